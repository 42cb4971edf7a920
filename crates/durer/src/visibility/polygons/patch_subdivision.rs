//! Catmull's subdivision: curved patches divided until a piece covers at most one pixel's centre.
//!
//! E. Catmull, *A Subdivision Algorithm for Computer Display of Curved Surfaces*, dissertation, University of Utah,
//! 1974, for which the z-buffer was invented ([`super::z_buffer`]). A bicubic patch is halved in both directions, and
//! its quarters likewise, until the rectangle around a piece contains at most one pixel's centre. Thus surfaces of a
//! higher degree are displayed without intersecting them with rays or scan lines. Class: image space. Cost: O(covered
//! pixels) pieces, and O(log of the patch's size in pixels) more along each outline; memory O(pixels + depth of the
//! division).
//!
//! Deviations: patches are Bézier patches, halved by de Casteljau's algorithm, where the paper keeps differences, which
//! take fewer additions. A piece with one centre is divided until it is nearly a parallelogram, then the centre is
//! compared with that, and the depth is the piece's own there; the paper uses the polygon of the corners. Colours are
//! not included.

use super::Screen;
use crate::curve::bezier::{bicubic, split};
use crate::info::{Class, Info, Occluder};
use crate::math::{DVec2, DVec3};
use crate::target::{NO_ITEM, Pixels};
use crate::trace::{PseudocodeLine, Tracer};
use crate::{Error, Result};
use std::ops::Range;

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "patch-subdivision",
    title: "Catmull's subdivision of patches",
    authors: "E. Catmull",
    year: 1974,
    source: "A Subdivision Algorithm for Computer Display of Curved Surfaces, University of Utah",
    class: Class::ImageSpace,
    occluder: Occluder::Point,
    coherence: &[],
    cost: "O(covered pixels) pieces, some more along outlines; O(pixels and depth of the division) memory",
    limits: "bicubic patches; one sample per pixel; outlines are off by the flatness at most",
    pseudocode: &[
        "for each pixel: depth[x, y] ← ∞, item[x, y] ← none; stack ← all patches",
        "while the stack is not empty: take a piece from it",
        "    box ← rectangle around its 16 control points; the piece is within it",
        "    if no pixel's centre is in the box: drop the piece",
        "    else if several are in it, or the piece is not flat:",
        "        halve its rows, then its columns, by de Casteljau; put the four quarters on the stack",
        "    else if the piece covers the centre of the one pixel (x, y):",
        "        z ← depth of the piece there",
        "        if z < depth[x, y]: depth[x, y] ← z, item[x, y] ← the patch",
    ],
};

/// Options for the division.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// Largest distance, in pixels, of a piece with one centre from the parallelogram that approximates it; outlines
    /// are off by at most as much. Positive; half of it takes about one more division there.
    pub flatness: f64,
    /// The most divisions of a piece of a piece: a patch of 2ⁿ pixels needs about n.
    pub max_depth: u32,
    /// The most pieces of all patches together.
    pub max_pieces: u64,
}

impl Default for Options {
    /// Returns the default: a 64th of a pixel, 24 divisions, a hundred million pieces.
    fn default() -> Self {
        Self { flatness: 1.0 / 64.0, max_depth: 24, max_pieces: 100_000_000 }
    }
}

impl Options {
    fn check(&self) -> Result<()> {
        if self.flatness > 0.0 && self.flatness.is_finite() {
            return Ok(());
        }
        Err(Error::parameter("flatness", self.flatness, "positive and finite"))
    }
}

/// A bicubic Bézier patch: x right and y down in pixels, z the distance from the eye.
///
/// # Guarantees
/// All coordinates of control points are between −1e100 and 1e100.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BicubicPatch {
    rows: [[DVec3; 4]; 4],
}

/// A part of the parameters of a patch: from and to along the rows, from and to across them.
pub type PatchPart = [[f64; 2]; 2];

impl BicubicPatch {
    /// Creates a patch from four rows of control points: u grows along each row, v across the rows.
    ///
    /// # Errors
    /// [`Error::NonFinite`]; [`Error::Parameter`] for coordinates beyond ±1e100, whose sums might not be finite.
    pub fn new(rows: [[DVec3; 4]; 4]) -> Result<Self> {
        let points = rows.as_flattened();
        if let Some(index) = points.iter().position(|point| !point.is_finite()) {
            return Err(Error::NonFinite { what: "control point", index });
        }
        match points.iter().find(|point| point.abs().max_element() > 1e100) {
            Some(huge) => Err(Error::parameter(
                "control point",
                huge,
                "of coordinates between −1e100 and 1e100",
            )),
            None => Ok(Self { rows }),
        }
    }

    /// Returns the control points, row by row.
    pub fn rows(&self) -> &[[DVec3; 4]; 4] {
        &self.rows
    }

    /// Returns the point at u, v, each 0 … 1.
    pub fn point(&self, [u, v]: [f64; 2]) -> DVec3 {
        bicubic(&self.rows, u, v).0
    }

    /// Returns the four corners: u = 0 and 1 for v = 0, then for v = 1.
    pub(crate) fn corners(&self) -> [DVec3; 4] {
        let [first, _, _, last] = &self.rows;
        [first[0], first[3], last[0], last[3]]
    }

    /// Returns both halves along the rows.
    fn halved(&self) -> [Self; 2] {
        let mut halves = [*self; 2];
        for (k, row) in self.rows.iter().enumerate() {
            let (near, far) = split(row, 0.5);
            for (half, points) in halves.iter_mut().zip([near, far]) {
                half.rows[k].iter_mut().zip(points).for_each(|(place, point)| *place = point);
            }
        }
        halves
    }

    fn transposed(&self) -> Self {
        Self { rows: [0, 1, 2, 3].map(|k| self.rows.map(|row| row[k])) }
    }

    /// Returns the four quarters, each with its part of the parameters.
    fn quarters(&self, [[u0, u1], [v0, v1]]: PatchPart) -> [(Self, PatchPart); 4] {
        let (u, v) = ((u0 + u1) / 2.0, (v0 + v1) / 2.0);
        let [left, right] = self.halved().map(|half| half.transposed().halved());
        let [near, far] = left.map(|quarter| quarter.transposed());
        let [right_near, right_far] = right.map(|quarter| quarter.transposed());
        [
            (near, [[u0, u], [v0, v]]),
            (right_near, [[u, u1], [v0, v]]),
            (far, [[u0, u], [v, v1]]),
            (right_far, [[u, u1], [v, v1]]),
        ]
    }

    /// Returns the columns and rows of a screen whose pixels have their centres in the rectangle around the control
    /// points, borders included.
    fn centers(&self, screen: &Screen) -> [Range<u32>; 2] {
        let points = self.rows.as_flattened();
        let along = |axis: usize, size: u32| {
            let all = || points.iter().map(|point| point[axis] - 0.5);
            let low = all().fold(f64::INFINITY, f64::min).ceil();
            let high = all().fold(f64::NEG_INFINITY, f64::max).floor() + 1.0;
            // Out of range is cut off by the conversion.
            (low as u32).min(size)..(high as u32).min(size)
        };
        [along(0, screen.width), along(1, screen.height)]
    }

    /// Returns the origin and the sides, along u and v, of the parallelogram that three corners span on the screen.
    fn parallelogram(&self) -> [DVec2; 3] {
        let [a, b, c, _] = self.corners().map(|corner| corner.truncate());
        [a, b - a, c - a]
    }

    /// Returns whether all control points are within a distance of where they would be for the parallelogram.
    fn is_flat(&self, flatness: f64) -> bool {
        let [origin, along, across] = self.parallelogram();
        self.rows.iter().enumerate().all(|(j, row)| {
            row.iter().enumerate().all(|(i, point)| {
                let place = origin + along * (i as f64 / 3.0) + across * (j as f64 / 3.0);
                point.truncate().distance(place) <= flatness
            })
        })
    }

    /// Returns the depth at a point of the screen; `None` if the parallelogram, grown by a distance, does not cover
    /// that.
    fn depth(&self, p: DVec2, grown: f64) -> Option<f64> {
        let [origin, along, across] = self.parallelogram();
        let area = along.perp_dot(across);
        let p = p - origin;
        // Twice the areas of the triangles to the four sides; area / side is a distance.
        let (u, v) = (p.perp_dot(across), along.perp_dot(p));
        let is_between = |x: f64, side: DVec2| {
            let margin = grown * side.length();
            let x = x * area.signum();
            x >= -margin && x <= area.abs() + margin
        };
        let covers = is_between(u, across) && is_between(v, along);
        // A piece that is seen edge-on has no area; its middle is as good as any other point.
        let parameter = |x: f64| if area == 0.0 { 0.5 } else { (x / area).clamp(0.0, 1.0) };
        covers.then(|| self.point([parameter(u), parameter(v)]).z)
    }
}

/// Step of the algorithm. Patches have the numbers of their order.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step {
    /// All pixels are cleared.
    Clear,
    /// No centre of a pixel is in the rectangle around a piece.
    Drop {
        /// The patch.
        patch: u32,
        /// The piece.
        part: PatchPart,
    },
    /// A piece is divided into four.
    Divide {
        /// The patch.
        patch: u32,
        /// The piece.
        part: PatchPart,
        /// Number of the centres in the rectangle around it.
        centers: u64,
    },
    /// The centre of the one pixel is compared with a piece.
    Compare {
        /// The patch.
        patch: u32,
        /// The piece.
        part: PatchPart,
        /// Column and row.
        pixel: [u32; 2],
        /// The piece's depth at the centre; none if it does not cover that.
        depth: Option<f64>,
        /// The depth stored so far.
        stored: f64,
    },
    /// The piece is nearer: depth and patch are stored.
    Store {
        /// Column and row.
        pixel: [u32; 2],
        /// The patch.
        patch: u32,
        /// Its depth.
        depth: f64,
    },
}

impl PseudocodeLine for Step {
    fn line(&self) -> usize {
        match self {
            Self::Clear => 1,
            Self::Drop { .. } => 4,
            Self::Divide { .. } => 6,
            Self::Compare { depth: None, .. } => 7,
            Self::Compare { .. } => 8,
            Self::Store { .. } => 9,
        }
    }
}

/// The nearest patch at each pixel's centre.
#[derive(Debug, Clone, PartialEq)]
pub struct PatchPicture {
    /// Index of the patch.
    pub items: Pixels<u32>,
    /// Depth of the patch; infinite where there is none.
    pub depths: Pixels<f64>,
}

impl PatchPicture {
    fn new(screen: &Screen) -> Result<Self> {
        Ok(Self { items: screen.plane(NO_ITEM)?, depths: screen.plane(f64::INFINITY)? })
    }

    fn store(&mut self, [x, y]: [u32; 2], patch: u32, depth: f64) {
        self.items.set(x, y, patch);
        self.depths.set(x, y, depth);
    }
}

/// Returns the picture that a list of steps leads to.
///
/// # Errors
/// [`Memory`](crate::Error::Memory) where the screen's budget does not suffice.
pub fn replay(screen: &Screen, steps: &[Step]) -> Result<PatchPicture> {
    let mut picture = PatchPicture::new(screen)?;
    for step in steps {
        if let Step::Store { pixel, patch, depth } = *step {
            picture.store(pixel, patch, depth);
        }
    }
    Ok(picture)
}

/// Returns the nearest patch at each pixel's centre, of equally near ones the first, with its depth.
///
/// ```
/// use durer::math::DVec3;
/// use durer::trace::NoTrace;
/// use durer::visibility::polygons::Screen;
/// use durer::visibility::polygons::patch_subdivision::{Options, BicubicPatch, render};
///
/// // A square of six pixels with a bulge towards the eye.
/// let inner = |k: usize| k == 1 || k == 2;
/// let point = |i: usize, j: usize| {
///     let z = if inner(i) && inner(j) { 1.0 } else { 5.0 };
///     DVec3::new(2.0 * i as f64, 2.0 * j as f64, z)
/// };
/// let patch = BicubicPatch::new([0, 1, 2, 3].map(|j| [0, 1, 2, 3].map(|i| point(i, j))))?;
/// let screen = Screen { width: 7, height: 7, ..Screen::default() };
/// let found = render(&[patch], &screen, &Options::default(), &mut NoTrace)?;
/// assert_eq!(found.items.data().iter().filter(|item| **item == 0).count(), 36);
/// // At u = v = 7/12 the inner points weigh (35/48)².
/// let depth = 5.0 - 4.0 * (35.0_f64 / 48.0).powi(2);
/// assert!((found.depths.get(3, 3).unwrap() - depth).abs() < 1e-9);
/// # Ok::<(), durer::Error>(())
/// ```
///
/// # Errors
/// [`Error::Parameter`] for a flatness that is not positive; [`Error::Limit`] for more divisions or pieces than the
/// options allow; [`Memory`](crate::Error::Memory) where the screen's budget does not suffice.
pub fn render(
    patches: &[BicubicPatch],
    screen: &Screen,
    options: &Options,
    t: &mut impl Tracer<Step>,
) -> Result<PatchPicture> {
    options.check()?;
    let mut picture = PatchPicture::new(screen)?;
    t.step(|| Step::Clear);
    let (mut pieces, mut stack) = (0u64, Vec::new());
    for (patch, own) in (0..).zip(patches) {
        stack.push((*own, [[0.0, 1.0]; 2], 0));
        while let Some((piece, part, depth)) = stack.pop() {
            pieces += 1;
            if pieces > options.max_pieces {
                let limit = options.max_pieces;
                return Err(Error::Limit {
                    what: "number of pieces of patches",
                    value: pieces,
                    limit,
                });
            }
            if pieces.is_multiple_of(CHECKED) {
                screen.work.check()?;
            }
            let [columns, rows] = piece.centers(screen);
            let centers = columns.len() as u64 * rows.len() as u64;
            if centers == 0 {
                t.step(|| Step::Drop { patch, part });
                continue;
            }
            let is_last = depth >= options.max_depth;
            if centers > 1 && is_last {
                let (value, limit) = (u64::from(depth) + 1, u64::from(options.max_depth));
                return Err(Error::Limit { what: "number of divisions of a patch", value, limit });
            }
            if centers > 1 || !(is_last || piece.is_flat(options.flatness)) {
                t.step(|| Step::Divide { patch, part, centers });
                // The last one put there is the first to be taken.
                let quarters = piece.quarters(part).into_iter().rev();
                stack.extend(quarters.map(|(piece, part)| (piece, part, depth + 1)));
                continue;
            }
            let pixel = [columns.start, rows.start];
            picture.compare(&piece, (patch, part), pixel, options.flatness, t);
        }
    }
    Ok(picture)
}

/// Pieces after which the work's cancellation is looked up.
const CHECKED: u64 = 4096;

impl PatchPicture {
    /// Stores a piece at a pixel if it covers the centre, and is nearer than the stored depth.
    fn compare(
        &mut self,
        piece: &BicubicPatch,
        (patch, part): (u32, PatchPart),
        pixel @ [x, y]: [u32; 2],
        flatness: f64,
        t: &mut impl Tracer<Step>,
    ) {
        let center = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
        let depth = piece.depth(center, flatness);
        let stored = self.depths.get(x, y).unwrap_or(f64::INFINITY);
        t.step(|| Step::Compare { patch, part, pixel, depth, stored });
        if let Some(depth) = depth.filter(|depth| *depth < stored) {
            t.step(|| Step::Store { pixel, patch, depth });
            self.store(pixel, patch, depth);
        }
    }
}
