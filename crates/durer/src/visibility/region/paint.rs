//! The faces of the map that form one region, and its colour.

use super::planar_map::VisibleMap;
use super::planar_map::merge::{self, NOTHING, Patches};
use super::shadow::{LIT, Lamps, World, chosen};
use super::trap::{self, Trap};
use super::{Fill, Merge, Options};
use crate::math::DVec2;
use crate::parallel;
use crate::scene::Scene;
use crate::shade::color::encode_rgba8;
use crate::shade::{PreparedLights, PreparedMaterials};
use crate::simd::default_level;
use crate::sorting::CompactSort;
use crate::target::drawing::{Line, LineClass, Region, RegionKind};
use crate::view::View;
use crate::visibility::surface::lit::{Lighting, Lit};
use crate::visibility::surface::setup::runs;

/// An item under the lights that reach it.
type Shown = (u32, u64);

/// Properties that joined regions share: their kind, their material, and their colour.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Key {
    kind: RegionKind,
    /// Item, material, material and band, or instance.
    of: u64,
    color: [u8; 4],
}

/// The labels of a map's faces, and their meaning.
pub struct Paint {
    shown: Vec<Option<Shown>>,
    /// For each face of the map an index into `keys`, or [`NOTHING`].
    pub labels: Vec<u32>,
    keys: Vec<Key>,
}

/// Items that one task colours.
const TASK: usize = 1 << 12;

impl Paint {
    pub fn new(
        scene: &Scene,
        view: &View,
        lights: &PreparedLights,
        options: &Options,
        world: &World<'_>,
        lamps: &Lamps<'_>,
        map: &VisibleMap,
    ) -> Self {
        let tasks: Vec<_> = map.shown.chunks(TASK).collect();
        let shown = parallel::map(tasks, |part| {
            let one = |shown: &Option<(DVec2, u32)>| {
                let (at, face) = (*shown)?;
                let item = map.faces[face as usize].item;
                Some((item, lamps.reaching(&map.frame, item, at)))
            };
            part.iter().map(one).collect::<Vec<_>>()
        });
        let shown: Vec<Option<Shown>> = shown.into_iter().flatten().collect();
        let mut distinct: Vec<Shown> = shown.iter().flatten().copied().collect();
        distinct.sort_unstable();
        distinct.dedup();
        let colors = colors(scene, view, lights, &distinct);
        let mut keys: Vec<Key> = distinct
            .iter()
            .zip(&colors)
            .map(|(shown, color)| key(*shown, *color, options, world))
            .collect();
        if matches!(options.merge, Merge::Band | Merge::Material | Merge::Part) {
            share_colors(map, &shown, &distinct, &mut keys);
        }
        if options.merge == Merge::Shade {
            darken(&mut keys);
        }
        let mut sorted = keys.clone();
        sorted.sort_unstable();
        sorted.dedup();
        let label = |shown: &Option<Shown>| {
            let index = (*shown).and_then(|s| distinct.binary_search(&s).ok());
            index.and_then(|i| sorted.binary_search(&keys[i]).ok()).map_or(NOTHING, |k| k as u32)
        };
        let labels = shown.iter().map(label).collect();
        Self { shown, labels, keys: sorted }
    }

    /// Returns the patches as regions, in the order of painting: from far to near, roughly.
    pub fn regions(&self, map: &VisibleMap, patches: &Patches, options: &Options) -> Vec<Region> {
        let depths: Vec<f64> = patches
            .list
            .iter()
            .map(|patch| {
                let of = |half: &u32| map.shown[map.map.face_of[*half as usize] as usize];
                let depth = |(at, face): (_, u32)| map.faces[face as usize].depth(at);
                let halves = patch.rings.iter().flatten();
                halves.filter_map(of).map(depth).fold(f64::NEG_INFINITY, f64::max)
            })
            .collect();
        let mut order: Vec<u32> = (0..patches.list.len() as u32).collect();
        order.compact_sort_by(|&a, &b| {
            depths[b as usize].total_cmp(&depths[a as usize]).then(a.cmp(&b))
        });
        let mut rank = vec![0; order.len()];
        for (i, &patch) in order.iter().enumerate() {
            rank[patch as usize] = i as u32;
        }
        let reach = match options.fill {
            Fill::Trapped { reach } if reach > 0.0 && reach.is_finite() => reach / map.frame.unit,
            _ => 0.0,
        };
        let trap = Trap { map: &map.map, patches, rank: &rank, reach };
        let room = if reach > 0.0 { trap.room() } else { Vec::new() };
        let unit = |mut rings: Vec<Vec<DVec2>>| {
            rings.iter_mut().flatten().for_each(|p| *p *= map.frame.unit);
            rings
        };
        let region = |&index: &u32| {
            let patch = &patches.list[index as usize];
            let key = &self.keys[patch.label as usize];
            let rings = match room[..] {
                [] => map.rings(patch),
                _ => unit(trap.rings(index as usize, &room)),
            };
            let item = (options.merge == Merge::Face).then_some(key.of as u32);
            Region { kind: key.kind, rings, color: key.color, item, part: None }
        };
        let mut regions = match room[..] {
            [] => Vec::new(),
            _ => self.beneath(&trap, &room, unit),
        };
        regions.extend(order.iter().map(region));
        regions
    }

    /// Adds the fill beneath the narrow patches: in their mean colour.
    fn beneath(
        &self,
        trap: &Trap<'_>,
        room: &[f64],
        unit: impl Fn(Vec<Vec<DVec2>>) -> Vec<Vec<DVec2>>,
    ) -> Vec<Region> {
        let found = trap::joined_narrow(trap, room);
        let below = Trap { patches: &found.patches, rank: &found.rank, ..*trap };
        let room = below.room();
        let region = |pairs: &[(u32, u32)]| {
            let keys = pairs.iter().map(|&(_, above)| {
                let patch = &trap.patches.list[above as usize];
                (self.keys[patch.label as usize], trap.area_and_length(patch).0)
            });
            let keys: Vec<(Key, f64)> = keys.collect();
            let rings = unit(below.rings(pairs[0].0 as usize, &room));
            let (kind, color) = (keys[0].0.kind, mean_color(&keys));
            Region { kind, rings, color, item: None, part: None }
        };
        found.pairs.chunk_by(|a, b| a.0 == b.0).map(region).collect()
    }

    /// Returns the lines on a face at which light ends.
    pub fn shadow_lines(&self, map: &VisibleMap) -> Vec<Line> {
        let of = |half: usize| self.shown[map.map.face_of[half] as usize];
        let is_border = |edge: usize| match (of(2 * edge), of(2 * edge + 1)) {
            (Some((a, lit)), Some((b, also))) => a == b && lit != also,
            _ => false,
        };
        let lines = merge::lines(&map.map, is_border);
        lines
            .into_iter()
            .map(|(vertices, closed)| Line {
                class: LineClass::Shadow,
                invisibility: 0,
                points: vertices.into_iter().map(|v| map.point(v)).collect(),
                closed,
            })
            .collect()
    }
}

/// Returns the mean of colours weighted by area, computed on the sRGB bytes, as viewers blend them.
fn mean_color(keys: &[(Key, f64)]) -> [u8; 4] {
    let total: f64 = keys.iter().map(|(_, area)| area).sum();
    std::array::from_fn(|k| {
        let sum: f64 = keys.iter().map(|(key, area)| f64::from(key.color[k]) * area).sum();
        if total > 0.0 { (sum / total).round() as u8 } else { keys[0].0.color[k] }
    })
}

fn key((item, mask): Shown, color: [u8; 4], options: &Options, world: &World<'_>) -> Key {
    let run = world.run(item);
    let material = run.and_then(|r| r.material);
    let kind = if material.is_some() && material == options.cap_material {
        RegionKind::Cap
    } else if mask != LIT {
        RegionKind::Shadow
    } else {
        RegionKind::Surface
    };
    let of = match options.merge {
        Merge::Face => Some(u64::from(item)),
        Merge::Part => run.map(|r| r.instance as u64),
        Merge::Shade | Merge::Band | Merge::Material => material.map(|m| m as u64),
    };
    let of = match options.merge {
        Merge::Band => Some((of.unwrap_or(u64::MAX) << 4) | band(color)),
        _ => of,
    };
    Key { kind, of: of.unwrap_or(u64::MAX), color }
}

/// Returns which of 16 shades a colour has, by its luma (Rec. 601, of the bytes as they are).
fn band([r, g, b, _]: [u8; 4]) -> u64 {
    (299 * u64::from(r) + 587 * u64::from(g) + 114 * u64::from(b)) / 16_000
}

/// Returns the flat colours of items under the lights that reach them.
pub fn colors(
    scene: &Scene,
    view: &View,
    lights: &PreparedLights,
    shown: &[Shown],
) -> Vec<[u8; 4]> {
    let Ok(runs) = runs(scene) else { return Vec::new() };
    let materials = PreparedMaterials::new(scene);
    // Flat light is computed by hand, for the lights that reach the face.
    let shading = None;
    let shared = Lighting {
        scene,
        view,
        runs: &runs,
        materials: &materials,
        lights,
        shading,
        reach: 0,
        level: default_level(),
    };
    let parts = parallel::map(shown.chunks(TASK).collect(), |part| {
        let mut lit = Lit::new(shared);
        let mut some = (LIT, lights.clone());
        part.iter()
            .map(|&(item, mask)| {
                if some.0 != mask {
                    some = (mask, chosen(lights, mask));
                }
                encode_rgba8(lit.face_color(item, &some.1))
            })
            .collect::<Vec<_>>()
    });
    parts.into_iter().flatten().collect()
}

/// Joins regions that are as dark as a shadow on the same material, because they are turned away
/// from the light, with it.
fn darken(keys: &mut [Key]) {
    let shadows = keys.iter().filter(|k| k.kind == RegionKind::Shadow);
    let mut dark: Vec<(u64, [u8; 4])> = shadows.map(|k| (k.of, k.color)).collect();
    dark.sort_unstable();
    dark.dedup();
    for key in keys.iter_mut().filter(|k| k.kind == RegionKind::Surface) {
        if dark.binary_search(&(key.of, key.color)).is_ok() {
            key.kind = RegionKind::Shadow;
        }
    }
}

/// Assigns all items of one material or part the colour that most of its area has.
fn share_colors(map: &VisibleMap, shown: &[Option<Shown>], distinct: &[Shown], keys: &mut [Key]) {
    let mut areas = vec![0i128; shown.len()];
    for edge in 0..map.map.edges.len() as u32 {
        let [a, b] = map.map.edges[edge as usize].map(|v| map.map.points[v as usize]);
        let twice = i128::from(a.x) * i128::from(b.y) - i128::from(a.y) * i128::from(b.x);
        areas[map.map.face_of[2 * edge as usize] as usize] += twice;
        areas[map.map.face_of[2 * edge as usize + 1] as usize] -= twice;
    }
    let of = |shown: &Option<Shown>| distinct.binary_search(&(*shown)?).ok();
    let mut tones: Vec<(Key, i128)> = Vec::new();
    for (shown, area) in shown.iter().zip(&areas) {
        tones.extend(of(shown).map(|i| (keys[i], *area)));
    }
    tones.sort_unstable();
    let sums = tones.chunk_by(|a, b| a.0 == b.0).map(|same| {
        let sum: i128 = same.iter().map(|t| t.1).sum();
        (same[0].0, sum)
    });
    let sums: Vec<(Key, i128)> = sums.collect();
    // The largest of each material or part; at equal areas the first colour.
    let mut most: Vec<(Key, i128)> = Vec::new();
    for &(key, area) in &sums {
        match most.last_mut() {
            Some((last, largest)) if (last.kind, last.of) == (key.kind, key.of) => {
                if area > *largest {
                    (*last, *largest) = (key, area);
                }
            }
            _ => most.push((key, area)),
        }
    }
    for key in keys {
        let found = most.binary_search_by(|(k, _)| (k.kind, k.of).cmp(&(key.kind, key.of)));
        key.color = found.map_or(key.color, |i| most[i].0.color);
    }
}
