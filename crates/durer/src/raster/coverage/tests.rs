//! Unit tests: every SIMD level gives the same bytes.

use super::*;
use crate::math::DVec2;
use crate::trace::NoTrace;

#[test]
fn every_simd_level_gives_the_same_bytes() {
    let mut seed = 3_u64;
    let mut random = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 33) as f64 / f64::from(1_u32 << 31) * 300.0 - 20.0
    };
    let contours = Contours::polygon((0..60).map(|_| DVec2::new(random(), random())));
    for rule in [FillRule::NonZero, FillRule::EvenOdd] {
        let options = Options { rule, ..Options::default() };
        let at = |level| fill_at(level, &contours, 257, 261, &options, &mut NoTrace).unwrap();
        let reference = at(Level::baseline());
        assert_eq!(at(Level::new()), reference);
        assert!(reference.data().iter().any(|c| *c > 0 && *c < 255));
    }
}

#[test]
fn convex_outlines_are_summed_with_and_without_marks_alike() {
    let mut seed = 8_u64;
    let mut random = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 33) as f64 / f64::from(1_u32 << 31)
    };
    let (width, height) = (180, 140);
    let (mut simple, mut lit) = (0, 0);
    for round in 0..600 {
        let corners = if round % 2 == 0 { 3 } else { 4 + round / 2 % 7 };
        let size = [0.7, 5.0, 14.0, 60.0, 110.0][round % 5];
        let center = DVec2::new(random() * 180.0, random() * 140.0);
        let thin = if round % 4 == 0 { 0.02 } else { 0.3 + random() };
        let (turn, lean) = (random() * 6.3, DVec2::from_angle(random() * 6.3));
        let point = |i: usize| {
            let angle = turn + i as f64 / corners as f64 * std::f64::consts::TAU;
            let p = DVec2::new(libm::cos(angle), libm::sin(angle) * thin) * size;
            let p = (center + p.rotate(lean)).clamp(DVec2::ZERO, DVec2::new(180.0, 140.0));
            // Some on borders and centres of pixels.
            if round % 3 == 0 { (p * 2.0).round() / 2.0 } else { p }
        };
        let (contours, mut list) = (Contours::polygon((0..corners).map(point)), Vec::new());
        let mut path = PathEdges::new(&contours, width, height, &mut list);
        simple += usize::from(path.whole);
        let mut at = |level, simple: bool| {
            path.whole &= simple;
            let mut mask = Pixels::new(width, height, 0);
            fill_path(level, &path, &list, &mut mask, &Options::default(), &mut NoTrace);
            mask
        };
        let (own, other) = (at(Level::new(), true), at(Level::baseline(), true));
        let cells = at(Level::new(), false);
        assert!(own == cells && other == cells, "round {round}");
        lit += own.data().iter().filter(|c| **c != 0).count();
    }
    assert!(simple > 400 && lit > 100_000, "{simple} {lit}");
}

#[test]
fn edges_and_joints_do_not_depend_on_the_chunks_they_are_made_in() {
    let mut seed = 5_u64;
    let mut random = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 33) as f64 / f64::from(1_u32 << 31)
    };
    let (size, mut edges, mut chained) = (DVec2::new(90.0, 70.0), 0, 0);
    for round in 0..400 {
        // Short and long steps, some on the grid, some outside the target, and a few NaN points.
        let step = [0.2, 0.8, 3.0, 40.0][round % 4];
        let mut contours = Contours::new();
        for _ in 0..1 + round % 3 {
            let mut p = DVec2::new(random(), random()) * size;
            let points: Vec<DVec2> = (0..1 + (random() * 60.0) as usize)
                .map(|i| {
                    p += (DVec2::new(random(), random()) - 0.5) * step;
                    match i % 23 {
                        7 if round % 5 == 0 => DVec2::new(f64::NAN, 1.0),
                        11 => p.round(),
                        _ => p,
                    }
                })
                .collect();
            contours.push(points, true);
        }
        let made = |points: usize| {
            let (chunks, extent) = outline::chunks(&contours, size, false, points);
            (chunks.into_iter().flat_map(|chunk| chunk.edges).collect::<Vec<_>>(), extent)
        };
        let all = made(1000);
        for points in [1, 2, 3, 7, 20] {
            assert_eq!(made(points), all, "round {round}, {points} points at once");
        }
        edges += all.0.len();
        chained += all.0.iter().filter(|edge| edge.chained() != (false, false)).count();
    }
    assert!(edges > 10_000 && chained > 5_000, "{edges} {chained}");
}
