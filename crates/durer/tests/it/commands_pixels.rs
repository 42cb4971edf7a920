//! Commands beyond geometry: lighting, textures, the pixel path, clipped lines, rows counted from below.

use durer::commands::{
    BezierPatch, Bitmap, BoundTexture, ColorMaterial, Command, CornerVertex, CullFace,
    DisplayLists, LightModel, LightSource, LightStep, LightingState, MaterialFace, Pipeline,
    PixelBlock, PixelPlane, Primitive, Reflection, ShadeModel, TextureFunction, execute,
    read_pixels,
};
use durer::fragment::{Compare, FragmentState, Scissor};
use durer::math::{DMat4, DVec2, DVec3, DVec4, IVec2, Vec4};
use durer::raster::line::{self, bresenham};
use durer::scene::{Image, Sampler, TextureFilter};
use durer::target::{Framebuffer, Pixels, RowOrigin};
use durer::trace::{NoTrace, Recorder};

const SIDE: u32 = 16;

fn target() -> Framebuffer {
    Framebuffer::new(SIDE, SIDE).with_depth().with_stencil()
}

fn on(mut target: Framebuffer, commands: &[Command]) -> Framebuffer {
    execute(commands, &DisplayLists::default(), &mut Pipeline::default(), &mut target)
        .expect("drawn");
    target
}

fn fails(commands: &[Command]) -> String {
    let lists = DisplayLists::default();
    let failed = execute(commands, &lists, &mut Pipeline::default(), &mut target());
    failed.expect_err("refused").to_string()
}

fn at(x: f64, y: f64) -> CornerVertex {
    CornerVertex::from(DVec3::new(x, y, 0.0))
}

fn square() -> Command {
    Command::Draw(Primitive::Polygon, vec![at(-1., -1.), at(1., -1.), at(1., 1.), at(-1., 1.)])
}

fn grey(v: f32) -> Vec4 {
    Vec4::new(v, v, v, 1.0)
}

fn close(found: DVec4, expected: [f64; 4]) {
    assert!((found - DVec4::from(expected)).abs().max_element() < 1e-6, "{found} {expected:?}");
}

/// A point light at distance 2, 60 degrees from the normal, all terms of the formula.
#[test]
fn every_term_of_the_light_is_shown() {
    let mut lighting = LightingState { enabled: true, ..LightingState::default() };
    lighting.model = LightModel { ambient: grey(0.1), local_viewer: true, two_sided: false };
    lighting.front = Reflection {
        ambient: grey(0.5),
        diffuse: Vec4::new(0.8, 0.4, 0.2, 0.75),
        specular: grey(0.5),
        emission: grey(0.05),
        shininess: 2.0,
    };
    let vertex = DVec4::new(0.0, 0.0, -3.0, 1.0);
    // l = (√3/2, 0, ½), and the eye is straight ahead.
    let toward = DVec3::new(0.75_f64.sqrt(), 0.0, 0.5);
    lighting.lights[3] = Some(LightSource {
        ambient: grey(0.2),
        position: (vertex.truncate() + toward * 2.0).extend(1.0),
        attenuation: [1.0, 0.25, 0.125],
        spot_direction: -toward,
        spot_cutoff: 30.0,
        spot_exponent: 4.0,
        ..LightSource::default()
    });
    let mut steps = Recorder::default();
    let lit = lighting.lit(true, vertex, DVec3::Z, Vec4::ONE, &mut steps);
    let [LightStep { light: 3, attenuation, spot, n_dot_l, n_dot_h, color }] = steps.steps() else {
        panic!("{:?}", steps.steps());
    };
    // 1 / (1 + ¼·2 + ⅛·4) = ½; along the axis; cos 60°; h is 30° from the normal.
    for (found, expected) in
        [(attenuation, 0.5), (spot, 1.0), (n_dot_l, 0.5), (n_dot_h, 0.75_f64.sqrt())]
    {
        assert!((found - expected).abs() < 1e-12, "{found} {expected}");
    }
    // ½ · (0.5·0.2 + ½·d + ¾·0.5), and 0.05 + 0.5·0.1 of no light.
    let channel = |d: f64| 0.5 * (0.1 + 0.5 * d + 0.375);
    assert!((color.x - channel(0.8)).abs() < 1e-7, "{color}");
    close(lit, [0.1 + channel(0.8), 0.1 + channel(0.4), 0.1 + channel(0.2), 0.75]);
    assert_eq!(lit, lighting.lit(true, vertex, DVec3::Z, Vec4::ONE, &mut NoTrace));
    // Beyond the cutoff the light has no effect.
    if let Some(light) = &mut lighting.lights[3] {
        light.spot_direction = DVec3::NEG_Z;
    }
    close(lighting.lit(true, vertex, DVec3::Z, Vec4::ONE, &mut NoTrace), [0.1, 0.1, 0.1, 0.75]);
}

#[test]
fn a_light_that_a_face_turns_away_from_leaves_its_ambient_share() {
    let mut lighting = LightingState { enabled: true, ..LightingState::default() };
    lighting.model.ambient = grey(0.0);
    lighting.front.specular = grey(1.0);
    lighting.lights[0] = Some(LightSource { ambient: grey(1.0), ..LightSource::default() });
    // Shininess 0 would add the whole highlight if f were not 0.
    let lit = lighting.lit(true, DVec4::W, DVec3::NEG_Z, Vec4::ONE, &mut NoTrace);
    close(lit, [0.2, 0.2, 0.2, 1.0]);
    let back = lighting.lit(false, DVec4::W, DVec3::NEG_Z, Vec4::ONE, &mut NoTrace);
    close(back, [1.0, 1.0, 1.0, 1.0]);
    lighting.color_material = Some(ColorMaterial::Ambient);
    let own =
        lighting.lit(true, DVec4::W, DVec3::NEG_Z, Vec4::new(0.5, 0.0, 0.25, 0.1), &mut NoTrace);
    close(own, [0.5, 0.0, 0.25, 1.0]);
}

fn lamp(commands: &mut Vec<Command>) {
    commands.push(Command::Lighting(true));
    commands.push(Command::LightModel(LightModel { ambient: grey(0.0), ..LightModel::default() }));
    commands.push(Command::Light(0, Some(LightSource::default())));
    let material = Reflection { ambient: grey(0.0), diffuse: Vec4::ONE, ..Reflection::default() };
    commands.push(Command::Material(MaterialFace::FrontAndBack, material));
}

/// Returns the stored channel of a linear value.
fn code(linear: f32) -> u8 {
    durer::shade::color::encode_rgba8(grey(linear))[0]
}

#[test]
fn lights_move_with_the_matrix_and_normals_with_its_inverse() {
    let mut commands = Vec::new();
    lamp(&mut commands);
    // A light under a rotation comes from +x; then the normal (1, 0, 1) is stretched along z to (1, 0, ½)/|…|.
    let turn = DMat4::from_rotation_y(std::f64::consts::FRAC_PI_2);
    commands.extend([
        Command::LoadModelView(turn),
        Command::Light(0, Some(LightSource::default())),
        Command::LoadModelView(DMat4::from_scale(DVec3::new(1.0, 1.0, 2.0))),
        Command::Normalize(true),
        Command::Normal(DVec3::new(1.0, 0.0, 1.0)),
        square(),
    ]);
    let picture = on(target(), &commands);
    let expected = code((1.0 / 1.25_f32.sqrt()).min(1.0));
    let found = picture.color.get(8, 8).expect("pixel")[0];
    assert!(found.abs_diff(expected) <= 1, "{found} {expected}");
}

#[test]
fn flat_shading_takes_the_last_vertex_and_two_sides_their_materials() {
    let mut commands = Vec::new();
    lamp(&mut commands);
    let corner = |x, y, normal| CornerVertex { normal: Some(normal), ..at(x, y) };
    let ring = vec![
        corner(-1., -1., DVec3::NEG_Z),
        corner(3., -1., DVec3::NEG_Z),
        corner(-1., 3., DVec3::Z),
    ];
    let mut smooth = commands.clone();
    smooth.push(Command::Draw(Primitive::Triangles, ring.clone()));
    let picture = on(target(), &smooth);
    assert!(picture.color.get(0, 15).expect("pixel")[0] < 60);
    commands.push(Command::ShadeModel(ShadeModel::Flat));
    commands.push(Command::Draw(Primitive::Triangles, ring.clone()));
    assert!(on(target(), &commands).color.data().iter().all(|c| *c == [255; 4]));
    // Seen from behind: corners in the other order, and a red back.
    let red = Reflection {
        ambient: grey(0.0),
        diffuse: Vec4::new(1.0, 0.0, 0.0, 1.0),
        ..Reflection::default()
    };
    let model = LightModel { ambient: grey(0.0), two_sided: true, ..LightModel::default() };
    let turned: Vec<CornerVertex> =
        ring.iter().rev().map(|v| CornerVertex { normal: Some(DVec3::NEG_Z), ..*v }).collect();
    commands.extend([
        Command::LightModel(model),
        Command::Material(MaterialFace::Back, red),
        Command::Draw(Primitive::Triangles, turned),
    ]);
    assert!(on(target(), &commands).color.data().iter().all(|c| *c == [255, 0, 0, 255]));
}

#[test]
fn patches_are_lit_by_the_normals_of_their_derivatives() {
    let row = |y: f64, z: f64| vec![DVec3::new(-1.0, y, z), DVec3::new(1.0, y, z)];
    let flat = BezierPatch { rows: vec![row(-1.0, 0.0), row(1.0, 0.0)] };
    assert_eq!(flat.normal(0.3, 0.8), Some(DVec3::Z));
    // A slope of one half along y: the normal is (0, −½, 1) / |…|.
    let slanted = BezierPatch { rows: vec![row(-1.0, -0.5), row(1.0, 0.5)] };
    let expected = DVec3::new(0.0, -0.5, 1.0).normalize();
    assert!((slanted.normal(0.5, 0.5).expect("a normal") - expected).length() < 1e-12);
    assert_eq!(BezierPatch { rows: vec![vec![DVec3::ZERO; 2]; 2] }.normal(0.5, 0.5), None);
    let mut commands = Vec::new();
    lamp(&mut commands);
    commands.push(Command::EvaluatePatch(slanted, [2, 2]));
    let found = on(target(), &commands).color.get(8, 8).expect("pixel")[0];
    assert!(found.abs_diff(code(expected.z as f32)) <= 1, "{found}");
}

#[test]
fn lights_and_materials_out_of_range_are_refused() {
    let light = |light: LightSource| fails(&[Command::Light(0, Some(light))]);
    assert!(light(LightSource { spot_cutoff: 100.0, ..LightSource::default() }).contains("180"));
    assert!(
        light(LightSource { attenuation: [0.0; 3], ..LightSource::default() })
            .contains("not all zero")
    );
    assert!(light(LightSource { spot_exponent: -1.0, ..LightSource::default() }).contains("128"));
    assert!(fails(&[Command::Light(8, None)]).contains('8'));
    let shiny = Reflection { shininess: f64::NAN, ..Reflection::default() };
    assert!(fails(&[Command::Material(MaterialFace::Front, shiny)]).contains("shininess"));
    assert!(fails(&[Command::PixelZoom(DVec2::new(f64::NAN, 1.0))]).contains("zoom"));
    assert!(fails(&[Command::CopyPixels([15, 0, 2, 1], PixelPlane::Color)]).contains("2x1+15+0"));
    assert!(fails(&[Command::CopyPixels([0; 4], PixelPlane::Index)]).contains("does not have"));
}

/// Two texels, red with half its alpha and green.
fn image() -> Image {
    let data = vec![[255, 0, 0, 128], [0, 255, 0, 255]];
    Image { name: String::new(), width: 2, height: 1, data }
}

fn textured(function: TextureFunction) -> Framebuffer {
    let texture = BoundTexture::new(image());
    let texture = BoundTexture {
        sampler: Sampler {
            mag: TextureFilter::Nearest,
            min: TextureFilter::Nearest,
            ..texture.sampler
        },
        function,
        color: Vec4::new(0.0, 0.0, 1.0, 1.0),
        ..texture
    };
    let corner = |x: f64, y: f64| CornerVertex {
        tex_coord: Some(DVec2::new((x + 1.0) / 2.0, 0.5)),
        ..at(x, y)
    };
    let ring = vec![corner(-1., -1.), corner(1., -1.), corner(1., 1.), corner(-1., 1.)];
    let white = Command::Color(Vec4::new(1.0, 1.0, 1.0, 0.5));
    on(target(), &[white, Command::Texture(Some(texture)), Command::Draw(Primitive::Polygon, ring)])
}

#[test]
fn each_texture_function_is_opengls() {
    for (function, left, right) in [
        (TextureFunction::Replace, [255, 0, 0, 128], [0, 255, 0, 255]),
        (TextureFunction::Modulate, [255, 0, 0, 64], [0, 255, 0, 128]),
        // White through half of red: linear ½.
        (TextureFunction::Decal, [255, code(0.498), code(0.498), 128], [0, 255, 0, 128]),
        // Red removes the red and adds that of the environment, which is none.
        (TextureFunction::Blend, [0, 255, 255, 64], [255, 0, 255, 128]),
        (TextureFunction::Add, [255, 255, 255, 64], [255, 255, 255, 128]),
    ] {
        let picture = textured(function);
        for (x, expected) in [(3, left), (12, right)] {
            let found = picture.color.get(x, 8).expect("pixel");
            let apart = found.iter().zip(expected).map(|(a, b)| a.abs_diff(b)).max();
            assert!(apart <= Some(1), "{function:?}: {found:?} {expected:?}");
        }
    }
}

fn block(width: u32, values: &[u8]) -> Pixels<[u8; 4]> {
    let data = values.iter().map(|v| [*v, 0, 0, 255]).collect();
    Pixels::from_data(width, values.len() as u32 / width, data).expect("a block")
}

/// Returns the red channel of rows of the picture.
fn reds(
    picture: &Framebuffer,
    columns: std::ops::Range<u32>,
    rows: std::ops::Range<u32>,
) -> Vec<u8> {
    let red = |x, y| picture.color.get(x, y).map_or(0, |c| c[0]);
    rows.flat_map(|y| columns.clone().map(move |x| red(x, y))).collect()
}

#[test]
fn pixels_are_drawn_at_the_raster_position_and_zoomed() {
    let draw = Command::DrawPixels(PixelBlock::Color(block(2, &[10, 20, 30, 40])));
    // Device coordinates −¾, ½ are column 2, row 4 from the top.
    let place = Command::RasterPosition(at(-0.75, 0.5));
    let plain = on(target(), &[place.clone(), draw.clone()]);
    assert_eq!(reds(&plain, 1..5, 3..7), [0, 0, 0, 0, 0, 10, 20, 0, 0, 30, 40, 0, 0, 0, 0, 0]);
    let zoomed =
        on(target(), &[place.clone(), Command::PixelZoom(DVec2::new(2.0, 1.5)), draw.clone()]);
    // Rows 4 to 5.5 and 5.5 to 7: the centre of row 5 is the border, which belongs to the second.
    assert_eq!(
        reds(&zoomed, 1..7, 4..7),
        [0, 10, 10, 20, 20, 0, 0, 30, 30, 40, 40, 0, 0, 30, 30, 40, 40, 0]
    );
    let mirrored = on(target(), &[place, Command::PixelZoom(DVec2::new(-1.0, -1.0)), draw]);
    assert_eq!(reds(&mirrored, 0..2, 2..4), [40, 30, 20, 10]);
}

#[test]
fn pixels_go_through_the_fragment_operations() {
    let depths = PixelBlock::Depth(Pixels::from_data(2, 1, vec![0.25, 0.75]).expect("a block"));
    let stencils = PixelBlock::Stencil(Pixels::from_data(2, 1, vec![7, 9]).expect("a block"));
    let scissor = Some(Scissor { x0: 0, y0: 0, x1: 1, y1: 16 });
    let picture = on(
        target(),
        &[
            Command::Clear { color: None, depth: Some(0.5), stencil: None, index: None },
            Command::Fragments(FragmentState { depth: Some(Compare::Less), ..Default::default() }),
            Command::Color(Vec4::new(0.0, 1.0, 0.0, 1.0)),
            Command::RasterPosition(at(-1.0, 1.0)),
            Command::DrawPixels(depths),
            Command::Fragments(FragmentState { scissor, ..Default::default() }),
            Command::DrawPixels(stencils),
        ],
    );
    let PixelBlock::Depth(found) =
        read_pixels(&picture, [0, 0, 2, 1], PixelPlane::Depth).expect("read")
    else {
        panic!("another plane");
    };
    assert_eq!(found.data(), [0.25, 0.5]);
    assert_eq!([0, 1].map(|x| picture.color.get(x, 0)), [Some([0, 255, 0, 255]), Some([0; 4])]);
    let stencil = picture.stencil.as_ref().expect("a plane");
    assert_eq!([0, 1].map(|x| stencil.get(x, 0)), [Some(7), Some(0)]);
}

#[test]
fn copying_is_reading_and_drawing_and_a_clipped_position_draws_nothing() {
    let draw = Command::DrawPixels(PixelBlock::Color(block(2, &[10, 20, 30, 40])));
    let drawn = vec![Command::RasterPosition(at(-1.0, 1.0)), draw.clone()];
    let copy = [
        Command::RasterPosition(at(0.0, 0.0)),
        Command::PixelZoom(DVec2::new(1.0, -1.0)),
        Command::CopyPixels([0, 0, 2, 2], PixelPlane::Color),
    ];
    let picture = on(target(), &[drawn.clone(), copy.to_vec()].concat());
    assert_eq!(reds(&picture, 8..10, 6..8), [30, 40, 10, 20]);
    let before = on(target(), &drawn);
    let beyond = [drawn, vec![Command::RasterPosition(at(1.5, 0.0)), draw]].concat();
    assert_eq!(on(target(), &beyond), before);
}

/// Checks that a line that leaves the viewport lights in it the pixels of the whole line, with its depths.
#[test]
fn lines_light_the_pixels_of_the_whole_line() {
    let viewport = [3_u32, 2, 10, 9];
    let place = |v: DVec2| DVec2::new((v.x - 3.0) / 5.0 - 1.0, 1.0 - (v.y - 2.0) / 4.5);
    let mut state = 5_u64;
    let mut random = || {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((state >> 33) % 60) as i32 - 22
    };
    for case in 0..300 {
        let ends = [0, 1].map(|_| IVec2::new(random(), random()));
        let corner = |p: IVec2| {
            let ndc = place(p.as_dvec2() + 0.5);
            CornerVertex::from(ndc.extend(0.0))
        };
        let commands = [
            Command::Viewport(Some(viewport)),
            Command::Draw(Primitive::Lines, ends.map(corner).to_vec()),
        ];
        let picture = on(Framebuffer::new(SIDE, SIDE), &commands);
        let mut expected = Framebuffer::new(SIDE, SIDE);
        let plot = |p: IVec2| {
            if (3..13).contains(&p.x) && (2..11).contains(&p.y) {
                expected.color.set(p.x as u32, p.y as u32, [255; 4]);
            }
        };
        bresenham::draw(ends[0], ends[1], &line::Options::default(), plot, &mut NoTrace);
        assert!(picture == expected, "{case}: {ends:?}");
    }
}

/// Checks rows counted from below: as in OpenGL, rows of viewport, scissor and pixels start at the lowest.
#[test]
fn pictures_may_begin_with_the_lowest_row() {
    let below = || Framebuffer { origin: RowOrigin::BottomLeft, ..target() };
    let ring = vec![at(-1., -1.), at(0.5, -1.), at(-1., 0.25)];
    let commands = [
        Command::Cull(CullFace::Back),
        Command::Draw(Primitive::Triangles, ring.clone()),
        Command::Draw(Primitive::Lines, vec![at(-1., 0.9), at(1., 0.1)]),
        Command::Draw(Primitive::Points, vec![at(0.9, -0.9)]),
    ];
    let picture = on(below(), &commands);
    assert_eq!(picture.color.get(0, 0), Some([255; 4]), "the corner is in the first row");
    assert_eq!(picture.color.get(15, 0), Some([255; 4]), "the point, too");
    // The same picture as with rows counted from above, except for which border of a face belongs to it.
    let turned = picture.clone().with_origin(RowOrigin::TopLeft);
    let other = on(target(), &commands);
    let apart = turned.color.data().iter().zip(other.color.data()).filter(|(a, b)| a != b).count();
    assert!(apart <= 16, "{apart}");
    assert_eq!(turned.with_origin(RowOrigin::BottomLeft), picture);
    let front = on(below(), &[Command::Cull(CullFace::Front), commands[1].clone()]);
    assert_eq!(front.color, target().color, "fronts are fronts in either order");
    let lower = on(
        below(),
        &[
            Command::Viewport(Some([0, 0, 16, 4])),
            square(),
            Command::RasterPosition(at(-1.0, 1.0)),
            Command::DrawPixels(PixelBlock::Color(block(1, &[10, 20]))),
        ],
    );
    assert_eq!(reds(&lower, 0..1, 0..7), [255, 255, 255, 255, 10, 20, 0]);
}

/// A letter L of 9 × 3 bits: its stem in the first column, its foot the whole last row.
fn letter() -> Bitmap {
    let rows = vec![0b1000_0000, 0, 0b1000_0000, 0, 0b1111_1111, 0b1000_0000];
    Bitmap::new(9, 3, rows).expect("rows")
}

/// Returns the pixels that are not empty, row by row.
fn drawn(target: &Framebuffer) -> Vec<[u32; 2]> {
    let all = (0..SIDE).flat_map(|y| (0..SIDE).map(move |x| [x, y]));
    all.filter(|[x, y]| target.color.get(*x, *y) != Some([0; 4])).collect()
}

#[test]
fn bitmaps_are_drawn_beside_the_raster_position_which_moves_on() {
    let place = Command::RasterPosition(at(-0.45, 0.45));
    let bits = letter().placed(DVec2::new(1.5, 0.5), DVec2::new(3.0, -2.0));
    let mut pipeline = Pipeline::default();
    let mut found = target();
    let green = Command::Color(Vec4::new(0.0, 1.0, 0.0, 1.0));
    let red = Command::Color(Vec4::new(1.0, 0.0, 0.0, 1.0));
    // The colour is that of the raster position, and the zoom does not affect bitmaps.
    let zoom = Command::PixelZoom(DVec2::splat(4.0));
    let commands = [green, place, red, zoom, Command::Bitmap(bits.clone())];
    execute(&commands, &DisplayLists::default(), &mut pipeline, &mut found).expect("drawn");
    // (4.4, 4.4) − (1.5, 0.5), rounded down, is (2, 3).
    let mut expected = vec![[2, 3], [2, 4]];
    expected.extend((2..11).map(|x| [x, 5]));
    assert_eq!(drawn(&found), expected);
    assert_eq!(found.color.get(2, 3), Some([0, 255, 0, 255]));
    let moved = pipeline.raster.expect("valid").at;
    assert!((moved - DVec2::new(7.4, 2.4)).abs().max_element() < 1e-12, "{moved}");
    // The next one is drawn beside it: (7.4, 2.4) leads to (5, 1).
    let again =
        [Command::Clear { color: Some(Vec4::ZERO), depth: None, stencil: None, index: None }];
    let again = again.into_iter().chain([Command::Bitmap(bits)]).collect::<Vec<_>>();
    execute(&again, &DisplayLists::default(), &mut pipeline, &mut found).expect("drawn");
    let mut expected = vec![[5, 1], [5, 2]];
    expected.extend((5..14).map(|x| [x, 3]));
    assert_eq!(drawn(&found), expected);
}

#[test]
fn bitmaps_are_clipped_tested_and_left_out() {
    let scissor = Scissor { x0: 0, y0: 0, x1: 3, y1: SIDE };
    let fragments = FragmentState { scissor: Some(scissor), depth: None, ..Default::default() };
    let bits =
        |x: f64, y: f64| Command::Bitmap(letter().placed(DVec2::new(x, y), DVec2::new(-1e9, 0.0)));
    let start = Command::RasterPosition(at(-1.0, 1.0));
    let found = on(target(), &[start.clone(), Command::Fragments(fragments), bits(4.0, 1.0)]);
    assert_eq!(drawn(&found), [[0, 1], [1, 1], [2, 1]]);
    // Far away nothing is drawn; a position that was clipped stays invalid and does not move.
    let found = on(target(), &[start, bits(0.0, -2.0), bits(0.0, 0.0)]);
    assert_eq!(drawn(&found).first(), Some(&[0, 2]));
    assert_eq!(drawn(&found).len(), 11);
    let mut pipeline = Pipeline::default();
    let mut empty = target();
    let lists = DisplayLists::default();
    let outside = [Command::RasterPosition(at(2.0, 0.0)), bits(0.0, 0.0)];
    execute(&outside, &lists, &mut pipeline, &mut empty).expect("drawn");
    assert!(drawn(&empty).is_empty() && pipeline.raster.is_none());
    let odd = letter().placed(DVec2::ZERO, DVec2::new(f64::NAN, 0.0));
    assert!(fails(&[Command::Bitmap(odd)]).contains("bitmap"));
    assert!(Bitmap::new(u32::MAX, u32::MAX, Vec::new()).is_err());
}
