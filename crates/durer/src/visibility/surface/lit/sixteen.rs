//! Lighting visible items sixteen pixels at a time: eight in a row and the eight below them, which show
//! mostly the same triangles.

use super::{Lit, LookedUp, RunInfo};
use crate::shade::lane::Vec3Lane;
use crate::shade::{Faces, Points, PreparedMaterial, Shading, TexCoords, shade_points_x16};
use crate::target::NO_ITEM;
use crate::visibility::surface::gather::{Gathered, points};
use crate::visibility::surface::textured::{GatheredCoords, coordinates_of_one};
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16, u32x16};
use fearless_simd_macros::simd;

/// Sixteen pixels whose neighbours in their rows differ at most as often are interpolated triangle by
/// triangle, others pixel by pixel.
const FEW_CHANGES: u32 = 5;

/// Whether sixteen pixels in two rows show few triangles.
#[inline(always)]
pub fn are_few<S: Simd>(simd: S, shown: u32x16<S>) -> bool {
    // All but the last of each row.
    const IN_ROWS: u64 = 0x7f7f;
    let beside = simd.slide_u32x16::<1>(shown, shown);
    (shown.simd_ne(beside).to_bitmask() & IN_ROWS).count_ones() <= FEW_CHANGES
}

impl<'a> Lit<'a> {
    /// Linear RGBA, straight alpha, of two rows of eight pixels, from (x, y) and from the pixel below:
    /// of those with an item, of which there is one. The bits are those of [`Self::colors_x8`].
    #[simd]
    pub fn colors_x16<S: Simd>(
        simd: S,
        this: &mut Lit<'_>,
        shown: u32x16<S>,
        [x, y]: [i32; 2],
        colors: &mut [[f32; 16]; 4],
    ) {
        let items: [u32; 16] = shown.into();
        let there = shown.simd_ne(u32x16::splat(simd, NO_ITEM)).to_bitmask();
        let info = this.run_info(items[there.trailing_zeros() as usize % 16]);
        let mine = (shown - info.first_item).simd_lt(u32x16::splat(simd, info.count));
        if info.plain && mine.to_bitmask() == there {
            let points = if are_few(simd, shown) {
                this.points_by_triangle(simd, info.run, (shown, &items), there, [x, y])
            } else {
                this.points_by_pixel(simd, info.run, &items, there, [x, y])
            };
            let (material, lights) = (info.material, this.shared.lights);
            let [r, g, b] = shade_points_x16(simd, &points, material, lights, info.shading);
            *colors = [r, g, b, [material.plain_alpha(); 16]];
            return;
        }
        if let Some(looked_up) = info.looked_up
            && mine.to_bitmask() == there
        {
            let run = (&info, looked_up);
            *colors = this.looked_up_x16(simd, run, (shown, &items), there, [x, y]);
            return;
        }
        let (rows, _) = items.as_chunks::<8>();
        for (i, row) in rows.iter().enumerate().filter(|(_, row)| **row != [NO_ITEM; 8]) {
            let mut eight = [[0.0; 8]; 4];
            Self::colors_x8(simd, this, row, x, y + i as i32, &mut eight);
            for (to, from) in colors.iter_mut().zip(&eight) {
                to[8 * i..8 * i + 8].copy_from_slice(from);
            }
        }
    }

    /// Linear red, green and blue of one item at sixteen pixels as in [`Self::colors_x16`], of which `there` tells
    /// where it shows; `None` where its material asks for more than [`shade_points_x16`].
    #[inline(always)]
    pub fn colors_of_one_x16<S: Simd>(
        &mut self,
        simd: S,
        item: u32,
        there: u64,
        [x, y]: [i32; 2],
    ) -> Option<[[f32; 16]; 3]> {
        let info = self.run_info(item);
        if !info.plain {
            return None;
        }
        let without_shadows = self.shared.lights.shadows.is_empty();
        let t = self.triangles.get(item, info.run);
        let (rows, has_coordinates) = t.points_x16(simd, x, y);
        let faces = if without_shadows && t.settled && there & !has_coordinates == 0 {
            Faces::Settled
        } else {
            Faces::Normals(Vec3Lane::splat(rows[0], t.face_normal))
        };
        let points = points(rows, faces, self.parallel_view);
        let lights = self.shared.lights;
        Some(shade_points_x16(simd, &points, info.material, lights, info.shading))
    }

    /// Colours as in [`Self::colors_x16`] of the pixels of a set, all of a run whose textures are looked up together.
    #[inline(always)]
    pub(super) fn looked_up_x16<S: Simd>(
        &mut self,
        simd: S,
        (info, looked_up): (&RunInfo<'a>, LookedUp<'a>),
        (shown, items): (u32x16<S>, &[u32; 16]),
        there: u64,
        at: [i32; 2],
    ) -> [[f32; 16]; 4] {
        let few = are_few(simd, shown);
        let points = if info.shading == Shading::Unlit {
            // Nothing is asked of them.
            points([f32x16::splat(simd, 0.0); 6], Faces::Settled, self.parallel_view)
        } else if few {
            self.points_by_triangle(simd, info.run, (shown, items), there, at)
        } else {
            self.points_by_pixel(simd, info.run, items, there, at)
        };
        let coords = if few {
            self.coords_by_triangle(simd, (info.run, looked_up), (shown, items), there, at)
        } else {
            self.coords_by_pixel(simd, (info.run, looked_up), items, there, at)
        };
        let (material, lights) = (info.material, self.shared.lights);
        let (color, alpha) =
            PreparedMaterial::shade_x16(simd, material, &points, &coords, lights, info.shading);
        [color.x.into(), color.y.into(), color.z.into(), alpha.into()]
    }

    /// The texture coordinates at the pixels of a set, all of one run.
    #[inline(always)]
    fn coords_by_pixel<S: Simd>(
        &mut self,
        simd: S,
        (run, LookedUp { coords, changing }): (usize, LookedUp<'a>),
        items: &[u32; 16],
        mut left: u64,
        [x, y]: [i32; 2],
    ) -> TexCoords<f32x16<S>> {
        let mut gathered = GatheredCoords::default();
        while left != 0 {
            let i = left.trailing_zeros() as usize % 16;
            left &= left - 1;
            let pixel = [x + i as i32 % 8, y + i as i32 / 8];
            let t = self.triangles.get(items[i], run);
            gathered.set(i, t, pixel, t.corners.map(|c| coords[c as usize]));
        }
        gathered.coordinates(simd, changing)
    }

    /// The same: at all sixteen pixels of each triangle, of which those that show it are taken. Pixels not in
    /// the set have coordinates near to the others'.
    #[inline(always)]
    fn coords_by_triangle<S: Simd>(
        &mut self,
        simd: S,
        (run, LookedUp { coords, changing }): (usize, LookedUp<'a>),
        (shown, items): (u32x16<S>, &[u32; 16]),
        there: u64,
        at: [i32; 2],
    ) -> TexCoords<f32x16<S>> {
        let first = items[there.trailing_zeros() as usize % 16];
        let t = self.triangles.get(first, run);
        let corners = t.corners.map(|c| coords[c as usize]);
        let mut all = coordinates_of_one(simd, t, at, corners, changing);
        let mut left = there & !shown.simd_eq(u32x16::splat(simd, first)).to_bitmask();
        while left != 0 {
            let item = items[left.trailing_zeros() as usize % 16];
            let same = shown.simd_eq(u32x16::splat(simd, item));
            left &= !same.to_bitmask();
            let t = self.triangles.get(item, run);
            let corners = t.corners.map(|c| coords[c as usize]);
            let of_t = coordinates_of_one(simd, t, at, corners, changing);
            for k in 0..2 {
                all.uv[k] = same.select(of_t.uv[k], all.uv[k]);
                all.ddx[k] = same.select(of_t.ddx[k], all.ddx[k]);
                all.ddy[k] = same.select(of_t.ddy[k], all.ddy[k]);
            }
        }
        all
    }

    /// The points that the pixels of a set show, all of one run.
    #[inline(always)]
    fn points_by_pixel<S: Simd>(
        &mut self,
        simd: S,
        run: usize,
        items: &[u32; 16],
        mut left: u64,
        [x, y]: [i32; 2],
    ) -> Points<f32x16<S>> {
        let mut rows = [Gathered::default(); 2];
        while left != 0 {
            let i = left.trailing_zeros() as usize % 16;
            left &= left - 1;
            let pixel = [x + i as i32 % 8, y + i as i32 / 8];
            rows[i / 8].set(simd, i, self.triangles.get(items[i], run), pixel);
        }
        Gathered::both(simd, &rows, self.parallel_view)
    }

    /// The same: all sixteen points of each triangle, of which those that show it are taken.
    #[inline(always)]
    fn points_by_triangle<S: Simd>(
        &mut self,
        simd: S,
        run: usize,
        (shown, items): (u32x16<S>, &[u32; 16]),
        mut left: u64,
        [x, y]: [i32; 2],
    ) -> Points<f32x16<S>> {
        let zero = f32x16::splat(simd, 0.0);
        let mut row = [zero; 6];
        let mut settled = self.shared.lights.shadows.is_empty();
        let there = left;
        while left != 0 {
            let item = items[left.trailing_zeros() as usize % 16];
            let same = shown.simd_eq(u32x16::splat(simd, item));
            let bits = same.to_bitmask();
            left &= !bits;
            let t = self.triangles.get(item, run);
            let (of_t, has_coordinates) = t.points_x16(simd, x, y);
            settled &= t.settled && bits & !has_coordinates == 0;
            for (to, from) in row.iter_mut().zip(of_t) {
                *to = same.select(from, *to);
            }
        }
        let faces = if settled {
            Faces::Settled
        } else {
            Faces::Normals(self.face_normals(simd, run, (shown, items), there))
        };
        points(row, faces, self.parallel_view)
    }

    /// The unit normals of the faces that the pixels of a set show.
    #[inline(always)]
    fn face_normals<S: Simd>(
        &mut self,
        simd: S,
        run: usize,
        (shown, items): (u32x16<S>, &[u32; 16]),
        mut left: u64,
    ) -> Vec3Lane<f32x16<S>> {
        let mut normal = [f32x16::splat(simd, 0.0); 3];
        while left != 0 {
            let item = items[left.trailing_zeros() as usize % 16];
            let same = shown.simd_eq(u32x16::splat(simd, item));
            left &= !same.to_bitmask();
            let of_face = self.triangles.get(item, run).face_normal.to_array();
            for (to, from) in normal.iter_mut().zip(of_face) {
                *to = same.select(f32x16::splat(simd, from), *to);
            }
        }
        let [x, y, z] = normal;
        Vec3Lane::new(x, y, z)
    }
}
