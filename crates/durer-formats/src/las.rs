//! LAS, the format of airborne laser scans, and LAZ, which is LAS compressed (feature `laz`).
//!
//! Source: ASPRS, *LAS Specification 1.4 – R15*, 2019; earlier versions are read in the same way. The reader takes the
//! position, colour and intensity of points; intensity is shown as grey if the file has no colours. Colours have 16
//! bits, and are scaled if all are below 256, as some programs write them. Classes, waveforms, and the coordinate
//! system are ignored. z is up.
//!
//! Cost: one pass. Memory: 24 bytes per point while reading, 20 more for colour and intensity.

#[cfg(feature = "laz")]
mod laz;
#[cfg(not(feature = "laz"))]
#[path = "las/no_laz.rs"]
mod laz;

use crate::cloud::Cloud;
use crate::{Error, Model, Place, ReadOptions, Resources, Result};
use durer::math::{DVec3, Vec4};

/// Least bytes of a header.
const HEADER: usize = 227;
/// Least bytes of a point, by the number of its format, and where its colour is.
const FORMATS: [(usize, Option<usize>); 11] = [
    (20, None),
    (28, None),
    (26, Some(20)),
    (34, Some(28)),
    (57, None),
    (63, Some(28)),
    (30, None),
    (36, Some(30)),
    (38, Some(30)),
    (59, None),
    (67, Some(30)),
];

/// Returns whether the content begins as LAS and LAZ do.
pub(crate) fn sniff(bytes: &[u8]) -> bool {
    bytes.starts_with(b"LASF")
}

/// Reads a LAS or LAZ file.
///
/// A truncated file is read up to its end, with a warning.
///
/// # Errors
/// [`Error::Decode`] for a header that is not LAS's, or compressed data that are broken from the first
/// point on; [`Error::Unsupported`] for formats of points beyond version 1.4, or LAZ without the feature;
/// [`Error::Limit`] for more points than allowed.
pub fn read(bytes: &[u8], _resources: &dyn Resources, options: &ReadOptions) -> Result<Model> {
    let header = Header::read(bytes)?;
    let name = if header.compressed { "LAZ" } else { "LAS" };
    let mut model = Model { format: format!("{name} 1.{}", header.minor), ..Model::default() };
    let mut cloud = Cloud { full: 65535.0, ..Cloud::default() };
    cloud.make_room(header.count, || Place::Byte(107), &options.limits)?;
    let read = if header.compressed {
        laz::points(bytes, &header, |record| header.point(record, &mut cloud))?
    } else {
        header.points(bytes, &mut cloud)
    };
    if read < header.count {
        let (count, are) = (header.count, if read == 1 { "is" } else { "are" });
        let message = format!("the file ends too early: {read} of {count} points {are} read");
        if read == 0 {
            return Err(Error::byte(bytes.len() as u64, message));
        }
        model.warn(Place::Byte(bytes.len() as u64), message);
    }
    let brightest = cloud.colors.iter().map(|c| c.truncate().max_element()).fold(0.0, f32::max);
    if brightest > 0.0 && brightest < 256.0 {
        cloud.full = 255.0;
        model.warn(Place::Whole, "colors go up to 255 instead of 65535; they were scaled");
    }
    cloud.into_model(model)
}

/// Header that describes the points.
struct Header {
    minor: u8,
    /// Offset of the points.
    data: usize,
    compressed: bool,
    color: Option<usize>,
    /// Bytes of a point.
    length: usize,
    count: u64,
    scale: DVec3,
    offset: DVec3,
}

/// Returns N bytes of a file from an offset on.
fn take<const N: usize>(bytes: &[u8], at: usize) -> Option<[u8; N]> {
    bytes.get(at..)?.first_chunk().copied()
}

fn vector(bytes: &[u8], at: usize) -> Option<DVec3> {
    let number = |at| take(bytes, at).map(f64::from_le_bytes);
    Some(DVec3::new(number(at)?, number(at + 8)?, number(at + 16)?))
}

impl Header {
    fn read(bytes: &[u8]) -> Result<Self> {
        if !sniff(bytes) {
            return Err(Error::byte(0, "a LAS file begins with `LASF`"));
        }
        let cut = || {
            let message = format!("the file ends within its header of {HEADER} bytes");
            Error::byte(bytes.len() as u64, message)
        };
        let header = Self::fields(bytes).ok_or_else(cut)?;
        let format = bytes[104] & 0x3f;
        let Some(&(least, color)) = FORMATS.get(usize::from(format)) else {
            return Err(Error::Unsupported {
                place: Place::Byte(104),
                what: format!("LAS point format {format}"),
                hint: "formats 0 to 10 are".to_owned(),
            });
        };
        if header.length < least {
            let length = header.length;
            let message =
                format!("points have {length} bytes; of format {format} they need {least}");
            return Err(Error::byte(105, message));
        }
        Ok(Self { color, ..header })
    }

    /// Returns the fields that do not depend on the format of points.
    fn fields(bytes: &[u8]) -> Option<Self> {
        bytes.get(..HEADER)?;
        let u16_at = |at| take(bytes, at).map(u16::from_le_bytes);
        let u32_at = |at| take(bytes, at).map(u32::from_le_bytes);
        let minor = *bytes.get(25)?;
        let size = usize::from(u16_at(94)?);
        let old_count = u64::from(u32_at(107)?);
        let wide = (minor >= 4 && size >= 255).then(|| take(bytes, 247).map(u64::from_le_bytes));
        let count = wide.flatten().filter(|&count| count > 0).unwrap_or(old_count);
        Some(Self {
            minor,
            data: u32_at(96)? as usize,
            compressed: *bytes.get(104)? & 0x80 != 0,
            color: None,
            length: usize::from(u16_at(105)?),
            count,
            scale: vector(bytes, 131)?,
            offset: vector(bytes, 155)?,
        })
    }

    /// Reads the points of a file that is not compressed; returns how many there are.
    fn points(&self, bytes: &[u8], cloud: &mut Cloud) -> u64 {
        let data = bytes.get(self.data..).unwrap_or_default();
        let records = data.chunks_exact(self.length);
        let there = (records.len() as u64).min(self.count);
        for record in records.take(there as usize) {
            self.point(record, cloud);
        }
        there
    }

    /// Adds a point.
    fn point(&self, record: &[u8], cloud: &mut Cloud) {
        let number = |at| take(record, at).map_or(0, i32::from_le_bytes);
        let place = [number(0), number(4), number(8)].map(f64::from);
        cloud.points.push(DVec3::from_array(place) * self.scale + self.offset);
        let short = |at| f32::from(take(record, at).map_or(0, u16::from_le_bytes));
        cloud.intensities.push(short(12));
        if let Some(at) = self.color {
            cloud.colors.push(Vec4::new(short(at), short(at + 2), short(at + 4), 1.0));
        }
    }
}

#[cfg(test)]
mod tests;
