//! Interpolation at corners, along edges and along rows, compared with barycentric coordinates.

use durer::math::{DVec2, DVec3};
use durer::raster::interpolate::rows::{Corner, interpolate, replay};
use durer::raster::interpolate::{barycentric_2d, blend, perspective_correct};
use durer::raster::triangle::Options;
use durer::trace::{NoTrace, Recorder};
use durer::view::window::PixelRect;

fn corners() -> [Corner; 3] {
    let corner = |x: f64, y: f64, w: f64, value: f64| Corner {
        at: DVec2::new(x, y),
        inv_w: 1.0 / w,
        value: DVec3::new(value, 1.0 - value, value * value),
    };
    [corner(1.25, 0.75, 1.0, 0.0), corner(14.5, 3.0, 4.0, 1.0), corner(4.0, 11.5, 2.0, 0.5)]
}

#[test]
fn rows_agree_with_barycentric_coordinates_and_steps_rebuild_them() {
    let options = Options { clip: PixelRect::spanning(0, 0, 12, 20) };
    let (mut steps, mut pixels, mut quiet) = (Recorder::default(), Vec::new(), Vec::new());
    interpolate(&corners(), &options, |p, v| pixels.push((p, v)), &mut steps).unwrap();
    interpolate(&corners(), &options, |p, v| quiet.push((p, v)), &mut NoTrace).unwrap();
    assert_eq!((&pixels, &replay(steps.steps())), (&quiet, &pixels));
    assert!(pixels.len() > 40);
    let points = corners().map(|c| c.at);
    for (pixel, value) in pixels {
        let screen = barycentric_2d(points, pixel.as_dvec2() + 0.5).unwrap();
        let weights = perspective_correct(screen, corners().map(|c| c.inv_w));
        let expected = blend(weights, corners().map(|c| c.value));
        assert!(value.distance(expected) < 1e-12, "{pixel}: {value} {expected}");
    }
}

#[test]
fn strange_corners_are_refused_or_give_nothing() {
    let mut strange = corners();
    strange[1].at.x = f64::NAN;
    let run = |corners: &[Corner; 3]| {
        let mut count = 0;
        interpolate(corners, &Options::default(), |_, _| count += 1, &mut NoTrace).map(|()| count)
    };
    assert!(run(&strange).is_err());
    let mut behind = corners();
    behind[0].inv_w = -1.0;
    assert!(run(&behind).is_err());
    let flat = corners().map(|c| Corner { at: DVec2::new(c.at.x, 3.0), ..c });
    assert_eq!(run(&flat).unwrap(), 0);
}
