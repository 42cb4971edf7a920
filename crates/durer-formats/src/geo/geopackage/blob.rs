//! Geometries as GeoPackages store them: well-known binary after a header with an envelope.

use crate::geo::{Dimensions, Feature, Geometry, Warnings, wkb};
use crate::{Error, Place, Result};

/// First bytes of a geometry, and its version.
const MAGIC: &[u8] = b"GP\0";

/// Numbers of the envelope, by its kind.
const ENVELOPES: [usize; 5] = [0, 4, 6, 6, 8];

/// Bytes before the envelope.
const HEAD: usize = 8;

/// Reads a geometry.
///
/// # Errors
/// The fault and its byte.
pub fn read(bytes: &[u8], warnings: &mut Warnings, place: &Place) -> Result<Option<Geometry>> {
    let (&[_, _, _, flags], _) = bytes
        .split_first_chunk()
        .filter(|_| bytes.starts_with(MAGIC))
        .ok_or_else(|| Error::byte(0, "a geometry must begin with GP and a version of 0"))?;
    if flags & 0x20 != 0 {
        return Err(Error::byte(3, "it is of an extension"));
    }
    let envelope = ENVELOPES.get(usize::from(flags >> 1 & 7));
    let envelope = envelope.ok_or_else(|| Error::byte(3, "an envelope of no known kind"))?;
    let mut reader = wkb::Reader::new(bytes);
    reader.resume(HEAD + 8 * envelope);
    let feature = reader.next_feature();
    reader.warnings.relocate(|_| place.clone());
    warnings.append(&mut reader.warnings);
    feature.map(|feature| feature.and_then(|feature| feature.geometry))
}

/// Returns a geometry with its header, with an envelope of x and y except for points.
pub fn write(geometry: &Geometry, system: i32) -> Vec<u8> {
    let bounds = geometry.bounds();
    let envelope = bounds.filter(|_| !matches!(geometry, Geometry::Point(_)));
    let flags = 1 | u8::from(envelope.is_some()) << 1 | u8::from(bounds.is_none()) << 4;
    let mut bytes = [MAGIC, &[flags], &system.to_le_bytes()].concat();
    if let Some(envelope) = envelope {
        let (low, high) = (envelope.min(), envelope.max());
        [low.x, high.x, low.y, high.y].iter().for_each(|n| bytes.extend(n.to_le_bytes()));
    }
    let feature = Feature::of_geometry(geometry.clone());
    // Writing to memory fails only for more than 2³² parts.
    let _ = wkb::write_feature(&mut bytes, &feature);
    bytes
}

/// Returns the name of a kind of geometry, by its number in well-known binary; the general name if they differ.
pub fn kind_name(kind: Option<u32>) -> &'static str {
    match kind {
        Some(1) => "POINT",
        Some(2) => "LINESTRING",
        Some(3) => "POLYGON",
        Some(4) => "MULTIPOINT",
        Some(5) => "MULTILINESTRING",
        Some(6) => "MULTIPOLYGON",
        Some(7) => "GEOMETRYCOLLECTION",
        _ => "GEOMETRY",
    }
}

/// Ordinates of geometries: in all, in some, in none.
#[derive(Debug, Clone, Copy, Default)]
pub struct Ordinates {
    z: Presence,
    m: Presence,
}

/// Counts of geometries with and without an ordinate.
#[derive(Debug, Clone, Copy, Default)]
struct Presence {
    with: bool,
    without: bool,
}

impl Presence {
    fn add(&mut self, is_there: bool) {
        self.with |= is_there;
        self.without |= !is_there;
    }

    /// Returns 0 for never, 1 for always, 2 for sometimes.
    fn code(self) -> i64 {
        match (self.with, self.without) {
            (false, _) => 0,
            (true, false) => 1,
            (true, true) => 2,
        }
    }
}

impl Ordinates {
    /// Counts a geometry.
    pub fn add(&mut self, dimensions: Dimensions) {
        self.z.add(dimensions.has_z());
        self.m.add(dimensions.has_m());
    }

    /// Returns the numbers for it in tables, of heights and measures.
    pub fn codes(self) -> [i64; 2] {
        [self.z.code(), self.m.code()]
    }
}
