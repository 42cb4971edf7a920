//! Lines divided into runs of pieces that are alike.

use crate::math::DVec2;
use crate::target::drawing::Line;

/// A straight piece of a line, and its properties.
pub type Known<K> = (K, [DVec2; 2]);

/// Returns the runs of a line whose pieces, in their order, have the same key. A closed line whose last run
/// has the key of the first has one less.
pub fn divided<K: Copy + PartialEq>(line: Line, pieces: &[Known<K>]) -> Vec<(K, Line)> {
    let runs: Vec<&[Known<K>]> = pieces.chunk_by(|a, b| a.0 == b.0).collect();
    if let [only] = runs[..] {
        return only.first().map(|p| (p.0, line)).into_iter().collect();
    }
    let mut parts: Vec<(K, Vec<DVec2>)> =
        runs.iter().filter_map(|run| Some((run.first()?.0, chain(run)))).collect();
    if line.closed && parts.first().map(|p| p.0) == parts.last().map(|p| p.0) && parts.len() > 1 {
        let (_, first) = parts.remove(0);
        if let Some((_, last)) = parts.last_mut() {
            last.extend(first.into_iter().skip(1));
        }
    }
    let part = |(key, points)| (key, Line { points, closed: false, ..line.clone() });
    parts.into_iter().map(part).collect()
}

/// Returns the points of pieces that follow each other.
fn chain<K>(run: &[Known<K>]) -> Vec<DVec2> {
    let first = run.first().map(|p| p.1[0]);
    first.into_iter().chain(run.iter().map(|p| p.1[1])).collect()
}

/// Returns the points of a line, the first again at the end of a closed one.
pub fn around(line: &Line) -> impl Iterator<Item = DVec2> {
    let again = line.points.first().filter(|_| line.closed);
    line.points.iter().chain(again).copied()
}
