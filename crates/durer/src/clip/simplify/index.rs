//! An index of the remaining points in a triangle: boxes around points that are near one another, boxes around
//! boxes, and so on, each with the number of points that remain in it.

use crate::clip::hilbert;
use crate::math::{DVec2, Orientation, Rect, orient2d};

/// Number of points, or boxes, in a box.
const BRANCH: usize = 16;

/// Points are put in order by their squares in a grid of 2^16 by 2^16.
const GRID_BITS: u8 = 16;

/// The points that are left.
#[derive(Debug)]
pub struct Index {
    /// The points, those near one another together.
    order: Vec<u32>,
    /// Positions in that order, so that the points of a box are adjacent in memory.
    at: Vec<DVec2>,
    /// The place of each point in that order.
    place_of: Vec<u32>,
    /// A bit for each remaining point of each box around points.
    left: Vec<u16>,
    /// Boxes around points, around those, …; the last level has one.
    levels: Vec<Vec<Box>>,
    /// Boxes still to be looked into, empty between two calls.
    open: Vec<(usize, usize)>,
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
    /// Creates all points.
    pub fn new(points: &[DVec2]) -> Self {
        let order = near_one_another(points);
        let mut place_of = vec![0; points.len()];
        for (&point, place) in order.iter().zip(0..) {
            place_of[point as usize] = place;
        }
        let at: Vec<DVec2> = order.iter().map(|&i| points[i as usize]).collect();
        let of_point = |&p: &DVec2| Box { min: p, max: p, left: 1 };
        let mut level: Vec<Box> =
            at.chunks(BRANCH).filter_map(|c| Box::around(c.iter().map(of_point))).collect();
        let left = at.chunks(BRANCH).map(|c| u16::MAX >> (BRANCH - c.len())).collect();
        let mut levels = Vec::new();
        while level.len() > 1 {
            let above = level.chunks(BRANCH).filter_map(|c| Box::around(c.iter().copied()));
            let above = above.collect();
            levels.push(std::mem::replace(&mut level, above));
        }
        levels.push(level);
        Self { order, at, place_of, left, levels, open: Vec::new() }
    }

    /// Removes a point.
    pub fn remove(&mut self, point: u32) {
        let Some(&place) = self.place_of.get(point as usize) else { return };
        let mut place = place as usize;
        let bit = 1 << (place % BRANCH);
        let Some(left) = self.left.get_mut(place / BRANCH).filter(|left| **left & bit != 0) else {
            return;
        };
        *left ^= bit;
        for level in &mut self.levels {
            place /= BRANCH;
            if let Some(around) = level.get_mut(place) {
                around.left -= 1;
            }
        }
    }

    /// Returns a point that is left in a closed triangle, beside its corners.
    pub fn in_triangle(&mut self, points: &[DVec2], corners: [u32; 3]) -> Option<u32> {
        let triangle = Triangle::new(corners.map(|i| points[i as usize]));
        let mut open = std::mem::take(&mut self.open);
        let found = self.look(&triangle, corners, &mut open);
        open.clear();
        self.open = open;
        found
    }

    fn look(
        &self,
        triangle: &Triangle,
        corners: [u32; 3],
        open: &mut Vec<(usize, usize)>,
    ) -> Option<u32> {
        open.push((self.levels.len().checked_sub(1)?, 0));
        while let Some((level, place)) = open.pop() {
            if level == 0 {
                let found = self.look_at_points(triangle, corners, place);
                if found.is_some() {
                    return found;
                }
                continue;
            }
            let below = self.levels.get(level - 1)?;
            let end = ((place + 1) * BRANCH).min(below.len());
            let children = (place * BRANCH..end).rev();
            let may_meet =
                |&child: &usize| below[child].left > 0 && triangle.may_meet(&below[child]);
            open.extend(children.filter(may_meet).map(|child| (level - 1, child)));
        }
        None
    }

    /// Searches the points of one box, like [`Index::in_triangle`].
    fn look_at_points(&self, triangle: &Triangle, corners: [u32; 3], place: usize) -> Option<u32> {
        let mut left = self.left.get(place).copied().unwrap_or(0);
        while left != 0 {
            let at = place * BRANCH + left.trailing_zeros() as usize;
            left &= left - 1;
            if triangle.contains(self.at[at]) && !corners.contains(&self.order[at]) {
                return Some(self.order[at]);
            }
        }
        None
    }
}

/// Returns the indices of points, in the order of the squares they lie in.
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
        // Thin oblique triangles have large boxes: is the whole box beyond one of the sides?
        let larger = (self.max - self.min).cmpgt(around.max - around.min);
        if !larger.any() {
            return true;
        }
        let [a, b, c] = self.corners;
        !self.is_beyond(a, c, b, around)
            && !self.is_beyond(b, c, a, around)
            && !self.is_beyond(a, b, c, around)
    }

    /// Returns whether a box is on one side of a line, and a point on the other side or on the line.
    fn is_beyond(&self, a: DVec2, b: DVec2, inner: DVec2, around: &Box) -> bool {
        let side = |p: DVec2| orient2d(a, b, p);
        let own = side(inner);
        let DVec2 { x: left, y: bottom } = around.min;
        let DVec2 { x: right, y: top } = around.max;
        let corners = [(left, bottom), (right, bottom), (right, top), (left, top)];
        let [first, rest @ ..] = corners.map(|p| side(DVec2::from(p)));
        first != own && first != Orientation::Collinear && rest.iter().all(|other| *other == first)
    }

    /// Returns whether a point is in it or on its border; exact.
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
