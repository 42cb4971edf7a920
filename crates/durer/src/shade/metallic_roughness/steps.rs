//! The formula for one light, step by step.

use super::{Dielectric, Substance, lit, point};
use crate::math::Vec3;
use crate::shade::lane::Vec3Lane;
use crate::shade::normal::face_viewer;
use crate::trace::{PseudocodeLine, Recorder, Tracer};

/// A point of a surface and a light.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lit {
    /// Base colour, linear, 0 … 1.
    pub base: Vec3,
    /// Metalness, 0 … 1.
    pub metallic: f32,
    /// Perceptual roughness, 0 … 1.
    pub roughness: f32,
    /// Unit normal; it is turned to the side of the eye.
    pub normal: Vec3,
    /// Unit vector to the eye.
    pub to_eye: Vec3,
    /// Unit vector to the light.
    pub to_light: Vec3,
}

/// Step of reflecting a light.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step {
    /// The cosines n·l, n·v, n·h and v·h.
    Cosines([f32; 4]),
    /// The distribution of facets.
    Distribution {
        /// The square of the roughness, which is at least 0.06.
        alpha: f32,
        /// D, times π.
        value: f32,
    },
    /// The visibility of facets from the light and from the eye, over 4 n·l n·v.
    Visibility(f32),
    /// Fresnel reflection.
    Fresnel {
        /// Reflectance straight on, with the light that is reflected more than once.
        straight: Vec3,
        /// Reflectance at grazing angles, likewise.
        grazing: Vec3,
        /// (1 − v·h)⁵, the part of the latter.
        away: f32,
        /// F.
        value: Vec3,
    },
    /// Diffuse reflection.
    Diffuse {
        /// Part of the light that enters the dielectric.
        through: f32,
        /// The diffuse reflectance, times π.
        value: Vec3,
    },
    /// Everything that leaves towards the eye.
    Sum(Vec3),
}

impl PseudocodeLine for Step {
    fn line(&self) -> usize {
        match self {
            Self::Cosines(_) => 1,
            Self::Distribution { .. } => 2,
            Self::Visibility(_) => 3,
            Self::Fresnel { .. } => 6,
            Self::Diffuse { .. } => 7,
            Self::Sum(_) => 8,
        }
    }
}

/// Returns the light that the steps before the sum lead to.
pub fn replay(steps: &[Step]) -> Vec3 {
    let [mut n_l, mut mirrored] = [0.0; 2];
    let [mut fresnel, mut diffuse] = [Vec3::ZERO; 2];
    for step in steps {
        match *step {
            Step::Cosines([first, ..]) => n_l = first,
            Step::Distribution { value, .. } => mirrored = value,
            Step::Visibility(value) => mirrored *= value,
            Step::Fresnel { value, .. } => fresnel = value,
            Step::Diffuse { value, .. } => diffuse = value,
            Step::Sum(_) => {}
        }
    }
    (diffuse + fresnel * mirrored) * n_l
}

/// Returns the part of a light that a dielectric of refractive index 1.5, or a metal, reflects towards the eye, by the
/// formula with which surfaces are lit: for the colour 1, in the light's unit, which contains π.
///
/// ```
/// use durer::math::Vec3;
/// use durer::shade::metallic_roughness::{Lit, reflect_one};
/// use durer::trace::NoTrace;
///
/// let straight_on = Lit {
///     base: Vec3::splat(0.5),
///     metallic: 0.0,
///     roughness: 1.0,
///     normal: Vec3::Z,
///     to_eye: Vec3::Z,
///     to_light: Vec3::Z,
/// };
/// // 0.96 of the base colour, and a hundredth from rough reflection.
/// assert!((reflect_one(&straight_on, &mut NoTrace).x - 0.49).abs() < 0.002);
/// ```
pub fn reflect_one(at: &Lit, t: &mut impl Tracer<Step>) -> Vec3 {
    let frame = face_viewer(at.to_eye.into(), at.normal.into(), at.normal.into());
    let substance = Substance {
        base: at.base.into(),
        metallic: at.metallic,
        roughness: at.roughness,
        occlusion: 1.0,
        mirrors: false,
    };
    let (point, _) = point(&frame, &substance, Dielectric::PLAIN);
    let mut terms = Recorder::with_cap(1);
    let sum = lit(&frame, &point, at.to_light.into(), &mut terms);
    let plain = |v: Vec3Lane<f32>| Vec3::new(v.x, v.y, v.z);
    if let Some(terms) = terms.into_steps().pop() {
        t.step(|| Step::Cosines(terms.cosines));
        t.step(|| Step::Distribution { alpha: point.alpha, value: terms.distribution });
        t.step(|| Step::Visibility(terms.visibility));
        t.step(|| Step::Fresnel {
            straight: plain(point.direct.straight),
            grazing: plain(point.direct.grazing),
            away: terms.away,
            value: plain(terms.fresnel),
        });
        t.step(|| Step::Diffuse { through: terms.through, value: plain(terms.diffuse) });
    }
    t.step(|| Step::Sum(plain(sum)));
    plain(sum)
}
