//! The integer grid of a drawing: the scene's vertices, projected and snapped.
//!
//! All decisions in the plane are made with integers and are exact; points that project to one position up to rounding
//! get one position.

use crate::math::{DVec2, DVec3, Rect};
use crate::view::picture_plane::{Borders, PicturePlane, PlanePoint};
use crate::visibility::object::Faces;

/// Half the page is at most this many steps; products of two differences stay far below 2⁶³.
const HALF_PAGE: f64 = (1u32 << 27) as f64;

/// Faces that reach further than this many times beyond the window are cut there, so that the grid
/// is not spent on invisible detail.
const GUARD: f64 = 2.0;

/// Points of the grid, in steps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default, Hash)]
pub(super) struct GridPoint {
    pub x: i32,
    pub y: i32,
}

impl GridPoint {
    pub fn minus(self, other: Self) -> [i64; 2] {
        [i64::from(self.x) - i64::from(other.x), i64::from(self.y) - i64::from(other.y)]
    }

    /// Returns the distance between the two, in steps.
    pub fn distance(self, other: Self) -> f64 {
        let [x, y] = self.minus(other).map(|d| d as f64);
        (x * x + y * y).sqrt()
    }
}

/// Returns twice the signed area of a, b, c; above 0 where they turn counter-clockwise. Exact.
#[inline]
pub(super) fn orient(a: GridPoint, b: GridPoint, c: GridPoint) -> i64 {
    let ([ux, uy], [vx, vy]) = (b.minus(a), c.minus(a));
    ux * vy - uy * vx
}

/// A vertex on the grid; its depth in steps as well.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Vertex {
    pub at: GridPoint,
    pub depth: f64,
}

/// Position of the grid in the plane of the picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Page {
    /// Plane units per step; a power of two.
    pub(super) step: f64,
    /// The middle of the page, in steps.
    pub(super) origin: DVec2,
    /// The larger side of the drawing, in steps.
    pub(super) extent: f64,
    /// Depths closer than this are one, in steps.
    pub(super) touching: f64,
}

impl Page {
    pub(super) fn plane_from_grid(&self, p: GridPoint) -> DVec2 {
        (self.origin + DVec2::new(f64::from(p.x), f64::from(p.y))) * self.step
    }

    /// Converts back from the plane to the grid; exact for the points that [`Self::plane_from_grid`] returns.
    pub(super) fn grid_from_plane(&self, p: DVec2) -> GridPoint {
        let p = p / self.step - self.origin;
        GridPoint { x: p.x.round() as i32, y: p.y.round() as i32 }
    }

    fn snap(&self, p: PlanePoint) -> Vertex {
        Vertex { at: self.grid_from_plane(p.at), depth: p.depth / self.step }
    }
}

/// A face, or the part of one in front of the eye.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cut {
    pub item: u32,
    pub corners: [Vertex; 3],
}

/// The vertices of a scene on the grid.
pub(super) struct Projected {
    pub page: Page,
    pub plane: PicturePlane,
    vertices: Vec<Vertex>,
    /// True for each vertex inside the view volume; empty if all are.
    inside: Vec<bool>,
    /// Cut faces: the parts inside the view volume of those that extend beyond it.
    pub cuts: Vec<Cut>,
    /// True if lines are cut at the window.
    windowed: bool,
}

impl Projected {
    /// Projects all vertices; `None` if nothing can be seen.
    pub fn new(faces: &Faces, plane: PicturePlane) -> Option<Self> {
        let view = |p: &DVec3| plane.view_from_world(*p);
        let depth_only = Borders { depth: true, sides: None };
        let mut around = Around::default();
        let mut all = true;
        for p in faces.points() {
            let v = view(p);
            if plane.contains(v, depth_only) {
                around.add(plane.plane_from_view(v));
            } else {
                all = false;
            }
        }
        let window = plane.window();
        let fits = |w: &Rect, k: f64| {
            let (lo, hi) = (w.min() * k, w.max() * k);
            around.min.cmpge(lo.extend(f64::NEG_INFINITY)).all()
                && around.max.cmple(hi.extend(f64::INFINITY)).all()
        };
        let windowed = !all || !window.as_ref().is_some_and(|w| fits(w, 1.0));
        let guarded = !all || !window.as_ref().is_some_and(|w| fits(w, GUARD));
        if guarded {
            around = around.limited(window?, faces, &plane);
        }
        let page = around.page()?;
        let volume = Borders { depth: true, sides: guarded.then_some(GUARD) };
        let mut found = Self {
            page,
            plane,
            vertices: Vec::new(),
            inside: Vec::new(),
            cuts: Vec::new(),
            windowed,
        };
        found.vertices =
            faces.points().iter().map(|p| page.snap(plane.plane_from_world(*p))).collect();
        if guarded {
            found.inside = faces.points().iter().map(|p| plane.contains(view(p), volume)).collect();
            found.cut_faces(faces, volume);
        }
        Some(found)
    }

    fn cut_faces(&mut self, faces: &Faces, volume: Borders) {
        for (item, t) in faces.triangles() {
            if t.iter().all(|v| self.inside[*v as usize]) {
                continue;
            }
            let Some(corners) = faces.sorted_corners(item) else { continue };
            let ring =
                self.plane.clip_face(&corners.map(|p| self.plane.view_from_world(p)), volume);
            let snapped: Vec<Vertex> =
                ring.iter().map(|p| self.page.snap(self.plane.plane_from_view(*p))).collect();
            for i in 1..snapped.len().saturating_sub(1) {
                let corners = [snapped[0], snapped[i], snapped[i + 1]];
                if corners.iter().all(|c| c.depth.is_finite()) {
                    self.cuts.push(Cut { item, corners });
                }
            }
        }
    }

    /// Returns the corners of a triangle on the grid; `None` if it reaches out of the view volume.
    #[inline]
    pub fn corners(&self, t: [u32; 3]) -> Option<[Vertex; 3]> {
        let whole = self.inside.is_empty() || t.iter().all(|v| self.inside[*v as usize]);
        whole.then(|| t.map(|v| self.vertices[v as usize]))
    }

    /// Returns whether any face reaches out of the view volume.
    pub fn any_cut(&self) -> bool {
        !self.inside.is_empty()
    }

    /// Returns an edge of the mesh, cut at the near plane and the window.
    pub fn edge(&self, faces: &Faces, ends: [u32; 2]) -> Option<[Vertex; 2]> {
        if self.windowed {
            return self.segment(ends.map(|v| faces.points()[v as usize]));
        }
        Some(ends.map(|v| self.vertices[v as usize]))
    }

    /// Returns any segment of the world, cut at the near plane and the window.
    pub fn segment(&self, ends: [DVec3; 2]) -> Option<[Vertex; 2]> {
        let mut ends = ends.map(|p| self.plane.view_from_world(p));
        if self.windowed {
            let borders = Borders { depth: true, sides: Some(1.0) };
            ends = self.plane.clip_segment(ends, borders)?;
        }
        let snapped = ends.map(|p| self.page.snap(self.plane.plane_from_view(p)));
        snapped.iter().all(|v| v.depth.is_finite()).then_some(snapped)
    }
}

/// Extent of the projected points.
struct Around {
    min: DVec3,
    max: DVec3,
}

impl Default for Around {
    fn default() -> Self {
        Self { min: DVec3::INFINITY, max: DVec3::NEG_INFINITY }
    }
}

impl Around {
    fn add(&mut self, p: PlanePoint) {
        let p = p.at.extend(p.depth);
        if p.is_finite() {
            self.min = self.min.min(p);
            self.max = self.max.max(p);
        }
    }

    /// Returns the bounds of the contents of the window, and the guard around it.
    fn limited(&self, window: Rect, faces: &Faces, plane: &PicturePlane) -> Self {
        let mut depths = Self::default();
        let volume = Borders { depth: true, sides: Some(GUARD) };
        for (item, _) in faces.triangles() {
            let Some(corners) = faces.sorted_corners(item) else { continue };
            let ring = plane.clip_face(&corners.map(|p| plane.view_from_world(p)), volume);
            ring.iter().for_each(|p| depths.add(plane.plane_from_view(*p)));
        }
        for ends in faces.marks() {
            let ends = ends.map(|v| plane.view_from_world(faces.points()[v as usize]));
            let inside = plane.clip_segment(ends, volume);
            inside.into_iter().flatten().for_each(|p| depths.add(plane.plane_from_view(p)));
        }
        let (lo, hi) = (window.min() * GUARD, window.max() * GUARD);
        Self {
            min: lo.max(depths.min.truncate()).extend(depths.min.z),
            max: hi.min(depths.max.truncate()).extend(depths.max.z),
        }
    }

    /// Returns the grid; `None` if nothing is there, or nothing that numbers can hold.
    fn page(&self) -> Option<Page> {
        let size = self.max - self.min;
        if !(size.is_finite() && size.min_element() >= 0.0) {
            return None;
        }
        let extent = size.truncate().max_element();
        // A point, or a line seen end-on, has no extent; any grid will do.
        let half =
            (extent * 0.5).max(self.max.abs().max(self.min.abs()).truncate().max_element() * 1e-12);
        let half = half.max(f64::MIN_POSITIVE * HALF_PAGE * 4.0);
        let (_, exponent) = libm::frexp(half / HALF_PAGE);
        let step = libm::ldexp(1.0, exponent);
        let origin = ((self.min + self.max).truncate() * (0.5 / step)).round();
        let model = size.max_element() / step;
        let page = Page { step, origin, extent: extent / step, touching: model * TOUCHING };
        (step.is_finite() && step > 0.0 && origin.is_finite() && model.is_finite()).then_some(page)
    }
}

/// Depths within this part of the model's extent touch: twice the noise of coordinates with 24 bits.
/// More would let lines shine through thin plates, less would hide lines on the faces they lie on.
const TOUCHING: f64 = 1.0 / (1u64 << 23) as f64;
