//! Models larger than the budget are read in pieces: pictures, reports and warnings are the same as for the whole.

use crate::harness::{Folder, Picture};
use serde_json::Value;
use std::f32::consts::{PI, TAU};

/// Enough for a piece and a small picture, too little for the models.
const BUDGET: &str = "--max-memory 1100k";

/// Returns corners of triangles of a wavy ball far from the origin; every eighth triangle occurs twice.
fn triangles() -> Vec<[[f32; 3]; 3]> {
    let (rows, columns) = (60, 100);
    let at = |i: u32, j: u32| {
        let (theta, phi) = (i as f32 * PI / rows as f32, j as f32 * TAU / columns as f32);
        let radius = 2.0 + 0.3 * libm::sinf(9.0 * theta) * libm::sinf(11.0 * phi);
        let flat = radius * libm::sinf(theta);
        [30.0 + flat * libm::cosf(phi), flat * libm::sinf(phi), radius * libm::cosf(theta)]
    };
    let mut all = Vec::new();
    for (i, j) in (0..rows).flat_map(|i| (0..columns).map(move |j| (i, j))) {
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        all.extend([[a, b, c], [a, c, d]]);
    }
    let again: Vec<_> = all.iter().copied().step_by(8).collect();
    all.extend(again);
    all[9001][1][2] = f32::NAN;
    all
}

/// Returns a binary STL file; some facets have colours that depend on their number.
fn stl(is_colored: impl Fn(usize) -> bool) -> Vec<u8> {
    let all = triangles();
    let mut file = vec![b' '; 80];
    file.extend((all.len() as u32).to_le_bytes());
    for (i, corners) in all.iter().enumerate() {
        file.extend([0; 12]);
        file.extend(corners.as_flattened().iter().flat_map(|v| v.to_le_bytes()));
        let color = if is_colored(i) { 0x8000 | i as u16 } else { 0 };
        file.extend(color.to_le_bytes());
    }
    file
}

/// Contents of a PLY file.
#[derive(Clone, Copy, Default)]
struct Ply {
    big: bool,
    wide: bool,
    normals: bool,
    colors: bool,
    faces: bool,
}

impl Ply {
    fn number(self, v: f64, wide: bool) -> Vec<u8> {
        let mut bytes =
            if wide { v.to_le_bytes().to_vec() } else { (v as f32).to_le_bytes().to_vec() };
        if self.big {
            bytes.reverse();
        }
        bytes
    }

    /// Returns a binary file with an unused vertex far away; faces are triangles, quads and some with a missing vertex.
    fn file(self) -> Vec<u8> {
        let all = triangles();
        let points: Vec<[f32; 3]> = all.iter().flatten().copied().chain([[900.0; 3]]).collect();
        let order = if self.big { "big" } else { "little" };
        let kind = if self.wide { "double" } else { "float" };
        let mut head =
            format!("ply\nformat binary_{order}_endian 1.0\nelement vertex {}\n", points.len());
        let mut say = |names: &str, kind: &str| {
            names.split(' ').for_each(|name| head += &format!("property {kind} {name}\n"));
        };
        say("x y z", kind);
        if self.normals {
            say("nx ny nz", "float");
        }
        if self.colors {
            say("red green blue", "uchar");
        }
        let quads = all.len() / 4;
        if self.faces {
            head += &format!("element face {}\nproperty uchar flags\n", all.len() - quads + 1);
            head += "property list uchar int vertex_indices\n";
        }
        head += "end_header\n";
        let mut file = head.into_bytes();
        for (i, point) in points.iter().enumerate() {
            let far = if self.wide { 5e4 } else { 0.0 };
            point.iter().for_each(|&v| file.extend(self.number(f64::from(v) + far, self.wide)));
            if self.normals {
                [0.6, 0.0, 0.8].iter().for_each(|&v| file.extend(self.number(v, false)));
            }
            if self.colors {
                file.extend([i as u8, (i / 9) as u8, (i / 70) as u8]);
            }
        }
        let index = |i: usize| {
            let bytes = (i as u32).to_le_bytes();
            if self.big { bytes.iter().rev().copied().collect() } else { bytes.to_vec() }
        };
        if self.faces {
            for i in 0..quads {
                file.extend([7, 4]);
                // A quad of two triangles side by side.
                [6 * i, 6 * i + 1, 6 * i + 2, 6 * i + 5]
                    .iter()
                    .for_each(|&v| file.extend(index(v)));
            }
            file.extend([7, 3]);
            [0, 1, 99_999].iter().for_each(|&v| file.extend(index(v)));
            for i in 2 * quads..all.len() {
                file.extend([7, 3]);
                [3 * i, 3 * i + 1, 3 * i + 2].iter().for_each(|&v| file.extend(index(v)));
            }
        }
        file
    }
}

/// Compares the pictures of a model in pieces with those of the whole.
#[track_caller]
fn compare(folder: &Folder, model: &str, options: &str) {
    let planes = |of: &str| {
        if options.contains("planes") {
            format!("--item {of}i.png --depth {of}d.png --normal {of}n.png")
        } else {
            String::new()
        }
    };
    let options = options.replace("planes", "");
    let run = |name: &str, more: &str| {
        let planes = planes(name);
        folder.must(&format!("render {model} -o {name}.png {options} {planes} --json {more}"))
    };
    let (whole, pieces) = (run("whole", ""), run("pieces", &format!("{BUDGET} -v")));
    assert!(pieces.err.contains("read in pieces"), "{model} {options}: {}", pieces.err);
    for plane in ["", "i", "d", "n"] {
        let [a, b] = ["whole", "pieces"].map(|name| format!("{name}{plane}.png"));
        if folder.path(&a).exists() {
            assert!(folder.read(&a) == folder.read(&b), "{model} {options}: {a}");
            std::fs::remove_file(folder.path(&a)).unwrap();
        } else {
            assert!(!plane.is_empty(), "{model}");
        }
    }
    let printed = |ended: &crate::harness::Ended| {
        let report = ended.json();
        let picture = &report["pictures"][0];
        let of = |value: &Value, names: &[&str]| -> Vec<Value> {
            names.iter().map(|name| value[name].clone()).collect()
        };
        let picture = of(picture, &["triangles", "status", "width", "algorithm", "cameras"]);
        (picture, of(&report["models"][0], &["format", "warnings"]))
    };
    assert_eq!(printed(&whole), printed(&pieces), "{model} {options}");
}

#[test]
fn stl_in_pieces_gives_the_picture_of_the_whole() {
    let folder = Folder::new();
    folder.write("plain.stl", stl(|_| false));
    folder.write("late.stl", stl(|i| i == 9000));
    folder.write("colored.stl", stl(|i| i % 3 > 0));
    for options in [
        "--size 64x48",
        "--size 64x64 --aa 1 planes",
        "--size 64x64 --aa 4 --view top --ortho fit --cull back planes",
        "--size 48x64 --eye 20,9,9 --color teal --shading flat",
        "--size 96x48 --viewports front,right --background transparent",
        "--size 40x40 --eye 31,0,0 --target 30,0,0 --up 0,0,1 --light point:31,0,0:white:3",
    ] {
        compare(&folder, "plain.stl", options);
    }
    compare(&folder, "late.stl", "--size 64x64");
    compare(&folder, "colored.stl", "--size 64x64 --view left");
    let seen = Picture::decode(&folder.read("pieces.png"));
    assert!(seen.shows_something());
}

#[test]
fn ply_in_pieces_gives_the_picture_of_the_whole() {
    let folder = Folder::new();
    let plain = Ply::default();
    for (model, options) in [
        (Ply { faces: true, ..plain }, "--size 64x64 planes"),
        (Ply { faces: true, normals: true, big: true, ..plain }, "--size 64x64 --shading phong"),
        (
            Ply { faces: true, colors: true, wide: true, ..plain },
            "--size 64x48 --aa 1 --view front",
        ),
        (plain, "--size 64x64"),
        (Ply { wide: true, colors: true, ..plain }, "--size 64x64 --aa 1 --point-size 2"),
        (
            Ply { normals: true, big: true, colors: true, ..plain },
            "--size 60x64 --eye 20,9,9 planes",
        ),
    ] {
        folder.write("model.ply", model.file());
        compare(&folder, "model.ply", options);
    }
}

#[test]
fn info_is_reported_of_models_in_pieces() {
    let folder = Folder::new();
    folder.write("a.stl", stl(|i| i == 9000));
    folder.write("a.ply", Ply { faces: true, colors: true, wide: true, ..Ply::default() }.file());
    folder.write("b.ply", Ply { colors: true, ..Ply::default() }.file());
    for model in ["a.stl", "a.ply", "b.ply"] {
        let whole = folder.must(&format!("info {model} --json")).json();
        let mut pieces = folder.must(&format!("info {model} --json {BUDGET}")).json();
        if whole["triangles"] != 0 {
            let warnings = pieces["warnings"].as_array_mut().unwrap();
            let why = warnings.pop().unwrap();
            assert!(why.as_str().unwrap().contains("in pieces"), "{why}");
            assert!(pieces["closed"].is_null());
            for examined in ["closed", "inside_out", "flipped"] {
                pieces[examined] = whole[examined].clone();
            }
        }
        assert_eq!(pieces, whole, "{model}");
    }
}

#[test]
fn what_is_not_seen_or_not_there_is_reported_of_pieces_too() {
    let folder = Folder::new();
    folder.write("a.stl", stl(|_| false));
    for (options, why) in [
        ("--eye 900,0,0 --target 999,0,0", "behind the eye"),
        ("--eye 900,0,0 --target 0,900,0", "outside the picture"),
        (
            "--eye 30,0,0.5 --target 30,0,0 --up 0,1,0 --near 99 --far 100",
            "nearer than the near plane",
        ),
        ("--color white --shading unlit", "has the colour of the background"),
    ] {
        let command = format!("render a.stl -o a.png --size 32x32 {options} {BUDGET}");
        let ended = folder.must(&command);
        assert!(ended.err.contains(why), "{options}: {}", ended.err);
    }
    // A file that ends within a face, and one with more triangles than allowed.
    let mut file = Ply { faces: true, ..Ply::default() }.file();
    file.truncate(file.len() - 7);
    folder.write("cut.ply", file);
    compare(&folder, "cut.ply", "--size 32x32");
    let few = "render a.stl -o b.png --size 32x32 --max-triangles 9000";
    folder.run(&format!("{few} {BUDGET}")).fails(
        1,
        "the number of triangles is 13500, above the limit of 9000; --max-triangles raises it",
    );
}

#[test]
fn what_needs_all_of_the_model_is_refused() {
    let folder = Folder::new();
    folder.write("a.stl", stl(|_| false));
    for options in
        ["--shadows map", "--algorithm ray", "--look studio", "--shading phong", "--turntable 2"]
    {
        let output = if options.contains("turntable") { "a%d.png" } else { "a.png" };
        let command = format!("render a.stl -o {output} --size 32x32 --max-memory 600k {options}");
        folder.run(&command).fails(1, "--max-memory allows").fails(1, "is made in pieces");
    }
    assert_eq!(folder.names(), ["a.stl"]);
}
