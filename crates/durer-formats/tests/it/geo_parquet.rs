//! GeoParquet: files of other programs, and files written here, with the feature `geoparquet`; without it, an error.

use durer_formats::geo::{GeoFormat, read_all};

/// A file written by geopandas, with a column of boxes.
const SEED: &[u8] = include_bytes!("../../../../fuzz/seeds/geoparquet/seed.parquet");

#[cfg(not(feature = "geoparquet"))]
#[test]
fn files_need_the_feature() {
    use durer_formats::geo::Writer;
    assert_eq!(GeoFormat::of_content(SEED), Some(GeoFormat::GeoParquet));
    let messages = read_all(SEED, "").expect_err("refused").to_string();
    assert!(
        messages.contains("GeoParquet by this build") && messages.contains("--features geoparquet"),
        "{messages}"
    );
    let writer = Writer::new(GeoFormat::GeoParquet, Vec::new());
    let messages = writer.finish(&[]).expect_err("refused").to_string();
    assert!(messages.contains("--features geoparquet"), "{messages}");
}

#[cfg(feature = "geoparquet")]
mod read_and_written {
    use super::{GeoFormat, SEED, read_all};
    use durer_formats::geo::{Feature, Member, Reader, System, Writer};

    fn wkt(features: &[Feature]) -> String {
        let mut writer = Writer::new(GeoFormat::Wkt, Vec::new());
        features.iter().for_each(|feature| writer.write(feature).expect("memory"));
        String::from_utf8(writer.finish(&[]).expect("memory")).expect("text")
    }

    #[test]
    fn files_of_geopandas_are_read_with_all_types() {
        let (features, warnings) = read_all(SEED, "").expect("features");
        assert_eq!(
            features[0].properties.as_deref(),
            Some(concat!(
                r#"{"name":"ä","n":1,"x":1.5,"b":true,"day":"2024-02-29","t":"2024-02-29T12:34:56.250000","#,
                r#""u":"2024-02-29T12:34:56Z","dec":-1.25,"list":[1,2],"dict":{"a":1},"small":1,"f":0.1}"#
            ))
        );
        let value = |i: usize, key: &str| {
            features[i].fields().into_iter().find(|f| f.key() == key).map(|f| f.value)
        };
        assert_eq!(value(1, "n").as_deref(), Some("null"));
        assert_eq!(value(2, "dec").as_deref(), Some("0.05"));
        assert_eq!(value(2, "day").as_deref(), Some("\"1969-12-31\""));
        assert_eq!(
            wkt(&features),
            "SRID=4326;POINT Z (1 2 3)\nSRID=4326;POLYGON ((0 0, 4 0, 4 4, 0 0))\n"
        );
        assert_eq!(warnings.len(), 1, "{warnings:?}");
        assert!(warnings[0].to_string().contains("2 binary values are left out"), "{warnings:?}");
    }

    const ALL: &str = r#"{"type":"FeatureCollection","features":[
{"type":"Feature","id":"p1","properties":{"n":1,"x":1.5,"t":"ä, \"b\"\nc","b":true,"d":"2024-02-29","bad":"2024-02-30","j":{"k":[1, 2]},"e":null},"geometry":{"type":"Point","coordinates":[1.25,-2,7.5]}},
{"type":"Feature","properties":{"n":-9007199254740993,"x":2,"geometry":"x"},"geometry":{"type":"LineString","coordinates":[[0,0],[1,1],[2,0]]}},
{"type":"Feature","properties":{"t":"c"},"geometry":{"type":"GeometryCollection","geometries":[{"type":"Point","coordinates":[1,2]},{"type":"LineString","coordinates":[[0,0],[1,1]]}]}},
{"type":"Feature","properties":null,"geometry":null}]}"#;

    #[test]
    fn what_is_written_is_read_again() {
        let (features, _) = read_all(ALL.as_bytes(), "a.geojson").expect("features");
        for code in [4326, 2154, 27700, 3413, 54030, 5070] {
            let mut writer = Writer::new(GeoFormat::GeoParquet, Vec::new());
            writer.set_system(System::of_code(code));
            features.iter().for_each(|feature| writer.write(feature).expect("memory"));
            let bytes = writer.finish(&[]).expect("memory");
            let mut reader = Reader::new(GeoFormat::GeoParquet, &bytes[..]).expect("a reader");
            assert_eq!(reader.system().code, Some(code));
            let mut again = Vec::new();
            while let Some(mut feature) = reader.next_feature().expect("a feature") {
                feature.srid = None;
                again.push(feature);
            }
            assert_eq!((wkt(&again), again.len()), (wkt(&features), 4));
            assert_eq!(
                again[0].properties.as_deref(),
                Some(concat!(
                    r#"{"id":"p1","n":1,"x":1.5,"t":"ä, \"b\"\nc","b":true,"d":"2024-02-29","bad":"2024-02-30","#,
                    r#""j":{"k":[1, 2]},"e":null,"geometry":null}"#
                ))
            );
            assert_eq!(again[1].fields()[1].value, "-9007199254740993");
            assert_eq!(again[1].fields().last().map(Member::key).as_deref(), Some("geometry"));
        }
    }

    #[test]
    fn broken_files_say_what_is_wrong() {
        let messages = |bytes: &[u8]| read_all(bytes, "a.parquet").expect_err("broken").to_string();
        assert!(messages(&SEED[..SEED.len() - 1]).contains("it is cut short"));
        assert!(messages(b"PAR1").contains("it has no footer"));
        assert!(messages(b"PAR1\xff\xff\xff\x00PAR1").contains("longer than it can be"));
        let with = |from: &[u8], to: &[u8]| {
            let mut bytes = SEED.to_vec();
            let at = bytes.windows(from.len()).rposition(|w| w == from).expect("it is there");
            bytes[at..at + to.len()].copy_from_slice(to);
            bytes
        };
        assert!(
            messages(&with(b"\"encoding\": \"WKB\"", b"\"encoding\": \"XYZ\""))
                .contains("encoding `XYZ`")
        );
        assert!(
            messages(&with(b"\"primary_column\": \"g", b"\"primary_column\": \"h"))
                .contains("there is no column heometry")
        );
        // Endlessly nested groups: a list of columns, each with one child.
        let mut footer = vec![0x15, 2, 0x19, 0xfc, 0xd0, 0x0f];
        (0..2000).for_each(|_| footer.extend([0x48, 1, b'a', 0x15, 2, 0]));
        footer.push(0);
        let length = (footer.len() as u32).to_le_bytes();
        let deep = [&b"PAR1"[..], &footer, &length, b"PAR1"].concat();
        assert!(messages(&deep).contains("nests columns too deep"), "{}", messages(&deep));
    }
}
