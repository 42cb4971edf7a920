//! Pictures other than a single algorithm's: the contact sheet of all algorithms, and the wireframe.

use crate::failure::Failure;
use crate::report::{ComparedReport, PictureReport};
use durer::curve::stroke_font;
use durer::math::{DAffine2, DVec2};
use durer::pipeline::{Background, Compared, RenderOptions, compare};
use durer::raster::line::wide::{Cap, Join, Stroke};
use durer::raster::paint::{self, Canvas, Color};
use durer::scene::Scene;
use durer::shade::color::encode_rgba8;
use durer::target::Framebuffer;
use durer::trace::NoTrace;
use durer::view::View;
use durer::visibility::wireframe;
use durer_formats::wording::counted;

/// Free pixels around the pictures of a sheet.
const GAP: u32 = 8;

/// Height of a label's capitals, pixels.
const LETTERS: f64 = 10.5;

/// Width of a label's strokes, as a part of the height of its capitals.
const STROKE_WIDTH: f64 = 0.12;

/// Rows below a picture for its label: name, and count of differing pixels.
const LABEL: u32 = 44;

const PAPER: Color = [236, 236, 238, 255];
const INK: Color = [24, 24, 28, 255];
const ALARM: Color = [190, 20, 20, 255];

/// Returns black lines on the background.
pub fn wireframe(scene: &Scene, options: &RenderOptions) -> durer::Result<Framebuffer> {
    options.check()?;
    scene.check()?;
    let view = View::new(options.camera, options.width, options.height)?;
    let mut framebuffer = Framebuffer::within(&options.work, options.width, options.height)?;
    let rows = f32::from(u16::MAX).min(options.height as f32);
    for y in 0..options.height {
        let color = match options.background {
            Background::Color(color) => color,
            Background::Gradient(top, bottom) => top.lerp(bottom, (y as f32 + 0.5) / rows),
        };
        framebuffer.color.row_mut(y).fill(encode_rgba8(color));
    }
    let lines = wireframe::Options::default();
    wireframe::render(scene, &view, &lines, &mut framebuffer.color, &mut NoTrace);
    Ok(framebuffer)
}

/// Returns the pictures of all algorithms, each as large as was requested, with their names and the
/// number of pixels whose item is not the z-buffer's.
pub fn sheet(
    scene: &Scene,
    options: &RenderOptions,
    report: &mut PictureReport,
) -> Result<Framebuffer, Failure> {
    let usage = |e: durer::Error| Failure::of_library(&e);
    let compared = compare(scene, options).map_err(usage)?;
    for c in &compared {
        report.compared.push(ComparedReport {
            algorithm: c.method.name(),
            differing_pixels: c.differing,
            seconds: c.report.geometry_seconds + c.report.raster_seconds,
        });
    }
    if let Some(first) = compared.first() {
        report.add(&first.report);
    }
    lay_out(&compared, options).map_err(usage)
}

/// Returns columns of a sheet: about as wide as high.
fn columns(count: u32, width: u32, height: u32) -> u32 {
    let (w, h) = (f64::from(width + GAP), f64::from(height + LABEL + GAP));
    let fits = |&c: &u32| f64::from(c) * w >= f64::from(count.div_ceil(c)) * h;
    (1..=count).find(fits).unwrap_or(count).max(1)
}

fn lay_out(compared: &[Compared], options: &RenderOptions) -> durer::Result<Framebuffer> {
    let count = compared.len() as u32;
    let (w, h) = (
        u64::from(options.width) + u64::from(GAP),
        u64::from(options.height) + u64::from(LABEL + GAP),
    );
    let columns = columns(count, options.width, options.height);
    let rows = count.div_ceil(columns);
    let (width, height) =
        (u64::from(columns) * w + u64::from(GAP), u64::from(rows) * h + u64::from(GAP));
    if width * height > options.max_pixels.max(1 << 20) || width > 32_767 || height > 32_767 {
        let expected = "at most 32767 pixels wide and high, and within --max-pixels; a smaller --size makes it smaller";
        return Err(durer::Error::parameter(
            "the sheet's size",
            format!("{width}x{height}"),
            expected,
        ));
    }
    let mut sheet = Framebuffer::within(&options.work, width as u32, height as u32)?;
    sheet.color.data_mut().fill(PAPER);
    let mut canvas = Canvas::new(width as u32, height as u32, paint::Options::default())?;
    for (i, c) in (0..).zip(compared) {
        let (x, y) = (GAP + i % columns * w as u32, GAP + i / columns * h as u32);
        sheet.color.paste(&c.picture.color, x, y);
        let below = DVec2::new(f64::from(x), f64::from(y + options.height));
        write(
            &mut canvas,
            c.method.name(),
            below + DVec2::new(2.0, 18.0),
            f64::from(options.width),
            INK,
        )?;
        let (text, ink) = match c.differing {
            0 => ("0 pixels differ".to_owned(), INK),
            n => (counted(n, "pixel differs", "pixels differ"), ALARM),
        };
        write(&mut canvas, &text, below + DVec2::new(2.0, 38.0), f64::from(options.width), ink)?;
    }
    canvas.render(&mut sheet.color)?;
    Ok(sheet)
}

/// Writes a line of text with its base line at a place, smaller if it would be too wide.
fn write(canvas: &mut Canvas, text: &str, at: DVec2, width: f64, ink: Color) -> durer::Result<()> {
    let whole = stroke_font::line(text, LETTERS).advance;
    let size = LETTERS * ((width - 4.0) / whole.max(1.0)).clamp(0.2, 1.0);
    let path = stroke_font::line(text, size).path().transformed(DAffine2::from_translation(at));
    let stroke = Stroke {
        width: size * STROKE_WIDTH,
        cap: Cap::Round,
        join: Join::Round,
        ..Stroke::default()
    };
    canvas.stroke(&path, &stroke, &ink.into(), 1.0)
}
