//! Aliased lines and seed fills.

use crate::medians;
use crate::scenes::Random;
use durer::math::IVec2;
use durer::raster::line::{Options, bresenham};
use durer::raster::seed_fill::{self, Connectivity, SeedFill, flood_fill};
use durer::target::Pixels;
use durer::trace::NoTrace;

/// 10⁶ lines of about 100 pixels in mixed colours at 2048².
pub fn aliased() {
    let (mut r, side) = (Random(4), 2048_usize);
    let lines: Vec<_> = (0..1_000_000)
        .map(|_| {
            let (x, y) = (200.0 + r.next() * 1648.0, 200.0 + r.next() * 1648.0);
            let (dx, dy) = ((r.next() - 0.5) * 190.0, (r.next() - 0.5) * 190.0);
            ((x as i32, y as i32), ((x + dx) as i32, (y + dy) as i32), r.color())
        })
        .collect();
    let mut maps = [(); 3].map(|()| Pixels::new(side as u32, side as u32, [255_u8; 4]));
    let [a, b, c] = &mut maps;
    let window = Some((IVec2::ZERO, IVec2::splat(side as i32 - 1)));
    let m = medians(
        7,
        &mut [
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
        "10^6 lines, ms: durer {:.0}, bresenham crate {:.0}, line_drawing {:.0}; best crate / durer {:.2}",
        m[0],
        m[1],
        m[2],
        m[1].min(m[2]) / m[0]
    );
}

/// Flood fills of 4096²: empty, noise, serpentine.
pub fn floods() {
    let side = 4096_u32;
    let mut r = Random(5);
    let noise: Vec<u8> = (0..side * side).map(|_| u8::from(r.next() < 0.35) * 255).collect();
    let snake = (0..side * side).map(|i| {
        let (x, y) = (i % side, i / side);
        let open = if y / 2 % 2 == 0 { side - 1 } else { 0 };
        u8::from(y % 2 == 1 && x != open) * 255
    });
    let scenes = [
        ("empty", vec![0; (side * side) as usize]),
        ("noise", noise),
        ("serpentine", snake.collect()),
    ];
    for (name, data) in scenes {
        let source = Pixels::from_data(side, side, data).unwrap();
        for connectivity in [Connectivity::Four, Connectivity::Eight] {
            let options = seed_fill::Options { connectivity };
            let mut times = Vec::new();
            for _ in 0..7 {
                let mut image = source.clone();
                let start = std::time::Instant::now();
                flood_fill(&mut image, (0, 0), 128, 0, SeedFill::Spans, &options, &mut NoTrace);
                times.push(start.elapsed().as_secs_f64() * 1e3);
            }
            times.sort_by(f64::total_cmp);
            println!("flood {name} {connectivity:?}: {:.1} ms", times[3]);
        }
    }
}
