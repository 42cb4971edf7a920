//! The naive polygon clip, which is wrong: every edge is clipped as a line and the pieces are joined.
//!
//! It is kept to show why polygon clipping is more than repeated line clipping. Where the polygon
//! leaves the window at one border and comes back at another, the window's corner between them is
//! missing, so the area is wrong; a polygon that surrounds the window vanishes; and parts that have
//! fallen apart are joined by edges across the window. It is not a member of any family of
//! algorithms; use [`super::rectangle`].

use crate::clip::line::cut_inside;
use crate::math::{DVec2, Rect};
use crate::trace::Tracer;
use crate::{Error, Result};

/// Step of the algorithm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step {
    /// The rest of an edge was joined to the ring.
    Kept {
        /// The edge's index.
        edge: usize,
        /// Its first visible point.
        start: DVec2,
        /// Its last visible point.
        end: DVec2,
    },
    /// No part of an edge is visible.
    Dropped {
        /// The edge's index.
        edge: usize,
    },
}

/// Returns the result that a list of steps leads to.
pub fn replay(steps: &[Step]) -> Vec<DVec2> {
    let mut ring = Vec::new();
    for step in steps {
        if let Step::Kept { start, end, .. } = *step {
            join(&mut ring, start, end);
        }
    }
    ring
}

/// Clips every edge of a ring as a line and joins the parts; **wrong** as a polygon clip.
///
/// ```
/// use durer::clip::polygon::{naive, signed_area};
/// use durer::math::{DVec2, Rect};
/// use durer::trace::NoTrace;
///
/// // The triangle covers the window's corner, but the result lacks it.
/// let p = DVec2::new;
/// let window = Rect::new(p(0.0, 0.0), p(2.0, 2.0))?;
/// let triangle = [p(1.0, 1.0), p(5.0, 1.0), p(1.0, 5.0)];
/// let clipped = naive::clip(&window, &triangle, &mut NoTrace)?;
/// assert_eq!(clipped, [p(1.0, 1.0), p(2.0, 1.0), p(1.0, 2.0)]);
/// assert_eq!(signed_area(&clipped), 0.5); // it should be 1
/// # Ok::<(), durer::Error>(())
/// ```
///
/// # Errors
/// [`Error::NonFinite`] for a vertex with a NaN or infinite coordinate.
pub fn clip(window: &Rect, ring: &[DVec2], t: &mut impl Tracer<Step>) -> Result<Vec<DVec2>> {
    if let Some(index) = ring.iter().position(|p| !p.is_finite()) {
        return Err(Error::NonFinite { what: "vertex", index });
    }
    let mut out = Vec::new();
    for (edge, (a, b)) in ring.iter().zip(ring.iter().cycle().skip(1)).enumerate() {
        match cut_inside(window, *a, *b) {
            None => t.step(|| Step::Dropped { edge }),
            Some(visible) => {
                t.step(|| Step::Kept { edge, start: visible.start, end: visible.end });
                join(&mut out, visible.start, visible.end);
            }
        }
    }
    if out.len() > 1 && out.first() == out.last() {
        out.pop();
    }
    Ok(out)
}

fn join(ring: &mut Vec<DVec2>, start: DVec2, end: DVec2) {
    for p in [start, end] {
        if ring.last() != Some(&p) {
            ring.push(p);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::trace::{NoTrace, Recorder};

    #[test]
    fn what_surrounds_the_window_vanishes() {
        let window = Rect::new(DVec2::ZERO, DVec2::ONE).unwrap();
        let around =
            [(-1.0, -1.0), (2.0, -1.0), (2.0, 2.0), (-1.0, 2.0)].map(|(x, y)| DVec2::new(x, y));
        assert!(clip(&window, &around, &mut NoTrace).unwrap().is_empty());
    }

    #[test]
    fn steps_rebuild_the_result() {
        let window = Rect::new(DVec2::ZERO, DVec2::ONE).unwrap();
        let ring = [(0.5, 0.5), (2.0, 0.5), (0.5, 3.0), (-1.0, 2.0)].map(|(x, y)| DVec2::new(x, y));
        let mut steps = Recorder::default();
        let mut rebuilt = {
            clip(&window, &ring, &mut steps).unwrap();
            replay(steps.steps())
        };
        // The ring is closed once all edges are added.
        if rebuilt.first() == rebuilt.last() {
            rebuilt.pop();
        }
        assert_eq!(rebuilt, clip(&window, &ring, &mut NoTrace).unwrap());
    }
}
