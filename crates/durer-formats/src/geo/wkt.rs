//! Well-known text of OGC Simple Features, with Z, M and ZM, and PostGIS's EWKT. Curves
//! become lines, surfaces of several polygons groups of them.
//!
//! A file holds any number of geometries, each over any number of lines, parted by blanks or `;`.

use super::curve;
use super::geojson::{finish_line, finish_ring};
use super::{Dimensions, Feature, Geometry, MAX_DEPTH, Points, Warnings, number};
use crate::{Error, Place, Result};
use durer::math::DVec2;
use std::io::{self, Write};

/// Names of types, each at the place of its number in well-known binary, from 1 on.
const NAMES: [&str; 17] = [
    "POINT",
    "LINESTRING",
    "POLYGON",
    "MULTIPOINT",
    "MULTILINESTRING",
    "MULTIPOLYGON",
    "GEOMETRYCOLLECTION",
    "CIRCULARSTRING",
    "COMPOUNDCURVE",
    "CURVEPOLYGON",
    "MULTICURVE",
    "MULTISURFACE",
    "CURVE",
    "SURFACE",
    "POLYHEDRALSURFACE",
    "TIN",
    "TRIANGLE",
];

/// The indices of names of abstract types, which stand only for others.
const ABSTRACT: [usize; 2] = [12, 13];

/// Returns whether a text begins with the name of a geometry and a valid continuation.
pub fn sniff(text: &[u8]) -> bool {
    let letters = text.iter().take_while(|b| b.is_ascii_alphabetic()).count();
    let (word, rest) = text.split_at(letters);
    let word = String::from_utf8_lossy(word).to_ascii_uppercase();
    let next = rest.trim_ascii_start().first();
    match &word[..] {
        "SRID" => next == Some(&b'='),
        _ => {
            tag(&word).is_some()
                && matches!(next, Some(b'(' | b'Z' | b'M' | b'E' | b'z' | b'm' | b'e'))
        }
    }
}

/// Splits `POINTZM` and similar words into the name's index and the dimensions, if there are any.
fn tag(word: &str) -> Option<(usize, Option<Dimensions>)> {
    let index = |name: &str| {
        NAMES.iter().position(|n| *n == name).filter(|found| !ABSTRACT.contains(found))
    };
    if let Some(found) = index(word) {
        return Some((found, None));
    }
    let suffixes = [("ZM", Dimensions::Xyzm), ("Z", Dimensions::Xyz), ("M", Dimensions::Xym)];
    suffixes.into_iter().find_map(|(suffix, dimensions)| {
        index(word.strip_suffix(suffix)?).map(|found| (found, Some(dimensions)))
    })
}

/// Position up to which a text has been read.
#[derive(Debug, Clone, Copy)]
pub struct Mark {
    /// Index of the next byte.
    at: usize,
    /// The last place that was reported: byte, line, and the start of the line.
    last_place: (usize, u64, usize),
}

impl Default for Mark {
    fn default() -> Self {
        Self { at: 0, last_place: (0, 1, 0) }
    }
}

/// Reader of geometries, one after the other.
pub struct Reader<'a> {
    text: &'a [u8],
    at: usize,
    last_place: (usize, u64, usize),
    pub warnings: Warnings,
}

impl<'a> Reader<'a> {
    /// Reads from a mark on.
    pub fn new(text: &'a [u8], Mark { at, last_place }: Mark) -> Self {
        Self { text, at, last_place, warnings: Warnings::default() }
    }

    /// Returns the current position.
    pub fn mark(&self) -> Mark {
        Mark { at: self.at, last_place: self.last_place }
    }

    /// Returns the position after the line of the next geometry.
    pub fn next_line(&mut self) -> Mark {
        self.peek();
        let rest = self.text.get(self.at..).unwrap_or_default();
        self.at += rest.iter().position(|&b| b == b'\n').map_or(rest.len(), |end| end + 1);
        self.mark()
    }

    fn peek(&mut self) -> Option<u8> {
        while self.text.get(self.at).is_some_and(u8::is_ascii_whitespace) {
            self.at += 1;
        }
        self.text.get(self.at).copied()
    }

    fn take(&mut self, byte: u8) -> bool {
        let found = self.peek() == Some(byte);
        self.at += usize::from(found);
        found
    }

    /// Returns the line and column of the next byte that is not a blank; counts on from the last reported place.
    fn place(&mut self) -> Place {
        self.peek();
        let (from, mut line, mut start) = self.last_place;
        for (i, _) in self.text[from..self.at].iter().enumerate().filter(|(_, b)| **b == b'\n') {
            line += 1;
            start = from + i + 1;
        }
        self.last_place = (self.at, line, start);
        Place::Line(line, (self.at - start) as u64 + 1)
    }

    fn error(&mut self, message: impl Into<String>) -> Error {
        Error::Decode { place: self.place(), message: message.into() }
    }

    fn expected(&mut self, what: &str) -> Error {
        let found = match self.peek() {
            None => "the end of the file".to_owned(),
            Some(byte @ 0x21..=0x7e) => format!("`{}`", char::from(byte)),
            Some(byte) => format!("byte {byte:#04x}"),
        };
        self.error(format!("{what} is expected, not {found}"))
    }

    /// Returns the letters that come next, in capitals.
    fn word(&mut self) -> String {
        self.peek();
        let rest = self.text.get(self.at..).unwrap_or_default();
        let length = rest.iter().take_while(|b| b.is_ascii_alphabetic()).count();
        self.at += length;
        String::from_utf8_lossy(&rest[..length]).to_ascii_uppercase()
    }

    /// Takes a word if it is one of these; else nothing.
    fn keyword(&mut self, words: &[&str]) -> Option<String> {
        let before = self.at;
        let word = self.word();
        if words.contains(&&word[..]) {
            return Some(word);
        }
        self.at = before;
        None
    }

    /// Returns the next geometry; `None` at the end.
    pub fn next_feature(&mut self) -> Result<Option<Feature>> {
        while self.take(b';') {}
        if self.peek().is_none() {
            return Ok(None);
        }
        let srid = self.srid()?;
        let geometry = self.geometry(None, 0)?;
        if !matches!(self.peek(), None | Some(b';' | b'A'..=b'Z' | b'a'..=b'z')) {
            return Err(self.expected("the end of the geometry"));
        }
        Ok(Some(Feature { srid, ..Feature::of_geometry(geometry) }))
    }

    fn srid(&mut self) -> Result<Option<i32>> {
        if self.keyword(&["SRID"]).is_none() {
            return Ok(None);
        }
        if !self.take(b'=') {
            return Err(self.expected("`=` after SRID"));
        }
        let rest = self.text.get(self.at..).unwrap_or_default();
        let number = crate::number::integer(rest);
        let Some((srid, length)) = number.and_then(|(n, l)| Some((i32::try_from(n).ok()?, l)))
        else {
            let digits = rest.iter().take_while(|b| matches!(b, b'-' | b'+' | b'0'..=b'9')).count();
            return Err(match rest.get(..digits).filter(|digits| digits.len() > 1) {
                Some(digits) => {
                    let digits = crate::text::quote(digits);
                    self.error(format!("the SRID {digits} must be from -2147483648 to 2147483647"))
                }
                None => self.expected("the number of a coordinate system"),
            });
        };
        self.at += length;
        if self.take(b';') { Ok(Some(srid)) } else { Err(self.expected("`;` after the SRID")) }
    }

    fn geometry(&mut self, outer: Option<Dimensions>, depth: usize) -> Result<Geometry> {
        if depth > MAX_DEPTH {
            return Err(self.error("geometries are nested too deep"));
        }
        let place = self.place();
        let start = self.at;
        let word = self.word();
        let Some((kind, glued)) = tag(&word) else {
            self.at = start;
            return Err(if word.is_empty() {
                self.expected("the name of a geometry")
            } else {
                self.error(format!("`{word}` is not a type of geometry"))
            });
        };
        let apart = self
            .keyword(&["ZM", "Z", "M"])
            .map(|w| Dimensions::new(w.contains('Z'), w.contains('M')));
        let mut dimensions = glued.or(apart).or(outer);
        if self.keyword(&["EMPTY"]).is_some() {
            return Ok(empty(kind));
        }
        let d = &mut dimensions;
        Ok(match kind {
            0 => {
                let mut point = Points::default();
                self.list(|s| s.position(&mut point, d))?;
                if point.len() != 1 {
                    return Err(self.error("a point has one position"));
                }
                Geometry::Point(point)
            }
            1 => Geometry::LineString(self.line(d)?),
            2 | 16 => Geometry::Polygon(self.polygon(d)?),
            7 | 8 => {
                self.at = start;
                let mut line = self.curve(d, depth)?;
                self.warnings.curves.add(|| place.clone());
                finish_line(&mut line, || place.clone(), &mut self.warnings);
                Geometry::LineString(line)
            }
            9 => Geometry::Polygon(self.surface(d, depth)?),
            10 => {
                let mut lines = Vec::new();
                self.warnings.curves.add(|| place.clone());
                self.list(|s| {
                    let mut line = s.curve(d, depth + 1)?;
                    finish_line(&mut line, || place.clone(), &mut s.warnings);
                    lines.push(line);
                    Ok(())
                })?;
                lines.retain(|line| !line.is_empty());
                Geometry::MultiLineString(lines)
            }
            11 => {
                let mut polygons = Vec::new();
                self.list(|s| s.patch(d, depth + 1).map(|rings| polygons.push(rings)))?;
                polygons.retain(|rings: &Vec<Points>| !rings.is_empty());
                Geometry::MultiPolygon(polygons)
            }
            3 => Geometry::MultiPoint(self.multi_point(d)?),
            4 => {
                let mut lines = Vec::new();
                self.list(|s| s.or_empty(|s| s.line(d)).map(|line| lines.extend(line)))?;
                lines.retain(|line: &Points| !line.is_empty());
                Geometry::MultiLineString(lines)
            }
            5 | 14 | 15 => {
                let mut polygons = Vec::new();
                self.list(|s| s.or_empty(|s| s.polygon(d)).map(|p| polygons.extend(p)))?;
                polygons.retain(|rings: &Vec<Points>| !rings.is_empty());
                Geometry::MultiPolygon(polygons)
            }
            _ => {
                let mut parts = Vec::new();
                self.list(|s| s.geometry(dimensions, depth + 1).map(|part| parts.push(part)))?;
                Geometry::Collection(parts)
            }
        })
    }

    /// Reads `( item, item … )`.
    fn list(&mut self, mut item: impl FnMut(&mut Self) -> Result<()>) -> Result<()> {
        if !self.take(b'(') {
            return Err(self.expected("`(` or EMPTY"));
        }
        loop {
            item(self)?;
            if self.take(b')') {
                return Ok(());
            }
            if !self.take(b',') {
                return Err(self.expected("`,` or `)`"));
            }
        }
    }

    fn or_empty<T>(&mut self, read: impl FnOnce(&mut Self) -> Result<T>) -> Result<Option<T>> {
        if self.keyword(&["EMPTY"]).is_some() { Ok(None) } else { read(self).map(Some) }
    }

    fn line(&mut self, dimensions: &mut Option<Dimensions>) -> Result<Points> {
        let place = self.place();
        let mut points = Points::default();
        self.list(|s| s.position(&mut points, dimensions))?;
        finish_line(&mut points, || place.clone(), &mut self.warnings);
        Ok(points)
    }

    /// Returns the next name if it is one of these, with the dimensions that follow it.
    fn name(&mut self, kinds: &[usize], dimensions: &mut Option<Dimensions>) -> Option<usize> {
        let start = self.at;
        let found = tag(&self.word()).filter(|(kind, _)| kinds.contains(kind));
        let Some((kind, glued)) = found else {
            self.at = start;
            return None;
        };
        let apart = self.keyword(&["ZM", "Z", "M"]);
        let apart = apart.map(|w| Dimensions::new(w.contains('Z'), w.contains('M')));
        *dimensions = glued.or(apart).or(*dimensions);
        Some(kind)
    }

    /// Returns a line, with its name or without, an arc, or a chain of both, as a line.
    fn curve(&mut self, dimensions: &mut Option<Dimensions>, depth: usize) -> Result<Points> {
        if depth > MAX_DEPTH {
            return Err(self.error("geometries are nested too deep"));
        }
        let kind = self.name(&[1, 7, 8], dimensions);
        let mut points = Points::default();
        if self.keyword(&["EMPTY"]).is_some() {
            return Ok(points);
        }
        if kind == Some(8) {
            self.list(|s| {
                curve::join(&mut points, &s.curve(dimensions, depth + 1)?);
                Ok(())
            })?;
            return Ok(points);
        }
        let start = self.place();
        self.list(|s| s.position(&mut points, dimensions))?;
        if kind == Some(7) {
            let error = |message: &str| Error::Decode { place: start, message: message.to_owned() };
            return curve::flatten(&points).map_err(error);
        }
        Ok(points)
    }

    /// Returns the rings of a polygon whose name has been read, which may be curves.
    fn surface(
        &mut self,
        dimensions: &mut Option<Dimensions>,
        depth: usize,
    ) -> Result<Vec<Points>> {
        let mut rings = Vec::new();
        let place = self.place();
        self.warnings.curves.add(|| place);
        self.list(|s| {
            let place = s.place();
            let mut ring = s.curve(dimensions, depth + 1)?;
            finish_ring(&mut ring, || place.clone(), &mut s.warnings);
            rings.push(ring);
            Ok(())
        })?;
        curve::keep_polygon(&mut rings);
        Ok(rings)
    }

    /// Returns a part of a group of surfaces: a polygon, with its name or without, or one of
    /// curves.
    fn patch(&mut self, dimensions: &mut Option<Dimensions>, depth: usize) -> Result<Vec<Points>> {
        let kind = self.name(&[2, 9], dimensions);
        if self.keyword(&["EMPTY"]).is_some() {
            return Ok(Vec::new());
        }
        if kind == Some(9) { self.surface(dimensions, depth) } else { self.polygon(dimensions) }
    }

    fn polygon(&mut self, dimensions: &mut Option<Dimensions>) -> Result<Vec<Points>> {
        let mut rings: Vec<Points> = Vec::new();
        let (mut first, mut lost) = (true, false);
        self.list(|s| {
            let place = s.place();
            let mut points = Points::default();
            let given = s.or_empty(|s| s.list(|s| s.position(&mut points, dimensions)))?;
            if given.is_some() {
                finish_ring(&mut points, || place.clone(), &mut s.warnings);
            }
            lost |= first && points.is_empty();
            first = false;
            if lost && !points.is_empty() {
                s.warnings.push(place, "the hole of a ring that was left out; left out too");
            } else if !points.is_empty() {
                rings.push(points);
            }
            Ok(())
        })?;
        Ok(rings)
    }

    /// Reads a multipoint; both `(1 2, 3 4)` and `((1 2), (3 4))` are in use.
    fn multi_point(&mut self, dimensions: &mut Option<Dimensions>) -> Result<Points> {
        let mut points = Points::default();
        self.list(|s| {
            if s.keyword(&["EMPTY"]).is_some() {
                return Ok(());
            }
            let wrapped = s.take(b'(');
            s.position(&mut points, dimensions)?;
            if wrapped && !s.take(b')') {
                return Err(s.expected("`)`"));
            }
            Ok(())
        })?;
        Ok(points)
    }

    fn position(&mut self, points: &mut Points, dimensions: &mut Option<Dimensions>) -> Result<()> {
        let mut numbers = [0.0; 4];
        let mut count = 0;
        while !matches!(self.peek(), None | Some(b',' | b')')) {
            let Some(place) = numbers.get_mut(count) else {
                return Err(self.error("a position has at most four numbers"));
            };
            let rest = self.text.get(self.at..).unwrap_or_default();
            let Some((value, length)) = crate::number::float(rest) else {
                return Err(self.expected("a number"));
            };
            if !value.is_finite() {
                return Err(self.error("coordinates must be finite"));
            }
            *place = value;
            self.at += length;
            count += 1;
        }
        let first = dimensions.get_or_insert(Dimensions::new(count > 2, count > 3));
        if count != first.count() {
            let message = format!(
                "a position of {} numbers is expected, this one has {count}",
                first.count()
            );
            return Err(self.error(message));
        }
        points.dimensions = *first;
        let [x, y, z, m] = numbers;
        points.push(DVec2::new(x, y), if *first == Dimensions::Xym { [0.0, z] } else { [z, m] });
        Ok(())
    }
}

fn empty(kind: usize) -> Geometry {
    match kind {
        0 => Geometry::Point(Points::default()),
        1 => Geometry::LineString(Points::default()),
        2 => Geometry::Polygon(Vec::new()),
        3 => Geometry::MultiPoint(Points::default()),
        4 | 10 => Geometry::MultiLineString(Vec::new()),
        5 | 11 | 14 | 15 => Geometry::MultiPolygon(Vec::new()),
        7 | 8 => Geometry::LineString(Points::default()),
        9 | 16 => Geometry::Polygon(Vec::new()),
        _ => Geometry::Collection(Vec::new()),
    }
}

/// Writes a feature's geometry on one line; nothing if it has none.
pub fn write_feature(out: &mut impl Write, feature: &Feature) -> io::Result<()> {
    let Some(geometry) = &feature.geometry else { return Ok(()) };
    if let Some(srid) = feature.srid {
        write!(out, "SRID={srid};")?;
    }
    write_geometry(out, geometry)?;
    out.write_all(b"\n")
}

fn write_geometry(out: &mut impl Write, geometry: &Geometry) -> io::Result<()> {
    let (kind, dimensions) = (super::wkb::kind(geometry), geometry.dimensions());
    let name = NAMES.get(kind as usize - 1).copied().unwrap_or_default();
    let letters = match dimensions {
        Dimensions::Xy => "",
        Dimensions::Xyz => " Z",
        Dimensions::Xym => " M",
        Dimensions::Xyzm => " ZM",
    };
    write!(out, "{name}{letters} ")?;
    if geometry.is_empty() {
        return out.write_all(b"EMPTY");
    }
    match geometry {
        Geometry::Point(points) | Geometry::LineString(points) | Geometry::MultiPoint(points) => {
            run(out, points, false)
        }
        Geometry::Polygon(rings) => list(out, rings, |out, ring| run(out, ring, true)),
        Geometry::MultiLineString(lines) => list(out, lines, |out, line| run(out, line, false)),
        Geometry::MultiPolygon(polygons) => {
            list(out, polygons, |out, rings| list(out, rings, |out, ring| run(out, ring, true)))
        }
        Geometry::Collection(parts) => list(out, parts, |out, part| write_geometry(out, part)),
    }
}

fn list<W: Write, T>(
    out: &mut W,
    items: &[T],
    write: impl Fn(&mut W, &T) -> io::Result<()>,
) -> io::Result<()> {
    out.write_all(b"(")?;
    for (i, item) in items.iter().enumerate() {
        if i > 0 {
            out.write_all(b", ")?;
        }
        write(out, item)?;
    }
    out.write_all(b")")
}

fn run(out: &mut impl Write, points: &Points, closed: bool) -> io::Result<()> {
    let again = (closed && !points.is_empty()).then_some(0);
    let order: Vec<usize> = (0..points.len()).chain(again).collect();
    list(out, &order, |out, &index| {
        for (i, n) in points.ordinates(index).enumerate() {
            if i > 0 {
                out.write_all(b" ")?;
            }
            number::write(out, n)?;
        }
        Ok(())
    })
}
