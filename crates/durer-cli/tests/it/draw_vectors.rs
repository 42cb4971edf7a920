//! `durer draw` to SVG and PDF: the vectors show what the pixels show.

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

/// Draws to pixels and to SVG, draws the SVG to pixels, and returns the mean and the largest difference of a channel.
fn differences(folder: &Folder, drawing: &str) -> (f64, u8) {
    folder.must(&format!("draw {drawing} -o a.png"));
    folder.must(&format!("draw {drawing} -o v.svg"));
    folder.must("draw v.svg -o b.png");
    let [a, b] = ["a.png", "b.png"].map(|name| Picture::decode(&folder.read(name)));
    assert_eq!(a.size(), b.size());
    let (width, height) = a.size();
    let (mut sum, mut most, mut painted) = (0.0, 0, false);
    for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
        // JPEG-like pictures without transparency have three channels.
        for (p, q) in a.pixel(x, y).iter().zip(b.pixel(x, y)) {
            sum += f64::from(p.abs_diff(*q));
            most = most.max(p.abs_diff(*q));
        }
        painted |= a.pixel(x, y) != a.pixel(0, 0);
    }
    assert!(painted, "{drawing}: nothing is painted");
    (sum / f64::from(width * height), most)
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
        let (mean, most) = differences(&folder, drawing);
        assert!(mean < 0.5 && most <= 24, "{drawing}: {mean} {most}");
    }
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
        "gradient.svg",
        "<linearGradient id='g'><stop stop-color='red'/><stop offset='1'/></linearGradient>
         <rect width='9' height='9' fill='url(#g)'/>",
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
        ("gradient", "gradients"),
        ("blend", "blend modes"),
        ("filter", "filters"),
        ("mask", "masks and clip paths of several shapes"),
    ] {
        let message = format!("{name}.svg: {kind} cannot be written as vectors; a picture (.png)");
        folder.run(&format!("draw {name}.svg -o {name}.pdf")).fails(1, &message);
        folder.must(&format!("draw {name}.svg -o {name}.png"));
        assert!(!folder.path(&format!("{name}.pdf")).exists());
    }
    for (options, part) in [
        ("-o a.dxf", "as vectors in SVG or PDF; end the name in .png"),
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
    let told = folder.must("info t.json --layer b --json").json();
    assert_eq!((&told["name"], &told["features"]), (&"b".into(), &1.into()), "{told}");
    folder.run("info t.json --layer c").fails(1, "there is no layer c");
    folder.write("a.svg", SVG);
    folder.run("draw a.svg --layer b -o a.png").fails(2, "--layer is for map data");
    folder.write("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    folder.run("info m.obj --layer b").fails(2, "--layer: m.obj holds a model");
}
