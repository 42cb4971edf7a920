//! Annotations on the command line: names of objects, annotation files, refused input.

use crate::harness::Folder;
use std::fs;

/// Returns a nut, a bolt and a ring.
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
    // The nut has two cylinders; only the hole can be M8.
    assert!(wrong.err.contains("boss 1 of `nut` has a diameter of 13"), "{}", wrong.err);
    let found = labels(&folder.read("n.svg"));
    for text in ["25 h7", "polished", "M8"] {
        assert!(found.iter().any(|l| l == text), "{found:?}");
    }
    folder.must(&format!("{shared} -o n.dxf --annotations a.toml --hidden dashed --center-lines"));
    let dxf = String::from_utf8_lossy(&folder.read("n.dxf")).into_owned();
    for part in
        ["AcDbRotatedDimension", "\n*D1\n", "\nCENTER\n", "25 h7", "\ndimension\n", "\n$DIMLFAC\n"]
    {
        assert!(dxf.contains(part), "{part}");
    }
}

#[test]
fn what_is_wrong_is_reported() {
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
    // An annotation without a place gives a warning, and the rest is drawn.
    let ended = folder.must("render parts.obj -o x.svg --fov 40 --dimension size");
    assert!(ended.err.contains("perspective"), "{}", ended.err);
    let ended = folder.must("render cube.obj -o x.svg --view front --dimension holes,size");
    assert!(ended.err.contains("has no hole"), "{}", ended.err);
    assert_eq!(labels(&folder.read("x.svg")), ["2", "2"]);
}

/// A bar along x from 0 to 300, 20 thick, with a step at each end.
const BAR: &str = "v 0 -10 -10\nv 300 -10 -10\nv 300 10 -10\nv 0 10 -10\nv 0 -10 10\nv 300 -10 10\nv 300 10 10\nv 0 10 10\n\
                   f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

#[test]
fn broken_views_keep_true_lengths() {
    let folder = Folder::new();
    folder.write("bar.obj", BAR);
    fs::write(
        folder.path("a.toml"),
        "[[dimension]]\nkind = 'linear'\nfrom = [20, 10, 10]\nto = [280, 10, 10]\nview = 'front'\n",
    )
    .unwrap();
    let shared = "render bar.obj --break x:50,250 --dimension size";
    folder.must(&format!("{shared} -o s.svg --sheet third-angle --annotations a.toml"));
    let found = labels(&folder.read("s.svg"));
    for text in ["300", "260", "20"] {
        assert!(found.iter().any(|l| l == text), "{found:?}");
    }
    let svg = String::from_utf8_lossy(&folder.read("s.svg")).into_owned();
    assert!(svg.contains("inkscape:label=\"visible-break\""));
    folder.must(&format!("{shared} -o b.dxf --view front"));
    let dxf = String::from_utf8_lossy(&folder.read("b.dxf")).into_owned();
    // Programs that measure again find another length, so the text states it.
    assert!(dxf.contains("\n  1\n300\n") || dxf.contains("\n1\n300\n"));
    // The paper is as wide as the remaining parts: two ends of 50 and a gap.
    let json = folder.must("render bar.obj -o b.dxf --view front --break x:50,250 --json").json();
    let width = json["models"][0]["pictures"][0]["drawing"]["page"][0].as_f64().unwrap();
    assert!((width - 102.5 - 10.0 - 0.5).abs() < 1e-6, "{width}");
}

#[test]
fn breaks_that_cannot_be_shown_are_reported() {
    let folder = Folder::new();
    folder.write("bar.obj", BAR);
    for (options, part) in [
        ("-o b.geojson --break x:50,250", "GeoJSON"),
        ("-o b.svg --break x:50,250 --fov 30", "perspective"),
        ("-o b.svg --break x:50,350", "between 0 and 300"),
        ("-o b.svg --break x:250,50", "FROM below TO"),
        ("-o b.png --break x:50,250", "it is for drawings"),
        ("-o b.gif --style hidden-line --turntable 3 --break x:50,250", "all sides"),
    ] {
        let ended = folder.run(&format!("render bar.obj {options}"));
        assert!(ended.code == 2 && ended.err.contains(part), "{options}: {}", ended.err);
    }
    let printed = folder.must("render bar.obj -o b.svg --break x:50,250 --view right").err;
    assert!(printed.contains("no view shows x in its true length"), "{printed}");
    let printed = folder.must("render bar.obj -o b.svg --break x:50,250 --view top").err;
    assert!(!printed.contains("no view"), "{printed}");
}

#[test]
fn objects_of_obj_and_stl_files_are_parts() {
    let folder = folder();
    let list = |model: &str| {
        folder.must(&format!("render {model} -o p.svg --sheet third-angle --page A3 --callouts"));
        labels(&folder.read("p.svg"))
    };
    let found = list("parts.obj");
    for text in ["nut", "bolt", "ring", "1", "2", "3"] {
        assert!(found.iter().any(|l| l == text), "{text}: {found:?}");
    }
    // Copies are counted.
    let tetrahedron = |name: &str, x: u32| {
        let y = x + 3;
        format!(
            "o {name}\nv {x} 0 0\nv {y} 0 0\nv {x} 4 0\nv {x} 0 5\nf -4 -2 -3\nf -4 -3 -1\nf -3 -2 -1\nf -2 -4 -1\n"
        )
    };
    folder.write(
        "pins.obj",
        tetrahedron("pin.1", 0) + &tetrahedron("lid", 9) + &tetrahedron("pin.2", 20),
    );
    let found = list("pins.obj");
    assert!(
        found.iter().any(|l| l == "pin") && found.iter().filter(|l| *l == "2").count() >= 2,
        "{found:?}"
    );
    // With a single object, its groups are the parts.
    let grouped = parts().replace("o nut", "o all\ng nut").replace("\no ", "\ng ");
    folder.write("groups.obj", &grouped);
    assert_eq!(list("groups.obj").iter().filter(|l| *l == "bolt").count(), 1);
    let facet = |z: u32| {
        format!(
            "facet normal 0 0 1\nouter loop\nvertex 0 0 {z}\nvertex 9 0 {z}\nvertex 0 9 {z}\nendloop\nendfacet\n"
        )
    };
    let solid = |name: &str, z: u32| format!("solid {name}\n{}endsolid {name}\n", facet(z));
    folder.write("s.stl", solid("lid", 5) + &solid("", 3) + &solid("lid", 0));
    let found = list("s.stl");
    // Two of the three are alike.
    for text in ["lid", "solid 1", "2"] {
        assert!(found.iter().any(|l| l == text), "{text}: {found:?}");
    }
    let height = |options: &str| {
        let json = folder
            .must(&format!("render s.stl -o s.svg --view front --scale 1:1 --json {options}"));
        json.json()["models"][0]["pictures"][0]["drawing"]["page"][1].as_f64().unwrap()
    };
    assert!(height("--explode z:20") > height("") + 30.0);
}
