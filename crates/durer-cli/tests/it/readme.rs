//! The documents are correct: their commands run, and their links have targets.

use crate::harness::{Ended, Folder, Picture};
use std::fs;
use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn document(name: &str) -> String {
    fs::read_to_string(root().join(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
}

/// Returns the lines of all code blocks marked `sh`.
fn shell_lines(document: &str) -> Vec<&str> {
    let mut inside = false;
    let mut lines = Vec::new();
    for line in document.lines() {
        if line.starts_with("```") {
            inside = line == "```sh";
        } else if inside {
            lines.push(line);
        }
    }
    lines
}

/// Returns the arguments of a line that calls `durer`.
fn arguments(line: &str) -> Option<Vec<String>> {
    let rest = line.strip_prefix("durer ").or(line.strip_prefix("cargo run --release -- "))?;
    assert!(!rest.contains(['|', '*', '$', '\\', '"', '&']), "needs a shell: {line}");
    // Words separated by blanks, as in a shell; single quotes are not part of a word.
    Some(rest.split_whitespace().map(|w| w.trim_matches('\'').to_owned()).collect())
}

/// Returns the same command for a small picture.
fn made_small(mut arguments: Vec<String>) -> Vec<String> {
    // Drawings in vectors are small anyway.
    let vectors = [".svg", ".pdf", ".dxf", ".hpgl", ".gcode", ".geojson"];
    let output = arguments.iter().skip_while(|a| *a != "-o").nth(1);
    if output.is_some_and(|a| vectors.iter().any(|v| a.ends_with(v))) {
        return arguments;
    }
    if !["render", "draw"].contains(&arguments[0].as_str()) {
        return arguments;
    }
    if let Some(at) = arguments.iter().position(|a| a == "--size") {
        arguments.drain(at..at + 2);
    }
    if let Some(at) = arguments.iter().position(|a| a == "--tile") {
        arguments[at + 1] = "0,0,96,64".to_owned();
    }
    arguments.extend(["--size", "96x64"].map(str::to_owned));
    arguments
}

/// Input of `durer clip` in the examples, and its mask.
const COUNTRIES: &str = r#"{"type":"Feature","properties":{"name":"A"},"geometry":{"type":"Polygon",
"coordinates":[[[0,40],[50,40],[50,50],[0,50],[0,40]]]}}"#;
const MASK: &str = r#"{"type":"Polygon","coordinates":[[[10,30],[20,30],[15,60],[10,30]]]}"#;

/// Returns a folder with a copy of the samples, and map data.
fn folder_with_samples() -> Folder {
    let folder = Folder::new();
    fs::create_dir(folder.path("samples")).unwrap();
    for entry in fs::read_dir(root().join("samples")).unwrap() {
        let entry = entry.unwrap();
        let name = entry.file_name().into_string().unwrap();
        fs::copy(entry.path(), folder.path("samples").join(name)).unwrap();
    }
    folder.write("countries.geojson", COUNTRIES);
    folder.write("mask.geojson", MASK);
    folder
}

/// Returns the values of options that name one picture.
fn pictures(arguments: &[String]) -> impl Iterator<Item = &str> {
    let names = |a: &str| ["-o", "--item", "--depth", "--normal"].contains(&a);
    let pairs = arguments.windows(2).filter(move |p| names(&p[0]));
    pairs.map(|p| p[1].as_str()).filter(|f| f.ends_with(".png") && !f.contains('%'))
}

/// Runs all commands of a document; returns the folder of their outputs.
fn folder_of_commands(name: &str, least: usize) -> Folder {
    let text = document(name);
    let commands: Vec<_> = shell_lines(&text).into_iter().filter_map(arguments).collect();
    assert!(commands.len() >= least, "{name}: only {} commands found", commands.len());
    let folder = folder_with_samples();
    for arguments in commands.into_iter().map(made_small) {
        let ended = Ended::of(folder.command("").args(&arguments).output().unwrap());
        assert_eq!(ended.code, 0, "{name}: durer {}: {}", arguments.join(" "), ended.err);
        for name in pictures(&arguments) {
            let picture = Picture::decode(&folder.read(name));
            assert_eq!(picture.size(), (96, 64), "{name}");
            assert!(picture.shows_something(), "durer {}: {name} is empty", arguments.join(" "));
        }
    }
    folder
}

#[test]
fn every_command_of_the_readme_runs() {
    let folder = folder_of_commands("README.md", 15);
    for name in ["turn/teapot_11.png", "thumbnails/crate.png", "europe.geojson", "within.svg"] {
        assert!(!folder.read(name).is_empty(), "{name}");
    }
}

#[test]
fn every_command_of_the_first_pages_runs() {
    folder_of_commands("docs/README.md", 6);
    folder_of_commands("docs/render.md", 6);
}

#[test]
fn the_gallery_shows_what_its_commands_make() {
    let readme = document("README.md");
    let block = readme.split("<!-- gallery -->").nth(1).and_then(|s| s.split("\n```\n").next());
    let commands: Vec<_> = block.unwrap().lines().filter_map(arguments).collect();
    let made: Vec<&str> = commands.iter().flat_map(|a| pictures(a)).collect();
    let shown: Vec<&str> =
        links(&readme).into_iter().filter_map(|l| l.strip_prefix("docs/gallery/")).collect();
    for name in shown.iter().filter(|l| l.ends_with(".png")) {
        assert!(made.contains(name), "no command makes {name}");
    }
    for entry in fs::read_dir(root().join("docs/gallery")).unwrap() {
        let entry = entry.unwrap();
        let name = entry.file_name().into_string().unwrap();
        assert!(shown.contains(&name.as_str()), "docs/gallery/{name} is shown nowhere");
        assert!(entry.metadata().unwrap().len() <= 150_000, "docs/gallery/{name} is too large");
    }
}

#[test]
fn ci_runs_the_command_of_the_readme() {
    let test = "cargo test --workspace";
    assert!(shell_lines(&document("README.md")).contains(&test));
    let ci = document(".ci/run");
    assert_eq!(ci.lines().rfind(|l| !l.is_empty()), Some(test));
}

/// Returns the targets of Markdown links, without anchors.
fn links(document: &str) -> Vec<&str> {
    let targets = document.split("](").skip(1).filter_map(|rest| rest.split(')').next());
    targets.map(|t| t.split('#').next().unwrap_or_default()).collect()
}

#[test]
fn links_lead_to_files() {
    let mut documents: Vec<String> = [
        "README.md",
        "ARCHITECTURE.md",
        "DESIGN.md",
        "CONTRIBUTING.md",
        "CHANGELOG.md",
        "samples/README.md",
        "peers/render/README.md",
        "crates/durer-py/README.md",
    ]
    .map(str::to_owned)
    .into();
    for folder in ["docs", "docs/algorithms", "docs/notes"] {
        let entries = fs::read_dir(root().join(folder)).unwrap();
        let names = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap());
        documents.extend(names.filter(|n| n.ends_with(".md")).map(|n| format!("{folder}/{n}")));
    }
    assert!(documents.len() > 50, "only {} documents found", documents.len());
    for name in &documents {
        let text = document(name);
        let folder = root().join(Path::new(name).parent().unwrap());
        for link in links(&text).into_iter().filter(|l| !l.is_empty() && !l.contains("://")) {
            assert!(folder.join(link).exists(), "{name}: {link}");
        }
    }
}

/// Returns the paths in this repository that a document names in backquotes.
fn named_paths(document: &str) -> impl Iterator<Item = &str> {
    let quoted = document.split('`').skip(1).step_by(2);
    let roots = ["crates/", "peers/", "samples/", "docs/", ".ci/", ".cargo/"];
    let plain = |p: &&str| !p.contains(['*', '<', '…', '{', ' ', '\n']);
    quoted.filter(move |p| roots.iter().any(|r| p.starts_with(r))).filter(plain)
}

#[test]
fn paths_in_documents_exist() {
    for name in
        ["README.md", "ARCHITECTURE.md", "CONTRIBUTING.md", "DESIGN.md", "docs/performance.md"]
    {
        // Fences would swap text inside and outside backquotes.
        let text = document(name).replace("```", "");
        for path in named_paths(&text) {
            assert!(root().join(path).exists(), "{name}: {path}");
        }
    }
}
