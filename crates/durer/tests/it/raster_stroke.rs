//! Strokes: the starts of dashes, the ends of joins, and the fineness of outlines.

use durer::curve::Path;
use durer::math::{DAffine2, DVec2};
use durer::raster::line::wide::{Cap, Join, Stroke};
use durer::raster::paint::{Canvas, Options, Paint};
use durer::target::Pixels;

const BLACK: Paint = Paint::Color([0, 0, 0, 255]);

/// Returns the alpha values of a stroke on a ground of 60×60 pixels.
fn alphas(path: &Path, stroke: &Stroke, transform: DAffine2) -> Pixels<u8> {
    let mut canvas = Canvas::new(60, 60, Options::default()).expect("canvas");
    canvas.set_transform(transform);
    canvas.stroke(path, stroke, &BLACK, 1.0).expect("stroke");
    let mut picture = Pixels::new(60, 60, [0; 4]);
    canvas.render(&mut picture).expect("size");
    Pixels::from_data(60, 60, picture.data().iter().map(|p| p[3]).collect()).expect("size")
}

/// Returns which of the pixels from x = 10 on are covered by a dashed line from there to 50.
fn dashes(dashes: &[f64], dash_offset: f64) -> String {
    let line = Path::polyline([DVec2::new(10.0, 30.0), DVec2::new(50.0, 30.0)]);
    let stroke = Stroke { width: 2.0, dashes: dashes.to_vec(), dash_offset, ..Stroke::default() };
    let found = alphas(&line, &stroke, DAffine2::IDENTITY);
    (10..50).map(|x| if found.get(x, 30) == Some(255) { '#' } else { '.' }).collect()
}

#[test]
fn dashes_begin_where_the_offset_says() {
    assert_eq!(dashes(&[4.0, 6.0], 0.0), "####......".repeat(4));
    assert_eq!(dashes(&[4.0, 6.0], 3.0), "#......###".repeat(4));
    for offset in [-7.0, 13.0, -107.0, 1e6 + 3.0] {
        assert_eq!(dashes(&[4.0, 6.0], offset), dashes(&[4.0, 6.0], 3.0), "{offset}");
    }
    // An odd list is repeated, so that dashes and gaps alternate.
    assert_eq!(dashes(&[5.0, 3.0, 2.0], 0.0), "#####...##.....###..".repeat(2));
    assert_eq!(dashes(&[5.0], 5.0), ".....#####".repeat(4));
    assert_eq!(dashes(&[5.0, 3.0, 2.0], 10.0), ".....###..#####...##".repeat(2));
}

#[test]
fn dots_at_corners_are_round() {
    let corner = [(10.0, 30.0), (30.0, 30.0), (30.0, 10.0)].map(|(x, y)| DVec2::new(x, y));
    // Half of the dot is before the corner and half behind it.
    let dot = 1e-4 * 16.0;
    let stroke = Stroke {
        width: 16.0,
        cap: Cap::Round,
        join: Join::Miter,
        dashes: vec![0.0, 20.0],
        dash_offset: dot / 2.0,
        ..Stroke::default()
    };
    let found = alphas(&Path::polyline(corner), &stroke, DAffine2::IDENTITY);
    assert_eq!((found.get(34, 34), found.get(36, 36)), (Some(255), Some(0)));
}

#[test]
fn sharp_joins_end_at_the_miter_limit() {
    // A corner of 60°: its miter is twice as long as the stroke is wide.
    let height = 20.0 * 3f64.sqrt();
    let wedge = [(10.0, 50.0), (30.0, 50.0 - height), (50.0, 50.0)].map(|(x, y)| DVec2::new(x, y));
    let tip = |miter_limit| {
        let stroke = Stroke { width: 8.0, miter_limit, ..Stroke::default() };
        let found = alphas(&Path::polyline(wedge), &stroke, DAffine2::IDENTITY);
        (0..60).find(|&y| found.get(30, y) != Some(0))
    };
    let (mitered, bevelled) =
        (Some((50.0 - height - 8.0) as u32), Some((50.0 - height - 2.0) as u32));
    for (limit, expected) in [(2.05, mitered), (1.95, bevelled), (1.0, bevelled), (10.0, mitered)] {
        assert_eq!(tip(limit), expected, "{limit}");
    }
}

#[test]
fn outlines_are_as_fine_in_pixels_whatever_the_scale() {
    // The same bends, drawn small and enlarged, or large and reduced.
    let at = |scale: f64| {
        let p = |x: f64, y: f64| DVec2::new(x, y) / scale;
        let mut bends = Path::new();
        bends.move_to(5.0 / scale, 5.0 / scale).cubic_to(
            p(95.0, 5.0),
            p(-35.0, 55.0),
            p(55.0, 55.0),
        );
        bends.quad_to(58.0 / scale, 2.0 / scale, 40.0 / scale, 30.0 / scale);
        let stroke = Stroke { width: 9.0 / scale, join: Join::Round, ..Stroke::default() };
        alphas(&bends, &stroke, DAffine2::from_scale(DVec2::splat(scale)))
    };
    let expected = at(1.0);
    for scale in [1e-3, 0.01, 20.0, 400.0, 1e5] {
        let found = at(scale);
        let pairs = found.data().iter().zip(expected.data());
        let worst = pairs.map(|(a, b)| a.abs_diff(*b)).max();
        println!("{scale}: {worst:?}");
        assert!(worst <= Some(10), "{scale}: {worst:?}");
    }
}
