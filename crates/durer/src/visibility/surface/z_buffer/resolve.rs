//! From the visible items of a tile to colours: each triangle is lit once per pixel, the samples of
//! a pixel are averaged in linear light, blended surfaces are laid over from far to near.

use super::surface::Lit;
use super::tile::{FragmentTest, SamplePlane, TILE, TILE_PIXELS};
use crate::math::Vec4;
use crate::shade::color::premultiply;
use crate::target::NO_ITEM;
use crate::visibility::surface::Background;
use crate::visibility::surface::setup::ScreenTriangle;
use fearless_simd::Simd;
use fearless_simd_macros::simd;

/// A fragment of a blended surface, in tile-local pixels.
#[derive(Debug, Clone, Copy)]
struct Fragment {
    pixel: u32,
    item: u32,
    /// Depth at the first covered sample.
    depth: f32,
    /// Bit i: sample i is covered and not hidden.
    samples: u32,
}

/// Collects the fragments of blended surfaces that nothing opaque hides.
pub struct Fragments {
    list: Vec<Fragment>,
    offsets: &'static [[i32; 2]],
    tile: [i32; 2],
}

impl Fragments {
    pub fn new(offsets: &'static [[i32; 2]]) -> Self {
        Self { list: Vec::new(), offsets, tile: [0; 2] }
    }

    /// Forgets all fragments and begins with another tile.
    pub fn clear(&mut self, tile: [i32; 2]) {
        self.list.clear();
        self.tile = tile;
    }

    /// Brings the fragments of each pixel together, far ones first; of equally far ones the higher
    /// item first, so that the lower is seen.
    fn sort(&mut self) {
        self.list.sort_by(|a, b| {
            (a.pixel, a.item).cmp(&(b.pixel, b.item)).then(a.samples.cmp(&b.samples))
        });
        // The samples of one item at one pixel become one fragment.
        self.list.dedup_by(|next, kept| {
            let same = (next.pixel, next.item) == (kept.pixel, kept.item);
            if same {
                kept.samples |= next.samples;
                kept.depth = kept.depth.min(next.depth);
            }
            same
        });
        self.list.sort_by(|a, b| {
            a.pixel.cmp(&b.pixel).then(b.depth.total_cmp(&a.depth)).then(b.item.cmp(&a.item))
        });
    }
}

impl FragmentTest for Fragments {
    /// Takes note of the fragment and lets nothing be written.
    fn passes(&mut self, t: &ScreenTriangle, x: i32, y: i32, sample: usize) -> bool {
        let origin = t.origin();
        let [ox, oy] = self.offsets[sample].map(|o| o as f32 / 256.0);
        let dx = (self.tile[0] + x - origin[0]) as f32 + ox;
        let dy = (self.tile[1] + y - origin[1]) as f32 + oy;
        self.list.push(Fragment {
            pixel: (y * TILE + x) as u32,
            item: t.item,
            depth: t.depth_at(dx, dy),
            samples: 1 << sample,
        });
        false
    }
}

/// Lets the fragments of masked surfaces pass where they are.
pub struct MaskTest<'t, 'a> {
    pub lit: &'t mut Lit<'a>,
    pub tile: [i32; 2],
}

impl FragmentTest for MaskTest<'_, '_> {
    fn passes(&mut self, t: &ScreenTriangle, x: i32, y: i32, _sample: usize) -> bool {
        self.lit.passes_mask(t.item, self.tile[0] + x, self.tile[1] + y)
    }
}

/// The colours of a tile: linear, premultiplied, row after row.
pub struct TileColors(Vec<Vec4>);

impl TileColors {
    pub fn new() -> Self {
        Self(vec![Vec4::ZERO; TILE_PIXELS])
    }

    /// A row of the tile.
    pub fn row(&self, y: i32) -> &[Vec4] {
        &self.0[(y * TILE) as usize..][..TILE as usize]
    }

    /// Lights everything that is visible in the tile whose upper left pixel is `tile`.
    #[expect(clippy::too_many_arguments, reason = "one call, all of it a tile's state")]
    pub fn resolve<S: Simd>(
        &mut self,
        simd: S,
        planes: &[SamplePlane],
        fragments: &mut Fragments,
        lit: &mut Lit<'_>,
        background: &dyn Fn(i32) -> Vec4,
        tile: [i32; 2],
        size: [i32; 2],
    ) {
        resolve_opaque(simd, &mut self.0, planes, lit, background, [tile, size]);
        fragments.sort();
        let mut rest = fragments.list.as_slice();
        while let Some(first) = rest.first() {
            let count = rest.iter().take_while(|f| f.pixel == first.pixel).count();
            let (of_pixel, others) = rest.split_at(count);
            rest = others;
            let (x, y) = (first.pixel as i32 % TILE, first.pixel as i32 / TILE);
            if x < size[0] && y < size[1] {
                self.0[first.pixel as usize] =
                    blended(planes, of_pixel, lit, background, [tile[0] + x, tile[1] + y]);
            }
        }
    }
}

/// All pixels of a tile without blended surfaces.
#[simd]
fn resolve_opaque<S: Simd>(
    simd: S,
    colors: &mut [Vec4],
    planes: &[SamplePlane],
    lit: &mut Lit<'_>,
    background: &dyn Fn(i32) -> Vec4,
    [tile, size]: [[i32; 2]; 2],
) {
    for y in 0..size[1] {
        let behind = premultiply(background(tile[1] + y));
        let mut x = 0;
        while x < size[0] {
            let index = (y * TILE + x) as usize;
            let out = &mut colors[index..index + 8];
            resolve_eight(simd, out, planes, index, lit, behind, [tile[0] + x, tile[1] + y]);
            x += 8;
        }
    }
}

/// Eight pixels in a row: those that show one item at all samples together, the others one by one.
#[inline(always)]
fn resolve_eight<S: Simd>(
    simd: S,
    out: &mut [Vec4],
    planes: &[SamplePlane],
    index: usize,
    lit: &mut Lit<'_>,
    behind: Vec4,
    [x, y]: [i32; 2],
) {
    let mut whole = [NO_ITEM; 8];
    whole.copy_from_slice(&planes[0].items()[index..index + 8]);
    let mut mixed = [false; 8];
    for plane in &planes[1..] {
        let items = &plane.items()[index..index + 8];
        for i in 0..8 {
            mixed[i] |= items[i] != whole[i];
        }
    }
    for i in 0..8 {
        if mixed[i] {
            whole[i] = NO_ITEM;
        }
    }
    out.fill(behind);
    if whole != [NO_ITEM; 8] {
        let mut colors = [Vec4::ZERO; 8];
        lit.colors_x8(simd, &whole, x, y, &mut colors);
        for i in 0..8 {
            if whole[i] != NO_ITEM {
                // Opaque and masked surfaces hide what is behind them.
                out[i] = colors[i].truncate().extend(1.0);
            }
        }
    }
    for i in 0..8 {
        if mixed[i] {
            let each = sample_colors(planes, index + i, lit, behind, [x + i as i32, y]);
            out[i] = average(&each[..planes.len()]);
        }
    }
}

/// The colour at each sample of a pixel; each item is lit once.
fn sample_colors(
    planes: &[SamplePlane],
    index: usize,
    lit: &mut Lit<'_>,
    behind: Vec4,
    [x, y]: [i32; 2],
) -> [Vec4; 16] {
    let mut colors = [behind; 16];
    for i in 0..planes.len() {
        let item = planes[i].items()[index];
        if item == NO_ITEM {
            continue;
        }
        let earlier = (0..i).find(|&j| planes[j].items()[index] == item);
        colors[i] = match earlier {
            Some(j) => colors[j],
            None => lit.color(item, x, y).truncate().extend(1.0),
        };
    }
    colors
}

fn average(colors: &[Vec4]) -> Vec4 {
    let sum = colors.iter().fold(Vec4::ZERO, |sum, &c| sum + c);
    // The number of samples is a power of two, so this is exact.
    sum * (1.0 / colors.len() as f32)
}

/// A pixel with blended surfaces, composed at each sample.
fn blended(
    planes: &[SamplePlane],
    fragments: &[Fragment],
    lit: &mut Lit<'_>,
    background: &dyn Fn(i32) -> Vec4,
    [x, y]: [i32; 2],
) -> Vec4 {
    let index = fragments[0].pixel as usize;
    let mut colors = sample_colors(planes, index, lit, premultiply(background(y)), [x, y]);
    for fragment in fragments {
        let over = premultiply(lit.color(fragment.item, x, y));
        for (i, under) in colors[..planes.len()].iter_mut().enumerate() {
            if fragment.samples >> i & 1 == 1 {
                *under = over + *under * (1.0 - over.w);
            }
        }
    }
    average(&colors[..planes.len()])
}

/// The background's colour in each row of a picture of this height.
pub fn background_rows(background: Background, height: u32) -> impl Fn(i32) -> Vec4 {
    move |y| match background {
        Background::Color(color) => color,
        Background::Gradient(top, bottom) => {
            let t = (y as f32 + 0.5) / height as f32;
            top * (1.0 - t) + bottom * t
        }
    }
}
