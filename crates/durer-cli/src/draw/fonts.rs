//! The fonts that are there.

use super::args::FontArgs;
use crate::failure::{Failure, in_words};
use durer_formats::svg::Fonts;
use std::fs;
use std::path::{Path, PathBuf};

/// DejaVu Sans: Latin, Greek, Cyrillic. Always there, so that text never depends on the machine.
const BUILT_IN: &[u8] = include_bytes!("../../fonts/DejaVuSans.ttf");

const SUFFIXES: [&str; 4] = ["ttf", "otf", "ttc", "otc"];

/// Folders are searched so deep.
const MAX_DEPTH: u32 = 16;

/// Returns the font that is always there.
pub fn built_in() -> Fonts {
    let mut fonts = Fonts::new();
    fonts.add(BUILT_IN.to_vec());
    fonts
}

/// Returns the fonts given, then the installed ones if requested, then the built-in one.
pub fn load(args: &FontArgs) -> Result<Fonts, Failure> {
    let mut fonts = Fonts::new();
    for path in &args.font {
        let mut files = Vec::new();
        find(path, 0, &mut files).map_err(|e| Failure::of_file(path, in_words(&e)))?;
        if path.is_dir() && files.is_empty() {
            return Err(Failure::of_file(path, "there is no .ttf, .otf, .ttc or .otc file in it"));
        }
        for file in files {
            let bytes = fs::read(&file).map_err(|e| Failure::of_file(&file, in_words(&e)))?;
            if fonts.add(bytes) == 0 && !path.is_dir() {
                return Err(Failure::of_file(&file, "it is not a TrueType or OpenType font"));
            }
        }
    }
    if args.system_fonts {
        let mut files = Vec::new();
        // Folders that cannot be read are ignored.
        system_folders().iter().for_each(|folder| drop(find(folder, 0, &mut files)));
        files.iter().filter_map(|file| fs::read(file).ok()).for_each(|bytes| {
            fonts.add(bytes);
        });
    }
    fonts.add(BUILT_IN.to_vec());
    Ok(fonts)
}

/// Finds the font files below a folder, sorted; or adds the file itself.
fn find(path: &Path, depth: u32, files: &mut Vec<PathBuf>) -> std::io::Result<()> {
    if !fs::metadata(path)?.is_dir() {
        files.push(path.to_owned());
        return Ok(());
    }
    let entries = fs::read_dir(path)?.map(|e| e.map(|e| e.path()));
    let mut entries = entries.collect::<std::io::Result<Vec<_>>>()?;
    entries.sort();
    for entry in entries {
        let suffix = entry.extension().map(|e| e.to_string_lossy().to_ascii_lowercase());
        if entry.is_dir() && depth < MAX_DEPTH {
            find(&entry, depth + 1, files)?;
        } else if suffix.is_some_and(|s| SUFFIXES.contains(&s.as_str())) {
            files.push(entry);
        }
    }
    Ok(())
}

fn system_folders() -> Vec<PathBuf> {
    let home = std::env::home_dir().unwrap_or_default();
    if cfg!(windows) {
        vec![
            PathBuf::from(r"C:\Windows\Fonts"),
            home.join(r"AppData\Local\Microsoft\Windows\Fonts"),
        ]
    } else if cfg!(target_os = "macos") {
        vec!["/System/Library/Fonts".into(), "/Library/Fonts".into(), home.join("Library/Fonts")]
    } else {
        let own = [home.join(".local/share/fonts"), home.join(".fonts")];
        let shared = ["/usr/share/fonts", "/usr/local/share/fonts"].map(PathBuf::from);
        shared.into_iter().chain(own).collect()
    }
}
