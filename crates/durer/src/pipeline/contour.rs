//! The outlines with nothing behind them: the contour of everything visible.
//!
//! An outline has, on one side, the surface it bounds, and on the other the surface behind. Points on both sides are
//! looked up among the projected faces; where one is in none of them, the line is part of the contour. The places along
//! a line where that changes are found by bisection. O(m log n) as a rule for m points and n faces.

use super::runs::{Known, around, divided};
use crate::Result;
use crate::math::{DVec2, DVec3};
use crate::scene::{Camera, Scene};
use crate::target::drawing::{Drawing, Line, LineClass};
use crate::view::picture_plane::PicturePlane;

/// Distance beside a line at which depth is sampled, as a part of the drawing's size: half a pen's
/// width on A4.
const BESIDE: f64 = 1.5e-3;

/// Lines are looked beside at least so often along the drawing's size.
const LOOKS: f64 = 200.0;

/// Number of halvings that locate the place where a line changes.
const HALVINGS: usize = 12;

/// Length, as a multiple of [`BESIDE`], below which parts come from faces near their ends.
const CRUMB: f64 = 4.0;

/// Makes the visible silhouettes and borders with nothing behind them lines of [`LineClass::Contour`].
///
/// # Errors
/// The errors of [`Camera::check`].
pub fn contoured(drawing: Drawing, scene: &Scene, camera: &Camera) -> Result<Drawing> {
    let Some(size) = drawing.bounds().map(|b| b.size().max_element()) else { return Ok(drawing) };
    let plane = PicturePlane::of_camera(camera, 1.0)?;
    let seen = Seen { faces: Faces::new(faces(scene, &plane)), size };
    let mut lines = Vec::with_capacity(drawing.lines.len());
    for line in drawing.lines {
        let outline = matches!(line.class, LineClass::Silhouette | LineClass::Border);
        if !outline || !line.is_visible() {
            lines.push(line);
            continue;
        }
        let pieces = seen.pieces(&line);
        let class = |outer: bool| if outer { LineClass::Contour } else { line.class };
        let parts = divided(line.clone(), &pieces);
        lines.extend(parts.into_iter().map(|(outer, part)| Line { class: class(outer), ..part }));
    }
    Ok(Drawing { lines, ..drawing })
}

/// Returns the part of each face behind the near plane, as seen.
fn faces(scene: &Scene, plane: &PicturePlane) -> Vec<Face> {
    let mut found = Vec::new();
    for instance in &scene.instances {
        let Some(mesh) = scene.meshes.get(instance.mesh) else { continue };
        let corner = |i: u32| -> Option<DVec3> {
            let p = mesh.positions.get(i as usize)?;
            Some(instance.world_from_mesh.transform_point3(p.as_dvec3()))
        };
        for [a, b, c] in (0..mesh.triangle_count()).map(|i| mesh.triangle(i)) {
            let (Some(a), Some(b), Some(c)) = (corner(a), corner(b), corner(c)) else { continue };
            let sides = [[a, b], [b, c], [c, a]];
            let seen = sides.into_iter().filter_map(|[a, b]| plane.project_segment(a, b));
            found.extend(Face::new(&seen.flatten().collect::<Vec<_>>()));
        }
    }
    found
}

/// A convex polygon with the box around it.
struct Face {
    /// Corners, at most six; neighbours may be one.
    corners: [DVec2; 6],
    low: DVec2,
    high: DVec2,
}

impl Face {
    fn new(points: &[DVec2]) -> Option<Self> {
        let last = *points.last()?;
        let corners = std::array::from_fn(|i| points.get(i).copied().unwrap_or(last));
        let low = points.iter().fold(last, |a, p| a.min(*p));
        let high = points.iter().fold(last, |a, p| a.max(*p));
        (low.is_finite() && high.is_finite()).then_some(Self { corners, low, high })
    }

    /// Returns whether a point is within it or on its border.
    fn contains(&self, p: DVec2) -> bool {
        let next = self.corners.iter().cycle().skip(1);
        let mut sides = [false; 2];
        for (a, b) in self.corners.iter().zip(next) {
            let side = (*b - *a).perp_dot(p - *a);
            sides[0] |= side > 0.0;
            sides[1] |= side < 0.0;
        }
        // Neither: a face seen from its edge.
        sides[0] != sides[1]
    }
}

/// Faces in a tree of boxes, halved by their middles along one axis and then the other.
struct Faces {
    faces: Vec<Face>,
    /// Boxes by node; the children of node n are 2n and 2n + 1.
    boxes: Vec<(DVec2, DVec2)>,
}

/// Faces in a leaf.
const LEAF: usize = 4;

impl Faces {
    fn new(faces: Vec<Face>) -> Self {
        let nodes = 4 * (faces.len() / LEAF + 1).next_power_of_two();
        let count = faces.len();
        let mut tree = Self { faces, boxes: vec![(DVec2::MAX, DVec2::MIN); nodes] };
        tree.sort(1, 0, count, true);
        tree
    }

    /// Sorts the faces of a node; the recursion is as deep as the logarithm of the number of faces.
    fn sort(&mut self, node: usize, from: usize, to: usize, along_x: bool) {
        let part = &mut self.faces[from..to];
        let none = (DVec2::MAX, DVec2::MIN);
        self.boxes[node] = part.iter().fold(none, |b, f| (b.0.min(f.low), b.1.max(f.high)));
        if to - from <= LEAF {
            return;
        }
        let middle = (to - from) / 2;
        let key = |f: &Face| if along_x { f.low.x + f.high.x } else { f.low.y + f.high.y };
        part.select_nth_unstable_by(middle, |a, b| key(a).total_cmp(&key(b)));
        self.sort(node * 2, from, from + middle, !along_x);
        self.sort(node * 2 + 1, from + middle, to, !along_x);
    }

    /// Returns whether any of them contains a point.
    fn contain(&self, p: DVec2) -> bool {
        self.any(1, 0, self.faces.len(), p)
    }

    fn any(&self, node: usize, from: usize, to: usize, p: DVec2) -> bool {
        let (low, high) = self.boxes[node];
        if !(p.cmpge(low).all() && p.cmple(high).all()) {
            return false;
        }
        if to - from <= LEAF {
            return self.faces[from..to].iter().any(|f| f.contains(p));
        }
        let middle = from + (to - from) / 2;
        self.any(node * 2, from, middle, p) || self.any(node * 2 + 1, middle, to, p)
    }
}

/// The faces, and the size of the drawing, plane units.
struct Seen {
    faces: Faces,
    size: f64,
}

impl Seen {
    /// Returns whether a point of a line that runs along `to` has nothing behind it on one side.
    fn is_outer(&self, p: DVec2, to: DVec2) -> bool {
        let beside = to.normalize_or_zero().perp() * (BESIDE * self.size);
        !(self.faces.contain(p + beside) && self.faces.contain(p - beside))
    }

    /// Returns the pieces of a line, and whether each is part of the contour.
    fn pieces(&self, line: &Line) -> Vec<Known<bool>> {
        let points: Vec<DVec2> = around(line).collect();
        let mut pieces: Vec<Known<bool>> =
            points.windows(2).flat_map(|w| self.divide(w[0], w[1])).collect();
        let crumb = CRUMB * BESIDE * self.size;
        let mut from = 0;
        while from < pieces.len() {
            let run = pieces[from..].iter().take_while(|p| p.0 == pieces[from].0);
            let (count, length) =
                run.fold((0, 0.0), |(n, l), p| (n + 1, l + p.1[0].distance(p.1[1])));
            let to = from + count;
            let before = from.checked_sub(1).and_then(|i| pieces.get(i));
            let beside = before.or(pieces.get(to)).map(|p| p.0);
            if let (true, Some(as_beside)) = (length < crumb, beside) {
                pieces[from..to].iter_mut().for_each(|p| p.0 = as_beside);
            }
            from = to;
        }
        pieces
    }

    /// Returns a straight piece, cut where it becomes part of the contour or ceases to be.
    fn divide(&self, a: DVec2, b: DVec2) -> Vec<Known<bool>> {
        let count = ((a.distance(b) / self.size * LOOKS).ceil()).clamp(1.0, LOOKS * 4.0) as usize;
        let outer = |t: f64| self.is_outer(a.lerp(b, t), b - a);
        let look = |i: usize| (i as f64 + 0.5) / count as f64;
        let mut state = outer(look(0));
        let (mut pieces, mut start) = (Vec::new(), a);
        for i in 1..count {
            let (mut before, mut after) = (look(i - 1), look(i));
            if outer(after) == state {
                continue;
            }
            for _ in 0..HALVINGS {
                let middle = (before + after) * 0.5;
                *(if outer(middle) == state { &mut before } else { &mut after }) = middle;
            }
            let cut = a.lerp(b, after);
            pieces.push((state, [start, cut]));
            (state, start) = (!state, cut);
        }
        pieces.push((state, [start, b]));
        pieces
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{DMat4, Vec3};
    use crate::scene::{Instance, Mesh, Projection};

    fn square(low: f32, high: f32, z: f32) -> [Vec3; 6] {
        let corner = |x, y| Vec3::new(x, y, z);
        let [a, b, c, d] =
            [corner(low, low), corner(high, low), corner(high, high), corner(low, high)];
        [a, b, c, a, c, d]
    }

    #[test]
    fn outlines_before_other_things_are_not_of_the_contour() {
        // A square in front of its own upper right part.
        let positions = [square(0.0, 2.0, 1.0), square(1.0, 4.0, 0.0)].concat();
        let instance = Instance { mesh: 0, world_from_mesh: DMat4::IDENTITY, name: String::new() };
        let mesh = Mesh { positions, ..Mesh::default() };
        let scene = Scene { meshes: vec![mesh], instances: vec![instance], ..Scene::default() };
        let camera = Camera {
            eye: DVec3::new(0.0, 0.0, 10.0),
            target: DVec3::ZERO,
            up: DVec3::Y,
            projection: Projection::Orthographic { height: 10.0 },
            near: 1.0,
            far: 20.0,
        };
        let ring = [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)];
        let line = Line {
            class: LineClass::Border,
            invisibility: 0,
            points: ring.map(|(x, y)| DVec2::new(x, y)).to_vec(),
            closed: true,
        };
        let far = Line {
            points: vec![DVec2::splat(4.0), DVec2::new(4.0, 1.0)],
            closed: false,
            ..line.clone()
        };
        let drawing = Drawing { lines: vec![line, far], ..Drawing::default() };
        let found = contoured(drawing, &scene, &camera).expect("a drawing").lines;
        let of =
            |class| -> f64 { found.iter().filter(|l| l.class == class).map(Line::length).sum() };
        assert_eq!(found.len(), 3, "{found:?}");
        assert!((of(LineClass::Border) - 2.0).abs() < 1e-2, "{found:?}");
        assert!((of(LineClass::Contour) - 9.0).abs() < 1e-2, "{found:?}");
    }
}
