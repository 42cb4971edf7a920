//! PNG: to 8 bits per channel, and deep ones to 16.

use super::{Picture, broken, check_size, pixels_of};
use crate::foreign;
use crate::png::Channels;
use crate::{Limits, Result};
use durer::target::Pixels;
use std::io::Cursor;

/// The first bytes of a PNG file.
pub(super) const MAGIC: &[u8] = b"\x89PNG\r\n\x1a\n";

/// Deflate's best ratio: a byte of a zlib stream holds at most this many bytes (RFC 1951: 258 bytes
/// per two bits).
const DEFLATE_RATIO: u64 = 1032;

/// Returns whether a PNG says of itself that it is grey.
pub(crate) fn is_grey(bytes: &[u8]) -> bool {
    // After the signature: the length and the name of the first chunk, width, height and depth.
    bytes.starts_with(MAGIC) && matches!(bytes.get(25), Some(0 | 4))
}

/// Returns the number of bits in each sample of a PNG, at least 8; JPEG files have 8 always.
pub fn bits_per_sample(bytes: &[u8]) -> u8 {
    // After the signature: the length and the name of the first chunk, width and height.
    let depth = bytes.get(24).filter(|_| bytes.starts_with(MAGIC));
    depth.map_or(8, |depth| (*depth).max(8))
}

/// Refuses a PNG whose bytes cannot hold its pixels, or whose pixels take more than `limit` bytes.
pub(crate) fn check_png_holds(length: usize, info: &png::Info, limit: u64) -> Result<()> {
    let limits = Limits { image_side: u32::MAX, decoded_bytes: limit, ..Limits::default() };
    let bits = info.bits_per_pixel().max(1) as u64;
    let holds = (length as u64).saturating_mul(DEFLATE_RATIO * 8) / bits;
    check_size((info.width, info.height), 4, holds, "height map", &limits)
}

/// Decodes a file.
///
/// # Errors
/// As [`super::decode`].
pub(super) fn decode(bytes: &[u8], name: &str, limits: &Limits) -> Result<Picture> {
    let (frame, samples) = png_samples(bytes, 4, name, limits)?;
    let color = frame.color_type;
    let pixels = match frame.bit_depth {
        png::BitDepth::Sixteen => {
            rgba(samples.as_chunks().0, color, u8::MAX, |s| to_8_bit(u16::from_be_bytes(s)))
        }
        _ => rgba(&samples, color, u8::MAX, |sample| sample),
    };
    Ok((frame.width, frame.height, pixels.ok_or_else(|| broken(name, "has no palette"))?))
}

/// A picture of 16 bits per channel.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct DeepImage {
    /// RGBA with straight alpha; greys have three channels alike, opaque ones an alpha of 65535.
    pub pixels: Pixels<[u16; 4]>,
    /// Channels of the file.
    pub channels: Channels,
}

/// Decodes a PNG file of 16 bits per channel without rounding; samples of fewer bits are spread over the same range.
///
/// `name`, limits and omissions as in [`super::decode`]; a pixel takes 8 bytes. [`bits_per_sample`] tells whether a
/// file is deep.
///
/// # Errors
/// As [`super::decode`]; also [`Decode`](crate::Error::Decode) if the bytes are no PNG.
pub fn decode_deep(bytes: &[u8], name: &str, limits: &Limits) -> Result<DeepImage> {
    if !bytes.starts_with(MAGIC) {
        return Err(broken(name, "is no PNG, the one format with 16 bits per channel"));
    }
    let (frame, samples) = png_samples(bytes, 8, name, limits)?;
    let color = frame.color_type;
    let pixels = match frame.bit_depth {
        png::BitDepth::Sixteen => rgba(samples.as_chunks().0, color, u16::MAX, u16::from_be_bytes),
        _ => rgba(&samples, color, u16::MAX, |sample: u8| u16::from(sample) * 257),
    };
    let pixels = pixels.ok_or_else(|| broken(name, "has no palette"))?;
    let channels = Channels {
        color: matches!(color, png::ColorType::Rgb | png::ColorType::Rgba),
        alpha: matches!(color, png::ColorType::GrayscaleAlpha | png::ColorType::Rgba),
    };
    Ok(DeepImage { pixels: Pixels::from_data(frame.width, frame.height, pixels)?, channels })
}

/// Returns the samples of the first picture of a PNG, palettes and transparent colours resolved, 1, 2 and 4
/// bits as 8, 16 bits as two bytes; `bytes_per_pixel` is the size of a decoded pixel.
fn png_samples(
    bytes: &[u8],
    bytes_per_pixel: u64,
    name: &str,
    limits: &Limits,
) -> Result<(png::OutputInfo, Vec<u8>)> {
    let wrong = |e: png::DecodingError| broken(name, foreign::png(&e));
    let memory = usize::try_from(limits.decoded_bytes).unwrap_or(usize::MAX);
    let mut decoder =
        png::Decoder::new_with_limits(Cursor::new(bytes), png::Limits { bytes: memory });
    decoder.set_transformations(png::Transformations::EXPAND);
    decoder.set_ignore_text_chunk(true);
    decoder.set_ignore_iccp_chunk(true);
    let info = decoder.read_header_info().map_err(wrong)?;
    let size = (info.width, info.height);
    let bits = info.bits_per_pixel().max(1) as u64;
    let holds = (bytes.len() as u64).saturating_mul(DEFLATE_RATIO * 8) / bits;
    check_size(size, bytes_per_pixel, holds, name, limits)?;
    let mut reader = decoder.read_info().map_err(wrong)?;
    let length = reader.output_buffer_size().ok_or_else(|| broken(name, "is too large"))?;
    let mut samples = vec![0; length];
    let frame = reader.next_frame(&mut samples).map_err(wrong)?;
    if (frame.width, frame.height) != size {
        return Err(broken(name, "has a first frame of another size"));
    }
    Ok((frame, samples))
}

/// Converts samples, each read by `v`, to RGBA; `None` for indices of a palette.
fn rgba<S: Copy, T: Copy>(
    samples: &[S],
    color: png::ColorType,
    opaque: T,
    v: impl Fn(S) -> T,
) -> Option<Vec<[T; 4]>> {
    Some(match color {
        png::ColorType::Grayscale => pixels_of(samples, v, |[g]| [g, g, g, opaque]),
        png::ColorType::GrayscaleAlpha => pixels_of(samples, v, |[g, a]| [g, g, g, a]),
        png::ColorType::Rgb => pixels_of(samples, v, |[r, g, b]| [r, g, b, opaque]),
        png::ColorType::Rgba => pixels_of(samples, v, |rgba| rgba),
        png::ColorType::Indexed => return None,
    })
}

/// Returns the nearest of 256 levels.
fn to_8_bit(sample: u16) -> u8 {
    ((u32::from(sample) * 255 + 32_767) / 65_535) as u8
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Error;
    use crate::image::decode;

    /// Returns a PNG of one row.
    fn png_row(width: u32, color: png::ColorType, depth: png::BitDepth, data: &[u8]) -> Vec<u8> {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, width, 1);
        encoder.set_color(color);
        encoder.set_depth(depth);
        if color == png::ColorType::Indexed {
            encoder.set_palette(vec![1, 2, 3, 9, 8, 7]);
            encoder.set_trns(vec![255, 10]);
        }
        let mut writer = encoder.write_header().unwrap();
        writer.write_image_data(data).unwrap();
        writer.finish().unwrap();
        bytes
    }

    fn decoded(bytes: &[u8]) -> Vec<[u8; 4]> {
        decode(bytes, "test", &Limits::default()).unwrap().data
    }

    #[test]
    fn every_png_layout_becomes_rgba() {
        use png::{BitDepth::*, ColorType::*};
        assert_eq!(decoded(&png_row(1, Rgb, Eight, &[5, 6, 7])), [[5, 6, 7, 255]]);
        assert_eq!(decoded(&png_row(1, Rgba, Eight, &[5, 6, 7, 8])), [[5, 6, 7, 8]]);
        assert_eq!(decoded(&png_row(1, GrayscaleAlpha, Eight, &[5, 6])), [[5, 5, 5, 6]]);
        let bits = decoded(&png_row(2, Grayscale, One, &[0b0100_0000]));
        assert_eq!(bits, [[0, 0, 0, 255], [255, 255, 255, 255]]);
        let palette = decoded(&png_row(2, Indexed, Eight, &[1, 0]));
        assert_eq!(palette, [[9, 8, 7, 10], [1, 2, 3, 255]]);
        // 0x807f / 257 = 127.99…: rounded up, where taking the high byte gives 128 as well, while
        // 0x00ff rounds to 1 and its high byte is 0.
        let deep = decoded(&png_row(2, Grayscale, Sixteen, &[0x80, 0x7f, 0x00, 0xff]));
        assert_eq!(deep, [[128, 128, 128, 255], [1, 1, 1, 255]]);
        let bits = |depth| {
            bits_per_sample(&png_row(if depth == One { 16 } else { 1 }, Grayscale, depth, &[0; 2]))
        };
        assert_eq!((bits(Sixteen), bits(One)), (16, 8));
    }

    #[test]
    fn every_png_layout_becomes_deep_rgba() {
        use png::{BitDepth::*, ColorType::*};
        let deep = |bytes: &[u8]| {
            let image = decode_deep(bytes, "test", &Limits::default()).unwrap();
            (image.pixels.into_data(), (image.channels.color, image.channels.alpha))
        };
        let data: Vec<u8> = (1..=8).collect();
        let of = |color| deep(&png_row(1, color, Sixteen, &data[..2 * color.samples()]));
        assert_eq!(of(Grayscale), (vec![[0x102, 0x102, 0x102, 0xffff]], (false, false)));
        assert_eq!(of(GrayscaleAlpha), (vec![[0x102, 0x102, 0x102, 0x304]], (false, true)));
        assert_eq!(of(Rgb), (vec![[0x102, 0x304, 0x506, 0xffff]], (true, false)));
        assert_eq!(of(Rgba), (vec![[0x102, 0x304, 0x506, 0x708]], (true, true)));
        let palette = deep(&png_row(1, Indexed, Eight, &[1]));
        assert_eq!(palette, (vec![[0x909, 0x808, 0x707, 0xa0a]], (true, true)));
        let limits = Limits { decoded_bytes: 15, ..Limits::default() };
        let two = png_row(2, Grayscale, Sixteen, &[0; 4]);
        assert!(matches!(decode_deep(&two, "x", &limits), Err(Error::Limit { .. })));
        assert!(decode(&two, "x", &limits).is_ok());
        let no = decode_deep(b"\xff\xd8\xff", "x", &Limits::default()).unwrap_err();
        assert!(no.to_string().contains("is no PNG"), "{no}");
    }

    #[test]
    fn a_size_is_refused_before_memory_is_taken() {
        let mut bytes = png_row(1, png::ColorType::Rgb, png::BitDepth::Eight, &[5, 6, 7]);
        for (width, limit) in [(1_000_000_000_u32, true), (16_000, false)] {
            bytes[16..20].copy_from_slice(&width.to_be_bytes());
            bytes[20..24].copy_from_slice(&width.to_be_bytes());
            let crc = crc(&bytes[12..29]);
            bytes[29..33].copy_from_slice(&crc.to_be_bytes());
            let error = decode(&bytes, "huge", &Limits::default()).unwrap_err();
            assert_eq!(matches!(error, Error::Limit { .. }), limit, "{error}");
            assert_eq!(error.to_string().contains("too short"), !limit, "{error}");
        }
    }

    /// Returns the checksum of a PNG chunk (ISO 3309).
    fn crc(bytes: &[u8]) -> u32 {
        !bytes.iter().fold(u32::MAX, |crc, &byte| {
            (0..8).fold(crc ^ u32::from(byte), |c, _| {
                (c >> 1) ^ (0xedb8_8320 & (c & 1).wrapping_neg())
            })
        })
    }
}
