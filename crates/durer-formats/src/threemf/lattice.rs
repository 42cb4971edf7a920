//! Beam lattices as triangles: beams as prisms with many sides, round ends and joints as balls.
//!
//! Source: 3MF Consortium, *Beam Lattice Extension* 1.2.0, 2021.
//!
//! A round end is a whole ball at the end of the beam, shared by all beams of its radius there. The corners and normals
//! are those of the true surface. The number of sides decreases with the number of beams.

use super::property::Properties;
use crate::{Error, Result};
use durer::math::{DVec3, Vec4};
use durer::scene::Mesh;
use std::collections::BTreeMap;

/// Beams and balls over the vertices of an object.
#[derive(Debug, Default)]
pub(super) struct Lattice {
    pub radius: f64,
    /// Length below which beams are ignored.
    pub shortest: f64,
    /// True if ends are flat unless a beam specifies otherwise.
    pub butt: bool,
    pub ball_radius: f64,
    /// True if all ends have a ball.
    pub all_balls: bool,
    /// The id of an object to be shown instead.
    pub shown_by: Option<u64>,
    pub property: Option<(u64, u64)>,
    pub beams: Vec<Beam>,
    pub balls: Vec<Ball>,
}

/// A cone or cylinder between two vertices.
#[derive(Debug)]
pub(super) struct Beam {
    pub ends: [u32; 2],
    pub radii: [f64; 2],
    /// True for each end that is flat.
    pub butts: [bool; 2],
    /// A group and the property at each end.
    pub property: Option<(u64, [u64; 2])>,
}

/// A ball around a vertex.
#[derive(Debug)]
pub(super) struct Ball {
    pub center: u32,
    pub radius: f64,
}

/// Returns the number of sides of a prism, by the number of beams.
fn sides(beams: usize) -> usize {
    match beams {
        0..=20_000 => 12,
        20_001..=200_000 => 8,
        _ => 6,
    }
}

/// Makes a lattice's mesh, relative to `origin`; at most `limit` triangles.
///
/// `color` is used for beams without their own.
///
/// # Errors
/// [`Error::Limit`].
pub(super) fn mesh(
    lattice: &Lattice,
    vertices: &[DVec3],
    origin: DVec3,
    (properties, color): (&Properties, Vec4),
    limit: u64,
) -> Result<Mesh> {
    let sides = sides(lattice.beams.len());
    let point = |v: u32| vertices.get(v as usize).map_or(DVec3::ZERO, |p| *p - origin);
    let seen = |b: &&Beam| {
        let length = point(b.ends[0]).distance(point(b.ends[1]));
        length > 0.0 && length >= lattice.shortest && b.radii.iter().all(|r| *r > 0.0)
    };
    let balls = balls(lattice, seen);
    let beams = lattice.beams.iter().filter(seen).count() as u64;
    let value = beams * (4 * sides as u64 - 4) + balls.len() as u64 * ball_triangles(sides);
    let limit = limit.min(u64::from(u32::MAX / 4));
    if value > limit {
        let place = crate::Place::Whole;
        return Err(Error::Limit {
            place,
            what: "number of triangles of a beam lattice",
            value,
            limit,
        });
    }
    let mut builder = Builder::new(sides);
    for beam in lattice.beams.iter().filter(seen) {
        let look = |i: usize| {
            let own = beam.property.and_then(|(group, p)| properties.look(group, p[i]));
            own.map_or(color, |look| look.color)
        };
        builder.beam(beam.ends.map(point), beam.radii, [look(0), look(1)]);
    }
    for (&(center, bits), color_of) in &balls {
        let look = color_of.and_then(|(group, p)| properties.look(group, p));
        builder.ball(point(center), f64::from_bits(bits), look.map_or(color, |l| l.color));
    }
    Ok(builder.mesh)
}

/// Returns the balls to draw, by their vertex and the bits of their radius, with a property. Only the largest ball
/// around a vertex is returned, because it hides the others.
fn balls(
    lattice: &Lattice,
    seen: impl Fn(&&Beam) -> bool,
) -> BTreeMap<(u32, u64), Option<(u64, u64)>> {
    let mut largest: BTreeMap<u32, (f64, Option<(u64, u64)>)> = BTreeMap::new();
    let mut add = |center: u32, radius: f64, property| {
        if radius > 0.0 && radius.is_finite() {
            let ball = largest.entry(center).or_insert((radius, property));
            if radius > ball.0 {
                *ball = (radius, property);
            }
        }
    };
    for beam in lattice.beams.iter().filter(seen) {
        for end in [0, 1] {
            let property = beam.property.map(|(group, p)| (group, p[end]));
            if !beam.butts[end] {
                add(beam.ends[end], beam.radii[end], property);
            }
            if lattice.all_balls {
                add(beam.ends[end], lattice.ball_radius, property);
            }
        }
    }
    lattice.balls.iter().for_each(|ball| add(ball.center, ball.radius, None));
    largest.into_iter().map(|(v, (radius, p))| ((v, radius.to_bits()), p)).collect()
}

fn ball_triangles(sides: usize) -> u64 {
    // Rows of two triangles per side, and two caps of one.
    (2 * sides * (sides / 2 - 1)) as u64
}

/// Builder of triangles for beams and balls.
struct Builder {
    mesh: Mesh,
    /// Cosines and sines around a whole turn.
    circle: Vec<(f64, f64)>,
}

impl Builder {
    fn new(sides: usize) -> Self {
        let turn = |i: usize| std::f64::consts::TAU * i as f64 / sides as f64;
        let circle = (0..sides).map(|i| (libm::cos(turn(i)), libm::sin(turn(i)))).collect();
        Self { mesh: Mesh { indices: Some(Vec::new()), ..Mesh::default() }, circle }
    }

    fn vertex(&mut self, position: DVec3, normal: DVec3, color: Vec4) -> u32 {
        let number = self.mesh.positions.len() as u32;
        self.mesh.positions.push(position.as_vec3());
        self.mesh.normals.push(normal.as_vec3());
        self.mesh.colors.push(color);
        number
    }

    fn triangle(&mut self, corners: [u32; 3]) {
        if let Some(indices) = &mut self.mesh.indices {
            indices.extend(corners);
        }
    }

    /// Adds a prism with flat ends.
    fn beam(&mut self, [from, to]: [DVec3; 2], radii: [f64; 2], colors: [Vec4; 2]) {
        let axis = (to - from).normalize_or_zero();
        let (u, v) = frame(axis);
        let slope = axis * ((radii[0] - radii[1]) / from.distance(to));
        let count = self.circle.len() as u32;
        let side = self.mesh.positions.len() as u32;
        for i in 0..self.circle.len() {
            let (cos, sin) = self.circle[i];
            let out = u * cos + v * sin;
            let normal = (out + slope).normalize_or_zero();
            self.vertex(from + out * radii[0], normal, colors[0]);
            self.vertex(to + out * radii[1], normal, colors[1]);
        }
        for i in 0..count {
            let [a, b] = [i, (i + 1) % count].map(|i| side + 2 * i);
            self.triangle([a, b, b + 1]);
            self.triangle([a, b + 1, a + 1]);
        }
        self.end([from, -axis], [v, u], radii[0], colors[0]);
        self.end([to, axis], [u, v], radii[1], colors[1]);
    }

    /// Adds a flat end: a fan around its first corner.
    fn end(&mut self, [center, normal]: [DVec3; 2], [u, v]: [DVec3; 2], radius: f64, color: Vec4) {
        let first = self.mesh.positions.len() as u32;
        for i in 0..self.circle.len() {
            let (cos, sin) = self.circle[i];
            self.vertex(center + (u * cos + v * sin) * radius, normal, color);
        }
        for i in 2..self.circle.len() as u32 {
            self.triangle([first, first + i - 1, first + i]);
        }
    }

    /// Adds a ball as rows between two poles.
    fn ball(&mut self, center: DVec3, radius: f64, color: Vec4) {
        let sides = self.circle.len();
        let rows = sides / 2;
        let south = self.vertex(center - DVec3::Z * radius, -DVec3::Z, color);
        for row in 1..rows {
            // Half a turn has half as many steps, so the rows are at steps of the same circle.
            let (cos, sin) = self.circle[row];
            for i in 0..sides {
                let (x, y) = self.circle[i];
                let normal = DVec3::new(x * sin, y * sin, -cos);
                self.vertex(center + normal * radius, normal, color);
            }
        }
        let north = self.vertex(center + DVec3::Z * radius, DVec3::Z, color);
        let (sides, rows) = (sides as u32, rows as u32);
        for i in 0..sides {
            let next = (i + 1) % sides;
            let at = |row: u32, i: u32| south + 1 + (row - 1) * sides + i;
            self.triangle([south, at(1, next), at(1, i)]);
            for row in 1..rows - 1 {
                self.triangle([at(row, i), at(row, next), at(row + 1, next)]);
                self.triangle([at(row, i), at(row + 1, next), at(row + 1, i)]);
            }
            self.triangle([at(rows - 1, i), at(rows - 1, next), north]);
        }
    }
}

/// Returns two unit vectors that make a right-handed frame with a third.
fn frame(axis: DVec3) -> (DVec3, DVec3) {
    let [x, y, z] = axis.abs().to_array();
    let least = if x <= y && x <= z {
        DVec3::X
    } else if y <= z {
        DVec3::Y
    } else {
        DVec3::Z
    };
    let u = least.cross(axis).normalize_or_zero();
    (u, axis.cross(u))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns six times the volume, and the number of triangles.
    fn measure(mesh: &Mesh) -> (f64, usize) {
        let point = |v: u32| mesh.positions[v as usize].as_dvec3();
        let six = |i: usize| {
            let [a, b, c] = mesh.triangle(i).map(point);
            a.dot(b.cross(c))
        };
        ((0..mesh.triangle_count()).map(six).sum(), mesh.triangle_count())
    }

    fn made(lattice: &Lattice, limit: u64) -> Result<Mesh> {
        let vertices = [DVec3::ZERO, DVec3::new(1.0, 2.0, 2.0)];
        mesh(lattice, &vertices, DVec3::ZERO, (&Properties::default(), Vec4::ONE), limit)
    }

    #[test]
    fn beams_and_balls_bound_their_volume() {
        let beam = |butts| Beam { ends: [0, 1], radii: [0.5, 0.25], butts, property: None };
        let flat = Lattice { beams: vec![beam([true; 2])], ..Lattice::default() };
        let cone = made(&flat, 1000).expect("within limits");
        // A frustum over a twelve-gon: area 3 r².
        let (six, count) = measure(&cone);
        assert!((six - 6.0 * 3.0 * (0.25 + 0.125 + 0.0625)).abs() < 1e-5, "{six}");
        assert_eq!(count, 44);
        let round = Lattice { beams: vec![beam([false, true])], ..Lattice::default() };
        let (more, count) = measure(&made(&round, 1000).expect("within limits"));
        let ball = (more - six) / 6.0;
        let true_ball = std::f64::consts::FRAC_PI_6;
        assert!(ball > 0.8 * true_ball && ball < true_ball, "{ball}");
        assert_eq!(count, 44 + 120);
        assert!(made(&round, 163).is_err());
        for (n, p) in cone.normals.iter().zip(&cone.positions) {
            assert!((n.length() - 1.0).abs() < 1e-5, "{n} at {p}");
        }
    }

    #[test]
    fn what_is_none_is_left_out() {
        let beam = |ends, radii| Beam { ends, radii, butts: [false; 2], property: None };
        let beams = vec![
            beam([0, 0], [1.0; 2]),
            beam([0, 1], [0.0; 2]),
            beam([0, 1], [f64::NAN; 2]),
            beam([0, 1], [1.0; 2]),
        ];
        let lattice = Lattice { beams, shortest: 3.5, ..Lattice::default() };
        assert_eq!(made(&lattice, 1000).expect("empty").triangle_count(), 0);
        let balls = vec![Ball { center: 1, radius: 1.0 }, Ball { center: 1, radius: 2.0 }];
        let lattice = Lattice { balls, ..Lattice::default() };
        assert_eq!(made(&lattice, 1000).expect("a ball").triangle_count(), 120);
    }
}
