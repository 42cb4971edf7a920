//! Evenly spaced streamlines: lines along a field of directions, nowhere nearer to each other than the field says.
//!
//! Bruno Jobard, Wilfrid Lefer, "Creating evenly-spaced streamlines of arbitrary density", Visualization in Scientific
//! Computing 1997. New lines begin beside lines that exist, at the distance that lines should have there, and grow in
//! both directions until the field ends or another line is too near; if no place beside a line is left, the given seeds
//! are tried in turn. Here the distance may differ from place to place. O(n) for n points of lines, where distances are
//! alike.

use crate::math::DVec2;
use std::collections::VecDeque;

/// Directions in the plane, and how far apart lines along them should be.
pub trait Field {
    /// Returns the direction at a point, of unit length; its sign does not matter. `None` if the field has
    /// none: lines end.
    fn direction(&self, p: DVec2) -> Option<DVec2>;

    /// Returns the distance that lines should have at a point, above 0. `None` if there should be
    /// none.
    fn separation(&self, p: DVec2) -> Option<f64>;

    /// Returns whether a line may go from one point to another, a step away.
    fn joins(&self, from: DVec2, to: DVec2) -> bool;
}

/// The settings of [`streamlines`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// Distance between points of a line, above 0; in the units of the plane.
    pub step: f64,
    /// Distance to another line at which a line ends, as a part of the separation; 0 … 1.
    pub closest: f64,
    /// Lines shorter than this are left out.
    pub shortest: f64,
}

/// A line along the field.
#[derive(Debug, Clone, PartialEq)]
pub struct Streamline {
    /// Its points, a step apart.
    pub points: Vec<DVec2>,
    /// True if its last point is joined to the first.
    pub closed: bool,
}

/// Points of one line at most.
const MOST_POINTS: i32 = 100_000;

/// Space that a new line needs on both sides, as a part of the separation: with all of it, gaps up to twice as
/// wide would remain.
const ROOM: f64 = 0.75;

/// A line ends where it would turn by more than 60° in a step.
const SHARPEST_TURN: f64 = 0.5;

/// Traces streamlines over the rectangle from the origin to `size`, which has to be finite.
///
/// Nothing where the step is not a number above 0.
pub fn streamlines(
    field: &impl Field,
    size: DVec2,
    seeds: impl IntoIterator<Item = DVec2>,
    options: &Options,
) -> Vec<Streamline> {
    if !(size.is_finite() && size.min_element() > 0.0 && options.step > 0.0) {
        return Vec::new();
    }
    let mut tracing = Tracing {
        field,
        options,
        size,
        placed: Placed::new(size, options.step),
        lines: Vec::new(),
    };
    let mut beside = VecDeque::new();
    for seed in seeds {
        tracing.try_seed(seed, &mut beside);
        while let Some(line) = beside.pop_front() {
            for seed in tracing.places_beside(line) {
                tracing.try_seed(seed, &mut beside);
            }
        }
    }
    tracing.lines
}

struct Tracing<'a, F> {
    field: &'a F,
    options: &'a Options,
    size: DVec2,
    placed: Placed,
    lines: Vec<Streamline>,
}

impl<F: Field> Tracing<'_, F> {
    /// Traces the line through a seed, unless another is too near.
    fn try_seed(&mut self, seed: DVec2, new: &mut VecDeque<usize>) {
        let Some(separation) = self.separation(seed) else { return };
        if self.placed.any(seed, separation * ROOM, |_| true) {
            return;
        }
        let Some(direction) = self.field.direction(seed) else { return };
        let own = self.lines.len() as u32;
        self.placed.insert(Point { at: seed, line: own, number: 0 });
        let (mut points, closed) = self.grow(seed, direction, 1);
        if !closed {
            let (mut other, _) = self.grow(seed, -direction, -1);
            other.reverse();
            other.push(seed);
            other.append(&mut points);
            points = other;
        } else {
            points.insert(0, seed);
        }
        let length = points.len().saturating_sub(1) as f64 * self.options.step;
        if length < self.options.shortest {
            self.placed.remove(own, &points);
            return;
        }
        new.push_back(self.lines.len());
        self.lines.push(Streamline { points, closed });
    }

    fn separation(&self, p: DVec2) -> Option<f64> {
        let inside = p.cmpge(DVec2::ZERO).all() && p.cmplt(self.size).all();
        if inside { self.field.separation(p).filter(|s| *s > 0.0) } else { None }
    }

    /// Returns the points that follow a seed to one side, numbered by 1 or −1, and whether they come
    /// back to it.
    fn grow(&mut self, seed: DVec2, start: DVec2, sign: i32) -> (Vec<DVec2>, bool) {
        let own = self.lines.len() as u32;
        let mut points = Vec::new();
        let (mut at, mut heading) = (seed, start);
        while (points.len() as i32) < MOST_POINTS {
            let Some((next, direction)) = self.next(at, heading) else { break };
            let Some(separation) = self.separation(next) else { break };
            let number = sign * (points.len() as i32 + 1);
            let own_reach = (2.0 * separation / self.options.step) as i32 + 2;
            if number > own_reach
                && returns(next, direction, seed, start, separation, self.options.step)
            {
                points.push(next);
                return (points, true);
            }
            let others = |p: &Point| p.line != own || (p.number - number).abs() > own_reach;
            if self.placed.any(next, separation * self.options.closest, others) {
                break;
            }
            self.placed.insert(Point { at: next, line: own, number });
            points.push(next);
            (at, heading) = (next, direction);
        }
        (points, false)
    }

    /// Returns a step by the midpoint rule, and the heading there.
    fn next(&self, at: DVec2, heading: DVec2) -> Option<(DVec2, DVec2)> {
        let along = |p: DVec2| {
            let direction = self.field.direction(p)?;
            Some(if direction.dot(heading) < 0.0 { -direction } else { direction })
        };
        let middle = at + heading * (self.options.step * 0.5);
        let direction = along(middle).or_else(|| along(at))?;
        if direction.dot(heading) < SHARPEST_TURN {
            return None;
        }
        let next = at + direction * self.options.step;
        (next.is_finite() && self.field.joins(at, next)).then_some((next, direction))
    }

    /// Returns where new lines might begin beside a line, on both sides.
    fn places_beside(&self, line: usize) -> Vec<DVec2> {
        let points = self.lines.get(line).map_or(&[][..], |l| &l.points);
        let mut places = Vec::new();
        for (i, p) in points.iter().enumerate() {
            let around = points.get(i.saturating_sub(1)).zip(points.get(i + 1).or(Some(p)));
            let Some((before, after)) = around else { continue };
            let across = (*after - *before).perp().normalize_or_zero();
            let Some(separation) = self.separation(*p) else { continue };
            places.extend([*p + across * separation, *p - across * separation]);
        }
        places
    }
}

/// Returns whether a line that heads along `direction` is about to run into its own start.
fn returns(
    p: DVec2,
    direction: DVec2,
    seed: DVec2,
    start: DVec2,
    separation: f64,
    step: f64,
) -> bool {
    let to_seed = seed - p;
    let ahead = to_seed.dot(direction);
    ahead >= 0.0
        && ahead <= separation
        && to_seed.perp_dot(direction).abs() <= step
        && direction.dot(start) > 0.9
}

#[derive(Clone, Copy)]
struct Point {
    at: DVec2,
    line: u32,
    /// Number along its line, from the seed: negative on one side.
    number: i32,
}

/// Points of lines in square cells.
struct Placed {
    cell: f64,
    columns: usize,
    rows: usize,
    cells: Vec<Vec<Point>>,
}

/// Steps along the side of a cell.
const STEPS_OF_CELL: f64 = 8.0;

/// Cells along a side, at most.
const MOST_CELLS: f64 = 1024.0;

impl Placed {
    fn new(size: DVec2, step: f64) -> Self {
        let cell = (step * STEPS_OF_CELL).max(size.max_element() / MOST_CELLS);
        let count = |side: f64| (side / cell) as usize + 1;
        let (columns, rows) = (count(size.x), count(size.y));
        Self { cell, columns, rows, cells: vec![Vec::new(); columns * rows] }
    }

    /// Returns the cell of a place, or the nearest one if it is outside.
    fn cell(&self, p: DVec2) -> (usize, usize) {
        let place = |v: f64, count: usize| ((v / self.cell).max(0.0) as usize).min(count - 1);
        (place(p.x, self.columns), place(p.y, self.rows))
    }

    fn insert(&mut self, point: Point) {
        let (x, y) = self.cell(point.at);
        self.cells[y * self.columns + x].push(point);
    }

    fn remove(&mut self, line: u32, points: &[DVec2]) {
        for p in points {
            let (x, y) = self.cell(*p);
            self.cells[y * self.columns + x].retain(|p| p.line != line);
        }
    }

    /// Returns whether any of the points that count is nearer than `distance`.
    fn any(&self, p: DVec2, distance: f64, counts: impl Fn(&Point) -> bool) -> bool {
        let (low, high) = (self.cell(p - distance), self.cell(p + distance));
        (low.1..=high.1).any(|y| {
            let row = &self.cells[y * self.columns..][low.0..=high.0];
            let near = |q: &Point| q.at.distance_squared(p) < distance * distance;
            row.iter().flatten().any(|q| near(q) && counts(q))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns circles around a centre, `separation` apart.
    struct Circles {
        center: DVec2,
        separation: f64,
    }

    impl Field for Circles {
        fn direction(&self, p: DVec2) -> Option<DVec2> {
            (p - self.center).perp().try_normalize()
        }

        fn separation(&self, p: DVec2) -> Option<f64> {
            let radius = p.distance(self.center);
            (10.0..40.0).contains(&radius).then_some(self.separation)
        }

        fn joins(&self, _: DVec2, _: DVec2) -> bool {
            true
        }
    }

    const OPTIONS: Options = Options { step: 0.5, closest: 0.5, shortest: 3.0 };

    fn seeds() -> impl Iterator<Item = DVec2> {
        (0..100).flat_map(|y| (0..100).map(move |x| DVec2::new(f64::from(x), f64::from(y))))
    }

    #[test]
    fn lines_keep_their_distance_and_close() {
        let field = Circles { center: DVec2::splat(50.0), separation: 5.0 };
        let lines = streamlines(&field, DVec2::splat(100.0), seeds(), &OPTIONS);
        // Circles of the radii 10 to 40, five apart, or slightly less to fill a gap.
        assert!((6..=8).contains(&lines.len()), "{}", lines.len());
        assert!(lines.iter().all(|l| l.closed));
        let radius = |l: &Streamline| l.points[0].distance(field.center);
        for line in &lines {
            let drift = |p: &DVec2| (p.distance(field.center) - radius(line)).abs();
            assert!(line.points.iter().all(|p| drift(p) < 0.1), "a circle stays one");
        }
        for (i, a) in lines.iter().enumerate() {
            for b in &lines[i + 1..] {
                assert!((radius(a) - radius(b)).abs() > 3.7);
            }
        }
    }

    /// Horizontal lines that end at x = 30.
    struct Wall;

    impl Field for Wall {
        fn direction(&self, _: DVec2) -> Option<DVec2> {
            Some(DVec2::X)
        }

        fn separation(&self, p: DVec2) -> Option<f64> {
            Some(if p.y < 50.0 { 4.0 } else { 10.0 })
        }

        fn joins(&self, from: DVec2, to: DVec2) -> bool {
            (from.x < 30.0) == (to.x < 30.0)
        }
    }

    #[test]
    fn lines_end_where_the_field_does_not_join_and_are_closer_where_it_says() {
        let lines = streamlines(&Wall, DVec2::splat(100.0), seeds(), &OPTIONS);
        let side = |l: &Streamline| l.points.iter().filter(|p| p.x < 30.0).count();
        assert!(lines.iter().all(|l| side(l) == 0 || side(l) == l.points.len()));
        let left = |low: f64, high: f64| {
            let within = |l: &&Streamline| (low..high).contains(&l.points[0].y) && side(l) > 0;
            lines.iter().filter(within).count()
        };
        assert_eq!(left(0.0, 48.0), 12);
        assert_eq!(left(50.0, 100.0), 5);
    }

    #[test]
    fn what_is_no_number_gives_nothing() {
        let field = Circles { center: DVec2::splat(50.0), separation: 5.0 };
        let none = Options { step: f64::NAN, ..OPTIONS };
        assert!(streamlines(&field, DVec2::splat(100.0), seeds(), &none).is_empty());
        assert!(streamlines(&field, DVec2::splat(f64::INFINITY), seeds(), &OPTIONS).is_empty());
        let seeds = [DVec2::NAN, DVec2::splat(-1e300)];
        assert!(streamlines(&field, DVec2::splat(100.0), seeds, &OPTIONS).is_empty());
    }
}
