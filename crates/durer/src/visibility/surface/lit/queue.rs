//! Items at pixels from anywhere, that are lit when there are enough of them.

use super::Lit;
use crate::shade::shade_points;
use fearless_simd::Simd;

/// Whether an item has been queued.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Queued {
    /// It has.
    Done,
    /// Not yet: what waits is of another run and has to be shaded first.
    OtherRun,
    /// Its pixels have to be shaded one by one.
    Never,
}

/// Up to so many pixels wait.
pub const QUEUE: usize = 16;

/// Pixels of one plain run.
#[derive(Default)]
pub struct Queue {
    items: [u32; QUEUE],
    pixels: [[i32; 2]; QUEUE],
    /// How many pixels there are.
    pub count: usize,
    /// The first item of their run.
    first_item: u32,
}

impl Lit<'_> {
    /// Adds a pixel of an item to a queue that is not full.
    #[inline(always)]
    pub fn queue(&mut self, item: u32, at: [i32; 2], queue: &mut Queue) -> Queued {
        let info = self.run_info(item);
        if !info.plain {
            return Queued::Never;
        }
        if queue.count > 0 && queue.first_item != info.first_item {
            return Queued::OtherRun;
        }
        queue.first_item = info.first_item;
        let place = queue.count % QUEUE;
        (queue.items[place], queue.pixels[place]) = (item, at);
        queue.count += 1;
        Queued::Done
    }

    /// Linear red, green and blue of the pixels that [`Self::queue`] has added.
    #[inline(always)]
    pub fn shade_queue<S: Simd>(&mut self, simd: S, queue: &Queue) -> [[f32; QUEUE]; 3] {
        let info = self.run_info(queue.first_item);
        let items = &queue.items[..queue.count.min(QUEUE)];
        items.iter().for_each(|&item| self.expect(item));
        self.make_ready();
        let (there, pixels) = ((1 << items.len()) - 1, &queue.pixels);
        let view = self.sight.towards_eye_of(simd, pixels);
        let points = self.points_by_pixel(simd, info.run, &queue.items, there, (pixels, view));
        shade_points(simd, &points, info.material, self.shared.lights, info.shading)
    }
}
