//! Pictures of sRGB colours to PNG, JPEG and WebP; several of them to one [`animation`].
//!
//! All writers give the same bytes for the same pixels, on every machine.

pub mod animation;
mod gif;
mod jpeg;
mod palette;
mod webp;

use crate::png::{self, Compression};
use crate::{Error, Result};
use durer::target::Pixels;
use durer::work::Charge;
use std::io::Write;

/// The file formats of pictures.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum PictureFormat {
    /// Portable Network Graphics (ISO/IEC 15948): as the pixels are, with transparency.
    #[default]
    Png,
    /// JPEG (ITU-T T.81), baseline: smaller, about as the pixels are, without transparency.
    Jpeg,
    /// WebP (RFC 9649), without loss: as the pixels are, with transparency.
    WebP,
}

impl PictureFormat {
    /// All formats.
    pub const ALL: &'static [Self] = &[Self::Png, Self::Jpeg, Self::WebP];

    /// Returns the name used on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Png => "png",
            Self::Jpeg => "jpeg",
            Self::WebP => "webp",
        }
    }

    /// Returns the endings of its files' names, lower case, without a dot; the first is the usual
    /// one.
    pub const fn suffixes(self) -> &'static [&'static str] {
        match self {
            Self::Png => &["png"],
            Self::Jpeg => &["jpg", "jpeg"],
            Self::WebP => &["webp"],
        }
    }

    /// Returns the format of a file name's suffix, without its dot, in any case.
    pub fn of_suffix(suffix: &str) -> Option<Self> {
        let lower = suffix.to_ascii_lowercase();
        Self::ALL.iter().copied().find(|f| f.suffixes().contains(&lower.as_str()))
    }

    /// Returns the largest width and height that it can say, in pixels.
    pub const fn max_side(self) -> u32 {
        match self {
            Self::Png => i32::MAX.unsigned_abs(),
            Self::Jpeg => u16::MAX as u32,
            Self::WebP => webp::MAX_SIDE,
        }
    }
}

/// Options for encoding pictures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Encoding {
    /// Effort of compression of a PNG; it changes no pixel.
    pub compression: Compression,
    /// Quality of JPEG: 1, small and coarse, to 100, large and fine. From 90 on colours are as fine as
    /// brightness.
    pub quality: u8,
}

impl Default for Encoding {
    /// Returns the default: fast, and of a quality at which pictures look the same.
    fn default() -> Self {
        Self { compression: Compression::Fast, quality: 90 }
    }
}

/// Writes sRGB colours with straight alpha, 8 bits each, row 0 at the top. Returns whether transparent parts
/// had to be laid onto white, as JPEG has no transparency.
///
/// ```
/// use durer::target::Pixels;
/// use durer_formats::picture::{Encoding, PictureFormat, write};
/// let (mut bytes, clear) = (Vec::new(), Pixels::new(2, 1, [255, 0, 0, 0]));
/// assert!(write(&mut bytes, PictureFormat::Jpeg, &clear, &Encoding::default())?);
/// assert!(bytes.starts_with(b"\xff\xd8\xff"));
/// # Ok::<(), durer_formats::Error>(())
/// ```
///
/// # Errors
/// [`Error::Library`] for a picture without pixels, or with more along a side than the format can say;
/// [`Error::Io`] if writing fails, and where the budget that the picture was charged to has no room for its encoder.
pub fn write<W: Write>(
    out: W,
    format: PictureFormat,
    pixels: &Pixels<[u8; 4]>,
    encoding: &Encoding,
) -> Result<bool> {
    match format {
        PictureFormat::Png => png::write_color(out, pixels, encoding.compression).map(|()| false),
        PictureFormat::Jpeg => jpeg::write(out, pixels, encoding),
        PictureFormat::WebP => webp::write(out, pixels).map(|()| false),
    }
}

/// Returns the width and height, where the picture has pixels and a format can say how many.
fn sides(pixels: &Pixels<[u8; 4]>, max: u32, expected: &'static str) -> Result<(u32, u32)> {
    let (width, height) = (pixels.width(), pixels.height());
    if width.min(height) == 0 || width.max(height) > max {
        let size = format!("{width}x{height}");
        return Err(durer::Error::parameter("size", size, expected).into());
    }
    Ok((width, height))
}

/// Charges bytes for each pixel of a picture that is encoded to the budget of its plane.
fn charged(pixels: &Pixels<[u8; 4]>, per_pixel: u64) -> Result<Charge> {
    let count = u64::from(pixels.width()) * u64::from(pixels.height());
    Ok(pixels.work().charge("encoded picture", count.saturating_mul(per_pixel))?)
}

/// Returns whether each pixel is opaque.
fn is_opaque(pixels: &Pixels<[u8; 4]>) -> bool {
    let rows = (0..pixels.height()).map(|y| pixels.row(y));
    let mut least = rows.map(|row| row.iter().fold(255, |least, p| p[3].min(least)));
    least.all(|alpha| alpha == 255)
}

/// Converts an encoder's error other than a failed write.
fn refused(_: impl std::fmt::Display) -> Error {
    Error::whole(crate::foreign::REFUSED)
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use durer::work::Work;

    /// Returns smooth colours, with a line that is half transparent.
    pub fn shades(width: u32, height: u32) -> Pixels<[u8; 4]> {
        let mut pixels = Pixels::new(width, height, [255; 4]);
        for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
            let alpha = if y == 1 { 100 } else { 255 };
            let byte = |n: u32| (n % 256) as u8;
            pixels.set(x, y, [byte(x * 5), byte(y * 7), byte(x * 2 + y), alpha]);
        }
        pixels
    }

    #[test]
    fn suffixes_and_names_lead_to_formats() {
        for &format in PictureFormat::ALL {
            for suffix in format.suffixes() {
                assert_eq!(PictureFormat::of_suffix(&suffix.to_uppercase()), Some(format));
            }
        }
        assert_eq!(PictureFormat::of_suffix("gif"), None);
    }

    #[test]
    fn encoders_charge_to_the_budget_of_the_picture() {
        let bytes = 64 * 64 * 4;
        let work = Work::with_budget(bytes + 1000, "--max-memory");
        let pixels = Pixels::within((&work, "picture"), 64, 64, [1, 2, 3, 255]).unwrap();
        for format in [PictureFormat::Jpeg, PictureFormat::WebP] {
            let error = write(Vec::new(), format, &pixels, &Encoding::default()).unwrap_err();
            assert!(error.to_string().starts_with("encoded picture: "), "{error}");
            assert_eq!(work.used(), bytes);
        }
        // A row at a time.
        write(Vec::new(), PictureFormat::Png, &pixels, &Encoding::default()).unwrap();
    }

    #[test]
    fn sizes_that_a_format_cannot_say_are_refused() {
        for (format, side) in [(PictureFormat::Jpeg, 65_536), (PictureFormat::WebP, 16_385)] {
            for (width, height) in [(side, 1), (1, side), (0, 1)] {
                let pixels = Pixels::new(width, height, [0; 4]);
                let error = write(Vec::new(), format, &pixels, &Encoding::default()).unwrap_err();
                let expected = if width == 0 { "0x1" } else { "pixels along a side" };
                assert!(error.to_string().contains(expected), "{error}");
            }
            let mut bytes = Vec::new();
            let row = Pixels::new(side - 1, 1, [7, 8, 9, 255]);
            write(&mut bytes, format, &row, &Encoding::default()).unwrap();
            assert!(!bytes.is_empty());
        }
    }
}
