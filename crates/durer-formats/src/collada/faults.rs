//! Omissions and repairs in geometries, as warnings.

use crate::Model;
use crate::text::Tally;

/// Omissions and repairs.
#[derive(Debug, Default)]
pub(super) struct Faults {
    pub numbers: Tally,
    pub indices: Tally,
    pub attributes: Tally,
    pub short: Tally,
    pub unknown: Tally,
    pub sources: Tally,
    pub holes: Tally,
}

/// Adds warnings of what was left out or repaired.
pub(super) fn warn(model: &mut Model, faults: &Faults) {
    for (tally, what) in [
        (&faults.numbers, "numbers of arrays are none or not finite; they are 0"),
        (&faults.indices, "corners have an index beyond their source; their faces are left out"),
        (
            &faults.attributes,
            "corners have a normal, color or place in a texture beyond its source; they have none",
        ),
        (&faults.short, "faces or lists have too few indices; they are left out"),
        (&faults.unknown, "geometries are not meshes (splines, bodies); they are left out"),
        (
            &faults.sources,
            "inputs name a source that is not there or has no numbers; they are left out",
        ),
        (&faults.holes, "holes of polygons could not be cut; they are filled"),
    ] {
        if tally.count > 0 {
            model.warn(tally.first.clone(), format!("{} {what}", tally.count));
        }
    }
}
