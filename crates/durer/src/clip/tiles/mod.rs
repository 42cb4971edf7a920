//! Tiles of web maps: the square of Web Mercator, halved on both axes per zoom level; tile 0/0/0 is
//! the world, x counts to the east, y to the south.
//!
//! [`walk()`] descends from the world to the tiles of one level and clips their contents on the way; [`Tiling`] clips
//! geometries as they are; [`Pyramid`] prepares features for vector tiles: simplified, on a grid of whole numbers, for
//! many levels. [`DetailLevel`] is the level at which their detail is visible.

mod apart;
mod detail;
mod level;
pub mod mercator;
mod options;
mod piece;
mod place;
mod pyramid;
mod ready;
mod tiling;
mod walk;

pub use detail::{DetailLevel, Reason};
pub use options::Options;
pub use piece::{GridShape, TileBody, TilePiece};
pub use place::{PlacedGeometry, extent, place};
pub use pyramid::Pyramid;
pub use ready::{TileFeature, WORLDS};
pub use tiling::{Reach, Subject, Tiling};
pub use walk::{Content, count, walk};

use super::hilbert;
use crate::sorting::CompactSort;

/// A tile.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Tile {
    /// The zoom level: there are 2^zoom tiles on each axis. At most [`Tile::MAX_ZOOM`].
    pub zoom: u8,
    /// Column, counted to the east.
    pub x: u32,
    /// Row, counted to the south.
    pub y: u32,
}

/// Coordinates of features to be placed on tiles.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Coordinates {
    /// Longitude and latitude in degrees.
    #[default]
    LonLat,
    /// Web Mercator (EPSG:3857), in metres.
    Mercator,
}

impl std::fmt::Display for Tile {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}/{}/{}", self.zoom, self.x, self.y)
    }
}

impl Tile {
    /// The tile that contains the whole world.
    pub const WORLD: Self = Self { zoom: 0, x: 0, y: 0 };

    /// The finest level: with a grid of 2^14 in each tile, places are still whole numbers of 38 bits.
    pub const MAX_ZOOM: u8 = 24;

    /// Returns the four tiles that it consists of, in the order of Hilbert's curve.
    ///
    /// ```
    /// use durer::clip::tiles::Tile;
    /// let ids = Tile::WORLD.children().map(Tile::id);
    /// assert_eq!(ids, [1, 2, 3, 4]);
    /// ```
    pub fn children(self) -> [Self; 4] {
        let (zoom, x, y) = (self.zoom + 1, 2 * self.x, 2 * self.y);
        let mut children =
            [(0, 0), (0, 1), (1, 0), (1, 1)].map(|(i, j)| Self { zoom, x: x + i, y: y + j });
        children.compact_sort_by_key(|child| child.id());
        children
    }

    /// Returns its number over all levels, coarse ones first, each along Hilbert's curve: the one of
    /// PMTiles 3.
    pub fn id(self) -> u64 {
        let zoom = self.zoom.min(31);
        let before = ((1u64 << (2 * u32::from(zoom))) - 1) / 3;
        before + hilbert::index(zoom, self.x, self.y)
    }

    /// Returns the number of tiles of a level in this one; 1 if the level is not finer.
    pub(crate) fn count_at(self, zoom: u8) -> u64 {
        1 << (2 * u32::from(zoom.saturating_sub(self.zoom).min(31)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ids_are_those_of_pmtiles() {
        let id = |zoom, x, y| Tile { zoom, x, y }.id();
        assert_eq!(
            [id(0, 0, 0), id(1, 0, 0), id(1, 0, 1), id(1, 1, 1), id(1, 1, 0)],
            [0, 1, 2, 3, 4]
        );
        assert_eq!([id(2, 0, 0), id(2, 3, 0), id(20, 0, 0)], [5, 20, 366_503_875_925]);
        // From the tests of PMTiles' own library.
        assert_eq!(id(12, 3423, 1763), 19_078_479);
    }

    #[test]
    fn children_are_next_to_each_other_on_the_curve() {
        let tile = Tile { zoom: 5, x: 19, y: 7 };
        let ids = tile.children().map(Tile::id);
        assert!(ids.windows(2).all(|pair| pair[1] == pair[0] + 1), "{ids:?}");
        assert_eq!((tile.count_at(7), tile.count_at(3)), (16, 1));
    }
}
