//! Work within a budget: what does not fit is an error, what is stopped ends, and all memory is given back.

use crate::scenes::{options, soup};
use durer::Error;
use durer::pipeline::{
    DrawOptions, DrawStyle, RenderOptions, Shadows, SurfaceMethod, draw, render,
};
use durer::raster::line::wide::Stroke;
use durer::raster::paint::{Canvas, Options, Paint};
use durer::scene::Scene;
use durer::target::{Framebuffer, Pixels};
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
