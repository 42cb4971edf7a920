//! Coordinate systems, and from one to another.
//!
//! Longitude comes before latitude, easting before northing, as in GeoJSON, whatever the system's own order. Between
//! frames that differ by less than two metres (WGS 84, ETRS89, NAD83 …) coordinates are passed unchanged; some older
//! frames (OSGB36, DHDN, ED50, MGI, Belge 1972) are transformed by seven parameters, to within a few metres
//! ([`Transform::accuracy`]); others are refused. All formulas are computed with the functions of `libm`, so that
//! results are the same on every machine.
//!
//! ```
//! use durer_formats::geo::crs::{Crs, Transform};
//! use durer::math::DVec2;
//!
//! let to_utm = Transform::new(&Crs::parse("EPSG:4326")?, &Crs::parse("EPSG:32632")?);
//! let p = to_utm.apply(DVec2::new(9.0, 48.0)).expect("it is on the earth");
//! assert!((p - DVec2::new(500_000.0, 5_316_300.0)).length() < 100.0);
//! # Ok::<(), String>(())
//! ```

mod codes;
#[cfg(feature = "geoparquet")]
mod conversion;
mod datum;
mod ellipsoid;
mod projection;
mod shift;
mod transverse;
mod wkt;
mod world;

use super::{Geometry, Points, System};
#[cfg(feature = "geoparquet")]
pub(super) use conversion::Parameter;
use datum::Datum;
use durer::math::DVec2;
use projection::Projection;

/// A coordinate system.
#[derive(Debug, Clone, PartialEq)]
pub struct Crs {
    code: Option<i32>,
    datum: &'static Datum,
    kind: Kind,
}

/// Kind of coordinates.
#[derive(Debug, Clone, PartialEq)]
enum Kind {
    /// Longitude and latitude in degrees.
    Geographic,
    /// Lengths in units of this many metres.
    Projected { projection: Projection, unit: f64 },
}

impl Crs {
    /// Creates a system by its number in the EPSG's list, or in Esri's; `None` for one that is not
    /// known.
    pub fn of_code(code: i32) -> Option<Self> {
        codes::crs(code)
    }

    /// Returns the system of a text from a command line: `EPSG:4326`, `4326`, `CRS84`, `robinson`, or a
    /// definition as well-known text.
    ///
    /// # Errors
    /// A sentence that names the known systems.
    pub fn parse(text: &str) -> Result<Self, String> {
        let text = text.trim();
        if text.contains('[') {
            let unknown = || "the definition is not well-known text".to_owned();
            let node = wkt::Node::parse(text).ok_or_else(unknown)?;
            let known = || code_of_node(&node).and_then(Self::of_code);
            return node.crs().or_else(|e| known().ok_or(e));
        }
        let upper = text.to_ascii_uppercase();
        let number = ["EPSG:", "ESRI:", "URN:OGC:DEF:CRS:EPSG::"];
        let number = number.iter().find_map(|prefix| upper.strip_prefix(prefix)).unwrap_or(&upper);
        let code = number.parse().ok().or_else(|| codes::of_name(&upper));
        let unknown = || match code.and_then(datum::refused) {
            Some(datum) => format!(
                "`{text}` is on the datum {datum}, and its shift to WGS 84 is not known here; convert it to EPSG:4326 with a program that has grids, such as ogr2ogr or QGIS"
            ),
            None => format!("`{text}` is not known; {}", codes::KNOWN),
        };
        code.and_then(Self::of_code).ok_or_else(unknown)
    }

    /// Returns the system that a file says it is in.
    ///
    /// # Errors
    /// A message about the part of the system that is not known.
    pub fn of_system(system: &System) -> Result<Self, String> {
        match (system.code.and_then(Self::of_code), system.code, &system.wkt) {
            (Some(crs), ..) => Ok(crs),
            (None, _, Some(wkt)) => Self::parse(wkt),
            (None, Some(code), None) => Self::parse(&format!("EPSG:{code}")),
            (None, None, None) => {
                Err("the file does not say which coordinate system it is in".to_owned())
            }
        }
    }

    /// Returns its number, if it has one.
    pub fn code(&self) -> Option<i32> {
        self.code
    }

    /// Returns the system as a file states it.
    pub fn system(&self) -> System {
        let wkt = self.code.is_none().then(|| wkt::of_crs(self, "unnamed"));
        System { code: self.code, wkt }
    }

    /// Returns whether coordinates are longitude and latitude.
    pub fn is_geographic(&self) -> bool {
        self.kind == Kind::Geographic
    }

    /// Returns the length of a unit of the coordinates in metres; `None` for longitude and latitude.
    pub fn unit(&self) -> Option<f64> {
        match self.kind {
            Kind::Geographic => None,
            Kind::Projected { unit, .. } => Some(unit),
        }
    }

    fn to_radians(&self, p: DVec2) -> Option<(f64, f64)> {
        match &self.kind {
            Kind::Geographic => {
                let inside = p.y.abs() <= 90.0 && p.x.abs() <= 1080.0;
                inside.then(|| (p.x.to_radians(), p.y.to_radians()))
            }
            Kind::Projected { projection, unit } => projection.inverse(p * *unit),
        }
    }

    fn place(&self, (lon, lat): (f64, f64)) -> Option<DVec2> {
        match &self.kind {
            Kind::Geographic => Some(DVec2::new(lon.to_degrees(), lat.to_degrees())),
            Kind::Projected { projection, unit } => Some(projection.forward(lon, lat)? / *unit),
        }
    }
}

/// Transform from one coordinate system to another.
#[derive(Debug, Clone, PartialEq)]
pub struct Transform {
    from: Crs,
    to: Crs,
}

impl Transform {
    /// Creates the transform from one system to another.
    pub fn new(from: &Crs, to: &Crs) -> Self {
        Self { from: from.clone(), to: to.clone() }
    }

    /// Returns whether coordinates stay as they are, to the bit.
    pub fn is_identity(&self) -> bool {
        self.from.kind == self.to.kind && !self.is_shifted()
    }

    /// Returns whether the two frames are hundreds of metres apart.
    fn is_shifted(&self) -> bool {
        let [from, to] = [self.from.datum, self.to.datum];
        !std::ptr::eq(from, to) && from.shift != to.shift
    }

    /// Returns the largest error of coordinates, in metres, if frames are shifted by parameters, and the frame that is
    /// least well known; otherwise `None`.
    pub fn accuracy(&self) -> Option<(&'static str, f64)> {
        let [from, to] = [self.from.datum, self.to.datum];
        let worst = if from.accuracy > to.accuracy { from } else { to };
        self.is_shifted().then_some((worst.name, from.accuracy + to.accuracy))
    }

    /// Transforms a place to the other system; `None` if it has no place there.
    pub fn apply(&self, p: DVec2) -> Option<DVec2> {
        if self.is_identity() {
            return Some(p);
        }
        let mut place = self.from.to_radians(p)?;
        if self.is_shifted() {
            let frame = |crs: &Crs| (crs.datum.body(), crs.datum.shift);
            place = shift::apply(place, frame(&self.from), frame(&self.to));
        }
        self.to.place(place).filter(|p| p.is_finite())
    }

    /// Returns a geometry with all its positions in the other system; heights and measures stay. `None` if a
    /// position has no place there.
    pub fn geometry(&self, geometry: &Geometry) -> Option<Geometry> {
        let all =
            |runs: &[Points]| runs.iter().map(|run| self.points(run)).collect::<Option<Vec<_>>>();
        Some(match geometry {
            Geometry::Point(points) => Geometry::Point(self.points(points)?),
            Geometry::LineString(points) => Geometry::LineString(self.points(points)?),
            Geometry::MultiPoint(points) => Geometry::MultiPoint(self.points(points)?),
            Geometry::Polygon(rings) => Geometry::Polygon(all(rings)?),
            Geometry::MultiLineString(lines) => Geometry::MultiLineString(all(lines)?),
            Geometry::MultiPolygon(polygons) => Geometry::MultiPolygon(
                polygons.iter().map(|rings| all(rings)).collect::<Option<_>>()?,
            ),
            Geometry::Collection(parts) => Geometry::Collection(
                parts.iter().map(|part| self.geometry(part)).collect::<Option<_>>()?,
            ),
        })
    }

    fn points(&self, points: &Points) -> Option<Points> {
        let xy = points.xy.iter().map(|&p| self.apply(p)).collect::<Option<_>>()?;
        Some(Points { xy, ..points.clone() })
    }
}

/// Returns the number of the system that a definition is of, if it is known.
pub fn code_of_wkt(text: &str) -> Option<i32> {
    code_of_node(&wkt::Node::parse(text)?)
}

fn code_of_node(node: &wkt::Node) -> Option<i32> {
    node.code().or_else(|| codes::of_crs(&node.crs().ok()?))
}

/// Returns whether a text is a definition of the first version, as .prj files have them.
pub fn is_wkt1(text: &str) -> bool {
    wkt::Node::parse(text).is_some_and(|node| node.is_first_version())
}

/// Returns the definition of a system for a .prj; `None` for a number that is not known.
pub fn wkt_of_code(code: i32) -> Option<String> {
    let crs = Crs::of_code(code)?;
    Some(wkt::of_crs(&crs, &codes::name(code)))
}
