//! Measures line drawings: the CPU seconds of hiding alone, and the resulting lines.
//!
//! `make FILE.obj --triangles N` or `hide MODEL`; README.md has the options.

use durer::target::drawing::Drawing;
use durer::trace::NoTrace;
use durer::view::View;
use durer::view::projection::{FitOptions, Lens, ViewDirection, fit_box};
use durer::visibility::line::Smooth;
use durer::visibility::line::hidden_line::{self, Options};
use durer::visibility::line::Intersections;
use durer_formats::{ReadOptions, Resources};
use std::fmt::Write as _;

mod bumps;

struct Nothing;

impl Resources for Nothing {
    fn read(&self, _: &str, _: u64) -> Result<Vec<u8>, String> {
        Err("not read here".to_owned())
    }
}

fn main() {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let value = |name: &str| args.iter().position(|a| a == name).and_then(|i| args.get(i + 1));
    let number = |name: &str, default: f64| value(name).map_or(default, |v| v.parse().expect("number"));
    let has = |name: &str| args.iter().any(|a| a == name);
    let model = args.get(1).expect("model");
    match args.first().map(String::as_str) {
        Some("make") => {
            let triangles = number("--triangles", 69_000.0) as usize;
            std::fs::write(model, bumps::obj(triangles)).expect("written");
            return;
        }
        Some("hide") => {}
        _ => panic!("hide or make"),
    }
    let bytes = std::fs::read(model).expect("model");
    let start = cpu();
    let read = durer_formats::read_model(&bytes, model, &Nothing, &ReadOptions::default());
    let scene = read.expect("model").scene;
    drop(bytes);
    println!("read {:.3} s, {} triangles", cpu() - start, scene.triangle_count());
    let direction = ViewDirection::from_angles(
        number("--azimuth", 45.0),
        number("--elevation", 35.264_389_682_754_654),
        scene.up_axis,
    )
    .expect("view");
    let fit = FitOptions { lens: Lens::Orthographic, ..FitOptions::default() };
    let camera = fit_box(scene.bounds().as_ref(), &direction, &fit).expect("camera");
    let view = View::new(camera, 1000, 1000).expect("view");
    let smooth = if has("--smooth") { Smooth::Auto } else { Smooth::Off };
    let mut options = Options { hidden: !has("--no-hidden"), smooth, ..Options::default() };
    options.tolerance = number("--tolerance", options.tolerance);
    if has("--wire") {
        options.classes = options.classes.with(durer::target::drawing::LineClass::Wire);
    }
    if has("--all-intersections") {
        options.intersections = Intersections::All;
    }
    if has("--no-intersections") {
        options.classes = options.classes.without(durer::target::drawing::LineClass::Intersection);
    }
    let mut seconds = Vec::new();
    let mut drawing = Drawing::default();
    for _ in 0..number("--rounds", 1.0) as usize {
        let start = cpu();
        drawing = hidden_line::draw(&scene, &view, &options, &mut NoTrace).expect("drawing");
        seconds.push(cpu() - start);
    }
    seconds.sort_by(f64::total_cmp);
    println!("hide {:.3} s CPU, median of {}", seconds[seconds.len() / 2], seconds.len());
    let visible = drawing.lines.iter().filter(|l| l.is_visible());
    let points: usize = visible.clone().map(|l| l.points.len()).sum();
    println!(
        "visible {} polylines, {points} points, length {:.6}; hidden {} polylines, length {:.6}; {} MB at most",
        visible.count(),
        drawing.length(|l| l.is_visible()),
        drawing.lines.iter().filter(|l| !l.is_visible()).count(),
        drawing.length(|l| !l.is_visible()),
        peak_megabytes(),
    );
    if let Some(path) = value("--svg") {
        std::fs::write(path, svg(&drawing)).expect("written");
    }
}

/// Returns a bare SVG, to look at.
fn svg(drawing: &Drawing) -> String {
    let Some(b) = drawing.bounds() else { return String::new() };
    let size = b.size().max_element().max(f64::MIN_POSITIVE);
    let scale = 1000.0 / size;
    let mut text = format!(
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='-20 -20 1040 {:.0}' width='1040' fill='none' \
         stroke='black' stroke-width='1.2' stroke-linecap='round' stroke-linejoin='round'>\n\
         <rect x='-20' y='-20' width='2000' height='2000' fill='white' stroke='none'/>\n",
        b.size().y * scale + 40.0
    );
    for line in &drawing.lines {
        let style = if line.is_visible() { "" } else { " stroke='#99c' stroke-width='0.6'" };
        let _ = write!(text, "<path{style} d='M");
        for p in &line.points {
            let q = *p - b.min();
            let _ = write!(text, "{:.3} {:.3} ", q.x * scale, (b.size().y - q.y) * scale);
        }
        text.push_str(if line.closed { "Z'/>\n" } else { "'/>\n" });
    }
    text + "</svg>\n"
}

/// User and system seconds of this process, all threads.
fn cpu() -> f64 {
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let after = stat.rsplit(')').next().unwrap_or_default();
    let ticks: f64 = after.split_whitespace().skip(11).take(2).filter_map(|t| t.parse::<f64>().ok()).sum();
    ticks / 100.0
}

fn peak_megabytes() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|l| l.strip_prefix("VmHWM:"));
    line.and_then(|l| l.trim().trim_end_matches(" kB").trim().parse::<u64>().ok()).unwrap_or(0) / 1024
}
