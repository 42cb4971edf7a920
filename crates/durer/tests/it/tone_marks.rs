//! Marks for tones follow the surfaces and are denser where it is darker.

use crate::line_scenes::{Triangle, soup};
use durer::math::{DVec2, DVec3, Vec3};
use durer::pipeline::{DrawOptions, Lighting, ToneMarks, tone_marks};
use durer::scene::{Camera, Light, LightKind, Projection, Scene};
use durer::target::drawing::{Line, LineClass};

/// Returns a camera that looks along −z at a square of side 4 around the origin.
fn camera() -> Camera {
    let projection = Projection::Orthographic { height: 4.0 };
    Camera {
        eye: DVec3::Z * 10.0,
        target: DVec3::ZERO,
        up: DVec3::Y,
        projection,
        near: 1.0,
        far: 20.0,
    }
}

/// Returns a tube of radius 1 around the y axis, from −1.5 to 1.5, of `n` flat sides.
fn tube(n: usize) -> Scene {
    let at = |i: usize, y: f64| {
        let angle = i as f64 / n as f64 * std::f64::consts::TAU;
        DVec3::new(angle.sin(), y, angle.cos())
    };
    let sides = (0..n).flat_map(|i| {
        let [a, b, c, d] = [at(i, -1.5), at(i + 1, -1.5), at(i + 1, 1.5), at(i, 1.5)];
        [[a, b, c], [a, c, d]]
    });
    soup(&sides.collect::<Vec<Triangle>>())
}

fn options() -> DrawOptions {
    // From the left, so the right side is dark.
    let light = Light {
        kind: LightKind::Directional { direction: DVec3::new(1.0, 0.0, -0.2).normalize() },
        color: Vec3::ONE,
    };
    DrawOptions { lighting: Lighting::Given(vec![light]), ..DrawOptions::new(camera()) }
}

fn marks(scene: &Scene, marks: ToneMarks) -> Vec<Line> {
    tone_marks(scene, &options(), marks).expect("marks")
}

#[test]
fn lines_go_around_a_tube_and_are_closer_in_the_dark() {
    let lines = marks(&tube(48), ToneMarks::Contours { spacing: 0.04 });
    assert!(lines.iter().all(|l| l.class == LineClass::Hatch && l.is_visible()));
    // Lengths between two places: of the lines that go around, and of all.
    let length = |low: f64, high: f64, around: bool| -> f64 {
        let sides = lines.iter().flat_map(|l| l.points.windows(2)).map(|w| (w[0], w[1]));
        let kept = sides.filter(|(a, b)| !around || (b.y - a.y).abs() <= 0.2 * (b.x - a.x).abs());
        let share = |(a, b): (DVec2, DVec2)| {
            let (from, to) = (a.x.min(b.x), a.x.max(b.x));
            let part = (to.min(high) - from.max(low)).max(0.0) / (to - from).max(1e-12);
            a.distance(b) * part
        };
        kept.map(share).sum()
    };
    let (around, lit) = (length(-0.8, -0.3, true), length(-0.8, -0.3, false));
    assert!(around > 0.95 * lit, "{around} of {lit} go around");
    // A band in the light and one of the same width in the dark: there lines are 0.04 apart.
    let (bright, dark) = (length(-0.7, -0.3, true), length(0.3, 0.7, true));
    assert!(dark > 3.0 * bright, "{dark} in the dark, {bright} in the light");
    assert!((0.75..1.2).contains(&(dark / (0.4 * 3.0 / 0.04))), "{dark}");
    let within = |p: &DVec2| p.x.abs() < 1.01 && p.y.abs() < 1.51;
    assert!(lines.iter().flat_map(|l| &l.points).all(within));
}

#[test]
fn dots_are_denser_in_the_dark_and_cover_no_more_than_there_is() {
    let diameter = 0.04;
    let dots = marks(&tube(48), ToneMarks::Dots { diameter });
    assert!(dots.iter().all(|l| l.class == LineClass::Stipple && l.length() < 0.1 * diameter));
    let count =
        |low: f64, high: f64| dots.iter().filter(|l| (low..high).contains(&l.points[0].x)).count();
    let (bright, dark) = (count(-0.7, -0.3), count(0.3, 0.7));
    assert!(dark > 3 * bright && dark > 300, "{dark} in the dark, {bright} in the light");
    let covered = dots.len() as f64 * std::f64::consts::FRAC_PI_4 * diameter * diameter;
    assert!(covered < 0.7 * 6.0, "{covered} of 6");
    assert!(dots.iter().all(|l| l.points[0].x.abs() < 1.01 && l.points[0].y.abs() < 1.51));
}

#[test]
fn the_far_side_of_an_edge_gets_lines_of_its_own() {
    // Two plates, one a step nearer: no line crosses from one to the other.
    let plate = |x: f64, z: f64| {
        let at = |u: f64, v: f64| DVec3::new(x + u, v, z);
        [[at(0.0, -1.5), at(1.5, -1.5), at(1.5, 1.5)], [at(0.0, -1.5), at(1.5, 1.5), at(0.0, 1.5)]]
    };
    let scene = soup(&[plate(-1.5, 0.0), plate(0.0, 0.7)].concat());
    let lines = marks(&scene, ToneMarks::Contours { spacing: 0.04 });
    assert!(lines.len() > 20);
    for line in &lines {
        let right = line.points.iter().filter(|p| p.x > 0.02).count();
        let left = line.points.iter().filter(|p| p.x < -0.02).count();
        assert!(left == 0 || right == 0, "{line:?}");
    }
}

#[test]
fn sizes_are_numbers_above_0() {
    for size in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        for wrong in [ToneMarks::Contours { spacing: size }, ToneMarks::Dots { diameter: size }] {
            assert!(tone_marks(&tube(8), &options(), wrong).is_err());
        }
    }
    let nothing = ToneMarks::Dots { diameter: 0.1 };
    assert!(marks(&Scene::default(), nothing).is_empty());
}
