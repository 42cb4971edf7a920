//! Work within a budget: work that does not fit is an error, stopped work ends, and all memory is given back.

use crate::scenes::{options, soup};
use durer::Error;
use durer::clip::polygon::{BooleanOp, Shapes, WindingRule, overlay};
use durer::curve::{Path, PathElement};
use durer::math::DVec2;
use durer::pipeline::{
    DrawOptions, DrawStyle, RenderOptions, Shadows, SurfaceMethod, draw, render,
};
use durer::raster::coverage::FillRule;
use durer::raster::line::wide::{Cap, Stroke, buffer};
use durer::raster::paint::{Canvas, Options, Paint};
use durer::scene::Scene;
use durer::target::{Framebuffer, Pixels};
use durer::trace::NoTrace;
use durer::work::Work;

fn within(work: &Work) -> RenderOptions {
    RenderOptions { work: work.clone(), ..options(&Scene::default(), 64, 48) }
}

fn stage(error: &Error) -> &'static str {
    match error {
        Error::Memory { stage, .. } => stage,
        _ => "none",
    }
}

#[test]
fn pictures_are_the_same_within_a_budget_and_give_all_of_it_back() {
    let scene = soup(400, 1);
    for &algorithm in SurfaceMethod::ALL {
        let work = Work::with_budget(4 << 20, "the budget");
        let shadows = Shadows::Map;
        let of = |work: &Work| RenderOptions {
            algorithm,
            shadows,
            shadow_map_side: 64,
            item: true,
            ..within(work)
        };
        let (free, _) = render(&scene, &of(&Work::default())).expect("picture");
        let (bounded, _) = render(&scene, &of(&work)).expect("picture");
        assert_eq!(free, bounded, "{algorithm}");
        // Two planes of four bytes a pixel.
        assert_eq!(work.used(), 64 * 48 * 8, "{algorithm}");
        drop(bounded);
        assert_eq!(work.used(), 0, "{algorithm}");
    }
}

#[test]
fn every_method_refuses_planes_and_triangles_that_do_not_fit() {
    let scene = soup(2000, 1);
    for &algorithm in SurfaceMethod::ALL {
        for (budget, expected) in
            [(64 * 48 * 3, "planes of the picture"), (40_000, "triangles on the screen")]
        {
            let work = Work::with_budget(budget, "the budget");
            let error = render(&scene, &RenderOptions { algorithm, ..within(&work) });
            assert_eq!(stage(&error.unwrap_err()), expected, "{algorithm}");
            assert_eq!(work.used(), 0, "{algorithm}");
        }
    }
}

#[test]
fn what_is_stopped_ends_with_the_reason() {
    let scene = soup(400, 1);
    let work = Work::stoppable();
    let camera = within(&work).camera;
    work.stop(Error::Cancelled);
    for &algorithm in SurfaceMethod::ALL {
        let ended = render(&scene, &RenderOptions { algorithm, ..within(&work) });
        assert_eq!(ended.unwrap_err(), Error::Cancelled);
    }
    for &style in DrawStyle::ALL {
        let options = DrawOptions { style, work: work.clone(), ..DrawOptions::new(camera) };
        assert_eq!(draw(&scene, &options).unwrap_err(), Error::Cancelled, "{style}");
    }
}

#[test]
fn drawings_give_back_what_they_take() {
    let scene = soup(60, 1);
    let work = Work::with_budget(16 << 20, "the budget");
    for &style in DrawStyle::ALL {
        let of = |work: &Work| DrawOptions {
            style,
            work: work.clone(),
            ..DrawOptions::new(within(work).camera)
        };
        let free = draw(&scene, &of(&Work::default())).expect("drawing");
        assert_eq!(draw(&scene, &of(&work)).expect("drawing"), free, "{style}");
        assert_eq!(work.used(), 0, "{style}");
        let tight = Work::with_budget(4000, "the budget");
        let error = draw(&scene, &of(&tight)).unwrap_err();
        assert!(stage(&error).starts_with("faces "), "{style}: {error}");
    }
}

#[test]
fn a_canvas_notes_as_much_as_fits() {
    let work = Work::with_budget(1 << 20, "the budget");
    let mut canvas = Canvas::new(100, 100, Options::default()).unwrap();
    canvas.set_work(&work);
    let (paint, stroke) =
        (Paint::Color([9, 9, 9, 255]), Stroke { width: 3.0, ..Stroke::default() });
    let circle = durer::curve::Path::circle(durer::math::DVec2::splat(50.0), 40.0);
    let mut target = Pixels::new(100, 100, [0; 4]);
    canvas.stroke(&circle, &stroke, &paint, 1.0).unwrap();
    canvas.render(&mut target).unwrap();
    let ended = (0..1_000_000).find_map(|_| canvas.stroke(&circle, &stroke, &paint, 1.0).err());
    assert_eq!(stage(&ended.unwrap()), "outlines of what is painted");
    assert_eq!(stage(&canvas.render(&mut target).unwrap_err()), "outlines of what is painted");
    assert!(work.used() <= 1 << 20);
    drop(canvas);
    assert_eq!(work.used(), 0);
}

/// Returns options for strokes with round caps, whose outlines have many points.
fn dashed(dashes: &[f64]) -> Stroke {
    Stroke { width: 30.0, cap: Cap::Round, dashes: dashes.to_vec(), ..Stroke::default() }
}

#[test]
fn many_dashes_are_the_same_in_parts_and_end_where_they_do_not_fit() {
    let line = Path::polyline([(5.0, 40.0), (95.0, 40.0)].map(DVec2::from));
    let paint = Paint::Color([9, 9, 9, 255]);
    let picture = |work: &Work, dashes: &[f64]| {
        let mut canvas = Canvas::new(100, 80, Options::default()).unwrap();
        canvas.set_work(work);
        canvas.stroke(&line, &dashed(dashes), &paint, 1.0)?;
        let mut target = Pixels::new(100, 80, [0; 4]);
        canvas.render(&mut target).map(|()| target)
    };
    // About 8,000 dashes that overlap.
    let many = picture(&Work::default(), &[0.01, 0.001]).unwrap();
    let work = Work::with_budget(64 << 20, "the budget");
    assert_eq!(picture(&work, &[0.01, 0.001]).unwrap(), many);
    assert_eq!(work.used(), 0);
    let alpha = |x, y| many.get(x, y).unwrap()[3];
    assert_eq!([alpha(50, 40), alpha(50, 52), alpha(50, 57), alpha(50, 60)], [255, 255, 0, 0]);
    let tight = Work::with_budget(1 << 20, "the budget");
    let error = picture(&tight, &[0.01, 0.001]).unwrap_err();
    assert_eq!((stage(&error), tight.used()), ("outlines of what is painted", 0));
}

#[test]
fn strokes_of_what_reaches_far_beyond_the_picture_cost_what_is_seen() {
    let mut path = Path::new();
    path.push(PathElement::MoveTo(DVec2::ZERO));
    for _ in 0..200 {
        let [a, b] = [(1e5, 1e5), (-1e5, 1e5)].map(DVec2::from);
        path.push(PathElement::CubicTo(a, b, DVec2::ZERO));
    }
    let work = Work::with_budget(4 << 20, "the budget");
    let mut canvas = Canvas::new(100, 80, Options::default()).unwrap();
    canvas.set_work(&work);
    let (paint, stroke) =
        (Paint::Color([9, 9, 9, 255]), Stroke { width: 3.0, ..Stroke::default() });
    canvas.stroke(&path, &stroke, &paint, 1.0).unwrap();
    let mut target = Pixels::new(100, 80, [0; 4]);
    canvas.render(&mut target).unwrap();
    // Near the origin the curves leave along the diagonals.
    let alpha = |x, y| target.get(x, y).unwrap()[3];
    assert_eq!([alpha(20, 20), alpha(60, 60), alpha(60, 20), alpha(20, 60)], [255, 255, 0, 0]);
}

#[test]
fn closed_paths_with_parts_far_away_keep_their_corners() {
    let p = |x: f64, y: f64| DVec2::new(x, y);
    let (paint, width) = (Paint::Color([9, 9, 9, 255]), 10.0);
    let stroke = Stroke { width, ..Stroke::default() };
    let picture = |far: f64| {
        let mut path = Path::new();
        // The stroke begins and ends in the picture.
        path.push(PathElement::MoveTo(p(40.0, 40.0)));
        path.push(PathElement::LineTo(p(90.0, 40.0)));
        path.push(PathElement::LineTo(p(far, 50.0)));
        path.push(PathElement::LineTo(p(far, far)));
        path.push(PathElement::LineTo(p(40.0, far)));
        path.push(PathElement::Close);
        let mut canvas = Canvas::new(80, 80, Options::default()).unwrap();
        canvas.stroke(&path, &stroke, &paint, 1.0).unwrap();
        let mut target = Pixels::new(80, 80, [0; 4]);
        canvas.render(&mut target).unwrap();
        target
    };
    let (near, far) = (picture(200.0), picture(2e6));
    assert_eq!(near.get(36, 36).unwrap()[3], 255);
    assert_eq!(near, far);
}

#[test]
fn overlays_and_buffers_refuse_crossings_that_do_not_fit() {
    let mut seed = 7_u64;
    let mut next = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 40) as f64
    };
    let ring: Vec<DVec2> = (0..400).map(|_| DVec2::new(next(), next())).collect();
    let ring = Shapes::from_rings([ring]);
    let over = |bytes: u64| {
        let work = Work::with_budget(bytes, "the budget");
        let options = overlay::Options { work: work.clone(), ..Default::default() };
        let none = Shapes::new();
        let made = overlay::overlay(&ring, &none, BooleanOp::Union, &options, &mut NoTrace);
        assert_eq!(work.used(), 0);
        made.map(|made| made.shapes)
    };
    let free = over(u64::MAX).unwrap();
    assert!(free.points().len() > 10_000);
    assert_eq!(over(1 << 30).unwrap(), free);
    for (bytes, expected) in
        [(10_000, "edges of the overlay"), (1 << 20, "crossings of the overlay")]
    {
        assert_eq!(stage(&over(bytes).unwrap_err()), expected);
    }
    let work = Work::with_budget(1 << 20, "the budget");
    let options = buffer::Options { distance: 1e5, work, ..Default::default() };
    let error = buffer::of_polygons(&ring, WindingRule::EvenOdd, &options).unwrap_err();
    assert!(stage(&error).contains("of the overlay"), "{error}");
}

#[test]
fn layers_of_groups_and_clips_are_refused_where_they_do_not_fit() {
    for clips in [false, true] {
        let work = Work::with_budget(1 << 20, "the budget");
        let mut canvas = Canvas::new(200, 64, Options::default()).unwrap();
        canvas.set_work(&work);
        let circle = Path::circle(DVec2::new(100.0, 32.0), 40.0);
        let paint = Paint::Color([9, 9, 9, 255]);
        for _ in 0..200 {
            if clips { canvas.push_clip(&circle, FillRule::NonZero) } else { canvas.push_group() }
        }
        canvas.fill(&circle, FillRule::NonZero, &paint, 1.0);
        let mut target = Pixels::new(200, 64, [0; 4]);
        let error = canvas.render(&mut target).unwrap_err();
        assert_eq!(stage(&error), "layers of groups and clip paths");
        drop(canvas);
        assert_eq!(work.used(), 0);
    }
}

#[test]
fn planes_hold_their_charge_wherever_they_go() {
    let work = Work::with_budget(1000, "the budget");
    let mut planes = Framebuffer::within(&work, 10, 10).unwrap();
    planes.add_planes(&work, true, false, false).unwrap();
    assert_eq!(work.used(), 800);
    assert_eq!(
        stage(&planes.add_planes(&work, false, true, false).unwrap_err()),
        "planes of the picture"
    );
    assert_eq!(planes.clone(), planes);
    let color = planes.color;
    drop(planes.depth);
    assert_eq!(work.used(), 400);
    drop(color);
    assert_eq!(work.used(), 0);
}
