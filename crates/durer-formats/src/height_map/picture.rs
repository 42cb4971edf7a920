//! Grey PNG pictures: 0 … 255 or 0 … 65535 is the height; fully transparent pixels are missing heights.

use super::{Grid, HeightMapOptions, check_size};
use crate::{Error, Place, Result, foreign};
use png::{BitDepth, ColorType, Decoder, Transformations};
use std::io::Cursor;

pub fn read(bytes: &[u8], options: &HeightMapOptions) -> Result<Grid> {
    let wrong = |e: png::DecodingError| Error::whole(format!("the picture {}", foreign::png(&e)));
    let memory = usize::try_from(options.limits.decoded_bytes).unwrap_or(usize::MAX);
    let mut decoder = Decoder::new_with_limits(Cursor::new(bytes), png::Limits { bytes: memory });
    decoder.set_transformations(Transformations::EXPAND);
    decoder.set_ignore_text_chunk(true);
    decoder.set_ignore_iccp_chunk(true);
    let info = decoder.read_header_info().map_err(wrong)?;
    let (width, height) = (info.width, info.height);
    let count = check_size(u64::from(width), u64::from(height), &options.limits)?;
    crate::image::check_png_holds(bytes.len(), info, options.limits.decoded_bytes)?;
    let mut reader = decoder.read_info().map_err(wrong)?;
    let length = reader.output_buffer_size().ok_or_else(|| Error::whole("it is too large"))?;
    let mut samples = vec![0; length];
    let frame = reader.next_frame(&mut samples).map_err(wrong)?;
    let samples: Vec<u16> = match frame.bit_depth {
        BitDepth::Sixteen => {
            samples.as_chunks().0.iter().map(|&pair| u16::from_be_bytes(pair)).collect()
        }
        _ => samples.into_iter().map(u16::from).collect(),
    };
    let heights: Vec<f64> = match frame.color_type {
        ColorType::Grayscale => samples.into_iter().map(f64::from).collect(),
        ColorType::GrayscaleAlpha => heights(&samples, |&[g, a]| (g, g, g, a))?,
        ColorType::Rgb => heights(&samples, |&[r, g, b]| (r, g, b, 1))?,
        ColorType::Rgba => heights(&samples, |&[r, g, b, a]| (r, g, b, a))?,
        ColorType::Indexed => return Err(Error::whole("it has no palette")),
    };
    if heights.len() != count {
        return Err(Error::whole("its first frame is of another size"));
    }
    let bits = if frame.bit_depth == BitDepth::Sixteen { 16 } else { 8 };
    let (columns, rows) = (width as usize, height as usize);
    let (format, warnings) = (format!("PNG, {bits} bits"), Vec::new());
    Ok(Grid { columns, rows, heights, place: None, format, warnings })
}

/// Returns the heights of pixels that are grey, as red, green, blue and alpha.
fn heights<const N: usize>(
    samples: &[u16],
    rgba: impl Fn(&[u16; N]) -> (u16, u16, u16, u16),
) -> Result<Vec<f64>> {
    let pixels = samples.as_chunks::<N>().0.iter().map(rgba);
    pixels
        .map(|(r, g, b, a)| match a {
            0 => Ok(f64::NAN),
            _ if r == g && g == b => Ok(f64::from(g)),
            _ => Err(Error::Unsupported {
                place: Place::Whole,
                what: "a height map in colours".to_owned(),
                hint: "use a grey picture of 8 or 16 bits".to_owned(),
            }),
        })
        .collect()
}
