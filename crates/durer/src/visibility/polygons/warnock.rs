//! Warnock's area subdivision on polygons.
//!
//! J. Warnock, *A Hidden Surface Algorithm for Computer Generated Halftone Pictures*, University of Utah TR 4-15, 1969.
//! Class: image space. A window is simple if at most one polygon meets it, or if one surrounds it in front of all
//! others, or if it is a pixel; a window that is not simple is divided into four. Cost: O(windows · polygons that meet
//! them), where windows follow the visible edges; memory O(rows of polygons + windows that wait · polygons).
//!
//! Deviations: windows are whole pixels, and a polygon's relation to a window is decided by the centres that it covers,
//! so that the picture is the z-buffer's. [`crate::visibility::surface::warnock`] is the same for the triangles of
//! models, with samples below pixels and surfaces that blend.

use super::{Face, Screen};
use crate::Result;
use crate::info::{Class, Coherence, Info, Occluder};
use crate::math::DVec2;
use crate::raster::span::Span;
use crate::sorting::CompactSort;
use crate::target::{NO_ITEM, Pixels};
use crate::trace::{PseudocodeLine, Tracer};
use crate::visibility::surface::warnock::Division;
use crate::visibility::surface::window::{SampleRect, WindowRelation};

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "warnock-polygons",
    title: "Warnock's area subdivision of polygons",
    authors: "J. Warnock",
    year: 1969,
    source: "A Hidden Surface Algorithm for Computer Generated Halftone Pictures, University of Utah",
    class: Class::ImageSpace,
    occluder: Occluder::Area,
    coherence: &[Coherence::Area],
    cost: "O(windows · polygons that concern them) time, O(rows of polygons) memory",
    limits: "one sample per pixel; plane polygons",
    pseudocode: &[
        "look(window, polygons): begin with the whole picture and all polygons",
        "    for each polygon: is it outside, inside, crossing or surrounding?",
        "    rule 1: all are outside: the window shows the background",
        "    rule 2: one alone is inside, crossing or surrounding: draw its part in the window",
        "    rule 3: one surrounds the window, at all four corners in front of all others: fill the window",
        "    rule 4: the window is one pixel: the nearest polygon there",
        "    no rule holds: divide the window in four,",
        "        look at each with the polygons that are not outside",
    ],
};

/// Options for dividing windows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Options {
    /// Places at which windows are divided.
    pub division: Division,
}

/// A rule by which a window is simple.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum WindowRule {
    /// Rule 1: all polygons are outside.
    Empty,
    /// Rule 2: one polygon is inside, crosses or surrounds the window.
    Single,
    /// Rule 3: one polygon surrounds the window and is in front of all others.
    Surrounded,
    /// Rule 4: the window is one pixel.
    Pixel,
}

impl WindowRule {
    /// Returns the rule's number.
    pub const fn number(self) -> u8 {
        match self {
            Self::Empty => 1,
            Self::Single => 2,
            Self::Surrounded => 3,
            Self::Pixel => 4,
        }
    }
}

/// Step of the algorithm.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Step {
    /// A window is examined.
    Look {
        /// The window, in pixels.
        window: SampleRect,
        /// Relation of each polygon that was not outside of the window around it.
        relations: Vec<(u32, WindowRelation)>,
    },
    /// The window is simple.
    Simple {
        /// The window.
        window: SampleRect,
        /// The rule that holds.
        rule: WindowRule,
        /// The polygon that is drawn, if one is.
        face: Option<u32>,
    },
    /// The window is divided before a column and a row.
    Divide {
        /// The window.
        window: SampleRect,
        /// First column of the right half.
        x: i32,
        /// First row of the lower half.
        y: i32,
    },
    /// A run of pixels of the polygon that is drawn.
    Draw {
        /// The polygon.
        face: u32,
        /// Row, first column, and the column after the last.
        span: [i32; 3],
    },
}

impl PseudocodeLine for Step {
    fn line(&self) -> usize {
        match self {
            Self::Look { .. } => 2,
            Self::Simple { rule, .. } => 2 + usize::from(rule.number()),
            Self::Divide { .. } => 7,
            Self::Draw { .. } => 4,
        }
    }
}

/// Returns the picture that a list of steps leads to.
///
/// # Errors
/// [`Memory`](crate::Error::Memory) if the screen's budget does not suffice.
pub fn replay(screen: &Screen, steps: &[Step]) -> Result<Pixels<u32>> {
    let runs = steps.iter().filter_map(|step| match *step {
        Step::Draw { face, span: [y, x0, x1] } => {
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
pub fn items(
    faces: &[Face],
    screen: &Screen,
    options: &Options,
    t: &mut impl Tracer<Step>,
) -> Result<Pixels<u32>> {
    let _table = screen.edge_table(faces)?;
    let mut charge = screen.work.charge("polygons in windows", 0)?;
    let mut cover = |face| {
        let cover = Cover::new(face, screen);
        charge.grow((cover.spans.len() * size_of::<Span>()) as u64)?;
        Ok(cover)
    };
    let covers = faces.iter().map(&mut cover).collect::<Result<_>>()?;
    let mut painter = Painter { covers, items: screen.plane(NO_ITEM)? };
    // The polygons of all windows that wait.
    let mut lists = screen.work.charge("polygons in windows", 0)?;
    let mut listed = faces.len();
    let [x1, y1] =
        [screen.width, screen.height].map(|side| i32::try_from(side).unwrap_or(i32::MAX));
    let mut waiting =
        vec![(SampleRect { x0: 0, y0: 0, x1, y1 }, (0..faces.len() as u32).collect())];
    while let Some((window, concerned)) = waiting.pop() {
        let concerned: Vec<u32> = concerned;
        listed -= concerned.len();
        if window.is_empty() {
            continue;
        }
        let relations = painter.relations(&window, concerned);
        t.step(|| Step::Look { window, relations: relations.clone() });
        let concerned: Vec<u32> = (relations.iter())
            .filter(|(_, relation)| *relation != WindowRelation::Outside)
            .map(|(face, _)| *face)
            .collect();
        if let Some((rule, face)) = simple(faces, &window, &relations, &concerned) {
            t.step(|| Step::Simple { window, rule, face });
            if let Some(face) = face {
                painter.draw(face, &window, t);
            }
            continue;
        }
        let [x, y] = division(faces, &window, &concerned, options.division);
        t.step(|| Step::Divide { window, x, y });
        listed += 4 * concerned.len();
        lists.grow_to((listed * size_of::<u32>()) as u64)?;
        // The upper left one is examined first.
        let SampleRect { x0, y0, x1, y1 } = window;
        for (x0, y0, x1, y1) in [(x, y, x1, y1), (x0, y, x, y1), (x, y0, x1, y), (x0, y0, x, y)] {
            waiting.push((SampleRect { x0, y0, x1, y1 }, concerned.clone()));
        }
    }
    Ok(painter.items)
}

/// Returns the rule by which a window is simple, and the polygon to draw there.
fn simple(
    faces: &[Face],
    window: &SampleRect,
    relations: &[(u32, WindowRelation)],
    concerned: &[u32],
) -> Option<(WindowRule, Option<u32>)> {
    match concerned {
        [] => return Some((WindowRule::Empty, None)),
        [face] => return Some((WindowRule::Single, Some(*face))),
        _ => {}
    }
    let is_surrounding =
        |(_, relation): &&(u32, WindowRelation)| *relation == WindowRelation::Surrounding;
    let in_front = |face: &u32| concerned.iter().all(|other| hides(faces, window, *face, *other));
    let mut surrounding = relations.iter().filter(is_surrounding).map(|(face, _)| *face);
    let is_pixel = window.x1 - window.x0 == 1 && window.y1 - window.y0 == 1;
    let rule = if is_pixel { WindowRule::Pixel } else { WindowRule::Surrounded };
    // A polygon that covers the only centre of a pixel surrounds it.
    surrounding
        .clone()
        .find(in_front)
        .or(surrounding.next_back().filter(|_| is_pixel))
        .map(|f| (rule, Some(f)))
}

/// Returns whether a face is in front of another one's plane at the pixels in all corners of a window.
fn hides(faces: &[Face], window: &SampleRect, face: u32, other: u32) -> bool {
    let depth = |face: u32, [x, y]: [i32; 2]| faces[face as usize].at(x, y).z;
    window.corners().into_iter().all(|at| {
        let [own, theirs] = [face, other].map(|face| depth(face, at));
        own < theirs || (own == theirs && face <= other)
    })
}

/// Returns the column and the row before which a window is divided: its middle, or the corner of a polygon in it that
/// is nearest to the middle.
fn division(
    faces: &[Face],
    window: &SampleRect,
    concerned: &[u32],
    division: Division,
) -> [i32; 2] {
    let SampleRect { x0, y0, x1, y1 } = *window;
    let middle = [x0 + (x1 - x0) / 2, y0 + (y1 - y0) / 2];
    // Both halves of a side of one pixel are the side itself and nothing.
    let middle =
        [if x1 - x0 == 1 { x1 } else { middle[0] }, if y1 - y0 == 1 { y1 } else { middle[1] }];
    if division == Division::Regular {
        return middle;
    }
    let at = DVec2::new(middle[0].into(), middle[1].into());
    let corners = concerned.iter().flat_map(|face| faces[*face as usize].corners());
    let rounded = corners.map(|corner| (corner.truncate() + 0.5).floor());
    let is_within = |p: &DVec2| {
        let within = |p: f64, from: i32, to: i32| p > f64::from(from) && p < f64::from(to);
        within(p.x, x0, x1) && within(p.y, y0, y1)
    };
    let nearest = rounded
        .filter(is_within)
        .min_by(|a, b| a.distance_squared(at).total_cmp(&b.distance_squared(at)));
    nearest.map_or(middle, |p| [p.x as i32, p.y as i32])
}

/// The pixels whose centres a face covers.
struct Cover {
    /// Runs, row by row.
    spans: Vec<Span>,
    count: i64,
}

impl Cover {
    fn new(face: &Face, screen: &Screen) -> Self {
        let mut spans = Vec::new();
        face.spans(screen, |span| spans.push(span));
        spans.compact_sort_by_key(|span| (span.y, span.x0));
        let count = spans.iter().map(|span| i64::from(span.x1 - span.x0)).sum();
        Self { spans, count }
    }

    /// Returns the runs within a window.
    fn within(&self, window: &SampleRect) -> impl Iterator<Item = Span> {
        let SampleRect { x0, y0, x1, y1 } = *window;
        let first = self.spans.partition_point(|span| span.y < y0);
        let rows = self.spans[first..].iter().take_while(move |span| span.y < y1);
        let cut = move |span: &Span| Span { y: span.y, x0: span.x0.max(x0), x1: span.x1.min(x1) };
        rows.map(cut).filter(|span| span.x0 < span.x1)
    }
}

/// The faces' pixels, and the picture as it becomes.
struct Painter {
    covers: Vec<Cover>,
    items: Pixels<u32>,
}

impl Painter {
    /// Returns the relation of faces to a window.
    fn relations(&self, window: &SampleRect, faces: Vec<u32>) -> Vec<(u32, WindowRelation)> {
        let size = i64::from(window.x1 - window.x0) * i64::from(window.y1 - window.y0);
        let relation = |face: u32| {
            let cover = &self.covers[face as usize];
            let inside: i64 = cover.within(window).map(|span| i64::from(span.x1 - span.x0)).sum();
            match inside {
                0 => WindowRelation::Outside,
                _ if inside == size => WindowRelation::Surrounding,
                _ if inside == cover.count => WindowRelation::Inside,
                _ => WindowRelation::Crossing,
            }
        };
        faces.into_iter().map(|face| (face, relation(face))).collect()
    }

    /// Draws the part of a face in a window.
    fn draw(&mut self, face: u32, window: &SampleRect, t: &mut impl Tracer<Step>) {
        for Span { y, x0, x1 } in self.covers[face as usize].within(window) {
            t.step(|| Step::Draw { face, span: [y, x0, x1] });
            (x0..x1).for_each(|x| self.items.set(x as u32, y as u32, face));
        }
    }
}
