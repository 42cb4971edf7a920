//! Circles and text at windows: the arcs of a fine polygon, and the characters that boxes and outlines leave.

use crate::raster_coverage::Random;
use durer::clip::circle::{self, Arc, Circle};
use durer::clip::outcode::Outcode;
use durer::clip::polygon::{self, PolygonClipper, Shapes, WindingRule};
use durer::clip::text::{self, BoxPlace, Character, Kept, Options, TextClipper, of_strokes};
use durer::curve::Contours;
use durer::math::{DVec2, Rect};
use durer::trace::{NoTrace, PseudocodeLine, Recorder};
use std::f64::consts::{PI, TAU};

fn rect(low: (f64, f64), high: (f64, f64)) -> Rect {
    Rect::new(low.into(), high.into()).unwrap()
}

fn clipped(window: &Rect, circle: &Circle) -> Vec<Arc> {
    let mut steps = Recorder::default();
    let arcs = circle::clip(window, circle, &mut steps).unwrap();
    assert_eq!(circle::clip(window, circle, &mut NoTrace).unwrap(), arcs);
    assert_eq!(circle::replay(steps.steps()), arcs);
    arcs
}

/// A point of the circle is in an arc if it is in the window; the ends of arcs are on the circle and on a border.
#[test]
fn arcs_are_the_visible_part_of_a_fine_polygon() {
    let mut random = Random(61);
    let window = rect((0.0, 0.0), (10.0, 6.0));
    let mut counts = [0; 5];
    for round in 0..600 {
        let whole = round % 3 == 0;
        let grid = |v: f64| if whole { v.round() } else { v };
        let p = random.point(-6.0, 14.0);
        let center = DVec2::new(grid(p.x), grid(p.y));
        let circle = if round % 4 == 1 {
            // Around the middle, wider than the window and not around its corners.
            let middle = DVec2::new(5.0, 3.0) + random.point(-0.7, 0.7);
            Circle { center: middle, radius: 5.0 + random.next() }
        } else {
            Circle { center, radius: grid(random.next() * 9.0) }
        };
        let center = circle.center;
        let arcs = clipped(&window, &circle);
        counts[arcs.len()] += 1;
        for arc in &arcs {
            let [from, to] = arc.angles;
            assert!((0.0..TAU).contains(&from) && from < to && to - from <= TAU, "{arc:?}");
            for (angle, end) in arc.angles.into_iter().zip(arc.ends) {
                assert!(circle.at(angle).distance(end) < 1e-7, "{circle:?} {arc:?}");
                let on_x = [0.0, 10.0].contains(&end.x);
                let on_border = on_x || [0.0, 6.0].contains(&end.y) || to - from == TAU;
                assert!(on_border, "{circle:?} {arc:?}");
                assert!((end.distance(center) - circle.radius).abs() < 1e-12 * 20.0, "{arc:?}");
            }
        }
        assert!(arcs.windows(2).all(|pair| pair[0].angles[1] <= pair[1].angles[0]), "{arcs:?}");
        for k in 0..720 {
            let angle = (f64::from(k) + 0.37) / 720.0 * TAU;
            let point = circle.at(angle);
            let near = [point.x, 10.0 - point.x, point.y, 6.0 - point.y];
            if near.iter().any(|d| d.abs() < 1e-9) {
                continue;
            }
            let holds = |arc: &Arc| {
                [angle, angle + TAU].iter().any(|a| arc.angles[0] <= *a && *a <= arc.angles[1])
            };
            let inside = Outcode::of_point_2d(&window, point).is_inside();
            assert_eq!(arcs.iter().any(holds), inside, "{circle:?} {angle} {arcs:?}");
        }
    }
    assert!(counts.iter().all(|count| *count > 0), "{counts:?}");
}

/// d, α and the arcs of the page: two borders of four cut the circle, and the arc between them is left.
#[test]
fn borders_take_their_angles_away() {
    use circle::Step;
    let window = rect((0.0, 0.0), (9.0, 8.0));
    let own = Circle { center: DVec2::splat(5.0), radius: 5.0 };
    let mut steps = Recorder::default();
    let arcs = circle::clip(&window, &own, &mut steps).unwrap();
    let steps = steps.steps();
    let crossed = Outcode::RIGHT | Outcode::TOP;
    assert_eq!(steps[0], Step::Box { beyond: Outcode::INSIDE, crossed });
    let borders: Vec<_> = steps[1..5]
        .iter()
        .map(|s| match *s {
            Step::Border { border, distance, taken } => {
                let degrees =
                    taken.map(|angles| angles.map(|a| (a.to_degrees() * 100.0).round() / 100.0));
                (border, distance, degrees)
            }
            _ => panic!("{s:?}"),
        })
        .collect();
    let expected = [
        (Outcode::LEFT, 5.0, None),
        (Outcode::RIGHT, 4.0, Some([-36.87, 36.87])),
        (Outcode::BOTTOM, 5.0, None),
        (Outcode::TOP, 3.0, Some([36.87, 143.13])),
    ];
    assert_eq!(borders, expected);
    assert_eq!(steps.iter().map(Step::line).collect::<Vec<_>>(), [1, 6, 8, 6, 8, 9]);
    assert_eq!(arcs.len(), 1);
    assert_eq!(arcs[0].ends, [DVec2::new(1.0, 8.0), DVec2::new(9.0, 2.0)]);
}

#[test]
fn whole_circles_and_none_need_no_border() {
    let window = rect((0.0, 0.0), (8.0, 6.0));
    let at = |x: f64, y: f64, radius: f64| {
        let circle = Circle { center: DVec2::new(x, y), radius };
        let mut steps = Recorder::default();
        let arcs = circle::clip(&window, &circle, &mut steps).unwrap();
        let borders = steps.steps().iter().filter(|s| matches!(s, circle::Step::Border { .. }));
        (arcs.len(), borders.count())
    };
    // Inside, touching all but one border from within, a point, beside, touching from outside, around the window.
    assert_eq!(at(4.0, 3.0, 3.0), (1, 0));
    assert_eq!(at(3.0, 3.0, 3.0), (1, 0));
    assert_eq!(at(8.0, 6.0, 0.0), (1, 0));
    assert_eq!(at(13.0, 3.0, 3.0), (0, 0));
    assert_eq!(at(11.0, 3.0, 3.0), (0, 4));
    assert_eq!(at(4.0, 3.0, 5.5), (0, 4));
    // Half a circle on a border.
    let half = clipped(&window, &Circle { center: DVec2::new(4.0, 6.0), radius: 2.0 });
    assert_eq!(half[0].angles, [PI, TAU]);
    for wrong in [-1.0, f64::NAN, f64::INFINITY] {
        let circle = Circle { center: DVec2::ZERO, radius: wrong };
        assert!(circle::clip(&window, &circle, &mut NoTrace).is_err());
    }
    let nowhere = Circle { center: DVec2::new(f64::NAN, 0.0), radius: 1.0 };
    assert!(circle::clip(&window, &nowhere, &mut NoTrace).is_err());
    // So large that it is a straight line in the window, from side to side.
    let huge = Circle { center: DVec2::new(4.0, 3.0 - 1e8), radius: 1e8 };
    let ends = clipped(&window, &huge)[0].ends;
    assert!(ends[0].distance(DVec2::new(8.0, 3.0)) < 1e-6, "{ends:?}");
    assert!(ends[1].distance(DVec2::new(0.0, 3.0)) < 1e-6, "{ends:?}");
    let far = Circle { center: DVec2::splat(1e308), radius: circle::MAX_RADIUS };
    assert!(clipped(&window, &far).is_empty());
    let beyond = Circle { center: DVec2::ZERO, radius: 2.0 * circle::MAX_RADIUS };
    assert!(circle::clip(&window, &beyond, &mut NoTrace).is_err());
}

fn kept(window: &Rect, text: &[Character], clipper: TextClipper) -> Vec<Kept> {
    let options = Options { clipper };
    let mut steps = Recorder::default();
    let kept = text::clip(window, text, &options, &mut steps).unwrap();
    assert_eq!(text::clip(window, text, &options, &mut NoTrace).unwrap(), kept);
    assert_eq!(text::replay(steps.steps()), kept);
    kept
}

fn numbers(kept: &[Kept]) -> Vec<usize> {
    kept.iter().map(|kept| kept.character).collect()
}

/// Whatever is kept by the string is kept by characters, and that by outlines; outlines are the strokes' part in the window.
#[test]
fn ways_to_clip_text_leave_more_and_more() {
    let text = of_strokes("Dürer 1525 jg", 12.0, DVec2::new(3.0, 1.0)).unwrap();
    let length = |outline: &Contours| -> f64 {
        let pieces = outline.iter().flat_map(|(points, _)| points.windows(2));
        pieces.map(|pair| pair[0].distance(pair[1])).sum()
    };
    let mut random = Random(17);
    let (mut strings, mut cut) = (0, 0);
    for round in 0..200 {
        let (p, q) = (random.point(-10.0, 160.0), random.point(-10.0, 160.0));
        let lower = random.point(-8.0, 6.0);
        let wide = if round % 4 == 0 { 200.0 } else { 0.0 };
        let low = DVec2::new(p.x.min(q.x) - wide, lower.x);
        let window =
            Rect::new(low, DVec2::new(p.x.max(q.x) + wide, lower.y.max(low.y) + 9.0)).unwrap();
        let [string, characters, outlines] =
            [TextClipper::String, TextClipper::Character, TextClipper::Outline]
                .map(|clipper| kept(&window, &text, clipper));
        assert!(string.is_empty() || string.len() == text.len());
        assert!(string.iter().all(|own| characters.contains(own)));
        assert!(characters.iter().all(|own| outlines.contains(own)));
        strings += usize::from(!string.is_empty());
        let within = |own: &&Character| {
            let corners = [own.bounds.min(), own.bounds.max()];
            corners.iter().all(|corner| window.contains(*corner))
        };
        assert_eq!(characters.len(), text.iter().filter(within).count());
        // Of each stroke as much as a line clipper leaves, segment by segment.
        for (number, own) in text.iter().enumerate() {
            let found = outlines.iter().find(|kept| kept.character == number);
            let segments = own.outline.iter().flat_map(|(points, _)| points.windows(2));
            let expected: f64 = segments
                .filter_map(|pair| {
                    let segment = durer::clip::line::Segment::new(pair[0], pair[1]);
                    durer::clip::line::liang_barsky::clip(&window, segment, &mut NoTrace).unwrap()
                })
                .map(|part| part.start.distance(part.end))
                .sum();
            let found = found.map_or(0.0, |kept| length(&kept.outline));
            assert!((found - expected).abs() < 1e-9, "{number}: {found} {expected}");
            cut += usize::from(found > 0.0 && found < length(&own.outline) - 1e-9);
        }
    }
    assert!(strings > 0 && cut > 100, "{strings} {cut}");
}

/// Rings of a glyph are clipped as polygons: the filled area is that of the overlay.
#[test]
fn rings_of_outlines_are_clipped_as_polygons() {
    let ring = |points: &[(f64, f64)]| points.iter().map(|p| DVec2::from(*p)).collect::<Vec<_>>();
    let outer = ring(&[
        (0.0, 0.0),
        (3.0, 0.0),
        (4.0, 3.0),
        (7.0, 3.0),
        (8.0, 0.0),
        (11.0, 0.0),
        (7.0, 12.0),
        (4.0, 12.0),
    ]);
    let hole = ring(&[(4.8, 5.5), (5.5, 8.5), (6.2, 5.5)]);
    let mut outline = Contours::new();
    outline.push(outer.clone(), true);
    outline.push(hole.clone(), true);
    let letter = Character { bounds: rect((-1.0, 0.0), (12.0, 12.0)), outline };
    let window = rect((2.0, 1.0), (20.0, 7.0));
    let found = kept(&window, std::slice::from_ref(&letter), TextClipper::Outline);
    let rings: Vec<Vec<DVec2>> =
        found[0].outline.iter().map(|(points, _)| points.to_vec()).collect();
    assert_eq!(rings.len(), 2);
    let area: f64 = rings.iter().map(|ring| polygon::signed_area(ring)).sum();
    let window_ring = ring(&[(2.0, 1.0), (20.0, 1.0), (20.0, 7.0), (2.0, 7.0)]);
    let [subject, clip] = [Shapes::from_rings([outer, hole]), Shapes::from_rings([window_ring])];
    let expected =
        PolygonClipper::Overlay.clip(&subject, &clip, polygon::BooleanOp::Intersection).unwrap();
    assert!((area - expected.area()).abs() < 1e-6, "{area} {}", expected.area());
    // A point is in the letter's part if it is in the letter and in the window.
    let inside = |p: DVec2| {
        let rings = rings.iter().map(Vec::as_slice);
        polygon::point::locate(rings, p, WindingRule::EvenOdd) == polygon::point::Place::Inside
    };
    assert!(
        inside(DVec2::new(5.5, 4.0))
            && !inside(DVec2::new(5.5, 6.0))
            && !inside(DVec2::new(5.5, 0.5))
    );
}

/// The page's word: W crosses the left border, A and V are within, E crosses the right one, S is beyond it.
#[test]
fn boxes_decide_before_outlines() {
    use text::Step;
    let text = of_strokes("WAVES", 12.0, DVec2::ZERO).unwrap();
    let ends: Vec<f64> = text.iter().map(|own| own.bounds.max().x).collect();
    let borders = [14.4, 25.8, 37.2, 47.0, 57.4];
    assert!(ends.iter().zip(borders).all(|(end, x)| (end - x).abs() < 1e-9), "{ends:?}");
    let window = rect((5.0, -5.0), (38.0, 13.0));
    let places = |clipper| {
        let mut steps = Recorder::default();
        text::clip(&window, &text, &Options { clipper }, &mut steps).unwrap();
        let place = |s: &Step| match *s {
            Step::Box { character, place, .. } => Some((character, place)),
            _ => None,
        };
        steps.steps().iter().filter_map(place).collect::<Vec<_>>()
    };
    assert_eq!(places(TextClipper::String), [(None, BoxPlace::Crossing)]);
    let each = [
        BoxPlace::Crossing,
        BoxPlace::Within,
        BoxPlace::Within,
        BoxPlace::Crossing,
        BoxPlace::Beyond,
    ];
    let each: Vec<_> = each.into_iter().enumerate().map(|(k, place)| (Some(k), place)).collect();
    assert_eq!(places(TextClipper::Character), each);
    assert_eq!(places(TextClipper::Outline), each);
    assert!(kept(&window, &text, TextClipper::String).is_empty());
    assert_eq!(numbers(&kept(&window, &text, TextClipper::Character)), [1, 2]);
    // Of the E, only the space before it is in the window.
    assert_eq!(numbers(&kept(&window, &text, TextClipper::Outline)), [0, 1, 2]);
    let far = rect((500.0, 0.0), (600.0, 9.0));
    let mut steps = Recorder::default();
    text::clip(&far, &text, &Options::default(), &mut steps).unwrap();
    let dropped = steps.steps().iter().filter(|s| matches!(s, Step::Drop { .. })).count();
    assert_eq!((dropped, steps.steps().len()), (5, 10));
    assert!(TextClipper::ALL.iter().all(|clipper| kept(&far, &text, *clipper).is_empty()));
    let all = rect((-1.0, -9.0), (99.0, 20.0));
    assert!(TextClipper::ALL.iter().all(|clipper| kept(&all, &text, *clipper).len() == 5));
    assert!(kept(&all, &[], TextClipper::String).is_empty());
    let mut wrong = Contours::new();
    wrong.push([DVec2::ZERO, DVec2::new(f64::NAN, 1.0)], false);
    let wrong = [Character { bounds: all, outline: wrong }];
    assert!(text::clip(&all, &wrong, &Options::default(), &mut NoTrace).is_err());
    assert!(of_strokes("A", f64::NAN, DVec2::ZERO).is_err());
}
