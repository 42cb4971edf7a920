//! Segments against a rectangle: ours against the crate `line-clipping`.

use crate::{Random, medians};
use durer::clip::line::{Segment, batch, cohen_sutherland, liang_barsky, nicholl_lee_nicholl};
use durer::math::{DVec2, Rect};
use durer::trace::NoTrace;
use line_clipping::{LineSegment, Point, Window, cohen_sutherland::clip_line};
use std::hint::black_box;

const N: usize = 10_000_000;

/// Segments that are all inside, all outside, all crossing, or anything.
fn segment(kind: &str, r: &mut Random) -> [f64; 4] {
    let mut within = |lo: f64, hi: f64| lo + (hi - lo) * r.next();
    match kind {
        "accept" => [0; 4].map(|_| within(0.26, 0.74)),
        "reject" => {
            let side = within(0.0, 4.0) as usize;
            let (far, any) =
                ([within(0.0, 0.24), within(0.0, 0.24)], [within(0.0, 1.0), within(0.0, 1.0)]);
            match side {
                0 => [far[0], any[0], far[1], any[1]],
                1 => [1.0 - far[0], any[0], 1.0 - far[1], any[1]],
                2 => [any[0], far[0], any[1], far[1]],
                _ => [any[0], 1.0 - far[0], any[1], 1.0 - far[1]],
            }
        }
        "cross" => {
            let inside = [within(0.26, 0.74), within(0.26, 0.74)];
            let mut outside = [within(0.0, 1.0), within(0.0, 1.0)];
            outside[within(0.0, 2.0) as usize] =
                if within(0.0, 1.0) < 0.5 { within(0.0, 0.24) } else { within(0.76, 1.0) };
            let [a, b] = if within(0.0, 1.0) < 0.5 { [inside, outside] } else { [outside, inside] };
            [a[0], a[1], b[0], b[1]]
        }
        _ => [0; 4].map(|_| within(0.0, 1.0)),
    }
}

/// Returns the number of accepted segments; each call is a direct one, as the other's.
fn one_by_one(all: &[[f64; 4]], f: impl Fn(Segment<DVec2>) -> Option<Segment<DVec2>>) -> f64 {
    let segments = all.iter().map(|s| Segment::new(DVec2::new(s[0], s[1]), DVec2::new(s[2], s[3])));
    segments.filter(|s| black_box(f(*s)).is_some()).count() as f64
}

pub fn run() {
    let window = Rect::new(DVec2::splat(0.25), DVec2::splat(0.75)).unwrap();
    let theirs = Window::new(0.25, 0.75, 0.25, 0.75);
    for kind in ["accept", "reject", "cross", "mixed"] {
        let mut random = Random(7);
        let all: Vec<[f64; 4]> = (0..N).map(|_| segment(kind, &mut random)).collect();
        let array = |k: usize| all.iter().map(|s| s[k]).collect::<Vec<f64>>();
        let [x0, y0, x1, y1] = [0, 1, 2, 3].map(array);
        let mut out = batch::Clipped::default();
        let mut chunk = batch::Clipped::default();
        let one_thread = batch::Options { threads: false, ..Default::default() };
        let whole = |out: &mut batch::Clipped| {
            let input = batch::Segments { x0: &x0, y0: &y0, x1: &x1, y1: &y1 };
            batch::clip(&window, input, &one_thread, out).unwrap();
            out.accepted.iter().map(|w| w.count_ones()).sum::<u32>() as f64
        };
        println!("{kind}, {N} segments, per segment:");
        medians(
            &mut [
                ("line-clipping clip_line", &mut || {
                    let lines = all
                        .iter()
                        .map(|s| LineSegment::new(Point::new(s[0], s[1]), Point::new(s[2], s[3])));
                    lines.filter(|l| black_box(clip_line(*l, theirs)).is_some()).count() as f64
                }),
                ("durer batch, one thread", &mut || whole(&mut out)),
                ("durer batch, one thread, output 16k at a time", &mut || {
                    let mut count = 0;
                    for from in (0..N).step_by(16_384) {
                        let part = from..(from + 16_384).min(N);
                        let input = batch::Segments {
                            x0: &x0[part.clone()],
                            y0: &y0[part.clone()],
                            x1: &x1[part.clone()],
                            y1: &y1[part],
                        };
                        batch::clip(&window, input, &one_thread, &mut chunk).unwrap();
                        count += chunk.accepted.iter().map(|w| w.count_ones()).sum::<u32>();
                    }
                    count as f64
                }),
                ("durer Cohen–Sutherland, one call each", &mut || {
                    one_by_one(&all, |s| cohen_sutherland::clip(&window, s, &mut NoTrace).unwrap())
                }),
                ("durer Liang–Barsky, one call each", &mut || {
                    one_by_one(&all, |s| liang_barsky::clip(&window, s, &mut NoTrace).unwrap())
                }),
                ("durer Nicholl–Lee–Nicholl, one call each", &mut || {
                    one_by_one(&all, |s| {
                        nicholl_lee_nicholl::clip(&window, s, &mut NoTrace).unwrap()
                    })
                }),
            ],
            N,
        );
    }
}
