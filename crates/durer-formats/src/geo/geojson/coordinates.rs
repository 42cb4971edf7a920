//! Geometry objects: `coordinates` by their type, with repairs.

use super::object::{Cursor, RawMember, Text, kind};
use crate::geo::{Dimensions, Geometry, MAX_DEPTH, Member, Points, Warnings};
use crate::{Place, Result};
use durer::math::DVec2;

/// Reader of geometries, which records repairs.
#[derive(Debug, Default)]
pub struct Geometries {
    pub warnings: Warnings,
    /// Members of the geometry read last that the format does not define.
    pub further: Vec<Member>,
}

/// Shape that the positions of one run must form.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Run {
    Points,
    Line,
    Ring,
}

impl Geometries {
    /// Returns a geometry by its type; `None` if there is no such type.
    pub fn geometry(
        &mut self,
        kind: &str,
        whole: Text<'_>,
        members: &[RawMember<'_>],
    ) -> Result<Option<Geometry>> {
        self.nested(kind, whole, members, 0)
    }

    fn nested(
        &mut self,
        kind: &str,
        whole: Text<'_>,
        members: &[RawMember<'_>],
        depth: usize,
    ) -> Result<Option<Geometry>> {
        let member = |name: &str| {
            let found = members.iter().rfind(|(n, _)| n.as_bytes() == name.as_bytes());
            found
                .map(|(_, value)| value.cursor())
                .ok_or_else(|| whole.error(format!("a {kind} needs the member {name}")))
        };
        let coordinates = || member("\"coordinates\"");
        let geometry = match kind {
            "Point" => Geometry::Point(self.point(coordinates()?)?),
            "MultiPoint" => Geometry::MultiPoint(self.run(&mut coordinates()?, Run::Points)?),
            "LineString" => Geometry::LineString(self.run(&mut coordinates()?, Run::Line)?),
            "MultiLineString" => {
                Geometry::MultiLineString(self.runs(&mut coordinates()?, Run::Line)?)
            }
            "Polygon" => Geometry::Polygon(self.runs(&mut coordinates()?, Run::Ring)?),
            "MultiPolygon" => {
                let mut polygons = Vec::new();
                coordinates()?.array("an array of polygons", |cursor| {
                    polygons.push(self.runs(cursor, Run::Ring)?);
                    Ok(())
                })?;
                polygons.retain(|polygon| !polygon.is_empty());
                Geometry::MultiPolygon(polygons)
            }
            "GeometryCollection" => {
                let mut parts = Vec::new();
                member("\"geometries\"")?.array("an array of geometries", |cursor| {
                    let part = cursor.value("a geometry")?;
                    parts.push(self.object(part, depth + 1)?);
                    Ok(())
                })?;
                Geometry::Collection(parts)
            }
            _ => return Ok(None),
        };
        Ok(Some(geometry))
    }

    /// Returns a geometry object.
    pub fn object(&mut self, text: Text<'_>, depth: usize) -> Result<Geometry> {
        if depth > MAX_DEPTH {
            return Err(text.error("geometries are nested too deep"));
        }
        let members = text.members()?;
        let kind = kind(&members)
            .ok_or_else(|| text.error("a geometry needs the member \"type\", a string"))?;
        let unknown = || {
            text.error(format!(
                "`{}` is not a type of geometry",
                crate::text::quote(kind.as_bytes())
            ))
        };
        if depth == 0 {
            self.further = further_members(&members)?;
        } else if members.iter().any(|(name, _)| !is_of_geometry(name)) {
            self.warnings.members.add(|| text.place());
        }
        self.nested(&kind, text, &members, depth)?.ok_or_else(unknown)
    }

    fn point(&mut self, mut cursor: Cursor<'_>) -> Result<Points> {
        let mut points = Points::default();
        if cursor.clone().begins_empty() {
            return Ok(points);
        }
        self.position(&mut cursor, &mut points)?;
        Ok(points)
    }

    fn runs(&mut self, cursor: &mut Cursor<'_>, kind: Run) -> Result<Vec<Points>> {
        let mut runs = Vec::new();
        let mut outer_lost = false;
        let what = if kind == Run::Ring { "an array of rings" } else { "an array of lines" };
        let mut first = true;
        cursor.array(what, |cursor| {
            let start = cursor.clone();
            let run = self.run(cursor, kind)?;
            let lost = run.is_empty();
            outer_lost |= first && lost && kind == Run::Ring;
            first = false;
            if outer_lost && !lost {
                self.warnings.push(
                    start.clone().place(),
                    "the hole of a ring that was left out; left out too",
                );
            } else if !lost {
                runs.push(run);
            }
            Ok(())
        })?;
        Ok(runs)
    }

    /// Returns an array of positions; empty if it had to be left out.
    pub fn run(&mut self, cursor: &mut Cursor<'_>, kind: Run) -> Result<Points> {
        // Computing a place reads all of the text before it, so places are computed only when needed.
        let start = cursor.clone();
        let place = || start.clone().place();
        let mut points = Points::default();
        let what = if kind == Run::Ring {
            "a ring, an array of positions"
        } else {
            "an array of positions"
        };
        cursor.array(what, |cursor| self.position(cursor, &mut points))?;
        match kind {
            Run::Points => {}
            Run::Line => finish_line(&mut points, place, &mut self.warnings),
            Run::Ring => finish_ring(&mut points, place, &mut self.warnings),
        }
        Ok(points)
    }

    fn position(&mut self, cursor: &mut Cursor<'_>, points: &mut Points) -> Result<()> {
        let start = cursor.clone();
        let mut numbers = [0.0; 4];
        let mut count = 0;
        cursor.array("a position, an array of numbers", |cursor| {
            let number = cursor.number()?;
            if let Some(place) = numbers.get_mut(count) {
                *place = number;
            }
            count += 1;
            Ok(())
        })?;
        let place = || start.clone().place();
        if count < 2 {
            return Err(start.clone().error("a position needs at least two numbers"));
        }
        if count > 4 {
            self.warnings
                .push(place(), "a position of more than four numbers; the rest is left out");
        }
        if points.is_empty() {
            points.dimensions = Dimensions::new(count > 2, count > 3);
        } else if count.min(4) != points.dimensions.count() {
            points.lift(Dimensions::new(count > 2, count > 3));
            let message = "a position with more or fewer numbers than the one before; missing numbers are taken as 0";
            self.warnings.push(place(), message);
        }
        points.push(DVec2::new(numbers[0], numbers[1]), [numbers[2], numbers[3]]);
        Ok(())
    }
}

/// Returns the members of a geometry that the format does not define. Like the members of features, they are kept
/// without `bbox`.
pub fn further_members(members: &[RawMember<'_>]) -> Result<Vec<Member>> {
    let further = members.iter().filter(|(name, _)| !is_of_geometry(name));
    further
        .map(|(name, value)| Ok(Member { name: name.checked()?, value: value.checked()? }))
        .collect()
}

/// Returns whether the format defines a member of geometries.
fn is_of_geometry(name: &Text<'_>) -> bool {
    matches!(name.as_bytes(), b"\"type\"" | b"\"coordinates\"" | b"\"geometries\"" | b"\"bbox\"")
}

/// Leaves out a line of a single position.
pub fn finish_line(points: &mut Points, place: impl Fn() -> Place, warnings: &mut Warnings) {
    if points.len() == 1 {
        warnings.push(place(), "a line needs two positions; this one is left out");
        *points = Points::default();
    }
}

/// Opens a ring as [`Geometry`] has it; closes rings that are not closed and leaves out rings that are too short.
pub fn finish_ring(points: &mut Points, place: impl Fn() -> Place, warnings: &mut Warnings) {
    if points.is_empty() {
        return;
    }
    if points.len() > 1 && points.xy.first() == points.xy.last() {
        points.pop();
    } else {
        warnings.push(place(), "the ring is not closed; closed");
    }
    if points.len() < 3 {
        let message = "a ring needs four positions, the last like the first; this one is left out";
        warnings.push(place(), message);
        *points = Points::default();
    }
}

impl Cursor<'_> {
    fn begins_empty(mut self) -> bool {
        self.take(b'[') && self.take(b']')
    }
}
