//! Messages of readers for files that try to forge them.

use durer_formats::geo::{GeoFormat, Reader};
use durer_formats::height_map::{self, HeightMapOptions};
use durer_formats::{ModelFormat, NoResources, ReadOptions, read_model, svg};

/// Colours a terminal, and reverses the writing direction.
const FORGED: &str = "\u{1b}[31mX\u{202e}\u{7}\u{85}";

/// Returns whether a message is one line, has no control characters and is not too long.
fn is_plain(message: &str) -> bool {
    !message.chars().any(|c| c.is_control() || ('\u{2028}'..='\u{202e}').contains(&c))
        && message.chars().count() <= 1000
}

/// Returns all messages from reading a model.
fn said_of_model(name: &str, bytes: &[u8]) -> Vec<String> {
    match read_model(bytes, name, &NoResources, &ReadOptions::default()) {
        Ok(model) => model.warnings.iter().map(ToString::to_string).collect(),
        Err(error) => vec![error.to_string()],
    }
}

#[test]
fn readers_of_models_quote_plainly() {
    let json = serde_json::to_string(FORGED).unwrap();
    let files = [
        (
            "a.obj",
            format!(
                "{FORGED} 1\nmtllib {FORGED}\nusemtl {FORGED}\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"
            ),
        ),
        ("b.obj", format!("v 0 0 {FORGED}\n")),
        ("a.stl", format!("solid a\nfacet {FORGED}\n")),
        (
            "a.ply",
            format!(
                "ply\nformat ascii 1.0\nelement vertex 1\nproperty {FORGED} x\nend_header\n1\n"
            ),
        ),
        ("a.off", format!("OFF\n1 1 {FORGED}\n")),
        ("a.gltf", format!(r#"{{"asset":{{"version":"2.0"}},"extensionsRequired":[{json}]}}"#)),
        ("b.gltf", format!(r#"{{"asset":{{"version":{json}}}}}"#)),
        ("c.gltf", format!(r#"{{"asset":{{"version":"2.0"}},"scene":{json}}}"#)),
        ("a.dae", format!("<COLLADA version='1.4.1'><a></{FORGED}></COLLADA>")),
        ("a.xyz", format!("1 2 3\n1 {FORGED} 3\n")),
        ("a.bin", FORGED.to_owned()),
    ];
    for (name, file) in files {
        let said = said_of_model(name, file.as_bytes());
        assert!(!said.is_empty(), "{name} is fine?");
        said.iter().for_each(|message| assert!(is_plain(message), "{name}: {message:?}"));
        // The same with a name of many letters.
        let long = file
            .replace(FORGED, &"é".repeat(50_000))
            .replace(&json, &format!("\"{}\"", "é".repeat(50_000)));
        for message in said_of_model(name, long.as_bytes()) {
            assert!(is_plain(&message), "{name}: {} letters", message.chars().count());
        }
    }
}

/// Returns all messages from reading map data.
fn said_of_map(format: GeoFormat, bytes: &[u8]) -> Vec<String> {
    let mut reader = match Reader::new(format, bytes) {
        Ok(reader) => reader,
        Err(error) => return vec![error.to_string()],
    };
    let ended = loop {
        match reader.next_feature() {
            Ok(Some(_)) => {}
            Ok(None) => break None,
            Err(error) => break Some(error.to_string()),
        }
    };
    ended.into_iter().chain(reader.warnings().iter().map(ToString::to_string)).collect()
}

#[test]
fn readers_of_map_data_quote_plainly() {
    let json = serde_json::to_string(FORGED).unwrap();
    let files = [
        (GeoFormat::GeoJson, format!(r#"{{"type":{json}}}"#)),
        (GeoFormat::GeoJson, format!(r#"{{"type":"Point","coordinates":[1,{FORGED}]}}"#)),
        (GeoFormat::Wkt, format!("POINT (1 {FORGED})")),
        (GeoFormat::Wkt, format!("{FORGED} (1 2)")),
        (GeoFormat::Kml, format!("<kml><Placemark></{FORGED}></kml>")),
        (GeoFormat::Gpx, format!("<gpx><wpt lat='{FORGED}' lon='1'/></gpx>")),
        (GeoFormat::Svg, format!("<svg><path d='M {FORGED}'/></svg>")),
    ];
    for (format, file) in files {
        let said = said_of_map(format, file.as_bytes());
        assert!(!said.is_empty(), "{format}: {file:?} is fine?");
        said.iter().for_each(|message| assert!(is_plain(message), "{format}: {message:?}"));
    }
}

/// Faults of XML, each within an element `R`, and the resulting messages for drawings.
const FAULTS: [(&str, &str); 17] = [
    ("<R><a></b></R>", "`</b>` is found where `</a>` is expected"),
    ("<R><a", "the text ends before all elements do"),
    ("<R><a>", "the text ends before all elements do"),
    ("<R><q:a/></R>", "`svg` needs `xmlns:q=\"…\"`"),
    ("<R><a b='1' b='2'/></R>", "an element has the attribute `b` twice"),
    ("<R xmlns:q='u' xmlns:q='v'/>", "an element has `xmlns:q` twice"),
    ("<R>&nothing;</R>", "`&nothing;` is not a known entity; `&` itself is written `&amp;`"),
    ("<R>a & b</R>", "after `&` no known entity follows"),
    ("<R><a b='<'/></R>", "an attribute's value holds `<`, which is written `&lt;`"),
    ("<R>]]></R>", "a text holds `]]>`, which is written `]]&gt;`"),
    ("<R><!-- -- --></R>", "a comment holds `--`, or ends with `-`"),
    ("<R>\u{1}</R>", "the character U+0001 is not allowed in XML"),
    ("<R><?xml version='1.0'?></R>", "elsewhere than at the very beginning"),
    ("<R><a b=c/></R>", "`c` is found where a quote is expected"),
    ("<R><a b/></R>", "`/` is found where `=` is expected"),
    ("<R><1/></R>", "a name is needed, which begins with a letter, `_` or `:`"),
    (
        "<!DOCTYPE R [<!ENTITY a '&b;'><!ENTITY b '&a;'>]><R>&a;</R>",
        "entities refer to each other in a circle, or too often",
    ),
];

/// Words from messages of the libraries used for reading. They name Rust types and byte offsets, and some repeat the
/// position.
const FOREIGN: [&str; 24] = [
    "not '",
    "expected '",
    "expected `",
    "mismatch",
    "duplicated",
    "namespace prefix",
    "malformed",
    "not declared in",
    "unexpected",
    "end of stream",
    "non-XML",
    "limit reached",
    "ill-formed",
    "syntax error",
    "EOF while",
    "invalid type",
    "missing field",
    "struct ",
    "usize",
    "Some(",
    "Error(",
    "corrupt deflate",
    "invalid Zip",
    "recursion limit",
];

fn are_our_words(messages: &[String]) {
    for message in messages {
        let theirs = FOREIGN.iter().find(|words| message.contains(**words));
        assert!(theirs.is_none() && is_plain(message), "{theirs:?} in {message:?}");
    }
}

#[test]
fn faults_of_xml_are_reported_in_our_words() {
    for (file, expected) in FAULTS {
        let drawing =
            file.replacen("<R", "<R xmlns='http://www.w3.org/2000/svg'", 1).replace('R', "svg");
        let warned = svg::Drawing::read(drawing.as_bytes(), &svg::ReadOptions::default());
        let warned = warned.expect_err(file).to_string();
        assert!(
            warned.starts_with("line 1, column ") && warned.contains(expected),
            "{file:?}: {warned}"
        );
        are_our_words(&[warned]);
        for (name, root) in [("a.dae", "COLLADA"), ("a.x3d", "X3D"), ("a.amf", "amf")] {
            are_our_words(&said_of_model(name, file.replace('R', root).as_bytes()));
        }
        for (format, root) in
            [(GeoFormat::Kml, "kml"), (GeoFormat::Gpx, "gpx"), (GeoFormat::Svg, "svg")]
        {
            are_our_words(&said_of_map(format, file.replace('R', root).as_bytes()));
        }
    }
}

#[test]
fn faults_of_json_are_reported_in_our_words() {
    for fault in [
        "",
        "{",
        "[1,",
        "{\"a\" 1}",
        "{\"a\":1,}",
        "nul",
        "1e999",
        "\"\\x\"",
        "[",
        "{\"scene\":\"x\"}",
    ] {
        let gltf = format!("{{\"asset\":{{\"version\":\"2.0\"}},\"nodes\":{fault}}}");
        are_our_words(&said_of_model("a.gltf", gltf.as_bytes()));
        for format in [GeoFormat::GeoJson, GeoFormat::GeoJsonSeq, GeoFormat::TopoJson] {
            are_our_words(&said_of_map(format, fault.as_bytes()));
            let within = format!("{{\"type\":\"Feature\",\"geometry\":{fault}}}");
            are_our_words(&said_of_map(format, within.as_bytes()));
        }
    }
}

#[test]
fn drawings_of_too_many_elements_are_not_called_ill_formed() {
    let uses = "<use href='#a'/>".repeat(1100);
    let twice = format!(
        "<svg xmlns='http://www.w3.org/2000/svg' width='9' height='9'><g id='a'>{}</g>{uses}</svg>",
        "<rect width='1' height='1'/>".repeat(1000)
    );
    let warned = svg::Drawing::read(twice.as_bytes(), &svg::ReadOptions::default());
    let warned = warned.expect_err("too many").to_string();
    assert!(warned.contains("1,000,000 elements") && !warned.contains("well-formed"), "{warned}");
}

/// Returns prefixes of a file, and the file with some of its bytes changed.
fn broken(file: &[u8]) -> Vec<Vec<u8>> {
    let cut = (1..16).map(|i| file[..file.len() * i / 16].to_vec());
    let changed = (1..64).map(|i| {
        let mut file = file.to_vec();
        let at = file.len() * i / 64;
        file[at..].iter_mut().take(3).for_each(|byte| *byte = byte.wrapping_add(101));
        file
    });
    cut.chain(changed).collect()
}

/// Returns the seeds of the fuzz target of a name.
fn seeds(target: &str) -> Vec<Vec<u8>> {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/seeds");
    let files = std::fs::read_dir(folder.join(target)).expect("seeds are part of the repository");
    files.map(|file| std::fs::read(file.expect("a file").path()).expect("a seed")).collect()
}

/// Returns copies of the file, each with escapes of the same length in place of one word.
fn with_escapes(file: &[u8]) -> Vec<Vec<u8>> {
    let mut words = Vec::new();
    let mut at = 0;
    for run in file.chunk_by(|a, b| a.is_ascii_alphabetic() == b.is_ascii_alphabetic()) {
        if run.len() > 2 && run[0].is_ascii_alphabetic() {
            words.push(at..at + run.len());
        }
        at += run.len();
    }
    let step = words.len().div_ceil(24).max(1);
    let replaced = |word: std::ops::Range<usize>| {
        let mut file = file.to_vec();
        let escapes = FORGED.bytes().chain("\u{202e}".bytes().cycle());
        file[word].iter_mut().zip(escapes).for_each(|(byte, escape)| *byte = escape);
        file
    };
    words.into_iter().step_by(step).map(replaced).collect()
}

/// Returns the fuzz target that has seeds of a format.
fn target_of_model(format: ModelFormat) -> &'static str {
    match format {
        ModelFormat::Gltf => "gltf",
        ModelFormat::Obj => "obj",
        ModelFormat::Stl => "stl",
        ModelFormat::Ply => "ply",
        ModelFormat::ThreeMf => "threemf",
        ModelFormat::Collada => "collada",
        ModelFormat::Fbx => "fbx",
        ModelFormat::Off => "off",
        ModelFormat::Las => "las",
        ModelFormat::E57 => "e57",
        ModelFormat::Xyz => "xyz",
    }
}

/// Returns the same for map data.
fn target_of_map(format: GeoFormat) -> &'static str {
    match format {
        GeoFormat::GeoJson | GeoFormat::GeoJsonSeq | GeoFormat::GeoJsonRs => "geojson",
        GeoFormat::Wkt => "wkt",
        GeoFormat::Wkb | GeoFormat::WkbHex => "wkb",
        GeoFormat::Svg => "svg",
        GeoFormat::Shapefile => "shapefile",
        GeoFormat::FlatGeobuf => "flatgeobuf",
        GeoFormat::GeoPackage => "geopackage",
        GeoFormat::GeoParquet => "geoparquet",
        GeoFormat::TopoJson => "topojson",
        GeoFormat::Csv => "csv",
        GeoFormat::Kml => "kml",
        GeoFormat::Gpx => "gpx",
    }
}

#[test]
fn every_reader_quotes_escapes_plainly() {
    let mut said_at_all = 0;
    let mut plain = |what: &str, said: Vec<String>| {
        said_at_all += said.len();
        said.iter().for_each(|message| assert!(is_plain(message), "{what}: {message:?}"));
    };
    for format in ModelFormat::ALL {
        let name = format!("a.{}", format.suffixes()[0]);
        for file in seeds(target_of_model(format)).iter().flat_map(|seed| with_escapes(seed)) {
            plain(&name, said_of_model(&name, &file));
        }
    }
    let reversed = "\u{202e}".repeat(9);
    let object =
        format!("<object id='{reversed}' name='{reversed}' pid='{reversed}'><mesh/></object>");
    let archive =
        crate::threemf::simple(&reversed, &object, &format!("<item objectid='{reversed}'/>"));
    plain("3MF", said_of_model("a.3mf", &archive));
    for format in GeoFormat::ALL {
        for file in seeds(target_of_map(format)).iter().flat_map(|seed| with_escapes(seed)) {
            plain(format.name(), said_of_map(format, &file));
        }
    }
    for file in seeds("drawing").iter().flat_map(|seed| with_escapes(seed)) {
        let read = svg::Drawing::read(&file, &svg::ReadOptions::default());
        plain("drawing", read.err().map(|error| error.to_string()).into_iter().collect());
    }
    for file in seeds("height_map").iter().flat_map(|seed| with_escapes(seed)) {
        for name in ["a.json", "a.npy", "a.npz", "a.png", "a.asc", "a.csv", "a.xyz"] {
            let said = height_map::read(&file, name, &HeightMapOptions::default());
            plain(name, said.err().map(|error| error.to_string()).into_iter().collect());
        }
    }
    assert!(said_at_all > 300, "{said_at_all}");
}

#[test]
fn words_of_other_libraries_do_not_appear() {
    let plain = |what: &str, said: Vec<String>| {
        for message in said {
            let foreign = FOREIGN.iter().find(|words| message.contains(**words));
            assert_eq!(foreign, None, "{what}: {message}");
        }
    };
    for (target, name) in [
        ("gltf", "a.glb"),
        ("gltf", "a.gltf"),
        ("obj", "a.obj"),
        ("stl", "a.stl"),
        ("ply", "a.ply"),
        ("threemf", "a.3mf"),
        ("collada", "a.dae"),
        ("off", "a.off"),
        ("las", "a.las"),
        ("e57", "a.e57"),
        ("xyz", "a.xyz"),
    ] {
        for file in seeds(target).iter().flat_map(|seed| broken(seed)) {
            plain(name, said_of_model(name, &file));
        }
    }
    for (target, format) in [
        ("geojson", GeoFormat::GeoJson),
        ("wkt", GeoFormat::Wkt),
        ("wkb", GeoFormat::Wkb),
        ("topojson", GeoFormat::TopoJson),
        ("flatgeobuf", GeoFormat::FlatGeobuf),
        ("geopackage", GeoFormat::GeoPackage),
        ("csv", GeoFormat::Csv),
        ("kml", GeoFormat::Kml),
        ("gpx", GeoFormat::Gpx),
        ("svg", GeoFormat::Svg),
    ] {
        for file in seeds(target).iter().flat_map(|seed| broken(seed)) {
            plain(target, said_of_map(format, &file));
        }
    }
    for file in seeds("drawing").iter().flat_map(|seed| broken(seed)) {
        let said = svg::Drawing::read(&file, &svg::ReadOptions::default());
        plain("drawing", said.err().map(|error| error.to_string()).into_iter().collect());
    }
    let deep = format!("[{}", "[".repeat(1000)).into_bytes();
    let of_heights = seeds("height_map").into_iter().flat_map(|seed| broken(&seed)).chain([deep]);
    for file in of_heights {
        for name in ["a.json", "a.npy", "a.npz", "a.png", "a.asc", "a.csv", "a.xyz"] {
            let said = height_map::read(&file, name, &HeightMapOptions::default());
            plain(name, said.err().map(|error| error.to_string()).into_iter().collect());
        }
    }
}

/// Returns whether a message counts one thing by a plural, such as `1 faces`.
fn is_wrongly_plural(message: &str) -> bool {
    let words: Vec<&str> = message.split(|c: char| c.is_whitespace() || c == '(').collect();
    words.windows(2).any(|pair| {
        let verb = ["is", "was", "has", "does"].contains(&pair[1]);
        pair[0] == "1" && pair[1].ends_with('s') && !verb
    })
}

#[test]
fn one_thing_is_no_plural() {
    const FACE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    let obj = |rest: &str| ("a.obj", format!("{FACE}{rest}").into_bytes());
    let ply = |vertices: &str, elements: &str, rows: &str| {
        let text = format!(
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
             {elements}end_header\n{vertices}{rows}"
        );
        ("a.ply", text.into_bytes())
    };
    let faces =
        |count: u32| format!("element face {count}\nproperty list uchar int vertex_indices\n");
    let points = "0 0 0\n1 0 0\n0 1 0\n";
    let stl = |rest: &str| {
        let facet = "facet\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendfacet\n";
        ("a.stl", format!("solid a\n{facet}{rest}").into_bytes())
    };
    let off =
        |faces: &str| ("a.off", format!("OFF\n3 2 0\n{points}3 0 1 2\n{faces}\n").into_bytes());
    let no_normal = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nf 1//1 3//1 2\n";
    let mut binary = vec![0; 84 + 50];
    binary[80] = 1;
    let longer = [&binary[..], b"x"].concat();
    binary[80] = 2;
    let none = [&b"v"[..], &binary[1..84]].concat();
    for ((name, bytes), expected) in [
        (obj("foo 1\n"), "1 statement is not known and was skipped: `foo`"),
        (obj("curv 0 1 1 2\n"), "1 statement of a free-form curve or surface is not read"),
        (obj("f 1 2 9\n"), "1 face, line or point has a wrong corner and was left out: vertex 9"),
        (obj("v 1\n"), "is not readable: `v` has 1 number; it needs 3"),
        (obj("f 1 2\n"), "1 element has too few corners and was left out"),
        (obj("v 0 0 inf\n"), "1 vertex has a coordinate"),
        (obj("v 0 0 0x\n"), "1 number has something behind it, which was ignored"),
        (obj("f 1/1 2 3\n"), "1 corner names texture coordinates or normals"),
        (obj("v 1 1 1 1 0 0\nv 0 0 2\n"), "1 vertex has no color where"),
        (("a.obj", no_normal.into()), "1 vertex has no normal where others have one"),
        (("a.obj", b"v 0 0 0\n".to_vec()), "the 1 vertex is taken as a point"),
        (stl("foo\nendsolid\n"), "1 word is not STL and was skipped"),
        (stl("facet\nvertex 0 0 0\nendfacet\nendsolid\n"), "1 facet has fewer than three"),
        (
            stl("facet\nvertex 0 0\nvertex 1 0 0\nvertex 0 1 0\nendfacet\nendsolid\n"),
            "its facet was",
        ),
        (
            stl("facet\nvertex 0 0 0,5\nvertex 1 0 0\nvertex 0 1 0\nendfacet\nendsolid\n"),
            "1 number has",
        ),
        (stl(""), "1 whole triangle was read"),
        (("a.stl", longer), "1 byte after the last triangle was ignored"),
        (("a.stl", binary), "the header counts 2 triangles, the file has room for 1"),
        (("a.stl", none), "the file has room for 0"),
        (
            ply(points, &faces(2), "3 0 1 2\n2 0 1\n"),
            "1 face has fewer than three vertices and was",
        ),
        (ply(points, &faces(2), "3 0 1 2\n3 0 1 9\n"), "1 face or edge like this is left out"),
        (ply(points, &format!("{}foo\n", faces(1)), "3 0 1 2\n"), "1 line is not of a PLY header"),
        (ply("0 0 0\n1 0 0\n0 1 nan\n", &faces(1), "3 0 1 2\n"), "1 vertex has a coordinate"),
        (ply(points, &faces(2), "3 0 1 2\n"), "1 of 2 rows of element `face` is read"),
        (ply(points, "element foo 1\nproperty int a\n", "7\n"), "its 1 row is left out"),
        (off("3 0 1 9"), "1 face has a vertex that does not exist and was left out"),
        (off("1 0"), "1 face has fewer than two vertices and was left out"),
        (off("3 0 1 2 7"), "1 face has a color by number"),
        (("a.xyz", b"0 0 0\nend\n".to_vec()), "1 line holds no point and was skipped"),
        (("a.xyz", b"0 0 0\n0 0 inf\n".to_vec()), "1 point has a coordinate"),
    ] {
        let said = said_of_model(name, &bytes);
        let text = String::from_utf8_lossy(&bytes);
        assert!(said.iter().any(|message| message.contains(expected)), "{text}: {said:?}");
        for message in said {
            assert!(!is_wrongly_plural(&message), "{message}");
        }
    }
}
