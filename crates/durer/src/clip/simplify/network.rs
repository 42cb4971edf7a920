//! Lines and rings as one network: points that are at the same place are one, and points where lines part, meet
//! or end are its nodes.

use super::removal::{Links, NONE};
use crate::math::DVec2;
use std::collections::BTreeSet;

/// Lines and rings as one network of places.
#[derive(Debug, Clone, Default)]
pub struct Network {
    /// The places, each once, by x and then by y.
    pub places: Vec<DVec2>,
    /// The place of each point, chain after chain.
    pub place_of: Vec<u32>,
    /// The neighbours of places that are not nodes.
    pub links: Links,
    /// Edges between two nodes, the smaller one first.
    pub direct: BTreeSet<[u32; 2]>,
}

/// Range of a chain among the points, and whether its last point is joined to its first.
#[derive(Debug, Clone)]
pub struct Chain {
    pub points: std::ops::Range<usize>,
    pub closed: bool,
}

impl Network {
    /// Creates the network of some chains.
    pub fn new(points: &[DVec2], chains: &[Chain]) -> Self {
        let (places, place_of) = merged(points);
        let mut network =
            Self { places, place_of, links: Links::default(), direct: BTreeSet::new() };
        let mut seen = vec![Seen::Never; network.places.len()];
        for chain in chains {
            let walk = network.walk(chain);
            let count = walk.len();
            let ring = chain.closed && count > 2;
            for (at, &place) in walk.iter().enumerate() {
                let inner = ring || (at > 0 && at + 1 < count);
                let beside = || [walk[(at + count - 1) % count], walk[(at + 1) % count]];
                seen[place as usize].add(inner.then(beside));
            }
        }
        network.links = Links(seen.into_iter().map(Seen::links).collect());
        let links = std::mem::take(&mut network.links);
        chains.iter().for_each(|chain| network.note_direct(&links, chain));
        Self { links, ..network }
    }

    /// Returns the places of a chain without repetitions; the first place of a closed chain is not repeated at the end.
    pub fn walk(&self, chain: &Chain) -> Vec<u32> {
        let mut walk = self.place_of.get(chain.points.clone()).unwrap_or_default().to_vec();
        walk.dedup();
        while chain.closed && walk.len() > 1 && walk.first() == walk.last() {
            walk.pop();
        }
        walk
    }

    /// Records the edges of a chain between two places that stay.
    pub fn note_direct(&mut self, links: &Links, chain: &Chain) {
        let walk = self.walk(chain);
        let again = chain.closed.then(|| walk.first().copied()).flatten();
        let next = walk.iter().copied().skip(1).chain(again);
        for (a, b) in walk.iter().copied().zip(next) {
            if !links.is_free(a) && !links.is_free(b) {
                self.direct.insert([a.min(b), a.max(b)]);
            }
        }
    }

    /// Returns whether two places are joined by an edge that does not lead over a third one, where `links`
    /// are the present neighbours.
    pub fn are_joined(&self, links: &Links, over: u32, [a, c]: [u32; 2]) -> bool {
        let beside = |at: u32, wanted: u32| {
            let pair = links.of(at);
            let other = if pair[0] == over { pair[1] } else { pair[0] };
            other == wanted
        };
        match (links.is_free(a), links.is_free(c)) {
            (true, _) => beside(a, c),
            (_, true) => beside(c, a),
            _ => self.direct.contains(&[a.min(c), a.max(c)]),
        }
    }
}

/// Returns the places of points, each once and in order, and the place of each point.
fn merged(points: &[DVec2]) -> (Vec<DVec2>, Vec<u32>) {
    let mut keyed: Vec<(u64, u64, u32)> =
        points.iter().zip(0..).map(|(p, i)| (ordered(p.x), ordered(p.y), i)).collect();
    keyed.sort_unstable();
    let (mut places, mut place_of) = (Vec::new(), vec![0; points.len()]);
    let mut last = None;
    for (x, y, i) in keyed {
        if last.replace((x, y)) != Some((x, y)) {
            places.push(points[i as usize]);
        }
        place_of[i as usize] = places.len() as u32 - 1;
    }
    (places, place_of)
}

/// Returns a whole number that is in the order of finite numbers; zeros of either sign are one.
fn ordered(value: f64) -> u64 {
    let bits = (value + 0.0).to_bits();
    if bits >> 63 == 0 { bits | 1 << 63 } else { !bits }
}

/// Knowledge about the neighbours of a place.
#[derive(Debug, Clone, Copy)]
enum Seen {
    Never,
    /// Between the same two each time, the smaller one first.
    Between([u32; 2]),
    Node,
}

impl Seen {
    fn add(&mut self, neighbours: Option<[u32; 2]>) {
        *self = match (*self, neighbours) {
            // At the tip of a spike both are the same.
            (_, None) => Self::Node,
            (_, Some([a, b])) if a == b => Self::Node,
            (Self::Never, Some([a, b])) => Self::Between([a.min(b), a.max(b)]),
            (Self::Between(pair), Some([a, b])) if pair == [a.min(b), a.max(b)] => *self,
            _ => Self::Node,
        };
    }

    fn links(self) -> [u32; 2] {
        match self {
            Self::Between(pair) => pair,
            Self::Never | Self::Node => [NONE; 2],
        }
    }
}
