//! A pyramid of depths.

use super::Screen;
use crate::Result;
use crate::math::DVec2;
use crate::target::Pixels;

/// Levels of depths: the z-buffer, and levels of half the size, whose entries are the farthest of four, up to a single
/// one.
pub struct Pyramid {
    levels: Vec<Pixels<f64>>,
}

/// Place in a pyramid.
pub struct Entry {
    pub level: u32,
    /// Column and row.
    pub at: [u32; 2],
}

impl Pyramid {
    /// Creates a pyramid with all depths infinite.
    pub fn new(screen: &Screen) -> Result<Self> {
        let mut levels = vec![screen.plane(f64::INFINITY)?];
        let (mut width, mut height) = (screen.width, screen.height);
        while width > 1 || height > 1 {
            (width, height) = (width.div_ceil(2), height.div_ceil(2));
            let work = (&screen.work, "planes of the picture");
            levels.push(Pixels::within(work, width, height, f64::INFINITY)?);
        }
        Ok(Self { levels })
    }

    /// Returns the farthest depth of an entry; for an entry outside, a depth that hides everything.
    pub fn get(&self, level: u32, [x, y]: [u32; 2]) -> f64 {
        let plane = self.levels.get(level as usize);
        plane.and_then(|plane| plane.get(x, y)).unwrap_or(f64::NEG_INFINITY)
    }

    /// Returns the finest entry that covers all pixels of a rectangle; `None` outside of the picture.
    pub fn covering(&self, low: DVec2, high: DVec2) -> Option<Entry> {
        let base = self.levels.first()?;
        let range = |low: f64, high: f64, size: u32| {
            let [first, end] =
                [low.floor(), high.ceil()].map(|v| v.clamp(0.0, f64::from(size)) as u32);
            (first < end).then(|| (first, end - 1))
        };
        let (x0, x1) = range(low.x, high.x, base.width())?;
        let (y0, y1) = range(low.y, high.y, base.height())?;
        let differ = |level: &u32| x0 >> level != x1 >> level || y0 >> level != y1 >> level;
        let level = (0..u32::BITS).take_while(differ).count() as u32;
        Some(Entry { level, at: [x0 >> level, y0 >> level] })
    }

    /// Sets the depth of a pixel, and calls `changed` for each entry above that gets a nearer depth by it.
    pub fn lower(
        &mut self,
        [mut x, mut y]: [u32; 2],
        depth: f64,
        mut changed: impl FnMut(u32, [u32; 2], f64),
    ) {
        self.levels[0].set(x, y, depth);
        for level in 1..self.levels.len() {
            (x, y) = (x / 2, y / 2);
            let below = level as u32 - 1;
            let four = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(i, j)| [2 * x + i, 2 * y + j]);
            let farthest =
                four.into_iter().map(|at| self.get(below, at)).fold(f64::NEG_INFINITY, f64::max);
            if self.get(level as u32, [x, y]) == farthest {
                return;
            }
            self.levels[level].set(x, y, farthest);
            changed(level as u32, [x, y], farthest);
        }
    }
}
