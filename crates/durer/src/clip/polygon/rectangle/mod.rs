//! The production rectangle clip for windows and map tiles: polygons with holes, and polylines.
//!
//! The reassembly follows Weiler and Atherton ("Hidden surface removal using polygon area sorting", SIGGRAPH 1977) with
//! a rectangle as the clip polygon: the parts of all rings inside the open window are chains that begin and end on its
//! border; walking the border counter-clockwise from the end of each to the beginning of the next closes them to rings.
//! Separate parts become separate rings, edges run along the border only where the shape does, and a corner appears
//! only if the shape covers it. The order of chain ends on the border is decided exactly.
//!
//! Object space. O(n) for n vertices, plus O(k log k) for k border crossings; bounding boxes accept
//! and reject first.
//!
//! Input polygons must be valid (simple rings, holes inside the outer ring, interiors connected); the direction of
//! rings does not matter. Invalid polygons cause no panic, but the region is unspecified. Where rings of valid polygons
//! touch one another the region is right, but a ring may touch itself there. Polygons wholly in the closed window are
//! copied bit for bit; clipped ones have counter-clockwise outer rings and clockwise holes (y up).

mod border;
mod lines;
mod near;
mod prepared;
mod rings;
pub(super) mod tree;

pub use lines::{ClippedLines, clip_lines};
pub(crate) use near::Near;
pub use prepared::Prepared;

use super::Shapes;
use crate::clip::attribute::{NoSources, Provenance, VertexSource};
use crate::info::{Class, Info, Occluder};
use crate::math::{DVec2, Rect};
use crate::trace::{PseudocodeLine, Tracer};
use crate::{Error, Result};
use rings::{Clipper, Unprepared};

/// The facts of the rectangle clip.
pub const INFO: Info = Info {
    name: "rectangle",
    title: "Rectangle clip",
    authors: "Kevin Weiler, Peter Atherton",
    year: 1977,
    source: "Hidden surface removal using polygon area sorting, SIGGRAPH; clip polygon a rectangle",
    class: Class::ObjectSpace,
    occluder: Occluder::None,
    coherence: &[],
    cost: "O(n + k log k), n vertices, k border crossings",
    limits: "axis-parallel windows; valid polygons, whose rings do not touch one another",
    pseudocode: &[
        "for each polygon:",
        "    its box in the window: copy it",
        "    its box beside the window: leave it out",
        "    for each ring: find the chains inside, from entry to exit",
        "    sort entries and exits counter-clockwise round the window",
        "    while a chain is left: begin a ring with it",
        "        emit its vertices, and the window's corners up to the next entry",
        "        follow the chain of that entry; the first one again: the ring is complete",
        "    give each hole to the ring around it: the polygon is complete",
    ],
};

/// Empty options: the algorithm has none.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Options;

/// Step of the algorithm; vertices are reported as they are added to the output.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step {
    /// A polygon's bounding box is in the window: the polygon is copied.
    Inside {
        /// Its index in the input.
        polygon: usize,
    },
    /// A polygon's bounding box misses the window.
    Outside {
        /// Its index in the input.
        polygon: usize,
    },
    /// A part of a ring inside the window was found, between two points of the border.
    Chain {
        /// Point at which it enters.
        entry: DVec2,
        /// Point at which it leaves.
        exit: DVec2,
    },
    /// A vertex of the ring being output.
    Vertex {
        /// Position of the vertex.
        point: DVec2,
    },
    /// The ring is complete.
    RingDone,
    /// The polygon is complete.
    PolygonDone,
}

impl PseudocodeLine for Step {
    fn line(&self) -> usize {
        match self {
            Self::Inside { .. } => 2,
            Self::Outside { .. } => 3,
            Self::Chain { .. } => 4,
            Self::Vertex { .. } => 7,
            Self::RingDone => 8,
            Self::PolygonDone => 9,
        }
    }
}

/// Returns the result that a list of steps leads to.
pub fn replay(input: &Shapes, steps: &[Step]) -> Shapes {
    let (mut output, mut ring) = (Shapes::new(), Vec::new());
    for step in steps {
        match *step {
            Step::Inside { polygon } => {
                for source in input.polygons().nth(polygon).iter().flat_map(|p| p.rings()) {
                    output.push_ring(source.iter().copied());
                }
                output.end_polygon();
            }
            Step::Outside { .. } | Step::Chain { .. } => {}
            Step::Vertex { point } => ring.push(point),
            Step::RingDone => output.push_ring(ring.drain(..)),
            Step::PolygonDone => output.end_polygon(),
        }
    }
    output
}

/// Returns the part of all polygons in the window; regions only, so parts without area are dropped.
///
/// ```
/// use durer::clip::polygon::{Shapes, rectangle};
/// use durer::math::{DVec2, Rect};
/// use durer::trace::NoTrace;
///
/// // A U whose arms reach into the window from below gives two rings, and no edge between them.
/// let p = DVec2::new;
/// let u = [p(0., 0.), p(5., 0.), p(5., 5.), p(4., 5.), p(4., 1.), p(1., 1.), p(1., 5.), p(0., 5.)];
/// let window = Rect::new(p(-1.0, 2.0), p(6.0, 4.0))?;
/// let shapes = Shapes::from_rings([&u[..]]);
/// let clipped = rectangle::clip(&window, &shapes, &rectangle::Options, &mut NoTrace)?;
/// assert_eq!((clipped.polygon_count(), clipped.area()), (2, 4.0));
/// # Ok::<(), durer::Error>(())
/// ```
///
/// # Errors
/// [`Error::NonFinite`] names the first point with a NaN or infinite coordinate.
pub fn clip(
    window: &Rect,
    shapes: &Shapes,
    _options: &Options,
    t: &mut impl Tracer<Step>,
) -> Result<Shapes> {
    run::<NoSources>(window, shapes, t).map(|(clipped, _)| clipped)
}

/// Clips polygons as [`clip`], and returns the source of every output vertex, from which attributes are interpolated by
/// [`crate::clip::attribute::interpolate`].
///
/// # Errors
/// As [`clip`].
pub(crate) fn clip_with_sources(
    window: &Rect,
    shapes: &Shapes,
    _options: &Options,
    t: &mut impl Tracer<Step>,
) -> Result<(Shapes, Vec<VertexSource>)> {
    run(window, shapes, t)
}

fn run<P: Provenance>(
    window: &Rect,
    shapes: &Shapes,
    t: &mut impl Tracer<Step>,
) -> Result<(Shapes, P)> {
    let mut clipper = Clipper::<P>::new(window);
    for (index, polygon) in shapes.polygons().enumerate() {
        let rings = polygon.ring_indices();
        match extent(window, polygon.outer()) {
            Extent::Outside => t.step(|| Step::Outside { polygon: index }),
            Extent::Inside => {
                t.step(|| Step::Inside { polygon: index });
                clipper.copy(shapes, rings);
            }
            Extent::Crossing => {
                let (outer, holes) = (rings.start, rings.start + 1..rings.end);
                let near = |&hole: &usize| extent(window, shapes.ring(hole)) != Extent::Outside;
                let rings = std::iter::once(outer).chain(holes.filter(near));
                clipper.cut(shapes, rings, &Unprepared, t);
            }
            Extent::NonFinite => return Err(non_finite(shapes.points())),
        }
    }
    Ok(clipper.finish())
}

/// Relation of a bounding box to the window.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Extent {
    Inside,
    Outside,
    Crossing,
    NonFinite,
}

/// The box around some points; `zero` is not zero if one of them is not finite.
#[derive(Debug, Clone, Copy)]
struct Bounds {
    min: DVec2,
    max: DVec2,
    zero: DVec2,
}

impl Bounds {
    #[inline(always)]
    fn add(&mut self, p: DVec2) {
        let (min, max) = (self.min, self.max);
        self.min.x = if p.x < min.x { p.x } else { min.x };
        self.min.y = if p.y < min.y { p.y } else { min.y };
        self.max.x = if p.x > max.x { p.x } else { max.x };
        self.max.y = if p.y > max.y { p.y } else { max.y };
        self.zero += p * 0.0;
    }
}

fn extent(window: &Rect, points: &[DVec2]) -> Extent {
    let Some(&first) = points.first() else { return Extent::Outside };
    // Four at a time, so that no comparison waits for the one before.
    let mut four = [Bounds { min: first, max: first, zero: DVec2::ZERO }; 4];
    let (chunks, rest) = points.as_chunks::<4>();
    for chunk in chunks {
        four.iter_mut().zip(chunk).for_each(|(bounds, &p)| bounds.add(p));
    }
    let [mut all, others @ ..] = four;
    rest.iter().for_each(|&p| all.add(p));
    for other in others {
        all.add(other.min);
        all.add(other.max);
        all.zero += other.zero;
    }
    let Bounds { min, max, zero } = all;
    let (low, high) = (window.min(), window.max());
    if zero != DVec2::ZERO {
        Extent::NonFinite
    } else if max.x < low.x || max.y < low.y || min.x > high.x || min.y > high.y {
        Extent::Outside
    } else if min.cmpge(low).all() && max.cmple(high).all() {
        Extent::Inside
    } else {
        Extent::Crossing
    }
}

#[cold]
fn non_finite(points: &[DVec2]) -> Error {
    let index = points.iter().position(|p| !p.is_finite()).unwrap_or(0);
    Error::NonFinite { what: "point", index }
}

#[cfg(test)]
mod tests;
