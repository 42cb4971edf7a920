//! Polygons by edge flags: the outline is marked in the plane, then each row is filled between marks.
//!
//! B. D. Ackland, N. H. Weste, *The edge flag algorithm — a fill method for raster scan displays*, IEEE Transactions on
//! Computers C-30(1), 1981. Each crossing of an edge with a row complements one flag; then a row is run through once,
//! and each flag turns a bit over that says whether pixels are inside. Class: image space. Cost: O(crossings + pixels
//! of the box); every pixel is touched once, which suits hardware. Coherence used: spans.
//!
//! Limits: the even-odd rule; a separate plane. Vertices are snapped to 1/256 of a pixel.
//!
//! Deviation: two crossings in one pixel complement its flag twice, so that thin parts vanish as they have no centre
//! inside; the paper's marks may be Bresenham's pixels, which also light parts outside.

use super::rows::for_each_crossing;
use crate::curve::Contours;
use crate::info::{Class, Coherence, Info, Occluder};
use crate::raster::span::Span;
use crate::target::Pixels;
use crate::trace::{PseudocodeLine, Tracer};

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "edge-flag",
    title: "Edge flag",
    authors: "B. D. Ackland, N. H. Weste",
    year: 1981,
    source: "The edge flag algorithm — a fill method for raster scan displays, IEEE Transactions on Computers C-30(1)",
    class: Class::ImageSpace,
    occluder: Occluder::None,
    coherence: &[Coherence::Span],
    cost: "O(c + p): c crossings of edges with rows, p pixels of the plane",
    limits: "the even-odd rule; needs a separate plane; vertices are snapped to 1/256 of a pixel",
    pseudocode: &[
        "clear the plane",
        "for each edge of the polygon, in any order:",
        "    for each row whose centre it crosses:",
        "        complement the flag of the first pixel right of the crossing",
        "for each row:",
        "    inside ← false",
        "    for each pixel from left to right:",
        "        its flag is set: inside ← not inside",
        "        the pixel ← inside",
    ],
};

/// Step of the algorithm.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Step {
    /// A flag is complemented.
    Flag {
        /// Column and row.
        pixel: [u32; 2],
        /// True if it is set now.
        set: bool,
    },
    /// A run of pixels between two flags is inside.
    Inside(Span),
}

impl PseudocodeLine for Step {
    fn line(&self) -> usize {
        match self {
            Self::Flag { .. } => 4,
            Self::Inside(_) => 9,
        }
    }
}

/// Sets the pixels of a plane to whether they are in a polygon, by the even-odd rule; contours count as closed, points
/// that are not finite are left out. Coordinates in pixels.
///
/// ```
/// use durer::curve::Contours;
/// use durer::math::DVec2;
/// use durer::raster::polygon::edge_flag::fill;
/// use durer::target::Pixels;
/// use durer::trace::NoTrace;
///
/// let triangle = Contours::polygon([(0.0, 0.0), (4.0, 0.0), (0.0, 4.0)].map(DVec2::from));
/// let mut plane = Pixels::new(4, 4, false);
/// fill(&triangle, &mut plane, &mut NoTrace);
/// assert_eq!(plane.row(1), [true, true, false, false]);
/// ```
pub fn fill(contours: &Contours, plane: &mut Pixels<bool>, t: &mut impl Tracer<Step>) {
    let size = (plane.width(), plane.height());
    plane.data_mut().fill(false);
    for_each_crossing(contours, size, |y, x| {
        // Crossings right of the last pixel begin nothing.
        if let Some(flag) = plane.row_mut(y).get_mut(x as usize) {
            *flag = !*flag;
            let set = *flag;
            t.step(|| Step::Flag { pixel: [x, y], set });
        }
    });
    for y in 0..size.1 {
        let (mut inside, mut first) = (false, 0);
        let row = plane.row_mut(y);
        for (x, pixel) in (0..).zip(row.iter_mut()) {
            if *pixel {
                inside = !inside;
                if inside {
                    first = x;
                } else {
                    t.step(|| Step::Inside(Span { y: y as i32, x0: first, x1: x }));
                }
            }
            *pixel = inside;
        }
        if inside {
            t.step(|| Step::Inside(Span { y: y as i32, x0: first, x1: size.0 as i32 }));
        }
    }
}

/// Returns a plane with the pixels that a list of steps leads to.
pub fn replay((width, height): (u32, u32), steps: &[Step]) -> Pixels<bool> {
    let mut plane = Pixels::new(width, height, false);
    for step in steps {
        if let Step::Inside(span) = step {
            let row = plane.row_mut(span.y as u32);
            row[span.x0 as usize..span.x1 as usize].fill(true);
        }
    }
    plane
}
