//! The lines of a scene before their visibility is known: edges of the mesh, lines where faces meet, and the lines and
//! points of the model.

use super::super::crease_chain::connected;
use super::super::edge_lines::{
    EdgeLine, Intersections, NO_ITEM, Outside, Rules, material_number, materials,
};
use super::super::facing::Facing;
use super::super::intersection::{Meeting, intersections};
use super::super::marks::marks;
use super::super::page::{Projected, Vertex};
use super::super::piece::Piece;
use super::super::smooth_silhouette::Whole;
use super::super::steps::Steps;
use super::super::tangent::Tangents;
use super::Options;
use crate::parallel;
use crate::target::drawing::LineClass;
use crate::visibility::object::{Bodies, Edges, Faces};
use std::ops::Range;

/// Knowledge about faces and edges besides their looks.
#[derive(Clone, Copy)]
pub(super) struct Known<'a> {
    pub whole: Whole<'a>,
    pub tangents: Option<&'a Tangents>,
    pub steps: Option<&'a Steps>,
}

/// All lines, before it is known what of them can be seen. Edges are a third of the size of
/// [`FeatureLine`], and there may be more of them than faces.
pub(super) struct Lines<'a> {
    faces: &'a Faces,
    pub whole: Whole<'a>,
    projected: &'a Projected,
    edges: Vec<EdgeLine>,
    /// Intersections of faces, and the lines and points of the model.
    loose: Vec<FeatureLine>,
    /// Edges of three triangles or more, with each of these; sorted.
    crowded: Vec<([u32; 2], u32)>,
}

impl<'a> Lines<'a> {
    pub fn new(
        faces: &'a Faces,
        bodies: &Bodies,
        edges: Edges,
        facing: &Facing,
        options: &Options,
        (projected, known): (&'a Projected, Known<'a>),
    ) -> Self {
        let Known { whole, tangents, steps } = known;
        let rules = Rules {
            faces,
            edges: &edges,
            facing,
            bodies,
            materials: materials(faces),
            cap: options.cap_material.map(|m| material_number(Some(m))),
            classes: options.classes,
            tangents,
            steps,
            whole,
            crease: libm::cos(options.crease) as f32,
            crease_end: libm::cos(options.crease_end.min(options.crease)) as f32,
        };
        let of_edges = connected(edge_lines(&rules), faces.points(), rules.wire());
        drop(rules);
        let crowded = crowded(&of_edges, &edges);
        drop(edges);
        let mut loose = if options.classes.contains(LineClass::Intersection) {
            meeting_lines(faces, bodies, options.intersections, projected)
        } else {
            Vec::new()
        };
        if options.classes.contains(LineClass::Mark) {
            let line = |ends| FeatureLine::new(ends, LineClass::Mark, [NO_ITEM; 2]);
            loose.extend(marks(faces, projected).filter_map(line));
        }
        // The eye may be inside the cut body.
        let whole = if projected.any_cut() { Whole(None) } else { whole };
        Self { faces, whole, projected, edges: of_edges, loose, crowded }
    }

    /// Returns whether a triangle has the edge of a line: it does not hide that line.
    pub fn is_at(&self, line: &FeatureLine, item: u32) -> bool {
        line.items.contains(&item)
            || (!self.crowded.is_empty() && self.crowded.binary_search(&(line.edge, item)).is_ok())
    }

    /// Returns the number of lines, including those that are points in the picture.
    pub fn len(&self) -> usize {
        self.edges.len() + self.loose.len()
    }

    /// Returns a smooth outline: where along it the surface hides it, and what does not. Which side of an
    /// open surface is its front is arbitrary, so there nothing is known where it bends the other way.
    fn smooth(&self, of: &EdgeLine, line: FeatureLine, turned: bool) -> FeatureLine {
        let mut ends = of.ends;
        if turned {
            ends.reverse();
        }
        let bends = ends.map(|v| self.whole.bend(v));
        let sign = if of.outside == Outside::Back { -1.0 } else { 1.0 };
        let [a, b] = bends.map(|bend| f64::from(bend.radial) * sign);
        let fold = match (a < 0.0, b < 0.0) {
            _ if of.outside == Outside::Both => [0.0; 2],
            (true, true) => [0.0, 1.0],
            (true, false) => [0.0, a / (a - b)],
            (false, true) => [a / (a - b), 1.0],
            (false, false) => [0.0; 2],
        };
        let closed = of.outside != Outside::Both;
        let reach = if closed && a + b < 0.0 { 0.0 } else { bends[0].reach.max(bends[1].reach) };
        let reach = f64::from(reach) / self.projected.page.step;
        FeatureLine { smooth: true, fold, reach, ..line }
    }

    /// Returns those of a range that have an extent in the picture.
    pub fn some(&self, range: Range<usize>) -> impl Iterator<Item = FeatureLine> + Clone {
        let split = self.edges.len();
        let edges = &self.edges[range.start.min(split)..range.end.min(split)];
        let loose = &self.loose[range.start.max(split) - split..range.end.max(split) - split];
        let line = |l: &EdgeLine| {
            let ends = self.projected.edge(self.faces, l.ends)?;
            let line = FeatureLine { edge: l.ends, ..FeatureLine::new(ends, l.class, l.items)? };
            if !l.smooth {
                let is_smooth = |item: &u32| self.whole.is_smooth(*item);
                let any = l.items.iter().any(is_smooth);
                let vertices = if any { l.ends } else { line.vertices };
                return Some(FeatureLine { vertices, ..line });
            }
            let turned = line.ends[0].at != ends[0].at;
            Some(self.smooth(l, line, turned))
        };
        edges.iter().filter_map(line).chain(loose.iter().copied())
    }
}

/// A line before it is known what of it can be seen.
#[derive(Clone, Copy)]
pub(super) struct FeatureLine {
    pub ends: [Vertex; 2],
    pub class: LineClass,
    /// Two of the faces that it lies on.
    pub items: [u32; 2],
    /// The vertices of the edge that it is, the smaller first; [`NO_ITEM`] if it is none.
    pub edge: [u32; 2],
    /// See [`Step::Line`].
    pub smooth: bool,
    /// See [`Step::Line`].
    pub fold: [f64; 2],
    /// Largest distance in front of it of a face of its own body that does not hide it, in steps.
    pub reach: f64,
    /// Its vertices, if it is a sharp outline of smooth faces: those around these lie folded over each other, and
    /// none hides it.
    pub vertices: [u32; 2],
}

impl FeatureLine {
    /// Creates a line of a class; returns `None` if it is a point in the picture.
    pub fn new(mut ends: [Vertex; 2], class: LineClass, items: [u32; 2]) -> Option<Self> {
        // One way round whatever the faces' order, so that cuts are rounded alike.
        ends.sort_unstable_by_key(|v| v.at);
        let line = Self {
            ends,
            class,
            items,
            edge: [NO_ITEM; 2],
            smooth: false,
            fold: [0.0; 2],
            reach: 0.0,
            vertices: [NO_ITEM; 2],
        };
        (ends[0].at != ends[1].at).then_some(line)
    }

    pub fn piece(&self) -> Piece {
        let Self { ends, class, smooth, .. } = *self;
        Piece { ends: ends.map(|v| v.at), class, invisibility: 0, smooth }
    }
}

/// Returns lines among the edges of the mesh.
fn edge_lines(rules: &Rules<'_>) -> Vec<EdgeLine> {
    let count = rules.faces.points().len() as u32;
    let jobs: Vec<_> = (0..count).step_by(1 << 15).map(|v| v..(v + (1 << 15)).min(count)).collect();
    joined(parallel::map(jobs, |vertices| rules.lines(vertices)))
}

/// Returns the edges of three triangles or more among the lines, with each of these, sorted. None of the triangles
/// at an edge hides it, though what is cut at the window is snapped anew and may not lie on the edge.
fn crowded(lines: &[EdgeLine], edges: &Edges) -> Vec<([u32; 2], u32)> {
    let may_be =
        |c: LineClass| matches!(c, LineClass::NonManifold | LineClass::Section | LineClass::Wire);
    let mut found = Vec::new();
    for line in lines.iter().filter(|line| may_be(line.class)) {
        let sides = edges.at(line.ends);
        if sides.len() > 2 {
            found.extend(sides.iter().map(|side| (line.ends, side.item())));
        }
    }
    found.sort_unstable();
    found
}

/// Returns lines where faces penetrate each other.
fn meeting_lines(
    faces: &Faces,
    bodies: &Bodies,
    which: Intersections,
    projected: &Projected,
) -> Vec<FeatureLine> {
    let line =
        |m: Meeting| FeatureLine::new(projected.segment(m.ends)?, LineClass::Intersection, m.items);
    intersections(faces, bodies, which).into_iter().filter_map(line).collect()
}

/// Returns all parts in one list of just their size.
pub(super) fn joined<T>(parts: Vec<Vec<T>>) -> Vec<T> {
    let mut all = Vec::with_capacity(parts.iter().map(Vec::len).sum());
    parts.into_iter().for_each(|part| all.extend(part));
    all
}
