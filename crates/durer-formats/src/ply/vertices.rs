//! The vertices of a PLY file.

use super::body::Values;
use super::bounds::list_length;
use super::header::Type;
use super::names::{
    ALPHA, NORMAL, OPACITY, Plan, RED, ROTATION, SCALE, SPLAT_COLOR, TEX_COORD, Use, VALUES,
};
use crate::facets::Attributes;
use crate::{Error, Result, place};
use durer::math::{DVec3, Vec2, Vec3, Vec4};

/// Half the root of 1 / π, the factor of a splat's first coefficient of spherical harmonics.
const SH_C0: f64 = 0.282_094_791_773_878_14;

/// The vertices so far; all lists except the positions may be empty.
#[derive(Debug, Default)]
pub(super) struct Vertices {
    /// Attributes of the mesh; colours are sRGB values.
    pub all: Attributes,
    /// Positions where the file has double precision.
    pub wide: Option<Vec<DVec3>>,
    /// Size and rotation of Gaussian splats.
    pub splats: Vec<Shape>,
    /// Divisors of the values that the file has.
    present: [Option<f64>; VALUES],
    kinds: Kinds,
}

/// Size and rotation of a splat.
#[derive(Debug, Clone, Copy)]
pub(super) struct Shape {
    /// Natural logarithms of the standard deviations along the axes.
    pub scale: Vec3,
    /// Real part first; of any length.
    pub rotation: [f32; 4],
}

/// Attributes of a vertex besides its position.
#[derive(Debug, Default, Clone, Copy)]
struct Kinds {
    normal: bool,
    color: bool,
    tex_coord: bool,
    /// A splat's colour, which is used if there is no other.
    splat_color: bool,
    splat: bool,
}

impl Vertices {
    /// Prepares for this many rows.
    ///
    /// # Errors
    /// A vertex without coordinates.
    pub fn begin(&mut self, plan: &Plan, count: usize) -> Result<()> {
        let mut wide = false;
        for step in plan.steps.iter().filter(|s| s.list.is_none()) {
            if let Use::Value(slot) = step.usage {
                self.present[slot] = Some(step.kind.full_scale());
                wide |= slot < NORMAL && matches!(step.kind, Type::F64 | Type::I64 | Type::U64);
            }
        }
        for (slot, name) in ["x", "y", "z"].iter().enumerate() {
            if self.present[slot].is_none() {
                return Err(no_coordinate(plan, name));
            }
        }
        let splat = self.has(SCALE, 3) && self.has(ROTATION, 4);
        self.kinds = Kinds {
            normal: self.has(NORMAL, 3),
            color: self.has(RED, 3),
            tex_coord: self.has(TEX_COORD, 2),
            splat_color: self.has(SPLAT_COLOR, 3) && !self.has(RED, 3),
            splat,
        };
        self.reserve(wide, count);
        Ok(())
    }

    fn reserve(&mut self, wide: bool, count: usize) {
        let Kinds { normal, color, tex_coord, splat_color, splat } = self.kinds;
        if wide {
            self.wide.get_or_insert_default().reserve_exact(count);
        } else {
            self.all.positions.reserve_exact(count);
        }
        self.all.normals.reserve_exact(if normal { count } else { 0 });
        self.all.colors.reserve_exact(if color || splat_color { count } else { 0 });
        self.all.tex_coords.reserve_exact(if tex_coord { count } else { 0 });
        self.splats.reserve_exact(if splat { count } else { 0 });
    }

    /// Returns whether the file has `count` values from `slot` on.
    fn has(&self, slot: usize, count: usize) -> bool {
        self.present.iter().skip(slot).take(count).all(Option::is_some)
    }

    /// Returns the number of vertices.
    pub fn len(&self) -> usize {
        self.wide.as_ref().map_or(self.all.positions.len(), Vec::len)
    }

    /// Returns the positions, relative to an origin if they have double precision.
    pub fn into_positions(self, origin: DVec3) -> Vec<Vec3> {
        self.wide.map_or(self.all.positions, |wide| place::narrow(&wide, origin))
    }

    /// Reads one row.
    ///
    /// # Errors
    /// Values that are missing or wrong.
    pub fn row(&mut self, plan: &Plan, row: u64, values: &mut impl Values) -> Result<()> {
        let mut vertex = [0.0; VALUES];
        for step in &plan.steps {
            match (step.usage, step.list) {
                (_, Some(length)) => {
                    let length = list_length(length, values, plan, row)?;
                    values.skip(step.kind, length)?;
                }
                (Use::Value(slot), None) => vertex[slot] = values.next(step.kind)?,
                _ => values.skip(step.kind, 1)?,
            }
        }
        self.add(&vertex);
        Ok(())
    }

    fn add(&mut self, v: &[f64; VALUES]) {
        let three = |at: usize| DVec3::new(v[at], v[at + 1], v[at + 2]);
        match &mut self.wide {
            Some(wide) => wide.push(three(0)),
            None => self.all.positions.push(three(0).as_vec3()),
        }
        if self.kinds.normal {
            let n = three(NORMAL);
            let n = if n.is_finite() { n.normalize_or_zero() } else { DVec3::ZERO };
            self.all.normals.push(n.as_vec3());
        }
        if self.kinds.color {
            let part = |slot: usize| (v[slot] / self.present[slot].unwrap_or(1.0)) as f32;
            let alpha = if self.has(ALPHA, 1) { part(ALPHA) } else { 1.0 };
            // Linear light is computed at the end, where bytes and floats are distinguished.
            self.all.colors.push(Vec4::new(part(RED), part(RED + 1), part(RED + 2), alpha));
        } else if self.kinds.splat_color {
            self.all.colors.push(self.splat_color(three(SPLAT_COLOR), v[OPACITY]));
        }
        if self.kinds.tex_coord {
            self.all
                .tex_coords
                .push(Vec2::new(v[TEX_COORD] as f32, (1.0 - v[TEX_COORD + 1]) as f32));
        }
        if self.kinds.splat {
            let rotation = std::array::from_fn(|i| v[ROTATION + i] as f32);
            self.splats.push(Shape { scale: three(SCALE).as_vec3(), rotation });
        }
    }

    /// Returns the colour of a splat seen from all around, and its opacity.
    fn splat_color(&self, coefficients: DVec3, opacity: f64) -> Vec4 {
        let color = DVec3::splat(0.5) + SH_C0 * coefficients;
        let color = color.as_vec3().clamp(Vec3::ZERO, Vec3::ONE);
        let logistic = 1.0 / (1.0 + libm::exp(-opacity));
        let opacity = if self.has(OPACITY, 1) && logistic.is_finite() { logistic } else { 1.0 };
        color.extend(opacity as f32)
    }
}

fn no_coordinate(plan: &Plan, name: &str) -> Error {
    let Plan { name: element, .. } = plan;
    Error::whole(format!("element `{element}` has no property `{name}`: there is nothing to show"))
}
