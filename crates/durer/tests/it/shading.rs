//! Materials, textures and lights together, as a renderer uses them.

use durer::math::{DMat3, DVec3, Vec2, Vec3, Vec4};
use durer::scene::{
    AlphaMode, Camera, Image, Light, LightKind, Material, MipFilter, Projection, Sampler, Scene,
    ShadingModel, Texture, TextureFilter, TextureRef, Wrap,
};
use durer::shade::flat::shade_face;
use durer::shade::gouraud::{Reflected, shade_vertex};
use durer::shade::{PreparedLights, PreparedMaterials, Shading, Surface, TexCoord, color, shade};

fn camera() -> Camera {
    Camera {
        eye: DVec3::Z * 5.0,
        target: DVec3::ZERO,
        up: DVec3::Y,
        projection: Projection::Orthographic { height: 2.0 },
        near: 1.0,
        far: 9.0,
    }
}

fn ambient(strength: f32) -> PreparedLights {
    let light = Light { kind: LightKind::Ambient, color: Vec3::splat(strength) };
    PreparedLights::new(&[light], &camera())
}

fn matte(base_color: Vec4) -> Material {
    Material { base_color, specular: Vec3::ZERO, ..Material::default() }
}

/// Returns a scene of one material, whose textures index one 2 × 1 image per entry.
fn scene(material: Material, images: &[[[u8; 4]; 2]]) -> Scene {
    let image = |data: &[[u8; 4]; 2]| Image {
        name: String::new(),
        width: 2,
        height: 1,
        data: data.to_vec(),
    };
    let sampler = Sampler {
        mag: TextureFilter::Nearest,
        min: TextureFilter::Nearest,
        mip: MipFilter::None,
        wrap_u: Wrap::Repeat,
        wrap_v: Wrap::Repeat,
    };
    Scene {
        materials: vec![material],
        images: images.iter().map(image).collect(),
        textures: (0..images.len()).map(|image| Texture { image, sampler }).collect(),
        ..Scene::default()
    }
}

fn texture(texture: usize) -> Option<TextureRef> {
    Some(TextureRef { texture, tex_coord: 0, transform: DMat3::IDENTITY })
}

fn at(u: f32) -> [TexCoord; 1] {
    [TexCoord { uv: Vec2::new(u, 0.5), ..TexCoord::default() }]
}

fn close(a: Vec4, b: Vec4) -> bool {
    (a - b).abs().max_element() < 1e-5
}

#[test]
fn textures_factors_and_vertex_colours_multiply() {
    let mut material = matte(Vec4::new(0.5, 1.0, 1.0, 1.0));
    material.base_color_texture = texture(0);
    material.occlusion_texture = texture(1);
    material.occlusion_strength = 0.5;
    material.emissive = Vec3::new(0.0, 0.0, 0.5);
    material.emissive_texture = texture(0);
    let scene = scene(material, &[[[188, 0, 255, 255], [255; 4]], [[0; 4], [255; 4]]]);
    let prepared = PreparedMaterials::new(&scene);
    let lights = ambient(0.5);
    for (u, base, light, emitted) in [
        (0.25, Vec3::new(color::decode_srgb8(188), 0.0, 1.0), 0.25, 1.0),
        (0.75, Vec3::ONE, 0.5, 1.0),
    ] {
        let tex_coords = at(u);
        let vertex = Vec4::new(0.5, 0.25, 1.0, 0.1);
        let surface = Surface { tex_coords: &tex_coords, color: vertex, ..Surface::default() };
        let found = shade(&surface, prepared.get(Some(0)), &lights, Shading::Phong);
        let lit = base * Vec3::new(0.25, 0.25, 1.0) * light;
        let expected = (lit + Vec3::new(0.0, 0.0, 0.5 * emitted)).extend(1.0);
        assert!(close(found, expected), "{u}: {found} {expected}");
    }
}

#[test]
fn texture_transforms_and_sets_are_applied() {
    let mut material = matte(Vec4::ONE);
    material.model = ShadingModel::Unlit;
    let transform = DMat3::from_cols_array_2d(&[[0.5, 0.0, 0.0], [0.0, 1.0, 0.0], [0.5, 0.0, 1.0]]);
    material.base_color_texture = Some(TextureRef { texture: 0, tex_coord: 1, transform });
    let scene = scene(material, &[[[255, 0, 0, 255], [0, 255, 0, 255]]]);
    let prepared = PreparedMaterials::new(&scene);
    let material = prepared.get(Some(0));
    assert!(material.is_textured() && !material.is_plain());
    let sets = [at(0.1)[0], at(0.1)[0]];
    let surface = Surface { tex_coords: &sets, ..Surface::default() };
    let green = shade(&surface, material, &ambient(1.0), material.shading());
    assert_eq!(green, Vec4::new(0.0, 1.0, 0.0, 1.0));
    // A set that the mesh lacks counts as (0, 0), which the transform maps to the second texel.
    let lacking = Surface { tex_coords: &sets[..1], ..Surface::default() };
    assert_eq!(shade(&lacking, material, &ambient(1.0), Shading::Unlit), green);
}

#[test]
fn alpha_modes_decide_what_is_left() {
    for (mode, alpha, expected) in [
        (AlphaMode::Opaque, 0.3, 1.0),
        (AlphaMode::Opaque, f32::NAN, 1.0),
        (AlphaMode::Mask { cutoff: 0.5 }, 0.5, 1.0),
        (AlphaMode::Mask { cutoff: 0.5 }, 0.499, 0.0),
        (AlphaMode::Blend, 0.3, 0.3),
        (AlphaMode::Blend, 7.0, 1.0),
        (AlphaMode::Blend, -1.0, 0.0),
        (AlphaMode::Blend, f32::NAN, 0.0),
    ] {
        let scene = scene(Material { alpha_mode: mode, ..matte(Vec4::ONE) }, &[]);
        let prepared = PreparedMaterials::new(&scene);
        let surface = Surface { color: Vec4::new(1.0, 1.0, 1.0, alpha), ..Surface::default() };
        for &shading in Shading::ALL {
            let found = shade(&surface, prepared.get(Some(0)), &ambient(0.5), shading);
            assert_eq!(found.w, expected, "{mode:?} {alpha}");
        }
    }
}

#[test]
fn both_sides_of_a_face_are_lit_alike() {
    let scene = scene(Material::default(), &[]);
    let prepared = PreparedMaterials::new(&scene);
    let lights = PreparedLights::auto(&camera());
    let normal = Vec3::new(0.3, 0.2, 0.9).normalize();
    for &shading in Shading::ALL {
        let seen = |geometric_normal: Vec3, normal: Vec3| {
            let surface = Surface { geometric_normal, normal, ..Surface::default() };
            shade(&surface, prepared.get(None), &lights, shading)
        };
        let front = seen(Vec3::Z, normal);
        assert!(front.x > 0.1);
        for (g, n) in [(-Vec3::Z, -normal), (Vec3::Z, -normal), (-Vec3::Z, normal)] {
            assert_eq!(seen(g, n), front, "{shading}");
        }
    }
}

#[test]
fn interpolated_and_face_light_take_the_place_of_the_points_own() {
    let scene = scene(Material::default(), &[]);
    let prepared = PreparedMaterials::new(&scene);
    let material = prepared.get(Some(0));
    let lights = PreparedLights::auto(&camera());
    let normals = [Vec3::X, Vec3::Y, Vec3::Z].map(|n| (n + Vec3::Z).normalize());
    let corners = normals.map(|n| shade_vertex(Vec3::ZERO, Vec3::Z, n, Vec3::Z, material, &lights));
    // At a vertex Gouraud and Phong shading agree.
    for (i, normal) in normals.into_iter().enumerate() {
        let weights = std::array::from_fn(|j| if i == j { 1.0 } else { 0.0 });
        let lit = Some(Reflected::interpolate(corners, weights));
        let surface = Surface { normal, ..Surface::default() };
        let phong = shade(&surface, material, &lights, Shading::Phong);
        let lit = Surface { lit, normal: Vec3::ZERO, ..Surface::default() };
        assert!(close(shade(&lit, material, &lights, Shading::Gouraud), phong));
    }
    // A face has one colour, whatever the normals of its vertices.
    let lit = Some(shade_face(Vec3::ZERO, Vec3::Z, Vec3::Z, material, &lights));
    let colors = normals.map(|normal| {
        shade(&Surface { lit, normal, ..Surface::default() }, material, &lights, Shading::Flat)
    });
    assert!(colors[0] == colors[1] && colors[1] == colors[2]);
    let own = shade(&Surface::default(), material, &lights, Shading::Flat);
    assert!(close(colors[0], own));
}

#[test]
fn normal_maps_bend_the_light_and_turn_with_the_face() {
    // Tangent-space normal (0.6, 0, 0.8) and a light from that direction: n·l = 1 instead of 0.8.
    let mut material = matte(Vec4::splat(0.5));
    material.normal_texture = texture(0);
    let scene = scene(material, &[[[204, 128, 230, 255]; 2]]);
    let prepared = PreparedMaterials::new(&scene);
    let direction = -DVec3::new(0.6, 0.0, 0.8);
    let key = Light { kind: LightKind::Directional { direction }, color: Vec3::ONE };
    let none = Light { kind: LightKind::Ambient, color: Vec3::ZERO };
    let lights = PreparedLights::new(&[key, none], &camera());
    let tex_coords = at(0.25);
    let light = |tangent: Vec3, side: f32| {
        let surface = Surface {
            normal: Vec3::Z * side,
            geometric_normal: Vec3::Z * side,
            tangent: Some(tangent.extend(1.0)),
            tex_coords: &tex_coords,
            ..Surface::default()
        };
        shade(&surface, prepared.get(Some(0)), &lights, Shading::Phong).x
    };
    assert!((light(Vec3::X, 1.0) - 0.5).abs() < 0.005);
    // cos of twice the angle between them: 0.8² − 0.6².
    assert!((light(-Vec3::X, 1.0) - 0.14).abs() < 0.01);
    // From behind, a bump is a dent: it bends the normal to the other side.
    assert!((light(-Vec3::X, -1.0) - 0.5).abs() < 0.005);
}

#[test]
fn automatic_light_shows_form_without_burning_out() {
    let scene = scene(matte(Vec4::new(0.8, 0.8, 0.8, 1.0)), &[]);
    let prepared = PreparedMaterials::new(&scene);
    let lights = PreparedLights::auto(&camera());
    let (mut darkest, mut brightest) = (1.0_f32, 0.0_f32);
    for (i, j) in (-20..=20).flat_map(|i| (-20..=20).map(move |j| (i, j))) {
        let (x, y) = (i as f32 / 20.0, j as f32 / 20.0);
        let height2 = 1.0 - x * x - y * y;
        if height2 < 0.0 {
            continue;
        }
        let normal = Vec3::new(x, y, height2.sqrt());
        let surface = Surface { normal, geometric_normal: Vec3::ZERO, ..Surface::default() };
        let light = shade(&surface, prepared.get(Some(0)), &lights, Shading::Phong).x;
        (darkest, brightest) = (darkest.min(light), brightest.max(light));
    }
    let codes = (color::encode_srgb8(darkest), color::encode_srgb8(brightest));
    assert!(codes.0 >= 60 && codes.0 <= 110, "{codes:?}");
    assert!(codes.1 >= 205 && codes.1 <= 235, "{codes:?}");
}

#[test]
fn every_material_survives_every_surface() {
    let mut material = Material { model: ShadingModel::MetallicRoughness, ..Material::default() };
    for slot in [
        &mut material.base_color_texture,
        &mut material.metallic_roughness_texture,
        &mut material.normal_texture,
        &mut material.occlusion_texture,
        &mut material.emissive_texture,
        &mut material.specular_texture,
    ] {
        *slot = texture(0);
    }
    let odd = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 0.0, -1.0, 1e38, 1e-40];
    let position = DVec3::new(0.0, 0.0, 5.0);
    let lamp = LightKind::Point { position, range: Some(1e-30) };
    let bright = |kind| Light { kind, color: Vec3::splat(1e38) };
    let lights = PreparedLights::new(
        &[bright(lamp), bright(LightKind::Directional { direction: DVec3::X })],
        &camera(),
    );
    for model in [ShadingModel::MetallicRoughness, ShadingModel::Phong, ShadingModel::Unlit] {
        for (a, b) in odd.iter().flat_map(|a| odd.map(|b| (*a, b))) {
            let odd_material = Material {
                model,
                metallic: a,
                roughness: b,
                shininess: a,
                normal_scale: b,
                occlusion_strength: a,
                emissive: Vec3::new(a, b, 0.5),
                specular: Vec3::splat(b),
                base_color: Vec4::new(b, a, 0.5, 1.0),
                ..material.clone()
            };
            let scene = scene(odd_material, &[[[9, 200, 77, 255], [128, 128, 255, 30]]]);
            let prepared = PreparedMaterials::new(&scene);
            let v = Vec3::new(a, b, 1.0);
            let d = Vec2::new(b, a);
            let tex_coords = [TexCoord { uv: Vec2::new(a, b), ddx: d, ddy: d }];
            for (normal, tangent) in [(v, None), (Vec3::ZERO, Some(v.extend(a)))] {
                let surface = Surface {
                    position: Vec3::new(b, 0.0, 0.0),
                    view: v,
                    normal,
                    geometric_normal: v,
                    tangent,
                    position_dx: v,
                    position_dy: v,
                    tex_coords: &tex_coords,
                    color: Vec4::new(1.0, a, b, 1.0),
                    lit: None,
                };
                for &shading in Shading::ALL {
                    let c = shade(&surface, prepared.get(Some(0)), &lights, shading);
                    let inside = c.min_element() >= 0.0 && c.max_element() <= 1.0;
                    assert!(inside && !c.is_nan(), "{model:?} {shading} {a} {b}: {c}");
                }
            }
        }
    }
}
