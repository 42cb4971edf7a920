//! The names that writers give to elements and properties of a PLY file.

use super::header::{Element, Property, Type};

/// Values of a vertex, in order: position, normal, colour with alpha, texture coordinate, and the values of a Gaussian
/// splat: colour, opacity, logarithms of radii, rotation.
pub(super) const VALUES: usize = 23;
pub(super) const NORMAL: usize = 3;
pub(super) const RED: usize = 6;
pub(super) const ALPHA: usize = 9;
pub(super) const TEX_COORD: usize = 10;
pub(super) const SPLAT_COLOR: usize = 12;
pub(super) const OPACITY: usize = 15;
pub(super) const SCALE: usize = 16;
pub(super) const ROTATION: usize = 19;

/// Role of an element.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Role {
    Vertex,
    Face,
    Strip,
    Edge,
    /// Element without geometry, such as cameras and materials.
    Quiet,
    Other,
}

/// Use of a property.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Use {
    /// A value of the vertex.
    Value(usize),
    /// The list of a face's or strip's vertices.
    Indices,
    /// The first or second vertex of an edge.
    End(usize),
    /// Red, green, blue or alpha of a face or an edge.
    Color(usize),
    /// The list of texture coordinates of a face's corners.
    TexCoords,
    /// The number of a face's picture.
    Texture,
    Nothing,
}

/// A property of an element, as the reader uses it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Step {
    pub usage: Use,
    /// Type of the length, where this is a list.
    pub list: Option<Type>,
    pub kind: Type,
}

/// Plan for reading the rows of an element.
#[derive(Debug)]
pub(super) struct Plan {
    pub role: Role,
    pub steps: Vec<Step>,
    /// True if rows of faces or edges have a colour.
    pub colored: bool,
    /// The element's name, for messages.
    pub name: String,
}

impl Plan {
    /// Creates the plan for an element.
    pub fn new(element: &Element) -> Self {
        let role = role(&element.name.to_ascii_lowercase());
        let mut steps: Vec<Step> = Vec::new();
        for property in &element.properties {
            let usage = usage(role, property);
            // The first of two names for one property is used.
            let known = usage != Use::Nothing && steps.iter().any(|s| s.usage == usage);
            let usage = if known { Use::Nothing } else { usage };
            steps.push(Step { usage, list: property.list, kind: property.kind });
        }
        let colored = (0..3).all(|i| steps.iter().any(|s| s.usage == Use::Color(i)));
        Self { role, steps, colored, name: element.name.clone() }
    }

    /// Returns about how many bytes a kept row takes.
    pub fn bytes(&self) -> u64 {
        // Wide numbers become narrow ones beside them.
        let of_step = |step: &Step| match step.kind {
            Type::F64 | Type::I64 | Type::U64 => 12,
            _ => 4,
        };
        match self.role {
            Role::Vertex => self.steps.iter().map(of_step).sum(),
            Role::Face | Role::Strip => 16,
            Role::Edge => 8,
            Role::Quiet | Role::Other => 0,
        }
    }

    /// Returns whether some property is used so.
    pub fn has(&self, usage: Use) -> bool {
        self.steps.iter().any(|s| s.usage == usage)
    }
}

fn role(name: &str) -> Role {
    match name {
        "vertex" => Role::Vertex,
        "face" => Role::Face,
        "tristrips" => Role::Strip,
        "edge" => Role::Edge,
        "camera" | "material" => Role::Quiet,
        _ => Role::Other,
    }
}

fn usage(role: Role, property: &Property) -> Use {
    let name = property.name.to_ascii_lowercase();
    let slot = slot(&name);
    match (role, property.list) {
        (Role::Vertex, None) => slot.map_or(Use::Nothing, Use::Value),
        (Role::Face | Role::Strip, Some(_)) => match name.as_str() {
            "vertex_indices" | "vertex_index" | "vertex_indexes" | "vertexindices" => Use::Indices,
            "texcoord" if role == Role::Face => Use::TexCoords,
            _ => Use::Nothing,
        },
        (Role::Face, None) if name == "texnumber" => Use::Texture,
        (Role::Edge, None) if name == "vertex1" => Use::End(0),
        (Role::Edge, None) if name == "vertex2" => Use::End(1),
        (Role::Face | Role::Edge, None) => match slot {
            Some(slot @ RED..=ALPHA) => Use::Color(slot - RED),
            _ => Use::Nothing,
        },
        _ => Use::Nothing,
    }
}

/// Returns the place of a vertex's value.
fn slot(name: &str) -> Option<usize> {
    Some(match name {
        "x" | "px" | "posx" | "pos_x" | "position_x" => 0,
        "y" | "py" | "posy" | "pos_y" | "position_y" => 1,
        "z" | "pz" | "posz" | "pos_z" | "position_z" => 2,
        "nx" | "normal_x" | "normalx" => NORMAL,
        "ny" | "normal_y" | "normaly" => NORMAL + 1,
        "nz" | "normal_z" | "normalz" => NORMAL + 2,
        "red" | "r" | "diffuse_red" | "color_red" | "color_r" => RED,
        "green" | "g" | "diffuse_green" | "color_green" | "color_g" => RED + 1,
        "blue" | "b" | "diffuse_blue" | "color_blue" | "color_b" => RED + 2,
        "alpha" | "a" | "diffuse_alpha" | "color_alpha" | "color_a" => ALPHA,
        "s" | "u" | "texture_u" | "texture_s" | "s0" | "u0" | "texcoord_u" | "tex_u" => TEX_COORD,
        "t" | "v" | "texture_v" | "texture_t" | "t0" | "v0" | "texcoord_v" | "tex_v" => {
            TEX_COORD + 1
        }
        "f_dc_0" => SPLAT_COLOR,
        "f_dc_1" => SPLAT_COLOR + 1,
        "f_dc_2" => SPLAT_COLOR + 2,
        "opacity" => OPACITY,
        "scale_0" => SCALE,
        "scale_1" => SCALE + 1,
        "scale_2" => SCALE + 2,
        "rot_0" => ROTATION,
        "rot_1" => ROTATION + 1,
        "rot_2" => ROTATION + 2,
        "rot_3" => ROTATION + 3,
        _ => return None,
    })
}
