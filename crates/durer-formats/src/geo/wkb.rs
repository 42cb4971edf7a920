//! Well-known binary of OGC Simple Features (ISO 13249-3), and PostGIS's EWKB; both byte orders.
//!
//! A file holds any number of geometries, one after the other.

use super::curve;
use super::geojson::{finish_line, finish_ring};
use super::{Dimensions, Feature, Geometry, MAX_DEPTH, Points, Warnings};
use crate::{Error, Place, Result};
use durer::math::DVec2;
use std::io::{self, Write};

/// Flags that EWKB adds to the type.
const HAS_Z: u32 = 0x8000_0000;
const HAS_M: u32 = 0x4000_0000;
const HAS_SRID: u32 = 0x2000_0000;

/// Returns the number of a geometry's type, from 1 for a point to 7 for a collection.
pub fn kind(geometry: &Geometry) -> u32 {
    match geometry {
        Geometry::Point(_) => 1,
        Geometry::LineString(_) => 2,
        Geometry::Polygon(_) => 3,
        Geometry::MultiPoint(_) => 4,
        Geometry::MultiLineString(_) => 5,
        Geometry::MultiPolygon(_) => 6,
        Geometry::Collection(_) => 7,
    }
}

/// The numbers of lines, arcs and chains of both.
const CURVES: [u32; 3] = [2, 8, 9];

/// Returns whether the bytes begin like a geometry.
pub fn sniff(bytes: &[u8]) -> bool {
    match bytes {
        [order @ (0 | 1), a, b, c, d, ..] => {
            let word = [*a, *b, *c, *d];
            let code =
                if *order == 0 { u32::from_be_bytes(word) } else { u32::from_le_bytes(word) };
            kind_of(code).is_some()
        }
        _ => false,
    }
}

/// Returns whether the text begins like a geometry in hexadecimal digits.
pub fn sniff_hex(text: &[u8]) -> bool {
    let digits = text.strip_prefix(b"\\x").unwrap_or(text);
    let head: Option<Vec<u8>> =
        digits.get(..10).and_then(|d| d.as_chunks::<2>().0.iter().map(|&p| hex(p)).collect());
    head.is_some_and(|head| sniff(&head))
}

fn hex([a, b]: [u8; 2]) -> Option<u8> {
    let digit = |d: u8| char::from(d).to_digit(16).map(|d| d as u8);
    Some(digit(a)? << 4 | digit(b)?)
}

/// Returns type and dimensions of a type code of ISO or EWKB; `None` if it is neither.
fn kind_of(code: u32) -> Option<(u32, Dimensions)> {
    let plain = code & !(HAS_Z | HAS_M | HAS_SRID);
    let (kind, thousands) = (plain % 1000, plain / 1000);
    let z = code & HAS_Z != 0 || matches!(thousands, 1 | 3);
    let m = code & HAS_M != 0 || matches!(thousands, 2 | 3);
    (matches!(kind, 1..=12 | 15..=17) && thousands <= 3).then(|| (kind, Dimensions::new(z, m)))
}

/// Returns the bytes of a line of hexadecimal digits.
pub fn decode_hex(line: &[u8], number: u64) -> Result<Vec<u8>> {
    let digits = line.strip_prefix(b"\\x").unwrap_or(line);
    let skipped = line.len() - digits.len();
    let (pairs, odd) = digits.as_chunks::<2>();
    let wrong = |i: usize| {
        let message = "two hexadecimal digits are expected";
        Error::line(number, (skipped + 2 * i + 1) as u64, message)
    };
    if !odd.is_empty() {
        return Err(wrong(pairs.len()));
    }
    pairs.iter().enumerate().map(|(i, &pair)| hex(pair).ok_or_else(|| wrong(i))).collect()
}

/// Reader of geometries, one after the other.
pub struct Reader<'a> {
    bytes: &'a [u8],
    at: usize,
    pub warnings: Warnings,
}

/// The start of a geometry.
struct Header {
    kind: u32,
    dimensions: Dimensions,
    srid: Option<i32>,
    big: bool,
}

impl<'a> Reader<'a> {
    pub fn new(bytes: &'a [u8]) -> Self {
        Self { bytes, at: 0, warnings: Warnings::default() }
    }

    /// Returns the index of the next byte to read.
    pub fn offset(&self) -> usize {
        self.at
    }

    /// Continues from a byte.
    pub fn resume(&mut self, at: usize) {
        self.at = at;
    }

    /// Returns the next geometry; `None` at the end.
    pub fn next_feature(&mut self) -> Result<Option<Feature>> {
        if self.at >= self.bytes.len() {
            return Ok(None);
        }
        let header = self.header()?;
        let srid = header.srid;
        let geometry = self.geometry(&header, 0)?;
        Ok(Some(Feature { srid, ..Feature::of_geometry(geometry) }))
    }

    fn error_at(&self, at: usize, message: impl Into<String>) -> Error {
        Error::byte(at as u64, message)
    }

    fn take<const N: usize>(&mut self) -> Result<[u8; N]> {
        let rest = self.bytes.get(self.at..).unwrap_or_default();
        let found = rest.first_chunk::<N>().copied();
        let taken =
            found.ok_or_else(|| self.error_at(self.at, "the data end within a geometry"))?;
        self.at += N;
        Ok(taken)
    }

    fn word(&mut self, big: bool) -> Result<u32> {
        let bytes = self.take()?;
        Ok(if big { u32::from_be_bytes(bytes) } else { u32::from_le_bytes(bytes) })
    }

    fn number(&mut self, big: bool) -> Result<f64> {
        let bytes = self.take()?;
        Ok(if big { f64::from_be_bytes(bytes) } else { f64::from_le_bytes(bytes) })
    }

    fn header(&mut self) -> Result<Header> {
        let at = self.at;
        let [order] = self.take()?;
        if order > 1 {
            return Err(self.error_at(at, format!("byte order {order}; it must be 0 or 1")));
        }
        let big = order == 0;
        let code = self.word(big)?;
        let Some((kind, dimensions)) = kind_of(code) else {
            let what = format!("well-known binary of type {code}");
            let hint = "types 1 to 12 and 15 to 17 are: points, lines, polygons, curves, surfaces and collections".to_owned();
            return Err(Error::Unsupported { place: Place::Byte(at as u64 + 1), what, hint });
        };
        let srid = if code & HAS_SRID != 0 { Some(self.word(big)? as i32) } else { None };
        Ok(Header { kind, dimensions, srid, big })
    }

    /// Returns a count of items of at least `least` bytes each; refuses it if the data are too short.
    fn count(&mut self, big: bool, least: usize) -> Result<usize> {
        let at = self.at;
        let count = self.word(big)? as usize;
        let left = self.bytes.len() - self.at;
        if count > left / least {
            let message = format!("a count of {count}, but only {left} bytes are left");
            return Err(self.error_at(at, message));
        }
        Ok(count)
    }

    fn geometry(&mut self, header: &Header, depth: usize) -> Result<Geometry> {
        if depth > MAX_DEPTH {
            return Err(self.error_at(self.at, "geometries are nested too deep"));
        }
        let place = Place::Byte(self.at as u64);
        Ok(match header.kind {
            1 => Geometry::Point(self.point(header)?),
            2 => Geometry::LineString(self.line(header)?),
            8 | 9 => {
                let mut line = self.curve(header, depth)?;
                self.warnings.curves.add(|| place.clone());
                finish_line(&mut line, || place.clone(), &mut self.warnings);
                Geometry::LineString(line)
            }
            3 | 17 => Geometry::Polygon(self.polygon(header)?),
            10 => Geometry::Polygon(self.surface(header, depth)?),
            4 => {
                let mut all = Points::new(header.dimensions);
                self.parts(header, &[1], |s, part| {
                    let point = s.point(part)?;
                    all.dimensions = if all.is_empty() { part.dimensions } else { all.dimensions };
                    (0..point.len()).for_each(|i| all.push(point.xy[i], point.zm(i)));
                    Ok(())
                })?;
                Geometry::MultiPoint(all)
            }
            5 => {
                let mut lines = Vec::new();
                self.parts(header, &[2], |s, part| s.line(part).map(|line| lines.push(line)))?;
                lines.retain(|line| !line.is_empty());
                Geometry::MultiLineString(lines)
            }
            11 => {
                let mut lines = Vec::new();
                self.warnings.curves.add(|| place.clone());
                self.parts(header, &CURVES, |s, part| {
                    let mut line = s.curve(part, depth + 1)?;
                    finish_line(&mut line, || place.clone(), &mut s.warnings);
                    lines.push(line);
                    Ok(())
                })?;
                lines.retain(|line| !line.is_empty());
                Geometry::MultiLineString(lines)
            }
            12 => {
                let mut polygons = Vec::new();
                self.parts(header, &[3, 10], |s, part| {
                    let is_flat = part.kind == 3;
                    polygons.push(if is_flat {
                        s.polygon(part)?
                    } else {
                        s.surface(part, depth + 1)?
                    });
                    Ok(())
                })?;
                polygons.retain(|rings| !rings.is_empty());
                Geometry::MultiPolygon(polygons)
            }
            6 | 15 | 16 => {
                let kinds: &[u32] = if header.kind == 6 { &[3] } else { &[3, 17] };
                let mut polygons = Vec::new();
                self.parts(header, kinds, |s, part| {
                    s.polygon(part).map(|rings| polygons.push(rings))
                })?;
                polygons.retain(|rings| !rings.is_empty());
                Geometry::MultiPolygon(polygons)
            }
            _ => {
                let mut parts = Vec::new();
                self.parts(header, &[], |s, part| {
                    s.geometry(part, depth + 1).map(|geometry| parts.push(geometry))
                })?;
                Geometry::Collection(parts)
            }
        })
    }

    /// Reads the parts of a collection, each with its own header, of one of `kinds`; of any kind if `kinds` is empty.
    fn parts(
        &mut self,
        header: &Header,
        kinds: &[u32],
        mut read: impl FnMut(&mut Self, &Header) -> Result<()>,
    ) -> Result<()> {
        // Byte order, type and a count.
        let count = self.count(header.big, 9)?;
        for _ in 0..count {
            let at = self.at;
            let part = self.header()?;
            if !kinds.is_empty() && !kinds.contains(&part.kind) {
                let kinds: Vec<String> = kinds.iter().map(u32::to_string).collect();
                let message =
                    format!("a part of type {}; {} is expected", part.kind, kinds.join(" or "));
                return Err(self.error_at(at + 1, message));
            }
            read(self, &part)?;
        }
        Ok(())
    }

    /// Returns a point; an empty one if all numbers are NaN.
    fn point(&mut self, header: &Header) -> Result<Points> {
        let mut points = Points::new(header.dimensions);
        let at = self.at;
        let mut numbers = [0.0; 4];
        for number in numbers.iter_mut().take(header.dimensions.count()) {
            *number = self.number(header.big)?;
        }
        let given = numbers.get(..header.dimensions.count()).unwrap_or_default();
        if !given.iter().all(|n| n.is_nan()) {
            self.push(&mut points, numbers, at)?;
        }
        Ok(points)
    }

    fn push(&self, points: &mut Points, numbers: [f64; 4], at: usize) -> Result<()> {
        if let Some(i) = numbers.iter().position(|n| !n.is_finite()) {
            return Err(self.error_at(at + 8 * i, "coordinates must be finite"));
        }
        let [x, y, z, m] = numbers;
        let only_m = points.dimensions == Dimensions::Xym;
        points.push(DVec2::new(x, y), if only_m { [0.0, z] } else { [z, m] });
        Ok(())
    }

    fn run(&mut self, header: &Header) -> Result<Points> {
        let size = header.dimensions.count();
        let count = self.count(header.big, 8 * size)?;
        let mut points = Points::new(header.dimensions);
        points.xy.reserve_exact(count);
        if size == 2 && !header.big && self.pairs(&mut points.xy, count) {
            return Ok(points);
        }
        for _ in 0..count {
            let at = self.at;
            let mut numbers = [0.0; 4];
            for number in numbers.iter_mut().take(size) {
                *number = self.number(header.big)?;
            }
            self.push(&mut points, numbers, at)?;
        }
        Ok(points)
    }

    /// Reads little-endian pairs of numbers; reads nothing and returns false if one is not finite.
    fn pairs(&mut self, points: &mut Vec<DVec2>, count: usize) -> bool {
        let rest = self.bytes.get(self.at..).unwrap_or_default().as_chunks::<8>().0;
        let (pairs, _) = rest.get(..2 * count).unwrap_or_default().as_chunks::<2>();
        points.extend(pairs.iter().map(|&pair| DVec2::from(pair.map(f64::from_le_bytes))));
        let all = points.len() == count && points.iter().all(|p| p.is_finite());
        if all {
            self.at += 16 * count;
        } else {
            points.clear();
        }
        all
    }

    fn line(&mut self, header: &Header) -> Result<Points> {
        let place = Place::Byte(self.at as u64);
        let mut points = self.run(header)?;
        finish_line(&mut points, || place.clone(), &mut self.warnings);
        Ok(points)
    }

    /// Returns a line, an arc or a chain of both, as a line.
    fn curve(&mut self, header: &Header, depth: usize) -> Result<Points> {
        if depth > MAX_DEPTH {
            return Err(self.error_at(self.at, "geometries are nested too deep"));
        }
        let at = self.at;
        match header.kind {
            8 => {
                let control = self.run(header)?;
                curve::flatten(&control).map_err(|message| self.error_at(at, message))
            }
            9 => {
                let mut joined = Points::new(header.dimensions);
                self.parts(header, &CURVES, |s, part| {
                    curve::join(&mut joined, &s.curve(part, depth + 1)?);
                    Ok(())
                })?;
                Ok(joined)
            }
            _ => self.run(header),
        }
    }

    /// Returns a polygon whose rings are curves.
    fn surface(&mut self, header: &Header, depth: usize) -> Result<Vec<Points>> {
        let place = Place::Byte(self.at as u64);
        self.warnings.curves.add(|| place.clone());
        let mut rings = Vec::new();
        self.parts(header, &CURVES, |s, part| {
            let mut ring = s.curve(part, depth + 1)?;
            finish_ring(&mut ring, || place.clone(), &mut s.warnings);
            rings.push(ring);
            Ok(())
        })?;
        curve::keep_polygon(&mut rings);
        Ok(rings)
    }

    fn polygon(&mut self, header: &Header) -> Result<Vec<Points>> {
        let mut rings: Vec<Points> = Vec::new();
        let mut lost = false;
        for index in 0..self.count(header.big, 4)? {
            let place = Place::Byte(self.at as u64);
            let mut ring = self.run(header)?;
            finish_ring(&mut ring, || place.clone(), &mut self.warnings);
            lost |= index == 0 && ring.is_empty();
            if lost && !ring.is_empty() {
                self.warnings.push(place, "the hole of a ring that was left out; left out too");
            } else if !ring.is_empty() {
                rings.push(ring);
            }
        }
        Ok(rings)
    }
}

/// Returns the geometry of well-known binary, with the number of its coordinate system in EWKB.
///
/// ```
/// use durer_formats::geo::{Geometry, from_wkb, to_wkb};
/// use durer::geometry::Points;
/// use durer::math::DVec2;
///
/// let point = Geometry::Point(Points::flat(vec![DVec2::new(1.0, 2.0)]));
/// let mut bytes = Vec::new();
/// to_wkb(&mut bytes, &point, None)?;
/// assert_eq!(from_wkb(&bytes)?.0, point);
/// # Ok::<(), durer_formats::Error>(())
/// ```
///
/// # Errors
/// [`Error::Decode`] with the byte, also for bytes after the geometry; [`Error::Unsupported`] for geometries that durer
/// does not know.
pub fn from_wkb(bytes: &[u8]) -> Result<(Geometry, Option<i32>)> {
    let mut reader = Reader::new(bytes);
    let header = reader.header()?;
    let geometry = reader.geometry(&header, 0)?;
    if reader.at < bytes.len() {
        return Err(
            reader.error_at(reader.at, "bytes follow the geometry; it must be the only one")
        );
    }
    Ok((geometry, header.srid))
}

/// Writes a geometry as well-known binary, little-endian: as EWKB if it has the number of a coordinate system, else as
/// ISO.
///
/// # Errors
/// [`Error::Io`] if writing fails.
pub fn to_wkb(out: &mut impl Write, geometry: &Geometry, srid: Option<i32>) -> Result<()> {
    Ok(write_geometry(out, geometry, srid)?)
}

/// Writes a feature's geometry, little-endian: as EWKB if it has an SRID, else as ISO.
pub fn write_feature(out: &mut impl Write, feature: &Feature) -> io::Result<()> {
    match &feature.geometry {
        Some(geometry) => write_geometry(out, geometry, feature.srid),
        None => Ok(()),
    }
}

fn write_geometry(out: &mut impl Write, geometry: &Geometry, srid: Option<i32>) -> io::Result<()> {
    let dimensions = geometry.dimensions();
    write_header(out, kind(geometry), dimensions, srid)?;
    let nested = |out: &mut _, part: &Geometry| {
        // PostGIS marks the SRID on the whole only, the dimensions on the parts too.
        if srid.is_some() { write_flagged(out, part) } else { write_geometry(out, part, None) }
    };
    write_body(out, geometry, dimensions, nested)
}

fn write_flagged<W: Write>(out: &mut W, geometry: &Geometry) -> io::Result<()> {
    let dimensions = geometry.dimensions();
    out.write_all(&[1])?;
    out.write_all(&(kind(geometry) | flags(dimensions)).to_le_bytes())?;
    write_body(out, geometry, dimensions, write_flagged)
}

fn flags(dimensions: Dimensions) -> u32 {
    let z = if dimensions.has_z() { HAS_Z } else { 0 };
    z | if dimensions.has_m() { HAS_M } else { 0 }
}

fn write_header(
    out: &mut impl Write,
    kind: u32,
    dimensions: Dimensions,
    srid: Option<i32>,
) -> io::Result<()> {
    let thousands = u32::from(dimensions.has_z()) + 2 * u32::from(dimensions.has_m());
    out.write_all(&[1])?;
    match srid {
        Some(srid) => {
            out.write_all(&(kind | flags(dimensions) | HAS_SRID).to_le_bytes())?;
            out.write_all(&srid.to_le_bytes())
        }
        None => out.write_all(&(kind + 1000 * thousands).to_le_bytes()),
    }
}

fn write_body<W: Write>(
    out: &mut W,
    geometry: &Geometry,
    dimensions: Dimensions,
    nested: impl Fn(&mut W, &Geometry) -> io::Result<()>,
) -> io::Result<()> {
    match geometry {
        Geometry::Point(points) if points.is_empty() => {
            (0..dimensions.count()).try_for_each(|_| out.write_all(&f64::NAN.to_le_bytes()))
        }
        Geometry::Point(points) => position(out, points, 0),
        Geometry::LineString(points) => run(out, points, false),
        Geometry::Polygon(rings) => write_rings(out, rings),
        Geometry::MultiPoint(points) => {
            count(out, points.len())?;
            (0..points.len()).try_for_each(|i| {
                let mut point = Points::new(points.dimensions);
                point.push(points.xy[i], points.zm(i));
                nested(out, &Geometry::Point(point))
            })
        }
        Geometry::MultiLineString(lines) => {
            count(out, lines.len())?;
            lines.iter().try_for_each(|line| nested(out, &Geometry::LineString(line.clone())))
        }
        Geometry::MultiPolygon(polygons) => {
            count(out, polygons.len())?;
            polygons.iter().try_for_each(|rings| nested(out, &Geometry::Polygon(rings.clone())))
        }
        Geometry::Collection(parts) => {
            count(out, parts.len())?;
            parts.iter().try_for_each(|part| nested(out, part))
        }
    }
}

fn count(out: &mut impl Write, count: usize) -> io::Result<()> {
    let count = u32::try_from(count).map_err(|_| io::Error::other("too many parts for WKB"))?;
    out.write_all(&count.to_le_bytes())
}

fn write_rings(out: &mut impl Write, rings: &[Points]) -> io::Result<()> {
    count(out, rings.len())?;
    rings.iter().try_for_each(|ring| run(out, ring, true))
}

fn run(out: &mut impl Write, points: &Points, closed: bool) -> io::Result<()> {
    let again = (closed && !points.is_empty()).then_some(0);
    count(out, points.len() + usize::from(again.is_some()))?;
    (0..points.len()).chain(again).try_for_each(|i| position(out, points, i))
}

fn position(out: &mut impl Write, points: &Points, index: usize) -> io::Result<()> {
    points.ordinates(index).try_for_each(|n| out.write_all(&n.to_le_bytes()))
}
