//! Seed fill without a tracer: row by row away from the seed, then word by word for the rest.
//!
//! Most of a region is directly below or above the part already reached. So one pass goes down from the seed and one
//! up: each row is examined and filled while it is in the cache. Parts behind a turn of the region are left as seeds in
//! the rows already passed, and are filled by words ([`super::words`]).

use super::region::{Region, paint, read_row};
use super::words::{Waiting, leftwards, rightwards, widen};
use crate::target::Pixels;

/// Bytes for each 64 pixels beside their bits: their seeds, and a place on the stack, which each word has at most once.
pub(super) const PER_WORD: u64 = 16;

/// Fills the pixels connected with the seed, a pixel inside; returns their number.
pub(super) fn fill<P: Copy>(
    image: &mut Pixels<P>,
    (x, y): (u32, u32),
    value: P,
    inside: &impl Fn(P) -> bool,
    eight: bool,
) -> u64 {
    let mut region = Region::unread(image, y as usize);
    let mut waiting = Waiting::new(&region, eight);
    let (seed, height) = (y as usize, region.height);
    let mut row = Row::new(region.words, eight);
    row.reached[x as usize / 64] = 1 << (x % 64);
    row.full = read_row(image.row(y), inside, &mut row.open);
    row.spread();
    let mut found = row.fill(image.row_mut(y), value, region.learn(seed));
    let (first, left) = (row.reached.clone(), row.left);
    // Advances by one row; returns whether there is anything to fill.
    let mut pass = |row: &mut Row, y: usize, before: usize| {
        row.full = read_row(image.row(y as u32), inside, &mut row.open);
        if !row.enter() {
            return false;
        }
        row.spread();
        let left = row.left;
        found += row.fill(image.row_mut(y as u32), value, region.learn(y));
        if left {
            waiting.add_beside(before, &row.reached, &region);
        }
        true
    };
    for y in seed + 1..height {
        if !pass(&mut row, y, y - 1) {
            break;
        }
    }
    (row.reached, row.left) = (first, left);
    for y in (0..seed).rev() {
        if !pass(&mut row, y, y + 1) {
            break;
        }
    }
    let mut late = vec![false; height];
    found += waiting.follow(&mut region, image, inside, &mut late);
    for (y, _) in late.iter().enumerate().filter(|(_, late)| **late) {
        region.paint(y, image.row_mut(y as u32), value, inside);
    }
    found
}

/// The current row of a pass through an image.
struct Row {
    eight: bool,
    /// Pixels that may be filled.
    open: Vec<u64>,
    /// True if all of it may.
    full: bool,
    /// Pixels that are reached; once they are filled, those that adjacent rows may touch.
    reached: Vec<u64>,
    /// True if open pixels are left behind in the row filled last.
    left: bool,
}

impl Row {
    fn new(words: usize, eight: bool) -> Self {
        Self { eight, open: vec![0; words], full: false, reached: vec![0; words], left: false }
    }

    /// Steps from the row before into this one, to the open pixels next to those reached there; returns whether there
    /// are any.
    fn enter(&mut self) -> bool {
        let mut any = 0;
        for (reached, open) in self.reached.iter_mut().zip(&self.open) {
            *reached &= open;
            any |= *reached;
        }
        any != 0
    }

    /// Extends the reached pixels to whole runs of open ones.
    fn spread(&mut self) {
        if self.full {
            return self.reached.copy_from_slice(&self.open);
        }
        let mut carry = 0;
        for (reached, open) in self.reached.iter_mut().zip(&self.open) {
            *reached = rightwards(*reached | (carry & open), *open);
            carry = *reached >> 63;
        }
        carry = 0;
        for (reached, open) in self.reached.iter_mut().zip(&self.open).rev() {
            let seeds = *reached | (carry & open);
            *reached = if seeds == 0 { 0 } else { leftwards(seeds, *open) };
            carry = *reached << 63;
        }
    }

    /// Fills the reached pixels and leaves the rest open; returns how many pixels were filled.
    fn fill<P: Copy>(&mut self, pixels: &mut [P], value: P, rest: &mut [u64]) -> u64 {
        self.left = !self.full;
        if self.full {
            pixels.fill(value);
            return pixels.len() as u64;
        }
        paint(pixels, &self.reached, value);
        let mut found = 0;
        for ((rest, open), reached) in rest.iter_mut().zip(&self.open).zip(&self.reached) {
            *rest = open & !reached;
            found += u64::from(reached.count_ones());
        }
        if self.eight {
            widen(&mut self.reached);
        }
        found
    }
}
