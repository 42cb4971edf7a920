//! Files that a page opens: as inputs of lessons, and as models to render.

use crate::answer::Failure;
use crate::input::InputData;
use crate::lessons::word;
use durer::explain::{Figure, Input, Operations, Word, title};
use durer::math::DVec2;
use durer::pipeline::{RenderOptions, Samples, SurfaceMethod, render as rendered, render_counted};
use durer::view::projection::{FitOptions, ViewDirection, fit_scene};
use durer_formats::formula::Formula;
use durer_formats::png::{Compression, write_color};
use durer_formats::{Limits, NoResources, ReadOptions, lesson, read_model};
use serde::Deserialize;
use serde_json::{Value, json};

/// The most bytes of a file after decompression.
const MOST_BYTES: u64 = 64 << 20;

/// The most pixels of a picture.
const MOST_PIXELS: u64 = 4 << 20;

/// The part of a picture that the model leaves free at each border, as in pictures of the command.
const MARGIN: f64 = 0.03;

/// Request to read a file.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ReadRequest {
    /// Name of the file, by whose suffix some formats are known.
    name: String,
    /// Column and row of the pixel from which a picture is filled.
    #[serde(default)]
    seed: [u32; 2],
}

/// Request to render a model.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct RenderRequest {
    /// Name of the file.
    name: String,
    /// Name of a method for visible surfaces.
    method: String,
    width: u32,
    height: u32,
    /// Direction to the eye around the up axis and above the horizon, in degrees.
    azimuth: f64,
    elevation: f64,
    /// True to put the method's counts of operations before the picture: JSON and a zero byte.
    #[serde(default)]
    counts: bool,
}

/// Request for curves of a surface.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct FormulaRequest {
    /// Formula y = f(x, z) in text.
    formula: String,
    /// Points of each curve.
    columns: u32,
    /// Number of curves.
    curves: u32,
}

/// The range of x and z in which a formula is evaluated, as that of `durer plot`.
const FORMULA_RANGE: f64 = 4.0;

/// The height of a surface on the page, and the part of it by which each curve is shifted up against the one before it, in columns.
const FORMULA_HEIGHT: f64 = 0.3;
const FORMULA_RISE: f64 = 0.08;

/// Returns the curves of a surface from the nearest to the farthest, each a little higher than the one before, as an input of
/// the floating horizon.
pub(crate) fn formula(request: &FormulaRequest) -> Result<Value, Failure> {
    let formula = Formula::parse(&request.formula).map_err(|e| e.to_string())?;
    let columns = request.columns.clamp(2, 60);
    let curves = request.curves.clamp(1, 24);
    let along =
        |k: u32, n: u32| FORMULA_RANGE * (2.0 * f64::from(k) / f64::from((n - 1).max(1)) - 1.0);
    let mut heights = Vec::new();
    for curve in 0..curves {
        // The nearest curve has the largest z.
        let z = -along(curve, curves);
        for column in 0..columns {
            let x = along(column, columns);
            let y = formula.evaluate(x, z);
            if !y.is_finite() {
                return Err(format!("the formula has no value at x = {x:.3}, z = {z:.3}"));
            }
            heights.push(y);
        }
    }
    let (low, high) = heights.iter().fold((f64::MAX, f64::MIN), |(l, h), &y| (l.min(y), h.max(y)));
    if !(high - low).is_finite() {
        return Err(format!("the values of the formula, {low:e} to {high:e}, differ too much"));
    }
    let wide = f64::from(columns);
    let scale = if high > low { FORMULA_HEIGHT * wide / (high - low) } else { 0.0 };
    let lines = heights.chunks(columns as usize).zip(0_u32..).map(|(row, curve)| {
        let rise = f64::from(curve) * FORMULA_RISE * wide;
        let place = |(x, y): (u32, &f64)| {
            // Three decimals are enough for a picture, and keep links short.
            let y = ((y - low) * scale + rise) * 1000.0;
            DVec2::new(x.into(), y.round() / 1000.0)
        };
        (0_u32..).zip(row).map(place).collect()
    });
    let figure = Figure { lines: lines.collect(), ..Figure::default() };
    Ok(json!({ "input": InputData::of_input(&Input::Figure(figure)), "warnings": [] }))
}

fn limits() -> Limits {
    Limits { decoded_bytes: MOST_BYTES, ..Limits::default() }
}

/// Reads a file as an input of a lesson.
pub(crate) fn read(request: &ReadRequest, file: &[u8]) -> Result<Value, Failure> {
    let [x, y] = request.seed;
    let seed = DVec2::new(x.into(), y.into());
    let options = lesson::Options { limits: limits(), window: None, seed };
    let read = lesson::read(file, &request.name, &NoResources, &options);
    let read = read.map_err(|e| format!("{}: {e}", request.name))?;
    Ok(json!({ "input": InputData::of_input(&read.input), "warnings": read.warnings }))
}

/// Returns the methods for visible surfaces.
pub(crate) fn methods() -> Value {
    let method = |method: &SurfaceMethod| {
        let info = method.info();
        json!({ "name": info.name, "title": info.title, "titles": word(title(info)) })
    };
    json!({ "methods": SurfaceMethod::ALL.iter().map(method).collect::<Vec<_>>() })
}

/// Renders a model to a PNG, after the counts of operations if they are requested.
pub(crate) fn render(request: &RenderRequest, file: &[u8]) -> Result<Vec<u8>, Failure> {
    let words = |e: durer::Error| e.to_string();
    let algorithm: SurfaceMethod = request.method.parse().map_err(words)?;
    let reading = ReadOptions { limits: limits(), ..ReadOptions::default() };
    let model = read_model(file, &request.name, &NoResources, &reading);
    let scene = model.map_err(|e| format!("{}: {e}", request.name))?.scene;
    let (width, height) = (request.width.max(1), request.height.max(1));
    let aspect = f64::from(width) / f64::from(height);
    let direction = ViewDirection::from_angles(request.azimuth, request.elevation, scene.up_axis)
        .map_err(words)?;
    let options = FitOptions { aspect, margin: MARGIN, ..FitOptions::default() };
    let camera = fit_scene(&scene, &direction, &options).map_err(words)?;
    let options = RenderOptions {
        algorithm,
        width,
        height,
        max_pixels: MOST_PIXELS,
        // One for all: methods that take only one would differ at every edge otherwise.
        samples: Samples::One,
        ..RenderOptions::new(camera)
    };
    let mut answer = Vec::new();
    let picture = if request.counts {
        let (picture, _, operations) = render_counted(&scene, &options).map_err(words)?;
        answer = counts(&operations).to_string().into_bytes();
        answer.push(0);
        picture
    } else {
        rendered(&scene, &options).map_err(words)?.0
    };
    write_color(&mut answer, &picture.color, Compression::Fast).map_err(|e| e.to_string())?;
    Ok(answer)
}

fn counts(operations: &[Operations]) -> Value {
    let count = |of: &Operations| {
        let Operations { name, title, count } = *of;
        json!({ "name": name, "title": word(title), "count": count })
    };
    json!({ "counts": operations.iter().map(count).collect::<Vec<_>>() })
}
