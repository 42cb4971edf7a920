//! Bands of rows, in which outlines are filled, and the edges that each needs.
//!
//! Paths with few edges are stored one after the other in a list. The edges of other paths are made in chunks, on
//! several threads; each chunk knows the edges of every band, and bands read the chunks in order, so the result does
//! not depend on the number of threads.

use std::ops::Range;

use fearless_simd::prelude::*;
use fearless_simd::{i32x4, i32x8};

use crate::curve::Contours;
use crate::parallel;

/// Rows of a band: small enough for its buffers to stay in the second-level cache.
pub(crate) const BAND_ROWS: i32 = 32;
/// Number of edges below which every band goes through the whole path.
pub(crate) const FEW_EDGES: usize = 48;
/// Number of points per chunk: enough to justify a task, and few enough for their edges to stay in the second-level
/// cache until they are sorted.
pub(crate) const CHUNK: usize = 4096;

/// The edges of one path.
#[derive(Debug)]
pub(crate) enum Edges<E> {
    /// A few edges, in a list shared with other paths.
    Few(Range<u32>),
    /// Many, in the order of the path.
    Many(Vec<Chunk<E>>),
}

/// Edges that follow each other in a path, and which of them each band needs.
#[derive(Debug)]
pub(crate) struct Chunk<E> {
    pub edges: Vec<E>,
    index: BandIndex,
}

impl<E> Chunk<E> {
    /// Creates a chunk of edges; `rows` returns the first row of an edge and one past the last.
    pub fn new(edges: Vec<E>, rows: impl Fn(&E) -> (i32, i32)) -> Self {
        let index = BandIndex::new(edges.iter().map(rows));
        Self { edges, index }
    }

    /// Returns its size in bytes.
    pub fn bytes(&self) -> u64 {
        let index = 8 * self.index.stretches.len() + 4 * self.index.starts.len();
        (self.edges.capacity() * size_of::<E>() + index + size_of::<Self>()) as u64
    }
}

impl<E> Edges<E> {
    /// Creates the edges from the items of the list from a place on, in the list or, if they are many, in a chunk.
    pub fn from_list(list: &mut Vec<E>, first: usize, rows: impl Fn(&E) -> (i32, i32)) -> Self {
        match (u32::try_from(first), u32::try_from(list.len())) {
            (Ok(first), Ok(end)) if (end - first) as usize <= FEW_EDGES => Self::Few(first..end),
            _ => Self::Many(vec![Chunk::new(list.split_off(first), rows)]),
        }
    }

    /// Creates the edges from the items of chunks, or, if they are few, of the list.
    pub fn from_chunks(
        chunks: Vec<Chunk<E>>,
        list: &mut Vec<E>,
        rows: impl Fn(&E) -> (i32, i32),
    ) -> Self {
        if chunks.iter().map(|chunk| chunk.edges.len()).sum::<usize>() > FEW_EDGES {
            return Self::Many(chunks);
        }
        let first = list.len();
        list.extend(chunks.into_iter().flat_map(|chunk| chunk.edges));
        Self::from_list(list, first, rows)
    }

    /// Returns the size of the chunks that are not in the list, in bytes.
    pub fn bytes(&self) -> u64 {
        let Self::Many(chunks) = self else { return 0 };
        chunks.iter().map(Chunk::bytes).sum()
    }

    /// Returns the edges of the band at row `top` in the order of the path, perhaps with others
    /// too.
    #[inline(always)]
    pub fn of_band<'a>(&'a self, list: &'a [E], top: i32) -> impl Iterator<Item = &'a [E]> {
        let (few, chunks) = match self {
            Self::Few(range) => (list.get(range.start as usize..range.end as usize), [].as_slice()),
            Self::Many(chunks) => (None, chunks.as_slice()),
        };
        let many = chunks.iter().flat_map(move |chunk| {
            let stretches = chunk.index.stretches(top).iter();
            stretches.filter_map(|(from, to)| chunk.edges.get(*from as usize..*to as usize))
        });
        few.into_iter().chain(many)
    }
}

/// Returns the running sums of eight numbers, starting from `before`.
///
/// Halves are summed for themselves first: to move numbers from one to the other takes longest.
#[inline(always)]
pub(crate) fn running_sums<S: Simd>(simd: S, v: i32x8<S>, before: i32x8<S>) -> i32x8<S> {
    let zero = i32x8::splat(simd, 0);
    let v = v + zero.slide_within_blocks::<3>(v);
    let v = v + zero.slide_within_blocks::<2>(v);
    let first_half = i32x4::splat(simd, v[3]);
    v + before + i32x4::splat(simd, 0).combine(first_half)
}

/// Applies `make` to chunks of the contours' points, several at once, and returns the results in
/// order.
pub(crate) fn by_chunks<M: Send>(
    contours: &Contours,
    size: usize,
    make: impl Fn(Range<usize>) -> M + Sync + Send,
) -> Vec<M> {
    let count = contours.points().len();
    let chunks = (0..count).step_by(size).map(|start| start..(start + size).min(count));
    parallel::map(chunks.collect(), make)
}

/// Edges that follow each other and touch the same bands.
struct Run {
    edges: (u32, u32),
    /// First and last.
    bands: (i32, i32),
}

/// Index of the edges of a chunk that touch each band.
#[derive(Debug, Default)]
struct BandIndex {
    /// The first band touched.
    base: i32,
    /// Ranges of consecutive edges that touch a band, end exclusive, sorted by band, because the ranges of a band are
    /// read together.
    stretches: Vec<(u32, u32)>,
    /// Start of each band's edges in that list, from the first band touched on, and the end of the
    /// last.
    starts: Vec<u32>,
}

impl BandIndex {
    /// Creates the index from the rows of each edge, first and one past the last.
    fn new(edges: impl Iterator<Item = (i32, i32)>) -> Self {
        let mut runs: Vec<Run> = Vec::new();
        let (mut base, mut last) = (i32::MAX, 0);
        let mut now = (-1, -1);
        for (i, (top, bottom)) in (0..).zip(edges) {
            let bands = (top / BAND_ROWS, (bottom - 1).max(top) / BAND_ROWS);
            if bands != now {
                now = bands;
                (base, last) = (base.min(bands.0), last.max(bands.1));
                runs.push(Run { edges: (i, i), bands });
            }
            if let Some(run) = runs.last_mut() {
                run.edges.1 = i + 1;
            }
        }
        Self::from_runs(&runs, base, last)
    }

    /// Creates the index from runs by counting sort.
    fn from_runs(runs: &[Run], base: i32, last: i32) -> Self {
        let bands = (last - base + 1).max(0) as usize;
        let mut starts = vec![0; bands + 1];
        let mut ends = vec![u32::MAX; bands];
        for run in runs {
            let range = (run.bands.0 - base) as usize..(run.bands.1 - base + 1) as usize;
            for (at, end) in range.clone().zip(ends.get_mut(range).into_iter().flatten()) {
                starts[at + 1] += u32::from(*end != run.edges.0);
                *end = run.edges.1;
            }
        }
        for band in 0..bands {
            starts[band + 1] += starts[band];
        }
        let mut stretches = vec![(0, 0); starts.last().map_or(0, |all| *all as usize)];
        let mut next = starts.clone();
        for run in runs {
            let range = (run.bands.0 - base) as usize..(run.bands.1 - base + 1) as usize;
            for (start, next) in starts[range.clone()].iter().zip(&mut next[range]) {
                let own = *next > *start;
                match stretches.get_mut(next.wrapping_sub(1) as usize) {
                    Some((_, end)) if own && *end == run.edges.0 => *end = run.edges.1,
                    _ => {
                        stretches[*next as usize] = run.edges;
                        *next += 1;
                    }
                }
            }
        }
        Self { base, stretches, starts }
    }

    /// Returns the stretches of edges, in the order of the path, that touch the band at row `top`.
    #[inline(always)]
    fn stretches(&self, top: i32) -> &[(u32, u32)] {
        let Ok(band) = usize::try_from(top / BAND_ROWS - self.base) else { return &[] };
        match (self.starts.get(band), self.starts.get(band + 1)) {
            (Some(start), Some(end)) => {
                self.stretches.get(*start as usize..*end as usize).unwrap_or_default()
            }
            _ => &[],
        }
    }
}
