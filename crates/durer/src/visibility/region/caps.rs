//! Which faces can have to do with what is seen of a section's caps: the caps, and what reaches before them.
//!
//! Over a grid of cells it is known how far the farthest cap reaches, and of ever larger cells the farthest
//! of all in them (a hierarchical z-buffer, after Greene, Kass and Miller 1993, of farthest depths). A face
//! that lies behind that in the few cells that its bounds touch hides no cap. O(n) for n faces.

use super::Options;
use super::weiler_atherton::edges::CLEARLY;
use super::weiler_atherton::faces::{Face, Frame, Place, Projector, float, surfaces};
use crate::Result;
use crate::math::DVec2;
use crate::scene::Scene;
use crate::view::View;

/// Cells along the longer side of what the caps span.
const CELLS: u64 = 256;

/// The caps of a scene in the picture, and the faces that may hide some of them.
pub fn with_what_may_hide_them(
    scene: &Scene,
    view: &View,
    frame: &Frame,
    options: &Options,
) -> Result<Vec<Face>> {
    let Some(material) = options.cap_material else { return Ok(Vec::new()) };
    let (caps, others): (Vec<_>, Vec<_>) =
        surfaces(scene)?.into_iter().partition(|run| run.material == Some(material));
    let mut projector = Projector::new(scene, view, frame, options.cull);
    let mut faces = Vec::new();
    caps.iter().for_each(|run| projector.project(run, |face| faces.push(face)));
    let Some(farthest) = Farthest::new(&faces) else { return Ok(faces) };
    for run in &others {
        projector.project(run, |face| {
            if farthest.may_be_hidden_by(&face) {
                faces.push(face);
            }
        });
    }
    Ok(faces)
}

/// How far the caps reach.
struct Farthest {
    /// What the caps span; the grid begins at its lower left corner.
    min: Place,
    max: Place,
    /// Cells of the finest level are 2^shift grid steps wide and high.
    shift: u32,
    /// Depths by cell, from the finest level to the one of a single cell.
    levels: Vec<Level>,
}

struct Level {
    columns: usize,
    rows: usize,
    depths: Vec<f64>,
}

impl Farthest {
    /// `None` where there are no caps.
    fn new(caps: &[Face]) -> Option<Self> {
        let mut boxes = caps.iter().map(Face::bounds);
        let first = boxes.next()?;
        let (min, max) = boxes.fold(first, |(lo, hi), (min, max)| {
            let lo = Place { x: lo.x.min(min.x), y: lo.y.min(min.y) };
            (lo, Place { x: hi.x.max(max.x), y: hi.y.max(max.y) })
        });
        let span = |a: i32, b: i32| (i64::from(b) - i64::from(a)) as u64;
        let (width, height) = (span(min.x, max.x), span(min.y, max.y));
        let shift = (width.max(height) / CELLS + 1).next_power_of_two().ilog2();
        let (columns, rows) = ((width >> shift) as usize + 1, (height >> shift) as usize + 1);
        let finest = Level { columns, rows, depths: vec![f64::NEG_INFINITY; columns * rows] };
        let mut farthest = Self { min, max, shift, levels: vec![finest] };
        caps.iter().for_each(|cap| farthest.enter(cap));
        while let Some(coarser) = farthest.levels.last().and_then(Level::coarser) {
            farthest.levels.push(coarser);
        }
        Some(farthest)
    }

    fn enter(&mut self, cap: &Face) {
        let ((left, bottom), (right, top)) = self.cells(cap.bounds());
        let size = (1u64 << self.shift) as f64;
        for row in bottom..=top {
            let Some((from, to)) = self.span(cap, row) else { continue };
            for column in from.max(left)..=to.min(right) {
                let corner = float(self.min) + DVec2::new(column as f64, row as f64) * size;
                let rise = (cap.plane.slope * size).max(DVec2::ZERO).element_sum();
                let far = (cap.plane.depth(corner) + rise).min(cap.far) + CLEARLY * cap.error;
                let level = &mut self.levels[0];
                let depth = &mut level.depths[row * level.columns + column];
                *depth = depth.max(far);
            }
        }
    }

    /// The first and the last column of a row of cells that a face may touch.
    fn span(&self, face: &Face, row: usize) -> Option<(usize, usize)> {
        let size = (1u64 << self.shift) as f64;
        // A step of margin makes up for rounding.
        let bottom = f64::from(self.min.y) + row as f64 * size - 1.0;
        let top = bottom + size + 2.0;
        let (mut from, mut to) = (f64::INFINITY, f64::NEG_INFINITY);
        for (a, b) in face.sides() {
            let (a, b) = if a.y <= b.y { (float(a), float(b)) } else { (float(b), float(a)) };
            if b.y < bottom || a.y > top {
                continue;
            }
            for y in [bottom.max(a.y), top.min(b.y)] {
                let flat = b.y == a.y;
                let ends = if flat {
                    [a.x, b.x]
                } else {
                    [a.x + (b.x - a.x) * ((y - a.y) / (b.y - a.y)); 2]
                };
                from = from.min(ends[0].min(ends[1]));
                to = to.max(ends[0].max(ends[1]));
            }
        }
        let column = |x: f64| ((x - f64::from(self.min.x)) / size).max(0.0) as usize;
        (from <= to).then(|| (column(from - 1.0), column(to + 1.0)))
    }

    /// The cells of two corners at the finest level; those outside are moved in.
    fn cells(&self, (min, max): (Place, Place)) -> ((usize, usize), (usize, usize)) {
        let index = |v: i32, low: i32, count: usize| {
            let offset = (i64::from(v) - i64::from(low)).max(0) >> self.shift;
            (offset as usize).min(count - 1)
        };
        let Level { columns, rows, .. } = self.levels[0];
        let cell = |p: Place| (index(p.x, self.min.x, columns), index(p.y, self.min.y, rows));
        (cell(min), cell(max))
    }

    /// Whether some of the caps may lie behind a face.
    fn may_be_hidden_by(&self, face: &Face) -> bool {
        let (min, max) = face.bounds();
        if max.x < self.min.x || max.y < self.min.y || min.x > self.max.x || min.y > self.max.y {
            return false;
        }
        let ((left, bottom), (right, top)) = self.cells((min, max));
        // So coarse that few cells are to be looked at.
        let wide = (right - left).max(top - bottom);
        let level = (wide.max(1).ilog2() as usize).min(self.levels.len() - 1);
        let Level { columns, depths, .. } = &self.levels[level];
        let near = face.near - CLEARLY * face.error;
        (bottom >> level..=top >> level).any(|row| {
            let cells = row * columns + (left >> level)..=row * columns + (right >> level);
            depths[cells].iter().any(|&far| near < far)
        })
    }
}

impl Level {
    /// The level of cells twice as wide and high; `None` above the last.
    fn coarser(&self) -> Option<Self> {
        if self.depths.len() < 2 {
            return None;
        }
        let (columns, rows) = (self.columns.div_ceil(2), self.rows.div_ceil(2));
        let mut depths = vec![f64::NEG_INFINITY; columns * rows];
        for (i, &depth) in self.depths.iter().enumerate() {
            let (column, row) = (i % self.columns / 2, i / self.columns / 2);
            let coarse = &mut depths[row * columns + column];
            *coarse = coarse.max(depth);
        }
        Some(Self { columns, rows, depths })
    }
}
