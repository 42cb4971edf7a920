//! The floating horizon against rays, the z-buffer, and itself.

use durer::math::DVec3;
use durer::pipeline::{RenderOptions, Samples, render};
use durer::scene::{Camera, HeightField, Projection};
use durer::trace::{NoTrace, Recorder};
use durer::view::View;
use durer::visibility::line::floating_horizon::{
    GridChain, LineFamily, LinePiece, Options, Step, curves, draw,
};
use proptest::prelude::*;

const ALL: Options = Options { every_row: 1, every_column: 1, hidden: true };

fn ripples(columns: usize, rows: usize) -> HeightField {
    HeightField::from_fn([columns, rows], [-4.0, 4.0], [-4.0, 4.0], |x, z| {
        let r = libm::hypot(x, z);
        if r == 0.0 { 3.0 } else { 3.0 * libm::sin(3.0 * r) / (3.0 * r) }
    })
    .expect("field")
}

/// Returns a camera that sees a field of this extent, at an azimuth and an elevation in degrees.
fn camera(azimuth: f64, elevation: f64, perspective: bool) -> Camera {
    let (sa, ca) = libm::sincos(azimuth.to_radians());
    let (se, ce) = libm::sincos(elevation.to_radians());
    let projection = match perspective {
        true => Projection::Perspective { fov_y: 0.9 },
        false => Projection::Orthographic { height: 12.0 },
    };
    Camera {
        eye: DVec3::new(sa * ce, se, ca * ce) * 12.0,
        target: DVec3::ZERO,
        up: DVec3::new(-sa * se, ce, -ca * se),
        projection,
        near: 0.1,
        far: 40.0,
    }
}

/// Returns the triangles of a field in double precision.
fn triangles(field: &HeightField) -> Vec<[DVec3; 3]> {
    let mut all = Vec::new();
    for row in 0..field.rows() {
        for column in 0..field.columns() {
            let Some(diagonal) = field.cell(column, row) else { continue };
            let at = |k: usize| field.point(column + (k & 1), row + (k >> 1)).expect("corner");
            all.extend(diagonal.triangles().map(|t| t.map(at)));
        }
    }
    all
}

/// Returns how deep inside a triangle the ray from `p` towards the eye crosses it: the least barycentric distance of
/// the crossing from the triangle's sides, about 0 on a side, and the ray parameter of the crossing; `None` if the ray
/// misses.
fn passes(p: DVec3, to_eye: DVec3, length: f64, [a, b, c]: &[DVec3; 3]) -> Option<(f64, f64)> {
    let (e1, e2) = (*b - *a, *c - *a);
    let h = to_eye.cross(e2);
    let det = e1.dot(h);
    if det.abs() < 1e-12 {
        return None;
    }
    let s = p - *a;
    let u = s.dot(h) / det;
    let q = s.cross(e1);
    let v = to_eye.dot(q) / det;
    let t = e2.dot(q) / det;
    let inside = u.min(v).min(1.0 - u - v);
    (t > 1e-7 && t < length && inside > -1e-9).then_some((inside, t))
}

/// Returns how deep inside a triangle, or inside the part of it between the levels, the point is hidden; `None` if it
/// is visible.
fn hidden_by(
    p: DVec3,
    camera: &Camera,
    triangles: &[[DVec3; 3]],
    levels: Option<[f64; 2]>,
) -> Option<f64> {
    let (to_eye, length) = match camera.projection {
        Projection::Perspective { .. } => (camera.eye - p, 1.0),
        Projection::Orthographic { .. } => {
            ((camera.eye - camera.target).normalize(), f64::INFINITY)
        }
    };
    let hides = |triangle: &[DVec3; 3]| {
        let (inside, t) = passes(p, to_eye, length, triangle)?;
        let y = p.y + to_eye.y * t;
        let inside = levels.map_or(inside, |[low, high]| inside.min(y - low).min(high - y));
        (inside > -1e-9).then_some(inside)
    };
    triangles.iter().filter_map(hides).max_by(f64::total_cmp)
}

/// Compares all lines with rays; returns the numbers of samples and of disagreements.
fn disagreements(field: &HeightField, camera: &Camera) -> (usize, Vec<(GridChain, DVec3)>) {
    let triangles = triangles(field);
    let (mut samples, mut wrong) = (0, Vec::new());
    for curve in curves(field, camera, &ALL, &mut NoTrace).expect("curves") {
        for pair in curve.points.windows(2) {
            for part in [0.03, 0.5, 0.97] {
                let p = pair[0].lerp(pair[1], part);
                let found = hidden_by(p, camera, &triangles, field.levels());
                samples += 1;
                // A ray through a side of a triangle may hit or miss.
                let agrees = match found {
                    None => curve.visible,
                    Some(depth) => !curve.visible || depth < 1e-6,
                };
                if !agrees && pair[0].distance(pair[1]) > 1e-6 {
                    wrong.push((curve.clone(), p));
                }
            }
        }
    }
    (samples, wrong)
}

#[test]
fn every_piece_is_seen_or_hidden_as_rays_say() {
    let field = ripples(21, 17);
    for perspective in [false, true] {
        for (azimuth, elevation) in [
            (0.0, 20.0),
            (45.0, 30.0),
            (90.0, 10.0),
            (-137.0, 3.0),
            (213.0, -25.0),
            (45.0, 0.0),
            (0.0, 0.0),
            (20.0, 90.0),
            (20.0, -89.999_999),
        ] {
            let camera = camera(azimuth, elevation, perspective);
            let (samples, wrong) = disagreements(&field, &camera);
            let what = format!("{azimuth} {elevation} {perspective}");
            // At exactly level views, lines coincide; rays may decide symmetric pieces either way.
            let allowed = if elevation == 0.0 { samples / 50 } else { 0 };
            assert!(samples > 1000, "{what}: {samples}");
            assert!(
                wrong.len() <= allowed,
                "{what}: {} of {samples}: {:?}",
                wrong.len(),
                wrong[0].1
            );
        }
    }
}

#[test]
fn eyes_above_below_and_within_the_surface_see_what_rays_see() {
    let field = ripples(15, 18);
    for eye in [
        DVec3::new(0.3, 2.0, 0.7),
        DVec3::new(-1.0, 6.0, 1.5),
        DVec3::new(0.1, -5.0, 0.2),
        DVec3::new(3.9, 0.1, -3.9),
        DVec3::new(2.0, 0.05, 0.0),
        DVec3::new(4.3, 0.5, 0.0),
        DVec3::new(8.0 / 14.0, 1.0, 0.0),
    ] {
        let target = eye + DVec3::new(0.3, -0.5, -1.0);
        let camera = Camera { eye, target, up: DVec3::Y, ..camera(0.0, 0.0, true) };
        let (samples, wrong) = disagreements(&field, &camera);
        assert!(samples > 1000);
        assert!(wrong.is_empty(), "{eye}: {} of {samples}: {:?}", wrong.len(), wrong[0]);
        // Nothing is lost: the pieces make up all lines.
        let length = |c: &GridChain| c.points.windows(2).map(|w| w[0].distance(w[1])).sum::<f64>();
        let found: f64 =
            curves(&field, &camera, &ALL, &mut NoTrace).expect("curves").iter().map(length).sum();
        assert!((found - whole_length(&field)).abs() < 1e-6, "{eye}: {found}");
    }
}

fn whole_length(field: &HeightField) -> f64 {
    let mut sum = 0.0;
    for row in 0..field.rows() {
        for column in 0..field.columns() {
            let here = field.point(column, row);
            let next = [field.point(column + 1, row), field.point(column, row + 1)];
            sum += next.into_iter().filter_map(|n| Some(n?.distance(here?))).sum::<f64>();
        }
    }
    sum
}

#[test]
fn one_looks_through_holes() {
    // A wall with a window in front of a hill.
    let field = HeightField::from_fn([41, 21], [-4.0, 4.0], [-2.0, 2.0], |x, z| {
        let window = x.abs() < 1.5 && (0.7..1.5).contains(&z);
        if window { f64::NAN } else { libm::exp(-(z - 1.1) * (z - 1.1) * 9.0) * 2.0 - z * 0.2 }
    })
    .expect("field");
    for (azimuth, elevation) in [(0.0, 15.0), (30.0, 5.0), (170.0, -20.0)] {
        let camera = camera(azimuth, elevation, true);
        let (samples, wrong) = disagreements(&field, &camera);
        assert!(wrong.is_empty(), "{azimuth}: {} of {samples}: {:?}", wrong.len(), wrong[0].1);
    }
}

#[test]
fn visible_lines_are_visible_in_the_z_buffer_and_hidden_ones_hidden() {
    let field = ripples(41, 41);
    let (width, height) = (900, 900);
    for (azimuth, elevation, perspective) in [(30.0, 25.0, false), (-65.0, 12.0, true)] {
        let camera = Camera { near: 4.0, far: 20.0, ..camera(azimuth, elevation, perspective) };
        let mut options = RenderOptions::new(camera);
        (options.width, options.height) = (width, height);
        (options.depth, options.samples) = (true, Samples::One);
        let (picture, _) = render(&field.to_scene(), &options).expect("picture");
        let depth = picture.depth.expect("depth");
        let view = View::new(camera, width, height).expect("view");
        let (mut right, mut wrong) = (0u32, 0u32);
        for curve in curves(&field, &camera, &ALL, &mut NoTrace).expect("curves") {
            for pair in curve.points.windows(2) {
                for part in [0.2, 0.5, 0.8] {
                    let p = view.screen_from_world() * pair[0].lerp(pair[1], part).extend(1.0);
                    let (x, y, z) = (p.x / p.w, p.y / p.w, p.z / p.w);
                    // Depths around the point: a line is between pixels, and on slopes.
                    let around = (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| (dx, dy)));
                    let depths = around.filter_map(|(dx, dy)| {
                        depth.get((x + f64::from(dx)) as u32, (y + f64::from(dy)) as u32)
                    });
                    let (near, far) =
                        depths.fold((f32::INFINITY, 0.0f32), |(n, f), d| (n.min(d), f.max(d)));
                    let agrees = match curve.visible {
                        true => z <= f64::from(far) + 1e-4,
                        false => z >= f64::from(near) - 1e-4,
                    };
                    if agrees { right += 1 } else { wrong += 1 }
                }
            }
        }
        assert!(right > 5000 && wrong * 1000 < right, "{azimuth}: {wrong} wrong, {right} right");
    }
}

#[test]
fn lines_are_as_long_on_a_fine_grid_as_on_a_coarse_one() {
    let per_line = |n: usize| {
        let drawing =
            draw(&ripples(n, n), &camera(35.0, 30.0, false), &Options::default(), &mut NoTrace);
        drawing.expect("drawing").length(|_| true) / n as f64
    };
    let (coarse, fine) = (per_line(81), per_line(241));
    assert!((coarse / fine - 1.0).abs() < 0.01, "{coarse} {fine}");
}

#[test]
fn fewer_lines_are_parts_of_all_lines() {
    let field = ripples(20, 15);
    let camera = camera(35.0, 30.0, true);
    let all = curves(&field, &camera, &Options::default(), &mut NoTrace).expect("curves");
    let some = Options { every_row: 4, every_column: 0, hidden: false };
    let some = curves(&field, &camera, &some, &mut NoTrace).expect("curves");
    let chosen = |c: &&GridChain| {
        c.family == LineFamily::AlongX && (c.line.is_multiple_of(4) || c.line == 14)
    };
    assert!(!some.is_empty() && some.iter().eq(all.iter().filter(chosen)));
}

#[test]
fn the_lower_side_is_reported() {
    let field = ripples(21, 21);
    let seen = |elevation: f64| {
        let all = curves(&field, &camera(30.0, elevation, true), &Options::default(), &mut NoTrace);
        let all = all.expect("curves");
        (all.iter().filter(|c| c.underside).count(), all.len())
    };
    assert_eq!(seen(80.0).0, 0);
    let (below, all) = seen(-80.0);
    assert_eq!(below, all);
    let (some, all) = seen(8.0);
    assert!(some > 5 && some < all / 2, "{some} of {all}");
}

#[test]
fn steps_rebuild_the_lines_and_change_nothing() {
    let field = ripples(12, 9);
    let camera = camera(35.0, 30.0, true);
    let mut recorder = Recorder::default();
    let traced = curves(&field, &camera, &ALL, &mut recorder).expect("curves");
    assert_eq!(traced, curves(&field, &camera, &ALL, &mut NoTrace).expect("curves"));
    let mut pieces: Vec<LinePiece> = Vec::new();
    let mut covered = 0;
    for step in recorder.steps() {
        match step {
            Step::Piece(piece) => pieces.push(*piece),
            Step::Cover(_) => covered += 1,
        }
    }
    assert_eq!(covered, triangles(&field).len());
    let key = |p: &LinePiece| (p.family, p.line, p.segment);
    pieces.sort_by(|a, b| key(a).cmp(&key(b)).then(a.range[0].total_cmp(&b.range[0])));
    let rebuilt: Vec<(LineFamily, usize, bool)> =
        pieces.iter().map(|p| (p.family, p.line, p.visible)).collect();
    let reported: Vec<(LineFamily, usize, bool)> = traced
        .iter()
        .flat_map(|c| std::iter::repeat_n((c.family, c.line, c.visible), c.points.len() - 1))
        .collect();
    assert_eq!(rebuilt, reported);
}

#[test]
fn odd_fields_are_drawn() {
    let new = |size, heights: Vec<f64>| HeightField::new(size, [0.0, 1.0], [0.0, 1.0], heights);
    let nan = f64::NAN;
    let one = HeightField::new([1, 1], [0.0, 0.0], [0.0, 0.0], vec![5.0]).expect("one");
    let spikes = (0..400).map(|i| if i % 7 == 0 { 1e90 } else { f64::from(i) }).collect();
    for (name, field, lines) in [
        ("one point", one, Some(0)),
        ("two points", new([2, 1], vec![0.0, 1.0]).expect("two"), Some(1)),
        ("a column", new([1, 5], vec![0.0, 1.0, nan, 2.0, 3.0]).expect("column"), Some(2)),
        ("flat", new([9, 9], vec![2.0; 81]).expect("flat"), None),
        ("nothing", new([9, 9], vec![nan; 81]).expect("nothing"), Some(0)),
        ("spikes", new([20, 20], spikes).expect("spikes"), None),
    ] {
        for camera in [camera(30.0, 20.0, false), camera(30.0, 20.0, true), camera(0.0, 0.0, false)]
        {
            for eye in [camera.eye, DVec3::new(0.5, 2.0, 0.5), DVec3::new(0.5, -1.0, 0.5)] {
                let camera = Camera { eye, target: eye + DVec3::new(0.1, 0.0, -1.0), ..camera };
                if camera.check().is_err() {
                    continue;
                }
                let drawing = draw(&field, &camera, &ALL, &mut NoTrace).expect(name);
                let (found, behind) = (drawing.lines.len(), camera.eye.z < 1.5);
                assert!(behind || lines.is_none_or(|n| n == found), "{name}: {found}");
                let finite = drawing.lines.iter().flat_map(|l| &l.points).all(|p| p.is_finite());
                assert!(finite, "{name}");
            }
        }
    }
}

#[test]
fn a_level_plane_seen_edge_on_is_drawn_once() {
    let flat = HeightField::from_fn([9, 9], [-4.0, 4.0], [-4.0, 4.0], |_, _| 0.25).expect("flat");
    for azimuth in [0.0, 90.0, 33.0] {
        let found = draw(&flat, &camera(azimuth, 0.0, false), &Options::default(), &mut NoTrace);
        let found = found.expect("drawing");
        let bounds = found.bounds().expect("bounds");
        let once = bounds.size().x;
        let length = found.length(|_| true);
        assert!(length > once * 0.999 && length < once * 2.001, "{azimuth}: {length} {once}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    #[test]
    fn random_surfaces_agree_with_rays(
        heights in proptest::collection::vec(-1.5..1.5f64, 7 * 6),
        holes in proptest::collection::vec(0..42usize, 0..6),
        eye in (-9.0..9.0f64, -6.0..6.0f64, -9.0..9.0f64),
        perspective: bool,
        levels in proptest::option::of((-1.4..-0.2f64, 0.2..1.4f64)),
    ) {
        let mut heights = heights;
        holes.iter().for_each(|&i| heights[i] = f64::NAN);
        let mut field = HeightField::new([7, 6], [-4.0, 4.0], [-4.0, 4.0], heights).expect("field");
        if let Some((low, high)) = levels {
            field = field.within([low, high]).expect("levels");
        }
        let eye = DVec3::new(eye.0, eye.1, eye.2);
        let camera = Camera { eye, target: DVec3::new(0.1, 0.2, 0.3), up: DVec3::Y, ..camera(0.0, 0.0, perspective) };
        prop_assume!(camera.check().is_ok());
        let (samples, wrong) = disagreements(&field, &camera);
        prop_assert!(wrong.is_empty(), "{} of {samples}: {:?}", wrong.len(), wrong.first());
    }
}

#[test]
fn levels_cut_the_surface_between_its_points() {
    // A plane that rises from −2 to 2 along x.
    let field = HeightField::from_fn([5, 4], [0.0, 8.0], [0.0, 3.0], |x, _| x * 0.5 - 2.0);
    let field = field.and_then(|f| f.within([-0.75, 1.25])).expect("field");
    assert_eq!(field.range(), Some([-0.75, 1.25]));
    let bounds = field.to_scene().bounds().expect("bounds");
    assert!((bounds.min.x - 2.5).abs() < 1e-6 && (bounds.max.x - 6.5).abs() < 1e-6, "{bounds:?}");
    let found = curves(&field, &camera(10.0, 50.0, false), &ALL, &mut NoTrace).expect("curves");
    for curve in &found {
        let [first, last] = [curve.points[0], curve.points[curve.points.len() - 1]];
        if curve.family == LineFamily::AlongX {
            assert!((first.x - 2.5).abs() < 1e-9 && (last.x - 6.5).abs() < 1e-9, "{curve:?}");
            assert!((first.y + 0.75).abs() < 1e-9 && (last.y - 1.25).abs() < 1e-9, "{curve:?}");
        } else {
            assert!(first.x == 4.0 || first.x == 6.0, "{curve:?}");
        }
    }
    assert_eq!(found.len(), 4 + 2);
    // A cell that jumps across all values between the levels is not part of the surface, nor are the sides that jump.
    let pole = HeightField::from_fn([8, 2], [-3.5, 3.5], [0.0, 1.0], |x, _| 1.0 / x);
    let pole = pole.and_then(|f| f.within([-1.5, 1.5])).expect("field");
    assert_eq!(pole.cell(3, 0), None);
    let found = curves(&pole, &camera(10.0, 50.0, false), &ALL, &mut NoTrace).expect("curves");
    let within = |p: &DVec3| p.y.abs() < 1.5 + 1e-9 && p.x.abs() > 0.5;
    assert!(found.iter().flat_map(|c| &c.points).all(within));
    assert!(
        HeightField::from_fn([2, 2], [0.0, 1.0], [0.0, 1.0], |x, _| x)
            .expect("field")
            .within([1.0, 0.0])
            .is_err()
    );
}

#[test]
fn nothing_hangs_from_the_borders_of_holes() {
    // A row of three points beside a surface, the first at its corner, and two isolated points.
    let f = |x: f64, z: f64| match (x as i32, z as i32) {
        (0..=1, 0..=1) | (2..=3, 1) | (1..=2, 3) => 0.0,
        _ => f64::NAN,
    };
    let field = HeightField::from_fn([4, 4], [0.0, 3.0], [0.0, 3.0], f).expect("field");
    let found = curves(&field, &camera(20.0, 60.0, false), &ALL, &mut NoTrace).expect("curves");
    let ends = |c: &GridChain| [c.points[0], c.points[c.points.len() - 1]].map(|p| (p.x, p.z));
    assert!(!found.iter().any(|c| ends(c).contains(&(1.0, 1.0)) && ends(c).contains(&(2.0, 1.0))));
    assert!(found.iter().any(|c| ends(c) == [(1.0, 3.0), (2.0, 3.0)]), "{found:?}");
    assert!(found.iter().flat_map(ends).filter(|p| *p == (1.0, 1.0)).count() >= 2);
}
