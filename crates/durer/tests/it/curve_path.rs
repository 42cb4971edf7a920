//! Paths: where contours begin, arcs, splines with repeated knots, holes in triangulations.

use durer::curve::b_spline::BSpline;
use durer::curve::{Contours, Path, PathElement, flatten};
use durer::math::DVec2;
use durer::raster::triangulate::{Step, Triangulation, triangulate};
use durer::trace::{NoTrace, Recorder};

#[test]
fn what_follows_a_closed_contour_begins_at_its_start() {
    let mut path = Path::new();
    path.move_to(1.0, 2.0).line_to(5.0, 2.0).line_to(5.0, 6.0).close();
    path.line_to(9.0, 9.0).line_to(9.0, 0.0);
    let contours = flatten(&path, 0.1);
    let second = contours.iter().nth(1).map(|(points, closed)| (points.to_vec(), closed));
    let expected = [(1.0, 2.0), (9.0, 9.0), (9.0, 0.0)].map(DVec2::from).to_vec();
    assert_eq!(second, Some((expected, false)));
}

#[test]
fn arcs_go_on_where_the_path_has_come_to() {
    let arc = |path: &mut Path| {
        path.arc(DVec2::new(5.0, 5.0), 2.0, 0.0, std::f64::consts::PI);
        path.elements().to_vec()
    };
    let first = DVec2::new(7.0, 5.0);
    assert_eq!(arc(&mut Path::new())[0], PathElement::MoveTo(first));
    let mut open = Path::new();
    open.move_to(0.0, 0.0);
    assert_eq!(arc(&mut open)[1], PathElement::LineTo(first));
    let mut closed = Path::rectangle(0.0, 0.0, 1.0, 1.0);
    let elements = arc(&mut closed);
    let at = elements.iter().position(|e| *e == PathElement::Close).map(|i| i + 1);
    assert_eq!(at.and_then(|i| elements.get(i)), Some(&PathElement::MoveTo(first)));
    // Its points lie on the circle, its end on the other side.
    let points = flatten(&open, 1e-4).points().to_vec();
    let off = |p: &DVec2| (p.distance(DVec2::splat(5.0)) - 2.0).abs();
    assert!(points[1..].iter().all(|p| off(p) < 1e-3));
    assert!(points.last().is_some_and(|p| p.distance(DVec2::new(3.0, 5.0)) < 1e-12));
}

#[test]
fn splines_are_defined_at_knots_of_any_multiplicity() {
    let control: Vec<DVec2> = (0..4).map(|i| DVec2::new(f64::from(i), f64::from(i * i))).collect();
    for (degree, knots) in [
        (1, vec![0.0, 0.0, 0.5, 1.0, 1.0, 1.0]),
        (1, vec![0.0, 0.0, 0.0, 0.5, 1.0, 1.0]),
        (2, vec![0.0, 0.0, 0.0, 0.5, 1.0, 1.0, 1.0]),
        (2, vec![0.0, 0.0, 0.5, 0.5, 1.0, 1.0, 1.0]),
        (1, vec![0.0, 0.0, 0.5, 0.5, 1.0, 1.0]),
    ] {
        let spline = BSpline::new(degree, control.clone(), knots.clone()).expect("knots");
        for i in 0..=8 {
            let (t, basis) = (f64::from(i) / 8.0, spline.basis(f64::from(i) / 8.0));
            let sum: DVec2 = basis.iter().zip(&control).map(|(b, p)| *p * *b).sum();
            assert!((basis.iter().sum::<f64>() - 1.0).abs() < 1e-12, "{knots:?} {t}: {basis:?}");
            assert!(sum.distance(spline.point(t)) < 1e-12, "{knots:?} {t}");
        }
    }
}

#[test]
fn triangles_leave_holes_open() {
    let square =
        |low: f64, high: f64| [(low, low), (high, low), (high, high), (low, high)].map(DVec2::from);
    let mut polygon = Contours::polygon(square(0.0, 9.0));
    polygon.push(square(1.0, 3.0), true);
    polygon.push(square(4.0, 8.0), true);
    let mut recorder = Recorder::default();
    let found = triangulate(&polygon, &mut recorder);
    assert_eq!((found.points.len(), found.triangles.len()), (12, 14));
    assert_eq!(found, triangulate(&polygon, &mut NoTrace));
    let mut replayed = Triangulation::default();
    for step in recorder.steps() {
        match *step {
            Step::Point(p) => replayed.points.push(p),
            Step::Triangle(corners) => replayed.triangles.push(corners),
            _ => {}
        }
    }
    assert_eq!(replayed, found);
    assert!((found.area() - (81.0 - 4.0 - 16.0)).abs() < 1e-12, "{}", found.area());
    let inside = |t: &[u32; 3], p: DVec2| {
        let [a, b, c] = t.map(|i| found.points[i as usize]);
        let turns = [(a, b), (b, c), (c, a)].map(|(a, b)| (b - a).perp_dot(p - a) > 0.0);
        turns[0] == turns[1] && turns[1] == turns[2]
    };
    for (p, covered) in [((2.1, 1.7), 0), ((5.3, 6.2), 0), ((3.4, 2.2), 1), ((0.4, 8.3), 1)] {
        let count = found.triangles.iter().filter(|t| inside(t, p.into())).count();
        assert_eq!(count, covered, "{p:?}");
    }
}
