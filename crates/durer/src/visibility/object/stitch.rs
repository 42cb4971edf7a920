//! Joining of faces that meet up to rounding.
//!
//! A closed surface has no borders. If a mesh has some only because corners of neighbouring faces were rounded
//! differently, because each face is a separate mesh, or because the edge of one face runs along several edges of
//! another (a T-junction), its borders coincide. Here they are joined: first triangles without height are left out,
//! then ends of borders within reach of each other become one vertex, and then borders are divided where ends of others
//! lie on them. Only borders are changed, so walls stay apart however thin they are. After André Guéziec, Gabriel
//! Taubin, Francis Lazarus and Bill Horn, *Cutting and stitching: converting sets of polygons to manifold surfaces*,
//! IEEE Transactions on Visualization and Computer Graphics, 2001; the pairs come from a k-d tree, and no surface is
//! cut. O(n), and O(b log² b) for b borders.

use super::{Edges, Faces};
use crate::math::DVec3;
use crate::view::near::{self, OF_EDGE, Places};

/// Precision of the faces of one instance, world units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Grain {
    /// The tree of nodes that it belongs to: only those of one tree meet.
    pub tree: u32,
    /// The spacing of numbers as large as its largest coordinate.
    pub step: f64,
    /// Value of the last digit of coordinates in its file, 0 if that is not known.
    pub digit: f64,
    /// Its extent.
    pub extent: f64,
    /// Largest distance between borders, if the caller sets one.
    pub given: Option<f64>,
}

/// Triangles lower than this many spacings have no area.
const LOW: f64 = 4.0;

/// Largest number of places, per border, at which borders are divided; beyond it none are divided, because thousands of
/// coincident borders would all divide each other.
const MOST: usize = 8;

impl Grain {
    /// Returns the largest distance between borders.
    fn reach(&self) -> f64 {
        self.given.unwrap_or_else(|| near::reach(self.step, self.digit, self.extent))
    }
}

/// Stitches the faces, and returns their edges. `grains` are those of the instances.
pub(super) fn stitch(faces: &mut Faces, grains: &[Grain]) -> Edges {
    let mut edges = Edges::new(faces, |_| true);
    let low = all_low(faces, &edges, grains);
    edges = without(faces, edges, &low);
    if let Some(borders) = Borders::new(faces, &edges, grains) {
        let moved = faces.renumber(&borders.joined(faces));
        if !moved.is_empty() {
            edges = edges.renewed(faces, &moved);
        }
        let low = borders.low(faces, &edges);
        edges = without(faces, edges, &low);
    }
    divide(faces, edges, grains)
}

/// Divides borders where the ends of others lie on them, if these other borders themselves lie on them too.
pub(super) fn divide(faces: &mut Faces, edges: Edges, grains: &[Grain]) -> Edges {
    let Some(borders) = Borders::new(faces, &edges, grains) else { return edges };
    let outlines = borders.outlines(faces);
    if outlines.is_empty() {
        return edges;
    }
    let items: Vec<u32> = outlines.iter().map(|o| o.0).collect();
    faces.set_outlines(outlines);
    edges.renewed(faces, &items)
}

/// Leaves out triangles.
fn without(faces: &mut Faces, edges: Edges, items: &[u32]) -> Edges {
    if items.is_empty() {
        return edges;
    }
    faces.leave_out(items);
    edges.renewed(faces, items)
}

/// Returns the triangles without height that lie along others; without them, the others meet.
fn all_low(faces: &Faces, edges: &Edges, grains: &[Grain]) -> Vec<u32> {
    let mut found = Vec::new();
    for run in faces.runs() {
        let Some(grain) = grains.get(run.instance) else { continue };
        let low = grain.step * LOW;
        for item in run.items.clone() {
            let Some(t) = faces.triangle(item) else { continue };
            if is_low(t.map(|v| faces.points()[v as usize]), low) && is_along(faces, edges, t) {
                found.push(item);
            }
        }
    }
    found
}

fn is_low([a, b, c]: [DVec3; 3], low: f64) -> bool {
    let longest = longest_squared([a, b, c]);
    (b - a).cross(c - a).length_squared() <= longest * low * low
}

fn longest([a, b, c]: [DVec3; 3]) -> f64 {
    longest_squared([a, b, c]).sqrt()
}

fn longest_squared([a, b, c]: [DVec3; 3]) -> f64 {
    a.distance_squared(b).max(b.distance_squared(c)).max(c.distance_squared(a))
}

/// Returns whether a triangle has neighbours all along, on one side or the other.
fn is_along(faces: &Faces, edges: &Edges, [a, b, c]: [u32; 3]) -> bool {
    let mut sides = [[a, b], [b, c], [c, a]];
    let length =
        |[a, b]: [u32; 2]| faces.points()[a as usize].distance_squared(faces.points()[b as usize]);
    sides.sort_by(|x, y| length(*y).total_cmp(&length(*x)));
    let has_neighbour = |[a, b]: [u32; 2]| edges.at([a.min(b), a.max(b)]).len() > 1;
    has_neighbour(sides[0]) || (has_neighbour(sides[1]) && has_neighbour(sides[2]))
}

/// An edge of one triangle.
struct Border {
    /// The smaller first.
    ends: [u32; 2],
    item: u32,
    /// Index into [`Borders::kinds`].
    kind: u32,
}

/// A vertex at which borders end.
struct End {
    vertex: u32,
    kind: u32,
    /// The length of the longest border at it.
    longest: f64,
}

/// Properties that the borders of one instance share.
#[derive(Clone, Copy)]
struct Kind {
    tree: u32,
    reach: f64,
    /// True if small ones are spared.
    careful: bool,
}

impl Kind {
    fn reach_of(&self, length: f64) -> f64 {
        if self.careful { self.reach.min(length * OF_EDGE) } else { self.reach }
    }
}

/// The edges with only one triangle.
struct Borders {
    all: Vec<Border>,
    /// By vertex.
    ends: Vec<End>,
    places: Places,
    kinds: Vec<Kind>,
}

impl Borders {
    /// Creates the borders that may meet; returns `None` if there are none.
    fn new(faces: &Faces, edges: &Edges, grains: &[Grain]) -> Option<Self> {
        let mut all: Vec<Border> =
            edges.borders().map(|(ends, item)| Border { ends, item, kind: 0 }).collect();
        all.sort_unstable_by_key(|b| b.item);
        let point = |v: u32| faces.points()[v as usize];
        let mut kinds = Vec::new();
        for run in all.chunk_by_mut(|a, b| faces.instance_of(a.item) == faces.instance_of(b.item)) {
            let grain = grains.get(faces.instance_of(run[0].item)?)?;
            let reach = grain.reach();
            run.iter_mut().for_each(|b| b.kind = kinds.len() as u32);
            kinds.push(Kind { tree: grain.tree, reach, careful: grain.given.is_none() });
        }
        let both = all.iter().flat_map(|b| {
            let longest = point(b.ends[0]).distance(point(b.ends[1]));
            b.ends.map(|vertex| End { vertex, kind: b.kind, longest })
        });
        let mut ends: Vec<End> = both.collect();
        ends.sort_unstable_by(|a, b| a.vertex.cmp(&b.vertex).then(b.longest.total_cmp(&a.longest)));
        ends.dedup_by_key(|e| e.vertex);
        let places = Places::new(ends.iter().map(|e| point(e.vertex)));
        (kinds.iter().any(|k| k.reach > 0.0)).then_some(Self { all, ends, places, kinds })
    }

    fn kind(&self, end: &End) -> &Kind {
        &self.kinds[end.kind as usize]
    }

    /// Returns the vertices that become others, with these.
    fn joined(&self, faces: &Faces) -> Vec<(u32, u32)> {
        let reaches: Vec<f64> =
            self.ends.iter().map(|e| self.kind(e).reach_of(e.longest)).collect();
        let points: Vec<DVec3> =
            self.ends.iter().map(|e| faces.points()[e.vertex as usize]).collect();
        let tree = |i: usize| self.kind(&self.ends[i]).tree;
        let joined = self.places.joined(&points, &reaches, |k, i| tree(k) == tree(i));
        joined.into_iter().map(|(k, i)| (self.ends[k].vertex, self.ends[i].vertex)).collect()
    }

    /// Returns the triangles at borders whose height is within a border's reach and that lie along others.
    fn low(&self, faces: &Faces, edges: &Edges) -> Vec<u32> {
        let mut found = Vec::new();
        for border in &self.all {
            let Some(t) = faces.triangle(border.item) else { continue };
            let points = t.map(|v| faces.points()[v as usize]);
            let reach = self.kinds[border.kind as usize].reach_of(longest(points));
            if is_low(points, reach) && is_along(faces, edges, t) {
                found.push(border.item);
            }
        }
        found.dedup();
        found
    }

    /// Returns the outlines of the triangles whose borders are divided, by item.
    fn outlines(&self, faces: &Faces) -> Vec<(u32, Vec<u32>)> {
        let mut divided: Vec<(usize, Vec<u32>)> = Vec::new();
        let mut count = 0;
        for (i, border) in self.all.iter().enumerate() {
            let between = self.between(faces, border);
            count += between.len();
            if count > MOST * self.all.len() {
                return Vec::new();
            }
            if !between.is_empty() {
                divided.push((i, between));
            }
        }
        let met = self.met(&divided);
        let mut met = met.into_iter();
        divided.retain(|_| met.next() == Some(true));
        divided
            .chunk_by(|a, b| self.all[a.0].item == self.all[b.0].item)
            .filter_map(|parts| self.outline(faces, parts))
            .collect()
    }

    /// Returns the ends of others that lie on a border, from its first end to its second.
    fn between(&self, faces: &Faces, border: &Border) -> Vec<u32> {
        let kind = &self.kinds[border.kind as usize];
        let ends = border.ends.map(|v| faces.points()[v as usize]);
        let length = ends[0].distance(ends[1]);
        let reach = kind.reach_of(length);
        let mut found: Vec<(f64, u32)> = Vec::new();
        self.places.along(ends, reach, |f| {
            let end = &self.ends[f.number as usize];
            let inside = f.at * length > reach && (1.0 - f.at) * length > reach;
            let other = !border.ends.contains(&end.vertex);
            if inside && other && self.kind(end).tree == kind.tree {
                found.push((f.at, end.vertex));
            }
        });
        found.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        found.into_iter().map(|f| f.1).collect()
    }

    /// Returns for each divided border whether a part of it is another border, or a part of one.
    fn met(&self, divided: &[(usize, Vec<u32>)]) -> Vec<bool> {
        let mut is_divided = vec![false; self.all.len()];
        let mut parts: Vec<([u32; 2], usize)> = Vec::new();
        for (k, (i, between)) in divided.iter().enumerate() {
            is_divided[*i] = true;
            let [a, b] = self.all[*i].ends;
            let row: Vec<u32> = [&[a], &between[..], &[b]].concat();
            parts.extend(row.windows(2).map(|w| ([w[0].min(w[1]), w[0].max(w[1])], k)));
        }
        let whole = self.all.iter().zip(&is_divided).filter(|(_, divided)| !**divided);
        parts.extend(whole.map(|(b, _)| (b.ends, usize::MAX)));
        parts.sort_unstable();
        let mut met = vec![false; divided.len()];
        for same in parts.chunk_by(|a, b| a.0 == b.0).filter(|same| same.len() > 1) {
            same.iter().filter(|p| p.1 != usize::MAX).for_each(|p| met[p.1] = true);
        }
        met
    }

    /// Returns the outline of one triangle, some of whose sides are divided.
    fn outline(&self, faces: &Faces, parts: &[(usize, Vec<u32>)]) -> Option<(u32, Vec<u32>)> {
        let item = self.all[parts[0].0].item;
        let [a, b, c] = faces.triangle(item)?;
        let mut outline = Vec::new();
        for [a, b] in [[a, b], [b, c], [c, a]] {
            outline.push(a);
            let part = parts.iter().find(|p| self.all[p.0].ends == [a.min(b), a.max(b)]);
            let between = part.map_or(&[][..], |p| &p.1);
            if a < b {
                outline.extend(between);
            } else {
                outline.extend(between.iter().rev());
            }
        }
        Some((item, outline))
    }
}
