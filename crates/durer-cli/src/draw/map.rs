//! A map of layers.

use super::args::DxfUnits;
use super::layers::{Labels, Layer, OF_LABELS, OF_STROKES, Priority};
use super::report::MapCounts;
use super::{Given, Job, MAP_SIDE, Surface, fonts, is_for_cad, sides};
use crate::failure::Failure;
use crate::input::display_name;
use durer::curve::text::Font;
use durer::map::{self, Label, Map, Style};
use durer::math::{DVec2, Rect};
use durer::view::window::{Window, WindowToViewport};
use durer_formats::drawing::DxfFrame;
use durer_formats::geo::Feature;
use durer_formats::svg::no_glyphs;
use std::time::Instant;

/// Natural Earth's property of how important a label is: small numbers first.
const LABELRANK: &str = "LABELRANK";

/// Fields of Natural Earth's names; the second has shorter ones for labels that find no room.
const NAME: &str = "NAME";
const ABBREV: &str = "ABBREV";

/// Number of fields that a message lists when a label's field is missing.
const LISTED: usize = 12;

/// Pixels of a millimetre: 96 are an inch.
const PIXELS_PER_MILLIMETRE: f64 = 96.0 / 25.4;

/// Last digit of coordinates in files for CAD, as a share of the map's longer side: coarser than the error of f64 on the
/// way to the sheet and back, finer than any map.
const PRECISION: f64 = 1e-11;

/// The most digits after the point of coordinates in files for CAD.
const MOST_DIGITS: usize = 15;

impl Job<'_> {
    /// Returns everything that the layers paint.
    pub(super) fn map<T: Surface>(&mut self, given: &[Given<'_>]) -> Result<T, Failure> {
        self.warn_of_idle();
        let start = Instant::now();
        let mut layers = Vec::new();
        for layer in given {
            layers.push(self.features(layer)?);
        }
        self.report.read_seconds += start.elapsed().as_secs_f64();
        if let Some(message) = self.systems.warning() {
            self.messages.warning(&self.names(), &message);
            self.report.warnings.push(message);
        }
        let usage = |e: durer::Error| Failure::Usage(e.to_string());
        let window = match &self.args.picture.window {
            Some(given) => {
                let (lo, hi) = (given.min(), given.max());
                Window::new(lo.x, hi.x, lo.y, hi.y).map_err(usage)?
            }
            None => extent(&layers, &self.names())?,
        };
        let extent = window.rect().size();
        let size = sides(self.args.picture.size, extent * (MAP_SIDE / extent.max_element()));
        let target: T = self.surface(size, [255; 4])?;
        let viewport = self.viewport(size)?;
        let mut map = Map::new(target, &window, &viewport).map_err(usage)?;
        if self.args.picture.dxf_units != Some(DxfUnits::Mm) {
            self.frame = frame(map.screen(), size, self.systems.unit());
        }
        let mut labels = Vec::new();
        for (index, (layer, features)) in given.iter().zip(&layers).enumerate() {
            let name = display_name(&layer.layer.input);
            self.messages.progress.stage(|| format!("drawing {name}"));
            map.target().begin_layer(&crate::names::stem(&layer.layer.input));
            let geometries = features.iter().filter_map(|feature| feature.geometry.as_ref());
            let fail = |e: durer::Error| Failure::of_library(&e).named(&name);
            let counts = map.layer(&layer.layer.style, geometries).map_err(fail)?;
            map.target().work().check().map_err(fail)?;
            if counts.solid {
                let message = "lines with more than 100,000 dashes and gaps are drawn solid";
                self.messages.warning(&name, message);
                self.report.warnings.push(message.to_owned());
            }
            self.report.layers[index].map = Some(MapCounts::new(features.len(), counts));
            labels.extend(
                labels_of(&map, features, &layer.layer.labels, index)
                    .map_err(|why| Failure::Data(format!("{name}: {why}")))?,
            );
        }
        let counts = self.report.layers.iter().filter_map(|layer| layer.map.as_ref());
        if counts.map(MapCounts::parts).sum::<u64>() == 0 {
            let (lo, hi) = (window.rect().min(), window.rect().max());
            let message = format!(
                "nothing of the map is within {:?},{:?},{:?},{:?}; durer info tells its extent",
                lo.x, lo.y, hi.x, hi.y
            );
            self.messages.warning(&self.names(), &message);
            self.report.warnings.push(message);
        }
        self.write(&mut map, labels, given)?;
        Ok(map.into_target())
    }

    /// Warns of options that have no effect on any of the layers that they are given for.
    fn warn_of_idle(&self) {
        let layers = &self.args.layers.0;
        let idle = |option: &&&str, has_none: &dyn Fn(&Layer) -> bool| {
            let mut with =
                layers.iter().filter(|l| l.given.iter().any(|name| name == *option)).peekable();
            with.peek().is_some() && with.all(has_none)
        };
        let of_labels = OF_LABELS.iter().filter(|o| idle(o, &|layer| layer.labels.field.is_none()));
        let of_strokes =
            OF_STROKES.iter().filter(|o| idle(o, &|layer| layer.style.stroke.is_none()));
        let reasons = of_labels
            .map(|o| (*o, "there is no --label"))
            .chain(of_strokes.map(|o| (*o, "--stroke is none")));
        for (option, reason) in reasons {
            let option = format!("--{}", option.replace('_', "-"));
            self.messages.warning(&option, format!("it has no effect: {reason}"));
        }
    }

    /// Draws the labels and counts the ones drawn.
    fn write(
        &mut self,
        map: &mut Map<impl Surface>,
        labels: Vec<Label>,
        given: &[Given<'_>],
    ) -> Result<(), Failure> {
        let given_fonts = !self.args.fonts.font.is_empty();
        // A file that is not a font is an error even if nothing is written.
        if labels.is_empty() && !given_fonts {
            return Ok(());
        }
        let fonts = fonts::load(&self.args.fonts)?;
        if labels.is_empty() {
            return Ok(());
        }
        self.messages.progress.stage(|| "placing labels".to_owned());
        let data = |e: durer::Error| Failure::Data(e.to_string());
        let mut styles: Vec<Style> = given.iter().map(|g| g.layer.style.clone()).collect();
        if is_for_cad(self.args) {
            // Programs for CAD print white as black.
            let halos = styles.iter_mut().map(|style| &mut style.label_halo);
            halos.filter(|halo| **halo == Some([255; 4])).for_each(|halo| *halo = None);
        }
        let styles: Vec<&Style> = styles.iter().collect();
        let opened = fonts.iter().map(|(bytes, index)| Font::new(bytes, index));
        let opened = opened.collect::<durer::Result<Vec<_>>>().map_err(data)?;
        map.target().begin_layer("labels");
        let placed = map.labels(labels, &styles, &opened).map_err(data)?;
        for (layer, placed) in self.report.layers.iter_mut().zip(placed.counts) {
            if let Some(counts) = &mut layer.map {
                (counts.labels, counts.labels_left_out) = placed;
            }
        }
        if let Some(message) = no_glyphs(placed.missing.into_iter()) {
            self.messages.warning("labels", &message);
            self.report.warnings.push(message);
        }
        Ok(())
    }
}

/// Returns the place of a sheet of a size in pixels in the coordinates of the map, whose unit has a length in metres.
fn frame(screen: &WindowToViewport, size: (u32, u32), unit: Option<f64>) -> DxfFrame {
    let [width, height] = [size.0, size.1].map(f64::from);
    let [pixels_per_unit, ..] = screen.coefficients();
    let units_per_millimetre = PIXELS_PER_MILLIMETRE / pixels_per_unit;
    let least = width.max(height) / pixels_per_unit * PRECISION;
    let digits =
        (0..MOST_DIGITS).find(|digits| 10_f64.powi(-i32::try_from(*digits).unwrap_or(0)) <= least);
    DxfFrame {
        origin: screen.to_world(DVec2::new(0.0, height)),
        units_per_millimetre,
        unit,
        digits: digits.unwrap_or(MOST_DIGITS),
    }
}

/// Returns the window around all features, with some space.
fn extent(layers: &[Vec<Feature>], names: &str) -> Result<Window, Failure> {
    let all = layers.iter().flatten().filter_map(|f| f.geometry.as_ref()?.bounds());
    let nothing = || Failure::Data(format!("{names}: there is nothing to draw"));
    let bounds = Rect::around(all.flat_map(|b| [b.min(), b.max()])).ok_or_else(nothing)?;
    map::extent(&bounds).map_err(|_| {
        let (lo, hi) = (bounds.min(), bounds.max());
        Failure::Data(format!(
            "{names}: coordinates reach from ({:?}, {:?}) to ({:?}, {:?}); a map must lie within ±10¹⁰⁰ and be \
             wider than 10⁻¹⁰⁰, or --window must say which part of it to draw",
            lo.x, lo.y, hi.x, hi.y
        ))
    })
}

/// Returns the properties of a feature.
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

/// Returns the text of a label: strings, numbers, true and false; nothing for null and composite values.
fn text_of(feature: &Feature, field: &str) -> Option<String> {
    let text = match properties(feature)?.remove(field)? {
        serde_json::Value::String(text) => text,
        serde_json::Value::Number(number) => number.to_string(),
        serde_json::Value::Bool(value) => value.to_string(),
        _ => return None,
    };
    (!text.trim().is_empty()).then_some(text)
}

/// Returns the rank of a feature by a property: small ones are placed first.
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

/// Returns the labels of a layer's features.
fn labels_of(
    map: &Map<impl Surface>,
    features: &[Feature],
    labels: &Labels,
    layer: usize,
) -> Result<Vec<Label>, String> {
    let Some(field) = &labels.field else { return Ok(Vec::new()) };
    let known = || Priority { field: LABELRANK.to_owned(), largest_first: false };
    let by = labels.priority.clone().unwrap_or_else(known);
    let label = |feature: &Feature| {
        let text = text_of(feature, field)?;
        let anchor = map.anchor(feature.geometry.as_ref()?)?;
        let short = if field == NAME { text_of(feature, ABBREV) } else { None };
        Some(Label { text, short, anchor, rank: rank(feature, &by), layer })
    };
    let found: Vec<Label> = features.iter().filter_map(label).collect();
    if found.is_empty() && !features.iter().any(|f| has(f, field)) {
        return Err(no_field(features, "label", field));
    }
    if let Some(by) = &labels.priority
        && !features.iter().any(|f| has(f, &by.field))
    {
        return Err(no_field(features, "label-priority", &by.field));
    }
    Ok(found)
}
