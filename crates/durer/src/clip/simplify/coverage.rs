//! Lines and borders of areas simplified together: shared borders stay shared, and no new crossings arise.
//!
//! Points are removed as in the coverage simplifier of the JTS Topology Suite (Martin Davis, 2023), a restricted form
//! of Visvalingam and Whyatt's method. Object space; O(n log n) for n points on usual data.
//!
//! Points at the same place are one. A place is a node, and stays, if the lines and rings through it do not agree on
//! its neighbours or if a line ends there. All other points are removed in the order of their weights, each only if no
//! remaining point is in the triangle that it forms with its neighbours, and if these are not joined already. So a
//! network without crossings stays without crossings: an edge that crossed the new one would have to end in the
//! triangle or cross one of the two old edges. A blocked point is removed after the point that blocks it.
//!
//! It follows that rings keep three points at least, holes stay in their polygons and islands in their holes.
//! Where the input crosses itself, so may the result, there and nowhere else. Orders and sides are decided exactly.

use super::index::Index;
use super::network::{Chain, Network};
use super::removal::{Guard, Links, Measure, Obstacle, Removal};
use super::{LineSimplifier, check, douglas_peucker};
use crate::info::{Class, Info, Occluder};
use crate::math::DVec2;
use crate::trace::{PseudocodeLine, Tracer};
use crate::{Error, Result};

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "coverage",
    title: "Coverage simplification",
    authors: "Martin Davis, after Maheswari Visvalingam and James Whyatt",
    year: 2023,
    source: "JTS Topology Suite 1.20, CoverageSimplifier",
    class: Class::ObjectSpace,
    occluder: Occluder::None,
    coherence: &[],
    cost: "O(n log n) for n points on usual data",
    limits: "borders are shared where neighbours have the same points; nodes stay",
    pseudocode: &[
        "merge points at the same place",
        "nodes ← places where lines end or meet with other neighbours; they stay",
        "for each other place: weight ← √area of the triangle with its neighbours",
        "while there are such places:",
        "    P ← the place with the smallest weight",
        "    if its weight > limit: stop",
        "    if a place lies in its triangle, or its neighbours are joined already:",
        "        P waits until one of them changes",
        "    else: remove P from all lines and rings that pass it",
        "        compute the weights of its two neighbours anew",
    ],
};

/// Options for simplifying lines and rings together.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// Method that orders points.
    pub method: LineSimplifier,
    /// Points of a larger weight are ignored and weigh infinitely; infinite for all weights. In units of the
    /// coordinates. Smaller limits take less time.
    pub limit: f64,
}

/// Step of the algorithm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step {
    /// A place is left out of all lines and rings.
    Removed {
        /// The place.
        at: DVec2,
        /// Its weight.
        weight: f64,
    },
}

impl PseudocodeLine for Step {
    fn line(&self) -> usize {
        match self {
            Self::Removed { .. } => 9,
        }
    }
}

/// Lines and rings that are simplified together.
///
/// ```
/// use durer::clip::simplify::LineSimplifier;
/// use durer::clip::simplify::coverage::{Coverage, Options};
/// use durer::math::DVec2;
/// use durer::trace::NoTrace;
///
/// // Two squares; the border between them is not quite straight.
/// let mut both = Coverage::default();
/// both.push_ring([(0., 0.), (4., 0.), (4.1, 2.), (4., 4.), (0., 4.)].map(DVec2::from));
/// both.push_ring([(4., 0.), (8., 0.), (8., 4.), (4., 4.), (4.1, 2.)].map(DVec2::from));
/// let options = Options { method: LineSimplifier::Visvalingam, limit: 1.0 };
/// let weights = both.weights(&options, &mut NoTrace)?;
/// let gone: Vec<usize> = (0..weights.len()).filter(|&i| weights[i] <= 1.0).collect();
/// assert_eq!(gone, [2, 9], "the same point of both");
/// # Ok::<(), durer::Error>(())
/// ```
#[derive(Debug, Clone, Default)]
pub struct Coverage {
    points: Vec<DVec2>,
    chains: Vec<Chain>,
}

impl Coverage {
    /// Adds a line.
    pub fn push_line(&mut self, points: impl IntoIterator<Item = DVec2>) {
        self.push(points, false);
    }

    /// Adds a ring; the first point is not repeated at its end.
    pub fn push_ring(&mut self, points: impl IntoIterator<Item = DVec2>) {
        self.push(points, true);
    }

    fn push(&mut self, points: impl IntoIterator<Item = DVec2>, closed: bool) {
        let start = self.points.len();
        self.points.extend(points);
        self.chains.push(Chain { points: start..self.points.len(), closed });
    }

    /// Returns the weights of all points, in the order in which they were added: see [`super`]. Of repeated points, the
    /// first has the weight of the place, and the others have weight 0.
    ///
    /// # Errors
    /// [`Error::NonFinite`] names the first point with a NaN or infinite coordinate; [`Error::Parameter`] for a
    /// limit that is negative or no number; [`Error::Limit`] for 2³² points and more.
    pub fn weights(&self, options: &Options, t: &mut impl Tracer<Step>) -> Result<Vec<f64>> {
        check(&self.points, options.limit)?;
        let count = self.points.len() as u64;
        let limit = u64::from(u32::MAX - 1);
        if count > limit {
            return Err(Error::Limit { what: "number of points", value: count, limit });
        }
        let mut network = Network::new(&self.points, &self.chains);
        let mut links = std::mem::take(&mut network.links);
        let measure = match options.method {
            LineSimplifier::Visvalingam => Measure::Area,
            LineSimplifier::DouglasPeucker => {
                let weights = self.distances(&network, &links)?;
                // The points that hold a closed line in place are not nodes of the network.
                for (link, weight) in links.0.iter_mut().zip(&weights) {
                    if weight.is_infinite() {
                        *link = [super::removal::NONE; 2];
                    }
                }
                self.chains.iter().for_each(|chain| network.note_direct(&links, chain));
                Measure::Given(weights)
            }
        };
        let places = std::mem::take(&mut network.places);
        let place_of = std::mem::take(&mut network.place_of);
        let guard = Fence { index: Index::new(&places), network };
        let removal = Removal { places: &places, links, measure, limit: options.limit, guard };
        let weights = removal.run(|i, weight| t.step(|| Step::Removed { at: places[i], weight }));
        Ok(self.of_points(&weights, &place_of))
    }

    /// Converts weights of places to weights of points.
    fn of_points(&self, weights: &[f64], place_of: &[u32]) -> Vec<f64> {
        let mut all: Vec<f64> = place_of.iter().map(|&place| weights[place as usize]).collect();
        for chain in &self.chains {
            let range = chain.points.clone();
            for i in range.clone().skip(1) {
                if place_of[i] == place_of[i - 1] {
                    all[i] = 0.0;
                }
            }
            let last = range.end.saturating_sub(1);
            if chain.closed && last > range.start && place_of[last] == place_of[range.start] {
                all[last] = 0.0;
            }
        }
        all
    }

    /// Returns the weights of places by Douglas and Peucker, for each stretch between nodes; rings without a node are
    /// held at their smallest place and at the place farthest from it.
    fn distances(&self, network: &Network, links: &Links) -> Result<Vec<f64>> {
        let mut weights: Vec<Option<f64>> = (0..network.places.len() as u32)
            .map(|i| (!links.is_free(i)).then_some(f64::INFINITY))
            .collect();
        for chain in &self.chains {
            let mut walk = network.walk(chain);
            if chain.closed {
                hold(&mut walk, &mut weights, &network.places);
            }
            let fixed: Vec<usize> = (0..walk.len())
                .filter(|&at| weights[walk[at] as usize] == Some(f64::INFINITY))
                .collect();
            for pair in fixed.windows(2) {
                let stretch = &walk[pair[0]..=pair[1]];
                // A neighbour has been here before.
                if stretch.len() < 3 || weights[stretch[1] as usize].is_some() {
                    continue;
                }
                let points: Vec<DVec2> =
                    stretch.iter().map(|&i| network.places[i as usize]).collect();
                for (&i, weight) in stretch.iter().zip(douglas_peucker::weights(&points)?) {
                    weights[i as usize].get_or_insert(weight);
                }
            }
        }
        Ok(weights.into_iter().map(|w| w.unwrap_or(f64::INFINITY)).collect())
    }
}

/// Turns a closed walk so that it begins, and ends, at a place that stays; if there is none, makes two.
fn hold(walk: &mut Vec<u32>, weights: &mut [Option<f64>], places: &[DVec2]) {
    let stays = |i: &u32| weights[*i as usize] == Some(f64::INFINITY);
    let start = walk.iter().position(stays).or_else(|| {
        // Places are numbered in their order.
        let (start, &low) = walk.iter().enumerate().min_by_key(|(_, i)| **i)?;
        if weights[low as usize].is_some() {
            return None;
        }
        let distance = |i: u32| places[i as usize].distance_squared(places[low as usize]);
        let far = |i: &u32, j: &u32| distance(*i).total_cmp(&distance(*j)).then(j.cmp(i));
        let &far = walk.iter().max_by(|i, j| far(i, j))?;
        for i in [low, far] {
            weights[i as usize] = Some(f64::INFINITY);
        }
        Some(start)
    });
    if let Some(start) = start {
        walk.rotate_left(start);
        walk.push(walk[0]);
    }
}

/// Guard that keeps lines from crossing.
struct Fence {
    index: Index,
    network: Network,
}

impl Guard for Fence {
    fn obstacle(
        &mut self,
        places: &[DVec2],
        links: &Links,
        [a, b, c]: [u32; 3],
    ) -> Option<Obstacle> {
        if self.network.are_joined(links, b, [a, c]) {
            return Some(Obstacle::Edge);
        }
        self.index.in_triangle(places, [a, b, c]).map(Obstacle::Point)
    }

    fn removed(&mut self, links: &Links, [a, b, c]: [u32; 3]) {
        self.index.remove(b);
        if !links.is_free(a) && !links.is_free(c) {
            self.network.direct.insert([a.min(c), a.max(c)]);
        }
    }
}
