//! The order in which a plotter's pen draws: from each end to the nearest line not yet drawn.
//!
//! Nearest neighbour (Rosenkrantz, Stearns and Lewis, *An analysis of several heuristics for the
//! traveling salesman problem*, 1977), with a uniform grid; lines may be drawn from either end, closed
//! ones from any of their points. O(n) cells looked at as a rule.

use super::chain::Chain;
use super::page::GridPoint;

/// Orders chains of one class after another, each class from where the last one ended.
pub(super) fn order(chains: Vec<Chain>) -> Vec<Chain> {
    let mut rest: Vec<Option<Chain>> = chains.into_iter().map(Some).collect();
    let mut ordered: Vec<Chain> = Vec::with_capacity(rest.len());
    let mut pen = GridPoint::default();
    let mut start = 0;
    while start < rest.len() {
        let key = |c: &Option<Chain>| c.as_ref().map(|c| (c.invisibility, c.class));
        let of = key(&rest[start]);
        let end = start + rest[start..].iter().take_while(|c| key(c) == of).count();
        let mut ends = Ends::new(&rest[start..end]);
        while let Some((index, point)) = ends.nearest(pen) {
            let Some(chain) = rest[start + index].take() else { continue };
            let chain = from_point(chain, point);
            ends.remove(index);
            pen = *(if chain.closed { chain.points.first() } else { chain.points.last() })
                .unwrap_or(&pen);
            ordered.push(chain);
        }
        start = end;
    }
    ordered
}

/// The chain from one of its points: reversed, or turned round.
fn from_point(mut chain: Chain, point: usize) -> Chain {
    if chain.closed {
        chain.points.rotate_left(point);
    } else if point > 0 {
        chain.points.reverse();
    }
    chain
}

/// The points at which chains may begin, by cell.
struct Ends {
    low: GridPoint,
    size: i64,
    side: i64,
    cells: Vec<Vec<(GridPoint, usize, usize)>>,
    done: Vec<bool>,
    left: usize,
}

impl Ends {
    fn new(chains: &[Option<Chain>]) -> Self {
        let mut starts = Vec::new();
        for (index, chain) in chains.iter().enumerate() {
            let Some(chain) = chain else { continue };
            let last = chain.points.len() - 1;
            let points: Vec<usize> =
                if chain.closed { (0..=last).collect() } else { vec![0, last] };
            starts.extend(points.into_iter().map(|p| (chain.points[p], index, p)));
        }
        let low = starts.iter().fold(GridPoint { x: i32::MAX, y: i32::MAX }, |lo, s| GridPoint {
            x: lo.x.min(s.0.x),
            y: lo.y.min(s.0.y),
        });
        let far = starts.iter().map(|s| s.0.minus(low)).fold(1, |m, [x, y]| m.max(x).max(y));
        let side = ((starts.len() as f64).sqrt().ceil() as i64).clamp(1, 1024);
        let size = far / side + 1;
        let mut cells = vec![Vec::new(); (side * side) as usize];
        for start in starts {
            let [x, y] = start.0.minus(low).map(|d| d / size);
            cells[(y * side + x) as usize].push(start);
        }
        Self { low, size, side, cells, done: vec![false; chains.len()], left: chains.len() }
    }

    fn remove(&mut self, index: usize) {
        self.done[index] = true;
        self.left -= 1;
    }

    /// The nearest start of a chain that is not done: its index and point.
    fn nearest(&mut self, pen: GridPoint) -> Option<(usize, usize)> {
        if self.left == 0 {
            return None;
        }
        let [cx, cy] = pen.minus(self.low).map(|d| d.div_euclid(self.size).clamp(0, self.side - 1));
        let mut best: Option<(f64, usize, usize)> = None;
        for ring in 0..self.side {
            for y in (cy - ring).max(0)..=(cy + ring).min(self.side - 1) {
                let on_rim = (y - cy).abs() == ring;
                let step = if on_rim || ring == 0 { 1 } else { 2 * ring };
                let mut x = cx - ring;
                while x <= cx + ring {
                    if (0..self.side).contains(&x) {
                        self.look(pen, (y * self.side + x) as usize, &mut best);
                    }
                    x += step;
                }
            }
            // What lies in further rings is at least so far away.
            if best.is_some_and(|(d, ..)| d <= (ring * self.size) as f64) {
                break;
            }
        }
        best.map(|(_, index, point)| (index, point))
    }

    fn look(&mut self, pen: GridPoint, cell: usize, best: &mut Option<(f64, usize, usize)>) {
        let done = &self.done;
        self.cells[cell].retain(|s| !done[s.1]);
        for &(at, index, point) in &self.cells[cell] {
            let d = at.distance(pen);
            if best.is_none_or(|b| (d, index, point) < b) {
                *best = Some((d, index, point));
            }
        }
    }
}
