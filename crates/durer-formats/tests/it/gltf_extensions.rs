//! glTF: the effects of extensions, each in a small file.

use crate::gltf::{ACCESSOR, file, read, scene, triangle, triangle_bytes};
use durer::math::{DVec3, Vec3, Vec4};
use durer::scene::{AlphaMode, Image, Material, Scene, ShadingModel};
use durer::target::Pixels;
use durer_formats::{Error, Limits, Model, NoResources, ReadOptions, gltf, png};

/// Returns a triangle and a node with three instances of it, given by floats, by normalized bytes and floats.
fn instanced(attributes: &str, node: &str) -> String {
    let mut data = triangle_bytes();
    let places: [f32; 9] = [0.0, 0.0, 0.0, 10.0, 0.0, 0.0, 0.0, 20.0, 0.0];
    let sizes: [f32; 9] = [1.0, 1.0, 1.0, 2.0, 2.0, 2.0, 1.0, 3.0, 1.0];
    data.extend(places.iter().chain(&sizes).flat_map(|v| v.to_le_bytes()));
    // Quaternions: none, half a turn around z, half a turn around x.
    data.extend([0, 0, 0, 127, 0, 0, 127, 0, 127, 0, 0, 0]);
    let accessor = |offset: u32, component: u32, count: u32, shape: &str| {
        format!(
            r#"{{"bufferView": 0, "byteOffset": {offset}, "componentType": {component}, "count": {count},
            "type": "{shape}", "normalized": {}}}"#,
            component == 5120
        )
    };
    let accessors = [
        accessor(36, 5126, 3, "VEC3"),
        accessor(72, 5126, 3, "VEC3"),
        accessor(108, 5120, 3, "VEC4"),
        accessor(36, 5126, 2, "VEC3"),
    ];
    file(
        &data,
        &format!(
            r#""accessors": [{ACCESSOR}, {}], "scenes": [{{"nodes": [0]}}],
            "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}}}]}}],
            "nodes": [{{"mesh": 0, "name": "n", "extensions": {{"EXT_mesh_gpu_instancing":
                {{"attributes": {{{attributes}}}}}}}, {node}}}]"#,
            accessors.join(",")
        ),
    )
}

#[test]
fn instances_stand_where_their_attributes_say() {
    let attributes = r#""TRANSLATION": 1, "SCALE": 2, "ROTATION": 3, "_ID": 1"#;
    let text = instanced(attributes, r#""translation": [0, 0, 5]"#);
    let scene = scene(&text);
    assert_eq!((scene.meshes.len(), scene.instances.len()), (1, 3));
    assert!(scene.instances.iter().all(|i| i.name == "n" && i.mesh == 0));
    let corner = |i: usize, at: DVec3| scene.instances[i].world_from_mesh.transform_point3(at);
    assert_eq!(corner(0, DVec3::X), DVec3::new(1.0, 0.0, 5.0));
    let near = |a: DVec3, b: DVec3| assert!((a - b).length() < 1e-12, "{a} {b}");
    near(corner(1, DVec3::new(1.0, 1.0, 1.0)), DVec3::new(8.0, -2.0, 7.0));
    near(corner(2, DVec3::new(1.0, 1.0, 1.0)), DVec3::new(1.0, 17.0, 4.0));
    assert!(read(&text).unwrap().warnings.is_empty());
    // Only attributes private to an application: one instance, as without the extension.
    assert_eq!(self::scene(&instanced(r#""_ID": 1"#, r#""scale": [1, 1, 1]"#)).instances.len(), 1);
}

#[test]
fn instances_that_do_not_fit_are_refused() {
    let error = |attributes: &str| {
        read(&instanced(attributes, r#""scale": [1, 1, 1]"#)).unwrap_err().to_string()
    };
    let counts = error(r#""TRANSLATION": 4, "ROTATION": 3"#);
    assert!(counts.contains("their numbers of elements differ: 2 and 3"), "{counts}");
    let missing = error(r#""TRANSLATION": 9"#);
    let at = "nodes[0].extensions.EXT_mesh_gpu_instancing.attributes.TRANSLATION: ";
    assert!(missing.starts_with(at), "{missing}");
    assert!(error(r#""ROTATION": 1"#).contains("4 are needed"));
    let limits = Limits { instances: 2, ..Limits::default() };
    let options = ReadOptions { limits, ..ReadOptions::default() };
    let text = instanced(r#""TRANSLATION": 1"#, r#""scale": [1, 1, 1]"#);
    let limited = gltf::read(text.as_bytes(), &NoResources, &options);
    assert!(matches!(limited, Err(Error::Limit { value: 3, limit: 2, .. })), "{limited:?}");
}

#[test]
fn what_is_hidden_is_left_out_with_all_below_it() {
    let hidden = r#""extensions": {"KHR_node_visibility": {"visible": false}}"#;
    let shown = r#""extensions": {"KHR_node_visibility": {"visible": true}}"#;
    let model = read(&triangle(&format!(
        r#""scenes": [{{"nodes": [0, 1, 3]}}], "nodes": [
        {{"name": "a", "mesh": 0, {shown}}},
        {{"name": "b", "mesh": 0, "children": [2], {hidden}}},
        {{"name": "c", "mesh": 0, "camera": 0, {shown}, "children": [4]}},
        {{"name": "d", "mesh": 0, "extensions": {{"KHR_node_visibility": {{}}}}}},
        {{"name": "e", "extensions": {{"KHR_lights_punctual": {{"light": 0}}}}}}],
        "cameras": [{{"name": "eye", "perspective": {{"yfov": 1, "znear": 1}}}}],
        "extensions": {{"KHR_lights_punctual": {{"lights": [{{"type": "point"}}]}}}},
        "extensionsRequired": ["KHR_node_visibility"]"#
    )))
    .unwrap();
    let names: Vec<&str> = model.scene.instances.iter().map(|i| i.name.as_str()).collect();
    assert_eq!(names, ["a", "d"]);
    assert!(model.scene.lights.is_empty() && model.scene.cameras.len() == 1);
}

/// Returns two triangles with materials by variant.
fn varied(variant: Option<&str>) -> durer_formats::Result<Model> {
    let text = file(
        &triangle_bytes(),
        &format!(
            r#""accessors": [{ACCESSOR}], "scenes": [{{"nodes": [0]}}], "nodes": [{{"mesh": 0}}],
            "materials": [{{"name": "plain"}}, {{"name": "red"}}, {{"name": "blue"}}],
            "extensions": {{"KHR_materials_variants": {{"variants":
                [{{"name": "hot"}}, {{"name": "cold"}}, {{}}]}}}},
            "extensionsUsed": ["KHR_materials_variants"],
            "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}, "material": 0,
                "extensions": {{"KHR_materials_variants": {{"mappings": [
                    {{"material": 1, "variants": [0]}}, {{"material": 2, "variants": [1, 2]}}]}}}}}},
                {{"attributes": {{"POSITION": 0}}, "material": 0}}]}}]"#
        ),
    );
    let variant = variant.map(str::to_owned);
    gltf::read(text.as_bytes(), &NoResources, &ReadOptions { variant, ..ReadOptions::default() })
}

#[test]
fn variants_choose_materials() {
    let materials = |variant: Option<&str>| {
        let model = varied(variant).unwrap();
        assert_eq!(model.variants, ["hot", "cold", "variant2"]);
        assert!(model.warnings.is_empty(), "{:?}", model.warnings);
        [0, 1].map(|m| model.scene.meshes[m].parts[0].material.unwrap())
    };
    assert_eq!(materials(None), [0, 0]);
    assert_eq!(materials(Some("hot")), [1, 0]);
    assert_eq!(materials(Some("cold")), [2, 0]);
    assert_eq!(materials(Some("variant2")), [2, 0]);
    assert_eq!(materials(Some("0")), [1, 0]);
    let error = varied(Some("warm")).unwrap_err().to_string();
    assert!(
        error.ends_with("there is no variant `warm`; there are hot, cold, variant2"),
        "{error}"
    );
}

/// Returns a PNG of some texels in a row as a data URI, in percent notation.
fn picture(texels: &[[u8; 4]]) -> String {
    let image = Pixels::from_data(texels.len() as u32, 1, texels.to_vec()).unwrap();
    let mut bytes = Vec::new();
    png::write_color(&mut bytes, &image, png::Compression::Fast).unwrap();
    crate::gltf::uri(&bytes)
}

/// Returns a triangle with materials and the pictures that they use: texture i shows picture i.
fn painted(materials: &str, pictures: &[&[[u8; 4]]]) -> Model {
    let images: Vec<String> =
        pictures.iter().map(|p| format!(r#"{{"uri": "{}"}}"#, picture(p))).collect();
    let textures: Vec<String> =
        (0..pictures.len()).map(|i| format!(r#"{{"source": {i}}}"#)).collect();
    read(&triangle(&format!(
        r#""scenes": [{{"nodes": [0]}}], "nodes": [{{"mesh": 0}}], "materials": [{materials}],
        "images": [{}], "textures": [{}]"#,
        images.join(","),
        textures.join(",")
    )))
    .unwrap()
}

fn image(scene: &Scene, texture: Option<durer::scene::TextureRef>) -> &Image {
    &scene.images[scene.textures[texture.unwrap().texture].image]
}

#[test]
fn layers_of_materials_are_read() {
    let model = painted(
        r#"{"extensions": {"KHR_materials_ior": {"ior": 2.4},
            "KHR_materials_specular": {"specularFactor": 0.5, "specularColorFactor": [1, 0.5, 0]},
            "KHR_materials_clearcoat": {"clearcoatFactor": 0.75, "clearcoatRoughnessFactor": 0.25},
            "KHR_materials_sheen": {"sheenColorFactor": [0.25, 0.5, 1], "sheenRoughnessFactor": 0.5}}},
        {"extensions": {"KHR_materials_ior": {"ior": 0}, "KHR_materials_specular": {},
            "KHR_materials_clearcoat": {}, "KHR_materials_sheen": {}}}, {}"#,
        &[],
    );
    let [all, empty, none] = model.scene.materials.as_slice() else { panic!() };
    assert_eq!((all.ior, all.specular_strength), (2.4, 0.5));
    assert_eq!(all.specular_tint, Vec3::new(1.0, 0.5, 0.0));
    assert_eq!((all.clearcoat, all.clearcoat_roughness), (0.75, 0.25));
    assert_eq!((all.sheen_color, all.sheen_roughness), (Vec3::new(0.25, 0.5, 1.0), 0.5));
    assert!(empty.ior > 1e5);
    assert_eq!(Material { ior: 1.5, ..empty.clone() }, *none);
    assert!(model.warnings.is_empty(), "{:?}", model.warnings);
}

#[test]
fn textures_of_layers_count_by_their_mean() {
    let coat = r#"{"extensions": {"KHR_materials_clearcoat": {"clearcoatFactor": 0.5,
        "clearcoatTexture": {"index": 0}, "clearcoatRoughnessFactor": 1,
        "clearcoatRoughnessTexture": {"index": 0}, "clearcoatNormalTexture": {"index": 0}},
        "KHR_materials_sheen": {"sheenColorFactor": [1, 1, 1], "sheenColorTexture": {"index": 1}}}}"#;
    let model =
        painted(&format!("{coat}, {coat}"), &[&[[255, 51, 9, 255], [0, 0, 9, 255]], &[[188; 4]]]);
    let material = &model.scene.materials[1];
    assert_eq!(material.clearcoat, 0.25);
    assert!((material.clearcoat_roughness - 0.1).abs() < 1e-6);
    // An sRGB value of 188 is half of the light.
    assert!((material.sheen_color - Vec3::splat(0.5)).abs().max_element() < 0.005);
    let messages: Vec<String> = model.warnings.iter().map(ToString::to_string).collect();
    assert_eq!(
        messages,
        [
            "materials[0].extensions.KHR_materials_clearcoat: its texture is not laid on, its mean is taken (4 textures)",
            "materials[0].extensions.KHR_materials_clearcoat: its texture of normals is left out (2 textures)",
            "materials[0].extensions.KHR_materials_sheen: its texture is not laid on, its mean is taken (2 textures)",
        ]
    );
    assert!(model.scene.images.iter().all(|image| image.data.is_empty()));
}

#[test]
fn specular_glossiness_becomes_metal() {
    let model = painted(
        r#"{"pbrMetallicRoughness": {"metallicFactor": 0, "baseColorFactor": [0, 1, 0, 1]},
            "extensions": {"KHR_materials_pbrSpecularGlossiness": {"diffuseFactor": [0, 0, 0, 0.5],
            "specularFactor": [1, 0.76, 0.33], "glossinessFactor": 0.7}}},
        {"extensions": {"KHR_materials_pbrSpecularGlossiness": {"diffuseFactor": [0.96, 0.48, 0, 1],
            "specularFactor": [0.04, 0.04, 0.04], "glossinessFactor": 0}}}"#,
        &[],
    );
    let [gold, plastic] = model.scene.materials.as_slice() else { panic!() };
    assert_eq!(gold.model, ShadingModel::MetallicRoughness);
    assert!((gold.base_color - Vec4::new(1.0, 0.76, 0.33, 0.5)).abs().max_element() < 1e-6);
    let unlit = painted(
        r#"{"extensions": {"KHR_materials_unlit": {}, "KHR_materials_pbrSpecularGlossiness":
            {"diffuseFactor": [0, 1, 0, 0.5]}, "KHR_materials_transmission": {"transmissionFactor": 1}}}"#,
        &[],
    );
    let unlit = &unlit.scene.materials[0];
    assert_eq!((unlit.model, unlit.alpha_mode), (ShadingModel::Unlit, AlphaMode::Opaque));
    assert_eq!(unlit.base_color, Vec4::new(0.0, 1.0, 0.0, 0.5));
    assert!(gold.metallic > 1.0 - 1e-6 && (gold.roughness - 0.3).abs() < 1e-6);
    assert!(plastic.metallic < 1e-6 && plastic.roughness == 1.0);
    assert!((plastic.base_color.x - 0.96).abs() < 1e-5);
}

#[test]
fn specular_glossiness_textures_become_those_of_metal() {
    let glossy = |placed: &str| {
        format!(
            r#"{{"extensions": {{"KHR_materials_pbrSpecularGlossiness": {{
            "diffuseTexture": {{"index": 0}}, "specularGlossinessTexture": {{"index": 1 {placed}}}}}}}}}"#
        )
    };
    let dark: [u8; 4] = [0, 0, 0, 255];
    let (diffuse, specular) =
        ([dark, [200, 100, 50, 128]], [[255, 226, 155, 191], [0, 0, 0, 0], dark, dark]);
    let one = glossy("");
    let model =
        painted(&format!("{one}, {one}, {}", glossy(r#", "texCoord": 1"#)), &[&diffuse, &specular]);
    let [a, b, other] = model.scene.materials.as_slice() else { panic!() };
    let (base, rough) = (a.base_color_texture, a.metallic_roughness_texture);
    assert_eq!((b.base_color_texture, b.metallic_roughness_texture), (base, rough));
    // Twice as wide as the diffuse picture.
    let (base, rough) = (image(&model.scene, base), image(&model.scene, rough));
    assert_eq!((base.width, base.height, rough.width), (4, 1, 4));
    assert_eq!((base.data[0], rough.data[0]), ([255, 226, 155, 255], [255, 64, 255, 255]));
    assert_eq!((rough.data[1][1], rough.data[1][2]), (255, 0));
    assert_eq!(base.data[3][3], 128);
    assert_eq!((a.metallic, a.roughness, a.base_color), (1.0, 1.0, Vec4::ONE));
    // Two textures with different placements cannot be combined texel by texel.
    assert!(other.base_color_texture.unwrap().texture != a.base_color_texture.unwrap().texture);
    assert_eq!(model.warnings.len(), 1, "{:?}", model.warnings);
    assert!(model.warnings[0].message.contains("has other coordinates"), "{:?}", model.warnings);
    // An unreadable picture makes no mirror.
    let text = triangle(
        r#""nodes": [{"mesh": 0}], "images": [{"uri": "none.png"}], "textures": [{"source": 0}],
        "materials": [{"extensions": {"KHR_materials_pbrSpecularGlossiness":
            {"specularGlossinessTexture": {"index": 0}}}}]"#,
    );
    let material = &scene(&text).materials[0];
    assert_eq!((material.metallic, material.roughness), (0.0, 0.5));
}

#[test]
fn what_transmits_light_is_blended() {
    let glass = |more: &str| {
        format!(
            r#"{{"extensions": {{"KHR_materials_transmission": {{"transmissionFactor": 1 {more}}}}}"#
        )
    };
    let factor =
        |members: &str| format!(r#""pbrMetallicRoughness": {{"metallicFactor": 0, {members}}}"#);
    let (clear, masked) = (glass(""), glass(r#", "transmissionTexture": {"index": 1}"#));
    let (white, black) = (
        factor(r#""baseColorFactor": [1, 1, 1, 0.5]"#),
        factor(r#""baseColorFactor": [0, 0, 0, 1]"#),
    );
    let textured = factor(r#""baseColorTexture": {"index": 0}"#);
    let metal = r#""pbrMetallicRoughness": {"metallicFactor": 1}"#;
    let model = painted(
        &format!(
            r#"{clear}, {white}}}, {clear}, {black}}}, {clear}, "alphaMode": "BLEND", {white}}},
            {clear}, {metal}}}, {masked}, {textured}}}"#
        ),
        &[
            &[[255, 255, 255, 100], [0, 0, 0, 100]],
            &[[255, 0, 0, 255], [255, 0, 0, 255], [0; 4], [0; 4]],
        ],
    );
    let [white, black, blended, metal, textured] = model.scene.materials.as_slice() else {
        panic!()
    };
    assert!(model.scene.materials.iter().all(|m| m.alpha_mode == AlphaMode::Blend));
    let near = |a: f32, b: f32| assert!((a - b).abs() < 1e-6, "{a} {b}");
    near(white.base_color.w, 0.15);
    near(black.base_color.w, 1.0);
    near(blended.base_color.w, 0.075);
    near(metal.base_color.w, 1.0);
    near(white.transmission, 1.0);
    near(textured.transmission, 0.5);
    // Where the mask is red, white glass is clear and black glass absorbs everything; elsewhere the material stays
    // opaque.
    let texels = &image(&model.scene, textured.base_color_texture).data;
    assert_eq!(texels.iter().map(|t| t[3]).collect::<Vec<_>>(), [38, 38, 255, 255]);
    assert!(model.warnings.is_empty(), "{:?}", model.warnings);
}

#[test]
fn webp_is_taken_before_what_stands_in_for_it() {
    let text = |textures: &str| {
        triangle(&format!(
            r#""scenes": [{{"nodes": [0]}}], "nodes": [{{"mesh": 0}}], "textures": [{textures}],
            "images": [{{"uri": "{}"}}, {{"uri": "{}"}}], "extensionsUsed": ["KHR_texture_basisu"],
            "extensionsRequired": ["EXT_texture_webp", "KHR_texture_basisu"],
            "materials": [{{"emissiveTexture": {{"index": 0}}}}]"#,
            picture(&[[1, 2, 3, 255]]),
            picture(&[[4, 5, 6, 255]])
        ))
    };
    let shown = |textures: &str| {
        let model = read(&text(textures)).unwrap();
        let image = image(&model.scene, model.scene.materials[0].emissive_texture).clone();
        (image.data, model.warnings.iter().map(ToString::to_string).collect::<Vec<_>>())
    };
    let webp = r#"{"source": 0, "extensions": {"EXT_texture_webp": {"source": 1}}}"#;
    assert_eq!(shown(webp), (vec![[4, 5, 6, 255]], vec![]));
    let fallback = r#"{"source": 0, "extensions": {"KHR_texture_basisu": {"source": 1}}}"#;
    assert_eq!(shown(fallback), (vec![[1, 2, 3, 255]], vec![]));
    let (data, messages) = shown(r#"{"extensions": {"KHR_texture_basisu": {"source": 1}}}"#);
    assert!(data.is_empty() && messages.len() == 1, "{messages:?}");
    assert!(
        messages[0].starts_with("textures[0]: KTX 2 (KHR_texture_basisu) is not decoded"),
        "{messages:?}"
    );
    let wrong = text(r#"{"source": 0, "extensions": {"EXT_texture_webp": {"source": 7}}}"#);
    assert!(
        read(&wrong)
            .unwrap_err()
            .to_string()
            .starts_with("textures[0].extensions.EXT_texture_webp")
    );
}

#[test]
fn only_extensions_that_change_the_picture_are_reported() {
    let messages = |name: &str| {
        let scene = r#""scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}]"#;
        let used = format!(r#"{scene}, "extensionsUsed": ["{name}"]"#);
        let model = read(&triangle(&used)).unwrap();
        model.warnings.iter().map(ToString::to_string).collect::<String>()
    };
    for silent in
        ["VRMC_springBone", "KHR_physics_rigid_bodies", "EXT_structural_metadata", "MSFT_lod"]
    {
        assert_eq!(messages(silent), "", "{silent}");
    }
    for (name, effect) in [
        ("VRMC_materials_mtoon", "toon materials are drawn as ordinary ones"),
        ("KHR_gaussian_splatting", "splats are drawn as points"),
        ("KHR_materials_anisotropy", "drawn without its effect"),
        ("ACME_new", "drawn without what it adds"),
    ] {
        assert_eq!(messages(name), format!("extensionsUsed: {name} is not read; {effect}"));
    }
}
