//! The A-buffer's arithmetic of one pixel, as published: masks of 4 × 4 sub-pixels, and shares by depth.
//!
//! L. Carpenter, *The A-buffer, an Antialiased Hidden Surface Method*, SIGGRAPH 1984. Class: image space. Fragments of
//! a pixel are processed by their nearest depth. Each takes the sub-pixels that are still free; if the next one
//! overlaps it in depth, the two share them in proportion to how far each is in front of the other, as if they crossed
//! there. Cost: O(k log k) for k fragments. [`crate::visibility::surface::a_buffer`] decides by exact areas and planes
//! where faces cut each other, and renders models.

use crate::info::{Class, Info, Occluder};
use crate::math::{DVec2, Vec4};
use crate::sorting::CompactSort;
use crate::trace::{PseudocodeLine, Tracer};

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "a-buffer-shares",
    title: "A-buffer with shares by depth",
    authors: "L. Carpenter",
    year: 1984,
    source: "The A-buffer, an Antialiased Hidden Surface Method, SIGGRAPH",
    class: Class::ImageSpace,
    occluder: Occluder::Area,
    coherence: &[],
    cost: "O(k log k) per pixel for k fragments",
    limits: "4 × 4 sub-pixels; opaque fragments; faces that intersect share sub-pixels by an estimate",
    pseudocode: &[
        "left[s] ← 1 for each of the 16 sub-pixels; sort the fragments by nearest depth",
        "for each fragment, from near to far:",
        "    search ← the sub-pixels with anything left",
        "    inside ← its mask and search",
        "    if the next fragment overlaps it in depth:",
        "        M ← inside and the mask of the next one",
        "        share ← (z2max − z1min) / ((z1max − z1min) + (z2max − z2min))",
        "        take share of the rest in M",
        "    take all the rest in the others of inside",
        "    weight of the fragment ← its total / 16",
        "weight of the background ← the rest / 16",
    ],
};

/// All sub-pixels of a pixel.
pub const FULL: u16 = u16::MAX;

/// Returns the signed distance of a point from the line through two others, positive where the edge function ΔY (x −
/// Xa) − ΔX (y − Ya) is: that function divided by the edge's length; `None` for an edge without length.
///
/// ```
/// use durer::math::DVec2;
/// use durer::visibility::polygons::a_buffer::edge_distance;
/// let edge = [DVec2::ZERO, DVec2::new(3.0, 4.0)];
/// assert_eq!(edge_distance(edge, DVec2::new(5.0, 0.0)), Some(4.0));
/// ```
pub fn edge_distance([a, b]: [DVec2; 2], p: DVec2) -> Option<f64> {
    let way = b - a;
    let value = way.y * (p.x - a.x) - way.x * (p.y - a.y);
    let length = libm::sqrt(way.length_squared());
    (length > 0.0).then(|| value / length)
}

/// Returns the mask of a half-plane by the area that it covers: n = round(16 · area) sub-pixels, the ones deepest
/// inside it. The pixel reaches from (0, 0) to (1, 1); bit 4 · row + column has a sub-pixel.
pub fn ordered_mask(edge: [DVec2; 2], area: f64) -> u16 {
    let count = (area.clamp(0.0, 1.0) * 16.0 + 0.5) as usize;
    let center = |bit: usize| DVec2::new((bit % 4) as f64 + 0.5, (bit / 4) as f64 + 0.5) / 4.0;
    let depth = |bit: usize| edge_distance(edge, center(bit)).unwrap_or(0.0);
    let mut order: Vec<usize> = (0..16).collect();
    order.compact_sort_by(|&i, &j| depth(j).total_cmp(&depth(i)).then(i.cmp(&j)));
    order.into_iter().take(count).fold(0, |mask, bit| mask | 1 << bit)
}

/// Returns the visible share of the first of two fragments where both cover: (z₂max − z₁min) / ((z₁max − z₁min) +
/// (z₂max − z₂min)). 1 if it ends before the other begins, 0 in the opposite case, ½ for two flat ones at equal depth.
pub fn visible_share(first: [f64; 2], second: [f64; 2]) -> f64 {
    if first[1] <= second[0] && first != second {
        return 1.0;
    }
    let reach = (first[1] - first[0]) + (second[1] - second[0]);
    let share = (second[1] - first[0]) / reach;
    if share.is_nan() { 0.5 } else { share.clamp(0.0, 1.0) }
}

/// Returns the visible masks of two fragments A and B that cut each other in the pixel, where P has
/// the sub-pixels at which A is in front: A · (¬B + P) and B · (¬A + ¬P).
///
/// ```
/// use durer::visibility::polygons::a_buffer::seen_masks;
/// assert_eq!(seen_masks(0b1110, 0b0111, 0b1100), [0b1100, 0b0011]);
/// ```
pub fn seen_masks(a: u16, b: u16, priority: u16) -> [u16; 2] {
    [a & (!b | priority), b & (!a | !priority)]
}

/// Contribution of a face to a pixel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FaceFragment {
    /// The sub-pixels that it covers.
    pub mask: u16,
    /// Its smallest and largest depth in the pixel.
    pub z: [f64; 2],
    /// Linear, opaque.
    pub color: Vec4,
}

/// Step of the algorithm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step {
    /// A fragment's turn, in the order of depth.
    Look {
        /// Its index in the input.
        fragment: usize,
        /// The sub-pixels that are still searched for.
        search: u16,
        /// The sub-pixels among them that it covers.
        inside: u16,
    },
    /// Another one overlaps it in depth: they share sub-pixels.
    Overlap {
        /// The one whose turn it is, and the other.
        fragments: [usize; 2],
        /// The sub-pixels examined.
        mask: u16,
        /// Share of the first one in them.
        share: f64,
    },
    /// The weight of a fragment in the pixel's colour.
    Weight {
        /// Its index; none for the background.
        fragment: Option<usize>,
        /// Weight, 0 … 1.
        weight: f64,
    },
}

impl PseudocodeLine for Step {
    fn line(&self) -> usize {
        match self {
            Self::Look { .. } => 4,
            Self::Overlap { .. } => 7,
            Self::Weight { fragment: Some(_), .. } => 10,
            Self::Weight { fragment: None, .. } => 11,
        }
    }
}

/// Returns the weights that a list of steps leads to: of each fragment, and of the background.
pub fn replay(count: usize, steps: &[Step]) -> (Vec<f64>, f64) {
    let (mut weights, mut background) = (vec![0.0; count], 0.0);
    for step in steps {
        match *step {
            Step::Weight { fragment: Some(index), weight } => weights[index] += weight,
            Step::Weight { fragment: None, weight } => background += weight,
            Step::Look { .. } | Step::Overlap { .. } => {}
        }
    }
    (weights, background)
}

/// Returns the weight of each fragment in the pixel, and that of the background; they add up to 1. Of fragments that
/// overlap in depth, each consecutive pair shares the sub-pixels that both cover.
pub fn weights(fragments: &[FaceFragment], t: &mut impl Tracer<Step>) -> (Vec<f64>, f64) {
    let mut order: Vec<usize> = (0..fragments.len()).collect();
    order.compact_sort_by(|&i, &j| fragments[i].z[0].total_cmp(&fragments[j].z[0]).then(i.cmp(&j)));
    let mut weights = vec![0.0; fragments.len()];
    // The share that each sub-pixel still has to give away.
    let mut left = [1.0_f64; 16];
    for (place, &fragment) in order.iter().enumerate() {
        let own = &fragments[fragment];
        let search = mask_of(&left);
        let inside = search & own.mask;
        t.step(|| Step::Look { fragment, search, inside });
        let next = order.get(place + 1).map(|&next| (next, &fragments[next]));
        let (common, share) = match next.filter(|(_, other)| other.z[0] < own.z[1]) {
            Some((other, behind)) => {
                let (mask, share) = (inside & behind.mask, visible_share(own.z, behind.z));
                let fragments = [fragment, other];
                t.step(|| Step::Overlap { fragments, mask, share });
                (mask, share)
            }
            None => (0, 1.0),
        };
        let mut weight = 0.0;
        for (bit, left) in left.iter_mut().enumerate().filter(|(bit, _)| inside >> bit & 1 == 1) {
            let taken = if common >> bit & 1 == 1 { *left * share } else { *left };
            weight += taken / 16.0;
            *left -= taken;
        }
        t.step(|| Step::Weight { fragment: Some(fragment), weight });
        weights[fragment] = weight;
    }
    let background = left.iter().sum::<f64>() / 16.0;
    t.step(|| Step::Weight { fragment: None, weight: background });
    (weights, background)
}

/// Returns the sub-pixels that have anything left.
fn mask_of(left: &[f64; 16]) -> u16 {
    (0..16).filter(|&bit| left[bit] > 0.0).fold(0, |mask, bit| mask | 1 << bit)
}

/// Returns the pixel's colour over a background.
pub fn resolve(fragments: &[FaceFragment], background: Vec4, t: &mut impl Tracer<Step>) -> Vec4 {
    let (weights, rest) = weights(fragments, t);
    let mixed = fragments.iter().zip(weights).map(|(f, weight)| f.color * weight as f32);
    mixed.fold(background * rest as f32, |sum, color| sum + color)
}
