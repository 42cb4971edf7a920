//! Places in a picture that a step is about: what a student clicks who is asked for the next one.

use durer::explain::{Look, MarkShape, Picture};
use durer::math::DVec2;
use serde_json::{Value, json};

/// Returns the pixels, points, lines and areas that a picture marks as those of its step, in its coordinates.
pub(crate) fn targets(picture: &Picture) -> Value {
    let now = picture.marks.iter().filter(|mark| mark.look == Look::Now);
    now.filter_map(|mark| target(&mark.shape)).collect()
}

fn target(shape: &MarkShape) -> Option<Value> {
    let points = |all: &[DVec2]| all.iter().map(DVec2::to_array).collect::<Vec<_>>();
    match shape {
        MarkShape::Cell { at, .. } => Some(json!({ "pixel": at })),
        MarkShape::Dot(p) => Some(json!({ "point": p.to_array() })),
        MarkShape::Chain(all) if all.len() > 1 => Some(json!({ "line": points(all) })),
        MarkShape::Arrow(ends) => Some(json!({ "line": points(ends) })),
        MarkShape::Rings(rings) => {
            Some(json!({ "area": rings.iter().map(|ring| points(ring)).collect::<Vec<_>>() }))
        }
        MarkShape::Chain(_) | MarkShape::Label { .. } => None,
    }
}
