//! Steps of culling, labels, sections and fog: recording them changes nothing, and they rebuild the results.

use crate::raster_coverage::Random;
use crate::scenes::{instance, sphere};
use durer::fragment::fog::{self, Fog};
use durer::math::{DMat4, DVec2, DVec3, Plane, Rect, Vec4};
use durer::scene::{Aabb, Instance, Scene};
use durer::trace::{NoTrace, Recorder};
use durer::view::cull::{self, Containment, ConvexVolume};
use durer::view::label::{self, Obstacle, Placer};
use durer::view::section;

#[test]
fn planes_of_a_box_lead_to_its_relation() {
    let mut random = Random(3);
    let frustum = ConvexVolume::frustum(&DMat4::IDENTITY, Default::default());
    let mut found = [0; 3];
    for _ in 0..2_000 {
        let (p, q) = (random.point(-2.0, 2.0), random.point(-2.0, 2.0));
        let center = p.extend(q.x);
        let half = DVec3::splat(q.y.abs() * 0.3);
        let own = Aabb { min: center - half, max: center + half };
        let mut steps = Recorder::default();
        let relation = frustum.contains_box_traced(&own, &mut steps);
        assert_eq!(frustum.contains_box(&own), relation);
        assert_eq!(cull::replay(steps.steps()), relation);
        assert_eq!(steps.steps().last(), Some(&cull::Step::Found(relation)));
        // Against −1 … 1 on each axis.
        let outside = own.min.max_element() > 1.0 || own.max.min_element() < -1.0;
        let inside = own.min.min_element() >= -1.0 && own.max.max_element() <= 1.0;
        match relation {
            Containment::Outside => assert!(outside),
            Containment::Inside => assert!(inside),
            Containment::Crossing => assert!(!outside && !inside),
        }
        found[relation as usize] += 1;
        // A body outside is rejected at the first plane that it is beyond.
        if relation != Containment::Outside {
            assert_eq!(steps.steps().len(), 7);
        }
    }
    assert!(found.iter().all(|count| *count > 50), "{found:?}");
}

#[test]
fn candidates_lead_to_the_place_of_a_label() {
    let mut random = Random(8);
    let bounds = Rect::new(DVec2::ZERO, DVec2::splat(300.0)).unwrap();
    let mut placers = [Placer::new(bounds), Placer::new(bounds)];
    let mut taken: Vec<Rect> = Vec::new();
    let mut left_out = 0;
    for _ in 0..200 {
        let size = DVec2::new(40.0, 12.0);
        let candidates: Vec<Rect> = (0..3)
            .map(|_| random.point(-20.0, 290.0))
            .map(|low| Rect::new(low, low + size).unwrap())
            .collect();
        let mut steps = Recorder::default();
        let place = placers[0].place_traced(candidates.clone(), &mut steps);
        assert_eq!(placers[1].place(candidates.clone()), place);
        assert_eq!(label::replay(steps.steps()), place);
        for step in steps.steps() {
            let label::Step::Candidate { place, obstacle, .. } = step else { continue };
            let meets = |other: &Rect| {
                let (low, high) = (place.min().max(other.min()), place.max().min(other.max()));
                low.cmplt(high).all()
            };
            match obstacle {
                None => {
                    assert!(bounds.contains(place.min()) && bounds.contains(place.max()));
                    assert!(!taken.iter().any(meets));
                }
                Some(Obstacle::Taken(other)) => assert!(meets(&taken[*other])),
                Some(Obstacle::Bounds) => {
                    assert!(!bounds.contains(place.min()) || !bounds.contains(place.max()));
                }
            }
        }
        match place {
            Some(number) => taken.push(candidates[number]),
            None => {
                assert_eq!(steps.steps().last(), Some(&label::Step::LeftOut));
                left_out += 1;
            }
        }
    }
    assert!(left_out > 10 && taken.len() > 30, "{left_out} {}", taken.len());
}

#[test]
fn edges_and_caps_lead_to_the_outline_of_a_section() {
    let scene = Scene {
        meshes: vec![sphere(8, None)],
        instances: vec![Instance {
            world_from_mesh: DMat4::from_scale(DVec3::new(1.0, 2.0, 1.5)),
            ..instance(0)
        }],
        ..Scene::default()
    };
    let planes = [
        Plane { normal: DVec3::new(1.0, 0.5, 0.0), distance: 0.1 },
        Plane { normal: DVec3::new(0.0, -1.0, 1.0), distance: 0.2 },
    ];
    let options = section::Options::default();
    let mut steps = Recorder::default();
    let found = section::cut_traced(&scene, &planes, &options, &mut steps).unwrap();
    assert_eq!(section::cut(&scene, &planes, &options).unwrap(), found);
    let (outline, area) = section::replay(steps.steps());
    assert_eq!(outline, found.outline);
    assert_eq!(area, found.cap_area);
    assert!(!outline.is_empty() && area > 0.1, "{area}");
    // One step for each triangle of the first plane, as many are divided as the cut has edges.
    let first: Vec<_> = steps
        .steps()
        .iter()
        .skip(1)
        .take_while(|s| !matches!(s, section::Step::Plane(_)))
        .collect();
    let triangles = first.iter().filter(|s| matches!(s, section::Step::Triangle { .. })).count();
    assert_eq!(triangles as u64, scene.triangle_count());
    let divided = first.iter().filter(
        |s| matches!(s, section::Step::Triangle { inside: [a, b, c], .. } if a != b || b != c),
    );
    let edges = first.iter().filter(|s| matches!(s, section::Step::Edge(_)));
    assert_eq!(divided.count(), edges.count());
}

#[test]
fn shares_lead_to_the_colour_in_fog() {
    let (color, air) = (Vec4::new(0.2, 0.4, 0.6, 0.5), Vec4::new(1.0, 0.8, 0.6, 1.0));
    let laws = [
        Fog::Linear { start: 2.0, end: 4.0, least: 0.25 },
        Fog::Exponential { density: 0.5 },
        Fog::Squared { density: 0.5 },
    ];
    for law in laws {
        for z in [0.0, 1.0, 2.5, 4.0, 9.0] {
            let mut steps = Recorder::default();
            let found = law.apply_traced(color, air, z, &mut steps);
            assert_eq!(law.apply(color, air, z), found);
            assert_eq!(fog::replay(color, air, steps.steps()), found);
            assert_eq!(found.w, 0.5);
            assert_eq!(steps.steps().len(), 2);
        }
    }
    // At three quarters of the way to the end of depth cueing: f = ¼ + ¾ · ¼.
    let mut steps = Recorder::default();
    laws[0].apply_traced(color, air, 3.5, &mut NoTrace);
    laws[0].apply_traced(color, air, 3.5, &mut steps);
    let share = fog::Step::Share { fog: laws[0], z: 3.5, left: 0.4375 };
    assert_eq!(steps.steps().first(), Some(&share));
}
