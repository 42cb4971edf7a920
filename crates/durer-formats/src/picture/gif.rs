//! Frames of a GIF (version 89a), by the crate `gif`, with colours of their own each.

use super::palette::{Indexed, indexed};
use super::{charged, refused};
use crate::{Error, Result};
use durer::target::Pixels;
use gif::{DisposalMethod, Encoder, EncodingError, Frame, Repeat};
use std::borrow::Cow;
use std::io::Write;

/// Begins a file that is shown again and again.
pub fn begin<W: Write>(out: W, width: u16, height: u16) -> Result<Encoder<W>> {
    let mut encoder = Encoder::new(out, width, height, &[]).map_err(failed)?;
    encoder.set_repeat(Repeat::Infinite).map_err(failed)?;
    Ok(encoder)
}

/// Adds a picture that is shown for some hundredths of a second.
pub fn push<W: Write>(
    encoder: &mut Encoder<W>,
    pixels: &Pixels<[u8; 4]>,
    (width, height): (u16, u16),
    delay: u16,
) -> Result<()> {
    // Numbers of colours, and the frame, which the encoder makes in memory.
    let _room = charged(pixels, 1 + 2)?;
    let Indexed { palette, indices, transparent } = indexed(pixels);
    // Otherwise the previous picture would be visible through transparent pixels.
    let dispose = match transparent {
        Some(_) => DisposalMethod::Background,
        None => DisposalMethod::Keep,
    };
    let frame = Frame {
        width,
        height,
        delay,
        dispose,
        transparent,
        palette: Some(palette.as_flattened().to_vec()),
        buffer: Cow::Owned(indices),
        ..Frame::default()
    };
    encoder.write_frame(&frame).map_err(failed)
}

/// Ends the file.
pub fn finish<W: Write>(encoder: Encoder<W>) -> Result<()> {
    encoder.into_inner().map_err(failed)?.flush().map_err(Error::Io)
}

fn failed(error: EncodingError) -> Error {
    match error {
        EncodingError::Io(error) => Error::Io(error),
        other => refused(other),
    }
}
