//! Labels that do not overlap.
//!
//! The greedy method, as in J. Christensen, J. Marks and S. Shieber, *An empirical study of algorithms
//! for point-feature label placement* (ACM Transactions on Graphics 14(3), 1995): labels come in the
//! order of their importance, each takes the first of its candidate places that is free, or none.
//! Class: image space. Cost: O(1) per candidate for labels of similar size, by a grid of buckets.

use crate::info::{Class, Info, Occluder};
use crate::math::{DVec2, Rect};

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
    limits: "what has been placed stays: not the most labels that there is room for",
    pseudocode: &[],
};

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
        for (number, candidate) in candidates.into_iter().enumerate() {
            if self.is_free(&candidate) {
                self.take(candidate);
                return Some(number);
            }
        }
        None
    }

    /// Takes the first of the candidates all of whose parts are free and within the bounds, as of a label along a line;
    /// returns its number. Parts of one candidate may overlap.
    pub fn place_parts(
        &mut self,
        candidates: impl IntoIterator<Item = Vec<Rect>>,
    ) -> Option<usize> {
        for (number, parts) in candidates.into_iter().enumerate() {
            if !parts.is_empty() && parts.iter().all(|part| self.is_free(part)) {
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

    fn is_free(&self, candidate: &Rect) -> bool {
        let bounds = &self.bounds;
        let within = bounds.contains(candidate.min()) && bounds.contains(candidate.max());
        within
            && self.touched(candidate).all(|bucket| {
                self.buckets[bucket].iter().all(|i| !overlap(&self.taken[*i as usize], candidate))
            })
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
