//! Many thin lines of many colours: Bresenham's pixels, tile by tile.
//!
//! Lines drawn one by one wait for memory, because each is in a different place. Here they are first sorted into the
//! tiles that their boxes touch, as in H. Fuchs et al., *Pixel-Planes 5*, SIGGRAPH 1989, then each tile's lines are
//! drawn in their order onto a copy of the tile that stays in the cache. Class: image space. Cost: O(lines · tiles
//! touched + pixels). A piece of a line starts with the fraction that the whole line has there, so the pixels are
//! exactly those of [`super::bresenham`]. Limits: as in `bresenham`.

use super::pieces::{AT_ONCE, Ends, PIXELS, Pieces, SHORT, TILE_BITS};
use super::{Course, Options, bresenham};
use crate::info::{Class, Coherence, Info, Occluder};
use crate::math::IVec2;
use crate::simd::{Level, default_level};
use crate::target::Pixels;
use crate::trace::{NoTrace, Tracer};

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "tiled-lines",
    title: "Lines tile by tile",
    authors: "H. Fuchs, J. Poulton, J. Eyles, T. Greer, J. Goldfeather, D. Ellsworth, S. Molnar, G. Turk, B. Tebbs, L. Israel",
    year: 1989,
    source: "Pixel-Planes 5: A heterogeneous multiprocessor graphics system using processor-enhanced memories, SIGGRAPH",
    class: Class::ImageSpace,
    occluder: Occluder::None,
    coherence: &[Coherence::Area],
    cost: "O(e + p): e tiles that the boxes of the lines touch, p pixels",
    limits: "thin lines between pixels; slower than line by line if there are few lines",
    pseudocode: &[],
};

/// Side of a tile, pixels. With four bytes per pixel a tile is 64 KiB, which fits in the second-level cache, and most
/// of it in the first.
const TILE: i32 = 1 << TILE_BITS;
/// Lines that are sorted into tiles at a time, which bounds the memory to twenty bytes or so, with 4-byte pixels, for
/// each tile that one of them touches.
const BATCH: usize = 1 << 18;
/// Groups of lines that are set up before the first of them is drawn.
const AHEAD: usize = 2;
/// Number of lines below which a tile is not worth copying.
const FEW: usize = 24;
/// Bits of the distance across below the pixel.
const BITS: u32 = 40;
/// Lines with up to this many steps are followed in binary fractions; as 2 · steps · (steps + 1) < 2³⁹ they come
/// out exact.
const EXACT_STEPS: i64 = 1 << 19;

/// A line between two pixels, both included, and the value that it writes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PixelLine<T> {
    /// First pixel, column and row.
    pub from: IVec2,
    /// Last pixel.
    pub to: IVec2,
    /// New value of its pixels.
    pub value: T,
}

/// Step of the algorithm: the part of a line in a tile.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Step<T> {
    /// First and last pixel of the tile, both included; tiles at the target's border end with it.
    pub tile: (IVec2, IVec2),
    /// The line; parts outside the tile are drawn with other tiles.
    pub line: PixelLine<T>,
}

/// Draws lines in their order: pixels of several lines have the value of the last. Pixels outside the target are left
/// out.
///
/// Draws the same pixels as [`super::bresenham::draw`], line by line, in less than half the time if there are many
/// lines. Memory: a share of the lines at a time, about 10 MB with short lines and 4-byte pixels.
///
/// ```
/// use durer::math::IVec2;
/// use durer::raster::line::tiled::{PixelLine, draw};
/// use durer::target::Pixels;
/// use durer::trace::NoTrace;
///
/// let mut picture = Pixels::new(5, 3, '.');
/// let line = |from: (i32, i32), to: (i32, i32), value| PixelLine { from: from.into(), to: to.into(), value };
/// let lines = [line((0, 0), (4, 2), 'a'), line((2, -5), (2, 9), 'b')];
/// draw(&lines, &mut picture, &mut NoTrace);
/// assert_eq!(String::from_iter(picture.data()), "aab....ba...b.a".to_owned());
/// ```
pub fn draw<T: Copy>(lines: &[PixelLine<T>], target: &mut Pixels<T>, t: &mut impl Tracer<Step<T>>) {
    draw_at(default_level(), lines, target, t);
}

fn draw_at<T: Copy>(
    level: Level,
    lines: &[PixelLine<T>],
    target: &mut Pixels<T>,
    t: &mut impl Tracer<Step<T>>,
) {
    let Some(first) = lines.first() else { return };
    let mut tiles = Tiles {
        across: (target.width().div_ceil(TILE as u32) as usize).max(1),
        size: (i64::from(target.width()), i64::from(target.height())),
        starts: Vec::new(),
        entries: Vec::new(),
        copy: vec![first.value; PIXELS],
    };
    for lines in lines.chunks(BATCH) {
        tiles.sort(lines);
        tiles.draw(level, target, t);
    }
}

/// Lines sorted by the tiles that their boxes touch.
struct Tiles<T> {
    /// Tiles of a row.
    across: usize,
    /// Pixels of the target.
    size: (i64, i64),
    /// Start of each tile's entries, and the end of the last.
    starts: Vec<u32>,
    entries: Vec<PixelLine<T>>,
    /// The pixels of one tile.
    copy: Vec<T>,
}

impl<T: Copy> Tiles<T> {
    /// Calls `f` with the number of each tile that the box of a line touches.
    #[inline(always)]
    fn each(&self, line: &PixelLine<T>, mut f: impl FnMut(usize)) {
        let range = |a: i32, b: i32, side: i64| {
            let low = i64::from(a.min(b)).max(0) >> TILE_BITS;
            let high = i64::from(a.max(b)).min(side - 1) >> TILE_BITS;
            low as usize..(high + 1).max(low) as usize
        };
        for row in range(line.from.y, line.to.y, self.size.1) {
            range(line.from.x, line.to.x, self.size.0).for_each(|x| f(row * self.across + x));
        }
    }

    /// Sorts lines by their tiles, by counting.
    fn sort(&mut self, lines: &[PixelLine<T>]) {
        let down = (self.size.1 as usize).div_ceil(TILE as usize);
        let mut starts = std::mem::take(&mut self.starts);
        starts.clear();
        starts.resize(self.across * down + 1, 0);
        for line in lines {
            self.each(line, |tile| starts[tile] += 1);
        }
        let mut sum = 0_u32;
        for start in &mut starts {
            sum += std::mem::replace(start, sum);
        }
        let mut entries = std::mem::take(&mut self.entries);
        if let Some(first) = lines.first() {
            entries.resize(sum as usize, *first);
        }
        for line in lines {
            self.each(line, |tile| {
                entries[starts[tile] as usize] = *line;
                starts[tile] += 1;
            });
        }
        // Each start has advanced to the start of the next tile.
        starts.rotate_right(1);
        starts[0] = 0;
        (self.starts, self.entries) = (starts, entries);
    }

    /// Draws the lines of all tiles.
    fn draw(&mut self, level: Level, target: &mut Pixels<T>, t: &mut impl Tracer<Step<T>>) {
        let Self { across, size, starts, entries, copy } = self;
        let Some(copy) = copy.first_chunk_mut::<PIXELS>() else { return };
        for (i, range) in starts.windows(2).enumerate() {
            let lines = &entries[range[0] as usize..range[1] as usize];
            let corner = IVec2::new((i % *across) as i32, (i / *across) as i32) * TILE;
            let size = IVec2::new(size.0 as i32, size.1 as i32);
            let end = size.min(corner + TILE);
            lines.iter().for_each(|line| t.step(|| Step { tile: (corner, end - 1), line: *line }));
            draw_tile(level, lines, (corner, end), copy, target);
        }
    }
}

/// Draws the lines of a tile between two corners.
fn draw_tile<T: Copy>(
    level: Level,
    lines: &[PixelLine<T>],
    (corner, end): (IVec2, IVec2),
    copy: &mut [T; PIXELS],
    target: &mut Pixels<T>,
) {
    if lines.len() < FEW {
        let options = Options { window: Some((corner, end - 1)) };
        for line in lines {
            let plot = |p: IVec2| target.set(p.x as u32, p.y as u32, line.value);
            bresenham::draw(line.from, line.to, &options, plot, &mut NoTrace);
        }
        return;
    }
    let columns = corner.x as usize..end.x as usize;
    let rows = corner.y as u32..end.y as u32;
    for (y, row) in rows.clone().zip(copy.chunks_exact_mut(TILE as usize)) {
        row[..columns.len()].copy_from_slice(&target.row(y)[columns.clone()]);
    }
    // The set-up of several lines, with its slow divisions, is in progress while the first of them is drawn.
    let mut pieces = [Pieces::default(); AHEAD];
    let size = (end.x - corner.x, end.y - corner.y);
    for lines in lines.chunks(AHEAD * AT_ONCE) {
        for (pieces, lines) in pieces.iter_mut().zip(lines.chunks(AT_ONCE)) {
            pieces.set_up(level, &ends(lines, corner), size);
        }
        for (pieces, lines) in pieces.iter().zip(lines.chunks(AT_ONCE)) {
            for (i, line) in lines.iter().enumerate() {
                if is_short(line) {
                    pieces.draw(i, line.value, copy);
                } else {
                    draw_long(line, corner, end, copy);
                }
            }
        }
    }
    for (y, row) in rows.zip(copy.chunks_exact(TILE as usize)) {
        target.row_mut(y)[columns.clone()].copy_from_slice(&row[..columns.len()]);
    }
}

/// Returns whether a line may be set up with others.
#[inline(always)]
fn is_short<T>(line: &PixelLine<T>) -> bool {
    line.from.x.abs_diff(line.to.x).max(line.from.y.abs_diff(line.to.y)) <= SHORT
}

/// Returns short lines as seen from a corner of a tile that their boxes touch; other lines are left at 0.
#[inline(always)]
fn ends<T>(lines: &[PixelLine<T>], corner: IVec2) -> Ends {
    let mut ends = Ends::default();
    for (i, line) in lines.iter().enumerate().take(AT_ONCE).filter(|(_, line)| is_short(line)) {
        let (from, to) = (line.from - corner, line.to - corner);
        (ends.x0[i], ends.y0[i]) = (from.x, from.y);
        (ends.x1[i], ends.y1[i]) = (to.x, to.y);
    }
    ends
}

/// Draws the part of a long line within a tile, onto the tile's copy.
#[inline(never)]
fn draw_long<T: Copy>(line: &PixelLine<T>, corner: IVec2, end: IVec2, copy: &mut [T; PIXELS]) {
    let seen =
        |p: IVec2| (i64::from(p.x) - i64::from(corner.x), i64::from(p.y) - i64::from(corner.y));
    let course = Course::between(seen(line.from), seen(line.to));
    if course.steps > EXACT_STEPS {
        let options = Options { window: Some((corner, end - 1)) };
        let plot = |p: IVec2| {
            let at = p - corner;
            if let Some(pixel) = copy.get_mut((at.y * TILE + at.x) as usize) {
                *pixel = line.value;
            }
        };
        bresenham::draw(line.from, line.to, &options, plot, &mut NoTrace);
        return;
    }
    let size = course.turned(seen(end));
    // After k steps the distance across is the whole part of start + k · slope. Both are slightly too large, by less
    // than the distance to the next multiple of 1/(2 · steps).
    let one = (1_i64 << BITS) as f64;
    let whole = course.steps.max(1) as f64;
    let slope = (course.rise as f64 / whole * one) as i64 + 1;
    let half = (course.steps - i64::from(course.sign >= 0)).max(0);
    let start = (half as f64 / (2.0 * whole) * one) as i64 + 1;
    let reaches = |distance: i64| match distance {
        ..=0 => 0,
        d if d > course.rise => course.steps + 1,
        d => ((d << BITS) - start + slope - 1).max(0) / slope,
    };
    let (mut first, mut last) =
        ((-course.along).max(0), course.steps.min(size.0 - 1 - course.along));
    let (near, far) = if course.sign < 0 {
        (course.across - (size.1 - 1), course.across)
    } else {
        (-course.across, size.1 - 1 - course.across)
    };
    if near > 0 {
        first = first.max(reaches(near));
    }
    if far < course.rise {
        last = last.min(reaches(far + 1) - 1);
    }
    let (step, stride) = if course.steep { (i64::from(TILE), 1) } else { (1, i64::from(TILE)) };
    let mut base = (course.along + first) * step + course.across * stride;
    let mut sum = start + first * slope;
    let stride = stride * course.sign;
    for _ in first..last + 1 {
        if let Some(pixel) = copy.get_mut((base + (sum >> BITS) * stride) as usize) {
            *pixel = line.value;
        }
        base += step;
        sum += slope;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_simd_level_draws_the_same_pixels() {
        let mut seed = 5_u64;
        let mut random = |side: i64| {
            seed = seed
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            ((seed >> 33) as i64 % side - 40) as i32
        };
        let lines: Vec<PixelLine<u16>> = (0..3000)
            .map(|value| {
                let (from, reach) =
                    (IVec2::new(random(330), random(310)), [9, 90, 700][usize::from(value) % 3]);
                PixelLine { from, to: from + IVec2::new(random(reach), random(reach)), value }
            })
            .collect();
        let at = |level| {
            let mut picture = Pixels::new(300, 270, u16::MAX);
            draw_at(level, &lines, &mut picture, &mut NoTrace);
            picture
        };
        let mut expected = Pixels::new(300, 270, u16::MAX);
        for line in &lines {
            let options = Options { window: Some((IVec2::ZERO, IVec2::new(299, 269))) };
            let plot = |p: IVec2| expected.set(p.x as u32, p.y as u32, line.value);
            bresenham::draw(line.from, line.to, &options, plot, &mut NoTrace);
        }
        assert!(at(Level::new()) == expected);
        assert!(at(Level::baseline()) == expected);
    }
}
