//! The lines and points of a model in a drawing: lines as they are, points as small crosses.

use super::page::{GridPoint, Projected, Vertex};
use crate::visibility::object::Faces;

/// Half the length of a cross's arms, as a part of the view's larger side.
const ARM: f64 = 0.0025;

/// The longest arm in steps, so that crosses stay where coordinates are exact.
const LONGEST: f64 = (1u32 << 25) as f64;

/// Returns the segments that represent the model's own lines and points on the page, in their order; what is outside
/// the view volume is cut off.
pub(super) fn marks<'a>(
    faces: &'a Faces,
    projected: &'a Projected,
) -> impl Iterator<Item = [Vertex; 2]> + 'a {
    let arm = arm(projected);
    faces.marks().iter().flat_map(move |&ends| {
        let seen = projected.edge(faces, ends);
        let [first, second] = match seen {
            Some([a, _]) if ends[0] == ends[1] => cross(a, arm).map(Some),
            _ => [seen, None],
        };
        first.into_iter().chain(second).filter(|[a, b]| a.at != b.at)
    })
}

/// Returns half the length of a cross's arms, in steps of the grid.
fn arm(projected: &Projected) -> i32 {
    let shown = projected.plane.window().map(|w| w.size().max_element() / projected.page.step);
    let steps = shown.unwrap_or(projected.page.extent) * ARM;
    steps.clamp(1.0, LONGEST) as i32
}

fn cross(center: Vertex, arm: i32) -> [[Vertex; 2]; 2] {
    let to = |x: i32, y: i32| {
        let at = GridPoint { x: center.at.x + x, y: center.at.y + y };
        Vertex { at, ..center }
    };
    [[to(-arm, 0), to(arm, 0)], [to(0, -arm), to(0, arm)]]
}
