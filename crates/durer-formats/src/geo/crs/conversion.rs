//! Projections in the terms of the EPSG's list.

use super::datum::Spheroid;
use super::projection::Method;
use super::wkt::parallel_of;
use super::{Crs, Kind, codes};

/// A parameter of a projection.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameter {
    /// Its name in the EPSG's list.
    pub name: &'static str,
    /// Its value.
    pub value: f64,
    /// `degree`, `unity`, or `length` for the unit of coordinates.
    pub unit: &'static str,
}

impl Crs {
    /// Returns its ellipsoid.
    pub(in super::super) fn ellipsoid(&self) -> &'static Spheroid {
        &self.datum.spheroid
    }

    /// Returns the names of its frame and of itself.
    pub(in super::super) fn names(&self) -> (&'static str, String) {
        (self.datum.name, self.code.map_or_else(|| "unnamed".to_owned(), codes::name))
    }

    /// Returns the name of the projection's method, its parameters, and the unit of coordinates in metres;
    /// `None` if coordinates are longitude and latitude.
    pub(in super::super) fn conversion(&self) -> Option<(&'static str, Vec<Parameter>, f64)> {
        let Kind::Projected { projection, unit } = &self.kind else { return None };
        let degrees = |angle: f64| (angle.to_degrees() * 1e10).round() / 1e10;
        let angle = |name, angle: f64| Parameter { name, value: degrees(angle), unit: "degree" };
        let factor =
            |value| Parameter { name: "Scale factor at natural origin", value, unit: "unity" };
        let natural = |lat| angle("Latitude of natural origin", lat);
        let middle = angle("Longitude of natural origin", projection.meridian);
        let shifted = ["False easting", "False northing"];
        let false_origin = |lat, [first, second]: [f64; 2]| {
            vec![
                angle("Latitude of false origin", lat),
                angle("Longitude of false origin", projection.meridian),
                angle("Latitude of 1st standard parallel", first),
                angle("Latitude of 2nd standard parallel", second),
            ]
        };
        let at_origin = ["Easting at false origin", "Northing at false origin"];
        let (method, mut parameters, names) = match projection.method {
            Method::Mercator { .. } if projection.body.e2 == 0.0 => {
                ("Popular Visualisation Pseudo Mercator", vec![natural(0.0), middle], shifted)
            }
            Method::Mercator { scale } => {
                ("Mercator (variant A)", vec![natural(0.0), middle, factor(scale)], shifted)
            }
            Method::Transverse { lat, scale } => {
                ("Transverse Mercator", vec![natural(lat), middle, factor(scale)], shifted)
            }
            Method::Conformal { lat, parallels, scale }
                if parallels[0] == parallels[1] && lat == parallels[0] =>
            {
                (
                    "Lambert Conic Conformal (1SP)",
                    vec![natural(lat), middle, factor(scale)],
                    shifted,
                )
            }
            Method::Conformal { lat, parallels, .. } => {
                ("Lambert Conic Conformal (2SP)", false_origin(lat, parallels), at_origin)
            }
            Method::Albers { lat, parallels } => {
                ("Albers Equal Area", false_origin(lat, parallels), at_origin)
            }
            Method::Azimuthal { lat } => {
                ("Lambert Azimuthal Equal Area", vec![natural(lat), middle], shifted)
            }
            Method::Stereographic { pole, scale } => {
                let parallel = pole * parallel_of(projection.body, scale);
                let parameters = vec![
                    angle("Latitude of standard parallel", parallel),
                    angle("Longitude of origin", projection.meridian),
                ];
                ("Polar Stereographic (variant B)", parameters, shifted)
            }
            Method::Robinson => ("Robinson", vec![middle], shifted),
            Method::EqualEarth => ("Equal Earth", vec![middle], shifted),
        };
        let offsets = names.into_iter().zip((projection.offset / *unit).to_array());
        parameters.extend(offsets.map(|(name, value)| Parameter { name, value, unit: "length" }));
        Some((method, parameters, *unit))
    }
}
