//! The boxes around operands, and the check of their points.

use super::parallel;
use crate::clip::polygon::{Shapes, Vertex};
use crate::{Error, Result};

/// Limit on points, so that an edge's index and two flags fit 32 bits, and twice an edge's index
/// too.
const MOST_POINTS: usize = 1 << 29;

/// The smallest and the largest coordinates.
pub type Corners<P> = [P; 2];

/// Checks the coordinates, and returns the boxes around subject and clip.
pub fn check<P: Vertex>(subject: &Shapes<P>, clip: &Shapes<P>) -> Result<[Option<Corners<P>>; 2]> {
    let count = subject.points().len() + clip.points().len();
    if count > MOST_POINTS {
        let (value, limit) = (count as u64, MOST_POINTS as u64);
        return Err(Error::Limit { what: "number of points", value, limit });
    }
    Ok([corners(subject.points(), 0)?, corners(clip.points(), subject.points().len())?])
}

/// Returns the box around points; `before` is how many points come before them in the caller's
/// count.
fn corners<P: Vertex>(points: &[P], before: usize) -> Result<Option<Corners<P>>> {
    /// Number of points in one task.
    const TASK: usize = if cfg!(test) { 8 } else { 1 << 16 };
    let tasks = parallel::ranges(points.len(), TASK);
    let boxes = parallel::map(tasks, |range| {
        let points = &points[range.clone()];
        match points.iter().position(|p| !p.is_finite()) {
            Some(i) => Err(range.start + i),
            None => Ok(around(points.iter().copied())),
        }
    });
    let mut all = None;
    for one in boxes {
        let one = one.map_err(|i| Error::NonFinite { what: "point", index: before + i })?;
        all = union([all, one]);
    }
    Ok(all)
}

pub fn around<P: Vertex>(mut points: impl Iterator<Item = P>) -> Option<Corners<P>> {
    let first = points.next()?;
    Some(points.fold([first; 2], |[low, high], p| [low.low(p), high.high(p)]))
}

pub fn union<P: Vertex>(boxes: [Option<Corners<P>>; 2]) -> Option<Corners<P>> {
    around(boxes.into_iter().flatten().flatten())
}
