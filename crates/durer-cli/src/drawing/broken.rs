//! `--break`: views without the part between two places on an axis.

use super::sheet::Shot;
use crate::failure::Failure;
use crate::kind::Kind;
use crate::render_args::RenderArgs;
use durer::paper::Breaks;
use durer::scene::{Camera, Projection, Scene};
use durer_formats::drawing::DrawingFormat;

/// Refuses combinations of options that the parser accepts separately.
pub fn check(args: &RenderArgs, kind: Kind) -> Result<(), Failure> {
    let message = match kind {
        _ if args.drawing.breaks.is_empty() => return Ok(()),
        Kind::Drawing(DrawingFormat::GeoJson) => {
            "GeoJSON has the places of the model; leave it out"
        }
        _ if args.picture.turntable.is_some() => {
            "a turntable shows all sides; leave one of the two out"
        }
        _ => return Ok(()),
    };
    Err(Failure::Usage(format!("--break: {message}")))
}

/// Returns the breaks of a model in views of it. Those in perspective are refused, and breaks that no view
/// shows are noted.
pub fn breaks(
    args: &RenderArgs,
    scene: &Scene,
    shots: &[Shot],
    notes: &mut Vec<String>,
) -> Result<Breaks, Failure> {
    let Some(bounds) = scene.bounds().filter(|_| !args.drawing.breaks.is_empty()) else {
        return Ok(Breaks::default());
    };
    let is_perspective = |s: &Shot| matches!(s.camera.projection, Projection::Perspective { .. });
    if shots.iter().any(is_perspective) {
        let message =
            "--break: in perspective no length is shown truly; leave out --fov, --eye or --camera";
        return Err(Failure::Usage(message.to_owned()));
    }
    for one in &args.drawing.breaks {
        if !shots.iter().any(|s| one.is_seen_by(&s.camera)) {
            let axis = one.axis_name();
            notes.push(format!(
                "--break {one}: no view shows {axis} in its true length, so nothing is left out; give e.g. --view {}",
                if axis == "z" { "front" } else { "top" }
            ));
        }
    }
    let cameras: Vec<Camera> = shots.iter().map(|s| s.camera).collect();
    let breaks = Breaks::new(&args.drawing.breaks, bounds, &cameras);
    breaks.map_err(|e| Failure::Usage(format!("--{e}")))
}
