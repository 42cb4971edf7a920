//! Caps: from the new edges of a cut to triangles that use each of them.

use crate::clip::polygon::{Ring, signed_area};
use crate::math::{DVec2, DVec3, Orientation, Vec3, orient2d};
use crate::sorting::CompactSort;
use earcut::Earcut;
use std::collections::HashMap;

/// Returns the triangles that close a cut, their front against `normal`; `None` if its edges do not
/// close.
///
/// Every edge is a side of exactly one triangle, so that a closed mesh stays closed.
pub fn triangles(
    positions: &[Vec3],
    segments: &[[u32; 2]],
    normal: DVec3,
) -> Option<Vec<[u32; 3]>> {
    let loops = loops(segments)?;
    let flat = Flat::new(positions, normal);
    let mut rings: Vec<(Vec<u32>, f64)> = loops
        .into_iter()
        .map(|ring| {
            let points: Vec<DVec2> = ring.iter().map(|&v| flat.point(v)).collect();
            let area = signed_area(&points);
            (ring, area)
        })
        .collect();
    // Large ones first: a hole's border is then the smallest outer ring around it that came before.
    rings.compact_sort_by(|a, b| b.1.abs().total_cmp(&a.1.abs()).then_with(|| a.0.cmp(&b.0)));
    let (outers, holes): (Vec<_>, Vec<_>) = rings.into_iter().partition(|(_, area)| *area > 0.0);
    let mut polygons: Vec<Vec<Vec<u32>>> = outers.into_iter().map(|(ring, _)| vec![ring]).collect();
    for (hole, _) in holes {
        let owner = polygons.iter().rposition(|polygon| flat.contains(&polygon[0], &hole));
        // A hole without an outer ring: faces turned inside out. Its own cap faces the other way.
        match owner {
            Some(i) => polygons[i].push(hole),
            None => polygons.push(vec![hole]),
        }
    }
    let mut triangles = Vec::new();
    for polygon in &polygons {
        flat.fill(polygon, &mut triangles);
    }
    Some(triangles)
}

/// Returns closed walks that use each segment once; `None` if some walk cannot be closed.
fn loops(segments: &[[u32; 2]]) -> Option<Vec<Vec<u32>>> {
    // Segments that run in both directions cancel.
    let mut sorted = segments.to_vec();
    sorted.sort_unstable();
    let mut count: HashMap<[u32; 2], i64> = HashMap::new();
    for &[a, b] in &sorted {
        *count.entry([a.min(b), a.max(b)]).or_default() += if a < b { 1 } else { -1 };
    }
    let mut out: HashMap<u32, Vec<u32>> = HashMap::new();
    let mut starts = Vec::new();
    for [a, b] in sorted {
        let left = count.entry([a.min(b), a.max(b)]).or_default();
        let direction = if a < b { 1 } else { -1 };
        if *left * direction > 0 {
            *left -= direction;
            out.entry(a).or_default().push(b);
            starts.push(a);
        }
    }
    let mut loops = Vec::new();
    for start in starts {
        let mut path: Vec<u32> = vec![start];
        let mut at: HashMap<u32, usize> = HashMap::from([(start, 0)]);
        let mut vertex = start;
        while let Some(next) = out.get_mut(&vertex).and_then(Vec::pop) {
            vertex = next;
            // Each time the walk returns to an earlier vertex, a simple loop is complete.
            if let Some(&from) = at.get(&vertex) {
                let ring: Vec<u32> = path.drain(from + 1..).collect();
                for v in &ring {
                    at.remove(v);
                }
                let whole: Vec<u32> = std::iter::once(vertex).chain(ring).collect();
                if whole.len() > 2 {
                    loops.push(whole);
                }
            } else {
                at.insert(vertex, path.len());
                path.push(vertex);
            }
        }
        if path.len() > 1 {
            return None;
        }
    }
    Some(loops)
}

/// The plane of the cut projected along the axis closest to its normal, by dropping a coordinate, without rounding.
struct Flat<'a> {
    positions: &'a [Vec3],
    axes: [usize; 2],
}

impl<'a> Flat<'a> {
    fn new(positions: &'a [Vec3], normal: DVec3) -> Self {
        let size = normal.abs();
        let k = if size.x >= size.y && size.x >= size.z {
            0
        } else if size.y >= size.z {
            1
        } else {
            2
        };
        let (u, v) = ((k + 1) % 3, (k + 2) % 3);
        // The front of a cap looks against the normal.
        let axes = if normal[k] < 0.0 { [u, v] } else { [v, u] };
        Self { positions, axes }
    }

    fn point(&self, v: u32) -> DVec2 {
        let p = self.positions[v as usize].as_dvec3();
        DVec2::new(p[self.axes[0]], p[self.axes[1]])
    }

    /// Returns whether a ring is within another, by its first point that is not one of the other's.
    fn contains(&self, outer: &[u32], inner: &[u32]) -> bool {
        let ring: Vec<DVec2> = outer.iter().map(|&v| self.point(v)).collect();
        let test = inner.iter().map(|&v| self.point(v)).find(|p| !ring.contains(p));
        test.is_some_and(|p| winds(&ring, p))
    }

    fn fill(&self, polygon: &[Vec<u32>], triangles: &mut Vec<[u32; 3]>) {
        let vertices: Vec<u32> = polygon.iter().flatten().copied().collect();
        let mut holes = Vec::new();
        let mut count = 0;
        for ring in &polygon[..polygon.len() - 1] {
            count += ring.len() as u32;
            holes.push(count);
        }
        let mut indices: Vec<u32> = Vec::new();
        let points = vertices.iter().map(|&v| self.point(v)).map(|p| [p.x, p.y]);
        Earcut::new().earcut(points, &holes, &mut indices);
        let area = signed_area(&polygon[0].iter().map(|&v| self.point(v)).collect::<Vec<_>>());
        let filled = indices.as_chunks::<3>().0.iter().map(|t| t.map(|i| vertices[i as usize]));
        let turned = filled.map(|[a, b, c]| {
            let turn = orient2d(self.point(a), self.point(b), self.point(c));
            let backwards = (turn == Orientation::Clockwise) == (area > 0.0);
            if backwards { [a, c, b] } else { [a, b, c] }
        });
        let start = triangles.len();
        triangles.extend(turned);
        for ring in polygon {
            use_all(ring, start, triangles);
        }
    }
}

/// Divides the triangles along straight borders, on which ear clipping leaves out vertices, so that each edge of the
/// ring is a side again.
fn use_all(ring: &[u32], start: usize, triangles: &mut Vec<[u32; 3]>) {
    let mut sides: HashMap<(u32, u32), usize> = HashMap::new();
    for (i, t) in triangles.iter().enumerate().skip(start) {
        for k in 0..3 {
            sides.insert((t[k], t[(k + 1) % 3]), i);
        }
    }
    let n = ring.len();
    let mut i = 0;
    while i < n {
        let from = ring[i];
        // The next vertex of the ring to which a side runs from this one.
        // An inner side has another triangle beside it; a side along the border has none.
        let is_border = |&k: &usize| {
            let to = ring[(i + k) % n];
            sides.contains_key(&(from, to)) && (k == 1 || !sides.contains_key(&(to, from)))
        };
        let reach = (1..n).find(is_border);
        let Some(reach) = reach else {
            i += 1;
            continue;
        };
        if reach > 1 {
            let to = ring[(i + reach) % n];
            let Some(index) = sides.remove(&(from, to)) else { break };
            let t = triangles[index];
            let tip = t[(0..3).find(|&k| t[k] != from && t[k] != to).unwrap_or(0)];
            let run: Vec<u32> = (0..=reach).map(|k| ring[(i + k) % n]).collect();
            for (k, pair) in run.windows(2).enumerate() {
                let piece = [pair[0], pair[1], tip];
                let place = if k == 0 { index } else { triangles.len() };
                if k == 0 {
                    triangles[index] = piece;
                } else {
                    triangles.push(piece);
                }
                for j in 0..3 {
                    sides.insert((piece[j], piece[(j + 1) % 3]), place);
                }
            }
        }
        i += reach;
    }
}

/// Returns whether a point is inside a simple ring; exact.
fn winds(ring: &Ring, p: DVec2) -> bool {
    let Some(&last) = ring.last() else { return false };
    let mut inside = false;
    let mut a = last;
    for &b in ring {
        if (a.y <= p.y) != (b.y <= p.y) {
            let up = b.y > a.y;
            let turn = orient2d(a, b, p);
            inside ^=
                turn == if up { Orientation::CounterClockwise } else { Orientation::Clockwise };
        }
        a = b;
    }
    inside
}
