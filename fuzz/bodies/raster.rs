//! The laws that hold for any bytes, read as paths, strokes, lines and images: the bodies of the fuzz
//! targets `raster` and `seed_fill`, which the tests call as well.

use arbitrary::{Result, Unstructured};
use durer::curve::{Contours, Path, PathElement, flatten};
use durer::math::{DAffine2, DVec2, IVec2};
use durer::raster::coverage::{self, FillRule, Overlap};
use durer::raster::line::wide::{Cap, Join, Stroke, outline};
use durer::raster::line::{self, LineRasterizer};
use durer::raster::paint::{Canvas, MaskKind, Options, Paint};
use durer::raster::polygon::{self, PolygonRasterizer};
use durer::raster::seed_fill::{self, Connectivity, SeedFill, boundary_fill, flood_fill};
use durer::target::Pixels;
use durer::target::gradient::{Gradient, GradientShape, Spread};
use durer::trace::NoTrace;
use std::sync::Arc;

/// Returns a number: on a tiny grid, where everything touches, around a small target, far away, or any
/// there is.
fn number(u: &mut Unstructured<'_>, kind: u8) -> Result<f64> {
    Ok(match kind {
        0 => f64::from(u.int_in_range(-2i8..=18)?),
        1 => f64::from(u.arbitrary::<u16>()?) / 3000.0,
        2 => f64::from(u.arbitrary::<i32>()?) * 1e-3,
        3 => *u.choose(&[0.0, 1e30, -1e30, 5.5, 1e-30, f64::MAX, f64::NAN, f64::INFINITY, 9.0])?,
        _ => f64::from_bits(u.arbitrary()?),
    })
}

fn point(u: &mut Unstructured<'_>, kind: u8) -> Result<DVec2> {
    Ok(DVec2::new(number(u, kind)?, number(u, kind)?))
}

fn path(u: &mut Unstructured<'_>, kind: u8) -> Result<Path> {
    let mut path = Path::new();
    for _ in 0..u.int_in_range(0..=12)? {
        path.push(match u.int_in_range(0..=5)? {
            0 => PathElement::MoveTo(point(u, kind)?),
            1 | 2 => PathElement::LineTo(point(u, kind)?),
            3 => PathElement::QuadTo(point(u, kind)?, point(u, kind)?),
            4 => PathElement::CubicTo(point(u, kind)?, point(u, kind)?, point(u, kind)?),
            _ => PathElement::Close,
        });
    }
    Ok(path)
}

fn stroke(u: &mut Unstructured<'_>, kind: u8) -> Result<Stroke> {
    // Any numbers hardly ever are a style; half of the time they are one.
    let usual = u.arbitrary()?;
    let length = |u: &mut Unstructured<'_>, most: u32| {
        if usual { Ok(f64::from(u.int_in_range(0..=most)?) / 8.0) } else { number(u, kind) }
    };
    let dashes: Result<Vec<f64>> = (0..u.int_in_range(0..=3)?).map(|_| length(u, 80)).collect();
    Ok(Stroke {
        width: length(u, 400)?,
        cap: *u.choose(&[Cap::Butt, Cap::Round, Cap::Square])?,
        join: *u.choose(&[Join::Miter, Join::Round, Join::Bevel])?,
        miter_limit: f64::from(u.int_in_range(0u8..=9)?),
        dashes: dashes?,
        dash_offset: length(u, 160)?,
    })
}

/// Fills, strokes and lines stay within the target, do not care about the direction, and what is wrong
/// with a stroke is an error.
pub fn raster(bytes: &[u8]) {
    let _ = any_raster(&mut Unstructured::new(bytes));
}

fn any_raster(u: &mut Unstructured<'_>) -> Result<()> {
    let kind = u.int_in_range(0..=4)?;
    let rule = *u.choose(&[FillRule::NonZero, FillRule::EvenOdd])?;
    let size = (u.int_in_range(0..=40)?, u.int_in_range(0..=20)?);
    any_lines(u)?;
    let (path, stroke) = (path(u, kind)?, stroke(u, kind)?);
    let outline = any_stroke(&path, &stroke).filter(|outline| outline.points().len() <= LONG);
    if let Some(outline) = &outline {
        any_reach(u, &path, &stroke, outline)?;
    }
    for contours in [Some(flatten(&path, 0.1)), outline.clone()].into_iter().flatten() {
        any_fill(&contours, rule, size);
    }
    any_painting(u, kind, &path, outline.map(|_| &stroke), rule, size)
}

/// Outlines of more elements, of fine dashes along lines that go far, take seconds and show nothing new.
const LONG: usize = 2_000;

const OVERLAPS: [Overlap; 4] =
    [Overlap::Exact, Overlap::Measured, Overlap::Adaptive, Overlap::Accumulated];

fn any_fill(contours: &Contours, rule: FillRule, size: (u32, u32)) {
    let masks = OVERLAPS.map(|overlap| {
        let options = coverage::Options { rule, overlap };
        coverage::fill(contours, size.0, size.1, &options, &mut NoTrace).expect("small")
    });
    let mut back = Contours::new();
    for (points, closed) in contours.iter() {
        back.push(points.iter().rev().copied(), closed);
    }
    for (mask, overlap) in masks.iter().zip(OVERLAPS) {
        let options = coverage::Options { rule, overlap };
        let reversed = coverage::fill(&back, size.0, size.1, &options, &mut NoTrace);
        assert_eq!(mask.data(), reversed.expect("small").data(), "{rule:?} {size:?} {contours:?}");
    }
    let (mut last, mut spans) = ((0, 0), Vec::new());
    let (options, edge) = (polygon::Options { rule }, (size.0 as i32, size.1 as i32));
    PolygonRasterizer::EdgeTable.fill(contours, size.0, size.1, &options, |s| {
        assert!(last <= (s.y, s.x0) && s.x0 < s.x1, "{s:?} after {last:?}: {contours:?}");
        assert!(s.y < edge.1 && s.x1 <= edge.0, "{s:?} in {size:?}: {contours:?}");
        last = (s.y, s.x1);
        spans.push(s);
    });
    let mut other = Vec::new();
    PolygonRasterizer::OrderedEdgeList.fill(contours, size.0, size.1, &options, |s| other.push(s));
    assert_eq!(spans, other, "{rule:?} {size:?} {contours:?}");
}

/// Returns the outline, of finite points, unless the style is wrong.
fn any_stroke(path: &Path, stroke: &Stroke) -> Option<Contours> {
    let length = |v: f64| v.is_finite() && v >= 0.0;
    let good = length(stroke.width)
        && stroke.miter_limit >= 1.0
        && stroke.dashes.iter().all(|d| length(*d))
        && stroke.dash_offset.is_finite();
    let found = outline(path, stroke, 0.1, &mut NoTrace);
    assert_eq!(found.is_ok(), good, "{stroke:?}");
    let found = found.ok()?;
    let finite = found.points().iter().all(|p| p.is_finite());
    assert!(finite, "{path:?} {stroke:?}");
    Some(found)
}

/// Coordinates and widths beyond this have no digits left for what [`any_reach`] asks.
const NEAR: f64 = 1e4;

/// The outline's tolerance, that of the chain it is compared with, and rounding.
const WITHIN: f64 = 0.1 + 0.01 + 1e-3;

/// Returns how often an outline winds around a point.
fn winding(outline: &Contours, p: DVec2) -> i32 {
    let mut winding = 0;
    for (points, _) in outline.iter() {
        for (i, a) in points.iter().enumerate() {
            let b = points[(i + 1) % points.len()];
            let side = (b - *a).perp_dot(p - *a);
            winding += i32::from(a.y <= p.y && b.y > p.y && side > 0.0);
            winding -= i32::from(a.y > p.y && b.y <= p.y && side < 0.0);
        }
    }
    winding
}

fn distance(chain: &Contours, p: DVec2) -> f64 {
    let to = |(a, b): (DVec2, DVec2)| {
        let (way, length) = (b - a, a.distance_squared(b));
        let t = if length > 0.0 { ((p - a).dot(way) / length).clamp(0.0, 1.0) } else { 0.0 };
        p.distance(a + way * t)
    };
    let edges = chain.iter().flat_map(|(points, closed)| {
        let last = if closed { points.len() } else { points.len().saturating_sub(1) };
        (0..last.max(1)).map(move |i| (points[i], points[(i + 1) % points.len()]))
    });
    edges.map(to).fold(f64::INFINITY, f64::min)
}

fn is_finite(element: &PathElement) -> bool {
    match *element {
        PathElement::MoveTo(p) | PathElement::LineTo(p) => p.is_finite(),
        PathElement::QuadTo(a, p) => a.is_finite() && p.is_finite(),
        PathElement::CubicTo(a, b, p) => a.is_finite() && b.is_finite() && p.is_finite(),
        PathElement::Close => true,
    }
}

/// Returns the path without what only moves, which has no stroke.
fn drawn(path: &Path) -> Path {
    let (mut out, mut moved, mut open) = (Path::new(), None, false);
    for element in path.elements() {
        match element {
            PathElement::MoveTo(_) => moved = Some(*element),
            PathElement::Close if moved.is_none() && !open => continue,
            _ => {
                if let Some(to) = moved.take() {
                    out.push(to);
                }
                out.push(*element);
            }
        }
        open = *element != PathElement::Close;
    }
    out
}

/// Checks that a stroke covers only points within its reach; that round ones cover everything within half
/// their width; and that no point is passed backwards, which would cancel the area around it.
fn any_reach(
    u: &mut Unstructured<'_>,
    path: &Path,
    stroke: &Stroke,
    outline: &Contours,
) -> Result<()> {
    // Strokes leave out elements that are not finite; flattening keeps their ends.
    if !path.elements().iter().all(is_finite) {
        return Ok(());
    }
    let chain = flatten(&drawn(path), 0.01);
    let near = |p: &DVec2| p.abs().max_element() <= NEAR;
    let few = chain.points().len() <= LONG && outline.points().len() <= LONG;
    // What only moves counts for the size of a path, and so for its tolerance.
    let is_near = path.bounds().is_some_and(|b| near(&b.min()) && near(&b.max()));
    if !few
        || !is_near
        || !chain.points().iter().all(near)
        || !(0.01..=NEAR).contains(&stroke.width)
    {
        return Ok(());
    }
    let half = stroke.width / 2.0;
    let sharp = if stroke.join == Join::Miter { stroke.miter_limit } else { 1.0 };
    let reach = half * if stroke.cap == Cap::Square { sharp.max(1.5) } else { sharp };
    let is_round = stroke.cap == Cap::Round && stroke.join == Join::Round;
    for _ in 0..8 {
        let p = DVec2::new(number(u, 1)?, number(u, 1)?);
        let (away, winding) = (distance(&chain, p), winding(outline, p));
        assert!(winding <= 0, "{p} is passed backwards: {path:?} {stroke:?}");
        if away > reach + WITHIN {
            assert_eq!(winding, 0, "{p}, {away} away: {path:?} {stroke:?}");
        }
        if is_round && stroke.dashes.is_empty() && away < half - WITHIN {
            assert!(winding < 0, "{p}, {away} away: {path:?} {stroke:?}");
        }
    }
    Ok(())
}

fn any_lines(u: &mut Unstructured<'_>) -> Result<()> {
    let whole = u.arbitrary()?;
    let mut number = || if whole { u.arbitrary() } else { u.int_in_range(-9..=40) };
    let (a, b) = (IVec2::new(number()?, number()?), IVec2::new(number()?, number()?));
    let window = (IVec2::ZERO, IVec2::new(31, 15));
    let options = line::Options { window: Some(window) };
    let pixels = |method: LineRasterizer, a, b| {
        let mut found = Vec::new();
        method.draw(a, b, &options, |p| found.push(p), &mut NoTrace);
        found
    };
    let expected = pixels(LineRasterizer::Bresenham, a, b);
    let inside = |p: &IVec2| p.cmpge(window.0).all() && p.cmple(window.1).all();
    assert!(expected.iter().all(inside), "{a} {b} {expected:?}");
    for &method in LineRasterizer::ALL {
        assert_eq!(pixels(method, a, b), expected, "{method} {a} {b}");
        assert_eq!(pixels(method, b, a), expected, "{method} {b} {a}");
    }
    Ok(())
}

/// Whatever is painted, clipped, grouped and masked, a picture comes out.
fn any_painting(
    u: &mut Unstructured<'_>,
    kind: u8,
    path: &Path,
    stroke: Option<&Stroke>,
    rule: FillRule,
    size: (u32, u32),
) -> Result<()> {
    let mut canvas = Canvas::new(size.0, size.1, Options::default()).expect("small");
    for _ in 0..u.int_in_range(0..=8)? {
        let opacity = number(u, kind)?;
        let paint = if u.arbitrary()? {
            Paint::Color(u.arbitrary()?)
        } else {
            let (start, end) = (point(u, kind)?, point(u, kind)?);
            let shape = GradientShape::Linear { start, end };
            let stops =
                vec![(number(u, kind)?, u.arbitrary()?), (number(u, kind)?, u.arbitrary()?)];
            let spread = *u.choose(&[Spread::Pad, Spread::Repeat, Spread::Reflect])?;
            let transform = DAffine2::IDENTITY;
            Paint::Gradient(Arc::new(Gradient { shape, stops, spread, transform }))
        };
        match u.int_in_range(0..=8)? {
            0 => canvas.push_clip(path, rule),
            1 => canvas.push_group(),
            2 => canvas.begin_mask(),
            3 => canvas.end_mask(MaskKind::Luminance),
            4 => canvas.pop(opacity),
            5 => canvas.set_transform(DAffine2::from_cols(
                point(u, kind)?,
                point(u, kind)?,
                point(u, kind)?,
            )),
            6 => drop(stroke.map(|stroke| canvas.stroke(path, stroke, &paint, opacity))),
            _ => canvas.fill(path, rule, &paint, opacity),
        }
    }
    let mut target = Pixels::new(size.0, size.1, [9, 8, 7, 6]);
    canvas.render(&mut target).expect("the same size");
    Ok(())
}

/// Both forms of the seed fill fill the same set, and what is filled is all of one piece.
pub fn seed_fill(bytes: &[u8]) {
    let _ = any_seed_fill(&mut Unstructured::new(bytes));
}

fn any_seed_fill(u: &mut Unstructured<'_>) -> Result<()> {
    let (width, height) = (u.int_in_range(0..=130)?, u.int_in_range(0..=9)?);
    let connectivity = *u.choose(&[Connectivity::Four, Connectivity::Eight])?;
    let options = seed_fill::Options { connectivity, ..Default::default() };
    let seed = (u.int_in_range(0..=131)?, u.int_in_range(0..=10)?);
    let (value, boundary, tolerance) = (u.arbitrary()?, u.arbitrary()?, u.arbitrary()?);
    let bits = u.bytes(u.len())?.iter().cycle();
    let data: Vec<u8> = bits.take((width * height) as usize).copied().collect();
    let Ok(image) = Pixels::from_data(width, height, data) else { return Ok(()) };
    let mut pictures = [image.clone(), image.clone(), image.clone(), image.clone()];
    let [a, b, c, d] = &mut pictures;
    let t = &mut NoTrace;
    let floods = [(a, SeedFill::Naive), (b, SeedFill::Spans)]
        .map(|(p, m)| flood_fill(p, seed, value, tolerance, m, &options, t).expect("no budget"));
    let boundaries = [(c, SeedFill::Naive), (d, SeedFill::Spans)].map(|(p, m)| {
        let filled = boundary_fill(p, seed, value, boundary, tolerance, m, &options, t);
        filled.expect("no budget")
    });
    assert_eq!(floods[0], floods[1]);
    assert_eq!(boundaries[0], boundaries[1]);
    assert_eq!(pictures[0].data(), pictures[1].data());
    assert_eq!(pictures[2].data(), pictures[3].data());
    assert_eq!(floods[0] > 0, seed.0 < width && seed.1 < height);
    let changed =
        |p: &Pixels<u8>| p.data().iter().zip(image.data()).filter(|(a, b)| a != b).count();
    assert!(changed(&pictures[0]) as u64 <= floods[0]);
    assert!(changed(&pictures[2]) as u64 <= boundaries[0]);
    Ok(())
}
