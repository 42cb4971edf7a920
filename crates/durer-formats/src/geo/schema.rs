//! Fields of a layer's features, and the kinds of their values.

use super::members::members;
use super::{Feature, Member};
use std::collections::BTreeMap;

/// Kind of a field's values.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum FieldKind {
    /// Null only.
    Null,
    /// `true` and `false`.
    Boolean,
    /// Whole numbers of 64 bits.
    Integer,
    /// Numbers.
    Number,
    /// Texts that are days, as 2024-12-31.
    Date,
    /// Texts, values of several kinds, and numbers that 64 bits do not hold: whole ones with more digits, and those
    /// beyond all of f64.
    Text,
    /// Objects and arrays.
    Json,
}

impl FieldKind {
    /// Returns its name in messages.
    pub fn name(self) -> &'static str {
        match self {
            Self::Null => "null",
            Self::Boolean => "boolean",
            Self::Integer => "integer",
            Self::Number => "number",
            Self::Date => "date",
            Self::Text => "text",
            Self::Json => "json",
        }
    }

    /// Returns the kind of a value in JSON.
    pub fn of(value: &str) -> Self {
        match value.as_bytes() {
            [b'"', ..] if is_day(value) => Self::Date,
            [b'"', ..] => Self::Text,
            [b'{' | b'[', ..] => Self::Json,
            [b't' | b'f', ..] => Self::Boolean,
            [b'n', ..] => Self::Null,
            _ if value.parse::<i64>().is_ok() => Self::Integer,
            _ if is_beyond(value) => Self::Text,
            _ => Self::Number,
        }
    }

    /// Returns the kind that holds values of both.
    pub fn join(self, other: Self) -> Self {
        match (self, other) {
            (a, b) if a == b => a,
            (Self::Null, kind) | (kind, Self::Null) => kind,
            (Self::Integer, Self::Number) | (Self::Number, Self::Integer) => Self::Number,
            _ => Self::Text,
        }
    }
}

/// Returns whether 64 bits do not hold a number of JSON: numbers of hashes and cells with all their digits.
fn is_beyond(value: &str) -> bool {
    let is_whole = value.bytes().all(|b| b.is_ascii_digit() || b == b'-');
    is_whole || value.parse::<f64>().is_ok_and(f64::is_infinite)
}

/// Returns whether a text of JSON is a day.
fn is_day(value: &str) -> bool {
    let shape =
        |(i, b): (usize, &u8)| if matches!(i, 5 | 8) { *b == b'-' } else { b.is_ascii_digit() };
    let bytes = value.as_bytes();
    bytes.len() == 12 && bytes.iter().enumerate().take(11).skip(1).all(shape)
}

/// A field of a layer.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Field {
    /// Its name.
    pub key: String,
    /// Common kind of its values.
    pub kind: FieldKind,
    /// Number of features with a value that is not null.
    pub filled: u64,
    /// The first few values that are not null and differ, in JSON.
    pub examples: Vec<String>,
}

/// Number of examples to keep.
const EXAMPLES: usize = 3;

/// The fields of a layer, in the order of their first appearance.
#[derive(Debug, Clone, Default)]
pub struct Schema {
    fields: Vec<Field>,
    places: BTreeMap<String, usize>,
}

impl Schema {
    /// Builds the schema of features.
    pub fn of(features: &[Feature]) -> Self {
        let mut schema = Self::default();
        features.iter().for_each(|feature| schema.add(feature));
        schema
    }

    /// Adds the properties of a feature.
    pub fn add(&mut self, feature: &Feature) {
        members(feature.properties.as_deref().unwrap_or_default())
            .iter()
            .for_each(|m| self.add_field(m));
    }

    fn add_field(&mut self, member: &Member) {
        let kind = FieldKind::of(&member.value);
        let key = member.key();
        let place = match self.places.get(&key) {
            Some(&place) => place,
            None => {
                let place = self.fields.len();
                self.places.insert(key.clone(), place);
                self.fields.push(Field { key, kind, filled: 0, examples: Vec::new() });
                place
            }
        };
        let Some(field) = self.fields.get_mut(place) else { return };
        field.kind = field.kind.join(kind);
        if kind != FieldKind::Null {
            field.filled += 1;
            if field.examples.len() < EXAMPLES && !field.examples.contains(&member.value) {
                field.examples.push(member.value.clone());
            }
        }
    }

    /// Returns all fields.
    pub fn columns(&self) -> &[Field] {
        &self.fields
    }

    /// Returns the place of a field by its name.
    pub fn find(&self, key: &str) -> Option<usize> {
        self.places.get(key).copied()
    }
}
