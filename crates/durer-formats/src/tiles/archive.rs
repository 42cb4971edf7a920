//! The metadata of files of tiles.

use serde_json::{Map, Value, json};

/// The metadata of files of tiles.
#[derive(Debug, Clone, PartialEq)]
pub struct Metadata {
    /// Its name.
    pub name: String,
    /// Its lowest and highest level.
    pub zooms: (u8, u8),
    /// West, south, east and north, in degrees.
    pub bounds: [f64; 4],
    /// Credit to show beside the map, as HTML.
    pub attribution: Option<String>,
    /// Contents of its layers.
    pub layers: Vec<LayerInfo>,
}

/// A layer of all tiles.
#[derive(Debug, Clone, PartialEq)]
pub struct LayerInfo {
    /// Its name.
    pub name: String,
    /// Its properties, by name.
    pub fields: Vec<(String, Field)>,
}

/// Kind of a property's values.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Field {
    /// Text, or of several kinds.
    Text,
    /// Numbers.
    Number,
    /// True or false.
    Bool,
}

impl Field {
    /// Returns its name in TileJSON.
    pub fn name(self) -> &'static str {
        match self {
            Self::Text => "String",
            Self::Number => "Number",
            Self::Bool => "Boolean",
        }
    }
}

impl Metadata {
    /// Returns the middle of the bounds, longitude and latitude.
    pub fn center(&self) -> [f64; 2] {
        let [west, south, east, north] = self.bounds;
        [west * 0.5 + east * 0.5, south * 0.5 + north * 0.5]
    }

    /// Returns the member `vector_layers` of TileJSON.
    pub fn vector_layers(&self) -> Value {
        let layer = |layer: &LayerInfo| {
            let fields =
                layer.fields.iter().map(|(name, field)| (name.clone(), json!(field.name())));
            let (first, last) = self.zooms;
            let fields: Map<String, Value> = fields.collect();
            json!({ "id": layer.name, "fields": fields, "minzoom": first, "maxzoom": last })
        };
        self.layers.iter().map(layer).collect()
    }

    /// Returns the members of PMTiles' metadata.
    pub fn to_json(&self) -> Value {
        let mut metadata = json!({
            "name": self.name,
            "type": "overlay",
            "format": "pbf",
            "generator": concat!("durer ", env!("CARGO_PKG_VERSION")),
            "vector_layers": self.vector_layers(),
        });
        if let Some(attribution) = &self.attribution {
            metadata["attribution"] = json!(attribution);
        }
        metadata
    }

    /// Returns a document of [TileJSON 3.0](https://github.com/mapbox/tilejson-spec/tree/master/3.0.0) for
    /// tiles at an address with `{z}`, `{x}` and `{y}`.
    pub fn tile_json(&self, address: &str) -> Value {
        let ([x, y], (first, last)) = (self.center(), self.zooms);
        let mut document = json!({
            "tilejson": "3.0.0",
            "name": self.name,
            "tiles": [address],
            "minzoom": first,
            "maxzoom": last,
            "bounds": self.bounds,
            "center": [x, y, first],
            "vector_layers": self.vector_layers(),
        });
        if let Some(attribution) = &self.attribution {
            document["attribution"] = json!(attribution);
        }
        document
    }
}
