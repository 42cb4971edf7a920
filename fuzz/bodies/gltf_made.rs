//! glTF documents that are well formed and whose numbers are hostile: the body of the fuzz target `gltf_made`, which
//! the tests call as well. Bytes alone hardly ever make a file whose references all lead somewhere; here most do.

use super::model::{check_gltf, glb, options};
use arbitrary::{Result, Unstructured};
use durer::math::DVec3;
use durer::pipeline::{Cull, RenderOptions, Samples, render};
use durer::scene::{Camera, Projection, Scene};
use durer_formats::{NoResources, gltf};

/// Bytes of the buffer: good floats, good indices, then what the input says.
const BUFFER: usize = 2048;

/// Where the floats end and indices begin, and where these end.
const FLOATS: usize = 768;
const INDICES: usize = 1024;

/// Numbers that JSON can hold and that readers tend to get wrong.
const NUMBERS: &[&str] = &[
    "0",
    "1",
    "-1",
    "0.5",
    "-0.0",
    "2",
    "3",
    "1e-40",
    "1e-300",
    "1e30",
    "-1e30",
    "3.5e38",
    "1e300",
    "-1e308",
    "0.9999999",
    "255",
    "65536",
    "4294967295",
    "4294967296",
    "9007199254740993",
    "18446744073709551615",
    "1e999",
];

/// A source of documents.
struct Made<'a, 'b>(&'b mut Unstructured<'a>);

impl Made<'_, '_> {
    /// Tells whether something rare happens: once in this many times.
    fn rarely(&mut self, times: u8) -> Result<bool> {
        Ok(self.0.int_in_range(1..=times)? == times)
    }

    fn one<'s>(&mut self, all: &[&'s str]) -> Result<&'s str> {
        self.0.choose(all).copied()
    }

    fn number(&mut self) -> Result<String> {
        Ok(match self.0.int_in_range(0..=3)? {
            0 => self.one(NUMBERS)?.to_owned(),
            1 => self.0.arbitrary::<i8>()?.to_string(),
            2 => format!("{}", f32::from(self.0.arbitrary::<i8>()?) / 64.0),
            _ => {
                let value = f32::from_bits(self.0.arbitrary()?);
                if value.is_finite() { format!("{value:e}") } else { "1".to_owned() }
            }
        })
    }

    fn numbers(&mut self, count: usize) -> Result<String> {
        let numbers: Vec<String> = (0..count).map(|_| self.number()).collect::<Result<_>>()?;
        Ok(format!("[{}]", numbers.join(",")))
    }

    /// Returns an index of one of this many, hardly ever another number.
    fn index(&mut self, count: usize) -> Result<String> {
        if self.rarely(32)? {
            self.number()
        } else {
            Ok(self.0.int_in_range(0..=count.max(1) - 1)?.to_string())
        }
    }

    /// `"name":value,` some of the time.
    fn maybe(
        &mut self,
        name: &str,
        value: impl FnOnce(&mut Self) -> Result<String>,
    ) -> Result<String> {
        if self.0.arbitrary()? {
            Ok(format!("\"{name}\":{},", value(self)?))
        } else {
            Ok(String::new())
        }
    }

    fn list(
        &mut self,
        from: usize,
        to: usize,
        mut of: impl FnMut(&mut Self, usize) -> Result<String>,
    ) -> Result<String> {
        let count = self.0.int_in_range(from..=to)?;
        let all: Vec<String> = (0..count).map(|i| of(self, i)).collect::<Result<_>>()?;
        Ok(format!("[{}]", all.join(",")))
    }

    /// View 0 has floats, view 1 indices of 16 bits; the rest is anywhere.
    fn view(&mut self, i: usize) -> Result<String> {
        let (offset, length) = match i {
            0 => (0, FLOATS),
            1 => (FLOATS, INDICES - FLOATS),
            _ => {
                let offset = self.0.int_in_range(0..=BUFFER)?;
                (offset, self.0.int_in_range(0..=BUFFER - offset)?)
            }
        };
        let stride = if i > 1 && self.rarely(4)? {
            format!(",\"byteStride\":{}", self.index(300)?)
        } else {
            String::new()
        };
        Ok(format!(
            r#"{{"buffer":{},"byteOffset":{offset},"byteLength":{length}{stride}}}"#,
            self.index(1)?
        ))
    }

    /// Accessors 0 to 3 are good: positions, texture coordinates, indices and matrices.
    fn accessor(&mut self, i: usize) -> Result<String> {
        let good = |view: u8, component: u16, count: u8, shape: &str| {
            format!(
                r#"{{"bufferView":{view},"componentType":{component},"count":{count},"type":"{shape}"}}"#
            )
        };
        match i {
            0 => return Ok(good(0, 5126, 24, "VEC3")),
            1 => return Ok(good(0, 5126, 24, "VEC2")),
            2 => return Ok(good(1, 5123, 36, "SCALAR")),
            3 => return Ok(good(0, 5126, 8, "MAT4")),
            _ => {}
        }
        let shape =
            self.one(&["SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4", "VEC3", "VEC4"])?;
        let component =
            self.one(&["5120", "5121", "5122", "5123", "5125", "5126", "5126", "5124"])?;
        let count = if self.rarely(12)? {
            self.number()?
        } else {
            self.0.choose(&[1, 3, 24, 24, 36])?.to_string()
        };
        let view = self.maybe("bufferView", |m| m.index(6))?;
        let offset = self.maybe("byteOffset", |m| m.index(64))?;
        let sparse =
            if self.rarely(3)? { format!("\"sparse\":{},", self.sparse()?) } else { String::new() };
        let normalized: bool = self.0.arbitrary()?;
        Ok(format!(
            r#"{{{view}{offset}{sparse}"normalized":{normalized},"componentType":{component},"count":{count},"type":"{shape}"}}"#
        ))
    }

    fn sparse(&mut self) -> Result<String> {
        let component = self.one(&["5121", "5123", "5125", "5126"])?;
        Ok(format!(
            r#"{{"count":{},"indices":{{"bufferView":{},"byteOffset":{},"componentType":{component}}},"values":{{"bufferView":{},"byteOffset":{}}}}}"#,
            self.index(24)?,
            self.index(6)?,
            self.index(40)?,
            self.index(6)?,
            self.index(40)?
        ))
    }

    fn attributes(&mut self, names: &[&str]) -> Result<String> {
        let mut all = Vec::new();
        for name in names {
            if self.0.arbitrary()? {
                let accessor = if *name == "TEXCOORD_0" && !self.rarely(4)? {
                    "1".to_owned()
                } else {
                    self.index(10)?
                };
                all.push(format!("\"{name}\":{accessor}"));
            }
        }
        if !self.rarely(16)? {
            all.push(format!(
                "\"POSITION\":{}",
                if self.rarely(4)? { self.index(10)? } else { "0".to_owned() }
            ));
        }
        Ok(format!("{{{}}}", all.join(",")))
    }

    fn primitive(&mut self) -> Result<String> {
        let names = [
            "NORMAL",
            "TANGENT",
            "TEXCOORD_0",
            "TEXCOORD_1",
            "COLOR_0",
            "JOINTS_0",
            "WEIGHTS_0",
            "JOINTS_1",
            "WEIGHTS_1",
        ];
        let attributes = self.attributes(&names)?;
        let indices =
            self.maybe("indices", |m| if m.rarely(4)? { m.index(10) } else { Ok("2".to_owned()) })?;
        let material = self.maybe("material", |m| m.index(3))?;
        let mode = self.maybe("mode", |m| m.index(8))?;
        let targets =
            self.list(0, 2, |m, _| m.attributes(&["NORMAL", "TANGENT", "TEXCOORD_0", "COLOR_0"]))?;
        let variants = self.maybe("extensions", |m| {
            Ok(format!(
                r#"{{"KHR_materials_variants":{{"mappings":[{{"material":{},"variants":[{}]}}]}}}}"#,
                m.index(3)?, m.index(2)?
            ))
        })?;
        Ok(format!(
            r#"{{{indices}{material}{mode}{variants}"targets":{targets},"attributes":{attributes}}}"#
        ))
    }

    fn mesh(&mut self) -> Result<String> {
        let weights = self.maybe("weights", |m| m.numbers(2))?;
        Ok(format!(r#"{{{weights}"primitives":{}}}"#, self.list(1, 2, |m, _| m.primitive())?))
    }

    fn node(&mut self, i: usize) -> Result<String> {
        let children = match self.0.arbitrary()? {
            // Nodes that come later, so that most documents have no circles.
            true if i < 5 && !self.rarely(16)? => format!("\"children\":[{}],", i + 1),
            true => format!("\"children\":[{},{}],", self.index(6)?, self.index(6)?),
            false => String::new(),
        };
        let mesh =
            if self.rarely(8)? { String::new() } else { format!("\"mesh\":{},", self.index(2)?) };
        let placed = match self.0.int_in_range(0..=3)? {
            0 => format!("\"matrix\":{},", self.numbers(16)?),
            1 => format!("\"translation\":{},\"scale\":{},", self.numbers(3)?, self.numbers(3)?),
            2 => format!("\"rotation\":{},", self.numbers(4)?),
            _ => String::new(),
        };
        let parts = [
            self.maybe("skin", |m| m.index(2))?,
            self.maybe("weights", |m| m.numbers(2))?,
            if self.rarely(6)? { format!("\"camera\":{},", self.index(2)?) } else { String::new() },
            if self.rarely(6)? {
                format!("\"extensions\":{},", self.node_extension()?)
            } else {
                String::new()
            },
        ];
        Ok(format!(r#"{{{children}{mesh}{placed}{}"name":"n{i}"}}"#, parts.concat()))
    }

    fn node_extension(&mut self) -> Result<String> {
        Ok(match self.0.int_in_range(0..=2)? {
            0 => format!(r#"{{"KHR_lights_punctual":{{"light":{}}}}}"#, self.index(2)?),
            1 => format!(
                r#"{{"KHR_node_visibility":{{"visible":{}}}}}"#,
                self.0.arbitrary::<bool>()?
            ),
            _ => {
                let [a, b, c] = [self.index(10)?, self.index(10)?, self.index(10)?];
                format!(
                    r#"{{"EXT_mesh_gpu_instancing":{{"attributes":{{"TRANSLATION":{a},"ROTATION":{b},"SCALE":{c}}}}}}}"#
                )
            }
        })
    }

    fn skin(&mut self) -> Result<String> {
        let inverse = self.maybe("inverseBindMatrices", |m| {
            if m.rarely(4)? { m.index(10) } else { Ok("3".to_owned()) }
        })?;
        let skeleton = self.maybe("skeleton", |m| m.index(6))?;
        Ok(format!(r#"{{{inverse}{skeleton}"joints":{}}}"#, self.list(1, 6, |m, _| m.index(6))?))
    }

    fn animation(&mut self) -> Result<String> {
        let channels = self.list(1, 3, |m, _| {
            let path = m.one(&["translation", "rotation", "scale", "weights", "pointer"])?;
            Ok(format!(
                r#"{{"sampler":{},"target":{{"node":{},"path":"{path}"}}}}"#,
                m.index(2)?,
                m.index(6)?
            ))
        })?;
        let samplers = self.list(1, 3, |m, _| {
            let how = m.one(&["LINEAR", "STEP", "CUBICSPLINE", "OTHER"])?;
            Ok(format!(
                r#"{{"input":{},"output":{},"interpolation":"{how}"}}"#,
                m.index(10)?,
                m.index(10)?
            ))
        })?;
        Ok(format!(r#"{{"channels":{channels},"samplers":{samplers}}}"#))
    }

    fn texture_info(&mut self) -> Result<String> {
        let placed = self.maybe("extensions", |m| {
            Ok(format!(
                r#"{{"KHR_texture_transform":{{"offset":{},"rotation":{},"scale":{}}}}}"#,
                m.numbers(2)?,
                m.number()?,
                m.numbers(2)?
            ))
        })?;
        let scale = self.maybe("scale", Self::number)?;
        let set = self.maybe("texCoord", |m| m.index(2))?;
        Ok(format!(r#"{{{placed}{scale}{set}"index":{}}}"#, self.index(2)?))
    }

    fn material(&mut self) -> Result<String> {
        let texture = Self::texture_info;
        let plain = [
            self.maybe("baseColorFactor", |m| m.numbers(4))?,
            self.maybe("metallicFactor", Self::number)?,
            self.maybe("baseColorTexture", texture)?,
            self.maybe("metallicRoughnessTexture", texture)?,
        ];
        let roughness = self.number()?;
        let mode = self.one(&["OPAQUE", "MASK", "BLEND", "OTHER"])?;
        let rest = [
            self.maybe("normalTexture", texture)?,
            self.maybe("emissiveFactor", |m| m.numbers(3))?,
            self.maybe("emissiveTexture", texture)?,
            self.maybe("occlusionTexture", texture)?,
            self.maybe("alphaCutoff", Self::number)?,
            self.maybe("extensions", Self::material_extensions)?,
        ];
        Ok(format!(
            r#"{{{}"alphaMode":"{mode}","pbrMetallicRoughness":{{{}"roughnessFactor":{roughness}}}}}"#,
            rest.concat(),
            plain.concat()
        ))
    }

    fn material_extensions(&mut self) -> Result<String> {
        let kinds: [(&str, &[(&str, usize)]); 8] = [
            ("KHR_materials_emissive_strength", &[("emissiveStrength", 1)]),
            ("KHR_materials_ior", &[("ior", 1)]),
            ("KHR_materials_specular", &[("specularFactor", 1), ("specularColorFactor", 3)]),
            ("KHR_materials_clearcoat", &[("clearcoatFactor", 1), ("clearcoatRoughnessFactor", 1)]),
            ("KHR_materials_sheen", &[("sheenColorFactor", 3), ("sheenRoughnessFactor", 1)]),
            ("KHR_materials_transmission", &[("transmissionFactor", 1)]),
            ("KHR_materials_volume", &[("attenuationColor", 3)]),
            (
                "KHR_materials_pbrSpecularGlossiness",
                &[("diffuseFactor", 4), ("glossinessFactor", 1)],
            ),
        ];
        let mut all = Vec::new();
        for (name, members) in kinds {
            if self.rarely(4)? {
                let members = members.iter().map(|&(member, count)| {
                    let value = if count == 1 { self.number()? } else { self.numbers(count)? };
                    Ok(format!("\"{member}\":{value}"))
                });
                all.push(format!(
                    "\"{name}\":{{{}}}",
                    members.collect::<Result<Vec<_>>>()?.join(",")
                ));
            }
        }
        if self.rarely(8)? {
            all.push("\"KHR_materials_unlit\":{}".to_owned());
        }
        Ok(format!("{{{}}}", all.join(",")))
    }

    fn camera(&mut self) -> Result<String> {
        let [a, b, c, d] = [self.number()?, self.number()?, self.number()?, self.number()?];
        Ok(match self.0.arbitrary()? {
            true => format!(
                r#"{{"type":"perspective","perspective":{{"yfov":{a},"znear":{b},"zfar":{c}}}}}"#
            ),
            false => format!(
                r#"{{"type":"orthographic","orthographic":{{"xmag":{a},"ymag":{b},"znear":{c},"zfar":{d}}}}}"#
            ),
        })
    }

    fn light(&mut self) -> Result<String> {
        let kind = self.one(&["point", "spot", "directional", "other"])?;
        let range = self.maybe("range", Self::number)?;
        let spot = self.maybe("spot", |m| {
            Ok(format!(r#"{{"innerConeAngle":{},"outerConeAngle":{}}}"#, m.number()?, m.number()?))
        })?;
        Ok(format!(
            r#"{{{range}{spot}"type":"{kind}","intensity":{},"color":{}}}"#,
            self.number()?,
            self.numbers(3)?
        ))
    }

    fn document(&mut self) -> Result<String> {
        let views = self.list(4, 6, Self::view)?;
        let accessors = self.list(6, 10, Self::accessor)?;
        let meshes = self.list(1, 2, |m, _| m.mesh())?;
        let nodes = self.list(3, 6, Self::node)?;
        let skins = self.list(0, 2, |m, _| m.skin())?;
        let animations = self.list(0, 2, |m, _| m.animation())?;
        let materials = self.list(0, 3, |m, _| m.material())?;
        let cameras = self.list(0, 2, |m, _| m.camera())?;
        let lights = self.list(0, 2, |m, _| m.light())?;
        let scene = self.maybe("scene", |m| m.index(1))?;
        Ok(format!(
            r#"{{"asset":{{"version":"2.0"}},{scene}"scenes":[{{"nodes":[0,{}]}}],"nodes":{nodes},"meshes":{meshes},
            "buffers":[{{"byteLength":{BUFFER}}}],"bufferViews":{views},"accessors":{accessors},"skins":{skins},
            "animations":{animations},"materials":{materials},"cameras":{cameras},
            "textures":[{{"source":0}},{{"source":0,"sampler":0}}],"samplers":[{{"wrapS":{},"minFilter":{}}}],
            "images":[{{"uri":"{IMAGE}"}}],"extensions":{{"KHR_lights_punctual":{{"lights":{lights}}},
            "KHR_materials_variants":{{"variants":[{{"name":"a"}},{{"name":"b"}}]}}}}}}"#,
            self.index(3)?,
            self.one(&["10497", "33071", "33648", "7"])?,
            self.one(&["9728", "9729", "9984", "9987", "7"])?,
        ))
    }
}

/// A picture of four pixels, two of them transparent.
const IMAGE: &str = "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAIAAAACCAYAAABytg0kAAAAFElEQVR4nGP4z8DwHwgbGMA0EAAAP9cIeY8TiooAAAAASUVORK5CYII=";

/// Returns the buffer: corners of boxes, indices of boxes, then the input over and over.
fn buffer(rest: &[u8]) -> Vec<u8> {
    let mut buffer = Vec::with_capacity(BUFFER);
    for i in 0..FLOATS / 4 {
        let value = [0.0f32, 1.0, 0.5, -1.0, 0.25, 2.0, 0.0][i % 7];
        buffer.extend(value.to_le_bytes());
    }
    for i in 0..(INDICES - FLOATS) / 2 {
        buffer.extend(((i * 7 % 24) as u16).to_le_bytes());
    }
    buffer.extend(rest.iter().copied().chain(std::iter::once(0)).cycle().take(BUFFER - INDICES));
    buffer
}

/// A picture of whatever was read is made, or refused, and is not waited for.
fn picture(scene: &Scene) {
    let Some(sphere) = scene.bounding_sphere() else { return };
    let reach = sphere.radius.max(1e-3);
    let mut options = RenderOptions::new(Camera {
        eye: sphere.center + DVec3::new(0.9, 0.7, 1.9) * reach,
        target: sphere.center,
        up: DVec3::Y,
        projection: Projection::Perspective { fov_y: 0.8 },
        near: reach * 1e-3,
        far: reach * 9.0,
    });
    (options.width, options.height) = (40, 30);
    (options.samples, options.cull) = (Samples::Four, Cull::Material);
    drop(render(scene, &options));
}

/// Documents whose references mostly lead somewhere are read alike from bytes and files, and what is read can be shown.
pub fn gltf_made(bytes: &[u8]) {
    let mut u = Unstructured::new(bytes);
    let Ok(json) = Made(&mut u).document() else { return };
    let file = glb(&json, &buffer(u.take_rest()));
    check_gltf(&file, &NoResources);
    if let Ok(model) = gltf::read(&file, &NoResources, &options()) {
        picture(&model.scene);
        model.scene.cameras.iter().for_each(|own| {
            let mut options = RenderOptions::new(own.camera);
            (options.width, options.height) = (24, 18);
            drop(render(&model.scene, &options));
        });
    }
}
