//! Scenes and views for drawings: bodies composed of boxes and triangles.

use durer::math::{DMat3, DMat4, DVec3, Vec3};
use durer::scene::{Camera, Instance, Mesh, Projection, Scene};
use durer::view::View;

pub type Triangle = [DVec3; 3];

/// Returns the twelve triangles of a box, facing outwards.
pub fn cuboid(min: [f64; 3], max: [f64; 3]) -> Vec<Triangle> {
    let p = |i: usize| {
        DVec3::from(std::array::from_fn(|k| if i >> k & 1 == 1 { max[k] } else { min[k] }))
    };
    let quads =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    quads.iter().flat_map(|&[a, b, c, d]| [[p(a), p(b), p(c)], [p(a), p(c), p(d)]]).collect()
}

/// Returns a flat rectangle with one side along x, seen from above, tilted by its corners' heights.
pub fn quad(corners: [[f64; 3]; 4]) -> Vec<Triangle> {
    let [a, b, c, d] = corners.map(DVec3::from);
    vec![[a, b, c], [a, c, d]]
}

/// Returns an upright cylinder of `n` sides.
pub fn cylinder(center: [f64; 2], radius: f64, heights: [f64; 2], n: usize) -> Vec<Triangle> {
    let at = |i: usize, z: f64| {
        let a = (i % n) as f64 / n as f64 * std::f64::consts::TAU;
        DVec3::new(center[0] + radius * a.cos(), center[1] + radius * a.sin(), z)
    };
    let [low, high] = heights;
    let middle = |z| DVec3::new(center[0], center[1], z);
    (0..n)
        .flat_map(|i| {
            [
                [at(i, low), at(i + 1, low), at(i + 1, high)],
                [at(i, low), at(i + 1, high), at(i, high)],
                [middle(high), at(i, high), at(i + 1, high)],
                [middle(low), at(i + 1, low), at(i, low)],
            ]
        })
        .collect()
}

/// Returns a scene of one mesh without shared vertices.
pub fn soup(triangles: &[Triangle]) -> Scene {
    placed(triangles, DMat4::IDENTITY)
}

/// Returns the same, moved.
pub fn placed(triangles: &[Triangle], world_from_mesh: DMat4) -> Scene {
    let positions: Vec<Vec3> = triangles.iter().flatten().map(|p| p.as_vec3()).collect();
    let mesh = Mesh { positions, ..Mesh::default() };
    let instance = Instance { mesh: 0, world_from_mesh, name: String::new() };
    Scene { meshes: vec![mesh], instances: vec![instance], ..Scene::default() }
}

/// Returns a view from a direction, `height` world units high, z up.
pub fn view(target: DVec3, to_eye: DVec3, height: f64, perspective: bool) -> View {
    let to_eye = to_eye.normalize();
    let up = if to_eye.z.abs() > 0.999 { DVec3::Y } else { DVec3::Z };
    let distance = 3.0 * height;
    let projection = if perspective {
        Projection::Perspective { fov_y: 2.0 * (0.5 * height / distance).atan() }
    } else {
        Projection::Orthographic { height }
    };
    let (near, far) = (0.1 * height, 8.0 * height);
    let camera = Camera { eye: target + to_eye * distance, target, up, projection, near, far };
    View::new(camera, 1000, 1000).expect("view")
}

/// Pseudo-random numbers in 0 … 1.
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> f64 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as f64 / (1u64 << 31) as f64
    }
}

/// Returns boxes of random position and size that may intersect.
pub fn random_boxes(count: usize, seed: u64) -> Vec<Triangle> {
    let mut random = Random(seed);
    let mut triangles = Vec::new();
    for _ in 0..count {
        let min: [f64; 3] = std::array::from_fn(|_| random.next() * 8.0);
        let max: [f64; 3] = std::array::from_fn(|k| min[k] + 0.3 + random.next() * 2.0);
        triangles.extend(cuboid(min, max));
    }
    triangles
}

/// Returns towers on a square grid, whose edges are aligned in many views.
pub fn city(side: usize) -> Vec<Triangle> {
    let mut triangles = Vec::new();
    for i in 0..side {
        for j in 0..side {
            let (x, y) = (i as f64 * 2.0, j as f64 * 2.0);
            let height = 1.0 + ((i * 7 + j * 3) % 4) as f64;
            triangles.extend(cuboid([x, y, 0.0], [x + 1.0, y + 1.0, height]));
        }
    }
    triangles
}

/// Returns a ring around z of radii 2 and 0.8.
pub fn torus(around: usize, across: usize) -> Vec<Triangle> {
    let at = |i: usize, k: usize| {
        let turn = |n: usize, of: usize| (n % of) as f64 / of as f64 * std::f64::consts::TAU;
        let ((s, c), (t, d)) = (turn(i, around).sin_cos(), turn(k, across).sin_cos());
        DVec3::new(c * (2.0 + 0.8 * d), s * (2.0 + 0.8 * d), 0.8 * t)
    };
    let cells = (0..around).flat_map(|i| (0..across).map(move |k| (i, k)));
    cells
        .flat_map(|(i, k)| {
            let [a, b, c, d] = [at(i, k), at(i + 1, k), at(i + 1, k + 1), at(i, k + 1)];
            [[a, b, c], [a, c, d]]
        })
        .collect()
}

/// Returns boxes in any position; some go through each other.
pub fn turned_boxes(count: usize, random: &mut Random) -> Vec<Triangle> {
    let mut all = Vec::new();
    for _ in 0..count {
        let mut number = |low: f64, high: f64| low + random.next() * (high - low);
        let half = [0; 3].map(|_| number(0.5, 2.0));
        let middle = DVec3::from([0; 3].map(|_| number(0.0, 7.0)));
        let axis = DVec3::from([0; 3].map(|_| number(-1.0, 1.0))).normalize();
        let turn = DMat3::from_axis_angle(axis, number(0.0, 6.0));
        let low = half.map(|v| -v);
        let placed = cuboid(low, half);
        all.extend(placed.iter().map(|t| t.map(|p| middle + turn * p)));
    }
    all
}
