//! usvg's geometry and paints in durer's terms.

use durer::curve::Path;
use durer::math::{DAffine2, DVec2};
use durer::raster::paint::{BlendFunction, Canvas, ImageFilter, Paint, Pattern};
use durer::target::Pixels;
use durer::target::gradient::{Gradient, GradientShape, Spread};
use std::sync::Arc;
use usvg::tiny_skia_path::{self, PathSegment};

/// Tiles of patterns have at most this many pixels a side; larger ones are painted coarser.
const MAX_TILE: f64 = 4096.0;

/// Factor for the pixels per side of tiles that are not aligned to whole pixels.
const FINER: f64 = 8.0;

/// Tiles are not made finer beyond this many pixels: a tile is painted for each size that it is seen
/// at.
const FINER_PIXELS: f64 = 1_048_576.0;

/// Difference from whole pixels below which sides of tiles count as whole.
const WHOLE: f64 = 1e-3;

pub(super) fn affine(t: usvg::Transform) -> DAffine2 {
    let at = |x: f32, y: f32| DVec2::new(x.into(), y.into());
    DAffine2::from_cols(at(t.sx, t.ky), at(t.kx, t.sy), at(t.tx, t.ty))
}

pub(super) fn path(data: &tiny_skia_path::Path) -> Path {
    let at = |p: tiny_skia_path::Point| DVec2::new(p.x.into(), p.y.into());
    let mut out = Path::new();
    for segment in data.segments() {
        use durer::curve::PathElement::{Close, CubicTo, LineTo, MoveTo, QuadTo};
        out.push(match segment {
            PathSegment::MoveTo(p) => MoveTo(at(p)),
            PathSegment::LineTo(p) => LineTo(at(p)),
            PathSegment::QuadTo(c, p) => QuadTo(at(c), at(p)),
            PathSegment::CubicTo(a, b, p) => CubicTo(at(a), at(b), at(p)),
            PathSegment::Close => Close,
        });
    }
    out
}

pub(super) fn rectangle(rect: usvg::NonZeroRect) -> Path {
    let side = |v: f32| f64::from(v);
    Path::rectangle(side(rect.x()), side(rect.y()), side(rect.width()), side(rect.height()))
}

pub(super) fn blend(mode: usvg::BlendMode) -> BlendFunction {
    use usvg::BlendMode as Mode;
    match mode {
        Mode::Normal => BlendFunction::Normal,
        Mode::Multiply => BlendFunction::Multiply,
        Mode::Screen => BlendFunction::Screen,
        Mode::Overlay => BlendFunction::Overlay,
        Mode::Darken => BlendFunction::Darken,
        Mode::Lighten => BlendFunction::Lighten,
        Mode::ColorDodge => BlendFunction::ColorDodge,
        Mode::ColorBurn => BlendFunction::ColorBurn,
        Mode::HardLight => BlendFunction::HardLight,
        Mode::SoftLight => BlendFunction::SoftLight,
        Mode::Difference => BlendFunction::Difference,
        Mode::Exclusion => BlendFunction::Exclusion,
        Mode::Hue => BlendFunction::Hue,
        Mode::Saturation => BlendFunction::Saturation,
        Mode::Color => BlendFunction::Color,
        Mode::Luminosity => BlendFunction::Luminosity,
        Mode::PlusLighter => BlendFunction::PlusLighter,
    }
}

/// Converts colours and gradients; `None` for a pattern.
pub(super) fn plain(paint: &usvg::Paint) -> Option<Paint> {
    let at = |x: f32, y: f32| DVec2::new(x.into(), y.into());
    match paint {
        usvg::Paint::Color(c) => Some(Paint::Color([c.red, c.green, c.blue, 255])),
        usvg::Paint::LinearGradient(g) => {
            let shape =
                GradientShape::Linear { start: at(g.x1(), g.y1()), end: at(g.x2(), g.y2()) };
            Some(gradient(g, shape))
        }
        usvg::Paint::RadialGradient(g) => {
            let shape = GradientShape::Radial {
                center: at(g.cx(), g.cy()),
                radius: f64::from(g.r().get()),
                focus: at(g.fx(), g.fy()),
                focus_radius: f64::from(g.fr().get()),
            };
            Some(gradient(g, shape))
        }
        usvg::Paint::Pattern(_) => None,
    }
}

fn gradient(g: &usvg::BaseGradient, shape: GradientShape) -> Paint {
    let stop = |s: &usvg::Stop| {
        let c = s.color();
        let alpha = (s.opacity().get() * 255.0).round() as u8;
        (f64::from(s.offset().get()), [c.red, c.green, c.blue, alpha])
    };
    let spread = match g.spread_method() {
        usvg::SpreadMethod::Pad => Spread::Pad,
        usvg::SpreadMethod::Reflect => Spread::Reflect,
        usvg::SpreadMethod::Repeat => Spread::Repeat,
    };
    let stops = g.stops().iter().map(stop).collect();
    Paint::Gradient(Arc::new(Gradient { shape, stops, spread, transform: affine(g.transform()) }))
}

/// One tile of a pattern in pixels.
pub(super) struct Tile {
    pub width: u32,
    pub height: u32,
    /// Map from the pattern's content to the tile's pixels.
    pub pixel_from_content: DAffine2,
    /// Map from the tile's pixels to the space of the path.
    path_from_pixel: DAffine2,
    filter: ImageFilter,
}

impl Tile {
    /// Creates a tile with as many pixels as it will cover where those are whole ones, else with up to eight
    /// times as many a side, which are then averaged; `None` if it covers nothing.
    pub fn new(pattern: &usvg::Pattern, pixel_from_path: DAffine2) -> Option<Self> {
        let path_from_pattern = affine(pattern.transform());
        let seen = (pixel_from_path * path_from_pattern).matrix2;
        let rect = pattern.rect();
        let size = DVec2::new(rect.width().into(), rect.height().into());
        let pixels = size * DVec2::new(seen.x_axis.length(), seen.y_axis.length());
        if !pixels.is_finite() || pixels.min_element() <= 0.0 {
            return None;
        }
        let is_upright = seen.x_axis.y == 0.0 && seen.y_axis.x == 0.0;
        let corner = DVec2::new(rect.x().into(), rect.y().into());
        let placed = (pixel_from_path * path_from_pattern).transform_point2(corner);
        let is_whole = |v: DVec2| (v - v.round()).abs().max_element() < WHOLE;
        let (finer, filter) = match is_upright && is_whole(pixels) && is_whole(placed) {
            true => (1.0, ImageFilter::Nearest),
            false => {
                let fitting = (FINER_PIXELS / (pixels.x * pixels.y)).sqrt();
                (fitting.floor().clamp(1.0, FINER), ImageFilter::Area)
            }
        };
        let pixels = (pixels * finer).round().clamp(DVec2::ONE, DVec2::splat(MAX_TILE));
        let path_from_pixel = path_from_pattern
            * DAffine2::from_translation(corner)
            * DAffine2::from_scale(size / pixels);
        Some(Self {
            width: pixels.x as u32,
            height: pixels.y as u32,
            pixel_from_content: DAffine2::from_scale(pixels / size),
            path_from_pixel,
            filter,
        })
    }

    /// Returns the filter between the tile's pixels.
    pub fn filter(&self) -> ImageFilter {
        self.filter
    }

    /// Returns the pattern, once its tile is painted.
    pub fn paint(&self, canvas: &Canvas) -> Option<Paint> {
        let mut image = Pixels::new(self.width, self.height, [0; 4]);
        canvas.render(&mut image).ok()?;
        let (image, transform) = (Arc::new(image), self.path_from_pixel);
        let spread = Some(Spread::Repeat);
        Some(Paint::Pattern(Arc::new(Pattern { image, transform, spread, filter: self.filter })))
    }
}
