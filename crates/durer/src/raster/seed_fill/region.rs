//! Which pixels of an image may be filled, one bit each.

use crate::target::Pixels;

/// With more runs of open pixels in a word on average, words are better steps than runs.
const RUNS_PER_WORD: u64 = 1;

/// One bit per pixel: whether it may still be filled.
pub(super) struct Region {
    pub width: usize,
    pub height: usize,
    /// Words of a row.
    pub words: usize,
    pub open: Vec<u64>,
    before: Vec<u64>,
}

impl Region {
    pub fn new<P: Copy>(image: &Pixels<P>, inside: impl Fn(P) -> bool) -> Self {
        let (width, height) = (image.width() as usize, image.height() as usize);
        let words = width.div_ceil(64);
        let mut open = Vec::with_capacity(words * height);
        for y in 0..image.height() {
            let chunks = image.row(y).chunks(64);
            open.extend(chunks.map(|chunk| bits(chunk, &inside)));
        }
        Self { width, height, words, before: open.clone(), open }
    }

    pub fn is_open(&self, x: i64, y: i64) -> bool {
        let inside = x >= 0 && y >= 0 && (x as usize) < self.width && (y as usize) < self.height;
        inside && self.open[y as usize * self.words + x as usize / 64] >> (x as usize % 64) & 1 != 0
    }

    /// Per row the words of what has been filled.
    pub fn filled(&self) -> impl Iterator<Item = Vec<u64>> {
        let words = self.words.max(1);
        let pairs = self.before.chunks(words).zip(self.open.chunks(words));
        pairs.map(|(before, after)| before.iter().zip(after).map(|(b, a)| b & !a).collect())
    }

    fn row(&self, y: usize) -> &[u64] {
        &self.open[y * self.words..(y + 1) * self.words]
    }

    /// The first open pixel of a row in `x..end`.
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

    /// Whether there are more runs of open pixels than words, so that words are the better steps.
    pub fn is_broken(&self) -> bool {
        let starts = |word: &u64| u64::from((word & !(word << 1)).count_ones());
        self.open.iter().map(starts).sum::<u64>() > self.open.len() as u64 * RUNS_PER_WORD
    }
}

/// One bit for each of at most 64 pixels.
#[inline(always)]
fn bits<P: Copy>(pixels: &[P], inside: impl Fn(P) -> bool) -> u64 {
    // Bytes first, for those are compared many at a time.
    let mut flags = [0_u8; 64];
    for (flag, pixel) in flags.iter_mut().zip(pixels) {
        *flag = u8::from(inside(*pixel));
    }
    let eights = flags.as_chunks::<8>().0.iter().enumerate();
    // The product brings the lowest bits of eight bytes side by side into the highest byte.
    eights.fold(0, |word, (i, eight)| {
        let eight = u64::from_le_bytes(*eight).wrapping_mul(0x0102_0408_1020_4080) >> 56;
        word | (eight << (8 * i))
    })
}

/// The first bit from `x` on that is set after `map`.
fn next_bit(row: &[u64], x: usize, map: impl Fn(u64) -> u64) -> Option<usize> {
    let first = map(*row.get(x / 64)?) & (u64::MAX << (x % 64));
    if first != 0 {
        return Some(x / 64 * 64 + first.trailing_zeros() as usize);
    }
    let rest = row.iter().enumerate().skip(x / 64 + 1);
    let mut rest = rest.map(|(i, w)| (i, map(*w))).filter(|(_, w)| *w != 0);
    rest.next().map(|(i, w)| i * 64 + w.trailing_zeros() as usize)
}

/// The last closed pixel before x.
fn previous_closed(row: &[u64], x: usize) -> Option<usize> {
    let last = !row.get(x / 64)? & !(u64::MAX << (x % 64));
    if last != 0 {
        return Some(x / 64 * 64 + 63 - last.leading_zeros() as usize);
    }
    let mut rest = row[..x / 64].iter().enumerate().rev().filter(|(_, w)| **w != u64::MAX);
    rest.next().map(|(i, w)| i * 64 + 63 - (!w).leading_zeros() as usize)
}

/// Writes the value to the pixels whose bits are set.
pub(super) fn paint<P: Copy>(row: &mut [P], words: &[u64], value: P) {
    for (pixels, word) in row.chunks_mut(64).zip(words) {
        if *word == u64::MAX {
            pixels.fill(value);
            continue;
        }
        for (pixels, byte) in pixels.chunks_mut(8).zip(word.to_le_bytes()) {
            if byte != 0 {
                // Each bit in its own byte, so that all of them are looked at at once.
                let spread = (u64::from(byte) * 0x0101_0101_0101_0101) & 0x8040_2010_0804_0201;
                for (pixel, set) in pixels.iter_mut().zip(spread.to_le_bytes()) {
                    *pixel = if set == 0 { *pixel } else { value };
                }
            }
        }
    }
}
