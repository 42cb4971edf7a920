//! A single-stroke font: letters as chains of lines for a pen to follow, for labels on drawings,
//! plotters and contact sheets.
//!
//! durer's own design, on a grid where capitals are 12 units high, small letters 8, and descenders reach 4 below the
//! base line. Round shapes are quarters of ellipses that start and end along the grid. Widths are proportional; figures
//! have equal widths. Printable ASCII, the signs that drawings need (° µ × ± – … Ø ² ³), and Latin letters with
//! accents; anything else is an empty box.

use super::Path;
use crate::math::DVec2;

/// A line of text as strokes.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct StrokeText {
    /// Chains of at least two points, y down, the first letter's origin on the base line at (0, 0). A
    /// chain that is closed repeats its first point.
    pub strokes: Vec<Vec<DVec2>>,
    /// Offset of the next letter. Half of the space between letters is on either side of each, so
    /// half of `advance` is the middle of the text.
    pub advance: f64,
}

impl StrokeText {
    /// Returns the strokes as a path, to be stroked with round caps and joins.
    pub fn path(&self) -> Path {
        let mut path = Path::new();
        for stroke in &self.strokes {
            path.extend(&Path::polyline(stroke.iter().copied()));
        }
        path
    }
}

/// The height of capital letters on the grid.
const CAP: f64 = 12.0;
/// The space between two letters.
const SPACING: f64 = 3.4;
/// The width of a space between words, its letter spacing not counted.
const WORD: f64 = 2.4;
/// Chords per quarter of an ellipse: 0.4 % of its radius off, a hundredth of a millimetre for letters
/// of 5 mm.
const CHORDS: u32 = 6;
/// Glyph for letters that the font does not have.
const MISSING: Glyph = (6.0, "M0 0 L6 0 L6 12 L0 12 L0 0");

/// Width and outline: `M` starts a stroke, `L` is a line; `H` and `V` are quarters of an ellipse that
/// leave horizontally or vertically, `Q` is a quadratic Bézier curve with its control point first.
type Glyph = (f64, &'static str);

/// Lays out one line of text whose capitals are `cap_height` high, in any unit.
///
/// Control characters are left out. A height that is not finite counts as 0.
///
/// ```
/// use durer::curve::stroke_font;
/// let text = stroke_font::line("L", 12.0);
/// assert_eq!(text.strokes.len(), 1);
/// assert_eq!(text.strokes[0].len(), 3);
/// assert_eq!(text.strokes[0][0].y, -12.0); // y down: the top of the letter
/// ```
pub fn line(text: &str, cap_height: f64) -> StrokeText {
    let height = if cap_height.is_finite() { cap_height.clamp(0.0, 1e9) } else { 0.0 };
    let scale = height / CAP;
    let mut line = StrokeText::default();
    let mut x = 0.0;
    for character in text.chars().filter(|c| !c.is_control()) {
        let letter = letter(character);
        let place = |p: DVec2| DVec2::new(x + SPACING * 0.5 + p.x, -p.y) * scale;
        let placed = letter.strokes.iter().map(|s| s.iter().map(|&p| place(p)).collect());
        line.strokes.extend(placed);
        x += letter.width + SPACING;
    }
    line.advance = x * scale;
    line
}

/// A letter on the grid, y up.
struct Letter {
    strokes: Vec<Vec<DVec2>>,
    width: f64,
}

fn letter(character: char) -> Letter {
    if matches!(character, ' ' | '\u{a0}') {
        return Letter { strokes: Vec::new(), width: WORD };
    }
    let plain = |(width, outline): Glyph| Letter { strokes: strokes(outline), width };
    if let Some(glyph) = glyph(character) {
        return plain(glyph);
    }
    match raised(character) {
        Some(letter) => letter,
        None => plain(accented(character).unwrap_or(MISSING)).with_accent(character),
    }
}

/// Returns small figures: half as large, at the height of capitals.
fn raised(character: char) -> Option<Letter> {
    let figure = match character {
        '²' => '2',
        '³' => '3',
        '¹' => '1',
        _ => return None,
    };
    let (width, outline) = glyph(figure)?;
    let up = |p: DVec2| p * 0.55 + DVec2::new(0.0, 0.45 * CAP);
    let strokes = strokes(outline).iter().map(|s| s.iter().map(|&p| up(p)).collect()).collect();
    Some(Letter { strokes, width: width * 0.55 })
}

impl Letter {
    /// Creates the same letter with the accent of `character` over (or under) its middle.
    fn with_accent(mut self, character: char) -> Self {
        let Some((base, accent)) = decomposed(character) else { return self };
        let Some((width, outline)) = accent_glyph(accent) else { return self };
        let lift = if base.is_uppercase() && accent != '¸' { CAP - X_HEIGHT } else { 0.0 };
        let shift = DVec2::new((self.width - width) * 0.5, lift);
        let moved =
            strokes(outline).into_iter().map(|s| s.into_iter().map(|p| p + shift).collect());
        self.strokes.extend(moved);
        self
    }
}

/// The height of small letters on the grid.
const X_HEIGHT: f64 = 8.0;

/// Returns the letter under an accent.
fn accented(character: char) -> Option<Glyph> {
    match decomposed(character)?.0 {
        'i' => Some((0.0, "M0 0 L0 8")),
        base => glyph(base),
    }
}

/// Returns a letter with an accent as its two parts.
fn decomposed(character: char) -> Option<(char, char)> {
    let row = ACCENTED.iter().find(|(_, _, all)| all.contains(character))?;
    let index = row.2.chars().position(|c| c == character)?;
    Some((row.1.chars().nth(index)?, row.0))
}

/// Accent, letters, letters with the accent.
const ACCENTED: &[(char, &str, &str)] = &[
    ('¨', "aeiouyAEIOUY", "äëïöüÿÄËÏÖÜŸ"),
    ('´', "aeiouycnszAEIOUYCNSZ", "áéíóúýćńśźÁÉÍÓÚÝĆŃŚŹ"),
    ('`', "aeiouAEIOU", "àèìòùÀÈÌÒÙ"),
    ('^', "aeiouAEIOU", "âêîôûÂÊÎÔÛ"),
    ('~', "anoANO", "ãñõÃÑÕ"),
    ('ˇ', "cdenrszCDENRSZ", "čďěňřšžČĎĚŇŘŠŽ"),
    ('˚', "auAU", "åůÅŮ"),
    ('¸', "csCS", "çşÇŞ"),
];

/// Returns the glyph of an accent over a small letter.
fn accent_glyph(accent: char) -> Option<Glyph> {
    Some(match accent {
        '¨' => (3.0, "M0 10.3 L0 10.9 M3 10.3 L3 10.9"),
        '´' => (1.8, "M0 9.6 L1.8 11.8"),
        '`' => (1.8, "M1.8 9.6 L0 11.8"),
        '^' => (3.6, "M0 9.6 L1.8 11.6 L3.6 9.6"),
        '~' => (4.0, "M0 10 Q1 11.6 2 10.7 Q3 9.8 4 11.4"),
        'ˇ' => (3.6, "M0 11.6 L1.8 9.6 L3.6 11.6"),
        '˚' => (2.4, "M1.2 11.8 H2.4 10.6 V1.2 9.4 H0 10.6 V1.2 11.8"),
        '¸' => (1.4, "M0.8 0 L0.5 -1.1 Q1.6 -1.3 1.5 -2.2 Q1.3 -3 0 -2.9"),
        _ => return None,
    })
}

/// Returns the chains of points of an outline.
fn strokes(outline: &str) -> Vec<Vec<DVec2>> {
    let mut strokes: Vec<Vec<DVec2>> = Vec::new();
    let mut control = None;
    let mut words = outline.split_ascii_whitespace();
    while let (Some(first), Some(second)) = (words.next(), words.next()) {
        // The first number of a quadratic's end has no letter before it.
        let (command, x) = match first.split_at_checked(1) {
            Some((letter, x)) if letter.as_bytes().iter().all(u8::is_ascii_alphabetic) => {
                (letter, x)
            }
            _ => ("", first),
        };
        let to = DVec2::new(x.parse().unwrap_or(0.0), second.parse().unwrap_or(0.0));
        match (command, strokes.last_mut()) {
            ("M", _) | (_, None) => strokes.push(vec![to]),
            ("Q", _) => control = Some(to),
            (command, Some(stroke)) => extend(stroke, command, control.take(), to),
        }
    }
    strokes
}

/// Lengthens a stroke by one piece.
fn extend(stroke: &mut Vec<DVec2>, command: &str, control: Option<DVec2>, to: DVec2) {
    let Some(&from) = stroke.last() else { return };
    let quarter = |corner: DVec2, i: u32| {
        let center = from + to - corner;
        let (sin, cos) =
            libm::sincos(std::f64::consts::FRAC_PI_2 * f64::from(i) / f64::from(CHORDS));
        center + (from - center) * cos + (to - center) * sin
    };
    match (command, control) {
        ("H", _) => stroke.extend((1..CHORDS).map(|i| quarter(DVec2::new(to.x, from.y), i))),
        ("V", _) => stroke.extend((1..CHORDS).map(|i| quarter(DVec2::new(from.x, to.y), i))),
        (_, Some(c)) => stroke.extend((1..CHORDS).map(|i| {
            let t = f64::from(i) / f64::from(CHORDS);
            from.lerp(c, t).lerp(c.lerp(to, t), t)
        })),
        _ => {}
    }
    stroke.push(to);
}

/// Returns the glyph of a letter, figure or sign on the grid.
fn glyph(character: char) -> Option<Glyph> {
    Some(match character {
        'A' => (8.0, "M0 0 L4 12 L8 0 M1.333 4 L6.667 4"),
        'B' => (7.0, "M0 6.3 L0 0 L3.8 0 H7 3.15 V3.8 6.3 L0 6.3 L0 12 L3.6 12 H6.4 9.15 V3.6 6.3"),
        'C' => (8.0, "M8 8.8 V4.4 12 H0 6 V4.4 0 H8 3.2"),
        'D' => (8.0, "M0 0 L0 12 L3 12 H8 7 L8 5 V3 0 L0 0"),
        'E' => (6.4, "M6.4 12 L0 12 L0 0 L6.4 0 M0 6.3 L5.4 6.3"),
        'F' => (6.2, "M6.2 12 L0 12 L0 0 M0 6.1 L5.2 6.1"),
        'G' => (8.4, "M8 8.9 V4.4 12 H0 6 V4.4 0 H8.4 4 L8.4 5.6 L5 5.6"),
        'H' => (8.0, "M0 0 L0 12 M8 0 L8 12 M0 6.2 L8 6.2"),
        'I' => (0.0, "M0 0 L0 12"),
        'J' => (5.0, "M5 12 L5 3 V2.5 0 H0 2.5"),
        'K' => (7.5, "M0 0 L0 12 M7.2 12 L0 4.8 M2.7 7.5 L7.5 0"),
        'L' => (6.0, "M0 12 L0 0 L6 0"),
        'M' => (9.0, "M0 0 L0 12 L4.5 4 L9 12 L9 0"),
        'N' => (8.0, "M0 0 L0 12 L8 0 L8 12"),
        'O' => (9.0, "M4.5 12 H9 6 V4.5 0 H0 6 V4.5 12"),
        'P' => (6.8, "M0 0 L0 12 L3.6 12 H6.8 8.7 V3.6 5.4 L0 5.4"),
        'Q' => (9.0, "M4.5 12 H9 6 V4.5 0 H0 6 V4.5 12 M5.6 3.2 L9 -1"),
        'R' => (7.2, "M0 0 L0 12 L3.6 12 H6.8 8.7 V3.6 5.4 L0 5.4 M3.8 5.4 L7.2 0"),
        'S' => (7.0, "M6.7 9.3 V3.5 12 H0.3 9.1 V3.5 6.2 H7 3.1 V3.5 0 H0 2.8"),
        'T' => (8.0, "M0 12 L8 12 M4 12 L4 0"),
        'U' => (8.0, "M0 12 L0 4 V4 0 H8 4 L8 12"),
        'V' => (8.0, "M0 12 L4 0 L8 12"),
        'W' => (11.0, "M0 12 L2.8 0 L5.5 11 L8.2 0 L11 12"),
        'X' => (7.6, "M0 0 L7.6 12 M0 12 L7.6 0"),
        'Y' => (8.0, "M0 12 L4 5.6 L8 12 M4 5.6 L4 0"),
        'Z' => (7.2, "M0 12 L7.2 12 L0 0 L7.2 0"),
        'a' => (6.0, "M6 8 L6 0 M6 4 V3 8 H0 4 V3 0 H6 4"),
        'b' => (6.0, "M0 12 L0 0 M0 4 V3 0 H6 4 V3 8 H0 4"),
        'c' => (5.4, "M5.4 6 V3 8 H0 4 V3 0 H5.4 2"),
        'd' => (6.0, "M6 12 L6 0 M6 4 V3 8 H0 4 V3 0 H6 4"),
        'e' => (6.0, "M0 4.2 L6 4.2 V3 8 H0 4 V3 0 H5.7 1.9"),
        'f' => (4.0, "M1.4 0 L1.4 9.6 V3.6 12 L4.2 12 M0 8 L3.8 8"),
        'g' => (6.0, "M6 8 L6 -1 V3 -4 H0.4 -2.2 M6 4 V3 8 H0 4 V3 0 H6 4"),
        'h' => (5.6, "M0 12 L0 0 M0 5 V2.9 8 H5.6 5 L5.6 0"),
        'i' => (0.0, "M0 0 L0 8 M0 10.6 L0 11.2"),
        'j' => (2.2, "M2.2 8 L2.2 -1.8 V0 -4 M2.2 10.6 L2.2 11.2"),
        'k' => (5.4, "M0 0 L0 12 M5 8 L0 3 M1.9 4.9 L5.4 0"),
        'l' => (1.6, "M0 12 L0 1.6 V1.6 0"),
        'm' => (9.4, "M0 0 L0 8 M0 5.4 V2.5 8 H4.7 5.4 L4.7 0 M4.7 5.4 V7.2 8 H9.4 5.4 L9.4 0"),
        'n' => (5.6, "M0 0 L0 8 M0 5 V2.9 8 H5.6 5 L5.6 0"),
        'o' => (6.0, "M3 8 H6 4 V3 0 H0 4 V3 8"),
        'p' => (6.0, "M0 8 L0 -4 M0 4 V3 8 H6 4 V3 0 H0 4"),
        'q' => (6.0, "M6 8 L6 -4 M6 4 V3 8 H0 4 V3 0 H6 4"),
        'r' => (3.6, "M0 0 L0 8 M0 5 V2.9 8 L3.6 8"),
        's' => (5.0, "M4.8 6.3 V2.5 8 H0.2 6.1 V2.5 4.2 H5 2.1 V2.5 0 H0 1.8"),
        't' => (3.8, "M1.4 11 L1.4 2 V3.2 0 L4 0 M0 8 L3.8 8"),
        'u' => (5.6, "M0 8 L0 3 V2.7 0 H5.6 3 M5.6 8 L5.6 0"),
        'v' => (6.0, "M0 8 L3 0 L6 8"),
        'w' => (9.0, "M0 8 L2.25 0 L4.5 7.3 L6.75 0 L9 8"),
        'x' => (5.6, "M0 0 L5.6 8 M0 8 L5.6 0"),
        'y' => (6.0, "M0 8 L3 0 M6 8 L1.5 -4"),
        'z' => (5.0, "M0 8 L5 8 L0 0 L5 0"),
        _ => return figure(character).or_else(|| sign(character)),
    })
}

/// Returns the glyph of a figure; all have one width.
fn figure(character: char) -> Option<Glyph> {
    let outline = match character {
        '0' => "M3.5 12 H7 8 L7 4 V3.5 0 H0 4 L0 8 V3.5 12",
        '1' => "M1 9.4 L4.2 12 L4.2 0",
        '2' => "M0.3 9 V3.5 12 H6.8 8.9 Q6.8 7 4.9 5.1 L0 0 L7 0",
        '3' => "M0.5 9.4 V3.5 12 H6.6 9.2 V3.5 6.4 L2.4 6.4 M3.5 6.4 H7 3.2 V3.5 0 H0.1 2.8",
        '4' => "M5.3 0 L5.3 12 L0 3.4 L7 3.4",
        '5' => "M6.3 12 L1 12 L0.6 6.7 Q1.7 7.6 3.4 7.6 H7 3.8 V3.4 0 H0 2.6",
        '6' => "M6 12 Q0 9.8 0 3.8 V3.5 0 H7 3.8 V3.5 7.5 H0 3.8",
        '7' => "M0 12 L7 12 L2.2 0",
        '8' => "M3.5 6.5 H0.4 9.25 V3.5 12 H6.6 9.25 V3.5 6.5 H7 3.25 V3.5 0 H0 3.25 V3.5 6.5",
        '9' => "M1 0 Q7 2.2 7 8.2 V3.5 12 H0 8.2 V3.5 4.5 H7 8.2",
        _ => return None,
    };
    Some((7.0, outline))
}

/// Returns the glyph of a punctuation mark or a sign of measures.
fn sign(character: char) -> Option<Glyph> {
    Some(match character {
        '.' => (0.0, "M0 0 L0 0.6"),
        ',' => (0.8, "M0.8 0.6 L0 -2"),
        ':' => (0.0, "M0 0 L0 0.6 M0 6.6 L0 7.2"),
        ';' => (0.8, "M0.8 0.6 L0 -2 M0.8 6.6 L0.8 7.2"),
        '!' => (0.0, "M0 12 L0 3.4 M0 0 L0 0.6"),
        '?' => (6.0, "M0 9.2 V3 12 H6 9 Q6 7.4 4.5 6.2 Q3 5 3 3.4 M3 0 L3 0.6"),
        '"' | '“' | '”' => (2.2, "M0 12 L0 9 M2.2 12 L2.2 9"),
        '\'' | '‘' | '’' => (0.0, "M0 12 L0 9"),
        '#' => (8.0, "M1.5 1 L3 11 M5 1 L6.5 11 M0 4 L7.5 4 M0.5 8 L8 8"),
        '$' => (7.0, "M6.7 9.3 V3.5 12 H0.3 9.1 V3.5 6.2 H7 3.1 V3.5 0 H0 2.8 M3.5 -1.6 L3.5 13.6"),
        '%' => (
            10.0,
            "M1.4 0 L8.6 12 M2 12 H4 9.75 V2 7.5 H0 9.75 V2 12 M8 4.5 H10 2.25 V8 0 H6 2.25 V8 4.5",
        ),
        '&' => (
            8.6,
            "M8.6 0 L2 7.8 Q1.1 8.9 1.1 10 V3.2 12 H5.3 10 Q5.3 8.5 2.9 7.1 Q0 5.4 0 3 V3.2 0 Q6.8 0 7.8 5",
        ),
        '(' => (2.4, "M2.4 13 Q0 9.5 0 5 Q0 0.5 2.4 -3"),
        ')' => (2.4, "M0 13 Q2.4 9.5 2.4 5 Q2.4 0.5 0 -3"),
        '*' => (5.0, "M2.5 12 L2.5 6.4 M0 10.6 L5 7.8 M5 10.6 L0 7.8"),
        '+' => (7.0, "M3.5 1.5 L3.5 8.5 M0 5 L7 5"),
        '±' => (7.0, "M3.5 2.6 L3.5 9.4 M0 6 L7 6 M0 0 L7 0"),
        '-' => (4.0, "M0 5 L4 5"),
        '−' => (7.0, "M0 5 L7 5"),
        '–' => (6.0, "M0 5 L6 5"),
        '—' => (10.0, "M0 5 L10 5"),
        '/' => (5.6, "M0 -1 L5.6 13"),
        '\\' => (5.6, "M0 13 L5.6 -1"),
        '<' => (6.4, "M6.4 9 L0 5 L6.4 1"),
        '>' => (6.4, "M0 9 L6.4 5 L0 1"),
        '=' => (7.0, "M0 6.6 L7 6.6 M0 3.4 L7 3.4"),
        '@' => (
            11.0,
            "M7.8 5.6 V5.5 8.2 H3.2 5.6 V5.5 3 H7.8 5.6 M7.8 8.2 L7.8 4.6 V9.4 3 H11 6 V5.5 12 H0 5.5 V5.5 -1 Q7.8 -1 9 0",
        ),
        '[' => (2.4, "M2.4 13 L0 13 L0 -3 L2.4 -3"),
        ']' => (2.4, "M0 13 L2.4 13 L2.4 -3 L0 -3"),
        '{' => (3.4, "M3.4 13 H1.7 11 L1.7 7 V0 5 H1.7 3 L1.7 -1 V3.4 -3"),
        '}' => (3.4, "M0 13 H1.7 11 L1.7 7 V3.4 5 H1.7 3 L1.7 -1 V0 -3"),
        '|' => (0.0, "M0 13 L0 -3"),
        '^' => (6.0, "M0 7.6 L3 12 L6 7.6"),
        '_' => (7.0, "M0 -2 L7 -2"),
        '`' => (1.8, "M0 12 L1.8 9.8"),
        '´' => (1.8, "M0 9.8 L1.8 12"),
        '~' => (7.0, "M0 4 Q1.6 6.6 3.5 5.1 Q5.4 3.6 7 6.2"),
        '°' => (3.8, "M1.9 12 H3.8 10.1 V1.9 8.2 H0 10.1 V1.9 12"),
        'µ' | 'μ' => (5.6, "M0 8 L0 -4 M0 3 V2.7 0 H5.6 3 M5.6 8 L5.6 0"),
        '×' => (6.0, "M0 2 L6 8 M0 8 L6 2"),
        '÷' => (7.0, "M0 5 L7 5 M3.5 8 L3.5 8.6 M3.5 1.4 L3.5 2"),
        '·' => (0.0, "M0 4.7 L0 5.3"),
        '•' => (2.0, "M1 6 H2 5 V1 4 H0 5 V1 6"),
        '…' => (8.0, "M0 0 L0 0.6 M4 0 L4 0.6 M8 0 L8 0.6"),
        'Ø' | '⌀' => (9.0, "M4.5 12 H9 6 V4.5 0 H0 6 V4.5 12 M0.6 -0.8 L8.4 12.8"),
        'ø' => (6.0, "M3 8 H6 4 V3 0 H0 4 V3 8 M0 -0.8 L6 8.8"),
        'ß' => (6.4, "M0 0 L0 9 V2.9 12 H5.7 9.3 V3.2 6.7 H6.4 3.35 V3.2 0 L2 0"),
        _ => return None,
    })
}
