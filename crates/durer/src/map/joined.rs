//! Areas of one colour that are painted as one: neighbours that share a border leave no seam, and where
//! they overlap nothing shows it.

use crate::clip::polygon::signed_area;
use crate::curve::Path;
use crate::math::DVec2;

/// Grid to which points are moved, per pixel, so that neighbours have the same border in either direction; points that
/// then coincide are left out. Each edge through a pixel changes the coverage by less than 0.1/255; on a grid of 1/256
/// it would be 1/255, which is visible as another colour.
const GRID: f64 = 4096.0;

/// Outer rings run in one direction and holes in the other, so that the winding number of a point is the number of
/// areas that contain it.
#[derive(Debug, Default)]
pub struct Joined {
    rings: Vec<Vec<DVec2>>,
}

impl Joined {
    /// Adds polygons, each an outer ring with its holes, in pixels; refuses all where a ring winds around more than
    /// once or crosses itself like an eight: windings of neighbours would cancel.
    pub fn take(&mut self, polygons: &[Vec<Vec<DVec2>>]) -> bool {
        let before = self.rings.len();
        for rings in polygons {
            for (i, ring) in rings.iter().enumerate() {
                let mut ring = snapped(ring);
                if ring.len() < 3 {
                    continue;
                }
                let Some(turns) = turns(&ring) else {
                    self.rings.truncate(before);
                    return false;
                };
                if (turns > 0) == (i > 0) {
                    ring.reverse();
                }
                self.rings.push(ring);
            }
        }
        true
    }

    /// Returns all of them, to be filled by the non-zero rule.
    pub fn into_path(self) -> Path {
        let mut path = Path::new();
        self.rings.into_iter().for_each(|ring| {
            path.extend(&Path::polygon(ring));
        });
        path
    }
}

/// Returns the ring on the grid, without points that repeat the one before, and without spikes.
fn snapped(ring: &[DVec2]) -> Vec<DVec2> {
    let mut out: Vec<DVec2> = Vec::with_capacity(ring.len());
    for p in ring {
        let p = (*p * GRID).round() / GRID;
        if out.last() != Some(&p) {
            out.push(p);
        }
        // There and back again.
        while out.len() > 2 && out[out.len() - 1] == out[out.len() - 3] {
            out.truncate(out.len() - 2);
        }
    }
    while out.len() > 1 && out.first() == out.last() {
        out.pop();
    }
    while out.len() > 2 && out[1] == out[out.len() - 1] {
        out.pop();
        out.remove(0);
    }
    out
}

/// Returns 1 for a ring that turns once to the left in all, −1 to the right; `None` for any other, which is not simple
/// (H. Hopf, *Über die Drehung der Tangenten und Sehnen ebener Kurven*, 1935), and for one whose area has another
/// sign.
fn turns(ring: &[DVec2]) -> Option<i32> {
    let n = ring.len();
    let step = |i: usize| ring[(i + 1) % n] - ring[i % n];
    let mut turns = 0;
    for i in 0..n {
        let (from, to) = (step(i), step(i + 1));
        let side = from.perp_dot(to);
        if side == 0.0 && from.dot(to) < 0.0 {
            return None;
        }
        // Number of times that the direction passes the x axis.
        match (from.y < 0.0, to.y < 0.0) {
            (true, false) if side > 0.0 => turns += 1,
            (false, true) if side < 0.0 => turns -= 1,
            _ => {}
        }
    }
    let area = signed_area(ring);
    (turns == if area > 0.0 { 1 } else { -1 } && area != 0.0).then_some(turns)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ring(points: &[(f64, f64)]) -> Vec<DVec2> {
        points.iter().map(|&p| p.into()).collect()
    }

    #[test]
    fn simple_rings_turn_once_and_others_are_refused() {
        let square = ring(&[(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)]);
        let mut back = square.clone();
        back.reverse();
        assert_eq!((turns(&square), turns(&back)), (Some(1), Some(-1)));
        let comb = ring(&[(0., 0.), (9., 0.), (9., 5.), (7., 1.), (5., 5.), (3., 1.), (0., 5.)]);
        assert_eq!(turns(&comb), Some(1));
        let eight = ring(&[(0.0, 0.0), (4.0, 4.0), (4.0, 0.0), (0.0, 5.0)]);
        let twice =
            ring(&[(0., 0.), (9., 0.), (9., 9.), (1., 9.), (1., 1.), (8., 1.), (8., 8.), (0., 8.)]);
        assert_eq!((turns(&eight), turns(&twice)), (None, None));
        let mut joined = Joined::default();
        assert!(joined.take(&[vec![square.clone(), square.clone()]]));
        assert!(!joined.take(&[vec![square], vec![eight]]));
        assert_eq!(joined.rings.len(), 2);
        assert_eq!(signed_area(&joined.rings[0]), -signed_area(&joined.rings[1]));
    }

    #[test]
    fn spikes_and_repeated_points_are_left_out() {
        let spiky = ring(&[
            (0., 0.),
            (4., 0.),
            (4., 9.),
            (4., 4.),
            (4., 4.0001),
            (0., 4.),
            (-9., 4.),
            (0., 4.),
        ]);
        let out = snapped(&spiky);
        assert!(out.len() <= 6, "{out:?}");
        let there = ring(&[(0., 0.), (4., 0.), (0., 0.), (0., 3.), (2., 2.)]);
        assert_eq!(snapped(&there), ring(&[(0., 0.), (0., 3.), (2., 2.)]));
    }
}
