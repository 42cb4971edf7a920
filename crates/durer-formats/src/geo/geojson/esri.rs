//! JSON of ArcGIS (Esri): feature sets, features and geometries of its REST services, by *ArcGIS REST API, Geometry
//! objects*.
//!
//! Rings that run clockwise are outer ones, the others their holes. Curves are not read.

use super::coordinates::{Geometries, Run};
use super::object::{Cursor, RawMember, Text};
use crate::geo::rings;
use crate::geo::system::System;
use crate::geo::{Dimensions, Feature, Geometry, Points, Warnings};
use crate::{Error, Place, Result};
use durer::math::DVec2;

/// Members by which a geometry is recognized.
const SHAPES: [&[u8]; 7] = [
    b"\"rings\"",
    b"\"paths\"",
    b"\"points\"",
    b"\"x\"",
    b"\"curveRings\"",
    b"\"curvePaths\"",
    b"\"xmin\"",
];

/// Members by which a feature set is recognized.
const SETS: [&[u8]; 4] =
    [b"\"geometryType\"", b"\"spatialReference\"", b"\"fieldAliases\"", b"\"displayFieldName\""];

/// Name of the member for the coordinate system.
pub const SYSTEM: &[u8] = b"\"spatialReference\"";

/// Statements of a feature set about all its geometries.
#[derive(Debug, Clone, Copy, Default)]
pub struct Given {
    has_z: Option<bool>,
    has_m: Option<bool>,
}

impl Given {
    /// Returns what the members of a feature set or of a geometry state, or else what is given already.
    pub fn of(self, members: &[RawMember<'_>]) -> Self {
        let stated = |name: &[u8]| match find(members, name)?.as_bytes() {
            b"true" => Some(true),
            b"false" => Some(false),
            _ => None,
        };
        Self {
            has_z: stated(b"\"hasZ\"").or(self.has_z),
            has_m: stated(b"\"hasM\"").or(self.has_m),
        }
    }

    /// Returns the dimensions of positions of this many numbers.
    fn dimensions(self, count: usize) -> Dimensions {
        let is_measure = count == 3 && self.has_m == Some(true) && self.has_z != Some(true);
        Dimensions::new(count > 2 && !is_measure, count > 3 || is_measure)
    }
}

fn find<'a>(members: &[RawMember<'a>], name: &[u8]) -> Option<Text<'a>> {
    members.iter().rfind(|(known, _)| known.as_bytes() == name).map(|(_, value)| *value)
}

/// Returns whether an object without a type is a feature or a geometry.
pub fn is_one(members: &[RawMember<'_>]) -> bool {
    is_geometry(members) || find(members, b"\"attributes\"").is_some()
}

fn is_geometry(members: &[RawMember<'_>]) -> bool {
    SHAPES.iter().any(|name| find(members, name).is_some())
}

/// Returns whether a text that is JSON begins as one of ArcGIS, by names that GeoJSON does not have.
pub fn begins(text: &[u8]) -> bool {
    let has = |name: &[u8]| text.windows(name.len()).any(|part| part == name);
    let own = [&b"\"attributes\""[..], b"\"rings\"", b"\"paths\"", b"\"geometryType\"", SYSTEM];
    own.into_iter().any(has) && !has(b"\"coordinates\"")
}

/// Returns whether the name of a member is one of a feature set.
pub fn is_of_set(name: &[u8]) -> bool {
    SETS.contains(&name)
}

/// Returns the system that a feature or a geometry states.
pub fn own_system(members: &[RawMember<'_>]) -> Option<System> {
    let of_geometry = || {
        let inner = find(members, b"\"geometry\"")?.members().ok()?;
        find(&inner, SYSTEM)
    };
    find(members, SYSTEM).or_else(of_geometry).map(|text| system(text.as_bytes()))
}

/// Returns the system of a `spatialReference`: of its number in the newest list, or of its definition.
pub fn system(json: &[u8]) -> System {
    let value: serde_json::Value = serde_json::from_slice(json).unwrap_or_default();
    let code = |name: &str| value[name].as_i64().and_then(|code| i32::try_from(code).ok());
    match (code("latestWkid").or_else(|| code("wkid")), value["wkt"].as_str()) {
        (Some(code), _) => System::of_code(code),
        (None, Some(wkt)) => System::of_wkt(wkt),
        (None, None) => System::default(),
    }
}

/// Returns the message of a server in place of features.
pub fn error_of_server(members: &[RawMember<'_>]) -> Option<String> {
    let error: serde_json::Value =
        serde_json::from_slice(find(members, b"\"error\"")?.as_bytes()).ok()?;
    let message = error["message"].as_str()?;
    let shown = crate::text::quote(message.as_bytes());
    Some(format!("this is not a map but an error from a server: {shown}"))
}

/// Warns of features that the server did not send.
pub fn warn_of_limit(value: &[u8], place: Place, warnings: &mut Warnings) {
    if value == b"true" {
        let message = "the server has more features than it sent (exceededTransferLimit); query the rest with resultOffset";
        warnings.push(place, message);
    }
}

/// Reads a feature, or a geometry alone.
pub fn feature(
    geometries: &mut Geometries,
    members: &[RawMember<'_>],
    given: Given,
) -> Result<Feature> {
    if is_geometry(members) {
        return Ok(Feature {
            geometry: geometry(geometries, members, given)?,
            ..Feature::default()
        });
    }
    let mut feature = Feature::default();
    for (name, value) in members {
        match name.as_bytes() {
            b"\"attributes\"" if value.as_bytes().first() == Some(&b'{') => {
                let (properties, lost) = value.checked_without_nan()?;
                (0..lost).for_each(|_| geometries.warnings.nan.add(|| value.place()));
                feature.properties = Some(properties);
            }
            b"\"attributes\"" if !value.is_null() => {
                return Err(value.error("attributes must be an object or null"));
            }
            b"\"geometry\"" if !value.is_null() => {
                feature.geometry = geometry(geometries, &value.members()?, given)?;
            }
            _ => {}
        }
    }
    Ok(feature)
}

fn geometry(
    geometries: &mut Geometries,
    members: &[RawMember<'_>],
    given: Given,
) -> Result<Option<Geometry>> {
    let given = given.of(members);
    let mut runs = |text: Text<'_>, kind: Run| {
        let mut runs = Vec::new();
        text.cursor().array("an array of arrays of positions", |cursor| {
            let run = geometries.run(cursor, kind)?;
            if !run.is_empty() {
                runs.push(measured(run, given));
            }
            Ok(())
        })?;
        Ok::<_, Error>(runs)
    };
    if let Some(rings) = find(members, b"\"rings\"") {
        let all = runs(rings, Run::Ring)?;
        let mut polygons = rings::directed(all, &rings.place(), &mut geometries.warnings);
        return Ok(Some(match polygons.len() {
            1 => Geometry::Polygon(polygons.pop().unwrap_or_default()),
            _ => Geometry::MultiPolygon(polygons),
        }));
    }
    if let Some(paths) = find(members, b"\"paths\"") {
        let mut lines = runs(paths, Run::Line)?;
        return Ok(Some(match lines.len() {
            1 => Geometry::LineString(lines.pop().unwrap_or_default()),
            _ => Geometry::MultiLineString(lines),
        }));
    }
    if let Some(points) = find(members, b"\"points\"") {
        let points = geometries.run(&mut points.cursor(), Run::Points)?;
        return Ok(Some(Geometry::MultiPoint(measured(points, given))));
    }
    if let Some(curve) = SHAPES[4..6].iter().find_map(|name| find(members, name)) {
        let hint = "query the service with returnTrueCurves=false".to_owned();
        return Err(Error::Unsupported { place: curve.place(), what: "a curve".to_owned(), hint });
    }
    if find(members, b"\"xmin\"").is_some() {
        return envelope(members);
    }
    point(members)
}

/// Returns positions whose third number is a measure, if that is stated.
fn measured(mut points: Points, given: Given) -> Points {
    let dimensions = given.dimensions(points.dimensions.count());
    if dimensions == points.dimensions {
        return points;
    }
    let mut all = Points::new(dimensions);
    let moved = std::mem::take(&mut points.xy);
    for (i, p) in moved.into_iter().enumerate() {
        let [third, _] = points.zm(i);
        all.push(p, [0.0, third]);
    }
    all
}

/// Returns a number by the name of its member; `None` for null and for `"NaN"`, the number of points without a place.
fn number(members: &[RawMember<'_>], name: &[u8]) -> Result<Option<f64>> {
    match find(members, name) {
        Some(text) if !text.is_null() && text.as_bytes() != b"\"NaN\"" => {
            let number = crate::number::float(text.as_bytes());
            let number = number
                .filter(|(value, length)| value.is_finite() && *length == text.as_bytes().len());
            let wrong = || {
                let mut cursor: Cursor<'_> = text.cursor();
                let found = cursor.found();
                cursor.error(format!("a finite number is expected, not {found}"))
            };
            number.map(|(value, _)| Some(value)).ok_or_else(wrong)
        }
        _ => Ok(None),
    }
}

fn point(members: &[RawMember<'_>]) -> Result<Option<Geometry>> {
    let [x, y, z, m] = [b"\"x\"", b"\"y\"", b"\"z\"", b"\"m\""].map(|name| number(members, name));
    let (Some(x), Some(y), z, m) = (x?, y?, z?, m?) else {
        return Ok(Some(Geometry::Point(Points::default())));
    };
    let mut point = Points::new(Dimensions::new(z.is_some(), m.is_some()));
    point.push(DVec2::new(x, y), [z.unwrap_or(0.0), m.unwrap_or(0.0)]);
    Ok(Some(Geometry::Point(point)))
}

/// Returns the rectangle of an extent.
fn envelope(members: &[RawMember<'_>]) -> Result<Option<Geometry>> {
    let [left, low, right, high] =
        [&b"\"xmin\""[..], b"\"ymin\"", b"\"xmax\"", b"\"ymax\""].map(|name| number(members, name));
    let (Some(left), Some(low), Some(right), Some(high)) = (left?, low?, right?, high?) else {
        return Ok(None);
    };
    let corners = [(left, low), (right, low), (right, high), (left, high)];
    let ring = Points::flat(corners.map(|(x, y)| DVec2::new(x, y)).to_vec());
    Ok(Some(Geometry::Polygon(vec![ring])))
}
