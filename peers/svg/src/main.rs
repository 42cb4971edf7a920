//! resvg's suite beside resvg itself at sixteen times the size: whose picture is nearer to the drawing?
//!
//! resvg samples coverage by a few rows per pixel and approximates curves by chords of matching length. At sixteen
//! times the size both are sixteen times finer, and the mean of 16 × 16 pixels is a reference for the drawing that is
//! independent of durer.

use durer::math::{DAffine2, DVec2};
use durer::raster::paint::{Canvas, Options};
use durer::target::Pixels;
use durer_formats::svg::{Drawing, Fonts, ReadOptions};
use resvg::{tiny_skia, usvg};
use std::error::Error;
use std::path::{Path, PathBuf};

/// Pixels per pixel of the fine picture.
const FINE: u32 = 16;

/// A pixel with premultiplied alpha, 0 … 255.
type Color = [f64; 4];

/// Returns drawings with one of the elements directly below the root each. Where one shape covers another, means of
/// pixels would show less of the covered one than coverage does, so each is drawn alone.
fn parts(text: &str) -> Result<Vec<String>, Box<dyn Error>> {
    const ALWAYS: [&str; 6] =
        ["title", "desc", "defs", "style", "linearGradient", "radialGradient"];
    let document = roxmltree::Document::parse(text)?;
    let drawn =
        |n: &roxmltree::Node<'_, '_>| n.is_element() && !ALWAYS.contains(&n.tag_name().name());
    let ranges: Vec<_> =
        document.root_element().children().filter(drawn).map(|n| n.range()).collect();
    let only = |i: usize| {
        let mut bytes = text.as_bytes().to_vec();
        let others = ranges.iter().enumerate().filter(|(j, _)| *j != i);
        others.for_each(|(_, range)| bytes[range.clone()].fill(b' '));
        Ok(String::from_utf8(bytes)?)
    };
    (0..ranges.len()).map(only).collect()
}

fn over(below: &mut [Color], top: &[Color]) {
    for (below, top) in below.iter_mut().zip(top) {
        *below = std::array::from_fn(|c| top[c] + below[c] * (1.0 - top[3] / 255.0));
    }
}

/// resvg's picture, each pixel the mean of `n` × `n`.
fn resvg(text: &str, (width, height): (u32, u32), n: u32) -> Result<Vec<Color>, Box<dyn Error>> {
    let mut picture = vec![[0.0; 4]; (width * height) as usize];
    for part in parts(text)? {
        let tree = usvg::Tree::from_str(&part, &usvg::Options::default())?;
        let mut map = tiny_skia::Pixmap::new(width * n, height * n).ok_or("no pixels")?;
        let scale = ((width * n) as f32, (height * n) as f32);
        let size = tree.size();
        let fit = tiny_skia::Transform::from_scale(scale.0 / size.width(), scale.1 / size.height());
        resvg::render(&tree, fit, &mut map.as_mut());
        let mut own = vec![[0.0; 4]; picture.len()];
        for (i, pixel) in map.data().as_chunks::<4>().0.iter().enumerate() {
            let (x, y) = (i as u32 % (width * n) / n, i as u32 / (width * n) / n);
            let sum = &mut own[(y * width + x) as usize];
            (0..4).for_each(|c| sum[c] += f64::from(pixel[c]) / f64::from(n * n));
        }
        over(&mut picture, &own);
    }
    Ok(picture)
}

fn durer(text: &str, (width, height): (u32, u32)) -> Result<Vec<Color>, Box<dyn Error>> {
    let fonts = Fonts::new();
    let drawing =
        Drawing::read(text.as_bytes(), &ReadOptions { fonts: &fonts, ..ReadOptions::default() })?;
    let mut canvas = Canvas::new(width, height, Options::default())?;
    let fit = DAffine2::from_scale(DVec2::new(width.into(), height.into()) / drawing.size());
    drawing.draw(&mut canvas, fit);
    let mut picture = Pixels::new(width, height, [0; 4]);
    canvas.render(&mut picture)?;
    let premultiplied = |c: &[u8; 4]| {
        let alpha = f64::from(c[3]) / 255.0;
        [f64::from(c[0]) * alpha, f64::from(c[1]) * alpha, f64::from(c[2]) * alpha, c[3].into()]
    };
    Ok(picture.data().iter().map(premultiplied).collect())
}

/// Returns the mean difference of all channels, and the percentage of pixels with a channel that differs by more than
/// 8.
fn difference(a: &[Color], b: &[Color]) -> (f64, f64) {
    let (mut sum, mut off) = (0.0, 0);
    for (a, b) in a.iter().zip(b) {
        let by: [f64; 4] = std::array::from_fn(|c| (a[c] - b[c]).abs());
        sum += by.iter().sum::<f64>() / 4.0;
        off += usize::from(by.iter().any(|d| *d > 8.0));
    }
    let count = a.len() as f64;
    (sum / count, 100.0 * off as f64 / count)
}

fn row(root: &Path, name: &str) -> Result<(), Box<dyn Error>> {
    let path = root.join(name);
    let text = std::fs::read_to_string(&path)?;
    let map = tiny_skia::Pixmap::load_png(path.with_extension("png"))?;
    let size = (map.width(), map.height());
    let reference: Vec<Color> =
        map.data().as_chunks::<4>().0.iter().map(|c| c.map(f64::from)).collect();
    let (durer, once, fine) =
        (durer(&text, size)?, resvg(&text, size, 1)?, resvg(&text, size, FINE)?);
    let columns = [
        difference(&durer, &reference),
        difference(&once, &reference),
        difference(&durer, &fine),
        difference(&reference, &fine),
    ];
    let columns = columns.map(|(mean, off)| format!("{mean:.3}, {off:.2} %"));
    println!("| {name} | {} |", columns.join(" | "));
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    let data = std::env::var("DURER_DATA").unwrap_or("../../../../shared/data".into());
    let root = PathBuf::from(data).join("reference/resvg");
    let listed = include_str!("../../../crates/durer-formats/tests/it/resvg.txt");
    println!(
        "| mean difference of 255, pixels off by more than 8 | durer, reference | resvg, reference | durer, resvg at 16 times | reference, resvg at 16 times |"
    );
    println!("|---|---|---|---|---|");
    for line in listed.lines().filter(|l| !l.starts_with('#')) {
        if let Some((name, _)) = line.split_once(": ").filter(|(name, _)| name.ends_with(".svg")) {
            row(&root, name)?;
        }
    }
    Ok(())
}
