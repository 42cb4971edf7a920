//! Sections: a scene cut by planes, with caps that close surfaces that were closed before.
//!
//! Each triangle is cut as by Sutherland and Hodgman (*Reentrant polygon clipping*, 1974), with new vertices found
//! per edge of the welded mesh, so neighbours share them. The cuts of one instance are linked to loops, and
//! the loops triangulated with all their vertices: a closed mesh stays closed. A vertex on the plane counts
//! as cut away, so a face in the plane is replaced by a cap, or vanishes with the body behind it.
//!
//! Cost: O(n) for n triangles, O(c²) at worst for c new edges of a cap. Limits: bodies that penetrate each other are
//! capped separately.

mod cap;
mod cut;

use super::cull::triangle_area;
use crate::info::{Class, Info, Occluder};
use crate::math::{DMat4, DVec3, Plane, Vec3, Vec4};
use crate::scene::{Material, Scene, ShadingModel, Topology};
use crate::trace::{NoTrace, PseudocodeLine, Tracer};
use crate::{Error, Result};

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "section",
    title: "Sections with caps",
    authors: "I. E. Sutherland, G. W. Hodgman",
    year: 1974,
    source: "Reentrant polygon clipping, Communications of the ACM 17(1)",
    class: Class::ObjectSpace,
    occluder: Occluder::None,
    coherence: &[],
    cost: "O(n) for n triangles, O(c²) at worst for c new edges of a cap",
    limits: "bodies that intersect are capped separately",
    pseudocode: &[
        "for each plane n · P + d = 0, n inwards:",
        "    h(V) ← n · V + d for each vertex V, 0 if V is on the plane up to rounding",
        "    for each triangle of a mesh:",
        "        no corner has h > 0: it is cut away; all have h > 0: it is kept",
        "        else a vertex at t = h / (h − h′) on each edge from h > 0 to h′ ≤ 0; one triangle or two are kept",
        "        the new edge, turned round, is an edge of the cap",
        "    link these edges to loops; a loop in another one is its hole",
        "    triangulate the loops: the cap",
        "    a walk along the edges does not close: the mesh was open, no cap",
    ],
};

/// Options for cutting a scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// True if closed bodies are closed again.
    pub caps: bool,
    /// Linear RGB of the caps; they are shown unlit, whole in this colour.
    pub cap_color: Vec3,
}

impl Default for Options {
    /// Returns the default: caps, in a strong red that no light changes.
    fn default() -> Self {
        Self { caps: true, cap_color: Vec3::new(0.6, 0.05, 0.03) }
    }
}

/// Step of the cutting.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step {
    /// The next plane cuts, world space.
    Plane(Plane),
    /// A triangle was compared with the plane.
    Triangle {
        /// The instance.
        instance: usize,
        /// Its triangle, numbered as before this plane.
        triangle: usize,
        /// For each corner, whether it is inside the plane.
        inside: [bool; 3],
    },
    /// A new edge on the plane, world space.
    Edge([DVec3; 2]),
    /// A triangle of a cap, world space.
    Cap([DVec3; 3]),
    /// The edges of an instance do not close: it gets no cap.
    Open {
        /// The instance.
        instance: usize,
    },
}

impl PseudocodeLine for Step {
    fn line(&self) -> usize {
        match self {
            Self::Plane(_) => 1,
            Self::Triangle { inside: [a, b, c], .. } if a == b && b == c => 4,
            Self::Triangle { .. } => 5,
            Self::Edge(_) => 6,
            Self::Cap(_) => 8,
            Self::Open { .. } => 9,
        }
    }
}

/// Returns the outline and the area of the caps that a list of steps leads to.
pub fn replay(steps: &[Step]) -> (Vec<[DVec3; 2]>, f64) {
    let mut outline: Vec<[DVec3; 2]> = Vec::new();
    let mut area = 0.0;
    for step in steps {
        match step {
            Step::Plane(plane) => {
                outline = outline.iter().filter_map(|s| inside(*s, plane)).collect();
            }
            Step::Edge(edge) => outline.push(*edge),
            Step::Cap(corners) => area += triangle_area(*corners).length(),
            Step::Triangle { .. } | Step::Open { .. } => {}
        }
    }
    (outline, area)
}

/// A scene after the cut.
#[derive(Debug, Clone, PartialEq)]
pub struct Section {
    /// Scene that remains, each instance with its own mesh; caps are the last part of each.
    pub scene: Scene,
    /// The material of the caps: index into [`Scene::materials`] of the new scene.
    pub cap_material: usize,
    /// The outlines of the cuts, world space, as far as no other plane has taken them away.
    pub outline: Vec<[DVec3; 2]>,
    /// Number of cuts through instances that are not closed, which have no cap.
    pub open_cuts: u64,
    /// Area of all caps, as cut by their own plane, in squared world units.
    pub cap_area: f64,
}

/// Cuts a scene: keeps the part of each instance that is inside all planes (`normal · p + distance > 0`,
/// world space).
///
/// Points and lines of a mesh are left out where their first vertex is. Attributes are interpolated along the edges
/// that are cut; on caps, which have their own material, they are meaningless.
///
/// ```
/// use durer::math::{DMat4, DVec3, Plane, Vec3};
/// use durer::scene::{Instance, Mesh, Scene};
/// use durer::view::section::cut;
///
/// let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
/// let indices = Some(vec![0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3]);
/// let mesh = Mesh { positions, indices, ..Mesh::default() };
/// let instance = Instance { mesh: 0, world_from_mesh: DMat4::IDENTITY, name: String::new() };
/// let scene = Scene { meshes: vec![mesh], instances: vec![instance], ..Scene::default() };
/// // What lies above z = ½ stays, and is closed by a right triangle with sides of ½.
/// let plane = Plane { normal: DVec3::Z, distance: -0.5 };
/// let section = cut(&scene, &[plane], &Default::default())?;
/// assert_eq!(section.cap_area, 0.125);
/// assert_eq!(section.scene.triangle_count(), 4);
/// # Ok::<(), durer::Error>(())
/// ```
///
/// # Errors
/// The errors of [`Scene::check`]; [`Error::Parameter`] for a plane without a direction.
pub fn cut(scene: &Scene, planes: &[Plane], options: &Options) -> Result<Section> {
    cut_traced(scene, planes, options, &mut NoTrace)
}

/// Cuts a scene as [`cut()`] does, with a listener for its steps.
///
/// # Errors
/// As [`cut()`].
pub fn cut_traced(
    scene: &Scene,
    planes: &[Plane],
    options: &Options,
    t: &mut impl Tracer<Step>,
) -> Result<Section> {
    scene.check()?;
    let mut section = Section {
        cap_material: scene.materials.len(),
        scene: scene.clone(),
        outline: Vec::new(),
        open_cuts: 0,
        cap_area: 0.0,
    };
    section.scene.materials.push(Material {
        name: "section".to_owned(),
        model: ShadingModel::Unlit,
        base_color: Vec4::from((options.cap_color, 1.0)),
        ..Material::default()
    });
    let meshes = std::mem::take(&mut section.scene.meshes);
    section.scene.meshes = scene.instances.iter().map(|i| meshes[i.mesh].clone()).collect();
    for (index, instance) in section.scene.instances.iter_mut().enumerate() {
        instance.mesh = index;
    }
    for plane in planes {
        let plane = plane.normalized().filter(|p| p.distance.is_finite()).ok_or_else(|| {
            Error::parameter("section plane", plane.normal, "a finite normal other than zero")
        })?;
        section.cut_by(&plane, options, t);
    }
    Ok(section)
}

impl Section {
    fn cut_by(&mut self, plane: &Plane, options: &Options, t: &mut impl Tracer<Step>) {
        t.step(|| Step::Plane(*plane));
        self.outline = self.outline.iter().filter_map(|s| inside(*s, plane)).collect();
        for index in 0..self.scene.instances.len() {
            let matrix = self.scene.instances[index].world_from_mesh;
            let mesh = &self.scene.meshes[index];
            let local = in_mesh(plane, &matrix);
            if mesh.topology != Topology::Triangles {
                let kept = cut::primitives(mesh, &local);
                self.scene.meshes[index] = kept;
                continue;
            }
            let report = |triangle: u32, inside| {
                let triangle = triangle as usize;
                t.step(|| Step::Triangle { instance: index, triangle, inside });
            };
            let mut cut = cut::triangles(mesh, &local, self.scene.last_digit, report);
            let world = |p: Vec3| matrix.transform_point3(p.as_dvec3());
            for segment in &cut.segments {
                let edge = segment.map(|v| world(cut.mesh.positions[v as usize]));
                t.step(|| Step::Edge(edge));
                self.outline.push(edge);
            }
            if options.caps && !cut.segments.is_empty() {
                match cap::triangles(&cut.mesh.positions, &cut.segments, local.normal) {
                    Some(caps) => {
                        for cap in &caps {
                            let corners = cap.map(|v| world(cut.mesh.positions[v as usize]));
                            t.step(|| Step::Cap(corners));
                            self.cap_area += triangle_area(corners).length();
                        }
                        cut::add_caps(&mut cut.mesh, &caps, local.normal, self.cap_material);
                    }
                    None => {
                        t.step(|| Step::Open { instance: index });
                        self.open_cuts += 1;
                    }
                }
            }
            self.scene.meshes[index] = cut.mesh;
        }
    }
}

/// Returns a plane of the world in the coordinates of a mesh.
fn in_mesh(plane: &Plane, world_from_mesh: &DMat4) -> Plane {
    let row = world_from_mesh.transpose() * plane.normal.extend(plane.distance);
    Plane { normal: row.truncate(), distance: row.w }
}

/// Returns the part of a segment inside a plane.
fn inside([a, b]: [DVec3; 2], plane: &Plane) -> Option<[DVec3; 2]> {
    let (da, db) = (plane.evaluate(a), plane.evaluate(b));
    let meet = || a.lerp(b, da / (da - db));
    match (da > 0.0, db > 0.0) {
        (true, true) => Some([a, b]),
        (true, false) => Some([a, meet()]),
        (false, true) => Some([meet(), b]),
        (false, false) => None,
    }
}
