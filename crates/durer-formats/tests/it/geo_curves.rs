//! Curves and surfaces of WKT and WKB, as lines and polygons.

use durer_formats::geo::{Geometry, read_all};

fn messages(text: &[u8], name: &str) -> (Vec<(String, usize)>, Vec<String>) {
    let (features, warnings) = read_all(text, name).expect("read");
    let kinds =
        features.iter().filter_map(|f| f.geometry.as_ref()).map(|g| (g.name().to_owned(), g.len()));
    (kinds.collect(), warnings.iter().map(ToString::to_string).collect())
}

#[test]
fn curves_of_wkt_become_lines_with_one_warning() {
    let text = "CIRCULARSTRING (0 0, 1 1, 2 0)
COMPOUNDCURVE ((0 0, 1 0), CIRCULARSTRING (1 0, 2 1, 3 0), (3 0, 4 0))
CURVEPOLYGON (CIRCULARSTRING (0 0, 4 0, 0 0), (1 0, 1.5 0, 1.5 0.5, 1 0))
CURVEPOLYGON (COMPOUNDCURVE ((0 0, 2 0), CIRCULARSTRING (2 0, 1 1, 0 0)))
MULTICURVE ((0 0, 1 1), CIRCULARSTRING (0 0, 1 1, 2 0))
MULTISURFACE (((0 0, 1 0, 1 1, 0 0)), CURVEPOLYGON (CIRCULARSTRING (0 0, 4 0, 0 0)))
CIRCULARSTRING EMPTY
CURVEPOLYGON Z EMPTY";
    let (kinds, warnings) = messages(text.as_bytes(), "a.wkt");
    let expected = [
        ("LineString", 65),
        ("LineString", 67),
        ("Polygon", 131),
        ("Polygon", 65),
        ("MultiLineString", 67),
        ("MultiPolygon", 131),
        ("LineString", 0),
        ("Polygon", 0),
    ];
    assert_eq!(kinds, expected.map(|(kind, count)| (kind.to_owned(), count)));
    assert_eq!(
        warnings,
        [
            "line 1, column 1, feature 1: 6 curves are flattened to lines of 32 edges per quarter turn"
        ]
    );
}

#[test]
fn surfaces_of_wkt_become_polygons() {
    let text = "TRIANGLE ((0 0, 1 0, 0 1, 0 0))
TIN Z (((0 0 1, 1 0 1, 0 1 1, 0 0 1)), ((1 0 1, 1 1 1, 0 1 1, 1 0 1)))
POLYHEDRALSURFACE (((0 0, 1 0, 0 1, 0 0)))
TIN EMPTY";
    let (kinds, warnings) = messages(text.as_bytes(), "a.wkt");
    let expected = [("Polygon", 3), ("MultiPolygon", 6), ("MultiPolygon", 3), ("MultiPolygon", 0)];
    assert_eq!(kinds, expected.map(|(kind, count)| (kind.to_owned(), count)));
    assert_eq!(warnings, Vec::<String>::new());
}

/// Returns well-known binary: a type, then the content.
fn wkb(kind: u32, rest: &[&[u8]]) -> Vec<u8> {
    [&[1], &kind.to_le_bytes()[..], &rest.concat()].concat()
}

fn run(points: &[(f64, f64)]) -> Vec<u8> {
    let numbers = points.iter().flat_map(|(x, y)| [x.to_le_bytes(), y.to_le_bytes()].concat());
    (points.len() as u32).to_le_bytes().into_iter().chain(numbers).collect()
}

#[test]
fn curves_of_wkb_are_those_of_wkt() {
    let one = 1_u32.to_le_bytes();
    let two = 2_u32.to_le_bytes();
    let arc = wkb(8, &[&run(&[(0.0, 0.0), (1.0, 1.0), (2.0, 0.0)])]);
    let back = wkb(2, &[&run(&[(2.0, 0.0), (0.0, 0.0)])]);
    let chain = wkb(9, &[&two, &arc, &back]);
    let surface = wkb(10, &[&one, &chain]);
    let triangle = wkb(17, &[&one, &run(&[(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (0.0, 0.0)])]);
    let tin = wkb(16, &[&one, &triangle]);
    let all = [
        &arc[..],
        &chain,
        &surface,
        &wkb(11, &[&one, &arc]),
        &wkb(12, &[&one, &surface]),
        &triangle,
        &tin,
    ];
    let (kinds, warnings) = messages(&all.concat(), "a.wkb");
    let expected = [
        ("LineString", 65),
        ("LineString", 66),
        ("Polygon", 65),
        ("MultiLineString", 65),
        ("MultiPolygon", 65),
        ("Polygon", 3),
        ("MultiPolygon", 3),
    ];
    assert_eq!(kinds, expected.map(|(kind, count)| (kind.to_owned(), count)));
    assert!(warnings[0].contains("5 curves are flattened"), "{warnings:?}");
    let (from_binary, _) = read_all(&arc, "a.wkb").expect("read");
    let (from_text, _) = read_all(b"CIRCULARSTRING (0 0, 1 1, 2 0)", "a.wkt").expect("read");
    assert_eq!(from_binary[0].geometry, from_text[0].geometry);
}

#[test]
fn neighbours_share_the_corners_of_an_arc() {
    let text =
        "CIRCULARSTRING (0.1 0.2, 1.3 1.1, 2.7 0.3)\nCIRCULARSTRING (2.7 0.3, 1.3 1.1, 0.1 0.2)";
    let (features, _) = read_all(text.as_bytes(), "a.wkt").expect("read");
    let [Some(Geometry::LineString(there)), Some(Geometry::LineString(back))] =
        [0, 1].map(|i| features[i].geometry.clone())
    else {
        panic!("two lines");
    };
    assert!(there.xy.iter().eq(back.xy.iter().rev()));
}
