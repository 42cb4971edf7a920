//! Trapping: filled shapes extend a little under the neighbours that are painted after them.
//!
//! Viewers blend the border of each shape with the colours below it, so the background shines through between two
//! shapes that share a border. Extending a shape under its neighbour closes the gap, a technique known from printing
//! (trapping). Shapes extend only under neighbours painted later, never over the background.
//!
//! A shape narrower than the reach has no room for an extension under it, and several side by side would let the
//! background show again. So connected shapes that are all so narrow get one common shape beneath them, which is
//! painted first and extends under everything around.

use super::planar_map::faces::float;
use super::planar_map::merge::{self, NOTHING, Patch, Patches};
use super::planar_map::planar::Planar;
use crate::math::DVec2;

/// Relations of a map's shapes to each other.
pub struct Trap<'a> {
    pub map: &'a Planar,
    pub patches: &'a Patches,
    /// Position of each patch in the order of painting.
    pub rank: &'a [u32],
    /// Grid steps.
    pub reach: f64,
}

/// The longest miter, as a multiple of the reach.
const MITER: f64 = 4.0;

/// Fill beneath narrow patches.
pub struct Beneath {
    /// The patches: connected narrow ones joined, the others unchanged.
    pub patches: Patches,
    /// 0 for the common shapes beneath, 1 for the others.
    pub rank: Vec<u32>,
    /// Pairs (common shape beneath, narrow patch above), sorted.
    pub pairs: Vec<(u32, u32)>,
}

/// Joins the patches that are narrower than twice the reach.
pub fn joined_narrow(trap: &Trap<'_>, room: &[f64]) -> Beneath {
    let narrow = |patch: u32| patch != NOTHING && room[patch as usize] < trap.reach;
    let joined = trap.patches.list.len() as u32;
    let label = |&patch: &u32| if narrow(patch) { joined } else { patch };
    let labels: Vec<u32> = trap.patches.of_face.iter().map(label).collect();
    let patches = merge::patches(trap.map, &labels);
    let both = patches.of_face.iter().copied().zip(trap.patches.of_face.iter().copied());
    let mut pairs: Vec<(u32, u32)> =
        both.filter(|&(below, above)| narrow(above) && below != NOTHING).collect();
    pairs.sort_unstable();
    pairs.dedup();
    let rank = patches.list.iter().map(|p| u32::from(p.label != joined)).collect();
    Beneath { patches, rank, pairs }
}

impl Trap<'_> {
    /// Returns how far shapes may extend under each patch: not through it, if it is narrow. Grid
    /// steps.
    pub fn room(&self) -> Vec<f64> {
        let of = |patch: &Patch| {
            let (area, length) = self.area_and_length(patch);
            if length > 0.0 { self.reach.min(area / length).max(0.0) } else { 0.0 }
        };
        self.patches.list.iter().map(of).collect()
    }

    /// Returns the area of a patch and the length of its border, in grid steps.
    pub fn area_and_length(&self, patch: &Patch) -> (f64, f64) {
        let (mut area, mut length) = (0.0, 0.0);
        for ring in &patch.rings {
            let at =
                |i: usize| float(self.map.points[self.map.start(ring[i % ring.len()]) as usize]);
            for i in 0..ring.len() {
                area += (at(i) - at(0)).perp_dot(at(i + 1) - at(0)) * 0.5;
                length += at(i).distance(at(i + 1));
            }
        }
        (area, length)
    }

    /// Returns the rings of a patch, grown; grid coordinates.
    pub fn rings(&self, index: usize, room: &[f64]) -> Vec<Vec<DVec2>> {
        let patch = &self.patches.list[index];
        patch.rings.iter().map(|ring| self.ring(index as u32, ring, room)).collect()
    }

    fn ring(&self, patch: u32, ring: &[u32], room: &[f64]) -> Vec<DVec2> {
        let mut points = Vec::with_capacity(ring.len() * 2);
        for &out in ring {
            self.corner(patch, out, room, &mut points);
        }
        points.dedup();
        points
    }

    /// Goes around a corner on the outside: from sector to sector between the edges that meet there.
    fn corner(&self, patch: u32, out: u32, room: &[f64], points: &mut Vec<DVec2>) {
        let vertex = self.map.start(out);
        let place = float(self.map.points[vertex as usize]);
        let kept = |half: &u32| self.beside(*half) != self.beside(half ^ 1);
        let around: Vec<u32> = self.map.around(vertex).iter().copied().filter(kept).collect();
        let count = around.len();
        let at = around.iter().position(|&half| half == out).unwrap_or(0);
        // Each sector is to the left of its edge. The sector of `out` is the patch's own, bounded on the other side by
        // the incoming edge.
        let left = |k: usize| self.beside(around[k % count]);
        let outside = |k: &usize| left(*k) != patch;
        let aside = |k: usize| {
            let (other, edge) = (left(k), |k: usize| around[k % count]);
            let later = other != NOTHING && self.rank[other as usize] > self.rank[patch as usize];
            let room = if later { room[other as usize] } else { 0.0 };
            place + self.bisector(edge(k), edge(k + 1)) * room
        };
        let from_in = (at + 1..at + count).take_while(outside);
        let before = points.len();
        points.extend(from_in.map(aside));
        if points.len() - before + 1 < count {
            // The patch comes through here once more, and its parts meet in this very point.
            points.push(place);
            let mut to_out: Vec<usize> =
                (1..count).map(|k| at + count - k).take_while(outside).collect();
            to_out.reverse();
            points.extend(to_out.into_iter().map(aside));
        }
        if points.len() == before {
            points.push(place);
        }
    }

    /// Returns the patch to the left of a half-edge.
    fn beside(&self, half: u32) -> u32 {
        self.patches.of_face[self.map.face_of[half as usize] as usize]
    }

    /// Returns the vector from a vertex into the sector between two half-edges that leave it, to the point one unit
    /// away from both.
    fn bisector(&self, from: u32, to: u32) -> DVec2 {
        let direction = |half: u32| {
            let [a, b] =
                [half, half ^ 1].map(|h| float(self.map.points[self.map.start(h) as usize]));
            (b - a).normalize_or_zero()
        };
        let normal = direction(from).perp();
        let middle = (normal - direction(to).perp()).normalize_or_zero();
        middle / middle.dot(normal).max(1.0 / MITER)
    }
}
