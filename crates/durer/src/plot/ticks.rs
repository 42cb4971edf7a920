//! Round numbers for an axis.
//!
//! P. Heckbert, *Nice Numbers for Graph Labels*, Graphics Gems, 1990: steps of 1, 2 or 5 times a power of
//! ten.

/// Numbers with more digits than this are written as differences from an offset.
const DIGITS: f64 = 1e6;

/// Returns the round number that a range far from zero is better counted from: 0 where its own numbers are short
/// enough to be distinguished.
///
/// ```
/// use durer::plot::ticks::offset;
/// assert_eq!(offset([1e9, 1e9 + 1.0]), 1e9);
/// assert_eq!(offset([-4.0, 4.0]), 0.0);
/// ```
pub fn offset([low, high]: [f64; 2]) -> f64 {
    let (extent, largest) = (high - low, low.abs().max(high.abs()));
    if !(extent > 0.0 && extent.is_finite() && largest > extent * DIGITS) {
        return 0.0;
    }
    let step = power(libm::ceil(libm::log10(extent)) as i32);
    let offset = (low / step).floor() * step;
    if offset.is_finite() { offset } else { 0.0 }
}

/// Returns the multiples of a round step in a range, about `wanted` of them, with their texts; all texts have
/// the same number of decimals.
///
/// ```
/// let texts: Vec<String> = durer::plot::ticks::ticks([-0.1, 1.04], 5).into_iter().map(|t| t.1).collect();
/// assert_eq!(texts, ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
/// ```
pub fn ticks([low, high]: [f64; 2], wanted: usize) -> Vec<(f64, String)> {
    let extent = high - low;
    if !(extent > 0.0 && extent.is_finite()) {
        return if low.is_finite() { vec![(low, short(low))] } else { Vec::new() };
    }
    let raw = extent / wanted.max(1) as f64;
    let mut exponent = libm::floor(libm::log10(raw)) as i32;
    let part = raw / power(exponent);
    let factor = match part {
        p if p < 1.5 => 1.0,
        p if p < 3.5 => 2.0,
        p if p < 7.5 => 5.0,
        _ => {
            exponent += 1;
            1.0
        }
    };
    let step = factor * power(exponent);
    let (first, last) = ((low / step - 1e-9).ceil(), (high / step + 1e-9).floor());
    // Ranges far from zero with hardly any digits left have no useful ticks.
    let few = last - first < 1000.0;
    if !few || first.abs().max(last.abs()) > 9e15 {
        return Vec::new();
    }
    let decimals = (-exponent).max(0) as usize;
    (first as i64..=last as i64)
        .map(|i| {
            // The quotient of two whole numbers is rounded once: 3 × 0.1 would be 0.30000000000000004.
            let value =
                if exponent < 0 { i as f64 * factor / power(-exponent) } else { i as f64 * step };
            (value, text(value, decimals))
        })
        .collect()
}

fn power(exponent: i32) -> f64 {
    libm::pow(10.0, f64::from(exponent))
}

/// Returns a number with as many digits as it needs, seven at most.
pub fn short(value: f64) -> String {
    if value != 0.0 && !(1e-4..1e7).contains(&value.abs()) {
        return text(value, 7);
    }
    let long = format!("{:.6}", value + 0.0);
    long.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// Returns a number with this many decimals, or with an exponent if that would be long.
fn text(value: f64, decimals: usize) -> String {
    let value = value + 0.0;
    if value == 0.0 && decimals > 6 {
        return "0".to_owned();
    }
    if value != 0.0 && (decimals > 6 || value.abs() >= 1e7) {
        let short = format!("{value:.6e}");
        let (mantissa, exponent) = short.split_once('e').unwrap_or((&short, "0"));
        return format!("{}e{exponent}", mantissa.trim_end_matches('0').trim_end_matches('.'));
    }
    format!("{value:.decimals$}")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(range: [f64; 2]) -> Vec<String> {
        ticks(range, 5).into_iter().map(|t| t.1).collect()
    }

    #[test]
    fn ticks_are_round() {
        assert_eq!(texts([-4.0, 4.0]), ["-4", "-2", "0", "2", "4"]);
        assert_eq!(texts([236.0, 1076.0]), ["400", "600", "800", "1000"]);
        assert_eq!(texts([0.0, 0.3]), ["0.00", "0.05", "0.10", "0.15", "0.20", "0.25", "0.30"]);
        assert_eq!(
            texts([-84.41, -84.08]),
            ["-84.40", "-84.35", "-84.30", "-84.25", "-84.20", "-84.15", "-84.10"]
        );
        assert_eq!(texts([0.0, 1e-9]), ["0", "2e-10", "4e-10", "6e-10", "8e-10", "1e-9"]);
        assert_eq!(texts([0.0, 4e9]), ["0", "1e9", "2e9", "3e9", "4e9"]);
    }

    #[test]
    fn ranges_far_from_zero_have_an_offset() {
        assert_eq!(offset([1e9, 1e9 + 1.0]), 1e9);
        assert_eq!(offset([1_234_567.25, 1_234_567.5]), 1_234_567.0);
        assert_eq!(offset([-1e9 - 1.0, -1e9]), -1e9 - 1.0);
        for near in [[0.0, 1e-9], [1e6, 1.1e6], [5.0, 5.0], [f64::NAN, 1.0]] {
            assert_eq!(offset(near), 0.0, "{near:?}");
        }
    }

    #[test]
    fn what_is_no_range_has_no_ticks_or_one() {
        assert_eq!(texts([2.5, 2.5]), ["2.5"]);
        assert_eq!(texts([-3e8, -3e8]), ["-3e8"]);
        assert!(texts([f64::NAN, 1.0]).is_empty());
        assert!(texts([f64::NEG_INFINITY, 1.0]).is_empty());
        assert!(texts([1e16, 1e16 + 4.0]).is_empty());
    }
}
