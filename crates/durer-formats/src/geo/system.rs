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

/// Returns the system of a member `crs` of GeoJSON, as in its version of 2008.
pub fn of_members(members: &[Member]) -> Option<System> {
    let told = members.iter().rfind(|member| member.name == "\"crs\"")?;
    let value: serde_json::Value = serde_json::from_str(&told.value).ok()?;
    let name = value.pointer("/properties/name")?.as_str()?;
    let last = name.rsplit(':').next()?;
    if last == "CRS84" {
        return Some(System::LONLAT);
    }
    let is_known = name.to_ascii_uppercase().contains("EPSG");
    last.parse().ok().filter(|_| is_known).map(System::of_code)
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
