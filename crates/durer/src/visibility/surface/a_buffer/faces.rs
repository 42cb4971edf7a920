//! The triangles that touch a row of pixels, from front to back.

use super::face::Face;
use crate::raster::fixed::SUBPIXEL_BITS;
use crate::visibility::surface::input::SurfaceInput;
use crate::visibility::surface::setup::{Coverage, ScreenTriangle};
use fearless_simd::Simd;

/// The triangles that touch a row anywhere, not only at pixels' centres.
///
/// They are ordered by smallest depth, so that most hidden fragments of a pixel follow the fragments that hide them.
/// The order affects the amount of work, not the picture.
pub struct Faces<'a> {
    input: &'a SurfaceInput<'a>,
    /// The first row.
    top: i32,
    /// The triangles by first row.
    waiting: Vec<Active>,
    /// Start of each row's list; one more than there are rows.
    starts: Vec<u32>,
    active: Vec<Active>,
    /// The active triangles of the previous row, while the next row's list is built.
    before: Vec<Active>,
    /// Depths and numbers of the triangles that begin in the row.
    order: Vec<u64>,
    /// Slots for active triangles, each with its computed data if the triangle has been used; some slots are free.
    places: Vec<(ScreenTriangle, Face)>,
    free: Vec<u32>,
    /// True if some items come in several pieces.
    pub in_pieces: bool,
    /// The run of the latest item that was requested: its first item, how many it has, and how it covers.
    run: (u32, u32, Coverage),
}

/// A triangle that touches the row.
#[derive(Debug, Clone, Copy)]
pub struct Active {
    /// Its smallest depth.
    pub depth: f32,
    /// The first column that it touches anywhere, and the one after the last.
    pub columns: [i32; 2],
    last_row: i32,
    triangle: u32,
    /// Its slot while it is active.
    place: u32,
}

impl<'a> Faces<'a> {
    /// Bytes for each triangle of the input.
    pub const PER_TRIANGLE: u64 = size_of::<Active>() as u64;

    /// Returns the bytes for the triangles of a row.
    pub fn bytes(&self) -> u64 {
        let active = (self.active.capacity() + self.before.capacity()) * size_of::<Active>();
        let places = self.places.capacity() * size_of::<(ScreenTriangle, Face)>();
        let order = self.order.capacity() * size_of::<u64>() + self.free.capacity() * 4;
        (active + places + order + self.starts.len() * size_of::<u32>()) as u64
    }

    /// Sorts the triangles by the first of the rows `top` … `end` − 1 that they touch.
    pub fn new(input: &'a SurfaceInput<'a>, [top, end]: [i32; 2]) -> Self {
        let first_row = |t: &ScreenTriangle| {
            let [first, last] = touched(&t.y);
            (last >= top && first < end).then_some((first.max(top) - top) as usize)
        };
        // Counting sort.
        let mut starts = vec![0; (end - top).max(0) as usize + 2];
        let (mut in_pieces, mut latest) = (false, None);
        // Count the triangles of each row; parts of one item are adjacent in the input.
        for t in &input.triangles {
            in_pieces |= latest.replace(t.item) == Some(t.item);
            if let Some(row) = first_row(t) {
                starts[row + 2] += 1;
            }
        }
        // Sums of the counts are the places where the rows begin.
        for row in 2..starts.len() {
            starts[row] += starts[row - 1];
        }
        // Place each triangle in its row; the entries that advance end as the starts of the next rows.
        let mut waiting = vec![Active::NONE; starts.last().map_or(0, |&n| n as usize)];
        for (index, t) in input.triangles.iter().enumerate() {
            if let Some(row) = first_row(t) {
                let place = &mut starts[row + 1];
                waiting[*place as usize] = Active::new(t, index as u32);
                *place += 1;
            }
        }
        Self {
            input,
            top,
            waiting,
            starts,
            active: Vec::new(),
            before: Vec::new(),
            order: Vec::new(),
            places: Vec::new(),
            free: Vec::new(),
            in_pieces,
            run: (0, 0, Coverage::Opaque),
        }
    }

    /// Advances to a row; rows must be in order.
    pub fn advance(&mut self, y: i32) {
        let Self { input, waiting, starts, active, before, order, places, free, .. } = self;
        std::mem::swap(active, before);
        active.clear();
        let [first, end] = [0, 1].map(|i| starts[(y - self.top) as usize + i] as usize);
        let new = &mut waiting[first..end];
        for new in new.iter_mut() {
            // All at once, because they have to be waited for.
            let t = input.triangles[new.triangle as usize];
            new.place = free.pop().unwrap_or(places.len() as u32);
            match places.get_mut(new.place as usize) {
                Some(place) => place.0 = t,
                None => places.push((t, Face::NONE)),
            }
        }
        // Depths are at least 0, so that their bits grow with them.
        let key =
            |(i, new): (usize, &Active)| u64::from((new.depth + 0.0).to_bits()) << 32 | i as u64;
        order.clear();
        order.extend(new.iter().enumerate().map(key));
        order.sort_unstable();
        let mut new = order.iter().map(|&key| new[key as u32 as usize]).peekable();
        for old in before.iter() {
            if old.last_row < y {
                free.push(old.place);
                continue;
            }
            while let Some(nearer) = new.next_if(|new| new.depth <= old.depth) {
                active.push(nearer);
            }
            active.push(*old);
        }
        active.extend(new);
    }

    /// Returns the number of triangles that touch the row.
    pub fn count(&self) -> usize {
        self.active.len()
    }

    /// Returns one of them; they are counted front to back by their smallest depths.
    #[inline(always)]
    pub fn active(&self, number: usize) -> &Active {
        &self.active[number]
    }

    /// Returns one of the triangles and its face.
    #[inline(always)]
    pub fn get<S: Simd>(&mut self, simd: S, number: usize) -> &(ScreenTriangle, Face) {
        let active = &self.active[number];
        let place = &mut self.places[active.place as usize];
        if place.1.triangle != active.triangle {
            let t = &place.0;
            if t.item.wrapping_sub(self.run.0) >= self.run.1 {
                let run = self.input.run_of(t.item);
                self.run = (run.first_item, run.range.len() as u32, run.coverage);
            }
            place.1 = Face::new(simd, t, active.triangle, self.run.2);
        }
        place
    }
}

impl Active {
    const NONE: Self = Self { depth: 0.0, columns: [0; 2], last_row: -1, triangle: 0, place: 0 };

    fn new(t: &ScreenTriangle, triangle: u32) -> Self {
        let ([left, right], [_, last_row]) = (touched(&t.x), touched(&t.y));
        Self { depth: t.depth_min, columns: [left, right + 1], last_row, triangle, place: 0 }
    }
}

/// Returns the first and the last pixel in one direction that a triangle touches.
fn touched([a, b, c]: &[i32; 3]) -> [i32; 2] {
    let (low, high) = (*a.min(b).min(c), *a.max(b).max(c));
    [low >> SUBPIXEL_BITS, (high - 1) >> SUBPIXEL_BITS]
}
