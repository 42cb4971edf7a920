//! Evaluators: curves and surfaces by their control points, drawn as lines and triangles.

use super::{CornerVertex, Primitive};
use crate::curve::b_spline::BSpline;
use crate::curve::bezier::de_casteljau;
use crate::curve::evaluator::patch;
use crate::math::{DVec3, DVec4};
use crate::trace::NoTrace;
use crate::{Error, Result};

/// Largest number of steps of an evaluator; for a patch, in both directions.
const MAX_STEPS: u32 = 4096;

/// A curve in space.
#[derive(Debug, Clone, PartialEq)]
pub enum SpaceCurve {
    /// A Bézier curve through its first and last control point.
    Bezier(Vec<DVec3>),
    /// A non-uniform rational B-spline: control points times their weight, and the weight; the degree
    /// and the knots are the spline's.
    Nurbs(BSpline<DVec4>),
}

impl SpaceCurve {
    /// Returns the point at a parameter 0 … 1; `None` without control points and where weights make it
    /// infinite.
    pub fn point(&self, t: f64) -> Option<DVec3> {
        match self {
            Self::Bezier(control) => de_casteljau(control, t, &mut NoTrace),
            Self::Nurbs(spline) => {
                let (first, last) = spline.domain();
                let p = spline.point(first + (last - first) * t);
                Some(p.truncate() / p.w)
            }
        }
        .filter(|p| p.is_finite())
    }

    pub(super) fn vertices(&self, steps: u32) -> Result<(Primitive, Vec<CornerVertex>)> {
        check(steps)?;
        let at = |i: u32| self.point(f64::from(i) / f64::from(steps)).map(CornerVertex::from);
        let vertices: Option<Vec<CornerVertex>> = (0..=steps).map(at).collect();
        Ok((Primitive::LineStrip, vertices.ok_or_else(infinite)?))
    }
}

/// A Bézier patch: rows of control points, all of one length; u runs along each row, v across the rows.
#[derive(Debug, Clone, PartialEq)]
pub struct BezierPatch {
    /// The control points.
    pub rows: Vec<Vec<DVec3>>,
}

impl BezierPatch {
    /// Returns the point at two parameters 0 … 1; `None` without control points and if it is not
    /// finite.
    pub(crate) fn point(&self, u: f64, v: f64) -> Option<DVec3> {
        patch(&self.rows, [u, v], &mut NoTrace).filter(|p| p.is_finite())
    }

    /// Returns the unit normal at two parameters 0 … 1, from the derivatives along u and v, ∂S/∂u × ∂S/∂v; `None` if
    /// they are parallel or not finite.
    pub fn normal(&self, u: f64, v: f64) -> Option<DVec3> {
        // The derivative of a Bézier curve has the differences of its control points, times its degree.
        let along: Vec<Vec<DVec3>> =
            self.rows.iter().map(|row| row.windows(2).map(|p| p[1] - p[0]).collect()).collect();
        let across: Vec<Vec<DVec3>> = self
            .rows
            .windows(2)
            .map(|rows| rows[0].iter().zip(&rows[1]).map(|(a, b)| *b - *a).collect())
            .collect();
        patch(&along, [u, v], &mut NoTrace)?
            .cross(patch(&across, [u, v], &mut NoTrace)?)
            .try_normalize()
    }

    pub(super) fn vertices(
        &self,
        [across, down]: [u32; 2],
    ) -> Result<(Primitive, Vec<CornerVertex>)> {
        check(across)?;
        check(down)?;
        let at = |i: u32, j: u32| {
            let (u, v) = (f64::from(i) / f64::from(across), f64::from(j) / f64::from(down));
            let position = self.point(u, v).ok_or_else(infinite)?;
            Ok(CornerVertex { normal: self.normal(u, v), ..CornerVertex::from(position) })
        };
        let mut rows = Vec::new();
        for j in 0..=down {
            let row: Result<Vec<CornerVertex>> = (0..=across).map(|i| at(i, j)).collect();
            rows.push(row?);
        }
        let mut vertices = Vec::new();
        for two in rows.windows(2) {
            for (above, below) in two[0].windows(2).zip(two[1].windows(2)) {
                vertices.extend([above[0], above[1], below[1], above[0], below[1], below[0]]);
            }
        }
        Ok((Primitive::Triangles, vertices))
    }
}

fn check(steps: u32) -> Result<()> {
    match steps {
        0 => Err(Error::parameter("steps", 0, "at least 1")),
        1..=MAX_STEPS => Ok(()),
        _ => {
            let (value, limit) = (u64::from(steps), u64::from(MAX_STEPS));
            Err(Error::Limit { what: "number of steps of an evaluator", value, limit })
        }
    }
}

fn infinite() -> Error {
    Error::parameter("control points", "given", "finite, and one at least")
}
