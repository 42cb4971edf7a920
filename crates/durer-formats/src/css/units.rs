//! Numbers, lengths and angles of CSS, and calculations with `calc()`.
//!
//! Source: *CSS Values and Units Module Level 4*, W3C.

use super::tokens::{Piece, Token};

/// `calc()` and parentheses within one another may be so deep.
const MAX_DEPTH: u32 = 32;

/// Lengths of relative units, in pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Units {
    pub font_size: f64,
    pub root_font_size: f64,
    /// Width and height to which percentages refer.
    pub viewport: [f64; 2],
}

impl Default for Units {
    fn default() -> Self {
        Self { font_size: 16.0, root_font_size: 16.0, viewport: [100.0; 2] }
    }
}

/// Base of a percentage.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Whole {
    /// 100 % are this length in pixels.
    Length(f64),
    /// 100 % are this number.
    Number(f64),
}

/// A value with its dimension.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Value {
    Number(f64),
    /// A length in pixels.
    Length(f64),
    /// An angle in degrees.
    Angle(f64),
}

impl Value {
    /// Returns the number, of a length in pixels, of an angle in degrees.
    pub fn raw(self) -> f64 {
        match self {
            Self::Number(v) | Self::Length(v) | Self::Angle(v) => v,
        }
    }

    fn with(self, v: f64) -> Self {
        match self {
            Self::Number(_) => Self::Number(v),
            Self::Length(_) => Self::Length(v),
            Self::Angle(_) => Self::Angle(v),
        }
    }

    fn is_like(self, other: Self) -> bool {
        std::mem::discriminant(&self) == std::mem::discriminant(&other)
    }

    /// Returns the number in pixels; a number without a unit is one of pixels.
    pub fn length(self) -> Option<f64> {
        match self {
            Self::Number(v) | Self::Length(v) => Some(v),
            Self::Angle(_) => None,
        }
    }

    /// Returns the number in degrees; a number without a unit is one of degrees.
    pub fn angle(self) -> Option<f64> {
        match self {
            Self::Number(v) | Self::Angle(v) => Some(v),
            Self::Length(_) => None,
        }
    }

    /// Returns the number, if it has no unit.
    pub fn number(self) -> Option<f64> {
        match self {
            Self::Number(v) => Some(v),
            _ => None,
        }
    }
}

impl Units {
    /// Returns the value of a number with a unit; `None` for an unknown unit.
    pub fn dimension(&self, number: f64, unit: &str) -> Option<Value> {
        let [width, height] = self.viewport;
        let px = match unit.to_ascii_lowercase().as_str() {
            "px" => 1.0,
            "em" => self.font_size,
            "rem" => self.root_font_size,
            "ex" | "ch" => self.font_size / 2.0,
            "in" => 96.0,
            "cm" => 96.0 / 2.54,
            "mm" => 96.0 / 25.4,
            "q" => 96.0 / 101.6,
            "pt" => 96.0 / 72.0,
            "pc" => 16.0,
            "vw" => width / 100.0,
            "vh" => height / 100.0,
            "vmin" => width.min(height) / 100.0,
            "vmax" => width.max(height) / 100.0,
            "deg" => return Some(Value::Angle(number)),
            "grad" => return Some(Value::Angle(number * 0.9)),
            "rad" => return Some(Value::Angle(number.to_degrees())),
            "turn" => return Some(Value::Angle(number * 360.0)),
            _ => return None,
        };
        Some(Value::Length(number * px))
    }

    /// Returns the value of the tokens from `range` on, which must be one number, length, angle, percentage
    /// or a function like `calc()`.
    pub fn value(&self, pieces: &[Piece<'_>], whole: Option<Whole>) -> Option<Value> {
        let mut sum = Sum { pieces, at: 0, units: self, whole, depth: 0 };
        sum.skip_blanks();
        let value = sum.term()?;
        sum.skip_blanks();
        (sum.at == pieces.len() && value.raw().is_finite()).then_some(value)
    }

    /// Parses a text like [`Self::value`].
    pub fn parse(&self, text: &str, whole: Option<Whole>) -> Option<Value> {
        self.value(&super::tokens::tokens(text), whole)
    }
}

/// Position in a computation. Mates of tokens are not used: the tokens may be part of a longer list.
struct Sum<'a, 'b> {
    pieces: &'b [Piece<'a>],
    at: usize,
    units: &'b Units,
    whole: Option<Whole>,
    depth: u32,
}

impl Sum<'_, '_> {
    fn peek(&self) -> Option<&Token<'_>> {
        self.pieces.get(self.at).map(|piece| &piece.token)
    }

    fn skip_blanks(&mut self) {
        while self.peek() == Some(&Token::Blank) {
            self.at += 1;
        }
    }

    /// Steps over a character, and blanks around it.
    fn take(&mut self, wanted: char) -> bool {
        let before = self.at;
        self.skip_blanks();
        let found = match self.peek() {
            Some(Token::Other(c) | Token::Close(c)) => *c == wanted,
            _ => false,
        };
        if found {
            self.at += 1;
            self.skip_blanks();
        } else {
            self.at = before;
        }
        found
    }

    /// Returns a number, a length, an angle, a percentage, a sum in parentheses or a function.
    fn term(&mut self) -> Option<Value> {
        let token = self.pieces.get(self.at)?.token.clone();
        self.at += 1;
        match token {
            Token::Number(v) => Some(Value::Number(v)),
            Token::Dimension(v, unit) => self.units.dimension(v, &unit),
            Token::Percent(v) => Some(match self.whole? {
                Whole::Length(all) => Value::Length(v * all / 100.0),
                Whole::Number(all) => Value::Number(v * all / 100.0),
            }),
            Token::Open('(') => self.function("calc"),
            Token::Function(name) => self.function(&name.to_ascii_lowercase()),
            Token::Ident(name) if self.depth > 0 && name.eq_ignore_ascii_case("pi") => {
                Some(Value::Number(std::f64::consts::PI))
            }
            _ => None,
        }
    }

    /// Evaluates a function on its arguments.
    fn function(&mut self, name: &str) -> Option<Value> {
        if self.depth == MAX_DEPTH {
            return None;
        }
        self.depth += 1;
        self.skip_blanks();
        let mut arguments = vec![self.sum()?];
        while self.take(',') {
            arguments.push(self.sum()?);
        }
        self.skip_blanks();
        // A parenthesis may be missing at the end.
        if !self.take(')') && self.at < self.pieces.len() {
            return None;
        }
        self.depth -= 1;
        let first = *arguments.first()?;
        if !arguments.iter().all(|other| other.is_like(first)) {
            return None;
        }
        let raw = || arguments.iter().map(|value| value.raw());
        let value = match (name, arguments.as_slice()) {
            ("calc", [_]) => first.raw(),
            ("abs", [_]) => first.raw().abs(),
            ("min", _) => raw().fold(f64::INFINITY, f64::min),
            ("max", _) => raw().fold(f64::NEG_INFINITY, f64::max),
            ("clamp", [low, middle, high]) => low.raw().max(middle.raw().min(high.raw())),
            _ => return None,
        };
        Some(first.with(value))
    }

    fn sum(&mut self) -> Option<Value> {
        let mut total = self.product()?;
        loop {
            let sign = if self.take('+') {
                1.0
            } else if self.take('-') {
                -1.0
            } else {
                return Some(total);
            };
            let other = self.product()?;
            if !total.is_like(other) {
                return None;
            }
            total = total.with(total.raw() + sign * other.raw());
        }
    }

    fn product(&mut self) -> Option<Value> {
        let mut total = self.term()?;
        loop {
            if self.take('*') {
                total = match (total, self.term()?) {
                    (Value::Number(a), b) => b.with(a * b.raw()),
                    (a, Value::Number(b)) => a.with(a.raw() * b),
                    _ => return None,
                };
            } else if self.take('/') {
                total = total.with(total.raw() / self.term()?.number()?);
            } else {
                return Some(total);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn computed_values() {
        let units = Units { font_size: 20.0, root_font_size: 10.0, viewport: [200.0, 100.0] };
        let of = |text| units.parse(text, Some(Whole::Length(50.0)));
        for (text, expected) in [
            ("3px", 3.0),
            ("2em", 40.0),
            ("2rem", 20.0),
            ("1in", 96.0),
            ("10%", 5.0),
            ("calc(100% - 2 * (3px + 1em))", 4.0),
            ("calc(10px / 4 + 1pt * 3)", 6.5),
            ("min(10px, 2em, 50%)", 10.0),
            ("clamp(1px, 100px, 7px)", 7.0),
            ("calc(1vw + 1vmin)", 3.0),
        ] {
            assert_eq!(of(text), Some(Value::Length(expected)), "{text}");
        }
        assert_eq!(of("calc(1 + 2 * 3)"), Some(Value::Number(7.0)));
        assert_eq!(of(".25turn"), Some(Value::Angle(90.0)));
        for wrong in
            ["calc(1px + 1)", "calc(2px * 2px)", "calc(1/0)", "3furlong", "1 2", "calc()", ""]
        {
            assert_eq!(of(wrong), None, "{wrong}");
        }
        assert_eq!(of(&format!("{}1{}", "calc(".repeat(9999), ")".repeat(9999))), None);
    }
}
