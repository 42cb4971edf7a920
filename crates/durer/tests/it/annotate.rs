//! Annotations: their texts, measurements of the model, and clear distances.

use crate::line_scenes::{Random, Triangle, cuboid, cylinder, soup, view};
use durer::annotate::{
    Along, Annotations, FeaturePlace, Request, RoundFeature, Shown, Thread, ViewSide, What,
    annotate, features,
};
use durer::math::{DVec2, DVec3, Rect};
use durer::paper::{LaidOut, Options, dimension_strokes, lay_out};
use durer::scene::Scene;
use durer::target::CurvePiece;
use durer::target::dimension::Measure;
use durer::target::drawing::Drawing;
use durer::target::sheet::Dimension;
use durer::target::sheet::PaperMark;
use durer::trace::NoTrace;
use durer::visibility::line::hidden_line::{self, draw};
use durer::visibility::object::Faces;

const TOP: DVec3 = DVec3::Z;
const FRONT: DVec3 = DVec3::NEG_Y;

/// Returns a plate of 80 × 40 × 6 with two pegs of ⌀10 and one of ⌀6 on it.
fn plate() -> Scene {
    let mut triangles: Vec<Triangle> = cuboid([0.0; 3], [80.0, 40.0, 6.0]);
    for (x, radius) in [(15.0, 5.0), (65.0, 5.0), (40.0, 3.0)] {
        triangles.extend(cylinder([x, 20.0], radius, [6.0, 16.0], 48));
    }
    soup(&triangles)
}

fn drawn(scene: &Scene, to_eye: DVec3) -> (LaidOut, Drawing) {
    let view = view(DVec3::new(40.0, 20.0, 5.0), to_eye, 120.0, false);
    let options = hidden_line::Options::default();
    let drawing = draw(scene, &view, &options, &mut NoTrace).expect("drawing");
    let (page, scale) = ("A4-landscape".parse().expect("page"), "1:1".parse().expect("scale"));
    let mut laid =
        lay_out(&drawing, "", &Options { page, scale, ..Options::default() }).expect("sheet");
    laid.views[0].camera = Some(*view.camera());
    (laid, drawing)
}

fn annotated(scene: &Scene, to_eye: DVec3, wanted: &Annotations) -> (LaidOut, Vec<String>) {
    let (mut laid, drawing) = drawn(scene, to_eye);
    let notes = put(scene, &mut laid, &drawing, wanted).expect("annotations");
    (laid, notes)
}

fn put(
    scene: &Scene,
    laid: &mut LaidOut,
    drawing: &Drawing,
    wanted: &Annotations,
) -> durer::Result<Vec<String>> {
    let features: Vec<RoundFeature> = features(scene, &Faces::new(scene).expect("faces"));
    let shown = Shown {
        views: &laid.views,
        drawings: &[drawing],
        features: &features,
        unit: 1.0,
        hidden: false,
        color: [0, 0, 0, 255],
    };
    annotate(&mut laid.sheet, wanted, &shown)
}

fn marks<'a>(laid: &'a LaidOut, layer: &str) -> &'a [PaperMark] {
    laid.sheet.layers.iter().find(|l| l.name == layer).map_or(&[], |l| &l.marks)
}

fn dimensions(laid: &LaidOut) -> Vec<&Dimension> {
    let of = |m: &'_ PaperMark| matches!(m, PaperMark::Dimension(_));
    let all = marks(laid, "dimension").iter().filter(|m| of(m));
    all.filter_map(|m| if let PaperMark::Dimension(d) = m { Some(&**d) } else { None }).collect()
}

fn texts(laid: &LaidOut) -> Vec<&str> {
    let mut texts: Vec<&str> = dimensions(laid).iter().map(|d| d.text.text.as_str()).collect();
    texts.sort_unstable();
    texts
}

fn linear(from: DVec3, to: DVec3, along: Along) -> Request {
    let what = What::Linear { from: FeaturePlace::Point(from), to: FeaturePlace::Point(to), along };
    Request { what, view: None, side: None, text: None }
}

#[test]
fn sizes_and_diameters_are_those_of_the_model() {
    let wanted = Annotations { sizes: true, bosses: true, ..Annotations::default() };
    let (laid, notes) = annotated(&plate(), TOP, &wanted);
    assert_eq!(texts(&laid), ["2× ⌀10", "40", "80", "⌀6"]);
    assert!(notes.is_empty(), "{notes:?}");
    for d in dimensions(&laid) {
        let paper = match d.measure {
            Measure::Linear { ends, along, .. } => (ends[1] - ends[0]).dot(along).abs(),
            Measure::Diameter { ends } => ends[0].distance(ends[1]),
            _ => panic!("{:?}", d.measure),
        };
        assert!((paper * d.units_per_millimetre - d.value).abs() < 1e-5, "{d:?}");
        assert_eq!(d.is_plain, !d.text.text.contains('×'), "{}", d.text.text);
    }
    let (laid, notes) = annotated(&plate(), FRONT, &wanted);
    assert_eq!(texts(&laid), ["16", "80"]);
    assert_eq!(notes.len(), 2, "the pegs are seen from the side: {notes:?}");
}

#[test]
fn the_size_of_a_round_thing_is_its_diameter() {
    // A regular polygon of 15 sides is smaller than its circle except in the directions of its corners.
    let scene = soup(&cylinder([40.0, 20.0], 25.0, [0.0, 7.0], 15));
    let wanted = Annotations { sizes: true, ..Annotations::default() };
    assert_eq!(texts(&annotated(&scene, TOP, &wanted).0), ["50", "50"]);
    assert_eq!(texts(&annotated(&scene, FRONT, &wanted).0), ["50", "7"]);
}

#[test]
fn centers_are_crosses_or_lines() {
    let wanted = Annotations { center_lines: true, ..Annotations::default() };
    let (laid, _) = annotated(&plate(), TOP, &wanted);
    let lengths = |laid: &LaidOut| -> Vec<f64> {
        let of = |m: &PaperMark| match m {
            PaperMark::Stroke { points, .. } => points[0].distance(points[1]),
            _ => panic!("{m:?}"),
        };
        let mut all: Vec<f64> = marks(laid, "center").iter().map(of).collect();
        all.sort_by(f64::total_cmp);
        all
    };
    // 2.5 mm beyond each side.
    let expected = [11.0, 11.0, 15.0, 15.0, 15.0, 15.0];
    let found = lengths(&laid);
    assert_eq!(found.len(), expected.len(), "{found:?}");
    assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-4), "{found:?}");
    let found = lengths(&annotated(&plate(), FRONT, &wanted).0);
    assert!(found.len() == 3 && found.iter().all(|l| (l - 15.0).abs() < 1e-4), "{found:?}");
    assert!(
        marks(&annotated(&soup(&cuboid([0.0; 3], [9.0; 3])), TOP, &wanted).0, "center").is_empty()
    );
}

#[test]
fn requests_say_what_they_measure() {
    let named = |name: &str| FeaturePlace::Feature(name.to_owned());
    let request = |what| Request { what, view: None, side: None, text: None };
    let between =
        What::Linear { from: named("boss 1"), to: named("boss 2"), along: Along::Straight };
    let angle = What::Angle {
        vertex: FeaturePlace::Point(DVec3::ZERO),
        from: FeaturePlace::Point(DVec3::new(80.0, 0.0, 0.0)),
        to: FeaturePlace::Point(DVec3::new(80.0, 40.0, 0.0)),
    };
    let wanted = Annotations {
        dimensions: vec![
            Request { text: Some("<> ±0.1".to_owned()), ..request(between) },
            request(What::Diameter("boss 3".to_owned())),
            request(What::Radius("boss 1".to_owned())),
            request(angle),
            linear(DVec3::new(1.0, 2.0, 3.0), DVec3::new(13.5, 9.0, 3.0), Along::X),
        ],
        ..Annotations::default()
    };
    let (laid, notes) = annotated(&plate(), TOP, &wanted);
    assert!(notes.is_empty(), "{notes:?}");
    assert_eq!(texts(&laid), ["12.5", "26.6°", "50 ±0.1", "R5", "⌀6"]);
}

#[test]
fn what_does_not_exist_is_refused_with_what_does() {
    let scene = plate();
    let (laid, drawing) = drawn(&scene, TOP);
    let error = |request: Request| {
        let wanted = Annotations { dimensions: vec![request], ..Annotations::default() };
        put(&scene, &mut laid.clone(), &drawing, &wanted).expect_err("refused").to_string()
    };
    let diameter = |name: &str, view: Option<&str>| Request {
        what: What::Diameter(name.to_owned()),
        view: view.map(str::to_owned),
        side: None,
        text: None,
    };
    let unknown = error(diameter("hole 1", None));
    assert!(
        unknown.contains("`hole 1`") && unknown.contains("boss 1, boss 2, boss 3"),
        "{unknown}"
    );
    assert!(error(diameter("boss 1", Some("left"))).contains("`left`"));
    let up = error(linear(DVec3::ZERO, DVec3::Z, Along::Straight));
    assert!(up.contains("(0.000, 0.000, 1.000)"), "{up}");
    assert!(error(linear(DVec3::ZERO, DVec3::ZERO, Along::X)).contains("no distance"));
    let threads = vec![Thread { name: "bolt".to_owned(), size: None }];
    let wanted = Annotations { threads, ..Annotations::default() };
    assert!(put(&scene, &mut laid.clone(), &drawing, &wanted).is_err());
}

#[test]
fn a_thread_is_three_quarters_of_a_circle_or_two_lines() {
    let scene = soup(&cylinder([40.0, 20.0], 4.0, [0.0, 20.0], 48));
    let size = Some("M8".parse().expect("size"));
    let threads = vec![Thread { name: "boss 1".to_owned(), size }];
    let wanted = Annotations { threads, bosses: true, ..Annotations::default() };
    let (laid, notes) = annotated(&scene, TOP, &wanted);
    assert_eq!((texts(&laid), notes.len()), (vec!["M8"], 0), "{notes:?}");
    let [PaperMark::Curve { curve, .. }] = marks(&laid, "thread") else { panic!("one arc") };
    let [CurvePiece::Arc(arc, _)] = curve.pieces[..] else { panic!("{curve:?}") };
    let center = laid.views[0].sheet_from_model(DVec3::new(40.0, 20.0, 0.0)).expect("seen");
    // The core diameter of M8: 8 − 1.0825 · 1.25.
    assert!((arc.radii().x - 6.6468 / 2.0).abs() < 1e-3 && arc.center.distance(center) < 1e-3);
    assert!((arc.turn.abs().to_degrees() - 270.0).abs() < 1e-9 && !curve.closed);
    assert_eq!(marks(&annotated(&scene, FRONT, &wanted).0, "thread").len(), 2);
}

/// Returns the extent of a text along its direction and across.
fn boxes(laid: &LaidOut) -> Vec<Rect> {
    let rect = |d: &&Dimension| Rect::around(dimension_strokes(&d.text).into_iter().flatten());
    dimensions(laid).iter().filter_map(rect).collect()
}

#[test]
fn texts_keep_clear_of_each_other_and_of_lines() {
    let mut random = Random(7);
    for round in 0..12 {
        let mut point = || {
            let mut next = |size: f64| (random.next() * size).round();
            DVec3::new(next(80.0), next(40.0), 6.0)
        };
        let sides = [
            None,
            Some(ViewSide::Above),
            Some(ViewSide::Below),
            Some(ViewSide::Left),
            Some(ViewSide::Right),
        ];
        let mut requests: Vec<Request> = Vec::new();
        while requests.len() < 7 {
            let (p, q) = (point(), point());
            let along = [Along::X, Along::Y, Along::Straight][requests.len() % 3];
            let apart = p != q && p.x != q.x && p.y != q.y;
            let side = sides[if along == Along::Straight { 0 } else { round % 3 }];
            requests.extend(apart.then(|| Request { side, ..linear(p, q, along) }));
        }
        let wanted = Annotations {
            dimensions: requests,
            sizes: true,
            bosses: true,
            center_lines: true,
            ..Annotations::default()
        };
        let (laid, notes) = annotated(&plate(), TOP, &wanted);
        assert_eq!(dimensions(&laid).len() + notes.len(), 11, "round {round}: {notes:?}");
        let boxes = boxes(&laid);
        let page = Rect::around([DVec2::ZERO, laid.sheet.size]).expect("page");
        for (i, a) in boxes.iter().enumerate() {
            assert!(a.min().cmpge(page.min()).all() && a.max().cmple(page.max()).all());
            assert!(boxes[..i].iter().all(|b| !is_upright_overlap(a, b)), "round {round}: {a:?}");
        }
    }
}

/// Oblique texts are made a little smaller, as their boxes are larger than the texts.
fn is_upright_overlap(a: &Rect, b: &Rect) -> bool {
    let small = |r: &Rect| r.size().min_element() < 3.6;
    let apart = a.max().cmple(b.min()).any() || b.max().cmple(a.min()).any();
    small(a) && small(b) && !apart
}

#[test]
fn lines_end_before_text() {
    // A dimension of the middle peg; its text is on the plate's centre line.
    let note = Request {
        what: What::Angle {
            vertex: FeaturePlace::Point(DVec3::new(20.0, 20.0, 6.0)),
            from: FeaturePlace::Point(DVec3::new(80.0, 10.0, 6.0)),
            to: FeaturePlace::Point(DVec3::new(80.0, 30.0, 6.0)),
        },
        view: None,
        side: None,
        text: None,
    };
    let wanted =
        Annotations { dimensions: vec![note], center_lines: true, ..Annotations::default() };
    let (laid, _) = annotated(&plate(), TOP, &wanted);
    let text = boxes(&laid)[0];
    let inside = |p: DVec2| p.cmpgt(text.min()).all() && p.cmplt(text.max()).all();
    for layer in laid.sheet.layers.iter().filter(|l| l.name != "dimension") {
        for mark in &layer.marks {
            let PaperMark::Stroke { points, .. } = mark else { continue };
            for w in points.windows(2) {
                let steps = (0..=100).map(|i| w[0].lerp(w[1], f64::from(i) / 100.0));
                assert!(!steps.into_iter().any(inside), "{}: {w:?} in {text:?}", layer.name);
            }
        }
    }
}
