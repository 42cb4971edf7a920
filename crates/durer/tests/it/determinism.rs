//! Same input, same bytes: at every SIMD level and number of threads.

use crate::scenes;
use durer::pipeline::{RenderOptions, Report, Samples, Shading, render};
use durer::scene::Scene;
use durer::target::Framebuffer;

fn picture(scene: &Scene, options: &RenderOptions, threads: usize) -> (Framebuffer, Report) {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    pool.install(|| render(scene, options)).expect("picture")
}

#[test]
fn pictures_have_the_same_bytes_at_every_level_and_number_of_threads() {
    for (name, scene) in scenes::all() {
        for (samples, shading) in [
            (Samples::One, None),
            (Samples::Four, Some(Shading::MetallicRoughness)),
            (Samples::Four, Some(Shading::Gouraud)),
            (Samples::Sixteen, None),
        ] {
            let mut options = scenes::options(&scene, 150, 130);
            (options.samples, options.shading) = (samples, shading);
            (options.depth, options.item, options.normal) = (true, true, true);
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
