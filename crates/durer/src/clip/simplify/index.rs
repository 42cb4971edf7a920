//! Which points lie in a triangle, of those that are left: boxes around points that are near one another, boxes
//! around boxes, and so on, each with the number of points that are left in it.

use crate::clip::hilbert;
use crate::math::{DVec2, Orientation, Rect, orient2d};

/// So many points, or boxes, are in a box.
const BRANCH: usize = 16;

/// Points are put in order by their squares in a grid of 2^16 by 2^16.
const GRID_BITS: u8 = 16;

/// The points that are left.
#[derive(Debug)]
pub struct Index {
    /// The points, those near one another together.
    order: Vec<u32>,
    /// The place of each point in that order.
    place_of: Vec<u32>,
    left: Vec<bool>,
    /// Boxes around points, around those, …; the last level has one.
    levels: Vec<Vec<Box>>,
}

#[derive(Debug, Clone, Copy)]
struct Box {
    min: DVec2,
    max: DVec2,
    left: u32,
}

impl Box {
    fn around(boxes: impl Iterator<Item = Self>) -> Option<Self> {
        boxes.reduce(|a, b| Self {
            min: a.min.min(b.min),
            max: a.max.max(b.max),
            left: a.left + b.left,
        })
    }
}

impl Index {
    /// All points.
    pub fn new(points: &[DVec2]) -> Self {
        let order = near_one_another(points);
        let mut place_of = vec![0; points.len()];
        for (&point, place) in order.iter().zip(0..) {
            place_of[point as usize] = place;
        }
        let of_point = |&i: &u32| {
            let p = points[i as usize];
            Box { min: p, max: p, left: 1 }
        };
        let mut level: Vec<Box> =
            order.chunks(BRANCH).filter_map(|c| Box::around(c.iter().map(of_point))).collect();
        let mut levels = Vec::new();
        while level.len() > 1 {
            let above = level.chunks(BRANCH).filter_map(|c| Box::around(c.iter().copied()));
            let above = above.collect();
            levels.push(std::mem::replace(&mut level, above));
        }
        levels.push(level);
        Self { order, place_of, left: vec![true; points.len()], levels }
    }

    /// Takes a point away.
    pub fn remove(&mut self, point: u32) {
        let Some(left) = self.left.get_mut(point as usize) else { return };
        if !std::mem::take(left) {
            return;
        }
        let mut place = self.place_of[point as usize] as usize;
        for level in &mut self.levels {
            place /= BRANCH;
            if let Some(around) = level.get_mut(place) {
                around.left -= 1;
            }
        }
    }

    /// A point that is left in a closed triangle, beside its corners.
    pub fn in_triangle(&self, points: &[DVec2], corners: [u32; 3]) -> Option<u32> {
        let triangle = Triangle::new(corners.map(|i| points[i as usize]));
        let mut open = vec![(self.levels.len().checked_sub(1)?, 0)];
        while let Some((level, place)) = open.pop() {
            let Some(around) = self.levels[level].get(place) else { continue };
            if around.left == 0 || !triangle.may_meet(around) {
                continue;
            }
            let children = place * BRANCH..(place + 1) * BRANCH;
            if level > 0 {
                open.extend(children.rev().map(|child| (level - 1, child)));
                continue;
            }
            let children = children.start..children.end.min(self.order.len());
            let found = self.order[children].iter().copied().find(|&i| {
                self.left[i as usize]
                    && !corners.contains(&i)
                    && triangle.contains(points[i as usize])
            });
            if found.is_some() {
                return found;
            }
        }
        None
    }
}

/// The indices of points, in the order of the squares they lie in.
fn near_one_another(points: &[DVec2]) -> Vec<u32> {
    let Some(around) = Rect::around(points.iter().copied()) else { return Vec::new() };
    let cells = f64::from((1u32 << GRID_BITS) - 1);
    // Halves, as a difference may overflow.
    let size = around.max() * 0.5 - around.min() * 0.5;
    let cell = |value: f64, low: f64, size: f64| {
        let part = if size > 0.0 { (value * 0.5 - low * 0.5) / size } else { 0.0 };
        (part * cells) as u32
    };
    let mut keyed: Vec<(u64, u32)> = points
        .iter()
        .zip(0..)
        .map(|(p, i)| {
            let (x, y) = (cell(p.x, around.min().x, size.x), cell(p.y, around.min().y, size.y));
            (hilbert::index(GRID_BITS, x, y), i)
        })
        .collect();
    keyed.sort_unstable();
    keyed.into_iter().map(|(_, i)| i).collect()
}

struct Triangle {
    corners: [DVec2; 3],
    min: DVec2,
    max: DVec2,
}

impl Triangle {
    fn new(corners @ [a, b, c]: [DVec2; 3]) -> Self {
        Self { corners, min: a.min(b).min(c), max: a.max(b).max(c) }
    }

    fn may_meet(&self, around: &Box) -> bool {
        let apart = around.max.cmplt(self.min) | around.min.cmpgt(self.max);
        if apart.any() {
            return false;
        }
        // Thin triangles that lie aslant have large boxes: is the whole box beyond the longest side?
        let [a, b, c] = self.corners;
        !self.is_beyond(a, c, b, around)
            && !self.is_beyond(b, c, a, around)
            && !self.is_beyond(a, b, c, around)
    }

    /// Whether a box lies on one side of a line, and a point on the other or on the line.
    fn is_beyond(&self, a: DVec2, b: DVec2, inner: DVec2, around: &Box) -> bool {
        let side = |p: DVec2| orient2d(a, b, p);
        let own = side(inner);
        let DVec2 { x: left, y: bottom } = around.min;
        let DVec2 { x: right, y: top } = around.max;
        let corners = [(left, bottom), (right, bottom), (right, top), (left, top)];
        let [first, rest @ ..] = corners.map(|p| side(DVec2::from(p)));
        first != own && first != Orientation::Collinear && rest.iter().all(|other| *other == first)
    }

    /// Whether a point lies in it or on its border; exact.
    fn contains(&self, p: DVec2) -> bool {
        let [a, b, c] = self.corners;
        if !(p.cmpge(self.min).all() && p.cmple(self.max).all()) {
            return false;
        }
        let sides = [(a, b), (b, c), (c, a)].map(|(from, to)| orient2d(from, to, p));
        let any = |wanted| sides.contains(&wanted);
        !(any(Orientation::CounterClockwise) && any(Orientation::Clockwise))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn finds_what_looking_at_all_finds(
            points in prop::collection::vec((-20i32..20, -20i32..20), 3..120),
            removed in prop::collection::vec(0..120usize, 0..60),
        ) {
            let points: Vec<DVec2> = points.iter().map(|&(x, y)| DVec2::new(x.into(), y.into())).collect();
            let mut index = Index::new(&points);
            let gone: Vec<usize> = removed.into_iter().filter(|i| *i < points.len()).collect();
            gone.iter().for_each(|&i| index.remove(i as u32));
            let triangle = Triangle::new([points[0], points[1], points[2]]);
            let within = |i: usize| !gone.contains(&i) && triangle.contains(points[i]);
            let expected = (3..points.len()).any(within);
            let found = index.in_triangle(&points, [0, 1, 2]);
            prop_assert_eq!(found.is_some(), expected);
            prop_assert!(found.is_none_or(|i| within(i as usize)));
        }
    }
}
