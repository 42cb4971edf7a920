//! Welding: vertices at one position get one number.
//!
//! Formats without shared vertices (STL) and exporters that write a vertex per face leave edges without neighbours;
//! here these are found. O(n) time and memory, by hashing positions.

use crate::math::{DVec3, Vec3};
use crate::scene::Aabb;
use crate::{Error, Result};

/// Largest difference of coordinates that count as equal, as a part of the model's extent, as in
/// [`crate::view::topology::mesh_topology`].
const TOLERANCE: f64 = 1.0 / (1u64 << 26) as f64;

/// Cells per extent. A cell is 64 tolerances wide, so few points must be looked up in two cells,
/// and still so small that hardly any two points share one.
const CELLS: f64 = (1u64 << 20) as f64;

/// Rule that joins vertices.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Weld {
    /// Vertices of one mesh that are at one place, up to 2⁻²⁶ of the mesh's extent; and, within one object
    /// ([`Scene::trees`]), ends of borders that coincide to the precision of their coordinates: 2⁻¹⁶ of the largest, or
    /// one unit of the last decimal. Borders along each other are joined too, even if their vertices differ.
    ///
    /// [`Scene::trees`]: crate::scene::Scene::trees
    #[default]
    Auto,
    /// Vertices of one mesh whose coordinates are equal.
    None,
    /// Like [`Self::Auto`], but with this largest distance between borders, in units of the world.
    Within(f64),
}

impl Weld {
    /// Checks the length.
    ///
    /// # Errors
    /// [`Error::Parameter`] for a length that is negative or not finite.
    pub(crate) fn check(self) -> Result<()> {
        match self {
            Self::Within(length) if !(length.is_finite() && length >= 0.0) => {
                Err(Error::parameter("weld", length, "a length, 0 or more"))
            }
            _ => Ok(()),
        }
    }
}

/// Result of [`weld`].
pub(super) struct Welded {
    /// For each vertex the number of its place; places are numbered in order of first use.
    pub place: Vec<u32>,
    /// The first vertex of each place.
    pub first: Vec<u32>,
    /// Bounds of the finite ones, if there are any.
    pub bounds: Option<Aabb>,
}

/// Numbers the distinct places of the vertices, or, if not `exactly`, those within [`TOLERANCE`]. Those that are not
/// finite stay alone.
pub(super) fn weld(positions: &[Vec3], exactly: bool) -> Welded {
    let Some(bounds) = Aabb::around(positions.iter().map(|p| p.as_dvec3())) else {
        return alone(positions.len());
    };
    let extent = bounds.size().max_element();
    let tolerance = if exactly { 0.0 } else { extent * TOLERANCE };
    let scale = if extent > 0.0 { CELLS / extent } else { 0.0 };
    let mut table = Table::new(positions.len());
    let place = Vec::with_capacity(positions.len());
    let mut found = Welded { place, first: Vec::new(), bounds: Some(bounds) };
    for (p, vertex) in positions.iter().zip(0u32..) {
        let exact = p.as_dvec3();
        let cell = (exact - bounds.min) * scale;
        let known = if exact.is_finite() {
            let near = |v: u32| {
                let other = positions[v as usize].as_dvec3();
                (other - exact).abs().max_element() <= tolerance
            };
            lookups(cell).find_map(|c| table.find(c, |place| near(found.first[place as usize])))
        } else {
            None
        };
        let place = known.unwrap_or_else(|| {
            let place = found.first.len() as u32;
            found.first.push(vertex);
            if exact.is_finite() {
                table.insert(cell.to_array().map(|c| c as u32), place);
            }
            place
        });
        found.place.push(place);
    }
    found
}

fn alone(count: usize) -> Welded {
    let all: Vec<u32> = (0..count as u32).collect();
    Welded { place: all.clone(), first: all, bounds: None }
}

/// Returns the cells in which a point within tolerance may have been entered, its own first.
fn lookups(cell: DVec3) -> impl Iterator<Item = [u32; 3]> {
    let margin = TOLERANCE * CELLS;
    let own = cell.to_array().map(|c| c as u32);
    let step = cell.to_array().map(|c| {
        let rest = c - c.floor();
        if rest <= margin {
            -1
        } else if rest >= 1.0 - margin {
            1
        } else {
            0
        }
    });
    (0..8u32).filter_map(move |choice| {
        let mut c = own;
        for axis in 0..3 {
            if choice >> axis & 1 == 1 {
                if step[axis] == 0 {
                    return None;
                }
                c[axis] = own[axis].checked_add_signed(step[axis])?;
            }
        }
        Some(c)
    })
}

/// An open-addressing hash table from cells to places; never grows, never holds more than half.
struct Table {
    /// Place + 1, or 0.
    slots: Vec<u32>,
    mask: usize,
}

impl Table {
    fn new(count: usize) -> Self {
        let size = (count.max(4) * 2).next_power_of_two();
        Self { slots: vec![0; size], mask: size - 1 }
    }

    fn start(&self, [x, y, z]: [u32; 3]) -> usize {
        let mix = |h: u64, v: u32| (h ^ u64::from(v)).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        let h = mix(mix(mix(0, x) >> 7, y) >> 5, z);
        (h >> 24) as usize & self.mask
    }

    fn find(&self, cell: [u32; 3], is: impl Fn(u32) -> bool) -> Option<u32> {
        let mut i = self.start(cell);
        while let Some(place) = self.slots[i].checked_sub(1) {
            if is(place) {
                return Some(place);
            }
            i = (i + 1) & self.mask;
        }
        None
    }

    fn insert(&mut self, cell: [u32; 3], place: u32) {
        let mut i = self.start(cell);
        while self.slots[i] != 0 {
            i = (i + 1) & self.mask;
        }
        self.slots[i] = place + 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_within_tolerance_are_one_and_others_are_not() {
        let p = Vec3::new;
        let positions = [
            p(0.0, 0.0, 1.0),
            p(5e-17, -0.0, 1.0),
            p(1.0, 0.0, 0.0),
            p(f32::NAN, 0.0, 0.0),
            p(1e-6, 0.0, 1.0),
            p(1.0, 0.0, -5e-17),
        ];
        let welded = weld(&positions, false);
        assert_eq!(welded.place, [0, 0, 1, 2, 3, 1]);
        assert_eq!(welded.first, [0, 2, 3, 4]);
        assert_eq!(weld(&positions, true).place, [0, 1, 2, 3, 4, 5]);
    }
}
