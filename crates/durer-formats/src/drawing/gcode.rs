//! Sheets as G-code for pen plotters, engravers and cutters (RS-274: Kramer, Proctor and Messina, *The NIST
//! RS274NGC Interpreter*, 2000; the part that GRBL, Marlin and LinuxCNC share).

use super::machine::{MachineOptions, Pass, Way, is_plain, passes, ways};
use super::number::short;
use crate::Result;
use durer::math::DVec2;
use durer::target::sheet::Sheet;
use std::io::Write;

/// Digits after the point of a millimetre; the middles of arcs have one more, so that arcs end where they should.
const DIGITS: usize = 3;

/// Arcs that leave their chords by less are lines, millimetres: machines step no finer.
const FLAT: f64 = 0.003;

/// Writes a sheet in millimetres, absolute, from the lower left corner, y up: pens of one width and colour one after
/// another, each picked up once, layer by layer, with its strokes in an order with short moves.
///
/// Circular arcs are G2 and G3 with I and J, which count from where the arc begins, none further than three eighths of
/// a turn; ellipses and cubic curves are arcs that stay within 0.01 mm. Without [`MachineOptions::arcs`] all are
/// chords.
///
/// Between pens the machine goes to the origin and waits (`M0`). Dashes and text are separate strokes; fills
/// are drawn as outlines, last.
///
/// # Errors
/// The errors of [`MachineOptions::check`]; [`crate::Error::Io`] if writing fails.
pub fn write(out: &mut impl Write, sheet: &Sheet, machine: &MachineOptions) -> Result<()> {
    machine.check()?;
    let passes = passes(sheet, machine.pens, machine.arcs);
    let [width, height] = [sheet.size.x, sheet.size.y].map(|v| short(v, DIGITS));
    if !sheet.title.is_empty() {
        writeln!(out, "; {}", comment(&sheet.title))?;
    }
    writeln!(out, "; sheet {width} x {height} mm, pens: {}", passes.len())?;
    writeln!(out, "G21\nG90\n{}", machine.pen_up)?;
    for (index, pass) in passes.into_iter().enumerate() {
        write_pass(&mut Head { out, machine }, index, pass)?;
    }
    let mut head = Head { out, machine };
    head.travel(DVec2::ZERO)?;
    out.write_all(b"M2\n")?;
    Ok(())
}

fn write_pass(head: &mut Head<impl Write>, index: usize, pass: Pass) -> Result<()> {
    let [r, g, b, _] = pass.color;
    let number = index + 1;
    if index > 0 {
        head.travel(DVec2::ZERO)?;
    }
    match pass.width {
        Some(w) => {
            writeln!(head.out, "; pen {number}: {} mm, #{r:02x}{g:02x}{b:02x}", short(w, 3))?
        }
        None => writeln!(head.out, "; pen {number}: outlines of areas")?,
    }
    if index > 0 {
        head.out.write_all(b"M0\n")?;
    }
    let mut at = DVec2::ZERO;
    for (name, chains) in pass.layers {
        writeln!(head.out, "; layer {}", comment(&name))?;
        for way in ways(chains, at) {
            head.draw(&way)?;
            at = way.steps.last().map_or(way.start, |s| s.0);
        }
    }
    Ok(())
}

/// State of the machine's pen.
struct Head<'a, W> {
    out: &'a mut W,
    machine: &'a MachineOptions,
}

impl<W: Write> Head<'_, W> {
    /// Draws one stroke; a single point is a dot.
    fn draw(&mut self, way: &Way) -> Result<()> {
        self.travel(way.start)?;
        writeln!(self.out, "{}", self.machine.pen_down)?;
        let mut feed = format!(" F{}", short(self.machine.feed, DIGITS));
        let mut last = rounded(way.start);
        for &(end, bulge) in &way.steps {
            let next = rounded(end);
            if next != last {
                // Commands of the pen may have changed the speed.
                writeln!(self.out, "{}{feed}", step(last, next, bulge))?;
                feed.clear();
                last = next;
            }
        }
        writeln!(self.out, "{}", self.machine.pen_up)?;
        Ok(())
    }

    /// Moves the lifted pen. GRBL takes no speed for G0.
    fn travel(&mut self, to: DVec2) -> Result<()> {
        match self.machine.travel {
            Some(speed) => writeln!(self.out, "G1 {} F{}", place(to), short(speed, DIGITS))?,
            None => writeln!(self.out, "G0 {}", place(to))?,
        }
        Ok(())
    }
}

/// Returns the command that draws a line or an arc between two rounded places.
fn step(from: DVec2, to: DVec2, bulge: f64) -> String {
    let (across, way) = (to - from, place(to));
    if (across.length() * 0.5 * bulge).abs() < FLAT {
        return format!("G1 {way}");
    }
    // So the centre is equally far from both rounded ends.
    let off = across * 0.5 + across.perp() * ((1.0 - bulge * bulge) / (4.0 * bulge));
    let [i, j] = [off.x, off.y].map(|v| short(v, DIGITS + 1));
    format!("{} {way} I{i} J{j}", if bulge > 0.0 { "G3" } else { "G2" })
}

/// Returns a position in the form in which it is written.
fn rounded(p: DVec2) -> DVec2 {
    (p * 1000.0).round() / 1000.0
}

fn place(p: DVec2) -> String {
    format!("X{} Y{}", short(p.x, DIGITS), short(p.y, DIGITS))
}

/// Returns text that no machine obeys.
fn comment(text: &str) -> String {
    text.chars().map(|c| if is_plain(c) { c } else { '_' }).collect()
}
