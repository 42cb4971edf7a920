//! Roberts' hidden lines of convex bodies: hand-computed numbers, and the same drawing as by quantitative invisibility.

use crate::line_scenes::{Random, Triangle, cuboid, soup, turned_boxes, view};
use durer::Error;
use durer::math::DVec3;
use durer::trace::{NoTrace, Recorder};
use durer::visibility::back_face::Eye;
use durer::visibility::line::hidden_line;
use durer::visibility::line::roberts::{self, ConvexBody, Options, Step, VisibleLine, draw};
use durer::work::Work;

const ISO: DVec3 = DVec3::new(1.0, -1.7, 0.9);

fn bodies(triangles: &[Triangle]) -> Vec<ConvexBody> {
    let faces: Vec<Vec<DVec3>> = triangles.iter().map(|t| t.to_vec()).collect();
    ConvexBody::several(&faces).unwrap()
}

fn lines(bodies: &[ConvexBody], eye: Eye) -> Vec<VisibleLine> {
    let mut steps = Recorder::default();
    let lines = draw(bodies, eye, &Options::default(), &Work::default(), &mut steps).unwrap();
    assert_eq!(
        draw(bodies, eye, &Options::default(), &Work::default(), &mut NoTrace),
        Ok(lines.clone())
    );
    assert_eq!(roberts::replay(steps.steps()), lines);
    lines
}

/// Returns the visible length in a plane: across the direction, or at distance 1 from the eye.
fn length(lines: &[VisibleLine], eye: Eye, to_eye: DVec3) -> f64 {
    let n = to_eye.normalize();
    let place = |p: DVec3| match eye {
        Eye::At(at) => (p - at) / (at - p).dot(n),
        Eye::Along(_) => p - n * p.dot(n),
    };
    lines.iter().flat_map(VisibleLine::parts).map(|[p, q]| place(p).distance(place(q))).sum()
}

#[test]
fn pictures_are_those_of_quantitative_invisibility() {
    let mut random = Random(4);
    let middle = DVec3::splat(3.5);
    let mut scales = Vec::new();
    for round in 0..12 {
        let triangles = turned_boxes(2 + round / 3, &mut random);
        let bodies = bodies(&triangles);
        for perspective in [false, true] {
            let view = view(middle, ISO, 12.0, perspective);
            let eye = Eye::of(view.camera());
            let lines = lines(&bodies, eye);
            check_by_rays(&bodies, &lines, eye);
            let found = length(&lines, eye, ISO);
            // All lines, however short.
            let options = hidden_line::Options { tolerance: 0.0, stubs: 0.0, ..Default::default() };
            let drawing = hidden_line::draw(&soup(&triangles), &view, &options, &mut NoTrace);
            let drawing = drawing.unwrap();
            let expected = drawing.length(|line| line.is_visible());
            if perspective {
                // The drawing plane is at another, constant distance.
                scales.push(expected / found);
            } else {
                let off = (found - expected).abs() / expected;
                assert!(off < 1e-5, "round {round}: {found} {expected}");
            }
        }
    }
    let off = scales.iter().map(|s| (s / scales[0] - 1.0).abs()).fold(0.0, f64::max);
    assert!(off < 1e-5, "{scales:?}");
}

/// Compares points of lines with rays to the eye, except close to an edge of a body.
fn check_by_rays(bodies: &[ConvexBody], lines: &[VisibleLine], eye: Eye) {
    for line in lines {
        for k in 0..40 {
            let t = (f64::from(k) + 0.37) / 40.0;
            let p = line.ends[0].lerp(line.ends[1], t);
            let to_eye = match eye {
                Eye::At(at) => at - p,
                Eye::Along(direction) => -direction,
            };
            // Length of the ray inside a body; less than a thousandth is too close to decide.
            let inside = |body: &ConvexBody| {
                let (mut from, mut to) =
                    (0.0_f64, if matches!(eye, Eye::At(_)) { 1.0 } else { 1e3_f64 });
                for plane in body.planes() {
                    let (at, rise) = (plane.evaluate(p), plane.normal.dot(to_eye));
                    if rise > 0.0 {
                        from = from.max(-at / rise);
                    } else if rise < 0.0 {
                        to = to.min(-at / rise);
                    } else if at <= 0.0 {
                        return -1.0;
                    }
                }
                (to - from) * to_eye.length()
            };
            let others = bodies.iter().enumerate().filter(|(n, _)| !line.bodies.contains(n));
            let depths: Vec<f64> = others.map(|(_, body)| inside(body)).collect();
            if depths.iter().any(|depth| depth.abs() < 1e-3) {
                continue;
            }
            let is_hidden = depths.iter().any(|depth| *depth > 0.0);
            let is_seen = line.visible.iter().any(|[from, to]| (*from..=*to).contains(&t));
            assert_eq!(is_seen, !is_hidden, "{t} of {line:?}");
        }
    }
}

#[test]
fn a_box_hides_the_middle_of_an_edge() {
    // Seen along −z: the plate before the bar hides x from 2 to 4.
    let mut triangles = cuboid([0.0, 1.0, 0.0], [10.0, 2.0, 1.0]);
    triangles.extend(cuboid([2.0, 0.0, 5.0], [4.0, 3.0, 6.0]));
    let bodies = bodies(&triangles);
    let mut steps = Recorder::default();
    let eye = Eye::Along(DVec3::NEG_Z);
    let found = draw(&bodies, eye, &Options::default(), &Work::default(), &mut steps).unwrap();
    // Each front face has four edges; the others face away or are seen edge-on.
    assert_eq!(found.len(), 8);
    let long: Vec<_> = found.iter().filter(|line| line.visible.len() == 2).collect();
    assert_eq!(long.len(), 2);
    for line in long {
        let mut seen: Vec<[f64; 2]> = line.parts().map(|part| part.map(|p| p.x)).collect();
        seen.iter_mut().for_each(|part| part.sort_by(f64::total_cmp));
        seen.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let expected = [[0.0, 2.0], [4.0, 10.0]];
        let off = seen.iter().flatten().zip(expected.iter().flatten()).map(|(a, b)| (a - b).abs());
        assert!(off.fold(0.0, f64::max) < 1e-12, "{seen:?}");
    }
    let hidden: Vec<_> = steps
        .steps()
        .iter()
        .filter_map(|step| {
            if let Step::Hidden { body, part, .. } = step { Some((*body, *part)) } else { None }
        })
        .collect();
    assert!(hidden.iter().all(|(body, _)| *body == 1));
    assert_eq!(hidden.len(), 2);
    // No edge of the plate is compared by inequalities: the bar is behind its planes.
    let compared = |step: &&Step| matches!(step, Step::Compare { body: 0, .. });
    assert_eq!(steps.steps().iter().filter(compared).count(), 0);
}

#[test]
fn what_touches_is_seen() {
    // A small box on a large one, flush with its front, and one beside it.
    let mut triangles = cuboid([0.0, 0.0, 0.0], [4.0, 4.0, 2.0]);
    triangles.extend(cuboid([1.0, 0.0, 2.0], [3.0, 2.0, 4.0]));
    triangles.extend(cuboid([4.0, 1.0, 0.0], [5.0, 3.0, 1.0]));
    let bodies = bodies(&triangles);
    let eye = Eye::Along(-ISO);
    let found =
        draw(&bodies, eye, &Options { junctions: false }, &Work::default(), &mut NoTrace).unwrap();
    // The foot of the small box on the large one.
    let foot = |line: &&VisibleLine| line.ends.iter().all(|p| p.z == 2.0) && line.bodies == [1, 1];
    let seen = found.iter().filter(foot).filter(|line| line.visible == [[0.0, 1.0]]);
    assert_eq!(seen.count(), 2);
    // It hides the part of the rear edge behind it.
    let back = |line: &&VisibleLine| line.ends.iter().all(|p| p.y == 4.0 && p.z == 2.0);
    let back = found.iter().find(back).unwrap();
    assert_ne!(back.visible, [[0.0, 1.0]]);
}

#[test]
fn a_bar_through_a_box_has_two_rings_of_junctions() {
    let mut triangles = cuboid([-3.0, -1.0, -1.0], [3.0, 1.0, 1.0]);
    triangles.extend(cuboid([-0.5, -2.0, -0.5], [0.5, 2.0, 0.5]));
    let bodies = bodies(&triangles);
    let eye = Eye::Along(-ISO);
    let junctions = |junctions| {
        let lines =
            draw(&bodies, eye, &Options { junctions }, &Work::default(), &mut NoTrace).unwrap();
        lines.into_iter().filter(|line| line.bodies[0] != line.bodies[1]).collect::<Vec<_>>()
    };
    assert_eq!(junctions(false), []);
    // The bar emerges towards the eye through one face; two of the bar's visible faces meet two edges of it.
    let found = junctions(true);
    assert!(found.iter().all(|line| line.ends.iter().all(|p| p.y == -1.0)), "{found:?}");
    assert_eq!(found.len(), 2);
}

#[test]
fn bodies_must_be_closed_and_convex() {
    let faces = |triangles: &[Triangle]| -> Vec<Vec<DVec3>> {
        triangles.iter().map(|t| t.to_vec()).collect()
    };
    let cube = faces(&cuboid([0.0; 3], [1.0; 3]));
    assert!(ConvexBody::new(&cube).is_ok());
    let reported = |faces: &[Vec<DVec3>]| ConvexBody::new(faces).unwrap_err().to_string();
    assert!(reported(&cube[1..]).contains("closed"));
    assert!(reported(&cube[..2]).contains("volume"));
    assert!(reported(&[]).contains("closed"));
    let mut dented = cube.clone();
    let inside = DVec3::splat(0.4);
    dented.iter_mut().flatten().filter(|p| **p == DVec3::ONE).for_each(|p| *p = inside);
    assert!(reported(&dented).contains("convex"));
    let mut wrong = cube;
    wrong[0][0].x = f64::NAN;
    assert!(ConvexBody::several(&wrong).is_err());
    // Inside out, or with faces in any direction, the body is the same.
    let turned: Vec<Vec<DVec3>> = faces(&cuboid([0.0; 3], [1.0; 3]))
        .into_iter()
        .map(|f| f.into_iter().rev().collect())
        .collect();
    let body = ConvexBody::new(&turned).unwrap();
    // The two triangles of a side have one plane, and their common edge is not an edge of the body.
    assert_eq!((body.planes().len(), body.edges().len(), body.corners().len()), (6, 12, 8));
    assert_eq!(ConvexBody::several(&[]).unwrap(), []);
}

#[test]
fn lines_are_charged_to_the_work_that_can_be_stopped() {
    let bodies =
        bodies(&[cuboid([0.0; 3], [1.0; 3]), cuboid([3.0, 0.0, 0.0], [4.0, 1.0, 1.0])].concat());
    let found = |work: &Work| {
        let eye = Eye::Along(-ISO);
        draw(&bodies, eye, &Options::default(), work, &mut NoTrace).map(|lines| lines.len())
    };
    let work = Work::with_budget(1 << 20, "the budget");
    assert_eq!((found(&work), work.used()), (Ok(18), 0));
    let refused = found(&Work::with_budget(1000, "the budget"));
    let Err(Error::Memory { stage, .. }) = refused else { panic!("{refused:?}") };
    assert_eq!(stage, "lines of bodies");
    let stopped = Work::stoppable();
    stopped.stop(Error::Cancelled);
    assert_eq!(found(&stopped), Err(Error::Cancelled));
}
