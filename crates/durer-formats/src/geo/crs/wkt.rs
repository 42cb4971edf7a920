//! Definitions of coordinate systems as well-known text: read in the first version and its dialect of .prj files,
//! which is written too.

use super::datum::Datum;
use super::ellipsoid::Ellipsoid;
use super::projection::{Method, Projection, mercator_scale, scale_of_parallel};
use super::{Crs, Kind};
use durer::math::DVec2;

/// Brackets may be nested so deep.
const MAX_DEPTH: usize = 32;

/// `KEYWORD["text", 1, OTHER[…]]`.
#[derive(Debug, Default, PartialEq)]
pub struct Node {
    keyword: String,
    values: Vec<String>,
    nodes: Vec<Node>,
}

impl Node {
    /// Reads a definition; `None` if it is invalid.
    pub fn parse(text: &str) -> Option<Self> {
        let mut rest = text.trim();
        let node = Self::read(&mut rest, 0)?;
        (!node.nodes.is_empty()).then_some(node)
    }

    fn read(rest: &mut &str, depth: usize) -> Option<Self> {
        let end = rest.find(|c: char| !c.is_ascii_alphanumeric() && c != '_')?;
        let mut node = Self { keyword: rest[..end].to_ascii_uppercase(), ..Self::default() };
        *rest = rest[end..].trim_start();
        if depth > MAX_DEPTH || node.keyword.is_empty() {
            return None;
        }
        *rest = rest.strip_prefix(['[', '('])?;
        loop {
            *rest = rest.trim_start();
            node.item(rest, depth)?;
            *rest = rest.trim_start();
            if let Some(after) = rest.strip_prefix([']', ')']) {
                *rest = after;
                return Some(node);
            }
            *rest = rest.strip_prefix(',')?;
        }
    }

    /// Returns the next text, number, word or node.
    fn item(&mut self, rest: &mut &str, depth: usize) -> Option<()> {
        if let Some(text) = rest.strip_prefix('"') {
            let end = text.find('"')?;
            self.values.push(text[..end].to_owned());
            *rest = &text[end + 1..];
            return Some(());
        }
        let end = rest.find([',', '[', '(', ']', ')'])?;
        if rest[end..].starts_with(['[', '(']) {
            self.nodes.push(Self::read(rest, depth + 1)?);
        } else {
            self.values.push(rest[..end].trim().to_owned());
            *rest = &rest[end..];
        }
        Some(())
    }

    fn node(&self, keyword: &str) -> Option<&Self> {
        self.nodes.iter().find(|node| node.keyword == keyword)
    }

    fn value(&self, index: usize) -> &str {
        self.values.get(index).map_or("", String::as_str)
    }

    fn number(&self, index: usize) -> Option<f64> {
        self.value(index).parse().ok().filter(|n: &f64| n.is_finite())
    }

    /// Returns the number that the definition says it has in the EPSG's list, or in Esri's.
    pub fn code(&self) -> Option<i32> {
        let own = self.nodes.iter().find(|n| matches!(&n.keyword[..], "AUTHORITY" | "ID"))?;
        let known = matches!(&own.value(0).to_ascii_uppercase()[..], "EPSG" | "ESRI");
        own.value(1).parse().ok().filter(|_| known)
    }

    /// Returns whether it is of the first version.
    pub fn is_first_version(&self) -> bool {
        matches!(&self.keyword[..], "PROJCS" | "GEOGCS")
    }

    /// Returns the coordinate system that it defines.
    ///
    /// # Errors
    /// A message about the part that is not known.
    pub fn crs(&self) -> Result<Crs, String> {
        let geographic = match &self.keyword[..] {
            "GEOGCS" => self,
            "PROJCS" => self.node("GEOGCS").ok_or("it has no GEOGCS")?,
            other => return Err(format!("definitions by {other} are not read")),
        };
        let named = geographic.node("DATUM").ok_or("it has no DATUM")?;
        let datum = Datum::of_name(named.value(0)).or_else(|| Datum::of_name(geographic.value(0)));
        let shifted =
            named.node("TOWGS84").is_some_and(|n| n.values.iter().any(|v| v.parse() != Ok(0.0)));
        // durer's own parameters of a frame take precedence over the definition's.
        let datum = datum.filter(|datum| !shifted || datum.accuracy > 0.0);
        let datum = datum.ok_or_else(|| {
            let name = named.value(0);
            format!(
                "the position of its datum {name} is not known; convert it to EPSG:4326 with a program that has grids, such as \
                 ogr2ogr or QGIS"
            )
        })?;
        let meridian = geographic.node("PRIMEM").and_then(|n| n.number(1)).unwrap_or(0.0);
        let degrees = geographic.node("UNIT").and_then(|n| n.number(1)).unwrap_or(DEGREE);
        if meridian != 0.0 || (degrees - DEGREE).abs() > 1e-9 {
            return Err("longitudes that are not in degrees from Greenwich are not read".to_owned());
        }
        let kind = match self.node("PROJECTION") {
            None => Kind::Geographic,
            Some(method) => {
                let unit = self.node("UNIT").and_then(|n| n.number(1)).filter(|n| *n > 0.0);
                let unit = unit.unwrap_or(1.0);
                Kind::Projected { projection: self.projection(method.value(0), datum, unit)?, unit }
            }
        };
        Ok(Crs { code: None, datum, kind })
    }

    fn projection(
        &self,
        method: &str,
        datum: &'static Datum,
        unit: f64,
    ) -> Result<Projection, String> {
        let parameter = |names: &[&str]| {
            let is_one = |n: &&Node| names.iter().any(|name| n.value(0).eq_ignore_ascii_case(name));
            self.nodes.iter().filter(|n| n.keyword == "PARAMETER").find(is_one)?.number(1)
        };
        let angle = |names: &[&str]| parameter(names).unwrap_or(0.0).to_radians();
        let lat = angle(&["latitude_of_origin", "latitude_of_center"]);
        let scale = parameter(&["scale_factor"]).unwrap_or(1.0);
        let first = parameter(&["standard_parallel_1"]).map(f64::to_radians);
        let second = parameter(&["standard_parallel_2"]).map(f64::to_radians);
        let mut body = datum.body();
        let lower = method.to_ascii_lowercase();
        let method = match &lower[..] {
            "transverse_mercator" | "gauss_kruger" => Method::Transverse { lat, scale },
            "mercator_auxiliary_sphere" => {
                body = body.sphere();
                Method::Mercator { scale: 1.0 }
            }
            // The form in which the system of web maps is written if it has no name.
            "mercator_1sp"
                if self.node("EXTENSION").is_some_and(|n| n.value(1).contains("+b=6378137")) =>
            {
                body = body.sphere();
                Method::Mercator { scale: 1.0 }
            }
            "popular_visualisation_pseudo_mercator" => {
                body = body.sphere();
                Method::Mercator { scale: 1.0 }
            }
            "mercator" | "mercator_1sp" | "mercator_2sp" => {
                let scale = first.map_or(scale, |lat| mercator_scale(body, lat));
                Method::Mercator { scale }
            }
            "lambert_conformal_conic"
            | "lambert_conformal_conic_1sp"
            | "lambert_conformal_conic_2sp" => {
                let first = first.unwrap_or(lat);
                Method::Conformal { lat, parallels: [first, second.unwrap_or(first)], scale }
            }
            "albers" | "albers_conic_equal_area" => {
                let first = first.unwrap_or(lat);
                Method::Albers { lat, parallels: [first, second.unwrap_or(first)] }
            }
            "lambert_azimuthal_equal_area" => Method::Azimuthal { lat },
            "stereographic_north_pole" | "stereographic_south_pole" | "polar_stereographic" => {
                let south = lower.contains("south") || first.unwrap_or(lat) < 0.0;
                let parallel = first.unwrap_or(lat);
                let scale = scale * scale_of_parallel(body, parallel);
                Method::Stereographic { pole: if south { -1.0 } else { 1.0 }, scale }
            }
            "robinson" => Method::Robinson,
            "equal_earth" => Method::EqualEarth,
            _ => return Err(format!("the projection {method} is not known")),
        };
        let meridian = angle(&["central_meridian", "longitude_of_center", "longitude_of_origin"]);
        let shift = |name| parameter(&[name]).unwrap_or(0.0) * unit;
        let offset = DVec2::new(shift("false_easting"), shift("false_northing"));
        Ok(Projection { method, body, meridian, offset })
    }
}

/// A degree in radians.
const DEGREE: f64 = 0.017_453_292_519_943_295;

/// Returns the definition of a system, as .prj files have it.
pub fn of_crs(crs: &Crs, name: &str) -> String {
    let datum = crs.datum;
    let (spheroid, own) = (&datum.spheroid, datum.name);
    let (body, a, flattening) = (spheroid.name, spheroid.a, spheroid.inverse);
    let geographic = format!(
        "GEOGCS[\"GCS_{own}\",DATUM[\"D_{own}\",SPHEROID[\"{body}\",{a:?},{flattening:?}]],\
         PRIMEM[\"Greenwich\",0.0],UNIT[\"Degree\",0.0174532925199433]]"
    );
    let Kind::Projected { projection, unit } = &crs.kind else { return geographic };
    let (method, parameters) = parameters(projection);
    let offset = projection.offset / *unit;
    let shifts = [("False_Easting", offset.x), ("False_Northing", offset.y)];
    let all = shifts.into_iter().chain(parameters);
    let all: String = all.map(|(key, value)| format!("PARAMETER[\"{key}\",{value:?}],")).collect();
    format!(
        "PROJCS[\"{name}\",{geographic},PROJECTION[\"{method}\"],{all}UNIT[\"Meter\",{unit:?}]]"
    )
}

/// Returns the name and the parameters of a projection, without its offset.
fn parameters(projection: &Projection) -> (&'static str, Vec<(&'static str, f64)>) {
    // Degrees as they were given: errors from radians are beyond the digits that are written.
    let degrees = |angle: f64| (angle.to_degrees() * 1e10).round() / 1e10;
    let middle = ("Central_Meridian", degrees(projection.meridian));
    let origin = |lat| ("Latitude_Of_Origin", degrees(lat));
    let parallels = |[first, second]: [f64; 2]| {
        [("Standard_Parallel_1", degrees(first)), ("Standard_Parallel_2", degrees(second))]
    };
    let with = |further: &[(&'static str, f64)]| [&[middle][..], further].concat();
    match projection.method {
        Method::Transverse { lat, scale } => {
            ("Transverse_Mercator", with(&[("Scale_Factor", scale), origin(lat)]))
        }
        Method::Mercator { .. } if projection.body.e2 == 0.0 => (
            "Mercator_Auxiliary_Sphere",
            with(&[("Standard_Parallel_1", 0.0), ("Auxiliary_Sphere_Type", 0.0)]),
        ),
        Method::Mercator { .. } => ("Mercator", with(&[("Standard_Parallel_1", 0.0)])),
        Method::Conformal { lat, parallels: two, .. } => {
            let [first, second] = parallels(two);
            ("Lambert_Conformal_Conic", with(&[first, second, origin(lat)]))
        }
        Method::Albers { lat, parallels: two } => {
            let [first, second] = parallels(two);
            ("Albers", with(&[first, second, origin(lat)]))
        }
        Method::Azimuthal { lat } => ("Lambert_Azimuthal_Equal_Area", with(&[origin(lat)])),
        Method::Stereographic { pole, scale } => {
            let name =
                if pole > 0.0 { "Stereographic_North_Pole" } else { "Stereographic_South_Pole" };
            (
                name,
                with(&[(
                    "Standard_Parallel_1",
                    pole * degrees(parallel_of(projection.body, scale)),
                )]),
            )
        }
        Method::Robinson => ("Robinson", with(&[])),
        Method::EqualEarth => ("Equal_Earth", with(&[])),
    }
}

/// Returns the true parallel of a polar projection with the given scale at the pole, by bisection.
pub fn parallel_of(body: Ellipsoid, scale: f64) -> f64 {
    let (mut low, mut high) = (0.0, std::f64::consts::FRAC_PI_2);
    for _ in 0..60 {
        let middle = (low + high) / 2.0;
        if scale_of_parallel(body, middle) < scale { low = middle } else { high = middle }
    }
    low
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_definition_is_none() {
        for text in ["", "GEOGCS", "GEOGCS[", "A[\"x", "[]", "A[1,2]", &"A[".repeat(100), "A[B[]"] {
            assert_eq!(Node::parse(text), None, "{text}");
        }
        let deep = Node::parse("PROJCS[\"a\", GEOGCS ( \"b\" , 1.5 ),AUTHORITY[\"EPSG\",\"7\"]]");
        let deep = deep.expect("a definition");
        assert_eq!((deep.code(), deep.nodes[0].number(1)), (Some(7), Some(1.5)));
    }
}
