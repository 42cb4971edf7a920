//! Labels that do not overlap.
//!
//! The greedy method, as in J. Christensen, J. Marks and S. Shieber, *An empirical study of algorithms
//! for point-feature label placement* (ACM Transactions on Graphics 14(3), 1995): labels come in the
//! order of their importance, each takes the first of its candidate places that is free, or none.
//! Class: image space. Cost: O(1) per candidate for labels of similar size, by a grid of buckets.

use crate::info::{Class, Info, Occluder};
use crate::math::{DVec2, Rect};
use crate::trace::{NoTrace, PseudocodeLine, Tracer};

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "greedy-labels",
    title: "Greedy label placement",
    authors: "J. Christensen, J. Marks, S. Shieber",
    year: 1995,
    source: "An empirical study of algorithms for point-feature label placement, ACM Transactions on Graphics 14(3)",
    class: Class::ImageSpace,
    occluder: Occluder::None,
    coherence: &[],
    cost: "O(1) per candidate for labels of similar size",
    limits: "placed labels stay: there may be room for more labels in other places",
    pseudocode: &[
        "taken ← ∅",
        "for each label, the most important first:",
        "    for each of its candidate places, the best first:",
        "        not wholly within the bounds: next candidate",
        "        for each taken place in the buckets that it touches:",
        "            the two overlap: next candidate",
        "        taken ← taken ∪ {candidate}; next label",
        "    no candidate is left: the label is left out",
    ],
};

/// Reason for which a place is not free.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Obstacle {
    /// It reaches beyond the bounds.
    Bounds,
    /// It overlaps a place that was taken before, by its number.
    Taken(usize),
}

/// Step of the placement of one label.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step {
    /// A candidate was tried.
    Candidate {
        /// Its number.
        number: usize,
        /// The place.
        place: Rect,
        /// Obstacle to it; none where it is free.
        obstacle: Option<Obstacle>,
    },
    /// The label has its place.
    Placed {
        /// Number of the candidate.
        number: usize,
    },
    /// The label is left out.
    LeftOut,
}

impl PseudocodeLine for Step {
    fn line(&self) -> usize {
        match self {
            Self::Candidate { obstacle: Some(Obstacle::Bounds), .. } => 4,
            Self::Candidate { obstacle: None, .. } => 5,
            Self::Candidate { obstacle: Some(Obstacle::Taken(_)), .. } => 6,
            Self::Placed { .. } => 7,
            Self::LeftOut => 8,
        }
    }
}

/// Returns the number of the candidate that a list of steps leads to.
pub fn replay(steps: &[Step]) -> Option<usize> {
    steps.iter().find_map(|step| match step {
        Step::Candidate { number, obstacle: None, .. } => Some(*number),
        _ => None,
    })
}

/// Buckets have this size in pixels: about that of a label.
const BUCKET: f64 = 64.0;

/// Record of the places that are taken.
#[derive(Debug, Clone)]
pub struct Placer {
    bounds: Rect,
    columns: usize,
    rows: usize,
    /// Labels that touch each bucket.
    buckets: Vec<Vec<u32>>,
    taken: Vec<Rect>,
}

impl Placer {
    /// Creates a placer without labels; none will reach beyond `bounds`, in pixels.
    pub fn new(bounds: Rect) -> Self {
        let count = |length: f64| (length / BUCKET).ceil().clamp(1.0, 1024.0) as usize;
        let (columns, rows) = (count(bounds.size().x), count(bounds.size().y));
        Self { bounds, columns, rows, buckets: vec![Vec::new(); columns * rows], taken: Vec::new() }
    }

    /// Takes the first candidate that is within the bounds and overlaps no place already taken; returns its number.
    ///
    /// ```
    /// use durer::math::{DVec2, Rect};
    /// use durer::view::label::Placer;
    ///
    /// let at = |x: f64, y: f64| {
    ///     Rect::new(DVec2::new(x, y), DVec2::new(x + 30.0, y + 10.0)).unwrap()
    /// };
    /// let mut placer = Placer::new(Rect::new(DVec2::ZERO, DVec2::splat(100.0))?);
    /// assert_eq!(placer.place([at(-1.0, 0.0), at(10.0, 10.0)]), Some(1));
    /// assert_eq!(placer.place([at(35.0, 15.0)]), None);
    /// # Ok::<(), durer::Error>(())
    /// ```
    pub fn place(&mut self, candidates: impl IntoIterator<Item = Rect>) -> Option<usize> {
        self.place_traced(candidates, &mut NoTrace)
    }

    /// Places a label as [`Self::place`] does, with a listener for its steps.
    pub fn place_traced(
        &mut self,
        candidates: impl IntoIterator<Item = Rect>,
        t: &mut impl Tracer<Step>,
    ) -> Option<usize> {
        for (number, place) in candidates.into_iter().enumerate() {
            let obstacle = self.obstacle(&place);
            t.step(|| Step::Candidate { number, place, obstacle });
            if obstacle.is_none() {
                self.take(place);
                t.step(|| Step::Placed { number });
                return Some(number);
            }
        }
        t.step(|| Step::LeftOut);
        None
    }

    /// Takes the first of the candidates all of whose parts are free and within the bounds, as of a label along a line;
    /// returns its number. Parts of one candidate may overlap.
    pub(crate) fn place_parts(
        &mut self,
        candidates: impl IntoIterator<Item = Vec<Rect>>,
    ) -> Option<usize> {
        for (number, parts) in candidates.into_iter().enumerate() {
            if !parts.is_empty() && parts.iter().all(|part| self.obstacle(part).is_none()) {
                parts.into_iter().for_each(|part| self.take(part));
                return Some(number);
            }
        }
        None
    }

    /// Keeps labels off a place, which others may be kept off too.
    pub fn reserve(&mut self, place: Rect) {
        self.take(place);
    }

    /// Returns what keeps a candidate from being placed; `None` where it is free.
    fn obstacle(&self, candidate: &Rect) -> Option<Obstacle> {
        let bounds = &self.bounds;
        if !bounds.contains(candidate.min()) || !bounds.contains(candidate.max()) {
            return Some(Obstacle::Bounds);
        }
        let near = self.touched(candidate).flat_map(|bucket| &self.buckets[bucket]);
        let mut taken = near.map(|number| *number as usize);
        taken.find(|number| overlap(&self.taken[*number], candidate)).map(Obstacle::Taken)
    }

    fn take(&mut self, rect: Rect) {
        let number = self.taken.len() as u32;
        for bucket in self.touched(&rect).collect::<Vec<_>>() {
            self.buckets[bucket].push(number);
        }
        self.taken.push(rect);
    }

    /// Returns the buckets that a rectangle touches.
    fn touched(&self, rect: &Rect) -> impl Iterator<Item = usize> + use<> {
        let columns = self.columns;
        let counts = DVec2::new(columns as f64, self.rows as f64);
        let scale = counts / self.bounds.size().max(DVec2::splat(f64::MIN_POSITIVE));
        let at = |p: DVec2| {
            let place = ((p - self.bounds.min()) * scale).clamp(DVec2::ZERO, counts - 1.0);
            (place.x as usize, place.y as usize)
        };
        let ((x0, y0), (x1, y1)) = (at(rect.min()), at(rect.max()));
        (y0..=y1).flat_map(move |y| (x0..=x1).map(move |x| y * columns + x))
    }
}

/// Returns whether two rectangles share more than a border.
fn overlap(a: &Rect, b: &Rect) -> bool {
    a.min().x < b.max().x && b.min().x < a.max().x && a.min().y < b.max().y && b.min().y < a.max().y
}
