//! Arcs of path data as curves that approximate them at any size of the picture.
//!
//! usvg approximates a circle by four curves, with an error of 1/3700 of its radius: half a pixel for a radius of 2000.
//! With eight the error is 1/240,000. And if an arc ends at its start, which draws nothing, usvg may compute the two
//! points a few last bits apart and draw the whole ellipse.

use crate::arc::{Arc, Ends};
use durer::math::DVec2;
use std::f64::consts::{FRAC_PI_4, PI};
use std::fmt::Write as _;
use svgtypes::{PathParser, PathSegment};

/// Calls `curve` with the points of curves after the first of each; `None` if the arc is a line.
pub(super) fn curves(ends: &Ends, mut curve: impl FnMut([DVec2; 3])) -> Option<()> {
    let arc = Arc::new(ends)?;
    let turn = if arc.is_half { PI.copysign(arc.turn) } else { arc.turn };
    // A hair less, so that rounding adds no curve to an eighth of a turn.
    let pieces = (turn.abs() / FRAC_PI_4 - 1e-9).ceil().max(1.0);
    let step = turn / pieces;
    let reach = 4.0 / 3.0 * libm::tan(step / 4.0);
    let at = |i: f64| {
        let (y, x) = libm::sincos(arc.start + step * i);
        DVec2::new(x, y)
    };
    for i in 0..pieces as u32 {
        let (a, b) = (at(f64::from(i)), at(f64::from(i) + 1.0));
        let last = i + 1 == pieces as u32;
        let end = if last { ends.to } else { arc.center + arc.seen(b) };
        let first = if i == 0 { ends.from } else { arc.center + arc.seen(a) };
        curve([first + arc.seen(a.perp() * reach), end - arc.seen(b.perp() * reach), end]);
    }
    Some(())
}

/// Returns the path data with curves in place of its arcs, as far as it is well-formed; `None` if it
/// has none.
pub(super) fn as_curves(data: &str) -> Option<String> {
    if !data.contains(['A', 'a']) {
        return None;
    }
    let mut out = String::with_capacity(2 * data.len());
    let (mut start, mut at, mut after_arc) = (DVec2::ZERO, DVec2::ZERO, false);
    for segment in PathParser::from(data).map_while(Result::ok) {
        use PathSegment::*;
        let was_arc = std::mem::replace(&mut after_arc, matches!(segment, EllipticalArc { .. }));
        let here = at;
        let point = |abs: bool, x: f64, y: f64| {
            if abs { DVec2::new(x, y) } else { here + DVec2::new(x, y) }
        };
        let mut write = |letter: char, points: &[DVec2]| {
            out.push(letter);
            points.iter().for_each(|p| {
                // Writing to a string cannot fail.
                let _ = write!(out, "{} {} ", p.x, p.y);
            });
        };
        match segment {
            MoveTo { abs, x, y } => {
                at = point(abs, x, y);
                start = at;
                write('M', &[at]);
            }
            LineTo { abs, x, y } => {
                at = point(abs, x, y);
                write('L', &[at]);
            }
            HorizontalLineTo { abs, x } => {
                at.x = point(abs, x, 0.0).x;
                write('L', &[at]);
            }
            VerticalLineTo { abs, y } => {
                at.y = point(abs, 0.0, y).y;
                write('L', &[at]);
            }
            CurveTo { abs, x1, y1, x2, y2, x, y } => {
                at = point(abs, x, y);
                write('C', &[point(abs, x1, y1), point(abs, x2, y2), at]);
            }
            SmoothCurveTo { abs, x2, y2, x, y } => {
                at = point(abs, x, y);
                // An arc has no control point to continue from.
                match was_arc {
                    true => write('C', &[here, point(abs, x2, y2), at]),
                    false => write('S', &[point(abs, x2, y2), at]),
                }
            }
            Quadratic { abs, x1, y1, x, y } => {
                at = point(abs, x, y);
                write('Q', &[point(abs, x1, y1), at]);
            }
            SmoothQuadratic { abs, x, y } => {
                at = point(abs, x, y);
                write('T', &[at]);
            }
            EllipticalArc { abs, rx, ry, x_axis_rotation, large_arc, sweep, x, y } => {
                at = point(abs, x, y);
                let (radii, turned) = (DVec2::new(rx, ry), x_axis_rotation.to_radians());
                let ends = Ends { from: here, to: at, radii, turned, large: large_arc, sweep };
                if curves(&ends, |points| write('C', &points)).is_none() {
                    write('L', &[at]);
                }
            }
            ClosePath { .. } => {
                at = start;
                write('Z', &[]);
            }
        }
    }
    Some(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the points on the curves of a path, at their ends and in between.
    fn points(data: &str) -> Vec<DVec2> {
        let mut at = DVec2::ZERO;
        let mut found = Vec::new();
        for segment in PathParser::from(data).flatten() {
            match segment {
                PathSegment::MoveTo { x, y, .. } | PathSegment::LineTo { x, y, .. } => {
                    at = DVec2::new(x, y);
                    found.push(at);
                }
                PathSegment::CurveTo { x1, y1, x2, y2, x, y, .. } => {
                    let [a, b, c] = [(x1, y1), (x2, y2), (x, y)].map(|(x, y)| DVec2::new(x, y));
                    for i in 1..=16 {
                        let t = f64::from(i) / 16.0;
                        let (p, q, r) = (at.lerp(a, t), a.lerp(b, t), b.lerp(c, t));
                        found.push(p.lerp(q, t).lerp(q.lerp(r, t), t));
                    }
                    at = c;
                }
                other => panic!("{other:?}"),
            }
        }
        found
    }

    #[test]
    fn all_four_arcs_of_a_circle_lie_on_it() {
        for (flags, center, sides) in [
            ("0 0", (0.0, 0.0), 1.0),
            ("1 1", (0.0, 0.0), 3.0),
            ("0 1", (100.0, 100.0), 1.0),
            ("1 0", (100.0, 100.0), 3.0),
        ] {
            let data = as_curves(&format!("M0 100A100 100 0 {flags} 100 0")).unwrap();
            let found = points(&data);
            let away = |p: &DVec2| (p.distance(center.into()) - 100.0).abs();
            let worst = found.iter().map(away).fold(0.0, f64::max);
            assert!(worst < 0.0005, "{flags}: {worst}");
            let length: f64 = found.windows(2).map(|w| w[0].distance(w[1])).sum();
            assert!((length - sides * 50.0 * PI).abs() < 0.3, "{flags}: {length}");
            assert_eq!(found.last(), Some(&DVec2::new(100.0, 0.0)));
        }
    }

    #[test]
    fn small_radii_grow_and_turned_ellipses_are_turned() {
        // From −10 to 10 across the side given by the sweep; the first axis is five times the second.
        for (sweep, side) in [(0, 1.0), (1, -1.0)] {
            let data = as_curves(&format!("M-10 0A1 5 90 1 {sweep} 10 0")).unwrap();
            let found = points(&data);
            assert!(found.iter().all(|p| p.y * side >= -1e-9), "{sweep}");
            let highest = found.iter().map(|p| p.y.abs()).fold(0.0, f64::max);
            assert!((highest - 2.0).abs() < 1e-3, "{sweep}: {highest}");
        }
    }

    #[test]
    fn arcs_to_where_they_begin_draw_nothing() {
        let data =
            as_curves("M20.7 34.7A22.5 .8 120 1 1 101.9 69.3A25.6 12 159 1 1 101.9 69.3").unwrap();
        let once = as_curves("M20.7 34.7A22.5 .8 120 1 1 101.9 69.3").unwrap();
        assert_eq!(data, once + "L101.9 69.3 ");
        assert_eq!(as_curves("M1 2a0 5 0 0 0 3 3").unwrap(), "M1 2 L4 5 ");
    }

    #[test]
    fn what_stands_around_arcs_stays_what_it_was() {
        let data =
            as_curves("m1 1h2v2l1 1c1 1 2 2 3 0s1 1 2 2q1 1 2 0t1 1zm5 5a0 1 0 0 0 1 1s1 1 2 2")
                .unwrap();
        assert_eq!(
            data,
            "M1 1 L3 1 L3 3 L4 4 C5 5 6 6 7 4 S8 5 9 6 Q10 7 11 6 T12 7 ZM6 6 L7 7 C7 7 8 8 9 9 "
        );
        assert_eq!(as_curves("M1 1L5 5"), None);
        assert_eq!(as_curves("M1 1L5 5A3 oops"), Some("M1 1 L5 5 ".to_owned()));
    }
}
