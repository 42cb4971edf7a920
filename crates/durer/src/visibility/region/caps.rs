//! The visible parts of a section's caps, without solving the rest of the picture.
//!
//! After a section, everything is on one side of each of its planes. So nothing hides a cap seen from the removed side,
//! and every face that overlaps a cap in the picture hides it if the cap is seen from the other side: its visible part
//! is its polygon minus the union of all other faces. Only the outline of that union is needed: where two faces share a
//! side in the picture and are on different sides of it, the side cancels, and the rest has the same winding numbers.
//! O(n log n) for n faces, and an overlay of the outlines.

use super::Options;
use super::paint::colors;
use super::planar_map::faces::{Face, Frame, Place, Projector, float, surfaces};
use super::shadow::{LIT, World};
use crate::Result;
use crate::clip::polygon::overlay::{self, overlay};
use crate::clip::polygon::{BooleanOp, Shapes, WindingRule};
use crate::math::{Plane, Rect};
use crate::scene::Scene;
use crate::shade::PreparedLights;
use crate::target::drawing::{Drawing, Region, RegionKind};
use crate::trace::NoTrace;
use crate::view::View;
use crate::visibility::surface::setup::Run;

/// Returns the visible parts of a section's caps ([`Options::cap_material`]) alone, disjoint, each connected part of an
/// instance's a region of kind [`RegionKind::Cap`]; parts common to several instances belong to the first. Of the
/// options only the material and the culling are used.
///
/// The scene must be a result of [`crate::view::section::cut`]: caps with faces on both of their sides are not
/// distinguished from others.
///
/// # Errors
/// As [`super::draw`].
pub fn draw_caps(
    scene: &Scene,
    view: &View,
    lights: &PreparedLights,
    options: &Options,
) -> Result<Drawing> {
    scene.check()?;
    let frame = Frame::new(view);
    let half = frame.half() * frame.unit;
    let drawing = Drawing { window: Rect::new(-half, half).ok(), ..Drawing::default() };
    let Some(material) = options.cap_material else { return Ok(drawing) };
    let (caps, others): (Vec<_>, Vec<_>) =
        surfaces(scene)?.into_iter().partition(|run| run.material == Some(material));
    let mut projector = Projector::new(scene, view, &frame, options.cull);
    let world = World::new(scene)?;
    let caps: Vec<Cap> = caps
        .iter()
        .filter_map(|run| {
            let mut faces = Vec::new();
            projector.project(run, |face| faces.push(face));
            Cap::new(&world, run, view, faces)
        })
        .collect();
    let Some(first) = caps.first() else { return Ok(drawing) };
    let color = colors(scene, view, lights, &[(first.faces[0].item, LIT)]).first().copied();
    let mut sides = Vec::new();
    if let Some(around) = Bounds::of(caps.iter().filter(|c| c.from_within).flat_map(|c| &c.faces)) {
        let mut add = |face: Face| {
            if around.overlaps(&face) {
                sides.extend(face.sides());
            }
        };
        others.iter().for_each(|run| projector.project(run, &mut add));
    }
    let before = outlines(sides);
    let color = color.unwrap_or_default();
    let mut regions = Vec::new();
    for (instance, visible) in by_part(&caps, &before)? {
        regions.extend(visible.polygons().map(|polygon| {
            let plane_units = |ring: &[_]| ring.iter().map(|p| *p * frame.unit).collect();
            let rings = polygon.rings().map(plane_units).collect();
            let part = u32::try_from(instance).ok();
            Region { kind: RegionKind::Cap, rings, color, item: None, part }
        }));
    }
    Ok(Drawing { regions, ..drawing })
}

/// Returns the visible parts of each instance's caps. If bodies overlap, their caps do, too: the common part
/// belongs to the first.
fn by_part(caps: &[Cap], before: &Shapes) -> Result<Vec<(usize, Shapes)>> {
    let mut parts: Vec<(usize, Shapes)> = Vec::new();
    let mut taken: Vec<(Rect, Shapes)> = Vec::new();
    for part in caps.chunk_by(|a, b| a.instance == b.instance) {
        let mut visible = Shapes::new();
        for cap in part {
            let others = caps.iter().filter(|other| !std::ptr::eq(*other, cap));
            visible.append(&cap.visible(before, others)?);
        }
        let Some(bounds) = Rect::around(visible.points().iter().copied()) else { continue };
        let mut common = Shapes::new();
        let overlapping = taken.iter().filter(|(other, _)| other.overlaps(&bounds));
        overlapping.for_each(|(_, shapes)| common.append(shapes));
        let own = combined(&visible, &common, BooleanOp::Difference)?;
        taken.push((bounds, own.clone()));
        parts.push((part[0].instance, own));
    }
    Ok(parts)
}

/// The caps of one mesh at one plane.
struct Cap {
    /// Index into [`Scene::instances`].
    instance: usize,
    /// At least one.
    faces: Vec<Face>,
    plane: Plane,
    /// True if it is seen from the model's side.
    from_within: bool,
}

impl Cap {
    /// Creates a cap; returns `None` if none of its faces are in the picture or none has a plane.
    fn new(world: &World<'_>, run: &Run, view: &View, faces: Vec<Face>) -> Option<Self> {
        let area = |f: &&Face| f.doubled_area();
        // The plane of the largest is the most certain.
        let plane = world.plane(faces.iter().max_by_key(area)?.item)?;
        let from_within = world.side_of_mesh(run, &plane) == world.side_of_eye(view, &plane);
        Some(Self { instance: run.instance, faces, plane, from_within })
    }

    /// Returns the part that outlines, and other caps, leave visible.
    fn visible<'a>(&self, before: &Shapes, caps: impl Iterator<Item = &'a Self>) -> Result<Shapes> {
        let own = outlines(self.faces.iter().flat_map(Face::sides).collect());
        if !self.from_within {
            return Ok(own);
        }
        let parallel = |c: &&Self| c.plane.normal.dot(self.plane.normal).abs() > PARALLEL;
        let others = caps.filter(|c| !parallel(c)).flat_map(|c| &c.faces);
        let mut before = before.clone();
        before.append(&outlines(others.flat_map(Face::sides).collect()));
        combined(&own, &before, BooleanOp::Difference)
    }
}

/// The cosine above which planes are parallel: parallel caps do not hide each other, because everything beyond either
/// plane is cut away.
const PARALLEL: f64 = 1.0 - 1e-12;

fn combined(a: &Shapes, b: &Shapes, op: BooleanOp) -> Result<Shapes> {
    // The grid of the faces.
    let rule = overlay::Options::with_rule(WindingRule::NonZero);
    let options = overlay::Options { grid: Some(1.0), drop_collinear: true, ..rule };
    Ok(overlay(a, b, op, &options, &mut NoTrace)?.shapes)
}

/// The smallest and the largest x and y of faces.
struct Bounds(Place, Place);

impl Bounds {
    fn of<'a>(faces: impl Iterator<Item = &'a Face>) -> Option<Self> {
        let join = |(lo, hi): (Place, Place), (min, max): (Place, Place)| {
            let lo = Place { x: lo.x.min(min.x), y: lo.y.min(min.y) };
            (lo, Place { x: hi.x.max(max.x), y: hi.y.max(max.y) })
        };
        faces.map(Face::bounds).reduce(join).map(|(min, max)| Self(min, max))
    }

    fn overlaps(&self, face: &Face) -> bool {
        let (min, max) = face.bounds();
        min.x <= self.1.x && self.0.x <= max.x && min.y <= self.1.y && self.0.y <= max.y
    }
}

/// Returns closed walks with the winding numbers of all faces whose sides these are.
fn outlines(sides: Vec<(Place, Place)>) -> Shapes {
    let mut sides = uncancelled(sides);
    sides.sort_unstable();
    // Those that begin at one point are taken in order: where the first of them is, the next to be taken.
    let mut next: Vec<usize> = (0..sides.len()).collect();
    let first_at = |p: Place| sides.partition_point(|s| s.0 < p);
    let mut walks = Shapes::new();
    for (index, &(start, _)) in sides.iter().enumerate() {
        let mut first = first_at(start);
        if next[first] > index {
            continue;
        }
        let mut ring = Vec::new();
        // Equally many sides begin and end at each point, so a walk returns to its start.
        while let Some(at) = next.get_mut(first) {
            let Some(&(a, b)) = sides.get(*at).filter(|s| s.0 == sides[first].0) else { break };
            *at += 1;
            ring.push(float(a));
            if b == start {
                break;
            }
            first = first_at(b);
        }
        walks.push_ring(ring);
        walks.end_polygon();
    }
    walks
}

/// Returns the sides that are not undone by others that run back.
fn uncancelled(sides: Vec<(Place, Place)>) -> Vec<(Place, Place)> {
    let mut sides: Vec<(Place, Place, bool)> =
        sides.into_iter().map(|(a, b)| (a.min(b), a.max(b), a < b)).collect();
    sides.sort_unstable();
    let mut left = Vec::new();
    for same in sides.chunk_by(|s, t| (s.0, s.1) == (t.0, t.1)) {
        let (a, b, _) = same[0];
        let forward = same.iter().filter(|s| s.2).count();
        let back = same.len() - forward;
        let side = if forward > back { (a, b) } else { (b, a) };
        left.extend(std::iter::repeat_n(side, forward.abs_diff(back)));
    }
    left
}
