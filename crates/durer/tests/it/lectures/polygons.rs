//! Clipping of polygons at windows.

use super::p;
use durer::clip::line::HalfPlane;
use durer::clip::polygon::Operand;
use durer::clip::polygon::sutherland_hodgman::by_borders::{self, EdgeRule, Step as Edge};
use durer::clip::polygon::weiler_atherton::{self, CrossingMark, Step as Walk};
use durer::clip::polygon::{
    BooleanOp, Shapes, WindingRule, greiner_hormann, liang_barsky, maillot, naive, overlay,
    sutherland_hodgman,
};
use durer::math::{DVec2, Rect};
use durer::trace::{NoTrace, Recorder};

/// Returns the borders of (0, 0) … (10, 10) in the lecture's order: top, right, bottom, left.
fn borders() -> [HalfPlane; 4] {
    let plane = |normal, point| HalfPlane { normal, point };
    let (low, high) = (DVec2::ZERO, DVec2::splat(10.0));
    [plane(-DVec2::Y, high), plane(-DVec2::X, high), plane(DVec2::Y, low), plane(DVec2::X, low)]
}

/// Returns the smallest of all rotations of a ring, so that rings with other starting points compare equal.
fn cyclic(ring: &[DVec2]) -> Vec<DVec2> {
    let key = |k: usize| -> Vec<[f64; 2]> {
        (0..ring.len()).map(|i| ring[(i + k) % ring.len()].to_array()).collect()
    };
    let first = (0..ring.len()).min_by(|&i, &j| key(i).partial_cmp(&key(j)).unwrap());
    let mut ring = ring.to_vec();
    ring.rotate_left(first.unwrap_or(0));
    ring
}

#[test]
fn four_rules_emit_what_they_are_named_for() {
    // Only D is beyond the border.
    let [a, b, c, d] = [p(2.0, 8.0), p(2.0, 2.0), p(8.0, 2.0), p(8.0, 14.0)];
    let top = &borders()[..1];
    let mut steps = Recorder::default();
    let left = by_borders::clip(top, &[a, b, c, d], &mut steps).unwrap();
    let (s1, s2) = (p(4.0, 10.0), p(8.0, 10.0));
    assert_eq!(left, [s1, a, b, c, s2]);
    let edge = |from, to, rule, emitted| Edge::Edge { border: 0, from, to, rule, emitted };
    let expected = [
        edge(d, a, EdgeRule::OutIn, [Some(s1), Some(a)]),
        edge(a, b, EdgeRule::InIn, [None, Some(b)]),
        edge(b, c, EdgeRule::InIn, [None, Some(c)]),
        edge(c, d, EdgeRule::InOut, [Some(s2), None]),
        Edge::List { border: 0, vertices: left.clone() },
    ];
    assert_eq!(steps.steps(), expected);
    assert_eq!(by_borders::replay(&[a, b, c, d], steps.steps()), left);
    assert_eq!(EdgeRule::OutOut.name(), "out→out");
}

#[test]
fn a_triangle_at_four_borders_has_the_lists_of_the_lecture() {
    let [v0, v1, v2] = [p(-6.0, 12.0), p(14.0, 4.0), p(6.0, -8.0)];
    let mut steps = Recorder::default();
    by_borders::clip(&borders(), &[v0, v1, v2], &mut steps).unwrap();
    let lists: Vec<Vec<DVec2>> = steps
        .steps()
        .iter()
        .filter_map(|step| match step {
            Edge::List { vertices, .. } => Some(vertices.clone()),
            Edge::Edge { .. } => None,
        })
        .collect();
    let [s1, s2, s3, s4] = [p(-1.0, 10.0), p(-4.8, 10.0), p(10.0, 5.6), p(10.0, -2.0)];
    let [s5, s6, s7, s8] = [p(10.0, 0.0), p(1.2, 0.0), p(0.0, 2.0), p(0.0, 9.6)];
    let expected = [
        vec![s1, v1, v2, s2],
        vec![s1, s3, s4, v2, s2],
        vec![s1, s3, s5, s6, s2],
        vec![s8, s3, s5, s6, s7],
    ];
    for (found, expected) in lists.iter().zip(&expected) {
        let (found, expected) = (cyclic(found), cyclic(expected));
        assert_eq!(found.len(), expected.len());
        let apart = found.iter().zip(&expected).map(|(a, b)| a.distance(*b));
        assert!(apart.fold(0.0, f64::max) < 1e-12, "{found:?} {expected:?}");
    }
    assert_eq!(lists.len(), 4);
    let rules = |wanted| {
        let is = |step: &&Edge<DVec2>| matches!(step, Edge::Edge { rule, .. } if *rule == wanted);
        steps.steps().iter().filter(is).count()
    };
    // Entries and exits are equally many, and in one list two consecutive vertices are outside: at the bottom, and on
    // the left.
    assert_eq!([EdgeRule::OutIn, EdgeRule::InOut, EdgeRule::OutOut].map(rules), [4, 4, 2]);
}

#[test]
fn border_by_border_and_stage_by_stage_leave_the_same_ring() {
    let mut random = crate::raster_coverage::Random(5);
    let window = Rect::new(DVec2::ZERO, DVec2::splat(10.0)).unwrap();
    let planes = HalfPlane::of_rect(&window);
    for _ in 0..500 {
        let ring: Vec<DVec2> = (0..7).map(|_| random.point(-4.0, 14.0)).collect();
        let chained = sutherland_hodgman::clip(&window, &ring, &mut NoTrace).unwrap();
        let listed = by_borders::clip(&planes, &ring, &mut NoTrace).unwrap();
        assert_eq!(cyclic(&listed), cyclic(&chained));
    }
}

#[test]
fn a_ring_that_falls_apart_keeps_a_bridge() {
    // Eight corners: an upside-down U whose back is beyond the top.
    let ring = [
        (1.0, 5.0),
        (3.0, 5.0),
        (3.0, 12.0),
        (7.0, 12.0),
        (7.0, 5.0),
        (9.0, 5.0),
        (9.0, 14.0),
        (1.0, 14.0),
    ]
    .map(DVec2::from);
    let left = by_borders::clip(&borders(), &ring, &mut NoTrace).unwrap();
    assert_eq!(left.len(), 8);
    let ends = || left.iter().zip(left.iter().cycle().skip(1));
    let along: Vec<f64> =
        ends().filter(|(a, b)| a.y == 10.0 && b.y == 10.0).map(|(a, b)| b.x - a.x).collect();
    assert_eq!(along, [4.0, -8.0], "between the legs, and back along the border");
    assert_eq!(durer::clip::polygon::signed_area(&left).abs(), 20.0);
}

#[test]
fn edge_by_edge_is_wrong_for_polygons() {
    // A triangle around a corner of the window: clipped edges alone do not form a closed ring.
    let window = Rect::new(DVec2::ZERO, DVec2::splat(10.0)).unwrap();
    let triangle = [p(5.0, 5.0), p(25.0, 5.0), p(5.0, 25.0)];
    let wrong = naive::clip(&window, &triangle, &mut NoTrace).unwrap();
    let right = sutherland_hodgman::clip(&window, &triangle, &mut NoTrace).unwrap();
    let area = durer::clip::polygon::signed_area;
    assert_eq!([area(&right), area(&wrong)], [25.0, 12.5], "the corner is missing");
}

fn subject() -> [DVec2; 10] {
    [
        (5.0, 9.0),
        (15.0, 9.0),
        (18.0, 5.0),
        (15.0, 1.0),
        (5.0, 1.0),
        (5.0, 3.0),
        (15.0, 3.0),
        (14.0, 5.0),
        (15.0, 7.0),
        (5.0, 7.0),
    ]
    .map(DVec2::from)
}

#[test]
fn weiler_and_atherton_walk_both_lists() {
    let s = subject();
    let w = [(0.0, 10.0), (10.0, 10.0), (10.0, 0.0), (0.0, 0.0)].map(DVec2::from);
    let [i, j, k, l] = [9.0, 7.0, 3.0, 1.0].map(|y| p(10.0, y));
    let mut steps = Recorder::default();
    let found = weiler_atherton::weiler_atherton(
        &Shapes::from_rings([s]),
        &Shapes::from_rings([w]),
        BooleanOp::Intersection,
        &Default::default(),
        &mut steps,
    )
    .unwrap();
    let listed = |wanted: Operand| -> Vec<(DVec2, Option<CrossingMark>)> {
        let of = |step: &Walk| match *step {
            Walk::Listed { list, at, mark } if list == wanted => Some((at, mark)),
            _ => None,
        };
        steps.steps().iter().filter_map(of).collect()
    };
    let (enters, leaves) = (Some(CrossingMark::Entering), Some(CrossingMark::Leaving));
    let plain = |range: std::ops::Range<usize>| s[range].iter().map(|&at| (at, None));
    let mut expected: Vec<_> = plain(0..1).chain([(i, leaves)]).chain(plain(1..4)).collect();
    expected.extend([(l, enters)].into_iter().chain(plain(4..6)).chain([(k, leaves)]));
    expected.extend(plain(6..9).chain([(j, enters)]).chain(plain(9..10)));
    assert_eq!(listed(Operand::Subject), expected);
    let window: Vec<DVec2> = listed(Operand::Clip).into_iter().map(|(at, _)| at).collect();
    assert_eq!(window, [w[0], w[1], i, j, k, l, w[2], w[3]]);
    // The walks, each along the subject first, with the changes between the lists.
    let turn = |at, to_subject| Walk::Turn { at, to_subject };
    let passed = |list, at| Walk::Passed { list, at };
    let walk = |from: DVec2, on: [DVec2; 2], to: DVec2| {
        let mut steps = vec![turn(from, true), passed(Operand::Subject, from)];
        steps.extend(on.map(|at| passed(Operand::Subject, at)));
        steps.extend([turn(to, false), passed(Operand::Clip, to)]);
        steps
    };
    let expected: Vec<Walk> = [walk(l, [s[4], s[5]], k), walk(j, [s[9], s[0]], i)].concat();
    let walks: Vec<Walk> = steps
        .steps()
        .iter()
        .filter(|step| matches!(step, Walk::Turn { .. } | Walk::Passed { .. }))
        .cloned()
        .collect();
    assert_eq!(walks, expected);
    let rings: Vec<Vec<DVec2>> = steps
        .steps()
        .iter()
        .filter_map(|step| match step {
            Walk::Ring { points } => Some(points.clone()),
            _ => None,
        })
        .collect();
    assert_eq!(rings, [vec![l, s[4], s[5], k], vec![j, s[9], s[0], i]]);
    assert_eq!(weiler_atherton::replay(steps.steps()), found);
    assert_eq!(found.area(), 20.0);
}

#[test]
fn a_clockwise_subject_gives_what_it_gives_the_other_way_round() {
    let (clockwise, mut other) = (subject(), subject());
    other.reverse();
    let window =
        Shapes::from_rings([[(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)].map(DVec2::from)]);
    for op in BooleanOp::ALL {
        let clip = |ring: [DVec2; 10]| {
            let subject = Shapes::from_rings([ring]);
            let none = &Default::default();
            weiler_atherton::weiler_atherton(&subject, &window, *op, none, &mut NoTrace).unwrap()
        };
        let rings = |shapes: &Shapes| {
            let mut rings: Vec<_> = shapes.rings().map(cyclic).collect();
            rings.sort_by(|a, b| a[0].to_array().partial_cmp(&b[0].to_array()).unwrap());
            rings
        };
        let (a, b) = (clip(clockwise), clip(other));
        assert_eq!(rings(&a), rings(&b), "{op}");
        assert_eq!(a.area(), b.area());
    }
}

/// A triangle around the corner (2, 2) of its window: the slanted edge is not seen, but turns there.
#[test]
fn liang_and_barsky_turn_where_an_edge_is_not_seen() {
    use liang_barsky::Step;
    let window = Rect::new(p(0.0, 0.0), p(2.0, 2.0)).unwrap();
    let mut steps = Recorder::default();
    let ring = [p(1.0, 1.0), p(5.0, 1.0), p(1.0, 5.0)];
    let found = liang_barsky::clip(&window, &ring, &mut steps).unwrap();
    assert_eq!(found, [p(2.0, 1.0), p(2.0, 2.0), p(1.0, 2.0), p(1.0, 1.0)]);
    let slanted = steps.steps().iter().position(|s| matches!(s, Step::Edge { edge: 1, .. }));
    let after = &steps.steps()[slanted.unwrap()..];
    // It enters x ≤ 2 at ¾ and leaves y ≤ 2 at ¼: the later entry is behind the first exit.
    assert_eq!(after[0], Step::Edge { edge: 1, enters: [0.75, -0.25], leaves: [1.25, 0.25] });
    assert_eq!(after[1], Step::Turn(p(2.0, 2.0)));
}

/// From below left to above right, past (0, 8): codes with their fifth bit, and the corners that they name.
#[test]
fn maillot_goes_around_the_corner_that_an_edge_passes() {
    use maillot::{Code, CornerReason, Step};
    let window = Rect::new(p(0.0, 0.0), p(10.0, 8.0)).unwrap();
    let ring = [p(-9.0, -1.0), p(11.0, 21.0), p(-9.0, 21.0)];
    let mut steps = Recorder::default();
    maillot::clip(&window, &ring, &mut steps).unwrap();
    let Step::Edge { edge: 0, start, end } = steps.steps()[0] else { panic!() };
    assert_eq!([start, end].map(|code| code.to_string()), ["10101", "11010"]);
    let turn = |corner, turn| Step::Turn { corner, turn };
    let corners =
        [turn(p(0.0, 8.0), CornerReason::CornerToCorner), turn(p(10.0, 8.0), CornerReason::Basic)];
    assert_eq!(steps.steps()[1..3], corners);
    // At x = 0 the edge is at 8.9, above the window.
    assert!((-1.0 + 22.0 * 9.0 / 20.0 - 8.9_f64).abs() < 1e-12);
    let beside = Code::of(&window, p(-1.0, 4.0));
    assert_eq!((beside.to_string(), beside.is_corner), ("00001".to_owned(), false));
}

/// Points, each with a mark.
type Marks = Vec<(DVec2, bool)>;

/// Returns the crossings (true for an entry), the points that the walk passes (true for those on the subject), and the
/// rings of an intersection.
fn crossing_walk(subject: &[(f64, f64)], clip: [(f64, f64); 4]) -> (Marks, Marks, Vec<Vec<DVec2>>) {
    let subject = Shapes::from_rings([subject.iter().map(|&at| at.into()).collect::<Vec<DVec2>>()]);
    let clip = Shapes::from_rings([clip.map(DVec2::from)]);
    let mut steps = Recorder::default();
    let op = BooleanOp::Intersection;
    let found =
        greiner_hormann::greiner_hormann(&subject, &clip, op, &Default::default(), &mut steps);
    assert_eq!(greiner_hormann::replay(steps.steps()), found.unwrap());
    assert!(steps.steps().contains(&Walk::CrossingRings));
    let (mut marks, mut passes, mut rings) = (Vec::new(), Vec::new(), Vec::new());
    for step in steps.steps() {
        match *step {
            Walk::Crossing { at, entry } => marks.push((at, entry)),
            Walk::Passed { list, at } => passes.push((at, list == Operand::Subject)),
            Walk::Ring { ref points } => rings.push(points.clone()),
            _ => {}
        }
    }
    (marks, passes, rings)
}

/// Returns the area that a ring encloses by the even-odd rule.
fn enclosed(ring: &[DVec2]) -> f64 {
    let (shapes, none) = (Shapes::from_rings([ring.to_vec()]), Shapes::new());
    let options = overlay::Options::with_rule(WindingRule::EvenOdd);
    let valid = overlay::overlay(&shapes, &none, BooleanOp::Union, &options, &mut NoTrace);
    valid.unwrap().shapes.area()
}

/// Page `polygon-clipping`: entries and exits take turns along a bow tie, and the ring of the result crosses itself.
#[test]
fn greiner_and_hormann_walk_along_a_bow_tie() {
    let bow = [(0.0, 0.0), (4.0, 4.0), (4.0, 0.0), (0.0, 4.0)];
    let band = [(-1.0, 1.0), (5.0, 1.0), (5.0, 3.0), (-1.0, 3.0)];
    let (marks, passes, rings) = crossing_walk(&bow, band);
    let ring = [p(1.0, 1.0), p(3.0, 3.0), p(4.0, 3.0), p(4.0, 1.0)];
    let ring = [ring, [p(3.0, 1.0), p(1.0, 3.0), p(0.0, 3.0), p(0.0, 1.0)]].concat();
    // From each entry along the bow tie, from each exit along the band, forwards or backwards.
    let in_turn: Marks = ring.iter().enumerate().map(|(i, &at)| (at, i % 2 == 0)).collect();
    assert_eq!([&marks, &passes], [&in_turn; 2]);
    assert_eq!(rings, [&ring[..]]);
    assert!((enclosed(&ring) - 6.0).abs() < 1e-6);
}

/// The example `pentagram`: six crossings, and one ring around three parts of the star.
#[test]
fn greiner_and_hormann_walk_along_a_pentagram() {
    let star = [(5.0, 10.0), (8.0, 0.5), (0.0, 6.5), (10.0, 6.5), (2.0, 0.5)];
    let right = [(5.5, 1.0), (11.0, 1.0), (11.0, 9.0), (5.5, 9.0)];
    let (marks, _, rings) = crossing_walk(&star, right);
    let [a, b] = [p(5.5, 10.0 - 9.5 / 6.0), p(5.0 + 27.0 / 9.5, 1.0)];
    let [c, d, e, f] = [p(22.0 / 3.0, 1.0), p(5.5, 2.375), p(5.5, 6.5), p(5.5, 3.125)];
    assert!(marks.iter().zip([a, b, c, d, e, f]).all(|((at, _), to)| at.distance(to) < 1e-12));
    let entries: Vec<bool> = marks.iter().map(|(_, entry)| *entry).collect();
    assert_eq!(entries, [true, false, true, false, true, false]);
    let [ring] = &rings[..] else { panic!("{rings:?}") };
    let expected = [a, b, c, d, f, p(10.0, 6.5), e];
    assert_eq!(ring.len(), expected.len(), "{ring:?}");
    assert!(ring.iter().zip(expected).all(|(at, to)| at.distance(to) < 1e-12), "{ring:?}");
    // Above, on the right and below of the pentagon in the middle, which is wound around twice.
    let parts = [0.5800439, 4.5991041, 3.8502006];
    assert!((enclosed(ring) - parts.iter().sum::<f64>()).abs() < 1e-6);
}
