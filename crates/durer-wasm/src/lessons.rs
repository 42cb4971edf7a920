//! The list of lessons.

use crate::answer::Failure;
use durer::explain::{self, Lesson, LessonFamily, LessonFault, Word};
use serde_json::{Value, json};

/// Families of this engine.
const FAMILIES: &[&[LessonFamily]] = &[
    #[cfg(feature = "plane")]
    explain::PLANE,
    #[cfg(feature = "space")]
    explain::SPACE,
    #[cfg(feature = "visibility")]
    explain::VISIBILITY,
];

fn families() -> impl Iterator<Item = &'static LessonFamily> + Clone {
    FAMILIES.iter().copied().flatten()
}

/// Returns a lesson of this engine.
pub(crate) fn lesson(name: &str) -> Result<&'static Lesson, Failure> {
    explain::find(families(), name).map_err(|e| e.to_string())
}

/// Returns the families of this engine with their lessons.
pub(crate) fn list() -> Value {
    json!({ "version": env!("CARGO_PKG_VERSION"), "families": families().map(family).collect::<Vec<_>>() })
}

fn family(family: &LessonFamily) -> Value {
    let lessons: Vec<Value> = family.lessons.iter().map(facts).collect();
    json!({ "title": word(family.title), "lessons": lessons })
}

/// Returns a text in every language.
pub(crate) fn word(word: Word) -> Value {
    json!({ "en": word.en, "de": word.de })
}

fn facts(lesson: &Lesson) -> Value {
    let info = lesson.info;
    let fault = |fault: &LessonFault| json!({ "line": fault.line, "wrong": fault.wrong });
    let example = |example: &durer::explain::Example| json!({ "name": example.name, "title": word(example.title) });
    let template = |template: &&durer::explain::Template| json!({ "kind": template.kind, "name": word(template.name()), "text": word(template.text) });
    json!({
        "name": lesson.name,
        "title": word(lesson.title()),
        "authors": info.authors,
        "year": info.year,
        "source": info.source,
        "class": info.class.name(),
        "occluder": info.occluder.name(),
        "coherence": info.coherence.iter().map(|kind| kind.name()).collect::<Vec<_>>(),
        "cost": info.cost,
        "limits": info.limits,
        "pseudocode": info.pseudocode,
        "takes": word(lesson.takes),
        "examples": lesson.examples.iter().map(example).collect::<Vec<_>>(),
        "faults": faults(lesson.name).iter().map(fault).collect::<Vec<_>>(),
        "templates": lesson.templates.iter().map(template).collect::<Vec<_>>(),
    })
}

/// Returns the faults that a lesson's program can have; only lessons in the plane have programs.
fn faults(name: &str) -> &'static [LessonFault] {
    if cfg!(feature = "plane") { explain::faults(name) } else { &[] }
}
