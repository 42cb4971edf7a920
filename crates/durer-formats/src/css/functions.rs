//! Colours that CSS writes as functions.
//!
//! Source: *CSS Color Module Level 4* and *Level 5*, W3C. Colours outside sRGB are clamped, as in browsers.

use super::spaces::{Color, Space};
use super::tokens::{Piece, Token, tokens};
use super::units::{Units, Value, Whole};

/// Colours within colours may be so deep.
const MAX_DEPTH: u32 = 8;

/// Returns the colour of a text; `current` is the value of `currentColor`.
pub(super) fn parse(text: &str, current: Option<Color>) -> Option<Color> {
    of_pieces(trimmed(&tokens(text)), current, 0)
}

/// Returns the colour that the tokens form; `None` if they are anything else.
fn of_pieces(pieces: &[Piece<'_>], current: Option<Color>, depth: u32) -> Option<Color> {
    let (first, rest) = pieces.split_first()?;
    let function = match &first.token {
        Token::Ident(name) if rest.is_empty() => return named(name, current),
        Token::Hash(digits) if rest.is_empty() => return plain(&format!("#{digits}")),
        Token::Function(name) if depth < MAX_DEPTH => name.to_ascii_lowercase(),
        _ => return None,
    };
    let inside = trimmed(match rest.split_last() {
        Some((last, inside)) if last.token == Token::Close(')') => inside,
        _ => rest,
    });
    match function.as_str() {
        "color-mix" => mixed(inside, current, depth + 1),
        "light-dark" => of_pieces(split(inside, ',').first()?, current, depth + 1),
        "color" => {
            let (name, components) = inside.split_first()?;
            let Token::Ident(name) = &name.token else { return None };
            of_components(Space::of_color(&name.to_ascii_lowercase())?, components)
        }
        name => of_components(Space::of_function(name)?, inside),
    }
}

fn named(name: &str, current: Option<Color>) -> Option<Color> {
    if name.eq_ignore_ascii_case("currentcolor") { current } else { plain(name) }
}

/// Returns a name, or a number with `#`.
fn plain(text: &str) -> Option<Color> {
    super::simple(text).map(Color::of_bytes)
}

/// Returns the tokens without blanks at the ends.
pub(super) fn trimmed<'a, 'b>(mut pieces: &'b [Piece<'a>]) -> &'b [Piece<'a>] {
    while let [Piece { token: Token::Blank, .. }, rest @ ..]
    | [rest @ .., Piece { token: Token::Blank, .. }] = pieces
    {
        pieces = rest;
    }
    pieces
}

/// Returns the parts between commas, or another character, outside of parentheses.
pub(crate) fn split<'a, 'b>(pieces: &'b [Piece<'a>], separator: char) -> Vec<&'b [Piece<'a>]> {
    split_at(pieces, &Token::Other(separator)).into_iter().map(trimmed).collect()
}

/// Returns the parts between tokens outside of parentheses.
fn split_at<'a, 'b>(pieces: &'b [Piece<'a>], separator: &Token<'_>) -> Vec<&'b [Piece<'a>]> {
    let mut depth = 0_u32;
    let parts = pieces.split(|piece| {
        match piece.token {
            Token::Open(_) | Token::Function(_) => depth += 1,
            Token::Close(_) => depth = depth.saturating_sub(1),
            _ => {}
        }
        depth == 0 && piece.token == *separator
    });
    parts.collect()
}

/// Returns the components of a colour as in a function: with commas, or with blanks and a stroke before alpha.
fn of_components(space: Space, inside: &[Piece<'_>]) -> Option<Color> {
    let mut parts = split(inside, ',');
    let alpha: Option<&[Piece<'_>]>;
    if parts.len() == 1 {
        let halves = split(inside, '/');
        alpha = halves.get(1).copied();
        if halves.len() > 2 {
            return None;
        }
        parts = words(halves.first()?);
    } else {
        alpha = if parts.len() == 4 { parts.pop() } else { None };
        // In the older syntax with commas, numbers and percentages are not mixed.
        let is_percent =
            |part: &&[Piece<'_>]| matches!(part, [Piece { token: Token::Percent(_), .. }]);
        let percents = parts.iter().filter(|part| is_percent(part)).count();
        if space == Space::Bytes && percents != 0 && percents != parts.len() {
            return None;
        }
    }
    let [a, b, c] = parts.as_slice() else { return None };
    let mut components = [0.0; 3];
    for (i, (component, part)) in components.iter_mut().zip([a, b, c]).enumerate() {
        *component = component_of(part, space, i)?;
    }
    let alpha = alpha.map_or(Some(1.0), |part| number(part, 1.0))?;
    Some(space.color(components, alpha.clamp(0.0, 1.0)))
}

/// Returns the parts between blanks outside of parentheses.
pub(crate) fn words<'a, 'b>(pieces: &'b [Piece<'a>]) -> Vec<&'b [Piece<'a>]> {
    split_at(pieces, &Token::Blank).into_iter().filter(|part| !part.is_empty()).collect()
}

/// Returns a number, a percentage of `all`, or `none`, which counts as 0.
fn number(part: &[Piece<'_>], all: f64) -> Option<f64> {
    if let [piece] = part
        && piece.token.is_word("none")
    {
        return Some(0.0);
    }
    Units::default().value(part, Some(Whole::Number(all)))?.number()
}

/// Returns the component of a colour at that index.
fn component_of(part: &[Piece<'_>], space: Space, index: usize) -> Option<f64> {
    if space.is_hue(index) {
        if let [piece] = part
            && piece.token.is_word("none")
        {
            return Some(0.0);
        }
        return Units::default().value(part, None).and_then(Value::angle);
    }
    number(part, space.whole(index))
}

/// Evaluates `color-mix()`.
fn mixed(inside: &[Piece<'_>], current: Option<Color>, depth: u32) -> Option<Color> {
    let parts = split(inside, ',');
    let [method, first, second] = parts.as_slice() else { return None };
    let method = words(method);
    let mut names = method.iter().map(|word| match word {
        [Piece { token: Token::Ident(name), .. }] => name.to_ascii_lowercase(),
        _ => String::new(),
    });
    if names.next()? != "in" {
        return None;
    }
    let space = names.next()?;
    let space = Space::of_color(&space).or_else(|| Space::of_function(&space))?;
    // Directions other than the shorter one around the hues are rare.
    let way: Vec<String> = names.collect();
    if !way.is_empty() && way != ["shorter", "hue"] {
        return None;
    }
    let (a, share_a) = with_share(first, current, depth)?;
    let (b, share_b) = with_share(second, current, depth)?;
    let (share_a, share_b) = match (share_a, share_b) {
        (None, None) => (50.0, 50.0),
        (Some(a), None) => (a, 100.0 - a),
        (None, Some(b)) => (100.0 - b, b),
        (Some(a), Some(b)) => (a, b),
    };
    let sum = share_a + share_b;
    if sum <= 0.0 {
        return None;
    }
    let mut color = space.mix(a, b, share_b / sum);
    color.alpha *= (sum / 100.0).min(1.0);
    Some(color)
}

/// Returns a colour with its share in percent, before or after it.
fn with_share(
    part: &[Piece<'_>],
    current: Option<Color>,
    depth: u32,
) -> Option<(Color, Option<f64>)> {
    let share = |piece: &Piece<'_>| match piece.token {
        Token::Percent(v) => Some(v.clamp(0.0, 100.0)),
        _ => None,
    };
    let (share, color) = match part {
        [first, rest @ ..] if share(first).is_some() => (share(first), rest),
        [rest @ .., last] if share(last).is_some() => (share(last), rest),
        _ => (None, part),
    };
    Some((of_pieces(trimmed(color), current, depth)?, share))
}
