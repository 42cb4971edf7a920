//! The geometry of a record.

use super::Faults;
use crate::geo::geojson::{finish_line, finish_ring};
use crate::geo::rings;
use crate::geo::{Dimensions, Geometry, Points, Warnings};
use crate::{Error, Place, Result};
use durer::math::DVec2;

/// Limit below which a measure means "none".
const NO_MEASURE: f64 = -1e38;

/// Numbers of a record, one after the other, little-endian.
struct Numbers<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl Numbers<'_> {
    fn take<const N: usize>(&mut self) -> Option<[u8; N]> {
        let found = self.bytes.get(self.at..)?.first_chunk::<N>().copied();
        self.at += N;
        found
    }

    fn whole(&mut self) -> Option<u32> {
        self.take().map(u32::from_le_bytes)
    }

    fn double(&mut self) -> Option<f64> {
        self.take().map(f64::from_le_bytes)
    }

    /// Returns the number of items of the given size in bytes; `None` if there is no room for them.
    fn count(&mut self, size: usize) -> Option<usize> {
        let count = self.whole()? as usize;
        let left = self.bytes.len().checked_sub(self.at)?;
        (count <= left / size).then_some(count)
    }

    fn left(&self) -> usize {
        self.bytes.len().saturating_sub(self.at)
    }
}

/// Content of a record before it becomes a geometry.
struct Content {
    points: Points,
    /// The first position of each part.
    starts: Vec<usize>,
    /// Kinds of a multipatch's parts.
    kinds: Vec<u32>,
}

impl Content {
    fn parts(&self) -> impl Iterator<Item = Points> + '_ {
        let ends = self.starts.iter().skip(1).copied().chain([self.points.len()]);
        self.starts.iter().zip(ends).map(|(&start, end)| self.part(start, end))
    }

    /// Returns the positions from one to another, or none if they are not in this order.
    fn part(&self, start: usize, end: usize) -> Points {
        let mut part = Points::new(self.points.dimensions);
        part.xy = self.points.xy.get(start..end).unwrap_or_default().to_vec();
        part.zm = self.points.zm.get(start..end).unwrap_or_default().to_vec();
        part
    }
}

/// Reads a record's content; nothing where it holds none, or cannot be shown.
pub fn read(
    bytes: &[u8],
    place: &Place,
    faults: &mut Faults,
    warnings: &mut Warnings,
) -> Result<Option<Geometry>> {
    let wrong = |message: String| Error::Decode { place: place.clone(), message };
    let kind = bytes.first_chunk().map_or(0, |b| u32::from_le_bytes(*b));
    if kind == 0 {
        return Ok(None);
    }
    let shape = if kind == MULTIPATCH { 5 } else { kind % 10 };
    if !matches!(kind, 1..=28 | MULTIPATCH) || !matches!(shape, 1 | 3 | 5 | 8) {
        let message =
            "a shape of the kinds 0, 1, 3, 5, 8, 11 … 18, 21 … 28 or 31 is expected, not ";
        return Err(wrong(format!("{message}{kind}")));
    }
    let content = content(bytes, kind, shape, place, faults);
    let content = content.ok_or_else(|| wrong("the record ends within its shape".to_owned()))?;
    // Some programs write a point without coordinates for an empty geometry.
    if shape == 1 && content.points.xy.iter().any(|p| p.is_nan()) {
        return Ok(None);
    }
    let finite = |z: &[f64; 2]| z.iter().all(|n| n.is_finite());
    if !content.points.xy.iter().all(|p| p.is_finite()) || !content.points.zm.iter().all(finite) {
        faults.infinite.add(|| place.clone());
        return Ok(None);
    }
    Ok(Some(match shape {
        1 => Geometry::Point(content.points),
        8 => Geometry::MultiPoint(content.points),
        3 => lines(&content, place, warnings),
        _ if kind == MULTIPATCH => {
            faults.patches.add(|| place.clone());
            polygons(patches(&content, place, warnings))
        }
        _ => polygons(areas(&content, place, warnings)),
    }))
}

/// The kind of surfaces in space.
const MULTIPATCH: u32 = 31;

fn content(
    bytes: &[u8],
    kind: u32,
    shape: u32,
    place: &Place,
    faults: &mut Faults,
) -> Option<Content> {
    let mut from = Numbers { bytes, at: 4 };
    let mut content = Content { points: Points::default(), starts: vec![0], kinds: Vec::new() };
    let mut count = 1;
    if shape != 1 {
        from.at += 32;
    }
    if matches!(shape, 3 | 5) {
        let parts = from.count(4)?;
        count = from.count(1)?;
        content.starts =
            (0..parts).map(|_| from.whole().map(|n| n as usize)).collect::<Option<_>>()?;
        if kind == MULTIPATCH {
            content.kinds = (0..parts).map(|_| from.whole()).collect::<Option<_>>()?;
        }
    } else if shape == 8 {
        count = from.count(16)?;
    }
    if count > from.left() / 16 {
        return None;
    }
    let xy = (0..count).map(|_| Some(DVec2::new(from.double()?, from.double()?)));
    content.points.xy = xy.collect::<Option<_>>()?;
    let has_z = matches!(kind, 11..=18 | MULTIPATCH);
    let z = if has_z { Some(further(&mut from, shape, count)?) } else { None };
    // Measures of shapes with heights may be left out.
    let m = if kind > 10 { further(&mut from, shape, count) } else { None };
    let m = m.filter(|m| m.iter().any(|m| *m > NO_MEASURE));
    if let Some(m) = &m
        && m.iter().any(|m| *m <= NO_MEASURE)
    {
        faults.measures.add(|| place.clone());
    }
    content.points.dimensions = Dimensions::new(z.is_some(), m.is_some());
    if z.is_some() || m.is_some() {
        let at =
            |list: &Option<Vec<f64>>, i| list.as_ref().and_then(|l: &Vec<f64>| l.get(i)).copied();
        let measure = |i| at(&m, i).filter(|m| *m > NO_MEASURE).unwrap_or(0.0);
        content.points.zm = (0..count).map(|i| [at(&z, i).unwrap_or(0.0), measure(i)]).collect();
    }
    Some(content)
}

/// Reads heights or measures; for several positions, their range comes first.
fn further(from: &mut Numbers<'_>, shape: u32, count: usize) -> Option<Vec<f64>> {
    if shape != 1 {
        from.at += 16;
    }
    if count > from.left() / 8 {
        return None;
    }
    (0..count).map(|_| from.double()).collect()
}

fn lines(content: &Content, place: &Place, warnings: &mut Warnings) -> Geometry {
    let mut lines: Vec<Points> = content.parts().collect();
    for line in &mut lines {
        finish_line(line, || place.clone(), warnings);
    }
    lines.retain(|line| !line.is_empty());
    match <[Points; 1]>::try_from(lines) {
        Ok([line]) => Geometry::LineString(line),
        Err(lines) => Geometry::MultiLineString(lines),
    }
}

/// Returns the polygons of rings; outer ones should run clockwise.
fn areas(content: &Content, place: &Place, warnings: &mut Warnings) -> Vec<Vec<Points>> {
    let mut all: Vec<Points> = content.parts().collect();
    for ring in &mut all {
        finish_ring(ring, || place.clone(), warnings);
    }
    all.retain(|ring| !ring.is_empty());
    rings::directed(all, place, warnings)
}

/// Returns the polygons of triangles and rings.
fn patches(content: &Content, place: &Place, warnings: &mut Warnings) -> Vec<Vec<Points>> {
    let mut polygons: Vec<Vec<Points>> = Vec::new();
    for (mut part, &kind) in content.parts().zip(&content.kinds) {
        match kind {
            0 | 1 => polygons.extend((2..part.len()).map(|i| {
                let first = if kind == 0 { i - 2 } else { 0 };
                let mut triangle = Points::new(part.dimensions);
                [first, i - 1, i].iter().for_each(|&j| triangle.push(part.xy[j], part.zm(j)));
                vec![triangle]
            })),
            _ => {
                finish_ring(&mut part, || place.clone(), warnings);
                match polygons.last_mut() {
                    _ if part.is_empty() => {}
                    // An inner ring, or a further one, belongs to the ring before.
                    Some(polygon) if kind == 3 || kind == 5 => polygon.push(part),
                    _ => polygons.push(vec![part]),
                }
            }
        }
    }
    polygons
}

fn polygons(polygons: Vec<Vec<Points>>) -> Geometry {
    match <[Vec<Points>; 1]>::try_from(polygons) {
        Ok([polygon]) => Geometry::Polygon(polygon),
        Err(polygons) => Geometry::MultiPolygon(polygons),
    }
}
