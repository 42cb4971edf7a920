//! Broken views (ISO 128-3): the part between two planes across an axis is left out, and the rest is moved together.

mod cut;

use crate::math::{DVec2, DVec3};
use crate::scene::{Aabb, Camera, Projection};
use crate::sorting::CompactSort;
use crate::target::drawing::Drawing;
use crate::{Error, Result};
use std::str::FromStr;

/// A part of a model that views from the side leave out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Break {
    /// 0 for x, 1 for y, 2 for z.
    axis: usize,
    /// Start and end on the axis, in units of the model.
    span: [f64; 2],
}

impl Break {
    /// Returns the axis, of unit length.
    pub(crate) fn axis(&self) -> DVec3 {
        DVec3::AXES[self.axis]
    }

    /// Returns whether a parallel view shows the axis in its true length, so that it can be broken there.
    pub fn is_seen_by(&self, camera: &Camera) -> bool {
        let is_parallel = matches!(camera.projection, Projection::Orthographic { .. });
        is_parallel && self.axis().dot(camera.axes()[2]).abs() <= ASIDE
    }

    /// Returns the name of the axis.
    pub fn axis_name(&self) -> &'static str {
        NAMES[self.axis]
    }
}

const NAMES: [&str; 3] = ["x", "y", "z"];

impl std::fmt::Display for Break {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let [from, to] = self.span;
        write!(f, "{}:{from},{to}", self.axis_name())
    }
}

impl FromStr for Break {
    type Err = Error;

    /// Parses `AXIS:FROM,TO`: x, y or z, and where on it the part begins and ends.
    fn from_str(text: &str) -> Result<Self> {
        let expected = "AXIS:FROM,TO with x, y or z and FROM below TO, e.g. x:40,260";
        let wrong = || Error::parameter("break", text, expected);
        let (name, span) = text.split_once(':').ok_or_else(wrong)?;
        let axis = NAMES.iter().position(|n| *n == name.trim()).ok_or_else(wrong)?;
        let (from, to) = span.split_once(',').ok_or_else(wrong)?;
        let number = |s: &str| s.trim().parse().ok().filter(|v: &f64| v.is_finite());
        let (from, to) = number(from).zip(number(to)).ok_or_else(wrong)?;
        if from < to { Ok(Self { axis, span: [from, to] }) } else { Err(wrong()) }
    }
}

/// The gap of a break, as a part of the longest side of the views' contents: 4.5 mm if that is 180 mm long on paper.
const GAP: f64 = 0.025;

/// The breaks of a model, each between ends of it and apart from the others.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Breaks {
    /// Breaks of an axis, from its lower end on.
    breaks: Vec<Break>,
    /// Units of the model.
    gap: f64,
}

impl Breaks {
    /// Returns the breaks of a model with these bounds for views that are drawn at one scale.
    ///
    /// # Errors
    /// [`Error::Parameter`] for a break that is not inside the model, that is shorter than the gap that takes its
    /// place, or that touches another one.
    pub fn new(breaks: &[Break], bounds: Aabb, views: &[Camera]) -> Result<Self> {
        let gap = views.iter().map(|v| extent(breaks, bounds, v)).fold(0.0, f64::max) * GAP;
        let mut breaks = breaks.to_vec();
        breaks.compact_sort_by(|a, b| a.axis.cmp(&b.axis).then(a.span[0].total_cmp(&b.span[0])));
        for one in &breaks {
            let (low, high) = (bounds.min[one.axis], bounds.max[one.axis]);
            if one.span[0] <= low || one.span[1] >= high {
                let value = format!("{one}, and the model lies between {low} and {high} there");
                return Err(Error::parameter("break", value, "inside the model"));
            }
            if one.span[1] - one.span[0] <= gap {
                let value = format!("{one}, and a break takes {gap:.3} itself");
                return Err(Error::parameter("break", value, "longer than what it takes"));
            }
        }
        let touches = |w: &&[Break]| w[0].axis == w[1].axis && w[0].span[1] + gap > w[1].span[0];
        if let Some(pair) = breaks.windows(2).find(touches) {
            let value = format!("{} beside {}", pair[1], pair[0]);
            return Err(Error::parameter("break", value, "apart from others of the axis"));
        }
        Ok(Self { breaks, gap })
    }

    /// Returns the breaks in a camera's view: those whose axes it sees in their true length; none in perspective.
    pub fn seen_by(&self, camera: &Camera) -> ViewBreaks {
        let [right, up, _] = camera.axes();
        let seen = self.breaks.iter().filter(|b| b.is_seen_by(camera));
        let view = |b: &Break| {
            let axis = b.axis();
            let way = DVec2::new(axis.dot(right), axis.dot(up)).normalize_or(DVec2::X);
            let [from, to] = b.span.map(|v| v - axis.dot(camera.target));
            ViewBreak { way, from, to, gap: self.gap }
        };
        let mut breaks: Vec<ViewBreak> = seen.map(view).collect();
        breaks.compact_sort_by(|a, b| a.from.total_cmp(&b.from));
        ViewBreaks(breaks)
    }
}

/// Returns the longer side of a box in a view, without the parts that breaks leave out.
fn extent(breaks: &[Break], bounds: Aabb, camera: &Camera) -> f64 {
    let mut size = bounds.size();
    for one in breaks.iter().filter(|b| b.is_seen_by(camera)) {
        size[one.axis] -= one.span[1] - one.span[0];
    }
    let [right, up, _] = camera.axes();
    [right, up].map(|side| side.abs().dot(size.max(DVec3::ZERO))).into_iter().fold(0.0, f64::max)
}

/// Axes are seen in their true length up to this sine.
const ASIDE: f64 = 1e-6;

/// A break as a view shows it, in units of its plane.
#[derive(Debug, Clone, Copy, PartialEq)]
struct ViewBreak {
    /// The direction of its axis in the plane, of unit length.
    way: DVec2,
    /// Start of the part of the axis that is left out; the end follows.
    from: f64,
    to: f64,
    /// Width of the gap that replaces it.
    gap: f64,
}

impl ViewBreak {
    /// Returns the distance by which everything beyond the break is moved.
    fn shift(&self) -> f64 {
        self.to - self.from - self.gap
    }
}

/// The breaks of a view, which map points of its plane to their places in the drawing.
///
/// ```
/// use durer::math::{DVec2, DVec3};
/// use durer::paper::{Break, Breaks};
/// use durer::scene::{Aabb, Camera, Projection};
/// let camera = Camera {
///     eye: DVec3::new(0.0, -9.0, 0.0),
///     target: DVec3::ZERO,
///     up: DVec3::Z,
///     projection: Projection::Orthographic { height: 2.0 },
///     near: 1.0,
///     far: 20.0,
/// };
/// let bounds = Aabb { min: DVec3::ZERO, max: DVec3::new(300.0, 10.0, 10.0) };
/// let one: Break = "x:50,250".parse()?;
/// let breaks = Breaks::new(&[one], bounds, &[camera])?.seen_by(&camera);
/// // 100 are left, of which the gap is 2.5 %.
/// assert_eq!(breaks.drawn_at(DVec2::new(20.0, 4.0)), DVec2::new(20.0, 4.0));
/// assert_eq!(breaks.drawn_at(DVec2::new(300.0, 4.0)), DVec2::new(102.5, 4.0));
/// assert_eq!(breaks.seen_at(DVec2::new(102.5, 4.0)), DVec2::new(300.0, 4.0));
/// # Ok::<(), durer::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ViewBreaks(Vec<ViewBreak>);

impl ViewBreaks {
    /// Returns whether there are none.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Returns where a point of the plane is drawn; points of the part that is left out are squeezed into the gap.
    pub fn drawn_at(&self, p: DVec2) -> DVec2 {
        let moved = |b: &ViewBreak| {
            let share = ((p.dot(b.way) - b.from) / (b.to - b.from)).clamp(0.0, 1.0);
            b.way * (share * b.shift())
        };
        self.0.iter().fold(p, |at, b| at - moved(b))
    }

    /// Returns the point of the plane that is drawn at a place.
    pub fn seen_at(&self, at: DVec2) -> DVec2 {
        self.0.iter().fold(at, |p, b| {
            let share = ((p.dot(b.way) - b.from) / b.gap).clamp(0.0, 1.0);
            p + b.way * (share * b.shift())
        })
    }

    /// Returns a drawing of the view with its breaks: lines of the class
    /// [`LineClass::Break`](crate::target::drawing::LineClass::Break) are where the model is broken. It has no window.
    ///
    /// # Errors
    /// [`Error::NonFinite`] for regions with a corner that is not finite.
    pub fn cut(&self, drawing: Drawing) -> Result<Drawing> {
        // From the upper end on, because breaks move only the parts above them.
        self.0.iter().rev().try_fold(drawing, |drawing, b| cut::cut(b, drawing))
    }
}
