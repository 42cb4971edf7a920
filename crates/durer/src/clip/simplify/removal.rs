//! Removes points one by one, the least important first.

use super::or_infinite;
use crate::math::DVec2;
use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

/// No neighbour.
pub const NONE: u32 = u32::MAX;

/// The two neighbours of each point; those of points that stay are [`NONE`].
#[derive(Debug, Clone, Default)]
pub struct Links(pub Vec<[u32; 2]>);

impl Links {
    /// Creates the links of one line, whose ends stay.
    pub fn of_line(count: usize) -> Self {
        let link = |i: usize| match (i.checked_sub(1), i + 1 < count) {
            (Some(before), true) => [before as u32, i as u32 + 1],
            _ => [NONE; 2],
        };
        Self((0..count).map(link).collect())
    }

    /// Returns whether a point may be left out.
    pub fn is_free(&self, point: u32) -> bool {
        self.of(point)[0] != NONE
    }

    /// Returns the neighbours of a point.
    pub fn of(&self, point: u32) -> [u32; 2] {
        self.0.get(point as usize).copied().unwrap_or([NONE; 2])
    }

    /// Puts another neighbour in the place of one.
    fn replace(&mut self, point: u32, old: u32, new: u32) {
        if let Some(pair) = self.0.get_mut(point as usize)
            && let Some(link) = pair.iter_mut().find(|link| **link == old)
        {
            *link = new;
        }
    }
}

/// Importance of a point, in units of the coordinates.
#[derive(Debug, Clone)]
pub enum Measure {
    /// The side of a square as large as its triangle with its neighbours.
    Area,
    /// Importance of each point, known beforehand.
    Given(Vec<f64>),
}

impl Measure {
    fn of(&self, places: &[DVec2], [a, c]: [u32; 2], b: u32) -> f64 {
        match self {
            Self::Given(weights) => weights.get(b as usize).copied().unwrap_or(f64::INFINITY),
            Self::Area => {
                let [a, b, c] =
                    [a, b, c].map(|i| places.get(i as usize).copied().unwrap_or_default());
                or_infinite(((b - a).perp_dot(c - a).abs() * 0.5).sqrt())
            }
        }
    }
}

/// Reason why a point cannot be left out now.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Obstacle {
    /// This point is where the line would jump over it.
    Point(u32),
    /// The edge that would come is there already.
    Edge,
}

/// Guard of the points that must not be left out.
pub trait Guard {
    /// Returns the obstacle to an edge that bypasses point b.
    fn obstacle(&mut self, places: &[DVec2], links: &Links, abc: [u32; 3]) -> Option<Obstacle>;
    /// Records that the point in the middle is left out.
    fn removed(&mut self, links: &Links, abc: [u32; 3]);
}

/// Every point may be left out.
#[derive(Debug, Clone, Copy)]
pub struct Free;

impl Guard for Free {
    fn obstacle(&mut self, _: &[DVec2], _: &Links, _: [u32; 3]) -> Option<Obstacle> {
        None
    }

    fn removed(&mut self, _: &Links, _: [u32; 3]) {}
}

/// Everything that is needed.
pub struct Removal<'a, G> {
    pub places: &'a [DVec2],
    pub links: Links,
    pub measure: Measure,
    /// Points that matter more stay.
    pub limit: f64,
    pub guard: G,
}

/// Importance of a point, in bits, and its index.
type Entry = (u64, u32);

/// Points by how much they matter, then by index.
///
/// Only the entries of the smallest magnitude are in a heap, which therefore stays in the processor's cache; the others
/// wait unsorted, and those outdated by then never enter the heap.
#[derive(Default)]
struct Queue {
    heap: BinaryHeap<Reverse<Entry>>,
    /// The largest magnitude in the heap.
    magnitude: u64,
    /// Entries of larger magnitudes.
    later: BTreeMap<u64, Vec<Entry>>,
    /// Current importance of each point; entries that say otherwise are out of date.
    now: Vec<f64>,
    /// Points that wait until another one is removed, by that one.
    waiting: BTreeMap<u32, Vec<u32>>,
}

/// Number of low bits that do not count for the magnitude of a measure: a magnitude spans a fourth of a power of two.
const MAGNITUDE_SHIFT: u32 = 50;

impl Queue {
    fn push(&mut self, point: u32, measure: f64, limit: f64) {
        // The bits of non-negative floats are in the order of their values.
        let measure = measure.abs();
        self.now[point as usize] = measure;
        if measure > limit {
            return;
        }
        let entry = (measure.to_bits(), point);
        let magnitude = entry.0 >> MAGNITUDE_SHIFT;
        if magnitude <= self.magnitude {
            self.heap.push(Reverse(entry));
        } else {
            self.later.entry(magnitude).or_default().push(entry);
        }
    }

    /// Returns the next point and its measure.
    fn pop(&mut self) -> Option<(u32, f64)> {
        loop {
            while let Some(Reverse(entry)) = self.heap.pop() {
                if is_current(&self.now, &entry) {
                    return Some((entry.1, f64::from_bits(entry.0)));
                }
            }
            let (magnitude, entries) = self.later.pop_first()?;
            self.magnitude = magnitude;
            let current = entries.into_iter().filter(|entry| is_current(&self.now, entry));
            self.heap = current.map(Reverse).collect();
        }
    }
}

/// Returns whether an entry has the current importance of its point.
fn is_current(now: &[f64], &(bits, point): &Entry) -> bool {
    now[point as usize].to_bits() == bits
}

/// Importance that marks a removed point.
const GONE: f64 = -1.0;

impl<G: Guard> Removal<'_, G> {
    /// Leaves out all points that it can; calls `visit` with each point and its weight. Returns the weights, infinite
    /// for points that stay.
    pub fn run(mut self, mut visit: impl FnMut(usize, f64)) -> Vec<f64> {
        let count = self.places.len();
        let mut weights = vec![f64::INFINITY; count];
        let mut queue = Queue { now: vec![f64::INFINITY; count], ..Queue::default() };
        for point in 0..count as u32 {
            self.queue(&mut queue, point);
        }
        // A triangle counts as at least as large as those taken before it.
        let mut least = 0.0f64;
        while let Some((b, measure)) = queue.pop() {
            let [a, c] = self.links.of(b);
            match self.guard.obstacle(self.places, &self.links, [a, b, c]) {
                Some(Obstacle::Point(other)) => queue.waiting.entry(other).or_default().push(b),
                // One of the neighbours has to change before.
                Some(Obstacle::Edge) => {}
                None => {
                    least = least.max(measure);
                    weights[b as usize] = least;
                    visit(b as usize, least);
                    self.unlink(&mut queue, [a, b, c]);
                }
            }
        }
        weights
    }

    fn unlink(&mut self, queue: &mut Queue, [a, b, c]: [u32; 3]) {
        queue.now[b as usize] = GONE;
        self.links.replace(a, b, c);
        self.links.replace(c, b, a);
        self.guard.removed(&self.links, [a, b, c]);
        let waiting = queue.waiting.remove(&b).unwrap_or_default();
        for point in [a, c].into_iter().chain(waiting) {
            if queue.now.get(point as usize).is_some_and(|now| *now != GONE) {
                self.queue(queue, point);
            }
        }
    }

    fn queue(&self, queue: &mut Queue, point: u32) {
        if self.links.is_free(point) {
            let measure = self.measure.of(self.places, self.links.of(point), point);
            queue.push(point, measure, self.limit);
        }
    }
}
