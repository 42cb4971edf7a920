//! Shapes of CSS, as `clip-path` has them.
//!
//! Source: *CSS Shapes Module Level 1*, W3C; *CSS Masking Module Level 1*, W3C, § 5.

use super::outline::Bounds;
use super::transform;
use crate::css::{Piece, Token, Units, Whole, split, tokens, words};
use durer::math::DVec2;
use std::fmt::Write as _;

/// Base of a shape's percentages.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Reference {
    /// The box around the filled shape.
    Fill,
    /// The box, enlarged by the stroke.
    Stroke,
    /// Base of the drawing's own percentages.
    View,
}

/// An area to clip by.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Area {
    /// Path data.
    pub data: String,
    pub is_even_odd: bool,
}

/// A shape that is not placed yet.
#[derive(Debug, Clone)]
pub(super) struct Shape<'a> {
    pieces: Vec<Piece<'a>>,
    pub reference: Reference,
    text: &'a str,
}

impl<'a> Shape<'a> {
    /// Reads a shape, a box, or both; `None` for other values.
    pub fn parse(text: &'a str) -> Option<Self> {
        let mut pieces = tokens(text);
        let (mut reference, mut has_box) = (Reference::Stroke, false);
        let mut open = 0_u32;
        for piece in &mut pieces {
            match &piece.token {
                Token::Function(_) | Token::Open(_) => open += 1,
                Token::Close(_) => open = open.saturating_sub(1),
                Token::Ident(word) if open == 0 => {
                    reference = match word.to_ascii_lowercase().as_str() {
                        "fill-box" | "content-box" | "padding-box" => Reference::Fill,
                        "stroke-box" | "border-box" | "margin-box" => Reference::Stroke,
                        "view-box" => Reference::View,
                        _ => return None,
                    };
                    has_box = true;
                    piece.token = Token::Blank;
                }
                Token::Blank => {}
                _ if open == 0 => return None,
                _ => {}
            }
        }
        let has_shape = pieces.iter().any(|piece| matches!(piece.token, Token::Function(_)));
        (has_shape || has_box).then_some(Self { pieces, reference, text })
    }

    /// Returns the area of the shape in its box.
    pub fn area(&self, bounds: Bounds, units: &Units) -> Option<Area> {
        let (low, size) = (bounds.low, bounds.size());
        let Some(at) =
            self.pieces.iter().position(|piece| matches!(piece.token, Token::Function(_)))
        else {
            return Some(Area {
                data: rectangle(low, bounds.high, &[DVec2::ZERO; 4]),
                is_even_odd: false,
            });
        };
        let piece = self.pieces.get(at)?;
        let Token::Function(name) = &piece.token else { return None };
        let inside = self.pieces.get(at + 1..piece.mate.min(self.pieces.len()))?;
        let within = Within { low, size, units };
        let plain = |data: String| Some(Area { data, is_even_odd: false });
        match name.to_ascii_lowercase().as_str() {
            "circle" => plain(within.circle(inside, self.text)?),
            "ellipse" => plain(within.ellipse(inside, self.text)?),
            "inset" | "rect" | "xywh" => plain(within.inset(&name.to_ascii_lowercase(), inside)?),
            "polygon" => within.polygon(inside),
            "path" => {
                let (is_even_odd, rest) = with_rule(inside);
                let Token::String(data) = &rest.first()?.first()?.token else { return None };
                let data = super::arcs::as_curves(data).unwrap_or_else(|| data.to_string());
                let moved = moved(&data, low)?;
                Some(Area { data: moved, is_even_odd })
            }
            _ => None,
        }
    }
}

/// Returns the path data, moved.
fn moved(data: &str, by: DVec2) -> Option<String> {
    use svgtypes::SimplePathSegment as Segment;
    let mut out = String::new();
    let p = |x: f64, y: f64| format!("{} {} ", x + by.x, y + by.y);
    for segment in svgtypes::SimplifyingPathParser::from(data) {
        match segment.ok()? {
            Segment::MoveTo { x, y } => write!(out, "M{}", p(x, y)).ok()?,
            Segment::LineTo { x, y } => write!(out, "L{}", p(x, y)).ok()?,
            Segment::CurveTo { x1, y1, x2, y2, x, y } => {
                write!(out, "C{}{}{}", p(x1, y1), p(x2, y2), p(x, y)).ok()?
            }
            Segment::Quadratic { x1, y1, x, y } => write!(out, "Q{}{}", p(x1, y1), p(x, y)).ok()?,
            Segment::ClosePath => out.push('Z'),
        }
    }
    Some(out)
}

/// Returns whether the first part says to fill by the even-odd rule, and the other parts.
fn with_rule<'a, 'b>(inside: &'b [Piece<'a>]) -> (bool, Vec<&'b [Piece<'a>]>) {
    let mut parts = split(inside, ',');
    let rule = match parts.first() {
        Some([Piece { token: Token::Ident(word), .. }]) => {
            Some(word.eq_ignore_ascii_case("evenodd"))
        }
        _ => None,
    };
    if rule.is_some() {
        parts.remove(0);
    }
    (rule.unwrap_or(false), parts)
}

struct Within<'a> {
    low: DVec2,
    size: DVec2,
    units: &'a Units,
}

impl Within<'_> {
    fn length(&self, part: &[Piece<'_>], whole: f64) -> Option<f64> {
        self.units.value(part, Some(Whole::Length(whole)))?.length()
    }

    /// Returns the words before `at`, and the place after it.
    fn place<'a, 'b>(
        &self,
        inside: &'b [Piece<'a>],
        text: &str,
    ) -> Option<(Vec<&'b [Piece<'a>]>, DVec2)> {
        let at = inside.iter().position(|piece| piece.token.is_word("at"));
        let (before, place) = match at {
            Some(at) => {
                let rest = inside.get(at + 1..)?;
                let (first, last) = (rest.first()?, rest.last()?);
                (inside.get(..at)?, text.get(first.start..last.end)?)
            }
            None => (inside, "center"),
        };
        let place =
            transform::origin(place, self.units, self.low.to_array(), self.size.to_array())?;
        Some((words(before), place))
    }

    /// Returns a radius: a length or a percentage of `whole`, or a word for the distance to a side.
    fn radius(&self, part: Option<&[Piece<'_>]>, whole: f64, [near, far]: [f64; 2]) -> Option<f64> {
        let Some(part) = part else { return Some(near) };
        match part {
            [piece] if piece.token.is_word("closest-side") => Some(near),
            [piece] if piece.token.is_word("farthest-side") => Some(far),
            _ => self.length(part, whole).filter(|r| *r >= 0.0),
        }
    }

    /// Returns the distances of a place to the nearer and the farther side, along both axes.
    fn sides(&self, place: DVec2) -> [[f64; 2]; 2] {
        let (a, b) = ((place - self.low).abs(), (self.low + self.size - place).abs());
        [[a.x.min(b.x), a.x.max(b.x)], [a.y.min(b.y), a.y.max(b.y)]]
    }

    fn circle(&self, inside: &[Piece<'_>], text: &str) -> Option<String> {
        let (before, place) = self.place(inside, text)?;
        let [x, y] = self.sides(place);
        let whole = self.size.length() / std::f64::consts::SQRT_2;
        let r = self.radius(before.first().copied(), whole, [x[0].min(y[0]), x[1].max(y[1])])?;
        (before.len() < 2).then(|| oval(place, DVec2::splat(r)))
    }

    fn ellipse(&self, inside: &[Piece<'_>], text: &str) -> Option<String> {
        let (before, place) = self.place(inside, text)?;
        let [x, y] = self.sides(place);
        let rx = self.radius(before.first().copied(), self.size.x, x)?;
        let ry = self.radius(before.get(1).copied(), self.size.y, y)?;
        matches!(before.len(), 0 | 2).then(|| oval(place, DVec2::new(rx, ry)))
    }

    fn polygon(&self, inside: &[Piece<'_>]) -> Option<Area> {
        let (is_even_odd, parts) = with_rule(inside);
        let mut data = String::new();
        for part in parts {
            let both = words(part);
            let [x, y] = both.as_slice() else { return None };
            let p =
                self.low + DVec2::new(self.length(x, self.size.x)?, self.length(y, self.size.y)?);
            data.push(if data.is_empty() { 'M' } else { 'L' });
            write!(data, "{} {} ", p.x, p.y).ok()?;
        }
        data.push('Z');
        Some(Area { data, is_even_odd })
    }

    /// Returns a rectangle, perhaps with round corners: by distances from the sides, by its sides, or by its
    /// corner and size.
    fn inset(&self, name: &str, inside: &[Piece<'_>]) -> Option<String> {
        let round = inside.iter().position(|piece| piece.token.is_word("round"));
        let before = words(inside.get(..round.unwrap_or(inside.len()))?);
        let whole = |i: usize| if i.is_multiple_of(2) { self.size.y } else { self.size.x };
        let mut given = Vec::new();
        for (i, part) in before.iter().enumerate() {
            let whole = if name == "xywh" { whole(i + 1) } else { whole(i) };
            let is_auto = matches!(part, [piece] if piece.token.is_word("auto"));
            given.push(match (is_auto && name == "rect", i) {
                (true, 0 | 3) => 0.0,
                (true, _) => whole,
                _ => self.length(part, whole)?,
            });
        }
        let (low, high) = match (name, given.as_slice()) {
            ("rect", [top, right, bottom, left]) => {
                (DVec2::new(*left, *top), DVec2::new(right.max(*left), bottom.max(*top)))
            }
            ("xywh", [x, y, w, h]) => (DVec2::new(*x, *y), DVec2::new(x + w, y + h)),
            ("inset", given) => {
                let [mut top, mut right, mut bottom, mut left] = four(given)?;
                for (a, b, whole) in
                    [(&mut top, &mut bottom, self.size.y), (&mut left, &mut right, self.size.x)]
                {
                    let sum = *a + *b;
                    if sum > whole {
                        (*a, *b) = (*a * whole / sum, *b * whole / sum);
                    }
                }
                (DVec2::new(left, top), self.size - DVec2::new(right, bottom))
            }
            _ => return None,
        };
        let radii = match round {
            Some(round) => self.radii(inside.get(round + 1..)?, high - low)?,
            None => [DVec2::ZERO; 4],
        };
        Some(rectangle(self.low + low, self.low + high, &radii))
    }

    /// Returns the radii of corners from the upper left one on, clockwise, as `border-radius` says them; made
    /// smaller where sides are too short for them.
    fn radii(&self, pieces: &[Piece<'_>], size: DVec2) -> Option<[DVec2; 4]> {
        let halves = split(pieces, '/');
        let of = |half: &[Piece<'_>], whole: f64| {
            let all: Option<Vec<f64>> =
                words(half).into_iter().map(|part| self.length(part, whole)).collect();
            four(&all?)
        };
        let x = of(halves.first()?, self.size.x)?;
        let y = of(halves.get(1).or(halves.first())?, self.size.y)?;
        let radii = [0, 1, 2, 3].map(|i| DVec2::new(x[i], y[i]).max(DVec2::ZERO));
        let [a, b, c, d] = radii;
        let sums =
            [(size.x, a.x + b.x), (size.x, c.x + d.x), (size.y, a.y + d.y), (size.y, b.y + c.y)];
        let fits = sums.iter().filter(|(_, sum)| *sum > 0.0).map(|(side, sum)| side / sum);
        let factor = fits.fold(1.0, f64::min);
        Some(radii.map(|r| r * factor))
    }
}

/// Returns four values from one to four, as `margin` has it.
fn four(given: &[f64]) -> Option<[f64; 4]> {
    Some(match *given {
        [a] => [a; 4],
        [a, b] => [a, b, a, b],
        [a, b, c] => [a, b, c, b],
        [a, b, c, d] => [a, b, c, d],
        _ => return None,
    })
}

/// Returns a rectangle with rounded corners, from the upper left one on, clockwise.
fn rectangle(low: DVec2, high: DVec2, radii: &[DVec2; 4]) -> String {
    let [a, b, c, d] = *radii;
    let arc = |r: DVec2, x: f64, y: f64| format!("A{} {} 0 0 1 {x} {y}", r.x, r.y);
    let data = format!(
        "M{} {}H{}{}V{}{}H{}{}V{}{}Z",
        low.x + a.x,
        low.y,
        high.x - b.x,
        arc(b, high.x, low.y + b.y),
        high.y - c.y,
        arc(c, high.x - c.x, high.y),
        low.x + d.x,
        arc(d, low.x, high.y - d.y),
        low.y + a.y,
        arc(a, low.x + a.x, low.y),
    );
    super::arcs::as_curves(&data).unwrap_or(data)
}

fn oval(center: DVec2, r: DVec2) -> String {
    rectangle(center - r, center + r, &[r; 4])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area(text: &str) -> Option<Area> {
        let bounds = Bounds { low: DVec2::new(10.0, 20.0), high: DVec2::new(110.0, 70.0) };
        Shape::parse(text)?.area(bounds, &Units::default())
    }

    #[test]
    fn shapes_lie_in_their_box() {
        let polygon = area("polygon(evenodd, 0 0, 50% 10px, 100% 100%) fill-box").unwrap();
        assert_eq!(polygon.data, "M10 20 L60 30 L110 70 Z");
        assert!(polygon.is_even_odd);
        assert!(area("inset(10% 5px)").unwrap().data.starts_with("M15 25 L105 25 "));
        assert!(area("rect(auto 50px auto 0)").unwrap().data.starts_with("M10 20 L60 20 "));
        assert!(area("xywh(1px 2px 3px 4px)").unwrap().data.starts_with("M11 22 L14 22 "));
        assert_eq!(area("path('M0 0h5v5z')").unwrap().data, "M10 20 L15 20 L15 25 Z");
        assert_eq!(area("fill-box").unwrap().data, area("inset(0)").unwrap().data);
        // The first point of a circle is its highest one.
        for (text, top) in [
            ("circle()", "M60 20 "),
            ("circle(10px at 0 0)", "M10 10 "),
            ("circle(farthest-side)", "M60 -5 "),
            ("ellipse(10% 20% at left bottom)", "M10 60 "),
            ("ellipse()", "M60 20 "),
        ] {
            let data = area(text).unwrap().data;
            assert!(data.starts_with(top), "{text}: {data}");
        }
        assert_eq!(Shape::parse("circle() view-box").unwrap().reference, Reference::View);
        let round = area("inset(0 round 60px)").unwrap().data;
        assert!(round.starts_with("M35 20 L85 20 C"), "{round}");
    }

    #[test]
    fn what_is_no_shape() {
        for text in [
            "",
            "none",
            "url(#a)",
            "blob()",
            "circle(1px 2px)",
            "polygon(1px)",
            "circle(-1px)",
            "inset()",
            "circle(",
            "path(1)",
        ] {
            assert!(area(text).is_none() || text == "circle(", "{text}");
        }
    }
}
