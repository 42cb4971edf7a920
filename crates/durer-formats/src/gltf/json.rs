//! The JSON part of a glTF file, as far as it matters for a picture.
//!
//! Unknown members are ignored; wrong types are errors with line and column. Numbers that are
//! indices or sizes may be written as `3` or `3.0`, as JSON Schema allows.

use super::old;
use crate::foreign;
use serde::de::value::MapAccessDeserializer;
use serde::de::{Deserialize, Deserializer, MapAccess, Visitor};

/// A whole number from 0: an index, a count or a size.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Whole(pub u64);

impl Whole {
    /// Parses an index; one too large for memory becomes an index that no array has.
    pub fn index(self) -> usize {
        usize::try_from(self.0).unwrap_or(usize::MAX)
    }
}

impl<'de> Deserialize<'de> for Whole {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Reader;
        impl Visitor<'_> for Reader {
            type Value = Whole;
            fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str("a whole number from 0")
            }
            fn visit_u64<E: serde::de::Error>(self, n: u64) -> Result<Whole, E> {
                Ok(Whole(n))
            }
            fn visit_f64<E: serde::de::Error>(self, n: f64) -> Result<Whole, E> {
                // 2^53: beyond it a float cannot represent all whole numbers.
                if (0.0..=9_007_199_254_740_992.0).contains(&n) && n == n.trunc() {
                    Ok(Whole(n as u64))
                } else {
                    Err(E::invalid_value(serde::de::Unexpected::Float(n), &self))
                }
            }
        }
        deserializer.deserialize_any(Reader)
    }
}

/// Declares structs of optional members, all named in camel case and with a default. They are read only from JSON
/// objects; a derived implementation would accept arrays too.
macro_rules! objects {
    ($($(#[$meta:meta])* $name:ident { $($(#[$field_meta:meta])* $field:ident: $type:ty,)* })*) => {$(
        $(#[$meta])*
        #[derive(Debug, Clone, Default, serde::Deserialize)]
        #[serde(remote = "Self", default, rename_all = "camelCase")]
        pub struct $name { $($(#[$field_meta])* pub $field: $type,)* }

        impl<'de> Deserialize<'de> for $name {
            fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                struct Reader;
                impl<'de> Visitor<'de> for Reader {
                    type Value = $name;
                    fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                        f.write_str("a JSON object")
                    }
                    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<$name, A::Error> {
                        $name::deserialize(MapAccessDeserializer::new(map))
                    }
                }
                deserializer.deserialize_map(Reader)
            }
        }
    )*};
}

objects! {
    /// The file.
    Root {
        asset: Option<Asset>,
        extensions_used: Vec<String>,
        extensions_required: Vec<String>,
        accessors: Vec<Accessor>,
        animations: Vec<Animation>,
        buffers: Vec<Buffer>,
        buffer_views: Vec<BufferView>,
        cameras: Vec<Camera>,
        images: Vec<Image>,
        materials: Vec<Material>,
        meshes: Vec<Mesh>,
        nodes: Vec<Node>,
        samplers: Vec<Sampler>,
        scene: Option<Whole>,
        scenes: Vec<Scene>,
        skins: Vec<Skin>,
        textures: Vec<Texture>,
        extensions: RootExtensions,
    }
    Asset { version: Option<String>, min_version: Option<String>, }
    RootExtensions {
        #[serde(rename = "KHR_lights_punctual")]
        lights: Option<Lights>,
        #[serde(rename = "KHR_materials_variants")]
        variants: Option<Variants>,
        #[serde(rename = "CESIUM_RTC")]
        rtc: Option<Rtc>,
    }
    Rtc { center: Option<[f64; 3]>, }
    Variants { variants: Vec<Variant>, }
    Variant { name: Option<String>, }
    Lights { lights: Vec<Light>, }
    Light {
        name: Option<String>,
        color: Option<[f64; 3]>,
        intensity: Option<f64>,
        #[serde(rename = "type")]
        kind: String,
        range: Option<f64>,
        spot: Option<Spot>,
    }
    Spot { inner_cone_angle: Option<f64>, outer_cone_angle: Option<f64>, }

    Buffer { uri: Option<String>, byte_length: Option<Whole>, extensions: BufferExtensions, }
    BufferExtensions {
        #[serde(rename = "EXT_meshopt_compression", alias = "KHR_meshopt_compression")]
        meshopt: Option<Fallback>,
    }
    Fallback { fallback: bool, }
    BufferView {
        buffer: Option<Whole>,
        byte_offset: Whole,
        byte_length: Option<Whole>,
        byte_stride: Option<Whole>,
        extensions: BufferViewExtensions,
    }
    BufferViewExtensions {
        #[serde(rename = "EXT_meshopt_compression", alias = "KHR_meshopt_compression")]
        meshopt: Option<Meshopt>,
    }
    Meshopt {
        buffer: Option<Whole>,
        byte_offset: Whole,
        byte_length: Whole,
        byte_stride: Whole,
        count: Whole,
        mode: String,
        filter: Option<String>,
    }
    Accessor {
        buffer_view: Option<Whole>,
        byte_offset: Whole,
        component_type: Whole,
        normalized: bool,
        count: Option<Whole>,
        #[serde(rename = "type")]
        shape: String,
        sparse: Option<Sparse>,
    }
    Sparse { count: Whole, indices: SparseIndices, values: SparseValues, }
    SparseIndices { buffer_view: Option<Whole>, byte_offset: Whole, component_type: Whole, }
    SparseValues { buffer_view: Option<Whole>, byte_offset: Whole, }

    Mesh { name: Option<String>, primitives: Vec<Primitive>, weights: Vec<f32>, }
    Primitive {
        attributes: std::collections::BTreeMap<String, Whole>,
        indices: Option<Whole>,
        material: Option<Whole>,
        mode: Option<Whole>,
        targets: Vec<std::collections::BTreeMap<String, Whole>>,
        extensions: PrimitiveExtensions,
    }
    PrimitiveExtensions {
        #[serde(rename = "KHR_draco_mesh_compression")]
        draco: Option<Draco>,
        #[serde(rename = "KHR_materials_variants")]
        variants: Option<VariantMappings>,
    }
    VariantMappings { mappings: Vec<VariantMapping>, }
    VariantMapping { material: Option<Whole>, variants: Vec<Whole>, }
    Draco {
        buffer_view: Option<Whole>,
        attributes: std::collections::BTreeMap<String, Whole>,
    }

    Scene { name: Option<String>, nodes: Vec<Whole>, }
    Node {
        name: Option<String>,
        children: Vec<Whole>,
        mesh: Option<Whole>,
        skin: Option<Whole>,
        camera: Option<Whole>,
        matrix: Option<[f64; 16]>,
        translation: Option<[f64; 3]>,
        rotation: Option<[f64; 4]>,
        scale: Option<[f64; 3]>,
        weights: Option<Vec<f32>>,
        extensions: NodeExtensions,
    }
    NodeExtensions {
        #[serde(rename = "KHR_lights_punctual")]
        light: Option<NodeLight>,
        #[serde(rename = "EXT_mesh_gpu_instancing")]
        instancing: Option<Instancing>,
        #[serde(rename = "KHR_node_visibility")]
        visibility: Option<Visibility>,
    }
    NodeLight { light: Option<Whole>, }
    Instancing { attributes: std::collections::BTreeMap<String, Whole>, }
    Visibility { visible: Option<bool>, }
    Skin {
        inverse_bind_matrices: Option<Whole>,
        skeleton: Option<Whole>,
        joints: Vec<Whole>,
    }
    Camera {
        name: Option<String>,
        perspective: Option<Perspective>,
        orthographic: Option<Orthographic>,
    }
    Perspective { aspect_ratio: Option<f64>, yfov: f64, zfar: Option<f64>, znear: f64, }
    Orthographic { xmag: f64, ymag: f64, zfar: f64, znear: f64, }

    Animation { name: Option<String>, channels: Vec<Channel>, samplers: Vec<AnimationSampler>, }
    Channel { sampler: Option<Whole>, target: Target, }
    Target { node: Option<Whole>, path: String, }
    AnimationSampler { input: Option<Whole>, interpolation: Option<String>, output: Option<Whole>, }

    Image {
        name: Option<String>,
        uri: Option<String>,
        buffer_view: Option<Whole>,
    }
    Sampler {
        mag_filter: Option<Whole>,
        min_filter: Option<Whole>,
        wrap_s: Option<Whole>,
        wrap_t: Option<Whole>,
    }
    Texture { sampler: Option<Whole>, source: Option<Whole>, extensions: TextureExtensions, }
    TextureExtensions {
        #[serde(rename = "EXT_texture_webp")]
        webp: Option<TextureSource>,
        #[serde(rename = "KHR_texture_basisu")]
        basisu: Option<TextureSource>,
    }
    TextureSource { source: Option<Whole>, }
    Material {
        name: Option<String>,
        pbr_metallic_roughness: MetallicRoughness,
        normal_texture: Option<TextureInfo>,
        occlusion_texture: Option<TextureInfo>,
        emissive_texture: Option<TextureInfo>,
        emissive_factor: Option<[f32; 3]>,
        alpha_mode: Option<String>,
        alpha_cutoff: Option<f32>,
        double_sided: bool,
        extensions: MaterialExtensions,
    }
    MetallicRoughness {
        base_color_factor: Option<[f32; 4]>,
        base_color_texture: Option<TextureInfo>,
        metallic_factor: Option<f32>,
        roughness_factor: Option<f32>,
        metallic_roughness_texture: Option<TextureInfo>,
    }
    MaterialExtensions {
        #[serde(rename = "KHR_materials_unlit")]
        unlit: Option<Empty>,
        #[serde(rename = "KHR_materials_emissive_strength")]
        emissive_strength: Option<EmissiveStrength>,
        #[serde(rename = "KHR_materials_pbrSpecularGlossiness")]
        specular_glossiness: Option<SpecularGlossiness>,
        #[serde(rename = "KHR_materials_ior")]
        ior: Option<Ior>,
        #[serde(rename = "KHR_materials_specular")]
        specular: Option<Specular>,
        #[serde(rename = "KHR_materials_clearcoat")]
        clearcoat: Option<Clearcoat>,
        #[serde(rename = "KHR_materials_sheen")]
        sheen: Option<Sheen>,
        #[serde(rename = "KHR_materials_transmission")]
        transmission: Option<Transmission>,
        #[serde(rename = "KHR_materials_volume")]
        volume: Option<Volume>,
    }
    Empty {}
    EmissiveStrength { emissive_strength: Option<f32>, }
    SpecularGlossiness {
        diffuse_factor: Option<[f32; 4]>,
        diffuse_texture: Option<TextureInfo>,
        specular_factor: Option<[f32; 3]>,
        glossiness_factor: Option<f32>,
        specular_glossiness_texture: Option<TextureInfo>,
    }
    Ior { ior: Option<f32>, }
    Specular {
        specular_factor: Option<f32>,
        specular_texture: Option<TextureInfo>,
        specular_color_factor: Option<[f32; 3]>,
        specular_color_texture: Option<TextureInfo>,
    }
    Clearcoat {
        clearcoat_factor: f32,
        clearcoat_texture: Option<TextureInfo>,
        clearcoat_roughness_factor: f32,
        clearcoat_roughness_texture: Option<TextureInfo>,
        clearcoat_normal_texture: Option<TextureInfo>,
    }
    Sheen {
        sheen_color_factor: [f32; 3],
        sheen_color_texture: Option<TextureInfo>,
        sheen_roughness_factor: f32,
        sheen_roughness_texture: Option<TextureInfo>,
    }
    Transmission { transmission_factor: f32, transmission_texture: Option<TextureInfo>, }
    Volume { attenuation_color: Option<[f32; 3]>, }
    /// Texture reference of any kind: `scale` is a normal texture's, `strength` an occlusion
    /// texture's.
    TextureInfo {
        index: Option<Whole>,
        tex_coord: Whole,
        scale: Option<f32>,
        strength: Option<f32>,
        extensions: TextureInfoExtensions,
    }
    TextureInfoExtensions {
        #[serde(rename = "KHR_texture_transform")]
        transform: Option<TextureTransform>,
    }
    TextureTransform {
        offset: Option<[f64; 2]>,
        rotation: f64,
        scale: Option<[f64; 2]>,
        tex_coord: Option<Whole>,
    }
}

/// Parses the JSON.
///
/// # Errors
/// A decode error at line and column; [`crate::Error::Unsupported`] for glTF 1.
pub fn parse(text: &[u8]) -> crate::Result<Root> {
    serde_json::from_slice(text).map_err(|e| {
        // Version 1 has other types, so it is known only after it was not understood.
        if let Some(version) = old::version(text) {
            return old::unsupported(crate::Place::Path("asset.version".to_owned()), &version);
        }
        let message = foreign::json(&e);
        crate::Error::line(e.line() as u64, e.column() as u64, format!("in the JSON: {message}"))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wrong_types_are_reported_with_their_line() {
        let error = |text: &str| parse(text.as_bytes()).unwrap_err().to_string();
        assert!(parse(br#"{"scene": 2.0, "what": [{}], "nodes": [{"mesh": 0}]}"#).is_ok());
        assert!(error("[]").starts_with("line 1"));
        assert!(error("{\n\"scene\": -1}").starts_with("line 2, column 1"));
        assert!(error("{\"scene\": 1.5}").contains("whole number"));
        assert!(error("{\"images\": [[\"uri\"]]}").contains("a JSON object"));
        assert!(error("{} x").contains("something follows after the end"));
        assert!(error(&"[".repeat(100_000)).starts_with("line 1"));
        assert!(error(&format!("{{\"extras\": {}", "[".repeat(100_000))).starts_with("line 1"));
    }
}
