//! A triangle that a whole tile lies within: nothing behind it is seen, and where all else is behind it, nothing need be
//! rasterized.

use super::bins::Bins;
use super::rasterize::Edges;
use super::tile::SamplePlane;
use crate::raster::fixed::SUBPIXELS;
use crate::visibility::surface::setup::{Coverage, ScreenTriangle};

/// An opaque triangle that covers all samples of a tile.
#[derive(Clone, Copy)]
pub struct Wall<'a> {
    triangle: &'a ScreenTriangle,
    /// None of its depths at the samples of the tile is larger.
    pub farthest: f32,
}

/// From this depth on nothing is seen.
const FAR: f32 = 1.0;

/// Slopes of depth per pixel of walls are less: depths are between 0 and 1 in more than a tile.
const STEEPEST: f32 = 1.0;

impl<'a> Wall<'a> {
    /// Of all in a tile the one that is nearest where it is farthest.
    pub fn of_tile(
        bins: &'a [Bins],
        planes: &[SamplePlane],
        area: [[i32; 2]; 2],
        index: u32,
    ) -> Option<Self> {
        let mut nearest: Option<Self> = None;
        for bins in bins.iter().filter(|b| b.wide && b.coverage == Coverage::Opaque) {
            for triangle in bins.of_tile(index) {
                if nearest.is_none_or(|wall| triangle.depth_min < wall.farthest)
                    && let Some(wall) = Self::of(triangle, planes, area)
                    && nearest.is_none_or(|nearest| wall.farthest < nearest.farthest)
                {
                    nearest = Some(wall);
                }
            }
        }
        nearest
    }

    /// A triangle that covers all samples of a tile and is seen at all of them, but for what is nearer.
    fn of(
        triangle: &'a ScreenTriangle,
        planes: &[SamplePlane],
        area: [[i32; 2]; 2],
    ) -> Option<Self> {
        if !spans(triangle, area) || !planes.iter().all(|plane| covers(triangle, plane, area)) {
            return None;
        }
        let farthest = planes.iter().map(|plane| farthest(triangle, plane, area));
        let farthest = farthest.fold(0.0, f32::max);
        (farthest < FAR).then_some(Self { triangle, farthest })
    }

    /// The item that all samples of the tile show, where all other triangles are behind the wall.
    pub fn alone(&self, bins: &[Bins], index: u32) -> Option<u32> {
        let item = self.triangle.item;
        let is_behind = |t: &ScreenTriangle| t.depth_min > self.farthest || t.item == item;
        let alone = bins.iter().all(|bins| bins.of_tile(index).all(is_behind));
        alone.then_some(item)
    }
}

/// Whether the box of a triangle holds a tile's samples, give or take a pixel: most triangles are smaller.
#[inline(always)]
fn spans(t: &ScreenTriangle, [tile, size]: [[i32; 2]; 2]) -> bool {
    let holds = |v: &[i32; 3], axis: usize| {
        let (first, last) = (tile[axis] + 1, tile[axis] + size[axis] - 1);
        let (least, most) = (v[0].min(v[1]).min(v[2]), v[0].max(v[1]).max(v[2]));
        least <= first * SUBPIXELS && most >= last * SUBPIXELS
    };
    holds(&t.x, 0) && holds(&t.y, 1)
}

/// The first and the last place of a plane's samples in a tile's rows and columns, from the centre of the first pixel.
fn ends(plane: &SamplePlane, size: [i32; 2]) -> [[i32; 2]; 2] {
    let [[left, right], [up, down]] = plane.reach;
    let [x, y] = size.map(|pixels| (pixels - 1) * SUBPIXELS);
    [[left, x + right], [up, y + down]]
}

/// Whether all samples of a tile lie inside a triangle, and the corners of the box around them.
fn covers(t: &ScreenTriangle, plane: &SamplePlane, [tile, size]: [[i32; 2]; 2]) -> bool {
    let Edges { at, dx, dy } = Edges::new(t, tile);
    let ends = ends(plane, size);
    (0..3).all(|i| {
        let least = |step: i32, [first, last]: [i32; 2]| {
            (i64::from(step) * i64::from(first)).min(i64::from(step) * i64::from(last))
        };
        at[i] + least(dx[i], ends[0]) + least(dy[i], ends[1]) >= 0
    })
}

/// What no depth of a triangle at the samples of a tile is larger than: rounded sums and products grow where the numbers
/// grow, so that the largest is in a corner.
fn farthest(t: &ScreenTriangle, plane: &SamplePlane, [tile, size]: [[i32; 2]; 2]) -> f32 {
    if t.depth_dx.abs().max(t.depth_dy.abs()) < STEEPEST {
        let origin = t.origin();
        let places = |axis: usize, end: i32| {
            (tile[axis] - origin[axis]) as f32 + end as f32 / SUBPIXELS as f32
        };
        let [columns, rows] = ends(plane, size);
        let corners = columns.into_iter().flat_map(|x| rows.map(|y| (x, y)));
        let depths = corners.map(|(x, y)| t.depth_at(places(0, x), places(1, y)));
        depths.fold(0.0, f32::max)
    } else {
        t.depth_max
    }
}

#[cfg(test)]
mod tests {
    use super::super::bins::jobs;
    use super::super::rasterize::{AllPass, rasterize};
    use super::*;
    use crate::math::{DMat4, DVec3, Vec3};
    use crate::scene::{Camera, Instance, Mesh, Projection, Scene};
    use crate::shade::{PreparedLights, PreparedMaterials};
    use crate::simd::Level;
    use crate::target::NO_ITEM;
    use crate::view::View;
    use crate::visibility::surface::lit::Lighting;
    use crate::visibility::surface::setup::{Filter, runs};
    use crate::visibility::surface::{Cull, Samples};
    use fearless_simd::dispatch;

    /// Triangles about as large as the tile that is seen, of all slopes; some reach beyond what is far enough.
    fn scene() -> Scene {
        let mut seed = 5_u32;
        let mut random = |most: f32| {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            ((seed >> 8) as f32 / 8_388_608.0 - 1.0) * most
        };
        let positions = (0..3 * 400).map(|_| Vec3::new(random(9.0), random(9.0), random(3.0)));
        Scene {
            meshes: vec![Mesh { positions: positions.collect(), ..Mesh::default() }],
            instances: vec![Instance {
                mesh: 0,
                world_from_mesh: DMat4::IDENTITY,
                name: String::new(),
            }],
            ..Scene::default()
        }
    }

    #[test]
    fn walls_cover_all_samples_and_are_not_farther_than_said() {
        let scene = scene();
        let projection = Projection::Orthographic { height: 2.0 };
        let (eye, target, up) = (DVec3::Z * 2.0, DVec3::ZERO, DVec3::Y);
        let camera = Camera { eye, target, up, projection, near: 1.0, far: 4.0 };
        let (runs, level) = (runs(&scene).expect("runs"), Level::new());
        let (materials, lights) = (PreparedMaterials::new(&scene), PreparedLights::auto(&camera));
        let (mut walls, mut others) = (0, 0);
        for (samples, size) in [Samples::One, Samples::Four, Samples::Sixteen]
            .into_iter()
            .flat_map(|samples| [[64, 64], [37, 50]].map(|size| (samples, size)))
        {
            let view = View::new(camera, size[0] as u32, size[1] as u32).expect("view");
            let filter = Filter::new(Cull::None, 128);
            let drawn = (&scene, &view, runs.as_slice());
            let lighting =
                Lighting::by_material(drawn, (&materials, &lights), samples.reach(), level);
            let (jobs, mut scratch) = (jobs(&runs), Default::default());
            let bins = Bins::new(&jobs[0], &lighting, filter, &mut scratch);
            let area = [[0, 0], size];
            let mut planes = SamplePlane::of(samples.offsets());
            for t in bins.of_tile(0) {
                planes.iter_mut().for_each(|plane| plane.clear(None));
                let alone = std::iter::once(t);
                dispatch!(level, simd =>
                    rasterize(simd, &mut planes, area, alone, None::<&mut AllPass>));
                let pixels =
                    || (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| (y * 64 + x) as usize));
                let is_seen = |plane: &SamplePlane| {
                    pixels().all(|pixel| plane.items(pixel).iter().all(|item| *item == t.item))
                };
                let is_wall = planes.iter().all(is_seen);
                let wall = Wall::of(t, &planes, area);
                let found = wall.is_some();
                // Of four samples none may be in a corner.
                let is_tight = samples == Samples::One;
                assert!(is_wall && (found || !is_tight) || !is_wall && !found, "{t:?}");
                *if found { &mut walls } else { &mut others } += 1;
                if let Some(wall) = wall {
                    let depths = planes.iter().flat_map(|plane| {
                        pixels().flat_map(|pixel| {
                            plane.depth[pixel << plane.shift..(pixel + 1) << plane.shift].iter()
                        })
                    });
                    let most = f32::from_bits(depths.copied().max().unwrap_or(0) as u32);
                    assert!(wall.farthest >= most, "{t:?} {most}");
                    assert!(wall.farthest == most || !is_tight, "{t:?} {most}");
                    assert_ne!(t.item, NO_ITEM);
                }
            }
        }
        assert!(walls > 60 && others > 300, "{walls} {others}");
    }
}
