//! Seed fill by words: what of 64 pixels of a row is reached, all at once.
//!
//! Where runs of open pixels are short, most of a fill by spans is finding where the next one begins. A word takes
//! all its runs together: seeds run to the right by an addition, whose carries stop at closed pixels, to the left by
//! doubling steps, and what they reach seeds the words around.

use super::Step;
use super::region::Region;
use crate::trace::Tracer;

/// Fills what is connected with the seed, an open pixel; returns how many pixels that are.
pub(super) fn fill(
    region: &mut Region,
    seed: (u32, u32),
    eight: bool,
    t: &mut impl Tracer<Step>,
) -> u64 {
    let words = region.words;
    let mut waiting = Waiting { seeds: vec![0; region.open.len()], stack: Vec::new() };
    let start = seed.1 as usize * words + seed.0 as usize / 64;
    waiting.add(start, 1 << (seed.0 % 64));
    let mut found = 0;
    while let Some(word) = waiting.stack.pop() {
        let seeds = std::mem::take(&mut waiting.seeds[word]);
        let open = &mut region.open;
        let reached = runs(seeds & open[word], open[word]);
        open[word] &= !reached;
        found += u64::from(reached.count_ones());
        let (y, column) = (word / words, word % words);
        trace(reached, y, column, t);
        let (first, last) = (reached & 1, reached >> 63);
        if first != 0 && column > 0 {
            waiting.add(word - 1, open[word - 1] & (1 << 63));
        }
        if last != 0 && column + 1 < words {
            waiting.add(word + 1, open[word + 1] & 1);
        }
        let beside = if eight { reached | (reached << 1) | (reached >> 1) } else { reached };
        for row in [word.wrapping_sub(words), word + words] {
            let Some(above) = open.get(row) else { continue };
            waiting.add(row, above & beside);
            if eight && first != 0 && column > 0 {
                waiting.add(row - 1, open[row - 1] & (1 << 63));
            }
            if eight && last != 0 && column + 1 < words {
                waiting.add(row + 1, open[row + 1] & 1);
            }
        }
    }
    found
}

/// Words with seeds that have not been followed.
struct Waiting {
    seeds: Vec<u64>,
    stack: Vec<usize>,
}

impl Waiting {
    #[inline(always)]
    fn add(&mut self, word: usize, seeds: u64) {
        if seeds != 0 {
            if self.seeds[word] == 0 {
                self.stack.push(word);
            }
            self.seeds[word] |= seeds;
        }
    }
}

/// The runs of open pixels of a word in which there is a seed; seeds are open.
#[inline(always)]
fn runs(seeds: u64, open: u64) -> u64 {
    // The carry of the lowest seed of a run clears it to its end; further seeds only set their own bits again.
    let right = ((open.wrapping_add(seeds) ^ open) & open) | seeds;
    let (mut left, mut through) = (right, open);
    for step in [1, 2, 4, 8, 16, 32] {
        left |= through & (left >> step);
        through &= through >> step;
    }
    left
}

/// Tells a listener of the runs reached.
fn trace(mut reached: u64, y: usize, column: usize, t: &mut impl Tracer<Step>) {
    while reached != 0 {
        let start = reached.trailing_zeros();
        let end = start + (!(reached >> start)).trailing_zeros().min(64 - start);
        let mut listens = false;
        t.step(|| {
            listens = true;
            let x = (column * 64) as u32;
            Step { y: y as u32, x0: x + start, x1: x + end }
        });
        if !listens {
            return;
        }
        reached &= u64::MAX.checked_shl(end).unwrap_or(0);
    }
}

#[cfg(test)]
mod tests {
    use super::runs;

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
            assert_eq!(runs(seeds, open), expected, "{seeds:x} {open:x}");
        }
    }
}
