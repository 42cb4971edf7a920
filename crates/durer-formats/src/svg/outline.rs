//! Outlines of shapes as browsers see them: for boxes that other values refer to, and for lengths of paths.

use super::values::{Around, whole_of};
use crate::css::Whole;
use durer::math::{DAffine2, DVec2};
use std::cell::Cell;
use std::collections::HashMap;
use svgtypes::{SimplePathSegment, SimplifyingPathParser};
use usvg::roxmltree::{Node, NodeId};

/// Largest depth of nested elements whose boxes are computed.
const MAX_DEPTH: u32 = 64;

/// Limit on the elements examined for boxes in a document: groups within groups would be examined again and again.
const MAX_ELEMENTS: u32 = 2_000_000;

/// The attributes that elements have in the end.
pub(super) trait Attributes<'a> {
    /// Returns the value of an attribute, without a namespace.
    fn value(&self, node: Node<'a, '_>, name: &str) -> Option<&str>;
    /// Returns the element that `use` shows.
    fn shown<'i>(&self, node: Node<'a, 'i>) -> Option<Node<'a, 'i>>;
}

/// A part of an outline.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Piece {
    Line([DVec2; 2]),
    Curve([DVec2; 4]),
}

/// A box: two opposite corners.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Bounds {
    pub low: DVec2,
    pub high: DVec2,
}

impl Bounds {
    fn of_point(p: DVec2) -> Self {
        Self { low: p, high: p }
    }

    fn with(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    pub fn size(self) -> DVec2 {
        self.high - self.low
    }
}

/// Returns a length that an element says.
fn length<'a>(
    all: &impl Attributes<'a>,
    node: Node<'a, '_>,
    name: &str,
    around: &Around,
) -> Option<f64> {
    let text = all.value(node, name)?;
    let whole = Whole::Length(whole_of(name, &around.units));
    around.units.parse(text, Some(whole))?.length()
}

/// Returns the outline of a basic shape; `None` for other elements.
fn pieces<'a>(
    all: &impl Attributes<'a>,
    node: Node<'a, '_>,
    around: &Around,
) -> Option<Vec<Piece>> {
    let of = |name: &str| length(all, node, name, around);
    let at = |x: &str, y: &str| DVec2::new(of(x).unwrap_or(0.0), of(y).unwrap_or(0.0));
    match node.tag_name().name() {
        "rect" => {
            let size = DVec2::new(of("width")?, of("height")?);
            let (rx, ry) = (of("rx").filter(|v| *v >= 0.0), of("ry").filter(|v| *v >= 0.0));
            let radii = DVec2::new(rx.or(ry).unwrap_or(0.0), ry.or(rx).unwrap_or(0.0));
            (size.min_element() > 0.0).then(|| rectangle(at("x", "y"), size, radii.min(size / 2.0)))
        }
        "circle" => of("r").filter(|r| *r > 0.0).map(|r| ellipse(at("cx", "cy"), DVec2::splat(r))),
        "ellipse" => {
            let (rx, ry) = (of("rx"), of("ry"));
            Some(ellipse(at("cx", "cy"), DVec2::new(rx.or(ry)?, ry.or(rx)?)))
        }
        "line" => Some(vec![Piece::Line([at("x1", "y1"), at("x2", "y2")])]),
        name @ ("polyline" | "polygon") => {
            let text = all.value(node, "points")?;
            let points: Vec<DVec2> =
                svgtypes::PointsParser::from(text).map(|(x, y)| DVec2::new(x, y)).collect();
            let mut lines: Vec<Piece> =
                points.windows(2).map(|p| Piece::Line([p[0], p[1]])).collect();
            if let (true, Some(first), Some(last)) =
                (name == "polygon", points.first(), points.last())
            {
                lines.push(Piece::Line([*last, *first]));
            }
            Some(lines)
        }
        "path" => Some(path(all.value(node, "d")?)),
        _ => None,
    }
}

fn path(data: &str) -> Vec<Piece> {
    let (mut found, mut at, mut start) = (Vec::new(), DVec2::ZERO, DVec2::ZERO);
    for segment in SimplifyingPathParser::from(data).map_while(Result::ok) {
        match segment {
            SimplePathSegment::MoveTo { x, y } => {
                at = DVec2::new(x, y);
                start = at;
            }
            SimplePathSegment::LineTo { x, y } => {
                let to = DVec2::new(x, y);
                found.push(Piece::Line([at, to]));
                at = to;
            }
            SimplePathSegment::CurveTo { x1, y1, x2, y2, x, y } => {
                let to = DVec2::new(x, y);
                found.push(Piece::Curve([at, DVec2::new(x1, y1), DVec2::new(x2, y2), to]));
                at = to;
            }
            SimplePathSegment::Quadratic { x1, y1, x, y } => {
                let (control, to) = (DVec2::new(x1, y1), DVec2::new(x, y));
                let third = |p: DVec2| p + (control - p) * (2.0 / 3.0);
                found.push(Piece::Curve([at, third(at), third(to), to]));
                at = to;
            }
            SimplePathSegment::ClosePath => {
                found.push(Piece::Line([at, start]));
                at = start;
            }
        }
    }
    found
}

/// Distance of control points of a quarter of a circle from its ends, in radii.
const KAPPA: f64 = 0.552_284_749_830_793_4;

fn quarter(from: DVec2, corner: DVec2, to: DVec2) -> Piece {
    Piece::Curve([from, from.lerp(corner, KAPPA), to.lerp(corner, KAPPA), to])
}

fn rectangle(corner: DVec2, size: DVec2, r: DVec2) -> Vec<Piece> {
    let (low, high) = (corner, corner + size);
    let p = DVec2::new;
    vec![
        Piece::Line([p(low.x + r.x, low.y), p(high.x - r.x, low.y)]),
        quarter(p(high.x - r.x, low.y), p(high.x, low.y), p(high.x, low.y + r.y)),
        Piece::Line([p(high.x, low.y + r.y), p(high.x, high.y - r.y)]),
        quarter(p(high.x, high.y - r.y), high, p(high.x - r.x, high.y)),
        Piece::Line([p(high.x - r.x, high.y), p(low.x + r.x, high.y)]),
        quarter(p(low.x + r.x, high.y), p(low.x, high.y), p(low.x, high.y - r.y)),
        Piece::Line([p(low.x, high.y - r.y), p(low.x, low.y + r.y)]),
        quarter(p(low.x, low.y + r.y), low, p(low.x + r.x, low.y)),
    ]
}

fn ellipse(center: DVec2, r: DVec2) -> Vec<Piece> {
    rectangle(center - r, r * 2.0, r)
}

impl Piece {
    fn mapped(self, map: &DAffine2) -> Self {
        match self {
            Self::Line(points) => Self::Line(points.map(|p| map.transform_point2(p))),
            Self::Curve(points) => Self::Curve(points.map(|p| map.transform_point2(p))),
        }
    }

    fn bounds(self) -> Bounds {
        match self {
            Self::Line([a, b]) => Bounds::of_point(a).with(Bounds::of_point(b)),
            Self::Curve(points) => {
                let [a, .., d] = points;
                let mut bounds = Bounds::of_point(a).with(Bounds::of_point(d));
                for axis in 0..2 {
                    for t in turns(points.map(|p| p[axis])) {
                        bounds = bounds.with(Bounds::of_point(on_curve(points, t)));
                    }
                }
                bounds
            }
        }
    }

    /// Returns the length of a curve by Simpson's rule over chords: off by less than 10⁻⁶ of it.
    fn length(self) -> f64 {
        match self {
            Self::Line([a, b]) => a.distance(b),
            Self::Curve(points) => {
                const PIECES: u32 = 64;
                let at = |i: u32| speed(points, f64::from(i) / f64::from(PIECES));
                let inner: f64 =
                    (1..PIECES).map(|i| at(i) * if i % 2 == 1 { 4.0 } else { 2.0 }).sum();
                (at(0) + inner + at(PIECES)) / (3.0 * f64::from(PIECES))
            }
        }
    }
}

fn on_curve([a, b, c, d]: [DVec2; 4], t: f64) -> DVec2 {
    let s = 1.0 - t;
    a * (s * s * s) + b * (3.0 * s * s * t) + c * (3.0 * s * t * t) + d * (t * t * t)
}

fn speed([a, b, c, d]: [DVec2; 4], t: f64) -> f64 {
    let s = 1.0 - t;
    ((b - a) * (3.0 * s * s) + (c - b) * (6.0 * s * t) + (d - c) * (3.0 * t * t)).length()
}

/// Returns the parameters at which a coordinate of a curve is greatest or least in between.
fn turns([a, b, c, d]: [f64; 4]) -> impl Iterator<Item = f64> {
    let (p, q, r) = (d - 3.0 * c + 3.0 * b - a, 2.0 * (c - 2.0 * b + a), b - a);
    let roots = if p.abs() < 1e-12 {
        [-r / q, f64::NAN]
    } else {
        let root = libm::sqrt(q * q - 4.0 * p * r);
        [(-q + root) / (2.0 * p), (-q - root) / (2.0 * p)]
    };
    roots.into_iter().filter(|t| *t > 0.0 && *t < 1.0)
}

/// Returns the length of the outline of a basic shape in its own units.
pub(super) fn path_length<'a>(
    all: &impl Attributes<'a>,
    node: Node<'a, '_>,
    around: &Around,
) -> Option<f64> {
    let length: f64 = pieces(all, node, around)?.into_iter().map(Piece::length).sum();
    (length.is_finite() && length > 0.0).then_some(length)
}

/// Search for boxes.
pub(super) struct Boxes<'b, A> {
    pub all: &'b A,
    pub around: &'b Around,
    /// Number of elements examined in the document.
    looked: &'b Cell<u32>,
}

impl<'b, A> Boxes<'b, A> {
    pub fn new(all: &'b A, around: &'b Around, looked: &'b Cell<u32>) -> Self {
        Self { all, around, looked }
    }

    /// Returns the box around an element in its own units, without its transform; `None` if it is not known, as for
    /// text.
    pub fn find<'a>(&mut self, node: Node<'a, '_>) -> Option<Bounds>
    where
        A: Attributes<'a>,
    {
        let bounds = self.mapped(node, &DAffine2::IDENTITY, 0)?;
        (bounds.low.is_finite() && bounds.high.is_finite()).then_some(bounds)
    }

    fn mapped<'a>(&mut self, node: Node<'a, '_>, map: &DAffine2, depth: u32) -> Option<Bounds>
    where
        A: Attributes<'a>,
    {
        self.looked.set(self.looked.get().saturating_add(1));
        if depth > MAX_DEPTH || self.looked.get() > MAX_ELEMENTS {
            return None;
        }
        let of = |name: &str| length(self.all, node, name, self.around);
        let corner = DVec2::new(of("x").unwrap_or(0.0), of("y").unwrap_or(0.0));
        match node.tag_name().name() {
            "g" | "a" => {
                let mut bounds: Option<Bounds> = None;
                for child in node.children().filter(Node::is_element) {
                    if is_described(child) || self.all.value(child, "display") == Some("none") {
                        continue;
                    }
                    let own = transform(self.all, child)?;
                    let more = self.mapped(child, &(*map * own), depth + 1)?;
                    bounds = Some(bounds.map_or(more, |bounds| bounds.with(more)));
                }
                bounds
            }
            "use" => {
                let shown = self.all.shown(node)?;
                let map = *map * DAffine2::from_translation(corner) * transform(self.all, shown)?;
                self.mapped(shown, &map, depth + 1)
            }
            "image" => {
                let high = corner + DVec2::new(of("width")?, of("height")?);
                Some(Piece::Line([corner, high]).mapped(map).bounds())
            }
            _ => {
                let pieces = pieces(self.all, node, self.around)?;
                let each = pieces.into_iter().map(|piece| piece.mapped(map).bounds());
                each.reduce(Bounds::with)
            }
        }
    }
}

fn transform<'a>(all: &impl Attributes<'a>, node: Node<'a, '_>) -> Option<DAffine2> {
    let Some(text) = all.value(node, "transform") else { return Some(DAffine2::IDENTITY) };
    let t: svgtypes::Transform = text.parse().ok()?;
    Some(DAffine2::from_cols(DVec2::new(t.a, t.b), DVec2::new(t.c, t.d), DVec2::new(t.e, t.f)))
}

/// Returns whether an element is a definition, which is not drawn in its place.
fn is_described(node: Node<'_, '_>) -> bool {
    matches!(
        node.tag_name().name(),
        "defs"
            | "style"
            | "title"
            | "desc"
            | "metadata"
            | "clipPath"
            | "mask"
            | "marker"
            | "pattern"
            | "symbol"
            | "linearGradient"
            | "radialGradient"
            | "filter"
            | "script"
            | "animate"
            | "animateTransform"
            | "set"
    )
}

/// Changed attributes of elements.
pub(super) type Changed<'a> =
    HashMap<NodeId, Vec<(std::borrow::Cow<'a, str>, std::borrow::Cow<'a, str>)>>;
