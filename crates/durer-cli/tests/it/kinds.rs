//! A small file of each kind that is easily shown wrong: its picture and its messages.

use crate::harness::{Folder, Picture};
use std::fs;
use std::path::{Path, PathBuf};

/// Side of each picture, and pictures per row of the sheet.
const SIDE: usize = 64;
const COLUMNS: usize = 8;

/// Pictures with further options: model, name of the picture, options.
const FURTHER: &[(&str, &str, &str)] =
    &[("x_blend3.gltf", "x_blend3_ray", "--algorithm ray --bounces 2")];

fn tests() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/tests"))
}

/// Returns all models of the folder `kinds`, in order.
fn models() -> Vec<String> {
    let entries = fs::read_dir(tests().join("kinds")).unwrap();
    let names = entries.map(|e| e.unwrap().file_name().into_string().unwrap());
    let is_model = |name: &String| {
        ["gltf", "obj", "ply", "stl", "3mf"].iter().any(|suffix| name.ends_with(suffix))
    };
    let mut models: Vec<_> = names.filter(is_model).collect();
    models.sort();
    models
}

/// Returns a folder with the models and the files that they refer to.
fn folder() -> Folder {
    let folder = Folder::new();
    for entry in fs::read_dir(tests().join("kinds")).unwrap() {
        let entry = entry.unwrap();
        folder.write(&entry.file_name().to_string_lossy(), fs::read(entry.path()).unwrap());
    }
    folder
}

/// Arranges pictures in rows; missing ones are grey.
fn sheet(pictures: &[Option<Picture>]) -> (usize, Vec<u8>) {
    let (width, height) = (COLUMNS * SIDE, pictures.len().div_ceil(COLUMNS) * SIDE);
    let mut rgb = vec![128; width * height * 3];
    for (i, picture) in pictures.iter().enumerate() {
        let Some(picture) = picture else { continue };
        let (left, top) = (i % COLUMNS * SIDE, i / COLUMNS * SIDE);
        for (k, pixel) in picture.pixels().enumerate() {
            let at = ((top + k / SIDE) * width + left + k % SIDE) * 3;
            rgb[at..at + 3].copy_from_slice(&pixel[..3]);
        }
    }
    (height, rgb)
}

fn write_png(path: &Path, height: usize, rgb: &[u8]) {
    let file = std::io::BufWriter::new(fs::File::create(path).unwrap());
    let mut encoder = png::Encoder::new(file, (COLUMNS * SIDE) as u32, height as u32);
    encoder.set_color(png::ColorType::Rgb);
    encoder.write_header().unwrap().write_image_data(rgb).unwrap();
}

/// Compares with the golden files; `DURER_BLESS=1` rewrites them.
fn check(golden: PathBuf, height: usize, rgb: &[u8], words: &str) {
    let (picture, text) = (golden.join("kinds.png"), golden.join("kinds.txt"));
    if std::env::var_os("DURER_BLESS").is_some() {
        write_png(&picture, height, rgb);
        fs::write(&text, words).unwrap();
    }
    assert_eq!(
        fs::read_to_string(&text).unwrap(),
        words,
        "what is said; DURER_BLESS=1 rewrites it"
    );
    let expected = Picture::decode(&fs::read(&picture).unwrap());
    if expected.data != rgb {
        let found = Path::new(env!("CARGO_TARGET_TMPDIR")).join("kinds.png");
        write_png(&found, height, rgb);
        panic!("{} is no longer {}", found.display(), picture.display());
    }
}

#[test]
fn each_kind_keeps_its_picture_and_its_word() {
    let (folder, models) = (folder(), models());
    let options = format!("--size {SIDE} --threads 1");
    let all = models.join(" ");
    let ended = folder.run(&format!("render {all} -o made/ --skip-failures -v {options}"));
    assert_eq!(ended.code, 3, "{}", ended.err);
    // Leaves out the steps done, which contain times.
    let is_word =
        |line: &&str| !line.contains(" triangles, read in ") && !line.contains(" drawn; geometry ");
    let words: String = ended.err.lines().filter(is_word).map(|l| l.to_owned() + "\n").collect();
    for (model, name, options_too) in FURTHER {
        folder.must(&format!("render {model} -o made/{name}.png {options} {options_too}"));
    }
    let stems = models.iter().map(|m| m.split('.').next().unwrap());
    let stems = stems.chain(FURTHER.iter().map(|f| f.1));
    let pictures: Vec<_> = stems
        .map(|stem| fs::read(folder.path(&format!("made/{stem}.png"))).ok())
        .map(|bytes| bytes.map(|bytes| Picture::decode(&bytes)))
        .collect();
    let (height, rgb) = sheet(&pictures);
    check(tests().join("golden"), height, &rgb, &words);
}
