//! Tones of a drawing by marks that follow the surfaces: lines along their curvature, or dots.
//!
//! Visibility, direction and lightness come from a picture by the z-buffer, a few pixels for each mark, so marks end
//! within a fraction of a pen's width from the ends of surfaces. O(pixels), plus the cost of
//! [`crate::curve::streamlines`] and [`crate::raster::stipple`].

mod bent;
mod branches;
mod directions;
mod seen;
mod tensor;

use super::draw::seen_height;
use super::{DrawOptions, RenderOptions, render, with_needed_normals};
use crate::clip::simplify::douglas_peucker;
use crate::curve::streamlines::{Field, Options, Streamline, streamlines};
use crate::math::DVec2;
use crate::raster::stipple::stipple;
use crate::scene::Scene;
use crate::shade::Shading;
use crate::target::Pixels;
use crate::target::drawing::{Line, LineClass};
use crate::trace::NoTrace;
use crate::view::View;
use crate::visibility::surface::Samples;
use crate::{Error, Result};
use directions::{Across, Directions};
use seen::Seen;

/// The marks that show tones.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ToneMarks {
    /// Lines along the surfaces' curvature, crossed where it is darkest; class [`LineClass::Hatch`].
    Contours {
        /// Distance of lines in the darkest tone, plane units, above 0.
        spacing: f64,
    },
    /// Dots, the closer the darker; class [`LineClass::Stipple`].
    Dots {
        /// Diameter of a dot: the width of the pen. Plane units, above 0.
        diameter: f64,
    },
}

/// Surfaces of at least this perceived lightness stay empty, as in [`crate::visibility::region::hatch`].
const WHITE: f64 = 0.85;

/// The share of the paper that dots cover where it is darkest: beyond that they merge.
const FULL: f64 = 0.7;

/// Pixels to the distance of the closest lines, and to the diameter of dots.
const PIXELS: [f64; 2] = [3.0, 4.0];

/// Width or height of the picture at most.
const MOST_PIXELS: f64 = 3072.0;

/// Bytes of a pixel's place, normal, sides, curvatures and directions.
const BYTES_OF_PIXEL: u64 = 500;

/// A dot is a stroke so much shorter than it is wide.
const DOT_LENGTH: f64 = 0.02;

/// Largest distance that lines may move when points are left out, in pixels.
const TOLERANCE: f64 = 0.05;

/// Returns marks for the tones of the surfaces that a drawing with the same options shows, in its plane: visible lines
/// to be drawn with it. Caps of sections have none: [`crate::visibility::region::hatch`] is for these.
///
/// # Errors
/// A size that is not a number above 0; as [`super::draw`] and [`super::render`].
pub fn tone_marks(scene: &Scene, options: &DrawOptions, marks: ToneMarks) -> Result<Vec<Line>> {
    let (size, pixels) = match marks {
        ToneMarks::Contours { spacing } => (spacing, PIXELS[0]),
        ToneMarks::Dots { diameter } => (diameter, PIXELS[1]),
    };
    if !(size.is_finite() && size > 0.0) {
        return Err(Error::parameter("size of marks", size, "a number above 0"));
    }
    scene.check()?;
    let frame = Frame::new(options, size, pixels)?;
    let mut how = frame.picture(options);
    let smoothed = with_needed_normals(scene, &how)?;
    let scene = smoothed.as_ref().map_or(scene, |smoothed| &smoothed.0);
    how.shading = None;
    let _room = options.work.charge("tones", frame.bytes())?;
    let picture = render(scene, &how)?.0;
    let seen = Seen::new(scene, &frame.view, &picture, options.cap_material);
    drop(picture);
    options.work.check()?;
    Ok(match marks {
        ToneMarks::Contours { .. } => contours(&seen, &frame, seen_height(&options.camera)),
        ToneMarks::Dots { .. } => dots(&seen, &frame),
    })
}

/// The picture's place in the plane.
struct Frame {
    view: View,
    /// The upper left corner, plane units.
    corner: DVec2,
    /// The size of a pixel, plane units.
    pixel: f64,
    /// The size of marks, in pixels.
    size: f64,
}

impl Frame {
    fn new(options: &DrawOptions, size: f64, pixels: f64) -> Result<Self> {
        let height = seen_height(&options.camera);
        let larger = height * options.aspect.max(1.0);
        let pixel = (size / pixels).max(larger / MOST_PIXELS);
        let count = |side: f64| (side / pixel).ceil().clamp(1.0, MOST_PIXELS) as u32;
        let view = View::new(options.camera, count(height * options.aspect), count(height))?;
        let pixel = height / f64::from(view.height());
        let half = DVec2::new(f64::from(view.width()), -f64::from(view.height())) * (0.5 * pixel);
        Ok(Self { view, corner: -half, pixel, size: size / pixel })
    }

    /// Returns the picture that tones come from, with smooth normals.
    fn picture(&self, options: &DrawOptions) -> RenderOptions {
        RenderOptions {
            width: self.view.width(),
            height: self.view.height(),
            lighting: options.lighting.clone(),
            exposure: options.exposure,
            cull: options.cull,
            shading: Some(Shading::Phong),
            samples: Samples::One,
            depth: true,
            item: true,
            normal: true,
            work: options.work.clone(),
            ..RenderOptions::new(options.camera)
        }
    }

    /// Returns the memory for all that is found at pixels.
    fn bytes(&self) -> u64 {
        u64::from(self.view.width()) * u64::from(self.view.height()) * BYTES_OF_PIXEL
    }

    fn plane_from_pixels(&self, p: DVec2) -> DVec2 {
        self.corner + DVec2::new(p.x, -p.y) * self.pixel
    }
}

/// Returns lines along the curvature, and where it is darkest across it.
fn contours(seen: &Seen, frame: &Frame, height: f64) -> Vec<Line> {
    let directions = Directions::new(seen, height);
    let size = DVec2::new(f64::from(seen.width), f64::from(seen.height));
    let options = Options { step: STEP, closest: CLOSEST, shortest: SHORTEST * frame.size };
    let mut lines = Vec::new();
    for across in [Across::No, Across::Yes] {
        let field = Hatching { seen, directions: &directions, across, closest: frame.size };
        let seeds = seen.places().map(|(x, y)| center(x, y));
        let found = streamlines(&field, size, seeds, &options);
        lines.extend(found.into_iter().filter_map(|line| frame.line(line)));
    }
    lines
}

/// Pixels from point to point of a line.
const STEP: f64 = 0.75;

/// Lines end where they come nearer to others than this part of their distance.
const CLOSEST: f64 = 0.6;

/// Lines shorter than this many of the smallest distances look like dirt.
const SHORTEST: f64 = 2.5;

fn center(x: u32, y: u32) -> DVec2 {
    DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5)
}

/// One direction of hatching.
struct Hatching<'a> {
    seen: &'a Seen,
    directions: &'a Directions,
    across: Across,
    /// Distance of lines in the darkest tone, pixels.
    closest: f64,
}

impl Field for Hatching<'_> {
    fn direction(&self, p: DVec2) -> Option<DVec2> {
        self.directions.at(self.seen, p, self.across)
    }

    fn separation(&self, p: DVec2) -> Option<f64> {
        let tone = self.seen.tone(p)? / WHITE;
        let Tones { closest, doubled, none } = match self.across {
            Across::No => ALONG,
            Across::Yes => ACROSS,
        };
        let doublings = ((tone - closest) / doubled).max(0.0);
        (tone < none).then(|| self.closest * libm::exp2(doublings))
    }

    fn joins(&self, from: DVec2, to: DVec2) -> bool {
        self.seen.joins(from, to)
    }
}

/// The distances of lines of one direction by the tone, 0 … 1.
struct Tones {
    /// Tone up to which they are at their closest.
    closest: f64,
    /// Difference in tone at which they are twice as far apart.
    doubled: f64,
    /// Tone above which there are no marks.
    none: f64,
}

const ALONG: Tones = Tones { closest: 0.25, doubled: 0.25, none: 1.0 };

/// Crossing lines begin where lines along the curvature are twice as far apart as at their closest.
const ACROSS: Tones = Tones { closest: 0.15, doubled: 0.17, none: 0.5 };

impl Frame {
    /// Returns a line in the plane, without points that it does not need.
    fn line(&self, line: Streamline) -> Option<Line> {
        let options = douglas_peucker::Options { tolerance: TOLERANCE };
        let kept = douglas_peucker::simplify(&line.points, &options, &mut NoTrace).ok()?;
        let points: Vec<DVec2> =
            kept.into_iter().map(|i| self.plane_from_pixels(line.points[i])).collect();
        let closed = line.closed && points.len() > 2;
        (points.len() > 1).then_some(Line {
            class: LineClass::Hatch,
            invisibility: 0,
            points,
            closed,
        })
    }
}

/// Returns a dot for each share of tone that it covers.
fn dots(seen: &Seen, frame: &Frame) -> Vec<Line> {
    let area = std::f64::consts::FRAC_PI_4 * frame.size * frame.size;
    let mut density = Pixels::new(seen.width, seen.height, 0.0);
    for (x, y) in seen.places() {
        if let Some(tone) = seen.tone(center(x, y)) {
            // Tones are roots of luminance; the paper shows its mean.
            let lightness = (tone / WHITE) * (tone / WHITE);
            let covered = (1.0 - lightness).clamp(0.0, FULL);
            density.set(x, y, (covered / area) as f32);
        }
    }
    let half = DVec2::new(0.5 * DOT_LENGTH * frame.size * frame.pixel, 0.0);
    let dot = |p: DVec2| {
        let at = frame.plane_from_pixels(p);
        Line {
            class: LineClass::Stipple,
            invisibility: 0,
            points: vec![at - half, at + half],
            closed: false,
        }
    };
    stipple(&density).into_iter().map(dot).collect()
}
