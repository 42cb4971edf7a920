//! From the rows of a PLY file to vertices, faces and edges.

use super::body::Values;
use super::bounds::{Bounds, list_length};
use super::faces::Faces;
use super::header::{Element, Header};
use super::names::{Plan, Role, Use};
use super::row_color::RowColor;
use super::vertices::Vertices;
use crate::budget::MODEL;
use crate::facets::Palette;
use crate::obj::corners::{Corner, Corners, NONE};
use crate::wording::counted;
use crate::{Error, Limits, Place, Result};

/// The edges so far.
#[derive(Debug, Default)]
pub(super) struct Edges {
    /// Both ends of each.
    pub ends: Corners,
    /// Their colours, which ends name in place of normals.
    pub palette: Palette,
}

impl Edges {
    fn row(
        &mut self,
        plan: &Plan,
        row: u64,
        bounds: &mut Bounds,
        values: &mut impl Values,
    ) -> Result<()> {
        let (mut ends, mut color) = ([None; 2], RowColor::new(plan.colored));
        for step in &plan.steps {
            match (step.usage, step.list) {
                (_, Some(kind)) => {
                    let length = list_length(kind, values, plan, row)?;
                    values.skip(step.kind, length)?;
                }
                (Use::End(end), None) => {
                    let value = values.next(step.kind)?;
                    ends[end] = bounds.vertex(value, values);
                }
                (Use::Color(part), None) => color.set(part, step.kind, values)?,
                _ => values.skip(step.kind, 1)?,
            }
        }
        if let [Some(from), Some(to)] = ends {
            let normal = color.number(&mut self.palette);
            for position in [from, to] {
                self.ends.push(Corner { position, tex_coord: NONE, normal });
            }
        }
        Ok(())
    }
}

/// Builder that collects the contents of the file.
pub(super) struct Builder {
    pub bounds: Bounds,
    pub vertices: Vertices,
    pub faces: Faces,
    pub edges: Edges,
    /// Messages about elements that are not drawn.
    pub unread: Vec<String>,
}

impl Builder {
    pub fn new(header: &Header, limits: Limits) -> Self {
        Self {
            bounds: Bounds::new(header, limits),
            vertices: Vertices::default(),
            faces: Faces::default(),
            edges: Edges::default(),
            unread: Vec::new(),
        }
    }

    /// Returns whether there is a triangle to show.
    pub fn has_faces(&self) -> bool {
        self.faces.has_any()
    }

    /// Prepares for `count` rows of an element.
    ///
    /// # Errors
    /// A vertex without coordinates; more rows than allowed.
    pub fn begin(&mut self, element: &Element, count: u64) -> Result<Plan> {
        let plan = Plan::new(element);
        let limit = self.bounds.limits.primitives.min(u64::from(u32::MAX / 3));
        if !matches!(plan.role, Role::Other | Role::Quiet) && count > limit {
            let what = "number of elements";
            return Err(Error::Limit { place: Place::Whole, what, value: count, limit });
        }
        let rows = count as usize;
        self.bounds.limits.work.keep(MODEL, count.saturating_mul(plan.bytes()))?;
        match plan.role {
            Role::Vertex => self.vertices.begin(&plan, rows)?,
            Role::Face | Role::Strip => self.faces.begin(&plan, rows),
            Role::Edge => self.edges.ends.indices.reserve_exact(2 * rows),
            Role::Quiet | Role::Other => {}
        }
        self.note_unread(&plan, element.count);
        Ok(plan)
    }

    /// Warns of elements that are not drawn.
    fn note_unread(&mut self, plan: &Plan, count: u64) {
        let lacks = match plan.role {
            Role::Face | Role::Strip if !plan.has(Use::Indices) => "no list `vertex_indices`",
            Role::Edge if !(plan.has(Use::End(0)) && plan.has(Use::End(1))) => {
                "no properties `vertex1` and `vertex2`"
            }
            Role::Other => "a name that is not known",
            _ => return,
        };
        if count > 0 {
            let name = &plan.name;
            let rows = counted(count, "row is", "rows are");
            self.unread.push(format!("element `{name}` has {lacks}: its {rows} left out"));
        }
    }

    /// Reads one row.
    ///
    /// # Errors
    /// Values that are missing or wrong.
    pub fn row(&mut self, plan: &Plan, row: u64, values: &mut impl Values) -> Result<()> {
        match plan.role {
            Role::Vertex => self.vertices.row(plan, row, values),
            Role::Face | Role::Strip => self.faces.row(plan, row, &mut self.bounds, values),
            Role::Edge => self.edges.row(plan, row, &mut self.bounds, values),
            Role::Quiet | Role::Other => skip(plan, row, values),
        }
    }
}

/// Steps over a row.
fn skip(plan: &Plan, row: u64, values: &mut impl Values) -> Result<()> {
    for step in &plan.steps {
        let count = match step.list {
            Some(kind) => list_length(kind, values, plan, row)?,
            None => 1,
        };
        values.skip(step.kind, count)?;
    }
    Ok(())
}
