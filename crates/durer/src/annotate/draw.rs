//! Dimensions and leaders, drawn at a given place.

use super::board::{Board, Draft, arc_mark, mark, text_mark};
use super::quad::Quad;
use super::style::{GAP, OVER, Style};
use crate::curve::stroke_font;
use crate::math::DVec2;
use crate::sorting::CompactSort;
use crate::target::dimension::{DimensionText, Measure};
use crate::target::sheet::Dimension;
use crate::target::sheet::PaperMark;

/// Text of a dimension.
#[derive(Debug, Clone)]
pub(super) struct Said {
    pub text: String,
    /// True if it is just the value with its sign.
    pub is_plain: bool,
    /// Value in units of the model, or radians.
    pub value: f64,
    /// Units of the model per millimetre.
    pub scale: f64,
}

/// A linear dimension.
#[derive(Debug, Clone, Copy)]
pub(super) struct Linear {
    pub ends: [DVec2; 2],
    /// A point of the dimension line.
    pub line: DVec2,
    /// Direction of the dimension line, of unit length.
    pub along: DVec2,
}

/// Returns the direction of texts along a line: to the right, or upwards.
pub(super) fn reading(along: DVec2) -> DVec2 {
    let backwards = along.x < -1e-6 || (along.x < 1e-6 && along.y > 0.0);
    if backwards { -along } else { along }
}

/// Returns the direction above a text, at a right angle to the text's own.
fn above(along: DVec2) -> DVec2 {
    DVec2::new(along.y, -along.x)
}

/// Returns a filled arrow head; `body` is the direction from its tip into it.
fn arrow(tip: DVec2, body: DVec2, style: &Style) -> PaperMark {
    let (back, side) = (tip + body * style.arrow, body.perp() * (style.arrow / 6.0));
    PaperMark::Fill {
        rings: vec![vec![tip, back + side, back - side]],
        color: style.color,
        even_odd: false,
    }
}

fn stroke(points: Vec<DVec2>, pen: usize) -> PaperMark {
    PaperMark::Stroke { points, closed: false, pen }
}

impl Board<'_> {
    /// Returns a dimension line with its extension lines, arrows and text. Distances too short for arrows
    /// have them outside, and the text beside them if it is too long.
    pub fn linear(&mut self, l: &Linear, said: &Said) -> Draft {
        let (style, thin, letters) = (self.style, self.thin(), self.letters());
        let along = reading(l.along);
        let mut ends = l.ends;
        ends.compact_sort_by(|p, q| p.dot(along).total_cmp(&q.dot(along)));
        let feet = ends.map(|p| l.line + along * (p - l.line).dot(along));
        let [from, to] = feet;
        let (length, width) = (to.distance(from), self.width(&said.text));
        let inside = length >= 2.0 * style.arrow + 1.5;
        let fits = width + 2.0 * GAP <= length;
        let (mut start, mut end) = (0.0, length);
        if !inside {
            (start, end) = (-2.0 * style.arrow, length + 2.0 * style.arrow);
        }
        let middle = if fits {
            length * 0.5
        } else {
            let first = length + GAP + if inside { GAP } else { style.arrow };
            end = end.max(first + width);
            first + width * 0.5
        };
        let mut marks = Vec::new();
        for (p, foot) in ends.into_iter().zip(feet) {
            let way = (foot - p).normalize_or_zero();
            if foot.distance(p) > GAP {
                marks.push(stroke(vec![p + way * GAP, foot + way * OVER], thin));
            }
        }
        marks.push(stroke(vec![from + along * start, from + along * end], thin));
        let body = if inside { along } else { -along };
        marks.extend([arrow(from, body, &style), arrow(to, -body, &style)]);
        let at = from + along * middle + above(along) * GAP;
        let line = Quad::of_segment(from + along * start, from + along * end, 0.5);
        let measure = Measure::Linear { ends, line: from, along };
        self.draft(
            measure,
            said,
            marks,
            DimensionText { at, along, text: said.text.clone(), height: style.text, pen: letters },
            vec![line],
            None,
        )
    }

    /// Returns a leader from a point to an elbow and on below its text. `measure` is the measured quantity,
    /// `None` for a note.
    pub fn leader(
        &mut self,
        tip: DVec2,
        elbow: DVec2,
        said: &Said,
        measure: Option<Measure>,
    ) -> Draft {
        let (style, thin, letters) = (self.style, self.thin(), self.letters());
        let width = self.width(&said.text);
        let sign = if elbow.x >= tip.x { 1.0 } else { -1.0 };
        let end = elbow + DVec2::new(sign * (width + GAP), 0.0);
        let body = (elbow - tip).normalize_or_zero();
        let lines = vec![stroke(vec![tip, elbow, end], thin), arrow(tip, body, &style)];
        let at = DVec2::new((elbow.x + end.x) * 0.5, elbow.y - GAP);
        // Two texts side by side on one line would be read as one.
        let apart = DVec2::X * (sign * style.text * 0.5);
        let landing = Quad::of_segment(elbow - apart, end + apart, 0.5);
        let leader = Some([tip + body * 0.5, elbow]);
        let text = DimensionText {
            at,
            along: DVec2::X,
            text: said.text.clone(),
            height: style.text,
            pen: letters,
        };
        match measure {
            Some(measure) => self.draft(measure, said, lines, text, vec![landing], leader),
            None => {
                let quad = Quad::of_dimension(&text);
                let words = text_mark(at, said.text.clone(), style.text, letters);
                let marks = lines.into_iter().chain([words]).collect();
                Draft { mark: marks, solid: vec![landing, quad], text: quad, leader }
            }
        }
    }

    /// Returns the angle at a vertex between two points, counter-clockwise as seen, with its arc through
    /// `radius`.
    pub fn angle(&mut self, vertex: DVec2, ends: [DVec2; 2], radius: f64, said: &Said) -> Draft {
        let (style, thin, letters) = (self.style, self.thin(), self.letters());
        let [from, to] = ends.map(|p| {
            let d = p - vertex;
            libm::atan2(-d.y, d.x)
        });
        let turn = (to - from).rem_euclid(std::f64::consts::TAU);
        let at = |angle: f64| {
            let (sin, cos) = libm::sincos(angle);
            vertex + DVec2::new(cos, -sin) * radius
        };
        let mut marks = vec![arc_mark(vertex, radius, from, turn, thin)];
        for p in ends {
            let (way, far) = ((p - vertex).normalize_or_zero(), p.distance(vertex));
            if far + GAP < radius {
                let line = vec![p + way * GAP, vertex + way * (radius + OVER)];
                marks.push(stroke(line, thin));
            }
        }
        let head = (style.arrow / radius).min(turn * 0.4);
        let body = |tip: f64, inner: f64| (at(inner) - at(tip)).normalize_or_zero();
        marks.push(arrow(at(from), body(from, from + head), &style));
        marks.push(arrow(at(from + turn), body(from + turn, from + turn - head), &style));
        let (sin, cos) = libm::sincos(from + turn * 0.5);
        // The text's middle is outside the arc by half its size in that direction.
        let half = DVec2::new(self.width(&said.text), style.text) * 0.5;
        let out = radius + GAP + half.x * cos.abs() + half.y * sin.abs();
        let middle = vertex + DVec2::new(cos, -sin) * out;
        let text = DimensionText {
            at: middle + DVec2::new(0.0, style.text * 0.5),
            along: DVec2::X,
            text: said.text.clone(),
            height: style.text,
            pen: letters,
        };
        let measure = Measure::Angle { vertex, ends, arc: at(from + turn * 0.5) };
        self.draft(measure, said, marks, text, Vec::new(), None)
    }

    pub fn width(&self, text: &str) -> f64 {
        stroke_font::line(text, self.style.text).advance
    }

    fn draft(
        &self,
        measure: Measure,
        said: &Said,
        marks: Vec<PaperMark>,
        text: DimensionText,
        mut solid: Vec<Quad>,
        leader: Option<[DVec2; 2]>,
    ) -> Draft {
        let quad = Quad::of_dimension(&text);
        solid.push(quad);
        let &Said { value, scale: units_per_millimetre, is_plain, .. } = said;
        let dimension = Dimension { measure, value, units_per_millimetre, is_plain, marks, text };
        Draft { mark: vec![mark(dimension)], solid, text: quad, leader }
    }
}
