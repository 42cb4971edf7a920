//! Files as a page opens them.

#![cfg(feature = "files")]

use durer_wasm::{Answer, Engine};
use serde_json::{Value, json};

fn requested(request: &Value, file: &[u8]) -> Answer {
    let mut bytes = request.to_string().into_bytes();
    bytes.push(0);
    bytes.extend(file);
    Engine::default().answer(&bytes)
}

#[test]
fn files_become_inputs() {
    let read =
        |name: &str, file: &[u8]| match requested(&json!({ "do": "read", "name": name }), file) {
            Answer::Json(text) => serde_json::from_str::<Value>(&text).expect("JSON"),
            other => panic!("{name}: {other:?}"),
        };
    let line = read("a.wkt", b"LINESTRING (0 1, 13 8)");
    assert_eq!(line["input"], json!({ "figure": { "lines": [[[0.0, 1.0], [13.0, 8.0]]] } }));
    let faces = read("a.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    assert_eq!(faces["input"]["faces"].as_array().expect("faces").len(), 1);
    let wrong = requested(&json!({ "do": "read", "name": "a.obj" }), b"f 1 2\n\0\0");
    assert!(matches!(wrong, Answer::Error(text) if text.contains("a.obj: ")));
}

#[test]
fn models_are_rendered() {
    let request = |method: &str| json!({ "do": "render", "name": "a.obj", "method": method, "width": 40, "height": 30, "azimuth": 30.0, "elevation": 20.0 });
    let teapot = include_bytes!("../../../samples/teapot.obj");
    for method in ["z-buffer", "scan-line-z"] {
        let answer = requested(&request(method), teapot);
        assert!(
            matches!(answer, Answer::Bytes(png) if png.starts_with(b"\x89PNG") && png.len() > 500)
        );
    }
    let wrong = requested(&request("guess"), teapot);
    assert!(matches!(wrong, Answer::Error(text) if text.contains("guess")));
}

/// Two triangles, by z-buffer and rays.
#[test]
fn counts_of_operations_come_before_the_picture() {
    let request = |counts: bool, method: &str| json!({ "do": "render", "name": "a.obj", "method": method, "width": 20, "height": 20, "azimuth": 0.0, "elevation": 0.0, "counts": counts });
    let model = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\nf 1 2 3\nf 4 5 6\n";
    let counted = |method: &str| {
        let Answer::Bytes(plain) = requested(&request(false, method), model) else { panic!() };
        let Answer::Bytes(both) = requested(&request(true, method), model) else { panic!() };
        let end = both.iter().position(|&byte| byte == 0).expect("a zero byte");
        assert!(both[end + 1..] == plain, "{method}");
        let value: Value = serde_json::from_slice(&both[..end]).expect("JSON");
        value["counts"].as_array().expect("counts").clone()
    };
    let [compared, stored] = &counted("z-buffer")[..] else { panic!("two counts") };
    assert_eq!(compared["title"]["de"], "Tiefenvergleiche");
    assert_eq!(stored["name"], "depths-stored");
    let number = |count: &Value| count["count"].as_u64().expect("a number");
    assert!(number(stored) > 40 && number(stored) <= number(compared), "{stored} {compared}");
    assert_eq!(number(&counted("ray")[0]), 400);
}

#[test]
fn a_formula_gives_curves_from_near_to_far() {
    let request =
        |formula: &str| json!({ "do": "formula", "formula": formula, "columns": 5, "curves": 3 });
    let Answer::Json(text) = requested(&request("x + z"), &[]) else { panic!("no curves") };
    let read: Value = serde_json::from_str(&text).expect("JSON");
    let lines = read["input"]["figure"]["lines"].as_array().expect("lines");
    assert_eq!(lines.len(), 3);
    // From −8 to 8 in 1.5 columns; the nearest curve has z = 4, the next one lies 0.4 higher.
    assert_eq!(
        lines[0],
        json!([[0.0, 0.75], [1.0, 0.938], [2.0, 1.125], [3.0, 1.313], [4.0, 1.5]])
    );
    assert_eq!(lines[1][0], json!([0.0, 0.775]));
    let mut engine = Engine::default();
    let run = json!({ "do": "run", "name": "horizon-curves", "input": read["input"], "cap": 500 });
    let answer = engine.answer(run.to_string().as_bytes());
    assert!(matches!(&answer, Answer::Json(_)), "{answer:?}");
    for (formula, words) in [("x +", "column"), ("1/x", "no value"), ("4e307*x", "too much")] {
        let wrong = requested(&request(formula), &[]);
        assert!(matches!(&wrong, Answer::Error(text) if text.contains(words)), "{wrong:?}");
    }
}
