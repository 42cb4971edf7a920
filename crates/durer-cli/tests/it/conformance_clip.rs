//! Natural Earth's maps, compared with areas, lengths and counts computed by GEOS.

use crate::conformance_models::data;
use crate::harness::{Ended, Folder};
use serde_json::Value;
use std::path::{Path, PathBuf};

/// Areas and lengths have nine decimals.
fn close(found: &Value, expected: &Value) -> bool {
    let (a, b) = (found.as_f64().unwrap(), expected.as_f64().unwrap());
    (a - b).abs() <= 1e-9 * b.abs() + 1e-9
}

/// Runs the command and returns the report on its result.
fn run(folder: &Folder, file: &Path, arguments: &str) -> Value {
    let mut command = folder.command(&format!("clip {arguments} -q --json"));
    let ended = Ended::of(command.arg(file).output().unwrap());
    assert_eq!(ended.code, 0, "{arguments}: {}", ended.err);
    ended.json()["out"].take()
}

#[test]
fn natural_earth_is_cut_and_united_as_by_geos() {
    let Some(data) = data() else { return };
    let text = std::fs::read(data.join("reference/geos_clip/expected.json")).unwrap();
    let expected: Value = serde_json::from_slice(&text).unwrap();
    let folder = Folder::new();
    for (name, wkt) in expected["windows"].as_object().unwrap() {
        folder.write(&format!("{name}.wkt"), wkt.as_str().unwrap());
    }
    let mut complaints = Vec::new();
    let mut union_of: Option<(PathBuf, Value)> = None;
    let results = expected["results"].as_array().unwrap();
    assert!(results.len() > 20);
    for result in results {
        let file = data.join(result["file"].as_str().unwrap());
        let op = result["op"].as_str().unwrap();
        let mask = result["window"].as_str().unwrap_or_default();
        let united = op.starts_with("union");
        let mut out = Value::Null;
        // Each file's union is requested several times.
        if united && union_of.as_ref().is_none_or(|(of, _)| *of != file) {
            let whole = run(&folder, &file, "--op union -o united.geojsonl");
            union_of = Some((file.clone(), whole));
        }
        if let Some((_, whole)) = union_of.as_ref().filter(|_| united) {
            out = whole.clone();
        }
        let how = match op {
            "union of all features" => None,
            "union difference window" => Some("--op difference"),
            "union symmetric_difference window" => Some("--op xor"),
            "union intersection window" | "per-feature intersection" => Some("--op intersection"),
            other => panic!("unknown operation {other}"),
        };
        if let Some(how) = how {
            let file = if united { folder.path("united.geojsonl") } else { file };
            out = run(&folder, &file, &format!("{how} --by {mask}.wkt -o out.geojsonl"));
        }
        let same = if united {
            close(&out["area"], &result["area"])
                && out["polygons"] == result["polygons"]
                && out["holes"] == result["holes"]
        } else {
            close(&out["area"], &result["total_area"])
                && close(&out["length"], &result["total_length"])
                && out["features"] == result["nonempty"]
        };
        if !same {
            complaints.push(format!("{result}\n  found {out}"));
        }
    }
    assert!(
        complaints.is_empty(),
        "{} of {}:\n{}",
        complaints.len(),
        results.len(),
        complaints.join("\n")
    );
}
