//! What a machine with pens does for a sheet: pen by pen, each of which is taken once, layer by layer.

use crate::{Error, Result};
use durer::curve::pieces;
use durer::math::DVec2;
use durer::paper::order::{Stroke, ordered};
use durer::paper::{dashes, dimension_strokes, text_strokes};
use durer::target::sheet::{Mark, Sheet};

/// How near chords are to curves, millimetres: less than half of a step of plotters.
const CHORDS: f64 = 0.01;

/// How machines draw.
#[derive(Debug, Clone, PartialEq)]
pub struct MachineOptions {
    /// How many pens there are; those of a sheet that has more are drawn with the pen that is most alike.
    pub pens: Option<usize>,
    /// How fast a pen draws, millimetres a minute.
    pub feed: f64,
    /// How fast it moves in the air, millimetres a minute; `None` for as fast as the machine moves.
    pub travel: Option<f64>,
    /// The lines of G-code that put the pen down.
    pub pen_down: String,
    /// Those that lift it.
    pub pen_up: String,
}

impl Default for MachineOptions {
    /// 1500 mm a minute, and a servo on the spindle's output, as GRBL has it; it gets 0.2 s to turn.
    fn default() -> Self {
        Self {
            pens: None,
            feed: 1500.0,
            travel: None,
            pen_down: "M3 S1000\nG4 P0.2".to_owned(),
            pen_up: "M5\nG4 P0.2".to_owned(),
        }
    }
}

impl MachineOptions {
    /// # Errors
    /// [`Error::Library`] for a speed that is not above 0, no pens, and commands with what machines take for
    /// something else.
    pub fn check(&self) -> Result<()> {
        let wrong = |name, value: String, expected| {
            Err(Error::from(durer::Error::parameter(name, value, expected)))
        };
        for (name, speed) in [("feed", self.feed), ("travel", self.travel.unwrap_or(1.0))] {
            if !(speed > 0.0 && speed.is_finite()) {
                return wrong(name, speed.to_string(), "above 0 mm a minute");
            }
        }
        if self.pens == Some(0) {
            return wrong("pens", "0".to_owned(), "at least 1");
        }
        for (name, lines) in [("pen-down", &self.pen_down), ("pen-up", &self.pen_up)] {
            if !lines.chars().all(|c| c == '\n' || is_plain(c)) {
                let expected = "printable ASCII without ! ? ~, which stop and start machines wherever they stand";
                return wrong(name, lines.clone(), expected);
            }
        }
        Ok(())
    }
}

/// Whether a character is text for every machine. GRBL obeys some, and all beyond ASCII, within comments too.
pub fn is_plain(c: char) -> bool {
    matches!(c, ' '..='}') && !matches!(c, '!' | '?')
}

/// All that one pen draws. Coordinates are millimetres from the lower left corner, y up.
pub struct Pass {
    /// Millimetres; `None` for the outlines of filled areas.
    pub width: Option<f64>,
    /// sRGB with straight alpha.
    pub color: [u8; 4],
    /// Names of layers and what the pen draws of them.
    pub layers: Vec<(String, Vec<Stroke>)>,
}

impl Pass {
    /// What is to be drawn, in an order with a short way from `start`, and where the pen is then.
    pub fn order(strokes: Vec<Stroke>, start: DVec2) -> Vec<Vec<DVec2>> {
        ordered(strokes, start).into_iter().map(chain).collect()
    }

    fn length(&self) -> f64 {
        let all = self.layers.iter().flat_map(|l| &l.1);
        all.map(|s| dashes::length(&s.points, s.closed)).sum()
    }

    fn add(&mut self, layer: &str, strokes: impl IntoIterator<Item = Stroke>) {
        match self.layers.iter_mut().find(|l| l.0 == layer) {
            Some(found) => found.1.extend(strokes),
            None => self.layers.push((layer.to_owned(), strokes.into_iter().collect())),
        }
    }

    /// How unlike two pens are: first by colour, then by width.
    fn unlike(&self, other: &Self) -> (u32, f64) {
        let color = self.color.iter().zip(other.color).map(|(a, b)| u32::from(a.abs_diff(b)));
        let width = |pass: &Self| pass.width.unwrap_or(0.0);
        (color.sum(), (width(self) - width(other)).abs())
    }
}

/// The way of the pen through a stroke.
fn chain(stroke: Stroke) -> Vec<DVec2> {
    let Stroke { mut points, closed } = stroke;
    let again = points.first().copied().filter(|_| closed);
    points.extend(again);
    points
}

/// A sheet by pens of one width and colour, in the order of the sheet's pens; the outlines of areas come last.
/// Dashes and texts become strokes, as machines differ in theirs.
pub fn passes(sheet: &Sheet, pens: Option<usize>) -> Vec<Pass> {
    let mut found: Vec<Pass> = Vec::new();
    let mut areas = Pass { width: None, color: [0, 0, 0, 255], layers: Vec::new() };
    let mut pass_of: Vec<usize> = Vec::new();
    for pen in &sheet.pens {
        let same = |p: &Pass| p.width == Some(pen.width) && p.color == pen.color;
        let index = found.iter().position(same).unwrap_or(found.len());
        if index == found.len() {
            found.push(Pass { width: Some(pen.width), color: pen.color, layers: Vec::new() });
        }
        pass_of.push(index);
    }
    for layer in &sheet.layers {
        for mark in layer.marks.iter().flat_map(with_parts) {
            let pass = match mark {
                Mark::Fill { .. } => Some(&mut areas),
                Mark::Stroke { pen, .. } | Mark::Curve { pen, .. } | Mark::Text { pen, .. } => {
                    pass_of.get(*pen).and_then(|i| found.get_mut(*i))
                }
                Mark::Dimension(dimension) => {
                    pass_of.get(dimension.text.pen).and_then(|i| found.get_mut(*i))
                }
            };
            if let Some(pass) = pass {
                pass.add(&layer.name, strokes_of(mark, sheet));
            }
        }
    }
    found.push(areas);
    found.retain(|pass| !pass.layers.is_empty());
    fold(&mut found, pens.unwrap_or(usize::MAX));
    found
}

/// A mark and the marks that it is made of.
fn with_parts(mark: &Mark) -> impl Iterator<Item = &Mark> {
    let parts = match mark {
        Mark::Dimension(dimension) => &dimension.marks[..],
        _ => &[],
    };
    std::iter::once(mark).chain(parts)
}

/// Gives what the least used pens draw to those most like them, until so many are left.
fn fold(passes: &mut Vec<Pass>, most: usize) {
    while passes.len() > most.max(1) {
        let lengths: Vec<f64> = passes.iter().map(Pass::length).collect();
        let least = (0..passes.len()).min_by(|a, b| lengths[*a].total_cmp(&lengths[*b]));
        let Some(least) = least else { return };
        let given = passes.remove(least);
        let order = |a: &&mut Pass, b: &&mut Pass| {
            let ((c, w), (d, v)) = (given.unlike(a), given.unlike(b));
            c.cmp(&d).then(w.total_cmp(&v))
        };
        let Some(to) = passes.iter_mut().min_by(order) else { return };
        given.layers.into_iter().for_each(|(name, strokes)| to.add(&name, strokes));
    }
}

/// A mark as strokes of a pen.
fn strokes_of(mark: &Mark, sheet: &Sheet) -> Vec<Stroke> {
    let height = sheet.size.y;
    let stroke = |points: &[DVec2], closed: bool| {
        let points = points.iter().map(|p| DVec2::new(p.x, height - p.y));
        Stroke { points: points.collect(), closed }
    };
    let open = |chains: Vec<Vec<DVec2>>| chains.iter().map(|c| stroke(c, false)).collect();
    let dashed = |points: &[DVec2], closed: bool, pen: usize| match sheet.pens.get(pen) {
        Some(pen) if !pen.dashes.is_empty() => open(dashes::cut(points, closed, &pen.dashes)),
        _ => vec![stroke(points, closed)],
    };
    match mark {
        Mark::Stroke { points, closed, pen } => dashed(points, *closed, *pen),
        Mark::Curve { curve, pen } => dashed(&pieces::points(curve, CHORDS), curve.closed, *pen),
        Mark::Fill { rings, .. } => rings.iter().map(|ring| stroke(ring, true)).collect(),
        Mark::Text { at, text, height, anchor, .. } => {
            open(text_strokes(*at, text, *height, *anchor))
        }
        Mark::Dimension(dimension) => open(dimension_strokes(&dimension.text)),
    }
}
