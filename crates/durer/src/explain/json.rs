//! Runs as JSON (RFC 8259), written by hand: the library knows no format of files otherwise.

use super::lesson::Lesson;
use super::picture::{Look, Mark, MarkShape, Picture};
use super::replay::Frame;
use super::table::Table;
use super::words::{Language, Value};
use crate::math::DVec2;
use std::fmt::Write;

/// Returns a run as a JSON object: the algorithm's facts and pseudocode, and its frames with captions and tables in one
/// language, values as numbers, and the marks of the pictures. `<` is written out, so that a page may contain the text.
pub fn json(lesson: &Lesson, frames: &[Frame], language: Language) -> String {
    let info = lesson.info;
    let texts = [
        ("algorithm", lesson.name),
        ("title", lesson.title().text(language)),
        ("authors", info.authors),
        ("source", info.source),
        ("cost", info.cost),
        ("limits", info.limits),
        ("language", language.code()),
    ];
    let mut members: Vec<String> =
        texts.iter().map(|(name, text)| member(name, &string(text))).collect();
    members.push(member("year", &info.year.to_string()));
    members.push(member("pseudocode", &array(info.pseudocode.iter().map(|line| string(line)))));
    members.push(member("frames", &array(frames.iter().map(|f| frame(f, language)))));
    object(members) + "\n"
}

/// Returns a text as a JSON string.
pub fn string(text: &str) -> String {
    let mut out = String::with_capacity(text.len() + 2);
    out.push('"');
    for letter in text.chars() {
        match letter {
            '"' => out.push_str("\\\""),
            '\\' => out.push_str("\\\\"),
            // These would end a script, or a line of it.
            '<' | '\u{2028}' | '\u{2029}' | '\0'..='\u{1f}' => {
                let _ = write!(out, "\\u{:04x}", u32::from(letter));
            }
            _ => out.push(letter),
        }
    }
    out.push('"');
    out
}

fn member(name: &str, value: &str) -> String {
    format!("{}:{value}", string(name))
}

fn object(members: impl IntoIterator<Item = String>) -> String {
    format!("{{{}}}", members.into_iter().collect::<Vec<_>>().join(","))
}

fn array(values: impl IntoIterator<Item = String>) -> String {
    format!("[{}]", values.into_iter().collect::<Vec<_>>().join(","))
}

/// Returns a number; JSON has none that is not finite.
fn number(x: f64) -> String {
    if x.is_finite() { format!("{x}") } else { string(&x.to_string()) }
}

fn point(p: DVec2) -> String {
    array(p.to_array().map(number))
}

/// Returns one frame as a JSON object: its line, kind, caption with values, and table, without the marks of the
/// picture.
pub fn frame_json(frame: &Frame, language: Language) -> String {
    object(texts(frame, language))
}

/// Returns the members of a frame other than its picture.
fn texts(frame: &Frame, language: Language) -> Vec<String> {
    let values = frame.caption.values.iter().map(|(name, v)| member(name, &value(v, language)));
    vec![
        member("line", &frame.line.to_string()),
        member("kind", &string(frame.kind)),
        member("caption", &string(&frame.text(language))),
        member("values", &object(values)),
        member("table", &table(&frame.table, language)),
    ]
}

fn frame(frame: &Frame, language: Language) -> String {
    let mut members = texts(frame, language);
    members.push(member("picture", &picture(&frame.picture, language)));
    object(members)
}

fn value(v: &Value, language: Language) -> String {
    match v {
        Value::Text(_) | Value::Word(_) => string(&v.text(language)),
        Value::Number(x) => number(*x),
        Value::Point(p) => point(*p),
        Value::Space(p) => array(p.to_array().map(number)),
        Value::List(all) => array(all.iter().map(|v| value(v, language))),
    }
}

fn table(table: &Table, language: Language) -> String {
    let heads = table.heads.iter().map(|word| string(word.text(language)));
    let rows = table.rows.iter().map(|row| {
        let cells = row.cells.iter().map(|cell| {
            let changed = member("changed", if cell.changed { "true" } else { "false" });
            object([member("text", &string(&cell.value.text(language))), changed])
        });
        object([member("name", &string(&row.name.text(language))), member("cells", &array(cells))])
    });
    object([member("heads", &array(heads)), member("rows", &array(rows))])
}

fn picture(picture: &Picture, language: Language) -> String {
    let [min, max] = picture.extent;
    let grid = picture.grid.map(|sides| array(sides.map(|side| side.to_string())));
    object([
        member("min", &point(min)),
        member("max", &point(max)),
        member("down", if picture.down { "true" } else { "false" }),
        member("grid", &grid.unwrap_or_else(|| "null".to_owned())),
        member("marks", &array(picture.marks.iter().map(|m| mark(m, language)))),
    ])
}

fn mark(mark: &Mark, language: Language) -> String {
    let points = |all: &[DVec2]| array(all.iter().map(|&p| point(p)));
    let (shape, mut members) = match &mark.shape {
        MarkShape::Chain(all) => ("chain", vec![member("points", &points(all))]),
        MarkShape::Rings(all) => {
            ("rings", vec![member("rings", &array(all.iter().map(|ring| points(ring))))])
        }
        MarkShape::Dot(p) => ("dot", vec![member("at", &point(*p))]),
        MarkShape::Arrow(ends) => ("arrow", vec![member("points", &points(ends))]),
        MarkShape::Label { at, by, text } => {
            let text = member("text", &string(&text.text(language)));
            ("label", vec![member("at", &point(*at)), member("by", &point(*by)), text])
        }
        MarkShape::Cell { at, color, text } => {
            let at = member("at", &array(at.map(|x| x.to_string())));
            let color = color.map(|rgb| member("color", &array(rgb.map(|c| c.to_string()))));
            let text = member("text", &string(&text.text(language)));
            ("cell", [at, text].into_iter().chain(color).collect())
        }
    };
    members.push(member("shape", &string(shape)));
    members.push(member("look", &string(mark.look.name())));
    object(members)
}

impl Look {
    /// Returns the name in data.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Pale => "pale",
            Self::Thin => "thin",
            Self::Grid => "grid",
            Self::Window => "window",
            Self::Dashed => "dashed",
            Self::First => "first",
            Self::Second => "second",
            Self::Result => "result",
            Self::Now => "now",
        }
    }
}
