//! From a scene to triangles on the screen, the input of every image-space algorithm.
//!
//! Vertices are taken to homogeneous screen space in f64, triangles are cut at the near plane and at
//! the guard band only (the rasterizer does the rest), and snapped to the 24.8 grid. All algorithms
//! take their triangles and depths from here, so their pictures agree bit for bit.
//!
//! Source: near-plane-only clipping after Blinn & Newell, *Clipping using homogeneous coordinates*
//! (1978); the guard band as in graphics hardware. Cost: O(vertices + triangles).

mod corner;
mod eight;
mod part;
mod rules;
mod runs;
mod sampled;
mod triangle;
mod vertex;

pub(crate) use corner::EIGHT;
pub(crate) use runs::runs;
pub(crate) use runs::{Coverage, Run};
pub(crate) use sampled::{PIXELS, Sampled, place_in_box};
pub use triangle::ScreenTriangle;
pub(crate) use vertex::ScreenVertex;

use crate::clip::volume::{ClipVertex, clip_polygon, clip_segment};
use crate::math::{DVec2, Vec3};
use crate::scene::{Mesh, Scene, Topology};
use crate::simd::{Level, dispatch};
use crate::trace::NoTrace;
use crate::view::View;
use crate::visibility::surface::{Cull, Marks};
use eight::Eight;
use fearless_simd::prelude::*;
use fearless_simd::{Simd, u32x16};
use fearless_simd_macros::simd;
use part::Part;
use rules::Rules;
use std::ops::Range;
use vertex::{Behind, Transform};

/// Numbers of triangles by outcome.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct TriangleCounts {
    /// Triangles with a vertex that is not finite.
    pub non_finite: u64,
    /// Cut by the near plane or the guard band.
    pub clipped: u64,
    /// Outside, turned away, without area or without a sample.
    pub culled: u64,
    /// Handed on.
    pub drawn: u64,
}

impl TriangleCounts {
    /// Adds the triangles, of up to eight, that are present and need no clipping.
    #[inline(always)]
    fn add(&mut self, eight: &Eight, there: u64) {
        let number = |of: u64| u64::from((of & there).count_ones());
        self.non_finite += number(eight.non_finite);
        self.drawn += number(eight.seen);
        self.culled += number(!(eight.non_finite | eight.seen | eight.uncut));
    }
}

impl std::ops::AddAssign for TriangleCounts {
    fn add_assign(&mut self, other: Self) {
        self.non_finite += other.non_finite;
        self.clipped += other.clipped;
        self.culled += other.culled;
        self.drawn += other.drawn;
    }
}

/// Filter for the triangles of a scene, and the size of lines and points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TriangleFilter {
    /// Treatment of faces seen from behind.
    pub cull: Cull,
    /// Largest distance of samples from the pixel's centre, in 1/256 pixel: triangles that cannot
    /// reach a sample are left out.
    pub sample_reach: i32,
    /// The size of lines and points.
    pub marks: Marks,
}

impl TriangleFilter {
    /// Creates a filter with lines and points of the usual size.
    pub const fn new(cull: Cull, sample_reach: i32) -> Self {
        Self { cull, sample_reach, marks: Marks::USUAL }
    }
}

/// Receiver of triangles as they come.
pub(crate) trait Sink {
    /// Takes one triangle.
    fn take(&mut self, triangle: ScreenTriangle);

    /// Returns the samples, as offsets from pixels' centres in 1/256 pixel, at which small triangles are sampled at
    /// once and go to [`Self::take_sampled`]; none if they are not.
    fn takes_sampled(&self) -> &'static [[i32; 2]] {
        &[]
    }

    /// Takes the covered samples of the triangles, of eight, whose bits are set in `which`. `primitive` returns a
    /// triangle's item and its vertices in the mesh.
    fn take_sampled<S: Simd>(
        &mut self,
        _simd: S,
        _sampled: &Sampled,
        _which: u64,
        _primitive: impl Fn(usize) -> (u32, [u32; 3]),
    ) {
    }
}

impl Sink for Vec<ScreenTriangle> {
    #[inline(always)]
    fn take(&mut self, triangle: ScreenTriangle) {
        self.push(triangle);
    }
}

/// Triangles without indices whose vertices are transformed at a time.
const UNINDEXED: u32 = 512;

/// Assembler that transforms, clips and sets up the triangles of runs.
pub(crate) struct Assembler<'a> {
    scene: &'a Scene,
    view: &'a View,
    filter: TriangleFilter,
    level: Level,
    vertices: Vec<ScreenVertex>,
    /// Counts so far.
    pub counts: TriangleCounts,
}

impl<'a> Assembler<'a> {
    /// Creates an assembler for the scene, which has passed [`Scene::check`].
    pub fn new(scene: &'a Scene, view: &'a View, filter: TriangleFilter, level: Level) -> Self {
        Self { scene, view, filter, level, vertices: Vec::new(), counts: TriangleCounts::default() }
    }

    /// Returns the assembler with memory for vertices that was used before, and that [`Self::into_memory`] returns.
    pub fn with_memory(self, vertices: Vec<ScreenVertex>) -> Self {
        Self { vertices, ..self }
    }

    /// Returns the memory for vertices.
    pub fn into_memory(self) -> Vec<ScreenVertex> {
        self.vertices
    }

    /// Passes the screen triangles of primitives `range` of a run to `sink`, in order. Lines become strips and points
    /// squares, of the size of [`TriangleFilter::marks`].
    pub fn primitives(&mut self, run: &Run, range: Range<u32>, sink: &mut impl Sink) {
        let mesh = &self.scene.meshes[run.mesh];
        let world_from_mesh = self.scene.instances[run.instance].world_from_mesh;
        let transform = Transform {
            clip_from_mesh: self.view.clip_from_world() * world_from_mesh,
            screen_from_mesh: self.view.screen_from_world() * world_from_mesh,
            width: f64::from(self.view.width()),
            height: f64::from(self.view.height()),
            mirrored: glam::DMat3::from_mat4(world_from_mesh).determinant() < 0.0,
            cull_back: match self.filter.cull {
                Cull::None => false,
                Cull::Back => true,
                Cull::Material => run.single_sided,
            },
        };
        match mesh.topology {
            Topology::Triangles => self.triangles(mesh, &transform, run, range, sink),
            Topology::Lines | Topology::Points => {
                for primitive in range {
                    let item = run.first_item + (primitive - run.range.start);
                    let ends = mesh.line_or_point(primitive as usize);
                    let ends = ends.map(|c| transform.clip_vertex(mesh.positions[c as usize]));
                    self.strip(&transform, ends, item, sink);
                }
            }
        }
    }

    fn triangles(
        &mut self,
        mesh: &Mesh,
        transform: &Transform,
        run: &Run,
        range: Range<u32>,
        sink: &mut impl Sink,
    ) {
        let mut vertices = std::mem::take(&mut self.vertices);
        // Without indices, triangles share no vertices; parts of a few triangles stay in the cache.
        let most = if mesh.indices.is_none() { UNINDEXED } else { u32::MAX };
        let mut start = range.start;
        while start < range.end {
            let part = start..range.end.min(start.saturating_add(most));
            start = part.end;
            let first = self.transform_vertices(mesh, transform, &part, &mut vertices);
            let corners = 3 * part.start as usize..3 * part.end as usize;
            let indices = first.zip(mesh.indices.as_ref());
            let shared = indices.map(|(first, all)| (first, all[corners].as_chunks().0));
            let first_item = run.first_item + (part.start - run.range.start);
            let part =
                Part { mesh, transform, triangles: part, first_item, vertices: &vertices, shared };
            dispatch!(self.level, simd => assemble(simd, self, &part, sink));
        }
        self.vertices = vertices;
    }

    /// Transforms the vertices of a range of triangles: all between the smallest and the largest
    /// index, if that is not many more than are used, and then gives the smallest; else three for
    /// each triangle.
    fn transform_vertices(
        &mut self,
        mesh: &Mesh,
        transform: &Transform,
        range: &Range<u32>,
        vertices: &mut Vec<ScreenVertex>,
    ) -> Option<u32> {
        let corners = 3 * range.start as usize..3 * range.end as usize;
        let Some(indices) = &mesh.indices else {
            transform.vertices(self.level, &mesh.positions[corners], vertices);
            return None;
        };
        let used = &indices[corners];
        let (min, max) = dispatch!(self.level, simd => least_and_largest(simd, used));
        if max >= min && ((max - min) as usize) < used.len() {
            let positions = &mesh.positions[min as usize..=max as usize];
            transform.vertices(self.level, positions, vertices);
            return Some(min);
        }
        let gathered: Vec<Vec3> = used.iter().map(|&i| mesh.positions[i as usize]).collect();
        transform.vertices(self.level, &gathered, vertices);
        None
    }

    /// Cuts a triangle at the near plane and the guard band and sets up the fan of what remains.
    #[cold]
    fn clip(
        &mut self,
        mesh: &Mesh,
        transform: &Transform,
        corners: [u32; 3],
        item: u32,
        sink: &mut impl Sink,
    ) {
        self.counts.clipped += 1;
        let points = corners.map(|c| transform.clip_vertex(mesh.positions[c as usize]));
        let polygon = clip_polygon(&points, &transform.clip_options(), &mut NoTrace);
        let projected: Vec<ScreenVertex> =
            polygon.iter().map(|v| ScreenVertex::new(transform.to_screen(v))).collect();
        let fan = (2..projected.len()).map(|i| [0, i - 1, i].map(|corner| projected[corner]));
        self.few(fan, item, Some(transform), sink);
    }

    /// Sets up the few triangles that one primitive has become.
    fn few(
        &mut self,
        triangles: impl Iterator<Item = [ScreenVertex; 3]>,
        item: u32,
        transform: Option<&Transform>,
        sink: &mut impl Sink,
    ) {
        let (rules, mut eight) = (self.rules(transform, &[]), Eight::default());
        let mut drawn = 0;
        for corners in triangles {
            let of = corners.each_ref().map(|v| [v; EIGHT]);
            dispatch!(self.level, simd => eight::set_up(simd, &rules, of, &mut eight));
            if eight.seen != 0 {
                drawn = 1;
                sink.take(eight.triangle(0, item));
            }
        }
        self.counts.drawn += drawn;
        self.counts.culled += 1 - drawn;
    }

    /// Returns the rules; marks without sides have no transform here.
    fn rules(&self, transform: Option<&Transform>, sampled: &'static [[i32; 2]]) -> Rules {
        let window = self.view.window();
        let window = [[window.x0(), window.x1()], [window.y0(), window.y1()]];
        let behind = transform.map_or(Behind::Positive, Transform::behind);
        let cull_back = transform.is_some_and(|transform| transform.cull_back);
        Rules { filter: self.filter, window, behind, cull_back, sampled }
    }

    /// Sets up the strip around a line, or the square around a point (whose ends are equal).
    fn strip(
        &mut self,
        transform: &Transform,
        ends: [ClipVertex; 2],
        item: u32,
        sink: &mut impl Sink,
    ) {
        if !ends.iter().all(|v| v.position.is_finite()) {
            self.counts.non_finite += 1;
            return;
        }
        let Some(inside) = clip_segment(ends, &transform.clip_options(), &mut NoTrace) else {
            self.counts.culled += 1;
            return;
        };
        let [(pa, za), (pb, zb)] = inside.map(|v| transform.to_screen(&v));
        let Marks { line_width, point_size } = self.filter.marks;
        let along = (pb - pa).normalize_or_zero();
        let (back, side) = match along == DVec2::ZERO {
            true => (DVec2::X * (0.5 * point_size), DVec2::Y * (0.5 * point_size)),
            false => (DVec2::ZERO, along.perp() * (0.5 * line_width)),
        };
        let corners = [pa - back - side, pa - back + side, pb + back + side, pb + back - side];
        let z = [za, za, zb, zb];
        let v = [0, 1, 2, 3].map(|i| ScreenVertex::new((corners[i], z[i])));
        let halves = [[0, 1, 2], [0, 2, 3]].map(|of: [usize; 3]| of.map(|i| v[i]));
        self.few(halves.into_iter(), item, None, sink);
    }
}

/// Returns the smallest and the largest of some numbers; of an empty slice, `u32::MAX` and 0.
#[simd]
fn least_and_largest<S: Simd>(simd: S, numbers: &[u32]) -> (u32, u32) {
    let (mut low, mut high) = (u32x16::splat(simd, u32::MAX), u32x16::splat(simd, 0));
    let (sixteens, rest) = numbers.as_chunks::<16>();
    for numbers in sixteens {
        let numbers = u32x16::from_slice(simd, numbers);
        (low, high) = (low.min(numbers), high.max(numbers));
    }
    let (low, high): ([u32; 16], [u32; 16]) = (low.into(), high.into());
    let least = low.iter().chain(rest).fold(u32::MAX, |least, &v| least.min(v));
    (least, high.iter().chain(rest).fold(0, |largest, &v| largest.max(v)))
}

/// Sets up triangles eight at a time; triangles that must be clipped are set up one by one.
#[simd]
fn assemble<S: Simd>(
    simd: S,
    assembler: &mut Assembler<'_>,
    part: &Part<'_>,
    sink: &mut impl Sink,
) {
    let rules = assembler.rules(Some(part.transform), sink.takes_sampled());
    let mut eight = Eight::default();
    let count = part.triangles.len();
    for start in (0..count).step_by(EIGHT) {
        eight::set_up(simd, &rules, part.eight(start), &mut eight);
        let there = 0xff >> EIGHT.saturating_sub(count - start);
        let sampled = eight.sampled.which & there;
        let mut left = ((eight.seen & !sampled) | eight.uncut) & there;
        assembler.counts.add(&eight, there);
        if sampled != 0 {
            sink.take_sampled(simd, &eight.sampled, sampled, |lane| part.primitive(start + lane));
        }
        while left != 0 {
            let lane = left.trailing_zeros() as usize;
            left &= left - 1;
            let (item, corners) = part.primitive(start + lane);
            if eight.uncut >> lane & 1 == 0 {
                sink.take(eight.triangle(lane, item));
            } else {
                assembler.clip(part.mesh, part.transform, corners, item, sink);
            }
        }
    }
}
