//! Frame-to-frame coherence: what of depth sort's order stays in the next frame of a turntable.

use crate::scenes::{instance, options, sphere};
use durer::math::{DMat4, DVec3};
use durer::pipeline::Cull;
use durer::scene::Scene;
use durer::trace::NoTrace;
use durer::view::View;
use durer::visibility::surface::depth_sort::order;
use durer::visibility::surface::input::SurfaceInput;
use durer::visibility::surface::setup::Filter;

/// The places of items in the order, seen after turning by some degrees.
fn places(scene: &Scene, degrees: f64) -> Vec<usize> {
    let mut camera = options(scene, 64, 64).camera;
    camera.eye =
        DMat4::from_rotation_y(degrees.to_radians()).transform_point3(DVec3::new(0.0, 1.0, 4.0));
    let view = View::new(camera, 64, 64).expect("view");
    let filter = Filter { cull: Cull::None, sample_reach: 128 };
    let input = SurfaceInput::new(scene, &view, filter).expect("input");
    let mut places = vec![usize::MAX; scene.triangle_count() as usize];
    for (place, polygon) in order(&input, &mut NoTrace).iter().enumerate() {
        places[polygon.item as usize] = place;
    }
    places
}

/// The share of neighbours in one order that stand the same way round in another.
fn kept(a: &[usize], b: &[usize]) -> f64 {
    let mut items: Vec<usize> = (0..a.len()).filter(|&i| a[i].max(b[i]) != usize::MAX).collect();
    items.sort_by_key(|&i| a[i]);
    let same = items.windows(2).filter(|two| b[two[0]] < b[two[1]]).count();
    same as f64 / (items.len() - 1) as f64
}

#[test]
fn the_order_hardly_changes_from_frame_to_frame() {
    let scene =
        Scene { meshes: vec![sphere(12, None)], instances: vec![instance(0)], ..Scene::default() };
    let first = places(&scene, 20.0);
    let after = [1.0, 5.0, 90.0].map(|turn| kept(&first, &places(&scene, 20.0 + turn)));
    println!("neighbours of depth sort that keep their order after 1, 5, 90 degrees: {after:.3?}");
    assert!(after[0] > after[2] && after[0] > 0.7, "{after:?}");
}
