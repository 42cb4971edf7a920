//! Windows, viewports, layouts.

use durer::math::DVec2;
use durer::trace::Recorder;
use durer::view::layout::{self, Layout};
use durer::view::window::*;
use proptest::prelude::*;

fn ulp(x: f64) -> f64 {
    let x = x.abs();
    f64::from_bits(x.to_bits() + 1) - x
}

fn windows() -> impl Strategy<Value = Window> {
    let start = prop_oneof![-1.0..1.0f64, -1e3..1e3f64, -1e9..1e9f64, Just(0.0)];
    let extent = prop_oneof![1e-3..1.0f64, 1.0..1e4f64, 1e4..1e9f64];
    (start.clone(), extent.clone(), start, extent)
        .prop_map(|(x, w, y, h)| Window::new(x, x + w, y, y + h).unwrap())
}

fn viewports() -> impl Strategy<Value = Viewport> {
    (-5000..5000i32, -5000..5000i32, 1..16_000i32, 1..16_000i32).prop_map(|(x, y, w, h)| {
        Viewport::new(PixelRect::new(x, y, x + w, y + h).unwrap()).unwrap()
    })
}

fn aspects() -> impl Strategy<Value = (Aspect, YAxis)> {
    let aspect = prop_oneof![Just(Aspect::Stretch), Just(Aspect::Fit), Just(Aspect::Fill)];
    (aspect, prop_oneof![Just(YAxis::Down), Just(YAxis::Up)])
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(5000))]

    #[test]
    fn corners_map_to_corners(window in windows(), viewport in viewports(), (_, y_axis) in aspects()) {
        let map = WindowToViewport::new(&window, &viewport, Aspect::Stretch, y_axis);
        let (r, p) = (window.rect(), viewport.pixels());
        let (bottom, top) = match y_axis {
            YAxis::Down => (p.y1(), p.y0()),
            YAxis::Up => (p.y0(), p.y1()),
        };
        prop_assert_eq!(map.to_screen(r.min()), DVec2::new(p.x0().into(), bottom.into()));
        prop_assert_eq!(map.to_screen(r.max()), DVec2::new(p.x1().into(), top.into()));
        prop_assert_eq!(map.to_world(DVec2::new(p.x0().into(), bottom.into())), r.min());
        prop_assert_eq!(map.to_world(DVec2::new(p.x1().into(), top.into())), r.max());
    }

    /// One ulp of the extent, or of the coordinates if the screen's are too coarse.
    #[test]
    fn there_and_back_is_the_identity(
        window in windows(), viewport in viewports(), (aspect, y_axis) in aspects(),
        u in 0.0..=1.0f64, v in 0.0..=1.0f64,
    ) {
        let map = WindowToViewport::new(&window, &viewport, aspect, y_axis);
        let (r, p) = (window.rect(), viewport.pixels());
        let at = (r.min() + r.size() * DVec2::new(u, v)).clamp(r.min(), r.max());
        let screen = map.to_screen(at);
        let back = map.to_world(screen);
        let [a, _, c, _] = map.coefficients();
        for (k, scale) in [(0, a), (1, c)] {
            let extent = r.size()[k].max(at[k].abs());
            // Half an ulp of the screen coordinate, carried back to the world.
            let coarse = 0.5 * ulp(screen[k]) / scale.abs();
            let bound = ulp(extent).max(coarse + 0.5 * ulp(at[k]));
            prop_assert!((back[k] - at[k]).abs() <= bound, "{k}: {} {} {bound:e} {p:?}", at[k], back[k]);
        }
    }

    #[test]
    fn viewport_from_the_origin_returns_within_one_ulp_of_the_extent(
        left in -1.0..1.0f64, width in 0.5..2.0f64, u in 0.0..=1.0f64, side in 1..5000u32,
    ) {
        let window = Window::new(left, left + width, 0.0, 1.0).unwrap();
        let viewport = Viewport::new(PixelRect::of_size(side, 7).unwrap()).unwrap();
        let map = WindowToViewport::new(&window, &viewport, Aspect::Stretch, YAxis::Down);
        let x = left + (window.rect().max().x - left) * u;
        let back = map.to_world(map.to_screen(DVec2::new(x, 0.5))).x;
        prop_assert!((back - x).abs() <= ulp(window.rect().size().x), "{} {}", x, back);
    }

    #[test]
    fn fit_shows_all_and_fill_covers_all(window in windows(), viewport in viewports()) {
        let (r, p) = (window.rect(), viewport.pixels());
        let size = DVec2::new(p.width().into(), p.height().into());
        let image = |aspect| {
            let map = WindowToViewport::new(&window, &viewport, aspect, YAxis::Up);
            let [a, _, c, _] = map.coefficients();
            assert_eq!(a, c);
            let middle = (map.to_screen(r.min()) + map.to_screen(r.max())) * 0.5;
            let center = DVec2::new(p.x0().into(), p.y0().into()) + size * 0.5;
            assert!((middle - center).length() <= 1e-9 * (1.0 + (r.size() * a).length()));
            map.to_screen(r.max()) - map.to_screen(r.min())
        };
        let tolerance = 1e-9 * size;
        let (fit, fill) = (image(Aspect::Fit), image(Aspect::Fill));
        prop_assert!((fit - tolerance).cmple(size).all() && (fit + tolerance).cmpge(size).any());
        prop_assert!((fill + tolerance).cmpge(size).all() && (fill - tolerance).cmple(size).any());
    }

    #[test]
    fn layouts_tile_the_screen(
        columns in 1..7usize, rows in 1..7usize, missing in 0..6usize, w in 50..90u32, h in 50..90u32,
    ) {
        let count = columns * rows - missing.min(columns - 1);
        let grid = Layout::new(columns, rows, vec!["iso".into(); count]).unwrap();
        let cells = grid.viewports(w, h).unwrap();
        prop_assert_eq!(cells.len(), count);
        let mut steps = Recorder::default();
        prop_assert_eq!(&grid.viewports_traced(w, h, &mut steps).unwrap(), &cells);
        let pixels: Vec<PixelRect> = cells.iter().map(|(_, v)| *v.pixels()).collect();
        prop_assert_eq!(layout::replay(steps.steps()), pixels);
        for y in 0..h as i32 {
            for x in 0..w as i32 {
                let owners = cells.iter().filter(|(_, v)| v.pixels().contains(x, y)).count();
                prop_assert_eq!(owners, 1);
            }
        }
        for (i, (_, a)) in cells.iter().enumerate() {
            let overlaps = |(_, b): &(&str, Viewport)| !a.pixels().intersection(b.pixels()).is_empty();
            prop_assert!(!cells[i + 1..].iter().any(overlaps));
        }
    }
}

#[test]
fn wrong_windows_are_errors() {
    let bad = [
        [0.0, 0.0, 0.0, 1.0],
        [1.0, 0.0, 0.0, 1.0],
        [0.0, 1.0, 2.0, 1.0],
        [f64::NAN, 1.0, 0.0, 1.0],
        [0.0, f64::INFINITY, 0.0, 1.0],
        [0.0, 1.0, f64::NEG_INFINITY, 1.0],
        [-1e308, 1e308, 0.0, 1.0],
        [0.0, 1e-310, 0.0, 1.0],
    ];
    for [l, r, b, t] in bad {
        let error = Window::new(l, r, b, t).unwrap_err();
        assert!(matches!(error, durer::Error::Parameter { name: "window", .. }), "{error}");
    }
    assert!(Window::new(-1e100, 1e100, 0.0, 1.001e-100).is_ok());
    assert!(Viewport::new(PixelRect::of_size(0, 9).unwrap()).is_err());
    assert!(PixelRect::new(3, 0, 2, 9).is_err());
    assert!(PixelRect::of_size(u32::MAX, 1).is_err());
}

#[test]
fn extreme_windows_map_without_nan() {
    let huge = Window::new(-1e100, 1e100, 0.0, 1e-99).unwrap();
    let viewport = Viewport::new(PixelRect::EVERYTHING).unwrap();
    for aspect in [Aspect::Stretch, Aspect::Fit, Aspect::Fill] {
        let map = WindowToViewport::new(&huge, &viewport, aspect, YAxis::Down);
        assert!(map.to_screen(DVec2::new(3.0, 5e-100)).is_finite());
        assert!(map.to_world(DVec2::ZERO).is_finite());
    }
}

#[test]
fn layouts_are_parsed() {
    let parse = |s: &str| s.parse::<Layout>();
    let sizes = |s: &str| -> Vec<(u32, u32)> {
        let layout = parse(s).unwrap();
        let cells = layout.viewports(60, 60).unwrap();
        cells.iter().map(|(_, v)| (v.pixels().width(), v.pixels().height())).collect()
    };
    assert_eq!(sizes("front,top,side,iso"), [(30, 30); 4]);
    assert_eq!(sizes("iso"), [(60, 60)]);
    assert_eq!(sizes("3x1:front,side,top"), [(20, 60); 3]);
    assert_eq!(sizes("1x3: front, side, top"), [(60, 20); 3]);
    assert_eq!(sizes("a,b,c"), [(30, 30), (30, 30), (60, 30)]);
    assert_eq!(parse("2x2:front,top,side,iso").unwrap().names()[2], "side");
    for bad in
        ["", ",", "a,,b", "2x2:a", "2x2:a,b,c,d,e", "0x2:a", "x:a", "2:a", "9999999x9999999:a"]
    {
        assert!(parse(bad).is_err(), "{bad}");
    }
    assert!(parse("a,b").unwrap().viewports(1, 9).is_err());
}
