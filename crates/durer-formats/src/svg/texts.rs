//! Texts that are too long to be laid out in one piece.
//!
//! usvg counts the letters of a piece of text from its beginning for each letter. A piece continues until an element
//! gives a position by `x` or `y`.

use super::ROOT;
use crate::{Error, Result};
use usvg::roxmltree::{Document, Node};

/// The sum of the squares of the letters of all pieces: 63,000 letters in one piece, or 63 times 8000 in as many; some
/// seconds.
const MOST: u64 = 4_000_000_000;

/// Refuses drawings whose texts would take too long.
///
/// # Errors
/// [`Error::Decode`] with the place of the text from where on it is too much.
pub(super) fn check(document: &Document<'_>) -> Result<()> {
    let (mut cost, mut end) = (0u64, 0);
    let mut piece = Piece::default();
    let mut text = document.root_element();
    for node in document.descendants() {
        let is_inside = node.range().start < end;
        if !is_inside && node.has_tag_name((ROOT.0, "text")) {
            cost = cost.saturating_add(std::mem::take(&mut piece).cost());
            (text, end) = (node, node.range().end);
        } else if !is_inside {
            continue;
        }
        if node.is_element() && ["x", "y"].iter().any(|name| node.has_attribute(*name)) {
            cost = cost.saturating_add(piece.cost());
            piece = Piece { letters: 0, placed: placed(node) };
        }
        if let Some(letters) = node.text().filter(|_| node.is_text()) {
            piece.letters += letters.chars().count() as u64;
        }
        if cost.saturating_add(piece.cost()) > MOST {
            return Err(too_long(document, text));
        }
    }
    Ok(())
}

/// Letters that are laid out together.
#[derive(Default)]
struct Piece {
    letters: u64,
    /// Number of letters at its beginning that have a position each.
    placed: u64,
}

impl Piece {
    fn cost(&self) -> u64 {
        self.letters.saturating_sub(self.placed).saturating_pow(2)
    }
}

/// Returns the number of letters whose places an element states.
fn placed(node: Node<'_, '_>) -> u64 {
    let listed = |name| {
        let values = node.attribute(name).unwrap_or_default();
        values
            .split(|c: char| c == ',' || c.is_ascii_whitespace())
            .filter(|v| !v.is_empty())
            .count()
    };
    listed("x").max(listed("y")) as u64
}

fn too_long(document: &Document<'_>, text: Node<'_, '_>) -> Error {
    let at = document.text_pos_at(text.range().start);
    let message = "the texts are too long to be laid out, with this one; \
                   lines need `text` or `tspan` elements of their own, with `x` and `y`";
    Error::line(at.row.into(), at.col.into(), message)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn is_read(content: &str) -> std::result::Result<(), String> {
        let text = format!("<svg xmlns='http://www.w3.org/2000/svg'>{content}</svg>");
        check(&Document::parse(&text).unwrap()).map_err(|error| error.to_string())
    }

    #[test]
    fn texts_are_too_long_in_one_piece_only() {
        let long = "abcdefgh".repeat(5000);
        let text = |inside: &str| format!("<text y='9'>{inside}</text>");
        assert_eq!(is_read(&text(&long)), Ok(()));
        assert_eq!(is_read(&text(&long).repeat(2)), Ok(()));
        let error = is_read(&format!("\n {}", text(&long).repeat(3))).unwrap_err();
        assert!(error.starts_with("line 2, column 80040: the texts are too long"), "{error}");
        let spans = |says: &str| format!("<tspan {says}>{long}</tspan>").repeat(2);
        assert!(is_read(&text(&spans(""))).is_err());
        assert_eq!(is_read(&text(&spans("x='0'"))), Ok(()));
        let places = "1 2,3 ".repeat(long.len() / 3);
        assert_eq!(is_read(&text(&format!("<tspan x='{places}'>{long}</tspan>{long}"))), Ok(()));
        // Other elements than text contain letters too.
        assert_eq!(is_read(&format!("<desc>{}</desc>{}", long.repeat(9), text("a"))), Ok(()));
    }
}
