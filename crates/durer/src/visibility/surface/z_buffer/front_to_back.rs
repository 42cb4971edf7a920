//! A tile's triangles roughly from near to far, so that most of those that nothing is seen of are
//! skipped by one comparison with the farthest depth where they lie.
//!
//! The order does not show in the picture: at equal depths the lower item wins, whatever comes first.
//!
//! Source: N. Greene, M. Kass, G. Miller, *Hierarchical Z-buffer visibility*, SIGGRAPH 1993; here with
//! one level above the samples, and buckets instead of an octree. Cost: O(triangles + samples).

use super::bins::Bins;
use crate::visibility::surface::setup::{Coverage, ScreenTriangle};

/// Tiles with fewer triangles are not worth it.
const FEWEST: usize = 64;

/// Ranges of depth that triangles are told apart by.
const BUCKETS: usize = 64;

/// After so many parts of the triangles the farthest depths are found anew.
pub const PARTS: usize = 4;

/// The opaque triangles of one tile.
#[derive(Default)]
pub struct FrontToBack<'a> {
    given: Vec<&'a ScreenTriangle>,
    sorted: Vec<&'a ScreenTriangle>,
}

impl<'a> FrontToBack<'a> {
    /// The triangles in parts, near ones first: one part where they are few.
    pub fn parts(
        &mut self,
        bins: &'a [Bins],
        tile: u32,
    ) -> impl Iterator<Item = &[&'a ScreenTriangle]> {
        self.given.clear();
        for bins in bins.iter().filter(|b| b.coverage == Coverage::Opaque) {
            self.given.extend(bins.of_tile(tile));
        }
        let few = self.given.len() < FEWEST;
        if !few {
            self.sort();
        }
        let (triangles, parts) = if few { (&self.given, 1) } else { (&self.sorted, PARTS) };
        triangles.chunks(triangles.len().div_ceil(parts).max(1))
    }

    /// A counting sort by the depth of the nearest vertex.
    fn sort(&mut self) {
        let (mut nearest, mut farthest) = (f32::INFINITY, f32::NEG_INFINITY);
        for t in &self.given {
            nearest = nearest.min(t.depth_min);
            farthest = farthest.max(t.depth_min);
        }
        // Where all are equally near the product is no number, and the cast gives bucket 0.
        let scale = BUCKETS as f32 / (farthest - nearest);
        let bucket =
            |t: &ScreenTriangle| (((t.depth_min - nearest) * scale) as usize).min(BUCKETS - 1);
        let mut next = [0; BUCKETS + 1];
        for t in &self.given {
            next[bucket(t) + 1] += 1;
        }
        for i in 1..BUCKETS {
            next[i] += next[i - 1];
        }
        self.sorted.clear();
        self.sorted.extend_from_slice(&self.given);
        for t in &self.given {
            let slot = &mut next[bucket(t)];
            self.sorted[*slot] = t;
            *slot += 1;
        }
    }
}
