//! The triangles that touch a row of pixels, from front to back.

use super::fragment::Face;
use crate::raster::fixed::SUBPIXEL_BITS;
use crate::visibility::surface::input::SurfaceInput;
use crate::visibility::surface::setup::ScreenTriangle;
use fearless_simd::Simd;

/// The triangles that touch a row anywhere, not only at pixels' centres.
///
/// They come by their smallest depth, so that most of what is hidden in a pixel comes after what
/// hides it. The picture does not depend on that order, only the work.
pub struct Faces<'a> {
    input: &'a SurfaceInput<'a>,
    /// The triangles by first row.
    waiting: Vec<Active>,
    /// Where each row's begin; one more than there are rows.
    starts: Vec<u32>,
    active: Vec<Active>,
    /// The active ones of the row before, while the next row's are put together.
    before: Vec<Active>,
    /// Depth and number of those that begin in the row.
    order: Vec<u64>,
    /// What was computed of those that were looked at, by place; some places are free.
    places: Vec<Face>,
    free: Vec<u32>,
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
    /// Where its face is kept; [`NOWHERE`] as long as all of it was hidden.
    place: u32,
}

/// No place.
const NOWHERE: u32 = u32::MAX;

impl<'a> Faces<'a> {
    pub fn new(input: &'a SurfaceInput<'a>, height: u32) -> Self {
        let first_row = |t: &ScreenTriangle| {
            let [first, last] = touched(&t.y);
            let seen = last >= 0 && i64::from(first) < i64::from(height);
            seen.then_some(first.max(0) as usize)
        };
        // Counting sort.
        let mut starts = vec![0; height as usize + 2];
        for row in input.triangles.iter().filter_map(first_row) {
            starts[row + 2] += 1;
        }
        for row in 2..starts.len() {
            starts[row] += starts[row - 1];
        }
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
            waiting,
            starts,
            active: Vec::new(),
            before: Vec::new(),
            order: Vec::new(),
            places: Vec::new(),
            free: Vec::new(),
        }
    }

    /// Goes on to a row; rows come in order.
    pub fn advance(&mut self, y: i32) {
        let Self { waiting, starts, active, before, order, free, .. } = self;
        std::mem::swap(active, before);
        active.clear();
        let [first, end] = [0, 1].map(|i| starts[y as usize + i] as usize);
        let new = &waiting[first..end];
        // Depths are at least 0, so that their bits grow with them.
        let key =
            |(i, new): (usize, &Active)| u64::from((new.depth + 0.0).to_bits()) << 32 | i as u64;
        order.clear();
        order.extend(new.iter().enumerate().map(key));
        order.sort_unstable();
        let mut new = order.iter().map(|&key| new[key as u32 as usize]).peekable();
        for old in before.iter() {
            if old.last_row < y {
                free.extend((old.place != NOWHERE).then_some(old.place));
                continue;
            }
            while let Some(nearer) = new.next_if(|new| new.depth <= old.depth) {
                active.push(nearer);
            }
            active.push(*old);
        }
        active.extend(new);
    }

    /// How many triangles touch the row.
    pub fn count(&self) -> usize {
        self.active.len()
    }

    /// One of them; they are counted front to back by their smallest depths.
    #[inline(always)]
    pub fn active(&self, number: usize) -> &Active {
        &self.active[number]
    }

    /// What is known of one of them.
    #[inline(always)]
    pub fn get<S: Simd>(&mut self, simd: S, number: usize) -> (&'a ScreenTriangle, &Face) {
        let active = &mut self.active[number];
        let t = &self.input.triangles[active.triangle as usize];
        if active.place == NOWHERE {
            let face = Face::new(simd, t, active.triangle, self.input.run_of(t.item).coverage);
            active.place = match self.free.pop() {
                Some(place) => {
                    self.places[place as usize] = face;
                    place
                }
                None => {
                    self.places.push(face);
                    self.places.len() as u32 - 1
                }
            };
        }
        (t, &self.places[active.place as usize])
    }
}

impl Active {
    const NONE: Self =
        Self { depth: 0.0, columns: [0; 2], last_row: -1, triangle: 0, place: NOWHERE };

    fn new(t: &ScreenTriangle, triangle: u32) -> Self {
        let ([left, right], [_, last_row]) = (touched(&t.x), touched(&t.y));
        Self { depth: t.depth_min, columns: [left, right + 1], last_row, triangle, place: NOWHERE }
    }
}

/// The first and the last pixel in one direction that a triangle touches.
fn touched([a, b, c]: &[i32; 3]) -> [i32; 2] {
    let (low, high) = (*a.min(b).min(c), *a.max(b).max(c));
    [low >> SUBPIXEL_BITS, (high - 1) >> SUBPIXEL_BITS]
}
