//! Homogeneous clipping: any w, both depth ranges, six borders or the near plane with a guard band.

use durer::clip::outcode::{ClipDepths, Outcode};
use durer::clip::volume::*;
use durer::math::{DMat4, DVec4};
use durer::raster::interpolate::perspective_correct;
use durer::trace::{NoTrace, Recorder};
use proptest::prelude::*;

type Vertex = ClipVertex<DVec4>;

/// A vertex whose attribute is its position, which shows whether both are interpolated alike.
fn vertex(position: DVec4) -> Vertex {
    ClipVertex { position, attributes: position }
}

fn point() -> impl Strategy<Value = DVec4> {
    // Often on borders, in the eye plane, behind it, or at the eye itself.
    let c = prop_oneof![4 => -4.0..4.0f64, 1 => (-3..4i32).prop_map(f64::from)];
    [c.clone(), c.clone(), c.clone(), c].prop_map(DVec4::from)
}

fn options() -> impl Strategy<Value = Options> {
    let depth = prop_oneof![Just(ClipDepths::NegativeOneToOne), Just(ClipDepths::ZeroToOne)];
    let borders = prop_oneof![
        Just(Borders::All),
        Just(Borders::NearOnly { guard_band: 2.0 }),
        Just(Borders::Depths { guard_band: 2.0 }),
    ];
    (depth, borders).prop_map(|(depth, borders)| Options { depth, borders })
}

/// Clips by the definition, without outcodes: the smallest of all distances along a dense row of samples.
fn lies_inside(p: DVec4, options: &Options) -> bool {
    let (g, far) = match options.borders {
        Borders::All => (1.0, true),
        Borders::NearOnly { guard_band } => (guard_band, false),
        Borders::Depths { guard_band } => (guard_band, true),
    };
    let near = if options.depth == ClipDepths::ZeroToOne { p.z >= 0.0 } else { p.z >= -p.w };
    p.x.abs() <= g * p.w && p.y.abs() <= g * p.w && near && (!far || p.z <= p.w)
}

/// Rebuilds positions and attributes from the steps alone.
fn replay(input: &[Vertex], steps: &[Step<DVec4>]) -> Vec<Vertex> {
    let (mut ring, mut next, mut open) = (input.to_vec(), Vec::new(), false);
    for step in steps {
        match *step {
            Step::Code { .. } | Step::Accepted => {}
            Step::Rejected => return Vec::new(),
            Step::Border(_) => {
                if open {
                    ring = std::mem::take(&mut next);
                }
                open = true;
            }
            Step::Keep { vertex } => next.push(ring[vertex]),
            Step::Cut { position, attributes, .. } => {
                next.push(Vertex { position, attributes });
            }
            Step::Dropped => next.retain(|v| v.position.w > 0.0),
        }
    }
    if open { next } else { ring }
}

fn bits(p: DVec4) -> [u64; 4] {
    p.to_array().map(|c| (c + 0.0).to_bits())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(10_000))]

    #[test]
    fn results_lie_inside_exactly_and_clipping_twice_changes_nothing(
        ring in prop::collection::vec(point(), 3..7), options in options(),
    ) {
        let ring: Vec<Vertex> = ring.into_iter().map(vertex).collect();
        let once = clip_polygon(&ring, &options, &mut NoTrace);
        prop_assert!(once.is_empty() || once.len() >= 3);
        for v in &once {
            prop_assert!(lies_inside(v.position, &options) && v.position.w > 0.0, "{:?}", v);
            prop_assert!((v.position - v.attributes).length() < 1e-12, "{:?}", v);
        }
        prop_assert_eq!(&clip_polygon(&once, &options, &mut NoTrace), &once);
        if let [a, b, ..] = ring[..]
            && let Some(cut) = clip_segment([a, b], &options, &mut NoTrace)
        {
            prop_assert!(cut.iter().all(|v| lies_inside(v.position, &options)));
            prop_assert_eq!(clip_segment(cut, &options, &mut NoTrace), Some(cut));
        }
    }

    #[test]
    fn swapping_the_ends_gives_the_same_bits(a in point(), b in point(), options in options()) {
        let there = clip_segment([vertex(a), vertex(b)], &options, &mut NoTrace);
        let back = clip_segment([vertex(b), vertex(a)], &options, &mut NoTrace);
        let flat = |s: Option<[Vertex; 2]>| s.map(|s| s.map(|v| bits(v.position)));
        prop_assert_eq!(flat(there), flat(back).map(|[p, q]| [q, p]));
        // Ends inside come back bit for bit.
        if let Some([p, q]) = there {
            prop_assert!(!lies_inside(a, &options) || a.w <= 0.0 || bits(p.position) == bits(a));
            prop_assert!(!lies_inside(b, &options) || b.w <= 0.0 || bits(q.position) == bits(b));
        }
    }

    /// Compares with the definition: dense samples of the segment, inside or not.
    #[test]
    fn a_segment_keeps_what_lies_inside(a in point(), b in point(), options in options()) {
        let cut = clip_segment([vertex(a), vertex(b)], &options, &mut NoTrace);
        let length2 = (b - a).length_squared();
        prop_assume!(length2 > 1e-6 && a != DVec4::ZERO && b != DVec4::ZERO);
        let along = |p: DVec4| (p - a).dot(b - a) / length2;
        // With a guard band, a part beyond a border may be kept, or rejected as a whole.
        let in_volume = |p: DVec4| boundary(p, &Options { borders: Borders::All, ..options });
        let band = cut.is_some() && a.w > 0.0 && b.w > 0.0; // else the far plane may cut, too
        for i in 0..=400 {
            let t = f64::from(i) / 400.0;
            let p = a * (1.0 - t) + b * t;
            let kept = cut.is_some_and(|[q, r]| {
                along(q.position) - 1e-12 <= t && t <= along(r.position) + 1e-12
            });
            let margin = boundary(p, &options);
            if in_volume(p) > 1e-9 || (margin > 1e-9 && band) {
                prop_assert!(kept, "{} {:?} {:?}", t, p, cut);
            } else if margin < -1e-9 {
                prop_assert!(!kept, "{} {:?} {:?}", t, p, cut);
            }
        }
    }

    #[test]
    fn a_positive_factor_changes_nothing(
        ring in prop::collection::vec((point(), -60..60i32, 0.01..100.0f64), 3..5), options in options(),
    ) {
        let plain: Vec<Vertex> = ring.iter().map(|(p, ..)| vertex(*p)).collect();
        let expected = clip_polygon(&plain, &options, &mut NoTrace);

        // One power of two for all: the same bits, scaled.
        let factor = f64::from(ring[0].1).exp2();
        let scaled: Vec<Vertex> = plain.iter().map(|v| vertex(v.position * factor)).collect();
        let found = clip_polygon(&scaled, &options, &mut NoTrace);
        let unscaled: Vec<_> = found.iter().map(|v| v.position / factor).collect();
        prop_assert_eq!(unscaled, expected.iter().map(|v| v.position).collect::<Vec<_>>());

        // Any factor preserves a point's outcode and its position after the division.
        for (p, _, s) in ring {
            for depth in [ClipDepths::NegativeOneToOne, ClipDepths::ZeroToOne] {
                let clear = boundary_coordinates(p, depth).iter().all(|d| d.abs() > 1e-12);
                prop_assert!(!clear
                    || Outcode::of_homogeneous(p, depth) == Outcode::of_homogeneous(p * s, depth));
            }
        }
    }

    /// Checks a separate factor for each end: the positions after the division are the same.
    #[test]
    fn each_end_may_have_its_own_factor(a in point(), b in point(), s in 0.01..100.0f64, r in 0.01..100.0f64) {
        let options = Options::default();
        let ndc = |a: DVec4, b: DVec4| {
            clip_segment([vertex(a), vertex(b)], &options, &mut NoTrace)
                .map(|s| s.map(|v| v.position.truncate() / v.position.w))
        };
        if let (Some(p), Some(q)) = (ndc(a, b), ndc(a * s, b * r)) {
            for k in 0..2 {
                prop_assert!((p[k] - q[k]).length() < 1e-8, "{:?} {:?}", p, q);
            }
        }
    }

    #[test]
    fn tracing_changes_no_output_and_replays(ring in prop::collection::vec(point(), 3..7), options in options()) {
        let vertices: Vec<Vertex> = ring.iter().copied().map(vertex).collect();
        let mut steps = Recorder::default();
        let traced = clip_polygon(&vertices, &options, &mut steps);
        prop_assert_eq!(&traced, &clip_polygon(&vertices, &options, &mut NoTrace));
        prop_assert_eq!(replay(&vertices, steps.steps()), traced);

        let mut steps = Recorder::default();
        let ends = [vertices[0], vertices[1]];
        let traced = clip_segment(ends, &options, &mut steps);
        prop_assert_eq!(traced, clip_segment(ends, &options, &mut NoTrace));
        let replayed = replay(&ends, steps.steps());
        prop_assert_eq!(replayed, traced.map_or(vec![], |s| s.to_vec()));
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 10_000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn many_triangles_are_clipped_as_each_is(
        points in prop::collection::vec((point(), point(), point(), 0..3usize), 0..9), options in options(),
    ) {
        // Some lie inside with all corners, and some reach where products overflow.
        let near = |p: DVec4| DVec4::new(p.x * 0.2, p.y * 0.2, p.z.abs() * 0.2, 1.0);
        let corners = |&(a, b, c, kind): &(DVec4, DVec4, DVec4, usize)| match kind {
            0 => [a, b, c],
            1 => [a, b, c].map(near),
            _ => [near(a), near(b), c * 1e160],
        };
        let triangles: Vec<[Vertex; 3]> = points.iter().map(|p| corners(p).map(vertex)).collect();
        let mut expected = Vec::new();
        for triangle in &triangles {
            let ring = clip_polygon(triangle, &options, &mut NoTrace);
            if let Some((first, rest)) = ring.split_first() {
                expected.extend(rest.windows(2).map(|pair| [*first, pair[0], pair[1]]));
            }
        }
        let mut found = Vec::new();
        clip_triangles(&triangles, &options, &mut found);
        prop_assert_eq!(found, expected);
    }
}

/// Returns the smallest distance inside all borders, by the definition.
fn boundary(p: DVec4, options: &Options) -> f64 {
    let d = boundary_coordinates(p, options.depth);
    match options.borders {
        Borders::All => d.into_iter().fold(f64::INFINITY, f64::min),
        Borders::NearOnly { guard_band: g } => {
            (g * p.w - p.x.abs()).min(g * p.w - p.y.abs()).min(d[4])
        }
        Borders::Depths { guard_band: g } => {
            (g * p.w - p.x.abs()).min(g * p.w - p.y.abs()).min(d[4]).min(d[5])
        }
    }
}

#[test]
fn a_triangle_around_the_volume_becomes_its_window() {
    let corners = [(-9.0, -9.0, 0.0, 1.0), (9.0, -9.0, 0.0, 1.0), (0.0, 30.0, 0.0, 1.0)];
    let ring = corners.map(|p| vertex(p.into()));
    let mut found = clip_polygon(&ring, &Options::default(), &mut NoTrace);
    found.sort_by(|a, b| {
        (a.position.x, a.position.y).partial_cmp(&(b.position.x, b.position.y)).unwrap()
    });
    let places: Vec<_> = found.iter().map(|v| (v.position.x, v.position.y)).collect();
    assert_eq!(places, [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)]);
}

#[test]
fn points_in_before_and_behind_the_eye_plane() {
    let eye_plane = vertex(DVec4::new(1.0, 0.0, -1.0, 0.0));
    let behind = vertex(DVec4::new(0.1, 0.0, -3.0, -2.0));
    let before = vertex(DVec4::new(0.0, 0.0, 0.5, 1.0));
    let clip = |a, b| clip_segment([a, b], &Options::default(), &mut NoTrace);
    assert_eq!(clip(eye_plane, behind), None);
    assert_eq!(clip(behind, behind), None);
    assert_eq!(clip(before, before), Some([before, before]));
    for end in [eye_plane, behind] {
        let [a, b] = clip(before, end).expect("reaches from the inside");
        assert_eq!(a, before);
        assert!(b.position.w > 0.0 && b.position != before.position);
    }
    // A segment whose ends are both behind the eye never shows the mirror image between them.
    let [l, r] = [-9.0, 9.0].map(|x| vertex(DVec4::new(x, 0.0, 0.0, -1.0)));
    assert_eq!(clip(l, r), None);
}

#[test]
fn a_guard_band_leaves_the_sides_alone() {
    let options = Options { borders: Borders::NearOnly { guard_band: 4.0 }, ..Options::default() };
    let corners = [(3.0, 0.0, 0.0, 1.0), (0.0, 3.5, 0.0, 1.0), (-3.0, 0.0, 7.0, 1.0)];
    let ring = corners.map(|p| vertex(p.into()));
    assert_eq!(clip_polygon(&ring, &options, &mut NoTrace), ring);
    let wide = [ring[0], ring[1], vertex(DVec4::new(-40.0, 0.0, 0.0, 1.0))];
    let cut = clip_polygon(&wide, &options, &mut NoTrace);
    assert!(cut.len() == 4 && cut.iter().all(|v| v.position.x >= -4.0));
    // A corner at infinity straight ahead has no position on the screen, but the other corners have.
    let endless = [ring[0], ring[1], vertex(DVec4::new(0.0, 0.0, 5.0, 0.0))];
    let cut = clip_polygon(&endless, &options, &mut NoTrace);
    assert!(cut.len() == 4 && cut.iter().all(|v| v.position.z <= v.position.w));
    // A segment entirely beyond one side is rejected by its outcodes.
    let beside = corners.map(|(x, y, z, w)| vertex(DVec4::new(x + 5.0, y, z, w)));
    assert!(clip_polygon(&beside, &options, &mut NoTrace).is_empty());
}

#[test]
fn what_is_not_finite_is_left_out() {
    let good = vertex(DVec4::new(0.0, 0.0, 0.0, 1.0));
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e200] {
        for k in 0..4 {
            let mut p = DVec4::new(0.5, 0.5, 0.5, 1.0);
            p[k] = bad;
            let options = Options::default();
            assert!(clip_polygon(&[good, good, vertex(p)], &options, &mut NoTrace).is_empty());
            assert_eq!(clip_segment([good, vertex(p)], &options, &mut NoTrace), None);
        }
    }
    assert!(clip_polygon::<()>(&[], &Options::default(), &mut NoTrace).is_empty());
}

#[test]
fn planes_of_the_source_space_are_the_borders() {
    let matrix = DMat4::from_cols_array_2d(&[
        [1.5, 0.1, 0.0, 0.2],
        [0.0, 2.0, 0.3, 0.0],
        [0.2, 0.0, -1.1, -1.0],
        [0.5, 0.0, -2.0, 3.0],
    ]);
    for depth in [ClipDepths::NegativeOneToOne, ClipDepths::ZeroToOne] {
        let planes = planes_in_source(&matrix, depth);
        for i in 0..125 {
            let p =
                DVec4::new((i % 5 - 2).into(), (i / 5 % 5 - 2).into(), (i / 25 - 2).into(), 1.0);
            let d = boundary_coordinates(matrix * p, depth);
            for k in 0..6 {
                assert!((planes[k].evaluate(p.truncate()) - d[k]).abs() < 1e-12);
            }
        }
    }
}

#[test]
fn an_end_on_the_border_stays_bit_for_bit() {
    for i in 1..50 {
        let w = 0.1 * f64::from(i);
        let on = vertex(DVec4::new(w, 0.07 * f64::from(i), w / 3.0, w));
        let out = vertex(DVec4::new(1.7 + w, 0.2, 0.1, 0.9));
        for ends in [[on, out], [out, on]] {
            let found = clip_segment(ends, &Options::default(), &mut NoTrace).expect("they touch");
            assert_eq!(found.map(|v| bits(v.position)), [bits(on.position); 2]);
            assert_eq!(found.map(|v| v.attributes), [on.attributes; 2]);
        }
    }
}

#[test]
fn a_corner_on_the_border_comes_out_once() {
    let [on, out, within] =
        [(1.0, 0.0), (2.0, 0.5), (0.0, 0.5)].map(|(x, y)| vertex(DVec4::new(x, y, 0.0, 1.0)));
    for ring in [[on, out, within], [out, within, on], [within, out, on]] {
        let clipped = clip_polygon(&ring, &Options::default(), &mut NoTrace);
        assert_eq!(clipped.len(), 3, "{clipped:?}");
    }
}

/// Checks that the null vector, which is not a point, is never an end of a visible segment.
#[test]
fn segments_that_end_in_the_null_vector_are_left_out() {
    let inside = vertex(DVec4::new(0.0, 0.0, 0.0, 1.0));
    for borders in [Borders::All, Borders::NearOnly { guard_band: 2.0 }] {
        for ends in [[vertex(DVec4::ZERO), inside], [inside, vertex(DVec4::ZERO)]] {
            let options = Options { borders, ..Options::default() };
            assert!(clip_segment(ends, &options, &mut NoTrace).is_none(), "{borders:?}");
        }
    }
}

#[test]
fn a_corner_in_the_eye_has_no_place_and_is_dropped() {
    let corners = [(0.5, -0.5, 0.0, 1.0), (0.5, 0.5, 0.0, 1.0), (-0.5, 0.5, 0.0, 1.0)];
    let corners = corners.map(|p| vertex(p.into()));
    let ring = [vertex(DVec4::ZERO), corners[0], corners[1], corners[2]];
    assert_eq!(clip_polygon(&ring, &Options::default(), &mut NoTrace), corners);
}

/// On the screen a new vertex is s of the way, and perspective-correct mixing by s gives what it got by t; mixing by s
/// alone does not.
#[test]
fn new_vertices_have_the_values_of_perspective_correct_mixing() {
    let mut random = crate::raster_coverage::Random(8);
    let (mut cuts, mut largest) = (0, 0.0_f64);
    for _ in 0..2_000 {
        let mut end = |w: f64| {
            let p = random.point(-4.0, 4.0);
            ClipVertex { position: DVec4::new(p.x, p.y, 0.0, w), attributes: random.next() }
        };
        let ends = [end(1.0), end(3.0)];
        let mut steps = Recorder::default();
        clip_segment(ends, &Options::default(), &mut steps);
        // The first new vertex is between the given ends.
        let cut = steps.steps().iter().find_map(|step| match *step {
            Step::Cut { inside, outside, position, attributes, .. } => {
                Some((inside, outside, position, attributes))
            }
            _ => None,
        });
        let Some((inside, outside, position, value)) = cut else { continue };
        let on_screen = |p: DVec4| p.truncate() / p.w;
        let [p, q] = [inside, outside].map(|i| on_screen(ends[i].position));
        let s = (on_screen(position) - p).dot(q - p) / (q - p).length_squared();
        let inv_w = [inside, outside].map(|i| ends[i].position.w.recip());
        let weights = perspective_correct([1.0 - s, s, 0.0], [inv_w[0], inv_w[1], 1.0]);
        let [from, to] = [inside, outside].map(|i| ends[i].attributes);
        let right = weights[0] * from + weights[1] * to;
        assert!((right - value).abs() < 1e-9, "{ends:?}: {value} {right}");
        largest = largest.max((from + (to - from) * s - value).abs());
        cuts += 1;
    }
    assert!(cuts > 500 && largest > 0.2, "{cuts} {largest}");
}
