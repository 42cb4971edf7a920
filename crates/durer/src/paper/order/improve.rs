//! Exchanges and moves that shorten the path through strokes.
//!
//! 2-opt (Croes, *A method for solving traveling-salesman problems*, 1958) and Or-opt (Or, 1976), tried only between
//! ends that are close together and only where something changed since the last try (Bentley, *Fast algorithms for
//! geometric traveling salesman problems*, 1992). The path is a circular array; instead of a long part, the rest is
//! reversed.

use super::ends::{End, Ends};

/// The longest row of strokes that is moved as one.
const LONGEST_ROW: usize = 3;

/// Largest number of strokes that one change reverses or passes: in longer paths, the rare changes that need more save
/// almost nothing.
const LONGEST_PART: usize = 25_000;

/// Limit on the changed places in the array, for each stroke: it bounds the time.
const CHANGES: usize = 2000;

/// Smallest saving of a change, as a part of the replaced distances, so that rounding never causes a cycle of changes.
const WORTH: f64 = 1e-9;

/// A path through all strokes and back to the start.
pub struct Way {
    /// The end that each stroke is entered at.
    sequence: Vec<End>,
    /// The place of each stroke.
    place: Vec<u32>,
    left: usize,
}

impl Way {
    /// Creates all of `count` strokes as they come, and the pen's home.
    pub fn new(count: usize) -> Self {
        let sequence = (0..=count as u32).map(|i| i * 2).collect();
        Self { sequence, place: (0..=count as u32).collect(), left: (count + 1) * CHANGES }
    }

    /// Returns the ends that strokes are entered at, in a circle.
    pub fn sequence(&self) -> &[End] {
        &self.sequence
    }

    /// Returns the same as a row from home on.
    pub fn unrolled(mut self) -> Vec<End> {
        let count = self.sequence.len();
        let home = count - 1;
        let at = self.place[home] as usize;
        self.sequence.rotate_left(at);
        let backwards = self.sequence[0] % 2 == 1;
        let mut rest = self.sequence.split_off(1);
        if backwards {
            rest.reverse();
            rest.iter_mut().for_each(|end| *end ^= 1);
        }
        rest
    }

    /// Changes the path as long as that makes it shorter.
    pub fn improve(&mut self, ends: &Ends) {
        if self.sequence.len() < 3 {
            return;
        }
        let mut waiting: std::collections::VecDeque<u32> = (0..self.place.len() as u32).collect();
        let mut waits = vec![true; self.place.len()];
        while let Some(stroke) = waiting.pop_front() {
            waits[stroke as usize] = false;
            while self.left > 0
                && let Some(touched) = self.change(ends, stroke)
            {
                for end in touched {
                    if !std::mem::replace(&mut waits[end as usize / 2], true) {
                        waiting.push_back(end / 2);
                    }
                }
            }
            if self.left == 0 {
                return;
            }
        }
    }

    /// Makes one saving change at a stroke; returns the ends at which the path changed.
    fn change(&mut self, ends: &Ends, stroke: u32) -> Option<[End; 6]> {
        [stroke * 2, stroke * 2 + 1].into_iter().find_map(|a| {
            let b = self.mate(a);
            let now = ends.distance(a, b);
            let near = ends.near(a).iter().map(|&c| (c, ends.distance(a, c)));
            near.take_while(|(_, to)| *to < now).find_map(|(c, to)| {
                let saved = now - to;
                self.exchange(ends, [a, b, c], saved)
                    .or_else(|| self.move_row(ends, [a, b, c], saved))
            })
        })
    }

    fn is_entry(&self, end: End) -> bool {
        self.sequence[self.place[end as usize / 2] as usize] == end
    }

    fn at(&self, place: usize) -> End {
        self.sequence[place % self.sequence.len()]
    }

    /// Returns the end that a move with the pen up connects with an end.
    fn mate(&self, end: End) -> End {
        let (place, count) = (self.place[end as usize / 2] as usize, self.sequence.len());
        if self.is_entry(end) { self.at(place + count - 1) ^ 1 } else { self.at(place + 1) }
    }

    /// Applies 2-opt where it saves enough: instead of a–b and c–d the pen goes a–c and b–d.
    fn exchange(&mut self, ends: &Ends, [a, b, c]: [End; 3], saved: f64) -> Option<[End; 6]> {
        if self.is_entry(a) != self.is_entry(c) {
            return None;
        }
        let d = self.mate(c);
        let old = ends.distance(c, d);
        let shorter = saved + old - ends.distance(b, d) > WORTH * (old + saved);
        if !shorter {
            return None;
        }
        // The part from the entry after the one move to the exit before the other.
        let (from, to) = if self.is_entry(a) { (a, d) } else { (b, c) };
        let [from, to] = [from, to].map(|end| self.place[end as usize / 2] as usize);
        self.reverse(from, to).then_some([a, b, c, d, a, b])
    }

    /// Applies Or-opt where it saves enough: moves a row of strokes that begins at `a` between c and its mate d,
    /// turned so that a is at c.
    fn move_row(&mut self, ends: &Ends, [a, b, c]: [End; 3], saved: f64) -> Option<[End; 6]> {
        let count = self.sequence.len();
        let d = self.mate(c);
        let gap = ends.distance(c, d);
        let [at, target] = [a, c].map(|end| self.place[end as usize / 2] as usize);
        let forwards = self.is_entry(a);
        for length in 1..=LONGEST_ROW.min(count.saturating_sub(2)) {
            let first = if forwards { at } else { (at + count + 1 - length) % count };
            // Neither of the two ends of the gap is in the row.
            let inside = |place: usize| (place + count - first) % count < length;
            let other = self.place[d as usize / 2] as usize;
            if inside(target) || inside(other) {
                return None;
            }
            let z = if forwards { self.at(first + length - 1) ^ 1 } else { self.at(first) };
            let y = self.mate(z);
            let old = ends.distance(z, y) + gap;
            let new = ends.distance(z, d) + ends.distance(b, y);
            if saved + old - new > WORTH * (saved + old) {
                // The gap is after the stroke whose exit it begins with.
                let c_leaves = !self.is_entry(c);
                let gap_after = if c_leaves { target } else { other };
                let moved = self.shift(first, length, gap_after, forwards != c_leaves);
                return moved.then_some([a, b, c, d, y, z]);
            }
        }
        None
    }

    fn put(&mut self, place: usize, end: End) {
        let place = place % self.sequence.len();
        self.sequence[place] = end;
        self.place[end as usize / 2] = place as u32;
        self.left = self.left.saturating_sub(1);
    }

    /// Reverses the part from place to place or, which gives the same path, all else; returns `false` if that is too
    /// much.
    fn reverse(&mut self, from: usize, to: usize) -> bool {
        let count = self.sequence.len();
        let mut length = (to + count - from) % count + 1;
        let (mut low, mut high) = (from, to);
        if length * 2 > count {
            (low, high, length) = (to + 1, from + count - 1, count - length);
        }
        if length > LONGEST_PART {
            return false;
        }
        for _ in 0..length.div_ceil(2) {
            let (a, b) = (self.at(low), self.at(high));
            self.put(low, b ^ 1);
            self.put(high, a ^ 1);
            (low, high) = (low + 1, (high + count - 1) % count);
        }
        true
    }

    /// Moves the row of this many strokes at `first` behind the stroke at the place `after`, reversed if requested;
    /// `false` if that is too far.
    fn shift(&mut self, first: usize, length: usize, after: usize, reversed: bool) -> bool {
        let count = self.sequence.len();
        let mut row: Vec<End> = (0..length).map(|i| self.at(first + i)).collect();
        if reversed {
            row.reverse();
            row.iter_mut().for_each(|end| *end ^= 1);
        }
        // The strokes between: behind the row, or before it.
        let behind = (after + count - (first + length - 1) % count) % count;
        let before = count - length - behind;
        if behind.min(before) > LONGEST_PART {
            return false;
        }
        let start = if behind <= before {
            for i in 0..behind {
                self.put(first + i, self.at(first + length + i));
            }
            first + behind
        } else {
            for i in 0..before {
                self.put(first + count + length - 1 - i, self.at(first + count - 1 - i));
            }
            first + count - before
        };
        for (i, end) in row.into_iter().enumerate() {
            self.put(start + i, end);
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::super::greedy;
    use super::super::tests::scattered;
    use super::*;
    use crate::math::DVec2;

    #[test]
    fn each_change_makes_the_way_shorter() {
        let strokes = scattered(300);
        let turns = greedy::turns(&strokes, DVec2::ZERO);
        let ends = Ends::new(&strokes, &turns, DVec2::ZERO);
        let mut way = Way::new(turns.len());
        let length = |way: &Way| -> f64 {
            way.sequence.iter().map(|end| ends.distance(way.mate(*end), *end)).sum()
        };
        let (mut now, mut changes) = (length(&way), 0);
        for stroke in (0..301).cycle().take(3000) {
            if way.change(&ends, stroke).is_some() {
                let shorter = length(&way);
                assert!(shorter < now, "{changes}: {shorter} {now}");
                (now, changes) = (shorter, changes + 1);
            }
        }
        assert!(changes > 50, "{changes}");
    }
}
