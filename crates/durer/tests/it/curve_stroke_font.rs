//! The single-stroke font.

use durer::curve::stroke_font::line;
use durer::math::DVec2;
use proptest::prelude::*;

fn strokes_of(c: char) -> Vec<Vec<DVec2>> {
    line(&c.to_string(), 12.0).strokes
}

/// Returns every letter that the font claims to have, except the space.
fn all() -> Vec<char> {
    let ascii = ('!'..='~').collect::<String>();
    (ascii + "°µ×±–—…Ø²³äöüÄÖÜßéèêñåçøřš−·÷").chars().collect()
}

#[test]
fn letters_are_all_there_and_all_different() {
    let missing = strokes_of('\u{10348}');
    let mut seen: Vec<(char, Vec<Vec<DVec2>>)> = Vec::new();
    for c in all() {
        let strokes = strokes_of(c);
        assert!(!strokes.is_empty() && strokes != missing, "{c} is missing");
        let twin = seen.iter().find(|(_, s)| *s == strokes);
        assert!(twin.is_none(), "{c} looks like {:?}", twin.map(|t| t.0));
        seen.push((c, strokes));
    }
}

#[test]
fn letters_stand_on_the_base_line_within_their_widths() {
    for c in all() {
        let text = line(&c.to_string(), 12.0);
        let points = text.strokes.iter().flatten();
        for p in points {
            assert!(p.x >= 0.0 && p.x <= text.advance, "{c} leaves its width: {p}");
            assert!((-16.0..=4.0).contains(&p.y), "{c} is too high or too deep: {p}");
        }
        if c.is_ascii_alphanumeric() {
            let lowest = text.strokes.iter().flatten().map(|p| p.y).fold(f64::MIN, f64::max);
            assert!(lowest == 0.0 || "gjpqyQ".contains(c), "{c} does not stand: {lowest}");
        }
        if c.is_ascii_uppercase() || c.is_ascii_digit() {
            let top = text.strokes.iter().flatten().map(|p| p.y).fold(f64::MAX, f64::min);
            assert!((top + 12.0).abs() < 1e-9, "{c} is not as high as capitals: {top}");
        }
    }
}

#[test]
fn figures_stand_in_columns() {
    let widths: Vec<f64> = ('0'..='9').map(|c| line(&c.to_string(), 5.0).advance).collect();
    assert!(widths.iter().all(|w| *w == widths[0]), "{widths:?}");
}

proptest! {
    #[test]
    fn any_text_gives_finite_chains(text in "\\PC{0,40}", height in prop::num::f64::ANY) {
        let text = line(&text, height);
        prop_assert!(text.advance.is_finite());
        for stroke in &text.strokes {
            prop_assert!(stroke.len() >= 2);
            prop_assert!(stroke.iter().all(|p| p.is_finite()));
        }
    }

    #[test]
    fn size_scales_and_text_joins(a in "[ -~äöüé°]{0,9}", b in "[ -~äöüé°]{0,9}") {
        let (whole, first) = (line(&format!("{a}{b}"), 3.0), line(&a, 3.0));
        let double = line(&a, 6.0);
        prop_assert!((whole.advance - first.advance - line(&b, 3.0).advance).abs() < 1e-9);
        for (s, d) in first.strokes.iter().flatten().zip(double.strokes.iter().flatten()) {
            prop_assert!((*s * 2.0).distance(*d) < 1e-12);
        }
        prop_assert_eq!(&whole.strokes[..first.strokes.len()], &first.strokes[..]);
    }
}
