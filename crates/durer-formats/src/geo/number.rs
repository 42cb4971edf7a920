//! Coordinates as text: the shortest that reads back the same.

use std::io::{self, Write};

/// Writes a finite number; very large and very small ones with an exponent.
pub fn write(out: &mut impl Write, value: f64) -> io::Result<()> {
    let size = value.abs();
    if size == 0.0 || (1e-7..1e17).contains(&size) {
        write!(out, "{value}")
    } else {
        write!(out, "{value:e}")
    }
}

/// Returns the number in JSON; `null` if it is not finite.
pub fn json(value: f64) -> String {
    let mut text = Vec::new();
    let written = write(&mut text, value).is_ok() && value.is_finite();
    String::from_utf8(text).ok().filter(|_| written).unwrap_or_else(|| "null".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(value: f64) -> String {
        let mut out = Vec::new();
        write(&mut out, value).expect("memory");
        String::from_utf8(out).expect("digits")
    }

    #[test]
    fn numbers_are_short_and_read_back() {
        assert_eq!([5.0, -0.1, 1e-300, 1e22, 0.0].map(text), ["5", "-0.1", "1e-300", "1e22", "0"]);
        for value in [0.1 + 0.2, -f64::MAX, f64::MIN_POSITIVE, 5e-324, 123_456_789.123_456_78, -0.0]
        {
            assert_eq!(text(value).parse::<f64>().map(f64::to_bits), Ok(value.to_bits()));
        }
    }
}
