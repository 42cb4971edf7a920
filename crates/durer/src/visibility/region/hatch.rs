//! Hatching: tones as parallel lines, for pens without shades of grey.
//!
//! All lines of one direction are at multiples of one distance, and a region takes every first, second, fourth, … of
//! them, so lines continue through neighbours of the same tone and end where the tone gets lighter. The darkest tones
//! are crossed by a second direction.

use crate::math::DVec2;
use crate::shade::color::decode_srgb8;
use crate::sorting::CompactSort;
use crate::target::drawing::{Line, LineClass, Region, RegionKind};

/// Options for hatching.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// Distance between lines in the darkest tone; plane units, above 0.
    pub spacing: f64,
    /// Direction of the lines, radians from the x axis, counter-clockwise.
    pub angle: f64,
    /// Regions of at least this luminance (0 black … 1 white) stay empty.
    pub white: f64,
    /// True if dark regions get lines in a second direction, at right angles to the first.
    pub cross: bool,
}

impl Default for Options {
    /// Returns lines at 45°, one unit apart.
    fn default() -> Self {
        Self { spacing: 1.0, angle: std::f64::consts::FRAC_PI_4, white: 0.85, cross: true }
    }
}

/// Distinct tones: every 8th, 4th, 2nd or each line.
const TONES: i32 = 4;

/// Directions of the hatching for the caps of successive parts, degrees relative to the first, which is 45°; all can be
/// distinguished from one another.
const PARTS: [f64; 6] = [0.0, 90.0, 15.0, 105.0, -15.0, 75.0];

/// Lines over one region, at most: beyond that it is black anyway.
const MOST_LINES: f64 = 1e6;

/// Returns the lines that represent the tones of regions; class [`LineClass::Hatch`].
///
/// Caps get the standard hatching of sections, one distance at one angle, whatever their colour; the caps of further
/// parts ([`Region::part`]) get other angles. Cost:
/// O(lines · sides of regions that they cross); no lines if the spacing is not a number above 0.
pub fn hatch(regions: &[Region], options: &Options) -> Vec<Line> {
    if !(options.spacing.is_finite() && options.spacing > 0.0 && options.angle.is_finite()) {
        return Vec::new();
    }
    let [first, others @ ..] = by_direction(regions);
    let mut lines = family(&first, options, options.angle, |region| first_tone(region, options));
    if options.cross {
        let across = options.angle + std::f64::consts::FRAC_PI_2;
        lines.extend(family(&first, options, across, |region| second_tone(region, options)));
    }
    for (turn, regions) in PARTS.iter().skip(1).zip(others) {
        let angle = options.angle + turn.to_radians();
        lines.extend(family(&regions, options, angle, |region| first_tone(region, options)));
    }
    lines
}

/// Returns the regions by the direction of their lines: all in the first but caps of further parts.
fn by_direction(regions: &[Region]) -> [Vec<&Region>; PARTS.len()] {
    let mut parts: Vec<u32> = regions.iter().filter_map(|r| r.part).collect();
    parts.sort_unstable();
    parts.dedup();
    let mut found = [const { Vec::new() }; PARTS.len()];
    for region in regions {
        let rank = region.part.map_or(0, |part| parts.partition_point(|p| *p < part));
        found[rank % PARTS.len()].push(region);
    }
    found
}

/// A region takes every how-many-th line; `None` leaves it empty.
type Stride = Option<i64>;

fn first_tone(region: &Region, options: &Options) -> Stride {
    if region.kind == RegionKind::Cap {
        return Some(4);
    }
    let tone = luminance(region.color) / options.white.max(f64::MIN_POSITIVE);
    (tone < 1.0).then(|| 1i64 << ((tone.max(0.0) * f64::from(TONES)) as i32).min(TONES - 1))
}

/// Returns the stride of the second direction's lines, which are added where the first direction is at its densest.
fn second_tone(region: &Region, options: &Options) -> Stride {
    let densest = region.kind != RegionKind::Cap && first_tone(region, options) == Some(1);
    let half = luminance(region.color) * f64::from(2 * TONES) < options.white;
    densest.then_some(if half { 1 } else { 2 })
}

/// Returns the perceived lightness of a colour, 0…1: the root of its linear luminance.
pub(crate) fn luminance(color: [u8; 4]) -> f64 {
    let [r, g, b] = [color[0], color[1], color[2]].map(|c| f64::from(decode_srgb8(c)));
    (0.2126 * r + 0.7152 * g + 0.0722 * b).sqrt()
}

/// Returns the lines of one direction.
fn family(
    regions: &[&Region],
    options: &Options,
    angle: f64,
    stride: impl Fn(&Region) -> Stride,
) -> Vec<Line> {
    let axis = DVec2::new(libm::cos(angle), libm::sin(angle));
    let turned = |p: DVec2| DVec2::new(axis.dot(p), axis.perp_dot(p));
    let mut spans: Vec<(i64, f64, f64)> = Vec::new();
    let mut meets: Vec<(i64, f64)> = Vec::new();
    for region in regions {
        let Some(stride) = stride(region) else { continue };
        meets.clear();
        for ring in &region.rings {
            let Some(&last) = ring.last() else { continue };
            let mut from = last;
            for &to in ring {
                crossings(turned(from), turned(to), options.spacing, stride, &mut meets);
                from = to;
            }
        }
        meets.compact_sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        let pairs = meets.as_chunks::<2>().0.iter();
        spans.extend(pairs.filter(|[a, b]| a.0 == b.0 && a.1 < b.1).map(|[a, b]| (a.0, a.1, b.1)));
    }
    spans.sort_unstable_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let back = |k: i64, along: f64| axis * along + axis.perp() * (k as f64 * options.spacing);
    united(&spans, options.spacing)
        .map(|(k, from, to)| Line {
            class: LineClass::Hatch,
            invisibility: 0,
            points: vec![back(k, from), back(k, to)],
            closed: false,
        })
        .collect()
}

/// Finds the intersections of a side with the lines of every `stride`-th number: (number, place
/// along the line). A side owns its lower end, so corners are met once or twice, never three times.
fn crossings(a: DVec2, b: DVec2, spacing: f64, stride: i64, meets: &mut Vec<(i64, f64)>) {
    // Computed from the same end for both directions, so that neighbours meet in the same place.
    let (low, high) = if (a.y, a.x) <= (b.y, b.x) { (a, b) } else { (b, a) };
    let step = spacing * stride as f64;
    let (first, end) = ((low.y / step).ceil(), (high.y / step).ceil());
    // Written so that huge numbers and NaN fail the test.
    if !(end - first <= MOST_LINES && first.abs() < 1e15) {
        return;
    }
    for k in first as i64..end as i64 {
        let t = (k as f64 * step - low.y) / (high.y - low.y);
        meets.push((k * stride, low.x + (high.x - low.x) * t));
    }
}

/// Joins spans that follow each other without a gap.
fn united(spans: &[(i64, f64, f64)], spacing: f64) -> impl Iterator<Item = (i64, f64, f64)> {
    // Neighbours meet to the last few digits; a thousandth of the spacing is far below any pen.
    let gap = spacing * 1e-3;
    let mut rest = spans.iter().copied().peekable();
    std::iter::from_fn(move || {
        let (k, from, mut to) = rest.next()?;
        while let Some(next) = rest.next_if(|s| s.0 == k && s.1 <= to + gap) {
            to = to.max(next.2);
        }
        Some((k, from, to))
    })
}
