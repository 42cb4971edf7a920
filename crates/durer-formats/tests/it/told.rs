//! What readers say of files that would have them say something else.

use durer_formats::geo::{GeoFormat, Reader};
use durer_formats::{NoResources, ReadOptions, read_model};

/// Colours a terminal, and turns the direction of writing.
const FORGED: &str = "\u{1b}[31mX\u{202e}\u{7}\u{85}";

/// Whether a message is on one line, acts on nothing and is not too long.
fn is_plain(message: &str) -> bool {
    !message.chars().any(|c| c.is_control() || ('\u{2028}'..='\u{202e}').contains(&c))
        && message.chars().count() <= 1000
}

/// Everything that is said when a model is read.
fn said_of_model(name: &str, bytes: &[u8]) -> Vec<String> {
    match read_model(bytes, name, &NoResources, &ReadOptions::default()) {
        Ok(model) => model.warnings.iter().map(ToString::to_string).collect(),
        Err(error) => vec![error.to_string()],
    }
}

#[test]
fn readers_of_models_quote_plainly() {
    let json = serde_json::to_string(FORGED).unwrap();
    let files = [
        (
            "a.obj",
            format!(
                "{FORGED} 1\nmtllib {FORGED}\nusemtl {FORGED}\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"
            ),
        ),
        ("b.obj", format!("v 0 0 {FORGED}\n")),
        ("a.stl", format!("solid a\nfacet {FORGED}\n")),
        (
            "a.ply",
            format!(
                "ply\nformat ascii 1.0\nelement vertex 1\nproperty {FORGED} x\nend_header\n1\n"
            ),
        ),
        ("a.off", format!("OFF\n1 1 {FORGED}\n")),
        ("a.gltf", format!(r#"{{"asset":{{"version":"2.0"}},"extensionsRequired":[{json}]}}"#)),
        ("b.gltf", format!(r#"{{"asset":{{"version":{json}}}}}"#)),
        ("c.gltf", format!(r#"{{"asset":{{"version":"2.0"}},"scene":{json}}}"#)),
        ("a.dae", format!("<COLLADA version='1.4.1'><a></{FORGED}></COLLADA>")),
        ("a.xyz", format!("1 2 3\n1 {FORGED} 3\n")),
        ("a.bin", FORGED.to_owned()),
    ];
    for (name, file) in files {
        let said = said_of_model(name, file.as_bytes());
        assert!(!said.is_empty(), "{name} is fine?");
        said.iter().for_each(|message| assert!(is_plain(message), "{name}: {message:?}"));
        // The same with a name of many letters.
        let long = file
            .replace(FORGED, &"é".repeat(50_000))
            .replace(&json, &format!("\"{}\"", "é".repeat(50_000)));
        for message in said_of_model(name, long.as_bytes()) {
            assert!(is_plain(&message), "{name}: {} letters", message.chars().count());
        }
    }
}

/// Everything that is said when map data are read.
fn said_of_map(format: GeoFormat, bytes: &[u8]) -> Vec<String> {
    let mut reader = match Reader::new(format, bytes) {
        Ok(reader) => reader,
        Err(error) => return vec![error.to_string()],
    };
    let ended = loop {
        match reader.next_feature() {
            Ok(Some(_)) => {}
            Ok(None) => break None,
            Err(error) => break Some(error.to_string()),
        }
    };
    ended.into_iter().chain(reader.warnings().iter().map(ToString::to_string)).collect()
}

#[test]
fn readers_of_map_data_quote_plainly() {
    let json = serde_json::to_string(FORGED).unwrap();
    let files = [
        (GeoFormat::GeoJson, format!(r#"{{"type":{json}}}"#)),
        (GeoFormat::GeoJson, format!(r#"{{"type":"Point","coordinates":[1,{FORGED}]}}"#)),
        (GeoFormat::Wkt, format!("POINT (1 {FORGED})")),
        (GeoFormat::Wkt, format!("{FORGED} (1 2)")),
        (GeoFormat::Kml, format!("<kml><Placemark></{FORGED}></kml>")),
        (GeoFormat::Gpx, format!("<gpx><wpt lat='{FORGED}' lon='1'/></gpx>")),
        (GeoFormat::Svg, format!("<svg><path d='M {FORGED}'/></svg>")),
    ];
    for (format, file) in files {
        let said = said_of_map(format, file.as_bytes());
        assert!(!said.is_empty(), "{format}: {file:?} is fine?");
        said.iter().for_each(|message| assert!(is_plain(message), "{format}: {message:?}"));
    }
}
