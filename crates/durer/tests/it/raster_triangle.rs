//! Triangles: the three rasterizers, the exact oracle, the top-left rule.

use durer::math::DVec2;
use durer::raster::Span;
use durer::raster::fixed::{self, GUARD_BAND, snap, unsnap};
use durer::raster::triangle::{
    Options, SnappedTriangle, TriangleRasterizer, edge_function, edge_walking, tiles,
};
use durer::trace::{NoTrace, Recorder};
use durer::view::window::PixelRect;
use proptest::prelude::*;

type Corners = [[i32; 2]; 3];

fn spans(method: TriangleRasterizer, corners: Corners, clip: PixelRect) -> Vec<Span> {
    let triangle = SnappedTriangle::new(corners).expect("within the guard band");
    let mut spans = Vec::new();
    method.rasterize(&triangle, &Options { clip }, |s| spans.push(s));
    spans
}

/// Finds spans by the definition: a sample moved infinitesimally to the right, and by far less downwards, is strictly
/// inside. That is the top-left rule without the words top and left.
fn oracle(corners: Corners, clip: PixelRect) -> Vec<Span> {
    let p = corners.map(|v| v.map(i128::from));
    let cross = |u: [i128; 2], v: [i128; 2]| u[0] * v[1] - u[1] * v[0];
    let minus = |u: [i128; 2], v: [i128; 2]| [u[0] - v[0], u[1] - v[1]];
    let area = cross(minus(p[1], p[0]), minus(p[2], p[0])).signum();
    let inside = |x: i32, y: i32| {
        let s = [i128::from(x) * 256 + 128, i128::from(y) * 256 + 128];
        area != 0
            && (0..3).all(|k| {
                let (a, d) = (p[k], minus(p[(k + 1) % 3], p[k]));
                let value = cross(d, minus(s, a));
                let moved = if value != 0 {
                    value
                } else if d[1] != 0 {
                    -d[1]
                } else {
                    d[0]
                };
                moved.signum() == area
            })
    };
    let mut spans = Vec::new();
    for y in clip.y0()..clip.y1() {
        let columns: Vec<i32> = (clip.x0()..clip.x1()).filter(|&x| inside(x, y)).collect();
        if let (Some(&x0), Some(&last)) = (columns.first(), columns.last()) {
            assert_eq!(columns.len() as i32, last + 1 - x0, "a triangle is convex");
            spans.push(Span { y, x0, x1: last + 1 });
        }
    }
    spans
}

fn rect(x0: i32, y0: i32, x1: i32, y1: i32) -> PixelRect {
    PixelRect::new(x0, y0, x1, y1).expect("not reversed")
}

/// Returns corners within 40 pixels, often on pixel centres and corners, often collinear.
fn small() -> impl Strategy<Value = Corners> {
    let coordinate = prop_oneof![
        -2000..9000i32,
        (-8..36i32).prop_map(|i| i * 256 + 128),
        (-8..36i32).prop_map(|i| i * 256),
        Just(128),
        Just(1152)
    ];
    let point = [coordinate.clone(), coordinate];
    prop_oneof![
        [point.clone(), point.clone(), point.clone()],
        // A sliver: the third corner is a few steps of the grid from the second.
        (point.clone(), point, -3..4i32, -3..4i32).prop_map(|(a, b, dx, dy)| [
            a,
            b,
            [b[0] + dx, b[1] + dy]
        ]),
    ]
}

fn huge() -> impl Strategy<Value = Corners> {
    let limit = (GUARD_BAND as i32) * 256;
    let coordinate = prop_oneof![-limit..=limit, Just(limit), Just(-limit), -9000..9000i32];
    let point = [coordinate.clone(), coordinate];
    [point.clone(), point.clone(), point]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(3000))]

    #[test]
    fn triangles_agree_with_the_exact_oracle(corners in small()) {
        let clip = rect(-8, -8, 36, 36);
        let expected = oracle(corners, clip);
        for &method in TriangleRasterizer::ALL {
            prop_assert_eq!(&spans(method, corners, clip), &expected, "{}", method);
        }
    }

    #[test]
    fn huge_triangles_agree_with_the_exact_oracle(corners in huge(), x in -40..40i32, y in -40..40i32) {
        let clip = rect(x, y, x + 11, y + 13);
        let expected = oracle(corners, clip);
        for &method in TriangleRasterizer::ALL {
            prop_assert_eq!(&spans(method, corners, clip), &expected, "{}", method);
        }
    }

    #[test]
    fn tracing_changes_no_output_and_replays(corners in small()) {
        let triangle = SnappedTriangle::new(corners).unwrap();
        let options = Options { clip: rect(-3, -5, 30, 31) };
        let plain = spans(TriangleRasterizer::Tiles, corners, options.clip);

        let (mut steps, mut traced) = (Recorder::default(), Vec::new());
        edge_function::rasterize(&triangle, &options, |s| traced.push(s), &mut steps);
        prop_assert_eq!(&traced, &plain);
        prop_assert_eq!(&replay_samples(steps.steps()), &plain);

        let (mut steps, mut traced) = (Recorder::default(), Vec::new());
        edge_walking::rasterize(&triangle, &options, |s| traced.push(s), &mut steps);
        prop_assert_eq!(&traced, &plain);
        prop_assert_eq!(&replay_rows(steps.steps(), &options.clip), &plain);

        let (mut steps, mut traced) = (Recorder::default(), Vec::new());
        tiles::rasterize(&triangle, &options, |s| traced.push(s), &mut steps);
        prop_assert_eq!(&traced, &plain);
        prop_assert_eq!(&replay_tiles(steps.steps(), &options.clip), &plain);
    }
}

/// Joins pixels, in any order, into spans.
fn joined(mut pixels: Vec<(i32, i32)>) -> Vec<Span> {
    pixels.sort_unstable();
    let mut spans: Vec<Span> = Vec::new();
    for (y, x) in pixels {
        match spans.last_mut() {
            Some(s) if s.y == y && s.x1 == x => s.x1 += 1,
            _ => spans.push(Span { y, x0: x, x1: x + 1 }),
        }
    }
    spans
}

fn replay_samples(steps: &[edge_function::Step]) -> Vec<Span> {
    let covered = steps.iter().filter_map(|&edge_function::Step::Sample { x, y, edges }| {
        edges.iter().all(|&e| e >= 0).then_some((y, x))
    });
    joined(covered.collect())
}

fn replay_rows(steps: &[edge_walking::Step], clip: &PixelRect) -> Vec<Span> {
    let mut pixels = Vec::new();
    for step in steps {
        if let &edge_walking::Step::Row { y, left, right } = step {
            let columns = left.max(clip.x0().into())..right.min(clip.x1().into());
            pixels.extend(columns.map(|x| (y, x as i32)));
        }
    }
    joined(pixels)
}

fn replay_tiles(steps: &[tiles::Step], clip: &PixelRect) -> Vec<Span> {
    let mut pixels = Vec::new();
    for &tiles::Step::Tile { x, y, rows, .. } in steps {
        for (row, mask) in rows.iter().enumerate() {
            let lit = (0..8).filter(|k| mask >> k & 1 == 1).map(|k| (y + row as i32, x + k));
            pixels.extend(lit.filter(|&(y, x)| clip.contains(x, y)));
        }
    }
    joined(pixels)
}

/// Returns the number of times that each pixel of a square picture is lit.
fn lit(method: TriangleRasterizer, triangles: &[Corners], side: i32) -> Vec<u8> {
    let mut counts = vec![0u8; (side * side) as usize];
    for &corners in triangles {
        for s in spans(method, corners, rect(0, 0, side, side)) {
            for x in s.x0..s.x1 {
                counts[(s.y * side + x) as usize] += 1;
            }
        }
    }
    counts
}

/// Returns a grid of cells whose inner corners are moved by up to a quarter cell, each cell split in two.
fn jittered_grid(cells: usize, side: i32, random: &[(i32, i32, bool)]) -> Vec<Corners> {
    let n = cells + 1;
    let cell = side * 256 / cells as i32;
    let corner = |i: usize, j: usize| {
        let moved = |k: usize, by: i32| {
            let at = if k == cells { side * 256 } else { k as i32 * cell };
            if k == 0 || k == cells { at } else { at + by * (cell / 4) / 100 }
        };
        let (dx, dy, on_center) = random[(j * n + i) % random.len()];
        let p = [moved(i, dx), moved(j, dy)];
        // On a pixel centre, if it is near enough not to fold the grid.
        let inner = i > 0 && i < cells && j > 0 && j < cells && cell >= 2048;
        if on_center && inner { p.map(|c| (c & !255) + 128) } else { p }
    };
    let mut triangles = Vec::new();
    for j in 0..cells {
        for i in 0..cells {
            let [a, b, c, d] =
                [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(|(i, j)| corner(i, j));
            if random[(j * cells + i) % random.len()].0 > 0 {
                triangles.extend([[a, b, c], [a, c, d]]);
            } else {
                triangles.extend([[b, c, d], [d, a, b]]);
            }
        }
    }
    triangles
}

/// Returns points inserted one after another, each splitting its triangle into three.
fn split_by_points(side: i32, points: &[[i32; 2]]) -> Vec<Corners> {
    let s = side * 256;
    let mut triangles = vec![[[0, 0], [s, 0], [s, s]], [[0, 0], [s, s], [0, s]]];
    let area = |a: [i32; 2], b: [i32; 2], c: [i32; 2]| {
        SnappedTriangle::new([a, b, c]).unwrap().doubled_area()
    };
    for &p in points {
        let holds = |t: &Corners| (0..3).all(|k| area(t[k], t[(k + 1) % 3], p) >= 0);
        if let Some(i) = triangles.iter().position(holds) {
            let [a, b, c] = triangles.swap_remove(i);
            triangles.extend([[a, b, p], [b, c, p], [c, a, p]]);
        }
    }
    triangles
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn a_triangulated_square_lights_each_pixel_once(
        cells in 1..14usize,
        random in prop::collection::vec((-100..=100i32, -100..=100i32, any::<bool>()), 17..40),
        points in prop::collection::vec([0..=48*256i32, 0..=48*256i32], 0..60),
        centers in prop::collection::vec([0..48i32, 0..48i32], 0..30),
    ) {
        let side = 48;
        let on_centers = centers.iter().map(|c| c.map(|i| i * 256 + 128));
        let all: Vec<_> = points.iter().copied().chain(on_centers).collect();
        for triangles in [jittered_grid(cells, side, &random), split_by_points(side, &all)] {
            for &method in TriangleRasterizer::ALL {
                let counts = lit(method, &triangles, side);
                prop_assert!(counts.iter().all(|&n| n == 1), "{} {:?}", method, counts);
            }
        }
    }
}

#[test]
fn coordinates_beyond_the_guard_band_are_errors() {
    let limit = GUARD_BAND;
    let at = |x: f64| SnappedTriangle::snap([DVec2::new(x, 0.0), DVec2::Y, DVec2::ONE]);
    assert!(at(limit).is_ok() && at(-limit).is_ok());
    assert!(at(limit * (1.0 + f64::EPSILON)).is_err());
    assert!(at(f64::NAN).is_err() && at(f64::INFINITY).is_err());
    assert!(SnappedTriangle::new([[i32::MIN, 0], [0, 0], [0, 9]]).is_err());
}

#[test]
fn nothing_is_emitted_for_no_area_or_no_pixels() {
    let line = [[0, 0], [512, 512], [5120, 5120]];
    let body = [[0, 0], [5120, 0], [0, 5120]];
    for &method in TriangleRasterizer::ALL {
        assert_eq!(spans(method, line, PixelRect::EVERYTHING), []);
        assert_eq!(spans(method, [[7, 7]; 3], PixelRect::EVERYTHING), []);
        assert_eq!(spans(method, body, rect(3, 3, 3, 9)), []);
        assert_eq!(spans(method, body, rect(100, 100, 200, 200)), []);
    }
}

/// Checks the triangles and pixels in the figure of Direct3D 11.3, Functional Specification, 3.4.2.
mod conformance_d3d11 {
    use super::*;

    /// Corners in pixels as in the figure, and the shaded pixels as (row, columns from, to exclusive).
    type Case = ([(f64, f64); 3], &'static [(i32, i32, i32)]);

    const FIGURE: [Case; 14] = [
        ([(1.0, 1.0), (6.0, 2.0), (2.0, 4.0)], &[(1, 1, 3), (2, 1, 5), (3, 2, 3)]),
        ([(5.25, 1.25), (6.25, 0.25), (6.25, 1.25)], &[]),
        ([(6.5, 1.5), (7.5, 0.5), (7.5, 1.5)], &[]),
        ([(7.75, 2.5), (9.75, 0.75), (11.75, 2.5)], &[(1, 9, 11)]),
        ([(7.75, 2.5), (11.75, 2.5), (9.5, 5.25)], &[(2, 8, 12), (3, 8, 11), (4, 9, 10)]),
        ([(1.0, 6.0), (7.0, 4.0), (5.0, 6.0)], &[(4, 5, 6), (5, 2, 5)]),
        ([(7.0, 4.0), (5.0, 6.0), (8.0, 7.0)], &[(4, 6, 7), (5, 5, 7), (6, 6, 8)]),
        ([(7.0, 4.0), (8.0, 7.0), (9.5, 5.5)], &[(4, 7, 8), (5, 7, 9)]),
        ([(11.5, 4.5), (11.5, 6.5), (12.5, 5.5)], &[(5, 11, 12)]),
        ([(13.5, 1.5), (15.0, 0.0), (14.5, 2.5)], &[(0, 14, 15), (1, 13, 15)]),
        ([(13.5, 1.5), (14.5, 2.5), (14.5, 4.5)], &[]),
        ([(13.5, 5.5), (15.5, 5.5), (13.5, 7.5)], &[(5, 13, 15), (6, 13, 14)]),
        ([(15.5, 5.5), (15.5, 7.5), (13.5, 7.5)], &[(6, 14, 15)]),
        ([(9.5, 7.5), (10.5, 7.5), (9.5, 9.5)], &[(7, 9, 10)]),
    ];

    #[test]
    fn triangle_figure_is_reproduced_in_every_corner_order() {
        let target = rect(0, 0, 16, 8);
        for (corners, pixels) in FIGURE {
            let shaded: Vec<Span> = pixels.iter().map(|&(y, x0, x1)| Span { y, x0, x1 }).collect();
            for order in [[0, 1, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0], [1, 0, 2], [0, 2, 1]] {
                let corners = order.map(|k| [snap(corners[k].0), snap(corners[k].1)]);
                for &method in TriangleRasterizer::ALL {
                    assert_eq!(spans(method, corners, target), shaded, "{method} {corners:?}");
                }
            }
        }
    }

    #[test]
    fn no_pixel_of_the_figure_is_lit_twice() {
        let triangles = FIGURE.map(|(c, _)| c.map(|(x, y)| [snap(x), snap(y)]));
        for &method in TriangleRasterizer::ALL {
            let counts = lit(method, &triangles, 16);
            assert!(counts.iter().all(|&n| n <= 1));
            let target = &counts[..8 * 16]; // the last triangle reaches below it
            assert_eq!(target.iter().map(|&n| u32::from(n)).sum::<u32>(), 38);
        }
    }

    /// Checks the example of the figure on conversion to fixed point.
    #[test]
    fn snapping_rounds_as_the_figure_says() {
        let n = f32::from_bits(0xc5ff_fd0c);
        assert_eq!(unsnap(snap(f64::from(n))), -8192.0 + 0.367_187_5);
        assert_eq!([snap(0.5 / 256.0), snap(1.5 / 256.0), snap(-0.5 / 256.0)], [0, 2, 0]);
        assert_eq!(snap(f64::NAN), 0);
    }

    /// Checks that a point, a square of width 1 around its position as two triangles in a Z pattern (3.4.6), lights
    /// exactly one pixel wherever it is.
    #[test]
    fn a_point_as_two_triangles_lights_one_pixel() {
        for i in 0..1024 {
            let (x, y) = (3.0 + f64::from(i % 32) / 16.0, 4.0 + f64::from(i / 32) / 16.0);
            let corner = |dx: f64, dy: f64| [snap(x + dx), snap(y + dy)];
            let [a, b] = [corner(-0.5, -0.5), corner(0.5, -0.5)];
            let [c, d] = [corner(-0.5, 0.5), corner(0.5, 0.5)];
            for &method in TriangleRasterizer::ALL {
                let counts = lit(method, &[[a, b, c], [c, b, d]], 8);
                assert_eq!(counts.iter().map(|&n| u32::from(n)).sum::<u32>(), 1, "{x} {y}");
            }
        }
    }
}

#[test]
fn untraced_and_traced_entry_points_are_the_same_function() {
    let triangle = SnappedTriangle::new([[10, 10], [7000, 900], [300, 8000]]).unwrap();
    let mut direct = Vec::new();
    tiles::rasterize(&triangle, &Options::default(), |s| direct.push(s), &mut NoTrace);
    assert_eq!(
        direct,
        spans(TriangleRasterizer::Tiles, triangle.vertices(), PixelRect::EVERYTHING)
    );
    assert_eq!(direct.first().map(|s| s.y), Some(fixed::first_center(10)));
}
