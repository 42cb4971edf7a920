use super::super::area::{BLOCKS, place_of};
use super::super::bins::{Binned, Source};
use super::super::front_to_back::FrontToBack;
use super::super::rasterize::{AllPass, FragmentTest, one_by_one};
use super::*;
use crate::math::{DVec3, Vec3, Vec4};
use crate::scene::{AlphaMode, Camera, Material, Mesh, Part, Projection, Scene};
use crate::shade::color::premultiply;
use crate::shade::{PreparedLights, PreparedMaterials};
use crate::simd::{dispatch, levels};
use crate::testing::{camera, scene_of};
use crate::view::View;
use crate::visibility::surface::lit::Lighting;
use crate::visibility::surface::setup::{Coverage, TriangleFilter, runs};
use crate::visibility::surface::{Cull, Samples};
use crate::work::Work;
use std::collections::BTreeMap;

/// Creates sheets one behind another, each of many triangles with common edges; in front and between them some that
/// intersect, and something opaque.
fn scene() -> Scene {
    let mut positions = Vec::new();
    for sheet in 0..12 {
        let z = 0.8 - 0.12 * sheet as f32;
        for (x, y) in (0..3).flat_map(|y| (0..3).map(move |x| (x, y))) {
            let at = |i: i32, j: i32| {
                // Tilted, but apart from the next one, which begins farther left, where it is nearest.
                let (x, y) = (i as f32 * 0.6 - 0.8, j as f32 * 0.7 - 1.1);
                Vec3::new(x - 0.02 * sheet as f32, y, z - 0.02 * x)
            };
            let [a, b, c, d] = [at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)];
            positions.extend([a, c, d, a, b, c]);
        }
    }
    for (x, z) in [(0.2, 0.3), (0.4, -0.1)] {
        let [a, b, c] = [(x, -0.8, z), (x + 0.6, 0.1, z - 0.3), (x - 0.2, 0.7, z + 0.05)];
        positions.extend([a, b, c].map(|(x, y, z)| Vec3::new(x, y, z)));
        positions.extend([b, a, c].map(|(x, y, z)| Vec3::new(x, -y, z)));
    }
    let blended = positions.len() as u32 / 3;
    positions.extend([(0.1, 0.1), (0.9, 0.3), (0.3, 0.9)].map(|(x, y)| Vec3::new(x, y, 0.02)));
    // Each sheet has its own colour, and the crossing ones have another.
    let glass = |i: usize| Material {
        base_color: Vec4::new(0.08 * i as f32, 0.5, 1.0 - 0.08 * i as f32, 0.4),
        alpha_mode: AlphaMode::Blend,
        ..Material::default()
    };
    let part = |i: usize, range| Part { range, material: Some(i), name: String::new() };
    let mut parts: Vec<Part> =
        (0..12).map(|i| part(i, 18 * i as u32..18 * (i as u32 + 1))).collect();
    parts.push(part(12, 216..blended));
    parts.push(part(13, blended..blended + 1));
    let materials = (0..13).map(glass).chain([Material::default()]).collect();
    Scene { materials, ..scene_of(Mesh { positions, parts, ..Mesh::default() }) }
}

/// The fragments of blended triangles by tile-local pixel and item: the least depth, and the samples as bits.
struct Recorder {
    offsets: &'static [[i32; 2]],
    fragments: BTreeMap<([i32; 2], u32), (f32, u32)>,
}

impl FragmentTest for Recorder {
    fn pass<S: Simd>(
        &mut self,
        simd: S,
        write: S::i32s,
        t: &ScreenTriangle,
        at: [i32; 2],
        (first, shift): (usize, u32),
    ) -> S::i32s {
        one_by_one(simd, write, at, shift, |x, y, sample| {
            let sample = first + sample;
            let [dx, dy] = [0, 1].map(|axis| {
                let pixel = [x, y][axis] - t.origin()[axis];
                pixel as f32 + self.offsets[sample][axis] as f32 / 256.0
            });
            let (depth, samples) =
                self.fragments.entry(([x, y], t.item)).or_insert((f32::INFINITY, 0));
            *depth = depth.min(t.depth_at(dx, dy));
            *samples |= 1 << sample;
            false
        })
    }
}

impl Recorder {
    /// Returns the colour of a pixel, whose samples show `opaque` behind the blended surfaces: the mean of its samples,
    /// each composed from far to near.
    fn composed(&self, [x, y]: [i32; 2], opaque: &[u32], behind: Vec4, lit: &mut Lit<'_>) -> Vec4 {
        let mut under: Vec<Vec4> = (opaque.iter())
            .map(|&item| if item == NO_ITEM { behind } else { lit.color(item, x, y) })
            .collect();
        let here = self.fragments.range(([x, y], 0)..=([x, y], NO_ITEM));
        let mut here: Vec<_> =
            here.map(|(&(_, item), &(depth, bits))| (depth, item, bits)).collect();
        here.sort_by(|a, b| b.0.total_cmp(&a.0).then(b.1.cmp(&a.1)));
        for (_, item, bits) in here {
            let color = premultiply(lit.color(item, x, y));
            let samples = under.iter_mut().enumerate();
            for (_, under) in samples.filter(|(i, _)| bits >> i & 1 == 1) {
                *under = color + *under * (1.0 - color.w);
            }
        }
        under.iter().fold(Vec4::ZERO, |sum, color| sum + *color) * (1.0 / under.len() as f32)
    }
}

#[test]
fn blended_surfaces_are_composed_sample_by_sample_from_far_to_near() {
    let scene = scene();
    let camera = camera(DVec3::Z * 2.0, Projection::Orthographic { height: 2.0 });
    let camera = Camera { near: 1.0, far: 4.0, ..camera };
    let view = View::new(camera, 64, 64).expect("view");
    let (runs, lights) = (runs(&scene).expect("runs"), PreparedLights::auto(&camera));
    let materials = PreparedMaterials::new(&scene);
    for (samples, level) in [Samples::One, Samples::Four, Samples::Sixteen]
        .into_iter()
        .flat_map(|s| levels().into_iter().map(move |l| (s, l)))
    {
        let filter = TriangleFilter::new(Cull::None, 128);
        let drawn = (&scene, &view, runs.as_slice());
        let lighting = Lighting::by_material(drawn, (&materials, &lights), samples.reach(), level);
        let (scene, view, runs) = drawn;
        let source = Source { scene, view, runs, filter, early: &[], lighting: None, level };
        let binned = Binned::new(&source, &Work::default()).expect("no limit");
        let (mut lit, area) = (Lit::new(lighting), [[0, 0], [64, 64]]);
        let mut planes = SamplePlane::of(samples.offsets());
        binned.rasterize(Coverage::Opaque, &mut planes, area, 0, None::<&mut AllPass>);
        let mut recorder = Recorder { offsets: samples.offsets(), fragments: BTreeMap::new() };
        binned.rasterize(Coverage::Blended, &mut planes, area, 0, Some(&mut recorder));
        let mut order = FrontToBack::default();
        let triangles = order.nearest_first(&binned, 0);
        let (planes, behind) = (&mut planes, Vec4::new(0.1, 0.2, 0.3, 0.5));
        let mut blended = Blended::new(samples.offsets());
        let [mut sums, mut sorted] = [(); 2].map(|()| vec![BlockSums::default(); BLOCKS]);
        dispatch!(level, simd => {
            light_blended(simd, &mut blended, triangles, planes, area, &mut lit);
            lay_over(simd, planes, &blended, &mut lit, &Area::new(area, |_| behind), &mut sums);
            // Only sorted.
            blended.layers.open(area);
            let Blended { fragments, layers, .. } = &mut blended;
            light_sorted(simd, fragments, triangles, layers, planes, area, &mut lit);
            lay_over(simd, planes, &blended, &mut lit, &Area::new(area, |_| behind), &mut sorted);
            // The first triangles form a sheet.
            let Blended { sheet, layers, .. } = &mut blended;
            layers.open(area);
            let taken = light_sheet(simd, sheet, triangles, layers, planes, area, &mut lit);
            assert!(taken.is_some());
        });
        let mut pixels: Vec<[i32; 2]> =
            recorder.fragments.keys().map(|(pixel, _)| *pixel).collect();
        pixels.dedup();
        assert!(pixels.len() > 3000);
        // Composing all would take long.
        for [x, y] in pixels.into_iter().step_by(7) {
            let (pixel, place) = ((y * TILE + x) as usize, place_of(x, y));
            let opaque: Vec<u32> =
                planes.iter().flat_map(|plane| plane.items(pixel)).copied().collect();
            let expected = recorder.composed([x, y], &opaque, premultiply(behind), &mut lit);
            for sums in [&sums, &sorted] {
                let found = sums[place / LANES].0.map(|channel| channel[place % LANES]);
                assert_eq!(found, expected.to_array(), "{samples:?} {level:?} {x} {y}");
            }
        }
    }
}
