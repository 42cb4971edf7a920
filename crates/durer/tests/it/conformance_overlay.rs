//! `overlay()` on the published suites.

use durer::clip::polygon::overlay::{Options, overlay};
use durer::trace::NoTrace;

use crate::overlay::cases::{ClipperCase, shared};
use crate::overlay::validity;

#[test]
fn clipper2_polygons_are_valid() {
    let Some(text) = shared("geo2d/clipper2/Polygons.txt") else { return };
    let cases = ClipperCase::all(&text);
    assert_eq!(cases.len(), 195);
    for case in &cases {
        let options = Options::with_rule(case.rule);
        let out =
            overlay(&case.subject, &case.clip, case.op, &options, &mut NoTrace).expect("finite");
        if let Err(why) = validity::check(&out.shapes, out.cell) {
            panic!("case {}: {why}", case.number);
        }
    }
}
