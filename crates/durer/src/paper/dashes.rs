//! Dashes that begin and end where a line does, and meet at its corners.

use crate::math::DVec2;

/// Chains that bend by more than this at a point are divided there; as the cosine of 25°.
pub(super) const CORNER: f64 = 0.906;

/// Largest number of dashes of a stroke; with more it looks solid anyway.
const MOST_DASHES: f64 = 100_000.0;

/// Returns the length of a chain of points.
pub fn length(points: &[DVec2], closed: bool) -> f64 {
    let open: f64 = points.windows(2).map(|w| w[0].distance(w[1])).sum();
    match (closed, points) {
        (true, [first, .., last]) => open + last.distance(*first),
        _ => open,
    }
}

/// Returns the nominal dashes stretched for one stroke of the given length: it begins and ends with a
/// whole dash, and a closed one has a whole number of periods. `None` if it is too short for two
/// dashes: then it is drawn solid.
///
/// ```
/// use durer::paper::dashes::fitted;
/// let dashes = fitted(&[3.0, 1.0], 10.0, false).unwrap();
/// let periods = 2.0; // dash gap dash gap dash
/// assert!((periods * (dashes[0] + dashes[1]) + dashes[0] - 10.0).abs() < 1e-12);
/// assert_eq!(fitted(&[3.0, 1.0], 2.0, false), None);
/// ```
pub fn fitted(dashes: &[f64], length: f64, closed: bool) -> Option<Vec<f64>> {
    let [first, ..] = *dashes else { return None };
    if !dashes.iter().all(|d| *d > 0.0 && d.is_finite()) {
        return None;
    }
    let period: f64 = dashes.iter().sum();
    let end = if closed { 0.0 } else { first };
    let periods = ((length - end) / period).round();
    if !(1.0..=MOST_DASHES).contains(&periods) {
        return None;
    }
    let stretch = length / (periods * period + end);
    Some(dashes.iter().map(|d| d * stretch).collect())
}

/// Divides a chain at its corners, so that the dashes of each part meet there. A closed chain without
/// corners comes back closed.
pub(crate) fn at_corners(points: &[DVec2], closed: bool) -> Vec<(Vec<DVec2>, bool)> {
    let count = points.len();
    let corner = |i: usize| {
        let (Some(a), Some(b), Some(c)) =
            (points.get((i + count - 1) % count), points.get(i), points.get((i + 1) % count))
        else {
            return false;
        };
        (*b - *a).normalize_or_zero().dot((*c - *b).normalize_or_zero()) < CORNER
    };
    let ends = if closed { 0..count } else { 1..count.saturating_sub(1) };
    let corners: Vec<usize> = ends.filter(|&i| corner(i)).collect();
    let Some(&first) = corners.first() else { return vec![(points.to_vec(), closed)] };
    let cuts: Vec<usize> = if closed {
        corners.iter().copied().chain([first + count]).collect()
    } else {
        [0].into_iter().chain(corners.iter().copied()).chain([count - 1]).collect()
    };
    let part = |from: usize, to: usize| -> Vec<DVec2> {
        (from..=to).filter_map(|i| points.get(i % count)).copied().collect()
    };
    cuts.windows(2).map(|w| (part(w[0], w[1]), false)).collect()
}

/// Returns the dashes of a stroke as separate chains, for pens and painters without dashes.
pub fn cut(points: &[DVec2], closed: bool, dashes: &[f64]) -> Vec<Vec<DVec2>> {
    let mut chain = points.to_vec();
    if let (true, Some(&first)) = (closed, points.first()) {
        chain.push(first);
    }
    let Some(dashes) = fitted(dashes, length(points, closed), closed) else { return vec![chain] };
    let mut cutter = Cutter { dashes: &dashes, index: 0, left: dashes[0], done: Vec::new() };
    cutter.done.extend(chain.first().map(|&p| vec![p]));
    for w in chain.windows(2) {
        cutter.advance(w[0], w[1]);
    }
    cutter.done.retain(|d| d.len() > 1);
    cutter.done
}

/// Walk along a chain, a dash or gap at a time.
struct Cutter<'a> {
    dashes: &'a [f64],
    /// Index of the current element; even ones are dashes.
    index: usize,
    /// Length that remains of it.
    left: f64,
    done: Vec<Vec<DVec2>>,
}

impl Cutter<'_> {
    fn advance(&mut self, from: DVec2, to: DVec2) {
        let length = from.distance(to);
        let mut at = 0.0;
        while length - at > self.left {
            at += self.left;
            let here = from.lerp(to, at / length);
            self.add(here);
            self.index = (self.index + 1) % self.dashes.len();
            self.left = self.dashes[self.index];
            if self.draws() {
                self.done.push(vec![here]);
            }
        }
        self.left -= length - at;
        self.add(to);
    }

    fn draws(&self) -> bool {
        self.index.is_multiple_of(2)
    }

    fn add(&mut self, point: DVec2) {
        match (self.draws(), self.done.last_mut()) {
            (true, Some(dash)) if dash.last() != Some(&point) => dash.push(point),
            _ => {}
        }
    }
}
