//! Lessons of textures: one image with its wrap modes and filters, and its levels on a face in perspective.

mod levels;
mod points;

use super::lesson::Lesson;
use super::words::{Caption, Template, Value, Word};
use crate::math::{DVec2, Vec2, Vec4};
use crate::scene::Image;
use crate::shade::texture::weights;

pub(super) const LESSONS: &[Lesson] = &[points::LESSON, levels::LESSON];

static WRAPPED: Template = Template::new(
    "wrapped",
    "Wrap mode {mode}: (u, v) = {from} becomes {to}, which is {place} in level {level} of {w} × {h} texels.",
    "Randmodus {mode}: (u; v) = {from} wird zu {to}, das ist {place} in Stufe {level} mit {w} × {h} Texeln.",
);
static NEAREST: Template = Template::new(
    "nearest",
    "The texel that contains it is {texel}: its value is {value}.",
    "Das Texel, in dem es liegt, ist {texel}: Sein Wert ist {value}.",
);
static BILINEAR: Template = Template::new(
    "bilinear",
    "a = {a} and b = {b}: {w0} · {v0} + {w1} · {v1} + {w2} · {v2} + {w3} · {v3} = {value}.",
    "a = {a} und b = {b}: {w0} · {v0} + {w1} · {v1} + {w2} · {v2} + {w3} · {v3} = {value}.",
);
static DIVIDED: Template = Template::new(
    "divided",
    "The colour is divided by its alpha {alpha}: {value}.",
    "Die Farbe wird durch ihr Alpha {alpha} geteilt: {value}.",
);

const OPAQUE: (&str, &str) = ("divided", "the textures of lessons are opaque");

/// Returns a grey opaque image from its rows.
fn image<const W: usize>(rows: &[[u8; W]]) -> Image {
    let texel = |grey: &u8| [*grey, *grey, *grey, 255];
    let data = rows.iter().flatten().map(texel).collect();
    Image { width: W as u32, height: rows.len() as u32, data, ..Image::default() }
}

/// Returns the grey of a value 0 … 1 as a colour of the picture: light enough for what is written on it.
fn shade(value: f64) -> [u8; 3] {
    [(90.0 + 165.0 * value.clamp(0.0, 1.0)) as u8; 3]
}

/// Returns the grey of a texel's value.
fn grey(value: Vec4) -> f64 {
    value.x.into()
}

fn number(x: f32) -> Value {
    f64::from(x).into()
}

fn pair(p: Vec2) -> Value {
    p.as_dvec2().into()
}

fn texel(at: [u32; 2]) -> Value {
    DVec2::from(at.map(f64::from)).into()
}

const VALUE: Word = Word::new("value", "Wert");

/// Returns the caption of coordinates before and after their wrap mode.
fn wrapped(mode: Word, level: usize, [w, h]: [u32; 2], [from, to]: [Vec2; 2]) -> Caption {
    WRAPPED.with([
        ("mode", mode.into()),
        ("from", pair(from)),
        ("to", pair(to)),
        ("place", pair(to * Vec2::new(w as f32, h as f32))),
        ("level", level.into()),
        ("w", w.into()),
        ("h", h.into()),
    ])
}

/// Returns the caption of the nearest texel.
fn nearest(at: [u32; 2], value: Vec4) -> Caption {
    NEAREST.with([("texel", texel(at)), ("value", number(value.x))])
}

/// Returns the caption of four texels with their weights.
fn bilinear(fractions: [f32; 2], values: [Vec4; 4], value: Vec4) -> Caption {
    let [w0, w1, w2, w3] = weights(fractions).map(number);
    let [v0, v1, v2, v3] = values.map(|value| number(value.x));
    let [a, b] = fractions.map(number);
    BILINEAR.with([
        ("a", a),
        ("b", b),
        ("w0", w0),
        ("v0", v0),
        ("w1", w1),
        ("v1", v1),
        ("w2", w2),
        ("v2", v2),
        ("w3", w3),
        ("v3", v3),
        ("value", number(value.x)),
    ])
}

/// Returns the caption of a colour divided by its alpha.
fn divided(value: Vec4) -> Caption {
    DIVIDED.with([("alpha", number(value.w)), ("value", number(value.x))])
}
