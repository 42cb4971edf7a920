//! Path data of lines, arcs and cubic curves.

use super::number::{push, short};
use durer::math::DVec2;
use durer::target::{Curve, CurvePiece, EllipticArc};

/// Digits after the point of a millimetre: a micrometre is far below what any plotter resolves.
pub(super) const DIGITS: usize = 3;

/// Arcs are divided so that none turns further, in radians: of a half circle, a last digit of its ends moves the middle
/// by many.
const FURTHEST: f64 = 2.1;

/// Appends a curve as path data: differences between rounded places, so that errors do not add up.
pub(super) fn path(text: &mut String, curve: &Curve) {
    let mut last = rounded(curve.start);
    text.push('M');
    pair(text, last);
    for piece in &curve.pieces {
        match *piece {
            CurvePiece::Line(end) => line(text, &mut last, end),
            CurvePiece::Cubic(a, b, end) => step(text, 'c', &mut last, &[a, b, end]),
            CurvePiece::Arc(arc, end) => arcs(text, &mut last, &arc, end),
        }
    }
    if curve.closed {
        text.push('z');
    }
}

fn line(text: &mut String, last: &mut DVec2, end: DVec2) {
    let way = rounded(end) - *last;
    let (command, along) = match (way.x == 0.0, way.y == 0.0) {
        (true, _) => ('v', way.y),
        (_, true) => ('h', way.x),
        _ => return step(text, 'l', last, &[end]),
    };
    text.push(command);
    push(text, along / 1000.0, DIGITS);
    *last += way;
}

/// Writes a command with points relative to the last place, which then becomes the last of them.
fn step(text: &mut String, command: char, last: &mut DVec2, points: &[DVec2]) {
    text.push(command);
    let from = *last;
    for (i, p) in points.iter().enumerate() {
        let way = rounded(*p) - from;
        if i > 0 {
            separator(text, way.x);
        }
        pair(text, way);
        *last = from + way;
    }
}

fn arcs(text: &mut String, last: &mut DVec2, arc: &EllipticArc, end: DVec2) {
    let parts = (arc.turn.abs() / FURTHEST).ceil().max(1.0);
    let radii = arc.radii();
    let angle = match arc.is_circular() {
        true => 0.0,
        false => libm::atan2(arc.axis.y, arc.axis.x).to_degrees(),
    };
    // One digit more than places have: errors of radii are seen in the middle of an arc.
    let [x, y] = radii.to_array().map(|v| short(v, DIGITS + 1));
    let sweep = u8::from(arc.turn > 0.0);
    for k in 1..=parts as u32 {
        let to = match f64::from(k) {
            k if k >= parts => end,
            k => arc.at(arc.start + arc.turn * k / parts),
        };
        let way = rounded(to) - *last;
        *text += &format!("a{x} {y} {} 0 {sweep}", short(angle, DIGITS + 1));
        separator(text, way.x);
        pair(text, way);
        *last += way;
    }
}

/// Returns a point in whole micrometres.
fn rounded(p: DVec2) -> DVec2 {
    (p * 1000.0).round()
}

/// Writes two coordinates given in micrometres.
pub(super) fn pair(text: &mut String, p: DVec2) {
    push(text, p.x / 1000.0, DIGITS);
    separator(text, p.y);
    push(text, p.y / 1000.0, DIGITS);
}

/// Writes a blank, unless the sign of the next number separates it from the last.
pub(super) fn separator(text: &mut String, next: f64) {
    if next >= 0.0 {
        text.push(' ');
    }
}
