//! Shadow maps: the depth of the first surface that each light meets.
//!
//! L. Williams, *Casting Curved Shadows on Curved Surfaces*, SIGGRAPH 1978; four comparisons weighted by distance: W.
//! Reeves, D. Salesin, R. Cook, *Rendering Antialiased Shadows with Depth Maps*, SIGGRAPH 1987. Image space. Each texel
//! of a map holds the depth of the first surface that the light meets; points farther away are in shadow. Cost: one
//! picture per map, then O(1) per point and light.
//!
//! Limits: shadows are as sharp as the map is fine, with steps of a texel along their edges; objects thinner than a
//! texel may cast none. So that a surface does not shadow itself, points are moved off it along its normal by the size
//! of a texel on the slope; shadows begin that far from the foot of an object.

use super::lane::{Lane, Vec3Lane};
use crate::info::{Class, Info, Occluder};
use crate::math::{DMat4, Mat4, Vec3};
use crate::target::Pixels;
use crate::trace::{NoTrace, PseudocodeLine, Tracer};
use crate::{Error, Result};
use std::sync::Arc;

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "shadow-map",
    title: "Shadow maps",
    authors: "L. Williams; W. Reeves, D. Salesin, R. Cook",
    year: 1978,
    source: "Casting Curved Shadows on Curved Surfaces, SIGGRAPH",
    class: Class::ImageSpace,
    occluder: Occluder::Point,
    coherence: &[],
    cost: "one depth picture per map, then O(1) per point and light; 4 bytes per texel",
    limits: "as sharp as the map's resolution; blended surfaces, lines and points cast no shadow",
    pseudocode: &[
        "for each light: map ← depth of the surface that it meets first, texel by texel",
        "for each point P of a surface with the normal N, turned to the light:",
        "    P ← P + N · texel · (1.6 · sin of N and the axis + 0.1)",
        "    (x, y, d) ← P in the space of the map",
        "    outside of the map: all light reaches P, next point",
        "    for each of the four texels around (x, y):",
        "        it is lit if d ≤ its depth",
        "    share ← mean of the four, weighted by their distances",
    ],
};

/// Step of a look-up in a map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step {
    /// The point was moved off its surface and is in the map, or not.
    Moved {
        /// The point, relative to the lights' origin.
        position: Vec3,
        /// The distance by which it was moved along the normal.
        bias: f32,
        /// Its place in the map, in texels, and its depth there.
        place: Vec3,
        /// True if that is within the map.
        inside: bool,
    },
    /// Comparison of its depth with that of a texel.
    Texel {
        /// Column and row.
        texel: [u32; 2],
        /// The stored depth; 1 if the light meets nothing.
        stored: f32,
        /// The depth of the point.
        depth: f32,
        /// Weight of the texel in the mean; texels without any are left out.
        weight: f32,
        /// True if the point is not behind the surface that the light sees there.
        lit: bool,
    },
    /// The share of the light that reaches the point.
    Share {
        /// Share of the light, 0 … 1.
        share: f32,
    },
}

impl PseudocodeLine for Step {
    fn line(&self) -> usize {
        match self {
            Self::Moved { inside: true, .. } => 4,
            Self::Moved { inside: false, .. } => 5,
            Self::Texel { .. } => 7,
            Self::Share { .. } => 8,
        }
    }
}

/// Returns the share that the steps of one look-up lead to, up to rounding; `None` outside the map.
pub fn replay(steps: &[Step]) -> Option<f32> {
    let inside = steps.iter().any(|step| matches!(step, Step::Moved { inside: true, .. }));
    let lit = |step: &Step| match *step {
        Step::Texel { weight, lit: true, .. } => weight,
        _ => 0.0,
    };
    inside.then(|| steps.iter().map(lit).sum())
}

/// Factor of the slope's depth over a texel by which a point is moved: four texels around it are
/// sampled, whose centres are up to √2 texels away. Less makes surfaces speckled.
const SLOPE_BIAS: f32 = 1.6;

/// Part of a texel by which a point is always moved, for the rounding of depths and vertices.
const BIAS: f32 = 0.1;

/// Depths that one light sees, by texel.
#[derive(Debug, Clone, PartialEq)]
pub struct ShadowMap {
    /// Matrix from points relative to [`super::PreparedLights::origin`] to texels times w and depth times w.
    map_from_position: Mat4,
    /// Size of a texel in world units, at w = 1 where the map is seen in perspective.
    texel: f32,
    perspective: bool,
    /// The unit vector along which depths grow, or against it.
    axis: Vec3,
    depths: Arc<Pixels<f32>>,
}

impl ShadowMap {
    /// Creates a map from its depths: window depths, 1 where the light meets nothing.
    ///
    /// `map_from_position` takes points relative to the lights' origin to homogeneous screen space of the
    /// map, as [`crate::view::View::screen_from_world`] does; `texel` is the size of a texel in world
    /// units, for a map in perspective that at distance 1.
    ///
    /// # Errors
    /// [`Error::Parameter`] for a map without texels and for numbers that are not finite.
    pub fn new(
        map_from_position: &DMat4,
        texel: f64,
        perspective: bool,
        depths: Pixels<f32>,
    ) -> Result<Self> {
        if depths.data().is_empty() {
            return Err(Error::parameter("shadow map", "empty", "at least one texel"));
        }
        let map_from_position = map_from_position.as_mat4();
        if !map_from_position.is_finite() || !texel.is_finite() {
            return Err(Error::parameter("shadow map's matrix", texel, "finite"));
        }
        let axis = map_from_position.row(2).truncate().normalize_or_zero();
        let (texel, depths) = (texel as f32, Arc::new(depths));
        Ok(Self { map_from_position, texel, perspective, axis, depths })
    }

    /// Returns the share of the light that reaches a point, 0 … 1; `None` outside the map.
    ///
    /// `face` is the unit normal of the surface, turned to the light's side.
    #[inline]
    pub fn reach(&self, position: Vec3, face: Vec3) -> Option<f32> {
        self.reach_traced(position, face, &mut NoTrace)
    }

    /// Returns the share of light as [`Self::reach`] does, with a tracer.
    #[inline]
    pub fn reach_traced(
        &self,
        position: Vec3,
        face: Vec3,
        t: &mut impl Tracer<Step>,
    ) -> Option<f32> {
        let seen = self.map_from_position * position.extend(1.0);
        if seen.w <= 0.0 {
            return None;
        }
        let texel = if self.perspective { self.texel * seen.w } else { self.texel };
        // The size of a texel across the axis is the same everywhere in the map.
        let cosine = face.dot(self.axis).clamp(-1.0, 1.0);
        let sine = (1.0 - cosine * cosine).sqrt();
        let bias = texel * (SLOPE_BIAS * sine + BIAS);
        let moved = position + face * bias;
        let p = self.map_from_position * moved.extend(1.0);
        let (x, y, depth) = (p.x / p.w, p.y / p.w, p.z / p.w);
        let (width, height) = (self.depths.width() as f32, self.depths.height() as f32);
        let inside = x >= 0.0 && y >= 0.0 && x < width && y < height && depth >= 0.0;
        t.step(|| Step::Moved { position, bias, place: Vec3::new(x, y, depth), inside });
        if !inside {
            return None;
        }
        let share = self.filtered(x - 0.5, y - 0.5, depth, t);
        t.step(|| Step::Share { share });
        Some(share)
    }

    /// Returns the share of the four texels around a place that are not nearer to the light.
    #[inline]
    fn filtered(&self, x: f32, y: f32, depth: f32, t: &mut impl Tracer<Step>) -> f32 {
        let (left, top) = (x.floor(), y.floor());
        let (fx, fy) = (x - left, y - top);
        let mut lit = |dx: f32, dy: f32| {
            let (i, j) = ((left + dx).max(0.0) as u32, (top + dy).max(0.0) as u32);
            let (i, j) = (i.min(self.depths.width() - 1), j.min(self.depths.height() - 1));
            let nearest = self.depths.get(i, j).unwrap_or(1.0);
            let lit = nearest >= 1.0 || depth <= nearest;
            let weight =
                (if dx > 0.0 { fx } else { 1.0 - fx }) * (if dy > 0.0 { fy } else { 1.0 - fy });
            if weight > 0.0 {
                t.step(|| Step::Texel { texel: [i, j], stored: nearest, depth, weight, lit });
            }
            if lit { 1.0 } else { 0.0 }
        };
        let upper = lit(0.0, 0.0) * (1.0 - fx) + lit(1.0, 0.0) * fx;
        let lower = lit(0.0, 1.0) * (1.0 - fx) + lit(1.0, 1.0) * fx;
        upper * (1.0 - fy) + lower * fy
    }
}

/// The maps of all lights of a picture; by default none, which means no shadows.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct ShadowMaps {
    /// Maps by the index in [`super::PreparedLights::directional`].
    pub directional: Vec<Vec<ShadowMap>>,
    /// Maps by the index in [`super::PreparedLights::points`]; several maps look in several directions.
    pub points: Vec<Vec<ShadowMap>>,
}

impl ShadowMaps {
    /// Returns whether there are no maps.
    pub(crate) fn is_empty(&self) -> bool {
        self.directional.is_empty() && self.points.is_empty()
    }
}

/// Returns the share of a light that reaches points, by its maps; all of it without maps and
/// outside of them.
///
/// Surfaces that face away from the light are dark without a map, so here all light reaches them.
#[inline(always)]
pub(super) fn reach<L: Lane>(
    maps: Option<&Vec<ShadowMap>>,
    position: Vec3Lane<L>,
    face: Vec3Lane<L>,
    to_light: Vec3Lane<L>,
) -> L {
    let one = position.x.splat(1.0);
    match maps {
        Some(maps) if !maps.is_empty() => reach_by(maps, position, face, to_light),
        _ => one,
    }
}

/// Returns the share of light that reaches points, by their maps. It is not inlined: formulas would prepare for it
/// before they know that there are maps.
#[inline(never)]
fn reach_by<L: Lane>(maps: &[ShadowMap], p: Vec3Lane<L>, n: Vec3Lane<L>, l: Vec3Lane<L>) -> L {
    L::lanewise([p.x, p.y, p.z, n.x, n.y, n.z, l.x, l.y, l.z], |v| reach_one(maps, v))
}

#[inline(never)]
fn reach_one(maps: &[ShadowMap], [px, py, pz, nx, ny, nz, lx, ly, lz]: [f32; 9]) -> f32 {
    let (position, l) = (Vec3::new(px, py, pz), Vec3::new(lx, ly, lz));
    let face = Vec3::new(nx, ny, nz).normalize_or_zero();
    if face.dot(l) <= 0.0 {
        return 1.0;
    }
    maps.iter().find_map(|map| map.reach(position, face)).unwrap_or(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::DVec3;

    /// Returns a light above the plane z = 0 that looks down −z; texels of one unit, depth 0 at z =
    /// 10.
    fn map(depths: Vec<f32>) -> ShadowMap {
        let matrix = DMat4::from_cols_array_2d(&[
            [1.0, 0.0, 0.0, 0.0],
            [0.0, 1.0, 0.0, 0.0],
            [0.0, 0.0, -0.1, 0.0],
            [0.0, 0.0, 1.0, 1.0],
        ]);
        let side = depths.len() as u32 / 2;
        let depths = Pixels::from_data(side, 2, depths).expect("size");
        ShadowMap::new(&matrix, 1.0, false, depths).expect("map")
    }

    #[test]
    fn what_is_behind_the_nearest_is_dark_and_edges_are_weighted() {
        let map = map(vec![1.0, 0.5, 0.5, 1.0, 0.5, 0.5]);
        let at = |x: f32, z: f32| map.reach(Vec3::new(x, 1.0, z), Vec3::Z);
        assert_eq!((at(2.5, 1.0), at(2.5, 6.0)), (Some(0.0), Some(1.0)));
        assert_eq!((at(0.5, 1.0), at(1.25, 1.0)), (Some(1.0), Some(0.25)));
        assert_eq!((at(-0.1, 1.0), at(3.0, 1.0)), (None, None));
    }

    #[test]
    fn equal_depths_are_lit() {
        let map = map(vec![0.5; 4]);
        let filtered = |depth| map.filtered(0.0, 0.0, depth, &mut NoTrace);
        assert_eq!((filtered(0.5), filtered(0.6)), (1.0, 0.0));
    }

    #[test]
    fn steps_add_up_to_the_share() {
        let map = map(vec![1.0, 0.5, 0.5, 1.0, 0.5, 0.5]);
        for (x, y, z) in [(0.5, 1.0, 1.0), (1.25, 0.8, 1.0), (2.5, 1.3, 6.0), (-0.1, 1.0, 1.0)] {
            let (position, mut steps) = (Vec3::new(x, y, z), crate::trace::Recorder::default());
            let share = map.reach_traced(position, Vec3::Z, &mut steps);
            assert_eq!(share, map.reach(position, Vec3::Z));
            let rebuilt = replay(steps.steps());
            assert_eq!(share.is_some(), rebuilt.is_some());
            assert!(share.zip(rebuilt).is_none_or(|(a, b)| (a - b).abs() < 1e-6));
        }
    }

    #[test]
    fn a_slope_does_not_shadow_itself() {
        // The plane z = x, with its depth at the texels' centres.
        let depths = |x: f32| 1.0 - 0.1 * (x + 0.5);
        let row: Vec<f32> = (0..4).map(|x| depths(x as f32)).collect();
        let map = map([row.clone(), row].concat());
        let normal = Vec3::new(-1.0, 0.0, 1.0).normalize();
        for i in 0..30 {
            // Moved along the normal, all of these are still in the map.
            let x = 0.95 + i as f32 * 0.1;
            assert_eq!(map.reach(Vec3::new(x, 1.0, x), normal), Some(1.0), "{x}");
        }
    }

    #[test]
    fn maps_without_texels_or_sense_are_refused() {
        let pixels = || Pixels::new(2, 2, 1.0);
        assert!(ShadowMap::new(&DMat4::IDENTITY, 1.0, true, Pixels::new(0, 2, 1.0)).is_err());
        assert!(ShadowMap::new(&DMat4::IDENTITY, f64::NAN, true, pixels()).is_err());
        let wild = DMat4::from_translation(DVec3::splat(f64::INFINITY));
        assert!(ShadowMap::new(&wild, 1.0, true, pixels()).is_err());
    }
}
