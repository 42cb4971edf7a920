//! Aliased lines and seed fills.

use crate::medians;
use crate::scenes::Random;
use durer::curve::Path;
use durer::math::{DVec2, IVec2};
use durer::raster::line::tiled::{self, PixelLine};
use durer::raster::line::wide::Stroke;
use durer::raster::line::{Options, bresenham};
use durer::raster::paint::{Canvas, Paint};
use durer::raster::seed_fill::{self, Connectivity, SeedFill, flood_fill};
use durer::target::Pixels;
use durer::trace::NoTrace;

/// 10⁶ lines of up to 100 pixels in mixed colours at 2048².
pub fn aliased() {
    let (mut r, side) = (Random(4), 2048_usize);
    let lines: Vec<_> = (0..1_000_000)
        .map(|_| {
            let (x, y) = (200.0 + r.next() * 1648.0, 200.0 + r.next() * 1648.0);
            let (dx, dy) = ((r.next() - 0.5) * 190.0, (r.next() - 0.5) * 190.0);
            ((x as i32, y as i32), ((x + dx) as i32, (y + dy) as i32), r.color())
        })
        .collect();
    let tiled: Vec<PixelLine<[u8; 4]>> = lines
        .iter()
        .map(|(p, q, value)| PixelLine { from: (*p).into(), to: (*q).into(), value: *value })
        .collect();
    let mut maps = [(); 4].map(|()| Pixels::new(side as u32, side as u32, [255_u8; 4]));
    let [a, b, c, d] = &mut maps;
    let window = Some((IVec2::ZERO, IVec2::splat(side as i32 - 1)));
    let m = medians(
        7,
        &mut [
            ("durer, tiles", Box::new(|| tiled::draw(&tiled, d, &mut NoTrace))),
            (
                "durer",
                Box::new(|| {
                    let data = a.data_mut();
                    for (p, q, color) in &lines {
                        let (p, q) = (IVec2::from(*p), IVec2::from(*q));
                        let plot = |at: IVec2| data[at.y as usize * side + at.x as usize] = *color;
                        bresenham::draw(p, q, &Options { window }, plot, &mut NoTrace);
                    }
                }),
            ),
            (
                "bresenham",
                Box::new(|| {
                    let data = b.data_mut();
                    for (p, q, color) in &lines {
                        let wide = |p: (i32, i32)| (p.0 as isize, p.1 as isize);
                        for (x, y) in ::bresenham::Bresenham::new(wide(*p), wide(*q)) {
                            data[y as usize * side + x as usize] = *color;
                        }
                    }
                }),
            ),
            (
                "line_drawing",
                Box::new(|| {
                    let data = c.data_mut();
                    for (p, q, color) in &lines {
                        for (x, y) in line_drawing::Bresenham::<i32>::new(*p, *q) {
                            data[y as usize * side + x as usize] = *color;
                        }
                    }
                }),
            ),
        ],
    );
    println!(
        "10^6 lines, ms: durer by tiles {:.0}, one by one {:.0}, bresenham crate {:.0}, line_drawing {:.0}; best crate / by tiles {:.2}",
        m[0],
        m[1],
        m[2],
        m[3],
        m[2].min(m[3]) / m[0]
    );
    assert!(maps[0].data() == maps[3].data(), "not the same pixels");
}

/// 10⁵ anti-aliased lines one pixel wide, up to 100 pixels long, in mixed colours at 2048².
pub fn hairlines() {
    let (mut r, side) = (Random(6), 2048_u32);
    let lines: Vec<_> = (0..100_000)
        .map(|_| {
            let p = DVec2::new(r.next(), r.next()) * 1648.0 + 200.0;
            (p, p + (DVec2::new(r.next(), r.next()) - 0.5) * 190.0, r.color())
        })
        .collect();
    let paths: Vec<_> = lines
        .iter()
        .map(|(p, q, color)| {
            let mut path = Path::new();
            path.move_to(p.x, p.y).line_to(q.x, q.y);
            (path, Paint::Color(*color))
        })
        .collect();
    let skia: Vec<_> = lines
        .iter()
        .map(|(p, q, _)| {
            let mut path = tiny_skia::PathBuilder::new();
            path.move_to(p.x as f32, p.y as f32);
            path.line_to(q.x as f32, q.y as f32);
            path.finish().unwrap()
        })
        .collect();
    let bez: Vec<_> = lines
        .iter()
        .map(|(p, q, _)| {
            let mut path = vello_cpu::kurbo::BezPath::new();
            path.move_to((p.x, p.y));
            path.line_to((q.x, q.y));
            path
        })
        .collect();
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let mut target = Pixels::new(side, side, [255; 4]);
    let mut skia_map = tiny_skia::Pixmap::new(side, side).unwrap();
    let settings = vello_cpu::RenderSettings { num_threads: 0, ..Default::default() };
    let mut context = vello_cpu::RenderContext::new_with(side as u16, side as u16, settings);
    let mut resources = vello_cpu::Resources::new();
    let mut pixmap = vello_cpu::Pixmap::new(side as u16, side as u16);
    let m = medians(
        5,
        &mut [
            (
                "durer",
                Box::new(|| {
                    one.install(|| {
                        let mut canvas = Canvas::new(side, side, Default::default()).unwrap();
                        canvas.clear([255; 4]);
                        for (path, paint) in &paths {
                            canvas.stroke(path, &Stroke::default(), paint, 1.0).unwrap();
                        }
                        canvas.render(&mut target).unwrap();
                    })
                }),
            ),
            (
                "tiny-skia",
                Box::new(|| {
                    skia_map.fill(tiny_skia::Color::WHITE);
                    let stroke = tiny_skia::Stroke::default();
                    let map = tiny_skia::Transform::identity();
                    for (path, (_, _, [r, g, b, a])) in skia.iter().zip(&lines) {
                        let mut paint = tiny_skia::Paint::default();
                        paint.set_color_rgba8(*r, *g, *b, *a);
                        skia_map.stroke_path(path, &paint, &stroke, map, None);
                    }
                }),
            ),
            (
                "vello",
                Box::new(|| {
                    use vello_cpu::{kurbo, peniko::color::AlphaColor};
                    context.reset();
                    context.set_paint(AlphaColor::from_rgba8(255, 255, 255, 255));
                    context.fill_rect(&kurbo::Rect::new(0.0, 0.0, side.into(), side.into()));
                    context.set_stroke(kurbo::Stroke::new(1.0).with_caps(kurbo::Cap::Butt));
                    for (path, (_, _, [r, g, b, a])) in bez.iter().zip(&lines) {
                        context.set_paint(AlphaColor::from_rgba8(*r, *g, *b, *a));
                        context.stroke_path(path);
                    }
                    context.flush();
                    context.render(&mut pixmap, &mut resources);
                }),
            ),
        ],
    );
    println!(
        "10^5 hairlines, ms: durer {:.0}, tiny-skia {:.0}, vello_cpu {:.0}; tiny-skia / durer {:.2}, vello_cpu / durer {:.2}",
        m[0],
        m[1],
        m[2],
        m[1] / m[0],
        m[2] / m[0]
    );
    // The same picture: how far vello_cpu's is off on average.
    let own = target.data().as_flattened();
    let far: u64 =
        own.iter().zip(pixmap.data_as_u8_slice()).map(|(a, b)| u64::from(a.abs_diff(*b))).sum();
    println!("mean difference from vello_cpu {:.3}/255", far as f64 / own.len() as f64);
}

/// Returns a maze by a random spanning tree (depth first): corridors and walls one pixel wide.
fn maze(side: u32, r: &mut Random) -> Vec<u8> {
    let n = ((side - 1) / 2) as usize;
    let side = side as usize;
    let mut pixels = vec![255; side * side];
    let mut stack = vec![(0, 0)];
    pixels[0] = 0;
    while let Some((x, y)) = stack.last().copied() {
        let around = [(1, 0), (-1, 0), (0, 1), (0, -1_i64)];
        let open = around.iter().filter_map(|(dx, dy)| {
            let (u, v) = ((x as i64 + dx) as usize, (y as i64 + dy) as usize);
            (u < n && v < n && pixels[2 * v * side + 2 * u] != 0).then_some((u, v))
        });
        let open: Vec<(usize, usize)> = open.collect();
        if open.is_empty() {
            stack.pop();
            continue;
        }
        let (u, v) = open[(r.next() * open.len() as f64) as usize % open.len()];
        pixels[2 * v * side + 2 * u] = 0;
        pixels[(y + v) * side + x + u] = 0;
        stack.push((u, v));
    }
    pixels
}

/// Flood fills of 4096²: empty, noise, maze, serpentine; imageproc has 4-connected ones.
pub fn floods() {
    let side = 4096_u32;
    let mut r = Random(5);
    let noise: Vec<u8> =
        (0..side * side).map(|i| u8::from(i != 0 && r.next() < 0.35) * 255).collect();
    let snake = (0..side * side).map(|i| {
        let (x, y) = (i % side, i / side);
        let open = if y / 2 % 2 == 0 { side - 1 } else { 0 };
        u8::from(y % 2 == 1 && x != open) * 255
    });
    let scenes = [
        ("empty", vec![0; (side * side) as usize]),
        ("noise", noise),
        ("maze", maze(side, &mut r)),
        ("serpentine", snake.collect()),
    ];
    println!(
        "| flood fill, ms | durer, 4 | durer, 8 | imageproc, 4 | imageproc / durer, 4 | / durer, 8 |"
    );
    println!("|---|---|---|---|---|---|");
    for (name, data) in scenes {
        let source = Pixels::from_data(side, side, data.clone()).unwrap();
        let peer = image::GrayImage::from_raw(side, side, data).unwrap();
        let (mut a, mut b, mut c) = (source.clone(), source.clone(), peer.clone());
        let fill = |image: &mut Pixels<u8>, connectivity| {
            image.data_mut().copy_from_slice(source.data());
            let options = seed_fill::Options { connectivity, ..Default::default() };
            let filled = flood_fill(image, (0, 0), 128, 0, SeedFill::Spans, &options, &mut NoTrace);
            filled.expect("no budget");
        };
        // The preparation of each, to be subtracted.
        let mut copy = source.clone();
        let m = medians(
            5,
            &mut [
                ("four", Box::new(|| fill(&mut a, Connectivity::Four))),
                ("eight", Box::new(|| fill(&mut b, Connectivity::Eight))),
                (
                    "imageproc",
                    Box::new(|| {
                        c.copy_from_slice(&peer);
                        let (seed, value) = ((0, 0), image::Luma([128]));
                        imageproc::drawing::flood_fill_mut(&mut c, seed.0, seed.1, value);
                    }),
                ),
                ("copy", Box::new(|| copy.data_mut().copy_from_slice(source.data()))),
            ],
        );
        assert!(a.data() == c.as_raw().as_slice(), "{name}: not the same pixels");
        let [four, eight, other] = [0, 1, 2].map(|i| m[i] - m[3]);
        println!(
            "| {name} | {four:.1} | {eight:.1} | {other:.1} | {:.2} | {:.2} |",
            other / four,
            other / eight
        );
    }
}
