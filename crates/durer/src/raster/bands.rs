//! Bands of rows, in which outlines are filled, and which edges each of them needs.

use std::ops::Range;

/// Rows of a band: small enough for its buffers to stay in the second-level cache.
pub(crate) const BAND_ROWS: i32 = 32;
/// Paths with fewer edges are gone through as a whole in every band.
const FEW_EDGES: usize = 48;
/// Which edges of a path touch each band.
#[derive(Debug, Clone, Default)]
pub(crate) struct BandIndex {
    edges: u32,
    /// The first band touched.
    base: i32,
    /// Edges that follow each other and all touch one band, first and one past the last, band after band, for those
    /// of a band are read one after the other; empty for paths of few edges.
    stretches: Vec<(u32, u32)>,
    /// Where in that list each band's begin, from the first band touched on, and the end of the last.
    starts: Vec<u32>,
}

impl BandIndex {
    /// The index of a path from the rows of each edge, first and one past the last, all within those of the path.
    pub fn new(path: (i32, i32), edges: impl ExactSizeIterator<Item = (i32, i32)> + Clone) -> Self {
        let (count, base) = (edges.len(), path.0 / BAND_ROWS);
        let mut index = Self { edges: count as u32, base, ..Self::default() };
        if count <= FEW_EDGES {
            return index;
        }
        let band = |row: i32| (row / BAND_ROWS - base) as usize;
        let bands = band((path.1 - 1).max(path.0)) + 1;
        // Counted first, then put in their places.
        let mut ends = vec![u32::MAX; bands];
        index.starts = vec![0; bands + 1];
        each_band(edges.clone(), band, |i, band| {
            let new = ends.get(band) != Some(&i);
            if let (Some(end), Some(count)) = (ends.get_mut(band), index.starts.get_mut(band + 1)) {
                *end = i + 1;
                *count += u32::from(new);
            }
        });
        for band in 0..bands {
            index.starts[band + 1] += index.starts[band];
        }
        index.stretches = vec![(0, 0); index.starts[bands] as usize];
        let mut next = index.starts.clone();
        each_band(edges, band, |i, band| {
            let Some(next) = next.get_mut(band) else { return };
            let own = index.starts.get(band).is_some_and(|start| *next > *start);
            let last = index.stretches.get_mut(next.wrapping_sub(1) as usize);
            match last.filter(|last| own && last.1 == i) {
                Some(last) => last.1 = i + 1,
                None => {
                    if let Some(stretch) = index.stretches.get_mut(*next as usize) {
                        *stretch = (i, i + 1);
                    }
                    *next += 1;
                }
            }
        });
        index
    }

    /// The stretches of edges, in the order of the path, that touch the band at row `top`; perhaps with others too.
    #[inline(always)]
    pub fn stretches(&self, top: i32) -> impl Iterator<Item = Range<usize>> {
        let band = (top / BAND_ROWS - self.base).max(0) as usize;
        let own = match (self.starts.get(band), self.starts.get(band + 1)) {
            (Some(start), Some(end)) => {
                self.stretches.get(*start as usize..*end as usize).unwrap_or_default()
            }
            _ => &[],
        };
        let few = self.starts.is_empty().then_some((0, self.edges));
        few.into_iter().chain(own.iter().copied()).map(|(a, b)| a as usize..b as usize)
    }
}

/// Calls `f` with the number of each edge and every band that it touches.
fn each_band(
    edges: impl Iterator<Item = (i32, i32)>,
    band: impl Fn(i32) -> usize,
    mut f: impl FnMut(u32, usize),
) {
    for (i, (top, bottom)) in (0..).zip(edges) {
        for at in band(top)..=band((bottom - 1).max(top)) {
            f(i, at);
        }
    }
}
