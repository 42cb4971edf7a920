//! Depth sort against the z-buffer.

use crate::surface_scenes::{
    Prepared, assert_same_planes, crossing_quads, depth_at, each, of_triangles, random, three_beams,
};
use durer::math::DVec2;
use durer::raster::interpolate::polygon_area;
use durer::scene::Scene;
use durer::trace::{NoTrace, Recorder};
use durer::visibility::surface::ScreenTriangle;
use durer::visibility::surface::SurfaceInput;
use durer::visibility::surface::depth_sort::{CutLine, Options, PaintTest, Step, order, render};
use std::collections::BTreeSet;

#[test]
fn depth_sort_agrees_with_the_z_buffer() {
    each(320, |name, p| {
        let mut found = p.framebuffer();
        render(&p.input(), &p.lights, &Options::default(), &mut found, &mut NoTrace).unwrap();
        assert_same_planes(name, &found, &p.by_z_buffer());
    });
}

fn steps(scene: &Scene) -> Vec<Step> {
    let p = Prepared::new(scene, 100, 100);
    let mut recorder = Recorder::default();
    order(&p.input(), &mut recorder).unwrap();
    recorder.into_steps()
}

fn splits(scene: &Scene) -> usize {
    steps(scene).iter().filter(|s| matches!(s, Step::Split { .. })).count()
}

#[test]
fn cycles_and_penetration_are_split_and_nothing_else() {
    assert!((1..=12).contains(&splits(&three_beams())));
    assert!((1..=12).contains(&splits(&crossing_quads())));
    let mut sphere = Scene::default();
    sphere.meshes.push(crate::scenes::sphere(12, None));
    sphere.instances.push(crate::scenes::instance(0));
    assert_eq!(splits(&sphere), 0);
}

#[test]
fn every_test_gets_its_turn() {
    let mut passed: BTreeSet<PaintTest> = BTreeSet::new();
    for seed in 0..60 {
        passed.extend(steps(&random(seed)).iter().filter_map(|s| match s {
            Step::Tested { passed, .. } => *passed,
            _ => None,
        }));
    }
    use PaintTest::{BehindPlane, Boxes, Depths, InFrontOfPlane, Pixels, Projections};
    let all = [Depths, Boxes, InFrontOfPlane, BehindPlane, Projections, Pixels];
    assert_eq!(all.map(PaintTest::number), ["1", "2a", "2b", "2c", "2d", "pixels"]);
    assert_eq!(passed.into_iter().collect::<Vec<_>>(), all);
}

/// Returns whether a pixel's centre is on the inner side of an edge, by the top-left rule.
fn is_within_edge(t: &ScreenTriangle, i: usize, x: i32, y: i32) -> bool {
    let j = (i + 1) % 3;
    let [dx, dy] = [t.x[j] - t.x[i], t.y[j] - t.y[i]].map(i64::from);
    let [px, py] = [256 * x + 128 - t.x[i], 256 * y + 128 - t.y[i]].map(i64::from);
    let side = dx * py - dy * px;
    side > 0 || side == 0 && (dy < 0 || dy == 0 && dx > 0)
}

/// Returns the pixels of each polygon number, from the steps.
struct Replay<'a> {
    input: &'a SurfaceInput<'a>,
    triangle: Vec<usize>,
    pixels: Vec<BTreeSet<(i32, i32)>>,
}

impl Replay<'_> {
    fn is_inner(&self, polygon: usize, cut: CutLine, x: i32, y: i32) -> bool {
        let of = |i: u32| &self.input.triangles[self.triangle[i as usize]];
        let key = |i: u32| (depth_at(of(i), x, y), of(i).item);
        match cut {
            CutLine::Plane { of } => key(polygon as u32) < key(of),
            CutLine::Edge { of: i, edge } => is_within_edge(of(i), edge, x, y),
            CutLine::Column(column) => x < column,
            CutLine::Row(row) => y < row,
        }
    }
}

#[test]
fn depth_sort_can_be_replayed() {
    for seed in 0..40 {
        let scene = random(seed);
        let p = Prepared::new(&scene, 60, 60);
        let input = p.input();
        let mut recorder = Recorder::default();
        let polygons = order(&input, &mut recorder).unwrap();
        assert!(polygons == order(&input, &mut NoTrace).unwrap(), "tracing changes the order");
        let pixels = |i: usize| {
            let polygon = durer::visibility::surface::depth_sort::ScreenPolygon {
                triangle: i as u32,
                item: input.triangles[i].item,
                part: None,
            };
            let mut all = BTreeSet::new();
            polygon.spans(&input, |s| all.extend((s.x0..s.x1).map(|x| (x, s.y))));
            all
        };
        let count = input.triangles.len();
        let mut replay = Replay {
            input: &input,
            triangle: (0..count).collect(),
            pixels: (0..count).map(pixels).collect(),
        };
        let mut placed = Vec::new();
        for step in recorder.steps() {
            match *step {
                Step::Split { polygon, cut, pieces } => {
                    let i = polygon as usize;
                    let whole = replay.pixels[i].clone();
                    let (inner, outer) =
                        whole.into_iter().partition(|&(x, y)| replay.is_inner(i, cut, x, y));
                    assert_eq!(pieces.map(|p| p as usize), [0, 1].map(|k| replay.pixels.len() + k));
                    replay.pixels.extend([inner, outer]);
                    replay.triangle.extend([replay.triangle[i]; 2]);
                }
                Step::Place { polygon } => placed.push(polygon as usize),
                _ => {}
            }
        }
        assert_eq!(placed.len(), polygons.len());
        for (&i, polygon) in placed.iter().zip(&polygons) {
            assert_eq!(replay.triangle[i], polygon.triangle as usize);
            let mut pixels = BTreeSet::new();
            polygon.spans(&input, |s| pixels.extend((s.x0..s.x1).map(|x| (x, s.y))));
            assert_eq!(replay.pixels[i], pixels);
        }
    }
}

#[test]
fn outlines_of_pieces_share_out_the_triangle() {
    let scene = three_beams();
    let p = Prepared::new(&scene, 120, 120);
    let input = p.input();
    let polygons = order(&input, &mut NoTrace).unwrap();
    assert!(polygons.len() > input.triangles.len());
    for (i, t) in input.triangles.iter().enumerate() {
        let corners = [0, 1, 2].map(|k| DVec2::new(t.x[k].into(), t.y[k].into()) / 256.0);
        let whole = polygon_area(&corners).abs();
        let parts = polygons.iter().filter(|p| p.triangle as usize == i);
        let sum: f64 = parts.map(|p| polygon_area(&p.outline(&input)).abs()).sum();
        assert!((sum - whole).abs() < 1e-6 * whole, "{i}: {sum} {whole}");
    }
}

#[test]
fn the_order_of_triangles_does_not_matter_without_ties() {
    let triangles = |seed| {
        let mut numbers = crate::scenes::Numbers(seed);
        (0..25).map(|_| [0; 3].map(|_| numbers.point(1.3))).collect::<Vec<_>>()
    };
    for seed in 0..20 {
        let forward = triangles(seed);
        let backward: Vec<_> = forward.iter().rev().copied().collect();
        let depth = |triangles: &[_]| {
            let scene = of_triangles(triangles);
            let p = Prepared::new(&scene, 80, 80);
            let mut found = p.framebuffer();
            render(&p.input(), &p.lights, &Options::default(), &mut found, &mut NoTrace).unwrap();
            (found.color, found.depth)
        };
        assert!(depth(&forward) == depth(&backward), "{seed}");
    }
}
