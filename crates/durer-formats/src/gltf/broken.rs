//! Parts that could not be read, and are left out if something else remains.

use crate::wording::counted;
use crate::{Error, Model, Place, Result};
use std::collections::BTreeMap;

/// Faults of primitives that could not be read.
#[derive(Default)]
pub struct Broken {
    /// Errors by their common cause, a missing or a broken file: the first error, the primitive it is of, and how many
    /// there are.
    kinds: BTreeMap<String, (Error, String, u64)>,
    /// The kind that came first.
    first: Option<String>,
}

impl Broken {
    /// Records an error; returns one that is not the primitive's own.
    pub fn take(&mut self, error: Error, at: String) -> Result<()> {
        let kind = match &error {
            Error::Resource { .. } => error.to_string(),
            Error::Decode { .. } => String::new(),
            _ => return Err(error),
        };
        self.first.get_or_insert_with(|| kind.clone());
        self.kinds.entry(kind).or_insert((error, at, 0)).2 += 1;
        Ok(())
    }

    /// Warns of omissions, and of missing buffers; if nothing is left to show, the first of them is an error.
    pub fn warn(mut self, missing: impl Iterator<Item = Error>, model: &mut Model) -> Result<()> {
        let unasked = missing.filter(|error| !self.kinds.contains_key(&error.to_string()));
        let mut unasked = unasked.collect::<Vec<_>>().into_iter();
        if model.scene.instances.is_empty() {
            let first = self.first.and_then(|kind| self.kinds.remove(&kind));
            if let Some(error) = first.map(|(error, ..)| error).or_else(|| unasked.next()) {
                return Err(error);
            }
        }
        for (error, at, count) in self.kinds.into_values() {
            let left_out = match count {
                1 => format!("{at} is left out"),
                _ => {
                    let more = counted(count - 1, "more primitive", "more primitives");
                    format!("{at} and {more} are left out")
                }
            };
            warn(error, &left_out, model);
        }
        unasked.for_each(|error| warn(error, "nothing that is shown needs it", model));
        Ok(())
    }
}

/// Warns of an error and its consequence.
fn warn(error: Error, then: &str, model: &mut Model) {
    let (place, what) = apart(error);
    model.warn(place, format!("{what}; {then}"));
}

/// Returns the place of an error, and its message without the place.
pub fn apart(error: Error) -> (Place, String) {
    match error {
        Error::Resource { place, uri, message } => {
            (place, format!("cannot read `{uri}`: {message}"))
        }
        Error::Decode { place, message } => (place, message),
        other => (Place::Whole, other.to_string()),
    }
}
