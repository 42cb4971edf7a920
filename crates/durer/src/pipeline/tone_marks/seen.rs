//! The visible surface at each pixel: its position, its normal, its brightness, and the neighbours that it
//! continues into.

use crate::math::{DMat4, DVec2, DVec3, DVec4};
use crate::scene::{Scene, Topology};
use crate::target::Framebuffer;
use crate::view::View;
use crate::view::pick::in_item_order;
use crate::visibility::region::hatch::luminance;
use std::ops::Range;

/// The surfaces of a picture.
pub struct Seen {
    pub width: u32,
    pub height: u32,
    pixels: Vec<Pixel>,
}

/// The surface at one pixel.
#[derive(Clone, Copy)]
pub struct Pixel {
    /// Position relative to the eye: to the right, down, and back; model units. NaN at the background.
    pub place: DVec3,
    /// Unit normal in the same directions, on the eye's side.
    pub normal: DVec3,
    /// Perceived lightness, 0 … 1.
    tone: f32,
    /// True if the same surface continues to the right, and below.
    right: bool,
    below: bool,
}

const NOTHING: Pixel =
    Pixel { place: DVec3::NAN, normal: DVec3::ZERO, tone: 1.0, right: false, below: false };

impl Pixel {
    pub fn is_seen(&self) -> bool {
        !self.place.is_nan()
    }

    /// Returns whether a neighbour shows the same surface: it is near the plane between the two and has a similar
    /// normal.
    fn goes_on_to(&self, other: &Self) -> bool {
        if !(self.is_seen() && other.is_seen() && self.normal.dot(other.normal) > SHARPEST) {
            return false;
        }
        let step = other.place - self.place;
        let across = (self.normal + other.normal) * 0.5;
        step.dot(across).abs() <= LARGEST_OFFSET * step.length()
    }
}

/// The cosine of the angle between the normals of neighbours on one surface: 53°.
const SHARPEST: f64 = 0.6;

/// Largest distance of a neighbour from the plane between two pixels, as a part of their distance. A round
/// surface of three pixels' radius stays below it.
const LARGEST_OFFSET: f64 = 0.3;

impl Seen {
    /// Reads a picture with planes of depth, items and normals.
    pub fn new(scene: &Scene, view: &View, picture: &Framebuffer, cap: Option<usize>) -> Self {
        let (width, height) = (picture.width(), picture.height());
        let eye = Eye::new(view);
        let left_out = caps(scene, cap);
        let triangles = u32::try_from(scene.triangle_count()).unwrap_or(u32::MAX);
        let pixel = |x: u32, y: u32| -> Option<Pixel> {
            let item = picture.item.as_ref()?.get(x, y)?;
            // Lines and points of the model come after its triangles.
            if item >= triangles || left_out.iter().any(|range| range.contains(&item)) {
                return None;
            }
            let depth = picture.depth.as_ref()?.get(x, y)?;
            let normal = picture.normal.as_ref()?.get(x, y)?;
            let tone = luminance(picture.color.get(x, y)?) as f32;
            let (place, normal) = eye.sees([x, y], depth, normal)?;
            Some(Pixel { place, normal, tone, ..NOTHING })
        };
        let mut seen = Self { width, height, pixels: Vec::new() };
        seen.pixels = seen.places().map(|(x, y)| pixel(x, y).unwrap_or(NOTHING)).collect();
        for (i, (x, y)) in seen.places().enumerate() {
            let here = seen.pixels[i];
            let goes_on = |to: Option<&Pixel>| to.is_some_and(|to| here.goes_on_to(to));
            let (right, below) = (goes_on(seen.pixel(x + 1, y)), goes_on(seen.pixel(x, y + 1)));
            (seen.pixels[i].right, seen.pixels[i].below) = (right, below);
        }
        seen
    }

    pub fn index(&self, x: u32, y: u32) -> Option<usize> {
        (x < self.width && y < self.height).then(|| (y * self.width + x) as usize)
    }

    /// Returns all pixels, row by row, as [`Self::index`] numbers them.
    pub fn places(&self) -> impl Iterator<Item = (u32, u32)> + use<> {
        let (width, height) = (self.width, self.height);
        (0..height).flat_map(move |y| (0..width).map(move |x| (x, y)))
    }

    /// Returns the pixels beside one, to the left, right, above and below, on the same surface.
    pub fn around_on_surface(&self, i: usize) -> impl Iterator<Item = usize> + '_ {
        let (x, y) = (i as u32 % self.width, i as u32 / self.width);
        let around = [(x.wrapping_sub(1), y), (x + 1, y), (x, y.wrapping_sub(1)), (x, y + 1)];
        let on = move |to: &(u32, u32)| self.goes_on((x, y), *to);
        around.into_iter().filter(on).filter_map(|(x, y)| self.index(x, y))
    }

    pub fn pixel(&self, x: u32, y: u32) -> Option<&Pixel> {
        self.pixels.get(self.index(x, y)?)
    }

    /// Returns the pixel around a point, where a surface is seen.
    fn around(&self, p: DVec2) -> Option<(u32, u32)> {
        if !(p.cmpge(DVec2::ZERO).all() && p.is_finite()) {
            return None;
        }
        let (x, y) = (p.x as u32, p.y as u32);
        self.pixel(x, y).is_some_and(Pixel::is_seen).then_some((x, y))
    }

    /// Returns the lightness at a point; `None` if no surface is.
    pub fn tone(&self, p: DVec2) -> Option<f64> {
        let (x, y) = self.around(p)?;
        self.pixel(x, y).map(|pixel| f64::from(pixel.tone))
    }

    /// Returns whether the surface continues from one pixel to a neighbour or the pixel itself, straight or around one
    /// corner.
    pub fn goes_on(&self, (x, y): (u32, u32), (u, v): (u32, u32)) -> bool {
        let across = |x: u32, y: u32| {
            let left = x.min(u);
            x == u || (x.abs_diff(u) == 1 && self.pixel(left, y).is_some_and(|p| p.right))
        };
        let along = |x: u32, y: u32| {
            let upper = y.min(v);
            y == v || (y.abs_diff(v) == 1 && self.pixel(x, upper).is_some_and(|p| p.below))
        };
        (across(x, y) && along(u, y)) || (along(x, y) && across(x, v))
    }

    /// Returns whether one surface continues from one point to another, at most a pixel away.
    pub fn joins(&self, from: DVec2, to: DVec2) -> bool {
        let ends = self.around(from).zip(self.around(to));
        ends.is_some_and(|(from, to)| self.goes_on(from, to))
    }
}

/// Returns the items of a section's caps.
fn caps(scene: &Scene, material: Option<usize>) -> Vec<Range<u32>> {
    let Some(material) = material else { return Vec::new() };
    let (mut found, mut first) = (Vec::new(), 0u32);
    let triangles = in_item_order(scene).filter(|(_, m)| m.topology == Topology::Triangles);
    for (_, mesh) in triangles {
        for (range, own) in mesh.material_runs() {
            let end = first.saturating_add(range.len() as u32);
            if own == Some(material) {
                found.push(first..end);
            }
            first = end;
        }
    }
    found
}

/// The map from a pixel and its depth to a place.
struct Eye {
    /// Right, down and back.
    axes: [DVec3; 3],
    from_screen: DMat4,
    perspective: bool,
}

impl Eye {
    fn new(view: &View) -> Self {
        let camera = view.camera();
        let [right, up, back] = camera.axes();
        let axes = [right, -up, back];
        let [x, y, z] = axes.map(|a| a.extend(0.0));
        let from_world =
            DMat4::from_cols(x, y, z, DVec4::W).transpose() * DMat4::from_translation(-camera.eye);
        let from_screen = from_world * view.screen_from_world().inverse();
        let perspective = matches!(camera.projection, crate::scene::Projection::Perspective { .. });
        Self { axes, from_screen, perspective }
    }

    /// Returns where a pixel's surface is, and its normal on the eye's side.
    fn sees(&self, [x, y]: [u32; 2], depth: f32, normal: [f32; 3]) -> Option<(DVec3, DVec3)> {
        let at = DVec4::new(f64::from(x) + 0.5, f64::from(y) + 0.5, f64::from(depth), 1.0);
        let place = self.from_screen * at;
        let place = place.truncate() / place.w;
        let normal = DVec3::from_array(normal.map(f64::from));
        let normal = DVec3::from_array(self.axes.map(|a| a.dot(normal))).try_normalize()?;
        let to_eye = if self.perspective { -place } else { DVec3::Z };
        let normal = if normal.dot(to_eye) < 0.0 { -normal } else { normal };
        place.is_finite().then_some((place, normal))
    }
}
