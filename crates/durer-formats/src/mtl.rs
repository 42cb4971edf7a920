//! The material library of Wavefront OBJ.
//!
//! Source: *Wavefront Advanced Visualizer Manual*, appendix B5, and the PBR statements (`Pr`, `Pm`,
//! `Ke`, `norm` …) that Exocortex proposed in 2014. Nothing here is an error: what is missing or
//! wrong in a material is a warning, and the model is shown all the same.
//!
//! What becomes what: `Kd` and `map_Kd` the base color, `Ks`, `map_Ks` and `Ns` Blinn's highlight
//! (none where `Ks` is missing or `illum` is 1), `Ke` and `map_Ke` the emission, `d` or 1 − `Tr` and
//! `map_d` the alpha (blended), `norm` the tangent-space normals; `Pr`, `Pm`, `map_Pr`, `map_Pm` make
//! the material metallic-roughness. `illum 0` is unlit. `Ka`, `Ni`, `Tf` and reflection maps have no
//! counterpart and are left out; bump maps too, with a warning. Colors are sRGB values.

mod convert;
mod image;
mod parse;
mod pictures;

use crate::{Model, Place, ReadOptions, Resources, text};
use durer::scene::Material;
use image::Images;
use parse::{Library, Statements};
pub(crate) use pictures::add_pictures;

/// Fills `model.scene.materials` with one material per name in `names`, in their order, from the
/// libraries that `mtllib` statements name (line, operand).
pub(crate) fn load(
    model: &mut Model,
    libraries: &[(u64, String)],
    names: &[String],
    resources: &dyn Resources,
    options: &ReadOptions,
) {
    let mut all = Library::default();
    for (line, operand) in libraries {
        read_libraries(model, &mut all, Place::Line(*line, 0), operand, resources, options);
    }
    let mut images = Images::new(resources, options.limits);
    for name in names {
        let material = match all.find(name) {
            Some(statements) => convert::material(model, &mut images, name, statements),
            None => {
                if !libraries.is_empty() || !name.is_empty() {
                    let message = format!("material `{name}` is not defined; a grey one is used");
                    model.warn(Place::Whole, message);
                }
                Material { name: name.clone(), ..Material::default() }
            }
        };
        model.scene.materials.push(material);
    }
}

/// Reads what one `mtllib` names: one file whose name may hold blanks, or else several.
fn read_libraries(
    model: &mut Model,
    all: &mut Library,
    place: Place,
    operand: &str,
    resources: &dyn Resources,
    options: &ReadOptions,
) {
    let limit = options.limits.decoded_bytes;
    let words: Vec<&str> = operand.split_ascii_whitespace().collect();
    let whole = resources.read(&relative(operand), limit);
    if words.len() < 2 || whole.is_ok() {
        return read_library(model, all, place, operand, whole);
    }
    for word in words {
        read_library(model, all, place.clone(), word, resources.read(&relative(word), limit));
    }
}

fn read_library(
    model: &mut Model,
    all: &mut Library,
    place: Place,
    name: &str,
    bytes: Result<Vec<u8>, String>,
) {
    match bytes {
        Ok(bytes) => all.read(model, name, &text::utf8(&bytes)),
        Err(why) => model.warn(place, format!("cannot read the material library `{name}`: {why}")),
    }
}

/// The path as [`Resources`] wants it: `/` between folders, no `./`; of an absolute path, which
/// was right on the writer's machine only, the file's name.
fn relative(path: &str) -> String {
    let path = path.trim_matches('"').replace('\\', "/");
    let drive = path.as_bytes().get(1) == Some(&b':');
    if path.starts_with('/') || drive {
        return path.rsplit(['/', ':']).next().unwrap_or_default().to_owned();
    }
    path.split('/').filter(|piece| !matches!(*piece, "" | ".")).collect::<Vec<_>>().join("/")
}

impl Library {
    fn find(&self, name: &str) -> Option<&Statements> {
        self.materials.get(name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ReadOptions;
    use durer::math::Vec3;
    use durer::scene::{AlphaMode, ShadingModel, Wrap};

    /// Files in memory.
    struct Files(Vec<(&'static str, Vec<u8>)>);

    impl Resources for Files {
        fn read(&self, path: &str, _limit: u64) -> Result<Vec<u8>, String> {
            let found = self.0.iter().find(|(name, _)| *name == path);
            found.map(|(_, bytes)| bytes.clone()).ok_or_else(|| "no such file".to_owned())
        }
    }

    fn png(width: u32, height: u32, rgba: &[u8]) -> Vec<u8> {
        let mut bytes = Vec::new();
        let mut encoder = ::png::Encoder::new(&mut bytes, width, height);
        encoder.set_color(::png::ColorType::Rgba);
        encoder.set_depth(::png::BitDepth::Eight);
        let mut writer = encoder.write_header().expect("header");
        writer.write_image_data(rgba).expect("data");
        writer.finish().expect("end");
        bytes
    }

    fn loaded(mtl: &str, names: &[&str], files: Vec<(&'static str, Vec<u8>)>) -> Model {
        let mut files = Files(files);
        files.0.push(("a b.mtl", mtl.as_bytes().to_vec()));
        let mut model = Model::default();
        let names: Vec<String> = names.iter().map(|n| (*n).to_owned()).collect();
        let libraries = [(1, "a b.mtl".to_owned())];
        load(&mut model, &libraries, &names, &files, &ReadOptions::default());
        model
    }

    #[test]
    fn colors_alpha_and_highlights() {
        let mtl = "newmtl glass pane\r\nKd 0.5 1 0\r\nKs 1 1 1\nNs 20\nd 0.25\nKe 0 0 1\n\
                   newmtl m\nKd 1 1 1\nPr 0.25\nPm 1\nnewmtl flat\nillum 0\nTr 0.5";
        let model = loaded(mtl, &["glass pane", "m", "flat", "none"], vec![]);
        let [glass, metal, flat, none] = &model.scene.materials[..] else { panic!("four") };
        assert!((glass.base_color.x - 0.2140).abs() < 1e-3 && glass.base_color.w == 0.25);
        assert_eq!((glass.alpha_mode, glass.shininess), (AlphaMode::Blend, 20.0));
        assert_eq!((glass.specular, glass.emissive), (Vec3::ONE, Vec3::Z));
        assert_eq!(metal.model, ShadingModel::MetallicRoughness);
        assert_eq!((metal.roughness, metal.metallic), (0.25, 1.0));
        assert_eq!((flat.model, flat.base_color.w), (ShadingModel::Unlit, 0.5));
        assert_eq!(none.name, "none");
        assert_eq!(model.warnings.len(), 1, "{:?}", model.warnings);
    }

    #[test]
    fn textures_with_options_are_decoded_once() {
        let image = png(1, 2, &[255, 0, 0, 255, 0, 0, 255, 255]);
        let mtl = "newmtl a\nmap_Kd -s 2 3 -o 0.25 0.5 -clamp on .\\my pic.png\n\
                   newmtl b\nKd 0 0 0\nmap_Kd my pic.png\nmap_Bump x.png\nmap_Ks gone.png";
        let model = loaded(mtl, &["a", "b"], vec![("my pic.png", image)]);
        assert_eq!((model.scene.images.len(), model.scene.textures.len()), (1, 2));
        let texture = model.scene.materials[0].base_color_texture.expect("texture");
        assert_eq!(model.scene.textures[texture.texture].sampler.wrap_u, Wrap::ClampToEdge);
        // v = 1 (top in the file's sense) is 0 here: u' = 2u + 0.25, v' = 3v + 0.5 from below.
        let uv = texture.transform.transform_point2(durer::math::DVec2::new(0.5, 1.0));
        assert_eq!((uv.x, uv.y), (1.25, 0.5));
        assert_eq!(model.scene.materials[1].base_color.x, 1.0);
        assert_eq!(model.warnings.len(), 2, "{:?}", model.warnings);
    }

    #[test]
    fn separate_maps_are_joined() {
        let grey = |v: u8| png(1, 1, &[v, v, v, 255]);
        let mtl = "newmtl a\nmap_Kd kd.png\nmap_d d.png\nmap_Pr r.png\nmap_Pm m.png";
        let files = vec![
            ("kd.png", png(2, 1, &[1, 2, 3, 255, 4, 5, 6, 255])),
            ("d.png", grey(77)),
            ("r.png", grey(10)),
            ("m.png", grey(20)),
        ];
        let model = loaded(mtl, &["a"], files);
        let material = &model.scene.materials[0];
        let image = |t: Option<durer::scene::TextureRef>| {
            let texture = model.scene.textures[t.expect("texture").texture];
            model.scene.images[texture.image].data.clone()
        };
        assert_eq!(image(material.base_color_texture), [[1, 2, 3, 77], [4, 5, 6, 77]]);
        assert_eq!(image(material.metallic_roughness_texture), [[255, 10, 20, 255]]);
        assert_eq!(material.alpha_mode, AlphaMode::Blend);
        assert!(model.warnings.is_empty(), "{:?}", model.warnings);
    }

    #[test]
    fn foreign_paths_are_made_relative() {
        for (path, expected) in [
            (r".\a\b.png", "a/b.png"),
            (r"C:\maps\x.png", "x.png"),
            ("/etc/shadow", "shadow"),
            ("../x.png", "../x.png"),
            ("\"a b.png\"", "a b.png"),
        ] {
            assert_eq!(relative(path), expected);
        }
    }

    #[test]
    fn nonsense_is_warned_about() {
        let model =
            loaded("Kd 1 1 1\nnewmtl a\nKd x\nKd spectral f.rfl\nd\nmap_Kd\n\0\0", &["a"], vec![]);
        assert_eq!(model.scene.materials.len(), 1);
        assert!(model.warnings.len() >= 4, "{:?}", model.warnings);
    }
}
