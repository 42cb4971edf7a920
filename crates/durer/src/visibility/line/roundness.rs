//! The choice of objects that approximate smooth surfaces.
//!
//! A mesh of a round part turns a little at each of its edges; one that is modelled in few facets turns by more, and
//! they are what it is. Told apart by area, object by object, from the angles alone: not by the view, so that all views
//! of a thing are drawn alike. O(n).

use super::planes::Planes;
use crate::parallel;
use crate::visibility::object::{Edges, Faces};
use std::ops::Range;

/// Objects whose outlines are those of the smooth surfaces that meshes approximate.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Smooth {
    /// They run along edges of the mesh.
    #[default]
    Off,
    /// They are smooth on objects that the mesh says are round: where most of what bends, by area and without
    /// creases, turns by less than 25° from facet to facet. Bends of more than 30° are edges on these, too.
    Auto,
    /// They are smooth wherever the mesh has no creases.
    On,
}

/// The cosine within which faces are one flat face: 0.1°. Less may be rounding of the file's coordinates.
pub(super) const FLAT: f64 = 1.0 - 1.5e-6;

/// The turn in radians up to which facets may be those of a round part: as for curves through lines
/// ([`crate::curve::fit`]), of 30° with 12 facets all around.
const ROUND: f64 = std::f64::consts::FRAC_PI_6;

/// The cosine of 25°: facets that turn by more are seen as such, with or without shading.
const COARSE: f64 = 0.906;

/// The part of the bent area that may turn by so much on a round object, at fins and small features: meshes of round
/// parts have up to 5 %, those of few facets from 20 % on.
const COARSE_PART: f64 = 0.125;

impl Smooth {
    /// Returns the angle in radians from which edges of smooth surfaces are sharp, where creases are from
    /// `crease` on.
    pub(super) fn sharp_from(self, crease: f64) -> f64 {
        if self == Self::Auto { crease.min(ROUND) } else { crease }
    }

    /// Returns true for each item of an object that has smooth outlines; `None` if none has.
    pub(super) fn items(
        self,
        (faces, edges): (&Faces, &Edges),
        planes: Option<&Planes>,
        crease: f64,
    ) -> Option<Vec<bool>> {
        let Some(planes) = planes.filter(|_| self == Self::Auto) else {
            return (self == Self::On).then(|| vec![true; faces.len()]);
        };
        let objects = faces.runs().iter().map(|r| r.instance + 1).max().unwrap_or(0);
        let mut bent = vec![Bent::default(); objects];
        for (object, part) in bends((faces, edges), planes, libm::cos(crease)) {
            bent[object].round += part.round;
            bent[object].coarse += part.coarse;
        }
        let is_round = |b: &Bent| b.round > 0.0 && b.coarse <= COARSE_PART * (b.round + b.coarse);
        if !bent.iter().any(is_round) {
            return None;
        }
        let mut items = vec![false; faces.len()];
        for run in faces.runs().iter().filter(|r| is_round(&bent[r.instance])) {
            items[run.items.start as usize..run.items.end as usize].fill(true);
        }
        Some(items)
    }
}

/// Share of an object that bends: the areas beside its edges, twice.
#[derive(Debug, Clone, Copy, Default)]
struct Bent {
    round: f64,
    coarse: f64,
}

/// Returns the bends in parts of one object each, in an order that is always the same.
fn bends((faces, edges): (&Faces, &Edges), planes: &Planes, crease: f64) -> Vec<(usize, Bent)> {
    let count = faces.points().len() as u32;
    let jobs: Vec<_> = (0..count).step_by(1 << 15).map(|v| v..(v + (1 << 15)).min(count)).collect();
    parallel::map(jobs, |vertices| bends_from((faces, edges), planes, crease, vertices)).concat()
}

/// Returns the same of the edges whose smaller vertices lie in a range.
fn bends_from(
    (faces, edges): (&Faces, &Edges),
    planes: &Planes,
    crease: f64,
    vertices: Range<u32>,
) -> Vec<(usize, Bent)> {
    let mut found: Vec<(usize, Bent)> = Vec::new();
    let (mut items, mut object) = (0..0, 0);
    for (_, sides) in edges.from_vertices(vertices) {
        let [a, b] = sides else { continue };
        let cosine = planes.cosine(*a, *b);
        if !(cosine < FLAT && cosine >= crease) {
            continue;
        }
        if !items.contains(&a.item()) {
            let Some(run) = faces.run_of(a.item()) else { continue };
            (items, object) = (run.items.clone(), run.instance);
        }
        if found.last().is_none_or(|f| f.0 != object) {
            found.push((object, Bent::default()));
        }
        let Some((_, bent)) = found.last_mut() else { continue };
        let area = planes.area(a.item()) + planes.area(b.item());
        *(if cosine < COARSE { &mut bent.coarse } else { &mut bent.round }) += area;
    }
    found
}
