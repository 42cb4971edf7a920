//! A small writer of binary glTF 2.0.

use crate::solids::Solid;
use durer::math::DVec3;
use serde_json::{Value, json};

/// A file that grows.
#[derive(Default)]
pub struct Glb {
    bin: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
    meshes: Vec<Value>,
    nodes: Vec<Value>,
    materials: Vec<Value>,
    images: Vec<Value>,
}

/// Numbers of accessors.
#[derive(Clone, Copy)]
pub struct Geometry {
    positions: usize,
    normals: usize,
    tex_coords: usize,
    indices: usize,
}

const FLOAT: u32 = 5126;
const UNSIGNED_INT: u32 = 5125;

impl Glb {
    fn view(&mut self, bytes: &[u8]) -> usize {
        self.views
            .push(json!({"buffer": 0, "byteOffset": self.bin.len(), "byteLength": bytes.len()}));
        self.bin.extend(bytes);
        self.bin.resize(self.bin.len().next_multiple_of(4), 0);
        self.views.len() - 1
    }

    fn floats<const N: usize>(
        &mut self,
        kind: &str,
        values: impl Iterator<Item = [f64; N]>,
    ) -> usize {
        let values: Vec<[f32; N]> = values.map(|v| v.map(|c| c as f32 + 0.0)).collect();
        let extreme = |f: fn(f32, f32) -> f32| -> Vec<f32> {
            (0..N).map(|i| values.iter().map(|v| v[i]).reduce(f).unwrap_or(0.0)).collect()
        };
        let bytes: Vec<u8> = values.iter().flatten().flat_map(|c| c.to_le_bytes()).collect();
        let view = self.view(&bytes);
        self.accessors.push(json!({
            "bufferView": view, "componentType": FLOAT, "count": values.len(), "type": kind,
            "min": extreme(f32::min), "max": extreme(f32::max),
        }));
        self.accessors.len() - 1
    }

    /// Returns the accessors of a body, which several meshes may share.
    pub fn geometry(&mut self, solid: &Solid) -> Geometry {
        let positions = self.floats("VEC3", solid.positions.iter().map(|p| p.to_array()));
        let normals = self.floats("VEC3", solid.normals.iter().map(|n| n.to_array()));
        let tex_coords = self.floats("VEC2", solid.tex_coords.iter().map(|t| t.to_array()));
        let bytes: Vec<u8> = solid.indices.iter().flat_map(|i| i.to_le_bytes()).collect();
        let view = self.view(&bytes);
        self.accessors.push(json!({
            "bufferView": view, "componentType": UNSIGNED_INT, "count": solid.indices.len(),
            "type": "SCALAR",
        }));
        Geometry { positions, normals, tex_coords, indices: self.accessors.len() - 1 }
    }

    /// Adds a mesh of one part and returns its number.
    pub fn mesh(&mut self, geometry: Geometry, material: usize) -> usize {
        let Geometry { positions, normals, tex_coords, indices } = geometry;
        self.meshes.push(json!({"primitives": [{
            "attributes": {"POSITION": positions, "NORMAL": normals, "TEXCOORD_0": tex_coords},
            "indices": indices, "material": material,
        }]}));
        self.meshes.len() - 1
    }

    /// Adds a PNG and returns the number of its texture.
    pub fn texture(&mut self, png: &[u8]) -> usize {
        let view = self.view(png);
        self.images.push(json!({"bufferView": view, "mimeType": "image/png"}));
        self.images.len() - 1
    }

    pub fn material(&mut self, material: Value) -> usize {
        self.materials.push(material);
        self.materials.len() - 1
    }

    /// Adds a mesh: scaled, turned around the y axis, moved.
    pub fn node(&mut self, name: &str, mesh: usize, place: DVec3, degrees: f64, scale: DVec3) {
        let (sin, cos) = libm::sincos(degrees.to_radians() * 0.5);
        self.nodes.push(json!({
            "name": name, "mesh": mesh, "translation": place.to_array(),
            "rotation": [0.0, sin, 0.0, cos], "scale": scale.to_array(),
        }));
    }

    /// Returns the bytes of the file.
    pub fn finish(mut self) -> Result<Vec<u8>, serde_json::Error> {
        self.bin.resize(self.bin.len().next_multiple_of(4), 0);
        let textures: Vec<Value> =
            (0..self.images.len()).map(|i| json!({"source": i, "sampler": 0})).collect();
        let mut root = json!({
            "asset": {"version": "2.0", "generator": "durer", "copyright": "CC0-1.0"},
            "scene": 0,
            "scenes": [{"nodes": (0..self.nodes.len()).collect::<Vec<_>>()}],
            "nodes": self.nodes, "meshes": self.meshes, "materials": self.materials,
            "accessors": self.accessors, "bufferViews": self.views,
            "buffers": [{"byteLength": self.bin.len()}],
        });
        if !self.images.is_empty() {
            // Linear between levels and texels; the image repeats.
            root["samplers"] = json!([{"magFilter": 9729, "minFilter": 9987}]);
            root["images"] = json!(self.images);
            root["textures"] = json!(textures);
        }
        let mut text = serde_json::to_vec(&root)?;
        text.resize(text.len().next_multiple_of(4), b' ');
        let total = 12 + 8 + text.len() + 8 + self.bin.len();
        let number = |n: usize| (n as u32).to_le_bytes();
        Ok([
            &b"glTF"[..],
            &number(2),
            &number(total),
            &number(text.len()),
            b"JSON",
            &text,
            &number(self.bin.len()),
            b"BIN\0",
            &self.bin,
        ]
        .concat())
    }
}
