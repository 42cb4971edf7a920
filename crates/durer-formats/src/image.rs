//! Pictures that models wear: PNG, JPEG, WebP, GIF, BMP and TGA to 8-bit RGBA; and deep PNG to 16-bit RGBA.
//!
//! The format is detected by the first bytes of a file, for TGA by its whole header. Sizes are checked before anything
//! is allocated, also against the largest picture that the file's bytes can contain, so a short file cannot claim a
//! huge picture.

mod bmp;
mod bytes;
mod gif;
mod jpeg;
mod orientation;
mod png;
mod tga;
mod webp;

pub use orientation::Orientation;
pub use png::{DeepImage, bits_per_sample, decode_deep};
pub(crate) use png::{check_png_holds, is_grey};

use crate::budget::DECODED;
use crate::wording::shown;
use crate::{Error, Limits, Place, Result};
use durer::scene::Image;

/// Width, height and pixels.
type Picture = (u32, u32, Vec<[u8; 4]>);

/// Decodes a PNG, JPEG, WebP, GIF, BMP or TGA file.
///
/// Palettes, greys, CMYK (inverted, as Adobe writes it) and transparency become RGBA with straight alpha; 16-bit
/// samples are rounded to 8. The first picture of an animation is used. Neither colour profiles nor the [`Orientation`]
/// are applied. `name` names the picture in the result and, unless it is empty, in messages.
///
/// # Errors
/// [`Error::Limit`] if a side is above `limits.image_side` or the pixels above `limits.decoded_bytes`,
/// [`Error::Unsupported`] for other known picture formats, [`Error::Decode`] for broken contents. `Place` is the whole:
/// the caller knows the rest.
pub fn decode(bytes: &[u8], name: &str, limits: &Limits) -> Result<Image> {
    let starts = |magic: &[u8]| bytes.starts_with(magic);
    let (width, height, data) = match () {
        () if starts(png::MAGIC) => png::decode(bytes, name, limits)?,
        () if starts(jpeg::MAGIC) => jpeg::decode(bytes, name, limits)?,
        () if webp::is_webp(bytes) => webp::decode(bytes, name, limits)?,
        () if starts(gif::MAGIC) => gif::decode(bytes, name, limits)?,
        () if starts(bmp::MAGIC) => bmp::decode(bytes, name, limits)?,
        () => match other_format(bytes) {
            Some(format) => return Err(unsupported(name, format)),
            None if bytes.is_empty() => return Err(broken(name, "is empty")),
            None if tga::is_tga(bytes) => tga::decode(bytes, name, limits)?,
            None => return Err(broken(name, "is neither PNG nor JPEG, WebP, GIF, BMP or TGA")),
        },
    };
    Ok(Image { name: name.to_owned(), width, height, data })
}

/// Returns whether the bytes begin like a picture of any format whose beginning is unmistakable.
pub(crate) fn is_picture(bytes: &[u8]) -> bool {
    [png::MAGIC, jpeg::MAGIC, gif::MAGIC].iter().any(|magic| bytes.starts_with(magic))
        || webp::is_webp(bytes)
        || other_format(bytes).is_some()
}

fn unsupported(name: &str, format: &str) -> Error {
    let hint = "use PNG, JPEG or WebP".to_owned();
    Error::Unsupported { place: place(name), what: format!("the format {format}"), hint }
}

/// Returns the name of a picture format that is known but not read.
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

/// Makes all pixels opaque if all have an alpha of 0: many writers do not set an alpha that they do not use.
fn show_if_all_transparent(pixels: &mut [[u8; 4]]) {
    if pixels.iter().all(|pixel| pixel[3] == 0) {
        pixels.iter_mut().for_each(|pixel| pixel[3] = 255);
    }
}

/// Returns the place of a picture, if it has a name.
fn place(name: &str) -> Place {
    if name.is_empty() { Place::Whole } else { Place::Path(format!("image `{}`", shown(name))) }
}

/// Returns a decode error that names the picture, if it has a name.
fn broken(name: &str, message: impl std::fmt::Display) -> Error {
    let message = message.to_string();
    let is_said_of_it = ["is ", "has ", "holds "].iter().any(|verb| message.starts_with(verb));
    match place(name) {
        Place::Whole if is_said_of_it => Error::whole(format!("it {message}")),
        place => Error::Decode { place, message },
    }
}

/// Checks a size against the limits and against what the file's bytes can hold.
fn check_size(
    size: (u32, u32),
    bytes_per_pixel: u64,
    holds: u64,
    name: &str,
    limits: &Limits,
) -> Result<()> {
    let limit = |what, value, limit| Err(Error::Limit { place: place(name), what, value, limit });
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
    // The picture stays; while it is decoded its samples are there too.
    limits.work.keep(DECODED, needed)?;
    limits.work.charge(DECODED, needed)?;
    limits.work.room_for::<u8>(DECODED, needed)?;
    Ok(())
}

/// Converts pixels of N samples each to RGBA.
fn pixels_of<S: Copy, T: Copy, const N: usize>(
    samples: &[S],
    value: impl Fn(S) -> T,
    rgba: impl Fn([T; N]) -> [T; 4],
) -> Vec<[T; 4]> {
    samples.as_chunks::<N>().0.iter().map(|pixel| rgba(pixel.map(&value))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_picture_is_named() {
        let error = |bytes: &[u8]| decode(bytes, "x", &Limits::default()).unwrap_err().to_string();
        assert!(error(b"").contains("image `x`: is empty"));
        assert!(error(b"text").contains("neither PNG nor JPEG"));
        let unnamed = |bytes: &[u8]| decode(bytes, "", &Limits::default()).unwrap_err().to_string();
        assert_eq!(unnamed(b""), "it is empty");
        assert!(unnamed(b"DDS ").starts_with("the format DDS is not supported"));
        assert!(
            error(b"\xabKTX 20\xbb\r\n\x1a\n").contains("KTX 2 (Basis Universal) is not supported")
        );
        for start in [&b"RIFF\0\0\0\0WEBPVP8 "[..], b"GIF89a", b"BM12345678"] {
            assert!(error(start).starts_with("image `x`"), "{}", error(start));
        }
        assert!(error(&[png::MAGIC, b"rubbish"].concat()).starts_with("image `x`"));
        assert!(error(&[jpeg::MAGIC, b"rubbish"].concat()).starts_with("image `x`"));
    }
}
