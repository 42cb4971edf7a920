//! Features, as all formats of geodata share them.

use durer::clip::polygon::WindingRule;
use durer::geometry::Geometry;

/// A member of a JSON object: its name and its value as the file writes them.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Member {
    /// The name in JSON, with its quotes.
    pub name: String,
    /// The value in JSON.
    pub value: String,
}

/// An object with a geometry and properties.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Feature {
    /// Its geometry, if it has one.
    pub geometry: Option<Geometry>,
    /// The properties, a JSON object as the file writes it; `None` for null.
    pub properties: Option<String>,
    /// The id, a JSON string or number as the file writes it.
    pub id: Option<String>,
    /// Members that the format does not define, in the file's order. `bbox` is never kept: it would
    /// be wrong once the geometry is cut.
    pub members: Vec<Member>,
    /// Members of its geometry that the format does not define.
    pub geometry_members: Vec<Member>,
    /// The number of the coordinate system, of EWKT, EWKB and files that state it for all features.
    pub srid: Option<i32>,
    /// Fill rule of its polygons: even-odd, except for paths of an SVG.
    pub fill_rule: WindingRule,
}

impl Feature {
    /// Creates a feature from a geometry alone.
    pub fn of_geometry(geometry: Geometry) -> Self {
        Self { geometry: Some(geometry), ..Self::default() }
    }

    /// Returns the properties in order.
    pub fn fields(&self) -> Vec<Member> {
        super::members::members(self.properties.as_deref().unwrap_or_default())
    }

    /// Sets all properties.
    pub fn set_fields(&mut self, fields: &[Member]) {
        self.properties = Some(super::members::object(fields));
    }
}
