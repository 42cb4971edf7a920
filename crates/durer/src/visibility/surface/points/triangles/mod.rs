//! Visible triangles by item: prepared for interpolation eight at a time; the latest ones are kept, because neighbours
//! share them.
//!
//! Most pixels need only normals, for which a triangle's [`NormalPlane`] suffices.

mod prepare;
mod read;
#[cfg(test)]
mod tests;

use crate::math::{DMat3, DMat4, Mat3, Vec3};
use crate::raster::fixed::SUBPIXELS;
use crate::scene::{Mesh, Projection, Scene, Topology};
use crate::simd::{Level, dispatch};
use crate::view::View;
use crate::visibility::surface::points::attributes::VisibleTriangle;
use crate::visibility::surface::points::normal_plane::NormalPlane;
use crate::visibility::surface::setup::Run;
use fearless_simd::Simd;
use prepare::{normal_planes, prepare, prepare_normals};

pub use prepare::NormalPlanes;
pub use read::Read;

/// Transform that all triangles of a run share.
#[derive(Debug, Clone, Copy)]
struct RunTransform {
    run: usize,
    screen_from_mesh: DMat4,
    eye_from_mesh: DMat4,
    normal_from_mesh: Mat3,
    /// −1 where the instance mirrors, so that fronts stay fronts.
    handedness: f64,
    /// All that is seen has at least this w.
    least_w: f64,
    /// Largest change of edge functions from one pixel to the next for a triangle to be settled.
    most_change: f32,
}

/// Visible triangles by item; the latest ones are kept.
pub struct Triangles<'a> {
    scene: &'a Scene,
    view: &'a View,
    runs: &'a [Run],
    level: Level,
    /// Largest change of edge functions from one pixel to the next for a triangle to be settled.
    most_change: f32,
    transform: Option<RunTransform>,
    /// Prepared triangles; as many as `normals`.
    kept: Box<[VisibleTriangle]>,
    /// A power of two.
    normals: Box<[NormalPlane]>,
    wanted: Wanted,
    /// True if all of the latest were settled.
    settled: bool,
}

/// Number of triangles kept for pictures made tile by tile: about 200 kB, the number that a tile of a fine mesh shows.
pub const OF_TILES: usize = 1 << 10;

/// Number that is kept for pictures made row by row, about 800 kB: a row shows more than a tile, and most of
/// them again in the next.
pub const OF_ROWS: usize = 1 << 12;

/// Data of an item that are needed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Needs {
    /// A [`NormalPlane`]; the rest only where one of several is not settled.
    #[default]
    Normals,
    /// A [`VisibleTriangle`], with the normals in it.
    All,
}

/// Items of one run of which the same is to be prepared; their places are already reserved.
#[derive(Debug, Clone, Copy, Default)]
struct Wanted {
    items: [u32; 8],
    /// Their vertices in the mesh.
    corners: [[u32; 3]; 8],
    /// Sources of the values: read when they are needed, for reading has to wait for memory.
    read: Read,
    count: usize,
    run: usize,
    needs: Needs,
}

/// Undivided weights of a settled triangle are at least minus this wherever a sample of its pixels may be.
const LEAST_WEIGHT: f32 = 0.5;

impl<'a> Triangles<'a> {
    /// Keeps as many as `kept`, a power of two, or as there are, rounded up to one: small scenes then need no large
    /// blocks of memory. Samples are up to `reach`/256 pixels from pixels' centres.
    pub fn new(
        scene: &'a Scene,
        view: &'a View,
        runs: &'a [Run],
        level: Level,
        (kept, reach): (usize, i32),
    ) -> Self {
        let most_change = most_change(reach);
        let items = runs.last().map_or(0, |run| run.first_item as usize + run.range.len());
        let kept = items.min(kept).next_power_of_two();
        let normals = vec![NormalPlane::default(); kept].into_boxed_slice();
        let kept = vec![VisibleTriangle::default(); kept].into_boxed_slice();
        Self {
            scene,
            view,
            runs,
            level,
            most_change,
            transform: None,
            kept,
            normals,
            wanted: Wanted::default(),
            settled: true,
        }
    }

    /// Returns the triangle of an item that the rasterizer has drawn.
    #[inline(always)]
    pub fn get(&mut self, item: u32, run: usize) -> &VisibleTriangle {
        if !self.has(item, Needs::All) {
            self.want(item, run, Needs::All);
            self.make_ready();
        }
        &self.kept[place(item, &self.kept)]
    }

    /// Returns its normals.
    #[inline(always)]
    pub fn normals(&mut self, item: u32, run: usize) -> &NormalPlane {
        if !self.has(item, Needs::Normals) {
            self.want(item, run, Needs::Normals);
            self.make_ready();
        }
        &self.normals[place(item, &self.normals)]
    }

    /// Returns whether what is needed of an item is kept or requested.
    #[inline(always)]
    pub fn has(&self, item: u32, needs: Needs) -> bool {
        match needs {
            Needs::Normals => self.normals[place(item, &self.normals)].item == item,
            Needs::All => self.kept[place(item, &self.kept)].normals.item == item,
        }
    }

    /// Requests what is needed of an item, which is ready at the latest after [`Self::make_ready`], which must be called before
    /// [`Self::get`] and [`Self::normals`].
    #[inline(never)]
    pub fn want(&mut self, item: u32, run: usize, needs: Needs) {
        let Wanted { items, count, run: of, needs: of_needs, .. } = &self.wanted;
        if *count == items.len() || *of != run || *of_needs != needs {
            self.make_ready();
        }
        (self.wanted.run, self.wanted.needs) = (run, needs);
        let (corners, lane) = (self.corners(item, run), self.wanted.count);
        self.wanted.items[lane] = item;
        self.wanted.corners[lane] = corners;
        self.wanted.read.set(lane, &self.scene.meshes[self.runs[run].mesh], corners);
        self.wanted.count += 1;
        match needs {
            Needs::Normals => self.normals[place(item, &self.normals)].item = item,
            Needs::All => self.kept[place(item, &self.kept)].normals.item = item,
        }
    }

    /// Returns the vertices of an item in its mesh; for a line, its ends and the first one again.
    fn corners(&self, item: u32, run: usize) -> [u32; 3] {
        let run = &self.runs[run];
        let mesh = &self.scene.meshes[run.mesh];
        let primitive = (run.range.start + (item - run.first_item)) as usize;
        if mesh.topology == Topology::Triangles {
            return mesh.triangle(primitive);
        }
        let [a, b] = mesh.line_or_point(primitive);
        [a, b, a]
    }

    /// Prepares all requested items.
    pub fn make_ready(&mut self) {
        let Wanted { items, corners, read, count, run: index, needs } = &mut self.wanted;
        let (count, index, needs) = (std::mem::take(count), *index, *needs);
        if count == 0 {
            return;
        }
        let mesh = &self.scene.meshes[self.runs[index].mesh];
        // Unused lanes repeat the first item.
        for i in count..8 {
            (items[i], corners[i]) = (items[0], corners[0]);
            read.set(i, mesh, corners[0]);
        }
        if self.transform.as_ref().is_none_or(|t| t.run != index) {
            let run = &self.runs[index];
            let new = RunTransform::new(index, run, self.scene, self.view, self.most_change);
            self.transform = Some(new);
        }
        let Some(t) = &self.transform else { return };
        let (items, corners, read) = (&*items, &*corners, &*read);
        let (kept, normals) = (&mut *self.kept, &mut *self.normals);
        // If the latest triangles were settled, these probably are: prepare their normals alone first.
        let (first, settled) = (needs == Needs::Normals && self.settled, &mut self.settled);
        dispatch!(self.level, simd => {
            if first {
                *settled = prepare_normals(simd, t, mesh, (items, read), normals);
            }
            if !(first && *settled) {
                prepare(simd, t, mesh, (items, corners, read), kept);
            }
        });
        if needs == Needs::Normals && !first {
            // If some are not settled, more of the following are not, and all would be prepared twice.
            self.settled = true;
            for &item in items {
                let of_item = self.kept[place(item, &self.kept)].normals;
                self.settled &= of_item.settled;
                self.normals[place(item, &self.normals)] = of_item;
            }
        }
    }
}

/// Returns the largest change of edge functions from one pixel to the next with which a triangle is settled, where
/// samples are up to `reach`/256 pixels from pixels' centres: vertices were rounded to 1/256 pixel before samples were
/// found.
fn most_change(reach: i32) -> f32 {
    LEAST_WEIGHT * SUBPIXELS as f32 / (reach + 1) as f32
}

/// Normals of triangles of one run that have not been requested by item yet.
pub struct RunNormals<'a> {
    mesh: &'a Mesh,
    transform: RunTransform,
}

impl<'a> RunNormals<'a> {
    /// Prepares a run; samples are up to `reach`/256 pixels from pixels' centres.
    pub fn new(scene: &'a Scene, view: &View, runs: &[Run], (index, reach): (usize, i32)) -> Self {
        let (run, most_change) = (&runs[index], most_change(reach));
        let transform = RunTransform::new(index, run, scene, view, most_change);
        Self { mesh: &scene.meshes[run.mesh], transform }
    }

    /// Reads the positions and normals from which a triangle's planes are computed; `corners` are its vertices in the
    /// mesh.
    #[inline(always)]
    pub fn read(&self, lane: usize, corners: [u32; 3], to: &mut Read) {
        to.set(lane, self.mesh, corners);
    }

    /// Returns the planes of eight triangles.
    #[inline(always)]
    pub fn planes<S: Simd>(&self, simd: S, read: &Read) -> NormalPlanes<S> {
        normal_planes(simd, &self.transform, self.mesh, read)
    }
}

/// Returns the direction to the eye if projection lines are parallel, world axes.
pub fn parallel_view(view: &View) -> Option<Vec3> {
    let camera = view.camera();
    match camera.projection {
        Projection::Perspective { .. } => None,
        Projection::Orthographic { .. } => Some(camera.axes()[2].as_vec3()),
    }
}

#[inline(always)]
fn place<T>(item: u32, kept: &[T]) -> usize {
    item as usize & (kept.len() - 1)
}

impl RunTransform {
    fn new(index: usize, run: &Run, scene: &Scene, view: &View, most_change: f32) -> Self {
        let world_from_mesh = scene.instances[run.instance].world_from_mesh;
        let eye_from_world = DMat4::from_translation(-view.camera().eye);
        let linear = DMat3::from_mat4(world_from_mesh);
        let determinant = linear.determinant();
        // The cofactor matrix transforms normals even if the inverse does not exist.
        let cofactors = DMat3::from_cols(
            linear.y_axis.cross(linear.z_axis),
            linear.z_axis.cross(linear.x_axis),
            linear.x_axis.cross(linear.y_axis),
        );
        let sign = if determinant < 0.0 { -1.0 } else { 1.0 };
        let largest = cofactors.to_cols_array().into_iter().fold(0.0, |m: f64, v| m.max(v.abs()));
        let scale = if largest > 0.0 { sign / largest } else { 1.0 };
        Self {
            run: index,
            screen_from_mesh: view.screen_from_world() * world_from_mesh,
            eye_from_mesh: eye_from_world * world_from_mesh,
            normal_from_mesh: (cofactors * scale).as_mat3(),
            handedness: sign,
            least_w: match view.camera().projection {
                Projection::Perspective { .. } => view.camera().near,
                Projection::Orthographic { .. } => 1.0,
            },
            most_change,
        }
    }
}
