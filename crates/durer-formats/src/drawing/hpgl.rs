//! Sheets as HPGL for pen plotters and cutters (Hewlett-Packard, *HP-GL Reference*, 1983; the common
//! part of HP-GL and HP-GL/2).

use crate::Result;
use durer::math::DVec2;
use durer::paper::order::nearest_first;
use durer::paper::{dashes, text_strokes};
use durer::target::sheet::{Mark, Sheet};
use std::io::Write;

/// Plotter units per millimetre: a unit is 0.025 mm.
const UNITS: f64 = 40.0;

/// Writes a sheet: the pens in their order, numbered from 1, each drawing its strokes on the shortest
/// way that a greedy search finds. The origin is the lower left corner, y up.
///
/// Dashes and text are strokes of their own, as plotters differ in theirs. Fills are drawn as outlines
/// with the pen after the last: a pen has no areas.
///
/// # Errors
/// [`crate::Error::Io`] where writing fails.
pub fn write(out: &mut impl Write, sheet: &Sheet) -> Result<()> {
    let mut strokes: Vec<Vec<Vec<[i64; 2]>>> = vec![Vec::new(); sheet.pens.len() + 1];
    for mark in sheet.layers.iter().flat_map(|l| &l.marks) {
        collect(&mut strokes, sheet, mark);
    }
    out.write_all(b"IN;\n")?;
    let mut at = [0, 0];
    for (pen, strokes) in strokes.iter().enumerate().filter(|(_, s)| !s.is_empty()) {
        writeln!(out, "SP{};", pen + 1)?;
        at = draw(out, strokes, at)?;
    }
    out.write_all(b"PU0,0;\nSP0;\n")?;
    Ok(())
}

/// The strokes of one pen, from where it is; where it is afterwards.
fn draw(out: &mut impl Write, strokes: &[Vec<[i64; 2]>], start: [i64; 2]) -> Result<[i64; 2]> {
    let point = |p: &[i64; 2]| DVec2::new(p[0] as f64, p[1] as f64);
    let ends: Vec<(DVec2, DVec2)> =
        strokes.iter().filter_map(|s| Some((point(s.first()?), point(s.last()?)))).collect();
    let mut at = None;
    for turn in nearest_first(&ends, point(&start)) {
        let Some(stroke) = strokes.get(turn.index) else { continue };
        let mut points = stroke.clone();
        if turn.backwards {
            points.reverse();
        }
        // A stroke that begins where the last one ended needs no lift.
        if at != points.first().copied() {
            let [x, y] = points[0];
            if at.is_some() {
                out.write_all(b";\n")?;
            }
            write!(out, "PU{x},{y};PD")?;
        } else {
            out.write_all(b",")?;
        }
        let rest: Vec<String> = points.iter().skip(1).map(|[x, y]| format!("{x},{y}")).collect();
        out.write_all(rest.join(",").as_bytes())?;
        at = points.last().copied();
    }
    if at.is_some() {
        out.write_all(b";\n")?;
    }
    Ok(at.unwrap_or(start))
}

fn collect(strokes: &mut [Vec<Vec<[i64; 2]>>], sheet: &Sheet, mark: &Mark) {
    let mut add = |pen: usize, points: &[DVec2], closed: bool| {
        let mut chain: Vec<[i64; 2]> = Vec::with_capacity(points.len() + 1);
        let again = points.first().filter(|_| closed);
        for p in points.iter().chain(again) {
            // A cast saturates; nothing on paper is that far away.
            let place = [p.x * UNITS, (sheet.size.y - p.y) * UNITS].map(|v| v.round() as i64);
            if chain.last() != Some(&place) {
                chain.push(place);
            }
        }
        if let [only] = chain[..] {
            // A dot: the pen is put down.
            chain.push(only);
        }
        if let (true, Some(pen)) = (chain.len() > 1, strokes.get_mut(pen)) {
            pen.push(chain);
        }
    };
    let last = sheet.pens.len();
    match mark {
        Mark::Stroke { points, closed, pen } => match sheet.pens.get(*pen) {
            Some(style) if !style.dashes.is_empty() => {
                let parts = dashes::cut(points, *closed, &style.dashes);
                parts.iter().for_each(|part| add(*pen, part, false));
            }
            Some(_) => add(*pen, points, *closed),
            None => {}
        },
        Mark::Fill { rings, .. } => rings.iter().for_each(|ring| add(last, ring, true)),
        Mark::Text { at, text, height, anchor, pen } => {
            let letters = text_strokes(*at, text, *height, *anchor);
            letters.iter().for_each(|stroke| add(*pen, stroke, false));
        }
    }
}
