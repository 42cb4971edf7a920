//! Painting: order, clips, groups, gradients, strokes and text; the same bytes on any number of threads.

use crate::raster_coverage::Random;
use durer::curve::text::Font;
use durer::curve::{Contours, Path};
use durer::math::{DAffine2, DVec2};
use durer::raster::coverage::{FillRule, Overlap};
use durer::raster::line::wide::{Cap, Join, Stroke, outline};
use durer::raster::paint::{
    BlendFunction, Blending, Canvas, ImageFilter, MaskKind, Options, Paint, Pattern,
};
use durer::target::Pixels;
use durer::target::gradient::{Gradient, GradientShape, Spread};
use durer::trace::NoTrace;
use std::sync::Arc;

const WHITE: [u8; 4] = [255; 4];

fn color(r: u8, g: u8, b: u8, a: u8) -> Paint {
    Paint::Color([r, g, b, a])
}

fn canvas(side: u32) -> Canvas {
    Canvas::new(side, side, Options::default()).unwrap()
}

fn rendered(canvas: &Canvas, side: u32, below: [u8; 4]) -> Pixels<[u8; 4]> {
    let mut target = Pixels::new(side, side, below);
    canvas.render(&mut target).unwrap();
    target
}

fn gradient(shape: GradientShape, spread: Spread) -> Paint {
    let stops = vec![(0.0, [255, 0, 0, 255]), (1.0, [0, 0, 255, 255])];
    Paint::Gradient(Arc::new(Gradient { shape, stops, spread, transform: DAffine2::IDENTITY }))
}

/// Returns a drawing with some of everything.
fn card(options: Options) -> Canvas {
    let mut c = Canvas::new(300, 200, options).unwrap();
    let shape = GradientShape::Linear { start: DVec2::ZERO, end: DVec2::new(100.0, 50.0) };
    let background = gradient(shape, Spread::Reflect);
    c.fill(&Path::rectangle(5.0, 5.0, 290.0, 190.0), FillRule::NonZero, &background, 0.5);
    c.push_clip(&Path::circle(DVec2::new(100.0, 100.0), 80.0), FillRule::NonZero);
    c.push_group();
    for i in 0..40 {
        let at = DVec2::new(f64::from(i * 37 % 300), f64::from(i * 71 % 200));
        c.fill(&Path::circle(at, 25.0), FillRule::EvenOdd, &color(i as u8 * 6, 99, 10, 200), 1.0);
    }
    c.pop(0.7);
    c.pop(1.0);
    let stroke =
        Stroke { width: 7.5, dashes: vec![20.0, 9.0], cap: Cap::Round, ..Stroke::default() };
    c.stroke(&Path::circle(DVec2::new(200.0, 100.0), 60.0), &stroke, &color(0, 0, 0, 160), 1.0)
        .unwrap();
    c
}

/// Returns a ring of this many vertices, some of them outside the picture.
fn jagged(count: u32) -> Contours {
    Contours::polygon((0..count).map(|i| {
        let angle = f64::from(i) / f64::from(count) * std::f64::consts::TAU;
        let radius = 85.0 + f64::from(i * 7919 % 101) * 0.2;
        DVec2::new(150.0 + radius * angle.cos(), 100.0 + radius * angle.sin())
    }))
}

#[test]
fn a_cleared_canvas_is_a_new_one() {
    let paint = |canvas: &mut Canvas, shift: f64| {
        canvas.clear([0, 30, 60, 255]);
        for i in 0..300 {
            let at = DVec2::new(f64::from(i * 37 % 300) + shift, f64::from(i * 71 % 200));
            canvas.set_anti_alias(i % 3 != 0);
            let paint = color(i as u8, 99, 10, 200);
            canvas.fill(&Path::circle(at, f64::from(i % 50)), FillRule::NonZero, &paint, 1.0);
        }
        canvas.fill_contours(&jagged(6000), FillRule::NonZero, &color(9, 9, 9, 99), 1.0);
        let mut target = Pixels::new(300, 200, WHITE);
        canvas.render(&mut target).unwrap();
        target
    };
    let new = || Canvas::new(300, 200, Options::default()).unwrap();
    let mut kept = new();
    for shift in [0.0, 3.3, 90.0] {
        assert!(paint(&mut kept, shift) == paint(&mut new(), shift), "{shift}");
    }
}

#[test]
fn the_number_of_threads_changes_nothing() {
    for blending in [Blending::Srgb, Blending::Linear] {
        let on = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let mut target = Pixels::new(300, 200, [9, 200, 77, 130]);
            pool.install(|| {
                let mut card = card(Options { blending, ..Options::default() });
                for smooth in [true, false] {
                    card.set_anti_alias(smooth);
                    let paint = color(80, 9, 200, 255);
                    card.fill_contours(&jagged(20_000), FillRule::EvenOdd, &paint, 0.5);
                }
                card.render(&mut target)
            })
            .unwrap();
            target
        };
        let one = on(1);
        assert_eq!(on(2), one);
        assert_eq!(on(7), one);
    }
}

#[test]
fn order_is_kept_and_opacity_mixes() {
    let mut c = canvas(40);
    c.fill(&Path::rectangle(0.0, 0.0, 40.0, 40.0), FillRule::NonZero, &color(0, 0, 0, 255), 1.0);
    c.fill(
        &Path::rectangle(0.0, 0.0, 40.0, 40.0),
        FillRule::NonZero,
        &color(200, 100, 50, 255),
        0.5,
    );
    let target = rendered(&c, 40, WHITE);
    let p = target.get(20, 20).unwrap();
    assert!([100, 50, 25].iter().zip(p).all(|(a, b)| b.abs_diff(*a) <= 1), "{p:?}");
    // Over nothing, the colour stays and only alpha is halved.
    let mut c = canvas(40);
    c.fill(
        &Path::rectangle(0.0, 0.0, 40.0, 40.0),
        FillRule::NonZero,
        &color(200, 100, 50, 255),
        0.5,
    );
    let p = rendered(&c, 40, [0; 4]).get(3, 3).unwrap();
    assert!([200, 100, 50, 128].iter().zip(p).all(|(a, b)| b.abs_diff(*a) <= 1), "{p:?}");
}

#[test]
fn linear_light_mixes_lighter() {
    let half = |blending| {
        let mut c = Canvas::new(2, 2, Options { blending, ..Options::default() }).unwrap();
        c.fill(
            &Path::rectangle(0.0, 0.0, 2.0, 2.0),
            FillRule::NonZero,
            &color(255, 255, 255, 255),
            0.5,
        );
        rendered(&c, 2, [0, 0, 0, 255]).get(0, 0).unwrap()[0]
    };
    assert_eq!(half(Blending::Srgb), 128);
    assert_eq!(half(Blending::Linear), 188);
}

#[test]
fn clips_nest_and_end() {
    let mut c = canvas(20);
    c.push_clip(&Path::rectangle(0.0, 0.0, 10.0, 20.0), FillRule::NonZero);
    c.push_clip(&Path::rectangle(0.0, 5.5, 20.0, 20.0), FillRule::NonZero);
    c.fill(&Path::rectangle(0.0, 0.0, 20.0, 20.0), FillRule::NonZero, &color(0, 0, 0, 255), 1.0);
    c.pop(1.0);
    c.pop(1.0);
    c.fill(&Path::rectangle(15.0, 0.0, 1.0, 1.0), FillRule::NonZero, &color(0, 0, 0, 255), 1.0);
    let target = rendered(&c, 20, WHITE);
    let at = |x, y| target.get(x, y).unwrap()[0];
    assert_eq!([at(5, 4), at(5, 6), at(12, 10), at(15, 0)], [255, 0, 255, 0]);
    assert_eq!(at(5, 5), 127);
}

#[test]
fn a_group_is_one_layer() {
    let mut c = canvas(20);
    c.push_group();
    c.fill(&Path::rectangle(0.0, 0.0, 20.0, 20.0), FillRule::NonZero, &color(255, 0, 0, 255), 1.0);
    c.fill(&Path::rectangle(0.0, 0.0, 20.0, 20.0), FillRule::NonZero, &color(0, 0, 0, 255), 1.0);
    c.pop(0.5);
    let p = rendered(&c, 20, WHITE).get(9, 9).unwrap();
    assert!(p[0].abs_diff(127) <= 1 && p[0] == p[1], "{p:?}");
    // A pop without a push does nothing, and groups left open are closed.
    let mut c = canvas(20);
    c.pop(1.0);
    c.push_group();
    c.fill(&Path::rectangle(0.0, 0.0, 20.0, 20.0), FillRule::NonZero, &color(1, 2, 3, 255), 1.0);
    assert_eq!(rendered(&c, 20, WHITE).get(1, 1), Some([1, 2, 3, 255]));
}

/// Returns a square of one colour over another, blended as a group.
fn blended(blend: BlendFunction, layer: Paint, below: [u8; 4], options: Options) -> [u8; 4] {
    let mut canvas = Canvas::new(4, 4, options).unwrap();
    canvas.push_group();
    canvas.fill(&Path::rectangle(0.0, 0.0, 4.0, 4.0), FillRule::NonZero, &layer, 1.0);
    canvas.pop_blended(0.5, blend);
    rendered(&canvas, 4, below).get(1, 1).unwrap()
}

#[test]
fn groups_blend_with_what_is_below() {
    let below = [51, 102, 204, 255];
    let by = |blend| blended(blend, color(153, 128, 26, 255), below, Options::default());
    // Half of each figure, half of the backdrop.
    assert_eq!(by(BlendFunction::Normal), [102, 115, 115, 255]);
    assert_eq!(by(BlendFunction::Multiply), [41, 77, 113, 255]);
    assert_eq!(by(BlendFunction::Screen), [112, 141, 207, 255]);
    assert_eq!(by(BlendFunction::Difference), [76, 64, 191, 255]);
    assert_eq!(by(BlendFunction::PlusLighter), [128, 166, 217, 255]);
    let linear = Options { blending: Blending::Linear, ..Options::default() };
    let all = blended(BlendFunction::Multiply, color(255, 255, 255, 255), below, linear);
    assert_eq!(all, below);
}

#[test]
fn where_nothing_is_below_layers_keep_their_colour() {
    for blend in [
        BlendFunction::Multiply,
        BlendFunction::Hue,
        BlendFunction::ColorBurn,
        BlendFunction::PlusLighter,
    ] {
        let found = blended(blend, color(200, 40, 0, 255), [0; 4], Options::default());
        assert_eq!(found, [199, 40, 0, 128], "{blend:?}");
    }
    // A backdrop that covers half of it contributes half of its colour.
    let found = blended(
        BlendFunction::Multiply,
        color(0, 255, 0, 255),
        [255, 0, 0, 128],
        Options::default(),
    );
    assert_eq!(found[3], 192);
    assert!(found[0].abs_diff(85) <= 1 && found[1].abs_diff(84) <= 2, "{found:?}");
}

#[test]
fn gradients_pad_repeat_and_reflect() {
    let shape = GradientShape::Linear { start: DVec2::new(10.0, 0.0), end: DVec2::new(20.0, 0.0) };
    let red = |spread, x| {
        let mut c = canvas(40);
        c.fill(
            &Path::rectangle(0.0, 0.0, 40.0, 40.0),
            FillRule::NonZero,
            &gradient(shape, spread),
            1.0,
        );
        rendered(&c, 40, WHITE).get(x, 7).unwrap()[0]
    };
    assert_eq!([red(Spread::Pad, 2), red(Spread::Pad, 35)], [255, 0]);
    assert!(red(Spread::Repeat, 20) > 235 && red(Spread::Repeat, 19) < 20);
    assert!(red(Spread::Reflect, 20) < 20 && red(Spread::Reflect, 29) > 235);
    let (center, focus) = (DVec2::splat(20.0), DVec2::splat(20.0));
    let radial = GradientShape::Radial { center, radius: 20.0, focus, focus_radius: 0.0 };
    let mut c = canvas(40);
    c.fill(
        &Path::rectangle(0.0, 0.0, 40.0, 40.0),
        FillRule::NonZero,
        &gradient(radial, Spread::Pad),
        1.0,
    );
    let target = rendered(&c, 40, WHITE);
    assert!(target.get(20, 20).unwrap()[0] > 240 && target.get(0, 0).unwrap()[0] == 0);
    assert!(target.get(29, 20).unwrap()[0].abs_diff(134) < 6);
}

/// Checks that two stops at one position make a border between two colours, accurate to a fraction of a pixel however
/// long the gradient is.
#[test]
fn hard_stops_are_sharp_and_in_place() {
    let (red, green, blue) = ([255, 0, 0, 255], [0, 255, 0, 255], [0, 0, 255, 255]);
    let row = |stops: &[(f64, [u8; 4])], (start, end): (f64, f64), spread| {
        let shape =
            GradientShape::Linear { start: DVec2::new(start, 0.0), end: DVec2::new(end, 0.0) };
        let (stops, transform) = (stops.to_vec(), DAffine2::IDENTITY);
        let paint = Paint::Gradient(Arc::new(Gradient { shape, stops, spread, transform }));
        let mut c = canvas(40);
        c.fill(&Path::rectangle(0.0, 0.0, 40.0, 40.0), FillRule::NonZero, &paint, 1.0);
        let target = rendered(&c, 40, WHITE);
        (0..40).map(|x| target.get(x, 7).unwrap()).collect::<Vec<_>>()
    };
    // A step of a table of 512 colours would be eight pixels here.
    let long = [(0.0, red), (0.501, red), (0.501, blue), (1.0, blue)];
    let found = row(&long, (-2000.0, 2000.0), Spread::Pad);
    let expected: Vec<_> = (0..40).map(|x| if x < 4 { red } else { blue }).collect();
    assert_eq!(found, expected);
    // Where a gradient reflects or repeats near a pixel's centre, colours beyond its end are not visible.
    let turned = [(0.0, red), (1.0, red), (1.0, blue)];
    for spread in [Spread::Reflect, Spread::Repeat] {
        assert_eq!(row(&turned, (-2.6, 4.503), spread), vec![red; 40], "{spread:?}");
    }
    // Beyond the ends are the first and the last stop.
    let twice = [(0.0, red), (0.0, green), (1.0, green), (1.0, blue)];
    let found = row(&twice, (10.0, 30.0), Spread::Pad);
    assert_eq!([found[9], found[10], found[29], found[30]], [red, green, green, blue]);
}

#[test]
fn clearing_is_filling_before() {
    for background in [[1, 2, 3, 255], [90, 80, 70, 60]] {
        let draw = |c: &mut Canvas| {
            c.fill(
                &Path::circle(DVec2::splat(20.0), 15.0),
                FillRule::NonZero,
                &color(9, 99, 200, 180),
                1.0,
            );
        };
        let (mut cleared, mut plain) = (canvas(40), canvas(40));
        draw(&mut cleared);
        cleared.clear(background);
        draw(&mut cleared);
        draw(&mut plain);
        assert_eq!(rendered(&cleared, 40, WHITE), rendered(&plain, 40, background));
    }
}

#[test]
fn patterns_repeat() {
    let image = Pixels::from_data(2, 1, vec![[255, 0, 0, 255], [0, 255, 0, 255]]).unwrap();
    let transform = DAffine2::from_scale(DVec2::splat(4.0));
    let pattern = Pattern {
        image: Arc::new(image),
        transform,
        spread: Some(Spread::Repeat),
        filter: ImageFilter::Nearest,
    };
    let mut c = canvas(20);
    let paint = Paint::Pattern(Arc::new(pattern));
    c.fill(&Path::rectangle(0.0, 0.0, 20.0, 20.0), FillRule::NonZero, &paint, 1.0);
    let target = rendered(&c, 20, WHITE);
    let row: Vec<u8> = (0..20).step_by(4).map(|x| target.get(x, 3).unwrap()[0]).collect();
    assert_eq!(row, [255, 0, 255, 0, 255]);
}

#[test]
fn strokes_have_their_width_caps_and_dashes() {
    let line = Path::polyline([DVec2::new(10.0, 10.0), DVec2::new(30.0, 10.0)]);
    let area = |stroke: &Stroke| {
        let options = Options { tolerance: 0.01, ..Options::default() };
        let mut c = Canvas::new(40, 40, options).unwrap();
        c.stroke(&line, stroke, &color(0, 0, 0, 255), 1.0).unwrap();
        rendered(&c, 40, WHITE).data().iter().map(|p| f64::from(255 - p[0]) / 255.0).sum::<f64>()
    };
    let plain = Stroke { width: 4.0, ..Stroke::default() };
    assert!((area(&plain) - 80.0).abs() < 0.1);
    assert!((area(&Stroke { cap: Cap::Square, ..plain.clone() }) - 96.0).abs() < 0.1);
    let round = area(&Stroke { cap: Cap::Round, ..plain.clone() });
    assert!((round - 80.0 - std::f64::consts::PI * 4.0).abs() < 0.1, "{round}");
    let dashed = Stroke { dashes: vec![2.0, 3.0], ..plain.clone() };
    assert!((area(&dashed) - 32.0).abs() < 0.1, "{}", area(&dashed));
    assert_eq!(area(&Stroke { width: 0.0, ..plain.clone() }), 0.0);
    for bad in [
        Stroke { width: -1.0, ..plain.clone() },
        Stroke { width: f64::NAN, ..plain.clone() },
        Stroke { miter_limit: 0.5, ..plain.clone() },
        Stroke { dashes: vec![-1.0], ..plain.clone() },
        Stroke { dash_offset: f64::INFINITY, ..plain.clone() },
    ] {
        assert!(outline(&line, &bad, 0.1, &mut NoTrace).is_err());
    }
    let mut strange = Path::new();
    strange.close().line_to(f64::NAN, 1.0).line_to(5.0, 5.0).quad_to(1e30, 3.0, 9.0, 9.0).close();
    for join in [Join::Miter, Join::Round, Join::Bevel] {
        assert!(outline(&strange, &Stroke { join, ..dashed.clone() }, 0.1, &mut NoTrace).is_ok());
    }
}

/// Checks that the overlaps of a stroke's outline at its bends do not count as noise.
#[test]
fn strokes_of_many_short_edges_are_measured() {
    let mut random = Random(12);
    let mut at = DVec2::splat(32.0);
    // Few enough that no more than 32 edges cross a pixel.
    let scribble = Path::polyline((0..600).map(|_| {
        at = (at + random.point(-3.0, 3.0)).clamp(DVec2::ZERO, DVec2::splat(64.0));
        at
    }));
    let stroke = Stroke { width: 0.5, ..Stroke::default() };
    let of = |overlap| {
        let mut c = Canvas::new(64, 64, Options { overlap, ..Options::default() }).unwrap();
        c.stroke(&scribble, &stroke, &color(0, 0, 0, 255), 1.0).unwrap();
        rendered(&c, 64, WHITE)
    };
    let exact = of(Overlap::Exact);
    let worst = |other: Pixels<[u8; 4]>| {
        let pairs = exact.data().iter().zip(other.data());
        pairs.map(|(a, b)| a[0].abs_diff(b[0])).max().unwrap()
    };
    assert_eq!(of(Overlap::Adaptive), of(Overlap::Measured));
    assert!(worst(of(Overlap::Adaptive)) <= 12, "{}", worst(of(Overlap::Adaptive)));
    assert!(worst(of(Overlap::Accumulated)) > 48);
}

#[test]
fn thin_lines_are_painted_as_their_outlines_are() {
    let (mut random, mut lit) = (Random(9), 0);
    for round in 0..240_usize {
        let (kind, side) = (round % 6, 150);
        let blending = if round % 5 == 0 { Blending::Linear } else { Blending::Srgb };
        let options = Options { blending, ..Options::default() };
        let mut canvases = [(); 2].map(|()| Canvas::new(side, side - 7, options).unwrap());
        let mut map = DAffine2::IDENTITY;
        if kind == 1 {
            let turn = DAffine2::from_angle_translation(random.next(), DVec2::new(40.0, -20.0));
            map = turn * DAffine2::from_scale(DVec2::new(1.2, 0.7));
            canvases.iter_mut().for_each(|c| c.set_transform(map));
        }
        if kind == 2 {
            let hole = Path::circle(DVec2::splat(80.0), 50.0);
            canvases.iter_mut().for_each(|c| c.push_clip(&hole, FillRule::NonZero));
            canvases.iter_mut().for_each(Canvas::push_group);
        }
        for i in 0..12 {
            let mut a = random.point(-2.0, 152.0);
            let mut b =
                if i % 3 == 0 { a + random.point(-4.0, 4.0) } else { random.point(0.0, 143.0) };
            match kind {
                // Ends on borders and centres of pixels, and lines along the axes and diagonals.
                3 => (a, b) = ((a * 2.0).round() / 2.0, (b * 2.0).round() / 2.0),
                4 => (a, b) = (a.round(), DVec2::new(b.x, a.y.round())),
                5 => b = DVec2::new(a.x + (b.y - a.y), b.y),
                _ => {}
            }
            if i % 2 == 0 && kind > 2 {
                (a, b) = (DVec2::new(a.y, a.x), DVec2::new(b.y, b.x));
            }
            let width = [1.0, 0.02, 0.4, 1.0 + random.next(), 2.0, 3.9, 5.0][(i + round) % 7];
            let cap = if i % 4 == 3 { Cap::Square } else { Cap::Butt };
            let stroke = Stroke { width, cap, ..Stroke::default() };
            let paint =
                color(i as u8 * 20, 200, 255 - round as u8, if i % 2 == 0 { 255 } else { 99 });
            let mut path = Path::new();
            path.move_to(a.x, a.y).line_to(b.x, b.y);
            let opacity = 0.9 + random.next() * 0.2;
            canvases[0].stroke(&path, &stroke, &paint, opacity).unwrap();
            let outline = outline(&path, &stroke, 0.025, &mut NoTrace).unwrap();
            canvases[1].fill_contours(
                &outline.transformed(map),
                FillRule::NonZero,
                &paint,
                opacity,
            );
        }
        let [own, other] = canvases.map(|c| {
            let mut target = Pixels::new(side, side - 7, [250, 240, 10, 200]);
            c.render(&mut target).unwrap();
            target
        });
        assert!(own == other, "round {round}");
        lit += own.data().iter().filter(|p| **p != [250, 240, 10, 200]).count();
    }
    assert!(lit > 100_000, "{lit}");
}

#[test]
fn empty_targets_and_strange_paints_are_defined() {
    let c = Canvas::new(0, 7, Options::default()).unwrap();
    c.render(&mut Pixels::new(0, 7, WHITE)).unwrap();
    assert!(c.render(&mut Pixels::new(1, 7, WHITE)).is_err());
    assert!(Canvas::new(40_000, 1, Options::default()).is_err());
    let mut c = canvas(10);
    c.set_transform(DAffine2::from_scale(DVec2::new(f64::NAN, 0.0)));
    let shape = GradientShape::Linear { start: DVec2::NAN, end: DVec2::ONE };
    c.fill(
        &Path::rectangle(0.0, 0.0, 5.0, 5.0),
        FillRule::NonZero,
        &gradient(shape, Spread::Repeat),
        f64::NAN,
    );
    c.fill_contours(
        &Contours::polygon([DVec2::ZERO, DVec2::X * 9.0, DVec2::Y * 9.0]),
        FillRule::NonZero,
        &gradient(shape, Spread::Pad),
        1.0,
    );
    rendered(&c, 10, WHITE);
}

/// Returns the area that a stroke covers, in pixels.
fn stroked(path: &Path, stroke: &Stroke) -> f64 {
    let mut c = canvas(40);
    c.stroke(path, stroke, &Paint::Color([0, 0, 0, 255]), 1.0).unwrap();
    let picture = rendered(&c, 40, [0; 4]);
    picture.data().iter().map(|p| f64::from(p[3]) / 255.0).sum()
}

#[test]
fn contours_and_dashes_without_length_are_dots() {
    let at = |cap, dashes: &[f64]| Stroke {
        width: 10.0,
        cap,
        dashes: dashes.to_vec(),
        ..Stroke::default()
    };
    let mut point = Path::new();
    point.move_to(20.0, 20.0).line_to(20.0, 20.0);
    let (disk, square) = (std::f64::consts::PI * 25.0, 100.0);
    // Chords are within the tolerance of the circle.
    let slack = Options::default().tolerance * std::f64::consts::PI * 10.0;
    assert!((stroked(&point, &at(Cap::Round, &[])) - disk).abs() < slack);
    assert!((stroked(&point, &at(Cap::Square, &[])) - square).abs() < 0.5);
    assert_eq!(stroked(&point, &at(Cap::Butt, &[])), 0.0);
    let mut only_move = Path::new();
    only_move.move_to(20.0, 20.0);
    assert_eq!(stroked(&only_move, &at(Cap::Round, &[])), 0.0);
    // Two dots, one at the start, one 20 further.
    let mut line = Path::new();
    line.move_to(10.0, 20.0).line_to(39.0, 20.0);
    let dots = stroked(&line, &at(Cap::Round, &[0.0, 20.0]));
    assert!((dots - 2.0 * disk).abs() < 2.0 * slack, "{dots}");
}

#[test]
fn a_mask_restricts_what_follows_until_it_is_popped() {
    for (kind, expected) in [(MaskKind::Alpha, [255, 255]), (MaskKind::Luminance, [255, 54])] {
        let mut c = canvas(20);
        c.push_clip(&Path::rectangle(0.0, 0.0, 20.0, 10.0), FillRule::NonZero);
        c.begin_mask();
        // Not clipped by clips around the mask, and closed by its end.
        c.push_group();
        for (x, color) in [(0.0, [255, 255, 255, 255]), (5.0, [255, 0, 0, 255])] {
            let path = Path::rectangle(x, 0.0, 5.0, 20.0);
            c.fill(&path, FillRule::NonZero, &Paint::Color(color), 1.0);
        }
        c.end_mask(kind);
        let all = Path::rectangle(0.0, 0.0, 20.0, 20.0);
        c.fill(&all, FillRule::NonZero, &Paint::Color([0, 0, 0, 255]), 1.0);
        c.pop(1.0);
        c.pop(1.0);
        c.fill(
            &Path::rectangle(15.0, 15.0, 5.0, 5.0),
            FillRule::NonZero,
            &Paint::Color([9, 9, 9, 255]),
            1.0,
        );
        let picture = rendered(&c, 20, [0; 4]);
        let alpha = |x, y| picture.get(x, y).unwrap()[3];
        assert_eq!([alpha(2, 5), alpha(7, 5)], expected, "{kind:?}");
        assert_eq!([alpha(12, 5), alpha(2, 15), alpha(17, 17)], [0, 0, 255], "{kind:?}");
    }
}

#[test]
fn a_clip_around_the_whole_picture_changes_nothing_and_ends() {
    let painted = |clips: &[&Path]| {
        let mut c = canvas(20);
        clips.iter().for_each(|clip| c.push_clip(clip, FillRule::EvenOdd));
        let circle = Path::circle(DVec2::new(9.3, 4.8), 6.1);
        c.fill(&circle, FillRule::NonZero, &color(200, 30, 9, 255), 0.7);
        // Each ends alone.
        clips.iter().for_each(|_| c.pop(1.0));
        let bar = Path::rectangle(3.5, 0.0, 9.0, 20.0);
        c.fill(&bar, FillRule::NonZero, &color(3, 90, 200, 255), 1.0);
        rendered(&c, 20, WHITE).data().to_vec()
    };
    let free = painted(&[]);
    let around = Path::rectangle(0.0, 0.0, 20.0, 20.0);
    let beyond = Path::rectangle(-5.0, -1.0, 99.0, 99.0);
    assert_eq!(painted(&[&around]), free);
    assert_eq!(painted(&[&beyond, &around]), free);
    // By the even-odd rule a winding number of two is outside; slightly fewer than all cuts.
    let mut twice = around.clone();
    twice.extend(&beyond);
    let less = Path::rectangle(0.0, 0.5, 20.0, 20.0);
    for cutting in [twice, less] {
        let cut = painted(&[&cutting]);
        assert!(cut != free && painted(&[&beyond, &cutting]) == cut);
    }
}

#[test]
fn a_group_is_clipped_once() {
    let mut c = canvas(4);
    c.push_clip(&Path::rectangle(0.0, 0.0, 1.5, 4.0), FillRule::NonZero);
    c.push_group();
    c.fill(&Path::rectangle(0.0, 0.0, 4.0, 4.0), FillRule::NonZero, &color(0, 0, 0, 255), 1.0);
    c.pop(1.0);
    c.pop(1.0);
    let picture = rendered(&c, 4, [0; 4]);
    assert_eq!(picture.row(1).iter().map(|p| p[3]).collect::<Vec<_>>(), [255, 128, 0, 0]);
}

#[test]
fn what_is_left_open_or_closed_too_often_is_defined() {
    let mut c = canvas(4);
    c.pop(1.0);
    c.end_mask(MaskKind::Alpha);
    c.push_group();
    c.begin_mask();
    c.fill(&Path::rectangle(0.0, 0.0, 4.0, 4.0), FillRule::NonZero, &Paint::Color([1; 4]), 1.0);
    assert!(rendered(&c, 4, WHITE).data().iter().all(|p| *p == WHITE));
    c.pop(1.0);
    c.fill(
        &Path::rectangle(0.0, 0.0, 4.0, 4.0),
        FillRule::NonZero,
        &Paint::Color([1, 1, 1, 255]),
        1.0,
    );
    assert!(rendered(&c, 4, WHITE).data().iter().all(|p| *p == [1, 1, 1, 255]));
}

#[test]
fn edges_are_smoothed_or_not_command_by_command() {
    let mut c = canvas(8);
    for (y, smooth) in [(0.0, true), (4.0, false)] {
        c.set_anti_alias(smooth);
        let path = Path::rectangle(0.0, y, 2.4, 2.0);
        c.fill(&path, FillRule::NonZero, &Paint::Color([0, 0, 0, 255]), 1.0);
    }
    let picture = rendered(&c, 8, [0; 4]);
    assert_eq!([0, 4].map(|y| picture.get(2, y).unwrap()[3]), [102, 0]);
}

#[test]
fn images_end_repeat_or_turn_at_their_border() {
    let image = Arc::new(Pixels::from_data(2, 1, vec![[10, 0, 0, 255], [20, 0, 0, 255]]).unwrap());
    let row = |spread| {
        let transform = DAffine2::from_translation(DVec2::new(3.0, 0.0));
        let pattern =
            Pattern { image: image.clone(), transform, spread, filter: ImageFilter::Nearest };
        let mut c = canvas(8);
        let all = Path::rectangle(0.0, 0.0, 8.0, 8.0);
        c.fill(&all, FillRule::NonZero, &Paint::Pattern(Arc::new(pattern)), 1.0);
        rendered(&c, 8, [0; 4]).row(0).iter().map(|p| p[0]).collect::<Vec<_>>()
    };
    assert_eq!(row(None), [0, 0, 0, 10, 20, 0, 0, 0]);
    assert_eq!(row(Some(Spread::Pad)), [10, 10, 10, 10, 20, 20, 20, 20]);
    assert_eq!(row(Some(Spread::Repeat)), [20, 10, 20, 10, 20, 10, 20, 10]);
    assert_eq!(row(Some(Spread::Reflect)), [20, 20, 10, 10, 20, 20, 10, 10]);
}

mod conformance_text {
    use super::*;

    #[test]
    fn text_advances_and_is_kerned() {
        let data = std::env::var("DURER_DATA")
            .unwrap_or_else(|_| format!("{}/../../../shared/data", env!("CARGO_MANIFEST_DIR")));
        let Ok(bytes) = std::fs::read(format!("{data}/fonts/DejaVuSans.ttf")) else {
            eprintln!("skipped: no fonts under {data}");
            return;
        };
        let font = Font::new(&bytes, 0).unwrap();
        let width = |text: &str| font.line(text, 100.0).advance;
        assert!((width("nn") - 2.0 * width("n")).abs() < 1e-3);
        assert!(width("AV") < width("A") + width("V") - 1.0, "kerning");
        let line = font.line("Hxg", 100.0);
        let bounds = line.path.bounds().unwrap();
        assert!(bounds.min().y < -70.0 && bounds.max().y > 15.0 && bounds.max().x <= line.advance);
        assert!(line.ascent > 70.0 && line.descent > 15.0);
        assert!(Font::new(b"not a font", 0).is_err());
        for size in [f64::NAN, f64::INFINITY, -1.0, 1e30, 1e-300] {
            let line = font.line("Hx\u{0}g", size);
            let finite = line.path.bounds().is_none_or(|b| (b.max() - b.min()).is_finite());
            assert!(finite && line.advance.is_finite() && line.ascent.is_finite(), "{size}");
        }
        // A truncated file has no outlines for the missing glyphs, and nothing fails.
        let cut = Font::new(&bytes[..bytes.len() / 2], 0).map(|f| f.line("Hxg", 100.0).advance);
        assert!(cut.is_ok_and(|advance| advance.is_finite()));
    }
}
