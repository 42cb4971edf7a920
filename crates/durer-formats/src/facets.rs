//! Polygons that have colours and texture coordinates of their own, as vertices and triangles.

use crate::obj::corners::{Corner, Corners, NONE};
use crate::{Limits, Model, Place, Result, color, polygon};
use durer::math::{Vec2, Vec3, Vec4};
use durer::scene::{Mesh, Part};
use std::collections::HashMap;

/// The different colours of faces or edges: sRGB values and alpha.
#[derive(Debug, Default)]
pub(crate) struct Palette {
    pub colors: Vec<Vec4>,
    numbers: HashMap<[u32; 4], u32>,
    /// The latest colour: neighbours often have the same.
    last: Option<([u32; 4], u32)>,
}

impl Palette {
    /// Returns the number of a colour.
    pub fn number(&mut self, color: [f32; 4]) -> u32 {
        let key = color.map(f32::to_bits);
        if let Some((last, number)) = self.last
            && last == key
        {
            return number;
        }
        let next = self.colors.len() as u32;
        let number = *self.numbers.entry(key).or_insert(next);
        if number == next {
            self.colors.push(Vec4::from_array(color));
        }
        self.last = Some((key, number));
        number
    }
}

/// The triangles of polygons, which are fanned from their first corners.
#[derive(Debug, Default)]
pub(crate) struct Facets {
    /// Corners of triangles; in place of a normal they name a colour of the palette.
    pub triangles: Corners,
    /// First triangle of each polygon, once one has several.
    pub starts: Vec<u32>,
    /// Colours of polygons.
    pub palette: Palette,
    count: u32,
}

impl Facets {
    /// Returns the number of polygons.
    pub fn count(&self) -> usize {
        self.count as usize
    }

    /// Adds a polygon of three corners or more: the numbers of its vertices and, if there are equally many, of its
    /// texture coordinates; and the number of its colour, or [`NONE`].
    pub fn add(&mut self, corners: &[u32], coords: &[u32], color: u32) {
        self.note(corners.len() > 3);
        if color == NONE && coords.is_empty() && !self.triangles.keyed() {
            let [a, rest @ ..] = corners else { return };
            for pair in rest.windows(2) {
                self.triangles.indices.extend([*a, pair[0], pair[1]]);
            }
            return;
        }
        let corner = |i: usize| Corner {
            position: corners[i],
            tex_coord: coords.get(i).copied().unwrap_or(NONE),
            normal: color,
        };
        for i in 2..corners.len() {
            [0, i - 1, i].into_iter().for_each(|i| self.triangles.push(corner(i)));
        }
    }

    /// Keeps the first triangle of each polygon once one has several.
    fn note(&mut self, several: bool) {
        if several && self.starts.is_empty() {
            self.starts.extend(0..self.count);
        }
        if several || !self.starts.is_empty() {
            self.starts.push(self.triangles.indices.len() as u32 / 3);
        }
        self.count += 1;
    }
}

/// Attributes of vertices; all lists except the positions may be empty. Colours are linear.
#[derive(Debug, Default)]
pub(crate) struct Attributes {
    pub positions: Vec<Vec3>,
    pub normals: Vec<Vec3>,
    pub colors: Vec<Vec4>,
    pub tex_coords: Vec<Vec2>,
}

impl Attributes {
    /// Returns the vertices as a mesh of points.
    pub fn into_mesh(self) -> Mesh {
        let Self { positions, normals, colors, tex_coords } = self;
        let tex_coords = if tex_coords.is_empty() { vec![] } else { vec![tex_coords] };
        Mesh { positions, normals, colors, tex_coords, ..Mesh::default() }
    }

    /// Returns the mesh of corners of these vertices, with the vertices unchanged or with one vertex per different
    /// corner. Corners refer to `palette` in place of normals, and to `coords` as texture coordinates.
    pub fn joined(
        self,
        model: &mut Model,
        corners: Corners,
        palette: &Palette,
        coords: &[Vec2],
    ) -> Mesh {
        let keys = &corners.keys;
        let all = if keys.is_empty() { self } else { self.split(model, keys, palette, coords) };
        Mesh { indices: Some(corners.indices), ..all.into_mesh() }
    }

    fn split(
        &self,
        model: &mut Model,
        keys: &[Corner],
        palette: &Palette,
        coords: &[Vec2],
    ) -> Self {
        let colors = if self.palette_counts(model, palette) {
            let color = |k: &Corner| palette.colors.get(k.normal as usize).copied();
            keys.iter().map(|k| color(k).unwrap_or(Vec4::ONE)).collect()
        } else {
            gathered(&self.colors, keys)
        };
        let tex_coords = if coords.is_empty() {
            gathered(&self.tex_coords, keys)
        } else {
            let coord = |k: &Corner| coords.get(k.tex_coord as usize).copied();
            keys.iter().map(|k| coord(k).unwrap_or_default()).collect()
        };
        let positions = gathered(&self.positions, keys);
        Self { positions, normals: gathered(&self.normals, keys), colors, tex_coords }
    }

    /// Returns whether colours of faces or edges are shown: not if the vertices' colours vary.
    fn palette_counts(&self, model: &mut Model, palette: &Palette) -> bool {
        let varied = self.colors.iter().any(|c| Some(c) != self.colors.first());
        if varied && !palette.colors.is_empty() {
            let message =
                "faces or edges have colors, and vertices too; those of vertices are shown";
            model.warn(Place::Whole, message);
        }
        !varied && !palette.colors.is_empty()
    }
}

/// Returns the values of corners' vertices; empty if vertices have none.
fn gathered<T: Copy + Default>(values: &[T], keys: &[Corner]) -> Vec<T> {
    let keys = if values.is_empty() { &[] } else { keys };
    keys.iter().map(|k| values.get(k.position as usize).copied().unwrap_or_default()).collect()
}

/// Creates the mesh of polygons, divided into triangles that cover them; its parts are made by `lay_on`.
///
/// # Errors
/// [`crate::Error::Limit`] if polygons that cross themselves make too many triangles.
pub(crate) fn mesh(
    model: &mut Model,
    vertices: Attributes,
    facets: Facets,
    coords: &[Vec2],
    limits: &Limits,
    lay_on: impl FnOnce(&mut Model, &mut Mesh),
) -> Result<Mesh> {
    let Facets { triangles, starts, palette, .. } = facets;
    let mut mesh = vertices.joined(model, triangles, &palette, coords);
    mesh.faces = starts;
    lay_on(model, &mut mesh);
    polygon::recut(model, &mut mesh, limits)?;
    Ok(mesh)
}

/// Assigns to meshes with colours, but without material, one that shows them.
pub(crate) fn show_colors(model: &mut Model, meshes: &mut [Mesh]) {
    let number = model.scene.materials.len();
    let plain = meshes.iter_mut().filter(|m| m.parts.is_empty() && !m.colors.is_empty());
    let mut any = false;
    for mesh in plain {
        mesh.parts.push(whole(mesh, number));
        any = true;
    }
    if any {
        model.scene.materials.push(color::vertex_color_material());
    }
}

/// Returns a part that is the whole mesh.
pub(crate) fn whole(mesh: &Mesh, material: usize) -> Part {
    let range = 0..mesh.primitive_count() as u32;
    Part { range, material: Some(material), name: String::new() }
}

/// Converts colours from sRGB to linear; numbers up to 255 that should go up to 1 are scaled.
pub(crate) fn make_linear(model: &mut Model, colors: &mut [Vec4]) {
    let scale = scale_of(brightest(colors));
    warn_of_scale(model, scale);
    scaled_to_linear(colors, scale);
}

/// Returns the largest part of colours.
pub(crate) fn brightest(colors: &[Vec4]) -> f32 {
    colors.iter().map(|c| c.truncate().max_element()).fold(0.0, f32::max)
}

/// Returns the factor of colours whose largest part this is.
pub(crate) fn scale_of(brightest: f32) -> f32 {
    if brightest > 2.0 { 1.0 / 255.0 } else { 1.0 }
}

/// Warns of colours that are scaled.
pub(crate) fn warn_of_scale(model: &mut Model, scale: f32) {
    if scale < 1.0 {
        model.warn(Place::Whole, "colors go up to 255 instead of 1; they were scaled");
    }
}

/// Converts colours from sRGB to linear, multiplied first.
pub(crate) fn scaled_to_linear(colors: &mut [Vec4], scale: f32) {
    for c in colors {
        *c = color::linear3((c.truncate() * scale).to_array()).extend(c.w * scale);
    }
}
