//! Back-face removal: right for polygons, and equal to the culling of the production path.

use crate::data;
use crate::scenes::{Numbers, instance, options, sphere};
use crate::surface_scenes::{assert_same_planes, covered, each};
use durer::math::{DMat4, DVec3, Vec3};
use durer::pipeline::Cull;
use durer::scene::{Camera, Mesh, Projection, Scene};
use durer::target::NO_ITEM;
use durer::trace::{NoTrace, Recorder};
use durer::view::View;
use durer::view::cull::FaceSide;
use durer::visibility::back_face::{Eye, Options, Step, remove, remove_of_scene};
use durer::visibility::surface::SurfaceInput;
use durer::visibility::surface::scan_line_z;
use durer::visibility::surface::{ScreenTriangle, TriangleFilter};
use proptest::prelude::*;

fn input<'a>(scene: &'a Scene, view: &'a View, cull: Cull) -> SurfaceInput<'a> {
    SurfaceInput::new(scene, view, TriangleFilter::new(cull, 128)).expect("input")
}

/// Returns whether rounding its corners to the grid can have reversed a triangle: each corner moves by half a step at
/// most, so twice the area changes by at most half the perimeter (|dx| + |dy|), and 3/2 more.
fn may_be_turned(t: &ScreenTriangle) -> bool {
    let side = |v: &[i32; 3], i: usize| i64::from(v[i]) - i64::from(v[(i + 1) % 3]);
    let around: i64 = (0..3).map(|i| side(&t.x, i).abs() + side(&t.y, i).abs()).sum();
    let area = side(&t.x, 0) * side(&t.y, 2) - side(&t.x, 2) * side(&t.y, 0);
    2 * area.abs() <= around + 3
}

/// Checks that the step removes exactly the faces that the production path culls, except slivers.
fn check_against_culling(name: &str, scene: &Scene, view: &View) -> [usize; 2] {
    let options = Options { whole_polygons: false, keep_edge_on: false };
    let kept = remove_of_scene(scene, Eye::of(view.camera()), &options, &mut NoTrace);
    let (all, culled) = (input(scene, view, Cull::None), input(scene, view, Cull::Back));
    let triangles = scene.triangle_count() as u32;
    let mut counts = [0; 2];
    let mut drawn = culled.triangles.iter().peekable();
    for t in all.triangles.iter().filter(|t| t.item < triangles) {
        let stays = drawn.next_if(|d| *d == t).is_some();
        let removed = kept.binary_search(&t.item).is_err();
        assert!(stays != removed || may_be_turned(t), "{name}: {t:?} {stays}");
        counts[usize::from(stays)] += 1;
    }
    counts
}

#[test]
fn what_the_production_path_culls_is_what_is_removed() {
    let mut counts = [0; 2];
    each(120, |name, p| {
        let found = check_against_culling(name, p.scene, &p.view);
        counts = [counts[0] + found[0], counts[1] + found[1]];
    });
    assert!(counts.iter().all(|&n| n > 1000), "{counts:?}");
}

#[test]
fn conformance_back_faces_of_real_models() {
    let Some(folder) = data::folder() else { return };
    for name in [
        "meshes/suzanne.obj",
        "meshes/nut.ply",
        "meshes/spot/spot_triangulated.obj",
        "gltf/Duck.glb",
    ] {
        let scene = data::read_model(&folder.join(name)).scene;
        for projection in
            [Projection::Perspective { fov_y: 0.6 }, Projection::Orthographic { height: 2.0 }]
        {
            let view = fitted(&scene, projection, 300);
            let counts = check_against_culling(name, &scene, &view);
            assert!(counts.iter().all(|&n| n > 100), "{name}: {counts:?}");
        }
    }
}

fn fitted(scene: &Scene, projection: Projection, side: u32) -> View {
    let bounds = scene.bounds().expect("bounds");
    let (center, extent) = ((bounds.min + bounds.max) * 0.5, (bounds.max - bounds.min).length());
    let projection = match projection {
        Projection::Orthographic { .. } => Projection::Orthographic { height: extent },
        other => other,
    };
    let camera = Camera {
        eye: center + DVec3::new(0.7, 0.5, 1.9) * extent,
        target: center,
        up: DVec3::Y,
        projection,
        near: extent * 0.2,
        far: extent * 6.0,
    };
    View::new(camera, side, side).expect("view")
}

/// Any of the image-space algorithms may leave culling to this step.
#[test]
fn a_closed_body_looks_the_same_without_its_back() {
    let mut scene = Scene {
        meshes: vec![sphere(14, None)],
        instances: vec![instance(0); 2],
        ..Scene::default()
    };
    scene.instances[1].world_from_mesh = DMat4::from_translation(DVec3::new(0.9, 0.2, 0.8))
        * DMat4::from_scale(DVec3::new(-0.6, 0.7, 0.5));
    for (name, side) in [("large", 160), ("small", 9)] {
        let view = View::new(options(&scene, side, side).camera, side, side).expect("view");
        let lights = durer::shade::PreparedLights::of(&scene, view.camera());
        let whole = input(&scene, &view, Cull::None);
        let mut front = whole.clone();
        let kept =
            remove_of_scene(&scene, Eye::of(view.camera()), &Options::default(), &mut NoTrace);
        front.triangles.retain(|t| kept.binary_search(&t.item).is_ok());
        let share = front.triangles.len() as f64 / whole.triangles.len() as f64;
        assert!((0.3..0.6).contains(&share), "{share}");
        let picture = |input: &SurfaceInput<'_>| {
            let planes = durer::target::Framebuffer::new(side, side);
            let mut planes = planes.with_items().with_depth().with_normals();
            scan_line_z::render(input, &lights, &Default::default(), &mut planes, &mut NoTrace);
            planes
        };
        assert_same_planes(name, &picture(&front), &picture(&whole));
    }
}

/// Returns a sphere whose first and last columns and whose poles coincide to the last bit: nothing shows through the
/// seam.
fn closed_sphere(rings: u32) -> Mesh {
    let mut mesh = sphere(rings, None);
    let columns = 2 * rings as usize + 1;
    for row in mesh.positions.chunks_exact_mut(columns) {
        row[columns - 1] = row[0];
    }
    let last = mesh.positions.len() - columns;
    mesh.positions[..columns].fill(Vec3::Y);
    mesh.positions[last..].fill(Vec3::NEG_Y);
    mesh
}

/// Checks that, of a convex body, everything kept that covers a pixel's centre is visible, and nothing else except
/// single pixels at the silhouette.
#[test]
fn one_convex_body_needs_nothing_else() {
    let scene =
        Scene { meshes: vec![closed_sphere(8)], instances: vec![instance(0)], ..Scene::default() };
    let view = View::new(options(&scene, 300, 300).camera, 300, 300).expect("view");
    let kept = remove_of_scene(&scene, Eye::of(view.camera()), &Options::default(), &mut NoTrace);
    let covers = |t: &ScreenTriangle| !covered(t, view.window()).is_empty();
    let input = input(&scene, &view, Cull::None);
    let mut expected: Vec<u32> = input
        .triangles
        .iter()
        .filter(|t| kept.binary_search(&t.item).is_ok() && covers(t))
        .map(|t| t.item)
        .collect();
    expected.dedup();
    assert!(expected.len() * 20 > kept.len() * 19, "{} {}", expected.len(), kept.len());
    let mut settings = options(&scene, 300, 300);
    settings.item = true;
    let planes = durer::pipeline::render(&scene, &settings).expect("picture").0;
    let items = planes.item.expect("items").into_data();
    // At the silhouette the depths of front and back are equal up to rounding, and a pixel there may show the back.
    let (mut seen, strays): (Vec<u32>, Vec<u32>) = items
        .into_iter()
        .filter(|&item| item != NO_ITEM)
        .partition(|item| kept.binary_search(item).is_ok());
    assert!(strays.len() * 5000 <= seen.len(), "{strays:?} of {}", seen.len());
    seen.sort_unstable();
    seen.dedup();
    assert_eq!(seen, expected);
}

/// Triangles of a concave polygon fanned from its first corner may face the wrong way; the polygon as a whole does not.
#[test]
fn concave_polygons_have_one_side() {
    let arrow = [(0.0, 0.0), (1.0, -1.0), (0.3, 0.0), (1.0, 1.0)];
    let ring = [1, 2, 3, 0].map(|i: usize| Vec3::new(arrow[i].0, arrow[i].1, 0.0));
    let mesh = Mesh {
        positions: ring.to_vec(),
        indices: Some(vec![0, 1, 2, 0, 2, 3]),
        faces: vec![0],
        ..Mesh::default()
    };
    let scene = Scene { meshes: vec![mesh], instances: vec![instance(0)], ..Scene::default() };
    let sides = |whole_polygons, z: f64| {
        let options = Options { whole_polygons, ..Options::default() };
        remove_of_scene(&scene, Eye::At(DVec3::new(0.4, 0.1, z)), &options, &mut NoTrace)
    };
    assert_eq!((sides(true, 5.0), sides(true, -5.0)), (vec![0, 1], vec![]));
    assert_ne!((sides(false, 5.0).len(), sides(false, -5.0).len()), (2, 0));
    // The same polygon in the triangles of a reader, which are not a fan.
    let mut scene = scene;
    scene.meshes[0].indices = Some(vec![3, 0, 1, 1, 2, 3]);
    for z in [5.0, -5.0] {
        let eye = Eye::At(DVec3::new(0.4, 0.1, z));
        let kept = remove_of_scene(&scene, eye, &Options::default(), &mut NoTrace);
        assert_eq!(kept.len(), if z > 0.0 { 2 } else { 0 });
    }
}

#[test]
fn what_is_edge_on_or_no_face_has_no_front() {
    let square = [(0., 0.), (1., 0.), (1., 1.), (0., 1.)].map(|(x, y)| DVec3::new(x, y, 0.0));
    let line = [DVec3::ZERO, DVec3::X, DVec3::X * 2.0];
    let strange = [DVec3::NAN, DVec3::X, DVec3::Y];
    let faces = [&square[..], &line[..], &strange[..], &[]];
    for keep_edge_on in [false, true] {
        let options = Options { keep_edge_on, ..Options::default() };
        let kept = |eye| remove(faces, eye, &options, &mut NoTrace);
        let rest: Vec<usize> = if keep_edge_on { vec![1, 2, 3] } else { vec![] };
        assert_eq!(kept(Eye::At(DVec3::Z))[..1], [0]);
        assert_eq!(kept(Eye::At(DVec3::Z))[1..], rest);
        assert_eq!(kept(Eye::At(DVec3::NEG_Z)), rest);
        assert_eq!(kept(Eye::At(DVec3::new(5.0, 5.0, 0.0))).contains(&0), keep_edge_on);
        assert_eq!(kept(Eye::Along(DVec3::X)).contains(&0), keep_edge_on);
        assert!(kept(Eye::Along(DVec3::NEG_Z)).contains(&0));
    }
}

proptest! {
    /// Checks the two laws of tracing, and that a polygon seen from its other side is the reversed one.
    #[test]
    fn steps_rebuild_the_result(seed in 0u64..1 << 40, count in 0usize..30) {
        let mut numbers = Numbers(seed);
        let mut point = || numbers.point(1.0).as_dvec3();
        let eye = Eye::At(point() * 3.0);
        let rings: Vec<Vec<DVec3>> = (0..count).map(|i| (0..3 + i % 4).map(|_| point()).collect()).collect();
        let given = || rings.iter().map(Vec::as_slice);
        let options = Options::default();
        let mut recorder = Recorder::default();
        let kept = remove(given(), eye, &options, &mut recorder);
        prop_assert_eq!(&kept, &remove(given(), eye, &options, &mut NoTrace));
        let replayed: Vec<usize> = recorder.steps().iter()
            .filter(|Step::Tested { side, .. }| *side == FaceSide::Front)
            .map(|Step::Tested { face, .. }| *face)
            .collect();
        prop_assert_eq!(&kept, &replayed);
        prop_assert_eq!(recorder.steps().len(), count);
        let turned: Vec<Vec<DVec3>> = rings.iter().map(|r| r.iter().rev().copied().collect()).collect();
        let behind = remove(turned.iter().map(Vec::as_slice), eye, &options, &mut NoTrace);
        let mut all = [kept, behind].concat();
        all.sort_unstable();
        prop_assert_eq!(all, (0..count).collect::<Vec<_>>());
    }
}
