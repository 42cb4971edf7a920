//! Windows of pictures: rendered one by one and joined, they are the whole picture, byte for byte.

use crate::scenes;
use durer::Error;
use durer::math::Vec4;
use durer::pipeline::{
    Background, RenderOptions, Samples, Shadows, Status, SurfaceMethod, render, render_seen,
    status, survey,
};
use durer::scene::Scene;
use durer::target::{Framebuffer, Pixels};
use durer::view::window::PixelRect;
use durer::visibility::surface::ambient_occlusion;
use durer::work::Work;

const SIZE: [u32; 2] = [134, 70];

/// Borders of windows, most of which differ from those of a method's tiles.
const COLUMNS: [i32; 4] = [0, 37, 128, 134];
const ROWS: [i32; 3] = [0, 63, 70];

fn options(scene: &Scene) -> RenderOptions {
    let options = scenes::options(scene, SIZE[0], SIZE[1]);
    let background = Background::Gradient(Vec4::new(0.1, 0.3, 0.9, 1.0), Vec4::ONE);
    RenderOptions { background, depth: true, item: true, normal: true, ..options }
}

fn windows() -> Vec<PixelRect> {
    let pairs = |of: &'static [i32]| of.windows(2).map(|pair| [pair[0], pair[1]]);
    let all = pairs(&ROWS).flat_map(|y| pairs(&COLUMNS).map(move |x| (x, y)));
    all.map(|([x0, x1], [y0, y1])| PixelRect::spanning(x0, y0, x1, y1)).collect()
}

fn paste<T: Copy>(whole: &mut Option<Pixels<T>>, part: &Option<Pixels<T>>, [x, y]: [u32; 2]) {
    whole.as_mut().unwrap().paste(part.as_ref().unwrap(), x, y);
}

/// Joins the pictures of all windows, the last first.
fn joined(mut picture: impl FnMut(PixelRect) -> Framebuffer) -> Framebuffer {
    let mut whole = Framebuffer::new(SIZE[0], SIZE[1]).with_depth().with_items().with_normals();
    for window in windows().into_iter().rev() {
        let part = picture(window);
        assert_eq!((part.width(), part.height()), (window.width(), window.height()));
        let at = [window.x0(), window.y0()].map(i32::unsigned_abs);
        whole.color.paste(&part.color, at[0], at[1]);
        paste(&mut whole.depth, &part.depth, at);
        paste(&mut whole.item, &part.item, at);
        paste(&mut whole.normal, &part.normal, at);
    }
    whole
}

fn rendered(scene: &Scene, options: &RenderOptions, window: PixelRect) -> Framebuffer {
    let options = RenderOptions { window: Some(window), ..options.clone() };
    render(scene, &options).expect("window").0
}

#[test]
fn windows_of_every_method_are_the_whole() {
    let has_windows = |m: &&SurfaceMethod| **m != SurfaceMethod::DepthSort;
    for (name, scene) in scenes::all() {
        for &algorithm in SurfaceMethod::ALL.iter().filter(has_windows) {
            let options = RenderOptions { algorithm, ..options(&scene) };
            let (whole, _) = render(&scene, &options).expect("picture");
            let found = joined(|window| rendered(&scene, &options, window));
            assert!(found == whole, "{name} {algorithm}");
        }
    }
}

#[test]
fn windows_of_small_triangles_and_many_samples_are_the_whole() {
    let meshes = vec![scenes::sphere(50, None)];
    let fine = Scene { meshes, instances: vec![scenes::instance(0)], ..Scene::default() };
    for (samples, planes) in
        [(Samples::One, true), (Samples::Four, false), (Samples::Sixteen, true)]
    {
        let mut options = RenderOptions { samples, shadows: Shadows::Map, ..options(&fine) };
        options.shadow_map_side = 64;
        (options.depth, options.item, options.normal) = (planes, planes, planes);
        let (whole, _) = render(&fine, &options).expect("picture");
        for window in windows() {
            let part = rendered(&fine, &options, window);
            for (y, row) in (0..part.height()).map(|y| (y, part.color.row(y))) {
                let (x0, y0) = (window.x0().unsigned_abs() as usize, window.y0().unsigned_abs());
                let expected = &whole.color.row(y0 + y)[x0..x0 + row.len()];
                assert_eq!(row, expected, "{samples:?} {window:?} row {y}");
            }
        }
    }
}

#[test]
fn windows_of_scenes_in_pieces_are_the_whole() {
    let scene = scenes::soup(400, 1);
    let options = options(&scene);
    let (whole, _) = render(&scene, &options).expect("picture");
    let found = joined(|window| {
        let options = RenderOptions { window: Some(window), ..options.clone() };
        let mut survey = survey(&options).expect("survey");
        survey.add(&scene).expect("piece");
        let seen = survey.finish().expect("seen");
        let mesh = &scene.meshes[0];
        let corners = seen.items.iter().flat_map(|&i| 3 * i as usize..3 * i as usize + 3);
        let mut only = scene.clone();
        only.meshes[0].positions = corners.filter_map(|c| mesh.positions.get(c).copied()).collect();
        render_seen(&only, 400, &seen, &options).expect("picture").0
    });
    assert!(found == whole);
}

#[test]
fn memory_follows_the_window() {
    let scene = scenes::soup(400, 1);
    let work = Work::with_budget(4 << 20, "the budget");
    let window = Some(PixelRect::spanning(49_000, 50_000, 49_100, 50_100));
    for &algorithm in SurfaceMethod::ALL.iter().filter(|m| **m != SurfaceMethod::DepthSort) {
        let large = scenes::options(&scene, 100_000, 100_000);
        let large = RenderOptions { algorithm, work: work.clone(), window, ..large };
        let (part, report) = render(&scene, &large).expect("a window of 10 gigapixels");
        assert_eq!((part.width(), part.height()), (100, 100));
        assert!(report.drawn < report.triangles_in / 4, "{algorithm}: {report:?}");
        assert_eq!(status(&scene, &large, &part), Ok(Status::Ok));
    }
}

#[test]
fn windows_lie_in_the_picture_and_go_with_most_methods() {
    let scene = scenes::soup(4, 1);
    let all = options(&scene);
    for (x0, y0, x1, y1) in [(0, 0, 151, 1), (-1, 0, 1, 1), (0, 130, 1, 131), (5, 5, 5, 6)] {
        let window = Some(PixelRect::spanning(x0, y0, x1, y1));
        let error = render(&scene, &RenderOptions { window, ..all.clone() }).unwrap_err();
        assert!(matches!(error, Error::Parameter { name: "window", .. }), "{error}");
    }
    let window = Some(PixelRect::spanning(0, 0, 9, 9));
    let dark = ambient_occlusion::Options { radius: 0.5, strength: 0.9 };
    for options in [
        RenderOptions { algorithm: SurfaceMethod::DepthSort, ..all.clone() },
        RenderOptions { ambient_occlusion: Some(dark), ..all.clone() },
    ] {
        let error = render(&scene, &RenderOptions { window, ..options }).unwrap_err();
        assert!(matches!(error, Error::Unsupported { .. }), "{error}");
    }
}
