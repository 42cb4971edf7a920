//! Point clouds, for all formats.

use crate::budget::MODEL;
use crate::model::count_infinite;
use crate::{Error, Limits, Model, Place, Result, facets, place};
use durer::math::{DVec3, Vec4};
use durer::scene::{Instance, Mesh, Topology, UpAxis};

/// The points so far. There are as many colours and intensities as points, or none.
#[derive(Debug, Default)]
pub(crate) struct Cloud {
    pub points: Vec<DVec3>,
    /// Red, green and blue of sRGB, from 0 to `full`, and alpha 1.
    pub colors: Vec<Vec4>,
    /// Divisor of colours.
    pub full: f32,
    /// Intensities of the echoes, in any unit; shown if there are no colours.
    pub intensities: Vec<f32>,
    /// Number of points for which memory has been charged.
    pub room: u64,
}

/// Bytes of a point while it is read: its place, colour and intensity, and its place and colour in the mesh.
const BYTES: u64 = 72;
/// Number of points for which memory is charged at a time.
const AT_ONCE: u64 = 1 << 12;

/// The part of all intensities that is as dark, or as bright, as can be: the outliers.
const OUTLIERS: usize = 100;
/// The grey of the least intensity, so that nothing vanishes on a dark ground.
const DARKEST: f32 = 0.1;

impl Cloud {
    /// Charges the memory for this many points in all, and refuses more than allowed.
    ///
    /// # Errors
    /// [`Error::Limit`]; those of the work.
    pub fn make_room(
        &mut self,
        value: u64,
        place: impl FnOnce() -> Place,
        limits: &Limits,
    ) -> Result<()> {
        let limit = limits.primitives.min(u64::from(u32::MAX));
        if value > limit {
            return Err(Error::Limit { place: place(), what: "number of points", value, limit });
        }
        if value > self.room {
            let more = (value - self.room).max(AT_ONCE);
            limits.work.keep(MODEL, more.saturating_mul(BYTES))?;
            self.room += more;
        }
        Ok(())
    }

    /// Adds the points to a model: z is up.
    ///
    /// # Errors
    /// An inconsistent scene, which would be a bug in the reader.
    pub fn into_model(mut self, mut model: Model) -> Result<Model> {
        model.scene.up_axis = UpAxis::Z;
        if self.points.is_empty() {
            model.warn(Place::Whole, "holds no points");
        }
        let origin = place::origin(&self.points);
        let positions = place::narrow(&self.points, origin);
        self.points = Vec::new();
        let words = "{point has|points have} a coordinate that is NaN or infinite";
        model.warn_counted(Place::Whole, count_infinite(&positions) as u64, words);
        let colors = self.linear_colors(&mut model);
        let mut mesh = Mesh { topology: Topology::Points, positions, colors, ..Mesh::default() };
        facets::show_colors(&mut model, std::slice::from_mut(&mut mesh));
        model.scene.meshes.push(mesh);
        let (world_from_mesh, name) = (place::matrix(origin), String::new());
        model.scene.instances.push(Instance { mesh: 0, world_from_mesh, name });
        model.scene.check()?;
        Ok(model)
    }

    fn linear_colors(self, model: &mut Model) -> Vec<Vec4> {
        let mut colors = self.colors;
        let flat = colors.iter().all(|c| Some(c) == colors.first());
        // Formats with room for colours have zeros there if there are none.
        if flat && self.intensities.iter().any(|i| Some(i) != self.intensities.first()) {
            colors = greys(&self.intensities);
        } else if flat && colors.first().is_some_and(|c| c.truncate().max_element() <= 0.0) {
            return Vec::new();
        } else {
            let scale = Vec4::new(self.full, self.full, self.full, 1.0).recip();
            colors.iter_mut().for_each(|c| *c *= scale);
        }
        facets::make_linear(model, &mut colors);
        colors
    }
}

/// Returns intensities as greys of sRGB: from the smallest to the largest, ignoring outliers.
fn greys(intensities: &[f32]) -> Vec<Vec4> {
    let mut sorted: Vec<f32> = intensities.iter().copied().filter(|i| i.is_finite()).collect();
    let outliers = sorted.len() / OUTLIERS;
    let last = sorted.len().saturating_sub(1);
    let mut at = |place: usize| match sorted.get_mut(..) {
        Some(all) if !all.is_empty() => *all.select_nth_unstable_by(place, f32::total_cmp).1,
        _ => 0.0,
    };
    let (least, most) = (at(outliers), at(last.saturating_sub(outliers)));
    let range = if most > least { most - least } else { 1.0 };
    let grey = |i: f32| {
        let part = ((i - least) / range).clamp(0.0, 1.0);
        let part = if part.is_nan() { 0.0 } else { part };
        let grey = DARKEST + (1.0 - DARKEST) * part;
        Vec4::new(grey, grey, grey, 1.0)
    };
    intensities.iter().map(|&i| grey(i)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cloud(colors: Vec<Vec4>, intensities: Vec<f32>) -> Mesh {
        let points = (0..4).map(|i| DVec3::splat(f64::from(i))).collect();
        let cloud = Cloud { points, colors, full: 255.0, intensities, ..Cloud::default() };
        cloud.into_model(Model::default()).expect("sound").scene.meshes.remove(0)
    }

    #[test]
    fn colors_go_before_intensities_and_black_is_none() {
        let greys = vec![1.0, 2.0, f32::NAN, 3.0];
        let red = Vec4::new(255.0, 0.0, 0.0, 1.0);
        let mesh = cloud(vec![red, Vec4::W, red, red], greys.clone());
        assert_eq!(mesh.colors[0], Vec4::new(1.0, 0.0, 0.0, 1.0));
        let mesh = cloud(vec![Vec4::W; 4], greys);
        assert!((mesh.colors[0].x - 0.01).abs() < 1e-3, "{}", mesh.colors[0]);
        assert_eq!((mesh.colors[2], mesh.colors[3]), (mesh.colors[0], Vec4::ONE));
        let mesh = cloud(vec![Vec4::W; 4], vec![]);
        assert!(mesh.colors.is_empty() && mesh.parts.is_empty());
        assert_eq!(cloud(vec![red; 4], vec![5.0; 4]).colors[0].x, 1.0);
    }
}
