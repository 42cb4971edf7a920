//! GPS times of LAZ's second version, without recursion.
//!
//! The crate `laz` recurses for each change of sequence in a file: a few hundred bytes overflow the stack. Writers
//! change the sequence once per point.
//!
//! Source: M. Isenburg, *LASzip: lossless compression of LiDAR data*, Photogrammetric Engineering and Remote Sensing 79
//! (2), 2013.

use laz::decoders::ArithmeticDecoder;
use laz::decompressors::{IntegerDecompressor, IntegerDecompressorBuilder};
use laz::models::{ArithmeticModel, ArithmeticModelBuilder};
use laz::record::FieldDecompressor;
use std::io::{self, Read};

/// Changes of sequence that a point may have.
const CHANGES: usize = 3;
/// Largest factor of the difference before.
const FACTOR: i32 = 500;
/// Least factor.
const LEAST: i32 = -10;
/// Symbol of a time that equals the time of the point before.
const SAME: i32 = FACTOR - LEAST + 1;
/// Symbol of a time that begins a sequence.
const BEGIN: i32 = SAME + 1;
/// Number of symbols: those above, and a change to each of three other sequences.
const SYMBOLS: u32 = BEGIN as u32 + 4;

/// One of four sequences of times that points alternate between.
#[derive(Debug, Clone, Copy, Default)]
struct Sequence {
    /// The last time; the bits of an `f64`.
    time: i64,
    /// The last difference that factors refer to.
    difference: i32,
    /// Extreme factors in a row.
    extremes: i32,
}

/// The field of GPS times.
pub(super) struct Times {
    /// Symbols of a sequence without a difference.
    first: ArithmeticModel,
    /// Symbols of a sequence with a difference.
    factor: ArithmeticModel,
    numbers: IntegerDecompressor,
    sequences: [Sequence; 4],
    /// The sequence of the last point.
    last: usize,
    /// The sequence that was begun last.
    begun: usize,
}

impl Default for Times {
    fn default() -> Self {
        Self {
            first: ArithmeticModelBuilder::new(6).build(),
            factor: ArithmeticModelBuilder::new(SYMBOLS).build(),
            numbers: IntegerDecompressorBuilder::new().bits(32).contexts(9).build_initialized(),
            sequences: [Sequence::default(); 4],
            last: 0,
            begun: 0,
        }
    }
}

impl Times {
    /// Decompresses one symbol and its data; returns whether it only changes the sequence.
    fn step<R: Read>(&mut self, decoder: &mut ArithmeticDecoder<R>) -> io::Result<bool> {
        let Sequence { difference, .. } = self.sequences[self.last];
        if difference == 0 {
            match decoder.decode_symbol(&mut self.first)? as i32 {
                0 => {}
                1 => {
                    let by = self.numbers.decompress(decoder, 0, 0)?;
                    self.sequences[self.last].difference = by;
                    self.advance(by, Some(0));
                }
                2 => self.begin(decoder)?,
                symbol => return Ok(self.change(symbol - 2)),
            }
            return Ok(false);
        }
        match decoder.decode_symbol(&mut self.factor)? as i32 {
            1 => {
                let by = self.numbers.decompress(decoder, difference, 1)?;
                self.advance(by, Some(0));
            }
            SAME => {}
            BEGIN => self.begin(decoder)?,
            symbol if symbol > BEGIN => return Ok(self.change(symbol - BEGIN)),
            symbol => self.multiple(symbol, decoder)?,
        }
        Ok(false)
    }

    /// Decompresses a difference that is about a multiple of the one before.
    fn multiple<R: Read>(
        &mut self,
        symbol: i32,
        decoder: &mut ArithmeticDecoder<R>,
    ) -> io::Result<()> {
        let (factor, context) = match symbol {
            0 => (0, 7),
            1..10 => (symbol, 2),
            10..FACTOR => (symbol, 3),
            FACTOR => (FACTOR, 4),
            _ if FACTOR - symbol > LEAST => (FACTOR - symbol, 5),
            _ => (LEAST, 6),
        };
        let Sequence { difference, extremes, .. } = self.sequences[self.last];
        let by = self.numbers.decompress(decoder, factor.wrapping_mul(difference), context)?;
        if !matches!(context, 4 | 6 | 7) {
            self.advance(by, None);
        } else if extremes < 3 {
            self.advance(by, Some(extremes + 1));
        } else {
            self.sequences[self.last].difference = by;
            self.advance(by, Some(0));
        }
        Ok(())
    }

    /// Moves the time of the sequence, and sets its extremes.
    fn advance(&mut self, by: i32, extremes: Option<i32>) {
        let sequence = &mut self.sequences[self.last];
        sequence.time = sequence.time.wrapping_add(by.into());
        sequence.extremes = extremes.unwrap_or(sequence.extremes);
    }

    /// Begins a sequence with an uncompressed time.
    fn begin<R: Read>(&mut self, decoder: &mut ArithmeticDecoder<R>) -> io::Result<()> {
        let high = (self.sequences[self.last].time >> 32) as i32;
        let high = self.numbers.decompress(decoder, high, 8)?;
        let time = i64::from(high) << 32 | i64::from(decoder.read_int()?);
        self.begun = (self.begun + 1) % self.sequences.len();
        self.last = self.begun;
        self.sequences[self.last] = Sequence { time, ..Sequence::default() };
        Ok(())
    }

    /// Goes to another sequence; returns true.
    fn change(&mut self, by: i32) -> bool {
        self.last = (self.last + by as usize) % self.sequences.len();
        true
    }
}

impl<R: Read> FieldDecompressor<R> for Times {
    fn size_of_field(&self) -> usize {
        size_of::<f64>()
    }

    fn decompress_first(&mut self, source: &mut R, point: &mut [u8]) -> io::Result<()> {
        source.read_exact(point)?;
        let bytes = point.try_into().map_err(|_| io::ErrorKind::InvalidInput)?;
        self.sequences[0].time = i64::from_le_bytes(bytes);
        Ok(())
    }

    fn decompress_with(
        &mut self,
        decoder: &mut ArithmeticDecoder<R>,
        point: &mut [u8],
    ) -> io::Result<()> {
        let mut changes = 0;
        while self.step(decoder)? {
            changes += 1;
            if changes > CHANGES {
                return Err(io::ErrorKind::InvalidData.into());
            }
        }
        point.copy_from_slice(&self.sequences[self.last].time.to_le_bytes());
        Ok(())
    }
}
