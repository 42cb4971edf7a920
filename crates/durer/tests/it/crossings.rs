//! Crossings of segments: the sweep finds the same as comparing all pairs, in every special case.

use crate::raster_coverage::Random;
use durer::Error;
use durer::clip::crossings::bentley_ottmann::{self, Neighbours, Step, crossings};
use durer::clip::crossings::{Crossing, Options, all_pairs};
use durer::clip::line::Segment;
use durer::math::DVec2;
use durer::trace::{NoTrace, Recorder};

fn segment([a, b, c, d]: [f64; 4]) -> Segment<DVec2> {
    Segment::new(DVec2::new(a, b), DVec2::new(c, d))
}

fn swept(segments: &[Segment<DVec2>]) -> Vec<Crossing> {
    let mut steps = Recorder::default();
    let found = crossings(segments, &Options::default(), &mut steps).unwrap();
    assert_eq!(crossings(segments, &Options::default(), &mut NoTrace).unwrap(), found);
    assert_eq!(bentley_ottmann::replay(steps.steps()), found);
    found
}

fn compared(segments: &[Segment<DVec2>]) -> Vec<Crossing> {
    all_pairs(segments, &Options::default()).unwrap()
}

/// Returns segments with ends on a small grid: many of them touch, overlap, are vertical or are points.
fn on_grid(random: &mut Random, count: usize, reach: f64, unit: f64) -> Vec<Segment<DVec2>> {
    let mut point = || (random.point(0.0, reach)).floor() * unit;
    (0..count).map(|_| Segment::new(point(), point())).collect()
}

#[test]
fn the_sweep_finds_what_all_pairs_have() {
    let mut random = Random(21);
    for round in 0..150 {
        let (count, reach) = (3 + round % 9, 3.0 + (round % 5) as f64);
        // Tenths are not binary fractions, so points on a line are on it only approximately.
        let unit = [1.0, 0.1, 1e-3][round % 3];
        let segments = on_grid(&mut random, count, reach, unit);
        assert_eq!(swept(&segments), compared(&segments), "round {round}: {segments:?}");
    }
    for count in [20, 60] {
        let point = |random: &mut Random| random.point(-5.0, 5.0);
        let segments: Vec<_> =
            (0..count).map(|_| Segment::new(point(&mut random), point(&mut random))).collect();
        let found = swept(&segments);
        assert!(found.len() > count);
        assert_eq!(found, compared(&segments));
    }
}

/// Returns the pairs that meet, in integers and without the library.
#[test]
fn pairs_meet_as_whole_numbers_say() {
    let mut random = Random(22);
    for _ in 0..60 {
        let segments = on_grid(&mut random, 8, 6.0, 1.0);
        let found = swept(&segments);
        for b in 0..segments.len() {
            for a in 0..b {
                let together =
                    |c: &&Crossing| [a, b].iter().all(|k| c.segments.contains(&(*k as u32)));
                let expected = meet(&segments[a], &segments[b]);
                let count = found.iter().filter(together).count();
                assert_eq!(count > 0, expected, "{:?} {:?}", segments[a], segments[b]);
            }
        }
    }
}

/// Returns whether two integer segments have a point in common: neither an axis nor a normal of theirs separates them.
fn meet(s: &Segment<DVec2>, t: &Segment<DVec2>) -> bool {
    let points = |s: &Segment<DVec2>| [s.start, s.end].map(|p| [p.x as i64, p.y as i64]);
    let (s, t) = (points(s), points(t));
    let normal = |s: [[i64; 2]; 2]| [s[0][1] - s[1][1], s[1][0] - s[0][0]];
    let along = |s: [[i64; 2]; 2]| [s[1][0] - s[0][0], s[1][1] - s[0][1]];
    let axes = [[1, 0], [0, 1], normal(s), normal(t), along(s), along(t)];
    axes.iter().all(|axis| {
        let range = |s: [[i64; 2]; 2]| {
            let [p, q] = s.map(|p| p[0] * axis[0] + p[1] * axis[1]);
            [p.min(q), p.max(q)]
        };
        let ([a, b], [c, d]) = (range(s), range(t));
        a <= d && c <= b
    })
}

/// Pairs of segments, and their common points.
type Case<'a> = (&'a [[f64; 4]], &'a [([f64; 2], &'a [u32])]);

#[test]
fn special_cases_are_defined() {
    let at = |found: &[Crossing]| -> Vec<([f64; 2], Vec<u32>)> {
        found.iter().map(|c| (c.at.to_array(), c.segments.clone())).collect()
    };
    let cases: [Case; 6] = [
        // A common end; an end on the other segment.
        (&[[0.0, 0.0, 4.0, 0.0], [4.0, 0.0, 5.0, 3.0]], &[([4.0, 0.0], &[0, 1])]),
        (&[[0.0, 0.0, 4.0, 4.0], [2.0, 2.0, 2.0, 9.0]], &[([2.0, 2.0], &[0, 1])]),
        // A collinear overlap, in opposite directions: both ends of the common part.
        (
            &[[0.0, 0.0, 6.0, 3.0], [8.0, 4.0, 2.0, 1.0]],
            &[([2.0, 1.0], &[0, 1]), ([6.0, 3.0], &[0, 1])],
        ),
        // The same segment twice, and a vertical one.
        (
            &[[1.0, 0.0, 1.0, 4.0], [1.0, 4.0, 1.0, 0.0], [0.0, 2.0, 3.0, 2.0]],
            &[([1.0, 0.0], &[0, 1]), ([1.0, 2.0], &[0, 1, 2]), ([1.0, 4.0], &[0, 1])],
        ),
        // Points on a segment and on each other.
        (
            &[
                [0.0, 0.0, 2.0, 2.0],
                [1.0, 1.0, 1.0, 1.0],
                [1.0, 1.0, 1.0, 1.0],
                [3.0, 3.0, 3.0, 3.0],
            ],
            &[([1.0, 1.0], &[0, 1, 2])],
        ),
        // Parallel and apart.
        (&[[0.0, 0.0, 4.0, 4.0], [1.0, 0.0, 5.0, 4.0]], &[]),
    ];
    for (segments, expected) in cases {
        let segments: Vec<_> = segments.iter().copied().map(segment).collect();
        let expected: Vec<_> = expected.iter().map(|(p, all)| (*p, all.to_vec())).collect();
        assert_eq!(at(&swept(&segments)), expected, "{segments:?}");
        assert_eq!(at(&compared(&segments)), expected, "{segments:?}");
    }
}

#[test]
fn huge_and_tiny_coordinates_are_exact() {
    let tiny = f64::from_bits(1);
    let scales = [1e300, 1e-300, tiny, 1.0];
    for scale in scales {
        let segments: Vec<_> =
            [[-4.0, -4.0, 4.0, 4.0], [-4.0, 4.0, 4.0, -4.0], [0.0, -4.0, 0.0, 4.0]]
                .map(|ends| segment(ends.map(|v| v * scale)))
                .into();
        let found = swept(&segments);
        let expected = Crossing { at: DVec2::ZERO, segments: vec![0, 1, 2] };
        assert_eq!(found, [expected], "{scale}");
        assert_eq!(found, compared(&segments));
    }
}

#[test]
fn neighbours_are_tested_and_the_status_changes_its_order() {
    // Two that cross, and a third far above, which is first the neighbour of one and then of the other.
    let segments = [[0.0, 0.0, 4.0, 4.0], [0.0, 4.0, 4.0, 0.0], [0.0, 9.0, 4.0, 9.0]].map(segment);
    let mut steps = Recorder::default();
    crossings(&segments, &Options::default(), &mut steps).unwrap();
    let orders: Vec<&[u32]> = steps
        .steps()
        .iter()
        .filter_map(|step| if let Step::Status { order } = step { Some(&order[..]) } else { None })
        .collect();
    let expected: [&[u32]; 7] = [&[0], &[0, 1], &[0, 1, 2], &[1, 0, 2], &[0, 2], &[2], &[]];
    assert_eq!(orders, expected);
    let tests: Vec<_> = steps
        .steps()
        .iter()
        .filter_map(|step| match step {
            Step::Test { place, pair, meet, is_new } => Some((*place, *pair, *meet, *is_new)),
            _ => None,
        })
        .collect();
    let middle = Some(DVec2::splat(2.0));
    let expected = [
        (Neighbours::Below, [0, 1], middle, true),
        (Neighbours::Below, [1, 2], None, false),
        (Neighbours::Above, [0, 2], None, false),
    ];
    assert_eq!(tests, expected);
}

#[test]
fn too_many_crossings_and_wrong_numbers_are_refused() {
    let fan: Vec<_> = (0..6).map(|k| segment([0.0, k.into(), 5.0, 5.0 - f64::from(k)])).collect();
    let bars: Vec<_> = (1..5).map(|k| segment([k.into(), -1.0, k.into(), 6.0])).collect();
    let all = [fan, bars].concat();
    let few = Options { max_crossings: 3 };
    for refused in [crossings(&all, &few, &mut NoTrace), all_pairs(&all, &few)] {
        assert!(matches!(refused, Err(Error::Limit { limit: 3, .. })), "{refused:?}");
    }
    let wrong = [segment([0.0, 0.0, 1.0, 1.0]), segment([0.0, f64::NAN, 1.0, 1.0])];
    let refused = crossings(&wrong, &Options::default(), &mut NoTrace);
    assert!(matches!(refused, Err(Error::NonFinite { index: 1, .. })), "{refused:?}");
    assert_eq!(crossings(&[], &Options::default(), &mut NoTrace).unwrap(), []);
}
