//! Exact shadows: the picture seen from a light, divided like the eye's, and projected back onto the faces.
//!
//! P. Atherton, K. Weiler, D. Greenberg, *Polygon Shadow Generation*, SIGGRAPH 1978. Class: object space. Cost: one
//! visible-region problem per light (six for a light among the faces). The edges that divide a face in the light's
//! picture divide it in the eye's; a region is lit if an inner point of it is. Deviation: the lit polygons are not
//! merged into the model; their borders divide the picture beside the faces' own.

use super::planar_map::cells::Cells;
use super::planar_map::edges::Edge;
use super::planar_map::faces::{Face, Frame, float, nearest};
use super::planar_map::{self as visible, VisibleMap};
use crate::Result;
use crate::clip::volume::{self, ClipVertex, clip_segment};
use crate::info::{Class, Coherence, Info, Occluder};
use crate::math::{DVec2, DVec3, Plane};
use crate::scene::{Camera, Projection, Scene};
use crate::shade::PreparedLights;
use crate::trace::NoTrace;
use crate::view::View;
use crate::visibility::surface::setup::{Run, runs};

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "shadow-polygons",
    title: "Polygon shadow generation",
    authors: "P. R. Atherton, K. Weiler, D. P. Greenberg",
    year: 1978,
    source: "Polygon shadow generation, SIGGRAPH",
    class: Class::ObjectSpace,
    occluder: Occluder::Area,
    coherence: &[Coherence::Edge, Coherence::Face],
    cost: "one visible-region problem per light, six for a light among the faces",
    limits: "hard shadows; 64 lights that cast them",
    pseudocode: &[],
};

/// Largest number of lights that cast shadows; further ones shine through everything.
pub const MOST_LIGHTS: usize = 64;

/// A light reaches everything.
pub const LIT: u64 = u64::MAX;

/// The world's triangles by item.
pub struct World<'a> {
    scene: &'a Scene,
    runs: Vec<Run>,
}

impl<'a> World<'a> {
    pub fn new(scene: &'a Scene) -> Result<Self> {
        Ok(Self { scene, runs: runs(scene)? })
    }

    /// Returns the run of an item.
    pub fn run(&self, item: u32) -> Option<&Run> {
        self.runs.get(self.runs.partition_point(|run| run.first_item <= item).checked_sub(1)?)
    }

    /// Returns whether a run's mesh is above a plane that it does not cross.
    pub fn side_of_mesh(&self, run: &Run, plane: &Plane) -> bool {
        let mesh = &self.scene.meshes[run.mesh];
        let matrix = &self.scene.instances[run.instance].world_from_mesh;
        let corners = (0..mesh.triangle_count()).flat_map(|i| mesh.triangle(i));
        let height =
            |v: u32| plane.evaluate(matrix.transform_point3(mesh.positions[v as usize].as_dvec3()));
        // The side of the farthest corner, because corners on the plane are rounded to either side.
        let farther = |a: f64, b: f64| if b.abs() > a.abs() { b } else { a };
        corners.map(height).fold(0.0, farther) > 0.0
    }

    /// Returns whether the eye is above a plane.
    pub fn side_of_eye(&self, view: &View, plane: &Plane) -> bool {
        is_above(plane, eye(view))
    }

    /// Returns the plane of an item, with a normal of unit length.
    pub fn plane(&self, item: u32) -> Option<Plane> {
        let run = self.run(item)?;
        let mesh = &self.scene.meshes[run.mesh];
        let corners = mesh.triangle((run.range.start + (item - run.first_item)) as usize);
        let matrix = &self.scene.instances[run.instance].world_from_mesh;
        let [a, b, c] =
            corners.map(|v| matrix.transform_point3(mesh.positions[v as usize].as_dvec3()));
        Plane::through(a, (b - a).cross(c - a)).normalized()
    }
}

/// Direction or position of an eye or a light.
#[derive(Debug, Clone, Copy)]
enum From {
    Direction(DVec3),
    Point(DVec3),
}

/// Returns the point or direction that a view is seen from.
fn eye(view: &View) -> From {
    let camera = view.camera();
    match camera.projection {
        Projection::Perspective { .. } => From::Point(camera.eye),
        Projection::Orthographic { .. } => From::Direction(camera.axes()[2]),
    }
}

/// Returns whether an eye or a light is above a plane.
fn is_above(plane: &Plane, from: From) -> bool {
    match from {
        From::Direction(d) => plane.normal.dot(d) > 0.0,
        From::Point(p) => plane.evaluate(p) > 0.0,
    }
}

/// A light, and the faces that it sees.
struct Lamp {
    from: From,
    /// One picture, or six around a light among the faces.
    views: Vec<VisibleMap>,
    /// For each item the error of its depth in the light's pictures.
    errors: Vec<f64>,
}

/// All lights that cast shadows.
pub struct Lamps<'a> {
    world: &'a World<'a>,
    view: View,
    eye: From,
    lamps: Vec<Lamp>,
}

impl<'a> Lamps<'a> {
    /// Solves each light's picture.
    pub fn new(
        world: &'a World<'a>,
        view: &View,
        lights: &PreparedLights,
        casts: bool,
    ) -> Result<Self> {
        let eye = eye(view);
        let mut lamps = Vec::new();
        if casts && let Some(sphere) = world.scene.bounding_sphere().filter(|s| s.radius > 0.0) {
            let directions =
                lights.directional.iter().map(|l| From::Direction(l.to_light.as_dvec3()));
            let points =
                lights.points.iter().map(|l| From::Point(l.position.as_dvec3() + lights.origin));
            for from in directions.chain(points).take(MOST_LIGHTS) {
                lamps.push(Lamp::new(world.scene, from, sphere.center, sphere.radius)?);
            }
        }
        Ok(Self { world, view: *view, eye, lamps })
    }

    /// Returns the borders of light and shadow on the faces of the eye's picture.
    pub fn edges(&self, frame: &Frame, faces: &[Face]) -> Vec<Edge> {
        if self.lamps.is_empty() {
            return Vec::new();
        }
        let errors = errors(faces, self.world.scene);
        let mut edges = Vec::new();
        for lamp in &self.lamps {
            for picture in &lamp.views {
                for edge in 0..picture.map.edges.len() {
                    for half in [2 * edge as u32, 2 * edge as u32 + 1] {
                        edges.extend(self.cast(lamp, picture, half, frame, &errors));
                    }
                }
            }
        }
        edges
    }

    /// Returns an edge of a light's picture, as it falls on the face to the left of a half-edge.
    fn cast(
        &self,
        lamp: &Lamp,
        picture: &VisibleMap,
        half: u32,
        frame: &Frame,
        errors: &[f64],
    ) -> Option<Edge> {
        let seen = |half: u32| picture.shown[picture.map.face_of[half as usize] as usize];
        let ((_, on), (_, other)) = (seen(half)?, seen(half ^ 1)?);
        let face = &picture.faces[on as usize];
        let ends =
            [half, half ^ 1].map(|h| float(picture.map.points[picture.map.start(h) as usize]));
        if face.item == picture.faces[other as usize].item || is_own(face, ends) {
            return None;
        }
        let error = *errors.get(face.item as usize).filter(|e| e.is_finite())?;
        let plane = self.world.plane(face.item)?;
        if is_above(&plane, lamp.from) != is_above(&plane, self.eye) {
            return None;
        }
        let on_face = |at: DVec2| {
            let (origin, direction) = picture.frame.sight(at);
            meet(&plane, origin, direction)
        };
        let [a, b] = ends;
        let vertex = |p: DVec3| ClipVertex {
            position: self.view.clip_from_world() * p.extend(1.0),
            attributes: (),
        };
        let segment = [vertex(on_face(a)?), vertex(on_face(b)?)];
        let [a, b] = clip_segment(segment, &volume::Options::default(), &mut NoTrace)?;
        let [(a, da), (b, db)] = [a, b].map(|v| frame.project(v.position));
        let (a, b) = (nearest(a), nearest(b));
        let (a, b, depths) = if a <= b { (a, b, [da, db]) } else { (b, a, [db, da]) };
        (a != b).then_some(Edge { a, b, depths, error })
    }

    /// Returns the lights that reach the side of an item that is seen at a point of the eye's
    /// picture: bit i for light i, directional ones first. Light that falls on the other side counts
    /// as reaching it, because shading leaves it out.
    pub fn reaching(&self, frame: &Frame, item: u32, at: DVec2) -> u64 {
        if self.lamps.is_empty() {
            return LIT;
        }
        let Some(plane) = self.world.plane(item) else { return LIT };
        let (origin, direction) = frame.sight(at);
        let Some(point) = meet(&plane, origin, direction) else { return LIT };
        let seen_above = is_above(&plane, self.eye);
        let hidden = self.lamps.iter().enumerate().filter(|(_, lamp)| {
            is_above(&plane, lamp.from) == seen_above && lamp.is_hidden(point, item)
        });
        hidden.fold(LIT, |mask, (i, _)| mask & !(1 << i))
    }
}

impl Lamp {
    fn new(scene: &Scene, from: From, center: DVec3, radius: f64) -> Result<Self> {
        let views = cameras(from, center, radius)
            .into_iter()
            .map(|camera| {
                let view = View::new(camera, 1, 1)?;
                visible::solve(scene, &view, &visible::Options::default(), &mut NoTrace)
            })
            .collect::<Result<Vec<_>>>()?;
        let mut all = vec![f64::INFINITY; scene.triangle_count() as usize];
        for view in &views {
            for (kept, error) in all.iter_mut().zip(errors(&view.faces, scene)) {
                *kept = if kept.is_finite() && error.is_finite() {
                    kept.max(error)
                } else {
                    kept.min(error)
                };
            }
        }
        Ok(Self { from, views, errors: all })
    }

    /// Returns whether another face is between the light and a point of an item.
    fn is_hidden(&self, point: DVec3, item: u32) -> bool {
        let error =
            self.errors.get(item as usize).copied().filter(|e| e.is_finite()).unwrap_or(0.0);
        let hidden = |picture: &VisibleMap| {
            let (at, depth) = picture.frame.project_world(point)?;
            let half = picture.frame.half();
            if at.x.abs() > half.x || at.y.abs() > half.y {
                return None;
            }
            Some(is_before(picture, at, depth - error, item))
        };
        self.views.iter().find_map(hidden).unwrap_or(false)
    }
}

/// Returns whether a face of another item is in front of a depth at a point.
fn is_before(picture: &VisibleMap, at: DVec2, depth: f64, item: u32) -> bool {
    let cells: &Cells = &picture.cells;
    let Some(cell) = cells.at(at) else { return false };
    let faces = cells.items(cell).iter().map(|&i| &picture.faces[i as usize]);
    faces
        .take_while(|face| face.near < depth)
        .any(|face| face.item != item && face.covers(at) && face.depth(at) + face.error < depth)
}

/// Returns the largest error of each item's depth in a picture; infinite if it has no face there.
fn errors(faces: &[Face], scene: &Scene) -> Vec<f64> {
    let mut errors = vec![f64::INFINITY; scene.triangle_count() as usize];
    for face in faces {
        if let Some(e) = errors.get_mut(face.item as usize) {
            *e = if e.is_finite() { e.max(face.error) } else { face.error };
        }
    }
    errors
}

/// Distance from a side of a face, in grid steps, below which ends count as on it.
const BESIDE: f64 = 4.0;

/// Returns whether a segment runs along a side of the face.
fn is_own(face: &Face, ends: [DVec2; 2]) -> bool {
    face.sides().into_iter().any(|(a, b)| {
        let (a, b) = (float(a), float(b));
        let reach = BESIDE * a.distance(b);
        ends.iter().all(|&p| (b - a).perp_dot(p - a).abs() <= reach)
    })
}

/// Returns the intersection of a line and a plane.
fn meet(plane: &Plane, origin: DVec3, direction: DVec3) -> Option<DVec3> {
    let t = -plane.evaluate(origin) / plane.normal.dot(direction);
    let p = origin + direction * t;
    p.is_finite().then_some(p)
}

/// Size of a light's picture relative to the scene.
const MARGIN: f64 = 1.01;

/// Lights nearer to the scene's sphere than this, in radii from its centre, look all around.
const AROUND: f64 = 1.1;

/// The nearest that a light among the faces looks, in radii of the scene.
const NEAREST: f64 = 1e-4;

/// Returns the pictures that a light needs to see the whole sphere.
fn cameras(from: From, center: DVec3, radius: f64) -> Vec<Camera> {
    let camera = |eye: DVec3, forward: DVec3, projection, near, far| {
        let up = if forward.y.abs() < 0.9 * forward.length() { DVec3::Y } else { DVec3::X };
        Camera { eye, target: eye + forward, up, projection, near, far }
    };
    match from {
        From::Direction(to_light) => {
            let eye = center + to_light * (2.0 * radius);
            let projection = Projection::Orthographic { height: 2.0 * radius * MARGIN };
            vec![camera(eye, -to_light * radius, projection, 0.5 * radius, 3.5 * radius)]
        }
        From::Point(eye) if eye.distance(center) > AROUND * radius => {
            let distance = eye.distance(center);
            let fov_y = 2.0 * libm::asin((radius / distance).min(1.0)) * MARGIN;
            let (near, far) = ((distance - radius) * 0.5, distance + 2.0 * radius);
            vec![camera(eye, center - eye, Projection::Perspective { fov_y }, near, far)]
        }
        From::Point(eye) => {
            let projection = Projection::Perspective { fov_y: std::f64::consts::FRAC_PI_2 };
            let axes = [DVec3::X, DVec3::Y, DVec3::Z];
            let (near, far) = (NEAREST * radius, 4.0 * radius);
            axes.into_iter()
                .flat_map(|axis| [axis, -axis])
                .map(|axis| camera(eye, axis * radius, projection, near, far))
                .collect()
        }
    }
}

/// Returns the lights that a mask lets through.
pub fn chosen(lights: &PreparedLights, mask: u64) -> PreparedLights {
    let mut chosen = lights.clone();
    let mut bits = (0..MOST_LIGHTS).map(|i| mask >> i & 1 == 1).chain(std::iter::repeat(true));
    chosen.directional.retain(|_| bits.next().unwrap_or(true));
    chosen.points.retain(|_| bits.next().unwrap_or(true));
    chosen
}
