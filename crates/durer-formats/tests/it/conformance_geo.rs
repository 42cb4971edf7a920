//! Geodata of the shared test data.

use crate::shared::data;
use durer_formats::geo::{GeoFormat, Reader, Writer, read_all};

#[test]
fn malformed_geojson_is_refused_or_repaired_and_reported() {
    let Some(data) = data() else { return };
    for (name, expected) in [
        ("geo_nan", "error: line 1, column 42: a number is expected"),
        ("geo_nest_50k", "error: line 1, column 161: this is nested too deep"),
        ("geo_wrong_nesting", "error: line 1, column 41: a position"),
        (
            "geo_two_point_ring",
            "warning: line 1, column 37, feature 1: a ring needs four positions",
        ),
        (
            "geo_unclosed_ring",
            "warning: line 1, column 37, feature 1: the ring is not closed; closed",
        ),
        // Rings are closed and long enough; their validity is left to clipping.
        ("geo_bowtie", "read"),
        ("geo_hole_outside", "read"),
        ("geo_spike_dup", "read"),
    ] {
        let bytes =
            std::fs::read(data.join(format!("malformed/synthetic/{name}.geojson"))).expect("file");
        let messages = match read_all(&bytes, name) {
            Err(e) => format!("error: {e}"),
            Ok((_, warnings)) => {
                warnings.first().map_or("read".to_owned(), |w| format!("warning: {w}"))
            }
        };
        assert!(messages.starts_with(expected), "{name}: {messages}");
    }
}

#[test]
fn of_bad_wkt_only_line_2_is_read() {
    let Some(data) = data() else { return };
    let text = std::fs::read_to_string(data.join("malformed/synthetic/wkt_bad.wkt")).expect("file");
    let legal: Vec<usize> = text
        .lines()
        .enumerate()
        .filter(|(_, line)| read_all(line.as_bytes(), "a.wkt").is_ok_and(|(_, w)| w.is_empty()))
        .map(|(i, _)| i + 1)
        .collect();
    assert_eq!(legal, [2]);
}

#[test]
fn natural_earth_goes_through_every_format() {
    let Some(data) = data() else { return };
    let bytes = std::fs::read(data.join("geo2d/natural_earth/ne_110m_admin_0_countries.json"))
        .expect("file");
    let (features, warnings) = read_all(&bytes, "").expect("read");
    assert_eq!((features.len(), warnings.len()), (177, 0));
    let count: usize = features.iter().filter_map(|f| f.geometry.as_ref()).map(|g| g.len()).sum();
    for format in GeoFormat::ALL.into_iter().filter(|f| f.is_written()) {
        let mut writer = Writer::new(format, Vec::new());
        features.iter().for_each(|f| writer.write(f).expect("memory"));
        let out = writer.finish(&[]).expect("memory");
        let mut reader = Reader::new(format, &out[..]).expect("a reader");
        let mut again = 0;
        while let Some(feature) = reader.next_feature().expect("a feature") {
            again += feature.geometry.map_or(0, |g| g.len());
        }
        assert_eq!(again, count, "{format}");
    }
}
