//! Drawings as GeoJSON for programs: one feature per piece, in plane units.

use crate::Result;
use crate::geo::number;
use durer::math::DVec2;
use durer::target::drawing::{Drawing, Line, Region, RegionKind};
use std::io::Write;

/// Writes a drawing as a `FeatureCollection`, one feature per line, in the order of painting.
///
/// Coordinates are plane units: x to the right, y up, the origin at the camera's target. (Not longitude
/// and latitude; but every reader of the format takes them.)
///
/// | piece | geometry | properties |
/// |---|---|---|
/// | line | `LineString`, closed ones repeat their first point | `class`, `visible`, `invisibility` |
/// | region | `MultiPolygon`, or `Polygon` if it has one outer ring | `class` (`surface`, `shadow`, `cap`), `visible`, `invisibility` 0, `color`, `item` or null |
/// | label | `Point` | `class` `label`, `visible`, `invisibility` 0, `text`, `height` |
///
/// Numbers are the shortest that read back the same.
///
/// # Errors
/// [`crate::Error::Io`] if writing fails.
pub fn write(out: &mut impl Write, drawing: &Drawing) -> Result<()> {
    out.write_all(b"{\"type\":\"FeatureCollection\",\"features\":[")?;
    let mut separator: &[u8] = b"\n";
    let mut next = |out: &mut dyn Write| {
        let written = out.write_all(separator);
        separator = b",\n";
        written
    };
    for region in drawing.regions.iter().filter(|r| !r.rings.is_empty()) {
        next(out)?;
        write_region(out, region)?;
    }
    for line in &drawing.lines {
        next(out)?;
        write_line(out, line)?;
    }
    for label in &drawing.labels {
        next(out)?;
        let text = serde_json::Value::from(label.text.as_str());
        start(out, "label", 0)?;
        write!(out, ",\"text\":{text},\"height\":")?;
        coordinate(out, label.height)?;
        out.write_all(b"},\"geometry\":{\"type\":\"Point\",\"coordinates\":")?;
        position(out, label.at)?;
        out.write_all(b"}}")?;
    }
    out.write_all(b"\n]}\n")?;
    Ok(())
}

fn start(out: &mut impl Write, class: &str, invisibility: u32) -> Result<()> {
    write!(
        out,
        "{{\"type\":\"Feature\",\"properties\":{{\"class\":\"{class}\",\"visible\":{},\
         \"invisibility\":{invisibility}",
        invisibility == 0
    )?;
    Ok(())
}

fn write_line(out: &mut impl Write, line: &Line) -> Result<()> {
    start(out, line.class.name(), line.invisibility)?;
    out.write_all(b"},\"geometry\":{\"type\":\"LineString\",\"coordinates\":")?;
    chain(out, &line.points, line.closed)?;
    out.write_all(b"}}")?;
    Ok(())
}

fn write_region(out: &mut impl Write, region: &Region) -> Result<()> {
    let class = match region.kind {
        RegionKind::Surface => "surface",
        RegionKind::Shadow => "shadow",
        RegionKind::Cap => "cap",
    };
    start(out, class, 0)?;
    let [r, g, b, a] = region.color;
    write!(out, ",\"color\":\"#{r:02x}{g:02x}{b:02x}{a:02x}\",\"item\":")?;
    match region.item {
        Some(item) => write!(out, "{item}")?,
        None => out.write_all(b"null")?,
    }
    let polygons = polygons(&region.rings);
    let kind = if polygons.len() == 1 { "Polygon" } else { "MultiPolygon" };
    write!(out, "}},\"geometry\":{{\"type\":\"{kind}\",\"coordinates\":")?;
    if polygons.len() != 1 {
        out.write_all(b"[")?;
    }
    for (i, polygon) in polygons.iter().enumerate() {
        out.write_all(if i > 0 { b",[" } else { b"[" })?;
        for (k, ring) in polygon.iter().enumerate() {
            if k > 0 {
                out.write_all(b",")?;
            }
            chain(out, ring, true)?;
        }
        out.write_all(b"]")?;
    }
    if polygons.len() != 1 {
        out.write_all(b"]")?;
    }
    out.write_all(b"}}")?;
    Ok(())
}

/// Returns rings of a region as polygons: each outer ring (counter-clockwise) with the holes in it.
fn polygons(rings: &[Vec<DVec2>]) -> Vec<Vec<&[DVec2]>> {
    let (outer, holes): (Vec<_>, Vec<_>) = rings.iter().partition(|r| area(r) >= 0.0);
    let mut polygons: Vec<Vec<&[DVec2]>> = outer.iter().map(|r| vec![r.as_slice()]).collect();
    for hole in holes {
        // The smallest outer ring around the hole; if there is none, the hole becomes a separate polygon.
        let around = (0..outer.len())
            .filter(|&i| inside(outer[i], hole))
            .min_by(|&a, &b| area(outer[a]).total_cmp(&area(outer[b])));
        match around {
            Some(i) => polygons[i].push(hole),
            None => polygons.push(vec![hole]),
        }
    }
    polygons
}

fn area(ring: &[DVec2]) -> f64 {
    let Some(&origin) = ring.first() else { return 0.0 };
    ring.windows(2).map(|w| (w[0] - origin).perp_dot(w[1] - origin)).sum::<f64>() * 0.5
}

/// Returns whether a ring is in another that it does not cross: by its first point that is not a point of the other,
/// because rings may touch.
fn inside(outer: &[DVec2], ring: &[DVec2]) -> bool {
    let Some(p) = ring.iter().find(|p| !outer.contains(p)).or(ring.first()) else { return false };
    let next = outer.iter().cycle().skip(1);
    outer.iter().zip(next).fold(false, |odd, (a, b)| {
        let crosses =
            (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x);
        odd != crosses
    })
}

fn chain(out: &mut impl Write, points: &[DVec2], closed: bool) -> Result<()> {
    out.write_all(b"[")?;
    let again = points.first().filter(|_| closed);
    for (i, p) in points.iter().chain(again).enumerate() {
        if i > 0 {
            out.write_all(b",")?;
        }
        position(out, *p)?;
    }
    out.write_all(b"]")?;
    Ok(())
}

fn position(out: &mut impl Write, p: DVec2) -> Result<()> {
    out.write_all(b"[")?;
    coordinate(out, p.x)?;
    out.write_all(b",")?;
    coordinate(out, p.y)?;
    out.write_all(b"]")?;
    Ok(())
}

/// Writes a coordinate; numbers that are not finite, which JSON does not have, become 0, and so does −0.
fn coordinate(out: &mut impl Write, value: f64) -> Result<()> {
    let value = if value.is_finite() && value != 0.0 { value } else { 0.0 };
    number::write(out, value)?;
    Ok(())
}
