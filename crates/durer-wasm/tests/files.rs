//! Files as a page opens them.

#![cfg(feature = "files")]

use durer_wasm::{Answer, Engine};
use serde_json::{Value, json};

fn asked(request: &Value, file: &[u8]) -> Answer {
    let mut bytes = request.to_string().into_bytes();
    bytes.push(0);
    bytes.extend(file);
    Engine::default().answer(&bytes)
}

#[test]
fn files_become_inputs() {
    let read = |name: &str, file: &[u8]| match asked(&json!({ "do": "read", "name": name }), file) {
        Answer::Json(text) => serde_json::from_str::<Value>(&text).expect("JSON"),
        other => panic!("{name}: {other:?}"),
    };
    let line = read("a.wkt", b"LINESTRING (0 1, 13 8)");
    assert_eq!(line["input"], json!({ "figure": { "lines": [[[0.0, 1.0], [13.0, 8.0]]] } }));
    let faces = read("a.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    assert_eq!(faces["input"]["faces"].as_array().expect("faces").len(), 1);
    let wrong = asked(&json!({ "do": "read", "name": "a.obj" }), b"f 1 2\n\0\0");
    assert!(matches!(wrong, Answer::Error(text) if text.contains("a.obj: ")));
}

#[test]
fn models_are_rendered() {
    let request = |method: &str| json!({ "do": "render", "name": "a.obj", "method": method, "width": 40, "height": 30, "azimuth": 30.0, "elevation": 20.0 });
    let teapot = include_bytes!("../../../samples/teapot.obj");
    for method in ["z-buffer", "scan-line-z"] {
        let answer = asked(&request(method), teapot);
        assert!(
            matches!(answer, Answer::Bytes(png) if png.starts_with(b"\x89PNG") && png.len() > 500)
        );
    }
    let wrong = asked(&request("guess"), teapot);
    assert!(matches!(wrong, Answer::Error(text) if text.contains("guess")));
}
