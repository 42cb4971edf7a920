//! MBTiles 1.3: <https://github.com/mapbox/mbtiles-spec/blob/master/1.3/spec.md>, a database of SQLite.

use super::archive::Metadata;
use crate::Result;
use crate::sqlite::{NewDatabase as Database, NewTable as Table, Value, index, record};
use durer::clip::tiles::Tile;
use serde_json::json;
use std::io::{Seek, SeekFrom, Write};

/// Application number "MPBX" of the specification.
const APPLICATION: u32 = 0x4d50_4258;

/// Writer of tiles to an MBTiles file.
pub struct MbTiles<W> {
    out: W,
    database: Database,
    tiles: Table,
    /// Level, column and row of each tile, in the order of the rows.
    places: Vec<(u8, u32, u32)>,
}

impl<W: Write + Seek> MbTiles<W> {
    /// Creates a file without a tile; the target must be empty.
    ///
    /// # Errors
    /// [`crate::Error::Io`].
    pub fn new(out: W) -> Result<Self> {
        Ok(Self { out, database: Database::new(), tiles: Table::new(), places: Vec::new() })
    }

    /// Adds a tile, compressed by [`gzip`](super::gzip()).
    ///
    /// # Errors
    /// [`crate::Error::Io`]; [`crate::Error::Limit`] if the database has no room.
    pub fn add(&mut self, tile: Tile, bytes: &[u8]) -> Result<()> {
        // Rows count to the north.
        let row = (1u32 << tile.zoom) - 1 - tile.y;
        let place = (tile.zoom, tile.x, row);
        let values = cells(place).into_iter().chain([Value::Blob(bytes)]).collect::<Vec<_>>();
        self.tiles.add(&mut self.database, &values)?;
        self.places.push(place);
        Ok(self.out.write_all(&self.database.take())?)
    }

    /// Writes the index of the tiles, and returns the target.
    ///
    /// # Errors
    /// As [`MbTiles::add`].
    pub fn finish(self, metadata: &Metadata) -> Result<W> {
        let Self { mut out, mut database, tiles, places } = self;
        let root = tiles.finish(&mut database)?;
        let mut sorted: Vec<_> = places.into_iter().zip(1i64..).collect();
        sorted.sort_unstable();
        let entry = |(place, row)| {
            record(&cells(place).into_iter().chain([Value::Integer(row)]).collect::<Vec<_>>())
        };
        let entries: Vec<Vec<u8>> = sorted.into_iter().map(entry).collect();
        let index_root = index(&mut database, &entries)?;
        let mut about = Table::new();
        for (name, value) in rows(metadata) {
            about.add(&mut database, &[Value::from(name), Value::from(&value[..])])?;
        }
        let about = about.finish(&mut database)?;
        let sql = "CREATE TABLE metadata (name text, value text)";
        database.name("table", "metadata", "metadata", about, sql);
        let sql = "CREATE TABLE tiles (zoom_level integer, tile_column integer, tile_row integer, tile_data blob)";
        database.name("table", "tiles", "tiles", root, sql);
        let sql = "CREATE UNIQUE INDEX tile_index on tiles (zoom_level, tile_column, tile_row)";
        database.name("index", "tile_index", "tiles", index_root, sql);
        let (first, rest) = database.finish(APPLICATION, 0)?;
        out.write_all(&rest)?;
        out.seek(SeekFrom::Start(0))?;
        out.write_all(&first)?;
        out.seek(SeekFrom::End(0))?;
        out.flush()?;
        Ok(out)
    }
}

fn cells((zoom, x, y): (u8, u32, u32)) -> [Value<'static>; 3] {
    [zoom.into(), x.into(), y.into()].map(Value::Integer)
}

/// Returns the table `metadata`.
fn rows(metadata: &Metadata) -> Vec<(&'static str, String)> {
    let [west, south, east, north] = metadata.bounds;
    let ([x, y], (first, last)) = (metadata.center(), metadata.zooms);
    let mut rows = vec![
        ("name", metadata.name.clone()),
        ("format", "pbf".to_owned()),
        ("bounds", format!("{west},{south},{east},{north}")),
        ("center", format!("{x},{y},{first}")),
        ("minzoom", first.to_string()),
        ("maxzoom", last.to_string()),
        ("type", "overlay".to_owned()),
        ("json", json!({ "vector_layers": metadata.vector_layers() }).to_string()),
    ];
    rows.extend(metadata.attribution.clone().map(|text| ("attribution", text)));
    rows
}
