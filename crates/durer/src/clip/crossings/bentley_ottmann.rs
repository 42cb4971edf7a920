//! Bentley and Ottmann's sweep: all crossings of segments from left to right.
//!
//! J. L. Bentley, T. A. Ottmann, *Algorithms for reporting and counting geometric intersections*, IEEE Transactions on Computers
//! C-28(9), 1979; cases of several segments in one point after M. de Berg et al., *Computational Geometry*, chapter 2. Object
//! space. An upright line sweeps over the plane. The status has the segments that it cuts, from below to above; it changes
//! only at events, which are ends and crossings. Two segments that cross are neighbours in the status just before, so only
//! neighbours are compared. Cost: O((n + k) log n) for n segments with k crossings; memory O(n + k).
//!
//! Deviations: the paper excludes ends on segments, vertical segments and three segments in a point; here they are
//! defined as [`crate::clip::crossings`] says. Events are rational numbers, and every comparison is exact, so the order
//! is never inconsistent. A crossing stays in the queue if its segments are no longer neighbours.

use super::point::{Meeting, Point, meeting, turn};
use super::{Crossing, Options, checked};
use crate::Result;
use crate::clip::line::Segment;
use crate::clip::status::Status;
use crate::info::{Class, Coherence, Info, Occluder};
use crate::math::DVec2;
use crate::trace::{PseudocodeLine, Tracer};
use std::cmp::Ordering;
use std::collections::BTreeMap;

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "bentley-ottmann",
    title: "Bentley–Ottmann",
    authors: "J. L. Bentley, T. A. Ottmann",
    year: 1979,
    source: "Algorithms for reporting and counting geometric intersections, IEEE TC C-28(9)",
    class: Class::ObjectSpace,
    occluder: Occluder::None,
    coherence: &[Coherence::ScanLine],
    cost: "O((n + k) log n) time, O(n + k) memory for n segments with k crossings",
    limits: "straight segments",
    pseudocode: &[
        "queue ← the ends of all segments, ordered by x, then y; status ← ∅",
        "while the queue is not empty:",
        "    p ← the first point of the queue",
        "    U, L, C ← segments that begin at p, end at p, go through p",
        "    if U, L and C have two or more segments: report p",
        "    take L and C out of the status",
        "    put U and C into the status, in their order just right of p",
        "    if U and C are empty: test the neighbours below and above p with each other",
        "    else: test the lowest of U and C with the neighbour below it",
        "          test the highest of U and C with the neighbour above it",
        "// test of two neighbours:",
        "they meet at a point after p: put it into the queue, if it is not there",
    ],
};

/// Neighbours that are tested.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Neighbours {
    /// Those below and above a point at which segments only end.
    Around,
    /// The lowest segment at the point and the one below it.
    Below,
    /// The highest segment at the point and the one above it.
    Above,
}

/// Step of the algorithm. Segments have the numbers of their order.
#[derive(Debug, Clone, PartialEq)]
pub enum Step {
    /// The ends of a segment are put into the queue.
    Ends {
        /// The segment.
        segment: u32,
        /// Its ends in the order of the sweep.
        ends: [DVec2; 2],
    },
    /// The sweep reaches a point.
    Event {
        /// The point.
        at: DVec2,
        /// Segments that begin there.
        begin: Vec<u32>,
        /// Segments that end there.
        end: Vec<u32>,
        /// Segments that go through it.
        through: Vec<u32>,
    },
    /// A crossing is found.
    Report(Crossing),
    /// The status after the event.
    Status {
        /// Segments from below to above.
        order: Vec<u32>,
    },
    /// Two neighbours are tested.
    Test {
        /// Place of the neighbours.
        place: Neighbours,
        /// The two, the lower one first.
        pair: [u32; 2],
        /// Point after the event where they meet.
        meet: Option<DVec2>,
        /// True if it is put into the queue.
        is_new: bool,
    },
}

impl PseudocodeLine for Step {
    fn line(&self) -> usize {
        match self {
            Self::Ends { .. } => 1,
            Self::Event { .. } => 4,
            Self::Report(_) => 5,
            Self::Status { .. } => 7,
            Self::Test { is_new: true, .. } => 12,
            Self::Test { place: Neighbours::Around, .. } => 8,
            Self::Test { place: Neighbours::Below, .. } => 9,
            Self::Test { place: Neighbours::Above, .. } => 10,
        }
    }
}

/// Returns the crossings that a list of steps leads to.
pub fn replay(steps: &[Step]) -> Vec<Crossing> {
    let report = |step: &Step| if let Step::Report(at) = step { Some(at.clone()) } else { None };
    steps.iter().filter_map(report).collect()
}

/// Returns all crossings in the order of their x and y.
///
/// # Errors
/// [`crate::Error::NonFinite`]; [`crate::Error::Limit`] for more crossings than the options allow.
pub fn crossings(
    segments: &[Segment<DVec2>],
    options: &Options,
    t: &mut impl Tracer<Step>,
) -> Result<Vec<Crossing>> {
    let segments = checked(segments)?;
    let mut queue = BTreeMap::<Point, Vec<usize>>::new();
    for (number, &ends) in segments.iter().enumerate() {
        t.step(|| Step::Ends { segment: number as u32, ends });
        queue.entry(ends[0].into()).or_default().push(number);
        queue.entry(ends[1].into()).or_default();
    }
    let status = Status::new(segments.len());
    let mut sweep = Sweep { segments, queue, status };
    let mut found = Vec::new();
    while let Some((at, begin)) = sweep.queue.pop_first() {
        if let Some(crossing) = sweep.event(&at, &begin, t) {
            t.step(|| Step::Report(crossing.clone()));
            found.push(crossing);
            options.check(found.len())?;
        }
        sweep.renew(&at, &begin, t);
    }
    Ok(found)
}

/// State of the sweep.
struct Sweep {
    segments: Vec<[DVec2; 2]>,
    /// Events to come, each with the segments that begin there.
    queue: BTreeMap<Point, Vec<usize>>,
    status: Status,
}

impl Sweep {
    /// Returns the lowest segment of the status that is not below a point.
    fn not_below(&self, at: &Point) -> Option<usize> {
        self.status.first(|segment| at.side(self.segments[segment]).is_le())
    }

    /// Returns the segments of the status that contain a point, from below to above, and the next one above.
    fn containing(&self, at: &Point) -> (Vec<usize>, Option<usize>) {
        let (mut all, mut next) = (Vec::new(), self.not_below(at));
        while let Some(segment) = next.filter(|segment| at.side(self.segments[*segment]).is_eq()) {
            all.push(segment);
            next = self.status.above(segment);
        }
        (all, next)
    }

    fn ends_at(&self, segment: usize, at: &Point) -> bool {
        at.is(self.segments[segment][1])
    }

    /// Returns the crossing at a point, if two or more segments meet there.
    fn event(&self, at: &Point, begin: &[usize], t: &mut impl Tracer<Step>) -> Option<Crossing> {
        let (all, _) = self.containing(at);
        t.step(|| {
            let (end, through): (Vec<usize>, _) = all.iter().partition(|s| self.ends_at(**s, at));
            let [begin, end, through] = [begin, &end, &through].map(numbers);
            Step::Event { at: at.near(), begin, end, through }
        });
        let mut segments = numbers(&all);
        segments.extend(numbers(begin));
        segments.sort_unstable();
        (segments.len() > 1).then(|| Crossing { at: at.near(), segments })
    }

    /// Brings the status into its order just right of a point, and tests the new neighbours.
    fn renew(&mut self, at: &Point, begin: &[usize], t: &mut impl Tracer<Step>) {
        let (all, above) = self.containing(at);
        let below = match all.first().copied().or(above) {
            Some(segment) => self.status.below(segment),
            None => self.status.last(),
        };
        all.iter().for_each(|segment| self.status.remove(*segment));
        let goes_on = |segment: &&usize| !self.ends_at(**segment, at);
        let on: Vec<usize> = all.iter().chain(begin).filter(goes_on).copied().collect();
        for &segment in &on {
            let segments = &self.segments;
            self.status.insert(segment, |other| is_above(segments, segment, other, at));
        }
        t.step(|| Step::Status { order: self.order() });
        if on.is_empty() {
            self.test(Neighbours::Around, [below, above], at, t);
            return;
        }
        let lowest = match below {
            Some(below) => self.status.above(below),
            None => self.status.first(|_| true),
        };
        let highest = match above {
            Some(above) => self.status.below(above),
            None => self.status.last(),
        };
        self.test(Neighbours::Below, [below, lowest], at, t);
        self.test(Neighbours::Above, [highest, above], at, t);
    }

    /// Returns the segments of the status from below to above.
    fn order(&self) -> Vec<u32> {
        let first = self.status.first(|_| true);
        let all = std::iter::successors(first, |segment| self.status.above(*segment));
        all.map(|segment| segment as u32).collect()
    }

    /// Puts the point where two neighbours meet into the queue, if it is still to come.
    fn test(
        &mut self,
        place: Neighbours,
        pair: [Option<usize>; 2],
        at: &Point,
        t: &mut impl Tracer<Step>,
    ) {
        let [Some(lower), Some(upper)] = pair else { return };
        // If they overlap, their ends are the events.
        let meet = match meeting(self.segments[lower], self.segments[upper]) {
            Meeting::At(point) if point > *at => Some(point),
            _ => None,
        };
        let is_new = meet.as_ref().is_some_and(|point| !self.queue.contains_key(point));
        t.step(|| Step::Test {
            place,
            pair: [lower as u32, upper as u32],
            meet: meet.as_ref().map(Point::near),
            is_new,
        });
        if let Some(point) = meet {
            self.queue.entry(point).or_default();
        }
    }
}

/// Returns whether a segment that begins at a point or goes through it is above another one, just right of the point.
/// Collinear segments have the order of their numbers.
fn is_above(segments: &[[DVec2; 2]], segment: usize, other: usize, at: &Point) -> bool {
    let side = at.side(segments[other]);
    let turned = |side: Ordering| side.then_with(|| turn(segments[other], segments[segment]));
    turned(side).then(segment.cmp(&other)).is_gt()
}

fn numbers(segments: &[usize]) -> Vec<u32> {
    segments.iter().map(|segment| *segment as u32).collect()
}
