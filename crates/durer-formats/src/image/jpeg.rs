//! JPEG: grey, colours and inks.

use super::{Picture, broken, check_size, pixels_of};
use crate::foreign;
use crate::{Error, Limits, Result};
use std::io::Cursor;
use zune_jpeg::zune_core::colorspace::ColorSpace;
use zune_jpeg::zune_core::options::DecoderOptions;

/// The first bytes of a JPEG file: start of image, and the start of the next marker.
pub(super) const MAGIC: &[u8] = b"\xff\xd8\xff";

/// Each 8 × 8 block of a JPEG costs one bit at least, so a byte holds at most this many pixels.
const JPEG_PIXELS_PER_BYTE: u64 = 8 * 64;

/// Decodes a file.
///
/// # Errors
/// As [`super::decode`].
pub(super) fn decode(bytes: &[u8], name: &str, limits: &Limits) -> Result<Picture> {
    let wrong = |e: zune_jpeg::errors::DecodeErrors| broken(name, foreign::jpeg(&e));
    let open = |out: ColorSpace| {
        let options = DecoderOptions::new_safe()
            .set_max_width(limits.image_side as usize)
            .set_max_height(limits.image_side as usize)
            .jpeg_set_out_colorspace(out);
        let mut decoder = zune_jpeg::JpegDecoder::new_with_options(Cursor::new(bytes), options);
        decoder.decode_headers().map_err(wrong)?;
        Ok::<_, Error>(decoder)
    };
    let mut decoder = open(ColorSpace::RGBA)?;
    let (width, height) = decoder.dimensions().ok_or_else(|| broken(name, "has no size"))?;
    let side = |n: usize| u32::try_from(n).unwrap_or(u32::MAX);
    let size = (side(width), side(height));
    let holds = (bytes.len() as u64).saturating_mul(JPEG_PIXELS_PER_BYTE);
    check_size(size, 4, holds, name, limits)?;
    let ink = matches!(decoder.input_colorspace(), Some(ColorSpace::CMYK | ColorSpace::YCCK));
    let pixels = if ink {
        // The decoder brings inks to RGB only.
        let mut samples = vec![0; width * height * 3];
        open(ColorSpace::RGB)?.decode_into(&mut samples).map_err(wrong)?;
        pixels_of(&samples, |sample| sample, |[r, g, b]| [r, g, b, 255])
    } else {
        let mut pixels = vec![[0; 4]; width * height];
        decoder.decode_into(pixels.as_flattened_mut()).map_err(wrong)?;
        pixels
    };
    // The decoder leaves missing parts grey.
    if !has_end(bytes) {
        return Err(broken(name, "is cut off: no end of image follows its last scan"));
    }
    Ok((size.0, size.1, pixels))
}

/// Returns whether the end marker of a JPEG comes after the marker of its last scan; the data of a scan can contain
/// neither.
fn has_end(bytes: &[u8]) -> bool {
    let last_scan = bytes.windows(2).rposition(|marker| marker == [0xff, 0xda]);
    last_scan.is_none_or(|at| bytes[at..].windows(2).any(|marker| marker == [0xff, 0xd9]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::decode;

    /// Returns a baseline JPEG of one 8 × 8 block per component with equal samples: its two Huffman tables have codes
    /// for differences of 0, 7 and 8 bits, and for the end of a block.
    fn jpeg_block(samples: &[u8]) -> Vec<u8> {
        let count = samples.len() as u8;
        let mut bytes = vec![0xff, 0xd8];
        bytes.extend(b"\xff\xee\0\x0eAdobe\0\x64\0\0\0\0\0");
        // Quantization: the constant term by 8, so that a step of it is a step of the samples.
        bytes.extend([0xff, 0xdb, 0, 67, 0, 8]);
        bytes.extend([1; 63]);
        bytes.extend([0xff, 0xc0, 0, 8 + 3 * count, 8, 0, 8, 0, 8, count]);
        (1..=count).for_each(|id| bytes.extend([id, 0x11, 0]));
        bytes.extend([0xff, 0xc4, 0, 22, 0x00, 0, 3]);
        bytes.extend([0; 14]);
        bytes.extend([0, 7, 8]);
        bytes.extend([0xff, 0xc4, 0, 20, 0x10, 1]);
        bytes.extend([0; 15]);
        bytes.extend([0, 0xff, 0xda, 0, 6 + 2 * count, count]);
        (1..=count).for_each(|id| bytes.extend([id, 0]));
        bytes.extend([0, 63, 0]);
        let mut bits = String::new();
        for &sample in samples {
            let constant = i32::from(sample) - 128;
            bits += &match constant {
                64..=127 => format!("01{constant:07b}0"),
                -255..=-128 => format!("10{:08b}0", constant + 255),
                _ => "000".to_owned(),
            };
        }
        bits += &"1".repeat(bits.len().wrapping_neg() % 8);
        for byte in bits.as_bytes().chunks(8) {
            let byte = byte.iter().fold(0, |b, bit| b << 1 | (bit - b'0'));
            bytes.push(byte);
            bytes.extend((byte == 0xff).then_some(0));
        }
        bytes.extend([0xff, 0xd9]);
        bytes
    }

    #[test]
    fn jpegs_of_one_three_and_four_components() {
        let pixels = |samples: &[u8]| {
            let image = decode(&jpeg_block(samples), "test", &Limits::default()).unwrap();
            assert_eq!((image.width, image.height), (8, 8));
            assert!(image.data.iter().all(|p| *p == image.data[0]));
            image.data[0]
        };
        assert_eq!(pixels(&[228]), [228, 228, 228, 255]);
        // CMYK as Adobe writes it: 255 is no ink.
        assert_eq!(pixels(&[255, 0, 0, 255]), [255, 0, 0, 255]);
        assert_eq!(pixels(&[255, 255, 0, 128]), [128, 128, 0, 255]);
        let whole = jpeg_block(&[228]);
        for cut in 1..=2 {
            let error = decode(&whole[..whole.len() - cut], "short", &Limits::default());
            assert!(error.unwrap_err().to_string().contains("cut off"), "{cut} bytes less");
        }
        let mut huge = whole.clone();
        let size = whole.windows(2).position(|w| w == [0xff, 0xc0]).unwrap() + 5;
        huge[size..size + 4].copy_from_slice(&[0x3f; 4]);
        let error = decode(&huge, "huge", &Limits::default()).unwrap_err().to_string();
        assert!(error.contains("too short for its 16191 × 16191 pixels"), "{error}");
    }
}
