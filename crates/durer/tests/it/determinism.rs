//! Same input, same bytes: at every SIMD level and number of threads.

use crate::scenes;
use durer::pipeline::{
    Exposure, RenderOptions, Report, Samples, Shading, SurfaceMethod, Surroundings, ToneMap,
    render, render_into,
};
use durer::scene::Scene;
use durer::target::Framebuffer;
use durer::visibility::surface::ambient_occlusion;
use std::sync::Arc;

fn picture(scene: &Scene, options: &RenderOptions, threads: usize) -> (Framebuffer, Report) {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    pool.install(|| render(scene, options)).expect("picture")
}

#[test]
fn what_a_framebuffer_held_before_is_of_no_matter() {
    let (_, scene) = scenes::all().remove(0);
    let mut options = scenes::options(&scene, 131, 77);
    let mut kept = Framebuffer::new(131, 77).with_depth().with_stencil();
    for &algorithm in SurfaceMethod::ALL {
        for samples in [Samples::One, Samples::Four] {
            (options.algorithm, options.samples) = (algorithm, samples);
            options.normal = samples == Samples::One;
            for scene in [&scene, &Scene::default()] {
                kept.color.data_mut().fill([1, 2, 3, 4]);
                let report = render_into(scene, &options, &mut kept).expect("picture");
                let (expected, whole) = render(scene, &options).expect("picture");
                assert!(kept == expected, "{algorithm} {samples:?}");
                assert_eq!(report.drawn, whole.drawn);
            }
        }
    }
}

/// Returns a sphere with faces smaller than a pixel.
fn fine() -> Scene {
    let meshes = vec![scenes::sphere(200, None)];
    Scene { meshes, instances: vec![scenes::instance(0)], ..Scene::default() }
}

#[test]
fn looks_have_the_same_bytes_at_every_level_and_number_of_threads() {
    let scene = scenes::lobes();
    let panorama = Surroundings::Panorama(Arc::new(scenes::panorama()));
    for (algorithm, surroundings, tone_map) in [
        (SurfaceMethod::ZBuffer, Surroundings::Studio, ToneMap::Agx),
        (SurfaceMethod::ZBuffer, panorama.clone(), ToneMap::Aces),
        (SurfaceMethod::ABuffer, panorama, ToneMap::KhronosNeutral),
        (SurfaceMethod::Ray, Surroundings::Studio, ToneMap::None),
    ] {
        let mut options = scenes::options(&scene, 90, 70);
        (options.algorithm, options.surroundings) = (algorithm, surroundings);
        (options.tone_map, options.exposure) = (tone_map, Some(Exposure::Ev(0.5)));
        options.bounces = if algorithm == SurfaceMethod::Ray { 2 } else { 0 };
        let (expected, _) = picture(&scene, &options, 1);
        for level in durer::simd::levels() {
            for threads in [1, 2, 4] {
                options.level = level;
                let (found, _) = picture(&scene, &options, threads);
                assert!(found == expected, "{algorithm} {tone_map:?} {level:?} {threads} threads");
            }
        }
    }
}

#[test]
fn pictures_have_the_same_bytes_at_every_level_and_number_of_threads() {
    for (name, scene) in scenes::all().into_iter().chain([("fine", fine())]) {
        for (samples, shading) in [
            (Samples::One, None),
            (Samples::Four, Some(Shading::MetallicRoughness)),
            (Samples::Four, Some(Shading::Gouraud)),
            (Samples::Sixteen, None),
        ] {
            let mut options = scenes::options(&scene, 150, 130);
            (options.samples, options.shading) = (samples, shading);
            (options.depth, options.item, options.normal) = (true, true, true);
            if samples == Samples::Sixteen {
                let occlusion = ambient_occlusion::Options { radius: 0.5, strength: 0.9 };
                options.ambient_occlusion = Some(occlusion);
            }
            let (expected, _) = picture(&scene, &options, 1);
            for level in durer::simd::levels() {
                for threads in [1, 2, 4] {
                    options.level = level;
                    let (found, _) = picture(&scene, &options, threads);
                    assert!(found == expected, "{name} {samples:?} {level:?} {threads} threads");
                }
            }
        }
    }
}
