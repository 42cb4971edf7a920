//! Manifests and reports of `durer batch` in Parquet.

use crate::harness::Folder;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::{Row, RowAccessor};
use serde_json::Value;

/// A manifest written with pyarrow by `tables/make.py`.
const ROWS: &[u8] = include_bytes!("../tables/rows.parquet");

/// Options of all rows; a row's own options replace them.
const COMMON: &str = "--size 9 --aa 16";

#[test]
fn rows_are_those_of_the_table() {
    let folder = Folder::with_models();
    folder.write("rows.parquet", ROWS);
    let ended = folder.run(&format!("batch rows.parquet -o out -- render {COMMON}"));
    ended.fails(3, "3 rows done, 1 failed").fails(3, "gone: gone.obj");
    for (id, options) in [
        ("angle", "--size 8 --azimuth 30.5 --grid --aa 1 --background black"),
        ("eye", "--size 9 --eye 4,3.5,5 --aa 1"),
        ("lights", "--size 12 --light ambient:white:0.2 --light directional:-1,-2,-1:red --aa 4"),
    ] {
        folder.must(&format!("render cube.obj -o {id}.png {options}"));
        let name = format!("{id}.png");
        assert_eq!(folder.read(&format!("out/{name}")), folder.read(&name), "{id}");
    }

    folder.must("batch --merge out -o report.parquet");
    folder.must("batch --merge out -o report.jsonl");
    let reader = SerializedFileReader::new(bytes::Bytes::from(folder.read("report.parquet")));
    let reader = reader.unwrap();
    let found: Vec<Row> = reader.get_row_iter(None).unwrap().map(Result::unwrap).collect();
    let lines = String::from_utf8(folder.read("report.jsonl")).unwrap();
    let wanted: Vec<Value> =
        lines.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert_eq!((found.len(), wanted.len()), (4, 4));
    for (found, wanted) in found.iter().zip(&wanted) {
        let text = |value: &Value| value.as_str().unwrap_or_default().to_owned();
        for (column, name) in ["id", "status", "output"].into_iter().enumerate() {
            assert_eq!(*found.get_string(column).unwrap(), text(&wanted[name]), "{name}");
        }
        assert_eq!(found.get_long(3).ok(), wanted["bytes"].as_i64());
        assert_eq!(*found.get_string(4).unwrap(), text(&wanted["sha256"]));
        assert!(found.get_double(5).unwrap() > 0.0);
        assert_eq!(*found.get_string(9).unwrap(), text(&wanted["error"]["message"]));
    }
    // A report is not a manifest: the error names the missing column.
    folder.run("batch report.parquet -o other").fails(1, "report.parquet: row 1: column `");
}

#[test]
fn broken_tables_are_errors_with_their_name() {
    let folder = Folder::with_models();
    for broken in [&ROWS[..4], &ROWS[..ROWS.len() - 8], &ROWS[..ROWS.len() / 2]] {
        folder.write("rows.parquet", broken);
        let ended = folder.run("batch rows.parquet -o out -- --size 8");
        ended.fails(1, "rows.parquet: it is not valid Parquet: ");
    }
    assert!(!folder.path("out").exists(), "nothing was begun");
    for at in (4..ROWS.len()).step_by(ROWS.len() / 24) {
        let mut broken = ROWS.to_vec();
        broken[at] ^= 0x55;
        folder.write("rows.parquet", broken);
        let ended = folder.run("batch rows.parquet -o out --restart --jobs 1 -- --size 8 --aa 1");
        assert!([0, 1, 3].contains(&ended.code), "byte {at}: {} {}", ended.code, ended.err);
    }
}
