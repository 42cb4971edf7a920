//! The arcs that lines and rings of a layer share, after M. Bostock, *How to Infer Topology*, 2013: a position is a
//! junction if a line ends there or its neighbours differ between uses; arcs run from junction to junction.

use crate::geo::Points;
use std::collections::BTreeMap;

/// Numbers of the positions of a run, equal ones alike.
type Run = Vec<u32>;

/// A line or a ring of the layer.
struct Path {
    run: Run,
    is_ring: bool,
}

/// All arcs, and which of them make up each line and ring, in order; `-1 - i` is arc i backwards.
#[derive(Debug, Default)]
pub struct Arcs {
    pub arcs: Vec<Points>,
    pub paths: Vec<Vec<i64>>,
}

impl Arcs {
    /// Builds arcs from lines, and from rings, which are marked by `true`.
    pub fn of(runs: &[(&Points, bool)]) -> Self {
        let (paths, places) = numbered(runs);
        let junctions = junctions(&paths, places.len());
        let mut made = Maker { arcs: Vec::new(), known: BTreeMap::new() };
        let paths = paths.iter().map(|path| made.path(path, &junctions)).collect();
        let point = |number: &u32| places.get(*number as usize).copied();
        let points = |run: &Run| {
            let mut points = Points::default();
            for (run, i) in run.iter().filter_map(point) {
                if points.is_empty() {
                    points.dimensions = run.dimensions;
                }
                points.push(run.xy[i], run.zm(i));
            }
            points
        };
        Self { arcs: made.arcs.iter().map(points).collect(), paths }
    }
}

/// Place of a position.
type Spot<'a> = (&'a Points, usize);

/// Returns all of a position's numbers, to the bit; zeros of both signs are alike.
fn key((points, i): Spot<'_>) -> [u64; 5] {
    let (p, [z, m]) = (points.xy[i], points.zm(i));
    let [x, y, z, m] = [p.x, p.y, z, m].map(|n| (n + 0.0).to_bits());
    [x, y, z, m, points.dimensions.count() as u64]
}

/// Returns runs as numbers, and a place for each number.
fn numbered<'a>(runs: &[(&'a Points, bool)]) -> (Vec<Path>, Vec<Spot<'a>>) {
    let spots = runs.iter().flat_map(|(run, _)| (0..run.len()).map(move |i| (*run, i)));
    let mut sorted: Vec<([u64; 5], Spot<'a>)> = spots.map(|spot| (key(spot), spot)).collect();
    // Stable, so that of equal positions the first one is kept.
    sorted.sort_by_key(|(key, _)| *key);
    sorted.dedup_by_key(|(key, _)| *key);
    let number = |run: &'a Points, i| {
        let key = key((run, i));
        sorted.binary_search_by_key(&key, |(key, _)| *key).unwrap_or(0) as u32
    };
    let path = |(run, is_ring): &(&'a Points, bool)| {
        let mut numbers: Run = (0..run.len()).map(|i| number(run, i)).collect();
        numbers.dedup();
        if *is_ring {
            while numbers.len() > 1 && numbers.first() == numbers.last() {
                numbers.pop();
            }
        }
        Path { run: numbers, is_ring: *is_ring }
    };
    let paths = runs.iter().map(path).collect();
    (paths, sorted.into_iter().map(|(_, spot)| spot).collect())
}

/// Returns true for each position that is a junction.
fn junctions(paths: &[Path], count: usize) -> Vec<bool> {
    let mut junctions = vec![false; count];
    let mut beside: Vec<Option<[u32; 2]>> = vec![None; count];
    for Path { run, is_ring } in paths {
        for (i, &at) in run.iter().enumerate() {
            let before = i.checked_sub(1).or(is_ring.then(|| run.len() - 1));
            let after = Some(i + 1).filter(|&j| j < run.len()).or(is_ring.then_some(0));
            let (Some(a), Some(b)) = (before, after) else {
                junctions[at as usize] = true;
                continue;
            };
            let pair = [run[a].min(run[b]), run[a].max(run[b])];
            match beside[at as usize] {
                Some(known) => junctions[at as usize] |= known != pair,
                None => beside[at as usize] = Some(pair),
            }
        }
    }
    junctions
}

struct Maker {
    arcs: Vec<Run>,
    /// Arcs, by their positions in the smaller of the two directions.
    known: BTreeMap<Run, i64>,
}

impl Maker {
    fn path(&mut self, path: &Path, junctions: &[bool]) -> Vec<i64> {
        let is_junction = |number: &u32| junctions[*number as usize];
        let mut run = path.run.clone();
        if path.is_ring && !run.is_empty() {
            match run.iter().position(is_junction) {
                Some(first) => run.rotate_left(first),
                None => return vec![self.loose(run)],
            }
            run.push(run[0]);
        }
        let mut made = Vec::new();
        let mut start = 0;
        for end in 1..run.len() {
            if is_junction(&run[end]) || end + 1 == run.len() {
                made.push(self.arc(run[start..=end].to_vec()));
                start = end;
            }
        }
        made
    }

    /// Returns a ring without a junction, which other rings may have from another position on.
    fn loose(&mut self, run: Run) -> i64 {
        let least = run.iter().enumerate().min_by_key(|(_, number)| **number).map_or(0, |(i, _)| i);
        let mut key = run.clone();
        key.rotate_left(least);
        key.push(key[0]);
        let backwards: Run = key.iter().rev().copied().collect();
        let is_turned = backwards < key;
        let mut own = run;
        own.push(own[0]);
        self.known(if is_turned { backwards } else { key }, own, is_turned)
    }

    fn arc(&mut self, run: Run) -> i64 {
        let backwards: Run = run.iter().rev().copied().collect();
        let is_turned = backwards < run;
        self.known(if is_turned { backwards } else { run.clone() }, run, is_turned)
    }

    /// Returns the number of an arc, which is kept as it came first.
    fn known(&mut self, key: Run, run: Run, is_turned: bool) -> i64 {
        if let Some(&number) = self.known.get(&key) {
            // The sign of the stored index tells whether the arc was reversed to get the key.
            let (index, was_turned) =
                if number < 0 { (-1 - number, true) } else { (number, false) };
            return if was_turned == is_turned { index } else { -1 - index };
        }
        let index = self.arcs.len() as i64;
        self.arcs.push(run);
        self.known.insert(key, if is_turned { -1 - index } else { index });
        index
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use durer::math::DVec2;

    fn run(points: &[(i32, i32)]) -> Points {
        Points::flat(points.iter().map(|&(x, y)| DVec2::new(x.into(), y.into())).collect())
    }

    #[test]
    fn neighbours_share_an_arc() {
        let (a, b) =
            (run(&[(0, 0), (1, 0), (1, 1), (0, 1)]), run(&[(1, 1), (1, 0), (2, 0), (2, 1)]));
        let alone = run(&[(5, 5), (6, 5), (6, 6)]);
        let again = run(&[(6, 5), (5, 5), (6, 6)]);
        let made = Arcs::of(&[(&a, true), (&b, true), (&alone, true), (&again, true)]);
        assert_eq!(made.arcs.len(), 4);
        assert_eq!(made.paths, [vec![0, 1], vec![-1, 2], vec![3], vec![-4]]);
        assert_eq!(made.arcs[0].xy, [DVec2::new(1.0, 0.0), DVec2::new(1.0, 1.0)]);
    }

    #[test]
    fn lines_are_cut_where_others_leave_them() {
        let (a, b) = (run(&[(0, 0), (1, 0), (2, 0), (3, 0)]), run(&[(1, 0), (2, 0), (2, 5)]));
        let made = Arcs::of(&[(&a, false), (&b, false)]);
        assert_eq!(made.paths, [vec![0, 1, 2], vec![1, 3]]);
        assert_eq!(Arcs::of(&[(&Points::default(), true)]).paths, [Vec::<i64>::new()]);
    }
}
