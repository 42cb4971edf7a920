//! Cells with their walls and portals, and their construction from a plan of rooms.

use crate::clip::line::{ConvexPolygon, Edge};
use crate::math::{DVec2, DVec3};
use crate::sorting::CompactSort;
use crate::{Error, Result};

/// Opening to another cell.
#[derive(Debug, Clone, PartialEq)]
pub struct Portal {
    /// Corners of the opening, a plane convex polygon.
    pub corners: Vec<DVec3>,
    /// The cell behind it.
    pub to: usize,
}

/// A convex room.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ConvexRoom {
    /// Plane polygons, whose corners run counter-clockwise seen from the inside.
    pub walls: Vec<Vec<DVec3>>,
    /// Its openings.
    pub portals: Vec<Portal>,
}

/// Cells that are connected by portals.
///
/// # Guarantees
/// All corners are finite; every portal leads to a cell of the plan.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Plan {
    cells: Vec<ConvexRoom>,
}

/// Largest distance of a door from the wall that it is in, in units of the plan's extent.
const IN_WALL: f64 = 1e-9;

impl Plan {
    /// Creates a plan.
    ///
    /// # Errors
    /// [`Error::NonFinite`] for a corner; [`Error::Dangling`] for a portal to a cell that is not there.
    pub fn new(cells: Vec<ConvexRoom>) -> Result<Self> {
        let count = cells.len();
        let portals = || cells.iter().flat_map(|cell| &cell.portals);
        if let Some(portal) = portals().find(|portal| portal.to >= count) {
            return Err(Error::Dangling { what: "cell", index: portal.to, count });
        }
        let walls = cells.iter().flat_map(|cell| &cell.walls).flatten();
        let mut corners = walls.chain(portals().flat_map(|portal| &portal.corners));
        match corners.position(|corner| !corner.is_finite()) {
            Some(index) => Err(Error::NonFinite { what: "corner", index }),
            None => Ok(Self { cells }),
        }
    }

    /// Returns the cells.
    pub fn cells(&self) -> &[ConvexRoom] {
        &self.cells
    }

    /// Builds rooms of one height on a plan: convex rings in x and z, and doors as high as the rooms, each with both
    /// ends on walls of two rooms. Walls reach from y = −height / 2 to height / 2; there are no floors and ceilings.
    ///
    /// # Errors
    /// [`Error::Parameter`] for a room that is not convex, and for a door that is not in the walls of two rooms; those
    /// of [`Self::new`].
    pub fn of_rooms(rooms: &[Vec<DVec2>], doors: &[[DVec2; 2]], height: f64) -> Result<Self> {
        let all = || rooms.iter().flatten();
        let extent = all().fold(0.0, |most: f64, p| most.max(p.abs().max_element()));
        let near = extent * IN_WALL;
        let upright = |a: DVec2, b: DVec2| {
            let at = |p: DVec2, y: f64| DVec3::new(p.x, y * height / 2.0, p.y);
            vec![at(a, -1.0), at(b, -1.0), at(b, 1.0), at(a, 1.0)]
        };
        let mut cells = vec![ConvexRoom::default(); rooms.len()];
        let mut sides = vec![Vec::new(); doors.len()];
        for (cell, room) in rooms.iter().enumerate() {
            // Counter-clockwise in x and z, so that walls are so, seen from the inside.
            for Edge { from: a, to: b } in ConvexPolygon::new(room)?.edges() {
                let mut openings: Vec<(f64, f64, usize)> = Vec::new();
                for (door, ends) in doors.iter().enumerate() {
                    if let [Some(s), Some(e)] = ends.map(|end| place(a, b, end, near)) {
                        openings.push((s.min(e), s.max(e), door));
                        sides[door].push(cell);
                    }
                }
                openings.compact_sort_by(|a, b| a.0.total_cmp(&b.0));
                let mut from = a;
                for (_, _, door) in openings {
                    let [s, e] = doors[door];
                    let forward = (e - s).dot(b - a) >= 0.0;
                    let [s, e] = if forward { [s, e] } else { [e, s] };
                    if s != from {
                        cells[cell].walls.push(upright(from, s));
                    }
                    from = e;
                }
                if from != b {
                    cells[cell].walls.push(upright(from, b));
                }
            }
        }
        for (door, [s, e]) in doors.iter().enumerate() {
            let &[a, b] = sides[door].as_slice() else {
                let value = format!("door {door}, in the walls of {} rooms", sides[door].len());
                return Err(Error::parameter("plan", value, "in walls of two rooms"));
            };
            for (cell, to) in [(a, b), (b, a)] {
                cells[cell].portals.push(Portal { corners: upright(*s, *e), to });
            }
        }
        Self::new(cells)
    }
}

/// Returns where along the wall from a to b a point is, 0 … 1; `None` if it is not in the wall.
fn place(a: DVec2, b: DVec2, p: DVec2, near: f64) -> Option<f64> {
    let (way, length) = (b - a, (b - a).length());
    let along = (p - a).dot(way) / length;
    let aside = (p - a).perp_dot(way).abs() / length;
    let within = along >= -near && along <= length + near;
    (aside <= near && within).then_some(along / length)
}
