//! Worked examples of the pages `scan-line-z`, `ray`, `shading`, `wireframe`, `sections` and `warping`.

use super::near;
use crate::line_scenes::view;
use crate::scenes::instance;
use crate::surface_scenes::of_triangles;
use durer::math::{DVec2, DVec3, Plane, Vec3, Vec4};
use durer::raster::interpolate::barycentric_3d;
use durer::scene::{
    Camera, Light, LightKind, Material, Mesh, Part, Projection, Scene, ShadingModel,
};
use durer::shade::gouraud::{Reflected, shade_vertex};
use durer::shade::{PreparedLights, PreparedMaterials, Shading, Surface, shade};
use durer::target::{Framebuffer, Pixels};
use durer::trace::Recorder;
use durer::view::View;
use durer::view::section::{self, cut_traced};
use durer::view::warp::{self, DepthPicture, HOLE, warp};
use durer::visibility::line::wireframe as wire_lines;
use durer::visibility::surface::Cull;
use durer::visibility::surface::SurfaceInput;
use durer::visibility::surface::TriangleFilter;
use durer::visibility::surface::ray::{self, RayKind};
use durer::visibility::surface::scan_line_z::{self, Step as Row};
use durer::visibility::wireframe;

/// Returns a camera in the origin of a perspective view along −z, by the tangent of half its vertical angle.
fn along_z(tangent: f64, near: f64, far: f64) -> Camera {
    let projection = Projection::Perspective { fov_y: 2.0 * tangent.atan() };
    Camera { eye: DVec3::ZERO, target: DVec3::NEG_Z, up: DVec3::Y, projection, near, far }
}

/// Page `scan-line-z`: row 3 of the triangle (2, 1) (10, 4) (4, 6), at x/20, and of a face at 0.28.
#[test]
fn a_row_of_depths_takes_what_is_nearer() {
    const ROWS: f64 = 8.0;
    // Window depth is −z / 20; whole numbers are centres of pixels, and rows count from the top.
    let corner = |x: f64, y: f64| DVec3::new(x + 0.5, ROWS - (y + 0.5), -x).as_vec3();
    let far = [(-1.0, -1.0), (30.0, -1.0), (-1.0, 30.0)];
    let far = far.map(|(x, y)| Vec3::new(x, y, -5.6));
    let scene = of_triangles(&[far, [corner(2.0, 1.0), corner(10.0, 4.0), corner(4.0, 6.0)]]);
    let eye = DVec3::new(6.0, 4.0, 1.0);
    let projection = Projection::Orthographic { height: ROWS };
    let target = eye + DVec3::NEG_Z;
    let camera = Camera { eye, target, up: DVec3::Y, projection, near: 1.0, far: 21.0 };
    let view = View::new(camera, 12, ROWS as u32).unwrap();
    let input = SurfaceInput::new(&scene, &view, TriangleFilter::new(Cull::None, 0)).unwrap();
    let lights = PreparedLights::new(&[], &camera);
    let mut target = Framebuffer::new(12, ROWS as u32).with_items();
    let mut steps = Recorder::default();
    scan_line_z::render(&input, &lights, &Default::default(), &mut target, &mut steps);
    let row = steps.steps().iter().skip_while(|s| **s != Row::Row { y: 3 }).skip(1);
    let row: Vec<Row> = row.take_while(|s| !matches!(s, Row::Row { .. })).copied().collect();
    let spans = row.iter().filter_map(|s| match *s {
        Row::Span { item, x0, x1 } => Some((item, x0, x1)),
        _ => None,
    });
    assert_eq!(spans.collect::<Vec<_>>(), [(0, 0, 12), (1, 3, 8)]);
    let written = |wanted: u32| {
        let of = |s: &Row| match *s {
            Row::Write { item, x, depth } if item == wanted => {
                Some((x, (f64::from(depth) * 1e4).round() / 1e4))
            }
            _ => None,
        };
        row.iter().filter_map(of).collect::<Vec<_>>()
    };
    assert_eq!(written(0), (0..12).map(|x| (x, 0.28)).collect::<Vec<_>>());
    assert_eq!(written(1), [(3, 0.15), (4, 0.2), (5, 0.25)]);
    let items = target.item.unwrap();
    let seen: Vec<_> = (0..12).map(|x| items.get(x, 3).unwrap()).collect();
    assert_eq!(seen, [0, 0, 0, 1, 1, 1, 0, 0, 0, 0, 0, 0]);
}

/// Page `ray`: t = 3 and weights ¼, ¼, ½; straight back; and t = 5 beside the triangle.
#[test]
fn rays_hit_a_triangle_by_its_weights() {
    let corners = [(-2.0, -2.0, -3.0), (2.0, -2.0, -3.0), (0.0, 2.0, -3.0)].map(DVec3::from);
    let mut scene = of_triangles(&[corners.map(|c| c.as_vec3())]);
    scene.materials.push(Material {
        model: ShadingModel::MetallicRoughness,
        base_color: Vec4::ONE,
        metallic: 1.0,
        roughness: 0.0,
        ..Material::default()
    });
    scene.meshes[0].parts = vec![Part { range: 0..1, material: Some(0), name: String::new() }];
    // Three rows of pixels: the ray of the upper one rises by 4 where it advances by 3.
    let camera = along_z(2.0, 1.0, 10.0);
    let view = View::new(camera, 3, 3).unwrap();
    let input = SurfaceInput::new(&scene, &view, TriangleFilter::new(Cull::None, 0)).unwrap();
    let lights = PreparedLights::new(&[], &camera);
    let options = ray::Options { reflections: true, ..ray::Options::default() };
    let mut steps = Recorder::default();
    ray::render(&input, &lights, &options, &mut Framebuffer::new(3, 3), &mut steps);
    let cast = |column: i32, line: i32, wanted: RayKind| {
        let of = |s: &ray::Step| match *s {
            ray::Step::Ray { x, y, kind, origin, direction, hit, t, .. }
                if (x, y, kind) == (column, line, wanted) =>
            {
                Some((origin, direction, hit, t))
            }
            _ => None,
        };
        steps.steps().iter().find_map(of)
    };
    let plane = Plane { normal: DVec3::Z, distance: 3.0 };
    let to_plane = |direction: DVec3| -plane.distance / plane.normal.dot(direction);
    let weights = |p: DVec3| barycentric_3d(corners, p).unwrap();
    let close = |a: [f64; 3], b: [f64; 3]| (DVec3::from(a) - DVec3::from(b)).length() < 1e-9;

    let (origin, direction, hit, t) = cast(1, 1, RayKind::Primary).unwrap();
    assert!(direction.distance(DVec3::NEG_Z) < 1e-9, "{direction}");
    assert_eq!((origin, hit), (DVec3::ZERO, Some(0)));
    assert!(near(to_plane(direction), 3.0) && (t - 3.0).abs() < 1e-5, "{t}");
    assert!(close(weights(origin + direction * 3.0), [0.25, 0.25, 0.5]));
    let (origin, direction, hit, _) = cast(1, 1, RayKind::Mirror).unwrap();
    assert!(direction.distance(DVec3::Z) < 1e-6 && hit.is_none(), "{direction}");
    assert!(origin.distance(DVec3::NEG_Z * 3.0) < 1e-3, "{origin}");

    let (origin, direction, hit, t) = cast(1, 0, RayKind::Primary).unwrap();
    assert!(direction.distance(DVec3::new(0.0, 0.8, -0.6)) < 1e-9, "{direction}");
    assert!((to_plane(direction) - 5.0).abs() < 1e-9);
    let passed = origin + direction * to_plane(direction);
    assert!(passed.distance(DVec3::new(0.0, 4.0, -3.0)) < 1e-9);
    assert!(close(weights(passed), [-0.25, -0.25, 1.5]));
    assert_eq!((hit, t), (None, f64::INFINITY));
}

/// Page `shading`: normals tilted by 60° to both sides of a light straight above.
#[test]
fn gouraud_misses_the_light_between_two_corners() {
    let camera = Camera::look_at([0.0, 0.0, 5.0], [0.0; 3], [0.0, 1.0, 0.0]);
    let above = LightKind::Directional { direction: DVec3::NEG_Z };
    let lights = [(above, Vec3::ONE), (LightKind::Ambient, Vec3::ZERO)];
    let lights = lights.map(|(kind, color)| Light { kind, color });
    let lights = PreparedLights::new(&lights, &camera);
    let matte = Material { base_color: Vec4::ONE, specular: Vec3::ZERO, ..Material::default() };
    let scene = Scene { materials: vec![matte], ..Scene::default() };
    let materials = PreparedMaterials::new(&scene);
    let material = materials.get(Some(0));
    let tilt = 60.0_f32.to_radians();
    let [left, right] = [-tilt, tilt].map(|a| Vec3::new(libm::sinf(a), 0.0, libm::cosf(a)));
    let ends =
        [left, right].map(|n| shade_vertex(Vec3::ZERO, Vec3::Z, n, Vec3::Z, material, &lights));
    let is = |found: f32, expected: f32| assert!((found - expected).abs() < 1e-6, "{found}");
    ends.iter().for_each(|end| is(end.diffuse.x, 0.5));
    let middle = Reflected::interpolate([ends[0], ends[1], ends[1]], [0.5, 0.5, 0.0]);
    let normal = left * 0.5 + right * 0.5;
    assert!(normal.distance(Vec3::Z * 0.5) < 1e-6, "not yet of length 1");
    let surface = Surface { normal, ..Surface::default() };
    let gouraud = Surface { lit: Some(middle), ..surface };
    is(shade(&gouraud, material, &lights, Shading::Gouraud).x, 0.5);
    is(shade(&surface, material, &lights, Shading::Phong).x, 1.0);
}

/// Page `wireframe`: 24 sides are 12 edges; pixels show the six diagonals of the triangles, too.
#[test]
fn sides_of_a_cube_are_found_twice_and_drawn_once() {
    let quads: [[u32; 4]; 6] =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let corner = |i: u32| Vec3::from([0, 1, 2].map(|k| (i >> k & 1) as f32));
    let fans = quads.iter().flat_map(|&[a, b, c, d]| [a, b, c, a, c, d]);
    let mesh = Mesh {
        positions: (0..8).map(corner).collect(),
        indices: Some(fans.collect()),
        faces: (0..12).step_by(2).collect(),
        ..Mesh::default()
    };
    let scene = Scene { meshes: vec![mesh], instances: vec![instance(0)], ..Scene::default() };
    let sides = |[a, b, c, d]: [u32; 4]| {
        [[a, b], [b, c], [c, d], [d, a]].map(|[a, b]| [a.min(b), a.max(b)])
    };
    let mut edges: Vec<[u32; 2]> = quads.into_iter().flat_map(sides).collect();
    assert_eq!(edges.len(), 24);
    edges.sort_unstable();
    assert!(edges.chunks(2).all(|pair| pair[0] == pair[1]), "each twice");
    edges.dedup();
    assert_eq!(edges.len(), 12);

    let large = view(DVec3::splat(0.5), DVec3::new(1.0, 0.7, 0.5), 3.0, true);
    let small = View::new(*large.camera(), 60, 60).unwrap();
    let mut steps = Recorder::default();
    let mut target = Pixels::new(60, 60, [255; 4]);
    wireframe::render(&scene, &small, &Default::default(), &mut target, &mut steps);
    let drawn = steps.steps().iter().map(|&wireframe::Step::Edge { vertices, .. }| vertices);
    let (of_cube, diagonals): (Vec<_>, Vec<_>) = drawn.partition(|edge| edges.contains(edge));
    assert_eq!((of_cube, diagonals.len()), (edges, 0));
    let mut steps = Recorder::default();
    let drawing = wire_lines::draw(&scene, &large, &Default::default(), &mut steps).unwrap();
    let drawn = |s: &&wire_lines::Step| matches!(s, wire_lines::Step::Edge(_));
    // Lines that meet are joined.
    let parts: usize =
        drawing.lines.iter().map(|line| line.points.len() - usize::from(!line.closed)).sum();
    assert_eq!((steps.steps().iter().filter(drawn).count(), parts), (12, 12));
}

/// Page `sections`: the pyramid at half its height.
#[test]
fn a_pyramid_is_cut_at_half_of_its_edges() {
    let base = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)].map(|(x, z)| Vec3::new(x, 0.0, z));
    let positions = base.into_iter().chain([Vec3::new(2.0, 4.0, 2.0)]).collect();
    let indices = vec![0, 1, 2, 0, 2, 3, 1, 0, 4, 2, 1, 4, 3, 2, 4, 0, 3, 4];
    let mesh = Mesh { positions, indices: Some(indices), ..Mesh::default() };
    let scene = Scene { meshes: vec![mesh], instances: vec![instance(0)], ..Scene::default() };
    let plane = Plane { normal: DVec3::NEG_Y, distance: 2.0 };
    let [low, high] = [0.0, 4.0].map(|y| plane.evaluate(DVec3::Y * y));
    assert_eq!([low, high, low / (low - high)], [2.0, -2.0, 0.5]);
    let mut steps = Recorder::default();
    let section = cut_traced(&scene, &[plane], &Default::default(), &mut steps).unwrap();
    let steps = steps.steps();
    let inside = steps.iter().filter_map(|s| match *s {
        section::Step::Triangle { inside, .. } => Some(inside),
        _ => None,
    });
    let (kept, divided) = ([true; 3], [true, true, false]);
    assert_eq!(inside.collect::<Vec<_>>(), [kept, kept, divided, divided, divided, divided]);
    let [a, b, c, d] = [(1.0, 1.0), (3.0, 1.0), (3.0, 3.0), (1.0, 3.0)];
    let [a, b, c, d] = [a, b, c, d].map(|(x, z)| DVec3::new(x, 2.0, z));
    let edges = steps.iter().filter_map(|s| match *s {
        section::Step::Edge([from, to]) => Some([from, to]),
        _ => None,
    });
    assert_eq!(edges.collect::<Vec<_>>(), [[b, a], [c, b], [d, c], [a, d]]);
    let caps = steps.iter().filter(|s| matches!(s, section::Step::Cap(_))).count();
    assert_eq!((caps, section.cap_area, section.open_cuts), (2, 4.0, 0));
}

/// Page `warping`: cameras 0.1 apart, 1000 pixels: 50 at distance 2, 10 at distance 10, a hole of 40.
#[test]
fn near_pixels_move_further_than_far_ones() {
    const WIDTH: u32 = 180;
    let from = along_z(0.5 / 1000.0, 1.0, 20.0);
    let aside = DVec3::X * 0.1;
    let to = Camera { eye: from.eye + aside, target: from.target + aside, ..from };
    let view = View::new(from, WIDTH, 1).unwrap();
    let depth_at = |distance: f64| {
        let p = view.screen_from_world() * DVec3::new(0.0, 0.0, -distance).extend(1.0);
        (p.z / p.w) as f32
    };
    let is_body = |x: u32| (60..120).contains(&x);
    let depths = (0..WIDTH).map(|x| depth_at(if is_body(x) { 2.0 } else { 10.0 })).collect();
    let colors = (0..WIDTH).map(|x| [if is_body(x) { 200 } else { 90 }, 0, 0, 255]).collect();
    let depth = Pixels::from_data(WIDTH, 1, depths).unwrap();
    let color = Pixels::from_data(WIDTH, 1, colors).unwrap();
    let source = DepthPicture { color: &color, depth: &depth, camera: from };
    let mut steps = Recorder::default();
    let found = warp(&[source], &to, [WIDTH, 1], &Default::default(), &mut steps).unwrap();
    let moves = steps.steps().iter().filter_map(|s| match *s {
        warp::Step::Move { from: [x, _], to, .. } => Some((x, to)),
        warp::Step::Write { .. } => None,
    });
    let moves: Vec<(u32, DVec2)> = moves.collect();
    assert_eq!(moves.len(), WIDTH as usize);
    for (x, to) in moves {
        let left = f64::from(x) + 0.5 - to.x;
        assert!((left - if is_body(x) { 50.0 } else { 10.0 }).abs() < 1e-3, "{x}: {left}");
    }
    let holes: Vec<u32> = (0..WIDTH).filter(|&x| found.source.get(x, 0) == Some(HOLE)).collect();
    // Beside the body, and at the border of the picture.
    assert_eq!(holes, (70..110).chain(170..180).collect::<Vec<_>>());
    let body =
        (0..WIDTH).filter(|&x| found.framebuffer.color.get(x, 0).is_some_and(|c| c[0] == 200));
    assert_eq!(
        body.filter(|x| !holes.contains(x)).collect::<Vec<_>>(),
        (10..70).collect::<Vec<_>>()
    );
}
