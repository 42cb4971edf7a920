//! Floating horizon: the visible lines of a surface y = f(x, z), drawn from front to back.
//!
//! T. J. Wright, *A Two-Space Solution to the Hidden Line Problem for Plotting Functions of Two
//! Variables*, IEEE Transactions on Computers C-22 (1), 1973; H. Williamson, *Algorithm 420: Hidden-Line
//! Plotting Program*, CACM 15 (2), 1972; both families of lines in one pass by cells, after
//! D. P. Anderson, *Hidden Line Elimination in Projected Grid Surfaces*, ACM Transactions on Graphics
//! 1 (4), 1982.
//!
//! - **Class**: object space. Horizons are piecewise linear functions made of the surface's own edges;
//!   crossings are interpolated; no pixels, no sampling.
//! - **Cost**: O(n h) for n cells, h the pieces of the horizon over one cell (a few), after O(n) for
//!   projecting. Memory O(n).
//! - **Limits**: one height per point of the grid. Horizons know that a line is hidden, not how often:
//!   hidden lines count one surface in front of them. Parts between the eye and the near plane hide others
//!   all the same.
//! - **Deviations**: cells are two triangles each, whose union is the covered area, so the result is
//!   that of a visible-surface algorithm on [`HeightField::to_mesh`]. Missing points leave gaps between
//!   parts of the surface, so there are several pairs of horizons over a column. In perspective, columns
//!   are planes through the vertical line of the eye, so the eye may have any position and direction,
//!   also inside or below the surface.

mod chain;
mod horizon;
mod sight;
mod strip;
mod walk;

pub use chain::projected;

use crate::info::{Class, Coherence, Info, Occluder};
use crate::math::DVec3;
use crate::scene::{Camera, HeightField};
use crate::target::drawing::{Drawing, Line, LineClass};
use crate::trace::Tracer;
use crate::view::picture_plane::PicturePlane;
use crate::{Error, Result};

/// The facts of the floating horizon.
pub const INFO: Info = Info {
    name: "floating-horizon",
    title: "Floating horizon",
    authors: "T. J. Wright",
    year: 1973,
    source: "A Two-Space Solution to the Hidden Line Problem for Plotting Functions of Two Variables, IEEE Transactions on Computers C-22 (1)",
    class: Class::ObjectSpace,
    occluder: Occluder::Line,
    coherence: &[Coherence::Edge],
    cost: "O(n h) for n cells, h the pieces of the horizon over one cell",
    limits: "surfaces y = f(x, z) over a grid",
    pseudocode: &[],
};

/// Family of lines of a surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum LineFamily {
    /// Lines along x, on each of which z is constant.
    AlongX,
    /// Lines along z, on each of which x is constant.
    AlongZ,
}

/// Options for the lines to draw.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Options {
    /// Draw each so-manieth row of the grid, and the last; 0 draws none. Cost does not follow it: the
    /// whole surface hides.
    pub every_row: usize,
    /// Draw each so-manieth column of the grid, and the last; 0 draws none.
    pub every_column: usize,
    /// True to report hidden pieces, too.
    pub hidden: bool,
}

impl Default for Options {
    /// Returns all lines, visible pieces only.
    fn default() -> Self {
        Self { every_row: 1, every_column: 1, hidden: false }
    }
}

/// A piece of a grid line between two neighbouring points of the grid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LinePiece {
    /// Its family.
    pub family: LineFamily,
    /// The row or column along which it runs.
    pub line: usize,
    /// The point of that line before the piece, from 0.
    pub segment: usize,
    /// Start and end, 0 … 1 from that point to the next.
    pub range: [f64; 2],
    /// True if it is seen.
    pub visible: bool,
    /// True if the surface in front of it shows its lower side to the eye.
    pub underside: bool,
}

/// Step of the algorithm: the pieces are the result, the triangles move the horizon.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step {
    /// A piece of a line was found to be visible or hidden.
    Piece(LinePiece),
    /// A triangle, with corners in the field's coordinates, was added to the covered area.
    Cover([DVec3; 3]),
}

/// A chain of pieces of one grid line, all visible or all hidden.
#[derive(Debug, Clone, PartialEq)]
pub struct GridChain {
    /// Its family.
    pub family: LineFamily,
    /// The row or column along which it runs.
    pub line: usize,
    /// True if it is seen.
    pub visible: bool,
    /// True if the surface in front of it shows its lower side to the eye.
    pub underside: bool,
    /// Points, at least two, in the field's coordinates, in ascending x or z.
    pub points: Vec<DVec3>,
}

/// Returns the visible (and hidden) parts of the lines of a surface, in the field's own coordinates:
/// rows first, then columns, each from its start to its end.
///
/// A line that lies exactly on another in the picture counts as hidden by it.
///
/// # Errors
/// The errors of [`Camera::check`].
pub fn curves(
    field: &HeightField,
    camera: &Camera,
    options: &Options,
    t: &mut impl Tracer<Step>,
) -> Result<Vec<GridChain>> {
    camera.check()?;
    let pieces = walk::pieces(field, camera, options, t);
    Ok(chain::curves(field, pieces))
}

/// Returns the columns and the rows of a field's cells, each nearest first: in the order of rows, and of
/// columns in each row, no cell is hidden by one that comes later.
pub(crate) fn front_to_back(field: &HeightField, camera: &Camera) -> [Vec<usize>; 2] {
    let middle = field.bounds().map_or(DVec3::ZERO, |b| b.center());
    let sight = sight::Sight::new(camera, middle);
    [sight.order(field, 0, middle.x), sight.order(field, 2, middle.z)]
}

/// Draws a surface: its lines as [`LineClass::Grid`] on the plane of the picture. Hidden pieces, where
/// requested, have invisibility 1, however many layers of the surface hide them.
///
/// ```
/// use durer::math::DVec3;
/// use durer::scene::{Camera, HeightField, Projection};
/// use durer::trace::NoTrace;
/// use durer::visibility::line::floating_horizon::{Options, draw};
///
/// // A ridge: the slope behind its crest is invisible.
/// let ridge = HeightField::from_fn([2, 3], [0.0, 1.0], [-1.0, 1.0], |_, z| 1.0 - z.abs())?;
/// let camera = Camera {
///     eye: DVec3::new(0.5, 0.5, 9.0),
///     target: DVec3::new(0.5, 0.5, 0.0),
///     up: DVec3::Y,
///     projection: Projection::Orthographic { height: 2.0 },
///     near: 1.0,
///     far: 20.0,
/// };
/// let drawing = draw(&ridge, &camera, &Options::default(), &mut NoTrace)?;
/// // The front edge, the crest, and two lines up to it.
/// assert_eq!(drawing.lines.len(), 4);
/// assert!((drawing.length(|_| true) - 4.0).abs() < 1e-12);
/// # Ok::<(), durer::Error>(())
/// ```
///
/// # Errors
/// The errors of [`Camera::check`]; [`Error::NonFinite`] where the projection overflows.
pub fn draw(
    field: &HeightField,
    camera: &Camera,
    options: &Options,
    t: &mut impl Tracer<Step>,
) -> Result<Drawing> {
    let plane = PicturePlane::of_camera(camera, 1.0)?;
    let curves = curves(field, camera, options, t)?;
    let mut lines = Vec::with_capacity(curves.len());
    for (index, curve) in curves.iter().enumerate() {
        let invisibility = u32::from(!curve.visible);
        for points in chain::projected(&curve.points, &plane) {
            if points.iter().any(|p| !p.is_finite()) {
                return Err(Error::NonFinite { what: "projected line", index });
            }
            lines.push(Line { class: LineClass::Grid, invisibility, points, closed: false });
        }
    }
    Ok(Drawing { lines, ..Drawing::default() })
}
