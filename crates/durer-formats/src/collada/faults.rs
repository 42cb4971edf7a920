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
        (
            &faults.numbers,
            "{word of an array is not a finite number; it counts|words of arrays are not finite numbers; they count} as 0",
        ),
        (
            &faults.indices,
            "{corner has an index beyond its source; its face is|corners have an index beyond their source; their faces are} left out",
        ),
        (
            &faults.attributes,
            "{corner refers|corners refer} to a normal, color or texture coordinate beyond its source; {it gets|they get} none",
        ),
        (
            &faults.short,
            "{face or list has too few indices; it is|faces or lists have too few indices; they are} left out",
        ),
        (
            &faults.unknown,
            "{geometry is not a mesh (but a spline or body); it is|geometries are not meshes (but splines or bodies); they are} left out",
        ),
        (
            &faults.sources,
            "{input names|inputs name} a source that is missing or has no numbers; {it is|they are} left out",
        ),
        (
            &faults.holes,
            "{hole of a polygon could not be cut; it is|holes of polygons could not be cut; they are} filled",
        ),
    ] {
        model.warn_of(tally, what);
    }
}
