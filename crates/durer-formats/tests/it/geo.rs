//! Geodata: every format reads what it wrote, and errors give the place.

use durer::clip::polygon::WindingRule;
use durer::math::{DVec2, Rect};
use durer_formats::geo::{
    Dimensions, Feature, GeoFormat, Geometry, Points, Reader, Writer, read_all,
};
use proptest::prelude::*;

fn features(format: GeoFormat, bytes: &[u8]) -> Vec<Feature> {
    let mut reader = Reader::new(format, bytes).expect("a reader");
    let mut all = Vec::new();
    while let Some(feature) = reader.next_feature().expect("a feature") {
        all.push(feature);
    }
    assert_eq!(reader.warnings(), []);
    all
}

fn written(format: GeoFormat, features: &[Feature]) -> Vec<u8> {
    let mut writer = Writer::new(format, Vec::new());
    features.iter().for_each(|feature| writer.write(feature).expect("memory"));
    writer.finish(&[]).expect("memory")
}

/// Returns the error message of reading a text.
fn error(format: GeoFormat, bytes: &[u8]) -> String {
    let mut reader = Reader::new(format, bytes).expect("a reader");
    loop {
        match reader.next_feature() {
            Ok(Some(_)) => {}
            Ok(None) => panic!("no error in {}", String::from_utf8_lossy(bytes)),
            Err(e) => return e.to_string(),
        }
    }
}

#[test]
fn a_line_that_is_cut_off_is_not_read_on() {
    let line = "{\"type\":\"Feature\",\"properties\":{},\"geometry\":{\"type\":\"Point\",\"coordinates\":[1,2]}}\n";
    for cut in [&line[..line.len() - 4], &line[..24], &line[..49]] {
        let text = [line, line, line, cut, "\n", line, line].concat();
        let messages = error(GeoFormat::GeoJson, text.as_bytes());
        assert!(
            messages.starts_with("line 4, ") || messages.starts_with("line 5, column 1:"),
            "{messages}"
        );
    }
    // Documents of several lines may precede others.
    let spread = line.replace(':', ":\n ");
    let texts = [[line, &spread, line, line], [&spread, &spread, line, &spread]];
    for text in texts.map(|parts| parts.concat()) {
        assert_eq!(features(GeoFormat::GeoJson, text.as_bytes()).len(), 4);
    }
}

#[test]
fn numbers_follow_the_grammar_of_json() {
    let point = |x: &str| format!("{{\"type\":\"Point\",\"coordinates\":[{x},2]}}");
    for x in ["01", "-01", "00", "1.", "-.5", "1.e5", ".5", "+1", "1e", "-Infinity", "-"] {
        let messages = error(GeoFormat::GeoJson, point(x).as_bytes());
        assert!(
            messages.contains("not a number of JSON") || messages.contains("a number is expected"),
            "{x}: {messages}"
        );
        assert!(messages.starts_with("line 1, column 32: "), "{x}: {messages}");
    }
    for (x, value) in [("0", 0.0), ("-0.5", -0.5), ("10", 10.0), ("0e1", 0.0), ("1E+2", 100.0)] {
        let read = features(GeoFormat::GeoJson, point(x).as_bytes());
        let Some(Geometry::Point(points)) = &read[0].geometry else { panic!("{x}") };
        assert_eq!(points.xy[0].x, value);
    }
}

#[test]
fn geojson_keeps_what_it_does_not_know() {
    let text = r#"{ "type":"FeatureCollection", "name":"n\u00e4h", "bbox":[0,0,1,1], "features":[
 {"type":"Feature","id":"a","bbox":[1,2,1,2],"style":{"x":1.50},"properties":{"n":1e3,"s":"\"}]"},"geometry":{"type":"Point","coordinates":[1,2.0,3]}},
 {"type":"Feature","properties":null,"geometry":null} ], "crs":{"k":[1, 2]} }"#;
    let mut reader = Reader::new(GeoFormat::GeoJson, text.as_bytes()).expect("a reader");
    let first = reader.next_feature().expect("read").expect("a feature");
    assert_eq!(first.properties.as_deref(), Some(r#"{"n":1e3,"s":"\"}]"}"#));
    assert_eq!(first.id.as_deref(), Some("\"a\""));
    assert_eq!(reader.members().len(), 0);
    let mut writer = Writer::new(GeoFormat::GeoJson, Vec::new());
    writer.write(&first).expect("memory");
    while let Some(feature) = reader.next_feature().expect("read") {
        writer.write(&feature).expect("memory");
    }
    let out = writer.finish(reader.members()).expect("memory");
    let expected = r#"{"type":"FeatureCollection","features":[
{"type":"Feature","id":"a","style":{"x":1.50},"properties":{"n":1e3,"s":"\"}]"},"geometry":{"type":"Point","coordinates":[1,2,3]}},
{"type":"Feature","properties":null,"geometry":null}
],"name":"n\u00e4h","crs":{"k":[1, 2]}}
"#;
    assert_eq!(String::from_utf8_lossy(&out), expected);
}

#[test]
fn every_layout_of_geojson_is_read() {
    let point = r#"{"type":"Point","coordinates":[1,2]}"#;
    for text in [
        point.to_owned(),
        format!("\u{feff}{point}\r\n{point}\n\n{point}"),
        format!("\x1e{point}\n\x1e{point}\n"),
        format!(
            r#"{{"features":[{{"geometry":{point},"type":"Feature"}}],"type":"FeatureCollection"}}"#
        ),
        format!(
            r#"{{"type":"FeatureCollection","features":[]}}{{"type":"Feature","geometry":{point}}}"#
        ),
    ] {
        let all = features(GeoFormat::GeoJson, text.as_bytes());
        assert!(!all.is_empty() && all.iter().all(|f| f.geometry.is_some()), "{text}");
    }
}

#[test]
fn a_million_features_need_no_memory() {
    /// The same line over and over.
    struct Lines(u64);
    impl std::io::Read for Lines {
        fn read(&mut self, out: &mut [u8]) -> std::io::Result<usize> {
            let line = b"{\"type\":\"Point\",\"coordinates\":[1,2]}\n";
            if self.0 == 0 {
                return Ok(0);
            }
            self.0 -= 1;
            out[..line.len()].copy_from_slice(line);
            Ok(line.len())
        }
    }
    let mut reader = Reader::new(GeoFormat::GeoJsonSeq, Lines(100_000)).expect("a reader");
    let mut count = 0;
    while reader.next_feature().expect("a feature").is_some() {
        count += 1;
    }
    assert_eq!(count, 100_000);
}

#[test]
fn errors_of_geojson_say_where() {
    for (text, expected) in [
        ("{\"type\":\"Point\",\n \"coordinates\":[1,x]}", "line 2, column 19: a number"),
        ("\n{\"type\":\"Point\",\"coordinates\":[1]}", "line 2, column 31: a position"),
        ("{\"type\":\"Point\",\"coordinates\":[NaN,1]}", "line 1, column 32: a number"),
        (
            "{\"type\":\"Point\",\"coordinates\":[1e999,1]}",
            "line 1, column 32: the number is too large",
        ),
        ("{\"type\":\"LineString\",\"coordinates\":[1,2]}", "line 1, column 37: a position"),
        ("{\"type\":\"Blob\",\"coordinates\":[1,2]}", "line 1, column 1: `Blob`"),
        ("{\"type\":\"Topology\"}", "TopoJSON within GeoJSON is not supported"),
        (
            "{\"type\":\"Feature\",\"properties\":[],\"geometry\":null}",
            "line 1, column 32, feature 1: properties",
        ),
        (
            "{\"type\":\"Feature\",\"properties\":{\"a\":tru},\"geometry\":null}",
            "line 1, column 40, feature 1: a value is expected",
        ),
        ("{\"type\":\"FeatureCollection\",\"features\":[{\"type\":", "ends within a value"),
        ("{\"features\":[]}", "line 1, column 1: an object with features"),
        ("[1,2]", "line 1, column 1: a GeoJSON object"),
    ] {
        let message = error(GeoFormat::GeoJson, text.as_bytes());
        assert!(message.contains(expected), "{text}: {message}");
    }
}

#[test]
fn repairs_are_reported() {
    let polygon = |rings: &str| format!("{{\"type\":\"Polygon\",\"coordinates\":[{rings}]}}");
    for (text, rings, messages) in [
        (
            polygon("[[0,0],[4,0],[4,4]]"),
            1,
            "line 1, column 34, feature 1: the ring is not closed; closed",
        ),
        (polygon("[[0,0],[4,0],[0,0]]"), 0, "a ring needs four positions"),
        (polygon("[[0,0],[4,0],[0,0]],[[1,1],[2,1],[2,2],[1,1]]"), 0, "left out too"),
    ] {
        let (features, warnings) = read_all(text.as_bytes(), "").expect("read");
        assert!(matches!(&features[0].geometry, Some(Geometry::Polygon(r)) if r.len() == rings));
        assert!(warnings.iter().any(|w| w.to_string().contains(messages)), "{warnings:?}");
    }
}

#[test]
fn wkt_is_read_in_all_its_spellings() {
    let text = "SRID=4326;POINT(1 2)\npoint z (1 2 3);POINTM(1 2 9) POINT ZM (1 2 3 9)
MULTIPOINT(1 2,3 4) MULTIPOINT((1 2),EMPTY,\n(3 4))\nPOLYGON EMPTY
GEOMETRYCOLLECTION(POINT(1 2),LINESTRING(0 0,1 1))\nPOLYGON((0 0,4 0,4 4,0 0),(1 1,2 1,2 2,1 1))";
    let all = features(GeoFormat::Wkt, text.as_bytes());
    let kinds: Vec<_> = all
        .iter()
        .filter_map(|f| f.geometry.as_ref())
        .map(|g| (g.name(), g.dimensions(), g.len()))
        .collect();
    use Dimensions::{Xy, Xym, Xyz, Xyzm};
    assert_eq!(
        kinds,
        [
            ("Point", Xy, 1),
            ("Point", Xyz, 1),
            ("Point", Xym, 1),
            ("Point", Xyzm, 1),
            ("MultiPoint", Xy, 2),
            ("MultiPoint", Xy, 2),
            ("Polygon", Xy, 0),
            ("GeometryCollection", Xy, 3),
            ("Polygon", Xy, 6)
        ]
    );
    assert_eq!((all[0].srid, all[1].srid), (Some(4326), None));
    for (text, expected) in [
        (
            "POINT (1 2)\nPOINT (1)",
            "line 2, column 9, feature 2: a position of 2 numbers is expected, this one has 1",
        ),
        ("POINT (1 nan)", "line 1, column 10, feature 1: coordinates must be finite"),
        ("POLYGON ((0 0, 1 1", "the end of the file"),
        ("LINESTRING (0 0, 1 1 2)", "this one has 3"),
        (
            "CIRCULARSTRING (0 0, 1 1)",
            "line 1, column 16, feature 1: arcs need an odd number of positions",
        ),
        ("CURVE (0 0, 1 1, 2 0)", "line 1, column 1, feature 1: `CURVE` is not a type"),
        ("BLOB (1 2)", "line 1, column 1, feature 1: `BLOB` is not a type"),
        ("POINT (1 2))", "line 1, column 12, feature 1: the end of the geometry"),
    ] {
        let message = error(GeoFormat::Wkt, text.as_bytes());
        assert!(message.contains(expected), "{text}: {message}");
    }
    let deep = "GEOMETRYCOLLECTION(".repeat(100_000);
    assert!(error(GeoFormat::Wkt, deep.as_bytes()).contains("nested too deep"));
}

#[test]
fn wkb_of_both_byte_orders_and_postgis_is_read() {
    for (hex, expected) in [
        ("0101000000000000000000F03F0000000000000040", "POINT (1 2)"),
        ("00000000013FF00000000000004000000000000000", "POINT (1 2)"),
        ("01E9030000000000000000F03F00000000000000400000000000000840", "POINT Z (1 2 3)"),
        (
            "01010000A0E6100000000000000000F03F00000000000000400000000000000840",
            "SRID=4326;POINT Z (1 2 3)",
        ),
        ("0101000040000000000000F03F00000000000000400000000000000840", "POINT M (1 2 3)"),
        ("0101000000000000000000F87F000000000000F87F", "POINT EMPTY"),
    ] {
        let all = features(GeoFormat::WkbHex, hex.as_bytes());
        let text = written(GeoFormat::Wkt, &all);
        assert_eq!(String::from_utf8_lossy(&text).trim(), expected, "{hex}");
    }
    for (hex, expected) in [
        (
            "0102000000FFFFFFFF",
            "column 11, feature 1: a count of 4294967295, but only 0 bytes are left",
        ),
        ("0101000000", "line 1, column 11, feature 1: the data end"),
        ("010D000000", "type 13 is not supported"),
        ("05", "byte order 5"),
        ("01010000000000000000F07F0000000000000040", "the data end"),
        (
            "0101000000000000000000F07F0000000000000040",
            "column 11, feature 1: coordinates must be finite",
        ),
        ("01zz", "column 3, feature 1: two hexadecimal digits"),
    ] {
        let message = error(GeoFormat::WkbHex, hex.as_bytes());
        assert!(message.contains(expected), "{hex}: {message}");
    }
    let deep = [&b"\x01\x07\0\0\0\x01\0\0\0"[..]; 5000].concat();
    assert!(error(GeoFormat::Wkb, &deep).contains("nested too deep"));
}

#[test]
fn shapes_of_svg_are_read_and_written() {
    let svg = r#"<svg xmlns="http://www.w3.org/2000/svg"><g id="g" transform="translate(10 0)">
<path d="M0,0h4v4H0zm1,1l1 0 0 1z"/><polyline id="p" points="0,0 1,2"/><text>a</text>
<rect x="1" y="2" width="3" height="4" transform="scale(2)"/><path d="M0 0Q1 2 2 0"/></g></svg>"#;
    let (all, warnings) = read_all(svg.as_bytes(), "").expect("read");
    let names: Vec<_> =
        all.iter().filter_map(|f| f.geometry.as_ref()).map(Geometry::name).collect();
    assert_eq!(names, ["MultiPolygon", "LineString", "Polygon", "LineString"]);
    assert_eq!(all[0].id.as_deref(), Some("\"g\""));
    assert!(
        warnings.len() == 1 && warnings[0].to_string().starts_with("line 2, column"),
        "{warnings:?}"
    );
    let bounds = all[2].geometry.as_ref().and_then(Geometry::bounds).expect("bounds");
    assert_eq!((bounds.min(), bounds.max()), (DVec2::new(12.0, -12.0), DVec2::new(18.0, -4.0)));
    let again = read_all(&written(GeoFormat::Svg, &all), "").expect("read").0;
    let bare =
        |all: &[Feature]| all.iter().map(|f| (f.geometry.clone(), f.fill_rule)).collect::<Vec<_>>();
    assert_eq!(bare(&again), bare(&all));
    assert!(read_all(b"<svg><g", "").expect_err("cut").to_string().contains("line 1"));
}

#[test]
fn points_of_svg_come_back_as_points() {
    let text = r#"{"type":"FeatureCollection","features":[
        {"type":"Feature","properties":null,"geometry":{"type":"Point","coordinates":[1,1]}},
        {"type":"Feature","properties":null,"geometry":{"type":"MultiPoint","coordinates":[[1,2],[3,4]]}}]}"#;
    let all = read_all(text.as_bytes(), "").expect("read").0;
    let again = read_all(&written(GeoFormat::Svg, &all), "").expect("read").0;
    let bare = |all: &[Feature]| all.iter().map(|f| f.geometry.clone()).collect::<Vec<_>>();
    assert_eq!(bare(&again), bare(&all));
    let mixed = read_all(b"<svg><path d='M1 1h0M0 0h3M0 0h3v3z'/></svg>", "").expect("read").0;
    let Some(Geometry::Collection(parts)) = &mixed[0].geometry else { panic!("{mixed:?}") };
    let names: Vec<_> = parts.iter().map(Geometry::name).collect();
    assert_eq!(names, ["Polygon", "LineString", "Point"]);
}

#[test]
fn fill_rules_of_svg_are_read_where_they_stand() {
    let path = "d='M0 0h9v9h-9z'";
    let text = format!(
        "<svg><path {path}/><g fill-rule='evenodd'><path {path}/><path {path} fill-rule='nonzero'/>\
         <path {path} fill-rule='nonzero' style='fill: red; fill-rule : evenodd'/><g><path {path}/></g>\
         <path {path} style='fill-rule:inherit'/></g><path {path} fill-rule='evenodd'/></svg>"
    );
    let found: Vec<WindingRule> =
        read_all(text.as_bytes(), "").expect("read").0.iter().map(|f| f.fill_rule).collect();
    let (odd, not) = (WindingRule::EvenOdd, WindingRule::NonZero);
    assert_eq!(found, [not, odd, not, odd, odd, odd, odd]);
}

/// Returns names and bounds of all shapes, and the warnings.
fn svg_shapes(content: &str) -> (Vec<(String, Rect)>, Vec<String>) {
    let (all, warnings) = read_all(format!("<svg>{content}</svg>").as_bytes(), "").expect("read");
    let shapes = all.iter().map(|f| {
        let bounds = f.geometry.as_ref().and_then(Geometry::bounds).expect("a shape");
        (f.id.clone().unwrap_or_default(), bounds)
    });
    (shapes.collect(), warnings.iter().map(ToString::to_string).collect())
}

#[test]
fn what_an_svg_does_not_draw_is_left_out() {
    let rect = "<rect width='2' height='1'/>";
    for around in ["defs", "clipPath", "mask", "symbol", "pattern", "marker", "metadata"] {
        let (shapes, warnings) = svg_shapes(&format!("<{around}><g>{rect}</g></{around}>"));
        assert!(shapes.is_empty() && warnings.is_empty(), "{around}: {shapes:?} {warnings:?}");
    }
    for (content, count) in [
        (format!("<g display='none'>{rect}<g display='inline'>{rect}</g></g>{rect}"), 1),
        (format!("<g style='DISPLAY: none'>{rect}</g>"), 0),
        (format!("<g visibility='hidden'>{rect}<g visibility='visible'>{rect}</g></g>"), 1),
        (format!("<g style='display:none!important;display:inline'>{rect}</g>"), 0),
        (format!("<g style='/*display:none*/'>{rect}</g>"), 1),
        (format!("<defs><text>a</text></defs>{rect}"), 1),
    ] {
        let (shapes, warnings) = svg_shapes(&content);
        assert_eq!((shapes.len(), warnings.len()), (count, 0), "{content}: {warnings:?}");
    }
}

#[test]
fn uses_of_svg_show_shapes_elsewhere() {
    let rect =
        |x: f64, y: f64| Rect::new(DVec2::new(x, -y - 1.0), DVec2::new(x + 2.0, -y)).unwrap();
    let shape = "<rect id='r' width='2' height='1'/>";
    for (content, expected) in [
        (
            format!("<defs>{shape}</defs><use href='#r' x='3' y='4'/>"),
            vec![("\"r\"", rect(3.0, 4.0))],
        ),
        // Before the shape, by XLink, at another position, with its own name.
        (
            format!("<use id='u' xlink:href='#r' transform='translate(5)' x='1'/>{shape}"),
            vec![("\"u\"", rect(6.0, 0.0)), ("\"r\"", rect(0.0, 0.0))],
        ),
        (
            format!("<symbol id='s'><g>{shape}</g></symbol><g id='g'><use href='#s' x='1'/></g>"),
            vec![("\"g\"", rect(1.0, 0.0))],
        ),
        (
            format!(
                "<defs>{shape}<use id='v' href='#r' x='1'/></defs><use href='#v' x='2'><title/></use>{shape}"
            ),
            vec![("\"v\"", rect(3.0, 0.0)), ("\"r\"", rect(0.0, 0.0))],
        ),
        (
            format!(
                "<defs><g id='g'>{shape}<path d='M0 0h2v1z'/></g></defs><use href='#g' y='7'/>"
            ),
            vec![("\"r\"", rect(0.0, 7.0)), ("\"g\"", rect(0.0, 7.0))],
        ),
    ] {
        let expected: Vec<_> = expected.into_iter().map(|(id, r)| (id.to_owned(), r)).collect();
        assert_eq!(svg_shapes(&content), (expected, vec![]), "{content}");
    }
    let text = format!(
        "<svg fill-rule='nonzero'><defs>{shape}</defs><use href='#r' fill-rule='evenodd'/></svg>"
    );
    assert_eq!(read_all(text.as_bytes(), "").expect("read").0[0].fill_rule, WindingRule::EvenOdd);
}

#[test]
fn uses_of_svg_that_cannot_be_followed_are_reported() {
    for (content, messages) in [
        ("<use/>", "needs an `href`"),
        ("<use href='#a'/>", "`use` of `#a`, which is not there"),
        ("<use href='b.svg#a'/>", "is in another file"),
        ("<g id='a'><use href='#a'/></g>", "which it is part of"),
        ("<use id='a' href='#a'/>", "which it is part of"),
        (
            "<symbol id='a' viewBox='0 0 1 1'><rect/></symbol><use href='#a'/>",
            "`viewBox` of a `symbol`",
        ),
        ("<svg viewBox='0 0 9 9'><rect width='1' height='1'/></svg>", "`viewBox` of a `svg`"),
    ] {
        let (shapes, warnings) = svg_shapes(content);
        assert!(shapes.is_empty(), "{content}: {shapes:?}");
        assert!(warnings.len() == 1 && warnings[0].contains(messages), "{content}: {warnings:?}");
    }
    let ring = "<use id='a' href='#b'/><use id='b' href='#c'/><use id='c' href='#a'/>";
    let (shapes, warnings) = svg_shapes(ring);
    assert_eq!((shapes.len(), warnings.len()), (0, 3), "{warnings:?}");
    // Forty levels of two would be 2⁴⁰ shapes.
    let doubled: String = (0..40)
        .map(|i| format!("<g id='g{}'><use href='#g{i}'/><use href='#g{i}'/></g>", i + 1))
        .collect();
    let text = format!("<svg><defs><path id='g0' d=''/>{doubled}</defs><use href='#g40'/></svg>");
    let messages = error(GeoFormat::Svg, text.as_bytes());
    assert!(messages.contains("the length of the text that `use` shows is 671"), "{messages}");
}

#[test]
fn lengths_of_svg_have_units() {
    let wide = |length: &str| {
        let (shapes, warnings) = svg_shapes(&format!("<rect width='{length}' height='1'/>"));
        (shapes.first().map(|(_, bounds)| bounds.size().x), warnings)
    };
    for (length, pixels) in [
        ("3px", 3.0),
        ("1in", 96.0),
        ("2.54cm", 96.0),
        ("25.4MM", 96.0),
        ("9pt ", 12.0),
        ("1pc", 16.0),
    ] {
        let (found, warnings) = wide(length);
        let found = found.expect("a rectangle");
        assert!((found - pixels).abs() < 1e-9 && warnings.is_empty(), "{length}: {found}");
    }
    for length in ["50%", "2em", "3 4", "1furlong"] {
        let (found, warnings) = wide(length);
        let messages = format!("`width` is `{length}`; a number, or one in px,");
        assert!(found.is_none() && warnings[0].contains(&messages), "{length}: {warnings:?}");
    }
}

#[test]
fn declarations_of_svg_follow_css() {
    let rule = |style: &str| {
        let text = format!("<svg><path d='M0 0h9v9h-9z' {style}/></svg>");
        let (all, warnings) = read_all(text.as_bytes(), "").expect("read");
        (all[0].fill_rule, warnings.len())
    };
    let (odd, not) = (WindingRule::EvenOdd, WindingRule::NonZero);
    for (style, expected) in [
        ("style='fill:red/*;*/;fill-rule:/**/evenodd'", (odd, 0)),
        ("style='fill-rule:evenodd ! important;fill-rule:nonzero'", (odd, 0)),
        ("style='fill-rule:nonzero;fill-rule:evenodd'", (odd, 0)),
        ("style='Fill-Rule:EvenOdd'", (odd, 0)),
        ("style='fill-rule:evenodd /* without end'", (odd, 0)),
        ("style='/*fill-rule:evenodd'", (not, 0)),
        // After declarations without a meaning here.
        ("style='font:12px/1.5 serif;fill-rule:evenodd'", (odd, 0)),
        ("style='--own:1;fill:;:;nothing;fill-rule:evenodd'", (odd, 0)),
        ("style='width:calc((1px + 1px)/2);fill-rule:evenodd ! IMPORTANT'", (odd, 0)),
        ("fill-rule='odd'", (not, 1)),
    ] {
        assert_eq!(rule(style), expected, "{style}");
    }
}

#[test]
fn bad_svg_is_reported() {
    for (text, messages) in [
        ("<svg><g>", "line 1, column 9: the file ends within `g`"),
        ("<svg></g></svg>", "`</svg>` is expected, not `</g>`"),
        ("<svg/></svg>", "`svg` ends, but has not begun"),
        ("<svg/><svg/>", "a second element"),
        ("<kml><svg/></kml>", "the document is a `kml`"),
        ("<svg/>\nwords", "there is text outside"),
        ("<!-- nothing -->", "there is no svg element"),
        ("", "there is no svg element"),
    ] {
        let found = error(GeoFormat::Svg, text.as_bytes());
        assert!(found.contains(messages), "{text}: {found}");
    }
    for (shape, count, messages) in [
        ("<polygon points='0,0 1,0 1,1 2'/>", 1, "an x without a y"),
        ("<rect width='-1' height='1'/>", 0, "`width` is -1"),
        ("<circle r='-1'/>", 0, "`r` is -1"),
        ("<switch><rect width='1' height='1'/></switch>", 1, "`switch` draws one"),
        ("<style>path{fill-rule:evenodd}</style>", 0, "style sheets are not read"),
    ] {
        let (shapes, warnings) = svg_shapes(shape);
        assert_eq!((shapes.len(), warnings.len()), (count, 1), "{shape}: {warnings:?}");
        assert!(warnings[0].contains(messages), "{shape}: {warnings:?}");
    }
    // A million curves have 16 positions each, and no more are kept.
    let long = format!("<path d='M0 0{}'/>", "q1 0 1 1".repeat((1 << 20) + 1));
    let (shapes, warnings) = svg_shapes(&long);
    assert!(shapes.is_empty() && warnings[0].contains("more than 16777216 positions"));
    // Shapes before the fault are read.
    let mut reader =
        Reader::new(GeoFormat::Svg, &b"<svg><path d='M0 0h1'/><g>"[..]).expect("a reader");
    assert!(reader.next_feature().expect("a shape").is_some());
    assert!(reader.next_feature().is_err());
}

/// Checks that the position of each item is counted from the one before, not each time from the start.
#[test]
fn many_small_things_take_no_longer_than_few_large_ones() {
    let points: String = (0..200_000).map(|i| format!("POINT ({i} 1)\n")).collect();
    assert_eq!(features(GeoFormat::Wkt, points.as_bytes()).len(), 200_000);
    let words = format!("<svg>{}</svg>", "<text>a</text>\n".repeat(200_000));
    assert_eq!(read_all(words.as_bytes(), "").expect("read").1.len(), 1000);
    let late = format!("{points}POINT (1)");
    assert!(
        error(GeoFormat::Wkt, late.as_bytes())
            .starts_with("line 200001, column 9, feature 200001:")
    );
}

#[test]
fn files_with_nothing_in_them_have_no_features() {
    for format in GeoFormat::ALL {
        if format.streams() {
            assert_eq!(features(format, b""), [], "{format}");
        } else {
            let found = Reader::new(format, &b""[..]).and_then(|mut reader| reader.next_feature());
            assert!(found.is_err(), "{format} has a head");
        }
    }
    let nothing = [GeoFormat::GeoJson, GeoFormat::GeoJsonSeq, GeoFormat::GeoJsonRs, GeoFormat::Wkt];
    for format in nothing {
        assert_eq!(features(format, b" \n"), [], "{format}");
    }
}

#[test]
fn numbers_of_coordinate_systems_fit_32_bits() {
    for (text, messages) in [
        (
            "SRID=99999999999;POINT(1 2)",
            "the SRID 99999999999 must be from -2147483648 to 2147483647",
        ),
        ("SRID=99999999999999999999999;POINT(1 2)", "the SRID 1e23 must"),
        ("SRID=x;POINT(1 2)", "the number of a coordinate system is expected, not `x`"),
    ] {
        let found = error(GeoFormat::Wkt, text.as_bytes());
        assert!(found.contains(messages), "{found}");
    }
}

#[test]
fn lines_of_svg_are_a_pixel_wide_for_any_viewer() {
    let line = r#"{"type":"LineString","coordinates":[[0,0],[9.8,4.9]]}"#;
    let all = read_all(line.as_bytes(), "").expect("read").0;
    let text = String::from_utf8(written(GeoFormat::Svg, &all)).expect("text");
    // 1000 pixels for 9.8 units and a margin of 1 % on each side.
    let width = text.split("path{stroke-width:").nth(1).and_then(|rest| rest.split('}').next());
    let width: f64 = width.and_then(|w| w.parse().ok()).expect("a width");
    assert!((width - 9.8 * 1.02 / 1000.0).abs() < 1e-12, "{width}");
    assert!(!text.contains("vector-effect"), "viewers that do not know it draw degrees wide");
}

/// Returns the points of the one shape of a document, y up.
fn svg_points(shape: &str) -> Vec<DVec2> {
    let text = format!("<svg>{shape}</svg>");
    let (all, warnings) = read_all(text.as_bytes(), "").expect("read");
    assert_eq!((all.len(), warnings.len()), (1, 0), "{shape}");
    let mut points = Vec::new();
    let geometry = all[0].geometry.as_ref().expect("a shape");
    geometry.for_each(&mut |part| points.extend(&part.xy));
    points
}

#[test]
fn arcs_of_svg_lie_on_their_ellipses() {
    // Radii (3, 2) around (5, 1), turned by 90°; y is flipped afterwards.
    for flags in ["0 0", "0 1", "1 0", "1 1", "01", "11"] {
        let points = svg_points(&format!("<path d='M5 4A3 2 90 {flags}3 1'/>"));
        let (large, sweep) = (flags.starts_with('1'), flags.ends_with('1'));
        assert_eq!(points.len(), if large { 49 } else { 17 }, "{flags}");
        assert_eq!(
            (points[0], points[points.len() - 1]),
            (DVec2::new(5.0, -4.0), DVec2::new(3.0, -1.0))
        );
        // Both ends are a quarter turn apart on two ellipses; the flags choose the ellipse and the direction.
        let center = if large == sweep { DVec2::new(3.0, -4.0) } else { DVec2::new(5.0, -1.0) };
        for p in &points {
            let q = (*p - center) / DVec2::new(2.0, 3.0);
            assert!((q.length() - 1.0).abs() < 1e-12, "{flags}: {p}");
        }
    }
    // Radii that are too small are enlarged; without radii the arc is a line.
    let half = svg_points("<path d='M0 0a1 1 0 0 1 8 0'/>");
    assert!(
        half.iter().all(|p| (p.distance(DVec2::new(4.0, 0.0)) - 4.0).abs() < 1e-12 && p.y > -1e-12)
    );
    assert_eq!(svg_points("<path d='M0 0A0 1 0 0 1 8 0'/>").len(), 2);
    let text = "<svg><path d='M0 0A1 1 0 2 1 8 0'/></svg>";
    assert!(
        read_all(text.as_bytes(), "").expect("read").1[0].to_string().contains("must be 0 or 1")
    );
}

#[test]
fn circles_and_round_corners_of_svg_are_read() {
    let circle = svg_points("<circle cx='1' cy='2' r='3'/>");
    let ellipse = svg_points("<ellipse cx='1' cy='2' rx='3' ry='3'/>");
    assert_eq!((circle.len(), &circle), (64, &ellipse));
    assert!(circle.iter().all(|p| (p.distance(DVec2::new(1.0, -2.0)) - 3.0).abs() < 1e-12));
    assert!(circle.contains(&DVec2::new(4.0, -2.0)) && circle.contains(&DVec2::new(1.0, -5.0)));
    let round = svg_points("<rect x='1' y='2' width='10' height='4' rx='9' ry='1'/>");
    let (low, high) = (DVec2::new(1.0, -6.0), DVec2::new(11.0, -2.0));
    assert!(round.iter().all(|p| p.cmpge(low).all() && p.cmple(high).all()), "{round:?}");
    assert!(round.contains(&DVec2::new(1.0, -3.0)) && round.contains(&DVec2::new(6.0, -2.0)));
    assert_eq!(svg_points("<rect width='2' height='2' rx='auto'/>").len(), 4);
    let none = read_all(b"<svg><circle r='0'/><rect width='2'/></svg>", "").expect("read");
    assert!(none.0.is_empty() && none.1.is_empty());
}

fn points(dimensions: Dimensions, least: usize) -> impl Strategy<Value = Points> {
    let number = || prop_oneof![-1e3..1e3f64, -4.0..4.0f64, Just(0.1), Just(1e-9), Just(-1e300)];
    let vertex = (number(), number(), number(), number());
    prop::collection::vec(vertex, least..least + 4).prop_map(move |all| {
        let mut points = Points::new(dimensions);
        for (x, y, z, m) in all {
            let z = if dimensions.has_z() { z } else { 0.0 };
            points.push(DVec2::new(x, y), [z, if dimensions.has_m() { m } else { 0.0 }]);
        }
        // An open ring whose end equals its beginning would be taken for a closed one.
        if points.xy.first() == points.xy.last() && points.len() > 1 {
            points.xy[0].x += 1.0;
        }
        points
    })
}

fn geometry() -> impl Strategy<Value = Geometry> {
    let dimensions = prop::sample::select(vec![
        Dimensions::Xy,
        Dimensions::Xyz,
        Dimensions::Xym,
        Dimensions::Xyzm,
    ]);
    dimensions.prop_flat_map(|d| {
        let rings = || prop::collection::vec(points(d, 3), 1..3);
        let simple = prop_oneof![
            points(d, 1).prop_map(|mut p| {
                while p.len() > 1 {
                    p.pop();
                }
                Geometry::Point(p)
            }),
            points(d, 2).prop_map(Geometry::LineString),
            points(d, 1).prop_map(Geometry::MultiPoint),
            rings().prop_map(Geometry::Polygon),
            prop::collection::vec(points(d, 2), 1..3).prop_map(Geometry::MultiLineString),
            prop::collection::vec(rings(), 1..3).prop_map(Geometry::MultiPolygon),
        ];
        prop_oneof![
            4 => simple.clone(),
            1 => prop::collection::vec(simple, 1..3).prop_map(Geometry::Collection),
        ]
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(10_000))]

    #[test]
    fn every_format_gives_back_what_it_was_given(
        geometries in prop::collection::vec(geometry(), 1..4),
        srid in prop::option::of(1..99999i32),
    ) {
        let all: Vec<Feature> = geometries.into_iter().map(Feature::of_geometry).collect();
        // The others have their own tests: they keep fields, and not all dimensions of empty geometries.
        for format in GeoFormat::ALL.into_iter().filter(|f| f.streams()) {
            let mut all = all.clone();
            if format.is_geojson() {
                // GeoJSON has no measures without heights.
                all.retain(|f| f.geometry.as_ref().is_some_and(|g| g.dimensions() != Dimensions::Xym));
            } else {
                all.iter_mut().for_each(|f| f.srid = srid);
            }
            if !all.is_empty() {
                prop_assert_eq!(features(format, &written(format, &all)), all, "{}", format);
            }
        }
    }

    #[test]
    fn no_bytes_make_readers_panic(
        text in "[ -~\n]{0,80}",
        cut in 0usize..400,
        at in 0usize..400,
        byte in any::<u8>(),
        given in geometry(),
    ) {
        for format in GeoFormat::ALL {
            let mut writer = Writer::new(format, Vec::new());
            // A Shapefile refuses geometries of different kinds.
            let whole = writer.write(&Feature::of_geometry(given.clone())).and_then(|()| writer.finish(&[]));
            let mut bytes = whole.unwrap_or_default();
            if let Some(place) = bytes.get_mut(at) {
                *place = byte;
            }
            bytes.truncate(bytes.len().saturating_sub(cut));
            for bytes in [&bytes[..], text.as_bytes()] {
                if let Ok(mut reader) = Reader::new(format, bytes) {
                    while let Ok(Some(_)) = reader.next_feature() {}
                }
            }
        }
    }
}

#[test]
fn errors_and_warnings_name_the_feature() {
    let ring = |id: &str, name: &str, ring: &str| {
        format!(
            r#"{{"type":"Feature",{id}"properties":{{"Name":"{name}"}},"geometry":{{"type":"Polygon","coordinates":[{ring}]}}}}"#
        )
    };
    let (open, whole) = ("[[0,0],[4,0],[4,4]]", "[[0,0],[4,0],[4,4],[0,0]]");
    let all = [ring("", "a", whole), ring("", "b", open), ring("\"id\":7,", "c", open)];
    let (_, warnings) = read_all(all.join("\n").as_bytes(), "").expect("read");
    let messages: Vec<String> = warnings.iter().map(ToString::to_string).collect();
    assert!(
        messages[0].starts_with("line 2, column 89, feature 2 (Name b): the ring"),
        "{messages:?}"
    );
    assert!(messages[1].contains(", feature 3 (id 7): the ring is not closed"), "{messages:?}");

    let collection = |features: &str| {
        format!(r#"{{"type":"FeatureCollection","crs":{{"a":1}},"features":[{features}]}}"#)
    };
    let broken = ring("\"id\":\"x\",", "d", "[[0,0],[4]]");
    let text = collection(&format!("{},{broken}", all[0]));
    let messages = error(GeoFormat::GeoJson, text.as_bytes());
    assert!(messages.contains(", feature 2 (id x): a position needs"), "{messages}");
    let (_, warnings) = read_all(collection(&all[1]).as_bytes(), "").expect("read");
    let messages: Vec<String> = warnings.iter().map(ToString::to_string).collect();
    assert!(messages[0].contains("column 35: the member crs"), "not of a feature: {messages:?}");
    assert!(messages[1].contains("feature 1 (Name b)"), "{messages:?}");
    // Behind the features there is none.
    let messages = error(
        GeoFormat::GeoJson,
        text.replace("[4]]", "[4,0],[4,4],[0,0]]").replace("]}", "];").as_bytes(),
    );
    assert!(!messages.contains("feature 3"), "{messages}");

    let kml = "<kml><Placemark id='p1'><Point><coordinates>1,2</coordinates></Point></Placemark>\n\
        <Placemark><name>Weg</name><LineString><coordinates>1,2</coordinates></LineString></Placemark>\n\
        <Placemark id='p3'><Point><coordinates>1,b</coordinates></Point></Placemark></kml>";
    let (_, warnings) = read_all(kml.as_bytes(), "").expect("read");
    let messages: Vec<String> = warnings.iter().map(ToString::to_string).collect();
    assert!(
        messages[0].contains(", feature 2 (name Weg): a line needs two positions"),
        "{messages:?}"
    );
    assert!(
        messages[1].contains(", feature 3 (id p3): 1 coordinate is not a number"),
        "{messages:?}"
    );
    let gpx = "<gpx><wpt lat='1' lon='2'/><rte><name>R</name><rtept lat='1' lon='2'/></rte></gpx>";
    let (_, warnings) = read_all(gpx.as_bytes(), "").expect("read");
    assert!(warnings[0].to_string().contains("feature 2 (name R): a line needs"), "{warnings:?}");

    let topology = r#"{"type":"Topology","arcs":[[[0,0],[1,1]]],"objects":{"o":{"type":"GeometryCollection","geometries":[
        {"type":"LineString","arcs":[0]},{"type":"LineString","id":"k","arcs":[9]}]}}}"#;
    let messages = read_all(topology.as_bytes(), "").expect_err("no arc").to_string();
    assert!(
        messages.starts_with(
            "line 2, column 80, feature 2 (id k): there is no arc of this number: there is 1"
        ),
        "{messages}"
    );
    let table = "name,wkt\nA,POINT (1 2)\nB,POINT (1)\n";
    let messages = error(GeoFormat::Csv, table.as_bytes());
    assert!(messages.starts_with("line 3, feature 2: a position of 2 numbers"), "{messages}");
}
