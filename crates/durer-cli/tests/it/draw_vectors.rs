//! `durer draw` to SVG, PDF and DXF: the vectors show what the pixels show.

use crate::harness::{Folder, Picture};

/// Areas with a hole, one partly outside, neighbours, a line and points.
const MAP: &str = r#"{"type":"FeatureCollection","features":[
{"type":"Feature","properties":{"name":"Ring"},"geometry":{"type":"Polygon","coordinates":[
 [[10,10],[90,10],[90,90],[10,90],[10,10]],[[40,40],[40,60],[60,60],[60,40],[40,40]]]}},
{"type":"Feature","properties":{"name":"Far"},"geometry":{"type":"Polygon","coordinates":[
 [[70,70],[1e6,75],[1e6,1e6],[80,95],[70,70]]]}},
{"type":"Feature","properties":{"name":"Way"},"geometry":{"type":"LineString","coordinates":[[0,5],[100,5],[95,50]]}},
{"type":"Feature","properties":{"name":"Pole"},"geometry":{"type":"Point","coordinates":[50,50]}}]}"#;

const SVG: &str = r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 60 40">
<clipPath id="c"><circle cx="20" cy="20" r="15"/></clipPath>
<g clip-path="url(#c)"><rect width="40" height="40" fill="#28c"/>
<path d="M0 20Q20-20 40 20t40 0" fill="none" stroke="#fa0" stroke-width="4"/></g>
<g opacity=".5" transform="rotate(10 45 20)"><rect x="38" y="8" width="16" height="16" fill="#c00"/>
<circle cx="48" cy="22" r="8" fill="#070" stroke="#000" stroke-dasharray="3 2"/></g>
<path fill-rule="evenodd" d="M2 2h12v12h-12zM5 5h6v6h-6z" fill="#808" fill-opacity=".8"/></svg>"##;

/// Draws to pixels and to SVG, draws the SVG to pixels, and returns the mean and the largest difference of a channel, and
/// the share of channels that differ by more than 24.
fn differences(folder: &Folder, drawing: &str) -> (f64, u8, f64) {
    folder.must(&format!("draw {drawing} -o a.png"));
    folder.must(&format!("draw {drawing} -o v.svg"));
    folder.must("draw v.svg -o b.png");
    let [a, b] = ["a.png", "b.png"].map(|name| Picture::decode(&folder.read(name)));
    assert_eq!(a.size(), b.size());
    let (width, height) = a.size();
    let (mut sum, mut most, mut many, mut painted) = (0.0, 0, 0.0, false);
    for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
        // JPEG-like pictures without transparency have three channels.
        for (p, q) in a.pixel(x, y).iter().zip(b.pixel(x, y)) {
            sum += f64::from(p.abs_diff(*q));
            most = most.max(p.abs_diff(*q));
            many += f64::from(u8::from(p.abs_diff(*q) > 24));
        }
        painted |= a.pixel(x, y) != a.pixel(0, 0);
    }
    assert!(painted, "{drawing}: nothing is painted");
    let pixels = f64::from(width * height);
    (sum / pixels, most, many / pixels)
}

#[test]
fn vectors_show_what_pixels_show() {
    let folder = Folder::new();
    folder.write("map.geojson", MAP);
    folder.write("a.svg", SVG);
    for drawing in [
        "map.geojson --size 200x200",
        "map.geojson --size 200x200 --window 0,0,100,100 --label name --marker square",
        "map.geojson --size 200x200 --window 0,0,100,100 --stroke-width 3 --dashes 9,4 --opacity .4",
        "map.geojson --size 200x200 --window 0,0,100,100 --stroke #0008 --stroke-width 5 --fill #f804",
        "map.geojson --size 200x150 --window 0,0,100,100 --viewport 20,30,90,80 --background #def",
        "map.geojson --stroke none --fill red map.geojson --fill none --size 90x --window 0,0,99,99",
        "a.svg --background white",
        "a.svg --size 300x --background white --window 10,5,50,30",
    ] {
        let (mean, most, _) = differences(&folder, drawing);
        assert!(mean < 0.5 && most <= 24, "{drawing}: {mean} {most}");
    }
}

/// Gradients along lines and between circles: skewed, repeated, reflected, translucent, with jumps of the colour, in
/// clip paths and groups, and of strokes.
const GRADIENTS: &str = r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 120 90">
<linearGradient id="a"><stop stop-color="#c00"/><stop offset=".3" stop-color="#fd0"/>
 <stop offset=".6" stop-color="#08c"/><stop offset=".6" stop-color="#fff"/><stop offset="1"/></linearGradient>
<linearGradient id="b" href="#a" gradientUnits="userSpaceOnUse" x1="40" y1="5" x2="50" y2="9"
 gradientTransform="rotate(20) scale(1 .7) skewX(20)" spreadMethod="reflect"/>
<linearGradient id="c" href="#a" x2=".2" y2=".1" spreadMethod="repeat"/>
<linearGradient id="d" x1=".3" x2=".7"><stop stop-color="#060"/><stop stop-color="#f0f" stop-opacity=".2"/>
 <stop offset="1" stop-color="#f80" stop-opacity=".9"/><stop offset="1" stop-color="#00f" stop-opacity=".5"/></linearGradient>
<radialGradient id="e" href="#a"/>
<radialGradient id="f" href="#d" fx=".3" fy=".4" r=".4" spreadMethod="pad"/>
<radialGradient id="g" href="#a" fx=".4" fr=".05" r=".3" spreadMethod="repeat"/>
<radialGradient id="h" href="#d" gradientTransform="rotate(15)" r=".2" spreadMethod="reflect"/>
<clipPath id="k"><circle cx="15" cy="75" r="12"/></clipPath>
<rect x="2" y="2" width="30" height="20" fill="url(#a)"/><rect x="40" y="2" width="30" height="20" fill="url(#b)"/>
<circle cx="95" cy="15" r="13" fill="url(#c)"/><rect x="2" y="30" width="30" height="25" fill="url(#d)"/>
<ellipse cx="55" cy="42" rx="18" ry="12" fill="url(#e)"/><rect x="80" y="30" width="35" height="25" fill="url(#f)"/>
<g clip-path="url(#k)"><rect x="2" y="60" width="30" height="26" fill="url(#g)"/></g>
<g opacity=".6"><rect x="40" y="60" width="30" height="26" fill="url(#h)"/>
 <circle cx="70" cy="70" r="9" fill="url(#a)"/></g>
<path d="M82 84Q90 40 98 84t18-20" fill="none" stroke="url(#c)" stroke-width="5" opacity=".8"/>
</svg>
"##;

#[test]
fn clip_paths_of_several_shapes_are_written_as_vectors() {
    let folder = Folder::new();
    folder.write(
        "c.svg",
        r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 60 40">
<clipPath id="a"><circle cx="15" cy="20" r="12"/><path clip-rule="evenodd"
 d="M20 5h30v30h-30zM28 12h14v14h-14z" transform="rotate(8 35 20)"/><text x="2" y="12" font-size="12">ab</text></clipPath>
<g clip-path="url(#a)"><rect width="60" height="40" fill="#28c"/><path d="M0 40L60 0" stroke="#fa0" stroke-width="9"/></g></svg>"##,
    );
    let (mean, most, many) = differences(&folder, "c.svg --size 300x --background white");
    // Where the outlines of two shapes cross, a mask has the coverage of both.
    assert!(mean < 0.5 && many < 1e-3, "{mean} {most} {many}");
    folder.must("draw c.svg -o c.pdf");
}

#[test]
fn gradients_are_written_as_vectors() {
    let folder = Folder::new();
    folder.write("g.svg", GRADIENTS);
    let (mean, _, many) = differences(&folder, "g.svg --size 360x --background white");
    // A pixel through whose centre the border of two colours goes may get either.
    assert!(mean < 0.1 && many < 1e-3, "{mean} {many}");
    folder.must("draw g.svg -o v.svg");
    let text = String::from_utf8(folder.read("v.svg")).expect("UTF-8");
    for part in [
        "spreadMethod=\"reflect\"",
        "spreadMethod=\"repeat\"",
        " gradientTransform=\"matrix(",
        " stop-opacity=\".2\"/>",
        " fr=\"",
        "<path fill=\"url(#_",
    ] {
        assert!(text.contains(part), "{part} is not in\n{text}");
    }
    folder.must("draw g.svg -o v.pdf");
    let pdf = folder.read("v.pdf");
    let text = String::from_utf8_lossy(&pdf);
    for part in ["/ShadingType 2", "/ShadingType 3", "/S /Luminosity", "/FunctionType 3"] {
        assert!(text.contains(part), "{part} is not in\n{text}");
    }
    folder.must("draw g.svg -o w.pdf");
    assert_eq!(folder.read("w.pdf"), pdf);
    let many = GRADIENTS.replace("x2=\".2\" y2=\".1\"", "x2=\".00001\"");
    folder.write("g.svg", many);
    folder.must("draw g.svg -o v.svg");
    let refused = folder.run("draw g.svg -o x.pdf");
    refused.fails(1, "a gradient that repeats more than some thousand times is not supported");
    assert!(!folder.path("x.pdf").exists());
}

#[test]
fn map_layers_become_layers_of_the_file() {
    let folder = Folder::new();
    folder.write("map.geojson", MAP);
    folder.must(
        "draw map.geojson map.geojson --label name -o v.svg --window 0,0,100,100 --size 96x96",
    );
    let text = String::from_utf8(folder.read("v.svg")).unwrap();
    for part in [
        "width=\"25.4mm\" height=\"25.4mm\"",
        "inkscape:label=\"map\"",
        "inkscape:label=\"map-2\"",
        "inkscape:label=\"labels\"",
        "fill-rule=\"evenodd\"",
    ] {
        assert!(text.contains(part), "{part} is not in\n{text}");
    }
    // Programs compute with numbers of limited size.
    let paths = text.split('"').filter(|value| value.starts_with('M'));
    let numbers = paths.flat_map(|path| path.split(|c: char| !c.is_ascii_digit() && c != '.'));
    let largest = numbers.filter_map(|n| n.parse::<f64>().ok()).fold(0.0, f64::max);
    assert!(largest < 3000.0, "{largest}");
    let pdf = "draw map.geojson --opacity .5 --label name -o v.pdf --json";
    let report = folder.must(pdf).json();
    assert_eq!(
        (&report["width"], &report["layers"][0]["map"]["polygons"]),
        (&1024.into(), &2.into())
    );
    let first = folder.read("v.pdf");
    folder.must(pdf);
    assert_eq!(folder.read("v.pdf"), first);
    let text = String::from_utf8_lossy(&first);
    assert!(text.starts_with("%PDF-") && text.contains("/S /Transparency"), "{text}");
    let piped = folder.must("draw map.geojson -o - --format svg").out;
    assert!(piped.starts_with(b"<svg "), "{piped:?}");
}

#[test]
fn content_without_vectors_is_refused() {
    let folder = Folder::new();
    folder.write("map.geojson", MAP);
    let body = |name: &str, body: &str| {
        let text = format!(
            "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 9 9'>{body}<rect id='r' width='9' height='9'/></svg>"
        );
        folder.write(name, text);
    };
    let png = "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg==";
    body("bitmap.svg", &format!("<image width='9' height='9' href='{png}'/>"));
    body(
        "pattern.svg",
        "<pattern id='p' width='.1' height='.1'><circle r='1'/></pattern>
         <rect width='9' height='9' fill='url(#p)'/>",
    );
    body("blend.svg", "<rect width='9' height='9' style='mix-blend-mode:multiply' fill='red'/>");
    body(
        "filter.svg",
        "<filter id='f'><feGaussianBlur stdDeviation='1'/></filter><circle r='5' filter='url(#f)'/>",
    );
    body(
        "mask.svg",
        "<mask id='m'><circle r='5' fill='red'/></mask><circle r='6' mask='url(#m)'/>",
    );
    for (name, kind) in [
        ("bitmap", "bitmaps and patterns"),
        ("pattern", "bitmaps and patterns"),
        ("blend", "blend modes"),
        ("filter", "filters"),
        ("mask", "masks"),
    ] {
        let message = format!("{name}.svg: {kind} cannot be written as vectors; a picture (.png)");
        folder.run(&format!("draw {name}.svg -o {name}.pdf")).fails(1, &message);
        folder.must(&format!("draw {name}.svg -o {name}.png"));
        assert!(!folder.path(&format!("{name}.pdf")).exists());
    }
    for (options, part) in [
        ("-o a.hpgl", "as vectors in SVG, PDF or DXF; end the name in .png"),
        ("-o a.dxf --aa none", "--aa: vectors have no pixels"),
        ("-o a.svg --aa none", "--aa: vectors have no pixels"),
        ("-o a.svg --quality 3", "--quality: only a JPEG has one"),
        ("-o a.svg --format pdf", "--format says pdf"),
    ] {
        folder.run(&format!("draw map.geojson {options}")).fails(2, part);
    }
}

#[test]
fn one_layer_of_a_file_is_drawn_and_described() {
    let folder = Folder::new();
    let object = |x: u32| format!(r#"{{"type":"Point","coordinates":[{x},2]}}"#);
    let objects = format!(r#""a":{},"b":{}"#, object(1), object(5));
    folder.write("t.json", format!(r#"{{"type":"Topology","arcs":[],"objects":{{{objects}}}}}"#));
    let ended = folder.must("draw t.json -o a.png");
    assert!(ended.err.contains("its 2 layers, a, b, become one"), "{}", ended.err);
    let report =
        folder.must("draw t.json --layer b t.json -o a.png --json --window 0,0,3,3").json();
    let points = |i: usize| report["layers"][i]["map"]["points"].clone();
    assert_eq!((points(0), points(1)), (0.into(), 1.into()), "b is outside of the window");
    let report =
        folder.must("draw --layer b t.json t.json -o a.png --json --window 0,0,3,3").json();
    assert_eq!(report["layers"][1]["map"]["points"], 0, "the layer is that of both");
    folder.run("draw t.json --layer c -o a.png").fails(1, "there is no layer c");
    let printed = folder.must("info t.json --layer b --json").json();
    assert_eq!((&printed["name"], &printed["features"]), (&"b".into(), &1.into()), "{printed}");
    folder.run("info t.json --layer c").fails(1, "there is no layer c");
    folder.write("a.svg", SVG);
    folder.run("draw a.svg --layer b -o a.png").fails(2, "--layer is for map data");
    folder.write("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    folder.run("info m.obj --layer b").fails(2, "--layer: m.obj holds a model");
}

/// Returns the entities of a DXF file: their kind, then their codes with values.
fn entities(dxf: &str) -> Vec<Vec<(i32, String)>> {
    let lines: Vec<&str> = dxf.lines().collect();
    let tag = |pair: &[&str]| (pair[0].trim().parse().expect("a code"), pair[1].trim().to_owned());
    let tags: Vec<(i32, String)> = lines.chunks_exact(2).map(tag).collect();
    let start = tags.iter().position(|t| t.0 == 2 && t.1 == "ENTITIES").expect("a section");
    let mut found: Vec<Vec<(i32, String)>> = Vec::new();
    for tag in &tags[start + 1..] {
        match (tag.0, &tag.1[..]) {
            (0, "ENDSEC") => break,
            (0, _) => found.push(vec![tag.clone()]),
            _ => found.last_mut().expect("an entity").push(tag.clone()),
        }
    }
    found
}

#[test]
fn maps_become_polylines_and_hatches_for_cad() {
    let folder = Folder::new();
    folder.write("map.geojson", MAP);
    folder.write("ways.geojson", MAP);
    let style =
        "--stroke #ff8000 --label name ways.geojson --fill none --stroke #0000ff80 --dashes 4,2,1";
    folder.must(&format!(
        "draw map.geojson {style} -o a.dxf --size 100x100 --window 0,0,100,100 --background #def --dxf-units mm"
    ));
    let dxf = String::from_utf8(folder.read("a.dxf")).expect("ASCII");
    let all = entities(&dxf);
    let of = |kind: &str, layer: &str| {
        let is =
            |e: &&Vec<(i32, String)>| e[0].1 == kind && e.iter().any(|t| t.0 == 8 && t.1 == layer);
        all.iter().filter(is).collect::<Vec<_>>()
    };
    let value = |entity: &[(i32, String)], code: i32| {
        entity.iter().find(|t| t.0 == code).map(|t| t.1.clone()).unwrap_or_default()
    };
    // The ring, its hole and the point; the way, and the part of the far area that is within the picture.
    let lines = of("LWPOLYLINE", "map");
    let closed = lines.iter().filter(|l| value(l, 70) == "129").count();
    assert_eq!((lines.len(), closed), (5, 3), "{lines:?}");
    let [ring, _] = &of("HATCH", "map")[..2] else { panic!("the areas are filled") };
    assert_eq!((value(ring, 91), value(ring, 420)), ("2".into(), 0xe3_e7_e0.to_string()));
    for (layer, color) in [("map", 0xff_80_00), ("ways", 0x00_00_ff)] {
        let at = dxf.find(&format!("\n  2\n{layer}\n 70\n")).expect("a layer");
        assert!(dxf[at..at + 80].contains(&format!("420\n{color}\n")), "{}", &dxf[at..at + 80]);
    }
    // Dashes are those of the line type, of which an odd number is taken twice; the colour is half transparent.
    let [way, ..] = &of("LWPOLYLINE", "ways")[..] else { panic!("no lines") };
    assert_eq!(value(way, 440), ((2 << 24) + 0x80).to_string());
    let types = &dxf[dxf.find("Center").expect("a line type")..];
    assert!(types.starts_with("Center ____ _ ____ _ ____ _ ____\n 72\n65\n 73\n6\n"), "{dxf}");
    assert_eq!(of("HATCH", "background").len(), 1);
    let letters = of("HATCH", "labels");
    assert!(letters.len() >= 4 && of("LWPOLYLINE", "labels").is_empty(), "no halo");
    let sizes = all.iter().flatten().filter(|t| t.0 == 10 || t.0 == 20);
    for (_, place) in sizes {
        let place: f64 = place.parse().expect("a number");
        assert!((-1e-6..=100.0 * 25.4 / 96.0 + 1e-6).contains(&place), "{place} is off the sheet");
    }
    let refused = folder.run("draw map.geojson --opacity .5 -o b.dxf");
    refused.fails(1, "map.geojson: opacities of whole layers cannot be written as DXF; a picture");
    folder.write("g.svg", GRADIENTS);
    let refused = folder.run("draw g.svg -o b.dxf");
    refused.fails(
        1,
        "g.svg: clip paths, gradients cannot be written as DXF; a picture (.png) shows them",
    );
    assert!(!folder.path("b.dxf").exists());
    folder.write(
        "a.svg",
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 9 9'><path d='M1 1h9'/></svg>",
    );
    folder.must("draw a.svg -o a.dxf");
    folder.write("straße.geojson", MAP);
    folder.must("draw straße.geojson -o a.dxf");
    let dxf = String::from_utf8(folder.read("a.dxf")).expect("ASCII");
    assert!(dxf.contains("\n  8\nstra\\U+00DFe\n"), "the name of the layer is escaped");
}

#[test]
fn maps_for_cad_have_the_coordinates_of_the_map() {
    let folder = Folder::new();
    let ring = "[[500000.25,5400000.5],[500010,5400000.5],[500010,5400020],[500000.25,5400000.5]]";
    folder.write(
        "utm.geojson",
        format!(
            r#"{{"type":"FeatureCollection","features":[
            {{"type":"Feature","properties":{{"n":"A"}},"geometry":{{"type":"Polygon","coordinates":[{ring}]}}}},
            {{"type":"Feature","properties":{{}},"geometry":{{"type":"Point","coordinates":[500005,5400015.125]}}}}]}}"#
        ),
    );
    folder.must("draw utm.geojson -o a.dxf --size 200x400 --dashes 4,2");
    let dxf = String::from_utf8(folder.read("a.dxf")).expect("ASCII");
    let all = entities(&dxf);
    let is_border = |e: &&Vec<(i32, String)>| {
        e[0].1 == "LWPOLYLINE" && e.iter().filter(|t| t.0 == 10).count() == 3
    };
    let line = all.iter().find(is_border).expect("a border");
    let values = |code: i32| {
        let of_code = line.iter().filter(|t| t.0 == code);
        of_code.map(|t| t.1.parse::<f64>().expect("a number")).collect::<Vec<_>>()
    };
    let near = |found: Vec<f64>, expected: [f64; 3]| {
        let apart = found.iter().zip(expected).map(|(a, b)| (a - b).abs());
        assert!(found.len() == 3 && apart.fold(0.0, f64::max) < 1e-8, "{found:?}");
    };
    near(values(10), [500_000.25, 500_010.0, 500_010.0]);
    near(values(20), [5_400_000.5, 5_400_000.5, 5_400_020.0]);
    // Nothing tells the units; dashes keep their size on the sheet, where the longer side of the window is 400 pixels.
    let after = |name: &str| {
        let at = dxf.find(name).expect("a variable");
        dxf[at..].lines().nth(2).expect("a value").trim().parse::<f64>().expect("a number")
    };
    assert_eq!(after("$INSUNITS"), 0.0);
    let (lower, upper) = (after("$EXTMIN"), after("$EXTMAX"));
    assert!(lower < 500_000.25 && upper > 500_010.0, "{lower} {upper}");
    let sheet = 200.0 * 25.4 / 96.0;
    assert!((after("$LTSCALE") - (upper - lower) / sheet).abs() < 1e-9);
    let units = |options: &str| {
        folder.must(&format!("draw utm.geojson -o b.dxf {options}"));
        let dxf = String::from_utf8(folder.read("b.dxf")).expect("ASCII");
        let at = dxf.find("$INSUNITS").expect("a variable");
        dxf[at..].lines().nth(2).map(|line| line.trim().to_owned())
    };
    let feet = |length: f64| {
        let geographic = r#"GEOGCS["G",DATUM["D_WGS_1984",SPHEROID["WGS_1984",6378137,298.257223563]],PRIMEM["Greenwich",0],UNIT["Degree",0.0174532925199433]]"#;
        let projection = r#"PROJECTION["Transverse_Mercator"],PARAMETER["Central_Meridian",9]"#;
        format!(r#"--from-crs PROJCS["P",{geographic},{projection},UNIT["Foot",{length}]]"#)
    };
    for (options, number) in [
        ("--from-crs EPSG:32632".to_owned(), "6"),
        ("--from-crs EPSG:32632 --dxf-units mm".to_owned(), "4"),
        ("--from-crs EPSG:32632 --to-crs EPSG:4326".to_owned(), "0"),
        (feet(0.3048), "2"),
        (feet(0.304_800_609_601_219_2), "21"),
    ] {
        assert_eq!(units(&options).as_deref(), Some(number), "{options}");
    }
    folder.write("a.svg", SVG);
    folder.run("draw a.svg -o b.dxf --dxf-units map").fails(2, "an SVG has no map's coordinates");
    folder.run("draw utm.geojson -o b.svg --dxf-units map").fails(2, "it is for .dxf files");
}

#[test]
fn features_are_drawn_that_meet_conditions() {
    let folder = Folder::new();
    let city = |x: u32, people: u32| {
        format!(
            r#"{{"type":"Feature","properties":{{"people":{people}}},"geometry":{{"type":"Point","coordinates":[{x},2]}}}}"#
        )
    };
    folder.write("c.geojsonl", [city(1, 10), city(2, 200), city(3, 3000)].join("\n"));
    let counts = |line: &str| {
        let printed = folder.must(&format!("draw {line} -o a.png --json --window 0,0,4,4")).json();
        printed["layers"]
            .as_array()
            .expect("layers")
            .iter()
            .map(|l| l["map"]["points"].clone())
            .collect::<Vec<_>>()
    };
    assert_eq!(counts("c.geojsonl --where people>10"), [2]);
    assert_eq!(counts("c.geojsonl --where people>10 --where people<1000 c.geojsonl"), [1, 3]);
    assert_eq!(counts("--where people>10 c.geojsonl c.geojsonl --where people!=200"), [2, 1]);
    let ended = folder.must("draw c.geojsonl --where people=1 -o a.png --window 0,0,4,4");
    assert!(ended.err.contains("3 features were read, and none meets --where"), "{}", ended.err);
    folder.write("a.svg", SVG);
    folder.run("draw a.svg --where a=1 -o a.png").fails(2, "--where is for map data");
}

#[test]
fn layers_in_several_systems_are_reported() {
    let folder = Folder::new();
    folder.write("a.geojson", r#"{"type":"Point","coordinates":[9,48]}"#);
    folder.write("b.wkt", "SRID=25832;POINT (500000 5400000)");
    let ended = folder.must("draw a.geojson b.wkt -o a.png");
    assert!(
        ended.err.contains("a.geojson in EPSG:4326 and b.wkt in EPSG:25832, and are drawn as"),
        "{}",
        ended.err
    );
    folder.write("c.wkt", "SRID=4258;POINT (9 48)\nPOINT (8 47)");
    assert_eq!(folder.must("draw a.geojson c.wkt -o a.png").err, "");
}

#[test]
fn layers_of_several_systems_are_drawn_in_one() {
    let folder = Folder::new();
    let square = |side: f64| {
        format!("SRID=4326;POLYGON ((9 48, {0} 48, {0} {1}, 9 {1}, 9 48))", 9.0 + side, 48.0 + side)
    };
    folder.write("a.wkt", square(1.0));
    folder.must("clip a.wkt --to-crs EPSG:32632 -o utm.csv");
    let stated = String::from_utf8(folder.read("utm.csv")).expect("text");
    folder.write("bare.csv", stated.replace("SRID=32632;", ""));
    let view =
        "--window 490000,5300000,600000,5440000 --size 200x --fill black --stroke none --aa none";
    let draw = |layers: &str, options: &str| {
        folder.must(&format!("draw {view} {layers} {options} -o o.png"));
        folder.read("o.png")
    };
    let (direct, converted) = (draw("utm.csv", ""), draw("a.wkt", "--to-crs EPSG:32632"));
    assert!(direct == converted, "the window is in the new system");
    let both = draw("a.wkt bare.csv --from-crs EPSG:32632", "--to-crs EPSG:32632");
    assert!(both == converted, "--from-crs is that of the layer before it");
    let ended = folder.run("draw bare.csv --to-crs EPSG:4326 -o o.png");
    ended.fails(2, "bare.csv: --to-crs: ");
    assert!(ended.err.contains("--from-crs sets the system of the input"), "{}", ended.err);
    let ended = folder.must("draw a.wkt utm.csv --from-crs EPSG:32632 -o o.png");
    assert!(ended.err.contains("; --to-crs converts them"), "{}", ended.err);
    folder.write("p.wkt", "SRID=4326;POINT (0 90)\nSRID=4326;POINT (0 0)");
    let ended = folder.must("draw p.wkt --to-crs 3857 -o o.png --json");
    assert_eq!(ended.json()["layers"][0]["map"]["features"], 1, "{}", ended.err);
    assert!(ended.err.contains("1 feature reaches beyond the area of EPSG:3857"), "{}", ended.err);
    folder.write("a.svg", SVG);
    folder.run("draw a.svg --to-crs 3857 -o o.png").fails(2, "--to-crs are for map data");
    folder.run("draw a.svg --skip-failures -o o.png").fails(2, "--skip-failures is for map data");
}

#[test]
fn broken_features_are_left_out_of_maps_on_request() {
    let folder = Folder::new();
    folder.write("a.wkt", "POINT (1 2)\nPOINT (3\nPOINT (5 6)\n");
    folder.run("draw a.wkt -o a.png").fails(1, "line 3, column 1, feature 2: ");
    assert!(!folder.path("a.png").exists());
    let ended = folder.run("draw a.wkt -o a.png --skip-failures --json");
    ended.fails(3, "1 feature cannot be read and is left out: ");
    assert_eq!(ended.json()["layers"][0]["map"]["points"], 2);
    assert!(folder.path("a.png").exists(), "the rest is drawn");
}

#[test]
fn options_of_labels_and_strokes_that_do_nothing_are_reported() {
    let folder = Folder::new();
    folder.write("a.wkt", "LINESTRING (0 0, 9 9)");
    for (options, printed) in [
        ("a.wkt --label-size 9", "--label-size: it has no effect: there is no --label"),
        ("--label-halo red a.wkt a.wkt", "--label-halo: it has no effect: there is no --label"),
        ("a.wkt --stroke none --dashes 2,1", "--dashes: it has no effect: --stroke is none"),
    ] {
        let ended = folder.must(&format!("draw {options} -o a.svg"));
        assert!(
            ended.err.contains(&format!("durer: warning: {printed}")),
            "{options}: {}",
            ended.err
        );
    }
    folder.write("b.geojson", MAP);
    for options in
        ["--label-size 9 a.wkt b.geojson --label name", "--dashes 2,1 a.wkt --stroke none a.wkt"]
    {
        let ended = folder.must(&format!("draw {options} -o a.svg"));
        assert!(!ended.err.contains("no effect"), "{options}: {}", ended.err);
    }
}
