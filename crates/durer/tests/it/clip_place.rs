//! Five places in the pipeline to clip, one picture.

use durer::clip::outcode::{ClipDepths, Outcode};
use durer::clip::place::{ClipPlace, EYE, NdcVertex, clip};
use durer::clip::volume::Step;
use durer::math::{DMat4, DVec2, DVec3, DVec4};
use durer::raster::interpolate::{ScreenPlane, doubled_area};
use durer::raster::triangle::{Options, SnappedTriangle, TriangleRasterizer};
use durer::scene::{Camera, Projection};
use durer::trace::{NoTrace, Recorder};
use durer::view::window::PixelRect;
use proptest::prelude::*;
use std::collections::BTreeSet;

const SIDE: i32 = 64;

fn camera(perspective: bool) -> DMat4 {
    let projection = if perspective {
        Projection::Perspective { fov_y: 1.2 }
    } else {
        Projection::Orthographic { height: 4.0 }
    };
    let camera = Camera {
        eye: DVec3::new(0.3, 0.2, 3.0),
        target: DVec3::new(0.1, 0.0, 0.0),
        up: DVec3::Y,
        projection,
        near: 0.5,
        far: 6.0,
    };
    camera.clip_from_view(1.0) * camera.view_from_world()
}

fn on_screen<A>(v: &NdcVertex<A>) -> DVec2 {
    (DVec2::new(v.position.x, -v.position.y) + DVec2::ONE) * f64::from(SIDE) * 0.5
}

/// Returns the pixels of a convex polygon, drawn as a fan.
fn pixels(polygon: &[DVec2]) -> BTreeSet<(i32, i32)> {
    let options = Options { clip: PixelRect::new(0, 0, SIDE, SIDE).unwrap() };
    let mut lit = BTreeSet::new();
    for k in 2..polygon.len() {
        let corners = [polygon[0], polygon[k - 1], polygon[k]];
        let triangle = SnappedTriangle::snap(corners).expect("on the screen");
        TriangleRasterizer::EdgeWalking.rasterize(&triangle, &options, |s| {
            lit.extend((s.x0..s.x1).map(|x| (x, s.y)));
        });
    }
    lit
}

/// Returns the pixels of a convex polygon whose depth is in the volume; the rasterizer's window is the scissor
/// rectangle.
fn pixels_by_depth(ring: &[NdcVertex<DVec3>]) -> BTreeSet<(i32, i32)> {
    let corners: Vec<DVec2> = ring.iter().map(on_screen).collect();
    let mut lit = pixels(&corners);
    // The largest triangle of the fan has the plane with the least rounding.
    let fan = |k: usize| [0, k - 1, k];
    let area = |k: usize| doubled_area(fan(k).map(|i| corners[i])).abs();
    let Some(k) = (2..ring.len()).max_by(|&a, &b| area(a).total_cmp(&area(b))) else { return lit };
    let (points, z) = (fan(k).map(|i| corners[i]), fan(k).map(|i| ring[i].position.z));
    let Some(depth) = ScreenPlane::through(points, z) else { return lit };
    lit.retain(|&(x, y)| {
        let z = depth.at(DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5));
        (-1.0..=1.0).contains(&z)
    });
    lit
}

/// Returns the distance of a point from the outline, in pixels.
fn from_outline(polygon: &[DVec2], p: DVec2) -> f64 {
    (0..polygon.len())
        .map(|k| {
            let (a, b) = (polygon[k], polygon[(k + 1) % polygon.len()]);
            let d = b - a;
            let t = ((p - a).dot(d) / d.length_squared().max(1e-300)).clamp(0.0, 1.0);
            (p - (a + d * t)).length()
        })
        .fold(f64::INFINITY, f64::min)
}

fn point() -> impl Strategy<Value = DVec3> {
    // Around the volume; the eye is at z = 3, so a third lies behind it.
    let near = [-3.0..3.0f64, -3.0..3.0, -4.0..6.0];
    let far = [-40.0..40.0f64, -40.0..40.0, -60.0..40.0];
    prop_oneof![4 => near.prop_map(DVec3::from), 1 => far.prop_map(DVec3::from)]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(10_000))]

    /// Checks the effect of snapping: a vertex moves by at most one step of the grid, 1/256 pixel on each axis, and its
    /// two edges with it; no other pixel may differ.
    #[test]
    fn all_places_light_the_same_pixels(t in [point(), point(), point()], perspective: bool) {
        let matrix = camera(perspective);
        let polygon = t.map(|p| (p, p));
        let depth = ClipDepths::NegativeOneToOne;
        let clipped: Vec<Vec<NdcVertex<DVec3>>> = ClipPlace::ALL
            .iter()
            .map(|&place| clip(place, &polygon, &matrix, depth, &mut NoTrace))
            .collect();
        for (place, ring) in ClipPlace::ALL.iter().zip(&clipped) {
            for v in ring {
                let inside = v.position.abs().max_element() <= 1.0 + 1e-9;
                prop_assert!(inside || *place == ClipPlace::PerPixel, "{:?}", v);
                // Attributes are linear in space: the vertex carries its world point.
                let seen = matrix * v.attributes.extend(1.0);
                prop_assert!((seen.truncate() / seen.w - v.position).length() < 1e-6, "{:?}", v);
                prop_assert!((1.0 / seen.w - v.inv_w).abs() < 1e-6 * v.inv_w);
            }
        }
        let mut outlines: Vec<Vec<DVec2>> =
            clipped.iter().map(|r| r.iter().map(on_screen).collect()).collect();
        let mut pictures: Vec<_> = outlines.iter().map(|o| pixels(o)).collect();
        if let Some(k) = ClipPlace::ALL.iter().position(|p| *p == ClipPlace::PerPixel) {
            pictures[k] = pixels_by_depth(&clipped[k]);
            // Its visible part has the same outline as the clipped ones.
            if !outlines[0].is_empty() {
                outlines[k] = outlines[0].clone();
            }
        }
        for k in 1..ClipPlace::ALL.len() {
            for &(x, y) in pictures[0].symmetric_difference(&pictures[k]) {
                let center = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
                let owner = if pictures[0].contains(&(x, y)) { 0 } else { k };
                let distance = from_outline(&outlines[owner], center);
                prop_assert!(distance <= std::f64::consts::SQRT_2 / 256.0,
                    "{} pixel {x},{y} is {distance} from the outline", ClipPlace::ALL[k]);
            }
        }
    }

    #[test]
    fn tracing_changes_no_output(t in [point(), point(), point()], perspective: bool) {
        let polygon = t.map(|p| (p, ()));
        for &place in ClipPlace::ALL {
            for depth in [ClipDepths::NegativeOneToOne, ClipDepths::ZeroToOne] {
                let matrix = camera(perspective);
                let mut steps = Recorder::default();
                let traced = clip(place, &polygon, &matrix, depth, &mut steps);
                prop_assert_eq!(&traced, &clip(place, &polygon, &matrix, depth, &mut NoTrace));
            }
        }
    }
}

/// Returns the ring rebuilt from the steps; after the border at the eye it is divided by w.
fn replay(input: Vec<DVec4>, steps: &[Step]) -> Vec<DVec4> {
    let divided = |ring: Vec<DVec4>| ring.into_iter().map(|p| (p.truncate() / p.w).extend(1.0));
    let (mut ring, mut next, mut border) = (input, Vec::new(), None);
    let finish = |border: Option<Outcode>, ring: Vec<DVec4>, next: Vec<DVec4>| match border {
        None => ring,
        Some(EYE) => divided(next).collect(),
        Some(_) => next,
    };
    for step in steps {
        match *step {
            Step::Border(b) => {
                ring = finish(border, ring, std::mem::take(&mut next));
                border = Some(b);
            }
            Step::Keep { vertex } => next.push(ring[vertex]),
            Step::Cut { position, .. } => next.push(position),
            Step::Rejected => return Vec::new(),
            Step::Code { .. } | Step::Accepted | Step::Dropped => {}
        }
    }
    finish(border, ring, next)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(10_000))]

    #[test]
    fn replaying_the_steps_rebuilds_the_output(t in [point(), point(), point()], perspective: bool) {
        let matrix = camera(perspective);
        for &place in ClipPlace::ALL {
            let mut steps = Recorder::default();
            let depth = ClipDepths::NegativeOneToOne;
            let found = clip(place, &t.map(|p| (p, ())), &matrix, depth, &mut steps);
            let input = t.map(|p| p.extend(1.0));
            let replayed: Vec<DVec3> = match place {
                ClipPlace::World => {
                    replay(input.to_vec(), steps.steps()).iter().map(|p| matrix * *p).collect()
                }
                _ => replay(input.map(|p| matrix * p).to_vec(), steps.steps()),
            }
            .iter()
            .map(|p: &DVec4| p.truncate() / p.w)
            .collect();
            let replayed = if replayed.len() < 3 { Vec::new() } else { replayed };
            prop_assert_eq!(replayed, found.iter().map(|v| v.position).collect::<Vec<_>>());
        }
    }
}

/// Counts how rarely the five places differ: the law above allows differences near an outline.
#[test]
fn differing_pixels_are_rare() {
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    let mut random = move || {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    let (mut lit, mut differ) = (0, 0);
    for _ in 0..2000 {
        let t = [(); 3].map(|()| {
            (DVec3::new(random() * 8.0 - 4.0, random() * 8.0 - 4.0, random() * 12.0 - 6.0), ())
        });
        let [world, clip_space, divided] = [0, 1, 2].map(|k| {
            let depth = ClipDepths::NegativeOneToOne;
            let ring = clip(ClipPlace::ALL[k], &t, &camera(true), depth, &mut NoTrace);
            pixels(&ring.iter().map(on_screen).collect::<Vec<_>>())
        });
        lit += clip_space.len();
        differ += world.symmetric_difference(&clip_space).count();
        differ += divided.symmetric_difference(&clip_space).count();
    }
    assert!(lit > 200_000, "{lit}");
    assert!(differ * 10_000 <= lit, "{differ} of {lit} pixels differ");
    println!("{differ} of {lit} pixels differ");
}

#[test]
fn a_triangle_that_spans_the_eye_plane_is_cut_everywhere() {
    // From far before the eye to far behind it, under its feet.
    let floor = [(-9.0, -0.5, -4.0), (9.0, -0.5, -4.0), (0.0, -0.5, 30.0)];
    let floor = floor.map(|p| (DVec3::from(p), ()));
    for &place in ClipPlace::ALL {
        let ring = clip(place, &floor, &camera(true), ClipDepths::NegativeOneToOne, &mut NoTrace);
        let lit = pixels(&ring.iter().map(on_screen).collect::<Vec<_>>());
        assert!(lit.contains(&(SIDE / 2, SIDE - 1)) && !lit.contains(&(SIDE / 2, 0)), "{place}");
    }
}

#[test]
fn odd_matrices_and_points_do_no_harm() {
    let triangle = [DVec3::ZERO, DVec3::X, DVec3::Y].map(|p| (p, ()));
    let nan = [DVec3::NAN, DVec3::X, DVec3::Y].map(|p| (p, ()));
    for &place in ClipPlace::ALL {
        for matrix in
            [DMat4::ZERO, DMat4::IDENTITY * f64::NAN, DMat4::from_cols_array(&[1e300; 16])]
        {
            for depth in [ClipDepths::NegativeOneToOne, ClipDepths::ZeroToOne] {
                let ring = clip(place, &triangle, &matrix, depth, &mut NoTrace);
                assert!(ring.iter().all(|v| v.position.is_finite()), "{place} {ring:?}");
            }
        }
        let depth = ClipDepths::NegativeOneToOne;
        assert!(clip(place, &nan, &DMat4::IDENTITY, depth, &mut NoTrace).is_empty());
        assert!(clip::<()>(place, &[], &DMat4::IDENTITY, depth, &mut NoTrace).is_empty());
    }
}
