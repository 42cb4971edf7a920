//! The turns of a polyline: its corners, and the parts that approximate round curves.

use super::Options;
use crate::math::DVec2;
use std::f64::consts::PI;

/// Larger turns are corners.
const CORNER: f64 = PI / 6.0 + 1e-3;

/// Largest ratio of angles that count as similar: where a line continues as an arc, the first turn is half of the
/// others, and arcs seen at an angle turn unevenly.
const LIKE: f64 = 3.2;

/// Ratio to the turns of its neighbours below which a turn may be a fold.
const LITTLE: f64 = 0.5;

/// A chord is not longer than this many times both of those beside it.
const LENGTHS: f64 = 2.5;

/// Number of consecutive turns from which a part counts as round.
const TURNS: usize = 5;

/// Factor on the sagitta implied by the turns, up to which the curve may leave a chord of a round part.
const MORE: f64 = 1.1;

/// A polyline with data about its turns.
pub(super) struct Bends {
    /// The points; a closed polyline repeats the first one at the end.
    pub points: Vec<DVec2>,
    pub closed: bool,
    /// Length of the polyline up to each point.
    pub along: Vec<f64>,
    /// Angle by which the polyline turns at each point, in radians; 0 at open ends.
    pub turns: Vec<f64>,
    /// Largest distance of the curve from each chord.
    pub allowed: Vec<f64>,
    /// True if a point is a fold; empty if none is.
    pub folds: Vec<bool>,
    /// Points at which pieces have to end, with the first and the last point.
    pub breaks: Vec<usize>,
    pub tolerance: f64,
    /// Index of the first point in the input.
    shift: usize,
}

impl Bends {
    pub fn new(
        given: &[DVec2],
        closed: bool,
        kept: &[bool],
        met: &dyn Fn(usize) -> bool,
        options: Options,
    ) -> Self {
        let mut points = given.to_vec();
        points.extend(given.first().filter(|_| closed));
        let turns = turns(&points, closed);
        let chords: Vec<f64> = points.windows(2).map(|w| w[0].distance(w[1])).collect();
        let mut along = vec![0.0; points.len()];
        for (i, chord) in chords.iter().enumerate() {
            along[i + 1] = along[i] + chord;
        }
        let tolerance = options.tolerance;
        let mut allowed = vec![tolerance; chords.len()];
        let mut folds = Vec::new();
        if options.round {
            folds = self::folds(&turns, closed, kept);
            let less = Less::new(&points, closed, &folds);
            less.allow(&mut allowed, met);
        }
        let last = points.len() - 1;
        let is_break = |i: &usize| {
            let inner = closed || (*i > 0 && *i < last);
            !inner && !closed
                || kept.get(*i).copied().unwrap_or(false)
                || is_corner(*i, &turns, &chords, &allowed, tolerance)
        };
        let count = if closed { last } else { last + 1 };
        let breaks = (0..count).filter(is_break).collect();
        Self { points, closed, along, turns, allowed, folds, breaks, tolerance, shift: 0 }
    }

    /// Returns how many points there are without the repeated one.
    pub fn count(&self) -> usize {
        self.points.len() - usize::from(self.closed)
    }

    /// Returns the index of a point in the input.
    pub fn original(&self, i: usize) -> usize {
        (i + self.shift) % self.count()
    }

    /// Begins a closed polyline at its first break or, if it has none, at the end of its longest chord, preferably one
    /// that the curve may not leave: there a line between arcs ends.
    pub fn started(self) -> Self {
        if !self.closed {
            return self;
        }
        let count = self.count();
        let chord = |i: &usize| self.along[*i + 1] - self.along[*i];
        let stays = |i: &usize| self.allowed[*i] <= self.tolerance;
        let longest = (0..count).max_by(|a, b| {
            stays(a).cmp(&stays(b)).then(chord(a).total_cmp(&chord(b))).then(b.cmp(a))
        });
        // A loop that starts in a fold would end in it.
        let after = |i: usize| (i + 1..=i + count).map(|k| k % count).find(|i| !self.is_fold(*i));
        let first = self.breaks.first().copied().or_else(|| longest.and_then(after));
        self.from(first.unwrap_or(0))
    }

    /// Returns the same closed polyline from one of its points on, which is a break then.
    pub fn from(&self, first: usize) -> Self {
        let count = self.count();
        let place = |i: usize| (i + first) % count;
        let chord = |i: usize| self.along[place(i) + 1] - self.along[place(i)];
        let mut along = vec![0.0; count + 1];
        for i in 0..count {
            along[i + 1] = along[i] + chord(i);
        }
        let breaks = self.breaks.iter().map(|i| (i + count - first) % count).filter(|i| *i > 0);
        let mut breaks: Vec<usize> = breaks.chain([0, count]).collect();
        breaks.sort_unstable();
        let folds = 0..if self.folds.is_empty() { 0 } else { count + 1 };
        Self {
            points: (0..=count).map(|i| self.points[place(i)]).collect(),
            closed: true,
            along,
            turns: (0..=count).map(|i| self.turns[place(i)]).collect(),
            allowed: (0..count).map(|i| self.allowed[place(i)]).collect(),
            folds: folds.map(|i| self.is_fold(place(i))).collect(),
            breaks,
            tolerance: self.tolerance,
            shift: first,
        }
    }

    /// Returns whether a point is a fold.
    pub fn is_fold(&self, i: usize) -> bool {
        self.folds.get(i).copied().unwrap_or(false)
    }

    /// Returns the sum of the turns at the points between two.
    pub fn turned(&self, from: usize, to: usize) -> f64 {
        self.turns.get(from + 1..to).unwrap_or_default().iter().sum()
    }
}

fn turns(points: &[DVec2], closed: bool) -> Vec<f64> {
    let last = points.len() - 1;
    let turn = |i: usize| {
        let (before, after) = match (i, closed) {
            (0, true) => (points[last - 1], points[1]),
            (_, true) if i == last => (points[last - 1], points[1]),
            (0, false) => return 0.0,
            _ if i == last => return 0.0,
            _ => (points[i - 1], points[i + 1]),
        };
        let (come, go) = (points[i] - before, after - points[i]);
        libm::atan2(come.perp_dot(go), come.dot(go))
    };
    (0..=last).map(turn).collect()
}

/// Returns the turns at both ends of a chord; where one is a corner or an open end, the other one
/// twice.
fn both(turns: &[f64], i: usize) -> Option<[f64; 2]> {
    let is_turn = |t: f64| t != 0.0 && t.abs() <= CORNER;
    match (turns[i], turns[i + 1]) {
        (a, b) if is_turn(a) && is_turn(b) => Some([a, b]),
        (a, b) if is_turn(a) && b.abs() != 0.0 || is_turn(a) && i + 2 == turns.len() => {
            Some([a; 2])
        }
        (a, b) if is_turn(b) && a.abs() != 0.0 || is_turn(b) && i == 0 => Some([b; 2]),
        _ => None,
    }
}

/// Returns for each chord whether it is one of many that turn the same way by similar angles.
fn regular(turns: &[f64], chords: &[f64], closed: bool) -> Vec<bool> {
    let count = chords.len();
    let is_like = |i: usize| {
        let Some([a, b]) = both(turns, i) else { return false };
        let before = if i > 0 {
            chords[i - 1]
        } else if closed {
            chords[count - 1]
        } else {
            0.0
        };
        let after = chords.get(i + 1).copied().unwrap_or(if closed { chords[0] } else { 0.0 });
        let (low, high) = (a.abs().min(b.abs()), a.abs().max(b.abs()));
        a * b > 0.0 && high <= low * LIKE && chords[i] <= before.max(after) * LENGTHS
    };
    let mut regular: Vec<bool> = (0..count).map(is_like).collect();
    // A closed polyline is walked from if it is not regular.
    let start = if closed { regular.iter().position(|r| !r).map_or(0, |i| i + 1) } else { 0 };
    let mut run: Vec<usize> = Vec::new();
    for k in 0..=count {
        let i = (start + k) % count;
        let goes_on = k < count && regular[i];
        if goes_on {
            run.push(i);
            continue;
        }
        let corner = |t: f64| usize::from(t != 0.0 && t.abs() <= CORNER);
        let inner = run.len().saturating_sub(1);
        let ends = match (run.first(), run.last()) {
            (Some(a), Some(b)) => corner(turns[*a]) + corner(turns[*b + 1]),
            _ => 0,
        };
        if inner + ends < TURNS {
            run.iter().for_each(|i| regular[*i] = false);
        }
        run.clear();
    }
    regular
}

/// Returns true for each point that is a fold; empty if there are none. Two round edges, one behind the other, whose
/// facets do not coincide appear as a polygon: some of its points are on the edges, others, the folds, where a chord of
/// one edge crosses a chord of the other. The polygon turns little at folds; they are not on the circle but inside it,
/// by less than the chords are.
fn folds(turns: &[f64], closed: bool, kept: &[bool]) -> Vec<bool> {
    let last = turns.len() - 1;
    let is_fold = |i: usize| {
        let (before, after) = match i {
            0 if closed => (last - 1, 1),
            i if closed && i == last => (last - 1, 1),
            0 => return false,
            i if i == last => return false,
            i => (i - 1, i + 1),
        };
        let [before, here, after] = [before, i, after].map(|i| turns[i]);
        let least = before.abs().min(after.abs()) * LITTLE;
        let is_kept = kept.get(i % last.max(1)).copied().unwrap_or(false);
        let high = before.abs().max(after.abs());
        !is_kept
            && high <= CORNER
            && before * here > 0.0
            && here * after > 0.0
            && here.abs() < least
    };
    let folds: Vec<bool> = (0..=last).map(is_fold).collect();
    if folds.iter().any(|f| *f) { folds } else { Vec::new() }
}

/// A polyline without its folds.
struct Less {
    /// The indices of the points.
    points: Vec<usize>,
    /// Number of chords of the whole polyline.
    count: usize,
    turns: Vec<f64>,
    chords: Vec<f64>,
    closed: bool,
}

impl Less {
    /// Creates a polyline without its folds; `points` of a closed one end with the first again.
    fn new(points: &[DVec2], closed: bool, folds: &[bool]) -> Self {
        let count = points.len() - 1;
        let is_fold = |i: usize| folds.get(i).copied().unwrap_or(false);
        let all = if closed { count } else { count + 1 };
        let mut left: Vec<usize> = (0..all).filter(|i| !is_fold(*i)).collect();
        if closed && let Some(first) = left.first() {
            left.push(first + count);
        }
        let place = |i: &usize| points[if closed { i % count } else { *i }];
        let places: Vec<DVec2> = left.iter().map(place).collect();
        let chords = places.windows(2).map(|w| w[0].distance(w[1])).collect();
        Self { turns: turns(&places, closed), points: left, count, chords, closed }
    }

    /// Allows the curve to leave chords as an arc does, where the polyline turns regularly and nothing ends on the
    /// chord.
    fn allow(&self, allowed: &mut [f64], met: &dyn Fn(usize) -> bool) {
        let regular = regular(&self.turns, &self.chords, self.closed);
        for (k, _) in regular.iter().enumerate().filter(|(_, r)| **r) {
            let rise = sagitta(&self.turns, &self.chords, k);
            let parts = || (self.points[k]..self.points[k + 1]).map(|i| i % self.count);
            if parts().any(|i| rise > allowed[i] * 0.5 && met(i)) {
                continue;
            }
            parts().for_each(|i| allowed[i] += rise);
        }
    }
}

/// Returns the sagitta of an arc that turns like the polyline over a chord.
fn sagitta(turns: &[f64], chords: &[f64], i: usize) -> f64 {
    let turn = both(turns, i).map_or(0.0, |[a, b]| a.abs().max(b.abs()));
    chords[i] * 0.5 * libm::tan(turn * 0.25) * MORE
}

/// Returns whether no curve within the tolerance goes through a point without a corner.
fn is_corner(i: usize, turns: &[f64], chords: &[f64], allowed: &[f64], tolerance: f64) -> bool {
    let turn = turns[i].abs();
    if turn > CORNER {
        return true;
    }
    let count = chords.len();
    let (before, after) = ((i + count - 1) % count, i % count);
    let rise = |chord: usize| chords[chord] * turn * 0.125;
    rise(before) > 2.0 * allowed[before] && rise(after) > 2.0 * allowed[after].max(tolerance)
}
