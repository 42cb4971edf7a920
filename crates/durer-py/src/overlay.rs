//! Geometries one by one: clipped to a mask, or overlaid with another.

use durer::clip::mask::{Cutter, Mask, Rules, Union};
use durer::clip::polygon::{BooleanOp, WindingRule};
use durer::geometry::Geometry;
use durer::work::Work;

/// Returns an operation of one geometry with another, by its name in shapely.
pub fn op(name: &str) -> Result<BooleanOp, String> {
    match name {
        "intersection" => Ok(BooleanOp::Intersection),
        "union" => Ok(BooleanOp::Union),
        "difference" => Ok(BooleanOp::Difference),
        "symmetric_difference" => Ok(BooleanOp::Xor),
        _ => Err(format!("there is no operation '{name}'")),
    }
}

/// Returns the overlay rules for a grid size.
pub fn rules(grid: Option<f64>) -> Rules {
    Rules { grid, ..Rules::default() }
}

/// Refuses coordinates that are not finite.
pub fn check(geometry: &Geometry) -> Result<(), String> {
    let mut wrong = None;
    geometry.for_each(&mut |points| {
        let found = points.xy.iter().find(|p| !p.is_finite());
        wrong = wrong.or(found.copied());
    });
    wrong.map_or(Ok(()), |p| Err(format!("the coordinate ({}, {}) is not finite", p.x, p.y)))
}

/// Returns the part of a geometry in a mask; `None` if it is empty.
pub fn clip(geometry: &Geometry, mask: &Mask, rules: &Rules) -> Result<Option<Geometry>, String> {
    check(geometry)?;
    let cutter = Cutter { rules: rules.clone(), ..Cutter::new(mask) };
    cutter.cut(geometry).map(|cut| cut.geometry).map_err(|e| e.to_string())
}

/// Returns the polygons of geometries as one mask.
pub fn mask(polygons: &[Geometry]) -> Result<Mask, String> {
    let rules = Rules::default();
    let mut union = Union::default();
    for (at, polygon) in polygons.iter().enumerate() {
        let fail = |e: String| format!("mask[{at}]: {e}");
        check(polygon).map_err(fail)?;
        if !is_area(polygon) {
            return Err(fail(format!("a {} has no area to clip to", polygon.name())));
        }
        let valid = rules.clean(polygon).map_err(|e| fail(e.to_string()))?;
        union.add(polygon, &valid.area);
    }
    let joined = union.finish(&Work::default()).map_err(|e| e.to_string())?;
    let shapes = joined.as_ref().map(|g| durer::clip::mask::Area::of_geometry(g).shapes);
    Mask::polygons(shapes.unwrap_or_default()).map_err(|e| e.to_string())
}

/// Returns whether a geometry consists only of polygons.
fn is_area(geometry: &Geometry) -> bool {
    matches!(geometry, Geometry::Polygon(_) | Geometry::MultiPolygon(_))
}

/// Overlays two geometries; `None` if the result is empty.
pub fn overlay(
    a: &Geometry,
    b: &Geometry,
    op: BooleanOp,
    rules: &Rules,
) -> Result<Option<Geometry>, String> {
    check(a)?;
    check(b)?;
    match (is_area(a), is_area(b)) {
        (true, true) => areas(a, b, op, rules),
        (false, true) if matches!(op, BooleanOp::Intersection | BooleanOp::Difference) => {
            let mask = mask(std::slice::from_ref(b))?;
            let cutter = Cutter { op, rules: rules.clone(), ..Cutter::new(&mask) };
            cutter.cut(a).map(|cut| cut.geometry).map_err(|e| e.to_string())
        }
        (true, false) if op == BooleanOp::Intersection => overlay(b, a, op, rules),
        // Geometries without area take none away.
        (true, false) if op == BooleanOp::Difference => areas(a, &nothing(), op, rules),
        _ => Err(format!(
            "{} of a {} and a {}: one of the two must be a polygon, for union and symmetric_difference both",
            name(op),
            a.name(),
            b.name()
        )),
    }
}

fn nothing() -> Geometry {
    Geometry::MultiPolygon(Vec::new())
}

fn name(op: BooleanOp) -> &'static str {
    match op {
        BooleanOp::Intersection => "intersection",
        BooleanOp::Union => "union",
        BooleanOp::Difference => "difference",
        BooleanOp::Xor => "symmetric_difference",
    }
}

fn areas(
    a: &Geometry,
    b: &Geometry,
    op: BooleanOp,
    rules: &Rules,
) -> Result<Option<Geometry>, String> {
    let clean = |g: &Geometry| rules.clean(g).map(|made| made.area);
    let overlaid = clean(a).and_then(|a| {
        let b = clean(b)?;
        rules.overlay(&a, &b.shapes, op, WindingRule::EvenOdd)
    });
    overlaid.map(|made| made.area.into_geometry()).map_err(|e| e.to_string())
}
