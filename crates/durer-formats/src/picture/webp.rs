//! WebP without loss (VP8L), by the crate `image-webp`.

use super::{charged, is_opaque, refused, sides};
use crate::{Error, Result};
use durer::target::Pixels;
use image_webp::{ColorType, EncodingError, WebPEncoder};
use std::io::Write;

/// VP8L has 14 bits for a side.
pub const MAX_SIDE: u32 = 1 << 14;

/// Writes a picture, without the alpha channel where all of it is opaque.
pub fn write<W: Write>(out: W, pixels: &Pixels<[u8; 4]>) -> Result<()> {
    let expected = "1x1 to 16384x16384 for a WebP, which has room for no more pixels along a side";
    let (width, height) = sides(pixels, MAX_SIDE, expected)?;
    // Colours without alpha, the encoder's predictions, and the file, which it builds in memory.
    let _room = charged(pixels, 3 + 4 + 4)?;
    let encoder = WebPEncoder::new(out);
    let written = if is_opaque(pixels) {
        let colors: Vec<[u8; 3]> = pixels.data().iter().map(|&[r, g, b, _]| [r, g, b]).collect();
        encoder.encode(colors.as_flattened(), width, height, ColorType::Rgb8)
    } else {
        encoder.encode(pixels.data().as_flattened(), width, height, ColorType::Rgba8)
    };
    written.map_err(|error| match error {
        EncodingError::IoError(error) => Error::Io(error),
        other => refused(other),
    })
}

#[cfg(test)]
mod tests {
    use super::super::tests::shades;
    use super::*;

    #[test]
    fn pictures_come_back_as_they_were() {
        let opaque = Pixels::new(9, 5, [1, 2, 3, 255]);
        for (pixels, channels) in [(shades(33, 17), 4), (opaque, 3)] {
            let mut bytes = Vec::new();
            write(&mut bytes, &pixels).unwrap();
            let mut decoder = image_webp::WebPDecoder::new(std::io::Cursor::new(&bytes)).unwrap();
            assert_eq!(decoder.dimensions(), (pixels.width(), pixels.height()));
            let mut data = vec![0; decoder.output_buffer_size().unwrap()];
            decoder.read_image(&mut data).unwrap();
            let expected: Vec<u8> =
                pixels.data().iter().flat_map(|p| p[..channels].to_vec()).collect();
            assert_eq!(data, expected);
        }
    }
}
