//! The reflection: drawn mirrored, only where the floor is.

use crate::cube::{above, flat, quad, scale, stencil};
use durer::commands::{Command, ListId};
use durer::fragment::{Compare, FragmentState, StencilOp};
use durer::math::{DMat4, DVec3};

pub fn commands(cube: ListId) -> [Command; 12] {
    let plain = FragmentState::default();
    let corners = [(-2.0, 2.0), (2.0, 2.0), (2.0, -2.0), (-2.0, -2.0)];
    [
        stencil(Compare::Always, StencilOp::Replace, above()),
        flat(0.75, 0.8, 0.85),
        quad(corners.map(|(x, z)| DVec3::new(x, -1.0, z))),
        Command::PushModelView,
        Command::MultiplyModelView(DMat4::from_translation(DVec3::Y * -2.0)),
        stencil(Compare::Equal, StencilOp::Keep, plain),
        scale(DVec3::new(1.0, -1.0, 1.0)),
        Command::Call(cube),
        Command::PopModelView,
        Command::Fragments(plain),
        Command::Clear { color: None, depth: Some(1.0), stencil: None, index: None },
        Command::Call(cube),
    ]
}
