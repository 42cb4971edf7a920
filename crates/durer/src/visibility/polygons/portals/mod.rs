//! Cells and portals: rooms are drawn only through the openings through which they are visible.
//!
//! D. Luebke, C. Georges, *Portals and mirrors: simple, fast evaluation of potentially visible sets*, Symposium on
//! Interactive 3D Graphics 1995; cells and portals by C. B. Jones, *A new approach to the 'hidden line' problem*, The
//! Computer Journal 14(3), 1971. Class: image space for the windows, with an order of cells from near to far. A model
//! is divided into cells with opaque walls, which are connected by openings, the portals. The part of a cell visible
//! through a portal is inside the rectangle around the portal on the screen; through a row of portals, inside the
//! intersection of their rectangles. If that is empty, nothing behind the portal is drawn. Cost: O(visited cells and
//! their walls and portals), independent of the size of the model; walls are drawn by a z-buffer.
//!
//! **Cells are convex**, so no line of sight enters a cell twice: a cell already on the path is not entered again.
//! Rectangles are widened to whole pixels. A portal that extends to the eye leaves the window unchanged. Mirrors, which
//! the paper treats as portals to a reflected model, are left out.

mod plan;

pub use plan::{ConvexRoom, Plan, Portal};

use super::{Face, Screen, pieces};
use crate::info::{Class, Coherence, Info, Occluder};
use crate::math::{DVec2, DVec3, Plane, Rect};
use crate::target::{NO_ITEM, Pixels};
use crate::trace::{PseudocodeLine, Tracer};
use crate::view::cull::{FaceSide as Side, face_from_point, newell_area};
use crate::{Error, Result};

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "portals",
    title: "Cells and portals",
    authors: "David Luebke, Chris Georges",
    year: 1995,
    source: "Portals and mirrors: simple, fast evaluation of potentially visible sets, Symposium on Interactive 3D Graphics",
    class: Class::ImageSpace,
    occluder: Occluder::Area,
    coherence: &[Coherence::Object, Coherence::Area],
    cost: "O(visited cells, their walls and portals); invisible cells cost nothing",
    limits: "models of closed convex cells; rectangles are larger than portals seen obliquely",
    pseudocode: &[
        "enter(cell of the eye, whole picture)",
        "enter(cell, window):",
        "    draw the walls of the cell, clipped to the window",
        "    for each portal of the cell:",
        "        it leads back to a cell on the way: next portal",
        "        box ← rectangle around the portal's corners on the screen",
        "        box ∩ window is empty: the portal is not seen, next portal",
        "        enter(the cell behind the portal, box ∩ window)",
    ],
};

/// Options for the visit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Options {
    /// Visits of cells at most: a cell is visited once for each row of portals through which it is seen.
    pub max_visits: usize,
}

impl Default for Options {
    /// Returns the default: a million visits.
    fn default() -> Self {
        Self { max_visits: 1 << 20 }
    }
}

/// The eye: it looks along z, x to the right and y down.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlanEye {
    /// Position.
    pub at: DVec3,
    /// Cell in which it is.
    pub cell: usize,
    /// Distance of the picture plane, pixels: half the width of the picture for a view of 90 degrees.
    pub focal: f64,
}

/// Nearer to the eye than this in z, nothing is drawn; a power of two, so that it rounds nothing.
const NEAR: f64 = 1.0 / 1024.0;

impl PlanEye {
    /// Returns a polygon on the screen with −focal / z as depth, which is plane for plane polygons; `None` if all of it
    /// is behind the eye.
    fn project(&self, polygon: &[DVec3], screen: &Screen) -> Option<Vec<DVec3>> {
        let seen: Vec<DVec3> = polygon.iter().map(|p| *p - self.at).collect();
        let near = Plane { normal: DVec3::Z, distance: -NEAR };
        let seen = pieces::part(&near, 1.0, &seen);
        let middle = DVec2::new(screen.width.into(), screen.height.into()) / 2.0;
        let project =
            |p: DVec3| (middle + p.truncate() * (self.focal / p.z)).extend(-self.focal / p.z);
        (seen.len() > 2).then(|| seen.into_iter().map(project).collect())
    }

    /// Returns the window in which a portal is seen through another one; `None` if there is none.
    fn window(
        &self,
        portal: &Portal,
        through: PortalWindow,
        screen: &Screen,
    ) -> [Option<PortalWindow>; 2] {
        let depth = |p: &DVec3| p.z - self.at.z;
        if portal.corners.iter().all(|p| depth(p) <= 0.0) {
            return [None; 2];
        }
        // Part of it may be seen between the eye and the near plane.
        if portal.corners.iter().any(|p| depth(p) < NEAR) {
            return [Some(through); 2];
        }
        let corners = self.project(&portal.corners, screen).unwrap_or_default();
        let around = Rect::around(corners.iter().map(|p| p.truncate()));
        let whole = PortalWindow { low: [0; 2], high: [screen.width, screen.height] };
        let pixel = |v: f64, limit: u32| v.clamp(0.0, f64::from(limit)) as u32;
        let bounds = around.map(|around| {
            let (low, high) = (around.min().floor(), around.max().ceil());
            let [width, height] = whole.high;
            PortalWindow {
                low: [pixel(low.x, width), pixel(low.y, height)],
                high: [pixel(high.x, width), pixel(high.y, height)],
            }
        });
        [bounds, bounds.and_then(|bounds| bounds.intersected(through))]
    }
}

/// A rectangle of pixels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct PortalWindow {
    /// First column and row.
    pub low: [u32; 2],
    /// Column and row after the last ones.
    pub high: [u32; 2],
}

impl PortalWindow {
    /// Returns the pixels in both windows; `None` if there is none.
    fn intersected(self, other: Self) -> Option<Self> {
        let low = [0, 1].map(|k| self.low[k].max(other.low[k]));
        let high = [0, 1].map(|k| self.high[k].min(other.high[k]));
        (low[0] < high[0] && low[1] < high[1]).then_some(Self { low, high })
    }
}

/// Visit of a cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Visit {
    /// The cell.
    pub cell: usize,
    /// Part of the picture in which it is seen.
    pub window: PortalWindow,
    /// Portals on the way from the eye.
    pub portals: usize,
}

/// Step of the algorithm.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Step {
    /// A cell is entered, and its walls are drawn within the window.
    Enter(Visit),
    /// A portal leads back to a cell on the way.
    Back {
        /// The cell.
        cell: usize,
        /// Number of the portal in it.
        portal: usize,
    },
    /// The rectangle around a portal was intersected with the window.
    Portal {
        /// The cell.
        cell: usize,
        /// Number of the portal in it.
        portal: usize,
        /// The rectangle; none for a portal behind the eye.
        bounds: Option<PortalWindow>,
        /// The intersection; none if the portal is not seen.
        window: Option<PortalWindow>,
    },
}

impl PseudocodeLine for Step {
    fn line(&self) -> usize {
        match self {
            Self::Enter(Visit { portals: 0, .. }) => 1,
            Self::Enter(_) => 3,
            Self::Back { .. } => 5,
            Self::Portal { window: None, .. } => 7,
            Self::Portal { window: Some(_), .. } => 6,
        }
    }
}

/// Returns the visits that a list of steps leads to.
pub fn replay(steps: &[Step]) -> Vec<Visit> {
    let visit = |step: &Step| if let Step::Enter(visit) = step { Some(*visit) } else { None };
    steps.iter().filter_map(visit).collect()
}

/// A cell that is being visited.
struct Open {
    cell: usize,
    window: PortalWindow,
    /// Next portal to look through.
    next: usize,
}

/// Returns the cells that are seen from the eye, each with the window in which it is seen; a cell that is seen through
/// several portals comes several times.
///
/// # Errors
/// [`Error::Dangling`] for an eye in no cell of the plan; [`Error::Limit`] for more visits than the options allow;
/// [`Memory`](Error::Memory) where the screen's budget does not suffice.
pub fn visits(
    plan: &Plan,
    eye: &PlanEye,
    screen: &Screen,
    options: &Options,
    t: &mut impl Tracer<Step>,
) -> Result<Vec<Visit>> {
    let (cells, count) = (plan.cells(), plan.cells().len());
    if eye.cell >= count {
        return Err(Error::Dangling { what: "cell", index: eye.cell, count });
    }
    let mut charge = screen.work.charge("visits of cells", 0)?;
    let mut visits = Vec::new();
    let mut enter = |way: &mut Vec<Open>, cell: usize, window: PortalWindow, t: &mut _| {
        if visits.len() >= options.max_visits {
            let (value, limit) = (visits.len() as u64 + 1, options.max_visits as u64);
            return Err(Error::Limit { what: "number of visits of cells", value, limit });
        }
        charge.grow(size_of::<(Visit, Open)>() as u64)?;
        let visit = Visit { cell, window, portals: way.len() };
        report(t, Step::Enter(visit));
        visits.push(visit);
        way.push(Open { cell, window, next: 0 });
        Ok(())
    };
    let mut way = Vec::new();
    if screen.width > 0 && screen.height > 0 {
        let window = PortalWindow { low: [0; 2], high: [screen.width, screen.height] };
        enter(&mut way, eye.cell, window, t)?;
    }
    while let Some(open) = way.last_mut() {
        let Open { cell, window: through, next: portal } = *open;
        let Some(opening) = cells[cell].portals.get(portal) else {
            way.pop();
            continue;
        };
        open.next += 1;
        if way.iter().any(|open| open.cell == opening.to) {
            t.step(|| Step::Back { cell, portal });
            continue;
        }
        let [bounds, window] = eye.window(opening, through, screen);
        t.step(|| Step::Portal { cell, portal, bounds, window });
        if let Some(window) = window {
            enter(&mut way, opening.to, window, t)?;
        }
    }
    Ok(visits)
}

/// Reports a step that exists already.
fn report(t: &mut impl Tracer<Step>, step: Step) {
    t.step(|| step);
}

/// A wall on the screen.
#[derive(Debug, Clone, PartialEq)]
pub struct Wall {
    /// Its number in the plan, that of its cell's walls after those of all cells before it.
    pub item: u32,
    /// Its polygon; depths grow with the distance from the eye.
    pub face: Face,
}

/// Returns the walls of a cell whose front the eye sees, on the screen.
///
/// # Errors
/// [`Error::Dangling`] for a cell that is not there; those of [`Face::new`].
pub fn walls(plan: &Plan, cell: usize, eye: &PlanEye, screen: &Screen) -> Result<Vec<Wall>> {
    let count = plan.cells().len();
    let own = plan.cells().get(cell).ok_or(Error::Dangling { what: "cell", index: cell, count })?;
    let before: usize = plan.cells().iter().take(cell).map(|cell| cell.walls.len()).sum();
    let mut walls = Vec::new();
    for (item, wall) in (before as u32..).zip(&own.walls) {
        let first = wall.first().copied().unwrap_or_default();
        if face_from_point(newell_area(wall), first, eye.at) != Side::Front {
            continue;
        }
        if let Some(corners) = eye.project(wall, screen) {
            walls.push(Wall { item, face: Face::new(&corners)? });
        }
    }
    Ok(walls)
}

/// Returns the number of the nearest wall at each pixel's centre; only walls of visited cells are drawn, and only in
/// the windows of their visits.
///
/// ```
/// use durer::math::{DVec2, DVec3};
/// use durer::trace::NoTrace;
/// use durer::visibility::polygons::Screen;
/// use durer::visibility::polygons::portals::{PlanEye, Plan, items, visits};
///
/// // Two rooms with a door between them, and a third one behind a wall.
/// let room = |y: f64| [(0.0, y), (4.0, y), (4.0, y + 4.0), (0.0, y + 4.0)].map(DVec2::from).to_vec();
/// let door = [DVec2::new(1.0, 4.0), DVec2::new(2.0, 4.0)];
/// let plan = Plan::of_rooms(&[room(0.0), room(4.0), room(8.0)], &[door], 2.0)?;
/// let eye = PlanEye { at: DVec3::new(1.5, 0.0, 1.0), cell: 0, focal: 8.0 };
/// let screen = Screen { width: 16, height: 8, ..Screen::default() };
/// let seen = visits(&plan, &eye, &screen, &Default::default(), &mut NoTrace)?;
/// assert_eq!(seen.iter().map(|visit| visit.cell).collect::<Vec<_>>(), [0, 1]);
/// let picture = items(&plan, &eye, &screen, &Default::default(), &mut NoTrace)?;
/// assert_eq!((picture.width(), picture.height()), (16, 8));
/// # Ok::<(), durer::Error>(())
/// ```
///
/// # Errors
/// Those of [`visits`] and [`walls`]; [`Memory`](Error::Memory) where the screen's budget does not suffice.
pub fn items(
    plan: &Plan,
    eye: &PlanEye,
    screen: &Screen,
    options: &Options,
    t: &mut impl Tracer<Step>,
) -> Result<Pixels<u32>> {
    let mut depths = screen.plane(f64::INFINITY)?;
    let mut items = screen.plane(NO_ITEM)?;
    for Visit { cell, window: PortalWindow { low, high }, .. } in
        visits(plan, eye, screen, options, t)?
    {
        let walls = walls(plan, cell, eye, screen)?;
        let _table = screen.edge_table(walls.iter().map(|wall| &wall.face))?;
        for Wall { item, face } in walls {
            face.pixels(screen, |[x, y], point| {
                let inside = x >= low[0] && x < high[0] && y >= low[1] && y < high[1];
                if inside && depths.get(x, y).is_some_and(|stored| point.z < stored) {
                    depths.set(x, y, point.z);
                    items.set(x, y, item);
                }
            });
        }
    }
    Ok(items)
}
