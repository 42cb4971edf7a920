//! Cameras that see the whole model.

use durer::math::DVec3;
use durer::scene::{Camera, Mesh, Projection, Scene, UpAxis};
use durer::view::projection::{NamedView, ViewDirection};

/// The part of the picture's width and height that the model may fill.
const FILL: f64 = 0.94;

/// A perspective near plane is at least this part of the far plane, for depth to keep its precision.
const NEAREST: f64 = 1e-4;

/// The eye keeps this part of the model's depth from it: a needle that points at the eye is not looked
/// at from within.
const CLOSEST: f64 = 0.02;

/// What is up for a line of sight; the back's direction where that looks along the up axis.
pub fn up_for(sight: DVec3, up_axis: UpAxis) -> DVec3 {
    let front = NamedView::Front.direction(up_axis);
    let sideways = sight.normalize_or_zero().cross(front.up()).length();
    if sideways < 1e-6 { -front.to_eye() } else { front.up() }
}

/// What a fitted camera has to see, and from where.
#[derive(Debug, Clone, Copy)]
pub struct Fit {
    /// From where.
    pub direction: ViewDirection,
    /// The axis around which the model turns while it must stay in the picture: world space, unit
    /// length, in one plane with the line of sight and the picture's up.
    pub around: Option<DVec3>,
    /// Width / height of the picture.
    pub aspect: f64,
}

/// How far the model reaches, seen from its middle. For side slopes s (half of the view's width over
/// the distance) the reach to the right is the largest x + s·z: the distance and the shift of the eye
/// follow from the reaches to both sides. Parallel views have s = 0.
#[derive(Debug, Clone, Copy)]
struct Reach {
    right: f64,
    left: f64,
    up: f64,
    down: f64,
    front: f64,
    back: f64,
}

impl Fit {
    /// The nearest perspective camera from which the whole model is seen.
    pub fn perspective(&self, scene: &Scene, fov_y: f64) -> Camera {
        let slope_y = libm::tan(fov_y * 0.5) * FILL;
        let slope_x = slope_y * self.aspect;
        let (center, reach) = self.reach(scene, slope_x, slope_y);
        let across = (reach.right + reach.left) / (2.0 * slope_x);
        let upright = (reach.up + reach.down) / (2.0 * slope_y);
        let closest = reach.front + (reach.front + reach.back) * CLOSEST;
        let distance = across.max(upright).max(closest);
        let camera = self.place(center, &reach, distance, Projection::Perspective { fov_y });
        let (near, far) = perspective_range(distance - reach.front, distance + reach.back);
        Camera { near, far, ..camera }
    }

    /// A parallel view from outside of the model; without a height, one that shows all of it.
    pub fn orthographic(&self, scene: &Scene, height: Option<f64>) -> Camera {
        let (center, reach) = self.reach(scene, 0.0, 0.0);
        let needed = (reach.up + reach.down).max((reach.right + reach.left) / self.aspect) / FILL;
        let depth = reach.front + reach.back;
        // A line seen end-on has no extent in the picture, but a neighbourhood.
        let height = height.unwrap_or(needed.max(depth * 1e-3));
        let distance = reach.front + depth * 0.5 + height * 0.5;
        let camera = self.place(center, &reach, distance, Projection::Orthographic { height });
        let (near, far) = (distance - reach.front, distance + reach.back);
        let margin = (far - near) * 0.01;
        Camera { near: near - margin, far: far + margin, ..camera }
    }

    fn place(&self, center: DVec3, reach: &Reach, distance: f64, projection: Projection) -> Camera {
        let [right, up, back] = self.axes();
        let target = center
            + right * ((reach.right - reach.left) * 0.5)
            + up * ((reach.up - reach.down) * 0.5);
        let eye = target + back * distance;
        Camera { eye, target, up, projection, near: 1.0, far: 2.0 }
    }

    /// The middle of the model and how far it reaches from there; something to look at for a model
    /// without extent.
    fn reach(&self, scene: &Scene, slope_x: f64, slope_y: f64) -> (DVec3, Reach) {
        let found = center(scene);
        let center = found.unwrap_or(DVec3::ZERO);
        let nothing = f64::NEG_INFINITY;
        let mut reach = Reach {
            right: nothing,
            left: nothing,
            up: nothing,
            down: nothing,
            front: nothing,
            back: nothing,
        };
        for_each_point(scene, |p| {
            let point = match self.around {
                Some(axis) => self.swept(p - center, axis, slope_x, slope_y),
                None => self.seen(p - center, slope_x, slope_y),
            };
            reach.join(&point);
        });
        let extent =
            (reach.right + reach.left).max(reach.up + reach.down).max(reach.front + reach.back);
        // A point, or nothing at all: a unit around it, or more where coordinates are coarse.
        let least = center.length().max(1.0) * if found.is_some() { 1e-6 } else { 1.0 };
        if extent <= least * 1e-6 {
            reach = Reach {
                right: least,
                left: least,
                up: least,
                down: least,
                front: least,
                back: least,
            };
        }
        (center, reach)
    }

    /// Right, up and backward of the camera, unit vectors.
    fn axes(&self) -> [DVec3; 3] {
        [self.direction.right(), self.direction.up(), self.direction.to_eye()]
    }

    /// The reach of one point.
    fn seen(&self, p: DVec3, slope_x: f64, slope_y: f64) -> Reach {
        let [x, y, z] = self.axes().map(|axis| axis.dot(p));
        Reach {
            right: x + slope_x * z,
            left: slope_x * z - x,
            up: y + slope_y * z,
            down: slope_y * z - y,
            front: z,
            back: -z,
        }
    }

    /// The reach of the circle that a point runs through on a turntable.
    fn swept(&self, p: DVec3, axis: DVec3, slope_x: f64, slope_y: f64) -> Reach {
        // Sine and cosine of the eye's elevation.
        let (sin, cos) = (axis.dot(self.direction.to_eye()), axis.dot(self.direction.up()));
        let height = axis.dot(p);
        let radius = (p - axis * height).length();
        let aside = height * sin * slope_x + radius * (1.0 + (cos * slope_x).powi(2)).sqrt();
        let (lift, depth) = (height * cos, height * sin);
        Reach {
            right: aside,
            left: aside,
            up: lift + depth * slope_y + radius * (cos * slope_y - sin).abs(),
            down: depth * slope_y - lift + radius * (cos * slope_y + sin).abs(),
            front: depth + radius * cos.abs(),
            back: radius * cos.abs() - depth,
        }
    }
}

impl Reach {
    fn join(&mut self, other: &Self) {
        self.right = self.right.max(other.right);
        self.left = self.left.max(other.left);
        self.up = self.up.max(other.up);
        self.down = self.down.max(other.down);
        self.front = self.front.max(other.front);
        self.back = self.back.max(other.back);
    }
}

/// All finite vertices that something is drawn with, in world space.
fn for_each_point(scene: &Scene, mut f: impl FnMut(DVec3)) {
    let used: Vec<Option<Vec<bool>>> = scene.meshes.iter().map(used_vertices).collect();
    for instance in &scene.instances {
        let Some(mesh) = scene.meshes.get(instance.mesh) else { continue };
        let used = used[instance.mesh].as_deref();
        for (i, p) in mesh.positions.iter().enumerate() {
            let p = instance.world_from_mesh.transform_point3(p.as_dvec3());
            if p.is_finite() && used.is_none_or(|used| used[i]) {
                f(p);
            }
        }
    }
}

/// Which vertices have an index; `None` = all.
fn used_vertices(mesh: &Mesh) -> Option<Vec<bool>> {
    let mut used = vec![false; mesh.positions.len()];
    for &i in mesh.indices.as_ref()? {
        if let Some(used) = used.get_mut(i as usize) {
            *used = true;
        }
    }
    Some(used)
}

/// The middle of the box around what is drawn; `None` where that is nothing.
pub fn center(scene: &Scene) -> Option<DVec3> {
    let (mut min, mut max) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for_each_point(scene, |p| {
        min = min.min(p);
        max = max.max(p);
    });
    (min.x <= max.x).then(|| min + (max - min) * 0.5)
}

/// Near and far planes around what a camera in a given place can see of the model.
pub fn depth_range(camera: &Camera, scene: &Scene) -> (f64, f64) {
    let back = (camera.eye - camera.target).normalize_or_zero();
    let (mut nearest, mut farthest) = (f64::INFINITY, f64::NEG_INFINITY);
    for_each_point(scene, |p| {
        let depth = (camera.eye - p).dot(back);
        nearest = nearest.min(depth);
        farthest = farthest.max(depth);
    });
    if nearest > farthest {
        return (0.1, 100.0);
    }
    match camera.projection {
        Projection::Perspective { .. } => perspective_range(nearest, farthest),
        Projection::Orthographic { height } => {
            let margin = (farthest - nearest).max(height * 1e-3) * 0.01;
            (nearest - margin, farthest + margin)
        }
    }
}

/// Planes with some room before and behind, the near one not too near.
fn perspective_range(nearest: f64, farthest: f64) -> (f64, f64) {
    let room = (farthest - nearest).max(farthest.abs() * 1e-3) * 0.01;
    let far = farthest + room;
    if far > 0.0 { ((nearest - room).max(far * NEAREST), far) } else { (0.1, 100.0) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use durer::math::{DMat4, Vec3};
    use durer::scene::Instance;

    /// Points of a skew, flat, off-centre box.
    fn scene(scale: f32, offset: f32) -> Scene {
        let positions = (0..60)
            .map(|i| {
                let t = i as f32;
                Vec3::new((t * 0.37) % 3.0, (t * 0.73) % 1.0, (t * 0.11) % 0.4) * scale + offset
            })
            .collect();
        let instance = Instance { mesh: 0, world_from_mesh: DMat4::IDENTITY, name: String::new() };
        let mesh = Mesh { positions, ..Mesh::default() };
        Scene { meshes: vec![mesh], instances: vec![instance], ..Scene::default() }
    }

    /// The smallest and largest clip coordinate over w, over all points and both axes; all inside.
    fn seen_by(camera: &Camera, scene: &Scene, aspect: f64) -> f64 {
        camera.check().unwrap();
        let clip = camera.clip_from_view(aspect) * camera.view_from_world();
        let mut largest: f64 = 0.0;
        for_each_point(scene, |p| {
            let c = clip * p.extend(1.0);
            assert!(c.w > 0.0 && c.z.abs() <= c.w, "{p}: {c}");
            largest = largest.max((c.x / c.w).abs()).max((c.y / c.w).abs());
        });
        largest
    }

    fn fit(azimuth: f64, elevation: f64, turning: bool, aspect: f64) -> Fit {
        let direction = ViewDirection::from_angles(azimuth, elevation, UpAxis::Z).unwrap();
        Fit { direction, around: turning.then_some(DVec3::Z), aspect }
    }

    #[test]
    fn a_fitted_model_fills_the_picture_and_no_more() {
        for (scale, offset) in [(1.0, 0.0), (1e-6, 0.0), (1e6, -5e6), (1e20, 0.0)] {
            let scene = scene(scale, offset);
            for (azimuth, elevation) in [(0.0, 0.0), (45.0, 35.0), (-200.0, -70.0), (10.0, 90.0)] {
                for aspect in [1.0, 0.3, 2.5] {
                    let fit = fit(azimuth, elevation, false, aspect);
                    let camera = fit.perspective(&scene, 0.6);
                    let share = seen_by(&camera, &scene, aspect);
                    assert!((share - FILL).abs() < 1e-6, "{share} at {azimuth}, {elevation}");
                    let camera = fit.orthographic(&scene, None);
                    let share = seen_by(&camera, &scene, aspect);
                    assert!((share - FILL).abs() < 1e-6, "{share} at {azimuth}, {elevation}");
                }
            }
        }
    }

    #[test]
    fn a_turning_model_stays_in_the_picture_at_one_distance() {
        let scene = scene(1.0, 3.0);
        for elevation in [0.0, 30.0, -60.0, 90.0] {
            let mut largest: f64 = 0.0;
            let mut distances = Vec::new();
            for degrees in 0..360 {
                let fit = fit(f64::from(degrees), elevation, true, 1.5);
                let camera = fit.perspective(&scene, 0.6);
                distances.push((camera.eye - camera.target).length());
                largest = largest.max(seen_by(&camera, &scene, 1.5));
                seen_by(&fit.orthographic(&scene, None), &scene, 1.5);
            }
            assert!(largest <= FILL + 1e-9 && largest > FILL - 0.02, "{largest} at {elevation}");
            assert!(distances.iter().all(|d| (d - distances[0]).abs() < 1e-9));
        }
    }

    #[test]
    fn vertices_that_nothing_uses_do_not_count() {
        let mut scene = scene(1.0, 0.0);
        let expected = fit(45.0, 35.0, false, 1.0).perspective(&scene, 0.6);
        scene.meshes[0].indices = Some((0..60).collect());
        scene.meshes[0].positions.push(Vec3::splat(1e9));
        scene.meshes[0].positions.push(Vec3::NAN);
        assert_eq!(fit(45.0, 35.0, false, 1.0).perspective(&scene, 0.6), expected);
    }

    #[test]
    fn models_without_extent_have_a_camera_too() {
        let point = Scene {
            meshes: vec![Mesh { positions: vec![Vec3::splat(7.0)], ..Mesh::default() }],
            ..scene(1.0, 0.0)
        };
        let line = Scene {
            meshes: vec![Mesh { positions: vec![Vec3::ZERO, Vec3::Y], ..Mesh::default() }],
            ..scene(1.0, 0.0)
        };
        for scene in [Scene::default(), point, line] {
            // From the front, the line is seen end-on.
            for (azimuth, elevation) in [(45.0, 35.0), (0.0, 0.0)] {
                let fit = fit(azimuth, elevation, false, 1.0);
                seen_by(&fit.perspective(&scene, 0.6), &scene, 1.0);
                seen_by(&fit.orthographic(&scene, None), &scene, 1.0);
            }
        }
    }
}
