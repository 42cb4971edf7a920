//! Numbers and names of features in the places of messages.

use super::{Feature, Member, Warnings};
use crate::text::Tally;
use crate::{Place, Result};

/// Fields that name a feature, in small letters.
const NAMES: [&str; 3] = ["name", "title", "label"];

/// The number of a feature and its name, for messages.
#[derive(Debug, Clone, Default)]
pub struct Label {
    /// Number in the file, from 1.
    pub number: u64,
    /// The id or name with its key, e.g. `id 7`; empty without one.
    pub name: String,
}

impl Label {
    /// Creates the label of a feature whose name is not known.
    pub fn bare(number: u64) -> Self {
        Self { number, name: String::new() }
    }

    /// Creates the label of a feature that has been read.
    pub fn of(number: u64, feature: &Feature) -> Self {
        Self { number, name: name(feature.id.as_deref(), || feature.fields()) }
    }
}

/// Returns the id or the name of a feature with its key; empty without one.
pub fn name(id: Option<&str>, fields: impl FnOnce() -> Vec<Member>) -> String {
    let text = |value: &str| match serde_json::from_str(value) {
        Ok(serde_json::Value::String(text)) if !text.trim().is_empty() => Some(text),
        Ok(serde_json::Value::Number(_)) => Some(value.to_owned()),
        _ => None,
    };
    let id = id.and_then(text).map(|id| ("id".to_owned(), id));
    let (key, value) = match id {
        Some(found) => found,
        None => {
            let fields: Vec<(String, String)> = fields()
                .into_iter()
                .filter_map(|field| Some((field.key(), text(&field.value)?)))
                .collect();
            let of = |name: &&str| fields.iter().find(|(key, _)| key.eq_ignore_ascii_case(name));
            let Some((key, value)) = NAMES.iter().find_map(of) else { return String::new() };
            (key.clone(), value.clone())
        }
    };
    format!("{key} {}", crate::text::quote(value.as_bytes()))
}

impl Place {
    /// Returns the place with the feature that it is in, unless it has one.
    pub(super) fn in_feature(self, label: &Label) -> Self {
        if matches!(self, Self::Feature { .. }) {
            return self;
        }
        Self::Feature { number: label.number, name: label.name.clone(), at: Box::new(self) }
    }
}

impl Tally {
    /// Adds the feature to the place of the first fault, unless it has one.
    pub(super) fn label(&mut self, label: impl FnOnce() -> Label) {
        if self.count > 0 && !matches!(self.first, Place::Feature { .. }) {
            self.first = std::mem::take(&mut self.first).in_feature(&label());
        }
    }
}

impl Warnings {
    /// Adds the feature that has just been read to the places of its faults: the warnings from the index `from` on, and
    /// the first of those that are counted.
    pub fn label(&mut self, from: usize, label: impl Fn() -> Label) {
        let new = self.kept.get_mut(from..).unwrap_or_default();
        if !new.is_empty() {
            let label = label();
            for warning in new {
                warning.place = std::mem::take(&mut warning.place).in_feature(&label);
            }
        }
        for tally in [&mut self.curves, &mut self.members, &mut self.nan] {
            tally.label(&label);
        }
    }

    /// Adds a feature to the places of its faults, or of the error because of which it cannot be read; `broken` is its
    /// label in this case.
    pub fn labelled(
        &mut self,
        read: Result<Option<Feature>>,
        broken: Label,
        from: usize,
    ) -> Result<Option<Feature>> {
        match &read {
            Ok(Some(feature)) => self.label(from, || Label::of(broken.number, feature)),
            Ok(None) => {}
            Err(_) => self.label(from, || broken.clone()),
        }
        read.map_err(|error| error.in_feature(&broken))
    }
}

impl crate::Error {
    /// Returns an error of the data with the feature that it is in.
    pub(super) fn in_feature(self, label: &Label) -> Self {
        self.at(|place| place.in_feature(label))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn features_are_named_by_id_or_else_by_name() {
        let of =
            |id: Option<&str>, fields: &str| name(id, || super::super::members::members(fields));
        let named = r#"{"a":1,"title":"T","NAME":"Bayern"}"#;
        assert_eq!(of(Some("7"), named), "id 7");
        assert_eq!(of(Some(r#""x\"1""#), named), "id x\"1");
        assert_eq!(of(Some("null"), named), "NAME Bayern");
        assert_eq!(of(None, r#"{"name":null,"label":12}"#), "label 12");
        assert_eq!(of(None, r#"{"name":" ","a":{"name":"b"}}"#), "");
    }

    #[test]
    fn places_get_their_feature_once() {
        let label = Label { number: 3, name: "id 7".to_owned() };
        let shown = |place: Place| place.in_feature(&label).to_string();
        assert_eq!(shown(Place::Line(2, 5)), "line 2, column 5, feature 3 (id 7): ");
        assert_eq!(shown(Place::Byte(12)), "byte 12, feature 3 (id 7): ");
        assert_eq!(shown(Place::Whole), "feature 3 (id 7): ");
        let bare = Place::Line(2, 0).in_feature(&Label::bare(4));
        assert_eq!(bare.to_string(), "line 2, feature 4: ");
        assert_eq!(shown(bare.clone()), bare.to_string());
        let mut tally = Tally::default();
        tally.label(|| label.clone());
        assert_eq!(tally.first, Place::Whole, "nothing was counted");
    }
}
