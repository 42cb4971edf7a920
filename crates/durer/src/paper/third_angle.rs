//! Four views of a thing on one sheet, in third-angle projection (ISO 5456-2): the top view stands over
//! the front view, the view from the right stands right of it, and an axonometric view fills the corner.

use super::title_block::{self, TitleBlock};
use super::{LaidOut, Options, Page, Placed, Scale, put};
use crate::Result;
use crate::math::{DVec2, Rect};
use crate::target::drawing::Drawing;
use crate::target::sheet::Sheet;

/// Parallel views of one thing at one scale, with the same point of it at the origin of their planes.
#[derive(Debug, Clone, Copy)]
pub struct Views<'a> {
    /// From the front.
    pub front: &'a Drawing,
    /// From above, the front at the bottom.
    pub top: &'a Drawing,
    /// From the right.
    pub right: &'a Drawing,
    /// From the front, the right and above.
    pub iso: &'a Drawing,
}

/// The least space around a view, millimetres.
const GAP: f64 = 10.0;

/// The paper where none is asked for: A4.
const PAGE: Page = Page::Either(DVec2::new(210.0, 297.0));

/// Where the views go, in model units: extents of columns (left, right) and rows (upper, lower).
struct Cells {
    /// The left column, on the x axes of front and top view.
    left: (f64, f64),
    /// The lower row, on the y axes of front and right view.
    lower: (f64, f64),
    right: f64,
    upper: f64,
}

/// Lays the views onto a sheet, aligned, at one scale, with a frame and a title block.
///
/// Without a page it is A4, or as large as a given scale needs.
///
/// # Errors
/// As [`super::lay_out`].
pub fn third_angle(views: &Views, title: &TitleBlock, options: &Options) -> Result<LaidOut> {
    options.check()?;
    let bounds = |d: &Drawing| super::frame_of(d, super::Frame::Content);
    let [front, top, right, iso] = [views.front, views.top, views.right, views.iso].map(bounds);
    let cells = Cells {
        left: (front.min().x.min(top.min().x), front.max().x.max(top.max().x)),
        lower: (front.min().y.min(right.min().y), front.max().y.max(right.max().y)),
        right: right.size().x.max(iso.size().x),
        upper: top.size().y.max(iso.size().y),
    };
    let extent = |range: (f64, f64)| range.1 - range.0;
    let size = DVec2::new(extent(cells.left) + cells.right, extent(cells.lower) + cells.upper);
    let border = DVec2::splat(2.0 * options.margin);
    let taken =
        border + DVec2::splat(3.0 * (GAP + options.around)) + DVec2::new(0.0, title_block::HEIGHT);
    let free = matches!((options.page, options.scale), (Page::Fit, Scale::Fit | Scale::Standard));
    let paged = if free { Options { page: PAGE, ..*options } } else { *options };
    let (page, scale) = paged.page_and_scale(size, taken)?;
    let factor = scale * options.unit;
    // What is left over is shared out around the views.
    let gap = (page - border - DVec2::new(0.0, title_block::HEIGHT) - size * factor) / 3.0;
    let corner = DVec2::splat(options.margin) + gap;
    let column = corner.x + extent(cells.left) * factor + gap.x;
    let row = corner.y + cells.upper * factor + gap.y;
    // The origins of the planes: x of front and top, y of front and right are the same.
    let x = corner.x - cells.left.0 * factor;
    let y = row + cells.lower.1 * factor;
    let centered = |b: &Rect, at: DVec2, room: DVec2| {
        let middle = (b.min() + b.max()) * 0.5;
        at + room * 0.5 - DVec2::new(middle.x, -middle.y) * factor
    };
    let upper_room = DVec2::new(cells.right, cells.upper) * factor;
    let placed = [
        Placed { drawing: views.front, origin: DVec2::new(x, y) },
        // As low as it can, next to the front view.
        Placed { drawing: views.top, origin: DVec2::new(x, row - gap.y + top.min().y * factor) },
        Placed { drawing: views.right, origin: DVec2::new(column - right.min().x * factor, y) },
        Placed {
            drawing: views.iso,
            origin: centered(&iso, DVec2::new(column, corner.y), upper_room),
        },
    ];
    let mut sheet = Sheet {
        title: title.name.clone(),
        size: page,
        background: options.background,
        ..Sheet::default()
    };
    put(&mut sheet, &placed, factor, options);
    title_block::put(&mut sheet, title, scale, options);
    let names = ["front", "top", "right", "iso"].into_iter().zip([front, top, right, iso]);
    let views = names
        .zip(&placed)
        .map(|((name, bounds), p)| super::PlacedView::new(name, None, bounds, p.origin, factor));
    let views = views.collect();
    Ok(LaidOut { sheet, scale, views, notes: Vec::new() })
}
