//! The section: the near plane cuts the body; a cap closes the cut where the inside is visible.

use crate::cube::{above, flat, quad, stencil};
use durer::commands::{Command, CullFace, ListId};
use durer::fragment::{Compare, FragmentState, StencilOp};
use durer::scene::Camera;

pub fn commands(cube: ListId, camera: &Camera) -> [Command; 11] {
    let plain = FragmentState::default();
    let cut = Camera { near: 5.6, ..*camera };
    let [side, top, back] = camera.axes().map(|a| a * 9.0);
    let plane = camera.eye - back * (5.61 / 9.0);
    [
        Command::LoadProjection(cut.clip_from_view(1.0)),
        Command::Cull(CullFace::Back),
        stencil(Compare::Always, StencilOp::Zero, plain),
        Command::Call(cube),
        Command::Cull(CullFace::Front),
        stencil(Compare::Always, StencilOp::Replace, plain),
        Command::Call(cube),
        Command::Cull(CullFace::None),
        stencil(Compare::Equal, StencilOp::Keep, above()),
        flat(0.8, 0.2, 0.15),
        quad([plane - side - top, plane + side - top, plane + side + top, plane - side + top]),
    ]
}
