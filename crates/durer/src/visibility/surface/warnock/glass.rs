//! Windows with blended surfaces: each sample has its opaque surface and a list of the blended ones in front of it.

use super::{BAND, Options, Solver, Step, pixel_mean};
use crate::math::Vec4;
use crate::shade::color::{encode_premultiplied, premultiply};
use crate::target::Framebuffer;
use crate::trace::Tracer;
use crate::visibility::surface::cover::SampleGrid;
use crate::visibility::surface::input::{SurfaceInput, TriangleSet};
use crate::visibility::surface::layers::{Layer, compose, mean, sort_layers};
use crate::visibility::surface::lit::{Lighting, Lit};
use crate::visibility::surface::picture::Picture;
use crate::visibility::surface::visible::{Visible, background_at, nearer, pixels_of};
use crate::visibility::surface::window::SampleRect;

/// The blended surfaces of a window.
pub struct Glass {
    pub blended: TriangleSet,
    pub layers: Vec<Layer>,
}

impl Glass {
    /// Returns the bytes of the layers.
    pub fn bytes(&self) -> u64 {
        (self.layers.capacity() * size_of::<Layer>()) as u64
    }

    /// Adds a layer at a place of the window; parts beyond the far plane are not seen.
    pub fn put(&mut self, place: usize, depth: f32, item: u32) {
        if depth < 1.0 {
            self.layers.push(Layer { place: place as u32, item, depth });
        }
    }

    /// Removes, from the layer `first` on, the layers that an opaque surface hides.
    pub fn keep_before(&mut self, first: usize, opaque: (f32, u32)) {
        let mut kept = first;
        for i in first..self.layers.len() {
            let layer = self.layers[i];
            if nearer((layer.depth, layer.item), opaque) {
                self.layers[kept] = layer;
                kept += 1;
            }
        }
        self.layers.truncate(kept);
    }

    /// Returns the layers of a place, far ones first, after they were sorted.
    fn at(&self, place: usize) -> &[Layer] {
        let first = self.layers.partition_point(|l| (l.place as usize) < place);
        let rest = &self.layers[first..];
        &rest[..rest.partition_point(|l| l.place as usize == place)]
    }
}

/// Renders in bands of rows, so that the lists of a few rows only are kept.
pub fn render(
    input: &SurfaceInput<'_>,
    lighting: Lighting<'_>,
    blended: TriangleSet,
    options: &Options,
    framebuffer: &mut Framebuffer,
    t: &mut impl Tracer<Step>,
) {
    let glass = Some(Glass { blended, layers: Vec::new() });
    let mut pixels = Bands::new(input, lighting, SampleGrid::PIXELS, glass);
    pixels.solve(options, t, |visible, glass| {
        let picture = &mut Picture::with_lighting(lighting, &options.look, framebuffer);
        write_planes(visible, glass, picture);
        if options.sub_levels == 0 {
            write_colors(visible, glass, picture);
        }
    });
    if options.sub_levels > 0 {
        let grid = SampleGrid::below_pixel(options.sub_levels);
        let mut samples = Bands::new(input, lighting, grid, pixels.solver.glass);
        let mut lit = Lit::new(lighting);
        let SampleRect { x0: left, y0: top, .. } = pixels_of(input.view);
        samples.solve(options, t, |visible, glass| {
            let [x0, x1, y0, y1] = in_pixels(visible, grid);
            for (x, y) in (y0..y1).flat_map(|y| (x0..x1).map(move |x| (x, y))) {
                let behind = background_at(&options.look, input.view.height(), y);
                let color = of_samples(visible, glass, &mut lit, grid, [x, y], behind);
                let (x, y) = ((x - left) as u32, (y - top) as u32);
                framebuffer.color.set(x, y, encode_premultiplied(color));
            }
        });
    }
}

/// Returns the first column and the one after the last, and the rows likewise, of a window of samples.
fn in_pixels(visible: &Visible, grid: SampleGrid) -> [i32; 4] {
    let SampleRect { x0, x1, y0, y1 } = visible.window();
    [x0, x1, y0, y1].map(|v| v / grid.per_pixel())
}

/// A solver that proceeds down the picture.
struct Bands<'a> {
    solver: Solver<'a>,
    grid: SampleGrid,
    pixels: SampleRect,
}

impl<'a> Bands<'a> {
    fn new(
        input: &'a SurfaceInput<'_>,
        lighting: Lighting<'a>,
        grid: SampleGrid,
        glass: Option<Glass>,
    ) -> Self {
        let nothing = SampleRect { x0: 0, y0: 0, x1: 0, y1: 0 };
        let solver = Solver::new(input, lighting, grid, nothing, glass);
        Self { solver, grid, pixels: pixels_of(input.view) }
    }

    /// Solves one band after the other and hands each over, its layers sorted.
    fn solve(
        &mut self,
        options: &Options,
        t: &mut impl Tracer<Step>,
        mut solved: impl FnMut(&Visible, &Glass),
    ) {
        let (n, SampleRect { x0, y0, x1, y1 }) = (self.grid.per_pixel(), self.pixels);
        for top in (y0..y1).step_by(BAND as usize) {
            let bottom = y1.min(top + BAND);
            let window = SampleRect { x0: x0 * n, y0: top * n, x1: x1 * n, y1: bottom * n };
            self.solver.restart(window);
            self.solver.run(window, options.division, t);
            if let Some(glass) = &mut self.solver.glass {
                sort_layers(&mut glass.layers);
                solved(&self.solver.visible, glass);
            }
        }
    }
}

/// Writes depth, item and normal of the nearest surface, blended or not.
fn write_planes(visible: &Visible, glass: &Glass, picture: &mut Picture<'_>) {
    let mut nearest = visible.clone();
    for layer in &glass.layers {
        // The last one at a place is the nearest.
        let place = layer.place as usize;
        (nearest.depth[place], nearest.item[place]) = (layer.depth, layer.item);
    }
    nearest.rows().for_each(|([x, y], items, depths)| picture.write_planes(x, y, items, depths));
}

fn write_colors(visible: &Visible, glass: &Glass, picture: &mut Picture<'_>) {
    visible.rows().for_each(|([x, y], items, _)| picture.write_color(x, y, items));
    for layers in glass.layers.chunk_by(|a, b| a.place == b.place) {
        let place = layers[0].place as usize;
        let [x, y] = visible.place(place);
        let behind = premultiply(picture.behind(y));
        let items = layers.iter().map(|l| l.item);
        let sum = compose(&mut picture.lit, visible.item[place], items, behind, [x, y]);
        picture.set_color(x as u32, y as u32, sum);
    }
}

/// Returns the mean of a pixel's samples.
fn of_samples(
    visible: &Visible,
    glass: &Glass,
    lit: &mut Lit<'_>,
    grid: SampleGrid,
    [x, y]: [i32; 2],
    behind: Vec4,
) -> Vec4 {
    let n = grid.per_pixel();
    let rows = y * n..(y + 1) * n;
    let places = rows.flat_map(|row| {
        let start = visible.index(x * n, row);
        start..start + n as usize
    });
    if places.clone().all(|place| glass.at(place).is_empty()) {
        return pixel_mean(visible, lit, n, [x, y], behind);
    }
    let stack = |place: usize| {
        let layers = glass.at(place).iter().map(|l| l.item);
        std::iter::once(visible.item[place]).chain(layers).collect()
    };
    let mut stacks: Vec<Vec<u32>> = places.map(stack).collect();
    mean(&mut stacks, |stack| compose(lit, stack[0], stack[1..].iter().copied(), behind, [x, y]))
}
