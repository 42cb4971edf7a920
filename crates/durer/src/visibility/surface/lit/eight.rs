//! Lighting visible items eight pixels at a time, where their materials allow it.

use super::{Lit, LookedUp, RunInfo};
use crate::math::{Vec3, Vec4};
use crate::shade::lane::Vec3Lane;
use crate::shade::{Faces, Points, Sample, Samples, shade_points};
use crate::target::NO_ITEM;
use crate::visibility::surface::attributes::VisibleTriangle;
use crate::visibility::surface::gather::{Gathered, points};
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x8, u32x8, u32x16};
use fearless_simd_macros::simd;

/// Eight pixels in a row that change the triangle at most as often are interpolated triangle by triangle,
/// others pixel by pixel.
const FEW_CHANGES: u32 = 2;

/// Eight pixels in a row from (x, y), and which of them are to be shaded.
#[derive(Clone, Copy)]
struct Eight<'e> {
    items: &'e [u32; 8],
    /// All bits set, or none.
    chosen: &'e [u32; 8],
    x: i32,
    y: i32,
}

impl Eight<'_> {
    /// The lanes chosen, each with its item and pixel.
    #[inline(always)]
    fn pixels(self) -> impl Iterator<Item = (usize, u32, [i32; 2])> {
        let Self { items, chosen, x, y } = self;
        let lanes = (0..8).filter(move |&i| chosen[i] != 0);
        lanes.map(move |i| (i, items[i], [x + i as i32, y]))
    }
}

impl<'a> Lit<'a> {
    /// Linear RGBA, straight alpha, of up to eight pixels in a row from `x`: those with an item.
    ///
    /// Where the material allows it they are lit eight at a time, else one by one; the bits are the same.
    #[simd]
    pub fn colors_x8<S: Simd>(
        simd: S,
        this: &mut Lit<'_>,
        items: &[u32; 8],
        x: i32,
        y: i32,
        colors: &mut [[f32; 8]; 4],
    ) {
        let mut done = [false; 8];
        for i in 0..8 {
            if done[i] || items[i] == NO_ITEM {
                continue;
            }
            let info = this.run_info(items[i]);
            if info.plain && i == 0 && *items == [items[0]; 8] {
                return this.one_triangle_x8(simd, &info, items[0], [x, y], colors);
            }
            if info.plain || info.together || info.looked_up.is_some() {
                this.run_x8(simd, &info, items, [x, y], &mut done, colors);
            } else {
                let color = this.color(items[i], x + i as i32, y);
                set_lane(colors, i, color);
            }
        }
    }

    /// Shades eight pixels that show one triangle of a plain run.
    #[inline(always)]
    fn one_triangle_x8<S: Simd>(
        &mut self,
        simd: S,
        info: &RunInfo<'a>,
        item: u32,
        [x, y]: [i32; 2],
        colors: &mut [[f32; 8]; 4],
    ) {
        let parallel = self.parallel_view;
        let t = self.triangles.get(item, info.run);
        let points = points_x8(simd, t, [x, y], parallel);
        let lights = self.shared.lights;
        let [r, g, b] = shade_points(simd, &points, info.material, lights, info.shading);
        *colors = [r, g, b, [info.material.plain_alpha(); 8]];
    }

    /// Shades all of eight pixels whose items belong to one run.
    #[inline(always)]
    fn run_x8<S: Simd>(
        &mut self,
        simd: S,
        info: &RunInfo<'a>,
        items: &[u32; 8],
        [x, y]: [i32; 2],
        done: &mut [bool; 8],
        colors: &mut [[f32; 8]; 4],
    ) {
        let mut mine = [0; 8];
        for i in 0..8 {
            if items[i].wrapping_sub(info.first_item) < info.count {
                (done[i], mine[i]) = (true, u32::MAX);
            }
        }
        let eight = Eight { items, chosen: &mine, x, y };
        let shaded = if info.plain {
            let [r, g, b] = self.plain_x8(simd, info, eight);
            [r, g, b, [info.material.plain_alpha(); 8]]
        } else if let Some(looked_up) = info.looked_up {
            self.looked_up_x8(simd, (info, looked_up), eight)
        } else {
            let [r, g, b] = self.textured_x8(simd, info, eight);
            [r, g, b, [1.0; 8]]
        };
        for (to, from) in colors.iter_mut().zip(&shaded) {
            fill_axis(*from, &mine, to);
        }
    }

    /// Shades the chosen of eight pixels, of a plain run.
    #[inline(always)]
    fn plain_x8<S: Simd>(
        &mut self,
        simd: S,
        info: &RunInfo<'a>,
        eight: Eight<'_>,
    ) -> [[f32; 8]; 3] {
        let mut changes = 0;
        for i in 1..8 {
            changes += u32::from(eight.items[i] != eight.items[i - 1]);
        }
        if changes <= FEW_CHANGES {
            let points = self.points_of_few(simd, info.run, eight);
            return shade_points(simd, &points, info.material, self.shared.lights, info.shading);
        }
        let mut gathered = Gathered::default();
        for (lane, item, pixel) in eight.pixels() {
            gathered.set(simd, lane, self.triangles.get(item, info.run), pixel);
        }
        self.shade_gathered(simd, info, &gathered)
    }

    /// The points at the chosen of eight pixels in a row: all eight of each triangle, of which those that
    /// show it are taken.
    #[inline(always)]
    fn points_of_few<S: Simd>(
        &mut self,
        simd: S,
        run: usize,
        eight: Eight<'_>,
    ) -> Points<f32x8<S>> {
        let zero = f32x8::splat(simd, 0.0);
        let Eight { items, chosen, x, y } = eight;
        let shown = u32x8::from_slice(simd, items);
        let (mut row, mut normal) = ([zero; 6], [zero; 3]);
        let chosen = u32x8::from_slice(simd, chosen).simd_ne(u32x8::splat(simd, 0));
        let mut left = chosen.to_bitmask();
        while left != 0 {
            let item = items[left.trailing_zeros() as usize % 8];
            let same = shown.simd_eq(u32x8::splat(simd, item));
            left &= !same.to_bitmask();
            let t = self.triangles.get(item, run);
            let of_t = t.points_x8(simd, x, y);
            let of_face = t.face_normal.to_array();
            for (to, from) in row.iter_mut().zip(of_t) {
                *to = same.select(from, *to);
            }
            for (to, from) in normal.iter_mut().zip(of_face) {
                *to = same.select(f32x8::splat(simd, from), *to);
            }
        }
        let [nx, ny, nz] = normal;
        points(row, Faces::Normals(Vec3Lane::new(nx, ny, nz)), self.parallel_view)
    }

    /// Shades the chosen of eight pixels, of a run whose textures are looked up together.
    #[inline(always)]
    fn looked_up_x8<S: Simd>(
        &mut self,
        simd: S,
        (info, looked_up): (&RunInfo<'a>, LookedUp<'a>),
        eight: Eight<'_>,
    ) -> [[f32; 8]; 4] {
        let (mut items, mut there) = ([NO_ITEM; 16], 0);
        for (lane, item, _) in eight.pixels() {
            items[lane] = item;
            there |= 1 << lane;
        }
        let (shown, at) = (u32x16::from_slice(simd, &items), [eight.x, eight.y]);
        let sixteen = self.looked_up_x16(simd, (info, looked_up), (shown, &items), there, at);
        let mut colors = [[0.0; 8]; 4];
        for (to, from) in colors.iter_mut().zip(&sixteen) {
            to.copy_from_slice(&from[..8]);
        }
        colors
    }

    /// Shades the chosen of eight pixels, of a run that is lit together.
    #[inline(always)]
    fn textured_x8<S: Simd>(
        &mut self,
        simd: S,
        info: &RunInfo<'a>,
        eight: Eight<'_>,
    ) -> [[f32; 8]; 3] {
        let mut samples = Samples::default();
        for (lane, item, [x, y]) in eight.pixels() {
            samples.set(lane, &self.sample(item, x, y));
        }
        Samples::shade(simd, &samples, self.shared.lights, info.shading)
    }

    /// What the textures say of an item at a pixel's centre.
    fn sample(&mut self, item: u32, x: i32, y: i32) -> Sample {
        self.with_surface(item, x, y, |surface, material, _, shading| {
            material.sample(surface, shading)
        })
    }

    #[inline(always)]
    fn shade_gathered<S: Simd>(
        &self,
        simd: S,
        info: &RunInfo<'a>,
        gathered: &Gathered,
    ) -> [[f32; 8]; 3] {
        let points = gathered.points(simd, self.parallel_view);
        shade_points(simd, &points, info.material, self.shared.lights, info.shading)
    }
}

#[inline(always)]
fn set_lane(lanes: &mut [[f32; 8]; 4], lane: usize, v: Vec4) {
    for (channel, value) in lanes.iter_mut().zip(v.to_array()) {
        channel[lane] = value;
    }
}

/// The points of a triangle at eight pixels in a row.
#[inline(always)]
fn points_x8<S: Simd>(
    simd: S,
    t: &VisibleTriangle,
    [x, y]: [i32; 2],
    parallel_view: Option<Vec3>,
) -> Points<f32x8<S>> {
    let face = Vec3Lane::splat(f32x8::splat(simd, 0.0), t.face_normal);
    points(t.points_x8(simd, x, y), Faces::Normals(face), parallel_view)
}

#[inline(always)]
fn fill_axis(from: [f32; 8], lanes: &[u32; 8], to: &mut [f32; 8]) {
    // Bits instead of a choice, which would become a slow masked store.
    for i in 0..8 {
        let old = to[i].to_bits();
        to[i] = f32::from_bits(old ^ ((old ^ from[i].to_bits()) & lanes[i]));
    }
}
