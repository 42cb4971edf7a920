//! Ray casting, and recursive tracing of rays.
//!
//! A. Appel, *Some Techniques for Shading Machine Renderings of Solids*, AFIPS Spring Joint Computer
//! Conference 1968; secondary rays: T. Whitted, *An Improved Illumination Model for Shaded Display*,
//! CACM 1980. Image space. Cost: O(n log n) for the hierarchy of boxes, about O(log n) for each ray;
//! memory O(n). Coherence used: objects, by the hierarchy.
//!
//! Deviations: rays from the eye are cast in screen space (see `primary`), with the z-buffer's
//! coverage and depths. Reflection is that of the material: Schlick's approximation of Fresnel's law,
//! less for rough surfaces. Without secondary rays blended surfaces count as opaque; with them, rays go
//! on through what is blended. Flat and Gouraud shading light each point where shadows are cast.

mod bvh;
mod primary;
mod whitted;
mod world;

use crate::info::{Class, Info};
use crate::math::Vec4;
use crate::shade::PreparedLights;
use crate::target::{Framebuffer, NO_ITEM};
use crate::trace::Tracer;
use crate::visibility::surface::Samples;
use crate::visibility::surface::input::SurfaceInput;
use crate::visibility::surface::lit::Lighting;
use crate::visibility::surface::mixed::encode;
use crate::visibility::surface::picture;
use crate::visibility::surface::visible::{
    Masks, Visible, background_at, pixels_of, with_lighting, write, write_planes,
};
use primary::{ScreenHit, ScreenRays};
use whitted::Whitted;
use world::WorldTriangles;

/// The facts.
pub const INFO: Info = Info {
    name: "ray",
    title: "Ray casting and tracing",
    authors: "A. Appel; T. Whitted",
    year: 1968,
    source: "Some Techniques for Shading Machine Renderings of Solids, AFIPS",
    class: Class::ImageSpace,
    cost: "O(n log n) once, about O(log n) per ray; memory O(n)",
    limits: "lines and points are seen, but have no shadow and no mirror image",
};

/// What the picture is to have.
#[derive(Debug, Clone, Copy)]
pub struct Options {
    /// Shading and background.
    pub look: picture::Options,
    /// Whether surfaces keep light from others.
    pub shadows: bool,
    /// Whether rays are followed that mirrors reflect and transparent surfaces refract.
    pub reflections: bool,
    /// How often a ray may be reflected or refracted.
    pub depth: u32,
    /// Refractive index of blended materials; 1 lets rays pass straight.
    pub refractive_index: f32,
    /// Rays per pixel; each surface is lit once per pixel.
    pub samples: Samples,
}

impl Default for Options {
    /// Ray casting with one ray per pixel; five generations if reflections are switched on.
    fn default() -> Self {
        Self {
            look: picture::Options::default(),
            shadows: false,
            reflections: false,
            depth: 5,
            refractive_index: 1.0,
            samples: Samples::One,
        }
    }
}

/// Why a ray is cast.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum RayKind {
    /// From the eye through a pixel's centre.
    Primary,
    /// From the eye through another point of the pixel.
    Sample,
    /// To a light.
    Shadow,
    /// Reflected.
    Mirror,
    /// Through a transparent surface.
    Refraction,
}

/// What there is to see.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Step {
    /// The hierarchies are built; rays follow, pixel by pixel.
    Begin,
    /// A ray was cast.
    Ray {
        /// Column of its pixel.
        x: i32,
        /// Row of its pixel.
        y: i32,
        /// Why.
        kind: RayKind,
        /// How many reflections and refractions lie before it.
        generation: u32,
        /// The item that it hits first; for a shadow ray one that is in the way.
        hit: Option<u32>,
    },
}

/// Renders the input into the planes that the framebuffer has.
pub fn render(
    input: &SurfaceInput<'_>,
    lights: &PreparedLights,
    options: &Options,
    framebuffer: &mut Framebuffer,
    t: &mut impl Tracer<Step>,
) {
    // The closure is called only if somebody listens.
    let mut listens = false;
    t.step(|| {
        listens = true;
        Step::Begin
    });
    with_lighting(input, lights, &options.look, |lighting| {
        let rays = ScreenRays::new(&input.triangles, input.view);
        let secondary = options.shadows || options.reflections;
        let world = secondary.then(|| WorldTriangles::new(input));
        let caster = Caster { input, lighting, options, rays, world, listens };
        let height = input.view.height() as i32;
        let bands = (0..height).step_by(BAND as usize).collect();
        let bands = crate::parallel::map(bands, |top| caster.band(top, height.min(top + BAND)));
        let mut visible = Visible::new(pixels_of(input.view));
        let mut colors = Vec::new();
        for band in bands {
            band.steps.into_iter().for_each(|step| t.step(|| step));
            for ([x, y], hit) in band.hits {
                visible.put(x, y, hit.depth, hit.item);
            }
            colors.extend(band.colors);
        }
        if caster.is_plain() {
            write(&visible, lighting, &options.look, framebuffer);
        } else {
            write_planes(&visible, lighting, &options.look, framebuffer);
            framebuffer.color.data_mut().copy_from_slice(&colors);
        }
    });
}

/// Rows of pixels that one thread takes at a time.
const BAND: i32 = 16;

/// The rows that one thread has worked on.
struct Band {
    hits: Vec<([i32; 2], ScreenHit)>,
    /// Empty where rays are only cast to find what is visible.
    colors: Vec<[u8; 4]>,
    steps: Vec<Step>,
}

struct Caster<'a> {
    input: &'a SurfaceInput<'a>,
    lighting: Lighting<'a>,
    options: &'a Options,
    rays: ScreenRays<'a>,
    world: Option<WorldTriangles>,
    listens: bool,
}

impl Caster<'_> {
    /// Whether one ray a pixel says all.
    fn is_plain(&self) -> bool {
        self.world.is_none() && self.options.samples == Samples::One
    }

    fn band(&self, top: i32, bottom: i32) -> Band {
        let mut band = Band { hits: Vec::new(), colors: Vec::new(), steps: Vec::new() };
        let mut masks = Masks::new(self.input, self.lighting);
        let mut stack = Vec::new();
        let mut whitted = Whitted::new(self.world.as_ref(), self.lighting, self.options);
        for (x, y) in
            (top..bottom).flat_map(|y| (0..self.input.view.width() as i32).map(move |x| (x, y)))
        {
            let mut cast = |offset: [i32; 2]| {
                let hit = self.rays.cast([x, y], offset, &mut masks, &mut stack);
                if self.listens {
                    let kind = if offset == [0; 2] { RayKind::Primary } else { RayKind::Sample };
                    let hit = hit.map(|h| h.item);
                    band.steps.push(Step::Ray { x, y, kind, generation: 0, hit });
                }
                hit
            };
            let center = cast([0; 2]);
            if let Some(hit) = center {
                band.hits.push(([x, y], hit));
            }
            if self.is_plain() {
                continue;
            }
            let items: Vec<u32> = match self.options.samples {
                Samples::One => vec![center.map_or(NO_ITEM, |h| h.item)],
                samples => {
                    let hits = samples.offsets().iter().map(|&offset| cast(offset));
                    hits.map(|h| h.map_or(NO_ITEM, |h| h.item)).collect()
                }
            };
            let mut report = |kind, generation, hit| {
                if self.listens {
                    band.steps.push(Step::Ray { x, y, kind, generation, hit });
                }
            };
            band.colors.push(self.color(&mut whitted, items, [x, y], &mut report));
        }
        band
    }

    /// The mean of a pixel's samples; each item is lit once.
    fn color(
        &self,
        whitted: &mut Whitted<'_>,
        mut items: Vec<u32>,
        [x, y]: [i32; 2],
        report: &mut impl FnMut(RayKind, u32, Option<u32>),
    ) -> [u8; 4] {
        items.sort_unstable();
        let share = 1.0 / items.len() as f32;
        let behind = background_at(&self.options.look, self.input.view.height(), y);
        let parts = items.chunk_by(|a, b| a == b);
        let sum = parts.fold(Vec4::ZERO, |sum, same| {
            let color = match same[0] {
                NO_ITEM => behind,
                item => whitted.at_pixel(item, [x, y], behind, report),
            };
            sum + color * (same.len() as f32 * share)
        });
        encode(sum)
    }
}
