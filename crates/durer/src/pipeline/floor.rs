//! The surroundings that a model can be placed on: a grid, axes, and the shadow where it touches
//! the floor.
//!
//! These are added to the scene as meshes, so that every method of rendering shows them.

use super::{RenderOptions, SurfaceMethod, render};
use crate::Result;
use crate::math::{DMat3, DMat4, DVec2, DVec3, Vec2, Vec3, Vec4};
use crate::scene::{
    Aabb, AlphaMode, Camera, Image, Instance, Material, Mesh, Part, Projection, Sampler, Scene,
    ShadingModel, Texture, TextureRef, Topology, UpAxis, Wrap,
};
use crate::target::Pixels;
use crate::view::projection::NamedView;
use crate::visibility::surface::Samples;

/// Distance that the shadow extends beyond the model, as a part of its size.
const REACH: f64 = 0.3;

/// Texels along the side of the shadow.
const TEXELS: u32 = 512;

/// The darkest shadow.
const DARKEST: f32 = 0.8;

/// Shadows of parts up to these heights over the floor, as fractions of the reach, with their shares.
/// Higher parts throw softer ones.
const LEVELS: [(f64, f32); 4] = [(0.06, 0.3), (0.15, 0.3), (0.4, 0.25), (1.0, 0.15)];

/// About how many cells a grid has along the larger side of a model.
const CELLS: f64 = 10.0;

/// The floor under a model.
struct Floor {
    /// Unit vectors along the floor and up from it; right-handed.
    axes: [DVec3; 3],
    /// The smallest and the largest coordinates along the axes.
    min: DVec3,
    max: DVec3,
}

impl Floor {
    fn under(model: &Aabb, up_axis: UpAxis) -> Self {
        let Aabb { min, max } = *model;
        let front = NamedView::Front.direction(up_axis);
        let axes = [front.to_eye(), front.right(), front.up()];
        let corner = |axis: DVec3| [axis.dot(min), axis.dot(max)];
        let along = axes.map(corner);
        let [low, high] =
            [along.map(|[a, b]| a.min(b)), along.map(|[a, b]| a.max(b))].map(DVec3::from);
        Self { axes, min: low, max: high }
    }

    /// Returns the length of the longest side.
    fn size(&self) -> f64 {
        (self.max - self.min).max_element()
    }

    fn world(&self, p: DVec3) -> DVec3 {
        self.axes[0] * p.x + self.axes[1] * p.y + self.axes[2] * p.z
    }
}

/// Adds lines of a grid on the floor under a model's box, 1, 2 or 5 times a power of ten apart; none under
/// a point.
pub fn add_grid(scene: &mut Scene, model: &Aabb) {
    let floor = Floor::under(model, scene.up_axis);
    let Some(cell) = round_length(floor.size() / CELLS) else { return };
    let low = (floor.min.truncate() / cell).floor() - 1.0;
    let high = (floor.max.truncate() / cell).ceil() + 1.0;
    let mut lines = Vec::new();
    let mut line = |a: DVec2, b: DVec2| {
        lines.push([a, b].map(|p| floor.world((p * cell).extend(floor.min.z))));
    };
    for i in 0..=(high.x - low.x) as u32 {
        let x = low.x + f64::from(i);
        line(DVec2::new(x, low.y), DVec2::new(x, high.y));
    }
    for i in 0..=(high.y - low.y) as u32 {
        let y = low.y + f64::from(i);
        line(DVec2::new(low.x, y), DVec2::new(high.x, y));
    }
    add_lines(scene, "grid", &lines, Vec3::splat(0.35));
}

/// Adds the axes of the world, x red, y green, z blue, as long as the model is large: from the origin if it is in the
/// box around the model, else from the box's smallest corner.
pub fn add_axes(scene: &mut Scene, model: &Aabb) {
    let Aabb { min, max } = *model;
    let inside = min.cmple(DVec3::ZERO).all() && max.cmpge(DVec3::ZERO).all();
    let from = if inside { DVec3::ZERO } else { min };
    let length = (max - min).max_element() * 0.6;
    let colors =
        [Vec3::new(0.7, 0.03, 0.03), Vec3::new(0.03, 0.4, 0.03), Vec3::new(0.03, 0.1, 0.8)];
    for ((axis, color), name) in
        DMat3::IDENTITY.to_cols_array_2d().into_iter().zip(colors).zip(["x", "y", "z"])
    {
        let to = from + DVec3::from(axis) * length;
        add_lines(scene, name, &[[from, to]], color);
    }
}

/// Rounds a length down to 1, 2 or 5 times a power of ten; returns `None` for a number that is not a length.
fn round_length(length: f64) -> Option<f64> {
    if !(length.is_finite() && length > 0.0) {
        return None;
    }
    let power = libm::pow(10.0, libm::log10(length).floor());
    let part = length / power;
    let digit = if part >= 5.0 {
        5.0
    } else if part >= 2.0 {
        2.0
    } else {
        1.0
    };
    Some(digit * power).filter(|l| l.is_normal())
}

fn add_lines(scene: &mut Scene, name: &str, lines: &[[DVec3; 2]], color: Vec3) {
    // Relative to the first end, so that single precision is enough anywhere.
    let Some([origin, _]) = lines.first().copied() else { return };
    let mesh = Mesh {
        name: name.to_owned(),
        topology: Topology::Lines,
        positions: lines.iter().flatten().map(|p| (*p - origin).as_vec3()).collect(),
        ..Mesh::default()
    };
    let model = ShadingModel::Unlit;
    let material = Material {
        name: name.to_owned(),
        model,
        base_color: color.extend(1.0),
        ..Material::default()
    };
    add(scene, mesh, origin, material);
}

fn add(scene: &mut Scene, mut mesh: Mesh, origin: DVec3, material: Material) {
    let range = 0..mesh.primitive_count() as u32;
    mesh.parts = vec![Part { range, material: Some(scene.materials.len()), name: String::new() }];
    let (world_from_mesh, name) = (DMat4::from_translation(origin), mesh.name.clone());
    scene.instances.push(Instance { mesh: scene.meshes.len(), world_from_mesh, name });
    scene.meshes.push(mesh);
    scene.materials.push(material);
}

/// Adds the soft shadow that a model, in its box, has on the floor under it: darker where it is nearer
/// to the floor.
///
/// The model is rendered from below, and surfaces up to a certain height over the floor darken it around them, lower
/// ones more sharply. Cost: a picture of 512 × 512 pixels.
///
/// # Errors
/// As [`render`].
pub fn add_ground(scene: &mut Scene, model: &Scene, around: &Aabb) -> Result<()> {
    let floor = Floor::under(around, scene.up_axis);
    let reach = floor.size() * REACH;
    let middle = (floor.min + floor.max) * 0.5;
    let side = (floor.max - floor.min).truncate().max_element() + 2.0 * reach;
    let Some(heights) = heights(model, &floor, side)? else { return Ok(()) };
    let shadow = shadow(&heights, reach, side);
    let data = shadow.iter().map(|s| [0, 0, 0, (s * 255.0 + 0.5) as u8]).collect();
    let image = Image { name: "ground".to_owned(), width: TEXELS, height: TEXELS, data };
    let wrap = Wrap::ClampToEdge;
    let sampler = Sampler { wrap_u: wrap, wrap_v: wrap, ..Sampler::default() };
    scene.textures.push(Texture { image: scene.images.len(), sampler });
    scene.images.push(image);
    let reference =
        TextureRef { texture: scene.textures.len() - 1, tex_coord: 0, transform: DMat3::IDENTITY };
    let material = Material {
        name: "ground".to_owned(),
        model: ShadingModel::Unlit,
        base_color: Vec4::ONE,
        base_color_texture: Some(reference),
        alpha_mode: AlphaMode::Blend,
        double_sided: false,
        ..Material::default()
    };
    // A little lower than the floor, so that faces on it are in front.
    let below = floor.min.z - 1e-3 * floor.size();
    let origin = floor.world(middle.truncate().extend(below));
    let corners = [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]];
    let mesh = Mesh {
        name: "ground".to_owned(),
        positions: corners
            .map(|[x, y]| floor.world(DVec3::new(x * side, y * side, 0.0)).as_vec3())
            .to_vec(),
        tex_coords: vec![corners.map(|[x, y]| Vec2::new(y as f32 + 0.5, x as f32 + 0.5)).to_vec()],
        indices: Some(vec![0, 1, 2, 0, 2, 3]),
        ..Mesh::default()
    };
    add(scene, mesh, origin, material);
    Ok(())
}

/// Returns the height over the floor of the lowest surface, in world units; infinite if there is
/// none. `None` if the model's height cannot be represented.
fn heights(scene: &Scene, floor: &Floor, side: f64) -> Result<Option<Vec<f64>>> {
    let size = floor.size();
    let height = (floor.max.z - floor.min.z).max(size * 1e-6);
    let middle = (floor.min + floor.max) * 0.5;
    let foot = floor.world(middle.truncate().extend(floor.min.z));
    let up = floor.axes[2];
    let (near, far) = (size * 0.999, size + height * 1.001);
    let camera = Camera {
        eye: foot - up * size,
        target: foot,
        // Seen from below with this up, columns run along the second axis and rows against the first.
        up: floor.axes[0],
        projection: Projection::Orthographic { height: side },
        near,
        far,
    };
    if camera.check().is_err() {
        return Ok(None);
    }
    let options = RenderOptions {
        algorithm: SurfaceMethod::ZBuffer,
        width: TEXELS,
        height: TEXELS,
        samples: Samples::One,
        depth: true,
        ..RenderOptions::new(camera)
    };
    let (picture, _) = render(scene, &options)?;
    let over = |d: &f32| {
        if *d < 1.0 { near + f64::from(*d) * (far - near) - size } else { f64::INFINITY }
    };
    Ok(picture.depth.as_ref().map(|depth| texels(depth).map(|d| over(&d)).collect()))
}

/// Returns the pixels of a picture from below in the order of the floor's texels: rows along the
/// first axis, columns along the second.
fn texels(depth: &Pixels<f32>) -> impl Iterator<Item = f32> + '_ {
    (0..TEXELS).rev().flat_map(move |y| (0..TEXELS).rev().filter_map(move |x| depth.get(x, y)))
}

/// Returns the darkness of the floor, texel by texel.
fn shadow(heights: &[f64], reach: f64, side: f64) -> Vec<f32> {
    let mut sum = vec![0.0_f32; heights.len()];
    for (part, share) in LEVELS {
        let high = reach * part;
        let mut level: Vec<f32> =
            heights.iter().map(|h| (1.0 - h / high).clamp(0.0, 1.0) as f32).collect();
        let radius = (high * 0.5 / side * f64::from(TEXELS)) as usize;
        for _ in 0..3 {
            blur_rows(&mut level, radius);
            level = transposed(&level);
            blur_rows(&mut level, radius);
            level = transposed(&level);
        }
        for (sum, level) in sum.iter_mut().zip(level) {
            *sum += DARKEST * share * level;
        }
    }
    sum
}

/// Averages over `radius` texels to both sides, row by row; values beyond the border count as 0.
fn blur_rows(values: &mut [f32], radius: usize) {
    let width = TEXELS as usize;
    for row in values.chunks_mut(width) {
        let before: Vec<f32> = row.to_vec();
        let (mut sum, part) = (0.0_f64, 1.0 / (2 * radius + 1) as f64);
        for v in before.iter().take(radius) {
            sum += f64::from(*v);
        }
        for (i, to) in row.iter_mut().enumerate() {
            sum += before.get(i + radius).map_or(0.0, |v| f64::from(*v));
            *to = (sum * part) as f32;
            sum -= i.checked_sub(radius).and_then(|i| before.get(i)).map_or(0.0, |v| f64::from(*v));
        }
    }
}

fn transposed(values: &[f32]) -> Vec<f32> {
    let width = TEXELS as usize;
    (0..width).flat_map(|x| values[x..].iter().step_by(width).copied()).collect()
}
