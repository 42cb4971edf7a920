//! Commands: state, display lists, evaluators, and uses of stencils.

use durer::commands::{
    BezierPatch, Command, CornerVertex, CullFace, DisplayLists, MAX_NESTING, Pipeline, Primitive,
    SpaceCurve, Step, execute, execute_traced, replay,
};
use durer::curve::b_spline::BSpline;
use durer::fragment::{
    Compare, FragmentState, LogicOp, Palette, Scissor, Stencil, StencilFace, StencilOp, WriteMask,
};
use durer::math::{DMat4, DVec3, DVec4, Vec4};
use durer::scene::{Camera, Projection};
use durer::target::Framebuffer;
use durer::trace::Recorder;
use proptest::prelude::*;

const SIDE: u32 = 40;

fn target() -> Framebuffer {
    Framebuffer::new(SIDE, SIDE).with_depth().with_stencil()
}

fn square(half: f64, z: f64) -> Command {
    let corner = |x: f64, y: f64| CornerVertex::from(DVec3::new(x * half, y * half, z));
    let ring = vec![corner(-1., -1.), corner(1., -1.), corner(1., 1.), corner(-1., 1.)];
    Command::Draw(Primitive::Polygon, ring)
}

fn color(r: f32, g: f32, b: f32) -> Command {
    Command::Color(Vec4::new(r, g, b, 1.0))
}

fn run(commands: &[Command], lists: &DisplayLists) -> (Framebuffer, Pipeline) {
    let (mut pipeline, mut target) = (Pipeline::default(), target());
    execute(commands, lists, &mut pipeline, &mut target).expect("drawn");
    (target, pipeline)
}

fn count(target: &Framebuffer, rgba: [u8; 4]) -> usize {
    target.color.data().iter().filter(|c| **c == rgba).count()
}

const RED: [u8; 4] = [255, 0, 0, 255];
const GREEN: [u8; 4] = [0, 255, 0, 255];

#[test]
fn the_initial_state_is_opengls() {
    let p = Pipeline::default();
    assert_eq!(
        (p.model_view, p.projection, p.color),
        (DMat4::IDENTITY, DMat4::IDENTITY, Vec4::ONE)
    );
    assert_eq!((p.cull, p.viewport, p.fragments.depth), (CullFace::None, None, None));
    // Without a depth test the last one drawn is visible, however far away.
    let far_last = [color(0., 1., 0.), square(1.0, -0.5), color(1., 0., 0.), square(1.0, 0.5)];
    assert_eq!(count(&run(&far_last, &DisplayLists::default()).0, RED), 1600);
}

#[test]
fn depth_is_nearer_towards_minus_one() {
    let tested = FragmentState::default();
    let commands = [
        Command::Clear { color: None, depth: Some(1.0), stencil: None, index: None },
        Command::Fragments(tested),
        color(0., 1., 0.),
        square(0.5, -0.5),
        color(1., 0., 0.),
        square(1.0, 0.5),
    ];
    let (target, _) = run(&commands, &DisplayLists::default());
    assert_eq!((count(&target, GREEN), count(&target, RED)), (400, 1200));
    let depth = target.depth.and_then(|d| d.get(20, 20));
    assert_eq!(depth, Some(0.25));
}

#[test]
fn replaying_a_list_is_giving_its_commands() {
    let mut lists = DisplayLists::default();
    let inner = lists.record(vec![
        Command::MultiplyModelView(DMat4::from_scale(DVec3::splat(0.5))),
        square(1.0, 0.0),
    ]);
    let outer = lists.record(vec![
        Command::PushModelView,
        color(1., 0., 0.),
        Command::Call(inner),
        color(0., 1., 0.),
        Command::Call(inner),
        Command::PopModelView,
    ]);
    let direct: Vec<Command> = [
        Command::PushModelView,
        color(1., 0., 0.),
        Command::MultiplyModelView(DMat4::from_scale(DVec3::splat(0.5))),
        square(1.0, 0.0),
        color(0., 1., 0.),
        Command::MultiplyModelView(DMat4::from_scale(DVec3::splat(0.5))),
        square(1.0, 0.0),
        Command::PopModelView,
    ]
    .into();
    let by_list = run(&[Command::Call(outer)], &lists);
    assert!(by_list == run(&direct, &DisplayLists::default()));
    assert_eq!((count(&by_list.0, GREEN), count(&by_list.0, RED)), (100, 300));
    assert_eq!(by_list.1.color, Vec4::new(0.0, 1.0, 0.0, 1.0), "state that a list sets stays");
    // Replacing a list changes the lists that call it.
    lists.replace(inner, vec![square(1.0, 0.0)]).expect("list");
    assert_eq!(count(&run(&[Command::Call(outer)], &lists).0, GREEN), 1600);
}

#[test]
fn lists_without_end_are_errors() {
    let mut lists = DisplayLists::default();
    let itself = lists.record(Vec::new());
    lists.replace(itself, vec![Command::Call(itself)]).expect("list");
    let fails = |lists: &DisplayLists, list| {
        execute(&[Command::Call(list)], lists, &mut Pipeline::default(), &mut target()).is_err()
    };
    assert!(fails(&lists, itself));
    assert!(fails(&DisplayLists::default(), itself));
    // Each list calls the one before it twice: few lists, but more commands than can ever be run.
    let mut latest = lists.record(vec![Command::PushModelView, Command::PopModelView]);
    for _ in 0..MAX_NESTING - 2 {
        latest = lists.record(vec![Command::Call(latest); 2]);
    }
    assert!(fails(&lists, latest));
    let pop = execute(&[Command::PopModelView], &lists, &mut Pipeline::default(), &mut target());
    assert!(pop.is_err());
    let push = vec![Command::PushModelView; 40];
    assert!(execute(&push, &lists, &mut Pipeline::default(), &mut target()).is_err());
}

#[test]
fn steps_of_lists_are_commands_without_lists() {
    let mut lists = DisplayLists::default();
    let mut steps = Recorder::default();
    let part = vec![color(1., 0., 0.), square(0.2, 0.0)];
    let wheel = lists.record_traced(part.clone(), &mut steps);
    let moved = Command::MultiplyModelView(DMat4::from_translation(DVec3::new(0.5, 0.0, 0.0)));
    let [push, pop] = [Command::PushModelView, Command::PopModelView];
    let car = vec![push, moved.clone(), Command::Call(wheel), pop, square(0.1, 0.1)];
    let car = lists.record_traced(car, &mut steps);
    let recorded = Step::Recorded { list: wheel, commands: part };
    assert_eq!((steps.steps().len(), steps.steps().first()), (2, Some(&recorded)));
    let main = [color(0., 1., 0.), Command::Call(car), moved, Command::Call(wheel)];
    let (mut pipeline, mut traced) = (Pipeline::default(), target());
    let mut steps = Recorder::default();
    execute_traced(&main, &lists, &mut pipeline, &mut traced, &mut steps).expect("drawn");
    assert_eq!((traced.clone(), pipeline.clone()), run(&main, &lists));
    // Replayed without any list, they draw and set the same.
    assert_eq!(run(&replay(steps.steps()), &DisplayLists::default()), (traced, pipeline));
    let depths: Vec<usize> = (steps.steps().iter())
        .filter_map(|step| match step {
            Step::Called { depth, .. } | Step::Returned { depth } => Some(*depth),
            Step::Executed { .. } | Step::Recorded { .. } | Step::Refused { .. } => None,
        })
        .collect();
    assert_eq!(depths, [1, 2, 1, 0, 1, 0]);
    // The matrix inside of the list, and on its stack.
    let inside = DMat4::from_translation(DVec3::new(0.5, 0.0, 0.0));
    let Step::Executed { model_view, kept, depth, .. } = &steps.steps()[5] else { panic!() };
    assert_eq!((*model_view, *kept, *depth), (inside, 1, 2));
}

#[test]
fn the_last_step_of_a_list_without_end_refuses_its_call() {
    let mut lists = DisplayLists::default();
    let list = lists.record(Vec::new());
    lists.replace(list, vec![Command::Call(list)]).expect("there");
    let mut steps = Recorder::default();
    let (mut pipeline, mut target) = (Pipeline::default(), target());
    let main = [Command::Call(list)];
    assert!(execute_traced(&main, &lists, &mut pipeline, &mut target, &mut steps).is_err());
    assert_eq!(steps.steps().len(), MAX_NESTING + 1);
    assert_eq!(steps.steps().last(), Some(&Step::Refused { list, depth: MAX_NESTING }));
}

#[test]
fn faces_are_culled_by_the_way_they_turn() {
    for (cull, expected) in [(CullFace::None, 1600), (CullFace::Back, 1600), (CullFace::Front, 0)] {
        let commands = [color(1., 0., 0.), Command::Cull(cull), square(1.0, 0.0)];
        assert_eq!(count(&run(&commands, &DisplayLists::default()).0, RED), expected, "{cull:?}");
    }
}

#[test]
fn viewport_and_scissor_bound_what_is_drawn() {
    let scissor = Some(Scissor { x0: 0, y0: 0, x1: 15, y1: 40 });
    let commands = [
        color(1., 0., 0.),
        Command::Viewport(Some([10, 20, 10, 5])),
        square(3.0, 0.0),
        Command::Fragments(FragmentState { scissor, depth: None, ..Default::default() }),
        color(0., 1., 0.),
        square(3.0, 0.0),
    ];
    let (target, _) = run(&commands, &DisplayLists::default());
    assert_eq!((count(&target, GREEN), count(&target, RED)), (25, 25));
    let beyond = [Command::Viewport(Some([31, 0, 10, 5]))];
    assert!(
        execute(&beyond, &DisplayLists::default(), &mut Pipeline::default(), &mut self::target())
            .is_err()
    );
}

#[test]
fn evaluators_draw_curves_and_patches() {
    // A quarter of a circle of radius 0.9 as a rational curve.
    let (r, w) = (0.9, std::f64::consts::FRAC_1_SQRT_2);
    let control = [(r, 0.0, 1.0), (r, r, w), (0.0, r, 1.0)];
    let control = control.map(|(x, y, w)| DVec4::new(x * w, y * w, 0.0, w)).to_vec();
    let circle = SpaceCurve::Nurbs(BSpline::clamped(2, control).expect("spline"));
    for i in 0..=20 {
        let p = circle.point(f64::from(i) / 20.0).expect("point");
        assert!((p.length() - r).abs() < 1e-12, "{p}");
    }
    let commands = [color(1., 0., 0.), Command::EvaluateCurve(circle, 40)];
    let (target, _) = run(&commands, &DisplayLists::default());
    let lit = count(&target, RED);
    assert!((18..=36).contains(&lit), "{lit}");
    let line = vec![
        DVec3::new(-0.875, -0.5, 0.0),
        DVec3::new(0.0, -0.5, 0.0),
        DVec3::new(0.875, -0.5, 0.0),
    ];
    let commands = [color(1., 0., 0.), Command::EvaluateCurve(SpaceCurve::Bezier(line), 7)];
    assert_eq!(count(&run(&commands, &DisplayLists::default()).0, RED), 36);
    let row = |y: f64| vec![DVec3::new(-0.5, y, 0.0), DVec3::new(0.5, y, 0.0)];
    let patch = BezierPatch { rows: vec![row(-0.5), row(0.0), row(0.5)] };
    let commands = [color(1., 0., 0.), Command::EvaluatePatch(patch, [3, 5])];
    assert_eq!(count(&run(&commands, &DisplayLists::default()).0, RED), 400);
    for steps in [0, u32::MAX] {
        let command = Command::EvaluateCurve(SpaceCurve::Bezier(Vec::new()), steps);
        let failed = execute(
            &[command],
            &DisplayLists::default(),
            &mut Pipeline::default(),
            &mut self::target(),
        );
        assert!(failed.is_err());
    }
}

/// Drawn into the stencil first, a larger copy leaves only a rim around the smaller one.
#[test]
fn a_stencil_leaves_the_outline() {
    let face = |compare, pass| StencilFace { compare, reference: 1, pass, ..Default::default() };
    let with = |face| FragmentState {
        stencil: Some(Stencil::both(face)),
        depth: None,
        ..Default::default()
    };
    let commands = [
        Command::Fragments(with(face(Compare::Always, StencilOp::Replace))),
        color(0., 1., 0.),
        square(0.5, 0.0),
        Command::Fragments(with(face(Compare::NotEqual, StencilOp::Keep))),
        color(1., 0., 0.),
        square(0.6, 0.0),
    ];
    let (target, _) = run(&commands, &DisplayLists::default());
    assert_eq!((count(&target, GREEN), count(&target, RED)), (400, 24 * 24 - 400));
}

/// Checks the stencil count of a body's faces behind the section plane: where more back faces than front faces are
/// counted, the plane is inside the body and gets its cap.
#[test]
fn a_stencil_caps_a_section() {
    let count_faces = Stencil {
        front: StencilFace { pass: StencilOp::DecrementWrap, ..Default::default() },
        back: StencilFace { pass: StencilOp::IncrementWrap, ..Default::default() },
    };
    let counting = FragmentState { stencil: Some(count_faces), depth: None, ..Default::default() };
    // The section has removed the near face; the far one is seen from inside the body.
    let mut turned = square(0.5, 0.6);
    if let Command::Draw(_, ring) = &mut turned {
        ring.reverse();
    }
    let cap = StencilFace { compare: Compare::NotEqual, reference: 0, ..Default::default() };
    let capping =
        FragmentState { stencil: Some(Stencil::both(cap)), depth: None, ..Default::default() };
    let commands = [
        Command::Fragments(counting),
        color(0., 1., 0.),
        turned,
        Command::Fragments(capping),
        color(1., 0., 0.),
        square(1.0, 0.0),
    ];
    let (target, _) = run(&commands, &DisplayLists::default());
    assert_eq!((count(&target, RED), count(&target, GREEN)), (400, 0));
}

fn projection(fov_y: f64) -> DMat4 {
    let (eye, target, up) = (DVec3::Z, DVec3::ZERO, DVec3::Y);
    let projection = Projection::Perspective { fov_y };
    Camera { eye, target, up, projection, near: 0.1, far: 10.0 }.clip_from_view(1.0)
}

fn number() -> impl Strategy<Value = f64> {
    prop_oneof![4 => -3.0..3.0f64, 1 => -1e9..1e9f64, 1 => Just(f64::NAN), 1 => Just(f64::INFINITY)]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn any_vertices_do_no_harm(points in prop::collection::vec([number(), number(), number()], 0..9), fov in 0.1..3.0f64) {
        let projection = projection(fov);
        let vertices: Vec<CornerVertex> = points.into_iter().map(|p| DVec3::from(p).into()).collect();
        let mut commands = vec![Command::LoadProjection(projection), Command::Fragments(FragmentState::default())];
        for primitive in [Primitive::Points, Primitive::Lines, Primitive::LineStrip, Primitive::Triangles, Primitive::Polygon] {
            commands.push(Command::Draw(primitive, vertices.clone()));
        }
        let (target, _) = run(&commands, &DisplayLists::default());
        prop_assert!(target.depth.iter().flat_map(|d| d.data()).all(|d| (0.0..=1.0).contains(d)));
    }
}

fn indexed(commands: &[Command]) -> Framebuffer {
    let mut target = target().with_indices();
    execute(commands, &DisplayLists::default(), &mut Pipeline::default(), &mut target)
        .expect("drawn");
    target
}

fn count_index(target: &Framebuffer, index: u8) -> usize {
    target.index.iter().flat_map(|p| p.data()).filter(|i| **i == index).count()
}

/// Checks that the highest bit of the indices serves as a layer: its drawing is erased without redrawing the picture
/// below.
#[test]
fn an_index_mask_keeps_an_overlay_apart() {
    let masked = |index| {
        let write_mask = WriteMask { index, ..WriteMask::default() };
        Command::Fragments(FragmentState { write_mask, depth: None, ..Default::default() })
    };
    let clear = |index| Command::Clear { color: None, depth: None, stencil: None, index };
    let picture = [clear(Some(2)), Command::Index(3.0), square(0.5, 0.0)];
    let overlay = [masked(0x80), Command::Index(128.0), square(0.25, 0.0)];
    let with = indexed(&[picture.to_vec(), overlay.to_vec()].concat());
    assert_eq!([2, 3, 131].map(|i| count_index(&with, i)), [1200, 300, 100]);
    let erased = indexed(&[picture.to_vec(), overlay.to_vec(), vec![clear(Some(0))]].concat());
    assert_eq!(erased, indexed(&picture));
}

/// Checks that a frame drawn twice with exclusive or disappears.
#[test]
fn a_logic_operation_on_indices_undoes_itself() {
    let xor = FragmentState { logic_op: Some(LogicOp::Xor), depth: None, ..Default::default() };
    let rubber = [Command::Fragments(xor), Command::Index(0xff as f32), square(0.6, 0.0)];
    let picture = [Command::Index(7.0), square(0.5, 0.0)];
    let once = indexed(&[&picture[..], &rubber].concat());
    assert_eq!([0xf8, 0xff, 7].map(|i| count_index(&once, i)), [400, 24 * 24 - 400, 0]);
    assert_eq!(indexed(&[&picture[..], &rubber, &rubber[1..]].concat()), indexed(&picture));
}

/// Checks that indices are interpolated in space, not on the screen: on a receding floor each of the ramp's entries
/// extends over its own depth.
#[test]
fn indices_are_interpolated_in_perspective() {
    let corner = |x: f64, z: f64, index| CornerVertex {
        index: Some(index),
        ..CornerVertex::from(DVec3::new(x, -0.5, z))
    };
    let (near, far) = (-1.0, -9.0);
    let floor = vec![
        corner(-9., near, 10.),
        corner(9., near, 10.),
        corner(9., far, 90.),
        corner(-9., far, 90.),
    ];
    let eye = Camera {
        eye: DVec3::ZERO,
        target: DVec3::NEG_Z,
        up: DVec3::Y,
        projection: Projection::Perspective { fov_y: std::f64::consts::FRAC_PI_2 },
        near: 0.1,
        far: 20.0,
    };
    let target = indexed(&[
        Command::LoadProjection(eye.clip_from_view(1.0)),
        Command::Draw(Primitive::Polygon, floor),
    ]);
    let plane = target.index.expect("indices");
    let mut seen = 0;
    for row in 20..SIDE {
        // The ray through the pixel's centre meets the floor at this distance.
        let depth = 0.5 / ((f64::from(row) + 0.5) / 20.0 - 1.0);
        if (1.0..9.0).contains(&depth) {
            let expected = 10.0 * depth;
            let found = f64::from(plane.get(20, row).expect("pixel"));
            // Rounded to the nearest, and the corners to 1/256 of a pixel.
            assert!((found - expected).abs() <= 0.51, "{row}: {found} {expected}");
            seen += 1;
        }
    }
    assert!(seen > 8, "{seen}");
}

#[test]
fn indices_of_lines_and_points_are_theirs() {
    let at = |x: f64, index| CornerVertex {
        index: Some(index),
        ..CornerVertex::from(DVec3::new(x, 0.0, 0.0))
    };
    let target = indexed(&[
        Command::Draw(Primitive::Lines, vec![at(-1.0, 100.0), at(1.0, 139.0)]),
        Command::Index(9.0),
        Command::Draw(Primitive::Points, vec![DVec3::new(0.0, 0.9, 0.0).into()]),
    ]);
    let plane = target.index.as_ref().expect("indices");
    assert_eq!([0, 20, 39].map(|x| plane.get(x, 20)), [Some(100), Some(120), Some(139)]);
    assert_eq!(count_index(&target, 9), 1);
    // Without a palette nothing is visible; a palette shows all of them.
    assert_eq!(target.color, self::target().color);
    let mut shown = target.clone();
    Palette::default().resolve(&mut shown);
    assert_eq!(shown.color.get(39, 20), Some([139, 139, 139, 255]));
}
