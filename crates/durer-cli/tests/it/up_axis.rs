//! Each of the six directions can be up.

use crate::harness::{Folder, Picture};
use durer::math::DVec3;
use durer::scene::UpAxis;
use std::fmt::Write;

/// Returns a cube with an arrow upwards, a small box on its right and a smaller one in front of it.
fn model(axis: UpAxis) -> String {
    let mut text = String::new();
    let mut count = 0;
    let mut vertex = |text: &mut String, right: f64, up: f64, front: f64| {
        let p: DVec3 = axis.right() * right + axis.up() * up + axis.front() * front;
        writeln!(text, "v {} {} {}", p.x, p.y, p.z).unwrap();
        count += 1;
        count
    };
    let boxes = [([0.0, 0.0, 0.0], 1.0), ([1.5, 0.0, 0.0], 0.4), ([0.0, 0.0, 1.25], 0.25)];
    for ([x, y, z], r) in boxes {
        let corners: Vec<usize> = (0..8)
            .map(|i| {
                let side = |bit: usize, at: f64| if i >> bit & 1 == 1 { at + r } else { at - r };
                vertex(&mut text, side(0, x), side(1, y), side(2, z))
            })
            .collect();
        for face in
            [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
        {
            let [a, b, c, d] = face.map(|i| corners[i]);
            writeln!(text, "f {a} {b} {c} {d}").unwrap();
        }
    }
    let base = [[-0.6, -0.6], [0.6, -0.6], [0.6, 0.6], [-0.6, 0.6]]
        .map(|[x, z]| vertex(&mut text, x, 1.0, z));
    let tip = vertex(&mut text, 0.0, 2.5, 0.0);
    for i in 0..4 {
        writeln!(text, "f {} {} {tip}", base[(i + 1) % 4], base[i]).unwrap();
    }
    text
}

#[test]
fn an_arrow_points_upwards_whichever_axis_is_up() {
    let folder = Folder::new();
    for view in ["front", "right", "top", "iso"] {
        let mut expected: Option<Vec<bool>> = None;
        for &axis in UpAxis::ALL {
            folder.write("arrow.obj", model(axis));
            let options = format!("--up-axis {} --view {view} --size 61x61 --aa 1", axis.name());
            folder.must(&format!("render arrow.obj -o a.png {options}"));
            let picture = Picture::decode(&folder.read("a.png"));
            let seen: Vec<bool> = picture.pixels().map(|p| p != [255; 3]).collect();
            let wrong = |e: &Vec<bool>| e.iter().zip(&seen).filter(|(a, b)| a != b).count();
            // Edges between pixel centres may be rounded to either side.
            let count = expected.as_ref().map_or(0, wrong);
            assert!(count <= 4, "{view} with {} up: {count} pixels differ", axis.name());
            expected.get_or_insert(seen);
        }
        let seen = expected.unwrap();
        let in_row = |y: usize| seen[y * 61..][..61].iter().filter(|s| **s).count();
        let rows: Vec<usize> = (0..61).map(in_row).filter(|n| *n > 0).collect();
        if view == "front" {
            assert!(rows[0] <= 3 && rows[rows.len() - 1] > 20, "the tip is at the top: {rows:?}");
        }
    }
}

#[test]
fn axes_are_reported_as_they_are_given() {
    let folder = Folder::with_models();
    folder.must("render cube.obj -o a.png --size 8x8 --up-axis -Z");
    folder.run("render cube.obj -o a.png --up-axis w").fails(2, "-x");
    folder.must("pick cube.obj --at 4,4 --size 8x8 --up-axis -y --view top");
}
