//! One texture at many points that lie near to each other: their texels are decoded once for all of them.
//!
//! Every operation is the one of [`PreparedTexture::sample`], in the same order, so the bits are the
//! same.

use super::color::decode_srgb8;
use super::lane::Vec3Lane;
use super::lookup::{Rows, columns, fixed_x16, four, mean, spread, straight_x16};
use super::material::PreparedMaterial;
use super::mip::Level;
use super::slot::Texel;
use super::texel_rows::TexelRows;
use super::texture::{PreparedTexture, Usage, inside};
use super::tone;
use crate::math::Vec4;
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16, i32x16};
use fearless_simd_macros::simd;

/// Points are taken sixteen at a time, up to as many times.
pub const MOST_PATCHES: usize = 32;

/// So many texels per sixteen points are decoded at most: where more lie between them, most of them are not looked at.
const TEXELS_OF_PATCH: usize = 32;

/// Texels that are decoded at most.
const MOST_TEXELS: usize = MOST_PATCHES * TEXELS_OF_PATCH;

/// Rows of at most as many texels are copied in one go, and of at most twice as many in a wider one.
const COPIED: usize = 8;

/// Points of one unlit material that shows a texture, and the texels around them.
pub struct Strip {
    points: Vec<Sixteen>,
    /// The texels as they are stored.
    codes: Box<[[u8; 4]; MOST_TEXELS]>,
    /// Whether the points of each eight lie between the same two rows of texels.
    between_rows: bool,
    /// The texels where points lie so and near enough to each other; else they are in `texels`.
    rows: Option<Box<TexelRows>>,
    /// Whether they are in `rows`.
    in_rows: bool,
    /// One more than are decoded, so that each has one after it.
    texels: Box<[[f32; 4]; MOST_TEXELS + 1]>,
    /// Column and row of the first texel; it may be beyond the border of the image by one.
    first: [i32; 2],
    /// Texels in a row.
    columns: i32,
}

/// Where sixteen points lie in the image: column and row of the first of four texels around them, which may be −1,
/// and how much the second ones weigh.
#[derive(Clone, Copy)]
struct Sixteen {
    first: [[i32; 16]; 2],
    weights: [[f32; 16]; 2],
}

impl Default for Strip {
    fn default() -> Self {
        let texels = Box::new([[0.0; 4]; MOST_TEXELS + 1]);
        let codes = Box::new([[0; 4]; MOST_TEXELS]);
        Self {
            points: Vec::with_capacity(MOST_PATCHES),
            codes,
            between_rows: true,
            rows: None,
            in_rows: false,
            texels,
            first: [0; 2],
            columns: 0,
        }
    }
}

impl Strip {
    /// Forgets all points.
    pub fn clear(&mut self) {
        self.points.clear();
        self.between_rows = true;
    }

    /// Adds sixteen points by their coordinates in the set that the material's texture uses.
    #[inline(always)]
    pub fn add<S: Simd>(&mut self, simd: S, material: &PreparedMaterial<'_>, uv: [f32x16<S>; 2]) {
        let Some(slot) = material.base_color_slot() else { return };
        let texture = &slot.texture;
        let (level, sampler) = (texture.chain.level(0), &texture.sampler);
        let [u, v] = slot.placed(uv);
        let (x, tx) = fixed_x16(simd, u, level.width as i32, sampler.wrap_u);
        let (y, ty) = fixed_x16(simd, v, level.height as i32, sampler.wrap_v);
        let (first, weights) = ([x.into(), y.into()], [tx.into(), ty.into()]);
        // Of each eight the last has none beside it.
        let differs = y.simd_ne(simd.slide_i32x16::<1>(y, y)).to_bitmask();
        self.between_rows &= differs & 0x7f7f == 0;
        self.points.push(Sixteen { first, weights });
    }

    /// Decodes all texels around the points. If there are too many nothing is done, and [`Self::color`] may not be asked:
    /// then this is not true.
    #[simd]
    pub fn decode<S: Simd>(simd: S, this: &mut Self, material: &PreparedMaterial<'_>) -> bool {
        let Some(slot) = material.base_color_slot() else { return false };
        let Some([[left, right], [top, low]]) = this.ends(simd) else { return false };
        let (columns, rows) = ((right - left) as usize + 2, (low - top) as usize + 2);
        if columns.saturating_mul(rows) > TEXELS_OF_PATCH * this.points.len() {
            return false;
        }
        (this.first, this.columns) = ([left, top], columns as i32);
        // First all rows are copied: they come from far, and while one is decoded not all others could be waited for.
        slot.texture.copy_area([left, top], [columns, rows], &mut this.codes);
        let codes = &this.codes[..columns * rows];
        this.in_rows = this.between_rows && TexelRows::have_room([columns, rows]);
        if this.in_rows {
            let to = this.rows.get_or_insert_default();
            for (y, codes) in codes.chunks_exact(columns).enumerate() {
                slot.texture.decode_base(codes, |x, texel| to.set([x, y], texel));
            }
        } else {
            let to = &mut this.texels;
            slot.texture.decode_base(codes, |i, texel| to[i % MOST_TEXELS] = texel.to_array());
        }
        true
    }

    /// Least and largest column and row of the first texels around the points.
    #[inline(always)]
    fn ends<S: Simd>(&self, simd: S) -> Option<[[i32; 2]; 2]> {
        let first = self.points.first()?;
        let mut least = [first_of(simd, first, 0), first_of(simd, first, 1)];
        let mut most = least;
        for points in &self.points {
            for axis in 0..2 {
                let these = first_of(simd, points, axis);
                least[axis] = least[axis].min(these);
                most[axis] = most[axis].max(these);
            }
        }
        let x = [simd.reduce_min_i32x16(least[0]), simd.reduce_max_i32x16(most[0])];
        let y = [simd.reduce_min_i32x16(least[1]), simd.reduce_max_i32x16(most[1])];
        Some([x, y])
    }

    /// Linear red, green and blue of the sixteen points that were added as those of this number, and their alpha, bit for
    /// bit as by [`PreparedMaterial::shade_x16`].
    #[inline(always)]
    pub fn color<S: Simd>(
        &self,
        simd: S,
        material: &PreparedMaterial<'_>,
        number: usize,
    ) -> (Vec3Lane<f32x16<S>>, f32x16<S>) {
        let points = &self.points[number];
        let usage = material.base_color_slot().map_or(Usage::Color, |s| s.texture.chain.usage);
        let means = match &self.rows {
            Some(rows) if self.in_rows => {
                let x = first_of(simd, points, 0) - self.first[0];
                let [above, below] = rows_of(&points.first);
                let y = [above - self.first[1], below - self.first[1]];
                let tx = f32x16::from_slice(simd, &points.weights[0]);
                let ty = f32x16::from_slice(simd, &points.weights[1]);
                rows.means(simd, (x, y), [tx, ty], usage == Usage::ColorWithAlpha)
            }
            _ => columns(simd, self.means(simd, points)),
        };
        let texel = Texel(straight_x16(simd, means, usage));
        let (color, alpha) = (material.base_times(&texel), material.alpha_times(&texel));
        // Weights are whole multiples of 2⁻¹², so that means of texels within 0…1 stay there.
        if usage != Usage::ColorWithAlpha && material.base_is_shown() {
            (color, alpha)
        } else {
            (tone::display(color), alpha)
        }
    }

    /// The means of four texels each at sixteen points.
    #[inline(always)]
    fn means<S: Simd>(&self, simd: S, points: &Sixteen) -> Rows<S> {
        let x = first_of(simd, points, 0) - self.first[0];
        let y = first_of(simd, points, 1) - self.first[1];
        let upper = y * self.columns + x;
        let lower: [i32; 16] = (upper + self.columns).into();
        let upper: [i32; 16] = upper.into();
        let tx = spread(simd, f32x16::from_slice(simd, &points.weights[0]));
        let ty = spread(simd, f32x16::from_slice(simd, &points.weights[1]));
        // Not in a loop, in which they would be stored and read again.
        [
            self.mean_of_four(simd, (&upper, &lower), 0, [tx[0], ty[0]]),
            self.mean_of_four(simd, (&upper, &lower), 1, [tx[1], ty[1]]),
            self.mean_of_four(simd, (&upper, &lower), 2, [tx[2], ty[2]]),
            self.mean_of_four(simd, (&upper, &lower), 3, [tx[3], ty[3]]),
        ]
    }

    /// The means of four texels each at four points side by side, from the point 4 `i` on.
    #[inline(always)]
    fn mean_of_four<S: Simd>(
        &self,
        simd: S,
        (upper, lower): (&[i32; 16], &[i32; 16]),
        i: usize,
        weights: [f32x16<S>; 2],
    ) -> f32x16<S> {
        let (a, b) = (self.four_from(simd, upper, i, 0), self.four_from(simd, upper, i, 1));
        let (c, d) = (self.four_from(simd, lower, i, 0), self.four_from(simd, lower, i, 1));
        mean([a, b, c, d], weights)
    }

    /// The texels of four points side by side, from the point 4 `i` on: so many after the given ones.
    #[inline(always)]
    fn four_from<S: Simd>(&self, simd: S, at: &[i32; 16], i: usize, after: usize) -> f32x16<S> {
        let texels = &self.texels;
        let a = Vec4::from_array(texels[at[4 * i] as usize % MOST_TEXELS + after]);
        let b = Vec4::from_array(texels[at[4 * i + 1] as usize % MOST_TEXELS + after]);
        let c = Vec4::from_array(texels[at[4 * i + 2] as usize % MOST_TEXELS + after]);
        let d = Vec4::from_array(texels[at[4 * i + 3] as usize % MOST_TEXELS + after]);
        four(simd, [a, b, c, d])
    }
}

/// Columns or rows of the first texels around sixteen points.
#[inline(always)]
fn first_of<S: Simd>(simd: S, points: &Sixteen, axis: usize) -> i32x16<S> {
    i32x16::from_slice(simd, &points.first[axis])
}

/// The rows of the first texels around the first of sixteen points and around the ninth.
#[inline(always)]
fn rows_of(first: &[[i32; 16]; 2]) -> [i32; 2] {
    [first[1][0], first[1][8]]
}

impl PreparedTexture<'_> {
    /// Copies texels of so many columns and rows of the image; the first and the last may be beyond the border by one.
    #[inline(always)]
    fn copy_area(
        &self,
        [left, top]: [i32; 2],
        [columns, rows]: [usize; 2],
        out: &mut [[u8; 4]; MOST_TEXELS],
    ) {
        let Level { width, height, texels } = self.chain.level(0);
        let is_inside = left >= 0 && left as usize + columns <= width as usize;
        for i in 0..rows {
            let y = inside((top + i as i32).into(), height, self.sampler.wrap_v) as usize;
            let from = texels.get(y * width as usize..).unwrap_or(&[]);
            let to = &mut out[i * columns..];
            // All in one width, though there are fewer: what is behind them comes later.
            let from_left = from.get(left as usize..).unwrap_or(&[]);
            if is_inside
                && (columns <= COPIED && copy_chunk::<COPIED>(from_left, to)
                    || columns <= 2 * COPIED && copy_chunk::<{ 2 * COPIED }>(from_left, to))
            {
                continue;
            }
            for (x, to) in (left..).zip(to).take(columns) {
                let texel = from.get(inside(x.into(), width, self.sampler.wrap_u) as usize);
                *to = texel.copied().unwrap_or([255; 4]);
            }
        }
    }

    /// Gives the decoded texels of a base colour with their numbers; those of opaque materials need no alpha.
    #[inline(always)]
    fn decode_base(&self, codes: &[[u8; 4]], mut to: impl FnMut(usize, Vec4)) {
        if self.chain.usage == Usage::ColorWithAlpha {
            for (i, &code) in codes.iter().enumerate() {
                to(i, self.decode(code));
            }
        } else {
            for (i, &[r, g, b, _]) in codes.iter().enumerate() {
                to(i, Vec4::new(decode_srgb8(r), decode_srgb8(g), decode_srgb8(b), 1.0));
            }
        }
    }
}

/// Copies so many texels, if there is room for them on both sides.
#[inline(always)]
fn copy_chunk<const COUNT: usize>(from: &[[u8; 4]], to: &mut [[u8; 4]]) -> bool {
    let (Some(from), Some(to)) = (from.first_chunk::<COUNT>(), to.first_chunk_mut()) else {
        return false;
    };
    *to = *from;
    true
}

#[cfg(test)]
mod tests {
    use super::super::lookup::TexCoords;
    use super::super::{Faces, Points, PreparedLights, PreparedMaterials, Shading};
    use super::*;
    use crate::math::{DMat3, DVec2, DVec3, Vec3};
    use crate::scene::{
        AlphaMode, Camera, Image, Material, MipFilter, Projection, Sampler, Scene, ShadingModel,
        Texture, TextureRef, Wrap,
    };
    use crate::simd::levels;
    use fearless_simd::dispatch;

    /// Coordinates of sixteen points.
    type Sixteen = [[f32; 16]; 2];

    /// Compares a strip with [`PreparedMaterial::shade_x16`]: whether its texels are not too many, and are in rows.
    #[simd]
    fn agrees<S: Simd>(
        simd: S,
        strip: &mut Strip,
        material: &PreparedMaterial<'_>,
        points: &[Sixteen],
    ) -> [bool; 2] {
        let load =
            |uv: &Sixteen| [f32x16::from_slice(simd, &uv[0]), f32x16::from_slice(simd, &uv[1])];
        strip.clear();
        for uv in points {
            strip.add(simd, material, load(uv));
        }
        if !Strip::decode(simd, strip, material) {
            return [false; 2];
        }
        let none = [f32x16::splat(simd, 0.0); 2];
        let nowhere = Vec3Lane::splat(none[0], Vec3::ZERO);
        let nothing =
            Points { position: nowhere, view: nowhere, normal: nowhere, faces: Faces::Settled };
        let projection = Projection::Orthographic { height: 1.0 };
        let (eye, target, up) = (DVec3::Z, DVec3::ZERO, DVec3::Y);
        let camera = Camera { eye, target, up, projection, near: 0.1, far: 2.0 };
        let lights = PreparedLights::new(&[], &camera);
        for (i, uv) in points.iter().enumerate() {
            let at = TexCoords { uv: load(uv), ddx: none, ddy: none };
            let (one, alpha) =
                PreparedMaterial::shade_x16(simd, material, &nothing, &at, &lights, Shading::Unlit);
            let (ours, our_alpha) = strip.color(simd, material, i);
            for (a, b) in [(one.x, ours.x), (one.y, ours.y), (one.z, ours.z), (alpha, our_alpha)] {
                let bits = |v: f32x16<S>| <[f32; 16]>::from(v).map(f32::to_bits);
                assert_eq!(bits(a), bits(b), "{uv:?}");
            }
        }
        [true, strip.in_rows]
    }

    #[test]
    fn colours_of_strips_are_those_of_sixteen_points() {
        let mut seed = 3_u32;
        let mut random = || {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (seed >> 8) as f32 / (1 << 24) as f32
        };
        let strange = [f32::NAN, f32::INFINITY, -0.0, 1.0, -1e-9, 8_388_609.0, 3e9];
        let (mut decoded, mut too_many, mut in_rows) = (0, 0, 0);
        for (width, height) in [(1, 1), (3, 2), (30, 30), (64, 16), (400, 300)] {
            let opaque = height % 3 == 1;
            let data = (0..width * height).map(|_| {
                let [r, g, b, a] = [0; 4].map(|_: u8| (random() * 255.0) as u8);
                [r, g, b, if opaque { 255 } else { a }]
            });
            let images = vec![Image { name: String::new(), width, height, data: data.collect() }];
            for (wrap, bright) in
                [(Wrap::Repeat, 1.8), (Wrap::MirroredRepeat, 0.9), (Wrap::ClampToEdge, 0.9)]
            {
                let sampler = Sampler {
                    mip: MipFilter::None,
                    wrap_u: wrap,
                    wrap_v: wrap,
                    ..Default::default()
                };
                let textures = vec![Texture { image: 0, sampler }];
                let modes = [AlphaMode::Opaque, AlphaMode::Mask { cutoff: 0.5 }, AlphaMode::Blend];
                let materials = modes.map(|mode| {
                    let angle = if width == height { 0.0 } else { 0.3 };
                    let transform =
                        DMat3::from_scale_angle_translation(DVec2::splat(0.8), angle, DVec2::X);
                    let texture = TextureRef { texture: 0, tex_coord: 0, transform };
                    Material {
                        model: ShadingModel::Unlit,
                        base_color: Vec4::new(bright, 0.5, 1.0, 0.5),
                        base_color_texture: Some(texture),
                        alpha_mode: mode,
                        ..Material::default()
                    }
                });
                let (images, materials) = (images.clone(), materials.to_vec());
                let scene = Scene { images, textures, materials, ..Scene::default() };
                let prepared = PreparedMaterials::new(&scene);
                for round in 0..60 {
                    let material = prepared.get(Some(round % 3));
                    assert!(material.suits_strips(Shading::Unlit));
                    let (u, v, extent) =
                        (random() * 3.0, random() * 3.0, random() * random() * 0.4);
                    let mut points = vec![[[0.0; 16]; 2]; 1 + round / 2];
                    let upright = round % 2 == 0;
                    for [us, vs] in &mut points {
                        *us = us.map(|_| u + random() * extent);
                        if upright {
                            for eight in vs.chunks_exact_mut(8) {
                                eight.fill(v + random() * extent);
                            }
                        } else {
                            *vs = vs.map(|_| v + random() * extent);
                        }
                    }
                    if round % 4 == 0 {
                        points[round / 4][round % 2][round % 16] = strange[round % strange.len()];
                    }
                    for level in levels() {
                        let mut strip = Strip::default();
                        let [done, rows] = dispatch!(level, simd =>
                            agrees(simd, &mut strip, material, &points));
                        *if done { &mut decoded } else { &mut too_many } += 1;
                        in_rows += u32::from(rows);
                    }
                }
            }
        }
        assert!(decoded > 300 && too_many > 100, "{decoded} {too_many}");
        assert!(in_rows > 100 && decoded - in_rows > 100, "{in_rows} of {decoded}");
    }
}
