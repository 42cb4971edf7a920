//! The choice of edges that become lines: silhouettes, creases, borders and similar ones.

use super::facing::{Facing, Pair};
use super::smooth_silhouette::Whole;
use super::steps::Steps;
use super::tangent::Tangents;
use crate::target::drawing::LineClass;
use crate::visibility::object::{Bodies, EdgeSide, Edges, Faces};

/// A set of classes of lines.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ClassSet(u32);

impl ClassSet {
    /// None.
    pub const NONE: Self = Self(0);

    /// Returns the set with these classes.
    pub fn of(classes: &[LineClass]) -> Self {
        classes.iter().fold(Self::NONE, |set, class| set.with(*class))
    }

    /// Returns the set with one more.
    pub const fn with(self, class: LineClass) -> Self {
        Self(self.0 | 1 << class as u32)
    }

    /// Returns the set with one less.
    pub const fn without(self, class: LineClass) -> Self {
        Self(self.0 & !(1 << class as u32))
    }

    /// Returns whether a class is in the set.
    pub const fn contains(self, class: LineClass) -> bool {
        self.0 >> (class as u32) & 1 == 1
    }
}

impl Default for ClassSet {
    /// Returns the classes of a technical drawing: all that an edge can be except
    /// [`LineClass::Wire`], and the lines and points of the model.
    fn default() -> Self {
        Self::NONE
            .with(LineClass::Silhouette)
            .with(LineClass::Crease)
            .with(LineClass::Border)
            .with(LineClass::NonManifold)
            .with(LineClass::Material)
            .with(LineClass::Intersection)
            .with(LineClass::Section)
            .with(LineClass::Mark)
    }
}

/// Pairs of faces that are searched for intersections.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Intersections {
    /// Intersections of different bodies: a body modelled in one piece is assumed not to intersect itself.
    #[default]
    BetweenBodies,
    /// Everywhere.
    All,
}

/// No triangle.
pub(super) const NO_ITEM: u32 = u32::MAX;

/// An edge that is a line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct EdgeLine {
    pub ends: [u32; 2],
    pub class: LineClass,
    /// Two of the triangles at it; [`NO_ITEM`] if there are fewer.
    pub items: [u32; 2],
    /// True if the surface is not sharp there.
    pub smooth: bool,
    pub sharpness: Sharpness,
    pub outside: Outside,
}

/// Side from which a surface can be seen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Outside {
    /// The fronts of its triangles: it bounds a volume, with the fronts outside.
    Front,
    /// The backs of its triangles: it bounds a volume, with the backs outside.
    Back,
    /// Both sides: it bounds no volume.
    Both,
}

/// Angle between the faces at an edge.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Sharpness {
    /// Hardly.
    Blunt,
    /// Enough to continue a crease that began elsewhere.
    Weak,
    /// Enough for a crease.
    Sharp,
}

/// Rules that decide which edges are lines.
pub(super) struct Rules<'a> {
    pub faces: &'a Faces,
    pub edges: &'a Edges,
    pub facing: &'a Facing,
    pub bodies: &'a Bodies,
    /// Materials by item, if there are several.
    pub materials: Option<Vec<u32>>,
    /// Material as in `materials`; its faces are the caps of a section.
    pub cap: Option<u32>,
    pub classes: ClassSet,
    /// Tangent edges, if requested, and the surfaces that triangles are parts of.
    pub tangents: Option<&'a Tangents>,
    /// Knowledge about edges besides their turn, if there is any.
    pub steps: Option<&'a Steps>,
    pub whole: Whole<'a>,
    /// Cosine of the crease angle.
    pub crease: f32,
    /// Cosine of the angle down to which a crease continues; at least `crease`.
    pub crease_end: f32,
}

/// Returns the material of each item; `None` if all have the same.
pub(super) fn materials(faces: &Faces) -> Option<Vec<u32>> {
    let runs = faces.runs();
    runs.iter().any(|r| r.material != runs[0].material).then(|| {
        runs.iter()
            .flat_map(|r| r.items.clone().map(move |_| material_number(r.material)))
            .collect()
    })
}

/// Returns a material among [`materials`].
pub(super) fn material_number(material: Option<usize>) -> u32 {
    material.map_or(0, |m| m as u32 + 1)
}

impl Rules<'_> {
    /// Returns the lines among the edges whose smaller vertex lies in a range, in the order of the
    /// edges. Weak creases are among them, whether or not they go on from others.
    pub fn lines(&self, vertices: std::ops::Range<u32>) -> Vec<EdgeLine> {
        let mut lines = Vec::new();
        for (ends, sides) in self.edges.of_vertices(vertices) {
            if let (Some(class), sharpness) = self.class(ends, sides) {
                let item = |i: usize| sides.get(i).map_or(NO_ITEM, |s: &EdgeSide| s.item());
                let items = [item(0), item(1)];
                let smooth = class == LineClass::Silhouette && sharpness != Sharpness::Sharp;
                let outside = if smooth { self.outside(items[0]) } else { Outside::Both };
                lines.push(EdgeLine { ends, class, items, smooth, sharpness, outside });
            }
        }
        lines
    }

    fn outside(&self, item: u32) -> Outside {
        let body = self.bodies.of(item).and_then(|b| self.bodies.all().get(b as usize));
        match body {
            Some(body) if body.closed && self.bodies.turned(item) => Outside::Back,
            Some(body) if body.closed => Outside::Front,
            _ => Outside::Both,
        }
    }

    fn wanted(&self, class: LineClass) -> Option<LineClass> {
        self.classes.contains(class).then_some(class)
    }

    /// Returns the class of an edge that has no other.
    pub fn wire(&self) -> Option<LineClass> {
        self.wanted(LineClass::Wire)
    }

    /// Returns the first requested class that an edge belongs to.
    fn class(&self, ends: [u32; 2], sides: &[EdgeSide]) -> (Option<LineClass>, Sharpness) {
        let blunt = |class: Option<LineClass>| (class, Sharpness::Blunt);
        if self.ends_a_cap(sides)
            && let Some(section) = self.wanted(LineClass::Section)
        {
            return blunt(Some(section));
        }
        match sides {
            [_] => blunt(self.wanted(LineClass::Border).or_else(|| self.wire())),
            [a, b] => {
                let against = (a.forward() == b.forward())
                    ^ self.bodies.turned(a.item())
                    ^ self.bodies.turned(b.item());
                let pair = Pair { ends, items: [a.item(), b.item()], against };
                if self.faces.same_polygon(a.item(), b.item()) {
                    // A polygon that is not flat has its outline between its triangles.
                    let outline = self.differ(pair);
                    let silhouette = outline.then_some(LineClass::Silhouette);
                    return blunt(silhouette.and_then(|c| self.wanted(c)));
                }
                self.class_of_two(pair)
            }
            _ => blunt(self.wanted(LineClass::NonManifold).or_else(|| self.wire())),
        }
    }

    /// Returns the same between two triangles of one surface.
    fn class_of_two(&self, pair: Pair) -> (Option<LineClass>, Sharpness) {
        let (turns, sharpness) = self.turn(pair);
        let sharpness = self.known(pair, sharpness);
        let outline = turns.then_some(LineClass::Silhouette).and_then(|c| self.wanted(c));
        let crease =
            |least| (sharpness == least).then_some(LineClass::Crease).and_then(|c| self.wanted(c));
        let [a, b] = pair.items;
        let differ = |m: &Vec<u32>| m[a as usize] != m[b as usize];
        let border = || {
            let differs = self.materials.as_ref().is_some_and(differ);
            differs.then_some(LineClass::Material).and_then(|c| self.wanted(c))
        };
        let class = outline
            .or_else(|| crease(Sharpness::Sharp))
            .or_else(border)
            .or_else(|| crease(Sharpness::Weak))
            .or_else(|| self.is_tangent(pair).then_some(LineClass::Tangent))
            .or_else(|| self.wire());
        (class, sharpness)
    }

    fn is_tangent(&self, pair: Pair) -> bool {
        let Some(tangents) = self.tangents else { return false };
        self.edge_of_whole(pair).is_some_and(|ends| tangents.contains(ends))
    }

    /// Returns the edge between the triangles that a pair are parts of, the smaller vertex first, if it
    /// is one.
    fn edge_of_whole(&self, pair: Pair) -> Option<[u32; 2]> {
        let [a, b] = pair.items.map(|item| self.whole.triangle(self.faces, item));
        let (a, b) = a.zip(b)?;
        let mut common = a.into_iter().filter(|v| b.contains(v));
        let (p, q) = common.next().zip(common.next())?;
        common.next().is_none().then_some([p.min(q), p.max(q)])
    }

    /// Returns the sharpness of an edge by its surroundings, if they decide more than its turn
    /// does.
    fn known(&self, pair: Pair, sharpness: Sharpness) -> Sharpness {
        let Some(steps) = self.steps else { return sharpness };
        if !steps.may_know(pair.items.map(|item| self.whole.item(item))) {
            return sharpness;
        }
        match self.edge_of_whole(pair).and_then(|ends| steps.is_crease(ends)) {
            Some(true) => Sharpness::Sharp,
            Some(false) => Sharpness::Blunt,
            None => sharpness,
        }
    }

    /// Returns whether some of the triangles are of a cap and some are not.
    fn ends_a_cap(&self, sides: &[EdgeSide]) -> bool {
        let (Some(cap), Some(materials)) = (self.cap, &self.materials) else { return false };
        let mut caps = sides.iter().map(|s| materials[s.item() as usize] == cap);
        let first = caps.next();
        caps.any(|c| Some(c) != first)
    }

    /// Returns whether two triangles show different sides, and how sharp the edge is.
    fn turn(&self, pair: Pair) -> (bool, Sharpness) {
        let differ = self.differ(pair);
        let pair = self.stand_ins(pair);
        if pair.items[0] == pair.items[1] {
            return (differ, Sharpness::Blunt);
        }
        let cosine = self.facing.angle_cosine(&pair);
        let sharpness = if cosine < self.crease {
            Sharpness::Sharp
        } else if cosine < self.crease_end {
            Sharpness::Weak
        } else {
            Sharpness::Blunt
        };
        (differ, sharpness)
    }

    /// Returns whether two triangles show different sides. Of a smooth surface that is known even where a
    /// triangle is too thin to tell.
    fn differ(&self, pair: Pair) -> bool {
        if pair.items.iter().all(|item| self.facing.is_smooth(*item)) {
            return self.facing.differ(&pair);
        }
        let pair = self.stand_ins(pair);
        pair.items[0] != pair.items[1] && self.facing.differ(&pair)
    }

    fn stand_ins(&self, pair: Pair) -> Pair {
        Pair { items: pair.items.map(|item| self.stand_in(pair.ends, item)), ..pair }
    }

    /// Returns the triangle itself, or for one that is too thin to be turned any way, the neighbour
    /// across its longest other edge, if there is one and no more.
    fn stand_in(&self, ends: [u32; 2], item: u32) -> u32 {
        let (mut item, mut ends) = (item, ends);
        // Several thin ones may lie beside each other; more than these are not worth the walk.
        for _ in 0..4 {
            if !self.facing.thin(item) {
                return item;
            }
            let Some([a, b, c]) = self.faces.triangle(item) else { return item };
            let length = |[a, b]: [u32; 2]| {
                (self.faces.points()[a as usize] - self.faces.points()[b as usize]).length_squared()
            };
            let others = [[a, b], [b, c], [c, a]].map(|[a, b]| [a.min(b), a.max(b)]);
            let longest = others
                .into_iter()
                .filter(|e| *e != ends)
                .max_by(|x, y| length(*x).total_cmp(&length(*y)));
            let Some(edge) = longest else { return item };
            // With three or more, the first would depend on the order of the triangles.
            let [a, b] = self.edges.at(edge) else { return item };
            (item, ends) = (if a.item() == item { b.item() } else { a.item() }, edge);
        }
        item
    }
}
