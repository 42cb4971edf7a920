//! Coverage masks by table look-up from the normalized edge function.
//!
//! An edge function a·u + b·v + e, with u and v from −½ to ½ in the pixel and |a| + |b| = 1, is positive in all of the
//! pixel from e = ½ on and nowhere below −½. In between, the table has for each direction (a, b) and each e the bits of
//! the sub-pixels on the positive side: their number follows from the exact area, and they are the ones with the
//! largest values of the function.

use super::SubpixelMask;
use crate::sorting::CompactSort;
use fearless_simd::{Simd, f32x8, prelude::*};

/// Pixels that are examined together.
pub const EIGHT: usize = 8;

/// Directions in a quadrant. Coarser ones turn edges by more than a sub-pixel's width.
const DIRECTIONS: usize = 32;

/// Steps of e from −½ to ½: half of the difference of neighbouring counts of 64 sub-pixels.
const DISTANCES: usize = 128;

/// Masks in the table; a power of two.
const ENTRIES: usize = 2 * DIRECTIONS * DISTANCES;

/// The masks of half planes for one size of mask.
pub struct MaskTable {
    /// Sub-pixels along the side of a pixel.
    side: u32,
    centers: Vec<[f32; 2]>,
    /// The same, eight at a time.
    centers_x8: Vec<[[f32; 8]; 2]>,
    masks: Masks,
}

/// Masks by direction, then distance; upper half plane of directions only. Stored in the smallest integer type, because
/// masks of sixteen bits fit in the first-level cache.
enum Masks {
    Sixteen(Box<[u16; ENTRIES]>),
    SixtyFour(Box<[u64; ENTRIES]>),
}

impl Masks {
    fn new(masks: Box<[u64; ENTRIES]>, side: u32) -> Self {
        if side * side > 16 {
            return Self::SixtyFour(masks);
        }
        Self::Sixteen(Box::new(masks.map(|mask| mask as u16)))
    }

    #[inline(always)]
    fn get(&self, index: usize) -> u64 {
        match self {
            Self::Sixteen(masks) => u64::from(masks[index % ENTRIES]),
            Self::SixtyFour(masks) => masks[index % ENTRIES],
        }
    }
}

/// The last place among a direction's masks. The first mask has no bits and the last has all of them,
/// so distances beyond the table give the right mask too.
const LAST_DISTANCE: f32 = (DISTANCES - 1) as f32;

/// A linear function on a pixel, divided by |a| + |b|: the direction's part.
#[derive(Debug, Clone, Copy)]
pub struct Direction {
    /// Start of the direction's masks in the table.
    start: u32,
    /// ±1 / (|a| + |b|), below 0 where the table has the opposite direction, so that masks are turned
    /// over; 0 for a function without slope.
    pub scale: f32,
}

impl Direction {
    /// Direction of a function without slope.
    pub const NONE: Self = Self { start: 0, scale: 0.0 };

    /// Creates the direction of a function that grows by `a` per pixel to the right and `b`
    /// downwards.
    #[inline(always)]
    pub fn new(a: f32, b: f32) -> Self {
        let length = a.abs() + b.abs();
        if length == 0.0 || !length.is_finite() {
            return Self::NONE;
        }
        // A function and its opposite use the same masks, so that they never overlap or leave a gap.
        let opposite = b < 0.0 || (b == 0.0 && a < 0.0);
        let (a, b) = if opposite { (-a, -b) } else { (a, b) };
        // Along the diamond |a| + |b| = 1 from (1, 0) by (0, 1) to (−1, 0).
        let along = if a >= 0.0 { b / length } else { 2.0 - b / length };
        let index = ((along * DIRECTIONS as f32) as usize).min(2 * DIRECTIONS - 1);
        let scale = 1.0 / length;
        let scale = if opposite { -scale } else { scale };
        Self { start: (index * DISTANCES) as u32, scale }
    }
}

/// Masks of three half planes in eight pixels, still to be looked up.
pub struct Common {
    /// In the table.
    places: [[i32; EIGHT]; 3],
    /// The bits to invert in each.
    turned: [u64; 3],
}

impl Common {
    /// Returns the sub-pixels of a pixel that all three have in common.
    #[inline(always)]
    pub fn get(&self, table: &MaskTable, pixel: usize) -> u64 {
        let [p, q, r] = &self.places;
        let of = |places: &[i32; EIGHT]| table.masks.get(places[pixel % EIGHT] as usize);
        let [a, b, c] = self.turned;
        (of(p) ^ a) & (of(q) ^ b) & (of(r) ^ c)
    }
}

impl MaskTable {
    pub fn new(mask: SubpixelMask) -> Self {
        let side = mask.side();
        let mut masks = Box::new([0; ENTRIES]);
        for (index, masks) in masks.chunks_exact_mut(DISTANCES).enumerate() {
            let along = (index as f32 + 0.5) / DIRECTIONS as f32;
            let (a, b) =
                if along <= 1.0 { (1.0 - along, along) } else { (1.0 - along, 2.0 - along) };
            masks_of_direction(side, a, b, masks);
        }
        let centers: Vec<[f32; 2]> = centers(side).collect();
        let (eights, _) = centers.as_chunks::<8>();
        let centers_x8 = eights.iter().map(|c| [0, 1].map(|axis| c.map(|p| p[axis]))).collect();
        Self { side, centers, centers_x8, masks: Masks::new(masks, side) }
    }

    /// Returns the mask with all bits.
    #[inline(always)]
    pub fn full(&self) -> u64 {
        u64::MAX >> (64 - self.side * self.side)
    }

    /// Returns the sub-pixels where a function of this direction is positive whose value at the
    /// pixel's centre is `center`, not divided.
    #[inline(always)]
    pub fn half_plane(&self, direction: &Direction, center: f32) -> u64 {
        let e = center * direction.scale;
        let step = ((e + 0.5) * DISTANCES as f32).clamp(0.0, LAST_DISTANCE);
        self.mask(direction, step as i32)
    }

    /// Returns the sub-pixels where three functions are positive, in eight pixels, at whose centres
    /// they have these values, not divided, times `scale`.
    #[inline(always)]
    pub fn common<S: Simd>(
        &self,
        simd: S,
        scale: f32,
        functions: [(&Direction, f32x8<S>); 3],
    ) -> Common {
        let (zero, last) = (f32x8::splat(simd, 0.0), f32x8::splat(simd, LAST_DISTANCE));
        let (mut places, mut turned) = ([[0; EIGHT]; 3], [0; 3]);
        for (i, (direction, centers)) in functions.iter().enumerate() {
            // Scaling by powers of two does not change the rounding.
            let per_center = direction.scale * (DISTANCES as f32 / scale);
            let step = *centers * per_center + 0.5 * DISTANCES as f32;
            let place = simd.cvt_i32_f32x8(step.max(zero).min(last));
            places[i] = (place + direction.start.cast_signed()).into();
            turned[i] = self.turned(direction);
        }
        Common { places, turned }
    }

    /// Returns a mask of a direction.
    #[inline(always)]
    fn mask(&self, direction: &Direction, distance: i32) -> u64 {
        self.masks.get(direction.start as usize + distance as usize) ^ self.turned(direction)
    }

    /// Returns the bits to be turned over in a direction's masks.
    #[inline(always)]
    fn turned(&self, direction: &Direction) -> u64 {
        if direction.scale < 0.0 { self.full() } else { 0 }
    }

    /// Returns the centres of the sub-pixels, from the pixel's, eight at a time: x and y.
    #[inline(always)]
    pub fn centers_x8(&self) -> &[[[f32; 8]; 2]] {
        &self.centers_x8
    }

    /// Returns the centres of the sub-pixels, from the pixel's, bit by bit.
    #[inline(always)]
    pub fn centers(&self) -> &[[f32; 2]] {
        &self.centers
    }
}

fn centers(side: u32) -> impl Iterator<Item = [f32; 2]> {
    let at = move |i: u32| (i as f32 + 0.5) / side as f32 - 0.5;
    (0..side * side).map(move |bit| [at(bit % side), at(bit / side)])
}

/// Makes the masks of one direction, for e from −½ to ½.
fn masks_of_direction(side: u32, a: f32, b: f32, masks: &mut [u64]) {
    let mut order: Vec<(f32, u32)> =
        centers(side).map(|[u, v]| a * u + b * v).zip(0..side * side).collect();
    order.compact_sort_by(|p, q| q.0.total_cmp(&p.0).then(p.1.cmp(&q.1)));
    for (step, mask) in masks.iter_mut().enumerate() {
        let e = (step as f32 + 0.5) / DISTANCES as f32 - 0.5;
        let count = (area(a, b, e) * (side * side) as f32 + 0.5) as usize;
        *mask = order.iter().take(count).fold(0, |mask, &(_, bit)| mask | 1 << bit);
    }
}

/// Returns the area of a pixel where a·u + b·v + e is positive; |a| + |b| = 1, e from −½ to ½.
fn area(a: f32, b: f32, e: f32) -> f32 {
    // The sum of two even distributions of widths |a| and |b|: a trapezoid over a length of 1.
    let (short, long) = (a.abs().min(b.abs()), a.abs().max(b.abs()));
    let t = e + 0.5;
    if t < short {
        t * t / (2.0 * short * long)
    } else if t > long {
        1.0 - (1.0 - t) * (1.0 - t) / (2.0 * short * long)
    } else {
        (t - 0.5 * short) / long
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn functions() -> impl Iterator<Item = (f32, f32, f32)> {
        let steps = || (-9..=9).map(|i| i as f32 / 7.0);
        steps().flat_map(move |a| steps().flat_map(move |b| steps().map(move |e| (a, b, e))))
    }

    #[test]
    fn a_function_and_its_opposite_share_all_sub_pixels() {
        for mask in [SubpixelMask::M16, SubpixelMask::M64] {
            let table = MaskTable::new(mask);
            for (a, b, e) in functions().filter(|(a, b, _)| a.abs() + b.abs() > 0.0) {
                let one = table.half_plane(&Direction::new(a, b), e);
                let other = table.half_plane(&Direction::new(-a, -b), -e);
                assert_eq!((one & other, one | other), (0, table.full()), "{a} {b} {e}");
            }
        }
    }

    #[test]
    fn the_outermost_masks_are_empty_and_full() {
        for mask in [SubpixelMask::M16, SubpixelMask::M64] {
            let table = MaskTable::new(mask);
            for first in (0..ENTRIES).step_by(DISTANCES) {
                let outermost = [first, first + DISTANCES - 1].map(|i| table.masks.get(i));
                assert_eq!(outermost, [0, table.full()]);
            }
        }
    }

    #[test]
    fn masks_count_as_many_sub_pixels_as_the_area_says() {
        for mask in [SubpixelMask::M16, SubpixelMask::M64] {
            let table = MaskTable::new(mask);
            let bits = table.full().count_ones();
            for (a, b, e) in functions().filter(|(a, b, _)| a.abs() + b.abs() > 0.0) {
                let count = table.half_plane(&Direction::new(a, b), e).count_ones();
                // Counted on 64 × 64 points.
                let inside = centers(64).filter(|[u, v]| a * u + b * v + e > 0.0).count();
                let expected = inside as f32 / 4096.0;
                let found = count as f32 / bits as f32;
                let bound = 0.5 / bits as f32 + 0.02;
                assert!((found - expected).abs() <= bound, "{a} {b} {e}: {found} {expected}");
            }
        }
    }
}
