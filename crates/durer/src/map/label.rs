//! Labels of a map: their positions and outlines.

use super::Style;
use super::along::{self, Run};
use super::block::{Block, HALO, LETTERS};
use super::places::{self, Fit, Land, NEARLY, Places};
use crate::clip::polygon::{Polygon, Shapes, rectangle};
use crate::curve::Path;
use crate::curve::text::Font;
use crate::geometry::{Geometry, Points};
use crate::math::{DVec2, Rect};
use crate::raster::coverage::FillRule;
use crate::raster::line::wide::{Join, Stroke};
use crate::raster::paint::{Paint, PaintTarget};
use crate::sorting::CompactSort;
use crate::trace::NoTrace;
use crate::view::interior_point::{Options, interior_point};
use crate::view::label::Placer;
use crate::view::window::WindowToViewport;
use crate::{Error, Result};
use std::cmp::Ordering;
use std::collections::BTreeSet;

/// Ratio of a label's width to its height: areas are treated as narrower by this, or by the known ratio of their label,
/// when a place is searched.
const WIDTH: f64 = 2.0;

/// Room between a marker and its label, as a share of the letters' size.
const GAP: f64 = 0.25;

/// Room between an area and its label's halo, as a share of the letters' size.
const APART: f64 = 0.15;

/// Additional share inside the area from which a name in two lines is preferred to one line.
const BETTER: f64 = 0.1;

/// Label of a feature.
#[derive(Debug, Clone, PartialEq)]
pub struct Label {
    /// Text in one line.
    pub text: String,
    /// Shorter text for when the whole finds no room.
    pub short: Option<String>,
    /// Feature that it belongs to, on the screen.
    pub anchor: Anchor,
    /// Order of placing: smaller numbers first.
    pub rank: f64,
    /// Index of its layer: upper layers are placed first.
    pub layer: usize,
}

/// Part of a feature that a label belongs to, in pixels: its largest area, its longest line, or its first point.
#[derive(Debug, Clone, PartialEq)]
pub struct Anchor {
    at: DVec2,
    /// True if the label belongs beside its point; otherwise it is centred on the point.
    beside: bool,
    /// Size that orders labels, largest first: pixels of area or length.
    size: f64,
    /// Area in which there may be other positions.
    area: Option<Shapes>,
    /// The line along which it may run.
    line: Vec<DVec2>,
}

impl Anchor {
    /// Returns points far from the border of an area, for labels of a shape: the best one, and the best ones of its
    /// left, right, upper and lower parts.
    fn poles(&self, area: &Shapes, wide: f64) -> Vec<DVec2> {
        let Some(bounds) = area.bounds() else { return vec![self.at] };
        let own = largest(std::slice::from_ref(area)).and_then(|polygon| middle(polygon, wide));
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
            middle(largest(std::slice::from_ref(&cut))?, wide)
        };
        let others = halves.into_iter().filter_map(within);
        own.into_iter().chain([self.at]).chain(others).collect()
    }

    /// Returns the middle of an area, which has to stay visible.
    fn heart(&self) -> Option<Rect> {
        let area = self.area.as_ref()?.bounds()?.size() / 4.0;
        Rect::new(self.at - area, self.at + area).ok()
    }

    /// Returns the part of a feature within the viewport `seen` that its label belongs to.
    pub(super) fn of(geometry: &Geometry, screen: &WindowToViewport, seen: &Rect) -> Option<Self> {
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

    /// Returns an anchor within the largest polygon, as far as it is visible.
    fn largest_area(&self) -> Option<Anchor> {
        let cut =
            |s: &Shapes| rectangle::clip(self.seen, s, &rectangle::Options, &mut NoTrace).ok();
        let pieces: Vec<Shapes> = self.areas.iter().filter_map(cut).collect();
        let largest = largest(&pieces)?;
        let (at, size) = (middle(largest, WIDTH)?, largest.area().abs());
        let mut area = Shapes::new();
        largest.rings().for_each(|ring| area.push_ring(ring.iter().copied()));
        area.end_polygon();
        Some(Anchor { at, beside: false, size, area: Some(area), line: Vec::new() })
    }

    /// Returns an anchor on the longest line, in its middle.
    fn longest_line(&self) -> Option<Anchor> {
        let length = |l: &[DVec2]| l.windows(2).map(|w| w[0].distance(w[1])).sum::<f64>();
        let seen = self.lines.iter().filter(|l| l.iter().any(|p| self.seen.contains(*p)));
        let (size, line) = seen.map(|l| (length(l), l)).max_by(|a, b| a.0.total_cmp(&b.0))?;
        let mut left = size * 0.5;
        for pair in line.windows(2) {
            let piece = pair[0].distance(pair[1]);
            if piece >= left && piece > 0.0 {
                let at = pair[0].lerp(pair[1], left / piece);
                return Some(Anchor { at, beside: false, size, area: None, line: line.clone() });
            }
            left -= piece;
        }
        None
    }

    fn first_point(&self) -> Option<Anchor> {
        let at = self.points.iter().copied().find(|p| self.seen.contains(*p))?;
        Some(Anchor { at, beside: true, size: 0.0, area: None, line: Vec::new() })
    }
}

/// Returns the polygon of the largest area.
fn largest(pieces: &[Shapes]) -> Option<Polygon<'_>> {
    let polygons = pieces.iter().flat_map(Shapes::polygons);
    polygons.max_by(|a, b| a.area().abs().total_cmp(&b.area().abs()))
}

/// Returns the point of a polygon that is farthest from its border, for labels that are `wide` times wider than high.
fn middle(polygon: Polygon<'_>, wide: f64) -> Option<DVec2> {
    let narrow = DVec2::new(1.0 / wide, 1.0);
    let rings: Vec<Vec<DVec2>> =
        polygon.rings().map(|r| r.iter().map(|p| *p * narrow).collect()).collect();
    let rings: Vec<&[DVec2]> = rings.iter().map(Vec::as_slice).collect();
    let found = interior_point(&rings, &Options::default(), &mut NoTrace)?;
    Some(found.point / narrow)
}

/// Counts of placed labels.
#[derive(Debug, Default, Clone, PartialEq, Eq)]
pub struct PlacedLabels {
    /// Numbers of labels of each layer that found room, and that did not.
    pub counts: Vec<(u64, u64)>,
    /// Letters that the fonts of their labels do not have.
    pub missing: BTreeSet<char>,
}

/// Map that labels are placed on.
pub(super) struct Ground<'a> {
    /// Viewport.
    pub seen: &'a Rect,
    /// Areas that labels beside theirs avoid.
    pub land: &'a Land,
    /// Boxes of markers, which no label covers.
    pub markers: &'a [Rect],
}

/// Draws as many labels as find room, each in the font that has most of its letters, the first of those.
pub(super) fn draw(
    target: &mut impl PaintTarget,
    ground: &Ground<'_>,
    labels: Vec<Label>,
    styles: &[&Style],
    fonts: &[Font<'_>],
) -> Result<PlacedLabels> {
    let no_font = || Error::parameter("fonts", 0, "at least one font for labels");
    let mut planned = Vec::new();
    let are_many = labels.len() > MANY;
    let work = target.work().clone();
    let mut charge = work.charge("labels", 0)?;
    for label in labels {
        let unknown = || Error::Dangling { what: "style", index: label.layer, count: styles.len() };
        let style = *styles.get(label.layer).ok_or_else(unknown)?;
        let missing = |font: &Font<'_>| label.text.chars().filter(|c| !font.has(*c)).count();
        let font = fonts.iter().min_by_key(|font| missing(font)).ok_or_else(no_font)?;
        let mut one = Planned::new(label, font, style, ground.land);
        if are_many {
            one.blocks.iter_mut().for_each(Block::forget_outlines);
        }
        charge.grow(one.bytes())?;
        planned.push(one);
    }
    // The sort is stable: equal labels stay in the order of the file.
    planned.compact_sort_by(Planned::order);
    let mut placer = Placer::new(*ground.seen);
    // One of many markers at one place is enough; each label is compared with all reserved places.
    let mut reserved = BTreeSet::new();
    let bits = |marker: &Rect| [marker.min(), marker.max()].map(|p| [p.x, p.y].map(f64::to_bits));
    let markers = ground.markers.iter().filter(|marker| reserved.insert(bits(marker)));
    markers.for_each(|marker| placer.reserve(*marker));
    let mut drawn = PlacedLabels { counts: vec![(0, 0); styles.len()], missing: BTreeSet::new() };
    for layer in planned.chunk_by(|a, b| a.label.layer == b.label.layer) {
        let style = styles[layer[0].label.layer];
        let held = layer.iter().take_while(|planned| planned.fit == Fit::Held).count();
        for (i, planned) in layer.iter().enumerate() {
            if i == held {
                // Islands that names would hide are kept free; names within their own areas are placed already.
                let tiny = layer.iter().filter(|p| p.tiny && p.alone);
                for heart in tiny.filter_map(|p| p.label.anchor.heart()) {
                    placer.place([heart]);
                }
            }
            let boxes = planned.spots.iter().map(|spot| planned.taken(spot, style));
            let counts = &mut drawn.counts[planned.label.layer];
            match placer.place_parts(boxes).and_then(|number| planned.spots.get(number)) {
                Some(spot) => {
                    counts.0 += 1;
                    drawn.missing.extend(&planned.missing);
                    let outlines = if are_many {
                        planned.with_outlines().outlines(spot, style)
                    } else {
                        planned.outlines(spot, style)
                    };
                    write(target, &outlines, style)?;
                }
                None => counts.1 += 1,
            }
        }
    }
    Ok(drawn)
}

/// Number of labels above which outlines of letters are not kept, because most labels find no room, but made again for
/// those that do.
const MANY: usize = 4096;

/// Label with its candidate positions.
struct Planned<'a, 'd> {
    label: Label,
    font: &'a Font<'d>,
    /// Forms of the label: in one line, then in two or shorter, if an area does not hold one.
    blocks: Vec<Block>,
    /// Letters that its font does not have.
    missing: Vec<char>,
    fit: Fit,
    /// True if its area holds less than half of each form.
    tiny: bool,
    /// The share of it that its area holds.
    held: f64,
    /// True if its area has no neighbours.
    alone: bool,
    /// Candidate positions, the best first.
    spots: Vec<Spot>,
}

/// Position of a label.
#[derive(Debug, Clone, PartialEq)]
enum Spot {
    /// Upright, the block of this number with its corner here.
    At(usize, DVec2),
    /// Along a line.
    Along(Run),
}

impl<'a, 'd> Planned<'a, 'd> {
    fn new(label: Label, font: &'a Font<'d>, style: &Style, land: &Land) -> Self {
        let size = style.label_size;
        let one = Block::new(vec![label.text.clone()], font, size);
        let missing = label.text.chars().filter(|c| !font.has(*c)).collect();
        let Some(area) = &label.anchor.area else {
            let extent = one.extent();
            let runs = along::runs(&label.anchor.line, extent.x, size);
            let upright = beside(label.anchor.at, label.anchor.beside, &one, style);
            let spots = runs.into_iter().map(Spot::Along);
            let spots =
                spots.chain(upright.into_iter().map(|corner| Spot::At(0, corner))).collect();
            let (fit, held, blocks) = (Fit::Over, 0.0, vec![one]);
            let (tiny, alone) = (false, false);
            return Self { label, font, blocks, missing, fit, tiny, held, alone, spots };
        };
        let around = |block: &Block| {
            let (extent, halo) = (block.extent(), DVec2::splat(2.0 * HALO * size));
            let poles = label.anchor.poles(area, (extent.x / extent.y).clamp(1.0, 8.0));
            let gap = APART * size + 0.5 * style.stroke_width;
            places::around(area, &poles, extent + halo, gap, land)
        };
        let Places { mut fit, mut held, alone, middles } = around(&one);
        let spots = |number: usize, block: &Block, middles: Vec<DVec2>| -> Vec<Spot> {
            middles.into_iter().map(|m| Spot::At(number, block.corner(m))).collect()
        };
        let mut found = spots(0, &one, middles);
        let mut blocks = vec![one];
        let mut tiny = fit == Fit::Tiny;
        if fit != Fit::Held {
            let short = label.short.as_ref().map(|s| Block::new(vec![s.clone()], font, size));
            for (block, whole) in [(Block::stacked(&label.text, font, size), true), (short, false)]
            {
                let Some(block) = block else { continue };
                let more = around(&block);
                tiny &= more.fit == Fit::Tiny;
                let better = more.fit < fit || (more.fit == fit && more.held > held + BETTER);
                let more_spots = spots(blocks.len(), &block, more.middles);
                if whole && better {
                    (fit, held) = (more.fit, more.held);
                    found.splice(..0, more_spots);
                } else {
                    found.extend(more_spots);
                }
                blocks.push(block);
            }
        }
        Self { label, font, blocks, missing, fit, tiny, held, alone, spots: found }
    }

    /// Returns about how many bytes it takes.
    fn bytes(&self) -> u64 {
        let spots = size_of_val(&self.spots[..]) + size_of::<Self>() + self.label.text.len();
        spots as u64 + self.blocks.iter().map(Block::bytes).sum::<u64>()
    }

    /// Returns the label with the outlines of its letters.
    fn with_outlines(&self) -> Self {
        let blocks = self.blocks.iter().map(|block| block.with_outlines(self.font)).collect();
        let (label, missing, spots) = (self.label.clone(), Vec::new(), Vec::new());
        Self { label, blocks, missing, spots, ..*self }
    }

    /// Returns its boxes at a position.
    fn taken(&self, spot: &Spot, style: &Style) -> Vec<Rect> {
        match spot {
            Spot::At(block, corner) => self.blocks[*block].taken(*corner),
            Spot::Along(run) => {
                let half = (0.5 * LETTERS + HALO) * style.label_size;
                let glyphs = || {
                    self.blocks.first().and_then(Block::line).into_iter().flat_map(|l| &l.glyphs)
                };
                let middles = glyphs().map(|g| (g.start + g.end) / 2.0);
                let halves = glyphs().map(|g| half.max((g.end - g.start) / 2.0));
                let around = |(at, half): (DVec2, f64)| Rect::new(at - half, at + half).ok();
                let at = middles.filter_map(|along| run.place(along));
                at.zip(halves).filter_map(around).collect()
            }
        }
    }

    /// Returns its outlines at a position.
    fn outlines(&self, spot: &Spot, style: &Style) -> Path {
        match spot {
            Spot::At(block, corner) => self.blocks[*block].outlines(*corner),
            Spot::Along(run) => {
                let line = self.blocks.first().and_then(Block::line);
                let down = 0.5 * LETTERS * style.label_size;
                line.map_or_else(Path::new, |line| line.along(&run.line, run.start, down))
            }
        }
    }

    /// Compares the order of placing: upper layers first, then labels that fit in their area, smaller ranks, labels
    /// that nearly fit, and larger areas.
    fn order(&self, other: &Self) -> Ordering {
        let nearly = |label: &Self| label.fit == Fit::Over && label.held >= NEARLY;
        let held = |label: &Self| label.fit != Fit::Held;
        let layers = other.label.layer.cmp(&self.label.layer).then(held(self).cmp(&held(other)));
        let layers = layers.then(self.label.rank.total_cmp(&other.label.rank));
        let layers = layers.then(self.fit.cmp(&other.fit));
        let size = other.label.anchor.size.total_cmp(&self.label.anchor.size);
        layers.then(nearly(other).cmp(&nearly(self))).then(size)
    }
}

/// Returns starts of the base line, the best first.
fn beside(at: DVec2, beside: bool, block: &Block, style: &Style) -> Vec<DVec2> {
    let (size, advance) = (style.label_size, block.extent().x);
    // Capitals are centred on the line.
    let middle = at + DVec2::new(0.0, LETTERS * 0.5 * size);
    let centered = middle - DVec2::new(advance * 0.5, 0.0);
    let apart = GAP * size + 0.5 * (style.marker_size + style.stroke_width);
    let above = DVec2::new(0.0, LETTERS * 0.5 * size + apart);
    if beside {
        let right = middle + DVec2::new(apart, 0.0);
        let left = middle - DVec2::new(apart + advance, 0.0);
        vec![right, left, centered - above, centered + above]
    } else {
        let shift = DVec2::new(0.0, 0.6 * size);
        vec![centered, centered - shift, centered + shift]
    }
}

fn write(target: &mut impl PaintTarget, outlines: &Path, style: &Style) -> Result<()> {
    if let Some(halo) = style.label_halo {
        let width = 2.0 * HALO * style.label_size;
        let stroke = Stroke { width, join: Join::Round, ..Stroke::default() };
        target.stroke(outlines, &stroke, &Paint::Color(halo), 1.0)?;
    }
    target.fill(outlines, FillRule::NonZero, &Paint::Color(style.label_color), 1.0);
    Ok(())
}
