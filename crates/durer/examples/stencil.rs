//! What a stencil is good for: an outline, a reflection in a plane, and a section with its cut closed.
//!
//! `cargo run --example stencil -- stencil.png`

use durer::commands::{Command, CullFace, DisplayLists, Pipeline, Primitive, Vertex, execute};
use durer::fragment::{Compare, FragmentState, Stencil, StencilFace, StencilOp};
use durer::math::{DMat4, DVec3, Vec4};
use durer::scene::{Camera, Projection};
use durer::target::Framebuffer;

fn quad(corners: [DVec3; 4]) -> Command {
    Command::Draw(Primitive::Polygon, corners.map(Vertex::from).into())
}

/// A cube from −1 to 1, its faces counter-clockwise from outside, coloured by their light.
fn colored_cube(color: impl Fn(f32) -> Vec4) -> Vec<Command> {
    let faces = DVec3::AXES.into_iter().enumerate().flat_map(|(k, axis)| [(k, axis), (k, -axis)]);
    faces
        .flat_map(|(k, n)| {
            let u = DVec3::AXES[(k + 1) % 3];
            let v = n.cross(u);
            let light = 0.35 + 0.25 * k as f32 + 0.1 * n.max_element() as f32;
            let color = Command::Color(color(light));
            [color, quad([n - u - v, n + u - v, n + u + v, n - u + v])]
        })
        .collect()
}

fn stencil(compare: Compare, pass: StencilOp, state: FragmentState) -> Command {
    let face = StencilFace { compare, reference: 1, pass, ..StencilFace::default() };
    Command::Fragments(FragmentState { stencil: Some(Stencil::both(face)), ..state })
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let (mut lists, mut target) =
        (DisplayLists::default(), Framebuffer::new(600, 200).with_depth().with_stencil());
    let (cube, plain) = (
        lists.record(colored_cube(|light| Vec4::new(light, light * 0.8, light * 0.4, 1.0))),
        FragmentState::default(),
    );
    let dark = lists.record(colored_cube(|_| Vec4::new(0.0, 0.02, 0.2, 1.0)));
    let above = FragmentState { depth: None, ..plain };
    let (eye, up, projection) =
        (DVec3::new(3.0, 2.6, 5.0), DVec3::Y, Projection::Perspective { fov_y: 0.8 });
    let camera =
        Camera { eye, target: DVec3::new(0.0, -0.2, 0.0), up, projection, near: 1.0, far: 20.0 };
    let scale = |s: DVec3| Command::MultiplyModelView(DMat4::from_scale(s));
    let at = |x| {
        [
            Command::Viewport(Some([x, 0, 200, 200])),
            Command::LoadModelView(camera.view_from_world()),
        ]
    };
    let mut c = vec![
        Command::Clear { color: Some(Vec4::ONE), depth: Some(1.0), stencil: Some(0) },
        Command::LoadProjection(camera.clip_from_view(1.0)),
    ];
    // The outline: where a larger body is beyond the body itself.
    let flat = |r, g, b| Command::Color(Vec4::new(r, g, b, 1.0));
    c.extend(at(0));
    c.extend([
        stencil(Compare::Always, StencilOp::Replace, plain),
        Command::Call(cube),
        stencil(Compare::NotEqual, StencilOp::Keep, above),
        scale(DVec3::splat(1.06)),
        Command::Call(dark),
    ]);
    // The reflection: drawn mirrored, only where the floor is.
    let floor = |y: f64| {
        quad([
            DVec3::new(-2.0, y, 2.0),
            DVec3::new(2.0, y, 2.0),
            DVec3::new(2.0, y, -2.0),
            DVec3::new(-2.0, y, -2.0),
        ])
    };
    c.extend(at(200));
    c.extend([
        stencil(Compare::Always, StencilOp::Replace, above),
        flat(0.75, 0.8, 0.85),
        floor(-1.0),
        Command::PushModelView,
    ]);
    c.extend([
        Command::MultiplyModelView(DMat4::from_translation(DVec3::Y * -2.0)),
        stencil(Compare::Equal, StencilOp::Keep, plain),
        scale(DVec3::new(1.0, -1.0, 1.0)),
        Command::Call(cube),
        Command::PopModelView,
    ]);
    c.extend([
        Command::Fragments(plain),
        Command::Clear { color: None, depth: Some(1.0), stencil: None },
        Command::Call(cube),
    ]);
    // The section: the near plane cuts the body; where its inside is seen, the cut is closed.
    c.extend(at(400));
    c.extend([
        Command::LoadProjection(Camera { near: 5.6, ..camera }.clip_from_view(1.0)),
        Command::Cull(CullFace::Back),
        stencil(Compare::Always, StencilOp::Zero, plain),
        Command::Call(cube),
    ]);
    c.extend([
        Command::Cull(CullFace::Front),
        stencil(Compare::Always, StencilOp::Replace, plain),
        Command::Call(cube),
        Command::Cull(CullFace::None),
    ]);
    let [side, top, back] = camera.axes().map(|a| a * 9.0);
    let plane = eye - back * (5.61 / 9.0);
    c.extend([
        stencil(Compare::Equal, StencilOp::Keep, above),
        flat(0.8, 0.2, 0.15),
        quad([plane - side - top, plane + side - top, plane + side + top, plane - side + top]),
    ]);
    execute(&c, &lists, &mut Pipeline::default(), &mut target)?;
    let path = std::env::args().nth(1).unwrap_or_else(|| "stencil.png".into());
    Ok(durer_formats::png::write_color(
        std::fs::File::create(path)?,
        &target.color,
        Default::default(),
    )?)
}
