//! Seed fills: from one pixel to all that are connected with it and belong together.
//!
//! A flood fill takes the pixels that are like the seed, a boundary fill those that are not like a
//! boundary. The naive form keeps a stack of pixels; the span form takes whole runs of a row and looks for
//! runs in the rows above and below (A. R. Smith, *Tint fill*, SIGGRAPH 1979; P. Heckbert, *A seed fill
//! algorithm*, Graphics Gems, 1990). Both fill the same set; neither recurses.
//!
//! Class: image space. Cost: O(n) for n filled pixels; the naive form touches each up to eight times.

use crate::info::{Class, Info, family};
use crate::target::Pixels;
use crate::trace::Tracer;

/// Which pixels are neighbours.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Connectivity {
    /// Those with a common side.
    #[default]
    Four,
    /// Those with a common side or corner.
    Eight,
}

/// How a region is filled.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Options {
    /// Which pixels are neighbours.
    pub connectivity: Connectivity,
}

/// One step: pixels of a row that were found to belong to the region.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Step {
    /// Row.
    pub y: u32,
    /// First pixel.
    pub x0: u32,
    /// One past the last pixel.
    pub x1: u32,
}

/// The facts of the naive form.
pub const NAIVE: Info = Info {
    name: "naive",
    title: "Seed fill with a stack of pixels",
    authors: "H. Lieberman",
    year: 1978,
    source: "How to color in a coloring book, SIGGRAPH",
    class: Class::ImageSpace,
    cost: "O(n) time and memory for n filled pixels",
    limits: "none",
};

/// The facts of the span form.
pub const INFO: Info = Info {
    name: "spans",
    title: "Seed fill by spans",
    authors: "A. R. Smith, P. Heckbert",
    year: 1979,
    source: "Tint fill, SIGGRAPH; A seed fill algorithm, Graphics Gems (1990)",
    class: Class::ImageSpace,
    cost: "O(n) time for n filled pixels, memory for the spans at the rim",
    limits: "none",
};

family! {
    /// The seed fills.
    pub enum SeedFill {
        /// With a stack of pixels.
        Naive => NAIVE,
        /// By spans.
        Spans => INFO,
    }
}

/// Values of pixels that can be more or less alike.
pub trait PixelValue: Copy {
    /// The largest difference of a channel.
    fn difference(self, other: Self) -> u8;
}

impl PixelValue for bool {
    fn difference(self, other: Self) -> u8 {
        u8::from(self != other) * 255
    }
}

impl PixelValue for u8 {
    #[inline(always)]
    fn difference(self, other: Self) -> u8 {
        self.abs_diff(other)
    }
}

impl<const N: usize> PixelValue for [u8; N] {
    fn difference(self, other: Self) -> u8 {
        self.iter().zip(other).map(|(a, b)| a.abs_diff(b)).max().unwrap_or(0)
    }
}

/// Fills the pixels connected with the seed whose channels differ from the seed's by at most
/// `tolerance`; returns how many were filled. A seed outside the image fills nothing.
///
/// ```
/// use durer::raster::seed_fill::{Options, SeedFill, flood_fill};
/// use durer::target::Pixels;
/// use durer::trace::NoTrace;
///
/// let mut image = Pixels::from_data(3, 2, vec![0_u8, 0, 9, 9, 9, 0]).unwrap();
/// let fill = SeedFill::Spans;
/// assert_eq!(flood_fill(&mut image, (0, 0), 7, 0, fill, &Options::default(), &mut NoTrace), 2);
/// assert_eq!(image.data(), [7, 7, 9, 9, 9, 0]);
/// ```
pub fn flood_fill<P: PixelValue>(
    image: &mut Pixels<P>,
    seed: (u32, u32),
    value: P,
    tolerance: u8,
    method: SeedFill,
    options: &Options,
    t: &mut impl Tracer<Step>,
) -> u64 {
    let Some(like) = image.get(seed.0, seed.1) else { return 0 };
    fill_where(image, seed, value, |p| p.difference(like) <= tolerance, method, options, t)
}

/// Fills the pixels connected with the seed up to a boundary: those whose channels differ from the
/// boundary's by more than `tolerance`; returns how many were filled.
#[allow(clippy::too_many_arguments)]
pub fn boundary_fill<P: PixelValue>(
    image: &mut Pixels<P>,
    seed: (u32, u32),
    value: P,
    boundary: P,
    tolerance: u8,
    method: SeedFill,
    options: &Options,
    t: &mut impl Tracer<Step>,
) -> u64 {
    fill_where(image, seed, value, |p| p.difference(boundary) > tolerance, method, options, t)
}

/// Fills the pixels connected with the seed for which `inside` holds; returns how many were filled.
pub fn fill_where<P: Copy>(
    image: &mut Pixels<P>,
    seed: (u32, u32),
    value: P,
    inside: impl Fn(P) -> bool,
    method: SeedFill,
    options: &Options,
    t: &mut impl Tracer<Step>,
) -> u64 {
    let mut region = Region::new(image, &inside);
    if !region.is_open(i64::from(seed.0), i64::from(seed.1)) {
        return 0;
    }
    let eight = options.connectivity == Connectivity::Eight;
    let found = match method {
        SeedFill::Naive => naive(&mut region, seed, eight, t),
        SeedFill::Spans => spans(&mut region, seed, eight, t),
    };
    let width = image.width().max(1) as usize;
    for (row, words) in image.data_mut().chunks_mut(width).zip(region.filled()) {
        paint(row, &words, value);
    }
    found
}

/// One bit per pixel: whether it may still be filled.
struct Region {
    width: usize,
    height: usize,
    words: usize,
    open: Vec<u64>,
    before: Vec<u64>,
}

impl Region {
    fn new<P: Copy>(image: &Pixels<P>, inside: impl Fn(P) -> bool) -> Self {
        let (width, height) = (image.width() as usize, image.height() as usize);
        let words = width.div_ceil(64);
        let mut open = Vec::with_capacity(words * height);
        for y in 0..image.height() {
            let chunks = image.row(y).chunks(64);
            open.extend(chunks.map(|chunk| bits(chunk, &inside)));
        }
        Self { width, height, words, before: open.clone(), open }
    }

    fn is_open(&self, x: i64, y: i64) -> bool {
        let inside = x >= 0 && y >= 0 && (x as usize) < self.width && (y as usize) < self.height;
        inside && self.open[y as usize * self.words + x as usize / 64] >> (x as usize % 64) & 1 != 0
    }

    /// Per row the words of what has been filled.
    fn filled(&self) -> impl Iterator<Item = Vec<u64>> {
        let words = self.words.max(1);
        let pairs = self.before.chunks(words).zip(self.open.chunks(words));
        pairs.map(|(before, after)| before.iter().zip(after).map(|(b, a)| b & !a).collect())
    }

    fn row(&self, y: usize) -> &[u64] {
        &self.open[y * self.words..(y + 1) * self.words]
    }

    /// The first open pixel of a row in `x..end`.
    fn next_open(&self, y: usize, x: usize, end: usize) -> Option<usize> {
        let found = next_bit(self.row(y), x, |w| w)?;
        (found < end).then_some(found)
    }

    /// Closes the whole run of open pixels around x; returns it.
    fn take_run(&mut self, y: usize, x: usize) -> (usize, usize) {
        let row = self.row(y);
        let end = next_bit(row, x, |w| !w).unwrap_or(self.width).min(self.width);
        let start = previous_closed(row, x).map_or(0, |p| p + 1);
        let base = y * self.words;
        let mut at = start;
        while at < end {
            let stop = end.min((at | 63) + 1);
            self.open[base + at / 64] &= !((u64::MAX >> (64 - (stop - at))) << (at % 64));
            at = stop;
        }
        (start, end)
    }
}

/// One bit for each of at most 64 pixels.
#[inline(always)]
fn bits<P: Copy>(pixels: &[P], inside: impl Fn(P) -> bool) -> u64 {
    // Bytes first, for those are compared many at a time.
    let mut flags = [0_u8; 64];
    for (flag, pixel) in flags.iter_mut().zip(pixels) {
        *flag = u8::from(inside(*pixel));
    }
    let eights = flags.as_chunks::<8>().0.iter().enumerate();
    // The product brings the lowest bits of eight bytes side by side into the highest byte.
    eights.fold(0, |word, (i, eight)| {
        let eight = u64::from_le_bytes(*eight).wrapping_mul(0x0102_0408_1020_4080) >> 56;
        word | (eight << (8 * i))
    })
}

/// The first bit from `x` on that is set after `map`.
fn next_bit(row: &[u64], x: usize, map: impl Fn(u64) -> u64) -> Option<usize> {
    let first = map(*row.get(x / 64)?) & (u64::MAX << (x % 64));
    if first != 0 {
        return Some(x / 64 * 64 + first.trailing_zeros() as usize);
    }
    let rest = row.iter().enumerate().skip(x / 64 + 1);
    let mut rest = rest.map(|(i, w)| (i, map(*w))).filter(|(_, w)| *w != 0);
    rest.next().map(|(i, w)| i * 64 + w.trailing_zeros() as usize)
}

/// The last closed pixel before x.
fn previous_closed(row: &[u64], x: usize) -> Option<usize> {
    let last = !row.get(x / 64)? & !(u64::MAX << (x % 64));
    if last != 0 {
        return Some(x / 64 * 64 + 63 - last.leading_zeros() as usize);
    }
    let mut rest = row[..x / 64].iter().enumerate().rev().filter(|(_, w)| **w != u64::MAX);
    rest.next().map(|(i, w)| i * 64 + 63 - (!w).leading_zeros() as usize)
}

/// Writes the value to the pixels whose bits are set.
fn paint<P: Copy>(row: &mut [P], words: &[u64], value: P) {
    for (pixels, word) in row.chunks_mut(64).zip(words) {
        if *word == u64::MAX {
            pixels.fill(value);
            continue;
        }
        let mut bits = *word;
        while bits != 0 {
            if let Some(pixel) = pixels.get_mut(bits.trailing_zeros() as usize) {
                *pixel = value;
            }
            bits &= bits - 1;
        }
    }
}

const NEIGHBOURS: [(i64, i64); 8] =
    [(1, 0), (-1, 0), (0, 1), (0, -1), (1, 1), (-1, 1), (1, -1), (-1, -1)];

fn naive(region: &mut Region, seed: (u32, u32), eight: bool, t: &mut impl Tracer<Step>) -> u64 {
    let neighbours = if eight { &NEIGHBOURS[..] } else { &NEIGHBOURS[..4] };
    let mut stack = vec![(i64::from(seed.0), i64::from(seed.1))];
    let mut found = 0;
    while let Some((x, y)) = stack.pop() {
        if !region.is_open(x, y) {
            continue;
        }
        region.open[y as usize * region.words + x as usize / 64] &= !(1 << (x as usize % 64));
        found += 1;
        t.step(|| Step { y: y as u32, x0: x as u32, x1: x as u32 + 1 });
        stack.extend(neighbours.iter().map(|(dx, dy)| (x + dx, y + dy)));
    }
    found
}

fn spans(region: &mut Region, seed: (u32, u32), eight: bool, t: &mut impl Tracer<Step>) -> u64 {
    let reach = usize::from(eight);
    let first = region.take_run(seed.1 as usize, seed.0 as usize);
    let mut stack = vec![(seed.1 as usize, first.0, first.1)];
    let mut found = 0;
    while let Some((y, start, end)) = stack.pop() {
        found += (end - start) as u64;
        t.step(|| Step { y: y as u32, x0: start as u32, x1: end as u32 });
        let (from, to) = (start.saturating_sub(reach), (end + reach).min(region.width));
        for next in [y.wrapping_sub(1), y + 1] {
            if next >= region.height {
                continue;
            }
            let mut x = from;
            while let Some(hit) = region.next_open(next, x, to) {
                let run = region.take_run(next, hit);
                stack.push((next, run.0, run.1));
                x = run.1;
            }
        }
    }
    found
}
