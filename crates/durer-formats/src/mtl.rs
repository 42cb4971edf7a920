//! The material library of Wavefront OBJ.
//!
//! Source: *Wavefront Advanced Visualizer Manual*, appendix B5, and the PBR statements (`Pr`, `Pm`, `Ke`, `norm` …)
//! that Exocortex proposed in 2014. There are no errors: missing or wrong data in a material give a warning, and the
//! model is shown nevertheless.
//!
//! Correspondence: `Kd` and `map_Kd` the base color, `Ks`, `map_Ks` and `Ns` Blinn's highlight
//! (none if `Ks` is missing, `illum` is 1, or `Ns` below 1), `Ke` and `map_Ke` the emission, `d` or
//! 1 − `Tr` and `map_d` the alpha (blended), `norm` the tangent-space normals; `Pr`, `Pm`, `map_Pr`,
//! `map_Pm` make the material metallic-roughness. `illum 0` is unlit, and other numbers make nothing
//! transparent. `Ka`, `Ni`, `Tf` and reflection maps have no counterpart and are left out; bump maps too,
//! with a warning, unless they show normals. Colors are sRGB values; those up to 255 are scaled.
//!
//! `Tr 1` without `d` is opaque, as in MeshLab, OpenMVS and mvs-texturing, because an invisible model is of no use. If
//! libraries have `Tr 1` and never `Tr 0`, `Tr` is the opacity of all materials.

mod convert;
pub(crate) mod image;
mod notes;
mod parse;
mod pictures;

use crate::uri::steps;
use crate::{Found, Model, Place, ReadOptions, Resources, text};
use durer::scene::Material;
use image::Images;
use notes::Notes;
use parse::{Library, Statements};
use std::collections::HashSet;

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
    // Some writers name the library for each object; the first time is enough, as is the first of two
    // materials with one name.
    let mut seen = HashSet::new();
    for (line, operand) in libraries.iter().filter(|(_, operand)| seen.insert(operand)) {
        read_libraries(model, &mut all, Place::Line(*line, 0), operand, resources, options);
    }
    let mut images = Images::new(resources, options.limits.clone());
    let mut notes = Notes { tr_is_opacity: all.tr_is_opacity, ..Notes::default() };
    for name in names {
        let material = match all.find(name) {
            Some(m) => convert::material(model, &mut images, &mut notes, name, m),
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
    notes.warn(model);
}

/// Reads the libraries named by an `mtllib`: one file whose name may contain blanks, or else several.
fn read_libraries(
    model: &mut Model,
    all: &mut Library,
    place: Place,
    operand: &str,
    resources: &dyn Resources,
    options: &ReadOptions,
) {
    let limit = options.limits.decoded_bytes;
    let names = names(operand);
    let whole = resources.find(&relative(operand), limit);
    if names.len() < 2 || whole.is_ok() {
        return read_library(model, all, place, operand, whole);
    }
    for name in &names {
        read_library(model, all, place.clone(), name, resources.find(&relative(name), limit));
    }
}

/// Returns the names of several libraries: each ends with `.mtl`, or where none does, with a blank.
fn names(operand: &str) -> Vec<String> {
    let words = operand.split_ascii_whitespace();
    let ends = |word: &&str| word.to_ascii_lowercase().ends_with(".mtl");
    if !words.clone().any(|word| ends(&word)) {
        return words.map(str::to_owned).collect();
    }
    let words: Vec<&str> = words.collect();
    words.split_inclusive(ends).map(|words| words.join(" ")).collect()
}

fn read_library(
    model: &mut Model,
    all: &mut Library,
    place: Place,
    name: &str,
    found: Result<Found, String>,
) {
    match found {
        Ok(Found { bytes, note }) => {
            if let Some(note) = note {
                model.warn(place, format!("the material library `{name}`: {note}"));
            }
            all.read(model, name, &text::utf8(&bytes));
        }
        Err(why) => model.warn(place, format!("cannot read the material library `{name}`: {why}")),
    }
}

/// Returns the path in the form for [`Resources`]: `/` between folders, no `./`; for an absolute path, which was valid
/// only on the writer's machine, the file's name.
fn relative(path: &str) -> String {
    let path = path.trim_matches('"').replace('\\', "/");
    let drive = path.as_bytes().get(1) == Some(&b':');
    if path.starts_with('/') || drive {
        return path.rsplit(['/', ':']).next().unwrap_or_default().to_owned();
    }
    steps(&path).join("/")
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

    fn alphas(mtl: &str, names: &[&str]) -> (Vec<f32>, Vec<String>) {
        let model = loaded(mtl, names, vec![]);
        let alphas = model.scene.materials.iter().map(|m| m.base_color.w).collect();
        (alphas, model.warnings.iter().map(ToString::to_string).collect())
    }

    #[test]
    fn dissolve_beats_transparency_and_transparency_alone_hides_nothing() {
        for mtl in ["newmtl m\nd 1\nTr 1", "newmtl m\nTr 1\nd 1.0", "newmtl m\nTr 0"] {
            assert_eq!(alphas(mtl, &["m"]), (vec![1.0], vec![]), "{mtl}");
        }
        assert_eq!(alphas("newmtl m\nTr 0.75\nd 0.25", &["m"]).0, [0.25]);
        assert_eq!(alphas("newmtl m\nTr 0.25", &["m"]), (vec![0.75], vec![]));
        let (alpha, warnings) = alphas("newmtl m\nTr 1.0", &["m"]);
        assert!(alpha == [1.0] && warnings[0].contains("`m`: `Tr` without `d`"), "{warnings:?}");
        // All materials of a file use `Tr` in the same sense; if one of them is 0, it is the manual's.
        let (alpha, warnings) = alphas("newmtl a\nTr 1\nnewmtl b\nTr 0.25", &["a", "b"]);
        assert!(alpha == [1.0, 0.25] && warnings[0].starts_with("2 materials"), "{warnings:?}");
        let (alpha, _) =
            alphas("newmtl a\nTr 1\nnewmtl b\nTr 0.25\nnewmtl c\nTr 0", &["a", "b", "c"]);
        assert_eq!(alpha, [1.0, 0.75, 1.0]);
        let (alpha, warnings) = alphas("newmtl m\nd 0", &["m"]);
        assert!(alpha == [0.0] && warnings[0].contains("`m`: wholly transparent (`d 0`)"));
    }

    #[test]
    fn exponents_below_one_make_no_highlight() {
        let mtl = "newmtl a\nKd .8 .3 .2\nKs .8 .8 .8\nNs 0\nillum 2\nnewmtl b\nKs 1 1 1\nNs 1";
        let model = loaded(mtl, &["a", "b"], vec![]);
        let speculars: Vec<Vec3> = model.scene.materials.iter().map(|m| m.specular).collect();
        assert_eq!(speculars, [Vec3::ZERO, Vec3::ONE]);
    }

    #[test]
    fn colors_up_to_255_are_scaled() {
        let mtl = "newmtl a\nKd 255 51 0\nKs 0.5 0.5 0.5\nKe 0 0 255\n\
                   newmtl b\nKa 20 20 20\nKd 1.2 1 1\nKe 20 0 0";
        let model = loaded(mtl, &["a", "b"], vec![]);
        let [a, b] = &model.scene.materials[..] else { panic!("two") };
        let expected = crate::color::linear3([1.0, 0.2, 0.0]);
        assert!((a.base_color.truncate() - expected).length() < 1e-6);
        assert_eq!((a.emissive, b.emissive.x > 100.0, b.base_color.x > 1.0), (Vec3::Z, true, true));
        assert!((a.specular.x - 0.214).abs() < 1e-3);
        assert_eq!(model.warnings.len(), 1, "{:?}", model.warnings);
        assert!(model.warnings[0].message.contains("`a`: colors go up to 255"));
    }

    #[test]
    fn bump_maps_that_show_normals_are_normal_maps() {
        let blue = png(2, 1, &[128, 128, 255, 255, 140, 110, 240, 255]);
        let brown = png(2, 1, &[200, 150, 100, 255, 90, 60, 30, 255]);
        let mtl = "newmtl a\nmap_Bump -bm 0.5 n.png\nnewmtl b\nbump h.png\n\
                   newmtl c\nnorm n.png\nbump h.png\nnewmtl d\nbump my_bump.png";
        let files = vec![("n.png", blue.clone()), ("h.png", brown), ("my_bump.png", blue)];
        let model = loaded(mtl, &["a", "b", "c", "d"], files);
        let maps: Vec<bool> =
            model.scene.materials.iter().map(|m| m.normal_texture.is_some()).collect();
        assert_eq!(maps, [true, false, true, false]);
        assert_eq!(model.scene.materials[0].normal_scale, 0.5);
        let [warning] = &model.warnings[..] else { panic!("{:?}", model.warnings) };
        assert!(warning.message.starts_with("2 materials, the first `b`: bump maps"));
    }

    #[test]
    fn a_map_of_alpha_has_it_in_one_channel_for_all_pixels() {
        let mtl = "newmtl a\nmap_d d.png\nKd 1 0 0";
        // Opaque black and half-transparent white: the second shows that the first's grey is not a default.
        let files = vec![("d.png", png(2, 1, &[0, 0, 0, 255, 255, 255, 255, 128]))];
        let model = loaded(mtl, &["a"], files);
        assert_eq!(model.scene.images[0].data, [[255, 255, 255, 255], [255, 255, 255, 128]]);
        assert_eq!(model.scene.materials[0].base_color.x, 1.0);
    }

    #[test]
    fn names_are_found_with_blanks_and_in_latin_1() {
        assert_eq!(names("a b.mtl c.MTL"), ["a b.mtl", "c.MTL"]);
        assert_eq!(names("a b"), ["a", "b"]);
        let mut model = Model::default();
        let files =
            Files(vec![("x.mtl", b"newmtl Gr\xfcn\nKd 0 1 0\nmap_Kd Bl\xe4tt.png".to_vec())]);
        let libraries = [(1, "y z.mtl x.mtl".to_owned())];
        load(&mut model, &libraries, &["Grün".to_owned()], &files, &ReadOptions::default());
        assert_eq!(model.scene.materials[0].base_color.y, 1.0);
        let words: Vec<String> = model.warnings.iter().map(ToString::to_string).collect();
        assert!(words[0].contains("`y z.mtl`") && words[1].contains("`Blätt.png`"), "{words:?}");
    }

    #[test]
    fn a_library_that_is_named_again_is_read_once() {
        struct Counting(std::cell::Cell<usize>);
        impl Resources for Counting {
            fn read(&self, _path: &str, _limit: u64) -> Result<Vec<u8>, String> {
                self.0.set(self.0.get() + 1);
                Ok(b"newmtl m\nKd 1 0 0\n".to_vec())
            }
        }
        let (files, mut model) = (Counting(0.into()), Model::default());
        let libraries: Vec<(u64, String)> = (1..1000).map(|i| (i, "a.mtl".to_owned())).collect();
        load(&mut model, &libraries, &["m".to_owned()], &files, &ReadOptions::default());
        assert_eq!((files.0.get(), model.scene.materials[0].base_color.x), (1, 1.0));
    }

    #[test]
    fn pictures_of_other_formats_are_textures_too() {
        let tga =
            [&[0, 0, 3, 0, 0, 0, 0, 0, 0, 0, 0, 0, 2, 0, 1, 0, 8, 0x20][..], &[7, 9]].concat();
        let mtl = "newmtl a\nKd 1 1 1\nmap_Kd t.tga\nnewmtl b\nmap_Kd k.ktx2";
        let ktx = b"\xabKTX 20\xbb\r\n\x1a\n".to_vec();
        let model = loaded(mtl, &["a", "b"], vec![("t.tga", tga), ("k.ktx2", ktx)]);
        assert_eq!(model.scene.images[0].data, [[7, 7, 7, 255], [9, 9, 9, 255]]);
        let [warning] = &model.warnings[..] else { panic!("{:?}", model.warnings) };
        assert!(warning.message.contains("KTX 2 (Basis Universal) is not supported"), "{warning}");
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
        // v = 1 (the top in the file's convention) is 0 here: u' = 2u + 0.25, v' = 3v + 0.5 from below.
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
