//! Solids combined by set operations, scan line by scan line.
//!
//! P. R. Atherton, *A scan-line hidden surface removal procedure for constructive solid geometry*, SIGGRAPH 1983.
//! Class: image space. A row of the picture cuts the faces of closed solids into runs of pixels; between two ends of
//! runs the covering faces are sorted by depth. From front to back each face leads into its solid or out of it, and the
//! first one after which the expression holds is visible: the combined surface is never computed. A span whose order
//! differs at both ends is divided. Cost: O(n log n + rows · (r log r + spans · f (log f + t))): r runs in a row, f
//! faces of a span, t terms of the expression.
//!
//! Deviations: spans with faces that change their order are halved until the order is constant, down to a pixel, where
//! the paper divides them at the crossing; the eye looks along z in parallel, from outside all solids. Faces at one
//! depth are passed together, and the first of them is visible.

use super::{Face, Screen};
use crate::clip::polygon::BooleanOp;
use crate::info::{Class, Coherence, Info, Occluder};
use crate::sorting::CompactSort;
use crate::target::{NO_ITEM, Pixels};
use crate::trace::{PseudocodeLine, Tracer};
use crate::{Error, Result};

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "csg-scan-line",
    title: "Scan lines for constructive solid geometry",
    authors: "Peter R. Atherton",
    year: 1983,
    source: "A scan-line hidden surface removal procedure for constructive solid geometry, SIGGRAPH 1983",
    class: Class::ImageSpace,
    occluder: Occluder::Line,
    coherence: &[Coherence::Span, Coherence::Depth],
    cost: "O(rows · spans · f (log f + t)): f faces in a span, t terms of the expression",
    limits: "closed solids of plane polygons, seen from outside; one sample per pixel",
    pseudocode: &[
        "for each row of the picture:",
        "    cut the faces by the row: runs of pixels, each with a depth at every pixel",
        "    for each span between the ends of runs, and the faces that cover it:",
        "        sort these faces by depth at the left end",
        "        their order at the right end differs: divide the span, take its halves",
        "        inside ← false for each solid",
        "        for each face from front to back:",
        "            inside of its solid ← not inside",
        "            the expression holds: fill the span with this face, next span",
        "        no face is left: the span stays empty",
    ],
};

/// Term of an expression in reverse Polish notation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Term {
    /// A solid, by its number.
    Solid(usize),
    /// An operation on the two results before it.
    Op(BooleanOp),
}

/// An expression of solids.
///
/// ```
/// use durer::clip::polygon::BooleanOp;
/// use durer::visibility::polygons::csg::{Expression, Term};
///
/// // A − (B ∪ C)
/// let union = Term::Op(BooleanOp::Union);
/// let difference = Term::Op(BooleanOp::Difference);
/// let terms = [Term::Solid(0), Term::Solid(1), Term::Solid(2), union, difference];
/// let expression = Expression::new(&terms)?;
/// assert!(expression.holds(&[true, false, false]) && !expression.holds(&[true, false, true]));
/// # Ok::<(), durer::Error>(())
/// ```
///
/// # Guarantees
/// Every operation has two operands, and one result is left.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Expression {
    terms: Vec<Term>,
}

impl Expression {
    /// Creates an expression from terms in reverse Polish notation.
    ///
    /// # Errors
    /// [`Error::Parameter`] for an operation without two operands, and for more or fewer results than one.
    pub fn new(terms: &[Term]) -> Result<Self> {
        let mut results = 0_usize;
        for term in terms {
            results = match term {
                Term::Solid(_) => results + 1,
                Term::Op(_) if results >= 2 => results - 1,
                Term::Op(_) => {
                    let expected = "operations after their two operands";
                    return Err(Error::parameter("expression", format!("{terms:?}"), expected));
                }
            };
        }
        if results == 1 {
            return Ok(Self { terms: terms.to_vec() });
        }
        Err(Error::parameter("expression", format!("of {results} results"), "of one result"))
    }

    /// Creates the expression that applies one operation to the first of some solids and each of the others in turn.
    ///
    /// # Errors
    /// [`Error::Parameter`] for no solid.
    pub fn fold(op: BooleanOp, solids: usize) -> Result<Self> {
        let rest = (1..solids).flat_map(|solid| [Term::Solid(solid), Term::Op(op)]);
        let first = (solids > 0).then_some(Term::Solid(0));
        Self::new(&first.into_iter().chain(rest).collect::<Vec<_>>())
    }

    /// Returns whether a solid is named.
    fn names(&self, solid: usize) -> bool {
        self.terms.contains(&Term::Solid(solid))
    }

    /// Returns whether a point is in the result, given the solids that it is inside; it is inside none that is not
    /// named.
    pub fn holds(&self, inside: &[bool]) -> bool {
        self.holds_with(inside, &mut Vec::new())
    }

    /// Evaluates the expression as [`Self::holds`] does, with a stack that is used again.
    fn holds_with(&self, inside: &[bool], stack: &mut Vec<bool>) -> bool {
        stack.clear();
        for term in &self.terms {
            let value = match *term {
                Term::Solid(solid) => inside.get(solid).copied().unwrap_or(false),
                Term::Op(op) => {
                    let (b, a) = (stack.pop().unwrap_or(false), stack.pop().unwrap_or(false));
                    op.keeps(a, b)
                }
            };
            stack.push(value);
        }
        stack.pop().unwrap_or(false)
    }
}

/// Pixels from one column up to another, exclusive, in a row.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct RowPart {
    /// Row.
    pub y: u32,
    /// First column.
    pub x0: u32,
    /// Column after the last one.
    pub x1: u32,
}

/// Step of the algorithm. Faces are numbered through all solids.
#[derive(Debug, Clone, PartialEq)]
pub enum Step {
    /// A span whose faces have one order by depth.
    Span {
        /// Its pixels.
        part: RowPart,
        /// Its faces, the nearest first.
        faces: Vec<u32>,
    },
    /// The order at both ends differs: the span is divided.
    Divide {
        /// Its pixels.
        part: RowPart,
        /// First column of the second half.
        at: u32,
    },
    /// A face leads into its solid, or out of it.
    Cross {
        /// The face.
        face: u32,
        /// Its solid.
        solid: usize,
        /// True if it leads into the solid.
        inside: bool,
        /// True if the expression holds behind it.
        holds: bool,
    },
    /// The span is filled, or stays empty.
    Fill {
        /// Its pixels.
        part: RowPart,
        /// The face that is seen.
        face: Option<u32>,
    },
}

impl PseudocodeLine for Step {
    fn line(&self) -> usize {
        match self {
            Self::Span { .. } => 4,
            Self::Divide { .. } => 5,
            Self::Cross { .. } => 8,
            Self::Fill { face: Some(_), .. } => 9,
            Self::Fill { face: None, .. } => 10,
        }
    }
}

/// Returns the picture that a list of steps leads to.
///
/// # Errors
/// [`Memory`](Error::Memory) where the screen's budget does not suffice.
pub fn replay(screen: &Screen, steps: &[Step]) -> Result<Pixels<u32>> {
    let runs = steps.iter().filter_map(|step| match *step {
        Step::Fill { part, face: Some(face) } => {
            Some((part.x0..part.x1).map(move |x| ([x, part.y], face)))
        }
        _ => None,
    });
    screen.painted(runs.flatten())
}

/// Returns the number of the face of the combined solid that is seen at each pixel's centre. Faces are numbered through
/// all solids; a face of a solid that is subtracted is seen from its back.
///
/// ```
/// use durer::clip::polygon::BooleanOp;
/// use durer::math::DVec3;
/// use durer::target::NO_ITEM;
/// use durer::trace::NoTrace;
/// use durer::visibility::polygons::csg::{Expression, items};
/// use durer::visibility::polygons::{Face, Screen};
///
/// // Front and back of two blocks; the sides are seen edge-on.
/// let block = |x: f64, near: f64, far: f64| -> Result<Vec<Face>, durer::Error> {
///     let square = |z| [(x, 0.0), (x + 4.0, 0.0), (x + 4.0, 1.0), (x, 1.0)].map(|(x, y)| DVec3::new(x, y, z));
///     [near, far].iter().map(|z| Face::new(&square(*z))).collect()
/// };
/// let solids = [block(0.0, 2.0, 5.0)?, block(2.0, 1.0, 3.0)?];
/// let screen = Screen { width: 6, height: 1, ..Screen::default() };
/// let seen = |op| {
///     let expression = Expression::fold(op, 2)?;
///     items(&solids, &expression, &screen, &mut NoTrace).map(|items| items.data().to_vec())
/// };
/// assert_eq!(seen(BooleanOp::Union)?, [0, 0, 2, 2, 2, 2]);
/// assert_eq!(seen(BooleanOp::Intersection)?, [NO_ITEM, NO_ITEM, 0, 0, NO_ITEM, NO_ITEM]);
/// // Where the second block is subtracted from the first, its own back is visible.
/// assert_eq!(seen(BooleanOp::Difference)?, [0, 0, 3, 3, NO_ITEM, NO_ITEM]);
/// # Ok::<(), durer::Error>(())
/// ```
///
/// # Errors
/// [`Memory`](Error::Memory) where the screen's budget does not suffice.
pub fn items(
    solids: &[Vec<Face>],
    expression: &Expression,
    screen: &Screen,
    t: &mut impl Tracer<Step>,
) -> Result<Pixels<u32>> {
    let faces: Vec<(usize, &Face)> = (0..)
        .zip(solids)
        .flat_map(|(solid, faces)| faces.iter().map(move |face| (solid, face)))
        .collect();
    let items = screen.plane(NO_ITEM)?;
    let _table = screen.edge_table(faces.iter().map(|(_, face)| *face))?;
    let mut charge = screen.work.charge_for::<Vec<Run>>("runs of pixels", screen.height.into())?;
    let mut rows: Vec<Vec<Run>> = vec![Vec::new(); screen.height as usize];
    for (number, (_, face)) in (0..).zip(&faces).filter(|(_, (solid, _))| expression.names(*solid))
    {
        let mut runs = 0;
        face.spans(screen, |span| {
            if let Some(row) = usize::try_from(span.y).ok().and_then(|y| rows.get_mut(y)) {
                row.push((span.x0 as u32, span.x1 as u32, number));
                runs += 1;
            }
        });
        // A row grows to twice its length.
        charge.grow(runs * size_of::<[Run; 2]>() as u64)?;
    }
    let inside = vec![false; solids.len()];
    let mut picture = Picture { faces, expression, items, inside, stack: Vec::new() };
    for (y, row) in (0..).zip(&rows) {
        let mut ends: Vec<u32> = row.iter().flat_map(|&(x0, x1, _)| [x0, x1]).collect();
        ends.sort_unstable();
        ends.dedup();
        for span in ends.windows(2) {
            let part = RowPart { y, x0: span[0], x1: span[1] };
            let covers = |&&(x0, x1, _): &&Run| x0 <= part.x0 && part.x1 <= x1;
            let covering: Vec<u32> = row.iter().filter(covers).map(|run| run.2).collect();
            if !covering.is_empty() {
                picture.span(part, &covering, t);
            }
        }
    }
    Ok(picture.items)
}

/// First column, column after the last one, and face of a run of pixels.
type Run = (u32, u32, u32);

/// The picture as it becomes.
struct Picture<'a> {
    /// Faces with their solids.
    faces: Vec<(usize, &'a Face)>,
    expression: &'a Expression,
    items: Pixels<u32>,
    inside: Vec<bool>,
    stack: Vec<bool>,
}

impl Picture<'_> {
    /// Returns the depth of a face at a pixel's centre.
    fn depth(&self, face: u32, x: u32, y: u32) -> f64 {
        self.faces[face as usize].1.at(x as i32, y as i32).z
    }

    /// Returns faces by depth at a pixel, each with whether it is as far as the one before; those are in their order.
    fn order(&self, faces: &[u32], x: u32, y: u32) -> Vec<(u32, bool)> {
        let mut sorted: Vec<(f64, u32)> =
            faces.iter().map(|face| (self.depth(*face, x, y), *face)).collect();
        sorted.compact_sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let mut before = f64::NEG_INFINITY;
        let order = |(depth, face)| (face, std::mem::replace(&mut before, depth) == depth);
        sorted.into_iter().map(order).collect()
    }

    /// Fills the pixels that some faces cover, and divides them where the faces change their order.
    fn span(&mut self, part: RowPart, covering: &[u32], t: &mut impl Tracer<Step>) {
        let mut waiting = vec![part];
        while let Some(part) = waiting.pop() {
            let RowPart { y, x0, x1 } = part;
            let order = self.order(covering, x0, y);
            if x1 - x0 > 1 && order != self.order(covering, x1 - 1, y) {
                let at = x0 + (x1 - x0) / 2;
                t.step(|| Step::Divide { part, at });
                waiting.extend([RowPart { x0: at, ..part }, RowPart { x1: at, ..part }]);
                continue;
            }
            t.step(|| Step::Span { part, faces: order.iter().map(|(face, _)| *face).collect() });
            let face = self.first(&order, t);
            t.step(|| Step::Fill { part, face });
            if let Some(face) = face {
                (x0..x1).for_each(|x| self.items.set(x, y, face));
            }
        }
    }

    /// Returns the first of sorted faces behind which the expression holds.
    fn first(&mut self, order: &[(u32, bool)], t: &mut impl Tracer<Step>) -> Option<u32> {
        self.inside.fill(false);
        let mut first = None;
        for (k, &(face, tied)) in (1..).zip(order) {
            let solid = self.faces[face as usize].0;
            self.inside[solid] ^= true;
            first = first.filter(|_| tied).or(Some(face));
            // Faces at one depth are passed together.
            let is_last = order.get(k).is_none_or(|(_, tied)| !tied);
            let holds = is_last && self.expression.holds_with(&self.inside, &mut self.stack);
            t.step(|| Step::Cross { face, solid, inside: self.inside[solid], holds });
            if holds {
                return first;
            }
        }
        None
    }
}
