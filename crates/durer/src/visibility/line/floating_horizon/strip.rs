//! Straight pieces, the bands between them, and strips of columns with the bands over them.

use crate::math::DVec2;
use crate::sorting::CompactSort;

/// A straight piece that is not vertical, from left to right.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Segment {
    pub a: DVec2,
    pub b: DVec2,
}

impl Segment {
    /// Creates the piece between two points with different abscissas.
    pub fn new(p: DVec2, q: DVec2) -> Self {
        if p.x < q.x { Self { a: p, b: q } } else { Self { a: q, b: p } }
    }

    /// Returns the ordinate at a column; exact at both ends.
    pub fn at(&self, x: f64) -> f64 {
        if x <= self.a.x {
            self.a.y
        } else if x >= self.b.x {
            self.b.y
        } else {
            self.a.y + (self.b.y - self.a.y) * ((x - self.a.x) / (self.b.x - self.a.x))
        }
    }
}

/// Covered area between a lower and an upper horizon.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Band {
    pub lower: Segment,
    pub upper: Segment,
}

/// A range of columns over which the horizons are straight.
#[derive(Debug, Clone, PartialEq)]
pub struct Strip {
    pub from: f64,
    pub to: f64,
    band: Band,
    /// Further bands: where the surface has holes, one can look between its pieces.
    more: Vec<Band>,
}

impl Strip {
    pub fn new(from: f64, to: f64, band: Band) -> Self {
        Self { from, to, band, more: Vec::new() }
    }

    pub fn bands(&self) -> impl Iterator<Item = &Band> {
        std::iter::once(&self.band).chain(&self.more)
    }

    /// Returns the same over other columns.
    pub fn over(&self, from: f64, to: f64) -> Self {
        Self { from, to, band: self.band, more: self.more.clone() }
    }
}

impl Band {
    /// Returns whether all of the other band lies in this one.
    pub fn holds(&self, other: &Self, from: f64, to: f64) -> bool {
        [from, to]
            .into_iter()
            .all(|x| self.lower.at(x) <= other.lower.at(x) && self.upper.at(x) >= other.upper.at(x))
    }
}

/// Appends a strip, or lengthens the last one where this one only continues it.
pub fn push(strips: &mut Vec<Strip>, strip: Strip) {
    if let Some(last) = strips.last_mut()
        && last.to == strip.from
        && last.band == strip.band
        && last.more == strip.more
    {
        last.to = strip.to;
        return;
    }
    if strip.to > strip.from {
        strips.push(strip);
    }
}

/// Unites a strip's bands and one more over the columns `from … to` of the strip.
pub fn unite(
    strip: &Strip,
    band: &Band,
    [from, to]: [f64; 2],
    [column, touch]: [f64; 2],
    cuts: &mut Vec<f64>,
    out: &mut Vec<Strip>,
) {
    if to <= from {
        return;
    }
    if strip.bands().any(|b| b.holds(band, from, to)) {
        return push(out, strip.over(from, to));
    }
    cuts.clear();
    for mine in [band.lower, band.upper] {
        for other in strip.bands().flat_map(|b| [b.lower, b.upper]) {
            let (d0, d1) = (mine.at(from) - other.at(from), mine.at(to) - other.at(to));
            if (d0 > touch && d1 < -touch) || (d0 < -touch && d1 > touch) {
                let x = from + (to - from) * (d0 / (d0 - d1));
                if x - from > column && to - x > column {
                    cuts.push(x);
                }
            }
        }
    }
    cuts.sort_by(f64::total_cmp);
    cuts.push(to);
    let mut x = from;
    for &cut in cuts.iter() {
        if cut - x > column || cut == to {
            push(out, united(strip, band, x, cut, touch));
            x = cut;
        }
    }
}

/// Returns the union over columns in which no two borders cross.
fn united(strip: &Strip, band: &Band, from: f64, to: f64, touch: f64) -> Strip {
    let x = from + (to - from) * 0.5;
    let mut sum = *band;
    let mut apart: Vec<Band> = Vec::new();
    for other in strip.bands() {
        let above = other.lower.at(x) > sum.upper.at(x) + touch;
        let below = other.upper.at(x) < sum.lower.at(x) - touch;
        if above || below {
            apart.push(*other);
            continue;
        }
        // Where they are alike the older border stays, so that its strips stay whole.
        if other.lower.at(x) <= sum.lower.at(x) + touch {
            sum.lower = other.lower;
        }
        if other.upper.at(x) >= sum.upper.at(x) - touch {
            sum.upper = other.upper;
        }
    }
    // A sum that has grown may now reach bands that were apart before.
    let reaches = |b: &Band, sum: &Band| {
        b.lower.at(x) <= sum.upper.at(x) + touch && b.upper.at(x) >= sum.lower.at(x) - touch
    };
    while let Some(i) = apart.iter().position(|b| reaches(b, &sum)) {
        let other = apart.remove(i);
        if other.lower.at(x) < sum.lower.at(x) {
            sum.lower = other.lower;
        }
        if other.upper.at(x) > sum.upper.at(x) {
            sum.upper = other.upper;
        }
    }
    apart.compact_sort_by(|a, b| a.lower.at(x).total_cmp(&b.lower.at(x)));
    Strip { from, to, band: sum, more: apart }
}
