//! The shapes of an SVG document as features.
//!
//! The reader takes `path`, `polygon`, `polyline`, `line`, `rect`, `circle` and `ellipse`, with the `transform`s and
//! `id`s on them and on the groups around them, and their copies by `use`. Bézier curves become [`path::STEPS`] edges
//! each, arcs and round corners the same number per quarter turn, with all corners on the curve. Closed parts become
//! polygons, open parts lines, and open parts without length points. The closed parts of a path are filled by
//! `fill-rule`, as attribute or in `style`, on it or around it; non-zero by default. Elements that are not drawn are
//! left out: the content of `defs`, `clipPath` and similar elements, and elements hidden by `display` or `visibility`.
//! Other styles, style sheets, text, clipping and view boxes of nested documents are ignored. Coordinates are the
//! document's with y reversed, so that y is up, as [`super::svg`] writes them.

mod attributes;
mod path;

use super::{Feature, Geometry, MAX_DEPTH, Warnings};
use crate::foreign;
use crate::{Error, Place, Result};
use attributes::{Matrix, UPRIGHT, attribute, compose, length, property, reference, transforms};
use durer::clip::polygon::WindingRule;
use durer::math::DVec2;
use path::Path;
use quick_xml::events::{BytesStart, Event};
use std::collections::HashMap;
use std::sync::Arc;

/// Elements whose content is drawn only by reference, or never.
const NOT_DRAWN: [&str; 19] = [
    "clipPath",
    "color-profile",
    "cursor",
    "defs",
    "desc",
    "filter",
    "font",
    "foreignObject",
    "linearGradient",
    "marker",
    "mask",
    "metadata",
    "pattern",
    "radialGradient",
    "script",
    "style",
    "symbol",
    "title",
    "view",
];

/// Largest total number of bytes of the document that `use` may copy: nested uses grow quickly.
const MAX_USED: u64 = 64 << 20;

/// Coordinate system and name that an element inherits.
#[derive(Debug, Clone)]
struct Level {
    /// The byte of its tag, and the length of its name.
    start: (usize, usize),
    matrix: Matrix,
    id: Option<Arc<str>>,
    /// True if ids within yield to this one: they are within an element that a `use` shows.
    keeps_id: bool,
    fill_rule: WindingRule,
    /// True if its contents are drawn at all.
    drawn: bool,
    /// True if it is visible; elements in it may differ.
    visible: bool,
}

/// Part of an element that is shown.
enum Drawn {
    Nothing,
    Shape(Geometry),
    /// Another element, that begins at this byte.
    Other(usize),
}

/// Around the whole document.
const OUTERMOST: Level = Level {
    start: (usize::MAX, 0),
    matrix: UPRIGHT,
    id: None,
    keeps_id: false,
    fill_rule: WindingRule::NonZero,
    drawn: true,
    visible: true,
};

/// The document, or one element of it that a `use` shows.
#[derive(Debug)]
struct Frame {
    /// Index of the next byte.
    at: usize,
    /// Levels around it, then those of the open elements.
    levels: Vec<Level>,
    /// True if all of it has been read.
    is_done: bool,
}

/// Reader of the shapes of a document, one after the other.
#[derive(Debug)]
pub struct Reader {
    text: Vec<u8>,
    walk: Walk,
}

impl Reader {
    pub fn new(text: Vec<u8>) -> Self {
        let frames = vec![Frame { at: 0, levels: vec![OUTERMOST], is_done: false }];
        let walk = Walk { frames, has_root: false, ids: None, used: 0, last_place: (0, 1, 0) };
        Self { text, walk }
    }

    /// Returns the next shape; `None` at the end.
    pub fn next_feature(&mut self, warnings: &mut Warnings) -> Result<Option<Feature>> {
        self.walk.next(&self.text, warnings)
    }
}

/// Position of a reader in its text.
#[derive(Debug)]
struct Walk {
    /// The document, then the elements that the `use`s being followed show.
    frames: Vec<Frame>,
    has_root: bool,
    /// The first byte of the elements with an `id`, when a `use` has requested it.
    ids: Option<HashMap<Box<str>, usize>>,
    /// Bytes shown by `use`.
    used: u64,
    /// The last place that was reported: byte, line, and the start of the line.
    last_place: (usize, u64, usize),
}

/// Returns the events of a text from a byte on. Matching of names is checked by [`Walk`], which can continue from any
/// byte.
fn events(text: &[u8], from: usize) -> quick_xml::Reader<&[u8]> {
    let mut reader = quick_xml::Reader::from_reader(text.get(from..).unwrap_or_default());
    let config = reader.config_mut();
    (config.check_end_names, config.allow_unmatched_ends) = (false, true);
    reader
}

impl Walk {
    fn next(&mut self, text: &[u8], warnings: &mut Warnings) -> Result<Option<Feature>> {
        while let Some(frame) = self.frames.last() {
            let (base, depth) = (frame.at, self.frames.len());
            let mut reader = events(text, base);
            loop {
                if self.frames.last().is_some_and(|frame| frame.is_done) {
                    self.frames.pop();
                }
                if self.frames.len() != depth {
                    break;
                }
                let at = base + reader.buffer_position() as usize;
                let event = reader.read_event();
                let next = base + reader.buffer_position() as usize;
                if let Some(frame) = self.frames.last_mut() {
                    frame.at = next;
                }
                if depth > 1 {
                    self.charge(text, at, next)?;
                }
                let event = event.map_err(|e| self.fail(text, at, foreign::xml(&e)))?;
                let found = match &event {
                    Event::Eof => {
                        self.end_of_file(text, at)?;
                        None
                    }
                    Event::Start(element) => self.element(text, at, element, true, warnings)?,
                    Event::Empty(element) => self.element(text, at, element, false, warnings)?,
                    Event::End(end) => {
                        self.leave(text, at, end.name().as_ref())?;
                        None
                    }
                    Event::Text(words) => {
                        self.words(text, at, words, warnings)?;
                        None
                    }
                    Event::CData(words) => {
                        self.words(text, at, words, warnings)?;
                        None
                    }
                    _ => None,
                };
                if found.is_some() {
                    return Ok(found);
                }
            }
        }
        Ok(None)
    }

    /// Returns the line and column of a byte; counts on from the last reported place.
    fn place(&mut self, text: &[u8], at: usize) -> Place {
        let at = at.min(text.len());
        let (from, mut line, mut start) =
            if at < self.last_place.0 { (0, 1, 0) } else { self.last_place };
        let between = text.get(from..at).unwrap_or_default();
        for (i, _) in between.iter().enumerate().filter(|(_, b)| **b == b'\n') {
            line += 1;
            start = from + i + 1;
        }
        self.last_place = (at, line, start);
        Place::Line(line, (at - start) as u64 + 1)
    }

    fn fail(&mut self, text: &[u8], at: usize, message: impl Into<String>) -> Error {
        Error::Decode { place: self.place(text, at), message: message.into() }
    }

    /// Adds a warning, whose place is computed only if it is kept.
    fn warn(&mut self, text: &[u8], at: usize, message: String, warnings: &mut Warnings) {
        let place = if warnings.are_many() { Place::Whole } else { self.place(text, at) };
        warnings.push(place, message);
    }

    fn charge(&mut self, text: &[u8], at: usize, next: usize) -> Result<()> {
        self.used += (next - at) as u64;
        if self.used <= MAX_USED {
            return Ok(());
        }
        let (place, value) = (self.place(text, at), self.used);
        Err(Error::Limit {
            place,
            what: "length of the text that `use` shows",
            value,
            limit: MAX_USED,
        })
    }

    fn end_of_file(&mut self, text: &[u8], at: usize) -> Result<()> {
        let open = self.frames.iter().rev().find_map(|f| f.levels.get(1..)?.last());
        if let Some(open) = open {
            let name = crate::text::quote(name_at(text, open.start));
            return Err(self.fail(text, at, format!("the file ends within `{name}`")));
        }
        if !self.has_root {
            return Err(self.fail(text, at, "there is no svg element"));
        }
        self.frames.clear();
        Ok(())
    }

    fn leave(&mut self, text: &[u8], at: usize, name: &str) -> Result<()> {
        let Some(frame) = self.frames.last_mut() else { return Ok(()) };
        if frame.levels.len() < 2 {
            let name = crate::text::quote(name.as_bytes());
            return Err(self.fail(text, at, format!("`{name}` ends, but has not begun")));
        }
        let open = frame.levels.pop().map_or((0, 0), |level| level.start);
        frame.is_done = frame.levels.len() == 1 && frame.levels[0].start != OUTERMOST.start;
        let expected = name_at(text, open);
        if name.as_bytes() != expected {
            let [expected, name] = [expected, name.as_bytes()].map(crate::text::quote);
            let message = format!("`</{expected}>` is expected, not `</{name}>`");
            return Err(self.fail(text, at, message));
        }
        Ok(())
    }

    /// Reads text between tags, which has a meaning in style sheets only.
    fn words(
        &mut self,
        text: &[u8],
        at: usize,
        words: &str,
        warnings: &mut Warnings,
    ) -> Result<()> {
        let Some(levels) = self.frames.last().map(|f| &f.levels) else { return Ok(()) };
        let Some(level) = levels.get(1..).and_then(<[_]>::last) else {
            let blank = words.trim_start_matches('\u{feff}').trim().is_empty();
            let outside = "there is text outside of the svg element";
            return if blank { Ok(()) } else { Err(self.fail(text, at, outside)) };
        };
        let is_sheet = name_at(text, level.start).ends_with(b"style");
        let unread = ["fill-rule", "display", "visibility"].into_iter().find(|p| words.contains(p));
        if let Some(property) = unread.filter(|_| is_sheet) {
            let message = format!("style sheets are not read; this one says `{property}`");
            self.warn(text, at, message, warnings);
        }
        Ok(())
    }

    /// Reads a tag; returns the shape that it draws.
    fn element(
        &mut self,
        text: &[u8],
        at: usize,
        element: &BytesStart<'_>,
        is_open: bool,
        warnings: &mut Warnings,
    ) -> Result<Option<Feature>> {
        let depth: usize = self.frames.iter().map(|f| f.levels.len()).sum();
        if depth > MAX_DEPTH * 8 {
            return Err(self.fail(text, at, "elements are nested too deep"));
        }
        let is_used = self.frames.len() > 1;
        let is_outermost = self.frames.last().is_some_and(|f| f.levels.len() == 1);
        let name = element.local_name();
        if is_outermost && !is_used {
            self.root(text, at, name.as_ref())?;
        }
        let outer = self.frames.last().and_then(|f| f.levels.last()).unwrap_or(&OUTERMOST);
        let mut notes = Vec::new();
        let found = enter(element, at, outer, &mut notes);
        let mut level = found.map_err(|message| self.fail(text, at, message))?;
        let is_shown = is_outermost && is_used;
        if NOT_DRAWN.contains(&name.as_ref()) && !(is_shown && name.as_ref() == "symbol") {
            level.drawn = false;
        }
        let drawn = if !level.drawn {
            Ok(Drawn::Nothing)
        } else if matches!(name.as_ref(), "svg" | "symbol") && (is_used || !is_outermost) {
            nested(element, &mut level).map(|()| Drawn::Nothing)
        } else if name.as_ref() == "use" {
            self.target(text, element).map(Drawn::Other)
        } else {
            let shape = shape(element, &level, &mut notes);
            shape.map(|shape| shape.filter(|_| level.visible).map_or(Drawn::Nothing, Drawn::Shape))
        };
        let drawn = drawn.unwrap_or_else(|message| {
            notes.push(format!("{message}; the shape is left out"));
            level.drawn = false;
            Drawn::Nothing
        });
        notes.into_iter().for_each(|note| self.warn(text, at, note, warnings));
        let (mut feature, mut target) = (None, None);
        match drawn {
            Drawn::Shape(geometry) => {
                let id = level.id.as_deref().map(|id| serde_json::Value::from(id).to_string());
                let fill_rule = level.fill_rule;
                feature = Some(Feature { id, fill_rule, ..Feature::of_geometry(geometry) });
            }
            Drawn::Other(start) => target = Some(start),
            Drawn::Nothing => {}
        }
        let frame = target.map(|target| {
            let keeps_id = level.id.is_some();
            let around = Level { start: (target, 0), keeps_id, ..level.clone() };
            Frame { at: target, levels: vec![around], is_done: false }
        });
        // The content of a `use` is not drawn, only the element it refers to.
        level.drawn &= frame.is_none();
        match self.frames.last_mut() {
            Some(around) if is_open => around.levels.push(level),
            Some(around) => around.is_done = is_shown,
            None => {}
        }
        self.frames.extend(frame);
        Ok(feature)
    }

    fn root(&mut self, text: &[u8], at: usize, name: &str) -> Result<()> {
        if std::mem::replace(&mut self.has_root, true) {
            return Err(self.fail(text, at, "there is a second element beside the svg element"));
        }
        if name != "svg" {
            let name = crate::text::quote(name.as_bytes());
            let message = format!("there is no svg element; the document is a `{name}`");
            return Err(self.fail(text, at, message));
        }
        Ok(())
    }

    /// Returns the first byte of the element that a `use` refers to.
    fn target(&mut self, text: &[u8], element: &BytesStart<'_>) -> Result<usize, String> {
        let uri = reference(element)?.ok_or("`use` needs an `href`")?;
        let quoted = crate::text::quote(uri.as_bytes());
        let Some(id) = uri.strip_prefix('#') else {
            return Err(format!("`use` of `{quoted}`, which is in another file, is not read"));
        };
        let ids = self.ids.get_or_insert_with(|| ids(text));
        let found = ids.get(id).copied();
        let target = found.ok_or_else(|| format!("`use` of `{quoted}`, which is not there"))?;
        if self.frames.iter().flat_map(|f| &f.levels).any(|level| level.start.0 == target) {
            return Err(format!("`use` of `{quoted}`, which it is part of"));
        }
        Ok(target)
    }
}

/// Returns the first byte of all elements that have an `id`; among several with the same id, the first one's.
fn ids(text: &[u8]) -> HashMap<Box<str>, usize> {
    let (mut reader, mut ids) = (events(text, 0), HashMap::new());
    loop {
        let at = reader.buffer_position() as usize;
        match reader.read_event() {
            Ok(Event::Start(element) | Event::Empty(element)) => {
                if let Ok(Some(id)) = attribute(&element, "id") {
                    ids.entry(id.into()).or_insert(at);
                }
            }
            // Errors are reported when the walk gets there.
            Ok(Event::Eof) | Err(_) => return ids,
            Ok(_) => {}
        }
    }
}

/// Returns the name in a tag.
fn name_at(text: &[u8], (start, length): (usize, usize)) -> &[u8] {
    text.get(start + 1..start + 1 + length).unwrap_or_default()
}

/// Computes an element's level from the one around it and its own attributes.
fn enter(
    element: &BytesStart<'_>,
    start: usize,
    outer: &Level,
    notes: &mut Vec<String>,
) -> Result<Level, String> {
    let transform = attribute(element, "transform")?.unwrap_or_default();
    let mut level = Level {
        start: (start, element.name().as_ref().len()),
        matrix: compose(&outer.matrix, &transforms(&transform)?),
        ..outer.clone()
    };
    if element.local_name().as_ref() == "use" {
        let [x, y] = [length(element, "x")?, length(element, "y")?];
        let there = [1.0, 0.0, 0.0, 1.0, x.unwrap_or(0.0), y.unwrap_or(0.0)];
        level.matrix = compose(&level.matrix, &there);
    }
    if !outer.keeps_id {
        level.id = attribute(element, "id")?.map(Arc::from).or(level.id);
    }
    let rules = [("nonzero", WindingRule::NonZero), ("evenodd", WindingRule::EvenOdd)];
    level.fill_rule = property(element, "fill-rule", &rules, notes)?.unwrap_or(level.fill_rule);
    let seen = [("visible", true), ("hidden", false), ("collapse", false)];
    level.visible = property(element, "visibility", &seen, notes)?.unwrap_or(level.visible);
    level.drawn &= property(element, "display", &[("none", false)], notes)?.unwrap_or(true);
    Ok(level)
}

/// Places a nested document or a symbol; fails if it has its own scale.
fn nested(element: &BytesStart<'_>, level: &mut Level) -> Result<(), String> {
    if attribute(element, "viewBox")?.is_some() {
        let name = element.local_name();
        return Err(format!(
            "the `viewBox` of a `{}` within the document is not read",
            name.as_ref()
        ));
    }
    if element.local_name().as_ref() == "svg" {
        let [x, y] = [length(element, "x")?, length(element, "y")?];
        let there = [1.0, 0.0, 0.0, 1.0, x.unwrap_or(0.0), y.unwrap_or(0.0)];
        level.matrix = compose(&level.matrix, &there);
    }
    Ok(())
}

/// Returns the geometry of an element; `None` if it is not a shape, or an empty one.
fn shape(
    element: &BytesStart<'_>,
    level: &Level,
    notes: &mut Vec<String>,
) -> Result<Option<Geometry>, String> {
    let text = |name: &str| attribute(element, name).map(Option::unwrap_or_default);
    let number = |name: &str| length(element, name).map(|value| value.unwrap_or(0.0));
    let size = |name: &str| {
        let value = number(name)?;
        if value < 0.0 {
            Err(format!("`{name}` is {value}; it must not be below 0"))
        } else {
            Ok(value)
        }
    };
    let local = element.local_name();
    let mut path = Path::default();
    match local.as_ref() {
        "path" => path.run(&text("d")?)?,
        "polygon" | "polyline" => {
            let numbers = attributes::numbers(&text("points")?)?;
            let (pairs, odd) = numbers.as_chunks::<2>();
            pairs.iter().for_each(|&pair| path.line_to(DVec2::from(pair)));
            if !odd.is_empty() {
                notes.push("`points` has an x without a y, which is left out".to_owned());
            }
            if local.as_ref() == "polygon" {
                path.close();
            }
        }
        "line" => {
            path.line_to(DVec2::new(number("x1")?, number("y1")?));
            path.line_to(DVec2::new(number("x2")?, number("y2")?));
        }
        "rect" => {
            let (corner, extent) =
                ((number("x")?, number("y")?), (size("width")?, size("height")?));
            let radius = |name: &str| {
                let is_auto = text(name)?.trim() == "auto";
                Ok::<_, String>(if is_auto { None } else { length(element, name)? })
            };
            let (rx, ry) = (radius("rx")?, radius("ry")?);
            let radii = DVec2::new(rx.or(ry).unwrap_or(0.0), ry.or(rx).unwrap_or(0.0));
            path.rectangle(DVec2::from(corner), DVec2::from(extent), radii);
        }
        "circle" => {
            let center = DVec2::new(number("cx")?, number("cy")?);
            path.ellipse(center, DVec2::splat(size("r")?));
        }
        "ellipse" => {
            let center = DVec2::new(number("cx")?, number("cy")?);
            path.ellipse(center, DVec2::new(size("rx")?, size("ry")?));
        }
        "text" | "image" => return Err(format!("`{}` is not read", local.as_ref())),
        "switch" => {
            notes.push("`switch` draws one of its parts; all of them are read".to_owned());
            return Ok(None);
        }
        _ => return Ok(None),
    }
    path.geometry(&level.matrix)
}
