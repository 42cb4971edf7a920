//! Boxes for examples, and the checks of input bodies.

use super::MOST;
use crate::explain::input::Input;
use crate::explain::lesson::Example;
use crate::explain::words::Word;
use crate::math::DVec3;
use crate::{Error, Result};

/// A box before another one, in a position where three faces of each are seen.
pub(super) const BOXES: Example = Example {
    name: "boxes",
    title: Word::new("a box before a box", "ein Quader vor einem Quader"),
    input: || {
        let mut faces = cuboid([0.0, 0.0, 0.0], [4.0, 3.0, 2.0]);
        faces.extend(cuboid([1.0, -1.0, 4.0], [3.0, 1.5, 5.0]));
        Input::Faces(faces)
    },
};

/// A bar through a box, in the same position.
pub(super) const PIERCED: Example = Example {
    name: "pierced",
    title: Word::new("a bar through a box", "ein Stab durch einen Quader"),
    input: || {
        let mut faces = cuboid([0.0, 0.0, 0.0], [3.0, 3.0, 3.0]);
        faces.extend(cuboid([-2.0, 1.0, 1.0], [5.0, 2.0, 2.0]));
        Input::Faces(faces)
    },
};

/// Two boxes side by side, in the same position.
pub(super) const BESIDE: Example = Example::new(
    "beside",
    "two boxes side by side: only their own faces hide edges",
    "zwei Quader nebeneinander: Nur die eigenen Flächen verdecken Kanten",
    || {
        let mut faces = cuboid([0.0, 0.0, 0.0], [2.0, 2.0, 2.0]);
        faces.extend(cuboid([4.0, 0.0, 0.0], [6.0, 2.0, 2.0]));
        Input::Faces(faces)
    },
);

/// Three boxes, one behind the other.
pub(super) const THREE: Example = Example::new(
    "three",
    "three boxes, one behind the other",
    "drei Quader hintereinander",
    || {
        let mut faces = cuboid([0.0, 0.0, 0.0], [3.0, 3.0, 1.0]);
        faces.extend(cuboid([0.5, 0.5, 3.0], [2.5, 2.5, 4.0]));
        faces.extend(cuboid([1.0, 1.0, 6.0], [2.0, 2.0, 7.0]));
        Input::Faces(faces)
    },
);

/// A single box.
pub(super) const BOX: Example = Example::new(
    "box",
    "one box: three of its edges are hidden",
    "ein Quader: drei Kanten sind verdeckt",
    || Input::Faces(cuboid([0.0, 0.0, 0.0], [4.0, 2.0, 3.0])),
);

/// Returns the six faces of a box with sides along the axes.
pub(super) fn upright(low: [f64; 3], high: [f64; 3]) -> Vec<Vec<DVec3>> {
    let corner =
        |i: usize| DVec3::from([0, 1, 2].map(|k| if i >> k & 1 == 1 { high[k] } else { low[k] }));
    let faces =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    faces.map(|face| face.map(corner).to_vec()).to_vec()
}

/// Returns the same turned, so that three faces are seen: by 3-4-5 triangles and 5-12-13 triangles.
pub(super) fn cuboid(low: [f64; 3], high: [f64; 3]) -> Vec<Vec<DVec3>> {
    upright(low, high).iter().map(|face| face.iter().copied().map(turned).collect()).collect()
}

/// Returns a point turned so that three faces of a box with sides along the axes are seen.
pub(super) fn turned(p: DVec3) -> DVec3 {
    let (x, z) = (0.8 * p.x + 0.6 * p.z, 0.8 * p.z - 0.6 * p.x);
    DVec3::new(x, (12.0 * p.y - 5.0 * z) / 13.0, (5.0 * p.y + 12.0 * z) / 13.0)
}

/// Checks that an input has no more faces than a picture can show.
pub(super) fn check_count(faces: &[Vec<DVec3>]) -> Result<()> {
    if faces.len() <= MOST {
        return Ok(());
    }
    let (value, limit) = (faces.len() as u64, MOST as u64);
    Err(Error::Limit { what: "number of faces to be explained", value, limit })
}
