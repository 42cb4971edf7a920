//! The window–viewport transformation as it is taught: four coefficients, then two multiplications and two additions
//! for each point.
//!
//! W. M. Newman and R. F. Sproull, *Principles of Interactive Computer Graphics*, 1973. Object space. Cost: O(n) for n
//! points. The coefficients equal those of [`WindowToViewport`], which keeps them in double the precision for its own
//! mapping; here they are rounded, so that the printed numbers are the ones used.

use super::window::{Aspect, Viewport, Window, WindowToViewport, YAxis};
use crate::info::{Class, Info, Occluder};
use crate::math::DVec2;
use crate::trace::{PseudocodeLine, Tracer};

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "window-viewport",
    title: "Window–viewport transformation",
    authors: "William M. Newman, Robert F. Sproull",
    year: 1973,
    source: "Principles of Interactive Computer Graphics",
    class: Class::ObjectSpace,
    occluder: Occluder::None,
    coherence: &[],
    cost: "O(n) for n points: two multiplications and two additions each",
    limits: "windows and viewports parallel to the axes",
    pseudocode: &[
        "W := window (xl, xr, yb, yt) of the world; V := viewport (xl, xr, yb, yt) of the screen",
        "a := (V.xr − V.xl) / (W.xr − W.xl)",
        "b := V.xl − a · W.xl",
        "c := (V.yt − V.yb) / (W.yt − W.yb)",
        "d := V.yb − c · W.yb",
        "for each point (x, y):",
        "    x' := a · x + b",
        "    y' := c · y + d",
    ],
};

/// Options for the mapping.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Options {
    /// Treatment of windows and viewports that differ in shape.
    pub aspect: Aspect,
    /// Direction of y on the screen.
    pub y_axis: YAxis,
}

/// Step of the algorithm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step {
    /// Scale and shift of x are known.
    Columns {
        /// Pixels per unit.
        a: f64,
        /// Column of x = 0.
        b: f64,
    },
    /// Scale and shift of y are known.
    Rows {
        /// Pixels per unit, negative where rows count downwards.
        c: f64,
        /// Row of y = 0.
        d: f64,
    },
    /// A point was mapped.
    Point {
        /// Its place in the world.
        from: DVec2,
        /// Its place on the screen, in pixels.
        to: DVec2,
    },
}

impl PseudocodeLine for Step {
    fn line(&self) -> usize {
        match self {
            Self::Columns { .. } => 3,
            Self::Rows { .. } => 5,
            Self::Point { .. } => 8,
        }
    }
}

/// Returns the result that a list of steps leads to.
pub fn replay(steps: &[Step]) -> Vec<DVec2> {
    let to = |step: &Step| if let Step::Point { to, .. } = *step { Some(to) } else { None };
    steps.iter().filter_map(to).collect()
}

/// Returns where points of the world are on the screen, in pixels.
///
/// ```
/// use durer::math::DVec2;
/// use durer::trace::NoTrace;
/// use durer::view::mapping::{Options, map};
/// use durer::view::window::{PixelRect, Viewport, Window, YAxis};
///
/// let window = Window::new(0.0, 4.0, 0.0, 2.0)?;
/// let viewport = Viewport::new(PixelRect::new(100, 50, 300, 250)?)?;
/// let options = Options { y_axis: YAxis::Up, ..Options::default() };
/// let mapped = map(&window, &viewport, &[DVec2::ONE], &options, &mut NoTrace);
/// assert_eq!(mapped, [DVec2::splat(150.0)]);
/// # Ok::<(), durer::Error>(())
/// ```
pub fn map(
    window: &Window,
    viewport: &Viewport,
    points: &[DVec2],
    options: &Options,
    t: &mut impl Tracer<Step>,
) -> Vec<DVec2> {
    let mapping = WindowToViewport::new(window, viewport, options.aspect, options.y_axis);
    let [a, b, c, d] = mapping.coefficients();
    t.step(|| Step::Columns { a, b });
    t.step(|| Step::Rows { c, d });
    let mapped = |&from: &DVec2| {
        let to = DVec2::new(a * from.x + b, c * from.y + d);
        t.step(|| Step::Point { from, to });
        to
    };
    points.iter().map(mapped).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::trace::{NoTrace, Recorder};
    use crate::view::window::PixelRect;

    #[test]
    fn the_lectures_window_has_its_coefficients() {
        let window = Window::new(0.0, 4.0, 0.0, 2.0).unwrap();
        let viewport = Viewport::new(PixelRect::new(100, 50, 300, 250).unwrap()).unwrap();
        let points = [DVec2::ONE, DVec2::new(4.0, 2.0)];
        let mut steps = Recorder::default();
        let up = Options { y_axis: YAxis::Up, ..Options::default() };
        let mapped = map(&window, &viewport, &points, &up, &mut steps);
        assert_eq!(mapped, [DVec2::splat(150.0), DVec2::new(300.0, 250.0)]);
        assert_eq!(steps.steps()[0], Step::Columns { a: 50.0, b: 100.0 });
        assert_eq!(steps.steps()[1], Step::Rows { c: 100.0, d: 50.0 });
        assert_eq!(replay(steps.steps()), mapped);
        let down = map(&window, &viewport, &points, &Options::default(), &mut NoTrace);
        assert_eq!(down, [DVec2::splat(150.0), DVec2::new(300.0, 50.0)]);
    }
}
