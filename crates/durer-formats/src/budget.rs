//! The quantities that readers count against [`Limits`] while they make meshes.

use crate::{Error, Limits, Place, Result};

/// Stage of a model's meshes in errors about memory.
pub(crate) const MODEL: &str = "meshes of the model";

/// Stage of pictures in errors about memory.
pub(crate) const DECODED: &str = "decoded pictures";

/// Amounts that may still be created from a file.
pub(crate) struct Budget {
    limits: Limits,
    primitives: u64,
    bytes: u64,
    copies: u64,
}

impl Budget {
    pub fn new(limits: Limits) -> Self {
        Self { limits, primitives: 0, bytes: 0, copies: 0 }
    }

    /// Charges this many triangles and lines.
    pub fn primitives(&mut self, count: u64, place: impl FnOnce() -> Place) -> Result<()> {
        self.primitives = self.primitives.saturating_add(count);
        let limit = self.limits.primitives.min(u64::from(u32::MAX / 3));
        take("number of triangles and lines", self.primitives, limit, place)
    }

    /// Charges `count` triangles and lines for copies of meshes that differ only in material.
    pub fn copied(&mut self, count: u64, place: impl FnOnce() -> Place) -> Result<()> {
        self.copies = self.copies.saturating_add(count);
        take(
            "number of triangles and lines in all materials",
            self.copies,
            self.limits.primitives,
            place,
        )
    }

    /// Charges this many bytes of numbers.
    pub fn bytes(&mut self, count: u64, place: impl FnOnce() -> Place) -> Result<()> {
        self.bytes = self.bytes.saturating_add(count);
        take("memory for numbers", self.bytes, self.limits.decoded_bytes, place)?;
        Ok(self.limits.work.keep(MODEL, count)?)
    }
}

fn take(what: &'static str, value: u64, limit: u64, place: impl FnOnce() -> Place) -> Result<()> {
    if value > limit { Err(Error::Limit { place: place(), what, value, limit }) } else { Ok(()) }
}
