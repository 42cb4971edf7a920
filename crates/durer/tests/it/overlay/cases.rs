//! Readers for the shared test suites, as simple as the files are.

use std::path::PathBuf;

use durer::clip::polygon::{BooleanOp, Shapes, WindingRule};
use durer::math::DVec2;

fn data() -> PathBuf {
    std::env::var_os("DURER_DATA")
        .map(PathBuf::from)
        .unwrap_or_else(|| PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data"))
}

/// Returns a file of the shared data; `None`, with a note, if there is none.
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
    pub rule: WindingRule,
    pub area: i64,
    pub count: i64,
    pub subject: Shapes,
    /// Polylines of the subject.
    pub open: Vec<Vec<DVec2>>,
    pub clip: Shapes,
}

impl ClipperCase {
    pub fn all(text: &str) -> Vec<Self> {
        text.split("CAPTION:").skip(1).map(Self::parse).collect()
    }

    fn parse(text: &str) -> Self {
        let mut case = Self::default();
        let (mut clip, mut open) = (false, false);
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
                    "EVENODD" => WindingRule::EvenOdd,
                    "NONZERO" => WindingRule::NonZero,
                    "POSITIVE" => WindingRule::Positive,
                    "NEGATIVE" => WindingRule::Negative,
                    other => panic!("fill rule {other}"),
                };
            } else if let Some(area) = value("SOL_AREA:") {
                case.area = area.parse().expect("area");
            } else if let Some(count) = value("SOL_COUNT:") {
                case.count = count.parse().expect("count");
            } else if line.starts_with("SUBJECTS") {
                (clip, open) = (false, line.starts_with("SUBJECTS_OPEN"));
            } else if line.starts_with("CLIPS") {
                (clip, open) = (true, false);
            } else if open && line.starts_with(|c: char| c.is_ascii_digit() || c == '-') {
                case.open.push(points(line));
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

/// Returns all files of a shared folder with this extension, at any depth, sorted.
pub fn shared_files(folder: &str, ending: &str) -> Vec<String> {
    fn collect(dir: &std::path::Path, ending: &str, found: &mut Vec<PathBuf>) {
        for entry in std::fs::read_dir(dir).into_iter().flatten().flatten() {
            let path = entry.path();
            if path.is_dir() {
                collect(&path, ending, found);
            } else if path.to_string_lossy().ends_with(ending) {
                found.push(path);
            }
        }
    }
    let root = data();
    let mut found = Vec::new();
    collect(&root.join(folder), ending, &mut found);
    found.sort();
    if found.is_empty() {
        eprintln!("skipped: {folder} is not there");
    }
    let relative = |p: PathBuf| p.strip_prefix(&root).expect("below data").display().to_string();
    found.into_iter().map(relative).collect()
}

/// Returns the polygons of a GeoJSON geometry, feature or collection, without the closing points.
pub fn geojson(value: &serde_json::Value) -> Shapes {
    let mut shapes = Shapes::new();
    add_geojson(value, &mut shapes);
    shapes
}

fn add_geojson(value: &serde_json::Value, shapes: &mut Shapes) {
    let list = |v: &serde_json::Value| v.as_array().cloned().unwrap_or_default();
    let polygon = |v: &serde_json::Value, shapes: &mut Shapes| {
        for ring in list(v) {
            let number = |p: &serde_json::Value, i: usize| p[i].as_f64().expect("number");
            let points =
                list(&ring).iter().map(|p| DVec2::new(number(p, 0), number(p, 1))).collect();
            shapes.push_ring(opened(points));
        }
        shapes.end_polygon();
    };
    match value["type"].as_str() {
        Some("FeatureCollection") => {
            list(&value["features"]).iter().for_each(|f| add_geojson(f, shapes))
        }
        Some("Feature") => add_geojson(&value["geometry"], shapes),
        Some("Polygon") => polygon(&value["coordinates"], shapes),
        Some("MultiPolygon") => list(&value["coordinates"]).iter().for_each(|p| polygon(p, shapes)),
        _ => {}
    }
}

fn opened(mut points: Vec<DVec2>) -> Vec<DVec2> {
    if points.len() > 1 && points.first() == points.last() {
        points.pop();
    }
    points
}

/// Returns the polygons of a geometry in WKT or hexadecimal WKB; `None` if it holds anything but
/// polygons.
pub fn well_known(text: &str) -> Option<Shapes> {
    let text = text.trim();
    if text.starts_with(|c: char| c.is_ascii_digit()) {
        let byte = |i: usize| u8::from_str_radix(text.get(2 * i..2 * i + 2)?, 16).ok();
        let bytes: Vec<u8> = (0..text.len() / 2).map_while(byte).collect();
        let mut shapes = Shapes::new();
        wkb(&bytes, &mut 0, &mut shapes)?;
        return Some(shapes);
    }
    let upper = text.to_uppercase();
    if !upper.starts_with("POLYGON") && !upper.starts_with("MULTIPOLYGON") {
        return None;
    }
    let mut shapes = Shapes::new();
    for part in upper.split(['(', ')']) {
        let numbers: Vec<f64> = part
            .split(|c: char| c == ',' || c.is_whitespace())
            .filter_map(|s| s.parse().ok())
            .collect();
        if numbers.len() >= 6 {
            let points = numbers.chunks_exact(2).map(|p| DVec2::new(p[0], p[1])).collect();
            shapes.push_ring(opened(points));
            shapes.end_polygon();
        }
    }
    Some(shapes)
}

fn wkb(bytes: &[u8], at: &mut usize, shapes: &mut Shapes) -> Option<()> {
    let little = *bytes.get(*at)? == 1;
    *at += 1;
    let word = |at: &mut usize| {
        let raw: [u8; 4] = bytes.get(*at..*at + 4)?.try_into().ok()?;
        *at += 4;
        Some(if little { u32::from_le_bytes(raw) } else { u32::from_be_bytes(raw) })
    };
    let float = |at: &mut usize| {
        let raw: [u8; 8] = bytes.get(*at..*at + 8)?.try_into().ok()?;
        *at += 8;
        Some(if little { f64::from_le_bytes(raw) } else { f64::from_be_bytes(raw) })
    };
    let kind = word(at)?;
    let count = word(at)?;
    match kind {
        3 => {
            for _ in 0..count {
                let points = word(at)?;
                let ring: Option<Vec<DVec2>> =
                    (0..points).map(|_| Some(DVec2::new(float(at)?, float(at)?))).collect();
                shapes.push_ring(opened(ring?));
            }
            shapes.end_polygon();
            Some(())
        }
        6 => (0..count).try_for_each(|_| wkb(bytes, at, shapes)),
        _ => None,
    }
}
