//! Maps: layers of points, lines and areas on a canvas or a sheet, each with a style, and labels that keep off each other.
//!
//! Neighbouring areas of one opaque colour are painted as one and leave no seam; dashed or translucent borders that two
//! areas share are drawn once. Labels are placed within areas, along lines and beside points, upper layers and small
//! ranks first; labels without room are left out.
//!
//! ```
//! use durer::geometry::{Geometry, Points};
//! use durer::map::{Map, Style};
//! use durer::math::DVec2;
//! use durer::raster::paint::{Canvas, Options};
//! use durer::target::Pixels;
//! use durer::view::window::{PixelRect, Viewport, Window};
//!
//! let square = [(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)].map(DVec2::from);
//! let land = Geometry::Polygon(vec![Points::flat(square.to_vec())]);
//! let style = Style { fill: Some([200, 180, 120, 255]), stroke: None, ..Style::default() };
//!
//! let viewport = Viewport::new(PixelRect::of_size(64, 64)?)?;
//! let canvas = Canvas::new(64, 64, Options::default())?;
//! let mut map = Map::new(canvas, &Window::new(-5.0, 15.0, -5.0, 15.0)?, &viewport)?;
//! let counts = map.layer(&style, [&land])?;
//! assert_eq!(counts.polygons, 1);
//! let mut picture = Pixels::new(64, 64, [255; 4]);
//! map.into_target().render(&mut picture)?;
//! assert_eq!(picture.get(32, 32), Some([200, 180, 120, 255]));
//! # Ok::<(), durer::Error>(())
//! ```
//!
//! The cost is O(n) for n positions, plus the canvas's, and O(l log l) for l labels.

mod along;
mod block;
mod borders;
mod joined;
mod label;
mod places;

pub use label::{Anchor, Label, PlacedLabels};

use crate::Result;
use crate::curve::text::Font;
use crate::curve::{Contours, Path};
use crate::geometry::{Geometry, Points};
use crate::math::{DVec2, Rect};
use crate::raster::coverage::FillRule;
use crate::raster::line::wide::{Cap, Join, Stroke, has_too_many_dashes};
use crate::raster::paint::{Canvas, Paint, PaintTarget};
use crate::view::window::{Aspect, Viewport, Window, WindowToViewport, YAxis};
use borders::Borders;
use joined::Joined;
use label::Ground;
use places::Land;

/// Space around features, as a share of their extent.
const MARGIN: f64 = 0.02;

/// Points of a line that are nearer to the one before in pixels are left out: an edge through a pixel changes its
/// coverage by less than 0.1/255 for it.
const NEAR: f64 = 1.0 / 4096.0;

/// Symbol for points.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Marker {
    /// A disk.
    #[default]
    Circle,
    /// A square.
    Square,
    /// A triangle that points upwards.
    Triangle,
    /// An upright cross, in the colour of the stroke.
    Cross,
}

/// Look of a layer; lengths in pixels, colours sRGB with straight alpha.
#[derive(Debug, Clone, PartialEq)]
pub struct Style {
    /// Colour of areas and markers.
    pub fill: Option<[u8; 4]>,
    /// Colour of lines and borders.
    pub stroke: Option<[u8; 4]>,
    /// Width of lines and borders.
    pub stroke_width: f64,
    /// Lengths of dashes and gaps in turn; empty for solid lines.
    pub dashes: Vec<f64>,
    /// Opacity of the layer as a whole, 0 … 1.
    pub opacity: f64,
    /// Symbol for points.
    pub marker: Marker,
    /// Width of markers.
    pub marker_size: f64,
    /// Size of labels' letters (em).
    pub label_size: f64,
    /// Colour of labels.
    pub label_color: [u8; 4],
    /// Colour around labels.
    pub label_halo: Option<[u8; 4]>,
}

impl Default for Style {
    /// Returns light areas with thin grey borders, dark labels with a white halo.
    fn default() -> Self {
        Self {
            fill: Some([0xe3, 0xe7, 0xe0, 255]),
            stroke: Some([0x55, 0x60, 0x6b, 255]),
            stroke_width: 1.0,
            dashes: Vec::new(),
            opacity: 1.0,
            marker: Marker::Circle,
            marker_size: 6.0,
            label_size: 12.0,
            label_color: [0x22, 0x22, 0x22, 255],
            label_halo: Some([255; 4]),
        }
    }
}

/// Counts of a layer: parts that touch the viewport.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct LayerCounts {
    /// Points.
    pub points: u64,
    /// Lines.
    pub lines: u64,
    /// Polygons.
    pub polygons: u64,
    /// True if lines with too many dashes were drawn solid ([`has_too_many_dashes`]).
    pub solid: bool,
}

/// Returns a window around a box with some space; a point gets a window of side 1.
///
/// # Errors
/// [`crate::Error::Parameter`] for a box that is too large or too small for a window.
pub fn extent(bounds: &Rect) -> Result<Window> {
    let size = bounds.size();
    let least = if size.max_element() > 0.0 { size.max_element() * MARGIN } else { 0.5 };
    let room = (size * MARGIN).max(DVec2::splat(least));
    let (lo, hi) = (bounds.min() - room, bounds.max() + room);
    Window::new(lo.x, hi.x, lo.y, hi.y)
}

/// Map that is being drawn.
#[derive(Debug)]
pub struct Map<T = Canvas> {
    target: T,
    screen: WindowToViewport,
    /// Viewport.
    seen: Rect,
    counts: LayerCounts,
    /// Areas of finished layers, which labels beside theirs avoid.
    lands: Vec<Contours>,
    /// Areas of the current layer.
    land: Contours,
    /// Areas of the current layer that are painted as one.
    joined: Option<Joined>,
    /// Borders of the current layer's areas that are drawn once for all of them.
    borders: Option<(Borders, Path)>,
    /// Boxes of all markers.
    marked: Vec<Rect>,
}

/// Returns whether the areas of a layer can be painted as one: one opaque colour, and no borders that the
/// area of a later feature could hide.
fn joins(style: &Style) -> bool {
    let bare = style.stroke.is_none_or(|c| c[3] == 0) || style.stroke_width == 0.0;
    bare && style.fill.is_some_and(|c| c[3] == 255)
}

/// Returns whether borders would look different if they were drawn twice.
fn shares(style: &Style) -> bool {
    style.stroke_width > 0.0
        && style.stroke.is_some_and(|c| c[3] > 0 && (c[3] < 255 || !style.dashes.is_empty()))
}

impl<T: PaintTarget> Map<T> {
    /// Creates a map of a window in a viewport of the target, a canvas or a sheet, to which it is clipped. The window keeps its shape; y
    /// points upwards.
    ///
    /// # Errors
    /// [`crate::Error::Parameter`] for a viewport without extent.
    pub fn new(mut target: T, window: &Window, viewport: &Viewport) -> Result<Self> {
        let screen = WindowToViewport::new(window, viewport, Aspect::Fit, YAxis::Down);
        let p = viewport.pixels();
        let [low, high] = [(p.x0(), p.y0()), (p.x1(), p.y1())]
            .map(|(x, y)| DVec2::new(f64::from(x), f64::from(y)));
        let (seen, size) = (Rect::new(low, high)?, high - low);
        target.push_clip(&Path::rectangle(low.x, low.y, size.x, size.y), FillRule::NonZero);
        Ok(Self {
            target,
            screen,
            seen,
            counts: LayerCounts::default(),
            lands: Vec::new(),
            land: Contours::new(),
            joined: None,
            borders: None,
            marked: Vec::new(),
        })
    }

    /// Draws a layer over those before it; returns the counts of parts that touch the viewport.
    ///
    /// # Errors
    /// Those of [`Canvas::stroke`], for invalid styles.
    pub fn layer<'a>(
        &mut self,
        style: &Style,
        geometries: impl IntoIterator<Item = &'a Geometry>,
    ) -> Result<LayerCounts> {
        self.counts = LayerCounts::default();
        let fade = style.opacity < 1.0;
        if fade {
            self.target.push_group();
        }
        self.joined = joins(style).then(Joined::default);
        self.borders = shares(style).then(<(Borders, Path)>::default);
        geometries.into_iter().try_for_each(|geometry| self.geometry(geometry, style))?;
        self.fill_joined(style);
        self.stroke_borders(style)?;
        if fade {
            self.target.pop(style.opacity);
        }
        self.lands.push(std::mem::take(&mut self.land));
        Ok(self.counts)
    }

    /// Returns the part of a feature that its label belongs to; `None` if it is not in the viewport.
    pub fn anchor(&self, geometry: &Geometry) -> Option<Anchor> {
        Anchor::of(geometry, &self.screen, &self.seen)
    }

    /// Draws the labels for which there is room, over all layers drawn so far; `styles` are the layers' styles. Each
    /// label is written in the first of the fonts that have most of its letters.
    ///
    /// # Errors
    /// [`crate::Error::Parameter`] if there is no font; [`crate::Error::Dangling`] for a label of a layer without a
    /// style.
    pub fn labels(
        &mut self,
        labels: Vec<Label>,
        styles: &[&Style],
        fonts: &[Font<'_>],
    ) -> Result<PlacedLabels> {
        let land = Land::new(self.lands.clone(), &self.seen)?;
        let ground = Ground { seen: &self.seen, land: &land, markers: &self.marked };
        label::draw(&mut self.target, &ground, labels, styles, fonts)
    }

    /// Returns the mapping of the map's coordinates to the target's pixels.
    pub fn screen(&self) -> &WindowToViewport {
        &self.screen
    }

    /// Returns the target, to set it up for the next layer.
    pub fn target(&mut self) -> &mut T {
        &mut self.target
    }

    /// Returns the target with everything drawn.
    pub fn into_target(self) -> T {
        self.target
    }

    fn geometry(&mut self, geometry: &Geometry, style: &Style) -> Result<()> {
        match geometry {
            Geometry::Point(points) | Geometry::MultiPoint(points) => self.markers(points, style),
            Geometry::LineString(line) => self.lines(std::slice::from_ref(line), style),
            Geometry::MultiLineString(lines) => self.lines(lines, style),
            Geometry::Polygon(rings) => self.polygons(std::slice::from_ref(rings), style),
            Geometry::MultiPolygon(polygons) => self.polygons(polygons, style),
            Geometry::Collection(parts) => parts.iter().try_for_each(|p| self.geometry(p, style)),
        }
    }

    /// Returns a run of positions on the screen, if a part of it may be visible with a pen of this width.
    fn run(&self, points: &[DVec2], width: f64) -> Option<Vec<DVec2>> {
        let mut run: Vec<DVec2> = Vec::with_capacity(points.len());
        for (i, p) in points.iter().enumerate() {
            let p = self.screen.to_screen(*p);
            let near = run.last().is_some_and(|last| last.distance_squared(p) < NEAR * NEAR);
            if !near || i + 1 == points.len() {
                run.push(p);
            }
        }
        let bounds = Rect::around(run.iter().copied())?;
        // Miters are round, so a pen reaches half its width.
        let reach = DVec2::splat(width * 0.5 + 1.0);
        let reached = Rect::new(bounds.min() - reach, bounds.max() + reach).ok()?;
        reached.overlaps(&self.seen).then_some(run)
    }

    fn stroke(&mut self, path: &Path, style: &Style) -> Result<()> {
        let Some(color) = style.stroke else { return Ok(()) };
        let cap = if style.dashes.is_empty() { Cap::Round } else { Cap::Butt };
        let (width, dashes) = (style.stroke_width, style.dashes.clone());
        let stroke = Stroke { width, cap, join: Join::Round, dashes, ..Stroke::default() };
        self.counts.solid |= has_too_many_dashes(path, &stroke);
        self.target.stroke(path, &stroke, &Paint::Color(color), 1.0)
    }

    fn lines(&mut self, lines: &[Points], style: &Style) -> Result<()> {
        let mut path = Path::new();
        for line in lines {
            if let Some(run) = self.run(&line.xy, style.stroke_width) {
                self.counts.lines += 1;
                path.extend(&Path::polyline(run));
            }
        }
        self.stroke(&path, style)
    }

    /// Paints the areas of a layer that have been joined, so that neighbours leave no seam.
    fn fill_joined(&mut self, style: &Style) {
        if let (Some(joined), Some(fill)) = (self.joined.take(), style.fill) {
            self.target.fill(&joined.into_path(), FillRule::NonZero, &Paint::Color(fill), 1.0);
        }
    }

    fn polygons(&mut self, polygons: &[Vec<Points>], style: &Style) -> Result<()> {
        if let Some(mut joined) = self.joined.take() {
            let seen = |ring: &Points| self.run(&ring.xy, 0.0).is_some();
            let on_screen =
                |ring: &Points| ring.xy.iter().map(|p| self.screen.to_screen(*p)).collect();
            let shown = polygons.iter().filter(|rings| rings.first().is_some_and(seen));
            let shown: Vec<Vec<Vec<DVec2>>> =
                shown.map(|rings| rings.iter().map(on_screen).collect()).collect();
            let taken = joined.take(&shown);
            self.joined = Some(joined);
            if taken {
                self.counts.polygons += shown.len() as u64;
                let rings = shown.into_iter().flatten();
                rings.for_each(|ring| self.land.push(ring, true));
                return Ok(());
            }
        }
        let mut path = Path::new();
        for rings in polygons {
            let outer = rings.first().and_then(|ring| self.run(&ring.xy, style.stroke_width));
            let Some(outer) = outer else { continue };
            self.counts.polygons += 1;
            let holes = rings[1..].iter().filter_map(|r| self.run(&r.xy, style.stroke_width));
            for ring in std::iter::once(outer).chain(holes.collect::<Vec<_>>()) {
                self.land.push(ring.iter().copied(), true);
                path.extend(&Path::polygon(ring));
            }
        }
        if let Some(fill) = style.fill {
            self.target.fill(&path, FillRule::EvenOdd, &Paint::Color(fill), 1.0);
        }
        match self.borders.take() {
            Some(borders) => self.add_borders(polygons, style, borders),
            None => self.stroke(&path, style)?,
        }
        Ok(())
    }

    /// Notes the borders of polygons that no polygon of the layer had before.
    fn add_borders(
        &mut self,
        polygons: &[Vec<Points>],
        style: &Style,
        (mut borders, mut path): (Borders, Path),
    ) {
        for border in polygons.iter().flatten().flat_map(|ring| borders.take(&ring.xy)) {
            if let Some(run) = self.run(&border.points, style.stroke_width) {
                let outline = if border.closed { Path::polygon(run) } else { Path::polyline(run) };
                path.extend(&outline);
            }
        }
        self.borders = Some((borders, path));
    }

    /// Draws the borders of a layer that have been noted, over all of its areas.
    fn stroke_borders(&mut self, style: &Style) -> Result<()> {
        self.borders.take().map_or(Ok(()), |(_, path)| self.stroke(&path, style))
    }

    fn markers(&mut self, points: &Points, style: &Style) -> Result<()> {
        let reach = DVec2::splat(style.marker_size + style.stroke_width);
        for p in &points.xy {
            let p = self.screen.to_screen(*p);
            let around = Rect::around([p - reach, p + reach]);
            if !around.is_some_and(|r| r.overlaps(&self.seen)) {
                continue;
            }
            self.counts.points += 1;
            let half = DVec2::splat(0.5 * (style.marker_size + style.stroke_width));
            self.marked.extend(Rect::new(p - half, p + half));
            let path = marker(style.marker, p, style.marker_size * 0.5);
            if let Some(fill) = style.fill.filter(|_| style.marker != Marker::Cross) {
                self.target.fill(&path, FillRule::NonZero, &Paint::Color(fill), 1.0);
            }
            self.stroke(&path, &Style { dashes: Vec::new(), ..style.clone() })?;
        }
        Ok(())
    }
}

/// Returns a marker's outline.
fn marker(marker: Marker, p: DVec2, r: f64) -> Path {
    match marker {
        Marker::Circle => Path::circle(p, r),
        Marker::Square => Path::rectangle(p.x - r, p.y - r, 2.0 * r, 2.0 * r),
        Marker::Triangle => {
            // Equilateral, its middle on the point.
            let corners = [(0.0, -1.0), (0.866_025_403_784, 0.5), (-0.866_025_403_784, 0.5)];
            Path::polygon(corners.map(|(x, y)| p + r * DVec2::new(x, y)))
        }
        Marker::Cross => {
            let mut path = Path::new();
            path.move_to(p.x - r, p.y).line_to(p.x + r, p.y);
            path.move_to(p.x, p.y - r).line_to(p.x, p.y + r);
            path
        }
    }
}
