//! Cubic curves at equal steps by forward differences: three additions a point and coordinate.
//!
//! J. D. Foley, A. van Dam, *Fundamentals of Interactive Computer Graphics*, Addison-Wesley 1982, section 13.5. Of a
//! cubic p(t) = a·t³ + b·t² + c·t + d the third difference at equal steps is constant, so each point follows from the
//! one before by adding the first difference to it, the second to the first, and the third to the second. Object space.
//! Cost: O(1) multiplications for a curve, three additions a point.
//!
//! Limits: equal steps of the parameter; rounding adds up with the cube of the number of steps, as the differences are
//! summed.

use crate::info::{Class, Coherence, Info, Occluder};
use crate::math::DVec2;
use crate::trace::{PseudocodeLine, Tracer};

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "forward-differences",
    title: "Cubic curves by forward differences",
    authors: "J. D. Foley, A. van Dam",
    year: 1982,
    source: "Fundamentals of Interactive Computer Graphics, Addison-Wesley",
    class: Class::ObjectSpace,
    occluder: Occluder::None,
    coherence: &[Coherence::Edge],
    cost: "three additions per point and coordinate",
    limits: "equal steps; rounding adds up over many steps",
    pseudocode: &[
        "a, b, c, d ← coefficients of t³, t², t and 1; h ← 1 / n",
        "p ← d",
        "Δ1 ← a·h³ + b·h² + c·h",
        "Δ2 ← 6·a·h³ + 2·b·h²",
        "Δ3 ← 6·a·h³",
        "emit p",
        "n times:",
        "    p ← p + Δ1, Δ1 ← Δ1 + Δ2, Δ2 ← Δ2 + Δ3",
        "    emit p",
    ],
};

/// Step of the algorithm: a point, and the differences from which the next one follows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Step {
    /// Number of the point, from 0.
    pub index: u32,
    /// The point.
    pub point: DVec2,
    /// Δ1, Δ2 and Δ3 there.
    pub differences: [DVec2; 3],
}

impl PseudocodeLine for Step {
    fn line(&self) -> usize {
        if self.index == 0 { 6 } else { 9 }
    }
}

/// Returns `steps` + 1 points of a cubic Bézier curve at equal steps of its parameter, from the first to the last; no
/// steps give the first point alone.
///
/// ```
/// use durer::curve::forward_difference::points;
/// use durer::math::DVec2;
/// use durer::trace::NoTrace;
///
/// let control = [(0.0, 0.0), (0.0, 4.0), (4.0, 4.0), (4.0, 0.0)].map(DVec2::from);
/// assert_eq!(points(&control, 2, &mut NoTrace)[1], DVec2::new(2.0, 3.0));
/// ```
pub fn points(control: &[DVec2; 4], steps: u32, t: &mut impl Tracer<Step>) -> Vec<DVec2> {
    let [p0, p1, p2, p3] = *control;
    let (a, b, c) = (p3 - p0 + (p1 - p2) * 3.0, (p0 - p1 * 2.0 + p2) * 3.0, (p1 - p0) * 3.0);
    let h = f64::from(steps.max(1)).recip();
    let (h2, h3) = (h * h, h * h * h);
    let mut point = p0;
    let mut differences =
        [a * h3 + b * h2 + c * h, a * (6.0 * h3) + b * (2.0 * h2), a * (6.0 * h3)];
    let mut found = vec![point];
    t.step(|| Step { index: 0, point, differences });
    for index in 1..=steps {
        point += differences[0];
        differences =
            [differences[0] + differences[1], differences[1] + differences[2], differences[2]];
        t.step(|| Step { index, point, differences });
        found.push(point);
    }
    found
}

/// Returns the points that a list of steps leads to, from the first one's differences.
pub fn replay(steps: &[Step]) -> Vec<DVec2> {
    let Some(first) = steps.first() else { return Vec::new() };
    let mut next = (first.point, first.differences);
    let follow = |_: &Step| {
        let (point, [d1, d2, d3]) = next;
        next = (point + d1, [d1 + d2, d2 + d3, d3]);
        point
    };
    steps.iter().map(follow).collect()
}
