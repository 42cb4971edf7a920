//! Every kind of mark in every writer: its text in the file, to the byte if it is short.

use durer::math::{DAffine2, DVec2};
use durer::target::dimension::{DimensionText, Measure};
use durer::target::drawing::TextAnchor;
use durer::target::gradient::{Gradient, GradientShape, Spread};
use durer::target::sheet::{
    ClipPath, Dimension, GradientArea, MarkGroup, PaperMark, Pen, Sheet, SheetLayer,
};
use durer::target::{Curve, CurvePiece, EllipticArc};
use durer_formats::drawing::{
    self, DrawingFormat, DxfStrokes, FileOptions, write_dxf, write_hpgl, write_pdf, write_svg,
};
use std::f64::consts::{FRAC_PI_2, TAU};

fn points(list: &[(f64, f64)]) -> Vec<DVec2> {
    list.iter().map(|&(x, y)| DVec2::new(x, y)).collect()
}

fn stroke(list: &[(f64, f64)], closed: bool, pen: usize) -> PaperMark {
    PaperMark::Stroke { points: points(list), closed, pen }
}

fn text(words: &str, anchor: TextAnchor) -> PaperMark {
    PaperMark::Text {
        at: DVec2::new(50.0, 40.0),
        text: words.to_owned(),
        height: 5.0,
        anchor,
        pen: 0,
    }
}

/// Returns a sheet of 100 × 80 with a black, a dashed and a half transparent red pen.
fn sheet(marks: Vec<PaperMark>) -> Sheet {
    let pen = |width, color, dashes| Pen { width, color, dashes };
    Sheet {
        title: "Marks".to_owned(),
        size: DVec2::new(100.0, 80.0),
        background: None,
        pens: vec![
            pen(0.5, [0, 0, 0, 255], Vec::new()),
            pen(0.25, [0, 0, 0, 255], vec![3.0, 1.5]),
            pen(0.7, [255, 0, 32, 128], Vec::new()),
        ],
        layers: vec![
            SheetLayer { name: "first".to_owned(), marks },
            SheetLayer { name: "second".to_owned(), marks: Vec::new() },
        ],
    }
}

fn written(write: impl Fn(&mut Vec<u8>) -> durer_formats::Result<()>) -> Vec<u8> {
    let mut bytes = Vec::new();
    write(&mut bytes).expect("written");
    bytes
}

fn utf8(bytes: Vec<u8>) -> String {
    String::from_utf8(bytes).expect("text")
}

#[test]
fn svg_paths_are_relative_and_dots_are_dots() {
    let marks = vec![
        stroke(&[(1.0, 0.0), (2.0, 0.0), (2.0, 3.0), (4.0, 2.0), (4.5, 1.0)], true, 0),
        stroke(&[(7.0, 8.0), (7.0, 8.0)], false, 0),
        stroke(&[(0.0, 0.0), (5.0, 5.0)], false, 2),
        PaperMark::Fill {
            rings: vec![points(&[(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)])],
            color: [1, 2, 3, 255],
            even_odd: false,
        },
    ];
    let svg = utf8(written(|out| write_svg(out, &sheet(marks.clone()))));
    for part in [
        "d=\"M1 0h1v3l2-1 .5-1z\"",
        "d=\"M7 8h0\"",
        " stroke=\"#ff0020\" stroke-opacity=\".502\" stroke-width=\".7\" d=\"M0 0l5 5\"",
        "<path fill=\"#010203\" stroke=\"none\" d=\"M0 0h1l-1 1z\"/>",
    ] {
        assert!(svg.contains(part), "{part} is not in\n{svg}");
    }
}

#[test]
fn hpgl_is_as_the_pen_moves() {
    let marks = vec![
        stroke(&[(1.0, 79.0), (2.0, 79.0), (2.0, 78.0)], true, 0),
        // Its end is nearer to the pen's position at that time.
        stroke(&[(90.0, 79.0), (5.0, 79.0)], false, 0),
        stroke(&[(95.0, 70.0), (95.0, 70.0)], false, 0),
    ];
    let hpgl = utf8(written(|out| write_hpgl(out, &sheet(marks.clone()))));
    let expected = "IN;\nSP1;PW.5,1;\nPU80,40;PD80,80,40,40,80,40;\nPU200,40;PD3600,40;\n\
                    PU3800,400;PD3800,400;\nPU0,0;\nSP0;\n";
    assert_eq!(hpgl, expected);
}

#[test]
fn dxf_entities_have_their_flags_weights_and_colours() {
    let marks = vec![
        stroke(&[(1.0, 2.0), (2.0, 2.0), (2.0, 3.0)], true, 0),
        stroke(&[(1.0, 2.0), (2.0, 2.0)], false, 2),
        text("2^3", TextAnchor::Start),
        text("end", TextAnchor::End),
        PaperMark::Fill {
            rings: vec![points(&[(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)])],
            color: [1, 2, 3, 255],
            even_odd: false,
        },
    ];
    let dxf = utf8(written(|out| write_dxf(out, &sheet(marks.clone()), DxfStrokes::Polylines)));
    let lines: Vec<&str> = dxf.lines().collect();
    let pairs: Vec<(&str, &str)> =
        lines.as_chunks::<2>().0.iter().map(|[code, value]| (code.trim(), *value)).collect();
    let of = |kind: &str| -> Vec<Vec<(&str, &str)>> {
        let starts = pairs.iter().enumerate().filter(|(_, p)| **p == ("0", kind));
        let end =
            |i: usize| pairs[i + 1..].iter().position(|p| p.0 == "0").map_or(0, |n| n + i + 1);
        starts.map(|(i, _)| pairs[i..end(i)].to_vec()).collect()
    };
    let has = |entity: &[(&str, &str)], pair: (&str, &str)| entity.contains(&pair);
    let polylines = of("LWPOLYLINE");
    assert!(has(&polylines[0], ("70", "129")) && has(&polylines[1], ("70", "128")));
    assert!(has(&polylines[0], ("370", "50")) && has(&polylines[1], ("370", "70")));
    assert!(has(&polylines[0], ("20", "78.0")), "y is up: {:?}", polylines[0]);
    let texts = of("TEXT");
    assert!(has(&texts[0], ("1", "2^ 3")) && !texts[0].iter().any(|p| p.0 == "72"));
    assert!(has(&texts[1], ("72", "2")) && has(&texts[1], ("11", "50.0")));
    assert!(has(&of("HATCH")[0], ("420", &(0x01_02_03).to_string())));
    let hidden = of("LTYPE").into_iter().find(|t| has(t, ("2", "HIDDEN"))).expect("line type");
    assert!(has(&hidden, ("49", "3.0")) && has(&hidden, ("49", "-1.5")), "{hidden:?}");
}

/// Returns the operators of a page.
fn content(pdf: &[u8]) -> String {
    let find = |from: usize, what: &[u8]| {
        pdf[from..].windows(what.len()).position(|w| w == what).map(|i| from + i)
    };
    let start = find(0, b"stream\n").or_else(|| find(0, b"stream\r\n")).expect("a stream");
    let start = start + pdf[start..].iter().position(|b| *b == b'\n').expect("its start") + 1;
    let end = find(start, b"endstream").expect("its end");
    utf8(miniz_oxide::inflate::decompress_to_vec_zlib(&pdf[start..end]).expect("deflated"))
}

#[test]
fn words_of_a_pdf_stand_beneath_their_strokes() {
    let pdf = written(|out| {
        write_pdf(out, &sheet(vec![text("A (b)", TextAnchor::End), text("Ωßш", TextAnchor::Start)]))
    });
    let content = content(&pdf);
    // Invisible, once; Latin-1 letters by their own codes, others by the first free ones.
    assert_eq!(content.matches("3 Tr\n").count(), 1, "{content}");
    assert!(content.contains("<4120286229> Tj ET"), "{content}");
    assert!(content.contains(" 50 40 Tm <80DF81> Tj ET"), "{content}");
    // The font's capitals are 0.562 of its size high.
    assert!(content.contains("BT /F 8.897 Tf"), "{content}");
    // It ends with the strokes: five letters of 0.6 of the size, stretched.
    let line = content.lines().find(|line| line.contains("<4120")).expect("the words");
    let numbers: Vec<f64> = line.split(' ').filter_map(|w| w.parse().ok()).collect();
    let [size, stretch, _, _, _, _, x, y] = numbers[..] else { panic!("{line}") };
    let end = x + 5.0 * 0.6 * size * stretch / 100.0;
    assert!((end - 50.0).abs() < 0.01 && y == 40.0, "{line}");
    let file = String::from_utf8_lossy(&pdf);
    assert!(file.contains("/BaseFont /Courier") && file.contains("<80> <03A9>"), "{file}");
    let without = written(|out| write_pdf(out, &sheet(Vec::new())));
    assert!(!String::from_utf8_lossy(&without).contains("/Font"));
}

#[test]
fn pdf_changes_its_state_only_where_it_must() {
    let marks = vec![
        stroke(&[(1.0, 2.0), (2.0, 2.0), (2.0, 3.0)], true, 1),
        stroke(&[(1.0, 2.0), (2.0, 2.0)], false, 2),
        stroke(&[(3.0, 2.0), (4.0, 2.0)], false, 2),
    ];
    let pdf = written(|out| write_pdf(out, &sheet(marks.clone())));
    let content = content(&pdf);
    let count = |part: &str| content.matches(part).count();
    // Dashes are reset before a pen without them; the opacity is set once.
    assert_eq!((count("[] 0 d"), count(" gs\n"), count(" RG\n")), (1, 1, 2), "{content}");
    assert!(content.contains("2 3 l\nh\nS\n"), "{content}");
    assert!(!String::from_utf8_lossy(&pdf).contains("/UserUnit"));
    // Viewers list the topmost layer first.
    let text = String::from_utf8_lossy(&pdf).into_owned();
    let list = |name: &str| {
        let from = text.find(name).expect("a list") + name.len();
        let list = &text[from..from + text[from..].find(']').expect("its end")];
        list.split("0 R").map(|id| id.trim_matches(|c| " [\n".contains(c)).to_owned()).collect()
    };
    let (on, mut order): (Vec<String>, Vec<String>) = (list("/ON"), list("/Order"));
    order.retain(|id| !id.is_empty());
    order.reverse();
    assert_eq!(
        on.iter().filter(|id| !id.is_empty()).collect::<Vec<_>>(),
        order.iter().collect::<Vec<_>>()
    );
    assert_eq!(order.len(), 2);
    // Pages larger than the format allows have a larger unit.
    let long = Sheet { size: DVec2::new(6000.0, 80.0), ..sheet(Vec::new()) };
    let pdf = written(|out| write_pdf(out, &long));
    assert!(String::from_utf8_lossy(&pdf).contains("/UserUnit 2"));
}

/// Returns a circle, an open chain of a line, an arc and a cubic curve, and a whole ellipse.
fn curves() -> Vec<PaperMark> {
    let at = DVec2::new;
    let arc = |center, axis, ratio, start, turn| EllipticArc { center, axis, ratio, start, turn };
    let whole = |arc: EllipticArc| {
        let start = arc.at(arc.start);
        Curve { start, pieces: vec![CurvePiece::Arc(arc, start)], closed: true }
    };
    let quarter = arc(at(30.0, 20.0), at(10.0, 0.0), 1.0, -FRAC_PI_2, FRAC_PI_2);
    let chain = Curve {
        start: at(10.0, 10.0),
        pieces: vec![
            CurvePiece::Line(at(30.0, 10.0)),
            CurvePiece::Arc(quarter, at(40.0, 20.0)),
            CurvePiece::Cubic(at(40.0, 25.0), at(45.0, 30.0), at(50.0, 30.0)),
        ],
        closed: false,
    };
    let curves = [
        whole(arc(at(20.0, 50.0), at(8.0, 0.0), 1.0, 0.0, TAU)),
        chain,
        whole(arc(at(70.0, 50.0), at(0.0, 10.0), 0.5, 0.0, -TAU)),
    ];
    curves.into_iter().map(|curve| PaperMark::Curve { curve, pen: 0 }).collect()
}

#[test]
fn svg_has_circles_arcs_and_cubic_curves() {
    let svg = utf8(written(|out| write_svg(out, &sheet(curves()))));
    let lines: Vec<&str> =
        svg.lines().filter(|l| l.starts_with("<circle") || l.starts_with("<path")).collect();
    assert_eq!(
        lines,
        [
            "<circle cx=\"20\" cy=\"50\" r=\"8\"/>",
            "<path d=\"M10 10h20a10 10 0 0 1 10 10c0 5 5 10 10 10\"/>",
            "<path d=\"M70 60a10 5 90 0 0 4.33-15a10 5 90 0 0-8.66 0a10 5 90 0 0 4.33 15z\"/>",
        ]
    );
    // Dashes fit the length of the curve: 50.265 mm of 11 periods.
    let dashed = PaperMark::Curve { curve: circle_of(&curves()), pen: 1 };
    let svg = utf8(written(|out| write_svg(out, &sheet(vec![dashed.clone()]))));
    assert!(svg.contains("<circle stroke-dasharray=\"3.0464 1.5232\" cx"), "{svg}");
}

fn circle_of(marks: &[PaperMark]) -> Curve {
    let PaperMark::Curve { curve, .. } = &marks[0] else { panic!("{marks:?}") };
    curve.clone()
}

#[test]
fn dxf_has_entities_for_curves_or_polylines_with_bulges() {
    let found = |strokes| {
        let text = utf8(written(|out| write_dxf(out, &sheet(curves()), strokes)));
        let (_, entities) = text.split_once("ENTITIES\n").expect("entities");
        let lines: Vec<&str> = entities.split("  0\nENDSEC").next().unwrap_or("").lines().collect();
        let tags: Vec<(String, String)> = lines
            .chunks(2)
            .map(|tag| (tag[0].trim().to_owned(), tag[1].to_owned()))
            .filter(|tag| !["5", "330", "100", "8", "370"].contains(&tag.0.as_str()))
            .collect();
        let text: Vec<String> =
            tags.iter().map(|(code, value)| format!("{code}={value}")).collect();
        text.join(" ")
    };
    let pieces = found(DxfStrokes::Pieces);
    for part in [
        "0=CIRCLE 10=20.0 20=30.0 30=0.0 40=8.0",
        "0=LINE 10=10.0 20=70.0 30=0.0 11=30.0 21=70.0 31=0.0",
        // A quarter turn, counter-clockwise with y up.
        "0=ARC 10=30.0 20=60.0 30=0.0 40=10.0 50=0.0 51=90.0",
        "0=SPLINE 210=0.0 220=0.0 230=1.0 70=8 71=3 72=8 73=4 74=0 40=0.0 40=0.0 40=0.0 40=0.0 40=1.0",
        "10=40.0 20=60.0 30=0.0 10=40.0 20=55.0 30=0.0 10=45.0 20=50.0 30=0.0 10=50.0 20=50.0 30=0.0",
        "0=ELLIPSE 10=70.0 20=30.0 30=0.0 11=0.0 21=-10.0 31=0.0 210=0.0 220=0.0 230=1.0 40=0.5 41=0.0 42=6.2831853072",
    ] {
        assert!(pieces.contains(part), "{part} in {pieces}");
    }
    let polylines = found(DxfStrokes::Polylines);
    assert_eq!(polylines.matches("0=LWPOLYLINE").count(), 3);
    // The tangent of a quarter of the angle; clockwise.
    assert!(polylines.contains("10=30.0 20=70.0 42=-0.4142135624 10=40.0 20=60.0"), "{polylines}");
}

#[test]
fn hpgl_draws_curves_as_chords() {
    let hpgl = utf8(written(|out| write_hpgl(out, &sheet(curves()[..1].to_vec()))));
    let down = hpgl.split("PD").nth(1).and_then(|t| t.split(';').next()).expect("a stroke");
    let numbers: Vec<f64> = down.split(',').map(|n| n.parse().expect("a number")).collect();
    assert!(numbers.len() > 80);
    for p in numbers.chunks(2) {
        let radius = (DVec2::new(p[0], p[1]) / 40.0).distance(DVec2::new(20.0, 30.0));
        assert!((radius - 8.0).abs() < 0.02, "{radius}");
    }
}

/// Returns a vertical dimension of 30 mm with an arrow.
fn dimension() -> PaperMark {
    let (a, b) = (DVec2::new(20.0, 60.0), DVec2::new(20.0, 30.0));
    let along = DVec2::new(0.0, -1.0);
    let arrow = points(&[(10.0, 60.0), (9.5, 57.0), (10.5, 57.0)]);
    let marks = vec![
        stroke(&[(10.0, 60.0), (10.0, 30.0)], false, 0),
        PaperMark::Fill { rings: vec![arrow], color: [0, 0, 0, 255], even_odd: false },
    ];
    let at = DVec2::new(9.0, 45.0);
    let words = DimensionText { at, along, text: "2× 15".to_owned(), height: 3.5, pen: 0 };
    PaperMark::Dimension(Box::new(Dimension {
        measure: Measure::Linear { ends: [a, b], line: DVec2::new(10.0, 60.0), along },
        value: 15.0,
        units_per_millimetre: 0.5,
        is_plain: false,
        marks,
        text: words,
    }))
}

#[test]
fn dimensions_are_entities_with_blocks() {
    let dxf = utf8(written(|out| write_dxf(out, &sheet(vec![dimension()]), DxfStrokes::Pieces)));
    let block = dxf.find("BLOCK\n  5\n").expect("blocks");
    for part in [
        "  2\n*D1\n 70\n1\n",
        "  0\nSOLID\n",
        " 50\n90.0\n 72\n1\n",
        "DIMENSION\n",
        "  2\n*D1\n 10\n10.0\n 20\n20.0\n",
        " 70\n160\n",
        "  1\n2x 15\n 42\n15.0\n  3\nISO-129-1\n",
        " 13\n20.0\n 23\n20.0\n 33\n0.0\n 14\n20.0\n 24\n50.0\n",
        " 50\n90.0\n100\nAcDbRotatedDimension\n",
        "144\n0.5\n",
    ] {
        assert!(dxf.contains(part), "{part:?} is not in\n{}", &dxf[block..]);
    }
}

#[test]
fn dimensions_are_drawn_where_nothing_knows_them() {
    let sheet = sheet(vec![dimension()]);
    let svg = utf8(written(|out| write_svg(out, &sheet)));
    assert!(svg.contains("aria-label=\"2× 15\"") && svg.contains("d=\"M10 60v-30\""), "{svg}");
    let hpgl = utf8(written(|out| write_hpgl(out, &sheet)));
    // Text runs upwards, left of x = 9 mm.
    assert!(
        hpgl.contains("PU400,800;PD400,2000") || hpgl.contains("PU400,2000;PD400,800"),
        "{hpgl}"
    );
    let letters = hpgl.split("PU").skip(1).filter_map(|t| t.split(',').next()?.parse::<i64>().ok());
    assert!(letters.filter(|x| (200..=360).contains(x)).count() >= 4, "{hpgl}");
    assert!(!written(|out| write_pdf(out, &sheet)).is_empty());
}

#[test]
fn groups_have_clip_paths_and_opacity() {
    let corner = points(&[(0.0, 0.0), (9.0, 0.0), (0.0, 9.0)]);
    let pieces = corner[1..].iter().chain(&corner[..1]).map(|p| CurvePiece::Line(*p)).collect();
    let rings = vec![Curve { start: corner[0], pieces, closed: true }];
    let area = PaperMark::Fill { rings: vec![corner], color: [1, 2, 3, 255], even_odd: true };
    let inner = MarkGroup { marks: vec![area.clone()], clip: None, opacity: 0.25 };
    let clip = Some(ClipPath { rings, even_odd: true });
    let marks =
        vec![stroke(&[(0.0, 0.0), (5.0, 5.0)], false, 1), PaperMark::Group(Box::new(inner)), area];
    let group = PaperMark::Group(Box::new(MarkGroup { marks, clip, opacity: 1.0 }));
    let sheet = sheet(vec![group, stroke(&[(1.0, 0.0), (9.0, 0.0)], false, 1)]);
    let svg = utf8(written(|out| write_svg(out, &sheet)));
    let clip = "<clipPath id=\"_1\"><path clip-rule=\"evenodd\" d=\"M0 0h9l-9 9v-9z\"/></clipPath>";
    let area = "<path fill=\"#010203\" fill-rule=\"evenodd\" stroke=\"none\" d=\"M0 0h9l-9 9z\"/>";
    for part in [
        &format!("{clip}\n<g clip-path=\"url(#_1)\">\n<path ")[..],
        &format!("<g opacity=\".25\">\n{area}\n</g>\n{area}\n</g>\n"),
    ] {
        assert!(svg.contains(part), "{part} is not in\n{svg}");
    }
    let pdf = written(|out| write_pdf(out, &sheet));
    let content = content(&pdf);
    for part in ["q\n0 0 m\n", "h\nW* n\n", "/A64 gs\n/X0 Do\n", "f*\nQ\n"] {
        assert!(content.contains(part), "{part} is not in\n{content}");
    }
    // The state before a group is that after it: the pen is set anew.
    assert!(content.ends_with("] 0 d\n1 0 m\n9 0 l\nS\nEMC\n/OC /L1 BDC\nEMC\n"), "{content}");
    assert!(content.matches(" w\n").count() == 2, "{content}");
    let text = String::from_utf8_lossy(&pdf);
    assert!(text.contains("/S /Transparency") && text.contains("/X0 "), "{text}");
    let drawing = durer::target::drawing::Drawing::default();
    for format in [DrawingFormat::Dxf, DrawingFormat::Hpgl, DrawingFormat::Gcode] {
        let options = FileOptions::default();
        let refused = drawing::write(&mut Vec::new(), format, &sheet, &drawing, &options);
        let message = refused.expect_err("groups").to_string();
        assert!(message.contains("a group of marks"), "{message}");
    }
}

#[test]
fn dxf_entities_of_other_pens_than_the_layer_have_their_own_colour() {
    let marks = vec![
        stroke(&[(0.0, 0.0), (5.0, 5.0)], false, 0),
        stroke(&[(1.0, 0.0), (9.0, 0.0)], false, 2),
    ];
    let sheet = sheet(marks);
    let dxf = utf8(written(|out| write_dxf(out, &sheet, DxfStrokes::Polylines)));
    let entities = &dxf[dxf.find("ENTITIES").expect("a section")..];
    let weights: Vec<&str> = entities.split("AcDbEntity").skip(1).collect();
    assert!(weights[0].starts_with("\n  8\nfirst\n370\n50\n100\n"), "{}", weights[0]);
    let own = "\n  8\nfirst\n 62\n1\n370\n70\n420\n16711712\n440\n33554560\n100\n";
    assert!(weights[1].starts_with(own), "{}", weights[1]);
}

#[test]
fn gradients_are_elements_and_shadings() {
    let corner = points(&[(0.0, 0.0), (9.0, 0.0), (0.0, 9.0)]);
    let pieces = corner[1..].iter().chain(&corner[..1]).map(|p| CurvePiece::Line(*p)).collect();
    let rings = vec![Curve { start: corner[0], pieces, closed: true }];
    let area = |shape: GradientShape, spread: Spread, alpha: u8| {
        let stops = vec![(0.0, [255, 0, 0, 255]), (0.5, [0, 0, 0, 255]), (1.0, [0, 0, 255, alpha])];
        let gradient = Gradient { shape, stops, spread, transform: DAffine2::IDENTITY };
        let rings = rings.clone();
        PaperMark::Gradient(Box::new(GradientArea { rings, even_odd: false, gradient }))
    };
    let line = GradientShape::Linear { start: DVec2::new(1.0, 2.0), end: DVec2::new(4.0, 2.0) };
    let (center, focus) = (DVec2::new(3.0, 4.0), DVec2::new(3.0, 5.0));
    let circle = GradientShape::Radial { center, radius: 2.0, focus, focus_radius: 0.0 };
    let marks = vec![
        area(line, Spread::Pad, 255),
        area(line, Spread::Pad, 255),
        area(circle, Spread::Pad, 128),
    ];
    let sheet = sheet(marks);
    let svg = utf8(written(|out| write_svg(out, &sheet)));
    let units = "gradientUnits=\"userSpaceOnUse\"";
    let stops = "<stop offset=\"0\" stop-color=\"#f00\"/><stop offset=\".5\" stop-color=\"#000\"/>";
    for part in [
        &format!("<linearGradient {units} x1=\"1\" y1=\"2\" x2=\"4\" y2=\"2\" id=\"_1\">{stops}")[..],
        "<path fill=\"url(#_1)\" d=\"M0 0h9l-9 9v-9z\"/>\n<path fill=\"url(#_1)\"",
        &format!(
            "<radialGradient {units} cx=\"3\" cy=\"4\" r=\"2\" fx=\"3\" fy=\"5\" id=\"_2\">{stops}"
        ),
        "<stop offset=\"1\" stop-color=\"#00f\" stop-opacity=\".502\"/></radialGradient>",
    ] {
        assert!(svg.contains(part), "{part} is not in\n{svg}");
    }
    let pdf = written(|out| write_pdf(out, &sheet));
    let operators = content(&pdf);
    for part in ["h\nW n\n/S0 sh\nQ\n", "h\nW n\n/G0 gs\n/S3 sh\nQ\n"] {
        assert!(operators.contains(part), "{part} is not in\n{operators}");
    }
    let text = String::from_utf8_lossy(&pdf);
    let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
    for part in [
        "/ShadingType 2 /ColorSpace /DeviceRGB /Coords [1 2 4 2] /Extend [true true]",
        "/ShadingType 3 /ColorSpace /DeviceGray /Coords [3 5 0 3 4 2] /Extend [true true]",
        "/Bounds [0.5] /Encode [0 1 0 1]",
    ] {
        assert!(text.contains(part), "{part} is not in\n{text}");
    }
    let drawing = durer::target::drawing::Drawing::default();
    let write = |format: DrawingFormat, sheet: &Sheet| {
        drawing::write(&mut Vec::new(), format, sheet, &drawing, &FileOptions::default())
    };
    for format in [DrawingFormat::Dxf, DrawingFormat::Hpgl, DrawingFormat::Gcode] {
        let message = write(format, &sheet).expect_err("gradients").to_string();
        assert!(message.contains("a gradient"), "{message}");
    }
    let end = DVec2::new(1.0 + 1e-3, 2.0);
    let often = self::sheet(vec![area(
        GradientShape::Linear { start: DVec2::new(1.0, 2.0), end },
        Spread::Repeat,
        255,
    )]);
    let message = write(DrawingFormat::Pdf, &often).expect_err("too often").to_string();
    assert!(message.contains("repeats more than"), "{message}");
    write(DrawingFormat::Svg, &often).expect("SVG repeats as often as wanted");
}
