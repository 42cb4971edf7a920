//! The body drawn, and the commands that all three pictures use.

use durer::commands::{Command, CornerVertex, Primitive};
use durer::fragment::{Compare, FragmentState, Stencil, StencilFace, StencilOp};
use durer::math::{DMat4, DVec3, Vec4};

pub fn quad(corners: [DVec3; 4]) -> Command {
    Command::Draw(Primitive::Polygon, corners.map(CornerVertex::from).into())
}

/// Returns a cube from −1 to 1, its faces counter-clockwise from outside, coloured by their light.
pub fn colored(color: impl Fn(f32) -> Vec4) -> Vec<Command> {
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

/// Compares the stencil with 1 and does `pass` where both tests pass.
pub fn stencil(compare: Compare, pass: StencilOp, state: FragmentState) -> Command {
    let face = StencilFace { compare, reference: 1, pass, ..StencilFace::default() };
    Command::Fragments(FragmentState { stencil: Some(Stencil::both(face)), ..state })
}

/// No depth test: drawn over the picture so far.
pub fn above() -> FragmentState {
    FragmentState { depth: None, ..FragmentState::default() }
}

pub fn flat(r: f32, g: f32, b: f32) -> Command {
    Command::Color(Vec4::new(r, g, b, 1.0))
}

pub fn scale(s: DVec3) -> Command {
    Command::MultiplyModelView(DMat4::from_scale(s))
}
