//! `KHR_materials_variants`: which of a primitive's materials is shown.

use super::json::{Primitive, Root, Whole};
use crate::{Error, Result};

/// Returns the names of the variants; unnamed ones are `variant0`, `variant1` …
pub fn names(root: &Root) -> Vec<String> {
    let variants = root.extensions.variants.as_ref().map_or(&[][..], |v| &v.variants);
    let name = |(i, name): (usize, &Option<String>)| name.clone().unwrap_or(format!("variant{i}"));
    variants.iter().map(|v| &v.name).enumerate().map(name).collect()
}

/// Returns the number of the variant of this name, or else of this number; `None` if none is
/// requested.
///
/// # Errors
/// If there is no such variant, with a list of all variants.
pub fn find(names: &[String], wanted: Option<&str>) -> Result<Option<u64>> {
    let Some(wanted) = wanted else { return Ok(None) };
    let by_number = || wanted.parse().ok().filter(|n| *n < names.len());
    let found = names.iter().position(|name| name == wanted).or_else(by_number);
    found.map(|n| Some(n as u64)).ok_or_else(|| {
        let all = if names.is_empty() { "there is none".to_owned() } else { names.join(", ") };
        let at = "extensions.KHR_materials_variants";
        Error::path(at, format!("there is no variant `{wanted}`: {all}"))
    })
}

/// Returns the material of a primitive in a variant.
pub fn material(primitive: &Primitive, variant: Option<u64>) -> Option<Whole> {
    let mappings = primitive.extensions.variants.as_ref().map_or(&[][..], |v| &v.mappings);
    let shown = variant.and_then(|variant| {
        mappings.iter().find(|mapping| mapping.variants.contains(&Whole(variant)))
    });
    shown.and_then(|mapping| mapping.material).or(primitive.material)
}
