//! Labels of a map: where they go, and their outlines.

use super::layers::Style;
use crate::failure::Failure;
use durer::clip::polygon::{Polygon, Shapes, rectangle};
use durer::curve::text::{Font, TextLine};
use durer::math::{DAffine2, DVec2, Rect};
use durer::raster::coverage::FillRule;
use durer::raster::line::wide::{Join, Stroke};
use durer::raster::paint::{Canvas, Paint};
use durer::trace::NoTrace;
use durer::view::interior_point::{Options, interior_point};
use durer::view::label::Placer;
use durer::view::window::WindowToViewport;
use durer_formats::geo::{Geometry, Points};
use durer_formats::svg::Fonts;
use std::collections::BTreeSet;

/// Labels are wider than high: an area counts as if it were narrower by this when a place is sought.
const WIDTH: f64 = 2.0;

/// The halo reaches so far around letters, as a share of their size.
const HALO: f64 = 0.16;

/// Room between a marker and its label, as a share of the letters' size.
const GAP: f64 = 0.25;

/// The em square's share that letters take between a label's top and bottom line.
const LETTERS: f64 = 0.73;

/// What is to be written.
#[derive(Debug)]
pub struct Label {
    pub text: String,
    pub anchor: Anchor,
    /// The number of its layer.
    pub layer: usize,
}

/// Where a label belongs, in pixels.
#[derive(Debug, Clone, PartialEq)]
pub struct Anchor {
    at: DVec2,
    /// Of a point, beside which it stands; else it stands on it.
    beside: bool,
    /// What is larger comes first: pixels of area or length.
    size: f64,
    /// The area in which there may be other places.
    area: Option<Shapes>,
}

impl Anchor {
    /// Other points within the area, if the best has no room: those farthest from the border of its left, right, upper
    /// and lower part.
    fn others(&self) -> Vec<DVec2> {
        let Some((area, bounds)) = self.area.as_ref().and_then(|a| a.bounds().map(|b| (a, b)))
        else {
            return Vec::new();
        };
        let (low, high, at) = (bounds.min(), bounds.max(), self.at);
        let halves = [
            (DVec2::new(low.x, low.y), DVec2::new(high.x, at.y)),
            (DVec2::new(low.x, at.y), DVec2::new(high.x, high.y)),
            (DVec2::new(low.x, low.y), DVec2::new(at.x, high.y)),
            (DVec2::new(at.x, low.y), DVec2::new(high.x, high.y)),
        ];
        let within = |(low, high)| {
            let half = Rect::new(low, high).ok()?;
            let cut = rectangle::clip(&half, area, &rectangle::Options, &mut NoTrace).ok()?;
            middle(largest(std::slice::from_ref(&cut))?)
        };
        halves.into_iter().filter_map(within).collect()
    }

    /// The place for the label of a feature, within what is seen.
    pub fn of(geometry: &Geometry, screen: &WindowToViewport, seen: &Rect) -> Option<Self> {
        let parts =
            Parts { screen, seen, areas: Vec::new(), lines: Vec::new(), points: Vec::new() };
        let mut parts = parts;
        parts.add(geometry);
        parts.largest_area().or_else(|| parts.longest_line()).or_else(|| parts.first_point())
    }
}

/// The parts of a feature on the screen.
struct Parts<'a> {
    screen: &'a WindowToViewport,
    seen: &'a Rect,
    areas: Vec<Shapes>,
    lines: Vec<Vec<DVec2>>,
    points: Vec<DVec2>,
}

impl Parts<'_> {
    fn run<'b>(&'b self, points: &'b Points) -> impl Iterator<Item = DVec2> + 'b {
        points.xy.iter().map(|p| self.screen.to_screen(*p))
    }

    fn add(&mut self, geometry: &Geometry) {
        match geometry {
            Geometry::Point(points) | Geometry::MultiPoint(points) => {
                let run: Vec<DVec2> = self.run(points).collect();
                self.points.extend(run);
            }
            Geometry::LineString(line) => self.lines.push(self.run(line).collect()),
            Geometry::MultiLineString(lines) => lines.iter().for_each(|line| {
                let run = self.run(line).collect();
                self.lines.push(run);
            }),
            Geometry::Polygon(rings) => self.area(rings),
            Geometry::MultiPolygon(polygons) => polygons.iter().for_each(|p| self.area(p)),
            Geometry::Collection(parts) => parts.iter().for_each(|part| self.add(part)),
        }
    }

    fn area(&mut self, rings: &[Points]) {
        let mut shapes = Shapes::new();
        rings.iter().for_each(|ring| shapes.push_ring(self.run(ring)));
        shapes.end_polygon();
        self.areas.push(shapes);
    }

    /// Within the largest polygon, as far as it is seen.
    fn largest_area(&self) -> Option<Anchor> {
        let cut =
            |s: &Shapes| rectangle::clip(self.seen, s, &rectangle::Options, &mut NoTrace).ok();
        let pieces: Vec<Shapes> = self.areas.iter().filter_map(cut).collect();
        let largest = largest(&pieces)?;
        let (at, size) = (middle(largest)?, largest.area().abs());
        let mut area = Shapes::new();
        largest.rings().for_each(|ring| area.push_ring(ring.iter().copied()));
        area.end_polygon();
        Some(Anchor { at, beside: false, size, area: Some(area) })
    }

    /// In the middle of the longest line.
    fn longest_line(&self) -> Option<Anchor> {
        let length = |l: &[DVec2]| l.windows(2).map(|w| w[0].distance(w[1])).sum::<f64>();
        let seen = self.lines.iter().filter(|l| l.iter().any(|p| self.seen.contains(*p)));
        let (size, line) = seen.map(|l| (length(l), l)).max_by(|a, b| a.0.total_cmp(&b.0))?;
        let mut left = size * 0.5;
        for pair in line.windows(2) {
            let piece = pair[0].distance(pair[1]);
            if piece >= left && piece > 0.0 {
                let at = pair[0].lerp(pair[1], left / piece);
                return Some(Anchor { at, beside: false, size, area: None });
            }
            left -= piece;
        }
        None
    }

    fn first_point(&self) -> Option<Anchor> {
        let at = self.points.iter().copied().find(|p| self.seen.contains(*p))?;
        Some(Anchor { at, beside: true, size: 0.0, area: None })
    }
}

/// The polygon of the largest area.
fn largest(pieces: &[Shapes]) -> Option<Polygon<'_>> {
    let polygons = pieces.iter().flat_map(Shapes::polygons);
    polygons.max_by(|a, b| a.area().abs().total_cmp(&b.area().abs()))
}

/// The point of a polygon that is farthest from its border, as labels see it.
fn middle(polygon: Polygon<'_>) -> Option<DVec2> {
    let narrow = DVec2::new(1.0 / WIDTH, 1.0);
    let rings: Vec<Vec<DVec2>> =
        polygon.rings().map(|r| r.iter().map(|p| *p * narrow).collect()).collect();
    let rings: Vec<&[DVec2]> = rings.iter().map(Vec::as_slice).collect();
    let found = interior_point(&rings, &Options::default(), &mut NoTrace)?;
    Some(found.point / narrow)
}

/// What became of labels.
#[derive(Debug, Default)]
pub struct Drawn {
    /// For each layer how many found room, and how many did not.
    pub counts: Vec<(u64, u64)>,
    /// Letters that the fonts of their labels do not have.
    pub missing: BTreeSet<char>,
}

/// Draws as many labels as find room, each in the font that has most of its letters, the first of those.
pub fn draw(
    canvas: &mut Canvas,
    seen: &Rect,
    mut labels: Vec<Label>,
    styles: &[&Style],
    fonts: &Fonts,
) -> Result<Drawn, Failure> {
    let opened = fonts.iter().map(|(bytes, index)| Font::new(bytes, index));
    let fonts = opened.collect::<durer::Result<Vec<_>>>();
    let fonts = fonts.map_err(|e| Failure::Data(e.to_string()))?;
    let no_font = || Failure::Data("there is no font for labels".to_owned());
    // The sort is stable: what is equal stays in the order of the file.
    labels.sort_by(|a, b| b.layer.cmp(&a.layer).then(b.anchor.size.total_cmp(&a.anchor.size)));
    let mut placer = Placer::new(*seen);
    let mut drawn = Drawn { counts: vec![(0, 0); styles.len()], missing: BTreeSet::new() };
    for label in &labels {
        let style = styles[label.layer];
        let missing = |font: &Font<'_>| label.text.chars().filter(|c| !font.has(*c)).count();
        let font = fonts.iter().min_by_key(|font| missing(font)).ok_or_else(no_font)?;
        let line = font.line(&label.text, style.label_size);
        let anchor = &label.anchor;
        let mut place = |at: DVec2| {
            let places = places(at, anchor.beside, &line, style);
            let boxes = places.iter().filter_map(|corner| taken(*corner, &line, style));
            placer.place(boxes).and_then(|number| places.get(number).copied())
        };
        let found = place(anchor.at).or_else(|| anchor.others().into_iter().find_map(place));
        match found {
            Some(corner) => {
                drawn.counts[label.layer].0 += 1;
                drawn.missing.extend(label.text.chars().filter(|c| !font.has(*c)));
                write(canvas, &line, corner, style).map_err(|e| Failure::Usage(e.to_string()))?;
            }
            None => drawn.counts[label.layer].1 += 1,
        }
    }
    Ok(drawn)
}

/// Starts of the base line, the best first.
fn places(at: DVec2, beside: bool, line: &TextLine, style: &Style) -> Vec<DVec2> {
    let size = style.label_size;
    // Capitals stand in the middle of the line.
    let middle = at + DVec2::new(0.0, LETTERS * 0.5 * size);
    let centered = middle - DVec2::new(line.advance * 0.5, 0.0);
    let apart = GAP * size + 0.5 * (style.marker_size + style.stroke_width);
    let above = DVec2::new(0.0, LETTERS * 0.5 * size + apart);
    if beside {
        let right = middle + DVec2::new(apart, 0.0);
        let left = middle - DVec2::new(apart + line.advance, 0.0);
        vec![right, left, centered - above, centered + above]
    } else {
        let shift = DVec2::new(0.0, 0.6 * size);
        vec![centered, centered - shift, centered + shift]
    }
}

/// The room that a label takes.
fn taken(corner: DVec2, line: &TextLine, style: &Style) -> Option<Rect> {
    let halo = HALO * style.label_size;
    let min = corner - DVec2::new(halo, LETTERS * style.label_size + halo);
    let max = corner + DVec2::new(line.advance + halo, line.descent + halo);
    Rect::new(min, max).ok()
}

fn write(canvas: &mut Canvas, line: &TextLine, at: DVec2, style: &Style) -> durer::Result<()> {
    canvas.set_transform(DAffine2::from_translation(at));
    if let Some(halo) = style.label_halo {
        let width = 2.0 * HALO * style.label_size;
        let stroke = Stroke { width, join: Join::Round, ..Stroke::default() };
        canvas.stroke(&line.path, &stroke, &Paint::Color(halo), 1.0)?;
    }
    canvas.fill(&line.path, FillRule::NonZero, &Paint::Color(style.label_color), 1.0);
    canvas.set_transform(DAffine2::IDENTITY);
    Ok(())
}
