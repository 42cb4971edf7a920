//! Several views of an object on one sheet: principal views in first-angle or third-angle projection (ISO 5456-2),
//! sections with the planes that cut them and details with their circles (ISO 128-3).

mod arrange;
mod callouts;
mod cutting_plane;
mod detail;
mod grid;
mod marks;
mod parts_list;
mod shelves;

pub use callouts::Callout;
pub use detail::Detail;
pub use parts_list::PartsListRow;

use super::title_block::{self, TitleBlock};
use super::{LaidOut, Options, PaperFrame, Placed, PlacedView, ViewBreaks, frame_of, put};
use crate::Result;
use crate::math::{Plane, Rect};
use crate::scene::Camera;
use crate::target::drawing::Drawing;
use crate::target::sheet::Sheet;
use crate::view::projection::NamedView;
use marks::Annotator;

/// Side of the front view on which each other view is placed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Angle {
    /// The right view is on the left, the top view below.
    First,
    /// The right view is on the right, the top view above.
    #[default]
    Third,
}

/// Kind of a view.
#[derive(Debug, Clone, PartialEq)]
pub enum ViewKind {
    /// A view from one of the usual sides; it has its place beside the others.
    Principal(NamedView),
    /// A view from any direction; it has the place of an isometric view.
    Free,
    /// Section: the part of the object on the positive side of a plane ([`Plane`]), seen from the side that is
    /// cut away. Its letter is drawn at the plane in the first principal view that sees it edge on.
    Section {
        /// E.g. `A`, for a view that is called `A–A`.
        letter: String,
        /// Cutting plane, in the model's units.
        plane: Plane,
    },
    /// A part of another view within a circle, enlarged.
    Detail(Detail),
}

/// A parallel view of an object; all views of a sheet have the same point of the object at the origin of their planes.
#[derive(Debug, Clone)]
pub struct SheetView<'a> {
    /// Kind of the view.
    pub kind: ViewKind,
    /// Camera of the view.
    pub camera: Camera,
    /// Drawing of the view.
    pub drawing: &'a Drawing,
    /// The breaks of the drawing.
    pub breaks: ViewBreaks,
}

impl SheetView<'_> {
    /// Returns the name of the view: `front`, `A–A`, `B`.
    pub fn name(&self) -> String {
        match &self.kind {
            ViewKind::Principal(view) => view.name().to_owned(),
            ViewKind::Free => String::new(),
            ViewKind::Section { letter, .. } => format!("{letter}–{letter}"),
            ViewKind::Detail(detail) => detail.letter.clone(),
        }
    }

    /// Returns its bounds in its plane.
    fn bounds(&self) -> Rect {
        match &self.kind {
            ViewKind::Detail(detail) => detail.bounds(),
            _ => frame_of(self.drawing, PaperFrame::Content),
        }
    }

    /// Returns whether it shows the whole object.
    fn is_principal(&self) -> bool {
        matches!(self.kind, ViewKind::Principal(_) | ViewKind::Free)
    }
}

/// Contents of a sheet.
#[derive(Debug, Clone)]
pub struct Contents<'a> {
    /// Arrangement of the principal views.
    pub angle: Angle,
    /// The views, each principal one at most once.
    pub views: &'a [SheetView<'a>],
    /// Numbers of parts around views.
    pub callouts: &'a [Callout],
    /// List of parts, placed above the title block, or in its place; empty for none.
    pub parts: &'a [PartsListRow],
    /// Title block; without one there is no frame either.
    pub title: Option<&'a TitleBlock>,
}

/// Lays views onto a sheet: the principal ones aligned, at one scale, the others beside or below them, with a
/// frame and a title block.
///
/// The default page is A4, or as large as a given scale needs. Layers beside those of [`super::lay_out`]:
/// `cutting-planes`, `details`, `view-titles`, `callouts`, `parts-list`, `frame`, `title-block`.
///
/// # Errors
/// As [`super::lay_out`].
pub fn lay_out_views(contents: &Contents, options: &Options) -> Result<LaidOut> {
    options.check()?;
    let arranged = arrange::arrange(contents, options)?;
    let mut sheet = Sheet {
        title: contents.title.map(|t| t.name.clone()).unwrap_or_default(),
        size: arranged.page,
        background: options.background,
        ..Sheet::default()
    };
    let places = contents.views.iter().zip(&arranged.places);
    let drawings: Vec<Placed> = places
        .clone()
        .map(|(v, p)| Placed { drawing: v.drawing, origin: p.origin, factor: p.factor })
        .collect();
    put(&mut sheet, &drawings, options);
    let views: Vec<PlacedView> = places
        .map(|(v, p)| PlacedView {
            breaks: v.breaks.clone(),
            ..PlacedView::new(&v.name(), Some(v.camera), v.bounds(), p.origin, p.factor)
        })
        .collect();
    let mut notes = Vec::new();
    let mut annotator = Annotator::new(&mut sheet, options);
    cutting_plane::put(&mut annotator, contents.views, &views, &mut notes);
    detail::put(&mut annotator, contents.views, &views);
    marks::put_titles(&mut annotator, contents.views, &views, arranged.scale, options);
    callouts::put(&mut annotator, contents.callouts, &views);
    if let Some((shape, corner)) = &arranged.list {
        parts_list::put(&mut annotator, contents.parts, shape, *corner);
    }
    if let Some(title) = contents.title {
        title_block::put(&mut sheet, title, contents.angle, arranged.scale, options);
    }
    Ok(LaidOut { sheet, scale: arranged.scale, views, notes })
}
