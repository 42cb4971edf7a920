//! The points of a set that lie outermost along some directions: all that fitting a frame needs.
//!
//! Points come in batches; a batch whose box lies within what there is already costs one look per
//! direction. Cost: O(points), a few operations each.

use crate::math::{DMat3, DMat4, DVec3, Vec3};
use crate::scene::{Aabb, Scene};

/// Points that are looked at together: neighbours in the file mostly are neighbours in space.
const BATCH: usize = 64;

/// Every so-manieth batch of a mesh is looked at before the others.
const SAMPLED: usize = 16;

/// What a box of transformed points grows by, relative to its numbers, so that rounding does not
/// leave a point outside: far above the 2⁻⁵³ that each of a few operations may be off.
const SLACK: f64 = 1e-14;

/// The outermost points along directions that are given, and along the axes.
pub(super) struct Outermost<const N: usize> {
    furthest: [Furthest; N],
    /// Along x, y and z, and against them.
    extremes: [[Furthest; 2]; 3],
}

/// The furthest point along a direction.
#[derive(Clone, Copy)]
struct Furthest {
    direction: DVec3,
    distance: f64,
    point: DVec3,
}

impl Furthest {
    fn along(direction: DVec3) -> Self {
        Self { direction, distance: f64::NEG_INFINITY, point: DVec3::ZERO }
    }

    /// Adds points and a box around them.
    fn add(&mut self, points: impl Iterator<Item = DVec3>, around: &Aabb) {
        // The same products and sums as a point's, each at least as large, also when rounded.
        let corner = DVec3::select(self.direction.cmpge(DVec3::ZERO), around.max, around.min);
        if self.direction.dot(corner) <= self.distance {
            return;
        }
        for point in points {
            let distance = self.direction.dot(point);
            if distance > self.distance {
                (self.distance, self.point) = (distance, point);
            }
        }
    }
}

impl<const N: usize> Outermost<N> {
    /// Of no points so far.
    pub fn new(directions: [DVec3; N]) -> Self {
        let both = |axis: DVec3| [Furthest::along(axis), Furthest::along(-axis)];
        let extremes = DVec3::AXES.map(both);
        Self { furthest: directions.map(Furthest::along), extremes }
    }

    /// Adds points; those that are not finite are left out.
    pub fn add_points(&mut self, points: impl IntoIterator<Item = DVec3>) {
        let mut batch = Vec::with_capacity(BATCH);
        for point in points.into_iter().filter(|p| p.is_finite()) {
            batch.push(point);
            if batch.len() == BATCH {
                self.add_batch(&batch);
                batch.clear();
            }
        }
        self.add_batch(&batch);
    }

    fn add_batch(&mut self, points: &[DVec3]) {
        if let Some(around) = Aabb::around(points.iter().copied()) {
            self.add(points.iter().copied(), &around);
        }
    }

    /// Adds all finite vertices of a scene that something is drawn with.
    pub fn add_scene(&mut self, scene: &Scene) {
        let used: Vec<_> = scene.meshes.iter().map(|mesh| mesh.used_vertices()).collect();
        for instance in &scene.instances {
            if let (Some(mesh), Some(used)) =
                (scene.meshes.get(instance.mesh), used.get(instance.mesh))
            {
                self.add_mesh(&mesh.positions, used.as_deref(), &instance.world_from_mesh);
            }
        }
    }

    fn add_mesh(&mut self, positions: &[Vec3], used: Option<&[bool]>, place: &DMat4) {
        let mut add = |(i, batch): (usize, &[Vec3])| {
            let used = used.and_then(|used| used.get(BATCH * i..));
            let drawn = |j: &usize| used.is_none_or(|used| used.get(*j).is_some_and(|&u| u));
            let points = (0..batch.len())
                .filter(drawn)
                .map(|j| place.transform_point3(batch[j].as_dvec3()))
                .filter(|p| p.is_finite());
            self.add(points, &around(batch, place));
        };
        // Some from everywhere first: of those that follow few reach beyond, though a file may run
        // from the bottom of a model to its top.
        let sampled = |(i, _): &(usize, &[Vec3])| i.is_multiple_of(SAMPLED);
        let batches = || positions.chunks(BATCH).enumerate();
        batches().filter(sampled).for_each(&mut add);
        batches().filter(|batch| !sampled(batch)).for_each(add);
    }

    fn add(&mut self, points: impl Iterator<Item = DVec3> + Clone, around: &Aabb) {
        for furthest in self.furthest.iter_mut().chain(self.extremes.as_flattened_mut()) {
            furthest.add(points.clone(), around);
        }
    }

    /// The outermost points along the directions; the origin where there are none.
    pub fn points(&self) -> [DVec3; N] {
        self.furthest.map(|f| f.point)
    }

    /// The box around all points.
    pub fn bounds(&self) -> Option<Aabb> {
        let [[right, left], [top, bottom], [front, back]] = self.extremes;
        let max = DVec3::new(right.point.x, top.point.y, front.point.z);
        let min = DVec3::new(left.point.x, bottom.point.y, back.point.z);
        (right.distance > f64::NEG_INFINITY).then_some(Aabb { min, max })
    }
}

/// A box in world space around placed positions; not finite where one of them is not.
fn around(positions: &[Vec3], place: &DMat4) -> Aabb {
    let [min, max] = extent(positions);
    let (min, max) = (min.as_dvec3(), max.as_dvec3());
    let (center, half) = ((min + max) * 0.5, (max - min) * 0.5);
    let linear = DMat3::from_mat4(*place);
    let sizes = DMat3::from_cols(linear.x_axis.abs(), linear.y_axis.abs(), linear.z_axis.abs());
    let world = place.transform_point3(center);
    let numbers = sizes * center.abs() + sizes * half + place.w_axis.truncate().abs();
    let reach = sizes * half + numbers * SLACK;
    Aabb { min: world - reach, max: world + reach }
}

/// The least and the largest coordinates of points; infinite, the wrong way round, where there are none.
fn extent(positions: &[Vec3]) -> [Vec3; 2] {
    // Four points are twelve numbers: three registers, whose lanes are put together in the end.
    let (mut least, mut most) = ([f32::INFINITY; 12], [f32::NEG_INFINITY; 12]);
    let (fours, rest) = positions.as_chunks::<4>();
    for four in fours {
        let numbers = four.map(|p| p.to_array());
        for (i, &v) in numbers.as_flattened().iter().enumerate() {
            // NaN is neither smaller nor larger, and such a point is left out in the end.
            least[i] = if v < least[i] { v } else { least[i] };
            most[i] = if v > most[i] { v } else { most[i] };
        }
    }
    let lanes = |all: &[f32; 12]| [0, 3, 6, 9].map(|i| Vec3::new(all[i], all[i + 1], all[i + 2]));
    let min = lanes(&least).iter().chain(rest).copied().fold(Vec3::INFINITY, |min, p| p.min(min));
    let max =
        lanes(&most).iter().chain(rest).copied().fold(Vec3::NEG_INFINITY, |max, p| p.max(max));
    [min, max]
}
