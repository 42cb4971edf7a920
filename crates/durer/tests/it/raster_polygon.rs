//! Aliased polygons against exact point-in-polygon tests at pixel centres; partitions; triangulation.

use crate::raster_coverage::Random;
use durer::curve::{Contours, Path, flatten};
use durer::math::DVec2;
use durer::raster::Span;
use durer::raster::coverage::FillRule;
use durer::raster::polygon::{
    Options, PolygonRasterizer, edge_fill, edge_flag, edge_table, ordered_edge_list,
};
use durer::raster::triangulate::triangulate;
use durer::target::Pixels;
use durer::trace::{NoTrace, PseudocodeLine, Recorder};

fn spans(
    method: PolygonRasterizer,
    contours: &Contours,
    (width, height): (u32, u32),
    rule: FillRule,
) -> Vec<Span> {
    let mut spans = Vec::new();
    method.fill(contours, width, height, &Options { rule }, |s| spans.push(s));
    spans
}

/// Returns how often each pixel is covered; all methods agree.
fn covered(contours: &Contours, side: u32, rule: FillRule) -> Vec<u32> {
    let found = spans(PolygonRasterizer::EdgeTable, contours, (side, side), rule);
    for method in PolygonRasterizer::ALL {
        assert_eq!(spans(*method, contours, (side, side), rule), found, "{method} {contours:?}");
    }
    let mut counts = vec![0; (side * side) as usize];
    for s in found {
        (s.x0..s.x1).for_each(|x| counts[s.y as usize * side as usize + x as usize] += 1);
    }
    counts
}

/// Returns the winding number of a pixel's centre, in integers: coordinates are doubled, so that centres are odd.
fn winding(points: &[(i128, i128)], x: i128, y: i128) -> i32 {
    let (cx, cy) = (4 * x + 2, 4 * y + 2);
    let mut winding = 0;
    for (i, a) in points.iter().enumerate() {
        let b = points[(i + 1) % points.len()];
        // A centre level with a vertex counts as below it; one on an edge counts as right of it.
        let (up, down) = if a.1 <= b.1 { (*a, b) } else { (b, *a) };
        if up.1 <= cy && cy < down.1 {
            let cross = (cx - up.0) * (down.1 - up.1) - (cy - up.1) * (down.0 - up.0);
            if cross >= 0 {
                winding += if a.1 <= b.1 { 1 } else { -1 };
            }
        }
    }
    winding
}

#[test]
fn aliased_polygons_are_exact_on_ties() {
    let mut random = Random(1);
    for round in 0..600 {
        // Vertices on quarters of pixels, including centres and corners.
        let mut corner = || {
            let p = random.point(-12.0, 44.0);
            (p.x.round() as i128, p.y.round() as i128)
        };
        let points: Vec<(i128, i128)> = (0..3 + round % 5).map(|_| corner()).collect();
        let polygon = points.iter().map(|p| DVec2::new(p.0 as f64, p.1 as f64) / 4.0);
        let contours = Contours::polygon(polygon);
        for rule in [FillRule::NonZero, FillRule::EvenOdd] {
            let found = covered(&contours, 8, rule);
            for y in 0..8 {
                for x in 0..8 {
                    let w = winding(&points, x, y);
                    let inside = if rule == FillRule::NonZero { w != 0 } else { w % 2 != 0 };
                    assert_eq!(
                        found[(y * 8 + x) as usize],
                        u32::from(inside),
                        "{x},{y} {points:?}"
                    );
                }
            }
        }
    }
}

#[test]
fn triangulated_polygons_light_each_pixel_once() {
    let mut random = Random(2);
    for round in 0..60 {
        let count = 5 + round % 20;
        let center = DVec2::splat(20.0);
        let star = |random: &mut Random, low: f64, high: f64| -> Vec<DVec2> {
            (0..count)
                .map(|i| {
                    let a = f64::from(i) / f64::from(count) * std::f64::consts::TAU;
                    let r = low + random.next() * (high - low);
                    ((center + DVec2::new(a.cos(), a.sin()) * r) * 2.0).round() / 2.0
                })
                .collect()
        };
        let mut contours = Contours::polygon(star(&mut random, 9.0, 19.0));
        contours.push(star(&mut random, 2.0, 5.0).into_iter().rev(), true);
        let whole = covered(&contours, 40, FillRule::EvenOdd);
        let mut parts = vec![0; 1600];
        let triangles = triangulate(&contours, &mut NoTrace);
        for t in &triangles.triangles {
            let corners = t.map(|i| triangles.points[i as usize]);
            let part = covered(&Contours::polygon(corners), 40, FillRule::NonZero);
            parts.iter_mut().zip(part).for_each(|(a, b)| *a += b);
        }
        assert_eq!(parts, whole, "round {round}");
    }
}

#[test]
fn the_steps_of_a_polygon_rebuild_it() {
    let circle = flatten(&Path::circle(DVec2::splat(16.0), 11.3), 0.05);
    let found = spans(PolygonRasterizer::EdgeTable, &circle, (32, 32), FillRule::NonZero);
    let (mut table, mut list) = (Recorder::default(), Recorder::default());
    let (mut a, mut b) = (Vec::new(), Vec::new());
    let options = Options::default();
    edge_table::fill(&circle, 32, 32, &options, |s| a.push(s), &mut table);
    ordered_edge_list::fill(&circle, 32, 32, &options, |s| b.push(s), &mut list);
    let replayed = table.steps().iter().filter_map(|s| match s {
        edge_table::Step::Span(span) => Some(*span),
        _ => None,
    });
    assert!(a == found && b == found && replayed.eq(found.iter().copied()));
    let replayed = list.steps().iter().filter_map(|s| match s {
        ordered_edge_list::Step::Span(span) => Some(*span),
        ordered_edge_list::Step::Crossing { .. } => None,
    });
    assert!(replayed.eq(found.iter().copied()));
    // From crossings alone: each edge winds around everything to its right.
    let mut winding = [[0; 32]; 32];
    for step in list.steps() {
        if let ordered_edge_list::Step::Crossing { y, x, winding: change } = step {
            (*x..32).for_each(|x| winding[*y as usize][x as usize] += change);
        }
    }
    let inside = winding.iter().flatten().map(|w| u32::from(*w != 0));
    assert!(inside.eq(covered(&circle, 32, FillRule::NonZero)));
    let area: i32 = found.iter().map(|s| s.x1 - s.x0).sum();
    // Pixel centres in the circle, counted one by one; none is nearer to the circle than the chords.
    let across = |i: i32| f64::from(i % 32 - 16) + 0.5;
    let inside = (0..1024).filter(|i| across(*i).hypot(f64::from(i / 32 - 16) + 0.5) <= 11.3);
    assert_eq!(area as usize, inside.count());
}

#[test]
fn both_ways_fill_the_same_pixels() {
    let mut random = Random(7);
    for round in 0..120_u32 {
        // Small and large, with few edges and with many, near the target and far from it.
        let (width, height) = [(33, 70), (129, 64), (300, 40)][round as usize % 3];
        let count = [3, 8, 70, 400][round as usize / 3 % 4];
        let (low, high) =
            [(-20.0, 320.0), (-3e4, 6e4), (-2e5, 1e5), (0.0, 70.0)][round as usize / 12 % 4];
        let on_grid = round % 5 == 0;
        let corner = |_| {
            let p = random.point(low, high);
            if on_grid { (p * 2.0).round() / 2.0 } else { p }
        };
        let contours = Contours::polygon((0..count).map(corner).collect::<Vec<_>>());
        for rule in [FillRule::NonZero, FillRule::EvenOdd] {
            let [a, b] = [PolygonRasterizer::EdgeTable, PolygonRasterizer::OrderedEdgeList]
                .map(|method| spans(method, &contours, (width, height), rule));
            assert_eq!(a, b, "round {round} {rule:?}");
        }
    }
}

/// Checks that complements and flags find the pixels of the even-odd rule, wherever the fence is, and that steps
/// rebuild them.
#[test]
fn complements_and_flags_fill_the_same_pixels() {
    let mut random = Random(9);
    let mut plane = Pixels::new(45, 30, true);
    for round in 0..200_u32 {
        let on_grid = round % 3 == 0;
        let (low, high) = [(-10.0, 50.0), (-3e5, 3e5), (5.0, 25.0)][round as usize % 3];
        let corner = |_| {
            let p = random.point(low, high);
            if on_grid { (p * 2.0).round() / 2.0 } else { p }
        };
        let contours = Contours::polygon((0..3 + round % 6).map(corner).collect::<Vec<_>>());
        let mut expected = Pixels::new(45, 30, false);
        for span in spans(PolygonRasterizer::EdgeTable, &contours, (45, 30), FillRule::EvenOdd) {
            (span.x0..span.x1).for_each(|x| expected.set(x as u32, span.y as u32, true));
        }
        let mut touched = Vec::new();
        for fence in [None, Some(0), Some(20), Some(99)] {
            let options = edge_fill::Options { fence };
            let (mut found, mut steps) = (Pixels::new(45, 30, false), Recorder::default());
            edge_fill::fill(&contours, &mut found, &options, &mut steps);
            assert!(found == expected, "round {round} {fence:?}");
            assert!(edge_fill::replay((45, 30), steps.steps()) == expected);
            touched.push(steps.steps().iter().map(|step| step.columns().len()).sum::<usize>());
            // Twice cancels out.
            edge_fill::fill(&contours, &mut found, &options, &mut NoTrace);
            assert!(!found.data().contains(&true));
        }
        assert_eq!(touched[0], touched[3], "a fence after the last column is none");
        let mut steps = Recorder::default();
        edge_flag::fill(&contours, &mut plane, &mut steps);
        assert!(plane == expected, "round {round}");
        assert!(edge_flag::replay((45, 30), steps.steps()) == expected);
    }
}

/// Checks a square from column 2 to 6: edge fill touches everything to the right of both sides, a fence in its middle
/// only the square itself.
#[test]
fn a_fence_saves_pixels() {
    let square = [(2.0, 0.0), (6.0, 0.0), (6.0, 1.0), (2.0, 1.0)];
    let contours = Contours::polygon(square.map(|(x, y)| DVec2::new(x, y)));
    let runs = |fence| {
        let (mut plane, mut steps) = (Pixels::new(10, 1, false), Recorder::default());
        edge_fill::fill(&contours, &mut plane, &edge_fill::Options { fence }, &mut steps);
        let mut runs: Vec<_> = steps.steps().iter().map(|s| (s.columns(), s.line())).collect();
        runs.sort_by_key(|(columns, _)| columns.start);
        runs
    };
    assert_eq!(runs(None), [(2..10, 5), (6..10, 5)]);
    assert_eq!(runs(Some(4)), [(2..4, 5), (4..6, 6)]);
    let (mut plane, mut steps) = (Pixels::new(10, 1, false), Recorder::default());
    edge_flag::fill(&contours, &mut plane, &mut steps);
    let flags = steps.steps().iter().filter_map(|s| match s {
        edge_flag::Step::Flag { pixel, set } => Some((pixel[0], *set)),
        edge_flag::Step::Inside(_) => None,
    });
    let mut flags: Vec<_> = flags.collect();
    flags.sort_unstable();
    assert_eq!(flags, [(2, true), (6, true)]);
}

#[test]
fn high_edges_are_exact_in_every_row() {
    // Nearly vertical edges through pixel centres, with the largest possible height.
    let mut random = Random(8);
    for round in 0..40 {
        let height = [32_767, 9000, 300][round % 3];
        let (x, drift) = (5.0 + (random.next() * 20.0).round() / 2.0, f64::from(round as u32));
        let points =
            [(x, 0.0), (x + drift, f64::from(height)), (x - 3.0, 60_000.0), (x - 4.5, -3e4)];
        let contours = Contours::polygon(points.map(|(x, y)| DVec2::new(x, y)));
        let [a, b] = [PolygonRasterizer::EdgeTable, PolygonRasterizer::OrderedEdgeList]
            .map(|method| spans(method, &contours, (64, height), FillRule::NonZero));
        assert!(a == b && a.len() as u32 == height, "round {round}");
    }
}

#[test]
fn far_vertices_leave_edges_where_they_are() {
    // A half-plane whose border has slope 1/2 and passes through (10, 10), from increasing distances.
    for far in [1e3, 1e5, 1e6, 1e9] {
        let at = |t: f64| DVec2::new(10.1 + 2.0 * t, 10.1 + t);
        let corners = [at(-far), at(far), DVec2::new(-far, 3.0 * far)];
        let found = covered(&Contours::polygon(corners), 20, FillRule::NonZero);
        for (i, covered) in found.iter().enumerate() {
            let (x, y) = ((i % 20) as f64 + 0.5, (i / 20) as f64 + 0.5);
            let below = y - 10.1 - (x - 10.1) / 2.0;
            assert_eq!(*covered, u32::from(below > 0.0), "{far}: {x} {y}");
        }
    }
}

#[test]
fn strange_polygons_give_defined_spans() {
    for a in [f64::NAN, f64::INFINITY, 1e30, -1e30, -0.5, 1e-300] {
        let points = [DVec2::new(a, 1.0), DVec2::new(3.0, a), DVec2::new(9.0, 12.0)];
        let found = covered(&Contours::polygon(points), 8, FillRule::NonZero);
        assert!(found.iter().all(|c| *c <= 1));
    }
    let huge = [(-1e9, -1e9), (1e9, -1e9), (1e9, 1e9), (-1e9, 1e9)].map(|(x, y)| DVec2::new(x, y));
    assert!(covered(&Contours::polygon(huge), 8, FillRule::NonZero).iter().all(|c| *c == 1));
    assert!(covered(&Contours::new(), 0, FillRule::NonZero).is_empty());
}

#[test]
fn an_edge_just_right_of_a_centre_leaves_that_pixel_out() {
    // In units of 1/256 pixel: at the second row's centre the left edge is at 128 + 1/257; a pixel's centre is at 128.
    let corners = [(129.0, 128.0), (128.0, 385.0), (2000.0, 385.0), (2000.0, 128.0)];
    let at = |(x, y): (f64, f64)| DVec2::new(x / 256.0, y / 256.0);
    let contours = Contours::polygon(corners.map(at));
    for method in PolygonRasterizer::ALL {
        let found = spans(*method, &contours, (9, 3), FillRule::NonZero);
        assert_eq!(found, [0, 1].map(|y| Span { y, x0: 1, x1: 8 }), "{method}");
    }
}

#[test]
fn points_that_are_not_finite_are_left_out() {
    let corners = [(1.0, 1.0), (17.0, 3.0), (12.0, 18.0), (2.0, 15.0)].map(DVec2::from);
    let expected = covered(&Contours::polygon(corners), 20, FillRule::NonZero);
    for bad in [DVec2::NAN, DVec2::new(f64::INFINITY, 3.0), DVec2::new(4.0, f64::NEG_INFINITY)] {
        for place in 0..=4 {
            let mut points = corners.to_vec();
            points.insert(place, bad);
            let found = covered(&Contours::polygon(points), 20, FillRule::NonZero);
            assert_eq!(found, expected, "{bad} {place}");
        }
    }
}
