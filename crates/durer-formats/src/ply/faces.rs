//! The faces of a PLY file: polygons and strips, with colours and texture coordinates of their own.

use super::body::Values;
use super::bounds::{Bounds, list_length};
use super::header::Type;
use super::names::{Plan, Role, Use};
use super::row_color::RowColor;
use crate::Result;
use crate::facets::Facets;
use crate::obj::corners::NONE;
use crate::text::Tally;
use durer::math::Vec2;
use std::collections::HashMap;

/// The faces so far.
#[derive(Debug, Default)]
pub(super) struct Faces {
    pub facets: Facets,
    /// Per face the number of its picture, where the file has one.
    pub textures: Vec<u32>,
    /// Texture coordinates of corners, each value once.
    pub tex_coords: Vec<Vec2>,
    numbers: HashMap<[u32; 2], u32>,
    /// Faces of fewer than three vertices.
    small: Tally,
    /// Faces whose lists of texture coordinates and of vertices differ in length.
    odd_tex_coords: Tally,
    /// The row that is read.
    corners: Vec<u32>,
    coords: Vec<u32>,
}

impl Faces {
    /// Returns whether there is a triangle to show.
    pub fn has_any(&self) -> bool {
        !self.facets.triangles.indices.is_empty()
    }

    /// Prepares for this many rows.
    pub fn begin(&mut self, plan: &Plan, count: usize) {
        if plan.has(Use::Indices) {
            self.facets.triangles.indices.reserve_exact(3 * count);
        }
    }

    /// Reads one row.
    ///
    /// # Errors
    /// Values that are missing or wrong.
    pub fn row(
        &mut self,
        plan: &Plan,
        row: u64,
        bounds: &mut Bounds,
        values: &mut impl Values,
    ) -> Result<()> {
        self.corners.clear();
        self.coords.clear();
        let (mut whole, mut texture) = (false, 0);
        let mut color = RowColor::new(plan.colored);
        for step in &plan.steps {
            if let Some(kind) = step.list {
                let length = list_length(kind, values, plan, row)?;
                match step.usage {
                    Use::Indices if plan.role == Role::Strip => {
                        self.strip(step.kind, length, bounds, values)?;
                    }
                    Use::Indices => whole = self.polygon(step.kind, length, bounds, values)?,
                    Use::TexCoords => self.coordinates(step.kind, length, values)?,
                    _ => values.skip(step.kind, length)?,
                }
                continue;
            }
            match step.usage {
                Use::Color(part) => color.set(part, step.kind, values)?,
                Use::Texture => texture = picture(values.next(step.kind)?),
                _ => values.skip(step.kind, 1)?,
            }
        }
        if whole {
            self.add(color, plan.has(Use::Texture).then_some(texture), values);
        }
        bounds.check_triangles(self.facets.triangles.indices.len() as u64 / 3, values)
    }

    /// Reads a polygon's vertices; returns whether all of them exist.
    fn polygon(
        &mut self,
        kind: Type,
        length: u64,
        bounds: &mut Bounds,
        values: &mut impl Values,
    ) -> Result<bool> {
        values.check_list(kind, length)?;
        for i in 0..length {
            let value = values.next(kind)?;
            let Some(index) = bounds.vertex(value, values) else {
                values.skip(kind, length - i - 1)?;
                return Ok(false);
            };
            self.corners.push(index);
        }
        Ok(true)
    }

    /// Reads the texture coordinates of a face's corners.
    fn coordinates(&mut self, kind: Type, length: u64, values: &mut impl Values) -> Result<()> {
        values.check_list(kind, length)?;
        for _ in 0..length / 2 {
            let (u, v) = (values.next(kind)? as f32, values.next(kind)? as f32);
            let next = self.tex_coords.len() as u32;
            let number = *self.numbers.entry([u, v].map(f32::to_bits)).or_insert(next);
            if number == next {
                self.tex_coords.push(Vec2::new(u, 1.0 - v));
            }
            self.coords.push(number);
        }
        values.skip(kind, length % 2)
    }

    /// Adds the face that was read.
    fn add(&mut self, color: RowColor, texture: Option<u32>, values: &impl Values) {
        if self.corners.len() < 3 {
            return self.small.add(|| values.place());
        }
        if self.coords.len() != self.corners.len() && !self.coords.is_empty() {
            self.odd_tex_coords.add(|| values.place());
            self.coords.clear();
        }
        if let Some(texture) = texture {
            self.textures.resize(self.facets.count(), 0);
            self.textures.push(texture);
        }
        let color = color.number(&mut self.facets.palette);
        self.facets.add(&self.corners, &self.coords, color);
    }

    /// Reads triangles of strips, one after another, with −1 between them; every second one is turned
    /// over. Those that repeat a vertex only join strips and are left out.
    fn strip(
        &mut self,
        kind: Type,
        length: u64,
        bounds: &mut Bounds,
        values: &mut impl Values,
    ) -> Result<()> {
        values.check_list(kind, length)?;
        let (mut a, mut b, mut seen) = (0, 0, 0u64);
        for _ in 0..length {
            let value = values.next(kind)?;
            let next = if value < 0.0 { None } else { bounds.vertex(value, values) };
            let Some(next) = next else {
                seen = 0;
                continue;
            };
            if seen >= 2 && a != b && b != next && a != next {
                let triangle = if seen % 2 == 0 { [a, b, next] } else { [b, a, next] };
                self.facets.add(&triangle, &[], NONE);
            }
            (a, b, seen) = (b, next, seen + 1);
        }
        Ok(())
    }

    /// Returns the messages about faces that were left out or changed.
    pub fn warnings(&self) -> [(&Tally, &'static str); 2] {
        [
            (
                &self.small,
                "{face has|faces have} fewer than three vertices and {was|were} left out",
            ),
            (
                &self.odd_tex_coords,
                "{face has|faces have} different numbers of texture coordinates and vertices; {it gets|they get} none",
            ),
        ]
    }
}

/// Returns the number of a picture; the largest means none.
fn picture(value: f64) -> u32 {
    if value >= 0.0 { value as u32 } else { u32::MAX }
}
