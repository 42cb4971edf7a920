//! Polygons: the types of shapes, and the algorithms that clip them.
//!
//! [`overlay`](mod@overlay) is the robust way to clip: it accepts any rings and returns valid polygons. [`rectangle`] is the fast
//! path for windows and map tiles. The others are the published algorithms, each with its own preconditions.

pub mod coverage;
mod cyclic;
pub mod greiner_hormann;
mod group;
pub mod liang_barsky;
mod lists;
pub mod maillot;
pub mod mismatch;
pub mod naive;
mod near;
mod nesting;
mod node;
mod outline;
pub mod overlay;
pub mod point;
pub mod rectangle;
pub mod scan_beams;
mod shapes;
mod steps;
pub mod sutherland_hodgman;
pub mod validity;
pub mod vatti;
mod vertex;
mod walk;
pub mod weiler_atherton;

pub use nesting::NestingTree;
use overlay::overlay;
pub use shapes::{Polygon, Ring, Shapes, signed_area};
pub use vertex::Vertex;

use crate::clip::line::ConvexPolygon;
use crate::math::Rect;
use crate::trace::NoTrace;
use crate::{Error, Result};

crate::info::family! {
    /// Algorithm that clips polygons with polygons.
    pub enum PolygonClipper {
        /// [`rectangle`]
        Rectangle => rectangle::INFO,
        /// [`sutherland_hodgman`]
        SutherlandHodgman => sutherland_hodgman::INFO,
        /// [`weiler_atherton`]
        WeilerAtherton => weiler_atherton::INFO,
        /// [`vatti`]
        Vatti => vatti::INFO,
        /// [`greiner_hormann`]
        GreinerHormann => greiner_hormann::INFO,
        /// [`overlay`](mod@overlay)
        Overlay => overlay::INFO,
    }
}

impl PolygonClipper {
    /// Runs the algorithm with its default options, by the even-odd rule.
    ///
    /// # Errors
    /// As [`overlay::overlay`]; all take only finite points. [`Error::Unsupported`] for Weiler–Atherton if rings of one
    /// operand cross or overlap, and for Greiner–Hormann if they also touch the other operand; for the rectangle clip
    /// and Sutherland–Hodgman for operations other than intersection, and for a clip that is not a single rectangle or
    /// a single ring, respectively. [`Error::Parameter`] if that ring is not convex.
    pub fn clip(self, subject: &Shapes, clip: &Shapes, op: BooleanOp) -> Result<Shapes> {
        let t = &mut NoTrace;
        let points = || subject.points().iter().chain(clip.points());
        if let Some(index) = points().position(|p| !p.is_finite()) {
            return Err(Error::NonFinite { what: "point", index });
        }
        if self.keeps_inside_only() && op != BooleanOp::Intersection {
            return Err(Error::Unsupported {
                what: "an operation other than intersection by this algorithm",
                instead: "choose overlay, vatti, weiler-atherton or greiner-hormann",
            });
        }
        Ok(match self {
            Self::Rectangle => {
                let window = as_rectangle(clip).ok_or(Error::Unsupported {
                    what: "a clip polygon that is not an axis-parallel rectangle",
                    instead: "choose another algorithm",
                })?;
                rectangle::clip(&window, subject, &Default::default(), t)?
            }
            Self::SutherlandHodgman => match (as_rectangle(clip), clip.ring_count()) {
                (Some(window), _) => sutherland_hodgman::clip_shapes(&window, subject, t)?,
                (None, 1) => {
                    let window = ConvexPolygon::new(clip.ring(0))?;
                    sutherland_hodgman::clip_shapes_with_polygon(&window, subject, t)?
                }
                _ => {
                    return Err(Error::Unsupported {
                        what: "a clip polygon that is not one ring",
                        instead: "choose another algorithm",
                    });
                }
            },
            Self::WeilerAtherton => {
                weiler_atherton::weiler_atherton(subject, clip, op, &Default::default(), t)?
            }
            Self::Vatti => vatti::vatti(subject, clip, op, &Default::default(), t)?.shapes,
            Self::GreinerHormann => {
                greiner_hormann::greiner_hormann(subject, clip, op, &Default::default(), t)?
            }
            Self::Overlay => overlay(subject, clip, op, &Default::default(), t)?.shapes,
        })
    }

    /// Returns whether intersection is the only operation.
    pub const fn keeps_inside_only(self) -> bool {
        matches!(self, Self::Rectangle | Self::SutherlandHodgman)
    }

    /// Returns whether the clip must be an axis-parallel rectangle.
    pub const fn needs_rectangle(self) -> bool {
        matches!(self, Self::Rectangle)
    }
}

/// Returns the shapes as a rectangle, if they are a single ring of its four corners.
fn as_rectangle(shapes: &Shapes) -> Option<Rect> {
    let [a, b, c, d] = *shapes.points() else { return None };
    let upright = a.x == b.x && b.y == c.y && c.x == d.x && d.y == a.y;
    let lying = a.y == b.y && b.x == c.x && c.y == d.y && d.x == a.x;
    let one = shapes.ring_count() == 1 && (upright || lying);
    one.then(|| Rect::around([a, c])).flatten()
}

/// Rule that decides from the winding number w of a point whether a set of closed curves encloses it: the five winding
/// rules of OpenGL's tessellator (GLU 1.3, 5.1).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum WindingRule {
    /// w is odd.
    #[default]
    EvenOdd,
    /// w ≠ 0.
    NonZero,
    /// w > 0: inside curves that run counter-clockwise (y up).
    Positive,
    /// w < 0: inside curves that run clockwise (y up).
    Negative,
    /// |w| ≥ 2: inside two curves that run the same way, or twice inside the same curve.
    AbsGeqTwo,
}

impl WindingRule {
    /// Every rule, in the order of the documentation.
    pub const ALL: &'static [Self] =
        &[Self::EvenOdd, Self::NonZero, Self::Positive, Self::Negative, Self::AbsGeqTwo];

    /// Returns the name used on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::EvenOdd => "even-odd",
            Self::NonZero => "non-zero",
            Self::Positive => "positive",
            Self::Negative => "negative",
            Self::AbsGeqTwo => "abs-geq-two",
        }
    }

    /// Returns whether a point with this winding number is inside.
    #[inline]
    pub const fn fills(self, winding: i32) -> bool {
        match self {
            Self::EvenOdd => winding & 1 != 0,
            Self::NonZero => winding != 0,
            Self::Positive => winding > 0,
            Self::Negative => winding < 0,
            Self::AbsGeqTwo => winding.unsigned_abs() >= 2,
        }
    }
}

/// One of the two inputs of a boolean operation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Operand {
    /// The first.
    Subject,
    /// The second.
    Clip,
}

/// Boolean operation on two regions, the subject A and the clip B.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum BooleanOp {
    /// A ∩ B: the points in both.
    #[default]
    Intersection,
    /// A ∪ B: the points in one or both.
    Union,
    /// A ∖ B: the points only in the subject.
    Difference,
    /// A △ B: the points in exactly one.
    Xor,
}

impl BooleanOp {
    /// Every operation, in the order of the documentation.
    pub const ALL: &'static [Self] =
        &[Self::Intersection, Self::Union, Self::Difference, Self::Xor];

    /// Returns the name used on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Intersection => "intersection",
            Self::Union => "union",
            Self::Difference => "difference",
            Self::Xor => "xor",
        }
    }

    /// Returns whether a point is in the result, given whether it is in the subject and in the clip.
    #[inline]
    pub const fn keeps(self, subject: bool, clip: bool) -> bool {
        match self {
            Self::Intersection => subject && clip,
            Self::Union => subject || clip,
            Self::Difference => subject && !clip,
            Self::Xor => subject != clip,
        }
    }
}

impl std::fmt::Display for WindingRule {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}

impl std::fmt::Display for BooleanOp {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}

impl std::str::FromStr for WindingRule {
    type Err = Error;

    fn from_str(s: &str) -> Result<Self> {
        let expected = "even-odd, non-zero, positive, negative or abs-geq-two";
        let found = Self::ALL.iter().copied().find(|r| r.name() == s);
        found.ok_or_else(|| Error::parameter("fill rule", s, expected))
    }
}

impl std::str::FromStr for BooleanOp {
    type Err = Error;

    fn from_str(s: &str) -> Result<Self> {
        let expected = "intersection, union, difference or xor";
        let found = Self::ALL.iter().copied().find(|op| op.name() == s);
        found.ok_or_else(|| Error::parameter("operation", s, expected))
    }
}
