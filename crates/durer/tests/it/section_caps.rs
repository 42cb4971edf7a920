//! The visible parts of a section's caps, computed alone, are those of the whole picture.

use crate::line_scenes::{Random, cuboid, random_boxes, soup, torus, view};
use durer::math::{DVec2, DVec3, Plane};
use durer::scene::{Instance, Scene};
use durer::shade::PreparedLights;
use durer::target::drawing::{Drawing, Region, RegionKind};
use durer::view::View;
use durer::view::section::{Options as SectionOptions, cut};
use durer::visibility::region::{Merge, Options, draw, draw_caps};

fn caps_of(drawing: &Drawing) -> Vec<&Region> {
    drawing.regions.iter().filter(|r| r.kind == RegionKind::Cap).collect()
}

fn covers(regions: &[&Region], p: DVec2) -> bool {
    let crosses = |a: DVec2, b: DVec2| {
        (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)
    };
    let rings = regions.iter().flat_map(|r| &r.rings);
    let sides = rings.flat_map(|ring| ring.iter().zip(ring.iter().cycle().skip(1)));
    sides.filter(|(a, b)| crosses(**a, **b)).count() % 2 == 1
}

fn area(regions: &[&Region]) -> f64 {
    let rings = regions.iter().flat_map(|r| &r.rings);
    rings.map(|ring| durer::clip::polygon::signed_area(ring)).sum()
}

/// Compares the caps computed alone with those of the whole picture; returns their visible area.
fn assert_same(name: &str, scene: &Scene, planes: &[Plane], view: &View) -> f64 {
    let section = cut(scene, planes, &SectionOptions::default()).expect("a section");
    let options = Options {
        merge: Merge::Material,
        cap_material: Some(section.cap_material),
        ..Options::default()
    };
    let lights = PreparedLights::of(&section.scene, view.camera());
    let whole = draw(&section.scene, view, &lights, &options).expect("a drawing");
    let alone = draw_caps(&section.scene, view, &lights, &options).expect("a drawing");
    assert_eq!(alone.window, whole.window);
    assert!(alone.regions.iter().all(|r| r.kind == RegionKind::Cap), "{name}");
    let (expected, found) = (caps_of(&whole), caps_of(&alone));
    let (a, b) = (area(&expected), area(&found));
    assert!((a - b).abs() < 1e-6, "{name}: {a} and {b}");
    let window = whole.window.expect("a window");
    let mut random = Random(7);
    for _ in 0..400 {
        let t = DVec2::new(random.next(), random.next());
        let p = window.min() + window.size() * t;
        assert_eq!(covers(&found, p), covers(&expected, p), "{name} at {p}");
    }
    assert_eq!(
        expected.iter().map(|r| r.color).collect::<Vec<_>>(),
        found.iter().map(|r| r.color).collect::<Vec<_>>(),
        "{name}"
    );
    area(&found)
}

#[test]
fn section_caps_alone_are_those_of_the_picture() {
    let plane = |x: f64, y: f64, z: f64, distance| Plane { normal: DVec3::new(x, y, z), distance };
    let (boxes, ring) = (soup(&random_boxes(25, 3)), soup(&torus(24, 12)));
    let sections = [
        vec![plane(0.0, 0.0, -1.0, 0.1)],
        vec![plane(0.3, -1.0, 0.2, 0.05)],
        vec![plane(-1.0, 0.0, 0.0, 0.2), plane(0.0, -1.0, 0.0, 0.1)],
    ];
    // A box without a lid, and one in front of the opening: the inside of a cap is partly visible.
    let mut open = cuboid([0.0; 3], [4.0, 4.0, 2.0]);
    open.retain(|t| t.iter().any(|p| p.z < 2.0));
    open.extend(cuboid([1.0, 1.0, 2.5], [2.5, 3.5, 3.0]));
    let open = soup(&open);
    let up = [plane(0.0, 0.0, 1.0, -1.0)];
    let above = view(DVec3::new(2.0, 2.0, 1.0), DVec3::new(0.1, -0.3, 1.0), 8.0, true);
    let inside = assert_same("open box", &open, &up, &above);
    assert!(inside > 2.0 && inside < 15.0, "{inside}");
    // Two bodies whose caps are in one plane and partly overlap: neither hides the other.
    let box_of = |x: f64| {
        let mut open = cuboid([x, 0.0, 0.0], [x + 4.0, 4.0, 2.0]);
        open.retain(|t| t.iter().any(|p| p.z < 2.0));
        open
    };
    let mut pair = soup(&box_of(0.0));
    pair.meshes.extend(soup(&box_of(3.0)).meshes);
    pair.instances.push(Instance { mesh: 1, ..pair.instances[0].clone() });
    let both = assert_same("two boxes", &pair, &up, &above);
    assert!(both > 6.0, "{both}");
    let mut seen = 0;
    for (name, scene) in [("boxes", &boxes), ("torus", &ring)] {
        let center = scene.bounding_sphere().expect("a sphere");
        for (i, planes) in sections.iter().enumerate() {
            // From in front of the caps, from the side, and from behind, where the model hides most of them.
            for (k, eye) in
                [[0.2, 0.4, 1.0], [1.0, 0.5, 0.1], [-0.3, -0.6, -1.0]].iter().enumerate()
            {
                let planes: Vec<Plane> = planes
                    .iter()
                    .map(|p| Plane {
                        distance: p.distance * center.radius - p.normal.dot(center.center),
                        ..*p
                    })
                    .collect();
                let view = view(center.center, DVec3::from(*eye), center.radius * 2.2, k == 1);
                let name = format!("{name}, section {i}, eye {k}");
                seen += usize::from(assert_same(&name, scene, &planes, &view) > 0.0);
            }
        }
    }
    assert!(seen > 9, "caps were seen in {seen} pictures");
}
