//! The polygons: whole triangles, and pieces of them with the pixels that fell to them.

use super::{ScreenPolygon, corners};
use crate::math::DVec2;
use crate::raster::fixed::SUBPIXELS;
use crate::raster::span::Span;
use crate::visibility::surface::cover::{Cover, SampleGrid};
use crate::visibility::surface::setup::ScreenTriangle;
use crate::visibility::surface::visible::nearer;
use crate::visibility::surface::window::SampleRect;

/// A line that cuts a polygon in two.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum CutLine {
    /// Intersection of the polygon with the plane of another; its inner side is nearer.
    Plane {
        /// The other polygon.
        of: u32,
    },
    /// Line along an edge of the triangle of another polygon, from this vertex to the next.
    Edge {
        /// The other polygon.
        of: u32,
        /// Number of the edge's first vertex.
        edge: usize,
    },
    /// Left of a column of pixels.
    Column(i32),
    /// Above a row of pixels.
    Row(i32),
}

impl CutLine {
    /// Returns the cuts that may separate a polygon from another.
    pub(super) fn along(of: u32) -> [Self; 4] {
        let edge = |edge| Self::Edge { of, edge };
        [Self::Plane { of }, edge(0), edge(1), edge(2)]
    }
}

/// A piece of a triangle.
#[derive(Debug, Clone, PartialEq)]
pub struct TrianglePiece {
    /// The corners, in pixels; convex.
    pub outline: Vec<DVec2>,
    /// The pixels that fell to it, row by row.
    pub spans: Vec<Span>,
}

/// Sort key of a polygon in the first order: greater for farther polygons; at equal depths greater for higher items.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Key {
    /// Bits of the farthest depth; depths are not negative, so they compare like the depths.
    depth: u32,
    item: u32,
    pub polygon: u32,
}

pub struct Piece {
    pub triangle: u32,
    /// The pixels of its box.
    pub window: SampleRect,
    pub nearest: f32,
    pub farthest: f32,
    pub part: Option<TrianglePiece>,
}

/// Bytes of a piece, and of its places in the queue, in the lists of a few tiles and in the result.
const PER_PIECE: u64 =
    (size_of::<Piece>() + 8 * size_of::<Key>() + size_of::<ScreenPolygon>()) as u64;

pub struct Pieces<'a> {
    pub triangles: &'a [ScreenTriangle],
    pub covers: Vec<Cover>,
    /// Largest distance of depths at pixels from the triangles' planes.
    pub slack: Vec<f64>,
    list: Vec<Piece>,
    /// Bytes of the pieces that splits have added, with their places in the order.
    bytes: u64,
}

impl<'a> Pieces<'a> {
    /// Bytes for each triangle, with its places in the order.
    pub const PER_TRIANGLE: u64 = (size_of::<Cover>() + size_of::<f64>()) as u64 + PER_PIECE;

    pub fn new(triangles: &'a [ScreenTriangle], screen: SampleRect) -> Self {
        let covers: Vec<Cover> =
            triangles.iter().map(|t| Cover::new(t, SampleGrid::PIXELS)).collect();
        let whole = |(i, t): (usize, &ScreenTriangle)| Piece {
            triangle: i as u32,
            window: covers[i].bounds.and(&screen),
            nearest: t.depth_min,
            farthest: t.depth_max,
            part: None,
        };
        let list = triangles.iter().enumerate().map(whole).collect();
        let slack = triangles.iter().map(slack).collect();
        Self { triangles, covers, slack, list, bytes: 0 }
    }

    /// Returns the bytes of the pieces that splits have added.
    pub fn bytes(&self) -> u64 {
        self.bytes
    }

    pub fn len(&self) -> u32 {
        self.list.len() as u32
    }

    pub fn get(&self, polygon: u32) -> &Piece {
        &self.list[polygon as usize]
    }

    pub fn window(&self, polygon: u32) -> &SampleRect {
        &self.get(polygon).window
    }

    pub fn nearest(&self, polygon: u32) -> f32 {
        self.get(polygon).nearest
    }

    pub fn farthest(&self, polygon: u32) -> f32 {
        self.get(polygon).farthest
    }

    pub fn triangle(&self, polygon: u32) -> &ScreenTriangle {
        &self.triangles[self.get(polygon).triangle as usize]
    }

    pub fn key(&self, polygon: u32) -> Key {
        let depth = self.farthest(polygon).to_bits();
        Key { depth, item: self.triangle(polygon).item, polygon }
    }

    /// Returns a polygon for the result.
    pub fn polygon(&mut self, polygon: u32) -> ScreenPolygon {
        let item = self.triangle(polygon).item;
        let piece = &mut self.list[polygon as usize];
        ScreenPolygon { triangle: piece.triangle, item, part: piece.part.take() }
    }

    /// Returns the pixels of a polygon within a window, row by row.
    pub fn spans(&self, polygon: u32, w: &SampleRect) -> Vec<Span> {
        let mut spans = Vec::new();
        let piece = self.get(polygon);
        match &piece.part {
            None => self.covers[piece.triangle as usize].spans(w, |span| spans.push(span)),
            Some(part) => {
                let first = part.spans.partition_point(|s| s.y < w.y0);
                for s in part.spans[first..].iter().take_while(|s| s.y < w.y1) {
                    let (x0, x1) = (s.x0.max(w.x0), s.x1.min(w.x1));
                    Span::emit_unless_empty(s.y, x0, x1, &mut |span| spans.push(span));
                }
            }
        }
        spans
    }

    /// Returns the depth and item of a polygon's triangle at a pixel.
    pub fn at(&self, polygon: u32, x: i32, y: i32) -> (f32, u32) {
        let t = self.triangle(polygon);
        (SampleGrid::PIXELS.depth(t, x, y), t.item)
    }

    /// Splits a polygon by the first cut that leaves pixels on both sides, or in the middle; `None` if it has only one
    /// pixel.
    pub fn split(&mut self, polygon: u32, cuts: &[CutLine]) -> Option<(CutLine, [u32; 2])> {
        let spans = self.spans(polygon, self.window(polygon));
        let w = box_of(&spans)?;
        let middle = [CutLine::Column((w.x0 + w.x1) / 2), CutLine::Row((w.y0 + w.y1) / 2)];
        let wide = w.x1 - w.x0 >= w.y1 - w.y0;
        let last = if wide { middle } else { [middle[1], middle[0]] };
        cuts.iter().chain(&last).find_map(|&cut| {
            let [inner, outer] = self.share_out(polygon, &spans, cut);
            if inner.is_empty() || outer.is_empty() {
                return None;
            }
            let outlines = self.cut_outline(polygon, cut);
            let [a, b] = outlines;
            let parts = [(inner, a), (outer, b)];
            Some((cut, parts.map(|(spans, outline)| self.add(polygon, spans, outline))))
        })
    }

    /// Adds a piece of a polygon.
    fn add(&mut self, of: u32, spans: Vec<Span>, outline: Vec<DVec2>) -> u32 {
        let (mut nearest, mut farthest) = (f32::INFINITY, 0.0f32);
        for (x, y) in spans.iter().flat_map(|s| (s.x0..s.x1).map(|x| (x, s.y))) {
            let depth = self.at(of, x, y).0;
            (nearest, farthest) = (nearest.min(depth), farthest.max(depth));
        }
        let window = box_of(&spans).unwrap_or(*self.window(of));
        let triangle = self.get(of).triangle;
        let lists = size_of_val(&spans[..]) + size_of_val(&outline[..]);
        self.bytes += PER_PIECE + lists as u64;
        let part = Some(TrianglePiece { outline, spans });
        self.list.push(Piece { triangle, window, nearest, farthest, part });
        self.len() - 1
    }

    /// Returns the pixels on the inner and the outer side of a cut.
    fn share_out(&self, polygon: u32, spans: &[Span], cut: CutLine) -> [Vec<Span>; 2] {
        let mut sides = [Vec::new(), Vec::new()];
        for s in spans {
            let mut x0 = s.x0;
            let mut side = self.is_inner(polygon, cut, s.x0, s.y);
            for x in s.x0 + 1..s.x1 {
                let next = self.is_inner(polygon, cut, x, s.y);
                if next != side {
                    sides[usize::from(!side)].push(Span { y: s.y, x0, x1: x });
                    (x0, side) = (x, next);
                }
            }
            sides[usize::from(!side)].push(Span { y: s.y, x0, x1: s.x1 });
        }
        sides
    }

    fn is_inner(&self, polygon: u32, cut: CutLine, x: i32, y: i32) -> bool {
        match cut {
            CutLine::Plane { of } => nearer(self.at(polygon, x, y), self.at(of, x, y)),
            CutLine::Edge { of, edge } => {
                self.covers[self.get(of).triangle as usize].edge_at(edge, x, y) >= 0
            }
            CutLine::Column(column) => x < column,
            CutLine::Row(row) => y < row,
        }
    }

    fn cut_outline(&self, polygon: u32, cut: CutLine) -> [Vec<DVec2>; 2] {
        let outline = match &self.get(polygon).part {
            Some(part) => part.outline.clone(),
            None => corners(self.triangle(polygon)).to_vec(),
        };
        let values: Vec<f64> = outline.iter().map(|&p| self.inward(polygon, cut, p)).collect();
        [half(&outline, &values, 1.0), half(&outline, &values, -1.0)]
    }

    /// Returns a linear function of the screen, positive on the inner side of a cut.
    fn inward(&self, polygon: u32, cut: CutLine, p: DVec2) -> f64 {
        match cut {
            CutLine::Plane { of } => {
                on_plane(self.triangle(of), p) - on_plane(self.triangle(polygon), p)
            }
            CutLine::Edge { of, edge } => {
                let v = corners(self.triangle(of));
                let (a, b) = (v[edge % 3], v[(edge + 1) % 3]);
                (b - a).perp_dot(p - a)
            }
            CutLine::Column(column) => f64::from(column) - p.x,
            CutLine::Row(row) => f64::from(row) - p.y,
        }
    }
}

/// Returns the depth of a triangle's plane at a point of the screen, in pixels.
pub fn on_plane(t: &ScreenTriangle, p: DVec2) -> f64 {
    let [ox, oy] = t.origin().map(|o| f64::from(o) + 0.5);
    let (dx, dy) = (f64::from(t.depth_dx), f64::from(t.depth_dy));
    f64::from(t.depth) + (dx * (p.x - ox) + dy * (p.y - oy))
}

/// Returns the largest distance of depths at pixels from the plane: by rounding, and because they
/// are kept to the range of the vertices' depths, which the snapped vertices may leave.
fn slack(t: &ScreenTriangle) -> f64 {
    let depths = corners(t).map(|p| on_plane(t, p));
    let (min, max) = (f64::from(t.depth_min), f64::from(t.depth_max));
    let beyond = depths.iter().fold(0.0f64, |m, &d| m.max(min - d).max(d - max));
    let [ox, oy] = t.origin().map(|o| o * SUBPIXELS);
    let reach = |v: &[i32; 3], o: i32| {
        let far = v.iter().map(|&v| f64::from(v - o).abs()).fold(0.0, f64::max);
        far / f64::from(SUBPIXELS) + 1.0
    };
    let largest = f64::from(t.depth).abs()
        + f64::from(t.depth_dx).abs() * reach(&t.x, ox)
        + f64::from(t.depth_dy).abs() * reach(&t.y, oy);
    // Two products and two sums, each off by at most half an ulp of f32.
    beyond + 2.0 * f64::from(f32::EPSILON) * largest
}

fn box_of(spans: &[Span]) -> Option<SampleRect> {
    let (first, last) = (spans.first()?, spans.last()?);
    let x0 = spans.iter().map(|s| s.x0).min()?;
    let x1 = spans.iter().map(|s| s.x1).max()?;
    Some(SampleRect { x0, y0: first.y, x1, y1: last.y + 1 })
}

/// Returns the part of a convex outline where `sign · values` is positive.
fn half(outline: &[DVec2], values: &[f64], sign: f64) -> Vec<DVec2> {
    let mut kept = Vec::new();
    for (i, (&b, &vb)) in outline.iter().zip(values).enumerate() {
        let before = if i == 0 { outline.len() - 1 } else { i - 1 };
        let (a, va) = (outline[before], values[before]);
        if (va > 0.0 && vb < 0.0) || (va < 0.0 && vb > 0.0) {
            kept.push(a + (b - a) * (va / (va - vb)));
        }
        if vb * sign >= 0.0 {
            kept.push(b);
        }
    }
    kept
}
