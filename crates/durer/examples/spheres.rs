//! Five materials under the automatic lights, one row per shading model, on white and on dark.
//!
//! `cargo run --release --example spheres -- spheres.png`

use durer::math::{DVec3, Vec3, Vec4};
use durer::scene::{Camera, Material, Projection, Scene, ShadingModel};
use durer::shade::{PreparedLights, PreparedMaterials, Shading, Surface, color, shade};

const CELL: u32 = 160;

fn materials() -> Vec<Material> {
    let of = |rgb: [f32; 3], metallic, roughness| Material {
        model: ShadingModel::MetallicRoughness,
        base_color: Vec3::from(rgb).extend(1.0),
        metallic,
        roughness,
        ..Material::default()
    };
    vec![
        Material::default(),
        of([0.6, 0.02, 0.02], 0.0, 0.35),
        of([1.0, 0.71, 0.29], 1.0, 0.3),
        of([0.9, 0.9, 0.92], 1.0, 0.05),
        of([0.9, 0.9, 0.9], 0.0, 1.0),
    ]
}

/// Returns the pixel's point on the unit sphere in the middle of its cell, seen along −z.
fn pixel(x: u32, y: u32) -> Option<Vec3> {
    let at = |i: u32| ((i % CELL) as f32 + 0.5) / CELL as f32 * 2.2 - 1.1;
    let (x, y) = (at(x), -at(y));
    let height2 = 1.0 - x * x - y * y;
    (height2 > 0.0).then(|| Vec3::new(x, y, height2.sqrt()))
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let scene = Scene { materials: materials(), ..Scene::default() };
    let prepared = PreparedMaterials::new(&scene);
    let projection = Projection::Orthographic { height: 2.2 };
    let (eye, target, up) = (DVec3::Z * 5.0, DVec3::ZERO, DVec3::Y);
    let lights = PreparedLights::auto(&Camera { eye, target, up, projection, near: 1.0, far: 9.0 });
    let rows = [Shading::Flat, Shading::Phong, Shading::MetallicRoughness];
    let (width, height) = (CELL * 10, CELL * rows.len() as u32);
    let mut data = Vec::new();
    for (y, x) in (0..height).flat_map(|y| (0..width).map(move |x| (y, x))) {
        let (column, shading) = ((x / CELL) as usize, rows[(y / CELL) as usize]);
        let background = if column < 5 { Vec4::ONE } else { Vec4::new(0.01, 0.012, 0.02, 1.0) };
        let shaded = pixel(x, y).map(|n| {
            let facet = ((n * 6.0).round() / 6.0).normalize();
            let geometric_normal = if shading == Shading::Flat { facet } else { n };
            let surface = Surface { normal: n, geometric_normal, ..Surface::default() };
            shade(&surface, prepared.get(Some(column % 5)), &lights, shading)
        });
        data.extend(color::encode_rgba8(shaded.unwrap_or(background)));
    }
    let path = std::env::args().nth(1).unwrap_or_else(|| "spheres.png".into());
    let mut encoder = png::Encoder::new(std::fs::File::create(path)?, width, height);
    encoder.set_color(png::ColorType::Rgba);
    Ok(encoder.write_header()?.write_image_data(&data)?)
}
