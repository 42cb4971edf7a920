//! Lines at windows.

use super::{near, p};
use durer::clip::line::liang_barsky::{Numbers, Step as Passage};
use durer::clip::line::{
    End, HalfPlane, HalfSpaceRelation, Segment, cohen_sutherland, cyrus_beck, homogeneous,
    liang_barsky, midpoint, skala, sobkow_pospisil_yang as by_code,
};
use durer::clip::outcode::Outcode;
use durer::math::{DVec2, DVec3, IVec2, Rect};
use durer::trace::{NoTrace, Recorder};

fn window() -> Rect {
    Rect::new(p(0.0, 0.0), p(10.0, 10.0)).unwrap()
}

#[test]
fn nine_regions_have_their_codes() {
    let rows = [
        (15.0, ["1001", "1000", "1010"]),
        (5.0, ["0001", "0000", "0010"]),
        (-5.0, ["0101", "0100", "0110"]),
    ];
    for (y, codes) in rows {
        let row = [-5.0, 5.0, 15.0].map(|x| Outcode::of_point_2d(&window(), p(x, y)).to_string());
        assert_eq!(row, codes);
    }
    assert_eq!(format!("{:?}", Outcode::LEFT | Outcode::TOP), "Outcode(1001)");
    // Planes numbered by hand: H1 bottom, H2 left, H3 top, H4 right.
    let order = [Outcode::BOTTOM, Outcode::LEFT, Outcode::TOP, Outcode::RIGHT];
    assert_eq!(Outcode::LEFT.digits(&order), "0100");
    assert_eq!((Outcode::NEAR | Outcode::LEFT).to_string(), "010001");
    // The corners of any primitive: all beyond the top border.
    let roof = [p(-5.0, 12.0), p(5.0, 20.0), p(15.0, 11.0)];
    let codes = roof.map(|corner| Outcode::of_point_2d(&window(), corner));
    assert_eq!(codes[0] & codes[1] & codes[2], Outcode::TOP);
}

#[test]
fn cohen_and_sutherland_reject_ad_after_one_cut() {
    use cohen_sutherland::Step;
    // A is left of the window, D above it; the line passes outside the window's upper left corner.
    let (a, d) = (p(-4.0, 8.0), p(2.0, 17.0));
    let mut steps = Recorder::default();
    let seen = cohen_sutherland::clip(&window(), Segment::new(a, d), &mut steps).unwrap();
    assert_eq!(seen, None);
    let [Step::Codes { start, end }, cut, Step::Rejected] = *steps.steps() else {
        panic!("{:?}", steps.steps())
    };
    assert_eq!([start, end].map(|code| code.to_string()), ["0001", "1000"]);
    assert_eq!([start & end, start | end].map(|code| code.to_string()), ["0000", "1001"]);
    let c = p(0.0, 14.0);
    let expected =
        Step::Cut { end: End::Start, border: Outcode::LEFT, point: c, code: Outcode::TOP };
    assert_eq!(cut, expected);
}

#[test]
fn cohen_and_sutherland_cut_eh_twice() {
    use cohen_sutherland::Step;
    let (e, h) = (p(-5.0, 2.0), p(15.0, 6.0));
    let (f, g) = (p(0.0, 3.0), p(10.0, 5.0));
    let mut steps = Recorder::default();
    let seen = cohen_sutherland::clip(&window(), Segment::new(e, h), &mut steps).unwrap();
    assert_eq!(seen, Some(Segment::new(f, g)));
    let inside = Outcode::INSIDE;
    let expected = [
        Step::Codes { start: Outcode::LEFT, end: Outcode::RIGHT },
        Step::Cut { end: End::Start, border: Outcode::LEFT, point: f, code: inside },
        Step::Cut { end: End::End, border: Outcode::RIGHT, point: g, code: inside },
        Step::Accepted,
    ];
    assert_eq!(steps.steps(), expected);
}

#[test]
fn short_ways_cut_no_more_than_they_must() {
    let cuts = |a: DVec2, b: DVec2| {
        let mut steps = Recorder::default();
        cohen_sutherland::clip(&window(), Segment::new(a, b), &mut steps).unwrap();
        let is_cut = |step: &&_| matches!(step, cohen_sutherland::Step::Cut { .. });
        steps.steps().iter().filter(is_cut).count()
    };
    assert_eq!(cuts(p(5.0, -5.0), p(5.0, 15.0)), 2, "vertical: bottom and top");
    assert_eq!(cuts(p(-5.0, 5.0), p(15.0, 5.0)), 2, "horizontal: left and right");
    assert_eq!(cuts(p(5.0, 5.0), p(15.0, 7.0)), 1, "one end inside");
    assert_eq!(cuts(p(5.0, 5.0), p(15.0, 30.0)), 2, "beyond two borders");
}

/// Checks that halving goes from 8 to 4 to 2 to 3: the last visible pixel is at x = 3, where y = 1.5 rounds up.
#[test]
fn halving_ends_at_the_last_visible_pixel() {
    let window = midpoint::PixelWindow::new(IVec2::ZERO, IVec2::new(3, 9)).unwrap();
    let line = Segment::new(IVec2::ZERO, IVec2::new(8, 4));
    let found = midpoint::clip(&window, line, &mut durer::trace::NoTrace);
    assert_eq!(found, Some(Segment::new(IVec2::ZERO, IVec2::new(3, 2))));
}

#[test]
fn halving_a_thousand_pixels_takes_ten_turns_an_end() {
    let screen = midpoint::PixelWindow::new(IVec2::ZERO, IVec2::splat(1023)).unwrap();
    for (a, b) in [(512, 1535), (-511, 512), (1000, 2023)] {
        let mut steps = Recorder::default();
        let line = Segment::new(IVec2::new(a, 500), IVec2::new(b, 500));
        midpoint::clip(&screen, line, &mut steps).unwrap();
        let halvings = steps.steps().iter();
        let halvings = halvings.filter(|s| matches!(s, midpoint::Step::Halved { .. })).count();
        assert!((1..=10).contains(&halvings), "{halvings}");
    }
}

/// Border, relation and numbers of each step.
fn borders<P: Copy>(steps: &[Passage<P>]) -> Vec<(usize, HalfSpaceRelation, Numbers)> {
    let border = |step: &Passage<P>| match *step {
        Passage::Border { border, relation, numbers } => Some((border, relation, numbers)),
        _ => None,
    };
    steps.iter().filter_map(border).collect()
}

#[test]
fn half_planes_tell_by_the_signs_of_e() {
    // Q1 = (1, 1), Q2 = (5, 4): n = (Δy, −Δx) points to the lower right.
    let (q1, q2) = (p(1.0, 1.0), p(5.0, 4.0));
    let plane = HalfPlane { normal: p(3.0, -4.0), point: q1 };
    let clip = |a, b| {
        let mut steps = Recorder::default();
        let line = Segment::new(a, b);
        let seen = liang_barsky::clip_half_planes(&[plane], line, &mut steps).unwrap();
        let (_, relation, numbers) = borders(steps.steps())[0];
        (seen, relation, [numbers.start, numbers.end], numbers.t())
    };
    // E = 3·(x − 1) − 4·(y − 1).
    let (seen, relation, e, t) = clip(p(1.0, 4.0), p(9.0, 4.0));
    assert_eq!((relation, e, t), (HalfSpaceRelation::Entering, [-12.0, 12.0], Some(0.5)));
    assert_eq!(seen, Some(Segment::new(p(5.0, 4.0), p(9.0, 4.0))));
    assert_eq!(clip(p(0.0, 5.0), p(1.0, 6.0)).0, None);
    assert_eq!(clip(p(5.0, 0.0), p(9.0, 1.0)).1, HalfSpaceRelation::Inside);
    // A segment in the line itself has E = 0 at both ends; the half-plane is closed, so it is inside.
    let (seen, relation, e, t) = clip(q1, q2);
    assert_eq!((seen, relation), (Some(Segment::new(q1, q2)), HalfSpaceRelation::Inside));
    assert_eq!((e, t), ([0.0, 0.0], None));
}

#[test]
fn liang_and_barsky_have_p_q_and_r_of_all_four_borders() {
    let (a, b) = (p(-5.0, 3.0), p(15.0, 9.0));
    let mut steps = Recorder::default();
    let seen = liang_barsky::clip(&window(), Segment::new(a, b), &mut steps).unwrap();
    assert_eq!(seen, Some(Segment::new(p(0.0, 4.5), p(10.0, 7.5))));
    // Left, right, bottom, top: p = −Δx, Δx, −Δy, Δy.
    let expected = [
        (-20.0, -5.0, 0.25, [0.25, 1.0]),
        (20.0, 15.0, 0.75, [0.25, 0.75]),
        (-6.0, 3.0, -0.5, [0.25, 0.75]),
        (6.0, 7.0, 7.0 / 6.0, [0.25, 0.75]),
    ];
    for (k, (found, expected)) in borders(steps.steps()).into_iter().zip(expected).enumerate() {
        let (border, _, numbers) = found;
        let (p, q, r, u) = expected;
        assert_eq!((border, numbers.p(), numbers.start), (k, p, q));
        assert!(near(numbers.t().unwrap(), r), "{numbers:?}");
        assert_eq!([numbers.lower, numbers.upper], u);
    }
    assert_eq!(borders(steps.steps()).len(), 4);
}

#[test]
fn a_line_along_a_border_has_p_zero() {
    let mut steps = Recorder::default();
    let line = Segment::new(p(-5.0, 12.0), p(15.0, 12.0));
    assert_eq!(liang_barsky::clip(&window(), line, &mut steps).unwrap(), None);
    let top = borders(steps.steps())[3].2;
    assert_eq!((top.p(), top.start, top.t()), (0.0, -2.0, None));
    assert_eq!(steps.steps().last(), Some(&Passage::Rejected));
}

#[test]
fn turning_a_segment_swaps_entering_and_leaving() {
    let (a, b) = (p(-5.0, 3.0), p(15.0, 9.0));
    let numbers = |a, b| {
        let mut steps = Recorder::default();
        cyrus_beck::clip(&window(), Segment::new(a, b), &mut steps).unwrap();
        borders(steps.steps())
    };
    let (there, back) = (numbers(a, b), numbers(b, a));
    // Outward normal · v: below 0 the line enters, above 0 it leaves.
    let classes = |all: &[(usize, HalfSpaceRelation, Numbers)]| -> Vec<f64> {
        all.iter().map(|(_, _, numbers)| numbers.p().signum()).collect()
    };
    assert_eq!(classes(&there), [-1.0, 1.0, -1.0, 1.0]);
    assert_eq!(classes(&back), [1.0, -1.0, 1.0, -1.0]);
    for ((border, relation, there), (other, turned, back)) in there.iter().zip(&back) {
        assert_eq!(border, other);
        let expected = match relation {
            HalfSpaceRelation::Entering => HalfSpaceRelation::Leaving,
            HalfSpaceRelation::Leaving => HalfSpaceRelation::Entering,
            same => *same,
        };
        assert_eq!(*turned, expected);
        assert!(near(there.t().unwrap(), 1.0 - back.t().unwrap()));
    }
    // t_e and t_l at the end, and seen from the other end.
    let last =
        |all: &[(usize, HalfSpaceRelation, Numbers)]| all.last().map(|n| [n.2.lower, n.2.upper]);
    assert_eq!((last(&there), last(&back)), (Some([0.25, 0.75]), Some([0.25, 0.75])));
}

#[test]
fn cuts_come_in_the_direction_of_the_caller() {
    let (a, b) = (p(15.0, 9.0), p(-5.0, 3.0));
    let mut steps = Recorder::default();
    cyrus_beck::clip(&window(), Segment::new(a, b), &mut steps).unwrap();
    let cuts: Vec<_> = steps
        .steps()
        .iter()
        .filter_map(|step| match *step {
            Passage::Cut { end, border, point } => Some((end, border, point)),
            _ => None,
        })
        .collect();
    assert_eq!(cuts, [(End::Start, 1, p(10.0, 7.5)), (End::End, 0, p(0.0, 4.5))]);
}

#[test]
fn a_factor_of_homogeneous_points_moves_t_but_not_the_place() {
    let unit = Rect::new(DVec2::ZERO, DVec2::ONE).unwrap();
    let q = DVec3::new(1.0, 0.0, 1.0);
    let cases = [
        (DVec3::new(-1.0, 0.0, 1.0), -1.0, 0.5, DVec3::new(0.0, 0.0, 1.0)),
        (DVec3::new(-2.0, 0.0, 2.0), -2.0, 2.0 / 3.0, DVec3::new(0.0, 0.0, 4.0 / 3.0)),
    ];
    for (p, d1, t, s) in cases {
        let mut steps = Recorder::default();
        let line = Segment::new(p, q);
        let seen = homogeneous::clip_homogeneous(&unit, line, &mut steps).unwrap().unwrap();
        let all = borders(steps.steps());
        let (left, right) = (all[0].2, all[1].2);
        // d1 = x, d2 = w − x.
        assert_eq!([left.start, left.end], [d1, 1.0]);
        assert_eq!([right.start, right.end], [p.z - p.x, 0.0]);
        assert!(near(left.t().unwrap(), t));
        assert!((seen.start - s).abs().max_element() < 1e-15, "{seen:?}");
        assert_eq!(seen.start.x / seen.start.z, 0.0);
    }
}

/// Checks a segment in space with the cube 0 … 1: d1 = x, d2 = w − x, d3 = y, d4 = w − y, d5 = z, d6 = w − z.
#[test]
fn a_cube_from_0_to_1_has_six_boundary_coordinates() {
    use durer::clip::line::ClipBox;
    use durer::math::DVec4;
    let cube = ClipBox::new(DVec3::ZERO, DVec3::ONE).unwrap();
    let q = DVec4::new(1.0, 0.0, 0.0, 1.0);
    let cases = [
        (DVec4::new(-1.0, 0.0, 0.0, 1.0), 0.5, DVec4::W),
        (DVec4::new(-2.0, 0.0, 0.0, 2.0), 2.0 / 3.0, DVec4::W * (4.0 / 3.0)),
    ];
    for (p, t, s) in cases {
        let mut steps = Recorder::default();
        let line = Segment::new(p, q);
        let seen = homogeneous::clip_homogeneous_box(&cube, line, &mut steps).unwrap().unwrap();
        let starts: Vec<f64> = borders(steps.steps()).iter().map(|b| b.2.start).collect();
        assert_eq!(starts, [p.x, p.w - p.x, p.y, p.w - p.y, p.z, p.w - p.z, p.w]);
        assert!(near(borders(steps.steps())[0].2.t().unwrap(), t));
        assert!((seen.start - s).abs().max_element() < 1e-15, "{seen:?}");
        assert_eq!(homogeneous::replay(line, steps.steps()), Some(seen));
        let back = Segment::new(q, p);
        let other = homogeneous::clip_homogeneous_box(&cube, back, &mut NoTrace).unwrap().unwrap();
        assert_eq!((other.end, other.start), (seen.start, seen.end));
    }
    // Beyond the far side although x and y are inside; and a line along a diagonal through the eye.
    let at = |p: [f64; 4]| DVec4::from(p);
    let beyond = Segment::new(at([0.5, 0.5, 1.5, 1.0]), at([0.6, 0.5, 1.1, 1.0]));
    assert_eq!(homogeneous::clip_homogeneous_box(&cube, beyond, &mut NoTrace), Ok(None));
    let behind = Segment::new(at([0.5, 0.5, 0.5, 1.0]), at([0.5, 0.5, 0.5, -1.0]));
    let seen = homogeneous::clip_homogeneous_box(&cube, behind, &mut NoTrace).unwrap().unwrap();
    assert_eq!(seen.end.w, 0.5);
}

#[test]
fn a_volume_tells_its_six_boundary_coordinates() {
    use durer::clip::volume::{ClipVertex, Options, Step, clip_segment};
    use durer::math::DVec4;
    let vertex =
        |x: f64, w: f64| ClipVertex { position: DVec4::new(x, 0.0, 0.0, w), attributes: () };
    let mut steps = Recorder::default();
    let seen = clip_segment([vertex(-3.0, 1.0), vertex(1.0, 1.0)], &Options::default(), &mut steps);
    assert_eq!(seen.unwrap()[0].position, DVec4::new(-1.0, 0.0, 0.0, 1.0));
    let Step::Code { distances, code, .. } = steps.steps()[0] else { panic!("no code") };
    assert_eq!((distances, code), ([-2.0, 4.0, 1.0, 1.0, 1.0, 1.0], Outcode::LEFT));
    let cut = steps.steps().iter().find_map(|step| match *step {
        Step::Cut { distances, outside, .. } => Some((distances, outside)),
        _ => None,
    });
    // t from the outside end: d_out / (d_out − d_in) = −2 / (−2 − 2) = ½.
    assert_eq!(cut, Some(([2.0, -2.0], 0)));
}

/// Window (0, 0)–(10, 6), from (−4, 1) to (10, 8): A × B, its values at the corners, and the two borders of its code.
#[test]
fn skala_codes_the_corners_by_one_cross_product() {
    let window = Rect::new(p(0.0, 0.0), p(10.0, 6.0)).unwrap();
    let mut steps = Recorder::default();
    skala::clip(&window, Segment::new(p(-4.0, 1.0), p(10.0, 8.0)), &mut steps).unwrap();
    let steps = steps.steps();
    assert_eq!(steps[0], skala::Step::Line { coefficients: DVec3::new(-7.0, 14.0, -42.0) });
    let corners = steps.iter().filter_map(|s| match *s {
        skala::Step::Corner { corner, value, side } => Some((corner, value, side.is_gt())),
        _ => None,
    });
    let expected = [(0, -42.0, false), (1, -112.0, false), (2, -28.0, false), (3, 42.0, true)];
    assert_eq!(corners.collect::<Vec<_>>(), expected);
    // The left and the top border are between corners of different signs.
    let cuts = steps.iter().filter_map(|s| match *s {
        skala::Step::Cut { end, point, .. } => Some((end, point)),
        _ => None,
    });
    assert_eq!(cuts.collect::<Vec<_>>(), [(End::Start, p(0.0, 3.0)), (End::End, p(6.0, 6.0))]);
    assert_eq!(steps.last(), Some(&skala::Step::Accepted { at_once: false }));
}

/// The line code 0001 1000 twice: once through the window, once past its corner.
#[test]
fn a_line_code_names_the_borders_to_cut() {
    let window = Rect::new(p(0.0, 0.0), p(10.0, 6.0)).unwrap();
    let steps = |a: DVec2, b: DVec2| {
        let mut steps = Recorder::default();
        by_code::clip(&window, Segment::new(a, b), &mut steps).unwrap();
        steps.into_steps()
    };
    let code = by_code::Step::Code { start: Outcode::LEFT, end: Outcode::TOP };
    let cut = |end, border, point, code| by_code::Step::Cut { end, border, point, code };
    let through = steps(p(-4.0, 1.0), p(10.0, 8.0));
    let expected = [
        code,
        cut(End::Start, Outcode::LEFT, p(0.0, 3.0), Outcode::INSIDE),
        cut(End::End, Outcode::TOP, p(6.0, 6.0), Outcode::INSIDE),
        by_code::Step::Accepted { at_once: false },
    ];
    assert_eq!(through, expected);
    let past = steps(p(-4.0, 3.0), p(3.0, 9.5));
    let [first, by_code::Step::Cut { end, border, point, code: beyond }, last] = past[..] else {
        panic!("{past:?}");
    };
    assert_eq!((first, last), (code, by_code::Step::Rejected { at_once: false }));
    assert_eq!((end, border, beyond), (End::Start, Outcode::LEFT, Outcode::TOP));
    assert!(
        point.x == 0.0 && near(point.y, 3.0 + 4.0 * 6.5 / 7.0) && (point.y - 6.71).abs() < 5e-3
    );
    // Exercise 4: the codes of a segment and of the same one turned round.
    let codes = |a: DVec2, b: DVec2| {
        let code = |q: DVec2| Outcode::of_point_2d(&super::lines::window(), q).to_string();
        [code(a), code(b)]
    };
    assert_eq!(codes(p(-5.0, 12.0), p(5.0, -3.0)), ["1001", "0100"]);
}
