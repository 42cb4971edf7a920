//! The library's options for the pictures of `durer render`.

use crate::camera::{self, Shot};
use crate::failure::Failure;
use crate::options::Samples;
use crate::render_args::RenderArgs;
use crate::staging;
use crate::values::Algorithm;
use durer::pipeline::{Lighting, Marks, RenderOptions, SurfaceMethod};
use durer::scene::{Camera, Scene};
use durer::visibility::surface::a_buffer::SubpixelMask;

/// Returns the options for a picture, given the model, the part that the view is fitted to, and the whole scene.
pub fn render_options(
    args: &RenderArgs,
    [model, framed, scene]: [&Scene; 3],
    shot: &Shot,
    algorithm: Algorithm,
) -> Result<RenderOptions, Failure> {
    let camera = camera::camera(&args.view, framed, shot)?;
    let camera = match std::ptr::eq(framed, scene) {
        true => camera,
        false => staging::with_depths(&args.view, &camera, scene),
    };
    let ambient_occlusion = staging::occlusion(&args.stage, model);
    let options = picture_options(args, camera, shot, algorithm);
    Ok(RenderOptions { ambient_occlusion, ..options })
}

/// Returns the options for the picture from a camera.
pub fn picture_options(
    args: &RenderArgs,
    camera: Camera,
    shot: &Shot,
    algorithm: Algorithm,
) -> RenderOptions {
    let lighting = match &args.look.light[..] {
        [] => Lighting::Auto,
        lights => Lighting::Given(lights.to_vec()),
    };
    RenderOptions {
        algorithm: match algorithm {
            Algorithm::Surfaces(method) => method,
            Algorithm::Wireframe | Algorithm::All => SurfaceMethod::ZBuffer,
        },
        width: shot.size.width,
        height: shot.size.height,
        window: args.picture.tile,
        shading: args.look.shading.map(Into::into),
        lighting,
        exposure: args.look.exposure,
        surroundings: args.look.surroundings.get().cloned().unwrap_or_default(),
        tone_map: args.look.tone_map.into(),
        background: args.picture.background,
        cull: args.look.cull.into(),
        marks: Marks { line_width: args.look.line_width, point_size: args.look.point_size },
        samples: args.picture.aa.into(),
        mask: match args.picture.aa {
            Samples::SixtyFour => SubpixelMask::M64,
            _ => SubpixelMask::M16,
        },
        shadows: args.look.shadows.into(),
        shadow_map_side: args.look.shadow_map,
        bounces: args.look.bounces,
        depth: args.planes.depth.is_some(),
        item: args.planes.item.is_some(),
        normal: args.planes.normal.is_some(),
        max_pixels: args.picture.max_pixels,
        work: args.running.work.clone(),
        ..RenderOptions::new(camera)
    }
}
