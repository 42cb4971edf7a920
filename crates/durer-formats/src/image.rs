//! Pictures that models wear: PNG, JPEG, WebP, GIF, BMP and TGA to 8-bit RGBA; and deep PNG to 16-bit RGBA.
//!
//! What a file is, is told by its first bytes, of TGA by its whole header. Sizes are checked before anything is allocated, also
//! against what the bytes at hand can hold at all, so a short file cannot ask for a huge picture.

mod bmp;
mod bytes;
mod gif;
mod orientation;
mod tga;
mod webp;

pub use orientation::Orientation;

use crate::png::Channels;
use crate::{Error, Limits, Place, Result};
use durer::scene::Image;
use durer::target::Pixels;
use std::io::Cursor;
use zune_jpeg::zune_core::colorspace::ColorSpace;
use zune_jpeg::zune_core::options::DecoderOptions;

/// The first bytes of a PNG file.
const PNG: &[u8] = b"\x89PNG\r\n\x1a\n";
/// The first bytes of a JPEG file: start of image, and the start of the next marker.
const JPEG: &[u8] = b"\xff\xd8\xff";

/// Deflate's best ratio: a byte of a zlib stream holds at most so many bytes (RFC 1951: 258 bytes
/// per two bits).
const DEFLATE_RATIO: u64 = 1032;
/// Each 8 × 8 block of a JPEG costs one bit at least, so a byte holds at most so many pixels.
const JPEG_PIXELS_PER_BYTE: u64 = 8 * 64;

/// Width, height and pixels.
type Picture = (u32, u32, Vec<[u8; 4]>);

/// Decodes a PNG, JPEG, WebP, GIF, BMP or TGA file.
///
/// Palettes, greys, CMYK (inverted, as Adobe writes it) and transparency become RGBA with straight
/// alpha; 16-bit samples are rounded to 8. Of an animation the first picture is taken. Colour
/// profiles are not applied, nor is the [`Orientation`]. `name` names the picture in the result and in messages.
///
/// # Errors
/// [`Error::Limit`] where a side is above `limits.image_side` or the pixels above
/// `limits.decoded_bytes`, [`Error::Unsupported`] for other known picture formats,
/// [`Error::Decode`] for what is broken. `Place` is the whole: the caller knows the rest.
pub fn decode(bytes: &[u8], name: &str, limits: &Limits) -> Result<Image> {
    let starts = |magic: &[u8]| bytes.starts_with(magic);
    let (width, height, data) = match () {
        () if starts(PNG) => decode_png(bytes, name, limits)?,
        () if starts(JPEG) => decode_jpeg(bytes, name, limits)?,
        () if webp::is_webp(bytes) => webp::decode(bytes, name, limits)?,
        () if starts(gif::MAGIC) => gif::decode(bytes, name, limits)?,
        () if starts(bmp::MAGIC) => bmp::decode(bytes, name, limits)?,
        () => match other_format(bytes) {
            Some(format) => return Err(unsupported(name, format)),
            None if tga::is_tga(bytes) => tga::decode(bytes, name, limits)?,
            None => return Err(broken(name, "is neither PNG nor JPEG, WebP, GIF, BMP or TGA")),
        },
    };
    Ok(Image { name: name.to_owned(), width, height, data })
}

/// Whether a PNG says of itself that it is grey.
pub(crate) fn is_grey(bytes: &[u8]) -> bool {
    // After the signature: the length and the name of the first chunk, width, height and depth.
    bytes.starts_with(PNG) && matches!(bytes.get(25), Some(0 | 4))
}

fn unsupported(name: &str, format: &str) -> Error {
    Error::Unsupported {
        place: Place::Whole,
        what: format!("image `{name}`: the format {format}"),
        hint: "use PNG, JPEG or WebP".to_owned(),
    }
}

/// How many bits each sample of a PNG has, at least 8; JPEG files have 8 always.
pub fn bits_per_sample(bytes: &[u8]) -> u8 {
    // After the signature: the length and the name of the first chunk, width and height.
    let depth = bytes.get(24).filter(|_| bytes.starts_with(PNG));
    depth.map_or(8, |depth| (*depth).max(8))
}

/// The name of a picture format that is known but not read.
fn other_format(bytes: &[u8]) -> Option<&'static str> {
    let starts = |magic: &[u8]| bytes.starts_with(magic);
    match () {
        () if starts(b"\xabKTX 20\xbb\r\n\x1a\n") => Some("KTX 2 (Basis Universal)"),
        () if starts(b"\xabKTX 11\xbb\r\n\x1a\n") => Some("KTX"),
        () if starts(b"sB") && bytes.get(4..6) == Some(&[77, 0]) => Some("Basis Universal"),
        () if starts(b"DDS ") => Some("DDS"),
        () if starts(b"II*\0") || starts(b"MM\0*") => Some("TIFF"),
        () if starts(b"8BPS") => Some("PSD"),
        () if starts(b"v/1\x01") => Some("OpenEXR"),
        () if starts(b"#?RADIANCE") => Some("Radiance HDR"),
        () => None,
    }
}

/// A value of `most` levels spread over a byte.
fn widen(value: u32, most: u32) -> u8 {
    (u64::from(value) * 255 + u64::from(most) / 2).checked_div(u64::from(most)).unwrap_or(0) as u8
}

/// Exchanges top and bottom.
fn flip(pixels: &mut [[u8; 4]], width: usize) {
    let height = pixels.len() / width.max(1);
    for y in 0..height / 2 {
        let (upper, lower) = pixels.split_at_mut((height - 1 - y) * width);
        upper[y * width..][..width].swap_with_slice(&mut lower[..width]);
    }
}

/// Makes pixels opaque that all have an alpha of 0: many writers leave unset what they do not use.
fn show_if_all_transparent(pixels: &mut [[u8; 4]]) {
    if pixels.iter().all(|pixel| pixel[3] == 0) {
        pixels.iter_mut().for_each(|pixel| pixel[3] = 255);
    }
}

/// A decode error that names the picture.
fn broken(name: &str, message: impl std::fmt::Display) -> Error {
    Error::whole(format!("image `{name}`: {message}"))
}

/// Checks a size against the limits and against what the file's bytes can hold.
fn check_size(
    size: (u32, u32),
    bytes_per_pixel: u64,
    holds: u64,
    name: &str,
    limits: &Limits,
) -> Result<()> {
    let limit = |what, value, limit| Err(Error::Limit { place: Place::Whole, what, value, limit });
    let side = size.0.max(size.1);
    if side > limits.image_side {
        return limit("side of an image", u64::from(side), u64::from(limits.image_side));
    }
    let pixels = u64::from(size.0) * u64::from(size.1);
    let needed = pixels.saturating_mul(bytes_per_pixel);
    if needed > limits.decoded_bytes {
        return limit("decoded size of an image", needed, limits.decoded_bytes);
    }
    if pixels == 0 {
        return Err(broken(name, "has no pixels"));
    }
    if pixels > holds {
        let (w, h) = size;
        return Err(broken(name, format!("is too short for its {w} × {h} pixels")));
    }
    Ok(())
}

/// Refuses a PNG whose bytes cannot hold its pixels, or whose pixels take more than `limit` bytes.
pub(crate) fn check_png_holds(length: usize, info: &png::Info, limit: u64) -> Result<()> {
    let limits = Limits { image_side: u32::MAX, decoded_bytes: limit, ..Limits::default() };
    let bits = info.bits_per_pixel().max(1) as u64;
    let holds = (length as u64).saturating_mul(DEFLATE_RATIO * 8) / bits;
    check_size((info.width, info.height), 4, holds, "height map", &limits)
}

fn decode_png(bytes: &[u8], name: &str, limits: &Limits) -> Result<Picture> {
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
    /// RGBA with straight alpha; greys have three channels alike, what is opaque an alpha of 65535.
    pub pixels: Pixels<[u16; 4]>,
    /// Which of them the file has.
    pub channels: Channels,
}

/// Decodes a PNG file of 16 bits per channel without rounding; samples of fewer bits are spread over the same range.
///
/// `name`, limits and what is left out are those of [`decode`]; a pixel takes 8 bytes. Whether a file is so deep
/// tells [`bits_per_sample`].
///
/// # Errors
/// As [`decode`]; also [`Error::Decode`] for what is no PNG.
pub fn decode_deep(bytes: &[u8], name: &str, limits: &Limits) -> Result<DeepImage> {
    if !bytes.starts_with(PNG) {
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

/// The samples of the first picture of a PNG, palettes and transparent colours resolved, 1, 2 and 4 bits as 8, 16
/// bits as two bytes; `bytes_per_pixel` is what a pixel will take once it is decoded.
fn png_samples(
    bytes: &[u8],
    bytes_per_pixel: u64,
    name: &str,
    limits: &Limits,
) -> Result<(png::OutputInfo, Vec<u8>)> {
    let wrong = |e: png::DecodingError| broken(name, e);
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

/// Samples, each read by `v`, as RGBA; `None` for indices of a palette.
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

/// The nearest of 256 levels.
fn to_8_bit(sample: u16) -> u8 {
    ((u32::from(sample) * 255 + 32_767) / 65_535) as u8
}

/// Pixels of N samples each to RGBA.
fn pixels_of<S: Copy, T: Copy, const N: usize>(
    samples: &[S],
    value: impl Fn(S) -> T,
    rgba: impl Fn([T; N]) -> [T; 4],
) -> Vec<[T; 4]> {
    samples.as_chunks::<N>().0.iter().map(|pixel| rgba(pixel.map(&value))).collect()
}

fn decode_jpeg(bytes: &[u8], name: &str, limits: &Limits) -> Result<Picture> {
    let wrong = |e: zune_jpeg::errors::DecodeErrors| broken(name, e);
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
    // The decoder leaves grey what is not there.
    if !has_end(bytes) {
        return Err(broken(name, "is cut off: no end of image follows its last scan"));
    }
    Ok((size.0, size.1, pixels))
}

/// Whether the marker of the end of a JPEG comes after that of its last scan; in the data of a scan neither
/// can be.
fn has_end(bytes: &[u8]) -> bool {
    let last_scan = bytes.windows(2).rposition(|marker| marker == [0xff, 0xda]);
    last_scan.is_none_or(|at| bytes[at..].windows(2).any(|marker| marker == [0xff, 0xd9]))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A PNG of one row.
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
        let no = decode_deep(&jpeg_block(&[228]), "x", &Limits::default()).unwrap_err();
        assert!(no.to_string().contains("is no PNG"), "{no}");
    }

    /// A baseline JPEG of one 8 × 8 block per component, all samples of a component alike: its two
    /// Huffman tables know differences of 0, 7 and 8 bits, and the end of a block.
    fn jpeg_block(samples: &[u8]) -> Vec<u8> {
        let count = samples.len() as u8;
        let mut bytes = vec![0xff, 0xd8];
        bytes.extend(b"\xff\xee\0\x0eAdobe\0\x64\0\0\0\0\0");
        // Quantization: the constant by 8, so that a step of it is a step of the samples.
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

    /// The checksum of a PNG chunk (ISO 3309).
    fn crc(bytes: &[u8]) -> u32 {
        !bytes.iter().fold(u32::MAX, |crc, &byte| {
            (0..8).fold(crc ^ u32::from(byte), |c, _| {
                (c >> 1) ^ (0xedb8_8320 & (c & 1).wrapping_neg())
            })
        })
    }

    #[test]
    fn what_is_no_picture_is_named() {
        let error = |bytes: &[u8]| decode(bytes, "x", &Limits::default()).unwrap_err().to_string();
        assert!(error(b"").contains("neither PNG nor JPEG"));
        assert!(
            error(b"\xabKTX 20\xbb\r\n\x1a\n").contains("KTX 2 (Basis Universal) is not supported")
        );
        for start in [&b"RIFF\0\0\0\0WEBPVP8 "[..], b"GIF89a", b"BM12345678"] {
            assert!(error(start).starts_with("image `x`"), "{}", error(start));
        }
        assert!(error(&[PNG, b"rubbish"].concat()).starts_with("image `x`"));
        assert!(error(&[JPEG, b"rubbish"].concat()).starts_with("image `x`"));
    }
}
