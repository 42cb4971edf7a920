//! Ray casting, and recursive tracing of rays.
//!
//! A. Appel, *Some Techniques for Shading Machine Renderings of Solids*, AFIPS Spring Joint Computer
//! Conference 1968; secondary rays: T. Whitted, *An Improved Illumination Model for Shaded Display*,
//! CACM 1980. Image space. Cost: O(n log n) for the hierarchy of boxes, about O(log n) for each ray;
//! memory O(n). Coherence used: objects, by the hierarchy.
//!
//! Deviations: rays from the eye are cast in screen space (see `primary`), with the z-buffer's coverage and depths.
//! Reflection follows the material: Schlick's approximation of Fresnel's law, weaker for rough surfaces. Rays continue
//! through blended surfaces: without secondary rays in a straight line, to the first opaque surface. Flat and Gouraud
//! shading light each point where shadows are cast.

mod bvh;
mod eye;
mod primary;
mod report;
mod whitted;
mod world;

use crate::info::{Class, Coherence, Info, Occluder};
use crate::math::DVec3;
use crate::shade::PreparedLights;
use crate::shade::color::encode_premultiplied;
use crate::target::Framebuffer;
use crate::trace::{PseudocodeLine, Tracer};
use crate::visibility::surface::Samples;
use crate::visibility::surface::input::{METHOD, SurfaceInput, TriangleSet};
use crate::visibility::surface::layers::mean;
use crate::visibility::surface::lit::Lighting;
use crate::visibility::surface::picture;
use crate::visibility::surface::setup::Coverage;
use crate::visibility::surface::visible::{
    Visible, background_at, pixels_of, with_lighting, write, write_planes,
};
use bvh::Bvh;
pub use bvh::Tests;
use eye::Eye;
use primary::ScreenRays;
use report::Report;
use whitted::Whitted;
use world::{Cast, Ray, WorldTriangles};

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "ray",
    title: "Ray casting and tracing",
    authors: "A. Appel; T. Whitted",
    year: 1968,
    source: "Some Techniques for Shading Machine Renderings of Solids, AFIPS",
    class: Class::ImageSpace,
    occluder: Occluder::Point,
    coherence: &[Coherence::Object],
    cost: "O(n log n) once, about O(log n) per ray; memory O(n)",
    limits: "lines and points are visible, but have no shadows and no reflections",
    pseudocode: &[
        "colour(pixel) ← trace(ray from the eye through the pixel, 0)",
        "trace(ray, depth):",
        "    hit ← nearest surface along O + t · D, t > 0",
        "    if there is none: return the background",
        "    colour ← emission and ambient light",
        "    for each light in front of the surface:",
        "        if the ray to it meets nothing: add what the surface reflects of it",
        "    if depth < limit:",
        "        if the surface mirrors: add share · trace(mirrored ray, depth + 1)",
        "        if it lets light through: add share · trace(refracted ray, depth + 1)",
        "    return colour",
    ],
};

/// Bytes for each triangle of the input, and for each pixel: its hit and its colour, in bands.
pub(super) const PER_TRIANGLE: u64 = Bvh::PER_BOX;
pub(super) const PER_PIXEL: u64 = size_of::<([i32; 2], (f32, u32), [u8; 4])>() as u64;

/// Options for rendering with ray casting and ray tracing.
#[derive(Debug, Clone, Copy)]
pub struct Options {
    /// Shading and background.
    pub look: picture::Options,
    /// True if rays to the lights find shadows.
    pub shadows: bool,
    /// True if rays are followed that mirrors reflect and transparent surfaces refract.
    pub reflections: bool,
    /// Number of times that a ray may be reflected or refracted.
    pub depth: u32,
    /// Refractive index of blended materials; 1 lets rays pass straight.
    pub refractive_index: f32,
    /// Rays per pixel; each surface is lit once per pixel.
    pub samples: Samples,
}

impl Default for Options {
    /// Returns the default: ray casting with one ray per pixel; five generations if reflections are switched on.
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

/// Purpose of a ray.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum RayKind {
    /// Ray from the eye through a pixel's centre.
    Primary,
    /// Ray from the eye through another point of the pixel.
    Sample,
    /// Ray to a light.
    Shadow,
    /// Reflected ray.
    Mirror,
    /// Ray through a transparent surface.
    Refraction,
}

/// Step of the algorithm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step {
    /// The hierarchies are built; rays follow, pixel by pixel.
    Begin,
    /// A ray was cast.
    Ray {
        /// Column of its pixel.
        x: i32,
        /// Row of its pixel.
        y: i32,
        /// Kind of the ray.
        kind: RayKind,
        /// Number of reflections and refractions before it.
        generation: u32,
        /// Its origin, world space.
        origin: DVec3,
        /// Its direction, a unit vector.
        direction: DVec3,
        /// The item that it hits first; for a shadow ray, an item that blocks it.
        hit: Option<u32>,
        /// Distance of the hit from the origin; infinite without one.
        t: f64,
        /// Boxes and triangles that it was tested against.
        tests: Tests,
    },
}

impl PseudocodeLine for Step {
    fn line(&self) -> usize {
        match self {
            Self::Begin => 1,
            Self::Ray { kind: RayKind::Primary | RayKind::Sample, .. } => 3,
            Self::Ray { kind: RayKind::Shadow, .. } => 7,
            Self::Ray { kind: RayKind::Mirror, .. } => 9,
            Self::Ray { kind: RayKind::Refraction, .. } => 10,
        }
    }
}

/// Renders the input into the planes that the framebuffer has.
pub fn render(
    input: &SurfaceInput<'_>,
    lights: &PreparedLights,
    options: &Options,
    framebuffer: &mut Framebuffer,
    t: &mut impl Tracer<Step>,
) {
    // The closure is called only if steps are recorded.
    let mut listens = false;
    t.step(|| {
        listens = true;
        Step::Begin
    });
    with_lighting(input, lights, &options.look, |lighting| {
        let lighting = Lighting { reach: options.samples.reach(), ..lighting };
        let rays = ScreenRays::new(&input.triangles, input.view);
        let secondary = options.shadows || options.reflections;
        let bytes = input.scene.triangle_count().saturating_mul(WorldTriangles::PER_TRIANGLE);
        let mut charge = input.work.charge(METHOD, 0).unwrap_or_default();
        if secondary && !charge.grow_to_or_stop(bytes) {
            return;
        }
        let world = secondary.then(|| WorldTriangles::new(input));
        // Secondary rays find the surfaces behind glass themselves.
        let blended = Some(input.having(Coverage::Blended));
        let blended = blended.filter(|set| !secondary && !set.is_empty());
        let report = listens.then(|| Report::new(input.view));
        let caster = Caster { input, lighting, options, rays: &rays, world, blended, report };
        let bands = caster.bands();
        let mut visible = Visible::new(pixels_of(input.view));
        let mut colors = Vec::new();
        for band in bands {
            band.steps.into_iter().for_each(|step| t.step(|| step));
            for ([x, y], (depth, item)) in band.hits {
                visible.put(x, y, depth, item);
            }
            colors.extend(band.colors);
        }
        if caster.is_plain() {
            write(&visible, lighting, &options.look, framebuffer);
        } else {
            write_planes(&visible, lighting, &options.look, framebuffer);
            // Fewer if the work was stopped.
            let pixels = framebuffer.color.data_mut();
            pixels.iter_mut().zip(colors).for_each(|(to, color)| *to = color);
        }
    });
}

/// The rays from the eye alone: the visible surfaces, without light.
pub struct PrimaryRays<'a> {
    input: &'a SurfaceInput<'a>,
    rays: ScreenRays<'a>,
}

impl<'a> PrimaryRays<'a> {
    /// Builds the hierarchy of boxes. Cost: O(n log n).
    pub fn new(input: &'a SurfaceInput<'a>) -> Self {
        Self { input, rays: ScreenRays::new(&input.triangles, input.view) }
    }

    /// Returns the first hits of the rays through the pixels' centres: column and row, window depth
    /// and item, row by row; pixels that show nothing are left out. Cost: about O(log n) per pixel.
    pub fn hits(&self) -> Vec<([i32; 2], (f32, u32))> {
        let Self { input, rays } = self;
        let options = Options::default();
        with_lighting(
            input,
            &PreparedLights::new(&[], input.view.camera()),
            &options.look,
            |lighting| {
                let (options, blended) = (&options, None);
                let caster =
                    Caster { input, lighting, options, rays, world: None, blended, report: None };
                caster.bands().into_iter().flat_map(|band| band.hits).collect()
            },
        )
    }
}

/// Rows of pixels that one thread takes at a time.
const BAND: i32 = 16;

/// The rows that one thread has worked on.
struct Band {
    /// Depth and item of the nearest surface at pixels' centres.
    hits: Vec<([i32; 2], (f32, u32))>,
    /// Empty if rays are only cast to find visible surfaces.
    colors: Vec<[u8; 4]>,
    steps: Vec<Step>,
}

struct Caster<'a> {
    input: &'a SurfaceInput<'a>,
    lighting: Lighting<'a>,
    options: &'a Options,
    rays: &'a ScreenRays<'a>,
    world: Option<WorldTriangles>,
    /// Surfaces that rays from the eye pass through.
    blended: Option<TriangleSet>,
    /// Maker of steps, if they are recorded.
    report: Option<Report>,
}

impl Caster<'_> {
    /// Returns whether one ray a pixel says all.
    fn is_plain(&self) -> bool {
        self.world.is_none() && self.blended.is_none() && self.options.samples == Samples::One
    }

    /// Works on all rows, on all threads.
    fn bands(&self) -> Vec<Band> {
        let window = self.input.view.window();
        let tops = (window.y0()..window.y1()).step_by(BAND as usize).collect();
        crate::parallel::map(tops, |top| self.band(top, window.y1().min(top + BAND)))
    }

    fn band(&self, top: i32, bottom: i32) -> Band {
        let mut band = Band { hits: Vec::new(), colors: Vec::new(), steps: Vec::new() };
        let mut eye = Eye::new(self);
        let counts = self.report.is_some();
        let mut whitted = Whitted::new(self.world.as_ref(), self.lighting, self.options, counts);
        let window = self.input.view.window();
        let columns = window.x0()..window.x1();
        if self.input.work.is_stopped() {
            return band;
        }
        self.input.work.advance((bottom - top) as u64);
        for at in (top..bottom).flat_map(|y| columns.clone().map(move |x| [x, y])) {
            let center = eye.cast(at, [0; 2], &mut band.steps);
            band.hits.extend(eye.nearest(center).map(|hit| (at, hit)));
            if self.is_plain() {
                continue;
            }
            let stacks = match self.options.samples {
                Samples::One => vec![eye.items(center)],
                samples => {
                    let sample = |&offset| {
                        let opaque = eye.cast(at, offset, &mut band.steps);
                        eye.items(opaque)
                    };
                    samples.offsets().iter().map(sample).collect()
                }
            };
            let mut hear = |kind, generation, ray: &Ray, cast: Cast| {
                let step = |report: &Report| report.secondary(at, (kind, generation), ray, cast);
                band.steps.extend(self.report.as_ref().map(step));
            };
            band.colors.push(self.color(&mut whitted, stacks, at, &mut hear));
        }
        band
    }

    /// Returns the mean of a pixel's samples, each with all that its ray sees.
    fn color(
        &self,
        whitted: &mut Whitted<'_>,
        mut stacks: Vec<Vec<u32>>,
        at: [i32; 2],
        hear: &mut impl FnMut(RayKind, u32, &Ray, Cast),
    ) -> [u8; 4] {
        let behind = background_at(&self.options.look, self.input.view.height(), at[1]);
        encode_premultiplied(mean(&mut stacks, |stack| whitted.at_pixel(stack, at, behind, hear)))
    }
}
