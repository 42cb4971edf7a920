//! Simple bodies as vertices and triangles.

use durer::math::{DVec2, DVec3};
use std::f64::consts::{PI, TAU};

/// Positions, normals and texture coordinates, and triangles counter-clockwise from outside.
#[derive(Default)]
pub struct Solid {
    pub positions: Vec<DVec3>,
    pub normals: Vec<DVec3>,
    pub tex_coords: Vec<DVec2>,
    pub indices: Vec<u32>,
}

impl Solid {
    fn vertex(&mut self, position: DVec3, normal: DVec3, tex_coord: DVec2) -> u32 {
        self.positions.push(position);
        self.normals.push(normal);
        self.tex_coords.push(tex_coord);
        self.positions.len() as u32 - 1
    }

    fn quad(&mut self, [a, b, c, d]: [u32; 4]) {
        self.indices.extend([a, b, c, a, c, d]);
    }
}

/// Returns a box around the origin, each side with the whole texture.
pub fn cuboid(half: DVec3) -> Solid {
    let mut solid = Solid::default();
    for axis in 0..3 {
        for sign in [-1.0, 1.0] {
            let normal = DVec3::AXES[axis] * sign;
            // On the sides the texture's v runs downwards.
            let up = if axis == 1 { DVec3::NEG_Z } else { DVec3::Y };
            let right = up.cross(normal);
            let corner = |x: f64, y: f64| (normal + right * x + up * y) * half;
            let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
            let ids = corners.map(|(x, y)| {
                solid.vertex(corner(x, y), normal, DVec2::new((x + 1.0) / 2.0, (1.0 - y) / 2.0))
            });
            solid.quad(ids);
        }
    }
    solid
}

/// Returns a ball of radius 1 around the origin.
pub fn ball(slices: u32, stacks: u32) -> Solid {
    let mut solid = Solid::default();
    for i in 0..=stacks {
        let (sin_e, cos_e) = libm::sincos(PI * f64::from(i) / f64::from(stacks));
        for j in 0..=slices {
            let (sin_a, cos_a) = libm::sincos(TAU * f64::from(j) / f64::from(slices));
            let p = DVec3::new(sin_e * sin_a, cos_e, sin_e * cos_a);
            let uv = DVec2::new(f64::from(j) / f64::from(slices), f64::from(i) / f64::from(stacks));
            solid.vertex(p, p, uv);
        }
    }
    for i in 0..stacks {
        for j in 0..slices {
            let at = |i: u32, j: u32| i * (slices + 1) + j;
            let (upper, lower) = ([at(i, j), at(i, j + 1)], [at(i + 1, j), at(i + 1, j + 1)]);
            if i > 0 {
                solid.indices.extend([upper[0], lower[0], upper[1]]);
            }
            if i + 1 < stacks {
                solid.indices.extend([upper[1], lower[0], lower[1]]);
            }
        }
    }
    solid
}
