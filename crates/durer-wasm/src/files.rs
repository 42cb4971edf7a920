//! Files that a page opens: as inputs of lessons, and as models to render.

use crate::answer::Failure;
use crate::input::InputData;
use durer::math::DVec2;
use durer::pipeline::{RenderOptions, SurfaceMethod, render as rendered};
use durer::view::projection::{FitOptions, ViewDirection, fit_scene};
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
        json!({ "name": info.name, "title": info.title })
    };
    json!({ "methods": SurfaceMethod::ALL.iter().map(method).collect::<Vec<_>>() })
}

/// Renders a model to a PNG.
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
        ..RenderOptions::new(camera)
    };
    let (picture, _) = rendered(&scene, &options).map_err(words)?;
    let mut png = Vec::new();
    write_color(&mut png, &picture.color, Compression::Fast).map_err(|e| e.to_string())?;
    Ok(png)
}
