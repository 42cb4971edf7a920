//! A replacement for Draco without the feature `draco`.

use super::buffer::Source;
use super::json::{Draco, Whole};
use crate::Result;

/// Empty type: without the feature no mesh is ever decoded, and the fallback accessors are read.
#[derive(Debug)]
pub enum Packed {}

/// Attribute of a decoded mesh; without the feature, there are none.
pub type Attribute<'a> = &'a Packed;

impl Packed {
    /// Returns nothing: the accessors of the file are read instead, if they have data.
    pub fn read(_: &Source<'_>, _: &Draco, _: &str) -> Result<Option<Self>> {
        Ok(None)
    }

    /// Returns the indices; never called.
    pub fn indices(&self) -> Vec<u32> {
        match *self {}
    }

    /// Returns an attribute; never called.
    pub fn attribute(&self, _: Whole) -> Option<Attribute<'_>> {
        match *self {}
    }

    /// Returns the floats of an attribute; never called.
    pub fn floats<const N: usize>(
        &self,
        _: bool,
        _: &Source<'_>,
        _: &str,
    ) -> Result<Vec<[f32; N]>> {
        match *self {}
    }
}
