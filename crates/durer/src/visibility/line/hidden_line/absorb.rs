//! Parts of a line that are too short to be visible: they are joined to neighbours.

use super::span::HiddenSpan;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Joins slivers, the shortest first, to the longer neighbour; O(n log n) for n parts.
pub(super) fn absorb(sliver: f64, spans: &mut Vec<HiddenSpan>) {
    if spans.len() > 1 && spans.iter().any(|span| length(span) < sliver) {
        let mut chain = Chain::new(spans, sliver);
        while chain.alive > 1 && chain.absorb_shortest() {}
        let mut is_left = chain.is_left.into_iter();
        spans.retain(|_| is_left.next() == Some(true));
    }
}

fn length(span: &HiddenSpan) -> f64 {
    span.to - span.from
}

/// Parts that know their neighbours.
struct Chain<'a> {
    spans: &'a mut [HiddenSpan],
    sliver: f64,
    before: Vec<Option<usize>>,
    after: Vec<Option<usize>>,
    is_left: Vec<bool>,
    alive: usize,
    /// Slivers by their lengths, as bits, which are in the order of the lengths, and places. Those that have grown
    /// since stay in.
    slivers: BinaryHeap<Reverse<(u64, usize)>>,
}

impl<'a> Chain<'a> {
    fn new(spans: &'a mut [HiddenSpan], sliver: f64) -> Self {
        let count = spans.len();
        let mut chain = Self {
            before: (0..count).map(|i| i.checked_sub(1)).collect(),
            after: (0..count).map(|i| Some(i + 1).filter(|i| *i < count)).collect(),
            is_left: vec![true; count],
            alive: count,
            slivers: BinaryHeap::new(),
            spans,
            sliver,
        };
        (0..count).for_each(|i| chain.note(i));
        chain
    }

    /// Notes a part if it is a sliver.
    fn note(&mut self, i: usize) {
        let length = length(&self.spans[i]);
        if length < self.sliver {
            self.slivers.push(Reverse((length.to_bits(), i)));
        }
    }

    /// Joins the shortest sliver to a neighbour; `false` if there is none.
    fn absorb_shortest(&mut self) -> bool {
        let Some(i) = self.next() else { return false };
        let gone = self.spans[i];
        let (before, after) = (self.before[i], self.after[i]);
        let of = |i: Option<usize>| i.map(|i| length(&self.spans[i]));
        match (before, after) {
            (Some(before), _) if of(Some(before)) >= of(after) => {
                self.spans[before].to = gone.to;
                self.note(before);
            }
            (_, Some(after)) => {
                self.spans[after].from = gone.from;
                self.note(after);
            }
            _ => return false,
        }
        self.remove(i);
        if let (Some(before), Some(after)) = (before, after)
            && self.spans[before].invisibility == self.spans[after].invisibility
        {
            self.spans[before].to = self.spans[after].to;
            self.remove(after);
            self.note(before);
        }
        true
    }

    /// Returns the shortest sliver, the first of equally short ones.
    fn next(&mut self) -> Option<usize> {
        while let Some(Reverse((bits, i))) = self.slivers.pop() {
            if self.is_left[i] && length(&self.spans[i]).to_bits() == bits {
                return Some(i);
            }
        }
        None
    }

    fn remove(&mut self, i: usize) {
        (self.is_left[i], self.alive) = (false, self.alive - 1);
        let (before, after) = (self.before[i], self.after[i]);
        if let Some(before) = before {
            self.after[before] = after;
        }
        if let Some(after) = after {
            self.before[after] = before;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Computes the same as [`absorb`] by examining all parts each time.
    fn slowly(sliver: f64, spans: &mut Vec<HiddenSpan>) {
        while spans.len() > 1 {
            let all = 0..spans.len();
            let shortest =
                all.min_by(|&a, &b| length(&spans[a]).total_cmp(&length(&spans[b]))).unwrap();
            if length(&spans[shortest]) >= sliver {
                return;
            }
            let gone = spans.remove(shortest);
            let before = shortest.checked_sub(1).map(|k| length(&spans[k]));
            if before >= spans.get(shortest).map(length) {
                spans[shortest - 1].to = gone.to;
            } else {
                spans[shortest].from = gone.from;
            }
            if let [a, b] = spans[shortest.saturating_sub(1)..spans.len().min(shortest + 1)]
                && a.invisibility == b.invisibility
            {
                spans[shortest - 1].to = b.to;
                spans.remove(shortest);
            }
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]

        #[test]
        fn slivers_go_where_they_went(
            parts in prop::collection::vec((0u8..6, 0u32..3), 1..30),
            sliver in 0u8..7,
        ) {
            let mut at = 0.0;
            let mut spans = Vec::<HiddenSpan>::new();
            for (length, invisibility) in parts {
                let from = at;
                at += f64::from(length);
                spans.push(HiddenSpan { from, to: at, invisibility });
            }
            let (mut expected, sliver) = (spans.clone(), f64::from(sliver));
            slowly(sliver, &mut expected);
            absorb(sliver, &mut spans);
            prop_assert_eq!(spans, expected);
        }
    }
}
