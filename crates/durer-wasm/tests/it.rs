//! Requests as a page makes them, answered by the native build.

use durer_wasm::{Answer, Engine};
use serde_json::{Value, json};

fn requested(engine: &mut Engine, request: &Value) -> Value {
    match engine.answer(request.to_string().as_bytes()) {
        Answer::Json(text) => serde_json::from_str(&text).expect("JSON"),
        other => panic!("{request}: {other:?}"),
    }
}

fn refused(engine: &mut Engine, request: &str) -> String {
    match engine.answer(request.as_bytes()) {
        Answer::Error(text) => {
            let value: Value = serde_json::from_str(&text).expect("JSON");
            value["error"].as_str().expect("words").to_owned()
        }
        other => panic!("{request}: {other:?}"),
    }
}

#[test]
fn every_lesson_is_listed_and_has_the_parts_of_a_page() {
    let list = requested(&mut Engine::default(), &json!({ "do": "lessons" }));
    let families = list["families"].as_array().unwrap();
    let lessons: Vec<&Value> =
        families.iter().flat_map(|family| family["lessons"].as_array().unwrap()).collect();
    assert_eq!(lessons.len(), durer::explain::lessons().count());
    for family in families {
        assert!(family["title"]["en"] != family["title"]["de"], "{}", family["title"]);
    }
    for lesson in lessons {
        let name = &lesson["name"];
        for language in ["en", "de"] {
            assert!(!lesson["title"][language].as_str().unwrap().is_empty(), "{name}: title");
        }
        for part in ["authors", "source", "cost", "limits"] {
            assert!(!lesson[part].as_str().unwrap().is_empty(), "{name}: {part}");
        }
        for part in ["pseudocode", "examples", "templates"] {
            assert!(
                lesson[part].as_array().unwrap().len() > 1 || part == "templates",
                "{name}: {part}"
            );
        }
        for template in lesson["templates"].as_array().unwrap() {
            assert!(!template["text"]["de"].as_str().unwrap().is_empty(), "{name}");
        }
    }
}

#[test]
fn a_run_is_stepped_through() {
    let mut engine = Engine::default();
    let request = json!({ "do": "run", "name": "cohen-sutherland", "input": { "example": "line-eh" }, "cap": 100 });
    let run = requested(&mut engine, &request);
    assert_eq!(run["steps"], 4);
    assert_eq!(run["input"]["figure"]["window"], json!([0.0, 0.0, 10.0, 6.0]));
    let kinds = run["templates"].as_array().unwrap();
    assert_eq!(kinds, json!([0, 1, 1, 2]).as_array().unwrap());
    let request = json!({ "do": "frame", "handle": run["handle"], "step": 1, "language": "de", "longest": 500 });
    let frame = requested(&mut engine, &request);
    assert!(frame["svg"].as_str().unwrap().starts_with("<svg"));
    assert!(frame["frame"]["caption"].as_str().unwrap().contains("wandert nach (0; "));
    assert_eq!(frame["map"]["input"], json!([1.0, 0.0, 0.0, 1.0, 0.0, 0.0]));
    assert_eq!(frame["frame"]["table"]["rows"][0]["cells"][0]["changed"], true);
    let request = json!({ "do": "captions", "handle": run["handle"], "first": 2, "count": 9, "language": "en" });
    assert_eq!(requested(&mut engine, &request)["captions"].as_array().unwrap().len(), 2);
    requested(&mut engine, &json!({ "do": "drop", "handle": run["handle"] }));
    assert!(refused(&mut engine, &request.to_string()).contains("does not exist"));
}

#[test]
fn own_inputs_come_back_as_they_went_in() {
    let mut engine = Engine::default();
    let inputs = [
        (
            "sutherland-hodgman",
            json!({ "figure": { "window": [0.0, 0.0, 4.0, 4.0], "rings": [[[1.0, 1.0], [9.0, 2.0], [3.0, 7.0]]] } }),
        ),
        ("naive", json!({ "grid": { "columns": 3, "cells": [0, 0, 1, 0, 1, 0], "seed": [0, 1] } })),
        (
            "z-buffer-loop",
            json!({ "faces": [[[0.0, 0.0, 1.0], [4.0, 0.0, 1.0], [0.0, 4.0, 2.0]]] }),
        ),
    ];
    for (name, input) in inputs {
        let request = json!({ "do": "run", "name": name, "input": input, "cap": 50 });
        let run = requested(&mut engine, &request);
        assert_eq!(run["input"], input, "{name}");
        assert!(run["steps"].as_u64().unwrap() > 2, "{name}");
    }
}

#[test]
fn choices_are_those_that_change_the_run() {
    let mut engine = Engine::default();
    let mut choices = |name: &str, example: &str| {
        let input = json!({ "example": example });
        let request =
            json!({ "do": "run", "name": name, "input": input, "cap": 9, "choices": true });
        requested(&mut engine, &request)["choices"].clone()
    };
    let overlay = choices("weiler-atherton", "");
    assert_eq!(overlay["operations"].as_array().unwrap().len(), 4, "{overlay}");
    let plain = choices("cohen-sutherland", "");
    assert_eq!(plain, json!({ "operations": [], "rules": [] }));
    let star = choices("edge-table", "star");
    assert_eq!(star["rules"], json!(["even-odd", "non-zero"]));
    // They are those of an input of one's own, too.
    let mut own = |name: &str, figure: Value| {
        let input = json!({ "figure": figure });
        let request =
            json!({ "do": "run", "name": name, "input": input, "cap": 9, "choices": true });
        requested(&mut engine, &request)["choices"].clone()
    };
    let twice = json!([[0.0, 0.0], [9.0, 0.0], [0.0, 9.0], [0.0, 0.0], [9.0, 0.0], [0.0, 9.0]]);
    let rules = own("edge-table", json!({ "rings": [twice] }));
    assert_eq!(rules["rules"], json!(["even-odd", "non-zero"]));
    let line = json!({ "window": [0.0, 0.0, 4.0, 4.0], "lines": [[[1.0, 1.0], [9.0, 3.0]]] });
    assert_eq!(own("cohen-sutherland", line), json!({ "operations": [], "rules": [] }));
}

/// Two stars with hundreds of crossings: their lists and rings are too long to be shown whole.
#[test]
fn long_lists_have_their_ends() {
    let star = |shift: f64| -> Vec<[f64; 2]> {
        let point = |k: u32| {
            let (turn, far) = (f64::from(k) / 180.0 * std::f64::consts::TAU, 8.0);
            let far = if k.is_multiple_of(2) { far } else { far - 1.0 };
            [far * turn.cos() + shift, far * turn.sin() - shift]
        };
        (0..180).map(point).collect()
    };
    let figure = json!({ "rings": [star(0.0)], "clip": [star(0.05)] });
    let mut engine = Engine::default();
    let request = json!({ "do": "run", "name": "weiler-atherton", "input": { "figure": figure }, "cap": 100_000 });
    let run = requested(&mut engine, &request);
    let last = run["steps"].as_u64().unwrap() - 1;
    let request = json!({ "do": "frame", "handle": run["handle"], "step": last, "language": "en" });
    let frame = requested(&mut engine, &request);
    let list = frame["frame"]["table"]["rows"][0]["cells"][0]["text"].as_str().unwrap();
    assert!(list.starts_with("0 ") && list.contains(" more … "), "{list}");
    let caption = frame["frame"]["caption"].as_str().unwrap();
    assert!(caption.contains(" … ") && caption.len() < 400, "{caption}");
}

#[test]
fn wrong_requests_are_refused_in_words() {
    let mut engine = Engine::default();
    let run = |name: &str, input: Value| {
        json!({ "do": "run", "name": name, "input": input, "cap": 10 }).to_string()
    };
    let cases = [
        ("{", "EOF"),
        (r#"{"do":"dance"}"#, "dance"),
        (&run("cohen", json!({ "example": "" })), "cohen-sutherland"),
        (&run("bresenham", json!({ "example": "x" })), "lecture"),
        (&run("bresenham", json!({ "faces": [] })), "faces in space"),
        (&run("bresenham", json!({ "figure": { "circles": [] } })), "circles"),
        (r#"{"do":"frame","handle":77,"step":0,"language":"en"}"#, "77"),
    ];
    for (request, wanted) in cases {
        let words = refused(&mut engine, request);
        assert!(words.contains(wanted), "{request}: {words}");
    }
    assert!(refused(&mut engine, "\0\0").contains("EOF"));
}

#[test]
fn many_steps_are_kept_and_found() {
    let mut engine = Engine::default();
    let ring: Vec<[f64; 2]> = vec![[0.0, 0.0], [20.0, 0.0], [20.0, 20.0], [0.0, 20.0]];
    let face: Vec<[f64; 3]> = ring.iter().map(|[x, y]| [*x, *y, 1.0]).collect();
    let faces = vec![face; 3];
    let request = json!({ "do": "run", "name": "z-buffer-loop", "input": { "faces": faces }, "cap": 100_000 });
    let run = requested(&mut engine, &request);
    let steps = run["steps"].as_u64().unwrap();
    assert!(steps > 1_000, "{steps}");
    for step in [0, steps / 2, steps - 1] {
        let request =
            json!({ "do": "frame", "handle": run["handle"], "step": step, "language": "en" });
        assert!(requested(&mut engine, &request)["svg"].as_str().unwrap().len() > 1_000);
    }
}

/// Seed fills show all waiting pixels of the stack: the table of a large picture is shortened in its middle.
#[test]
fn long_tables_are_cut_in_the_middle() {
    let mut engine = Engine::default();
    let cells = vec![0; 30 * 30];
    let grid = json!({ "columns": 30, "cells": cells, "seed": [0, 0] });
    let run = json!({ "do": "run", "name": "naive", "input": { "grid": grid }, "cap": 100_000 });
    let run = requested(&mut engine, &run);
    let mut rows = |step: usize| {
        let frame =
            json!({ "do": "frame", "handle": run["handle"], "step": step, "language": "de" });
        requested(&mut engine, &frame)["frame"]["table"]["rows"].as_array().expect("rows").clone()
    };
    assert_eq!(rows(3).len(), 3);
    let long = rows(2_000);
    assert_eq!(long.len(), 201);
    let cut = long[100]["name"].as_str().expect("a name");
    let more: usize =
        cut.strip_suffix(" weitere Zeilen").expect("the rest").parse().expect("a number");
    // The top and the bottom of the stack are shown.
    assert_eq!(long[0]["name"], (200 + more).to_string());
    assert_eq!(long[200]["name"], "1");
}

#[test]
fn old_runs_make_room() {
    let mut engine = Engine::default();
    let request =
        json!({ "do": "run", "name": "bresenham", "input": { "example": "" }, "cap": 10 });
    let first = requested(&mut engine, &request)["handle"].clone();
    (0..16).for_each(|_| drop(requested(&mut engine, &request)));
    let frame = json!({ "do": "frame", "handle": first, "step": 0, "language": "en" });
    assert!(refused(&mut engine, &frame.to_string()).contains("only the last 16"));
}

#[test]
fn frames_say_what_their_step_is_about() {
    let mut engine = Engine::default();
    let mut targets = |name: &str, example: &str, step: usize| {
        let input = json!({ "example": example });
        let request = json!({ "do": "run", "name": name, "input": input, "cap": 50 });
        let handle = requested(&mut engine, &request)["handle"].clone();
        let request = json!({ "do": "frame", "handle": handle, "step": step, "language": "en" });
        requested(&mut engine, &request)["targets"].clone()
    };
    // The cut at the left border: the border and the new end.
    let cut = json!([{ "line": [[0.0, 0.0], [0.0, 6.0]] }, { "point": [0.0, 1.96875] }]);
    assert_eq!(targets("cohen-sutherland", "line-eh", 1), cut);
    assert_eq!(targets("cohen-sutherland", "line-eh", 0), json!([]));
    assert_eq!(targets("bresenham", "", 0), json!([{ "pixel": [0, 0] }]));
}

#[test]
fn programs_with_faults_run_in_place_of_the_library() {
    let mut engine = Engine::default();
    let mut captions = |fault: Value| {
        let input = json!({ "example": "line-eh" });
        let request = json!({ "do": "run", "name": "cohen-sutherland", "input": input, "cap": 50, "fault": fault });
        let handle = requested(&mut engine, &request)["handle"].clone();
        let request = json!({ "do": "captions", "handle": handle, "first": 0, "count": 50, "language": "en" });
        requested(&mut engine, &request)["captions"].clone()
    };
    let right = captions(Value::Null);
    assert_eq!(right.as_array().unwrap().len(), 4);
    assert_ne!(captions(json!(0)), right);
    let list = requested(&mut engine, &json!({ "do": "lessons" }));
    let families = list["families"].as_array().unwrap().iter();
    let lessons = families.flat_map(|family| family["lessons"].as_array().unwrap());
    let faulty = lessons.filter(|lesson| !lesson["faults"].as_array().unwrap().is_empty());
    assert!(faulty.count() >= 5);
    let run = |name: &str, fault: usize| {
        json!({ "do": "run", "name": name, "input": { "example": "" }, "cap": 50, "fault": fault })
            .to_string()
    };
    assert!(refused(&mut engine, &run("cohen-sutherland", 99)).contains("fault"));
    assert!(refused(&mut engine, &run("vatti", 0)).contains("with faults"));
}
