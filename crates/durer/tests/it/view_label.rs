//! Places for labels.

use durer::math::{DVec2, Rect};
use durer::trace::{NoTrace, Recorder};
use durer::view::interior_point::{Options, Step, interior_point};
use durer::view::label::Placer;
use proptest::prelude::*;

fn ring(points: &[(f64, f64)]) -> Vec<DVec2> {
    points.iter().map(|(x, y)| DVec2::new(*x, *y)).collect()
}

fn find(rings: &[Vec<DVec2>], precision: f64) -> Option<(DVec2, f64)> {
    let rings: Vec<&[DVec2]> = rings.iter().map(Vec::as_slice).collect();
    let options = Options { precision, ..Options::default() };
    interior_point(&rings, &options, &mut NoTrace).map(|i| (i.point, i.distance))
}

#[test]
fn the_pole_of_a_square_is_its_middle_and_of_a_ring_it_is_not() {
    let square = ring(&[(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)]);
    let (p, d) = find(std::slice::from_ref(&square), 0.01).unwrap();
    assert!((p - DVec2::splat(5.0)).length() < 0.02 && (d - 5.0).abs() < 0.02);
    let hole = ring(&[(2.0, 2.0), (9.0, 2.0), (9.0, 9.0), (2.0, 9.0)]);
    let (p, d) = find(&[square, hole], 0.01).unwrap();
    // In the corner between both rings: the circle that touches two sides and the corner of the hole.
    let radius = 2.0 * 2.0_f64.sqrt() / (1.0 + 2.0_f64.sqrt());
    assert!((d - radius).abs() < 0.02 && p.max_element() < 2.0, "{p} {d}");
}

#[test]
fn nothing_is_inside_of_nothing() {
    assert_eq!(find(&[], 0.5), None);
    assert_eq!(find(&[ring(&[(1.0, 1.0)])], 0.5), None);
    assert_eq!(find(&[ring(&[(0.0, 0.0), (5.0, 5.0)])], 0.5), None);
    assert_eq!(find(&[ring(&[(0.0, 0.0), (f64::NAN, 5.0), (5.0, 0.0)])], 0.5), None);
    assert!(
        find(&[ring(&[(0.0, 0.0), (1e300, 0.0), (1e300, 1e300)])], 0.0)
            .is_none_or(|f| f.0.is_finite())
    );
    // A needle a million times longer than wide.
    let needle = ring(&[(0.0, 0.0), (1e6, 0.0), (1e6, 1.0), (0.0, 1.0)]);
    assert!(find(&[needle], 0.01).is_some_and(|f| f.1 > 0.3));
}

proptest! {
    #[test]
    fn the_point_is_inside_and_no_sample_is_much_farther(
        radii in prop::collection::vec(2.0_f64..20.0, 5..20), precision in 0.1_f64..1.0
    ) {
        // A star around the origin, which is inside.
        let turn = std::f64::consts::TAU / radii.len() as f64;
        let star: Vec<DVec2> = radii.iter().enumerate()
            .map(|(i, r)| DVec2::new((turn * i as f64).cos(), (turn * i as f64).sin()) * *r)
            .collect();
        let (p, d) = find(std::slice::from_ref(&star), precision).unwrap();
        let distance = |p: DVec2| (0..star.len()).map(|i| {
            let (a, b) = (star[i], star[(i + 1) % star.len()]);
            let t = ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
            p.distance(a.lerp(b, t))
        }).fold(f64::INFINITY, f64::min);
        let inside = |p: DVec2| (0..star.len()).filter(|i| {
            let (a, b) = (star[*i], star[(i + 1) % star.len()]);
            (a.y > p.y) != (b.y > p.y) && p.x < (b.x - a.x) * (p.y - a.y) / (b.y - a.y) + a.x
        }).count() % 2 == 1;
        prop_assert!(inside(p) && (distance(p) - d).abs() < 1e-9);
        for i in 0..400 {
            let q = DVec2::new(f64::from(i % 20) * 2.0 - 19.0, f64::from(i / 20) * 2.0 - 19.0);
            prop_assert!(!inside(q) || distance(q) <= d + precision + 1e-9);
        }
    }

    #[test]
    fn labels_neither_overlap_nor_leave_the_picture(
        boxes in prop::collection::vec((-20.0_f64..320.0, -20.0_f64..220.0, 1.0_f64..150.0, 1.0_f64..30.0), 1..80)
    ) {
        let bounds = Rect::new(DVec2::ZERO, DVec2::new(300.0, 200.0)).unwrap();
        let mut placer = Placer::new(bounds);
        let mut taken: Vec<Rect> = Vec::new();
        let overlap = |a: &Rect, b: &Rect| {
            let (lo, hi) = (a.min().max(b.min()), a.max().min(b.max()));
            lo.x < hi.x && lo.y < hi.y
        };
        for (x, y, w, h) in boxes {
            let min = DVec2::new(x, y);
            let label = Rect::new(min, min + DVec2::new(w, h)).unwrap();
            let free = bounds.contains(label.min()) && bounds.contains(label.max())
                && taken.iter().all(|t| !overlap(t, &label));
            prop_assert_eq!(placer.place([label]), free.then_some(0));
            if free {
                taken.push(label);
            }
        }
    }
}

#[test]
fn listening_changes_nothing_and_the_steps_hold_the_result() {
    let rings = [ring(&[(0.0, 0.0), (30.0, 2.0), (22.0, 19.0), (4.0, 11.0)])];
    let rings: Vec<&[DVec2]> = rings.iter().map(Vec::as_slice).collect();
    let mut recorder: Recorder<Step> = Recorder::default();
    let heard = interior_point(&rings, &Options::default(), &mut recorder).unwrap();
    assert_eq!(Some(heard), interior_point(&rings, &Options::default(), &mut NoTrace));
    let steps = recorder.steps();
    let best = steps.iter().map(|s| s.distance).fold(f64::MIN, f64::max);
    assert!(best - heard.distance <= Options::default().precision, "{best}, {heard:?}");
    // The result is the last point-sized cell at that distance.
    let far = |s: &&Step| s.half == 0.0 && s.distance >= best - Options::default().precision;
    let last = steps.iter().rfind(far).unwrap();
    assert_eq!((last.center, last.distance), (heard.point, heard.distance));
}
