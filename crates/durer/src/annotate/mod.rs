//! The annotations that draughtsmen write on a drawing: centre lines, dimensions, threads, notes.
//!
//! [`annotate`] puts them on a sheet whose views are known ([`PlacedView`]), beside the views and clear of each
//! other, in the layers `center`, `thread` and `dimension`. Lines end before text that is placed on them. Signs,
//! lines and arrows are those of ISO 128-2, ISO 129-1 and ISO 6410-1.

mod automatic;
mod board;
mod center;
mod clear;
mod draw;
mod explicit;
mod feature;
mod letters;
mod place;
mod quad;
mod request;
mod seen;
mod style;
mod thread;

pub use feature::{FeatureKind, RoundFeature, features};
pub use request::{Along, Annotations, FeaturePlace, Request, Thread, ThreadSize, ViewSide, What};

use crate::Result;
use crate::math::Rect;
use crate::paper::PlacedView;
use crate::target::drawing::Drawing;
use crate::target::sheet::Sheet;
use board::Board;
use seen::Seen;

/// Contents of a sheet.
#[derive(Debug, Clone, Copy)]
pub struct Shown<'a> {
    /// Its views and their places.
    pub views: &'a [PlacedView],
    /// Drawings of the views, in the same order.
    pub drawings: &'a [&'a Drawing],
    /// The round parts of the model.
    pub features: &'a [RoundFeature],
    /// Millimetres per unit of the model.
    pub unit: f64,
    /// True if hidden lines are drawn.
    pub hidden: bool,
    /// sRGB with straight alpha, of all annotations.
    pub color: [u8; 4],
}

/// Returns the space that a sheet should leave around its views for annotations, in millimetres.
pub fn room(wanted: &Annotations) -> f64 {
    let lanes = wanted.dimensions.len().min(2) + usize::from(wanted.sizes);
    let leaders = wanted.holes || wanted.bosses || !wanted.threads.is_empty();
    let dimensions = style::FIRST + style::STEP * (lanes.max(1) as f64);
    match (lanes, leaders) {
        (0, false) if wanted.center_lines => style::BEYOND,
        (0, false) => 0.0,
        _ => dimensions,
    }
}

/// Puts annotations on a sheet; returns messages for those that could not be placed.
///
/// # Errors
/// [`crate::Error::Parameter`] for unknown names, and for features that no view shows.
pub fn annotate(sheet: &mut Sheet, wanted: &Annotations, shown: &Shown) -> Result<Vec<String>> {
    let mut notes = Vec::new();
    let both = shown.views.iter().zip(shown.drawings);
    let views: Vec<Seen> = both.filter_map(|(v, d)| Seen::new(v, d, shown.hidden)).collect();
    let taken: Vec<Rect> = views.iter().map(Seen::bounds).collect();
    let Some(mut board) = Board::new(sheet, &taken, shown.color) else {
        let what = "annotations are for parallel views; a view in perspective has none";
        return Ok(vec![what.to_owned()]);
    };
    let (board_ref, features) = (&mut board, shown.features);
    if wanted.center_lines {
        let alone = shown.views.len() == 1;
        views.iter().for_each(|view| center::put(board_ref, view, features, alone));
    }
    let model = explicit::Model { features, unit: shown.unit };
    explicit::put(board_ref, &views, &model, &wanted.dimensions, &mut notes)?;
    if wanted.sizes {
        automatic::sizes(board_ref, &views, features, shown.unit, &mut notes);
    }
    let sized = thread::put(board_ref, &views, features, &wanted.threads, shown.unit, &mut notes)?;
    for (kind, requested) in [(FeatureKind::Hole, wanted.holes), (FeatureKind::Boss, wanted.bosses)]
    {
        let chosen: Vec<&RoundFeature> = features
            .iter()
            .filter(|f| requested && f.kind == kind && !sized.iter().any(|s| s.name == f.name))
            .collect();
        automatic::diameters(board_ref, &views, &chosen, shown.unit, &mut notes);
        if requested && !features.iter().any(|f| f.kind == kind) {
            notes.push(format!("the model has no {} to be dimensioned", kind.name()));
        }
    }
    let (mut texts, page) = board.finish();
    texts.extend(letters::make_room(sheet, &taken, &page));
    clear::clear(sheet, &texts);
    Ok(notes)
}
