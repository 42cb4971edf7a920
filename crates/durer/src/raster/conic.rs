//! Circles and ellipses in pixels by the midpoint method.
//!
//! Circles: J. E. Bresenham, *A linear algorithm for incremental digital display of circular arcs*, Communications of
//! the ACM 20(2), 1977, in the midpoint form of M. L. V. Pitteway, *Algorithm for drawing ellipses or hyperbolae with a
//! digital plotter*, Computer Journal 10(3), 1967. Ellipses: J. R. Van Aken, *An efficient ellipse-drawing algorithm*,
//! IEEE CG&A 4(9),
//! 1984. Class: image space. Cost: O(n) for n pixels, two or three integer additions each. d is the curve's equation at
//! the point midway between the two pixels that may come next: below 0 that point is inside, and the outer pixel is the
//! nearer one.
//!
//! Pixels come once each, by octants or quadrants mirrored; the centre is a pixel, radii are whole. Deviation: the tips
//! of ellipses so flat that their last rows have no step between them are drawn as the line that they are. Limits:
//! where an ellipse has rows of few pixels beside its tips, a pixel there may be the second nearest, as published.

use crate::info::{Class, Coherence, Info, Occluder};
use crate::math::IVec2;
use crate::trace::{PseudocodeLine, Tracer};
use crate::{Error, Result};

/// The facts of circles.
pub const CIRCLE: Info = Info {
    name: "midpoint-circle",
    title: "Midpoint circle",
    authors: "J. E. Bresenham; M. L. V. Pitteway",
    year: 1977,
    source: "A linear algorithm for incremental digital display of circular arcs, Communications of the ACM 20(2)",
    class: Class::ImageSpace,
    occluder: Occluder::None,
    coherence: &[Coherence::Edge],
    cost: "O(radius), two integer additions per step and eight pixels",
    limits: "a pixel as centre, an integer radius up to 2^20",
    pseudocode: &[
        "x ← 0, y ← r, d ← 1 − r",
        "while x ≤ y:",
        "    set the eight pixels (±x, ±y) and (±y, ±x)",
        "    // d < 0: the midpoint (x + 1, y − ½) lies inside the circle",
        "    if d < 0:",
        "        d ← d + 2x + 3",
        "    else:",
        "        d ← d + 2(x − y) + 5, y ← y − 1",
        "    x ← x + 1",
    ],
};

/// The facts of ellipses.
pub const INFO: Info = Info {
    name: "midpoint-ellipse",
    title: "Midpoint ellipse",
    authors: "J. R. Van Aken; M. L. V. Pitteway",
    year: 1984,
    source: "An efficient ellipse-drawing algorithm, IEEE Computer Graphics and Applications 4(9)",
    class: Class::ImageSpace,
    occluder: Occluder::None,
    coherence: &[Coherence::Edge],
    cost: "O(radii), three integer additions per step and four pixels",
    limits: "a pixel as centre, axes along rows and columns, integer radii up to 2^20",
    pseudocode: &[
        "x ← 0, y ← b, d ← b² − a²b + a²/4",
        "while b²(x + 1) < a²(y − ½):",
        "    set the four pixels (±x, ±y)",
        "    // flat part: the midpoint is (x + 1, y − ½)",
        "    if d < 0:",
        "        d ← d + b²(2x + 3)",
        "    else:",
        "        d ← d + b²(2x + 3) + a²(2 − 2y), y ← y − 1",
        "    x ← x + 1",
        "d ← b²(x + ½)² + a²(y − 1)² − a²b²",
        "while y ≥ 0:",
        "    set the four pixels (±x, ±y)",
        "    // steep part: the midpoint is (x + ½, y − 1)",
        "    if d < 0:",
        "        d ← d + b²(2x + 2) + a²(3 − 2y), x ← x + 1",
        "    else:",
        "        d ← d + a²(3 − 2y)",
        "    y ← y − 1",
    ],
};

/// The largest radius, in pixels: products of four of them fit i128 with room to spare, and time is bounded.
pub const MAX_RADIUS: u32 = 1 << 20;

/// Part of the curve that is being made.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum CurveRegion {
    /// The octant of a circle from the top to the diagonal.
    Octant,
    /// Part of an ellipse from the top to where the curve falls by 45°; x is stepped.
    Flat,
    /// The part from there to the right; y is stepped.
    Steep,
}

/// Step of the algorithm: a pixel of the part that is mirrored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Step {
    /// Part of the curve.
    pub region: CurveRegion,
    /// The pixel, seen from the centre, with y up.
    pub pixel: IVec2,
    /// The decision variable at the pixel; for ellipses multiplied by four, which makes it an integer. If it is
    /// negative, the next step is axial in the flat parts and diagonal in the steep one.
    pub d: i128,
}

impl PseudocodeLine for Step {
    /// Returns the line of the pseudocode that follows from the decision variable.
    fn line(&self) -> usize {
        match (self.region, self.d < 0) {
            (CurveRegion::Octant | CurveRegion::Flat, true) => 6,
            (CurveRegion::Octant | CurveRegion::Flat, false) => 8,
            (CurveRegion::Steep, true) => 15,
            (CurveRegion::Steep, false) => 17,
        }
    }
}

/// Returns the pixels that a list of steps leads to, seen from the centre, in no order.
pub fn replay(steps: &[Step]) -> Vec<IVec2> {
    let mut pixels = Vec::new();
    for step in steps {
        let at = (i64::from(step.pixel.x), i64::from(step.pixel.y));
        mirrored(at, step.region == CurveRegion::Octant, |x, y| {
            pixels.push(IVec2::new(x as i32, y as i32))
        });
    }
    pixels
}

/// Calls `plot` for the pixels of a circle, each once; those beyond i32 are left out.
///
/// ```
/// use durer::math::IVec2;
/// use durer::raster::conic::circle;
/// use durer::trace::NoTrace;
///
/// let mut pixels = Vec::new();
/// circle(IVec2::ZERO, 2, |p| pixels.push((p.x, p.y)), &mut NoTrace)?;
/// pixels.sort();
/// let left = [(-2, -1), (-2, 0), (-2, 1), (-1, -2), (-1, 2)];
/// assert_eq!(pixels[..5], left);
/// assert_eq!(pixels.len(), 12);
/// # Ok::<(), durer::Error>(())
/// ```
///
/// # Errors
/// [`Error::TooLarge`] for a radius above [`MAX_RADIUS`].
pub fn circle(
    center: IVec2,
    radius: u32,
    mut plot: impl FnMut(IVec2),
    t: &mut impl Tracer<Step>,
) -> Result<()> {
    let (mut x, mut y) = (0, checked(radius)?);
    let mut d = 1 - y;
    while x <= y {
        let pixel = IVec2::new(x as i32, y as i32);
        t.step(|| Step { region: CurveRegion::Octant, pixel, d: i128::from(d) });
        mirrored((x, y), true, |x, y| put(center, (x, y), &mut plot));
        if d < 0 {
            d += 2 * x + 3;
        } else {
            d += 2 * (x - y) + 5;
            y -= 1;
        }
        x += 1;
    }
    Ok(())
}

/// Calls `plot` for the pixels of an ellipse with its axes along rows and columns, each once; those beyond i32 are left
/// out. `radii` are half its width and half its height.
///
/// # Errors
/// [`Error::TooLarge`] for a radius above [`MAX_RADIUS`].
pub fn ellipse(
    center: IVec2,
    radii: [u32; 2],
    mut plot: impl FnMut(IVec2),
    t: &mut impl Tracer<Step>,
) -> Result<()> {
    let [a, b] = [checked(radii[0])?, checked(radii[1])?];
    let mut light = |region, (x, y): (i64, i64), d: i128| {
        t.step(|| Step { region, pixel: IVec2::new(x as i32, y as i32), d });
        mirrored((x, y), false, |x, y| put(center, (x, y), &mut plot));
    };
    let (aa, bb) = (i128::from(a) * i128::from(a), i128::from(b) * i128::from(b));
    let (mut x, mut y) = (0, b);
    let wide = |v: i64| i128::from(v);
    // Four times b²x² + a²y² − a²b² at (x + 1, y − ½).
    let mut d = 4 * bb - 4 * aa * wide(b) + aa;
    while 2 * bb * wide(x + 1) < aa * wide(2 * y - 1) {
        light(CurveRegion::Flat, (x, y), d);
        let inside = d < 0;
        d += 4 * bb * wide(2 * x + 3);
        if !inside {
            d += 8 * aa * wide(1 - y);
            y -= 1;
        }
        x += 1;
    }
    // The same at (x + ½, y − 1).
    let mut d = bb * wide(2 * x + 1).pow(2) + 4 * aa * wide(y - 1).pow(2) - 4 * aa * bb;
    while y >= 0 {
        light(CurveRegion::Steep, (x, y), d);
        if y == 0 {
            break;
        }
        let inside = d < 0;
        d += 4 * aa * wide(3 - 2 * y);
        if inside {
            d += 8 * bb * wide(x + 1);
            x += 1;
        }
        y -= 1;
    }
    // The rest of a flat tip.
    (x + 1..=a).for_each(|x| light(CurveRegion::Steep, (x, 0), d));
    Ok(())
}

fn checked(radius: u32) -> Result<i64> {
    if radius > MAX_RADIUS {
        let (value, limit) = (u64::from(radius), u64::from(MAX_RADIUS));
        return Err(Error::TooLarge { what: "radius in pixels", value, limit });
    }
    Ok(i64::from(radius))
}

/// Calls `f` for each of the different mirror images of a pixel.
fn mirrored((x, y): (i64, i64), octants: bool, mut f: impl FnMut(i64, i64)) {
    let mut four = |x: i64, y: i64| {
        f(x, y);
        if x != 0 {
            f(-x, y);
        }
        if y != 0 {
            f(x, -y);
        }
        if x != 0 && y != 0 {
            f(-x, -y);
        }
    };
    four(x, y);
    if octants && x != y {
        four(y, x);
    }
}

fn put(center: IVec2, (x, y): (i64, i64), plot: &mut impl FnMut(IVec2)) {
    let at = (i64::from(center.x) + x, i64::from(center.y) + y);
    if let (Ok(x), Ok(y)) = (i32::try_from(at.0), i32::try_from(at.1)) {
        plot(IVec2::new(x, y));
    }
}
