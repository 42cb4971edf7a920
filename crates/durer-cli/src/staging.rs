//! The surroundings of a model and effects of its light: floor, grid, axes, edges, occlusion.

use crate::failure::Failure;
use crate::options::ViewArgs;
use crate::values;
use clap::{Args, ValueEnum};
use durer::math::Vec4;
use durer::pipeline::{self, EdgeStyle, RenderOptions, add_axes, add_grid, add_ground};
use durer::scene::{AlphaMode, Camera, Material, Scene, ShadingModel};
use durer::target::Framebuffer;
use durer::view::fit;
use durer::view::projection::drawn_bounds;
use durer::visibility::surface::ambient_occlusion;
use durer::work::{Charge, Work};

/// Distance, as a part of the model's radius, within which surfaces occlude each other.
const OCCLUSION_RADIUS: f64 = 0.25;

/// Options for the stage.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Stage")]
pub struct StageArgs {
    /// A set of the options below
    #[arg(long, value_name = "NAME", default_value = "plain")]
    pub look: Look,
    /// Darken places that little ambient light reaches, by this strength from 0 to 1 [default without a
    /// number: 0.8]
    #[arg(long, value_name = "STRENGTH", num_args = 0..=1, require_equals = true, default_missing_value = "0.8", value_parser = strength)]
    pub ambient_occlusion: Option<f64>,
    /// Add a soft shadow on the floor under the model
    #[arg(long)]
    pub ground: bool,
    /// Draw exact visible outlines, creases and borders over the picture, this many pixels wide
    /// [default without a number: 1.5]
    #[arg(long, value_name = "PIXELS", num_args = 0..=1, require_equals = true, default_missing_value = "1.5", value_parser = values::pixels)]
    pub edges: Option<f64>,
    /// Add a grid on the floor; its lines are 1, 2 or 5 times a power of ten apart
    #[arg(long)]
    pub grid: bool,
    /// Add the axes of the world: x red, y green, z blue
    #[arg(long)]
    pub axes: bool,
}

/// `--look`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Look {
    /// The materials in plain light
    Plain,
    /// With a shadow on the floor and occlusion
    Studio,
    /// All surfaces of one matte clay, with a shadow on the floor and occlusion
    Clay,
    /// All surfaces nearly white, with edges
    Technical,
}

fn strength(text: &str) -> Result<f64, String> {
    let value = values::not_negative(text)?;
    if value <= 1.0 { Ok(value) } else { Err("it is a part of the light, 0 to 1".to_owned()) }
}

impl StageArgs {
    fn has_studio(&self) -> bool {
        matches!(self.look, Look::Studio | Look::Clay)
    }

    fn occlusion(&self) -> Option<f64> {
        self.ambient_occlusion.or(self.has_studio().then_some(0.8))
    }

    fn edges(&self) -> Option<f64> {
        self.edges.or((self.look == Look::Technical).then_some(1.5))
    }

    /// Returns whether edges are drawn over the picture.
    pub fn has_edges(&self) -> bool {
        self.edges().is_some()
    }

    /// Returns whether the picture is darkened by occlusion.
    pub fn has_occlusion(&self) -> bool {
        self.occlusion().is_some()
    }

    /// Returns whether an option needs the whole model.
    pub fn needs_model(&self) -> bool {
        self.has_ground() || self.grid || self.axes || self.has_edges() || self.has_occlusion()
    }

    fn has_ground(&self) -> bool {
        self.ground || self.has_studio()
    }
}

/// Assigns the material of the look, if it has one, to all surfaces, in its own colour or the one requested.
pub fn give_materials(args: &StageArgs, requested: Option<Vec4>, scene: &mut Scene) {
    let (color, roughness) = match args.look {
        Look::Plain | Look::Studio => return,
        Look::Clay => (Vec4::new(0.62, 0.52, 0.44, 1.0), 0.9),
        Look::Technical => (Vec4::new(0.9, 0.9, 0.9, 1.0), 1.0),
    };
    let color = requested.unwrap_or(color);
    let alpha_mode = if color.w < 1.0 { AlphaMode::Blend } else { AlphaMode::Opaque };
    for material in &mut scene.materials {
        *material = Material {
            name: std::mem::take(&mut material.name),
            model: ShadingModel::MetallicRoughness,
            base_color: color,
            alpha_mode,
            roughness,
            double_sided: material.double_sided,
            ..Material::default()
        };
    }
    for mesh in &mut scene.meshes {
        mesh.colors.clear();
    }
    scene.give_material(Material {
        model: ShadingModel::MetallicRoughness,
        base_color: color,
        alpha_mode,
        roughness,
        ..Material::default()
    });
}

/// A model with its surroundings: floor, grid and axes.
pub struct Staged {
    /// Scene that the view is fitted to: all but the shadow on the floor, which fades out.
    pub framed: Scene,
    /// All of it.
    pub whole: Scene,
    /// Memory of both.
    _charge: Charge,
}

/// Returns the scene with the surroundings of the model; `None` if there are none.
pub fn staged(args: &StageArgs, scene: &Scene, work: &Work) -> Result<Option<Staged>, Failure> {
    if !(args.has_ground() || args.grid || args.axes) {
        return Ok(None);
    }
    let Some(model) = drawn_bounds(scene) else { return Ok(None) };
    let charge = work.charge("copies of the model", scene.bytes().saturating_mul(2));
    let charge = charge.map_err(|e| Failure::of_library(&e))?;
    let mut framed = scene.clone();
    if args.grid {
        add_grid(&mut framed, &model);
    }
    if args.axes {
        add_axes(&mut framed, &model);
    }
    let mut whole = framed.clone();
    if args.has_ground() {
        let usage = |e: durer::Error| Failure::of_library(&e);
        add_ground(&mut whole, scene, &model).map_err(usage)?;
    }
    Ok(Some(Staged { framed, whole, _charge: charge }))
}

/// Returns the options of ambient occlusion for a model, if requested.
pub fn occlusion(args: &StageArgs, model: &Scene) -> Option<ambient_occlusion::Options> {
    let strength = args.occlusion().filter(|s| *s > 0.0)? as f32;
    let radius = model.bounding_sphere()?.radius * OCCLUSION_RADIUS;
    (radius > 0.0).then_some(ambient_occlusion::Options { radius, strength })
}

/// Draws the edges of a model over its picture, if requested.
pub fn draw_edges(
    args: &StageArgs,
    model: &Scene,
    options: &RenderOptions,
    picture: &mut Framebuffer,
) -> Result<(), Failure> {
    let Some(width) = args.edges() else { return Ok(()) };
    let style = EdgeStyle { width, ..EdgeStyle::default() };
    pipeline::draw_edges(model, options, &style, picture).map_err(|e| Failure::of_library(&e))
}

/// Moves the near and far planes of a fitted camera, so that the surroundings of the model are between them.
pub fn with_depths(view: &ViewArgs, camera: &Camera, staged: &Scene) -> Camera {
    let (near, far) = fit::depth_range(camera, staged);
    let fitted = view.camera.is_none();
    Camera {
        near: if fitted && view.near.is_none() { near } else { camera.near },
        far: if fitted && view.far.is_none() { far } else { camera.far },
        ..*camera
    }
}
