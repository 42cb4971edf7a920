//! Paint of PrusaSlicer, Bambu Studio and similar programs: triangles divided by a code, with a filament for each
//! piece.
//!
//! The code is a tree in hexadecimal digits, read from its end, root first. The low two bits of a digit are the number
//! of divided sides. With none it is a piece, whose filament is in the high two bits; 3 there means 3 plus the next
//! digit, and each digit 15 adds 15 and continues. Otherwise the high bits name the corner to count from, and the
//! children follow, the last one first: with one divided side, the side opposite the corner is halved; with two, the
//! sides at the corner; with three, all. Filament 0 is no paint.

use durer::math::DVec3;

/// The corners of a piece.
type Corners = [DVec3; 3];

/// Divides a triangle by its code; `piece` receives each piece with its filament. Returns whether the code had exactly
/// the needed digits; pieces without digits get no paint.
pub(super) fn divide(code: &str, corners: Corners, mut piece: impl FnMut(Corners, u32)) -> bool {
    let mut digits = Digits(code.as_bytes());
    let mut stack = vec![corners];
    let mut whole = true;
    while let Some(corners) = stack.pop() {
        let Some(digit) = digits.next().filter(|_| whole) else {
            whole = false;
            piece(corners, 0);
            continue;
        };
        match (digit & 3, digit >> 2) {
            (0, 3) => match digits.large() {
                Some(filament) => piece(corners, filament),
                None => {
                    whole = false;
                    piece(corners, 0);
                }
            },
            (0, filament) => piece(corners, filament),
            (sides, corner) => children(sides, turned(corners, corner), &mut stack),
        }
    }
    whole && digits.0.is_empty()
}

/// The digits that are left; the next is the last.
struct Digits<'a>(&'a [u8]);

impl Digits<'_> {
    /// Reads the next digit; `None` at the end and for other characters.
    fn next(&mut self) -> Option<u32> {
        let (&last, rest) = self.0.split_last()?;
        self.0 = rest;
        char::from(last).to_digit(16)
    }

    /// Reads the number of a filament from 3 on.
    fn large(&mut self) -> Option<u32> {
        let mut filament = 3u32;
        loop {
            let digit = self.next()?;
            filament = filament.saturating_add(digit);
            if digit < 15 {
                return Some(filament);
            }
        }
    }
}

/// Returns corners counted from another one.
fn turned([a, b, c]: Corners, first: u32) -> Corners {
    match first % 3 {
        0 => [a, b, c],
        1 => [b, c, a],
        _ => [c, a, b],
    }
}

/// Adds the children of a triangle with `sides` divided sides, the first one first.
fn children(sides: u32, [a, b, c]: Corners, stack: &mut Vec<Corners>) {
    let middle = |p: DVec3, q: DVec3| (p + q) * 0.5;
    match sides {
        1 => {
            let m = middle(b, c);
            stack.extend([[a, b, m], [m, c, a]]);
        }
        2 => {
            let (ab, ca) = (middle(a, b), middle(c, a));
            stack.extend([[a, ab, ca], [ab, b, ca], [b, c, ca]]);
        }
        _ => {
            let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
            stack.extend([[a, ab, ca], [ab, b, bc], [bc, c, ca], [ab, bc, ca]]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TRIANGLE: Corners = [DVec3::ZERO, DVec3::X, DVec3::Y];

    fn pieces(code: &str) -> (Vec<(Corners, u32)>, bool) {
        let mut pieces = Vec::new();
        let whole = divide(code, TRIANGLE, |corners, filament| pieces.push((corners, filament)));
        (pieces, whole)
    }

    fn area([a, b, c]: &Corners) -> f64 {
        (*b - *a).cross(*c - *a).length() / 2.0
    }

    #[test]
    fn whole_triangles() {
        for (code, filament) in [
            ("0", 0),
            ("4", 1),
            ("8", 2),
            ("0C", 3),
            ("8C", 11),
            ("dC", 16),
            ("0FC", 18),
            ("2FFC", 35),
        ] {
            assert_eq!(pieces(code), (vec![(TRIANGLE, filament)], true), "{code}");
        }
    }

    #[test]
    fn divided_triangles() {
        // Three sides: the root comes last, before it its last child, the middle one.
        let (four, whole) = pieces("48403");
        assert!(whole);
        assert_eq!(four.iter().map(|p| p.1).collect::<Vec<_>>(), [0, 1, 2, 1]);
        let half = |p: DVec3, q: DVec3| (p + q) * 0.5;
        let [a, b, c] = TRIANGLE;
        assert_eq!(four[0].0, [half(a, b), half(b, c), half(c, a)]);
        assert_eq!(four[3].0, [a, half(a, b), half(c, a)]);
        // One side, opposite to corner 1.
        let (two, _) = pieces("485");
        assert_eq!(two, [([half(c, a), a, b], 2), ([b, c, half(c, a)], 1)]);
        // Two sides, those at corner 2; one child is subdivided again.
        let (five, whole) = pieces("4480348A");
        assert!(whole && five.len() == 6, "{five:?}");
        for pieces in [four, two, five] {
            let sum: f64 = pieces.iter().map(|p| area(&p.0)).sum();
            assert!((sum - 0.5).abs() < 1e-15 && pieces.iter().all(|p| area(&p.0) > 0.0));
        }
    }

    #[test]
    fn broken_codes_leave_no_holes() {
        for code in ["", "C", "3", "43", "x", "4x43", "F", "FFFFC", "44"] {
            let (pieces, whole) = pieces(code);
            let sum: f64 = pieces.iter().map(|p| area(&p.0)).sum();
            assert!(!whole && (sum - 0.5).abs() < 1e-15, "{code}");
        }
    }
}
