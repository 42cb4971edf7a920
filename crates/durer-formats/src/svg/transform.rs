//! Transforms as CSS writes them, with units and an origin.
//!
//! Source: *CSS Transforms Module Level 1* and *Level 2*, W3C; of the latter only the functions in the plane.

use crate::css::{Piece, Token, Units, Whole, split, tokens, words};
use durer::math::{DAffine2, DVec2};

/// Returns the map of a list of functions; percentages are of the `size` of the reference box.
pub(super) fn parse(text: &str, units: &Units, size: [f64; 2]) -> Option<DAffine2> {
    if text.trim().eq_ignore_ascii_case("none") {
        return Some(DAffine2::IDENTITY);
    }
    let pieces = tokens(text);
    let (mut map, mut at) = (DAffine2::IDENTITY, 0);
    while let Some(piece) = pieces.get(at) {
        match &piece.token {
            Token::Blank => at += 1,
            Token::Function(name) => {
                let inside = pieces.get(at + 1..piece.mate.min(pieces.len()))?;
                map *= function(&name.to_ascii_lowercase(), inside, units, size)?;
                at = piece.mate + 1;
            }
            _ => return None,
        }
    }
    (map.is_finite() && !pieces.is_empty()).then_some(map)
}

/// Returns the map of one function.
fn function(name: &str, inside: &[Piece<'_>], units: &Units, size: [f64; 2]) -> Option<DAffine2> {
    let parts = split(inside, ',');
    let length = |i: usize, axis: usize| {
        units.value(parts.get(i)?, Some(Whole::Length(size[axis])))?.length()
    };
    let angle = |i: usize| units.value(parts.get(i)?, None)?.angle().map(f64::to_radians);
    let number = |i: usize| units.value(parts.get(i)?, Some(Whole::Number(1.0)))?.number();
    let has = |counts: &[usize]| counts.contains(&parts.len()).then_some(());
    let turn = |angle: f64| {
        let (sin, cos) = libm::sincos(angle);
        DAffine2::from_cols(DVec2::new(cos, sin), DVec2::new(-sin, cos), DVec2::ZERO)
    };
    let skew = |x: f64, y: f64| {
        let (x, y) = (libm::tan(x), libm::tan(y));
        DAffine2::from_cols(DVec2::new(1.0, y), DVec2::new(x, 1.0), DVec2::ZERO)
    };
    let shift = |x: f64, y: f64| DAffine2::from_translation(DVec2::new(x, y));
    let scale = |x: f64, y: f64| DAffine2::from_scale(DVec2::new(x, y));
    let row = |at: [usize; 6]| {
        let [a, b, c, d, e, f] = at.map(&number);
        Some(DAffine2::from_cols(DVec2::new(a?, b?), DVec2::new(c?, d?), DVec2::new(e?, f?)))
    };
    has(match name {
        "translate" | "scale" | "skew" => &[1, 2],
        "translate3d" | "scale3d" => &[3],
        "rotate3d" => &[4],
        "matrix" => &[6],
        "matrix3d" => &[16],
        _ => &[1],
    })?;
    let second = parts.len() > 1;
    Some(match name {
        "translate" if !second => shift(length(0, 0)?, 0.0),
        "translate" => shift(length(0, 0)?, length(1, 1)?),
        "translate3d" if length(2, 0)? == 0.0 => shift(length(0, 0)?, length(1, 1)?),
        "translatex" => shift(length(0, 0)?, 0.0),
        "translatey" => shift(0.0, length(0, 1)?),
        "translatez" if length(0, 0)? == 0.0 => DAffine2::IDENTITY,
        "scale" => scale(number(0)?, number(usize::from(second))?),
        "scale3d" => scale(number(0)?, number(1)?),
        "scalex" => scale(number(0)?, 1.0),
        "scaley" => scale(1.0, number(0)?),
        "scalez" => number(0).map(|_| DAffine2::IDENTITY)?,
        "rotate" | "rotatez" => turn(angle(0)?),
        "rotate3d" if number(0)? == 0.0 && number(1)? == 0.0 && number(2)? > 0.0 => turn(angle(3)?),
        "skew" => skew(angle(0)?, if second { angle(1)? } else { 0.0 }),
        "skewx" => skew(angle(0)?, 0.0),
        "skewy" => skew(0.0, angle(0)?),
        "matrix" => row([0, 1, 2, 3, 4, 5])?,
        "matrix3d" if is_flat(&number) => row([0, 1, 4, 5, 12, 13])?,
        _ => return None,
    })
}

/// Returns whether a matrix maps the plane onto itself.
fn is_flat(number: &impl Fn(usize) -> Option<f64>) -> bool {
    [(2, 0.0), (3, 0.0), (6, 0.0), (7, 0.0), (14, 0.0), (15, 1.0)]
        .iter()
        .all(|(i, v)| number(*i) == Some(*v))
}

/// Returns the map of the properties `translate`, `rotate` and `scale`.
pub(super) fn single(
    property: &str,
    value: &str,
    units: &Units,
    size: [f64; 2],
) -> Option<DAffine2> {
    if value.trim().eq_ignore_ascii_case("none") {
        return Some(DAffine2::IDENTITY);
    }
    let pieces = tokens(value);
    let parts: Vec<_> = words(&pieces)
        .into_iter()
        .filter_map(|part| Some(value.get(part.first()?.start..part.last()?.end)?.to_owned()))
        .collect();
    parse(&format!("{property}({})", parts.join(",")), units, size)
}

/// Returns the origin of a transform in a reference box with that corner and size.
pub(super) fn origin(text: &str, units: &Units, corner: [f64; 2], size: [f64; 2]) -> Option<DVec2> {
    let pieces = tokens(text);
    let mut parts = words(&pieces);
    parts.truncate(2);
    let word = |part: &[Piece<'_>]| match part {
        [Piece { token: Token::Ident(word), .. }] => Some(word.to_ascii_lowercase()),
        _ => None,
    };
    let is_vertical = |part: &&[Piece<'_>]| word(part).is_some_and(|w| w == "top" || w == "bottom");
    let is_horizontal =
        |part: &&[Piece<'_>]| word(part).is_some_and(|w| w == "left" || w == "right");
    if parts.first().is_some_and(is_vertical) || parts.get(1).is_some_and(is_horizontal) {
        // The vertical position may come first, or alone.
        let horizontal = parts.get(1).copied().unwrap_or_default();
        parts = vec![horizontal, parts.first()?];
    }
    let along = |axis: usize| {
        let part = parts.get(axis).copied().unwrap_or_default();
        let offset = match word(part).as_deref() {
            Some("left" | "top") => 0.0,
            Some("right" | "bottom") => size[axis],
            Some("center") => size[axis] / 2.0,
            None if part.is_empty() => size[axis] / 2.0,
            _ => units.value(part, Some(Whole::Length(size[axis])))?.length()?,
        };
        Some(corner[axis] + offset)
    };
    Some(DVec2::new(along(0)?, along(1)?))
}

/// Returns a map as an attribute.
pub(super) fn attribute(map: &DAffine2) -> String {
    let (m, t) = (map.matrix2, map.translation);
    format!("matrix({} {} {} {} {} {})", m.x_axis.x, m.x_axis.y, m.y_axis.x, m.y_axis.y, t.x, t.y)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn moved(text: &str) -> Option<[f64; 2]> {
        let map = parse(text, &Units::default(), [200.0, 100.0])?;
        Some(
            map.transform_point2(DVec2::new(10.0, 20.0))
                .to_array()
                .map(|v| (v * 1e6).round() / 1e6),
        )
    }

    #[test]
    fn functions_map_as_css_says() {
        for (text, expected) in [
            ("none", [10.0, 20.0]),
            ("translate(5px, 1em)", [15.0, 36.0]),
            ("translate(50%) translateY(-10%)", [110.0, 10.0]),
            ("rotate(.25turn)", [-20.0, 10.0]),
            ("rotate(90deg) scale(2)", [-40.0, 20.0]),
            ("scale(50%, 3)", [5.0, 60.0]),
            ("skewX(45deg)", [30.0, 20.0]),
            ("skew(45deg, 0)", [30.0, 20.0]),
            ("matrix(1, 0, 0, 2, 3, 4)", [13.0, 44.0]),
            ("translate3d(1px, 2px, 0) rotateZ(180deg)", [-9.0, -18.0]),
            ("translate(calc(100% - 1px), 0)", [209.0, 20.0]),
        ] {
            assert_eq!(moved(text), Some(expected), "{text}");
        }
        for text in [
            "",
            "rotate()",
            "rotate(1px)",
            "turn(1)",
            "translateZ(3px)",
            "rotateX(3deg)",
            "scale(1 2)",
            "matrix(1)",
        ] {
            assert_eq!(moved(text), None, "{text}");
        }
    }

    #[test]
    fn origins_are_words_and_lengths() {
        let of = |text| {
            origin(text, &Units::default(), [10.0, 20.0], [200.0, 100.0]).map(|v| v.to_array())
        };
        for (text, expected) in [
            ("center", [110.0, 70.0]),
            ("top", [110.0, 20.0]),
            ("left bottom", [10.0, 120.0]),
            ("bottom left", [10.0, 120.0]),
            ("5px 10%", [15.0, 30.0]),
            ("25%", [60.0, 70.0]),
            ("0 0 3px", [10.0, 20.0]),
        ] {
            assert_eq!(of(text), Some(expected), "{text}");
        }
        assert_eq!(of("nowhere"), None);
    }
}
