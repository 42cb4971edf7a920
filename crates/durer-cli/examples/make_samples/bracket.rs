//! A bent sheet-metal bracket with holes, rounded corners and a boss with a fillet; closed.
//!
//! The flat sheet is a grid of square cells that all have the same points on their sides, so that cells with and
//! without holes fit together; then the sheet is bent. Millimetres, z up.

use durer::math::{DVec2, DVec3};
use std::f64::consts::{FRAC_PI_2, TAU};

/// Points around a hole, and around the border of a cell.
const AROUND: usize = 48;
/// Half of a cell's side.
const HALF: f64 = 10.0;
/// Half the side of a cell.
const THICK: f64 = 4.0;
/// Radius of the plate's corners.
const CORNER: f64 = 8.0;
/// Rows of cells across the sheet.
const ROWS: usize = 3;
/// Columns of cells in the lying leg.
const LYING: usize = 3;
/// Columns of cells in the standing leg.
const STANDING: usize = 2;
/// Columns of cells in the horizontal leg.
const STRIPS: usize = 12;
/// Columns of cells in the vertical leg.
const BEND: f64 = 6.0;
/// Length of the bend in the flat sheet, at its middle.
const BENT: f64 = (BEND + THICK * 0.5) * FRAC_PI_2;

/// Returns the bytes of a binary STL file.
pub fn stl() -> Vec<u8> {
    let triangles = sheet();
    let mut bytes = b"bracket, made by durer, CC0".to_vec();
    bytes.resize(80, b' ');
    bytes.extend((triangles.len() as u32).to_le_bytes());
    for [a, b, c] in triangles {
        let normal = (b - a).cross(c - a).normalize_or_zero();
        for v in [normal, a, b, c] {
            bytes.extend(v.to_array().into_iter().flat_map(|x| (x as f32 + 0.0).to_le_bytes()));
        }
        bytes.extend([0, 0]);
    }
    bytes
}

/// Feature in the middle of a cell.
#[derive(Clone, Copy, PartialEq)]
enum Middle {
    Plain,
    Hole(f64),
    Boss,
}

fn sheet() -> Vec<[DVec3; 3]> {
    let mut flat = Vec::new();
    for row in 0..ROWS {
        for column in 0..LYING + STANDING {
            cell(row, column, &mut flat);
        }
        for strip in 0..STRIPS {
            bend_strip(row, strip, &mut flat);
        }
    }
    flat.into_iter().map(|triangle| triangle.map(bent)).collect()
}

fn middle(row: usize, column: usize) -> Middle {
    let outer = row != 1;
    match column {
        0 | 2 if outer => Middle::Hole(3.3),
        1 if !outer => Middle::Boss,
        4 if outer => Middle::Hole(4.5),
        3 if !outer => Middle::Hole(6.0),
        _ => Middle::Plain,
    }
}

/// Returns the position of the cell's middle in the flat sheet.
fn center(row: usize, column: usize) -> DVec2 {
    let bend = if column < LYING { 0.0 } else { BENT };
    DVec2::new((2 * column + 1) as f64 * HALF + bend, (2 * row + 1) as f64 * HALF)
}

/// Returns the direction of point i around a cell's middle.
fn direction(i: usize) -> DVec2 {
    let (sin, cos) = libm::sincos(TAU * (i % AROUND) as f64 / AROUND as f64);
    DVec2::new(cos, sin)
}

/// Returns which sides of a cell lie on the sheet's border: left, right, lower, upper.
fn borders(row: usize, column: usize) -> [bool; 4] {
    [column == 0, column == LYING + STANDING - 1, row == 0, row == ROWS - 1]
}

/// Point i on the border of a cell, seen from its middle; outer corners are round.
fn border_point(row: usize, column: usize, i: usize) -> DVec2 {
    let d = direction(i);
    let square = d * (HALF / d.abs().max_element());
    let [left, right, lower, upper] = borders(row, column);
    let corner = (if d.x < 0.0 { left } else { right }) && (if d.y < 0.0 { lower } else { upper });
    let flat_to = HALF - CORNER;
    if !corner || square.abs().min_element() <= flat_to + 1e-9 {
        return square;
    }
    // The ray s·d meets the circle of radius CORNER around the corner's middle m: its farther root.
    let m = d.signum() * flat_to;
    let along = d.dot(m);
    d * (along + (along * along - m.length_squared() + CORNER * CORNER).sqrt())
}

/// Adds both faces of a cell, its hole or boss, and its part of the sheet's rim.
fn cell(row: usize, column: usize, out: &mut Vec<[DVec3; 3]>) {
    let c = center(row, column);
    let border = |i: usize| border_point(row, column, i % AROUND) + c;
    let lift = |p: DVec2, z: f64| p.extend(z);
    for i in 0..AROUND {
        let (a, b) = (border(i), border(i + 1));
        let ring =
            |r: f64, z: f64| [lift(direction(i) * r + c, z), lift(direction(i + 1) * r + c, z)];
        let mut profile = vec![[lift(a, THICK), lift(b, THICK)]];
        profile.extend(profile_of(middle(row, column)).into_iter().map(|(r, z)| ring(r, z)));
        profile.push([lift(a, 0.0), lift(b, 0.0)]);
        for pair in profile.windows(2) {
            quad([pair[0][0], pair[0][1], pair[1][1], pair[1][0]], out);
        }
        if on_rim(row, column, i) {
            quad([lift(a, 0.0), lift(b, 0.0), lift(b, THICK), lift(a, THICK)], out);
        }
    }
}

/// Returns whether the piece of a cell's border after point i is the sheet's border.
fn on_rim(row: usize, column: usize, i: usize) -> bool {
    let between = direction(i) + direction(i + 1);
    let [left, right, lower, upper] = borders(row, column);
    if between.x.abs() > between.y.abs() {
        if between.x < 0.0 { left } else { right }
    } else if between.y < 0.0 {
        lower
    } else {
        upper
    }
}

/// Radius and height of the rings from the upper face to the lower one.
fn profile_of(middle: Middle) -> Vec<(f64, f64)> {
    match middle {
        Middle::Plain => vec![(0.0, THICK), (0.0, 0.0)],
        Middle::Hole(r) => vec![(r, THICK), (r, 0.0)],
        Middle::Boss => boss(),
    }
}

/// Returns the rings of a boss: a fillet of 2.5 at the foot, a round of 1 at the top, a bore of 3.
fn boss() -> Vec<(f64, f64)> {
    const STEPS: usize = 8;
    let (radius, foot, round, top, bore) = (6.0, 2.5, 1.0, 16.0, 3.0);
    let angle = |i: usize| libm::sincos(FRAC_PI_2 * i as f64 / STEPS as f64);
    let mut rings = Vec::new();
    for (sin, cos) in (0..=STEPS).map(angle) {
        rings.push((radius + foot - foot * sin, THICK + foot - foot * cos));
    }
    for (sin, cos) in (0..=STEPS).map(angle) {
        rings.push((radius - round + round * cos, top - round + round * sin));
    }
    rings.extend([(bore, top), (bore, 0.0)]);
    rings
}

/// One strip of the bend across one row, with the points of the cells' sides.
fn bend_strip(row: usize, strip: usize, out: &mut Vec<[DVec3; 3]>) {
    let x = |i: usize| (2 * LYING) as f64 * HALF + BENT * i as f64 / STRIPS as f64;
    let (x0, x1) = (x(strip), x(strip + 1));
    let eighth = AROUND / 8;
    let y = |i: usize| {
        let point = border_point(1, 1, (AROUND - eighth + i) % AROUND);
        point.y + (2 * row + 1) as f64 * HALF
    };
    let at = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
    for i in 0..2 * eighth {
        let (y0, y1) = (y(i), y(i + 1));
        quad([at(x0, y0, THICK), at(x1, y0, THICK), at(x1, y1, THICK), at(x0, y1, THICK)], out);
        quad([at(x0, y0, 0.0), at(x0, y1, 0.0), at(x1, y1, 0.0), at(x1, y0, 0.0)], out);
    }
    if row == 0 {
        let y = y(0);
        quad([at(x0, y, 0.0), at(x1, y, 0.0), at(x1, y, THICK), at(x0, y, THICK)], out);
    }
    if row == ROWS - 1 {
        let y = y(2 * eighth);
        quad([at(x0, y, 0.0), at(x0, y, THICK), at(x1, y, THICK), at(x1, y, 0.0)], out);
    }
}

/// Returns the position of a point of the flat sheet after bending, on a grid of a millionth of a
/// millimetre so that equal points stay equal.
fn bent(p: DVec3) -> DVec3 {
    let start = (2 * LYING) as f64 * HALF;
    let from_axis = BEND + THICK - p.z;
    let bent = if p.x <= start {
        p
    } else if p.x >= start + BENT {
        DVec3::new(start + from_axis, p.y, THICK + BEND + p.x - start - BENT)
    } else {
        let (sin, cos) = libm::sincos((p.x - start) / BENT * FRAC_PI_2);
        DVec3::new(start + from_axis * sin, p.y, THICK + BEND - from_axis * cos)
    };
    (bent * 1e6).round() / 1e6
}

/// Two triangles, or one where two corners meet.
fn quad([a, b, c, d]: [DVec3; 4], out: &mut Vec<[DVec3; 3]>) {
    for triangle in [[a, b, c], [a, c, d]] {
        let [p, q, r] = triangle.map(bent);
        if p != q && q != r && r != p {
            out.push(triangle);
        }
    }
}
