//! Pictures with a wide range of brightness: Radiance's RGBE (.hdr, .pic).
//!
//! G. Ward, *Real Pixels*, Graphics Gems II, 1991; run-length encoding as in Radiance's `color.c`, including the older
//! form.

use crate::text::quote;
use crate::{Error, Limits, Place, Result};

/// Linear colours, row by row from the top.
#[derive(Debug, Clone, PartialEq)]
pub struct HdrPicture {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Red, green and blue, without a unit.
    pub pixels: Vec<[f32; 3]>,
}

/// Largest number of bytes of decoded pixels, independent of the limits: a panorama of 8192 × 4096 has 400 MB.
const MOST_BYTES: u64 = 1 << 30;
/// Widths whose rows may be encoded channel by channel.
const WIDTHS_BY_CHANNEL: std::ops::Range<usize> = 8..0x8000;

/// Reads a picture whose rows run from the top and from the left, as all panoramas do.
///
/// # Errors
/// [`Error::Limit`] if a side is above `limits.image_side` or the pixels above `limits.decoded_bytes` or 1 GiB,
/// [`Error::Unsupported`] for CIE colours and other orientations, [`Error::Decode`] for bytes that are no such picture
/// or end early.
pub fn read(bytes: &[u8], limits: &Limits) -> Result<HdrPicture> {
    if !bytes.starts_with(b"#?") {
        return Err(Error::whole("is no Radiance picture: it does not begin with `#?RADIANCE`"));
    }
    let mut source = Source { bytes, at: 0 };
    let exposure = header(&mut source)?;
    let (width, height) = size(source.line()?, limits)?;
    let mut pixels: Vec<[f32; 3]> = Vec::new();
    let mut row = vec![[0; 4]; width];
    for _ in 0..height {
        source.row(&mut row)?;
        pixels.extend(row.iter().map(|code| decoded(*code, exposure)));
    }
    Ok(HdrPicture { width: width as u32, height: height as u32, pixels })
}

/// Reads the header; returns the product of all exposures that were applied to the pixels.
fn header(source: &mut Source<'_>) -> Result<f32> {
    let mut exposure = 1.0;
    loop {
        let at = source.at;
        let line = source.line()?;
        if line.is_empty() {
            return Ok(exposure);
        }
        if let Some(format) = line.strip_prefix(b"FORMAT=")
            && format.trim_ascii() != b"32-bit_rle_rgbe"
        {
            let what = format!("the pixel format `{}`", quote(format));
            let hint = "32-bit_rle_rgbe is read".to_owned();
            return Err(Error::Unsupported { place: Place::Byte(at as u64), what, hint });
        }
        if let Some(value) = line.strip_prefix(b"EXPOSURE=") {
            let value = std::str::from_utf8(value).ok().and_then(|v| v.trim().parse::<f32>().ok());
            let value = value.filter(|v| *v > 0.0 && v.is_finite());
            exposure *=
                value.ok_or_else(|| Error::byte(at as u64, "EXPOSURE is not a number above 0"))?;
        }
    }
}

/// Returns the width and height from a line such as `-Y 512 +X 1024`.
fn size(line: &[u8], limits: &Limits) -> Result<(usize, usize)> {
    let text = String::from_utf8_lossy(line);
    let words: Vec<&str> = text.split_ascii_whitespace().collect();
    let [y, height, x, width] = words[..] else { return Err(no_size(line)) };
    if (y, x) != ("-Y", "+X") {
        let what = format!("the orientation `{}`", quote(line));
        let hint = "save it with rows from the top, `-Y height +X width`".to_owned();
        return Err(Error::Unsupported { place: Place::Whole, what, hint });
    }
    let number = |word: &str| word.parse::<u64>().ok().filter(|n| *n > 0);
    let (Some(width), Some(height)) = (number(width), number(height)) else {
        return Err(no_size(line));
    };
    let limit = |what, value, limit| Err(Error::Limit { place: Place::Whole, what, value, limit });
    let (side, most) = (width.max(height), u64::from(limits.image_side));
    if side > most {
        return limit("image side", side, most);
    }
    let (decoded, most) = (width.saturating_mul(height * 12), limits.decoded_bytes.min(MOST_BYTES));
    if decoded > most {
        return limit("decoded size", decoded, most);
    }
    Ok((width as usize, height as usize))
}

fn no_size(line: &[u8]) -> Error {
    Error::whole(format!("`{}` is not a size such as `-Y 512 +X 1024`", quote(line)))
}

/// Returns a colour from three mantissas and their common exponent.
fn decoded([r, g, b, exponent]: [u8; 4], exposure: f32) -> [f32; 3] {
    if exponent == 0 {
        return [0.0; 3];
    }
    // Finite, so that nothing times it is nothing.
    let scale = (libm::scalbnf(1.0, i32::from(exponent) - 136) / exposure).min(f32::MAX);
    [r, g, b].map(|mantissa| f32::from(mantissa) * scale)
}

/// Bytes that are read from the front.
struct Source<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> Source<'a> {
    fn error(&self, message: &str) -> Error {
        Error::byte(self.at as u64, message)
    }

    fn next(&mut self) -> Result<u8> {
        let byte = self.bytes.get(self.at).copied();
        let byte = byte.ok_or_else(|| self.error("the file ends within its pixels"))?;
        self.at += 1;
        Ok(byte)
    }

    fn code(&mut self) -> Result<[u8; 4]> {
        Ok([self.next()?, self.next()?, self.next()?, self.next()?])
    }

    /// Returns a line of the header, without its end.
    fn line(&mut self) -> Result<&'a [u8]> {
        let rest = self.bytes.get(self.at..).unwrap_or_default();
        let length = rest.iter().position(|byte| *byte == b'\n');
        let length = length.ok_or_else(|| self.error("the file ends within its header"))?;
        self.at += length + 1;
        let line = &rest[..length];
        Ok(line.strip_suffix(b"\r").unwrap_or(line))
    }

    /// Reads the codes of a row.
    fn row(&mut self, row: &mut [[u8; 4]]) -> Result<()> {
        let first = self.code()?;
        let [a, b, high, low] = first.map(usize::from);
        let by_channel = [a, b] == [2, 2] && high < 128;
        if by_channel && WIDTHS_BY_CHANNEL.contains(&row.len()) {
            if (high << 8 | low) != row.len() {
                return Err(self.error("a row is not as long as the picture is wide"));
            }
            return (0..4).try_for_each(|channel| self.channel(row, channel));
        }
        self.codes(first, row)
    }

    /// Reads one channel of a row, in runs and sequences.
    fn channel(&mut self, row: &mut [[u8; 4]], channel: usize) -> Result<()> {
        let mut x = 0;
        while x < row.len() {
            let count = usize::from(self.next()?);
            let (count, run) = if count > 128 { (count - 128, true) } else { (count, false) };
            let Some(codes) = row.get_mut(x..x + count).filter(|_| count > 0) else {
                return Err(self.error("a run is empty or reaches beyond its row"));
            };
            let repeated = if run { self.next()? } else { 0 };
            for code in codes {
                code[channel] = if run { repeated } else { self.next()? };
            }
            x += count;
        }
        Ok(())
    }

    /// Reads whole codes from `first` on; (1, 1, 1, n) repeats the one before n times.
    fn codes(&mut self, first: [u8; 4], row: &mut [[u8; 4]]) -> Result<()> {
        let (mut x, mut shift, mut code) = (0_usize, 0_u32, first);
        loop {
            if let [1, 1, 1, count] = code {
                let count = usize::from(count) << shift;
                let last = x.checked_sub(1).and_then(|x| row.get(x).copied());
                let (Some(last), Some(codes)) = (last, row.get_mut(x..x.saturating_add(count)))
                else {
                    return Err(self.error("a run has no colour or reaches beyond its row"));
                };
                codes.fill(last);
                (x, shift) = (x + count, (shift + 8).min(24));
            } else {
                row[x] = code;
                (x, shift) = (x + 1, 0);
            }
            if x >= row.len() {
                return Ok(());
            }
            code = self.code()?;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(header: &str, pixels: &[u8]) -> Vec<u8> {
        [header.as_bytes(), pixels].concat()
    }

    fn picture(header: &str, pixels: &[u8]) -> Result<HdrPicture> {
        read(&file(header, pixels), &Limits::default())
    }

    const FLAT: &str = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 3\n";

    #[test]
    fn flat_codes_and_old_runs() {
        let found = picture(FLAT, &[128, 64, 0, 129, 1, 1, 1, 1, 5, 6, 7, 0]).unwrap();
        assert_eq!((found.width, found.height), (3, 1));
        assert_eq!(found.pixels, [[1.0, 0.5, 0.0], [1.0, 0.5, 0.0], [0.0; 3]]);
        let brighter = FLAT.replace("\n\n", "\nEXPOSURE=0.5\n\n");
        let found = picture(&brighter, &[128, 0, 0, 129, 1, 1, 1, 2]).unwrap();
        assert_eq!(found.pixels, [[2.0, 0.0, 0.0]; 3]);
    }

    #[test]
    fn rows_by_channel() {
        let header = "#?RGBE\n# a comment\n\n-Y 2 +X 8\n";
        let row = [2, 2, 0, 8, 136, 128, 2, 10, 20, 134, 30, 136, 0, 136, 128];
        let found = picture(header, &[row, row].concat()).unwrap();
        assert_eq!(found.pixels.len(), 16);
        assert_eq!(found.pixels[8], [0.5, 10.0 / 256.0, 0.0]);
        assert_eq!(found.pixels[15], [0.5, 30.0 / 256.0, 0.0]);
    }

    #[test]
    fn what_is_wrong_is_said() {
        let short = picture(FLAT, &[1, 2, 3, 4, 5]).unwrap_err().to_string();
        assert!(short.contains("ends within"), "{short}");
        for (header, part) in [
            ("P6\n", "RADIANCE"),
            ("#?RADIANCE\n", "header"),
            ("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n", "xyze"),
            ("#?RADIANCE\nEXPOSURE=-1\n\n", "EXPOSURE"),
            ("#?RADIANCE\n\n+X 3 -Y 1\n", "orientation"),
            ("#?RADIANCE\n\n-Y 0 +X 1\n", "not a size"),
            ("#?RADIANCE\n\n-Y 99999 +X 1\n", "image side"),
            ("#?RADIANCE\n\n-Y 16000 +X 16000\n", "decoded size"),
            ("#?RADIANCE\n\n-Y 1 +X 3\n\u{1}\u{1}\u{1}\u{1}", "no colour"),
            ("#?RADIANCE\n\n-Y 1 +X 9\n\u{2}\u{2}\0\u{8}", "not as long"),
            ("#?RADIANCE\n\n-Y 1 +X 8\n\u{2}\u{2}\0\u{8}\0", "empty"),
        ] {
            let error = picture(header, &[]).unwrap_err().to_string();
            assert!(error.contains(part), "{header:?}: {error}");
        }
    }

    #[test]
    fn broken_bytes_do_no_harm() {
        let row = [2, 2, 0, 8, 136, 128, 2, 10, 20, 134, 30, 136, 0, 136, 128];
        let whole = file("#?RGBE\n\n-Y 1 +X 8\n", &row);
        for i in 0..whole.len() {
            let _ = read(&whole[..i], &Limits::default());
            for value in [0, 1, 127, 128, 255] {
                let mut bytes = whole.clone();
                bytes[i] = value;
                let _ = read(&bytes, &Limits::default());
            }
        }
    }
}
