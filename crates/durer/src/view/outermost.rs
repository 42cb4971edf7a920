//! The outermost points of a set along some directions, as needed to fit a frame.
//!
//! Points come in batches; a batch whose box is within the known extents costs one test per direction, and so does a
//! group of such batches. Cost: O(points), a few operations each.

use crate::math::{DMat3, DMat4, DVec3, Vec3};
use crate::scene::{Aabb, Scene};

/// Points that are examined together: neighbours in the file mostly are neighbours in space.
const BATCH: usize = 64;

/// Batches of a mesh that are examined together. The first of them is examined before all others.
const GROUP: usize = 16;

/// Vertices of a group: pieces of meshes end where groups do.
pub const PIECE: usize = BATCH * GROUP;

/// Growth of a box of transformed points, relative to its numbers, so that rounding does not leave
/// a point outside: far above the 2⁻⁵³ that each of a few operations may be off.
const SLACK: f64 = 1e-14;

/// The outermost points along directions that are given, and along the axes.
#[derive(Clone)]
pub(super) struct Outermost<const N: usize> {
    furthest: [Furthest; N],
    /// Along x, y and z, and against them.
    extremes: [[Furthest; 2]; 3],
}

/// The furthest point along a direction.
#[derive(Clone, Copy)]
struct Furthest {
    direction: DVec3,
    /// Positive and negative parts of the direction.
    above_below: [DVec3; 2],
    distance: f64,
    point: DVec3,
}

impl Furthest {
    fn along(direction: DVec3) -> Self {
        let above_below = [direction.max(DVec3::ZERO), direction.min(DVec3::ZERO)];
        Self { direction, above_below, distance: f64::NEG_INFINITY, point: DVec3::ZERO }
    }

    /// Returns whether a point in a box may be further out; true if the box is not finite.
    fn may_be_in(&self, around: &Aabb) -> bool {
        let [above, below] = self.above_below;
        // One half of each sum is zero. The other is at least as large as the corresponding product of any point in the
        // box, also when rounded; and the sums are formed as for points.
        let most = above * around.max + below * around.min;
        let inside = most.x + most.y + most.z <= self.distance;
        !inside
    }

    fn add(&mut self, points: &[DVec3]) {
        for &point in points {
            let distance = self.direction.dot(point);
            if distance > self.distance {
                (self.distance, self.point) = (distance, point);
            }
        }
    }
}

impl<const N: usize> Outermost<N> {
    /// Creates a search along these directions, with no points so far.
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
            self.all().filter(|f| f.may_be_in(&around)).for_each(|f| f.add(points));
        }
    }

    fn all(&mut self) -> impl Iterator<Item = &mut Furthest> {
        self.furthest.iter_mut().chain(self.extremes.as_flattened_mut())
    }

    /// Adds all finite vertices of a scene that primitives use.
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
        // A sample from everywhere first: then few of the following points are further out, even if a file runs from
        // the bottom of a model to its top.
        self.add_firsts(positions, used, place);
        self.add_others(positions, used, place);
    }

    /// Adds the first batch of each group.
    fn add_firsts(&mut self, positions: &[Vec3], used: Option<&[bool]>, place: &DMat4) {
        let mut placed = Placed { used, place, points: Vec::with_capacity(BATCH) };
        for (i, batch) in positions.chunks(BATCH).enumerate().step_by(GROUP) {
            placed.add_to(self, i, batch, &around(extent(batch), place));
        }
    }

    /// Adds the other batches.
    fn add_others(&mut self, positions: &[Vec3], used: Option<&[bool]>, place: &DMat4) {
        let mut placed = Placed { used, place, points: Vec::with_capacity(BATCH) };
        for (group, positions) in positions.chunks(BATCH * GROUP).enumerate() {
            let others = || positions.chunks(BATCH).enumerate().skip(1);
            let mut extents = [NOTHING; GROUP];
            others().for_each(|(i, batch)| extents[i] = extent(batch));
            let whole = extents.into_iter().fold(NOTHING, |[a, b], [c, d]| [a.min(c), b.max(d)]);
            let whole = around(whole, place);
            if self.all().any(|f| f.may_be_in(&whole)) {
                for (i, batch) in others() {
                    placed.add_to(self, group * GROUP + i, batch, &around(extents[i], place));
                }
            }
        }
    }

    /// Returns the outermost points along the directions; the origin if there are none.
    pub fn points(&self) -> [DVec3; N] {
        self.furthest.map(|f| f.point)
    }

    /// Returns the box around all points.
    pub fn bounds(&self) -> Option<Aabb> {
        let [[right, left], [top, bottom], [front, back]] = self.extremes;
        let max = DVec3::new(right.point.x, top.point.y, front.point.z);
        let min = DVec3::new(left.point.x, bottom.point.y, back.point.z);
        (right.distance > f64::NEG_INFINITY).then_some(Aabb { min, max })
    }
}

/// The points of a batch of a mesh in the world.
struct Placed<'a> {
    used: Option<&'a [bool]>,
    place: &'a DMat4,
    points: Vec<DVec3>,
}

impl Placed<'_> {
    /// Adds the points of the mesh's batch `i` that are drawn.
    fn add_to<const N: usize>(
        &mut self,
        all: &mut Outermost<N>,
        i: usize,
        batch: &[Vec3],
        around: &Aabb,
    ) {
        let Self { used, place, points } = self;
        let used = used.and_then(|used| used.get(BATCH * i..));
        let drawn = |j: &usize| used.is_none_or(|used| used.get(*j).is_some_and(|&u| u));
        points.clear();
        for furthest in all.all().filter(|f| f.may_be_in(around)) {
            // Once for all directions, and only where one asks.
            if points.is_empty() {
                let of_batch = (0..batch.len()).filter(drawn);
                let placed = of_batch.map(|j| place.transform_point3(batch[j].as_dvec3()));
                points.extend(placed.filter(|p| p.is_finite()));
            }
            furthest.add(points);
        }
    }
}

/// The outermost points of a mesh that comes in pieces: among equally far points, the same ones as for the whole mesh.
pub(super) struct OutermostOfPieces<const N: usize> {
    /// Bounds of the first batches of groups, and of the others, which are examined after all of
    /// those.
    found: [Outermost<N>; 2],
}

impl<const N: usize> OutermostOfPieces<N> {
    /// Creates a search along these directions, with no points so far.
    pub fn new(directions: [DVec3; N]) -> Self {
        Self { found: [Outermost::new(directions), Outermost::new(directions)] }
    }

    /// Adds the vertices of the next piece, a scene of one instance; all pieces but the last must have a multiple of
    /// [`PIECE`] vertices.
    pub fn add_piece(&mut self, piece: &Scene) {
        for instance in &piece.instances {
            let Some(mesh) = piece.meshes.get(instance.mesh) else { continue };
            let used = mesh.used_vertices();
            let [firsts, others] = &mut self.found;
            firsts.add_firsts(&mesh.positions, used.as_deref(), &instance.world_from_mesh);
            others.add_others(&mesh.positions, used.as_deref(), &instance.world_from_mesh);
        }
    }

    /// Returns the outermost points of all pieces.
    pub fn whole(&self) -> Outermost<N> {
        let [mut whole, others] = self.found.clone();
        let others = others.furthest.iter().chain(others.extremes.as_flattened());
        for (furthest, other) in whole.all().zip(others) {
            if other.distance > furthest.distance {
                *furthest = *other;
            }
        }
        whole
    }
}

/// Returns a box in world space around placed positions of an extent; not finite where one of them
/// is not.
fn around([min, max]: [Vec3; 2], place: &DMat4) -> Aabb {
    let (min, max) = (min.as_dvec3(), max.as_dvec3());
    let (center, half) = ((min + max) * 0.5, (max - min) * 0.5);
    let linear = DMat3::from_mat4(*place);
    let sizes = DMat3::from_cols(linear.x_axis.abs(), linear.y_axis.abs(), linear.z_axis.abs());
    let world = place.transform_point3(center);
    let numbers = sizes * center.abs() + sizes * half + place.w_axis.truncate().abs();
    let reach = sizes * half + numbers * SLACK;
    Aabb { min: world - reach, max: world + reach }
}

/// The extent of no points.
const NOTHING: [Vec3; 2] = [Vec3::INFINITY, Vec3::NEG_INFINITY];

/// Returns the smallest and the largest coordinates of points, ignoring NaN; [`NOTHING`] if there are none.
fn extent(positions: &[Vec3]) -> [Vec3; 2] {
    // Four points are twelve numbers: three registers, whose lanes are combined in the end.
    let (mut least, mut most) = ([f32::INFINITY; 12], [f32::NEG_INFINITY; 12]);
    // NaN is neither smaller nor larger; such points are left out in the end.
    let lesser = |least: f32, v: f32| if v < least { v } else { least };
    let larger = |most: f32, v: f32| if v > most { v } else { most };
    let (fours, rest) = positions.as_chunks::<4>();
    for four in fours {
        let numbers = four.map(|p| p.to_array());
        for (i, &v) in numbers.as_flattened().iter().enumerate() {
            (least[i], most[i]) = (lesser(least[i], v), larger(most[i], v));
        }
    }
    for (i, v) in rest.iter().flat_map(|p| p.to_array().into_iter().enumerate()) {
        (least[i], most[i]) = (lesser(least[i], v), larger(most[i], v));
    }
    let lanes = |all: &[f32; 12]| [0, 3, 6, 9].map(|i| Vec3::new(all[i], all[i + 1], all[i + 2]));
    let ([a, b, c, d], [e, f, g, h]) = (lanes(&least), lanes(&most));
    [a.min(b).min(c.min(d)), e.max(f).max(g.max(h))]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns points in order from one end of a skew body to the other; some are not finite.
    fn points(count: usize) -> Vec<Vec3> {
        let point = |i: usize| {
            let (t, turn) = (i as f32 / count as f32, i as f32 * 0.37);
            let p = Vec3::new(turn.sin() * t, t * 3.0 - 1.0, turn.cos() * (1.0 - t));
            match i % 97 {
                13 => p.with_x(f32::NAN),
                14 => p.with_y(f32::INFINITY),
                15 => Vec3::NAN,
                _ => p,
            }
        };
        (0..count).map(point).collect()
    }

    #[test]
    fn a_mesh_has_the_outermost_of_its_points() {
        let place = DMat4::from_cols(
            [1.0, 0.2, 0.0, 0.0].into(),
            [0.3, -2.0, 0.1, 0.0].into(),
            [0.0, 0.4, 1.5, 0.0].into(),
            [10.0, 20.0, -5.0, 1.0].into(),
        );
        // Wherever the one distant vertex is, to either side.
        for (count, far) in [
            (0, 0),
            (1, 0),
            (3, 1),
            (63, 62),
            (64, 0),
            (65, 64),
            (67, 64),
            (1023, 1022),
            (1025, 1024),
            (1094, 1093),
            (5003, 0),
            (5003, 70),
            (5003, 1981),
            (5003, 2047),
            (5003, 5002),
        ] {
            for side in DVec3::AXES.into_iter().flat_map(|axis| [axis, -axis]) {
                let mut positions = points(count);
                if let Some(vertex) = positions.get_mut(far) {
                    *vertex = (side * 100.0).as_vec3();
                }
                check(&positions, &place);
            }
        }
    }

    /// Compares with examining all points one by one.
    fn check(positions: &[Vec3], place: &DMat4) {
        let directions = [DVec3::ONE, -DVec3::ONE, DVec3::new(0.3, -1.0, 0.2), DVec3::X, -DVec3::Z];
        let used: Vec<bool> = (0..positions.len()).map(|i| i % 5 != 3).collect();
        for used in [None, Some(&used[..])] {
            let mut found = Outermost::new(directions);
            found.add_mesh(positions, used, place);
            let drawn = |i: &usize| used.is_none_or(|used| used[*i]);
            let placed = (0..positions.len())
                .filter(drawn)
                .map(|i| place.transform_point3(positions[i].as_dvec3()))
                .filter(|p| p.is_finite());
            assert_eq!(found.bounds(), Aabb::around(placed.clone()), "{}", positions.len());
            for (direction, point) in directions.into_iter().zip(found.points()) {
                let most = placed.clone().map(|p| direction.dot(p)).reduce(f64::max);
                assert_eq!(direction.dot(point), most.unwrap_or(0.0), "{}", positions.len());
            }
        }
    }
}
