//! Truevision TGA: indexed, true colour and grey pictures, as they are or run-length encoded.
//!
//! Source: *Truevision TGA File Format Specification*, version 2.0, 1991. The format has no magic number:
//! a file is one whose header makes sense, which few other bytes do.

use super::{Picture, broken, check_size, pixels_of, show_if_all_transparent};
use crate::{Limits, Result};
use image::codecs::tga::TgaDecoder;
use image::{ColorType, ImageDecoder, ImageError};
use std::io::{ErrorKind, Read};

/// The length of the header.
const HEADER: usize = 18;

/// A run-length packet of two bytes at least holds up to 128 pixels.
const PIXELS_PER_BYTE: u64 = 64;

/// Kind of pixels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Indexed,
    Color,
    Grey,
}

/// The header.
#[derive(Debug, Clone, Copy)]
struct Header {
    kind: Kind,
    packed: bool,
    /// First index, number, and bits of the entries of the colour map.
    map: [usize; 3],
    width: u32,
    height: u32,
    bits: usize,
}

impl Header {
    /// Reads a header; `None` if it is invalid.
    fn of(bytes: &[u8]) -> Option<Self> {
        let short = |at: usize| {
            Some(usize::from(u16::from_le_bytes([*bytes.get(at)?, *bytes.get(at + 1)?])))
        };
        let byte = |at: usize| bytes.get(at).copied();
        let (map_type, image_type, descriptor) = (byte(1)?, byte(2)?, byte(17)?);
        let kind = match image_type & 7 {
            1 => Kind::Indexed,
            2 => Kind::Color,
            3 => Kind::Grey,
            _ => return None,
        };
        let header = Self {
            kind,
            packed: image_type & 8 != 0,
            map: [short(3)?, short(5)?, usize::from(byte(7)?)],
            width: short(12)? as u32,
            height: short(14)? as u32,
            bits: usize::from(byte(16)?),
        };
        let known = image_type & !0b1011 == 0 && map_type <= 1 && descriptor & 0xc0 == 0;
        let has_map = map_type == 1 && matches!(header.map[2], 15 | 16 | 24 | 32);
        let fits = match kind {
            Kind::Indexed => has_map && matches!(header.bits, 8 | 16),
            Kind::Color => matches!(header.bits, 15 | 16 | 24 | 32),
            Kind::Grey => matches!(header.bits, 8 | 16),
        };
        (known && fits && header.width > 0 && header.height > 0).then_some(header)
    }

    /// Returns the bytes of a header without its number of bits of alpha, which many writers get wrong: 32
    /// bits have alpha, and so have 16 of grey.
    fn without_alpha(&self, head: &[u8]) -> Vec<u8> {
        let mut head = head.to_vec();
        if let Some(descriptor) = head.last_mut() {
            let alpha = if self.kind == Kind::Grey && self.bits == 16 { 8 } else { 0 };
            *descriptor = *descriptor & 0x30 | alpha;
        }
        head
    }
}

/// Returns whether bytes begin like a TGA file.
pub(super) fn is_tga(bytes: &[u8]) -> bool {
    Header::of(bytes).is_some()
}

/// Decodes a file, by the decoder of the crate `image`.
///
/// # Errors
/// As [`super::decode`].
pub(super) fn decode(bytes: &[u8], name: &str, limits: &Limits) -> Result<Picture> {
    let header = Header::of(bytes).ok_or_else(|| broken(name, "is no TGA picture"))?;
    let per_byte = if header.packed { PIXELS_PER_BYTE } else { 1 };
    let holds = (bytes.len() as u64).saturating_mul(per_byte);
    // Samples and pixels are there at once.
    check_size((header.width, header.height), 8, holds, name, limits)?;
    let wrong = |e: ImageError| match e {
        ImageError::IoError(e) if e.kind() == ErrorKind::UnexpectedEof => {
            broken(name, "is cut off")
        }
        _ => broken(name, "holds broken TGA data"),
    };
    let (head, rest) = bytes.split_at_checked(HEADER).unwrap_or((bytes, &[]));
    let head = header.without_alpha(head);
    let decoder = TgaDecoder::new(head.as_slice().chain(rest)).map_err(wrong)?;
    let color = decoder.color_type();
    let pixels = header.width as usize * header.height as usize;
    let mut samples = vec![0; pixels * usize::from(color.bytes_per_pixel())];
    decoder.read_image(&mut samples).map_err(wrong)?;
    let mut pixels = match color {
        ColorType::L8 => pixels_of(&samples, |s| s, |[g]| [g, g, g, 255]),
        ColorType::La8 => pixels_of(&samples, |s| s, |[g, a]| [g, g, g, a]),
        ColorType::Rgb8 => pixels_of(&samples, |s| s, |[r, g, b]| [r, g, b, 255]),
        _ => pixels_of(&samples, |s| s, |rgba| rgba),
    };
    show_if_all_transparent(&mut pixels);
    Ok((header.width, header.height, pixels))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::decode;

    /// Returns a file of two by two pixels.
    fn file(image_type: u8, bits: u8, descriptor: u8, map: &[u8], data: &[u8]) -> Vec<u8> {
        let mut bytes = vec![1, u8::from(!map.is_empty()), image_type];
        bytes.extend([
            0,
            0,
            (map.len() / 3) as u8,
            0,
            24,
            0,
            0,
            0,
            0,
            2,
            0,
            2,
            0,
            bits,
            descriptor,
        ]);
        bytes.push(b'!');
        [&bytes, map, data].concat()
    }

    fn decoded(bytes: &[u8]) -> Vec<[u8; 4]> {
        decode(bytes, "x", &Limits::default()).unwrap().data
    }

    const GREYS: [[u8; 4]; 4] = [[1, 1, 1, 255], [2, 2, 2, 255], [3, 3, 3, 255], [4, 4, 4, 255]];

    #[test]
    fn rows_and_columns_come_in_any_order() {
        assert_eq!(decoded(&file(3, 8, 0x20, &[], &[1, 2, 3, 4])), GREYS);
        assert_eq!(decoded(&file(3, 8, 0x00, &[], &[3, 4, 1, 2])), GREYS);
        assert_eq!(decoded(&file(3, 8, 0x30, &[], &[2, 1, 4, 3])), GREYS);
        // A run of two, and two literal pixels; also across the end of a row.
        assert_eq!(decoded(&file(11, 8, 0x20, &[], &[0, 1, 0x81, 2, 0, 4]))[1..3], [GREYS[1]; 2]);
    }

    #[test]
    fn every_layout_becomes_rgba() {
        let first = |bytes: Vec<u8>| decoded(&bytes)[0];
        assert_eq!(first(file(2, 24, 0x20, &[], &[3, 2, 1].repeat(4))), [1, 2, 3, 255]);
        assert_eq!(first(file(2, 32, 0x28, &[], &[3, 2, 1, 9].repeat(4))), [1, 2, 3, 9]);
        assert_eq!(first(file(10, 32, 0x28, &[], &[0x83, 3, 2, 1, 0])), [1, 2, 3, 255]);
        assert_eq!(first(file(2, 24, 0x28, &[], &[3, 2, 1].repeat(4))), [1, 2, 3, 255]);
        assert_eq!(first(file(2, 32, 0x20, &[], &[3, 2, 1, 9].repeat(4))), [1, 2, 3, 9]);
        assert_eq!(first(file(3, 16, 0x20, &[], &[3, 9].repeat(4))), [3, 3, 3, 9]);
        assert_eq!(first(file(2, 16, 0x20, &[], &[0x1f, 0x7c].repeat(4))), [255, 0, 255, 255]);
        assert_eq!(first(file(1, 8, 0x20, &[9, 9, 9, 3, 2, 1], &[1, 0, 0, 0])), [1, 2, 3, 255]);
    }

    #[test]
    fn what_is_missing_or_too_much_is_reported() {
        let error = |bytes: &[u8]| decode(bytes, "x", &Limits::default()).unwrap_err().to_string();
        assert!(error(&file(3, 8, 0, &[], &[1, 2])).contains("cut off"));
        assert!(error(&file(11, 8, 0, &[], &[0x81, 1])).contains("cut off"));
        assert!(error(&file(1, 8, 0, &[1, 2, 3], &[0, 0, 0, 1])).contains("broken TGA data"));
        let mut huge = file(3, 8, 0, &[], &[1, 2, 3, 4]);
        huge[12..16].copy_from_slice(&[0xff, 0x3f, 0xff, 0x3f]);
        assert!(error(&huge).contains("too short for its 16383 × 16383 pixels"));
        huge[13] = 0xff;
        assert!(error(&huge).contains("above the limit"));
    }
}
