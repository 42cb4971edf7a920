//! Days and times, counted from 1970, as texts, after H. Hinnant, *chrono-Compatible Low-Level Date Algorithms*, 2021.

/// Days of 400 years.
const ERA: i64 = 146_097;

/// Returns the day of a text such as 2024-02-29; `None` if there is no such day.
pub fn of_text(text: &str) -> Option<i32> {
    let mut parts = text.splitn(3, '-').map(|part| part.parse::<i64>().ok());
    let (year, month, day) = (parts.next()??, parts.next()??, parts.next()??);
    if text.len() != 10 || !(1..=12).contains(&month) || !(1..=31).contains(&day) {
        return None;
    }
    let shifted = if month <= 2 { year - 1 } else { year };
    let (era, of_era) = (shifted.div_euclid(400), shifted.rem_euclid(400));
    let of_year = (153 * ((month + 9) % 12) + 2) / 5 + day - 1;
    let days = era * ERA + of_era * 365 + of_era / 4 - of_era / 100 + of_year - 719_468;
    (to_text(days) == text).then(|| i32::try_from(days).ok()).flatten()
}

/// Returns a day as text.
pub fn to_text(days: i64) -> String {
    let days = days.saturating_add(719_468);
    let (era, of_era) = (days.div_euclid(ERA), days.rem_euclid(ERA));
    let year = (of_era - of_era / 1460 + of_era / 36_524 - of_era / 146_096) / 365;
    let of_year = of_era - (365 * year + year / 4 - year / 100);
    let month = (5 * of_year + 2) / 153;
    let day = of_year - (153 * month + 2) / 5 + 1;
    let month = if month < 10 { month + 3 } else { month - 9 };
    let year = era * 400 + year + i64::from(month <= 2);
    format!("{year:04}-{month:02}-{day:02}")
}

/// Returns a time as text, given in this many parts of a second; with the day, in UTC, or without.
pub fn time(count: i64, parts: i64, has_day: bool, is_utc: bool) -> String {
    let (seconds, rest) = (count.div_euclid(parts), count.rem_euclid(parts));
    let (days, second) = (seconds.div_euclid(86_400), seconds.rem_euclid(86_400));
    let (hour, minute, second) = (second / 3600, second / 60 % 60, second % 60);
    let digits = parts.ilog10() as usize;
    let rest = if rest == 0 { String::new() } else { format!(".{rest:0digits$}") };
    let day = if has_day { format!("{}T", to_text(days)) } else { String::new() };
    let zone = if is_utc { "Z" } else { "" };
    format!("{day}{hour:02}:{minute:02}:{second:02}{rest}{zone}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn days_are_counted_and_shown() {
        for (text, days) in [
            ("1970-01-01", 0),
            ("2024-02-29", 19_782),
            ("1969-12-31", -1),
            ("0001-01-01", -719_162),
        ] {
            assert_eq!((of_text(text), to_text(days)), (Some(days as i32), text.to_owned()));
        }
        for text in ["2023-02-29", "2024-13-01", "2024-1-01", "24-01-001", "a", ""] {
            assert_eq!(of_text(text), None, "{text}");
        }
        assert_eq!(time(1_709_210_096_250, 1000, true, true), "2024-02-29T12:34:56.250Z");
        assert_eq!(time(-1, 1_000_000, true, false), "1969-12-31T23:59:59.999999");
        assert_eq!(time(3_661_000, 1000, false, false), "01:01:01");
        assert!(to_text(i64::MAX).len() > 10);
    }
}
