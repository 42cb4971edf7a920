//! Line clipping where errors of rounding, of the number range and of array ends would show.

use durer::clip::attribute::VertexSource;
use durer::clip::line::batch::{self, Clipped, Segments};
use durer::clip::line::homogeneous::clip_homogeneous;
use durer::clip::line::sobkow_pospisil_yang::{self as by_code, CASES, Case};
use durer::clip::line::{ConvexPolygon, End, LineClipper, Segment, cyrus_beck, skala};
use durer::clip::outcode::Outcode;
use durer::clip::polygon::Shapes;
use durer::clip::polygon::rectangle::clip_lines;
use durer::clip::polyline::{self, KeptPart};
use durer::math::{DVec2, DVec3, Rect};
use durer::trace::{NoTrace, Recorder};
use std::cmp::Ordering;

fn p(x: f64, y: f64) -> DVec2 {
    DVec2::new(x, y)
}

fn unit() -> Rect {
    Rect::new(DVec2::ZERO, DVec2::ONE).expect("window")
}

#[test]
fn sources_name_the_ends_that_are_kept() {
    let line = [p(-1.0, 0.5), p(0.5, 0.5), p(1.0, 1.0), p(3.0, 1.0)];
    let cut = clip_lines(&unit(), &line, &[4], true).expect("clipped");
    assert_eq!(cut.points, [p(0.0, 0.5), p(0.5, 0.5), p(1.0, 1.0)]);
    let entry = VertexSource::Cut { from: 0, to: 1, t: 2.0 / 3.0 };
    assert_eq!(cut.sources, [entry, VertexSource::Vertex(1), VertexSource::Vertex(2)]);
    // If a segment comes from outside and ends on the border, its end is a vertex too.
    for line in [[p(-1.0, 0.5), p(1.0, 0.5)], [p(1.0, 0.5), p(-1.0, 0.5)]] {
        let cut = clip_lines(&unit(), &line, &[2], true).expect("clipped");
        let vertices = cut.sources.iter().filter(|s| matches!(s, VertexSource::Vertex(_))).count();
        assert_eq!(vertices, 1, "{:?}", cut.sources);
    }
}

#[test]
fn cuts_of_huge_segments_lie_between_their_ends() {
    let far = 1.7e308;
    for (a, b) in [(p(-far, 0.1), p(far, 0.9)), (p(0.1, far), p(0.9, -far))] {
        let cut = clip_lines(&unit(), &[a, b], &[2], true).expect("clipped");
        assert_eq!(cut.sources.len(), 2);
        for source in cut.sources {
            let VertexSource::Cut { t, .. } = source else { panic!("{source:?}") };
            assert!((t - 0.5).abs() < 1e-12, "{t}");
        }
    }
}

#[test]
fn a_compact_batch_accepts_what_it_has_and_no_more() {
    for count in [1, 3, 63, 64, 65, 130] {
        // Every other segment meets the window.
        let x: Vec<f64> = (0..2 * count).map(|i| if i % 2 == 0 { 0.5 } else { 7.0 }).collect();
        let y = vec![0.5; 2 * count];
        let segments = Segments { x0: &x, y0: &y, x1: &x, y1: &y };
        let mut clipped = Clipped::default();
        batch::clip(&unit(), segments, &batch::Options::default(), &mut clipped).expect("lengths");
        let kept = clipped.compact();
        assert_eq!(kept, (0..count).map(|i| 2 * i).collect::<Vec<_>>());
        assert_eq!(clipped.iter().count(), count);
        let bits: u32 = clipped.accepted.iter().map(|word| word.count_ones()).sum();
        assert_eq!((bits as usize, clipped.is_accepted(count)), (count, false));
    }
}

/// Segments through a window's upper left corner, exactly, with coordinates whose products round.
fn through_a_corner() -> (Rect, Vec<[f64; 4]>) {
    let corner = p(1_099_511_627_791.0, 3_298_534_883_309.0);
    let window = Rect::new(corner - p(0.0, 1e12), corner + p(1e12, 0.0)).expect("window");
    let mut state = 7_u64;
    let mut random = move |below: u64| {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((state >> 33) % below + 1) as f64
    };
    let segments = (0..2000).map(|_| {
        let along = p(random(1 << 20), random(1 << 20));
        let (before, after) = (random(1 << 20), random(1 << 20));
        let (a, b) = (corner - along * before, corner + along * after);
        [a.x, a.y, b.x, b.y]
    });
    (window, segments.collect())
}

#[test]
fn segments_that_touch_a_corner_are_accepted_one_by_one_and_in_batches() {
    let (window, segments) = through_a_corner();
    let column = |k: usize| segments.iter().map(|s| s[k]).collect::<Vec<f64>>();
    let [x0, y0, x1, y1] = [0, 1, 2, 3].map(column);
    let mut clipped = Clipped::default();
    let all = Segments { x0: &x0, y0: &y0, x1: &x1, y1: &y1 };
    batch::clip(&window, all, &batch::Options::default(), &mut clipped).expect("lengths");
    let corner = p(window.min().x, window.max().y);
    for (i, &[ax, ay, bx, by]) in segments.iter().enumerate() {
        let segment = Segment::new(p(ax, ay), p(bx, by));
        let touch = Segment::new(corner, corner);
        for &clipper in LineClipper::ALL.iter().filter(|c| **c != LineClipper::Midpoint) {
            let found = clipper.clip(&window, segment).expect("finite");
            assert_eq!(found, Some(touch), "{clipper:?} {i}");
        }
        let found = p(clipped.x0[i], clipped.y0[i]);
        assert!(clipped.is_accepted(i) && found == corner, "batch {i}: {found}");
    }
}

#[test]
fn batches_decide_like_one_by_one_where_a_corner_is_an_ulp_away() {
    let mut state = 9_u64;
    let mut random = || {
        let step = (6_364_136_223_846_793_005, 1_442_695_040_888_963_407);
        state = state.wrapping_mul(step.0).wrapping_add(step.1);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    let (mut accepted, mut clipped) = (0, Clipped::default());
    for i in 0..20_000 {
        let a = p(random() - 1.0, random() - 1.0);
        let b = p(random(), random());
        let corner = a + (b - a) * random();
        let window = Rect::new(corner - p(0.0, 2.0), corner + p(2.0, 0.0)).expect("window");
        // As many as fill the lanes.
        let [x0, y0, x1, y1] = [a.x, a.y, b.x, b.y].map(|v| [v; 8]);
        let eight = Segments { x0: &x0, y0: &y0, x1: &x1, y1: &y1 };
        batch::clip(&window, eight, &batch::Options::default(), &mut clipped).expect("lengths");
        let clip = LineClipper::LiangBarsky.clip(&window, Segment::new(a, b)).expect("finite");
        let found = (clipped.is_accepted(2), clipped.x0[2], clipped.y0[2]);
        let expected = clip.map_or((false, a.x, a.y), |s| (true, s.start.x, s.start.y));
        assert_eq!(found, expected, "{i}: {a} {b} {corner}");
        accepted += u32::from(clip.is_some());
    }
    assert!((4000..16_000).contains(&accepted), "{accepted}");
}

/// Checks that a second clip changes nothing: the result is in the closed window, exactly.
fn clipped_to(window: &ConvexPolygon, a: DVec2, b: DVec2) -> Segment<DVec2> {
    let clip = |s| cyrus_beck::clip_polygon(window, s, &mut NoTrace).expect("finite");
    let found = clip(Segment::new(a, b)).expect("they meet");
    assert_eq!(clip(found), Some(found));
    found
}

#[test]
fn windows_thinner_than_an_ulp_of_the_segment_are_hit() {
    let needle = ConvexPolygon::new(&[p(0.0, 0.0), p(1.0, 1e-20), p(1.0, 2e-20)]).expect("convex");
    let found = clipped_to(&needle, p(0.5, -1.0), p(0.5, 1.0));
    assert!((found.start.y - 0.5e-20).abs() < 1e-32, "{found:?}");
    assert!((found.end.y - 1e-20).abs() < 1e-32, "{found:?}");
    // In this tip, a cut has few neighbours inside, or only the tip itself.
    let tip = p(1.0, 1.0);
    for slope in [0.7, 0.35, 0.9, 0.111] {
        let end = 1.0 + 2.0 * slope;
        let needle =
            ConvexPolygon::new(&[tip, p(3.0, end), p(3.0, end.next_up())]).expect("convex");
        for ulps in [1, 2, 3, 7, 12] {
            let x = 1.0 + f64::from(ulps) * f64::EPSILON;
            let found = clipped_to(&needle, p(x, 0.0), p(x, 3.0));
            assert!(found.start.distance(tip) < 64.0 * f64::EPSILON, "{found:?}");
        }
    }
}

#[test]
fn the_null_vector_is_no_point_of_a_segment() {
    let q = DVec3::new;
    let clip = |a, b| clip_homogeneous(&unit(), Segment::new(a, b), &mut NoTrace).expect("finite");
    assert_eq!(clip(DVec3::ZERO, DVec3::ZERO), None);
    assert_eq!(clip(DVec3::ZERO, q(0.5, 0.5, 1.0)), None);
    assert_eq!(clip(q(0.5, 0.5, 1.0), DVec3::ZERO), None);
    // Through the null vector to the point's other representation, where w is negative.
    for x in [0.1, 0.3, 0.7] {
        for w in [0.3, 1.0, 1.1] {
            for back in [0.125, 0.25, 0.5, 2.0] {
                let a = q(x * w, 0.2 * w, w);
                assert_eq!(clip(a, -a * back), None, "{x} {w} {back}");
            }
        }
    }
}

#[test]
fn pieces_never_reach_beyond_their_segment() {
    for i in 0..1000 {
        let (from, to) = (-0.1 * f64::from(i + 1), 0.07 * f64::from(i) + 0.3);
        // A border that the segment crosses less than an ulp before its end.
        let border = [p(to.next_down(), -1.0), p(to, 1.0), p(to + 9.0, 1.0), p(to + 9.0, -1.0)];
        let polygon = Shapes::from_rings([border]);
        for part in [KeptPart::Inside, KeptPart::Outside] {
            for line in [[p(from, 0.0), p(to, 0.0)], [p(to, 0.0), p(from, 0.0)]] {
                let options = polyline::Options { part };
                let out = polyline::clip(&polygon, &line, &[2], &options, &mut NoTrace);
                for point in out.expect("finite").points {
                    assert!((from..=to).contains(&point.x), "{from} {to}: {point}");
                }
            }
        }
    }
}

/// Outcodes of the nine regions of the plane.
const REGIONS: [u8; 9] = [0, 1, 2, 4, 8, 5, 6, 9, 10];

#[test]
fn line_codes_have_a_case_for_each_pair_of_regions() {
    let cases = REGIONS.map(|a| REGIONS.map(|b| CASES[usize::from(a << 4 | b)]));
    let count = |is: fn(&Case) -> bool| cases.iter().flatten().filter(|case| is(case)).count();
    assert_eq!(count(|case| *case == Case::Accept), 1);
    assert_eq!(count(|case| *case == Case::Reject), 32);
    assert_eq!(count(|case| matches!(case, Case::Cut { .. })), 48);
}

#[test]
fn cuts_of_a_line_code_are_those_of_its_case() {
    let window = Rect::new(DVec2::ZERO, p(10.0, 6.0)).expect("window");
    let steps = |a: DVec2, b: DVec2| {
        let mut steps = Recorder::default();
        by_code::clip(&window, Segment::new(a, b), &mut steps).expect("finite");
        steps.steps().to_vec()
    };
    let cut = |end, border, point, code| by_code::Step::Cut { end, border, point, code };
    // From corner to corner: the first cut of the end is above the window, the second one is on its right side.
    let (start, end) = (Outcode::LEFT | Outcode::BOTTOM, Outcode::RIGHT | Outcode::TOP);
    let expected = [
        by_code::Step::Code { start, end },
        cut(End::Start, Outcode::LEFT, p(0.0, 1.5), Outcode::INSIDE),
        cut(End::End, Outcode::RIGHT, p(10.0, 6.5), Outcode::TOP),
        cut(End::End, Outcode::TOP, p(9.0, 6.0), Outcode::INSIDE),
        by_code::Step::Accepted { at_once: false },
    ];
    assert_eq!(steps(p(-4.0, -0.5), p(12.0, 7.5)), expected);
    // From the left side past a corner: one cut, at the border that only the end is beyond.
    let missed = steps(p(-4.0, 3.0), p(3.0, 10.0));
    let code = by_code::Step::Code { start: Outcode::LEFT, end: Outcode::TOP };
    let rejected = by_code::Step::Rejected { at_once: false };
    assert_eq!(missed, [code, cut(End::Start, Outcode::LEFT, p(0.0, 7.0), Outcode::TOP), rejected]);
    // From the corner past the next one: two cuts.
    let missed = steps(p(-4.0, -8.0), p(12.0, 1.0));
    assert_eq!(missed.len(), 4, "{missed:?}");
    assert_eq!(missed.last(), Some(&rejected));
    // At an end inside, no cut is tested.
    let inside = steps(p(9.0, 5.0), p(12.0, 20.0));
    assert_eq!(inside.len(), 4, "{inside:?}");
}

/// Checks that signs of corners are those of the shown values, in the caller's direction, and that cuts are at borders
/// whose corners are on different sides.
#[test]
fn signs_of_corners_belong_to_the_callers_line() {
    let window = Rect::new(DVec2::ZERO, p(10.0, 6.0)).expect("window");
    let sides = [[3, 0], [1, 2], [0, 1], [2, 3]];
    let ends = [
        (p(-4.0, 1.0), p(10.0, 8.0)),
        (p(-3.0, 5.0), p(5.0, -3.0)),
        (p(4.0, -2.0), p(5.0, 9.0)),
        (p(-1.0, 2.0), p(11.0, 3.0)),
        (p(-2.0, 4.0), p(2.0, 8.0)),
    ];
    for (a, b) in ends.into_iter().flat_map(|(a, b)| [(a, b), (b, a)]) {
        let mut steps = Recorder::default();
        skala::clip(&window, Segment::new(a, b), &mut steps).expect("finite");
        let mut signs = [Ordering::Equal; 4];
        let mut cuts = 0;
        for step in steps.steps() {
            match *step {
                skala::Step::Corner { corner, value, side } => {
                    assert_eq!(value.partial_cmp(&0.0), Some(side), "{a} {b}: corner {corner}");
                    signs[corner] = side;
                }
                skala::Step::Cut { border, .. } => {
                    let [first, second] = sides[border].map(|corner| signs[corner]);
                    assert_ne!(first, second, "{a} {b}: border {border}");
                    cuts += 1;
                }
                _ => {}
            }
        }
        assert_eq!(cuts, 2, "{a} {b}");
    }
}

/// Windows without an area have their corners on the line itself.
#[test]
fn segments_along_windows_without_an_area_are_cut_at_both_ends() {
    let slit = Rect::new(p(0.0, 1.0), p(4.0, 1.0)).expect("window");
    let point = Rect::new(p(2.0, 1.0), p(2.0, 1.0)).expect("window");
    let along = Segment::new(p(-3.0, 1.0), p(9.0, 1.0));
    for &clipper in LineClipper::ALL.iter().filter(|c| **c != LineClipper::Midpoint) {
        let kept = clipper.clip(&slit, along).expect("finite");
        assert_eq!(kept, Some(Segment::new(p(0.0, 1.0), p(4.0, 1.0))), "{clipper}");
        let kept = clipper.clip(&point, along).expect("finite");
        assert_eq!(kept, Some(Segment::new(p(2.0, 1.0), p(2.0, 1.0))), "{clipper}");
    }
}
