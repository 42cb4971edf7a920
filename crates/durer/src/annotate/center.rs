//! Centre lines and centre marks (ISO 128-2, line type 04.1).

use super::board::{Board, Layer, arc_mark};
use super::draw::reading;
use super::feature::{FeatureKind, RoundFeature};
use super::quad::Quad;
use super::seen::{Seen, Sight};
use super::style::BEYOND;
use crate::math::DVec2;
use crate::sorting::CompactSort;
use crate::target::sheet::PaperMark;
use std::f64::consts::TAU;

/// Length of lines, in millimetres, below which a cross is solid: there is no room for three dashes with dots between
/// them.
const SOLID: f64 = 24.0;

/// Centres nearer than this are one, millimetres.
const SAME: f64 = 0.05;

/// An axis as seen: the key common to axes in line, its begin and end along them, its direction, and its distance from
/// the origin.
type Axis = ([i64; 3], (f64, f64), DVec2, f64);

/// A circle that is seen in its true shape.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Circle {
    center: DVec2,
    radius: f64,
}

/// Draws the centre marks and lines of one view; if it is the sheet's only one (`alone`), axes seen obliquely are drawn
/// too.
pub(super) fn put(board: &mut Board, view: &Seen, features: &[RoundFeature], alone: bool) {
    let round = || features.iter().filter(|f| f.kind != FeatureKind::Fillet);
    let mut circles = Vec::new();
    let mut axes = Vec::new();
    for feature in round() {
        let circle = view.circle(&feature.cylinder);
        circles.extend(circle.map(|(center, radius)| Circle { center, radius }));
        let way = match view.sight(feature.cylinder.axis()) {
            Sight::Along(way) => way,
            Sight::Oblique(way) if alone => way,
            _ => continue,
        };
        axes.push((reading(way), feature.cylinder.ends.map(|p| view.point(p))));
    }
    let (pen, thin) = (board.center(), board.thin());
    let (marks, rings) = center_marks(&circles);
    let mut add = |[a, b]: [DVec2; 2], pen: usize| {
        board.add(Layer::Center, PaperMark::Stroke { points: vec![a, b], closed: false, pen });
    };
    // Details show a part of the model.
    let around = Quad::of_rect(view.bounds()).wider(BEYOND + SAME);
    let shown = |[a, b]: [DVec2; 2]| around.inside(a, b).map(|(s, t)| [a.lerp(b, s), a.lerp(b, t)]);
    axis_lines(&axes).into_iter().filter_map(shown).for_each(|line| add(line, pen));
    for [a, b] in marks {
        // Crosses meet in dashes: they are drawn from their middles, where a dash begins.
        let middle = (a + b) * 0.5;
        if a.distance(b) < SOLID {
            add([a, b], thin);
        } else {
            add([middle, a], pen);
            add([middle, b], pen);
        }
    }
    for ring in rings {
        board.add(Layer::Center, arc_mark(ring.center, ring.radius, 0.0, TAU, pen));
    }
}

/// Returns the lines of axes; those in line that overlap are one.
fn axis_lines(axes: &[(DVec2, [DVec2; 2])]) -> Vec<[DVec2; 2]> {
    let mut keyed: Vec<_> = axes
        .iter()
        .filter(|(_, ends)| ends.iter().all(|p| p.is_finite()))
        .map(|&(way, ends)| {
            let offset = ends[0].dot(way.perp());
            let along = ends.map(|p| p.dot(way));
            let span = (along[0].min(along[1]) - BEYOND, along[0].max(along[1]) + BEYOND);
            let key = [way.x, way.y, offset / SAME / 1e3].map(|v| (v * 1e3).round() as i64);
            (key, span, way, offset)
        })
        .collect();
    keyed.compact_sort_by(|a, b| a.0.cmp(&b.0).then(a.1.0.total_cmp(&b.1.0)));
    let mut lines = Vec::with_capacity(keyed.len());
    for next in keyed {
        let last: Option<&mut Axis> = lines.last_mut();
        match last {
            Some(last) if last.0 == next.0 && next.1.0 <= last.1.1 => {
                last.1.1 = last.1.1.max(next.1.1);
            }
            _ => lines.push(next),
        }
    }
    let ends = |way: DVec2, offset: f64, at: f64| way * at + way.perp() * offset;
    lines.into_iter().map(|(_, (a, b), way, o)| [ends(way, o, a), ends(way, o, b)]).collect()
}

/// Crosses, or pitch circles with ticks for equal holes on one circle.
fn center_marks(circles: &[Circle]) -> (Vec<[DVec2; 2]>, Vec<Circle>) {
    let mut circles = concentric(circles);
    circles.compact_sort_by(|a, b| a.radius.total_cmp(&b.radius));
    let (mut lines, mut rings) = (Vec::new(), Vec::new());
    let same = |a: &Circle, b: &Circle| b.radius - a.radius <= 1e-3 * b.radius;
    for alike in circles.chunk_by(same) {
        match pitch_circle(alike) {
            Some(pitch) => {
                let ring = pitch.center;
                rings.push(pitch);
                lines.extend(alike.iter().map(|c| tick(c, (c.center - ring).normalize_or_zero())));
            }
            None => {
                lines.extend(alike.iter().flat_map(|c| [tick(c, DVec2::X), tick(c, DVec2::Y)]));
            }
        }
    }
    (lines, rings)
}

/// Returns a line across a circle, and a little beyond it.
fn tick(circle: &Circle, way: DVec2) -> [DVec2; 2] {
    let reach = way * (circle.radius + BEYOND);
    [circle.center - reach, circle.center + reach]
}

/// Returns the largest circle around each centre.
fn concentric(circles: &[Circle]) -> Vec<Circle> {
    let key = |c: &Circle| [c.center.x, c.center.y].map(|v| (v / SAME).round() as i64);
    let mut sorted = circles.to_vec();
    sorted.compact_sort_by(|a, b| key(a).cmp(&key(b)).then(b.radius.total_cmp(&a.radius)));
    sorted.dedup_by_key(|c| key(c));
    sorted
}

/// Returns the circle on which the centres of at least three circles are evenly spaced.
fn pitch_circle(circles: &[Circle]) -> Option<Circle> {
    let count = circles.len();
    if count < 3 {
        return None;
    }
    let center = circles.iter().map(|c| c.center).sum::<DVec2>() / count as f64;
    let radius = circles[0].center.distance(center);
    let mut angles: Vec<f64> = Vec::with_capacity(count);
    for circle in circles {
        let spoke = circle.center - center;
        if (spoke.length() - radius).abs() > SAME || radius < circle.radius {
            return None;
        }
        angles.push(libm::atan2(spoke.y, spoke.x));
    }
    angles.sort_by(f64::total_cmp);
    let step = TAU / count as f64;
    let even = angles.windows(2).all(|w| (w[1] - w[0] - step).abs() * radius < 4.0 * SAME);
    (even && (count != 4 || !is_square_to_page(&angles))).then_some(Circle { center, radius })
}

/// Returns the pitch circle of circles of one radius, given by their centres: the centre and the radius.
pub(super) fn pitch_of(centers: impl Iterator<Item = DVec2>, radius: f64) -> Option<(DVec2, f64)> {
    let circles: Vec<Circle> = centers.map(|center| Circle { center, radius }).collect();
    pitch_circle(&circles).map(|c| (c.center, c.radius))
}

/// Returns whether four angles are those of an upright rectangle: its holes are dimensioned along its sides.
fn is_square_to_page(angles: &[f64]) -> bool {
    let quarter = TAU / 4.0;
    angles.iter().all(|a| ((a / quarter).rem_euclid(1.0) - 0.5).abs() < 0.01)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn way(angle: f64) -> DVec2 {
        DVec2::new(angle.cos(), angle.sin())
    }

    fn circles(count: u32, start: f64) -> Vec<Circle> {
        let at = |i: u32| start + f64::from(i) * TAU / f64::from(count);
        let of = |i| Circle { center: way(at(i)) * 20.0 + 50.0, radius: 3.0 };
        (0..count).map(of).collect()
    }

    #[test]
    fn holes_on_a_circle_get_it() {
        for count in [3, 5, 6, 8] {
            let (lines, rings) = center_marks(&circles(count, 0.3));
            assert_eq!((lines.len(), rings.len()), (count as usize, 1));
            let spoke = lines[0][1] - lines[0][0];
            assert!((spoke.length() - 2.0 * (3.0 + BEYOND)).abs() < 1e-9);
        }
        // Two have crosses, and so have four at the corners of a rectangle.
        assert_eq!(center_marks(&circles(2, 0.0)).0.len(), 4);
        let (lines, rings) = center_marks(&circles(4, TAU / 8.0));
        assert_eq!((lines.len(), rings.len()), (8, 0));
    }

    #[test]
    fn circles_in_each_other_have_one_cross() {
        let circle = |radius| Circle { center: DVec2::ONE, radius };
        let (lines, _) = center_marks(&[circle(2.0), circle(5.0), circle(1.0)]);
        assert_eq!(lines.len(), 2);
        assert_eq!(lines[0], [DVec2::new(-6.5, 1.0), DVec2::new(8.5, 1.0)]);
    }

    #[test]
    fn axes_in_line_are_one() {
        let p = DVec2::new;
        let axes = [
            (DVec2::X, [p(0.0, 1.0), p(5.0, 1.0)]),
            (DVec2::X, [p(9.0, 1.0), p(5.0, 1.0)]),
            (DVec2::X, [p(0.0, 2.0), p(5.0, 2.0)]),
            (DVec2::X, [p(40.0, 2.0), p(45.0, 2.0)]),
        ];
        let lines = axis_lines(&axes);
        assert_eq!(lines.len(), 3);
        assert!(lines.contains(&[p(-2.5, 1.0), p(11.5, 1.0)]), "{lines:?}");
    }
}
