//! Interpolation as it is taught: at the corners, along the edges, then within each row.
//!
//! H. Gouraud, *Continuous Shading of Curved Surfaces*, IEEE Transactions on Computers C-20(6), 1971, for intensities;
//! B. T. Phong, *Illumination for Computer Generated Pictures*, CACM 18(6), 1975, for normals; with 1/w beside the
//! values, perspective-correct as in [`super`]. Class: image space. The method is in [`super`], which computes the same
//! from planes over the screen, faster.

use crate::math::{DVec2, DVec3, IVec2};
use crate::raster::triangle::Options;
use crate::trace::{PseudocodeLine, Tracer};
use crate::{Error, Result};

/// A corner of a triangle with the values to interpolate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Corner {
    /// Place on the screen, in pixels.
    pub at: DVec2,
    /// 1/w, positive; 1 for values that are to be linear on the screen.
    pub inv_w: f64,
    /// Value: an intensity, a colour, a normal, texture coordinates.
    pub value: DVec3,
}

/// Step of the algorithm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step {
    /// Both edges were interpolated at the centre of a row.
    Ends {
        /// Row.
        y: i32,
        /// Abscissas of their crossings with it, from left to right, in pixels.
        x: [f64; 2],
        /// 1/w there.
        inv_w: [f64; 2],
        /// Values divided by w there.
        over_w: [DVec3; 2],
    },
    /// A pixel between the edges got its value.
    Pixel {
        /// Column and row.
        pixel: IVec2,
        /// 1/w there.
        inv_w: f64,
        /// Value divided by w there.
        over_w: DVec3,
        /// The quotient of both.
        value: DVec3,
    },
}

impl PseudocodeLine for Step {
    /// Returns the line of the pseudocode of Gouraud's, Phong's and perspective-correct interpolation.
    fn line(&self) -> usize {
        match self {
            Self::Ends { .. } => 4,
            Self::Pixel { .. } => 6,
        }
    }
}

/// Returns the pixels and values that a list of steps leads to.
pub fn replay(steps: &[Step]) -> Vec<(IVec2, DVec3)> {
    let pixel = |step: &Step| match *step {
        Step::Pixel { pixel, value, .. } => Some((pixel, value)),
        Step::Ends { .. } => None,
    };
    steps.iter().filter_map(pixel).collect()
}

/// Values that are linear on the screen.
#[derive(Debug, Clone, Copy)]
struct Linear {
    at: DVec2,
    inv_w: f64,
    over_w: DVec3,
}

impl Linear {
    fn mix(&self, other: &Self, t: f64) -> Self {
        Self {
            at: self.at.lerp(other.at, t),
            inv_w: self.inv_w + (other.inv_w - self.inv_w) * t,
            over_w: self.over_w.lerp(other.over_w, t),
        }
    }
}

/// Calls `emit` with the values at the centres of the pixels of a triangle, row by row.
///
/// ```
/// use durer::math::{DVec2, DVec3};
/// use durer::raster::interpolate::rows::{Corner, interpolate};
/// use durer::raster::triangle::Options;
/// use durer::trace::NoTrace;
/// use durer::view::window::PixelRect;
///
/// let corner = |x, y, value| Corner { at: DVec2::new(x, y), inv_w: 1.0, value: DVec3::splat(value) };
/// let corners = [corner(0.0, 0.0, 0.0), corner(4.0, 0.0, 4.0), corner(0.0, 4.0, 0.0)];
/// let mut row = Vec::new();
/// let options = Options { clip: PixelRect::spanning(0, 0, 4, 1) };
/// interpolate(&corners, &options, |p, value| row.push((p.x, value.x)), &mut NoTrace)?;
/// assert_eq!(row, [(0, 0.5), (1, 1.5), (2, 2.5)]);
/// # Ok::<(), durer::Error>(())
/// ```
///
/// # Errors
/// [`Error::NonFinite`] for corners that are not finite; [`Error::Parameter`] for 1/w that is not positive.
pub fn interpolate(
    corners: &[Corner; 3],
    options: &Options,
    mut emit: impl FnMut(IVec2, DVec3),
    t: &mut impl Tracer<Step>,
) -> Result<()> {
    check(corners)?;
    let linear = corners.map(|c| Linear { at: c.at, inv_w: c.inv_w, over_w: c.value * c.inv_w });
    let clip = &options.clip;
    let heights = corners.map(|c| c.at.y);
    let [low, high] = [
        heights.into_iter().fold(f64::INFINITY, f64::min),
        heights.into_iter().fold(f64::NEG_INFINITY, f64::max),
    ];
    let within = |y: f64, low: i32, high: i32| y.clamp(low.into(), high.into()) as i32;
    let first = within((low - 0.5).ceil(), clip.y0(), clip.y1());
    let last = within((high - 0.5).ceil(), clip.y0(), clip.y1());
    for y in first..last {
        let Some([left, right]) = crossings(&linear, f64::from(y) + 0.5) else { continue };
        t.step(|| Step::Ends {
            y,
            x: [left.at.x, right.at.x],
            inv_w: [left.inv_w, right.inv_w],
            over_w: [left.over_w, right.over_w],
        });
        let from = within((left.at.x - 0.5).ceil(), clip.x0(), clip.x1());
        let to = within((right.at.x - 0.5).ceil(), clip.x0(), clip.x1());
        for x in from..to {
            let share = (f64::from(x) + 0.5 - left.at.x) / (right.at.x - left.at.x);
            let Linear { inv_w, over_w, .. } = left.mix(&right, share);
            let (pixel, value) = (IVec2::new(x, y), over_w / inv_w);
            t.step(|| Step::Pixel { pixel, inv_w, over_w, value });
            emit(pixel, value);
        }
    }
    Ok(())
}

fn check(corners: &[Corner; 3]) -> Result<()> {
    let finite = |c: &Corner| c.at.is_finite() && c.value.is_finite() && c.inv_w.is_finite();
    if let Some(index) = corners.iter().position(|c| !finite(c)) {
        return Err(Error::NonFinite { what: "corner", index });
    }
    match corners.iter().find(|c| c.inv_w <= 0.0) {
        Some(corner) => Err(Error::parameter("1/w", corner.inv_w, "above 0")),
        None => Ok(()),
    }
}

/// Returns the points at which a row's centre crosses two edges, from left to right; the upper end of an edge belongs
/// to it.
fn crossings(corners: &[Linear; 3], y: f64) -> Option<[Linear; 2]> {
    let [a, b, c] = corners;
    let mut found = [(a, b), (b, c), (c, a)].into_iter().filter_map(|(from, to)| {
        let crosses = (from.at.y <= y) != (to.at.y <= y);
        // Downwards always, so that neighbours find the same.
        let (from, to) = if from.at.y < to.at.y { (from, to) } else { (to, from) };
        crosses.then(|| from.mix(to, (y - from.at.y) / (to.at.y - from.at.y)))
    });
    let (one, other) = (found.next()?, found.next()?);
    Some(if one.at.x <= other.at.x { [one, other] } else { [other, one] })
}
