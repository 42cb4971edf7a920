//! resvg's test suite and complex drawings, compared with pictures made by resvg.
//!
//! `resvg.txt` and `resvg_suite.txt` list the drawings that do not match, with reasons; a drawing that is not listed
//! must match, and a listed one must not.

use crate::shared::{Folder, data, files};
use durer::math::{DAffine2, DVec2};
use durer::raster::paint::{Canvas, Options};
use durer::target::Pixels;
use durer_formats::svg::{Drawing, Fonts, ReadOptions};
use durer_formats::{Limits, image};
use std::collections::BTreeMap;
use std::path::Path;

type Picture = Pixels<[u8; 4]>;

const LISTED: &str = include_str!("resvg.txt");
const LISTED_IN_SUITE: &str = include_str!("resvg_suite.txt");

fn reference(path: &Path) -> Picture {
    let bytes = std::fs::read(path).unwrap();
    let image = image::decode(&bytes, "reference", &Limits::default()).unwrap();
    Pixels::from_data(image.width, image.height, image.data).unwrap()
}

/// Returns the drawing in the size of its reference picture. A drawing that cannot be read is
/// empty, as in resvg's tests.
fn render(path: &Path, fonts: &Fonts, size: (u32, u32), background: [u8; 4]) -> Picture {
    let bytes = std::fs::read(path).unwrap();
    let folder = Folder(path.parent().unwrap().to_owned());
    let options = ReadOptions { fonts, resources: &folder, ..ReadOptions::default() };
    let mut canvas = Canvas::new(size.0, size.1, Options::default()).unwrap();
    canvas.clear(background);
    if let Ok(drawing) = Drawing::read(&bytes, &options) {
        let scale = DVec2::new(size.0.into(), size.1.into()) / drawing.size();
        drawing.draw(&mut canvas, DAffine2::from_scale(scale));
    }
    let mut picture = Pixels::new(size.0, size.1, [0; 4]);
    canvas.render(&mut picture).unwrap();
    picture
}

/// Returns the difference of two pictures: the mean over all channels, premultiplied, and the share of pixels with a
/// channel off by more than 8.
#[derive(Debug, Clone, Copy, Default)]
struct Difference {
    mean: f64,
    off: f64,
}

impl Difference {
    fn new(a: &Picture, b: &Picture) -> Self {
        let premultiplied = |c: [u8; 4]| {
            let part = |i: usize| f64::from(c[i]) * f64::from(c[3]) / 255.0;
            [part(0), part(1), part(2), f64::from(c[3])]
        };
        let (mut sum, mut off) = (0.0, 0.0);
        for (a, b) in a.data().iter().zip(b.data()) {
            let (a, b) = (premultiplied(*a), premultiplied(*b));
            let by: [f64; 4] = std::array::from_fn(|i| (a[i] - b[i]).abs());
            sum += by.iter().sum::<f64>();
            off += f64::from(u8::from(by.iter().any(|d| *d > 8.0)));
        }
        let count = a.data().len() as f64;
        Self { mean: sum / count / 4.0, off: off / count }
    }

    fn is_match(&self) -> bool {
        self.mean < 1.0 && self.off < 0.005
    }
}

/// Writes pictures that differ, with the reference, to the folder that `DURER_PICTURES` names.
fn keep(name: &str, found: &Picture, reference: &Picture) {
    let Some(folder) = std::env::var_os("DURER_PICTURES") else { return };
    for (kind, picture) in [("found", found), ("wanted", reference)] {
        let mut bytes = Vec::new();
        durer_formats::png::write_color(&mut bytes, picture, Default::default()).unwrap();
        let name = format!("{}.{kind}.png", name.replace('/', "__"));
        std::fs::write(Path::new(&folder).join(name), bytes).unwrap();
    }
}

/// Describes how a result departs from the list; empty if it agrees.
fn complaint(listed: &str, name: &str, difference: Difference) -> String {
    let lines = listed.lines().filter(|l| !l.starts_with('#') && !l.is_empty());
    let mut names = lines.map(|l| l.split_once(": ").expect("a name, a colon, a reason").0);
    match (difference.is_match(), names.any(|n| n == name)) {
        (false, false) => format!("{name} differs: {difference:?}\n"),
        (true, true) => format!("{name} is listed, but matches: {difference:?}\n"),
        _ => String::new(),
    }
}

/// Draws all files of some chapters below a folder; returns the departures from the list, and the number of files.
fn compare(root: &Path, chapters: &[&str], fonts: &Fonts, listed: &str) -> (String, u32) {
    let mut folders: BTreeMap<String, (u32, u32)> = BTreeMap::new();
    let mut complaints = String::new();
    for path in chapters.iter().flat_map(|chapter| files(&root.join(chapter), &["svg"])) {
        let name = path.strip_prefix(root).unwrap().to_string_lossy().into_owned();
        let wanted = reference(&path.with_extension("png"));
        let found = render(&path, fonts, (wanted.width(), wanted.height()), [0; 4]);
        let difference = Difference::new(&found, &wanted);
        let count = folders.entry(name.rsplit_once('/').unwrap().0.to_owned()).or_default();
        count.0 += u32::from(difference.is_match());
        count.1 += 1;
        if !difference.is_match() {
            keep(&name, &found, &wanted);
        }
        complaints += &complaint(listed, &name, difference);
    }
    for (folder, (good, all)) in &folders {
        println!("{folder}: {good} of {all}");
    }
    let sums = folders.values().fold((0, 0), |s, c| (s.0 + c.0, s.1 + c.1));
    println!("all: {} of {}", sums.0, sums.1);
    (complaints, sums.1)
}

#[test]
fn the_resvg_suite_matches_but_for_what_is_listed() {
    let Some(data) = data() else { return };
    let root = data.join("reference/resvg");
    let chapters = ["masking", "painting", "shapes", "structure"];
    let (complaints, count) = compare(&root, &chapters, &Fonts::new(), LISTED);
    assert!(count > 150, "only {count} drawings found");
    assert!(complaints.is_empty(), "\n{complaints}");
}

#[test]
fn the_suite_with_fonts_matches_but_for_what_is_listed() {
    let Some(root) = data().map(|data| data.join("reference/resvg_suite")) else { return };
    if !root.is_dir() {
        return println!("skipped: no {}", root.display());
    }
    let mut fonts = Fonts::new();
    for file in files(&root.join("fonts"), &["ttf", "otf"]) {
        fonts.add(std::fs::read(file).unwrap());
    }
    let chapters = ["masking", "paint-servers", "painting", "shapes", "structure"];
    let (complaints, count) = compare(&root, &chapters, &fonts, LISTED_IN_SUITE);
    assert!(count > 400, "only {count} drawings found");
    assert!(complaints.is_empty(), "\n{complaints}");
}

#[test]
fn heavy_art_matches_resvg() {
    let Some(data) = data() else { return };
    let fonts = Fonts::new();
    let mut complaints = String::new();
    let mut count = 0;
    for path in files(&data.join("svg"), &["svg"]) {
        let folder = path.parent().unwrap().file_name().unwrap().to_string_lossy();
        let name = format!("{folder}__{}", path.file_stem().unwrap().to_string_lossy());
        let picture = data.join(format!("reference/resvg_render_w512/{name}.png"));
        if !picture.exists() {
            continue;
        }
        let wanted = reference(&picture);
        let found = render(&path, &fonts, (wanted.width(), wanted.height()), [255; 4]);
        let difference = Difference::new(&found, &wanted);
        println!("{name}: {difference:?}");
        if !difference.is_match() {
            keep(&name, &found, &wanted);
        }
        complaints += &complaint(LISTED, &name, difference);
        count += 1;
    }
    assert!(count >= 8, "only {count} drawings found");
    assert!(complaints.is_empty(), "\n{complaints}");
}
