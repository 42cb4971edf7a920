//! The tests between two polygons, in order of cost.

use super::piece::{Pieces, on_plane};
use super::{PaintTest, corners};
use crate::visibility::surface::setup::ScreenTriangle;
use crate::visibility::surface::visible::nearer;

/// Result of the tests on P, which is to be painted before Q.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// It may be, by this test.
    Passed(PaintTest),
    /// Q must be painted first.
    Later,
    /// Each hides a part of the other.
    Penetrates,
}

impl Pieces<'_> {
    /// Decides whether P may be painted before Q. If Q is marked, a conflict of planes is not enough against it: there
    /// must be a pixel at which P hides Q.
    pub fn judge(&self, p: u32, q: u32, marked: bool) -> Verdict {
        if self.is_behind(p, q) {
            return Verdict::Passed(PaintTest::Depths);
        }
        let common = self.window(p).and(self.window(q));
        if common.is_empty() {
            return Verdict::Passed(PaintTest::Boxes);
        }
        let (tp, tq) = (self.triangle(p), self.triangle(q));
        let slack =
            self.slack[self.get(p).triangle as usize] + self.slack[self.get(q).triangle as usize];
        if lies_behind(tq, tp, tq, slack) {
            return Verdict::Passed(PaintTest::InFrontOfPlane);
        }
        if lies_behind(tp, tp, tq, slack) {
            return Verdict::Passed(PaintTest::BehindPlane);
        }
        if separated(tp, tq) || separated(tq, tp) {
            return Verdict::Passed(PaintTest::Projections);
        }
        let whole = self.get(p).part.is_none() && self.get(q).part.is_none();
        if whole && !marked && (lies_behind(tq, tq, tp, slack) || lies_behind(tp, tq, tp, slack)) {
            return Verdict::Later;
        }
        self.compare_pixels(p, q)
    }

    /// Returns whether P is behind Q (test 1); at equal depths the higher item is behind.
    fn is_behind(&self, p: u32, q: u32) -> bool {
        let p = (self.nearest(p), self.triangle(p).item);
        let q = (self.farthest(q), self.triangle(q).item);
        nearer(q, p)
    }

    /// Decides at the pixels that both cover.
    fn compare_pixels(&self, p: u32, q: u32) -> Verdict {
        let common = self.window(p).and(self.window(q));
        let (of_p, of_q) = (self.spans(p, &common), self.spans(q, &common));
        let (mut p_nearer, mut q_nearer) = (false, false);
        let (mut i, mut j) = (0, 0);
        while let (Some(a), Some(b)) = (of_p.get(i), of_q.get(j)) {
            if a.y == b.y {
                for x in a.x0.max(b.x0)..a.x1.min(b.x1) {
                    let p_wins = nearer(self.at(p, x, a.y), self.at(q, x, a.y));
                    p_nearer |= p_wins;
                    q_nearer |= !p_wins;
                }
                if p_nearer && q_nearer {
                    return Verdict::Penetrates;
                }
            }
            if (a.y, a.x1) < (b.y, b.x1) { i += 1 } else { j += 1 }
        }
        if p_nearer { Verdict::Later } else { Verdict::Passed(PaintTest::Pixels) }
    }
}

/// Returns whether the plane of `back` is certainly behind the plane of `front` everywhere in `area`.
fn lies_behind(
    area: &ScreenTriangle,
    back: &ScreenTriangle,
    front: &ScreenTriangle,
    slack: f64,
) -> bool {
    corners(area).into_iter().all(|v| on_plane(back, v) - on_plane(front, v) > slack)
}

/// Returns whether an edge of `a` has all of `b` on its outer side; exact. Triangles that only
/// touch cover no pixel in common.
fn separated(a: &ScreenTriangle, b: &ScreenTriangle) -> bool {
    (0..3).any(|i| {
        let j = (i + 1) % 3;
        let (dx, dy) = (i64::from(a.x[j] - a.x[i]), i64::from(a.y[j] - a.y[i]));
        (0..3).all(|k| {
            let (x, y) = (i64::from(b.x[k] - a.x[i]), i64::from(b.y[k] - a.y[i]));
            dx * y - dy * x <= 0
        })
    })
}
