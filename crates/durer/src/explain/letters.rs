//! Widths of text, so that captions fit, and their division into lines.

/// Returns the width of a text in pixels for a size of the font, measured in DejaVu Sans, which is as wide as any
/// common font without serifs: where another one is shown, it takes less room.
pub(super) fn width(text: &str, size: f64) -> f64 {
    text.chars().map(thousandths).sum::<f64>() * size / 1000.0
}

/// Returns the width of a letter in thousandths of the size of the font, or somewhat more.
fn thousandths(letter: char) -> f64 {
    match letter {
        'i' | 'j' | 'l' | '\'' => 280.0,
        'I' | ' ' | '.' | ',' | '|' | ':' | ';' => 340.0,
        'f' | 't' | 'r' | '(' | ')' | '[' | ']' | '-' | '!' | '/' => 412.0,
        'a'..='l' | 'n'..='v' | 'x'..='z' | '0'..='9' | 'ä' | 'ö' | 'ü' | 'ß' | '{' | '}' => {
            637.0
        }
        'm' | 'W' | '%' | '…' => 1000.0,
        'A'..='L' | 'P' | 'R'..='V' | 'X'..='Z' => 771.0,
        _ => 864.0,
    }
}

/// Divides a text into lines that are no wider than `most` pixels, between words where that can be.
pub(super) fn wrap(text: &str, size: f64, most: f64) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in words(text) {
        let mut line = lines.pop().unwrap_or_default();
        if !line.is_empty() && width(&line, size) + width(word, size) + width(" ", size) > most {
            lines.push(std::mem::take(&mut line));
        } else if !line.is_empty() {
            line.push(' ');
        }
        for letter in word.chars() {
            if !line.is_empty() && width(&line, size) + thousandths(letter) * size / 1000.0 > most {
                lines.push(std::mem::take(&mut line));
            }
            line.push(letter);
        }
        lines.push(line);
    }
    lines
}

/// Divides a text at spaces, but not within the brackets of a point, after a comma or semicolon.
fn words(text: &str) -> impl Iterator<Item = &str> {
    let mut depth = 0;
    let mut before = ' ';
    text.split(move |letter| {
        match letter {
            '(' => depth += 1,
            ')' => depth -= 1,
            _ => {}
        }
        let within = depth > 0 && matches!(before, ',' | ';');
        before = letter;
        letter == ' ' && !within
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_no_wider_than_they_may_be() {
        let text =
            "the code of the start is 1001: left and above, Donaudampfschifffahrtsgesellschaft";
        let lines = wrap(text, 10.0, 100.0);
        assert!(lines.iter().all(|line| width(line, 10.0) <= 100.0), "{lines:?}");
        assert_eq!(lines[0], "the code of the");
        assert_eq!(lines.concat().replace(' ', ""), text.replace(' ', ""));
        assert_eq!(wrap("", 10.0, 100.0), [""]);
        assert_eq!(wrap("ab (1, 2) c", 10.0, 40.0), ["ab", "(1, 2) c"]);
    }
}
