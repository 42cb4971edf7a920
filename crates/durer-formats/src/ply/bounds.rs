//! Limits of the numbers in a file: of vertices that rows name, and of the lengths of lists.

use super::body::Values;
use super::header::{Header, Type};
use super::names::Plan;
use crate::text::Tally;
use crate::wording::there_are;
use crate::{Error, Limits, Result};

/// Limits of vertex numbers and counts.
#[derive(Debug)]
pub(super) struct Bounds {
    pub limits: Limits,
    pub vertex_count: u64,
    /// Rows that name a vertex that does not exist.
    pub dangling: Tally,
    /// The first such number.
    dangling_vertex: f64,
}

impl Bounds {
    /// Creates the builder of a file, without faults so far.
    pub fn new(header: &Header, limits: Limits) -> Self {
        let vertex_count = header.element("vertex").map_or(0, |e| e.count);
        Self { limits, vertex_count, dangling: Tally::default(), dangling_vertex: 0.0 }
    }

    /// Returns the vertex that a value names, if there is one; others are counted.
    pub fn vertex(&mut self, value: f64, values: &impl Values) -> Option<u32> {
        if value >= 0.0 && value < self.vertex_count as f64 && value.fract() == 0.0 {
            return Some(value as u32);
        }
        if self.dangling.count == 0 {
            self.dangling_vertex = value;
        }
        self.dangling.add(|| values.place());
        None
    }

    /// Returns the message about the first number that names no vertex.
    pub fn dangling_message(&self) -> String {
        let (value, count) = (self.dangling_vertex, self.vertex_count);
        let there = there_are(count);
        let message = format!("vertex {value} does not exist: {there}, counted from 0");
        let swapped = u64::from((value as u32).swap_bytes()) < count;
        if swapped && (65536.0..=f64::from(u32::MAX)).contains(&value) {
            return message + "; it would if the header named the other byte order";
        }
        message
    }

    /// Refuses more triangles than allowed.
    ///
    /// # Errors
    /// [`Error::Limit`].
    pub fn check_triangles(&self, value: u64, values: &impl Values) -> Result<()> {
        let limit = self.limits.primitives;
        if value <= limit {
            return Ok(());
        }
        Err(Error::Limit { place: values.place(), what: "number of triangles", value, limit })
    }
}

/// Reads the length of a list.
///
/// # Errors
/// If a value is not a number.
pub(super) fn list_length(
    kind: Type,
    values: &mut impl Values,
    plan: &Plan,
    row: u64,
) -> Result<u64> {
    let length = values.next(kind)?;
    if length >= 0.0 && length.fract() == 0.0 && length <= f64::from(u32::MAX) {
        return Ok(length as u64);
    }
    let message =
        format!("`{length}` is not a length of a list, in row {row} of element `{}`", plan.name);
    Err(Error::Decode { place: values.place(), message })
}
