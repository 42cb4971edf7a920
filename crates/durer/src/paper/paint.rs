//! A sheet as pixels.

use super::{dashes, dimension_strokes, text_strokes};
use crate::Result;
use crate::curve::{Path, pieces};
use crate::math::{DAffine2, DVec2};
use crate::raster::coverage::FillRule;
use crate::raster::line::wide::{Cap, Join, Stroke};
use crate::raster::paint::{Canvas, Options, Paint};
use crate::target::sheet::{PaperMark, Pen, Sheet};
use crate::target::{Curve, Pixels};
use std::sync::Arc;

/// Number of marks that are painted at a time: their edges take more memory than they do.
const AT_ONCE: usize = 1 << 15;

/// Largest distance between painted chords and curves, in millimetres: far below a pixel.
const FINE: f64 = 0.002;

/// Paints a sheet, as large as it can be, in the middle of a picture; `background` is the colour beside the paper and,
/// where the paper is blank, on it.
///
/// Marks are freed one by one as they are painted, so that large sheets are not held twice.
///
/// # Errors
/// [`crate::Error::TooLarge`] for sides beyond 32,767 pixels; [`crate::Error::Parameter`] for pens that
/// are not at least 0 wide.
pub fn paint(
    sheet: Sheet,
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
    let mut pixels = Pixels::new(width, height, background);
    // Between two parts translucent pixels would be rounded.
    let most = if background[3] == 255 { AT_ONCE } else { usize::MAX };
    let mut count = 0;
    for mark in sheet.layers.into_iter().flat_map(|l| l.marks) {
        put(&mut canvas, &mark, &sheet.pens)?;
        count += 1;
        if count % most == 0 {
            canvas.render(&mut pixels)?;
            canvas.restart();
        }
    }
    canvas.render(&mut pixels)?;
    Ok(pixels)
}

fn put(canvas: &mut Canvas, mark: &PaperMark, pens: &[Pen]) -> Result<()> {
    match mark {
        PaperMark::Fill { rings, color, even_odd } => {
            let mut path = Path::new();
            rings.iter().for_each(|r| {
                path.extend(&Path::polygon(r.iter().copied()));
            });
            canvas.fill(&path, rule(*even_odd), &Paint::Color(*color), 1.0);
            Ok(())
        }
        PaperMark::Area { rings, color, even_odd } => {
            canvas.fill(&around(rings), rule(*even_odd), &Paint::Color(*color), 1.0);
            Ok(())
        }
        PaperMark::Gradient(area) => {
            let paint = Paint::Gradient(Arc::new(area.gradient.clone()));
            canvas.fill(&around(&area.rings), rule(area.even_odd), &paint, 1.0);
            Ok(())
        }
        PaperMark::Stroke { points, closed, pen } => match pens.get(*pen) {
            Some(pen) if pen.dashes.is_empty() => line(canvas, points, *closed, pen),
            Some(pen) => {
                let parts = dashes::cut(points, *closed, &pen.dashes);
                parts.iter().try_for_each(|part| line(canvas, part, false, pen))
            }
            None => Ok(()),
        },
        PaperMark::Curve { curve, pen } => match pens.get(*pen) {
            Some(pen) if pen.dashes.is_empty() => draw(canvas, &pieces::path(curve, FINE), pen),
            Some(pen) => {
                let parts = dashes::cut(&pieces::points(curve, FINE), curve.closed, &pen.dashes);
                parts.iter().try_for_each(|part| line(canvas, part, false, pen))
            }
            None => Ok(()),
        },
        PaperMark::Text { at, text, height, anchor, pen } => {
            let Some(pen) = pens.get(*pen) else { return Ok(()) };
            let strokes = text_strokes(*at, text, *height, *anchor);
            strokes.iter().try_for_each(|stroke| line(canvas, stroke, false, pen))
        }
        PaperMark::Dimension(dimension) => {
            dimension.marks.iter().try_for_each(|mark| put(canvas, mark, pens))?;
            let Some(pen) = pens.get(dimension.text.pen) else { return Ok(()) };
            let strokes = dimension_strokes(&dimension.text);
            strokes.iter().try_for_each(|stroke| line(canvas, stroke, false, pen))
        }
        PaperMark::Group(group) => {
            if let Some(clip) = &group.clip {
                canvas.push_clip(&around(&clip.rings), rule(clip.even_odd));
            }
            canvas.push_group();
            let done = group.marks.iter().try_for_each(|mark| put(canvas, mark, pens));
            canvas.pop(group.opacity);
            if group.clip.is_some() {
                canvas.pop(1.0);
            }
            done
        }
    }
}

fn rule(even_odd: bool) -> FillRule {
    if even_odd { FillRule::EvenOdd } else { FillRule::NonZero }
}

/// Returns closed curves as one path.
fn around(rings: &[Curve]) -> Path {
    let mut path = Path::new();
    rings.iter().for_each(|ring| {
        path.extend(&pieces::path(ring, FINE));
    });
    path
}

fn line(canvas: &mut Canvas, points: &[DVec2], closed: bool, pen: &Pen) -> Result<()> {
    let path = match closed {
        true => Path::polygon(points.iter().copied()),
        false => Path::polyline(points.iter().copied()),
    };
    draw(canvas, &path, pen)
}

fn draw(canvas: &mut Canvas, path: &Path, pen: &Pen) -> Result<()> {
    let style =
        Stroke { width: pen.width, cap: Cap::Round, join: Join::Round, ..Stroke::default() };
    canvas.stroke(path, &style, &Paint::Color(pen.color), 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::target::sheet::SheetLayer;

    #[test]
    fn many_marks_are_painted_in_parts_as_they_are_at_once() {
        let fill = |i: usize| {
            let at = |k: usize| (i.wrapping_mul(2_654_435_761) >> k) as f64 % 97.0;
            let ring = vec![(at(0), at(7)), (at(14), at(3)), (at(9), at(20))];
            let color = [i as u8, (i >> 3) as u8, (i >> 8) as u8, 40 + (i % 200) as u8];
            let rings = vec![ring.into_iter().map(|(x, y)| DVec2::new(x, y)).collect()];
            PaperMark::Fill { rings, color, even_odd: false }
        };
        let mut marks: Vec<PaperMark> = (0..AT_ONCE + 200).map(fill).collect();
        let sheet = |marks: Vec<PaperMark>| {
            let layers = vec![SheetLayer { name: "fills".to_owned(), marks }];
            Sheet { size: DVec2::splat(97.0), layers, ..Sheet::default() }
        };
        let painted = |marks: Vec<PaperMark>| paint(sheet(marks), 60, 60, [250, 240, 230, 255]);
        let parts = painted(marks.clone()).expect("painted");
        // The last 200 over the picture of the earlier ones.
        let last = marks.split_off(AT_ONCE);
        let mut whole = painted(marks).expect("painted");
        assert_ne!(parts, whole);
        let mut canvas = Canvas::new(60, 60, Options::default()).expect("canvas");
        let scale = DVec2::splat(60.0 / 97.0);
        canvas.set_transform(DAffine2::from_scale_angle_translation(scale, 0.0, DVec2::ZERO));
        last.iter().for_each(|mark| put(&mut canvas, mark, &[]).expect("put"));
        canvas.render(&mut whole).expect("rendered");
        assert_eq!(parts, whole);
    }
}
