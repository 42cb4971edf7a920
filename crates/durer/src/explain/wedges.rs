//! Shared parts of lessons of clip space: the wedges of coordinates, the names of borders, sentences.

use super::input::Input;
use super::picture::{Look, Picture};
use super::words::{Caption, Template, Value, Word};
use crate::clip::outcode::Outcode;
use crate::clip::place::EYE;
use crate::math::{DVec2, DVec4};

pub(super) const CLIP_SPACE: Word = Word::new(
    "two or more points of clip space (x, y, z, w)",
    "zwei oder mehr Punkte des Clip-Raums (x, y, z, w)",
);
/// Returns an input of points of clip space.
pub(super) fn clip_space(points: &[(f64, f64, f64, f64)]) -> Input {
    Input::ClipSpace(points.iter().map(|&p| p.into()).collect())
}

pub(super) static BORDER: Template = Template::new(
    "border",
    "Next is the {border} border: {count} {count|vertex goes|vertices go} in.",
    "Nun der Rand {border}: {count} {count|Ecke geht|Ecken gehen} hinein.",
);
pub(super) static ACCEPTED: Template = Template::new(
    "accepted",
    "No outcode has a bit: everything is inside, nothing is cut.",
    "Kein Outcode hat ein Bit: Alles liegt innen, nichts wird geschnitten.",
);
pub(super) static REJECTED: Template = Template::new(
    "rejected",
    "The rest is beyond one border or has no area: rejected.",
    "Was übrig ist, liegt ganz jenseits eines Rands oder ist keine Fläche: abgelehnt.",
);
pub(super) static DROPPED: Template = Template::new(
    "dropped",
    "Vertices with w ≤ 0 have no place on the screen: they are dropped.",
    "Ecken mit w ≤ 0 haben keinen Ort auf dem Schirm: Sie fallen weg.",
);

/// The borders in the order of their bits, then the eye plane.
const BORDERS: [Word; 7] = [
    Word::new("left", "links"),
    Word::new("right", "rechts"),
    Word::new("bottom", "unten"),
    Word::new("top", "oben"),
    Word::new("near", "vorn"),
    Word::new("far", "hinten"),
    Word::new("eye", "am Auge"),
];

/// Returns the index of a border among [`BORDERS`].
pub(super) fn number(border: Outcode) -> usize {
    if border == EYE { 6 } else { border.0.trailing_zeros() as usize }
}

/// Returns the sentence about a border that a number of vertices go into.
pub(super) fn begun(border: Outcode, count: usize) -> Caption {
    let name = BORDERS.get(number(border)).copied().unwrap_or_default();
    BORDER.with([("border", name.into()), ("count", count.into())])
}

/// Named vertices that go into a border, and those that have come out.
pub(super) type Rings<'a> = (&'a [(Value, DVec4)], &'a [DVec4]);

/// Draws the wedge −w ≤ c ≤ w of one coordinate c across w upwards, as Blinn and Newell do: with the polygon of the
/// beginning, and, while something is left, the ring that goes into a border, with names, and what has come out.
pub(super) fn wedge(axis: usize, start: &[DVec4], rings: Option<Rings<'_>>) -> Picture {
    let place =
        |points: &[DVec4]| -> Vec<DVec2> { points.iter().map(|&p| seen(p, axis)).collect() };
    // The same extent for all coordinates: the wedge keeps its size from border to border.
    let all = (0..3).flat_map(|axis| start.iter().map(move |&p| seen(p, axis)));
    let tip = [DVec2::new(-1.5, 0.0), DVec2::new(1.5, 1.5)];
    let ring = rings.iter().flat_map(|(ring, _)| ring.iter().map(|&(_, p)| seen(p, axis)));
    let mut picture = Picture::around(all.chain(ring.clone()).chain(tip), 0.12);
    picture.picture_from_input = None;
    let high = picture.extent[1].y;
    picture.chain([DVec2::new(-high, high), DVec2::ZERO, DVec2::new(high, high)], Look::Window);
    let wide = picture.extent.map(|p| DVec2::new(p.x, 0.0));
    picture.chain(wide, Look::Thin);
    let name = ["x", "y", "z"].get(axis).copied().unwrap_or_default();
    // Beside the tip, where faces are rare.
    let arm = (high * 0.25).min(picture.extent[1].x).min(-picture.extent[0].x);
    picture.label(DVec2::new(arm, arm), (22.0, 4.0), format!("{name} = w"));
    picture.label(DVec2::new(-arm, arm), (-24.0, 4.0), format!("{name} = −w"));
    picture.ring(place(start), Look::Pale);
    if let Some((named, out)) = rings {
        picture.ring(ring.collect::<Vec<_>>(), Look::First);
        for (name, p) in named {
            picture.named(seen(*p, axis), name.clone(), Look::First);
        }
        picture.chain(place(out), Look::Result);
        out.iter().for_each(|&p| picture.dot(seen(p, axis), Look::Result));
    }
    picture
}

/// Returns where a point is in the picture of one coordinate and w.
pub(super) fn seen(p: DVec4, axis: usize) -> DVec2 {
    DVec2::new(p.to_array().get(axis).copied().unwrap_or_default(), p.w)
}
