//! The framebuffer in rows of tiles.

use super::tile::TILE;
use crate::target::Framebuffer;

/// A row of tiles of the framebuffer's planes.
pub struct Band<'a> {
    pub row: i32,
    pub width: usize,
    pub color: &'a mut [[u8; 4]],
    pub depth: Option<&'a mut [f32]>,
    pub item: Option<&'a mut [u32]>,
    pub normal: Option<&'a mut [[f32; 3]]>,
}

impl Band<'_> {
    /// Returns the rows of the colour plane from a column on, as far as a tile's pixels across and
    /// down.
    pub fn rows_of(
        &mut self,
        column: i32,
        size: [i32; 2],
    ) -> impl Iterator<Item = (i32, &mut [[u8; 4]])> {
        let (start, end) = (column as usize, (column + size[0]) as usize);
        let rows = self.color.chunks_mut(self.width.max(1));
        (0..size[1]).zip(rows.map(move |row| &mut row[start..end]))
    }
}

/// Divides the planes into rows of tiles that threads can write at the same time.
pub fn bands(framebuffer: &mut Framebuffer) -> Vec<Band<'_>> {
    let width = framebuffer.width() as usize;
    let size = width * TILE as usize;
    let mut depth = framebuffer.depth.as_mut().map(|p| p.data_mut().chunks_mut(size));
    let mut item = framebuffer.item.as_mut().map(|p| p.data_mut().chunks_mut(size));
    let mut normal = framebuffer.normal.as_mut().map(|p| p.data_mut().chunks_mut(size));
    let color = framebuffer.color.data_mut().chunks_mut(size);
    color
        .enumerate()
        .map(|(row, color)| Band {
            row: row as i32,
            width,
            color,
            depth: depth.as_mut().and_then(Iterator::next),
            item: item.as_mut().and_then(Iterator::next),
            normal: normal.as_mut().and_then(Iterator::next),
        })
        .collect()
}
