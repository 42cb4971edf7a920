//! Trapping: filled shapes reach a little under the neighbours that are painted after them.
//!
//! Viewers blend the border of each shape with what is there already, so between two shapes that share
//! a border the background shines through. A shape that goes on under its neighbour closes the gap, as
//! printers have always done. Only neighbours painted later are gone under, never the background.

use super::weiler_atherton::faces::float;
use super::weiler_atherton::merge::{NOTHING, Patch, Patches};
use super::weiler_atherton::planar::Planar;
use crate::math::DVec2;

/// What the shapes of a map need to know of each other.
pub struct Trap<'a> {
    pub map: &'a Planar,
    pub patches: &'a Patches,
    /// When each patch is painted.
    pub rank: &'a [u32],
    /// Grid steps.
    pub reach: f64,
}

/// The longest miter, as a multiple of the reach.
const MITER: f64 = 4.0;

impl Trap<'_> {
    /// How far shapes may go under each patch: not through it, where it is narrow. Grid steps.
    pub fn room(&self) -> Vec<f64> {
        let of = |patch: &Patch| {
            let (mut area, mut length) = (0.0, 0.0);
            for ring in &patch.rings {
                let at = |i: usize| {
                    float(self.map.points[self.map.start(ring[i % ring.len()]) as usize])
                };
                for i in 0..ring.len() {
                    area += (at(i) - at(0)).perp_dot(at(i + 1) - at(0)) * 0.5;
                    length += at(i).distance(at(i + 1));
                }
            }
            if length > 0.0 { self.reach.min(area / length).max(0.0) } else { 0.0 }
        };
        self.patches.list.iter().map(of).collect()
    }

    /// The rings of a patch, grown; grid coordinates.
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
        let around = self.map.around(vertex);
        let kept = |half: u32| self.beside(half) != self.beside(half ^ 1);
        let at = around.iter().position(|&half| half == out).unwrap_or(0);
        // Clockwise from the edge that goes out, as far as the edge that came in.
        let mut sectors: Vec<(u32, u32)> = Vec::new();
        let mut last = out;
        for k in 1..=around.len() {
            let half = around[(at + around.len() - k) % around.len()];
            if half == out || !kept(half) {
                continue;
            }
            sectors.push((half, last));
            last = half;
            // The edge that came in has the patch on its own left, this one's right.
            if self.beside(half ^ 1) == patch {
                break;
            }
        }
        let later = |half: u32| {
            let other = self.beside(half);
            (other != NOTHING && self.rank[other as usize] > self.rank[patch as usize])
                .then(|| room[other as usize])
        };
        for &(from, to) in sectors.iter().rev() {
            let point = later(from).map_or(place, |room| place + self.bisector(from, to) * room);
            points.push(point);
        }
        if sectors.is_empty() {
            points.push(place);
        }
    }

    /// The patch to the left of a half-edge.
    fn beside(&self, half: u32) -> u32 {
        self.patches.of_face[self.map.face_of[half as usize] as usize]
    }

    /// Into the sector between two half-edges that leave a vertex, to where it is one unit away from both.
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
