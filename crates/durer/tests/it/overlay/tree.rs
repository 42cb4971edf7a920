//! The nesting tree, compared with the plain definition: a ring's parent is the smallest ring around it.

use durer::clip::polygon::overlay::{Options, overlay};
use durer::clip::polygon::{BooleanOp, NestingTree, Shapes, Vertex, WindingRule, signed_area};
use durer::math::{I64Vec2, Orientation};
use durer::trace::NoTrace;
use proptest::prelude::*;

use super::whole::soup;

/// Returns whether a point on no ring's border is inside a ring.
fn encloses<P: Vertex>(ring: &[P], p: P) -> bool {
    let mut inside = false;
    for (i, &a) in ring.iter().enumerate() {
        let b = ring[(i + 1) % ring.len()];
        let (low, high) = if a.order(b).is_lt() { (a, b) } else { (b, a) };
        let spans = low.order(p).is_lt() && p.order(high).is_lt();
        inside ^= spans && P::turn(low, high, p) == Orientation::CounterClockwise;
    }
    inside
}

/// Checks a tree against the definition; `between` gives the exact midpoint of two points.
pub fn check<P: Vertex>(shapes: &Shapes<P>, tree: &NestingTree, between: impl Fn(P, P) -> P) {
    assert_eq!(tree.len(), shapes.ring_count());
    for r in 0..tree.len() {
        let middle = between(shapes.ring(r)[0], shapes.ring(r)[1]);
        let around = |&s: &usize| s != r && encloses(shapes.ring(s), middle);
        let area = |s: &usize| signed_area(shapes.ring(*s)).abs();
        let around: Vec<usize> = (0..tree.len()).filter(around).collect();
        let parent = around.iter().copied().min_by(|a, b| area(a).total_cmp(&area(b)));
        assert_eq!(tree.parent(r), parent, "ring {r} of {shapes:?}");
        assert_eq!(tree.depth(r), around.len());
        assert_eq!(tree.is_hole(r), signed_area(shapes.ring(r)) < 0.0);
        let siblings = parent.map_or(tree.roots(), |p| tree.children(p));
        assert!(siblings.is_sorted() && siblings.binary_search(&r).is_ok());
    }
    let children: usize = (0..tree.len()).map(|r| tree.children(r).len()).sum();
    assert_eq!(children + tree.roots().len(), tree.len());
}

/// With even coordinates every edge has an integer midpoint.
fn doubled(shapes: &Shapes<I64Vec2>) -> Shapes<I64Vec2> {
    let mut shapes = shapes.clone();
    shapes.points_mut().iter_mut().for_each(|p| *p *= 2);
    shapes
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 10_000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn parents_are_the_smallest_rings_around(
        a in soup(8, 9, 12), b in soup(5, 9, 12),
        op in super::laws::op(), rule in super::laws::rule(),
    ) {
        let out = overlay(&a, &b, op, &Options::with_rule(rule), &mut NoTrace).expect("small");
        let shapes = doubled(&out.shapes);
        prop_assert_eq!(&out.tree(), &NestingTree::of(&shapes));
        check(&shapes, &out.tree(), |p, q| (p + q) / 2);
    }
}

#[test]
fn rings_in_rings_nest_as_deep_as_they_go() {
    let square = |r: i64| [(-r, -r), (r, -r), (r, r), (-r, r)].map(I64Vec2::from);
    let rings = Shapes::from_rings((1..=3000).map(square));
    let options = Options::with_rule(WindingRule::EvenOdd);
    let out = overlay(&rings, &Shapes::new(), BooleanOp::Union, &options, &mut NoTrace);
    let tree = out.expect("small").tree();
    assert_eq!((tree.len(), tree.roots().len()), (3000, 1));
    assert!((0..3000).all(|ring| tree.children(ring).len() <= 1));
    assert_eq!((0..3000).map(|ring| tree.depth(ring)).max(), Some(2999));
}
