//! Readers for the shared suites, as plain as the files are.

use std::path::PathBuf;

use durer::clip::polygon::{BooleanOp, FillRule, Shapes};
use durer::math::DVec2;

/// A file of the shared data; `None`, with a note, where there is none.
pub fn shared(path: &str) -> Option<String> {
    let root = std::env::var_os("DURER_DATA")
        .map(PathBuf::from)
        .unwrap_or_else(|| PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data"));
    let text = std::fs::read_to_string(root.join(path)).ok();
    if text.is_none() {
        eprintln!("skipped: {path} is not there");
    }
    text
}

/// One case of Clipper2's text files.
#[derive(Debug, Clone, Default)]
pub struct ClipperCase {
    pub number: usize,
    pub op: BooleanOp,
    pub rule: FillRule,
    pub area: i64,
    pub count: i64,
    pub subject: Shapes,
    pub clip: Shapes,
}

impl ClipperCase {
    pub fn all(text: &str) -> Vec<Self> {
        text.split("CAPTION:").skip(1).map(Self::parse).collect()
    }

    fn parse(text: &str) -> Self {
        let mut case = Self::default();
        let mut clip = false;
        for (i, line) in text.lines().enumerate() {
            let line = line.trim();
            let value = |key: &str| line.strip_prefix(key).map(str::trim);
            if i == 0 {
                let digits: String = line.chars().take_while(char::is_ascii_digit).collect();
                case.number = digits.parse().expect("case number");
            } else if let Some(op) = value("CLIPTYPE:") {
                case.op = op.to_lowercase().parse().expect("operation");
            } else if let Some(rule) = value("FILLRULE:") {
                case.rule = match rule {
                    "EVENODD" => FillRule::EvenOdd,
                    "NONZERO" => FillRule::NonZero,
                    "POSITIVE" => FillRule::Positive,
                    "NEGATIVE" => FillRule::Negative,
                    other => panic!("fill rule {other}"),
                };
            } else if let Some(area) = value("SOL_AREA:") {
                case.area = area.parse().expect("area");
            } else if let Some(count) = value("SOL_COUNT:") {
                case.count = count.parse().expect("count");
            } else if line.starts_with("SUBJECTS") {
                clip = false;
            } else if line.starts_with("CLIPS") {
                clip = true;
            } else if line.starts_with(|c: char| c.is_ascii_digit() || c == '-') {
                let shapes = if clip { &mut case.clip } else { &mut case.subject };
                shapes.push_ring(points(line));
                shapes.end_polygon();
            }
        }
        case
    }
}

fn points(line: &str) -> Vec<DVec2> {
    let numbers: Vec<f64> = line
        .split(|c: char| c == ',' || c.is_whitespace())
        .filter(|s| !s.is_empty())
        .map(|s| s.parse().expect("number"))
        .collect();
    numbers.chunks_exact(2).map(|p| DVec2::new(p[0], p[1])).collect()
}
