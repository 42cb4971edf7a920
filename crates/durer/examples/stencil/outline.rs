//! The outline: the rim of a larger body around the body itself.

use crate::cube::{above, scale, stencil};
use durer::commands::{Command, ListId};
use durer::fragment::{Compare, FragmentState, StencilOp};
use durer::math::DVec3;

pub fn commands(cube: ListId, dark: ListId) -> [Command; 5] {
    [
        stencil(Compare::Always, StencilOp::Replace, FragmentState::default()),
        Command::Call(cube),
        stencil(Compare::NotEqual, StencilOp::Keep, above()),
        scale(DVec3::splat(1.06)),
        Command::Call(dark),
    ]
}
