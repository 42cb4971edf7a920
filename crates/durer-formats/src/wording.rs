//! Texts of files in a form for messages: on one line, in one direction, and not too long.

use std::borrow::Cow;
use std::fmt::Write;

/// Largest number of characters of a quoted name, or of other text of a file.
const WORDS: usize = 120;

/// Largest number of characters of a whole message; durer's own messages with their quotes are shorter.
const MESSAGE: usize = 1000;

/// Numbers with more characters than this are written with an exponent.
const NUMBER: usize = 20;

/// Returns text of a file, such as a name, for a message: characters that control a terminal, end the line or reverse
/// the writing direction are escaped as in Rust (`\n`, `\u{202e}`), and text beyond 120 characters is cut off.
pub fn shown(text: &str) -> Cow<'_, str> {
    escaped(cut(text))
}

/// Returns at most 120 characters of a text, the last one an ellipsis where there were more.
pub fn cut(text: &str) -> Cow<'_, str> {
    cut_at(text, WORDS)
}

/// Returns a number with what is counted, e.g. `1 feature has` or `2 features have`.
///
/// ```
/// use durer_formats::wording::counted;
/// assert_eq!(counted(1, "feature has", "features have"), "1 feature has");
/// assert_eq!(counted(0, "feature has", "features have"), "0 features have");
/// ```
pub fn counted(count: u64, one: &str, several: &str) -> String {
    format!("{count} {}", if count == 1 { one } else { several })
}

/// Returns a number and words that agree with it: of each `{one|several}` in the words, the first if the number is 1.
///
/// ```
/// use durer_formats::wording::agreeing;
/// let words = "{face has|faces have} two corners; {it is|they are} left out";
/// assert_eq!(agreeing(1, words), "1 face has two corners; it is left out");
/// assert_eq!(agreeing(2, words), "2 faces have two corners; they are left out");
/// ```
pub fn agreeing(count: u64, words: &str) -> String {
    let mut out = count.to_string() + " ";
    let mut rest = words;
    while let Some((before, choice)) = rest.split_once('{')
        && let Some((choice, after)) = choice.split_once('}')
    {
        let (one, several) = choice.split_once('|').unwrap_or((choice, choice));
        out += before;
        out += if count == 1 { one } else { several };
        rest = after;
    }
    out + rest
}

/// Returns how many things there are, e.g. `there is 1` or `there are 2`.
pub(crate) fn there_are(count: u64) -> String {
    format!("there {} {count}", if count == 1 { "is" } else { "are" })
}

fn cut_at(text: &str, most: usize) -> Cow<'_, str> {
    let mut ends = text.char_indices().map(|(at, _)| at).skip(most - 1);
    match (ends.next(), ends.next()) {
        (Some(last), Some(_)) => Cow::Owned(format!("{}…", text.get(..last).unwrap_or_default())),
        _ => Cow::Borrowed(text),
    }
}

/// Returns a path for a message, as [`shown`] does; the end of a long one, which has the file's name.
pub fn shown_path(path: &std::path::Path) -> String {
    let text = path.to_string_lossy();
    let count = text.chars().count();
    let end: String = text.chars().skip(count.saturating_sub(WORDS - 1)).collect();
    escaped(if count > WORDS { Cow::Owned(format!("…{end}")) } else { text.clone() }).into_owned()
}

/// Returns a text with the characters written out that would steer a terminal, end the line or turn the direction of
/// writing. Characters that are written out already stay so.
pub fn escaped<'a>(text: impl Into<Cow<'a, str>>) -> Cow<'a, str> {
    let text = text.into();
    if !text.chars().any(steers) {
        return text;
    }
    let mut out = String::with_capacity(text.len() + 16);
    for c in text.chars() {
        if steers(c) {
            out.extend(c.escape_default());
        } else {
            out.push(c);
        }
    }
    Cow::Owned(out)
}

/// Returns equivalent JSON in which characters that reverse the writing direction or control a terminal are escaped in
/// strings.
pub fn json(text: &str) -> Cow<'_, str> {
    let written_out = |c: char| steers(c) && !matches!(c, '\n' | '\r' | '\t');
    if !text.chars().any(written_out) {
        return Cow::Borrowed(text);
    }
    let mut out = String::with_capacity(text.len() + 16);
    for c in text.chars() {
        if written_out(c) {
            for unit in c.encode_utf16(&mut [0; 2]) {
                // Writing to a string cannot fail.
                let _ = write!(out, "\\u{unit:04x}");
            }
        } else {
            out.push(c);
        }
    }
    Cow::Owned(out)
}

/// Returns a message that quotes text of a file, safe for a terminal: escaped, with the text between backticks cut as
/// by [`shown`], and long numbers written with an exponent.
pub fn message(text: &str) -> Cow<'_, str> {
    // Nearly all are fine as they are.
    if text.len() <= NUMBER || (text.len() <= WORDS && !has_long_number(text)) {
        return escaped(text);
    }
    let mut out = String::new();
    for (i, part) in text.split('`').enumerate() {
        let quoted = i % 2 == 1;
        if i > 0 {
            out.push('`');
        }
        out += &if quoted { cut(part) } else { with_short_numbers(part) };
    }
    Cow::Owned(escaped(cut_at(&out, MESSAGE)).into_owned())
}

/// Returns whether a character controls the display, or the characters beside it.
fn steers(c: char) -> bool {
    c.is_control()
        || matches!(c, '\u{ad}' | '\u{61c}' | '\u{180e}' | '\u{200b}' | '\u{200e}' | '\u{200f}'
            | '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{206f}' | '\u{feff}' | '\u{fff9}'..='\u{fffb}'
            | '\u{e0000}'..='\u{e007f}')
}

fn of_number(byte: u8) -> bool {
    byte.is_ascii_digit() || byte == b'.'
}

fn has_long_number(text: &str) -> bool {
    text.as_bytes().chunk_by(|&a, &b| of_number(a) == of_number(b)).any(is_long_number)
}

fn is_long_number(run: &[u8]) -> bool {
    run.len() > NUMBER && run.iter().all(|&b| of_number(b))
}

/// Returns the same text with numbers of more than 20 characters as powers of ten.
fn with_short_numbers(text: &str) -> Cow<'_, str> {
    if !has_long_number(text) {
        return Cow::Borrowed(text);
    }
    let mut out = String::new();
    let mut rest = text;
    for run in text.as_bytes().chunk_by(|&a, &b| of_number(a) == of_number(b)) {
        // Runs end beside ASCII characters, so between characters.
        let (run_text, after) = rest.split_at_checked(run.len()).unwrap_or((rest, ""));
        rest = after;
        match run_text.parse::<f64>().ok().filter(|_| is_long_number(run)) {
            // Writing to a string cannot fail.
            Some(number) => drop(write!(out, "{}", short(number))),
            None => out.push_str(run_text),
        }
    }
    Cow::Owned(out)
}

/// Returns a number with few digits: single precision is enough to find it in the file.
fn short(number: f64) -> String {
    let text = format!("{number:.8e}");
    let (digits, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let digits = digits.trim_end_matches('0').trim_end_matches('.');
    if exponent == "0" { digits.to_owned() } else { format!("{digits}e{exponent}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_steers_is_written_out() {
        for (text, out) in [
            ("a\u{1b}[31mX\n\rdurer: b", r"a\u{1b}[31mX\n\rdurer: b"),
            ("a\u{202e}b\u{2066}c\u{9b}", r"a\u{202e}b\u{2066}c\u{9b}"),
            ("Größe, 大きさ, 👩‍🚀, \u{301}", "Größe, 大きさ, 👩‍🚀, \u{301}"),
        ] {
            assert_eq!(shown(text), out);
            assert_eq!(message(out), out);
        }
    }

    #[test]
    fn words_are_cut_and_what_is_said_of_them_stays() {
        let name = "é".repeat(500);
        assert_eq!(shown(&name).chars().count(), 120);
        assert_eq!(shown(&name[..240]), &name[..240]);
        let out =
            message(&format!("material `{name}` is not defined; a grey one is used")).into_owned();
        assert!(
            out.starts_with("material `éé")
                && out.ends_with("é…` is not defined; a grey one is used")
        );
        assert_eq!(message(&"`".repeat(5000)).chars().count(), 1000);
        let path = format!("/{name}/model.obj");
        let shown = shown_path(path.as_ref());
        assert!(shown.starts_with("…é") && shown.ends_with("é/model.obj"), "{shown}");
        assert_eq!(shown.chars().count(), 120);
    }

    #[test]
    fn json_says_the_same() {
        let names = ["a\u{202e}b\n", "\u{e0041}\u{7f}", "é"];
        let text = serde_json::to_string_pretty(&names).unwrap();
        let out = json(&text);
        assert!(out.contains(r"a\u202eb\n") && out.contains(r"\udb40\udc41\u007f"), "{out}");
        assert_eq!(serde_json::from_str::<[String; 3]>(&out).unwrap(), names);
    }

    #[test]
    fn long_numbers_have_an_exponent() {
        let text = format!("eye is [{}, {}, 12345678901234567890]; no", 1e300, 1.5e-30);
        assert_eq!(message(&text), "eye is [1e300, 1.5e-30, 12345678901234567890]; no");
    }
}
