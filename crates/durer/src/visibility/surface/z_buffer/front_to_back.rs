//! A tile's triangles roughly from near to far, so that one comparison with the farthest depth in their area skips most
//! hidden ones.
//!
//! The picture does not depend on the order: at equal depths the lower item wins.
//!
//! Source: N. Greene, M. Kass, G. Miller, *Hierarchical Z-buffer visibility*, SIGGRAPH 1993; here with
//! one level above the samples, and buckets instead of an octree. Cost: O(triangles + samples).

use super::bins::Binned;
use crate::visibility::surface::setup::{Coverage, ScreenTriangle};

/// Number of triangles below which sorting a tile costs more than it saves.
const FEWEST: usize = 64;

/// Ranges of depth into which triangles are sorted.
const BUCKETS: usize = 64;

/// Parts of the triangles, in 64ths, after which the farthest depths are recomputed: the first parts are small because
/// the nearest layer hides most.
const PARTS: [usize; 6] = [1, 4, 16, 32, 48, 64];

/// The triangles of one tile that are ordered.
#[derive(Default)]
pub struct FrontToBack<'a> {
    given: Vec<&'a ScreenTriangle>,
    /// The depth of the nearest vertex of each; read only once, because the triangles are far apart in memory.
    depths: Vec<f32>,
    sorted: Vec<&'a ScreenTriangle>,
}

impl<'a> FrontToBack<'a> {
    /// Returns the triangles in parts, near ones first: a single part if they are few.
    pub fn parts(
        &mut self,
        binned: &'a Binned,
        tile: u32,
    ) -> impl Iterator<Item = &[&'a ScreenTriangle]> {
        self.given.clear();
        for bins in binned.having(Coverage::Opaque) {
            self.given.extend(bins.of_tile(tile));
        }
        let few = self.given.len() < FEWEST;
        if !few {
            self.sort();
        }
        let (triangles, parts) =
            if few { (&self.given, &PARTS[5..]) } else { (&self.sorted, &PARTS[..]) };
        let part = |of_64: usize| triangles.len() * of_64 / 64;
        let mut from = 0;
        parts.iter().map(move |&of_64| {
            let part = &triangles[from..part(of_64)];
            from += part.len();
            part
        })
    }

    /// Returns the blended triangles of a tile by the depth of their nearest vertex.
    pub fn nearest_first(&mut self, binned: &'a Binned, tile: u32) -> &[&'a ScreenTriangle] {
        self.given.clear();
        for bins in binned.having(Coverage::Blended) {
            self.given.extend(bins.of_tile(tile));
        }
        self.given.sort_by(|s, t| s.depth_min.total_cmp(&t.depth_min));
        &self.given
    }

    /// Sorts by the depth of the nearest vertex, by counting.
    fn sort(&mut self) {
        self.depths.clear();
        self.depths.extend(self.given.iter().map(|t| t.depth_min));
        let nearest = self.depths.iter().copied().fold(f32::INFINITY, f32::min);
        let farthest = self.depths.iter().copied().fold(f32::NEG_INFINITY, f32::max);
        // If all are equally near, the product is NaN, and the cast yields bucket 0.
        let scale = BUCKETS as f32 / (farthest - nearest);
        let bucket = |depth: f32| (((depth - nearest) * scale) as usize).min(BUCKETS - 1);
        let mut next = [0; BUCKETS + 1];
        for &depth in &self.depths {
            next[bucket(depth) + 1] += 1;
        }
        for i in 1..BUCKETS {
            next[i] += next[i - 1];
        }
        self.sorted.clear();
        self.sorted.extend_from_slice(&self.given);
        for (t, &depth) in self.given.iter().zip(&self.depths) {
            let slot = &mut next[bucket(depth)];
            self.sorted[*slot] = t;
            *slot += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::bins::Source;
    use super::super::rasterize::{AllPass, rasterize};
    use super::super::tile::SamplePlane;
    use super::*;
    use crate::math::{DVec3, Vec3};
    use crate::scene::{Camera, Mesh, Projection, Scene};
    use crate::simd::Level;
    use crate::simd::dispatch;
    use crate::testing::{camera, scene_of};
    use crate::view::View;
    use crate::visibility::surface::setup::{TriangleFilter, runs};
    use crate::visibility::surface::{Cull, Samples};
    use crate::work::Work;

    /// Creates far triangles, then a wall of many small ones in front of most of them; in the right half of the last
    /// rows nothing hides them.
    fn scene() -> (Scene, View) {
        let mut positions = Vec::new();
        for i in 0..300_u32 {
            let (x, y) = ((i % 20) as f32 / 10.0 - 1.0, (i / 20) as f32 / 7.5 - 1.0);
            let z = -0.2 - (i * 37 % 64) as f32 / 100.0;
            positions.extend(
                [(0.0, 0.0), (0.2, 0.0), (0.0, 0.2)].map(|(a, b)| Vec3::new(x + a, y + b, z)),
            );
        }
        for (x, y) in (0..8).flat_map(|y| (0..8).map(move |x| (x, y))) {
            if y == 0 && x >= 4 {
                continue;
            }
            let at = |i: i32, j: i32| Vec3::new(i as f32 / 4.0 - 1.0, j as f32 / 4.0 - 1.0, 0.5);
            let [a, b, c, d] = [at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)];
            positions.extend([a, b, c, a, c, d]);
        }
        let scene = scene_of(Mesh { positions, ..Mesh::default() });
        let camera = camera(DVec3::Z * 2.0, Projection::Orthographic { height: 2.0 });
        let camera = Camera { near: 1.0, far: 4.0, ..camera };
        (scene, View::new(camera, 64, 64).expect("view"))
    }

    #[test]
    fn what_a_wall_hides_is_skipped_and_the_picture_stays() {
        let (scene, view) = scene();
        let runs = runs(&scene).expect("runs");
        for samples in [Samples::One, Samples::Four] {
            let level = Level::new();
            let filter = TriangleFilter::new(Cull::None, 128);
            let (scene, view, runs) = (&scene, &view, runs.as_slice());
            let source = Source { scene, view, runs, filter, early: &[], lighting: None, level };
            let binned = Binned::new(&source, &Work::default()).expect("no limit");
            let area = [[0, 0], [64, 64]];
            let mut order = FrontToBack::default();
            let (mut given, mut skipped) = (Vec::new(), 0);
            let mut sorted = SamplePlane::of(samples.offsets());
            for (i, part) in order.parts(&binned, 0).enumerate() {
                dispatch!(level, simd => {
                    if i > 0 {
                        sorted.iter_mut().for_each(|plane| plane.find_farthest(simd));
                    }
                    let hidden = |t: &&&ScreenTriangle| {
                        let [x0, y0, x1, y1] = t.pixel_bounds(128).expect("pixels");
                        let in_tile = [x0.max(0), y0.max(0), x1.min(63), y1.min(63)];
                        sorted.iter().all(|p| p.hides(in_tile, t.depth_min.to_bits() as i32))
                    };
                    skipped += part.iter().filter(hidden).count();
                    rasterize(simd, &mut sorted, area, part.iter().copied(), None::<&mut AllPass>)
                });
                given.extend(part.iter().map(|t| t.item));
            }
            assert!(skipped > 150, "{skipped} of {}", given.len());
            given.sort_unstable();
            let all = binned.having(Coverage::Opaque).flat_map(|bins| bins.of_tile(0));
            assert!(given.into_iter().eq(all.map(|t| t.item)), "each once");
            let mut plain = SamplePlane::of(samples.offsets());
            binned.rasterize(Coverage::Opaque, &mut plain, area, 0, None::<&mut AllPass>);
            for (a, b) in sorted.iter().zip(&plain) {
                assert!(a.item == b.item && a.depth == b.depth, "{samples:?}");
            }
            // Some of the far triangles are visible, some hidden.
            assert!(plain[0].item.iter().any(|&item| item < 300));
        }
    }
}
