//! Fewer points within a tolerance.
//!
//! Urs Ramer, *An iterative procedure for the polygonal approximation of plane curves*, 1972; David
//! Douglas and Thomas Peucker, *Algorithms for the reduction of the number of points required to
//! represent a digitized line*, 1973. Distances are to the segment, not to its carrier; ends stay.
//! O(n log n) as a rule, O(n²) at worst.

use super::page::GridPoint;

/// Leaves out points within the tolerance. A closed ring begins at the point that is furthest to the left, then down,
/// and keeps the point furthest from it as well. Points among the sorted `corners` stay.
pub(super) fn simplify(
    points: &[GridPoint],
    closed: bool,
    tolerance: f64,
    corners: &[GridPoint],
) -> Vec<GridPoint> {
    if !closed {
        return open(points, tolerance, corners);
    }
    let Some(start) = (0..points.len()).min_by_key(|&i| points[i]) else { return Vec::new() };
    let mut ring: Vec<GridPoint> =
        points[start..].iter().chain(&points[..start]).copied().collect();
    ring.push(ring[0]);
    let furthest = |i: &usize| ring[*i].distance(ring[0]);
    let middle = (1..ring.len() - 1).max_by(|a, b| furthest(a).total_cmp(&furthest(b)));
    let Some(middle) = middle else { return ring };
    let mut kept = open(&ring[..=middle], tolerance, corners);
    kept.extend_from_slice(&open(&ring[middle..], tolerance, corners)[1..]);
    kept.pop();
    kept
}

fn open(points: &[GridPoint], tolerance: f64, corners: &[GridPoint]) -> Vec<GridPoint> {
    if points.len() < 3 {
        return points.to_vec();
    }
    let mut keep = vec![false; points.len()];
    let stays = |i: &usize| *i == points.len() - 1 || corners.binary_search(&points[*i]).is_ok();
    let mut from = 0;
    let parts = (1..points.len()).filter(stays).map(|i| (std::mem::replace(&mut from, i), i));
    let mut stack: Vec<(usize, usize)> = parts.collect();
    while let Some((a, b)) = stack.pop() {
        (keep[a], keep[b]) = (true, true);
        let mut worst = (tolerance, None);
        for i in a + 1..b {
            let d = distance(points[i], points[a], points[b]);
            if d > worst.0 {
                worst = (d, Some(i));
            }
        }
        if let Some(i) = worst.1 {
            stack.extend([(a, i), (i, b)]);
        }
    }
    points.iter().zip(keep).filter(|(_, k)| *k).map(|(p, _)| *p).collect()
}

fn distance(p: GridPoint, a: GridPoint, b: GridPoint) -> f64 {
    let ([px, py], [bx, by]) = (p.minus(a).map(|d| d as f64), b.minus(a).map(|d| d as f64));
    let length2 = bx * bx + by * by;
    let t = if length2 > 0.0 { ((px * bx + py * by) / length2).clamp(0.0, 1.0) } else { 0.0 };
    let (x, y) = (px - t * bx, py - t * by);
    (x * x + y * y).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_stay_however_flat_they_are() {
        let row: Vec<GridPoint> = [(0, 0), (100, 1), (200, 0), (300, 1), (400, 0)]
            .map(|(x, y)| GridPoint { x, y })
            .into();
        assert_eq!(simplify(&row, false, 2.0, &[]), [row[0], row[4]]);
        assert_eq!(simplify(&row, false, 2.0, &row[1..2]), [row[0], row[1], row[4]]);
        let ring = [&row[..], &[GridPoint { x: 200, y: 300 }]].concat();
        assert_eq!(simplify(&ring, true, 2.0, &row[3..4]), [row[0], row[3], row[4], ring[5]]);
    }
}
