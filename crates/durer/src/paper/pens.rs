//! Pens of the line classes.

use crate::target::drawing::{LineClass, NEARNESS_STEPS};
use crate::target::sheet::Pen;
use crate::{Error, Result};
use std::str::FromStr;

/// The width of a stroke for every class of line, in millimetres, and their colours.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pens {
    /// Widths by class, in the order of [`LineClass::ALL`].
    widths: [f64; LineClass::ALL.len()],
    /// Hidden lines of every class.
    hidden: f64,
    /// sRGB with straight alpha, of all visible lines.
    pub color: [u8; 4],
}

/// The widest pen, in millimetres.
const WIDEST: f64 = 100.0;

/// Dashes and gaps between their round ends look like 10 and 4 widths, as on drawings to ISO 128.
const DASH: [f64; 2] = [9.0, 5.0];
/// Lines thinner than this are dashed like this one: shorter dashes are hard to make out.
const THINNEST_DASHED: f64 = 0.18;

/// Factor of a pen's width by step of nearness, and how far it fades to white.
pub const NEARNESS: [(f64, f64); NEARNESS_STEPS as usize] =
    [(1.4, 0.0), (1.0, 0.15), (0.7, 0.35), (0.5, 0.55)];

/// Hidden lines that are drawn solid are grey.
const HIDDEN_GREY: u8 = 0x90;

impl Default for Pens {
    /// Returns the default: contours 0.7 mm, outlines and dots 0.5 mm, edges and the model's own lines 0.35 mm, lines
    /// on surfaces (tangents, wires, shadows, hatching) 0.18 mm, all others and hidden lines 0.25 mm; black.
    fn default() -> Self {
        let mut pens =
            Self { widths: [0.25; LineClass::ALL.len()], hidden: 0.25, color: [0, 0, 0, 255] };
        for &class in LineClass::ALL {
            use LineClass::{
                Axis, Border, Break, Contour, Crease, Grid, Hatch, Intersection, Mark, Material,
                NonManifold, Section, Shadow, Silhouette, Stipple, Tangent, Wire,
            };
            let width = match class {
                Contour => 0.7,
                Silhouette | Border | Section | Stipple => 0.5,
                Crease | NonManifold | Intersection | Mark => 0.35,
                Material | Grid | Axis | Break => 0.25,
                Tangent | Wire | Shadow | Hatch => 0.18,
            };
            pens.set(class, width);
        }
        pens
    }
}

impl Pens {
    /// Returns the width for a class of visible lines, millimetres.
    pub fn width(&self, class: LineClass) -> f64 {
        LineClass::ALL
            .iter()
            .zip(&self.widths)
            .find(|(c, _)| **c == class)
            .map_or(0.25, |(_, w)| *w)
    }

    fn set(&mut self, class: LineClass, width: f64) {
        for (c, w) in LineClass::ALL.iter().zip(&mut self.widths) {
            if *c == class {
                *w = width;
            }
        }
    }

    /// Returns the pen for visible lines of a class.
    pub(crate) fn visible(&self, class: LineClass) -> Pen {
        Pen { width: self.width(class), color: self.color, dashes: Vec::new() }
    }

    /// Returns the pen for visible lines of a class at a step of
    /// [`crate::target::drawing::Drawing::nearness`]: the nearer, the wider and darker.
    pub(crate) fn at_nearness(&self, class: LineClass, step: Option<u8>) -> Pen {
        let pen = self.visible(class);
        let Some((factor, fade)) = step.and_then(|s| NEARNESS.get(usize::from(s))) else {
            return pen;
        };
        let [r, g, b, a] = pen.color;
        let faded = |c: u8| c + (f64::from(255 - c) * fade).round() as u8;
        Pen { width: pen.width * factor, color: [faded(r), faded(g), faded(b), a], ..pen }
    }

    /// Returns the widest of its pens for visible lines, millimetres: with that for contours or
    /// without.
    pub(crate) fn widest(&self, contours: bool) -> f64 {
        let some = LineClass::ALL.iter().filter(|c| contours || **c != LineClass::Contour);
        some.map(|c| self.width(*c)).fold(0.0, f64::max)
    }

    /// Returns the pen for hidden lines: no wider than the class's own.
    pub(crate) fn hidden(&self, class: LineClass, dashed: bool) -> Pen {
        let width = self.hidden.min(self.width(class));
        if dashed {
            let unit = width.max(THINNEST_DASHED);
            return Pen { width, color: self.color, dashes: DASH.map(|d| d * unit).to_vec() };
        }
        let [r, g, b, a] = self.color;
        let grey = |c: u8| c.max(HIDDEN_GREY);
        Pen { width, color: [grey(r), grey(g), grey(b), a], dashes: Vec::new() }
    }
}

impl FromStr for Pens {
    type Err = Error;

    /// Parses `WIDTH[,CLASS=WIDTH…]` in millimetres, e.g. `0.35,silhouette=0.7,hidden=0.18`; the first width is for
    /// all that are not named, and may be left out.
    fn from_str(text: &str) -> Result<Self> {
        let expected = "WIDTH[,CLASS=WIDTH…] in millimetres above 0, e.g. \
                        0.35,silhouette=0.7,hidden=0.18; classes are those of --lines, and hidden";
        let wrong = |what: &str| Error::parameter("pen", what, expected);
        let width = |s: &str| {
            let width = s.trim().parse().ok().filter(|w: &f64| *w > 0.0 && *w <= WIDEST);
            width.ok_or_else(|| wrong(s))
        };
        let mut pens = Self::default();
        for (i, part) in text.split(',').enumerate() {
            match part.split_once('=') {
                None if i == 0 => {
                    pens.hidden = width(part)?;
                    pens.widths = [pens.hidden; LineClass::ALL.len()];
                }
                None => return Err(wrong(part)),
                Some((name, value)) if name.trim() == "hidden" => pens.hidden = width(value)?,
                Some((name, value)) => {
                    let class = name.trim().parse().map_err(|_| wrong(part))?;
                    pens.set(class, width(value)?);
                }
            }
        }
        Ok(pens)
    }
}
