//! From the elements of a PLY file to a mesh.

use super::body::Values;
use super::header::{Element, Encoding, Header, Property, Type};
use crate::model::count_infinite;
use crate::text::Tally;
use crate::{Error, Limits, Model, Place, Result, color, place};
use durer::math::{DVec3, Vec2, Vec4};
use durer::scene::{Instance, Mesh, Part, Topology};

/// What a property of a vertex is, as a place in the row's values.
const SLOTS: [(&str, usize); 31] = [
    ("x", 0),
    ("y", 1),
    ("z", 2),
    ("nx", 3),
    ("ny", 4),
    ("nz", 5),
    ("normal_x", 3),
    ("normal_y", 4),
    ("normal_z", 5),
    ("red", 6),
    ("green", 7),
    ("blue", 8),
    ("alpha", 9),
    ("r", 6),
    ("g", 7),
    ("b", 8),
    ("a", 9),
    ("diffuse_red", 6),
    ("diffuse_green", 7),
    ("diffuse_blue", 8),
    ("diffuse_alpha", 9),
    ("s", 10),
    ("t", 11),
    ("u", 10),
    ("v", 11),
    ("texture_u", 10),
    ("texture_v", 11),
    ("texture_s", 10),
    ("texture_t", 11),
    ("s0", 10),
    ("t0", 11),
];
/// Values of a vertex: position, normal, color with alpha, texture coordinate.
const VALUES: usize = 12;
const NORMAL: usize = 3;
const RED: usize = 6;
const ALPHA: usize = 9;
const TEX_COORD: usize = 10;

/// What an element is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Role {
    Vertex,
    Face,
    Strip,
    Edge,
    Other,
}

/// What becomes of a property.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Use {
    /// A value of the vertex.
    Value(usize),
    /// The list of a face's or strip's vertices.
    Indices,
    /// The first or second vertex of an edge.
    End(usize),
    Nothing,
}

/// Collects the mesh.
pub(super) struct Builder {
    limits: Limits,
    vertex_count: u64,
    role: Role,
    uses: Vec<Use>,
    /// Which of the vertex's values the file has, and by what they are divided.
    present: [Option<f64>; VALUES],
    wide: Option<Vec<DVec3>>,
    mesh: Mesh,
    indices: Vec<u32>,
    edges: Vec<u32>,
    face_count: u32,
    small_faces: Tally,
}

impl Builder {
    pub fn new(header: &Header, limits: Limits) -> Self {
        Self {
            limits,
            vertex_count: header.element("vertex").map_or(0, |e| e.count),
            role: Role::Other,
            uses: Vec::new(),
            present: [None; VALUES],
            wide: None,
            mesh: Mesh::default(),
            indices: Vec::new(),
            edges: Vec::new(),
            face_count: 0,
            small_faces: Tally::default(),
        }
    }

    /// Prepares for the rows of an element.
    ///
    /// # Errors
    /// A vertex without coordinates; more rows than allowed.
    pub fn begin(&mut self, element: &Element) -> Result<()> {
        self.role = match element.name.as_str() {
            "vertex" => Role::Vertex,
            "face" => Role::Face,
            "tristrips" => Role::Strip,
            "edge" => Role::Edge,
            _ => Role::Other,
        };
        self.uses = element.properties.iter().map(|p| self.use_of(p)).collect();
        let limit = self.limits.primitives.min(u64::from(u32::MAX / 3));
        if self.role != Role::Other && element.count > limit {
            let what = "number of elements";
            return Err(Error::Limit { place: Place::Whole, what, value: element.count, limit });
        }
        let count = element.count as usize;
        match self.role {
            Role::Vertex => return self.begin_vertices(element, count),
            Role::Face => self.indices.reserve_exact(3 * count),
            Role::Edge => self.edges.reserve_exact(2 * count),
            Role::Strip | Role::Other => {}
        }
        Ok(())
    }

    fn use_of(&self, property: &Property) -> Use {
        let name = property.name.as_str();
        let slot = SLOTS.iter().find(|(n, _)| *n == name).map(|(_, slot)| *slot);
        match (self.role, property.list) {
            (Role::Vertex, None) => slot.map_or(Use::Nothing, Use::Value),
            (Role::Face | Role::Strip, Some(_))
                if matches!(name, "vertex_indices" | "vertex_index") =>
            {
                Use::Indices
            }
            (Role::Edge, None) if name == "vertex1" => Use::End(0),
            (Role::Edge, None) if name == "vertex2" => Use::End(1),
            _ => Use::Nothing,
        }
    }

    fn begin_vertices(&mut self, element: &Element, count: usize) -> Result<()> {
        let mut wide = false;
        for (property, usage) in element.properties.iter().zip(&self.uses) {
            if let Use::Value(slot) = *usage {
                self.present[slot] = Some(property.kind.full_scale());
                wide |= slot < NORMAL && property.kind == Type::F64;
            }
        }
        for (slot, name) in ["x", "y", "z"].iter().enumerate() {
            if self.present[slot].is_none() {
                return Err(Error::whole(format!("element `vertex` has no property `{name}`")));
            }
        }
        if wide {
            self.wide = Some(Vec::with_capacity(count));
        } else {
            self.mesh.positions.reserve_exact(count);
        }
        if self.has(NORMAL, 3) {
            self.mesh.normals.reserve_exact(count);
        }
        if self.has(RED, 3) {
            self.mesh.colors.reserve_exact(count);
        }
        if self.has(TEX_COORD, 2) {
            self.mesh.tex_coords.push(Vec::with_capacity(count));
        }
        Ok(())
    }

    /// Whether the file has `count` values from `slot` on.
    fn has(&self, slot: usize, count: usize) -> bool {
        self.present.iter().skip(slot).take(count).all(Option::is_some)
    }

    /// Reads one row.
    ///
    /// # Errors
    /// Values that are missing or wrong, indices out of range.
    pub fn row(&mut self, element: &Element, row: u64, values: &mut impl Values) -> Result<()> {
        let mut vertex = [0.0; VALUES];
        let mut ends = [None; 2];
        for (i, property) in element.properties.iter().enumerate() {
            let usage = self.uses.get(i).copied().unwrap_or(Use::Nothing);
            if let Some(kind) = property.list {
                let length = list_length(kind, values, element, row)?;
                if usage == Use::Indices {
                    self.polygon(property.kind, length, values)?;
                } else {
                    values.skip(property.kind, length)?;
                }
                continue;
            }
            match usage {
                Use::Value(slot) => vertex[slot] = values.next(property.kind)?,
                Use::End(end) => ends[end] = Some(self.index(property.kind, values)?),
                _ => values.skip(property.kind, 1)?,
            }
        }
        match (self.role, ends) {
            (Role::Vertex, _) => self.vertex(&vertex),
            (Role::Edge, [Some(from), Some(to)]) => self.edges.extend([from, to]),
            _ => {}
        }
        Ok(())
    }

    fn vertex(&mut self, v: &[f64; VALUES]) {
        let p = DVec3::new(v[0], v[1], v[2]);
        match &mut self.wide {
            Some(wide) => wide.push(p),
            None => self.mesh.positions.push(p.as_vec3()),
        }
        if self.has(NORMAL, 3) {
            let n = DVec3::new(v[NORMAL], v[NORMAL + 1], v[NORMAL + 2]);
            let n = if n.is_finite() { n.normalize_or_zero() } else { DVec3::ZERO };
            self.mesh.normals.push(n.as_vec3());
        }
        if self.has(RED, 3) {
            let part = |slot: usize| (v[slot] / self.present[slot].unwrap_or(1.0)) as f32;
            let alpha = if self.has(ALPHA, 1) { part(ALPHA) } else { 1.0 };
            // Linear light is computed at the end, where bytes and floats are told apart.
            self.mesh.colors.push(Vec4::new(part(RED), part(RED + 1), part(RED + 2), alpha));
        }
        if let Some(set) = self.mesh.tex_coords.first_mut() {
            set.push(Vec2::new(v[TEX_COORD] as f32, (1.0 - v[TEX_COORD + 1]) as f32));
        }
    }

    /// A vertex index.
    fn index(&self, kind: Type, values: &mut impl Values) -> Result<u32> {
        let value = values.next(kind)?;
        self.check_index(value, values)
    }

    fn check_index(&self, value: f64, values: &impl Values) -> Result<u32> {
        if value >= 0.0 && value < self.vertex_count as f64 && value.fract() == 0.0 {
            return Ok(value as u32);
        }
        let count = self.vertex_count;
        let mut message =
            format!("vertex {value} does not exist: there are {count}, counted from 0");
        if u64::from((value as u32).swap_bytes()) < count
            && value <= f64::from(u32::MAX)
            && value >= 65536.0
        {
            message += "; it would if the header named the other byte order";
        }
        Err(Error::Decode { place: values.place(), message })
    }

    fn polygon(&mut self, kind: Type, length: u64, values: &mut impl Values) -> Result<()> {
        // The last value of an ascii file needs no blank behind it.
        let (least, left) = (length.saturating_mul(values.least_value(kind)), values.bytes_left());
        if least > left + 1 {
            let message = format!("a list of {length} values, but only {left} bytes are left");
            return Err(Error::Decode { place: values.place(), message });
        }
        let start = self.indices.len();
        if self.role == Role::Strip {
            self.strip(kind, length, values)?;
        } else {
            self.fan(kind, length, values)?;
            self.note_face(start / 3, length, values);
        }
        let (value, limit) = (self.indices.len() as u64 / 3, self.limits.primitives);
        if value > limit {
            let what = "number of triangles";
            return Err(Error::Limit { place: values.place(), what, value, limit });
        }
        Ok(())
    }

    /// A polygon's triangles, all from its first vertex.
    fn fan(&mut self, kind: Type, length: u64, values: &mut impl Values) -> Result<()> {
        let (mut first, mut last) = (0, 0);
        for i in 0..length {
            let next = self.index(kind, values)?;
            match i {
                0 => first = next,
                1 => {}
                _ => self.indices.extend([first, last, next]),
            }
            last = next;
        }
        Ok(())
    }

    /// Triangles of strips, one after another, with −1 between them; every second one is turned
    /// over. Those that repeat a vertex only join strips and are left out.
    fn strip(&mut self, kind: Type, length: u64, values: &mut impl Values) -> Result<()> {
        let (mut a, mut b, mut seen) = (0, 0, 0u64);
        for _ in 0..length {
            let value = values.next(kind)?;
            if value < 0.0 {
                seen = 0;
                continue;
            }
            let next = self.check_index(value, values)?;
            if seen >= 2 && a != b && b != next && a != next {
                let triangle = if seen % 2 == 0 { [a, b, next] } else { [b, a, next] };
                self.indices.extend(triangle);
            }
            (a, b, seen) = (b, next, seen + 1);
        }
        Ok(())
    }

    /// Keeps the first triangle of each face once a face has several.
    fn note_face(&mut self, first: usize, corners: u64, values: &impl Values) {
        if corners < 3 {
            return self.small_faces.add(|| values.place());
        }
        let faces = &mut self.mesh.faces;
        if corners > 3 && faces.is_empty() {
            faces.extend(0..self.face_count);
        }
        if corners > 3 || !faces.is_empty() {
            faces.push(first as u32);
        }
        self.face_count += 1;
    }

    /// The model.
    ///
    /// # Errors
    /// No element `vertex`.
    pub fn finish(mut self, header: &Header) -> Result<Model> {
        let format = match header.encoding {
            Encoding::Ascii => "PLY, ascii",
            Encoding::LittleEndian => "PLY, binary little endian",
            Encoding::BigEndian => "PLY, binary big endian",
        };
        let mut model = Model { format: format.to_owned(), ..Model::default() };
        if header.element("vertex").is_none() {
            return Err(Error::whole("has no element `vertex`: there is nothing to show"));
        }
        let origin = self.wide.as_deref().map_or(DVec3::ZERO, place::origin);
        if let Some(wide) = self.wide.take() {
            self.mesh.positions = place::narrow(&wide, origin);
        }
        self.warn(&mut model, header);
        for mesh in self.into_meshes(&mut model) {
            let number = model.scene.meshes.len();
            model.scene.meshes.push(mesh);
            let (world_from_mesh, name) = (place::matrix(origin), String::new());
            model.scene.instances.push(Instance { mesh: number, world_from_mesh, name });
        }
        Ok(model)
    }

    fn warn(&self, model: &mut Model, header: &Header) {
        let infinite = count_infinite(&self.mesh.positions);
        if infinite > 0 {
            let message = format!("{infinite} vertices have a coordinate that is NaN or infinite");
            model.warn(Place::Whole, message);
        }
        if self.mesh.positions.is_empty() {
            model.warn(Place::Whole, "holds no vertices");
        }
        if self.small_faces.count > 0 {
            let message = format!(
                "{} faces have fewer than three vertices and were left out",
                self.small_faces.count
            );
            model.warn(self.small_faces.first.clone(), message);
        }
        let face = header.element("face");
        if face.is_some_and(|f| f.properties.iter().any(|p| p.name == "red")) {
            model.warn(Place::Whole, "colors of faces are not shown; those of vertices would be");
        }
        if face.is_some_and(|f| f.properties.iter().any(|p| p.name == "texcoord")) {
            model.warn(
                Place::Whole,
                "texture coordinates of faces are not read; those of vertices would be",
            );
        }
    }

    /// Triangles; else lines; else points.
    fn into_meshes(mut self, model: &mut Model) -> Vec<Mesh> {
        let mut mesh = std::mem::take(&mut self.mesh);
        make_linear(model, &mut mesh.colors);
        let mut meshes = Vec::new();
        if !self.edges.is_empty() {
            meshes.push(Mesh {
                topology: Topology::Lines,
                positions: mesh.positions.clone(),
                colors: mesh.colors.clone(),
                indices: Some(self.edges),
                ..Mesh::default()
            });
        }
        if !self.indices.is_empty() {
            mesh.indices = Some(self.indices);
            meshes.insert(0, mesh);
        } else if meshes.is_empty() {
            mesh.topology = Topology::Points;
            meshes.push(mesh);
        }
        if meshes.iter().any(|m| !m.colors.is_empty()) {
            model.scene.materials.push(color::vertex_color_material());
            for mesh in &mut meshes {
                let range = 0..mesh.primitive_count() as u32;
                mesh.parts.push(Part { range, material: Some(0), name: String::new() });
            }
        }
        meshes
    }
}

/// From sRGB to linear; numbers up to 255 that should go up to 1 are scaled.
fn make_linear(model: &mut Model, colors: &mut [Vec4]) {
    let brightest = colors.iter().map(|c| c.truncate().max_element()).fold(0.0, f32::max);
    let scale = if brightest > 2.0 { 1.0 / 255.0 } else { 1.0 };
    if scale < 1.0 {
        model.warn(Place::Whole, "colors go up to 255 instead of 1; they were scaled");
    }
    for c in colors {
        *c = color::linear3((c.truncate() * scale).to_array()).extend(c.w * scale);
    }
}

/// The length of a list.
fn list_length(kind: Type, values: &mut impl Values, element: &Element, row: u64) -> Result<u64> {
    let length = values.next(kind)?;
    if length >= 0.0 && length.fract() == 0.0 && length <= f64::from(u32::MAX) {
        return Ok(length as u64);
    }
    let message =
        format!("`{length}` is no length of a list, in row {row} of element `{}`", element.name);
    Err(Error::Decode { place: values.place(), message })
}
