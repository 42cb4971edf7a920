//! Pictures and drawings as checksums, which have to be the same on every machine and at every SIMD level.

#[allow(dead_code)]
#[path = "../../../crates/durer/tests/it/scenes.rs"]
mod scenes;

use durer::math::{DAffine2, DVec2};
use durer::paper::{self, Options as Paper};
use durer::pipeline::{
    DrawOptions, RenderOptions, Samples, Shading, SurfaceMethod, Surroundings, ToneMap, ToneMarks,
    draw, render, tone_marks, with_marks,
};
use durer::raster::paint::{Canvas, Options as Painting};
use durer::scene::{Camera, Scene, UpAxis};
use durer::target::Pixels;
use durer::view::projection::{FitOptions, Lens, NamedView, fit_box};
use durer_formats::drawing::{DrawingFormat, FileOptions, write};
use durer_formats::geo::{GeoFormat, Reader, Writer};
use durer_formats::{NoResources, ReadOptions, read_model, svg};

const TEAPOT: &[u8] = include_bytes!("../../../samples/teapot.obj");
const BRACKET: &[u8] = include_bytes!("../../../samples/bracket.stl");
const CRATE: &[u8] = include_bytes!("../../../samples/crate.glb");
const GLASS: &[u8] = include_bytes!("../../../samples/glass.glb");
const PERSPECTIVE: &[u8] = include_bytes!("../../../samples/perspective.svg");
const COUNTRIES: &[u8] = include_bytes!("../../../samples/countries.geojson");

/// FNV-1a.
fn sum(bytes: impl IntoIterator<Item = u8>) -> u64 {
    bytes.into_iter().fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3)
    })
}

fn of_pixels(pixels: &Pixels<[u8; 4]>) -> u64 {
    sum(pixels.data().as_flattened().iter().copied())
}

fn picture(scene: &Scene, options: &RenderOptions) -> u64 {
    of_pixels(&render(scene, options).expect("a picture").0.color)
}

fn model(bytes: &[u8], name: &str) -> Scene {
    read_model(bytes, name, &NoResources, &ReadOptions::default()).expect("a sample").scene
}

fn camera(scene: &Scene) -> Camera {
    let options = FitOptions { lens: Lens::Perspective { fov_y: 0.6 }, aspect: 1.25, margin: 0.02 };
    let bounds = scene.bounds().expect("something");
    fit_box(Some(&bounds), &NamedView::Iso.direction(UpAxis::Y), &options).expect("a camera")
}

fn model_picture(bytes: &[u8], name: &str, samples: Samples) -> u64 {
    let scene = model(bytes, name);
    let mut options = RenderOptions::new(camera(&scene));
    (options.width, options.height, options.samples) = (200, 160, samples);
    (options.surroundings, options.tone_map) = (Surroundings::Studio, ToneMap::Agx);
    picture(&scene, &options)
}

fn drawing(bytes: &[u8], name: &str, format: DrawingFormat, marked: bool) -> u64 {
    let scene = model(bytes, name);
    let options = DrawOptions::new(camera(&scene));
    let mut drawing = draw(&scene, &options).expect("a drawing");
    if marked {
        let spacing = scene.bounding_sphere().expect("something").radius * 0.05;
        let marks = tone_marks(&scene, &options, ToneMarks::Contours { spacing });
        drawing = with_marks(drawing, marks.expect("marks"));
    }
    let mut laid =
        paper::lay_out(&drawing, name, &Paper { fit: 0.02, ..Paper::default() }).expect("a sheet");
    paper::order::sheet(&mut laid.sheet);
    let mut out = Vec::new();
    write(&mut out, format, &laid.sheet, &drawing, &FileOptions::default()).expect("memory");
    sum(out)
}

fn painted() -> u64 {
    let drawing = svg::Drawing::read(PERSPECTIVE, &svg::ReadOptions::default()).expect("a sample");
    let mut canvas = Canvas::new(240, 180, Painting::default()).expect("small");
    drawing.draw(&mut canvas, DAffine2::from_scale(DVec2::new(240.0, 180.0) / drawing.size()));
    let mut pixels = Pixels::new(240, 180, [255; 4]);
    canvas.render(&mut pixels).expect("the same size");
    of_pixels(&pixels)
}

fn map() -> u64 {
    let mut reader = Reader::new(GeoFormat::GeoJson, COUNTRIES).expect("a sample");
    let mut writer = Writer::new(GeoFormat::TopoJson, Vec::new());
    while let Some(feature) = reader.next_feature().expect("a sample") {
        writer.write(&feature).expect("memory");
    }
    sum(writer.finish(&[]).expect("memory"))
}

/// Returns the golden scenes of the library, each at four samples and by one of the methods.
fn scenes_by_methods() -> Vec<(String, u64)> {
    let methods = SurfaceMethod::ALL.iter().cycle();
    let scenes = scenes::all().into_iter().cycle().take(SurfaceMethod::ALL.len());
    let made = scenes.zip(methods).map(|((name, scene), &method)| {
        let mut options = scenes::options(&scene, 150, 130);
        (options.samples, options.algorithm) = (Samples::Four, method);
        options.shading = Some(Shading::MetallicRoughness);
        (format!("{name}, {method}"), picture(&scene, &options))
    });
    made.collect()
}

/// Returns the outputs by name, with their checksums.
pub fn all() -> Vec<(String, u64)> {
    let mut all = scenes_by_methods();
    let lobes = scenes::lobes();
    let mut options = scenes::options(&lobes, 120, 90);
    options.surroundings = Surroundings::Studio;
    all.push(("lobes in the studio".to_owned(), picture(&lobes, &options)));
    let samples = [
        ("teapot.obj", model_picture(TEAPOT, "teapot.obj", Samples::One)),
        ("crate.glb", model_picture(CRATE, "crate.glb", Samples::Four)),
        ("glass.glb", model_picture(GLASS, "glass.glb", Samples::Four)),
        ("teapot.obj as SVG", drawing(TEAPOT, "teapot.obj", DrawingFormat::Svg, false)),
        (
            "bracket.stl with marks as DXF",
            drawing(BRACKET, "bracket.stl", DrawingFormat::Dxf, true),
        ),
        ("crate.glb as PDF", drawing(CRATE, "crate.glb", DrawingFormat::Pdf, false)),
        ("perspective.svg", painted()),
        ("countries.geojson as TopoJSON", map()),
    ];
    all.extend(samples.map(|(name, sum)| (name.to_owned(), sum)));
    all
}
