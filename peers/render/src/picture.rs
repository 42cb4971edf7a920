//! Pictures as bytes, and where two of them differ.

use crate::Result;
use std::fs::File;
use std::io::{BufReader, BufWriter};
use std::path::Path;

/// Rows from the top.
#[derive(Clone)]
pub struct Picture {
    /// In pixels.
    pub width: usize,
    /// Red, green, blue.
    pub pixels: Vec<[u8; 3]>,
    /// Colour of a pixel that nothing covers.
    pub background: [u8; 3],
}

impl Picture {
    /// Reads an 8-bit RGB or RGBA PNG; the background is taken to be the first pixel.
    pub fn read(path: &Path) -> Result<Self> {
        let mut reader = png::Decoder::new(BufReader::new(File::open(path)?)).read_info()?;
        let size = reader.output_buffer_size().ok_or("a picture too large")?;
        let mut data = vec![0; size];
        let info = reader.next_frame(&mut data)?;
        let channels = info.color_type.samples();
        if info.bit_depth != png::BitDepth::Eight || channels < 3 {
            return Err(format!("{}: neither RGB nor RGBA of 8 bits", path.display()).into());
        }
        let pixels: Vec<[u8; 3]> =
            data[..info.buffer_size()].chunks_exact(channels).map(|p| [p[0], p[1], p[2]]).collect();
        let background = pixels.first().copied().ok_or("a picture without pixels")?;
        Ok(Self { width: info.width as usize, pixels, background })
    }

    /// Writes a PNG.
    pub fn write(&self, path: &Path) -> Result<()> {
        let (width, height) = (self.width as u32, (self.pixels.len() / self.width) as u32);
        let out = BufWriter::new(File::create(path)?);
        let mut encoder = png::Encoder::new(out, width, height);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_compression(png::Compression::Fast);
        encoder.write_header()?.write_image_data(self.pixels.as_flattened())?;
        Ok(())
    }

    /// Returns the number of pixels that something covers.
    pub fn covered(&self) -> usize {
        self.pixels.iter().filter(|p| **p != self.background).count()
    }

    /// Returns the number of pixels that are covered in one of two pictures only, and the mean
    /// difference of a channel where both are.
    pub fn compare(&self, other: &Self) -> (usize, f64) {
        let (mut differ, mut sum, mut both) = (0, 0, 0);
        for (a, b) in self.pixels.iter().zip(&other.pixels) {
            match (*a != self.background, *b != other.background) {
                (true, true) => {
                    both += 3;
                    sum += a.iter().zip(b).map(|(a, b)| u64::from(a.abs_diff(*b))).sum::<u64>();
                }
                (false, false) => {}
                _ => differ += 1,
            }
        }
        (differ, sum as f64 / f64::from(both.max(1)))
    }
}
