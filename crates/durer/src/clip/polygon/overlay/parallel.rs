//! The same work on one thread or several, joined in order, so that the result is the same.

pub use crate::parallel::{alone, map, threads};
use std::cmp::Ordering;
use std::ops::Range;

/// Sorts by an order that no two different items are equal in; items in runs cost little.
pub fn sort<T: Send>(list: &mut [T], compare: impl Fn(&T, &T) -> Ordering + Sync) {
    #[cfg(feature = "parallel")]
    if crate::parallel::threads() > 1 {
        use rayon::prelude::*;
        return list.par_sort_by(compare);
    }
    list.sort_by(compare);
}

/// Returns ranges of at most `size` that cover `0..count`.
pub fn ranges(count: usize, size: usize) -> Vec<Range<usize>> {
    (0..count).step_by(size).map(|start| start..(start + size).min(count)).collect()
}

/// Returns a list in as many pieces of neighbours as give each thread some, one for one thread.
pub fn groups<T>(mut list: Vec<T>) -> Vec<Vec<T>> {
    let threads = if list.is_empty() { 1 } else { threads() };
    let pieces = if threads == 1 { 1 } else { threads * PIECES };
    let size = list.len().div_ceil(pieces).max(1);
    let mut groups = Vec::with_capacity(pieces);
    while list.len() > size {
        groups.push(list.split_off(list.len() - size));
    }
    groups.push(list);
    groups.reverse();
    groups
}

/// Pieces of work for each thread, so that none waits long for the others.
const PIECES: usize = 8;

/// Returns a list cut at `ends`, which grow up to its length.
pub fn cut<'a, T>(mut list: &'a mut [T], ends: &[u32]) -> Vec<&'a mut [T]> {
    let mut start = 0;
    let mut pieces = Vec::with_capacity(ends.len());
    for &end in ends {
        let (piece, rest) = list.split_at_mut((end - start) as usize);
        pieces.push(piece);
        (list, start) = (rest, end);
    }
    pieces
}

/// Returns the end of each list if the lists follow one another.
pub fn ends(lengths: impl Iterator<Item = usize>) -> Vec<u32> {
    let mut end = 0;
    lengths
        .map(|length| {
            end += length as u32;
            end
        })
        .collect()
}

/// Returns the range that ends at `ends[index]`.
pub fn range(ends: &[u32], index: usize) -> Range<usize> {
    let start = index.checked_sub(1).map_or(0, |before| ends[before]);
    start as usize..ends[index] as usize
}

/// Less than this is filled faster than it is shared out.
#[cfg(feature = "parallel")]
const FILLS: usize = if cfg!(test) { 8 } else { 1 << 16 };

/// Returns a vector of copies of a value: the first write to each page of memory costs a page fault, so threads share
/// that work too.
pub fn filled<T: Copy + Send + Sync>(value: T, count: usize) -> Vec<T> {
    #[cfg(feature = "parallel")]
    if count > FILLS && threads() > 1 {
        use rayon::prelude::*;
        let mut list = Vec::new();
        // `collect` would also be compiled for iterators of unknown length.
        rayon::iter::repeat_n(value, count).with_min_len(FILLS / 4).collect_into_vec(&mut list);
        return list;
    }
    vec![value; count]
}

/// Returns all lists, one after the other.
pub fn concat<T: Copy + Default + Send + Sync>(lists: &[&[T]]) -> Vec<T> {
    if threads() == 1 {
        return lists.concat();
    }
    let ends = ends(lists.iter().map(|list| list.len()));
    let mut all = filled(T::default(), ends.last().copied().unwrap_or(0) as usize);
    let tasks = cut(&mut all, &ends).into_iter().zip(lists).collect();
    map(tasks, |(to, from): (&mut [T], &&[T])| to.copy_from_slice(from));
    all
}
