//! A run as one page that needs nothing else.

use durer::explain::{self, Frame, Language, Lesson};

/// Words of the page.
struct Words {
    code: &'static str,
    state: &'static str,
    step: &'static str,
    first: &'static str,
    back: &'static str,
    play: &'static str,
    next: &'static str,
    last: &'static str,
    speed: &'static str,
    keys: &'static str,
}

const ENGLISH: Words = Words {
    code: "Pseudocode",
    state: "State",
    step: "Step",
    first: "First step",
    back: "Step back",
    play: "Play or pause",
    next: "Next step",
    last: "Last step",
    speed: "Steps per second",
    keys: "Keys: ← → step, Shift with them next of this kind, Home End, Space plays. Click a line of the pseudocode to go to its next step.",
};

const GERMAN: Words = Words {
    code: "Pseudocode",
    state: "Zustand",
    step: "Schritt",
    first: "Erster Schritt",
    back: "Schritt zurück",
    play: "Abspielen oder anhalten",
    next: "Nächster Schritt",
    last: "Letzter Schritt",
    speed: "Schritte je Sekunde",
    keys: "Tasten: ← → Schritt, mit Umschalt zum nächsten gleicher Art, Pos1 Ende, Leertaste spielt ab. Ein Klick auf eine Zeile geht zu ihrem nächsten Schritt.",
};

/// Returns the page.
pub fn page(lesson: &Lesson, frames: &[Frame], language: Language) -> String {
    let words = match language {
        Language::English => &ENGLISH,
        Language::German => &GERMAN,
    };
    let pictures: Vec<String> = frames
        .iter()
        .map(|f| explain::json_string(&explain::picture(&f.picture, language)))
        .collect();
    let values = [
        ("{{lang}}", language.code().to_owned()),
        ("{{title}}", text(lesson.title().text(language))),
        ("{{by}}", text(&format!("{}, {}", lesson.info.authors, lesson.info.year))),
        ("{{source}}", text(lesson.info.source)),
        ("{{code}}", text(words.code)),
        ("{{state}}", text(words.state)),
        ("{{step}}", text(words.step)),
        ("{{first}}", text(words.first)),
        ("{{back}}", text(words.back)),
        ("{{play}}", text(words.play)),
        ("{{next}}", text(words.next)),
        ("{{last}}", text(words.last)),
        ("{{speed}}", text(words.speed)),
        ("{{keys}}", text(words.keys)),
        ("{{run}}", explain::json(lesson, frames, language)),
        ("{{pictures}}", format!("[{}]", pictures.join(","))),
    ];
    filled(include_str!("page.html"), &values)
}

/// Returns a template with its names replaced, each place once, so that values may contain names.
fn filled(template: &str, values: &[(&str, String)]) -> String {
    let mut out = String::new();
    let mut rest = template;
    while let Some(at) = rest.find("{{") {
        let (before, from) = rest.split_at(at);
        out.push_str(before);
        let known = values.iter().find(|(name, _)| from.starts_with(name));
        let (name, value) = known.map_or(("{{", "{{"), |(name, value)| (*name, value.as_str()));
        out.push_str(value);
        rest = from.get(name.len()..).unwrap_or_default();
    }
    out + rest
}

fn text(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_not_looked_into() {
        let values = [("{{a}}", "{{b}}".to_owned()), ("{{b}}", "x".to_owned())];
        assert_eq!(filled("1 {{a}} 2 {{b}} {{c}}", &values), "1 {{b}} 2 x {{c}}");
    }
}
