//! The laws that hold for any bytes, read as a height map or as a formula: the bodies of the fuzz
//! targets `height_map` and `formula`, which the tests call as well.

use super::words::text;
use durer::math::DVec3;
use durer::scene::{Camera, HeightField, Projection};
use durer::trace::NoTrace;
use durer::visibility::line::floating_horizon::{Options, curves};
use durer_formats::Limits;
use durer_formats::formula::Formula;
use durer_formats::height_map::{HeightMapOptions, read};

/// Points of a surface that is drawn at most, so that one run stays short.
const POINTS: usize = 2048;

/// Returns a camera that looks at a box of any size, from above the front or from a side that `turn`
/// chooses.
fn camera(field: &HeightField, turn: u8) -> Option<Camera> {
    let bounds = field.bounds()?;
    let (center, reach) = (bounds.center(), bounds.size().length().max(1e-3));
    let angle = f64::from(turn) * std::f64::consts::TAU / 256.0;
    let to_eye = DVec3::new(libm::sin(angle), 0.6, libm::cos(angle)).normalize();
    let projection = match turn % 3 {
        0 => Projection::Orthographic { height: reach },
        _ => Projection::Perspective { fov_y: 0.7 },
    };
    let eye = center + to_eye * reach * 2.0;
    Some(Camera {
        eye,
        target: center,
        up: DVec3::Y,
        projection,
        near: reach * 1e-3,
        far: reach * 9.0,
    })
}

/// Lines of a surface lie on the surface, over the ground it covers.
fn draw(field: &HeightField, turn: u8) {
    let Some(camera) = camera(field, turn) else { return };
    let options = Options { hidden: turn.is_multiple_of(2), ..Options::default() };
    let Ok(found) = curves(field, &camera, &options, &mut NoTrace) else { return };
    let Some(bounds) = field.bounds() else { return };
    let slack = DVec3::splat(1e-9 * (1.0 + bounds.min.abs().max(bounds.max.abs()).max_element()));
    for curve in found {
        assert!(curve.points.len() >= 2);
        for point in curve.points {
            let within = point.cmpge(bounds.min - slack) & point.cmple(bounds.max + slack);
            assert!(within.all(), "{point} is not in {bounds:?}");
        }
    }
}

/// Words of the text formats of height maps.
const HEIGHTS: &[&str] = &[
    " ",
    " ",
    "\n",
    ",",
    ";",
    "\t",
    "nan",
    "NA",
    "-9999",
    "1e308",
    "1e-320",
    "0.5",
    "-3",
    "7",
    "[",
    "]",
    "{\"width\":",
    "\"height\":",
    "\"values\":[",
    "}",
    "ncols ",
    "nrows ",
    "cellsize ",
    "xllcorner ",
];

/// Whatever is read has the size it says, and can be drawn.
fn read_and_draw(bytes: &[u8], name: &str, turn: u8) {
    let limits = Limits { decoded_bytes: 1 << 20, ..Limits::default() };
    let options = HeightMapOptions { limits, ..HeightMapOptions::default() };
    let Ok(map) = read(bytes, name, &options) else { return };
    let points = map.field.columns() * map.field.rows();
    assert!(points > 0 && points <= (1 << 17), "{points} points are above the limit");
    if points <= POINTS {
        draw(&map.field, turn);
    }
}

/// A height map from bytes, and from words.
pub fn height_map(bytes: &[u8]) {
    let turn = bytes.last().copied().unwrap_or(0);
    read_and_draw(bytes, "", turn);
    if let Ok(text) = text(bytes, HEIGHTS) {
        read_and_draw(&text, "table.csv", turn);
    }
}

/// A formula in words; those that are understood give a surface that can be drawn.
pub fn formula(bytes: &[u8]) {
    let turn = bytes.first().copied().unwrap_or(0);
    evaluate(&String::from_utf8_lossy(bytes), turn);
    if let Ok(text) = text(bytes, FORMULA) {
        evaluate(&String::from_utf8_lossy(&text), turn);
    }
}

/// Words of formulas.
const FORMULA: &[&str] = &[
    "x", "z", "r", "pi", "e", "(", ")", ")", "+", "-", "*", "/", "%", "^", "**", ",", "sin(",
    "exp(", "ln(", "sqrt(", "atan2(", "min(", "clamp(", "j1(", "sinc(", "abs(", "1e300", ".5", "2",
    "-1", " ", "y=",
];

fn evaluate(text: &str, turn: u8) {
    let Ok(formula) = Formula::parse(text) else { return };
    let (mut stack, ground) = (Vec::new(), [-4.0, 4.0]);
    for (x, z) in [(0.0, 0.0), (-1.5, 2.0), (f64::MAX, f64::NAN)] {
        let (once, again) = (formula.evaluate(x, z), formula.evaluate_on(&mut stack, x, z));
        assert!(once.to_bits() == again.to_bits() || once.is_nan() && again.is_nan(), "{text}");
    }
    let surface = HeightField::from_fn([9, 7], ground, ground, |x, z| formula.evaluate(x, z));
    draw(&surface.expect("sizes and ranges are right"), turn);
}
