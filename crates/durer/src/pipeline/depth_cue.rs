//! The nearness of a drawing's visible lines, in a few steps, for pens that distinguish near from
//! far.
//!
//! Lines run along edges, so their points are projected vertices of the model; of vertices at one place the nearest is
//! visible. Between them depth is linear in the plane of the picture, also in perspective ([`PlanePoint::depth`]).
//! Lines are divided where they cross from one step to the next. O(n log n) for n vertices.

use super::runs::{Known, around, divided};
use crate::Result;
use crate::math::DVec2;
use crate::paper::order::nearest::{Nearest, Tree};
use crate::scene::{Camera, Scene};
use crate::target::drawing::{Drawing, Line, LineClass, NEARNESS_STEPS};
use crate::view::picture_plane::{PicturePlane, PlanePoint};
use std::cmp::Ordering;

/// Vertices within this part of the drawing's size are seen at one place.
const ONE_PLACE: f64 = 1e-4;

/// Number of vertices seen at one place, except for rounding, that are examined.
const VERTICES: usize = 16;

/// Drawings whose depth is less than this part of their size have no near and far.
const FLAT: f64 = 1e-3;

/// Sets the nearness of each visible edge of a drawing ([`Drawing::nearness`]), from the nearest to the farthest point
/// of all, and divides lines where it changes. Hatching, hidden lines and flat drawings stay as they are.
///
/// # Errors
/// The errors of [`Camera::check`].
pub fn depth_cued(drawing: Drawing, scene: &Scene, camera: &Camera) -> Result<Drawing> {
    let Some(size) = drawing.bounds().map(|b| b.size().max_element()) else { return Ok(drawing) };
    let vertices = Vertices::new(scene, camera, size * ONE_PLACE)?;
    let depths: Vec<Option<Vec<f64>>> =
        drawing.lines.iter().map(|l| is_cued(l).then(|| vertices.along(l)).flatten()).collect();
    let all = || depths.iter().flatten().flatten().copied();
    let (near, far) =
        (all().fold(f64::INFINITY, f64::min), all().fold(f64::NEG_INFINITY, f64::max));
    let flat = far - near < size * FLAT;
    if flat || !(far - near).is_finite() {
        return Ok(drawing);
    }
    let steps = Steps { near, size: (far - near) / f64::from(NEARNESS_STEPS) };
    let (mut lines, mut nearness) = (Vec::new(), Vec::new());
    for (line, depths) in drawing.lines.into_iter().zip(depths) {
        let parts = match depths {
            Some(depths) => steps.divide(&line, &depths),
            None => vec![(line, None)],
        };
        for (line, step) in parts {
            lines.push(line);
            nearness.push(step);
        }
    }
    Ok(Drawing { lines, nearness, ..drawing })
}

/// Returns whether a line is along a visible edge.
fn is_cued(line: &Line) -> bool {
    let apart = matches!(
        line.class,
        LineClass::Hatch | LineClass::Shadow | LineClass::Grid | LineClass::Axis
    );
    line.is_visible() && !apart && line.points.len() > 1
}

/// The vertices of a scene as they are seen.
struct Vertices {
    seen: Vec<PlanePoint>,
    tree: Tree,
    /// Plane units.
    one_place: f64,
}

impl Vertices {
    fn new(scene: &Scene, camera: &Camera, one_place: f64) -> Result<Self> {
        let plane = PicturePlane::of_camera(camera, 1.0)?;
        let mut seen = Vec::new();
        for instance in &scene.instances {
            let Some(mesh) = scene.meshes.get(instance.mesh) else { continue };
            let world =
                |p: &crate::math::Vec3| instance.world_from_mesh.transform_point3(p.as_dvec3());
            let ahead = mesh.positions.iter().map(world).filter(|p| plane.is_behind_near(*p));
            let points = ahead.map(|p| plane.plane_from_world(p));
            seen.extend(points.filter(|p| p.at.is_finite() && p.depth.is_finite()));
        }
        // Readers repeat vertices, and of those at one place the nearest counts.
        let key = |p: &PlanePoint| [p.at.x, p.at.y, p.depth];
        let order = |a: &[f64; 3], b: &[f64; 3]| {
            let parts = a.iter().zip(b).map(|(a, b)| a.total_cmp(b));
            parts.fold(Ordering::Equal, Ordering::then)
        };
        seen.sort_unstable_by(|a, b| order(&key(a), &key(b)));
        seen.dedup_by(|next, kept| next.at == kept.at);
        let tree = Tree::new(seen.iter().map(|p| p.at));
        Ok(Self { seen, tree, one_place })
    }

    /// Returns the depths at the points of a line; `None` if there are no vertices.
    fn along(&self, line: &Line) -> Option<Vec<f64>> {
        let mut nearest = Nearest::new(VERTICES);
        let mut at = |p: &DVec2| {
            self.tree.nearest(*p, &mut nearest, |_| true);
            let here = nearest.list.iter().filter(|n| n.0 <= self.one_place * self.one_place);
            here.map(|n| self.seen[n.1 as usize].depth).reduce(f64::min)
        };
        let known: Vec<Option<f64>> = line.points.iter().map(&mut at).collect();
        if known.iter().any(Option::is_some) {
            return Some(between(&line.points, &known));
        }
        // The outline of a round part may run between vertices: those beside it are nearly as near.
        self.tree.nearest(*line.points.first()?, &mut nearest, |_| true);
        let beside = self.seen[nearest.list.first()?.1 as usize].depth;
        Some(vec![beside; line.points.len()])
    }
}

/// Interpolates the depths of all points from those that are known: linearly between them, before the first and after
/// the last equal to the nearest.
fn between(points: &[DVec2], known: &[Option<f64>]) -> Vec<f64> {
    let mut depths: Vec<f64> = Vec::with_capacity(points.len());
    let mut last: Option<(usize, f64)> = None;
    for (i, depth) in known.iter().enumerate() {
        let Some(depth) = *depth else { continue };
        let start = last.map_or(0, |(j, _)| j + 1);
        let (from, before) = last.unwrap_or((start, depth));
        let whole = length(&points[from..=i]);
        for k in start..i {
            let share = if whole > 0.0 { length(&points[from..=k]) / whole } else { 0.0 };
            depths.push(before + (depth - before) * share);
        }
        depths.push(depth);
        last = Some((i, depth));
    }
    depths.resize(points.len(), last.map_or(0.0, |l| l.1));
    depths
}

fn length(points: &[DVec2]) -> f64 {
    points.windows(2).map(|w| w[0].distance(w[1])).sum()
}

/// Steps of one size in depth, from the nearest point on.
struct Steps {
    near: f64,
    size: f64,
}

impl Steps {
    fn of(&self, depth: f64) -> u8 {
        // A cast saturates.
        (((depth - self.near) / self.size) as u8).min(NEARNESS_STEPS - 1)
    }

    /// Returns a line in parts that are in one step each.
    fn divide(&self, line: &Line, depths: &[f64]) -> Vec<(Line, Option<u8>)> {
        let depth = depths.iter().chain(depths.first()).copied();
        let points: Vec<(DVec2, f64)> = around(line).zip(depth).collect();
        let pieces: Vec<Known<u8>> =
            points.windows(2).flat_map(|w| self.pieces(w[0], w[1])).collect();
        let parts = divided(line.clone(), &pieces);
        parts.into_iter().map(|(step, part)| (part, Some(step))).collect()
    }

    /// Returns a straight piece, cut where it comes from one step to the next.
    fn pieces(&self, from: (DVec2, f64), to: (DVec2, f64)) -> Vec<Known<u8>> {
        let (a, b) = (self.of(from.1), self.of(to.1));
        let border = |step: u8| self.near + f64::from(step) * self.size;
        let share = |step: u8| ((border(step) - from.1) / (to.1 - from.1)).clamp(0.0, 1.0);
        let mut shares: Vec<f64> = (a.min(b)..a.max(b)).map(|step| share(step + 1)).collect();
        if a > b {
            shares.reverse();
        }
        let cuts: Vec<DVec2> = shares.into_iter().map(|s| from.0.lerp(to.0, s)).collect();
        let ends: Vec<DVec2> = [from.0].into_iter().chain(cuts).chain([to.0]).collect();
        let step = |i: usize| if a > b { a - i as u8 } else { a + i as u8 };
        let piece = |(i, w): (usize, &[DVec2])| (step(i), [w[0], w[1]]);
        ends.windows(2).enumerate().map(piece).filter(|p| p.1[0] != p.1[1]).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(points: &[(f64, f64)], closed: bool) -> Line {
        let points = points.iter().map(|&(x, y)| DVec2::new(x, y)).collect();
        Line { class: LineClass::Crease, invisibility: 0, points, closed }
    }

    #[test]
    fn lines_are_divided_where_they_come_to_the_next_step() {
        let steps = Steps { near: 0.0, size: 1.0 };
        let found = steps.divide(&line(&[(0.0, 0.0), (40.0, 0.0)], false), &[0.0, 4.0]);
        let parts: Vec<(f64, f64, Option<u8>)> =
            found.iter().map(|(l, step)| (l.points[0].x, l.points[1].x, *step)).collect();
        let expected = [(0.0, 10.0, 0), (10.0, 20.0, 1), (20.0, 30.0, 2), (30.0, 40.0, 3)];
        assert_eq!(parts, expected.map(|(a, b, step)| (a, b, Some(step))));
        let found = steps.divide(&line(&[(0.0, 0.0), (40.0, 0.0)], false), &[2.5, 0.5]);
        let parts: Vec<(f64, Option<u8>)> =
            found.iter().map(|(l, s)| (l.points[0].x, *s)).collect();
        assert_eq!(parts, [(0.0, Some(2)), (10.0, Some(1)), (30.0, Some(0))]);
        // A square that leans back: its near side is one part, although the line starts in its middle.
        let square = line(&[(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)], true);
        let found = steps.divide(&square, &[0.0, 0.0, 2.0, 2.0]);
        assert_eq!(found.iter().map(|f| f.1).collect::<Vec<_>>(), [1, 2, 1, 0].map(Some));
        assert_eq!(found[3].0, line(&[(0.0, 2.0), (0.0, 0.0), (4.0, 0.0), (4.0, 2.0)], false));
        assert_eq!(steps.divide(&square, &[0.5; 4]), [(square.clone(), Some(0))]);
    }

    #[test]
    fn of_vertices_seen_at_one_place_the_nearest_counts() {
        use crate::math::{DMat4, DVec3, Vec3};
        use crate::scene::{Instance, Mesh, Projection};
        let far = std::iter::repeat_n(Vec3::new(1.0, 0.0, -5.0), 40);
        let near = [Vec3::new(1.0, 1e-6, 2.0), Vec3::new(3.0, 0.0, -1.0)];
        let mesh = Mesh { positions: far.chain(near).collect(), ..Mesh::default() };
        let instance = Instance { mesh: 0, world_from_mesh: DMat4::IDENTITY, name: String::new() };
        let scene = Scene { meshes: vec![mesh], instances: vec![instance], ..Scene::default() };
        let camera = Camera {
            eye: DVec3::new(0.0, 0.0, 10.0),
            target: DVec3::ZERO,
            up: DVec3::Y,
            projection: Projection::Orthographic { height: 8.0 },
            near: 1.0,
            far: 20.0,
        };
        let vertices = Vertices::new(&scene, &camera, 1e-4).expect("a camera");
        let found = vertices.along(&line(&[(1.0, 0.0), (2.0, 0.0), (3.0, 0.0)], false));
        assert_eq!(found, Some(vec![-2.0, -0.5, 1.0]));
    }

    #[test]
    fn unknown_depths_lie_between_known_ones() {
        let points: Vec<DVec2> = [0.0, 1.0, 3.0, 4.0, 9.0].map(|x| DVec2::new(x, 0.0)).to_vec();
        let known = [None, Some(1.0), None, Some(4.0), None];
        assert_eq!(between(&points, &known), [1.0, 1.0, 3.0, 4.0, 4.0]);
    }
}
