//! Curves fitted to polylines: their kinds, their distance from the points, and their ends.

use durer::curve::fit::{Fitted, Options, Polyline, fit};
use durer::curve::pieces;
use durer::math::DVec2;
use durer::target::{Curve, CurvePiece, EllipticArc};
use std::f64::consts::{PI, TAU};

const TOLERANCE: f64 = 0.02;

fn fitted(points: &[DVec2], closed: bool, kept: &[bool], round: bool) -> Fitted {
    let polyline = Polyline { points, closed, kept };
    fit(polyline, |_, _| false, Options { tolerance: TOLERANCE, round }).expect("a curve")
}

fn round(points: &[DVec2], closed: bool) -> Curve {
    fitted(points, closed, &[], true).curve
}

/// Returns a regular polygon.
fn polygon(sides: u32, radius: f64) -> Vec<DVec2> {
    let angle = |i: u32| f64::from(i) * TAU / f64::from(sides) + 0.3;
    (0..sides).map(|i| DVec2::new(50.0, 40.0) + unit(angle(i)) * radius).collect()
}

fn unit(angle: f64) -> DVec2 {
    DVec2::new(libm::cos(angle), libm::sin(angle))
}

fn letters(curve: &Curve) -> String {
    let letter = |p: &CurvePiece| match p {
        CurvePiece::Line(_) => 'L',
        CurvePiece::Arc(arc, _) if arc.is_circular() => 'A',
        CurvePiece::Arc(..) => 'E',
        CurvePiece::Cubic(..) => 'C',
    };
    curve.pieces.iter().map(letter).collect()
}

/// Returns the distance of a point from a chain of chords.
fn distance(p: DVec2, chain: &[DVec2], closed: bool) -> f64 {
    let chords = chain.len() - usize::from(!closed);
    let to = |i: usize| {
        let (a, b) = (chain[i], chain[(i + 1) % chain.len()]);
        let t = ((p - a).dot(b - a) / (b - a).length_squared().max(1e-300)).clamp(0.0, 1.0);
        p.distance(a + (b - a) * t)
    };
    (0..chords).map(to).fold(f64::INFINITY, f64::min)
}

#[test]
fn round_polygons_are_circles_and_others_stay() {
    for (sides, radius) in [(12, 5.0), (24, 20.0), (40, 8.0), (720, 90.0)] {
        let curve = round(&polygon(sides, radius), true);
        let circle = curve.whole().unwrap_or_else(|| panic!("{sides} sides"));
        assert!(circle.is_circular() && circle.center.distance(DVec2::new(50.0, 40.0)) < 1e-9);
        assert!((circle.axis.length() - radius).abs() < 1e-9);
        assert_eq!(curve.start, curve.pieces[0].end());
    }
    for sides in [3, 4, 6, 8, 10] {
        assert_eq!(letters(&round(&polygon(sides, 10.0), true)), "L".repeat(sides as usize));
    }
    // Where facets do not approximate anything round, curves stay as close as the tolerance requires.
    let strict = fitted(&polygon(24, 20.0), true, &[], false).curve;
    assert_eq!(letters(&strict), "L".repeat(24));
}

#[test]
fn circles_seen_at_an_angle_are_ellipses() {
    let turned = unit(0.4);
    let points: Vec<DVec2> = polygon(48, 10.0)
        .iter()
        .map(|p| turned.rotate((*p - DVec2::new(50.0, 40.0)) * DVec2::new(1.0, 0.35)))
        .collect();
    let curve = round(&points, true);
    let ellipse = curve.whole().expect("an ellipse");
    assert!(!ellipse.is_circular());
    assert!((ellipse.radii() - DVec2::new(10.0, 3.5)).abs().max_element() < 1e-6);
    assert!(ellipse.axis.normalize().perp_dot(turned).abs() < 1e-7);
    // Half of it is an arc of the same.
    let half = round(&points[..25], false);
    let [CurvePiece::Arc(arc, end)] = half.pieces[..] else { panic!("{half:?}") };
    assert!((arc.radii() - DVec2::new(10.0, 3.5)).abs().max_element() < 1e-6);
    assert_eq!((half.start, end), (points[0], points[24]));
}

/// Returns a slot: two half circles of this many chords, and lines.
fn slot(chords: u32) -> Vec<DVec2> {
    let half = |x: f64, from: f64| {
        let angle = move |i: u32| from + f64::from(i) * PI / f64::from(chords);
        (0..=chords).map(move |i| DVec2::new(x, 0.0) + unit(angle(i)) * 4.0)
    };
    half(30.0, -PI / 2.0).chain(half(0.0, PI / 2.0)).collect()
}

#[test]
fn slots_and_rounded_corners_are_lines_and_arcs() {
    for chords in [6, 9, 40] {
        let curve = round(&slot(chords), true);
        let mut found = letters(&curve);
        // It begins at an arbitrary point.
        found.sort_desc();
        assert_eq!(found, "LLAA", "{chords}");
        for piece in &curve.pieces {
            if let CurvePiece::Arc(arc, _) = piece {
                assert!(
                    (arc.axis.length() - 4.0).abs() < 1e-9 && (arc.turn.abs() - PI).abs() < 1e-9
                );
            }
        }
    }
}

trait SortDesc {
    fn sort_desc(&mut self);
}

impl SortDesc for String {
    fn sort_desc(&mut self) {
        let mut letters: Vec<char> = self.chars().collect();
        letters.sort_unstable_by(|a, b| b.cmp(a));
        *self = letters.into_iter().collect();
    }
}

#[test]
fn corners_and_kept_points_are_ends_of_pieces() {
    let points = polygon(40, 8.0);
    let mut kept = vec![false; 40];
    (kept[7], kept[19]) = (true, true);
    let found = fitted(&points, true, &kept, true);
    assert_eq!(letters(&found.curve), "AA");
    assert_eq!(found.from, [7, 19]);
    assert_eq!(found.curve.start, points[7]);
    assert_eq!(found.curve.pieces[0].end(), points[19]);
    assert_eq!(found.curve.pieces[1].end(), points[7]);
    // A circle begins at the end of the one line that ends on it.
    kept[7] = false;
    let found = fitted(&points, true, &kept, true);
    assert!(found.curve.whole().is_some());
    assert_eq!(found.curve.start, points[19]);
}

#[test]
fn chords_that_something_ends_on_stay() {
    let points = polygon(24, 20.0);
    let polyline = Polyline { points: &points, closed: true, kept: &[] };
    let is_met = |a: DVec2, _| a == points[5];
    let options = Options { tolerance: TOLERANCE, round: true };
    let curve = fit(polyline, is_met, options).expect("a curve").curve;
    let line = curve.iter().find(|(_, p)| matches!(p, CurvePiece::Line(_))).expect("a line");
    assert_eq!((line.0, line.1.end()), (points[5], points[6]));
    assert_eq!(curve.pieces.len(), 2);
}

/// Checks two rims of a coarse cylinder, one behind the other, out of step: their outline is the union of two polygons.
#[test]
fn outlines_of_two_rims_are_one_circle() {
    let count = 45;
    let step = TAU / f64::from(count);
    let (near, far) = (0.0, step * 0.3);
    // Alternately a vertex of one polygon, and the crossing of its chord with one of the other.
    let mut points = Vec::new();
    for i in 0..count {
        for offset in [near, far] {
            points.push(unit(f64::from(i) * step + offset) * 90.0);
        }
    }
    // The second polygon is a little smaller, so that its vertices are within reach of the chords.
    for p in points.iter_mut().skip(1).step_by(2) {
        *p *= 0.9989;
    }
    let curve = round(&points, true);
    let circle = curve.whole().expect("a circle");
    assert!((circle.axis.length() - 90.0).abs() < 1e-6);
}

#[test]
fn ends_between_two_points_of_a_circle_stay() {
    // A circle that disappears behind something in the middle of a chord.
    let mut points = polygon(160, 12.0)[..60].to_vec();
    let last = points.len() - 1;
    points[last] = points[last - 1].lerp(points[last], 0.5);
    let curve = round(&points, false);
    let [CurvePiece::Arc(arc, end)] = curve.pieces[..] else { panic!("{curve:?}") };
    assert_eq!(end, points[last]);
    assert!(arc.at(arc.start + arc.turn).distance(end) < TOLERANCE * 0.021);
    assert!((arc.axis.length() - 12.0).abs() < TOLERANCE);
}

/// Pseudo-random numbers.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// Returns a chain of lines, arcs and waves, with corners and noise.
fn any_chain(numbers: &mut Numbers) -> Vec<DVec2> {
    let mut points = vec![DVec2::new(numbers.next(), numbers.next()) * 50.0];
    let mut way = numbers.next() * TAU;
    for _ in 0..2 + (numbers.next() * 5.0) as u32 {
        let steps = 1 + (numbers.next() * 40.0) as u32;
        let (length, bend) = (0.05 + numbers.next() * 2.0, (numbers.next() - 0.5) * 0.4);
        let (wave, noise) = (numbers.next() * 0.2, numbers.next() * numbers.next() * 0.01);
        for i in 0..steps {
            way += bend + wave * libm::sin(f64::from(i) * 0.3);
            let off = DVec2::new(numbers.next() - 0.5, numbers.next() - 0.5) * noise;
            let last = points[points.len() - 1];
            points.push(last + unit(way) * length + off);
        }
        way += (numbers.next() - 0.5) * 3.0;
    }
    points
}

#[test]
fn fitted_curves_stay_near_to_any_polyline() {
    let mut numbers = Numbers(5);
    let mut curved = 0;
    for case in 0..150 {
        let points = any_chain(&mut numbers);
        let closed = case % 3 == 0;
        let strict = fitted(&points, closed, &[], false);
        let curve = &strict.curve;
        assert_eq!(curve.closed, closed && points.len() > 2);
        if !closed {
            assert_eq!((curve.start, Some(&points[0])), (points[0], points.first()), "{case}");
            assert_eq!(curve.pieces.last().map(CurvePiece::end), points.last().copied(), "{case}");
        } else if points.len() > 2 {
            assert_eq!(curve.pieces.last().map(CurvePiece::end), Some(curve.start), "{case}");
        }
        // Curves begin at points, in order.
        for (start, from) in curve.iter().map(|p| p.0).zip(&strict.from) {
            assert_eq!(start, points[*from], "{case}");
        }
        curved += usize::from(!curve.is_straight());
        let chain = pieces::points(curve, 1e-4);
        for p in &points {
            assert!(distance(*p, &chain, closed) <= TOLERANCE + 2e-4, "{case}: {p}");
        }
        for p in chain.iter().step_by(3) {
            assert!(distance(*p, &points, closed) <= TOLERANCE + 2e-4, "{case}: {p}");
        }
        // With facets of round surfaces, points stay near too.
        let chain = pieces::points(&round(&points, closed), 1e-4);
        let far = points.iter().filter(|p| distance(**p, &chain, closed) > TOLERANCE + 2e-4);
        assert_eq!(far.count(), 0, "{case}");
        assert_eq!(fitted(&points, closed, &[], false), strict);
    }
    assert!(curved > 80, "{curved}");
}

#[test]
fn smooth_chains_become_few_cubic_curves() {
    let wave = |i: u32| DVec2::new(f64::from(i) * 0.25, 6.0 * libm::sin(f64::from(i) * 0.05));
    let points: Vec<DVec2> = (0..400).map(wave).collect();
    let curve = round(&points, false);
    assert!(curve.pieces.len() <= 24, "{}", letters(&curve));
    // Curves join without a visible corner.
    let ways: Vec<[DVec2; 2]> = curve.iter().map(|(start, p)| p.ways(start)).collect();
    for pair in ways.windows(2) {
        assert!(pair[0][1].angle_to(pair[1][0]).abs() < 0.08);
    }
}

#[test]
fn points_in_a_row_are_one_line() {
    let mut points: Vec<DVec2> = (0..8).map(|i| DVec2::new(f64::from(i * i), 0.0)).collect();
    points.extend((1..6).map(|i| DVec2::new(49.0, f64::from(i))));
    let curve = round(&points, false);
    assert_eq!(curve.pieces, [CurvePiece::Line(points[7]), CurvePiece::Line(points[12])]);
    let mut kept = vec![false; 13];
    kept[3] = true;
    assert_eq!(letters(&fitted(&points, false, &kept, true).curve), "LLL");
}

/// Checks a curve of increasing curvature with many points: any short part is nearly a circle.
#[test]
fn long_polylines_take_no_longer_for_being_nearly_round() {
    let (mut p, mut way) = (DVec2::ZERO, 0.0);
    let mut points = Vec::new();
    for i in 0..8_000 {
        points.push(p);
        way += f64::from(i) * 1.4e-8;
        p += unit(way) * 0.05;
    }
    let curve = round(&points, false);
    assert!(curve.pieces.len() < 40, "{}", letters(&curve));
}

#[test]
fn broken_polylines_give_nothing_and_do_no_harm() {
    let options = Options { tolerance: TOLERANCE, round: true };
    let fit = |points: &[DVec2], closed| {
        fit(Polyline { points, closed, kept: &[] }, |_, _| false, options)
    };
    assert_eq!(fit(&[], true), None);
    assert_eq!(fit(&[DVec2::ONE], false), None);
    assert_eq!(fit(&[DVec2::ONE, DVec2::NAN], false), None);
    for closed in [false, true] {
        assert!(fit(&[DVec2::ONE; 9], closed).is_some());
        let back_and_forth: Vec<DVec2> = (0..20).map(|i| DVec2::X * f64::from(i % 3)).collect();
        assert!(fit(&back_and_forth, closed).is_some());
        let huge: Vec<DVec2> = polygon(30, 1.0).iter().map(|p| *p * 1e300).collect();
        assert!(fit(&huge, closed).is_some());
        let tiny: Vec<DVec2> = polygon(30, 1e-300);
        assert!(fit(&tiny, closed).is_some());
    }
}

#[test]
fn cubic_curves_and_pairs_of_arcs_are_near_to_ellipses() {
    let arc = EllipticArc {
        center: DVec2::new(3.0, 4.0),
        axis: DVec2::new(60.0, 25.0),
        ratio: 0.4,
        start: 0.7,
        turn: -5.1,
    };
    let (start, end) = (arc.at(arc.start), arc.at(arc.start + arc.turn));
    let curve = Curve { start, pieces: vec![CurvePiece::Arc(arc, end)], closed: false };
    let fine: Vec<DVec2> =
        (0..=20_000).map(|i| arc.at(0.7 - 5.1 * f64::from(i) / 20_000.0)).collect();
    let cubics = Curve {
        pieces: pieces::cubics(&arc, end, 1e-4)
            .iter()
            .map(|[a, b, c]| CurvePiece::Cubic(*a, *b, *c))
            .collect(),
        ..curve.clone()
    };
    for p in pieces::points(&cubics, 1e-5).iter().step_by(7) {
        assert!(distance(*p, &fine, false) < 1.2e-4);
    }
    let length: f64 = fine.windows(2).map(|w| w[0].distance(w[1])).sum();
    assert!((pieces::length(&curve) / length - 1.0).abs() < 1e-5);
    let arcs = pieces::arcs(&curve, 0.005);
    assert!(arcs.len() < 70, "{}", arcs.len());
    assert_eq!(arcs.last().map(|a| a.0), Some(end));
    let mut from = start;
    for (to, bulge) in arcs {
        // The middle of each arc.
        let p = (from + to) * 0.5 - (to - from).perp() * (0.5 * bulge);
        assert!(distance(p, &fine, false) < 0.006);
        from = to;
    }
}
