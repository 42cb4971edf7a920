//! Features as GeoJSON text.

use crate::geo::{Feature, Geometry, Member, Points, number};
use std::io::{self, Write};

/// Writes a feature on one line, without a line end.
pub fn write_feature(out: &mut impl Write, feature: &Feature) -> io::Result<()> {
    out.write_all(br#"{"type":"Feature""#)?;
    if let Some(id) = &feature.id {
        write!(out, r#","id":{}"#, Flat(id))?;
    }
    write_members(out, &feature.members)?;
    let properties = feature.properties.as_deref().unwrap_or("null");
    write!(out, r#","properties":{},"geometry":"#, Flat(properties))?;
    match &feature.geometry {
        Some(geometry) => {
            open_geometry(out, geometry)?;
            write_members(out, &feature.geometry_members)?;
            out.write_all(b"}")?;
        }
        None => out.write_all(b"null")?,
    }
    out.write_all(b"}")
}

/// Writes members, each with a comma before it.
pub fn write_members(out: &mut impl Write, members: &[Member]) -> io::Result<()> {
    members.iter().try_for_each(|member| write_member(out, member))
}

/// Writes a member with a comma before it.
pub fn write_member(out: &mut impl Write, member: &Member) -> io::Result<()> {
    write!(out, ",{}:{}", Flat(&member.name), Flat(&member.value))
}

/// JSON unchanged, but on one line: line ends between its parts become blanks. (Within strings JSON
/// has none.)
pub struct Flat<'a>(pub &'a str);

impl std::fmt::Display for Flat<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        for (i, line) in self.0.split(['\n', '\r']).enumerate() {
            if i > 0 {
                f.write_str(" ")?;
            }
            f.write_str(line)?;
        }
        Ok(())
    }
}

fn write_geometry<W: Write>(out: &mut W, geometry: &Geometry) -> io::Result<()> {
    open_geometry(out, geometry)?;
    out.write_all(b"}")
}

/// Writes a geometry without its last bracket.
fn open_geometry<W: Write>(out: &mut W, geometry: &Geometry) -> io::Result<()> {
    write!(out, r#"{{"type":"{}","#, geometry.name())?;
    if let Geometry::Collection(parts) = geometry {
        out.write_all(br#""geometries":"#)?;
        return list(out, parts, |out, part| write_geometry(out, part));
    }
    out.write_all(br#""coordinates":"#)?;
    match geometry {
        Geometry::Point(points) if points.is_empty() => out.write_all(b"[]"),
        Geometry::Point(points) => position(out, points, 0),
        Geometry::LineString(points) | Geometry::MultiPoint(points) => run(out, points, false),
        Geometry::MultiLineString(lines) => list(out, lines, |out, line| run(out, line, false)),
        Geometry::Polygon(rings) => list(out, rings, |out, ring| run(out, ring, true)),
        Geometry::MultiPolygon(polygons) => {
            list(out, polygons, |out, rings| list(out, rings, |out, ring| run(out, ring, true)))
        }
        Geometry::Collection(_) => Ok(()),
    }
}

/// Writes an array; `write` writes each item.
fn list<W: Write, T>(
    out: &mut W,
    items: &[T],
    write: impl Fn(&mut W, &T) -> io::Result<()>,
) -> io::Result<()> {
    out.write_all(b"[")?;
    for (i, item) in items.iter().enumerate() {
        if i > 0 {
            out.write_all(b",")?;
        }
        write(out, item)?;
    }
    out.write_all(b"]")
}

fn run(out: &mut impl Write, points: &Points, closed: bool) -> io::Result<()> {
    let again = (closed && !points.is_empty()).then_some(0);
    let order: Vec<usize> = (0..points.len()).chain(again).collect();
    list(out, &order, |out, &i| position(out, points, i))
}

/// Writes a position. GeoJSON knows no measure without a height: then the height is 0.
pub fn position(out: &mut impl Write, points: &Points, index: usize) -> io::Result<()> {
    let (p, [z, m]) = (points.xy[index], points.zm(index));
    let further = [z, m];
    let count = points.dimensions.count().max(if points.dimensions.has_m() { 4 } else { 2 });
    let numbers: Vec<f64> = [p.x, p.y].into_iter().chain(further).take(count).collect();
    list(out, &numbers, |out, &n| number::write(out, n))
}
