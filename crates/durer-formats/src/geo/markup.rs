//! Parts that the formats in XML share: the root of a document, by which its format is detected, and positions.

use super::{Dimensions, Points};
use crate::Place;
use crate::text::Tally;
use durer::math::DVec2;

/// Number of bytes of a document that are searched for its root.
const PROBE: usize = 16 << 10;

/// Adds a position to a line; counts those that have a height where others have none, or lack one that others have,
/// which is 0 then.
pub fn push(
    points: &mut Points,
    place: DVec2,
    height: Option<f64>,
    (mixed, at): (&mut Tally, impl FnOnce() -> Place),
) {
    let dimensions = Dimensions::new(height.is_some(), false);
    if points.is_empty() {
        points.dimensions = dimensions;
    } else if points.dimensions != dimensions {
        points.lift(dimensions);
        mixed.add(at);
    }
    points.push(place, [height.unwrap_or(0.0), 0.0]);
}

/// Words of a warning about positions counted by [`push`].
pub const MIXED: [&str; 2] = [
    "position has a height where others of its line have none, or none where they have one; missing heights are 0",
    "positions have a height where others of their line have none, or none where they have one; missing heights are 0",
];

/// Returns the local name of a document's root, if it is near the beginning.
pub fn root(bytes: &[u8]) -> Option<&str> {
    let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes).trim_ascii_start();
    let text = text.get(..PROBE).unwrap_or(text);
    if text.first() != Some(&b'<') {
        return None;
    }
    let mut at = 0;
    loop {
        let rest = text.get(at..)?;
        let open = rest.iter().position(|&b| b == b'<')?;
        let rest = rest.get(open + 1..)?;
        at += open + 1;
        let end = |mark: &[u8]| rest.windows(mark.len()).position(|w| w == mark);
        at += match rest.first()? {
            b'?' => end(b"?>")?,
            b'!' if rest.starts_with(b"!--") => end(b"-->")?,
            b'!' => end(b">")?,
            _ => return name(rest),
        };
    }
}

fn name(tag: &[u8]) -> Option<&str> {
    let length = tag.iter().take_while(|b| !b.is_ascii_whitespace() && !b"/>".contains(b)).count();
    let name = std::str::from_utf8(tag.get(..length)?).ok()?;
    Some(name.rsplit_once(':').map_or(name, |(_, local)| local))
}
