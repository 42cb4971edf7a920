//! Sutherland–Hodgman polygon clipping, as re-entrant stages.
//!
//! Ivan Sutherland and Gary Hodgman, "Reentrant polygon clipping", Communications of the ACM 17(1),
//! 1974. Object space; O(n·m) for n vertices and m borders. One stage per border takes the vertices one by one and
//!       passes on those of the part inside; stages are chained, so no ring is stored between them and the memory per
//!       stage is two vertices.
//!
//! **Bridging edges.** The result is one ring even where the part inside falls into several: the
//! parts stay joined by edges that run to and fro along the border. Its area and every area integral
//! are right and so is a fill; a stroke shows the bridges. [`super::rectangle`] and
//! the overlay give separate rings.
//!
//! The side of a border that a vertex is on is decided exactly. Cuts are computed from the
//! lexicographically smaller end of an edge, so polygons that share an edge share its cuts.

pub mod by_borders;

use super::group::is_flat;
use super::{Shapes, signed_area};
use crate::clip::line::border::Canonical;
use crate::clip::line::convex::{self, HalfSpace};
use crate::clip::line::{ClipBox, ConvexPolygon, HalfPlane};
use crate::info::{Class, Info, Occluder};
use crate::math::{DVec2, DVec3, Plane, Rect};
use crate::trace::{PseudocodeLine, Tracer};
use crate::{Error, Result};
use std::cmp::Ordering;

/// The facts of Sutherland–Hodgman clipping.
pub const INFO: Info = Info {
    name: "sutherland-hodgman",
    title: "Sutherland–Hodgman",
    authors: "Ivan E. Sutherland, Gary W. Hodgman",
    year: 1974,
    source: "Reentrant polygon clipping, Communications of the ACM 17(1)",
    class: Class::ObjectSpace,
    occluder: Occluder::None,
    coherence: &[],
    cost: "O(n·m), n vertices, m borders; two vertices of memory per border",
    limits: "convex windows; a subject that falls apart keeps bridging edges along the border",
    pseudocode: &[
        "for each border of the window:",
        "    S := the last vertex of the list; out := empty",
        "    for each vertex P of the list, by the sides of S and P:",
        "        in→in: emit P",
        "        in→out: emit the cut of SP with the border",
        "        out→in: emit the cut of SP, then P",
        "        out→out: emit nothing",
        "        S := P",
        "    list := out",
        "the list is the result, one ring",
    ],
};

/// Vertex with a position that can be mixed with another vertex of an edge.
pub trait MixableVertex<const N: usize>: Copy {
    /// Returns the coordinates, in the space of the window.
    fn position(&self) -> [f64; N];
    /// Returns the vertex at `position` on the edge from self (t = 0) to `other` (t = 1).
    fn cut(&self, other: &Self, t: f64, position: [f64; N]) -> Self;
}

impl MixableVertex<2> for DVec2 {
    fn position(&self) -> [f64; 2] {
        self.to_array()
    }

    fn cut(&self, _other: &Self, _t: f64, position: [f64; 2]) -> Self {
        position.into()
    }
}

impl MixableVertex<3> for DVec3 {
    fn position(&self) -> [f64; 3] {
        self.to_array()
    }

    fn cut(&self, _other: &Self, _t: f64, position: [f64; 3]) -> Self {
        position.into()
    }
}

/// A vertex with a tuple of K numbers that are interpolated at cuts: colour, measure, texture.
impl<const K: usize> MixableVertex<2> for (DVec2, [f64; K]) {
    fn position(&self) -> [f64; 2] {
        self.0.to_array()
    }

    fn cut(&self, other: &Self, t: f64, position: [f64; 2]) -> Self {
        let mix = |k: usize| self.1[k] + (other.1[k] - self.1[k]) * t;
        (position.into(), std::array::from_fn(mix))
    }
}

/// The same in three dimensions.
impl<const K: usize> MixableVertex<3> for (DVec3, [f64; K]) {
    fn position(&self) -> [f64; 3] {
        self.0.to_array()
    }

    fn cut(&self, other: &Self, t: f64, position: [f64; 3]) -> Self {
        let mix = |k: usize| self.1[k] + (other.1[k] - self.1[k]) * t;
        (position.into(), std::array::from_fn(mix))
    }
}

/// One stage, which takes the vertices of a ring one by one and passes on those of the part inside.
#[derive(Debug, Clone)]
pub struct Stage<H, V> {
    border: H,
    first: Option<(V, bool)>,
    previous: Option<(V, bool)>,
}

impl<H, V> Stage<H, V> {
    /// Creates a stage that has seen nothing.
    pub fn new(border: H) -> Self {
        Self { border, first: None, previous: None }
    }

    /// Takes the next vertex; returns up to two: the cut of the edge that leads to it, and itself.
    fn take<const N: usize>(&mut self, vertex: V) -> [Option<V>; 2]
    where
        H: HalfSpace<N>,
        V: MixableVertex<N>,
    {
        let inside = self.border.sign(vertex.position()) != Ordering::Less;
        let cut = self.previous.and_then(|from| cut(&self.border, from, (vertex, inside)));
        self.first.get_or_insert((vertex, inside));
        self.previous = Some((vertex, inside));
        [cut, inside.then_some(vertex)]
    }

    /// Ends the ring; returns the cut of the edge that closes it, if there is one. Afterwards the stage is as new.
    fn close<const N: usize>(&mut self) -> Option<V>
    where
        H: HalfSpace<N>,
        V: MixableVertex<N>,
    {
        let (from, to) = self.previous.take().zip(self.first.take())?;
        cut(&self.border, from, to)
    }
}

/// Returns the cut of an edge whose ends are on different sides of a border; none if one end is on
/// it.
fn cut<const N: usize, H: HalfSpace<N>, V: MixableVertex<N>>(
    border: &H,
    (a, a_in): (V, bool),
    (b, b_in): (V, bool),
) -> Option<V> {
    let on_border = |v: &V| border.sign(v.position()) == Ordering::Equal;
    if a_in == b_in || on_border(&a) || on_border(&b) {
        return None;
    }
    // Vertices that passed a window are finite, so this cannot fail.
    let line = Canonical::new(a.position(), b.position()).ok()?;
    let t = convex::parameter(border, &line);
    let mut position = line.at(t);
    if let Some((axis, at)) = border.coordinate() {
        position[axis] = at;
    }
    let (from, to) = if line.swapped { (b, a) } else { (a, b) };
    Some(from.cut(&to, t, position))
}

/// Refuses vertices with coordinates that are not finite.
fn finite_vertices<const N: usize, V: MixableVertex<N>>(ring: &[V]) -> Result<()> {
    let finite = |v: &V| v.position().iter().all(|c| c.is_finite());
    match ring.iter().position(|v| !finite(v)) {
        Some(index) => Err(Error::NonFinite { what: "vertex", index }),
        None => Ok(()),
    }
}

/// Step of the algorithm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step<V> {
    /// A vertex came into a stage.
    Enters {
        /// The stage, that is the border's index.
        stage: usize,
        /// The vertex.
        vertex: V,
    },
    /// A vertex came out of the last stage.
    Leaves {
        /// The vertex.
        vertex: V,
    },
}

impl<V> PseudocodeLine for Step<V> {
    fn line(&self) -> usize {
        match self {
            Self::Enters { .. } => 3,
            Self::Leaves { .. } => 10,
        }
    }
}

/// Returns the result that a list of steps leads to.
pub fn replay<V: Copy>(steps: &[Step<V>]) -> Vec<V> {
    let leaves = |step: &Step<V>| match *step {
        Step::Leaves { vertex } => Some(vertex),
        Step::Enters { .. } => None,
    };
    steps.iter().filter_map(leaves).collect()
}

/// Stages one behind the other: the streaming form of the algorithm.
///
/// ```
/// use durer::clip::line::HalfPlane;
/// use durer::clip::polygon::sutherland_hodgman::Stages;
/// use durer::math::DVec2;
/// use durer::trace::NoTrace;
///
/// let right = HalfPlane { normal: DVec2::X, point: DVec2::ZERO };
/// let mut pipeline = Stages::new([right]);
/// let mut ring = Vec::new();
/// for v in [DVec2::new(-1.0, 0.0), DVec2::new(1.0, 0.0), DVec2::new(1.0, 2.0)] {
///     pipeline.push(v, &mut |v| ring.push(v), &mut NoTrace);
/// }
/// pipeline.close(&mut |v| ring.push(v), &mut NoTrace);
/// assert_eq!(ring, [DVec2::new(0., 0.), DVec2::new(1., 0.), DVec2::new(1., 2.), DVec2::new(0., 1.)]);
/// ```
#[derive(Debug, Clone)]
pub struct Stages<H, V> {
    stages: Vec<Stage<H, V>>,
}

impl<H, V> Stages<H, V> {
    /// Creates one stage for each border, in this order.
    pub fn new(borders: impl IntoIterator<Item = H>) -> Self {
        Self { stages: borders.into_iter().map(Stage::new).collect() }
    }

    /// Passes a vertex of the ring to the first stage; `out` gets the output of the last.
    pub fn push<const N: usize>(
        &mut self,
        vertex: V,
        out: &mut impl FnMut(V),
        t: &mut impl Tracer<Step<V>>,
    ) where
        H: HalfSpace<N>,
        V: MixableVertex<N>,
    {
        self.push_at(0, vertex, out, t);
    }

    /// Ends the ring; the pipeline is then ready for the next.
    pub fn close<const N: usize>(&mut self, out: &mut impl FnMut(V), t: &mut impl Tracer<Step<V>>)
    where
        H: HalfSpace<N>,
        V: MixableVertex<N>,
    {
        for stage in 0..self.stages.len() {
            if let Some(vertex) = self.stages[stage].close() {
                self.push_at(stage + 1, vertex, out, t);
            }
        }
    }

    fn push_at<const N: usize>(
        &mut self,
        stage: usize,
        vertex: V,
        out: &mut impl FnMut(V),
        t: &mut impl Tracer<Step<V>>,
    ) where
        H: HalfSpace<N>,
        V: MixableVertex<N>,
    {
        let Some(current) = self.stages.get_mut(stage) else {
            t.step(|| Step::Leaves { vertex });
            return out(vertex);
        };
        t.step(|| Step::Enters { stage, vertex });
        for vertex in current.take(vertex).into_iter().flatten() {
            self.push_at(stage + 1, vertex, out, t);
        }
    }
}

/// Returns the part of a ring in a rectangle, as one ring; empty if there is none.
///
/// # Errors
/// [`Error::NonFinite`] for a vertex with a NaN or infinite coordinate.
pub fn clip<V: MixableVertex<2>>(
    window: &Rect,
    ring: &[V],
    t: &mut impl Tracer<Step<V>>,
) -> Result<Vec<V>> {
    run(HalfPlane::of_rect(window), ring, t)
}

/// Returns the part of a ring in a convex polygon, as one ring; empty if there is none.
///
/// # Errors
/// [`Error::NonFinite`] for a vertex with a NaN or infinite coordinate.
pub fn clip_polygon<V: MixableVertex<2>>(
    window: &ConvexPolygon,
    ring: &[V],
    t: &mut impl Tracer<Step<V>>,
) -> Result<Vec<V>> {
    run(window.edges(), ring, t)
}

/// Returns the parts of all rings in a rectangle; rings without a remaining area are left out, and so are the holes of
/// such an outer ring.
///
/// # Errors
/// [`Error::NonFinite`] for a point with a NaN or infinite coordinate.
pub fn clip_shapes(
    window: &Rect,
    shapes: &Shapes,
    t: &mut impl Tracer<Step<DVec2>>,
) -> Result<Shapes> {
    map_rings(shapes, |ring| clip(window, ring, t))
}

/// Returns the parts of all rings in a convex polygon; rings without a remaining area are left out, and so are the
/// holes of such an outer ring.
///
/// # Errors
/// [`Error::NonFinite`] for a point with a NaN or infinite coordinate.
pub(crate) fn clip_shapes_with_polygon(
    window: &ConvexPolygon,
    shapes: &Shapes,
    t: &mut impl Tracer<Step<DVec2>>,
) -> Result<Shapes> {
    map_rings(shapes, |ring| clip_polygon(window, ring, t))
}

fn map_rings(
    shapes: &Shapes,
    mut clip: impl FnMut(&[DVec2]) -> Result<Vec<DVec2>>,
) -> Result<Shapes> {
    let mut out = Shapes::new();
    for polygon in shapes.polygons() {
        for (k, ring) in polygon.rings().enumerate() {
            let ring = clip(ring)?;
            // A ring that only touches the window from outside gives a flat ring along the border.
            if has_area(&ring) {
                out.push_ring(ring);
            } else if k == 0 {
                break;
            }
        }
        out.end_polygon();
    }
    Ok(out)
}

/// Returns whether a ring encloses more than rounding of its coordinates could.
fn has_area(ring: &[DVec2]) -> bool {
    let Some(around) = Rect::around(ring.iter().copied()) else { return false };
    let reach = around.min().abs().max(around.max().abs());
    let rounding = f64::EPSILON * (reach.x * around.size().y + reach.y * around.size().x);
    !is_flat(ring) && signed_area(ring).abs() > rounding
}

/// Returns the part of a planar polygon of space in a box: left, right, bottom, top, and the two
/// planes in front and at the back (smallest and largest z).
///
/// # Errors
/// [`Error::NonFinite`] for a vertex with a NaN or infinite coordinate.
pub fn clip_box<V: MixableVertex<3>>(
    window: &ClipBox<3>,
    ring: &[V],
    t: &mut impl Tracer<Step<V>>,
) -> Result<Vec<V>> {
    run(window.planes(), ring, t)
}

/// Returns the part of a planar polygon of space on the positive side of all planes.
///
/// # Errors
/// [`Error::NonFinite`] for a vertex or plane with a NaN or infinite number.
pub fn clip_polyhedron<V: MixableVertex<3>>(
    window: &[Plane],
    ring: &[V],
    t: &mut impl Tracer<Step<V>>,
) -> Result<Vec<V>> {
    let finite = |p: &Plane| p.normal.is_finite() && p.distance.is_finite();
    if let Some(index) = window.iter().position(|p| !finite(p)) {
        return Err(Error::NonFinite { what: "plane", index });
    }
    run(window.iter().copied(), ring, t)
}

fn run<const N: usize, H: HalfSpace<N>, V: MixableVertex<N>>(
    borders: impl IntoIterator<Item = H>,
    ring: &[V],
    t: &mut impl Tracer<Step<V>>,
) -> Result<Vec<V>> {
    finite_vertices(ring)?;
    let (mut pipeline, mut out) = (Stages::new(borders), Vec::new());
    for &vertex in ring {
        pipeline.push(vertex, &mut |v| out.push(v), t);
    }
    pipeline.close(&mut |v| out.push(v), t);
    Ok(out)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::trace::{NoTrace, Recorder};
    use proptest::prelude::*;

    fn p(x: f64, y: f64) -> DVec2 {
        DVec2::new(x, y)
    }

    #[test]
    fn a_subject_that_falls_apart_keeps_bridging_edges() {
        let window = Rect::new(p(0.0, 2.0), p(9.0, 9.0)).unwrap();
        let u = [
            p(1.0, 0.0),
            p(6.0, 0.0),
            p(6.0, 4.0),
            p(5.0, 4.0),
            p(5.0, 1.0),
            p(2.0, 1.0),
            p(2.0, 4.0),
            p(1.0, 4.0),
        ];
        let ring = clip(&window, &u, &mut NoTrace).unwrap();
        assert_eq!(signed_area(&ring), 4.0);
        let bridges = ring.iter().zip(ring.iter().cycle().skip(1));
        let along: Vec<_> = bridges.filter(|(a, b)| a.y == 2.0 && b.y == 2.0).collect();
        assert_eq!(along, [(&p(5.0, 2.0), &p(2.0, 2.0)), (&p(1.0, 2.0), &p(6.0, 2.0))]);
    }

    #[test]
    fn attributes_follow_the_cut() {
        let window = Rect::new(p(0.0, 0.0), p(4.0, 4.0)).unwrap();
        let ring =
            [(p(-1.0, 1.0), [10.0, 0.0]), (p(3.0, 1.0), [50.0, 4.0]), (p(3.0, 3.0), [50.0, 4.0])];
        let clipped = clip(&window, &ring, &mut NoTrace).unwrap();
        assert!(clipped.contains(&(p(0.0, 1.0), [20.0, 1.0])), "{clipped:?}");
        assert!(clipped.contains(&(p(0.0, 1.5), [20.0, 1.0])), "{clipped:?}");
    }

    #[test]
    fn front_and_back_cut_in_space() {
        let window = ClipBox::<3>::new(DVec3::splat(-1.0), DVec3::splat(1.0)).unwrap();
        let q = DVec3::new;
        let upright = [q(0.0, -0.5, -3.0), q(0.0, -0.5, 3.0), q(0.0, 0.5, 3.0), q(0.0, 0.5, -3.0)];
        let clipped = clip_box(&window, &upright, &mut NoTrace).unwrap();
        assert_eq!(clipped.len(), 4);
        assert!(clipped.iter().all(|v| v.z.abs() == 1.0 && v.y.abs() == 0.5), "{clipped:?}");
        assert_eq!(clip_polyhedron(&window.planes(), &upright, &mut NoTrace).unwrap(), clipped);
    }

    #[test]
    fn triangles_that_share_an_edge_share_its_cut() {
        let window = Rect::new(p(0.1, 0.1), p(0.9, 0.9)).unwrap();
        let (a, b) = (p(-0.3, 0.2), p(1.7, 0.7));
        let cuts = |ring: [DVec2; 3]| {
            let ring = clip(&window, &ring, &mut NoTrace).unwrap();
            ring.into_iter().filter(|v| v.x == 0.1 || v.x == 0.9).collect::<Vec<_>>()
        };
        let (upper, lower) = (cuts([a, b, p(0.5, 3.0)]), cuts([b, a, p(0.5, -3.0)]));
        assert_eq!(upper.iter().filter(|v| lower.contains(v)).count(), 2);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(10_000))]

        #[test]
        fn parts_inside_and_outside_make_the_whole(
            ring in prop::collection::vec((-4i32..=4, -4i32..=4), 3..9),
            n in (-3i32..=3, -3i32..=3),
        ) {
            let ring: Vec<DVec2> = ring.iter().map(|&(x, y)| p(x.into(), y.into())).collect();
            let normal = p(n.0.into(), n.1.into());
            let half = HalfPlane { normal, point: p(0.5, 0.0) };
            let other = HalfPlane { normal: -normal, ..half };
            prop_assume!(normal != DVec2::ZERO);
            let mut steps = Recorder::default();
            let inside = run([half], &ring, &mut steps).unwrap();
            prop_assert_eq!(&replay(steps.steps()), &inside);
            let outside = run([other], &ring, &mut NoTrace).unwrap();
            let sum = signed_area(&inside) + signed_area(&outside);
            prop_assert!((sum - signed_area(&ring)).abs() < 1e-12);
            for v in &inside {
                prop_assert!(normal.dot(*v - half.point) > -1e-14);
            }
        }
    }
}
