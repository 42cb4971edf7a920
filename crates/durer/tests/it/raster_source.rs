//! Paint sources: gradients of all shapes, images between their pixels, mixing in linear light.

use durer::curve::Path;
use durer::math::{DAffine2, DVec2};
use durer::raster::coverage::{FillRule, PartitionFace, fill_partition};
use durer::raster::paint::{Blending, Canvas, ImageFilter, Options, Paint, Pattern};
use durer::target::Pixels;
use durer::target::gradient::{Gradient, GradientShape, Spread};
use durer::trace::NoTrace;
use std::sync::Arc;

/// Returns a square of 40×40 pixels in one paint, over nothing.
fn square(paint: &Paint, options: Options) -> Pixels<[u8; 4]> {
    let mut canvas = Canvas::new(40, 40, options).expect("canvas");
    canvas.fill(&Path::rectangle(0.0, 0.0, 40.0, 40.0), FillRule::NonZero, paint, 1.0);
    let mut picture = Pixels::new(40, 40, [0; 4]);
    canvas.render(&mut picture).expect("size");
    picture
}

/// Returns the whiteness around the middle of a pixel of a gradient from black at 0 to white at 1; `None` outside.
fn parameter(shape: GradientShape, x: u32, y: u32) -> Option<f64> {
    let stops = vec![(0.0, [0, 0, 0, 255]), (1.0, [255; 4])];
    let transform = DAffine2::IDENTITY;
    let gradient = Gradient { shape, stops, spread: Spread::Pad, transform };
    let picture = square(&Paint::Gradient(Arc::new(gradient)), Options::default());
    let [white, .., alpha] = picture.get(x, y).expect("pixel");
    (alpha > 0).then(|| f64::from(white) / 255.0)
}

#[test]
fn circles_that_touch_from_within_cover_their_side_only() {
    // The focus is on the outer circle: t = |p − f|² / (2 (p − f) · (c − f)).
    let (center, focus) = (DVec2::new(20.5, 20.5), DVec2::new(10.5, 20.5));
    let shape = GradientShape::Radial { center, radius: 10.0, focus, focus_radius: 0.0 };
    for (x, y) in [(20, 20), (12, 20), (25, 20), (20, 14), (12, 24)] {
        let p = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5) - focus;
        let expected = (p.length_squared() / (2.0 * p.dot(center - focus))).min(1.0);
        let found = parameter(shape, x, y).expect("covered");
        assert!((found - expected).abs() < 0.006, "{x},{y}: {found} {expected}");
    }
    assert_eq!(parameter(shape, 5, 20), None);
}

#[test]
fn circles_that_shrink_outwards_run_inwards() {
    let center = DVec2::splat(20.5);
    let shape = GradientShape::Radial { center, radius: 5.0, focus: center, focus_radius: 15.0 };
    for (x, expected) in [(30, 0.5), (33, 0.2), (25, 1.0), (22, 1.0), (39, 0.0)] {
        let found = parameter(shape, x, 20).expect("covered");
        assert!((found - expected).abs() < 0.006, "{x}: {found}");
    }
    // A cone that ends in its apex: beyond it there is nothing.
    let (center, focus) = (DVec2::new(25.5, 20.5), DVec2::new(5.5, 20.5));
    let cone = GradientShape::Radial { center, radius: 2.0, focus, focus_radius: 10.0 };
    assert_eq!(parameter(cone, 39, 20), None);
    let inside = parameter(cone, 5, 20).expect("covered");
    assert!((inside - 10.0 / 28.0).abs() < 0.006, "{inside}");
}

#[test]
fn gradients_without_extent_have_the_last_colour() {
    let (start, center) = (DVec2::splat(9.0), DVec2::splat(20.0));
    for shape in [
        GradientShape::Linear { start, end: start },
        GradientShape::Radial { center, radius: 0.0, focus: center, focus_radius: 0.0 },
    ] {
        assert_eq!(parameter(shape, 3, 3), Some(1.0), "{shape:?}");
    }
}

#[test]
fn clear_pixels_of_an_image_lend_no_colour() {
    let image = Pixels::from_data(2, 1, vec![[200, 40, 0, 255], [0, 255, 255, 0]]).expect("size");
    let transform = DAffine2::from_scale(DVec2::splat(20.0));
    let pattern = Pattern {
        image: Arc::new(image),
        transform,
        spread: Some(Spread::Pad),
        filter: ImageFilter::Bilinear,
    };
    let picture = square(&Paint::Pattern(Arc::new(pattern)), Options::default());
    let mut alphas = Vec::new();
    for x in 0..40 {
        let [r, g, b, alpha] = picture.get(x, 20).expect("pixel");
        alphas.push(alpha);
        if alpha > 30 {
            assert!(r.abs_diff(200) < 5 && g.abs_diff(40) < 5 && b < 5, "{x}: {r} {g} {b} {alpha}");
        }
    }
    assert_eq!((alphas[5], alphas[35]), (255, 0));
    assert!(alphas.windows(2).all(|w| w[0] >= w[1]) && alphas[20].abs_diff(124) < 4, "{alphas:?}");
}

/// Returns a picture of 40 × 40 with a one-row image, enlarged to this many pixels per image pixel.
fn enlarged(row: &[u8], by: f64, filter: ImageFilter) -> Vec<u8> {
    let data = row.iter().map(|v| [*v, *v, *v, 255]).collect();
    let image = Arc::new(Pixels::from_data(row.len() as u32, 1, data).expect("size"));
    let transform = DAffine2::from_scale(DVec2::splat(by));
    let pattern = Pattern { image, transform, spread: Some(Spread::Pad), filter };
    let picture = square(&Paint::Pattern(Arc::new(pattern)), Options::default());
    picture.row(20).iter().map(|c| c[0]).collect()
}

#[test]
fn mitchell_s_filter_keeps_ramps_and_overshoots_at_steps() {
    let ramp =
        enlarged(&[40, 60, 80, 100, 120, 140, 160, 180, 200, 220], 4.0, ImageFilter::Bicubic);
    let line = |x: usize| 40.0 + ((x as f64 + 0.5) / 4.0 - 0.5) * 20.0;
    for (x, v) in ramp.iter().enumerate().take(33).skip(8) {
        assert!((f64::from(*v) - line(x)).abs() <= 0.5, "{x}: {v}");
    }
    let step =
        enlarged(&[100, 100, 100, 100, 100, 200, 200, 200, 200, 200], 4.0, ImageFilter::Bicubic);
    assert!(step[13..19].iter().any(|v| *v < 100) && step[21..27].iter().any(|v| *v > 200));
    // At a pixel's centre its neighbours have a weight of 1/18 each, equally on both sides.
    let weights = [1.0 / 18.0, 16.0 / 18.0, 1.0 / 18.0];
    let image = [0, 0, 0, 0, 180, 0, 0, 0];
    let odd = enlarged(&image, 5.0, ImageFilter::Bicubic);
    let found = [odd[17], odd[22], odd[27]].map(f64::from);
    assert!(found.iter().zip(weights).all(|(f, w)| (f - 180.0 * w).abs() <= 0.51), "{found:?}");
}

#[test]
fn areas_are_means_of_what_a_pixel_covers() {
    let row: Vec<u8> = (0..320).map(|i| if i % 32 < 12 { 0 } else { 240 }).collect();
    let found = enlarged(&row, 0.125, ImageFilter::Area);
    // Periods of four pixels: black, half black, white, white.
    for (i, v) in found.iter().enumerate().take(36).skip(4) {
        let wanted = [0.0, 120.0, 240.0, 240.0][i % 4];
        assert!((f64::from(*v) - wanted).abs() <= 0.5, "{i}: {v}");
    }
}

#[test]
fn linear_light_comes_back_as_the_nearest_byte() {
    let linear = |v: f64| {
        if v <= 0.040_45 { v / 12.92 } else { libm::pow((v + 0.055) / 1.055, 2.4) }
    };
    for level in 0..=255u8 {
        let options = Options { blending: Blending::Linear, ..Options::default() };
        let mut canvas = Canvas::new(1, 1, options).expect("canvas");
        let all = Path::rectangle(0.0, 0.0, 1.0, 1.0);
        let opacity = f64::from(level) / 255.0;
        canvas.fill(&all, FillRule::NonZero, &Paint::Color([255; 4]), opacity);
        let mut picture = Pixels::new(1, 1, [0, 0, 0, 255]);
        canvas.render(&mut picture).expect("size");
        let found = picture.get(0, 0).expect("pixel")[0];
        let off = |byte: u8| (linear(f64::from(byte) / 255.0) - opacity).abs();
        for other in [found.saturating_sub(1), found.saturating_add(1)] {
            assert!(off(found) <= off(other) + 2e-5, "{level}: {found}, not {other}");
        }
    }
}

#[test]
fn faces_mix_with_what_is_below_and_with_each_other() {
    let all = || Path::rectangle(0.0, 0.0, 4.0, 4.0);
    let face = |color| PartitionFace { contours: durer::curve::flatten(&all(), 0.1), color };
    let drawn = |faces: &[PartitionFace], below| {
        let mut picture = Pixels::new(4, 4, below);
        fill_partition(faces, &mut picture, &mut NoTrace).expect("size");
        picture.get(1, 1).expect("pixel")
    };
    // Half of black over white, over nothing, and over half of white.
    let near = |found: [u8; 4], expected: [u8; 4]| {
        assert!(
            found.iter().zip(expected).all(|(a, b)| a.abs_diff(b) <= 1),
            "{found:?} {expected:?}"
        );
    };
    let half = [face([0, 0, 0, 128])];
    near(drawn(&half, [255; 4]), [127, 127, 127, 255]);
    near(drawn(&half, [0; 4]), [0, 0, 0, 128]);
    near(drawn(&half, [255, 255, 255, 128]), [84, 84, 84, 192]);
    // Overlapping faces, although none were requested, share the pixel.
    near(drawn(&[face([0, 0, 0, 100]), face([0, 0, 0, 100])], [0; 4]), [0, 0, 0, 100]);
    near(drawn(&[face([255, 0, 0, 255]), face([0, 0, 255, 255])], [255; 4]), [128, 0, 128, 255]);
}

#[test]
fn hard_spans_end_where_they_end_in_every_paint() {
    let shape = GradientShape::Linear { start: DVec2::ZERO, end: DVec2::new(90.0, 0.0) };
    let stops = vec![(0.0, [0, 0, 0, 255]), (1.0, [9, 9, 9, 255])];
    let (spread, transform) = (Spread::Pad, DAffine2::IDENTITY);
    let gradient = Gradient { shape, stops, spread, transform };
    let paints = [
        Paint::Color([0, 0, 0, 255]),
        Paint::Color([0, 0, 0, 128]),
        Paint::Gradient(Arc::new(gradient)),
    ];
    for (paint, clipped) in paints.iter().flat_map(|p| [(p, false), (p, true)]) {
        for (from, to) in (0..9).flat_map(|from| (from + 1..from + 20).map(move |to| (from, to))) {
            let options = Options { anti_alias: false, ..Options::default() };
            let mut canvas = Canvas::new(40, 2, options).expect("canvas");
            let path = Path::rectangle(from.into(), 0.0, (to - from).into(), 2.0);
            if clipped {
                canvas.push_clip(&Path::rectangle(0.0, 0.0, 40.0, 2.0), FillRule::NonZero);
            }
            canvas.fill(&path, FillRule::NonZero, paint, 1.0);
            let mut picture = Pixels::new(40, 2, [0; 4]);
            canvas.render(&mut picture).expect("size");
            let covered = |x: &u32| picture.get(*x, 1).is_some_and(|p| p[3] > 0);
            let found: Vec<u32> = (0..40).filter(covered).collect();
            assert_eq!(found, (from..to).collect::<Vec<u32>>(), "{paint:?} {clipped}");
        }
    }
}
