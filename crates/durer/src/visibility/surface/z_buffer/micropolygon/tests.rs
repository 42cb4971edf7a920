//! Fragments, compared with the triangles that they come from.

use super::tiles::ITEM_BITS;
use super::*;
use crate::math::{DVec3, Vec3};
use crate::scene::{Camera, Mesh, Projection, Scene};
use crate::shade::{PreparedLights, PreparedMaterials};
use crate::simd::levels;
use crate::target::NO_ITEM;
use crate::testing::{Numbers, camera, scene_of};
use crate::view::View;
use crate::visibility::surface::lit::Lighting;
use crate::visibility::surface::points::triangles::{OF_ROWS, Triangles};
use crate::visibility::surface::setup::{Coverage, TriangleFilter, runs};
use crate::visibility::surface::z_buffer::bins::{Binned, Source};
use crate::visibility::surface::z_buffer::rasterize::AllPass;
use crate::visibility::surface::z_buffer::tile::SamplePlane;
use crate::visibility::surface::{Cull, Samples};
use crate::work::Work;

const COUNT: usize = 6_000;

/// Size of two tiles and a part of a third, in each direction.
const SIZE: [i32; 2] = [150, 140];

/// Returns triangles of at most about three pixels, some of them larger, of all slopes, with normals.
fn scene() -> Scene {
    let mut numbers = Numbers(11);
    let mut random = || numbers.signed();
    let mut mesh = Mesh::default();
    for i in 0..COUNT {
        let middle = Vec3::new(random() * 1.1, random() * 1.1, random() * 0.4);
        let size = if i % 20 == 0 { 0.15 } else { 0.025 };
        let [a, b, c] = [0; 3].map(|_| middle + Vec3::new(random(), random(), random()) * size);
        let face = (b - a).cross(c - a).normalize_or_zero();
        // Some normals point anywhere, so that they are computed on demand.
        let off = if i % 10 == 0 { 2.0 } else { 0.1 };
        for corner in [a, b, c] {
            mesh.positions.push(corner);
            mesh.normals.push(face + Vec3::new(random(), random(), random()) * off);
        }
    }
    scene_of(mesh)
}

/// Returns for each sample of a tile the nearest item and the bits of its depth.
fn nearest(samples: Samples, binned: &Binned, (tile, at): (u32, [i32; 2])) -> Vec<(u32, i32)> {
    let mut planes = SamplePlane::of(samples.offsets());
    planes[0].clear();
    let size = [0, 1].map(|axis| TILE.min(SIZE[axis] - at[axis]));
    binned.draw_fragments(&mut planes, None, tile);
    binned.rasterize(Coverage::Opaque, &mut planes, [at, size], tile, None::<&mut AllPass>);
    // Values outside the border are unspecified.
    let pixels = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| (y * TILE + x) as usize));
    let count = samples.offsets().len();
    let samples = pixels.flat_map(|pixel| count * pixel..count * (pixel + 1));
    samples.map(|sample| (planes[0].item[sample], planes[0].depth[sample])).collect()
}

/// Number of fragments whose normals were found.
#[derive(Default)]
struct Found {
    known: usize,
    unsettled: usize,
    /// Grouped by the upper bits of their items.
    uppers: [usize; 2],
}

impl Found {
    /// Compares the normals of the fragments in a tile with those of their triangles.
    fn add<const N: usize>(
        &mut self,
        store: &Store<N>,
        triangles: &mut Triangles<'_>,
        (tile, at): (u32, [i32; 2]),
    ) {
        for (upper, block) in store.with_normals.of(tile) {
            self.uppers[(upper >> ITEM_BITS) as usize] += block.len();
            for fragment in block {
                let (pixel, item) = fragment.sample.at.pixel_and_item(upper);
                let [x, y] = [pixel as i32 % TILE, pixel as i32 / TILE];
                let plane = triangles.normals(item, 0);
                assert_eq!(fragment.normal[0].is_nan(), !plane.settled, "{item}");
                if plane.settled {
                    let expected = plane.at([at[0] + x, at[1] + y]).to_array();
                    assert_eq!(fragment.normal.map(f32::to_bits), expected.map(f32::to_bits));
                    self.known += 1;
                } else {
                    self.unsettled += 1;
                }
            }
        }
    }
}

#[test]
fn fragments_are_what_rasterizing_and_normal_planes_give() {
    let scene = scene();
    let projection = Projection::Perspective { fov_y: 0.6 };
    let camera = camera(DVec3::new(0.3, 0.2, 3.5), projection);
    let camera = Camera { near: 1.0, far: 9.0, ..camera };
    let view = View::new(camera, SIZE[0] as u32, SIZE[1] as u32).expect("view");
    let mut runs = runs(&scene).expect("runs");
    // Blocks of items whose upper bits differ.
    runs[0].first_item = (1 << ITEM_BITS) - COUNT as u32 / 2;
    let (materials, lights) = (PreparedMaterials::new(&scene), PreparedLights::auto(&camera));
    for (level, samples) in
        levels().into_iter().flat_map(|level| [(level, Samples::One), (level, Samples::Four)])
    {
        let (reach, offsets) = (samples.reach(), samples.offsets());
        let drawn = (&scene, &view, runs.as_slice());
        let lighting = Lighting::by_material(drawn, (&materials, &lights), reach, level);
        let (scene, view, runs) = drawn;
        let filter = TriangleFilter::new(Cull::None, reach);
        let binned = |early: &'static [[i32; 2]]| {
            let lighting = Some(&lighting);
            let source = Source { scene, view, runs, filter, early, lighting, level };
            Binned::new(&source, &Work::default()).expect("no limit")
        };
        let (binned, plain) = (binned(offsets), binned(&[]));
        let mut triangles = Triangles::new(scene, view, runs, level, (OF_ROWS, reach));
        let grid = TileGrid::of(view);
        let (mut shown, mut found) = (0, Found::default());
        for tile in 0..grid.count() {
            assert!(!plain.has_fragments(tile));
            let at = [tile as i32 % grid.columns * TILE, tile as i32 / grid.columns * TILE];
            let ours = nearest(samples, &binned, (tile, at));
            let expected = nearest(samples, &plain, (tile, at));
            assert_eq!(ours, expected, "{level:?} {samples:?}, tile {tile}");
            shown += ours.iter().filter(|(item, _)| *item != NO_ITEM).count();
            for fragments in &binned.fragments {
                found.add(&fragments.one, &mut triangles, (tile, at));
                found.add(&fragments.four, &mut triangles, (tile, at));
            }
        }
        let Found { known, unsettled, uppers } = found;
        assert!(shown > 5_000 * offsets.len() && known > 1_000, "{shown} {known}");
        assert!(unsettled > 0 && uppers.iter().all(|n| *n > 500), "{unsettled} {uppers:?}");
    }
}
