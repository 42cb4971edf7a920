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

/// Adds warnings about omissions and repairs.
pub(super) fn warn(model: &mut Model, faults: &Faults) {
    for (tally, what) in [
        (&faults.numbers, "words of arrays are not finite numbers; they count as 0"),
        (&faults.indices, "corners have an index beyond their source; their faces are left out"),
        (
            &faults.attributes,
            "corners refer to a normal, color or texture coordinate beyond its source; they get none",
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
