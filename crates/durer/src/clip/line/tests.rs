//! Laws of all line clippers, on coordinates where segments touch and on coordinates of all sizes.

use super::*;
use crate::clip::exact;
use crate::math::{DVec3, IVec2, Plane, orient2d_value};
use crate::trace::Recorder;
use proptest::prelude::*;
use std::cmp::Ordering;

const FLOAT: [LineClipper; 7] = [
    LineClipper::CohenSutherland,
    LineClipper::CyrusBeck,
    LineClipper::LiangBarsky,
    LineClipper::NichollLeeNicholl,
    LineClipper::Skala,
    LineClipper::SobkowPospisilYang,
    LineClipper::Homogeneous,
];

/// Returns coordinates of one family: a tiny grid where everything touches, or numbers of every size.
fn coordinate(family: usize) -> BoxedStrategy<f64> {
    match family {
        0 => (-3i32..=3).prop_map(f64::from).boxed(),
        1 => (-3i32..=3).prop_map(|v| f64::from(v) * 0.1).boxed(),
        2 => (any::<bool>(), -9.0..12.0f64)
            .prop_map(|(minus, e)| if minus { -1.0 } else { 1.0 } * libm::exp10(e))
            .boxed(),
        3 => (-10i32..=10).prop_map(|v| f64::from(v) * 1.5e307).boxed(),
        4 => (-3i64..=3).prop_map(|v| v as f64 * f64::from_bits(1)).boxed(),
        _ => prop_oneof![
            Just(0.0),
            Just(-0.0),
            Just(1e300),
            Just(-1e300),
            Just(5e-324),
            Just(1.0),
            Just(1.0 + f64::EPSILON),
            -2.0..2.0f64,
        ]
        .boxed(),
    }
}

const FAMILIES: std::ops::Range<usize> = 0..6;

fn point(family: usize) -> impl Strategy<Value = DVec2> {
    (coordinate(family), coordinate(family)).prop_map(|(x, y)| DVec2::new(x, y))
}

fn case() -> impl Strategy<Value = (Rect, Segment<DVec2>)> {
    FAMILIES.prop_flat_map(|f| (point(f), point(f), point(f), point(f))).prop_map(|(a, b, p, q)| {
        let (min, max) =
            (DVec2::new(a.x.min(b.x), a.y.min(b.y)), DVec2::new(a.x.max(b.x), a.y.max(b.y)));
        (Rect::new(min, max).unwrap(), Segment::new(p, q))
    })
}

/// Returns whether a closed segment and a rectangle meet: neither an axis nor the segment's normal separates them.
fn meets(w: &Rect, s: &Segment<DVec2>) -> bool {
    let Some(around) = Rect::around([s.start, s.end]) else { return false };
    let (min, max) = (w.min(), w.max());
    let corners = [min, DVec2::new(max.x, min.y), max, DVec2::new(min.x, max.y)];
    let sides = corners.map(|c| exact::side(s.start, s.end, c));
    let one_side = |o: Ordering| sides.iter().all(|&s| s == o);
    w.overlaps(&around) && !one_side(Ordering::Less) && !one_side(Ordering::Greater)
}

/// Returns 4 ulp of the largest coordinate involved.
fn tolerance(w: &Rect, s: &Segment<DVec2>) -> f64 {
    let largest = [w.min(), w.max(), s.start, s.end]
        .iter()
        .fold(0.0f64, |m, p| m.max(p.x.abs()).max(p.y.abs()));
    4.0 * (largest.next_up() - largest).min(largest - largest.next_down()).max(f64::from_bits(1))
}

fn bits(s: Option<Segment<DVec2>>) -> Option<[u64; 4]> {
    s.map(|s| [s.start.x, s.start.y, s.end.x, s.end.y].map(f64::to_bits))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60_000))]

    #[test]
    fn rectangle_clippers_obey_the_laws((w, s) in case()) {
        let expected = meets(&w, &s);
        let tol = tolerance(&w, &s);
        let reference = LineClipper::LiangBarsky.clip(&w, s).unwrap();
        for a in FLOAT {
            let got = a.clip(&w, s).unwrap();
            prop_assert_eq!(got.is_some(), expected, "{} accepts wrongly", a);
            let back = a.clip(&w, s.reversed()).unwrap().map(Segment::reversed);
            if s.start != s.end {
                prop_assert_eq!(bits(back), bits(got), "{} depends on the direction", a);
            }
            let (Some(got), Some(reference)) = (got, reference) else { continue };
            prop_assert!(w.contains(got.start) && w.contains(got.end), "{} leaves the window", a);
            prop_assert_eq!(bits(a.clip(&w, got).unwrap()), bits(Some(got)), "{} twice", a);
            for (p, q, original) in [(got.start, reference.start, s.start), (got.end, reference.end, s.end)] {
                prop_assert!(((p - q) * 0.25).abs().max_element() <= tol * 0.25, "{}: {} {}", a, p, q);
                if w.contains(original) {
                    prop_assert_eq!(p.to_array().map(f64::to_bits), original.to_array().map(f64::to_bits));
                }
            }
            if !matches!(a, LineClipper::CyrusBeck | LineClipper::Homogeneous) {
                prop_assert_eq!(bits(Some(got)), bits(Some(reference)), "{}", a);
            }
        }
    }

    #[test]
    fn cut_points_lie_on_the_segment((w, s) in case()) {
        let length = (s.end - s.start).abs().max_element();
        if !(1e-100..1e100).contains(&length) {
            return Ok(());
        }
        if let Some(got) = LineClipper::CohenSutherland.clip(&w, s).unwrap() {
            for p in [got.start, got.end] {
                // Twice the triangle's area is the longer extent times the offset along the other axis.
                let off = orient2d_value(s.start, s.end, p).abs() / length;
                prop_assert!(off <= tolerance(&w, &s), "{} is off by {}", p, off);
            }
        }
    }

    #[test]
    fn steps_rebuild_the_result((w, s) in case()) {
        let mut steps = Recorder::default();
        let got = cohen_sutherland::clip(&w, s, &mut steps).unwrap();
        prop_assert_eq!(bits(got), bits(LineClipper::CohenSutherland.clip(&w, s).unwrap()));
        prop_assert_eq!(bits(cohen_sutherland::replay(s, steps.steps())), bits(got));
        let mut steps = Recorder::default();
        let got = liang_barsky::clip(&w, s, &mut steps).unwrap();
        prop_assert_eq!(bits(liang_barsky::replay(s, steps.steps())), bits(got));
        let mut steps = Recorder::default();
        let got = cyrus_beck::clip(&w, s, &mut steps).unwrap();
        prop_assert_eq!(bits(cyrus_beck::replay(s, steps.steps())), bits(got));
        let mut steps = Recorder::default();
        let got = nicholl_lee_nicholl::clip(&w, s, &mut steps).unwrap();
        prop_assert_eq!(bits(nicholl_lee_nicholl::replay(s, steps.steps())), bits(got));
        let mut steps = Recorder::default();
        let got = skala::clip(&w, s, &mut steps).unwrap();
        prop_assert_eq!(bits(skala::replay(s, steps.steps())), bits(got));
        let mut steps = Recorder::default();
        let got = sobkow_pospisil_yang::clip(&w, s, &mut steps).unwrap();
        prop_assert_eq!(bits(sobkow_pospisil_yang::replay(s, steps.steps())), bits(got));
        let mut steps = Recorder::default();
        let got = homogeneous::clip(&w, s, &mut steps).unwrap();
        let lifted = Segment::new(s.start.extend(1.0), s.end.extend(1.0));
        let rebuilt = homogeneous::replay(lifted, steps.steps());
        let places = rebuilt.map(|s| Segment::new(s.start.truncate(), s.end.truncate()));
        prop_assert_eq!(bits(places), bits(got));
    }

    /// Checks that points of any positive weight represent the same positions; exact if weights are powers of two.
    #[test]
    fn weights_do_not_move_places((w, s) in case(), k in prop::array::uniform2(-3i32..=3)) {
        let weights = k.map(|k| libm::scalbn(1.0, k));
        let lift = |p: DVec2, w: f64| (p * w).extend(w);
        let lifted = Segment::new(lift(s.start, weights[0]), lift(s.end, weights[1]));
        let scaled_back = (lifted.start / weights[0]).truncate() == s.start && (lifted.end / weights[1]).truncate() == s.end;
        if !scaled_back {
            return Ok(());
        }
        let expected = LineClipper::CyrusBeck.clip(&w, s).unwrap();
        let got = homogeneous::clip_homogeneous(&w, lifted, &mut NoTrace).unwrap();
        prop_assert_eq!(got.is_some(), expected.is_some());
        let Some((got, expected)) = got.zip(expected) else { return Ok(()) };
        for (p, q) in [(got.start, expected.start), (got.end, expected.end)] {
            prop_assert!(p.z > 0.0);
            let place = p.truncate() * (0.25 / p.z);
            // Weights from 1/8 to 8 make an ulp of a coordinate 64 ulps of the position.
            prop_assert!((place - q * 0.25).abs().max_element() <= 64.0 * tolerance(&w, &s), "{} {}", p, q);
        }
    }

    /// Checks that the visible part of a segment that ends behind the eye goes to infinity.
    #[test]
    fn what_runs_behind_the_eye_is_a_ray((w, s) in case()) {
        let direction = s.end;
        let sizes = [w.min(), w.max(), s.start, s.end].map(|p| p.abs().max_element());
        // Where start and direction nearly cancel, the segment passes through the null vector, or so near to it that w
        // rounds to 0 at the cut.
        if sizes.iter().any(|&size| size > 1e6) || (s.start + direction).abs().max_element() < 1e-9 {
            return Ok(());
        }
        let lifted = Segment::new(s.start.extend(1.0), direction.extend(-1.0));
        let got = homogeneous::clip_homogeneous(&w, lifted, &mut NoTrace).unwrap();
        // The position at t is (start + t (direction − start)) / (1 − 2t), before t = ½.
        let ray = HalfPlane::of_rect(&w);
        let far = s.start + (s.start + direction) * 1e9;
        let expected = liang_barsky::clip_half_planes(&ray, Segment::new(s.start, far), &mut NoTrace).unwrap();
        // Rounding of the far end may decide at a corner.
        if let Some((got, expected)) = got.zip(expected) {
            for (p, q) in [(got.start, expected.start), (got.end, expected.end)] {
                // A coordinate is off by some ulp of the largest at the ends; a small w enlarges that.
                let largest = s.start.abs().max(s.end.abs()).max_element().max(1.0);
                let off = 8.0 * f64::EPSILON * largest * (1.0 + q.abs().max_element()) / p.z;
                let off = off + 16.0 * tolerance(&w, &Segment::new(s.start, far));
                prop_assert!((p.truncate() / p.z - q).abs().max_element() <= off, "{} {}", p, q);
            }
        }
        prop_assert!(!w.contains(s.start) || got.is_some());
    }
}

fn point3(family: usize) -> impl Strategy<Value = DVec3> {
    (point(family), coordinate(family)).prop_map(|(p, z)| p.extend(z))
}

fn planes(min: DVec3, max: DVec3) -> Vec<Plane> {
    let axes = [DVec3::X, DVec3::Y, DVec3::Z];
    axes.iter().flat_map(|&n| [Plane::through(min, n), Plane::through(max, -n)]).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(10_000))]

    #[test]
    fn box_clippers_agree((a, b, p, q) in (0..4usize).prop_flat_map(|f| (point3(f), point3(f), point3(f), point3(f)))) {
        let (min, max) = (a.min(b), a.max(b));
        let window = ClipBox::<3>::new(min, max).unwrap();
        let s = Segment::new(p, q);
        let t = &mut NoTrace;
        let [cs, lb] = [cohen_sutherland::clip_box(&window, s, t), liang_barsky::clip_box(&window, s, t)].map(Result::unwrap);
        prop_assert_eq!(cs, lb);
        let back = cohen_sutherland::clip_box(&window, s.reversed(), t).unwrap().map(Segment::reversed);
        prop_assert_eq!(back, cs);
        let cb = cyrus_beck::clip_polyhedron(&planes(min, max), s, t).unwrap();
        prop_assert_eq!(cb.is_some(), cs.is_some());
        let Some((cb, cs)) = cb.zip(cs) else { return Ok(()) };
        prop_assert_eq!(cohen_sutherland::clip_box(&window, cs, t).unwrap(), Some(cs));
        let largest = [min, max, p, q].iter().fold(0.0f64, |m, v| m.max(v.abs().max_element()));
        let off = ((cb.start - cs.start) * 0.125).abs().max((cb.end - cs.end) * 0.125).max_element();
        prop_assert!(off <= largest * 0.125 * 4.0 * f64::EPSILON, "{:?} {:?}", cb, cs);
    }

    #[test]
    fn convex_polygons_obey_the_laws(
        (cloud, p, q) in (0..3usize).prop_flat_map(|f| (prop::collection::vec(point(f), 3..9), point(f), point(f))),
    ) {
        let Some(window) = hull(cloud) else { return Ok(()) };
        let (s, t) = (Segment::new(p, q), &mut NoTrace);
        let got = cyrus_beck::clip_polygon(&window, s, t).unwrap();
        prop_assert_eq!(got.is_some(), meets_polygon(&window, &s));
        let back = cyrus_beck::clip_polygon(&window, s.reversed(), t).unwrap().map(Segment::reversed);
        prop_assert_eq!(got, back);
        let mut steps = Recorder::default();
        let by_signs = skala::clip_polygon(&window, s, &mut steps).unwrap();
        prop_assert_eq!(skala::replay(s, steps.steps()), by_signs);
        prop_assert_eq!(by_signs.is_some(), got.is_some());
        if let (Some(a), Some(b)) = (by_signs, got) {
            let largest = p.abs().max(q.abs()).max_element();
            let off = (a.start - b.start).abs().max((a.end - b.end).abs()).max_element();
            prop_assert!(off <= largest * 64.0 * f64::EPSILON || !is_thick(&window), "{:?} {:?}", a, b);
        }
        if let Some(got) = got {
            if is_thick(&window) {
                let twice = cyrus_beck::clip_polygon(&window, got, t).unwrap();
                prop_assert_eq!(twice, Some(got), "{:?}", window);
            }
            let mut steps = Recorder::default();
            cyrus_beck::clip_polygon(&window, s, &mut steps).unwrap();
            prop_assert_eq!(cyrus_beck::replay(s, steps.steps()), Some(got));
        }
    }

    #[test]
    fn half_planes_agree_with_the_rectangle((w, s) in case()) {
        let planes = HalfPlane::of_rect(&w);
        let mut steps = Recorder::default();
        let got = liang_barsky::clip_half_planes(&planes, s, &mut steps).unwrap();
        prop_assert_eq!(bits(got), bits(LineClipper::CyrusBeck.clip(&w, s).unwrap()));
        prop_assert_eq!(bits(liang_barsky::replay(s, steps.steps())), bits(got));
    }

    #[test]
    fn midpoint_stays_within_a_pixel(v in prop::array::uniform8(-40i32..40)) {
        let p = |i: usize| IVec2::new(v[i], v[i + 1]);
        midpoint_laws(p(0).min(p(2)), p(0).max(p(2)), Segment::new(p(4), p(6)))?;
    }

    #[test]
    fn midpoint_takes_all_of_i32(v in prop::array::uniform8(any::<i32>())) {
        let p = |i: usize| IVec2::new(v[i], v[i + 1]);
        midpoint_laws(p(0).min(p(2)), p(0).max(p(2)), Segment::new(p(4), p(6)))?;
    }
}

/// Returns the convex hull by Andrew's monotone chain.
fn hull(mut cloud: Vec<DVec2>) -> Option<ConvexPolygon> {
    cloud.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    let half = |points: &mut dyn Iterator<Item = &DVec2>| {
        let mut chain: Vec<DVec2> = Vec::new();
        for &p in points {
            while let [.., a, b] = chain[..]
                && exact::side(a, b, p) != Ordering::Greater
            {
                chain.pop();
            }
            chain.push(p);
        }
        chain.pop();
        chain
    };
    let mut ring = half(&mut cloud.iter());
    ring.extend(half(&mut cloud.iter().rev()));
    ConvexPolygon::new(&ring).ok()
}

/// Returns whether the window is wider than some ulps, so that there are numbers inside near every
/// cut.
fn is_thick(w: &ConvexPolygon) -> bool {
    let ring = w.vertices();
    let size = ring.iter().fold(0.0f64, |m, v| m.max(v.abs().max_element()));
    (0..ring.len()).all(|i| {
        let (a, b) = (ring[i], ring[(i + 1) % ring.len()]);
        let height = |v: &DVec2| orient2d_value(a, b, *v) / (b - a).length();
        ring.iter().map(height).fold(0.0, f64::max) > size * 1e-12
    })
}

fn meets_polygon(w: &ConvexPolygon, s: &Segment<DVec2>) -> bool {
    let sides: Vec<_> = w.vertices().iter().map(|&v| exact::side(s.start, s.end, v)).collect();
    let separated_by_segment = s.start != s.end
        && [Ordering::Less, Ordering::Greater].iter().any(|o| sides.iter().all(|s| s == o));
    let ring = w.vertices();
    let separated_by_edge = (0..ring.len()).any(|i| {
        let (a, b) = (ring[i], ring[(i + 1) % ring.len()]);
        [s.start, s.end].iter().all(|&p| exact::side(a, b, p) == Ordering::Less)
    });
    !separated_by_segment && !separated_by_edge
}

fn midpoint_laws(min: IVec2, max: IVec2, s: Segment<IVec2>) -> Result<(), TestCaseError> {
    let window = midpoint::PixelWindow::new(min, max).unwrap();
    let mut steps = Recorder::default();
    let got = midpoint::clip(&window, s, &mut steps);
    prop_assert_eq!(midpoint::replay(s, steps.steps()), got);
    let back = midpoint::clip(&window, s.reversed(), &mut NoTrace).map(Segment::reversed);
    prop_assert_eq!(back, got);

    // Halvings: at most ⌈log2 n⌉ for each end.
    let halvings =
        steps.steps().iter().filter(|s| matches!(s, midpoint::Step::Halved { .. })).count();
    let n = s.start.x.abs_diff(s.end.x).max(s.start.y.abs_diff(s.end.y)).max(1);
    let log = u64::from(n).next_power_of_two().trailing_zeros() as usize;
    prop_assert!(halvings <= 2 * log, "{} halvings, n = {}", halvings, n);

    // Exact cuts give points within a pixel, except for segments that pass a corner so closely.
    let wide = |v: IVec2| v.as_dvec2();
    let rect = |grow: f64| Rect::new(wide(min) - grow, wide(max) + grow);
    let exact = |w: Rect| {
        cohen_sutherland::clip(&w, Segment::new(wide(s.start), wide(s.end)), &mut NoTrace).unwrap()
    };
    if exact(rect(1.0).unwrap()).is_none() {
        prop_assert!(got.is_none());
    }
    if rect(-1.0).is_ok_and(|w| exact(w).is_some()) {
        prop_assert!(got.is_some());
    }
    let Some(got) = got else { return Ok(()) };
    prop_assert_eq!(midpoint::clip(&window, got, &mut NoTrace), Some(got));
    let length = wide(s.end) - wide(s.start);
    for p in [got.start, got.end] {
        prop_assert!(p.cmpge(min).all() && p.cmple(max).all());
        let across = length.perp_dot(wide(p) - wide(s.start)).abs();
        prop_assert!(across <= (length.x.abs() + length.y.abs()) * (0.5 + 1e-6), "{}", p);
    }
    Ok(())
}

#[test]
fn non_finite_ends_are_errors() {
    let w = Rect::new(DVec2::ZERO, DVec2::ONE).unwrap();
    let good = DVec2::splat(0.5);
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY].map(|v| DVec2::new(0.0, v)) {
        for a in FLOAT {
            let error = |s| a.clip(&w, s).unwrap_err();
            let expected = |index| Error::NonFinite { what: "segment end point", index };
            assert_eq!(error(Segment::new(bad, good)), expected(0), "{a}");
            assert_eq!(error(Segment::new(good, bad)), expected(1), "{a}");
        }
    }
}

#[test]
fn names_are_read_back() {
    for &a in LineClipper::ALL {
        assert_eq!(a.name().parse(), Ok(a));
    }
    assert!("sutherland".parse::<LineClipper>().is_err());
}

#[test]
fn in_the_tip_of_a_needle_the_smaller_coordinate_has_numbers_inside() {
    let p = DVec2::new;
    let tip = p(-187_399_625_501.856_45, 5.074_507_911_728_825e-6);
    let ring = [tip, p(452_969_585_983.105_16, -608_884.956_942_382), p(1.0, 1.0)];
    let ends = [
        p(-238_774_825_123.150_73, 3.286_452_362_468_028_7e-9),
        p(2_734.282_439_447_801_6, 6.614_489_055_946_68e-8),
    ];
    // The same case mirrored at both axes, and with the axes exchanged.
    let turns: [fn(DVec2) -> DVec2; 3] = [|p| p, |p| -p, |p| DVec2::new(p.y, p.x)];
    for turn in turns {
        let window = ConvexPolygon::new(&ring.map(turn)).unwrap();
        let s = Segment::new(turn(ends[0]), turn(ends[1]));
        let got = cyrus_beck::clip_polygon(&window, s, &mut NoTrace).unwrap().unwrap();
        let inside =
            |p: DVec2| window.edges().iter().all(|e| e.sign(p.to_array()) != Ordering::Less);
        assert!(inside(got.start) && inside(got.end), "{got:?}");
        let twice = cyrus_beck::clip_polygon(&window, got, &mut NoTrace).unwrap();
        assert_eq!(bits(twice), bits(Some(got)));
        // The exact crossing, up to some ulps of the larger coordinate.
        let expected = turn(p(-187_399_625_496.537, 1.681e-8));
        assert!((got.start - expected).abs().max_element() < 1e-3, "{got:?}");
    }
}

#[test]
fn rings_that_are_not_convex_are_refused() {
    let p = DVec2::new;
    let square = [p(0.0, 0.0), p(1.0, 0.0), p(1.0, 1.0), p(0.0, 1.0)];
    let clockwise: Vec<_> = square.iter().rev().copied().collect();
    assert_eq!(ConvexPolygon::new(&clockwise).unwrap().vertices().len(), 4);
    let pentagram = [0, 2, 4, 1, 3].map(|k| {
        let a = f64::from(k) * std::f64::consts::TAU / 5.0;
        p(libm::cos(a), libm::sin(a))
    });
    let dent = [p(0.0, 0.0), p(2.0, 0.0), p(0.5, 0.5), p(0.0, 2.0)];
    let flat = [p(0.0, 0.0), p(1.0, 1.0), p(2.0, 2.0)];
    for bad in [&pentagram[..], &dent, &flat, &[]] {
        assert!(ConvexPolygon::new(bad).is_err(), "{bad:?}");
    }
}

mod batches {
    use super::*;
    use crate::clip::line::batch::{Clipped, Options, Segments, clip};
    use crate::simd::levels;

    fn check(w: &Rect, segments: &[Segment<DVec2>]) {
        let array = |f: fn(&Segment<DVec2>) -> f64| segments.iter().map(f).collect::<Vec<_>>();
        let (x0, y0) = (array(|s| s.start.x), array(|s| s.start.y));
        let (x1, y1) = (array(|s| s.end.x), array(|s| s.end.y));
        let input = Segments { x0: &x0, y0: &y0, x1: &x1, y1: &y1 };
        for level in levels() {
            for threads in [false, true] {
                let mut out = Clipped::default();
                clip(w, input, &Options { level, threads }, &mut out).unwrap();
                let mut bad = Vec::new();
                for (i, &s) in segments.iter().enumerate() {
                    let one = liang_barsky::clip(w, s, &mut NoTrace);
                    if one.is_err() {
                        bad.push(i);
                    }
                    let one = one.ok().flatten();
                    assert_eq!(out.is_accepted(i), one.is_some(), "{w:?} {s:?}");
                    let point = |x: &[f64], y: &[f64]| DVec2::new(x[i], y[i]);
                    let got = Segment::new(point(&out.x0, &out.y0), point(&out.x1, &out.y1));
                    assert_eq!(bits(Some(got)), bits(Some(one.unwrap_or(s))), "{w:?} {s:?}");
                }
                assert_eq!(out.non_finite, bad);
                let expected: Vec<_> = out.iter().collect();
                let kept = out.compact();
                let compacted: Vec<_> = out.iter().collect();
                assert_eq!(compacted.len(), kept.len());
                for ((i, s), (k, e)) in compacted.iter().map(|(i, s)| (kept[*i], s)).zip(expected) {
                    assert_eq!((i, *s), (k, e));
                }
            }
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(1000))]

        #[test]
        fn equal_the_scalar_clipper(
            (a, b, points) in FAMILIES.prop_flat_map(|f| (point(f), point(f), prop::collection::vec((point(f), point(f)), 0..80))),
            bad in 0..100usize,
        ) {
            let w = Rect::around([a, b]).unwrap();
            let mut segments: Vec<_> = points.iter().map(|&(p, q)| Segment::new(p, q)).collect();
            if let Some(s) = segments.get_mut(bad) {
                s.end.y = f64::NAN;
            }
            check(&w, &segments);
        }
    }

    #[test]
    fn long_batches_are_joined_in_order() {
        let w = Rect::new(DVec2::splat(-0.5), DVec2::splat(0.5)).unwrap();
        let mut state = 1u64;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        };
        let mut segments: Vec<_> = (0..100_001)
            .map(|_| Segment::new(DVec2::new(next(), next()), DVec2::new(next(), next())))
            .collect();
        segments[70_000].start.x = f64::INFINITY;
        segments[100_000].start.y = f64::NAN;
        check(&w, &segments);
    }

    #[test]
    fn arrays_of_different_lengths_are_an_error() {
        let w = Rect::new(DVec2::ZERO, DVec2::ONE).unwrap();
        let input = Segments { x0: &[0.0], y0: &[], x1: &[0.0], y1: &[0.0] };
        assert!(clip(&w, input, &Options::default(), &mut Clipped::default()).is_err());
    }
}
