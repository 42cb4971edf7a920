//! Lighting visible items: one pixel with everything a material can have, or eight plain ones.

use super::attributes::{Triangles, VisibleTriangle, Weights, blend, blend_x8};
use crate::math::{Vec2, Vec3, Vec4};
use crate::scene::{Projection, Scene, Topology};
use crate::shade::{
    Batch, PreparedLights, PreparedMaterial, PreparedMaterials, Reflected, Shading, Surface,
    TexCoord, shade, shade_face, shade_vertex, shade_x8,
};
use crate::target::NO_ITEM;
use crate::view::View;
use crate::visibility::surface::setup::Run;
use fearless_simd::Simd;

/// Sets of texture coordinates that are looked at.
const TEX_COORD_SETS: usize = 4;

/// What all threads share.
#[derive(Clone, Copy)]
pub struct Lighting<'a> {
    pub scene: &'a Scene,
    pub view: &'a View,
    pub runs: &'a [Run],
    pub materials: &'a PreparedMaterials<'a>,
    pub lights: &'a PreparedLights,
    pub shading: Option<Shading>,
}

/// One thread's way from items to colours.
pub struct Lit<'a> {
    shared: Lighting<'a>,
    triangles: Triangles<'a>,
    /// Towards the eye where projection lines are parallel.
    parallel_view: Option<Vec3>,
    /// The light on the face or at the corners of the latest triangle; for flat and Gouraud.
    reflected: Option<(u32, [Reflected; 3])>,
}

impl<'a> Lit<'a> {
    pub fn new(shared: Lighting<'a>) -> Self {
        let camera = shared.view.camera();
        let parallel_view = match camera.projection {
            Projection::Perspective { .. } => None,
            Projection::Orthographic { .. } => Some(camera.axes()[2].as_vec3()),
        };
        let triangles = Triangles::new(shared.scene, shared.view, shared.runs);
        Self { shared, triangles, parallel_view, reflected: None }
    }

    fn material(&self, run: usize) -> (&'a PreparedMaterial<'a>, Shading) {
        let run = &self.shared.runs[run];
        let mesh = &self.shared.scene.meshes[run.mesh];
        let material = self.shared.materials.get(run.material);
        let without_sides = mesh.topology != Topology::Triangles && mesh.normals.is_empty();
        let shading = match self.shared.shading {
            _ if without_sides => Shading::Unlit,
            Some(shading) => shading,
            None => material.shading(),
        };
        (material, shading)
    }

    /// Whether eight pixels of a run can be shaded at a time.
    fn is_plain(&self, run: usize) -> bool {
        let (material, shading) = self.material(run);
        let mesh = &self.shared.scene.meshes[self.shared.runs[run].mesh];
        let per_pixel = !matches!(shading, Shading::Flat | Shading::Gouraud);
        material.is_plain() && mesh.colors.is_empty() && per_pixel
    }

    /// Linear RGBA, straight alpha, of an item at a pixel's centre.
    pub fn color(&mut self, item: u32, x: i32, y: i32) -> Vec4 {
        self.with_surface(item, x, y, |surface, material, lights, shading| {
            shade(surface, material, lights, shading)
        })
    }

    /// Whether a masked surface is there at a pixel's centre.
    pub fn passes_mask(&mut self, item: u32, x: i32, y: i32) -> bool {
        self.with_surface(item, x, y, |surface, material, _, _| material.alpha(surface) > 0.0)
    }

    /// Unit normal of an item at a pixel's centre, world axes, turned to the eye.
    pub fn normal(&mut self, item: u32, x: i32, y: i32) -> Vec3 {
        let parallel = self.parallel_view;
        let t = self.triangles.get(item);
        let w = t.weights(x, y, [0.0; 2]);
        let normal = blend(&t.normals, w).normalize_or(t.face_normal);
        let view = parallel.unwrap_or(-blend(&t.positions, w));
        if normal.dot(view) < 0.0 { -normal } else { normal }
    }

    fn with_surface<R>(
        &mut self,
        item: u32,
        x: i32,
        y: i32,
        use_it: impl FnOnce(&Surface<'_>, &PreparedMaterial<'_>, &PreparedLights, Shading) -> R,
    ) -> R {
        let run = self.triangles.get(item).run;
        let (material, shading) = self.material(run);
        let lit = self.reflected(item, material, shading);
        let parallel = self.parallel_view;
        let t = self.triangles.get(item);
        let mesh = &self.shared.scene.meshes[self.shared.runs[run].mesh];
        let w = t.weights(x, y, [0.0; 2]);
        let position = blend(&t.positions, w);
        let mut tex_coords = [TexCoord::default(); TEX_COORD_SETS];
        let mut surface = Surface {
            position,
            view: parallel.unwrap_or(-position),
            normal: blend(&t.normals, w),
            geometric_normal: t.face_normal,
            lit: lit.map(|corners| Reflected::interpolate(corners, w)),
            ..Surface::default()
        };
        if !mesh.colors.is_empty() {
            let [a, b, c] = t.corners.map(|c| mesh.colors[c as usize]);
            surface.color = a * w[0] + b * w[1] + c * w[2];
        }
        if material.is_textured() {
            let (right, down) = t.weights_beside(x, y);
            for (set, coordinates) in mesh.tex_coords.iter().take(TEX_COORD_SETS).enumerate() {
                let corners = t.corners.map(|c| coordinates[c as usize]);
                tex_coords[set] = tex_coord(&corners, w, right, down);
            }
            if material.has_normal_map() {
                surface.position_dx = blend(&t.positions, right) - position;
                surface.position_dy = blend(&t.positions, down) - position;
                surface.tangent = t.tangent(mesh, w);
            }
            surface.tex_coords = &tex_coords;
        }
        use_it(&surface, material, self.shared.lights, shading)
    }

    /// The light on the corners of a triangle, for shadings that interpolate it.
    fn reflected(
        &mut self,
        item: u32,
        material: &PreparedMaterial<'_>,
        shading: Shading,
    ) -> Option<[Reflected; 3]> {
        if !matches!(shading, Shading::Flat | Shading::Gouraud) {
            return None;
        }
        if let Some((kept, corners)) = self.reflected
            && kept == item
        {
            return Some(corners);
        }
        let (lights, parallel) = (self.shared.lights, self.parallel_view);
        let t = self.triangles.get(item);
        let view = |p: Vec3| parallel.unwrap_or(-p);
        let corners = if shading == Shading::Flat {
            let centroid = (t.positions[0] + t.positions[1] + t.positions[2]) / 3.0;
            [shade_face(centroid, view(centroid), t.face_normal, material, lights); 3]
        } else {
            [0, 1, 2].map(|i| {
                let (p, n) = (t.positions[i], t.normals[i]);
                shade_vertex(p, view(p), n, t.face_normal, material, lights)
            })
        };
        self.reflected = Some((item, corners));
        Some(corners)
    }

    /// Linear RGBA of up to eight pixels in a row from `x`: those with an item.
    ///
    /// Plain materials are shaded eight at a time, others one by one; the bits are the same.
    #[inline(always)]
    pub fn colors_x8<S: Simd>(
        &mut self,
        simd: S,
        items: &[u32; 8],
        x: i32,
        y: i32,
        colors: &mut [Vec4; 8],
    ) {
        let mut done = [false; 8];
        for i in 0..8 {
            if done[i] || items[i] == NO_ITEM {
                continue;
            }
            let run = self.triangles.get(items[i]).run;
            if self.is_plain(run) {
                self.plain_x8(simd, run, items, [x, y], &mut done, colors);
            } else {
                colors[i] = self.color(items[i], x + i as i32, y);
            }
        }
    }

    /// Shades all of eight pixels whose items belong to one plain run.
    #[inline(always)]
    fn plain_x8<S: Simd>(
        &mut self,
        simd: S,
        run: usize,
        items: &[u32; 8],
        [x, y]: [i32; 2],
        done: &mut [bool; 8],
        colors: &mut [Vec4; 8],
    ) {
        let mut batch = Batch::default();
        let mut mine = [false; 8];
        for i in 0..8 {
            if done[i] || items[i] == NO_ITEM || self.triangles.run_of(items[i]) != run {
                continue;
            }
            let parallel = self.parallel_view;
            let t = self.triangles.get(items[i]);
            let mut lanes = [false; 8];
            for j in i..8 {
                lanes[j] = items[j] == items[i];
                done[j] |= lanes[j];
                mine[j] |= lanes[j];
            }
            interpolate_x8(simd, t, [x, y], parallel, &lanes, &mut batch);
        }
        let (material, shading) = self.material(run);
        let [r, g, b] = shade_x8(simd, &batch, material, self.shared.lights, shading);
        for i in 0..8 {
            if mine[i] {
                colors[i] = Vec4::new(r[i], g[i], b[i], 1.0);
            }
        }
    }
}

/// Fills the lanes of a batch that show one triangle.
#[inline(always)]
fn interpolate_x8<S: Simd>(
    simd: S,
    t: &VisibleTriangle,
    [x, y]: [i32; 2],
    parallel_view: Option<Vec3>,
    lanes: &[bool; 8],
    batch: &mut Batch,
) {
    let w = t.weights_x8(simd, x, y);
    let position = blend_x8(&t.positions, &w);
    let normal = blend_x8(&t.normals, &w);
    let face = t.face_normal.to_array();
    let parallel = parallel_view.map(|v| v.to_array());
    let all = *lanes == [true; 8];
    for axis in 0..3 {
        let (p, n): ([f32; 8], [f32; 8]) = (position[axis].into(), normal[axis].into());
        let v: [f32; 8] = match parallel {
            Some(view) => [view[axis]; 8],
            None => (-position[axis]).into(),
        };
        if all {
            batch.position[axis] = p;
            batch.normal[axis] = n;
            batch.view[axis] = v;
            batch.geometric_normal[axis] = [face[axis]; 8];
            continue;
        }
        for i in 0..8 {
            if lanes[i] {
                batch.position[axis][i] = p[i];
                batch.normal[axis][i] = n[i];
                batch.view[axis][i] = v[i];
                batch.geometric_normal[axis][i] = face[axis];
            }
        }
    }
}

/// Texture coordinates at a pixel, and their change to the pixels beside and below it.
fn tex_coord(corners: &[Vec2; 3], w: Weights, right: Weights, down: Weights) -> TexCoord {
    let at = |w: Weights| corners[0] * w[0] + corners[1] * w[1] + corners[2] * w[2];
    let uv = at(w);
    TexCoord { uv, ddx: at(right) - uv, ddy: at(down) - uv }
}
