//! Cameras for turntables, and a scene as seen by a camera: its aspect ratio, middle and depths.

use super::projection::{
    FitOptions, NamedView, ViewDirection, drawn_bounds, drawn_ends, fit_points,
};
use crate::Result;
use crate::math::{DVec2, DVec3};
use crate::scene::{Camera, Mesh, Projection, Scene, UpAxis};
use std::f64::consts::TAU;

/// A perspective near plane is at least this part of the far plane, for depth to keep its precision.
const NEAREST: f64 = 1e-4;

/// Number of discs, one above another, that approximate a turning model.
const SLABS: usize = 512;

/// Points on the rim of each disc; at 64 the rim is at most 0.12 % outside of them.
const AROUND: usize = 64;

/// Returns the up direction for a line of sight, world space; if the line runs along the up axis, the back view's.
pub fn up_for(sight: DVec3, up_axis: UpAxis) -> DVec3 {
    let front = NamedView::Front.direction(up_axis);
    let sideways = sight.normalize_or_zero().cross(front.up()).length();
    if sideways < 1e-6 { -front.to_eye() } else { front.up() }
}

/// Returns the camera that sees the model as large as possible while it turns around the up axis: at the same
/// distance and height for all azimuths.
///
/// # Errors
/// As [`fit_points`].
pub fn fit_turning(
    scene: &Scene,
    direction: &ViewDirection,
    options: &FitOptions,
) -> Result<Camera> {
    fit_points(rims(scene, direction.to_eye(), direction.up()), direction, options)
}

/// Returns points of the discs that approximate a turning model, seen from a direction with another one up.
fn rims(scene: &Scene, to_eye: DVec3, up: DVec3) -> Vec<DVec3> {
    let axis = NamedView::Front.direction(scene.up_axis).up();
    // Level directions, to the viewer and to the right: rims begin there, so that they look the same
    // from all azimuths.
    let outward = to_eye * axis.dot(up) - up * axis.dot(to_eye);
    let side = up.cross(to_eye);
    let center = center(scene).unwrap_or(DVec3::ZERO);
    let mut points = Vec::new();
    for (radius, height) in circles(scene, center, axis) {
        for (sin, cos) in (0..AROUND).map(|i| libm::sincos(TAU * i as f64 / AROUND as f64)) {
            points.push(center + axis * height + (outward * cos + side * sin) * radius);
        }
    }
    points
}

/// Returns the ratio of width to height of the model as a camera sees it, or of all frames of a turntable; NaN if
/// nothing is seen.
pub fn aspect(camera: &Camera, scene: &Scene, turning: bool) -> f64 {
    let back = (camera.eye - camera.target).normalize_or_zero();
    let up = camera.up.reject_from(back).normalize_or_zero();
    let right = up.cross(back);
    let (mut least, mut most) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    let mut see = |p: DVec3| {
        let p = p - camera.eye;
        let distance = match camera.projection {
            Projection::Perspective { .. } => -p.dot(back),
            Projection::Orthographic { .. } => 1.0,
        };
        if distance > 0.0 {
            let seen = DVec2::new(p.dot(right), p.dot(up)) / distance;
            (least, most) = (least.min(seen), most.max(seen));
        }
    };
    if turning {
        rims(scene, back, up).into_iter().for_each(see);
    } else {
        for_each_point(scene, &mut see);
    }
    let extent = most - least;
    extent.x / extent.y
}

/// Returns radii and heights of circles around an axis; the model, turned around it, stays within
/// their hull.
fn circles(scene: &Scene, center: DVec3, axis: DVec3) -> Vec<(f64, f64)> {
    let place = |p: DVec3| {
        let height = axis.dot(p - center);
        ((p - center - axis * height).length(), height)
    };
    let (mut lowest, mut highest) = (f64::INFINITY, f64::NEG_INFINITY);
    for_each_point(scene, |p| {
        let (_, height) = place(p);
        lowest = lowest.min(height);
        highest = highest.max(height);
    });
    let slabs = SLABS as f64 / (highest - lowest);
    // Radius, lowest and highest point of each slab.
    let mut discs: Vec<Option<(f64, f64, f64)>> = vec![None; SLABS];
    for_each_point(scene, |p| {
        let (radius, height) = place(p);
        // If all heights are equal, the product is NaN and the cast gives slab 0.
        let slab = &mut discs[(((height - lowest) * slabs) as usize).min(SLABS - 1)];
        let (r, low, high) = slab.unwrap_or((radius, height, height));
        *slab = Some((r.max(radius), low.min(height), high.max(height)));
    });
    discs.into_iter().flatten().flat_map(|(r, low, high)| [(r, low), (r, high)]).collect()
}

/// Returns all finite vertices used by primitives, in world space.
fn points(scene: &Scene) -> impl Iterator<Item = DVec3> + '_ {
    let used: Vec<Option<Vec<bool>>> = scene.meshes.iter().map(Mesh::used_vertices).collect();
    scene.instances.iter().flat_map(move |instance| {
        let positions = scene.meshes.get(instance.mesh).map_or(&[][..], |m| &m.positions);
        let used = used.get(instance.mesh).cloned().flatten();
        let place = instance.world_from_mesh;
        let drawn = move |i: usize| used.as_ref().is_none_or(|used| used[i]);
        positions
            .iter()
            .enumerate()
            .filter(move |(i, _)| drawn(*i))
            .map(move |(_, p)| place.transform_point3(p.as_dvec3()))
            .filter(|p| p.is_finite())
    })
}

fn for_each_point(scene: &Scene, f: impl FnMut(DVec3)) {
    points(scene).for_each(f);
}

/// Returns the middle of the box around everything drawn, world space; `None` if there is nothing.
pub fn center(scene: &Scene) -> Option<DVec3> {
    drawn_bounds(scene).map(|bounds| bounds.center())
}

/// Returns the distances of near and far planes around the part of the model that a camera at this position can
/// see, world units.
pub fn depth_range(camera: &Camera, scene: &Scene) -> (f64, f64) {
    depth_range_of(camera, drawn_ends(scene, back(camera)))
}

/// Returns the unit vector from a camera's target to its eye.
pub fn back(camera: &Camera) -> DVec3 {
    (camera.eye - camera.target).normalize_or_zero()
}

/// Returns the result of [`depth_range`] for the points furthest along [`back`] and against it.
pub fn depth_range_of(camera: &Camera, ends: Option<[DVec3; 2]>) -> (f64, f64) {
    let back = back(camera);
    let Some(ends) = ends else { return (0.1, 100.0) };
    let [nearest, farthest] = ends.map(|p| (camera.eye - p).dot(back));
    match camera.projection {
        Projection::Perspective { .. } => perspective_range(nearest, farthest),
        Projection::Orthographic { height } => {
            let margin = (farthest - nearest).max(height * 1e-3) * 0.01;
            (nearest - margin, farthest + margin)
        }
    }
}

/// Returns the near and far planes with some room before and behind, the near one not too near.
fn perspective_range(nearest: f64, farthest: f64) -> (f64, f64) {
    let room = (farthest - nearest).max(farthest.abs() * 1e-3) * 0.01;
    let far = farthest + room;
    if far > 0.0 { ((nearest - room).max(far * NEAREST), far) } else { (0.1, 100.0) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{DMat4, Vec3};
    use crate::scene::Instance;
    use crate::view::projection::{Lens, fit_scene};

    /// Returns points of a skew, flat, off-centre box.
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

    /// Returns the smallest and the largest clip coordinate over w, over all points and both axes; all points are
    /// inside.
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

    fn direction(azimuth: f64, elevation: f64) -> ViewDirection {
        ViewDirection::from_angles(azimuth, elevation, UpAxis::Y).unwrap()
    }

    fn options(lens: Lens, aspect: f64) -> FitOptions {
        FitOptions { lens, aspect, margin: 0.03 }
    }

    const LENSES: [Lens; 2] = [Lens::Perspective { fov_y: 0.6 }, Lens::Orthographic];

    #[test]
    fn a_fitted_model_fills_the_picture_and_no_more() {
        for (scale, offset) in [(1.0, 0.0), (1e-6, 0.0), (1e6, -5e6), (1e20, 0.0)] {
            let scene = scene(scale, offset);
            for (azimuth, elevation) in [(0.0, 0.0), (45.0, 35.0), (-200.0, -70.0), (10.0, 90.0)] {
                for (lens, aspect) in [(LENSES[0], 0.3), (LENSES[0], 2.5), (LENSES[1], 1.0)] {
                    let from = direction(azimuth, elevation);
                    let camera = fit_scene(&scene, &from, &options(lens, aspect)).unwrap();
                    let share = seen_by(&camera, &scene, aspect);
                    assert!((share - 0.94).abs() < 1e-6, "{share} at {azimuth}, {elevation}");
                }
            }
        }
    }

    #[test]
    fn a_turning_model_stays_in_the_picture_at_one_distance() {
        let scene = scene(1.0, 3.0);
        for (lens, elevation) in
            LENSES.into_iter().flat_map(|l| [0.0, 30.0, -60.0, 90.0].map(|e| (l, e)))
        {
            let mut largest: f64 = 0.0;
            let mut distances = Vec::new();
            for degrees in 0..360 {
                let from = direction(f64::from(degrees), elevation);
                let camera = fit_turning(&scene, &from, &options(lens, 1.5)).unwrap();
                // The scale of the picture; the eye of a parallel view may be anywhere.
                distances.push(match camera.projection {
                    Projection::Perspective { .. } => {
                        (camera.eye - center(&scene).unwrap()).length()
                    }
                    Projection::Orthographic { height } => height,
                });
                largest = largest.max(seen_by(&camera, &scene, 1.5));
            }
            assert!((0.92..0.942).contains(&largest), "{largest} at {elevation}");
            assert!(distances.iter().all(|d| (d - distances[0]).abs() < 1e-9 * d));
        }
    }

    #[test]
    fn vertices_that_nothing_uses_do_not_count() {
        let mut scene = scene(1.0, 0.0);
        let camera =
            |scene: &Scene| fit_scene(scene, &direction(45.0, 35.0), &options(LENSES[0], 1.0));
        let expected = camera(&scene);
        scene.meshes[0].indices = Some((0..60).collect());
        scene.meshes[0].positions.push(Vec3::splat(1e9));
        scene.meshes[0].positions.push(Vec3::NAN);
        assert_eq!(camera(&scene), expected);
    }

    #[test]
    fn models_without_extent_have_a_camera_too() {
        let of = |positions| {
            let meshes = vec![Mesh { positions, ..Mesh::default() }];
            Scene { meshes, ..scene(1.0, 0.0) }
        };
        let (point, line) = (of(vec![Vec3::splat(7.0)]), of(vec![Vec3::ZERO, Vec3::Z]));
        for scene in [Scene::default(), point, line] {
            // From the front, the line is seen end-on.
            for (azimuth, elevation) in [(45.0, 35.0), (0.0, 0.0)] {
                for lens in LENSES {
                    let (from, options) = (direction(azimuth, elevation), options(lens, 1.0));
                    seen_by(&fit_scene(&scene, &from, &options).unwrap(), &scene, 1.0);
                    seen_by(&fit_turning(&scene, &from, &options).unwrap(), &scene, 1.0);
                }
            }
        }
    }
}
