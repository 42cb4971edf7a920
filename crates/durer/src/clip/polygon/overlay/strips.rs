//! Crossings among many long segments: vertical strips, halved again and again, after Balaban
//! (*An optimal algorithm for finding segments intersections*, 1995, the simpler form).
//!
//! In each strip, segments that span it and do not cross one another form a staircase; the others
//! find the stairs they cross or hit by binary search, and go down into the two halves.
//! O(n log² n + k) time for n segments and k crossings, O(n log n) memory. On neighbours that come
//! one after the other sorting and searching cost little, and O(n log n + k) is left.

use std::cmp::Ordering;
use std::ops::Range;

use super::lattice::{Coord, Height, Point, Segment, cross};
use super::parallel;

/// Strips with no more segments than this are not halved.
const FEW: usize = 12;

/// How many segments one task looks for on a staircase.
const CLIMBS: usize = if cfg!(test) { 8 } else { 1 << 11 };

/// Of how many segments, at most, the ends tell where a strip is halved.
const SAMPLES: usize = 64;

/// Pairs that cross, and where.
type Found<C> = Vec<(u32, u32, Point<C>)>;

/// The staircases of all strips.
#[derive(Debug, Default)]
pub struct Strips<C> {
    strips: Vec<Strip<C>>,
    /// Indices of segments: of each strip its stairs, from low to high, and of the last ones all.
    lists: Vec<u32>,
    found: Found<C>,
    /// Segments of the strips that are being worked on, those of each half behind the whole's.
    open: Vec<u32>,
    /// Segments that span the strip that is being worked on, and those of them that are stairs.
    spanning: Vec<Stair>,
    stairs: Vec<Stair>,
    ends: Vec<C>,
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
        self.open.clear();
        self.open.extend(0..segments.len() as u32);
        // One column more on both sides: a crossing on the border may round into the leaf.
        self.strip(segments, (left - 1, right + 1), 0);
    }

    /// All pairs that cross, with their pixels; some pairs more than once.
    pub fn crossings(&self, mut f: impl FnMut(usize, usize, Point<C>)) {
        for &(i, j, p) in &self.found {
            f(i as usize, j as usize, p);
        }
    }

    /// Works on the columns `left..=right`, that is from x = left − ½ to right + ½, and the open
    /// segments from `start` on.
    fn strip(&mut self, segments: &[Segment<C>], (left, right): (i64, i64), start: usize) -> u32 {
        let index = self.strips.len();
        self.strips.push(Strip::default());
        if self.open.len() - start > FEW {
            self.strips[index].stairs = self.staircase(&Bounds::new(segments, left, right), start);
        }
        let end = self.open.len();
        if end - start <= FEW || left == right {
            self.compare_all(segments, start);
            let first = self.lists.len() as u32;
            self.lists.extend_from_slice(&self.open[start..]);
            self.strips[index].rest = (first, self.lists.len() as u32);
            return index as u32;
        }
        let middle = self.middle(segments, (left, right), start);
        self.open_half(start..end, |i| segments[i as usize].a.x.i64() < middle);
        let lower = self.strip(segments, (left, middle - 1), end);
        self.open.truncate(end);
        self.open_half(start..end, |i| segments[i as usize].b.x.i64() >= middle);
        let upper = self.strip(segments, (middle, right), end);
        self.open.truncate(end);
        self.strips[index].middle = C::from_i64(middle);
        self.strips[index].halves = Some((lower, upper));
        index as u32
    }

    /// Opens those of some open segments that `keep` accepts.
    fn open_half(&mut self, range: Range<usize>, keep: impl Fn(u32) -> bool) {
        let mut end = self.open.len();
        self.open.resize(end + range.len(), 0);
        // Which half one belongs to is hard to foretell: no branch.
        for k in range {
            let i = self.open[k];
            self.open[end] = i;
            end += usize::from(keep(i));
        }
        self.open.truncate(end);
    }

    fn compare_all(&mut self, segments: &[Segment<C>], start: usize) {
        let list = &self.open[start..];
        for (k, &j) in list.iter().enumerate() {
            for &i in &list[..k] {
                if let Some(p) = segments[i as usize].crossing(&segments[j as usize]) {
                    self.found.push((i, j, p));
                }
            }
        }
    }

    /// Makes the staircase of a strip: takes from the open segments those that span the strip and do
    /// not cross one another in it, from low to high, and finds what the others cross there.
    fn staircase(&mut self, bounds: &Bounds<C>, start: usize) -> (u32, u32) {
        self.spanning.clear();
        self.stairs.clear();
        let mut rest = start;
        for k in start..self.open.len() {
            let i = self.open[k];
            if bounds.are_spanned_by(i) {
                self.spanning.push(bounds.stair(i));
            } else {
                self.open[rest] = i;
                rest += 1;
            }
        }
        self.open.truncate(rest);
        parallel::sort(&mut self.spanning, |s, t| {
            bounds
                .compare(WEST, s, t)
                .then_with(|| bounds.compare(EAST, s, t))
                .then(s.index.cmp(&t.index))
        });
        for &stair in &self.spanning {
            match self.stairs.last() {
                Some(top) if bounds.compare(EAST, top, &stair).is_gt() => {
                    self.open.push(stair.index)
                }
                _ => self.stairs.push(stair),
            }
        }
        self.climb(bounds, start);
        let first = self.lists.len() as u32;
        self.lists.extend(self.stairs.iter().map(|stair| stair.index));
        (first, self.lists.len() as u32)
    }

    /// Finds the stairs that open segments cross.
    fn climb(&mut self, bounds: &Bounds<C>, start: usize) {
        let (stairs, rest) = (&self.stairs[..], &self.open[start..]);
        if stairs.is_empty() {
            return;
        }
        let climb = |some: &[u32], found: &mut Found<C>| {
            let mut climber = Climber { bounds, stairs, below: (0, 0) };
            some.iter().for_each(|&i| climber.climb(i, found));
        };
        if parallel::threads() == 1 || rest.len() <= CLIMBS {
            return climb(rest, &mut self.found);
        }
        let found = parallel::map(rest.chunks(CLIMBS).collect(), |some| {
            let mut found = Vec::new();
            climb(some, &mut found);
            found
        });
        found.iter().for_each(|found| self.found.extend_from_slice(found));
    }

    /// The median column of the ends within the strip, of many segments those of some, or the
    /// strip's middle.
    fn middle(&mut self, segments: &[Segment<C>], (left, right): (i64, i64), start: usize) -> i64 {
        let list = &self.open[start..];
        self.ends.clear();
        // An odd step, for every second edge of a ring may end on one side.
        for &i in list.iter().step_by(list.len() / SAMPLES | 1) {
            let s = &segments[i as usize];
            let within = |x: &C| left < x.i64() && x.i64() <= right;
            self.ends.extend([s.a.x, s.b.x].iter().filter(|x| within(x)));
        }
        if self.ends.is_empty() {
            return left + (right - left + 1) / 2;
        }
        let half = self.ends.len() / 2;
        self.ends.select_nth_unstable(half).1.i64()
    }

    /// Calls `f` with each segment that passes through a pixel and what the pixel is listed with,
    /// once for each; reorders the list.
    ///
    /// All pixels are looked for in one strip before they go down into its halves. Neighbours mostly
    /// follow one another, so that each search begins where the one before ended.
    pub fn hits<T: Copy>(
        &self,
        segments: &[Segment<C>],
        pixels: &mut [(Point<C>, T)],
        f: &mut impl FnMut(usize, T),
    ) {
        let mut right = Vec::with_capacity(pixels.len());
        self.hits_in(0, segments, pixels, &mut right, f);
    }

    fn hits_in<T: Copy>(
        &self,
        strip: u32,
        segments: &[Segment<C>],
        pixels: &mut [(Point<C>, T)],
        right: &mut Vec<(Point<C>, T)>,
        f: &mut impl FnMut(usize, T),
    ) {
        let strip = &self.strips[strip as usize];
        let list = |(a, b): (u32, u32)| &self.lists[a as usize..b as usize];
        let stairs = list(strip.stairs);
        let mut below = 0;
        for &(p, what) in &*pixels {
            let side = |i: &u32| segments[*i as usize].side_of_pixel(p);
            below = partition_near(stairs, below, |i| side(i) == Ordering::Greater);
            let hit = stairs[below..].iter().take_while(|i| side(i) == Ordering::Equal);
            // A stair's line hits; in its y range it is only where the segment itself goes.
            let hit = hit.filter(|i| segments[**i as usize].hits_pixel(p));
            hit.for_each(|&i| f(i as usize, what));
        }
        let Some(halves) = strip.halves else {
            let rest = list(strip.rest);
            for &(p, what) in &*pixels {
                let hit = rest.iter().filter(|i| segments[**i as usize].hits_pixel(p));
                hit.for_each(|&i| f(i as usize, what));
            }
            return;
        };
        right.clear();
        let mut left = 0;
        for k in 0..pixels.len() {
            let pixel = pixels[k];
            if pixel.0.x < strip.middle {
                pixels[left] = pixel;
                left += 1;
            } else {
                right.push(pixel);
            }
        }
        let (lower, upper) = pixels.split_at_mut(left);
        upper.copy_from_slice(right);
        for (half, pixels) in [(halves.0, lower), (halves.1, upper)] {
            if !pixels.is_empty() {
                self.hits_in(half, segments, pixels, right, f);
            }
        }
    }
}

/// The borders of a strip, by their indices.
const WEST: usize = 0;
const EAST: usize = 1;

/// A strip's columns, its borders in half columns, and the segments that are compared there.
#[derive(Debug)]
struct Bounds<'a, C> {
    segments: &'a [Segment<C>],
    left: i64,
    right: i64,
    borders: [i64; 2],
}

/// A segment that spans a strip, with its heights at the strip's borders.
#[derive(Debug, Clone, Copy)]
struct Stair {
    index: u32,
    heights: [Height; 2],
}

impl<'a, C: Coord> Bounds<'a, C> {
    fn new(segments: &'a [Segment<C>], left: i64, right: i64) -> Self {
        Self { segments, left, right, borders: [2 * left - 1, 2 * right + 1] }
    }

    fn are_spanned_by(&self, index: u32) -> bool {
        let s = &self.segments[index as usize];
        (s.a.x.i64() < self.left) & (s.b.x.i64() > self.right)
    }

    fn stair(&self, index: u32) -> Stair {
        let s = &self.segments[index as usize];
        Stair { index, heights: self.borders.map(|border| s.height_at(border)) }
    }

    /// The order of two segments at a border that both span.
    #[inline]
    fn compare(&self, border: usize, s: &Stair, t: &Stair) -> Ordering {
        s.heights[border].compare(t.heights[border]).unwrap_or_else(|| {
            let t = &self.segments[t.index as usize];
            self.segments[s.index as usize].compare_exactly(t, self.borders[border])
        })
    }
}

/// Looks for what segments cross on a staircase. Neighbours mostly follow one another, so each
/// search begins where the one before ended.
struct Climber<'a, C> {
    bounds: &'a Bounds<'a, C>,
    stairs: &'a [Stair],
    /// How many stairs were below the start and the end of the last segment.
    below: (usize, usize),
}

impl<C: Coord> Climber<'_, C> {
    /// Finds the stairs that a segment crosses within the strip.
    fn climb(&mut self, index: u32, found: &mut Found<C>) {
        let Self { bounds, stairs, below } = self;
        let segments = bounds.segments;
        let s = &segments[index as usize];
        let under = |end: Point<C>, guess: usize| {
            partition_near(stairs, guess, |stair| {
                let stair = &segments[stair.index as usize];
                cross(stair.a, stair.b, end) > C::Wide::default()
            })
        };
        let under_border = |border: usize, guess: usize| {
            let mut heights = [Height::default(); 2];
            heights[border] = s.height_at(bounds.borders[border]);
            let here = Stair { index, heights };
            partition_near(stairs, guess, |stair| bounds.compare(border, stair, &here).is_lt())
        };
        let start = match s.a.x.i64() >= bounds.left {
            true => under(s.a, below.0),
            false => under_border(WEST, below.0),
        };
        let end = match s.b.x.i64() <= bounds.right {
            true => under(s.b, below.1),
            false => under_border(EAST, below.1),
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
            let mut pixels: Vec<_> = expected.iter().take(500).map(|&p| (p, p)).collect();
            let mut hits = Vec::new();
            strips.hits(&segments, &mut pixels, &mut |i, p| hits.push((p, i)));
            hits.sort_unstable();
            for &p in expected.iter().take(500) {
                let hits = hits.iter().filter(|hit| hit.0 == p).map(|hit| hit.1);
                let all = (0..segments.len()).filter(|&i| segments[i].hits_pixel(p));
                assert!(hits.eq(all));
            }
        }
    }
}
