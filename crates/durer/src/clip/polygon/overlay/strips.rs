//! Crossings among many long segments: vertical strips, halved again and again, after Balaban
//! (*An optimal algorithm for finding segments intersections*, 1995, the simpler form).
//!
//! In each strip, segments that span it and do not cross one another form a staircase; the others find the stairs they
//! cross or hit by binary search. Stairs divide the others into groups, each between two of them, and each group goes
//! down into its own two halves of the strip. So neighbours that run side by side are separated at once, and little is
//! left for each further level. O(n log² n + k) time for n segments and k crossings, O(n log n + k) memory.

mod finder;

use std::cmp::Ordering;
use std::ops::Range;

use super::lattice::{Coord, Height, Point, Segment, cross};
use super::parallel;

/// Strips with no more segments than this are not halved.
const FEW: usize = 12;

/// Number of segments in one column from which overlapping ones are compared as one.
const MANY: usize = 4 * FEW;

/// About how many segments are in a group, if stairs keep them apart.
const GROUP: usize = if cfg!(test) { 4 } else { 24 };

/// Number of segments that one task searches for on a staircase.
const CLIMBS: usize = if cfg!(test) { 8 } else { 1 << 11 };

/// Largest number of segments whose ends decide where a strip is halved.
const SAMPLES: usize = 64;

/// Pairs that cross, and where.
type Found<C> = Vec<(u32, u32, Point<C>)>;

/// The staircases of all strips.
#[derive(Debug, Default)]
pub struct Strips<C> {
    strips: Vec<Strip>,
    groups: Vec<Group<C>>,
    /// Indices of segments: of each strip its stairs, from low to high, and of each group that is not
    /// halved all.
    lists: Vec<u32>,
    found: Found<C>,
    /// Number of pairs that there is memory for; further pairs are not searched.
    pub room: Option<usize>,
    /// Segments of the strips being processed; those of a part follow those of the whole.
    open: Vec<u32>,
    /// Lowest and highest place on its staircase of each open segment in a strip.
    places: Vec<(u32, u32)>,
    /// Group of each place on a staircase.
    group_of: Vec<u32>,
    /// Segments that span the strip being processed, and the stairs among them.
    spanning: Vec<Stair>,
    stairs: Vec<Stair>,
    ends: Vec<C>,
}

#[derive(Debug, Clone, Copy, Default)]
struct Strip {
    stairs: (u32, u32),
    /// Groups from low to high, at least one.
    groups: (u32, u32),
}

/// Segments between two stairs of a staircase that are not on it.
#[derive(Debug, Clone, Copy, Default)]
struct Group<C> {
    /// Places on the staircase below this belong to the group or to those before: above this many
    /// stairs.
    end: u32,
    /// Columns from `middle` on belong to the right half.
    middle: C,
    halves: Option<(u32, u32)>,
    /// Its segments, compared one by one, if there are no halves.
    rest: (u32, u32),
}

impl<C: Coord> Strips<C> {
    /// Divides the columns `left..=right` of pixels.
    pub fn build(&mut self, segments: &[Segment<C>], left: i64, right: i64) {
        self.strips.clear();
        self.groups.clear();
        self.lists.clear();
        self.found.clear();
        self.open.clear();
        self.open.extend(0..segments.len() as u32);
        // One column more on both sides: a crossing on the border may round into the leaf.
        self.strip(segments, (left - 1, right + 1), 0);
    }

    /// Returns whether there are more pairs than there is memory for.
    pub fn is_full(&self) -> bool {
        is_full(&self.found, self.room)
    }

    /// Calls `f` for all pairs that cross, with their pixels; for some pairs more than once, and of segments that
    /// overlap perhaps only for the first.
    pub fn crossings(&self, mut f: impl FnMut(usize, usize, Point<C>)) {
        for &(i, j, p) in &self.found {
            f(i as usize, j as usize, p);
        }
    }

    /// Works on the columns `left..=right`, that is from x = left − ½ to right + ½, and the open
    /// segments from `start` on.
    fn strip(&mut self, segments: &[Segment<C>], columns: (i64, i64), start: usize) -> u32 {
        let index = self.strips.len();
        self.strips.push(Strip::default());
        let mut stairs = (0, 0);
        if self.is_full() {
            return index as u32;
        }
        if self.open.len() - start > FEW {
            stairs = self.staircase(&Bounds::new(segments, columns), start);
        }
        let (first, end) = (self.groups.len(), self.open.len());
        self.divide(start, stairs.1 - stairs.0);
        self.strips[index] = Strip { stairs, groups: (first as u32, self.groups.len() as u32) };
        for group in (first..self.groups.len()).rev() {
            let (start, end) = self.groups[group].rest;
            self.open.truncate(end as usize);
            self.group(group, segments, columns, start as usize);
        }
        self.open.truncate(end);
        index as u32
    }

    /// Divides open segments into groups, which are stored behind them if there are several.
    fn divide(&mut self, start: usize, stairs: u32) {
        let end = self.open.len();
        let count = end - start;
        let first = self.groups.len();
        let whole = Group { end: u32::MAX, rest: (start as u32, end as u32), ..Group::default() };
        if stairs == 0 || count < 2 * GROUP {
            return self.groups.push(whole);
        }
        self.group_of.clear();
        self.group_of.resize(stairs as usize + 1, 0);
        self.places.iter().for_each(|&(low, _)| self.group_of[low as usize] += 1);
        let (mut load, mut group) = (0, 0);
        for (place, load_or_group) in (1..).zip(&mut self.group_of) {
            load += std::mem::replace(load_or_group, group);
            if load as usize >= GROUP {
                self.groups.push(Group { end: place, ..Group::default() });
                (load, group) = (0, group + 1);
            }
        }
        self.groups.push(whole);
        let groups = |(low, high): (u32, u32)| {
            let [low, high] = [low, high].map(|place| self.group_of[place as usize] as usize);
            first + low..first + high + 1
        };
        let copies: usize = self.places.iter().map(|&places| groups(places).len()).sum();
        // Segments that cross many stairs would be in many groups.
        if copies > 2 * count {
            self.groups.truncate(first);
            return self.groups.push(whole);
        }
        self.groups[first..].iter_mut().for_each(|group| group.rest = (0, 0));
        for &places in &self.places {
            self.groups[groups(places)].iter_mut().for_each(|group| group.rest.1 += 1);
        }
        let mut place = end as u32;
        for group in &mut self.groups[first..] {
            let count = group.rest.1;
            group.rest = (place, place);
            place += count;
        }
        self.open.resize(end + copies, 0);
        for (k, &places) in (start..).zip(&self.places) {
            for group in &mut self.groups[groups(places)] {
                self.open[group.rest.1 as usize] = self.open[k];
                group.rest.1 += 1;
            }
        }
    }

    /// Processes a group, whose open segments are those from `start` on.
    fn group(
        &mut self,
        group: usize,
        segments: &[Segment<C>],
        (left, right): (i64, i64),
        start: usize,
    ) {
        let end = self.open.len();
        if end - start <= FEW || left == right {
            self.compare_all(segments, start);
            let first = self.lists.len() as u32;
            self.lists.extend_from_slice(&self.open[start..]);
            self.groups[group].rest = (first, self.lists.len() as u32);
            return;
        }
        let middle = self.middle(segments, (left, right), start);
        self.open_half(start..end, |i| segments[i as usize].a.x.i64() < middle);
        let lower = self.strip(segments, (left, middle - 1), end);
        self.open.truncate(end);
        self.open_half(start..end, |i| segments[i as usize].b.x.i64() >= middle);
        let upper = self.strip(segments, (middle, right), end);
        self.open.truncate(end);
        self.groups[group].middle = C::from_i64(middle);
        self.groups[group].halves = Some((lower, upper));
    }

    /// Opens the segments among some open ones that `keep` accepts.
    fn open_half(&mut self, range: Range<usize>, keep: impl Fn(u32) -> bool) {
        let mut end = self.open.len();
        self.open.resize(end + range.len(), 0);
        // Which half a segment belongs to is hard to predict: no branch.
        for k in range {
            let i = self.open[k];
            self.open[end] = i;
            end += usize::from(keep(i));
        }
        self.open.truncate(end);
    }

    fn compare_all(&mut self, segments: &[Segment<C>], start: usize) {
        let mut distinct = Vec::new();
        let mut list = &self.open[start..];
        if list.len() > MANY {
            let at = |i: u32| segments[i as usize];
            distinct.extend_from_slice(list);
            distinct.sort_unstable_by_key(|&i| (at(i).a, at(i).b, i));
            distinct.dedup_by(|i, first| at(*i) == at(*first));
            list = &distinct;
        }
        for (k, &j) in list.iter().enumerate() {
            if is_full(&self.found, self.room) {
                return;
            }
            for &i in &list[..k] {
                if let Some(p) = segments[i as usize].crossing(&segments[j as usize]) {
                    self.found.push((i, j, p));
                }
            }
        }
    }

    /// Builds the staircase of a strip: takes from the open segments those that span the strip and do not cross one
    /// another in it, from low to high, and finds the stairs that the others cross there.
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
                Some(top) if bounds.crosses(top, &stair) => self.open.push(stair.index),
                _ => self.stairs.push(stair),
            }
        }
        self.climb(bounds, start);
        let first = self.lists.len() as u32;
        self.lists.extend(self.stairs.iter().map(|stair| stair.index));
        (first, self.lists.len() as u32)
    }

    /// Finds the stairs that open segments cross, and their places on the staircase.
    fn climb(&mut self, bounds: &Bounds<C>, start: usize) {
        let (stairs, rest) = (&self.stairs[..], &self.open[start..]);
        if stairs.is_empty() {
            return;
        }
        self.places.clear();
        self.places.resize(rest.len(), (0, 0));
        let room = self.room;
        let climb = |some: &[u32], places: &mut [(u32, u32)], found: &mut Found<C>| {
            let mut climber = Climber { bounds, stairs, below: (0, 0) };
            for (&i, place) in some.iter().zip(places) {
                if is_full(found, room) {
                    return;
                }
                *place = climber.climb(i, found);
            }
        };
        if parallel::threads() == 1 || rest.len() <= CLIMBS {
            return climb(rest, &mut self.places, &mut self.found);
        }
        let tasks = rest.chunks(CLIMBS).zip(self.places.chunks_mut(CLIMBS));
        let found = parallel::map(tasks.collect(), |(some, places)| {
            let mut found = Vec::new();
            climb(some, places, &mut found);
            found
        });
        found.iter().for_each(|found| self.found.extend_from_slice(found));
    }

    /// Returns the median column of the ends within the strip (of a sample, if there are many segments), or the strip's
    /// middle.
    fn middle(&mut self, segments: &[Segment<C>], (left, right): (i64, i64), start: usize) -> i64 {
        let list = &self.open[start..];
        self.ends.clear();
        // An odd step, for every second edge of a ring may end on one side.
        for &i in list.iter().step_by((list.len() / SAMPLES) | 1) {
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
}

/// Returns whether there are more pairs than there is memory for.
fn is_full<C>(found: &Found<C>, room: Option<usize>) -> bool {
    room.is_some_and(|room| found.len() > room)
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
    fn new(segments: &'a [Segment<C>], (left, right): (i64, i64)) -> Self {
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

    /// Returns whether two segments that span the strip, of which the first is not higher in the west, cross in it. A
    /// crossing on the eastern border counts: both segments reach it, and in the next strip neither would be above the
    /// other.
    fn crosses(&self, s: &Stair, t: &Stair) -> bool {
        let order = self.compare(EAST, s, t);
        order.is_gt() || (order.is_eq() && self.compare(WEST, s, t).is_lt())
    }

    /// Returns the order of two segments at a border that both span.
    #[inline]
    fn compare(&self, border: usize, s: &Stair, t: &Stair) -> Ordering {
        s.heights[border].compare(t.heights[border]).unwrap_or_else(|| {
            let t = &self.segments[t.index as usize];
            self.segments[s.index as usize].compare_exactly(t, self.borders[border])
        })
    }
}

/// Search for the crossings of segments with a staircase. Neighbours mostly follow one another, so each search begins
/// where the one before ended.
struct Climber<'a, C> {
    bounds: &'a Bounds<'a, C>,
    stairs: &'a [Stair],
    /// Numbers of stairs below the start and the end of the last segment.
    below: (usize, usize),
}

impl<C: Coord> Climber<'_, C> {
    /// Finds the stairs that a segment crosses within the strip. Returns its lowest and highest place: how many stairs
    /// are below.
    fn climb(&mut self, index: u32, found: &mut Found<C>) -> (u32, u32) {
        let Self { bounds, stairs, below } = self;
        let segments = bounds.segments;
        let s = &segments[index as usize];
        let under = |end: Point<C>, guess: usize| {
            partition_near(stairs, guess, |stair| {
                let stair = &segments[stair.index as usize];
                cross(stair.a, stair.b, end) > C::Wide::default()
            })
        };
        let at = |border: usize| {
            let mut heights = [Height::default(); 2];
            heights[border] = s.height_at(bounds.borders[border]);
            Stair { index, heights }
        };
        let start = if s.a.x.i64() >= bounds.left {
            under(s.a, below.0)
        } else {
            let west = at(WEST);
            partition_near(stairs, below.0, |stair| bounds.compare(WEST, stair, &west).is_lt())
        };
        let (end, met) = if s.b.x.i64() <= bounds.right {
            (under(s.b, below.1), 0)
        } else {
            let east = at(EAST);
            let order = |stair: &Stair| bounds.compare(EAST, stair, &east);
            let end = partition_near(stairs, below.1, |stair| order(stair).is_lt());
            // Stairs met on the eastern border are crossed there: see `Bounds::crosses`.
            (end, stairs[end..].iter().take_while(|stair| order(stair).is_eq()).count())
        };
        *below = (start, end);
        let (low, high) = (start.min(end), start.max(end + met));
        for stair in &stairs[low..high] {
            if let Some(p) = segments[stair.index as usize].crossing(s) {
                found.push((stair.index, index, p));
            }
        }
        (low as u32, high as u32)
    }
}

/// Returns the result of [`slice::partition_point`]; O(log d) if that is d items from `guess`.
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
        // On tiny grids many cross just where two strips meet.
        let tiny = (4..60).map(|round| (round, 16, 60));
        for (round, limit, count) in
            [(1u64, 40, 400), (2, 300, 400), (3, 1 << 28, 400)].into_iter().chain(tiny)
        {
            let mut seed = round;
            let mut point = |near: i64| {
                Point::<i32>::new(near + spread(&mut seed, limit / 4), spread(&mut seed, limit))
            };
            let segments: Vec<Segment<i32>> = (0..count)
                .map(|i| {
                    let (a, b) = (point(0), point(if i % 3 == 0 { 0 } else { 3 * limit / 4 }));
                    if a < b { Segment { a, b } } else { Segment { a: b, b: a } }
                })
                .filter(|s| s.a != s.b)
                .collect();
            let mut strips = Strips::default();
            strips.build(&segments, 0, limit);
            let mut found = Vec::new();
            strips.crossings(|i, j, p| found.push((i.min(j), i.max(j), p)));
            let pairs = (0..segments.len()).flat_map(|j| (0..j).map(move |i| (i, j)));
            let crossing =
                |(i, j): (usize, usize)| Some((i, j, segments[i].crossing(&segments[j])?));
            let mut expected: Vec<_> = pairs.filter_map(crossing).collect();
            for list in [&mut found, &mut expected] {
                list.sort_unstable();
                list.dedup();
            }
            assert_eq!(found, expected);
            let pixels: Vec<_> = expected.iter().map(|pair| pair.2).zip(0..500).collect();
            let mut hits = Vec::new();
            strips.hits(&segments, &pixels, |i, k| hits.push((k, i)));
            hits.sort_unstable();
            for &(p, k) in &pixels {
                let hits = hits.iter().filter(|hit| hit.0 == k).map(|hit| hit.1);
                let all = (0..segments.len()).filter(|&i| segments[i].hits_pixel(p));
                assert!(hits.eq(all));
            }
        }
    }

    #[test]
    fn copies_of_segments_are_compared_once() {
        let mut seed = 5;
        let mut end = || Point::<i32>::new(spread(&mut seed, 2), spread(&mut seed, 30));
        let few: Vec<Segment<i32>> = (0..40)
            .map(|_| (end(), end()))
            .filter(|(a, b)| a < b)
            .map(|(a, b)| Segment { a, b })
            .collect();
        let segments: Vec<_> = few.iter().cycle().take(50 * few.len()).copied().collect();
        let mut strips = Strips::default();
        strips.build(&segments, 0, 2);
        let (mut found, mut count) = (Vec::new(), 0);
        strips.crossings(|i, j, p| {
            assert_eq!(segments[i].crossing(&segments[j]), Some(p));
            found.push(p);
            count += 1;
        });
        let pairs = few.iter().flat_map(|s| few.iter().map(move |t| (s, t)));
        let mut expected: Vec<_> = pairs.filter_map(|(s, t)| s.crossing(t)).collect();
        for list in [&mut found, &mut expected] {
            list.sort_unstable();
            list.dedup();
        }
        assert!(found == expected && !found.is_empty());
        assert!(count < few.len() * few.len(), "{count}");
    }
}
