//! A closed mesh of any number of triangles: a ball with bumps of several sizes, as a scan has them.

use std::fmt::Write as _;

/// Wavefront OBJ text of about `triangles` triangles.
pub fn obj(triangles: usize) -> String {
    let rows = ((triangles as f64 / 4.0).sqrt() as usize).max(3);
    let columns = 2 * rows;
    let mut text = String::new();
    let mut point = |u: f64, v: f64| {
        let d = [v.sin() * u.cos(), v.cos(), v.sin() * u.sin()];
        let mut r = 1.0;
        for (k, [a, b, c]) in [[3.0, 1.0, 2.0], [5.0, -4.0, 3.0], [9.0, 7.0, -8.0], [17.0, 19.0, 13.0]]
            .into_iter()
            .enumerate()
        {
            let wave = (a * d[0] + 1.3).sin() + (b * d[1] + 0.4).sin() + (c * d[2]).sin();
            r += wave * 0.09 / (1.0 + 1.6 * k as f64);
        }
        let _ = writeln!(text, "v {:.6} {:.6} {:.6}", d[0] * r, d[1] * r, d[2] * r);
    };
    point(0.0, 0.0);
    for i in 1..rows {
        for j in 0..columns {
            let (u, v) = (j as f64 / columns as f64, i as f64 / rows as f64);
            point(u * std::f64::consts::TAU, v * std::f64::consts::PI);
        }
    }
    point(0.0, std::f64::consts::PI);
    let at = |i: usize, j: usize| 2 + (i - 1) * columns + j % columns;
    let last = 2 + (rows - 1) * columns;
    for j in 0..columns {
        let _ = writeln!(text, "f 1 {} {}", at(1, j + 1), at(1, j));
        let _ = writeln!(text, "f {last} {} {}", at(rows - 1, j), at(rows - 1, j + 1));
        for i in 1..rows - 1 {
            let _ = writeln!(text, "f {} {} {}", at(i, j), at(i, j + 1), at(i + 1, j + 1));
            let _ = writeln!(text, "f {} {} {}", at(i, j), at(i + 1, j + 1), at(i + 1, j));
        }
    }
    text
}
