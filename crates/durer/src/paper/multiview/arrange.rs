//! The choice of page, scale and positions for the views of a sheet.

use super::callouts;
use super::grid::{Extent, Grid};
use super::marks::TITLE_ROOM;
use super::parts_list::Shape;
use super::shelves::{Load, Shelved, shelved};
use super::{Contents, SheetView, ViewKind};
use crate::math::DVec2;
use crate::paper::{Options, Page, Scale, scale_text, standard_scale, title_block};
use crate::view::projection::NamedView;
use crate::{Error, Result};

/// The least space around a view, millimetres; with lines of cutting planes at its sides.
const GAP: f64 = 10.0;
const GAP_OF_PARENT: f64 = 20.0;

/// The paper if none is requested: A4.
const PAGE: Page = Page::Either(DVec2::new(210.0, 297.0));

/// Number of smaller scales that are tried until all views have room: down to a ten-thousandth.
const SMALLER: usize = 13;
/// Number of bisections in the search for the largest scale.
const HALVINGS: usize = 24;
/// A sheet that is to be as large as its views need is made larger by this much, this many times at
/// most.
const GROWTH: f64 = 1.05;
const MOST_GROWTHS: usize = 200;

/// Position of a view.
#[derive(Debug, Clone, Copy)]
pub struct Place {
    /// Position of the origin of its plane, in millimetres.
    pub origin: DVec2,
    /// Millimetres per plane unit.
    pub factor: f64,
}

/// Arrangement of a sheet.
#[derive(Debug)]
pub struct Arranged {
    pub page: DVec2,
    /// Length on paper over true length, of the principal views.
    pub scale: f64,
    /// Places by view.
    pub places: Vec<Place>,
    /// The list of parts, if there is one, and its lower right corner.
    pub list: Option<(Shape, DVec2)>,
}

/// A part of the page for views.
struct Room {
    /// Size; the upper left corner is the margin's.
    size: DVec2,
    list: Option<(Shape, DVec2)>,
}

/// Finds the page, in the orientation that gives the larger scale, and the largest requested scale at which all views
/// have room.
pub fn arrange(contents: &Contents, options: &Options) -> Result<Arranged> {
    let free = matches!((options.page, options.scale), (Page::Fit, Scale::Fit | Scale::Standard));
    let page = if free { PAGE } else { options.page };
    let on = |page: Page| Layout::new(contents, &Options { page, ..*options }).arranged();
    let alone = contents.views.iter().all(SheetView::is_principal)
        && contents.callouts.is_empty()
        && contents.parts.is_empty();
    match page {
        Page::Either(size) if !alone => {
            let lying = on(Page::Exact(DVec2::new(size.max_element(), size.min_element())));
            let upright = on(Page::Exact(DVec2::new(size.min_element(), size.max_element())));
            match (lying, upright) {
                (Ok(a), Ok(b)) if b.scale > a.scale => Ok(b),
                (Err(_), Ok(b)) => Ok(b),
                (a, _) => a,
            }
        }
        page => on(page),
    }
}

/// Views that look for their places.
struct Layout<'a> {
    contents: &'a Contents<'a>,
    options: Options,
    gap: f64,
}

impl<'a> Layout<'a> {
    fn new(contents: &'a Contents<'a>, options: &Options) -> Self {
        let cut = contents.views.iter().any(|v| matches!(v.kind, ViewKind::Section { .. }));
        let gap = if cut { GAP_OF_PARENT } else { GAP };
        Self { contents, options: *options, gap: gap + options.around }
    }

    fn arranged(&self) -> Result<Arranged> {
        // The size of the principal views alone, in the model's units; everything else may make them smaller.
        let bare = Contents { callouts: &[], ..self.contents.clone() };
        let grid = Layout::new(&bare, &self.options).grid(1.0 / self.options.unit);
        let taken = self.border() + grid.gaps() * self.gap;
        let size = grid.size();
        let scale = match self.options.scale {
            // Room for the given scale is checked with all views.
            Scale::Given(_) if self.options.page != Page::Fit => Scale::Fit,
            scale => scale,
        };
        let open = Options { scale, ..self.options };
        let (page, largest) = open.page_and_scale(size, taken)?;
        let at = |page: DVec2, scale: f64| self.at(page, scale);
        match self.options.scale {
            Scale::Given(scale) if self.options.page == Page::Fit => {
                let pages = std::iter::successors(Some(page), |p| Some(*p * GROWTH));
                pages.take(MOST_GROWTHS).find_map(|page| at(page, scale))
            }
            Scale::Given(scale) => at(page, scale),
            Scale::Standard => smaller(largest).find_map(|scale| at(page, scale)),
            Scale::Fit => at(page, largest).or_else(|| self.largest_below(page, largest)),
        }
        .ok_or_else(|| self.no_room(page, largest))
    }

    /// Returns the largest scale below one at which there is no room.
    fn largest_below(&self, page: DVec2, scale: f64) -> Option<Arranged> {
        let mut high = scale;
        let mut found = smaller(scale).find_map(|scale| {
            let found = self.at(page, scale);
            high = if found.is_none() { scale } else { high };
            found
        })?;
        for _ in 0..HALVINGS {
            let middle = (found.scale + high) * 0.5;
            match self.at(page, middle) {
                Some(better) => found = better,
                None => high = middle,
            }
        }
        Some(found)
    }

    fn no_room(&self, page: DVec2, largest: f64) -> Error {
        let count = self.contents.views.len();
        let value = format!("{} × {} mm for {count} views", page.x, page.y);
        match self.options.scale {
            Scale::Given(scale) => {
                let smaller = smaller(largest.min(scale));
                let fits = smaller.skip(1).find(|s| self.at(page, *s).is_some());
                let fits =
                    fits.map_or_else(String::new, |s| format!(" ({} has room)", scale_text(s)));
                let value = format!("{} on {value}{fits}", scale_text(scale));
                Error::parameter("scale", value, "small enough for the page, or `auto`")
            }
            _ => Error::parameter("page", value, "larger, or fewer views"),
        }
    }

    /// Returns the size of margins and title block on a page.
    fn border(&self) -> DVec2 {
        let title = if self.contents.title.is_some() { title_block::HEIGHT } else { 0.0 };
        DVec2::splat(2.0 * self.options.margin) + DVec2::new(0.0, title)
    }

    /// Returns the areas of a page for views: everything within its border, or the parts below or to the right
    /// of a parts list.
    fn rooms(&self, page: DVec2) -> Vec<Room> {
        let (parts, size) = (self.contents.parts, page - self.border());
        if parts.is_empty() {
            return vec![Room { size, list: None }];
        }
        let corner = DVec2::splat(self.options.margin) + size;
        let (low, high) = (Shape::within_width(parts, size.x), Shape::within_height(parts, size.y));
        let rooms = [
            (low, size - DVec2::new(0.0, low.size().y)),
            (high, size - DVec2::new(high.size().x, 0.0)),
        ];
        let fits = |shape: &Shape| shape.size().cmple(size).all();
        let rooms = rooms.into_iter().filter(|(shape, _)| fits(shape));
        rooms.map(|(shape, size)| Room { size, list: Some((shape, corner)) }).collect()
    }

    /// Returns the principal views, at a scale.
    fn grid(&self, scale: f64) -> Grid {
        let principal = |(index, view): (usize, &SheetView)| {
            let side = match view.kind {
                ViewKind::Principal(side) => Some(side),
                _ => None,
            };
            view.is_principal().then(|| (index, side, self.extent(index, view, scale)))
        };
        let views: Vec<(usize, Option<NamedView>, Extent)> =
            self.contents.views.iter().enumerate().filter_map(principal).collect();
        Grid::new(&views, self.contents.angle)
    }

    /// Returns the extent of a view with its title and callouts, in millimetres around its origin.
    fn extent(&self, index: usize, view: &SheetView, scale: f64) -> Extent {
        let (bounds, factor) = (view.bounds(), self.factor(view, scale));
        let title = if view.is_principal() { 0.0 } else { TITLE_ROOM };
        let called = self.contents.callouts.iter().any(|c| c.view == index);
        let around = if called { callouts::ROOM } else { 0.0 };
        Extent {
            min: DVec2::new(bounds.min().x * factor, -bounds.max().y * factor - title) - around,
            max: DVec2::new(bounds.max().x * factor, -bounds.min().y * factor) + around,
        }
    }

    /// Returns the millimetres per unit of a view's plane, where the principal views have a scale.
    fn factor(&self, view: &SheetView, scale: f64) -> f64 {
        let unit = self.options.unit;
        match &view.kind {
            ViewKind::Detail(detail) => detail.scale_beside(scale, unit) * unit,
            _ => scale * unit,
        }
    }

    /// Returns the views in their places, if they have room.
    fn at(&self, page: DVec2, scale: f64) -> Option<Arranged> {
        let views = self.contents.views;
        let grid = self.grid(scale);
        let others: Vec<(usize, Extent)> = views
            .iter()
            .enumerate()
            .filter(|(_, v)| !v.is_principal())
            .map(|(i, v)| (i, self.extent(i, v, scale)))
            .collect();
        let sizes: Vec<DVec2> = others.iter().map(|o| o.1.size()).collect();
        let main = grid.size();
        let load = Load { main, main_gaps: grid.gaps(), others: &sizes, gap: self.gap };
        let lying = page.x > page.y;
        let (Shelved { main, others: corners }, list) =
            self.rooms(page).into_iter().find_map(|Room { size, list }| {
                let mut ways = [lying, !lying].into_iter();
                ways.find_map(|beside| shelved(&load, size, beside)).zip(Some(list))
            })?;
        let margin = DVec2::splat(self.options.margin);
        let factor = |i: usize| self.factor(&views[i], scale);
        let mut places: Vec<Place> =
            (0..views.len()).map(|i| Place { origin: margin, factor: factor(i) }).collect();
        for (i, origin) in grid.place(margin, main) {
            places[i].origin = origin;
        }
        for ((i, extent), corner) in others.into_iter().zip(corners) {
            places[i].origin = margin + corner - extent.min;
        }
        Some(Arranged { page, scale, places, list })
    }
}

/// Returns a scale, and standard ones below it.
fn smaller(scale: f64) -> impl Iterator<Item = f64> {
    std::iter::successors(Some(scale), |s| Some(standard_scale(*s * 0.99))).take(SMALLER)
}
