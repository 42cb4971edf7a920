//! Sheets as HPGL for pen plotters and cutters (Hewlett-Packard, *HP-GL Reference*, 1983; the common
//! part of HP-GL and HP-GL/2, and the widths of pens, which is of HP-GL/2 and passed over by others).

use super::machine::{MachineOptions, Way, passes, ways};
use crate::Result;
use durer::math::DVec2;
use durer::paper::order::Chain;
use durer::target::sheet::Sheet;
use std::io::Write;

/// Plotter units per millimetre: a unit is 0.025 mm.
const UNITS: f64 = 40.0;

/// Writes a sheet: pens of one width and colour in order, numbered from 1, each picked up once, with its strokes in an
/// order with short moves. The origin is the lower left corner, y up.
///
/// Curves are drawn as chords: ends of arcs, in whole units and degrees, would be displaced. Dashes and text are
/// separate strokes, because plotters' own differ. Fills are drawn as outlines with the pen after the last: a pen has
/// no areas.
///
/// # Errors
/// [`crate::Error::Io`] if writing fails.
pub fn write(out: &mut impl Write, sheet: &Sheet) -> Result<()> {
    write_for(out, sheet, &MachineOptions::default())
}

/// Writes a sheet as [`write()`] does, for a plotter with the pens of `machine`.
pub(super) fn write_for(
    out: &mut impl Write,
    sheet: &Sheet,
    machine: &MachineOptions,
) -> Result<()> {
    out.write_all(b"IN;\n")?;
    let mut at = [0, 0];
    for (pen, pass) in passes(sheet, machine.pens, false).into_iter().enumerate() {
        let number = pen + 1;
        let width = pass.width.map(|w| format!("PW{},{number};", super::number::short(w, 3)));
        writeln!(out, "SP{number};{}", width.unwrap_or_default())?;
        at = draw(out, pass.layers.into_iter().flat_map(|l| l.1).collect(), at)?;
    }
    out.write_all(b"PU0,0;\nSP0;\n")?;
    Ok(())
}

/// Draws everything of one pen from its position; returns its position afterwards.
fn draw(out: &mut impl Write, chains: Vec<Chain>, start: [i64; 2]) -> Result<[i64; 2]> {
    let start_mm = DVec2::new(start[0] as f64, start[1] as f64) / UNITS;
    let mut at = None;
    for points in ways(chains, start_mm).iter().map(steps) {
        let Some(&[x, y]) = points.first() else { continue };
        // A stroke that begins where the last one ended needs no lift.
        if at == Some([x, y]) {
            out.write_all(b",")?;
        } else {
            let end: &[u8] = if at.is_some() { b";\n" } else { b"" };
            out.write_all(end)?;
            write!(out, "PU{x},{y};PD")?;
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

/// Returns the points in plotter units, without repetitions; a dot has two, because the pen must be put down.
fn steps(way: &Way) -> Vec<[i64; 2]> {
    let all = std::iter::once(way.start).chain(way.steps.iter().map(|s| s.0));
    // A cast saturates; nothing on paper is that far away.
    let mut points: Vec<[i64; 2]> =
        all.map(|p| [p.x, p.y].map(|v| (v * UNITS).round() as i64)).collect();
    points.dedup();
    if let [only] = points[..] {
        points.push(only);
    }
    points
}
