//! The rendering pipeline: the order of its stages, which no other module knows.

mod callouts;
mod contour;
mod depth_cue;
mod draw;
mod edges;
mod floor;
mod pieces;
mod runs;
mod status;
mod tone_marks;

pub use callouts::seen_at;
pub use contour::contoured;
pub use depth_cue::depth_cued;
pub use draw::{DrawOptions, DrawStyle, draw, hatched, line_classes, with_marks};
pub use edges::{EdgeStyle, draw_edges};
pub use floor::{add_axes, add_grid, add_ground};
pub use pieces::{check_pieces, render_seen, status_of_pieces, survey};
use status::Places;
pub use status::{Status, Unseen, drawing_status, status};
pub use tone_marks::{ToneMarks, tone_marks};

use crate::explain::{Operations, Tally};
use crate::math::{Vec4, exp2};
use crate::raster::fixed::GUARD_BAND;
use crate::scene::{Camera, Light, Scene};
use crate::shade::PreparedLights;
use crate::shade::environment::Mirrored;
use crate::shade::studio::Studio;
pub use crate::shade::{Exposure, Shading, Surroundings, ToneMap};
use crate::simd::{Level, default_level};
use crate::stopwatch::Stopwatch;
use crate::target::Framebuffer;
use crate::trace::{NoTrace, Tracer};
use crate::view::View;
use crate::view::window::PixelRect;
use crate::visibility::surface::a_buffer::SubpixelMask;
use crate::visibility::surface::ambient_occlusion;
use crate::visibility::surface::comparisons::comparisons;
use crate::visibility::surface::input::SurfaceInput;
use crate::visibility::surface::method::{self, render_with};
use crate::visibility::surface::setup::TriangleFilter;
pub use crate::visibility::surface::z_buffer::survey::{MOST_ITEMS, Survey, SurveyResult};
pub use crate::visibility::surface::{Background, Cull, Marks, Samples, SurfaceMethod};
use crate::visibility::surface::{shadow_map, z_buffer};
use crate::work::{Charge, Work};
use crate::{Error, Result};

/// Lights of a picture.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum Lighting {
    /// The scene's own lights. For a scene without any, unless a panorama lights it, ambient light and three
    /// directional lights that move with the camera: key, fill and rim light.
    #[default]
    Auto,
    /// The given lights, in world space.
    Given(Vec<Light>),
}

/// Method for shadows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Shadows {
    /// No shadows.
    #[default]
    None,
    /// Shadow maps, for all algorithms: [`crate::shade::shadow`].
    Map,
    /// Rays to the lights, for [`SurfaceMethod::Ray`].
    Rays,
}

/// Options of a picture: everything but the scene.
#[derive(Debug, Clone)]
pub struct RenderOptions {
    /// Method for visible surfaces.
    pub algorithm: SurfaceMethod,
    /// Width in pixels, at least 1.
    pub width: u32,
    /// Height in pixels, at least 1.
    pub height: u32,
    /// Pixels of the picture to render, as they are in the whole one: the framebuffer has their size, and memory follows it.
    /// `None` = all.
    pub window: Option<PixelRect>,
    /// Camera that sees the picture.
    pub camera: Camera,
    /// Shading; `None` = by material.
    pub shading: Option<Shading>,
    /// Lights that shine on the scene.
    pub lighting: Lighting,
    /// Exposure; `None` = [`Exposure::Auto`] for the scene's own lights and for panoramas, 0 EV for
    /// lights that are given.
    pub exposure: Option<Exposure>,
    /// Surroundings that mirrors show, and that may light the scene from all around.
    pub surroundings: Surroundings,
    /// Mapping from the range of brightness to that of a display.
    pub tone_map: ToneMap,
    /// Background of the picture.
    pub background: Background,
    /// Faces to leave out.
    pub cull: Cull,
    /// Size of lines and points on the screen.
    pub marks: Marks,
    /// Samples per pixel of the colour plane, for algorithms that take several; the other planes always have one
    /// sample, at the pixel's centre.
    pub samples: Samples,
    /// Resolution of the A-buffer's masks, which replace its samples.
    pub mask: SubpixelMask,
    /// Method that computes shadows.
    pub shadows: Shadows,
    /// Texels along the side of shadow maps.
    pub shadow_map_side: u32,
    /// Largest number of reflections by mirrors and refractions by blended surfaces along a ray; above 0 for
    /// [`SurfaceMethod::Ray`] only.
    pub bounces: u32,
    /// Ambient occlusion of the visible surfaces; `None` = without.
    pub ambient_occlusion: Option<ambient_occlusion::Options>,
    /// True if the framebuffer gets a depth plane.
    pub depth: bool,
    /// True if the framebuffer gets an item plane.
    pub item: bool,
    /// True if the framebuffer gets a normal plane.
    pub normal: bool,
    /// Limit on the number of pixels; larger pictures are refused.
    pub max_pixels: u64,
    /// SIMD level; all levels produce the same bytes.
    pub level: Level,
    /// Memory budget and cancellation of the work.
    pub work: Work,
}

impl RenderOptions {
    /// Creates the options of a picture of 1024 × 1024 pixels: white background, four samples, colour only.
    pub fn new(camera: Camera) -> Self {
        Self {
            algorithm: SurfaceMethod::ZBuffer,
            width: 1024,
            height: 1024,
            window: None,
            camera,
            shading: None,
            lighting: Lighting::Auto,
            exposure: None,
            surroundings: Surroundings::Studio,
            tone_map: ToneMap::None,
            background: Background::Color(Vec4::ONE),
            cull: Cull::None,
            marks: Marks::default(),
            samples: Samples::Four,
            mask: SubpixelMask::M16,
            shadows: Shadows::None,
            shadow_map_side: shadow_map::Options::default().side,
            bounces: 0,
            ambient_occlusion: None,
            depth: false,
            item: false,
            normal: false,
            max_pixels: 16_384 * 16_384,
            level: default_level(),
            work: Work::default(),
        }
    }

    /// Checks the options.
    ///
    /// # Errors
    /// [`Error::Parameter`] for a size of zero, a window that is empty or goes beyond the picture, and a window of a picture
    /// with a side above 131,072; [`Error::TooLarge`] for more pixels than `max_pixels`; [`Error::Unsupported`] for secondary
    /// rays with an algorithm that casts none, and for a window with ambient occlusion or by depth sort.
    pub fn check(&self) -> Result<()> {
        if self.width == 0 || self.height == 0 {
            let size = format!("{}x{}", self.width, self.height);
            return Err(Error::parameter("size", size, "at least 1x1"));
        }
        self.check_window()?;
        let (width, height) = self.rendered_size();
        let pixels = u64::from(width) * u64::from(height);
        if pixels > self.max_pixels {
            return Err(Error::TooLarge {
                what: "number of pixels",
                value: pixels,
                limit: self.max_pixels,
            });
        }
        if let Some(Exposure::Ev(ev)) = self.exposure
            && !ev.is_finite()
        {
            return Err(Error::parameter("exposure", ev, "a finite number of EV"));
        }
        if self.algorithm != SurfaceMethod::Ray {
            let instead = "the algorithm `ray` does that";
            if self.bounces > 0 {
                return Err(Error::Unsupported { what: "following reflected rays", instead });
            }
            if self.shadows == Shadows::Rays {
                return Err(Error::Unsupported { what: "casting rays to the lights", instead });
            }
        }
        self.camera.check()
    }

    fn check_window(&self) -> Result<()> {
        let Some(window) = self.window else { return Ok(()) };
        let whole = PixelRect::of_size(self.width, self.height)?;
        if window.is_empty() || window.intersection(&whole) != window {
            let (x, y) = (window.x0(), window.y0());
            let value = format!("{x},{y},{},{}", window.width(), window.height());
            let expected = "not empty, and within the picture";
            return Err(Error::parameter("window", value, expected));
        }
        if self.width.max(self.height) > GUARD_BAND as u32 {
            let expected = "at most 131,072 pixels a side for a picture in parts";
            let size = format!("{}x{}", self.width, self.height);
            return Err(Error::parameter("size", size, expected));
        }
        if self.ambient_occlusion.is_some() {
            let (what, instead) =
                ("ambient occlusion in a part of a picture", "it takes the whole");
            return Err(Error::Unsupported { what, instead });
        }
        if self.algorithm == SurfaceMethod::DepthSort {
            let (what, instead) =
                ("a part of a picture by depth sort", "all other methods do that");
            return Err(Error::Unsupported { what, instead });
        }
        Ok(())
    }

    /// Returns the width and height of the framebuffer: those of the window, if there is one.
    pub fn rendered_size(&self) -> (u32, u32) {
        let whole = (self.width, self.height);
        self.window.map_or(whole, |window| (window.width(), window.height()))
    }

    /// Returns the view of the camera, with the window.
    fn view(&self) -> Result<View> {
        let view = View::new(self.camera, self.width, self.height)?;
        Ok(self.window.map_or(view, |window| view.with_window(window)))
    }

    /// Returns the filter for triangles on the screen.
    fn filter(&self) -> TriangleFilter {
        let sample_reach = self.algorithm.sample_reach();
        TriangleFilter { cull: self.cull, sample_reach, marks: self.marks }
    }
}

/// Report on the rendering of a picture.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Report {
    /// Triangles of the scene, over all instances.
    pub triangles_in: u64,
    /// Triangles left out because a vertex is not finite.
    pub non_finite: u64,
    /// Triangles that were cut by a plane of the view volume.
    pub clipped: u64,
    /// Triangles left out because they are outside the view, seen from behind, or without area.
    pub culled: u64,
    /// Triangles passed to the rasterizer.
    pub drawn: u64,
    /// Seconds for vertices, clipping, set-up and shadow maps.
    pub geometry_seconds: f64,
    /// Seconds for rasterization, shading and resolve.
    pub raster_seconds: f64,
}

/// Renders a scene by the requested algorithm; the z-buffer is the production path.
///
/// Meshes without normals have flat faces. If Gouraud or Phong shading is requested, they get smooth normals first
/// ([`crate::scene::Mesh::with_smooth_normals`]).
///
/// The same input produces the same bytes on every CPU and number of threads. Runs on the current rayon pool where the
/// feature `parallel` is on.
///
/// # Errors
/// The errors of [`RenderOptions::check`] and [`Scene::check`].
pub fn render(scene: &Scene, options: &RenderOptions) -> Result<(Framebuffer, Report)> {
    let mut framebuffer = Framebuffer::new(0, 0);
    let report = render_into(scene, options, &mut framebuffer)?;
    Ok((framebuffer, report))
}

/// Renders like [`render`], into a framebuffer that may contain another picture. Afterwards it has the planes and bytes
/// that [`render`] returns. For pictures of one size its memory is reused, which saves a tenth of the time of small
/// ones.
///
/// ```
/// use durer::pipeline::{RenderOptions, render, render_into};
/// use durer::math::DVec3;
/// use durer::scene::{Camera, Projection, Scene};
/// use durer::target::Framebuffer;
///
/// let (eye, target, up) = (DVec3::Z, DVec3::ZERO, DVec3::Y);
/// let projection = Projection::Perspective { fov_y: 0.5 };
/// let camera = Camera { eye, target, up, projection, near: 0.1, far: 9.0 };
/// let mut options = RenderOptions::new(camera);
/// let mut picture = Framebuffer::new(0, 0);
/// for step in 0..4 {
///     options.camera.eye.x = f64::from(step);
///     render_into(&Scene::default(), &options, &mut picture)?;
///     assert_eq!(picture, render(&Scene::default(), &options)?.0);
/// }
/// # Ok::<(), durer::Error>(())
/// ```
///
/// # Errors
/// As [`render`]; the contents of the framebuffer are unusable then.
pub fn render_into(
    scene: &Scene,
    options: &RenderOptions,
    framebuffer: &mut Framebuffer,
) -> Result<Report> {
    render_traced(scene, options, framebuffer, &mut NoTrace)
}

/// Renders like [`render`], and counts the operations of the algorithm: depth comparisons, windows, pairs of polygons,
/// rays and the like. The picture has the same bytes.
///
/// The counts of the z-buffer are those of its loop over triangles and pixels' centres: its own tiles
/// compare less. It is run a second time for them.
///
/// # Errors
/// As [`render`].
pub fn render_counted(
    scene: &Scene,
    options: &RenderOptions,
) -> Result<(Framebuffer, Report, Vec<Operations>)> {
    let (mut framebuffer, mut tally) = (Framebuffer::new(0, 0), Tally::default());
    let report = render_traced(scene, options, &mut framebuffer, &mut tally)?;
    if options.algorithm == SurfaceMethod::ZBuffer {
        let view = options.view()?;
        let input = SurfaceInput::within(&options.work, scene, &view, options.filter())?;
        tally.add_comparisons(comparisons(&input)?);
    }
    Ok((framebuffer, report, tally.operations(options.algorithm)))
}

fn render_traced(
    scene: &Scene,
    options: &RenderOptions,
    framebuffer: &mut Framebuffer,
    t: &mut impl Tracer<method::Step>,
) -> Result<Report> {
    options.check()?;
    scene.check()?;
    let view = options.view()?;
    make_ready(framebuffer, options)?;
    let (lighting, surroundings) = (&options.lighting, &options.surroundings);
    let mut lights = lights(scene, &options.camera, (lighting, surroundings), options.exposure);
    lights.tone.map = options.tone_map;
    let smoothed = with_needed_normals(scene, options)?;
    let scene = smoothed.as_ref().map_or(scene, |smoothed| &smoothed.0);
    let start = Stopwatch::start();
    if options.shadows == Shadows::Map {
        let map = shadow_map::Options { side: options.shadow_map_side };
        shadow_map::cast_within(&options.work, scene, &mut lights, &map)?;
    }
    let shadow_seconds = start.seconds();
    let report = match options.algorithm {
        SurfaceMethod::ZBuffer => {
            let z_options = z_buffer::Options {
                samples: options.samples,
                cull: options.cull,
                marks: options.marks,
                shading: options.shading,
                background: options.background,
                level: options.level,
                work: options.work.clone(),
            };
            z_buffer::render(scene, &view, &lights, &z_options, framebuffer)?
        }
        _ => from_screen_triangles(scene, &view, &lights, options, framebuffer, t)?,
    };
    options.work.check()?;
    let start = Stopwatch::start();
    darken(&view, options, framebuffer);
    let darken_seconds = start.seconds();
    options.work.check()?;
    Ok(Report {
        triangles_in: scene.triangle_count(),
        non_finite: report.counts.non_finite,
        clipped: report.counts.clipped,
        culled: report.counts.culled,
        drawn: report.counts.drawn,
        geometry_seconds: report.geometry_seconds + shadow_seconds,
        raster_seconds: report.raster_seconds + darken_seconds,
    })
}

/// Applies ambient occlusion, if requested, and drops the planes that only it needs.
fn darken(view: &View, options: &RenderOptions, framebuffer: &mut Framebuffer) {
    let Some(occlusion) = &options.ambient_occlusion else { return };
    let Framebuffer { color, depth, normal, .. } = framebuffer;
    if let (Some(depth), Some(normal)) = (&depth, &normal) {
        ambient_occlusion::apply(view, (depth, normal), occlusion, options.level, color);
    }
    if !options.depth {
        *depth = None;
    }
    if !options.normal {
        *normal = None;
    }
}

/// Returns the lights of a picture from a camera, exposed.
fn lights(
    scene: &Scene,
    camera: &Camera,
    (lighting, surroundings): (&Lighting, &Surroundings),
    exposure: Option<Exposure>,
) -> PreparedLights {
    let (own, default) = match lighting {
        Lighting::Auto => (&scene.lights, Exposure::Auto),
        Lighting::Given(lights) => (lights, Exposure::Ev(0.0)),
    };
    let panorama = match surroundings {
        Surroundings::Panorama(panorama) => Some((panorama, scene.up_axis)),
        Surroundings::Studio | Surroundings::None => None,
    };
    let with_camera = *lighting == Lighting::Auto && own.is_empty() && panorama.is_none();
    let exposure = exposure.unwrap_or(default);
    let mut lights = match exposure {
        _ if with_camera => PreparedLights::auto(camera),
        Exposure::Auto => PreparedLights::exposed(panorama, own, scene, camera),
        Exposure::Ev(_) => PreparedLights::within(panorama, own, camera),
    };
    if let Exposure::Ev(ev) = exposure {
        lights.tone.gain = exp2(ev.clamp(-64.0, 64.0));
    }
    if *surroundings == Surroundings::Studio {
        lights.environment.mirrored = Mirrored::Studio(match with_camera {
            true => Studio::of_camera(camera),
            false => Studio::of_world(scene.up_axis),
        });
    }
    lights
}

/// Creates the requested planes of a framebuffer. Colours of the right number are not cleared, for every method sets
/// all of them; everything else is as new.
fn make_ready(framebuffer: &mut Framebuffer, options: &RenderOptions) -> Result<()> {
    let Framebuffer { color, .. } = std::mem::replace(framebuffer, Framebuffer::new(0, 0));
    let (width, height) = options.rendered_size();
    let stays = (color.width(), color.height()) == (width, height);
    let mut ready = if stays {
        Framebuffer { color, ..Framebuffer::new(0, 0) }
    } else {
        Framebuffer::within(&options.work, width, height)?
    };
    let occlusion = options.ambient_occlusion.is_some();
    let RenderOptions { work, depth, item, normal, .. } = options;
    ready.add_planes(work, *depth || occlusion, *item, *normal || occlusion)?;
    *framebuffer = ready;
    Ok(())
}

/// Picture by one method, compared with the z-buffer's.
#[derive(Debug, Clone)]
pub struct Compared {
    /// The method.
    pub method: SurfaceMethod,
    /// Its picture, with an item plane.
    pub picture: Framebuffer,
    /// Counts and times of the run.
    pub report: Report,
    /// Number of pixels whose item differs from the z-buffer's; all methods here promise 0.
    pub differing: u64,
}

/// Renders a scene by all methods and compares their item planes, in the order of
/// [`SurfaceMethod::ALL`]; `options.algorithm` does not matter.
///
/// # Errors
/// As [`render`].
pub fn compare(scene: &Scene, options: &RenderOptions) -> Result<Vec<Compared>> {
    let mut compared: Vec<Compared> = Vec::new();
    for &method in SurfaceMethod::ALL {
        let options = RenderOptions { algorithm: method, item: true, ..options.clone() };
        let (picture, report) = render(scene, &options)?;
        let first = compared.first().map_or(&picture, |z_buffer| &z_buffer.picture);
        let differing = differing_items(&picture, first);
        compared.push(Compared { method, picture, report, differing });
    }
    Ok(compared)
}

/// Returns the number of pixels with different items; 0 if a framebuffer has no item plane.
fn differing_items(a: &Framebuffer, b: &Framebuffer) -> u64 {
    match (&a.item, &b.item) {
        (Some(a), Some(b)) => a.data().iter().zip(b.data()).filter(|(a, b)| a != b).count() as u64,
        _ => 0,
    }
}

/// Renders by any method but the production path: lists the triangles on the screen, then applies the method.
fn from_screen_triangles(
    scene: &Scene,
    view: &View,
    lights: &PreparedLights,
    options: &RenderOptions,
    framebuffer: &mut Framebuffer,
    t: &mut impl Tracer<method::Step>,
) -> Result<z_buffer::StageReport> {
    let start = Stopwatch::start();
    let input = SurfaceInput::within(&options.work, scene, view, options.filter())?;
    let geometry_seconds = start.seconds();
    let start = Stopwatch::start();
    let method_options = method::Options {
        samples: options.samples,
        mask: options.mask,
        shadow_rays: options.shadows == Shadows::Rays,
        bounces: options.bounces,
        shading: options.shading,
        background: options.background,
        level: options.level,
    };
    render_with(options.algorithm, &input, lights, &method_options, framebuffer, t)?;
    let raster_seconds = start.seconds();
    Ok(z_buffer::StageReport { counts: input.counts, geometry_seconds, raster_seconds })
}

/// Approximate number of bytes for each corner of a mesh while its vertices get normals.
const PER_SMOOTHED: u64 = 48;

/// Returns the scene with the missing vertex normals added, and the charge for its memory, if the requested shading
/// interpolates and some are missing; `None` otherwise.
fn with_needed_normals(scene: &Scene, options: &RenderOptions) -> Result<Option<(Scene, Charge)>> {
    let interpolates = matches!(options.shading, Some(Shading::Gouraud | Shading::Phong));
    if !interpolates || scene.meshes.iter().all(|m| !m.normals.is_empty()) {
        return Ok(None);
    }
    let mut charge = options.work.charge("copy of the model", scene.bytes())?;
    let mut scene = scene.clone();
    for mesh in &mut scene.meshes {
        options.work.check()?;
        // Corners that are sharp are vertices of their own, with all attributes.
        charge.grow(mesh.index_count() as u64 * PER_SMOOTHED)?;
        *mesh = mesh.with_smooth_normals();
    }
    Ok(Some((scene, charge)))
}
