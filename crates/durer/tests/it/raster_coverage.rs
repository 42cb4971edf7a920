//! Exact area coverage, compared with an independent computation of the areas, and its invariants.

use durer::curve::Contours;
use durer::math::DVec2;
use durer::raster::coverage::{
    FillRule, Options, Overlap, PartitionFace, PartitionStep, Step, cell_sums, fill, fill_partition,
};
use durer::target::Pixels;
use durer::trace::{NoTrace, Recorder};

/// A small generator with the same numbers on every run.
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> f64 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as f64 / f64::from(1_u32 << 31)
    }

    pub fn point(&mut self, low: f64, high: f64) -> DVec2 {
        DVec2::new(low + self.next() * (high - low), low + self.next() * (high - low))
    }
}

const RULES: [FillRule; 2] = [FillRule::NonZero, FillRule::EvenOdd];

fn mask(contours: &Contours, width: u32, height: u32, rule: FillRule) -> Pixels<u8> {
    mask_with(contours, width, height, &Options { rule, ..Options::default() })
}

fn mask_with(contours: &Contours, width: u32, height: u32, options: &Options) -> Pixels<u8> {
    fill(contours, width, height, options, &mut NoTrace).expect("size")
}

fn edges(contours: &Contours) -> Vec<(DVec2, DVec2)> {
    let mut edges = Vec::new();
    for (points, _) in contours.iter() {
        for (i, p) in points.iter().enumerate() {
            edges.push((*p, points[(i + 1) % points.len()]));
        }
    }
    edges
}

/// Returns the area inside the outline for each pixel of one row: the row is cut at every vertex, at every crossing of
/// two edges and at every crossing of an edge with a pixel border.
fn row_areas(edges: &[(DVec2, DVec2)], y: u32, width: u32, rule: FillRule) -> Vec<f64> {
    let (top, bottom) = (f64::from(y), f64::from(y) + 1.0);
    let x_at = |e: &(DVec2, DVec2), y: f64| e.0.x + (e.1.x - e.0.x) * (y - e.0.y) / (e.1.y - e.0.y);
    let steep: Vec<_> = edges.iter().filter(|e| e.0.y != e.1.y).collect();
    let mut cuts = vec![top, bottom];
    for (i, e) in steep.iter().enumerate() {
        cuts.extend([e.0.y, e.1.y]);
        for x in 0..=width {
            if e.0.x != e.1.x {
                cuts.push(e.0.y + (e.1.y - e.0.y) * (f64::from(x) - e.0.x) / (e.1.x - e.0.x));
            }
        }
        for f in &steep[..i] {
            let (d, g) = (e.1 - e.0, f.1 - f.0);
            let cross = d.perp_dot(g);
            if cross != 0.0 {
                cuts.push(e.0.y + d.y * ((f.0 - e.0).perp_dot(g) / cross));
            }
        }
    }
    cuts.retain(|c| *c >= top && *c <= bottom);
    cuts.sort_by(f64::total_cmp);
    let mut areas = vec![0.0; width as usize];
    for pair in cuts.windows(2).filter(|p| p[1] > p[0]) {
        let middle = (pair[0] + pair[1]) / 2.0;
        let mut hits: Vec<(f64, i32)> = steep
            .iter()
            .filter(|e| (e.0.y < middle) != (e.1.y < middle))
            .map(|e| (x_at(e, middle), if e.0.y < e.1.y { 1 } else { -1 }))
            .collect();
        hits.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut winding = 0;
        for w in hits.windows(2) {
            winding += w[0].1;
            let inside = if rule == FillRule::NonZero { winding != 0 } else { winding % 2 != 0 };
            if inside {
                for (x, area) in areas.iter_mut().enumerate() {
                    let (left, right) = (w[0].0.max(x as f64), w[1].0.min(x as f64 + 1.0));
                    *area += (right - left).max(0.0) * (pair[1] - pair[0]);
                }
            }
        }
    }
    areas
}

/// Returns the largest difference from the exact coverage, in 1/255.
fn worst_error(contours: &Contours, width: u32, height: u32, rule: FillRule) -> f64 {
    error_of(&mask(contours, width, height, rule), contours, rule)
}

/// Returns the same for a given coverage.
fn error_of(found: &Pixels<u8>, contours: &Contours, rule: FillRule) -> f64 {
    let edges = edges(contours);
    let (width, height) = (found.width(), found.height());
    let mut worst = 0.0_f64;
    for y in 0..height {
        for (x, area) in row_areas(&edges, y, width, rule).iter().enumerate() {
            let error = (f64::from(found.row(y)[x]) - area * 255.0).abs();
            if error > worst && error > 0.53 {
                eprintln!("pixel {x},{y}: {} for {}", found.row(y)[x], area * 255.0);
            }
            worst = worst.max(error);
        }
    }
    worst
}

#[test]
fn coverage_is_the_exact_area_of_simple_and_crossing_polygons() {
    let mut random = Random(1);
    for round in 0..400 {
        let count = 3 + round % 6;
        let contours = Contours::polygon((0..count).map(|_| random.point(-3.0, 15.0)));
        for rule in RULES {
            let worst = worst_error(&contours, 12, 12, rule);
            assert!(worst <= 0.52, "round {round}, {rule:?}: {worst} {contours:?}");
        }
    }
}

#[test]
fn coverage_is_exact_on_a_coarse_grid_where_everything_meets() {
    let mut random = Random(2);
    for round in 0..400 {
        let mut contours = Contours::new();
        for _ in 0..1 + round % 3 {
            let points = (0..3 + round % 4).map(|_| (random.point(-2.0, 8.0) * 2.0).round() / 2.0);
            contours.push(points, true);
        }
        for rule in RULES {
            let worst = worst_error(&contours, 6, 6, rule);
            assert!(worst <= 0.52, "round {round}, {rule:?}: {worst} {contours:?}");
        }
    }
}

#[test]
fn coverage_is_exact_in_crowded_pixels() {
    let mut random = Random(4);
    for round in 0..100 {
        let contours = Contours::polygon((0..12).map(|_| random.point(0.0, 4.0)));
        for rule in RULES {
            let worst = worst_error(&contours, 4, 4, rule);
            assert!(worst <= 0.52, "round {round}, {rule:?}: {worst}");
        }
    }
}

#[test]
fn small_crowded_drawings_are_exact() {
    let contours = crowd(60, DVec2::new(96.0, 32.0), &mut Random(60));
    for rule in RULES {
        let worst = worst_error(&contours, 96, 32, rule);
        assert!(worst <= 1.0, "{rule:?}: {worst}");
    }
}

/// Makes many triangles of about six pixels, scattered over a drawing.
fn crowd(count: usize, size: DVec2, random: &mut Random) -> Contours {
    let mut contours = Contours::new();
    for _ in 0..count {
        let center = DVec2::new(random.next(), random.next()) * size;
        contours.push((0..3).map(|_| center + random.point(-4.0, 4.0)), true);
    }
    contours
}

#[test]
fn noise_is_exact_where_that_is_requested() {
    let contours = crowd(150, DVec2::new(40.0, 12.0), &mut Random(61));
    for rule in RULES {
        let of = |overlap| {
            let found = mask_with(&contours, 40, 12, &Options { rule, overlap });
            error_of(&found, &contours, rule)
        };
        let (exact, adaptive) = (of(Overlap::Exact), of(Overlap::Adaptive));
        assert!(exact <= 1.0, "{rule:?}: {exact}");
        // Otherwise the drawing would not distinguish the two.
        assert!(adaptive > 16.0, "{rule:?}: {adaptive}");
    }
}

#[test]
fn pixels_of_many_edges_are_measured() {
    let contours = crowd(120, DVec2::splat(3.0), &mut Random(62));
    let mut small = Contours::new();
    for (points, closed) in contours.iter() {
        small.push(points.iter().map(|p| *p * 0.4 + DVec2::splat(0.6)), closed);
    }
    let of = |overlap| {
        let rule = FillRule::EvenOdd;
        let found = mask_with(&small, 3, 3, &Options { rule, overlap });
        error_of(&found, &small, rule)
    };
    let (exact, accumulated) = (of(Overlap::Exact), of(Overlap::Accumulated));
    assert!(exact <= 2.0 && accumulated > 16.0, "{exact} {accumulated}");
}

#[test]
fn opposite_windings_do_not_cancel() {
    // The two halves of a bow-tie meet on the diagonal of every pixel.
    let points = [(0.0, 0.0), (8.0, 8.0), (8.0, 0.0), (0.0, 8.0)].map(|(x, y)| DVec2::new(x, y));
    let bow = Contours::polygon(points);
    for rule in RULES {
        assert!(worst_error(&bow, 8, 8, rule) <= 0.52);
    }
    // A pixel covered by one square and by another of opposite direction.
    let mut both = Contours::new();
    let square = |x: f64| {
        [(x, 0.0), (x + 0.5, 0.0), (x + 0.5, 1.0), (x, 1.0)].map(|(x, y)| DVec2::new(x, y))
    };
    both.push(square(0.0), true);
    both.push(square(0.5).into_iter().rev(), true);
    assert_eq!(mask(&both, 1, 1, FillRule::NonZero).data(), [255]);
    let accumulated = Options { overlap: Overlap::Accumulated, ..Options::default() };
    assert_eq!(fill(&both, 1, 1, &accumulated, &mut NoTrace).unwrap().data(), [0]);
    // Horizontal slivers of opposite winding, far from their ends.
    let mut slivers = Contours::new();
    let sliver = |y: f64| {
        [(0.0, y), (90.0, y), (90.0, y + 0.5), (0.0, y + 0.5)].map(|(x, y)| DVec2::new(x, y))
    };
    slivers.push(sliver(0.0), true);
    slivers.push(sliver(0.5).into_iter().rev(), true);
    assert_eq!(mask(&slivers, 90, 1, FillRule::NonZero).data(), [255; 90]);
}

#[test]
fn shallow_and_steep_edges_are_exact_across_many_pixels() {
    let mut random = Random(5);
    for _ in 0..40 {
        let points = [
            DVec2::new(-20.0 * random.next(), random.next()),
            DVec2::new(220.0, 3.0 * random.next()),
            DVec2::new(150.0 * random.next(), 4.0),
        ];
        let contours = Contours::polygon(points);
        let worst = worst_error(&contours, 200, 4, FillRule::NonZero);
        assert!(worst <= 0.52, "{worst} {points:?}");
        let turned = Contours::polygon(points.map(|p| DVec2::new(p.y, p.x)));
        let worst = worst_error(&turned, 4, 200, FillRule::NonZero);
        assert!(worst <= 0.52, "{worst} {points:?}");
    }
}

#[test]
fn reversal_and_the_starting_vertex_change_nothing() {
    let mut random = Random(6);
    for _ in 0..100 {
        let mut points: Vec<DVec2> = (0..7).map(|_| random.point(-5.0, 45.0)).collect();
        for rule in RULES {
            let reference = mask(&Contours::polygon(points.clone()), 40, 40, rule);
            points.reverse();
            assert_eq!(mask(&Contours::polygon(points.clone()), 40, 40, rule), reference);
            points.rotate_left(3);
            assert_eq!(mask(&Contours::polygon(points.clone()), 40, 40, rule), reference);
        }
    }
}

#[test]
fn steps_smaller_than_pixels_may_be_taken_either_way_from_anywhere() {
    let mut random = Random(16);
    for (longest, count, side) in [(1.0, 60, 12), (4.0, 90, 24), (12.0, 400, 64), (3.0, 6000, 64)] {
        for round in 0..40 {
            let (mut at, mut heading) = (random.point(4.0, f64::from(side) - 4.0), 0.0);
            let mut points = Vec::new();
            for _ in 0..count {
                // Smoothly bent curves and random walks, with steps of all sizes.
                heading += (random.next() - 0.5) * if round % 2 == 0 { 1.5 } else { 6.0 };
                let step = longest * random.next() * random.next() * random.next();
                at += DVec2::new(libm::cos(heading), libm::sin(heading)) * step;
                at = at.clamp(DVec2::splat(-2.0), DVec2::splat(f64::from(side) + 2.0));
                points.push(at);
            }
            for rule in RULES {
                let picture = |p: &[DVec2]| mask(&Contours::polygon(p.to_vec()), side, side, rule);
                let reference = picture(&points);
                points.rotate_left(count / 3 + round);
                assert!(picture(&points) == reference, "{longest} {count} {round}: turned on");
                points.reverse();
                assert!(picture(&points) == reference, "{longest} {count} {round}: reversed");
            }
        }
    }
}

/// Returns a star with its spikes on a circle, starting at one of its points.
fn star(center: DVec2, radius: f64, start: usize) -> Vec<DVec2> {
    let point = |i: usize| {
        let angle = 0.3 + (i + start) as f64 * 2.0 / 5.0 * std::f64::consts::TAU;
        center + DVec2::new(libm::cos(angle), libm::sin(angle)) * radius
    };
    (0..5).map(point).collect()
}

#[test]
fn tiny_stars_are_exact_wherever_they_begin() {
    let mut random = Random(21);
    for _ in 0..150 {
        let (center, radius) = (random.point(1.2, 2.8), 0.1 + random.next());
        for rule in RULES {
            let of = |start| mask(&Contours::polygon(star(center, radius, start)), 4, 4, rule);
            for start in 1..5 {
                let (a, b) = (of(0), of(start));
                let pairs = a.data().iter().zip(b.data());
                assert!(
                    pairs.clone().all(|(a, b)| a.abs_diff(*b) <= 1),
                    "{center} {radius} {start}"
                );
            }
            let worst = worst_error(&Contours::polygon(star(center, radius, 0)), 4, 4, rule);
            assert!(worst <= 0.52, "{worst}: {center} {radius} {rule:?}");
        }
    }
}

#[test]
fn a_closing_edge_that_crosses_near_the_start_is_exact() {
    let mut random = Random(23);
    for _ in 0..400 {
        // The first edge is inside a pixel, where the last may cross the second.
        let mut points = vec![random.point(2.0, 3.0), random.point(2.0, 3.0)];
        points.extend((0..2).map(|_| random.point(0.0, 5.0)));
        for rule in RULES {
            let worst = worst_error(&Contours::polygon(points.clone()), 5, 5, rule);
            assert!(worst <= 0.52, "{worst}: {rule:?} {points:?}");
        }
    }
}

#[test]
fn columns_are_alike_wherever_the_shape_stands() {
    // Words of 64 columns, bands of 32 rows: shapes that cross inside pixels at all their borders.
    let mut random = Random(22);
    for _ in 0..12 {
        // On a grid of 1/256, so that moving changes no bit of the shape.
        let on_grid = |p: DVec2| (p * 256.0).round() / 256.0;
        let points: Vec<DVec2> = (0..9).map(|_| on_grid(random.point(1.0, 7.0))).collect();
        for rule in RULES {
            let at = |x: u32, y: u32| {
                let offset = DVec2::new(x.into(), y.into());
                let mut moved = Contours::polygon(points.iter().map(|p| *p + offset));
                // So that columns are counted from the left border.
                moved.push([(0.0, 66.0), (1.0, 66.0), (0.0, 67.0)].map(DVec2::from), true);
                let whole = mask(&moved, 140, 72, rule);
                let pixel = |i: u32| whole.get(x + i % 8, y + i / 8).expect("inside");
                (0..64).map(pixel).collect::<Vec<u8>>()
            };
            let expected = at(0, 0);
            for (x, y) in (54..68).chain(120..132).map(|x| (x, 0)).chain((22..36).map(|y| (3, y))) {
                assert_eq!(at(x, y), expected, "{x},{y} {rule:?} {points:?}");
            }
        }
    }
}

#[test]
fn a_window_shows_what_the_whole_shows_there() {
    let mut random = Random(7);
    for _ in 0..100 {
        let points: Vec<DVec2> = (0..6).map(|_| random.point(-30.0, 130.0)).collect();
        let whole = mask(&Contours::polygon(points.clone()), 100, 100, FillRule::NonZero);
        let offset = DVec2::new(37.0, 41.0);
        let moved = Contours::polygon(points.iter().map(|p| *p - offset));
        let window = mask(&moved, 20, 30, FillRule::NonZero);
        for y in 0..30 {
            for x in 0..20 {
                let (a, b) = (whole.get(x + 37, y + 41).unwrap(), window.get(x, y).unwrap());
                assert!(a.abs_diff(b) <= 1, "{x},{y}: {a} {b}");
            }
        }
    }
}

#[test]
fn the_steps_rebuild_the_mask() {
    let mut random = Random(8);
    let contours = Contours::polygon((0..9).map(|_| random.point(-10.0, 110.0)));
    let mut recorder: Recorder<Step> = Recorder::default();
    let traced = fill(&contours, 100, 100, &Options::default(), &mut recorder).unwrap();
    assert_eq!(traced, mask(&contours, 100, 100, FillRule::NonZero));
    let mut rebuilt = Pixels::new(100, 100, 0_u8);
    for step in recorder.steps() {
        (step.x0..step.x1).for_each(|x| rebuilt.set(x, step.y, step.coverage));
    }
    assert_eq!(rebuilt, traced);
}

#[test]
fn strange_coordinates_give_defined_pictures() {
    let values = [
        f64::NAN,
        f64::INFINITY,
        f64::NEG_INFINITY,
        1e30,
        -1e30,
        f64::MAX,
        1e-300,
        -0.0,
        5.5,
        32768.0,
    ];
    for a in values {
        for b in values {
            let points =
                [DVec2::new(a, b), DVec2::new(b, 3.0), DVec2::new(7.5, a), DVec2::new(1.0, 2.0)];
            for (width, height) in [(0, 0), (0, 9), (9, 0), (1, 1), (65, 40)] {
                let contours = Contours::polygon(points);
                assert_eq!(
                    mask(&contours, width, height, FillRule::NonZero).data().len() as u32,
                    width * height
                );
            }
        }
    }
    let huge = |s: f64| [(-s, -s), (s, -s), (s, s), (-s, s)].map(|(x, y)| DVec2::new(x, y));
    for size in [1e3, 1e9, 1e30, f64::MAX] {
        let all = mask(&Contours::polygon(huge(size)), 70, 40, FillRule::NonZero);
        assert!(all.data().iter().all(|c| *c == 255), "{size}");
    }
    assert!(fill(&Contours::new(), 40_000, 1, &Options::default(), &mut NoTrace).is_err());
}

#[test]
fn a_million_vertices_that_cross_themselves_are_filled() {
    let mut random = Random(9);
    let contours = Contours::polygon((0..1_000_000).map(|_| random.point(0.0, 64.0)));
    let mask = mask(&contours, 64, 64, FillRule::NonZero);
    assert!(mask.data().iter().filter(|c| **c > 0).count() > 4000);
}

/// Returns triangles of a jittered grid over the whole target, each in a random colour.
fn mesh(random: &mut Random, cells: usize, side: f64) -> Vec<PartitionFace> {
    let step = side / cells as f64;
    let points: Vec<DVec2> = (0..(cells + 1) * (cells + 1))
        .map(|i| {
            let (x, y) = (i % (cells + 1), i / (cells + 1));
            let jitter =
                |i: usize, r: f64| if i == 0 || i == cells { 0.0 } else { (r - 0.5) * 0.9 };
            let offset = DVec2::new(jitter(x, random.next()), jitter(y, random.next()));
            (DVec2::new(x as f64, y as f64) + offset) * step
        })
        .collect();
    let mut faces = Vec::new();
    for i in 0..cells * cells {
        let a = i / cells * (cells + 1) + i % cells;
        for t in [[a, a + 1, a + cells + 2], [a, a + cells + 1, a + cells + 2]] {
            let color = [(random.next() * 255.0) as u8, 90, 160, 255];
            faces.push(PartitionFace { contours: Contours::polygon(t.map(|i| points[i])), color });
        }
    }
    faces
}

#[test]
fn steps_of_a_partition_rebuild_it() {
    let mut faces = mesh(&mut Random(4), 9, 37.0);
    faces.truncate(100);
    let below = Pixels::new(40, 33, [0, 255, 0, 128]);
    let (mut painted, mut unheard, mut replayed) = (below.clone(), below.clone(), below);
    let mut recorder = Recorder::default();
    let full = fill_partition(&faces, &mut painted, &mut recorder).unwrap();
    assert_eq!(fill_partition(&faces, &mut unheard, &mut NoTrace).unwrap(), full);
    assert_eq!(unheard, painted);
    let (mut sums, mut colored) = (Pixels::new(40, 33, 0), 0);
    for step in recorder.steps() {
        match *step {
            PartitionStep::Area { face, pixel: (x, y), area } => {
                assert!(face < faces.len());
                sums.set(x, y, sums.get(x, y).unwrap() + area);
            }
            PartitionStep::Pixel { pixel: (x, y), color } => {
                replayed.set(x, y, color);
                colored += 1;
            }
        }
    }
    assert_eq!(replayed, painted);
    let areas = sums.data();
    assert_eq!(areas.iter().filter(|sum| **sum > 0).count(), colored);
    // A pixel is full from 254.5 of 255 parts on.
    let enough = areas.iter().filter(|sum| **sum * 2 * 255 >= 65_536 * 509).count();
    assert_eq!(enough as u64, full);
}

#[test]
fn a_partition_is_exactly_full_in_any_order() {
    let mut random = Random(10);
    for side in [40_u32, 97] {
        let mut faces = mesh(&mut random, 13, f64::from(side));
        let mut reference = Pixels::new(side, side, [0, 255, 0, 255]);
        assert_eq!(
            fill_partition(&faces, &mut reference, &mut NoTrace).unwrap(),
            u64::from(side * side)
        );
        faces.reverse();
        let mut again = Pixels::new(side, side, [0, 255, 0, 255]);
        fill_partition(&faces, &mut again, &mut NoTrace).unwrap();
        assert_eq!(again, reference);
        // White faces over black: no pixel may be darker than white.
        faces.iter_mut().for_each(|f| f.color = [255; 4]);
        let mut white = Pixels::new(side, side, [0, 0, 0, 255]);
        fill_partition(&faces, &mut white, &mut NoTrace).unwrap();
        assert!(white.data().iter().all(|p| *p == [255; 4]));
    }
}

#[test]
fn cells_by_hand_give_the_production_fill() {
    let mut random = Random(21);
    for corners in [3, 4, 9, 30] {
        for rule in RULES {
            let contours = Contours::polygon((0..corners).map(|_| random.point(-9.0, 40.0)));
            let mut steps = Recorder::default();
            let found = cell_sums::fill(&contours, 31, 27, rule, &mut steps).expect("size");
            let options = Options { rule, overlap: Overlap::Accumulated };
            let fast = mask_with(&contours, 31, 27, &options);
            let far = |(a, b): (&u8, &u8)| a.abs_diff(*b) > 1;
            assert!(!found.data().iter().zip(fast.data()).any(far), "{corners} {rule:?}");
            let plain = cell_sums::fill(&contours, 31, 27, rule, &mut NoTrace).expect("size");
            assert_eq!(found, plain);
            assert_eq!(cell_sums::replay(steps.steps(), 31, 27), found);
        }
    }
    let far = Contours::polygon([(-1e300, 2.0), (1e300, 2.5), (1e300, 1e308)].map(DVec2::from));
    assert!(cell_sums::fill(&far, 8, 8, FillRule::NonZero, &mut NoTrace).is_ok());
    assert!(cell_sums::fill(&far, 40_000, 8, FillRule::NonZero, &mut NoTrace).is_err());
}
