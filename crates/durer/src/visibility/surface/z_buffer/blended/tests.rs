use super::super::bins::{Binned, Source};
use super::super::front_to_back::FrontToBack;
use super::super::rasterize::AllPass;
use super::*;
use crate::math::{DVec3, Vec3, Vec4};
use crate::scene::{AlphaMode, Camera, Material, Mesh, Part, Projection, Scene};
use crate::shade::{PreparedLights, PreparedMaterials};
use crate::simd::{dispatch, levels};
use crate::testing::{camera, scene_of};
use crate::view::View;
use crate::visibility::surface::lit::Lighting;
use crate::visibility::surface::setup::{Coverage, Filter, runs};
use crate::visibility::surface::{Cull, Samples};
use crate::work::Work;

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

#[test]
fn sheets_look_as_if_all_fragments_were_sorted() {
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
        let filter = Filter::new(Cull::None, 128);
        let drawn = (&scene, &view, runs.as_slice());
        let lighting = Lighting::by_material(drawn, (&materials, &lights), samples.reach(), level);
        let (scene, view, runs) = drawn;
        let source = Source { scene, view, runs, filter, early: &[], lighting: None, level };
        let binned = Binned::new(&source, &Work::default()).expect("no limit");
        let (mut lit, area) = (Lit::new(lighting), [[0, 0], [64, 64]]);
        let mut planes = SamplePlane::of(samples.offsets());
        binned.rasterize(Coverage::Opaque, &mut planes, area, 0, None::<&mut AllPass>);
        let mut order = FrontToBack::default();
        let triangles = order.nearest_first(&binned, 0);
        let planes = &mut planes;
        let (mut sheets, mut sorted) =
            (Blended::new(samples.offsets()), Blended::new(samples.offsets()));
        let taken = dispatch!(level, simd => {
            light_blended(simd, &mut sheets, triangles, planes, area, &mut lit);
            // Only sorted; and the number of sheets that there would be.
            let (mut rest, mut taken) = (triangles, [0; 2]);
            sorted.layers.open(area);
            while !rest.is_empty() {
                let Blended { sheet, fragments, layers } = &mut sorted;
                let n = light_sorted(simd, fragments, (rest, 1), layers, planes, area, &mut lit);
                let mut other = LitLayers::new(layers.count);
                other.open(area);
                let m = light_sheet(simd, sheet, rest, &mut other, planes, area, &mut lit);
                taken[usize::from(m.is_ok())] += 1;
                rest = &rest[n..];
            }
            taken
        });
        assert!(taken[0] > 0 && taken[1] > 4, "{taken:?}");
        let area = Area::new(area, |_| Vec4::new(0.1, 0.2, 0.3, 0.5));
        let mut pictures = [vec![BlockSums::default(); BLOCKS], vec![BlockSums::default(); BLOCKS]];
        for (blended, sums) in [&sheets, &sorted].into_iter().zip(&mut pictures) {
            dispatch!(level, simd => lay_over(simd, planes, blended, &mut lit, &area, sums));
        }
        // Red, green, blue and alpha, block by block.
        let numbers = |sums: &[BlockSums]| -> Vec<u32> {
            sums.iter().flat_map(|of_block| of_block.0).flatten().map(f32::to_bits).collect()
        };
        let [a, b] = pictures.map(|sums| numbers(&sums));
        let differing = a.iter().zip(&b).filter(|(a, b)| a != b).count();
        assert_eq!(differing, 0, "{samples:?} {level:?}");
        assert!(a.iter().filter(|number| **number != 0).count() > 4 * 3000);
    }
}
