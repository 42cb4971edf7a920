//! Numbers of parts in circles around a view, with lines that lead to the parts (ISO 6433).

use super::marks::{Annotator, THIN};
use crate::math::{DVec2, Rect};
use crate::paper::PlacedView;

/// A part's number.
#[derive(Debug, Clone, PartialEq)]
pub struct Callout {
    /// Index of its view on the sheet.
    pub view: usize,
    /// The part's number, as the circle shows it.
    pub number: String,
    /// A place of the part, in the plane of that view.
    pub at: DVec2,
}

/// The radius of a circle, and the height of its number, millimetres.
const RADIUS: f64 = 4.5;
const TEXT: f64 = 3.5;
/// Smallest distance of the centres of circles from the drawing and from each other.
const AWAY: f64 = 11.0;
const APART: f64 = 2.0 * RADIUS + 1.5;
/// The radius of the dot that ends a line on a part.
const DOT: f64 = 0.6;

/// Width of the strip that circles take around a view.
pub const ROOM: f64 = AWAY + RADIUS;

/// Largest number of rounds of better exchanges.
const ROUNDS: usize = 64;

/// Draws the callouts of all views, each at the edge of a rectangle around its view and such that no two lines cross:
/// layer `callouts`.
pub fn put(annotator: &mut Annotator, callouts: &[Callout], placed: &[PlacedView]) {
    for (index, view) in placed.iter().enumerate() {
        let here: Vec<&Callout> =
            callouts.iter().filter(|c| c.view == index && c.at.is_finite()).collect();
        let dots: Vec<DVec2> = here.iter().map(|c| view.sheet_from_plane(c.at)).collect();
        let (ports, apart) = ports(&view.bounds, here.len());
        let radius = RADIUS.min(apart * 0.5 * RADIUS / (RADIUS + 0.5));
        for ((callout, dot), port) in here.iter().zip(&dots).zip(matched(&dots, &ports)) {
            let Some(&middle) = ports.get(port) else { continue };
            let towards = (*dot - middle).normalize_or_zero();
            annotator.circle(middle, radius);
            annotator.line(vec![middle + towards * radius, *dot], THIN, &[]);
            annotator.dot(*dot, DOT);
            let digits = callout.number.chars().count().max(1) as f64;
            let height = (TEXT * radius / RADIUS).min(2.2 * radius / digits);
            annotator.letters(middle, &callout.number, height);
        }
    }
    annotator.end_layer("callouts");
}

/// Returns places along the edge of a rectangle around the drawing, at least `count`, and how far apart they are.
fn ports(bounds: &Rect, count: usize) -> (Vec<DVec2>, f64) {
    let (min, size) = (bounds.min() - AWAY, bounds.size() + 2.0 * AWAY);
    let around = 2.0 * (size.x + size.y);
    let number = ((around / APART).floor().clamp(1.0, 1e4) as usize).max(count);
    let apart = around / number as f64;
    let place = |i: usize| {
        // Clockwise from the middle of the upper side.
        let s = (size.x * 0.5 + apart * i as f64) % around;
        let [right, down] = [size.x, size.x + size.y];
        let left = down + size.x;
        min + match s {
            s if s < right => DVec2::new(s, 0.0),
            s if s < down => DVec2::new(size.x, s - right),
            s if s < left => DVec2::new(left - s, size.y),
            s => DVec2::new(0.0, around - s),
        }
    };
    ((0..number).map(place).collect(), apart)
}

/// Assigns each point its own port; there are at least as many ports as points. In the end neither exchanging two ports
/// nor using a free one makes the lines shorter in total, so no two of them cross.
fn matched(points: &[DVec2], ports: &[DVec2]) -> Vec<usize> {
    let length = |point: usize, port: usize| points[point].distance(ports[port]);
    let mut holder: Vec<Option<usize>> = vec![None; ports.len()];
    let mut port_of = Vec::with_capacity(points.len());
    for point in 0..points.len() {
        let free = (0..ports.len()).filter(|p| holder[*p].is_none());
        let Some(nearest) = free.min_by(|a, b| length(point, *a).total_cmp(&length(point, *b)))
        else {
            break;
        };
        holder[nearest] = Some(point);
        port_of.push(nearest);
    }
    for _ in 0..ROUNDS {
        let mut better = false;
        for point in 0..port_of.len() {
            for port in 0..ports.len() {
                let own = port_of[point];
                let now = length(point, own) + holder[port].map_or(0.0, |o| length(o, port));
                let then = length(point, port) + holder[port].map_or(0.0, |o| length(o, own));
                if port != own && then < now * (1.0 - 1e-9) {
                    if let Some(other) = holder[port] {
                        port_of[other] = own;
                    }
                    holder.swap(port, own);
                    port_of[point] = port;
                    better = true;
                }
            }
        }
        if !better {
            break;
        }
    }
    port_of
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::orient2d_value;

    #[test]
    fn lines_of_callouts_do_not_cross_and_circles_do_not_touch() {
        let bounds = Rect::new(DVec2::ZERO, DVec2::new(60.0, 40.0)).unwrap();
        let points: Vec<DVec2> = (0..14u32)
            .map(|i| DVec2::new(f64::from(i * 37 % 60), f64::from(i * 23 % 40)))
            .collect();
        let (ports, apart) = ports(&bounds, points.len());
        assert!(apart >= 2.0 * RADIUS && ports.len() >= points.len());
        let found = matched(&points, &ports);
        let mut used = found.clone();
        used.sort_unstable();
        used.dedup();
        assert_eq!(used.len(), points.len());
        let crosses = |i: usize, j: usize| {
            let (a, b, c, d) = (points[i], ports[found[i]], points[j], ports[found[j]]);
            orient2d_value(a, b, c) * orient2d_value(a, b, d) < 0.0
                && orient2d_value(c, d, a) * orient2d_value(c, d, b) < 0.0
        };
        for i in 0..points.len() {
            assert!((0..i).all(|j| !crosses(i, j)), "{i}");
        }
        // If there are too many, circles shrink.
        assert!(super::ports(&bounds, 100).1 < APART);
    }
}
