//! The A-buffer: an anti-aliased, area-averaged, accumulation buffer.
//!
//! L. Carpenter, *The A-buffer, an Antialiased Hidden Surface Method*, SIGGRAPH 1984; masks by
//! look-up as in E. Fiume, A. Fournier, L. Rudolph, *A Parallel Scan Conversion Algorithm with
//! Anti-Aliasing*, SIGGRAPH 1983. Image space. Every triangle leaves in each pixel that it touches a
//! fragment: the mask of the sub-pixels it covers, the exact area, the smallest and the largest
//! depth. A pixel's fragments are sorted front to back; masks give the visible part of each. Where
//! the depths of two overlap within the pixel, a priority mask gives the sub-pixels at which one is
//! in front of the other, so penetrating faces meet in a clean line. Blended surfaces need no order.
//!
//! Deviations: opaque fragments are weighted by their exact area, and masks only determine the hidden part of it;
//! pixels with blended fragments are composed at each sub-pixel. The picture is made row by row. As in all methods, the
//! depth, item and normal planes hold the values at the pixels' centres. Colours and the alpha test of masked surfaces
//! are evaluated at the pixels' centres too.
//!
//! Cost: O(n log n + triangles · rows + fragments + Σ k²) for k fragments that overlap in a pixel.
//! Memory: the triangles, the table (64 kB) and at most [`Options::max_fragments`] fragments of 44
//! bytes: a row with more is made in parts, down to one pixel, whose list is never cut off.

mod coverage;
mod edges;
mod face;
mod faces;
mod fragment;
mod mask;
mod resolve;

use crate::info::{Class, Coherence, Info, Occluder};
use crate::math::Vec4;
use crate::raster::fixed::HALF_PIXEL;
use crate::shade::color::premultiply;
use crate::shade::{PreparedLights, PreparedMaterials, Shading};
use crate::simd::{Level, dispatch};
use crate::target::Framebuffer;
use crate::trace::Tracer;
use crate::visibility::surface::Background;
use crate::visibility::surface::input::{METHOD, SurfaceInput};
use crate::visibility::surface::lit::Lit;
use crate::visibility::surface::lit::{PointQueue, ShadingPoint};
use crate::visibility::surface::picture::{self, Picture};
use crate::visibility::surface::rows::active::ActiveList;
use crate::visibility::surface::rows::nearest::{DepthRow, Masked};
use crate::visibility::surface::setup::Coverage;
use crate::work::Work;
use faces::Faces;
use fearless_simd::Simd;
use fearless_simd_macros::simd;
use fragment::{Fragment, PER_FRAGMENT, Pool};
use mask::MaskTable;
use resolve::{Pixel, Place};

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "a-buffer",
    title: "A-buffer",
    authors: "L. Carpenter",
    year: 1984,
    source: "The A-buffer, an Antialiased Hidden Surface Method, SIGGRAPH",
    class: Class::ImageSpace,
    occluder: Occluder::Area,
    coherence: &[Coherence::ScanLine],
    cost: "O(n log n + fragments + Σ k²) time, k fragments of a pixel; memory by a limit",
    limits: "one colour per face and pixel; needs every part of a pixel: sample_reach of half a pixel",
    pseudocode: &[],
};

/// Sub-pixels of a coverage mask.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum SubpixelMask {
    /// 4 × 4.
    #[default]
    M16,
    /// 8 × 8.
    M64,
}

impl SubpixelMask {
    /// Returns the number of sub-pixels along the side of a pixel.
    fn side(self) -> u32 {
        match self {
            Self::M16 => 4,
            Self::M64 => 8,
        }
    }
}

/// Bytes for each triangle of the input.
pub(super) const PER_TRIANGLE: u64 = Faces::PER_TRIANGLE + ActiveList::PER_TRIANGLE;

/// Options for rendering with the A-buffer.
#[derive(Debug, Clone, Copy)]
pub struct Options {
    /// Resolution of the masks.
    pub mask: SubpixelMask,
    /// Fragments kept at a time. Bounds memory to 44 bytes times this; a row with more is made in
    /// parts, so a low limit costs time and changes no pixel.
    pub max_fragments: usize,
    /// Shading; `None` = by material.
    pub shading: Option<Shading>,
    /// Background of the picture.
    pub background: Background,
    /// SIMD level; all levels produce the same bytes.
    pub level: Level,
}

impl Default for Options {
    /// Returns the default: 4 × 4 masks, a million fragments, by material, on white.
    fn default() -> Self {
        let picture::Options { shading, background, level } = picture::Options::default();
        Self { mask: SubpixelMask::M16, max_fragments: 1 << 20, shading, background, level }
    }
}

/// Step of the algorithm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step {
    /// Start of a part of a row; a part that was started before is restarted with fewer columns.
    Row {
        /// The row, from the top.
        y: i32,
        /// First column.
        x0: i32,
        /// The column after the last.
        x1: i32,
    },
    /// A triangle leaves a fragment.
    Fragment {
        /// The column.
        x: i32,
        /// Its item.
        item: u32,
        /// The sub-pixels it covers, row by row from the upper left.
        mask: u64,
        /// The area it covers, 0 … 1.
        area: f32,
        /// The smallest and the largest depth in the pixel.
        depths: [f32; 2],
    },
    /// Share of an item's colour, taken at the pixel's centre, in the pixel.
    Share {
        /// The column.
        x: i32,
        /// Its item.
        item: u32,
        /// Share of the pixel, 0 … 1; alpha included.
        share: f32,
    },
    /// Share of the background, the rest of the pixel.
    Background {
        /// The column.
        x: i32,
        /// Share of the pixel, 0 … 1.
        share: f32,
    },
}

/// Renders into the planes that the framebuffer has.
///
/// The input must have let through all triangles that touch a pixel anywhere: a
/// [`crate::visibility::surface::TriangleFilter::sample_reach`] of 128.
pub fn render(
    input: &SurfaceInput<'_>,
    lights: &PreparedLights,
    options: &Options,
    framebuffer: &mut Framebuffer,
    t: &mut impl Tracer<Step>,
) {
    let materials = PreparedMaterials::new(input.scene).with_ink(options.background.ink());
    let (width, window) = (input.view.width(), input.view.window());
    let Options { shading, background, level, .. } = *options;
    let of_picture = picture::Options { shading, background, level };
    let mut picture =
        Picture::new(input, &materials, lights, (&of_picture, HALF_PIXEL), framebuffer);
    let table = MaskTable::new(options.mask);
    let mut centers = Centers::new(input, &picture);
    let mut rows = Rows {
        input,
        table: &table,
        level,
        faces: Faces::new(input, [window.y0(), window.y1()]),
        pool: Pool::new(&table, width, options.max_fragments.min(most_within(&input.work))),
        queue: PointQueue::new(width as usize),
        pixel: Pixel::default(),
    };
    let mut charge = input.work.charge(METHOD, 0).unwrap_or_default();
    for y in (window.y0()..window.y1()).take_while(|_| !input.work.is_stopped()) {
        input.work.advance(1);
        rows.faces.advance(y);
        rows.row(y, &mut picture, t);
        charge.grow_to_or_stop(rows.faces.bytes() + rows.pool.bytes());
        if let Some(centers) = &mut centers {
            centers.row(y, &mut picture);
        }
    }
}

/// Returns the fragments that an eighth of the budget has room for.
fn most_within(work: &Work) -> usize {
    usize::try_from(work.budget() / 8).unwrap_or(usize::MAX) / PER_FRAGMENT
}

/// Values at the centres of the pixels, for the planes besides colour.
struct Centers<'a> {
    masked: Masked<'a>,
    list: ActiveList<'a>,
    row: DepthRow,
}

impl<'a> Centers<'a> {
    /// Creates the values, or nothing if the picture has no such planes.
    fn new(input: &'a SurfaceInput<'a>, picture: &Picture<'_>) -> Option<Self> {
        picture.wants_planes().then(|| Self {
            masked: Masked::new(input),
            list: ActiveList::new(&input.triangles, input.view),
            row: DepthRow::new(input.view.width()),
        })
    }

    fn row(&mut self, y: i32, picture: &mut Picture<'_>) {
        self.row.clear();
        for a in self.list.advance(y, |_| ()) {
            let span = [a.x0, a.x1];
            self.masked.enter(&mut self.row, a.triangle, span, y, &mut picture.lit, |_, _| ());
        }
        picture.write_planes(0, y as u32, &self.row.item, &self.row.depth);
    }
}

/// The buffers that all rows share.
struct Rows<'a> {
    input: &'a SurfaceInput<'a>,
    table: &'a MaskTable,
    level: Level,
    faces: Faces<'a>,
    pool: Pool<'a>,
    queue: PointQueue,
    pixel: Pixel,
}

impl Rows<'_> {
    /// Makes a row, in as few parts as the limit of fragments allows.
    fn row(&mut self, y: i32, picture: &mut Picture<'_>, t: &mut impl Tracer<Step>) {
        let behind = premultiply(picture.behind(y));
        self.queue.fill(behind);
        let window = self.input.view.window();
        let mut parts = vec![[window.x0(), window.x1()]];
        while let Some([x0, x1]) = parts.pop() {
            t.step(|| Step::Row { y, x0, x1 });
            let (level, lit) = (self.level, &mut picture.lit);
            let done = dispatch!(level, simd =>
                part_of_row(simd, self, y, [x0, x1], behind, lit, t));
            if !done {
                let middle = x0 + (x1 - x0) / 2;
                parts.extend([[middle, x1], [x0, middle]]);
            }
        }
        picture.write_sums(y as u32, &self.queue.sums);
    }

    /// Collects the fragments of a part of a row; returns whether there was room.
    #[inline(always)]
    fn collect<S: Simd>(
        &mut self,
        simd: S,
        y: i32,
        columns: [i32; 2],
        lit: &mut Lit<'_>,
        t: &mut impl Tracer<Step>,
    ) -> bool {
        let Self { faces, pool, .. } = self;
        pool.clear(columns);
        for number in 0..faces.count() {
            if pool.rejects(simd, faces.active(number), columns) {
                continue;
            }
            let (triangle, face) = faces.get(simd, number);
            let item = triangle.item;
            let masked = face.coverage == Coverage::Masked;
            let passes = |x| !masked || lit.passes_mask(item, x, y);
            let added = |x, f: &Fragment| {
                let (mask, area, depths) = (f.mask, f.area, [f.z_min, f.z_max]);
                t.step(|| Step::Fragment { x, item, mask, area, depths });
            };
            if !pool.add(simd, triangle, face, y, columns, passes, added) {
                return false;
            }
        }
        true
    }

    /// Adds up the colours of a part of a row.
    #[inline(always)]
    fn resolve<S: Simd>(
        &mut self,
        simd: S,
        y: i32,
        [x0, x1]: [i32; 2],
        behind: Vec4,
        lit: &mut Lit<'_>,
        t: &mut impl Tracer<Step>,
    ) {
        let Self { input, table, faces, pool, queue, pixel, .. } = self;
        let mut x = x0;
        while x < x1 {
            let filled = pool.next_filled([x, x1]);
            // Pixels without fragments keep the background.
            if x < filled {
                (x..filled).for_each(|x| t.step(|| Step::Background { x, share: 1.0 }));
                x = filled;
                continue;
            }
            let place = Place { triangles: &input.triangles, table, x, y };
            if let Some(only) = pool.only(x).filter(|f| !f.blended) {
                // This is the case for most pixels.
                queue.set(x as usize, Vec4::W * only.area);
                if only.area > 0.0 {
                    t.step(|| Step::Share { x, item: only.item, share: only.area });
                    queue.add(simd, lit, point_at(only.item, [x, y], only.area), None);
                }
                pixel.background = 1.0 - only.area;
            } else {
                // Several fragments: blended ones are composed in depth order, opaque ones share the pixel.
                pixel.begin(pool, x, table.full(), faces.in_pieces);
                if pixel.is_blended() {
                    queue.set(x as usize, blended(pixel, &place, lit, t));
                } else {
                    pixel.resolve_opaque(&place);
                    queue.set(x as usize, Vec4::W * pixel.shares.iter().sum::<f32>());
                    for (f, &share) in pixel.fragments.iter().zip(&pixel.shares) {
                        if share > 0.0 {
                            t.step(|| Step::Share { x, item: f.item, share });
                            queue.add(simd, lit, point_at(f.item, [x, y], share), None);
                        }
                    }
                }
            }
            // The background gets the rest.
            if pixel.background > 0.0 {
                t.step(|| Step::Background { x, share: pixel.background });
                queue.add_color(x as usize, behind, pixel.background);
            }
            x += 1;
        }
        PointQueue::flush(simd, queue, lit);
    }
}

/// Returns a point of an item at a pixel of a row, whose sums are numbered by columns.
fn point_at(item: u32, at: [i32; 2], weight: f32) -> ShadingPoint {
    ShadingPoint { item, at, place: at[0] as u32, weight }
}

/// Makes a part of a row; returns whether there was room for its fragments.
#[simd]
fn part_of_row<S: Simd, T: Tracer<Step>>(
    simd: S,
    rows: &mut Rows<'_>,
    y: i32,
    columns: [i32; 2],
    behind: Vec4,
    lit: &mut Lit<'_>,
    t: &mut T,
) -> bool {
    let done = rows.collect(simd, y, columns, lit, t);
    if done {
        rows.resolve(simd, y, columns, behind, lit, t);
    }
    done
}

/// Returns the colour of a pixel with blended fragments, premultiplied, without the background's
/// share.
fn blended(
    pixel: &mut Pixel,
    place: &Place<'_>,
    lit: &mut Lit<'_>,
    t: &mut impl Tracer<Step>,
) -> Vec4 {
    let (x, y) = (place.x, place.y);
    let mut color = |f: &Fragment| {
        let color = lit.color(f.item, x, y);
        if f.blended { color } else { color.truncate().extend(1.0) }
    };
    let mut colors = vec![Vec4::ZERO; pixel.fragments.len()];
    if pixel.is_in_order() {
        pixel.resolve_in_order(place.table.full(), |i, f| {
            colors[i] = color(f);
            colors[i].w
        });
    } else {
        colors.iter_mut().zip(&pixel.fragments).for_each(|(to, f)| *to = color(f));
        let alphas: Vec<f32> = colors.iter().map(|c| c.w).collect();
        pixel.resolve_blended(&alphas, place);
    }
    let mut sum = Vec4::ZERO;
    for ((f, &share), color) in pixel.fragments.iter().zip(&pixel.shares).zip(&colors) {
        t.step(|| Step::Share { x, item: f.item, share });
        sum += color.truncate().extend(1.0) * share;
    }
    sum
}
