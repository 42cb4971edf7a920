//! Golden pictures: a picture stays the same to the byte.
//!
//! Generated scenes are kept as PNG files in `tests/golden/`, real models as checksums, because their pictures do not
//! belong to this repository. `DURER_BLESS=1` rewrites both; a picture that differs is written beside its golden one
//! into `target/golden/`, with the difference as third panel. Generated scenes are compared at every SIMD level.

use crate::{data, scenes};
use durer::math::{DVec3, Vec3};
use durer::pipeline::{Cull, RenderOptions, Samples, Shading, Surroundings, ToneMap, render};
use durer::scene::{Aabb, Camera, Light, LightKind, Scene, UpAxis};
use durer::target::Pixels;
use durer::view::projection::{FitOptions, Lens, NamedView};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

fn golden_folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden")
}

fn bless() -> bool {
    std::env::var_os("DURER_BLESS").is_some()
}

fn write_png(path: &Path, picture: &Pixels<[u8; 4]>) {
    fs::create_dir_all(path.parent().expect("folder")).expect("folder");
    let file = std::io::BufWriter::new(fs::File::create(path).expect("golden file"));
    let mut encoder = png::Encoder::new(file, picture.width(), picture.height());
    encoder.set_color(png::ColorType::Rgba);
    let mut writer = encoder.write_header().expect("PNG header");
    writer.write_image_data(picture.data().as_flattened()).expect("PNG data");
}

fn read_png(path: &Path) -> Option<Pixels<[u8; 4]>> {
    let mut reader =
        png::Decoder::new(std::io::BufReader::new(fs::File::open(path).ok()?)).read_info().ok()?;
    let mut bytes = vec![0; reader.output_buffer_size()?];
    let info = reader.next_frame(&mut bytes).ok()?;
    let data = bytes.as_chunks::<4>().0.to_vec();
    Pixels::from_data(info.width, info.height, data).ok()
}

/// Returns the picture, the golden one and their difference side by side.
fn three_panels(found: &Pixels<[u8; 4]>, golden: &Pixels<[u8; 4]>) -> Pixels<[u8; 4]> {
    let (w, h) = (found.width(), found.height());
    let mut panels = Pixels::new(3 * w, h, [255; 4]);
    panels.paste(found, 0, 0);
    panels.paste(golden, w, 0);
    for (x, y) in (0..h).flat_map(|y| (0..w).map(move |x| (x, y))) {
        if found.get(x, y) != golden.get(x, y) {
            panels.set(2 * w + x, y, [255, 0, 0, 255]);
        }
    }
    panels
}

fn check(name: &str, found: &Pixels<[u8; 4]>) {
    let path = golden_folder().join(format!("{name}.png"));
    if bless() {
        return write_png(&path, found);
    }
    let golden = read_png(&path).unwrap_or_else(|| panic!("{} cannot be read", path.display()));
    if *found != golden {
        let beside = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("golden/{name}.png"));
        write_png(&beside, &three_panels(found, &golden));
        panic!("{name} differs from its golden picture: see {}", beside.display());
    }
}

/// Checks the picture at every SIMD level.
fn check_render(name: &str, scene: &Scene, options: &RenderOptions) {
    for level in durer::simd::levels() {
        let options = RenderOptions { level, ..options.clone() };
        check(name, &render(scene, &options).expect("picture").0.color);
    }
}

#[test]
fn scenes_made_by_code() {
    for (name, scene) in scenes::all() {
        let mut options = scenes::options(&scene, 160, 140);
        check_render(name, &scene, &options);
        for &shading in Shading::ALL {
            options.shading = Some(shading);
            check_render(&format!("{name}_{shading}"), &scene, &options);
        }
    }
}

#[test]
fn looks_made_by_code() {
    let scene = scenes::lobes();
    let panorama = Surroundings::Panorama(Arc::new(scenes::panorama()));
    let lamp = LightKind::Point { position: DVec3::new(2.0, 3.0, 4.0), range: None };
    let mut lit = scene.clone();
    lit.lights.push(Light { kind: lamp, color: Vec3::new(5e4, 4e4, 3e4) });
    let maps = [ToneMap::KhronosNeutral, ToneMap::Aces, ToneMap::Agx];
    let (studio, none) = (Surroundings::Studio, Surroundings::None);
    let looks = [
        ("studio", &scene, studio.clone(), ToneMap::None),
        ("no_studio", &scene, none, ToneMap::None),
        ("panorama", &scene, panorama, ToneMap::None),
        ("lamp", &lit, studio.clone(), ToneMap::None),
    ];
    let mapped = maps.map(|map| (map.name(), &scene, studio.clone(), map));
    for (name, scene, surroundings, tone_map) in looks.into_iter().chain(mapped) {
        let mut options = scenes::options(scene, 120, 90);
        (options.surroundings, options.tone_map) = (surroundings, tone_map);
        check_render(&format!("look_{name}"), scene, &options);
    }
}

/// Returns the whole scene from the front or from the corner.
fn camera(scene: &Scene, view: NamedView) -> Camera {
    let bounds: Aabb = scene.bounds().expect("something to see");
    let lens = Lens::Perspective { fov_y: 35f64.to_radians() };
    let options = FitOptions { lens, aspect: 1.0, margin: 0.02 };
    durer::view::projection::fit_box(Some(&bounds), &view.direction(UpAxis::Y), &options)
        .expect("camera")
}

fn checksum(picture: &Pixels<[u8; 4]>) -> u64 {
    // FNV-1a: short, and the same on every machine.
    picture.data().as_flattened().iter().fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3)
    })
}

/// Cards and models that each show one feature, with the time of their pose.
const CARDS: [(&str, NamedView, Option<f64>); 12] = [
    ("AlphaBlendModeTest.glb", NamedView::Front, None),
    ("VertexColorTest/VertexColorTest.gltf", NamedView::Front, None),
    ("TextureSettingsTest/TextureSettingsTest.gltf", NamedView::Front, None),
    ("MultiUVTest/MultiUVTest.gltf", NamedView::Iso, None),
    ("UnlitTest/UnlitTest.gltf", NamedView::Front, None),
    ("MorphStressTest.glb", NamedView::Iso, Some(1.2)),
    ("CesiumMan.glb", NamedView::Iso, Some(0.5)),
    ("Fox/Fox.gltf", NamedView::Iso, Some(0.3)),
    ("Duck_meshopt.glb", NamedView::Iso, None),
    ("Box_Draco.glb", NamedView::Iso, None),
    ("CornellBox.glb", NamedView::Front, None),
    ("Cameras/Cameras.gltf", NamedView::Front, None),
];

#[test]
fn real_cards_keep_their_pictures() {
    let Some(folder) = data::folder() else { return };
    let file = golden_folder().join("cards.txt");
    let text = fs::read_to_string(&file).unwrap_or_default();
    let golden: BTreeMap<&str, &str> = text.lines().filter_map(|l| l.split_once(' ')).collect();
    let mut found = String::new();
    for (name, view, time) in CARDS {
        let scene = data::read_posed(&folder.join("gltf").join(name), time).scene;
        let mut options = RenderOptions::new(match scene.cameras.first() {
            Some(own) if name.starts_with("Cameras") => own.camera,
            _ => camera(&scene, view),
        });
        (options.width, options.height) = (256, 256);
        (options.samples, options.cull) = (Samples::Four, Cull::Material);
        let picture = render(&scene, &options).expect("picture").0.color;
        let sum = format!("{:016x}", checksum(&picture));
        found += &format!("{name} {sum}\n");
        if !bless() && golden.get(name) != Some(&sum.as_str()) {
            let path = Path::new(env!("CARGO_TARGET_TMPDIR"))
                .join("golden")
                .join(name.replace('/', "_") + ".png");
            write_png(&path, &picture);
            panic!("{name} is not what it was: see {}", path.display());
        }
    }
    if bless() {
        fs::write(file, found).expect("golden checksums");
    }
}
