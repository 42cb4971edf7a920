//! Traversal that carries the result at one corner along edges to all corners connected with it.

use super::FaceNet;
use crate::work::Work;
use crate::{Error, Result};
use std::collections::VecDeque;

/// An algorithm that carries a state along edges.
pub(in super::super) trait Carrier {
    /// State of a corner.
    type State: PartialEq;

    /// Returns the state of the first corner of a connected part.
    fn find(&mut self, corner: usize) -> Self::State;

    /// Returns the state at the end of an edge, whose corners are in the direction of travel, from that at its
    /// beginning.
    ///
    /// # Errors
    /// Those of charging the results to the work.
    fn along(
        &mut self,
        edge: usize,
        corners: [usize; 2],
        state: &Self::State,
    ) -> Result<Self::State>;
}

impl FaceNet {
    /// Goes along all edges that are not flat, each once, from a corner whose state is known.
    ///
    /// # Errors
    /// The errors of the carrier and of the work, which is checked at each edge; [`Error::Parameter`] if two ways to a
    /// corner lead to different states: something touches there, so that
    /// rounding decides which of two is in front.
    pub(in super::super) fn carry<C: Carrier>(&self, carrier: &mut C, work: &Work) -> Result<()> {
        let (corners, edges) = (self.points.len() as u64, self.edges.len() as u64);
        let _known = work.charge_for::<(Option<C::State>, usize)>("corners of faces", corners)?;
        let _done = work.charge_for::<bool>("edges of faces", edges)?;
        work.begin("edges", edges);
        let mut known: Vec<Option<C::State>> = self.points.iter().map(|_| None).collect();
        let mut done = vec![false; self.edges.len()];
        let mut waiting = VecDeque::new();
        for first in 0..self.points.len() {
            if known[first].is_some() || self.around[first].is_empty() {
                continue;
            }
            known[first] = Some(carrier.find(first));
            waiting.push_back(first);
            while let Some(from) = waiting.pop_front() {
                for &edge in &self.around[from] {
                    if std::mem::replace(&mut done[edge], true) {
                        continue;
                    }
                    work.check()?;
                    work.advance(1);
                    let [a, b] = self.edges[edge].corners;
                    let to = if a == from { b } else { a };
                    let Some(state) = &known[from] else { continue };
                    let found = carrier.along(edge, [from, to], state)?;
                    match &known[to] {
                        Some(other) if *other != found => return Err(self.contradiction(to)),
                        Some(_) => {}
                        None => {
                            known[to] = Some(found);
                            waiting.push_back(to);
                        }
                    }
                }
            }
        }
        Ok(())
    }

    fn contradiction(&self, corner: usize) -> Error {
        let value = format!("touched by another at {}", self.corners[corner]);
        Error::parameter("face", value, "apart from others, or pierced by them")
    }
}
