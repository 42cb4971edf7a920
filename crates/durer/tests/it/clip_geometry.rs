//! Whole geometries: cut by cells and tiles, repaired, joined, simplified, placed on tiles.

use durer::clip::cells::Cells;
use durer::clip::mask::{Rules, Union, is_valid, match_points};
use durer::clip::polygon::{Shapes, WindingRule};
use durer::clip::simplify::{Amount, Dropped, LineSimplifier, simplify};
use durer::clip::tiles::{
    Coordinates, GridShape, Reach, Subject, Tile, TileBody, TileFeature, Tiling, extent, place,
};
use durer::geometry::{Dimensions, Geometry, Points};
use durer::math::{DVec2, I64Vec2, Rect};
use durer::raster::line::wide::buffer::{Options, of_geometry};
use durer::raster::line::wide::{Cap, Join};
use durer::work::Work;

type At = (f64, f64);

fn points(at: &[At]) -> Points {
    Points::flat(at.iter().copied().map(DVec2::from).collect())
}

fn line(at: &[At]) -> Geometry {
    Geometry::LineString(points(at))
}

fn square((x, y): At, side: f64) -> [At; 4] {
    [(x, y), (x + side, y), (x + side, y + side), (x, y + side)]
}

fn polygon(ring: &[At]) -> Geometry {
    Geometry::Polygon(vec![points(ring)])
}

fn area(geometry: &Geometry) -> f64 {
    durer::clip::mask::Area::of_geometry(geometry).shapes.area()
}

/// Returns three cells in a row from 0 to 3, a separate one, and one without an area.
fn cells() -> Cells {
    let shapes = |at: At, side: f64| Shapes::from_rings([square(at, side).map(DVec2::from)]);
    let mut all: Vec<Shapes> = (0..3).map(|i| shapes((f64::from(i), 0.0), 1.0)).collect();
    all.extend([Shapes::new(), shapes((10.0, 0.0), 2.0)]);
    Cells::new(all).expect("finite cells")
}

#[test]
fn cells_near_a_box_include_those_that_it_touches() {
    let near = |low: At, high: At| cells().near(&Rect::new(low.into(), high.into()).unwrap());
    assert_eq!(near((0.5, 0.5), (1.5, 0.6)), [0, 1]);
    assert_eq!(near((1.0, 0.5), (1.0, 0.5)), [0, 1]);
    assert_eq!(near((1.0, 1.0), (2.0, 5.0)), [0, 1, 2]);
    assert_eq!(near((4.0, 0.0), (9.9, 1.0)), [0; 0]);
    assert_eq!(near((-5.0, 0.0), (50.0, 1.0)), [0, 1, 2, 4]);
    assert_eq!(near((12.0, 2.0), (13.0, 3.0)), [4]);
    assert_eq!((cells().len(), cells().is_empty()), (5, false));
}

#[test]
fn a_large_polygon_is_cut_into_the_same_pieces_as_a_small_one() {
    // The same square with few and with many vertices.
    let few = square((0.5, -1.0), 10.0);
    let mut many = Vec::new();
    for (i, &(x, y)) in few.iter().enumerate() {
        let (u, v) = few[(i + 1) % 4];
        many.extend((0..32).map(|k| {
            let t = f64::from(k) / 32.0;
            (x + (u - x) * t, y + (v - y) * t)
        }));
    }
    let areas = |ring: &[At]| -> Vec<(usize, f64)> {
        let pieces = cells().cut(&polygon(ring), &Rules::default()).expect("finite polygons");
        pieces.iter().map(|p| (p.cell, p.cut.geometry.as_ref().map_or(0.0, area))).collect()
    };
    assert_eq!(areas(&few), [(0, 0.5), (1, 1.0), (2, 1.0), (4, 1.0)]);
    assert_eq!(areas(&many), areas(&few));
}

#[test]
fn polygons_are_made_valid_once() {
    let bow_tie = polygon(&[(0.0, 0.0), (2.0, 2.0), (2.0, 0.0), (0.0, 2.0)]);
    let both = Geometry::Collection(vec![line(&[(0.0, 0.0), (1.0, 1.0)]), bow_tie.clone()]);
    let fixed = Rules::default().fix(&both).expect("finite");
    assert!(fixed.changed && !is_valid(&both));
    let Some(Geometry::Collection(parts)) = &fixed.geometry else { panic!("two parts") };
    assert!(
        is_valid(&parts[1])
            && area(&parts[1]) == 2.0
            && parts[0] == line(&[(0.0, 0.0), (1.0, 1.0)])
    );
    let again = Rules::default().fix(fixed.geometry.as_ref().unwrap()).expect("finite");
    assert!(!again.changed && again.geometry == fixed.geometry);
    // By another rule, the rings of a valid polygon may mean something else.
    let clockwise = polygon(&[(0.0, 0.0), (0.0, 1.0), (1.0, 1.0), (1.0, 0.0)]);
    let positive = Rules { fill: WindingRule::Positive, ..Rules::default() };
    let gone = positive.fix(&clockwise).expect("finite");
    assert_eq!((gone.geometry, gone.changed), (None, false));
}

#[test]
fn neighbours_get_the_points_of_each_other() {
    let left = polygon(&square((0.0, 0.0), 1.0));
    let right = polygon(&[(1.0, 0.0), (2.0, 0.0), (2.0, 1.0), (1.0, 1.0), (1.0, 0.5)]);
    let mut layer = [Some(left), None, Some(right), Some(line(&[(0.0, 0.0), (1.0, 0.0)]))];
    assert_eq!(match_points(&mut layer), 1);
    assert_eq!(layer[0].as_ref().map(Geometry::len), Some(5));
    assert_eq!(match_points(&mut layer), 0);
}

#[test]
fn unions_join_polygons_and_keep_the_rest() {
    let mut union = Union::default();
    let mut add = |geometry: &Geometry| {
        union.add(geometry, &Rules::default().clean(geometry).expect("finite").area)
    };
    assert!(!add(&polygon(&square((0.0, 0.0), 2.0))));
    assert!(!add(&polygon(&square((1.0, 0.0), 2.0))));
    assert!(!add(&line(&[(0.0, 5.0), (1.0, 5.0)])));
    assert!(!add(&Geometry::Point(points(&[(7.0, 7.0)]))));
    let mut high = Points::new(Dimensions::Xyz);
    high.push(DVec2::new(8.0, 8.0), [3.0, 0.0]);
    assert!(add(&Geometry::Point(high)), "points with and without heights");
    let Ok(Some(Geometry::Collection(parts))) = union.finish(&Work::default()) else {
        panic!("three parts")
    };
    assert_eq!(
        parts.iter().map(Geometry::name).collect::<Vec<_>>(),
        ["Polygon", "LineString", "MultiPoint"]
    );
    assert_eq!(area(&parts[0]), 6.0);
    assert_eq!(Union::default().finish(&Work::default()), Ok(None));
}

#[test]
fn geometries_are_simplified_together_and_small_rings_dropped() {
    let mut road = line(&[(0.0, 0.0), (1.0, 0.1), (2.0, 0.0), (3.0, 2.0)]);
    let mut lake = polygon(&square((10.0, 10.0), 0.5));
    let by = LineSimplifier::DouglasPeucker;
    let tolerance = simplify(&mut [&mut road, &mut lake], by, Amount::Tolerance(0.2));
    assert_eq!((tolerance, road.len(), lake.len()), (Ok(0.2), 3, 4));
    let kept = simplify(&mut [&mut road], by, Amount::Keep(0.0)).expect("finite");
    assert!(kept > 0.0 && road.len() == 2);
    let mut dropped = Dropped::default();
    assert_eq!(dropped.left(lake.clone(), 0.25), Some(lake.clone()));
    assert_eq!(dropped.left(lake, 0.26), None);
    assert_eq!(dropped.left(line(&[(0.0, 0.0)]), 0.0), None);
    assert_eq!(dropped, Dropped { small_rings: 1, degenerate: 1 });
    // A hole is removed alone, and a polygon together with its outer ring.
    let rings = [square((0.0, 0.0), 4.0), square((1.0, 1.0), 0.5)].map(|ring| points(&ring));
    let left = dropped.left(Geometry::Polygon(rings.to_vec()), 1.0);
    assert_eq!(left, Some(Geometry::Polygon(vec![points(&square((0.0, 0.0), 4.0))])));
}

#[test]
fn buffers_reach_a_distance_around_all_parts() {
    let options =
        |distance| Options { distance, join: Join::Miter, cap: Cap::Square, ..Options::default() };
    let buffer = |g: &Geometry, distance| {
        of_geometry(g, WindingRule::EvenOdd, &options(distance)).expect("finite").area()
    };
    let post = Geometry::Point(points(&[(10.0, 10.0)]));
    let yard = polygon(&square((0.0, 0.0), 2.0));
    let both = Geometry::Collection(vec![yard.clone(), post.clone()]);
    assert_eq!([buffer(&post, 1.0), buffer(&yard, 1.0), buffer(&both, 1.0)], [4.0, 16.0, 20.0]);
    assert_eq!(buffer(&both, -0.5), 1.0);
}

#[test]
fn edges_go_the_long_way_unless_requested_otherwise() {
    let across = line(&[(170.0, 0.0), (-170.0, 0.0)]);
    let xs = |short| -> Vec<f64> {
        let placed = place(&across, Coordinates::LonLat, short);
        assert_eq!(placed.long, !short);
        placed.bodies[0].points().iter().map(|p| p.x * 36.0).map(f64::round).collect()
    };
    assert_eq!((xs(false), xs(true)), (vec![35.0, 1.0], vec![35.0, 37.0]));
    let around = polygon(&[(0.0, 80.0), (120.0, 80.0), (-120.0, 80.0)]);
    assert!(place(&around, Coordinates::LonLat, true).pole);
    assert!(!place(&around, Coordinates::LonLat, false).pole);
    let placed = place(&line(&[(0.0, 95.0), (1.0, 0.0)]), Coordinates::LonLat, false);
    assert!(placed.latitude && !placed.far);
    let far = place(&line(&[(0.0, 0.0), (1e9, 0.0)]), Coordinates::Mercator, false);
    assert!(far.far && far.bodies.is_empty());
    assert!(place(&line(&[]), Coordinates::LonLat, false).bodies.is_empty());
}

#[test]
fn extents_are_those_within_the_world() {
    let of = |at: &[At]| {
        let place = |&p: &At| durer::clip::tiles::mercator::project(p.into());
        let body = TileBody::Points(at.iter().map(place).collect());
        let found = extent(&[TileFeature { layer: 0, body, fill: WindingRule::EvenOdd }]);
        found.map(|e| e.map(|v| v.round()))
    };
    assert_eq!(of(&[(-10.0, 20.0), (30.0, -40.0)]), Some([-10.0, -40.0, 30.0, 20.0]));
    assert_eq!(of(&[(170.0, 0.0), (200.0, 10.0)]), Some([-180.0, 0.0, 180.0, 10.0]));
    assert_eq!(of(&[]), None);
}

#[test]
fn shapes_of_tiles_go_back_to_degrees() {
    let corners = [(0, 0), (0, 4096), (4096, 4096), (4096, 0)].map(|(x, y)| I64Vec2::new(x, y));
    let tile = Tile { zoom: 1, x: 1, y: 0 };
    let degrees = GridShape::Areas(Shapes::from_rings([corners])).in_degrees(tile, 4096);
    let bounds = degrees.bounds().expect("a place");
    assert_eq!([bounds.min().x, bounds.min().y, bounds.max().x], [0.0, 0.0, 180.0]);
    assert_eq!(bounds.max().y.round(), 85.0);
    let one = GridShape::Points(vec![corners[0]]).in_degrees(tile, 4096);
    assert_eq!(one.name(), "Point");
}

#[test]
fn tiles_cut_geometries_as_they_are() {
    let road = line(&[(-10.0, 50.0), (10.0, 50.0), (10.0, -50.0)]);
    let tiling = Tiling::new(1, Coordinates::LonLat);
    let subjects = [Subject::new(&tiling, 7, &road, Rules::default())];
    let mut found = Vec::new();
    let take = |tile: Tile, parts: Vec<(usize, Geometry)>| {
        found.extend(parts.into_iter().map(|(index, part)| (tile.x, tile.y, index, part.len())));
        Ok::<(), durer::Error>(())
    };
    tiling.visit(&subjects, |_, parts| parts, take).expect("finite");
    found.sort_unstable();
    assert_eq!(found, [(0, 0, 7, 2), (1, 0, 7, 3), (1, 1, 7, 2)]);
    assert_eq!((subjects[0].index(), subjects[0].is_repaired(), tiling.failed()), (7, false, None));
    assert!(tiling.count(&subjects, 100).is_ok_and(|count| (3..=4).contains(&count)));
    assert_eq!(tiling.reach(&road), Reach::Within);
    assert_eq!(tiling.reach(&line(&[(0.0, 0.0), (0.0, 89.0)])), Reach::BeyondLatitudes);
    assert_eq!(tiling.reach(&line(&[(0.0, 0.0), (5000.0, 0.0)])), Reach::TooFar);
}

#[test]
fn places_go_to_the_nearest_cells_halves_up() {
    let body = TileBody::Points([(0.5, -0.5), (1.4, -1.5), (0.49, 2.0)].map(DVec2::from).into());
    let cells = [(1, 0), (1, -1), (0, 2)].map(|(x, y)| I64Vec2::new(x, y));
    let snapped = |origin| body.snapped(origin, WindingRule::EvenOdd);
    assert_eq!(snapped(I64Vec2::ZERO), Ok(GridShape::Points(cells.into())));
    let moved = cells.map(|cell| cell - I64Vec2::new(3, -1));
    assert_eq!(snapped(I64Vec2::new(3, -1)), Ok(GridShape::Points(moved.into())));
}
