//! Coverages remain coverages: common borders are cut alike.

use durer::clip::polygon::rectangle::Prepared;
use durer::clip::polygon::validity::{Touching, is_valid};
use durer::clip::polygon::{BooleanOp, Shapes, WindingRule, coverage};
use durer::clip::polyline;
use durer::math::{DVec2, orient2d_value};
use durer::trace::NoTrace;
use proptest::prelude::*;
use std::collections::HashMap;

/// Pseudo-random numbers.
struct Random(u64);

impl Random {
    fn unit(&mut self) -> f64 {
        let step = (6_364_136_223_846_793_005, 1_442_695_040_888_963_407);
        self.0 = self.0.wrapping_mul(step.0).wrapping_add(step.1);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn below(&mut self, count: usize) -> usize {
        ((self.unit() * count as f64) as usize).min(count - 1)
    }
}

/// Parcels: polygons with common vertices, by their indices.
struct Layer {
    points: Vec<DVec2>,
    cells: Vec<Vec<usize>>,
}

impl Layer {
    /// Creates a square that is divided repeatedly by chords from edge to edge; the cell beyond an edge gets the vertex
    /// at which a chord ends.
    fn new(random: &mut Random, parts: usize) -> Self {
        let points = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(DVec2::from).to_vec();
        let mut layer = Self { points, cells: vec![vec![0, 1, 2, 3]] };
        for _ in 0..parts {
            let cell = random.below(layer.cells.len());
            let count = layer.cells[cell].len();
            let from = random.below(count);
            let to = (from + 1 + random.below(count - 1)) % count;
            let [a, b] = [from, to].map(|k| {
                let ring = &layer.cells[cell];
                (ring[k], ring[(k + 1) % count])
            });
            let straight = |layer: &Self| {
                let p = |i: usize| layer.points[i];
                let turns = [a.1, b.0, b.1].map(|i| orient2d_value(p(a.0), p(a.1), p(i)).abs());
                turns.iter().all(|turn| *turn < 1e-9)
            };
            if straight(&layer) {
                continue;
            }
            let [p, q] = [a, b].map(|(u, v)| {
                let t = 0.2 + 0.6 * random.unit();
                layer.divide(u, v, t)
            });
            layer.part(cell, p, q);
        }
        layer
    }

    /// Returns a new vertex on an edge, in both cells that have it.
    fn divide(&mut self, u: usize, v: usize, t: f64) -> usize {
        let new = self.points.len();
        self.points.push(self.points[u] + (self.points[v] - self.points[u]) * t);
        for ring in &mut self.cells {
            let count = ring.len();
            let edge = (0..count).find(|&k| {
                let ends = (ring[k], ring[(k + 1) % count]);
                ends == (u, v) || ends == (v, u)
            });
            if let Some(k) = edge {
                ring.insert(k + 1, new);
            }
        }
        new
    }

    fn part(&mut self, cell: usize, p: usize, q: usize) {
        let mut ring = self.cells[cell].clone();
        let place = |ring: &[usize], of: usize| ring.iter().position(|&i| i == of).unwrap();
        let first = place(&ring, p);
        ring.rotate_left(first);
        let second = place(&ring, q);
        let other = ring[second..].iter().copied().chain([p]).collect();
        ring.truncate(second + 1);
        self.cells[cell] = ring;
        self.cells.push(other);
    }

    /// Returns the layer moved and scaled.
    fn moved(mut self, size: f64, origin: DVec2) -> Self {
        self.points.iter_mut().for_each(|p| *p = origin + *p * size);
        self
    }

    fn shapes(&self) -> Vec<Shapes> {
        let ring = |cell: &Vec<usize>| cell.iter().map(|&i| self.points[i]).collect::<Vec<_>>();
        self.cells.iter().map(|cell| Shapes::from_rings([ring(cell)])).collect()
    }
}

/// Returns a star around a position in the layer; some of its corners are vertices of the layer.
fn star(random: &mut Random, layer: &Layer, size: f64, corners: usize) -> Shapes {
    let low = layer.points[0];
    let center = low + DVec2::new(random.unit(), random.unit()) * size;
    let turn = random.unit();
    let mut ring: Vec<DVec2> = (0..corners)
        .map(|i| {
            let angle = std::f64::consts::TAU * (i as f64 + turn) / corners as f64;
            let far = size * (0.1 + 0.7 * random.unit());
            center + DVec2::new(libm::cos(angle), libm::sin(angle)) * far
        })
        .collect();
    if random.below(3) == 0 {
        // Towards a vertex, and exactly to it.
        let k = random.below(corners);
        ring[k] = layer.points[random.below(layer.points.len())];
    }
    Shapes::from_rings([ring])
}

/// Positions of large coordinates, and the sizes of layers there.
const PLACES: [(f64, f64); 5] = [
    (0.0, 0.0),
    (13.377_704, 52.516_272),
    (-170.1, -80.3),
    (389_955.3, 5_819_699.1),
    (2.6e6, -1.2e6),
];

struct Case {
    layer: Layer,
    mask: Shapes,
    size: f64,
    /// Distance by which rounding may move a point.
    ulp: f64,
}

/// Returns the first case, from a seed on, whose polygons are valid.
fn case(seed: u64, corners: usize) -> Case {
    let found = (0..64).find_map(|step| valid_case(seed.wrapping_add(step), corners));
    found.expect("six of seven are valid")
}

fn valid_case(seed: u64, corners: usize) -> Option<Case> {
    let random = &mut Random(seed);
    let (x, y) = PLACES[random.below(PLACES.len())];
    let finest = (f64::max(x.abs(), y.abs()) * 1e-9).max(1e-6);
    let size = finest * 10f64.powf(random.unit() * (1e6 / finest).log10());
    let parts = 3 + random.below(30);
    let layer = Layer::new(random, parts).moved(size, DVec2::new(x, y));
    let count = 3 + random.below(corners);
    let mask = star(random, &layer, size, count);
    let farthest = layer.points.iter().chain(mask.points()).map(|p| p.abs().max_element());
    let ulp = farthest.fold(0.0, f64::max) * f64::EPSILON;
    let valid = |shapes: &Shapes| is_valid(shapes, Touching::AtPoints);
    (valid(&mask) && layer.shapes().iter().all(valid)).then_some(Case { layer, mask, size, ulp })
}

fn cut(shapes: &Shapes, mask: &Prepared, op: BooleanOp) -> coverage::CoverageCut {
    coverage::cut(shapes, mask, op, &Default::default()).expect("finite")
}

type Edge = [DVec2; 2];

/// Returns the edges that occur in no other polygon in the opposite direction.
fn unmatched(all: &[Shapes]) -> Vec<Edge> {
    let key = |p: DVec2| [p.x.to_bits(), p.y.to_bits()];
    let mut open: HashMap<[[u64; 2]; 2], Edge> = HashMap::new();
    for ring in all.iter().flat_map(Shapes::rings) {
        for (&a, &b) in ring.iter().zip(ring.iter().cycle().skip(1)) {
            if open.remove(&[key(b), key(a)]).is_none() {
                open.insert([key(a), key(b)], [a, b]);
            }
        }
    }
    open.into_values().collect()
}

fn edges(shapes: &Shapes) -> impl Iterator<Item = Edge> + '_ {
    let of_ring = |ring: &'_ [DVec2]| -> Vec<Edge> {
        ring.iter().zip(ring.iter().cycle().skip(1)).map(|(&a, &b)| [a, b]).collect()
    };
    shapes.rings().flat_map(of_ring)
}

fn lies_on(p: DVec2, [a, b]: Edge, ulp: f64) -> bool {
    let beside = p.cmpge(a.min(b) - 4.0 * ulp).all() && p.cmple(a.max(b) + 4.0 * ulp).all();
    beside && orient2d_value(a, b, p).abs() <= 4.0 * ulp * a.distance(b)
}

/// Returns whether an edge without a neighbour is where it may have none: on an edge of the mask or of the layer's
/// border, or between two corners of the mask so close that they count as one.
fn is_outer(edge: Edge, borders: &[Edge], ulp: f64) -> bool {
    borders.iter().any(|&border| edge.iter().all(|&p| lies_on(p, border, ulp)))
        || edge[0].distance(edge[1]) <= 8.0 * ulp
}

fn check(case: &Case) -> Result<(), TestCaseError> {
    let mask = Prepared::new(case.mask.clone()).expect("finite");
    let cells = case.layer.shapes();
    let mut borders = unmatched(&cells);
    borders.extend(edges(&case.mask));
    let mut areas = [0.0; 2];
    for (k, op) in [BooleanOp::Intersection, BooleanOp::Difference].into_iter().enumerate() {
        let cuts: Vec<coverage::CoverageCut> =
            cells.iter().map(|cell| cut(cell, &mask, op)).collect();
        let parts: Vec<Shapes> = cuts.iter().map(|cut| cut.shapes.clone()).collect();
        for (cut, cell) in cuts.iter().zip(&cells) {
            prop_assert!(is_valid(&cut.shapes, Touching::AtPoints), "{:?}", cut.shapes);
            prop_assert!(!cut.whole || cut.shapes.area() == cell.area() || cut.snapped == 0);
            let again = self::cut(&cut.shapes, &mask, op);
            prop_assert!(again.whole || cut.shapes.is_empty(), "{op}: {cut:?} {again:?}");
            let other = if k == 0 { BooleanOp::Difference } else { BooleanOp::Intersection };
            let nothing = self::cut(&cut.shapes, &mask, other).shapes.area();
            prop_assert!(nothing <= 8.0 * case.ulp * case.size, "{op}: {nothing}");
        }
        for edge in unmatched(&parts) {
            prop_assert!(is_outer(edge, &borders, case.ulp), "{op}: {edge:?}");
        }
        areas[k] = parts.iter().map(Shapes::area).sum();
    }
    let layer: f64 = cells.iter().map(Shapes::area).sum();
    let slack = layer * 1e-12 + 40.0 * case.size * case.ulp;
    prop_assert!((areas[0] + areas[1] - layer).abs() <= slack, "{areas:?} {layer}");
    let none = Shapes::new();
    let mut whole = Shapes::new();
    cells.iter().for_each(|cell| whole.append(cell));
    let options = coverage::Options { rule: WindingRule::NonZero, ..Default::default() };
    let union = coverage::join(&whole, &none, BooleanOp::Union, &options).unwrap().shapes;
    let both = cut(&union, &mask, BooleanOp::Intersection).shapes.area();
    prop_assert!((both - areas[0]).abs() <= slack, "{both} {areas:?}");
    Ok(())
}

/// Returns the number of cases; the variable PROPTEST_CASES can raise it.
pub fn cases(usual: u32) -> u32 {
    let requested = std::env::var("PROPTEST_CASES").ok();
    requested.and_then(|count| count.parse().ok()).unwrap_or(usual)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(150)))]

    #[test]
    fn parcels_cut_by_slanted_masks_are_a_coverage(seed in any::<u64>()) {
        check(&case(seed, 24))?;
    }

    #[test]
    fn lines_end_where_polygons_are_cut(seed in any::<u64>()) {
        let case = case(seed, 12);
        let mask = Prepared::new(case.mask.clone()).expect("finite");
        let borders: Vec<Edge> = edges(&case.mask).collect();
        for cell in case.layer.shapes() {
            let mut line = cell.points().to_vec();
            line.push(line[0]);
            let inside = cut(&cell, &mask, BooleanOp::Intersection).shapes;
            let part = |part, line: &[DVec2]| {
                let options = polyline::Options { part };
                polyline::clip_prepared(&mask, line, &[line.len()], &options, &mut NoTrace).unwrap()
            };
            let lines = part(polyline::KeptPart::Inside, &line);
            for point in inside.points() {
                let corner = case.mask.points().contains(point);
                prop_assert!(corner || lines.points.contains(point), "{point} {inside:?} {lines:?}");
            }
            for (_, piece) in lines.pieces() {
                let again = part(polyline::KeptPart::Inside, piece);
                prop_assert_eq!(&again.points[..], piece, "{:?} {:?}", line, case.mask);
                // The remainder on the other side is on the border.
                for point in part(polyline::KeptPart::Outside, piece).points {
                    prop_assert!(borders.iter().any(|&border| lies_on(point, border, case.ulp)));
                }
            }
        }
    }
}

#[test]
fn masks_of_many_corners_leave_a_coverage() {
    let corners = if cfg!(debug_assertions) { 20_000 } else { 100_000 };
    let random = &mut Random(7);
    let layer = Layer::new(random, 60).moved(1000.0, DVec2::new(389_955.3, 5_819_699.1));
    let center = layer.points[0] + DVec2::splat(500.0);
    let ring: Vec<DVec2> = (0..corners)
        .map(|i| {
            let angle = std::f64::consts::TAU * f64::from(i) / f64::from(corners);
            let far = 300.0 + 100.0 * libm::sin(9.0 * angle) + 0.01 * random.unit();
            center + DVec2::new(libm::cos(angle), libm::sin(angle)) * far
        })
        .collect();
    let mask = Shapes::from_rings([ring]);
    assert!(is_valid(&mask, Touching::No));
    let prepared = Prepared::new(mask.clone()).unwrap();
    let cells = layer.shapes();
    let parts: Vec<Shapes> =
        cells.iter().map(|cell| cut(cell, &prepared, BooleanOp::Intersection).shapes).collect();
    let total: f64 = parts.iter().map(Shapes::area).sum();
    assert!((total - mask.area()).abs() < 1e-12 * total + 1e-3, "{total} {}", mask.area());
    let corner: HashMap<[u64; 2], ()> =
        mask.points().iter().map(|p| ([p.x.to_bits(), p.y.to_bits()], ())).collect();
    let inner = unmatched(&parts).into_iter().filter(|edge| {
        let known = |p: &DVec2| corner.contains_key(&[p.x.to_bits(), p.y.to_bits()]);
        !edge.iter().any(known) && edge[0].distance(edge[1]) > 1.0
    });
    assert_eq!(inner.collect::<Vec<_>>(), Vec::<Edge>::new());
}

/// Checks that a feature of 1e-8 degrees below a mask around the world keeps its area.
#[test]
fn tiny_features_keep_their_area_under_a_large_mask() {
    let p = DVec2::new;
    let mask = [
        p(-180.0, -90.0),
        p(180.0, -90.0),
        p(180.0, 52.516_272_004_99),
        p(-180.0, 52.516_272_005_01),
    ];
    let mask = Prepared::new(Shapes::from_rings([mask])).unwrap();
    let (x, y, d) = (13.377_704, 52.516_272, 1e-8);
    let square = Shapes::from_rings([[p(x, y), p(x + d, y), p(x + d, y + d), p(x, y + d)]]);
    let inside = cut(&square, &mask, BooleanOp::Intersection);
    let outside = cut(&square, &mask, BooleanOp::Difference);
    let total = inside.shapes.area() + outside.shapes.area();
    assert!((total / square.area() - 1.0).abs() < 1e-6);
    assert!(inside.shapes.area() > 0.3 * total && outside.shapes.area() > 0.3 * total);
}

/// Checks a spike along an edge, whose foot is a rounding error away from the edge.
#[test]
fn spikes_that_end_a_rounding_beside_an_edge_leave_nothing() {
    let p = DVec2::new;
    let foot = p(1.0, 1.0 / 3.0);
    let spiked = Shapes::from_rings([[p(0.0, 0.0), p(3.0, 1.0), foot, p(1.0, 5.0), p(-1.0, 5.0)]]);
    let options = coverage::Options { mend: true, ..Default::default() };
    let whole = coverage::join(&spiked, &Shapes::new(), BooleanOp::Union, &options).unwrap();
    let left = Shapes::from_rings([[p(-1.0, 5.0), p(0.0, 0.0), foot, p(1.0, 5.0)]]);
    assert_eq!(whole.shapes, left);
}

/// Checks the border of Sudan in Natural Earth's map 1:110 million: a spike along the border with Ethiopia ends some
/// ulps beside that border, so that the ring crosses itself.
#[test]
fn spikes_that_end_some_ulp_beside_an_edge_leave_no_sliver() {
    let p = DVec2::new;
    let (top, tip) = (p(33.96162, 9.58358), p(33.97498, 8.68456));
    let foot = p(33.963392794971185, 9.464285229420625);
    let west = [
        p(33.82496348090751, 9.484060845715362),
        p(33.84213085302815, 9.981914637215993),
        p(33.72195924818311, 10.325262079630193),
    ];
    let north = p(34.25745, 10.63009);
    let sudan = Shapes::from_rings([[north, top, tip, foot, west[0], west[1], west[2]]]);
    assert!(!is_valid(&sudan, Touching::AtPoints));
    let mask = Shapes::from_rings([[p(20., 0.), p(50., 5.), p(45., 30.), p(18., 20.)]]);
    let mask = Prepared::new(mask).unwrap();
    let options = coverage::Options { mend: true, ..Default::default() };
    let cut = coverage::cut(&sudan, &mask, BooleanOp::Intersection, &options).unwrap();
    let expected = [west[2], west[1], west[0], foot, top, north];
    let low = (0..6).min_by(|&i, &j| expected[i].x.total_cmp(&expected[j].x)).unwrap();
    let mut expected = expected.to_vec();
    expected.rotate_left(low);
    assert_eq!(cut.shapes, Shapes::from_rings([expected]));
    let nothing = coverage::cut(&sudan, &mask, BooleanOp::Difference, &options).unwrap();
    assert!(nothing.shapes.is_empty(), "{nothing:?}");
}
