//! Curves as in textbooks: knot insertion, Catmull–Rom splines, forward differences.

mod knots {
    use durer::curve::b_spline::BSpline;
    use durer::curve::knot_insertion::*;
    use durer::math::DVec2;
    use durer::trace::{NoTrace, Recorder};

    fn curve(degree: usize) -> BSpline<DVec2> {
        let control = (0..8).map(|i| DVec2::new(f64::from(i), f64::from(i * i % 5))).collect();
        BSpline::clamped(degree, control).unwrap()
    }

    fn same(a: &BSpline<DVec2>, b: &BSpline<DVec2>) {
        for i in 0..=60 {
            let t = f64::from(i) / 60.0;
            assert!(a.point(t).distance(b.point(t)) < 1e-12, "{t}");
        }
    }

    #[test]
    fn both_keep_the_curve_and_agree() {
        for degree in 1..=5 {
            let whole = curve(degree);
            let inner = 1.0 / (8 - degree) as f64;
            // New knots, a repeated one, and one inserted several times.
            let mut new = vec![0.31, 0.8, 0.07];
            if degree > 1 {
                new.extend([inner, 0.31]);
            }
            let mut one_by_one = whole.clone();
            for &knot in &new {
                let mut steps = Recorder::default();
                let next = insert(&one_by_one, knot, &mut steps).unwrap();
                assert_eq!(insert(&one_by_one, knot, &mut NoTrace).as_ref(), Ok(&next));
                assert_eq!(replay(one_by_one.control(), steps.steps()), next.control());
                assert_eq!(steps.steps().len(), degree);
                one_by_one = next;
                same(&one_by_one, &whole);
            }
            let mut steps = Recorder::default();
            let at_once = refine(&whole, &new, &mut steps).unwrap();
            same(&at_once, &whole);
            assert_eq!(at_once.knots(), one_by_one.knots());
            let pairs = at_once.control().iter().zip(one_by_one.control());
            assert!(pairs.clone().all(|(a, b)| a.distance(*b) < 1e-12), "degree {degree}");
            let last = |of: usize| steps.steps().iter().rfind(|s| s.of == of).unwrap().point;
            assert!((0..at_once.control().len()).all(|of| last(of) == at_once.control()[of]));
        }
    }

    /// Checks a knot with the multiplicity of the degree: the curve's point is a control point, which divides the
    /// curve.
    #[test]
    fn a_knot_of_full_multiplicity_is_a_point_of_the_curve() {
        let whole = curve(3);
        let divided = refine(&whole, &[0.3; 3], &mut NoTrace).unwrap();
        let point = whole.point(0.3);
        assert!(divided.control().iter().any(|p| p.distance(point) < 1e-12));
        assert!(insert(&divided, 0.3, &mut NoTrace).is_err());
        assert!(refine(&whole, &[0.3; 4], &mut NoTrace).is_err());
    }

    #[test]
    fn knots_outside_are_refused() {
        for knot in [0.0, 1.0, -0.5, 2.0, f64::NAN, f64::INFINITY] {
            assert!(insert(&curve(3), knot, &mut NoTrace).is_err());
            assert!(refine(&curve(3), &[knot], &mut NoTrace).is_err());
        }
    }
}

mod through_points {
    use durer::curve::bezier::de_casteljau;
    use durer::curve::catmull_rom::*;
    use durer::math::DVec2;
    use durer::trace::{NoTrace, Recorder};

    /// The paper's basis matrix at the parameter t.
    fn published(p: [DVec2; 4], t: f64) -> DVec2 {
        let sum = p[1] * 2.0
            + (p[2] - p[0]) * t
            + (p[0] * 2.0 - p[1] * 5.0 + p[2] * 4.0 - p[3]) * (t * t)
            + (p[1] * 3.0 - p[0] - p[2] * 3.0 + p[3]) * (t * t * t);
        sum * 0.5
    }

    fn points() -> Vec<DVec2> {
        [(0.0, 0.0), (1.0, 4.0), (5.0, 5.0), (6.0, 1.0), (9.0, 2.0)].map(DVec2::from).to_vec()
    }

    #[test]
    fn inner_pieces_are_the_published_ones() {
        let mut steps = Recorder::default();
        let found = pieces(&points(), &Options::default(), &mut steps);
        assert_eq!(found, replay(steps.steps()));
        assert_eq!(found, pieces(&points(), &Options::default(), &mut NoTrace));
        assert_eq!(found.len(), 4);
        for (k, four) in points().windows(4).enumerate() {
            let four = [four[0], four[1], four[2], four[3]];
            for i in 0..=10 {
                let t = f64::from(i) / 10.0;
                let p = de_casteljau(&found[k + 1], t, &mut NoTrace).unwrap();
                assert!(p.distance(published(four, t)) < 1e-12, "{k} {t}");
            }
        }
        // (5, 5) − (0, 0), halved.
        assert_eq!(steps.steps()[1], Step::Tangent { index: 1, tangent: DVec2::new(2.5, 2.5) });
    }

    #[test]
    fn closed_curves_and_other_tensions() {
        let closed = Options { closed: true, ..Options::default() };
        let ring = pieces(&points(), &closed, &mut NoTrace);
        assert_eq!(ring.len(), 5);
        // Each segment leaves a point in the direction in which the previous one arrives.
        for (a, b) in ring.iter().zip(ring.iter().cycle().skip(1)) {
            assert_eq!(a[3], b[0]);
            assert!((a[3] - a[2]).distance(b[1] - b[0]) < 1e-12);
        }
        let straight = Options { tension: 0.0, ..Options::default() };
        for piece in pieces(&points(), &straight, &mut NoTrace) {
            assert_eq!((piece[0], piece[3]), (piece[1], piece[2]));
        }
        assert!(pieces(&points()[..1], &closed, &mut NoTrace).is_empty());
    }
}

mod differences {
    use durer::curve::bezier::de_casteljau;
    use durer::curve::forward_difference::*;
    use durer::math::DVec2;
    use durer::trace::{NoTrace, Recorder};

    #[test]
    fn the_points_are_those_of_de_casteljau() {
        for k in 0..20 {
            let at = |i: i32| {
                DVec2::new(f64::from((k * 7 + i * 5) % 11), f64::from((k * 3 + i * i) % 7))
            };
            let control = [0, 1, 2, 3].map(at);
            for count in [0, 1, 2, 7, 64] {
                let mut steps = Recorder::default();
                let found = points(&control, count, &mut steps);
                assert_eq!(found, points(&control, count, &mut NoTrace));
                assert_eq!(found, replay(steps.steps()));
                assert_eq!(found.len() as u32, count + 1);
                for (i, p) in (0..).zip(&found) {
                    let t = f64::from(i) / f64::from(count.max(1));
                    let expected = de_casteljau(&control, t, &mut NoTrace).unwrap();
                    assert!(p.distance(expected) < 1e-11, "{k} {count} {i}");
                }
            }
        }
    }

    /// (0, 0) (0, 4) (4, 4) (4, 0): a = (−8, 0), b = (12, −12), c = (0, 12), in two steps.
    #[test]
    fn the_differences_are_those_of_the_formulas() {
        let control = [(0.0, 0.0), (0.0, 4.0), (4.0, 4.0), (4.0, 0.0)].map(DVec2::from);
        let mut steps = Recorder::default();
        points(&control, 2, &mut steps);
        let d = |x: f64, y: f64| DVec2::new(x, y);
        assert_eq!(steps.steps()[0].differences, [d(2.0, 3.0), d(0.0, -6.0), d(-6.0, 0.0)]);
        assert_eq!(steps.steps()[1].differences[0], d(2.0, -3.0));
        assert_eq!(steps.steps()[2].point, d(4.0, 0.0));
    }
}
