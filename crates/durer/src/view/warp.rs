//! New views from given ones: forward warping of pictures with depth.
//!
//! L. McMillan, G. Bishop, *Plenoptic Modeling: An Image-Based Rendering System*, SIGGRAPH 1995, move
//! every pixel to where a near camera sees its point; S. Chen, L. Williams, *View Interpolation for
//! Image Synthesis*, SIGGRAPH 1993, keep the nearest by a z-buffer and speak of the holes. Image space.
//! Each pixel is taken as a small square on its surface, whose slope comes from its neighbours' depths;
//! window depth is linear on the screen, so squares of one plane join without a gap. Cost: O(pixels of
//! all pictures + pixels lit); memory O(pixels of the new picture).
//!
//! Limits: surfaces that no picture shows are holes; colours are as seen from the old eye; pixels that become larger
//! than [`LARGEST`] are left out. Depth 1 means that there is no surface: such pixels are treated as infinitely far
//! away, and show only where no picture shows a surface. Pixels of smoothed outlines get the colour of the surface
//! whose depth they have.

mod unmixed;

use crate::info::{Class, Coherence, Info, Occluder};
use crate::math::{DMat4, DVec2, DVec3, DVec4};
use crate::scene::Camera;
use crate::target::{Framebuffer, Pixels};
use crate::trace::{PseudocodeLine, Tracer};
use crate::view::View;
use crate::work::Work;
use crate::{Error, Result};

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "forward-warp",
    title: "Forward warping with a z-buffer",
    authors: "S. Chen, L. Williams; L. McMillan, G. Bishop",
    year: 1993,
    source: "View Interpolation for Image Synthesis, SIGGRAPH",
    class: Class::ImageSpace,
    occluder: Occluder::Point,
    coherence: &[Coherence::Frame],
    cost: "O(pixels of the pictures + pixels lit) time, O(pixels of the new picture) memory",
    limits: "areas that no picture shows are holes; pixels that become very large are left out",
    pseudocode: &[
        "for each picture, for each of its pixels (x, y) with the depth z:",
        "    slope ← change of depth to the neighbours whose depth is nearest",
        "    (x', y', z') ← N · M⁻¹ · (x, y, z, 1), divided by w'",
        "    square ← the pixel's square with its slope, moved likewise",
        "    for each pixel of the new picture whose centre lies in it:",
        "        if z' is nearer than what this picture has put there: keep it",
        "pixels that the first picture does not show: take the next one's",
        "pixels that no picture shows are holes",
    ],
};

/// Pixels on a side that a pixel may cover in the new picture. A near camera does not need more, and
/// wrong depths cannot make the work grow without bound.
pub const LARGEST: f64 = 64.0;

/// Half the side of a pixel's square, in pixels: a little more than half, so that squares with different
/// slopes leave no gap.
const HALF_SIDE: f64 = 0.5 + 1.0 / 16.0;

/// A picture with depth and the camera it was made with.
#[derive(Debug, Clone, Copy)]
pub struct DepthPicture<'a> {
    /// 8-bit sRGB with straight alpha.
    pub color: &'a Pixels<[u8; 4]>,
    /// Window depth 0 (near) … 1 (far), 1 at the background; of the same size.
    pub depth: &'a Pixels<f32>,
    /// The eye it was seen from.
    pub camera: Camera,
}

/// Options for the look of holes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Options {
    /// The colour of pixels that no picture shows.
    pub hole: [u8; 4],
    /// Budget of the work, and its cancellation.
    pub work: Work,
}

impl Default for Options {
    /// Returns the default: magenta, which marks holes.
    fn default() -> Self {
        Self { hole: [255, 0, 255, 255], work: Work::default() }
    }
}

/// Step of the algorithm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step {
    /// A pixel of a picture finds its place.
    Move {
        /// Index of the picture.
        source: usize,
        /// Its column and row there.
        from: [u32; 2],
        /// Position of its middle in the new picture, in pixels.
        to: DVec2,
        /// Its depth there.
        depth: f64,
        /// Its own colour, without the colours mixed in at a smoothed outline.
        color: [u8; 4],
    },
    /// The pixel moved last is the nearest so far at a pixel of the new picture. The nearest pixel of an earlier
    /// picture stays, and surfaces hide pixels of depth 1 in all pictures.
    Write {
        /// Column and row.
        at: [u32; 2],
    },
}

impl PseudocodeLine for Step {
    fn line(&self) -> usize {
        match self {
            Self::Move { .. } => 3,
            Self::Write { .. } => 6,
        }
    }
}

/// A new view.
#[derive(Debug, Clone, PartialEq)]
pub struct Warped {
    /// Colour and depth; holes have depth 1.
    pub framebuffer: Framebuffer,
    /// Source picture of each pixel; [`HOLE`] if none shows it.
    pub source: Pixels<u32>,
    /// Pixels that no picture shows.
    pub holes: u64,
}

/// The source of a pixel that no picture shows.
pub const HOLE: u32 = u32::MAX;

/// Makes the view of a camera from pictures: the surfaces of the first, where it shows none those of the second, and so
/// on; the background where no picture has a surface.
///
/// # Errors
/// [`Error::Parameter`] if a picture's depth has another size than its colours, or a camera cannot
/// see ([`Camera::check`]).
pub fn warp(
    sources: &[DepthPicture<'_>],
    camera: &Camera,
    [width, height]: [u32; 2],
    options: &Options,
    t: &mut impl Tracer<Step>,
) -> Result<Warped> {
    let view = View::new(*camera, width, height)?;
    let work = &options.work;
    let mut framebuffer = Framebuffer::within(work, width, height)?;
    framebuffer.add_planes(work, true, false, false)?;
    framebuffer.color.data_mut().fill(options.hole);
    let mut chosen = Pixels::within((work, STAGE), width, height, HOLE)?;
    let pixels = u64::from(width) * u64::from(height);
    let layer = pixels.saturating_mul(2 * size_of::<Option<(f64, [u8; 4])>>() as u64);
    let _layers = work.charge(STAGE, layer.saturating_mul(sources.len() as u64))?;
    work.room_for::<u8>(STAGE, layer)?;
    let layers: Vec<Layer> = (0..)
        .zip(sources)
        .map(|(index, source)| Layer::of(index, source, (&view, work), t))
        .collect::<Result<_>>()?;
    let surfaces = layers.iter().map(|layer| &layer.nearest);
    let nothing = layers.iter().map(|layer| &layer.nothing);
    for (index, found) in (0..).zip(surfaces).chain((0..).zip(nothing)) {
        let depths = framebuffer.depth.iter_mut().flat_map(|d| d.data_mut());
        let colors = framebuffer.color.data_mut().iter_mut();
        let planes = chosen.data_mut().iter_mut().zip(depths).zip(colors);
        for (((chosen, depth), color), found) in planes.zip(found) {
            if let (HOLE, Some((z, rgba))) = (*chosen, found) {
                (*chosen, *depth, *color) = (index, *z as f32, *rgba);
            }
        }
    }
    let holes = chosen.data().iter().filter(|s| **s == HOLE).count() as u64;
    Ok(Warped { framebuffer, source: chosen, holes })
}

/// Name of the buffers in errors about memory.
const STAGE: &str = "places of moved pixels";

/// Contribution of one picture to the new view.
struct Layer {
    width: u32,
    height: u32,
    /// Depth and colour of the nearest surface so far.
    nearest: Vec<Option<(f64, [u8; 4])>>,
    /// Colour of the background.
    nothing: Vec<Option<(f64, [u8; 4])>>,
}

impl Layer {
    /// Moves all pixels of one source into the new view.
    fn of(
        index: u32,
        source: &DepthPicture<'_>,
        (view, work): (&View, &Work),
        t: &mut impl Tracer<Step>,
    ) -> Result<Self> {
        let (width, height) = (view.width(), view.height());
        let none = vec![None; width as usize * height as usize];
        let mut layer = Self { width, height, nearest: none.clone(), nothing: none };
        let (w, h) = (source.color.width(), source.color.height());
        if (source.depth.width(), source.depth.height()) != (w, h) {
            let size = format!("{}x{}", source.depth.width(), source.depth.height());
            return Err(Error::parameter("depth picture", size, "as large as its colour picture"));
        }
        let old = View::new(source.camera, w, h)?;
        let new_from_old = view.screen_from_world() * old.screen_from_world().inverse();
        if !new_from_old.is_finite() {
            return Err(Error::parameter("camera", "one of the pictures'", "able to be inverted"));
        }
        let endless = endless(&old, view);
        let colors = unmixed::unmixed(source);
        work.begin("rows of a picture", h.into());
        let rows = (0..h).take_while(|_| !work.is_stopped()).inspect(|_| work.advance(1));
        for (x, y) in rows.flat_map(|y| (0..w).map(move |x| (x, y))) {
            let depth = f64::from(source.depth.get(x, y).unwrap_or(1.0));
            let Some(color) = colors.get(x, y).filter(|_| (0.0..=1.0).contains(&depth)) else {
                continue;
            };
            let center = DVec3::new(f64::from(x) + 0.5, f64::from(y) + 0.5, depth);
            let is_nothing = depth >= 1.0;
            let slope = if is_nothing { DVec2::ZERO } else { slope(source.depth, x, y) };
            let moving = if is_nothing { &endless } else { &new_from_old };
            let Some(mut to) = moved(moving, center) else { continue };
            if is_nothing {
                to.z = 1.0;
            }
            t.step(|| {
                let (to, depth) = (to.truncate(), to.z);
                Step::Move { source: index as usize, from: [x, y], to, depth, color }
            });
            if let Some(corners) = corners(moving, center, slope) {
                layer.splat(&corners, color, is_nothing, t);
            }
        }
        work.check().map(|()| layer)
    }

    /// Sets the pixels whose centres are in a square, where it is nearer than the surface there.
    fn splat(
        &mut self,
        corners: &[DVec3; 4],
        rgba: [u8; 4],
        is_nothing: bool,
        t: &mut impl Tracer<Step>,
    ) {
        let flat = corners.map(|c| c.truncate());
        let (lo, hi) = flat.iter().fold((flat[0], flat[0]), |(l, h), &p| (l.min(p), h.max(p)));
        let size = DVec2::new(f64::from(self.width), f64::from(self.height));
        if (hi - lo).max_element() > LARGEST || lo.cmpge(size).any() || hi.cmple(DVec2::ZERO).any()
        {
            return;
        }
        let first = (lo - 0.5).ceil().max(DVec2::ZERO).as_uvec2();
        let last = (hi - 0.5).floor().min(size - 1.0);
        if last.cmplt(DVec2::ZERO).any() {
            return;
        }
        let last = last.as_uvec2();
        for (x, y) in (first.y..=last.y).flat_map(|y| (first.x..=last.x).map(move |x| (x, y))) {
            let p = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
            let [a, b, c, d] = *corners;
            let Some(z) = depth_in([a, b, c], p).or_else(|| depth_in([a, c, d], p)) else {
                continue;
            };
            let z = if is_nothing { 1.0 } else { z };
            let plane = if is_nothing { &mut self.nothing } else { &mut self.nearest };
            let Some(place) = plane.get_mut(y as usize * self.width as usize + x as usize) else {
                continue;
            };
            if (0.0..=1.0).contains(&z) && place.is_none_or(|(kept, _)| z < kept) {
                *place = Some((z, rgba));
                t.step(|| Step::Write { at: [x, y] });
            }
        }
    }
}

/// Returns the matrix that takes pixels of the old screen to the new one as if they were infinitely far away: only the
/// rotation of the camera moves them. In parallel projection, they keep their place in the picture.
fn endless(old: &View, new: &View) -> DMat4 {
    let size = |view: &View| DVec2::new(f64::from(view.width()), f64::from(view.height()));
    let parallel = |view: &View| {
        matches!(view.camera().projection, crate::scene::Projection::Orthographic { .. })
    };
    if parallel(old) || parallel(new) {
        return DMat4::from_scale((size(new) / size(old)).extend(1.0));
    }
    let world_from_old = old.screen_from_world().inverse();
    // A point at homogeneous depth 1 less the eye, which is the same for all w, is a direction.
    let eye = old.camera().eye;
    let from_eye = DMat4::from_translation(-eye) * world_from_old;
    let direction =
        DMat4::from_cols_array_2d(&from_eye.to_cols_array_2d().map(|[x, y, z, _]| [x, y, z, 0.0]));
    new.screen_from_world() * direction
}

/// Returns a point of the old screen on the new one; `None` behind the eye.
fn moved(new_from_old: &DMat4, p: DVec3) -> Option<DVec3> {
    let q: DVec4 = *new_from_old * p.extend(1.0);
    let place = q.truncate() / q.w;
    (q.w > 0.0 && place.is_finite()).then_some(place)
}

/// Returns the corners of a pixel's square in the new picture.
fn corners(new_from_old: &DMat4, center: DVec3, slope: DVec2) -> Option<[DVec3; 4]> {
    let corner = |x: f64, y: f64| {
        let z = center.z + slope.x * x + slope.y * y;
        moved(new_from_old, DVec3::new(center.x + x, center.y + y, z.clamp(0.0, 1.0)))
    };
    let h = HALF_SIDE;
    Some([corner(-h, -h)?, corner(h, -h)?, corner(h, h)?, corner(-h, h)?])
}

/// Returns the change of depth per pixel to the right and downwards: towards the neighbour with the closer depth,
/// because the other may belong to another surface.
fn slope(depth: &Pixels<f32>, x: u32, y: u32) -> DVec2 {
    let here = depth.get(x, y).unwrap_or(1.0);
    let along = |before: Option<f32>, after: Option<f32>| {
        let differences = [before.map(|b| here - b), after.map(|a| a - here)];
        let known = differences.into_iter().flatten().filter(|d| d.is_finite());
        known.reduce(|a, b| if b.abs() < a.abs() { b } else { a }).map_or(0.0, f64::from)
    };
    let at = |x: Option<u32>, y: Option<u32>| depth.get(x?, y?);
    DVec2::new(
        along(at(x.checked_sub(1), Some(y)), at(x.checked_add(1), Some(y))),
        along(at(Some(x), y.checked_sub(1)), at(Some(x), y.checked_add(1))),
    )
}

/// Returns the depth of a triangle at a point of the screen, if it covers it; its border belongs to
/// it.
fn depth_in([a, b, c]: [DVec3; 3], p: DVec2) -> Option<f64> {
    let edge = |u: DVec3, v: DVec3| (v - u).truncate().perp_dot(p - u.truncate());
    let e = [edge(b, c), edge(c, a), edge(a, b)];
    let sum = e[0] + e[1] + e[2];
    let inside = e.iter().all(|&e| e >= 0.0) || e.iter().all(|&e| e <= 0.0);
    (inside && sum != 0.0).then(|| (e[0] * a.z + e[1] * b.z + e[2] * c.z) / sum)
}
