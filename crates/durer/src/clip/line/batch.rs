//! Many segments against one rectangle: Liang–Barsky without branches, several segments at a time.
//!
//! Segments lie in four arrays, one per coordinate, so that the lanes of a vector register hold the same coordinate of
//! several segments; segments with different outcomes then cost the same, while a scalar clipper loses most of its time
//! to mispredicted branches. Lanes that rounding could have decided wrongly, or that are not finite, are clipped again
//! one by one, so every result is that of [`liang_barsky::clip`] bit for bit, at every SIMD level and number of
//! threads.
//!
//! Cost: O(n); about ten arithmetic instructions and two divisions per end and vector.

use super::{Segment, liang_barsky};
use crate::info::{Class, Info, Occluder};
use crate::math::{DVec2, Rect};
use crate::simd::{Level, default_level, dispatch};
use crate::trace::NoTrace;
use crate::{Error, Result};
use fearless_simd::prelude::*;
use fearless_simd_macros::simd;

/// The facts of clipping in batches.
pub const INFO: Info = Info {
    name: "batch",
    title: "Liang–Barsky in batches",
    authors: "You-Dong Liang, Brian A. Barsky",
    year: 1984,
    source: "A new concept and method for line clipping, ACM Transactions on Graphics 3(1); \
             without branches, in vectors",
    class: Class::ObjectSpace,
    occluder: Occluder::None,
    coherence: &[],
    cost: "O(n) for n segments; about ten instructions and two divisions per end and vector",
    limits: "rectangles",
    pseudocode: &[],
};

/// Segments as four arrays of one length; segment i is (x0\[i\], y0\[i\]) → (x1\[i\], y1\[i\]).
#[derive(Debug, Clone, Copy)]
pub struct Segments<'a> {
    /// x of the starts.
    pub x0: &'a [f64],
    /// y of the starts.
    pub y0: &'a [f64],
    /// x of the ends.
    pub x1: &'a [f64],
    /// y of the ends.
    pub y1: &'a [f64],
}

/// Options for the work; no choice changes a bit of the result.
#[derive(Debug, Clone, Copy)]
pub struct Options {
    /// Instructions to use; the best the machine has by default.
    pub level: Level,
    /// True to share the work among the threads of the current rayon pool.
    pub threads: bool,
}

impl Default for Options {
    fn default() -> Self {
        Self { level: default_level(), threads: true }
    }
}

/// The result of a batch, in the order of the input; reuse it to spare the allocation.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Clipped {
    /// x of the starts; the input's for segments that are not accepted, as for the fields below.
    pub x0: Vec<f64>,
    /// y of the starts.
    pub y0: Vec<f64>,
    /// x of the ends.
    pub x1: Vec<f64>,
    /// y of the ends.
    pub y1: Vec<f64>,
    /// Bit i % 64 of word i / 64 tells whether segment i meets the window.
    pub accepted: Vec<u64>,
    /// The segments with a NaN or infinite coordinate, ascending; none of them is accepted.
    pub non_finite: Vec<usize>,
}

impl Clipped {
    /// Returns whether segment `index` meets the window.
    pub fn is_accepted(&self, index: usize) -> bool {
        self.accepted.get(index / 64).is_some_and(|word| word >> (index % 64) & 1 == 1)
    }

    /// Returns the accepted segments, each with its index in the input.
    pub fn iter(&self) -> impl Iterator<Item = (usize, Segment<DVec2>)> + '_ {
        let point = |x: &[f64], y: &[f64], i: usize| DVec2::new(x[i], y[i]);
        (0..self.x0.len()).filter(|&i| self.is_accepted(i)).map(move |i| {
            let segment = Segment::new(point(&self.x0, &self.y0, i), point(&self.x1, &self.y1, i));
            (i, segment)
        })
    }

    /// Drops the segments that are not accepted and returns the indices in the input of the others.
    ///
    /// Afterwards every entry is accepted and [`Clipped::non_finite`] still speaks of the input.
    pub fn compact(&mut self) -> Vec<usize> {
        let kept: Vec<usize> = (0..self.x0.len()).filter(|&i| self.is_accepted(i)).collect();
        for array in [&mut self.x0, &mut self.y0, &mut self.x1, &mut self.y1] {
            for (to, &from) in kept.iter().enumerate() {
                array[to] = array[from];
            }
            array.truncate(kept.len());
        }
        self.accepted.clear();
        self.accepted.resize(kept.len().div_ceil(64), u64::MAX);
        if let Some(last) = self.accepted.last_mut()
            && !kept.len().is_multiple_of(64)
        {
            *last = (1 << (kept.len() % 64)) - 1;
        }
        kept
    }

    fn resize(&mut self, n: usize) {
        for array in [&mut self.x0, &mut self.y0, &mut self.x1, &mut self.y1] {
            array.resize(n, 0.0);
        }
        self.accepted.resize(n.div_ceil(BLOCK), 0);
        self.non_finite.clear();
    }
}

/// Segments clipped at a time: one word of the accept mask.
const BLOCK: usize = 64;
/// Number of segments handed to a thread at a time: 2 MiB of input and output, which makes the cost of handing over
/// negligible.
#[cfg(feature = "parallel")]
const CHUNK: usize = 512 * BLOCK;

/// Clips all segments against the closed rectangle.
///
/// ```
/// use durer::clip::line::batch::{Clipped, Options, Segments, clip};
/// use durer::math::{DVec2, Rect};
///
/// let window = Rect::new(DVec2::ZERO, DVec2::ONE)?;
/// let segments =
///     Segments { x0: &[-1.0, 2.0], y0: &[0.5, 0.5], x1: &[0.5, 3.0], y1: &[0.5, f64::NAN] };
/// let mut clipped = Clipped::default();
/// clip(&window, segments, &Options::default(), &mut clipped)?;
/// assert_eq!((clipped.x0[0], clipped.accepted[0], &clipped.non_finite[..]), (0.0, 0b01, &[1][..]));
/// # Ok::<(), durer::Error>(())
/// ```
///
/// # Errors
/// [`Error::Parameter`] if the arrays differ in length. Non-finite segments are no error here:
/// they are listed in the result.
pub fn clip(
    window: &Rect,
    segments: Segments<'_>,
    options: &Options,
    out: &mut Clipped,
) -> Result<()> {
    let n = segments.x0.len();
    let lengths = [segments.y0.len(), segments.x1.len(), segments.y1.len()];
    if lengths != [n; 3] {
        let value = format!("{n}, {lengths:?}");
        return Err(Error::parameter("coordinate arrays' lengths", value, "all the same"));
    }
    out.resize(n);
    let Clipped { x0, y0, x1, y1, accepted, non_finite } = out;
    let slot = Slot { x: [x0, y0, x1, y1], accepted };
    let input = [segments.x0, segments.y0, segments.x1, segments.y1];
    #[cfg(feature = "parallel")]
    if options.threads && n > CHUNK {
        *non_finite = on_threads(window, input, options.level, slot);
        return Ok(());
    }
    clip_range(options.level, window, input, slot, 0, non_finite);
    Ok(())
}

/// The part of the output that one call fills.
struct Slot<'a> {
    x: [&'a mut [f64]; 4],
    accepted: &'a mut [u64],
}

#[cfg(feature = "parallel")]
fn on_threads(window: &Rect, input: [&[f64]; 4], level: Level, slot: Slot<'_>) -> Vec<usize> {
    use rayon::prelude::*;
    let [x0, y0, x1, y1] = slot.x;
    let outputs = (x0.par_chunks_mut(CHUNK), y0.par_chunks_mut(CHUNK))
        .into_par_iter()
        .zip((x1.par_chunks_mut(CHUNK), y1.par_chunks_mut(CHUNK)).into_par_iter())
        .zip(slot.accepted.par_chunks_mut(CHUNK / BLOCK));
    let lists: Vec<Vec<usize>> = outputs
        .enumerate()
        .map(|(i, (((x0, y0), (x1, y1)), accepted))| {
            let first = i * CHUNK;
            let part = input.map(|a| &a[first..(first + CHUNK).min(a.len())]);
            let mut non_finite = Vec::new();
            let slot = Slot { x: [x0, y0, x1, y1], accepted };
            clip_range(level, window, part, slot, first, &mut non_finite);
            non_finite
        })
        .collect();
    lists.concat()
}

/// Clips one range; `first` is the index of its first segment in the whole batch.
fn clip_range(
    level: Level,
    window: &Rect,
    input: [&[f64]; 4],
    slot: Slot<'_>,
    first: usize,
    non_finite: &mut Vec<usize>,
) {
    let Slot { x: mut output, accepted } = slot;
    let doubtful = |block: usize, doubt: u64, word: &mut u64, out: &mut [&mut [f64]; 4]| {
        let mut left = doubt;
        while left != 0 {
            let lane = left.trailing_zeros() as usize;
            left &= left - 1;
            let i = block * BLOCK + lane;
            if !clip_one(window, input, out, i, lane, word) {
                non_finite.push(first + i);
            }
        }
    };
    dispatch!(level, simd => range_kernel(simd, window, input, &mut output, accepted, doubtful));
}

/// Clips segment i by the scalar algorithm; returns whether its coordinates are finite.
fn clip_one(
    window: &Rect,
    input: [&[f64]; 4],
    output: &mut [&mut [f64]; 4],
    i: usize,
    lane: usize,
    word: &mut u64,
) -> bool {
    let [x0, y0, x1, y1] = input.map(|a| a[i]);
    let segment = Segment::new(DVec2::new(x0, y0), DVec2::new(x1, y1));
    let clipped = liang_barsky::clip(window, segment, &mut NoTrace);
    let kept = clipped.as_ref().ok().copied().flatten();
    let Segment { start, end } = kept.unwrap_or(segment);
    for (array, v) in output.iter_mut().zip([start.x, start.y, end.x, end.y]) {
        array[i] = v;
    }
    *word = *word & !(1 << lane) | u64::from(kept.is_some()) << lane;
    clipped.is_ok()
}

/// Clips block after block; `doubtful` mends the lanes named in its second argument.
#[simd]
fn range_kernel<S: Simd>(
    simd: S,
    window: &Rect,
    input: [&[f64]; 4],
    output: &mut [&mut [f64]; 4],
    accepted: &mut [u64],
    mut doubtful: impl FnMut(usize, u64, &mut u64, &mut [&mut [f64]; 4]),
) {
    let borders = Borders::new(simd, window);
    let blocks = input.map(|a| a.as_chunks::<BLOCK>());
    for (block, word) in accepted.iter_mut().enumerate() {
        let slots = output.each_mut().map(|a| a.as_chunks_mut::<BLOCK>());
        let [x0, y0, x1, y1] = slots;
        let (accept, doubt) = match (
            x0.0.get_mut(block),
            y0.0.get_mut(block),
            x1.0.get_mut(block),
            y1.0.get_mut(block),
        ) {
            (Some(x0), Some(y0), Some(x1), Some(y1)) => {
                block_kernel(simd, &borders, blocks.map(|a| &a.0[block]), [x0, y0, x1, y1])
            }
            // The last segments of a batch, in a block that is filled up with points.
            _ => {
                let filled = blocks.map(|a| filled(a.1));
                let mut clipped = [[0.0; BLOCK]; 4];
                let [cx0, cy0, cx1, cy1] = &mut clipped;
                let found = block_kernel(simd, &borders, filled.each_ref(), [cx0, cy0, cx1, cy1]);
                for (to, from) in [x0.1, y0.1, x1.1, y1.1].into_iter().zip(&clipped) {
                    to.copy_from_slice(&from[..to.len()]);
                }
                let real = (1 << blocks[0].1.len()) - 1;
                (found.0 & real, found.1 & real)
            }
        };
        *word = accept;
        if doubt != 0 {
            doubtful(block, doubt, word, output);
        }
    }
}

/// Returns the numbers, and zeros behind them.
fn filled(some: &[f64]) -> [f64; BLOCK] {
    let mut block = [0.0; BLOCK];
    block[..some.len()].copy_from_slice(some);
    block
}

/// Clips 64 segments; the bits of those accepted and of those in doubt.
#[simd]
fn block_kernel<S: Simd>(
    simd: S,
    borders: &Borders<S>,
    [x0, y0, x1, y1]: [&[f64; BLOCK]; 4],
    [out_x0, out_y0, out_x1, out_y1]: [&mut [f64; BLOCK]; 4],
) -> (u64, u64) {
    let (mut accept, mut doubt) = (0, 0);
    let at_once = size_of::<S::f64s>() / size_of::<f64>();
    for i in (0..BLOCK).step_by(at_once) {
        let part = i..i + at_once;
        let (x0, y0) = (&x0[part.clone()], &y0[part.clone()]);
        let (x1, y1) = (&x1[part.clone()], &y1[part.clone()]);
        let start = [S::f64s::from_slice(simd, x0), S::f64s::from_slice(simd, y0)];
        let end = [S::f64s::from_slice(simd, x1), S::f64s::from_slice(simd, y1)];
        let lanes = clip_lanes(simd, borders, start, end);
        lanes.x[0].store_slice(&mut out_x0[part.clone()]);
        lanes.x[1].store_slice(&mut out_y0[part.clone()]);
        lanes.x[2].store_slice(&mut out_x1[part.clone()]);
        lanes.x[3].store_slice(&mut out_y1[part]);
        accept |= lanes.accept << i;
        doubt |= lanes.doubt << i;
    }
    (accept, doubt)
}

/// The window's borders in every lane.
struct Borders<S: Simd> {
    left: S::f64s,
    right: S::f64s,
    bottom: S::f64s,
    top: S::f64s,
}

impl<S: Simd> Borders<S> {
    fn new(simd: S, window: &Rect) -> Self {
        // Adding zero turns −0 into 0, as in the scalar clippers.
        let splat = |v: f64| S::f64s::splat(simd, v + 0.0);
        let (min, max) = (window.min(), window.max());
        Self { left: splat(min.x), right: splat(max.x), bottom: splat(min.y), top: splat(max.y) }
    }
}

/// The clipped segments of a vector.
struct Lanes<S: Simd> {
    x: [S::f64s; 4],
    accept: u64,
    doubt: u64,
}

/// Smallest product of distances without underflow, exact up to relative rounding errors.
const LEAST_PRODUCT: f64 = 1e-280;
/// See [`LEAST_PRODUCT`].
const GREATEST_PRODUCT: f64 = 1e300;
/// Bound on the rounding errors of the coordinates of cut points, including the error from a wrong order of two
/// borders; the one that [`super::border`] uses.
const POINT_DOUBT: f64 = 16.0 * crate::clip::exact::EPSILON;

#[simd]
fn clip_lanes<S: Simd>(
    simd: S,
    w: &Borders<S>,
    [x0, y0]: [S::f64s; 2],
    [x1, y1]: [S::f64s; 2],
) -> Lanes<S> {
    // Canonical direction: p is the lexicographically smaller end, so the segment goes right.
    let swap = x0.simd_gt(x1) | (x0.simd_eq(x1) & y0.simd_gt(y1));
    let (px, qx) = (swap.select(x1, x0), swap.select(x0, x1));
    let (py, qy) = (swap.select(y1, y0), swap.select(y0, y1));
    let (dx, dy) = (qx - px, qy - py);
    let rise = dy.abs();

    // Distances along each axis from p to the border entered and the border left; the ends' own
    // sides of them are exact comparisons.
    let down = py.simd_gt(qy);
    let (entry_y, exit_y) = (down.select(w.top, w.bottom), down.select(w.bottom, w.top));
    let (enter_x, leave_x) = (w.left - px, w.right - px);
    let (enter_y, leave_y) = ((entry_y - py).abs(), (exit_y - py).abs());
    // An end beyond the border on its own side of the segment is cut there. An end beyond the border on the other end's
    // side means that the whole segment is beyond it; the other results are then not used.
    let (p_out_x, q_out_x) = (px.simd_lt(w.left), qx.simd_gt(w.right));
    let (p_below, p_above) = (py.simd_lt(w.bottom), py.simd_gt(w.top));
    let (q_below, q_above) = (qy.simd_lt(w.bottom), qy.simd_gt(w.top));
    let (p_out_y, q_out_y) = (p_below | p_above, q_below | q_above);
    let beyond =
        qx.simd_lt(w.left) | px.simd_gt(w.right) | (p_below & q_below) | (p_above & q_above);

    // t of x borders against t of y borders, both multiplied by dx · |dy|.
    let (enter_tx, leave_tx) = (enter_x * rise, leave_x * rise);
    let (enter_ty, leave_ty) = (enter_y * dx, leave_y * dx);
    let enters_by_x = p_out_x & (!p_out_y | enter_tx.simd_gt(enter_ty));
    let leaves_by_x = q_out_x & (!q_out_y | leave_tx.simd_lt(leave_ty));
    let (x_then_y, y_then_x) = (p_out_x & q_out_y, p_out_y & q_out_x);
    let misses = (x_then_y & enter_tx.simd_gt(leave_ty)) | (y_then_x & enter_ty.simd_gt(leave_tx));
    // Rounding decides an order wrongly only where the parameters differ by 6 ulp halves of them. The
    // cut is then as near to a corner, and in doubt for that; but not where products left the
    // range in which rounding is relative.
    let product = dx * rise;
    let ordered = product.simd_gt(S::f64s::splat(simd, LEAST_PRODUCT))
        & product.simd_lt(S::f64s::splat(simd, GREATEST_PRODUCT));
    let doubt_order = !ordered & (p_out_x | q_out_x) & (p_out_y | q_out_y);

    // The two cut points; near a corner the scalar clipper must decide their sides.
    let line = Lines { p: [px, py], d: [dx, dy], size: [px.abs() + qx.abs(), py.abs() + qy.abs()] };
    let entry = line.cut(simd, w, enters_by_x, (enter_x, w.left), (entry_y - py, entry_y));
    let exit = line.cut(simd, w, leaves_by_x, (leave_x, w.right), (exit_y - py, exit_y));
    let (p_out, q_out) = (p_out_x | p_out_y, q_out_x | q_out_y);
    let rejected = beyond | misses;
    let infinite = {
        // Differences are finite only if both numbers are.
        let zero = (dx + dy) * 0.0;
        !zero.simd_eq(S::f64s::splat(simd, 0.0))
    };
    let doubt_points = (p_out & entry.doubt) | (q_out & exit.doubt);
    let doubt = infinite | (!beyond & (doubt_order | doubt_points));

    // Ends that are inside, and segments that are rejected, keep their bits.
    let (cut_p, cut_q) = (p_out & !rejected, q_out & !rejected);
    let (px, py) = (cut_p.select(entry.x, px), cut_p.select(entry.y, py));
    let (qx, qy) = (cut_q.select(exit.x, qx), cut_q.select(exit.y, qy));
    Lanes {
        x: [swap.select(qx, px), swap.select(qy, py), swap.select(px, qx), swap.select(py, qy)],
        accept: (!rejected).to_bitmask(),
        doubt: doubt.to_bitmask(),
    }
}

/// Canonical segments: first end, difference of the ends, sum of the coordinates' sizes.
struct Lines<S: Simd> {
    p: [S::f64s; 2],
    d: [S::f64s; 2],
    size: [S::f64s; 2],
}

/// A cut point in each lane, and whether it is too near a corner to be sure of it.
struct CutLanes<S: Simd> {
    x: S::f64s,
    y: S::f64s,
    doubt: S::mask64s,
}

impl<S: Simd> Lines<S> {
    /// Returns the crossing with an x border where `by_x`, else with a y border; each is given as
    /// its signed distance from p and its coordinate.
    #[inline(always)]
    fn cut(
        &self,
        _simd: S,
        w: &Borders<S>,
        by_x: S::mask64s,
        x: (S::f64s, S::f64s),
        y: (S::f64s, S::f64s),
    ) -> CutLanes<S> {
        let t = by_x.select(x.0, y.0) / by_x.select(self.d[0], self.d[1]);
        let along = by_x.select(self.d[1], self.d[0]) * t;
        let other = by_x.select(self.p[1], self.p[0]) + along;
        let margin = by_x.select(self.size[1], self.size[0]) * POINT_DOUBT + 1e-290;
        let (min, max) = (by_x.select(w.bottom, w.left), by_x.select(w.top, w.right));
        // If a segment misses the window, its cut is beyond a border, but not near it either.
        let doubt = !((other - min).abs().simd_gt(margin) & (max - other).abs().simd_gt(margin));
        CutLanes { x: by_x.select(x.1, other), y: by_x.select(other, y.1), doubt }
    }
}
