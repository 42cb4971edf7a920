//! Threads as drawings show them (ISO 6410-1): thin lines, and three quarters of a circle, at the depth of the thread.

use super::automatic::{circles, no_room, place_diameter};
use super::board::{Board, Layer, arc_mark};
use super::draw::Said;
use super::feature::{self, FeatureKind, RoundFeature};
use super::request::{Thread, ThreadSize};
use super::seen::{Seen, Sight};
use crate::Result;
use crate::math::DVec2;
use crate::paper::Pens;
use crate::target::drawing::LineClass;
use crate::target::sheet::PaperMark;

/// The core of a screw whose pitch is not known, as a part of its diameter: as drawings show it.
const CORE: f64 = 0.85;

/// Largest difference between the diameters of a cylinder and its thread, as a part of the diameter.
const NEAR: f64 = 0.15;

/// The arc is open in the upper right quarter: from 95° on, for 270°.
const START: f64 = 95.0;
const TURN: f64 = 270.0;

/// Draws the threads in all views, and the label of each at one place. Returns the features whose size is thereby
/// given.
pub(super) fn put<'a>(
    board: &mut Board,
    views: &[Seen],
    features: &'a [RoundFeature],
    threads: &[Thread],
    unit: f64,
    notes: &mut Vec<String>,
) -> Result<Vec<&'a RoundFeature>> {
    let mut sized = Vec::new();
    for thread in threads {
        let found = feature::named(features, &thread.name)?;
        let mut threaded: Vec<&'a RoundFeature> = Vec::new();
        for feature in found.into_iter().filter(|f| f.kind != FeatureKind::Fillet) {
            match other_radius(feature, thread.size.as_ref(), unit) {
                Some(radius) => {
                    views.iter().for_each(|view| symbol(board, view, feature, radius));
                    threaded.push(feature);
                }
                None => notes.push(format!(
                    "--thread: {} of `{}` has a diameter of {}, which does not fit {}; it is drawn without a thread",
                    feature.name,
                    thread.name,
                    super::style::length(2.0 * feature.cylinder.radius, unit),
                    thread.size.as_ref().map_or("a thread", |s| s.text.as_str()),
                )),
            }
        }
        if let Some(size) = &thread.size {
            sized.extend(&threaded);
            label(board, views, threaded, size, notes);
        }
    }
    Ok(sized)
}

/// Returns the radius of the thin lines, in units of the model.
fn other_radius(feature: &RoundFeature, size: Option<&ThreadSize>, unit: f64) -> Option<f64> {
    let (radius, hole) = (feature.cylinder.radius, feature.kind == FeatureKind::Hole);
    let Some(size) = size else {
        return Some(if hole { radius / CORE } else { radius * CORE });
    };
    let [major, minor] = [size.major, size.minor()].map(|d| 0.5 * d / unit);
    let near = |r: f64| (radius - r).abs() <= NEAR * major;
    let at_major = (radius - major).abs() <= (radius - minor).abs();
    (near(major) || near(minor)).then_some(if at_major { minor } else { major })
}

fn symbol(board: &mut Board, view: &Seen, feature: &RoundFeature, radius: f64) {
    let (cylinder, reach) = (&feature.cylinder, radius * view.factor());
    let thin = board.thin();
    match view.sight(cylinder.axis()) {
        Sight::EndOn => {
            let Some((center, _)) = view.circle(cylinder) else { return };
            let [start, turn] = [START, TURN].map(f64::to_radians);
            board.add(Layer::Thread, arc_mark(center, reach, start, turn, thin));
        }
        Sight::Along(way) => {
            let ends = cylinder.ends.map(|p| view.point(p));
            let Some(hidden) = is_hidden(view, feature, ends, way) else { return };
            let pen = if hidden { dashed(board) } else { thin };
            for side in [way.perp() * reach, -way.perp() * reach] {
                let points = ends.map(|p| p + side).to_vec();
                board.add(Layer::Thread, PaperMark::Stroke { points, closed: false, pen });
            }
        }
        Sight::Oblique(_) => {}
    }
}

fn dashed(board: &mut Board) -> usize {
    let dashes = Pens::default().hidden(LineClass::Crease, true).dashes;
    board.pen(super::style::THIN, dashes)
}

/// Returns whether the lines of a thread seen from the side are hidden; `None` if they are not drawn. The outline of a
/// screw is visible; the outline of a hole is visible in sections and hidden elsewhere.
fn is_hidden(view: &Seen, feature: &RoundFeature, ends: [DVec2; 2], way: DVec2) -> Option<bool> {
    let side = way.perp() * feature.cylinder.radius * view.factor();
    let corners = ends.iter().flat_map(|p| [*p + side, *p - side]);
    let drawn = corners.filter(|p| view.has_point(*p)).count() >= 2;
    let cut = view.placed.name.contains('–');
    drawn.then_some(feature.kind == FeatureKind::Hole && !cut)
}

/// Places the label of a thread.
fn label(
    board: &mut Board,
    views: &[Seen],
    threaded: Vec<&RoundFeature>,
    size: &ThreadSize,
    notes: &mut Vec<String>,
) {
    if threaded.is_empty() {
        return;
    }
    let mut rest = threaded;
    for view in views {
        let Some((targets, value)) = circles(view, &mut rest) else { continue };
        let times = if targets.len() > 1 { format!("{}× ", targets.len()) } else { String::new() };
        let text = format!("{times}{}", size.text);
        let said = Said { text, is_plain: false, value, scale: 1.0 / view.factor() };
        if !place_diameter(board, view, &targets, None, &said) {
            notes.push(no_room(&said.text));
        }
        return;
    }
    notes.push(format!("no view shows the thread {} as a circle; it has no label", size.text));
}
