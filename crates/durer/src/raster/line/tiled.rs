//! Many thin lines of many colours: Bresenham's pixels, tile by tile.
//!
//! Lines one by one wait for memory, for each is somewhere else. Here they are first sorted into the tiles that
//! their boxes touch, as in H. Fuchs et al., *Pixel-Planes 5*, SIGGRAPH 1989, then each tile's lines are drawn in
//! their order onto a copy of the tile that stays in the cache. Class: image space. Cost: O(lines · tiles touched +
//! pixels). A piece of a line is entered with the fraction it has there, so the pixels are
//! [`super::bresenham`]'s, all of them. Limits: as there.

use super::{Course, Options, bresenham};
use crate::info::{Class, Info};
use crate::math::IVec2;
use crate::target::Pixels;
use crate::trace::NoTrace;

/// The facts.
pub const INFO: Info = Info {
    name: "tiled-lines",
    title: "Lines tile by tile",
    authors: "H. Fuchs, J. Poulton, J. Eyles, T. Greer, J. Goldfeather, D. Ellsworth, S. Molnar, G. Turk, B. Tebbs, L. Israel",
    year: 1989,
    source: "Pixel-Planes 5: A heterogeneous multiprocessor graphics system using processor-enhanced memories, SIGGRAPH",
    class: Class::ImageSpace,
    cost: "O(e + p): e tiles that the boxes of the lines touch, p pixels",
    limits: "thin lines between pixels; slower than one by one where there are few",
};

/// Pixels of a tile's side, as a power of two: with four bytes a pixel 64 KiB, which the second-level cache holds,
/// and most of it the first.
const TILE_BITS: u32 = 7;
/// Pixels of a tile's side.
const TILE: i32 = 1 << TILE_BITS;
/// Entries of all tiles that are kept before they are drawn, which bounds the memory: 20 bytes each with 4-byte
/// pixels, more only where the lines of one tile are more.
const BATCH: usize = 1 << 21;
/// With fewer lines than this a tile is not worth copying.
const FEW: usize = 24;
/// Bits of the distance across below the pixel.
const BITS: u32 = 40;
/// Lines with up to so many steps are followed in binary fractions; as 2 · steps · (steps + 1) < 2³⁹ they come out
/// exact.
const EXACT_STEPS: i64 = 1 << 19;

/// A line between two pixels, both included, and what it leaves there.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Line<T> {
    /// First pixel, column and row.
    pub from: IVec2,
    /// Last pixel.
    pub to: IVec2,
    /// What its pixels become.
    pub value: T,
}

/// Draws lines in their order: pixels of several have the value of the last. What lies outside the target is left out.
///
/// The same pixels as [`super::bresenham::draw`] lights, one line after the other, in about half the time where
/// there are many. Memory: a share of the lines at a time, up to 40 MB with 4-byte pixels.
///
/// ```
/// use durer::math::IVec2;
/// use durer::raster::line::tiled::{Line, draw};
/// use durer::target::Pixels;
///
/// let mut picture = Pixels::new(5, 3, '.');
/// let line = |from: (i32, i32), to: (i32, i32), value| Line { from: from.into(), to: to.into(), value };
/// draw(&[line((0, 0), (4, 2), 'a'), line((2, -5), (2, 9), 'b')], &mut picture);
/// assert_eq!(String::from_iter(picture.data()), "aab....ba...b.a".to_owned());
/// ```
pub fn draw<T: Copy>(lines: &[Line<T>], target: &mut Pixels<T>) {
    let Some(first) = lines.first() else { return };
    let across = (target.width().div_ceil(TILE as u32) as usize).max(1);
    let down = target.height().div_ceil(TILE as u32) as usize;
    let size = (i64::from(target.width()), i64::from(target.height()));
    let mut buckets: Vec<Vec<Line<T>>> = vec![Vec::new(); across * down];
    let mut canvas = vec![first.value; (TILE * TILE) as usize];
    let mut kept = 0;
    for line in lines {
        let range = |a: i32, b: i32, side: i64| {
            let low = i64::from(a.min(b)).max(0) >> TILE_BITS;
            let high = i64::from(a.max(b)).min(side - 1) >> TILE_BITS;
            low as usize..(high + 1).max(low) as usize
        };
        let columns = range(line.from.x, line.to.x, size.0);
        for row in range(line.from.y, line.to.y, size.1) {
            let start = row * across;
            let tiles = buckets.get_mut(start + columns.start..start + columns.end);
            for bucket in tiles.into_iter().flatten() {
                bucket.push(*line);
                kept += 1;
            }
        }
        if kept >= BATCH {
            empty(&mut buckets, across, &mut canvas, target);
            kept = 0;
        }
    }
    empty(&mut buckets, across, &mut canvas, target);
}

/// Draws what the buckets hold.
fn empty<T: Copy>(
    buckets: &mut [Vec<Line<T>>],
    across: usize,
    canvas: &mut [T],
    target: &mut Pixels<T>,
) {
    for (i, bucket) in buckets.iter_mut().enumerate().filter(|(_, b)| !b.is_empty()) {
        let corner = IVec2::new((i % across) as i32, (i / across) as i32) * TILE;
        let end = IVec2::new(
            target.width().min((corner.x + TILE) as u32) as i32,
            target.height().min((corner.y + TILE) as u32) as i32,
        );
        if bucket.len() < FEW {
            let options = Options { window: Some((corner, end - 1)) };
            for line in bucket.iter() {
                let plot = |p: IVec2| target.set(p.x as u32, p.y as u32, line.value);
                bresenham::draw(line.from, line.to, &options, plot, &mut NoTrace);
            }
        } else {
            let columns = corner.x as usize..end.x as usize;
            let rows = corner.y as u32..end.y as u32;
            for (y, row) in rows.clone().zip(canvas.chunks_exact_mut(TILE as usize)) {
                row[..columns.len()].copy_from_slice(&target.row(y)[columns.clone()]);
            }
            bucket.iter().for_each(|line| in_tile(line, corner, end, canvas));
            for (y, row) in rows.zip(canvas.chunks_exact(TILE as usize)) {
                target.row_mut(y)[columns.clone()].copy_from_slice(&row[..columns.len()]);
            }
        }
        bucket.clear();
    }
}

/// Draws the part of a line within a tile, onto the tile's copy.
fn in_tile<T: Copy>(line: &Line<T>, corner: IVec2, end: IVec2, canvas: &mut [T]) {
    let seen =
        |p: IVec2| (i64::from(p.x) - i64::from(corner.x), i64::from(p.y) - i64::from(corner.y));
    let course = Course::between(seen(line.from), seen(line.to));
    if course.steps > EXACT_STEPS {
        let options = Options { window: Some((corner, end - 1)) };
        let plot = |p: IVec2| {
            let at = p - corner;
            if let Some(pixel) = canvas.get_mut((at.y * TILE + at.x) as usize) {
                *pixel = line.value;
            }
        };
        bresenham::draw(line.from, line.to, &options, plot, &mut NoTrace);
        return;
    }
    let size = course.turned(seen(end));
    // After k steps the distance across is the whole part of start + k · slope. Both are a little too large, by less
    // than the next multiple of 1/(2 · steps) is away.
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
        if let Some(pixel) = canvas.get_mut((base + (sum >> BITS) * stride) as usize) {
            *pixel = line.value;
        }
        base += step;
        sum += slope;
    }
}
