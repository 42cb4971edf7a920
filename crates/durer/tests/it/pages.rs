//! The pages of `docs/algorithms`: their pseudocode is that of the algorithms' facts, and their links lead somewhere.

use durer::explain::ALGORITHMS;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// Precedes a block of pseudocode; the name of the algorithm and ` -->` follow.
const MARK: &str = "<!-- pseudocode ";
const BLOCK: &str = " -->\n```text\n";

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/algorithms")
}

/// Returns the pages; none if the crate is tested outside of the repository.
fn pages() -> Vec<PathBuf> {
    let Ok(files) = std::fs::read_dir(folder()) else {
        println!("skipped: {} is missing", folder().display());
        return Vec::new();
    };
    let paths = files.map(|file| file.expect("an entry").path());
    paths.filter(|path| path.extension().is_some_and(|suffix| suffix == "md")).collect()
}

fn numbered(lines: &[&str]) -> String {
    let mut out = String::new();
    for (i, line) in lines.iter().enumerate() {
        writeln!(out, "{:2}  {line}", i + 1).expect("a string");
    }
    out
}

/// Returns the text of a page with the pseudocode of the facts.
fn with_pseudocode(text: &str) -> String {
    let mut parts = text.split(MARK);
    let mut out = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let (name, rest) = part.split_once(BLOCK).expect("a block of text follows the mark");
        let (_, rest) = rest.split_once("```\n").expect("the block ends");
        let info = ALGORITHMS.iter().find(|info| info.name == name);
        let lines = info.unwrap_or_else(|| panic!("`{name}` is not an algorithm")).pseudocode;
        assert!(!lines.is_empty(), "`{name}` has no pseudocode");
        write!(out, "{MARK}{name}{BLOCK}{}```\n{rest}", numbered(lines)).expect("a string");
    }
    out
}

#[test]
fn pseudocode_of_pages_is_that_of_the_facts() {
    for path in pages() {
        let text = std::fs::read_to_string(&path).expect("a page");
        let right = with_pseudocode(&text);
        if text != right && std::env::var_os("DURER_BLESS").is_some() {
            std::fs::write(&path, &right).expect("written");
        }
        assert!(text == right, "{}: run with DURER_BLESS=1", path.display());
    }
}

#[test]
fn links_of_pages_lead_to_files() {
    for path in pages() {
        let text = std::fs::read_to_string(&path).expect("a page");
        for link in text.split("](").skip(1).filter_map(|rest| rest.split(')').next()) {
            let file = link.split('#').next().unwrap_or_default();
            let found = file.is_empty() || link.contains("://") || folder().join(file).exists();
            assert!(found, "{}: {link}", path.display());
        }
    }
}
