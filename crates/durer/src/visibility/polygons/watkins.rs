//! The spanning scan line with its three tables.
//!
//! G. S. Watkins, *A Real Time Visible Surface Algorithm*, dissertation, University of Utah, 1970; after W. J.
//! Bouknight, CACM 13(9), 1970. Class: image space. The edge table has all edges by first row, with x there, last row,
//! Δx/Δy and their polygon; the polygon table has each polygon's plane and an in/out flag. In each row the active edges
//! are sorted by x; passing one inverts its polygon's flag, and between two of them the set of polygons does not
//! change. A polygon that is nearest at both ends of such a span is nearest in all of it, because planes are linear; if
//! the nearest one changes, the span is halved. Coherence used: edges, scan lines, spans. Cost: O(n log n) for n edges,
//! then per row O(e log e + spans · d) for e active edges and d overlapping polygons.
//! [`crate::visibility::surface::spanning_scan_line`] renders models.

use super::{Face, Screen};
use crate::Result;
use crate::info::{Class, Coherence, Info, Occluder};
use crate::math::DVec2;
use crate::raster::polygon::edge_table::{TableEdge, table};
use crate::sorting::CompactSort;
use crate::target::{NO_ITEM, Pixels};
use crate::trace::{PseudocodeLine, Tracer};

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "watkins",
    title: "Watkins' spanning scan line, with its tables",
    authors: "G. S. Watkins",
    year: 1970,
    source: "A Real Time Visible Surface Algorithm, University of Utah",
    class: Class::ImageSpace,
    occluder: Occluder::Line,
    coherence: &[Coherence::Edge, Coherence::ScanLine, Coherence::Span, Coherence::Depth],
    cost: "O(n log n + rows · (e log e + spans · d)) for n edges, e active ones, d deep",
    limits: "one sample per pixel; plane polygons",
    pseudocode: &[
        "ET ← all edges by first row: x, y_max, Δx/Δy, polygon",
        "PT ← for each polygon its plane and a flag, out",
        "for each row:",
        "    move the edges that begin here from the ET to the AET",
        "    sort the AET by x",
        "    for each edge of the AET, from left to right:",
        "        if polygons are in between the edge before and this one:",
        "            find the nearest of them at both ends of the span",
        "            if it is the same one: fill the span with it",
        "            else: halve the span and decide both halves",
        "        invert the flag of the edge's polygon",
        "    remove the edges that end here; x ← x + Δx/Δy of the others",
    ],
};

/// An entry of the edge table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct EdgeEntry {
    /// x at the first row, one past the last row, Δx/Δy.
    pub edge: TableEdge,
    /// The polygon that it bounds.
    pub face: u32,
}

/// Step of the algorithm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step {
    /// An entry of the edge table, by first row.
    Edge(EdgeEntry),
    /// An entry of the polygon table; its flag is out.
    Polygon {
        /// Its index.
        face: u32,
        /// z = origin + slope · (x, y), in pixels.
        slope: DVec2,
        /// z at the picture's upper left corner.
        origin: f64,
    },
    /// A row begins.
    Row {
        /// The row.
        y: i32,
    },
    /// An entry of the row's active edge table, in the order of x.
    Active(EdgeEntry),
    /// An edge is passed: its polygon's flag is turned over.
    Flag {
        /// The polygon.
        face: u32,
        /// The column.
        x: i32,
        /// True if the polygon is in from here on.
        inside: bool,
    },
    /// The polygons that are in a span are compared at its ends.
    Ends {
        /// First column and the one after the last.
        columns: [i32; 2],
        /// Number of polygons that are in.
        polygons: usize,
        /// The nearest one at the first column and at the last.
        nearest: [u32; 2],
        /// Their depths there.
        depths: [f64; 2],
    },
    /// A polygon is seen in a span.
    Span {
        /// The polygon.
        face: u32,
        /// Row.
        y: i32,
        /// First column and the one after the last.
        columns: [i32; 2],
    },
}

impl PseudocodeLine for Step {
    fn line(&self) -> usize {
        match self {
            Self::Edge(_) => 1,
            Self::Polygon { .. } => 2,
            Self::Row { .. } => 3,
            Self::Active(_) => 5,
            Self::Ends { .. } => 8,
            Self::Span { .. } => 9,
            Self::Flag { .. } => 11,
        }
    }
}

/// Returns the picture that a list of steps leads to.
///
/// # Errors
/// [`Memory`](crate::Error::Memory) if the screen's budget does not suffice.
pub fn replay(screen: &Screen, steps: &[Step]) -> Result<Pixels<u32>> {
    let runs = steps.iter().filter_map(|step| match *step {
        Step::Span { face, y, columns: [x0, x1] } => {
            Some((x0..x1).map(move |x| ([x as u32, y as u32], face)))
        }
        _ => None,
    });
    screen.painted(runs.flatten())
}

/// Returns the index of the nearest face at each pixel's centre, of equally near ones the first.
///
/// # Errors
/// [`Memory`](crate::Error::Memory) if the screen's budget does not suffice.
pub fn items(faces: &[Face], screen: &Screen, t: &mut impl Tracer<Step>) -> Result<Pixels<u32>> {
    let mut items = screen.plane(NO_ITEM)?;
    let edges = faces.iter().map(|face| face.corners().len() as u64).sum();
    // Each edge is in the table, then among the active ones.
    let _charge = screen.work.charge_for::<[EdgeEntry; 2]>("edge table", edges)?;
    let mut waiting = edge_table(faces, screen);
    waiting.iter().rev().for_each(|&entry| t.step(|| Step::Edge(entry)));
    for (face, own) in (0..).zip(faces) {
        t.step(|| polygon_entry(face, own));
    }
    let mut active: Vec<EdgeEntry> = Vec::new();
    for y in 0..screen.height.min(i32::MAX as u32) as i32 {
        while let Some(entry) = waiting.pop_if(|entry| entry.edge.rows.0 == y) {
            active.push(entry);
        }
        if active.is_empty() {
            continue;
        }
        t.step(|| Step::Row { y });
        active.compact_sort_by_key(|entry| (entry.edge.x, entry.face));
        active.iter().for_each(|&entry| t.step(|| Step::Active(entry)));
        Row { faces, y, width: screen.width }.sweep(&active, &mut items, t);
        active.retain(|entry| entry.edge.rows.1 > y + 1);
        active.iter_mut().for_each(|entry| entry.edge.advance());
    }
    Ok(items)
}

fn polygon_entry(face: u32, own: &Face) -> Step {
    let z = |x, y| own.depth(DVec2::new(x, y));
    let origin = z(0.0, 0.0);
    Step::Polygon { face, slope: DVec2::new(z(1.0, 0.0) - origin, z(0.0, 1.0) - origin), origin }
}

/// Returns all edges, ordered so that the first rows' come last.
fn edge_table(faces: &[Face], screen: &Screen) -> Vec<EdgeEntry> {
    let of = |(face, own): (u32, &Face)| {
        table(&own.contours(), screen.height).into_iter().map(move |edge| EdgeEntry { edge, face })
    };
    let mut entries: Vec<EdgeEntry> = (0..).zip(faces).flat_map(of).collect();
    entries.compact_sort_by_key(|entry| {
        std::cmp::Reverse((entry.edge.rows.0, entry.edge.x, entry.face))
    });
    entries
}

/// One row of the picture.
struct Row<'a> {
    faces: &'a [Face],
    y: i32,
    width: u32,
}

impl Row<'_> {
    /// Passes the active edges, in the order of x.
    fn sweep(&self, active: &[EdgeEntry], items: &mut Pixels<u32>, t: &mut impl Tracer<Step>) {
        let last = i64::from(self.width.min(i32::MAX as u32));
        let (mut inside, mut from): (Vec<u32>, i32) = (Vec::new(), 0);
        for entry in active {
            let x = entry.edge.x.clamp(0, last) as i32;
            if from < x && !inside.is_empty() {
                self.span(&inside, [from, x], items, t);
            }
            let place = inside.iter().position(|&face| face == entry.face);
            match place {
                Some(place) => drop(inside.remove(place)),
                None => inside.push(entry.face),
            }
            t.step(|| Step::Flag { face: entry.face, x, inside: place.is_none() });
            from = x;
        }
    }

    /// Finds the visible polygon where the same polygons are active.
    fn span(
        &self,
        inside: &[u32],
        columns: [i32; 2],
        items: &mut Pixels<u32>,
        t: &mut impl Tracer<Step>,
    ) {
        let mut parts = vec![columns];
        while let Some(columns @ [x0, x1]) = parts.pop() {
            let nearest = [x0, x1 - 1].map(|x| self.nearest(inside, x));
            t.step(|| {
                let depths = [self.depth(nearest[0], x0), self.depth(nearest[1], x1 - 1)];
                Step::Ends { columns, polygons: inside.len(), nearest, depths }
            });
            if nearest[0] == nearest[1] {
                let face = nearest[0];
                t.step(|| Step::Span { face, y: self.y, columns });
                (x0..x1).for_each(|x| items.set(x as u32, self.y as u32, face));
            } else {
                let middle = x0 + (x1 - x0) / 2;
                parts.extend([[middle, x1], [x0, middle]]);
            }
        }
    }

    /// Returns a polygon's depth at a column; infinity for no polygon.
    fn depth(&self, face: u32, x: i32) -> f64 {
        self.faces.get(face as usize).map_or(f64::INFINITY, |face| face.at(x, self.y).z)
    }

    /// Returns the nearest polygon at a column, the first of equally near ones.
    fn nearest(&self, inside: &[u32], x: i32) -> u32 {
        let nearer =
            |&a: &u32, &b: &u32| self.depth(a, x).total_cmp(&self.depth(b, x)).then(a.cmp(&b));
        inside.iter().copied().min_by(nearer).unwrap_or(NO_ITEM)
    }
}
