//! The choice of each pixel between its two principal directions, so that lines do not turn where the order of the
//! curvatures changes.
//!
//! A surface's pixels are processed in the order of how clearly their directions differ, each next to one already
//! processed, and take the branch of their neighbours. In the end the two branches of the whole surface are exchanged
//! if that gives more of it the direction of the stronger curvature. O(n log n).

use super::bent::Bent;
use super::seen::Seen;
use super::tensor::Tensor;
use crate::sorting::CompactSort;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Returns, for each pixel, whether it takes the second of its directions.
pub fn second(seen: &Seen, bent: &[Bent]) -> Vec<bool> {
    let mut order: Vec<usize> = (0..bent.len()).filter(|i| bent[*i].weight > 0.0).collect();
    order.compact_sort_by(|a, b| bent[*b].weight.total_cmp(&bent[*a].weight));
    let mut taking = Taking {
        seen,
        bent,
        second: vec![false; bent.len()],
        taken: vec![false; bent.len()],
        carried: vec![Tensor::ZERO; bent.len()],
    };
    for first in order {
        if !taking.taken[first] {
            taking.surface(first);
        }
    }
    taking.second
}

struct Taking<'a> {
    seen: &'a Seen,
    bent: &'a [Bent],
    second: Vec<bool>,
    taken: Vec<bool>,
    /// The direction that neighbours follow: a pixel's own as far as it is clear, else its neighbours'.
    carried: Vec<Tensor>,
}

impl Taking<'_> {
    /// Takes all pixels that are connected with a pixel.
    fn surface(&mut self, first: usize) {
        // Weights are at least 0, so their bits are in their order.
        let entry = |i: usize| (self.bent[i].weight.to_bits(), Reverse(i));
        let mut next = BinaryHeap::from([entry(first)]);
        let mut surface = Vec::new();
        let mut more_of_the_first = 0.0;
        while let Some((_, Reverse(i))) = next.pop() {
            if self.taken[i] {
                continue;
            }
            self.take(i);
            surface.push(i);
            let lead = self.bent[i].lead;
            more_of_the_first += if self.second[i] { -lead } else { lead };
            let around = self.seen.around_on_surface(i);
            next.extend(
                around
                    .filter(|j| !self.taken[*j])
                    .map(|j| (self.bent[j].weight.to_bits(), Reverse(j))),
            );
        }
        if more_of_the_first < 0.0 {
            for i in surface {
                self.second[i] = !self.second[i];
            }
        }
    }

    fn take(&mut self, i: usize) {
        let (mut sum, mut count) = (Tensor::ZERO, 0.0);
        for j in self.seen.around_on_surface(i).filter(|j| self.taken[*j]) {
            sum = sum + self.carried[j];
            count += 1.0;
        }
        let Bent { directions, weight, .. } = &self.bent[i];
        let [first, second] = directions.map(|v| sum.form(v, v));
        self.second[i] = second > first;
        let own = Tensor::of(directions[usize::from(self.second[i])]);
        let mean = if count > 0.0 { sum * (1.0 / count) } else { own };
        self.carried[i] = own * *weight + mean * (1.0 - weight);
        self.taken[i] = true;
    }
}
