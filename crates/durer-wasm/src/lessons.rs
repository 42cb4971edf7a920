//! The list of lessons.

use durer::explain::{FAMILIES, Family, Lesson, Word};
use serde_json::{Value, json};

/// Returns all families with their lessons.
pub(crate) fn list() -> Value {
    json!({ "version": env!("CARGO_PKG_VERSION"), "families": FAMILIES.iter().map(family).collect::<Vec<_>>() })
}

fn family(family: &Family) -> Value {
    let lessons: Vec<Value> = family.lessons.iter().map(lesson).collect();
    json!({ "title": word(family.title), "lessons": lessons })
}

fn word(word: Word) -> Value {
    json!({ "en": word.en, "de": word.de })
}

fn lesson(lesson: &Lesson) -> Value {
    let info = lesson.info;
    let example = |example: &durer::explain::Example| json!({ "name": example.name, "title": word(example.title) });
    let template = |template: &&durer::explain::Template| json!({ "kind": template.kind, "text": word(template.text) });
    json!({
        "name": lesson.name,
        "title": info.title,
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
        "templates": lesson.templates.iter().map(template).collect::<Vec<_>>(),
    })
}
