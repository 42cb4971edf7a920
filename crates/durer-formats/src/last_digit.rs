//! The number of digits of a text file's coordinates.

/// Number of lines examined; the first lines are taken as representative.
const LINES: usize = 4096;

/// Returns the value of one unit of the last digit of the numbers in lines that begin with the word `key` or, if that
/// is empty, of the first three words of all lines. Of numbers with exponents, which all have the same number of
/// digits, the largest counts; of other numbers the one with most decimals, because trailing zeros may be left out. 0
/// if there are no decimals: whole numbers are taken as exact.
pub(crate) fn last_digit(text: &[u8], key: &[u8]) -> f64 {
    let (mut fixed, mut largest, mut decimals) = (0, None::<i32>, 0);
    let mut seen = 0;
    for line in text.split(|b| matches!(b, b'\n' | b'\r')) {
        let mut words = line.split(u8::is_ascii_whitespace).filter(|w| !w.is_empty());
        if !key.is_empty() && words.next() != Some(key) {
            continue;
        }
        for digit in words.take(3).filter_map(Digit::of) {
            match digit {
                Digit::Fixed(behind) => fixed = fixed.max(behind),
                Digit::Exponent(power, behind) => {
                    largest = largest.max(Some(power));
                    decimals = decimals.max(behind);
                }
            }
        }
        seen += 1;
        if seen == LINES {
            break;
        }
    }
    match largest {
        _ if fixed > 0 => power_of_ten(-fixed),
        Some(power) => power_of_ten(power - decimals),
        None => 0.0,
    }
}

/// Reads it, which rounds alike everywhere.
fn power_of_ten(power: i32) -> f64 {
    format!("1e{power}").parse().unwrap_or(0.0)
}

/// The place of a number's last digit.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Digit {
    /// Behind this many decimals.
    Fixed(i32),
    /// Behind this many decimals of a number with this power of ten.
    Exponent(i32, i32),
}

impl Digit {
    /// Returns the place of a number's last digit; `None` for a word that is not a number.
    fn of(word: &[u8]) -> Option<Self> {
        let (mantissa, exponent) = match word.iter().position(|b| matches!(b, b'e' | b'E')) {
            Some(at) => (&word[..at], Some(&word[at + 1..])),
            None => (word, None),
        };
        let mantissa = mantissa.strip_prefix(b"-").unwrap_or(mantissa);
        let is_point = |b: &u8| matches!(b, b'.' | b',');
        let point = mantissa.iter().position(is_point).unwrap_or(mantissa.len());
        let decimals = mantissa.get(point + 1..).unwrap_or_default();
        let digits = |s: &[u8]| s.iter().all(u8::is_ascii_digit);
        if mantissa.is_empty() || !digits(&mantissa[..point]) || !digits(decimals) {
            return None;
        }
        let decimals = decimals.len().min(400) as i32;
        let Some(exponent) = exponent else { return Some(Self::Fixed(decimals)) };
        let exponent: i32 = std::str::from_utf8(exponent).ok()?.parse().ok()?;
        // The power of a zero has no meaning.
        let is_zero = mantissa.iter().all(|b| matches!(b, b'0' | b'.' | b','));
        let power = if is_zero { -400 } else { exponent.clamp(-400, 400) };
        Some(Self::Exponent(power, decimals))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn last_digits_are_those_of_coordinates() {
        let of = |text: &str, key: &str| last_digit(text.as_bytes(), key.as_bytes());
        let close = |a: f64, b: f64| (a - b).abs() <= b * 1e-12;
        assert!(close(of("vn 0.12345 1 0\nv 40 0 0.5\r\nv -1.125 2 3 0.123456\n", "v"), 1e-3));
        assert!(close(of(" vertex 4.000000e+01 1.5e-7 0.0e+00\n", "vertex"), 1e-5));
        assert!(close(of("1.25 0 3 0.123456 9\n3 0 1 2\n", ""), 1e-2));
        assert!(close(of("v 1,5 0,125 3\n", "v"), 1e-3));
        assert_eq!(of("v 1 2 3\nv nan . 1e999999999999\n", "v"), 0.0);
        assert_eq!(of("", ""), 0.0);
    }
}
