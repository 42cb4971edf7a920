//! Picking, compared with the item plane and with brute force.

use crate::scenes::Numbers;
use crate::surface_scenes::{Prepared, of_triangles, random, three_beams};
use durer::math::{DMat4, DVec2, DVec3, Rect};
use durer::scene::{Instance, Scene};
use durer::target::NO_ITEM;
use durer::trace::Recorder;
use durer::view::pick::{PickArea, objects, pick, pick_traced, replay};

fn center(x: u32, y: u32) -> DVec2 {
    DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5)
}

#[test]
fn the_first_triangle_under_a_pixel_is_the_visible_one() {
    let (mut pixels, mut differing) = (0, 0);
    for seed in 0..30 {
        let scene = random(seed);
        let p = Prepared::new(&scene, 40, 30);
        let framebuffer = p.by_z_buffer();
        let items = framebuffer.item.expect("items");
        for (x, y) in (0..30).flat_map(|y| (0..40).map(move |x| (x, y))) {
            let hits = pick(&scene, &p.view, PickArea::Point(center(x, y)));
            if x % 9 == 0 {
                let (at, mut steps) = (PickArea::Point(center(x, y)), Recorder::default());
                assert_eq!(pick_traced(&scene, &p.view, at, &mut steps), hits);
                assert_eq!(replay(steps.steps()), hits);
            }
            let first = hits.first().map_or(NO_ITEM, |h| h.item);
            pixels += 1;
            // The z-buffer snaps vertices to 1/256 pixel; picking does not.
            differing += usize::from(Some(first) != items.get(x, y));
            for hit in &hits {
                let s = p.view.screen_from_world() * hit.position.extend(1.0);
                assert!((DVec2::new(s.x, s.y) / s.w - center(x, y)).length() < 1e-6);
                assert!((s.z / s.w - hit.depth).abs() < 1e-9);
            }
            assert!(hits.is_sorted_by(|a, b| (a.depth, a.item) < (b.depth, b.item)));
        }
    }
    assert!(differing * 500 < pixels, "{differing} of {pixels}");
}

/// Returns whether any point of a fine grid in the rectangle is on the triangle.
fn some_point_hits(scene: &Scene, p: &Prepared<'_>, rect: &Rect, item: u32) -> bool {
    let steps = 40;
    (0..=steps).flat_map(|j| (0..=steps).map(move |i| (i, j))).any(|(i, j)| {
        let at =
            rect.min() + rect.size() * DVec2::new(f64::from(i), f64::from(j)) / f64::from(steps);
        pick(scene, &p.view, PickArea::Point(at)).iter().any(|h| h.item == item)
    })
}

#[test]
fn rectangles_hold_what_their_points_hold() {
    for seed in 0..12 {
        let scene = random(seed);
        let p = Prepared::new(&scene, 60, 60);
        let mut numbers = Numbers(seed + 99);
        let mut number = || f64::from(numbers.next());
        for _ in 0..6 {
            let min = DVec2::new(number() * 50.0, number() * 50.0);
            let max = min + DVec2::new(0.5 + number() * 20.0, 0.5 + number() * 20.0);
            let rect = Rect::new(min, max).expect("rectangle");
            let hits = pick(&scene, &p.view, PickArea::Rect(rect));
            for _ in 0..60 {
                let at = min + (max - min) * DVec2::new(number(), number());
                for under in pick(&scene, &p.view, PickArea::Point(at)) {
                    let hit = hits.iter().find(|h| h.item == under.item);
                    assert!(hit.is_some_and(|h| h.depth <= under.depth + 1e-9), "{seed} {at}");
                }
            }
            for hit in &hits {
                let s = p.view.screen_from_world() * hit.position.extend(1.0);
                let at = DVec2::new(s.x, s.y) / s.w;
                assert!((at - at.clamp(min, max)).length() < 1e-6, "{seed}: {at} outside");
            }
        }
    }
}

#[test]
fn small_and_empty_rectangles() {
    let scene = three_beams();
    let p = Prepared::new(&scene, 60, 60);
    let everything = Rect::new(DVec2::splat(-100.0), DVec2::splat(200.0)).expect("rectangle");
    assert_eq!(pick(&scene, &p.view, PickArea::Rect(everything)).len(), 6);
    let line = Rect::new(DVec2::ZERO, DVec2::new(60.0, 0.0)).expect("rectangle");
    assert!(pick(&scene, &p.view, PickArea::Rect(line)).is_empty());
    let one = pick(&scene, &p.view, PickArea::Rect(everything))[0];
    let s = p.view.screen_from_world() * one.position.extend(1.0);
    let at = DVec2::new(s.x, s.y) / s.w;
    let small = Rect::new(at - 0.5, at + 0.5).expect("rectangle");
    assert!(some_point_hits(&scene, &p, &small, one.item));
    assert!(pick(&scene, &p.view, PickArea::Point(DVec2::NAN)).is_empty());
}

#[test]
fn objects_come_nearest_first() {
    let mut scene = of_triangles(&[crate::surface_scenes::FACING]);
    let place = |z: f64| Instance {
        mesh: 0,
        world_from_mesh: DMat4::from_translation(DVec3::new(0.0, 0.0, z)),
        name: format!("{z}"),
    };
    scene.instances = vec![place(-2.0), place(0.5), place(-1.0), place(100.0)];
    let p = Prepared::new(&scene, 60, 60);
    let middle = Rect::new(DVec2::splat(0.0), DVec2::splat(60.0)).expect("rectangle");
    let hits = pick(&scene, &p.view, PickArea::Rect(middle));
    let found: Vec<_> = objects(&hits).iter().map(|o| (o.instance, o.primitives)).collect();
    assert_eq!(found, [(1, 1), (2, 1), (0, 1)]);
    assert_eq!(hits.iter().map(|h| h.item).collect::<Vec<_>>(), [1, 2, 0]);
}

#[test]
fn nothing_before_the_near_plane_or_beyond_the_far_plane_is_picked() {
    let mut scene = of_triangles(&[crate::surface_scenes::FACING]);
    let camera = Prepared::new(&scene, 60, 60).options.camera;
    let ahead = (camera.target - camera.eye).normalize();
    let at = |distance: f64| Instance {
        mesh: 0,
        world_from_mesh: DMat4::from_translation(camera.eye + ahead * distance),
        name: String::new(),
    };
    scene.instances = vec![at(0.5 * camera.near), at(2.0), at(19.0), at(25.0), at(-1.0)];
    let p = Prepared::new(&scene, 60, 60);
    let hits = pick(&scene, &p.view, PickArea::Point(DVec2::splat(30.0)));
    assert_eq!(hits.iter().map(|h| h.item).collect::<Vec<_>>(), [1, 2]);
}
