//! Evaluators: points of Bézier patches on a grid of parameters, and the triangles between them.
//!
//! P. Bézier, *Définition numérique des courbes et surfaces*, Automatisme 11, 1966; as commands of a pipeline: M.
//! Segal, K. Akeley, *The OpenGL Graphics System*, 1992, 5.1. Each point is found by de Casteljau's algorithm: first
//! along the rows of control points, then across. Class: object space. Cost: O(n² m + m²) per point, m rows of n
//! control points.

use super::bezier::{Point, de_casteljau};
use crate::info::{Class, Info, Occluder};
use crate::trace::{NoTrace, PseudocodeLine, Tracer};

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "evaluator",
    title: "Evaluators of Bézier patches",
    authors: "Pierre Bézier; M. Segal, K. Akeley",
    year: 1966,
    source: "Définition numérique des courbes et surfaces, Automatisme 11; The OpenGL Graphics System, 1992",
    class: Class::ObjectSpace,
    occluder: Occluder::None,
    coherence: &[],
    cost: "O(n² m + m²) per point, m rows of n control points",
    limits: "parameters in 0 … 1",
    pseudocode: &[
        "for j = 0 … steps down: v ← j / steps down",
        "    for i = 0 … steps across: u ← i / steps across",
        "        for each row r of control points:",
        "            Q_r ← point of the row's curve at u, by de Casteljau",
        "        P_ij ← point at v of the curve with the control points Q_r",
        "for each cell of the grid of points:",
        "    output the triangle P_ij, P_(i+1)j, P_(i+1)(j+1)",
        "    output the triangle P_ij, P_(i+1)(j+1), P_i(j+1)",
    ],
};

/// Step of the evaluation of one point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step<P> {
    /// A row of control points became one point.
    Row {
        /// Index of the row.
        row: usize,
        /// Parameter along it.
        u: f64,
        /// Point of its curve.
        point: P,
    },
    /// The points of the rows became one point of the patch.
    Point {
        /// Parameters along the rows and across them.
        parameters: [f64; 2],
        /// Point of the patch.
        point: P,
    },
}

impl<P> PseudocodeLine for Step<P> {
    fn line(&self) -> usize {
        match self {
            Self::Row { .. } => 4,
            Self::Point { .. } => 5,
        }
    }
}

/// Returns the point of a patch that the steps lead to.
pub fn replay<P: Point>(steps: &[Step<P>]) -> Option<P> {
    let points = steps.iter().filter_map(|step| match *step {
        Step::Row { point, .. } => Some(point),
        Step::Point { .. } => None,
    });
    let column: Vec<P> = points.collect();
    let v = steps.iter().find_map(|step| match *step {
        Step::Point { parameters: [_, v], .. } => Some(v),
        Step::Row { .. } => None,
    });
    de_casteljau(&column, v?, &mut NoTrace)
}

/// Returns the point of a patch at (u, v): `rows` of control points, u along each row, v across the rows; `None`
/// without control points.
///
/// ```
/// use durer::curve::evaluator::patch;
/// use durer::math::DVec3;
/// use durer::trace::NoTrace;
///
/// let rows = [[(0.0, 0.0, 0.0), (4.0, 0.0, 2.0)], [(0.0, 4.0, 2.0), (4.0, 4.0, 0.0)]];
/// let rows = rows.map(|row| row.map(DVec3::from));
/// assert_eq!(patch(&rows, [0.5, 0.5], &mut NoTrace), Some(DVec3::new(2.0, 2.0, 1.0)));
/// ```
pub fn patch<P: Point>(
    rows: &[impl AsRef<[P]>],
    [u, v]: [f64; 2],
    t: &mut impl Tracer<Step<P>>,
) -> Option<P> {
    let mut column = Vec::with_capacity(rows.len());
    for (row, control) in rows.iter().enumerate() {
        let point = de_casteljau(control.as_ref(), u, &mut NoTrace)?;
        t.step(|| Step::Row { row, u, point });
        column.push(point);
    }
    let point = de_casteljau(&column, v, &mut NoTrace)?;
    t.step(|| Step::Point { parameters: [u, v], point });
    Some(point)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::DVec3;
    use crate::trace::Recorder;

    #[test]
    fn steps_rebuild_the_point() {
        let height = |i: usize, j: usize| ((i * 7 + j * 3) % 5) as f64;
        let row = |j: usize| (0..4).map(|i| DVec3::new(i as f64, j as f64, height(i, j))).collect();
        let rows: Vec<Vec<DVec3>> = (0..3).map(row).collect();
        for at in [[0.0, 0.0], [0.25, 0.75], [1.0, 0.5]] {
            let mut steps = Recorder::default();
            let point = patch(&rows, at, &mut steps);
            assert_eq!(point, patch(&rows, at, &mut NoTrace));
            assert_eq!(point, replay(steps.steps()));
            assert_eq!(steps.steps().len(), 4);
        }
        assert_eq!(patch(&rows, [0.0, 0.0], &mut NoTrace), Some(rows[0][0]));
        assert_eq!(patch::<DVec3>(&Vec::<Vec<DVec3>>::new(), [0.5; 2], &mut NoTrace), None);
        assert_eq!(patch(&[Vec::<DVec3>::new()], [0.5; 2], &mut NoTrace), None);
    }
}
