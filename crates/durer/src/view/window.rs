//! Windows in the world and viewports on the screen.
//!
//! The window-to-viewport transformation of Newman & Sproull, *Principles of Interactive Computer
//! Graphics* (1973): x' = a·x + b and y' = c·y + d, with a … d computed once.

use crate::math::{DVec2, Rect};
use crate::{Error, Result};

/// Rectangle of the pixels x0 … x1 − 1 of rows y0 … y1 − 1; y grows downwards. May be empty.
///
/// # Guarantees
/// `x0 ≤ x1` and `y0 ≤ y1`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct PixelRect {
    min: [i32; 2],
    max: [i32; 2],
}

impl PixelRect {
    /// All pixels with i32 coordinates, except the last row and column.
    pub const EVERYTHING: Self = Self { min: [i32::MIN; 2], max: [i32::MAX; 2] };

    /// Creates a rectangle of pixels from its first column and row and its last ones, which are exclusive.
    ///
    /// # Errors
    /// [`Error::Parameter`] if `x0 > x1` or `y0 > y1`.
    pub fn new(x0: i32, y0: i32, x1: i32, y1: i32) -> Result<Self> {
        if x0 <= x1 && y0 <= y1 {
            Ok(Self { min: [x0, y0], max: [x1, y1] })
        } else {
            let value = format!("{x0},{y0} … {x1},{y1}");
            Err(Error::parameter("pixel rectangle", value, "not reversed"))
        }
    }

    /// Returns the rectangle of all pixels of a picture, from the origin.
    ///
    /// # Errors
    /// [`Error::TooLarge`] for a side above 2³¹ − 1.
    pub fn of_size(width: u32, height: u32) -> Result<Self> {
        let side = |value: u32| {
            let limit = i32::MAX as u64;
            i32::try_from(value).map_err(|_| Error::TooLarge {
                what: "number of pixels a side",
                value: value.into(),
                limit,
            })
        };
        Ok(Self { min: [0; 2], max: [side(width)?, side(height)?] })
    }

    /// Returns the rectangle between two corners, empty if they are reversed.
    pub fn spanning(x0: i32, y0: i32, x1: i32, y1: i32) -> Self {
        Self { min: [x0, y0], max: [x1.max(x0), y1.max(y0)] }
    }

    /// Returns the first column.
    pub fn x0(&self) -> i32 {
        self.min[0]
    }

    /// Returns the first row.
    pub fn y0(&self) -> i32 {
        self.min[1]
    }

    /// Returns the last column, exclusive.
    pub fn x1(&self) -> i32 {
        self.max[0]
    }

    /// Returns the last row, exclusive.
    pub fn y1(&self) -> i32 {
        self.max[1]
    }

    /// Returns the number of columns.
    pub fn width(&self) -> u32 {
        self.max[0].abs_diff(self.min[0])
    }

    /// Returns the number of rows.
    pub fn height(&self) -> u32 {
        self.max[1].abs_diff(self.min[1])
    }

    /// Returns whether the rectangle has no pixels.
    pub fn is_empty(&self) -> bool {
        self.min[0] == self.max[0] || self.min[1] == self.max[1]
    }

    /// Returns whether the pixel is in the rectangle.
    pub fn contains(&self, x: i32, y: i32) -> bool {
        (self.min[0]..self.max[0]).contains(&x) && (self.min[1]..self.max[1]).contains(&y)
    }

    /// Returns the pixels in both rectangles; if there are none, some empty rectangle.
    pub fn intersection(&self, other: &Self) -> Self {
        let lo = [0, 1].map(|k| self.min[k].max(other.min[k]));
        let hi = [0, 1].map(|k| self.max[k].min(other.max[k]));
        Self::spanning(lo[0], lo[1], hi[0], hi[1])
    }
}

/// Closed rectangle of the world with an area; y grows upwards.
///
/// # Guarantees
/// Finite, `left < right`, `bottom < top`, no coordinate beyond ± 10¹⁰⁰ and no extent below 10⁻¹⁰⁰, so that neither
/// scales nor their ratio overflow.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Window {
    rect: Rect,
}

/// Limit on coordinates: beyond it, and for extents below its inverse, scales times extents leave the range of f64.
const WINDOW_LIMIT: f64 = 1e100;

impl Window {
    /// Creates the window from `left` to `right` and from `bottom` to `top`, in world units.
    ///
    /// # Errors
    /// [`Error::Parameter`] for a number that is NaN, infinite or beyond ± 10¹⁰⁰, and for a window
    /// that is reversed, empty or narrower than 10⁻¹⁰⁰.
    pub fn new(left: f64, right: f64, bottom: f64, top: f64) -> Result<Self> {
        let all = [left, right, bottom, top];
        let sound = all.iter().all(|v| v.abs() <= WINDOW_LIMIT)
            && right - left >= WINDOW_LIMIT.recip()
            && top - bottom >= WINDOW_LIMIT.recip();
        if !sound {
            // As Debug, which does not write out hundreds of digits.
            let value = format!("{left:?} … {right:?} × {bottom:?} … {top:?}");
            let expected = "within ±10¹⁰⁰, with left < right and bottom < top by 10⁻¹⁰⁰ or more";
            return Err(Error::parameter("window", value, expected));
        }
        Ok(Self { rect: Rect::new(DVec2::new(left, bottom), DVec2::new(right, top))? })
    }

    /// Returns the window as a closed rectangle, for clipping.
    pub fn rect(&self) -> &Rect {
        &self.rect
    }
}

/// Rectangle of pixels to draw in.
///
/// # Guarantees
/// Not empty.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Viewport {
    pixels: PixelRect,
}

impl Viewport {
    /// Creates a viewport from its pixels.
    ///
    /// # Errors
    /// [`Error::Parameter`] for a rectangle without pixels.
    pub fn new(pixels: PixelRect) -> Result<Self> {
        if pixels.is_empty() {
            let value = format!("{}x{}", pixels.width(), pixels.height());
            return Err(Error::parameter("viewport", value, "at least 1x1"));
        }
        Ok(Self { pixels })
    }

    /// Returns the pixels of the viewport.
    pub fn pixels(&self) -> &PixelRect {
        &self.pixels
    }
}

/// Treatment of a window and a viewport of different shape.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Aspect {
    /// Separate scales for the axes; corners map to corners.
    #[default]
    Stretch,
    /// One scale for both axes; all of the window is visible, in the middle of the viewport.
    Fit,
    /// One scale for both axes; all of the viewport is filled, with the middle of the window.
    Fill,
}

/// Direction of y on the screen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum YAxis {
    /// Downwards: y is flipped, as the top of the window is row 0.
    #[default]
    Down,
    /// Upwards: the bottom of the window is row 0, for framebuffers with the origin at the bottom left.
    Up,
}

/// The mapping from a window to a viewport and back.
///
/// Coefficients have twice the precision of f64, and x is measured from a corner of the window. So corners map to
/// corners exactly, and the inverse returns within 1 ulp of the extent, even for a small window far from the origin.
///
/// ```
/// use durer::math::DVec2;
/// use durer::view::window::*;
/// let window = Window::new(-2.0, 2.0, -1.0, 1.0).unwrap();
/// let viewport = Viewport::new(PixelRect::of_size(640, 480).unwrap()).unwrap();
/// let map = WindowToViewport::new(&window, &viewport, Aspect::Fit, YAxis::Down);
/// assert_eq!(map.to_screen(DVec2::new(-2.0, 1.0)), DVec2::new(0.0, 80.0));
/// assert_eq!(map.coefficients(), [160.0, 320.0, -160.0, 240.0]);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WindowToViewport {
    x: Axis,
    y: Axis,
}

impl WindowToViewport {
    /// Creates the mapping of `window` to `viewport`.
    pub fn new(window: &Window, viewport: &Viewport, aspect: Aspect, y_axis: YAxis) -> Self {
        let (lo, hi, p) = (window.rect.min(), window.rect.max(), &viewport.pixels);
        let x = Axis::stretched([lo.x, hi.x], [p.x0().into(), p.x1().into()]);
        let rows = match y_axis {
            YAxis::Down => [p.y1().into(), p.y0().into()],
            YAxis::Up => [p.y0().into(), p.y1().into()],
        };
        let y = Axis::stretched([lo.y, hi.y], rows);
        let x_is_smaller = x.scale.hi < y.scale.hi.abs();
        match aspect {
            Aspect::Stretch => Self { x, y },
            Aspect::Fit | Aspect::Fill if x_is_smaller == (aspect == Aspect::Fit) => {
                Self { x, y: y.rescaled(&x, [lo.y, hi.y], rows) }
            }
            Aspect::Fit | Aspect::Fill => {
                let columns = [p.x0().into(), p.x1().into()];
                Self { x: x.rescaled(&y, [lo.x, hi.x], columns), y }
            }
        }
    }

    /// Converts world coordinates to screen coordinates in pixels.
    pub fn to_screen(&self, world: DVec2) -> DVec2 {
        DVec2::new(self.x.forward(world.x), self.y.forward(world.y))
    }

    /// Converts screen coordinates in pixels to world coordinates.
    pub fn to_world(&self, screen: DVec2) -> DVec2 {
        DVec2::new(self.x.backward(screen.x), self.y.backward(screen.y))
    }

    /// Returns the coefficients a, b, c, d of x' = a·x + b and y' = c·y + d, rounded to f64.
    pub fn coefficients(&self) -> [f64; 4] {
        let b = |axis: &Axis| axis.forward(0.0);
        [self.x.scale.hi, b(&self.x), self.y.scale.hi, b(&self.y)]
    }
}

/// Mapping of one axis: to' = scale · (x − from) + to, from the nearer of two anchors, so that each is mapped exactly.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Axis {
    from: [f64; 2],
    to: [f64; 2],
    scale: Double,
    inverse: Double,
}

impl Axis {
    /// Creates the mapping of ends to ends.
    fn stretched(from: [f64; 2], to: [f64; 2]) -> Self {
        let (span, length) = (Double::sum(from[1], -from[0]), Double::sum(to[1], -to[0]));
        let (scale, inverse) = (length.over(span), span.over(length));
        Self { from, to, scale, inverse }
    }

    /// Returns the axis with the size of the other's scale; its middle stays in the middle.
    fn rescaled(&self, other: &Self, from: [f64; 2], to: [f64; 2]) -> Self {
        let sign = (self.scale.hi * other.scale.hi).signum();
        let (scale, inverse) = (other.scale.times(sign), other.inverse.times(sign));
        let covered = scale.product(Double::sum(from[1], -from[0])).hi;
        let to0 = (to[0] + to[1]) * 0.5 - covered * 0.5;
        Self { from: [from[0]; 2], to: [to0; 2], scale, inverse }
    }

    fn forward(&self, x: f64) -> f64 {
        transform(x, self.from, self.scale, self.to)
    }

    fn backward(&self, x: f64) -> f64 {
        transform(x, self.to, self.inverse, self.from)
    }
}

/// Returns scale · (x − from) + to, rounded once if all numbers are in range.
fn transform(x: f64, from: [f64; 2], scale: Double, to: [f64; 2]) -> f64 {
    let nearer = usize::from((x - from[1]).abs() < (x - from[0]).abs());
    let (from, to) = (from[nearer], to[nearer]);
    let product = scale.product(Double::sum(x, -from));
    let total = Double::sum(product.hi, to);
    let result = total.hi + (total.lo + product.lo);
    if result.is_finite() { result } else { scale.hi * (x - from) + to }
}

/// An unevaluated sum of two f64, about 106 bits (T. J. Dekker, *A Floating-Point Technique for
/// Extending the Available Precision*, 1971).
#[derive(Debug, Clone, Copy, PartialEq)]
struct Double {
    hi: f64,
    lo: f64,
}

impl Double {
    /// Returns a + b without error (Knuth's two-sum).
    fn sum(a: f64, b: f64) -> Self {
        let hi = a + b;
        let b_part = hi - a;
        Self { hi, lo: (a - (hi - b_part)) + (b - b_part) }
    }

    /// Returns a · b without error (Veltkamp's splitting, Dekker's product).
    fn exact_product(a: f64, b: f64) -> Self {
        let hi = a * b;
        let ((a1, a0), (b1, b0)) = (split(a), split(b));
        Self { hi, lo: ((a1 * b1 - hi) + a1 * b0 + a0 * b1) + a0 * b0 }
    }

    /// Returns the product with `sign`, which is ± 1.
    fn times(self, sign: f64) -> Self {
        Self { hi: self.hi * sign, lo: self.lo * sign }
    }

    fn product(self, other: Self) -> Self {
        let p = Self::exact_product(self.hi, other.hi);
        Self::sum(p.hi, p.lo + (self.hi * other.lo + self.lo * other.hi))
    }

    fn over(self, divisor: Self) -> Self {
        let q = self.hi / divisor.hi;
        let p = divisor.product(Self { hi: q, lo: 0.0 });
        let rest = (self.hi - p.hi) + (self.lo - p.lo);
        Self::sum(q, rest / divisor.hi)
    }
}

/// Returns two halves of 26 bits that add up to `a`.
fn split(a: f64) -> (f64, f64) {
    let c = a * 134_217_729.0;
    let high = c - (c - a);
    (high, a - high)
}
