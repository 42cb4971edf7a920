//! Any bytes become a scene that is cut, broken, marked, annotated and written to every kind of drawing, and a set of
//! lines that are fitted, simplified, tiled and dashed: the bodies of the fuzz targets `sheet`, `marks`, `curves`
//! and `maps`, which the tests call as well.

use super::surfaces::{Bytes, camera, scene};
use durer::annotate::{
    self, Along, Annotations, FeaturePlace, Request, Shown, Thread, ViewSide, What,
};
use durer::clip::polygon::{Shapes, WindingRule};
use durer::clip::simplify::LineSimplifier;
use durer::clip::simplify::coverage::{self, Coverage};
use durer::clip::tiles::{Options as TileOptions, Pyramid, TileBody, TileFeature};
use durer::curve::b_spline::Nurbs;
use durer::curve::fit::{Options as FitOptions, Polyline, fit};
use durer::curve::pieces;
use durer::math::{DVec2, DVec3, Plane};
use durer::paper::{self, Breaks, Hidden, LaidOut, Options as PaperOptions, dashes};
use durer::pipeline::{DrawOptions, DrawStyle, ToneMarks, draw, tone_marks};
use durer::scene::{Camera, Projection, Scene};
use durer::trace::NoTrace;
use durer::view::{explode, section};
use durer::visibility::object::{Faces, Weld};
use durer_formats::drawing::{DrawingFormat, FileOptions, write};

/// The last level of tiles.
const LAST: u8 = 3;

fn number(bytes: &mut Bytes<'_>) -> f64 {
    const ODD: [f64; 8] = [0.0, 1e30, -1e30, 1e-30, f64::NAN, f64::INFINITY, 0.25, -1.0];
    match bytes.next() {
        n @ 0..8 => ODD[usize::from(n)],
        n => (f64::from(n) - 128.0) / 64.0,
    }
}

fn point(bytes: &mut Bytes<'_>) -> DVec2 {
    DVec2::new(number(bytes), number(bytes))
}

fn place(bytes: &mut Bytes<'_>) -> FeaturePlace {
    match bytes.next() % 3 {
        0 => FeaturePlace::Feature(format!("hole {}", bytes.next() % 3)),
        _ => FeaturePlace::Point(DVec3::new(number(bytes), number(bytes), number(bytes))),
    }
}

fn request(bytes: &mut Bytes<'_>) -> Request {
    let what = match bytes.next() % 5 {
        0 => What::Diameter("boss 1".to_owned()),
        1 => What::Angle { vertex: place(bytes), from: place(bytes), to: place(bytes) },
        2 => What::Note(place(bytes)),
        n => {
            let along = [Along::Straight, Along::X, Along::Y, Along::Z][usize::from(n) % 4];
            What::Linear { from: place(bytes), to: place(bytes), along }
        }
    };
    let sides = [
        None,
        Some(ViewSide::Above),
        Some(ViewSide::Below),
        Some(ViewSide::Left),
        Some(ViewSide::Right),
    ];
    let texts =
        [None, Some("<>".to_owned()), Some("a\n\u{202e}<>\0".to_owned()), Some(String::new())];
    let (side, text) = (bytes.next() % 5, bytes.next() % 4);
    Request {
        what,
        view: None,
        side: sides[usize::from(side)],
        text: texts[usize::from(text)].clone(),
    }
}

fn annotations(bytes: &mut Bytes<'_>) -> Annotations {
    let flags = bytes.next();
    let dimensions = (0..bytes.next() % 4).map(|_| request(bytes)).collect();
    let size = format!("M{}", bytes.next() % 70).parse().ok();
    let threads = vec![Thread { name: "hole 1".to_owned(), size }];
    Annotations {
        center_lines: flags & 1 != 0,
        sizes: flags & 2 != 0,
        holes: flags & 4 != 0,
        bosses: flags & 8 != 0,
        dimensions,
        threads: if flags & 48 == 48 { threads } else { Vec::new() },
    }
}

/// Returns a scene, perhaps cut and pulled apart.
fn model(bytes: &mut Bytes<'_>) -> Scene {
    let mut scene = scene(bytes);
    if bytes.next().is_multiple_of(2) {
        let normal = DVec3::new(number(bytes), number(bytes), number(bytes));
        let plane = Plane { normal: normal.normalize_or(DVec3::X), distance: number(bytes) };
        if let Ok(cut) = section::cut(&scene, &[plane], &section::Options::default()) {
            scene = cut.scene;
        }
    }
    scene
}

fn parallel(camera: Camera) -> Camera {
    Camera { projection: Projection::Orthographic { height: 3.0 }, ..camera }
}

fn laid(bytes: &mut Bytes<'_>) -> Option<(LaidOut, durer::target::drawing::Drawing)> {
    let camera = parallel(camera(bytes));
    let scene = model(bytes);
    let bounds = scene.bounds()?;
    let mut options = DrawOptions::new(camera);
    options.style = DrawStyle::ALL[usize::from(bytes.next()) % DrawStyle::ALL.len()];
    let drawing = draw(&scene, &options).ok()?;
    let text = format!(
        "{}:{},{}",
        ["x", "y", "z"][usize::from(bytes.next()) % 3],
        number(bytes),
        number(bytes)
    );
    let breaks = text.parse().ok().and_then(|b| Breaks::new(&[b], bounds, &[camera]).ok());
    let view = breaks.unwrap_or_default().seen_by(&camera);
    let drawing = view.cut(drawing).ok()?;
    let hidden = [Hidden::Drop, Hidden::Dashed][usize::from(bytes.next()) % 2];
    let fit = f64::from(bytes.next() % 3) * 0.1;
    let page = PaperOptions { fit, hidden, fit_areas: fit > 0.0, ..PaperOptions::default() };
    let mut laid = paper::lay_out(&drawing, "a\u{1}<&", &page).ok()?;
    for placed in &mut laid.views {
        placed.camera.get_or_insert(camera);
        placed.breaks = view.clone();
    }
    let wanted = annotations(bytes);
    let features = Faces::welded(&scene, Weld::default()).map(|f| annotate::features(&scene, &f));
    let shown = Shown {
        views: &laid.views,
        drawings: &[&drawing],
        features: &features.unwrap_or_default(),
        unit: 1.0,
        hidden: hidden != Hidden::Drop,
        color: [0, 0, 0, 255],
    };
    drop(annotate::annotate(&mut laid.sheet, &wanted, &shown));
    Some((laid, drawing))
}

/// Whatever is drawn can be written, without a number that is none.
///
/// # Panics
/// Where that is not so.
pub fn sheet(data: &[u8]) {
    let Some((mut laid, drawing)) = laid(&mut Bytes(data)) else { return };
    paper::order::sheet(&mut laid.sheet);
    for &format in DrawingFormat::ALL {
        let mut out = Vec::new();
        write(&mut out, format, &laid.sheet, &drawing, &FileOptions::default()).expect("memory");
        let text = String::from_utf8_lossy(&out);
        let wrong = ["NaN", "nan ", "inf ", "-inf"].iter().find(|word| text.contains(**word));
        assert!(format == DrawingFormat::Pdf || wrong.is_none(), "{format}: {wrong:?}");
    }
    paper::paint(laid.sheet, 40, 30, [255; 4]).expect("small");
}

/// Returns the height of the picture where the target is, in units of the scene.
fn height(camera: &Camera) -> f64 {
    match camera.projection {
        Projection::Orthographic { height } => height,
        Projection::Perspective { fov_y } => {
            2.0 * libm::tan(fov_y / 2.0) * camera.eye.distance(camera.target)
        }
    }
}

/// Marks of tones are finite lines.
///
/// # Panics
/// Where that is not so.
pub fn marks(data: &[u8]) {
    let mut bytes = Bytes(data);
    let camera = camera(&mut bytes);
    let scene = model(&mut bytes);
    // Parts of what is seen, so that the picture between is small.
    let size = height(&camera) * (0.08 + f64::from(bytes.next()) / 2000.0);
    let mut options = DrawOptions::new(camera);
    options.aspect = [1.0, 1.6, 0.4][usize::from(bytes.next()) % 3];
    for how in [ToneMarks::Contours { spacing: size }, ToneMarks::Dots { diameter: size }] {
        let Ok(lines) = tone_marks(&scene, &options, how) else { continue };
        for line in lines {
            assert!(
                line.points.len() >= 2 && line.points.iter().all(|p| p.is_finite()),
                "{line:?}"
            );
        }
    }
    drop(explode::explode(&scene, explode::ExplodeDirection::Radial, None));
}

/// Up to 200 points: free, on a grid, or along a circle.
fn points(bytes: &mut Bytes<'_>) -> Vec<DVec2> {
    let (count, kind) = (usize::from(bytes.next() % 200), bytes.next() % 3);
    (0..count)
        .map(|i| match kind {
            0 => point(bytes),
            1 => DVec2::new(f64::from(bytes.next() % 8), f64::from(bytes.next() % 8)),
            _ => {
                let turn = DVec2::from_angle(i as f64 * std::f64::consts::TAU / count as f64);
                turn * (1.0 + f64::from(bytes.next() % 4) * 1e-3)
            }
        })
        .collect()
}

/// Fitted curves begin and end where the polyline does.
///
/// # Panics
/// Where that is not so.
pub fn curves(data: &[u8]) {
    let mut bytes = Bytes(data);
    let flags = bytes.next();
    let options = FitOptions { tolerance: number(&mut bytes).abs() * 0.05, round: flags & 1 != 0 };
    let points = points(&mut bytes);
    let kept: Vec<bool> = (0..points.len()).map(|_| bytes.next() == 9).collect();
    let polyline = Polyline { points: &points, closed: flags & 2 != 0, kept: &kept };
    if let Some(fitted) = fit(polyline, |_, _| flags & 4 != 0, options) {
        assert!(fitted.from.len() == fitted.curve.pieces.len());
        let around = pieces::points(&fitted.curve, 0.01);
        assert!(around.iter().all(|p| p.is_finite()), "{around:?}");
        drop((pieces::path(&fitted.curve, 0.01), pieces::at_corners(&fitted.curve, 0.5)));
    }
    let pattern: Vec<f64> = (0..bytes.next() % 4).map(|_| number(&mut bytes).abs()).collect();
    drop(dashes::cut(&points, polyline.closed, &pattern));
    let degree = usize::from(bytes.next() % 6);
    let control: Vec<(DVec2, f64)> =
        points.iter().take(12).map(|p| (*p, number(&mut bytes))).collect();
    let mut knots: Vec<f64> = (0..=control.len() + degree).map(|_| number(&mut bytes)).collect();
    knots.sort_by(f64::total_cmp);
    if let Ok(curve) = Nurbs::new(degree, &control, knots) {
        assert!(curve.point(f64::NAN).is_finite() || !curve.point(curve.domain().0).is_finite());
    }
}

/// Simplified lines keep their ends, and tiles can be made of any shapes.
///
/// # Panics
/// Where that is not so.
pub fn maps(data: &[u8]) {
    let mut bytes = Bytes(data);
    let (line, ring, tolerance) = (points(&mut bytes), points(&mut bytes), number(&mut bytes));
    for &method in LineSimplifier::ALL {
        let Ok(kept) = method.simplify(&line, tolerance) else { continue };
        assert!(kept.is_sorted() && kept.last().is_none_or(|&last| last == line.len() - 1));
        let mut both = Coverage::default();
        both.push_line(line.iter().copied());
        both.push_ring(ring.iter().copied());
        drop(both.weights(&coverage::Options { method, limit: tolerance }, &mut NoTrace));
    }
    let scaled = |all: &[DVec2]| all.iter().map(|p| *p * 0.2 + 0.5).collect::<Vec<_>>();
    let mut areas = Shapes::new();
    areas.push_ring(scaled(&ring));
    let bodies = [TileBody::Points(scaled(&line)), TileBody::Areas(areas)];
    let features = bodies.map(|body| TileFeature { layer: 0, body, fill: WindingRule::EvenOdd });
    let buffer = u32::from(bytes.next() % 64);
    let options = TileOptions { zooms: 0..=LAST, extent: 64, buffer, ..TileOptions::default() };
    let Ok(pyramid) = Pyramid::new(features.into(), options) else { return };
    for zoom in 0..=LAST {
        drop(pyramid.visit(zoom, |_, pieces| pieces.len(), |_, _| Ok::<_, durer::Error>(())));
    }
}
