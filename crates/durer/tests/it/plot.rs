//! Plots on paper: numbers, titles and the colour bar have room.

use durer::math::{DVec2, Rect};
use durer::plot::{ColorMap, Options, Plot, surface};
use durer::scene::HeightField;
use durer::target::drawing::TextAnchor;
use durer::target::sheet::PaperMark;
use durer::view::projection::ViewDirection;

fn plot(x: [f64; 2], z: [f64; 2], f: impl Fn(f64, f64) -> f64, options: &Options) -> Plot {
    let field = HeightField::from_fn([21, 21], x, z, f).expect("field");
    surface(&field, options).expect("plot")
}

/// Returns all texts with their boxes on the page, assuming letters 0.6 as wide as high.
fn texts(plot: &Plot) -> Vec<(String, Rect)> {
    let marks = plot.clone().into_sheet().layers.into_iter().flat_map(|layer| layer.marks);
    let boxed = |mark: PaperMark| {
        let PaperMark::Text { at, text, height, anchor, .. } = mark else { return None };
        let width = text.chars().count() as f64 * height * 0.6;
        let left = match anchor {
            TextAnchor::Start => 0.0,
            TextAnchor::Middle => width * 0.5,
            TextAnchor::End => width,
        };
        let low = at - DVec2::new(left, height);
        Some((text, Rect::new(low, low + DVec2::new(width, height)).ok()?))
    };
    marks.filter_map(boxed).collect()
}

#[test]
fn texts_keep_apart_and_on_the_page() {
    let long = "A title that is much too long for one line of a page that is a hundred and eighty millimetres wide";
    let ranges = [[-4.0, 4.0], [0.0, 1.0], [-123_456.5, 987_654.5], [1e9, 1e9 + 1.0], [0.0, 1e-9]];
    for x in ranges {
        for (azimuth, elevation) in [(30.0, 30.0), (200.0, 10.0), (-75.0, 60.0), (0.0, 5.0)] {
            let up = durer::scene::UpAxis::Y;
            let options = Options {
                direction: ViewDirection::from_angles(azimuth, elevation, up).expect("direction"),
                color_map: Some(ColorMap::ALL[0]),
                title: long.to_owned(),
                aspect: Some(1.0),
                exaggeration: 0.3 * (x[1] - x[0]),
                ..Options::default()
            };
            let plot = plot(x, [0.0, 3.0], |_, z| z.sin(), &options);
            let texts = texts(&plot);
            assert!(texts.len() > 6, "{texts:?}");
            for (i, (text, own)) in texts.iter().enumerate() {
                let inside =
                    own.min().cmpge(DVec2::ZERO).all() && own.max().cmple(options.page).all();
                assert!(inside, "{x:?}, {azimuth}: `{text}` leaves the page");
                for (other, its) in &texts[..i] {
                    assert!(
                        !own.overlaps(its),
                        "{x:?}, {azimuth}, {elevation}: `{text}` on `{other}`"
                    );
                }
            }
        }
    }
}

#[test]
fn the_ground_has_the_shape_that_is_requested() {
    let top = ViewDirection::from_angles(0.0, 90.0, durer::scene::UpAxis::Y).expect("direction");
    for (aspect, wanted) in [(None, 0.2), (Some(1.0), 1.0), (Some(2.0), 2.0)] {
        let options = Options { direction: top, axes: None, aspect, ..Options::default() };
        let plot = plot([0.0, 10.0], [0.0, 2.0], |x, _| x, &options);
        let points = plot.drawing.lines.iter().flat_map(|line| line.points.iter().copied());
        let size = Rect::around(points).expect("points").size();
        assert!((size.y / size.x - wanted).abs() < 1e-9, "{aspect:?}: {size}");
    }
}

#[test]
fn level_surfaces_keep_their_upright_axis() {
    let plot = plot([0.0, 1.0], [0.0, 1.0], |_, _| 5.0, &Options::default());
    let texts = texts(&plot);
    assert!(texts.iter().any(|(text, _)| text == "5") && texts.iter().any(|(text, _)| text == "y"));
}

#[test]
fn a_bar_tells_the_heights_of_colors() {
    let options = Options { color_map: Some(ColorMap::ALL[0]), ..Options::default() };
    let f = |x: f64, _: f64| x;
    let count = |options: &Options| {
        let sheet = plot([0.0, 8.0], [0.0, 8.0], f, options).into_sheet();
        sheet.layers.iter().find(|layer| layer.name == "colour-bar").map(|l| l.marks.len())
    };
    assert!(count(&options).is_some_and(|marks| marks > 35));
    assert_eq!(count(&Options { color_bar: false, ..options.clone() }), None);
    assert_eq!(count(&Options { color_map: None, ..options }), None);
}
