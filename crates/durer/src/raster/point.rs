//! Points in pixels: squares of whole pixels, and smooth discs.
//!
//! M. Segal, K. Akeley, *The OpenGL Graphics System: A Specification*, 1992, section 3.3. Image space. A square has its
//! size rounded, and its centre moved: to the middle of a pixel for odd sizes, to a corner of pixels for even ones. A
//! disc keeps its place and its size; each pixel gets the exact area of the disc in it. A point whose centre is outside
//! of the window is left out as a whole; the others are drawn as a whole, beyond the window's borders, too.
//!
//! Deviations: rows may count downwards, so a centre on the border of two rows belongs to the one with the larger
//! number; one on the border at which the window ends belongs to its last pixels.

use super::line::projected;
use crate::info::{Class, Info, Occluder};
use crate::math::{DVec2, IVec2};
use crate::trace::{PseudocodeLine, Tracer};
use crate::view::window::PixelRect;

/// The facts of points as squares.
pub const INFO: Info = Info {
    name: "points",
    title: "Points as squares of pixels",
    authors: "M. Segal, K. Akeley",
    year: 1992,
    source: "The OpenGL Graphics System: A Specification",
    class: Class::ImageSpace,
    occluder: Occluder::None,
    coherence: &[],
    cost: "O(size²) pixels",
    limits: "sizes up to 256, rounded to whole pixels",
    pseudocode: &[
        "x, y ← the centre in window coordinates: columns and rows of pixels",
        "the centre is outside of the window: light nothing, even if the square reaches in; stop",
        "n ← the size, rounded, at least 1",
        "n odd: centre ← (⌊x⌋ + ½, ⌊y⌋ + ½), the middle of the pixel of (x, y)",
        "n even: centre ← (⌊x + ½⌋, ⌊y + ½⌋), the corner of pixels nearest to (x, y)",
        "for each of the n · n pixels around the centre:",
        "    light it, beyond the window, too",
        "// all have the depth, the colour and the texture coordinates of the centre",
    ],
};

/// The facts of points as discs.
pub const DISC: Info = Info {
    name: "smooth-points",
    title: "Points as smooth discs",
    cost: "O(size²) pixels, four arcs each",
    limits: "sizes up to 256",
    pseudocode: &[
        "x, y ← the centre in window coordinates: columns and rows of pixels",
        "the centre is outside of the window: light nothing, even if the disc reaches in; stop",
        "r ← half of the size; neither r nor the centre is rounded",
        "for each pixel of the columns ⌊x − r⌋ … ⌊x + r⌋ and the rows ⌊y − r⌋ … ⌊y + r⌋:",
        "    a ← 0; for each side AB of the pixel, counter-clockwise:",
        "        a ← a + the area of the triangle (x, y) A B within the circle, with the sign of its turn",
        "    a > 0: light the pixel with its alpha multiplied by a",
        "// the sum of all a is π r², wherever the centre is",
    ],
    ..INFO
};

/// The largest size of a point, in pixels: it bounds the pixels of one to 65,536.
pub const MAX_SIZE: f64 = 256.0;

/// Options for drawing a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// Side of the square or diameter of the disc in pixels; brought to 0 … [`MAX_SIZE`].
    pub size: f64,
    /// True for a disc by coverage, false for a square of whole pixels.
    pub smooth: bool,
    /// Window that the centre has to be in, its borders included; `None` = everywhere.
    pub window: Option<PixelRect>,
}

impl Default for Options {
    /// Returns the default: one pixel, everywhere.
    fn default() -> Self {
        Self { size: 1.0, smooth: false, window: None }
    }
}

/// Step of drawing a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step {
    /// The centre is outside of the window, or not finite: nothing is lit.
    Outside,
    /// The point is a square.
    Square {
        /// Columns and rows, the rounded size.
        side: i32,
        /// Centre of the square, in pixels.
        center: DVec2,
    },
    /// A pixel of a square is lit.
    Lit(IVec2),
    /// The point is a disc.
    Disc {
        /// Diameter, in pixels.
        diameter: f64,
    },
    /// A pixel is lit in part.
    Covered {
        /// Column and row.
        pixel: IVec2,
        /// Area of the disc in it, above 0, at most 1.
        area: f64,
    },
}

impl PseudocodeLine for Step {
    /// Returns the line of the pseudocode of [`INFO`] or [`DISC`] that runs, counted from 1.
    fn line(&self) -> usize {
        match self {
            Self::Outside => 2,
            Self::Disc { .. } => 3,
            Self::Square { side, .. } if side % 2 == 1 => 4,
            Self::Square { .. } => 5,
            Self::Lit(_) | Self::Covered { .. } => 7,
        }
    }
}

/// Returns the pixels that the steps light, with their coverage.
pub fn replay(steps: &[Step]) -> Vec<(IVec2, f64)> {
    let lit = |step: &Step| match *step {
        Step::Lit(pixel) => Some((pixel, 1.0)),
        Step::Covered { pixel, area } => Some((pixel, area)),
        Step::Outside | Step::Square { .. } | Step::Disc { .. } => None,
    };
    steps.iter().filter_map(lit).collect()
}

/// Calls `plot` for each pixel of a point with its coverage, row by row; squares cover their pixels wholly.
///
/// ```
/// use durer::math::{DVec2, IVec2};
/// use durer::raster::point::{Options, draw};
/// use durer::trace::NoTrace;
///
/// let mut pixels = Vec::new();
/// let options = Options { size: 2.0, ..Options::default() };
/// draw(DVec2::new(3.4, 1.6), &options, |pixel, _| pixels.push(pixel), &mut NoTrace);
/// // The nearest corner of pixels is (3, 2).
/// assert_eq!(pixels, [(2, 1), (3, 1), (2, 2), (3, 2)].map(|(x, y)| IVec2::new(x, y)));
/// ```
pub fn draw(
    center: DVec2,
    options: &Options,
    mut plot: impl FnMut(IVec2, f64),
    t: &mut impl Tracer<Step>,
) {
    let end = options.window.map_or(DVec2::INFINITY, |w| DVec2::new(w.x1().into(), w.y1().into()));
    let start =
        options.window.map_or(DVec2::NEG_INFINITY, |w| DVec2::new(w.x0().into(), w.y0().into()));
    let is_inside = center.cmpge(start).all() && center.cmple(end).all();
    if !is_inside || !center.is_finite() {
        t.step(|| Step::Outside);
        return;
    }
    if options.smooth {
        return disc(center, 0.5 * options.size.clamp(0.0, MAX_SIZE), plot, t);
    }
    let side = options.size.round().clamp(1.0, MAX_SIZE) as i32;
    let half = side / 2;
    let middle = if side % 2 == 1 {
        projected::pixel(center, end)
    } else {
        (center + 0.5).floor().as_ivec2()
    };
    t.step(|| {
        let center = middle.as_dvec2() + 0.5 * f64::from(side % 2);
        Step::Square { side, center }
    });
    let first = middle.saturating_sub(IVec2::splat(half));
    for (row, column) in (0..side).flat_map(|row| (0..side).map(move |column| (row, column))) {
        let pixel = first.saturating_add(IVec2::new(column, row));
        t.step(|| Step::Lit(pixel));
        plot(pixel, 1.0);
    }
}

/// Plots the pixels that a disc meets, with the disc's area in each.
fn disc(center: DVec2, radius: f64, mut plot: impl FnMut(IVec2, f64), t: &mut impl Tracer<Step>) {
    t.step(|| Step::Disc { diameter: 2.0 * radius });
    let first = (center - radius).floor().as_ivec2();
    let last = (center + radius).floor().as_ivec2();
    for (y, x) in (first.y..=last.y).flat_map(|y| (first.x..=last.x).map(move |x| (y, x))) {
        let pixel = IVec2::new(x, y);
        let area = area_in_pixel(center, radius, pixel);
        if area > 0.0 {
            t.step(|| Step::Covered { pixel, area });
            plot(pixel, area);
        }
    }
}

/// Returns the area of a disc in a pixel: the sum over its four sides of the area between the side and the centre of the
/// disc, as far as the disc reaches, with the sign of the turn.
fn area_in_pixel(center: DVec2, radius: f64, pixel: IVec2) -> f64 {
    let low = pixel.as_dvec2() - center;
    let corners = [low, low + DVec2::X, low + 1.0, low + DVec2::Y];
    let parts = (0..4).map(|k| area_of_side(corners[k], corners[(k + 1) % 4], radius));
    parts.sum::<f64>().clamp(0.0, 1.0)
}

/// Returns the area of the part of the triangle from the origin to a side that is within a circle around the origin;
/// negative where the side turns clockwise around the origin.
fn area_of_side(from: DVec2, to: DVec2, radius: f64) -> f64 {
    let sector = |a: DVec2, b: DVec2| 0.5 * radius * radius * libm::atan2(a.perp_dot(b), a.dot(b));
    let way = to - from;
    // The side is a unit long: its line is in the circle for t from −b − root to −b + root.
    let b = from.dot(way);
    let inside = b * b - (from.length_squared() - radius * radius);
    let root = inside.max(0.0).sqrt();
    let [enters, leaves] = [(-b - root).max(0.0), (-b + root).min(1.0)];
    if inside <= 0.0 || enters >= leaves {
        return sector(from, to);
    }
    let [a, b] = [enters, leaves].map(|t| from + way * t);
    sector(from, a) + 0.5 * a.perp_dot(b) + sector(b, to)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::trace::NoTrace;
    use std::f64::consts::PI;

    fn covered(center: DVec2, size: f64) -> Vec<(IVec2, f64)> {
        let mut pixels = Vec::new();
        let options = Options { size, smooth: true, window: None };
        draw(center, &options, |pixel, area| pixels.push((pixel, area)), &mut NoTrace);
        pixels
    }

    #[test]
    fn the_areas_of_a_disc_add_up_to_its_own() {
        for size in [0.1, 0.5, 1.0, 1.7, 2.0, 5.0, 31.3] {
            for k in 0..40 {
                let k = f64::from(k);
                let center = DVec2::new(40.0 + 0.173 * k, -7.0 - 0.25 * k);
                let sum: f64 = covered(center, size).iter().map(|(_, area)| area).sum();
                let own = PI * size * size / 4.0;
                assert!((sum - own).abs() < 1e-12 * (1.0 + own), "{size} at {center}: {sum}");
            }
        }
    }

    #[test]
    fn a_quarter_of_a_disc_is_in_each_pixel_around_a_corner() {
        let areas = covered(DVec2::new(2.0, 3.0), 1.0);
        assert_eq!(areas.len(), 4);
        assert!(areas.iter().all(|(_, area)| (area - PI / 16.0).abs() < 1e-15), "{areas:?}");
        // A disc around a pixel covers it; one within a pixel touches no other.
        assert_eq!(covered(DVec2::splat(0.5), 2.0)[4], (IVec2::ZERO, 1.0));
        assert_eq!(covered(DVec2::splat(0.5), 0.9).len(), 1);
    }
}
