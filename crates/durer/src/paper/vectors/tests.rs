use super::*;
use crate::paper::paint;
use crate::raster::paint::Canvas;
use crate::target::Pixels;
use crate::target::gradient::{GradientShape, Spread};
use std::sync::Arc;

const SIDE: u32 = 64;

/// Returns the largest difference of a picture that is drawn directly from one that is drawn by way of a sheet.
fn difference(draw: impl Fn(&mut dyn PaintTarget)) -> u8 {
    let mut canvas = Canvas::new(SIDE, SIDE, Options::default()).expect("canvas");
    let mut painter = SheetPainter::new(SIDE, SIDE);
    canvas.clear([255; 4]);
    draw(&mut canvas);
    draw(&mut painter);
    let mut direct = Pixels::new(SIDE, SIDE, [255; 4]);
    canvas.render(&mut direct).expect("rendered");
    assert!(direct.data().iter().any(|pixel| *pixel != [255; 4]), "nothing is painted");
    let sheet = painter.into_sheet().expect("vectors");
    let by_sheet = paint(sheet, SIDE, SIDE, [255; 4]).expect("painted");
    let channels = direct.data().iter().flatten().zip(by_sheet.data().iter().flatten());
    channels.map(|(a, b)| a.abs_diff(*b)).max().unwrap_or(0)
}

fn star(far: f64) -> Path {
    let corners = [(32.0, 4.0), (50.0, 60.0), (4.0, 24.0), (60.0, 24.0), (14.0, far)];
    Path::polygon(corners.map(DVec2::from))
}

#[test]
fn a_sheet_shows_what_a_canvas_shows() {
    let red = Paint::Color([200, 0, 0, 255]);
    let thin = Paint::Color([0, 0, 90, 120]);
    let round = Stroke { width: 3.0, cap: Cap::Round, join: Join::Round, ..Stroke::default() };
    for rule in [FillRule::NonZero, FillRule::EvenOdd] {
        for far in [60.0, 1e7] {
            assert!(difference(|t| t.fill(&star(far), rule, &red, 0.7)) <= 2, "{rule:?} {far}");
            let clipped = difference(|t| {
                t.push_clip(&star(far), rule);
                t.fill(&Path::circle(DVec2::splat(30.0), 25.0), FillRule::NonZero, &red, 1.0);
                t.pop(1.0);
                t.fill(&Path::circle(DVec2::splat(9.0), 5.0), FillRule::NonZero, &red, 1.0);
            });
            assert!(clipped <= 3, "{rule:?} {far}: {clipped}");
        }
    }
    let dashed = Stroke { dashes: vec![5.0, 3.0], cap: Cap::Butt, ..round.clone() };
    let mitred = Stroke { join: Join::Miter, cap: Cap::Square, ..round.clone() };
    for stroke in [&round, &dashed, &mitred] {
        for (paint, far) in [(&red, 60.0), (&thin, 60.0), (&red, 1e5)] {
            let found = difference(|t| {
                t.set_transform(DAffine2::from_scale(DVec2::new(1.0, 0.8)));
                t.stroke(&star(far), stroke, paint, 1.0).expect("stroke");
                t.set_transform(DAffine2::IDENTITY);
                t.stroke(&star(far), stroke, paint, 0.5).expect("stroke");
            });
            assert!(found <= 6, "{stroke:?} {far}: {found}");
        }
    }
    let group = difference(|t| {
        t.push_group();
        t.fill(&star(60.0), FillRule::NonZero, &red, 1.0);
        t.push_group();
        t.fill(&Path::circle(DVec2::splat(30.0), 25.0), FillRule::NonZero, &thin, 1.0);
        t.pop(1.0);
        t.pop(0.4);
    });
    assert!(group <= 3, "{group}");
}

#[test]
fn several_clip_paths_are_united() {
    let circle = |x: f64| Path::circle(DVec2::new(x, 32.0), 12.0);
    let mut ring = circle(36.0);
    ring.extend(&Path::circle(DVec2::new(36.0, 32.0), 6.0));
    let paths = [(circle(20.0), FillRule::NonZero), (ring, FillRule::EvenOdd)];
    let red = Paint::Color([200, 0, 0, 255]);
    let found = difference(|t| {
        t.set_transform(DAffine2::from_scale(DVec2::new(1.0, 0.8)));
        if !t.push_united_clip(&paths) {
            t.begin_mask();
            for (path, rule) in &paths {
                t.fill(path, *rule, &red, 1.0);
            }
            t.end_mask(MaskKind::Alpha);
        }
        t.fill(&Path::rectangle(0.0, 0.0, 60.0, 80.0), FillRule::NonZero, &red, 1.0);
        t.pop(1.0);
        t.fill(&Path::circle(DVec2::splat(9.0), 5.0), FillRule::NonZero, &red, 1.0);
    });
    // Where the circles cross, a mask has the coverage of both.
    assert!(found <= 40, "{found}");
}

#[test]
fn layers_keep_the_clip_paths_that_are_open() {
    let mut painter = SheetPainter::new(SIDE, SIDE);
    let red = Paint::Color([200, 0, 0, 255]);
    painter.push_clip(&Path::rectangle(-1.0, -1.0, 99.0, 99.0), FillRule::NonZero);
    painter.push_clip(&Path::rectangle(8.0, 8.0, 9.0, 9.0), FillRule::NonZero);
    for name in ["a", "a", "b"] {
        painter.begin_layer(name);
        painter.fill(&star(60.0), FillRule::NonZero, &red, 1.0);
    }
    let sheet = painter.into_sheet().expect("vectors");
    let names: Vec<&str> = sheet.layers.iter().map(|layer| &layer.name[..]).collect();
    assert_eq!(names, ["a", "a-2", "b"]);
    for layer in &sheet.layers {
        let [PaperMark::Group(group)] = &layer.marks[..] else { panic!("{:?}", layer.marks) };
        assert!(group.clip.is_some() && group.marks.len() == 1);
    }
}

#[test]
fn content_without_vectors_is_named() {
    let mut painter = SheetPainter::new(SIDE, SIDE);
    painter.begin_mask();
    painter.end_mask(MaskKind::Alpha);
    painter.push_group();
    painter.pop_blended(1.0, BlendFunction::Multiply);
    let refused = painter.into_sheet().expect_err("refused");
    let names = ["blend modes", "masks"];
    assert_eq!(Vec::from_iter(refused), names);
}

#[test]
fn gradients_show_what_a_canvas_shows() {
    let stops = vec![(0.0, [200, 0, 0, 255]), (0.5, [0, 90, 0, 80]), (1.0, [0, 0, 220, 255])];
    let turned = DAffine2::from_cols_array(&[0.8, 0.5, -0.9, 1.1, 6.0, -4.0]);
    let focus = DVec2::new(29.0, 25.0);
    for shape in [
        GradientShape::Linear { start: DVec2::new(20.0, 8.0), end: DVec2::new(36.0, 20.0) },
        GradientShape::Radial {
            center: DVec2::splat(30.0),
            radius: 14.0,
            focus,
            focus_radius: 2.0,
        },
    ] {
        for spread in [Spread::Pad, Spread::Repeat, Spread::Reflect] {
            for transform in [DAffine2::IDENTITY, turned] {
                let gradient = Gradient { shape, stops: stops.clone(), spread, transform };
                let paint = Paint::Gradient(Arc::new(gradient));
                let found = difference(|t| {
                    t.set_transform(DAffine2::from_scale(DVec2::new(1.2, 0.9)));
                    t.fill(&star(60.0), FillRule::EvenOdd, &paint, 0.6);
                });
                // Where a gradient begins again, its parameter may be on the other side.
                let most = if spread == Spread::Repeat { 160 } else { 3 };
                assert!(found <= most, "{shape:?} {spread:?} {transform}: {found}");
            }
        }
    }
    let flat = Gradient {
        shape: GradientShape::Linear { start: focus, end: focus },
        stops,
        spread: Spread::Pad,
        transform: turned,
    };
    let paint = Paint::Gradient(Arc::new(flat));
    let found = difference(|t| t.fill(&star(60.0), FillRule::NonZero, &paint, 1.0));
    assert!(found <= 1, "the last colour everywhere: {found}");
}

/// Returns the marks that are painted for CAD on a sheet as large as 64 pixels.
fn for_cad(draw: impl Fn(&mut SheetPainter)) -> Vec<PaperMark> {
    let mut painter = SheetPainter::new(SIDE, SIDE);
    painter.set_cad();
    draw(&mut painter);
    let sheet = painter.into_sheet().expect("vectors");
    sheet.layers.into_iter().flat_map(|layer| layer.marks).collect()
}

#[test]
fn marks_for_cad_are_cut_and_fill_by_turns() {
    let red = Paint::Color([200, 0, 0, 255]);
    let side = f64::from(SIDE) * MILLIMETRES;
    let miter = Stroke { width: 2.0, join: Join::Miter, dashes: vec![4.0], ..Stroke::default() };
    let line = |from: f64, to: f64| Path::polyline([(from, 32.0), (to, 32.0)].map(DVec2::from));
    let marks = for_cad(|t| {
        t.stroke(&line(-500.0, 40.0), &miter, &red, 1.0).expect("stroke");
        t.push_clip(&Path::rectangle(8.0, 8.0, 24.0, 99.0), FillRule::NonZero);
        t.begin_layer("again");
        t.stroke(&line(0.0, 40.0), &miter, &red, 1.0).expect("stroke");
        t.push_clip(&Path::rectangle(50.0, 8.0, 9.0, 9.0), FillRule::NonZero);
        t.fill(&star(60.0), FillRule::NonZero, &red, 1.0);
        t.pop(1.0);
        t.pop(1.0);
        t.stroke(&line(60.0, 70.0), &miter, &red, 1.0).expect("stroke");
    });
    let ends = |mark: &PaperMark| match mark {
        PaperMark::Stroke { points, closed: false, pen: 0 } => [points[0].x, points[1].x],
        other => panic!("{other:?}"),
    };
    let found: Vec<[f64; 2]> = marks.iter().map(ends).collect();
    let expected =
        [[0.0, 40.0], [8.0, 32.0], [60.0, 64.0]].map(|pair| pair.map(|x| x * MILLIMETRES));
    assert_eq!(found.len(), expected.len(), "the star is in no clip path: {marks:?}");
    for (found, expected) in found.iter().flatten().zip(expected.iter().flatten()) {
        assert!((found - expected).abs() < 1e-9 * side, "{found} {expected}");
    }

    // The middle of a star is wound around twice; a circle stays a curve.
    let marks = for_cad(|t| {
        t.fill(&star(60.0), FillRule::NonZero, &red, 1.0);
        t.fill(&Path::circle(DVec2::splat(30.0), 20.0), FillRule::NonZero, &red, 1.0);
    });
    let [PaperMark::Fill { rings, even_odd: true, .. }, PaperMark::Area { even_odd: false, .. }] =
        &marks[..]
    else {
        panic!("{marks:?}")
    };
    assert_eq!((rings.len(), rings[0].len()), (1, 10), "the outline of a star has ten corners");
}

#[test]
fn cad_without_clip_paths_and_opacities_is_refused() {
    let red = Paint::Color([200, 0, 0, 255]);
    let mut painter = SheetPainter::new(SIDE, SIDE);
    painter.set_cad();
    painter.push_clip(&star(60.0), FillRule::NonZero);
    painter.push_group();
    painter.fill(&star(60.0), FillRule::NonZero, &red, 1.0);
    painter.pop(0.5);
    let refused = painter.into_sheet().expect_err("refused");
    assert_eq!(Vec::from_iter(refused), ["clip paths", "opacities of whole layers"]);
}
