//! The conversion between geometries and polygons with heights and measures.

use super::mean_value::MeanValues;
use super::values::{Values, Zm, between, mix};
use crate::clip::attribute::VertexSource;
use crate::clip::polygon::Operand;
use crate::clip::polygon::overlay::Output;
use crate::clip::polygon::{Shapes, signed_area};
use crate::geometry::{Dimensions, Geometry, Points};
use crate::math::DVec2;

/// Polygons with the heights and measures of their vertices.
#[derive(Debug, Clone, Default)]
pub struct Area {
    /// The polygons.
    pub shapes: Shapes,
    dimensions: Dimensions,
    /// One for each of the shapes' points; empty if there are neither heights nor measures.
    zm: Vec<Zm>,
}

impl Area {
    /// Returns the polygons of a geometry, of collections too.
    pub fn of_geometry(geometry: &Geometry) -> Self {
        let mut area = Self { dimensions: geometry.dimensions(), ..Self::default() };
        area.add(geometry);
        area
    }

    /// Creates polygons without heights and measures.
    pub fn flat(shapes: Shapes) -> Self {
        Self { shapes, ..Self::default() }
    }

    fn add(&mut self, geometry: &Geometry) {
        match geometry {
            Geometry::Polygon(rings) => self.add_polygon(rings),
            Geometry::MultiPolygon(polygons) => polygons.iter().for_each(|p| self.add_polygon(p)),
            Geometry::Collection(parts) => parts.iter().for_each(|part| self.add(part)),
            _ => {}
        }
    }

    fn add_polygon(&mut self, rings: &[Points]) {
        for ring in rings {
            // Repeated positions are dropped.
            let last = |&i: &usize| {
                let next = if i + 1 < ring.len() { i + 1 } else { 0 };
                ring.xy[i] != ring.xy[next]
            };
            if self.dimensions == Dimensions::Xy && (0..ring.len()).all(|i| last(&i)) {
                self.shapes.push_ring(ring.xy.iter().copied());
                continue;
            }
            let kept: Vec<usize> = (0..ring.len()).filter(last).collect();
            self.shapes.push_ring(kept.iter().map(|&i| ring.xy[i]));
            if self.dimensions != Dimensions::Xy {
                self.zm.extend(kept.iter().map(|&i| ring.zm(i)));
            }
        }
        self.shapes.end_polygon();
    }

    /// Adds the polygons of another area. Heights or measures that only one of the two has become 0 in the other;
    /// returns whether that happened.
    pub fn append(&mut self, other: &Self) -> bool {
        if self.shapes.is_empty() || other.shapes.is_empty() {
            if self.shapes.is_empty() {
                self.clone_from(other);
            }
            return false;
        }
        let mixed = self.dimensions != other.dimensions;
        self.dimensions = self.dimensions.with(other.dimensions);
        if self.dimensions != Dimensions::Xy {
            self.zm.resize(self.shapes.points().len(), Zm::default());
            self.zm.extend_from_slice(&other.zm);
        }
        self.shapes.append(&other.shapes);
        if self.dimensions != Dimensions::Xy {
            self.zm.resize(self.shapes.points().len(), Zm::default());
        }
        mixed
    }

    /// Returns a polygon, or several, or nothing.
    pub fn into_geometry(self) -> Option<Geometry> {
        let mut next = 0;
        let mut polygons: Vec<Vec<Points>> = Vec::new();
        for polygon in self.shapes.polygons() {
            let mut rings = Vec::new();
            for ring in polygon.rings() {
                let mut points = Points::new(self.dimensions);
                for &p in ring {
                    points.push(p, self.zm.get(next).copied().unwrap_or_default());
                    next += 1;
                }
                rings.push(points);
            }
            polygons.push(rings);
        }
        match polygons.len() {
            0 => None,
            1 => polygons.pop().map(Geometry::Polygon),
            _ => Some(Geometry::MultiPolygon(polygons)),
        }
    }

    /// Returns the clipped area, with the sources of new vertices as far as they are known.
    pub(crate) fn cut(&self, shapes: Shapes, sources: &[VertexSource]) -> Self {
        if self.zm.is_empty() {
            return Self { shapes, dimensions: self.dimensions, zm: Vec::new() };
        }
        let own = Values { shapes: &self.shapes, zm: &self.zm };
        let values = shapes.points().iter().zip(sources).map(|(&p, source)| match *source {
            VertexSource::Vertex(i) => self.zm.get(i).copied(),
            VertexSource::Cut { from, to, .. } => own.along([from, to], p),
            VertexSource::Corner => None,
        });
        let values = values.collect();
        self.with_values(shapes, values)
    }

    /// Returns this area after an overlay in which it was the subject.
    pub(crate) fn overlaid(&self, output: &Output) -> Self {
        let shapes = output.shapes.clone();
        if self.zm.is_empty() {
            return Self { shapes, dimensions: self.dimensions, zm: Vec::new() };
        }
        let values = output.attributes(
            |operand, index| {
                (operand == Operand::Subject).then(|| self.zm.get(index).copied()).flatten()
            },
            |a, b, t| Some(mix(a?, b?, t)),
            |a, b| a.or(b),
        );
        self.with_values(shapes, values)
    }

    fn with_values(&self, shapes: Shapes, mut values: Vec<Option<Zm>>) -> Self {
        values.resize(shapes.points().len(), None);
        let of = Values { shapes: &self.shapes, zm: &self.zm };
        // Corners of the mask may lie on edges of the subject, from which their values are interpolated.
        of.on_edges(shapes.points(), &mut values);
        let open = values.iter().filter(|value| value.is_none()).count();
        if open > 0 && open.saturating_mul(self.zm.len()) <= PAIRS {
            let mean = MeanValues::new(&of);
            for (value, &p) in values.iter_mut().zip(shapes.points()) {
                *value = value.or_else(|| mean.at(p));
            }
        }
        let by_x = std::cell::OnceCell::new();
        let nearest = |p: DVec2| of.nearest(by_x.get_or_init(|| of.by_x()), p);
        let mut zm = Vec::with_capacity(values.len());
        for index in 0..shapes.ring_count() {
            let known = values.get(shapes.ring_range(index)).unwrap_or_default();
            zm.extend(fill(shapes.ring(index), known, nearest));
        }
        Self { shapes, dimensions: self.dimensions, zm }
    }
}

/// Limit on the pairs of a position and a vertex that are searched for heights within a polygon: half a
/// second or less; beyond it heights are interpolated along the border from the known ones.
const PAIRS: usize = 1 << 26;

/// Returns the values of a ring with the unknown ones filled in: by length along the ring between the known ones before
/// and after; if the ring has none, by `otherwise`.
fn fill(ring: &[DVec2], known: &[Option<Zm>], otherwise: impl Fn(DVec2) -> Zm) -> Vec<Zm> {
    let count = ring.len();
    let Some(first) = known.iter().position(Option::is_some) else {
        return ring.iter().map(|&p| otherwise(p)).collect();
    };
    let mut values: Vec<Zm> = known.iter().map(|v| v.unwrap_or_default()).collect();
    let mut start = first;
    while start < first + count {
        let mut end = start + 1;
        while known[end % count].is_none() {
            end += 1;
        }
        let step = |i: usize| ring[i % count].distance(ring[(i + 1) % count]);
        let whole: f64 = (start..end).map(step).sum();
        let (a, b) = (values[start % count], values[end % count]);
        let mut walked = 0.0;
        for i in start + 1..end {
            walked += step(i - 1);
            values[i % count] = mix(a, b, if whole > 0.0 { walked / whole } else { 0.0 });
        }
        start = end;
    }
    values
}

/// Returns the same geometry with outer rings counter-clockwise and holes clockwise, each from its first
/// vertex, as RFC 7946 requires of GeoJSON.
pub fn oriented(mut geometry: Geometry) -> Geometry {
    orient_all(&mut geometry);
    geometry
}

fn orient_all(geometry: &mut Geometry) {
    match geometry {
        Geometry::Polygon(rings) => orient(rings),
        Geometry::MultiPolygon(polygons) => polygons.iter_mut().for_each(|rings| orient(rings)),
        Geometry::Collection(parts) => parts.iter_mut().for_each(orient_all),
        _ => {}
    }
}

fn orient(rings: &mut [Points]) {
    for (k, ring) in rings.iter_mut().enumerate() {
        if !ring.is_empty() && (signed_area(&ring.xy) < 0.0) == (k == 0) {
            ring.xy[1..].reverse();
            if let Some(rest) = ring.zm.get_mut(1..) {
                rest.reverse();
            }
        }
    }
}

/// Returns the pieces of lines, from the sources of their vertices.
pub(super) fn pieces(
    lines: &[&Points],
    cut: &crate::clip::polygon::rectangle::ClippedLines,
) -> Vec<Points> {
    let any = |has: fn(Dimensions) -> bool| lines.iter().any(|line| has(line.dimensions));
    let dimensions = Dimensions::new(any(Dimensions::has_z), any(Dimensions::has_m));
    let zm: Vec<Zm> = match dimensions {
        Dimensions::Xy => Vec::new(),
        _ => lines.iter().flat_map(|line| (0..line.len()).map(|i| line.zm(i))).collect(),
    };
    let xy: Vec<DVec2> = match dimensions {
        Dimensions::Xy => Vec::new(),
        _ => lines.iter().flat_map(|line| line.xy.iter().copied()).collect(),
    };
    let value = |i: usize| zm.get(i).copied().unwrap_or_default();
    let mut next = 0;
    let piece = |(_, run): (usize, &[DVec2])| {
        let mut points = Points::new(dimensions);
        for &p in run {
            let values = match cut.sources.get(next) {
                Some(VertexSource::Vertex(i)) => value(*i),
                Some(VertexSource::Cut { from, to, .. }) if dimensions != Dimensions::Xy => {
                    let end = |i: usize| (xy.get(i).copied().unwrap_or(p), value(i));
                    between(end(*from), end(*to), p)
                }
                Some(VertexSource::Cut { .. } | VertexSource::Corner) | None => [0.0; 2],
            };
            points.push(p, values);
            next += 1;
        }
        points
    };
    cut.pieces().map(piece).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unknown_values_lie_between_their_neighbours() {
        let ring = [(0.0, 0.0), (1.0, 0.0), (3.0, 0.0), (3.0, 3.0)].map(DVec2::from);
        let known = [Some([3.0, 0.0]), None, Some([9.0, 1.0]), None];
        let filled = fill(&ring, &known, |_| [0.0; 2]);
        assert_eq!(filled[1][0], 5.0);
        assert!(filled[3][0] > 3.0 && filled[3][0] < 9.0);
        assert_eq!(fill(&ring, &[None; 4], |p| [p.x, 0.0])[2], [3.0, 0.0]);
    }
}
