//! Sub-paths of SVG's shapes, and the geometry that they are.

use super::attributes::{Matrix, Scanner, apply};
use crate::arc::{Arc, Ends};
use crate::geo::{Geometry, Points};
use durer::math::DVec2;
use std::f64::consts::FRAC_PI_2;

/// Edges that a curve, or a quarter of an ellipse, becomes.
pub const STEPS: u32 = 16;

/// Largest number of positions of a path, including those of flattened curves, which a short text can make numerous.
const MAX_POSITIONS: usize = 1 << 24;

/// Sub-paths in the element's coordinates, each open or closed.
#[derive(Debug, Default)]
pub struct Path {
    done: Vec<(Vec<DVec2>, bool)>,
    open: Vec<DVec2>,
    /// Positions of all of them.
    count: usize,
    at: DVec2,
    /// The last control point, for smooth curves, and the degree of its curve.
    control: Option<(DVec2, u8)>,
}

impl Path {
    pub fn line_to(&mut self, p: DVec2) {
        self.open.push(p);
        self.count += 1;
        self.at = p;
        self.control = None;
    }

    fn end(&mut self) {
        let points = std::mem::take(&mut self.open);
        if points.len() > 1 {
            self.done.push((points, false));
        }
    }

    pub fn close(&mut self) {
        let points = std::mem::take(&mut self.open);
        self.at = points.first().copied().unwrap_or(self.at);
        self.control = None;
        self.done.push((points, true));
    }

    /// Runs the commands of the attribute `d`.
    pub fn run(&mut self, text: &str) -> Result<(), String> {
        let mut scanner = Scanner::new(text);
        let mut command = None;
        while !scanner.at_end() {
            if let Some(next) = scanner.letter() {
                command = Some(next);
            }
            let Some(letter) = command else { return Err("a path begins with M or m".to_owned()) };
            self.step(letter, &mut scanner)?;
            if self.count > MAX_POSITIONS {
                return Err(format!("a path has more than {MAX_POSITIONS} positions"));
            }
            // Further pairs of a move are lines; nothing can follow a Z without a letter.
            command = match letter {
                'M' => Some('L'),
                'm' => Some('l'),
                'Z' | 'z' => None,
                other => Some(other),
            };
        }
        self.end();
        Ok(())
    }

    fn step(&mut self, letter: char, s: &mut Scanner<'_>) -> Result<(), String> {
        let base = if letter.is_ascii_lowercase() { self.at } else { DVec2::ZERO };
        if self.open.is_empty() && !matches!(letter, 'M' | 'm' | 'Z' | 'z') {
            self.open.push(self.at);
        }
        let mirrored = |path: &Self, degree: u8| match path.control {
            Some((control, d)) if d == degree => path.at * 2.0 - control,
            _ => path.at,
        };
        match letter.to_ascii_uppercase() {
            'M' => {
                self.end();
                let p = base + s.pair()?;
                self.line_to(p);
            }
            'L' => {
                let p = base + s.pair()?;
                self.line_to(p);
            }
            'H' => {
                let p = DVec2::new(base.x + s.need()?, self.at.y);
                self.line_to(p);
            }
            'V' => {
                let p = DVec2::new(self.at.x, base.y + s.need()?);
                self.line_to(p);
            }
            'C' => {
                let points = [base + s.pair()?, base + s.pair()?, base + s.pair()?];
                self.curve(points, points[1], 3);
            }
            'S' => {
                let points = [mirrored(self, 3), base + s.pair()?, base + s.pair()?];
                self.curve(points, points[1], 3);
            }
            'Q' | 'T' => {
                let control = if letter.eq_ignore_ascii_case(&'Q') {
                    base + s.pair()?
                } else {
                    mirrored(self, 2)
                };
                let end = base + s.pair()?;
                let raise = |p: DVec2| p + (control - p) * (2.0 / 3.0);
                self.curve([raise(self.at), raise(end), end], control, 2);
            }
            'Z' => self.close(),
            'A' => {
                let (radii, turned) = (s.pair()?, s.need()?.to_radians());
                let (large, sweep) = (s.flag()?, s.flag()?);
                let to = base + s.pair()?;
                self.arc(&Ends { from: self.at, to, radii, turned, large, sweep });
            }
            _ => return Err(format!("`{letter}` is not a command of a path")),
        }
        Ok(())
    }

    /// Adds a cubic Bézier curve from the current point.
    fn curve(&mut self, [p1, p2, p3]: [DVec2; 3], control: DVec2, degree: u8) {
        let p0 = self.at;
        for i in 1..=STEPS {
            let t = f64::from(i) / f64::from(STEPS);
            let u = 1.0 - t;
            let p = p0 * (u * u * u)
                + p1 * (3.0 * u * u * t)
                + p2 * (3.0 * u * t * t)
                + p3 * (t * t * t);
            self.line_to(if i == STEPS { p3 } else { p });
        }
        self.control = Some((control, degree));
    }

    /// Adds an elliptical arc.
    fn arc(&mut self, ends: &Ends) {
        if let Some(arc) = Arc::new(ends) {
            // A hair less, so that rounding adds no edge to a quarter turn.
            let edges = libm::ceil(arc.turn.abs() / FRAC_PI_2 * f64::from(STEPS) - 1e-6);
            let edges = edges.clamp(1.0, f64::from(4 * STEPS)) as u32;
            for i in 1..edges {
                let angle = arc.start + arc.turn * f64::from(i) / f64::from(edges);
                let (sin, cos) = libm::sincos(angle);
                self.line_to(arc.center + arc.seen(DVec2::new(cos, sin)));
            }
        }
        self.line_to(ends.to);
    }

    /// Adds an ellipse with its axes along the coordinates'; none if a radius is not above zero.
    pub fn ellipse(&mut self, center: DVec2, radii: DVec2) {
        if radii.cmpgt(DVec2::ZERO).all() {
            (0..4 * STEPS).for_each(|i| self.line_to(center + on_circle(i) * radii));
            self.close();
        }
    }

    /// Adds a rectangle, with corners as round as its sides allow.
    pub fn rectangle(&mut self, corner: DVec2, size: DVec2, radii: DVec2) {
        if !size.cmpgt(DVec2::ZERO).all() {
            return;
        }
        let radii = radii.max(DVec2::ZERO).min(size * 0.5);
        let round = radii.min_element() > 0.0;
        let radii = if round { radii } else { DVec2::ZERO };
        let (low, high) = (corner + radii, corner + size - radii);
        let centers = [high, DVec2::new(low.x, high.y), low, DVec2::new(high.x, low.y)];
        for (center, quarter) in centers.into_iter().zip(0..) {
            let last = if round { STEPS } else { 0 };
            for i in 0..=last {
                self.line_to(center + on_circle(quarter * STEPS + i) * radii);
            }
        }
        self.close();
    }

    pub fn geometry(mut self, matrix: &Matrix) -> Result<Option<Geometry>, String> {
        self.end();
        let (mut rings, mut lines, mut dots) = (Vec::new(), Vec::new(), Points::default());
        for (points, closed) in &self.done {
            let mut xy: Vec<DVec2> = points.iter().map(|&p| apply(matrix, p)).collect();
            if xy.iter().any(|p| !p.is_finite()) {
                return Err("a coordinate is not finite".to_owned());
            }
            if *closed && xy.len() > 1 && xy.first() == xy.last() {
                xy.pop();
            }
            match (closed, xy.len()) {
                (true, 3..) => rings.push(vec![Points::flat(xy)]),
                // A point is drawn as a line without length, with round ends.
                (false, 2..) if xy.iter().all(|p| *p == xy[0]) => dots.push(xy[0], [0.0; 2]),
                (false, 2..) => lines.push(Points::flat(xy)),
                _ => {}
            }
        }
        let area = match rings.len() {
            0 => None,
            1 => rings.pop().map(Geometry::Polygon),
            _ => Some(Geometry::MultiPolygon(rings)),
        };
        let line = match lines.len() {
            0 => None,
            1 => lines.pop().map(Geometry::LineString),
            _ => Some(Geometry::MultiLineString(lines)),
        };
        let dot = match dots.len() {
            0 => None,
            1 => Some(Geometry::Point(dots)),
            _ => Some(Geometry::MultiPoint(dots)),
        };
        let mut parts: Vec<Geometry> = [area, line, dot].into_iter().flatten().collect();
        Ok(if parts.len() > 1 { Some(Geometry::Collection(parts)) } else { parts.pop() })
    }
}

/// Returns point i of a unit circle of 4 · [`STEPS`] points; quarters are alike to the bit.
fn on_circle(i: u32) -> DVec2 {
    let step = i % STEPS;
    let (sin, cos) = libm::sincos(FRAC_PI_2 * f64::from(step) / f64::from(STEPS));
    let point = if step == 0 { DVec2::X } else { DVec2::new(cos, sin) };
    (0..i / STEPS % 4).fold(point, |p, _| p.perp())
}
