//! Seed fills: from one pixel to all connected pixels of its region.
//!
//! A flood fill takes the connected pixels that equal the seed, a boundary fill those that differ from a boundary
//! value. The naive form keeps a stack of pixels; the span form takes whole runs of a row and looks for runs in the
//! rows above and below (A. R. Smith, *Tint fill*, SIGGRAPH 1979; P. Heckbert, *A seed fill algorithm*, Graphics Gems,
//! 1990). A tracer sees that form; without one, runs are found 64 pixels at a time, row after row away from the seed,
//! and only parts behind a turn of the region are kept on a stack. All fill the same set; none recurses.
//!
//! Class: image space. Cost: O(n) for n filled pixels; the naive form touches each up to eight times. Stacks, and the bits
//! that mark pixels, are charged to the budget of the image.

mod region;
mod rows;
mod words;

use crate::Result;
use crate::info::{Class, Coherence, Info, Occluder, family};
use crate::target::Pixels;
use crate::trace::{PseudocodeLine, Tracer};
use crate::work::Charge;
use region::Region;

/// Neighbourhood of pixels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Connectivity {
    /// Pixels with a common side.
    #[default]
    Four,
    /// Pixels with a common side or corner.
    Eight,
}

/// Options for filling a region.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Options {
    /// Neighbourhood of pixels.
    pub connectivity: Connectivity,
    /// For [`boundary_fill`]: whether pixels that already have the new value also stop the fill, as is taught (`current
    /// ≠ boundary and current ≠ fill`). Pixels behind them are then not reached.
    pub stop_at_value: bool,
}

/// Step of the algorithm.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Step {
    /// Pixels are taken from the stack, or are the seed's, and filled.
    Fill {
        /// The pixels.
        run: FillRun,
        /// Size of the stack then: pixels of the naive form, runs of the other.
        waiting: usize,
    },
    /// Pixels are put on the stack: a neighbour, or a run beside a filled one.
    Push(FillRun),
    /// A pixel is taken from the stack that is outside, not of the region, or filled already.
    Skip(FillRun),
}

impl PseudocodeLine for Step {
    /// Returns the line of the pseudocode; it is the same in both forms.
    fn line(&self) -> usize {
        match self {
            Self::Skip(_) => 4,
            Self::Fill { .. } => 5,
            Self::Push(_) => 7,
        }
    }
}

/// Pixels of a row; runs on the stack may be outside the image.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FillRun {
    /// Row.
    pub y: i64,
    /// First pixel.
    pub x0: i64,
    /// One past the last pixel.
    pub x1: i64,
}

impl FillRun {
    fn pixel((x, y): (i64, i64)) -> Self {
        Self { y, x0: x, x1: x + 1 }
    }

    fn of((y, start, end): (usize, usize, usize)) -> Self {
        Self { y: y as i64, x0: start as i64, x1: end as i64 }
    }
}

impl Step {
    /// Returns the pixels that the step fills.
    pub fn filled(&self) -> Option<FillRun> {
        if let Self::Fill { run, .. } = *self { Some(run) } else { None }
    }
}

/// The facts of the naive form.
pub const NAIVE: Info = Info {
    name: "naive",
    title: "Seed fill with a stack of pixels",
    authors: "H. Lieberman",
    year: 1978,
    source: "How to color in a coloring book, SIGGRAPH",
    class: Class::ImageSpace,
    occluder: Occluder::None,
    coherence: &[],
    cost: "O(n) time and memory for n filled pixels",
    limits: "none",
    pseudocode: &[
        "push the seed onto the stack",
        "while the stack is not empty:",
        "    pop (x, y)",
        "    if (x, y) is outside, not of the region, or filled: continue",
        "    fill (x, y)",
        "    for each neighbour, in the reverse of the textbook order:",
        "        push it",
        "// the last one pushed is the next one popped",
    ],
};

/// The facts of the span form.
pub const INFO: Info = Info {
    name: "spans",
    title: "Seed fill by spans",
    authors: "A. R. Smith, P. Heckbert",
    year: 1979,
    source: "Tint fill, SIGGRAPH; A seed fill algorithm, Graphics Gems (1990)",
    class: Class::ImageSpace,
    occluder: Occluder::None,
    coherence: &[Coherence::Span],
    cost: "O(n) time for n filled pixels, memory for the spans at the rim",
    limits: "none",
    pseudocode: &[
        "push the run of the seed onto the stack",
        "while the stack is not empty:",
        "    pop a run",
        "    // runs were marked when they were pushed, so none comes twice",
        "    fill it",
        "    for each run of the region that touches it in the rows above and below:",
        "        mark it and push it",
        "// with eight neighbours a run also touches those at its corners",
    ],
};

family! {
    /// The seed fills.
    pub enum SeedFill {
        /// Filling with a stack of pixels.
        Naive => NAIVE,
        /// Filling by spans.
        Spans => INFO,
    }
}

/// Values of pixels that can be more or less alike.
pub trait PixelValue: Copy {
    /// Unit of differences.
    type Level: Copy + Ord + Default;
    /// Returns the largest difference of a channel.
    fn difference(self, other: Self) -> Self::Level;
    /// Returns whether it is 0, with which a channel of opacity shows nothing.
    fn is_zero(self) -> bool;
}

impl PixelValue for bool {
    type Level = u8;
    fn difference(self, other: Self) -> u8 {
        u8::from(self != other) * 255
    }
    fn is_zero(self) -> bool {
        !self
    }
}

impl PixelValue for u8 {
    type Level = u8;
    #[inline(always)]
    fn difference(self, other: Self) -> u8 {
        // Many at a time, where abs_diff would be computed in 32 bits.
        self.max(other) - self.min(other)
    }
    #[inline(always)]
    fn is_zero(self) -> bool {
        self == 0
    }
}

impl PixelValue for u16 {
    type Level = u16;
    #[inline(always)]
    fn difference(self, other: Self) -> u16 {
        self.max(other) - self.min(other)
    }
    #[inline(always)]
    fn is_zero(self) -> bool {
        self == 0
    }
}

/// Four channels are a colour with straight alpha: all fully transparent colours are equal.
impl<T: PixelValue, const N: usize> PixelValue for [T; N] {
    type Level = T::Level;
    #[inline]
    fn difference(self, other: Self) -> T::Level {
        let most = self.iter().zip(other).map(|(a, b)| (*a).difference(b)).max();
        let are_clear = N == 4 && self[N - 1].is_zero() && other[N - 1].is_zero();
        if are_clear { T::Level::default() } else { most.unwrap_or_default() }
    }
    #[inline(always)]
    fn is_zero(self) -> bool {
        self.iter().all(|channel| channel.is_zero())
    }
}

/// Fills the pixels connected with the seed whose channels differ from the seed's by at most
/// `tolerance`; returns how many were filled. A seed outside the image fills nothing.
///
/// # Errors
/// Those of [`fill_where`].
///
/// ```
/// use durer::raster::seed_fill::{Options, SeedFill, flood_fill};
/// use durer::target::Pixels;
/// use durer::trace::NoTrace;
///
/// let mut image = Pixels::from_data(3, 2, vec![0_u8, 0, 9, 9, 9, 0]).unwrap();
/// let fill = SeedFill::Spans;
/// assert_eq!(flood_fill(&mut image, (0, 0), 7, 0, fill, &Options::default(), &mut NoTrace)?, 2);
/// assert_eq!(image.data(), [7, 7, 9, 9, 9, 0]);
/// # Ok::<(), durer::Error>(())
/// ```
pub fn flood_fill<P: PixelValue>(
    image: &mut Pixels<P>,
    seed: (u32, u32),
    value: P,
    tolerance: P::Level,
    method: SeedFill,
    options: &Options,
    t: &mut impl Tracer<Step>,
) -> Result<u64> {
    let Some(like) = image.get(seed.0, seed.1) else { return Ok(0) };
    fill_where(image, seed, value, |p| p.difference(like) <= tolerance, method, options, t)
}

/// Fills the pixels connected with the seed up to a boundary: those whose channels differ from the
/// boundary's by more than `tolerance`; returns how many were filled.
///
/// # Errors
/// Those of [`fill_where`].
///
/// ```
/// use durer::raster::seed_fill::{Options, SeedFill, boundary_fill};
/// use durer::target::Pixels;
/// use durer::trace::NoTrace;
///
/// // 5 is the new value, 9 the boundary; what has the new value stops the fill if that is asked for.
/// let mut row = Pixels::from_data(7, 1, vec![0_u8, 0, 5, 0, 0, 9, 0]).unwrap();
/// let options = Options { stop_at_value: true, ..Options::default() };
/// let fill = SeedFill::Naive;
/// assert_eq!(boundary_fill(&mut row, (0, 0), 5, 9, 0, fill, &options, &mut NoTrace)?, 2);
/// assert_eq!(row.data(), [5, 5, 5, 0, 0, 9, 0]);
/// # Ok::<(), durer::Error>(())
/// ```
#[expect(clippy::too_many_arguments, reason = "one call, all of it the kind of fill")]
pub fn boundary_fill<P: PixelValue>(
    image: &mut Pixels<P>,
    seed: (u32, u32),
    value: P,
    boundary: P,
    tolerance: P::Level,
    method: SeedFill,
    options: &Options,
    t: &mut impl Tracer<Step>,
) -> Result<u64> {
    let inside = |p: P| p.difference(boundary) > tolerance;
    if options.stop_at_value {
        let is_new = |p: P| p.difference(value) == P::Level::default();
        return fill_where(image, seed, value, |p| inside(p) && !is_new(p), method, options, t);
    }
    fill_where(image, seed, value, inside, method, options, t)
}

/// Fills the pixels connected with the seed for which `inside` holds; returns how many were filled.
///
/// # Errors
/// [`Error::Memory`](crate::Error::Memory) if the budget that the image is charged to is too small for the stack, and its
/// reason if that work is stopped. The image is then as it was.
pub fn fill_where<P: Copy>(
    image: &mut Pixels<P>,
    seed: (u32, u32),
    value: P,
    inside: impl Fn(P) -> bool,
    method: SeedFill,
    options: &Options,
    t: &mut impl Tracer<Step>,
) -> Result<u64> {
    let Some(true) = image.get(seed.0, seed.1).map(&inside) else { return Ok(0) };
    let eight = options.connectivity == Connectivity::Eight;
    let words = u64::from(image.width().div_ceil(64)) * u64::from(image.height());
    let mut charge = image.work().charge_for::<u64>(STACK, words)?;
    if method == SeedFill::Spans && !listens(image, seed, &inside, t) {
        charge.grow(words.saturating_mul(rows::PER_WORD))?;
        return Ok(rows::fill(image, seed, value, &inside, eight));
    }
    let mut region = Region::new(image, &inside);
    let found = match method {
        SeedFill::Naive => naive(&mut region, seed, eight, &mut charge, t)?,
        SeedFill::Spans => spans(&mut region, seed, eight, &mut charge, t)?,
    };
    for y in 0..region.height {
        region.paint(y, image.row_mut(y as u32), value, &inside);
    }
    Ok(found)
}

/// Stage of charges and errors.
const STACK: &str = "stack of the fill";

/// Raises the charge of a stack that has grown by this many bytes since, once it is worth it.
fn charge_stack(charge: &mut Charge, charged: &mut usize, bytes: usize) -> Result<()> {
    if bytes > *charged {
        let next = bytes.max(2 * *charged).max(STACK_STEP);
        charge.grow((next - *charged) as u64)?;
        *charged = next;
    }
    Ok(())
}

/// Bytes by which the charge of a stack begins.
const STACK_STEP: usize = 1 << 12;

/// Reports the run of the seed to a tracer; returns whether there is a tracer.
fn listens<P: Copy>(
    image: &Pixels<P>,
    (x, y): (u32, u32),
    inside: impl Fn(P) -> bool,
    t: &mut impl Tracer<Step>,
) -> bool {
    let mut listens = false;
    t.step(|| {
        listens = true;
        let (before, after) = image.row(y).split_at(x as usize);
        let left = before.iter().rev().take_while(|p| inside(**p)).count();
        let right = after.iter().take_while(|p| inside(**p)).count();
        let run = FillRun::of((y as usize, x as usize - left, x as usize + right));
        Step::Fill { run, waiting: 0 }
    });
    listens
}

/// Neighbours, in the order in which they are taught to be visited.
const NEIGHBOURS: [(i64, i64); 8] =
    [(1, 0), (-1, 0), (0, 1), (0, -1), (1, 1), (-1, 1), (1, -1), (-1, -1)];

fn naive(
    region: &mut Region,
    seed: (u32, u32),
    eight: bool,
    charge: &mut Charge,
    t: &mut impl Tracer<Step>,
) -> Result<u64> {
    let neighbours = if eight { &NEIGHBOURS[..] } else { &NEIGHBOURS[..4] };
    let mut stack = vec![(i64::from(seed.0), i64::from(seed.1))];
    let (mut found, mut charged) = (0, 0);
    while let Some((x, y)) = stack.pop() {
        if !region.is_open(x, y) {
            t.step(|| Step::Skip(FillRun::pixel((x, y))));
            continue;
        }
        region.open[y as usize * region.words + x as usize / 64] &= !(1 << (x as usize % 64));
        found += 1;
        let waiting = stack.len();
        t.step(|| Step::Fill { run: FillRun::pixel((x, y)), waiting });
        let most = waiting + neighbours.len();
        charge_stack(charge, &mut charged, most * size_of::<(i64, i64)>())?;
        // The last one pushed is taken first, so pixels are visited in the order of the recursive form.
        stack.extend(neighbours.iter().rev().map(|(dx, dy)| (x + dx, y + dy)));
        stack.iter().skip(waiting).for_each(|&at| t.step(|| Step::Push(FillRun::pixel(at))));
    }
    Ok(found)
}

/// Fills the spans of a region from a seed on, whose run has been reported, and returns the number of their pixels.
fn spans(
    region: &mut Region,
    seed: (u32, u32),
    eight: bool,
    charge: &mut Charge,
    t: &mut impl Tracer<Step>,
) -> Result<u64> {
    let reach = usize::from(eight);
    let first = region.take_run(seed.1 as usize, seed.0 as usize);
    let mut stack = vec![(seed.1 as usize, first.0, first.1)];
    let (mut found, mut charged) = (0, 0);
    while let Some((y, start, end)) = stack.pop() {
        if found > 0 {
            let waiting = stack.len();
            t.step(|| Step::Fill { run: FillRun::of((y, start, end)), waiting });
        }
        found += (end - start) as u64;
        let (from, to) = (start.saturating_sub(reach), (end + reach).min(region.width));
        for next in [y.wrapping_sub(1), y + 1] {
            if next >= region.height {
                continue;
            }
            let mut x = from;
            while let Some(hit) = region.next_open(next, x, to) {
                let run = region.take_run(next, hit);
                charge_stack(charge, &mut charged, (stack.len() + 1) * size_of::<[usize; 3]>())?;
                stack.push((next, run.0, run.1));
                t.step(|| Step::Push(FillRun::of((next, run.0, run.1))));
                x = run.1;
            }
        }
    }
    Ok(found)
}
