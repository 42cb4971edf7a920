//! Space and surfaces: outcodes in space, the order of tests, the order of fragment operations, and the classification.

use super::p;
use durer::clip::outcode::{ClipDepths, Outcode};
use durer::explain::{self, ALGORITHMS, Frame, Input, Options};
use durer::fragment::{
    AlphaTest, Blend, Compare, Fragment, FragmentState, Outcome, Scissor, Stencil, StencilFace,
    StencilOp, Step, apply, apply_traced, replay,
};
use durer::info::{Coherence, Occluder};
use durer::math::{DVec3, DVec4, Rect, Vec4};
use durer::target::Framebuffer;
use durer::trace::{PseudocodeLine, Recorder};
use durer::visibility::polygons::warnock::{self, Step as Rules, WindowRule};
use durer::visibility::polygons::{Face, Screen};
use durer::visibility::surface::depth_sort::PaintTest;
use durer::visibility::surface::{SampleRect, WindowRelation};
use std::collections::BTreeSet;

fn frames(name: &str, example: &str) -> Vec<Frame> {
    explain::run(name, &Input::Example(example.to_owned()), &Options::default(), 5_000).unwrap()
}

#[test]
fn space_has_twenty_seven_regions_of_six_bits() {
    let sides = [-2.0, 0.0, 2.0];
    let mut codes = BTreeSet::new();
    for k in 0..27 {
        let [x, y, z] = [sides[k % 3], sides[k / 3 % 3], sides[k / 9]];
        let code = Outcode::of_homogeneous(DVec4::new(x, y, z, 1.0), ClipDepths::default());
        let outside = [x, y, z].iter().filter(|side| **side != 0.0).count();
        assert_eq!(code.0.count_ones() as usize, outside);
        codes.insert(code.0);
    }
    assert_eq!(codes.len(), 27);
    assert!(codes.iter().all(|code| *code < 64));
}

#[test]
fn the_and_of_all_codes_rejects_any_polygon() {
    let window = Rect::new(p(0.0, 0.0), p(4.0, 4.0)).unwrap();
    let and = |ring: &[(f64, f64)]| {
        let codes = ring.iter().map(|&(x, y)| Outcode::of_point_2d(&window, p(x, y)).0);
        codes.fold(0b1111, |all, code| all & code)
    };
    // All above; above and to the right; around the window, where outcodes decide nothing.
    assert_eq!(and(&[(1.0, 5.0), (3.0, 6.0), (-2.0, 7.0)]), 0b1000);
    assert_eq!(and(&[(5.0, 5.0), (9.0, 6.0), (5.0, 7.0)]), 0b1010);
    assert_eq!(and(&[(-1.0, -1.0), (9.0, -1.0), (2.0, 9.0)]), 0);
}

/// Checks the order from far to near; of the tests 1 and 2a to 2d the first that holds decides; a face that may hide
/// the other is marked and moved, and a face already marked is split.
#[test]
fn depth_sort_has_its_tests_in_order() {
    let tests = [
        PaintTest::Depths,
        PaintTest::Boxes,
        PaintTest::InFrontOfPlane,
        PaintTest::BehindPlane,
        PaintTest::Projections,
    ];
    assert!(tests.is_sorted());
    assert_eq!(tests.map(PaintTest::number), ["1", "2a", "2b", "2c", "2d"]);
    let count = |example: &str, kind: &str| {
        frames("depth-sort", example).iter().filter(|frame| frame.kind == kind).count()
    };
    // Three cyclically overlapping beams: two splits. Faces that pierce each other have no order either.
    assert_eq!(count("cyclic", "split"), 2);
    assert_eq!(count("penetration", "split"), 1);
}

/// Checks outside, inside, intersecting, surrounding; rules 1 to 4 in their order, and a quad around the window.
#[test]
fn warnock_has_four_relations_and_four_rules() {
    let look = |faces: &[Face], size: u32| {
        let screen = Screen { width: size, height: size, ..Screen::default() };
        let mut steps = Recorder::default();
        warnock::items(faces, &screen, &warnock::Options::default(), &mut steps).unwrap();
        steps.into_steps()
    };
    let face = |corners: &[(f64, f64)], z: f64| {
        let corners: Vec<DVec3> = corners.iter().map(|(x, y)| DVec3::new(*x, *y, z)).collect();
        Face::new(&corners).unwrap()
    };
    let quad = face(&[(-1.0, -1.0), (17.0, -1.0), (17.0, 17.0), (-1.0, 17.0)], 5.0);
    let alone = look(std::slice::from_ref(&quad), 16);
    let whole = SampleRect { x0: 0, y0: 0, x1: 16, y1: 16 };
    let surrounding = vec![(0, WindowRelation::Surrounding)];
    assert_eq!(alone[0], Rules::Look { window: whole, relations: surrounding });
    assert_eq!(alone[1], Rules::Simple { window: whole, rule: WindowRule::Single, face: Some(0) });
    assert!(alone[2..].iter().all(|step| matches!(step, Rules::Draw { .. })));
    // A small triangle in front of it in one quarter: three quarters by rule 2, the fourth is subdivided further.
    let triangle = face(&[(1.0, 9.0), (7.5, 9.0), (1.0, 15.5)], 2.0);
    let steps = look(&[quad.clone(), triangle], 16);
    let both = vec![(0, WindowRelation::Surrounding), (1, WindowRelation::Inside)];
    assert_eq!(steps[0], Rules::Look { window: whole, relations: both });
    assert_eq!(steps[1], Rules::Divide { window: whole, x: 8, y: 8 });
    let simple = |rule: WindowRule| -> Vec<(SampleRect, Option<u32>)> {
        let of_rule = |step: &Rules| match *step {
            Rules::Simple { window, rule: own, face } if own == rule => Some((window, face)),
            _ => None,
        };
        steps.iter().filter_map(of_rule).collect()
    };
    let large = |w: &&(SampleRect, Option<u32>)| w.0.x1 - w.0.x0 == 8 && w.1 == Some(0);
    assert_eq!(simple(WindowRule::Single).iter().filter(large).count(), 3);
    assert!(!simple(WindowRule::Surrounded).is_empty());
    assert!(
        simple(WindowRule::Surrounded)
            .iter()
            .chain(&simple(WindowRule::Pixel))
            .all(|w| w.1 == Some(1))
    );
    assert!(simple(WindowRule::Empty).is_empty());
    let crossing = steps.iter().any(|step| {
        matches!(step, Rules::Look { relations, .. } if relations.contains(&(1, WindowRelation::Crossing)))
    });
    assert!(crossing);
    // Two that pierce each other in a single pixel: no larger window is simple. Beside them is nothing.
    let sloped = |z: [f64; 2]| {
        let corners = [(3.0, 3.0, z[0]), (5.0, 3.0, z[1]), (5.0, 5.0, z[1]), (3.0, 5.0, z[0])];
        Face::new(&corners.map(DVec3::from)).unwrap()
    };
    let steps = look(&[sloped([1.0, 3.0]), sloped([3.0, 1.0])], 8);
    let numbers: BTreeSet<u8> = steps
        .iter()
        .filter_map(
            |step| if let Rules::Simple { rule, .. } = step { Some(rule.number()) } else { None },
        )
        .collect();
    assert!(numbers.contains(&1) && numbers.contains(&4), "{numbers:?}");
    assert_eq!(
        [WindowRule::Empty, WindowRule::Single, WindowRule::Surrounded, WindowRule::Pixel]
            .map(WindowRule::number),
        [1, 2, 3, 4]
    );
}

fn fragment(depth: f32, alpha: f32) -> Fragment {
    Fragment {
        x: 0,
        y: 0,
        depth,
        color: Vec4::new(1.0, 0.0, 0.0, alpha),
        index: 0.0,
        front_facing: true,
        item: 1,
        normal: [0.0, 0.0, 1.0],
    }
}

/// Checks scissor, alpha, stencil, depth, blending, in this order, each with its numbers.
#[test]
fn fragments_go_from_test_to_test() {
    let counting = StencilFace { pass: StencilOp::Increment, ..StencilFace::default() };
    let state = FragmentState {
        scissor: Some(Scissor { x0: 0, y0: 0, x1: 1, y1: 1 }),
        alpha_test: Some(AlphaTest { compare: Compare::Greater, reference: 0.1 }),
        stencil: Some(Stencil::both(counting)),
        blend: Some(Blend::Over),
        ..FragmentState::default()
    };
    let target = || {
        let mut target = Framebuffer::new(2, 1).with_depth().with_stencil();
        target.color.data_mut().fill([255; 4]);
        target
    };
    let all = [fragment(0.4, 0.5), fragment(0.45, 1.0), fragment(0.3, 0.05)];
    let outside = Fragment { x: 1, ..fragment(0.1, 1.0) };
    let (mut traced, mut plain, mut steps) = (target(), target(), Recorder::default());
    let outcomes = all.into_iter().chain([outside]).map(|fragment| {
        let outcome = apply_traced(&state, fragment, &mut traced, &mut steps);
        assert_eq!(apply(&state, fragment, &mut plain), outcome);
        outcome
    });
    let outcomes: Vec<Outcome> = outcomes.collect();
    let expected = [Outcome::Drawn, Outcome::Depth, Outcome::AlphaTest, Outcome::Scissor];
    assert_eq!(outcomes, expected);
    assert!(traced == plain);
    let mut rebuilt = target();
    replay(steps.steps(), &mut rebuilt);
    assert!(rebuilt == traced);
    // ½ red over white, in linear light, with the depth of the fragment; the next fragment is behind it.
    let half = |step: &Step| matches!(step, Step::Blend { result, .. } if (result.y - 0.5).abs() < 1e-6 && result.x == 1.0);
    let lines: Vec<usize> = steps.steps().iter().map(Step::line).collect();
    assert_eq!(lines, [2, 3, 5, 7, 9, 12, 2, 3, 5, 7, 2, 3, 2]);
    assert!(matches!(steps.steps()[2], Step::Stencil { stored: 0, new: 1, passes: true, .. }));
    assert!(half(&steps.steps()[4]));
    let depth =
        |step: &Step| matches!(step, Step::Depth { depth: 0.45, stored: 0.4, passes: false });
    assert!(depth(&steps.steps()[9]));
}

#[test]
fn the_classification_is_printed_from_data() {
    let facts = |name: &str| {
        let info = ALGORITHMS.iter().find(|info| info.name == name).unwrap();
        (info.class.name(), info.occluder)
    };
    assert_eq!(facts("z-buffer").1, Occluder::Point);
    assert_eq!(facts("ray"), ("image", Occluder::Point));
    assert_eq!(facts("spanning-scan-line").1, Occluder::Line);
    assert_eq!(facts("warnock"), ("image", Occluder::Area));
    assert_eq!(facts("depth-sort"), ("list-priority", Occluder::Area));
    assert_eq!(facts("hidden-line"), ("object", Occluder::Area));
    let scan = ALGORITHMS.iter().find(|info| info.name == "scan-line-z").unwrap();
    assert!(scan.coherence.contains(&Coherence::ScanLine));
}
