//! Visible regions by a planar map: all divisions along edges of faces at once.
//!
//! The regions of K. Weiler, P. Atherton, *Hidden Surface Removal Using Polygon Area Sorting*, SIGGRAPH 1977; their own
//! method is [`crate::visibility::polygons::regions`]. Class: object space; the result does not depend on pixels. Cost:
//! O((n + k) log n) on usual scenes, for n faces and k visible pieces of edges; at worst every face lies over every
//! other, O(n²).
//!
//! The paper repeatedly divides the picture along the outline of the nearest polygon, discards the parts behind it, and
//! continues with the rest; polygons that penetrate are split. Here all divisions are made at once, in four steps, so
//! that the cost depends on the overlaps, and neighbours share their borders:
//!
//! 1. Faces are cut at the border of the picture and their corners snapped to an integer grid of 2³⁰ steps
//!    across; from then on the sides of a point are decided exactly. Depth is linear over each face.
//! 2. A grid of cells holds faces from front to back, as far as the first that covers the cell.
//! 3. Each side of a face, and each segment along which two faces penetrate, is reduced by the parts behind faces: an
//!    interval for each face in front of it. The remaining pieces divide the picture.
//! 4. The pieces are noded by snap rounding into a planar map. In each of its faces one face of the scene
//!    is in front: found at an inner point. Neighbours with one label are joined.
//!
//! An unnecessary piece does no harm, because both its sides get the same label; so pieces extend a little further than
//! needed, and equally near faces do not hide each other's sides. Among equally near faces the lower item is shown.
//! Deviations: no recursion, and polygons are triangles.
//!
//! Limits: every face hides what is behind it, whatever the alpha of its material. Corners move by up to
//! half a grid step, 2⁻³¹ of the picture.

pub(super) mod cells;
pub(super) mod edges;
pub(super) mod faces;
pub(super) mod merge;
pub(super) mod planar;

use crate::Result;
use crate::info::{Class, Coherence, Info, Occluder};
use crate::math::DVec2;
use crate::parallel;
use crate::scene::Scene;
use crate::trace::Tracer;
use crate::view::View;
use crate::visibility::surface::Cull;
use crate::work::Work;
use cells::Cells;
use faces::{Face, Frame};
use merge::{NOTHING, Patch};
use planar::Planar;

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "planar-map",
    title: "Visible regions by a planar map",
    authors: "Kevin Weiler, Peter Atherton",
    year: 1977,
    source: "Hidden Surface Removal Using Polygon Area Sorting, SIGGRAPH",
    class: Class::ObjectSpace,
    occluder: Occluder::Area,
    coherence: &[Coherence::Edge, Coherence::Face],
    cost: "O((n + k) log n) usually, O(n^2) at worst, n faces, k visible pieces of edges",
    limits: "every face is opaque; corners are snapped to 2^-30 of the picture",
    pseudocode: &[],
};

/// Options for the solver.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Options {
    /// Faces to leave out.
    pub cull: Cull,
    /// Budget of memory, and whether to go on.
    pub work: Work,
}

/// Step of the solver; plane units.
#[derive(Debug, Clone, PartialEq)]
pub enum Step {
    /// Faces are in the picture, and their sides and intersections are to divide it.
    Project {
        /// Triangles, after the cut at the picture's border.
        faces: usize,
        /// Segments.
        edges: usize,
    },
    /// A piece of an edge that nothing hides divides the picture.
    Divide {
        /// One end.
        from: DVec2,
        /// The other end.
        to: DVec2,
    },
    /// The planar map is complete.
    Map {
        /// Vertices.
        vertices: usize,
        /// Edges.
        edges: usize,
        /// Faces, with the one around everything.
        faces: usize,
    },
    /// The visible regions, face by face.
    Regions(Vec<VisibleRegion>),
}

/// Rebuilds the visible regions from the steps.
pub fn replay(steps: &[Step]) -> Vec<VisibleRegion> {
    let regions = |step: &Step| match step {
        Step::Regions(regions) => Some(regions.clone()),
        _ => None,
    };
    steps.iter().find_map(regions).unwrap_or_default()
}

/// A part of the picture that shows one surface or the background.
#[derive(Debug, Clone, PartialEq)]
pub struct VisibleRegion {
    /// The triangle that it shows, or one of several: index in scene order.
    pub item: u32,
    /// The outer ring, counter-clockwise (y up), then holes, clockwise; plane units (see
    /// [`crate::target::drawing::Drawing`]); open. A ring may touch itself in a point.
    pub rings: Vec<Vec<DVec2>>,
}

/// The picture, divided.
///
/// # Guarantees
/// A planar map: regions share their borders, point for point, without gaps.
#[derive(Debug)]
pub struct VisibleMap {
    pub(super) frame: Frame,
    pub(super) faces: Vec<Face>,
    pub(super) cells: Cells,
    pub(super) map: Planar,
    /// For each face of the map a point in it, and which of `faces` is seen there.
    pub(super) shown: Vec<Option<(DVec2, u32)>>,
}

/// Divides the picture of a scene into its visible regions.
///
/// ```
/// use durer::math::{DMat4, DVec3, Vec3};
/// use durer::scene::{Camera, Instance, Mesh, Projection, Scene};
/// use durer::trace::NoTrace;
/// use durer::view::View;
/// use durer::visibility::region::planar_map::solve;
///
/// // Two right triangles; the nearer one hides a corner of the other.
/// let positions = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [0.0, 1.0, 1.0]];
/// let mesh = Mesh { positions: positions.map(Vec3::from).to_vec(), ..Mesh::default() };
/// let instance = Instance { mesh: 0, world_from_mesh: DMat4::IDENTITY, name: String::new() };
/// let scene = Scene { meshes: vec![mesh], instances: vec![instance], ..Scene::default() };
/// let camera = Camera {
///     eye: DVec3::new(1.0, 1.0, 8.0),
///     target: DVec3::new(1.0, 1.0, 0.0),
///     up: DVec3::Y,
///     projection: Projection::Orthographic { height: 4.0 },
///     near: 1.0,
///     far: 10.0,
/// };
/// let map = solve(&scene, &View::new(camera, 100, 100)?, &Default::default(), &mut NoTrace)?;
/// let mut regions = map.regions(|item| u64::from(item));
/// regions.sort_by_key(|r| r.item);
/// let areas: Vec<f64> = regions.iter().map(|r| r.area()).collect();
/// assert_eq!(regions.iter().map(|r| r.item).collect::<Vec<_>>(), [0, 1]);
/// assert!((areas[0] - 1.5).abs() < 1e-8 && (areas[1] - 0.5).abs() < 1e-8);
/// # Ok::<(), durer::Error>(())
/// ```
///
/// # Errors
/// The errors of [`Scene::check`], and [`crate::Error::Limit`] for too many triangles.
pub fn solve(
    scene: &Scene,
    view: &View,
    options: &Options,
    t: &mut impl Tracer<Step>,
) -> Result<VisibleMap> {
    let map = divide(scene, view, options, |_, _| Vec::new(), t)?;
    t.step(|| Step::Regions(map.regions(u64::from)));
    Ok(map)
}

/// Runs the stages in their order; `more` returns further edges that divide the picture.
pub(super) fn divide(
    scene: &Scene,
    view: &View,
    options: &Options,
    more: impl Fn(&Frame, &[Face]) -> Vec<edges::Edge>,
    t: &mut impl Tracer<Step>,
) -> Result<VisibleMap> {
    scene.check()?;
    let frame = Frame::new(view);
    let mut faces = faces::project(scene, view, &frame, options.cull)?;
    faces.sort_by(|f, g| f.near.total_cmp(&g.near).then(f.item.cmp(&g.item)));
    let cells = Cells::new(&faces);
    let mut edges = edges::sides(&faces, &cells);
    edges.extend(edges::intersections(&faces, &cells));
    edges.extend(more(&frame, &faces));
    t.step(|| Step::Project { faces: faces.len(), edges: edges.len() });
    let pieces = edges::visible(&edges, &faces, &cells);
    drop(edges);
    for &(a, b) in &pieces {
        t.step(|| Step::Divide { from: frame.plane(a), to: frame.plane(b) });
    }
    let map = Planar::new(&pieces, &options.work)?;
    drop(pieces);
    let count = |map: &Planar| (map.points.len(), map.edges.len(), map.face_count);
    t.step(|| {
        let (vertices, edges, faces) = count(&map);
        Step::Map { vertices, edges, faces }
    });
    let shown = look(&map, &faces, &cells);
    Ok(VisibleMap { frame, faces, cells, map, shown })
}

/// Number of faces of the map in one task.
const TASK: usize = 1 << 13;

/// Finds the visible item in each face of the map.
fn look(map: &Planar, faces: &[Face], cells: &Cells) -> Vec<Option<(DVec2, u32)>> {
    let (starts, list) = map.borders();
    let tasks: Vec<usize> = (0..map.face_count).step_by(TASK).collect();
    let parts = parallel::map(tasks, |start| {
        let see = |face: usize| {
            let border = &list[starts[face] as usize..starts[face + 1] as usize];
            // Face 0 is the outside.
            let inside = (face > 0).then(|| map.inner_point(border)).flatten()?;
            Some((inside, cells.nearest(faces, inside)?))
        };
        (start..(start + TASK).min(map.face_count)).map(see).collect::<Vec<_>>()
    });
    parts.into_iter().flatten().collect()
}

impl VisibleMap {
    /// Returns vertices, edges, faces (with the one around everything) and connected parts of the
    /// planar map: V − E + F = 1 + C.
    pub fn counts(&self) -> [usize; 4] {
        let map = &self.map;
        let used = (0..map.points.len() as u32).filter(|&v| !map.around(v).is_empty()).count();
        [used, map.edges.len(), map.face_count, map.part_count]
    }

    /// Returns the visible regions; neighbours whose items have one key are one region.
    ///
    /// Regions are in the order of their first edges in the map: from left to right, roughly. Slivers that
    /// vanish with the vertices left out of straight lines, less than a grid step wide, are not among them.
    pub fn regions(&self, key: impl Fn(u32) -> u64) -> Vec<VisibleRegion> {
        let item = |face: u32| self.faces[face as usize].item;
        let mut keys: Vec<u64> = self.shown.iter().flatten().map(|s| key(item(s.1))).collect();
        keys.sort_unstable();
        keys.dedup();
        let rank = |k: u64| keys.binary_search(&k).unwrap_or(0) as u32;
        let label = |shown: &Option<(DVec2, u32)>| shown.map_or(NOTHING, |s| rank(key(item(s.1))));
        let labels: Vec<u32> = self.shown.iter().map(label).collect();
        let patches = merge::patches(&self.map, &labels);
        patches.list.iter().map(|patch| self.region(patch)).collect()
    }

    fn region(&self, patch: &Patch) -> VisibleRegion {
        let halves = patch.rings.iter().flatten();
        let item = halves.filter_map(|&half| self.item_beside(half)).min().unwrap_or(0);
        VisibleRegion { item, rings: self.rings(patch) }
    }

    /// Returns the item that is seen to the left of a half-edge.
    pub(super) fn item_beside(&self, half: u32) -> Option<u32> {
        let (_, face) = self.shown[self.map.face_of[half as usize] as usize]?;
        Some(self.faces[face as usize].item)
    }

    /// Returns the rings of a patch in plane units.
    pub(super) fn rings(&self, patch: &Patch) -> Vec<Vec<DVec2>> {
        let point = |&half: &u32| self.point(self.map.start(half));
        patch.rings.iter().map(|ring| ring.iter().map(point).collect()).collect()
    }

    /// Returns a vertex of the map in plane units.
    pub(super) fn point(&self, vertex: u32) -> DVec2 {
        self.frame.plane(self.map.points[vertex as usize])
    }
}

impl VisibleRegion {
    /// Returns the area in squared plane units.
    pub fn area(&self) -> f64 {
        self.rings.iter().map(|ring| crate::clip::polygon::signed_area(ring)).sum()
    }
}
