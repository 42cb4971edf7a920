//! The paints: one colour, gradients, images. All are evaluated at pixel centres.

use std::cmp::Ordering;
use std::sync::Arc;

use super::color::{Space, premultiply};
use crate::math::{DAffine2, DVec2};
use crate::target::Pixels;
use crate::target::gradient::{Gradient, GradientShape, Spread};

/// 8-bit sRGB with straight alpha.
pub type Color = [u8; 4];

/// An image, as it is or spread over the plane.
#[derive(Debug, Clone, PartialEq)]
pub struct Pattern {
    /// The pixels; straight alpha.
    pub image: Arc<Pixels<Color>>,
    /// Map from the image's pixels to the path's space.
    pub transform: DAffine2,
    /// Extension outside the image: the pixels at its border, or the image again; `None` = nothing.
    pub spread: Option<Spread>,
    /// Filter between its pixels.
    pub filter: ImageFilter,
}

/// Filter for colours between the pixels of an image. Colours are weighted by their alpha.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum ImageFilter {
    /// The nearest pixel.
    Nearest,
    /// A mixture of the four pixels around.
    #[default]
    Bilinear,
    /// A mixture of the sixteen pixels around, for enlarged images: D. Mitchell, A. Netravali, *Reconstruction Filters
    /// in Computer Graphics*, SIGGRAPH 1988, with B = C = 1/3.
    Bicubic,
    /// The mean of the pixels at 8 × 8 points spread evenly over the one that is painted, for images with about eight
    /// times as many pixels per side as are painted.
    Area,
}

/// Paint of a path.
#[derive(Debug, Clone, PartialEq)]
pub enum Paint {
    /// One colour.
    Color(Color),
    /// A colour ramp.
    Gradient(Arc<Gradient>),
    /// An image.
    Pattern(Arc<Pattern>),
}

impl From<Color> for Paint {
    fn from(color: Color) -> Self {
        Self::Color(color)
    }
}

/// Entries of a gradient's table: twice the number that 8 bits distinguish.
const RAMP: usize = 512;

/// Largest difference, of 255, between a table's entry and the colours within half a step of it. Where they differ
/// more, colours are computed from the stops, so that hard borders between colours are sharp and in the right place.
const FLAT: f64 = 2.0;

/// A prepared paint: colours premultiplied in the space of the canvas, maps inverted.
#[derive(Debug, Clone)]
pub(crate) enum Source<P> {
    Solid(P),
    Ramp(Box<Ramp<P>>),
    Image(Box<Image>),
}

/// A prepared gradient.
#[derive(Debug, Clone)]
pub(crate) struct Ramp<P> {
    gradient: Arc<Gradient>,
    paint_from_pixel: DAffine2,
    opacity: f64,
    /// Colours at equal steps of the parameter; `None` if they change too fast for a table.
    colors: Vec<Option<P>>,
}

impl<P: Space> Ramp<P> {
    fn new(gradient: &Arc<Gradient>, paint_from_pixel: DAffine2, opacity: f64) -> Self {
        let color = |steps: f64| stop_color(&gradient.stops, steps / (RAMP - 1) as f64);
        let is_near =
            |a: [f64; 4], b: [f64; 4]| a.iter().zip(b).all(|(a, b)| (a - b).abs() <= FLAT);
        let mut before = color(-0.5);
        let entry = |i: usize| {
            let (at, after) = (color(i as f64), color(i as f64 + 0.5));
            let even = is_near(at, std::mem::replace(&mut before, after)) && is_near(at, after);
            even.then(|| premultiply_f(at, opacity))
        };
        let mut colors: Vec<Option<P>> = (0..RAMP).map(entry).collect();
        for stop in &gradient.stops {
            let place = stop.0 * (RAMP - 1) as f64 + 0.5;
            if let Some(entry) = colors.get_mut(place as usize)
                && !is_near(stop.1.map(f64::from), color(place.floor()))
            {
                *entry = None;
            }
        }
        Self { gradient: gradient.clone(), paint_from_pixel, opacity, colors }
    }

    /// Returns the colour at a parameter.
    fn color(&self, t: f64) -> P {
        let within = spread_over(self.gradient.spread, t);
        let place = (within * (RAMP - 1) as f64 + 0.5) as usize;
        let tabled = self.colors.get(place).copied().flatten();
        tabled.unwrap_or_else(|| {
            // Before a first stop at 0, its own colour applies, not that of another stop at 0.
            let t = if self.gradient.spread == Spread::Pad { t } else { within };
            premultiply_f(stop_color(&self.gradient.stops, t), self.opacity)
        })
    }
}

/// A prepared pattern.
#[derive(Debug, Clone)]
pub(crate) struct Image {
    pattern: Arc<Pattern>,
    image_from_pixel: DAffine2,
    opacity: f64,
}

/// Returns an opacity clamped to 0 … 1; 1 for NaN.
pub(super) fn opacity(opacity: f64) -> f64 {
    if opacity.is_finite() { opacity.clamp(0.0, 1.0) } else { 1.0 }
}

impl<P: Space> Source<P> {
    /// Creates the source of a paint; `pixel_from_path` maps the path's space to pixels. A paint that cannot be
    /// evaluated — a map without inverse, a gradient without stops — paints nothing or its last stop, as SVG says.
    pub fn new(paint: &Paint, pixel_from_path: DAffine2, opacity: f64) -> Self {
        let opacity = self::opacity(opacity);
        match paint {
            Paint::Color(color) => Self::Solid(premultiply(*color, opacity as f32)),
            Paint::Gradient(g) => Self::gradient(g, pixel_from_path * g.transform, opacity),
            Paint::Pattern(p) => match inverse(pixel_from_path * p.transform) {
                Some(image_from_pixel) if !p.image.data().is_empty() => {
                    Self::Image(Box::new(Image { pattern: p.clone(), image_from_pixel, opacity }))
                }
                _ => Self::Solid(P::CLEAR),
            },
        }
    }

    fn gradient(g: &Arc<Gradient>, pixel_from_paint: DAffine2, opacity: f64) -> Self {
        let only = g.only_color(pixel_from_paint);
        let (None, Some(paint_from_pixel)) = (only, inverse(pixel_from_paint)) else {
            return Self::Solid(premultiply(only.unwrap_or_default(), opacity as f32));
        };
        Self::Ramp(Box::new(Ramp::new(g, paint_from_pixel, opacity)))
    }

    /// Computes the colours of the eight pixels of row `y` from column `x` on.
    pub fn row(&self, x: usize, y: usize, out: &mut [P; 8]) {
        match self {
            Self::Solid(color) => out.fill(*color),
            Self::Ramp(ramp) => {
                for (point, pixel) in centers(&ramp.paint_from_pixel, x, y).zip(out) {
                    let t = parameter(&ramp.gradient.shape, point);
                    *pixel = t.map_or(P::CLEAR, |t| ramp.color(t));
                }
            }
            Self::Image(image) => {
                let Image { pattern, image_from_pixel, opacity } = &**image;
                for (point, pixel) in centers(image_from_pixel, x, y).zip(out) {
                    let color = image_color(pattern, point, image_from_pixel);
                    *pixel = premultiply_f(color, *opacity);
                }
            }
        }
    }

    /// Returns its colour if it covers everything behind it completely.
    pub fn color(&self) -> Option<P> {
        match self {
            Self::Solid(color) => Some(*color),
            _ => None,
        }
    }
}

/// Returns the centres of eight pixels of row `y` from column `x` on, mapped. Steps begin at every eighth column, so
/// that the last bits of a pixel's mapped centre do not depend on the pixels requested with it.
fn centers(map: &DAffine2, x: usize, y: usize) -> impl Iterator<Item = DVec2> {
    let step = map.matrix2.x_axis;
    let begin = x & !7;
    let start = |x: usize| map.transform_point2(DVec2::new(x as f64 + 0.5, y as f64 + 0.5));
    let starts = [start(begin), start(begin + 8)];
    (x..x + 8).map(move |x| starts[usize::from(x >= begin + 8)] + step * (x & 7) as f64)
}

fn inverse(map: DAffine2) -> Option<DAffine2> {
    let determinant = map.matrix2.determinant();
    (determinant.is_finite() && determinant != 0.0 && map.is_finite()).then(|| map.inverse())
}

/// Returns straight colour in 0 … 255 at a parameter of the stops.
fn stop_color(stops: &[(f64, Color)], t: f64) -> [f64; 4] {
    // By bisection: drawings may have thousands.
    let after = stops.partition_point(|s| s.0.partial_cmp(&t) != Some(Ordering::Greater));
    let (before, after) = (after.saturating_sub(1), after.min(stops.len().saturating_sub(1)));
    let ((t0, c0), (t1, c1)) = (stops[before], stops[after]);
    let share = if t1 > t0 { ((t - t0) / (t1 - t0)).clamp(0.0, 1.0) } else { 0.0 };
    std::array::from_fn(|i| f64::from(c0[i]) + (f64::from(c1[i]) - f64::from(c0[i])) * share)
}

/// Returns the gradient's parameter at a point; `None` if no circle passes through it.
fn parameter(shape: &GradientShape, p: DVec2) -> Option<f64> {
    match *shape {
        GradientShape::Linear { start, end } => {
            let d = end - start;
            Some((p - start).dot(d) / d.length_squared())
        }
        GradientShape::Radial { center, radius, focus, focus_radius } => {
            // The largest t for which p is on the circle around focus + t (center − focus) with
            // radius r0 + t (r1 − r0) ≥ 0.
            let (cd, pd, dr) = (center - focus, p - focus, radius - focus_radius);
            let a = cd.length_squared() - dr * dr;
            let b = pd.dot(cd) + focus_radius * dr;
            let c = pd.length_squared() - focus_radius * focus_radius;
            let valid = |t: f64| (t.is_finite() && focus_radius + t * dr >= 0.0).then_some(t);
            if a == 0.0 {
                return valid(c / (2.0 * b));
            }
            let root = (b * b - a * c).sqrt();
            let (t0, t1) = ((b + root) / a, (b - root) / a);
            valid(t0.max(t1)).or_else(|| valid(t0.min(t1)))
        }
    }
}

fn spread_over(spread: Spread, t: f64) -> f64 {
    match spread {
        Spread::Pad => t.clamp(0.0, 1.0),
        Spread::Repeat => t - t.floor(),
        Spread::Reflect => {
            let u = t - 2.0 * (t * 0.5).floor();
            if u > 1.0 { 2.0 - u } else { u }
        }
    }
}

/// Returns the column or row, of `n` of an image, at `at`.
fn within(at: i64, n: i64, pattern: &Pattern) -> Option<u32> {
    let at = match pattern.spread {
        None if (0..n).contains(&at) => at,
        None => return None,
        Some(Spread::Pad) => at.clamp(0, n - 1),
        Some(Spread::Repeat) => at.rem_euclid(n),
        Some(Spread::Reflect) => {
            let at = at.rem_euclid(2 * n);
            at.min(2 * n - 1 - at)
        }
    };
    u32::try_from(at).ok()
}

/// Returns the pattern's straight colour in 0 … 255 at a point in its pixels; the map gives the size of
/// a pixel that is painted there.
fn image_color(pattern: &Pattern, p: DVec2, image_from_pixel: &DAffine2) -> [f64; 4] {
    match pattern.filter {
        ImageFilter::Nearest => {
            let at = p.floor();
            pixel(pattern, at.x, at.y)
        }
        ImageFilter::Bilinear => bilinear(pattern, p).straight(),
        ImageFilter::Bicubic => bicubic(pattern, p),
        ImageFilter::Area => area(pattern, p, image_from_pixel),
    }
}

/// Returns the straight colour of a pixel of a pattern, inside or outside its image.
fn pixel(pattern: &Pattern, x: f64, y: f64) -> [f64; 4] {
    let size = (i64::from(pattern.image.width()), i64::from(pattern.image.height()));
    let place = [(x as i64, size.0), (y as i64, size.1)].map(|(at, n)| within(at, n, pattern));
    let [Some(x), Some(y)] = place else { return [0.0; 4] };
    pattern.image.get(x, y).unwrap_or([0; 4]).map(f64::from)
}

fn bilinear(pattern: &Pattern, p: DVec2) -> Mixture {
    let (q, f) = ((p - 0.5).floor(), (p - 0.5) - (p - 0.5).floor());
    let weights = [(1.0 - f.x) * (1.0 - f.y), f.x * (1.0 - f.y), (1.0 - f.x) * f.y, f.x * f.y];
    let mut sum = Mixture::default();
    for (corner, weight) in weights.into_iter().enumerate() {
        let (x, y) = (q.x + (corner % 2) as f64, q.y + (corner / 2) as f64);
        sum.add(&Mixture::of(pixel(pattern, x, y)), weight);
    }
    sum
}

fn area(pattern: &Pattern, p: DVec2, image_from_pixel: &DAffine2) -> [f64; 4] {
    let size = DVec2::new(pattern.image.width().into(), pattern.image.height().into());
    // Repeated images are so common, and need so many samples, that places in them are found without division.
    let (again, per_size) = (pattern.spread == Some(Spread::Repeat), size.recip());
    let mut sum = Mixture::default();
    for part in 0..64 {
        let (x, y) = (f64::from(part % 8), f64::from(part / 8));
        let aside = DVec2::new((x - 3.5) / 8.0, (y - 3.5) / 8.0);
        let at = p + image_from_pixel.transform_vector2(aside);
        let at = if again { at - size * (at * per_size).floor() } else { at };
        sum.add(&Mixture::of(pixel_within(pattern, at.floor())), 1.0 / 64.0);
    }
    sum.straight()
}

/// Returns the same colour as [`pixel`], faster inside the image.
fn pixel_within(pattern: &Pattern, at: DVec2) -> [f64; 4] {
    let place = (at.x >= 0.0 && at.y >= 0.0).then_some((at.x as u32, at.y as u32));
    let found = place.and_then(|(x, y)| pattern.image.get(x, y));
    found.map_or_else(|| pixel(pattern, at.x, at.y), |color| color.map(f64::from))
}

fn bicubic(pattern: &Pattern, p: DVec2) -> [f64; 4] {
    let (q, f) = ((p - 0.5).floor(), (p - 0.5) - (p - 0.5).floor());
    let (across, down) = (mitchell(f.x), mitchell(f.y));
    let mut sum = Mixture::default();
    for (y, of_row) in (-1..3).zip(down) {
        for (x, of_column) in (-1..3).zip(across) {
            let color = pixel(pattern, q.x + f64::from(x), q.y + f64::from(y));
            sum.add(&Mixture::of(color), of_row * of_column);
        }
    }
    sum.straight()
}

/// Returns the weights of the four pixels in a row around a point at the fraction `f` between the second and the third.
fn mitchell(f: f64) -> [f64; 4] {
    let (near, far) = (
        |x: f64| ((7.0 * x - 12.0) * x * x + 16.0 / 3.0) / 6.0,
        |x: f64| (((-7.0 / 3.0 * x + 12.0) * x - 20.0) * x + 32.0 / 3.0) / 6.0,
    );
    [far(1.0 + f), near(f), near(1.0 - f), far(2.0 - f)]
}

/// Colours that are mixed: red, green and blue times opacity, and opacity.
#[derive(Debug, Clone, Copy, Default)]
struct Mixture([f64; 4]);

impl Mixture {
    fn of([r, g, b, a]: [f64; 4]) -> Self {
        Self([r * a, g * a, b * a, a])
    }

    fn add(&mut self, other: &Self, weight: f64) {
        self.0.iter_mut().zip(other.0).for_each(|(sum, part)| *sum += part * weight);
    }

    /// Returns the straight colour, within 0 … 255.
    fn straight(self) -> [f64; 4] {
        let [r, g, b, a] = self.0;
        if a <= 0.0 {
            return [0.0; 4];
        }
        [r / a, g / a, b / a, a].map(|c| c.clamp(0.0, 255.0))
    }
}

fn premultiply_f<P: Space>(color: [f64; 4], opacity: f64) -> P {
    P::from_srgb(color.map(|c| (c / 255.0) as f32), opacity as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stops_are_found_among_many_and_among_those_at_one_place() {
        // Two stops at each of 0, 0.01, …: the colour jumps there and is constant between.
        let level = |i: u32| [(i * 37 % 256) as u8, (i * 91 % 256) as u8, 0, 255];
        let pair = |i: u32| [level(i), level(i + 1)].map(|color| (f64::from(i) / 100.0, color));
        let stops: Vec<(f64, Color)> = (0..=100).flat_map(pair).collect();
        for i in 0..100 {
            let expected = level(i + 1).map(f64::from);
            for within in [0.0, 0.3, 0.999] {
                let t = (f64::from(i) / 100.0) * (1.0 - within) + f64::from(i + 1) / 100.0 * within;
                assert_eq!(stop_color(&stops, t), expected, "{t}");
            }
        }
        assert_eq!(stop_color(&stops, -1.0), level(0).map(f64::from));
        assert_eq!(stop_color(&stops, 2.0), level(101).map(f64::from));
        assert_eq!(stop_color(&stops, f64::NAN), level(101).map(f64::from));
    }
}
