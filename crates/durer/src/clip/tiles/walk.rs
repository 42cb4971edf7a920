//! From the world down to the tiles of one level.

use super::Tile;
use crate::Result;
use crate::parallel;

/// A feature to be divided into tiles, or a part of it.
pub trait Content: Send + Sync + Sized {
    /// Returns the parts in some tiles inside the tile that this part comes from; `None` for tiles without a part.
    ///
    /// # Errors
    /// Any error of the implementation.
    fn within(&self, tiles: &[Tile]) -> Result<Vec<Option<Self>>>;

    /// Returns the amount of work, in positions.
    fn size(&self) -> usize;

    /// Returns whether it covers a tile wholly, and so all tiles within it.
    fn covers(&self, tile: Tile) -> bool;
}

/// Number of levels of a subtree that one thread processes at once, if it has no more than …
const LEVELS: u8 = 2;

/// … this many positions.
const SIZE: usize = 1 << 16;

/// Results of this many subtrees are held at once.
const JOBS: usize = 32;

type Open<C> = Vec<(Tile, Vec<C>)>;

/// Visits the non-empty tiles of a level in the order of Hilbert's curve: `make` turns a tile's contents into a result,
/// on any thread, and `take` takes the results in order.
///
/// The contents keep their order. Parts are cut from the parts in the tiles of the level
/// above, so that the time grows with the contents and not with the number of tiles. At any time, the contents of the
/// tiles on the way down to one are in memory.
///
/// # Errors
/// The first error of [`Content::within`], and those of `take`.
pub fn walk<C: Content, R: Send, E: From<crate::Error>>(
    contents: &[C],
    zoom: u8,
    make: impl Fn(Tile, Vec<C>) -> R + Sync + Send,
    mut take: impl FnMut(Tile, R) -> std::result::Result<(), E>,
) -> std::result::Result<(), E> {
    let mut open: Open<C> = parts(contents, &[Tile::WORLD])?;
    let mut jobs: Open<C> = Vec::new();
    while let Some((tile, contents)) = open.pop() {
        let levels = zoom.saturating_sub(tile.zoom);
        let size: usize = contents.iter().map(Content::size).sum();
        if levels == 0 || (levels <= LEVELS && size <= SIZE) {
            jobs.push((tile, contents));
        } else {
            open.extend(parts(&contents, &tile.children())?.into_iter().rev());
        }
        if jobs.len() >= JOBS || open.is_empty() {
            let done = parallel::map(std::mem::take(&mut jobs), |(tile, contents)| {
                subtree(tile, contents, zoom, &make)
            });
            for tiles in done {
                tiles?.into_iter().try_for_each(|(tile, made)| take(tile, made))?;
            }
        }
    }
    Ok(())
}

/// Makes the tiles of a subtree.
fn subtree<C: Content, R>(
    tile: Tile,
    contents: Vec<C>,
    zoom: u8,
    make: &impl Fn(Tile, Vec<C>) -> R,
) -> Result<Vec<(Tile, R)>> {
    let (mut open, mut done) = (vec![(tile, contents)], Vec::new());
    while let Some((tile, contents)) = open.pop() {
        if tile.zoom >= zoom {
            done.push((tile, make(tile, contents)));
        } else {
            open.extend(parts(&contents, &tile.children())?.into_iter().rev());
        }
    }
    Ok(done)
}

/// Number of contents that one task cuts.
const TASK: usize = 64;

/// Returns the contents of those tiles that are not empty.
fn parts<C: Content>(contents: &[C], tiles: &[Tile]) -> Result<Open<C>> {
    let tasks: Vec<&[C]> = contents.chunks(TASK).collect();
    let cut = parallel::map(tasks, |some| {
        some.iter().map(|content| content.within(tiles)).collect::<Result<Vec<_>>>()
    });
    let mut open: Open<C> = tiles.iter().map(|&tile| (tile, Vec::new())).collect();
    for some in cut {
        for parts in some? {
            for ((_, contents), part) in open.iter_mut().zip(parts) {
                contents.extend(part);
            }
        }
    }
    open.retain(|(_, contents)| !contents.is_empty());
    Ok(open)
}

/// Counts the tiles of a level that are not empty, up to a limit; above it the result exceeds the limit but may
/// be less than the number.
///
/// Tiles that one content covers wholly are counted without visiting the tiles within them.
///
/// # Errors
/// The first error of [`Content::within`].
pub fn count<C: Content>(contents: &[C], zoom: u8, limit: u64) -> Result<u64> {
    let (mut open, mut count) = (parts(contents, &[Tile::WORLD])?, 0);
    while let Some((tile, contents)) = open.pop() {
        if tile.zoom >= zoom || contents.iter().any(|content| content.covers(tile)) {
            count += tile.count_at(zoom);
        } else {
            open.extend(parts(&contents, &tile.children())?);
        }
        if count > limit {
            break;
        }
    }
    Ok(count)
}
