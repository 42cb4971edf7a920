//! Pictures one after another in one file: animated PNG, WebP and GIF, shown again and again.
//!
//! Each picture is written immediately, so the memory of one suffices.

use super::{charged, gif, refused, sides, webp};
use crate::png::{Compression, encoding};
use crate::{Error, Result};
use durer::target::Pixels;
use png::{BitDepth, ColorType, SrgbRenderingIntent};
use std::io::{Seek, SeekFrom, Write};

/// The file formats of animations.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum AnimationFormat {
    /// Animated PNG (PNG, third edition, 2025): as the pixels are, with transparency.
    Png,
    /// Animated WebP (RFC 9649), without loss: as the pixels are, with transparency.
    WebP,
    /// GIF (version 89a): 256 colours in each picture, chosen for it; pixels are transparent or not.
    Gif,
}

impl AnimationFormat {
    /// Returns the largest width and height that it can say, in pixels.
    pub const fn max_side(self) -> u32 {
        match self {
            Self::Png => i32::MAX.unsigned_abs(),
            Self::WebP => webp::MAX_SIDE,
            Self::Gif => u16::MAX as u32,
        }
    }

    /// Returns the parts of a second that it counts in.
    const fn ticks(self) -> f64 {
        match self {
            Self::Png | Self::WebP => 1000.0,
            Self::Gif => 100.0,
        }
    }

    /// Returns the shortest and longest time that a picture can be shown, in seconds. Viewers show a picture
    /// of less than 2/100 s in a GIF for 10/100 s.
    pub const fn times(self) -> (f64, f64) {
        match self {
            Self::Png | Self::WebP => (0.001, 65.0),
            Self::Gif => (0.02, 600.0),
        }
    }
}

/// Facts about an animation that are known before its first picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// Columns and rows.
    pub size: (u32, u32),
    /// Number of pictures.
    pub frames: u32,
    /// Time that all pictures take, in seconds.
    pub seconds: f64,
    /// True if pictures may be transparent; otherwise their alpha is left out of a PNG.
    pub alpha: bool,
    /// Effort of PNG compression.
    pub compression: Compression,
}

/// A file that pictures are added to.
pub struct Animation<W: Write + Seek> {
    options: Options,
    format: AnimationFormat,
    /// Pictures so far.
    count: u32,
    file: File<W>,
}

enum File<W: Write + Seek> {
    Png(png::Writer<W>),
    WebP(W),
    Gif(::gif::Encoder<W>),
}

impl<W: Write + Seek> Animation<W> {
    /// Begins a file. Only a WebP seeks in it.
    ///
    /// # Errors
    /// [`Error::Library`] for a size or times that the format cannot say, [`Error::Io`] if writing
    /// fails.
    pub fn new(out: W, format: AnimationFormat, options: &Options) -> Result<Self> {
        check(format, options)?;
        let (width, height) = options.size;
        let file = match format {
            AnimationFormat::Png => File::Png(begin_png(out, options)?),
            AnimationFormat::WebP => File::WebP(begin_webp(out, options)?),
            AnimationFormat::Gif => File::Gif(gif::begin(out, width as u16, height as u16)?),
        };
        Ok(Self { options: *options, format, count: 0, file })
    }

    /// Adds the next picture.
    ///
    /// # Errors
    /// [`Error::Library`] for one of another size or one too many, [`Error::Io`] if writing fails.
    pub fn push(&mut self, pixels: &Pixels<[u8; 4]>) -> Result<()> {
        let (width, height) = sides(pixels, u32::MAX, "1x1 at least")?;
        if (width, height) != self.options.size || self.count >= self.options.frames {
            let value = format!("{width}x{height}, number {}", u64::from(self.count) + 1);
            let expected = "of the animation's size, and one of as many as were announced";
            return Err(durer::Error::parameter("picture", value, expected).into());
        }
        let delay = self.delay();
        self.count += 1;
        match &mut self.file {
            File::Png(writer) => push_png(writer, pixels, self.options.alpha, delay as u16),
            File::WebP(out) => push_webp(out, pixels, delay),
            File::Gif(encoder) => {
                gif::push(encoder, pixels, (width as u16, height as u16), delay as u16)
            }
        }
    }

    /// Returns the time of the next picture, in the format's parts of a second. Rounding errors do not add
    /// up.
    fn delay(&self) -> u32 {
        let Options { frames, seconds, .. } = self.options;
        let ticks = seconds * self.format.ticks() / f64::from(frames);
        let begin = |i: u32| (ticks * f64::from(i)).round();
        (begin(self.count + 1) - begin(self.count)) as u32
    }

    /// Ends the file.
    ///
    /// # Errors
    /// [`Error::Library`] if pictures are missing, [`Error::Io`] if writing fails.
    pub fn finish(self) -> Result<()> {
        if self.count != self.options.frames {
            let value = self.count.to_string();
            let expected = "as many as were announced";
            return Err(durer::Error::parameter("pictures", value, expected).into());
        }
        match self.file {
            File::Png(writer) => writer.finish().map_err(encoding),
            File::WebP(out) => finish_webp(out),
            File::Gif(encoder) => gif::finish(encoder),
        }
    }
}

/// Checks that the format can store all of that.
fn check(format: AnimationFormat, options: &Options) -> Result<()> {
    let (width, height) = options.size;
    let wrong =
        |name, value: String, expected| Err(durer::Error::parameter(name, value, expected).into());
    if width.min(height) == 0 || width.max(height) > format.max_side() {
        let expected = match format {
            AnimationFormat::Png => "at least 1x1 for a PNG",
            AnimationFormat::WebP => "1x1 to 16384x16384 for a WebP",
            AnimationFormat::Gif => "1x1 to 65535x65535 for a GIF",
        };
        return wrong("size", format!("{width}x{height}"), expected);
    }
    let (least, most) = format.times();
    let each = options.seconds / f64::from(options.frames);
    // Slightly less, because of rounded numbers such as 0.3 / 15.
    if !(each >= least * (1.0 - 1e-9) && each <= most) {
        let expected = match format {
            AnimationFormat::Gif => "0.02 to 600 seconds for each picture of a GIF",
            _ => "0.001 to 65 seconds for each picture",
        };
        return wrong("duration", each.to_string(), expected);
    }
    Ok(())
}

fn begin_png<W: Write>(out: W, options: &Options) -> Result<png::Writer<W>> {
    let (width, height) = options.size;
    let mut encoder = png::Encoder::new(out, width, height);
    encoder.set_color(if options.alpha { ColorType::Rgba } else { ColorType::Rgb });
    encoder.set_depth(BitDepth::Eight);
    encoder.set_source_srgb(SrgbRenderingIntent::Perceptual);
    crate::png::set_compression(&mut encoder, options.compression);
    encoder.set_animated(options.frames, 0).map_err(encoding)?;
    encoder.write_header().map_err(encoding)
}

fn push_png<W: Write>(
    writer: &mut png::Writer<W>,
    pixels: &Pixels<[u8; 4]>,
    alpha: bool,
    delay: u16,
) -> Result<()> {
    writer.set_frame_delay(delay, 1000).map_err(encoding)?;
    // Colours without alpha, and the frame, which the encoder makes in memory.
    let _room = charged(pixels, 3 + 4)?;
    if alpha {
        return writer.write_image_data(pixels.data().as_flattened()).map_err(encoding);
    }
    let colors: Vec<[u8; 3]> = pixels.data().iter().map(|&[r, g, b, _]| [r, g, b]).collect();
    writer.write_image_data(colors.as_flattened()).map_err(encoding)
}

/// `RIFF`, its length, `WEBP`.
const RIFF_HEADER: usize = 12;

/// Writes the header with an open length, and the settings of all pictures.
fn begin_webp<W: Write>(mut out: W, options: &Options) -> Result<W> {
    let (width, height) = options.size;
    out.write_all(b"RIFF\0\0\0\0WEBP")?;
    out.write_all(b"VP8X\x0a\0\0\0")?;
    let (animated, with_alpha) = (1 << 1, 1 << 4);
    out.write_all(&[animated | if options.alpha { with_alpha } else { 0 }, 0, 0, 0])?;
    out.write_all(&three_bytes(width - 1))?;
    out.write_all(&three_bytes(height - 1))?;
    // A transparent background, and no end of repetitions.
    out.write_all(b"ANIM\x06\0\0\0\0\0\0\0\0\0")?;
    Ok(out)
}

/// Returns the lower three bytes, the lowest first.
fn three_bytes(number: u32) -> [u8; 3] {
    let [a, b, c, _] = number.to_le_bytes();
    [a, b, c]
}

fn push_webp<W: Write>(out: &mut W, pixels: &Pixels<[u8; 4]>, delay: u32) -> Result<()> {
    let _room = charged(pixels, 4)?;
    let mut still = Vec::new();
    webp::write(&mut still, pixels)?;
    // A still picture is its header and one chunk, which is of an even length.
    let chunk = still.get(RIFF_HEADER..).unwrap_or_default();
    // Place and size, time, flags: the picture replaces the previous one.
    let header_length = 16;
    let length = u32::try_from(chunk.len() + header_length).map_err(refused)?;
    out.write_all(b"ANMF")?;
    out.write_all(&length.to_le_bytes())?;
    out.write_all(&[0; 6])?;
    out.write_all(&three_bytes(pixels.width() - 1))?;
    out.write_all(&three_bytes(pixels.height() - 1))?;
    out.write_all(&three_bytes(delay))?;
    out.write_all(&[1 << 1])?;
    out.write_all(chunk)?;
    Ok(())
}

/// Fills in the length.
fn finish_webp<W: Write + Seek>(mut out: W) -> Result<()> {
    let length = out.stream_position()?.saturating_sub(8);
    let limit = u64::from(u32::MAX - 1);
    let Ok(bytes) = u32::try_from(length) else {
        let place = crate::Place::Whole;
        return Err(Error::Limit { place, what: "length of a WebP", value: length, limit });
    };
    out.seek(SeekFrom::Start(4))?;
    out.write_all(&bytes.to_le_bytes())?;
    out.seek(SeekFrom::End(0))?;
    out.flush()?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::super::tests::shades;
    use super::*;
    use std::io::Cursor;

    const SIZE: (u32, u32) = (20, 12);

    /// Returns three pictures: the second has smaller content, the third is partly transparent.
    fn pictures() -> Vec<Pixels<[u8; 4]>> {
        let mut first = shades(SIZE.0, SIZE.1);
        first.data_mut().iter_mut().for_each(|p| p[3] = 255);
        let second = Pixels::new(SIZE.0, SIZE.1, [10, 200, 30, 255]);
        vec![first, second, shades(SIZE.0, SIZE.1)]
    }

    fn options(frames: u32, seconds: f64, alpha: bool) -> Options {
        Options { size: SIZE, frames, seconds, alpha, compression: Compression::Fast }
    }

    fn written(format: AnimationFormat, pictures: &[Pixels<[u8; 4]>], seconds: f64) -> Vec<u8> {
        let mut bytes = Cursor::new(Vec::new());
        let options = options(pictures.len() as u32, seconds, true);
        let mut animation = Animation::new(&mut bytes, format, &options).unwrap();
        pictures.iter().for_each(|p| animation.push(p).unwrap());
        animation.finish().unwrap();
        bytes.into_inner()
    }

    #[test]
    fn png_frames_come_back_with_their_times() {
        let pictures = pictures();
        let bytes = written(AnimationFormat::Png, &pictures, 0.5);
        let mut reader = png::Decoder::new(Cursor::new(&bytes)).read_info().unwrap();
        let control = reader.info().animation_control.unwrap();
        assert_eq!((control.num_frames, control.num_plays), (3, 0));
        let mut data = vec![0; reader.output_buffer_size().unwrap()];
        let mut delays = Vec::new();
        for picture in &pictures {
            reader.next_frame(&mut data).unwrap();
            let frame = reader.info().frame_control.unwrap();
            delays.push((frame.delay_num, frame.delay_den));
            assert_eq!(data, picture.data().as_flattened());
        }
        assert_eq!(delays, [(167, 1000), (166, 1000), (167, 1000)]);
    }

    #[test]
    fn opaque_png_frames_have_no_alpha() {
        let mut bytes = Cursor::new(Vec::new());
        let options = options(1, 1.0, false);
        let mut animation = Animation::new(&mut bytes, AnimationFormat::Png, &options).unwrap();
        animation.push(&pictures()[0]).unwrap();
        animation.finish().unwrap();
        let reader = png::Decoder::new(Cursor::new(bytes.into_inner())).read_info().unwrap();
        assert_eq!(reader.info().color_type, ColorType::Rgb);
    }

    #[test]
    fn webp_frames_come_back_with_their_times() {
        let pictures = pictures();
        let bytes = written(AnimationFormat::WebP, &pictures, 0.5);
        let length = u32::from_le_bytes(bytes[4..8].try_into().unwrap());
        assert_eq!(length as usize, bytes.len() - 8);
        let mut decoder = image_webp::WebPDecoder::new(Cursor::new(&bytes)).unwrap();
        assert!(decoder.is_animated() && decoder.dimensions() == SIZE);
        assert_eq!(
            (decoder.num_frames(), decoder.loop_count()),
            (3, image_webp::LoopCount::Forever)
        );
        let mut data = vec![0; decoder.output_buffer_size().unwrap()];
        let mut delays = Vec::new();
        for picture in &pictures {
            delays.push(decoder.read_frame(&mut data).unwrap());
            assert_eq!(data, picture.data().as_flattened());
        }
        assert_eq!(delays, [167, 166, 167]);
    }

    #[test]
    fn gif_frames_come_back_with_their_times() {
        let pictures = pictures();
        let bytes = written(AnimationFormat::Gif, &pictures, 0.5);
        let mut options = ::gif::DecodeOptions::new();
        options.set_color_output(::gif::ColorOutput::RGBA);
        let mut decoder = options.read_info(Cursor::new(&bytes)).unwrap();
        assert_eq!(decoder.repeat(), ::gif::Repeat::Infinite);
        let mut delays = Vec::new();
        for picture in &pictures {
            let frame = decoder.read_next_frame().unwrap().unwrap();
            delays.push(frame.delay);
            for (found, &[r, g, b, alpha]) in frame.buffer.as_chunks().0.iter().zip(picture.data())
            {
                assert_eq!(*found, if alpha < 128 { [0; 4] } else { [r, g, b, 255] });
            }
        }
        assert!(decoder.read_next_frame().unwrap().is_none());
        assert_eq!(delays, [17, 16, 17]);
    }

    #[test]
    fn what_a_format_cannot_say_is_refused() {
        let begin = |format, options: &Options| {
            Animation::new(Cursor::new(Vec::new()), format, options).err().map(|e| e.to_string())
        };
        let fast = options(51, 1.0, false);
        let message = begin(AnimationFormat::Gif, &fast).unwrap();
        assert!(message.contains("0.02"), "{message}");
        assert!(begin(AnimationFormat::Gif, &options(50, 1.0, false)).is_none());
        assert!(begin(AnimationFormat::Png, &fast).is_none());
        assert!(begin(AnimationFormat::Png, &options(1, f64::NAN, false)).is_some());
        let large = Options { size: (70_000, 1), ..fast };
        assert!(begin(AnimationFormat::WebP, &large).unwrap().contains("70000x1"));
    }

    #[test]
    fn frames_are_as_many_and_as_large_as_announced() {
        let mut animation =
            Animation::new(Cursor::new(Vec::new()), AnimationFormat::WebP, &options(1, 1.0, true))
                .unwrap();
        assert!(animation.push(&Pixels::new(3, 3, [0; 4])).is_err());
        animation.push(&pictures()[0]).unwrap();
        assert!(animation.push(&pictures()[0]).is_err());
        let empty =
            Animation::new(Cursor::new(Vec::new()), AnimationFormat::Gif, &options(2, 1.0, true));
        assert!(empty.unwrap().finish().is_err());
    }
}
