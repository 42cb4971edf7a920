//! Crossings among many long segments: vertical strips, halved again and again, after Balaban
//! (*An optimal algorithm for finding segments intersections*, 1995, the simpler form).
//!
//! In each strip, segments that span it and do not cross one another form a staircase; the others
//! find the stairs they cross or hit by binary search, and go down into the two halves.
//! O(n log² n + k) time for n segments and k crossings, O(n log n) memory.

use std::cmp::Ordering;

use super::lattice::{Coord, Point, Segment};
use super::parallel;

/// Strips with no more segments than this are not halved.
const FEW: usize = 12;

/// How many segments one task looks for on a staircase.
const CLIMBS: usize = if cfg!(test) { 8 } else { 1 << 11 };

/// The staircases of all strips.
#[derive(Debug, Default)]
pub struct Strips<C> {
    strips: Vec<Strip<C>>,
    /// Indices of segments: of each strip its stairs, from low to high, and of the last ones all.
    lists: Vec<u32>,
    /// Pairs that cross, and where.
    found: Vec<(u32, u32, Point<C>)>,
}

#[derive(Debug, Clone, Copy, Default)]
struct Strip<C> {
    stairs: (u32, u32),
    /// Columns from `middle` on belong to the right half.
    middle: C,
    halves: Option<(u32, u32)>,
    /// The rest, compared one by one, where there are no halves.
    rest: (u32, u32),
}

impl<C: Coord> Strips<C> {
    /// Divides the columns `left..=right` of pixels.
    pub fn build(&mut self, segments: &[Segment<C>], left: i64, right: i64) {
        self.strips.clear();
        self.lists.clear();
        self.found.clear();
        // One column more on both sides: a crossing on the border may round into the leaf.
        let all: Vec<u32> = (0..segments.len() as u32).collect();
        self.strip(segments, left - 1, right + 1, all);
    }

    /// All pairs that cross, with their pixels; some pairs more than once.
    pub fn crossings(&self, mut f: impl FnMut(usize, usize, Point<C>)) {
        for &(i, j, p) in &self.found {
            f(i as usize, j as usize, p);
        }
    }

    /// All segments that pass through a pixel, each once.
    pub fn hits(&self, segments: &[Segment<C>], p: Point<C>, mut f: impl FnMut(usize)) {
        let list = |(a, b): (u32, u32)| &self.lists[a as usize..b as usize];
        let mut index = 0;
        loop {
            let strip = &self.strips[index];
            let stairs = list(strip.stairs);
            let side = |i: &u32| segments[*i as usize].side_of_pixel(p);
            let start = stairs.partition_point(|i| side(i) == Ordering::Greater);
            let hit = stairs[start..].iter().take_while(|i| side(i) == Ordering::Equal);
            for &i in hit {
                // A stair's line hits; in its y range it is only where the segment itself goes.
                if segments[i as usize].hits_pixel(p) {
                    f(i as usize);
                }
            }
            let Some((left, right)) = strip.halves else {
                for &i in list(strip.rest) {
                    if segments[i as usize].hits_pixel(p) {
                        f(i as usize);
                    }
                }
                return;
            };
            index = if p.x < strip.middle { left } else { right } as usize;
        }
    }

    /// Works on the columns `left..=right`, that is from x = left − ½ to right + ½.
    fn strip(&mut self, segments: &[Segment<C>], left: i64, right: i64, list: Vec<u32>) -> u32 {
        let index = self.strips.len();
        self.strips.push(Strip::default());
        let (stairs, rest) = if list.len() <= FEW {
            (Vec::new(), list)
        } else {
            staircase(segments, left, right, &list)
        };
        let found = parallel::map(rest.chunks(CLIMBS).collect(), |some: &[u32]| {
            let mut found = Vec::new();
            some.iter().for_each(|&i| climb(segments, (left, right), &stairs, i, &mut found));
            found
        });
        found.iter().for_each(|found| self.found.extend_from_slice(found));
        let start = self.lists.len() as u32;
        self.lists.extend_from_slice(&stairs);
        self.strips[index].stairs = (start, self.lists.len() as u32);
        if rest.len() <= FEW || left == right {
            self.compare_all(segments, &rest);
            let start = self.lists.len() as u32;
            self.lists.extend_from_slice(&rest);
            self.strips[index].rest = (start, self.lists.len() as u32);
            return index as u32;
        }
        let middle = middle(segments, left, right, &rest);
        let part = |f: &dyn Fn(&Segment<C>) -> bool| {
            rest.iter().copied().filter(|&i| f(&segments[i as usize])).collect::<Vec<u32>>()
        };
        let lower = part(&|s| s.a.x.i64() < middle);
        let upper = part(&|s| s.b.x.i64() >= middle);
        drop(rest);
        let lower = self.strip(segments, left, middle - 1, lower);
        let upper = self.strip(segments, middle, right, upper);
        self.strips[index].middle = C::from_i64(middle);
        self.strips[index].halves = Some((lower, upper));
        index as u32
    }

    fn compare_all(&mut self, segments: &[Segment<C>], list: &[u32]) {
        for (k, &j) in list.iter().enumerate() {
            for &i in &list[..k] {
                if let Some(p) = segments[i as usize].crossing(&segments[j as usize]) {
                    self.found.push((i, j, p));
                }
            }
        }
    }
}

/// Finds the stairs that a segment crosses within a strip.
fn climb<C: Coord>(
    segments: &[Segment<C>],
    (left, right): (i64, i64),
    stairs: &[u32],
    index: u32,
    found: &mut Vec<(u32, u32, Point<C>)>,
) {
    if stairs.is_empty() {
        return;
    }
    let s = &segments[index as usize];
    let below = |end: Point<C>, border: i64, inside: bool| {
        stairs.partition_point(|&i| {
            let stair = &segments[i as usize];
            if inside {
                super::lattice::cross(stair.a, stair.b, end) > C::Wide::default()
            } else {
                stair.compare_at(s, border) == Ordering::Less
            }
        })
    };
    let start = below(s.a, 2 * left - 1, s.a.x.i64() >= left);
    let end = below(s.b, 2 * right + 1, s.b.x.i64() <= right);
    for &i in &stairs[start.min(end)..start.max(end)] {
        if let Some(p) = segments[i as usize].crossing(s) {
            found.push((i, index, p));
        }
    }
}

/// Splits off segments that span the strip and do not cross one another in it, from low to high.
fn staircase<C: Coord>(
    segments: &[Segment<C>],
    left: i64,
    right: i64,
    list: &[u32],
) -> (Vec<u32>, Vec<u32>) {
    let at = |i: u32| &segments[i as usize];
    let spans = |i: &u32| at(*i).a.x.i64() < left && at(*i).b.x.i64() > right;
    let (mut spanning, mut rest): (Vec<u32>, Vec<u32>) = list.iter().partition(|i| spans(i));
    let (west, east) = (2 * left - 1, 2 * right + 1);
    parallel::sort(&mut spanning, |&i, &j| {
        at(i).compare_at(at(j), west).then_with(|| at(i).compare_at(at(j), east)).then(i.cmp(&j))
    });
    let mut stairs: Vec<u32> = Vec::with_capacity(spanning.len());
    for i in spanning {
        match stairs.last() {
            Some(&top) if at(top).compare_at(at(i), east) == Ordering::Greater => rest.push(i),
            _ => stairs.push(i),
        }
    }
    (stairs, rest)
}

/// The median column of the ends within the strip, or its middle.
fn middle<C: Coord>(segments: &[Segment<C>], left: i64, right: i64, list: &[u32]) -> i64 {
    let ends = list.iter().flat_map(|&i| {
        let s = &segments[i as usize];
        [s.a.x.i64(), s.b.x.i64()]
    });
    let mut ends: Vec<i64> = ends.filter(|&x| left < x && x <= right).collect();
    if ends.is_empty() {
        return left + (right - left + 1) / 2;
    }
    let half = ends.len() / 2;
    *ends.select_nth_unstable(half).1
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spread(seed: &mut u64, limit: i64) -> i64 {
        *seed =
            seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (*seed >> 33) as i64 % limit
    }

    #[test]
    fn strips_find_what_all_pairs_find() {
        for (round, limit) in [(1u64, 40), (2, 300), (3, 1 << 28)] {
            let mut seed = round;
            let mut point = |near: i64| {
                Point::<i32>::new(near + spread(&mut seed, limit / 4), spread(&mut seed, limit))
            };
            let segments: Vec<Segment<i32>> = (0..400)
                .map(|i| {
                    let (a, b) = (point(0), point(if i % 3 == 0 { 0 } else { 3 * limit / 4 }));
                    if a < b { Segment { a, b } } else { Segment { a: b, b: a } }
                })
                .filter(|s| s.a != s.b)
                .collect();
            let mut strips = Strips::default();
            strips.build(&segments, 0, limit);
            let mut found = Vec::new();
            strips.crossings(|_, _, p| found.push(p));
            let pairs = (0..segments.len()).flat_map(|j| (0..j).map(move |i| (i, j)));
            let mut expected: Vec<_> =
                pairs.filter_map(|(i, j)| segments[i].crossing(&segments[j])).collect();
            for list in [&mut found, &mut expected] {
                list.sort_unstable();
                list.dedup();
            }
            assert_eq!(found, expected);
            for &p in expected.iter().take(500) {
                let mut hits = Vec::new();
                strips.hits(&segments, p, |i| hits.push(i));
                hits.sort_unstable();
                let all = (0..segments.len()).filter(|&i| segments[i].hits_pixel(p));
                assert_eq!(hits, all.collect::<Vec<_>>());
            }
        }
    }
}
