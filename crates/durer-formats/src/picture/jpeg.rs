//! JPEG, by the crate `jpeg-encoder`, whose arithmetic is whole numbers.

use super::{Encoding, is_opaque, refused, sides};
use crate::png::Compression;
use crate::{Error, Result};
use durer::target::Pixels;
use jpeg_encoder::{ChromaSubsamplingMethod, ColorType, Encoder, EncodingError};
use std::borrow::Cow;
use std::io::Write;

/// Writes a picture; returns whether it had to be laid onto white.
pub fn write<W: Write>(out: W, pixels: &Pixels<[u8; 4]>, encoding: &Encoding) -> Result<bool> {
    let expected = "1x1 to 65535x65535 for a JPEG, which has room for no more pixels along a side";
    let sides = sides(pixels, u32::from(u16::MAX), expected)?;
    let (Ok(width), Ok(height)) = (u16::try_from(sides.0), u16::try_from(sides.1)) else {
        return Err(refused(expected));
    };
    let colors = on_white(pixels);
    let mut encoder = Encoder::new(out, encoding.quality.clamp(1, 100));
    encoder.set_chroma_subsampling_method(ChromaSubsamplingMethod::Average);
    encoder.set_optimized_huffman_tables(encoding.compression == Compression::Small);
    let bytes = colors.data().as_flattened();
    encoder.encode(bytes, width, height, ColorType::Rgba).map_err(failed)?;
    Ok(matches!(colors, Cow::Owned(_)))
}

/// The picture as viewers show it on white.
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

/// A channel over white, rounded.
fn over_white(channel: u8, alpha: u8) -> u8 {
    let (c, a) = (u32::from(channel), u32::from(alpha));
    ((c * a + 255 * (255 - a) + 127) / 255) as u8
}

fn failed(error: EncodingError) -> Error {
    match error {
        EncodingError::IoError(error) => Error::Io(error),
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

    /// The largest difference of a channel, after decoding.
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
    fn smaller_files_have_the_same_pixels() {
        let opaque = on_white(&shades(64, 64)).into_owned();
        let small = Encoding { compression: Compression::Small, ..Encoding::default() };
        let (fast, small) = (written(&opaque, &Encoding::default()).0, written(&opaque, &small).0);
        assert!(small.len() < fast.len());
        let decode = |bytes: &[u8]| image::decode(bytes, "a.jpg", &Limits::default()).unwrap();
        assert_eq!(decode(&fast).data, decode(&small).data);
    }

    #[test]
    fn transparent_parts_lie_on_white_and_that_is_told() {
        let clear = Pixels::new(16, 16, [0, 0, 0, 0]);
        let (bytes, flattened) = written(&clear, &Encoding::default());
        assert!(flattened && worst(&Pixels::new(16, 16, [255; 4]), &bytes) <= 1);
        assert!(!written(&Pixels::new(16, 16, [1, 2, 3, 255]), &Encoding::default()).1);
        assert_eq!([over_white(10, 0), over_white(10, 255), over_white(0, 128)], [255, 10, 127]);
    }
}
