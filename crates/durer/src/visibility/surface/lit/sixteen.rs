//! Lighting of visible items, sixteen pixels at a time, where their materials allow it.

use super::known::Known;
use super::{Lit, LookedUp, RunInfo, Seen, Way};
use crate::math::{Vec3, Vec4};
use crate::shade::lane::Vec3Lane;
use crate::shade::{
    Faces, Points, PreparedMaterial, Shading, TexturedPoint, TexturedPoints, shade_points,
};
use crate::target::NO_ITEM;
use crate::visibility::surface::gather::Gathered;
use crate::visibility::surface::points::normal_plane::NormalPlane;
use crate::visibility::surface::points::patch::Patch;
use crate::visibility::surface::points::triangles::Needs;
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16, mask32x16, u32x16};
use fearless_simd_macros::simd;

/// Returns red, green and blue.
#[inline(always)]
pub fn opaque<S: Simd>(simd: S, [r, g, b, _]: &[[f32; 16]; 4]) -> [f32x16<S>; 3] {
    let (r, g) = (f32x16::from_slice(simd, r), f32x16::from_slice(simd, g));
    [r, g, f32x16::from_slice(simd, b)]
}

/// Returns one vector where a mask is set, the other elsewhere.
#[inline(always)]
fn chosen<S: Simd>(
    mask: mask32x16<S>,
    set: Vec3Lane<f32x16<S>>,
    other: Vec3Lane<f32x16<S>>,
) -> Vec3Lane<f32x16<S>> {
    let (x, y) = (mask.select(set.x, other.x), mask.select(set.y, other.y));
    Vec3Lane::new(x, y, mask.select(set.z, other.z))
}

impl<'a> Lit<'a> {
    /// Computes the colours, linear RGBA with straight alpha, of the pixels of a patch that have an item, at least one.
    ///
    /// They are lit together if the material allows it, else one by one; the bits are the same.
    #[simd]
    pub fn colors_x16<S: Simd>(
        simd: S,
        this: &mut Lit<'_>,
        shown: u32x16<S>,
        patch: Patch,
        colors: &mut [[f32; 16]; 4],
    ) {
        let items: [u32; 16] = shown.into();
        let there = shown.simd_ne(u32x16::splat(simd, NO_ITEM)).to_bitmask();
        let mut left = there;
        while left != 0 {
            let info = this.run_info(items[left.trailing_zeros() as usize % 16]);
            let mine = (shown - info.first_item).simd_lt(u32x16::splat(simd, info.count));
            let bits = mine.to_bitmask();
            let shaded = this.colors_of_run(simd, &info, (shown, &items), bits, patch);
            if bits == there {
                *colors = shaded;
                return;
            }
            left &= !bits;
            for (to, from) in colors.iter_mut().zip(&shaded) {
                let (old, new) = (f32x16::from_slice(simd, to), f32x16::from_slice(simd, from));
                mine.select(new, old).store_slice(to);
            }
        }
    }

    /// Returns colours as in [`Self::colors_x16`] of the pixels of a set, all of one run.
    #[inline(always)]
    fn colors_of_run<S: Simd>(
        &mut self,
        simd: S,
        info: &RunInfo<'a>,
        (shown, items): (u32x16<S>, &[u32; 16]),
        there: u64,
        patch: Patch,
    ) -> [[f32; 16]; 4] {
        match info.way {
            Way::Plain => {
                let points = self.points(simd, info.run, (shown, items), there, patch);
                let (material, lights) = (info.material, self.shared.lights);
                let [r, g, b] = shade_points(simd, &points, material, lights, info.shading);
                [r, g, b, [material.plain_alpha(); 16]]
            }
            Way::LookedUp(looked_up) => {
                self.looked_up_x16(simd, (info, looked_up), (shown, items), there, patch)
            }
            Way::Sampled => self.sampled_x16(simd, info, items, there, patch),
            Way::Alone => {
                let mut colors = [[0.0; 16]; 4];
                for i in (0..16).filter(|i| there >> i & 1 == 1) {
                    let [x, y] = patch.pixel(i);
                    let color: Vec4 = self.color(items[i], x, y);
                    for (channel, value) in colors.iter_mut().zip(color.to_array()) {
                        channel[i] = value;
                    }
                }
                colors
            }
        }
    }

    /// Returns colours as in [`Self::colors_x16`] of the pixels of a set, all of a run whose textures are looked up
    /// together.
    #[inline(always)]
    fn looked_up_x16<S: Simd>(
        &mut self,
        simd: S,
        (info, looked_up): (&RunInfo<'a>, LookedUp<'a>),
        (shown, items): (u32x16<S>, &[u32; 16]),
        there: u64,
        patch: Patch,
    ) -> [[f32; 16]; 4] {
        let points = if info.shading == Shading::Unlit {
            // Unlit shading uses none of these vectors.
            let none = Vec3Lane::splat(f32x16::splat(simd, 0.0), Vec3::ZERO);
            Points { position: none, view: none, normal: none, faces: Faces::Settled }
        } else {
            self.points(simd, info.run, (shown, items), there, patch)
        };
        let coords = if patch.shows_few(simd, shown) {
            self.coords_by_triangle(simd, (info.run, looked_up), (shown, items), there, patch)
        } else {
            self.coords_by_pixel(simd, (info.run, looked_up), items, there, patch)
        };
        let (material, lights) = (info.material, self.shared.lights);
        let (color, alpha) =
            PreparedMaterial::shade_x16(simd, material, &points, &coords, lights, info.shading);
        [color.x.into(), color.y.into(), color.z.into(), alpha.into()]
    }

    /// Returns the colours of a run that is lit together after its textures were looked up one by one.
    #[inline(always)]
    fn sampled_x16<S: Simd>(
        &mut self,
        simd: S,
        info: &RunInfo<'a>,
        items: &[u32; 16],
        there: u64,
        patch: Patch,
    ) -> [[f32; 16]; 4] {
        let mut colors = [[1.0; 16]; 4];
        for first in [0, 8] {
            if there >> first & 0xff == 0 {
                continue;
            }
            let mut points = TexturedPoints::default();
            for i in (first..first + 8).filter(|i| there >> i & 1 == 1) {
                let [x, y] = patch.pixel(i);
                points.set(i % 8, &self.sample(items[i], x, y));
            }
            let shaded = TexturedPoints::shade(simd, &points, self.shared.lights, info.shading);
            for (to, from) in colors.iter_mut().zip(&shaded) {
                to[first..first + 8].copy_from_slice(from);
            }
        }
        colors
    }

    /// Returns the values of an item's textures at a pixel's centre.
    fn sample(&mut self, item: u32, x: i32, y: i32) -> TexturedPoint<'a> {
        self.with_surface(item, Seen::Pixel(x, y), |surface, material, _, shading| {
            material.textured_point(surface, shading)
        })
    }

    /// Returns the normals of an item, if they are settled and nothing else is needed.
    #[inline(always)]
    pub(super) fn settled_plane(&mut self, item: u32, run: usize) -> Option<&NormalPlane> {
        match self.needs {
            Needs::All => None,
            Needs::Normals => Some(self.triangles.normals(item, run)).filter(|n| n.settled),
        }
    }

    /// Returns whether lights need the positions of points.
    #[inline(always)]
    pub(super) fn with_positions(&self) -> bool {
        self.with_shadows() || !self.shared.lights.points.is_empty()
    }

    /// Returns whether shadows need the positions of points and the normals of their faces.
    #[inline(always)]
    fn with_shadows(&self) -> bool {
        !self.shared.lights.shadows.is_empty()
    }

    /// Returns the points that the pixels of a set show, all of one run.
    #[inline(always)]
    pub(super) fn points<S: Simd>(
        &mut self,
        simd: S,
        run: usize,
        shown: (u32x16<S>, &[u32; 16]),
        there: u64,
        patch: Patch,
    ) -> Points<f32x16<S>> {
        let view = self.sight.towards_eye_x16(simd, patch);
        if patch.shows_few(simd, shown.0) {
            self.points_by_triangle(simd, run, shown, there, (patch, view))
        } else {
            let none = (0, Gathered::default());
            self.points_by_pixel(simd, run, shown.1, (there, none), (&patch.pixels(), view))
        }
    }

    /// Returns the points as [`Self::points`] does, where some of the normals may be known; the positions of these
    /// points are not requested.
    #[inline(always)]
    pub(super) fn points_known<S: Simd>(
        &mut self,
        simd: S,
        run: usize,
        shown: (u32x16<S>, &[u32; 16]),
        there: u64,
        (patch, known): (Patch, Option<Known<S>>),
    ) -> Points<f32x16<S>> {
        let mut others = there;
        if let Some((known, normal)) = known {
            others &= !known.to_bitmask();
            if others == 0 {
                let view = self.sight.towards_eye_x16(simd, patch);
                return Points { position: view, view, normal, faces: Faces::Settled };
            }
        }
        let mut points = self.points(simd, run, shown, others, patch);
        if let Some((known, normal)) = known {
            points.normal = chosen(known, normal, points.normal);
            if let Faces::Seen(faces) = &mut points.faces {
                // Settled normals are on the visible side.
                *faces = chosen(known, normal, *faces);
            }
        }
        points
    }

    /// Returns the points, each gathered from its triangle; the bits mark points whose normals are known, and thus
    /// settled.
    #[inline(always)]
    pub(super) fn points_by_pixel<S: Simd>(
        &mut self,
        simd: S,
        run: usize,
        items: &[u32; 16],
        (there, (known, mut normals)): (u64, (u64, Gathered)),
        (pixels, view): (&[[i32; 2]; 16], Vec3Lane<f32x16<S>>),
    ) -> Points<f32x16<S>> {
        let mut positions = Gathered::default();
        let (with_positions, with_shadows) = (self.with_positions(), self.with_shadows());
        let (mut faces, mut unsettled, mut left) = (Gathered::default(), 0, there & !known);
        // Gather the vectors of each pixel; settled triangles need only the plane of their normals.
        while left != 0 {
            let i = left.trailing_zeros() as usize % 16;
            left &= left - 1;
            if let Some(plane) = self.settled_plane(items[i], run) {
                normals.set(i, plane.at_x4(simd, pixels[i]));
                continue;
            }
            let t = self.triangles.get(items[i], run);
            if with_shadows || !t.normals.settled {
                unsettled |= 1 << i;
            }
            normals.set(i, t.normal_x4(simd, pixels[i]));
            faces.set_vector(i, t.seen_face_normal);
            if with_positions {
                positions.set(i, t.position(simd, pixels[i]));
            }
        }
        let normal = normals.vectors(simd);
        let position = if with_positions { positions.vectors(simd) } else { view };
        let faces = if unsettled == 0 {
            Faces::Settled
        } else {
            // Settled normals are on the visible side.
            let mut left = there & !unsettled;
            while left != 0 {
                let i = left.trailing_zeros() as usize % 16;
                left &= left - 1;
                faces.copy(i, &normals);
            }
            Faces::Seen(faces.vectors(simd))
        };
        Points { position, view, normal, faces }
    }

    /// Returns the points: computes them at all pixels for each triangle and selects the pixels that show it.
    #[inline(always)]
    fn points_by_triangle<S: Simd>(
        &mut self,
        simd: S,
        run: usize,
        (shown, items): (u32x16<S>, &[u32; 16]),
        there: u64,
        (patch, view): (Patch, Vec3Lane<f32x16<S>>),
    ) -> Points<f32x16<S>> {
        let (with_positions, with_shadows) = (self.with_positions(), self.with_shadows());
        let (mut normal, mut position) = ([view.x; 3], [view.x; 3]);
        let (mut unsettled, mut left) = (0, there);
        while left != 0 {
            // All pixels that show the same item are computed together.
            let item = items[left.trailing_zeros() as usize % 16];
            let same = shown.simd_eq(u32x16::splat(simd, item));
            let bits = same.to_bitmask();
            left &= !bits;
            let of_item = match self.settled_plane(item, run) {
                Some(plane) => plane.of_patch(simd, patch),
                None => {
                    let t = self.triangles.get(item, run);
                    if with_shadows || !t.normals.settled {
                        unsettled |= bits & there;
                    }
                    if with_positions {
                        for (to, from) in position.iter_mut().zip(t.positions_x16(simd, patch)) {
                            *to = same.select(from, *to);
                        }
                    }
                    t.normals_x16(simd, patch)
                }
            };
            for (to, from) in normal.iter_mut().zip(of_item) {
                *to = same.select(from, *to);
            }
        }
        let ([nx, ny, nz], [px, py, pz]) = (normal, position);
        let (normal, position) = (Vec3Lane::new(nx, ny, nz), Vec3Lane::new(px, py, pz));
        let faces = if unsettled == 0 {
            Faces::Settled
        } else {
            // Settled normals are on the visible side.
            Faces::Seen(self.face_normals(simd, run, (shown, items), unsettled, normal))
        };
        Points { position, view, normal, faces }
    }

    /// Returns the unit normals of the sides of faces that the pixels of a set show, and other vectors
    /// elsewhere.
    #[inline(always)]
    fn face_normals<S: Simd>(
        &mut self,
        simd: S,
        run: usize,
        (shown, items): (u32x16<S>, &[u32; 16]),
        mut left: u64,
        elsewhere: Vec3Lane<f32x16<S>>,
    ) -> Vec3Lane<f32x16<S>> {
        let mut normal = [elsewhere.x, elsewhere.y, elsewhere.z];
        while left != 0 {
            let item = items[left.trailing_zeros() as usize % 16];
            let same = shown.simd_eq(u32x16::splat(simd, item));
            left &= !same.to_bitmask();
            let of_face = self.triangles.get(item, run).seen_face_normal.to_array();
            for (to, from) in normal.iter_mut().zip(of_face) {
                *to = same.select(f32x16::splat(simd, from), *to);
            }
        }
        let [x, y, z] = normal;
        Vec3Lane::new(x, y, z)
    }
}
