//! The pages of `docs/algorithms`: their pseudocode is that of the algorithms' facts, their pictures are those of the
//! lessons, and their links have targets.

use durer::explain::{self, ALGORITHMS, Frame, Input, Language};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// Precedes a block of pseudocode; the name of the algorithm and ` -->` follow.
const MARK: &str = "<!-- pseudocode ";
const BLOCK: &str = " -->\n```text\n";

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/algorithms")
}

/// Returns the pages; none if the crate is tested outside the repository.
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

/// The site has each page in its navigation, and refuses to be built otherwise.
#[test]
fn pages_are_in_the_navigation_of_the_site() {
    let navigation = std::fs::read_to_string(folder().join("../../properdocs.yml"));
    let navigation = navigation.unwrap_or_default();
    for path in pages() {
        let name = path.file_name().expect("a page").to_string_lossy();
        assert!(navigation.contains(&format!("algorithms/{name}\n")), "{name}");
    }
}

/// Pictures of pages: the lesson, which names the file, its example, and the largest number of steps shown.
const SHEETS: &[(&str, &str, usize)] = &[
    ("cohen-sutherland", "all-borders", 100),
    ("midpoint", "both-ends", 100),
    ("cyrus-beck", "pentagon", 100),
    ("nicholl-lee-nicholl", "from-corner", 100),
    ("skala", "all-outside", 100),
    ("sobkow-pospisil-yang", "corners", 100),
    ("bentley-ottmann", "one-point", 16),
    ("sutherland-hodgman", "triangle", 100),
    ("maillot", "opposite", 12),
    ("circle-clipping", "corner", 12),
    ("clip-attributes", "one-to-three", 16),
    ("text-by-outline", "word", 16),
    ("weiler-atherton", "lecture", 100),
    ("greiner-hormann", "squares", 12),
    ("vatti", "letter", 12),
    ("overlay", "letter", 8),
    ("de-casteljau", "cubic", 12),
    ("flatten", "cubic", 8),
    ("validity", "divided", 16),
    ("douglas-peucker", "coast", 12),
    ("visvalingam", "coast", 8),
    ("points", "odd-and-even", 12),
    ("smooth-points", "moved", 12),
    ("bresenham", "lecture", 12),
    ("run-slice", "slices", 8),
    ("double-step", "lecture", 8),
    ("wu", "lecture", 8),
    ("line-pattern", "corner", 12),
    ("stroke", "joins", 12),
    ("edge-table", "triangle", 16),
    ("cell-sums", "triangle", 12),
    ("partition", "fan", 8),
    ("naive", "room", 12),
    ("triangulate", "arrow", 12),
    ("fragment-operations", "all-tests", 16),
    ("scan-line-z", "penetration", 12),
    ("ray", "shadow", 12),
    ("octree", "wall", 12),
    ("patch-subdivision", "leaf", 16),
    ("warnock", "corner", 12),
    ("depth-sort", "cyclic", 16),
    ("roberts", "boxes", 16),
    ("appel", "boxes", 28),
    ("galimberti-montanari", "strip", 16),
    ("hidden-line", "strip", 12),
    ("horizon-curves", "lecture", 12),
    ("interior-point", "hook", 12),
    ("shadow-map", "plate", 12),
    ("shadow-volumes", "plates", 20),
    ("evaluator", "saddle", 12),
    ("pick", "stack", 12),
    ("portals", "row", 12),
    ("csg-scan-line", "blocks", 12),
    ("bounding-volumes", "volume", 12),
    ("section", "pyramid", 12),
    ("greedy-labels", "cities", 12),
    ("metallic-roughness", "plastic-and-metal", 12),
    ("fog", "road", 12),
    ("viewport-layout", "five", 8),
    ("texture-sampling", "beyond", 18),
    ("mip-map", "into-depth", 12),
    ("display-lists", "cars", 16),
    ("forward-warp", "hole", 12),
];

/// Returns at most this many frames: the first, the last, and others at equal distances.
fn chosen(frames: Vec<Frame>, most: usize) -> Vec<Frame> {
    let last = frames.len().saturating_sub(1);
    let count = most.min(frames.len());
    (0..count).map(|i| frames[i * last / (count - 1).max(1)].clone()).collect()
}

/// Draws some steps of a lesson's example.
fn sheet((lesson, example, most): (&str, &str, usize)) -> String {
    let input = Input::Example(example.to_owned());
    let frames = explain::run(lesson, &input, &explain::Options::default(), 5_000);
    let frames = frames.unwrap_or_else(|e| panic!("{lesson} {example}: {e}"));
    explain::sheet(&chosen(frames, most), 4, Language::English)
}

#[test]
fn pictures_of_pages_are_those_of_the_lessons() {
    for &(lesson, example, most) in SHEETS {
        let path = folder().join(format!("{lesson}.svg"));
        let drawn = sheet((lesson, example, most));
        let shown = std::fs::read_to_string(&path).unwrap_or_default();
        if shown != drawn && std::env::var_os("DURER_BLESS").is_some() {
            std::fs::write(&path, &drawn).expect("written");
        } else {
            assert!(drawn == shown, "{}: run with DURER_BLESS=1", path.display());
        }
    }
}

#[test]
fn pages_show_every_picture() {
    let text: String =
        pages().iter().map(|path| std::fs::read_to_string(path).expect("a page")).collect();
    for (lesson, ..) in SHEETS {
        assert!(text.is_empty() || text.contains(&format!("]({lesson}.svg)")), "{lesson}");
    }
}
