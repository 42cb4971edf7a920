//! The order of work of a machine with pens: pen by pen, each picked up once, and layer by layer.

use super::dxf_curve::turned_up;
use crate::{Error, Result};
use durer::curve::pieces;
use durer::math::DVec2;
use durer::paper::order::{Chain, PenStroke, ordered_chains};
use durer::paper::{dashes, dimension_strokes, text_strokes};
use durer::target::sheet::{PaperMark, Sheet};

/// Largest distance between chords and curves, in millimetres: less than half of a step of
/// plotters.
pub const CHORDS: f64 = 0.01;

/// Options for machines that draw.
#[derive(Debug, Clone, PartialEq)]
pub struct MachineOptions {
    /// Number of pens; strokes of a sheet that has more are drawn with the most similar pen.
    pub pens: Option<usize>,
    /// Speed of a drawing pen, in millimetres a minute.
    pub feed: f64,
    /// Speed of the raised pen, in millimetres a minute; `None` for as fast as the machine moves.
    pub travel: Option<f64>,
    /// True if the machine knows arcs in G-code, G2 and G3; else they are chords.
    pub arcs: bool,
    /// The lines of G-code that put the pen down.
    pub pen_down: String,
    /// Commands that lift the pen.
    pub pen_up: String,
}

impl Default for MachineOptions {
    /// Returns the default: 1500 mm a minute, and a servo on the spindle's output, as GRBL has it, with 0.2 s to turn.
    fn default() -> Self {
        Self {
            pens: None,
            feed: 1500.0,
            travel: None,
            arcs: true,
            pen_down: "M3 S1000\nG4 P0.2".to_owned(),
            pen_up: "M5\nG4 P0.2".to_owned(),
        }
    }
}

impl MachineOptions {
    /// Checks the options.
    ///
    /// # Errors
    /// [`Error::Library`] for a speed that is not above 0, no pens, and commands with characters that machines
    /// misinterpret.
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

/// Returns whether a character is text for every machine. GRBL obeys some, and all beyond ASCII, within
/// comments too.
pub fn is_plain(c: char) -> bool {
    matches!(c, ' '..='}') && !matches!(c, '!' | '?')
}

/// All that one pen draws. Coordinates are millimetres from the lower left corner, y up.
pub struct Pass {
    /// Millimetres; `None` for the outlines of filled areas.
    pub width: Option<f64>,
    /// sRGB with straight alpha.
    pub color: [u8; 4],
    /// Names of layers, and the chains that the pen draws of them.
    pub layers: Vec<(String, Vec<Chain>)>,
}

impl Pass {
    fn length(&self) -> f64 {
        let all = self.layers.iter().flat_map(|l| &l.1);
        all.map(|chain| match chain {
            Chain::Straight(stroke) => dashes::length(&stroke.points, stroke.closed),
            Chain::Curved(curve) => pieces::length(curve),
        })
        .sum()
    }

    fn add(&mut self, layer: &str, chains: impl IntoIterator<Item = Chain>) {
        match self.layers.iter_mut().find(|l| l.0 == layer) {
            Some(found) => found.1.extend(chains),
            None => self.layers.push((layer.to_owned(), chains.into_iter().collect())),
        }
    }

    /// Returns how much two pens differ: first by colour, then by width.
    fn unlike(&self, other: &Self) -> (u32, f64) {
        let color = self.color.iter().zip(other.color).map(|(a, b)| u32::from(a.abs_diff(b)));
        let width = |pass: &Self| pass.width.unwrap_or(0.0);
        (color.sum(), (width(self) - width(other)).abs())
    }
}

/// The path of a pen: its start, and for each arc or line its end and its bulge, the tangent of a quarter of its
/// turn, above 0 counter-clockwise, 0 for lines.
pub struct Way {
    pub start: DVec2,
    pub steps: Vec<(DVec2, f64)>,
}

/// Returns the paths to draw, in an order with short moves of the lifted pen from `start` on.
pub fn ways(chains: Vec<Chain>, start: DVec2) -> Vec<Way> {
    ordered_chains(chains, start).into_iter().filter_map(way).collect()
}

fn way(chain: Chain) -> Option<Way> {
    match chain {
        Chain::Straight(PenStroke { points, closed }) => {
            let start = *points.first()?;
            let rest = points.into_iter().skip(1).chain(closed.then_some(start));
            Some(Way { start, steps: rest.map(|p| (p, 0.0)).collect() })
        }
        Chain::Curved(curve) => {
            Some(Way { start: curve.start, steps: pieces::arcs(&curve, CHORDS) })
        }
    }
}

/// Returns a sheet by pens of one width and colour, in the order of the sheet's pens; the outlines of areas
/// come last. Dashes and texts become strokes, because machines' own differ; without `arcs`, curves become strokes too.
pub fn passes(sheet: &Sheet, pens: Option<usize>, arcs: bool) -> Vec<Pass> {
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
                PaperMark::Fill { .. } | PaperMark::Area { .. } => Some(&mut areas),
                // Files with groups are refused.
                PaperMark::Gradient(_) | PaperMark::Group(_) => None,
                PaperMark::Stroke { pen, .. }
                | PaperMark::Curve { pen, .. }
                | PaperMark::Text { pen, .. } => pass_of.get(*pen).and_then(|i| found.get_mut(*i)),
                PaperMark::Dimension(dimension) => {
                    pass_of.get(dimension.text.pen).and_then(|i| found.get_mut(*i))
                }
            };
            if let Some(pass) = pass {
                pass.add(&layer.name, chains_of(mark, sheet, arcs));
            }
        }
    }
    found.push(areas);
    found.retain(|pass| !pass.layers.is_empty());
    fold(&mut found, pens.unwrap_or(usize::MAX));
    found
}

/// Returns a mark and the marks that it consists of.
fn with_parts(mark: &PaperMark) -> impl Iterator<Item = &PaperMark> {
    let parts = match mark {
        PaperMark::Dimension(dimension) => &dimension.marks[..],
        _ => &[],
    };
    std::iter::once(mark).chain(parts)
}

/// Moves the chains of the least used pens to the pens most like them, until this many are left.
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
        given.layers.into_iter().for_each(|(name, chains)| to.add(&name, chains));
    }
}

/// Returns a mark as chains for pens.
fn chains_of(mark: &PaperMark, sheet: &Sheet, arcs: bool) -> Vec<Chain> {
    let height = sheet.size.y;
    let stroke = |points: &[DVec2], closed: bool| {
        let points = points.iter().map(|p| DVec2::new(p.x, height - p.y));
        Chain::Straight(PenStroke { points: points.collect(), closed })
    };
    let open = |chains: Vec<Vec<DVec2>>| chains.iter().map(|c| stroke(c, false)).collect();
    let dashes = |pen: usize| sheet.pens.get(pen).map(|p| &p.dashes[..]).unwrap_or_default();
    let dashed = |points: &[DVec2], closed: bool, pen: usize| match dashes(pen) {
        [] => vec![stroke(points, closed)],
        dashes => open(dashes::cut(points, closed, dashes)),
    };
    match mark {
        PaperMark::Stroke { points, closed, pen } => dashed(points, *closed, *pen),
        PaperMark::Curve { curve, pen } if arcs && dashes(*pen).is_empty() => {
            vec![Chain::Curved(turned_up(curve, height))]
        }
        PaperMark::Curve { curve, pen } => {
            dashed(&pieces::points(curve, CHORDS), curve.closed, *pen)
        }
        PaperMark::Fill { rings, .. } => rings.iter().map(|ring| stroke(ring, true)).collect(),
        PaperMark::Area { rings, .. } if arcs => {
            rings.iter().map(|ring| Chain::Curved(turned_up(ring, height))).collect()
        }
        PaperMark::Area { rings, .. } => {
            rings.iter().map(|ring| stroke(&pieces::points(ring, CHORDS), true)).collect()
        }
        PaperMark::Text { at, text, height, anchor, .. } => {
            open(text_strokes(*at, text, *height, *anchor))
        }
        PaperMark::Dimension(dimension) => open(dimension_strokes(&dimension.text)),
        PaperMark::Gradient(_) | PaperMark::Group(_) => Vec::new(),
    }
}
