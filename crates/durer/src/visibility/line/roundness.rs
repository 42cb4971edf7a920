//! The choice of objects that approximate smooth surfaces.
//!
//! At each edge the mesh of a round part turns a little; a shape modelled with few facets turns by more and really has
//! these edges. The two are distinguished by area, object by object, from the angles alone and not by the view, so that
//! all views of an object are drawn alike. O(n).

use super::planes::Planes;
use crate::math::DVec3;
use crate::parallel;
use crate::visibility::object::{Edges, Faces};
use std::ops::Range;

/// Objects whose outlines are those of the smooth surfaces that meshes approximate.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Smooth {
    /// Outlines run along edges of the mesh.
    #[default]
    Off,
    /// Outlines are smooth on objects that the mesh shows to be round: most of their bent area, without creases, turns
    /// by less than 25° from facet to facet, or has facets too narrow to be visible. On the former, bends of more than
    /// 30° are edges too.
    Auto,
    /// Outlines are smooth wherever the mesh has no creases.
    On,
}

/// The cosine of the angle up to which faces count as one flat face: 0.1°. Smaller angles may be rounding of the file's
/// coordinates.
pub(super) const FLAT: f64 = 1.0 - 1.5e-6;

/// The angle in radians up to which facets may belong to a round part, as for curves through lines
/// ([`crate::curve::fit`]): 30°, that is, 12 facets all around.
const ROUND: f64 = std::f64::consts::FRAC_PI_6;

/// The cosine of 25°: facets that turn by more are visible as such, with or without shading.
const COARSE: f64 = 0.906;

/// The part of the bent area that may exceed this angle on a round object, at fins and small features: meshes of round
/// parts have up to 5 %, shapes modelled with few facets from 20 % on.
const COARSE_PART: f64 = 0.125;

/// The distance, as a part of an object's diagonal, within which facets count as the surface itself: less than a pen's
/// width if the object fills a page. So a thin wire may have few facets around and still be round.
const UNSEEN: f64 = 0.002;

/// The items of objects that have smooth outlines.
pub(super) struct Round {
    /// True for each item of these objects.
    pub items: Vec<bool>,
    /// True for items of objects with facets too narrow to be visible; empty if there are none.
    narrow: Vec<bool>,
    /// The angles in radians from which edges are sharp: of the other objects, and of those with narrow facets.
    sharp: [f64; 2],
}

impl Round {
    /// Returns whether an item belongs to an object with facets too narrow to be visible.
    pub fn is_narrow(&self, item: u32) -> bool {
        self.narrow.get(item as usize) == Some(&true)
    }

    /// Returns the angles in radians from which edges are sharp, each with whether it is for narrow facets.
    pub fn sharp(&self) -> impl Iterator<Item = (f64, bool)> {
        let kinds = if self.narrow.is_empty() { 1 } else { 2 };
        self.sharp.into_iter().zip([false, true]).take(kinds)
    }
}

impl Smooth {
    /// Returns the items of objects with smooth outlines, with creases from the angle `crease` on; `None` if there are
    /// none.
    pub(super) fn round(
        self,
        (faces, edges): (&Faces, &Edges),
        planes: Option<&Planes>,
        crease: f64,
    ) -> Option<Round> {
        let Some(planes) = planes.filter(|_| self == Self::Auto) else {
            let (items, narrow) = (vec![true; faces.len()], Vec::new());
            return (self == Self::On).then_some(Round { items, narrow, sharp: [crease; 2] });
        };
        let sharp = [crease.min(ROUND), crease];
        let objects = faces.runs().iter().map(|r| r.instance + 1).max().unwrap_or(0);
        let crease = libm::cos(crease);
        let bent = sums(bends((faces, edges), planes, (crease, &[])), objects);
        let mut round: Vec<bool> = bent.iter().map(Bent::is_round).collect();
        let mut narrow = vec![false; objects];
        if bent.iter().any(Bent::is_of_few_facets) {
            let unseen = sizes(faces, objects).into_iter().map(|s| s * UNSEEN).collect::<Vec<_>>();
            let bent = sums(bends((faces, edges), planes, (crease, &unseen)), objects);
            narrow =
                bent.iter().zip(&round).map(|(bent, round)| !round && bent.is_round()).collect();
            round.iter_mut().zip(&narrow).for_each(|(round, narrow)| *round |= narrow);
        }
        if !round.contains(&true) {
            return None;
        }
        let of = |objects: &[bool]| {
            let mut items = vec![false; faces.len()];
            for run in faces.runs().iter().filter(|r| objects[r.instance]) {
                items[run.items.start as usize..run.items.end as usize].fill(true);
            }
            items
        };
        let narrow = if narrow.contains(&true) { of(&narrow) } else { Vec::new() };
        Some(Round { items: of(&round), narrow, sharp })
    }
}

/// Share of an object that is bent: the areas beside its edges, doubled.
#[derive(Debug, Clone, Copy, Default)]
struct Bent {
    round: f64,
    coarse: f64,
}

impl Bent {
    fn is_of_few_facets(&self) -> bool {
        self.coarse > COARSE_PART * (self.round + self.coarse)
    }

    fn is_round(&self) -> bool {
        self.round > 0.0 && !self.is_of_few_facets()
    }
}

/// Returns the sums of bends by object.
fn sums(parts: Vec<(usize, Bent)>, objects: usize) -> Vec<Bent> {
    let mut bent = vec![Bent::default(); objects];
    for (object, part) in parts {
        bent[object].round += part.round;
        bent[object].coarse += part.coarse;
    }
    bent
}

/// Returns the diagonal of each object.
fn sizes(faces: &Faces, objects: usize) -> Vec<f64> {
    let mut boxes = vec![[DVec3::INFINITY, DVec3::NEG_INFINITY]; objects];
    for run in faces.runs() {
        let [min, max] = &mut boxes[run.instance];
        for corner in run.items.clone().filter_map(|item| faces.corners(item)).flatten() {
            (*min, *max) = (min.min(corner), max.max(corner));
        }
    }
    boxes.into_iter().map(|[min, max]| (max - min).max(DVec3::ZERO).length()).collect()
}

/// Returns the bends in parts of one object each, in a fixed order. Facets that are no farther from a round surface
/// than the share `unseen` of their object's diagonal, if given, do not count as coarse.
fn bends(
    (faces, edges): (&Faces, &Edges),
    planes: &Planes,
    (crease, unseen): (f64, &[f64]),
) -> Vec<(usize, Bent)> {
    let count = faces.points().len() as u32;
    let jobs: Vec<_> = (0..count).step_by(1 << 15).map(|v| v..(v + (1 << 15)).min(count)).collect();
    let of = |vertices| bends_from((faces, edges), planes, (crease, unseen), vertices);
    parallel::map(jobs, of).concat()
}

/// Returns the same for the edges whose smaller vertices are in a range.
fn bends_from(
    (faces, edges): (&Faces, &Edges),
    planes: &Planes,
    (crease, unseen): (f64, &[f64]),
    vertices: Range<u32>,
) -> Vec<(usize, Bent)> {
    let mut found: Vec<(usize, Bent)> = Vec::new();
    let (mut items, mut object) = (0..0, 0);
    for (ends, sides) in edges.of_vertices(vertices) {
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
        let is_unseen = |unseen: &f64| {
            // The sagitta of a chord as wide as the facets, which is θ/8 of its width.
            let width = area / (2.0 * length(faces, ends));
            width * (2.0 * (1.0 - cosine)).sqrt() / 8.0 <= *unseen
        };
        let coarse = cosine < COARSE && !unseen.get(object).is_some_and(is_unseen);
        *(if coarse { &mut bent.coarse } else { &mut bent.round }) += area;
    }
    found
}

fn length(faces: &Faces, [a, b]: [u32; 2]) -> f64 {
    faces.points()[a as usize].distance(faces.points()[b as usize])
}
