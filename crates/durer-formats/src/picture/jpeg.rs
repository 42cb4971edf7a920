//! JPEG, by the crate `image`: baseline, with colours as fine as brightness.

use super::{Encoding, charged, is_opaque, refused, sides};
use crate::{Error, Result};
use ::image::codecs::jpeg::JpegEncoder;
use ::image::{ExtendedColorType, ImageError};
use durer::target::Pixels;
use std::borrow::Cow;
use std::io::Write;

/// Writes a picture; returns whether it had to be laid onto white.
pub fn write<W: Write>(out: W, pixels: &Pixels<[u8; 4]>, encoding: &Encoding) -> Result<bool> {
    let expected = "1x1 to 65535x65535 for a JPEG, which has room for no more pixels along a side";
    let sides = sides(pixels, u32::from(u16::MAX), expected)?;
    // Colours without alpha, and the picture on white.
    let _room = charged(pixels, if is_opaque(pixels) { 3 } else { 7 })?;
    let colors = on_white(pixels);
    let rgb: Vec<u8> = colors.data().iter().flat_map(|[r, g, b, _]| [*r, *g, *b]).collect();
    let mut encoder = JpegEncoder::new_with_quality(out, encoding.quality.clamp(1, 100));
    encoder.encode(&rgb, sides.0, sides.1, ExtendedColorType::Rgb8).map_err(failed)?;
    Ok(matches!(colors, Cow::Owned(_)))
}

/// Returns the picture as viewers show it on white.
fn on_white(pixels: &Pixels<[u8; 4]>) -> Cow<'_, Pixels<[u8; 4]>> {
    if is_opaque(pixels) {
        return Cow::Borrowed(pixels);
    }
    let mut opaque = pixels.clone();
    for pixel in opaque.data_mut() {
        let [.., alpha] = *pixel;
        *pixel = pixel.map(|c| over_white(c, alpha));
        pixel[3] = 255;
    }
    Cow::Owned(opaque)
}

/// Returns a channel over white, rounded.
fn over_white(channel: u8, alpha: u8) -> u8 {
    let (c, a) = (u32::from(channel), u32::from(alpha));
    ((c * a + 255 * (255 - a) + 127) / 255) as u8
}

fn failed(error: ImageError) -> Error {
    match error {
        ImageError::IoError(error) => Error::Io(error),
        other => refused(other),
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::shades;
    use super::*;
    use crate::{Limits, image};

    fn written(pixels: &Pixels<[u8; 4]>, encoding: &Encoding) -> (Vec<u8>, bool) {
        let mut bytes = Vec::new();
        let flattened = write(&mut bytes, pixels, encoding).unwrap();
        (bytes, flattened)
    }

    /// Returns the largest difference of a channel, after decoding.
    fn worst(pixels: &Pixels<[u8; 4]>, bytes: &[u8]) -> u8 {
        let decoded = image::decode(bytes, "a.jpg", &Limits::default()).unwrap();
        assert_eq!((decoded.width, decoded.height), (pixels.width(), pixels.height()));
        let both = decoded.data.as_flattened().iter().zip(pixels.data().as_flattened());
        both.map(|(a, b)| a.abs_diff(*b)).max().unwrap()
    }

    #[test]
    fn pictures_come_back_as_near_as_the_quality_says() {
        let opaque = on_white(&shades(40, 30)).into_owned();
        let of = |quality| written(&opaque, &Encoding { quality, ..Encoding::default() }).0;
        let sizes = [1, 50, 90, 100].map(|q| of(q).len());
        assert!(sizes.is_sorted_by(|a, b| a < b), "{sizes:?}");
        assert!(worst(&opaque, &of(100)) <= 4);
        let plain = Pixels::new(33, 17, [200, 30, 60, 255]);
        assert!(worst(&plain, &written(&plain, &Encoding::default()).0) <= 2);
    }

    #[test]
    fn transparent_parts_lie_on_white_and_that_is_reported() {
        let clear = Pixels::new(16, 16, [0, 0, 0, 0]);
        let (bytes, flattened) = written(&clear, &Encoding::default());
        assert!(flattened && worst(&Pixels::new(16, 16, [255; 4]), &bytes) <= 1);
        assert!(!written(&Pixels::new(16, 16, [1, 2, 3, 255]), &Encoding::default()).1);
        assert_eq!([over_white(10, 0), over_white(10, 255), over_white(0, 128)], [255, 10, 127]);
    }
}
