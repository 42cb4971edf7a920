//! Features as a topology, whose arcs keep all digits of the coordinates.

use super::arcs::Arcs;
use crate::geo::geojson::{Flat, position, write_member, write_members};
use crate::geo::{Feature, Geometry, Member, Points};
use std::io::{self, Write};

/// The name of the one object.
const LAYER: &str = "layer";

/// Writes features as one object, in their order.
pub fn write(out: &mut impl Write, features: &[Feature], members: &[Member]) -> io::Result<()> {
    let mut runs = Vec::new();
    features.iter().filter_map(|f| f.geometry.as_ref()).for_each(|g| collect(g, &mut runs));
    let arcs = Arcs::of(&runs);
    out.write_all(br#"{"type":"Topology""#)?;
    write_members(out, members)?;
    write!(out, ",\"objects\":{{\"{LAYER}\":{{\"type\":\"GeometryCollection\",\"geometries\":[")?;
    let mut paths = arcs.paths.iter();
    for (i, feature) in features.iter().enumerate() {
        out.write_all(if i > 0 { b",\n" } else { b"\n" })?;
        write_feature(out, feature, &mut paths)?;
    }
    out.write_all(b"\n]}},\"arcs\":[")?;
    for (i, arc) in arcs.arcs.iter().enumerate() {
        out.write_all(if i > 0 { b",\n" } else { b"\n" })?;
        list(out, 0..arc.len(), |out, j| position(out, arc, j))?;
    }
    out.write_all(b"\n]}\n")
}

/// Collects the lines and rings of a geometry, in the order in which they are written.
fn collect<'a>(geometry: &'a Geometry, runs: &mut Vec<(&'a Points, bool)>) {
    match geometry {
        Geometry::Point(_) | Geometry::MultiPoint(_) => {}
        Geometry::LineString(line) => runs.push((line, false)),
        Geometry::MultiLineString(lines) => runs.extend(lines.iter().map(|line| (line, false))),
        Geometry::Polygon(rings) => runs.extend(rings.iter().map(|ring| (ring, true))),
        Geometry::MultiPolygon(polygons) => {
            runs.extend(polygons.iter().flatten().map(|ring| (ring, true)));
        }
        Geometry::Collection(parts) => parts.iter().for_each(|part| collect(part, runs)),
    }
}

/// The arcs of lines and rings that have not been written.
type Paths<'a> = std::slice::Iter<'a, Vec<i64>>;

fn write_feature(out: &mut impl Write, feature: &Feature, paths: &mut Paths<'_>) -> io::Result<()> {
    match &feature.geometry {
        Some(geometry) => write_geometry(out, geometry, paths)?,
        None => out.write_all(b"{\"type\":null")?,
    }
    if let Some(id) = &feature.id {
        write!(out, ",\"id\":{}", Flat(id))?;
    }
    if let Some(properties) = &feature.properties {
        write!(out, ",\"properties\":{}", Flat(properties))?;
    }
    feature.members.iter().try_for_each(|member| write_member(out, member))?;
    out.write_all(b"}")
}

/// Writes a geometry without its last bracket.
fn write_geometry(
    out: &mut impl Write,
    geometry: &Geometry,
    paths: &mut Paths<'_>,
) -> io::Result<()> {
    write!(out, "{{\"type\":\"{}\",", geometry.name())?;
    match geometry {
        Geometry::Point(points) => {
            out.write_all(b"\"coordinates\":")?;
            if points.is_empty() { out.write_all(b"[]") } else { position(out, points, 0) }
        }
        Geometry::MultiPoint(points) => {
            out.write_all(b"\"coordinates\":")?;
            list(out, 0..points.len(), |out, i| position(out, points, i))
        }
        Geometry::LineString(_) => {
            out.write_all(b"\"arcs\":")?;
            numbers(out, paths)
        }
        Geometry::MultiLineString(runs) | Geometry::Polygon(runs) => {
            out.write_all(b"\"arcs\":")?;
            list(out, 0..runs.len(), |out, _| numbers(out, paths))
        }
        Geometry::MultiPolygon(polygons) => {
            out.write_all(b"\"arcs\":")?;
            list(out, polygons, |out, rings| list(out, rings, |out, _| numbers(out, paths)))
        }
        Geometry::Collection(parts) => {
            out.write_all(b"\"geometries\":")?;
            list(out, parts, |out, part| {
                write_geometry(out, part, paths)?;
                out.write_all(b"}")
            })
        }
    }
}

fn numbers(out: &mut impl Write, paths: &mut Paths<'_>) -> io::Result<()> {
    list(out, paths.next().into_iter().flatten(), |out, arc| write!(out, "{arc}"))
}

/// Writes an array; `write` writes each item.
fn list<W: Write, T>(
    out: &mut W,
    items: impl IntoIterator<Item = T>,
    mut write: impl FnMut(&mut W, T) -> io::Result<()>,
) -> io::Result<()> {
    out.write_all(b"[")?;
    for (i, item) in items.into_iter().enumerate() {
        out.write_all(if i > 0 { b"," } else { b"" })?;
        write(out, item)?;
    }
    out.write_all(b"]")
}
