//! Textbook algorithms around the main ones: circles, ellipses, pens, halftones, fog, points in polygons, polygons at
//! windows, winding rules.

use crate::raster_coverage::Random;
use durer::clip::polygon::point::{self, Place, locate, winding_number};
use durer::clip::polygon::{WindingRule, liang_barsky, maillot, signed_area, sutherland_hodgman};
use durer::curve::Contours;
use durer::fragment::fog::Fog;
use durer::fragment::halftone::{as_light, clustered_dot, error_diffusion};
use durer::math::{DVec2, IVec2, Rect, Vec4};
use durer::raster::conic::{self, CurveRegion, MAX_RADIUS, circle, ellipse};
use durer::raster::ear_clipping::ears;
use durer::raster::interpolate::barycentric_2d;
use durer::raster::line::pattern::{self, PenShape};
use durer::raster::triangulate::{Step as Ear, triangulate_by_rule};
use durer::target::Pixels;
use durer::trace::{NoTrace, Recorder};

fn sorted(mut pixels: Vec<IVec2>) -> Vec<[i32; 2]> {
    pixels.sort_by_key(|p| (p.y, p.x));
    pixels.into_iter().map(|p| p.to_array()).collect()
}

fn lit(draw: impl FnOnce(&mut Vec<IVec2>)) -> Vec<[i32; 2]> {
    let mut pixels = Vec::new();
    draw(&mut pixels);
    let count = pixels.len();
    let mut all = sorted(pixels);
    all.dedup();
    assert_eq!(all.len(), count, "a pixel twice");
    all
}

#[test]
fn circles_light_the_nearest_pixels() {
    for radius in 0..80_u32 {
        let found = lit(|pixels| {
            circle(IVec2::ZERO, radius, |p| pixels.push(p), &mut NoTrace).unwrap();
        });
        let r = i64::from(radius);
        // In each octant the pixel nearest to the circle along the shorter way: (2y − 1)² < 4(r² − x²) < (2y + 1)².
        let nearest = |x: i64| (0..=r).find(|y| 4 * (r * r - x * x) < (2 * y + 1) * (2 * y + 1));
        let mut expected = Vec::new();
        for x in 0..=r {
            let Some(y) = nearest(x).filter(|y| x <= *y) else { continue };
            for (x, y) in [(x, y), (-x, y), (x, -y), (-x, -y), (y, x), (-y, x), (y, -x), (-y, -x)] {
                expected.push(IVec2::new(x as i32, y as i32));
            }
        }
        let mut expected = sorted(expected);
        expected.dedup();
        assert_eq!(found, expected, "radius {radius}");
    }
}

#[test]
fn the_decisions_of_a_circle_are_the_lectures() {
    let mut steps = Recorder::default();
    let mut found = Vec::new();
    circle(IVec2::new(7, -3), 8, |p| found.push(p - IVec2::new(7, -3)), &mut steps).unwrap();
    let octant: Vec<_> = steps.steps().iter().map(|s| (s.pixel.x, s.pixel.y, s.d)).collect();
    // d = 1 − r; below 0 it grows by 2x + 3, else by 2(x − y) + 5 and y falls.
    let expected = [(0, 8, -7), (1, 8, -4), (2, 8, 1), (3, 7, -6), (4, 7, 3), (5, 6, 2)];
    assert_eq!(octant, expected);
    assert!(steps.steps().iter().all(|s| s.region == CurveRegion::Octant));
    assert_eq!(sorted(conic::replay(steps.steps())), sorted(found));
}

#[test]
fn ellipses_are_closed_and_near_and_have_their_tips() {
    for (a, b) in (0..24).flat_map(|a| (0..24).map(move |b| (a, b))).chain([(500, 3), (2, 400)]) {
        let mut steps = Recorder::default();
        let found = lit(|pixels| {
            ellipse(IVec2::ZERO, [a, b], |p| pixels.push(p), &mut steps).unwrap();
        });
        assert_eq!(sorted(conic::replay(steps.steps())), found);
        let (wide, high) = (a as i32, b as i32);
        for tip in [[wide, 0], [-wide, 0], [0, high], [0, -high]] {
            assert!(found.contains(&tip), "{a} {b}: {tip:?}");
        }
        // The quadrant's pixels follow each other without a gap.
        let quadrant: Vec<IVec2> = steps.steps().iter().map(|s| s.pixel).collect();
        let next = |w: &[IVec2]| (w[1] - w[0]).abs().max_element() == 1;
        assert!(quadrant.windows(2).all(next), "{a} {b}: {quadrant:?}");
        if a + b == 0 {
            continue;
        }
        // The curve passes within a pixel of each.
        let outside = |x: f64, y: f64| {
            let (a, b) = (f64::from(a), f64::from(b));
            x * x * b * b + y * y * a * a > a * a * b * b
        };
        for p in &quadrant {
            let (x, y) = (f64::from(p.x), f64::from(p.y));
            let inner = outside((x - 1.0).max(0.0), (y - 1.0).max(0.0));
            assert!(!inner && outside(x + 1.0, y + 1.0), "{a} {b}: {p}");
        }
    }
    let circle_like = |r| {
        (
            lit(|p| ellipse(IVec2::ZERO, [r, r], |q| p.push(q), &mut NoTrace).unwrap()),
            lit(|p| circle(IVec2::ZERO, r, |q| p.push(q), &mut NoTrace).unwrap()),
        )
    };
    for r in [1, 5, 13, 40] {
        let (found, expected) = circle_like(r);
        let differing = found.iter().filter(|p| !expected.contains(p)).count();
        assert!(differing <= 8, "{r}: {differing}");
    }
}

#[test]
fn circles_at_the_rim_of_all_coordinates_and_beyond_the_limit() {
    let mut count = 0;
    circle(IVec2::MAX, 50, |_| count += 1, &mut NoTrace).unwrap();
    assert!(count > 0);
    assert!(circle(IVec2::ZERO, MAX_RADIUS + 1, |_| {}, &mut NoTrace).is_err());
    assert!(ellipse(IVec2::ZERO, [1, u32::MAX], |_| {}, &mut NoTrace).is_err());
}

#[test]
fn pens_and_patterns_follow_the_thin_line() {
    let (a, b) = (IVec2::new(20, 5), IVec2::new(-4, 14));
    let options =
        pattern::Options { pen: PenShape::Square(3), pattern: 0x0f0f, repeat: 2, offset: 3 };
    for (from, to) in [(a, b), (b, a)] {
        let mut steps = Recorder::default();
        let mut found = Vec::new();
        pattern::draw(from, to, &options, |p| found.push(p), &mut steps);
        assert_eq!(pattern::replay(from, to, &options, steps.steps()), found);
        // From the caller's first end: three pixels into a pattern of eight on, eight off.
        let down = |step: u64| (step + 3) % 16 < 8;
        assert!(steps.steps().iter().all(|s| s.down == down(s.step)));
        let at = |end| steps.steps().iter().find(|s| s.pixel == end).map(|s| s.step);
        assert_eq!((at(from), at(to)), (Some(0), Some(24)));
    }
    let thick = |pen| {
        let options = pattern::Options { pen, ..Default::default() };
        let mut pixels = Vec::new();
        pattern::draw(IVec2::ZERO, IVec2::new(3, 9), &options, |p| pixels.push(p), &mut NoTrace);
        pixels.len()
    };
    assert_eq!([0, 1, 4].map(|w| thick(PenShape::Replicated(w))), [0, 10, 40]);
    assert_eq!(thick(PenShape::Square(2)), 40);
    let mut count = 0;
    let far = pattern::Options { pen: PenShape::Square(4), ..Default::default() };
    pattern::draw(IVec2::MAX, IVec2::MAX, &far, |_| count += 1, &mut NoTrace);
    assert_eq!(count, 9, "what lies beyond i32 is left out");
}

fn ramp() -> Pixels<f32> {
    let mut ramp = Pixels::new(96, 64, 0.0);
    for y in 0..64 {
        ramp.row_mut(y).iter_mut().enumerate().for_each(|(x, v)| *v = x as f32 / 95.0);
    }
    ramp
}

#[test]
fn errors_go_to_the_four_neighbours_and_are_not_lost() {
    let grey = Pixels::from_data(3, 2, vec![0.5, 0.25, 0.0, 0.0, 1.0, 0.5]).unwrap();
    let mut steps = Recorder::default();
    let found = error_diffusion::dither(&grey, &Default::default(), &mut steps);
    let value = |k: usize| (steps.steps()[k].value, steps.steps()[k].level);
    // 0.5 becomes white; −0.5 · 7/16 comes to the next, −0.5 · 5/16 and 1/16 below.
    let second = 0.25 - 0.5 * 7.0 / 16.0;
    assert_eq!((value(0), value(1)), ((0.5, 1), (second, 0)));
    assert_eq!(value(2), (second * 7.0 / 16.0, 0));
    assert_eq!(value(3), (-0.5 * 5.0 / 16.0 + second * 3.0 / 16.0, 0));
    assert_eq!(error_diffusion::replay(3, 2, steps.steps()), found);
    for options in [
        error_diffusion::Options::default(),
        error_diffusion::Options { levels: 4, serpentine: true },
    ] {
        let mut steps = Recorder::default();
        let dots = error_diffusion::dither(&ramp(), &options, &mut steps);
        assert_eq!(error_diffusion::dither(&ramp(), &options, &mut NoTrace), dots);
        let sum = |image: &Pixels<f32>| image.data().iter().map(|v| f64::from(*v)).sum::<f64>();
        let light = as_light(&dots, options.levels);
        // Only errors passed over the borders are lost: at most half a level along them.
        assert!((sum(&light) - sum(&ramp())).abs() < 80.0, "{options:?}");
        assert!(dots.data().iter().all(|level| *level < options.levels));
    }
}

#[test]
fn strange_greys_have_levels() {
    let strange = vec![f32::NAN, f32::INFINITY, -1.0, 7.0];
    let image = Pixels::from_data(4, 1, strange).unwrap();
    let levels = error_diffusion::dither(&image, &Default::default(), &mut NoTrace);
    assert_eq!(levels.data(), [0, 1, 0, 1]);
    assert_eq!(clustered_dot::dither(&image, &mut NoTrace).data(), [0, 1, 0, 1]);
    let none = Pixels::new(0, 0, 1.0);
    assert!(error_diffusion::dither(&none, &Default::default(), &mut NoTrace).data().is_empty());
}

#[test]
fn clustered_dots_have_the_tone_and_hold_together() {
    let mut thresholds: Vec<u8> = clustered_dot::SCREEN.concat();
    thresholds.sort_unstable();
    assert!(thresholds.chunks(2).zip(0..).all(|(pair, t)| pair == [t, t]));
    for tone in 0..=32 {
        let image = Pixels::new(8, 8, tone as f32 / 32.0);
        let mut steps = Recorder::default();
        let dots = clustered_dot::dither(&image, &mut steps);
        assert_eq!(clustered_dot::replay(8, 8, steps.steps()), dots);
        assert_eq!(dots.data().iter().map(|v| i32::from(*v)).sum::<i32>(), 2 * tone);
        // Around the screen, which repeats, there are few changes: at most two dots of each kind.
        let changes = (0..64).filter(|i| {
            let (x, y) = (i % 8, i / 8);
            dots.get(x, y) != dots.get((x + 1) % 8, y)
        });
        assert!(changes.count() <= 24, "{tone}");
    }
}

#[test]
fn fog_has_three_laws() {
    let linear = Fog::Linear { start: 1.0, end: 5.0, least: 0.0 };
    assert_eq!([0.0, 1.0, 2.0, 5.0, 7.0].map(|z| linear.left(z)), [1.0, 1.0, 0.75, 0.0, 0.0]);
    let close = |a: f32, b: f64| (f64::from(a) - b).abs() < 1e-6;
    let exponential = Fog::Exponential { density: 0.5 };
    let squared = Fog::Squared { density: 0.5 };
    for z in [0.0_f32, 0.5, 2.0, 3.0] {
        let thick = f64::from(z) * 0.5;
        assert!(close(exponential.left(z), (-thick).exp()));
        assert!(close(squared.left(z), (-thick * thick).exp()));
    }
    let color = linear.apply(Vec4::new(1.0, 0.0, 0.0, 0.5), Vec4::ONE, 2.0);
    assert_eq!(color, Vec4::new(1.0, 0.25, 0.25, 0.5));
    for fog in [linear, exponential, squared, Fog::Linear { start: 2.0, end: 2.0, least: 0.0 }] {
        for z in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 2.0] {
            assert!((0.0..=1.0).contains(&fog.left(z)), "{fog:?} {z}");
        }
    }
}

#[test]
fn a_point_is_located_by_every_rule() {
    // A pentagram, whose middle is wound around twice, its tips once.
    let tip = |k: i32| DVec2::from_angle(f64::from(k) * 2.0 * std::f64::consts::TAU / 5.0) * 8.0;
    let star: Vec<DVec2> = (0..5).map(tip).collect();
    let mut steps = Recorder::default();
    assert_eq!(winding_number([&star[..]], DVec2::ZERO, &mut steps), Some(2));
    assert_eq!(point::replay(steps.steps()), Some(2));
    let middle = WindingRule::ALL.iter().map(|rule| locate([&star[..]], DVec2::ZERO, *rule));
    let inside = |place| place == Place::Inside;
    assert_eq!(middle.map(inside).collect::<Vec<_>>(), [false, true, true, false, true]);
    let at_tip = DVec2::new(7.0, 0.0);
    let tips = WindingRule::ALL.iter().map(|rule| locate([&star[..]], at_tip, *rule));
    assert_eq!(tips.map(inside).collect::<Vec<_>>(), [true, true, true, false, false]);
    for rule in WindingRule::ALL {
        assert_eq!(locate([&star[..]], star[0], *rule), Place::Border);
        assert_eq!(locate([&star[..]], DVec2::new(-8.0, 1.0), *rule), Place::Outside);
        assert_eq!(locate([&[][..]], DVec2::ZERO, *rule), Place::Outside);
    }
}

#[test]
fn five_winding_rules_triangulate_a_pentagram() {
    let tip = |k: i32| DVec2::from_angle(f64::from(k) * 2.0 * std::f64::consts::TAU / 5.0) * 8.0;
    let star = Contours::polygon((0..5).map(tip));
    let area = |rule| {
        let mut steps = Recorder::default();
        let found = triangulate_by_rule(&star, rule, &mut steps).unwrap();
        assert_eq!(steps.steps().len(), found.points.len() + found.triangles.len());
        found.area()
    };
    let [odd, all, positive, negative, twice] = [0, 1, 2, 3, 4].map(|k| area(WindingRule::ALL[k]));
    assert!((odd + twice - all).abs() < 1e-6 && (positive - all).abs() < 1e-9);
    assert_eq!(negative, 0.0);
    // The pentagon in the middle, by its radius.
    let radius = 8.0 * (std::f64::consts::TAU / 5.0).cos() / (std::f64::consts::TAU / 10.0).cos();
    let pentagon = 2.5 * radius * radius * (std::f64::consts::TAU / 5.0).sin();
    assert!((twice - pentagon).abs() < 1e-6, "{twice} {pentagon}");
}

#[test]
fn liang_and_barsky_leave_the_area_that_sutherland_and_hodgman_leave() {
    let mut random = Random(21);
    let window = Rect::new(DVec2::ZERO, DVec2::splat(10.0)).unwrap();
    for round in 0..3000 {
        // Every other ring has integer coordinates: along borders, through corners, around the window.
        let point = |random: &mut Random| {
            let p = random.point(-8.0, 18.0);
            if round % 2 == 0 { p.round() } else { p }
        };
        let ring: Vec<DVec2> = (0..3 + round % 6).map(|_| point(&mut random)).collect();
        let mut steps = Recorder::default();
        let found = liang_barsky::clip(&window, &ring, &mut steps).unwrap();
        assert_eq!(liang_barsky::replay(steps.steps()), found);
        assert_eq!(liang_barsky::clip(&window, &ring, &mut NoTrace).unwrap(), found);
        let expected = sutherland_hodgman::clip(&window, &ring, &mut NoTrace).unwrap();
        agrees_with_maillot(&window, &ring, signed_area(&expected), &mut random);
        let (a, b) = (signed_area(&found), signed_area(&expected));
        assert!((a - b).abs() < 1e-9, "{ring:?}: {a} {b}");
        assert!(found.iter().all(|p| window.contains(p.clamp(DVec2::ZERO, DVec2::splat(10.0)))));
        assert!(found.iter().all(|p| p.cmpge(DVec2::splat(-1e-9)).all()));
        assert!(found.iter().all(|p| p.cmple(DVec2::splat(10.0 + 1e-9)).all()));
    }
}

/// Checks Maillot's ring: its area, its steps, and that its winding number around each point of the window is that of
/// the whole.
fn agrees_with_maillot(window: &Rect, ring: &[DVec2], area: f64, random: &mut Random) {
    let mut steps = Recorder::default();
    let found = maillot::clip(window, ring, &mut steps).unwrap();
    assert_eq!(maillot::replay(steps.steps()), found);
    assert_eq!(maillot::clip(window, ring, &mut NoTrace).unwrap(), found);
    assert!(found.iter().all(|p| window.contains(*p)), "{ring:?}: {found:?}");
    assert!((signed_area(&found) - area).abs() < 1e-9, "{ring:?}: {found:?}");
    if found.is_empty() {
        return;
    }
    for _ in 0..8 {
        let sample = random.point(0.001, 9.999);
        let turns = [ring, &found[..]].map(|ring| winding_number([ring], sample, &mut NoTrace));
        assert_eq!(turns[0], turns[1], "{ring:?}: {sample}");
    }
}

#[test]
fn far_rings_go_around_the_window_as_maillot_has_it() {
    let mut random = Random(34);
    let window = Rect::new(DVec2::ZERO, DVec2::splat(10.0)).unwrap();
    for round in 0..1500 {
        // Far enough for edges from corner to opposite corner beside the window.
        let ring: Vec<DVec2> = (0..3 + round % 6).map(|_| random.point(-30.0, 40.0)).collect();
        let expected = sutherland_hodgman::clip(&window, &ring, &mut NoTrace).unwrap();
        agrees_with_maillot(&window, &ring, signed_area(&expected), &mut random);
    }
}

#[test]
fn corners_between_the_regions_of_two_ends_are_turned_around() {
    use maillot::CornerReason::{Basic, BorderToBorder, BorderToCorner, CornerToCorner};
    let window = Rect::new(DVec2::ZERO, DVec2::splat(10.0)).unwrap();
    let turns = |from: [f64; 2], to: [f64; 2]| {
        let ring = [from, to].map(DVec2::from);
        let mut steps = Recorder::default();
        maillot::clip(&window, &ring, &mut steps).unwrap();
        // Those of the first edge.
        let edges = steps.steps().iter().skip(1);
        let first = edges.take_while(|step| !matches!(step, maillot::Step::Edge { .. }));
        let turn = |step: &maillot::Step| match *step {
            maillot::Step::Turn { corner, turn } => Some((corner.to_array(), turn)),
            _ => None,
        };
        first.filter_map(turn).collect::<Vec<_>>()
    };
    let [a, b, c, d] = [[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0]];
    assert_eq!(turns([-4.0, 3.0], [3.0, -4.0]), [(a, BorderToBorder)]);
    assert_eq!(turns([-2.0, 1.0], [12.0, -8.0]), [(a, BorderToCorner), (b, Basic)]);
    assert_eq!(turns([12.0, -8.0], [-2.0, 1.0]), [(a, BorderToCorner)]);
    // From corner to opposite corner, on both sides and in both directions of both diagonals.
    assert_eq!(turns([-9.0, -1.0], [11.0, 25.0]), [(d, CornerToCorner), (c, Basic)]);
    assert_eq!(turns([11.0, 25.0], [-9.0, -1.0]), [(d, CornerToCorner), (a, Basic)]);
    assert_eq!(turns([-1.0, -9.0], [25.0, 11.0]), [(b, CornerToCorner), (c, Basic)]);
    assert_eq!(turns([-9.0, 11.0], [11.0, -19.0]), [(a, CornerToCorner), (b, Basic)]);
    assert_eq!(turns([11.0, -19.0], [-9.0, 11.0]), [(a, CornerToCorner), (d, Basic)]);
    assert_eq!(turns([-1.0, 23.0], [23.0, -1.0]), [(c, CornerToCorner), (b, Basic)]);
    // Beyond a common border there are no turning points.
    assert_eq!(turns([-4.0, -4.0], [5.0, -4.0]), []);
}

#[test]
fn a_window_within_a_polygon_turns_at_its_four_corners() {
    let window = Rect::new(DVec2::ZERO, DVec2::splat(2.0)).unwrap();
    let around = [(-5.0, -5.0), (9.0, -5.0), (9.0, 9.0), (-5.0, 9.0)].map(DVec2::from);
    let mut steps = Recorder::default();
    let found = liang_barsky::clip(&window, &around, &mut steps).unwrap();
    assert_eq!(signed_area(&found), 4.0);
    let turns = steps.steps().iter().filter(|s| matches!(s, liang_barsky::Step::Turn(_)));
    assert_eq!(turns.count(), found.len());
    let beside = [(3.0, 3.0), (5.0, 3.0), (5.0, 5.0)].map(DVec2::from);
    assert!(liang_barsky::clip(&window, &beside, &mut NoTrace).unwrap().is_empty());
    let odd = [DVec2::ZERO, DVec2::new(f64::NAN, 1.0), DVec2::ONE];
    assert!(liang_barsky::clip(&window, &odd, &mut NoTrace).is_err());
}

#[test]
fn carpenters_masks_and_shares() {
    use durer::visibility::polygons::a_buffer::{
        FULL, FaceFragment, Step, edge_distance, ordered_mask, replay, resolve, seen_masks,
        visible_share, weights,
    };
    // E(x, y) = [ΔY (x − Xa) − ΔX (y − Ya)] / √(ΔX² + ΔY²).
    let edge = [DVec2::new(1.0, 2.0), DVec2::new(4.0, 6.0)];
    assert_eq!(edge_distance(edge, DVec2::new(6.0, 2.0)), Some(4.0));
    assert_eq!(edge_distance([DVec2::ONE; 2], DVec2::ZERO), None);
    // n = round(16 · area), and the samples deepest in the half-plane first: here the rows above y = ½.
    let level = [DVec2::new(1.0, 0.5), DVec2::new(0.0, 0.5)];
    assert_eq!(ordered_mask(level, 0.5).count_ones(), 8);
    assert_eq!([0.0, 1.0, 0.03, 0.04].map(|a| ordered_mask(level, a).count_ones()), [0, 16, 0, 1]);
    assert!([0x00ff, 0xff00].contains(&ordered_mask(level, 0.5)));
    // Disjoint in depth, and overlapping.
    assert_eq!(visible_share([1.0, 2.0], [3.0, 4.0]), 1.0);
    assert_eq!(visible_share([3.0, 4.0], [1.0, 2.0]), 0.0);
    assert_eq!(visible_share([1.0, 3.0], [2.0, 4.0]), 0.75);
    assert_eq!(visible_share([2.0, 2.0], [2.0, 2.0]), 0.5);
    // Two faces that intersect: P has the pixels where A is in front.
    let (a, b, front) = (0x0fff, 0xfff0, 0x00f0);
    assert_eq!(seen_masks(a, b, front), [0x00ff, 0xff00]);
    let [of_a, of_b] = seen_masks(a, b, front);
    assert_eq!((of_a & of_b, of_a | of_b), (0, a | b));
    let fragment =
        |mask, z, red: f32| FaceFragment { mask, z, color: Vec4::new(red, 0.0, 0.0, 1.0) };
    let all = [fragment(FULL, [2.0, 4.0], 0.0), fragment(0x00ff, [1.0, 3.0], 1.0)];
    let mut steps = Recorder::default();
    let (found, rest) = weights(&all, &mut steps);
    // The near half takes three quarters of its eight sub-pixels.
    assert_eq!((found.as_slice(), rest), (&[0.625, 0.375][..], 0.0));
    assert_eq!(replay(2, steps.steps()), (found, rest));
    let overlap = Step::Overlap { fragments: [1, 0], mask: 0x00ff, share: 0.75 };
    assert!(steps.steps().contains(&overlap));
    assert_eq!(resolve(&all, Vec4::ZERO, &mut NoTrace).x, 0.375);
    let half = [fragment(0x00ff, [1.0, 1.0], 1.0)];
    assert_eq!(resolve(&half, Vec4::ONE, &mut NoTrace), Vec4::new(1.0, 0.5, 0.5, 1.0));
    assert_eq!(weights(&[], &mut NoTrace), (vec![], 1.0));
}

#[test]
fn scan_beams_find_the_areas_that_the_overlay_finds() {
    use durer::clip::polygon::scan_beams::{Options, Step, Trapezoid, replay, scan_beams};
    use durer::clip::polygon::{
        BooleanOp, Shapes,
        overlay::{self, overlay},
    };
    let mut random = Random(31);
    for round in 0..60 {
        let mut ring = |n: usize| -> Vec<DVec2> {
            let point = |random: &mut Random| {
                let p = random.point(-9.0, 9.0);
                // Integers: horizontal edges, common vertices, collinear edges.
                if round % 3 == 0 { p.round() } else { p }
            };
            (0..n).map(|_| point(&mut random)).collect()
        };
        let subject = Shapes::from_rings([ring(3 + round % 5), ring(4)]);
        let clip = Shapes::from_rings([ring(3 + round % 4)]);
        for (&op, &rule) in
            BooleanOp::ALL.iter().flat_map(|op| WindingRule::ALL.iter().map(move |r| (op, r)))
        {
            let how = Options { subject_rule: rule, clip_rule: rule, ..Options::default() };
            let mut steps = Recorder::default();
            let parts = scan_beams(&subject, &clip, op, &how, &mut steps).unwrap();
            assert_eq!(replay(steps.steps()), parts);
            assert_eq!(scan_beams(&subject, &clip, op, &how, &mut NoTrace).unwrap(), parts);
            let area: f64 = parts.iter().map(Trapezoid::area).sum();
            let options = overlay::Options::with_rule(rule);
            let expected = overlay(&subject, &clip, op, &options, &mut NoTrace).unwrap().shapes;
            assert!(
                (area - expected.area()).abs() < 1e-4,
                "{op} {rule}, round {round}: {area} {}",
                expected.area()
            );
            assert!(parts.iter().all(|part| part.area() >= -1e-9));
            let minima = steps.steps().iter().filter(|s| matches!(s, Step::Minimum { .. }));
            assert!(minima.count() >= 1);
        }
    }
    let square =
        Shapes::from_rings([[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(DVec2::from)]);
    let none = Options { max_trapezoids: 0, ..Options::default() };
    assert!(scan_beams(&square, &square, BooleanOp::Union, &none, &mut NoTrace).is_err());
}

#[test]
fn a_beam_tells_minima_crossings_and_contributing_edges() {
    use durer::clip::polygon::scan_beams::{Step, scan_beams};
    use durer::clip::polygon::{BooleanOp, Shapes};
    let up = [(0.0, 0.0), (4.0, 0.0), (2.0, 4.0)].map(DVec2::from);
    let down = [(2.0, 0.0), (4.0, 4.0), (0.0, 4.0)].map(DVec2::from);
    let shapes = |ring: [DVec2; 3]| Shapes::from_rings([ring]);
    let mut steps = Recorder::default();
    let op = BooleanOp::Intersection;
    let none = Default::default();
    let parts = scan_beams(&shapes(up), &shapes(down), op, &none, &mut steps).unwrap();
    let steps = steps.steps();
    let at = |x: f64, y: f64| DVec2::new(x, y);
    assert_eq!(steps[0], Step::Minimum { at: at(4.0, 0.0), clip: false });
    assert_eq!(steps[1], Step::Minimum { at: at(2.0, 0.0), clip: true });
    assert_eq!(steps[2], Step::Beam { y: [0.0, 4.0], active: 4 });
    assert_eq!(steps[3], Step::Crossing { at: at(1.0, 2.0) });
    assert_eq!(steps[4], Step::Crossing { at: at(3.0, 2.0) });
    let active: Vec<_> = steps
        .iter()
        .filter_map(|s| match *s {
            Step::Active { winding, contributes, .. } => Some((winding, contributes)),
            _ => None,
        })
        .collect();
    // Below the crossings the clip's edges contribute, above them the subject's.
    let expected = [([1, 0], false), ([1, 1], true), ([1, 0], true), ([0, 0], false)];
    assert_eq!(active[..4], expected);
    let expected = [([0, 1], false), ([1, 1], true), ([0, 1], true), ([0, 0], false)];
    assert_eq!(active[4..], expected);
    assert_eq!(parts.iter().map(|part| part.area()).sum::<f64>(), 4.0);
}

fn area_of(ring: &[DVec2]) -> f64 {
    signed_area(ring).abs()
}

/// Checks that ears cover the polygon, in the number given by the formula, whatever the direction of the rings, and
/// that rejected corners are named.
#[test]
fn ears_cover_polygons_with_holes() {
    let mut random = Random(31);
    for round in 0..60 {
        // A star around the origin, and square holes within its smallest radius.
        let count = 5 + round % 9;
        let star: Vec<DVec2> = (0..count)
            .map(|k| {
                let turn = f64::from(k) / f64::from(count) * std::f64::consts::TAU;
                DVec2::from_angle(turn) * (10.0 + random.point(0.0, 12.0).x)
            })
            .collect();
        let square = |x: f64, y: f64| {
            [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|(u, v)| DVec2::new(x + u, y + v))
        };
        let holes: Vec<[DVec2; 4]> = [square(-2.5, -0.5), square(0.5, 1.0), square(1.0, -2.0)]
            [..(round % 4) as usize]
            .to_vec();
        let mut contours = Contours::new();
        let ring = |points: &[DVec2], turned: bool| -> Vec<DVec2> {
            if turned { points.iter().rev().copied().collect() } else { points.to_vec() }
        };
        contours.push(ring(&star, round % 2 == 1), true);
        holes.iter().for_each(|hole| contours.push(ring(hole, round % 3 == 1), true));
        let mut steps = Recorder::default();
        let found = ears(&contours, &mut steps);
        assert_eq!(ears(&contours, &mut NoTrace), found);
        let corners = star.len() + 4 * holes.len();
        assert_eq!(found.triangles.len(), corners + 2 * holes.len() - 2, "round {round}");
        let expected = area_of(&star) - holes.len() as f64;
        assert!((found.area() - expected).abs() < 1e-9 * expected, "round {round}");
        let at = |corners: [u32; 3]| corners.map(|corner| found.points[corner as usize]);
        let mut triangles = Vec::new();
        for step in steps.steps() {
            match *step {
                Ear::Triangle(corners) => triangles.push(corners),
                Ear::Reflex { corners, cross } => {
                    let [a, b, c] = at(corners);
                    assert!(cross <= 0.0 && ((b - a).perp_dot(c - b) - cross).abs() < 1e-9);
                }
                Ear::Blocked { corners, by } => {
                    let weights = barycentric_2d(at(corners), found.points[by as usize]).unwrap();
                    assert!(weights.iter().all(|weight| *weight >= -1e-9));
                }
                Ear::Bridge(_) | Ear::Point(_) => {}
            }
        }
        assert_eq!(triangles, found.triangles);
        // No triangle is reversed or overlaps another.
        assert!(triangles.iter().all(|corners| signed_area(&at(*corners)) > 0.0), "round {round}");
    }
    // Rings that cross terminate too.
    let bow = [(0.0, 0.0), (4.0, 4.0), (4.0, 0.0), (0.0, 4.0)].map(DVec2::from);
    assert_eq!(ears(&Contours::polygon(bow), &mut NoTrace).triangles.len(), 2);
    let line = [(0.0, 0.0), (1.0, 1.0), (2.0, 2.0), (3.0, 3.0)].map(DVec2::from);
    assert_eq!(ears(&Contours::polygon(line), &mut NoTrace).triangles.len(), 2);
    assert!(ears(&Contours::new(), &mut NoTrace).triangles.is_empty());
}
