//! Wireframe: every edge of every face, hidden or not. Sides of triangles inside a face with more corners are not edges.
//!
//! L. G. Roberts, *Machine Perception of Three-Dimensional Solids*, MIT Lincoln Laboratory TR 315, 1963, drew solids in
//! this way before removing hidden lines. Edges are clipped in homogeneous coordinates at the near and the far plane
//! and drawn as J. Bresenham's lines, lighting exactly those pixels of the whole line that are in the picture; each
//! edge once, though two faces share it. Cost: O(edges · log edges + pixels lit); memory O(edges).
//!
//! Limits: the picture is ambiguous — front and back cannot be distinguished; the other algorithms solve that.
//! Coherence used: none.

use crate::clip::volume::ClipVertex;
use crate::info::{Class, Info, Occluder};
use crate::math::{DMat4, DVec2, DVec4, IVec2};
use crate::raster::line::{self, bresenham, projected};
use crate::scene::{Mesh, Scene, Topology};
use crate::target::Pixels;
use crate::trace::{NoTrace, Tracer};
use crate::view::View;

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "wireframe",
    title: "Wireframe",
    authors: "L. G. Roberts",
    year: 1963,
    source: "Machine Perception of Three-Dimensional Solids, MIT Lincoln Laboratory TR 315",
    class: Class::ImageSpace,
    occluder: Occluder::None,
    coherence: &[],
    cost: "O(edges · log edges + pixels lit) time, O(edges) memory",
    limits: "ambiguous: lines in front and behind look alike",
    pseudocode: &[],
};

/// Options for the look of lines.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Options {
    /// 8-bit sRGB with straight alpha; replaces the stored colour.
    pub color: [u8; 4],
}

impl Default for Options {
    /// Returns black.
    fn default() -> Self {
        Self { color: [0, 0, 0, 255] }
    }
}

/// Step of the algorithm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step {
    /// An edge, clipped by the near and the far plane, is drawn between two pixels, which may be outside the picture.
    Edge {
        /// Index of the instance.
        instance: usize,
        /// Its vertices in the mesh.
        vertices: [u32; 2],
        /// The pixel where it begins.
        from: IVec2,
        /// The pixel where it ends.
        to: IVec2,
    },
}

/// Draws the edges of all faces and all lines of a scene, which has passed [`Scene::check`], over the contents of the
/// plane. Edges with an end that is not finite are left out.
pub fn render(
    scene: &Scene,
    view: &View,
    options: &Options,
    target: &mut Pixels<[u8; 4]>,
    t: &mut impl Tracer<Step>,
) {
    for (instance, placed) in scene.instances.iter().enumerate() {
        let Some(mesh) = scene.meshes.get(placed.mesh) else { continue };
        let clip_from_mesh = view.clip_from_world() * placed.world_from_mesh;
        for vertices in edges(mesh) {
            let Some([from, to]) = pixels_of(mesh, vertices, &clip_from_mesh, view) else {
                continue;
            };
            t.step(|| Step::Edge { instance, vertices, from, to });
            let last = IVec2::new(view.width() as i32 - 1, view.height() as i32 - 1);
            let window = line::Options { window: Some((IVec2::ZERO, last)) };
            let plot = |p: IVec2| target.set(p.x as u32, p.y as u32, options.color);
            bresenham::draw(from, to, &window, plot, &mut NoTrace);
        }
    }
}

/// Returns the edges of a mesh, each once, by their vertices.
fn edges(mesh: &Mesh) -> Vec<[u32; 2]> {
    match mesh.topology {
        Topology::Triangles => edges_of_faces(mesh),
        Topology::Lines => {
            let lines = (0..mesh.primitive_count()).map(|i| mesh.line_or_point(i));
            let mut edges: Vec<[u32; 2]> = lines.collect();
            edges.sort_unstable();
            edges.dedup();
            edges
        }
        Topology::Points => Vec::new(),
    }
}

/// Returns the edges of all faces. A side of two triangles is none if both are parts of one face.
fn edges_of_faces(mesh: &Mesh) -> Vec<[u32; 2]> {
    let mut sides = Vec::with_capacity(3 * mesh.triangle_count());
    for (i, face) in mesh.faces_of_triangles().enumerate() {
        let [a, b, c] = mesh.triangle(i);
        let own = [[a, b], [b, c], [c, a]];
        sides.extend(own.map(|[a, b]| ([a.min(b), a.max(b)], face, i as u32)));
    }
    sides.sort_unstable();
    let of_one_edge = sides.chunk_by(|(a, ..), (b, ..)| a == b);
    let is_inside =
        |own: &[([u32; 2], u32, u32)]| matches!(own, [(_, f, i), (_, g, k)] if f == g && i != k);
    of_one_edge.filter(|own| !is_inside(own)).filter_map(|own| Some(own.first()?.0)).collect()
}

/// Returns the pixels at the ends of an edge between the near and the far plane; `None` if it is outside of the
/// picture.
fn pixels_of(
    mesh: &Mesh,
    vertices: [u32; 2],
    clip_from_mesh: &DMat4,
    view: &View,
) -> Option<[IVec2; 2]> {
    let mut ends = [ClipVertex { position: DVec4::ZERO, attributes: () }; 2];
    for (end, vertex) in ends.iter_mut().zip(vertices) {
        let p = mesh.positions.get(vertex as usize)?.as_dvec3();
        end.position = *clip_from_mesh * p.extend(1.0);
    }
    let size = DVec2::new(f64::from(view.width()), f64::from(view.height()));
    let cut = projected::cut(ends, view.width().max(view.height()))?;
    Some(cut.map(|v| {
        let ndc = DVec2::new(v.position.x, -v.position.y) / v.position.w;
        projected::pixel((ndc + 1.0) * 0.5 * size, size)
    }))
}
