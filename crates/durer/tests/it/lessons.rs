//! Numbers that lessons show: those of the lectures.

use durer::explain::{self, Frame, Input, Language, Options, Value};
use durer::math::DVec2;

fn frames(name: &str, example: &str) -> Vec<Frame> {
    explain::run(name, &Input::Example(example.to_owned()), &Options::default(), 5_000).unwrap()
}

/// Returns a value of every caption that has it.
fn values(frames: &[Frame], name: &str) -> Vec<Value> {
    let all = frames.iter().flat_map(|frame| &frame.caption.values);
    all.filter(|(own, _)| *own == name).map(|(_, value)| value.clone()).collect()
}

fn numbers(frames: &[Frame], name: &str) -> Vec<f64> {
    let number = |value: &Value| if let Value::Number(x) = value { *x } else { f64::NAN };
    values(frames, name).iter().map(number).collect()
}

/// Returns the names of a table's rows and their cells.
fn rows(frame: &Frame) -> Vec<String> {
    let text = |value: &Value| value.text(Language::English);
    let row = |row: &durer::explain::Row| {
        let cells: Vec<String> = row.cells.iter().map(|cell| text(&cell.value)).collect();
        format!("{}: {}", text(&row.name), cells.join(" "))
    };
    frame.table.rows.iter().map(row).collect()
}

#[test]
fn bresenham_shows_the_decision_variable_of_the_lecture() {
    let frames = frames("bresenham", "lecture");
    assert_eq!(numbers(&frames, "e"), [1.0, -3.0, 3.0, -1.0, 5.0]);
    assert_eq!(numbers(&frames, "sum"), [-3.0, 3.0, -1.0, 5.0, 1.0]);
    assert_eq!(frames.last().unwrap().kind, "last");
    let text = frames[1].text(Language::German);
    assert!(text.starts_with("Pixel (1; 1). E = −3: ") && text.ends_with("−3 + 6 = 3."), "{text}");
}

#[test]
fn circles_and_horizons_show_the_numbers_of_the_lecture() {
    let circle = frames("midpoint-circle", "radius-10");
    assert_eq!(numbers(&circle, "d"), [-9.0, -6.0, -1.0, 6.0, -3.0, 8.0, 5.0, 6.0]);
    let horizon = frames("horizon-curves", "lecture");
    let at = [DVec2::new(0.5, 1.0), DVec2::new(1.5, 1.0)].map(Value::Point);
    assert_eq!(values(&horizon, "at"), at);
}

#[test]
fn edges_go_from_one_table_to_the_other() {
    let frames = frames("edge-table", "triangle");
    let kinds: Vec<&str> = frames.iter().take(6).map(|frame| frame.kind).collect();
    assert_eq!(kinds, ["table", "table", "table", "enter", "enter", "active"]);
    assert_eq!(
        rows(&frames[2]),
        ["ET 1: A: 9 2 0.375 0.687", "ET 1: B: 3 4 4 0.5", "ET 3: C: 9 10 −0.833 0.083"]
    );
    assert_eq!(rows(&frames[4])[..2], ["ET 3: C: 9 10 −0.833 0.083", "AET A: 9 2 0.375 0.687"]);
}

#[test]
fn a_stack_of_pixels_is_shown_with_its_top_above() {
    let frames = frames("naive", "room");
    assert_eq!(rows(&frames[0]), [""; 0]);
    assert_eq!(rows(&frames[4]), ["4: 3|1", "3: 1|1", "2: 2|2", "1: 2|0"]);
    assert_eq!(
        frames[5].text(Language::English),
        "Pixel 3|1 is popped, belongs to the region and is filled; 3 wait."
    );
}

#[test]
fn spans_are_decided_by_depths_at_their_ends() {
    let frames = frames("watkins", "near-first");
    let first: Vec<f64> = numbers(&frames, "z0");
    assert!(first.iter().all(|z| *z == 1.0 || *z == 3.0), "{first:?}");
    assert!(
        frames
            .iter()
            .any(|frame| frame.text(Language::English).contains("2 in: A is nearest at both ends"))
    );
}

#[test]
fn every_algorithm_has_a_lesson_or_a_reason() {
    let has_lesson = |name: &str, title: &str| {
        explain::lessons().any(|lesson| (lesson.info.name, lesson.info.title) == (name, title))
    };
    for info in explain::ALGORITHMS {
        let reason = explain::WITHOUT_LESSON.iter().find(|(own, _)| own == info);
        let explained = has_lesson(info.name, info.title);
        assert!(explained || reason.is_some(), "{}: neither lesson nor reason", info.title);
        assert!(!explained || reason.is_none(), "{}: take it out of WITHOUT_LESSON", info.title);
    }
    let known = |info: &durer::info::Info| explain::ALGORITHMS.contains(&info);
    assert!(explain::WITHOUT_LESSON.iter().all(|(info, why)| known(info) && !why.is_empty()));
    // The list only shrinks.
    assert!(explain::WITHOUT_LESSON.len() <= 37);
}
