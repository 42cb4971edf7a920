//! `KHR_materials_variants`: which of a primitive's materials is shown.

use super::choice;
use super::json::{Primitive, Root, Whole};
use crate::Result;

/// Returns the names of the variants; unnamed ones are `variant0`, `variant1` …
pub fn names(root: &Root) -> Vec<String> {
    let variants = root.extensions.variants.as_ref().map_or(&[][..], |v| &v.variants);
    choice::names("variant", variants.iter().map(|v| &v.name))
}

/// Returns the number of the variant of this name, or else of this number; `None` if none is
/// requested.
///
/// # Errors
/// If there is no such variant, with a list of all variants.
pub fn find(names: &[String], wanted: Option<&str>) -> Result<Option<u64>> {
    let found = choice::find("variant", names, wanted, "extensions.KHR_materials_variants")?;
    Ok(found.map(|n| n as u64))
}

/// Returns the material of a primitive in a variant.
pub fn material(primitive: &Primitive, variant: Option<u64>) -> Option<Whole> {
    let mappings = primitive.extensions.variants.as_ref().map_or(&[][..], |v| &v.mappings);
    let shown = variant.and_then(|variant| {
        mappings.iter().find(|mapping| mapping.variants.contains(&Whole(variant)))
    });
    shown.and_then(|mapping| mapping.material).or(primitive.material)
}
