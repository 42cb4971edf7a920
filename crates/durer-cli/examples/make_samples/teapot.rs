//! The Utah teapot as triangles with the normals of its patches.

use crate::teapot_data::{PATCHES, POINTS};
use durer::math::DVec3;
use std::collections::BTreeMap;
use std::fmt::Write;

/// Pieces along each side of a patch.
const PIECES: usize = 10;

/// Step away from a point where a side of the patch has shrunk to nothing.
const ASIDE: f64 = 1e-4;

/// Returns the text of an OBJ file.
pub fn obj() -> String {
    let mut model = Obj::default();
    for patch in &PATCHES {
        tessellate(&patch.map(|i| DVec3::from_array(POINTS[usize::from(i)])), &mut model);
    }
    model.text()
}

/// Returns the value and the derivative of a cubic Bézier curve.
fn cubic(p: [DVec3; 4], t: f64) -> (DVec3, DVec3) {
    let s = 1.0 - t;
    let value = p[0] * (s * s * s)
        + p[1] * (3.0 * s * s * t)
        + p[2] * (3.0 * s * t * t)
        + p[3] * (t * t * t);
    let slope = (p[1] - p[0]) * (s * s) + (p[2] - p[1]) * (2.0 * s * t) + (p[3] - p[2]) * (t * t);
    (value, slope * 3.0)
}

/// Returns the point and the cross product of both derivatives, which points outwards.
fn surface(p: &[DVec3; 16], u: f64, v: f64) -> (DVec3, DVec3) {
    let row = |i: usize| cubic([p[4 * i], p[4 * i + 1], p[4 * i + 2], p[4 * i + 3]], v);
    let rows = [row(0), row(1), row(2), row(3)];
    let (point, along_u) = cubic(rows.map(|r| r.0), u);
    let (along_v, _) = cubic(rows.map(|r| r.1), u);
    (point, along_v.cross(along_u))
}

fn tessellate(patch: &[DVec3; 16], model: &mut Obj) {
    let mut grid = Vec::new();
    for i in 0..=PIECES {
        for j in 0..=PIECES {
            let (u, v) = (i as f64 / PIECES as f64, j as f64 / PIECES as f64);
            let (point, mut normal) = surface(patch, u, v);
            if normal.length() < 1e-9 {
                let inside = |t: f64| t.clamp(ASIDE, 1.0 - ASIDE);
                normal = surface(patch, inside(u), inside(v)).1;
            }
            grid.push(model.vertex(point, normal.normalize()));
        }
    }
    let at = |i: usize, j: usize| grid[i * (PIECES + 1) + j];
    for i in 0..PIECES {
        for j in 0..PIECES {
            model.triangle([at(i, j), at(i + 1, j + 1), at(i + 1, j)]);
            model.triangle([at(i, j), at(i, j + 1), at(i + 1, j + 1)]);
        }
    }
}

/// Lines of an OBJ file, each value once.
#[derive(Default)]
struct Obj {
    points: Lines,
    normals: Lines,
    faces: String,
}

#[derive(Default)]
struct Lines {
    numbers: BTreeMap<String, usize>,
    text: String,
}

impl Lines {
    /// Returns the number of a line, counted from 1; z up becomes y up.
    fn number(&mut self, keyword: &str, v: DVec3) -> usize {
        // Adding 0 turns −0 into 0.
        let round = |c: f64| (c * 1e5).round() / 1e5 + 0.0;
        let line = format!("{keyword} {} {} {}\n", round(v.x), round(v.z), round(-v.y));
        let next = self.numbers.len() + 1;
        *self.numbers.entry(line).or_insert_with_key(|line| {
            self.text.push_str(line);
            next
        })
    }
}

impl Obj {
    fn vertex(&mut self, point: DVec3, normal: DVec3) -> [usize; 2] {
        [self.points.number("v", point), self.normals.number("vn", normal)]
    }

    /// Adds a triangle, unless two of its corners coincide.
    fn triangle(&mut self, [a, b, c]: [[usize; 2]; 3]) {
        if a[0] != b[0] && b[0] != c[0] && c[0] != a[0] {
            // Writing to a string cannot fail.
            let _ =
                writeln!(self.faces, "f {}//{} {}//{} {}//{}", a[0], a[1], b[0], b[1], c[0], c[1]);
        }
    }

    fn text(&self) -> String {
        let head = "# The Utah teapot, Martin Newell 1975: 32 Bezier patches, tessellated by durer\no teapot\n";
        [head, &self.points.text, &self.normals.text, &self.faces].concat()
    }
}
