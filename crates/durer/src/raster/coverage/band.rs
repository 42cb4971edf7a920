//! One path in one band of rows: add its edges, resolve shared pixels, sum the rows.

use fearless_simd::prelude::*;
use fearless_simd_macros::simd;

use super::FillRule;
use super::cells::{BAND_ROWS, Cells, Marks};
use super::edge::{BITS, Edge, EdgeBuilder, ONE};
use super::resolve::Resolver;
use super::sweep::{Run, alpha, sweep};
use crate::curve::Contours;

/// Where edges touch the same pixels more often than this on average, what a pixel shows is noise;
/// the integrals are taken as they are.
const CROWDED: u64 = 6;
/// Paths with fewer edges are gone through as a whole in every band.
const FEW_EDGES: usize = 48;

/// The edges of one path and which of them each band needs.
#[derive(Debug, Clone, Default)]
pub(crate) struct PathEdges {
    edges: Vec<Edge>,
    /// First row and one past the last row touched.
    pub rows: (i32, i32),
    /// First and last pixel touched.
    columns: (i32, i32),
    /// Indices of edges, band after band from the first one touched; empty for paths of few edges.
    by_band: Vec<u32>,
    /// Where each band's indices start.
    starts: Vec<u32>,
}

impl PathEdges {
    /// The edges of contours within a target of the given size.
    pub fn new(contours: &Contours, width: u32, height: u32) -> Self {
        let mut path = Self { rows: (i32::MAX, 0), columns: (i32::MAX, 0), ..Self::default() };
        path.edges.reserve(contours.points().len());
        EdgeBuilder::new(&mut path.edges, width, height).contours(contours);
        for edge in &path.edges {
            let (first, last) = edge.rows();
            path.rows = (path.rows.0.min(first), path.rows.1.max(last));
            path.columns.0 = path.columns.0.min(edge.x0.min(edge.x1) >> BITS);
            path.columns.1 = path.columns.1.max(edge.x0.max(edge.x1) >> BITS);
        }
        if path.edges.len() > FEW_EDGES {
            path.sort_into_bands();
        }
        path
    }

    fn sort_into_bands(&mut self) {
        let band = |row: i32| (row / BAND_ROWS) as usize;
        let base = band(self.rows.0);
        let bands = |e: &Edge| {
            let (first, last) = e.rows();
            band(first) - base..band((last - 1).max(first)) - base + 1
        };
        let count = band((self.rows.1 - 1).max(self.rows.0)) - base + 2;
        let mut ends = vec![0_u32; count + 1];
        for edge in &self.edges {
            bands(edge).for_each(|b| ends[b + 1] += 1);
        }
        for i in 1..ends.len() {
            ends[i] += ends[i - 1];
        }
        self.starts = ends.clone();
        self.by_band = vec![0; ends.last().copied().unwrap_or(0) as usize];
        for (i, edge) in self.edges.iter().enumerate() {
            for b in bands(edge) {
                self.by_band[ends[b] as usize] = i as u32;
                ends[b] += 1;
            }
        }
    }

    /// Whether the path touches no row of the band that starts at row `top`.
    pub fn misses(&self, top: i32) -> bool {
        self.rows.0 >= top + BAND_ROWS || self.rows.1 <= top
    }

    /// The indices of the edges of the band at row `top`; `None` = all of them.
    fn band(&self, top: i32) -> Option<&[u32]> {
        if self.starts.is_empty() {
            return None;
        }
        let band = (top / BAND_ROWS - self.rows.0 / BAND_ROWS).max(0) as usize;
        let at = |i: usize| self.starts.get(i).copied().unwrap_or(0) as usize;
        self.by_band.get(at(band)..at(band + 1))
    }

    /// Calls `f` with the edges of the band in the order of the path.
    #[inline(always)]
    fn for_each(&self, top: i32, f: impl FnMut(&Edge)) {
        match self.band(top) {
            None => self.edges.iter().for_each(f),
            Some(indices) => {
                indices.iter().filter_map(|i| self.edges.get(*i as usize)).for_each(f);
            }
        }
    }
}

/// The buffers for filling paths in a band; used again for the next path and band.
#[derive(Debug)]
pub(crate) struct BandFiller {
    cells: Cells,
    resolver: Resolver,
    width: usize,
    coverage: Vec<u32>,
    runs: Vec<Run>,
    patches: Vec<(usize, u8)>,
}

impl BandFiller {
    /// Buffers for rows of `width` pixels.
    pub fn new(width: u32) -> Self {
        Self {
            cells: Cells::new(width),
            resolver: Resolver::default(),
            width: width as usize,
            coverage: vec![0; (width as usize).next_multiple_of(64) + 64],
            runs: Vec::new(),
            patches: Vec::new(),
        }
    }

    /// Adds the edges of a path to the cells of the band that starts at row `top`; returns the
    /// path's rows within the band and its words of marks.
    fn add(&mut self, path: &PathEdges, top: i32) -> ((i32, i32), (usize, usize)) {
        let cells = &mut self.cells;
        cells.touches = 0;
        path.for_each(top, |edge| cells.add(edge, top));
        let rows = ((path.rows.0 - top).max(0), (path.rows.1 - top).min(BAND_ROWS));
        // Edges also change the two cells after the last pixel they touch.
        let last = (path.columns.1.max(0) as usize + 2).min(self.width + 2);
        let words = ((path.columns.0.max(0) >> 6) as usize, (last >> 6) + 1);
        (rows, words)
    }

    /// Fills one path: calls `paint(row of the band, runs, coverage)` for its rows from the top.
    #[simd]
    pub fn fill<S: Simd>(
        simd: S,
        this: &mut Self,
        path: &PathEdges,
        top: i32,
        rule: FillRule,
        exact: bool,
        mut paint: impl FnMut(S, i32, &[Run], &[u32]),
    ) {
        let (rows, words) = this.add(path, top);
        let shared = if exact { this.shared_rows(rows, words) } else { 0 };
        if shared != 0 {
            this.gather(path, top, shared);
        }
        for row in rows.0..rows.1 {
            this.patches.clear();
            if (shared >> row) & 1 != 0 {
                this.resolve(row, words, rule);
            }
            let (cells, marks) = this.cells.row(row);
            sweep(simd, cells, marks, words, this.width, rule, &mut this.coverage, &mut this.runs);
            for (column, value) in &this.patches {
                if let Some(lane) = this.coverage.get_mut(*column) {
                    *lane = u32::from(*value);
                }
            }
            if !this.runs.is_empty() {
                paint(simd, row, &this.runs, &this.coverage);
            }
        }
    }

    /// Rows with shared pixels, one bit each; none where the band is crowded.
    fn shared_rows(&mut self, rows: (i32, i32), words: (usize, usize)) -> u64 {
        let (mut found, mut touched) = (0, 0_u64);
        for row in rows.0..rows.1 {
            let (_, marks) = self.cells.row(row);
            for mark in &marks[words.0..words.1] {
                found |= u64::from(mark.shared != 0) << row;
                touched += u64::from(mark.touched.count_ones());
            }
        }
        if self.cells.touches > CROWDED * touched { 0 } else { found }
    }

    fn gather(&mut self, path: &PathEdges, top: i32, shared: u64) {
        let (cells, resolver) = (&self.cells, &mut self.resolver);
        let marks = |row: i32| cells.marks_of(row);
        match path.band(top) {
            None => resolver.gather(path.edges.iter(), top, shared, marks),
            Some(indices) => {
                let edges = indices.iter().filter_map(|i| path.edges.get(*i as usize));
                resolver.gather(edges, top, shared, marks);
            }
        }
    }

    /// Finds the shared pixels of a row whose coverage is not what the integral says.
    fn resolve(&mut self, row: i32, words: (usize, usize), rule: FillRule) {
        let Self { cells, resolver, patches, .. } = self;
        let (cells, _) = cells.row(row);
        let (mut at, mut sum) = (words.0 * 64, 0_i32);
        let integral = |column: usize| {
            sum = cells[at..=column].iter().fold(sum, |s, c| s.wrapping_add(*c));
            at = column + 1;
            sum
        };
        resolver.row_coverage(row, rule, integral, |x, value| patches.push((x, value)));
    }

    /// Fills one face of a partition: calls `add(row of the band, first pixel, one past the last, area)`
    /// with the area of each pixel, 0 … 65,536.
    pub fn areas(&mut self, path: &PathEdges, top: i32, mut add: impl FnMut(i32, usize, i32)) {
        let (rows, words) = self.add(path, top);
        let width = self.width;
        for row in rows.0..rows.1 {
            let (cells, marks) = self.cells.row(row);
            let mut sum = 0_i32;
            let end = self.width.max(words.0 * 64);
            for (x, cell) in cells[words.0 * 64..].iter_mut().enumerate().take(end + 64) {
                sum = sum.wrapping_add(std::mem::take(cell));
                let area = sum.saturating_abs().min(ONE);
                if area != 0 && words.0 * 64 + x < width {
                    add(row, words.0 * 64 + x, area);
                }
            }
            marks[words.0..words.1].fill(Marks::default());
        }
    }
}

/// Coverage 0 … 255 of an area 0 … 65,536.
pub(crate) fn coverage_of_area(area: i32) -> u8 {
    alpha(area, FillRule::NonZero)
}
