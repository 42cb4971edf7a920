//! Wireframe: all edges, whatever is in front of them.
//!
//! Timothy Johnson, *Sketchpad III: a computer program for drawing in three dimensions*, AFIPS Spring Joint Computer
//! Conference, 1963. Object space; O(n log n) for n edges. The picture is ambiguous: it does not show which side is in
//! front (Necker's cube), and different bodies may have the same picture.

use super::arrange::{How, Pieces, arrange, arranged, on_page};
use super::edge_lines::NO_ITEM;
use super::marks::marks;
use super::page::{Page, Projected};
use super::piece::Piece;
use crate::Result;
use crate::info::{Class, Info, Occluder};
use crate::math::DVec2;
use crate::scene::Scene;
use crate::target::drawing::{Drawing, Line, LineClass};
use crate::trace::Tracer;
use crate::view::View;
use crate::view::picture_plane::PicturePlane;
use crate::visibility::object::{Bodies, EdgeSide, Edges, Faces, Weld};

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "wireframe-lines",
    title: "Wireframe",
    authors: "Timothy Johnson",
    year: 1963,
    source: "Sketchpad III: a computer program for drawing in three dimensions, AFIPS Spring Joint \
             Computer Conference",
    class: Class::ObjectSpace,
    occluder: Occluder::None,
    coherence: &[],
    cost: "O(n log n) for n edges",
    limits: "ambiguous: lines in front and behind look alike",
    pseudocode: &[],
};

/// Options of a wireframe.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// Tolerance, as in [`super::hidden_line::Options::tolerance`].
    pub tolerance: f64,
    /// Rule that joins vertices.
    pub weld: Weld,
}

impl Default for Options {
    /// Returns the default: 0.05 pixels in a picture of 1000.
    fn default() -> Self {
        Self { tolerance: 5e-5, weld: Weld::Auto }
    }
}

impl Options {
    fn how(&self) -> How {
        How { tolerance: self.tolerance, stubs: 0.0, beneath: 0.0, smooth: false }
    }
}

/// Step of the algorithm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step {
    /// The grid was laid.
    Page(Page),
    /// One edge was drawn.
    Edge([DVec2; 2]),
}

/// Returns the lines that a list of steps leads to.
pub fn replay(steps: &[Step], options: &Options) -> Vec<Line> {
    let Some(Step::Page(page)) = steps.first() else { return Vec::new() };
    let edges = steps.iter().filter_map(|s| match s {
        Step::Edge(ends) => Some(piece(ends.map(|p| page.grid_from_plane(p)))),
        Step::Page(_) => None,
    });
    let all = edges.collect();
    arrange(page, Pieces { all, ..Pieces::default() }, options.how())
}

fn piece(ends: [super::page::GridPoint; 2]) -> Piece {
    Piece { ends, class: LineClass::Wire, invisibility: 0, smooth: false }
}

/// Draws all edges of a scene's faces, and its lines and points. Edges inside a polygon that was read as several
/// triangles are none; edges that lie on each other in the picture are drawn once.
///
/// # Errors
/// [`crate::Error::Parameter`] for an option out of its range, and what [`Faces::welded`] finds.
pub fn draw(
    scene: &Scene,
    view: &View,
    options: &Options,
    t: &mut impl Tracer<Step>,
) -> Result<Drawing> {
    options.how().check()?;
    let mut faces = Faces::welded(scene, options.weld)?;
    let edges = faces.take_edges();
    let (_, edges) = Bodies::of_edges(&faces, edges);
    let plane = PicturePlane::new(view);
    let window = plane.window();
    let found = on_page(&faces, plane, |projected| pieces(&faces, &edges, projected, t));
    let edges = edges.count();
    Ok(Drawing { window, lines: arranged(found, options.how()), edges, ..Drawing::default() })
}

/// Returns all edges, and the lines and points of the model.
fn pieces(
    faces: &Faces,
    edges: &Edges,
    projected: &Projected,
    t: &mut impl Tracer<Step>,
) -> Pieces {
    t.step(|| Step::Page(projected.page));
    let drawn = edges.iter().filter(|(_, sides)| !inside_polygon(faces, sides));
    let of_edges = drawn.filter_map(|(ends, _)| projected.edge(faces, ends));
    let mut all = Vec::new();
    for ends in of_edges.filter(|e| e[0].at != e[1].at).chain(marks(faces, projected)) {
        let ends = ends.map(|v| v.at);
        t.step(|| Step::Edge(ends.map(|p| projected.page.plane_from_grid(p))));
        all.push(piece(ends));
    }
    Pieces { all, ..Pieces::default() }
}

fn inside_polygon(faces: &Faces, sides: &[EdgeSide]) -> bool {
    let item = |i: usize| sides.get(i).map_or(NO_ITEM, |s| s.item());
    sides.len() == 2 && faces.same_polygon(item(0), item(1))
}
