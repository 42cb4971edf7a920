//! Tiles of the screen, each with its polygons sorted by depth.

use super::piece::{Key, Pieces};
use crate::view::View;
use crate::visibility::surface::window::SampleRect;

/// Pixels along the side of a tile. Smaller ones cost memory for large polygons, larger ones more
/// tests among small polygons.
const TILE: i32 = 16;

pub struct Tiles {
    columns: i32,
    /// Farthest first; polygons before `first` are done.
    lists: Vec<Vec<Key>>,
    first: Vec<usize>,
}

impl Tiles {
    pub fn new(pieces: &Pieces<'_>, view: &View) -> Self {
        let across = |pixels: u32| (pixels as i32 + TILE - 1) / TILE;
        let (columns, rows) = (across(view.width()), across(view.height()));
        let count = columns as usize * rows as usize;
        let mut tiles = Self { columns, lists: vec![Vec::new(); count], first: vec![0; count] };
        for polygon in 0..pieces.len() {
            for tile in tiles.of(pieces.window(polygon)) {
                tiles.lists[tile].push(pieces.key(polygon));
            }
        }
        tiles.lists.iter_mut().for_each(|list| list.sort_unstable_by(|a, b| b.cmp(a)));
        tiles
    }

    /// Returns the bytes that the lists of these polygons take, before they are made: large polygons are in many. Lists
    /// that have grown have room for up to twice as many.
    pub fn bytes(pieces: &Pieces<'_>, view: &View) -> u64 {
        let across = |from: i32, to: i32| ((to + TILE - 1) / TILE - from / TILE).max(0) as u64;
        let tiles = |w: &SampleRect| across(w.x0, w.x1) * across(w.y0, w.y1);
        let keys: u64 = (0..pieces.len()).map(|polygon| tiles(pieces.window(polygon))).sum();
        let lists = across(0, view.width() as i32) * across(0, view.height() as i32);
        keys * 2 * size_of::<Key>() as u64 + lists * size_of::<Vec<Key>>() as u64
    }

    /// Returns the tiles that a window of pixels of the screen has a part in.
    pub fn of(&self, w: &SampleRect) -> impl Iterator<Item = usize> + use<> {
        let columns = self.columns;
        let end = |v: i32| (v + TILE - 1) / TILE;
        let (x0, x1, y0, y1) = (w.x0 / TILE, end(w.x1), w.y0 / TILE, end(w.y1));
        (y0..y1).flat_map(move |y| (x0..x1).map(move |x| (y * columns + x) as usize))
    }

    /// Leaves out polygons at the far end of a tile's list that are done.
    pub fn skip_done(&mut self, tile: usize, done: &[bool]) {
        let first = &mut self.first[tile];
        let left = &self.lists[tile][*first..];
        *first += left.iter().take_while(|key| done[key.polygon as usize]).count();
    }

    /// Returns the polygon at a place of a tile's list, which may be done.
    pub fn get(&self, tile: usize, place: usize) -> Option<u32> {
        self.lists[tile].get(self.first[tile] + place).map(|key| key.polygon)
    }

    pub fn insert(&mut self, polygon: u32, pieces: &Pieces<'_>) {
        let key = pieces.key(polygon);
        for tile in self.of(pieces.window(polygon)) {
            let first = self.first[tile];
            let place = self.lists[tile][first..].partition_point(|other| *other > key);
            self.lists[tile].insert(first + place, key);
        }
    }
}
