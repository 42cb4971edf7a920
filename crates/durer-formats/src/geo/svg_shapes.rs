//! The shapes of an SVG document as features.
//!
//! Read are `path`, `polygon`, `polyline`, `line`, `rect`, `circle` and `ellipse`, with the
//! `transform`s and `id`s on them and on the groups around them. Bézier curves become [`STEPS`] edges
//! each, arcs and round corners as many per quarter turn, with all corners on the curve. Closed parts become polygons,
//! open parts lines, and open parts without length points. Which points the closed parts of a path enclose
//! is told by `fill-rule`, as attribute or in `style`, on it or around it; non-zero where nothing is said.
//! Other styles, style sheets, `use`, text, clipping and nested documents are not looked at. Coordinates are
//! those of the document turned over, so that y is up, as [`super::svg`] writes them.

use super::{Feature, Geometry, Points, Warnings};
use crate::{Error, Place, Result};
use durer::clip::polygon::FillRule;
use durer::math::DVec2;
use quick_xml::events::{BytesStart, Event};
use std::f64::consts::{FRAC_PI_2, TAU};

/// Edges that a curve, or a quarter of an ellipse, becomes.
const STEPS: u32 = 16;

/// The matrix (a, b, c, d, e, f) of SVG: x' = a·x + c·y + e, y' = b·x + d·y + f.
type Matrix = [f64; 6];

const UPRIGHT: Matrix = [1.0, 0.0, 0.0, -1.0, 0.0, 0.0];

fn apply(m: &Matrix, p: DVec2) -> DVec2 {
    DVec2::new(m[0] * p.x + m[2] * p.y + m[4], m[1] * p.x + m[3] * p.y + m[5])
}

/// First `inner`, then `outer`.
fn compose(outer: &Matrix, inner: &Matrix) -> Matrix {
    let linear = [outer[0], outer[1], outer[2], outer[3], 0.0, 0.0];
    let x = apply(&linear, DVec2::new(inner[0], inner[1]));
    let y = apply(&linear, DVec2::new(inner[2], inner[3]));
    let o = apply(outer, DVec2::new(inner[4], inner[5]));
    [x.x, x.y, y.x, y.y, o.x, o.y]
}

/// Where an element's coordinates and name come from.
#[derive(Debug, Clone)]
struct Level {
    matrix: Matrix,
    id: Option<String>,
    fill_rule: FillRule,
}

/// Around the whole document.
const OUTERMOST: Level = Level { matrix: UPRIGHT, id: None, fill_rule: FillRule::NonZero };

/// Reads the shapes of a document.
pub fn read(text: &[u8], warnings: &mut Warnings) -> Result<Vec<Feature>> {
    let mut reader = quick_xml::Reader::from_reader(text);
    let mut levels = vec![OUTERMOST];
    let mut features = Vec::new();
    let mut seen_svg = false;
    loop {
        let at = reader.buffer_position();
        let place = || place(text, at);
        let fail = |message: String| Error::Decode { place: place(), message };
        match reader.read_event().map_err(|e| fail(e.to_string()))? {
            Event::Eof if seen_svg => return Ok(features),
            Event::Eof => return Err(fail("there is no svg element".to_owned())),
            event @ (Event::Start(_) | Event::Empty(_)) => {
                let (element, open) = match &event {
                    Event::Start(element) => (element, true),
                    Event::Empty(element) => (element, false),
                    _ => continue,
                };
                if levels.len() > super::MAX_DEPTH * 8 {
                    return Err(fail("elements are nested too deep".to_owned()));
                }
                seen_svg |= element.local_name().as_ref() == "svg";
                let level = enter(element, levels.last()).map_err(fail)?;
                match shape(element, &level) {
                    Ok(Some(geometry)) => features.push(Feature {
                        id: level
                            .id
                            .as_ref()
                            .map(|id| serde_json::Value::from(&id[..]).to_string()),
                        fill_rule: level.fill_rule,
                        ..Feature::of_geometry(geometry)
                    }),
                    Ok(None) => {}
                    Err(message) => {
                        warnings.push(place(), format!("{message}; the shape is left out"))
                    }
                }
                if open {
                    levels.push(level);
                }
            }
            Event::End(_) if levels.len() > 1 => drop(levels.pop()),
            _ => {}
        }
    }
}

fn place(text: &[u8], at: u64) -> Place {
    let before = text.get(..at as usize).unwrap_or(text);
    let line = before.iter().filter(|&&b| b == b'\n').count() as u64 + 1;
    let column = before.iter().rev().take_while(|&&b| b != b'\n').count() as u64 + 1;
    Place::Line(line, column)
}

fn attribute(element: &BytesStart<'_>, name: &str) -> Result<Option<String>, String> {
    let found = element.try_get_attribute(name).map_err(|e| e.to_string())?;
    let Some(found) = found else { return Ok(None) };
    quick_xml::escape::unescape(&found.value)
        .map(|t| Some(t.into_owned()))
        .map_err(|e| e.to_string())
}

fn enter(element: &BytesStart<'_>, outer: Option<&Level>) -> Result<Level, String> {
    let outer = outer.cloned().unwrap_or(OUTERMOST);
    let transform = attribute(element, "transform")?.unwrap_or_default();
    let matrix = compose(&outer.matrix, &transforms(&transform)?);
    let fill_rule = fill_rule(element)?.unwrap_or(outer.fill_rule);
    Ok(Level { matrix, id: attribute(element, "id")?.or(outer.id), fill_rule })
}

/// What an element says itself: its style before its attribute.
fn fill_rule(element: &BytesStart<'_>) -> Result<Option<FillRule>, String> {
    let style = attribute(element, "style")?.unwrap_or_default();
    let mut declarations = style.split(';').filter_map(|declaration| declaration.split_once(':'));
    let declared = declarations.rfind(|(name, _)| name.trim() == "fill-rule");
    let rule = |value: &str| match value.trim() {
        "evenodd" => Some(FillRule::EvenOdd),
        "nonzero" => Some(FillRule::NonZero),
        _ => None,
    };
    let by_attribute = attribute(element, "fill-rule")?;
    Ok(declared.and_then(|(_, value)| rule(value)).or(by_attribute.as_deref().and_then(rule)))
}

fn transforms(text: &str) -> Result<Matrix, String> {
    let mut all = [1.0, 0.0, 0.0, 1.0, 0.0, 0.0];
    for part in text.split(')').map(|p| p.trim_matches([' ', ',', '\n', '\t', '\r'])) {
        if part.is_empty() {
            continue;
        }
        let (name, numbers) = part.split_once('(').ok_or("a transform needs brackets")?;
        let numbers = Scanner::new(numbers).all()?;
        let matrix = match (name.trim(), &numbers[..]) {
            ("matrix", &[a, b, c, d, e, f]) => [a, b, c, d, e, f],
            ("translate", &[x]) => [1.0, 0.0, 0.0, 1.0, x, 0.0],
            ("translate", &[x, y]) => [1.0, 0.0, 0.0, 1.0, x, y],
            ("scale", &[s]) => [s, 0.0, 0.0, s, 0.0, 0.0],
            ("scale", &[x, y]) => [x, 0.0, 0.0, y, 0.0, 0.0],
            ("rotate", &[angle]) => rotation(angle, DVec2::ZERO),
            ("rotate", &[angle, x, y]) => rotation(angle, DVec2::new(x, y)),
            _ => {
                return Err(format!(
                    "the transform `{}` is not known",
                    crate::text::quote(part.as_bytes())
                ));
            }
        };
        all = compose(&all, &matrix);
    }
    Ok(all)
}

fn rotation(degrees: f64, center: DVec2) -> Matrix {
    let (sin, cos) = libm::sincos(degrees.to_radians());
    let (x, y) = (center.x, center.y);
    [cos, sin, -sin, cos, x - cos * x + sin * y, y - sin * x - cos * y]
}

/// The geometry of an element; `None` where it is no shape.
fn shape(element: &BytesStart<'_>, level: &Level) -> Result<Option<Geometry>, String> {
    let text = |name: &str| attribute(element, name).map(Option::unwrap_or_default);
    let number =
        |name: &str| Ok::<f64, String>(Scanner::new(&text(name)?).number()?.unwrap_or(0.0));
    let local = element.local_name();
    let mut path = Path::default();
    match local.as_ref() {
        "path" => path.run(&text("d")?)?,
        "polygon" | "polyline" => {
            let numbers = Scanner::new(&text("points")?).all()?;
            for pair in numbers.chunks_exact(2) {
                path.line_to(DVec2::new(pair[0], pair[1]));
            }
            if local.as_ref() == "polygon" {
                path.close();
            }
        }
        "line" => {
            path.line_to(DVec2::new(number("x1")?, number("y1")?));
            path.line_to(DVec2::new(number("x2")?, number("y2")?));
        }
        "rect" => {
            let size = DVec2::new(number("width")?, number("height")?);
            let radius = |name: &str| {
                let text = text(name)?;
                let given = !matches!(text.trim(), "" | "auto");
                Ok::<_, String>(if given { Scanner::new(&text).number()? } else { None })
            };
            let (rx, ry) = (radius("rx")?, radius("ry")?);
            let radii = DVec2::new(rx.or(ry).unwrap_or(0.0), ry.or(rx).unwrap_or(0.0));
            path.rectangle(DVec2::new(number("x")?, number("y")?), size, radii);
        }
        "circle" => {
            let center = DVec2::new(number("cx")?, number("cy")?);
            path.ellipse(center, DVec2::splat(number("r")?));
        }
        "ellipse" => {
            let center = DVec2::new(number("cx")?, number("cy")?);
            path.ellipse(center, DVec2::new(number("rx")?, number("ry")?));
        }
        "text" | "use" | "image" => {
            return Err(format!("`{}` of this kind is not read", local.as_ref()));
        }
        _ => return Ok(None),
    }
    path.geometry(&level.matrix)
}

/// Sub-paths in the element's coordinates, each open or closed.
#[derive(Debug, Default)]
struct Path {
    done: Vec<(Vec<DVec2>, bool)>,
    open: Vec<DVec2>,
    at: DVec2,
    /// The last control point, for smooth curves, and of what degree its curve was.
    control: Option<(DVec2, u8)>,
}

impl Path {
    fn line_to(&mut self, p: DVec2) {
        self.open.push(p);
        self.at = p;
        self.control = None;
    }

    fn end(&mut self) {
        let points = std::mem::take(&mut self.open);
        if points.len() > 1 {
            self.done.push((points, false));
        }
    }

    fn close(&mut self) {
        let points = std::mem::take(&mut self.open);
        self.at = points.first().copied().unwrap_or(self.at);
        self.control = None;
        self.done.push((points, true));
    }

    /// The commands of the attribute `d`.
    fn run(&mut self, text: &str) -> Result<(), String> {
        let mut scanner = Scanner::new(text);
        let mut command = None;
        while !scanner.at_end() {
            if let Some(next) = scanner.letter() {
                command = Some(next);
            }
            let Some(letter) = command else { return Err("a path begins with M or m".to_owned()) };
            self.step(letter, &mut scanner)?;
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
                let (radii, angle) = (s.pair()?, s.need()?);
                let (large, sweep) = (s.flag()?, s.flag()?);
                let end = base + s.pair()?;
                self.arc(radii, angle, large != sweep, sweep, end);
            }
            _ => return Err(format!("`{letter}` is no command of a path")),
        }
        Ok(())
    }

    /// A cubic Bézier curve from the current point.
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

    /// An elliptical arc from the current point, by the conversion of SVG 1.1, appendix F.6.5; `differ`
    /// tells whether its two flags, for the larger arc and for growing angles, are different.
    fn arc(&mut self, radii: DVec2, degrees: f64, differ: bool, sweep: bool, end: DVec2) {
        let (start, mut radii) = (self.at, radii.abs());
        if start == end || radii.min_element() == 0.0 {
            return self.line_to(end);
        }
        // In the space where the ellipse is a unit circle around c, the ends are at ±p.
        let (sin, cos) = libm::sincos(degrees.to_radians());
        let turned = |p: DVec2| DVec2::new(cos * p.x - sin * p.y, sin * p.x + cos * p.y);
        let half = (start - end) * 0.5;
        let mut p = DVec2::new(cos * half.x + sin * half.y, cos * half.y - sin * half.x) / radii;
        let reach = p.length();
        if reach > 1.0 {
            // Too small to reach: as much larger as needed.
            (radii, p) = (radii * reach, p / reach);
        }
        let distance = (1.0 / p.length_squared() - 1.0).max(0.0).sqrt();
        let c = DVec2::new(p.y, -p.x) * if differ { distance } else { -distance };
        let angle = |v: DVec2| libm::atan2(v.y, v.x);
        let from = angle(p - c);
        let mut turn = angle(-p - c) - from;
        match sweep {
            true if turn < 0.0 => turn += TAU,
            false if turn > 0.0 => turn -= TAU,
            _ => {}
        }
        // A hair less, so that rounding adds no edge to a quarter turn.
        let edges = libm::ceil(turn.abs() / FRAC_PI_2 * f64::from(STEPS) - 1e-6);
        let edges = edges.clamp(1.0, f64::from(4 * STEPS)) as u32;
        let center = start * 0.5 + end * 0.5 + turned(c * radii);
        for i in 1..edges {
            let (sin, cos) = libm::sincos(from + turn * f64::from(i) / f64::from(edges));
            self.line_to(center + turned(DVec2::new(cos, sin) * radii));
        }
        self.line_to(end);
    }

    /// An ellipse with its axes along the coordinates'; none where a radius is not above zero.
    fn ellipse(&mut self, center: DVec2, radii: DVec2) {
        if radii.cmpgt(DVec2::ZERO).all() {
            (0..4 * STEPS).for_each(|i| self.line_to(center + on_circle(i) * radii));
            self.close();
        }
    }

    /// A rectangle, with corners as round as its sides allow.
    fn rectangle(&mut self, corner: DVec2, size: DVec2, radii: DVec2) {
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

    fn geometry(mut self, matrix: &Matrix) -> Result<Option<Geometry>, String> {
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
                // How a point is drawn: a line without length, with round ends.
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

/// Point i of a unit circle of 4 · [`STEPS`]; quarters are alike to the bit.
fn on_circle(i: u32) -> DVec2 {
    let step = i % STEPS;
    let (sin, cos) = libm::sincos(FRAC_PI_2 * f64::from(step) / f64::from(STEPS));
    let point = if step == 0 { DVec2::X } else { DVec2::new(cos, sin) };
    (0..i / STEPS % 4).fold(point, |p, _| p.perp())
}

/// Numbers and letters, parted by blanks and commas or nothing.
struct Scanner<'a> {
    rest: &'a [u8],
}

impl<'a> Scanner<'a> {
    fn new(text: &'a str) -> Self {
        Self { rest: text.as_bytes() }
    }

    fn skip(&mut self) {
        while let [b' ' | b',' | b'\t' | b'\n' | b'\r', rest @ ..] = self.rest {
            self.rest = rest;
        }
    }

    fn at_end(&mut self) -> bool {
        self.skip();
        self.rest.is_empty()
    }

    fn letter(&mut self) -> Option<char> {
        self.skip();
        let (first, rest) = self.rest.split_first().filter(|(b, _)| b.is_ascii_alphabetic())?;
        self.rest = rest;
        Some(char::from(*first))
    }

    /// A number, or `None` at the end.
    fn number(&mut self) -> Result<Option<f64>, String> {
        if self.at_end() {
            return Ok(None);
        }
        let found = crate::number::float(self.rest).filter(|(value, _)| value.is_finite());
        let (value, length) = found.ok_or_else(|| {
            format!("a number is expected, not `{}`", crate::text::quote(self.rest))
        })?;
        self.rest = self.rest.get(length..).unwrap_or_default();
        Ok(Some(value))
    }

    fn need(&mut self) -> Result<f64, String> {
        self.number()?.ok_or_else(|| "a number is missing at the end".to_owned())
    }

    /// A flag of an arc, which needs nothing to part it from what follows.
    fn flag(&mut self) -> Result<bool, String> {
        self.skip();
        match self.rest {
            [flag @ (b'0' | b'1'), rest @ ..] => {
                self.rest = rest;
                Ok(*flag == b'1')
            }
            _ => Err("a flag of an arc must be 0 or 1".to_owned()),
        }
    }

    fn pair(&mut self) -> Result<DVec2, String> {
        Ok(DVec2::new(self.need()?, self.need()?))
    }

    fn all(mut self) -> Result<Vec<f64>, String> {
        let mut numbers = Vec::new();
        while let Some(number) = self.number()? {
            numbers.push(number);
        }
        Ok(numbers)
    }
}
