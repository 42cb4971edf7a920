//! Faces that share edges, in one pass and without seams.
//!
//! E. Catmull's weights, *A hidden-surface algorithm with anti-aliasing* (SIGGRAPH 1978), with nothing hidden: in each
//! pixel every face's colour is weighted by its area, and the sums are exact, because both faces of a shared edge get
//! the same integers. Class: image space. Cost: O(c + p) per face, c pixels crossed by its edges and p covered. Limits:
//! faces must not overlap; flat colours.

use super::band::{BandFiller, PathEdges, coverage_of_area};
use super::check_size;
use crate::Result;
use crate::curve::Contours;
use crate::info::{Class, Coherence, Info, Occluder};
use crate::raster::bands::BAND_ROWS;
use crate::target::Pixels;
use crate::trace::{PseudocodeLine, Tracer};

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "partition",
    title: "Faces summed to full coverage",
    authors: "E. Catmull",
    year: 1978,
    source: "A hidden-surface algorithm with anti-aliasing, SIGGRAPH",
    class: Class::ImageSpace,
    occluder: Occluder::None,
    coherence: &[Coherence::ScanLine, Coherence::Span],
    cost: "O(c + p) per face: c pixels crossed by its edges, p pixels covered",
    limits: "faces of one colour each that do not overlap; sides up to 32,767 pixels",
    pseudocode: &[
        "for each pixel: area ← 0, colour ← 0",
        "for each face:",
        "    for each pixel that it covers a part of:",
        "        a ← exact area of the face within the pixel",
        "        area ← area + a",
        "        colour ← colour + a · colour of the face",
        "for each pixel with area > 0:",
        "    if area > 1, faces overlap: divide area and colour by it",
        "    pixel ← colour + (1 − area) · pixel",
    ],
};

/// One face of a partition: a simple polygon, perhaps with holes, of one colour.
#[derive(Debug, Clone, PartialEq)]
pub struct PartitionFace {
    /// The outline in pixels, y down; a face's holes run against its outer contour.
    pub contours: Contours,
    /// 8-bit colour with straight alpha.
    pub color: [u8; 4],
}

/// Sums of one pixel: area 0 … 65,536, and area · colour for three channels and alpha.
type Sums = [u32; 5];

/// One step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Step {
    /// A face covers a part of a pixel.
    Area {
        /// Index of the face.
        face: usize,
        /// Column and row.
        pixel: (u32, u32),
        /// The part, of 65,536.
        area: u32,
    },
    /// Colour of a pixel whose sums are complete.
    Pixel {
        /// Column and row.
        pixel: (u32, u32),
        /// The faces over the earlier colour.
        color: [u8; 4],
    },
}

impl PseudocodeLine for Step {
    fn line(&self) -> usize {
        match self {
            Self::Area { .. } => 6,
            Self::Pixel { .. } => 9,
        }
    }
}

/// Paints faces that do not overlap over the target as one shape: their areas and colours are added in each pixel
/// before rounding, so that nothing behind shows through where faces meet.
///
/// The picture does not depend on the order of the faces and their vertices. Faces that do overlap mix in
/// proportion to their areas. Returns the number of pixels that the faces together cover fully.
///
/// # Errors
/// [`crate::Error::TooLarge`] for sides beyond 32,767 pixels.
pub fn fill_partition(
    faces: &[PartitionFace],
    target: &mut Pixels<[u8; 4]>,
    t: &mut impl Tracer<Step>,
) -> Result<u64> {
    let (width, height) = (target.width(), target.height());
    check_size(width, height)?;
    let mut list = Vec::new();
    let edges = |face: &PartitionFace| PathEdges::new(&face.contours, width, height, &mut list);
    let paths: Vec<PathEdges> = faces.iter().map(edges).collect();
    let mut filler = BandFiller::new(width);
    let mut full = 0;
    // Bands of rows bound the memory for the sums.
    for top in (0..height as i32).step_by(BAND_ROWS as usize) {
        let mut sums: Vec<Sums> = vec![[0; 5]; width as usize * BAND_ROWS as usize];
        let touched = faces.iter().zip(&paths).enumerate().filter(|(_, (_, p))| !p.misses(top));
        for (index, (face, path)) in touched {
            // Each face adds its exact area, and its premultiplied colour weighted by this area.
            let [r, g, b, a] = face.color.map(u32::from);
            let weights = [1, r * a / 255, g * a / 255, b * a / 255, a];
            filler.areas(path.with(&list), top, |row, x, area| {
                let pixel = (x as u32, top as u32 + row as u32);
                t.step(|| Step::Area { face: index, pixel, area: area as u32 });
                let sum = &mut sums[row as usize * width as usize + x];
                for (sum, weight) in sum.iter_mut().zip(weights) {
                    *sum = sum.saturating_add(area as u32 * weight);
                }
            });
        }
        // The sums become colours only now, so that rounding happens once per pixel.
        for (i, sum) in sums.iter().enumerate().filter(|(_, s)| s[0] != 0) {
            let (x, y) = (i as u32 % width, top as u32 + i as u32 / width);
            full += u64::from(coverage_of_area(sum[0].min(65_536) as i32) == 255);
            if let Some(below) = target.get(x, y) {
                let color = over(sum, below);
                t.step(|| Step::Pixel { pixel: (x, y), color });
                target.set(x, y, color);
            }
        }
    }
    Ok(full)
}

/// Returns the sums of a pixel composited over its previous colour, straight alpha in and out.
fn over(sum: &Sums, below: [u8; 4]) -> [u8; 4] {
    // All in units of 1/65,536 · 1/255; faces that overlap are scaled down to one pixel.
    let total = u64::from(sum[0].max(65_536));
    let part = |i: usize| u64::from(sum[i]) * 65_536 / total;
    let full = 65_536 * 255;
    let through = full - part(4).min(full);
    let behind = u64::from(below[3]) * through / 255;
    let alpha = part(4) + behind;
    if alpha == 0 {
        return [0; 4];
    }
    let channel = |i: usize| {
        let value = part(i + 1) * 255 + u64::from(below[i]) * behind;
        ((value + alpha / 2) / alpha).min(255) as u8
    };
    [channel(0), channel(1), channel(2), ((alpha + 32_768) >> 16).min(255) as u8]
}
