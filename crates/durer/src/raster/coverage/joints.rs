//! The edges of a contour that continue into each other without being able to cross.
//!
//! Joints with only short edges between them form a group, with the edges that lead to it and away from it. Two edges
//! with a common end cannot cross, nor can several as long as all of them advance in one direction. The result does not
//! depend on the contour's start, its direction, or the chunks it is made in.

use std::ops::Range;

use super::edge::{Edge, is_on_border};

/// Edges of one contour that were made together, between the first and the last of them at which a group of joints
/// begins or ends; the joints between these are done.
#[derive(Debug, Clone)]
pub(super) struct Part {
    /// The number of the contour's first point.
    pub contour: usize,
    /// Its edges in the chunk.
    pub edges: Range<usize>,
    /// The two edges, if there are any.
    pub ends: Option<(usize, usize)>,
    /// True if edges may be missing between them.
    pub gaps: bool,
}

/// Chains the joints of a whole contour at which edges cannot meet but where they continue each other. With `gaps`
/// some edges may not begin where the one before ends.
pub(super) fn chain_contour(edges: &mut [Edge], gaps: bool) {
    let count = edges.len();
    let begins_anew = |edges: &[Edge]| {
        let (Some(first), Some(last)) = (edges.first(), edges.last()) else { return false };
        gaps && count > 1 && !is_joint(last, first)
    };
    let ends = match chain_inner(edges, gaps) {
        Some(ends) => ends,
        None if begins_anew(edges) => (0, 0),
        None => return,
    };
    if count > 1 {
        let mut around = edges[ends.1..].to_vec();
        around.extend(&edges[..=ends.0]);
        chain(&mut around, Some(count - ends.1), gaps);
        let own = (ends.1..count).chain(0..=ends.0);
        around.iter().zip(own).for_each(|(copy, i)| edges[i].chain_as(copy));
    }
}

/// Chains the edges between the first and the last edge that a group of joints begins at; returns these two.
pub(super) fn chain_inner(edges: &mut [Edge], gaps: bool) -> Option<(usize, usize)> {
    let begins = |i: &usize| {
        !edges[*i].is_short() || (gaps && *i > 0 && !is_joint(&edges[i - 1], &edges[*i]))
    };
    let first = (0..edges.len()).find(begins)?;
    let last = (first..edges.len()).rev().find(begins)?;
    chain(&mut edges[first..=last], None, gaps);
    Some((first, last))
}

fn is_joint(before: &Edge, after: &Edge) -> bool {
    before.course()[1] == after.course()[0]
}

/// Chains the joints between the edges of a contour that are inside, including the first and the last. The first edge
/// of the contour may appear again at place `closing`, after its last one.
pub(super) fn chain(edges: &mut [Edge], closing: Option<usize>, gaps: bool) {
    // Joint i is before edge i.
    let mut first = 1;
    for i in 1..edges.len() {
        if gaps && !is_joint(&edges[i - 1], &edges[i]) {
            chain_group(edges, first..i, closing);
            first = i + 1;
        } else if !edges[i].is_short() || i + 1 == edges.len() {
            if first == i && closing.is_none() {
                edges[i].chain(true);
            } else {
                chain_group(edges, first..i + 1, closing);
            }
            first = i + 1;
        }
    }
}

/// Chains a group of joints.
fn chain_group(edges: &mut [Edge], joints: Range<usize>, closing: Option<usize>) {
    let directions = || {
        let around = edges.get(joints.start.saturating_sub(1)..joints.end).unwrap_or_default();
        around.iter().fold(u8::MAX, |common, edge| common & edge.directions())
    };
    if joints.is_empty() || (joints.len() > 1 && directions() == 0) {
        return;
    }
    let closing = closing.filter(|c| joints.contains(c) && !is_on_border(edges[*c].course()[0]));
    for joint in joints {
        // The edge that comes later in the order of the edges does not count at their joint, and up to
        // the closing joint none does before which the first edge has come.
        if closing.is_some_and(|closing| joint <= closing) {
            edges[joint - 1].chain(false);
        } else {
            edges[joint].chain(true);
        }
    }
}
