//! Fills, anti-aliased and aliased: durer, vello_cpu, tiny-skia.

use crate::medians;
use crate::scenes::{self, Scene};
use cpu_time::ProcessTime;
use durer::raster::coverage::{FillRule, Overlap};
use durer::raster::paint::{Canvas, Options, Paint};
use durer::target::Pixels;
use std::time::Instant;

fn all() -> Vec<Box<dyn Fn() -> Scene>> {
    let data = std::env::var("DURER_DATA").unwrap_or("../../../../shared/data".into());
    let file = format!("{data}/svg/openclipart/van_gogh_s_room_enrique__01.svg");
    let other = file.clone();
    vec![
        Box::new(scenes::small_polygons),
        Box::new(scenes::mesh),
        Box::new(move || scenes::art(&file, 1024)),
        Box::new(move || scenes::art(&other, 4096)),
        Box::new(|| scenes::heavy("coast", false)),
        Box::new(|| scenes::heavy("walk", false)),
        Box::new(|| scenes::heavy("walk", true)),
        Box::new(|| scenes::heavy("spikes", false)),
        Box::new(|| scenes::heavy("spikes", true)),
    ]
}

/// Returns a canvas, kept from picture to picture as vello_cpu's context is.
fn canvas(scene: &Scene, overlap: Overlap, anti_alias: bool) -> Canvas {
    let options = Options { overlap, anti_alias, ..Options::default() };
    Canvas::new(scene.size, scene.size, options).unwrap()
}

fn durer(scene: &Scene, canvas: &mut Canvas, target: &mut Pixels<[u8; 4]>) {
    canvas.clear([255; 4]);
    for s in &scene.shapes {
        let rule = if s.even_odd { FillRule::EvenOdd } else { FillRule::NonZero };
        canvas.fill_contours(&s.contours, rule, &Paint::Color(s.color), 1.0);
    }
    canvas.render(target).unwrap();
}

/// The calling thread does the work, so no other thread must be woken.
fn one_thread() -> rayon::ThreadPool {
    rayon::ThreadPoolBuilder::new().num_threads(1).use_current_thread().build().unwrap()
}

/// Durer's fill alone, so often, for a profile or beside another build: the median and the least of the times, and a
/// number that is the same for the same pixels.
pub fn alone(filter: &str, times: usize, anti_alias: bool) {
    let one = one_thread();
    for scene in all().iter().map(|make| make()).filter(|s| s.name.contains(filter)) {
        let mut target = Pixels::new(scene.size, scene.size, [255; 4]);
        for overlap in [Overlap::Adaptive, Overlap::Exact, Overlap::Accumulated] {
            let mut canvas = canvas(&scene, overlap, anti_alias);
            let mut run = || {
                let start = ProcessTime::now();
                one.install(|| durer(&scene, &mut canvas, &mut target));
                start.elapsed().as_secs_f64() * 1e3
            };
            let mut all: Vec<f64> = (0..times).map(|_| run()).collect();
            all.sort_by(f64::total_cmp);
            let bytes = target.data().as_flattened().iter();
            // FNV-1a.
            let hash = bytes.fold(0xcbf2_9ce4_8422_2325_u64, |h, b| {
                (h ^ u64::from(*b)).wrapping_mul(0x0100_0000_01b3)
            });
            println!(
                "{} {overlap:?}: {:.3} ({:.3}) ms, {hash:016x}",
                scene.name,
                all[times / 2],
                all[0]
            );
        }
    }
}

fn bez(scene: &Scene) -> Vec<vello_cpu::kurbo::BezPath> {
    let path = |s: &scenes::Shape| {
        let mut p = vello_cpu::kurbo::BezPath::new();
        for (points, _) in s.contours.iter() {
            for (i, q) in points.iter().enumerate() {
                if i == 0 { p.move_to((q.x, q.y)) } else { p.line_to((q.x, q.y)) }
            }
            p.close_path();
        }
        p
    };
    scene.shapes.iter().map(path).collect()
}

/// Context and target of vello_cpu.
struct Vello {
    context: vello_cpu::RenderContext,
    resources: vello_cpu::Resources,
    pixmap: vello_cpu::Pixmap,
}

impl Vello {
    /// Creates a square target, one thread.
    fn new(side: u32) -> Self {
        let settings = vello_cpu::RenderSettings { num_threads: 0, ..Default::default() };
        let side = side as u16;
        Self {
            context: vello_cpu::RenderContext::new_with(side, side, settings),
            resources: vello_cpu::Resources::new(),
            pixmap: vello_cpu::Pixmap::new(side, side),
        }
    }
}

fn vello(
    scene: &Scene,
    paths: &[vello_cpu::kurbo::BezPath],
    threshold: Option<u8>,
    target: &mut Vello,
) {
    let Vello { context, resources, pixmap } = target;
    use vello_cpu::peniko::{Fill, color::AlphaColor};
    context.reset();
    context.set_aliasing_threshold(threshold);
    context.set_paint(AlphaColor::from_rgba8(255, 255, 255, 255));
    context.fill_rect(&vello_cpu::kurbo::Rect::new(0.0, 0.0, scene.size.into(), scene.size.into()));
    for (s, p) in scene.shapes.iter().zip(paths) {
        context.set_fill_rule(if s.even_odd { Fill::EvenOdd } else { Fill::NonZero });
        let [r, g, b, a] = s.color;
        context.set_paint(AlphaColor::from_rgba8(r, g, b, a));
        context.fill_path(p);
    }
    context.flush();
    context.render(pixmap, resources);
}

fn skia_paths(scene: &Scene) -> Vec<Option<tiny_skia::Path>> {
    let path = |s: &scenes::Shape| {
        let mut b = tiny_skia::PathBuilder::new();
        for (points, _) in s.contours.iter() {
            for (i, q) in points.iter().enumerate() {
                let (x, y) = (q.x as f32, q.y as f32);
                if i == 0 { b.move_to(x, y) } else { b.line_to(x, y) }
            }
            b.close();
        }
        b.finish()
    };
    scene.shapes.iter().map(path).collect()
}

pub fn skia(
    scene: &Scene,
    paths: &[Option<tiny_skia::Path>],
    smooth: bool,
    pixmap: &mut tiny_skia::Pixmap,
) {
    pixmap.fill(tiny_skia::Color::WHITE);
    for (s, p) in scene.shapes.iter().zip(paths) {
        let Some(p) = p else { continue };
        let mut paint = tiny_skia::Paint { anti_alias: smooth, ..Default::default() };
        let [r, g, b, a] = s.color;
        paint.set_color_rgba8(r, g, b, a);
        let rule =
            if s.even_odd { tiny_skia::FillRule::EvenOdd } else { tiny_skia::FillRule::Winding };
        pixmap.fill_path(p, &paint, rule, tiny_skia::Transform::identity(), None);
    }
}

pub fn anti_aliased(filter: &str, rounds: usize) {
    println!(
        "| anti-aliased, ms | durer | durer accumulated | durer, 2 threads | vello_cpu | tiny-skia | vello / durer | vello / accumulated | tiny-skia / durer | 2 threads, by the clock |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|");
    let one = one_thread();
    let two = rayon::ThreadPoolBuilder::new().num_threads(2).build().unwrap();
    for make in all() {
        let scene = make();
        if !scene.name.contains(filter) {
            continue;
        }
        let side = scene.size;
        let mut targets = [(); 3].map(|()| Pixels::new(side, side, [255; 4]));
        let [t0, t1, t2] = &mut targets;
        let overlaps = [Overlap::Adaptive, Overlap::Accumulated, Overlap::Adaptive];
        let [mut c0, mut c1, mut c2] = overlaps.map(|overlap| canvas(&scene, overlap, true));
        let (bez, skia_paths) = (bez(&scene), skia_paths(&scene));
        let mut vello_target = Vello::new(side);
        let mut skia_map = tiny_skia::Pixmap::new(side, side).unwrap();
        let slow = scene.name.starts_with("spikes");
        let rounds = if slow { 3 } else { rounds };
        let mut walls = [Vec::new(), Vec::new()];
        let [wall_one, wall_two] = &mut walls;
        let m = medians(
            rounds,
            &mut [
                (
                    "adaptive",
                    Box::new(|| {
                        let start = Instant::now();
                        one.install(|| durer(&scene, &mut c0, t0));
                        wall_one.push(start.elapsed().as_secs_f64());
                    }),
                ),
                (
                    "accumulated",
                    Box::new(|| one.install(|| durer(&scene, &mut c1, t1))),
                ),
                (
                    "two",
                    Box::new(|| {
                        let start = Instant::now();
                        two.install(|| durer(&scene, &mut c2, t2));
                        wall_two.push(start.elapsed().as_secs_f64());
                    }),
                ),
                ("vello", Box::new(|| vello(&scene, &bez, None, &mut vello_target))),
                (
                    "tiny-skia",
                    Box::new(|| {
                        if !slow {
                            skia(&scene, &skia_paths, true, &mut skia_map)
                        }
                    }),
                ),
            ],
        );
        // Time by the clock, the least of the rounds: others may keep the second core busy.
        let [wall_one, wall_two] = walls.map(|w| w.into_iter().fold(f64::MAX, f64::min));
        println!(
            "| {} | {:.2} | {:.2} | {:.2} | {:.2} | {:.2} | {:.2} | {:.2} | {:.2} | {:.2} |",
            scene.name,
            m[0],
            m[1],
            m[2],
            m[3],
            m[4],
            m[3] / m[0],
            m[3] / m[1],
            m[4] / m[0],
            wall_one / wall_two
        );
        if std::env::var("PICTURES").is_ok() {
            let name = scene.name.replace(' ', "_");
            image::save_buffer(
                format!("{name}_durer.png"),
                targets[0].data().as_flattened(),
                side,
                side,
                image::ColorType::Rgba8,
            )
            .unwrap();
            image::save_buffer(
                format!("{name}_vello.png"),
                vello_target.pixmap.data_as_u8_slice(),
                side,
                side,
                image::ColorType::Rgba8,
            )
            .unwrap();
        }
    }
}

/// Fills by pixels' centres. vello_cpu decides by half-covered pixels, the others by centres; differences are counted.
pub fn aliased(filter: &str, rounds: usize) {
    println!(
        "| aliased, ms | durer | vello_cpu | tiny-skia | best / durer | pixels unlike tiny-skia's |"
    );
    println!("|---|---|---|---|---|---|");
    let one = one_thread();
    for make in all() {
        let scene = make();
        if !scene.name.contains(filter) {
            continue;
        }
        let side = scene.size;
        let mut target = Pixels::new(side, side, [255; 4]);
        let mut canvas = canvas(&scene, Overlap::Adaptive, false);
        let (bez, skia_paths) = (bez(&scene), skia_paths(&scene));
        let mut vello_target = Vello::new(side);
        let mut skia_map = tiny_skia::Pixmap::new(side, side).unwrap();
        let slow = scene.name.starts_with("spikes");
        let rounds = if slow { 3 } else { rounds };
        let m = medians(
            rounds,
            &mut [
                (
                    "durer",
                    Box::new(|| one.install(|| durer(&scene, &mut canvas, &mut target))),
                ),
                (
                    "vello",
                    Box::new(|| {
                        vello(&scene, &bez, Some(127), &mut vello_target);
                    }),
                ),
                (
                    "tiny-skia",
                    Box::new(|| {
                        // It takes half a minute for spikes.
                        if !slow {
                            skia(&scene, &skia_paths, false, &mut skia_map)
                        }
                    }),
                ),
            ],
        );
        let pixels = target.data().as_flattened().as_chunks::<4>().0;
        let unlike = pixels.iter().zip(skia_map.data().as_chunks::<4>().0).filter(|(a, b)| a != b);
        println!(
            "| {} | {:.2} | {:.2} | {:.2} | {:.2} | {} |",
            scene.name,
            m[0],
            m[1],
            m[2],
            if slow { m[1] } else { m[1].min(m[2]) } / m[0],
            unlike.count()
        );
    }
}
