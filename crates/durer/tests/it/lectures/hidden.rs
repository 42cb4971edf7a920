//! Hidden lines and surfaces.

use super::p;
use durer::math::{DVec2, DVec3};
use durer::trace::{NoTrace, Recorder};
use durer::view::cull::{FaceSide, face_along, newell_area};
use durer::visibility::line::horizon_curves::{
    ColumnCurve, HorizonSide, Options, Step, VisiblePiece, draw, replay,
};
use durer::visibility::object::orientation::{self, Outward, orient};

fn curves(all: &[(usize, &[f64])]) -> Vec<ColumnCurve> {
    all.iter()
        .map(|(first, heights)| ColumnCurve { first: *first, heights: heights.to_vec() })
        .collect()
}

#[test]
fn the_far_curve_crosses_the_near_one_at_a_half_and_at_one_and_a_half() {
    let all = curves(&[(0, &[0.0, 2.0, 0.0]), (0, &[1.0, 1.0, 1.0])]);
    let mut steps = Recorder::default();
    let pieces = draw(&all, &Options::columns(3), &mut steps).unwrap();
    let crossings: Vec<DVec2> = steps
        .steps()
        .iter()
        .filter_map(|s| if let Step::Crossing { at, .. } = *s { Some(at) } else { None })
        .collect();
    assert_eq!(crossings, [p(0.5, 1.0), p(1.5, 1.0)]);
    let far: Vec<_> = pieces.iter().filter(|q| q.curve == 1).map(|q| q.seen).collect();
    assert_eq!(
        far,
        [HorizonSide::Above, HorizonSide::Below, HorizonSide::Below, HorizonSide::Above]
    );
    assert_eq!(replay(steps.steps()), pieces);
    // Both horizon arrays after the two curves.
    let mut horizons = [[0.0; 2]; 3];
    for step in steps.steps() {
        if let Step::Horizon { column, horizons: new } = *step {
            horizons[column] = new;
        }
    }
    assert_eq!(horizons, [[0.0, 1.0], [1.0, 2.0], [0.0, 1.0]]);
}

#[test]
fn what_lies_between_the_horizons_is_hidden() {
    // A ridge, a valley, and a curve that passes behind both.
    let all = curves(&[(0, &[3.0, 3.0, 3.0]), (0, &[0.0, 0.0, 0.0]), (0, &[2.0, 4.0, -1.0])]);
    let pieces = draw(&all, &Options::columns(3), &mut NoTrace).unwrap();
    let last: Vec<VisiblePiece> = pieces.into_iter().filter(|q| q.curve == 2).collect();
    let ends: Vec<_> = last.iter().map(|q| (q.ends, q.seen)).collect();
    let expected = [
        ([p(0.5, 3.0), p(1.0, 4.0)], HorizonSide::Above),
        ([p(1.0, 4.0), p(1.2, 3.0)], HorizonSide::Above),
        ([p(1.8, 0.0), p(2.0, -1.0)], HorizonSide::Below),
    ];
    assert_eq!(ends.len(), 3);
    for ((found, seen), (points, wanted)) in ends.iter().zip(expected) {
        assert_eq!(*seen, wanted);
        let apart = found.iter().zip(points).map(|(a, b)| a.distance(b));
        assert!(apart.fold(0.0, f64::max) < 1e-12, "{found:?}");
    }
}

#[test]
fn mirrored_curves_give_mirrored_pieces() {
    let mut random = crate::raster_coverage::Random(7);
    let all: Vec<ColumnCurve> = (0..9)
        .map(|_| ColumnCurve {
            first: 0,
            heights: (0..20).map(|_| random.next().round() + random.next()).collect(),
        })
        .collect();
    let mut mirrored = all.clone();
    mirrored.iter_mut().for_each(|curve| curve.heights.reverse());
    let pieces =
        |curves: &[ColumnCurve]| draw(curves, &Options::columns(20), &mut NoTrace).unwrap();
    let (there, mut back) = (pieces(&all), pieces(&mirrored));
    let turned = |q: DVec2| p(19.0 - q.x, q.y);
    back.iter_mut().for_each(|q| q.ends = [turned(q.ends[1]), turned(q.ends[0])]);
    back.sort_by(|a, b| a.curve.cmp(&b.curve).then(a.ends[0].x.total_cmp(&b.ends[0].x)));
    assert_eq!(there.len(), back.len());
    for (a, b) in there.iter().zip(&back) {
        assert_eq!((a.curve, a.seen), (b.curve, b.seen));
        assert!(a.ends.iter().zip(b.ends).all(|(a, b)| a.distance(b) < 1e-9));
    }
}

#[test]
fn gaps_at_the_ends_are_filled() {
    // Two adjacent bands, from y = 0 to 4; column 3 is between them.
    let (low, high) = ([0.0; 3], [4.0; 3]);
    let all = curves(&[(4, &low), (4, &high), (0, &low), (0, &high), (1, &[2.0, 2.0, 2.0])]);
    let seen = |fill_ends| {
        let options = Options { fill_ends, ..Options::columns(8) };
        let pieces = draw(&all, &options, &mut NoTrace).unwrap();
        pieces.iter().filter(|q| q.curve == 4).count()
    };
    assert_eq!([seen(true), seen(false)], [0, 1]);
    let bad = curves(&[(0, &[0.0, f64::NAN])]);
    assert!(draw(&bad, &Options::columns(3), &mut NoTrace).is_err());
    assert!(draw(&all, &Options::columns(0), &mut NoTrace).unwrap().is_empty());
    let far = curves(&[(usize::MAX, &[1.0, 2.0])]);
    assert!(draw(&far, &Options::columns(3), &mut NoTrace).unwrap().is_empty());
}

#[test]
fn newells_sums_are_the_normal_and_its_length_the_area() {
    let ring =
        [(0.0, 0.0, 0.0), (4.0, 0.0, 2.0), (4.0, 3.0, 2.0), (0.0, 3.0, 0.0)].map(DVec3::from);
    let sums = |u: fn(DVec3) -> f64, v: fn(DVec3) -> f64| -> f64 {
        let next = ring.iter().cycle().skip(1);
        ring.iter().zip(next).map(|(a, b)| (u(*a) - u(*b)) * (v(*a) + v(*b))).sum()
    };
    // Nx = Σ (y_i − y_j)(z_i + z_j), and cyclically: twice the vector area.
    let n = DVec3::new(sums(|c| c.y, |c| c.z), sums(|c| c.z, |c| c.x), sums(|c| c.x, |c| c.y));
    assert_eq!(newell_area(&ring) * 2.0, n);
    assert_eq!(n, DVec3::new(-12.0, 0.0, 24.0));
    // Outward of a convex body: P is the mean of the corners, v = P_k − P, N · v > 0.
    let body_middle = DVec3::new(2.0, 1.5, -3.0);
    assert!(n.dot(ring[0] - body_middle) > 0.0);
}

/// Checks N · (P_k − P) for the faces of a cube of side 2: area 4 times distance 1, negative for faces turned
/// inwards; later culling by the eye is right for any of them.
#[test]
fn outward_faces_have_a_positive_product() {
    let corner = |n: usize| DVec3::from([0, 1, 2].map(|k| if n >> k & 1 == 1 { 2.0 } else { 0.0 }));
    let points: Vec<DVec3> = (0..8).map(corner).collect();
    let right =
        [[4, 5, 7, 6], [0, 2, 3, 1], [1, 3, 7, 5], [0, 4, 6, 2], [2, 6, 7, 3], [0, 1, 5, 4]];
    let flipped = |which: &[usize]| {
        let mut faces = right;
        which.iter().for_each(|face| faces[*face].reverse());
        faces
    };
    let cases: [(&[usize], bool, usize); 3] =
        [(&[], false, 0), (&[0, 1, 2, 3, 4, 5], true, 0), (&[3], false, 1)];
    for (which, inside_out, count) in cases {
        let mut faces = flipped(which);
        let options = orientation::Options { outward: Outward::Centroid };
        let mut steps = Recorder::default();
        let found = orient(&points, &faces, &options, &mut steps).unwrap();
        let mut products = [0.0; 6];
        for step in steps.steps() {
            if let orientation::Step::Compared { face, product } = *step {
                products[face] = product;
            }
        }
        let expected: Vec<f64> =
            (0..6).map(|face| if which.contains(&face) { -4.0 } else { 4.0 }).collect();
        assert_eq!(products[..], expected, "{which:?}");
        assert_eq!((found.pieces[0].inside_out, found.pieces[0].flipped), (inside_out, count));
        for (ring, _) in faces.iter_mut().zip(&found.turned).filter(|(_, turned)| **turned) {
            ring.reverse();
        }
        // Seen along (−1, −2, −3), the faces at x = 2, y = 2 and z = 2 are front faces.
        let front = |ring: &[usize; 4]| {
            let ring = ring.map(|corner| points[corner]);
            face_along(newell_area(&ring), DVec3::new(-1.0, -2.0, -3.0)) == FaceSide::Front
        };
        let fronts: Vec<bool> = faces.iter().map(front).collect();
        assert_eq!(fronts, [true, false, true, false, true, false], "{which:?}");
    }
}
