//! Frame-to-frame coherence in turntables: how much of the order of depth sort and of the spans remains in the next
//! frame, and how much starting with the previous frame's order saves.

use crate::scenes::{instance, options, sphere};
use durer::math::{DMat4, DVec3};
use durer::pipeline::Cull;
use durer::raster::Span;
use durer::scene::Scene;
use durer::shade::PreparedLights;
use durer::target::{Framebuffer, NO_ITEM};
use durer::trace::{NoTrace, Recorder};
use durer::view::View;
use durer::visibility::surface::SurfaceInput;
use durer::visibility::surface::TriangleFilter;
use durer::visibility::surface::depth_sort::{ScreenPolygon, Step, order, order_after};
use durer::visibility::surface::spanning_scan_line as spanning;

const SIDE: u32 = 64;

/// Returns the view after turning by some degrees.
fn turned(scene: &Scene, degrees: f64) -> View {
    let mut camera = options(scene, SIDE, SIDE).camera;
    camera.eye =
        DMat4::from_rotation_y(degrees.to_radians()).transform_point3(DVec3::new(0.0, 1.0, 4.0));
    View::new(camera, SIDE, SIDE).expect("view")
}

fn input<'a>(scene: &'a Scene, view: &'a View) -> SurfaceInput<'a> {
    let filter = TriangleFilter::new(Cull::None, 128);
    SurfaceInput::new(scene, view, filter).expect("input")
}

/// Returns the ranks of items in the order after turning by some degrees.
fn places(scene: &Scene, degrees: f64) -> Vec<usize> {
    let view = turned(scene, degrees);
    let input = input(scene, &view);
    let mut places = vec![usize::MAX; scene.triangle_count() as usize];
    for (place, polygon) in order(&input, &mut NoTrace).unwrap().iter().enumerate() {
        places[polygon.item as usize] = place;
    }
    places
}

/// Returns the share of neighbours in one order that have the same relative order in another.
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

/// Returns the items in the order in which they are painted.
fn painted(input: &SurfaceInput<'_>, polygons: &[ScreenPolygon]) -> Vec<u32> {
    let mut items = vec![NO_ITEM; (SIDE * SIDE) as usize];
    for polygon in polygons {
        polygon.spans(input, |Span { y, x0, x1 }| {
            (x0..x1).for_each(|x| items[(y * SIDE as i32 + x) as usize] = polygon.item);
        });
    }
    items
}

/// Polygons compared, tests and moves needed for an order.
fn work(steps: &Recorder<Step>) -> [usize; 3] {
    let count = |is: fn(&Step) -> bool| steps.steps().iter().filter(|s| is(s)).count();
    [
        count(|s| matches!(s, Step::Look { .. })),
        count(|s| matches!(s, Step::Tested { .. })),
        count(|s| matches!(s, Step::Move { .. })),
    ]
}

#[test]
fn the_order_of_the_frame_before_saves_moves() {
    let place = |x: f64, size: f64| {
        let mut instance = instance(0);
        instance.world_from_mesh = DMat4::from_translation(DVec3::new(x, 0.1 * x, -0.3 * x))
            * DMat4::from_scale(DVec3::splat(size));
        instance
    };
    let instances = vec![place(0.0, 0.9), place(0.5, 0.8), place(-1.3, 0.5)];
    let scene = Scene { meshes: vec![sphere(10, None)], instances, ..Scene::default() };
    for degrees in [1.0, 5.0] {
        let mut previous: Vec<u32> = Vec::new();
        let mut sums = [[0; 3]; 2];
        for frame in 0..6 {
            let view = turned(&scene, degrees * f64::from(frame));
            let input = input(&scene, &view);
            let (mut fresh, mut reused) = (Recorder::default(), Recorder::default());
            let expected = painted(&input, &order(&input, &mut fresh).unwrap());
            let polygons = order_after(&input, &previous, &mut reused).unwrap();
            assert_eq!(painted(&input, &polygons), expected, "{degrees} {frame}");
            previous = polygons.iter().map(|p| p.item).collect();
            if frame > 0 {
                for (sum, steps) in sums.iter_mut().zip([&fresh, &reused]) {
                    let work = work(steps);
                    (0..3).for_each(|k| sum[k] += work[k]);
                }
            }
        }
        println!(
            "{degrees} degrees a frame: looks, tests, moves of five frames, anew and reused: {sums:?}"
        );
        // The depth order is nearly right already, so little can be saved: some moves, between frames a small step
        // apart. After larger steps the old order is no better than the depth order.
        let saved = sums[1][2] < sums[0][2] && sums[1][1] * 100 < sums[0][1] * 105;
        assert!(degrees > 1.0 || saved, "{degrees}: {sums:?}");
    }
}

/// Checks that any list will do: the order of an unrelated frame, or nonsense.
#[test]
fn orders_that_are_wrong_are_put_right() {
    for seed in 0..60 {
        let scene = crate::surface_scenes::random(seed);
        let view = turned(&scene, 10.0);
        let input = input(&scene, &view);
        let expected = painted(&input, &order(&input, &mut NoTrace).unwrap());
        let count = scene.triangle_count() as u32;
        let turned_over: Vec<u32> = (0..count).collect();
        let scattered: Vec<u32> = (0..2 * count).map(|i| i * 7 % (count + 3)).collect();
        for previous in [turned_over, scattered] {
            let found = painted(&input, &order_after(&input, &previous, &mut NoTrace).unwrap());
            assert_eq!(found, expected, "seed {seed}");
        }
    }
}

/// Returns the item that a span shows at each pixel; `None` for pixels compared one by one.
fn spans(scene: &Scene, degrees: f64) -> Vec<u32> {
    let view = turned(scene, degrees);
    let lights = PreparedLights::of(scene, view.camera());
    let (mut recorder, mut picture) = (Recorder::default(), Framebuffer::new(SIDE, SIDE));
    let options = spanning::Options::default();
    spanning::render(&input(scene, &view), &lights, &options, &mut picture, &mut recorder);
    let (mut row, mut items) = (0, vec![NO_ITEM; (SIDE * SIDE) as usize]);
    for step in recorder.steps() {
        match *step {
            spanning::Step::Row { y } => row = y,
            spanning::Step::Span { item, x0, x1, .. } => {
                (x0..x1).for_each(|x| items[(row * SIDE as i32 + x) as usize] = item);
            }
            _ => {}
        }
    }
    items
}

#[test]
fn spans_stay_where_little_moves() {
    let scene =
        Scene { meshes: vec![sphere(6, None)], instances: vec![instance(0)], ..Scene::default() };
    let first = spans(&scene, 20.0);
    let covered = first.iter().filter(|i| **i != NO_ITEM).count();
    let after = [1.0, 5.0, 20.0].map(|turn| {
        let same = first.iter().zip(spans(&scene, 20.0 + turn)).filter(|(a, b)| **a == *b);
        same.filter(|(a, _)| **a != NO_ITEM).count() as f64 / covered as f64
    });
    println!("pixels of spans that show the same face after 1, 5, 20 degrees: {after:.3?}");
    assert!(after.is_sorted_by(|a, b| a > b) && after[0] > 0.5, "{after:?}");
}
