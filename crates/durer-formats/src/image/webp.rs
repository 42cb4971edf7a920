//! WebP, by `image-webp`.

use super::{Picture, broken, check_size};
use crate::foreign;
use crate::{Limits, Result};
use image_webp::WebPDecoder;
use std::io::Cursor;

/// Returns whether bytes begin like a WebP file.
pub(super) fn is_webp(bytes: &[u8]) -> bool {
    bytes.starts_with(b"RIFF") && bytes.get(8..12) == Some(b"WEBP")
}

/// Decodes a file, or the first picture of an animation.
///
/// # Errors
/// As [`super::decode`].
pub(super) fn decode(bytes: &[u8], name: &str, limits: &Limits) -> Result<Picture> {
    let wrong = |e: image_webp::DecodingError| broken(name, foreign::webp(&e));
    let mut decoder = WebPDecoder::new(Cursor::new(bytes)).map_err(wrong)?;
    let size @ (width, height) = decoder.dimensions();
    // Equal pixels take no bits at all, so the file's size does not limit their number.
    check_size(size, 4, u64::MAX, name, limits)?;
    decoder.set_memory_limit(usize::try_from(limits.decoded_bytes).unwrap_or(usize::MAX));
    let too_large = || broken(name, "is too large");
    let mut samples = vec![0; decoder.output_buffer_size().ok_or_else(too_large)?];
    if decoder.is_animated() {
        decoder.read_frame(&mut samples).map_err(wrong)?;
    } else {
        decoder.read_image(&mut samples).map_err(wrong)?;
    }
    let same = |sample| sample;
    let pixels = if decoder.has_alpha() {
        super::pixels_of(&samples, same, |rgba| rgba)
    } else {
        super::pixels_of(&samples, same, |[r, g, b]| [r, g, b, 255])
    };
    Ok((width, height, pixels))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Error;
    use crate::image::decode;

    /// Four squares: red and green, blue and yellow.
    #[rustfmt::skip]
    const QUAD: [u8; 156] = [
        0x52, 0x49, 0x46, 0x46, 0x94, 0x00, 0x00, 0x00, 0x57, 0x45, 0x42, 0x50, 0x56, 0x50, 0x38, 0x20,
        0x88, 0x00, 0x00, 0x00, 0xd0, 0x06, 0x00, 0x9d, 0x01, 0x2a, 0x40, 0x00, 0x40, 0x00, 0x3e, 0x6d,
        0x2e, 0x93, 0x46, 0x24, 0x22, 0xa1, 0xa1, 0x30, 0x19, 0xf8, 0x00, 0x80, 0x0d, 0x89, 0x41, 0x0e,
        0x00, 0x30, 0x21, 0x40, 0x5f, 0x80, 0x7e, 0x33, 0x6d, 0xa2, 0xf0, 0x0f, 0xc6, 0x3f, 0xc6, 0x0e,
        0x43, 0x5e, 0xee, 0x66, 0x7e, 0x01, 0xff, 0x96, 0xa4, 0x8e, 0x5d, 0xc4, 0x6d, 0x5c, 0xfa, 0xe9,
        0x73, 0x63, 0x00, 0x00, 0xfe, 0x1b, 0xb5, 0xae, 0x7f, 0xad, 0xe0, 0xd4, 0xda, 0x37, 0x2c, 0x4c,
        0xef, 0x8e, 0x01, 0x1c, 0xcf, 0x39, 0x00, 0xde, 0xfa, 0x3f, 0x6e, 0xa4, 0xf7, 0x56, 0x4d, 0xa8,
        0x96, 0x73, 0xfe, 0xe2, 0x7d, 0xc4, 0x90, 0x0c, 0x50, 0x4d, 0x16, 0x2b, 0x43, 0x60, 0x61, 0xcc,
        0x77, 0x4e, 0x09, 0x25, 0x25, 0xeb, 0x5b, 0xc2, 0x9e, 0x4e, 0xb3, 0x8d, 0x22, 0xe4, 0x84, 0x27,
        0x15, 0x09, 0x0d, 0x90, 0x4b, 0x72, 0xe0, 0x1b, 0x1c, 0x66, 0x00, 0x00,
    ];

    #[test]
    fn a_picture_is_decoded_and_limited() {
        let image = decode(&QUAD, "quad", &Limits::default()).unwrap();
        assert_eq!((image.width, image.height, image.data.len()), (64, 64, 4096));
        let near = |[x, y]: [usize; 2], color: [u8; 3]| {
            image.data[64 * y + x].iter().zip(color).all(|(a, b)| a.abs_diff(b) < 4)
        };
        assert!(near([8, 8], [220, 30, 30]) && near([40, 8], [30, 180, 30]));
        assert!(near([8, 40], [30, 60, 220]) && image.data[0][3] == 255);
        let limits = Limits { decoded_bytes: 4 * 4096 - 1, ..Limits::default() };
        assert!(matches!(decode(&QUAD, "quad", &limits), Err(Error::Limit { .. })));
        let limits = Limits { image_side: 63, ..Limits::default() };
        assert!(matches!(decode(&QUAD, "quad", &limits), Err(Error::Limit { .. })));
        for cut in 0..QUAD.len() {
            let _ = decode(&QUAD[..cut], "quad", &Limits::default());
        }
    }
}
