//! The cutting plane of a section in another view: a chain line with thick ends, arrows in the direction of
//! sight of the section, and its letter twice (ISO 128-3).

use super::marks::{Annotator, LETTER, THICK, THIN};
use super::{SheetView, ViewKind};
use crate::math::{DVec2, Plane, Rect};
use crate::paper::PlacedView;
use crate::scene::Camera;

/// Length of the line beyond the view, and of its thick ends, in millimetres.
const BEYOND: f64 = 7.0;
const THICK_END: f64 = 6.0;
/// Distance of an arrow's tail from the line, and of a letter's middle from the tail.
const ARROW: f64 = 9.0;
const TO_LETTER: f64 = 1.0 + LETTER * 0.5;

/// A long-dashed dotted line (ISO 128-2, type 04), thin.
const CHAIN: [f64; 4] = [6.0, 1.25, 0.25, 1.25];

/// Largest sine of the angle between a line of sight and a plane that is seen edge on.
const EDGE_ON: f64 = 1e-6;

/// Draws the planes of all sections in the layer `cutting-planes`. Planes that no view can show are noted.
pub fn put(
    annotator: &mut Annotator,
    views: &[SheetView],
    placed: &[PlacedView],
    notes: &mut Vec<String>,
) {
    for view in views {
        let ViewKind::Section { letter, plane } = &view.kind else { continue };
        let parents = views.iter().zip(placed).filter(|(v, _)| v.is_principal());
        let mut traces = parents.filter_map(|(v, p)| trace(plane, &v.camera, p));
        match traces.next() {
            Some(trace) => draw(annotator, &trace, letter),
            None => notes.push(format!(
                "section {letter}: no view of the sheet sees its plane edge on and cut, so none shows where it is"
            )),
        }
    }
    annotator.end_layer("cutting-planes");
}

/// A plane that is seen edge on.
struct Trace {
    /// Ends of the line in the drawing, on the sheet.
    ends: [DVec2; 2],
    /// The direction in which the section is examined, on the sheet; unit length.
    sight: DVec2,
}

/// Returns the trace of a plane in a view, if the view sees it edge on and it meets the drawing.
fn trace(plane: &Plane, camera: &Camera, view: &PlacedView) -> Option<Trace> {
    let plane = plane.normalized()?;
    let [right, up, back] = camera.axes();
    if plane.normal.dot(back).abs() > EDGE_ON {
        return None;
    }
    let sight = DVec2::new(plane.normal.dot(right), -plane.normal.dot(up)).normalize_or_zero();
    // The point of the plane nearest to the target, seen from along the plane.
    let foot =
        view.sheet_from_model(camera.target - plane.normal * plane.evaluate(camera.target))?;
    let ends = across(&view.bounds, foot, sight.perp())?;
    Some(Trace { ends, sight })
}

/// Returns the part of a line in a rectangle, in the direction of the line.
fn across(rect: &Rect, at: DVec2, along: DVec2) -> Option<[DVec2; 2]> {
    let (mut enter, mut leave) = (f64::NEG_INFINITY, f64::INFINITY);
    for axis in [0, 1] {
        let (min, max) = (rect.min()[axis] - at[axis], rect.max()[axis] - at[axis]);
        if along[axis].abs() < EDGE_ON {
            if !(min <= 0.0 && max >= 0.0) {
                return None;
            }
            continue;
        }
        let (a, b) = (min / along[axis], max / along[axis]);
        (enter, leave) = (enter.max(a.min(b)), leave.min(a.max(b)));
    }
    (enter < leave && enter.is_finite() && leave.is_finite())
        .then(|| [at + along * enter, at + along * leave])
}

fn draw(annotator: &mut Annotator, trace: &Trace, letter: &str) {
    let [a, b] = trace.ends;
    let along = (b - a).normalize_or_zero();
    let ends = [(a - along * BEYOND, along), (b + along * BEYOND, -along)];
    let thin = ends.map(|(end, inwards)| end + inwards * THICK_END);
    annotator.line(thin.to_vec(), THIN, &CHAIN);
    for (end, inwards) in ends {
        annotator.line(vec![end, end + inwards * THICK_END], THICK, &[]);
        // The tip touches the line where it is thick.
        let tip = end + inwards * (THICK_END * 0.25);
        let tail = tip - trace.sight * ARROW;
        annotator.arrow(tail, tip);
        annotator.letters(tail - trace.sight * TO_LETTER, letter, LETTER);
    }
}
