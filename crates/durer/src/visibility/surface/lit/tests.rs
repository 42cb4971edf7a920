//! Pixels lit alone or with others, in any order, have the same bits.

use super::*;
use crate::math::DVec3;
use crate::scene::{Camera, Light, LightKind, Material, Mesh, Part, Projection, Scene};
use crate::shade::environment::Mirrored;
use crate::shade::studio::Studio;
use crate::shade::tone::Tone;
use crate::shade::{PreparedMaterials, ToneMap};
use crate::simd::{dispatch, levels};
use crate::target::NO_ITEM;
use crate::testing::{Numbers, camera, instance};
use crate::view::View;
use crate::visibility::surface::points::patch::Patch;
use crate::visibility::surface::setup::runs;
use fearless_simd::prelude::*;
use fearless_simd::{Simd, u32x16};

/// Position of the eye.
const EYE: DVec3 = DVec3::new(0.3, 0.2, 4.0);

/// Triangles of a run.
const TRIANGLES: u32 = 24;

/// Returns two runs of triangles in all directions; every fourth is nearly or exactly edge-on, and some have no normals
/// or normals on the side of their back.
fn scene() -> Scene {
    let mut numbers = Numbers(7);
    let mesh = |numbers: &mut Numbers| {
        let mut mesh = Mesh::default();
        for i in 0..TRIANGLES {
            let a = numbers.vector();
            let (b, mut c) = (numbers.vector(), numbers.vector());
            if i % 4 == 0 {
                // Nearly towards the eye from a.
                let off = [0.0, 1e-7, 1e-4][numbers.below(3) as usize];
                c = a + (EYE.as_vec3() - a) * 0.3 + numbers.vector() * off;
            }
            let normal = (b - a).cross(c - a).normalize_or_zero();
            for corner in [a, b, c] {
                mesh.positions.push(corner);
                let scale = match i % 8 {
                    1 | 2 | 5 => 1.5,
                    _ => [1.0, 0.3, 1.5, 1e-12][numbers.below(4) as usize],
                };
                mesh.normals.push(match i % 8 {
                    3 => Vec3::ZERO,
                    6 | 7 => numbers.vector(),
                    _ => normal * scale + numbers.vector() * scale * 0.1,
                });
            }
        }
        mesh
    };
    let meshes: Vec<Mesh> = (0..2)
        .map(|material| Mesh {
            parts: vec![Part {
                range: 0..TRIANGLES,
                material: Some(material),
                name: String::new(),
            }],
            ..mesh(&mut numbers)
        })
        .collect();
    let material = |model| Material {
        model,
        base_color: Vec4::new(0.9, 0.6, 0.2, 1.0),
        metallic: 0.4,
        roughness: 0.3,
        double_sided: true,
        ..Material::default()
    };
    use crate::scene::ShadingModel::{MetallicRoughness, Phong};
    Scene {
        meshes,
        instances: vec![instance(0), instance(1)],
        materials: vec![material(Phong), material(MetallicRoughness)],
        ..Scene::default()
    }
}

/// Returns the colours of a patch as bits, by pixel, leaving out pixels without an item.
type Bits = Vec<[u32; 3]>;

fn bits(colors: &[[f32; 16]; 4], items: &[u32; 16]) -> Bits {
    let shown = (0..16).filter(|&i| items[i] != NO_ITEM);
    shown.map(|i| [0, 1, 2].map(|k| colors[k][i].to_bits())).collect()
}

/// Returns whether an item may be lit at a pixel: normals of settled triangles are valid only on the triangle.
fn may_be_lit(lit: &mut Lit<'_>, item: u32, [x, y]: [i32; 2]) -> bool {
    let t = lit.triangle(item);
    let ([constant, dx, dy], [x, y]) = t.edge_functions(x, y);
    !t.normals.settled || (0..3).all(|i| dx[i] * x + dy[i] * y + constant[i] >= -0.1)
}

/// Returns the pixel in the middle of an item.
fn middle(lit: &mut Lit<'_>, item: u32) -> [i32; 2] {
    let [a, b, c] = lit.triangle(item).positions();
    let view = lit.shared.view;
    let at = (a + b + c).as_dvec3() / 3.0 + view.camera().eye;
    let at = view.screen_from_world() * at.extend(1.0);
    [at.x / at.w, at.y / at.w].map(|v| v as i32)
}

/// Returns an item at every pixel of a patch.
fn of_one<S: Simd>(simd: S, lit: &mut Lit<'_>, item: u32, patch: Patch) -> [[f32; 16]; 4] {
    let mut colors = [[0.0; 16]; 4];
    Lit::colors_x16(simd, lit, u32x16::splat(simd, item), patch, &mut colors);
    colors
}

/// Lights pixels whose samples show several items, as the weighted sum of these; returns the number of patches where
/// this applied.
fn light_samples<S: Simd>(simd: S, lit: &mut Lit<'_>, numbers: &mut Numbers) -> usize {
    let (mut queue, mut found) = (PointQueue::new(16 * 256), 0);
    let mut expected = vec![BlockSums::default(); 256];
    for (k, expected) in expected.iter_mut().enumerate() {
        // At most two items per pixel, whose sum is the same in either order; more per patch.
        let run = numbers.below(2) * TRIANGLES;
        let mut kind = || run + 8 * numbers.below(3) + [1, 2, 5][numbers.below(3) as usize];
        let kinds = [kind(), kind(), kind()];
        let [x, y] = middle(lit, kinds[0]);
        let patch = Patch::block([x - numbers.below(8) as i32, y]);
        let mut samples = [[0; 16]; 4];
        let colors = kinds.map(|item| of_one(simd, lit, item, patch));
        for pixel in 0..16 {
            let (a, b) = (numbers.below(3) as usize, numbers.below(3) as usize);
            let of_b = numbers.below(5) as usize;
            for (i, sample) in samples.iter_mut().enumerate() {
                sample[pixel] = kinds[if i < of_b { b } else { a }];
            }
            let shares = if kinds[a] == kinds[b] { [4, 0] } else { [4 - of_b, of_b] };
            let mut sum = [0.0; 3];
            for (of_item, count) in [a, b].into_iter().zip(shares) {
                for (sum, color) in sum.iter_mut().zip(colors[of_item]) {
                    *sum += color[pixel] * (count as f32 * 0.25);
                }
            }
            for (channel, sum) in sum.into_iter().enumerate() {
                expected.0[channel][pixel] = sum;
            }
        }
        let samples = samples.map(|items| u32x16::from_slice(simd, &items));
        if queue.light_samples(simd, lit, &samples, (k, patch)) {
            found += 1;
        } else {
            *expected = BlockSums::default();
        }
    }
    PointQueue::flush(simd, &mut queue, lit);
    for (sums, expected) in queue.sums.iter().zip(&expected) {
        assert_eq!(bits(&sums.0, &[0; 16]), bits(&expected.0, &[0; 16]));
    }
    found
}

/// Lights each pixel of patches in every way; returns the number of settled pixels.
fn light_all<S: Simd>(simd: S, lit: &mut Lit<'_>, numbers: &mut Numbers) -> usize {
    let (mut blocks, mut settled) = (PointQueue::new(16 * 64), 0);
    let mut expected = vec![BlockSums::default(); 64];
    let mut known = KnownNormals::new(16 * 64, 1);
    for k in 0..64 {
        // The largest number of triangles that a patch may show, of one run or of both.
        let (kinds, runs) = (1 + numbers.below(12), 1 + numbers.below(2));
        let kinds: Vec<u32> = (0..kinds).map(|_| numbers.below(TRIANGLES * runs)).collect();
        let mut item = kinds[0];
        let mut items = [NO_ITEM; 16];
        for to in &mut items[..(8 + 8 * (k % 2))] {
            if numbers.below(3) == 0 {
                item = kinds[numbers.below(kinds.len() as u32) as usize];
            }
            *to = if numbers.below(9) == 0 { NO_ITEM } else { item };
        }
        let [x, y] = middle(lit, item);
        let at = [x - numbers.below(8) as i32, y - numbers.below(2) as i32];
        for patch in [Patch::row(at), Patch::block(at)] {
            let mut items = items;
            for (i, item) in items.iter_mut().enumerate() {
                if *item != NO_ITEM && !may_be_lit(lit, *item, patch.pixel(i)) {
                    *item = NO_ITEM;
                }
            }
            if items == [NO_ITEM; 16] {
                continue;
            }
            let shown = u32x16::from_slice(simd, &items);
            let mut together = [[0.0; 16]; 4];
            Lit::colors_x16(simd, lit, shown, patch, &mut together);
            let mut one_by_one = [[0.0; 16]; 4];
            for i in (0..16).filter(|&i| items[i] != NO_ITEM) {
                let [x, y] = patch.pixel(i);
                let color = lit.color(items[i], x, y).to_array();
                for (channel, value) in one_by_one.iter_mut().zip(color) {
                    channel[i] = value;
                }
                settled += usize::from(lit.triangle(items[i]).normals.settled);
                if patch == Patch::block(at) {
                    (0..3).for_each(|channel| expected[k].0[channel][i] = color[channel]);
                    let normals = lit.triangle(items[i]).normals;
                    // For some, the normals are known; for others, they are known to be missing, or to be those of
                    // another.
                    let normal = match numbers.below(3) {
                        0 => [f32::NAN; 3],
                        _ => normals.at([x, y]).to_array(),
                    };
                    match numbers.below(4) {
                        0 => known.set(16 * k + i, items[i] + 1, normal),
                        _ if normals.settled => known.set(16 * k + i, items[i], normal),
                        _ => {}
                    }
                }
                // A patch covered entirely by its triangle.
                let of_one = of_one(simd, lit, items[i], patch);
                let mut only = [NO_ITEM; 16];
                only[i] = items[i];
                assert_eq!(bits(&of_one, &only), bits(&one_by_one, &only));
            }
            assert_eq!(bits(&together, &items), bits(&one_by_one, &items), "{items:?} {patch:?}");
            let mut queue = PointQueue::new(16);
            for i in (0..16).filter(|&i| items[i] != NO_ITEM) {
                let (item, at) = (items[i], patch.pixel(i));
                let point = ShadingPoint { item, at, place: i as u32, weight: 1.0 };
                let normals = lit.triangle(item).normals;
                let is_known = normals.settled && !lit.with_positions() && numbers.below(2) == 0;
                let normal = normals.at(at).extend(0.0).to_array();
                queue.add(simd, lit, point, is_known.then_some(&normal));
            }
            PointQueue::flush(simd, &mut queue, lit);
            assert_eq!(bits(&queue.sums[0].0, &items), bits(&one_by_one, &items));
            if patch == Patch::block(at) {
                let known = known.of_patch(simd, [16 * k, 16 * k + 8], shown);
                let known = known.filter(|_| !lit.with_positions());
                blocks.light_block(simd, lit, (shown, known), (k, patch));
            }
        }
    }
    PointQueue::flush(simd, &mut blocks, lit);
    for (sums, expected) in blocks.sums.iter().zip(&expected) {
        assert_eq!(bits(&sums.0, &[0; 16]), bits(&expected.0, &[0; 16]));
    }
    settled
}

#[test]
fn pixels_are_lit_alike_alone_and_together() {
    let scene = scene();
    let runs = runs(&scene).expect("runs");
    let materials = PreparedMaterials::new(&scene);
    let lamp = LightKind::Point { position: DVec3::new(1.0, 2.0, 3.0), range: None };
    let lamp = Light { kind: lamp, color: Vec3::splat(5.0) };
    for projection in
        [Projection::Perspective { fov_y: 0.8 }, Projection::Orthographic { height: 3.0 }]
    {
        let camera = Camera { far: 10.0, ..camera(EYE, projection) };
        let view = View::new(camera, 96, 64).expect("view");
        let mut studio = PreparedLights::auto(&camera);
        studio.environment.mirrored = Mirrored::Studio(Studio::of_camera(&camera));
        studio.tone = Tone { gain: 1.5, map: ToneMap::Agx };
        let lamp = PreparedLights::new(&[lamp], &camera);
        for lights in [PreparedLights::auto(&camera), studio, lamp] {
            for (level, reach) in levels().into_iter().flat_map(|l| [(l, 0), (l, 128)]) {
                let drawn = (&scene, &view, runs.as_slice());
                let lighting = Lighting::by_material(drawn, (&materials, &lights), reach, level);
                let (mut lit, mut numbers) = (Lit::new(lighting), Numbers(11));
                let settled = dispatch!(level, simd => light_all(simd, &mut lit, &mut numbers));
                assert!(settled > 100, "{settled}");
                let found = dispatch!(level, simd => light_samples(simd, &mut lit, &mut numbers));
                let asks_for_more = !lights.points.is_empty();
                assert!(if asks_for_more { found == 0 } else { found > 30 }, "{found}");
            }
        }
    }
}
