//! Triangulation of polygons with holes, by ear clipping (D. Eberly's account of G. Meisters' two-ears
//! theorem, with the z-order search of V. Agafonkin's earcut, whose Rust form does the work).
//!
//! Cost: O(n log n) on ordinary input, O(n²) at worst. Limits: crossing contours give triangles that need
//! not cover exactly the even-odd area.

use earcut::Earcut;

use crate::curve::Contours;
use crate::info::{Class, Info};
use crate::math::DVec2;
use crate::trace::Tracer;

/// The facts of triangulation.
pub const INFO: Info = Info {
    name: "triangulate",
    title: "Triangulation by ear clipping",
    authors: "Gary H. Meisters",
    year: 1975,
    source: "Polygons have ears, American Mathematical Monthly 82(6)",
    class: Class::ObjectSpace,
    cost: "O(n log n) time on usual input, O(n²) at worst; O(n) memory",
    limits: "contours that cross give triangles that need not cover exactly the even-odd area",
};

/// Triangles of a polygon.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Triangulation {
    /// The finite points of the contours, in their order.
    pub points: Vec<DVec2>,
    /// Indices into `points`, three to a triangle.
    pub triangles: Vec<[u32; 3]>,
}

impl Triangulation {
    /// The sum of the triangles' areas.
    pub fn area(&self) -> f64 {
        let at = |i: u32| self.points.get(i as usize).copied().unwrap_or_default();
        let area = |t: &[u32; 3]| (at(t[1]) - at(t[0])).perp_dot(at(t[2]) - at(t[0])).abs() / 2.0;
        self.triangles.iter().map(area).sum()
    }
}

/// One step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step {
    /// The next of the points that triangles name.
    Point(DVec2),
    /// An ear is cut off: its corners.
    Triangle([u32; 3]),
}

/// Triangulates a polygon: the first contour is its border, the others are holes in it.
///
/// ```
/// use durer::curve::{Path, flatten};
/// use durer::raster::triangulate::triangulate;
/// use durer::trace::NoTrace;
///
/// let mut frame = Path::rectangle(0.0, 0.0, 4.0, 4.0);
/// frame.extend(&Path::rectangle(1.0, 1.0, 2.0, 2.0));
/// let triangles = triangulate(&flatten(&frame, 0.1), &mut NoTrace);
/// assert_eq!(triangles.area(), 12.0);
/// assert_eq!(triangles.triangles.len(), 8);
/// ```
pub fn triangulate(polygon: &Contours, t: &mut impl Tracer<Step>) -> Triangulation {
    let mut points = Vec::with_capacity(polygon.points().len());
    let mut holes: Vec<u32> = Vec::new();
    for (i, (contour, _)) in polygon.iter().enumerate() {
        if i > 0 {
            holes.push(points.len() as u32);
        }
        points.extend(contour.iter().copied().filter(|p| p.is_finite()));
    }
    let mut indices: Vec<u32> = Vec::new();
    Earcut::new().earcut(points.iter().map(|p| [p.x, p.y]), &holes, &mut indices);
    let triangles = indices.as_chunks::<3>().0.to_vec();
    points.iter().for_each(|p| t.step(|| Step::Point(*p)));
    triangles.iter().for_each(|corners| t.step(|| Step::Triangle(*corners)));
    Triangulation { points, triangles }
}
