//! The colour of a visible point, for any material.

use super::{Framing, PreparedMaterial};
use crate::math::{Vec3, Vec4};
use crate::shade::light::PreparedLights;
use crate::shade::normal::{face_seen, face_viewer};
use crate::shade::surface::Surface;
use crate::shade::textured::TexturedPoint;
use crate::shade::{Shading, formula, lobes, tone};

/// Returns the colour of a visible point: linear RGBA with straight alpha, all within 0…1 and never
/// NaN.
///
/// Alpha is 1 for opaque materials, 0 or 1 for masked ones (the caller drops points of 0), else the surface's alpha.
/// Both sides of a face are lit; a colour brighter than white keeps its hue and is drawn towards white, all else is
/// kept exactly. Cost: O(lights) and one sample per texture; allocates nothing.
pub fn shade(
    surface: &Surface<'_>,
    material: &PreparedMaterial<'_>,
    lights: &PreparedLights,
    shading: Shading,
) -> Vec4 {
    shade_framed(surface, face_viewer, material, lights, shading)
}

/// Shades a point as [`shade`] does, whose geometric normal is on the viewer's side already, or zero, which is then
/// not tested.
pub fn shade_seen(
    surface: &Surface<'_>,
    material: &PreparedMaterial<'_>,
    lights: &PreparedLights,
    shading: Shading,
) -> Vec4 {
    shade_framed(surface, face_seen, material, lights, shading)
}

#[inline]
fn shade_framed(
    surface: &Surface<'_>,
    frame: Framing,
    material: &PreparedMaterial<'_>,
    lights: &PreparedLights,
    shading: Shading,
) -> Vec4 {
    let base = material.base(surface);
    let alpha = material.coverage(base.w);
    if alpha == 0.0 {
        return Vec4::ZERO;
    }
    let TexturedPoint { frame, position, inputs } =
        material.textured_point_with(surface, frame, base, shading);
    if let Some(lobes) = inputs.lobes.filter(|l| l.is_glass())
        && shading == Shading::MetallicRoughness
    {
        let substance = &inputs.substance;
        let whole = lobes.reflect(&frame, position, (substance, inputs.emission), lights);
        let shine = lobes.shine(&frame, position, substance, lights);
        let (color, alpha) = lobes::glass(whole.into(), shine.into(), alpha);
        return Vec3::from(tone::display(lights.tone.of(color.into()))).extend(alpha);
    }
    let shown = formula::display(&frame, position, &inputs, surface.lit.as_ref(), lights, shading);
    Vec3::from(shown).extend(alpha)
}
