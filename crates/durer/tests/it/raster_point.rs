//! Points: squares and discs, beside their definitions, and as commands draw them.

use crate::raster_coverage::Random;
use durer::commands::{Command, CornerVertex, DisplayLists, Pipeline, Primitive, execute};
use durer::fragment::{Blend, FragmentState, Scissor};
use durer::math::{DVec2, DVec3, IVec2, Vec4};
use durer::raster::point::{MAX_SIZE, Options, Step, draw, replay};
use durer::target::Framebuffer;
use durer::trace::{NoTrace, PseudocodeLine, Recorder};
use durer::view::window::PixelRect;

fn pixels(center: DVec2, options: &Options) -> Vec<(IVec2, f64)> {
    let mut pixels = Vec::new();
    draw(center, options, |pixel, area| pixels.push((pixel, area)), &mut NoTrace);
    pixels
}

fn corner((pixel, _): &(IVec2, f64)) -> DVec2 {
    pixel.as_dvec2()
}

#[test]
fn steps_lead_to_the_pixels_and_change_nothing() {
    let mut random = Random(5);
    for k in 0..400 {
        let center = random.point(-9.0, 9.0);
        let size = random.point(0.0, 7.0).x;
        let window = (k % 3 == 0).then(|| PixelRect::new(-4, -3, 5, 6).unwrap());
        let options = Options { size, smooth: k % 2 == 0, window };
        let (mut steps, mut plotted) = (Recorder::default(), Vec::new());
        draw(center, &options, |pixel, area| plotted.push((pixel, area)), &mut steps);
        assert_eq!(plotted, pixels(center, &options));
        assert_eq!(plotted, replay(steps.steps()));
    }
}

/// No block of n · n whole pixels has its centre nearer to the point.
#[test]
fn a_square_is_the_nearest_block_of_pixels() {
    let mut random = Random(6);
    for side in 1..=6 {
        for _ in 0..100 {
            let center = random.point(-5.0, 5.0);
            let size = f64::from(side) + 0.98 * random.point(-0.5, 0.5).x;
            let lit = pixels(center, &Options { size, ..Options::default() });
            assert_eq!(lit.len(), (side * side) as usize, "{size}");
            let (first, last) = (corner(&lit[0]), corner(&lit[lit.len() - 1]) + 1.0);
            assert_eq!(last - first, DVec2::splat(side.into()));
            let off = (first + last) / 2.0 - center;
            assert!(off.abs().max_element() <= 0.5, "{center} {size}: {off}");
        }
    }
    // A pixel owns its side with the smaller coordinate.
    let one = |x, y| pixels(DVec2::new(x, y), &Options::default())[0].0;
    assert_eq!([one(4.0, 1.5), one(-0.25, -1.0)], [IVec2::new(4, 1), IVec2::new(-1, -1)]);
}

/// Compares areas with the share of 200 × 200 places in the pixel.
#[test]
fn areas_of_discs_are_those_of_their_definition() {
    let mut random = Random(7);
    for _ in 0..12 {
        let center = random.point(-2.0, 2.0);
        let size = random.point(0.3, 4.0).x;
        for (pixel, area) in pixels(center, &Options { size, smooth: true, window: None }) {
            let places = (0..40_000_u32).map(|k| {
                let place = DVec2::new((k % 200).into(), (k / 200).into()) + 0.5;
                pixel.as_dvec2() + place / 200.0
            });
            let within = places.filter(|p| p.distance(center) <= size / 2.0).count();
            let share = within as f64 / 40_000.0;
            assert!((share - area).abs() < 2e-3, "{center} {size} {pixel}: {area} {share}");
        }
    }
}

#[test]
fn the_worked_example_of_the_page() {
    let columns = |size: f64| {
        let lit = pixels(DVec2::new(3.3, 3.7), &Options { size, ..Options::default() });
        (lit[0].0, lit[lit.len() - 1].0)
    };
    assert_eq!(columns(3.0), (IVec2::splat(2), IVec2::splat(4)));
    assert_eq!(columns(4.0), (IVec2::new(1, 2), IVec2::new(4, 5)));
    let disc = |at: f64| {
        let areas = pixels(DVec2::splat(at), &Options { size: 2.0, smooth: true, window: None });
        areas.iter().map(|(_, area)| (area * 1e4).round() / 1e4).collect::<Vec<_>>()
    };
    let quarter = (std::f64::consts::FRAC_PI_4 * 1e4).round() / 1e4;
    assert_eq!(disc(2.0), [quarter; 4]);
    let (corner, side) = (0.0788, 0.4566);
    assert_eq!(disc(2.5), [corner, side, corner, side, 1.0, side, corner, side, corner]);
    let window = Some(PixelRect::new(2, 2, 10, 8).unwrap());
    let options = Options { size: 3.0, smooth: false, window };
    let inside = pixels(DVec2::new(9.7, 4.2), &options);
    assert_eq!((inside.len(), inside[2].0), (9, IVec2::new(10, 3)));
    assert!(pixels(DVec2::new(1.8, 6.4), &options).is_empty());
    // The borders are inside; the last pixel owns the one at which the window ends.
    let one = Options { size: 1.0, ..options };
    assert_eq!(pixels(DVec2::new(10.0, 2.0), &one), [(IVec2::new(9, 2), 1.0)]);
}

#[test]
fn strange_points_light_nothing_or_end() {
    for x in [f64::NAN, f64::INFINITY, -1e300, 1e18, 2_147_483_647.0] {
        for size in [f64::NAN, -1.0, 0.0, 1e300, f64::INFINITY, 3.0] {
            for smooth in [false, true] {
                let mut steps = Recorder::default();
                let options = Options { size, smooth, window: None };
                draw(DVec2::new(x, 0.5), &options, |_, _| {}, &mut steps);
                assert!(steps.steps().iter().all(|step| (1..=8).contains(&step.line())));
                let outside = matches!(steps.steps().first(), Some(Step::Outside));
                assert_eq!(outside, !x.is_finite());
            }
        }
    }
}

const SIDE: u32 = 8;

/// Draws points of normalized device coordinates on a black picture, or returns the error.
fn drawn(commands: &[Command], at: &[(f64, f64)]) -> durer::Result<Framebuffer> {
    let mut target = Framebuffer::new(SIDE, SIDE);
    let black = Command::Clear {
        color: Some(Vec4::new(0.0, 0.0, 0.0, 1.0)),
        depth: None,
        stencil: None,
        index: None,
    };
    let vertex = |&(x, y): &(f64, f64)| CornerVertex::from(DVec3::new(x, y, 0.0));
    let draw = Command::Draw(Primitive::Points, at.iter().map(vertex).collect());
    let all: Vec<Command> = [black].into_iter().chain(commands.to_vec()).chain([draw]).collect();
    execute(&all, &DisplayLists::default(), &mut Pipeline::default(), &mut target)?;
    Ok(target)
}

fn lit(target: &Framebuffer) -> Vec<(u32, u32)> {
    let all = (0..SIDE).flat_map(|y| (0..SIDE).map(move |x| (x, y)));
    all.filter(|&(x, y)| target.color.get(x, y) != Some([0, 0, 0, 255])).collect()
}

#[test]
fn commands_draw_points_of_a_size() {
    // At first a pixel; the right and the lower border belong to the last ones.
    let one = drawn(&[], &[(0.0, 0.0), (1.0, -1.0)]).unwrap();
    assert_eq!(lit(&one), [(4, 4), (7, 7)]);
    let two = drawn(&[Command::PointSize(2.0)], &[(0.0, 0.0)]).unwrap();
    assert_eq!(lit(&two), [(3, 3), (4, 3), (3, 4), (4, 4)]);
    // The centre decides: a point beside the picture is left out, one in it reaches beyond its viewport.
    let size = Command::PointSize(3.0);
    let beside = drawn(std::slice::from_ref(&size), &[(-1.01, 0.0)]).unwrap();
    assert_eq!(lit(&beside), []);
    let viewport = Command::Viewport(Some([2, 2, 2, 2]));
    let beyond = drawn(&[viewport, size], &[(0.9, 0.0)]).unwrap();
    assert_eq!(lit(&beyond).len(), 9);
    assert!(lit(&beyond).contains(&(4, 3)));
    for size in [0.0, -1.0, f64::NAN, MAX_SIZE + 1.0] {
        let error = drawn(&[Command::PointSize(size)], &[]).unwrap_err().to_string();
        assert!(error.contains("point size") && error.contains("256"), "{error}");
    }
}

#[test]
fn smooth_points_are_blended_by_their_coverage() {
    let over = FragmentState { blend: Some(Blend::Over), depth: None, ..FragmentState::default() };
    let commands = [
        Command::PointSmooth(true),
        Command::PointSize(2.0),
        Command::Color(Vec4::new(1.0, 1.0, 1.0, 0.5)),
        Command::Fragments(over),
    ];
    let target = drawn(&commands, &[(0.0, 0.0)]).unwrap();
    assert_eq!(lit(&target), [(3, 3), (4, 3), (3, 4), (4, 4)]);
    // Half of π/4 of white light over black: 0.3927 is 168 of 255 in sRGB.
    assert_eq!(target.color.get(3, 3), Some([168, 168, 168, 255]));
    let scissor = Some(Scissor { x0: 4, y0: 0, x1: SIDE, y1: SIDE });
    let cut = Command::Fragments(FragmentState { scissor, ..over });
    let target = drawn(&[commands.to_vec(), vec![cut]].concat(), &[(0.0, 0.0)]).unwrap();
    assert_eq!(lit(&target), [(4, 3), (4, 4)]);
}
