//! A map of layers.

use super::borders::Borders;
use super::joined::Joined;
use super::label::{Anchor, Ground, Label};
use super::layers::{Marker, Priority, Style};
use super::places::Land;
use super::report::MapCounts;
use super::{Given, Job, MAP_SIDE, fonts, frame, sides};
use crate::failure::Failure;
use crate::input::display_name;
use durer::curve::{Contours, Path};
use durer::math::{DVec2, Rect};
use durer::raster::coverage::FillRule;
use durer::raster::line::wide::{Cap, Join, Stroke, has_too_many_dashes};
use durer::raster::paint::{Canvas, Paint};
use durer::view::window::{Aspect, Viewport, Window, WindowToViewport, YAxis};
use durer_formats::geo::{Feature, Geometry, Points};
use durer_formats::svg::no_glyphs;
use std::time::Instant;

/// Room around what is shown, as a share of it, where no window is given.
const MARGIN: f64 = 0.02;

/// Points of a line that are nearer to the one before in pixels are left out: an edge through a pixel changes its
/// coverage by less than 0.1/255 for it.
const NEAR: f64 = 1.0 / 4096.0;

/// Natural Earth's property of how important a label is: small numbers first.
const LABELRANK: &str = "LABELRANK";

/// Where Natural Earth has names, and shorter ones for those that find no room.
const NAME: &str = "NAME";
const ABBREV: &str = "ABBREV";

/// So many names of properties are listed where a label's is not there.
const LISTED: usize = 12;

impl Job<'_> {
    /// Everything that the layers want painted.
    pub(super) fn map(&mut self, given: &[Given<'_>]) -> Result<Canvas, Failure> {
        let start = Instant::now();
        let mut layers = Vec::new();
        for layer in given {
            layers.push(self.features(layer)?);
        }
        self.report.read_seconds += start.elapsed().as_secs_f64();
        let usage = |e: durer::Error| Failure::Usage(e.to_string());
        let window = match &self.args.picture.window {
            Some(given) => {
                let (lo, hi) = (given.min(), given.max());
                Window::new(lo.x, hi.x, lo.y, hi.y).map_err(usage)?
            }
            None => extent(&layers, &names(given))?,
        };
        let extent = window.rect().size();
        let size = sides(self.args.picture.size, extent * (MAP_SIDE / extent.max_element()));
        let canvas = self.canvas(size, [255; 4])?;
        let viewport = self.viewport(size)?;
        let screen = WindowToViewport::new(&window, &viewport, Aspect::Fit, YAxis::Down);
        let (seen, counts) = (seen(&viewport)?, MapCounts::default());
        let land = Contours::new();
        let (joined, borders, marked) = (None, None, Vec::new());
        let mut map =
            Map { canvas, screen, seen, counts, land, joined, borders, marked, solid: false };
        map.canvas.push_clip(&frame(&viewport), FillRule::NonZero);
        let (mut labels, mut land) = (Vec::new(), Vec::new());
        for (index, (layer, features)) in given.iter().zip(&layers).enumerate() {
            let name = display_name(&layer.layer.input);
            self.messages.progress.stage(|| format!("drawing {name}"));
            let style = &layer.layer.style;
            map.counts = MapCounts { features: features.len() as u64, ..MapCounts::default() };
            let fade = style.opacity < 1.0;
            if fade {
                map.canvas.push_group();
            }
            map.joined = joins(style).then(Joined::default);
            map.borders = shares(style).then(<(Borders, Path)>::default);
            features.iter().try_for_each(|f| map.feature(f, style)).map_err(usage)?;
            map.fill_joined(style);
            map.stroke_borders(style).map_err(usage)?;
            if std::mem::take(&mut map.solid) {
                let message = "what has more than 100,000 dashes and gaps is drawn solid";
                self.messages.warning(&name, message);
                self.report.warnings.push(message.to_owned());
            }
            if fade {
                map.canvas.pop(style.opacity);
            }
            if let Some(field) = &style.label {
                let mut own = map.labels(features, field, style, index);
                if own.is_empty() && !features.iter().any(|f| has(f, field)) {
                    let why = no_field(features, "label", field);
                    return Err(Failure::Data(format!("{name}: {why}")));
                }
                if let Some(by) = &style.label_priority
                    && !features.iter().any(|f| has(f, &by.field))
                {
                    let why = no_field(features, "label-priority", &by.field);
                    return Err(Failure::Data(format!("{name}: {why}")));
                }
                labels.append(&mut own);
            }
            land.push(std::mem::take(&mut map.land));
            self.report.layers[index].map = Some(map.counts);
        }
        let given_fonts = !self.args.fonts.font.is_empty();
        // What is no font is wrong also where nothing is written.
        let fonts = if labels.is_empty() && !given_fonts {
            None
        } else {
            Some(fonts::load(&self.args.fonts)?)
        };
        if let (false, Some(fonts)) = (labels.is_empty(), fonts) {
            self.messages.progress.stage(|| "placing labels".to_owned());
            let styles: Vec<&Style> = given.iter().map(|g| &g.layer.style).collect();
            let land = Land::new(land, &map.seen).map_err(usage)?;
            let ground = Ground { seen: &map.seen, land: &land, markers: &map.marked };
            let drawn = super::label::draw(&mut map.canvas, &ground, labels, &styles, &fonts)?;
            for (layer, placed) in self.report.layers.iter_mut().zip(drawn.counts) {
                if let Some(counts) = &mut layer.map {
                    (counts.labels, counts.labels_left_out) = placed;
                }
            }
            if let Some(message) = no_glyphs(drawn.missing.into_iter()) {
                self.messages.warning("labels", &message);
                self.report.warnings.push(message);
            }
        }
        Ok(map.canvas)
    }

    fn features(&mut self, given: &Given<'_>) -> Result<Vec<Feature>, Failure> {
        let name = display_name(&given.layer.input);
        let fail = |e: durer_formats::Error| Failure::Data(format!("{name}: {e}"));
        self.messages.progress.stage(|| format!("reading {name}"));
        let reader = crate::layer::reader(&given.layer.input, given.format, &given.bytes[..], None);
        let mut reader = reader.map_err(fail)?;
        let mut features = Vec::new();
        while let Some(feature) = reader.next_feature().map_err(fail)? {
            crate::layer::keep(&feature, &self.args.running.work).map_err(|e| fail(e.into()))?;
            features.push(feature);
        }
        self.warn(&name, reader.warnings());
        let more = reader.further_warnings();
        if more > 0 {
            self.report.warnings.push(format!("and {more} more"));
        }
        Ok(features)
    }
}

fn names(given: &[Given<'_>]) -> String {
    let names: Vec<String> = given.iter().map(|g| display_name(&g.layer.input)).collect();
    names.join(", ")
}

/// The window around all features, with some room; a point gets one of side 1.
fn extent(layers: &[Vec<Feature>], names: &str) -> Result<Window, Failure> {
    let all = layers.iter().flatten().filter_map(|f| f.geometry.as_ref()?.bounds());
    let nothing = || Failure::Data(format!("{names}: there is nothing to draw"));
    let bounds = Rect::around(all.flat_map(|b| [b.min(), b.max()])).ok_or_else(nothing)?;
    let size = bounds.size();
    let least = if size.max_element() > 0.0 { size.max_element() * MARGIN } else { 0.5 };
    let room = (size * MARGIN).max(DVec2::splat(least));
    let (lo, hi) = (bounds.min() - room, bounds.max() + room);
    Window::new(lo.x, hi.x, lo.y, hi.y).map_err(|_| {
        let (lo, hi) = (bounds.min(), bounds.max());
        Failure::Data(format!(
            "{names}: coordinates reach from ({:?}, {:?}) to ({:?}, {:?}); a map must lie within ±10¹⁰⁰ and be \
             wider than 10⁻¹⁰⁰, or --window must say which part of it to draw",
            lo.x, lo.y, hi.x, hi.y
        ))
    })
}

fn seen(viewport: &Viewport) -> Result<Rect, Failure> {
    let p = viewport.pixels();
    let corner = |x: i32, y: i32| DVec2::new(x.into(), y.into());
    Rect::new(corner(p.x0(), p.y0()), corner(p.x1(), p.y1()))
        .map_err(|e| Failure::Usage(e.to_string()))
}

/// The properties of a feature.
fn properties(feature: &Feature) -> Option<serde_json::Map<String, serde_json::Value>> {
    serde_json::from_str(feature.properties.as_deref()?).ok()
}

fn has(feature: &Feature, field: &str) -> bool {
    properties(feature).is_some_and(|p| p.contains_key(field))
}

fn no_field(features: &[Feature], option: &str, field: &str) -> String {
    let mut known: Vec<String> = Vec::new();
    for name in features.iter().filter_map(properties).flat_map(|p| p.into_iter().map(|m| m.0)) {
        if known.len() <= LISTED && !known.contains(&name) {
            known.push(name);
        }
    }
    if known.len() > LISTED {
        known[LISTED] = "…".to_owned();
    }
    let there = if known.is_empty() { "none".to_owned() } else { known.join(", ") };
    format!("--{option} {field}: no feature has this property; there are: {there}")
}

/// What a label says: text, numbers, true and false; nothing for null and what has parts.
fn text_of(feature: &Feature, field: &str) -> Option<String> {
    let text = match properties(feature)?.remove(field)? {
        serde_json::Value::String(text) => text,
        serde_json::Value::Number(number) => number.to_string(),
        serde_json::Value::Bool(value) => value.to_string(),
        _ => return None,
    };
    (!text.trim().is_empty()).then_some(text)
}

/// The map while it is drawn.
struct Map {
    canvas: Canvas,
    screen: WindowToViewport,
    /// The viewport.
    seen: Rect,
    counts: MapCounts,
    /// The layer's areas so far, which labels beside theirs keep off.
    land: Contours,
    /// The layer's areas so far, where they are painted as one.
    joined: Option<Joined>,
    /// The borders of the layer's areas, where they are drawn once for all of them.
    borders: Option<(Borders, Path)>,
    /// Boxes of all markers.
    marked: Vec<Rect>,
    /// Whether something has so many dashes that it is drawn without.
    solid: bool,
}

/// Whether the areas of a layer can be painted as one: one opaque colour, and no borders that the
/// area of a later feature could hide.
fn joins(style: &Style) -> bool {
    let bare = style.stroke.is_none_or(|c| c[3] == 0) || style.stroke_width == 0.0;
    bare && style.fill.is_some_and(|c| c[3] == 255)
}

/// Whether borders would look different where they are drawn twice.
fn shares(style: &Style) -> bool {
    style.stroke_width > 0.0
        && style.stroke.is_some_and(|c| c[3] > 0 && (c[3] < 255 || !style.dashes.is_empty()))
}

/// Ranks of features by a property: small ones are placed first.
fn rank(feature: &Feature, by: &Priority) -> f64 {
    let value = properties(feature).and_then(|mut known| known.remove(&by.field));
    let number = match value {
        Some(serde_json::Value::Number(number)) => number.as_f64(),
        Some(serde_json::Value::String(text)) => text.trim().parse().ok(),
        _ => None,
    };
    let number = number.filter(|n: &f64| n.is_finite());
    number.map_or(f64::INFINITY, |n| if by.largest_first { -n } else { n })
}

impl Map {
    fn feature(&mut self, feature: &Feature, style: &Style) -> durer::Result<()> {
        match &feature.geometry {
            Some(geometry) => self.geometry(geometry, style),
            None => Ok(()),
        }
    }

    fn geometry(&mut self, geometry: &Geometry, style: &Style) -> durer::Result<()> {
        match geometry {
            Geometry::Point(points) | Geometry::MultiPoint(points) => self.markers(points, style),
            Geometry::LineString(line) => self.lines(std::slice::from_ref(line), style),
            Geometry::MultiLineString(lines) => self.lines(lines, style),
            Geometry::Polygon(rings) => self.polygons(std::slice::from_ref(rings), style),
            Geometry::MultiPolygon(polygons) => self.polygons(polygons, style),
            Geometry::Collection(parts) => parts.iter().try_for_each(|p| self.geometry(p, style)),
        }
    }

    /// A run of positions on the screen, if a part of it may be seen with a pen of this width.
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

    fn stroke(&mut self, path: &Path, style: &Style) -> durer::Result<()> {
        let Some(color) = style.stroke else { return Ok(()) };
        let cap = if style.dashes.is_empty() { Cap::Round } else { Cap::Butt };
        let (width, dashes) = (style.stroke_width, style.dashes.clone());
        let stroke = Stroke { width, cap, join: Join::Round, dashes, ..Stroke::default() };
        self.solid |= has_too_many_dashes(path, &stroke);
        self.canvas.stroke(path, &stroke, &Paint::Color(color), 1.0)
    }

    fn lines(&mut self, lines: &[Points], style: &Style) -> durer::Result<()> {
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
            self.canvas.fill(&joined.into_path(), FillRule::NonZero, &Paint::Color(fill), 1.0);
        }
    }

    fn polygons(&mut self, polygons: &[Vec<Points>], style: &Style) -> durer::Result<()> {
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
            self.canvas.fill(&path, FillRule::EvenOdd, &Paint::Color(fill), 1.0);
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
    fn stroke_borders(&mut self, style: &Style) -> durer::Result<()> {
        self.borders.take().map_or(Ok(()), |(_, path)| self.stroke(&path, style))
    }

    fn markers(&mut self, points: &Points, style: &Style) -> durer::Result<()> {
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
                self.canvas.fill(&path, FillRule::NonZero, &Paint::Color(fill), 1.0);
            }
            self.stroke(&path, &Style { dashes: Vec::new(), ..style.clone() })?;
        }
        Ok(())
    }

    /// What is to be written, and where.
    fn labels(&self, features: &[Feature], field: &str, style: &Style, layer: usize) -> Vec<Label> {
        let known = || Priority { field: LABELRANK.to_owned(), largest_first: false };
        let by = style.label_priority.clone().unwrap_or_else(known);
        let label = |feature: &Feature| {
            let text = text_of(feature, field)?;
            let anchor = Anchor::of(feature.geometry.as_ref()?, &self.screen, &self.seen)?;
            let short = if field == NAME { text_of(feature, ABBREV) } else { None };
            Some(Label { text, short, anchor, rank: rank(feature, &by), layer })
        };
        features.iter().filter_map(label).collect()
    }
}

/// A marker's outline.
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
