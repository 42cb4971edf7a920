//! The coordinate system that a file states.

use super::{Member, crs};

/// The coordinate system that a file says its coordinates are in.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct System {
    /// Its number in the EPSG's list, if it is known.
    pub code: Option<i32>,
    /// Its definition as well-known text, as the file has it.
    pub wkt: Option<String>,
}

impl System {
    /// Longitude and latitude in degrees on WGS 84, as GeoJSON, KML and GPX have them always.
    pub const LONLAT: Self = Self { code: Some(4326), wkt: None };

    /// Creates a system by its number.
    pub fn of_code(code: i32) -> Self {
        Self { code: Some(code), wkt: None }
    }

    /// Creates a system by its definition, and searches for its number.
    pub fn of_wkt(wkt: &str) -> Self {
        let wkt = wkt.trim();
        let given = (!wkt.is_empty()).then(|| wkt.to_owned());
        Self { code: crs::code_of_wkt(wkt), wkt: given }
    }

    /// Returns whether nothing is known.
    pub fn is_unknown(&self) -> bool {
        self.code.is_none() && self.wkt.is_none()
    }
}

/// Returns the system of the member `crs` of GeoJSON, as in its version of 2008: unknown if the member is null or names
/// none that is known; `None` without the member.
pub fn of_members(members: &[Member]) -> Option<System> {
    members.iter().rfind(|member| member.name == CRS).map(|member| of_value(&member.value))
}

/// Name of the member for the coordinate system, in JSON.
pub const CRS: &str = "\"crs\"";

/// Returns the system of a value of the member `crs`.
pub fn of_value(json: &str) -> System {
    let value: serde_json::Value = serde_json::from_str(json).unwrap_or_default();
    let of = |place: &str| value.pointer(place);
    let name = of("/properties/name").or_else(|| of("/properties/href")).and_then(|n| n.as_str());
    if let Some(name) = name {
        return of_name(name).unwrap_or_default();
    }
    // The type EPSG of GeoServer and of drafts of the standard.
    let is_code = of("/type").and_then(|kind| kind.as_str()) == Some("EPSG");
    let code = of("/properties/code").filter(|_| is_code);
    let code = code.and_then(|code| match code.as_str() {
        Some(text) => text.trim().parse().ok(),
        None => code.as_i64().and_then(|code| i32::try_from(code).ok()),
    });
    code.map_or_else(System::default, System::of_code)
}

/// Returns the system of a name such as `EPSG:25832`, `urn:ogc:def:crs:EPSG::25832`, `urn:ogc:def:crs:OGC:1.3:CRS84` or
/// `http://www.opengis.net/def/crs/EPSG/0/25832`.
fn of_name(name: &str) -> Option<System> {
    let parts: Vec<&str> = name.split([':', '/', '#']).map(str::trim).collect();
    let is_lonlat = |pair: &[&str]| {
        pair[1] == "CRS84" || pair[0].eq_ignore_ascii_case("CRS") && pair[1] == "84"
    };
    if name == "CRS84" || parts.windows(2).any(is_lonlat) {
        return Some(System::LONLAT);
    }
    let start = parts.iter().position(|part| {
        part.get(..4).is_some_and(|beginning| beginning.eq_ignore_ascii_case("epsg"))
    })?;
    parts.get(start + 1..)?.iter().rev().find_map(|part| part.parse().ok()).map(System::of_code)
}

impl System {
    /// Returns its member `crs` in GeoJSON; `None` if it is the system that GeoJSON assumes.
    pub fn member(&self) -> Option<Member> {
        let code = self.code.filter(|code| *code != 4326)?;
        let value = format!(
            "{{\"type\":\"name\",\"properties\":{{\"name\":\"urn:ogc:def:crs:EPSG::{code}\"}}}}"
        );
        Some(Member::new("crs", value))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn members_name_systems_in_many_ways() {
        let named = |name: &str| {
            of_value(&format!(r#"{{"type":"name","properties":{{"name":"{name}"}}}}"#)).code
        };
        for (name, code) in [
            ("EPSG:25832", Some(25832)),
            ("epsg:3857", Some(3857)),
            ("urn:ogc:def:crs:EPSG::31467", Some(31467)),
            ("urn:ogc:def:crs:EPSG:9.8.15:3857", Some(3857)),
            ("http://www.opengis.net/def/crs/EPSG/0/2056", Some(2056)),
            ("http://www.opengis.net/gml/srs/epsg.xml#4258", Some(4258)),
            ("urn:ogc:def:crs:OGC:1.3:CRS84", Some(4326)),
            ("urn:ogc:def:crs:OGC::CRS84", Some(4326)),
            ("CRS:84", Some(4326)),
            ("mine", None),
            ("urn:ogc:def:crs:EPSG::", None),
            ("ESRI:54009", None),
        ] {
            assert_eq!(named(name), code, "{name}");
        }
        let code = |json: &str| of_value(json).code;
        assert_eq!(code(r#"{"type":"EPSG","properties":{"code":31467}}"#), Some(31467));
        assert_eq!(code(r#"{"type":"EPSG","properties":{"code":"2056"}}"#), Some(2056));
        let link = r#"{"type":"link","properties":{"href":"http://spatialreference.org/ref/epsg/4269/proj4/"}}"#;
        assert_eq!(code(link), Some(4269));
        for json in ["null", "3", "{}", r#"{"type":"link","properties":{"href":"a.proj4"}}"#] {
            assert!(of_value(json).is_unknown(), "{json}");
        }
        let members = [Member { name: CRS.to_owned(), value: "null".to_owned() }];
        assert_eq!(of_members(&members), Some(System::default()), "null is stated");
        assert_eq!(of_members(&[]), None);
    }
}
