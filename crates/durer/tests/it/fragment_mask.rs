//! Clipping per pixel: masks with holes give the same as polygon clipping.

use durer::curve::{Path, flatten};
use durer::fragment::{Fragment, FragmentState, Outcome, PixelMask, Scissor, apply, apply_within};
use durer::math::{DVec2, Vec4};
use durer::raster::coverage::FillRule;
use durer::raster::triangle::{Options, SnappedTriangle, TriangleRasterizer};
use durer::target::Framebuffer;
use durer::view::window::PixelRect;

const SIDE: u32 = 70;

fn fragment(x: u32, y: u32) -> Fragment {
    Fragment {
        x,
        y,
        depth: 0.5,
        color: Vec4::new(1.0, 0.0, 0.0, 1.0),
        index: 0.0,
        front_facing: true,
        item: 3,
        normal: [0.0; 3],
    }
}

fn state() -> FragmentState {
    FragmentState { depth: None, ..FragmentState::default() }
}

/// Draws a triangle larger than the picture, limited to the pixels that the mask allows.
fn draw(mut put: impl FnMut(Fragment, &mut Framebuffer)) -> Framebuffer {
    let mut target = Framebuffer::new(SIDE, SIDE);
    let corners = [DVec2::new(-90.0, 200.0), DVec2::new(31.0, -80.0), DVec2::new(160.0, 130.0)];
    let triangle = SnappedTriangle::snap(corners).expect("triangle");
    let options = Options { clip: PixelRect::new(0, 0, SIDE as i32, SIDE as i32).expect("window") };
    TriangleRasterizer::EdgeWalking.rasterize(&triangle, &options, |s| {
        (s.x0..s.x1).for_each(|x| put(fragment(x as u32, s.y as u32), &mut target));
    });
    target
}

fn ring(x: f64, y: f64, width: f64, height: f64) -> Path {
    Path::rectangle(x, y, width, height)
}

#[test]
fn a_rectangular_mask_is_the_scissor() {
    let mask = PixelMask::of_contours(
        &flatten(&ring(10.0, 5.0, 40.0, 60.0), 0.1),
        FillRule::EvenOdd,
        SIDE,
        SIDE,
    )
    .expect("mask");
    let scissor = Scissor { x0: 10, y0: 5, x1: 50, y1: 65 };
    let by_scissor = FragmentState { scissor: Some(scissor), ..state() };
    let a = draw(|f, t| {
        apply_within(&mask, &state(), f, t);
    });
    let b = draw(|f, t| {
        apply(&by_scissor, f, t);
    });
    assert!(a == b && a.color.data().iter().filter(|c| c[3] > 0).count() > 1000);
}

#[test]
fn holes_of_a_mask_stay_as_they_were() {
    let mut path = ring(4.0, 4.0, 62.0, 62.0);
    path.extend(&Path::circle(DVec2::splat(35.0), 20.0));
    path.extend(&ring(28.0, 28.0, 14.0, 14.0));
    let mask =
        PixelMask::of_contours(&flatten(&path, 0.05), FillRule::EvenOdd, SIDE, SIDE).expect("mask");
    let masked = draw(|f, t| {
        apply_within(&mask, &state(), f, t);
    });
    let whole = draw(|f, t| {
        apply(&state(), f, t);
    });
    let mut counts = [0; 3];
    for (x, y) in (0..SIDE).flat_map(|y| (0..SIDE).map(move |x| (x, y))) {
        let p = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
        let within =
            |lo: f64, hi: f64| p.cmpgt(DVec2::splat(lo)).all() && p.cmplt(DVec2::splat(hi)).all();
        let island = within(28.0, 42.0);
        let from_circle = (p - DVec2::splat(35.0)).length() - 20.0;
        if from_circle.abs() < 0.1 {
            continue;
        }
        let inside = within(4.0, 66.0) && (from_circle > 0.0 || island);
        assert_eq!(mask.contains(x, y), inside, "{x} {y}");
        counts[usize::from(inside) + usize::from(island)] += 1;
        let expected = if inside { whole.color.get(x, y) } else { Some([0; 4]) };
        assert_eq!(masked.color.get(x, y), expected, "{x} {y}");
    }
    assert!(counts.iter().all(|&c| c > 100), "{counts:?}");
}

#[test]
fn nothing_is_drawn_outside_a_mask_of_any_size() {
    for (width, height) in [(0, 0), (1, 1), (64, 2), (65, 3), (63, 1)] {
        let mut mask = PixelMask::empty(width, height).expect("mask");
        assert!(!mask.contains(0, 0));
        for (x, y) in (0..height + 2).flat_map(|y| (0..width + 70).map(move |x| (x, y))) {
            mask.set(x, y, true);
            assert_eq!(mask.contains(x, y), x < width && y < height, "{x} {y} of {width}x{height}");
        }
        mask.set(0, 0, false);
        let mut target = Framebuffer::new(80, 80);
        assert_eq!(apply_within(&mask, &state(), fragment(0, 0), &mut target), Outcome::Scissor);
    }
    assert!(PixelMask::empty(u32::MAX, 3).is_err());
}
