//! Regions in delicate cases: unlit sides, equal shades, sharp corners of trapped shapes, faces that extend behind the
//! eye.

use crate::line_scenes::{Triangle, cuboid, quad, soup, view};
use durer::math::{DVec2, DVec3, Vec3};
use durer::scene::{Camera, Light, LightKind, Projection, Scene};
use durer::shade::PreparedLights;
use durer::target::drawing::{Drawing, LineClass, Region, RegionKind};
use durer::trace::NoTrace;
use durer::view::View;
use durer::visibility::line::hidden_line;
use durer::visibility::region::planar_map::solve;
use durer::visibility::region::{Fill, Merge, Options, draw};

fn floor(z: f64, side: f64) -> Vec<Triangle> {
    quad([[-side, -side, z], [side, -side, z], [side, side, z], [-side, side, z]])
}

fn shadowed(triangles: &[Triangle], to_eye: DVec3, direction: DVec3) -> Drawing {
    let view = view(DVec3::ZERO, to_eye, 8.0, false);
    let kind = LightKind::Directional { direction: direction.normalize() };
    // Unlit surfaces are black.
    let ambient = Light { kind: LightKind::Ambient, color: Vec3::ZERO };
    let lights = PreparedLights::new(&[Light { kind, color: Vec3::ONE }, ambient], view.camera());
    let options = Options { shadows: true, ..Options::default() };
    draw(&soup(triangles), &view, &lights, &options).expect("drawn")
}

fn is_black(region: &Region) -> bool {
    region.color[..3] == [0, 0, 0]
}

fn reported(drawing: &Drawing) -> Vec<(RegionKind, [u8; 4], f64)> {
    drawing.regions.iter().map(|r| (r.kind, r.color, r.area())).collect()
}

#[test]
fn shadows_fall_on_the_side_that_the_light_is_on_alone() {
    // A plate below the floor, lit from below: from above its shadow is invisible, even if it were as large as the
    // floor.
    let up = DVec3::new(0.1, 0.05, 1.0);
    let unlit = |r: &Region| r.kind == RegionKind::Surface && is_black(r);
    for size in [4.0, 1.0] {
        let triangles = [floor(0.0, 3.0), floor(-1.0, size)].concat();
        let above = shadowed(&triangles, DVec3::new(0.02, 0.01, 1.0), up);
        assert!(above.regions.iter().any(unlit));
        let of_floor = |r: &&Region| size < 3.0 || unlit(r);
        assert!(above.regions.iter().filter(of_floor).all(unlit), "{:?}", reported(&above));
        assert_eq!(above.length(|l| l.class == LineClass::Shadow), 0.0);
    }
    let triangles = [floor(0.0, 3.0), floor(-1.0, 1.0)].concat();
    // From below it is visible; and lit surfaces are not black.
    let below = shadowed(&triangles, DVec3::new(2.0, 0.1, -1.0), up);
    let (dark, lit): (Vec<&Region>, Vec<_>) =
        below.regions.iter().partition(|r| r.kind == RegionKind::Shadow);
    assert!(!dark.is_empty() && dark.iter().all(|r| is_black(r)), "{:?}", reported(&below));
    assert!(!lit.is_empty() && lit.iter().all(|r| !is_black(r)));
    assert!(below.length(|l| l.class == LineClass::Shadow) > 1.0);
}

#[test]
fn what_is_as_dark_as_a_shadow_is_one_region_with_it() {
    // Both visible sides of the box are turned away from the light, and its shadow begins at one.
    let mut triangles = floor(0.0, 3.0);
    triangles.extend(cuboid([0.0; 3], [1.0; 3]));
    let drawing = shadowed(&triangles, DVec3::new(1.0, -1.0, 1.0), DVec3::new(1.0, -0.2, -1.0));
    let dark: Vec<&Region> = drawing.regions.iter().filter(|r| is_black(r)).collect();
    assert_eq!(
        dark.iter().map(|r| r.kind).collect::<Vec<_>>(),
        [RegionKind::Shadow],
        "{:?}",
        reported(&drawing)
    );
    // Only two sides of the box, seen from an angle.
    assert!(dark[0].area() > 2.0 / 3.0_f64.sqrt() + 0.5, "{}", dark[0].area());
}

#[test]
fn trapped_shapes_do_not_shoot_out_of_sharp_corners() {
    // A wedge of 4.6° in front of a square that extends beneath it.
    let tip = DVec2::new(-3.0, 0.0);
    let wedge = [[-3.0, 0.0, 1.0], [2.0, -0.2, 1.0], [2.0, 0.2, 1.0]].map(DVec3::from);
    let scene = soup(&[floor(0.0, 3.5), vec![wedge]].concat());
    let view = view(DVec3::ZERO, DVec3::Z, 8.0, false);
    let lights = PreparedLights::of(&scene, view.camera());
    let reach = 0.05;
    let options =
        Options { merge: Merge::Face, fill: Fill::Trapped { reach }, ..Options::default() };
    let drawing = draw(&scene, &view, &lights, &options).expect("drawn");
    // Points of the underlying shape that belong neither to the wedge nor to the square.
    let points = drawing.regions.iter().flat_map(|r| r.rings.iter().flatten());
    let beneath: Vec<DVec2> = points.filter(|p| p.distance(tip) < 1.5).copied().collect();
    let farthest = beneath.iter().map(|p| p.distance(tip)).fold(0.0, f64::max);
    assert!(farthest > 2.0 * reach && farthest < 4.0 * reach + 1e-6, "{farthest}: {beneath:?}");
}

/// Returns a box, and above it a sheet from behind the eye to a little beyond the near plane: the part of the sheet
/// between the eye and that plane would cover the box.
fn under_a_sheet(sheet: bool) -> (Scene, View) {
    let mut triangles = cuboid([5.0, -0.5, -2.5], [6.0, 0.5, -1.25]);
    if sheet {
        let corners = [[-1.0, -3.0], [1.2, -3.0], [1.2, 3.0], [-1.0, 3.0]];
        triangles.extend(quad(corners.map(|[x, y]| [x, y, -0.2])));
    }
    let camera = Camera {
        eye: DVec3::ZERO,
        target: DVec3::X,
        up: DVec3::Z,
        projection: Projection::Perspective { fov_y: 1.5 },
        near: 1.0,
        far: 20.0,
    };
    (soup(&triangles), View::new(camera, 400, 400).expect("view"))
}

#[test]
fn what_lies_before_the_near_plane_hides_nothing() {
    let [with, without] = [true, false].map(|sheet| {
        let (scene, view) = under_a_sheet(sheet);
        let options = hidden_line::Options::default();
        let lines = hidden_line::draw(&scene, &view, &options, &mut NoTrace).expect("drawing");
        let map = solve(&scene, &view, &Default::default(), &mut NoTrace).expect("a map");
        let of_box = |item: u32| item < 12;
        let regions = map.regions(u64::from);
        let area: f64 = regions.iter().filter(|r| of_box(r.item)).map(|r| r.area()).sum();
        let visible = lines.length(|l| l.class != LineClass::Border && l.is_visible());
        let border = lines.length(|l| l.class == LineClass::Border);
        (visible, area, border > 0.0)
    });
    assert!(without.0 > 1.0 && without.1 > 0.01, "{without:?}");
    assert!((with.0 - without.0).abs() < 1e-6, "{with:?} {without:?}");
    assert!((with.1 - without.1).abs() < 1e-6, "{with:?} {without:?}");
    assert!(with.2 && !without.2);
}
