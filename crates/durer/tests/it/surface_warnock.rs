//! Area subdivision against the z-buffer.

use crate::surface_scenes::{
    Prepared, assert_same_planes, covered, crossing_quads, depth_at, each, random,
};
use durer::raster::Span;
use durer::target::{Framebuffer, NO_ITEM};
use durer::trace::{NoTrace, Recorder};
use durer::view::window::PixelRect;
use durer::visibility::surface::SampleRect;
use durer::visibility::surface::warnock::{Division, Options, Step, render};

fn picture(p: &Prepared<'_>, options: &Options) -> Framebuffer {
    let mut framebuffer = p.framebuffer();
    render(&p.input(), &p.lights, options, &mut framebuffer, &mut NoTrace);
    framebuffer
}

#[test]
fn warnock_agrees_with_the_z_buffer() {
    each(320, |name, p| {
        let expected = p.by_z_buffer();
        for division in [Division::Regular, Division::Vertices] {
            let found = picture(p, &Options { division, ..Options::default() });
            assert_same_planes(&format!("{name} {division:?}"), &found, &expected);
            assert!(found.color == expected.color, "{name} {division:?}: colour");
        }
    });
}

fn samples(w: SampleRect) -> impl Iterator<Item = (i32, i32)> {
    (w.y0..w.y1).flat_map(move |y| (w.x0..w.x1).map(move |x| (x, y)))
}

#[test]
fn warnock_can_be_replayed() {
    for seed in 0..40 {
        let scene = random(seed);
        let p = Prepared::new(&scene, 70, 50);
        let input = p.input();
        let mut recorder = Recorder::default();
        let mut traced = p.framebuffer();
        render(&input, &p.lights, &Options::default(), &mut traced, &mut recorder);
        assert!(traced == picture(&p, &Options::default()), "tracing changes the picture");
        let mut items = vec![NO_ITEM; 70 * 50];
        let mut put = |x: i32, y: i32, triangle: u32| {
            let t = &input.triangles[triangle as usize];
            if depth_at(t, x, y) < 1.0 {
                items[y as usize * 70 + x as usize] = t.item;
            }
        };
        for step in recorder.steps() {
            match *step {
                Step::Surrounded { window, triangle } => {
                    samples(window).for_each(|(x, y)| put(x, y, triangle));
                }
                Step::Single { window, triangle } => {
                    let SampleRect { x0, y0, x1, y1 } = window;
                    let clip = PixelRect::new(x0, y0, x1, y1).expect("window");
                    for Span { y, x0, x1 } in covered(&input.triangles[triangle as usize], clip) {
                        (x0..x1).for_each(|x| put(x, y, triangle));
                    }
                }
                Step::Sample { x, y, triangle: Some(triangle) } => put(x, y, triangle),
                _ => {}
            }
        }
        assert_eq!(items, traced.item.expect("items").data());
    }
}

#[test]
fn all_samples_are_decided_once() {
    let scene = random(7);
    let p = Prepared::new(&scene, 90, 61);
    let mut recorder = Recorder::default();
    render(&p.input(), &p.lights, &Options::default(), &mut p.framebuffer(), &mut recorder);
    let mut decided = vec![0; 90 * 61];
    for step in recorder.steps() {
        match *step {
            Step::Empty { window }
            | Step::Single { window, .. }
            | Step::Surrounded { window, .. } => {
                samples(window).for_each(|(x, y)| decided[(y * 90 + x) as usize] += 1);
            }
            Step::Sample { x, y, .. } => decided[(y * 90 + x) as usize] += 1,
            _ => {}
        }
    }
    assert!(decided.iter().all(|&n| n == 1));
}

#[test]
fn sub_pixel_levels_come_near_to_the_area() {
    let scene = crossing_quads();
    let p = Prepared::new(&scene, 40, 40);
    let color = |sub_levels| {
        let mut framebuffer = p.framebuffer();
        let options = Options { sub_levels, ..Options::default() };
        render(&p.fine_input(), &p.lights, &options, &mut framebuffer, &mut NoTrace);
        framebuffer.color.into_data()
    };
    let best = color(4);
    let error = |found: &[[u8; 4]]| -> u32 {
        let pairs = found.as_flattened().iter().zip(best.as_flattened());
        pairs.map(|(a, b)| u32::from(a.abs_diff(*b))).sum()
    };
    let errors = [0, 1, 2, 3].map(|level| error(&color(level)));
    assert!(errors.is_sorted_by(|a, b| a > b), "{errors:?}");
}
