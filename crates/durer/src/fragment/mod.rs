//! The operations on a fragment between the rasterizer and the framebuffer, in this order: scissor and
//! mask → alpha test → stencil → depth → blending → dithering → logic operation → write masks.
//!
//! A framebuffer with a plane of colour indices takes a fragment's index in the place of its colour:
//! scissor and mask → stencil → depth → dithering → logic operation → write mask; there is no alpha to
//! test and nothing to blend. A [`Palette`] makes colours of indices.
//!
//! Definitions: *The OpenGL Graphics System* 4.6 (2017), chapter 17, and 2.1 (2006), chapter 4, for the
//! alpha test and colour indices. Only [`apply`] knows the order.

mod alpha_test;
mod blend;
mod color_index;
mod compare;
mod depth;
mod dither;
pub mod fog;
pub mod halftone;
mod logic_op;
mod pixel_mask;
mod scissor;
mod stencil;
mod step;
mod write_mask;

pub use alpha_test::AlphaTest;
pub use blend::{Blend, Equation, Factor, Function, over_premultiplied, over_straight};
pub use color_index::Palette;
pub use compare::Compare;
pub use depth::{DepthRange, PolygonOffset};
pub use dither::{BAYER8, Dither};
pub use logic_op::LogicOp;
pub use pixel_mask::PixelMask;
pub use scissor::Scissor;
pub use stencil::{Stencil, StencilFace, StencilOp};
pub use step::{INFO, Step, replay};
pub use write_mask::WriteMask;

use crate::math::Vec4;
use crate::shade::color::{decode_rgba8, encode_rgba8};
use crate::target::{Framebuffer, Pixels};
use crate::trace::{NoTrace, Tracer};

/// One candidate for a pixel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fragment {
    /// Column.
    pub x: u32,
    /// Row, in the framebuffer's own order.
    pub y: u32,
    /// Window depth at the sample, 0 (near) … 1 (far).
    pub depth: f32,
    /// Colour: linear RGBA, straight alpha; ignored in a colour-index framebuffer.
    pub color: Vec4,
    /// Colour index, fractions allowed; used in a colour-index framebuffer only.
    pub index: f32,
    /// True if the face is seen from its front; true for points and lines.
    pub front_facing: bool,
    /// Number of the drawn item, for the item plane.
    pub item: u32,
    /// Unit normal in world space, for the normal plane.
    pub normal: [f32; 3],
}

/// The state of all fragment operations.
///
/// The default draws everything nearer than the stored depth, unblended, and writes all planes. (OpenGL's own initial
/// state has no depth test.)
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FragmentState {
    /// `None` = the whole framebuffer.
    pub scissor: Option<Scissor>,
    /// `None` = no alpha test.
    pub alpha_test: Option<AlphaTest>,
    /// `None` = no stencil test; needs a stencil plane.
    pub stencil: Option<Stencil>,
    /// `None` = no depth test, and depth is not written; needs a depth plane.
    pub depth: Option<Compare>,
    /// `None` = the fragment replaces the stored colour.
    pub blend: Option<Blend>,
    /// `None` = colours are rounded.
    pub dither: Option<Dither>,
    /// `None` = no logic operation. With one, there is no blending.
    pub logic_op: Option<LogicOp>,
    /// Planes and channels that may be written.
    pub write_mask: WriteMask,
}

impl Default for FragmentState {
    fn default() -> Self {
        Self {
            scissor: None,
            alpha_test: None,
            stencil: None,
            depth: Some(Compare::Less),
            blend: None,
            dither: None,
            logic_op: None,
            write_mask: WriteMask::default(),
        }
    }
}

/// Stage at which a fragment ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Outcome {
    /// Outside the framebuffer, the scissor rectangle or the mask.
    Scissor,
    /// Dropped by the alpha test.
    AlphaTest,
    /// Dropped by the stencil test.
    Stencil,
    /// Dropped by the depth test.
    Depth,
    /// Passed all tests; the write masks decide which planes were written.
    Drawn,
}

/// Passes one fragment through all operations. A plane that the framebuffer does not have passes its test. Cost: O(1).
pub fn apply(state: &FragmentState, fragment: Fragment, target: &mut Framebuffer) -> Outcome {
    apply_traced(state, fragment, target, &mut NoTrace)
}

/// Applies a fragment as [`apply`] does, with a tracer.
pub fn apply_traced(
    state: &FragmentState,
    fragment: Fragment,
    target: &mut Framebuffer,
    t: &mut impl Tracer<Step>,
) -> Outcome {
    let (x, y) = (fragment.x, fragment.y);
    let inside = state.scissor.is_none_or(|s| s.contains(x, y));
    let stored = target.color.get(x, y).filter(|_| inside);
    t.step(|| Step::Scissor { fragment, passes: stored.is_some() });
    let Some(stored) = stored else { return Outcome::Scissor };
    let has_alpha = target.index.is_none();
    if let Some(test) = state.alpha_test.filter(|_| has_alpha) {
        let (alpha, reference) = (fragment.color.w, test.reference.clamp(0.0, 1.0));
        let passes = test.passes(alpha);
        t.step(|| Step::Alpha { alpha, reference, passes });
        if !passes {
            return Outcome::AlphaTest;
        }
    }
    let near = passes_depth(state, &fragment, target);
    if !passes_stencil(state, &fragment, near, target, t) {
        return Outcome::Stencil;
    }
    if state.depth.is_some() {
        let plane = target.depth.as_ref().and_then(|plane| plane.get(x, y));
        if let Some(stored) = plane {
            t.step(|| Step::Depth { depth: fragment.depth, stored, passes: near });
        }
    }
    if !near {
        return Outcome::Depth;
    }
    write_depth(state, &fragment, target);
    let (mut color, mut index) = (None, None);
    match &mut target.index {
        Some(plane) => index = write_index(state, &fragment, plane),
        None => {
            let code = written_color(state, &fragment, stored, t);
            target.color.set(x, y, code);
            color = Some(code);
        }
    }
    let writes_depth = state.write_mask.depth && state.depth.is_some() && target.depth.is_some();
    t.step(|| Step::Write { color, index, depth: writes_depth.then_some(fragment.depth) });
    Outcome::Drawn
}

/// Returns the content of the colour plane after a fragment that passed all tests.
fn written_color(
    state: &FragmentState,
    fragment: &Fragment,
    stored: [u8; 4],
    t: &mut impl Tracer<Step>,
) -> [u8; 4] {
    let color = blended(state, fragment.color, stored, t);
    let code = match state.dither {
        Some(dither) => dither.apply(color, fragment.x, fragment.y),
        None => encode_rgba8(color),
    };
    let code = match state.logic_op {
        Some(op) => std::array::from_fn(|i| op.apply(code[i], stored[i])),
        None => code,
    };
    state.write_mask.color(code, stored)
}

/// Writes the index and returns the plane's new value.
fn write_index(state: &FragmentState, fragment: &Fragment, plane: &mut Pixels<u8>) -> Option<u8> {
    let (x, y) = (fragment.x, fragment.y);
    let stored = plane.get(x, y).unwrap_or(0);
    let index = match state.dither {
        Some(dither) => dither.index(fragment.index, x, y),
        None => color_index::rounded(fragment.index),
    };
    let index = state.logic_op.map_or(index, |op| op.apply(index, stored));
    let index = state.write_mask.index(index, stored);
    plane.set(x, y, index);
    plane.get(x, y)
}

/// Applies a fragment as [`apply`] does, within a mask: pixels outside of it fail as at the scissor rectangle.
pub fn apply_within(
    mask: &PixelMask,
    state: &FragmentState,
    fragment: Fragment,
    target: &mut Framebuffer,
) -> Outcome {
    if mask.contains(fragment.x, fragment.y) {
        apply(state, fragment, target)
    } else {
        Outcome::Scissor
    }
}

fn passes_depth(state: &FragmentState, fragment: &Fragment, target: &Framebuffer) -> bool {
    let stored = target.depth.as_ref().and_then(|plane| plane.get(fragment.x, fragment.y));
    match (state.depth, stored) {
        (Some(compare), Some(stored)) => compare.passes(fragment.depth, stored),
        _ => true,
    }
}

/// Returns whether the fragment passes the stencil test; updates the stored value by the operation that applies.
fn passes_stencil(
    state: &FragmentState,
    fragment: &Fragment,
    near: bool,
    target: &mut Framebuffer,
    t: &mut impl Tracer<Step>,
) -> bool {
    let (Some(stencil), Some(plane)) = (state.stencil, target.stencil.as_mut()) else {
        return true;
    };
    let Some(stored) = plane.get(fragment.x, fragment.y) else { return true };
    let face = stencil.face(fragment.front_facing);
    let passes = face.passes(stored);
    let new = face.operation(passes, near).apply(stored, face.reference);
    let new = state.write_mask.stencil(fragment.front_facing, new, stored);
    plane.set(fragment.x, fragment.y, new);
    t.step(|| Step::Stencil { stored, reference: face.reference, passes, new });
    passes
}

/// Writes depth, item and normal of the fragment that is now nearest.
fn write_depth(state: &FragmentState, fragment: &Fragment, target: &mut Framebuffer) {
    fn put<T: Copy>(plane: &mut Option<Pixels<T>>, x: u32, y: u32, value: T) {
        if let Some(plane) = plane {
            plane.set(x, y, value);
        }
    }
    if !state.write_mask.depth {
        return;
    }
    if state.depth.is_some() {
        put(&mut target.depth, fragment.x, fragment.y, fragment.depth);
    }
    put(&mut target.item, fragment.x, fragment.y, fragment.item);
    put(&mut target.normal, fragment.x, fragment.y, fragment.normal);
}

fn blended(
    state: &FragmentState,
    source: Vec4,
    stored: [u8; 4],
    t: &mut impl Tracer<Step>,
) -> Vec4 {
    match state.blend {
        Some(blend) if state.logic_op.is_none() => {
            let stored = decode_rgba8(stored);
            let result = blend.apply(source, stored);
            t.step(|| Step::Blend { source, stored, result });
            result
        }
        _ => source,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fragment(depth: f32) -> Fragment {
        Fragment {
            x: 1,
            y: 1,
            depth,
            color: Vec4::new(1.0, 0.0, 0.0, 0.5),
            index: 5.5,
            front_facing: true,
            item: 7,
            normal: [0.0, 0.0, 1.0],
        }
    }

    fn target() -> Framebuffer {
        Framebuffer::new(3, 3).with_depth().with_items().with_normals().with_stencil()
    }

    fn stencil_at(target: &Framebuffer) -> Option<u8> {
        target.stencil.as_ref().and_then(|s| s.get(1, 1))
    }

    #[test]
    fn the_nearer_fragment_wins_and_the_first_of_equals() {
        let mut t = target();
        let state = FragmentState::default();
        assert_eq!(apply(&state, fragment(0.5), &mut t), Outcome::Drawn);
        assert_eq!(apply(&state, Fragment { item: 8, ..fragment(0.5) }, &mut t), Outcome::Depth);
        assert_eq!(apply(&state, Fragment { item: 9, ..fragment(0.6) }, &mut t), Outcome::Depth);
        assert_eq!(t.item.as_ref().and_then(|p| p.get(1, 1)), Some(7));
        assert_eq!(t.depth.as_ref().and_then(|p| p.get(1, 1)), Some(0.5));
        assert_eq!(t.normal.as_ref().and_then(|p| p.get(1, 1)), Some([0.0, 0.0, 1.0]));
        assert_eq!(t.color.get(1, 1), Some([255, 0, 0, 128]));
        assert_eq!(t.color.data().iter().filter(|c| **c != [0; 4]).count(), 1);
    }

    #[test]
    fn tests_come_in_their_order() {
        // Every test would drop the fragment: the first one in the order does.
        let never = Compare::Never;
        let face = StencilFace { compare: never, fail: StencilOp::Invert, ..Default::default() };
        let mut state = FragmentState {
            scissor: Some(Scissor { x0: 0, y0: 0, x1: 1, y1: 1 }),
            alpha_test: Some(AlphaTest { compare: never, reference: 0.0 }),
            stencil: Some(Stencil::both(face)),
            depth: Some(never),
            ..FragmentState::default()
        };
        let mut t = target();
        assert_eq!(apply(&state, fragment(0.0), &mut t), Outcome::Scissor);
        state.scissor = None;
        assert_eq!(apply(&state, fragment(0.0), &mut t), Outcome::AlphaTest);
        state.alpha_test = None;
        assert_eq!(stencil_at(&t), Some(0));
        assert_eq!(apply(&state, fragment(0.0), &mut t), Outcome::Stencil);
        assert_eq!(stencil_at(&t), Some(255));
        state.stencil = None;
        assert_eq!(apply(&state, fragment(0.0), &mut t), Outcome::Depth);
        assert_eq!(t.color, Framebuffer::new(3, 3).color);
        state.depth = None;
        assert_eq!(apply(&state, fragment(0.25), &mut t), Outcome::Drawn);
        // Without a depth test no depth is written, whatever the mask.
        assert_eq!(t.depth.as_ref().and_then(|p| p.get(1, 1)), Some(1.0));
        let outside = Fragment { x: 3, ..fragment(0.0) };
        assert_eq!(apply(&state, outside, &mut t), Outcome::Scissor);
    }

    #[test]
    fn the_stencil_counts_by_face_and_by_depth() {
        let count = |pass, depth_fail| StencilFace { pass, depth_fail, ..Default::default() };
        let state = FragmentState {
            stencil: Some(Stencil {
                front: count(StencilOp::IncrementWrap, StencilOp::Keep),
                back: count(StencilOp::Keep, StencilOp::DecrementWrap),
            }),
            ..FragmentState::default()
        };
        let mut t = target();
        apply(&state, fragment(0.5), &mut t);
        assert_eq!(stencil_at(&t), Some(1));
        apply(&state, Fragment { front_facing: false, ..fragment(0.9) }, &mut t);
        apply(&state, Fragment { front_facing: false, ..fragment(0.9) }, &mut t);
        assert_eq!(stencil_at(&t), Some(255));
    }

    #[test]
    fn colours_are_blended_in_linear_light_then_written_through_the_mask() {
        let mut t = target();
        t.color.set(1, 1, [0, 0, 255, 255]);
        let mut state = FragmentState { blend: Some(Blend::Over), ..FragmentState::default() };
        state.write_mask.color[3] = false;
        state.write_mask.depth = false;
        assert_eq!(apply(&state, fragment(0.5), &mut t), Outcome::Drawn);
        // Half the light of 255 is code 188.
        assert_eq!(t.color.get(1, 1), Some([188, 0, 188, 255]));
        assert_eq!(t.depth.as_ref().and_then(|p| p.get(1, 1)), Some(1.0));
    }

    #[test]
    fn a_logic_operation_takes_the_place_of_blending() {
        let mut t = target();
        let state = FragmentState {
            blend: Some(Blend::Over),
            logic_op: Some(LogicOp::Xor),
            depth: None,
            ..FragmentState::default()
        };
        let before = t.color.clone();
        apply(&state, fragment(0.5), &mut t);
        assert_eq!(t.color.get(1, 1), Some([255, 0, 0, 128]));
        apply(&state, fragment(0.5), &mut t);
        assert_eq!(t.color, before);
    }

    fn index_at(target: &Framebuffer) -> Option<u8> {
        target.index.as_ref().and_then(|plane| plane.get(1, 1))
    }

    #[test]
    fn an_index_takes_the_colours_place() {
        let never = AlphaTest { compare: Compare::Never, reference: 0.0 };
        let mut state = FragmentState {
            alpha_test: Some(never),
            blend: Some(Blend::Over),
            ..FragmentState::default()
        };
        let mut t = target().with_indices();
        assert_eq!(apply(&state, fragment(0.5), &mut t), Outcome::Drawn);
        assert_eq!(index_at(&t), Some(6), "rounded; no alpha to be tested, nothing blended");
        assert_eq!(t.color, Framebuffer::new(3, 3).color, "colours come from the palette alone");
        assert_eq!(t.depth.as_ref().and_then(|p| p.get(1, 1)), Some(0.5));
        let behind = Fragment { index: 9.0, ..fragment(0.6) };
        assert_eq!(apply(&state, behind, &mut t), Outcome::Depth);
        assert_eq!(index_at(&t), Some(6));
        state.stencil = Some(Stencil::both(StencilFace {
            compare: Compare::Equal,
            reference: 1,
            ..Default::default()
        }));
        assert_eq!(apply(&state, fragment(0.1), &mut t), Outcome::Stencil);
        state.scissor = Some(Scissor { x0: 0, y0: 0, x1: 1, y1: 1 });
        assert_eq!(apply(&state, fragment(0.1), &mut t), Outcome::Scissor);
    }

    #[test]
    fn indices_are_combined_then_written_through_their_mask() {
        let at = |index, state: &FragmentState, t: &mut Framebuffer| {
            apply(state, Fragment { index, ..fragment(0.5) }, t);
            index_at(t).map(u32::from)
        };
        let mut state = FragmentState { depth: None, ..FragmentState::default() };
        let mut t = target().with_indices();
        assert_eq!(at(f32::from(0b0101_0101_u8), &state, &mut t), Some(0b0101_0101));
        state.logic_op = Some(LogicOp::Xor);
        assert_eq!(at(f32::from(0b1111_0000_u8), &state, &mut t), Some(0b1010_0101));
        state.write_mask.index = 0b0000_1111;
        assert_eq!(at(f32::from(0xff_u8), &state, &mut t), Some(0b1010_1010));
        state.logic_op = None;
        assert_eq!(at(0.0, &state, &mut t), Some(0b1010_0000));
    }

    #[test]
    fn dithered_indices_have_the_right_mean() {
        let state = FragmentState { dither: Some(Dither::default()), ..FragmentState::default() };
        for (index, expected) in [(5.25, 16), (5.75, 48), (5.0, 0), (5.5, 32)] {
            let mut t = Framebuffer::new(8, 8).with_indices();
            for (x, y) in (0..8).flat_map(|y| (0..8).map(move |x| (x, y))) {
                apply(&state, Fragment { x, y, index, ..fragment(0.5) }, &mut t);
            }
            let count = |i: u8| t.index.iter().flat_map(|p| p.data()).filter(|d| **d == i).count();
            assert_eq!((count(5), count(6)), (64 - expected, expected), "{index}");
        }
    }
}
