//! durer's production path.

use crate::Result;
use crate::clock::{Cost, measure, median_cost};
use crate::mesh::Mesh;
use crate::picture::Picture;
use crate::scene::{self, Place};
use durer::math::{DMat4, DVec3, Vec3};
use durer::pipeline::{
    Background, Cull, Lighting, RenderOptions, Samples, Shading, SurfaceMethod, render_into,
};
use durer::scene::{
    Camera, Instance, Light, LightKind, Material, Part, Projection, Scene, ShadingModel,
};
use durer::shade::color;
use durer::target::Framebuffer;

/// durer with a number of threads.
pub struct Durer {
    scene: Scene,
    place: Place,
    samples: Samples,
    /// The way to find visible surfaces.
    pub algorithm: SurfaceMethod,
    /// Pixels across and down.
    pub size: [u32; 2],
    pool: rayon::ThreadPool,
    last: Framebuffer,
}

impl Durer {
    /// Creates the scene ready to be drawn, with 1 or 4 samples per pixel.
    pub fn new(mesh: &Mesh, samples: u32, threads: usize) -> Result<Self> {
        let durer_mesh = durer::scene::Mesh {
            positions: mesh.positions.iter().copied().map(Vec3::from).collect(),
            normals: mesh.normals.iter().copied().map(Vec3::from).collect(),
            indices: Some(mesh.triangles.as_flattened().to_vec()),
            parts: vec![Part {
                range: 0..mesh.triangles.len() as u32,
                material: Some(0),
                name: String::new(),
            }],
            ..Default::default()
        };
        let instance = Instance { mesh: 0, world_from_mesh: DMat4::IDENTITY, name: String::new() };
        let scene_of = Scene {
            meshes: vec![durer_mesh],
            instances: vec![instance],
            materials: vec![material()],
            ..Default::default()
        };
        let samples = if samples == 4 { Samples::Four } else { Samples::One };
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
        let (place, last) = (Place::of(mesh), Framebuffer::new(0, 0));
        let size = [scene::WIDTH as u32, scene::HEIGHT as u32];
        let algorithm = SurfaceMethod::ZBuffer;
        Ok(Self { scene: scene_of, place, samples, algorithm, size, pool, last })
    }

    /// Draws one turn of frames; the medians of the timed ones.
    pub fn turn(&mut self) -> Result<Cost> {
        let mut costs = Vec::new();
        for frame in 0..=scene::LAST {
            let options = self.options(frame);
            let Self { scene, pool, last, .. } = self;
            let work = || pool.install(|| render_into(scene, &options, last));
            let (result, cost) = measure(work);
            result?;
            if frame >= scene::WARM {
                costs.push(cost);
            }
        }
        Ok(median_cost(&costs))
    }

    fn options(&self, frame: usize) -> RenderOptions {
        let (center, angle) = (DVec3::from(self.place.center), scene::angle(frame));
        let camera = Camera {
            eye: center + DVec3::new(-angle.sin(), 0.0, angle.cos()) * self.place.distance,
            target: center,
            up: DVec3::Y,
            projection: Projection::Perspective { fov_y: scene::FOV_Y },
            near: self.place.near(),
            far: self.place.far(),
        };
        let [right, up, back] = camera.axes();
        let [x, y, z] = scene::LIGHT;
        let direction = -(right * x + up * y + back * z);
        let light = |kind, color| Light { kind, color };
        RenderOptions {
            width: self.size[0],
            height: self.size[1],
            algorithm: self.algorithm,
            shading: Some(Shading::Phong),
            // Without a light from everywhere durer would add one; the ambient term is emission here.
            lighting: Lighting::Given(vec![
                light(LightKind::Directional { direction }, Vec3::ONE),
                light(LightKind::Ambient, Vec3::ZERO),
            ]),
            background: Background::Color(Vec3::from(scene::BACKGROUND).extend(1.0)),
            cull: Cull::Back,
            samples: self.samples,
            ..RenderOptions::new(camera)
        }
    }

    /// Returns the last frame, turned from sRGB to the linear bytes that the others write.
    pub fn picture(&self) -> Picture {
        let linear = |c: u8| color::encode_unorm8(color::decode_srgb8(c));
        let pixels = self.last.color.data().iter().map(|&[r, g, b, _]| [r, g, b].map(linear));
        let [r, g, b] = scene::BACKGROUND.map(|c| linear(color::encode_srgb8(c)));
        Picture { width: scene::WIDTH, pixels: pixels.collect(), background: [r, g, b] }
    }
}

fn material() -> Material {
    Material {
        model: ShadingModel::Phong,
        base_color: Vec3::from(scene::DIFFUSE).extend(1.0),
        emissive: Vec3::from(scene::AMBIENT),
        specular: Vec3::splat(scene::SPECULAR),
        shininess: scene::SHININESS,
        double_sided: false,
        ..Material::default()
    }
}
