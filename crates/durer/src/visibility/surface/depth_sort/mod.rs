//! Depth sort: polygons are put in order, then painted over each other from back to front.
//!
//! M. Newell, R. Newell, T. Sancha, *A Solution to the Hidden Surface Problem*, ACM Annual Conference 1972. List
//! priority. Cost: O(n log n + n · polygons nearby at similar depths), but O(n²) pieces if all faces penetrate each
//! other, each compared with many others, O(n³) and more; that is cut off by [`Error::Limit`] (300 faces that all
//! penetrate each other are sorted, 500 are not). Memory O(n + pieces' rows). Coherence used: faces, depth.
//!
//! Deviations: candidates for the tests come from tiles of the screen, in which polygons are sorted by depth. The tests
//! allow for rounding; pairs that they leave undecided are compared at the pixel centres that both polygons cover, with
//! the z-buffer's depths, and the pieces of a split polygon divide its pixel centres among them. So the painted picture
//! equals the z-buffer's, also at equal depths. Where a plane does not separate cyclically overlapping polygons, an
//! edge does. Blended surfaces are painted over what is behind them, which the order provides without extra work.

mod glazed;
mod piece;
mod relation;
mod tiles;

pub use piece::{CutLine, TrianglePiece};

use crate::info::{Class, Coherence, Info, Occluder};
use crate::math::DVec2;
use crate::raster::fixed::unsnap;
use crate::raster::span::Span;
use crate::shade::PreparedLights;
use crate::target::Framebuffer;
use crate::trace::{PseudocodeLine, Tracer};
use crate::visibility::surface::cover::{Cover, SampleGrid};
use crate::visibility::surface::input::{METHOD, SurfaceInput};
use crate::visibility::surface::picture;
use crate::visibility::surface::setup::{Coverage, ScreenTriangle};
use crate::visibility::surface::visible::{
    Masks, Visible, pixels_of, with_lighting, write, write_planes,
};
use crate::{Error, Result};
use glazed::Glazed;
use piece::{Key, Pieces};
use relation::Verdict;
use std::collections::BinaryHeap;
use tiles::Tiles;

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "depth-sort",
    title: "Newell–Newell–Sancha depth sort",
    authors: "M. Newell, R. Newell, T. Sancha",
    year: 1972,
    source: "A Solution to the Hidden Surface Problem, ACM Annual Conference",
    class: Class::ListPriority,
    occluder: Occluder::Area,
    coherence: &[Coherence::Face, Coherence::Depth],
    cost: "O(n log n + n · nearby polygons at similar depths), O(n²) where all faces cross",
    limits: "one sample per pixel",
    pseudocode: &[
        "sort the polygons by their farthest point, the farthest first",
        "while polygons are left:",
        "    P ← the first of the list",
        "    for each Q that P may hide:",
        "        // P may be painted before Q if one test holds, in this order",
        "        1 depths apart, 2a boxes apart, 2b Q wholly before P's plane,",
        "        2c P wholly behind Q's plane, 2d projections apart",
        "        if none holds:",
        "            if Q is not marked: mark it, move it before P and continue with it",
        "            else they overlap cyclically: split one along the plane of the other",
        "    paint P",
    ],
};

/// Bytes for each triangle of the input.
pub(super) const PER_TRIANGLE: u64 = Pieces::PER_TRIANGLE;

/// Options for rendering with depth sort.
#[derive(Debug, Clone, Copy, Default)]
pub struct Options {
    /// Shading and background.
    pub look: picture::Options,
}

/// The tests that let a polygon P be painted before another one Q, in order of cost.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum PaintTest {
    /// 1: P's nearest point is behind Q's farthest.
    Depths,
    /// 2a: their boxes on the screen have no pixel in common.
    Boxes,
    /// 2b: Q is wholly in front of P's plane.
    InFrontOfPlane,
    /// 2c: P is wholly behind Q's plane.
    BehindPlane,
    /// 2d: their projections do not overlap.
    Projections,
    /// P is nearer at no pixel that both cover.
    Pixels,
}

impl PaintTest {
    /// Returns the test's number in textbooks; the last test is not in the paper.
    pub const fn number(self) -> &'static str {
        match self {
            Self::Depths => "1",
            Self::Boxes => "2a",
            Self::InFrontOfPlane => "2b",
            Self::BehindPlane => "2c",
            Self::Projections => "2d",
            Self::Pixels => "pixels",
        }
    }
}

/// Step of the algorithm. Polygons have numbers: first the triangles of the input, then pieces.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step {
    /// A polygon is the farthest that is left (or the one whose turn it is), or was moved before it: is
    /// it to be painted next?
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
    /// Q must be painted before P: it is marked and takes P's place.
    Move {
        /// Q.
        polygon: u32,
    },
    /// A polygon is cut in two.
    Split {
        /// Number of the polygon.
        polygon: u32,
        /// Cut that divides it.
        cut: CutLine,
        /// The two pieces: the one on the cut's inner side first.
        pieces: [u32; 2],
    },
    /// A polygon is painted next.
    Place {
        /// Number of the polygon.
        polygon: u32,
    },
}

impl PseudocodeLine for Step {
    fn line(&self) -> usize {
        match self {
            Self::Look { .. } => 3,
            Self::Tested { .. } => 6,
            Self::Move { .. } => 9,
            Self::Split { .. } => 10,
            Self::Place { .. } => 11,
        }
    }
}

/// A polygon in its place in the order.
#[derive(Debug, Clone, PartialEq)]
pub struct ScreenPolygon {
    /// Index into [`SurfaceInput::triangles`].
    pub triangle: u32,
    /// Its item.
    pub item: u32,
    /// Part of the triangle that it is, if the triangle was split.
    pub part: Option<TrianglePiece>,
}

impl ScreenPolygon {
    /// Returns the corners, in pixels, x right and y down; convex, in one sense or the other.
    pub fn outline(&self, input: &SurfaceInput<'_>) -> Vec<DVec2> {
        match &self.part {
            Some(part) => part.outline.clone(),
            None => corners(&input.triangles[self.triangle as usize]).to_vec(),
        }
    }

    /// Emits the pixels that it covers: its share of the triangle's.
    pub fn spans(&self, input: &SurfaceInput<'_>, mut emit: impl FnMut(Span)) {
        match &self.part {
            Some(part) => part.spans.iter().for_each(|&span| emit(span)),
            None => {
                let triangle = &input.triangles[self.triangle as usize];
                let cover = Cover::new(triangle, SampleGrid::PIXELS);
                cover.spans(&pixels_of(input.view), emit);
            }
        }
    }
}

/// Returns the vertices of a triangle in pixels.
fn corners(t: &ScreenTriangle) -> [DVec2; 3] {
    [0, 1, 2].map(|i| DVec2::new(unsnap(t.x[i]), unsnap(t.y[i])))
}

/// Puts the triangles of an input into an order in which each may be painted over those before it;
/// triangles that penetrate each other or overlap cyclically are split.
///
/// # Errors
/// [`Error::Limit`] if it takes too many comparisons, as of hundreds of triangles that all penetrate each other.
pub fn order(input: &SurfaceInput<'_>, t: &mut impl Tracer<Step>) -> Result<Vec<ScreenPolygon>> {
    order_after(input, &[], t)
}

/// Sorts polygons as [`order`] does, with frame-to-frame coherence: they are examined as in an order of the same scene
/// seen before, not from far to near. `previous` has that order's items. With any list the order is as right, and the
/// picture is the same. Little is saved: a tenth of the moves, where frames are a degree apart.
///
/// # Errors
/// As [`order`].
pub fn order_after(
    input: &SurfaceInput<'_>,
    previous: &[u32],
    t: &mut impl Tracer<Step>,
) -> Result<Vec<ScreenPolygon>> {
    let more = COMPARISONS_PER_TRIANGLE.saturating_mul(input.triangles.len() as u64);
    order_within(input, previous, COMPARISONS.saturating_add(more), t)
}

/// Limit on the number of comparisons, some seconds of work, to which `COMPARISONS_PER_TRIANGLE` is added for each
/// triangle. Models of surfaces take about a hundred per triangle.
const COMPARISONS: u64 = 1 << 26;
const COMPARISONS_PER_TRIANGLE: u64 = 4096;

/// Sorts polygons as [`order_after`] does, with at most `most` comparisons.
fn order_within(
    input: &SurfaceInput<'_>,
    previous: &[u32],
    most: u64,
    t: &mut impl Tracer<Step>,
) -> Result<Vec<ScreenPolygon>> {
    // Both the pieces and the lists of the tiles are charged.
    let pieces = Pieces::new(&input.triangles, pixels_of(input.view));
    let _tiles = input.work.charge(METHOD, Tiles::bytes(&pieces, input.view))?;
    let tiles = Tiles::new(&pieces, input.view);
    let mut charge = input.work.charge(METHOD, 0)?;
    let turns = turns(input, previous);
    // The queue orders pieces by their turns, then by depth.
    let queue = (0..pieces.len()).map(|i| (turns[i as usize], pieces.key(i))).collect();
    let done = vec![false; pieces.len() as usize];
    let mut sorter = Sorter {
        pieces,
        tiles,
        turns,
        queue,
        marked: done.clone(),
        seen: vec![0; done.len()],
        round: 0,
        looks: 0,
        done,
        stack: Vec::new(),
    };
    // Pieces are painted one by one; splitting makes further ones, up to the limits.
    let mut polygons = Vec::with_capacity(input.triangles.len());
    while let Some(p) = sorter.next() {
        if sorter.advance(p, t) {
            polygons.push(sorter.pieces.polygon(p));
        }
        input.work.check()?;
        charge.grow_to(sorter.pieces.bytes())?;
        let value = sorter.looks / LOOKS_PER_COMPARISON;
        if value > most {
            let what = "number of comparisons of polygons by depth sort";
            return Err(Error::Limit { what, value, limit: most });
        }
    }
    Ok(polygons)
}

/// Returns the rank of each triangle of an input in a previous order, greater for earlier ones; triangles that are not
/// in it come first, by depth.
fn turns(input: &SurfaceInput<'_>, previous: &[u32]) -> Vec<u32> {
    let mut places: Vec<(u32, u32)> = previous.iter().copied().zip(0..).collect();
    // For an item in pieces, the first piece counts.
    places.sort_unstable();
    let turn = |item: u32| {
        let at = places.partition_point(|p| p.0 < item);
        places.get(at).filter(|p| p.0 == item).map_or(u32::MAX, |p| u32::MAX - 1 - p.1)
    };
    input.triangles.iter().map(|t| turn(t.item)).collect()
}

/// Renders the input into the planes that the framebuffer has.
///
/// # Errors
/// As [`order`].
pub fn render(
    input: &SurfaceInput<'_>,
    lights: &PreparedLights,
    options: &Options,
    framebuffer: &mut Framebuffer,
    t: &mut impl Tracer<Step>,
) -> Result<()> {
    let polygons = order(input, t)?;
    with_lighting(input, lights, &options.look, |lighting| {
        let masks = &mut Masks::new(input, lighting);
        let blended = input.having(Coverage::Blended);
        let pixels = u64::from(framebuffer.width()) * u64::from(framebuffer.height());
        let mut charge = input.work.charge(METHOD, 0)?;
        if !blended.is_empty() {
            charge.grow_to(pixels.saturating_mul(glazed::PER_PIXEL))?;
            let mut glazed = Glazed::new(input, blended, lighting, &options.look);
            let visible = paint(input, &polygons, masks, |at, i, depth| glazed.put(at, i, depth));
            write_planes(&visible, lighting, &options.look, framebuffer);
            glazed.write(framebuffer);
        } else {
            let visible = paint(input, &polygons, masks, |_, _, _| ());
            write(&visible, lighting, &options.look, framebuffer);
        }
        Ok(())
    })
}

/// Paints polygons over each other; `painted` hears of pixel, triangle and depth.
fn paint(
    input: &SurfaceInput<'_>,
    polygons: &[ScreenPolygon],
    masks: &mut Masks<'_>,
    mut painted: impl FnMut([i32; 2], usize, f32),
) -> Visible {
    let mut visible = Visible::new(pixels_of(input.view));
    for polygon in polygons {
        let index = polygon.triangle as usize;
        let triangle = &input.triangles[index];
        polygon.spans(input, |Span { y, x0, x1 }| {
            for x in x0..x1 {
                if masks.passes(index, triangle.item, x, y) {
                    let depth = SampleGrid::PIXELS.depth(triangle, x, y);
                    visible.put(x, y, depth, triangle.item);
                    painted([x, y], index, depth);
                }
            }
        });
    }
    visible
}

/// A comparison takes as long as about this many looks into the list of a tile.
const LOOKS_PER_COMPARISON: u64 = 16;

/// The list of polygons being sorted.
struct Sorter<'a> {
    pieces: Pieces<'a>,
    tiles: Tiles,
    /// Rank of each triangle, greater for those to compare earlier.
    turns: Vec<u32>,
    /// By turn, of one turn farthest first.
    queue: BinaryHeap<(u32, Key)>,
    /// Placed, or replaced by its pieces.
    done: Vec<bool>,
    /// True for each polygon in the stack.
    marked: Vec<bool>,
    /// The round in which a polygon was last tested.
    seen: Vec<u32>,
    round: u32,
    /// Number of lookups in a tile's list; a comparison counts as several.
    looks: u64,
    /// The polygon under examination on top, below it the polygons that wait for it.
    stack: Vec<u32>,
}

impl Sorter<'_> {
    /// Returns the polygon that is being examined, or the next one.
    fn next(&mut self) -> Option<u32> {
        while self.stack.is_empty() {
            let next = self.queue.pop()?.1.polygon;
            if !self.done[next as usize] {
                self.push(next);
            }
        }
        self.stack.last().copied()
    }

    fn push(&mut self, polygon: u32) {
        self.marked[polygon as usize] = true;
        self.stack.push(polygon);
    }

    /// Removes the polygon at this place of the stack, and all above.
    fn pop_from(&mut self, place: usize) {
        for polygon in self.stack.drain(place..) {
            self.marked[polygon as usize] = false;
        }
    }

    /// Takes one step with the polygon that is being examined; returns whether it can be painted next.
    fn advance(&mut self, p: u32, t: &mut impl Tracer<Step>) -> bool {
        t.step(|| Step::Look { polygon: p });
        match self.obstacle(p, t) {
            Some((q, Verdict::Later)) if !self.marked[q as usize] => {
                t.step(|| Step::Move { polygon: q });
                self.push(q);
                return false;
            }
            Some((q, verdict)) if self.resolve(p, q, verdict, t) => return false,
            // Nothing is in conflict, or no cut could resolve the conflict.
            _ => {}
        }
        t.step(|| Step::Place { polygon: p });
        self.done[p as usize] = true;
        self.pop_from(self.stack.len() - 1);
        true
    }

    /// Returns a polygon that P must not be painted before.
    fn obstacle(&mut self, p: u32, t: &mut impl Tracer<Step>) -> Option<(u32, Verdict)> {
        self.round += 1;
        self.seen[p as usize] = self.round;
        for tile in self.tiles.of(self.pieces.window(p)) {
            self.tiles.skip_done(tile, &self.done);
            let mut place = 0;
            while let Some(q) = self.tiles.get(tile, place) {
                place += 1;
                self.looks += 1;
                if self.pieces.farthest(q) < self.pieces.nearest(p) {
                    break;
                }
                let i = q as usize;
                if self.done[i] || self.seen[i] == self.round {
                    continue;
                }
                self.seen[i] = self.round;
                self.looks += LOOKS_PER_COMPARISON;
                let verdict = self.pieces.judge(p, q, self.marked[i]);
                t.step(|| {
                    let passed =
                        if let Verdict::Passed(test) = verdict { Some(test) } else { None };
                    Step::Tested { polygon: p, other: q, passed }
                });
                if !matches!(verdict, Verdict::Passed(_)) {
                    return Some((q, verdict));
                }
            }
        }
        None
    }

    /// Splits one of the polygons involved if P and Q penetrate each other or Q already waits for P; returns `false` if
    /// none can be split.
    fn resolve(&mut self, p: u32, q: u32, verdict: Verdict, t: &mut impl Tracer<Step>) -> bool {
        if self.split(p, &CutLine::along(q), t) {
            return true;
        }
        if verdict == Verdict::Penetrates || !self.marked[q as usize] {
            return self.split(q, &CutLine::along(p), t);
        }
        let first = self.stack.iter().position(|&s| s == q).unwrap_or(0);
        let cycle = self.stack[first..].to_vec();
        self.split(q, &CutLine::along(p), t) || cycle.into_iter().any(|r| self.split(r, &[], t))
    }

    /// Splits a polygon by the first cut that leaves pixels on both sides, or else in the middle.
    fn split(&mut self, p: u32, cuts: &[CutLine], t: &mut impl Tracer<Step>) -> bool {
        let Some((cut, pieces)) = self.pieces.split(p, cuts) else { return false };
        t.step(|| Step::Split { polygon: p, cut, pieces });
        self.done[p as usize] = true;
        if let Some(place) = self.stack.iter().position(|&s| s == p) {
            self.pop_from(place);
        }
        for piece in pieces {
            self.done.push(false);
            self.marked.push(false);
            self.seen.push(0);
            let turn = self.turns[self.pieces.get(piece).triangle as usize];
            self.queue.push((turn, self.pieces.key(piece)));
            self.tiles.insert(piece, &self.pieces);
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{DMat4, DVec3, Vec3};
    use crate::scene::{Camera, Instance, Mesh, Projection, Scene};
    use crate::trace::NoTrace;
    use crate::view::View;
    use crate::visibility::surface::Cull;
    use crate::visibility::surface::setup::TriangleFilter;

    /// Returns triangles around the origin, rotated against each other: each intersects all others.
    fn penetrating(count: u32) -> Scene {
        let corner = |i: u32, k: u32| {
            let [a, b] = [f64::from(i * 7 + k * 40), f64::from(i * 3 + k * 50)].map(|v| v * 0.7);
            DVec3::new(libm::cos(a), libm::sin(a), libm::sin(b)).as_vec3()
        };
        let positions: Vec<Vec3> = (0..3 * count).map(|i| corner(i / 3, i % 3)).collect();
        let mesh = Mesh { positions, ..Mesh::default() };
        let instance = Instance { mesh: 0, world_from_mesh: DMat4::IDENTITY, name: String::new() };
        Scene { meshes: vec![mesh], instances: vec![instance], ..Scene::default() }
    }

    #[test]
    fn faces_that_all_penetrate_each_other_end_at_the_limit() {
        let scene = penetrating(24);
        let camera = Camera {
            eye: DVec3::new(0.0, 0.0, 5.0),
            target: DVec3::ZERO,
            up: DVec3::Y,
            projection: Projection::Orthographic { height: 2.5 },
            near: 1.0,
            far: 10.0,
        };
        let view = View::new(camera, 48, 48).unwrap();
        let input = SurfaceInput::new(&scene, &view, TriangleFilter::new(Cull::None, 128)).unwrap();
        let polygons = order(&input, &mut NoTrace).unwrap();
        assert!(polygons.len() > 200, "{}", polygons.len());
        let error = order_within(&input, &[], 500, &mut NoTrace).unwrap_err();
        let Error::Limit { value, limit: 500, .. } = error else { panic!("{error}") };
        assert!((501..1000).contains(&value), "{value}");
    }
}
