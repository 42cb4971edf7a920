//! Smooth thin lines: Wu's two pixels per step, Gupta and Sproull's filtered three, and the exact area
//! of a line one pixel wide.
//!
//! X. Wu, *An efficient antialiasing technique*, SIGGRAPH 1991. S. Gupta, R. F. Sproull, *Filtering edges
//! for gray-scale displays*, SIGGRAPH 1981. Class: image space. Cost: two or three pixels per step.
//! Limits: pixel end points; lines look thinner along diagonals with Wu's, as published.

use std::sync::OnceLock;

use super::Course;
use crate::curve::Contours;
use crate::info::{Class, Coherence, Info, Occluder, family};
use crate::math::{DVec2, IVec2};
use crate::trace::{PseudocodeLine, Tracer};

pub use super::Options;

/// The facts about Wu's lines.
pub const WU: Info = Info {
    name: "wu",
    title: "Wu's anti-aliased lines",
    authors: "X. Wu",
    year: 1991,
    source: "An efficient antialiasing technique, SIGGRAPH",
    class: Class::ImageSpace,
    occluder: Occluder::None,
    coherence: &[Coherence::Edge],
    cost: "O(n), two pixels per step",
    limits: "pixel end points; diagonal lines look thinner",
    pseudocode: &[
        "Δx ← x2 − x1, Δy ← y2 − y1",
        "if |Δy| > |Δx|: swap the roles of x and y",
        "for each x from x1 to x2:",
        "    y ← y1 + Δy / Δx · (x − x1)",
        "    d ← y − ⌊y⌋",
        "    // two pixels share the light by their distances d and 1 − d",
        "    set pixel (x, ⌊y⌋) to 1 − d",
        "    set pixel (x, ⌊y⌋ + 1) to d",
    ],
};

/// The facts about Gupta and Sproull's lines.
pub const INFO: Info = Info {
    name: "gupta-sproull",
    title: "Gupta–Sproull lines",
    authors: "S. Gupta, R. F. Sproull",
    year: 1981,
    source: "Filtering edges for gray-scale displays, SIGGRAPH",
    class: Class::ImageSpace,
    occluder: Occluder::None,
    coherence: &[Coherence::Edge],
    cost: "O(n), three pixels per step",
    limits: "pixel end points; ends are cut perpendicular to the longer axis",
    pseudocode: &[
        "table[k] ← volume of a cone of radius 1 over a line k/32 away",
        "Δx ← x2 − x1, Δy ← y2 − y1",
        "if |Δy| > |Δx|: swap the roles of x and y",
        "for each x from x1 to x2:",
        "    y ← y1 + Δy / Δx · (x − x1)",
        "    for each of the three pixels nearest to y in the column:",
        "        d ← perpendicular distance of its centre from the line",
        "        set the pixel to table[32 d]",
    ],
};

family! {
    /// The classical smooth lines.
    pub enum SmoothLine {
        /// Two pixels share each step by their distances.
        Wu => WU,
        /// Three pixels by a cone filter of radius 1 over a line one pixel wide.
        GuptaSproull => INFO,
    }
}

/// Step of the algorithm: the intensity of a pixel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Step {
    /// Column and row.
    pub pixel: IVec2,
    /// Distance of its centre from the line, in pixels: across the longer axis for Wu's, square to the line for
    /// Gupta's and Sproull's.
    pub distance: f64,
    /// Intensity 1 … 255.
    pub intensity: u8,
}

impl PseudocodeLine for Step {
    /// Returns the line of the pseudocode that sets a pixel; it is the same in both algorithms.
    fn line(&self) -> usize {
        8
    }
}

/// Calls `plot` with the pixels of the line between two pixels and their intensities 1 … 255.
pub fn draw(
    method: SmoothLine,
    from: IVec2,
    to: IVec2,
    options: &Options,
    mut plot: impl FnMut(IVec2, u8),
    t: &mut impl Tracer<Step>,
) {
    // Pixels beside the line may be in the window although the line is not: two pixels away where a tie goes the other
    // way.
    let reach = IVec2::splat(2);
    let wider =
        options.window.map(|(low, high)| (low.saturating_sub(reach), high.saturating_add(reach)));
    let course = Course::new(from, to, &Options { window: wider });
    let inside = |p: IVec2| {
        options.window.is_none_or(|(l, h)| p.x >= l.x && p.y >= l.y && p.x <= h.x && p.y <= h.y)
    };
    let across = if course.steep { IVec2::X } else { IVec2::Y } * course.sign.max(-1) as i32;
    let mut put = |pixel: IVec2, distance: f64, intensity: u8| {
        if intensity > 0 && inside(pixel) {
            t.step(|| Step { pixel, distance, intensity });
            plot(pixel, intensity);
        }
    };
    let (steps, rise) = (course.steps.max(1) as f64, course.rise as f64);
    let cosine = steps / (steps * steps + rise * rise).sqrt();
    for step in course.first..=course.last {
        // Distance across in 1/(2·steps), exact; ties cannot matter here.
        let twice = 2 * i128::from(step) * i128::from(course.rise);
        let distance = (twice / course.denominator()) as i64;
        let part = (twice % course.denominator()) as f64 / course.denominator() as f64;
        let pixel = course.pixel(step, distance);
        match method {
            SmoothLine::Wu => {
                let upper = (part * 255.0 + 0.5) as u8;
                put(pixel, part, 255 - upper);
                put(pixel.saturating_add(across), 1.0 - part, upper);
            }
            SmoothLine::GuptaSproull => {
                let nearest = if part > 0.5 { 1 } else { 0 };
                for k in nearest - 1..=nearest + 1 {
                    let away = (f64::from(k) - part).abs() * cosine;
                    put(pixel.saturating_add(across * k), away, filtered(away));
                }
            }
        }
    }
}

/// Steps of the filter table per pixel.
const TABLE_STEPS: usize = 32;

/// Returns the intensity of a pixel whose centre is `distance` pixels from the axis of a line one pixel wide.
fn filtered(distance: f64) -> u8 {
    static TABLE: OnceLock<Vec<u8>> = OnceLock::new();
    let table = TABLE.get_or_init(|| (0..=TABLE_STEPS * 3 / 2).map(cone_over_line).collect());
    table.get((distance * TABLE_STEPS as f64 + 0.5) as usize).copied().unwrap_or(0)
}

/// Returns the volume of a cone of radius 1 and volume 1 over the line, by the midpoint rule.
fn cone_over_line(step: usize) -> u8 {
    let distance = step as f64 / TABLE_STEPS as f64;
    let (cells, mut volume) = (128, 0.0);
    let at = |i: i32| (f64::from(i) + 0.5) / f64::from(cells) * 2.0 - 1.0;
    for u in (0..cells).map(at).filter(|u| (u - distance).abs() <= 0.5) {
        volume += (0..cells).map(at).map(|v| (1.0 - (u * u + v * v).sqrt()).max(0.0)).sum::<f64>();
    }
    let area = 4.0 / f64::from(cells * cells);
    (volume * area * 3.0 / std::f64::consts::PI * 255.0 + 0.5).min(255.0) as u8
}

/// Returns the outline of a straight line of the given width with butt ends, to be filled by
/// [`crate::raster::coverage::fill`]: the exact form of a smooth line. Empty for a line without length.
pub fn outline(from: DVec2, to: DVec2, width: f64) -> Contours {
    corners(from, to, width).map_or_else(Contours::new, Contours::polygon)
}

/// Returns the corners of that outline, around; `None` if it is empty.
pub(crate) fn corners(from: DVec2, to: DVec2, width: f64) -> Option<[DVec2; 4]> {
    let along = to - from;
    let length = along.length();
    if !(length.is_finite() && length > 0.0 && width.is_finite() && width > 0.0) {
        return None;
    }
    let side = along.perp() / length * (width / 2.0);
    Some([from + side, to + side, to - side, from - side])
}
