//! Tiles of web maps: the square of Web Mercator, halved on both axes per zoom level; tile 0/0/0 is
//! the world, x counts to the east, y to the south.

use super::args::TileCoordinates;
use super::engine::{Cutter, Rules};
use super::mask::Mask;
use durer::clip::polygon::BooleanOp;
use durer::math::{DVec2, Rect};
use durer_formats::geo::Geometry;
use std::f64::consts::PI;

/// Half the circumference of the sphere of Web Mercator, in metres.
const HALF_WORLD: f64 = PI * 6_378_137.0;

/// A tile.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Tile {
    pub zoom: u8,
    pub x: u32,
    pub y: u32,
}

impl std::fmt::Display for Tile {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}/{}/{}", self.zoom, self.x, self.y)
    }
}

impl Tile {
    const WORLD: Self = Self { zoom: 0, x: 0, y: 0 };

    fn children(self) -> [Self; 4] {
        let (zoom, x, y) = (self.zoom + 1, 2 * self.x, 2 * self.y);
        [(0, 0), (0, 1), (1, 0), (1, 1)].map(|(i, j)| Self { zoom, x: x + i, y: y + j })
    }

    /// What it covers. Borders of neighbours are the same numbers.
    pub fn bounds(self, coordinates: TileCoordinates) -> durer::Result<Rect> {
        let side = f64::from(1u32 << self.zoom);
        let x = |x: u32| {
            let part = f64::from(x) / side * 2.0 - 1.0;
            match coordinates {
                TileCoordinates::Lonlat => part * 180.0,
                TileCoordinates::Mercator => part * HALF_WORLD,
            }
        };
        let y = |y: u32| {
            let part = 1.0 - f64::from(y) / side * 2.0;
            match coordinates {
                TileCoordinates::Lonlat => latitude(part),
                TileCoordinates::Mercator => part * HALF_WORLD,
            }
        };
        Rect::new(DVec2::new(x(self.x), y(self.y + 1)), DVec2::new(x(self.x + 1), y(self.y)))
    }
}

/// The latitude in degrees at a height of the square, 1 at its upper border.
fn latitude(part: f64) -> f64 {
    libm::atan(libm::sinh(part * PI)).to_degrees()
}

/// A tile and what lies in it.
pub type Piece = (Tile, Geometry);

/// The parts of a geometry in all tiles of a zoom level, in the order of the tiles' quadtree; and
/// whether it had to be made valid.
///
/// The parts are cut from the parts in the tiles of the level above, so that the time grows with the
/// geometry in the tiles and not with their number.
pub fn cut(
    geometry: &Geometry,
    zoom: u8,
    coordinates: TileCoordinates,
    rules: Rules,
) -> durer::Result<(Vec<Piece>, bool)> {
    let mut repaired = false;
    let mut done = Vec::new();
    let mut open = vec![(Tile::WORLD, geometry.clone())];
    while let Some((tile, geometry)) = open.pop() {
        let mask = &Mask::window(tile.bounds(coordinates)?)?;
        let cutter = Cutter { mask, op: BooleanOp::Intersection, rules, algorithm: None };
        let cut = cutter.cut(&geometry)?;
        repaired |= cut.repaired;
        let Some(part) = cut.geometry else { continue };
        if tile.zoom == zoom {
            done.push((tile, part));
        } else {
            open.extend(tile.children().into_iter().rev().map(|child| (child, part.clone())));
        }
    }
    Ok((done, repaired))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_cover_the_world() {
        let world = Tile::WORLD.bounds(TileCoordinates::Lonlat).expect("bounds");
        assert_eq!((world.min().x, world.max().x), (-180.0, 180.0));
        // The latitude where Web Mercator ends.
        assert!((world.max().y - 85.051_128_779_806_59).abs() < 1e-12);
        let [a, b, ..] = Tile::WORLD.children();
        let (a, b) = (a.bounds(TileCoordinates::Mercator), b.bounds(TileCoordinates::Mercator));
        let (a, b) = (a.expect("bounds"), b.expect("bounds"));
        assert_eq!((a.min().y, a.max().y), (0.0, HALF_WORLD));
        assert_eq!(a.min().y, b.max().y);
    }
}
