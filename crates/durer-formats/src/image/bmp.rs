//! Windows bitmaps: palettes, 16, 24 and 32 bits, bit fields, and run-length encoding of 4 and 8 bits.
//!
//! Source: Microsoft, *Bitmap Storage* (BITMAPCOREHEADER to BITMAPV5HEADER).

use super::bytes::Bytes;
use super::{Picture, broken, check_size, place};
use crate::{Error, Limits, Result};

/// The first bytes.
pub(super) const MAGIC: &[u8] = b"BM";
/// The length of the file's header, which precedes the picture's.
const FILE_HEADER: usize = 14;
/// Two bytes of a run hold up to 255 pixels, and four leave out up to 255 rows.
const RUN_PIXELS_PER_BYTE: u64 = 1 << 20;

/// Storage of pixels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Packing {
    Plain,
    Runs,
    /// Masks of red, green, blue and alpha.
    Fields([u32; 4]),
}

struct Header {
    width: u32,
    height: u32,
    from_top: bool,
    bits: u32,
    packing: Packing,
    palette: Vec<[u8; 4]>,
    /// Offset of the pixels.
    start: usize,
}

/// Decodes a file.
///
/// # Errors
/// As [`super::decode`].
pub(super) fn decode(bytes: &[u8], name: &str, limits: &Limits) -> Result<Picture> {
    let cut_off = || broken(name, "is cut off");
    let header = header(bytes, name)?;
    let data = bytes.get(header.start..).ok_or_else(cut_off)?;
    let (bits, length) = (u64::from(header.bits), data.len() as u64);
    let holds = match header.packing {
        Packing::Runs => length.saturating_mul(RUN_PIXELS_PER_BYTE),
        _ => length.saturating_mul(8) / bits,
    };
    check_size((header.width, header.height), 4, holds, name, limits)?;
    let (width, height) = (header.width as usize, header.height as usize);
    let mut pixels = match header.packing {
        Packing::Runs => runs(&header, data),
        _ => {
            let row = (width * header.bits as usize).div_ceil(32) * 4;
            let rows = data.chunks(row).take(height);
            let pixels: Vec<_> = rows.flat_map(|row| row_pixels(&header, row)).collect();
            (pixels.len() == width * height).then_some(pixels)
        }
    }
    .ok_or_else(cut_off)?;
    if !header.from_top {
        flip(&mut pixels, width);
    }
    super::show_if_all_transparent(&mut pixels);
    Ok((header.width, header.height, pixels))
}

fn long(bytes: &[u8], at: usize) -> Option<u32> {
    Some(u32::from_le_bytes(*bytes.get(at..)?.first_chunk()?))
}

fn short(bytes: &[u8], at: usize) -> Option<u16> {
    Some(u16::from_le_bytes(*bytes.get(at..)?.first_chunk()?))
}

/// Returns the numbers of the headers unchanged: width, height (negative if the first row is the upper
/// one), bits of a pixel, the number of its packing, and entries of the palette.
fn numbers(bytes: &[u8], old: bool) -> Option<(i32, i32, u16, u32, u32)> {
    let at = FILE_HEADER;
    if old {
        let side = |at| short(bytes, at).map(i32::from);
        return Some((side(at + 4)?, side(at + 6)?, short(bytes, at + 10)?, 0, 0));
    }
    let side = |at| long(bytes, at).map(u32::cast_signed);
    let (bits, packing) = (short(bytes, at + 14)?, long(bytes, at + 16)?);
    Some((side(at + 4)?, side(at + 8)?, bits, packing, long(bytes, at + 32)?))
}

fn header(bytes: &[u8], name: &str) -> Result<Header> {
    let cut_off = || broken(name, "is cut off");
    let start = long(bytes, 10).ok_or_else(cut_off)? as usize;
    let size = long(bytes, FILE_HEADER).ok_or_else(cut_off)? as usize;
    let old = size == 12;
    let (width, height, bits, packing, colors) = numbers(bytes, old).ok_or_else(cut_off)?;
    let bits = u32::from(bits);
    let packing = match (packing, bits) {
        (0, 16) => Packing::Fields([0x7c00, 0x3e0, 0x1f, 0]),
        (0, 32) => Packing::Fields([0xff_0000, 0xff00, 0xff, 0]),
        (0, 1 | 2 | 4 | 8 | 24) => Packing::Plain,
        (1, 8) | (2, 4) => Packing::Runs,
        (3 | 6, 16 | 32) => {
            // The masks are in later headers or behind the first ones, at the same place in both cases.
            let has_alpha = packing == 6 || size >= 56;
            let field = |i: usize| long(bytes, FILE_HEADER + 40 + 4 * i).unwrap_or(0);
            Packing::Fields([field(0), field(1), field(2), if has_alpha { field(3) } else { 0 }])
        }
        _ => {
            return Err(Error::Unsupported {
                place: place(name),
                what: format!("a bitmap of {bits} bits packed by method {packing}"),
                hint: "save it as PNG".to_owned(),
            });
        }
    };
    let sides = (u32::try_from(width), i32::unsigned_abs(height));
    let (Ok(width), rows) = sides else { return Err(broken(name, "has a negative width")) };
    let most = if bits <= 8 { 1 << bits } else { 0 };
    let count = if colors == 0 { most } else { colors.min(most) } as usize;
    let entry = if old { 3 } else { 4 };
    let from = FILE_HEADER.saturating_add(size);
    let palette = bytes.get(from..).unwrap_or_default().chunks_exact(entry).take(count);
    let palette = palette.map(|e| [e[2], e[1], e[0], 255]).collect();
    Ok(Header { width, height: rows, from_top: height < 0, bits, packing, palette, start })
}

impl Header {
    /// Returns a colour of the palette; black for missing ones.
    fn color(&self, index: usize) -> [u8; 4] {
        self.palette.get(index).copied().unwrap_or([0, 0, 0, 255])
    }
}

/// Returns the pixels of a row; fewer where its bytes end.
fn row_pixels(header: &Header, row: &[u8]) -> Vec<[u8; 4]> {
    let width = header.width as usize;
    let (bits, size) = (header.bits as usize, header.bits as usize / 8);
    if let Packing::Fields(masks) = header.packing {
        let value = |p: &[u8]| p.iter().rev().fold(0, |v, &byte| v << 8 | u32::from(byte));
        return row.chunks_exact(size).take(width).map(|p| fields(value(p), masks)).collect();
    }
    if bits == 24 {
        return row.chunks_exact(3).take(width).map(|p| [p[2], p[1], p[0], 255]).collect();
    }
    let per_byte = 8 / bits.max(1);
    let mask = (1_usize << bits) - 1;
    let indices = row
        .iter()
        .flat_map(|&byte| (1..=per_byte).map(move |i| usize::from(byte) >> (8 - i * bits) & mask));
    indices.take(width).map(|i| header.color(i)).collect()
}

/// Returns the parts of a pixel by masks, each spread over a byte.
fn fields(value: u32, masks: [u32; 4]) -> [u8; 4] {
    let mut parts = masks.map(|mask| {
        let shift = mask.trailing_zeros().min(31);
        widen((value & mask) >> shift, mask >> shift)
    });
    if masks[3] == 0 {
        parts[3] = 255;
    }
    parts
}

/// Decodes run-length encoded pixels; skipped pixels have the first colour.
fn runs(header: &Header, data: &[u8]) -> Option<Vec<[u8; 4]>> {
    let (width, height) = (header.width as usize, header.height as usize);
    let mut pixels = vec![header.color(0); width * height];
    let mut data = Bytes::new(data);
    let [mut x, mut y] = [0, 0];
    let index = |bytes: &[u8], i: usize| match header.bits {
        8 => usize::from(bytes[i]),
        _ => usize::from(if i.is_multiple_of(2) { bytes[i / 2] >> 4 } else { bytes[i / 2] & 15 }),
    };
    while y < height {
        let pair = [data.byte()?, data.byte()?];
        let mut put = |color: [u8; 4]| {
            if let Some(pixel) = pixels.get_mut(y * width + x).filter(|_| x < width) {
                *pixel = color;
            }
            x += 1;
        };
        match pair {
            [0, 0] => [x, y] = [0, y + 1],
            [0, 1] => break,
            [0, 2] => [x, y] = [x + usize::from(data.byte()?), y + usize::from(data.byte()?)],
            [0, count] => {
                let count = usize::from(count);
                let length = (count * header.bits as usize).div_ceil(8);
                // Each run fills whole pairs of bytes.
                let bytes = data.take(length.next_multiple_of(2))?;
                (0..count).for_each(|i| put(header.color(index(bytes, i))));
            }
            [count, value] => {
                let colors = [0, 1].map(|i| header.color(index(&[value; 2], i)));
                (0..usize::from(count)).for_each(|i| put(colors[i % 2]));
            }
        }
    }
    Some(pixels)
}

/// Returns a value of `most` levels spread over a byte.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::decode;

    /// Returns a file with a header of 40 bytes; `between` are masks or a palette.
    fn file(size: [i32; 2], bits: u16, packing: u32, between: &[u8], data: &[u8]) -> Vec<u8> {
        let start = 54 + between.len() as u32;
        let mut bytes = b"BM\0\0\0\0\0\0\0\0".to_vec();
        bytes.extend(start.to_le_bytes());
        bytes.extend(40_u32.to_le_bytes());
        size.iter().for_each(|side| bytes.extend(side.to_le_bytes()));
        bytes.extend([1, 0]);
        bytes.extend(bits.to_le_bytes());
        bytes.extend(packing.to_le_bytes());
        bytes.extend([0; 20]);
        [&bytes, between, data].concat()
    }

    fn decoded(bytes: &[u8]) -> Vec<[u8; 4]> {
        decode(bytes, "x", &Limits::default()).unwrap().data
    }

    const PALETTE: [u8; 8] = [3, 2, 1, 0, 6, 5, 4, 0];
    const FIRST: [u8; 4] = [1, 2, 3, 255];
    const SECOND: [u8; 4] = [4, 5, 6, 255];

    #[test]
    fn every_layout_becomes_rgba() {
        let rows = [3, 2, 1, 0, 6, 5, 4, 0];
        assert_eq!(decoded(&file([1, 2], 24, 0, &[], &rows)), [SECOND, FIRST]);
        assert_eq!(decoded(&file([1, -2], 24, 0, &[], &rows)), [FIRST, SECOND]);
        assert_eq!(decoded(&file([2, 1], 32, 0, &[], &rows)), [FIRST, SECOND]);
        assert_eq!(decoded(&file([2, 1], 1, 0, &PALETTE, &[0x40, 0, 0, 0])), [FIRST, SECOND]);
        assert_eq!(decoded(&file([2, 1], 4, 0, &PALETTE, &[0x10, 0, 0, 0])), [SECOND, FIRST]);
        assert_eq!(decoded(&file([2, 1], 8, 0, &PALETTE, &[1, 0, 0, 0])), [SECOND, FIRST]);
        assert_eq!(decoded(&file([1, 1], 16, 0, &[], &[0x1f, 0x7c, 0, 0])), [[255, 0, 255, 255]]);
        let masks = [0, 0xf8, 0, 0, 0xe0, 7, 0, 0, 0x1f, 0, 0, 0];
        assert_eq!(decoded(&file([1, 1], 16, 3, &masks, &[0xe0, 7, 0, 0])), [[0, 255, 0, 255]]);
        let masks = [0xff, 0, 0, 0, 0, 0xff, 0, 0, 0, 0, 0xff, 0, 0, 0, 0, 0xff];
        assert_eq!(decoded(&file([1, 1], 32, 6, &masks, &[1, 2, 3, 4])), [[1, 2, 3, 4]]);
    }

    #[test]
    fn runs_are_unpacked() {
        // Two pixels of the second colour, a step to the right, the end of the line; then three literal pixels.
        let eight = [2, 1, 0, 2, 1, 0, 1, 1, 0, 0, 0, 3, 1, 0, 1, 0, 0, 1];
        let colors = decoded(&file([4, -2], 8, 1, &PALETTE, &eight));
        assert_eq!(colors[..4], [SECOND, SECOND, FIRST, SECOND]);
        assert_eq!(colors[4..], [SECOND, FIRST, SECOND, FIRST]);
        let four = decoded(&file([4, 1], 4, 2, &PALETTE, &[4, 0x10, 0, 1]));
        assert_eq!(four, [SECOND, FIRST, SECOND, FIRST]);
    }

    #[test]
    fn what_is_missing_or_too_much_is_reported() {
        let error = |bytes: &[u8]| decode(bytes, "x", &Limits::default()).unwrap_err().to_string();
        assert!(error(&file([1, 2], 24, 0, &[], &[1, 2, 3, 4])).contains("too short"));
        assert!(error(&file([1, 2], 8, 1, &PALETTE, &[1, 1])).contains("cut off"));
        assert!(error(&file([1, 1], 24, 5, &[], &[1, 2, 3, 4])).contains("packed by method 5"));
        assert!(error(&file([-1, 1], 24, 0, &[], &[1, 2, 3, 4])).contains("negative width"));
        assert!(error(&file([1, i32::MIN], 8, 1, &PALETTE, &[0])).contains("above the limit"));
        let whole = file([4, 1], 4, 2, &PALETTE, &[4, 0x10, 0, 1]);
        for cut in 0..whole.len() {
            assert!(decode(&whole[..cut], "x", &Limits::default()).is_err() || cut > 62, "{cut}");
        }
    }
}
