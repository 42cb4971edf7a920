//! Edges where curved faces join others smoothly.

use crate::line_scenes::{Triangle, soup, view};
use durer::math::DVec3;
use durer::target::drawing::{Drawing, LineClass};
use durer::trace::NoTrace;
use durer::visibility::line::hidden_line::{Options, draw};
use durer::visibility::line::{ClassSet, Smooth};

/// Returns a bar along z from 0 to 5 over a slot: two half circles of radius 1 and `n` facets, 4 apart,
/// with lids.
fn slot(n: usize) -> Vec<Triangle> {
    let corner = |k: usize| {
        let (side, k) = if k <= n { (2.0, k) } else { (-2.0, k - 1) };
        let angle = (k as f64 / n as f64 - 0.5) * std::f64::consts::PI;
        [side + angle.cos(), angle.sin()]
    };
    let count = 2 * n + 2;
    let at = |k: usize, z: f64| DVec3::new(corner(k % count)[0], corner(k % count)[1], z);
    let sides = (0..count).flat_map(|k| {
        let [a, b, c, d] = [at(k, 0.0), at(k + 1, 0.0), at(k + 1, 5.0), at(k, 5.0)];
        [[a, b, c], [a, c, d]]
    });
    let lids = (1..count - 1).flat_map(|k| {
        [[at(0, 0.0), at(k + 1, 0.0), at(k, 0.0)], [at(0, 5.0), at(k, 5.0), at(k + 1, 5.0)]]
    });
    sides.chain(lids).collect()
}

fn drawn(triangles: &[Triangle], to_eye: DVec3, smooth: Smooth) -> Drawing {
    let classes = ClassSet::default().with(LineClass::Tangent);
    let options = Options { classes, smooth, tolerance: 1e-6, ..Options::default() };
    let v = view(DVec3::new(0.0, 0.0, 2.5), to_eye, 12.0, false);
    draw(&soup(triangles), &v, &options, &mut NoTrace).expect("drawing")
}

#[test]
fn a_slot_has_four_where_its_sides_begin() {
    for (n, smooth) in [(6, Smooth::Off), (12, Smooth::Off), (12, Smooth::Auto), (40, Smooth::Auto)]
    {
        let to_eye = DVec3::new(0.6, -1.0, 0.7);
        let drawing = drawn(&slot(n), to_eye, smooth);
        let height = 5.0 * (1.0 - to_eye.normalize().z.powi(2)).sqrt();
        let tangent = |visible| {
            drawing.length(|l| l.class == LineClass::Tangent && l.is_visible() == visible) / height
        };
        // Two in front, and two behind, none of which is an outline.
        let (seen, hidden) = (tangent(true), tangent(false));
        assert!((seen - 2.0).abs() < 1e-3, "{n} {smooth:?}: {seen}");
        assert!((hidden - 2.0).abs() < 1e-3, "{n} {smooth:?}: {hidden}");
        assert_eq!(drawing.length(|l| l.class == LineClass::Wire), 0.0);
    }
}

#[test]
fn round_bodies_and_bends_have_none() {
    let ring = |n: usize| -> Vec<Triangle> {
        let mut all = slot(n);
        all.iter_mut().flatten().for_each(|p| p.x -= 2.0 * p.x.signum());
        all
    };
    // A cylinder; facets all around.
    let cylinder = ring(24);
    let found = drawn(&cylinder, DVec3::new(0.6, -1.0, 0.7), Smooth::Auto);
    assert_eq!(found.length(|l| l.class == LineClass::Tangent), 0.0);
    // Flat faces at 30° to each other, beside creases.
    let roof = slot(3);
    let found = drawn(&roof, DVec3::new(0.6, -1.0, 2.0), Smooth::Off);
    assert_eq!(found.length(|l| l.class == LineClass::Tangent), 0.0);
}

#[test]
fn they_are_drawn_only_where_requested() {
    let v = view(DVec3::new(0.0, 0.0, 2.5), DVec3::new(0.6, -1.0, 0.7), 12.0, false);
    let drawing = draw(&soup(&slot(12)), &v, &Options::default(), &mut NoTrace).expect("drawing");
    assert_eq!(drawing.length(|l| l.class == LineClass::Tangent), 0.0);
}
