//! Short decimal numbers.

use std::fmt::Write;

/// Appends a number rounded to this many digits after the point, without trailing zeros and, like SVG and PDF allow,
/// without the zero before the point. Numbers that are not finite become 0.
pub fn push(text: &mut String, value: f64, digits: usize) {
    let start = text.len();
    let value = if value.is_finite() { value } else { 0.0 };
    // Writing to a string cannot fail.
    let _ = write!(text, "{value:.digits$}");
    if text[start..].contains('.') {
        let kept = text.trim_end_matches('0').trim_end_matches('.').len();
        text.truncate(kept);
    }
    if &text[start..] == "-0" {
        text.replace_range(start.., "0");
    } else if text[start..].starts_with("0.") {
        text.remove(start);
    } else if text[start..].starts_with("-0.") {
        text.remove(start + 1);
    }
}

/// Returns the number on its own.
pub fn short(value: f64, digits: usize) -> String {
    let mut text = String::new();
    push(&mut text, value, digits);
    text
}

#[cfg(test)]
mod tests {
    use super::short;

    #[test]
    fn numbers_are_short() {
        let cases = [(0.5, ".5"), (-0.25, "-.25"), (10.0, "10"), (-0.0001, "0"), (1.2345, "1.234")];
        for (value, text) in cases {
            assert_eq!(short(value, 3), text);
        }
        assert_eq!(
            [f64::NAN, 100.0, 1e21].map(|v| short(v, 0)),
            ["0", "100", "1000000000000000000000"]
        );
    }
}
