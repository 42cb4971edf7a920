//! One path in one band of rows: add its edges, resolve shared pixels, sum the rows.

use crate::simd::{default_level, dispatch};
use fearless_simd::prelude::*;
use fearless_simd_macros::simd;

use super::cells::{Cells, Marks};
use super::convex;
use super::edge::{BITS, Edge, ONE};
use super::outline;
use super::resolve::{Noise, Resolver};
use super::small::{self, SmallCells, Touched};
use super::sweep::{Rows, Sink, alpha, sweep};
use super::turns::is_convex;
use super::{FillRule, Options, Overlap};
use crate::curve::Contours;
use crate::raster::bands::{BAND_ROWS, CHUNK, Chunk, Edges};

/// Convex paths with this many edges are filled without cells; with more, finding the two that cross a row costs more
/// than cells do.
const SIMPLE: usize = 3;
/// The edges of one path and which of them each band needs.
#[derive(Debug)]
pub(crate) struct PathEdges {
    edges: Edges<Edge>,
    /// First row and one past the last row touched.
    pub rows: (i32, i32),
    /// First and last pixel touched.
    columns: (i32, i32),
    /// Windings cannot differ by more than one anywhere.
    convex: bool,
    /// They are few besides, and nothing has been cut off.
    pub whole: bool,
}

impl PathEdges {
    /// Creates the edges of contours within a target of the given size; a few are added to the
    /// list.
    pub fn new(contours: &Contours, width: u32, height: u32, list: &mut Vec<Edge>) -> Self {
        // A triangle is always convex.
        let points = contours.points();
        let convex = contours.iter().nth(1).is_none() && (points.len() <= 3 || is_convex(points));
        let (edges, extent) = outline::edges(contours, (width, height), convex, list);
        let whole = convex && !extent.cut && matches!(&edges, Edges::Few(_));
        let [rows, columns] = extent.pixels();
        Self { edges, rows, columns, convex, whole }
    }

    /// Returns the size of the edges that are not in the list, in bytes.
    pub fn bytes(&self) -> u64 {
        self.edges.bytes()
    }

    /// Returns whether the path touches no row of the band that starts at row `top`.
    pub fn misses(&self, top: i32) -> bool {
        self.rows.0 >= top + BAND_ROWS || self.rows.1 <= top
    }

    /// Returns the path with the list it was made with.
    pub fn with<'a>(&'a self, list: &'a [Edge]) -> Path<'a> {
        Path { path: self, list }
    }
}

/// The edges of a path that is added in parts of some contours each; the parts need not be kept.
#[derive(Debug)]
pub(crate) struct PartsOfPath {
    chunks: Vec<Chunk<Edge>>,
    extent: outline::Extent,
}

impl PartsOfPath {
    /// Begins without parts.
    pub fn new() -> Self {
        Self { chunks: Vec::new(), extent: outline::Extent::NONE }
    }

    /// Adds the edges of contours within a target of the given size; returns their size in bytes.
    pub fn add(&mut self, contours: &Contours, (width, height): (u32, u32)) -> u64 {
        let size = outline::size(width, height);
        let (chunks, extent) = outline::chunks(contours, size, false, CHUNK);
        self.extent.join(extent);
        let bytes = chunks.iter().map(Chunk::bytes).sum();
        self.chunks.extend(chunks);
        bytes
    }

    /// Returns the path of all parts; a few edges are added to the list.
    pub fn path(self, list: &mut Vec<Edge>) -> PathEdges {
        let edges = Edges::from_chunks(self.chunks, list, Edge::rows);
        let [rows, columns] = self.extent.pixels();
        PathEdges { edges, rows, columns, convex: false, whole: false }
    }
}

/// A path and the list that its edges may be in.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Path<'a> {
    path: &'a PathEdges,
    list: &'a [Edge],
}

impl Path<'_> {
    /// Returns the first row and one past the last.
    pub fn rows(&self) -> (i32, i32) {
        self.path.rows
    }

    /// Returns the rows within the band at row `top`, counted from there.
    fn rows_of_band(&self, top: i32) -> (i32, i32) {
        let (first, end) = self.path.rows;
        ((first - top).max(0), (end - top).min(BAND_ROWS))
    }

    /// Returns the edges of the band at row `top` in the order of the path, perhaps with others
    /// too.
    #[inline(always)]
    fn of_band(&self, top: i32) -> impl Iterator<Item = &[Edge]> {
        self.path.edges.of_band(self.list, top)
    }
}

/// The buffers for filling paths in a band; used again for the next path and band.
#[derive(Debug, Default)]
pub(crate) struct BandFiller {
    cells: Cells,
    /// Cells for small convex paths.
    small: SmallCells,
    resolver: Resolver,
    width: usize,
}

impl BandFiller {
    /// Creates buffers for rows of `width` pixels.
    pub fn new(width: u32) -> Self {
        let (small, resolver) = (SmallCells::default(), Resolver::default());
        Self { cells: Cells::new(width), small, resolver, width: width as usize }
    }

    /// Adds the edges of a path to the cells; returns whether there are pixels that have to be resolved.
    #[simd]
    fn collect<S: Simd>(
        simd: S,
        this: &mut Self,
        path: Path<'_>,
        top: i32,
        overlap: Overlap,
    ) -> bool {
        let Self { cells, resolver, .. } = this;
        cells.lay_out(path.path.columns);
        let x = (cells.first() as i32) << BITS;
        cells.any_shared = 0;
        let exact = overlap != Overlap::Accumulated;
        let mut edges = 0;
        for some in path.of_band(top) {
            edges += some.len() as u32;
            for edge in some {
                cells.add(simd, &edge.moved(x), top, exact);
            }
        }
        Cells::flush(simd, cells, exact);
        let any = cells.any_shared != 0;
        let noise = match overlap {
            Overlap::Exact => Noise::Resolved,
            Overlap::Measured => Noise::Measured { edges },
            Overlap::Adaptive | Overlap::Accumulated => Noise::Left { edges },
        };
        let shared = if any { resolver.begin(cells, path.rows_of_band(top), noise) } else { 0 };
        if shared != 0 {
            let marks = |row: i32| cells.marks_of(row);
            let edges = path.of_band(top).flatten();
            edges.for_each(|edge| resolver.add(&edge.moved(x), top, shared, marks));
        }
        shared != 0
    }

    /// Fills one path: hands the coverage of its rows, from the top, to the sink.
    #[simd]
    pub fn fill<S: Simd, K: Sink<S>>(
        simd: S,
        this: &mut Self,
        path: Path<'_>,
        top: i32,
        &Options { rule, overlap }: &Options,
        sink: &mut K,
    ) {
        let &PathEdges { ref edges, rows, columns, convex, whole } = path.path;
        if let (true, Edges::Few(range)) = (whole, edges) {
            let own = path.list.get(range.start as usize..range.end as usize).unwrap_or_default();
            if columns.1 - columns.0 <= small::WIDEST {
                let touched = Touched { rows, columns };
                return small::fill(simd, &mut this.small, own, touched, top, sink);
            } else if own.len() <= SIMPLE {
                return convex::fill(simd, own, rows, top, this.width, sink);
            }
        }
        // Nothing of a convex path overlaps.
        let overlap = if convex { Overlap::Accumulated } else { overlap };
        let resolved = Self::collect(simd, this, path, top, overlap);
        let Self { cells, resolver, width, .. } = this;
        let at = Rows { rows: path.rows_of_band(top), width: *width, rule };
        sweep(simd, cells, at, resolved.then_some(resolver), sink);
    }

    /// Fills one face of a partition: calls `add(row of the band, pixel, area)` with the area of each
    /// pixel, 0 … 65,536.
    pub fn areas(&mut self, path: Path<'_>, top: i32, mut add: impl FnMut(i32, usize, i32)) {
        let width = self.width;
        dispatch!(default_level(), simd => Self::collect(simd, self, path, top, Overlap::Accumulated));
        let rows = path.rows_of_band(top);
        for row in rows.0..rows.1 {
            let start = self.cells.first();
            let (cells, marks) = self.cells.row(row);
            let mut sum = 0_i32;
            for (x, cell) in (start..).zip(&mut *cells) {
                sum = sum.wrapping_add(std::mem::take(cell));
                let area = sum.saturating_abs().min(ONE);
                if area != 0 && x < width {
                    add(row, x, area);
                }
            }
            // Right of the last cell the sum stays as it is.
            let area = sum.saturating_abs().min(ONE);
            for x in start + cells.len()..if area == 0 { 0 } else { width } {
                add(row, x, area);
            }
            marks.fill(Marks::default());
        }
    }
}

/// Returns the coverage 0 … 255 of an area 0 … 65,536.
pub(crate) fn coverage_of_area(area: i32) -> u8 {
    alpha(area, FillRule::NonZero)
}
