//! The triangles that a scan line crosses: y-buckets and the active list of all scan-line methods.

use crate::raster::triangle::edge_walking::RowWalk;
use crate::view::View;
use crate::visibility::surface::setup::ScreenTriangle;

/// A triangle that the current scan line crosses.
#[derive(Debug, Clone, Copy)]
pub struct Active {
    /// Index into the list of triangles.
    pub triangle: u32,
    /// First column whose centre is covered; within the window.
    pub x0: i32,
    /// The column after the last; the span is empty if `x0 ≥ x1`.
    pub x1: i32,
    walk: RowWalk,
}

/// List of active triangles, followed down the screen; visits each row once.
///
/// Triangles wait sorted by their first row instead of in one bucket per row, so that memory grows
/// with the triangles and not with the picture's height.
pub struct ActiveList<'a> {
    triangles: &'a [ScreenTriangle],
    /// The first column of the window, and the one after the last.
    columns: [i64; 2],
    /// First row in the upper half, index of the triangle in the lower.
    waiting: Vec<u64>,
    next: usize,
    active: Vec<Active>,
}

impl<'a> ActiveList<'a> {
    /// Bytes for each triangle that waits.
    pub const PER_TRIANGLE: u64 = size_of::<u64>() as u64;

    /// Sorts the triangles by their first row in the window of a view.
    pub fn new(triangles: &'a [ScreenTriangle], view: &View) -> Self {
        let window = view.window();
        let mut waiting: Vec<u64> = Vec::with_capacity(triangles.len());
        for (index, t) in triangles.iter().enumerate() {
            let Some([_, y0, _, y1]) = t.pixel_bounds(0) else { continue };
            if y1 >= window.y0() && y0 < window.y1() {
                waiting.push((y0.max(window.y0()) as u64) << 32 | index as u64);
            }
        }
        waiting.sort_unstable();
        let columns = [window.x0(), window.x1()].map(i64::from);
        Self { triangles, columns, waiting, next: 0, active: Vec::new() }
    }

    /// Returns the bytes of the active list.
    pub fn bytes(&self) -> u64 {
        (self.active.capacity() * size_of::<Active>()) as u64
    }

    /// Advances to row `y`; rows come in order from the window's first.
    ///
    /// Calls `enter` for each triangle that begins; the earlier ones keep their order.
    pub fn advance(&mut self, y: i32, mut enter: impl FnMut(&Active)) -> &[Active] {
        let Self { triangles, columns, active, .. } = self;
        active.retain_mut(|a| {
            let goes_on = a.walk.advance(y, || triangles[a.triangle as usize].snapped());
            a.set_span(*columns);
            goes_on
        });
        while let Some(&key) = self.waiting.get(self.next)
            && (key >> 32) as i64 <= i64::from(y)
        {
            self.next += 1;
            let triangle = key as u32;
            let snapped = self.triangles[triangle as usize].snapped();
            if let Some((walk, _)) = RowWalk::start(&snapped, y) {
                let mut new = Active { triangle, x0: 0, x1: 0, walk };
                new.set_span(self.columns);
                enter(&new);
                self.active.push(new);
            }
        }
        &self.active
    }
}

impl Active {
    #[inline(always)]
    fn set_span(&mut self, [first, end]: [i64; 2]) {
        [self.x0, self.x1] = self.walk.span().map(|x| x.clamp(first, end) as i32);
    }
}
