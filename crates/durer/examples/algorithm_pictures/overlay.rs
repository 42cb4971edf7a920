//! The steps of an algorithm, drawn over its picture.

use durer::math::{DVec2, IVec2};
use durer::raster::line::{Options, bresenham};
use durer::target::Pixels;
use durer::trace::NoTrace;
use durer::visibility::surface::Step;
use durer::visibility::surface::{scan_line_z as scan, spanning_scan_line as spanning, warnock};

const INK: [u8; 4] = [20, 20, 30, 255];

/// Draws a step over the picture: windows, spans, outlines of polygons, the row of depths.
pub fn draw(step: &Step, row: &mut u32, p: &mut Pixels<[u8; 4]>) {
    let tint =
        |item: u32| [0, 8, 16].map(|s| 120 + (item.wrapping_mul(0x9e37_79b9) >> s & 0x7f) as u8);
    match *step {
        Step::Warnock(warnock::Step::Divide { window: w, x, y }) => {
            (w.y0..w.y1).for_each(|y| p.set(x as u32, y as u32, INK));
            (w.x0..w.x1).for_each(|x| p.set(x as u32, y as u32, INK));
        }
        Step::SpanningScanLine(spanning::Step::Row { y })
        | Step::ScanLineZ(scan::Step::Row { y }) => *row = y as u32,
        Step::SpanningScanLine(spanning::Step::Span { item, x0, x1, .. }) => {
            let [r, g, b] = tint(item);
            (x0..x1).for_each(|x| p.set(x as u32, *row, [r, g, b, 255]));
        }
        Step::ScanLineZ(scan::Step::Write { x, depth, .. }) => {
            let grey = ((1.0 - depth) * 800.0).clamp(0.0, 255.0) as u8;
            p.set(x as u32, *row, [grey, grey, grey, 255]);
        }
        _ => {}
    }
}

/// The outline of a polygon.
pub fn outline(corners: &[DVec2], p: &mut Pixels<[u8; 4]>) {
    let pixels: Vec<IVec2> = corners.iter().map(|v| v.as_ivec2()).collect();
    for (&a, &b) in pixels.iter().zip(pixels.iter().cycle().skip(1)) {
        let plot = |q: IVec2| p.set(q.x as u32, q.y as u32, INK);
        bresenham::draw(a, b, &Options::default(), plot, &mut NoTrace);
    }
}
