//! Texts in words of a format, for bytes alone hardly ever make a file.

use arbitrary::{Result, Unstructured};

/// Returns a text of words of a format, with numbers, and with bytes between where the input says
/// so.
pub fn text(bytes: &[u8], words: &[&str]) -> Result<Vec<u8>> {
    let mut u = Unstructured::new(bytes);
    let mut text = Vec::new();
    while !u.is_empty() {
        match u.arbitrary::<u8>()? {
            0 => text.push(u.arbitrary()?),
            1 => text.extend(u.arbitrary::<i16>()?.to_string().bytes()),
            2 => text.extend(f64::from_bits(u.arbitrary()?).to_string().bytes()),
            word => text.extend(words[usize::from(word) % words.len()].bytes()),
        }
    }
    Ok(text)
}
