//! Things by the tiles of the screen that they are in.

use crate::visibility::surface::z_buffer::tile::TILE;

/// Bits of a pixel's place in its tile.
pub const PIXEL_BITS: u32 = 2 * TILE.trailing_zeros();

/// Bits of an item's number that are kept with a sample of it; the items of a block have the others in common.
pub const ITEM_BITS: u32 = 32 - PIXEL_BITS;

/// The bits of an item's number that are kept with its samples.
pub const LOW_BITS: u32 = (1 << ITEM_BITS) - 1;

/// Entries by tile, in blocks that are not moved.
pub struct Tiles<T> {
    by_tile: Vec<Blocks<T>>,
    /// Things that the blocks have room for.
    room: usize,
}

/// Blocks of one tile.
struct Blocks<T> {
    /// Position of the next item; when there is none, the list is full or has no room.
    open: Vec<T>,
    /// The upper bits of items there.
    upper: u32,
    /// Those before, with the upper bits of their items.
    full: Vec<(u32, Vec<T>)>,
}

/// The least and the most that a block holds: each next one four times as much.
const BLOCK: [usize; 2] = [32, 2048];

impl<T> Default for Tiles<T> {
    fn default() -> Self {
        Self { by_tile: Vec::new(), room: 0 }
    }
}

impl<T> Tiles<T> {
    /// Makes room for the entries of `tiles` tiles.
    pub fn have(&mut self, tiles: usize) {
        self.by_tile.resize_with(tiles, Blocks::default);
    }

    /// Adds an entry of an item at a place on the screen.
    #[inline(always)]
    pub fn push(&mut self, place: u32, item: u32, thing: T) {
        let tile = &mut self.by_tile[(place >> PIXEL_BITS) as usize];
        let upper = item & !LOW_BITS;
        if tile.open.len() == tile.open.capacity() || tile.upper != upper {
            self.room += tile.open_next(upper);
        }
        tile.open.push(thing);
    }

    /// Returns the memory of all blocks in bytes.
    pub fn bytes(&self) -> u64 {
        (self.room * size_of::<T>() + self.by_tile.capacity() * size_of::<Blocks<T>>()) as u64
    }

    /// Returns the items in a tile, block by block, with their upper bits.
    pub fn of(&self, tile: u32) -> impl Iterator<Item = (u32, &[T])> + '_ {
        self.by_tile.get(tile as usize).into_iter().flat_map(|Blocks { full, open, upper }| {
            let full = full.iter().map(|(upper, block)| (*upper, block.as_slice()));
            full.chain([(*upper, open.as_slice())])
        })
    }

    /// Returns whether there is nothing in a tile.
    pub fn nothing_in(&self, tile: u32) -> bool {
        self.by_tile.get(tile as usize).is_none_or(|of_tile| of_tile.open.is_empty())
    }
}

impl<T> Default for Blocks<T> {
    fn default() -> Self {
        Self { open: Vec::new(), upper: 0, full: Vec::new() }
    }
}

impl<T> Blocks<T> {
    /// Opens a block, and returns how much room it has.
    #[cold]
    fn open_next(&mut self, upper: u32) -> usize {
        let [least, most] = BLOCK;
        let size = (4 * self.open.len()).clamp(least, most);
        let full = std::mem::replace(&mut self.open, Vec::with_capacity(size));
        let of_full = std::mem::replace(&mut self.upper, upper);
        if !full.is_empty() {
            self.full.push((of_full, full));
        }
        size
    }
}
