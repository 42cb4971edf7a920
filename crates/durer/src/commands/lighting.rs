//! Lighting of vertices, as in the classic OpenGL pipeline.
//!
//! M. Segal, K. Akeley, *The OpenGL Graphics System: A Specification* 2.1 (2006), 2.14: each vertex gets
//!
//! ```text
//! c = e + a·a_scene + Σ att·spot·(a·a_light + max(n·l, 0)·d·d_light + f·max(n·h, 0)^s·s·s_light)
//! ```
//!
//! from the emission e, the ambient, diffuse and specular reflection a, d, s of the material, for each light that is
//! on; att = 1 / (k₀ + k₁·δ + k₂·δ²) at the distance δ, 1 for a directional light; f = 0 where n·l ≤ 0. Colours are
//! interpolated between the vertices (Gouraud) or are one for all of a primitive (flat).

use crate::math::{DMat3, DVec3, DVec4, Vec4};
use crate::trace::Tracer;
use crate::{Error, Result};

/// The number of lights, the minimum that OpenGL requires.
pub const MAX_LIGHTS: usize = 8;

/// A source of light.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LightSource {
    /// Linear colour of the ambient light, which is attenuated.
    pub ambient: Vec4,
    /// Linear colour that is reflected in all directions.
    pub diffuse: Vec4,
    /// Linear colour that is mirrored.
    pub specular: Vec4,
    /// Homogeneous position; w = 0 is a directional light, whose light comes from there.
    pub position: DVec4,
    /// Axis of a spotlight, away from it.
    pub spot_direction: DVec3,
    /// Exponent by which a spotlight falls off towards its rim, 0 … 128.
    pub spot_exponent: f64,
    /// Half the angle of a spotlight in degrees, 0 … 90; 180 shines in all directions.
    pub spot_cutoff: f64,
    /// k₀, k₁, k₂: the light is divided by their sum, weighted by powers of the distance.
    pub attenuation: [f64; 3],
}

impl Default for LightSource {
    /// Returns the default: OpenGL's light 0, white, directional from +z, without ambient light.
    fn default() -> Self {
        let black = Vec4::new(0.0, 0.0, 0.0, 1.0);
        Self {
            ambient: black,
            diffuse: Vec4::ONE,
            specular: Vec4::ONE,
            position: DVec4::Z,
            spot_direction: DVec3::NEG_Z,
            spot_exponent: 0.0,
            spot_cutoff: 180.0,
            attenuation: [1.0, 0.0, 0.0],
        }
    }
}

/// Reflection of a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reflection {
    /// Share of ambient light.
    pub ambient: Vec4,
    /// Share of diffuse light; its alpha is the result's alpha.
    pub diffuse: Vec4,
    /// Share of mirrored light.
    pub specular: Vec4,
    /// Colour without any light.
    pub emission: Vec4,
    /// Exponent of the highlight, 0 … 128.
    pub shininess: f64,
}

impl Default for Reflection {
    /// Returns the default: OpenGL's initial material.
    fn default() -> Self {
        let grey = |v: f32| Vec4::new(v, v, v, 1.0);
        let (ambient, diffuse) = (grey(0.2), grey(0.8));
        Self { ambient, diffuse, specular: grey(0.0), emission: grey(0.0), shininess: 0.0 }
    }
}

/// Properties of all lighting.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LightModel {
    /// Linear ambient colour that belongs to no light.
    pub ambient: Vec4,
    /// True if the direction to the eye is computed from each vertex; false if it is +z everywhere.
    pub local_viewer: bool,
    /// True if back faces are lit with the back material and reversed normals.
    pub two_sided: bool,
}

impl Default for LightModel {
    /// Returns the default: OpenGL's initial model, a little ambient light, a distant viewer, one side.
    fn default() -> Self {
        let ambient = Vec4::new(0.2, 0.2, 0.2, 1.0);
        Self { ambient, local_viewer: false, two_sided: false }
    }
}

/// Side of faces that a material is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum MaterialFace {
    /// Front faces, and all faces where lighting has one side.
    Front,
    /// Back faces.
    Back,
    /// Both.
    FrontAndBack,
}

/// Property of the materials that follows the colour of vertices.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum ColorMaterial {
    /// The ambient reflection.
    Ambient,
    /// The diffuse reflection.
    Diffuse,
    /// Both.
    AmbientAndDiffuse,
    /// The specular reflection.
    Specular,
    /// The emission.
    Emission,
}

/// Interpolation of colours.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum ShadeModel {
    /// The last vertex of a line or triangle, the first of a polygon, colours all of it.
    Flat,
    /// Interpolation between the vertices: the initial state.
    #[default]
    Smooth,
}

/// The state of lighting.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct LightingState {
    /// True if vertices are lit; at first they have their own colours.
    pub enabled: bool,
    /// The lights that are on, in eye space.
    pub lights: [Option<LightSource>; MAX_LIGHTS],
    /// Ambient light, viewer, sides.
    pub model: LightModel,
    /// Material of front faces.
    pub front: Reflection,
    /// Material of back faces.
    pub back: Reflection,
    /// Property that follows the vertices' colour; at first none.
    pub color_material: Option<ColorMaterial>,
    /// True if normals are made unit length after their transformation.
    pub normalize: bool,
    /// Interpolation of colours, lit or not.
    pub shade_model: ShadeModel,
}

/// The numbers of one light at one vertex.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Step {
    /// Number of the light.
    pub light: usize,
    /// One over the sum of the attenuation's terms.
    pub attenuation: f64,
    /// Share that a spotlight has in this direction.
    pub spot: f64,
    /// n·l, not below 0.
    pub n_dot_l: f64,
    /// n·h, not below 0.
    pub n_dot_h: f64,
    /// Linear colour that the light adds.
    pub color: DVec3,
}

impl LightSource {
    /// Returns the light in another space.
    pub(super) fn transformed(&self, to: &crate::math::DMat4) -> Self {
        let spot_direction = DMat3::from_mat4(*to) * self.spot_direction;
        Self { position: *to * self.position, spot_direction, ..*self }
    }

    /// Checks the light's numbers.
    ///
    /// # Errors
    /// [`Error::Parameter`] for one that is not finite or out of its range.
    pub(crate) fn check(&self) -> Result<()> {
        let colors = [self.ambient, self.diffuse, self.specular];
        if !colors.iter().all(|c| c.is_finite())
            || !self.position.is_finite()
            || !self.spot_direction.is_finite()
        {
            return Err(Error::parameter("light", "given", "finite"));
        }
        let is_angle = (0.0..=90.0).contains(&self.spot_cutoff) || self.spot_cutoff == 180.0;
        if !is_angle {
            let value = self.spot_cutoff;
            return Err(Error::parameter("spot cutoff", value, "from 0 to 90 degrees, or 180"));
        }
        exponent("spot exponent", self.spot_exponent)?;
        let terms = self.attenuation;
        let sum: f64 = terms.iter().sum();
        if !terms.iter().all(|k| *k >= 0.0) || !sum.is_finite() || sum == 0.0 {
            let value = format!("{terms:?}");
            return Err(Error::parameter("attenuation", value, "not negative, and not all zero"));
        }
        Ok(())
    }
}

impl Reflection {
    /// Checks the material's numbers.
    ///
    /// # Errors
    /// [`Error::Parameter`] for one that is not finite or out of its range.
    pub(crate) fn check(&self) -> Result<()> {
        let colors = [self.ambient, self.diffuse, self.specular, self.emission];
        if !colors.iter().all(|c| c.is_finite()) {
            return Err(Error::parameter("material", "given", "finite"));
        }
        exponent("shininess", self.shininess)
    }
}

fn exponent(what: &'static str, value: f64) -> Result<()> {
    if (0.0..=128.0).contains(&value) {
        Ok(())
    } else {
        Err(Error::parameter(what, value, "from 0 to 128"))
    }
}

impl LightingState {
    /// Returns the front or the back material, with the property that follows a vertex's colour.
    fn material(&self, front: bool, color: Vec4) -> Reflection {
        let mut material = if front { self.front } else { self.back };
        match self.color_material {
            None => {}
            Some(ColorMaterial::Ambient) => material.ambient = color,
            Some(ColorMaterial::Diffuse) => material.diffuse = color,
            Some(ColorMaterial::AmbientAndDiffuse) => {
                (material.ambient, material.diffuse) = (color, color);
            }
            Some(ColorMaterial::Specular) => material.specular = color,
            Some(ColorMaterial::Emission) => material.emission = color,
        }
        material
    }

    /// Returns the colour of a vertex, linear RGBA within 0 … 1, by its position, normal and own colour. Position and
    /// normal are in eye space; the normal is used as it is, reversed for the back.
    ///
    /// ```
    /// use durer::commands::{LightSource, LightingState, Reflection};
    /// use durer::math::{DVec3, DVec4, Vec4};
    /// use durer::trace::NoTrace;
    ///
    /// // The initial light from +z, 60 degrees from the normal: 0.2 · 0.2 ambient and 0.8 · ½ diffuse.
    /// let mut lighting = LightingState { enabled: true, ..LightingState::default() };
    /// lighting.lights[0] = Some(LightSource::default());
    /// let normal = DVec3::new(0.75_f64.sqrt(), 0.0, 0.5);
    /// let lit = lighting.lit(true, DVec4::W, normal, Vec4::ONE, &mut NoTrace);
    /// assert!((lit.x - 0.44).abs() < 1e-6 && lit.w == 1.0);
    /// ```
    pub fn lit(
        &self,
        front: bool,
        position: DVec4,
        normal: DVec3,
        color: Vec4,
        t: &mut impl Tracer<Step>,
    ) -> DVec4 {
        let material = self.material(front, color);
        let normal = if front { normal } else { -normal };
        let rgb = |c: Vec4| c.truncate().as_dvec3();
        let mut sum = rgb(material.emission) + rgb(material.ambient) * rgb(self.model.ambient);
        for (light, source) in self.lights.iter().enumerate() {
            let Some(source) = source else { continue };
            let step = self.of_light(light, source, &material, position, normal);
            t.step(|| step);
            sum += step.color;
        }
        sum.extend(f64::from(material.diffuse.w)).clamp(DVec4::ZERO, DVec4::ONE)
    }

    fn of_light(
        &self,
        light: usize,
        source: &LightSource,
        material: &Reflection,
        position: DVec4,
        normal: DVec3,
    ) -> Step {
        let rgb = |c: Vec4| c.truncate().as_dvec3();
        let toward = toward(source.position, position);
        let (l, distance) = (toward.normalize_or_zero(), toward.length());
        let [k0, k1, k2] = source.attenuation;
        let directional = source.position.w == 0.0;
        let attenuation =
            if directional { 1.0 } else { (k0 + k1 * distance + k2 * distance * distance).recip() };
        let spot = spot(source, l);
        let n_dot_l = normal.dot(l).max(0.0);
        let eye =
            if self.model.local_viewer { (-place(position)).normalize_or_zero() } else { DVec3::Z };
        let n_dot_h = normal.dot((l + eye).normalize_or_zero()).max(0.0);
        let highlight = if n_dot_l > 0.0 { libm::pow(n_dot_h, material.shininess) } else { 0.0 };
        let reflected = rgb(material.ambient) * rgb(source.ambient)
            + rgb(material.diffuse) * rgb(source.diffuse) * n_dot_l
            + rgb(material.specular) * rgb(source.specular) * highlight;
        // Attenuation may be infinite in the light itself, where there is no direction.
        let share = attenuation * spot;
        let color = if share.is_finite() { reflected * share } else { DVec3::ZERO };
        Step { light, attenuation, spot, n_dot_l, n_dot_h, color }
    }
}

/// Returns the place of a homogeneous point; for a direction, the direction.
fn place(p: DVec4) -> DVec3 {
    if p.w == 0.0 { p.truncate() } else { p.truncate() / p.w }
}

/// Returns the vector from a vertex to a light; the direction to a directional one.
fn toward(light: DVec4, vertex: DVec4) -> DVec3 {
    if light.w == 0.0 { light.truncate() } else { place(light) - place(vertex) }
}

fn spot(light: &LightSource, l: DVec3) -> f64 {
    if light.spot_cutoff == 180.0 {
        return 1.0;
    }
    let cosine = (-l).dot(light.spot_direction.normalize_or_zero());
    if cosine < libm::cos(light.spot_cutoff.to_radians()) {
        return 0.0;
    }
    libm::pow(cosine.max(0.0), light.spot_exponent)
}
