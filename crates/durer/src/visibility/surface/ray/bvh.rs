//! A hierarchy of boxes over triangles, built by binned surface area heuristic.
//!
//! I. Wald, *On Fast Construction of SAH-Based Bounding Volume Hierarchies*, IEEE Symposium on
//! Interactive Ray Tracing 2007.

use crate::math::Vec3;
use crate::trace::Tracer;

/// Numbers of tests of a ray on its way through the hierarchy.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Tests {
    /// Boxes of nodes.
    pub boxes: u32,
    /// Triangles in leaves.
    pub triangles: u32,
}

/// Test of a ray.
#[derive(Debug, Clone, Copy)]
pub enum Test {
    Box,
    Triangle,
}

impl Tracer<Test> for Tests {
    #[inline(always)]
    fn step(&mut self, make: impl FnOnce() -> Test) {
        match make() {
            Test::Box => self.boxes += 1,
            Test::Triangle => self.triangles += 1,
        }
    }
}

/// A closed box.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Box3 {
    pub min: Vec3,
    pub max: Vec3,
}

impl Box3 {
    /// Empty box, the neutral element of the union.
    pub const EMPTY: Self =
        Self { min: Vec3::splat(f32::INFINITY), max: Vec3::splat(f32::NEG_INFINITY) };

    fn union(&self, o: &Self) -> Self {
        Self { min: self.min.min(o.min), max: self.max.max(o.max) }
    }

    fn extent(&self) -> Vec3 {
        (self.max - self.min).max(Vec3::ZERO)
    }

    fn middle(&self) -> Vec3 {
        self.min * 0.5 + self.max * 0.5
    }
}

/// Probability that a ray meets a box of this extent, up to a factor.
pub type Likelihood = fn(Vec3) -> f32;

/// Returns the likelihood for rays of all directions: the surface.
pub fn surface(e: Vec3) -> f32 {
    e.x * e.y + e.y * e.z + e.z * e.x
}

/// Returns the likelihood for rays along z: the face across.
pub fn face(e: Vec3) -> f32 {
    e.x * e.y
}

/// A node: its left child follows it, `second` is its right child; or a leaf, whose `count` boxes
/// begin at `second`.
#[derive(Debug, Clone, Copy)]
struct Node {
    bounds: Box3,
    second: u32,
    count: u32,
}

#[derive(Debug, Clone)]
pub struct Bvh {
    nodes: Vec<Node>,
    /// Numbers of the boxes, leaf by leaf.
    order: Vec<u32>,
}

/// Boxes in a leaf at most, unless they all have the same middle.
const LEAF: usize = 4;

const BINS: usize = 16;

/// Depth below which nodes are split into halves, so that no input builds a chain.
const DEEP: u32 = 40;

/// A part of the boxes that waits to become a node, as right child of `parent`.
struct Waiting {
    first: usize,
    end: usize,
    parent: Option<usize>,
    depth: u32,
}

impl Bvh {
    /// Bytes for each box, while the hierarchy is built: leaves have two boxes or more on average.
    pub const PER_BOX: u64 =
        (size_of::<Box3>() + size_of::<u32>() + size_of::<Node>() * 3 / 2) as u64;

    pub fn new(boxes: &[Box3], likelihood: Likelihood) -> Self {
        let mut order: Vec<u32> = (0..boxes.len() as u32).collect();
        let mut nodes: Vec<Node> = Vec::new();
        let whole = Waiting { first: 0, end: boxes.len(), parent: None, depth: 0 };
        let mut stack = if boxes.is_empty() { Vec::new() } else { vec![whole] };
        while let Some(Waiting { first, end, parent, depth }) = stack.pop() {
            let index = nodes.len();
            if let Some(parent) = parent {
                nodes[parent].second = index as u32;
            }
            let part = &mut order[first..end];
            let all = part.iter().map(|&i| boxes[i as usize]);
            let bounds = all.fold(Box3::EMPTY, |a, b| a.union(&b));
            let split =
                if part.len() <= LEAF { None } else { split(boxes, part, depth, likelihood) };
            let Some(left) = split else {
                nodes.push(Node { bounds, second: first as u32, count: part.len() as u32 });
                continue;
            };
            nodes.push(Node { bounds, second: 0, count: 0 });
            let (middle, depth) = (first + left, depth + 1);
            stack.push(Waiting { first: middle, end, parent: Some(index), depth });
            stack.push(Waiting { first, end: middle, parent: None, depth });
        }
        Self { nodes, order }
    }

    /// Visits boxes that a ray meets, near ones first. `enter` returns where the ray enters a box, if it does; `visit`
    /// tests a box's content and may lower the limit, beyond which nothing is visited. `stack` is scratch
    /// space.
    #[inline]
    pub fn visit(
        &self,
        mut limit: f32,
        stack: &mut Vec<(u32, f32)>,
        enter: impl Fn(&Box3) -> Option<f32>,
        mut visit: impl FnMut(u32, &mut f32),
        t: &mut impl Tracer<Test>,
    ) {
        stack.clear();
        let Some(root) = self.nodes.first() else { return };
        t.step(|| Test::Box);
        if let Some(at) = enter(&root.bounds) {
            stack.push((0, at));
        }
        while let Some((index, at)) = stack.pop() {
            if at > limit {
                continue;
            }
            let node = &self.nodes[index as usize];
            if node.count > 0 {
                let first = node.second as usize;
                for &i in &self.order[first..first + node.count as usize] {
                    t.step(|| Test::Triangle);
                    visit(i, &mut limit);
                }
                continue;
            }
            let (left, right) = (index + 1, node.second);
            let mut child = |i: u32| {
                t.step(|| Test::Box);
                enter(&self.nodes[i as usize].bounds).map(|at| (i, at))
            };
            match (child(left), child(right)) {
                (Some(a), Some(b)) if a.1 <= b.1 => stack.extend([b, a]),
                (Some(a), Some(b)) => stack.extend([a, b]),
                (a, b) => stack.extend(a.or(b)),
            }
        }
    }
}

/// Divides boxes in two; returns how many are in the first part. `None` if they cannot be divided.
fn split(boxes: &[Box3], part: &mut [u32], depth: u32, likelihood: Likelihood) -> Option<usize> {
    let middle = |i: u32| boxes[i as usize].middle();
    // The axis along which the middles of the boxes extend farthest.
    let (lo, hi) = part
        .iter()
        .map(|&i| middle(i))
        .fold((Vec3::splat(f32::INFINITY), Vec3::splat(f32::NEG_INFINITY)), |(lo, hi), m| {
            (lo.min(m), hi.max(m))
        });
    let extent = hi - lo;
    let axis = if extent.x >= extent.y && extent.x >= extent.z {
        0
    } else {
        1 + usize::from(extent.z > extent.y)
    };
    // This is also the case if the extent is NaN.
    if !(extent[axis] > 0.0 && extent[axis] < f32::INFINITY) {
        return None;
    }
    // Deep nodes are halved by number, which bounds the depth.
    let half = part.len() / 2;
    if depth >= DEEP {
        part.select_nth_unstable_by(half, |&a, &b| middle(a)[axis].total_cmp(&middle(b)[axis]));
        return Some(half);
    }
    let bin = |i: u32| {
        let place = (middle(i)[axis] - lo[axis]) / extent[axis] * BINS as f32;
        (place as usize).min(BINS - 1)
    };
    // Others are divided at the cheapest border of a bin.
    let cut = best_cut(boxes, part, bin, likelihood);
    let mut left = 0;
    for k in 0..part.len() {
        if bin(part[k]) < cut {
            part.swap(k, left);
            left += 1;
        }
    }
    // The extreme middles are in the first and the last bin, so neither part is empty.
    Some(left)
}

/// Returns the bin before which to cut, by the cost of both sides.
fn best_cut(
    boxes: &[Box3],
    part: &[u32],
    bin: impl Fn(u32) -> usize,
    likelihood: Likelihood,
) -> usize {
    let mut bins = [(Box3::EMPTY, 0u32); BINS];
    for &i in part {
        let (bounds, count) = &mut bins[bin(i)];
        *bounds = bounds.union(&boxes[i as usize]);
        *count += 1;
    }
    let add = |sum: &(Box3, u32), b: &(Box3, u32)| (sum.0.union(&b.0), sum.1 + b.1);
    let cost = |side: &(Box3, u32)| likelihood(side.0.extent()) * side.1 as f32;
    let mut right = [(Box3::EMPTY, 0u32); BINS + 1];
    for k in (0..BINS).rev() {
        right[k] = add(&right[k + 1], &bins[k]);
    }
    let mut left = (Box3::EMPTY, 0);
    let mut best = (f32::INFINITY, 1);
    for k in 1..BINS {
        left = add(&left, &bins[k - 1]);
        let sum = cost(&left) + cost(&right[k]);
        if sum < best.0 {
            best = (sum, k);
        }
    }
    best.1
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::Numbers;
    use crate::trace::NoTrace;

    fn boxes(count: usize) -> Vec<Box3> {
        let mut numbers = Numbers(1);
        let mut next = || numbers.unit();
        (0..count)
            .map(|_| {
                let min = Vec3::new(next(), next(), next()) * 10.0;
                Box3 { min, max: min + Vec3::new(next(), next(), next()) }
            })
            .collect()
    }

    #[test]
    fn every_box_that_is_met_is_visited_once_and_none_else_need_be() {
        for count in [0, 1, 5, 300] {
            let boxes = boxes(count);
            let bvh = Bvh::new(&boxes, surface);
            for (x, y) in (0..22).flat_map(|y| (0..22).map(move |x| (x, y))) {
                let (x, y) = (x as f32 / 2.0, y as f32 / 2.0);
                let enter = |b: &Box3| {
                    (b.min.x <= x && x <= b.max.x && b.min.y <= y && y <= b.max.y)
                        .then_some(b.min.z)
                };
                let mut met = Vec::new();
                let visit = |i, _: &mut f32| met.extend(enter(&boxes[i as usize]).map(|_| i));
                bvh.visit(f32::INFINITY, &mut Vec::new(), enter, visit, &mut NoTrace);
                met.sort_unstable();
                let all = (0..count as u32).filter(|&i| enter(&boxes[i as usize]).is_some());
                assert_eq!(met, all.collect::<Vec<_>>());
            }
        }
    }

    /// Eight boxes side by side: a root, two nodes or more, and leaves of at most four.
    #[test]
    fn tests_are_counted() {
        let at = |k: u32| Vec3::splat(3.0 * k as f32);
        let boxes: Vec<Box3> =
            (0..8).map(|k| Box3 { min: at(k), max: at(k) + Vec3::ONE }).collect();
        let bvh = Bvh::new(&boxes, surface);
        let tests = |enters: bool| {
            let mut tests = Tests::default();
            let enter = |b: &Box3| enters.then_some(b.min.z);
            bvh.visit(f32::INFINITY, &mut Vec::new(), enter, |_, _| {}, &mut tests);
            tests
        };
        assert_eq!(tests(false), Tests { boxes: 1, triangles: 0 });
        assert_eq!(tests(true), Tests { boxes: bvh.nodes.len() as u32, triangles: 8 });
        assert_eq!(bvh.nodes.len() % 2, 1);
    }

    #[test]
    fn equal_boxes_make_one_leaf() {
        let boxes = vec![Box3 { min: Vec3::ZERO, max: Vec3::ONE }; 100];
        assert_eq!(Bvh::new(&boxes, surface).nodes.len(), 1);
    }
}
