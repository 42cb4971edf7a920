//! Colours and gradients of SVG.

use super::number::short;
use super::svg_curve::DIGITS;
use durer::math::DAffine2;
use durer::target::gradient::{Gradient, GradientShape, Spread};

/// Digits after the point of lengths: one more than those of places, and for circles of radius 1.
const FINE: usize = 6;

/// Returns an attribute of a colour, such as `fill` or `stop-color`, and that of its opacity if it is not opaque.
pub(super) fn paint(name: &str, [r, g, b, a]: [u8; 4]) -> String {
    let color = match [r, g, b].map(|c| (c >> 4, c & 15)) {
        [(r, s), (g, t), (b, u)] if r == s && g == t && b == u => format!("#{r:x}{g:x}{b:x}"),
        _ => format!("#{r:02x}{g:02x}{b:02x}"),
    };
    if a == 255 {
        return format!(" {name}=\"{color}\"");
    }
    let of = name.trim_end_matches("-color");
    format!(" {name}=\"{color}\" {of}-opacity=\"{}\"", short(f64::from(a) / 255.0, 3))
}

/// Returns a gradient in the user space, as text before and after the identifier in its first tag.
pub(super) fn definition(gradient: &Gradient) -> [String; 2] {
    let (name, places) = match gradient.shape {
        GradientShape::Linear { start, end } => {
            let places = [("x1", start.x), ("y1", start.y), ("x2", end.x), ("y2", end.y)];
            ("linearGradient", places.to_vec())
        }
        GradientShape::Radial { center, radius, focus, focus_radius } => {
            let mut places = vec![("cx", center.x), ("cy", center.y), ("r", radius)];
            if focus != center {
                places.extend([("fx", focus.x), ("fy", focus.y)]);
            }
            if focus_radius > 0.0 {
                places.push(("fr", focus_radius));
            }
            ("radialGradient", places)
        }
    };
    let mut start = format!("{name} gradientUnits=\"userSpaceOnUse\"");
    for (name, value) in places {
        start += &format!(" {name}=\"{}\"", short(value, FINE));
    }
    if gradient.transform != DAffine2::IDENTITY {
        let numbers = gradient.transform.to_cols_array().map(|v| short(v, FINE));
        start += &format!(" gradientTransform=\"matrix({})\"", numbers.join(" "));
    }
    match gradient.spread {
        Spread::Pad => {}
        Spread::Repeat => start += " spreadMethod=\"repeat\"",
        Spread::Reflect => start += " spreadMethod=\"reflect\"",
    }
    let stop = |(offset, color): &(f64, [u8; 4])| {
        let (offset, color) = (short(*offset, DIGITS + 1), paint("stop-color", *color));
        format!("<stop offset=\"{offset}\"{color}/>")
    };
    let stops: String = gradient.stops.iter().map(stop).collect();
    [start, format!("{stops}</{name}>")]
}
