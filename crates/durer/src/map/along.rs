//! Labels that run along a line: their positions and directions.

use crate::curve::text::place_along;
use crate::math::DVec2;

/// Places on a line are examined in steps of this share of the letters' size.
const STEP: f64 = 0.5;

/// A line is smoothed over this many steps to both sides: letters do not follow each bend of a river.
const SMOOTHED: usize = 3;

/// Angle by which a line may turn between letters as far apart as they are large, in radians.
const BEND: f64 = 0.6;

/// Number of positions to try.
const TRIED: usize = 24;

/// A label's course along a line.
#[derive(Debug, Clone, PartialEq)]
pub struct Run {
    /// The line, from the label's beginning to its end.
    pub line: Vec<DVec2>,
    /// Distance along the line at which the label begins, in pixels.
    pub start: f64,
}

impl Run {
    /// Returns the point at this distance from the label's beginning.
    pub fn place(&self, along: f64) -> Option<DVec2> {
        place_along(&self.line, self.start + along).map(|place| place.0)
    }
}

/// Returns the positions of a label of this length and size of letters along a line: those near its middle first, none
/// if it bends too much. Labels run from the left to the right.
pub fn runs(line: &[DVec2], length: f64, size: f64) -> Vec<Run> {
    let step = STEP * size;
    let whole: f64 = line.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
    if !(step > 0.0 && whole.is_finite() && whole >= length + size) {
        return Vec::new();
    }
    let line = smoothed(&resampled(line, whole, step));
    let whole: f64 = line.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
    let room = whole - length;
    if room < 0.0 {
        return Vec::new();
    }
    let shift = room / TRIED as f64;
    let starts = (0..=TRIED).map(|i| {
        // 0, −1, 1, −2, 2 … steps from the middle.
        let steps = i.div_ceil(2) as f64;
        room * 0.5 + if i % 2 == 0 { steps } else { -steps } * shift
    });
    let starts = starts.filter(|start| bend(&line, *start, length, size) <= BEND);
    starts.filter_map(|start| upright(&line, start, length, whole)).collect()
}

/// Returns points at equal steps along a line.
fn resampled(line: &[DVec2], whole: f64, step: f64) -> Vec<DVec2> {
    let count = (whole / step).ceil().clamp(1.0, 65_536.0) as usize;
    let at = |i: usize| place_along(line, whole * i as f64 / count as f64).map(|place| place.0);
    (0..=count).filter_map(at).collect()
}

/// Returns the means of points and their neighbours; the ends stay where they are.
fn smoothed(line: &[DVec2]) -> Vec<DVec2> {
    let mean = |i: usize| {
        let reach = SMOOTHED.min(i).min(line.len() - 1 - i);
        let around = &line[i - reach..=i + reach];
        around.iter().sum::<DVec2>() / around.len() as f64
    };
    (0..line.len()).map(mean).collect()
}

/// Returns the largest turn of a line over the size of a letter, from a start on over a length, in radians.
fn bend(line: &[DVec2], start: f64, length: f64, size: f64) -> f64 {
    let count = (length / size).ceil().max(1.0) as usize;
    let direction = |i: usize| place_along(line, start + length * i as f64 / count as f64);
    let directions: Vec<DVec2> = (0..=count).filter_map(|i| Some(direction(i)?.1)).collect();
    let turns = directions.windows(2).map(|pair| pair[0].angle_to(pair[1]).abs());
    turns.fold(0.0, f64::max)
}

/// Returns a label from left to right.
fn upright(line: &[DVec2], start: f64, length: f64, whole: f64) -> Option<Run> {
    let (from, to) = (place_along(line, start)?.0, place_along(line, start + length)?.0);
    if from.x <= to.x {
        return Some(Run { line: line.to_vec(), start });
    }
    let back = line.iter().rev().copied().collect();
    Some(Run { line: back, start: whole - start - length })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_run_in_the_middle_and_from_left_to_right() {
        let line = [DVec2::new(100.0, 40.0), DVec2::new(0.0, 40.0)];
        let runs = runs(&line, 20.0, 10.0);
        let first = &runs[0];
        let places = [first.place(0.0).unwrap(), first.place(20.0).unwrap()];
        let off = |p: DVec2, x: f64| p.distance(DVec2::new(x, 40.0));
        assert!(off(places[0], 40.0) < 1e-9 && off(places[1], 60.0) < 1e-9, "{places:?}");
        assert_eq!(runs.len(), TRIED + 1);
    }

    #[test]
    fn lines_that_are_short_or_turn_sharply_have_no_room() {
        let corner = [(0.0, 0.0), (60.0, 0.0), (60.0, 60.0)].map(|(x, y)| DVec2::new(x, y));
        assert!(runs(&corner[..2], 55.0, 10.0).is_empty());
        let around = runs(&corner, 100.0, 4.0);
        assert!(around.is_empty(), "{around:?}");
        let beside = runs(&corner, 30.0, 4.0);
        assert!(!beside.is_empty());
    }
}
