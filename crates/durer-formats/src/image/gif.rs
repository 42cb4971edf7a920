//! The first picture of a GIF, by `gif`.

use super::{Picture, broken, check_size};
use crate::foreign;
use crate::{Limits, Result};
use gif::{ColorOutput, DecodeOptions, MemoryLimit};
use std::num::NonZeroU64;

/// The first bytes.
pub(super) const MAGIC: &[u8] = b"GIF8";

/// Decodes a file; the part of the screen outside its first picture is transparent.
///
/// # Errors
/// As [`super::decode`].
pub(super) fn decode(bytes: &[u8], name: &str, limits: &Limits) -> Result<Picture> {
    let wrong = |e: gif::DecodingError| broken(name, foreign::gif(&e));
    let mut options = DecodeOptions::new();
    options.set_color_output(ColorOutput::RGBA);
    options.set_memory_limit(match NonZeroU64::new(limits.decoded_bytes) {
        Some(bytes) => MemoryLimit::Bytes(bytes),
        None => MemoryLimit::Unlimited,
    });
    let mut decoder = options.read_info(bytes).map_err(wrong)?;
    let (width, height) = (usize::from(decoder.width()), usize::from(decoder.height()));
    let size = (width as u32, height as u32);
    check_size(size, 4, u64::MAX, name, limits)?;
    let frame = decoder.read_next_frame().map_err(wrong)?;
    let frame = frame.ok_or_else(|| broken(name, "holds no picture"))?;
    let mut pixels = vec![[0; 4]; width * height];
    let [left, top, across] = [frame.left, frame.top, frame.width].map(usize::from);
    let rows = frame.buffer.as_chunks::<4>().0.chunks_exact(across.max(1));
    for (row, from) in pixels.chunks_exact_mut(width).skip(top).zip(rows) {
        let place = row.iter_mut().skip(left);
        place.zip(from).for_each(|(to, from)| *to = *from);
    }
    Ok((size.0, size.1, pixels))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Error;
    use crate::image::decode;

    /// A screen of three by two pixels with a picture of two by one in its lower right corner.
    #[rustfmt::skip]
    const CORNER: [u8; 35] = [
        0x47, 0x49, 0x46, 0x38, 0x39, 0x61, 0x03, 0x00, 0x02, 0x00, 0x80, 0x00, 0x00, 0x0a, 0x14, 0x1e,
        0x28, 0x32, 0x3c, 0x2c, 0x01, 0x00, 0x01, 0x00, 0x02, 0x00, 0x01, 0x00, 0x00, 0x02, 0x02, 0x0c,
        0x0a, 0x00, 0x3b,
    ];

    #[test]
    fn the_first_picture_has_its_place_on_the_screen() {
        let image = decode(&CORNER, "x", &Limits::default()).unwrap();
        assert_eq!((image.width, image.height), (3, 2));
        assert_eq!(image.data[..4], [[0; 4]; 4]);
        assert_eq!(image.data[4..], [[40, 50, 60, 255], [10, 20, 30, 255]]);
        let limits = Limits { image_side: 2, ..Limits::default() };
        assert!(matches!(decode(&CORNER, "x", &limits), Err(Error::Limit { .. })));
        for cut in 0..CORNER.len() - 6 {
            assert!(decode(&CORNER[..cut], "x", &Limits::default()).is_err(), "{cut}");
        }
    }
}
