//! Crossings among many long segments: vertical strips, halved again and again, after Balaban
//! (*An optimal algorithm for finding segments intersections*, 1995, the simpler form).
//!
//! In each strip, segments that span it and do not cross one another form a staircase; the others
//! find the stairs they cross or hit by binary search, and go down into the two halves.
//! O(n log² n + k) time for n segments and k crossings, O(n log n) memory.

use std::cmp::Ordering;

use super::lattice::{Coord, Height, Point, Segment, cross};
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

    /// To look for what passes through pixels.
    pub fn finder<'a>(&'a self, segments: &'a [Segment<C>]) -> Finder<'a, C> {
        Finder { strips: self, segments, below: vec![0; self.strips.len()] }
    }

    /// Works on the columns `left..=right`, that is from x = left − ½ to right + ½.
    fn strip(&mut self, segments: &[Segment<C>], left: i64, right: i64, list: Vec<u32>) -> u32 {
        let index = self.strips.len();
        self.strips.push(Strip::default());
        let columns = Columns::new(left, right);
        let (stairs, rest) = if list.len() <= FEW {
            (Vec::new(), list)
        } else {
            staircase(segments, columns, &list)
        };
        let found = parallel::map(rest.chunks(CLIMBS).collect(), |some: &[u32]| {
            let mut climber = Climber { segments, columns, stairs: &stairs, below: (0, 0) };
            let mut found = Vec::new();
            some.iter().for_each(|&i| climber.climb(i, &mut found));
            found
        });
        found.iter().for_each(|found| self.found.extend_from_slice(found));
        let start = self.lists.len() as u32;
        self.lists.extend(stairs.iter().map(|stair| stair.index));
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

/// Looks for the segments that pass through pixels; each search begins on a staircase where the
/// one before ended.
pub struct Finder<'a, C> {
    strips: &'a Strips<C>,
    segments: &'a [Segment<C>],
    /// Of each strip how many stairs were below the last pixel.
    below: Vec<u32>,
}

impl<C: Coord> Finder<'_, C> {
    /// All segments that pass through a pixel, each once.
    pub fn hits(&mut self, p: Point<C>, mut f: impl FnMut(usize)) {
        let Strips { strips, lists, .. } = self.strips;
        let segments = self.segments;
        let list = |(a, b): (u32, u32)| &lists[a as usize..b as usize];
        let mut index = 0;
        loop {
            let strip = &strips[index];
            let stairs = list(strip.stairs);
            let side = |i: &u32| segments[*i as usize].side_of_pixel(p);
            let below = &mut self.below[index];
            let start = partition_near(stairs, *below as usize, |i| side(i) == Ordering::Greater);
            *below = start as u32;
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
}

/// A strip's columns, and its borders in half columns.
#[derive(Debug, Clone, Copy)]
struct Columns {
    left: i64,
    right: i64,
    west: i64,
    east: i64,
}

/// A segment that spans a strip, with its heights at the strip's borders.
#[derive(Debug, Clone, Copy)]
struct Stair {
    index: u32,
    west: Height,
    east: Height,
}

impl Columns {
    fn new(left: i64, right: i64) -> Self {
        Self { left, right, west: 2 * left - 1, east: 2 * right + 1 }
    }

    fn are_spanned_by<C: Coord>(&self, s: &Segment<C>) -> bool {
        s.a.x.i64() < self.left && s.b.x.i64() > self.right
    }

    fn stair<C: Coord>(&self, segments: &[Segment<C>], index: u32) -> Stair {
        let s = &segments[index as usize];
        Stair { index, west: s.height_at(self.west), east: s.height_at(self.east) }
    }

    /// Compares at the western border, then at the eastern one, then by index.
    #[inline]
    fn compare<C: Coord>(&self, segments: &[Segment<C>], s: &Stair, t: &Stair) -> Ordering {
        let exactly = |border| {
            segments[s.index as usize].compare_exactly(&segments[t.index as usize], border)
        };
        let at_west = s.west.compare(t.west).unwrap_or_else(|| exactly(self.west));
        let at_east = || s.east.compare(t.east).unwrap_or_else(|| exactly(self.east));
        at_west.then_with(at_east).then(s.index.cmp(&t.index))
    }
}

/// Looks for what segments cross on a staircase. Neighbours mostly follow one another, so each
/// search begins where the one before ended.
struct Climber<'a, C> {
    segments: &'a [Segment<C>],
    columns: Columns,
    stairs: &'a [Stair],
    /// How many stairs were below the start and the end of the last segment.
    below: (usize, usize),
}

impl<C: Coord> Climber<'_, C> {
    /// Finds the stairs that a segment crosses within the strip.
    fn climb(&mut self, index: u32, found: &mut Vec<(u32, u32, Point<C>)>) {
        if self.stairs.is_empty() {
            return;
        }
        let Self { segments, columns, stairs, below } = self;
        let s = &segments[index as usize];
        let under = |end: Point<C>, guess: usize| {
            partition_near(stairs, guess, |stair| {
                let stair = &segments[stair.index as usize];
                cross(stair.a, stair.b, end) > C::Wide::default()
            })
        };
        let under_border = |border: i64, guess: usize, at: fn(&Stair) -> Height| {
            let height = s.height_at(border);
            partition_near(stairs, guess, |stair| {
                let order = at(stair).compare(height);
                let stair = &segments[stair.index as usize];
                order.unwrap_or_else(|| stair.compare_exactly(s, border)) == Ordering::Less
            })
        };
        let start = if s.a.x.i64() >= columns.left {
            under(s.a, below.0)
        } else {
            under_border(columns.west, below.0, |stair| stair.west)
        };
        let end = if s.b.x.i64() <= columns.right {
            under(s.b, below.1)
        } else {
            under_border(columns.east, below.1, |stair| stair.east)
        };
        *below = (start, end);
        for stair in &stairs[start.min(end)..start.max(end)] {
            if let Some(p) = segments[stair.index as usize].crossing(s) {
                found.push((stair.index, index, p));
            }
        }
    }
}

/// What [`slice::partition_point`] gives; O(log d) where that is d items from `guess`.
fn partition_near<T>(list: &[T], guess: usize, mut before: impl FnMut(&T) -> bool) -> usize {
    let (mut low, mut high) = (0, list.len());
    let mut probe = guess.min(high.saturating_sub(1));
    let mut step = 1;
    while low < high {
        if before(&list[probe]) {
            low = probe + 1;
            if high < list.len() {
                break;
            }
            probe = (probe + step).min(high - 1);
        } else {
            high = probe;
            if low > 0 {
                break;
            }
            probe = probe.saturating_sub(step);
        }
        step *= 2;
    }
    low + list[low..high.max(low)].partition_point(before)
}

/// Splits off segments that span the strip and do not cross one another in it, from low to high.
fn staircase<C: Coord>(
    segments: &[Segment<C>],
    columns: Columns,
    list: &[u32],
) -> (Vec<Stair>, Vec<u32>) {
    let mut spanning = Vec::new();
    let mut rest = Vec::new();
    for &i in list {
        if columns.are_spanned_by(&segments[i as usize]) {
            spanning.push(columns.stair(segments, i));
        } else {
            rest.push(i);
        }
    }
    parallel::sort(&mut spanning, |s, t| columns.compare(segments, s, t));
    let mut stairs: Vec<Stair> = Vec::with_capacity(spanning.len());
    for stair in spanning {
        let above = |top: &Stair| {
            top.east.compare(stair.east).unwrap_or_else(|| {
                let other = &segments[stair.index as usize];
                segments[top.index as usize].compare_exactly(other, columns.east)
            })
        };
        match stairs.last() {
            Some(top) if above(top) == Ordering::Greater => rest.push(stair.index),
            _ => stairs.push(stair),
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
    fn from_any_guess_the_same_place_is_found() {
        for length in 0..12 {
            let list: Vec<usize> = (0..length).collect();
            for (place, guess) in (0..=length).flat_map(|p| (0..=length + 1).map(move |g| (p, g))) {
                assert_eq!(partition_near(&list, guess, |&k| k < place), place, "{length} {guess}");
            }
        }
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
            let mut finder = strips.finder(&segments);
            for &p in expected.iter().take(500) {
                let mut hits = Vec::new();
                finder.hits(p, |i| hits.push(i));
                hits.sort_unstable();
                let all = (0..segments.len()).filter(|&i| segments[i].hits_pixel(p));
                assert_eq!(hits, all.collect::<Vec<_>>());
            }
        }
    }
}
