//! Sources: arrays of numbers, taken in tuples.

use super::document::Document;
use crate::Result;
use crate::budget::Budget;
use crate::piece::{SETS, Values};
use crate::text::Tally;
use std::collections::HashMap;
use std::rc::Rc;

/// Numbers in tuples.
#[derive(Debug)]
pub(super) struct Source {
    values: Vec<f64>,
    offset: usize,
    stride: usize,
    count: usize,
    /// Positions of the components among a tuple's values.
    components: Vec<usize>,
}

impl Source {
    /// Returns the components of a tuple, with `fill` for missing ones; `None` beyond the end.
    pub fn get<const N: usize>(&self, index: u32, fill: f64) -> Option<[f64; N]> {
        let first = self.stride.checked_mul(index as usize)?.checked_add(self.offset)?;
        let values = self.values.get(first..)?;
        if index as usize >= self.count || values.is_empty() {
            return None;
        }
        Some(std::array::from_fn(|i| {
            let at = self.components.get(i);
            at.and_then(|&at| values.get(at)).copied().unwrap_or(fill)
        }))
    }
}

/// The source of each of a corner's indices.
pub(super) type Slots = [Option<usize>; 3 + SETS];

/// Sources that have been read, by their elements.
pub(super) type Sources = HashMap<usize, Option<Rc<Source>>>;

/// Data that the slots of corners refer to.
pub(super) struct Slotted<'s>(pub &'s Sources, pub Slots);

impl Slotted<'_> {
    fn source(&self, slot: usize) -> Option<&Source> {
        let number = self.1.get(slot).copied().flatten()?;
        self.0.get(&number)?.as_deref()
    }
}

impl Values for Slotted<'_> {
    fn has(&self, slot: usize) -> bool {
        self.source(slot).is_some()
    }

    fn get(&self, slot: usize, index: u32, fill: f64) -> Option<[f64; 4]> {
        self.source(slot)?.get(index, fill)
    }
}

/// Reads a source; `None` if it has no numbers.
///
/// # Errors
/// [`crate::Error::Limit`].
pub(super) fn read(
    document: &Document<'_>,
    element: usize,
    budget: &mut Budget,
    broken: &mut Tally,
) -> Result<Option<Source>> {
    let accessor = document.find(element, &["technique_common", "accessor"]);
    let named = accessor.and_then(|a| document.refers(a, "source"));
    let is_array = |&n: &usize| matches!(document.name(n), "float_array" | "int_array");
    let array = named.filter(is_array).or_else(|| document.children(element).find(is_array));
    let Some(array) = array else { return Ok(None) };
    let mut values = Vec::new();
    for value in document.floats(array) {
        let place = || document.place(array);
        let number = value.filter(|v| v.is_finite());
        if number.is_none() {
            broken.add(place);
        }
        values.push(number.unwrap_or(0.0));
    }
    budget.bytes(8 * values.len() as u64, || document.place(array))?;
    let params = accessor.into_iter().flat_map(|a| document.named(a, "param"));
    let named: Vec<bool> = params.map(|p| document.attribute(p, "name").is_some()).collect();
    let whole = |key| accessor.and_then(|a| document.whole(a, key));
    let limit = |n: u64| n.min(1 << 32) as usize;
    let stride = whole("stride").map_or(named.len(), limit).max(1);
    // Components without a name are ignored; where none has one, all are meant.
    let components: Vec<usize> = (0..named.len()).filter(|&i| named[i]).collect();
    let components = if components.is_empty() { (0..stride.min(4)).collect() } else { components };
    let count = whole("count").map_or(usize::MAX, limit);
    let offset = whole("offset").map_or(0, limit);
    Ok(Some(Source { values, offset, stride, count, components }))
}
