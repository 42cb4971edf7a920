//! The orientation of faces: towards the eye or away, and against each other.

use super::page::{GridPoint, Projected, orient};
use super::smooth_silhouette::Whole;
use crate::math::DVec3;
use crate::visibility::object::{Bodies, Edges, Faces};
use std::cmp::Ordering;

/// Orientation of all faces.
pub(super) struct Facing {
    /// 1 where the front is seen, −1 the back, 0 edge-on; after turning.
    turn: Vec<i8>,
    /// The same for the smooth surfaces that triangles approximate, 0 for a flat one; empty if all do.
    surface: Vec<i8>,
    /// Unit normals after turning; zero if a triangle is too thin to have one.
    normals: Vec<[f32; 3]>,
}

/// Triangles thinner than this part of the scene's extent have no normal: coordinates have 24 bits, so
/// at 2⁻²⁰ it is uncertain by some degrees.
const THIN: f64 = 1.0 / (1u64 << 20) as f64;

/// A triangle on the grid lower than this many steps is seen edge-on.
const EDGE_ON: f64 = 2.0;

/// The cosine within which the faces on both sides of a sliver are one surface: 20°.
const ONE_SURFACE: f32 = 0.94;

impl Facing {
    /// Finds how each triangle faces; normals are those of the whole triangles. Slivers lower than `tolerance`, a part
    /// of the scene's extent, that lie in a surface and are turned away from it only by rounding have no normal
    /// either.
    pub fn new(
        faces: &Faces,
        bodies: &Bodies,
        edges: &Edges,
        projected: &Projected,
        whole: Whole<'_>,
        tolerance: f64,
    ) -> Self {
        let extent = extent(faces);
        let mut found = Self::of_each(faces, bodies, projected, whole, extent * THIN);
        let in_surface =
            |item: &u32| found.lies_in_surface(faces, edges, *item, extent * tolerance);
        let slivers: Vec<u32> = (0..faces.len() as u32).filter(in_surface).collect();
        slivers.iter().for_each(|item| found.normals[*item as usize] = [0.0; 3]);
        found
    }

    fn of_each(
        faces: &Faces,
        bodies: &Bodies,
        projected: &Projected,
        whole: Whole<'_>,
        thin: f64,
    ) -> Self {
        let mut found = Self {
            turn: vec![0; faces.len()],
            surface: whole.turns().to_vec(),
            normals: vec![[0.0; 3]; faces.len()],
        };
        for (item, t) in faces.triangles() {
            let points = t.map(|v| faces.points()[v as usize]);
            let sign = if bodies.turned(item) { -1.0 } else { 1.0 };
            let i = item as usize;
            let of_whole = whole.corners(faces, item);
            let of_surface = whole.normal_at_sliver(item);
            if let Some(normal) = of_surface.or_else(|| of_whole.and_then(|w| normal(w, thin))) {
                found.normals[i] = (normal * sign).as_vec3().to_array();
            }
            found.turn[i] = match projected.corners(t) {
                Some(c) => turned_on_grid(c.map(|c| c.at)),
                None => turned_in_space(faces, item, points, projected),
            } * sign as i8;
            if let Some(surface) = found.surface.get_mut(i) {
                *surface *= sign as i8;
            }
        }
        found
    }

    /// Returns whether a triangle is lower than `tolerance`, and between two faces that are not and go on in
    /// each other, though not in it. Coordinates of a file are rounded too, often to few digits, and such a
    /// triangle may then be turned any way.
    fn lies_in_surface(&self, faces: &Faces, edges: &Edges, item: u32, tolerance: f64) -> bool {
        let is_low = |item| faces.corners(item).is_none_or(|c| normal(c, tolerance).is_none());
        let Some(t) = faces.triangle(item).filter(|_| is_low(item)) else { return false };
        let length = |[a, b]: &[u32; 2]| {
            (faces.points()[*a as usize] - faces.points()[*b as usize]).length_squared()
        };
        let mut ends = [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]];
        ends.sort_by(|a, b| length(b).total_cmp(&length(a)));
        let across = |ends| edges.across(ends, item);
        let (Some(a), Some(b)) = (across(ends[0]), across(ends[1])) else { return false };
        let cosine =
            |a, b| self.angle_cosine(&Pair { ends: ends[0], items: [a, b], against: false });
        !is_low(a) && !is_low(b) && cosine(a, b) > ONE_SURFACE && cosine(a, item) < ONE_SURFACE
    }

    /// Returns whether the front is visible; of the smooth surface, if a triangle approximates one.
    #[inline]
    pub fn front(&self, item: u32) -> bool {
        self.side(item) > 0
    }

    /// Returns the visible side: 1 the front, −1 the back, 0 none.
    #[inline]
    fn side(&self, item: u32) -> i8 {
        match self.surface.get(item as usize) {
            Some(&side) if side != 0 => side,
            _ => self.turn[item as usize],
        }
    }

    /// Returns whether triangles approximate a smooth surface at all.
    pub fn any_smooth(&self) -> bool {
        !self.surface.is_empty()
    }

    /// Returns whether it is known from a smooth surface which side is seen.
    pub fn is_smooth(&self, item: u32) -> bool {
        self.surface.get(item as usize).is_some_and(|side| *side != 0)
    }

    /// Returns whether a triangle shows another side than the smooth surface that it approximates: it lies
    /// folded over an outline.
    #[inline]
    pub fn folded(&self, item: u32) -> bool {
        let of_surface = self.surface.get(item as usize).copied().unwrap_or(0);
        of_surface * self.turn[item as usize] < 0
    }

    /// Returns whether the triangles of a pair show different sides; those seen edge-on show none. Which side
    /// of an open body is its front is arbitrary, so fronts and backs count alike.
    pub fn differ(&self, pair: &Pair) -> bool {
        let [a, b] = pair.items.map(|item| self.side(item));
        a != if pair.against { -b } else { b }
    }

    pub fn thin(&self, item: u32) -> bool {
        self.normals[item as usize] == [0.0; 3]
    }

    pub fn angle_cosine(&self, pair: &Pair) -> f32 {
        let [a, b] = pair.items.map(|item| self.normals[item as usize]);
        let cosine = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        if pair.against { -cosine } else { cosine }
    }
}

/// Two triangles at an edge.
#[derive(Clone, Copy)]
pub(super) struct Pair {
    pub ends: [u32; 2],
    pub items: [u32; 2],
    /// True if they are turned against each other. A surface with one side only, as Möbius' band, has such edges
    /// somewhere, however its triangles are turned; where is of no matter.
    pub against: bool,
}

fn extent(faces: &Faces) -> f64 {
    let bounds = crate::scene::Aabb::around(faces.points().iter().copied());
    bounds.map_or(0.0, |b| b.size().max_element())
}

fn normal([a, b, c]: [DVec3; 3], thin: f64) -> Option<DVec3> {
    let (u, v) = (b - a, c - a);
    let n = u.cross(v);
    let double_area = n.length();
    let longest = u.length_squared().max(v.length_squared()).max((c - b).length_squared()).sqrt();
    (double_area > longest * thin && double_area > 0.0 && double_area.is_finite())
        .then(|| n / double_area)
}

/// Returns the same as [`turned_on_grid`] for a triangle that is not all in front of the eye. From its sorted
/// corners, so that copies that begin elsewhere are rounded alike, and such that turn the other way are
/// opposite.
fn turned_in_space(faces: &Faces, item: u32, points: [DVec3; 3], projected: &Projected) -> i8 {
    let Some([a, b, c]) = faces.sorted_corners(item) else { return 0 };
    let towards = -(b - a).cross(c - a).dot(projected.plane.sight_at(a));
    let same_way = (0..3).any(|i| points[i] == a && points[(i + 1) % 3] == b);
    match towards.partial_cmp(&0.0) {
        Some(Ordering::Greater) if same_way => 1,
        Some(Ordering::Less) if !same_way => 1,
        Some(Ordering::Greater | Ordering::Less) => -1,
        _ => 0,
    }
}

/// Returns 1 where the points turn counter-clockwise, −1 where they turn clockwise, and 0 where the triangle is hardly
/// more than a line.
pub(super) fn turned_on_grid(c: [GridPoint; 3]) -> i8 {
    let area = orient(c[0], c[1], c[2]) as f64;
    let squared = |a: usize, b: usize| {
        let [x, y] = c[a].minus(c[b]).map(|d| d as f64);
        x * x + y * y
    };
    let longest = squared(0, 1).max(squared(1, 2)).max(squared(2, 0));
    if area * area <= longest * (EDGE_ON * EDGE_ON) {
        0
    } else if area > 0.0 {
        1
    } else {
        -1
    }
}
