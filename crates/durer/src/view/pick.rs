//! Picking: what is behind a point or a rectangle of the screen.
//!
//! A rectangle and the near and far plane bound a part of the view volume; a triangle is hit if its part within (Blinn
//! & Newell's homogeneous clipping) is not empty. A point is decided by the edge functions in homogeneous screen space
//! (M. Olano, T. Greer, *Triangle scan conversion using 2D homogeneous coordinates*, 1997), so that triangles that
//! reach behind the eye need no cutting; the function of an edge has the same absolute value in both of its triangles,
//! so no point falls between them. Lines and points, which have no area, are hit within [`REACH`] of the point. Object
//! space. Cost: O(triangles of the instances whose boxes are met).

use crate::clip::volume::{ClipVertex, Options, clip_polygon, clip_segment};
use crate::info::{Class, Coherence, Info, Occluder};
use crate::math::{DMat4, DVec2, DVec3, DVec4, Rect};
use crate::scene::{Aabb, Mesh, Scene, Topology};
use crate::sorting::CompactSort;
use crate::trace::{NoTrace, PseudocodeLine, Tracer};
use crate::view::View;
use crate::view::cull::{Containment, ConvexVolume};

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "pick",
    title: "Picking in the view volume behind a rectangle or a point",
    authors: "M. Olano, T. Greer",
    year: 1997,
    source: "Triangle scan conversion using 2D homogeneous coordinates, Graphics Hardware",
    class: Class::ObjectSpace,
    occluder: Occluder::None,
    coherence: &[Coherence::Object],
    cost: "O(t): t triangles of the instances whose boxes are hit",
    limits: "transparent surfaces are hit like opaque ones",
    pseudocode: &[
        "hits ← ∅",
        "for each object:",
        "    if its bounding box is outside of the pick volume: next object",
        "    for each triangle of the object:",
        "        if an edge function has the wrong sign at the point: next triangle",
        "        z ← depth of the triangle's plane at the point",
        "        hits ← hits ∪ {(z, object, triangle)}",
        "sort the hits by z, the nearest first",
    ],
};

/// Largest distance of a model's lines and points from a picked point, in pixels.
pub const REACH: f64 = 3.0;

/// A part of the screen, in pixels, x right and y down; pixel (0, 0) is the square from 0 to 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PickArea {
    /// All that covers a point.
    Point(DVec2),
    /// All that reaches into a rectangle. One without width or height contains nothing.
    Rect(Rect),
}

/// A triangle, a line or a point that was hit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hit {
    /// Index into [`Scene::instances`].
    pub instance: usize,
    /// Kind of primitive.
    pub topology: Topology,
    /// Index of the triangle, line or point in the instance's mesh.
    pub primitive: usize,
    /// Its place in the sequence of all triangles, as in item planes; lines and points come after all
    /// triangles.
    pub item: u32,
    /// Window depth, 0 (near plane) … 1 (far plane), of its nearest point in the area.
    pub depth: f64,
    /// Position of that point, in the world.
    pub position: DVec3,
}

/// Instance some of whose triangles, lines or points were hit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Object {
    /// Index into [`Scene::instances`].
    pub instance: usize,
    /// Its nearest triangle, line or point in the area.
    pub nearest: Hit,
    /// Number of its triangles, lines or points in the area.
    pub primitives: usize,
}

/// Step of picking.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step {
    /// The box of an instance was held against the pick volume.
    Object {
        /// Index into [`Scene::instances`].
        instance: usize,
        /// True if some of it is inside, so that its triangles, lines and points are tested.
        inside: bool,
    },
    /// A triangle, a line or a point was tested.
    Tested {
        /// Its item.
        item: u32,
        /// Its hit, if any.
        hit: Option<Hit>,
    },
    /// The hits are in order.
    Sorted {
        /// Number of hits.
        hits: usize,
    },
}

impl PseudocodeLine for Step {
    fn line(&self) -> usize {
        match self {
            Self::Object { inside: false, .. } => 3,
            Self::Object { inside: true, .. } => 4,
            Self::Tested { hit: None, .. } => 5,
            Self::Tested { hit: Some(_), .. } => 7,
            Self::Sorted { .. } => 8,
        }
    }
}

/// Returns the hits that a list of steps leads to.
pub fn replay(steps: &[Step]) -> Vec<Hit> {
    let hit = |step: &Step| if let Step::Tested { hit, .. } = *step { hit } else { None };
    let mut hits: Vec<Hit> = steps.iter().filter_map(hit).collect();
    sort(&mut hits);
    hits
}

/// Sorts hits by depth, equally near ones by item.
fn sort(hits: &mut [Hit]) {
    hits.compact_sort_by(|a, b| a.depth.total_cmp(&b.depth).then(a.item.cmp(&b.item)));
}

/// Returns the triangles, lines and points behind an area of the screen, whether others hide them or
/// not, from either side; nearest first, of equally near ones the lower item. Triangles that are seen
/// edge on under a point are not picked.
pub fn pick(scene: &Scene, view: &View, area: PickArea) -> Vec<Hit> {
    pick_traced(scene, view, area, &mut NoTrace)
}

/// Picks as [`pick`] does, with a tracer.
pub fn pick_traced(
    scene: &Scene,
    view: &View,
    area: PickArea,
    t: &mut impl Tracer<Step>,
) -> Vec<Hit> {
    let Some(around) = window(area) else { return Vec::new() };
    let pick_from_world = pick_from_screen(&around) * view.screen_from_world();
    let boxes: Vec<Option<Aabb>> = scene
        .meshes
        .iter()
        .map(|m| Aabb::around(m.positions.iter().map(|p| p.as_dvec3())))
        .collect();
    let mut hits = Vec::new();
    let mut next_item = 0;
    for (instance, mesh) in in_item_order(scene) {
        let placed = &scene.instances[instance];
        let first_item = next_item;
        next_item += mesh.material_runs().map(|(range, _)| range.len() as u32).sum::<u32>();
        let frustum =
            ConvexVolume::frustum(&(pick_from_world * placed.world_from_mesh), Default::default());
        let inside = |b: &Aabb| frustum.contains_box(b) != Containment::Outside;
        let is_inside = boxes[placed.mesh].as_ref().is_some_and(inside);
        t.step(|| Step::Object { instance, inside: is_inside });
        if !is_inside {
            continue;
        }
        let screen_from_mesh = view.screen_from_world() * placed.world_from_mesh;
        let pick_from_mesh = pick_from_world * placed.world_from_mesh;
        let primitives = mesh.material_runs().flat_map(|(range, _)| range);
        for (item, primitive) in (first_item..).zip(primitives) {
            let primitive = primitive as usize;
            let found = if mesh.topology == Topology::Triangles {
                let corners = corners(mesh, primitive);
                match area {
                    PickArea::Point(p) => at_point(&corners, &screen_from_mesh, p),
                    PickArea::Rect(_) => in_window(&corners, &pick_from_mesh),
                }
            } else {
                let ends = mesh.line_or_point(primitive);
                let ends = ends.map(|v| mesh.positions[v as usize].as_dvec3());
                match area {
                    PickArea::Point(p) => near_point(&ends, &pick_from_mesh, &screen_from_mesh, p),
                    PickArea::Rect(_) => mark_in_window(&ends, &pick_from_mesh),
                }
            };
            let hit = found.map(|(depth, position)| {
                let position = placed.world_from_mesh.transform_point3(position);
                let topology = mesh.topology;
                Hit { instance, topology, primitive, item, depth, position }
            });
            t.step(|| Step::Tested { item, hit });
            hits.extend(hit);
        }
    }
    sort(&mut hits);
    t.step(|| Step::Sorted { hits: hits.len() });
    hits
}

/// Returns the instances with their meshes in the order of items: those of triangles first.
pub(crate) fn in_item_order(scene: &Scene) -> impl Iterator<Item = (usize, &Mesh)> {
    let of = |triangles: bool| {
        let mesh = |(i, placed): (usize, &crate::scene::Instance)| (i, &scene.meshes[placed.mesh]);
        let wanted =
            move |(_, m): &(usize, &Mesh)| (m.topology == Topology::Triangles) == triangles;
        scene.instances.iter().enumerate().map(mesh).filter(wanted)
    };
    of(true).chain(of(false))
}

/// Returns the instances of hits, nearest first.
pub fn objects(hits: &[Hit]) -> Vec<Object> {
    let mut by_instance: Vec<(usize, &Hit)> = hits.iter().enumerate().collect();
    by_instance.compact_sort_by_key(|(place, hit)| (hit.instance, *place));
    let mut found: Vec<(usize, Object)> = by_instance
        .chunk_by(|a, b| a.1.instance == b.1.instance)
        .map(|same| {
            let (place, nearest) = same[0];
            let instance = nearest.instance;
            (place, Object { instance, nearest: *nearest, primitives: same.len() })
        })
        .collect();
    found.compact_sort_by_key(|(place, _)| *place);
    found.into_iter().map(|(_, object)| object).collect()
}

/// Returns the rectangle whose frustum holds everything that may be hit.
fn window(area: PickArea) -> Option<Rect> {
    match area {
        // Wide enough to be free of rounding.
        PickArea::Point(p) => Rect::new(p - DVec2::splat(REACH), p + DVec2::splat(REACH)).ok(),
        PickArea::Rect(rect) => (rect.size().x > 0.0 && rect.size().y > 0.0).then_some(rect),
    }
}

/// Returns the matrix from homogeneous screen space to the clip space of a window's own frustum.
fn pick_from_screen(window: &Rect) -> DMat4 {
    let (scale, sum) = (2.0 / window.size(), window.min() + window.max());
    let shift = -0.5 * scale * sum;
    DMat4::from_cols(
        DVec4::new(scale.x, 0.0, 0.0, 0.0),
        DVec4::new(0.0, -scale.y, 0.0, 0.0),
        DVec4::new(0.0, 0.0, 2.0, 0.0),
        DVec4::new(shift.x, -shift.y, -1.0, 1.0),
    )
}

fn corners(mesh: &Mesh, triangle: usize) -> [DVec3; 3] {
    mesh.triangle(triangle).map(|v| mesh.positions[v as usize].as_dvec3())
}

/// Returns the nearest point of a triangle's part in a frustum: its depth, and where it is in the
/// mesh.
fn in_window(corners: &[DVec3; 3], pick_from_mesh: &DMat4) -> Option<(f64, DVec3)> {
    let ring =
        corners.map(|p| ClipVertex { position: *pick_from_mesh * p.extend(1.0), attributes: p });
    let inside = clip_polygon(&ring, &Options::default(), &mut NoTrace);
    inside
        .iter()
        .map(|v| (0.5 + 0.5 * v.position.z / v.position.w, v.attributes))
        .min_by(|a, b| a.0.total_cmp(&b.0))
}

/// Returns the point of a triangle under a point of the screen: its depth, and where it is in the
/// mesh.
fn at_point(corners: &[DVec3; 3], screen_from_mesh: &DMat4, p: DVec2) -> Option<(f64, DVec3)> {
    // Counted from the point, x and y of a vertex are exact enough wherever the point is.
    let h = corners.map(|c| {
        let v = *screen_from_mesh * c.extend(1.0);
        DVec4::new(v.x - p.x * v.w, v.y - p.y * v.w, v.z, v.w)
    });
    let edge = |a: DVec4, b: DVec4| a.x * b.y - b.x * a.y;
    let edges = [edge(h[1], h[2]), edge(h[2], h[0]), edge(h[0], h[1])];
    let determinant = edges[0] * h[0].w + edges[1] * h[1].w + edges[2] * h[2].w;
    let weights = edges.map(|e| e / determinant);
    let sum = weights[0] + weights[1] + weights[2];
    // Weights that are not numbers, of a triangle without area, are not inside.
    if !(weights.iter().all(|&w| w >= 0.0) && sum > 0.0 && sum.is_finite()) {
        return None;
    }
    let depth = weights[0] * h[0].z + weights[1] * h[1].z + weights[2] * h[2].z;
    let at = corners[0] * weights[0] + corners[1] * weights[1] + corners[2] * weights[2];
    (0.0..=1.0).contains(&depth).then(|| (depth, at / sum))
}

/// Returns the nearest point of a line's part in a frustum: its depth, and where it is in the mesh.
fn mark_in_window(ends: &[DVec3; 2], pick_from_mesh: &DMat4) -> Option<(f64, DVec3)> {
    let ends =
        ends.map(|p| ClipVertex { position: *pick_from_mesh * p.extend(1.0), attributes: p });
    let inside = clip_segment(ends, &Options::default(), &mut NoTrace)?;
    let depth = |v: &ClipVertex<DVec3>| 0.5 + 0.5 * v.position.z / v.position.w;
    inside
        .iter()
        .map(|v| (depth(v), v.attributes))
        .filter(|(depth, _)| depth.is_finite())
        .min_by(|a, b| a.0.total_cmp(&b.0))
}

/// Returns the point of a line that is nearest to a point of the screen, within [`REACH`]: its depth,
/// and where it is in the mesh.
fn near_point(
    ends: &[DVec3; 2],
    pick_from_mesh: &DMat4,
    screen_from_mesh: &DMat4,
    p: DVec2,
) -> Option<(f64, DVec3)> {
    // The remaining part in the square around the point has a place on the screen.
    let ends =
        ends.map(|p| ClipVertex { position: *pick_from_mesh * p.extend(1.0), attributes: p });
    let [a, b] = clip_segment(ends, &Options::default(), &mut NoTrace)?.map(|v| v.attributes);
    let on_screen = |q: DVec3| {
        let v = *screen_from_mesh * q.extend(1.0);
        (v.truncate() / v.w, v.w)
    };
    let ((sa, wa), (sb, wb)) = (on_screen(a), on_screen(b));
    let along = (sb - sa).truncate();
    let squared = along.length_squared();
    let t = if squared > 0.0 {
        ((p - sa.truncate()).dot(along) / squared).clamp(0.0, 1.0)
    } else {
        0.0
    };
    let at = sa + (sb - sa) * t;
    // Depth is linear on the screen, places in the mesh are in 1/w.
    let weight = t * wa / ((1.0 - t) * wb + t * wa);
    let near = at.truncate().distance(p) <= REACH && (0.0..=1.0).contains(&at.z);
    near.then(|| (at.z, a + (b - a) * weight))
}
