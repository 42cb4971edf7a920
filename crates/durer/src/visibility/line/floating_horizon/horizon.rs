//! The part of the picture that the surface covers so far, as exact piecewise linear bands over the
//! columns.

use super::strip::{Band, Segment, Strip, push, unite};
use crate::math::DVec2;
use crate::sorting::CompactSort;

/// Vertical distances below this part of the picture's height are none: what touches is one.
const TOUCH: f64 = 1.0 / (1u64 << 40) as f64;
/// Columns nearer to each other than this part of the picture's width are one. Abscissas of vertices
/// are multiples of a larger part, so only crossings are ever this close.
const COLUMN: f64 = 1.0 / (1u64 << 44) as f64;

/// The upper and the lower horizon, and those of pieces between holes.
///
/// A horizon keeps the surface's own edges, not values computed at its corners, so it does not drift
/// however often it is cut, and a piece that turns out to be uncut is whole again.
#[derive(Debug)]
pub struct Horizon {
    left: f64,
    /// Width of a bucket.
    width: f64,
    /// Strips by columns, so that a change moves few of them: sorted and disjoint in each.
    buckets: Vec<Vec<Strip>>,
    touch: f64,
    column: f64,
    /// Memory used again and again.
    fresh: Vec<Strip>,
    cuts: Vec<f64>,
}

impl Horizon {
    /// Creates an empty horizon for a picture with these opposite corners.
    pub fn new(min: DVec2, max: DVec2, buckets: usize) -> Self {
        let size = max - min;
        let buckets = if size.x > 0.0 { buckets.max(1) } else { 1 };
        Self {
            left: min.x,
            width: if size.x > 0.0 { size.x / buckets as f64 } else { 1.0 },
            buckets: vec![Vec::new(); buckets],
            touch: size.y * TOUCH,
            column: size.x * COLUMN,
            fresh: Vec::new(),
            cuts: Vec::new(),
        }
    }

    fn bucket(&self, x: f64) -> usize {
        // The cast maps columns left of the picture to 0.
        (((x - self.left) / self.width) as usize).min(self.buckets.len() - 1)
    }

    /// Returns the end of a bucket; infinite for the last.
    fn end_of(&self, bucket: usize) -> f64 {
        if bucket + 1 >= self.buckets.len() {
            return f64::INFINITY;
        }
        self.left + self.width * (bucket + 1) as f64
    }

    /// Covers a convex polygon, given by its corners in order, either way round.
    pub fn cover(&mut self, polygon: &[DVec2]) {
        // The edges that run to the right are one border, those that run to the left the other.
        let mut chains: [Vec2Chain; 2] = [Vec2Chain::default(), Vec2Chain::default()];
        for (i, &p) in polygon.iter().enumerate() {
            let q = polygon[(i + 1) % polygon.len()];
            if p.x != q.x {
                chains[usize::from(q.x < p.x)].push(Segment::new(p, q));
            }
        }
        let [mut one, mut other] = chains;
        one.sort();
        other.sort();
        let (mut i, mut j) = (0, 0);
        while let (Some(s), Some(t)) = (one.get(i), other.get(j)) {
            let (from, to) = (s.a.x.max(t.a.x), s.b.x.min(t.b.x));
            if from < to {
                let middle = from + (to - from) * 0.5;
                let s_above = s.at(middle) >= t.at(middle);
                let (lower, upper) = if s_above { (t, s) } else { (s, t) };
                self.cover_columns(from, to, Band { lower, upper });
            }
            i += usize::from(s.b.x <= to);
            j += usize::from(t.b.x <= to);
        }
    }

    fn cover_columns(&mut self, from: f64, to: f64, band: Band) {
        let mut from = from;
        for bucket in self.bucket(from)..=self.bucket(to) {
            let end = self.end_of(bucket).min(to);
            if end > from {
                self.cover_in(bucket, from, end, &band);
                from = end;
            }
        }
    }

    /// Covers a band over columns of one bucket.
    fn cover_in(&mut self, bucket: usize, from: f64, to: f64, band: &Band) {
        let strips = &mut self.buckets[bucket];
        let first = strips.partition_point(|s| s.to <= from);
        let last = first + strips[first..].iter().take_while(|s| s.from < to).count();
        if let [only] = &strips[first..last]
            && only.from <= from
            && only.to >= to
            && only.bands().any(|b| b.holds(band, from, to))
        {
            return;
        }
        let mut fresh = std::mem::take(&mut self.fresh);
        // A neighbour may continue in the new strips.
        let start = first.saturating_sub(1);
        let end = (last + 1).min(strips.len());
        fresh.extend(strips[start..first].iter().cloned());
        let mut x = from;
        for strip in &strips[first..last] {
            if strip.from > x {
                push(&mut fresh, Strip::new(x, strip.from, *band));
                x = strip.from;
            }
            if strip.from < from {
                push(&mut fresh, strip.over(strip.from, from));
            }
            let until = strip.to.min(to);
            unite(strip, band, [x, until], [self.column, self.touch], &mut self.cuts, &mut fresh);
            if strip.to > to {
                push(&mut fresh, strip.over(to, strip.to));
            }
            x = until;
        }
        if x < to {
            push(&mut fresh, Strip::new(x, to, *band));
        }
        for strip in &strips[last..end] {
            push(&mut fresh, strip.clone());
        }
        strips.splice(start..end, fresh.drain(..));
        self.fresh = fresh;
    }

    /// Finds the parts of the segment p … q that are covered, as sorted, disjoint ranges of 0 … 1 from p to q.
    ///
    /// Lines along the border of the covered area count as covered, because they coincide with an existing line.
    pub fn hidden(&self, p: DVec2, q: DVec2, hidden: &mut Vec<[f64; 2]>) {
        hidden.clear();
        if p.x == q.x {
            self.hidden_upright(p, q, hidden);
        } else {
            self.hidden_along(p, q, hidden);
        }
        join(hidden);
    }

    fn hidden_along(&self, p: DVec2, q: DVec2, hidden: &mut Vec<[f64; 2]>) {
        let line = Segment::new(p, q);
        let share = |x: f64| if x == q.x { 1.0 } else { (x - p.x) / (q.x - p.x) };
        for bucket in self.bucket(line.a.x)..=self.bucket(line.b.x) {
            let strips = &self.buckets[bucket];
            let first = strips.partition_point(|s| s.to <= line.a.x);
            for strip in strips[first..].iter().take_while(|s| s.from < line.b.x) {
                let (from, to) = (strip.from.max(line.a.x), strip.to.min(line.b.x));
                for band in strip.bands() {
                    if let Some([u, v]) = self.inside(&line, band, from, to) {
                        let (s, t) = (share(u), share(v));
                        hidden.push(if s < t { [s, t] } else { [t, s] });
                    }
                }
            }
        }
    }

    /// Returns the columns of `from … to` over which the line lies in the band.
    fn inside(&self, line: &Segment, band: &Band, from: f64, to: f64) -> Option<[f64; 2]> {
        let (mut u, mut v) = (from, to);
        let (y0, y1) = (line.at(from), line.at(to));
        for (d0, d1) in [
            (y0 - band.lower.at(from), y1 - band.lower.at(to)),
            (band.upper.at(from) - y0, band.upper.at(to) - y1),
        ] {
            match (d0 < -self.touch, d1 < -self.touch) {
                (true, true) => return None,
                (false, false) => {}
                // On the border at one end, outside at the other.
                (true, false) if d1 <= self.touch => return None,
                (false, true) if d0 <= self.touch => return None,
                (true, false) => u = u.max(from + (to - from) * (d0 / (d0 - d1))),
                (false, true) => v = v.min(from + (to - from) * (d0 / (d0 - d1))),
            }
        }
        (v - u > self.column).then_some([u, v])
    }

    /// Finds the covered parts of an upright segment: those where the surface covers either side of it, because the
    /// surface in front of it goes through its column.
    fn hidden_upright(&self, p: DVec2, q: DVec2, hidden: &mut Vec<[f64; 2]>) {
        if p.y == q.y {
            return;
        }
        let share = |y: f64| ((y - p.y) / (q.y - p.y)).clamp(0.0, 1.0);
        let bucket = self.bucket(p.x);
        for bucket in bucket.saturating_sub(1)..=bucket {
            let strips = &self.buckets[bucket];
            let first = strips.partition_point(|s| s.to < p.x);
            for strip in strips[first..].iter().take_while(|s| s.from <= p.x) {
                for band in strip.bands() {
                    let (lower, upper) = (band.lower.at(p.x), band.upper.at(p.x));
                    let (s, t) = (share(lower), share(upper));
                    let (s, t) = if s < t { (s, t) } else { (t, s) };
                    if upper - lower > self.touch && t > s {
                        hidden.push([s, t]);
                    }
                }
            }
        }
    }
}

/// Up to eight segments of one border of a polygon.
#[derive(Debug, Clone, Copy, Default)]
struct Vec2Chain {
    segments: [Option<Segment>; 8],
    count: usize,
}

impl Vec2Chain {
    fn push(&mut self, segment: Segment) {
        if let Some(place) = self.segments.get_mut(self.count) {
            *place = Some(segment);
            self.count += 1;
        }
    }

    fn get(&self, i: usize) -> Option<Segment> {
        self.segments.get(i).copied().flatten()
    }

    fn sort(&mut self) {
        let key = |s: &Option<Segment>| s.map_or(f64::INFINITY, |s| s.a.x);
        self.segments[..self.count].sort_by(|s, t| key(s).total_cmp(&key(t)));
    }
}

/// Joins ranges that touch, in place.
fn join(ranges: &mut Vec<[f64; 2]>) {
    /// Parts of a segment shorter than this are rounding between two strips.
    const GAP: f64 = 1e-9;
    ranges.compact_sort_by(|a, b| a[0].total_cmp(&b[0]));
    let mut kept = 0;
    for i in 0..ranges.len() {
        let [from, to] = ranges[i];
        if kept > 0 && from <= ranges[kept - 1][1] + GAP {
            ranges[kept - 1][1] = ranges[kept - 1][1].max(to);
        } else {
            ranges[kept] = [from, to];
            kept += 1;
        }
    }
    ranges.truncate(kept);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(x: f64, y: f64) -> DVec2 {
        DVec2::new(x, y)
    }

    fn horizon() -> Horizon {
        Horizon::new(at(0.0, 0.0), at(8.0, 8.0), 4)
    }

    fn hidden(h: &Horizon, p: DVec2, q: DVec2) -> Vec<[f64; 2]> {
        let mut out = Vec::new();
        h.hidden(p, q, &mut out);
        out
    }

    #[test]
    fn a_line_is_cut_where_it_crosses_either_horizon() {
        let mut h = horizon();
        h.cover(&[at(1.0, 2.0), at(7.0, 2.0), at(7.0, 4.0), at(1.0, 4.0)]);
        assert_eq!(hidden(&h, at(0.0, 3.0), at(8.0, 3.0)), [[0.125, 0.875]]);
        assert_eq!(hidden(&h, at(2.0, 0.0), at(6.0, 8.0)), [[0.25, 0.5]]);
        assert_eq!(hidden(&h, at(6.0, 8.0), at(2.0, 0.0)), [[0.5, 0.75]]);
        assert_eq!(hidden(&h, at(3.0, 0.0), at(3.0, 8.0)), [[0.25, 0.5]]);
        // Along the border, on an existing line.
        assert_eq!(hidden(&h, at(2.0, 4.0), at(3.0, 4.0)), [[0.0, 1.0]]);
        // From a point of the border outwards.
        assert_eq!(hidden(&h, at(2.0, 4.0), at(3.0, 4.001)), [] as [[f64; 2]; 0]);
    }

    #[test]
    fn pieces_apart_stay_apart_until_something_joins_them() {
        let mut h = horizon();
        h.cover(&[at(0.0, 1.0), at(8.0, 1.0), at(8.0, 2.0), at(0.0, 2.0)]);
        h.cover(&[at(0.0, 5.0), at(8.0, 5.0), at(8.0, 6.0), at(0.0, 6.0)]);
        assert_eq!(hidden(&h, at(4.0, 0.0), at(4.0, 8.0)), [[0.125, 0.25], [0.625, 0.75]]);
        h.cover(&[at(3.0, 1.5), at(5.0, 1.5), at(5.0, 5.5), at(3.0, 5.5)]);
        assert_eq!(hidden(&h, at(4.0, 0.0), at(4.0, 8.0)), [[0.125, 0.75]]);
        assert_eq!(hidden(&h, at(0.0, 3.0), at(8.0, 3.0)), [[0.375, 0.625]]);
    }

    #[test]
    fn strips_that_are_one_are_one() {
        let mut h = horizon();
        h.cover(&[at(0.0, 0.0), at(2.0, 0.0), at(1.0, 2.0)]);
        h.cover(&[at(0.5, 0.5), at(1.5, 0.5), at(1.0, 1.0)]);
        assert_eq!(h.buckets.iter().map(Vec::len).sum::<usize>(), 2);
    }
}
