//! A sheet as pixels.

use super::{dashes, text_strokes};
use crate::Result;
use crate::curve::Path;
use crate::math::{DAffine2, DVec2};
use crate::raster::coverage::FillRule;
use crate::raster::line::wide::{Cap, Join, Stroke};
use crate::raster::paint::{Canvas, Options, Paint};
use crate::target::Pixels;
use crate::target::sheet::{Mark, Pen, Sheet};

/// Paints a sheet, as large as it can be, in the middle of a picture; `background` is what the picture
/// shows beside and, where the paper is blank, on the paper.
///
/// # Errors
/// [`crate::Error::Limit`] for sides beyond 32,767 pixels; [`crate::Error::Parameter`] for pens that
/// are not at least 0 wide.
pub fn paint(
    sheet: &Sheet,
    width: u32,
    height: u32,
    background: [u8; 4],
) -> Result<Pixels<[u8; 4]>> {
    let mut canvas = Canvas::new(width, height, Options::default())?;
    canvas.clear(background);
    let picture = DVec2::new(f64::from(width), f64::from(height));
    let scale = (picture / sheet.size.max(DVec2::splat(1e-9))).min_element();
    let corner = (picture - sheet.size * scale) * 0.5;
    canvas.set_transform(DAffine2::from_scale_angle_translation(DVec2::splat(scale), 0.0, corner));
    if let Some(color) = sheet.background {
        let paper = Path::rectangle(0.0, 0.0, sheet.size.x, sheet.size.y);
        canvas.fill(&paper, FillRule::NonZero, &Paint::Color(color), 1.0);
    }
    for mark in sheet.layers.iter().flat_map(|l| &l.marks) {
        put(&mut canvas, mark, &sheet.pens)?;
    }
    let mut pixels = Pixels::new(width, height, background);
    canvas.render(&mut pixels)?;
    Ok(pixels)
}

fn put(canvas: &mut Canvas, mark: &Mark, pens: &[Pen]) -> Result<()> {
    match mark {
        Mark::Fill { rings, color } => {
            let mut path = Path::new();
            rings.iter().for_each(|r| {
                path.extend(&Path::polygon(r.iter().copied()));
            });
            canvas.fill(&path, FillRule::NonZero, &Paint::Color(*color), 1.0);
            Ok(())
        }
        Mark::Stroke { points, closed, pen } => match pens.get(*pen) {
            Some(pen) if pen.dashes.is_empty() => line(canvas, points, *closed, pen),
            Some(pen) => {
                let parts = dashes::cut(points, *closed, &pen.dashes);
                parts.iter().try_for_each(|part| line(canvas, part, false, pen))
            }
            None => Ok(()),
        },
        Mark::Text { at, text, height, anchor, pen } => {
            let Some(pen) = pens.get(*pen) else { return Ok(()) };
            let strokes = text_strokes(*at, text, *height, *anchor);
            strokes.iter().try_for_each(|stroke| line(canvas, stroke, false, pen))
        }
    }
}

fn line(canvas: &mut Canvas, points: &[DVec2], closed: bool, pen: &Pen) -> Result<()> {
    let path = match closed {
        true => Path::polygon(points.iter().copied()),
        false => Path::polyline(points.iter().copied()),
    };
    let style =
        Stroke { width: pen.width, cap: Cap::Round, join: Join::Round, ..Stroke::default() };
    canvas.stroke(&path, &style, &Paint::Color(pen.color), 1.0)
}
