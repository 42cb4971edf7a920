//! Axes on the outer edges of the box around a surface, with ticks and labels.

use super::ticks::{offset, short, ticks};
use super::{Axes, Marks, Options};
use crate::math::{DVec2, DVec3, Rect};
use crate::scene::{Aabb, HeightField};
use crate::target::drawing::{Line, LineClass, TextAnchor, TextLabel};
use crate::view::picture_plane::PicturePlane;

/// Length of a tick, in heights of a letter.
const TICK: f64 = 0.6;
/// Distance from a tick to its label, in heights of a letter.
const GAP: f64 = 0.5;
/// Width of a letter, in heights: to keep texts apart.
pub const LETTER: f64 = 0.85;
/// Room between two labels, in heights of a letter.
const APART: f64 = 0.4;
/// Room that a label takes along an axis of the ground and along an upright one, in heights of a letter.
const SPACE: [f64; 2] = [5.0, 3.0];

/// An edge of the box along axis `k`, as seen.
#[derive(Clone, Copy)]
struct Edge {
    k: usize,
    /// Its lower and its upper end.
    ends: [DVec3; 2],
    seen: [DVec2; 2],
}

/// Draws the axes of a field that is `seen` with other heights and ranges; `scale` is millimetres per plane unit.
pub fn draw(
    field: &HeightField,
    seen_field: &HeightField,
    bounds: &Aabb,
    plane: &PicturePlane,
    axes: &Axes,
    options: &Options,
    scale: f64,
) -> Marks {
    let mut marks = Marks::default();
    let seen: Vec<DVec2> = bounds.corners().into_iter().filter_map(|c| plane.project(c)).collect();
    // The camera is fitted around the box, so its corners are all in front.
    if seen.len() != 8 {
        return marks;
    }
    let center = seen.iter().sum::<DVec2>() / 8.0;
    let edge = |k: usize, corner: usize| {
        let ends = [corner, corner | 1 << k].map(|c| bounds.corners()[c]);
        Edge { k, ends, seen: [seen[corner], seen[corner | 1 << k]] }
    };
    // Along the ground the edges that are lowest in the picture, upwards the leftmost one.
    let lowest = |k: usize, other: usize| {
        let (near, far) = (edge(k, 1 << other), edge(k, 0));
        let height = |e: &Edge| e.seen[0].y + e.seen[1].y;
        let slack = (near.seen[0] - far.seen[0]).length() * 1e-9;
        if height(&near) <= height(&far) + slack { near } else { far }
    };
    let (x, z) = (lowest(0, 2), lowest(2, 0));
    let upright = [0, 1, 4, 5].map(|corner| edge(1, corner));
    let leftmost = upright.into_iter().min_by(|a, b| a.seen[0].x.total_cmp(&b.seen[0].x));
    for e in [Some(x), Some(z), leftmost].into_iter().flatten() {
        let true_range = match e.k {
            0 => field.x_range(),
            1 => field.range().unwrap_or_default(),
            _ if axes.z_is_south => field.z_range().map(|z| -z),
            _ => field.z_range(),
        };
        axis(&mut marks, &e, true_range, center, &axes.names[e.k], plane, options, scale);
    }
    corners(&mut marks, seen_field, &[x, z], plane);
    marks
}

/// Adds upright lines from the ends of the ground's axes up to the surface's own corners.
fn corners(marks: &mut Marks, field: &HeightField, edges: &[Edge; 2], plane: &PicturePlane) {
    let (columns, rows) = (field.columns(), field.rows());
    for (column, row) in [(0, 0), (columns - 1, 0), (0, rows - 1), (columns - 1, rows - 1)] {
        let Some(top) = field.point(column, row).filter(|p| field.keeps(p.y)) else { continue };
        let at_corner = |p: &&DVec3| p.x == top.x && p.z == top.z;
        let ground = edges.iter().flat_map(|e| &e.ends).find(at_corner);
        if let Some(points) = ground.and_then(|g| plane.project_segment(*g, top)) {
            push(marks, points);
        }
    }
}

fn push(marks: &mut Marks, [a, b]: [DVec2; 2]) {
    if a != b {
        let class = LineClass::Axis;
        marks.lines.push(Line { class, invisibility: 0, points: vec![a, b], closed: false });
    }
}

#[expect(clippy::too_many_arguments, reason = "one axis needs all that the plot knows")]
fn axis(
    marks: &mut Marks,
    edge: &Edge,
    range: [f64; 2],
    center: DVec2,
    name: &str,
    plane: &PicturePlane,
    options: &Options,
    scale: f64,
) {
    let along = edge.seen[1] - edge.seen[0];
    let length = along.length() * scale;
    let letter = options.text / scale;
    push(marks, edge.seen);
    // Seen end on, an axis has no room for labels.
    if length < 3.0 * options.text {
        return;
    }
    let middle = (edge.seen[0] + edge.seen[1]) * 0.5;
    let across = along.perp().normalize_or_zero();
    let out = if across.dot(middle - center) >= 0.0 { across } else { -across };
    let wanted =
        ((length / (SPACE[usize::from(edge.k == 1)] * options.text)) as usize).clamp(2, 10);
    let base = offset([range[0].min(range[1]), range[0].max(range[1])]);
    let range = range.map(|end| end - base);
    let at = |value: f64| {
        let part =
            if range[0] == range[1] { 0.5 } else { (value - range[0]) / (range[1] - range[0]) };
        plane.project(edge.ends[0].lerp(edge.ends[1], part.clamp(0.0, 1.0)))
    };
    let labelled = |wanted: usize| -> Vec<(DVec2, TextLabel)> {
        let ticks = ticks([range[0].min(range[1]), range[0].max(range[1])], wanted);
        let placed = ticks.into_iter().filter_map(|(value, text)| Some((at(value)?, text)));
        let with_label = |(at, text): (DVec2, String)| {
            (at, label(at + out * ((TICK + GAP) * letter), out, text, letter, options.text))
        };
        placed.map(with_label).collect()
    };
    // The largest number of labels that do not touch, or else a single label.
    let fitting = (1..=wanted).rev().map(labelled).find(|placed| stand_apart(placed, letter));
    let placed = fitting.unwrap_or_else(|| labelled(1).into_iter().take(1).collect());
    let mut widest: f64 = 0.0;
    for (at, label) in placed {
        push(marks, [at, at + out * (TICK * letter)]);
        widest = widest.max(reach(out, label.text.chars().count() as f64 * LETTER));
        // At a corner, the other axis may have a label already.
        if is_free(&label, &marks.labels, letter) {
            marks.labels.push(label);
        }
    }
    let name = match base {
        0.0 => name.to_owned(),
        b if b > 0.0 => format!("{name} - {}", short(b)),
        b => format!("{name} + {}", short(-b)),
    };
    if name.is_empty() {
        return;
    }
    let height = options.text;
    // Beside a vertical axis a long name would need a wide margin, so it is placed on top.
    let (at, out) = match edge.k {
        1 => (edge.seen[1] + DVec2::Y * (GAP * 1.6 * letter), DVec2::Y),
        _ => (middle + out * ((TICK + 2.2 * GAP + widest) * letter), out),
    };
    let mut name = match edge.k {
        1 => TextLabel { at, text: name, height, anchor: TextAnchor::Middle },
        _ => label(at, out, name, letter, height),
    };
    // Numbers at the end of an axis push its name on.
    for _ in 0..8 {
        if is_free(&name, &marks.labels, letter) {
            break;
        }
        name.at += out * (0.5 * letter);
    }
    marks.labels.push(name);
}

/// Returns the box of a label in the plane; `letter` is the height of a letter there.
pub fn box_of(label: &TextLabel, letter: f64) -> Option<Rect> {
    let width = label.text.chars().count() as f64 * LETTER * letter;
    let left = match label.anchor {
        TextAnchor::Start => 0.0,
        TextAnchor::Middle => 0.5 * width,
        TextAnchor::End => width,
    };
    let low = label.at - DVec2::new(left, 0.0);
    Rect::new(low, low + DVec2::new(width, letter)).ok()
}

/// Returns whether a label overlaps no other.
fn is_free(label: &TextLabel, others: &[TextLabel], letter: f64) -> bool {
    let Some(own) = box_of(label, letter) else { return true };
    let mut boxes = others.iter().filter_map(|other| box_of(other, letter));
    !boxes.any(|other| other.overlaps(&own))
}

/// Returns whether no label touches the next.
fn stand_apart(placed: &[(DVec2, TextLabel)], letter: f64) -> bool {
    let boxes: Vec<Rect> = placed.iter().filter_map(|(_, l)| box_of(l, letter)).collect();
    let room = DVec2::splat(APART * letter);
    boxes.windows(2).all(|pair| {
        let wider = Rect::new(pair[0].min() - room, pair[0].max() + room);
        wider.is_ok_and(|wider| !wider.overlaps(&pair[1]))
    })
}

/// Returns the extent of a text of this width in a direction, in heights of a letter.
fn reach(out: DVec2, width: f64) -> f64 {
    (width * out.x.abs()).max(out.y.abs())
}

/// Returns a text that extends from a point in a direction.
fn label(at: DVec2, out: DVec2, text: String, letter: f64, height: f64) -> TextLabel {
    let anchor = match out.x {
        x if x < -0.35 => TextAnchor::End,
        x if x > 0.35 => TextAnchor::Start,
        _ => TextAnchor::Middle,
    };
    // The letter's middle at the point for sideways, its top or foot for up and down.
    let at = at + DVec2::new(0.0, (out.y - 1.0) * 0.5 * letter);
    TextLabel { at, text, height, anchor }
}
