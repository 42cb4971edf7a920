//! Runs by number, and their frames.

use crate::answer::{Failure, FrameRequest, RunRequest};
use crate::input::InputData;
use crate::lessons::lesson;
use crate::targets::targets;
use durer::clip::polygon::{BooleanOp, WindingRule};
use durer::explain::{
    self, Frame, Frames, Input, Language, Lesson, Options, Picture, Row, Table, Template, Word,
    json_string, picture_of_size,
};
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// The most runs that are kept: a page compares three, and has some in flight.
const MOST_RUNS: usize = 16;

/// The most steps of a run.
const MOST_STEPS: usize = 100_000;

/// The most captions in an answer.
const MOST_CAPTIONS: usize = 2_000;

/// The most rows of a table, and values of a list, in an answer: a page would take long to show more.
const MOST_ROWS: usize = 200;

/// Steps by which choices are compared.
const COMPARED: usize = 400;

/// Runs that requests may refer to.
#[derive(Debug, Default)]
pub(crate) struct Runs {
    next: u32,
    all: BTreeMap<u32, Frames>,
}

impl Runs {
    /// Runs an algorithm and keeps its frames.
    pub fn start(&mut self, request: RunRequest) -> Result<Value, Failure> {
        let words = |e: durer::Error| e.to_string();
        let lesson = lesson(&request.name)?;
        let is_example = matches!(request.input, InputData::Example(_));
        let input = match request.input.into_input()? {
            Input::Example(name) => lesson.example(&name).map_err(words)?,
            own => own,
        };
        let options = options(&request.operation, &request.rule)?;
        let cap = request.cap.min(MOST_STEPS);
        let run = match request.fault {
            Some(fault) => with_fault(lesson, fault, &input, cap),
            None => lesson.record(&input, &options, cap),
        };
        let run = run.map_err(words)?;
        let mut answer = json!({
            "handle": self.next,
            "steps": run.len(),
            "lines": run.outline().map(|(line, _)| line).collect::<Vec<_>>(),
            "templates": run.outline().map(|(_, template)| place(lesson, template)).collect::<Vec<_>>(),
            "input": InputData::of_input(&input),
        });
        if request.choices && (is_example || has_choices(lesson)) {
            answer["choices"] = choices(lesson, &input);
        } else if request.choices {
            answer["choices"] = json!({ "operations": [], "rules": [] });
        }
        while self.all.len() >= MOST_RUNS {
            self.all.pop_first();
        }
        self.all.insert(self.next, run);
        self.next = self.next.wrapping_add(1);
        Ok(answer)
    }

    /// Returns a run by its number.
    pub fn of(&self, handle: u32) -> Result<&Frames, Failure> {
        self.all.get(&handle).ok_or_else(|| {
            format!("run {handle} does not exist; only the last {MOST_RUNS} are kept")
        })
    }

    /// Forgets a run.
    pub fn drop(&mut self, handle: u32) {
        self.all.remove(&handle);
    }
}

/// Runs the lesson's program with a fault; only lessons in the plane have programs.
fn with_fault(lesson: &Lesson, fault: usize, input: &Input, cap: usize) -> durer::Result<Frames> {
    if cfg!(feature = "plane") {
        return explain::record_with_fault(lesson.name, fault, input, cap);
    }
    let instead = "lessons in the plane have programs";
    Err(durer::Error::Unsupported { what: "a fault in a lesson in space", instead })
}

/// Returns the number of a caption's template in the lesson; −1 for one that is of no step.
fn place(lesson: &Lesson, template: &Template) -> i64 {
    let found = lesson.templates.iter().position(|own| *own == template);
    found.map_or(-1, |place| place as i64)
}

/// Returns options by the names of operation and rule.
fn options(operation: &str, rule: &str) -> Result<Options, Failure> {
    let mut options = Options::default();
    if !operation.is_empty() {
        options.operation = operation.parse().map_err(|e: durer::Error| e.to_string())?;
    }
    if !rule.is_empty() {
        options.rule = rule.parse().map_err(|e: durer::Error| e.to_string())?;
    }
    Ok(options)
}

/// Returns the operations and the rules with which the lesson runs, if they change what happens.
fn choices(lesson: &Lesson, input: &Input) -> Value {
    let default = Options::default();
    let operations =
        BooleanOp::ALL.iter().map(|&op| (op.name(), Options { operation: op, ..default }));
    let rules = WindingRule::ALL.iter().map(|&rule| (rule.name(), Options { rule, ..default }));
    let [operations, rules] = [operations.collect::<Vec<_>>(), rules.collect()]
        .map(|options| distinct(lesson, input, &options));
    json!({ "operations": operations, "rules": rules })
}

/// Returns whether choices change the run of one of the lesson's examples: most lessons have none, and need not be run
/// many times on a large input to find that out.
fn has_choices(lesson: &Lesson) -> bool {
    let changes = |input: &Input| {
        let choices = choices(lesson, input);
        ["operations", "rules"].iter().any(|&kind| choices[kind] != json!([]))
    };
    lesson.examples.iter().any(|example| changes(&(example.input)()))
}

/// Returns the names of the options with which the lesson runs on an input; none if all of them give the same run.
fn distinct(lesson: &Lesson, input: &Input, all: &[(&'static str, Options)]) -> Vec<&'static str> {
    let captions = |options: &Options| {
        let run = lesson.record(input, options, COMPARED).ok()?;
        Some(run.captions(0).collect::<Vec<_>>())
    };
    let runs = all.iter().filter_map(|(name, options)| Some((*name, captions(options)?)));
    let good: Vec<_> = runs.collect();
    let differ = good.windows(2).any(|pair| pair[0].1 != pair[1].1);
    if differ { good.into_iter().map(|(name, _)| name).collect() } else { Vec::new() }
}

/// Makes a frame.
pub(crate) fn made(run: &Frames, step: usize) -> Result<Frame, Failure> {
    run.frame(step).ok_or_else(|| format!("step {step}: the run has {} steps", run.len()))
}

/// Returns a frame as JSON: its texts and table, the drawing, where the input is in it, and what the step is about.
pub(crate) fn frame(run: &Frames, request: &FrameRequest) -> Result<String, Failure> {
    let mut frame = made(run, request.step)?;
    shorten(&mut frame.table);
    let language = request.language.into();
    let drawing = picture_of_size(&frame.picture, request.longest, language);
    Ok(format!(
        "{{\"frame\":{},\"svg\":{},\"map\":{},\"targets\":{}}}",
        explain::frame_json(&frame, language),
        json_string(&drawing),
        map(&frame.picture),
        targets(&frame.picture)
    ))
}

/// Leaves rows in the middle of a long table out, and values in the middle of a long list, with their number in their
/// place.
fn shorten(table: &mut Table) {
    let list =
        |number: usize, en, de| explain::Value::List(vec![number.into(), Word::new(en, de).into()]);
    let row = |number| Row { name: list(number, "more rows", "weitere Zeilen"), cells: Vec::new() };
    leave_out(&mut table.rows, row);
    for cell in table.rows.iter_mut().flat_map(|row| &mut row.cells) {
        if let explain::Value::List(values) = &mut cell.value {
            leave_out(values, |number| list(number, "more …", "weitere …"));
        }
    }
}

/// Replaces what is between the first and the last of many by a note about its number.
fn leave_out<T>(all: &mut Vec<T>, note: impl FnOnce(usize) -> T) {
    let more = all.len().saturating_sub(MOST_ROWS);
    if more > 0 {
        let first = MOST_ROWS / 2;
        all.splice(first..first + more, [note(more)]);
    }
}

/// Returns the part of the plane that a picture shows, and the map that takes points of the input there.
fn map(picture: &Picture) -> Value {
    let [min, max] = picture.extent.map(|p| p.to_array());
    let matrix = picture.picture_from_input.map(|map| map.to_cols_array());
    json!({ "min": min, "max": max, "down": picture.down, "input": matrix })
}

/// Returns captions in one language.
pub(crate) fn captions(run: &Frames, first: usize, count: usize, language: Language) -> Value {
    let all = run.captions(first).take(count.min(MOST_CAPTIONS));
    json!({ "captions": all.map(|caption| caption.text(language)).collect::<Vec<_>>() })
}
