//! The laws that hold for any bytes, read as segments and polygons: the bodies of the fuzz targets
//! `line`, `polygon` and `overlay`, which the tests call as well.

use arbitrary::{Result, Unstructured};
use durer::clip::line::{LineClipper, Segment, batch};
use durer::clip::polygon::overlay::{Options, overlay};
use durer::clip::polygon::{BooleanOp, PolygonClipper, Shapes, WindingRule, vatti};
use durer::math::{DVec2, Rect};
use durer::trace::NoTrace;

/// Returns a number: on a tiny grid, where everything touches, of usual size, or any there is.
fn number(u: &mut Unstructured<'_>, kind: u8) -> Result<f64> {
    Ok(match kind {
        0 => f64::from(u.int_in_range(-4i8..=4)?),
        1 => f64::from(u.int_in_range(-4i8..=4)?) * 0.1,
        2 => f64::from(u.arbitrary::<i16>()?),
        3 => f64::from(u.arbitrary::<i32>()?) * 1e-3,
        _ => f64::from_bits(u.arbitrary()?),
    })
}

fn point(u: &mut Unstructured<'_>, kind: u8) -> Result<DVec2> {
    Ok(DVec2::new(number(u, kind)?, number(u, kind)?))
}

fn kind(u: &mut Unstructured<'_>) -> Result<u8> {
    u.int_in_range(0..=4)
}

/// All line clippers agree, keep to the window, and do not care about the direction.
pub fn line(bytes: &[u8]) {
    let mut u = Unstructured::new(bytes);
    let Ok(kind) = kind(&mut u) else { return };
    let (Ok(a), Ok(b)) = (point(&mut u, kind), point(&mut u, kind)) else { return };
    let Some(window) = Rect::around([a, b]) else { return };
    let mut ends = [const { Vec::new() }; 4];
    while !u.is_empty() && ends[0].len() < 64 {
        let (Ok(p), Ok(q)) = (point(&mut u, kind), point(&mut u, kind)) else { break };
        one_line(&window, Segment::new(p, q));
        ends.iter_mut().zip([p.x, p.y, q.x, q.y]).for_each(|(list, v)| list.push(v));
    }
    let [x0, y0, x1, y1] = &ends;
    let mut clipped = batch::Clipped::default();
    let segments = batch::Segments { x0, y0, x1, y1 };
    batch::clip(&window, segments, &batch::Options::default(), &mut clipped).expect("one length");
    for (i, segment) in clipped.iter() {
        let given = Segment::new(DVec2::new(x0[i], y0[i]), DVec2::new(x1[i], y1[i]));
        let alone = LineClipper::CohenSutherland.clip(&window, given);
        assert_eq!(alone, Ok(Some(segment)), "{window:?} {given:?}");
    }
}

fn one_line(window: &Rect, segment: Segment<DVec2>) {
    let finite = segment.start.is_finite() && segment.end.is_finite();
    let expected = LineClipper::LiangBarsky.clip(window, segment);
    for &clipper in LineClipper::ALL.iter().filter(|&&a| a != LineClipper::Midpoint) {
        let found = clipper.clip(window, segment);
        assert_eq!(found.is_ok(), finite, "{clipper} {window:?} {segment:?}");
        let (Ok(found), Ok(expected)) = (found, &expected) else { continue };
        assert_eq!(found.is_some(), expected.is_some(), "{clipper} {window:?} {segment:?}");
        let back = clipper.clip(window, segment.reversed()).ok().flatten();
        let back = back.map(Segment::reversed);
        assert!(segment.start == segment.end || back == found, "{clipper} {window:?} {segment:?}");
        if let Some(s) = found {
            let inside = window.contains(s.start) && window.contains(s.end);
            assert!(inside, "{clipper} {window:?} {segment:?} {s:?}");
            assert_eq!(clipper.clip(window, s), Ok(Some(s)), "{clipper} {window:?}");
        }
    }
}

fn shapes(u: &mut Unstructured<'_>, kind: u8) -> Result<Shapes> {
    let mut shapes = Shapes::new();
    for _ in 0..u.int_in_range(0..=3)? {
        for _ in 0..u.int_in_range(0..=2)? {
            let count = u.int_in_range(0..=9)?;
            let ring: Result<Vec<DVec2>> = (0..count).map(|_| point(u, kind)).collect();
            shapes.push_ring(ring?);
        }
        shapes.end_polygon();
    }
    Ok(shapes)
}

/// No algorithm panics, whatever polygons it gets, and what comes out is finite.
pub fn polygon(bytes: &[u8]) {
    let mut u = Unstructured::new(bytes);
    let _ = any_polygons(&mut u);
}

fn any_polygons(u: &mut Unstructured<'_>) -> Result<()> {
    let kind = kind(u)?;
    let op = *u.choose(BooleanOp::ALL)?;
    let subject = shapes(u, kind)?;
    let mask = if u.arbitrary()? {
        let (a, b) = (point(u, kind)?, point(u, kind)?);
        Shapes::from_rings([[a, DVec2::new(b.x, a.y), b, DVec2::new(a.x, b.y)]])
    } else {
        shapes(u, kind)?
    };
    for &clipper in PolygonClipper::ALL {
        if let Ok(region) = clipper.clip(&subject, &mask, op) {
            assert!(
                region.points().iter().all(|p| p.is_finite()),
                "{clipper} {subject:?} {mask:?}"
            );
        }
    }
    Ok(())
}

/// The overlay's result is valid by `check` (its cell is reported), the sweep's is the same, and the areas
/// of the four operations fit together within what snapping may change.
pub fn overlay_laws(bytes: &[u8], check: impl Fn(&Shapes, f64) -> std::result::Result<(), String>) {
    let mut u = Unstructured::new(bytes);
    let _ = any_overlay(&mut u, check);
}

fn any_overlay(
    u: &mut Unstructured<'_>,
    check: impl Fn(&Shapes, f64) -> std::result::Result<(), String>,
) -> Result<()> {
    let kind = kind(u)?;
    let grid = if u.ratio(1, 4)? { Some(number(u, kind)?.abs()) } else { None };
    let rules = [*u.choose(WindingRule::ALL)?, *u.choose(WindingRule::ALL)?];
    let options =
        Options { subject_rule: rules[0], clip_rule: rules[1], grid, ..Options::default() };
    let (a, b) = (shapes(u, kind)?, shapes(u, kind)?);
    let mut areas = Vec::new();
    let mut within = 0.0;
    for &op in BooleanOp::ALL {
        let found = overlay(&a, &b, op, &options, &mut NoTrace);
        let sweep = vatti::vatti(&a, &b, op, &options, &mut NoTrace);
        assert_eq!(found, sweep, "{op} {options:?} {a:?} {b:?}");
        let Ok(found) = found else { return Ok(()) };
        // The validator counts in cells, and knows powers of two only.
        if found.cell.to_bits() << 12 == 0
            && let Err(why) = check(&found.shapes, found.cell)
        {
            panic!("{why}: {op} {options:?} {a:?} {b:?}");
        }
        areas.push(found.shapes.area());
        within = bound(&a, &b, found.cell);
    }
    // Squares of the largest coordinates are beyond all numbers.
    if !areas.iter().all(|area| area.is_finite()) {
        return Ok(());
    }
    let [and, or, sub, xor] = areas[..] else { return Ok(()) };
    assert!((xor + and - or).abs() <= within, "{xor} {and} {or}: {options:?} {a:?} {b:?}");
    assert!(sub <= or + within, "{sub} {or}: {options:?} {a:?} {b:?}");
    Ok(())
}

/// Returns a bound on the change of four areas by snapping: all edges times the diagonal of a cell,
/// and rounding.
fn bound(a: &Shapes, b: &Shapes, cell: f64) -> f64 {
    let around =
        |r: &[DVec2]| (0..r.len()).map(|i| r[i].distance(r[(i + 1) % r.len()])).sum::<f64>();
    let length: f64 = a.rings().chain(b.rings()).map(around).sum();
    let size =
        a.points().iter().chain(b.points()).fold(0.0f64, |m, p| m.max(p.abs().max_element()));
    8.0 * length * cell + 1e-9 * length * size
}
