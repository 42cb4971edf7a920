//! Annotations from the command line: names of objects, files of them, what is refused.

use crate::harness::Folder;
use std::fs;

/// A nut, a bolt and a ring.
fn parts() -> String {
    let mut text = String::new();
    let mut count = 0;
    for (name, x, radii, height) in [
        ("nut", 0.0, [3.4, 6.5], 6.0),
        ("bolt", 25.0, [0.0, 4.0], 30.0),
        ("ring", 60.0, [12.0, 20.0], 5.0),
    ] {
        text += &format!("o {name}\n");
        let [inner, outer] = radii;
        let corners = [(outer, 0.0), (outer, height), (inner, height), (inner, 0.0)];
        for i in 0..48 {
            let (sin, cos) = (f64::from(i) / 48.0 * std::f64::consts::TAU).sin_cos();
            for (r, z) in corners {
                text += &format!("v {:.6} {z} {:.6}\n", x + r * cos, -r * sin);
            }
        }
        for i in 0..48 {
            for k in 0..4 {
                let at = |i: usize, k: usize| count + 4 * (i % 48) + k % 4 + 1;
                text += &format!(
                    "f {} {} {} {}\n",
                    at(i, k),
                    at(i + 1, k),
                    at(i + 1, k + 1),
                    at(i, k + 1)
                );
            }
        }
        count += 4 * 48;
    }
    text
}

fn folder() -> Folder {
    let folder = Folder::with_models();
    fs::write(folder.path("parts.obj"), parts()).unwrap();
    folder
}

fn labels(svg: &[u8]) -> Vec<String> {
    let text = String::from_utf8_lossy(svg);
    let ends = text.split("aria-label=\"").skip(1).filter_map(|t| t.split('"').next());
    let mut labels: Vec<String> = ends.map(str::to_owned).collect();
    labels.sort();
    labels
}

#[test]
fn round_parts_are_listed_and_dimensioned() {
    let folder = folder();
    let options = "--view top --page A3 --dimension size,holes,bosses --center-lines";
    let ended = folder.must(&format!("render parts.obj -o p.svg {options} --json"));
    let drawing = &ended.json()["models"][0]["pictures"][0]["drawing"];
    let list = drawing["features"].as_array().unwrap();
    let names: Vec<&str> = list.iter().map(|f| f["object"].as_str().unwrap()).collect();
    assert_eq!(names, ["nut", "nut", "bolt", "ring", "ring"]);
    let diameters: Vec<f64> = list.iter().map(|f| f["diameter"].as_f64().unwrap()).collect();
    for (found, expected) in diameters.iter().zip([13.0, 6.8, 8.0, 40.0, 24.0]) {
        assert!((found - expected).abs() < 1e-4, "{diameters:?}");
    }
    let svg = folder.read("p.svg");
    let expected = ["40", "86.5", "⌀13", "⌀24", "⌀40", "⌀6.8", "⌀8"];
    assert_eq!(labels(&svg), expected);
    assert!(String::from_utf8_lossy(&svg).contains("inkscape:label=\"center\""));
}

#[test]
fn a_file_names_features_views_and_threads() {
    let folder = folder();
    let file = "[[dimension]]\nkind = 'linear'\nfrom = 'boss 1'\nto = 'bolt'\nview = 'top'\ntext = '<> h7'\n\
                [[dimension]]\nkind = 'note'\nat = [60, 5, 0]\ntext = 'polished'\nview = 'top'\n\
                [[thread]]\nname = 'nut'\nsize = 'M8'\n";
    fs::write(folder.path("a.toml"), file).unwrap();
    let shared = "render parts.obj --sheet third-angle --page A3";
    let wrong = folder.run(&format!("{shared} -o n.svg --annotations a.toml"));
    // The nut has two cylinders, of which only the hole can be M8.
    assert!(wrong.err.contains("boss 1 of `nut` has a diameter of 13"), "{}", wrong.err);
    let found = labels(&folder.read("n.svg"));
    for text in ["25 h7", "polished", "M8"] {
        assert!(found.iter().any(|l| l == text), "{found:?}");
    }
    folder.must(&format!("{shared} -o n.dxf --annotations a.toml --hidden dashed --center-lines"));
    let dxf = String::from_utf8_lossy(&folder.read("n.dxf")).into_owned();
    for part in ["AcDbRotatedDimension", "\n*D1\n", "\nCENTER\n", "25 h7", "\ndimension\n"] {
        assert!(dxf.contains(part), "{part}");
    }
}

#[test]
fn what_is_wrong_is_told() {
    let folder = folder();
    fs::write(folder.path("k.toml"), "[[dimension]]\nkind = 'lineal'\n").unwrap();
    fs::write(
        folder.path("v.toml"),
        "[[dimension]]\nkind = 'diameter'\nof = 'bolt'\nview = 'left'\n",
    )
    .unwrap();
    fs::write(folder.path("s.toml"), "[[dimension]]\nkind = 'diameter'\nof = 'ring'\n").unwrap();
    let cases = [
        ("-o x.svg --thread nat", "nut, bolt, ring"),
        ("-o x.svg --thread nut=W3", "ISO 261"),
        ("-o x.svg --dimension sizes", "size, holes, bosses"),
        ("-o x.geojson --dimension size", "GeoJSON has no paper"),
        ("-o x.png --center-lines", "it is for drawings"),
        ("-o x.svg --annotations k.toml", "k.toml: line 2: kind `lineal`"),
        ("-o x.svg --annotations v.toml", "`left`"),
        ("-o x.svg --annotations s.toml", "boss 3, hole 2"),
        ("-o x.svg --annotations gone.toml", "gone.toml"),
    ];
    for (options, part) in cases {
        let ended = folder.run(&format!("render parts.obj {options}"));
        assert!(ended.code != 0 && ended.err.contains(part), "{options}: {}", ended.err);
    }
    // What has no place is warned of, and the rest is drawn.
    let ended = folder.must("render parts.obj -o x.svg --fov 40 --dimension size");
    assert!(ended.err.contains("perspective"), "{}", ended.err);
    let ended = folder.must("render cube.obj -o x.svg --view front --dimension holes,size");
    assert!(ended.err.contains("has no hole"), "{}", ended.err);
    assert_eq!(labels(&folder.read("x.svg")), ["2", "2"]);
}
