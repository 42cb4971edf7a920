//! The scan-line z-buffer: one row of depth and colour.
//!
//! C. Wylie, G. Romney, D. Evans, A. Erdahl, *Half-Tone Perspective Drawings by Computer*, AFIPS
//! Fall Joint Computer Conference, 1967; L. Carpenter's form with a row of depths. Image space. Rows
//! are made from the top: triangles whose first row is reached join the active list, their left and
//! right ends advance by integer increments from row to row (edge coherence), and each span is
//! entered into the row of depths.
//!
//! Cost: O(n log n) for the order by first row, then O(rows crossed + covered pixels). Memory: the
//! triangles, the active list and one row; nothing grows with the picture's height but the
//! framebuffer itself. Coherence used: edges, from row to row. Limits: one opaque surface per pixel,
//! one sample; blended surfaces are kept in a list per pixel of the row and laid over by depth.

use crate::info::{Class, Coherence, Info, Occluder};
use crate::shade::{PreparedLights, PreparedMaterials};
use crate::target::Framebuffer;
use crate::trace::{PseudocodeLine, Tracer};
use crate::visibility::surface::input::{METHOD, SurfaceInput};
use crate::visibility::surface::layers::{Layers, write_row};
pub use crate::visibility::surface::picture::Options;
use crate::visibility::surface::picture::Picture;
use crate::visibility::surface::rows::active::ActiveList;
use crate::visibility::surface::rows::nearest::{DepthRow, Masked};

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "scan-line-z",
    title: "Scan-line z-buffer",
    authors: "C. Wylie, G. Romney, D. Evans, A. Erdahl; L. Carpenter",
    year: 1967,
    source: "Half-Tone Perspective Drawings by Computer, AFIPS Fall Joint Computer Conference",
    class: Class::ImageSpace,
    occluder: Occluder::Point,
    coherence: &[Coherence::Edge, Coherence::ScanLine, Coherence::Depth],
    cost: "O(n log n + rows crossed + covered pixels) time, O(n + width) memory, n triangles",
    limits: "one sample per pixel",
    pseudocode: &[
        "sort the triangles by their first row",
        "for each row y from the top:",
        "    depths of the row ← 1, items ← none",
        "    remove the triangles that end before y, move the edges of the others",
        "    add the triangles that begin at y",
        "    for each active triangle:",
        "        for each x from its left edge to its right edge:",
        "            z ← depth of its plane at (x, y)",
        "            if z < depth[x]:",
        "                depth[x] ← z, item[x] ← triangle",
        "    light and write the row",
    ],
};

/// Step of the algorithm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step {
    /// A row begins with an empty row of depths.
    Row {
        /// The row, from the top.
        y: i32,
    },
    /// A triangle joins the active list.
    Enter {
        /// Its item.
        item: u32,
    },
    /// A triangle's part of the row is compared with the stored depths.
    Span {
        /// Its item.
        item: u32,
        /// First column.
        x0: i32,
        /// The column after the last.
        x1: i32,
    },
    /// The triangle of the latest span is the nearest so far at a pixel.
    Write {
        /// Its item.
        item: u32,
        /// The column.
        x: i32,
        /// Its depth there.
        depth: f32,
    },
}

impl PseudocodeLine for Step {
    fn line(&self) -> usize {
        match self {
            Self::Row { .. } => 3,
            Self::Enter { .. } => 5,
            Self::Span { .. } => 7,
            Self::Write { .. } => 10,
        }
    }
}

/// Renders into the planes that the framebuffer has.
pub fn render(
    input: &SurfaceInput<'_>,
    lights: &PreparedLights,
    options: &Options,
    framebuffer: &mut Framebuffer,
    t: &mut impl Tracer<Step>,
) {
    let materials = PreparedMaterials::new(input.scene).with_ink(options.background.ink());
    let (width, rows) = (input.view.width(), input.view.window());
    let mut picture = Picture::new(input, &materials, lights, (options, 0), framebuffer);
    let masked = Masked::new(input);
    let mut list = ActiveList::new(&input.triangles, input.view);
    let mut row = DepthRow::new(width);
    let mut layers = Layers::of(input);
    let mut charge = input.work.charge(METHOD, 0).unwrap_or_default();
    for y in (rows.y0()..rows.y1()).take_while(|_| !input.work.is_stopped()) {
        t.step(|| Step::Row { y });
        input.work.advance(1);
        row.clear();
        let item = |triangle: u32| input.triangles[triangle as usize].item;
        let active = list.advance(y, |a| t.step(|| Step::Enter { item: item(a.triangle) }));
        for span in active.iter().filter(|a| a.x0 < a.x1) {
            let (item, x0, x1) = (item(span.triangle), span.x0, span.x1);
            t.step(|| Step::Span { item, x0, x1 });
            let wrote = |x, depth| t.step(|| Step::Write { item, x, depth });
            masked.enter(&mut row, span.triangle, [x0, x1], y, &mut picture.lit, wrote);
        }
        write_row(y, &row, active, &mut layers, &masked, &mut picture);
        charge.grow_to_or_stop(list.bytes());
    }
}
