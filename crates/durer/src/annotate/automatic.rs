//! Sizes of the whole, and diameters of round parts.

use super::board::Board;
use super::center;
use super::draw::Said;
use super::feature::{FeatureKind, RoundFeature};
use super::place::{self, Target};
use super::request::ViewSide;
use super::seen::{Seen, Sight};
use super::style;
use crate::math::{DVec2, DVec3};
use crate::sorting::CompactSort;
use crate::target::dimension::Measure;

/// Holes that are alike and are tried for the place of their dimension.
const TRIED: usize = 48;

/// Views whose names are not these show a part of the whole.
const WHOLE: &[&str] = &["", "front", "top", "right", "left", "back", "bottom"];

/// Returns the text of a dimension for a length.
pub(super) fn said(sign: &str, value: f64, count: usize, view: &Seen, unit: f64) -> Said {
    let times = if count > 1 { format!("{count}× ") } else { String::new() };
    let text = format!("{times}{sign}{}", style::length(value, unit));
    // Programs that regenerate the text write two digits after the point.
    let is_plain = count <= 1 && text.rsplit_once('.').is_none_or(|(_, digits)| digits.len() <= 2);
    Said { text, is_plain, value, scale: 1.0 / view.factor().max(f64::MIN_POSITIVE) }
}

/// Puts the size along each axis of the world into the first view that shows it; returns the sizes
/// without one.
pub(super) fn sizes(
    board: &mut Board,
    views: &[Seen],
    features: &[RoundFeature],
    unit: f64,
    notes: &mut Vec<String>,
) {
    let whole = |v: &&Seen| v.is_from_a_side() && WHOLE.contains(&v.placed.name.as_str());
    if !views.iter().any(|v| whole(&v)) {
        notes
            .push("no view from a side shows the size; give --view front, top or right".to_owned());
    }
    for (axis, name) in [(DVec3::X, "x"), (DVec3::Y, "y"), (DVec3::Z, "z")] {
        let shown = views.iter().filter(whole).find_map(|v| match v.sight(axis) {
            Sight::Along(way) => Some((v, way)),
            _ => None,
        });
        // One view from a side does not show the third size.
        let Some((view, way)) = shown else { continue };
        if !size(board, view, features, axis, way, unit) {
            notes.push(no_room(&format!("the size along {name}")));
        }
    }
}

/// Returns whether there was room.
fn size(
    board: &mut Board,
    view: &Seen,
    features: &[RoundFeature],
    axis: DVec3,
    way: DVec2,
    unit: f64,
) -> bool {
    let way = super::draw::reading(way);
    let (side, then) = if way.x.abs() > way.y.abs() {
        ([ViewSide::Below, ViewSide::Above], DVec2::Y)
    } else {
        ([ViewSide::Left, ViewSide::Right], -DVec2::X)
    };
    let found = view.farthest(-way, then).zip(view.farthest(way, then));
    let Some((low, high)) = found else { return true };
    let (mut from, mut to) = (low.dot(way), high.dot(way));
    // A mesh's polygon is smaller than the circle that it approximates.
    for cylinder in features.iter().map(|f| &f.cylinder).filter(|c| c.is_full() && !c.hollow) {
        let along = cylinder.axis().dot(axis);
        let reach = cylinder.radius * (1.0 - along * along).max(0.0).sqrt() * view.factor();
        for end in
            cylinder.ends.map(|p| view.point(p).dot(way)).into_iter().filter(|e| e.is_finite())
        {
            from = from.min(end - reach);
            to = to.max(end + reach);
        }
    }
    let ends = [low + way * (from - low.dot(way)), high + way * (to - high.dot(way))];
    let value = view.length(ends, way);
    if !(value > 0.0 && value.is_finite()) {
        return true;
    }
    place::linear(board, view, ends, way, &side, &said("", value, 1, view, unit))
}

/// Places the diameters of the features of one kind: equal ones share one dimension, with their number. Notes name
/// features without room for one.
pub(super) fn diameters(
    board: &mut Board,
    views: &[Seen],
    features: &[&RoundFeature],
    unit: f64,
    notes: &mut Vec<String>,
) {
    let text = |f: &RoundFeature| style::length(2.0 * f.cylinder.radius, unit);
    let kind = features.first().map_or(FeatureKind::Hole, |f| f.kind);
    let mut left: Vec<&RoundFeature> = features.to_vec();
    left.compact_sort_by(|a, b| a.cylinder.radius.total_cmp(&b.cylinder.radius));
    for alike in left.chunk_by(|a, b| text(a) == text(b)) {
        let mut rest: Vec<&RoundFeature> = alike.to_vec();
        for view in views {
            let Some((targets, value)) = circles(view, &mut rest) else { continue };
            let said = said("⌀", value, targets.len(), view, unit);
            if !place_diameter(board, view, &targets, None, &said) {
                notes.push(no_room(&said.text));
            }
            if kind == FeatureKind::Hole {
                pitch(board, view, &targets, unit, notes);
            }
        }
        if let [first, ..] = rest[..] {
            let (count, name) = (rest.len(), kind.name());
            let many =
                if count > 1 { format!("{count} {}", plural(name)) } else { format!("a {name}") };
            notes.push(format!(
                "no view shows {many} of ⌀{} as a circle; there is no dimension",
                text(first)
            ));
        }
    }
}

/// Puts the diameter of the pitch circle of holes, if they have one.
fn pitch(board: &mut Board, view: &Seen, holes: &[Target], unit: f64, notes: &mut Vec<String>) {
    let radius = holes.first().map_or(0.0, |t| t.radius);
    let Some((center, radius)) = center::pitch_of(holes.iter().map(|t| t.center), radius) else {
        return;
    };
    let said = said("⌀", 2.0 * radius / view.factor(), 1, view, unit);
    let target = Target { center, radius, facing: None };
    if !place_diameter(board, view, &[target], None, &said) {
        notes.push(no_room(&said.text));
    }
}

/// Returns a warning about an annotation that finds no place.
pub(super) fn no_room(what: &str) -> String {
    format!("there is no room for {what}; give a larger --page, or a smaller --scale")
}

fn plural(name: &str) -> String {
    if name.ends_with('s') { format!("{name}es") } else { format!("{name}s") }
}

/// Removes from the list the features that a view shows as circles; returns their distinct circles and their diameter.
pub(super) fn circles(view: &Seen, rest: &mut Vec<&RoundFeature>) -> Option<(Vec<Target>, f64)> {
    let mut targets: Vec<Target> = Vec::new();
    let mut value = None;
    rest.retain(|f| {
        let Some((center, radius)) = view.circle(&f.cylinder) else { return true };
        if !targets.iter().any(|t| t.center.distance(center) < 0.05) {
            targets.push(Target { center, radius, facing: None });
        }
        value.get_or_insert(2.0 * f.cylinder.radius);
        false
    });
    // Parts behind a circle that has its dimension need none.
    rest.retain(|f| {
        let hidden = view.sight(f.cylinder.axis()) == Sight::EndOn;
        !(hidden && targets.iter().any(|t| t.center.distance(view.point(f.middle())) < 0.05))
    });
    value.map(|value| (targets, value))
}

/// Puts a diameter at one of several circles; returns whether there was room.
pub(super) fn place_diameter(
    board: &mut Board,
    view: &Seen,
    targets: &[Target],
    side: Option<ViewSide>,
    said: &Said,
) -> bool {
    let tried = &targets[..targets.len().min(TRIED)];
    place::leader(board, view, tried, side, said, |target, way| {
        let reach = way * target.radius;
        Some(Measure::Diameter { ends: [target.center - reach, target.center + reach] })
    })
}
