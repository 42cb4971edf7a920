//! Values of columns in JSON.

use super::days;
use crate::geo::members::quoted;
use crate::geo::number;
use parquet::basic::{ConvertedType, LogicalType, TimeUnit};
use parquet::data_type::Decimal;
use parquet::record::Field;
use parquet::schema::types::Type;

/// Meaning of a column's values beyond their stored type.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Meaning {
    /// No further meaning.
    Plain,
    /// Texts that are JSON.
    Json,
    /// Times with days, of this many parts of a second; in UTC, or as a clock shows them.
    Instant(i64, bool),
    /// Times without days, of this many parts of a second.
    Clock(i64),
}

impl Meaning {
    /// Returns the meaning of a column's values.
    pub fn of(column: &Type) -> Self {
        let parts = |unit: &TimeUnit| match unit {
            TimeUnit::MILLIS => 1000,
            TimeUnit::MICROS => 1_000_000,
            TimeUnit::NANOS => 1_000_000_000,
        };
        let about = column.get_basic_info();
        match about.logical_type_ref() {
            Some(LogicalType::Json) => Self::Json,
            Some(LogicalType::Timestamp(t)) => {
                Self::Instant(parts(&t.unit), t.is_adjusted_to_u_t_c)
            }
            Some(LogicalType::Time(t)) => Self::Clock(parts(&t.unit)),
            _ if about.converted_type() == ConvertedType::JSON => Self::Json,
            _ => Self::Plain,
        }
    }
}

/// Returns a value in JSON; `None` for binary values.
pub fn json(field: &Field, meaning: Meaning) -> Option<String> {
    Some(match (field, meaning) {
        (Field::Null, _) => "null".to_owned(),
        (Field::Bool(value), _) => value.to_string(),
        (Field::Byte(n), _) => n.to_string(),
        (Field::Short(n), _) => n.to_string(),
        (Field::Int(n) | Field::TimeMillis(n), Meaning::Clock(parts)) => {
            quoted(&days::time((*n).into(), parts, false, false))
        }
        (Field::Int(n), _) => n.to_string(),
        (
            Field::Long(n) | Field::TimestampMillis(n) | Field::TimestampMicros(n),
            Meaning::Instant(parts, is_utc),
        ) => quoted(&days::time(*n, parts, true, is_utc)),
        (Field::Long(n) | Field::TimeMicros(n), Meaning::Clock(parts)) => {
            quoted(&days::time(*n, parts, false, false))
        }
        (Field::Long(n), _) => n.to_string(),
        (Field::UByte(n), _) => n.to_string(),
        (Field::UShort(n), _) => n.to_string(),
        (Field::UInt(n), _) => n.to_string(),
        (Field::ULong(n), _) => n.to_string(),
        (Field::Float16(n), _) => number::json(n.to_f32().into()),
        // The shortest decimal that identifies it.
        (Field::Float(n), _) => number::json(n.to_string().parse().unwrap_or(f64::NAN)),
        (Field::Double(n), _) => number::json(*n),
        (Field::Decimal(n), _) => decimal(n),
        (Field::Str(text), Meaning::Json) if is_json(text) => text.trim().to_owned(),
        (Field::Str(text), _) => quoted(text),
        (Field::Bytes(_), _) => return None,
        (Field::Date(days), _) => quoted(&days::to_text((*days).into())),
        (Field::TimeMillis(n), _) => quoted(&days::time((*n).into(), 1000, false, false)),
        (Field::TimeMicros(n), _) => quoted(&days::time(*n, 1_000_000, false, false)),
        (Field::TimestampMillis(n), _) => quoted(&days::time(*n, 1000, true, true)),
        (Field::TimestampMicros(n), _) => quoted(&days::time(*n, 1_000_000, true, true)),
        (Field::Group(row), _) => {
            let member = |(key, value): (&String, &Field)| {
                Some(format!("{}:{}", quoted(key), json(value, Meaning::Plain)?))
            };
            let members: Vec<String> = row.get_column_iter().filter_map(member).collect();
            format!("{{{}}}", members.join(","))
        }
        (Field::ListInternal(list), _) => {
            let items = list.elements().iter().filter_map(|item| json(item, Meaning::Plain));
            format!("[{}]", items.collect::<Vec<_>>().join(","))
        }
        (Field::MapInternal(map), _) => {
            let entry = |(key, value): &(Field, Field)| {
                let key = json(key, Meaning::Plain)?;
                let key = if key.starts_with('"') { key } else { quoted(&key) };
                Some(format!("{key}:{}", json(value, Meaning::Plain)?))
            };
            let entries: Vec<String> = map.entries().iter().filter_map(entry).collect();
            format!("{{{}}}", entries.join(","))
        }
    })
}

fn is_json(text: &str) -> bool {
    serde_json::from_str::<serde::de::IgnoredAny>(text).is_ok()
}

/// Returns a number of up to 38 digits, all of them kept.
fn decimal(value: &Decimal) -> String {
    let (bytes, scale) = (value.data(), usize::try_from(value.scale()).unwrap_or(0));
    let sign = if bytes.first().is_some_and(|b| b & 0x80 != 0) { -1 } else { 0 };
    if bytes.len() > 16 || scale > 38 {
        return "null".to_owned();
    }
    let whole = bytes.iter().fold(sign, |n: i128, b| n << 8 | i128::from(*b));
    let digits = format!("{:0>width$}", whole.unsigned_abs(), width = scale + 1);
    let (before, after) = digits.split_at(digits.len() - scale);
    let (minus, point) = (if whole < 0 { "-" } else { "" }, if scale > 0 { "." } else { "" });
    format!("{minus}{before}{point}{after}")
}
