//! Aliased polygons against exact point-in-polygon tests at pixel centres; partitions; triangulation.

use crate::raster_coverage::Random;
use durer::curve::{Contours, Path, flatten};
use durer::math::DVec2;
use durer::raster::coverage::FillRule;
use durer::raster::polygon::{Options, Span, Step, fill};
use durer::raster::triangulate::triangulate;
use durer::trace::{NoTrace, Recorder};

fn covered(contours: &Contours, side: u32, rule: FillRule) -> Vec<u32> {
    let mut counts = vec![0; (side * side) as usize];
    let count = |s: Span| (s.x0..s.x1).for_each(|x| counts[(s.y * side + x) as usize] += 1);
    fill(contours, side, side, &Options { rule }, count, &mut NoTrace);
    counts
}

/// The winding number of a pixel's centre, in integers: twice the coordinates, the centre at odd ones.
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
        // Vertices on quarters of pixels: centres and corners among them.
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
        let triangles = triangulate(&contours);
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
    let mut recorder: Recorder<Step> = Recorder::default();
    let mut spans = Vec::new();
    fill(&circle, 32, 32, &Options::default(), |s| spans.push(s), &mut recorder);
    let replayed: Vec<Span> = recorder
        .steps()
        .iter()
        .filter_map(|s| if let Step::Span(span) = s { Some(*span) } else { None })
        .collect();
    assert_eq!(replayed, spans);
    let area: u32 = spans.iter().map(|s| s.x1 - s.x0).sum();
    // Pixel centres within the circle, counted one by one; none is nearer to it than the chords.
    let across = |i: i32| f64::from(i % 32 - 16) + 0.5;
    let inside = (0..1024).filter(|i| across(*i).hypot(f64::from(i / 32 - 16) + 0.5) <= 11.3);
    assert_eq!(area as usize, inside.count());
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
