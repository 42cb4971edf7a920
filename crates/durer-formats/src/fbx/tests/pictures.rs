//! Materials and their pictures.

use super::*;

/// Returns a picture of one pixel, as BMP.
fn pixel([r, g, b]: [u8; 3]) -> Vec<u8> {
    let mut bytes = b"BM".to_vec();
    for word in [58u32, 0, 54, 40, 1, 1, 1 | 24 << 16, 0, 4, 0, 0, 0, 0] {
        bytes.extend(word.to_le_bytes());
    }
    bytes.extend([b, g, r, 0]);
    bytes
}

/// Pictures by name, in colours that distinguish them.
struct Folder;

impl Resources for Folder {
    fn read(&self, path: &str, _: u64) -> std::result::Result<Vec<u8>, String> {
        match path {
            "tex/a.bmp" => Ok(pixel([255, 0, 0])),
            "b.bmp" => Ok(pixel([0, 255, 0])),
            "grey.bmp" => Ok(pixel([64, 64, 64])),
            "normal.bmp" => Ok(pixel([128, 128, 255])),
            _ => Err("not there".to_owned()),
        }
    }
}

fn texture(id: u32, path: &str, more: &str) -> String {
    format!(
        "Texture: {id}, \"Texture::t{id}\", \"\" {{ Type: \"TextureVideoClip\"\nFileName: \"/x/{path}\"\n\
         RelativeFilename: \"{path}\"\nProperties70: {{ {more} }} }}\n"
    )
}

/// Returns the model of a material with these properties and textures.
fn shaded(properties: &str, textures: &[(&str, &str, &str)], creator: &str) -> Model {
    let mut objects = format!("{}{}", node(2, "Mesh", ""), material(8, properties));
    let mut joined = vec![(2, 0, ""), (1, 2, ""), (8, 2, "")];
    for (id, (path, property, more)) in (20..).zip(textures) {
        objects += &texture(id, path, more);
        joined.push((id, 8, property));
    }
    let text = file(SETTINGS, &objects, &joined);
    let text =
        text.replace("FBXVersion: 7400\n", &format!("FBXVersion: 7400\nCreator: \"{creator}\"\n"));
    read_with(&text, &Folder, Limits::default()).expect("readable")
}

#[test]
fn phong_has_colors_highlights_and_opacity() {
    let color = |name, v: f64| vectors(&[(name, [v, v, v])]);
    let lit = [
        color("DiffuseColor", 1.0),
        number("DiffuseFactor", 0.5),
        color("EmissiveColor", 1.0),
        number("EmissiveFactor", 0.25),
        color("SpecularColor", 1.0),
        number("SpecularFactor", 0.5),
        number("ShininessExponent", 40.0),
    ]
    .concat();
    let model = shaded(&lit, &[], "");
    let m = &model.scene.materials[0];
    assert_eq!((m.name.as_str(), m.model, m.shininess), ("m8", ShadingModel::Phong, 40.0));
    assert_eq!(
        (m.base_color, m.emissive, m.specular),
        (Vec4::new(0.5, 0.5, 0.5, 1.0), Vec3::splat(0.25), Vec3::splat(0.5))
    );
    for (properties, alpha, mode) in [
        (number("Opacity", 0.25), 0.25, AlphaMode::Blend),
        (
            color("TransparentColor", 0.5) + &number("TransparencyFactor", 0.5),
            0.75,
            AlphaMode::Blend,
        ),
        (color("TransparentColor", 0.5) + &number("Opacity", 1.0), 1.0, AlphaMode::Opaque),
        (String::new(), 1.0, AlphaMode::Opaque),
    ] {
        let model = shaded(&properties, &[], "");
        let m = &model.scene.materials[0];
        assert_eq!((m.base_color.w, m.alpha_mode), (alpha, mode), "{properties}");
        assert_eq!(warnings(&model), Vec::<String>::new());
    }
    let none =
        shaded(&(color("TransparentColor", 1.0) + &number("TransparencyFactor", 1.0)), &[], "");
    assert_eq!(none.scene.materials[0].base_color.w, 1.0);
    assert!(warnings(&none)[0].starts_with("m8: 1 material is wholly transparent"));
}

#[test]
fn pictures_are_found_beside_the_file() {
    for (path, found) in [
        ("tex\\\\a.bmp", [255, 0, 0]),
        ("C:\\\\work\\\\b.bmp", [0, 255, 0]),
        ("../far/b.bmp", [0, 255, 0]),
    ] {
        let model = shaded("", &[(path, "DiffuseColor", "")], "");
        assert_eq!(warnings(&model), Vec::<String>::new(), "{path}");
        let [image] = &model.scene.images[..] else { panic!("one picture") };
        assert_eq!(image.data[0][..3], found, "{path}");
        assert_eq!(model.scene.materials[0].base_color, Vec4::ONE);
    }
    let model = shaded("", &[("none.bmp", "DiffuseColor", "")], "");
    assert!(
        warnings(&model)[0].contains("texture `none.bmp` is left out"),
        "{:?}",
        warnings(&model)
    );
    let repeated = "P: \"WrapModeU\", \"enum\", \"\", \"\",1\nP: \"UVSet\", \"KString\", \"\", \"\", \"second\"\n".to_owned()
        + &vectors(&[("Scaling", [0.5, 0.25, 1.0]), ("Translation", [0.0, 0.25, 0.0])]);
    let model = shaded("", &[("b.bmp", "DiffuseColor", &repeated)], "");
    let placed = model.scene.materials[0].base_color_texture.expect("a texture");
    assert_eq!(placed.tex_coord, 1);
    // The picture fills half the width, and in height the range from 1/4 to 1/2.
    let at = |u: f64, v: f64| placed.transform * DVec3::new(u, 1.0 - v, 1.0);
    near(at(0.0, 0.25), DVec3::new(0.0, 1.0, 1.0));
    near(at(0.5, 0.5), DVec3::new(1.0, 0.0, 1.0));
    let sampler = model.scene.textures[0].sampler;
    assert_ne!(sampler.wrap_u, sampler.wrap_v);
}

#[test]
fn pictures_in_the_file_go_before_others() {
    let video = "Video: 30, \"Video::v\", \"Clip\" { Type: \"Clip\"\nRelativeFilename: \"b.bmp\"\nContent: , \"CONTENT\" }\n";
    let base64 = |bytes: &[u8]| {
        let digits = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
        let group = |g: &[u8]| {
            let bits =
                (0..3).fold(0u32, |bits, i| bits << 8 | u32::from(g.get(i).copied().unwrap_or(0)));
            let digit = |i: usize| {
                if i <= g.len() {
                    digits[(bits >> (18 - 6 * i) & 63) as usize] as char
                } else {
                    '='
                }
            };
            (0..4).map(digit).collect::<String>()
        };
        bytes.chunks(3).map(group).collect::<String>()
    };
    let objects = [
        node(2, "Mesh", ""),
        material(8, ""),
        texture(20, "b.bmp", ""),
        video.replace("CONTENT", &base64(&pixel([1, 2, 3]))),
    ]
    .concat();
    let joined = [(2, 0, ""), (1, 2, ""), (8, 2, ""), (20, 8, "DiffuseColor"), (30, 20, "")];
    let model = read_with(&file(SETTINGS, &objects, &joined), &Folder, Limits::default())
        .expect("readable");
    assert_eq!(model.scene.images[0].data[0], [1, 2, 3, 255]);
    let few = Limits { image_side: 0, ..Limits::default() };
    let model = read_with(&file(SETTINGS, &objects, &joined), &Folder, few).expect("readable");
    assert!(warnings(&model)[0].contains("is left out"));
}

#[test]
fn pictures_of_opacity_and_normals() {
    let model =
        shaded("", &[("b.bmp", "DiffuseColor", ""), ("grey.bmp", "TransparentColor", "")], "");
    let m = &model.scene.materials[0];
    let shown = m.base_color_texture.expect("a texture");
    let image = &model.scene.images[model.scene.textures[shown.texture].image];
    assert_eq!((image.data[0], m.alpha_mode), ([0, 255, 0, 191], AlphaMode::Blend));
    let bump = |path| shaded("", &[(path, "Bump", "")], "");
    assert!(bump("normal.bmp").scene.materials[0].normal_texture.is_some());
    let height = bump("grey.bmp");
    assert!(height.scene.materials[0].normal_texture.is_none());
    assert!(
        warnings(&height)[0].starts_with("m8: 1 bump maps show heights"),
        "{:?}",
        warnings(&height)
    );
}

#[test]
fn blenders_materials_are_physical_and_linear() {
    let blender = "Blender (stable FBX IO) - 4.0.2 - 5.8.12";
    let properties = vectors(&[("DiffuseColor", [0.5, 0.25, 1.0])])
        + &number("Shininess", 25.0)
        + &number("ReflectionFactor", 0.75);
    let model = shaded(&properties, &[], blender);
    let m = &model.scene.materials[0];
    assert_eq!((m.model, m.roughness, m.metallic), (ShadingModel::MetallicRoughness, 0.5, 0.75));
    assert_eq!(m.base_color, Vec4::new(0.5, 0.25, 1.0, 1.0));
    let mapped = shaded(&properties, &[("grey.bmp", "Shininess", "")], blender);
    let m = &mapped.scene.materials[0];
    assert_eq!((m.roughness, m.metallic), (1.0, 0.75));
    assert_eq!(mapped.scene.images[0].data[0], [255, 64, 255, 255]);
}
