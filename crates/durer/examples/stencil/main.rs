//! Uses of a stencil: an outline, a reflection in a plane, and a section with a closed cut.
//!
//! `cargo run --example stencil -- stencil.png`

mod cube;
mod outline;
mod reflection;
mod section;

use durer::commands::{Command, DisplayLists, Pipeline, execute};
use durer::math::{DVec3, Vec4};
use durer::scene::{Camera, Projection};
use durer::target::Framebuffer;

const SIDE: u32 = 200;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut lists = DisplayLists::default();
    let light = |light| Vec4::new(light, light * 0.8, light * 0.4, 1.0);
    let cube = lists.record(cube::colored(light));
    let dark = lists.record(cube::colored(|_| Vec4::new(0.0, 0.02, 0.2, 1.0)));
    let camera = Camera {
        eye: DVec3::new(3.0, 2.6, 5.0),
        target: DVec3::new(0.0, -0.2, 0.0),
        up: DVec3::Y,
        projection: Projection::Perspective { fov_y: 0.8 },
        near: 1.0,
        far: 20.0,
    };
    let white = Some(Vec4::ONE);
    let mut commands = vec![
        Command::Clear { color: white, depth: Some(1.0), stencil: Some(0), index: None },
        Command::LoadProjection(camera.clip_from_view(1.0)),
    ];
    let pictures = [
        outline::commands(cube, dark).to_vec(),
        reflection::commands(cube).to_vec(),
        section::commands(cube, &camera).to_vec(),
    ];
    for (x, picture) in (0..).step_by(SIDE as usize).zip(pictures) {
        commands.push(Command::Viewport(Some([x, 0, SIDE, SIDE])));
        commands.push(Command::LoadModelView(camera.view_from_world()));
        commands.extend(picture);
    }
    let mut target = Framebuffer::new(3 * SIDE, SIDE).with_depth().with_stencil();
    execute(&commands, &lists, &mut Pipeline::default(), &mut target)?;
    let path = std::env::args().nth(1).unwrap_or_else(|| "stencil.png".into());
    let file = std::fs::File::create(path)?;
    Ok(durer_formats::png::write_color(file, &target.color, Default::default())?)
}
