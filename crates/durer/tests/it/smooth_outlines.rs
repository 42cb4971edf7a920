//! Outlines of the smooth surfaces that meshes approximate: round, and met by all lines that end on them.

use crate::line_oracle::{distance, segments};
use crate::line_scenes::{Triangle, quad, soup, torus, view};
use durer::math::{DMat4, DVec2, DVec3};
use durer::scene::Instance;
use durer::target::drawing::{Drawing, LineClass};
use durer::trace::NoTrace;
use durer::view::View;
use durer::visibility::line::Smooth;
use durer::visibility::line::hidden_line::{Options, draw};

fn smooth(triangles: &[Triangle], view: &View) -> Drawing {
    let options =
        Options { smooth: Smooth::On, hidden: false, tolerance: 1e-6, ..Options::default() };
    draw(&soup(triangles), view, &options, &mut NoTrace).expect("drawing")
}

/// Returns a ball of radius 1 of `n` by 2 `n` quadrilaterals.
fn ball(n: usize) -> Vec<Triangle> {
    let at = |i: usize, k: usize| {
        let angle = |j: usize, of: usize| (j % of) as f64 / of as f64 * std::f64::consts::TAU;
        let ((s, c), (t, d)) = (angle(i, 2 * n).sin_cos(), angle(k, 2 * n).sin_cos());
        DVec3::new(c * t, s * t, d)
    };
    let cells = (0..2 * n).flat_map(|i| (0..n).map(move |k| (i, k)));
    let quads = cells.map(|(i, k)| [at(i, k), at(i, k + 1), at(i + 1, k + 1), at(i + 1, k)]);
    quads.flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).collect()
}

#[test]
fn outline_of_a_coarse_ball_is_round() {
    for perspective in [false, true] {
        let v = view(DVec3::ZERO, DVec3::new(1.0, -1.7, 0.9), 4.0, perspective);
        let drawing = smooth(&ball(12), &v);
        // From a distance of 12 a ball looks a little larger than it is.
        let radius = if perspective { 12.0 / 143.0_f64.sqrt() } else { 1.0 };
        let outline = drawing.lines.iter().filter(|l| l.class == LineClass::Silhouette);
        let radii: Vec<f64> =
            outline.flat_map(|l| &l.points).map(|p| p.length() / radius).collect();
        // Half of the mesh's own outline is further in, by up to 0.86 %.
        let round = radii.iter().filter(|r| (**r - 1.0).abs() < 2e-3).count();
        assert!(4 * round > 3 * radii.len(), "{perspective}: {round} of {radii:?}");
        assert!(radii.iter().all(|r| (0.99..1.002).contains(r)), "{perspective}: {radii:?}");
        let closed = drawing.lines.iter().filter(|l| l.closed).count();
        let in_the_open = drawing.length(|l| !l.closed);
        assert_eq!(closed, 1, "{perspective}");
        // Near a pole one edge of a facet sticks out.
        assert!(in_the_open < 0.05 * drawing.length(|_| true), "{perspective}: {in_the_open}");
    }
}

#[test]
fn visible_lines_are_the_same_without_the_hidden_ones() {
    let moved = |k: usize| {
        let by = DVec3::new(0.13, 0.07, -2.5) * k as f64;
        ball(12).into_iter().map(move |t| t.map(|p| p + by))
    };
    let mut scene: Vec<Triangle> = (0..4).flat_map(moved).collect();
    scene.extend(quad([
        [-3.0, -0.4, -9.0],
        [3.0, -0.4, -9.0],
        [3.0, 0.3, -9.0],
        [-3.0, 0.3, -9.0],
    ]));
    let v = view(DVec3::ZERO, DVec3::new(0.05, 0.02, 1.0), 8.0, false);
    let drawn = |hidden| {
        let options = Options { smooth: Smooth::On, hidden, ..Options::default() };
        draw(&soup(&scene), &v, &options, &mut NoTrace).expect("drawing").lines
    };
    let visible: Vec<_> = drawn(true).into_iter().filter(|l| l.is_visible()).collect();
    assert_eq!(visible, drawn(false));
}

#[test]
fn lines_that_pass_behind_a_smooth_outline_end_on_it() {
    let mut scene = torus(24, 12);
    for i in 0..9 {
        let at = |x: f64, y: f64| [x, y, -1.2];
        let y = -2.1 + 0.5 * f64::from(i);
        scene.extend(quad([at(-4.0, y), at(4.0, y), at(4.0, y + 0.21), at(-4.0, y + 0.21)]));
    }
    for to_eye in [DVec3::new(0.1, -0.7, 1.0), DVec3::new(1.0, 0.4, 0.9), DVec3::new(0.3, 0.2, 1.0)]
    {
        let v = view(DVec3::ZERO, to_eye, 12.0, false);
        let drawing = smooth(&scene, &v);
        let of = |class| drawing.lines.iter().filter(move |l| l.class == class);
        let outline: Vec<[DVec2; 2]> = of(LineClass::Silhouette).flat_map(segments).collect();
        let (mut on_outline, mut in_the_open) = (0, Vec::new());
        for line in of(LineClass::Border).filter(|l| !l.closed) {
            for end in [line.points[0], line.points[line.points.len() - 1]] {
                let gap = outline.iter().map(|s| distance(end, *s)).fold(f64::INFINITY, f64::min);
                if gap < 1e-5 {
                    on_outline += 1;
                } else {
                    in_the_open.push((end, gap));
                }
            }
        }
        assert!(
            on_outline > 30 && in_the_open.is_empty(),
            "{to_eye}: {on_outline}, {in_the_open:?}"
        );
    }
}

#[test]
fn outlines_of_balls_are_one_line_whatever_the_mesh() {
    let (mut drawings, mut pieces) = (0, 0);
    for n in [7, 10, 13, 18, 25] {
        for (x, y, z) in [(1.0, -1.7, 0.9), (0.3, -2.0, 0.2), (0.05, -0.1, 1.0), (-2.0, 0.7, -1.1)]
        {
            let drawing = smooth(&ball(n), &view(DVec3::ZERO, DVec3::new(x, y, z), 4.0, false));
            drawings += 1;
            pieces += drawing.lines.len();
        }
    }
    // Near a pole one edge of a facet may stick out.
    assert!(pieces < drawings + 3, "{pieces} in {drawings} drawings");
}

/// Returns the lengths of outlines, visible and hidden.
fn lengths(triangles: &[Triangle], view: &View) -> [f64; 2] {
    let options = Options { smooth: Smooth::On, tolerance: 1e-6, ..Options::default() };
    let drawing = draw(&soup(triangles), view, &options, &mut NoTrace).expect("drawing");
    assert_eq!(drawing.length(|l| l.class != LineClass::Silhouette), 0.0);
    [true, false].map(|visible| drawing.length(|l| l.is_visible() == visible))
}

#[test]
fn outlines_of_a_torus_are_as_long_as_they_are_exactly() {
    // From Open CASCADE 7.8, HLRBRep_Algo, of the surface itself; the inner outline has cusps.
    let (elevation_sin, elevation_cos) = 12.0_f64.to_radians().sin_cos();
    let cases = [
        (DVec3::new(1.0, -1.0, 1.0), [20.2383, 0.2499]),
        (DVec3::new(0.0, -elevation_cos, elevation_sin), [16.4693, 5.6239]),
    ];
    for (to_eye, exact) in cases {
        let v = view(DVec3::ZERO, to_eye, 12.0, false);
        for (around, across) in [(40, 20), (60, 32), (130, 64)] {
            let found = lengths(&torus(around, across), &v);
            for (found, exact) in found.into_iter().zip(exact) {
                let off = (found - exact).abs() / 20.0;
                assert!(off < 0.004, "{to_eye}, {around} by {across}: {found}, not {exact}");
            }
        }
    }
}

/// Returns a ball with slivers: some edges have thin triangles to a third point of the sphere.
fn ball_with_slivers(n: usize) -> Vec<Triangle> {
    let halves = |(i, [a, b, c]): (usize, Triangle)| {
        let over = ((a + b) / 2.0).normalize();
        // At the poles triangles have no area.
        if i % 7 == 3 && c.z.abs() < 0.9 {
            vec![[a, over, c], [over, b, c], [a, b, over]]
        } else {
            vec![[a, b, c]]
        }
    };
    ball(n).into_iter().enumerate().flat_map(halves).collect()
}

#[test]
fn slivers_of_a_ball_make_no_lines() {
    for (x, y, z) in [(1.0, -1.7, 0.9), (0.3, -2.0, 0.2), (-2.0, 0.7, -1.1)] {
        let v = view(DVec3::ZERO, DVec3::new(x, y, z), 4.0, false);
        let [visible, hidden] = lengths(&ball_with_slivers(12), &v);
        // Where slivers bend it, the outline wavers a little.
        let exact = std::f64::consts::TAU;
        assert!((visible / exact - 1.0).abs() < 0.04 && hidden < 0.01, "{visible}, {hidden}");
        let drawing = smooth(&ball_with_slivers(12), &v);
        let radii = drawing.lines.iter().flat_map(|l| &l.points).map(|p| p.length());
        assert!(radii.into_iter().all(|r| (0.98..1.01).contains(&r)));
        assert_eq!(drawing.lines.len(), 1, "{x} {y} {z}");
    }
}

/// Returns a bar along y with these corners in x and z, counter-clockwise seen from −y.
fn bar(corners: &[[f64; 2]]) -> Vec<Triangle> {
    let at = |i: usize, y: f64| {
        let [x, z] = corners[i % corners.len()];
        DVec3::new(x, y, z)
    };
    let sides = (0..corners.len()).flat_map(|i| {
        let [a, b, c, d] = [at(i, -3.0), at(i, 3.0), at(i + 1, 3.0), at(i + 1, -3.0)];
        [[a, b, c], [a, c, d]]
    });
    let ends = (1..corners.len() - 1).flat_map(|i| {
        [[at(0, -3.0), at(i, -3.0), at(i + 1, -3.0)], [at(0, 3.0), at(i + 1, 3.0), at(i, 3.0)]]
    });
    sides.map(|[a, b, c]| [a, c, b]).chain(ends).collect()
}

#[test]
fn outlines_of_flat_faces_run_along_their_bends() {
    // A roof of 2 · 15°: no crease, but nothing round either.
    let rise = 2.0 * 15.0_f64.to_radians().tan();
    let roof = bar(&[[-2.0, -1.0], [2.0, -1.0], [2.0, 0.0], [0.0, rise], [-2.0, 0.0]]);
    for (x, z) in [(1.0, 0.05), (1.0, 0.2), (-1.0, 0.1)] {
        let v = view(DVec3::ZERO, DVec3::new(x, -0.4, z), 9.0, false);
        let plain = Options { tolerance: 1e-6, hidden: false, ..Options::default() };
        let plain = draw(&soup(&roof), &v, &plain, &mut NoTrace).expect("drawing");
        assert_eq!(smooth(&roof, &v).lines, plain.lines, "{x} {z}");
    }
}

#[test]
fn outlines_of_cylinders_and_cones_are_straight() {
    for n in [12, 24, 60] {
        for top in [1.0, 0.0] {
            let at = |k: usize, r: f64, z: f64| {
                let (s, c) = (k as f64 / n as f64 * std::f64::consts::TAU).sin_cos();
                DVec3::new(r * c, r * s, z)
            };
            let (bottom, tip) = (DVec3::ZERO, DVec3::new(0.0, 0.0, 3.0));
            let mut triangles = Vec::new();
            for k in 0..n {
                let [a, b] = [at(k, 1.0, 0.0), at(k + 1, 1.0, 0.0)];
                let [c, d] = [at(k + 1, top, 3.0), at(k, top, 3.0)];
                triangles.extend([[bottom, b, a], [a, b, c]]);
                if top > 0.0 {
                    triangles.extend([[a, c, d], [tip, d, c]]);
                }
            }
            let v = view(DVec3::ZERO, DVec3::new(0.2, -1.0, 0.3), 8.0, false);
            let options = Options { smooth: Smooth::On, stubs: 0.01, ..Options::default() };
            let drawing = draw(&soup(&triangles), &v, &options, &mut NoTrace).expect("drawing");
            // Half of the bottom rim is an outline and half is hidden; seen from above.
            let ellipse = {
                let sin = v.camera().eye.normalize().z;
                let part = |i: usize| {
                    let (s, c) = (i as f64 / 1e4 * std::f64::consts::TAU).sin_cos();
                    (s * s + c * c * sin * sin).sqrt() * std::f64::consts::TAU / 1e4
                };
                (0..10_000).map(part).sum::<f64>()
            };
            let cos = (1.0 - v.camera().eye.normalize().z.powi(2)).sqrt();
            let sides = 2.0 * if top > 0.0 { 3.0 * cos } else { cone_side(cos) };
            let rims = if top > 0.0 { 2.0 * ellipse } else { ellipse };
            let found = drawing.length(|_| true);
            let off = found / (sides + rims) - 1.0;
            assert!(off.abs() < 0.02, "{n}, {top}: {found}, not {}", sides + rims);
        }
    }
}

/// Returns the length of an outline of a cone of radius 1 and height 3 in a picture in which its height is 3 `cos`: the
/// tangent from the tip to the ellipse of the rim.
fn cone_side(cos: f64) -> f64 {
    let (height, sin2) = (3.0 * cos, 1.0 - cos * cos);
    let y = sin2 / height;
    let x2 = 1.0 - y * y / sin2;
    (x2 + (height - y).powi(2)).sqrt()
}

/// Returns a body of revolution of `n` facets around z with this profile of radii and heights, from the bottom up,
/// without lids.
fn turned(profile: &[[f64; 2]], n: usize) -> Vec<Triangle> {
    let at = |k: usize, [r, z]: [f64; 2]| {
        let (s, c) = (k as f64 / n as f64 * std::f64::consts::TAU).sin_cos();
        DVec3::new(r * c, r * s, z)
    };
    let cells = profile.windows(2).flat_map(|w| (0..n).map(move |k| (k, w[0], w[1])));
    let quads = cells.map(|(k, a, b)| [at(k, a), at(k + 1, a), at(k + 1, b), at(k, b)]);
    quads.flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).collect()
}

#[test]
fn a_cylinder_that_ends_in_a_cone_is_straight() {
    // Its rim turns by 35°: no crease, but nothing is round along the axis either.
    let aside = 4.0 - 1.5 * 35.0_f64.to_radians().tan();
    let barrel = turned(&[[4.0, -6.0], [4.0, 6.0], [aside, 7.5]], 60);
    for to_eye in [DVec3::new(0.0, -1.0, 0.1), DVec3::new(0.3, -1.0, -0.2)] {
        let drawing = smooth(&barrel, &view(DVec3::ZERO, to_eye, 20.0, false));
        let across = |p: &DVec2| p.x.abs();
        let widest = drawing.lines.iter().flat_map(|l| &l.points).map(across).fold(0.0, f64::max);
        assert!((widest - 4.0).abs() < 0.01, "{to_eye}: {widest}");
    }
}

#[test]
fn what_is_modelled_in_few_facets_keeps_them() {
    let drawn = |triangles: &[Triangle], smooth: Smooth| {
        let v = view(DVec3::ZERO, DVec3::new(1.0, -1.7, 0.9), 4.0, false);
        let options = Options { smooth, tolerance: 1e-6, ..Options::default() };
        draw(&soup(triangles), &v, &options, &mut NoTrace).expect("drawing").lines
    };
    for (n, round) in [(12, true), (9, true), (6, false), (5, false)] {
        let ball = ball(n);
        let auto = drawn(&ball, Smooth::Auto);
        assert_eq!(auto == drawn(&ball, Smooth::On), round, "{n}");
        assert_eq!(auto == drawn(&ball, Smooth::Off), !round, "{n}");
    }
    // A ring whose wire has ten sides is round if the wire is thin.
    for (wire, round) in [(0.05, true), (1.0, false)] {
        let thinner = |p: DVec3| {
            let center = DVec3::new(p.x, p.y, 0.0).normalize() * 2.0;
            (center + (p - center) * wire) * 0.5
        };
        let ring: Vec<Triangle> = torus(60, 10).into_iter().map(|t| t.map(thinner)).collect();
        assert_eq!(drawn(&ring, Smooth::Auto) == drawn(&ring, Smooth::On), round, "{wire}");
        assert_eq!(drawn(&ring, Smooth::Auto) == drawn(&ring, Smooth::Off), !round, "{wire}");
    }
    // No part of a box bends.
    let cube = bar(&[[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]);
    assert_eq!(drawn(&cube, Smooth::Auto), drawn(&cube, Smooth::Off));
}

#[test]
fn each_object_is_round_or_not() {
    let scene = |parts: [&[Triangle]; 2]| {
        let parts = parts.map(soup);
        let [mut scene, other] = parts;
        let offset = DMat4::from_translation(DVec3::new(3.0, 0.0, 0.0));
        scene.meshes.extend(other.meshes);
        scene.instances.push(Instance { mesh: 1, world_from_mesh: offset, name: String::new() });
        scene
    };
    let (round, coarse) = (ball(12), ball(5));
    let v = view(DVec3::new(1.5, 0.0, 0.0), DVec3::new(0.2, -1.7, 0.9), 8.0, false);
    let drawn = |parts, smooth| {
        let options = Options { smooth, tolerance: 1e-6, ..Options::default() };
        draw(&scene(parts), &v, &options, &mut NoTrace).expect("drawing").lines
    };
    let auto = drawn([&round, &coarse], Smooth::Auto);
    let of = |smooth| drawn([&round, &coarse], smooth);
    let (on, off) = (of(Smooth::On), of(Smooth::Off));
    let side = |lines: &[durer::target::drawing::Line], right: bool| {
        let of = lines.iter().filter(|l| (l.points[0].x > 0.0) == right).cloned();
        of.collect::<Vec<_>>()
    };
    assert_eq!(side(&auto, false), side(&on, false));
    assert_eq!(side(&auto, true), side(&off, true));
    assert_ne!(side(&on, true), side(&off, true));
}

#[test]
fn outlines_of_open_shells_are_whole() {
    // Bowls, seen from above and below, whose insides curve towards the eye.
    let profile: Vec<[f64; 2]> = (0..=12)
        .map(|k| (k as f64 / 12.0 * 1.3 + 0.25).sin_cos())
        .map(|(s, c)| [2.0 * s, -2.0 * c])
        .collect();
    let bowl = turned(&profile, 48);
    for z in [0.3, -0.3, 0.8, -0.8] {
        let v = view(DVec3::ZERO, DVec3::new(0.2, -1.0, z), 8.0, false);
        let options = Options { stubs: 0.01, ..Options::default() };
        let drawn = |smooth| {
            let options = Options { smooth, ..options.clone() };
            draw(&soup(&bowl), &v, &options, &mut NoTrace).expect("drawing")
        };
        let [smooth, plain] = [Smooth::On, Smooth::Off].map(drawn);
        for visible in [true, false] {
            let [a, b] = [&smooth, &plain].map(|d| d.length(|l| l.is_visible() == visible));
            assert!((a - b).abs() < 0.02 * 20.0, "{z} {visible}: {a}, {b}");
        }
    }
}

#[test]
fn turned_parts_have_the_lines_of_open_cascade() {
    // From Open CASCADE 7.8, HLRBRep_Algo, of the parts themselves: profiles, and visible and hidden lengths by view.
    let views =
        [DVec3::new(1.0, -1.0, 1.0), DVec3::new(0.3, -0.8, 1.6), DVec3::new(1.0, -2.2, 0.45)];
    let shaft: &[[f64; 2]] =
        &[[6.0, 0.0], [6.0, 10.0], [4.0, 10.0], [4.0, 22.0], [2.5, 22.0], [2.5, 30.0]];
    let cone: &[[f64; 2]] = &[[5.0, 0.0], [2.0, 10.0]];
    let pulley: &[[f64; 2]] =
        &[[8.0, 0.0], [8.0, 2.0], [5.0, 4.0], [5.0, 8.0], [8.0, 10.0], [8.0, 12.0]];
    let parts = [
        (shaft, [[130.171, 44.936], [125.32, 50.907], [124.221, 39.133]]),
        (cone, [[40.615, 11.359], [40.114, 9.452], [39.386, 10.333]]),
        (pulley, [[131.044, 93.898], [130.516, 125.601], [133.387, 71.296]]),
    ];
    for (profile, exact) in parts {
        let (bottom, top) = ([0.0, profile[0][1]], [0.0, profile[profile.len() - 1][1]]);
        let closed: Vec<[f64; 2]> = [&[bottom], profile, &[top]].concat();
        for (n, within) in [(64, 0.01), (126, 0.01)] {
            let part = turned(&closed, n);
            for (to_eye, exact) in views.into_iter().zip(exact) {
                let v = view(DVec3::new(0.0, 0.0, top[1] / 2.0), to_eye, 60.0, false);
                let options = Options { smooth: Smooth::Auto, stubs: 0.01, ..Options::default() };
                let drawing = draw(&soup(&part), &v, &options, &mut NoTrace).expect("drawing");
                let found = [true, false].map(|seen| drawing.length(|l| l.is_visible() == seen));
                let off = [0, 1].map(|k| (found[k] - exact[k]) / (exact[0] + exact[1]));
                let worst = off[0].abs().max(off[1].abs());
                assert!(worst < within, "{n} {to_eye}: {found:?}, not {exact:?}");
            }
        }
    }
}
