//! From visible items to colours.
//!
//! [`Lit`] lights items: one point with all that a material can have in this file, sixteen pixels at a time in
//! [`sixteen`]. Where a point is, its normal, and the direction to the eye come from [`points`](super::points), the
//! formulas from [`shade`](crate::shade); a run's [`Way`] decides which of these are needed.
//!
//! [`PointQueue`] collects the points of plain materials, each with its weight in a pixel, until there are enough to be
//! lit together. [`KnownNormals`] keeps normals from the set-up of small triangles.

mod coords;
mod known;
mod lighting;
mod queue;
mod shares;
mod sixteen;
#[cfg(test)]
mod tests;

pub use known::KnownNormals;
pub use lighting::Lighting;
pub use queue::{BlockSums, PointQueue, ShadingPoint};
pub use shares::MOST_SAMPLES;
pub use sixteen::opaque;

use crate::math::{Vec2, Vec3, Vec4};
use crate::shade::{
    PreparedLights, PreparedMaterial, Reflected, Shading, Surface, TexCoord, shade, shade_face,
    shade_seen, shade_vertex,
};
use crate::visibility::surface::points::attributes::{VisibleTriangle, Weights, blend, run_of};
use crate::visibility::surface::points::sight::Sight;
use crate::visibility::surface::points::triangles::{
    Needs, OF_ROWS, OF_TILES, Triangles, parallel_view,
};
use lighting::{LookedUp, RunInfo, Way};

/// Sets of texture coordinates that are examined.
const TEX_COORD_SETS: usize = 4;

/// The viewpoint of an item's point.
#[derive(Debug, Clone, Copy)]
pub enum Seen {
    /// View from the eye, at a pixel's centre.
    Pixel(i32, i32),
    /// View from anywhere, as by a ray that was reflected; textures are sampled at full size.
    Point {
        /// Barycentric coordinates of the point.
        weights: Weights,
        /// Direction from which it is seen, world axes.
        view: Vec3,
    },
}

/// Lights items, on one thread.
pub struct Lit<'a> {
    shared: Lighting<'a>,
    triangles: Triangles<'a>,
    /// Data of their triangles that lighting several pixels of plain materials needs.
    needs: Needs,
    /// The run of the latest item.
    latest: Option<RunInfo<'a>>,
    /// Direction to the eye where projection lines are parallel.
    parallel_view: Option<Vec3>,
    /// Directions to the eye, by pixel.
    sight: Sight,
    /// The light on the face or at the corners of the latest triangle; for flat and Gouraud.
    reflected: Option<(u32, [Reflected; 3])>,
}

impl<'a> Lit<'a> {
    /// Creates the state for a picture that is made tile by tile.
    pub fn new(shared: Lighting<'a>) -> Self {
        Self::keeping(shared, OF_TILES)
    }

    /// Creates the state for a picture that is made row by row.
    pub fn by_rows(shared: Lighting<'a>) -> Self {
        Self::keeping(shared, OF_ROWS)
    }

    fn keeping(shared: Lighting<'a>, kept: usize) -> Self {
        let (parallel_view, sight) = (parallel_view(shared.view), Sight::new(shared.view));
        let Lighting { scene, view, runs, reach, level, .. } = shared;
        let triangles = Triangles::new(scene, view, runs, level, (kept, reach));
        let needs = shared.needs();
        Self { shared, triangles, needs, latest: None, parallel_view, sight, reflected: None }
    }

    /// Returns the run of an item and its material.
    #[inline(always)]
    fn run_info(&mut self, item: u32) -> RunInfo<'a> {
        match self.latest {
            Some(info) if info.has(item) => info,
            _ => self.find_run_info(item),
        }
    }

    #[cold]
    fn find_run_info(&mut self, item: u32) -> RunInfo<'a> {
        let info = self.shared.run_info(run_of(self.shared.runs, item));
        self.latest = Some(info);
        info
    }

    /// Requests the triangle of an item, which [`Self::make_ready`] then sets up with all others that were
    /// requested: several at a time are faster than each alone.
    #[inline(always)]
    pub fn expect(&mut self, item: u32) {
        let (plain, run) = match &self.latest {
            Some(info) if info.has(item) => (info.is_plain(), info.run),
            _ => {
                let info = self.find_run_info(item);
                (info.is_plain(), info.run)
            }
        };
        let needs = if plain { self.needs } else { Needs::All };
        if !self.triangles.has(item, needs) {
            self.triangles.want(item, run, needs);
        }
    }

    /// Prepares the expected triangles.
    pub fn make_ready(&mut self) {
        self.triangles.make_ready();
    }

    /// Returns linear RGBA, straight alpha, of a point of an item under given lights.
    pub fn color_under(&mut self, item: u32, seen: Seen, lights: &PreparedLights) -> Vec4 {
        self.with_surface(item, seen, |surface, material, _, shading| {
            // Light computed at corners or for faces cannot depend on the lights that reach the point.
            let surface = Surface { lit: None, ..*surface };
            match seen {
                Seen::Pixel(..) => shade_seen(&surface, material, lights, shading),
                Seen::Point { .. } => shade(&surface, material, lights, shading),
            }
        })
    }

    /// Returns linear RGBA, straight alpha, of a whole face under given lights: flat shading, where
    /// the material is not unlit.
    pub fn face_color(&mut self, item: u32, lights: &PreparedLights) -> Vec4 {
        let parallel = self.parallel_view;
        let weights = [1.0 / 3.0; 3];
        let view = parallel.unwrap_or_else(|| -blend(&self.triangle(item).positions(), weights));
        let seen = Seen::Point { weights, view };
        self.with_surface(item, seen, |surface, material, _, shading| {
            if shading == Shading::Unlit {
                return shade(surface, material, lights, shading);
            }
            let face = surface.geometric_normal;
            let lit = shade_face(surface.position, surface.view, face, material, lights);
            let surface = Surface { lit: Some(lit), ..*surface };
            shade(&surface, material, lights, Shading::Flat)
        })
    }

    /// Returns the alpha of a point of an item.
    pub fn alpha(&mut self, item: u32, seen: Seen) -> f32 {
        self.with_surface(item, seen, |surface, material, _, _| material.alpha(surface))
    }

    /// Returns the triangle of an item.
    pub fn triangle(&mut self, item: u32) -> &VisibleTriangle {
        let run = self.run_info(item).run;
        self.triangles.get(item, run)
    }

    /// Returns linear RGBA, straight alpha, of an item at a pixel's centre.
    pub fn color(&mut self, item: u32, x: i32, y: i32) -> Vec4 {
        self.with_surface(item, Seen::Pixel(x, y), |surface, material, lights, shading| {
            shade_seen(surface, material, lights, shading)
        })
    }

    /// Returns whether a masked surface is there at a pixel's centre.
    pub fn passes_mask(&mut self, item: u32, x: i32, y: i32) -> bool {
        self.alpha(item, Seen::Pixel(x, y)) > 0.0
    }

    /// Returns unit normal of an item at a pixel's centre, world axes, turned to the eye.
    pub fn normal(&mut self, item: u32, x: i32, y: i32) -> Vec3 {
        let (view, run) = (self.sight.towards_eye([x, y]), self.run_info(item).run);
        let t = self.triangles.get(item, run);
        let normal = t.normal_within(x, y).normalize_or(t.seen_face_normal);
        if normal.dot(view) < 0.0 { -normal } else { normal }
    }

    /// Calls `use_it` with the surface at a point of an item, its material, the lights and the shading.
    fn with_surface<R>(
        &mut self,
        item: u32,
        seen: Seen,
        use_it: impl FnOnce(&Surface<'_>, &'a PreparedMaterial<'a>, &PreparedLights, Shading) -> R,
    ) -> R {
        let RunInfo { run, mesh, material, shading, .. } = self.run_info(item);
        let lit = self.reflected(item, run, material, shading);
        let sight = self.sight;
        let t = self.triangles.get(item, run);
        // Weights of the corners, direction to the viewpoint and normals, at a pixel or at any point.
        let (w, view, normal, face) = match seen {
            Seen::Pixel(x, y) => {
                let view = sight.towards_eye([x, y]);
                (t.weights(x, y), view, t.normal(x, y), t.seen_face_normal)
            }
            Seen::Point { weights: w, view } => {
                (w, view, blend(&t.corner_normals(), w), t.face_normal())
            }
        };
        let position = blend(&t.positions(), w);
        // The values that every material needs.
        let mut tex_coords = [TexCoord::default(); TEX_COORD_SETS];
        let mut surface = Surface {
            position,
            view,
            normal,
            geometric_normal: face,
            lit: lit.map(|corners| Reflected::interpolate(corners, w)),
            ..Surface::default()
        };
        // Colours and texture coordinates of the vertices, if the mesh and the material have them.
        if !mesh.colors.is_empty() {
            let [a, b, c] = t.corners.map(|c| mesh.colors[c as usize]);
            surface.color = a * w[0] + b * w[1] + c * w[2];
        }
        if material.is_textured() {
            let (right, down) = match seen {
                Seen::Pixel(x, y) => t.weights_beside(x, y),
                Seen::Point { .. } => (w, w),
            };
            for (set, coordinates) in mesh.tex_coords.iter().take(TEX_COORD_SETS).enumerate() {
                let corners = t.corners.map(|c| coordinates[c as usize]);
                tex_coords[set] = tex_coord(&corners, w, right, down);
            }
            // A normal map needs the change of the position over the screen, and the tangent.
            if material.has_normal_map() {
                surface.position_dx = blend(&t.positions(), right) - position;
                surface.position_dy = blend(&t.positions(), down) - position;
                surface.tangent = t.tangent(mesh, w).map(|tangent| {
                    let world = self.shared.world_axes(run, tangent.truncate());
                    world.normalize_or_zero().extend(tangent.w)
                });
            }
            surface.tex_coords = &tex_coords;
        }
        use_it(&surface, material, self.shared.lights, shading)
    }

    /// Returns the light on the corners of a triangle, for shadings that interpolate it.
    fn reflected(
        &mut self,
        item: u32,
        run: usize,
        material: &PreparedMaterial<'_>,
        shading: Shading,
    ) -> Option<[Reflected; 3]> {
        // Light computed at corners or for faces cannot depend on shadows.
        let interpolated = matches!(shading, Shading::Flat | Shading::Gouraud);
        if !interpolated || !self.shared.lights.shadows.is_empty() {
            return None;
        }
        if let Some((kept, corners)) = self.reflected
            && kept == item
        {
            return Some(corners);
        }
        let (lights, parallel) = (self.shared.lights, self.parallel_view);
        let t = self.triangles.get(item, run);
        let view = |p: Vec3| parallel.unwrap_or(-p);
        let corners = if shading == Shading::Flat {
            let [a, b, c] = t.positions();
            let centroid = (a + b + c) / 3.0;
            [shade_face(centroid, view(centroid), t.face_normal(), material, lights); 3]
        } else {
            let (positions, normals) = (t.positions(), t.corner_normals());
            [0, 1, 2].map(|i| {
                let (p, n) = (positions[i], normals[i]);
                shade_vertex(p, view(p), n, t.face_normal(), material, lights)
            })
        };
        self.reflected = Some((item, corners));
        Some(corners)
    }
}

/// Returns texture coordinates at a pixel, and their change to the pixels beside and below it.
fn tex_coord(corners: &[Vec2; 3], w: Weights, right: Weights, down: Weights) -> TexCoord {
    let at = |w: Weights| corners[0] * w[0] + corners[1] * w[1] + corners[2] * w[2];
    let uv = at(w);
    TexCoord { uv, ddx: at(right) - uv, ddy: at(down) - uv }
}
