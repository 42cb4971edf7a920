//! Versions before glTF 2.0, which are recognized and refused by name.

use crate::{Error, Place};
use serde::Deserialize;
use serde::de::{Deserializer, IgnoredAny, MapAccess, SeqAccess, Visitor};

/// Returns the error for a version that is not read.
pub fn unsupported(place: Place, version: &str) -> Error {
    let hint = match version.split('.').next() {
        Some("0" | "1") => {
            "export the model as glTF 2.0, or convert it, for example by `gltf-pipeline`"
        }
        _ => "export the model as glTF 2.0",
    };
    Error::Unsupported { place, what: format!("glTF {version}"), hint: hint.to_owned() }
}

/// Returns the version that a JSON text declares or has the structure of, if it is before 2.0.
pub fn version(text: &[u8]) -> Option<String> {
    let outline: Outline = serde_json::from_slice(text).ok()?;
    let said = match outline.asset.unwrap_or_default().version {
        Loose::Text(version) => Some(version),
        Loose::Number(version) => Some(format!("{version:?}")),
        Loose::Object | Loose::Other => None,
    };
    let parts = [outline.accessors, outline.meshes, outline.nodes, outline.scenes];
    match said {
        Some(version) => matches!(version.split('.').next(), Some("0" | "1")).then_some(version),
        // Its lists were objects, and the version might be missing.
        None => parts.contains(&Loose::Object).then(|| "1.0".to_owned()),
    }
}

/// Members that identify the version of a file.
#[derive(Debug, Default, Deserialize)]
#[serde(default)]
struct Outline {
    asset: Option<Asset>,
    accessors: Loose,
    meshes: Loose,
    nodes: Loose,
    scenes: Loose,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
struct Asset {
    version: Loose,
}

/// A value of any kind; only texts and numbers are kept.
#[derive(Debug, Default, PartialEq)]
enum Loose {
    Text(String),
    Number(f64),
    Object,
    #[default]
    Other,
}

impl<'de> Deserialize<'de> for Loose {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Reader;
        impl<'de> Visitor<'de> for Reader {
            type Value = Loose;
            fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str("any value")
            }
            fn visit_str<E>(self, text: &str) -> Result<Loose, E> {
                Ok(Loose::Text(text.to_owned()))
            }
            fn visit_f64<E>(self, number: f64) -> Result<Loose, E> {
                Ok(Loose::Number(number))
            }
            fn visit_u64<E>(self, number: u64) -> Result<Loose, E> {
                Ok(Loose::Number(number as f64))
            }
            fn visit_i64<E>(self, _: i64) -> Result<Loose, E> {
                Ok(Loose::Other)
            }
            fn visit_bool<E>(self, _: bool) -> Result<Loose, E> {
                Ok(Loose::Other)
            }
            fn visit_unit<E>(self) -> Result<Loose, E> {
                Ok(Loose::Other)
            }
            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Loose, A::Error> {
                while map.next_entry::<IgnoredAny, IgnoredAny>()?.is_some() {}
                Ok(Loose::Object)
            }
            fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Loose, A::Error> {
                while list.next_element::<IgnoredAny>()?.is_some() {}
                Ok(Loose::Other)
            }
        }
        deserializer.deserialize_any(Reader)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn old_files_are_reported_by_what_they_say_or_are_built_like() {
        for (text, expected) in [
            (r#"{"asset": {"version": "1.0"}, "accessors": {}}"#, Some("1.0")),
            (r#"{"asset": {"version": 1.1, "profile": {}}, "nodes": {}}"#, Some("1.1")),
            (r#"{"asset": {"version": 1}, "nodes": {}}"#, Some("1.0")),
            (r#"{"asset": {"generator": "x"}, "meshes": {"a": {}}}"#, Some("1.0")),
            (r#"{"meshes": {"a": {"primitives": []}}}"#, Some("1.0")),
            (r#"{"asset": {"version": "2.0"}, "meshes": {}}"#, None),
            (r#"{"asset": {"version": 2.0}, "meshes": {}}"#, None),
            (r#"{"asset": [], "meshes": []}"#, None),
            (r#"{"meshes": [{}], "nodes": null, "scenes": true}"#, None),
            ("[]", None),
            ("", None),
        ] {
            assert_eq!(version(text.as_bytes()).as_deref(), expected, "{text}");
        }
    }
}
