//! Natural Earth's maps against areas, lengths and counts that GEOS gives.

use crate::conformance_models::data;
use crate::harness::Folder;
use serde_json::Value;

/// Areas and lengths are given with nine digits after the point.
fn close(found: &Value, expected: &Value) -> bool {
    let (a, b) = (found.as_f64().unwrap(), expected.as_f64().unwrap());
    (a - b).abs() <= 1e-9 * b.abs() + 1e-9
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
    let results = expected["results"].as_array().unwrap();
    assert!(results.len() > 20);
    for result in results {
        let file = data.join(result["file"].as_str().unwrap());
        let union = result["op"].as_str().unwrap().starts_with("union");
        let mask = result["window"].as_str().unwrap_or_default();
        let how = if union { "--op union".to_owned() } else { format!("--by {mask}.wkt") };
        let mut command = folder.command(&format!("clip {how} -o out.geojsonl -q --json"));
        let ended = crate::harness::Ended::of(command.arg(&file).output().unwrap());
        assert_eq!(ended.code, 0, "{result}: {}", ended.err);
        let out = &ended.json()["out"];
        let same = if union {
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
