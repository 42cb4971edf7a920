//! Fragments beside what the triangles give that they are made of.

use super::*;
use crate::math::{DMat4, DVec3, Vec3};
use crate::scene::{Camera, Instance, Mesh, Projection, Scene};
use crate::shade::{PreparedLights, PreparedMaterials};
use crate::simd::levels;
use crate::target::NO_ITEM;
use crate::view::View;
use crate::visibility::surface::Cull;
use crate::visibility::surface::lit::Lighting;
use crate::visibility::surface::setup::{Filter, runs};
use crate::visibility::surface::triangles::{OF_ROWS, Triangles};
use crate::visibility::surface::z_buffer::bins::{Bins, Scratch, jobs};
use crate::visibility::surface::z_buffer::rasterize::{AllPass, rasterize};

const COUNT: usize = 6_000;

/// Of two tiles and a piece of a third across, and as many down.
const SIZE: [i32; 2] = [150, 140];

/// Triangles of up to some three pixels across, some of them larger, of all slopes, with normals.
fn scene() -> Scene {
    let mut seed = 11_u32;
    let mut random = || {
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (seed >> 8) as f32 / 8_388_608.0 - 1.0
    };
    let mut mesh = Mesh::default();
    for i in 0..COUNT {
        let middle = Vec3::new(random() * 1.1, random() * 1.1, random() * 0.4);
        let size = if i % 20 == 0 { 0.15 } else { 0.025 };
        let [a, b, c] = [0; 3].map(|_| middle + Vec3::new(random(), random(), random()) * size);
        let face = (b - a).cross(c - a).normalize_or_zero();
        // Of some the normals point anywhere, so that they are found when they are asked for.
        let off = if i % 10 == 0 { 2.0 } else { 0.1 };
        for corner in [a, b, c] {
            mesh.positions.push(corner);
            mesh.normals.push(face + Vec3::new(random(), random(), random()) * off);
        }
    }
    let instance = Instance { mesh: 0, world_from_mesh: DMat4::IDENTITY, name: String::new() };
    Scene { meshes: vec![mesh], instances: vec![instance], ..Scene::default() }
}

/// By pixel of a tile the nearest item and the bits of its depth.
fn nearest(
    level: Level,
    (bins, fragments): (&Bins, &Fragments),
    (tile, at): (u32, [i32; 2]),
) -> Vec<(u32, i32)> {
    let mut planes = SamplePlane::of(&[[0; 2]]);
    planes[0].clear(None);
    fragments.draw(&mut planes[0], None, tile);
    let size = [0, 1].map(|axis| TILE.min(SIZE[axis] - at[axis]));
    dispatch!(level, simd =>
        rasterize(simd, &mut planes, [at, size], bins.of_tile(tile), None::<&mut AllPass>));
    // What is beyond the border means nothing.
    let pixels = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| (y * TILE + x) as usize));
    pixels.map(|pixel| (planes[0].item[pixel], planes[0].depth[pixel])).collect()
}

#[test]
fn fragments_are_what_rasterizing_and_normal_planes_give() {
    let scene = scene();
    let projection = Projection::Perspective { fov_y: 0.6 };
    let (eye, target, up) = (DVec3::new(0.3, 0.2, 3.5), DVec3::ZERO, DVec3::Y);
    let camera = Camera { eye, target, up, projection, near: 1.0, far: 9.0 };
    let view = View::new(camera, SIZE[0] as u32, SIZE[1] as u32).expect("view");
    let mut runs = runs(&scene).expect("runs");
    // Blocks of items whose upper bits differ.
    runs[0].first_item = (1 << ITEM_BITS) - COUNT as u32 / 2;
    let (materials, lights) = (PreparedMaterials::new(&scene), PreparedLights::auto(&camera));
    for level in levels() {
        let drawn = (&scene, &view, runs.as_slice());
        let lighting = Lighting::by_material(drawn, (&materials, &lights), 0, level);
        let bins_for = |sample_reach: i32| {
            let (mut scratch, filter) = (Scratch::default(), Filter::new(Cull::None, sample_reach));
            (Bins::new(&jobs(&runs)[0], &lighting, filter, &mut scratch), scratch.fragments)
        };
        // Where samples lie off pixels' centres nothing is sampled before its time.
        let ((bins, fragments), (all, none)) = (bins_for(0), bins_for(1));
        let mut triangles = Triangles::new(&scene, &view, &runs, level, (OF_ROWS, 0));
        let grid = TileGrid::new(view.width(), view.height());
        let (mut shown, mut with_normals, mut unsettled, mut uppers) = (0, 0, 0, [0; 2]);
        for tile in 0..grid.count() {
            assert!(none.nothing_in(tile));
            let at = [tile as i32 % grid.columns * TILE, tile as i32 / grid.columns * TILE];
            let ours = nearest(level, (&bins, &fragments), (tile, at));
            assert_eq!(ours, nearest(level, (&all, &none), (tile, at)), "{level:?}, tile {tile}");
            shown += ours.iter().filter(|(item, _)| *item != NO_ITEM).count();
            for (upper, block) in fragments.with_normals.of(tile) {
                uppers[(upper >> ITEM_BITS) as usize] += block.len();
                for fragment in block {
                    let (pixel, item) = fragment.seen.pixel_and_item(upper);
                    let [x, y] = [pixel as i32 % TILE, pixel as i32 / TILE];
                    let plane = triangles.normals(item, 0);
                    let [a, b, c, _] = fragment.found;
                    assert_eq!(a.is_nan(), !plane.settled, "{item}");
                    if plane.settled {
                        let expected = plane.at([at[0] + x, at[1] + y]).to_array();
                        assert_eq!(
                            [a, b, c].map(f32::to_bits),
                            expected.map(f32::to_bits),
                            "{item}"
                        );
                        with_normals += 1;
                    } else {
                        unsettled += 1;
                    }
                }
            }
        }
        assert!(shown > 5_000 && with_normals > 1_000, "{shown} {with_normals}");
        assert!(unsettled > 0 && uppers.iter().all(|n| *n > 500), "{unsettled} {uppers:?}");
    }
}
