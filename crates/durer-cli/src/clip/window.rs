//! `--window`: a rectangle, or one across the 180th meridian.

use crate::values;
use durer::clip::mask::Mask;
use durer::math::{DVec2, Rect};
use durer_formats::geo::{Geometry, Points};

/// Value of `--window`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Window {
    Plain(Rect),
    /// Across the 180th meridian: the window at the western and at the eastern end of the map.
    Across([Rect; 2]),
}

impl Window {
    pub fn mask(&self) -> durer::Result<Mask> {
        match self {
            Self::Plain(window) => Mask::window(*window),
            Self::Across(windows) => Mask::windows(windows),
        }
    }

    /// Returns whether an edge of a geometry may be meant to cross the meridian but goes the long way around the world:
    /// more than half, but not all of it.
    pub fn is_long_way(&self, geometry: &Geometry) -> bool {
        let long = |a: DVec2, b: DVec2| {
            let way = (b.x - a.x).abs();
            way > 180.0 && way < 360.0
        };
        let line = |points: &Points| points.xy.windows(2).any(|pair| long(pair[0], pair[1]));
        let ring = |points: &Points| {
            line(points)
                || points.xy.first().zip(points.xy.last()).is_some_and(|(a, b)| long(*a, *b))
        };
        matches!(self, Self::Across(_))
            && match geometry {
                Geometry::Point(_) | Geometry::MultiPoint(_) => false,
                Geometry::LineString(points) => line(points),
                Geometry::MultiLineString(lines) => lines.iter().any(line),
                Geometry::Polygon(rings) => rings.iter().any(ring),
                Geometry::MultiPolygon(polygons) => polygons.iter().flatten().any(ring),
                Geometry::Collection(parts) => parts.iter().any(|part| self.is_long_way(part)),
            }
    }
}

/// Returns a window, or one across the meridian where the left border is the larger one, as in RFC
/// 7946.
pub fn region(text: &str) -> Result<Window, String> {
    let [xl, yb, xr, yt] = corners(text)?;
    // From the eastern hemisphere to the western one: all else is a slip.
    if !(0.0 < xl && xl <= 180.0 && (-180.0..0.0).contains(&xr) && yb < yt) {
        return window(text).map(Window::Plain);
    }
    let rect = |xl: f64, xr: f64| {
        Rect::new(DVec2::new(xl, yb), DVec2::new(xr, yt)).map_err(|e| e.to_string())
    };
    Ok(Window::Across([rect(xl - 360.0, xr)?, rect(xl, xr + 360.0)?]))
}

/// Returns a rectangle.
pub fn window(text: &str) -> Result<Rect, String> {
    let [xl, yb, xr, yt] = corners(text)?;
    if xl >= xr || yb >= yt {
        let message = "the window is empty; give left, lower, right, upper; from 0 to 180 and from -180 to 0 \
                       degrees, left and right make a window across the 180th meridian";
        return Err(message.to_owned());
    }
    Rect::new(DVec2::new(xl, yb), DVec2::new(xr, yt)).map_err(|e| e.to_string())
}

fn corners(text: &str) -> Result<[f64; 4], String> {
    let numbers: Vec<f64> = text.split(',').map(values::number).collect::<Result<_, _>>()?;
    let four = "four numbers joined by commas are needed, e.g. -10,35,30,60";
    numbers.try_into().map_err(|_| four.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn windows_may_go_across_the_meridian() {
        let rect = |xl, xr| Rect::new(DVec2::new(xl, -10.0), DVec2::new(xr, 10.0)).unwrap();
        assert_eq!(
            region("170,-10,-170,10"),
            Ok(Window::Across([rect(-190.0, -170.0), rect(170.0, 190.0)]))
        );
        assert_eq!(region("-170,-10,170,10"), Ok(Window::Plain(rect(-170.0, 170.0))));
        for wrong in ["170,10,-170,-10", "5,0,5,1", "3,0,1,1", "500,0,-400,1", "1,2,3", "nan,0,1,1"]
        {
            assert!(region(wrong).is_err(), "{wrong}");
        }
    }
}
