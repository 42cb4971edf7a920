//! The commands of a canvas, band by band.

use fearless_simd::prelude::*;
use fearless_simd::{Level, dispatch};

use super::color::Space;
use super::command::{Prepared, sort_into_bands};
use super::source::Source;
use super::{Canvas, Color, MaskKind};
use crate::raster::coverage::Overlap;
use crate::raster::coverage::band::{BandFiller, PathEdges};
use crate::raster::coverage::cells::BAND_ROWS;
use crate::raster::coverage::sweep::Run;
use crate::target::Pixels;

/// Paints all commands over the target.
pub(super) fn render<P: Space>(
    level: Level,
    canvas: &Canvas,
    commands: &[Prepared<'_, P>],
    target: &mut Pixels<Color>,
) {
    let width = target.width() as usize;
    if target.data().is_empty() {
        return;
    }
    let by_band = sort_into_bands(commands, target.height(), BAND_ROWS);
    let rows_per_band = width * BAND_ROWS as usize;
    let paint = |painter: &mut Option<Painter<P>>, (band, rows): (usize, &mut [Color])| {
        let painter = painter.get_or_insert_with(|| Painter::new(canvas));
        let commands = by_band[band].iter().map(|i| &commands[*i as usize]);
        painter.band(level, commands, band as i32 * BAND_ROWS, rows);
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

/// Buffers of one thread.
struct Painter<P> {
    filler: BandFiller,
    width: usize,
    exact: bool,
    background: Option<Color>,
    /// A layer for each open group.
    layers: Vec<Vec<P>>,
    /// Coverage of the open clip paths, each multiplied with those below it in the same layer.
    clips: Vec<Vec<u8>>,
    /// For each layer how many clip paths were open when it was begun: they do not clip what is painted
    /// onto it, but the layer as a whole, or edges would be thinned twice.
    floors: Vec<usize>,
    coverage: Vec<u32>,
    colors: Vec<P>,
    /// Whether what was popped can be used again.
    spare: Vec<Vec<P>>,
}

impl<P: Space> Painter<P> {
    fn new(canvas: &Canvas) -> Self {
        let width = canvas.width as usize;
        Self {
            filler: BandFiller::new(canvas.width),
            width,
            exact: canvas.options.overlap == Overlap::Exact,
            background: canvas.background,
            layers: Vec::new(),
            clips: Vec::new(),
            floors: Vec::new(),
            coverage: vec![0; width],
            colors: vec![P::CLEAR; width],
            spare: Vec::new(),
        }
    }

    /// Paints the commands onto the rows of one band, whose first row is `top`.
    fn band<'a>(
        &mut self,
        level: Level,
        commands: impl Iterator<Item = &'a Prepared<'a, P>>,
        top: i32,
        rows: &mut [Color],
    ) where
        P: 'a,
    {
        let mut copy = self.spare.pop().unwrap_or_default();
        if let Some(color) = self.background {
            rows.fill(color);
        }
        if let Some(base) = P::in_place(rows) {
            // Nothing painted over opaque pixels makes them less so.
            let opaque = self.background.map_or_else(|| P::all_opaque(base), |c| c[3] == 255);
            if !opaque {
                base.iter_mut().for_each(|p| *p = p.premultiplied());
            }
            self.commands(level, commands, top, base);
            if !opaque {
                base.iter_mut().for_each(|p| *p = p.straight());
            }
        } else {
            copy.clear();
            copy.extend(rows.iter().map(|c| P::load(*c)));
            self.commands(level, commands, top, &mut copy);
            rows.iter_mut().zip(&copy).for_each(|(color, pixel)| *color = pixel.store());
        }
        self.spare.push(copy);
    }

    fn commands<'a>(
        &mut self,
        level: Level,
        commands: impl Iterator<Item = &'a Prepared<'a, P>>,
        top: i32,
        base: &mut [P],
    ) where
        P: 'a,
    {
        for command in commands {
            match command {
                Prepared::Fill { path, rule, source, smooth } => {
                    let at = (top, *smooth, &mut *base);
                    dispatch!(level, simd => self.fill(simd, path, *rule, source, at));
                }
                Prepared::PushClip { path, rule, smooth } => {
                    dispatch!(level, simd => self.push_clip(simd, path, *rule, (top, *smooth)));
                }
                Prepared::PopClip => drop(self.clips.pop()),
                Prepared::PushGroup => self.push_group(base.len()),
                Prepared::PopGroup { opacity } => self.pop_group(*opacity, base),
                Prepared::BeginMask => self.push_group(base.len()),
                Prepared::EndMask { kind } => self.end_mask(*kind),
            }
        }
    }

    fn fill<S: Simd>(
        &mut self,
        simd: S,
        path: &PathEdges,
        rule: super::FillRule,
        source: &Source<P>,
        (top, anti_alias, base): (i32, bool, &mut [P]),
    ) {
        let Self { filler, layers, clips, floors, coverage, colors, .. } = self;
        let width = self.width;
        let layer = layers.last_mut().map_or(base, |l| l.as_mut_slice());
        let clip = clip_in_force(clips, floors);
        let color = source.color();
        let paint = |simd: S, row: i32, runs: &[Run], own: &[u32]| {
            let start = row as usize * width;
            let Some(pixels) = layer.get_mut(start..start + width) else { return };
            let clip = clip.map(|c| &c[start..start + width]);
            for run in runs {
                let below = &mut pixels[run.start..run.end];
                let span = run.start..run.end;
                if let (Some(color), None, true) = (color, clip, anti_alias) {
                    match run.constant {
                        Some(255) if color.is_opaque() => below.fill(color),
                        Some(alpha) => below.iter_mut().for_each(|p| *p = color.over(alpha, *p)),
                        None => P::color_over(simd, color, &own[span], below),
                    }
                    continue;
                }
                let mask = &mut coverage[span.clone()];
                match run.constant {
                    Some(alpha) => mask.fill(u32::from(alpha)),
                    None => mask.copy_from_slice(&own[span.clone()]),
                }
                if !anti_alias {
                    mask.iter_mut().for_each(|m| *m = if *m >= 128 { 255 } else { 0 });
                }
                if let Some(clip) = clip {
                    multiply(mask, &clip[span.clone()]);
                }
                match color {
                    Some(color) => P::color_over(simd, color, mask, below),
                    None => {
                        let colors = &mut colors[span];
                        source.row(run.start, (top + row) as usize, colors);
                        P::colors_over(simd, colors, mask, below);
                    }
                }
            }
        };
        BandFiller::fill(simd, filler, path, top, rule, self.exact, paint);
    }

    fn push_clip<S: Simd>(
        &mut self,
        simd: S,
        path: &PathEdges,
        rule: super::FillRule,
        (top, anti_alias): (i32, bool),
    ) {
        let mut clip = vec![0_u8; self.width * BAND_ROWS as usize];
        let (width, below) = (self.width, clip_in_force(&self.clips, &self.floors));
        if !path.misses(top) {
            let write = |_: S, row: i32, runs: &[Run], own: &[u32]| {
                let start = row as usize * width;
                for run in runs {
                    for x in run.start..run.end {
                        let alpha = run.constant.unwrap_or(own[x] as u8);
                        let alpha = if anti_alias { alpha } else { (alpha >> 7) * 255 };
                        let parent = below.map_or(255, |b| b[start + x]);
                        clip[start + x] = multiplied(u32::from(alpha), parent) as u8;
                    }
                }
            };
            BandFiller::fill(simd, &mut self.filler, path, top, rule, self.exact, write);
        }
        self.clips.push(clip);
    }

    fn push_group(&mut self, len: usize) {
        let mut layer = self.spare.pop().unwrap_or_default();
        layer.clear();
        layer.resize(len, P::CLEAR);
        self.layers.push(layer);
        self.floors.push(self.clips.len());
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
    fn pop_group(&mut self, opacity: u8, base: &mut [P]) {
        let Some(layer) = self.layers.pop() else { return };
        let below = self.layers.last_mut().map_or(base, |l| l.as_mut_slice());
        self.floors.pop();
        let clip = clip_in_force(&self.clips, &self.floors);
        for (i, (pixel, below)) in layer.iter().zip(below.iter_mut()).enumerate() {
            if *pixel != P::CLEAR {
                let mask = clip.map_or(255, |c| c[i]);
                *below = pixel.scaled(opacity).over(mask, *below);
            }
        }
        self.spare.push(layer);
    }
}

/// The coverage that what is painted now is multiplied with.
fn clip_in_force<'a>(clips: &'a [Vec<u8>], floors: &[usize]) -> Option<&'a Vec<u8>> {
    clips.last().filter(|_| clips.len() > floors.last().copied().unwrap_or(0))
}

/// Coverage times the clip path's.
fn multiply(coverage: &mut [u32], clip: &[u8]) {
    for (c, m) in coverage.iter_mut().zip(clip) {
        *c = multiplied(*c, *m);
    }
}

#[inline(always)]
fn multiplied(a: u32, b: u8) -> u32 {
    let x = a * u32::from(b) + 128;
    (x + (x >> 8)) >> 8
}
