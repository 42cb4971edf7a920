//! Normals of the smooth surface at the vertices of a mesh that has none.
//!
//! Henri Gouraud, *Continuous shading of curved surfaces*, IEEE Transactions on Computers, 1971: averages over the
//! faces around a vertex. Weights are area times angle: it does not matter how a quadrilateral is divided, as in Grit
//! Thürmer and Charles Wüthrich, *Computing vertex normals from polygonal facets*, Journal of Graphics Tools, 1998, and
//! large flat faces keep their own direction beside narrow roundings.
//!
//! Faces beyond a sharp edge do not count: beyond a crease, and beyond a bend between two flat faces that are no facets
//! of a round surface. O(n) for vertices of bounded degree.

use super::planes::Planes;
use super::roundness::FLAT;
use crate::math::DVec3;
use crate::parallel;
use crate::visibility::object::{Edges, Faces};

/// Triangles lower than this part of their longest side L are slivers. A surface that turns by less than the crease
/// angle θ along that side is up to θL/8 away from it: lower triangles may be turned against it by more than θ.
const SLIVER: f64 = 0.125;

/// Lower than this part of their longest side triangles may still be turned against the surface by half of the crease
/// angle.
const LOW: f64 = 0.2;

/// Largest number of slivers beside each other; more are a strip of a round part, and turned as that
/// is.
const SLIVERS: usize = 4;

/// Faces beside a sliver lie in one surface with it if they are turned against each other, and against that surface, by
/// less than 45°, or half more than the crease angle where that is less: they may be turned a little themselves, where
/// a triangulation has slivers.
const BESIDE: f64 = std::f64::consts::FRAC_PI_4;

/// A sliver reaches out of its surface by at most this many times what its longest side does, which is a
/// chord.
const SAGITTAS: f64 = 3.0;

/// The part of a sliver's turn that faces beside it are turned by at most: else it is no more turned than they are.
const AS_MUCH: f64 = 0.8;

/// Ratio of the bends of a round part at two sides of a facet. Triangulations are irregular, and springs bend that much
/// more around their wire than along it.
pub(super) const UNEVEN: f64 = 8.0;

/// Largest number of triangles in a facet of a round part: two for a quadrilateral, and as many beside.
const FACET: usize = 4;

/// Vertices per job.
const JOB: usize = 1 << 13;

/// Vertices of more triangles are hubs, and not round: all pairs of them are too many to examine.
const HUB: usize = 256;

/// Returns twice the area of a triangle along its normal, and whether it is a sliver.
pub(super) fn direction(corners: [DVec3; 3]) -> (DVec3, bool) {
    let (across, lowness) = lowness(corners);
    (across, lowness < SLIVER)
}

/// Returns twice the area of a triangle along its normal, and its height as a part of its longest
/// side.
fn lowness([a, b, c]: [DVec3; 3]) -> (DVec3, f64) {
    let across = (b - a).cross(c - a);
    let longest = a.distance_squared(b).max(b.distance_squared(c)).max(c.distance_squared(a));
    (across, across.length() / longest)
}

/// The directions of faces, slivers as the surface goes.
pub(super) struct Directions<'a> {
    faces: &'a Faces,
    edges: &'a Edges,
    planes: &'a Planes,
    /// The cosine of the crease angle, of a half and a quarter of it, and of what faces beside a sliver may be turned
    /// by.
    crease: f64,
    half: f64,
    quarter: f64,
    beside: f64,
    /// The slivers that are turned against the surface that they lie in, with its normal, in item order.
    pub turned: Vec<(u32, DVec3)>,
    /// True for each item that is among them; empty if none is.
    is_turned: Vec<bool>,
}

impl<'a> Directions<'a> {
    /// Finds the directions of faces; `crease` is the crease angle in radians; `items` are the triangles to look for
    /// slivers among, in order.
    pub fn new(
        (faces, edges): (&'a Faces, &'a Edges),
        planes: &'a Planes,
        crease: f64,
        items: &[u32],
    ) -> Self {
        let mut around = vec![DVec3::ZERO; faces.points().len()];
        let mut slivers = Vec::new();
        for &item in items {
            let (Some(t), Some(corners)) = (faces.triangle(item), faces.corners(item)) else {
                continue;
            };
            let (across, lowness) = lowness(corners);
            t.iter().for_each(|v| around[*v as usize] += across);
            if lowness < LOW {
                slivers.push(item);
            }
        }
        let beside = libm::cos(crease.max(BESIDE.min(crease * 1.5)));
        let [crease, half, quarter] = [1.0, 0.5, 0.25].map(|part| libm::cos(crease * part));
        let (turned, is_turned) = (Vec::new(), Vec::new());
        let mut found =
            Self { faces, edges, planes, crease, half, quarter, beside, turned, is_turned };
        let of_surface = |item| Some((item, found.of_surface(item, &around)?));
        found.turned = slivers.into_iter().filter_map(of_surface).collect();
        if !found.turned.is_empty() {
            found.is_turned = vec![false; faces.len()];
            found.turned.iter().for_each(|t| found.is_turned[t.0 as usize] = true);
        }
        found
    }

    /// Returns the unit normal of a triangle, or of the surface that it lies in; zero if there is
    /// none.
    pub fn of(&self, item: u32) -> DVec3 {
        if self.is_turned.get(item as usize) == Some(&true)
            && let Ok(i) = self.turned.binary_search_by_key(&item, |t| t.0)
        {
            return self.turned[i].1;
        }
        self.planes.normal(item)
    }

    /// Returns the direction of the surface at a sliver that lies in it but is turned against the faces
    /// beside it. `around` has the sum of the faces around each vertex.
    fn of_surface(&self, item: u32, around: &[DVec3]) -> Option<DVec3> {
        let [_, second, first] = self.sides_by_length(item)?;
        let ends = first.map(|v| around[v as usize].normalize_or_zero());
        let surface = (ends[0] + ends[1]).try_normalize()?;
        let across = self.planes.across(item);
        let own = across.try_normalize()?;
        if own.dot(surface) >= self.half {
            return None;
        }
        let beside = |ends| {
            let corners = self.faces.corners(self.beyond_slivers(item, ends)?)?;
            direction(corners).0.try_normalize()
        };
        let (a, b) = (beside(first)?, beside(second)?);
        if [a.dot(b), a.dot(surface), b.dot(surface)].into_iter().any(|c| c < self.beside) {
            return None;
        }
        let turned = a.distance(surface).max(b.distance(surface));
        // A riser between two treads is not a part of them: these do not bend.
        let [p, q] = first.map(|v| self.faces.points()[v as usize]);
        let sagitta = (q - p).dot(ends[1] - ends[0]).abs() / 8.0;
        let aside = across.cross(surface).length() / p.distance(q);
        (turned <= AS_MUCH * own.distance(surface) && aside <= SAGITTAS * sagitta)
            .then_some(surface)
    }

    /// Returns the sides of a triangle, the shortest first.
    fn sides_by_length(&self, item: u32) -> Option<[[u32; 2]; 3]> {
        let mut sides = sides(self.faces.triangle(item)?);
        let points = self.faces.points();
        let length = |[a, b]: &[u32; 2]| points[*a as usize].distance_squared(points[*b as usize]);
        sides.sort_by(|a, b| length(a).total_cmp(&length(b)));
        Some(sides)
    }

    /// Returns the triangle at the other side of an edge, or where that is a sliver too, the one beyond it,
    /// and so on.
    fn beyond_slivers(&self, mut item: u32, mut ends: [u32; 2]) -> Option<u32> {
        for _ in 0..SLIVERS {
            item = self.edges.across(ends, item)?;
            if !direction(self.faces.corners(item)?).1 {
                return Some(item);
            }
            let [_, second, first] = self.sides_by_length(item)?;
            ends = if same_edge(first, ends) { second } else { first };
        }
        None
    }

    /// Returns whether the surface is not round at an edge between two triangles.
    fn is_sharp(&self, ends: [u32; 2], a: u32, b: u32) -> bool {
        let cosine = self.of(a).dot(self.of(b));
        // A bend of less than half the crease angle moves an outline by little.
        if 2.0 * cosine * cosine - 1.0 >= self.crease || cosine < self.crease {
            return cosine < self.crease;
        }
        !self.is_round(ends, [a, b])
    }

    /// Returns whether the surface is round at an edge between two triangles: it bends again beyond
    /// one of them.
    pub fn is_round(&self, ends: [u32; 2], items: [u32; 2]) -> bool {
        let least = self.bend(ends, items) / (UNEVEN * UNEVEN);
        items.into_iter().any(|item| self.is_facet(ends, item, least))
    }

    /// Returns half the square of the curvature at an edge between two triangles: of the angle over their
    /// mean height.
    fn bend(&self, ends: [u32; 2], items: [u32; 2]) -> f64 {
        let height = (self.height(ends, items[0]) + self.height(ends, items[1])) / 2.0;
        (1.0 - self.of(items[0]).dot(self.of(items[1]))) / (height * height)
    }

    /// Returns whether the flat face that a triangle is a part of bends again, straight across from the edge `ends`, as
    /// facets of round parts do, by at least `least`. Its turns at other sides do not count: a cylinder is round, and
    /// the rim where it meets a cone is not.
    fn is_facet(&self, ends: [u32; 2], item: u32, least: f64) -> bool {
        let next = self.next_bend(ends, item).1;
        next.is_some_and(|curvature| curvature * curvature >= 2.0 * least)
    }

    /// Returns the width of the flat face that a triangle is a part of, straight across from the edge `ends`, as far as
    /// that is followed, and the bend of the surface in that direction at its other end: the turn over the mean width
    /// of the faces there, if it is round; above 0 where it is convex.
    pub fn next_bend(&self, ends: [u32; 2], item: u32) -> (f64, Option<f64>) {
        self.next_turn(ends, item, FLAT)
    }

    /// Returns whether the surface continues to bend at both sides of an edge between two
    /// triangles, by half of its turn there.
    pub fn bends_on(&self, ends: [u32; 2], items: [u32; 2]) -> bool {
        let cosine = self.of(items[0]).dot(self.of(items[1]));
        // cos(a / 2).
        let half = ((1.0 + cosine.max(-1.0)) / 2.0).sqrt();
        items.into_iter().all(|item| self.next_turn(ends, item, half).1.is_some())
    }

    /// Returns the same as [`Self::next_bend`] as far as faces are turned by less than an angle, which is
    /// given by its cosine.
    fn next_turn(&self, mut ends: [u32; 2], mut item: u32, until: f64) -> (f64, Option<f64>) {
        let [p, q] = ends.map(|v| self.faces.points()[v as usize]);
        let own = self.of(item);
        let (mut at, mut far) = ((p + q) / 2.0, 0.0);
        let along = own.cross(q - p).normalize_or_zero();
        for _ in 0..FACET {
            let Some((side, exit)) = self.walk(item, ends, at, along) else { return (far, None) };
            far += at.distance(exit);
            let Some(beside) = self.edges.across(side, item) else { return (far, None) };
            let cosine = own.dot(self.of(beside));
            if cosine < until {
                let width = (far + self.height(side, beside)) / 2.0;
                let turn = self.of(beside).dot(along) * (exit - at).dot(along).signum();
                return (far, (cosine >= self.crease).then(|| turn / width));
            }
            (item, ends, at) = (beside, side, exit);
        }
        (far, None)
    }

    /// Finds the point and the side at which a line through a point of one side of a triangle leaves
    /// it.
    fn walk(
        &self,
        item: u32,
        ends: [u32; 2],
        at: DVec3,
        along: DVec3,
    ) -> Option<([u32; 2], DVec3)> {
        let apex = self.faces.triangle(item)?.into_iter().find(|v| !ends.contains(v))?;
        let place = |v: u32| self.faces.points()[v as usize];
        let beside = self.of(item).cross(along);
        let offset = |v: u32| (place(v) - at).dot(beside);
        let end = ends.into_iter().find(|v| (offset(*v) > 0.0) != (offset(apex) > 0.0))?;
        let part = offset(apex) / (offset(apex) - offset(end));
        Some(([apex, end], place(apex) + (place(end) - place(apex)) * part))
    }

    /// Returns the height of a triangle over one of its sides.
    fn height(&self, [a, b]: [u32; 2], item: u32) -> f64 {
        let length = self.faces.points()[a as usize].distance(self.faces.points()[b as usize]);
        self.planes.area(item) / length
    }
}

fn sides([a, b, c]: [u32; 3]) -> [[u32; 2]; 3] {
    [[a, b], [b, c], [c, a]]
}

fn same_edge(a: [u32; 2], b: [u32; 2]) -> bool {
    a == b || a == [b[1], b[0]]
}

/// A triangle as it lies around one of its vertices.
#[derive(Clone, Copy)]
pub(super) struct Around {
    pub item: u32,
    /// Index of its corner.
    pub corner: u8,
    vertex: u32,
    /// The other two vertices.
    others: [u32; 2],
    /// Its unit normal; zero if it has none.
    direction: DVec3,
    weight: f64,
}

impl Around {
    /// Creates a triangle around one of its corners.
    fn of(faces: &Faces, directions: &Directions<'_>, item: u32, k: usize) -> Option<Self> {
        let (t, places) = (faces.triangle(item)?, faces.corners(item)?);
        let [p, q, r] = [0, 1, 2].map(|i| places[(k + i) % 3]);
        let area = directions.planes.area(item);
        let weight = area * libm::atan2(area, (q - p).dot(r - p));
        let others = [t[(k + 1) % 3], t[(k + 2) % 3]];
        let direction = directions.of(item);
        Some(Self { item, corner: k as u8, vertex: t[k], others, direction, weight })
    }
}

/// Returns the normals of the corners of triangles that are `wanted`, by item and corner, in no particular order. All
/// vertices of those triangles are `requested`; `items` are in order.
pub(super) fn normals(
    directions: &Directions<'_>,
    items: &[u32],
    requested: &[bool],
    wanted: impl Fn(u32) -> bool + Sync + Send,
) -> Vec<Vec<(u32, u8, DVec3)>> {
    let corners = || {
        let triangles =
            items.iter().filter_map(|item| Some((*item, directions.faces.triangle(*item)?)));
        let all = triangles.flat_map(|(item, t)| (0..3).map(move |k| (item, k, t[k])));
        all.filter(|(_, _, v)| requested[*v as usize]).map(|(item, k, v)| (item, k as u8, v))
    };
    // By vertex, at each in item order.
    let mut ends = vec![0_u32; requested.len() + 1];
    corners().for_each(|(_, _, v)| ends[v as usize + 1] += 1);
    let mut sum = 0;
    for end in &mut ends {
        sum += *end;
        *end = sum;
    }
    let mut sorted = vec![(0, 0_u8); sum as usize];
    for (item, k, v) in corners() {
        let start = &mut ends[v as usize];
        sorted[*start as usize] = (item, k);
        *start += 1;
    }
    let around = |c: &(u32, u8)| Around::of(directions.faces, directions, c.0, c.1.into());
    let of = |first: usize| {
        let (mut found, mut group) = (Vec::new(), Vec::new());
        let mut start = if first == 0 { 0 } else { ends[first - 1] as usize };
        for end in &ends[first..requested.len().min(first + JOB)] {
            group.clear();
            group.extend(sorted[start..*end as usize].iter().filter_map(around));
            start = *end as usize;
            if !group.is_empty() {
                averages(&group, directions, &mut |a, normal| {
                    if wanted(a.item) {
                        found.push((a.item, a.corner, normal));
                    }
                });
            }
        }
        found
    };
    parallel::map((0..requested.len()).step_by(JOB).collect(), of)
}

/// Calls `f` with the normal of each triangle around a vertex, which are in item order: one for all where it is round,
/// and each side's at an edge. At the tip of a cone only those count that are near.
fn averages(group: &[Around], directions: &Directions<'_>, f: &mut impl FnMut(&Around, DVec3)) {
    let sum = |alike: &dyn Fn(usize) -> bool| {
        let alike = group.iter().enumerate().filter(|(i, _)| alike(*i));
        alike.fold(DVec3::ZERO, |sum, (_, a)| sum + a.direction * a.weight)
    };
    let all = group.iter().fold(DVec3::ZERO, |sum, a| sum + a.direction * a.weight);
    let all = all.normalize_or_zero();
    let least = group.iter().map(|a| a.direction.dot(all)).fold(1.0, f64::min);
    // Within a quarter of the crease angle of one direction no two meet at a sharp edge.
    if least >= directions.quarter {
        return group.iter().for_each(|a| f(a, all));
    }
    if group.len() > HUB {
        return group.iter().for_each(|a| f(a, a.direction));
    }
    let parts = parts(group, directions);
    if least >= directions.crease && parts.iter().all(|p| *p == parts[0]) {
        return group.iter().for_each(|a| f(a, all));
    }
    for (a, part) in group.iter().zip(&parts) {
        let near = |b: &Around| b.direction.dot(a.direction) >= directions.crease;
        let own = sum(&|i| parts[i] == *part && near(&group[i]));
        f(a, own.normalize_or(a.direction));
    }
}

/// Returns for each triangle around a vertex the first that no sharp edge divides it from.
fn parts(group: &[Around], directions: &Directions<'_>) -> Vec<usize> {
    let mut parts: Vec<usize> = (0..group.len()).collect();
    for (i, a) in group.iter().enumerate() {
        for ends in a.others.map(|other| [a.vertex, other]) {
            let beside = directions.edges.across(ends, a.item);
            let beside = beside.and_then(|b| group.binary_search_by_key(&b, |a| a.item).ok());
            // Each edge once.
            let Some(k) = beside.filter(|k| *k > i && parts[*k] != parts[i]) else { continue };
            if !directions.is_sharp(ends, a.item, group[k].item) {
                let (first, last) = (parts[i].min(parts[k]), parts[i].max(parts[k]));
                parts.iter_mut().filter(|p| **p == last).for_each(|p| *p = first);
            }
        }
    }
    parts
}
