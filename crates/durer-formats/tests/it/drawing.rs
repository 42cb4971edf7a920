//! Drawings on paper and in files.

use durer::math::{DVec2, DVec3, Plane, Rect};
use durer::paper::{
    Angle, Callout, Contents, Detail, Hidden, LaidOut, Options, PartsListRow, SheetView,
    TitleBlock, ViewKind, dashes, lay_out, lay_out_views,
};
use durer::scene::{Camera, Projection, UpAxis};
use durer::target::drawing::{Drawing, Line, LineClass, Region, RegionKind, TextAnchor, TextLabel};
use durer::target::sheet::PaperMark;
use durer::view::projection::NamedView;
use durer::work::Work;
use durer_formats::drawing::{
    DrawingFormat, DxfStrokes, FileOptions, write, write_dxf, write_geojson, write_hpgl, write_svg,
};

fn rectangle(w: f64, h: f64) -> Vec<DVec2> {
    [(-w, -h), (w, -h), (w, h), (-w, h)].map(|(x, y)| DVec2::new(x, y)).to_vec()
}

fn line(class: LineClass, invisibility: u32, points: Vec<DVec2>, closed: bool) -> Line {
    Line { class, invisibility, points, closed }
}

/// Returns a plate of 2w × 2h with a hole, an edge, and hidden lines behind one and two surfaces.
fn plate(w: f64, h: f64) -> Drawing {
    let hole: Vec<DVec2> = rectangle(5.0, 5.0).into_iter().rev().collect();
    let bend = [(-w, 0.0), (0.0, 0.0), (0.0, h)].map(|(x, y)| DVec2::new(x, y)).to_vec();
    let across = vec![DVec2::new(-w, -h / 2.0), DVec2::new(w, -h / 2.0)];
    Drawing {
        window: None,
        regions: vec![Region {
            kind: RegionKind::Surface,
            rings: vec![rectangle(w, h), hole.clone()],
            color: [200, 210, 230, 255],
            item: Some(7),
            part: None,
        }],
        lines: vec![
            line(LineClass::Silhouette, 0, rectangle(w, h), true),
            line(LineClass::Crease, 0, across, false),
            line(LineClass::Crease, 1, bend, false),
            line(LineClass::Border, 2, hole, true),
        ],
        labels: vec![TextLabel {
            at: DVec2::ZERO,
            text: "Ø 10 < é & \"x\"".to_owned(),
            height: 3.0,
            anchor: TextAnchor::Middle,
        }],
        ..Drawing::default()
    }
}

fn laid(hidden: Hidden) -> LaidOut {
    let page = "A4".parse().unwrap();
    let options = Options { page, scale: "1:1".parse().unwrap(), hidden, ..Options::default() };
    lay_out(&plate(60.0, 20.0), "Plate <1>", &options).unwrap()
}

fn text_of(write: impl Fn(&mut Vec<u8>) -> durer_formats::Result<()>) -> String {
    let mut bytes = Vec::new();
    write(&mut bytes).unwrap();
    String::from_utf8(bytes).unwrap()
}

#[test]
fn layers_follow_what_becomes_of_hidden_lines() {
    let names =
        |hidden| -> Vec<String> { laid(hidden).sheet.layers.into_iter().map(|l| l.name).collect() };
    let visible = ["visible-crease", "visible-silhouette", "text"];
    assert_eq!(names(Hidden::Drop), [&["regions"][..], &visible].concat());
    let dashed = ["regions", "hidden-border", "hidden-crease"];
    assert_eq!(names(Hidden::Dashed), [&dashed[..], &visible].concat());
    let deep = ["regions", "hidden-2-border", "hidden-1-crease"];
    assert_eq!(names(Hidden::Layer), [&deep[..], &visible].concat());
}

#[test]
fn svg_has_millimetres_layers_and_all_strokes() {
    let sheet = laid(Hidden::Dashed).sheet;
    let text = text_of(|out| write_svg(out, &sheet));
    let document = roxmltree::Document::parse(&text).unwrap();
    let root = document.root_element();
    assert_eq!(root.attribute("width"), Some("297mm"));
    assert_eq!(root.attribute("viewBox"), Some("0 0 297 210"));
    assert_eq!(
        root.children().find(|n| n.has_tag_name("title")).unwrap().text(),
        Some("Plate <1>")
    );
    let inkscape = "http://www.inkscape.org/namespaces/inkscape";
    let groups: Vec<_> =
        root.children().filter(|n| n.attribute((inkscape, "groupmode")) == Some("layer")).collect();
    assert_eq!(groups.len(), sheet.layers.len());
    for (group, layer) in groups.iter().zip(&sheet.layers) {
        assert_eq!(group.attribute((inkscape, "label")), Some(layer.name.as_str()));
        let paths: Vec<_> = group.children().filter(|n| n.has_tag_name("path")).collect();
        assert_eq!(paths.len(), layer.marks.len(), "{}", layer.name);
        for (path, mark) in paths.iter().zip(&layer.marks) {
            if let PaperMark::Stroke { points, closed, .. } = mark {
                let d = path.attribute("d").unwrap();
                assert!(d.starts_with(&format!("M{}", points[0].x)), "{d}");
                assert_eq!(d.ends_with('z'), *closed);
            }
        }
    }
    let silhouette =
        groups.iter().find(|g| g.attribute("id") == Some("visible-silhouette")).unwrap();
    let path = silhouette.children().find(|n| n.has_tag_name("path")).unwrap();
    assert_eq!(path.attribute("d"), Some("M88.5 125h120v-40h-120z"));
    assert_eq!(silhouette.attribute("stroke-width"), Some(".5"));
    let label = document.descendants().find_map(|n| n.attribute("aria-label"));
    assert_eq!(label, Some("Ø 10 < é & \"x\""));
}

#[test]
fn dashes_begin_and_end_with_a_whole_dash_and_meet_at_corners() {
    let sheet = laid(Hidden::Dashed).sheet;
    let layer = sheet.layers.iter().find(|l| l.name == "hidden-crease").unwrap();
    assert_eq!(layer.marks.len(), 2, "divided at its corner");
    for mark in &layer.marks {
        let PaperMark::Stroke { points, closed, pen } = mark else { panic!("{mark:?}") };
        let nominal = &sheet.pens[*pen].dashes;
        let length = dashes::length(points, *closed);
        let fitted = dashes::fitted(nominal, length, *closed).unwrap();
        let parts = dashes::cut(points, *closed, nominal);
        assert!(parts[0][0].distance(points[0]) < 1e-9);
        assert!(parts.last().unwrap().last().unwrap().distance(*points.last().unwrap()) < 1e-9);
        for part in &parts {
            assert!((dashes::length(part, false) - fitted[0]).abs() < 1e-9);
        }
        assert!((fitted[0] / nominal[0] - 1.0).abs() < 0.2);
    }
}

#[test]
fn geojson_has_a_feature_a_piece() {
    let drawing = plate(60.0, 20.0);
    let text = text_of(|out| write_geojson(out, &drawing));
    let json: serde_json::Value = serde_json::from_str(&text).unwrap();
    let features = json["features"].as_array().unwrap();
    assert_eq!(features.len(), 6);
    let region = &features[0];
    assert_eq!(region["properties"]["class"], "surface");
    assert_eq!(region["properties"]["item"], 7);
    assert_eq!(region["geometry"]["type"], "Polygon");
    assert_eq!(region["geometry"]["coordinates"].as_array().unwrap().len(), 2);
    for (feature, line) in features[1..].iter().zip(&drawing.lines) {
        assert_eq!(feature["properties"]["class"], line.class.name());
        assert_eq!(feature["properties"]["visible"], line.is_visible());
        assert_eq!(feature["properties"]["invisibility"], line.invisibility);
        let points = feature["geometry"]["coordinates"].as_array().unwrap();
        assert_eq!(points.len(), line.points.len() + usize::from(line.closed));
        assert_eq!(points[0][0].as_f64(), Some(line.points[0].x));
    }
}

#[test]
fn dxf_has_pairs_unique_handles_and_declared_layers() {
    let sheet = laid(Hidden::Dashed).sheet;
    let text = text_of(|out| write_dxf(out, &sheet, DxfStrokes::Polylines));
    assert!(text.is_ascii());
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines.len() % 2, 0);
    let tags: Vec<(u16, &str)> =
        lines.chunks(2).map(|c| (c[0].trim().parse().unwrap(), c[1])).collect();
    assert_eq!(tags.last(), Some(&(0, "EOF")));
    let count = |kind: &str| tags.iter().filter(|t| **t == (0, kind)).count();
    assert_eq!(count("SECTION"), count("ENDSEC"));
    assert_eq!(count("TABLE"), count("ENDTAB"));
    assert_eq!(count("LAYER"), sheet.layers.len() + 1);
    assert_eq!((count("HATCH"), count("TEXT")), (1, 1));
    // The bend is two strokes, the hole four, outline and edge one each.
    assert_eq!(count("LWPOLYLINE"), 8);
    let mut handles: Vec<&str> = tags
        .iter()
        .skip_while(|t| **t != (2, "TABLES"))
        .filter(|t| t.0 == 5 || t.0 == 105)
        .map(|t| t.1)
        .collect();
    let all = handles.len();
    handles.sort_unstable();
    handles.dedup();
    assert_eq!(handles.len(), all);
    for layer in &sheet.layers {
        assert!(tags.contains(&(2, layer.name.as_str())), "{}", layer.name);
    }
    assert!(tags.contains(&(6, "HIDDEN")) && tags.contains(&(6, "CONTINUOUS")));
}

#[test]
fn dots_are_circles_in_dxf() {
    let dot = |x: f64| vec![DVec2::new(x, 0.0), DVec2::new(x + 0.01, 0.0)];
    let dash = vec![DVec2::new(0.0, 9.0), DVec2::new(0.1, 9.0)];
    let strokes = [dot(-20.0), dot(20.0), dash];
    let lines = strokes.map(|points| line(LineClass::Stipple, 0, points, false)).to_vec();
    let options = Options {
        page: "A4".parse().unwrap(),
        scale: "1:1".parse().unwrap(),
        ..Options::default()
    };
    let drawing = Drawing { lines, ..Drawing::default() };
    let sheet = lay_out(&drawing, "dots", &options).unwrap().sheet;
    let text = text_of(|out| write_dxf(out, &sheet, DxfStrokes::Pieces));
    let all: Vec<&str> = text.lines().collect();
    let count = |name: &str| all.windows(2).filter(|w| w == &["  0", name]).count();
    assert_eq!((count("CIRCLE"), count("LINE")), (2, 1));
    // Dots are as wide as the pen: the radius follows the centre.
    let radii: Vec<&str> =
        all.windows(2).filter(|w| w[0] == " 40" && w[1] == "0.25").map(|w| w[1]).collect();
    assert_eq!(radii.len(), 2);
}

#[test]
fn hpgl_draws_each_pen_once_and_stays_on_the_paper() {
    let sheet = laid(Hidden::Dashed).sheet;
    let text = text_of(|out| write_hpgl(out, &sheet));
    assert!(text.starts_with("IN;") && text.ends_with("SP0;\n"));
    let pens: Vec<&str> = text.split(';').map(str::trim).filter(|c| c.starts_with("SP")).collect();
    let mut different = pens.clone();
    different.dedup();
    assert_eq!(pens, different);
    for command in
        text.split(';').map(str::trim).filter(|c| c.starts_with("PU") || c.starts_with("PD"))
    {
        let numbers: Vec<i64> = command[2..].split(',').map(|n| n.parse().unwrap()).collect();
        assert_eq!(numbers.len() % 2, 0, "{command}");
        for p in numbers.chunks(2) {
            assert!((0..=11880).contains(&p[0]) && (0..=8400).contains(&p[1]), "{command}");
        }
    }
}

#[test]
fn every_format_gives_the_same_bytes_again_and_takes_an_empty_sheet() {
    for &format in DrawingFormat::ALL {
        for drawing in [plate(60.0, 20.0), Drawing::default()] {
            let sheet = lay_out(&drawing, "", &Options::default()).unwrap().sheet;
            let bytes = || {
                let mut out = Vec::new();
                write(&mut out, format, &sheet, &drawing, &FileOptions::default()).unwrap();
                out
            };
            assert!(!bytes().is_empty() && bytes() == bytes(), "{format}");
        }
    }
}

/// Returns a parallel view of the origin from a side of a model whose z axis is up.
fn camera(side: NamedView) -> Camera {
    let direction = side.direction(UpAxis::Z);
    Camera {
        eye: direction.to_eye() * 500.0,
        target: DVec3::ZERO,
        up: direction.up(),
        projection: Projection::Orthographic { height: 200.0 },
        near: 1.0,
        far: 1000.0,
    }
}

/// Returns the four usual views of a block of 120 × 70 × 40.
fn block() -> [(NamedView, Drawing); 4] {
    [
        (NamedView::Front, plate(60.0, 20.0)),
        (NamedView::Top, plate(60.0, 35.0)),
        (NamedView::Right, plate(35.0, 20.0)),
        (NamedView::Iso, plate(62.0, 45.0)),
    ]
}

fn principal(views: &[(NamedView, Drawing)]) -> Vec<SheetView<'_>> {
    let all = views.iter();
    all.map(|(side, drawing)| SheetView {
        kind: ViewKind::Principal(*side),
        camera: camera(*side),
        drawing,
        breaks: Default::default(),
    })
    .collect()
}

fn on_sheet(angle: Angle, views: &[SheetView], scale: &str, page: &str) -> durer::Result<LaidOut> {
    let (page, scale) = (page.parse()?, scale.parse()?);
    let options = Options { margin: 10.0, scale, page, ..Options::default() };
    let title = TitleBlock { name: "Plate".to_owned(), unit: "mm".to_owned(), date: None };
    let contents = Contents { angle, views, callouts: &[], parts: &[], title: Some(&title) };
    lay_out_views(&contents, &options)
}

/// Returns the rectangles around strokes of a layer.
fn boxes(laid: &LaidOut, layer: &str) -> Vec<Rect> {
    let layer = laid.sheet.layers.iter().find(|l| l.name == layer).expect("a layer");
    let points = layer.marks.iter().filter_map(|m| match m {
        PaperMark::Stroke { points, .. } => Rect::around(points.iter().copied()),
        _ => None,
    });
    points.collect()
}

fn texts(laid: &LaidOut, layer: &str) -> Vec<(String, DVec2)> {
    let layer = laid.sheet.layers.iter().find(|l| l.name == layer).expect("a layer");
    let texts = layer.marks.iter().filter_map(|m| match m {
        PaperMark::Text { text, at, .. } => Some((text.clone(), *at)),
        _ => None,
    });
    texts.collect()
}

/// Checks that views are beside each other, within the frame and above the title block of an A4 sheet.
fn assert_apart(views: &[Rect]) {
    for (i, a) in views.iter().enumerate() {
        assert!(a.min().min_element() > 10.0 && a.max().x < 287.0 && a.max().y < 184.0, "{a:?}");
        assert!(views[..i].iter().all(|b| !a.overlaps(b)), "{views:?}");
    }
}

#[test]
fn third_angle_views_are_aligned_and_on_the_paper() {
    let block = block();
    let laid = on_sheet(Angle::Third, &principal(&block), "auto", "fit").unwrap();
    assert_eq!((laid.scale, laid.sheet.size), (1.0, DVec2::new(297.0, 210.0)));
    let [front, top, right, iso] = boxes(&laid, "visible-silhouette")[..] else { panic!() };
    assert_eq!((front.min().x, front.max().x), (top.min().x, top.max().x));
    assert_eq!((front.min().y, front.max().y), (right.min().y, right.max().y));
    assert!(top.max().y < front.min().y && front.max().x < right.min().x);
    assert!(iso.min().x > top.max().x && iso.max().y < right.min().y);
    assert_apart(&[front, top, right, iso]);
}

#[test]
fn first_angle_views_stand_on_the_other_sides() {
    let block = block();
    let laid = on_sheet(Angle::First, &principal(&block), "auto", "fit").unwrap();
    let [front, top, right, iso] = laid.views[..].iter().map(|v| v.bounds).collect::<Vec<_>>()[..]
    else {
        panic!("{:?}", laid.views)
    };
    assert_eq!((front.min().x, front.max().x), (top.min().x, top.max().x));
    assert_eq!((front.min().y, front.max().y), (right.min().y, right.max().y));
    assert!(top.min().y > front.max().y && front.min().x > right.max().x);
    assert!(iso.max().x < top.min().x && iso.min().y > right.max().y);
    assert_apart(&[front, top, right, iso]);
    // The circles of the symbol are right of the cone; in both symbols the cone narrows to the left.
    for (angle, side) in [(Angle::First, 1.0), (Angle::Third, -1.0)] {
        let laid = on_sheet(angle, &principal(&block), "auto", "fit").unwrap();
        let block = boxes(&laid, "title-block");
        let middle = |size: f64| {
            let found = block.iter().find(|b| (b.size() - DVec2::splat(size)).length() < 0.1);
            found.map(|b| (b.min().x + b.max().x) * 0.5).expect("a shape of the symbol")
        };
        assert!((middle(4.0) - (middle(8.0))).abs() < 0.1);
        let symbol = boxes(&laid, "title-block");
        let cone = symbol.iter().rev().find(|b| (b.size().y - 8.0).abs() < 1e-9).unwrap();
        assert_eq!((middle(4.0) - (cone.min().x + cone.max().x) * 0.5).signum(), side);
    }
}

#[test]
fn views_on_sheets_tell_where_points_of_the_model_are() {
    let block = block();
    let laid = on_sheet(Angle::Third, &principal(&block), "1:2", "A4").unwrap();
    let corner = DVec3::new(60.0, -35.0, 20.0); // right, front, top
    let at: Vec<DVec2> = laid.views.iter().map(|v| v.sheet_from_model(corner).unwrap()).collect();
    assert_eq!(
        laid.views.iter().map(|v| v.name.as_str()).collect::<Vec<_>>(),
        ["front", "top", "right", "iso"]
    );
    assert!((at[0].x - at[1].x).abs() < 1e-9 && (at[0].y - at[2].y).abs() < 1e-9);
    let upper_right = DVec2::new(laid.views[0].bounds.max().x, laid.views[0].bounds.min().y);
    assert!((at[0] - upper_right).length() < 1e-9);
    assert!((laid.views[0].factor - 0.5).abs() < 1e-12);
}

#[test]
fn all_six_sides_have_their_places() {
    use NamedView::{Back, Bottom, Front, Iso, Left, Right, Top};
    let size = |side| match side {
        Front | Back => (60.0, 20.0),
        Top | Bottom => (60.0, 35.0),
        Left | Right => (35.0, 20.0),
        Iso => (62.0, 45.0),
    };
    let drawn: Vec<(NamedView, Drawing)> =
        NamedView::ALL.iter().map(|v| (*v, plate(size(*v).0, size(*v).1))).collect();
    for angle in [Angle::First, Angle::Third] {
        let laid = on_sheet(angle, &principal(&drawn), "auto", "fit").unwrap();
        let of = |side: NamedView| {
            laid.views.iter().find(|v| v.name == side.name()).expect("a view").bounds
        };
        let turn = if angle == Angle::Third { 1.0 } else { -1.0 };
        let right_of = |a: NamedView, b: NamedView| (of(a).min().x - of(b).min().x) * turn > 0.0;
        let below = |a: NamedView, b: NamedView| (of(a).min().y - of(b).min().y) * turn > 0.0;
        assert!(right_of(Right, Front) && right_of(Front, Left) && right_of(Back, Right));
        assert!(below(Front, Top) && below(Bottom, Front) && right_of(Iso, Top));
        let all: Vec<Rect> = laid.views.iter().map(|v| v.bounds).collect();
        assert_apart(&all);
    }
}

fn section(letter: &str, normal: DVec3, drawing: &Drawing) -> (ViewKind, Camera, Drawing) {
    let plane = Plane { normal, distance: 10.0 };
    let kind = ViewKind::Section { letter: letter.to_owned(), plane };
    (kind, Camera { eye: normal * -500.0, ..camera(NamedView::Front) }, drawing.clone())
}

#[test]
fn sections_get_views_with_titles_and_lines_where_they_cut() {
    let block = block();
    let mut views = principal(&block);
    // The remaining part is right of x = −10, and above y = −10 in the view from above.
    let (a, b) = (section("A", DVec3::X, &block[2].1), section("B", DVec3::Y, &block[0].1));
    let askew = section("C", DVec3::new(1.0, 1.0, 1.0), &block[2].1);
    for (kind, camera, drawing) in [&a, &b, &askew] {
        views.push(SheetView {
            kind: kind.clone(),
            camera: *camera,
            drawing,
            breaks: Default::default(),
        });
    }
    let laid = on_sheet(Angle::Third, &views, "auto", "A3").unwrap();
    let names: Vec<&str> = laid.views[4..].iter().map(|v| v.name.as_str()).collect();
    assert_eq!(names, ["A–A", "B–B", "C–C"]);
    let titles = texts(&laid, "view-titles");
    for (view, (title, at)) in laid.views[4..].iter().zip(&titles) {
        assert_eq!(&view.name, title);
        assert!(at.y < view.bounds.min().y && at.y > view.bounds.min().y - 10.0);
    }
    for (i, a) in laid.views.iter().enumerate() {
        assert!(laid.views[..i].iter().all(|b| !a.bounds.overlaps(&b.bounds)));
        assert!(a.bounds.max().y < laid.sheet.size.y - 26.0);
    }
    // Section A is vertical in the front view, at x = −10, with its arrows and letters left of it.
    let (front, top) = (&laid.views[0], &laid.views[1]);
    let lines = boxes(&laid, "cutting-planes");
    let x = front.sheet_from_model(DVec3::new(-10.0, 0.0, 0.0)).unwrap().x;
    assert!((lines[0].min().x - x).abs() < 1e-9 && lines[0].size().x < 1e-9);
    assert!(lines[0].min().y < front.bounds.min().y && lines[0].max().y > front.bounds.max().y);
    let letters = texts(&laid, "cutting-planes");
    let said: Vec<&str> = letters.iter().map(|l| l.0.as_str()).collect();
    assert_eq!(said, ["A", "A", "B", "B"]);
    assert!(letters[..2].iter().all(|l| l.1.x < x - 9.0));
    // Section B is drawn in the view from above and viewed from below, that is, from the front.
    let y = top.sheet_from_model(DVec3::new(0.0, -10.0, 0.0)).unwrap().y;
    assert!(letters[2..].iter().all(|l| l.1.y > y + 9.0 && l.1.x < top.bounds.max().x + 20.0));
    // No view shows C edge-on.
    assert_eq!(laid.notes.len(), 1);
    assert!(laid.notes[0].contains("section C"), "{:?}", laid.notes);
}

#[test]
fn details_are_cut_to_their_circles() {
    let block = block();
    let detail = Detail {
        letter: "D".to_owned(),
        of: 0,
        center: DVec2::new(60.0, 20.0),
        radius: 5.0,
        scale: None,
    };
    let cut = detail.cut(&block[0].1).unwrap();
    let [corner] = &cut.lines[..] else { panic!("{:?}", cut.lines) };
    let expected = [(60.0, 15.0), (60.0, 20.0), (55.0, 20.0)].map(DVec2::from);
    assert_eq!(corner.points.len(), 3);
    assert!(corner.points.iter().zip(expected).all(|(p, e)| p.abs_diff_eq(e, 1e-9)), "{corner:?}");
    assert!(!corner.closed && cut.labels.is_empty());
    // A quarter of the disc is filled.
    let quarter = std::f64::consts::PI * 25.0 / 4.0;
    assert!((cut.regions[0].area() / quarter - 1.0).abs() < 2e-3, "{}", cut.regions[0].area());
    let mut views = principal(&block);
    let kind = ViewKind::Detail(detail);
    views.push(SheetView {
        kind,
        camera: views[0].camera,
        drawing: &cut,
        breaks: Default::default(),
    });
    let laid = on_sheet(Angle::Third, &views, "auto", "A4").unwrap();
    // 10 mm wide at 1:2; at 5:1 it is 50 mm.
    assert_eq!((laid.scale, laid.views[4].factor), (0.5, 5.0));
    assert_eq!(texts(&laid, "view-titles")[0].0, "D (5:1)");
    let circles = boxes(&laid, "details");
    assert!(
        (circles[0].size() - 50.0).length() < 1e-9 && (circles[1].size() - 5.0).length() < 1e-9
    );
    assert!(circles[1].contains(laid.views[0].sheet_from_plane(DVec2::new(60.0, 20.0))));
    let all: Vec<Rect> = laid.views.iter().map(|v| v.bounds).collect();
    assert_apart(&all);
}

#[test]
fn views_that_have_no_room_are_refused_and_fitted_paper_grows() {
    let block = block();
    let mut views = principal(&block);
    let (kind, camera, drawing) = section("A", DVec3::X, &block[0].1);
    views.push(SheetView { kind, camera, drawing: &drawing, breaks: Default::default() });
    let error = on_sheet(Angle::Third, &views, "1:1", "A4").unwrap_err().to_string();
    assert!(error.contains("5 views") && error.contains("1:2 has room"), "{error}");
    let laid = on_sheet(Angle::Third, &views, "1:1", "fit").unwrap();
    assert!(laid.views[4].bounds.max().y < laid.sheet.size.y - 26.0 && laid.scale == 1.0);
    assert!(on_sheet(Angle::Third, &views, "auto", "20x40").is_err());
    let filled = Options { page: "A4".parse().unwrap(), ..Options::default() };
    let title = TitleBlock::default();
    let contents = Contents {
        angle: Angle::Third,
        views: &views,
        callouts: &[],
        parts: &[],
        title: Some(&title),
    };
    let laid = lay_out_views(&contents, &filled).unwrap();
    assert!(laid.scale > 0.5 && laid.scale < 1.0, "{}", laid.scale);
}

#[test]
fn callouts_stand_around_their_view_and_the_list_on_the_title_block() {
    let block = block();
    let views = principal(&block);
    let callout = |(number, x): (&str, f64)| Callout {
        view: 3,
        number: number.to_owned(),
        at: DVec2::new(x, 0.0),
    };
    let callouts = [("1", -30.0), ("2", 0.0), ("3", 30.0)].map(callout);
    let part = |(number, name, quantity): (&str, &str, usize)| PartsListRow {
        number: number.to_owned(),
        name: name.to_owned(),
        quantity,
    };
    let parts = [("1", "base", 1), ("2", "screw", 4), ("3", "lid", 1)].map(part);
    let title = TitleBlock { name: "Block".to_owned(), unit: "mm".to_owned(), date: None };
    let contents = Contents {
        angle: Angle::Third,
        views: &views,
        callouts: &callouts,
        parts: &parts,
        title: Some(&title),
    };
    let page = "A3".parse().unwrap();
    let options =
        Options { page, margin: 10.0, scale: "1:1".parse().unwrap(), ..Options::default() };
    let laid = lay_out_views(&contents, &options).unwrap();
    let numbers = texts(&laid, "callouts");
    assert_eq!(numbers.iter().map(|n| n.0.as_str()).collect::<Vec<_>>(), ["1", "2", "3"]);
    let iso = laid.views[3].bounds;
    let circles = boxes(&laid, "callouts");
    let circles = circles.iter().filter(|b| (b.size() - 9.0).abs().max_element() < 0.1);
    for circle in circles.clone() {
        assert!(!circle.overlaps(&iso), "{circle:?} {iso:?}");
        let others = laid.views[..3].iter();
        assert!(others.clone().all(|v| !v.bounds.overlaps(circle)) && circle.min().y > 10.0);
    }
    assert_eq!(circles.count(), 3);
    let rows: Vec<String> = texts(&laid, "parts-list").into_iter().map(|t| t.0).collect();
    let expected = ["ITEM", "NAME", "QTY", "1", "base", "1", "2", "screw", "4", "3", "lid", "1"];
    assert_eq!(rows, expected);
    // Its heading is above the title block, at the right; no view overlaps it.
    let list = Rect::around(boxes(&laid, "parts-list").iter().flat_map(|b| [b.min(), b.max()]));
    let list = list.unwrap();
    assert_eq!(list.max(), laid.sheet.size - DVec2::new(10.0, 26.0));
    assert!(laid.views.iter().all(|v| !v.bounds.overlaps(&list)));
    // Without a title block it takes that place.
    let free = SheetView { kind: ViewKind::Free, ..views[3].clone() };
    let callouts = callouts.clone().map(|c| Callout { view: 0, ..c });
    let views = [free];
    let contents = Contents { title: None, views: &views, callouts: &callouts, ..contents };
    let laid = lay_out_views(&contents, &options).unwrap();
    let list = boxes(&laid, "parts-list").iter().map(|b| b.max()).fold(DVec2::ZERO, DVec2::max);
    assert_eq!(list, laid.sheet.size - 10.0);
    assert!(laid.sheet.layers.iter().all(|l| l.name != "title-block"));
}

#[test]
fn a_scale_that_does_not_fit_is_refused() {
    let page = "A5".parse().unwrap();
    let options = Options { page, scale: "10:1".parse().unwrap(), ..Options::default() };
    let error = lay_out(&plate(60.0, 20.0), "", &options).unwrap_err().to_string();
    assert!(error.contains("10:1") && error.contains("1.66:1") && error.contains("1:1"), "{error}");
}

#[test]
fn files_made_in_memory_are_charged() {
    let sheet = laid(Hidden::Dashed).sheet;
    for (format, is_charged) in [
        (DrawingFormat::Pdf, true),
        (DrawingFormat::Dxf, true),
        (DrawingFormat::Svg, false),
        (DrawingFormat::Hpgl, false),
    ] {
        let work = Work::with_budget(300, "--max-memory");
        let options = FileOptions { work: work.clone(), ..FileOptions::default() };
        let written = write(&mut Vec::new(), format, &sheet, &Drawing::default(), &options);
        let refused = written.err().map(|error| error.to_string());
        let named = refused.as_ref().is_some_and(|e| e.starts_with("file of the drawing: "));
        assert_eq!((named, work.used()), (is_charged, 0), "{format}: {refused:?}");
    }
}
