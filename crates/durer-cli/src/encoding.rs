//! The encoding of pictures: options that all commands share.

use crate::failure::Failure;
use crate::kind::Kind;
use crate::output::{Target, deliver};
use crate::values;
use clap::{Args, ValueEnum};
use durer::target::Pixels;
use durer_formats::picture::{self, Encoding, PictureFormat};

/// Warning for a JPEG whose picture was not opaque.
pub const FLATTENED: &str = "a JPEG has no transparency; the picture is composed with white";

/// Formats and sizes of files.
#[derive(Debug, Clone, Args)]
pub struct EncodingArgs {
    /// Effort of compression of a PNG; the pixels do not change
    #[arg(long, value_name = "HOW", default_value = "fast")]
    pub compression: Compression,
    /// Quality of a JPEG, 1 to 100 [default: 90]
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = clap::value_parser!(u8).range(1..=100))]
    pub quality: Option<u8>,
    /// True if the compression is from the command line, and not from a file of options.
    #[arg(skip)]
    pub compression_given: bool,
    /// The same for the quality.
    #[arg(skip)]
    pub quality_given: bool,
}

/// The same, of commands that write one picture.
#[derive(Debug, Clone, Args)]
pub struct PictureFileArgs {
    /// The format of the output: png, jpeg or webp [default: by its suffix, else png]
    #[arg(long, value_name = "FORMAT", value_parser = values::picture_format())]
    pub format: Option<PictureFormat>,
    /// Sizes of files.
    #[command(flatten)]
    pub encoding: EncodingArgs,
}

/// `--compression`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Compression {
    /// About twenty times faster than `small`
    Fast,
    /// Files a quarter to a half smaller
    Small,
}

impl From<Compression> for durer_formats::png::Compression {
    fn from(compression: Compression) -> Self {
        match compression {
            Compression::Fast => Self::Fast,
            Compression::Small => Self::Small,
        }
    }
}

impl EncodingArgs {
    /// Refuses options that no file of the command follows, given the kinds of the files.
    pub fn check(&self, kinds: &[Kind]) -> Result<(), Failure> {
        if self.compression_given && !kinds.contains(&Kind::PNG) {
            let message =
                "--compression: only a PNG has one; leave it out, or end the name in .png";
            return Err(Failure::Usage(message.to_owned()));
        }
        if self.quality_given && !kinds.contains(&Kind::Picture(PictureFormat::Jpeg)) {
            let message = "--quality: only a JPEG has one, other formats keep the pixels as they are; \
                           end the name in .jpg, or give --format jpeg";
            return Err(Failure::Usage(message.to_owned()));
        }
        Ok(())
    }

    /// Returns the options in the form that encoders take.
    pub fn encoding(&self) -> Encoding {
        let default = Encoding::default();
        Encoding {
            compression: self.compression.into(),
            quality: self.quality.unwrap_or(default.quality),
        }
    }

    /// Encodes a picture and writes it; returns whether it had to be composed with white.
    pub fn deliver(
        &self,
        target: &Target,
        format: PictureFormat,
        pixels: &Pixels<[u8; 4]>,
    ) -> Result<bool, Failure> {
        let mut flattened = false;
        deliver(target, &pixels.work(), |out| {
            flattened = picture::write(out, format, pixels, &self.encoding())?;
            Ok(())
        })?;
        Ok(flattened)
    }
}
