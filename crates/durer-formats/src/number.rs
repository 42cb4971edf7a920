//! Decimal numbers in text, as the formats' writers spell them: read from bytes, correctly rounded.

/// Powers of ten that are exact in double precision.
const POWERS: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16,
    1e17, 1e18, 1e19, 1e20, 1e21, 1e22,
];

/// More digits than these may not fit 64 bits.
const MAX_DIGITS: usize = 19;

/// Returns the longest number at the start of `text` and its length in bytes, as C's `strtod` takes
/// it.
///
/// Knows `.5`, `1.`, `+1`, `1e-3`, `nan`, `inf`, `infinity` (any case, signed) and the `1.#IND`,
/// `1.#INF` that old Microsoft libraries wrote.
///
/// The fast path is exact by W. D. Clinger, *How to Read Floating Point Numbers Accurately*, 1990:
/// one operation on two exact doubles rounds once. Longer numbers are parsed by the standard library.
pub(crate) fn float(text: &[u8]) -> Option<(f64, usize)> {
    let negative = text.first() == Some(&b'-');
    let signed = usize::from(negative || text.first() == Some(&b'+'));
    let (mut mantissa, mut digits, mut exponent, mut at) = (0u64, 0, 0i32, signed);
    let mut fraction = false;
    while let Some(&byte) = text.get(at) {
        if byte.is_ascii_digit() {
            mantissa = mantissa.wrapping_mul(10).wrapping_add(u64::from(byte - b'0'));
            digits += usize::from(digits > 0 || byte != b'0');
            exponent = exponent.saturating_sub(i32::from(fraction));
        } else if byte == b'.' && !fraction {
            fraction = true;
        } else {
            break;
        }
        at += 1;
    }
    if at == signed + usize::from(fraction) {
        return word(text.get(signed..)?, negative).map(|(value, n)| (value, n + signed));
    }
    if text.get(at) == Some(&b'#') {
        return microsoft(text.get(at..)?, negative).map(|(value, n)| (value, at + n));
    }
    let (scale, length) = exponent_part(text.get(at..).unwrap_or_default());
    at += length;
    let power = exponent.saturating_add(scale);
    if digits <= MAX_DIGITS && mantissa <= 1 << 53 {
        let m = if negative { -(mantissa as f64) } else { mantissa as f64 };
        match (power, POWERS.get(power.unsigned_abs() as usize)) {
            (0.., Some(p)) => return Some((m * p, at)),
            (_, Some(p)) => return Some((m / p, at)),
            _ => {}
        }
    }
    let text = std::str::from_utf8(text.get(..at)?).ok()?;
    text.parse().ok().map(|value| (value, at))
}

/// Returns value and length of `e±digits` at the start of `text`; zeros where no digit follows.
fn exponent_part(text: &[u8]) -> (i32, usize) {
    if !matches!(text.first(), Some(b'e' | b'E')) {
        return (0, 0);
    }
    let negative = text.get(1) == Some(&b'-');
    let start = 1 + usize::from(negative || text.get(1) == Some(&b'+'));
    let mut value = 0i32;
    let mut at = start;
    while let Some(digit) = text.get(at).filter(|b| b.is_ascii_digit()) {
        value = value.saturating_mul(10).saturating_add(i32::from(digit - b'0'));
        at += 1;
    }
    if at == start { (0, 0) } else { (if negative { -value } else { value }, at) }
}

/// Returns value and length of `nan`, `inf` or `infinity` at the start of `text`.
fn word(text: &[u8], negative: bool) -> Option<(f64, usize)> {
    let starts = |w: &[u8]| text.get(..w.len()).is_some_and(|t| t.eq_ignore_ascii_case(w));
    let infinity = if negative { f64::NEG_INFINITY } else { f64::INFINITY };
    let length = if starts(b"infinity") {
        8
    } else if starts(b"inf") || starts(b"nan") {
        3
    } else {
        return None;
    };
    Some((if starts(b"nan") { f64::NAN } else { infinity }, length))
}

/// Returns value and length of `#IND`, `#QNAN`, `#SNAN` or `#INF` with the zeros that may follow, after the `1.`
/// before it.
fn microsoft(text: &[u8], negative: bool) -> Option<(f64, usize)> {
    let length = text.iter().position(|b| b.is_ascii_whitespace()).unwrap_or(text.len());
    let infinite = text.get(1..4).is_some_and(|t| t.eq_ignore_ascii_case(b"INF"));
    let infinity = if negative { f64::NEG_INFINITY } else { f64::INFINITY };
    Some((if infinite { infinity } else { f64::NAN }, length))
}

/// Returns the decimal integer at the start of `text` and its length; saturates beyond 64 bits.
pub(crate) fn integer(text: &[u8]) -> Option<(i64, usize)> {
    let negative = text.first() == Some(&b'-');
    let start = usize::from(negative || text.first() == Some(&b'+'));
    let (mut value, mut at) = (0i64, start);
    while let Some(digit) = text.get(at).filter(|b| b.is_ascii_digit()) {
        value = value.saturating_mul(10).saturating_add(i64::from(digit - b'0'));
        at += 1;
    }
    (at > start).then_some((if negative { -value } else { value }, at))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn odd_spellings_are_understood() {
        let good: [(&str, f64, usize); 14] = [
            ("1", 1.0, 1),
            (".5", 0.5, 2),
            ("1.", 1.0, 2),
            ("+1.5e+2x", 150.0, 7),
            ("-2.e1 ", -20.0, 5),
            ("3.1+e2", 3.1, 3),
            ("1e", 1.0, 1),
            ("0.1", 0.1, 3),
            ("1e400", f64::INFINITY, 5),
            ("-inf", f64::NEG_INFINITY, 4),
            ("Infinity/", f64::INFINITY, 8),
            ("1.#INF", f64::INFINITY, 6),
            ("-1.#INF000 2", f64::NEG_INFINITY, 10),
            ("0.00000000000000000000000000000000000000001", 1e-41, 43),
        ];
        for (text, value, length) in good {
            assert_eq!(float(text.as_bytes()), Some((value, length)), "{text}");
        }
        for text in ["nan", "-NaN", "1.#IND", "-1.#QNAN0"] {
            let (value, length) = float(text.as_bytes()).expect(text);
            assert!(value.is_nan() && length == text.len(), "{text}");
        }
        for text in ["", "-", ".", "x1", "+e2", "e5", "in"] {
            assert_eq!(float(text.as_bytes()), None, "{text}");
        }
    }

    #[test]
    fn integers_saturate() {
        assert_eq!(integer(b"-12/3"), Some((-12, 3)));
        assert_eq!(integer(b"99999999999999999999"), Some((i64::MAX, 20)));
        assert_eq!(integer(b"-"), None);
    }

    proptest! {
        #[test]
        fn floats_are_read_as_the_standard_library_reads_them(
            value in any::<f64>().prop_filter("finite", |v| v.is_finite()),
            places in 0usize..20,
            small in -1e6..1e6f64,
        ) {
            for text in [format!("{value}"), format!("{value:e}"), format!("{small:.places$}")] {
                let expected: f64 = text.parse().expect("written by the standard library");
                prop_assert_eq!(float(text.as_bytes()), Some((expected, text.len())), "{}", text);
            }
        }
    }
}
