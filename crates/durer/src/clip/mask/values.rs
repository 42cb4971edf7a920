//! Heights and measures of polygons at places that are not vertices of theirs.

use crate::clip::attribute::VertexSource;
use crate::clip::polygon::Shapes;
use crate::math::DVec2;

/// Height and measure of a vertex.
pub type Zm = [f64; 2];

/// Largest distance from an edge, as a share of the shape's size, at which a point counts as on it:
/// several times the distance that the overlay's grid moves a vertex.
const NEAR: f64 = 1e-12;

/// Returns the values at t between a (0) and b (1).
pub fn mix(a: Zm, b: Zm, t: f64) -> Zm {
    [a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t]
}

/// The values of all vertices.
pub struct Values<'a> {
    pub shapes: &'a Shapes,
    /// One for each point.
    pub zm: &'a [Zm],
}

/// Returns the values at a place on the edge from a to b, each given by its place and values: the
/// same bits for either direction, so that neighbours agree.
pub fn between(a: (DVec2, Zm), b: (DVec2, Zm), p: DVec2) -> Zm {
    let order = |p: DVec2, q: DVec2| p.x.total_cmp(&q.x).then(p.y.total_cmp(&q.y));
    let (a, b) = if order(a.0, b.0).is_le() { (a, b) } else { (b, a) };
    match VertexSource::on_edge(p, (0, a.0), (1, b.0)) {
        VertexSource::Vertex(0) => a.1,
        VertexSource::Cut { t, .. } => mix(a.1, b.1, t),
        _ => b.1,
    }
}

impl Values<'_> {
    /// Returns the values at a place on the edge between two vertices.
    pub fn along(&self, ends: [usize; 2], p: DVec2) -> Option<Zm> {
        let [a, b] =
            ends.map(|i| self.shapes.points().get(i).copied().zip(self.zm.get(i).copied()));
        Some(between(a?, b?, p))
    }

    /// Fills in the values of places that are on edges up to rounding; where several edges pass, the first one's. Each
    /// edge is compared only with the places within its range of x.
    pub fn on_edges(&self, places: &[DVec2], values: &mut [Option<Zm>]) {
        let mut open: Vec<usize> = (0..places.len()).filter(|&i| values[i].is_none()).collect();
        let Some(bounds) = self.shapes.bounds().filter(|_| !open.is_empty()) else { return };
        open.sort_by(|&i, &j| places[i].x.total_cmp(&places[j].x));
        let near = NEAR * (bounds.max() - bounds.min()).max_element();
        for index in 0..self.shapes.ring_count() {
            let (ring, range) = (self.shapes.ring(index), self.shapes.ring_range(index));
            let Some(zm) = self.zm.get(range) else { return };
            for i in 0..ring.len() {
                let next = (i + 1) % ring.len();
                let ((a, b), (from, to)) = ((ring[i], ring[next]), (zm[i], zm[next]));
                let (low, high) = (a.min(b) - near, a.max(b) + near);
                let first = open.partition_point(|&place| places[place].x < low.x);
                for &place in open[first..].iter().take_while(|&&place| places[place].x <= high.x) {
                    let p = places[place];
                    if values[place].is_some() || p.y < low.y || p.y > high.y {
                        continue;
                    }
                    let (along, squared) = (b - a, a.distance_squared(b));
                    let t = if squared > 0.0 { (p - a).dot(along) / squared } else { 0.0 };
                    let t = t.clamp(0.0, 1.0);
                    if p.distance(a + along * t) <= near {
                        values[place] = Some(mix(from, to, t));
                    }
                }
            }
        }
    }

    /// Returns the numbers of the vertices by their x, to find the nearest ones.
    pub fn by_x(&self) -> Vec<usize> {
        let points = self.shapes.points();
        let mut order: Vec<usize> = (0..points.len()).collect();
        order.sort_by(|&i, &j| points[i].x.total_cmp(&points[j].x));
        order
    }

    /// Returns the values of the vertex nearest to a place, of several the first; `by_x` as above.
    pub fn nearest(&self, by_x: &[usize], place: DVec2) -> Zm {
        let points = self.shapes.points();
        let (mut best, mut squared) = (usize::MAX, f64::INFINITY);
        let mut closer = |&i: &usize| {
            let across = points[i].x - place.x;
            let found = points[i].distance_squared(place);
            if (found, i) < (squared, best) {
                (best, squared) = (i, found);
            }
            // Those beyond are farther away on this axis alone.
            across * across <= squared
        };
        let middle = by_x.partition_point(|&i| points[i].x < place.x);
        by_x[middle..].iter().all(&mut closer);
        by_x[..middle].iter().rev().all(&mut closer);
        self.zm.get(best).copied().unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn many_places_get_what_each_alone_gets() {
        let mut state = 7_u64;
        let mut random = |range: u64| {
            let step = (6_364_136_223_846_793_005, 1_442_695_040_888_963_407);
            state = state.wrapping_mul(step.0).wrapping_add(step.1);
            ((state >> 33) % range) as f64
        };
        for _ in 0..500 {
            let mut point = || DVec2::new(random(9), random(9));
            let ring: Vec<DVec2> = (0..6).map(|_| point()).collect();
            let places: Vec<DVec2> = (0..20).map(|_| point()).collect();
            let zm: Vec<Zm> = (0..6).map(|i| [f64::from(i), 0.0]).collect();
            let shapes = Shapes::from_rings([ring]);
            let values = Values { shapes: &shapes, zm: &zm };
            let mut all = vec![None; places.len()];
            values.on_edges(&places, &mut all);
            let order = values.by_x();
            for (&place, found) in places.iter().zip(all) {
                let mut alone = [None];
                values.on_edges(&[place], &mut alone);
                assert_eq!(found, alone[0], "{place}");
                let distance = |i: &usize| shapes.points()[*i].distance_squared(place);
                let nearest = (0..6).min_by(|i, j| distance(i).total_cmp(&distance(j)));
                assert_eq!(values.nearest(&order, place), zm[nearest.unwrap()], "{place}");
            }
        }
    }
}
