//! Worked examples of further pages of `docs/algorithms`: what a reader computes by hand is what the steps show.

use super::{near, p};
use durer::clip::simplify::{douglas_peucker, visvalingam};
use durer::curve::b_spline::BSpline;
use durer::curve::{bezier, evaluator, knot_insertion, segments_for};
use durer::fragment::fog::Fog;
use durer::math::{DMat4, DVec2, DVec3, IVec2, Plane, Rect, Vec3};
use durer::raster::interpolate::{barycentric_2d, doubled_area, perspective_correct};
use durer::raster::line::pattern;
use durer::scene::Aabb;
use durer::shade::shadow::{self, ShadowMap};
use durer::target::Pixels;
use durer::trace::{NoTrace, PseudocodeLine, Recorder};
use durer::view::cull::{self, Containment, ConvexVolume, FaceSide as Turn};
use durer::view::interior_point::{self, interior_point};
use durer::view::label::{Obstacle, Placer, Step as Label};
use durer::visibility::back_face::{self, Eye};
use durer::visibility::object::orientation;
use durer::visibility::polygons::{Face, Screen, regions, watkins, z_buffer};
use durer::work::Work;

/// Page `simplification`: distances for Douglas and Peucker, areas for Visvalingam.
#[test]
fn points_are_kept_by_distance_and_left_out_by_area() {
    use douglas_peucker::Step;
    let line = [p(0.0, 0.0), p(1.0, 3.0), p(2.0, 1.0), p(4.0, 0.0)];
    let decided = |tolerance: f64| {
        let mut steps = Recorder::default();
        let options = douglas_peucker::Options { tolerance };
        let kept = douglas_peucker::simplify(&line, &options, &mut steps).unwrap();
        let parts = steps.steps().iter().filter(|s| s.line() != 1);
        let parts = parts.map(|s| match *s {
            Step::Kept { point, part, distance } => (Some(point), part, distance),
            Step::Straight { part, distance } => (None, part, distance),
        });
        (kept, parts.filter(|(_, _, distance)| *distance > 0.0).collect::<Vec<_>>())
    };
    let third = 3.0 / 18.0_f64.sqrt();
    let (kept, steps) = decided(0.5);
    assert_eq!(kept, [0, 1, 2, 3]);
    assert_eq!((steps[0], steps[1].0, steps[1].1), ((Some(1), [0, 3], 3.0), Some(2), [1, 3]));
    assert!(near(steps[1].2, third) && (third - 0.71).abs() < 5e-3);
    let (kept, steps) = decided(1.0);
    assert_eq!((kept, steps[1].0, steps[1].1), (vec![0, 1, 3], None, [1, 3]));
    let mut steps = Recorder::default();
    let options = visvalingam::Options { tolerance: 100.0 };
    visvalingam::simplify(&line, &options, &mut steps).unwrap();
    let removed = steps.steps().iter().filter_map(|s| match *s {
        visvalingam::Step::Removed { point, side } => Some((point, side)),
        visvalingam::Step::Begin { .. } => None,
    });
    let removed: Vec<_> = removed.collect();
    assert_eq!(removed[0].0, 2);
    assert!(near(removed[0].1, 1.5_f64.sqrt()), "{removed:?}");
}

/// Page `curves`: a knot inserted by Boehm, the triangle of de Casteljau, and the number of chords.
#[test]
fn curves_have_the_numbers_of_their_page() {
    let knots = vec![0.0, 0.0, 0.0, 0.5, 1.0, 1.0, 1.0];
    let curve = BSpline::new(2, vec![0.0, 2.0, 3.0, 7.0], knots).unwrap();
    let mut steps = Recorder::default();
    let found = knot_insertion::insert(&curve, 0.25, &mut steps).unwrap();
    assert_eq!(found.control(), [0.0, 1.0, 2.25, 3.0, 7.0]);
    let shares: Vec<_> = steps.steps().iter().map(|s| (s.index, s.share, s.point)).collect();
    assert_eq!(shares, [(1, 0.5, 1.0), (2, 0.25, 2.25)]);

    let control = [(0.0, 0.0), (0.0, 4.0), (4.0, 4.0), (4.0, 0.0)].map(DVec2::from);
    let mut steps = Recorder::default();
    assert_eq!(bezier::de_casteljau(&control, 0.5, &mut steps), Some(p(2.0, 3.0)));
    let levels: Vec<_> = steps.steps().iter().map(|s| (s.level, s.point)).collect();
    let first = [(1, p(0.0, 2.0)), (1, p(2.0, 4.0)), (1, p(4.0, 2.0))];
    assert_eq!(levels[..3], first);
    assert_eq!(levels[3..], [(2, p(1.0, 3.0)), (2, p(3.0, 3.0)), (3, p(2.0, 3.0))]);
    let second = [0, 1].map(|i| control[i] - control[i + 1] * 2.0 + control[i + 2]);
    assert_eq!(second, [p(4.0, -4.0), p(-4.0, -4.0)]);
    let largest = second[0].length();
    assert!((largest - 5.66).abs() < 5e-3);
    assert_eq!(segments_for(3, largest, 0.1), 7);

    // Page `display-lists`: a curve of three points, evaluated twice.
    let row = [p(0.0, 0.0), p(1.0, 2.0), p(2.0, 0.0)];
    let at = |u: f64| evaluator::patch(&[row], [u, 0.0], &mut NoTrace);
    assert_eq!([0.0, 0.5, 1.0].map(at), [p(0.0, 0.0), p(1.0, 1.0), p(2.0, 0.0)].map(Some));
}

/// Page `triangles`: edge functions, their shares, and shares in perspective.
#[test]
fn edge_functions_are_shares_of_twice_the_area() {
    let [a, b, c, q] = [p(0.0, 0.0), p(4.0, 0.0), p(0.0, 4.0), p(1.0, 1.0)];
    let edges = [[a, b], [b, c], [c, a]].map(|[from, to]| doubled_area([from, to, q]));
    assert_eq!(edges, [4.0, 8.0, 4.0]);
    assert_eq!(edges.iter().sum::<f64>(), doubled_area([a, b, c]));
    let shares = barycentric_2d([a, b, c], q).unwrap();
    assert_eq!(shares, [0.5, 0.25, 0.25]);
    let true_shares = perspective_correct(shares, [1.0, 0.5, 0.25]);
    assert!(true_shares.iter().zip([8.0, 2.0, 1.0]).all(|(s, n)| near(*s, n / 11.0)));
}

/// Pages `back-face-removal`, `culling-and-picking` and `orientation`.
#[test]
fn faces_and_boxes_are_tested_by_their_products() {
    let top = [(0.0, 0.0, 1.0), (1.0, 0.0, 1.0), (1.0, 1.0, 1.0), (0.0, 1.0, 1.0)];
    let top = top.map(DVec3::from);
    let bottom = [3, 2, 1, 0].map(|k| top[k] - DVec3::Z);
    let eye = DVec3::new(0.5, 0.5, 3.0);
    let mut steps = Recorder::default();
    let faces = [&top[..], &bottom[..]];
    let kept = back_face::remove(faces, Eye::At(eye), &Default::default(), &mut steps);
    assert_eq!(kept, [0]);
    for (step, (ring, product, turn)) in
        steps.steps().iter().zip([(top, 4.0, Turn::Front), (bottom, -6.0, Turn::Back)])
    {
        let back_face::Step::Tested { area, side, .. } = *step;
        // N is twice the vector area.
        assert_eq!(((area * 2.0).dot(eye - ring[0]), side), (product, turn));
    }

    let volume = ConvexVolume::new(vec![Plane { normal: DVec3::X, distance: 0.0 }]);
    for (x, relation) in [(-1.0, Containment::Crossing), (-3.0, Containment::Outside)] {
        let half = DVec3::new(2.0, 1.0, 1.0);
        let own = Aabb { min: DVec3::X * x - half, max: DVec3::X * x + half };
        let mut steps = Recorder::default();
        assert_eq!(volume.contains_box_traced(&own, &mut steps), relation);
        let expected = cull::Step::Plane { plane: 0, distance: x, reach: 2.0, relation };
        assert_eq!(steps.steps()[0], expected);
    }

    use orientation::Step;
    let [o, x, y, z] = [0, 1, 2, 3];
    let points = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    let faces = [[o, y, x], [o, z, x], [x, y, z], [y, o, z]];
    let mut steps = Recorder::default();
    let found = orientation::orient(&points, &faces, &Default::default(), &mut steps).unwrap();
    assert_eq!(found.turned, [false, true, false, false]);
    assert_eq!((found.pieces[0].inside_out, found.pieces[0].flipped), (false, 1));
    let turned = |s: &Step| matches!(s, Step::Reached { from: 0, face: 1, turned: true, .. });
    assert!(steps.steps().iter().any(turned));
    let volume = steps.steps().iter().find_map(|s| match *s {
        Step::Volume { volume, .. } => Some(volume),
        _ => None,
    });
    assert!(near(volume.unwrap(), 1.0 / 6.0));
}

/// Pages `fog`, `line-patterns` and `shadow-maps`.
#[test]
fn shares_of_light_and_bits_of_patterns() {
    assert_eq!(Fog::Linear { start: 2.0, end: 4.0, least: 0.5 }.left(3.0), 0.75);
    let options = pattern::Options { pattern: 0b0011_0011_0011_0011, ..Default::default() };
    let mut columns = Vec::new();
    let plot = |pixel: IVec2| columns.push(pixel.x);
    pattern::draw(IVec2::ZERO, IVec2::new(7, 0), &options, plot, &mut NoTrace);
    assert_eq!(columns, [0, 1, 4, 5]);
    // Depths 4 and 7 of ten, a point of depth 5, a quarter of the way from the one column to the other.
    let depths = Pixels::from_data(2, 2, vec![0.4, 0.7, 0.4, 0.7]).unwrap();
    let map = ShadowMap::new(&DMat4::IDENTITY, 0.0, false, depths).unwrap();
    let mut steps = Recorder::default();
    let share = map.reach_traced(Vec3::new(0.75, 0.5, 0.5), Vec3::Z, &mut steps);
    assert_eq!(share, Some(0.25));
    let texels = steps.steps().iter().filter_map(|s| match *s {
        shadow::Step::Texel { stored, weight, lit, .. } => Some((stored, weight, lit)),
        _ => None,
    });
    assert_eq!(texels.collect::<Vec<_>>(), [(0.4, 0.75, false), (0.7, 0.25, true)]);
}

/// Page `label-points`: bounds of squares, and four places of a label.
#[test]
fn labels_have_room_by_their_bounds() {
    let square = [p(0.0, 0.0), p(4.0, 0.0), p(4.0, 4.0), p(0.0, 4.0)];
    let mut steps = Recorder::default();
    let options = interior_point::Options { precision: 0.05, ..Default::default() };
    let found = interior_point(&[&square[..]], &options, &mut steps).unwrap();
    assert_eq!((found.point, found.distance), (p(2.0, 2.0), 2.0));
    let squares: Vec<_> = steps.steps().iter().filter(|s| s.half > 0.0).collect();
    assert_eq!((squares[0].center, squares[0].half, squares[0].distance), (p(2.0, 2.0), 2.0, 2.0));
    let bound = |s: &interior_point::Step| s.distance + s.half * 2.0_f64.sqrt();
    assert!((bound(squares[0]) - 4.83).abs() < 5e-3);
    assert!(squares[1..5].iter().all(|s| s.distance == 1.0 && (bound(s) - 2.41).abs() < 5e-3));
    let next = squares.iter().filter(|s| s.half == 0.5).map(|s| bound(s));
    assert!((next.fold(0.0, f64::max) - 2.21).abs() < 5e-3);

    let mut placer = Placer::new(Rect::new(p(0.0, 0.0), p(40.0, 24.0)).unwrap());
    let size = p(8.0, 3.0);
    let places = |at: DVec2| {
        [p(0.0, 0.0), p(0.0, -3.0), p(-8.0, 0.0), p(-8.0, -3.0)]
            .map(|shift| Rect::new(at + shift, at + shift + size).unwrap())
    };
    assert_eq!(placer.place(places(p(10.0, 12.0))), Some(0));
    let mut steps = Recorder::default();
    assert_eq!(placer.place_traced(places(p(13.0, 13.0)), &mut steps), None);
    let taken = Some(Obstacle::Taken(0));
    let refused = |s: &&Label| matches!(s, Label::Candidate { obstacle, .. } if *obstacle == taken);
    assert_eq!(steps.steps().iter().filter(refused).count(), 4);
}

/// Returns a face of four corners, from x₀ to x₁ in one row of pixels, with its depth at both.
fn strip([x0, x1]: [f64; 2], [z0, z1]: [f64; 2]) -> Face {
    let corners = [(x0, 0.0, z0), (x1, 0.0, z1), (x1, 1.0, z1), (x0, 1.0, z0)];
    Face::new(&corners.map(DVec3::from)).unwrap()
}

/// Pages `z-buffer`, `spanning-scan-line` and `visible-regions`: rows of pixels, spans, and areas.
#[test]
fn nearer_faces_take_pixels_spans_and_areas() {
    use watkins::Step;
    let row = |width: u32| Screen { width, height: 1, ..Screen::default() };
    let all = [strip([0.0, 4.0], [0.1, 0.9]), strip([0.0, 4.0], [0.5, 0.5])];
    let mut steps = Recorder::default();
    let items = z_buffer::items(&all, &row(4), &mut steps).unwrap();
    assert_eq!(items.data(), [0, 0, 1, 1]);
    let compared = steps.steps().iter().filter_map(|s| match *s {
        z_buffer::Step::Compare { depth, stored, .. } if stored.is_finite() => {
            Some((depth < stored, (stored * 10.0).round()))
        }
        _ => None,
    });
    let expected = [(false, 2.0), (false, 4.0), (true, 6.0), (true, 8.0)];
    assert_eq!(compared.collect::<Vec<_>>(), expected);

    // A from 2 to 10 at depth 5; B from 4, where it is at 3, to 8, where it is at 7.
    let all = [strip([2.0, 10.0], [5.0, 5.0]), strip([4.0, 8.0], [3.0, 7.0])];
    let mut steps = Recorder::default();
    watkins::items(&all, &row(12), &mut steps).unwrap();
    let mut spans: Vec<(u32, [i32; 2])> = Vec::new();
    for step in steps.steps() {
        if let Step::Span { face, columns, .. } = *step {
            spans.push((face, columns));
        }
    }
    assert_eq!(spans, [(0, [2, 4]), (1, [4, 6]), (0, [6, 8]), (0, [8, 10])]);

    let square = |low: f64, side: f64, z: f64| {
        let corners = [(low, low), (low + side, low), (low + side, low + side), (low, low + side)];
        Face::new(&corners.map(|(x, y)| DVec3::new(x, y, z))).unwrap()
    };
    let all = [square(0.0, 4.0, 2.0), square(1.0, 1.0, 1.0)];
    let mut steps = Recorder::default();
    let work = Work::default();
    let seen = regions::regions(&all, &Default::default(), &work, &mut steps).unwrap();
    let mut areas: Vec<_> = seen.iter().map(|r| (r.face, r.shapes.area())).collect();
    areas.sort_by_key(|(face, _)| *face);
    assert_eq!(areas.iter().map(|(face, _)| *face).collect::<Vec<_>>(), [0, 1]);
    assert!((areas[0].1 - 15.0).abs() < 1e-6 && (areas[1].1 - 1.0).abs() < 1e-6);
    let cut = steps.steps().iter().find_map(|s| match s {
        regions::Step::Cut { face: 0, inside, outside } => Some([inside.area(), outside.area()]),
        _ => None,
    });
    let [inside, outside] = cut.unwrap();
    assert!((inside - 1.0).abs() < 1e-6 && (outside - 15.0).abs() < 1e-6);
}
