//! Stable sorting with little machine code. `[T]::sort_by` is compiled anew for each comparison, 8 KB every time; here
//! one sort of indices serves all, and a list takes the order that they have.
//!
//! A comparison costs a call through a pointer, so a long list takes up to twice the time. Lists that are long where
//! time matters are sorted by `[T]::sort_by`.

use std::cmp::Ordering;

/// Length up to which the indices are on the stack.
const FEW: usize = 32;

/// Sorting by indices, for lists that are short or sorted once.
pub trait CompactSort<T> {
    /// Sorts by a comparison, and keeps the order of equals.
    fn compact_sort_by(&mut self, compare: impl FnMut(&T, &T) -> Ordering);

    /// Sorts by a key, and keeps the order of equals.
    fn compact_sort_by_key<K: Ord>(&mut self, key: impl Fn(&T) -> K);
}

impl<T> CompactSort<T> for [T] {
    #[inline]
    fn compact_sort_by(&mut self, compare: impl FnMut(&T, &T) -> Ordering) {
        sort(self.len(), &mut Listed { list: self, compare });
    }

    #[inline]
    fn compact_sort_by_key<K: Ord>(&mut self, key: impl Fn(&T) -> K) {
        self.compact_sort_by(|a, b| key(a).cmp(&key(b)));
    }
}

/// A list whose elements are compared and exchanged by their indices.
trait Indexed {
    fn compare(&mut self, a: usize, b: usize) -> Ordering;
    fn swap(&mut self, a: usize, b: usize);
}

/// A list with the comparison of its elements.
struct Listed<'a, T, F> {
    list: &'a mut [T],
    compare: F,
}

impl<T, F: FnMut(&T, &T) -> Ordering> Indexed for Listed<'_, T, F> {
    fn compare(&mut self, a: usize, b: usize) -> Ordering {
        (self.compare)(&self.list[a], &self.list[b])
    }

    fn swap(&mut self, a: usize, b: usize) {
        self.list.swap(a, b);
    }
}

/// Sorts a list of `count` elements. Not generic, so that it is compiled once and not for each caller.
#[inline(never)]
fn sort(count: usize, list: &mut dyn Indexed) {
    let mut few = [0; FEW];
    let mut many = Vec::new();
    let order = match few.get_mut(..count) {
        Some(few) => few,
        None => {
            many.resize(count, 0);
            &mut many[..]
        }
    };
    order.iter_mut().enumerate().for_each(|(place, index)| *index = place);
    order.sort_by(|&a, &b| list.compare(a, b));
    // Each cycle of the permutation moves one element out of the way, and the others to their places.
    for start in 0..count {
        let mut place = start;
        loop {
            let from = std::mem::replace(&mut order[place], place);
            if from == start {
                break;
            }
            list.swap(place, from);
            place = from;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Checks lists on the stack and longer ones, with equal keys, against the standard library.
    #[test]
    fn results_are_those_of_the_standard_library() {
        for count in [0, 1, 2, 3, 20, 31, 32, 33, 100, 1000] {
            for keys in [1, 2, 7, 10_000] {
                let list: Vec<(u64, u64)> = (0..count)
                    .map(|i: u64| (i.wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 40) % keys)
                    .zip(0..)
                    .collect();
                let mut expected = list.clone();
                expected.sort_by_key(|a| std::cmp::Reverse(a.0));
                let mut sorted = list.clone();
                sorted.compact_sort_by(|a, b| b.0.cmp(&a.0));
                assert_eq!(sorted, expected, "{count} {keys}");
                expected.sort_by_key(|a| a.0);
                sorted.compact_sort_by_key(|a| a.0);
                assert_eq!(sorted, expected, "{count} {keys}");
            }
        }
    }
}
