//! Parts of a drawing's lines.

use crate::math::DVec2;
use crate::target::drawing::Line;

/// Returns the parts of a line that `cut` leaves of its segments, in order along each. Parts that continue from one
/// segment to the next, with ends equal to the bit, stay one part, also across the first point of a closed line.
pub(super) fn parts<I: IntoIterator<Item = [DVec2; 2]>>(
    line: &Line,
    cut: impl Fn(DVec2, DVec2) -> I,
) -> Vec<Line> {
    let last = line.closed.then(|| line.points.first().copied()).flatten();
    let points: Vec<DVec2> = line.points.iter().copied().chain(last).collect();
    let mut chains: Vec<Vec<DVec2>> = Vec::new();
    for [a, b] in points.windows(2).flat_map(|w| cut(w[0], w[1])) {
        match chains.last_mut() {
            Some(chain) if chain.last() == Some(&a) => chain.push(b),
            _ => chains.push(vec![a, b]),
        }
    }
    if let (true, [first, .., last]) = (line.closed, &mut chains[..])
        && first.first() == last.last()
    {
        last.extend_from_slice(&first[1..]);
        chains.swap_remove(0);
    }
    let part = |points| Line { points, closed: false, ..line.clone() };
    chains.into_iter().map(part).collect()
}
