//! The assignment of holes to rings, by the directions in which these run.

use crate::Place;
use crate::geo::{Points, Warnings};
use durer::clip::polygon::signed_area;
use durer::math::{DVec2, Orientation, Rect, orient2d};

/// A ring that may have holes.
struct Outer {
    bounds: Rect,
    area: f64,
    /// Its place in the result.
    polygon: usize,
}

/// Returns the polygons of rings, of which outer ones run clockwise, or all the other way round as some programs write them:
/// the largest ring is not a hole.
pub fn directed(all: Vec<Points>, place: &Place, warnings: &mut Warnings) -> Vec<Vec<Points>> {
    let areas = all.iter().map(|ring| signed_area(&ring.xy));
    let largest = areas.max_by(|a, b| a.abs().total_cmp(&b.abs())).unwrap_or(0.0);
    let is_outer = |ring: &Points| (signed_area(&ring.xy) > 0.0) == (largest > 0.0);
    polygons(all, is_outer, place, warnings)
}

/// Puts each hole into the smallest outer ring around it; a hole outside all rings becomes a polygon, with a warning.
fn polygons(
    rings: Vec<Points>,
    is_outer: impl Fn(&Points) -> bool,
    place: &Place,
    warnings: &mut Warnings,
) -> Vec<Vec<Points>> {
    let (outer, holes): (Vec<Points>, Vec<Points>) = rings.into_iter().partition(is_outer);
    let mut polygons: Vec<Vec<Points>> = outer.into_iter().map(|ring| vec![ring]).collect();
    let mut outers: Vec<Outer> = Vec::new();
    for (polygon, rings) in polygons.iter().enumerate() {
        let Some(ring) = rings.first() else { continue };
        let Some(bounds) = Rect::around(ring.xy.iter().copied()) else { continue };
        outers.push(Outer { bounds, area: signed_area(&ring.xy).abs(), polygon });
    }
    outers.sort_by(|a, b| a.area.total_cmp(&b.area));
    let mut alone = Vec::new();
    for hole in holes {
        let bounds = Rect::around(hole.xy.iter().copied());
        let is_around = |outer: &&Outer| {
            let ring = polygons.get(outer.polygon).and_then(|rings| rings.first());
            let near = bounds
                .is_some_and(|b| outer.bounds.contains(b.min()) && outer.bounds.contains(b.max()));
            near && ring.is_some_and(|ring| surrounds(&ring.xy, &hole.xy))
        };
        match outers.iter().find(is_around).map(|outer| outer.polygon) {
            Some(polygon) => polygons[polygon].push(hole),
            None => alone.push(vec![hole]),
        }
    }
    if !alone.is_empty() {
        let words = "{ring is|rings are} oriented as {a hole but is|holes but are} in no ring; {it becomes a polygon|they become polygons}";
        warnings.push(place.clone(), crate::wording::agreeing(alone.len() as u64, words));
    }
    polygons.append(&mut alone);
    polygons
}

/// Returns whether a ring is in another, by its first point that is not on the other's border.
fn surrounds(outer: &[DVec2], hole: &[DVec2]) -> bool {
    hole.iter().find_map(|&p| is_inside(outer, p)).unwrap_or(true)
}

/// Returns whether a point is in a ring; `None` on its border.
fn is_inside(ring: &[DVec2], p: DVec2) -> Option<bool> {
    let mut inside = false;
    let next = ring.iter().cycle().skip(1);
    for (&a, &b) in ring.iter().zip(next) {
        let (low, high) = if a.y <= b.y { (a, b) } else { (b, a) };
        if p.y < low.y || p.y > high.y {
            continue;
        }
        let side = orient2d(low, high, p);
        let within = p.x >= a.x.min(b.x) && p.x <= a.x.max(b.x);
        if side == Orientation::Collinear && within {
            return None;
        }
        inside ^= side == Orientation::CounterClockwise && low.y <= p.y && p.y < high.y;
    }
    Some(inside)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(x: f64, y: f64, side: f64) -> Points {
        let corners = [(0.0, 0.0), (0.0, side), (side, side), (side, 0.0)];
        Points::flat(corners.iter().map(|&(u, v)| DVec2::new(x + u, y + v)).collect())
    }

    fn turned(mut ring: Points) -> Points {
        ring.xy.reverse();
        ring
    }

    #[test]
    fn holes_find_the_smallest_ring_around_them() {
        let mut warnings = Warnings::default();
        let rings = vec![
            turned(square(1.0, 1.0, 8.0)),
            square(0.0, 0.0, 10.0),
            turned(square(2.0, 2.0, 1.0)),
            square(2.0, 2.0, 3.0),
            turned(square(20.0, 20.0, 1.0)),
        ];
        let is_outer = |ring: &Points| signed_area(&ring.xy) < 0.0;
        let found = polygons(rings, is_outer, &Place::Whole, &mut warnings);
        let shape: Vec<Vec<DVec2>> =
            found.iter().map(|p| p.iter().map(|r| r.xy[0]).collect()).collect();
        let at = |x: f64, y: f64| DVec2::new(x, y);
        assert_eq!(
            shape,
            [
                vec![at(0.0, 0.0), at(9.0, 1.0)],
                vec![at(2.0, 2.0), at(3.0, 2.0)],
                vec![at(21.0, 20.0)]
            ]
        );
        assert!(warnings.kept[0].message.starts_with("1 ring is oriented"));
    }
}
