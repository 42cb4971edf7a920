//! Positions for the label of an area: inside it if the label fits, otherwise where it hides least.
//!
//! Names that fit in their area cannot collide, so they come first. A name that would hide most of its area is placed
//! beside it in the open, like the names of small islands on maps; a name that only extends a little over the border
//! stays where most of it is inside. No name is placed on another area unless it extends into its own.

use crate::clip::polygon::{Shapes, rectangle};
use crate::curve::Contours;
use crate::math::{DVec2, Rect};
use crate::raster::coverage::{FillRule, Options, fill};
use crate::sorting::CompactSort;
use crate::trace::NoTrace;

/// A label is in an area that holds this share of it: corners of its box are empty.
const HELD: f64 = 0.98;

/// Share of a label inside its area from which it nearly fits: such labels come before labels of larger areas that fit
/// less.
pub const NEARLY: f64 = 0.75;

/// A label belongs to an area that contains at least this share of it.
const MOSTLY: f64 = 0.5;

/// Smallest share of a label that an area has to hold for the label to reach out of it, if there is no better place.
const PARTLY: f64 = 0.35;

/// Largest share of a label on land with which it is in the open.
const OPEN: f64 = 0.02;

/// Factor within which the land around an area may be larger than it for the area to count as alone.
const ALONE: f64 = 1.5;

/// Numbers of columns and rows of candidate positions within an area.
const GRID: (u32, u32) = (17, 13);

/// Largest number of pixels per side in which the land is examined.
const LAND_SIDE: f64 = 1024.0;

/// Quality of a label's position in its area; better ones are placed first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Fit {
    /// Wholly inside.
    Held,
    /// Partly inside, with most of the area still visible.
    Over,
    /// Partly inside, hiding most of an area without neighbours.
    Hiding,
    /// Hardly inside.
    Tiny,
}

/// Middles of a label's box, the best first.
#[derive(Debug, Clone)]
pub struct Places {
    pub fit: Fit,
    /// The share of the label that the area holds.
    pub held: f64,
    /// True if the area has no neighbours, like an island.
    pub alone: bool,
    pub middles: Vec<DVec2>,
}

/// Index that answers which share of a rectangle is covered by areas.
#[derive(Debug)]
pub struct Land {
    low: DVec2,
    scale: f64,
    columns: usize,
    rows: usize,
    /// Sum, for each corner of a pixel, of the coverage of all that is left of it and above.
    sums: Vec<u64>,
}

impl Land {
    /// Creates the index of layers, each by the even-odd rule, in a viewport.
    pub fn new(layers: Vec<Contours>, seen: &Rect) -> crate::Result<Self> {
        let size = seen.size();
        let scale = (LAND_SIDE / size.max_element().max(1.0)).min(1.0);
        let side = |length: f64| (length * scale).ceil().max(1.0) as u32;
        let (width, height) = (side(size.x), side(size.y));
        let mut land = vec![0_u8; width as usize * height as usize];
        let options = Options { rule: FillRule::EvenOdd, ..Options::default() };
        for contours in layers {
            let map = crate::math::DAffine2::from_scale(DVec2::splat(scale))
                * crate::math::DAffine2::from_translation(-seen.min());
            let mask = fill(&contours.transformed(map), width, height, &options, &mut NoTrace)?;
            land.iter_mut().zip(mask.data()).for_each(|(land, own)| *land = (*land).max(*own));
        }
        let (columns, rows) = (width as usize, height as usize);
        let mut sums = vec![0; (columns + 1) * (rows + 1)];
        for (y, row) in land.chunks_exact(columns).enumerate() {
            let mut sum = 0;
            for (x, own) in row.iter().enumerate() {
                sum += u64::from(*own);
                let above = sums[y * (columns + 1) + x + 1];
                sums[(y + 1) * (columns + 1) + x + 1] = above + sum;
            }
        }
        Ok(Self { low: seen.min(), scale, columns, rows, sums })
    }

    /// Returns the share of a rectangle that is land, counted in whole pixels.
    fn share(&self, rect: &Rect) -> f64 {
        let limit = DVec2::new(self.columns as f64, self.rows as f64);
        let at = |p: DVec2| ((p - self.low) * self.scale).round().clamp(DVec2::ZERO, limit);
        let (low, high) = (at(rect.min()), at(rect.max()));
        let sum = |x: f64, y: f64| self.sums[y as usize * (self.columns + 1) + x as usize];
        let inside =
            sum(high.x, high.y) + sum(low.x, low.y) - sum(low.x, high.y) - sum(high.x, low.y);
        let size = high - low;
        inside as f64 / (255.0 * size.x * size.y).max(1.0)
    }

    /// Returns whether an area within these bounds has no neighbours within a distance.
    fn is_alone(&self, area: f64, bounds: &Rect, near: f64) -> bool {
        let around = Rect::new(bounds.min() - near, bounds.max() + near);
        around.is_ok_and(|rect| {
            self.share(&rect) * rect.size().element_product() <= ALONE * area + near
        })
    }
}

/// Returns the positions for a label of a size in an area; these points of it are far from the border.
pub fn around(area: &Shapes, poles: &[DVec2], size: DVec2, gap: f64, land: &Land) -> Places {
    let Some(bounds) = area.bounds() else {
        return Places { fit: Fit::Tiny, held: 0.0, alone: false, middles: poles.to_vec() };
    };
    let share_of = |middle: DVec2| {
        let label = Rect::new(middle - size / 2.0, middle + size / 2.0).ok()?;
        let cut = rectangle::clip(&label, area, &rectangle::Options, &mut NoTrace).ok()?;
        Some(cut.area().abs() / (size.x * size.y))
    };
    let mut inside: Vec<(f64, DVec2)> =
        poles.iter().filter_map(|p| Some((share_of(*p)?, *p))).collect();
    if inside.first().is_none_or(|best| best.0 < HELD) && bounds.size().max_element() > size.y {
        let cells = DVec2::new(f64::from(GRID.0), f64::from(GRID.1));
        let step = bounds.size() / cells;
        for (i, j) in (0..GRID.1).flat_map(|j| (0..GRID.0).map(move |i| (i, j))) {
            let middle = bounds.min() + step * (DVec2::new(f64::from(i), f64::from(j)) + 0.5);
            inside.extend(share_of(middle).map(|share| (share, middle)));
        }
    }
    // Of places where it fits whole, the first stays first: it is the farthest from the border.
    inside.compact_sort_by(|a, b| b.0.min(HELD).total_cmp(&a.0.min(HELD)));
    let best = inside.first().map_or(0.0, |best| best.0);
    let hidden = best * size.x * size.y / area.area().abs().max(f64::MIN_POSITIVE);
    let alone = land.is_alone(area.area().abs(), &bounds, size.y / 2.0);
    let is_open = |middle: &DVec2| {
        let label = Rect::new(*middle - size / 2.0, *middle + size / 2.0);
        label.is_ok_and(|label| land.share(&label) <= OPEN)
    };
    // At a corner, only an area without neighbours is unambiguous.
    let sides = if alone { 8 } else { 4 };
    let open = beside(&bounds, size, gap).into_iter().take(sides).filter(is_open);
    let on = inside.iter().filter(|(share, _)| *share >= MOSTLY).map(|(_, middle)| *middle);
    let partly = inside.iter().filter(|(share, _)| (PARTLY..MOSTLY).contains(share));
    let over = partly.map(|(_, middle)| *middle).chain(poles.iter().copied());
    let over = over.chain(poles.iter().flat_map(|pole| reaching_out(*pole, size)));
    let fit = match best {
        b if b >= HELD => Fit::Held,
        b if b < MOSTLY => Fit::Tiny,
        // Between neighbours there is no open place.
        _ if hidden <= MOSTLY || !alone => Fit::Over,
        _ => Fit::Hiding,
    };
    let middles = match fit {
        Fit::Held | Fit::Over => on.chain(open).chain(over).collect(),
        Fit::Hiding | Fit::Tiny => open.chain(on).chain(over).collect(),
    };
    Places { fit, held: best, alone, middles }
}

/// Returns places from which a label still reaches to a point: it begins or ends there, is above it or below it.
fn reaching_out(point: DVec2, size: DVec2) -> [DVec2; 6] {
    let (x, y) = ((size.x - size.y) / 2.0, size.y / 2.0);
    [(x, 0.0), (-x, 0.0), (x, -y), (x, y), (-x, -y), (-x, y)].map(|(x, y)| point + DVec2::new(x, y))
}

/// Returns places beside a box: right, left, above, below and at its corners.
fn beside(bounds: &Rect, size: DVec2, gap: f64) -> Vec<DVec2> {
    let (low, high) = (bounds.min(), bounds.max());
    let middle = (low + high) / 2.0;
    let (left, right) = (low.x - gap - size.x / 2.0, high.x + gap + size.x / 2.0);
    let (above, below) = (low.y - gap - size.y / 2.0, high.y + gap + size.y / 2.0);
    [
        (right, middle.y),
        (left, middle.y),
        (middle.x, above),
        (middle.x, below),
        (right, above),
        (right, below),
        (left, above),
        (left, below),
    ]
    .map(|(x, y)| DVec2::new(x, y))
    .to_vec()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(low: f64, high: f64) -> Shapes {
        let mut shapes = Shapes::new();
        let corners = [(low, low), (high, low), (high, high), (low, high)];
        shapes.push_ring(corners.map(|(x, y)| DVec2::new(x, y)));
        shapes.end_polygon();
        shapes
    }

    /// Returns the land of one square in a viewport of 200 × 200.
    fn land(low: f64, high: f64) -> Land {
        let contours = Contours::polygon(
            [(low, low), (high, low), (high, high), (low, high)].map(|(x, y)| DVec2::new(x, y)),
        );
        let seen = Rect::new(DVec2::ZERO, DVec2::splat(200.0)).unwrap();
        Land::new(vec![contours], &seen).unwrap()
    }

    #[test]
    fn a_label_is_on_what_holds_it_and_beside_what_it_would_hide() {
        let size = DVec2::new(40.0, 12.0);
        let places = |low, high, land: &Land| {
            around(&square(low, high), &[DVec2::splat((low + high) / 2.0)], size, 2.0, land)
        };
        let large = places(60.0, 140.0, &land(60.0, 140.0));
        assert_eq!((large.fit, large.middles[0]), (Fit::Held, DVec2::splat(100.0)));
        let island = places(97.0, 103.0, &land(97.0, 103.0));
        assert_eq!((island.fit, island.middles[0]), (Fit::Tiny, DVec2::new(125.0, 100.0)));
        let medium = places(85.0, 115.0, &land(85.0, 115.0));
        assert_eq!((medium.fit, medium.middles[0]), (Fit::Over, DVec2::splat(100.0)));
        let hidden = places(90.0, 110.0, &land(90.0, 110.0));
        assert_eq!((hidden.fit, hidden.middles[0]), (Fit::Hiding, DVec2::new(132.0, 100.0)));
        // With land all around, moving gains nothing.
        let enclosed = places(90.0, 110.0, &land(0.0, 200.0));
        assert_eq!((enclosed.fit, enclosed.middles[0]), (Fit::Over, DVec2::splat(100.0)));
        assert!(island.alone && !enclosed.alone);
    }

    #[test]
    fn the_land_in_a_rectangle_is_counted() {
        let land = land(50.0, 100.0);
        let rect = |x0: f64, y0: f64, x1: f64, y1: f64| {
            Rect::new(DVec2::new(x0, y0), DVec2::new(x1, y1)).unwrap()
        };
        assert_eq!(land.share(&rect(60.0, 60.0, 90.0, 70.0)), 1.0);
        assert_eq!(land.share(&rect(0.0, 0.0, 50.0, 200.0)), 0.0);
        assert_eq!(land.share(&rect(40.0, 60.0, 60.0, 80.0)), 0.5);
        assert_eq!(land.share(&rect(-40.0, -60.0, -10.0, -5.0)), 0.0);
    }
}
