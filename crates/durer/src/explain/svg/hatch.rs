//! Hatching, so that areas can be told apart without colour.

use crate::math::DVec2;
use crate::sorting::CompactSort;

/// Distance of the lines along x, in pixels.
const DISTANCE: f64 = 9.0;

/// Returns the lines that hatch the inside of rings, by the even-odd rule, within a picture of some size; they run up
/// to the right, or down.
pub(super) fn hatch(rings: &[Vec<DVec2>], size: DVec2, up: bool) -> Vec<[DVec2; 2]> {
    // A line that runs up on the page has x + y = c, since y grows downwards there; one that runs down x − y = c.
    let along = |p: DVec2| if up { p.x + p.y } else { p.x - p.y };
    let first = if up { 0.0 } else { -size.y };
    let count = ((size.x + size.y) / DISTANCE).clamp(0.0, 1000.0) as usize;
    let mut lines = Vec::new();
    for k in 0..=count {
        let c = first + (k as f64 + 0.5) * DISTANCE;
        let mut stops: Vec<DVec2> =
            rings.iter().flat_map(|ring| crossings(ring, along, c)).collect();
        stops.compact_sort_by(|a, b| a.x.total_cmp(&b.x));
        lines
            .extend(stops.chunks_exact(2).filter_map(|pair| Some([*pair.first()?, *pair.get(1)?])));
    }
    lines
}

/// Returns the points where a ring crosses a line of the hatching.
fn crossings(ring: &[DVec2], along: impl Fn(DVec2) -> f64, c: f64) -> Vec<DVec2> {
    let next = ring.iter().cycle().skip(1);
    let cross = |(&a, &b): (&DVec2, &DVec2)| {
        let (from, to) = (along(a) - c, along(b) - c);
        ((from < 0.0) != (to < 0.0)).then(|| a + (b - a) * (from / (from - to)))
    };
    ring.iter().zip(next).filter_map(cross).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hatching_stays_inside() {
        let p = DVec2::new;
        let outer = vec![p(10.0, 10.0), p(90.0, 10.0), p(90.0, 90.0), p(10.0, 90.0)];
        let hole = vec![p(40.0, 40.0), p(60.0, 40.0), p(60.0, 60.0), p(40.0, 60.0)];
        for up in [false, true] {
            let lines = hatch(&[outer.clone(), hole.clone()], p(100.0, 100.0), up);
            assert!(lines.len() > 15);
            for [a, b] in lines {
                let middle = (a + b) / 2.0;
                let free = (middle - 50.0).abs().max_element() >= 10.0;
                assert!(free && (middle - 50.0).abs().max_element() <= 40.0, "{middle}");
                assert_eq!((b - a).x.signum() * (b - a).y.signum(), if up { -1.0 } else { 1.0 });
            }
        }
    }
}
