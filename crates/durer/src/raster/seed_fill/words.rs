//! Seed fill by words: the reached pixels among 64 of a row are found at once.
//!
//! Where runs of open pixels are short, a fill by spans spends most of its time finding the next run. A word takes all
//! its runs together: seeds run to the right by an addition, whose carries stop at closed pixels, to the left by
//! doubling steps, and the reached pixels seed the adjacent words.

use super::region::Region;
use crate::target::Pixels;

/// Words with seeds that have not been followed.
pub(super) struct Waiting {
    eight: bool,
    seeds: Vec<u64>,
    /// Seeded words: row, and word in the row.
    stack: Vec<(u32, u32)>,
}

impl Waiting {
    /// Creates an empty list for a region.
    pub fn new(region: &Region, eight: bool) -> Self {
        Self { eight, seeds: vec![0; region.open.len()], stack: Vec::new() }
    }

    #[inline(always)]
    fn add(&mut self, (row, word): (usize, usize), at: usize, seeds: u64) {
        if seeds != 0 {
            if self.seeds[at] == 0 {
                self.stack.push((row as u32, word as u32));
            }
            self.seeds[at] |= seeds;
        }
    }

    /// Adds the open pixels of a row next to those reached in a neighbouring row; if fills go diagonally too, `reached`
    /// has been widened by one pixel on each side.
    pub fn add_beside(&mut self, row: usize, reached: &[u64], region: &Region) {
        let start = row * region.words;
        for (i, beside) in reached.iter().enumerate() {
            self.add((row, i), start + i, region.open[start + i] & beside);
        }
    }

    /// Follows all seeds; returns how many pixels they reach, and sets the flags of the rows in which some are.
    pub fn follow<P: Copy>(
        &mut self,
        region: &mut Region,
        image: &Pixels<P>,
        inside: &impl Fn(P) -> bool,
        late: &mut [bool],
    ) -> u64 {
        let words = region.words;
        let mut found = 0;
        while let Some((row, column)) = self.stack.pop() {
            let (row, column) = (row as usize, column as usize);
            let at = row * words + column;
            let seeds = std::mem::take(&mut self.seeds[at]);
            let open = region.open[at];
            let reached = leftwards(rightwards(seeds & open, open), open);
            region.open[at] = open & !reached;
            found += u64::from(reached.count_ones());
            late[row] = true;
            let (left, right) =
                (column > 0 && reached & 1 != 0, column + 1 < words && reached >> 63 != 0);
            if left {
                self.add((row, column - 1), at - 1, region.open[at - 1] & (1 << 63));
            }
            if right {
                self.add((row, column + 1), at + 1, region.open[at + 1] & 1);
            }
            let beside =
                if self.eight { reached | (reached << 1) | (reached >> 1) } else { reached };
            for next in [row.wrapping_sub(1), row + 1] {
                if next >= region.height {
                    continue;
                }
                region.know(next, image, inside);
                let at = next * words + column;
                self.add((next, column), at, region.open[at] & beside);
                if self.eight && left {
                    self.add((next, column - 1), at - 1, region.open[at - 1] & (1 << 63));
                }
                if self.eight && right {
                    self.add((next, column + 1), at + 1, region.open[at + 1] & 1);
                }
            }
        }
        found
    }
}

/// Returns the pixels reached to the right of seeds, which are open, as far as pixels are.
#[inline(always)]
pub(super) fn rightwards(seeds: u64, open: u64) -> u64 {
    // The carry of the lowest seed of a run clears it to its end; further seeds only set their own bits again.
    ((open.wrapping_add(seeds) ^ open) & open) | seeds
}

/// Returns the pixels reached to the left of seeds, which are open, as far as pixels are.
#[inline(always)]
pub(super) fn leftwards(seeds: u64, open: u64) -> u64 {
    let (mut left, mut through) = (seeds, open);
    for step in [1, 2, 4] {
        left |= through & (left >> step);
        through &= through >> step;
    }
    // Most runs are not as long.
    if through & (left >> 8) != 0 {
        for step in [8, 16, 32] {
            left |= through & (left >> step);
            through &= through >> step;
        }
    }
    left
}

/// Adds the pixels left and right of those whose bits are set.
pub(super) fn widen(words: &mut [u64]) {
    let mut before = 0;
    for i in 0..words.len() {
        let (own, next) = (words[i], words.get(i + 1).copied().unwrap_or(0));
        words[i] = own | (own << 1) | (before >> 63) | (own >> 1) | (next << 63);
        before = own;
    }
}

#[cfg(test)]
mod tests {
    use super::{leftwards, rightwards};

    #[test]
    fn runs_with_seeds_are_found() {
        let mut state = 1_u64;
        let mut next = || {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            state
        };
        for round in 0..500 {
            let open = if round % 2 == 0 { next() | next() } else { next() & (next() | next()) };
            let seeds = next() & next() & open;
            let mut expected = seeds;
            for _ in 0..64 {
                expected |= ((expected << 1) | (expected >> 1)) & open;
            }
            assert_eq!(leftwards(rightwards(seeds, open), open), expected, "{seeds:x} {open:x}");
        }
    }
}
