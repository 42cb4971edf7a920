//! From the contents of a tile to its bytes.

use super::args::{TileFormat, TilesArgs};
use super::layers::{Layers, Row};
use durer::clip::tiles::{GridShape, Tile, TilePiece};
use durer_formats::geo::{Feature, GeoFormat, Member, Writer};
use durer_formats::tiles::{Layer, Value, encode, gzip};
use std::collections::{BTreeMap, HashSet};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

/// Maker of tiles, usable on any thread.
pub struct Maker<'a> {
    format: TileFormat,
    extent: u32,
    last_zoom: u8,
    all: &'a Layers,
    /// True for each row that is in some tile.
    seen: Vec<AtomicBool>,
    /// Compressed tiles that features cover wholly: inside a large feature all are the same.
    covered: Mutex<BTreeMap<Vec<u8>, Vec<u8>>>,
}

/// Number of tiles to hold.
const HELD: usize = 4096;

/// A tile.
pub struct Made {
    pub bytes: Vec<u8>,
    pub features: u64,
}

impl<'a> Maker<'a> {
    pub fn new(args: &TilesArgs, format: TileFormat, last_zoom: u8, all: &'a Layers) -> Self {
        let seen = all.rows.iter().map(|_| AtomicBool::new(false)).collect();
        let covered = Mutex::default();
        Self { format, extent: args.extent, last_zoom, all, seen, covered }
    }

    /// Returns the number of features that are in no tile.
    pub fn lost(&self) -> u64 {
        self.seen.iter().filter(|seen| !seen.load(Ordering::Relaxed)).count() as u64
    }

    /// Returns the bytes of a tile.
    pub fn make(&self, tile: Tile, mut pieces: Vec<TilePiece>) -> Made {
        for piece in &pieces {
            self.seen[self.all.row_of[piece.feature]].store(true, Ordering::Relaxed);
        }
        if tile.zoom < self.last_zoom {
            self.merge_points(&mut pieces);
        }
        let bytes = match self.format {
            TileFormat::Pmtiles | TileFormat::Mbtiles => self.packed(&pieces),
            TileFormat::Mvt => self.vector(&pieces),
            TileFormat::Geojson => self.geojson(tile, &pieces),
        };
        Made { bytes, features: pieces.len() as u64 }
    }

    /// Returns the compressed bytes, of tiles that come often from memory.
    fn packed(&self, pieces: &[TilePiece]) -> Vec<u8> {
        let bytes = self.vector(pieces);
        let covers = |piece: &TilePiece| matches!(&piece.shape, GridShape::Areas(s) if s.points().len() == 4);
        if !pieces.iter().all(covers) {
            return gzip(&bytes);
        }
        // The value is consistent even if a thread panicked.
        let covered = || self.covered.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(packed) = covered().get(&bytes) {
            return packed.clone();
        }
        let packed = gzip(&bytes);
        let mut covered = covered();
        if covered.len() < HELD {
            covered.insert(bytes, packed.clone());
        }
        packed
    }

    fn row(&self, piece: &TilePiece) -> &Row {
        &self.all.rows[self.all.row_of[piece.feature]]
    }

    /// Keeps the first of several points with the same properties at the same place.
    fn merge_points(&self, pieces: &mut Vec<TilePiece>) {
        let mut seen = HashSet::new();
        pieces.retain_mut(|piece| {
            let row = self.row(piece);
            let GridShape::Points(points) = &mut piece.shape else { return true };
            points.retain(|p| seen.insert((row.layer, &row.properties, p.x, p.y)));
            !points.is_empty()
        });
    }

    fn vector(&self, pieces: &[TilePiece]) -> Vec<u8> {
        let layer = |l: &'a super::layers::Layer| Layer::new(&l.name, self.extent, &l.dictionary);
        let mut layers: Vec<Layer<'_>> = self.all.layers.iter().map(layer).collect();
        for piece in pieces {
            let row = self.row(piece);
            layers[row.layer].add(row.id, &row.properties, &piece.shape);
        }
        encode(&layers)
    }

    fn geojson(&self, tile: Tile, pieces: &[TilePiece]) -> Vec<u8> {
        let mut writer = Writer::new(GeoFormat::GeoJson, Vec::new());
        for piece in pieces {
            let row = self.row(piece);
            let feature = Feature {
                geometry: Some(piece.shape.in_degrees(tile, self.extent)),
                properties: Some(self.properties(row)),
                id: row.id.map(|id| id.to_string()),
                members: vec![Member {
                    name: "\"layer\"".to_owned(),
                    value: serde_json::Value::from(&self.all.layers[row.layer].name[..])
                        .to_string(),
                }],
                ..Feature::default()
            };
            // Memory takes all that comes.
            let _ = writer.write(&feature);
        }
        writer.finish(&[]).unwrap_or_default()
    }

    fn properties(&self, row: &Row) -> String {
        let dictionary = &self.all.layers[row.layer].dictionary;
        let mut object = serde_json::Map::new();
        for &(name, value) in &row.properties {
            let (Some(name), Some(value)) =
                (dictionary.names().get(name as usize), dictionary.get(value))
            else {
                continue;
            };
            let value = match value {
                Value::Text(text) => text.clone().into(),
                Value::Number(value) => (*value).into(),
                Value::Unsigned(value) => (*value).into(),
                Value::Signed(value) => (*value).into(),
                Value::Bool(value) => (*value).into(),
            };
            object.insert(name.clone(), value);
        }
        serde_json::Value::Object(object).to_string()
    }
}
