//! Planes of pixels to PNG (ISO/IEC 15948).
//!
//! All writers take row 0 as the top row, write no time stamp and give the same bytes for the same
//! pixels. Memory: one row, and the compressor's state (about 100 kB); cost: one pass.

use crate::budget::DECODED;
use crate::foreign;
use crate::{Error, Limits, Result};
use durer::target::{NO_ITEM, Pixels};
use png::{BitDepth, ColorType, Encoder, EncodingError, Filter, SrgbRenderingIntent};
use std::io::Write;

/// Effort of the writer to make the file small.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Compression {
    /// A DEFLATE made for PNG: some twenty times faster, files a quarter to a half larger.
    #[default]
    Fast,
    /// zlib's level 6 with a filter chosen for each row.
    Small,
}

/// The colour that means "no item" in an item picture; items are below it.
pub const ITEM_BACKGROUND: u32 = 0x00ff_ffff;

/// The grey that means "nothing" in a depth picture: the far plane.
pub const DEPTH_BACKGROUND: u16 = u16::MAX;

/// IDAT chunks of this size: large enough that their headers do not count.
const CHUNK_BYTES: usize = 256 * 1024;

/// Writes sRGB colours with straight alpha, 8 bits each; without the alpha channel where all of the picture is opaque.
/// The `sRGB` chunk defines the meaning of the numbers.
///
/// ```
/// use durer::target::Pixels;
/// use durer_formats::png::{Compression, write_color};
/// let mut bytes = Vec::new();
/// write_color(&mut bytes, &Pixels::new(2, 1, [255, 0, 0, 255]), Compression::Fast)?;
/// assert!(bytes.starts_with(b"\x89PNG"));
/// # Ok::<(), durer_formats::Error>(())
/// ```
///
/// # Errors
/// [`Error::Library`] for a picture without pixels, [`Error::Io`] if writing fails.
pub fn write_color<W: Write>(
    out: W,
    pixels: &Pixels<[u8; 4]>,
    compression: Compression,
) -> Result<()> {
    // Row by row, as a loop that may end at any pixel looks at one pixel at a time.
    let mut rows = (0..pixels.height()).map(|y| pixels.row(y));
    // Whole pixels: combining parts of them would be slower.
    let all = |row: &[[u8; 4]]| row.iter().fold(!0, |all, &p| all & u32::from_ne_bytes(p));
    let opaque = rows.all(|row| all(row).to_ne_bytes()[3] == 255);
    let color = if opaque { ColorType::Rgb } else { ColorType::Rgba };
    let kind = Kind { color, depth: BitDepth::Eight, srgb: true };
    if opaque {
        write_rows(out, pixels, kind, compression, without_alpha)
    } else {
        write(out, pixels, kind, compression, |pixel| pixel)
    }
}

/// Copies the first three bytes of each pixel; both rows have the same length.
fn without_alpha(row: &[[u8; 4]], bytes: &mut [[u8; 3]]) {
    let Some((last, others)) = row.split_last() else { return };
    let bytes = bytes.as_flattened_mut();
    // All four at once: the next pixel overwrites the fourth.
    for (i, pixel) in others.iter().enumerate() {
        bytes[3 * i..][..4].copy_from_slice(pixel);
    }
    bytes[3 * others.len()..][..3].copy_from_slice(&last[..3]);
}

/// Channels of a PNG beside a grey one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct Channels {
    /// Red, green and blue instead of grey.
    pub color: bool,
    /// Alpha.
    pub alpha: bool,
}

/// Writes sRGB colours with straight alpha, 16 bits each. If the file has no channel for them, the red one is taken as
/// grey, and alpha is left out.
///
/// # Errors
/// As [`write_color`].
pub fn write_deep_color<W: Write>(
    out: W,
    pixels: &Pixels<[u16; 4]>,
    channels: Channels,
    compression: Compression,
) -> Result<()> {
    let kind = |color| Kind { color, depth: BitDepth::Sixteen, srgb: true };
    match (channels.color, channels.alpha) {
        (false, false) => {
            let kind = kind(ColorType::Grayscale);
            write(out, pixels, kind, compression, |[g, ..]| g.to_be_bytes())
        }
        (false, true) => {
            let kind = kind(ColorType::GrayscaleAlpha);
            write(out, pixels, kind, compression, |[g, .., a]| big_endian::<2, 4>([g, a]))
        }
        (true, false) => {
            let kind = kind(ColorType::Rgb);
            write(out, pixels, kind, compression, |[r, g, b, _]| big_endian::<3, 6>([r, g, b]))
        }
        (true, true) => write(out, pixels, kind(ColorType::Rgba), compression, big_endian::<4, 8>),
    }
}

/// Returns the bytes of two-byte numbers, the higher one first.
fn big_endian<const N: usize, const BYTES: usize>(samples: [u16; N]) -> [u8; BYTES] {
    let bytes = samples.map(u16::to_be_bytes);
    std::array::from_fn(|i| bytes[i / 2][i % 2])
}

/// Writes window depths 0…1 as 16-bit grey: depth × 65535, rounded to nearest; NaN becomes [`DEPTH_BACKGROUND`].
///
/// # Errors
/// As [`write_color`].
pub fn write_depth<W: Write>(out: W, pixels: &Pixels<f32>, compression: Compression) -> Result<()> {
    let kind = Kind { color: ColorType::Grayscale, depth: BitDepth::Sixteen, srgb: false };
    write(out, pixels, kind, compression, |depth| {
        let grey = if depth.is_nan() {
            DEPTH_BACKGROUND
        } else {
            (f64::from(depth).clamp(0.0, 1.0) * 65535.0).round() as u16
        };
        grey.to_be_bytes()
    })
}

/// Reads window depths as [`write_depth`] writes them: a 16-bit grey PNG, 65535 for depth 1.
///
/// # Errors
/// [`Error::Limit`] for more pixels than `limits.decoded_bytes` hold at 4 bytes each or a side above
/// `limits.image_side`, [`Error::Decode`] for bytes that are broken or no 16-bit grey PNG.
pub fn read_depth(bytes: &[u8], limits: &Limits) -> Result<Pixels<f32>> {
    let wrong =
        |e: png::DecodingError| Error::whole(format!("the depth picture {}", foreign::png(&e)));
    let memory = usize::try_from(limits.decoded_bytes).unwrap_or(usize::MAX);
    let input = std::io::Cursor::new(bytes);
    let mut decoder = png::Decoder::new_with_limits(input, png::Limits { bytes: memory });
    decoder.set_ignore_text_chunk(true);
    decoder.set_ignore_iccp_chunk(true);
    let info = decoder.read_header_info().map_err(wrong)?;
    let (width, height) = (info.width, info.height);
    if (info.color_type, info.bit_depth) != (ColorType::Grayscale, BitDepth::Sixteen) {
        let message =
            "the depth picture is not a 16-bit grey PNG, as `durer render --depth` writes";
        return Err(Error::whole(message.to_owned()));
    }
    let needed = u64::from(width) * u64::from(height) * 4;
    if width.max(height) > limits.image_side || needed > limits.decoded_bytes {
        let (what, value, limit) = ("size of a depth picture", needed, limits.decoded_bytes);
        return Err(Error::Limit { place: crate::Place::Whole, what, value, limit });
    }
    limits.work.keep(DECODED, needed)?;
    limits.work.charge(DECODED, needed)?;
    let mut reader = decoder.read_info().map_err(wrong)?;
    let length = reader.output_buffer_size().unwrap_or(0);
    let mut samples = vec![0; length];
    reader.next_frame(&mut samples).map_err(wrong)?;
    let depths = samples.as_chunks().0.iter().map(|&s| f32::from(u16::from_be_bytes(s)) / 65535.0);
    Ok(Pixels::from_data(width, height, depths.collect())?)
}

/// Writes unit normals as 8-bit colours: each component n as (n · 0.5 + 0.5) · 255, rounded. At background pixels, the
/// zero vector becomes (128, 128, 128), which no unit normal does.
///
/// # Errors
/// As [`write_color`].
pub fn write_normals<W: Write>(
    out: W,
    pixels: &Pixels<[f32; 3]>,
    compression: Compression,
) -> Result<()> {
    let kind = Kind { color: ColorType::Rgb, depth: BitDepth::Eight, srgb: false };
    let channel = |n: f32| ((n * 0.5 + 0.5).clamp(0.0, 1.0) * 255.0).round() as u8;
    write(out, pixels, kind, compression, |normal| normal.map(channel))
}

/// Writes item indices as 8-bit colours R<<16 | G<<8 | B; [`ITEM_BACKGROUND`] at background pixels.
///
/// # Errors
/// [`Error::Limit`] for an index that does not fit below [`ITEM_BACKGROUND`], else as
/// [`write_color`].
pub fn write_items<W: Write>(out: W, pixels: &Pixels<u32>, compression: Compression) -> Result<()> {
    let fits = |item: u32| item == NO_ITEM || item < ITEM_BACKGROUND;
    if let Some(&item) = pixels.data().iter().find(|&&item| !fits(item)) {
        return Err(too_many_items(item));
    }
    let kind = Kind { color: ColorType::Rgb, depth: BitDepth::Eight, srgb: false };
    write(out, pixels, kind, compression, |item| {
        // The lower 24 bits of [`NO_ITEM`] are [`ITEM_BACKGROUND`].
        let [_, r, g, b] = item.to_be_bytes();
        [r, g, b]
    })
}

fn too_many_items(item: u32) -> Error {
    Error::Limit {
        place: crate::Place::Whole,
        what: "index of an item",
        value: u64::from(item),
        limit: u64::from(ITEM_BACKGROUND) - 1,
    }
}

/// Kind of pixels according to the header.
struct Kind {
    color: ColorType,
    depth: BitDepth,
    srgb: bool,
}

/// Writes row after row, each made of the bytes that `encode` returns for its pixels. Their fixed number per pixel lets
/// the compiler vectorize.
fn write<W: Write, T: Copy, const BYTES: usize>(
    out: W,
    pixels: &Pixels<T>,
    kind: Kind,
    compression: Compression,
    encode: impl Fn(T) -> [u8; BYTES],
) -> Result<()> {
    write_rows(out, pixels, kind, compression, |row, bytes| {
        for (bytes, &pixel) in bytes.iter_mut().zip(row) {
            *bytes = encode(pixel);
        }
    })
}

/// Writes pixels as [`write`] does, with rows encoded as a whole.
fn write_rows<W: Write, T: Copy, const BYTES: usize>(
    out: W,
    pixels: &Pixels<T>,
    kind: Kind,
    compression: Compression,
    encode: impl Fn(&[T], &mut [[u8; BYTES]]),
) -> Result<()> {
    if pixels.width() == 0 || pixels.height() == 0 {
        let size = format!("{}x{}", pixels.width(), pixels.height());
        return Err(durer::Error::parameter("size", size, "at least 1x1 for a PNG").into());
    }
    let mut encoder = Encoder::new(out, pixels.width(), pixels.height());
    encoder.set_color(kind.color);
    encoder.set_depth(kind.depth);
    if kind.srgb {
        encoder.set_source_srgb(SrgbRenderingIntent::Perceptual);
    }
    set_compression(&mut encoder, compression);
    let mut writer = encoder.write_header().map_err(encoding)?;
    let mut stream = writer.stream_writer_with_size(CHUNK_BYTES).map_err(encoding)?;
    let mut row = vec![[0; BYTES]; pixels.width() as usize];
    for y in 0..pixels.height() {
        encode(pixels.row(y), &mut row);
        stream.write_all(row.as_flattened())?;
    }
    stream.finish().map_err(encoding)?;
    writer.finish().map_err(encoding)
}

/// Sets the effort of an encoder.
pub(crate) fn set_compression<W: Write>(encoder: &mut Encoder<W>, compression: Compression) {
    match compression {
        Compression::Fast => {
            encoder.set_compression(png::Compression::Fast);
            encoder.set_filter(Filter::Up);
        }
        Compression::Small => encoder.set_compression(png::Compression::Balanced),
    }
}

pub(crate) fn encoding(error: EncodingError) -> Error {
    match error {
        EncodingError::IoError(error) => Error::Io(error),
        _ => Error::whole(foreign::REFUSED),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn decode(bytes: &[u8]) -> (png::OutputInfo, Vec<u8>, bool) {
        let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().unwrap();
        let mut data = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut data).unwrap();
        data.truncate(info.buffer_size());
        (info, data, reader.info().srgb.is_some())
    }

    #[test]
    fn depths_come_back_as_they_were_written() {
        let pixels = noise(13, 9, |h| (h >> 16) as f32 / 65535.0);
        let mut bytes = Vec::new();
        write_depth(&mut bytes, &pixels, Compression::Fast).unwrap();
        assert_eq!(read_depth(&bytes, &Limits::default()).unwrap(), pixels);
        let small = Limits { decoded_bytes: 100, ..Limits::default() };
        assert!(read_depth(&bytes, &small).is_err());
        assert!(read_depth(&bytes[..60], &Limits::default()).is_err());
        let mut colors = Vec::new();
        write_color(&mut colors, &Pixels::new(2, 2, [9; 4]), Compression::Fast).unwrap();
        let error = read_depth(&colors, &Limits::default()).unwrap_err().to_string();
        assert!(error.contains("16-bit"), "{error}");
    }

    /// Returns pixels that differ, so that a wrong order shows.
    fn noise<T: Copy>(width: u32, height: u32, f: impl Fn(u32) -> T) -> Pixels<T> {
        let data = (0..width * height).map(|i| f(i.wrapping_mul(2_654_435_761))).collect();
        Pixels::from_data(width, height, data).unwrap()
    }

    #[test]
    fn colors_come_back_with_and_without_alpha() {
        for compression in [Compression::Fast, Compression::Small] {
            let pixels = noise(33, 17, |h| h.to_le_bytes());
            let mut bytes = Vec::new();
            write_color(&mut bytes, &pixels, compression).unwrap();
            let (info, data, srgb) = decode(&bytes);
            assert_eq!((info.width, info.height, info.color_type), (33, 17, ColorType::Rgba));
            assert!(srgb && data == pixels.data().concat());

            let opaque = noise(33, 17, |h| (h | 0xff00_0000).to_le_bytes());
            let mut bytes = Vec::new();
            write_color(&mut bytes, &opaque, compression).unwrap();
            let (info, data, _) = decode(&bytes);
            let rgb: Vec<u8> = opaque.data().iter().flat_map(|p| p[..3].to_vec()).collect();
            assert!(info.color_type == ColorType::Rgb && data == rgb);
        }
    }

    #[test]
    fn depths_are_rounded_to_sixteen_bits() {
        let depths = vec![0.0, 1.0, 0.5, f32::NAN, -1.0, 2.0, 1.49 / 65535.0, 1.51 / 65535.0];
        let mut bytes = Vec::new();
        let pixels = Pixels::from_data(8, 1, depths).unwrap();
        write_depth(&mut bytes, &pixels, Compression::Fast).unwrap();
        let (info, data, srgb) = decode(&bytes);
        let grey: Vec<u16> = data.chunks(2).map(|b| u16::from_be_bytes([b[0], b[1]])).collect();
        assert_eq!(info.bit_depth, BitDepth::Sixteen);
        assert!(!srgb, "depths are not colours");
        assert_eq!(grey, [0, 65535, 32768, 65535, 0, 65535, 1, 2]);
    }

    #[test]
    fn normals_fill_the_range_of_a_byte() {
        let normals = vec![[1.0, -1.0, 0.0], [0.0; 3], [0.0, 0.96, -0.28]];
        let mut bytes = Vec::new();
        let pixels = Pixels::from_data(3, 1, normals).unwrap();
        write_normals(&mut bytes, &pixels, Compression::Fast).unwrap();
        assert_eq!(decode(&bytes).1, [255, 0, 128, 128, 128, 128, 128, 250, 92]);
    }

    #[test]
    fn items_are_24_bit_numbers_and_no_more() {
        let items = vec![0, 0x0001_0203, ITEM_BACKGROUND - 1, NO_ITEM];
        let mut bytes = Vec::new();
        let pixels = Pixels::from_data(2, 2, items).unwrap();
        write_items(&mut bytes, &pixels, Compression::Fast).unwrap();
        assert_eq!(decode(&bytes).1, [0, 0, 0, 1, 2, 3, 255, 255, 254, 255, 255, 255]);

        let too_many = Pixels::new(1, 1, ITEM_BACKGROUND);
        let error = write_items(Vec::new(), &too_many, Compression::Fast).unwrap_err();
        assert!(error.to_string().contains("16777215, above the limit of 16777214"), "{error}");
    }

    #[test]
    fn same_pixels_same_bytes_and_no_empty_pictures() {
        let pixels = noise(64, 64, |h| h.to_le_bytes());
        let (mut a, mut b) = (Vec::new(), Vec::new());
        write_color(&mut a, &pixels, Compression::Fast).unwrap();
        write_color(&mut b, &pixels, Compression::Fast).unwrap();
        assert_eq!(a, b);
        let empty = Pixels::new(0, 7, [0; 4]);
        let error = write_color(Vec::new(), &empty, Compression::Fast).unwrap_err();
        assert!(error.to_string().contains("0x7"), "{error}");
    }

    #[test]
    fn a_full_disk_is_an_io_error() {
        struct Full;
        impl Write for Full {
            fn write(&mut self, _: &[u8]) -> std::io::Result<usize> {
                Err(std::io::ErrorKind::StorageFull.into())
            }
            fn flush(&mut self) -> std::io::Result<()> {
                Ok(())
            }
        }
        let error = write_color(Full, &Pixels::new(2, 2, [0; 4]), Compression::Fast).unwrap_err();
        assert!(matches!(error, Error::Io(e) if e.kind() == std::io::ErrorKind::StorageFull));
    }
}
