//! The shape of a picture whose size leaves a side open: the shape of the model in the view.

use crate::camera::{self, Shot};
use crate::failure::Failure;
use crate::options::{PictureArgs, ViewArgs};
use crate::values::Size;
use durer::math::DVec2;
use durer::scene::Scene;
use durer::view::fit;
use durer::view::layout::Layout;

/// Shapes that are longer than this become this: a line has no height.
const LONGEST: f64 = 16.0;

/// Pixels along a side of a picture that is divided into viewports, to find their shape.
const TRIAL: u32 = 1 << 12;

/// Returns the width and height of a picture, up to a factor: square cells of viewports, the aspect ratio of
/// a camera of the file, the outline of a model that fills the view; else a square.
pub fn of_picture(picture: &PictureArgs, view: &ViewArgs, scene: &Scene) -> Result<DVec2, Failure> {
    match &picture.viewports {
        Some(layout) => Ok(of_layout(layout)),
        None => of_view(view, scene, picture.turntable),
    }
}

/// Returns columns and rows.
fn of_layout(layout: &Layout) -> DVec2 {
    let cells = layout.viewports(TRIAL, TRIAL).unwrap_or_default();
    cells.first().map_or(DVec2::ONE, |(_, viewport)| {
        let pixels = viewport.pixels();
        DVec2::new(f64::from(pixels.height()), f64::from(pixels.width()))
    })
}

/// Returns the shape of one view.
pub fn of_view(view: &ViewArgs, scene: &Scene, turntable: Option<u32>) -> Result<DVec2, Failure> {
    if let Some(name) = &view.camera {
        let camera = scene.cameras.iter().find(|c| c.name == *name);
        let aspect = camera.and_then(|c| c.aspect).filter(|a| a.is_finite() && *a > 0.0);
        return Ok(DVec2::new(bounded(aspect.unwrap_or(1.0)), 1.0));
    }
    if view.eye.is_some() {
        return Ok(DVec2::ONE);
    }
    let (mut aspect, side) = (1.0, 1 << 16);
    let turn = turntable.map(|count| (0, count));
    // Each view is fitted to the shape of the one before.
    for _ in 0..6 {
        let size = Size { width: (aspect * f64::from(side)) as u32, height: side };
        let shot = Shot { view: None, size, turn };
        let camera = camera::camera(view, scene, &shot)?;
        aspect = bounded(fit::aspect(&camera, scene, turn.is_some()));
    }
    Ok(DVec2::new(aspect, 1.0))
}

fn bounded(aspect: f64) -> f64 {
    if aspect > 0.0 { aspect.clamp(1.0 / LONGEST, LONGEST) } else { 1.0 }
}
