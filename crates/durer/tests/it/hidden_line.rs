//! Hidden lines: scenes at which solvers fail, laws, and an independent oracle.

use crate::line_oracle::{Oracle, drawn_twice, segments};
use crate::line_scenes::{
    Random, Triangle, city, cuboid, cylinder, placed, quad, random_boxes, soup, view,
};
use durer::math::{DMat4, DVec3};
use durer::scene::{Camera, Projection};
use durer::target::drawing::{Drawing, Line, LineClass};
use durer::trace::{NoTrace, Recorder};
use durer::view::View;
use durer::visibility::line::hidden_line::{Options, Step, draw, replay};
use durer::visibility::line::{ClassSet, Intersections, wireframe};

const ISO: DVec3 = DVec3::new(1.0, -1.7, 0.9);

fn drawing(triangles: &[Triangle], view: &View) -> Drawing {
    draw(&soup(triangles), view, &Options::default(), &mut NoTrace).expect("drawing")
}

fn count(drawing: &Drawing, visible: bool) -> usize {
    drawing.lines.iter().filter(|l| l.is_visible() == visible).map(|l| segments(l).len()).sum()
}

fn lengths(drawing: &Drawing) -> [f64; 2] {
    [drawing.length(|l| l.is_visible()), drawing.length(|l| !l.is_visible())]
}

#[test]
fn cube_has_nine_visible_and_three_hidden_edges() {
    let cube = cuboid([-1.0; 3], [1.0; 3]);
    for perspective in [false, true] {
        let found = drawing(&cube, &view(DVec3::ZERO, ISO, 4.0, perspective));
        assert_eq!((count(&found, true), count(&found, false)), (9, 3), "{:?}", found.lines);
        assert!(found.lines.iter().all(|l| l.invisibility <= 1));
        let outline = found.lines.iter().find(|l| l.class == LineClass::Silhouette && l.closed);
        assert_eq!(outline.expect("outline").points.len(), 6);
    }
    let front = drawing(&cube, &view(DVec3::ZERO, DVec3::NEG_Y, 4.0, false));
    assert_eq!((front.lines.len(), count(&front, true)), (1, 4));
}

#[test]
fn result_is_the_same_at_any_size_place_order_and_turn() {
    let mut triangles = random_boxes(6, 3);
    triangles.extend(cylinder([4.0, 4.0], 1.5, [0.0, 9.0], 16));
    let middle = DVec3::splat(5.0);
    let expected = lengths(&drawing(&triangles, &view(middle, ISO, 16.0, false)));
    let agree = |name: &str, found: [f64; 2], scale: f64| {
        for k in 0..2 {
            let off = (found[k] / scale - expected[k]).abs();
            assert!(off < 2e-6 * expected[k], "{name}: {found:?} {expected:?}");
        }
    };
    for scale in [1e-6, 1e-3, 1e3, 1e6] {
        let matrix = DMat4::from_scale(DVec3::splat(scale));
        let v = view(middle * scale, ISO, 16.0 * scale, false);
        let found = draw(&placed(&triangles, matrix), &v, &Options::default(), &mut NoTrace);
        agree("scaled", lengths(&found.expect("drawing")), scale);
    }
    let away = DVec3::new(1e5, -3e5, 2e4);
    let v = view(middle + away, ISO, 16.0, false);
    let moved = placed(&triangles, DMat4::from_translation(away));
    agree(
        "moved",
        lengths(&draw(&moved, &v, &Options::default(), &mut NoTrace).expect("drawing")),
        1.0,
    );
    let v = view(middle, ISO, 16.0, false);
    let mut random = Random(5);
    for turn_all in [false, true] {
        let mut mixed = triangles.clone();
        for i in (1..mixed.len()).rev() {
            mixed.swap(i, (random.next() * (i + 1) as f64) as usize);
        }
        mixed.iter_mut().filter(|_| turn_all || random.next() < 0.3).for_each(|t| t.swap(0, 1));
        agree("turned", lengths(&drawing(&mixed, &v)), 1.0);
    }
}

#[test]
fn bars_that_overlap_in_a_cycle_have_six_polylines() {
    // Each bar lies on the next one's end.
    let bar = |k: usize| {
        let turn = durer::math::DMat3::from_rotation_z(k as f64 * std::f64::consts::TAU / 3.0);
        let corners = [[-2.5, -1.2, 0.4], [2.5, -1.2, -0.4], [2.5, -0.8, -0.4], [-2.5, -0.8, 0.4]];
        quad(corners.map(|c| (turn * DVec3::from(c)).to_array()))
    };
    let bars: Vec<Triangle> = (0..3).flat_map(bar).collect();
    let found = drawing(&bars, &view(DVec3::ZERO, DVec3::Z, 8.0, false));
    let visible = found.lines.iter().filter(|l| l.is_visible());
    assert_eq!(visible.count(), 6, "{:?}", found.lines);
    assert_eq!(found.lines.iter().filter(|l| !l.is_visible()).count(), 6);
}

#[test]
fn bar_through_a_bar_has_two_rings_of_intersection() {
    let mut bars = cuboid([-3.0, -1.0, -1.0], [3.0, 1.0, 1.0]);
    bars.extend(cuboid([-0.5, -2.0, -0.5], [0.5, 2.0, 0.5]));
    let v = view(DVec3::ZERO, ISO, 9.0, false);
    let found = drawing(&bars, &v);
    let meets = || found.lines.iter().filter(|l| l.class == LineClass::Intersection);
    let edges: usize = meets().map(|l| segments(l).len()).sum();
    assert_eq!(edges, 8, "{:?}", meets().collect::<Vec<_>>());
    let inside = Options { intersections: Intersections::All, ..Options::default() };
    let all = draw(&soup(&bars), &v, &inside, &mut NoTrace).expect("drawing");
    assert_eq!(lengths(&all), lengths(&found));
    let without =
        Options { classes: ClassSet::default().without(LineClass::Intersection), ..inside };
    let none = draw(&soup(&bars), &v, &without, &mut NoTrace).expect("drawing");
    assert!(none.lines.iter().all(|l| l.class != LineClass::Intersection));
}

/// Scenes with the share of samples that must be right.
fn zoo() -> Vec<(&'static str, Vec<Triangle>, DVec3)> {
    let mut touching = cuboid([0.0; 3], [2.0; 3]);
    touching.extend(cuboid([2.0, 0.5, 0.0], [3.0, 1.5, 1.0]));
    touching.extend(cuboid([0.5, 0.5, 2.0], [1.5, 1.5, 3.0]));
    touching.extend(cuboid([-1.0, 0.0, 0.0], [0.0, 2.0, 2.0]));
    let mut plate = cuboid([-4.0, -4.0, -1.0], [4.0, 4.0, 0.0]);
    plate.extend(cylinder([-1.5, 0.0], 1.2, [0.0, 3.0], 24));
    plate.extend(cylinder([2.0, 1.0], 0.8, [0.0, 1.5], 17));
    let mut random = Random(11);
    let soup: Vec<Triangle> = (0..60)
        .map(|_| {
            let at = DVec3::from(std::array::from_fn(|_| random.next() * 6.0));
            std::array::from_fn(|_| at + DVec3::from(std::array::from_fn(|_| random.next() * 2.0)))
        })
        .collect();
    let twice = [random_boxes(3, 9), random_boxes(3, 9)].concat();
    vec![
        ("touching", touching, ISO),
        ("plate", plate, DVec3::new(0.6, -1.0, 0.7)),
        ("boxes", random_boxes(25, 1), ISO),
        ("city", city(6), ISO),
        ("aligned city", city(6), DVec3::ONE),
        ("city from above", city(6), DVec3::Z),
        ("city from the side", city(6), DVec3::NEG_Y),
        ("triangles", soup, ISO),
        ("twice the same", twice, ISO),
    ]
}

#[test]
fn samples_of_lines_agree_with_rays() {
    for (name, triangles, to_eye) in zoo() {
        let middle = triangles.iter().flatten().sum::<DVec3>() / (3.0 * triangles.len() as f64);
        for perspective in [false, true] {
            let v = view(middle, to_eye, 22.0, perspective);
            let found = drawing(&triangles, &v);
            let oracle = Oracle::new(&triangles, &v);
            let [visible, hidden] = oracle.precision(&found, 12);
            let recall = oracle.recall(&found, 12);
            for (what, score) in [("visible", visible), ("hidden", hidden), ("recall", recall)] {
                assert!(score.share() >= 0.999, "{name} {what} {perspective}: {score:?}");
            }
            let twice = drawn_twice(&found, 2e-5 * 10.0);
            assert!(twice <= 1e-3 * lengths(&found)[0], "{name} {perspective}: {twice}");
        }
    }
}

#[test]
fn replay_gives_the_drawing_and_threads_change_nothing() {
    let scene = soup(&random_boxes(20, 4));
    let v = view(DVec3::splat(5.0), ISO, 16.0, true);
    for hidden in [true, false] {
        let options = Options { hidden, ..Options::default() };
        let mut recorder = Recorder::default();
        let traced = draw(&scene, &v, &options, &mut recorder).expect("drawing");
        assert_eq!(replay(recorder.steps(), &options), traced.lines);
        for threads in [1, 2, 4] {
            let pool =
                rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
            let found = pool.install(|| draw(&scene, &v, &options, &mut NoTrace)).expect("drawing");
            assert_eq!(found, traced);
        }
    }
}

#[test]
fn visible_lines_are_the_same_without_the_hidden_ones() {
    let scene = soup(&random_boxes(20, 8));
    let v = view(DVec3::splat(5.0), ISO, 16.0, false);
    let with = draw(&scene, &v, &Options::default(), &mut NoTrace).expect("drawing");
    let only = Options { hidden: false, ..Options::default() };
    let without = draw(&scene, &v, &only, &mut NoTrace).expect("drawing");
    let visible: Vec<_> = with.lines.into_iter().filter(|l| l.is_visible()).collect();
    assert_eq!(visible, without.lines);
}

/// Returns the drawing of faces that penetrate each other, and the number of faces found in front of each line.
fn penetrating(count: usize, hidden: bool) -> (Drawing, f64) {
    let mut random = Random(5);
    let mut point = || DVec3::from(std::array::from_fn(|_| random.next()));
    let triangles: Vec<Triangle> = (0..count).map(|_| [(); 3].map(|_| point())).collect();
    let v = view(DVec3::splat(0.5), ISO, 2.0, false);
    let options = Options { hidden, ..Options::default() };
    let mut recorder = Recorder::default();
    let found = draw(&soup(&triangles), &v, &options, &mut recorder).expect("drawing");
    assert_eq!(replay(recorder.steps(), &options), found.lines);
    let covers = recorder.steps().iter().filter_map(|step| match step {
        Step::Line { tried, covers, .. } => {
            assert!(tried.is_sorted_by(|a, b| a < b));
            assert!(covers.iter().all(|cover| tried.contains(&cover.item)));
            let spans = step.spans();
            assert!(spans.windows(2).all(|pair| pair[0].to == pair[1].from));
            assert_eq!((spans[0].from, spans[spans.len() - 1].to), (0.0, 1.0));
            Some(covers.len())
        }
        Step::Page(_) => None,
    });
    let (lines, sum) = covers.fold((0, 0), |(lines, sum), covers| (lines + 1, sum + covers));
    (found, sum as f64 / f64::from(lines))
}

#[test]
fn where_all_is_known_to_be_hidden_no_more_faces_are_looked_for() {
    let (all, of_all) = penetrating(120, true);
    let [(_, of_half), (seen, of_seen)] = [60, 120].map(|count| penetrating(count, false));
    let visible: Vec<_> = all.lines.into_iter().filter(|l| l.is_visible()).collect();
    assert_eq!(visible, seen.lines);
    println!("faces found in front of a line: {of_half} and {of_seen} of {of_all}");
    assert!(of_seen * 2.0 < of_all && of_seen < of_half * 1.5);
}

#[test]
fn lines_end_at_the_window_and_at_the_near_plane() {
    let triangles = random_boxes(20, 2);
    let v = view(DVec3::splat(5.0), ISO, 3.0, false);
    let found = drawing(&triangles, &v);
    let window = found.window.expect("window");
    let slack = 1e-6;
    assert!(
        found.lines.iter().flat_map(|l| &l.points).all(|p| {
            p.x.abs() <= window.max().x + slack && p.y.abs() <= window.max().y + slack
        })
    );
    // From inside the boxes.
    let mut camera = *v.camera();
    camera.eye = DVec3::new(4.0, 4.0, 4.0);
    camera.projection = durer::scene::Projection::Perspective { fov_y: 1.2 };
    camera.near = 1e-3;
    let inside = View::new(camera, 800, 800).expect("view");
    let found = drawing(&triangles, &inside);
    let oracle_points = found.lines.iter().flat_map(|l| &l.points);
    assert!(oracle_points.clone().count() > 0 && oracle_points.clone().all(|p| p.is_finite()));
}

#[test]
fn open_sheets_hide_from_both_sides_and_have_borders() {
    let mut sheets = quad([[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [4.0, 4.0, 0.0], [0.0, 4.0, 0.0]]);
    sheets.extend(quad([[1.0, 1.0, -1.0], [5.0, 1.0, -1.0], [5.0, 2.0, -1.0], [1.0, 2.0, -1.0]]));
    for turned in [false, true] {
        let mut sheets = sheets.clone();
        if turned {
            sheets.iter_mut().take(2).for_each(|t| t.swap(0, 1));
        }
        let found = drawing(&sheets, &view(DVec3::new(2.0, 2.0, 0.0), DVec3::Z, 12.0, false));
        assert!(found.lines.iter().all(|l| l.class == LineClass::Border));
        let [visible, hidden] = lengths(&found);
        assert!((visible - (16.0 + 3.0)).abs() < 1e-5 && (hidden - 7.0).abs() < 1e-5);
    }
}

#[test]
fn no_triangle_at_an_edge_of_three_hides_it() {
    // Borders of all three coincide and are divided there; all extend beyond the window and are cut.
    let triangles: [Triangle; 3] = [
        [
            [3.457_031_3, 3.472_656_3, 3.472_656_3],
            [3.472_656_3, -0.433_593_75, 2.847_656_3],
            [-0.511_718_75; 3],
        ],
        [[-0.507_812_5, -1.773_437_5, -2.242_187_5], [-0.507_812_5; 3], [-2.257_812_5; 3]],
        [[1.878_906_3; 3], [0.144_531_25, 2.472_656_3, 1.878_906_3], [-1.679_687_5; 3]],
    ]
    .map(|t| t.map(DVec3::from));
    let camera = Camera {
        eye: DVec3::new(-3.999, -3.998, -3.8095),
        target: DVec3::splat(-0.3),
        up: DVec3::new(0.3, 0.5, 0.8),
        projection: Projection::Orthographic { height: 1.0 },
        near: 0.05,
        far: 6.0,
    };
    let view = View::new(camera, 80, 60).expect("view");
    let expected = drawing(&triangles, &view);
    let of_three = |l: &&Line| l.class == LineClass::NonManifold;
    assert!(expected.lines.iter().filter(of_three).all(Line::is_visible));
    assert_eq!(expected.lines.iter().filter(of_three).count(), 1);
    for [a, b, c] in [[0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]] {
        let found = drawing(&[triangles[a], triangles[b], triangles[c]], &view);
        assert_eq!(found.lines, expected.lines, "{a} {b} {c}");
    }
}

#[test]
fn wireframe_has_each_edge_once() {
    let cube = cuboid([-1.0; 3], [1.0; 3]);
    let v = view(DVec3::ZERO, ISO, 4.0, false);
    let options = wireframe::Options::default();
    let mut recorder = Recorder::default();
    let found = wireframe::draw(&soup(&cube), &v, &options, &mut recorder).expect("drawing");
    // Twelve edges and six diagonals.
    assert_eq!(count(&found, true), 18);
    assert_eq!(wireframe::replay(recorder.steps(), &options), found.lines);
}

#[test]
fn nothing_and_nonsense_are_no_drawing() {
    let v = view(DVec3::ZERO, ISO, 4.0, true);
    assert!(drawing(&[], &v).lines.is_empty());
    let nan =
        [[DVec3::NAN, DVec3::X, DVec3::Y], [DVec3::X; 3], [DVec3::ZERO, DVec3::X, DVec3::X * 2.0]];
    let found = drawing(&nan, &v);
    assert!(found.lines.iter().flat_map(|l| &l.points).all(|p| p.is_finite()));
    let huge: Vec<Triangle> =
        cuboid([-1.0; 3], [1.0; 3]).into_iter().map(|t| t.map(|p| p * 1e38)).collect();
    let found = drawing(&huge, &v);
    assert!(found.lines.iter().flat_map(|l| &l.points).all(|p| p.is_finite()));
    let wrong = Options { crease: f64::NAN, ..Options::default() };
    assert!(draw(&soup(&[]), &v, &wrong, &mut NoTrace).is_err());
}

#[test]
fn edges_that_meet_in_a_corner_end_in_one_point() {
    let exact = Options { tolerance: 1e-3, ..Options::default() };
    // Of three edges, two continue each other up to a part of the tolerance.
    for to_eye in [DVec3::new(1.0, 1.0, 1e-3), DVec3::new(-1.0, 1.0, -1e-3), ISO] {
        let seen = view(DVec3::splat(1.0), to_eye, 4.0, false);
        let cube = soup(&cuboid([0.0; 3], [2.0; 3]));
        let lines = draw(&cube, &seen, &exact, &mut NoTrace).expect("drawing").lines;
        for line in lines.iter().filter(|l| !l.closed) {
            for end in [line.points[0], line.points[line.points.len() - 1]] {
                let through = lines.iter().filter(|l| l.points.contains(&end)).count();
                assert!(through > 1, "{to_eye}: {end} of {line:?}");
            }
        }
    }
}

#[test]
fn hidden_lines_beside_visible_ones_are_left_out_where_that_is_requested() {
    let cube = cuboid([0.0; 3], [2.0; 3]);
    for off in [1e-7, 1e-5, 1e-4, 1e-3] {
        let seen = view(DVec3::splat(1.0), DVec3::new(off, -1.3 * off, 1.0), 4.0, false);
        let drawn = |beneath: f64| {
            let options = Options { beneath, ..Options::default() };
            draw(&soup(&cube), &seen, &options, &mut NoTrace).expect("drawing")
        };
        let [visible, hidden] = lengths(&drawn(0.002));
        assert_eq!(hidden, 0.0, "{off}");
        assert_eq!(visible, lengths(&drawn(0.0))[0]);
    }
    assert!(
        lengths(&drawing(&cube, &view(DVec3::ONE, DVec3::new(1e-3, 0.0, 1.0), 4.0, false)))[1]
            > 1.0
    );
}
