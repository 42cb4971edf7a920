//! The euc crate: one thread, one sample, shaders written in Rust.

use crate::clock::{Cost, measure, median_cost};
use crate::mesh::Mesh;
use crate::picture::Picture;
use crate::scene::{self, Place};
use euc::buffer::Buffer2d;
use euc::{Pipeline, Target, rasterizer};
use vek::{Mat4, Vec3, Vec4};

/// The scene and the buffers, which are kept from frame to frame.
pub struct Euc {
    positions: Vec<Vec3<f32>>,
    normals: Vec<Vec3<f32>>,
    indices: Vec<u32>,
    place: Place,
    color: Buffer2d<[u8; 4]>,
    depth: Buffer2d<f32>,
}

/// Values that are the same for a whole frame.
struct Phong<'a> {
    positions: &'a [Vec3<f32>],
    normals: &'a [Vec3<f32>],
    view_from_world: Mat4<f32>,
    clip_from_world: Mat4<f32>,
    light: Vec3<f32>,
}

impl Pipeline for Phong<'_> {
    type Vertex = u32;
    /// Position and normal in view space.
    type VsOut = (Vec3<f32>, Vec3<f32>);
    type Pixel = [u8; 4];

    #[inline(always)]
    fn vert(&self, vertex: &u32) -> ([f32; 4], Self::VsOut) {
        let position = Vec4::from_point(self.positions[*vertex as usize]);
        let normal = Vec4::from_direction(self.normals[*vertex as usize]);
        let seen = |v| Vec3::from(self.view_from_world * v);
        ((self.clip_from_world * position).into_array(), (seen(position), seen(normal)))
    }

    #[inline(always)]
    fn frag(&self, (position, normal): &Self::VsOut) -> [u8; 4] {
        let normal = normal.normalized();
        let half = ((-*position).normalized() + self.light).normalized();
        let diffuse = normal.dot(self.light).max(0.0);
        let specular = normal.dot(half).max(0.0).powi(scene::SHININESS as i32) * scene::SPECULAR;
        let channel = |k: usize| byte(scene::AMBIENT[k] + diffuse * scene::DIFFUSE[k] + specular);
        [channel(0), channel(1), channel(2), 255]
    }
}

fn byte(value: f32) -> u8 {
    (value * 255.0 + 0.5) as u8
}

fn background() -> [u8; 3] {
    scene::BACKGROUND.map(byte)
}

impl Euc {
    /// Creates the scene ready to be drawn.
    pub fn new(mesh: &Mesh) -> Self {
        let size = [scene::WIDTH, scene::HEIGHT];
        let vectors = |v: &[[f32; 3]]| v.iter().map(|&p| Vec3::from(p)).collect();
        Self {
            positions: vectors(&mesh.positions),
            normals: vectors(&mesh.normals),
            indices: mesh.triangles.as_flattened().to_vec(),
            place: Place::of(mesh),
            color: Buffer2d::new(size, [0; 4]),
            depth: Buffer2d::new(size, 1.0),
        }
    }

    /// Draws one turn of frames; the medians of the timed ones.
    pub fn turn(&mut self) -> Cost {
        let mut costs = Vec::new();
        for frame in 0..=scene::LAST {
            let ((), cost) = measure(|| self.draw(frame));
            if frame >= scene::WARM {
                costs.push(cost);
            }
        }
        median_cost(&costs)
    }

    fn draw(&mut self, frame: usize) {
        let view_from_world = self.place.view_from_world(frame);
        let (width, height) = (scene::WIDTH as f32, scene::HEIGHT as f32);
        let (near, far) = (self.place.near() as f32, self.place.far() as f32);
        let fov = scene::FOV_Y as f32;
        let clip_from_view = Mat4::perspective_fov_rh_no(fov, width, height, near, far);
        let [r, g, b] = background();
        self.color.clear([r, g, b, 255]);
        self.depth.clear(1.0);
        let phong = Phong {
            positions: &self.positions,
            normals: &self.normals,
            view_from_world,
            clip_from_world: clip_from_view * view_from_world,
            light: Vec3::from(scene::LIGHT.map(|c| c as f32)),
        };
        let depth = Some(&mut self.depth);
        phong.draw::<rasterizer::Triangles<_>, _>(&self.indices, &mut self.color, depth);
    }

    /// Returns the last frame.
    pub fn picture(&self) -> Picture {
        let pixels = self.color.as_ref().iter().map(|&[r, g, b, _]| [r, g, b]).collect();
        Picture { width: scene::WIDTH, pixels, background: background() }
    }
}
