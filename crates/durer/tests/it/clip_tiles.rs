//! Features in tiles: valid on the grid, within their windows, the same on any number of threads.

use durer::clip::polygon::validity::flaws;
use durer::clip::polygon::{Shapes, WindingRule};
use durer::clip::tiles::{GridShape, Options, Pyramid, Tile, TileBody, TileFeature, TilePiece};
use durer::math::{DVec2, I64Vec2};
use durer::{Error, Result};
use proptest::prelude::*;

fn tiles(features: Vec<TileFeature>, options: &Options) -> Result<Vec<(Tile, Vec<TilePiece>)>> {
    let pyramid = Pyramid::new(features, options.clone())?;
    let mut found = Vec::new();
    for zoom in options.zooms.clone() {
        pyramid.visit(
            zoom,
            |_, pieces| pieces,
            |tile, pieces| {
                found.push((tile, pieces));
                Ok::<_, Error>(())
            },
        )?;
    }
    assert!(pyramid.count(u64::MAX)? >= found.len() as u64);
    // A limit stops the count early only if there are at least as many tiles.
    assert!(found.is_empty() || pyramid.count(found.len() as u64 - 1)? >= found.len() as u64);
    Ok(found)
}

fn on_threads<R: Send>(count: usize, work: impl FnOnce() -> R + Send) -> R {
    rayon::ThreadPoolBuilder::new().num_threads(count).build().unwrap().install(work)
}

fn places() -> impl Strategy<Value = Vec<DVec2>> {
    // Some are outside the world, many on the borders of tiles.
    let place = (-10i32..26, -2i32..18).prop_map(|(x, y)| DVec2::new(x.into(), y.into()) / 16.0);
    prop::collection::vec(place, 1..12)
}

fn features() -> impl Strategy<Value = Vec<TileFeature>> {
    let body = (0..3, places(), places()).prop_map(|(kind, points, others)| match kind {
        0 => TileBody::Points(points),
        1 => {
            let ends = vec![points.len(), points.len() + others.len()];
            TileBody::Lines { points: [points, others].concat(), ends }
        }
        _ => TileBody::Areas(Shapes::from_rings([points, others])),
    });
    let feature = (0..2usize, body).prop_map(|(layer, body)| TileFeature {
        layer,
        body,
        fill: WindingRule::EvenOdd,
    });
    prop::collection::vec(feature, 0..6)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(crate::coverage::cases(200)))]

    #[test]
    fn shapes_are_valid_and_within_their_tiles(
        features in features(),
        (extent, buffer, tiny) in (2u32..40, 0u32..2, 0u32..3),
    ) {
        let options = Options { zooms: 0..=3, extent, buffer, tiny: tiny.into(), ..Options::default() };
        let found = on_threads(1, || tiles(features.clone(), &options)).unwrap();
        prop_assert_eq!(&found, &on_threads(4, || tiles(features, &options)).unwrap());
        prop_assert!(found.windows(2).all(|pair| pair[0].0.id() < pair[1].0.id()));
        let (low, high) = (-i64::from(buffer), i64::from(extent + buffer));
        let inside = |p: &I64Vec2| p.min_element() >= low && p.max_element() <= high;
        for piece in found.iter().flat_map(|(_, pieces)| pieces) {
            match &piece.shape {
                GridShape::Points(points) => prop_assert!(!points.is_empty() && points.iter().all(inside)),
                GridShape::Lines(lines) => {
                    prop_assert!(lines.iter().flatten().all(inside));
                    prop_assert!(lines.iter().all(|l| l.len() > 1 && l.windows(2).all(|w| w[0] != w[1])));
                }
                GridShape::Areas(shapes) => {
                    prop_assert!(shapes.points().iter().all(inside) && shapes.area() > 0.0);
                    let points = |ring: &[I64Vec2]| ring.iter().map(|p| p.as_dvec2()).collect::<Vec<_>>();
                    let mut whole = Shapes::new();
                    for polygon in shapes.polygons() {
                        polygon.rings().for_each(|ring| whole.push_ring(points(ring)));
                        whole.end_polygon();
                    }
                    prop_assert_eq!(flaws(&whole).unwrap(), []);
                }
            }
        }
    }
}

fn square(x: f64, y: f64, side: f64) -> TileFeature {
    let corners =
        [(0., 0.), (side, 0.), (side, side), (0., side)].map(|(u, v)| DVec2::new(x + u, y + v));
    TileFeature {
        layer: 0,
        body: TileBody::Areas(Shapes::from_rings([corners])),
        fill: WindingRule::EvenOdd,
    }
}

#[test]
fn areas_are_divided_among_tiles() {
    let options = Options { zooms: 0..=4, buffer: 0, tiny: 0.0, ..Options::default() };
    let found = tiles(vec![square(0.3, 0.2, 0.45)], &options).unwrap();
    for zoom in 0..=4u8 {
        let side = 4096.0 * f64::from(1 << zoom);
        let area = |piece: &TilePiece| match &piece.shape {
            GridShape::Areas(shapes) => shapes.area(),
            _ => 0.0,
        };
        let level = found.iter().filter(|(tile, _)| tile.zoom == zoom);
        let all: f64 = level.flat_map(|(_, pieces)| pieces).map(area).sum();
        assert!((all / side / side - 0.45 * 0.45).abs() < 2e-4 / f64::from(1 << zoom), "{zoom}");
    }
}

#[test]
fn a_pyramid_with_fewer_levels_has_the_tiles_of_one_made_with_them() {
    // A wave whose points appear level by level.
    let point =
        |i: u32| DVec2::new(0.1 + f64::from(i) / 400.0, 0.5 + (f64::from(i) * 1.3).sin() / 500.0);
    let wave = TileFeature {
        layer: 0,
        body: TileBody::Lines { points: (0..300).map(point).collect(), ends: vec![300] },
        fill: WindingRule::EvenOdd,
    };
    let options = Options { zooms: 0..=6, ..Options::default() };
    let mut reduced = Pyramid::new(vec![wave.clone()], options.clone()).unwrap();
    reduced.reduce(20).unwrap();
    assert!(reduced.count(u64::MAX).unwrap() <= 20);
    let zooms = reduced.zooms();
    assert!(*zooms.end() > 1 && *zooms.end() < 6, "{zooms:?}");
    let made = Pyramid::new(vec![wave], Options { zooms: zooms.clone(), ..options }).unwrap();
    for zoom in zooms {
        let tiles = |pyramid: &Pyramid| {
            let mut found = Vec::new();
            let take = |tile, pieces| {
                found.push((tile, pieces));
                Ok::<_, Error>(())
            };
            pyramid.visit(zoom, |_, pieces| pieces, take).unwrap();
            found
        };
        assert!(!tiles(&made).is_empty());
        assert_eq!(tiles(&reduced), tiles(&made), "{zoom}");
    }
}

#[test]
fn buffers_reach_around_the_world() {
    let options = Options { zooms: 1..=1, ..Options::default() };
    let found = tiles(vec![square(0.0, 0.1, 0.001)], &options).unwrap();
    let names: Vec<String> = found.iter().map(|(tile, _)| tile.to_string()).collect();
    assert_eq!(names, ["1/0/0", "1/1/0"]);
    let GridShape::Areas(shapes) = &found[1].1[0].shape else { panic!("an area") };
    assert_eq!(shapes.bounds_of_whole(), (4096, 4104));
}

trait Whole {
    fn bounds_of_whole(&self) -> (i64, i64);
}

impl Whole for Shapes<I64Vec2> {
    /// Returns the smallest and the largest x.
    fn bounds_of_whole(&self) -> (i64, i64) {
        let x = || self.points().iter().map(|p| p.x);
        (x().min().unwrap(), x().max().unwrap())
    }
}

#[test]
fn what_cannot_be_tiled_is_named() {
    let far =
        TileFeature { body: TileBody::Points(vec![DVec2::splat(1e300)]), ..square(0.0, 0.0, 1.0) };
    let odd = TileFeature { body: TileBody::Points(vec![DVec2::NAN]), ..far.clone() };
    let new =
        |feature: TileFeature, options: Options| Pyramid::new(vec![feature], options).map(drop);
    assert!(matches!(new(far, Options::default()), Err(Error::Parameter { name: "place", .. })));
    assert!(matches!(new(odd, Options::default()), Err(Error::NonFinite { .. })));
    let base = Options::default();
    #[expect(clippy::reversed_empty_ranges)]
    let backwards = 5..=3;
    for (name, options) in [
        ("zoom", Options { zooms: backwards, ..base.clone() }),
        ("zoom", Options { zooms: 0..=25, ..base.clone() }),
        ("extent", Options { extent: 0, ..base.clone() }),
        ("buffer", Options { buffer: 4096, ..base.clone() }),
        ("tolerance", Options { tolerance: f64::NAN, ..base.clone() }),
        ("tiny", Options { tiny: -1.0, ..base.clone() }),
    ] {
        let found = new(square(0.0, 0.0, 1.0), options);
        assert!(
            matches!(found, Err(Error::Parameter { name: n, .. }) if n == name),
            "{name}: {found:?}"
        );
    }
}
