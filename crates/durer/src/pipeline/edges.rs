//! Exact visible edges over a shaded picture.

use super::{DrawOptions, RenderOptions, draw};
use crate::Result;
use crate::curve::Path;
use crate::math::DVec2;
use crate::raster::line::wide::{Cap, Join, Stroke};
use crate::raster::paint::{Canvas, Options, Paint};
use crate::scene::Scene;
use crate::target::Framebuffer;
use crate::visibility::line::hidden_line;

/// Look of edges over a picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EdgeStyle {
    /// Width in pixels, above 0.
    pub width: f64,
    /// sRGB with straight alpha.
    pub color: [u8; 4],
}

impl Default for EdgeStyle {
    /// Returns the default: 1.5 pixels, nearly black.
    fn default() -> Self {
        Self { width: 1.5, color: [24, 25, 28, 255] }
    }
}

/// Draws the visible outlines, creases and borders of a scene over the picture that [`super::render`] made of it with
/// the same options. They are found exactly, as for drawings, by [`hidden_line`], and painted with area coverage.
///
/// # Errors
/// As [`draw`] and [`Canvas::new`].
pub fn draw_edges(
    scene: &Scene,
    options: &RenderOptions,
    style: &EdgeStyle,
    picture: &mut Framebuffer,
) -> Result<()> {
    let size = DVec2::new(f64::from(options.width), f64::from(options.height));
    let lines = hidden_line::Options { hidden: false, stubs: STUBS, ..Default::default() };
    let aspect = (size.x / size.y).clamp(1e-3, 1e3);
    let work = options.work.clone();
    let options = DrawOptions { aspect, lines, work, ..DrawOptions::new(options.camera) };
    let drawing = draw(scene, &options)?;
    let Some(window) = drawing.window else { return Ok(()) };
    let to_pixels = |p: DVec2| {
        let part = (p - window.min()) / window.size();
        DVec2::new(part.x, 1.0 - part.y) * size
    };
    let mut canvas = Canvas::new(picture.width(), picture.height(), Options::default())?;
    let stroke =
        Stroke { width: style.width, cap: Cap::Round, join: Join::Round, ..Stroke::default() };
    for line in drawing.lines.iter().filter(|l| l.is_visible()) {
        let points = line.points.iter().map(|p| to_pixels(*p));
        let path = if line.closed { Path::polygon(points) } else { Path::polyline(points) };
        canvas.stroke(&path, &stroke, &Paint::Color(style.color), 1.0)?;
    }
    canvas.render(&mut picture.color)
}

/// Length of stubs, as in drawings that are examined ([`hidden_line::Options::stubs`]).
const STUBS: f64 = 0.01;
