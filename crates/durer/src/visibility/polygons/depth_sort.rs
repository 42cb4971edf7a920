//! Newell, Newell and Sancha's depth sort on polygons.
//!
//! M. Newell, R. Newell, T. Sancha, *A Solution to the Hidden Surface Problem*, ACM Annual Conference 1972. Class: list
//! priority. Polygons are painted over each other from far to near. Before one is painted, five tests, the cheap ones
//! first, check whether it may hide another; a polygon that it may hide is moved before it, or split if it was moved
//! already. Cost: O(n²) tests for n polygons and pieces; memory O(pixels of all pieces).
//!
//! Deviations: each polygon is tested against all remaining ones. The overlap of projections is tested at the pixels'
//! centres. If neither polygon crosses the plane of the other, one is split along an edge of the other. A piece keeps
//! its face and the planes that cut it, so that the picture is the z-buffer's. After a split all marks are cleared.
//! [`crate::visibility::surface::depth_sort`] is the same for the triangles of models, with tiles for speed.

use super::pieces::{Pieces, PlaneSide};
use super::{Face, Screen};
use crate::Result;
use crate::info::{Class, Coherence, Info, Occluder};
use crate::math::{DVec3, Plane};
use crate::sorting::CompactSort;
use crate::target::{NO_ITEM, Pixels};
use crate::trace::{PseudocodeLine, Tracer};
use crate::visibility::surface::depth_sort::PaintTest;
use crate::work::Charge;

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "depth-sort-polygons",
    title: "Newell–Newell–Sancha depth sort of polygons",
    authors: "M. Newell, R. Newell, T. Sancha",
    year: 1972,
    source: "A Solution to the Hidden Surface Problem, ACM Annual Conference",
    class: Class::ListPriority,
    occluder: Occluder::Area,
    coherence: &[Coherence::Face, Coherence::Depth],
    cost: "O(n²) tests for n polygons and pieces; memory O(pixels of all pieces)",
    limits: "one sample per pixel; plane polygons; at most as many pieces as the options allow",
    pseudocode: &[
        "sort the polygons by their farthest corner, the farthest first",
        "while polygons are left:",
        "    P ← the first of the list",
        "    for each other Q of the list: P may be painted before Q if one test holds, in this order",
        "        1  z of P's nearest corner > z of Q's farthest corner",
        "        2a the boxes of P and Q on the screen are apart",
        "        2b all corners of Q are before P's plane",
        "        2c all corners of P are behind Q's plane",
        "        2d the projections of P and Q are apart",
        "        if none holds:",
        "            if Q is not marked: mark it, move it to the front of the list, begin with it",
        "            else they overlap cyclically: split Q along P's plane, sort again without marks",
        "    paint P over the picture so far",
    ],
};

/// Options for splitting.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Options {
    /// The most polygons and pieces.
    pub max_pieces: usize,
}

impl Default for Options {
    /// Returns the default: at most 65,536 pieces.
    fn default() -> Self {
        Self { max_pieces: 1 << 16 }
    }
}

/// Step of the algorithm. Polygons have numbers: first the faces, then the pieces that splitting makes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Step {
    /// A polygon is the first of the list: may it be painted?
    Look {
        /// P.
        polygon: u32,
    },
    /// P was tested against Q.
    Tested {
        /// P.
        polygon: u32,
        /// Q.
        other: u32,
        /// The test that lets P be painted before Q, if there is one.
        passed: Option<PaintTest>,
    },
    /// Q is marked and moved before P.
    Move {
        /// Q.
        polygon: u32,
    },
    /// A polygon is split.
    Split {
        /// The polygon.
        polygon: u32,
        /// Its face.
        face: u32,
        /// The polygon along whose plane, or whose edge, it is split.
        along: u32,
        /// The two pieces.
        pieces: [u32; 2],
    },
    /// A polygon is painted.
    Paint {
        /// The polygon.
        polygon: u32,
        /// Its face.
        face: u32,
    },
    /// A pixel of the polygon that is painted.
    Pixel {
        /// Column and row.
        pixel: [u32; 2],
        /// The face.
        face: u32,
    },
}

impl PseudocodeLine for Step {
    fn line(&self) -> usize {
        match self {
            Self::Look { .. } => 3,
            Self::Tested { passed, .. } => match passed {
                Some(PaintTest::Depths) => 5,
                Some(PaintTest::Boxes) => 6,
                Some(PaintTest::InFrontOfPlane) => 7,
                Some(PaintTest::BehindPlane) => 8,
                Some(PaintTest::Projections | PaintTest::Pixels) => 9,
                None => 10,
            },
            Self::Move { .. } => 11,
            Self::Split { .. } => 12,
            Self::Paint { .. } | Self::Pixel { .. } => 13,
        }
    }
}

/// Returns the picture that a list of steps leads to.
///
/// # Errors
/// [`Memory`](crate::Error::Memory) if the screen's budget does not suffice.
pub fn replay(screen: &Screen, steps: &[Step]) -> Result<Pixels<u32>> {
    screen.painted(steps.iter().filter_map(|step| match *step {
        Step::Pixel { pixel, face } => Some((pixel, face)),
        _ => None,
    }))
}

/// Returns the index of the nearest face at each pixel's centre, of equally near ones the first.
///
/// # Errors
/// [`Limit`](crate::Error::Limit) for too many pieces, [`Memory`](crate::Error::Memory) if the screen's budget does
/// not suffice.
pub fn items(
    faces: &[Face],
    screen: &Screen,
    options: &Options,
    t: &mut impl Tracer<Step>,
) -> Result<Pixels<u32>> {
    let mut items = screen.plane(NO_ITEM)?;
    let _table = screen.edge_table(faces)?;
    let mut charge = screen.work.charge("pixels of polygons", 0)?;
    let mut covered = |face: &Face| {
        let mut count = 0;
        face.spans(screen, |span| count += u64::from(span.x0.abs_diff(span.x1)));
        charge.grow(count.saturating_mul(size_of::<([u32; 2], DVec3)>() as u64))?;
        let mut pixels = Vec::with_capacity(count as usize);
        face.pixels(screen, |[x, y], point| pixels.push(([y, x], point)));
        pixels.compact_sort_by_key(|(pixel, _)| *pixel);
        Ok(pixels)
    };
    let pixels = faces.iter().map(&mut covered).collect::<Result<_>>()?;
    let pieces = Pieces::new(faces, &screen.work)?;
    let mut sorter = Sorter { faces, pieces, pixels, list: Vec::new(), charge };
    sorter.list = (0..faces.len() as u32).map(|polygon| (polygon, false)).collect();
    sorter.sort();
    while let Some(&(polygon, _)) = sorter.list.first() {
        t.step(|| Step::Look { polygon });
        if let Some(place) = sorter.hidden_by(polygon, t)
            && sorter.give_way(polygon, place, options, t)?
        {
            continue;
        }
        sorter.list.remove(0);
        let face = sorter.pieces.face(polygon);
        t.step(|| Step::Paint { polygon, face });
        for &([y, x], _) in &sorter.pixels[polygon as usize] {
            t.step(|| Step::Pixel { pixel: [x, y], face });
            items.set(x, y, face);
        }
    }
    Ok(items)
}

/// The list, and the state of its polygons.
struct Sorter<'a> {
    faces: &'a [Face],
    pieces: Pieces,
    /// Row and column of each pixel of each polygon, and its point there, row by row.
    pixels: Vec<Vec<([u32; 2], DVec3)>>,
    /// Polygons, and whether they are marked.
    list: Vec<(u32, bool)>,
    /// Memory of the pixels.
    charge: Charge,
}

impl Sorter<'_> {
    fn sort(&mut self) {
        let farthest = |polygon: u32| self.depths(polygon)[1];
        let mut list: Vec<(u32, f64)> =
            self.list.iter().map(|(polygon, _)| (*polygon, farthest(*polygon))).collect();
        list.compact_sort_by(|a, b| b.1.total_cmp(&a.1));
        self.list = list.into_iter().map(|(polygon, _)| (polygon, false)).collect();
    }

    /// Returns the nearest and the farthest corner's z.
    fn depths(&self, polygon: u32) -> [f64; 2] {
        let [low, high] = self.bounds(polygon);
        [low.z, high.z]
    }

    fn bounds(&self, polygon: u32) -> [DVec3; 2] {
        let around = |[low, high]: [DVec3; 2], p: &DVec3| [low.min(*p), high.max(*p)];
        let corners = self.pieces.corners(polygon).iter();
        corners.fold([DVec3::INFINITY, DVec3::NEG_INFINITY], around)
    }

    fn plane(&self, polygon: u32) -> &Plane {
        self.faces[self.pieces.face(polygon) as usize].plane()
    }

    /// Returns the place in the list of the first polygon that P may hide.
    fn hidden_by(&self, polygon: u32, t: &mut impl Tracer<Step>) -> Option<usize> {
        (1..self.list.len()).find(|&place| {
            let other = self.list[place].0;
            let passed = self.test(polygon, other);
            t.step(|| Step::Tested { polygon, other, passed });
            passed.is_none()
        })
    }

    /// Returns the first test that lets P be painted before Q.
    fn test(&self, p: u32, q: u32) -> Option<PaintTest> {
        let ([p_low, p_high], [q_low, q_high]) = (self.bounds(p), self.bounds(q));
        if p_low.z > q_high.z {
            return Some(PaintTest::Depths);
        }
        let apart = |k: usize| p_high[k] <= q_low[k] || q_high[k] <= p_low[k];
        if apart(0) || apart(1) {
            return Some(PaintTest::Boxes);
        }
        if self.is_beside(q, p, 1.0, p, q) {
            return Some(PaintTest::InFrontOfPlane);
        }
        if self.is_beside(p, q, -1.0, p, q) {
            return Some(PaintTest::BehindPlane);
        }
        (!self.overlap(p, q)).then_some(PaintTest::Projections)
    }

    /// Returns whether all corners of a polygon are on one side of another one's plane, for sign 1 on the eye's. Of two
    /// coplanar polygons, the first face is painted last.
    fn is_beside(&self, polygon: u32, of: u32, sign: f64, p: u32, q: u32) -> bool {
        let plane = self.plane(of);
        let to_eye = if plane.normal.z > 0.0 { -sign } else { sign };
        let side = self.pieces.side(plane, polygon);
        let wanted = if to_eye > 0.0 { PlaneSide::Front } else { PlaneSide::Back };
        let is_first = self.pieces.face(q) < self.pieces.face(p);
        plane.normal.z != 0.0 && (side == wanted || (side == PlaneSide::On && is_first))
    }

    /// Returns whether two polygons have a pixel in common.
    fn overlap(&self, p: u32, q: u32) -> bool {
        let [mut p, mut q] = [p, q].map(|polygon| self.pixels[polygon as usize].iter().peekable());
        while let (Some((a, _)), Some((b, _))) = (p.peek(), q.peek()) {
            match a.cmp(b) {
                std::cmp::Ordering::Less => p.next(),
                std::cmp::Ordering::Greater => q.next(),
                std::cmp::Ordering::Equal => return true,
            };
        }
        false
    }

    /// Moves the polygon at a place before P, or splits one of them; returns false if nothing can be done.
    fn give_way(
        &mut self,
        p: u32,
        place: usize,
        options: &Options,
        t: &mut impl Tracer<Step>,
    ) -> Result<bool> {
        let (q, is_marked) = self.list[place];
        if !is_marked {
            self.list.remove(place);
            self.list.insert(0, (q, true));
            t.step(|| Step::Move { polygon: q });
            return Ok(true);
        }
        let Some((polygon, along, plane)) = self.cut(p, q) else { return Ok(false) };
        let limit = ("number of pieces of polygons", options.max_pieces);
        let pieces = self.pieces.split(&plane, polygon, limit)?;
        t.step(|| Step::Split { polygon, face: self.pieces.face(polygon), along, pieces });
        // The pixels of both pieces are those of the polygon, which keeps its own.
        let count = self.pixels[polygon as usize].len();
        self.charge.grow((count * size_of::<([u32; 2], DVec3)>()) as u64)?;
        for piece in pieces {
            let all = &self.pixels[polygon as usize];
            let own = all.iter().filter(|(_, point)| self.pieces.holds(piece, *point));
            let own = own.copied().collect();
            self.pixels.push(own);
        }
        self.list.retain(|(other, _)| *other != polygon);
        self.list.extend(pieces.map(|piece| (piece, false)));
        self.sort();
        Ok(true)
    }

    /// Returns which of two polygons is split, along which, and the plane: the other's own, or one through an edge of
    /// it.
    fn cut(&self, p: u32, q: u32) -> Option<(u32, u32, Plane)> {
        let splits =
            |plane: &Plane, polygon: u32| self.pieces.side(plane, polygon) == PlaneSide::Both;
        for (polygon, along) in [(q, p), (p, q)] {
            let plane = self.plane(along);
            if splits(plane, polygon) {
                return Some((polygon, along, *plane));
            }
        }
        for (polygon, along) in [(q, p), (p, q)] {
            let corners = self.pieces.corners(along);
            let edges = corners.iter().zip(corners.iter().cycle().skip(1));
            let upright = |(a, b): (&DVec3, &DVec3)| {
                Plane::through(*a, (*b - *a).cross(DVec3::Z)).normalized()
            };
            if let Some(plane) = edges.filter_map(upright).find(|plane| splits(plane, polygon)) {
                return Some((polygon, along, plane));
            }
        }
        None
    }
}
