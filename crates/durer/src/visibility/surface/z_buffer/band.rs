//! The framebuffer in rows of tiles.

use super::tile::TILE;
use crate::target::Framebuffer;
use crate::view::View;
use crate::view::window::PixelRect;

/// A row of tiles of the framebuffer's planes.
pub struct Band<'a> {
    /// Number of the row of tiles, from the window's first.
    pub row: u32,
    /// Pixels of the screen that the planes hold.
    pixels: PixelRect,
    pub color: &'a mut [[u8; 4]],
    pub depth: Option<&'a mut [f32]>,
    pub item: Option<&'a mut [u32]>,
    pub normal: Option<&'a mut [[f32; 3]]>,
}

impl Band<'_> {
    /// Returns whether there are planes beside colour, which show values at pixels' centres.
    pub fn wants_center(&self) -> bool {
        self.depth.is_some() || self.item.is_some() || self.normal.is_some()
    }

    /// Returns the place of a pixel of the screen in the planes, if it is there.
    pub fn place(&self, [x, y]: [i32; 2]) -> Option<usize> {
        let at = |x: i32, y: i32| {
            let (x, y) = (x - self.pixels.x0(), y - self.pixels.y0());
            y as usize * self.pixels.width() as usize + x as usize
        };
        self.pixels.contains(x, y).then(|| at(x, y))
    }

    /// Returns the rows of the colour plane within a tile, given by its first pixel and its pixels across and down: of
    /// each row the place of its first pixel in the tile.
    pub fn rows_of(
        &mut self,
        [x, y]: [i32; 2],
        [width, height]: [i32; 2],
    ) -> impl Iterator<Item = ([i32; 2], &mut [[u8; 4]])> {
        let tile = PixelRect::spanning(x, y, x + width, y + height);
        let (all, part) = (self.pixels, self.pixels.intersection(&tile));
        let columns = (part.x0() - all.x0()) as usize..(part.x1() - all.x0()) as usize;
        let rows = self.color.chunks_mut((all.width() as usize).max(1));
        let rows = rows.skip((part.y0() - all.y0()) as usize);
        let place = move |row: i32| [part.x0() - x, row - y];
        (part.y0()..part.y1()).map(place).zip(rows.map(move |row| &mut row[columns.clone()]))
    }
}

/// Divides the planes, which hold the window of a view, into rows of tiles that threads can write at the same time.
pub fn bands<'a>(framebuffer: &'a mut Framebuffer, view: &View) -> Vec<Band<'a>> {
    let window = view.window();
    let width = window.width() as usize;
    let first = width * (TILE - window.y0() % TILE) as usize;
    let mut depth = framebuffer.depth.as_mut().map(|plane| parts(plane.data_mut(), first, width));
    let mut item = framebuffer.item.as_mut().map(|plane| parts(plane.data_mut(), first, width));
    let mut normal = framebuffer.normal.as_mut().map(|plane| parts(plane.data_mut(), first, width));
    let color = parts(framebuffer.color.data_mut(), first, width);
    let mut y0 = window.y0();
    let band = |(row, color): (u32, &'a mut [[u8; 4]])| {
        let y1 = y0 + (color.len() / width.max(1)) as i32;
        let pixels = PixelRect::spanning(window.x0(), y0, window.x1(), y1);
        y0 = y1;
        Band {
            row,
            pixels,
            color,
            depth: depth.as_mut().and_then(Iterator::next),
            item: item.as_mut().and_then(Iterator::next),
            normal: normal.as_mut().and_then(Iterator::next),
        }
    };
    (0..).zip(color).map(band).collect()
}

/// Divides pixels into those of the first row of tiles, `first` pixels, and those of each following row of tiles.
fn parts<T>(pixels: &mut [T], first: usize, width: usize) -> impl Iterator<Item = &mut [T]> {
    let (first, others) = pixels.split_at_mut(first.min(pixels.len()));
    std::iter::once(first).chain(others.chunks_mut((width * TILE as usize).max(1)))
}
