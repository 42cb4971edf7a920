//! Which boxes meet: sorted by their left sides, in horizontal slabs.

use crate::math::DVec2;

/// Tells each pair of closed boxes, given by two opposite corners, that have a point in common, once.
/// About O(n log n) time where boxes are small against the whole, O(n²) at worst.
pub(super) fn pairs(boxes: &[[DVec2; 2]], mut tell: impl FnMut(usize, usize)) {
    let low = |i: usize| boxes[i][0].min(boxes[i][1]);
    let high = |i: usize| boxes[i][0].max(boxes[i][1]);
    let mut order: Vec<usize> = (0..boxes.len()).collect();
    order.sort_by(|&i, &j| low(i).x.total_cmp(&low(j).x));
    let bottom = boxes.iter().flatten().fold(f64::INFINITY, |y, p| y.min(p.y));
    let top = boxes.iter().flatten().fold(f64::NEG_INFINITY, |y, p| y.max(p.y));
    let count = libm::sqrt(boxes.len() as f64) as usize + 1;
    // Halves, because the height of the whole may overflow.
    let slab = |y: f64| {
        let part = (y * 0.5 - bottom * 0.5) / (top * 0.5 - bottom * 0.5) * count as f64;
        (part.max(0.0) as usize).min(count - 1)
    };
    let mut slabs: Vec<Vec<usize>> = vec![Vec::new(); count];
    for i in order {
        slabs[slab(low(i).y)..=slab(high(i).y)].iter_mut().for_each(|slab| slab.push(i));
    }
    let mut active: Vec<usize> = Vec::new();
    for (k, members) in slabs.iter().enumerate() {
        active.clear();
        for &i in members {
            active.retain(|&j| high(j).x >= low(i).x);
            for &j in &active {
                let from = low(i).y.max(low(j).y);
                // Boxes that share several slabs meet in the first of them.
                if from <= high(i).y.min(high(j).y) && slab(from) == k {
                    tell(i, j);
                }
            }
            active.push(i);
        }
    }
}
