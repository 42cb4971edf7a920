//! Effects of the common profile, to materials.

use super::document::{Document, float};
use crate::mtl::image::Images;
use crate::text::Tally;
use crate::uri::percent_decode;
use crate::{Model, Place, color};
use durer::math::{DMat3, Vec3, Vec4};
use durer::scene::{AlphaMode, Material, Sampler, ShadingModel, Texture, TextureRef, Wrap};
use std::collections::HashMap;

/// The largest exponent of a highlight: narrower ones fall between pixels.
const MAX_SHININESS: f64 = 10_000.0;

/// Map from channels of texture coordinates to the mesh's sets.
pub(super) type Channels<'c> = &'c dyn Fn(&str) -> u32;

/// Materials, each made once for a choice of sets.
pub(super) struct Materials<'d, 'a> {
    document: &'d Document<'a>,
    images: Images<'d>,
    known: HashMap<(usize, Vec<u32>), usize>,
    textures: HashMap<(usize, Wrap, Wrap), usize>,
    /// True if the file counts transparency from the opaque, as old exporters of SketchUp, Blender and
    /// 3ds Max do.
    reversed: bool,
    /// True if colours are linear light instead of sRGB values.
    linear: bool,
    lost: Tally,
}

/// One of an effect's values.
enum Value {
    Color(Vec4),
    /// The sampler's element or name, and the channel.
    Texture(String, String),
}

impl<'d, 'a> Materials<'d, 'a> {
    pub fn new(document: &'d Document<'a>, images: Images<'d>, model: &mut Model) -> Self {
        let reversed = is_reversed(document);
        if let Some(element) = reversed {
            let message = "a transparency of 0 would make this invisible; in this file it is taken as \
                           opaque, 1 as invisible";
            model.warn(document.place(element), message);
        }
        let (known, textures) = Default::default();
        let (linear, lost) = (is_linear(document), Tally::default());
        Self { document, images, known, textures, reversed: reversed.is_some(), linear, lost }
    }

    /// Returns the scene's number of a material; `None` if the document does not have it.
    pub fn get(&mut self, model: &mut Model, id: &str, channels: Channels<'_>) -> Option<usize> {
        let document = self.document;
        let element = document.by_id(id).filter(|&m| document.name(m) == "material")?;
        let effect = document.find(element, &["instance_effect"])?;
        let effect = document.refers(effect, "url")?;
        let texture = |n: &usize| document.name(*n) == "texture";
        let sets = document.inside(effect).filter(texture);
        let sets = sets.map(|t| channels(document.attribute(t, "texcoord").unwrap_or_default()));
        let key = (element, sets.collect());
        if let Some(&number) = self.known.get(&key) {
            return Some(number);
        }
        let name = document.attribute(element, "name").or(document.attribute(element, "id"));
        let mut material =
            Material { name: name.unwrap_or_default().to_owned(), ..Material::default() };
        self.fill(model, &mut material, effect, channels);
        model.scene.materials.push(material);
        self.known.insert(key, model.scene.materials.len() - 1);
        Some(model.scene.materials.len() - 1)
    }

    /// Adds warnings about omissions.
    pub fn warn(&self, model: &mut Model) {
        let words = "{texture names no picture; it is|textures name no picture; they are} left out";
        model.warn_of(&self.lost, words);
    }

    fn fill(
        &mut self,
        model: &mut Model,
        material: &mut Material,
        effect: usize,
        channels: Channels<'_>,
    ) {
        let document = self.document;
        material.double_sided = sides(document, effect).unwrap_or(true);
        let Some(profile) = document.find(effect, &["profile_COMMON"]) else { return };
        let Some(technique) = document.find(profile, &["technique"]) else { return };
        let is_model =
            |n: &usize| matches!(document.name(*n), "phong" | "blinn" | "lambert" | "constant");
        let Some(shader) = document.children(technique).find(is_model) else { return };
        let kind = document.name(shader);
        let base = if kind == "constant" { "emission" } else { "diffuse" };
        self.color(model, material, (profile, shader, base), channels);
        if kind == "constant" {
            material.model = ShadingModel::Unlit;
        } else {
            match self.value(profile, shader, "emission") {
                Some(Value::Color(c)) => material.emissive = Vec3::new(c.x, c.y, c.z),
                Some(Value::Texture(image, channel)) => {
                    let texture = self.texture(model, profile, &image, channels(&channel));
                    material.emissive_texture = texture;
                    material.emissive = if texture.is_some() { Vec3::ONE } else { Vec3::ZERO };
                }
                None => {}
            }
        }
        self.highlight(material, profile, shader, matches!(kind, "phong" | "blinn"));
        self.opacity(model, material, (profile, shader), channels);
    }

    /// Sets the colour or picture that a surface shows.
    fn color(
        &mut self,
        model: &mut Model,
        material: &mut Material,
        (profile, shader, name): (usize, usize, &str),
        channels: Channels<'_>,
    ) {
        match self.value(profile, shader, name) {
            Some(Value::Color(color)) => {
                material.base_color = Vec3::new(color.x, color.y, color.z).extend(1.0);
            }
            Some(Value::Texture(image, channel)) => {
                material.base_color_texture =
                    self.texture(model, profile, &image, channels(&channel));
                if material.base_color_texture.is_some() {
                    material.base_color = Vec4::ONE;
                }
            }
            None => {}
        }
    }

    fn highlight(&self, material: &mut Material, profile: usize, shader: usize, shines: bool) {
        let color = match self.value(profile, shader, "specular").filter(|_| shines) {
            Some(Value::Color(c)) => Vec3::new(c.x, c.y, c.z),
            _ => Vec3::ZERO,
        };
        let shininess = self.number(profile, shader, "shininess").unwrap_or(20.0);
        // Some write parts of 128, as OpenGL's largest exponent.
        let exponent = if shininess < 1.0 { shininess * 128.0 } else { shininess };
        material.specular = if exponent < 1.0 { Vec3::ZERO } else { color };
        material.shininess = exponent.clamp(1.0, MAX_SHININESS) as f32;
    }

    fn opacity(
        &mut self,
        model: &mut Model,
        material: &mut Material,
        (profile, shader): (usize, usize),
        channels: Channels<'_>,
    ) {
        let document = self.document;
        let transparent = document.find(shader, &["transparent"]);
        let mode = transparent.and_then(|t| document.attribute(t, "opaque")).unwrap_or("A_ONE");
        let amount = self.number(profile, shader, "transparency");
        if transparent.is_none() && amount.is_none() {
            return;
        }
        let amount = amount.unwrap_or(1.0).clamp(0.0, 1.0) as f32;
        let alpha = match self.value(profile, shader, "transparent") {
            Some(Value::Color(c)) => {
                let luminance = 0.212671 * c.x + 0.715160 * c.y + 0.072169 * c.z;
                match mode {
                    "RGB_ZERO" => 1.0 - luminance * amount,
                    "RGB_ONE" => luminance * amount,
                    "A_ZERO" => 1.0 - c.w * amount,
                    _ if self.reversed => 1.0 - c.w * amount,
                    _ => c.w * amount,
                }
            }
            Some(Value::Texture(image, channel)) => {
                // Usually it is the picture of the surface, whose alpha is used.
                let texture = self.texture(model, profile, &image, channels(&channel));
                if texture.is_some() && texture == material.base_color_texture {
                    material.alpha_mode = AlphaMode::Blend;
                } else if texture.is_some() {
                    let message = "is a picture of its own, which is not read; it is opaque";
                    let place = transparent.map_or(Place::Whole, |t| document.place(t));
                    model.warn(place, format!("<transparent> {message}"));
                }
                return;
            }
            None if self.reversed => 1.0 - amount,
            None => amount,
        };
        material.base_color.w = alpha.clamp(0.0, 1.0);
        if material.base_color.w < 1.0 {
            material.alpha_mode = AlphaMode::Blend;
        }
    }

    /// Returns a colour, a picture, or a parameter that is a colour.
    fn value(&self, profile: usize, shader: usize, name: &str) -> Option<Value> {
        let document = self.document;
        let element = document.find(shader, &[name])?;
        let child = document
            .children(element)
            .find(|&n| matches!(document.name(n), "color" | "texture" | "param"))?;
        match document.name(child) {
            "texture" => {
                let name = |key| document.attribute(child, key).unwrap_or_default().to_owned();
                Some(Value::Texture(name("texture"), name("texcoord")))
            }
            "param" => {
                let parameter = self.parameter(profile, document.attribute(child, "ref")?)?;
                let is_color = |n: &usize| document.name(*n).starts_with("float");
                let color = document.children(parameter).find(is_color)?;
                Some(Value::Color(self.linear_color(color)))
            }
            _ => Some(Value::Color(self.linear_color(child))),
        }
    }

    /// Returns a colour with alpha as linear light.
    fn linear_color(&self, element: usize) -> Vec4 {
        let floats = self.document.floats(element);
        let mut floats = floats.map(|v| v.filter(|v| v.is_finite()).unwrap_or(0.0));
        let mut next = |none: f64| floats.next().unwrap_or(none) as f32;
        let rgb = [next(0.0), next(0.0), next(0.0)].map(|v| v.max(0.0));
        let rgb = if self.linear { Vec3::from(rgb) } else { color::linear3(rgb) };
        rgb.extend(next(1.0))
    }

    fn number(&self, profile: usize, shader: usize, name: &str) -> Option<f64> {
        let document = self.document;
        let element = document.find(shader, &[name])?;
        let of = |n: usize| float(document.raw(n).trim()).filter(|v| v.is_finite());
        document.named(element, "float").find_map(of).or_else(|| {
            let parameter = document.named(element, "param").next()?;
            let parameter = self.parameter(profile, document.attribute(parameter, "ref")?)?;
            document.named(parameter, "float").find_map(of)
        })
    }

    /// Returns a parameter of the profile, by its name there.
    fn parameter(&self, profile: usize, sid: &str) -> Option<usize> {
        let document = self.document;
        let mut all = document.inside(profile).filter(|&n| document.name(n) == "newparam");
        all.find(|&n| document.attribute(n, "sid") == Some(sid))
    }

    /// Returns the texture that a sampler's name leads to.
    fn texture(
        &mut self,
        model: &mut Model,
        profile: usize,
        name: &str,
        tex_coord: u32,
    ) -> Option<TextureRef> {
        let document = self.document;
        let sampler = self.parameter(profile, name).and_then(|p| document.find(p, &["sampler2D"]));
        let wrap = |key| match sampler.and_then(|s| document.find(s, &[key])) {
            Some(style) => match document.text(style).as_str() {
                "MIRROR" => Wrap::MirroredRepeat,
                "CLAMP" | "BORDER" | "NONE" => Wrap::ClampToEdge,
                _ => Wrap::Repeat,
            },
            None => Wrap::Repeat,
        };
        let Some(path) = self.picture(profile, name, sampler) else {
            self.lost.add(|| document.place(profile));
            return None;
        };
        let image = self.images.whole(model, &path)?;
        let (wrap_u, wrap_v) = (wrap("wrap_s"), wrap("wrap_t"));
        let textures = &mut model.scene.textures;
        let texture = *self.textures.entry((image, wrap_u, wrap_v)).or_insert_with(|| {
            textures
                .push(Texture { image, sampler: Sampler { wrap_u, wrap_v, ..Sampler::default() } });
            textures.len() - 1
        });
        Some(TextureRef { texture, tex_coord, transform: DMat3::IDENTITY })
    }

    /// Returns the path of the picture behind a sampler: through a surface (1.4), an instance (1.5), or directly if the
    /// name is an image's.
    fn picture(&self, profile: usize, name: &str, sampler: Option<usize>) -> Option<String> {
        let document = self.document;
        let text = |n: Option<usize>| n.map(|n| document.text(n));
        let surface = text(sampler.and_then(|s| document.find(s, &["source"])));
        let surface = surface.and_then(|sid| self.parameter(profile, &sid));
        let by_surface = text(surface.and_then(|s| document.find(s, &["surface", "init_from"])));
        let instance = sampler.and_then(|s| document.find(s, &["instance_image"]));
        let by_instance = instance.and_then(|i| document.attribute(i, "url")).map(str::to_owned);
        let id = by_surface.or(by_instance).unwrap_or_else(|| name.to_owned());
        let image = document.by_id(&id).filter(|&n| document.name(n) == "image")?;
        let from = document.find(image, &["init_from"])?;
        let uri = text(document.find(from, &["ref"])).unwrap_or_else(|| document.text(from));
        Some(path(&uri)).filter(|path| !path.is_empty())
    }
}

/// Returns whether the file was written by Blender 2.80 or later, which writes the linear values of its
/// nodes.
pub(super) fn is_linear(document: &Document<'_>) -> bool {
    let contributors = document.root().and_then(|root| document.find(root, &["asset"]));
    let mut contributors = contributors.into_iter().flat_map(|a| document.named(a, "contributor"));
    contributors.any(|c| {
        let tool = document.find(c, &["authoring_tool"]).map(|t| document.text(t));
        let version = tool.as_deref().and_then(|t| t.strip_prefix("Blender "));
        let version = version.and_then(|v| {
            let mut numbers = v.split(|c: char| !c.is_ascii_digit()).map(str::parse::<u32>);
            Some((numbers.next()?.ok()?, numbers.next()?.ok()?))
        });
        version.is_some_and(|v| v >= (2, 80))
    })
}

/// Returns the visible sides by an effect, from the part that the schema leaves to programs.
fn sides(document: &Document<'_>, effect: usize) -> Option<bool> {
    let found = document.inside(effect).find(|&n| document.name(n) == "double_sided")?;
    let text = document.text(found);
    Some(text != "0" && !text.eq_ignore_ascii_case("false"))
}

/// Returns the first effect that is wholly transparent by its values but can only mean the opposite.
fn is_reversed(document: &Document<'_>) -> Option<usize> {
    let root = document.root()?;
    let zero =
        |n: usize| document.named(n, "float").any(|f| float(document.raw(f).trim()) == Some(0.0));
    let mut shaders = document
        .inside(root)
        .filter(|&n| matches!(document.name(n), "phong" | "blinn" | "lambert" | "constant"));
    shaders.find_map(|shader| {
        let amount = document.find(shader, &["transparency"]).filter(|&n| zero(n))?;
        let transparent = document.find(shader, &["transparent"]);
        let mode = transparent.and_then(|t| document.attribute(t, "opaque"));
        matches!(mode, None | Some("A_ONE")).then_some(amount)
    })
}

/// Returns the path of a picture's address: absolute paths are from the writer's machine, so these files are searched
/// beside the model.
fn path(uri: &str) -> String {
    let bytes = percent_decode(uri).and_then(|b| String::from_utf8(b).ok());
    let path = bytes.unwrap_or_else(|| uri.to_owned()).replace('\\', "/");
    let absolute = path.starts_with('/') || path.split('/').next().is_some_and(|s| s.contains(':'));
    let name = path.rsplit('/').next().unwrap_or_default();
    let path = if absolute { name } else { &path };
    path.split('/').filter(|p| *p != ".").collect::<Vec<_>>().join("/")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_of_pictures() {
        for (uri, expected) in [
            ("./a%20b/c.png", "a b/c.png"),
            ("file:///C:/x/y.png", "y.png"),
            ("C:\\x\\y.png", "y.png"),
            ("/home/x/y.png", "y.png"),
            ("x\\y.png", "x/y.png"),
            ("../y%.png", "../y%.png"),
        ] {
            assert_eq!(path(uri), expected, "{uri}");
        }
    }
}
