//! The one place where a shading model's name becomes its formula, for one sample and for eight.

use super::lane::{Lane, Vec3Lane};
use super::light::PreparedLights;
use super::lobes::Lobes;
use super::metallic_roughness::{self, Dielectric, Substance};
use super::normal::Frame;
use super::phong::{self, Shininess};
use super::reflected::Reflected;
use super::{Shading, tone};

/// Everything that textures and factors say about a point.
#[derive(Debug, Clone, Copy)]
pub(super) struct Inputs<'a, L> {
    /// Parameters for the metallic-roughness and the unlit model.
    pub substance: Substance<L>,
    /// Phong's diffuse colour.
    pub diffuse: Vec3Lane<L>,
    /// Phong's specular colour.
    pub specular: Vec3Lane<L>,
    /// Phong's exponent, the same in all lanes.
    pub shininess: Shininess,
    /// Emitted light.
    pub emission: Vec3Lane<L>,
    /// Further lobes of the metallic-roughness model, the same in all lanes.
    pub lobes: Option<&'a Lobes>,
}

/// Returns the displayed colour; `lit` is interpolated or per-face light where the caller has it.
#[inline(always)]
pub(super) fn display<L: Lane>(
    frame: &Frame<L>,
    position: Vec3Lane<L>,
    inputs: &Inputs<'_, L>,
    lit: Option<&Reflected>,
    lights: &PreparedLights,
    shading: Shading,
) -> Vec3Lane<L> {
    let color = match shading {
        Shading::Unlit => return tone::display(inputs.substance.base),
        Shading::MetallicRoughness => metallic_roughness_color(frame, position, inputs, lights),
        Shading::Flat | Shading::Gouraud | Shading::Phong => {
            let normal = if shading == Shading::Flat { frame.face } else { frame.normal };
            let lit = lit.filter(|_| shading != Shading::Phong);
            phong_color(&Frame { normal, ..*frame }, position, inputs, lit, lights)
        }
    };
    tone::display(lights.tone.of(color))
}

#[inline(always)]
fn metallic_roughness_color<L: Lane>(
    frame: &Frame<L>,
    position: Vec3Lane<L>,
    inputs: &Inputs<'_, L>,
    lights: &PreparedLights,
) -> Vec3Lane<L> {
    let Inputs { substance, emission, lobes, .. } = inputs;
    match lobes {
        None => metallic_roughness::reflect(frame, position, substance, Dielectric::PLAIN, lights)
            .plus(*emission),
        Some(lobes) => lobes.reflect(frame, position, (substance, *emission), lights),
    }
}

#[inline(always)]
fn phong_color<L: Lane>(
    frame: &Frame<L>,
    position: Vec3Lane<L>,
    inputs: &Inputs<'_, L>,
    lit: Option<&Reflected>,
    lights: &PreparedLights,
) -> Vec3Lane<L> {
    let occlusion = inputs.substance.occlusion;
    let (diffuse, specular) = match lit {
        Some(lit) => {
            (Vec3Lane::splat(occlusion, lit.diffuse), Vec3Lane::splat(occlusion, lit.specular))
        }
        None => phong::reflect(frame, position, lights, inputs.shininess, occlusion),
    };
    diffuse.times(inputs.diffuse).plus(specular.times(inputs.specular)).plus(inputs.emission)
}
