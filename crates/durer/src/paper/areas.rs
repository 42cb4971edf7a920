//! Borders of regions as curves on paper. Shared borders are fitted once, so neighbours still share them, bit for bit.

use super::fitted::{is_as_it_was, key};
use super::onto_paper;
use crate::curve::fit::{self, Fitted, Options, Polyline};
use crate::math::DVec2;
use crate::parallel;
use crate::target::drawing::Region;
use crate::target::{Curve, CurvePiece};
use std::collections::BTreeMap;

/// Returns the borders of each region as curves, in millimetres on paper, all within `tolerance` millimetres, or as an
/// arc through corners leaves its chords; `None` for regions without round borders.
///
/// Points where more than two pieces of borders meet keep their coordinates, bit for bit. A border that continues
/// straight there is fitted as a whole, so that the rim of a faceted cylinder is round, whatever the shades of its
/// facets.
pub(super) fn borders(
    regions: &[Region],
    origin: DVec2,
    factor: f64,
    tolerance: f64,
) -> Vec<Option<Vec<Curve>>> {
    let network = Network::new(regions, |p| onto_paper(p, origin, factor));
    let mut chains = Chains::default();
    let rings: Vec<Vec<Vec<Link>>> = regions
        .iter()
        .map(|r| r.rings.iter().map(|ring| chains.links(&network, ring)).collect())
        .collect();
    let rows = chains.rows(&network);
    let fitted = parallel::map(rows, |row| chains.fitted(&network, &row, tolerance));
    let mut curves: Vec<Option<Curve>> = vec![None; chains.all.len()];
    for (chain, curve) in fitted.into_iter().flatten() {
        curves[chain] = Some(curve);
    }
    let region = |rings: Vec<Vec<Link>>| {
        let is_round = rings.iter().flatten().any(|link| curves[link.chain].is_some());
        let ring = |links: &Vec<Link>| chains.joined(&network, links, &curves);
        is_round.then(|| rings.iter().filter_map(ring).collect())
    };
    rings.into_iter().map(region).collect()
}

/// A chain of a ring, and whether it is run through from its end.
#[derive(Clone, Copy)]
struct Link {
    chain: usize,
    back: bool,
}

/// The points of all rings, each once, and the edges that leave them.
struct Network {
    /// Sorted by their bits.
    keys: Vec<[u64; 2]>,
    /// Places on paper.
    places: Vec<DVec2>,
    /// For each point where in `next` those begin that it is joined to.
    starts: Vec<usize>,
    next: Vec<u32>,
}

/// No point.
const NONE: u32 = u32::MAX;

/// The cosine of 30°: borders that turn further end.
const STRAIGHT: f64 = 0.866;

impl Network {
    fn new(regions: &[Region], on_paper: impl Fn(DVec2) -> DVec2) -> Self {
        let rings = || regions.iter().flat_map(|r| &r.rings);
        let mut keys: Vec<[u64; 2]> = rings().flatten().map(|p| key(*p)).collect();
        keys.sort_unstable();
        keys.dedup();
        let place = |bits: &[u64; 2]| on_paper(DVec2::from_array(bits.map(f64::from_bits)));
        let places = keys.iter().map(place).collect();
        let mut network = Self { keys, places, starts: Vec::new(), next: Vec::new() };
        let mut pairs: Vec<[u32; 2]> = Vec::new();
        for ring in rings() {
            let ids = network.ids(ring);
            for (i, id) in ids.iter().enumerate() {
                let after = ids[(i + 1) % ids.len()];
                pairs.extend([[*id, after], [after, *id]]);
            }
        }
        pairs.sort_unstable();
        pairs.dedup();
        let start = |id: usize| pairs.partition_point(|p| (p[0] as usize) < id);
        network.starts = (0..=network.keys.len()).map(start).collect();
        network.next = pairs.iter().map(|p| p[1]).collect();
        network
    }

    fn ids(&self, ring: &[DVec2]) -> Vec<u32> {
        let id = |p: &DVec2| self.keys.binary_search(&key(*p)).map_or(NONE, |i| i as u32);
        ring.iter().map(id).collect()
    }

    fn next(&self, id: u32) -> &[u32] {
        let ends = self.starts.get(id as usize..).and_then(|s| s.first_chunk::<2>());
        ends.and_then(|[from, to]| self.next.get(*from..*to)).unwrap_or_default()
    }

    fn is_junction(&self, id: u32) -> bool {
        self.next(id).len() != 2
    }

    fn place(&self, id: u32) -> DVec2 {
        self.places.get(id as usize).copied().unwrap_or(DVec2::NAN)
    }

    /// Returns the continuation of a border that comes from one point to another: the candidate closest to straight
    /// ahead, if the same holds in the other direction.
    fn ahead(&self, from: u32, at: u32) -> Option<u32> {
        let straightest = |from: u32| {
            let come = (self.place(at) - self.place(from)).normalize_or_zero();
            let ways =
                self.next(at).iter().filter(|to| **to != from).map(|to| {
                    (come.dot((self.place(*to) - self.place(at)).normalize_or_zero()), *to)
                });
            ways.filter(|w| w.0 >= STRAIGHT).max_by(|a, b| a.0.total_cmp(&b.0)).map(|w| w.1)
        };
        straightest(from).filter(|to| straightest(*to) == Some(from))
    }
}

/// The chains between junctions, and rings without one, each once: their points, and whether they are closed.
#[derive(Default)]
struct Chains {
    all: Vec<(Vec<u32>, bool)>,
    /// Links by their first two points, from both ends.
    found: BTreeMap<[u32; 2], Link>,
}

/// Chains that go on in each other, and whether the last does in the first.
struct Row {
    links: Vec<Link>,
    closed: bool,
}

impl Chains {
    /// Returns the chains of a ring.
    fn links(&mut self, network: &Network, ring: &[DVec2]) -> Vec<Link> {
        let mut ids = network.ids(ring);
        let first = ids.iter().position(|id| network.is_junction(*id));
        let Some(first) = first else { return self.closed(ids) };
        ids.rotate_left(first);
        ids.push(ids[0]);
        let mut links = Vec::new();
        let mut from = 0;
        for to in 1..ids.len() {
            if network.is_junction(ids[to]) {
                links.push(self.link(ids[from..=to].to_vec(), false));
                from = to;
            }
        }
        links
    }

    /// Returns the link of a ring without junctions, which begins with its first point.
    fn closed(&mut self, mut ids: Vec<u32>) -> Vec<Link> {
        let least = ids.iter().enumerate().min_by_key(|(_, id)| **id).map(|(i, _)| i);
        let Some(least) = least else { return Vec::new() };
        ids.rotate_left(least);
        vec![self.link(ids, true)]
    }

    /// Returns the link of a chain, which has one direction in all rings.
    fn link(&mut self, ids: Vec<u32>, closed: bool) -> Link {
        let key = |a: Option<&u32>, b: Option<&u32>| [a, b].map(|i| i.copied().unwrap_or(NONE));
        let ahead = key(ids.first(), ids.get(1));
        let back = match closed {
            true => key(ids.first(), ids.last()),
            false => key(ids.last(), ids.iter().rev().nth(1)),
        };
        if let Some(link) = self.found.get(&ahead) {
            return *link;
        }
        let link = Link { chain: self.all.len(), back: false };
        self.found.insert(ahead, link);
        self.found.entry(back).or_insert(Link { back: true, ..link });
        self.all.push((ids, closed));
        link
    }

    /// Returns all chains, in rows that are fitted as wholes.
    fn rows(&self, network: &Network) -> Vec<Row> {
        let mut taken = vec![false; self.all.len()];
        let mut rows = Vec::new();
        for chain in 0..self.all.len() {
            if std::mem::replace(&mut taken[chain], true) {
                continue;
            }
            let first = Link { chain, back: false };
            if self.all[chain].1 {
                rows.push(Row { links: vec![first], closed: true });
                continue;
            }
            let mut links = vec![first];
            let closed = self.extend(network, &mut links, &mut taken);
            if !closed {
                // The same from the other end.
                links = turned(links);
                self.extend(network, &mut links, &mut taken);
            }
            rows.push(Row { links, closed });
        }
        rows
    }

    /// Extends a row as far as possible; returns whether it returns to its start.
    fn extend(&self, network: &Network, links: &mut Vec<Link>, taken: &mut [bool]) -> bool {
        while let Some(last) = links.last() {
            let ids = self.ids(*last);
            let [.., from, at] = ids[..] else { return false };
            let Some(to) = network.ahead(from, at) else { return false };
            let Some(next) = self.found.get(&[at, to]).copied() else { return false };
            if next.chain == links[0].chain && next.back == links[0].back {
                return true;
            }
            if std::mem::replace(&mut taken[next.chain], true) {
                return false;
            }
            links.push(next);
        }
        false
    }

    /// Returns the points of a chain in the direction of a link.
    fn ids(&self, link: Link) -> Vec<u32> {
        let (ids, closed) = &self.all[link.chain];
        match (link.back, closed) {
            (false, _) => ids.clone(),
            (true, false) => ids.iter().rev().copied().collect(),
            (true, true) => ids.iter().take(1).chain(ids.iter().skip(1).rev()).copied().collect(),
        }
    }

    /// Returns the curves of the chains of a row, in the direction of the chains, where they are
    /// round.
    fn fitted(&self, network: &Network, row: &Row, tolerance: f64) -> Vec<(usize, Curve)> {
        let mut points: Vec<DVec2> = Vec::new();
        let mut firsts = Vec::with_capacity(row.links.len());
        for link in &row.links {
            points.pop();
            firsts.push(points.len());
            points.extend(self.ids(*link).iter().map(|id| network.place(*id)));
        }
        let is_ring = row.links.first().is_some_and(|l| self.all[l.chain].1);
        if row.closed && !is_ring {
            points.pop();
        }
        let polyline = Polyline { points: &points, closed: row.closed, kept: &[] };
        let found = fit::fit(polyline, |_, _| false, Options { tolerance, round: true });
        let found = found.filter(|f| !is_as_it_was(&f.curve, points.len()));
        let Some(found) = found else { return Vec::new() };
        if let ([link], true) = (&row.links[..], is_ring) {
            return vec![(link.chain, found.curve)];
        }
        let row_of = RowCurve { points: &points, closed: row.closed, fitted: &found, tolerance };
        let part = |(link, first): (&Link, usize)| {
            let steps = self.all[link.chain].0.len() - 1;
            let curve = row_of.part(first, steps).filter(|c| !c.is_straight())?;
            Some((link.chain, if link.back { curve.reversed() } else { curve }))
        };
        row.links.iter().zip(firsts).filter_map(part).collect()
    }

    /// Returns the ring of some chains.
    fn joined(&self, network: &Network, links: &[Link], curves: &[Option<Curve>]) -> Option<Curve> {
        let mut ring: Option<Curve> = None;
        for link in links {
            let curve = match &curves[link.chain] {
                Some(curve) if link.back => curve.clone().reversed(),
                Some(curve) => curve.clone(),
                None => self.straight(network, *link)?,
            };
            match &mut ring {
                Some(ring) => ring.pieces.extend(curve.pieces),
                None => ring = Some(Curve { closed: true, ..curve }),
            }
        }
        ring
    }

    fn straight(&self, network: &Network, link: Link) -> Option<Curve> {
        let ids = self.ids(link);
        let again = ids.first().filter(|_| self.all[link.chain].1);
        let mut points = ids.iter().chain(again).map(|id| network.place(*id));
        let start = points.next()?;
        Some(Curve { start, pieces: points.map(CurvePiece::Line).collect(), closed: false })
    }
}

/// Returns the same row from its other end.
fn turned(links: Vec<Link>) -> Vec<Link> {
    links.into_iter().rev().map(|l| Link { back: !l.back, ..l }).collect()
}

/// Curve that is fitted to a row of chains.
struct RowCurve<'a> {
    points: &'a [DVec2],
    closed: bool,
    fitted: &'a Fitted,
    tolerance: f64,
}

impl RowCurve<'_> {
    fn point(&self, i: usize) -> DVec2 {
        self.points[i % self.points.len()]
    }

    /// Returns the part of the curve between two points of the polyline, this many steps from the first;
    /// `None` if one of them is not on it.
    fn part(&self, first: usize, steps: usize) -> Option<Curve> {
        let count = self.points.len();
        let shift = if self.closed { *self.fitted.from.first()? } else { 0 };
        let from = (first + count - shift) % count;
        let to = from + steps;
        let starts: Vec<usize> =
            self.fitted.from.iter().map(|i| (i + count - shift) % count).collect();
        let end = if self.closed { count } else { count - 1 };
        let ends = starts.iter().skip(1).copied().chain([end]);
        let rounds = if self.closed { 2 } else { 1 };
        let mut pieces = Vec::new();
        for round in 0..rounds {
            for ((start, end), piece) in
                starts.iter().zip(ends.clone()).zip(&self.fitted.curve.pieces)
            {
                let (start, end) = (start + round * count, end + round * count);
                let (low, high) = (start.max(from), end.min(to));
                if low < high {
                    let ends = [low, high].map(|i| self.point(i + shift));
                    pieces.push(self.cut(piece, (low, high) == (start, end), ends)?);
                }
            }
        }
        Some(Curve { start: self.point(from + shift), pieces, closed: false })
    }

    /// Returns a part of a piece.
    fn cut(
        &self,
        piece: &CurvePiece,
        is_whole: bool,
        [start, end]: [DVec2; 2],
    ) -> Option<CurvePiece> {
        match piece {
            _ if is_whole => Some(*piece),
            CurvePiece::Line(_) => Some(CurvePiece::Line(end)),
            CurvePiece::Arc(arc, _) => {
                fit::between(arc, start, end, self.tolerance).map(|arc| CurvePiece::Arc(arc, end))
            }
            CurvePiece::Cubic(..) => None,
        }
    }
}
