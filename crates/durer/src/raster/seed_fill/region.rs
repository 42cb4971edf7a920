//! The pixels of an image that may be filled, one bit each.

use std::ops::Range;

use crate::target::Pixels;

/// One bit per pixel: whether it may still be filled.
pub(super) struct Region {
    pub width: usize,
    pub height: usize,
    /// Words of a row.
    pub words: usize,
    pub open: Vec<u64>,
    /// The rows that have been examined.
    known: Range<usize>,
}

impl Region {
    /// Creates an image with only one row known, and nothing open there yet.
    pub fn unread<P: Copy>(image: &Pixels<P>, row: usize) -> Self {
        let (width, height) = (image.width() as usize, image.height() as usize);
        let words = width.div_ceil(64);
        Self { width, height, words, open: vec![0; words * height], known: row..row + 1 }
    }

    /// Creates an image as a whole.
    pub fn new<P: Copy>(image: &Pixels<P>, inside: &impl Fn(P) -> bool) -> Self {
        let mut region = Self::unread(image, 0);
        let rows = region.open.chunks_exact_mut(region.words.max(1));
        for (y, row) in (0..).zip(rows) {
            read_row(image.row(y), inside, row);
        }
        region.known = 0..region.height;
        region
    }

    /// Extends the known rows by an adjacent one; returns its words.
    pub fn learn(&mut self, row: usize) -> &mut [u64] {
        self.known = self.known.start.min(row)..self.known.end.max(row + 1);
        &mut self.open[row * self.words..(row + 1) * self.words]
    }

    /// Examines a row that is known or beside a known one.
    #[inline(always)]
    pub fn know<P: Copy>(&mut self, row: usize, image: &Pixels<P>, inside: &impl Fn(P) -> bool) {
        if !self.known.contains(&row) {
            read_row(image.row(row as u32), inside, self.learn(row));
        }
    }

    pub fn is_open(&self, x: i64, y: i64) -> bool {
        let inside = x >= 0 && y >= 0 && (x as usize) < self.width && (y as usize) < self.height;
        inside && self.open[y as usize * self.words + x as usize / 64] >> (x as usize % 64) & 1 != 0
    }

    /// Fills the pixels of a row of the image that may be filled and are no longer open.
    pub fn paint<P: Copy>(
        &self,
        y: usize,
        pixels: &mut [P],
        value: P,
        inside: &impl Fn(P) -> bool,
    ) {
        for (chunk, open) in pixels.chunks_mut(64).zip(self.row(y)) {
            let taken = bits(chunk, inside) & !open;
            paint_word(chunk, taken, value);
        }
    }

    fn row(&self, y: usize) -> &[u64] {
        &self.open[y * self.words..(y + 1) * self.words]
    }

    /// Returns the first open pixel of a row in `x..end`.
    pub fn next_open(&self, y: usize, x: usize, end: usize) -> Option<usize> {
        let found = next_bit(self.row(y), x, |w| w)?;
        (found < end).then_some(found)
    }

    /// Closes the whole run of open pixels around x; returns it.
    pub fn take_run(&mut self, y: usize, x: usize) -> (usize, usize) {
        let row = self.row(y);
        let end = next_bit(row, x, |w| !w).unwrap_or(self.width).min(self.width);
        let start = previous_closed(row, x).map_or(0, |p| p + 1);
        let base = y * self.words;
        let mut at = start;
        while at < end {
            let stop = end.min((at | 63) + 1);
            self.open[base + at / 64] &= !((u64::MAX >> (64 - (stop - at))) << (at % 64));
            at = stop;
        }
        (start, end)
    }
}

/// Sets a bit for each pixel of a row that may be filled; returns whether all may.
pub(super) fn read_row<P: Copy>(
    pixels: &[P],
    inside: &impl Fn(P) -> bool,
    words: &mut [u64],
) -> bool {
    let (whole, rest) = pixels.as_chunks::<64>();
    let mut all = u64::MAX;
    for (word, pixels) in words.iter_mut().zip(whole) {
        *word = bits(pixels, inside);
        all &= *word;
    }
    if !rest.is_empty()
        && let Some(last) = words.last_mut()
    {
        *last = bits(rest, inside);
        all &= *last | (u64::MAX << rest.len());
    }
    all == u64::MAX
}

/// Returns one bit for each of at most 64 pixels.
#[inline(always)]
fn bits<P: Copy>(pixels: &[P], inside: &impl Fn(P) -> bool) -> u64 {
    // Bytes first, because those are compared many at a time.
    let mut flags = [0_u8; 64];
    if let Some(whole) = pixels.first_chunk::<64>() {
        flags = whole.map(|pixel| u8::from(inside(pixel)));
    } else {
        for (flag, pixel) in flags.iter_mut().zip(pixels) {
            *flag = u8::from(inside(*pixel));
        }
    }
    let eights = || flags.as_chunks::<8>().0.iter().map(|e| u64::from_le_bytes(*e));
    const ALL: u64 = 0x0101_0101_0101_0101;
    if eights().fold(ALL, |all, e| all & e) == ALL {
        return u64::MAX;
    }
    // The product brings the lowest bits of eight bytes side by side into the highest byte.
    let bytes = eights().map(|e| e.wrapping_mul(0x0102_0408_1020_4080) >> 56);
    bytes.enumerate().fold(0, |word, (i, byte)| word | (byte << (8 * i)))
}

/// Returns the first bit from `x` on that is set after `map`.
fn next_bit(row: &[u64], x: usize, map: impl Fn(u64) -> u64) -> Option<usize> {
    let first = map(*row.get(x / 64)?) & (u64::MAX << (x % 64));
    if first != 0 {
        return Some(x / 64 * 64 + first.trailing_zeros() as usize);
    }
    let rest = row.iter().enumerate().skip(x / 64 + 1);
    let mut rest = rest.map(|(i, w)| (i, map(*w))).filter(|(_, w)| *w != 0);
    rest.next().map(|(i, w)| i * 64 + w.trailing_zeros() as usize)
}

/// Returns the last closed pixel before x.
fn previous_closed(row: &[u64], x: usize) -> Option<usize> {
    let last = !row.get(x / 64)? & !(u64::MAX << (x % 64));
    if last != 0 {
        return Some(x / 64 * 64 + 63 - last.leading_zeros() as usize);
    }
    let mut rest = row[..x / 64].iter().enumerate().rev().filter(|(_, w)| **w != u64::MAX);
    rest.next().map(|(i, w)| i * 64 + 63 - (!w).leading_zeros() as usize)
}

/// Writes the value to the pixels of a row whose bits are set.
pub(super) fn paint<P: Copy>(row: &mut [P], words: &[u64], value: P) {
    for (pixels, word) in row.chunks_mut(64).zip(words) {
        paint_word(pixels, *word, value);
    }
}

/// Writes the value to the pixels, of at most 64, whose bits are set.
#[inline(always)]
fn paint_word<P: Copy>(pixels: &mut [P], word: u64, value: P) {
    if word == u64::MAX {
        return pixels.fill(value);
    }
    if word == 0 {
        return;
    }
    // Each bit in its own byte, because bytes are examined many at a time.
    let mut taken = [0_u8; 64];
    for (i, eight) in taken.as_chunks_mut::<8>().0.iter_mut().enumerate() {
        let byte = (word >> (8 * i)) & 255;
        let spread = byte.wrapping_mul(0x0101_0101_0101_0101) & 0x8040_2010_0804_0201;
        *eight = spread.to_le_bytes();
    }
    if let Some(whole) = pixels.first_chunk_mut::<64>() {
        for (pixel, taken) in whole.iter_mut().zip(taken) {
            *pixel = if taken == 0 { *pixel } else { value };
        }
    } else {
        for (pixel, _) in pixels.iter_mut().zip(taken).filter(|(_, taken)| *taken != 0) {
            *pixel = value;
        }
    }
}
