//! All methods to find visible surfaces: the same scene gives the same picture.

use crate::math::Vec4;
use crate::raster::fixed::HALF_PIXEL;
use crate::shade::{PreparedLights, PreparedMaterials, Shading};
use crate::simd::{Level, default_level};
use crate::target::Framebuffer;
use crate::trace::Tracer;
use crate::visibility::surface::a_buffer::SubpixelMask;
use crate::visibility::surface::input::{METHOD, SurfaceInput};
use crate::visibility::surface::rows::active::ActiveList;
use crate::visibility::surface::setup::TriangleFilter;
use crate::visibility::surface::visible::Visible;
use crate::visibility::surface::{Background, Samples};
use crate::visibility::surface::{
    a_buffer, depth_sort, picture, ray, scan_line_z, spanning_scan_line, warnock, z_buffer,
};

crate::info::family! {
    /// The algorithms that find visible surfaces.
    pub enum SurfaceMethod {
        /// The z-buffer, the production path.
        ZBuffer => z_buffer::INFO,
        /// The z-buffer with one row of depth.
        ScanLineZ => scan_line_z::INFO,
        /// Visibility span by span along the scan line.
        SpanningScanLine => spanning_scan_line::INFO,
        /// Fragment lists with coverage masks.
        ABuffer => a_buffer::INFO,
        /// Polygons in order, painted from back to front.
        DepthSort => depth_sort::INFO,
        /// Windows divided until they are simple.
        Warnock => warnock::INFO,
        /// Rays through the samples.
        Ray => ray::INFO,
    }
}

impl SurfaceMethod {
    /// Returns the bytes that a method takes beside the input, about: for each of its triangles, and for each pixel.
    fn bytes(self) -> [u64; 2] {
        match self {
            // The z-buffer charges its memory itself.
            Self::ZBuffer => [0, 0],
            Self::ScanLineZ | Self::SpanningScanLine => [ActiveList::PER_TRIANGLE, 0],
            Self::ABuffer => [a_buffer::PER_TRIANGLE, 0],
            Self::DepthSort => [depth_sort::PER_TRIANGLE, Visible::PER_SAMPLE],
            Self::Warnock => [warnock::PER_TRIANGLE, Visible::PER_SAMPLE],
            Self::Ray => [ray::PER_TRIANGLE, ray::PER_PIXEL + Visible::PER_SAMPLE],
        }
    }

    /// Returns the largest distance from pixels' centres at which the method samples, in 1/256
    /// pixel: [`TriangleFilter::sample_reach`].
    pub fn sample_reach(self) -> i32 {
        match self {
            Self::ScanLineZ | Self::SpanningScanLine | Self::DepthSort => 0,
            Self::ZBuffer | Self::ABuffer | Self::Warnock | Self::Ray => HALF_PIXEL,
        }
    }
}

/// Options of all methods.
#[derive(Debug, Clone, Copy)]
pub struct Options {
    /// Samples per pixel of the colour plane, for those methods that can take several.
    pub samples: Samples,
    /// Sub-pixels of the A-buffer's masks.
    pub mask: SubpixelMask,
    /// True if rays to the lights find shadows; for the ray method.
    pub shadow_rays: bool,
    /// Number of times that a ray may be reflected or refracted; for the ray method.
    pub bounces: u32,
    /// Shading; `None` = by material.
    pub shading: Option<Shading>,
    /// Background of the picture.
    pub background: Background,
    /// SIMD level; all levels produce the same bytes.
    pub level: Level,
}

impl Default for Options {
    /// Returns one sample, by material, on white, the machine's best level.
    fn default() -> Self {
        Self {
            samples: Samples::One,
            mask: SubpixelMask::M16,
            shadow_rays: false,
            bounces: 0,
            shading: None,
            background: Background::Color(Vec4::ONE),
            level: default_level(),
        }
    }
}

impl Options {
    /// Returns the part that methods with one surface per pixel need.
    fn picture(&self) -> picture::Options {
        let Self { shading, background, level, .. } = *self;
        picture::Options { shading, background, level }
    }

    fn ray(&self) -> ray::Options {
        ray::Options {
            look: self.picture(),
            shadows: self.shadow_rays,
            reflections: self.bounces > 0,
            // Without mirrors, rays still pass through blended surfaces.
            depth: if self.bounces > 0 { self.bounces } else { ray::Options::default().depth },
            samples: self.samples,
            ..Default::default()
        }
    }

    /// Returns options with as many samples, in rows and columns.
    fn warnock(&self) -> warnock::Options {
        let sub_levels = match self.samples {
            Samples::One => 0,
            Samples::Four => 1,
            Samples::Sixteen => 2,
        };
        warnock::Options { look: self.picture(), sub_levels, ..Default::default() }
    }

    fn a_buffer(&self) -> a_buffer::Options {
        let Self { mask, shading, background, level, .. } = *self;
        a_buffer::Options { mask, shading, background, level, ..Default::default() }
    }

    fn z_buffer(&self, input: &SurfaceInput<'_>) -> z_buffer::Options {
        let Self { samples, shading, background, level, .. } = *self;
        let TriangleFilter { cull, marks, .. } = input.filter;
        let work = input.work.clone();
        z_buffer::Options { samples, cull, marks, shading, background, level, work }
    }
}

/// A step of one of the methods.
#[derive(Debug, Clone, PartialEq)]
pub enum Step {
    /// Step of the scan-line z-buffer.
    ScanLineZ(scan_line_z::Step),
    /// Step of depth sort.
    DepthSort(depth_sort::Step),
    /// Step of Warnock's subdivision.
    Warnock(warnock::Step),
    /// Step of ray casting.
    Ray(ray::Step),
    /// Step of the spanning scan line.
    SpanningScanLine(spanning_scan_line::Step),
    /// Step of the A-buffer.
    ABuffer(a_buffer::Step),
}

/// Tracer that passes the steps of one method on as [`Step`].
struct Wrapped<'a, T, F>(&'a mut T, F);

impl<S, T: Tracer<Step>, F: Fn(S) -> Step> Tracer<S> for Wrapped<'_, T, F> {
    #[inline(always)]
    fn step(&mut self, make: impl FnOnce() -> S) {
        let Self(t, wrap) = self;
        t.step(|| wrap(make()));
    }
}

/// Renders into the planes that the framebuffer has, by any of the methods; depth, item and normal
/// at pixel centres are the same by all of them.
///
/// The production z-buffer works in parallel and takes no steps.
///
/// # Errors
/// Those of the method's own function, and the reason that stopped the input's work.
pub fn render_with(
    method: SurfaceMethod,
    input: &SurfaceInput<'_>,
    lights: &PreparedLights,
    options: &Options,
    framebuffer: &mut Framebuffer,
    t: &mut impl Tracer<Step>,
) -> crate::Result<()> {
    let window = input.view.window();
    let (width, height) = (u64::from(window.width()), u64::from(window.height()));
    // Charge the lists that grow with triangles and pixels; the z-buffer charges its materials itself.
    let [per_triangle, per_pixel] = method.bytes();
    let triangles = (input.triangles.len() as u64).saturating_mul(per_triangle);
    let pixels = (width * height).saturating_mul(per_pixel);
    let _lists = input.work.charge(METHOD, triangles.saturating_add(pixels))?;
    let materials = match method {
        SurfaceMethod::ZBuffer => 0,
        _ => PreparedMaterials::bytes(input.scene),
    };
    let _materials = input.work.charge(PreparedMaterials::STAGE, materials)?;
    input.work.begin("rows", height);
    match method {
        SurfaceMethod::ZBuffer => {
            let z_options = options.z_buffer(input);
            z_buffer::render(input.scene, input.view, lights, &z_options, framebuffer)?;
        }
        SurfaceMethod::ScanLineZ => {
            let t = &mut Wrapped(t, Step::ScanLineZ);
            scan_line_z::render(input, lights, &options.picture(), framebuffer, t);
        }
        SurfaceMethod::DepthSort => {
            let t = &mut Wrapped(t, Step::DepthSort);
            let options = depth_sort::Options { look: options.picture() };
            depth_sort::render(input, lights, &options, framebuffer, t)?;
        }
        SurfaceMethod::Warnock => {
            let t = &mut Wrapped(t, Step::Warnock);
            warnock::render(input, lights, &options.warnock(), framebuffer, t);
        }
        SurfaceMethod::Ray => {
            let t = &mut Wrapped(t, Step::Ray);
            ray::render(input, lights, &options.ray(), framebuffer, t);
        }
        SurfaceMethod::SpanningScanLine => {
            let t = &mut Wrapped(t, Step::SpanningScanLine);
            spanning_scan_line::render(input, lights, &options.picture(), framebuffer, t);
        }
        SurfaceMethod::ABuffer => {
            let t = &mut Wrapped(t, Step::ABuffer);
            a_buffer::render(input, lights, &options.a_buffer(), framebuffer, t);
        }
    }
    input.work.check()
}
