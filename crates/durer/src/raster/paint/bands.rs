//! The commands of a canvas, band by band.

use std::ops::Range;

use crate::simd::dispatch;
use fearless_simd::prelude::*;
use fearless_simd::{Level, u32x8};
use fearless_simd_macros::simd;

use super::color::Space;
use super::command::{Item, Line, Prepared, sort_into_bands};
use super::outline::{Drawn, Filler};
use super::source::Source;
use super::{BlendFunction, Canvas, Color, MaskKind};
use crate::raster::bands::BAND_ROWS;
use crate::raster::coverage::sweep::{Sink, unpacked};
use crate::raster::coverage::{self, convex};
use crate::target::Pixels;
use crate::work::Charge;

/// Paints all commands over the target.
pub(super) fn render<'a, P: Space>(
    level: Level,
    canvas: &'a Canvas,
    commands: &[Prepared<'_, P>],
    target: &mut Pixels<Color>,
) {
    let width = target.width() as usize;
    if target.data().is_empty() {
        return;
    }
    let by_band = sort_into_bands(commands, &canvas.lines, target.height(), BAND_ROWS);
    let rows_per_band = width * BAND_ROWS as usize;
    canvas.work.begin("bands of rows", by_band.len() as u64);
    let paint = |painter: &mut Option<Painter<'a, P>>, (band, rows): (usize, &mut [Color])| {
        if canvas.work.is_stopped() {
            return;
        }
        let painter = painter.get_or_insert_with(|| Painter::new(canvas));
        let todo = Todo { items: &by_band[band], commands, lines: &canvas.lines };
        painter.band(level, &todo, band as i32 * BAND_ROWS, rows);
        canvas.work.advance(1);
    };
    #[cfg(feature = "parallel")]
    {
        use rayon::prelude::*;
        if rayon::current_num_threads() > 1 && by_band.len() > 1 {
            target
                .data_mut()
                .par_chunks_mut(rows_per_band)
                .enumerate()
                .for_each_init(|| None, paint);
            return;
        }
    }
    let mut painter = None;
    target.data_mut().chunks_mut(rows_per_band).enumerate().for_each(|b| paint(&mut painter, b));
}

/// Number of lines fetched together: they are far apart in memory, so their waiting times overlap.
const AT_ONCE: usize = 16;

/// Work to do in a band.
struct Todo<'a, P> {
    items: &'a [Item],
    commands: &'a [Prepared<'a, P>],
    lines: &'a [Line],
}

/// Buffers of one thread.
struct Painter<'a, P> {
    canvas: &'a Canvas,
    /// Lent by the canvas.
    filler: Filler,
    width: usize,
    /// A layer for each open group.
    layers: Vec<Vec<P>>,
    /// Coverage of the open clip paths, each multiplied with those below it in the same layer.
    clips: Vec<Vec<u8>>,
    /// Number of clip paths that were open when each layer was begun: they do not clip the marks on the layer, but the
    /// layer as a whole; otherwise edges would be thinned twice.
    floors: Vec<usize>,
    /// Vectors that were popped, for further use.
    spare: Vec<Vec<P>>,
    /// The lines painted next.
    near: Vec<Line>,
    /// Charge of layers and clips to the budget.
    charge: Charge,
    /// Largest number of clip paths that were open together.
    most_clips: usize,
}

/// Stage of layers and clips in errors about memory.
const LAYERS: &str = "layers of groups and clip paths";

impl<P> Drop for Painter<'_, P> {
    fn drop(&mut self) {
        self.canvas.keep(std::mem::take(&mut self.filler));
    }
}

impl<'a, P: Space> Painter<'a, P> {
    fn new(canvas: &'a Canvas) -> Self {
        Self {
            canvas,
            filler: canvas.filler(),
            width: canvas.width as usize,
            layers: Vec::new(),
            clips: Vec::new(),
            floors: Vec::new(),
            spare: Vec::new(),
            near: Vec::new(),
            // If the work is stopped, nothing is painted.
            charge: canvas.work.charge(LAYERS, 0).unwrap_or_default(),
            most_clips: 0,
        }
    }

    /// Charges a buffer that is made; returns whether it fits, and stops the work if it does not.
    fn hold(&mut self, bytes: usize) -> bool {
        self.charge.grow(bytes as u64).map_err(|error| self.canvas.work.stop(error)).is_ok()
    }

    /// Paints the commands onto the rows of one band, whose first row is `top`.
    fn band(&mut self, level: Level, todo: &Todo<'_, P>, top: i32, rows: &mut [Color]) {
        let mut copy = self.spare.pop().unwrap_or_default();
        let background = self.canvas.background;
        if let Some(color) = background {
            dispatch!(level, simd => clear(simd, rows, color));
        }
        if let Some(base) = P::in_place(rows) {
            // Nothing painted over opaque pixels makes them less so.
            let opaque = background.map_or_else(|| P::all_opaque(base), |c| c[3] == 255);
            if !opaque {
                base.iter_mut().for_each(|p| *p = p.premultiplied());
            }
            self.commands(level, todo, top, base);
            if !opaque {
                base.iter_mut().for_each(|p| *p = p.straight());
            }
        } else {
            copy.clear();
            copy.extend(rows.iter().map(|c| P::load(*c)));
            self.commands(level, todo, top, &mut copy);
            rows.iter_mut().zip(&copy).for_each(|(color, pixel)| *color = pixel.store());
        }
        self.spare.push(copy);
    }

    fn commands(&mut self, level: Level, todo: &Todo<'_, P>, top: i32, base: &mut [P]) {
        for items in todo.items.chunk_by(|a, b| a.line().is_some() && b.line().is_some()) {
            let command = match items {
                [item] if item.line().is_none() => &todo.commands[item.command()],
                _ => {
                    self.lines(level, items, todo.lines, top, base);
                    continue;
                }
            };
            match command {
                // They are items of their own.
                Prepared::Lines { .. } => {}
                Prepared::Fill { outline, how, source } => {
                    let at = (top, &mut *base);
                    dispatch!(level, simd => self.fill(simd, *outline, how, source, at));
                }
                Prepared::PushClip { outline, how } => {
                    if !self.has_room_for_clip() {
                        return;
                    }
                    dispatch!(level, simd => self.push_clip(simd, *outline, how, top));
                }
                Prepared::PopClip => drop(self.clips.pop()),
                Prepared::PushGroup | Prepared::BeginMask => {
                    if !self.push_group(base.len()) {
                        return;
                    }
                }
                Prepared::PopGroup { opacity, blend } => self.pop_group(*opacity, *blend, base),
                Prepared::EndMask { kind } => self.end_mask(*kind),
            }
        }
    }

    fn fill<S: Simd>(
        &mut self,
        simd: S,
        outline: Drawn<'_>,
        how: &coverage::Options,
        source: &Source<P>,
        (top, base): (i32, &mut [P]),
    ) {
        let Self { filler, layers, clips, floors, width, .. } = self;
        let width = *width;
        let pixels = layers.last_mut().map_or(base, |l| l.as_mut_slice());
        let clip = clip_in_force(clips, floors).map(Vec::as_slice);
        match (source.color(), clip) {
            (Some(color), None) => {
                let mut sink = Plain { pixels, width, color };
                Filler::fill(simd, filler, outline, top, how, &mut sink);
            }
            _ => {
                let mut sink = Painted { pixels, width, source, clip, top };
                Filler::fill(simd, filler, outline, top, how, &mut sink);
            }
        }
    }

    fn lines(&mut self, level: Level, items: &[Item], lines: &[Line], top: i32, base: &mut [P]) {
        let Self { layers, clips, floors, width, near, .. } = self;
        let width = *width;
        let pixels = layers.last_mut().map_or(base, |l| l.as_mut_slice());
        let clip = clip_in_force(clips, floors).map(Vec::as_slice);
        for items in items.chunks(AT_ONCE) {
            near.clear();
            near.extend(items.iter().filter_map(|item| lines.get(item.line()?)));
            for line in &*near {
                let (edges, rows) = (line.strip.edges(), line.strip.rows());
                let color = P::from_srgb(line.color.map(|c| f32::from(c) / 255.0), line.opacity);
                if clip.is_some() {
                    let source = &Source::Solid(color);
                    let mut sink = Painted { pixels, width, source, clip, top };
                    dispatch!(level, simd => convex::fill(simd, &edges, rows, top, width, &mut sink));
                } else {
                    let mut sink = Plain { pixels, width, color };
                    dispatch!(level, simd => convex::fill(simd, &edges, rows, top, width, &mut sink));
                }
            }
        }
    }

    /// Returns whether one more clip path fits into the budget.
    fn has_room_for_clip(&mut self) -> bool {
        if self.clips.len() < self.most_clips {
            return true;
        }
        self.most_clips += 1;
        self.hold(self.width * BAND_ROWS as usize)
    }

    fn push_clip<S: Simd>(
        &mut self,
        simd: S,
        outline: Drawn<'_>,
        how: &coverage::Options,
        top: i32,
    ) {
        let mut clip = vec![0_u8; self.width * BAND_ROWS as usize];
        let (width, below) = (self.width, clip_in_force(&self.clips, &self.floors));
        let touched = outline.rows();
        if touched.0 < top + BAND_ROWS && touched.1 > top {
            let mut sink = Clip { clip: &mut clip, width, below: below.map(Vec::as_slice) };
            Filler::fill(simd, &mut self.filler, outline, top, how, &mut sink);
        }
        self.clips.push(clip);
    }

    /// Begins a layer; returns whether it fits into the budget.
    fn push_group(&mut self, len: usize) -> bool {
        let mut layer = self.spare.pop().unwrap_or_default();
        if layer.capacity() < len && !self.hold(len * size_of::<P>()) {
            return false;
        }
        layer.clear();
        layer.resize(len, P::CLEAR);
        self.layers.push(layer);
        self.floors.push(self.clips.len());
        true
    }

    /// Makes a clip of the last layer.
    fn end_mask(&mut self, kind: MaskKind) {
        let Some(layer) = self.layers.pop() else { return };
        self.floors.pop();
        let below = clip_in_force(&self.clips, &self.floors);
        let own = |pixel: &P| match kind {
            MaskKind::Alpha => pixel.alpha(),
            MaskKind::Luminance => pixel.luminance(),
        };
        let within = |(i, pixel): (usize, &P)| {
            multiplied(u32::from(own(pixel)), below.map_or(255, |b| b[i])) as u8
        };
        let clip = layer.iter().enumerate().map(within).collect();
        self.clips.push(clip);
        self.spare.push(layer);
    }

    /// Lays the last layer over the one below it, within the clip paths that are open.
    fn pop_group(&mut self, opacity: u8, blend: BlendFunction, base: &mut [P]) {
        let Some(layer) = self.layers.pop() else { return };
        let below = self.layers.last_mut().map_or(base, |l| l.as_mut_slice());
        self.floors.pop();
        let clip = clip_in_force(&self.clips, &self.floors);
        for (i, (pixel, below)) in layer.iter().zip(below.iter_mut()).enumerate() {
            if *pixel != P::CLEAR {
                let mask = clip.map_or(255, |c| c[i]);
                *below = blend.over(*pixel, opacity, mask, *below);
            }
        }
        self.spare.push(layer);
    }
}

/// Returns the coverage by which the current marks are multiplied.
fn clip_in_force<'a>(clips: &'a [Vec<u8>], floors: &[usize]) -> Option<&'a Vec<u8>> {
    clips.last().filter(|_| clips.len() > floors.last().copied().unwrap_or(0))
}

/// One colour over the pixels of a band, without a clip.
struct Plain<'a, P> {
    pixels: &'a mut [P],
    width: usize,
    color: P,
}

impl<S: Simd, P: Space> Sink<S> for Plain<'_, P> {
    #[inline(always)]
    fn eight(&mut self, simd: S, row: i32, x: usize, coverage: u32x8<S>) {
        let start = row as usize * self.width;
        let (first, end) = (start + x, start + self.width);
        if let Some(below) = whole_eight(self.pixels, first, end) {
            P::color_over(simd, self.color, coverage, below);
        } else {
            let mut below = part_of_eight(self.pixels, first, end);
            P::color_over(simd, self.color, coverage, &mut below);
            put_back(self.pixels, first, end, &below);
        }
    }

    #[inline(always)]
    fn four(&mut self, simd: S, row: i32, x: usize, coverage: u32) {
        let start = row as usize * self.width;
        let (first, end) = (start + x, start + self.width);
        if first + 4 > end {
            self.eight(simd, row, x, unpacked(simd, coverage));
        } else if let Some(below) =
            self.pixels.get_mut(first..first + 4).and_then(<[P]>::first_chunk_mut)
        {
            P::color_over_four(simd, self.color, coverage, below);
        }
    }

    #[inline(always)]
    fn span(&mut self, simd: S, row: i32, x: Range<usize>, coverage: u8) {
        let start = row as usize * self.width;
        if coverage == 255 && self.color.is_opaque() {
            let pixels = self.pixels.get_mut(start + x.start..start + x.end);
            return fill(pixels.unwrap_or_default(), self.color);
        }
        for first in x.clone().step_by(8) {
            self.eight(simd, row, first, part_covered(simd, coverage, x.end - first));
        }
    }
}

/// Sets all rows as [`fill`] does, with the widest stores of the SIMD level.
#[simd]
fn clear<S: Simd>(_simd: S, pixels: &mut [Color], color: Color) {
    fill(pixels, color);
}

/// Sets pixels to a colour; those in the middle perhaps twice, because then there are few distinct lengths.
#[inline(always)]
fn fill<P: Copy>(pixels: &mut [P], color: P) {
    match pixels.len() {
        0..4 => pixels.iter_mut().for_each(|pixel| *pixel = color),
        4..8 => fill_ends::<P, 4>(pixels, color),
        8..16 => fill_ends::<P, 8>(pixels, color),
        16..32 => fill_ends::<P, 16>(pixels, color),
        32..64 => fill_ends::<P, 32>(pixels, color),
        _ => {
            if let Some(last) = pixels.last_chunk_mut::<64>() {
                *last = [color; 64];
            }
            for some in pixels.as_chunks_mut::<64>().0 {
                *some = [color; 64];
            }
        }
    }
}

/// Sets the first and the last `COUNT` pixels to a colour.
#[inline(always)]
fn fill_ends<P: Copy, const COUNT: usize>(pixels: &mut [P], color: P) {
    if let Some(first) = pixels.first_chunk_mut::<COUNT>() {
        *first = [color; COUNT];
    }
    if let Some(last) = pixels.last_chunk_mut::<COUNT>() {
        *last = [color; COUNT];
    }
}

/// Any paint over the pixels of a band, perhaps within a clip.
struct Painted<'a, P> {
    pixels: &'a mut [P],
    width: usize,
    source: &'a Source<P>,
    clip: Option<&'a [u8]>,
    top: i32,
}

impl<S: Simd, P: Space> Sink<S> for Painted<'_, P> {
    #[inline(always)]
    fn eight(&mut self, simd: S, row: i32, x: usize, coverage: u32x8<S>) {
        let start = row as usize * self.width;
        let (first, end) = (start + x, start + self.width);
        let mut coverage = coverage;
        if let Some(clip) = self.clip {
            let mut within = [0; 8];
            let clip = clip.get(first..end).unwrap_or_default();
            within.iter_mut().zip(clip).for_each(|(w, c)| *w = u32::from(*c));
            let product = coverage * u32x8::from_slice(simd, &within) + u32x8::splat(simd, 128);
            coverage = (product + (product >> 8)) >> 8;
        }
        let mut colors = [P::CLEAR; 8];
        self.source.row(x, (self.top + row) as usize, &mut colors);
        if let Some(below) = whole_eight(self.pixels, first, end) {
            P::colors_over(simd, &colors, coverage, below);
        } else {
            let mut below = part_of_eight(self.pixels, first, end);
            P::colors_over(simd, &colors, coverage, &mut below);
            put_back(self.pixels, first, end, &below);
        }
    }

    #[inline(always)]
    fn span(&mut self, simd: S, row: i32, x: Range<usize>, coverage: u8) {
        for first in x.clone().step_by(8) {
            self.eight(simd, row, first, part_covered(simd, coverage, x.end - first));
        }
    }
}

/// Returns the same coverage for all pixels that are left, at most eight, and 0 for the rest of the eight.
#[inline(always)]
fn part_covered<S: Simd>(simd: S, coverage: u8, left: usize) -> u32x8<S> {
    let all = u32x8::splat(simd, u32::from(coverage));
    if left >= 8 {
        return all;
    }
    let lanes = u32x8::from_slice(simd, &[0, 1, 2, 3, 4, 5, 6, 7]);
    lanes.simd_lt(u32x8::splat(simd, left as u32)).select(all, u32x8::splat(simd, 0))
}

// No closures here: their bodies would not be compiled for the SIMD level.

/// Returns the eight pixels from `first` on, where all of them come before `end`.
#[inline(always)]
fn whole_eight<P>(pixels: &mut [P], first: usize, end: usize) -> Option<&mut [P; 8]> {
    if first + 8 > end {
        return None;
    }
    pixels.get_mut(first..first + 8)?.first_chunk_mut()
}

/// Returns the pixels from `first` to before `end`, and clear ones.
#[inline(always)]
fn part_of_eight<P: Space>(pixels: &[P], first: usize, end: usize) -> [P; 8] {
    let mut eight = [P::CLEAR; 8];
    let some = pixels.get(first..end).unwrap_or_default();
    eight.iter_mut().zip(some).for_each(|(e, p)| *e = *p);
    eight
}

/// Writes back pixels that [`part_of_eight`] returned.
#[inline(always)]
fn put_back<P: Space>(pixels: &mut [P], first: usize, end: usize, eight: &[P; 8]) {
    let some = pixels.get_mut(first..end).unwrap_or_default();
    some.iter_mut().zip(eight).for_each(|(p, e)| *p = *e);
}

/// The coverage of a clip path, multiplied with that below it.
struct Clip<'a> {
    clip: &'a mut [u8],
    width: usize,
    below: Option<&'a [u8]>,
}

impl Clip<'_> {
    fn put(&mut self, row: i32, x: usize, coverage: u8) {
        let at = row as usize * self.width + x;
        let below = self.below.map_or(255, |b| b[at]);
        self.clip[at] = multiplied(u32::from(coverage), below) as u8;
    }
}

impl<S: Simd> Sink<S> for Clip<'_> {
    #[inline(always)]
    fn eight(&mut self, _: S, row: i32, x: usize, coverage: u32x8<S>) {
        let mut own = [0; 8];
        coverage.store_slice(&mut own);
        for (x, coverage) in (x..self.width).zip(own) {
            self.put(row, x, coverage as u8);
        }
    }

    #[inline(always)]
    fn span(&mut self, _: S, row: i32, x: Range<usize>, coverage: u8) {
        for x in x {
            self.put(row, x, coverage);
        }
    }
}

#[inline(always)]
fn multiplied(a: u32, b: u8) -> u32 {
    let x = a * u32::from(b) + 128;
    (x + (x >> 8)) >> 8
}
