//! A hundred full-screen quads, one in front of another, textured with bilinear filtering: a test of overdraw.

use crate::clock::{Cost, measure, median_cost, ratio};
use crate::options::Options;
use crate::{Result, llvmpipe, scene, table};
use durer::math::{DMat4, DVec3, Vec2, Vec3, Vec4};
use durer::pipeline::{Lighting, RenderOptions, Samples, render_into};
use durer::scene::{
    AlphaMode, Camera, Image, Instance, Material, Mesh, MipFilter, Part, Projection, Sampler,
    Scene, ShadingModel, Texture, TextureFilter, TextureRef, Wrap,
};
use durer::target::Framebuffer;

/// Quads.
const LAYERS: usize = 100;

/// Texels along the side of the texture.
const TEXELS: u32 = 1024;

/// Orders of the quads, by the harness's names.
const MODES: [&str; 3] = ["b2f", "f2b", "blend"];

/// Measures all orders with one sample and prints a table.
pub fn run(options: &Options) -> Result<()> {
    let Some(harness) = llvmpipe::harness() else {
        return Err("LLVMPIPE_BENCH is not set".into());
    };
    table::head(&["100 quads", "durer CPU ms", "llvmpipe CPU ms", "its CPU / durer's"]);
    for mode in MODES {
        let (scene, view) = (quads(mode, LAYERS), view());
        let (mut ours, mut theirs) = (Vec::new(), Vec::new());
        for _ in 0..options.rounds {
            ours.push(turn(&scene, &view)?);
            let arguments = ["fill", "tex", "--mode", mode, "--frames", "3"];
            theirs.push(llvmpipe::run(&harness, &arguments, 0)?);
        }
        table::row(&[
            mode.to_owned(),
            format!("{:.1}", median_cost(&ours).cpu * 1e3),
            format!("{:.1}", median_cost(&theirs).cpu * 1e3),
            format!("{:.2}", ratio(&theirs, &ours, |c| c.cpu)),
        ]);
    }
    Ok(())
}

/// Returns the median of three frames into one picture, as the harness has one surface, after one that does
/// not count.
pub fn turn(scene: &Scene, view: &RenderOptions) -> Result<Cost> {
    let (mut costs, mut picture) = (Vec::new(), Framebuffer::new(0, 0));
    for frame in 0..4 {
        let (result, cost) = measure(|| render_into(scene, view, &mut picture));
        result?;
        if frame > 0 {
            costs.push(cost);
        }
    }
    Ok(median_cost(&costs))
}

/// Returns the view of the quads.
pub fn view() -> RenderOptions {
    let height = 2.0;
    let camera = Camera {
        eye: DVec3::Z * 2.0,
        target: DVec3::ZERO,
        up: DVec3::Y,
        projection: Projection::Orthographic { height },
        near: 0.5,
        far: 3.5,
    };
    RenderOptions {
        width: scene::WIDTH as u32,
        height: scene::HEIGHT as u32,
        samples: Samples::One,
        lighting: Lighting::Given(Vec::new()),
        ..RenderOptions::new(camera)
    }
}

/// Returns the quads in an order.
pub fn quads(mode: &str, layers: usize) -> Scene {
    let half = (scene::WIDTH as f32 / scene::HEIGHT as f32, 1.0);
    let mut mesh = Mesh::default();
    let mut coordinates = Vec::new();
    for layer in 0..layers {
        let near = if mode == "f2b" { layers - layer } else { layer };
        let z = -0.9 + 1.8 * near as f32 / layers as f32;
        for (x, y) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
        {
            mesh.positions.push(Vec3::new(x * half.0, y * half.1, z));
            // As in the harness: once across, nine sixteenths up.
            coordinates.push(Vec2::new(0.5 + 0.5 * x, 0.5625 * (0.5 + 0.5 * y)));
        }
    }
    mesh.tex_coords.push(coordinates);
    mesh.parts = vec![Part { range: 0..2 * layers as u32, material: Some(0), name: String::new() }];
    let blend = mode == "blend";
    let material = Material {
        model: ShadingModel::Unlit,
        base_color: Vec4::new(1.0, 1.0, 1.0, if blend { 0.5 } else { 1.0 }),
        base_color_texture: Some(TextureRef {
            texture: 0,
            tex_coord: 0,
            transform: durer::math::DMat3::IDENTITY,
        }),
        alpha_mode: if blend { AlphaMode::Blend } else { AlphaMode::Opaque },
        ..Material::default()
    };
    let sampler = Sampler {
        mag: TextureFilter::Linear,
        min: TextureFilter::Linear,
        mip: MipFilter::None,
        wrap_u: Wrap::Repeat,
        wrap_v: Wrap::Repeat,
    };
    Scene {
        meshes: vec![mesh],
        instances: vec![Instance {
            mesh: 0,
            world_from_mesh: DMat4::IDENTITY,
            name: String::new(),
        }],
        materials: vec![material],
        textures: vec![Texture { image: 0, sampler }],
        images: vec![image()],
        ..Scene::default()
    }
}

/// Returns the harness's texture: a chequer with noise.
fn image() -> Image {
    let mut seed = 1u32;
    let mut data = Vec::new();
    for (y, x) in (0..TEXELS).flat_map(|y| (0..TEXELS).map(move |x| (y, x))) {
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        let dark = (x >> 5) ^ (y >> 5);
        let red = if dark & 1 == 1 { 200 } else { 40 };
        data.push([red, (x * 255 / TEXELS) as u8, (seed >> 24) as u8, 255]);
    }
    Image { name: String::new(), width: TEXELS, height: TEXELS, data }
}
