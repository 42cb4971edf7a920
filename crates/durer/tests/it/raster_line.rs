//! Lines: all algorithms light the same pixels, from both ends, within half a pixel, clipped or not.

use crate::raster_coverage::Random;
use durer::math::IVec2;
use durer::raster::line::anti_aliased::{self, SmoothLine};
use durer::raster::line::double_step::{self, StepPattern};
use durer::raster::line::run_slice::{self, RunKind};
use durer::raster::line::tiled::{self, PixelLine};
use durer::raster::line::{LineRasterizer, Options, Step, bresenham};
use durer::target::Pixels;
use durer::trace::{NoTrace, Recorder};

fn pixels(method: LineRasterizer, a: IVec2, b: IVec2, options: &Options) -> Vec<IVec2> {
    let mut found = Vec::new();
    method.draw(a, b, options, |p| found.push(p), &mut NoTrace);
    found
}

fn point(random: &mut Random, reach: f64) -> IVec2 {
    let p = random.point(-reach, reach);
    IVec2::new(p.x as i32, p.y as i32)
}

/// Returns whether a pixel is within half a pixel of the line along its shorter axis; exact.
fn is_near(p: IVec2, a: IVec2, b: IVec2) -> bool {
    let wide = |v: IVec2| (i128::from(v.x), i128::from(v.y));
    let ((px, py), (ax, ay), (bx, by)) = (wide(p), wide(a), wide(b));
    let (dx, dy) = (bx - ax, by - ay);
    let cross = (px - ax) * dy - (py - ay) * dx;
    2 * cross.abs() <= dx.abs().max(dy.abs())
}

#[test]
fn lines_are_nearest_connected_and_the_same_reversed() {
    let mut random = Random(1);
    for round in 0..3000 {
        let reach = if round % 2 == 0 { 8.0 } else { 300.0 };
        let (a, b) = (point(&mut random, reach), point(&mut random, reach));
        let reference = pixels(LineRasterizer::Equation, a, b, &Options::default());
        let d = (b - a).abs();
        assert_eq!(reference.len() as i32, d.x.max(d.y) + 1);
        assert!(reference.iter().all(|p| is_near(*p, a, b)), "{a} {b}");
        assert!(reference.contains(&a) && reference.contains(&b));
        assert!(reference.windows(2).all(|w| (w[1] - w[0]).abs().max_element() == 1));
        for method in LineRasterizer::ALL {
            assert_eq!(pixels(*method, a, b, &Options::default()), reference, "{method} {a} {b}");
            assert_eq!(pixels(*method, b, a, &Options::default()), reference, "{method} {a} {b}");
        }
    }
}

#[test]
fn clipped_lines_are_the_unclipped_ones_within_the_window() {
    let mut random = Random(2);
    for _ in 0..4000 {
        let (a, b) = (point(&mut random, 40.0), point(&mut random, 40.0));
        let (c, d) = (point(&mut random, 30.0), point(&mut random, 30.0));
        let (low, high) = (c.min(d), c.max(d));
        let options = Options { window: Some((low, high)) };
        for method in LineRasterizer::ALL {
            let mut expected = pixels(*method, a, b, &Options::default());
            expected.retain(|p| p.cmpge(low).all() && p.cmple(high).all());
            assert_eq!(
                pixels(*method, a, b, &options),
                expected,
                "{method} {a} {b} in {low} {high}"
            );
        }
    }
}

#[test]
fn lines_from_end_to_end_of_the_integers_do_not_overflow() {
    let ends = [i32::MIN, i32::MIN + 1, -1, 0, 7, i32::MAX - 1, i32::MAX];
    let window = (IVec2::splat(-20), IVec2::splat(20));
    let corner = (IVec2::splat(i32::MAX - 20), IVec2::splat(i32::MAX));
    for window in [window, corner] {
        let options = Options { window: Some(window) };
        for (ax, ay) in ends.into_iter().flat_map(|x| ends.map(|y| (x, y))) {
            for (bx, by) in ends.into_iter().flat_map(|x| ends.map(|y| (x, y))) {
                let (a, b) = (IVec2::new(ax, ay), IVec2::new(bx, by));
                let reference = pixels(LineRasterizer::Equation, a, b, &options);
                assert!(reference.iter().all(|p| is_near(*p, a, b)), "{a} {b}");
                for method in LineRasterizer::ALL {
                    assert_eq!(pixels(*method, a, b, &options), reference, "{method} {a} {b}");
                    assert_eq!(pixels(*method, b, a, &options), reference, "{method} {b} {a}");
                }
            }
        }
    }
}

#[test]
fn the_steps_of_a_line_rebuild_it() {
    let (a, b) = (IVec2::new(-3, 9), IVec2::new(40, -6));
    let window = Some((IVec2::new(0, 0), IVec2::new(30, 30)));
    for options in [Options::default(), Options { window }] {
        for method in LineRasterizer::ALL {
            for (from, to) in [(a, b), (b, a)] {
                let mut recorder: Recorder<Step> = Recorder::default();
                let mut found = Vec::new();
                method.draw(from, to, &options, |p| found.push(p), &mut recorder);
                assert_eq!(found, pixels(*method, a, b, &options));
                // Steps have the caller's direction.
                found.sort_by_key(|p| if from == a { p.x } else { -p.x });
                let replayed: Vec<_> = recorder.steps().iter().map(|s| s.pixel).collect();
                assert_eq!(replayed, found);
            }
        }
    }
}

#[test]
fn runs_have_the_lengths_that_their_decisions_say() {
    let mut steps = Recorder::default();
    let (a, b) = (IVec2::ZERO, IVec2::new(15, 4));
    run_slice::draw(a, b, &Options::default(), |_| {}, &mut steps);
    let runs: Vec<_> =
        steps.steps().iter().map(|s| (s.run, s.e, s.pixels().count(), s.is_cut)).collect();
    let expected = [
        (RunKind::First, 0, 2, false),
        (RunKind::Long, -6, 4, false),
        (RunKind::Long, -4, 4, false),
        (RunKind::Long, -2, 4, false),
        (RunKind::Short, 0, 2, true),
    ];
    assert_eq!(runs, expected);
    let mut random = Random(6);
    for _ in 0..300 {
        let (a, b) = (point(&mut random, 60.0), point(&mut random, 60.0));
        let options = Options { window: Some((IVec2::splat(-30), IVec2::splat(40))) };
        for options in [options, Options::default()] {
            let (mut steps, mut found) = (Recorder::default(), Vec::new());
            run_slice::draw(a, b, &options, |p| found.push(p), &mut steps);
            assert_eq!(run_slice::replay(steps.steps()), found);
            let d = (b - a).abs();
            assert!(steps.steps().len() as i32 <= d.min_element() + 1, "{a} {b}");
            let whole = steps.steps().iter().filter(|s| s.run != RunKind::First && !s.is_cut);
            let q = d.max_element() / d.min_element().max(1);
            for step in whole {
                let expected = if step.e < 0 { q + 1 } else { q };
                assert_eq!(step.pixels().count() as i32, expected, "{a} {b}");
            }
        }
    }
}

#[test]
fn two_steps_have_one_of_four_patterns() {
    let mut steps = Recorder::default();
    double_step::draw(IVec2::ZERO, IVec2::new(5, 3), &Options::default(), |_| {}, &mut steps);
    let at = IVec2::new;
    let pair = |pattern, d, pixels| double_step::Step::Pair { pattern, d, pixels };
    let expected = [
        double_step::Step::Start { pixel: at(0, 0), d: -3 },
        pair(StepPattern::First, -3, [at(1, 1), at(2, 1)]),
        pair(StepPattern::First, -1, [at(3, 2), at(4, 2)]),
        // The last E in the lecture.
        double_step::Step::Last { e: 5, pixel: at(5, 3) },
    ];
    assert_eq!(steps.steps(), expected);
    let mut random = Random(7);
    for _ in 0..300 {
        let (a, b) = (point(&mut random, 60.0), point(&mut random, 60.0));
        let (mut steps, mut found) = (Recorder::default(), Vec::new());
        double_step::draw(a, b, &Options::default(), |p| found.push(p), &mut steps);
        assert_eq!(double_step::replay(steps.steps()), found);
        let d = (b - a).abs();
        let is_flat = 2 * d.min_element() < d.max_element();
        let mut decisions = 0;
        for step in steps.steps() {
            let double_step::Step::Pair { pattern, .. } = step else { continue };
            assert!(*pattern != if is_flat { StepPattern::Aslant } else { StepPattern::Straight });
            decisions += pattern.decisions();
        }
        assert!(decisions as i32 <= d.max_element());
    }
    // Slope 1 / 8: one decision for two pixels, except once in eight.
    let mut steps = Recorder::default();
    double_step::draw(at(0, 0), at(80, 10), &Options::default(), |_| {}, &mut steps);
    let simple = |step: &&double_step::Step| {
        matches!(step, double_step::Step::Pair { pattern: StepPattern::Straight, .. })
    };
    assert_eq!(steps.steps().iter().filter(simple).count(), 30);
}

#[test]
fn smooth_lines_carry_the_lines_weight() {
    let mut random = Random(3);
    for _ in 0..300 {
        let (a, b) = (point(&mut random, 60.0), point(&mut random, 60.0));
        let d = (b - a).abs();
        let columns = f64::from(d.x.max(d.y) + 1);
        for method in SmoothLine::ALL {
            let mut sum = 0.0;
            let plot = |_: IVec2, i: u8| sum += f64::from(i) / 255.0;
            anti_aliased::draw(*method, a, b, &Options::default(), plot, &mut NoTrace);
            let expected = match method {
                SmoothLine::Wu => columns,
                SmoothLine::GuptaSproull => {
                    columns * d.as_dvec2().length().max(1.0) / (columns - 1.0).max(1.0)
                }
            };
            assert!((sum - expected).abs() <= 0.04 * expected + 0.01, "{method}: {sum} {expected}");
        }
    }
}

#[test]
fn smooth_lines_in_a_window_are_the_whole_ones_there() {
    let mut random = Random(5);
    for _ in 0..1500 {
        let (a, b) = (point(&mut random, 30.0), point(&mut random, 30.0));
        let (c, d) = (point(&mut random, 20.0), point(&mut random, 20.0));
        let (low, high) = (c.min(d), c.max(d));
        for method in SmoothLine::ALL {
            let drawn = |window| {
                let mut found = Vec::new();
                let plot = |p: IVec2, i: u8| found.push((p, i));
                anti_aliased::draw(*method, a, b, &Options { window }, plot, &mut NoTrace);
                found.sort_by_key(|(p, i)| (p.x, p.y, *i));
                found
            };
            let mut expected = drawn(None);
            expected.retain(|(p, _)| p.cmpge(low).all() && p.cmple(high).all());
            assert_eq!(drawn(Some((low, high))), expected, "{method} {a} {b} in {low} {high}");
        }
    }
}

#[test]
fn wus_pairs_share_a_pixel_by_the_nearest_level() {
    let mut random = Random(6);
    for _ in 0..500 {
        let b = point(&mut random, 60.0).abs();
        let (long, short) = (b.x.max(b.y), b.x.min(b.y));
        let (a, b) = (IVec2::ZERO, IVec2::new(long, short));
        let mut found = Vec::new();
        let plot = |p: IVec2, i: u8| found.push((p, i));
        anti_aliased::draw(SmoothLine::Wu, a, b, &Options::default(), plot, &mut NoTrace);
        for (p, i) in found {
            let height = f64::from(p.x) * f64::from(short) / f64::from(long.max(1));
            let share = 255.0 * (1.0 - (height - f64::from(p.y)).abs());
            assert!((f64::from(i) - share).abs() <= 0.5 + 1e-9, "{b} {p}: {i} {share}");
        }
    }
}

#[test]
fn tiled_lines_are_bresenhams_in_their_order() {
    let mut random = Random(11);
    for round in 0..40 {
        let (width, height) = [(300, 200), (128, 128), (1, 400), (700, 3)][round % 4];
        let (low, high) = [(-50.0, 350.0), (0.0, 127.0), (-1e5, 1e5), (-2e9, 2e9)][round / 4 % 4];
        // Few lines and many in one tile, short ones, points, and ties at 45 degrees and halfway.
        let count = [5, 60, 900][round % 3];
        let mut lines: Vec<PixelLine<u16>> = Vec::new();
        for value in 1..=count {
            let mut corner = || {
                let p = random.point(low, high);
                IVec2::new(p.x as i32, p.y as i32)
            };
            let (from, far) = (corner(), corner());
            let step = IVec2::new(i32::from(value) % 9 - 4, i32::from(value) % 5 - 2);
            let to = if value % 3 == 0 { from.saturating_add(step * 4) } else { far };
            lines.push(PixelLine { from, to, value });
        }
        let mut expected = Pixels::new(width, height, 0);
        let corner = IVec2::new(width as i32 - 1, height as i32 - 1);
        let options = Options { window: Some((IVec2::ZERO, corner)) };
        for PixelLine { from, to, value } in &lines {
            let plot = |p: IVec2| expected.set(p.x as u32, p.y as u32, *value);
            bresenham::draw(*from, *to, &options, plot, &mut NoTrace);
        }
        let mut found = Pixels::new(width, height, 0);
        let mut recorder = Recorder::default();
        tiled::draw(&lines, &mut found, &mut recorder);
        assert!(found == expected, "round {round}");
        let mut replayed = Pixels::new(width, height, 0);
        for tiled::Step { tile, line } in recorder.steps() {
            let options = Options { window: Some(*tile) };
            let plot = |p: IVec2| replayed.set(p.x as u32, p.y as u32, line.value);
            bresenham::draw(line.from, line.to, &options, plot, &mut NoTrace);
        }
        assert!(replayed == expected, "steps of round {round}");
        let mut unheard = Pixels::new(width, height, 0);
        tiled::draw(&lines, &mut unheard, &mut NoTrace);
        assert!(unheard == expected, "without a listener, round {round}");
    }
}

#[test]
fn every_short_slope_is_bresenhams_in_a_tile() {
    for steps in 0..128 {
        for rise in 0..=steps {
            let ends = [
                [0, 0, steps, rise],
                [0, rise, steps, 0],
                [0, 0, rise, steps],
                [rise, 0, 0, steps],
            ];
            for [ax, ay, bx, by] in if (steps + rise) % 3 == 0 { &ends[..] } else { &ends[..2] } {
                let (from, to) = (IVec2::new(*ax, *ay), IVec2::new(*bx, *by));
                // Enough to draw the tile separately.
                let lines = [PixelLine { from, to, value: 1_u8 }; 24];
                let (width, height) = (ax.max(bx) + 1, ay.max(by) + 1);
                let mut found = Pixels::new(width as u32, height as u32, 0);
                tiled::draw(&lines, &mut found, &mut NoTrace);
                let mut expected = Pixels::new(width as u32, height as u32, 0);
                let plot = |p: IVec2| expected.set(p.x as u32, p.y as u32, 1);
                bresenham::draw(from, to, &Options::default(), plot, &mut NoTrace);
                assert!(found == expected, "{from} {to}");
            }
        }
    }
}
