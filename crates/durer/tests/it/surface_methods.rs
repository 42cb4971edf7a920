//! All methods by their one door: the same items, depths and normals.

use crate::surface_scenes::{Prepared, assert_same_planes, crossing_quads, random, three_beams};
use durer::scene::Scene;
use durer::target::Framebuffer;
use durer::trace::{NoTrace, Recorder};
use durer::visibility::surface::method::{Options, SurfaceMethod, render_with};

fn scenes() -> Vec<Scene> {
    let random = (400..420).map(random);
    [three_beams(), crossing_quads(), crate::scenes::materials()]
        .into_iter()
        .chain(random)
        .collect()
}

fn picture(p: &Prepared<'_>, method: SurfaceMethod, options: &Options) -> Framebuffer {
    let mut framebuffer = p.framebuffer();
    render_with(method, &p.input(), &p.lights, options, &mut framebuffer, &mut NoTrace)
        .expect("picture");
    framebuffer
}

#[test]
fn all_methods_give_the_same_planes_at_every_level_traced_or_not() {
    for scene in scenes() {
        let p = Prepared::new(&scene, 97, 83);
        let expected = p.by_z_buffer();
        for &method in SurfaceMethod::ALL {
            let found = picture(&p, method, &Options::default());
            assert_same_planes(method.name(), &found, &expected);
            for level in durer::simd::levels() {
                let options = Options { level, ..Options::default() };
                assert!(picture(&p, method, &options) == found, "{method} {level:?}");
            }
            let mut traced = p.framebuffer();
            let mut recorder = Recorder::default();
            let (input, options) = (p.input(), Options::default());
            render_with(method, &input, &p.lights, &options, &mut traced, &mut recorder)
                .expect("picture");
            assert!(traced == found, "{method} traced");
            assert!(method == SurfaceMethod::ZBuffer || !recorder.steps().is_empty(), "{method}");
        }
    }
}
