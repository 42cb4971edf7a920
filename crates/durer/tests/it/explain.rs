//! Lessons: every algorithm with a lesson, on every example, in every language.

use durer::Error;
use durer::clip::polygon::BooleanOp;
use durer::explain::{self, Figure, Frame, Input, Language, Lesson, Options, Template};
use durer::math::{DVec2, DVec3, Rect};
use std::collections::BTreeSet;

fn frames(lesson: &Lesson, example: &str) -> Vec<Frame> {
    let input = Input::Example(example.to_owned());
    lesson
        .run(&input, &Options::default(), 5_000)
        .unwrap_or_else(|e| panic!("{} {example}: {e}", lesson.name))
}

#[test]
fn every_lesson_has_its_parts() {
    let mut names = BTreeSet::new();
    for lesson in explain::lessons() {
        let name = lesson.name;
        assert!(names.insert(name), "{name} twice");
        assert!(explain::ALGORITHMS.contains(&lesson.info), "{name}");
        assert!((8..=20).contains(&lesson.info.pseudocode.len()), "{name}: pseudocode");
        assert!(lesson.examples.len() >= 6, "{name}: {} examples", lesson.examples.len());
        let distinct: BTreeSet<_> = lesson.examples.iter().map(|example| example.name).collect();
        assert_eq!(distinct.len(), lesson.examples.len(), "{name}: names of examples");
        for example in lesson.examples {
            assert!(!example.title.en.is_empty() && !example.title.de.is_empty(), "{name}");
        }
        assert!(!lesson.takes.en.is_empty() && !lesson.takes.de.is_empty(), "{name}");
    }
    assert!(names.len() > 3);
}

#[test]
fn both_languages_name_the_same_values() {
    let names = |text: &str| -> BTreeSet<String> {
        // A name may be followed by words that depend on its number.
        text.split('{')
            .skip(1)
            .map(|part| part.split(['}', '|']).next().unwrap().to_owned())
            .collect()
    };
    for lesson in explain::lessons() {
        for Template { kind, text } in lesson.templates {
            assert!(
                !text.en.is_empty() && !text.de.is_empty() && text.en != text.de,
                "{} {kind}",
                lesson.name
            );
            assert_eq!(names(text.en), names(text.de), "{} {kind}", lesson.name);
        }
    }
}

#[test]
fn examples_reach_every_kind_of_step_and_fill_every_caption() {
    for lesson in explain::lessons() {
        let mut templates = BTreeSet::new();
        let mut kinds = BTreeSet::new();
        for example in lesson.examples {
            let frames = frames(lesson, example.name);
            assert!(!frames.is_empty(), "{} {}", lesson.name, example.name);
            for frame in &frames {
                let place = format!("{} {} {}", lesson.name, example.name, frame.kind);
                assert!(
                    (1..=lesson.info.pseudocode.len()).contains(&frame.line),
                    "{place}: line {}",
                    frame.line
                );
                assert_ne!(frame.kind, "more", "{place}: too many steps");
                assert!(
                    lesson.templates.contains(&frame.caption.template),
                    "{place} is not listed"
                );
                for &language in Language::ALL {
                    let text = frame.text(language);
                    assert!(!text.contains(['{', '}']) && !text.contains("NaN"), "{place}: {text}");
                }
                kinds.insert(frame.kind);
                templates.insert(frame.caption.template.text.en);
            }
        }
        for kind in lesson.kinds() {
            let excused = lesson.unreached.iter().find(|(unreached, _)| *unreached == kind);
            assert_eq!(kinds.contains(kind), excused.is_none(), "{}: {kind}", lesson.name);
            assert!(excused.is_none_or(|(_, reason)| !reason.is_empty()));
        }
    }
}

#[test]
fn frames_are_cut_off_with_a_word() {
    let lesson = explain::lesson("cohen-sutherland").unwrap();
    let frames =
        explain::run(lesson.name, &Input::Example(String::new()), &Options::default(), 2).unwrap();
    assert_eq!(frames.iter().map(|frame| frame.kind).collect::<Vec<_>>(), ["codes", "cut", "more"]);
    assert!(frames[2].text(Language::English).starts_with("2 steps are shown; "));
}

#[test]
fn changed_cells_are_marked() {
    let lesson = explain::lesson("cohen-sutherland").unwrap();
    let frames = frames(lesson, "line-eh");
    let changed: Vec<Vec<bool>> = frames[1]
        .table
        .rows
        .iter()
        .map(|row| row.cells.iter().map(|cell| cell.changed).collect())
        .collect();
    // The start moves; its code and the OR are new.
    assert_eq!(changed, [[true, true], [false, false], [false, true], [false, false]]);
}

#[test]
fn wrong_names_and_inputs_are_reported_what_is_right() {
    let none = Options::default();
    let example = |name: &str| Input::Example(name.to_owned());
    let reported =
        |name: &str, input: &Input| explain::run(name, input, &none, 10).unwrap_err().to_string();
    assert!(reported("cohen-suterland", &example("")).contains("cohen-sutherland"));
    assert!(reported("cohen-sutherland", &example("line-xy")).contains("line-eh"));
    let wrong = reported("cohen-sutherland", &Input::Faces(Vec::new()));
    assert!(wrong.contains("faces in space") && wrong.contains("a window and a line"), "{wrong}");
    let many = Figure { points: vec![DVec2::ZERO; 3000], ..Default::default() };
    let error = explain::run("cohen-sutherland", &Input::Figure(many), &none, 10);
    assert!(matches!(error, Err(Error::Limit { .. })), "{error:?}");
    for x in [f64::NAN, 1e300] {
        let lines = vec![vec![DVec2::new(x, 0.0); 2]];
        let figure = Figure { lines, ..Default::default() };
        assert!(reported("cohen-sutherland", &Input::Figure(figure)).contains("huge"));
    }
}

/// Checks that drawings are XML with finite numbers, in every language.
#[test]
fn drawings_are_well_formed() {
    for lesson in explain::lessons() {
        for &language in Language::ALL {
            let frames = frames(lesson, "");
            let sheet = explain::sheet(&frames, 4, language);
            let one = explain::svg(&frames[frames.len() / 2], language);
            for svg in [sheet, one] {
                assert!(!svg.contains("NaN") && !svg.contains("inf"), "{}", lesson.name);
                assert_eq!(svg.matches("<g ").count(), svg.matches("</g>").count());
                assert_eq!(svg.matches("<text ").count(), svg.matches("</text>").count());
                assert_eq!(svg.matches("<svg ").count(), svg.matches("</svg>").count());
            }
        }
    }
}

/// Checks inputs as files may contain them: nothing panics, and all numbers drawn are finite.
#[test]
fn odd_inputs_give_frames_or_errors() {
    let p = DVec2::new;
    let rings = [
        vec![],
        vec![p(1.0, 1.0)],
        vec![p(1.0, 1.0); 4],
        vec![p(0.0, 0.0), p(4.0, 0.0), p(0.0, 4.0)],
        vec![p(0.0, 0.0), p(4.0, 4.0), p(4.0, 0.0), p(0.0, 4.0)],
        vec![p(-9e99, 0.0), p(9e99, 1.0), p(1e-300, 9e99)],
        vec![p(5.0, 1e-320), p(6.0, 0.0), p(7.0, 1e-310)],
    ];
    let windows = [None, Some((p(0.0, 0.0), p(0.0, 0.0))), Some((p(0.0, 0.0), p(3.0, 2.0)))];
    for (i, ring) in rings.iter().enumerate() {
        for window in windows {
            let window = window.and_then(|(low, high)| Rect::new(low, high).ok());
            let clip = rings[(i + 3) % rings.len()].clone();
            for clip in [vec![], vec![clip]] {
                let (lines, points) = (vec![ring.clone()], ring.clone());
                let figure = Figure { window, lines, rings: vec![ring.clone()], clip, points };
                draw_all(&Input::Figure(figure));
            }
        }
        let space = |q: &DVec2| DVec3::new(q.x, q.y, -q.x - 1.0);
        draw_all(&Input::Faces(vec![ring.iter().map(space).collect()]));
        draw_all(&Input::ClipSpace(ring.iter().map(|q| space(q).extend(q.y)).collect()));
    }
}

/// Runs all lessons on an input, with all operations, and draws their frames.
fn draw_all(input: &Input) {
    for lesson in explain::lessons() {
        // Only overlays have operations.
        let overlays = ["weiler-atherton", "greiner-hormann", "vatti", "overlay"];
        let operations = if overlays.contains(&lesson.name) { BooleanOp::ALL.len() } else { 1 };
        for &operation in &BooleanOp::ALL[..operations] {
            let options = Options { operation, ..Options::default() };
            let Ok(frames) = lesson.run(input, &options, 12) else { continue };
            let sheet = explain::sheet(&frames, 3, Language::German);
            let data = explain::json(lesson, &frames, Language::German);
            assert!(
                !sheet.contains("NaN") && !sheet.contains("='inf"),
                "{} {input:?}",
                lesson.name
            );
            assert!(!data.contains(":NaN") && !data.contains(":inf"), "{} {input:?}", lesson.name);
        }
    }
}
