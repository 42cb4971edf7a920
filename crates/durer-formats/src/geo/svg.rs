//! Features as SVG that any viewer shows as a map.

use super::{Feature, Geometry, Points, number};
use durer::clip::polygon::WindingRule;
use durer::math::{DVec2, Rect};
use std::io::{self, Write};

/// Look of geometries, except for the width of lines.
const STYLE: &str = "path{stroke:#224;stroke-linejoin:round;stroke-linecap:round}\
.area{fill:#9bc}.line{fill:none}.points{fill:none}";

/// The width of lines and of points, in pixels.
const WIDTHS: [(&str, f64); 2] = [("path", 1.0), (".points", 4.0)];

/// The longer side of the picture, in pixels.
const SIDE: f64 = 1000.0;

/// Writes features as paths in their own coordinates, turned over so that y is up.
pub fn write(out: &mut impl Write, features: &[Feature]) -> io::Result<()> {
    let Some(frame) = frame(features) else { return Ok(()) };
    let size = frame.size();
    let scale = SIDE / size.max_element();
    let corner = DVec2::new(frame.min().x, -frame.max().y);
    out.write_all(b"<svg xmlns=\"http://www.w3.org/2000/svg\"")?;
    for (name, value) in [("width", size.x * scale), ("height", size.y * scale)] {
        write!(out, " {name}=\"{}\"", value.ceil())?;
    }
    out.write_all(b" viewBox=\"")?;
    for (i, value) in [corner.x, corner.y, size.x, size.y].into_iter().enumerate() {
        out.write_all(if i > 0 { b" " } else { b"" })?;
        number::write(out, value)?;
    }
    write!(out, "\">\n<style>{STYLE}")?;
    // In units of the coordinates: not every viewer knows strokes that do not scale.
    for (what, width) in WIDTHS {
        write!(out, "{what}{{stroke-width:")?;
        number::write(out, width / scale)?;
        write!(out, "}}")?;
    }
    writeln!(out, "</style>\n<g fill-rule=\"evenodd\" transform=\"scale(1 -1)\">")?;
    for feature in features {
        if let Some(geometry) = &feature.geometry {
            write_feature(out, feature, geometry)?;
        }
    }
    out.write_all(b"</g>\n</svg>\n")
}

/// Returns the picture's frame: all features and a small margin.
fn frame(features: &[Feature]) -> Option<Rect> {
    let boxes = features.iter().filter_map(|f| f.geometry.as_ref()?.bounds());
    let all = Rect::around(boxes.flat_map(|b| [b.min(), b.max()]));
    let all = all.or(Rect::around([DVec2::ZERO, DVec2::ONE]))?;
    let side = all.size().max_element();
    let margin = DVec2::splat(if side > 0.0 { side * 0.01 } else { 0.5 });
    Rect::new(all.min() - margin, all.max() + margin).ok()
}

fn write_feature(out: &mut impl Write, feature: &Feature, geometry: &Geometry) -> io::Result<()> {
    let id: Option<serde_json::Value> =
        feature.id.as_deref().and_then(|id| serde_json::from_str(id).ok());
    let id = id.map(|id| id.as_str().map_or_else(|| id.to_string(), str::to_owned));
    out.write_all(b"<g")?;
    if let Some(id) = id {
        write!(out, " id=\"{}\"", quick_xml::escape::escape(&id))?;
    }
    if feature.fill_rule == WindingRule::NonZero {
        out.write_all(b" fill-rule=\"nonzero\"")?;
    }
    out.write_all(b">")?;
    write_geometry(out, geometry)?;
    out.write_all(b"</g>\n")
}

fn write_geometry(out: &mut impl Write, geometry: &Geometry) -> io::Result<()> {
    if geometry.is_empty() {
        return Ok(());
    }
    match geometry {
        Geometry::Point(points) | Geometry::MultiPoint(points) => {
            out.write_all(b"<path class=\"points\" d=\"")?;
            for p in &points.xy {
                place(out, "M", *p)?;
                out.write_all(b"h0")?;
            }
        }
        Geometry::LineString(line) => {
            out.write_all(b"<path class=\"line\" d=\"")?;
            run(out, line, "")?;
        }
        Geometry::MultiLineString(lines) => {
            out.write_all(b"<path class=\"line\" d=\"")?;
            lines.iter().try_for_each(|line| run(out, line, ""))?;
        }
        Geometry::Polygon(rings) => {
            out.write_all(b"<path class=\"area\" d=\"")?;
            rings.iter().try_for_each(|ring| run(out, ring, "Z"))?;
        }
        Geometry::MultiPolygon(polygons) => {
            out.write_all(b"<path class=\"area\" d=\"")?;
            polygons.iter().flatten().try_for_each(|ring| run(out, ring, "Z"))?;
        }
        Geometry::Collection(parts) => {
            return parts.iter().try_for_each(|part| write_geometry(out, part));
        }
    }
    out.write_all(b"\"/>")
}

fn run(out: &mut impl Write, points: &Points, end: &str) -> io::Result<()> {
    for (i, p) in points.xy.iter().enumerate() {
        place(out, if i == 0 { "M" } else { "L" }, *p)?;
    }
    out.write_all(end.as_bytes())
}

fn place(out: &mut impl Write, command: &str, p: DVec2) -> io::Result<()> {
    out.write_all(command.as_bytes())?;
    number::write(out, p.x)?;
    out.write_all(b" ")?;
    number::write(out, p.y)
}
