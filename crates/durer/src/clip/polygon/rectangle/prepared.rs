//! Polygons prepared for many windows and points.
//!
//! Boxes around runs of consecutive edges, around runs of runs and so on, are computed once. A run whose box lies
//! beyond a border of the window has no edge in it. A run whose box lies to the right of a point crosses the ray from
//! the point to the right an odd number of times if its two ends are on different sides of the ray, whatever happens
//! between them; so only edges in runs whose boxes contain the point's height and are not wholly to one side of it are
//! examined. Rings are found by boxes in the same way.

use super::rings::{Clipper, Directed, Guide, crosses};
use super::tree::Tree;
use crate::clip::attribute::{NoSources, Provenance, VertexSource};
use crate::clip::exact;
use crate::clip::polygon::{Ring, Shapes, signed_area};
use crate::math::{DVec2, Rect};
use crate::trace::NoTrace;
use crate::{Error, Result};
use std::cmp::Ordering;
use std::ops::Range;

/// Polygons prepared for many windows or for tests of many points.
///
/// Preparing costs O(n + r log r) time for n vertices in r rings, and about ten bytes per vertex. A window
/// then costs O(log n + k) for k vertices near it, and a point O(log n), as long as consecutive edges
/// are near one another; where they jump about, boxes settle less.
///
/// ```
/// use durer::clip::polygon::{Shapes, rectangle};
/// use durer::math::{DVec2, Rect};
///
/// let p = DVec2::new;
/// let triangle = Shapes::from_rings([[p(0.0, 0.0), p(8.0, 0.0), p(0.0, 8.0)]]);
/// let prepared = rectangle::Prepared::new(triangle)?;
/// assert_eq!(prepared.clip(&Rect::new(p(1.0, 1.0), p(2.0, 2.0))?).area(), 1.0);
/// assert!(prepared.contains(p(4.0, 4.0)) && !prepared.contains(p(4.0, 5.0)));
/// # Ok::<(), durer::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Prepared {
    shapes: Shapes,
    /// The rings of each polygon.
    polygons: Vec<Range<usize>>,
    rings: Vec<PreparedRing>,
    /// The rings that have points, sorted so that nearby ones are together.
    order: Vec<usize>,
    /// Boxes around runs of that order.
    tree: Tree,
}

#[derive(Debug, Clone)]
struct PreparedRing {
    polygon: usize,
    turns_left: bool,
    /// Boxes around runs of its edges, in the direction in which its inside is on the left.
    tree: Tree,
}

impl Prepared {
    /// Prepares polygons.
    ///
    /// # Errors
    /// [`Error::NonFinite`] names the first point with a NaN or infinite coordinate.
    pub fn new(shapes: Shapes) -> Result<Self> {
        if let Some(index) = shapes.points().iter().position(|p| !p.is_finite()) {
            return Err(Error::NonFinite { what: "point", index });
        }
        let polygons: Vec<_> = shapes.polygons().map(|p| p.ring_indices()).collect();
        let prepare = |(polygon, numbers): (usize, &Range<usize>)| {
            let outer = numbers.start;
            let shapes = &shapes;
            let ring = move |number| PreparedRing::new(shapes, number, polygon, number == outer);
            numbers.clone().map(ring)
        };
        let rings: Vec<_> = polygons.iter().enumerate().flat_map(prepare).collect();
        let (mut order, boxes): (Vec<usize>, Vec<Rect>) =
            rings.iter().enumerate().filter_map(|(i, r)| Some((i, r.tree.around()?))).unzip();
        let middle = |place: usize| boxes[place].min() * 0.5 + boxes[place].max() * 0.5;
        let mut places: Vec<usize> = (0..order.len()).collect();
        gather(&mut places, &middle);
        let corners = |place: &usize| [boxes[*place].min(), boxes[*place].max()];
        let tree =
            Tree::new(places.len(), &|some| Rect::around(places[some].iter().flat_map(corners)));
        order = places.iter().map(|&place| order[place]).collect();
        Ok(Self { shapes, polygons, rings, order, tree })
    }

    /// Returns the polygons.
    pub(crate) fn shapes(&self) -> &Shapes {
        &self.shapes
    }

    /// Returns the smallest rectangle around them; `None` if there is no point.
    pub(crate) fn bounds(&self) -> Option<Rect> {
        self.tree.around()
    }

    /// Returns the part of all polygons in the window, with the same bits as [`super::clip`].
    pub fn clip(&self, window: &Rect) -> Shapes {
        self.run::<NoSources>(window).0
    }

    /// Clips as [`Self::clip`], and returns the source of every point.
    pub(crate) fn clip_with_sources(&self, window: &Rect) -> (Shapes, Vec<VertexSource>) {
        self.run(window)
    }

    /// Returns whether an edge comes near a rectangle: the boxes around both have a point in
    /// common.
    pub(crate) fn has_edges_near(&self, window: &Rect) -> bool {
        self.rings_near(window).into_iter().any(|number| {
            let ring = self.directed(number);
            let mut found = false;
            self.rings[number].tree.visit(|node| {
                let look = !found && node.around.overlaps(window);
                if look && node.is_last() {
                    let edge = |k: usize| Rect::around([ring.point(k), ring.point(k + 1)]);
                    let near = |k: usize| edge(k).is_some_and(|edge| edge.overlaps(window));
                    found = node.items.clone().any(near);
                }
                look
            });
            found
        })
    }

    fn run<P: Provenance>(&self, window: &Rect) -> (Shapes, P) {
        let mut clipper = Clipper::<P>::new(window);
        let mut found = self.rings_near(window);
        found.sort_unstable();
        let mut rest = &found[..];
        while let Some(&first) = rest.first() {
            let rings = &self.polygons[self.rings[first].polygon];
            let (near, others) = rest.split_at(rest.partition_point(|&ring| ring < rings.end));
            rest = others;
            // Without its outer ring a polygon is empty.
            let outer = (first == rings.start).then(|| self.rings[first].tree.around()).flatten();
            let Some(outer) = outer else { continue };
            if window.contains(outer.min()) && window.contains(outer.max()) {
                clipper.copy(&self.shapes, rings.clone());
            } else {
                clipper.cut(&self.shapes, near.iter().copied(), self, &mut NoTrace);
            }
        }
        clipper.finish()
    }

    /// Returns whether a point lies in the closed polygons, by the even-odd rule over all rings;
    /// exact.
    pub fn contains(&self, p: DVec2) -> bool {
        let place = self.place(p);
        place.odd || place.on_border
    }

    /// Returns whether a point lies on a ring; exact.
    pub(crate) fn has_on_border(&self, p: DVec2) -> bool {
        self.place(p).on_border
    }

    fn place(&self, p: DVec2) -> Place {
        let mut all = Place::default();
        let Ok(at) = Rect::new(p, p) else { return all };
        for number in self.rings_near(&at) {
            let place = self.place_of(&self.directed(number), p);
            all.odd ^= place.odd;
            all.on_border |= place.on_border;
        }
        all
    }

    fn directed(&self, number: usize) -> Directed<'_> {
        let outer = self.polygons[self.rings[number].polygon].start == number;
        Directed::new(&self.shapes, number, self.rings[number].turns_left != outer)
    }

    /// Returns the rings whose boxes have a point in common with a rectangle.
    fn rings_near(&self, window: &Rect) -> Vec<usize> {
        let mut found = Vec::new();
        let near = |around: Rect| around.overlaps(window);
        self.tree.visit(|node| {
            let look = near(node.around);
            if look && node.is_last() {
                let rings = self.order[node.items.clone()].iter().copied();
                found
                    .extend(rings.filter(|&ring| self.rings[ring].tree.around().is_some_and(near)));
            }
            look
        });
        found
    }

    fn place_of(&self, ring: &Directed<'_>, p: DVec2) -> Place {
        let mut place = Place::default();
        self.rings[ring.number].tree.visit(|node| {
            let (low, high) = (node.around.min(), node.around.max());
            if p.x > high.x || p.y < low.y || p.y > high.y {
                return false;
            }
            if p.x < low.x {
                let below = |k: usize| ring.point(k).y <= p.y;
                place.odd ^= below(node.items.start) != below(node.items.end);
                return false;
            }
            if node.is_last() {
                for k in node.items.clone() {
                    let (a, b) = (ring.point(k), ring.point(k + 1));
                    place.odd ^= crosses(a, b, p);
                    place.on_border |= is_on(a, b, p);
                }
            }
            true
        });
        place
    }
}

/// Location of a point relative to rings.
#[derive(Default)]
struct Place {
    /// True if a ray to the right crosses the ring an odd number of times.
    odd: bool,
    on_border: bool,
}

/// Returns whether a point lies on a closed segment; exact.
fn is_on(a: DVec2, b: DVec2, p: DVec2) -> bool {
    let (low, high) = (a.min(b), a.max(b));
    p.cmpge(low).all() && p.cmple(high).all() && exact::side(a, b, p) == Ordering::Equal
}

impl Guide for Prepared {
    fn turns_left(&self, number: usize, _ring: &Ring) -> bool {
        self.rings[number].turns_left
    }

    fn stretches(
        &self,
        window: &Rect,
        ring: &Directed<'_>,
        start: usize,
    ) -> impl Iterator<Item = Range<usize>> {
        let (min, max) = (window.min(), window.max());
        let mut near: Vec<Range<usize>> = Vec::new();
        self.rings[ring.number].tree.visit(|node| {
            let (low, high) = (node.around.min(), node.around.max());
            let beyond = high.x <= min.x || low.x >= max.x || high.y <= min.y || low.y >= max.y;
            if !beyond && node.is_last() {
                near.push(node.items.clone());
            }
            !beyond
        });
        // Once around from the start; the run that contains the start is divided there.
        let count = ring.len();
        let first = near.partition_point(|run| run.end <= start);
        let (before, after) = (near[..near.len().min(first + 1)].to_vec(), near.split_off(first));
        let after = after.into_iter().map(move |run| run.start.max(start)..run.end);
        let before =
            before.into_iter().map(move |run| run.start + count..run.end.min(start) + count);
        after.chain(before).filter(|run| !run.is_empty())
    }

    fn holds(&self, ring: &Directed<'_>, p: DVec2) -> bool {
        self.place_of(ring, p).odd
    }
}

impl PreparedRing {
    fn new(shapes: &Shapes, number: usize, polygon: usize, outer: bool) -> Self {
        let turns_left = signed_area(shapes.ring(number)) > 0.0;
        let ring = Directed::new(shapes, number, turns_left != outer);
        let around = |edges: Range<usize>| match ring.len() {
            0 => None,
            _ => Rect::around((edges.start..=edges.end).map(|k| ring.point(k))),
        };
        let tree = Tree::new(ring.len(), &around);
        Self { polygon, turns_left, tree }
    }
}

/// Sorts nearby items together: halves along the longer side, halves of those, …
fn gather(things: &mut [usize], middle: &impl Fn(usize) -> DVec2) {
    let around = Rect::around(things.iter().map(|&thing| middle(thing)));
    let Some(size) = around.map(|r| r.size()).filter(|_| things.len() > Tree::RUN) else { return };
    let axis = usize::from(size.y > size.x);
    let half = things.len() / 2;
    things.select_nth_unstable_by(half, |&a, &b| middle(a)[axis].total_cmp(&middle(b)[axis]));
    let (low, high) = things.split_at_mut(half);
    gather(low, middle);
    gather(high, middle);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::clip::polygon::point::{Place, locate};
    use crate::clip::polygon::rectangle::{Options, clip};
    use crate::clip::polygon::{WindingRule, overlay};
    use proptest::prelude::*;

    fn p((x, y): (i32, i32)) -> DVec2 {
        DVec2::new(x.into(), y.into())
    }

    /// Returns arbitrary rings, each a polygon or a hole of the one before.
    fn rings() -> impl Strategy<Value = Shapes> {
        let ring = prop::collection::vec((-6i32..=6, -6i32..=6), 0..14);
        prop::collection::vec((ring, any::<bool>()), 0..9).prop_map(|rings| {
            let mut shapes = Shapes::new();
            for (ring, hole) in rings {
                if !hole {
                    shapes.end_polygon();
                }
                shapes.push_ring(ring.into_iter().map(p));
            }
            shapes.end_polygon();
            shapes
        })
    }

    /// Returns the same region as valid polygons.
    fn valid(shapes: &Shapes) -> Shapes {
        let options = overlay::Options::with_rule(WindingRule::EvenOdd);
        let op = crate::clip::polygon::BooleanOp::Union;
        overlay::overlay(shapes, &Shapes::new(), op, &options, &mut NoTrace).unwrap().shapes
    }

    /// Returns the rings with other first points and directions.
    fn turned(shapes: &Shapes, by: usize, flip: bool) -> Shapes {
        let mut out = Shapes::new();
        for polygon in shapes.polygons() {
            for ring in polygon.rings() {
                let mut ring = ring.to_vec();
                let count = ring.len().max(1);
                ring.rotate_left(by % count);
                if flip {
                    ring.reverse();
                }
                out.push_ring(ring);
            }
            out.end_polygon();
        }
        out
    }

    fn same(shapes: &Shapes, window: &Rect) -> std::result::Result<(), TestCaseError> {
        let expected = clip(window, shapes, &Options, &mut NoTrace).unwrap();
        let prepared = Prepared::new(shapes.clone()).unwrap();
        prop_assert_eq!(prepared.clip(window), expected, "{:?} {:?}", window, shapes);
        prop_assert_eq!(prepared.bounds(), Rect::around(shapes.rings().flatten().copied()));
        Ok(())
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(10_000))]

        #[test]
        fn windows_are_those_of_the_plain_clip(
            shapes in rings(),
            (by, flip) in (0..9usize, any::<bool>()),
            (x, y, w, h) in (-14i32..14, -14i32..14, 0i32..20, 0i32..20),
        ) {
            // Halves: through the vertices, and between them.
            let low = p((x, y)) * 0.5;
            let window = Rect::new(low, low + p((w, h)) * 0.5).unwrap();
            same(&shapes, &window)?;
            let valid = valid(&shapes);
            same(&valid, &window)?;
            same(&turned(&valid, by, flip), &window)?;
        }

        #[test]
        fn points_lie_where_every_edge_says(shapes in rings(), x in -14i32..=14, y in -14i32..=14) {
            let at = p((x, y)) * 0.5;
            let prepared = Prepared::new(shapes.clone()).unwrap();
            let place = locate(shapes.rings(), at, WindingRule::EvenOdd);
            prop_assert_eq!(prepared.contains(at), place != Place::Outside, "{} {:?}", at, shapes);
            prop_assert_eq!(prepared.has_on_border(at), place == Place::Border, "{} {:?}", at, shapes);
        }
    }

    #[test]
    fn borders_belong_to_polygons() {
        let outer = [(0, 0), (9, 0), (9, 9), (0, 9)].map(p);
        let hole = [(1, 1), (2, 1), (2, 2), (1, 2)].map(p);
        let prepared = Prepared::new(Shapes::from_rings([outer, hole])).unwrap();
        for (x, y, inside) in [
            (0.5, 0.5, true),
            (1.5, 1.5, false),
            (1.0, 1.5, true),
            (9.0, 9.0, true),
            (9.5, 9.0, false),
        ] {
            assert_eq!(prepared.contains(DVec2::new(x, y)), inside, "{x}, {y}");
        }
    }

    #[test]
    fn points_that_are_not_finite_are_named_or_nowhere() {
        let square = [(0, 0), (4, 0), (4, 4), (0, 4)].map(p);
        let prepared = Prepared::new(Shapes::from_rings([square])).unwrap();
        assert!(!prepared.contains(DVec2::new(f64::NAN, 1.0)));
        let bad = Shapes::from_rings([[square[0], DVec2::new(1.0, f64::INFINITY), square[2]]]);
        assert_eq!(Prepared::new(bad).unwrap_err(), Error::NonFinite { what: "point", index: 1 });
    }
}
