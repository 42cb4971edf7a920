//! The faces of a scene in the plane of the picture: corners on an integer grid, depth as a plane over it.

use crate::clip::polygon::overlay::lattice::{Coord, Point, cross};
use crate::clip::volume::{self, ClipVertex, clip_polygon};
use crate::math::{DMat4, DVec2, DVec3, DVec4};
use crate::scene::{Mesh, Projection, Scene, Topology};
use crate::trace::NoTrace;
use crate::view::View;
use crate::visibility::surface::Cull;
use crate::visibility::surface::setup::{Run, runs};

/// A point of the grid: x to the right, y up, the middle of the picture at the origin.
pub type Place = Point<i32>;

/// Grid steps from the middle of the picture to the border of its longer side. With products of 64 bits
/// every predicate on the grid is exact.
pub const REACH: f64 = ((1 << 29) - 64) as f64;

/// Relative difference below which two depths are equal: the effect of a few roundings in f64.
const ROUNDING: f64 = 1e-12;

/// Factor on the errors of depths by which hidden points must be behind: an edge that, due to rounded corners, ended
/// before the next one would join separate faces.
pub const CLEARLY: f64 = 4.0;

/// Conversion between the grid, the plane of the picture and the world.
#[derive(Debug, Clone, Copy)]
pub struct Frame {
    clip_from_world: DMat4,
    /// Grid steps of half the picture's width and height.
    half: DVec2,
    /// Plane units of a grid step.
    pub unit: f64,
    /// True if lines of sight meet in the eye.
    perspective: bool,
    /// The camera.
    eye: DVec3,
    axes: [DVec3; 3],
    /// Plane units of half the picture's height, at the distance of the target.
    half_height: f64,
    distance: f64,
}

impl Frame {
    pub fn new(view: &View) -> Self {
        let (width, height) = (f64::from(view.width()), f64::from(view.height()));
        let longer = width.max(height);
        let half = DVec2::new((REACH * width / longer).floor(), (REACH * height / longer).floor());
        let camera = view.camera();
        let distance = camera.eye.distance(camera.target);
        let (perspective, half_height) = match camera.projection {
            Projection::Perspective { fov_y } => (true, libm::tan(fov_y * 0.5) * distance),
            Projection::Orthographic { height } => (false, height * 0.5),
        };
        Self {
            clip_from_world: view.clip_from_world(),
            half,
            unit: half_height / (REACH * height / longer),
            perspective,
            eye: camera.eye,
            axes: camera.axes(),
            half_height,
            distance,
        }
    }

    /// Returns a grid point in plane units.
    pub fn plane(&self, p: Place) -> DVec2 {
        DVec2::new(p.x.f64(), p.y.f64()) * self.unit
    }

    /// Returns the corners of the picture, on the grid.
    pub fn half(&self) -> DVec2 {
        self.half
    }

    /// Returns the grid coordinates and depth of a point in clip space, w > 0.
    pub fn project(&self, p: DVec4) -> (DVec2, f64) {
        let ndc = p.truncate() / p.w;
        // The quantity that is linear along a line of the picture: z, or the inverse of the distance.
        let depth = if self.perspective { -1.0 / p.w } else { ndc.z };
        let at = ndc.truncate().clamp(DVec2::NEG_ONE, DVec2::ONE) * self.half;
        (at, depth)
    }

    /// Returns the grid coordinates and depth of a point of the world; `None` behind the eye.
    pub fn project_world(&self, p: DVec3) -> Option<(DVec2, f64)> {
        let c = self.clip_from_world * p.extend(1.0);
        if !(c.w > 0.0 && c.is_finite()) {
            return None;
        }
        let depth = if self.perspective { -1.0 / c.w } else { c.z / c.w };
        Some((DVec2::new(c.x, c.y) / c.w * self.half, depth))
    }

    /// Returns the line of sight through a point of the grid: a point of it, and its direction.
    pub fn sight(&self, at: DVec2) -> (DVec3, DVec3) {
        let [right, up, back] = self.axes;
        let p = at * (self.half_height / self.half.y);
        if self.perspective {
            (self.eye, right * p.x + up * p.y - back * self.distance)
        } else {
            (self.eye + right * p.x + up * p.y, -back)
        }
    }
}

/// Depth as a linear function of the grid's coordinates; grows away from the eye.
#[derive(Debug, Clone, Copy, Default)]
pub struct DepthPlane {
    pub at: DVec2,
    pub depth: f64,
    pub slope: DVec2,
}

impl DepthPlane {
    /// Returns the plane through three grid points that are not on one line.
    fn through(p: [Place; 3], d: [f64; 3]) -> Self {
        let [a, b, c] = p.map(float);
        let (u, v, area) = (b - a, c - a, cross(p[0], p[1], p[2]) as f64);
        let (du, dv) = (d[1] - d[0], d[2] - d[0]);
        let slope = DVec2::new(du * v.y - dv * u.y, dv * u.x - du * v.x) / area;
        Self { at: a, depth: d[0], slope }
    }

    #[inline(always)]
    pub fn depth(&self, p: DVec2) -> f64 {
        self.depth + self.slope.dot(p - self.at)
    }
}

/// Returns a grid point in floating point; exact.
#[inline(always)]
pub fn float(p: Place) -> DVec2 {
    DVec2::new(f64::from(p.x), f64::from(p.y))
}

/// A triangle in the plane of the picture.
///
/// # Guarantees
/// Its corners run counter-clockwise and enclose an area; depths are finite.
#[derive(Debug, Clone, Copy)]
pub struct Face {
    pub corners: [Place; 3],
    pub plane: DepthPlane,
    /// Depths of the corners.
    pub depths: [f64; 3],
    /// The nearest and the farthest corner's depth.
    pub near: f64,
    pub far: f64,
    /// Largest error of depths over this face: its corners are up to a grid step off.
    pub error: f64,
    pub item: u32,
}

impl Face {
    fn new(mut corners: [Place; 3], mut depths: [f64; 3], item: u32) -> Option<Self> {
        let area = cross(corners[0], corners[1], corners[2]);
        if area == 0 || !depths.iter().all(|d| d.is_finite()) {
            return None;
        }
        if area < 0 {
            corners.swap(1, 2);
            depths.swap(1, 2);
        }
        let plane = DepthPlane::through(corners, depths);
        let near = depths.iter().fold(f64::INFINITY, |m, &d| m.min(d));
        let far = depths.iter().fold(f64::NEG_INFINITY, |m, &d| m.max(d));
        let steps = plane.slope.abs().element_sum().min(far - near);
        let error = steps + ROUNDING * near.abs().max(far.abs());
        plane.slope.is_finite().then_some(Self { corners, plane, depths, near, far, error, item })
    }

    /// Returns twice its area in squared grid steps; exact.
    pub fn doubled_area(&self) -> i64 {
        cross(self.corners[0], self.corners[1], self.corners[2])
    }

    /// Returns the depth over a point of the grid, clamped to the range of the corners.
    #[inline(always)]
    pub fn depth(&self, p: DVec2) -> f64 {
        self.plane.depth(p).clamp(self.near, self.far)
    }

    /// Returns the smallest and the largest x and y of its corners.
    #[inline(always)]
    pub fn bounds(&self) -> (Place, Place) {
        let [a, b, c] = self.corners;
        let min = Place { x: a.x.min(b.x).min(c.x), y: a.y.min(b.y).min(c.y) };
        let max = Place { x: a.x.max(b.x).max(c.x), y: a.y.max(b.y).max(c.y) };
        (min, max)
    }

    /// Returns whether a point is in the triangle or on its border.
    #[inline(always)]
    pub fn covers(&self, p: DVec2) -> bool {
        let [a, b, c] = self.corners.map(float);
        let left = |a: DVec2, b: DVec2| (b - a).perp_dot(p - a) >= 0.0;
        left(a, b) && left(b, c) && left(c, a)
    }

    /// Returns its sides, counter-clockwise.
    #[inline(always)]
    pub fn sides(&self) -> [(Place, Place); 3] {
        let [a, b, c] = self.corners;
        [(a, b), (b, c), (c, a)]
    }
}

/// Returns all faces that reach into the picture, cut at its border.
pub fn project(scene: &Scene, view: &View, frame: &Frame, cull: Cull) -> crate::Result<Vec<Face>> {
    let mut faces = Vec::with_capacity(scene.triangle_count().min(1 << 24) as usize);
    let mut projector = Projector::new(scene, view, frame, cull);
    for run in surfaces(scene)? {
        projector.project(&run, |face| faces.push(face));
    }
    Ok(faces)
}

/// Returns the runs of triangles, in item order.
pub fn surfaces(scene: &Scene) -> crate::Result<Vec<Run>> {
    Ok(runs(scene)?.into_iter().filter(|run| is_surface(&scene.meshes[run.mesh])).collect())
}

/// Projection of runs of triangles into the picture; consecutive runs of one instance are cheapest.
pub struct Projector<'a> {
    scene: &'a Scene,
    view: &'a View,
    frame: &'a Frame,
    cull: Cull,
    vertices: Vertices,
}

impl<'a> Projector<'a> {
    pub fn new(scene: &'a Scene, view: &'a View, frame: &'a Frame, cull: Cull) -> Self {
        Self { scene, view, frame, cull, vertices: Vertices::default() }
    }

    /// Emits the faces of a run, cut at the picture's border.
    pub fn project(&mut self, run: &Run, mut give: impl FnMut(Face)) {
        let mesh = &self.scene.meshes[run.mesh];
        let world_from_mesh = self.scene.instances[run.instance].world_from_mesh;
        let clip_from_mesh = self.view.clip_from_world() * world_from_mesh;
        self.vertices.transform(mesh, run.instance, &clip_from_mesh, self.frame);
        let mirrored = glam::DMat3::from_mat4(world_from_mesh).determinant() < 0.0;
        let culls = self.cull == Cull::Back || (self.cull == Cull::Material && run.single_sided);
        let hidden = culls.then_some(mirrored);
        for (primitive, item) in run.range.clone().zip(run.first_item..) {
            let corners = mesh.triangle(primitive as usize);
            self.vertices.face(corners, item, hidden, self.frame, &mut give);
        }
    }
}

fn is_surface(mesh: &Mesh) -> bool {
    mesh.topology == Topology::Triangles
}

/// The vertices of one instance.
#[derive(Default)]
struct Vertices {
    instance: Option<usize>,
    clip: Vec<DVec4>,
    /// On the grid, with depth; `None` if it is outside the picture.
    placed: Vec<Option<(Place, f64)>>,
}

impl Vertices {
    fn transform(&mut self, mesh: &Mesh, instance: usize, clip_from_mesh: &DMat4, frame: &Frame) {
        if self.instance == Some(instance) {
            return;
        }
        self.instance = Some(instance);
        self.clip.clear();
        self.clip.extend(mesh.positions.iter().map(|p| *clip_from_mesh * p.as_dvec3().extend(1.0)));
        let options = volume::Options::default();
        let inside = |p: &DVec4| {
            let d = volume::boundary_coordinates(*p, options.depth);
            p.w > 0.0 && d.iter().all(|&d| d >= 0.0)
        };
        self.placed.clear();
        self.placed.extend(self.clip.iter().map(|p| inside(p).then(|| snap(frame.project(*p)))));
    }

    fn face(
        &self,
        corners: [u32; 3],
        item: u32,
        hidden: Option<bool>,
        frame: &Frame,
        give: &mut impl FnMut(Face),
    ) {
        let placed = corners.map(|c| self.placed[c as usize]);
        if let [Some(a), Some(b), Some(c)] = placed {
            return push([a, b, c], item, hidden, give);
        }
        let ring = corners.map(|c| ClipVertex { position: self.clip[c as usize], attributes: () });
        let cut = clip_polygon(&ring, &volume::Options::default(), &mut NoTrace);
        let Some((first, rest)) = cut.split_first() else { return };
        let at = |v: &ClipVertex| snap(frame.project(v.position));
        for pair in rest.windows(2) {
            push([at(first), at(&pair[0]), at(&pair[1])], item, hidden, give);
        }
    }
}

/// Emits a face, unless it must face the eye and does not.
fn push(v: [(Place, f64); 3], item: u32, hidden: Option<bool>, give: &mut impl FnMut(Face)) {
    let corners = v.map(|v| v.0);
    let front = cross(corners[0], corners[1], corners[2]) > 0;
    if hidden.is_some_and(|mirrored| front == mirrored) {
        return;
    }
    if let Some(face) = Face::new(corners, v.map(|v| v.1), item) {
        give(face);
    }
}

fn snap((at, depth): (DVec2, f64)) -> (Place, f64) {
    (nearest(at), depth)
}

/// Returns the grid point nearest to a point of the picture.
pub fn nearest(at: DVec2) -> Place {
    let at = at.clamp(DVec2::splat(-REACH), DVec2::splat(REACH));
    Place::new((at.x + 0.5).floor() as i64, (at.y + 0.5).floor() as i64)
}
