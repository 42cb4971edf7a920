//! Outlines of wide lines.

use durer::curve::Path;
use durer::math::DVec2;
use durer::raster::line::wide::{Cap, Join, Part, Step, Stroke, outline};
use durer::trace::Recorder;

use crate::Picture;
use crate::sketch::{Panel, svg};

pub const ALL: &[fn() -> Picture] = &[|| ("wide-line", outlines())];

fn outlines() -> durer::Result<String> {
    let long = [(2.0, 2.0), (6.5, 7.5), (11.0, 2.0)];
    let short = [(2.0, 4.0), (6.2, 4.0), (6.8, 4.9), (6.2, 5.8), (2.0, 5.8)];
    let plain = Stroke { width: 3.0, ..Stroke::default() };
    let round = Stroke { cap: Cap::Round, join: Join::Round, ..plain.clone() };
    let square = Stroke { cap: Cap::Square, join: Join::Bevel, ..plain.clone() };
    let panels = [
        panel(&long, &plain, "miter, butt: inside, one point\nwhere the offset lines meet")?,
        panel(&long, &round, "round join and caps")?,
        panel(&long, &square, "bevel, square")?,
        panel(&short, &plain, "short pieces: inside,\nthrough the corners (red)")?,
    ];
    Ok(svg(&panels, 4))
}

/// Returns the path, and the outline as its steps tell it.
fn panel(points: &[(f64, f64)], stroke: &Stroke, caption: &str) -> durer::Result<Panel> {
    let mut panel = Panel::new((-0.5, -1.0), (13.5, 10.5))?;
    let points: Vec<DVec2> = points.iter().copied().map(DVec2::from).collect();
    let mut steps = Recorder::default();
    outline(&Path::polyline(points.iter().copied()), stroke, 0.15, &mut steps)?;
    let (mut ring, mut dots) = (Vec::new(), Vec::new());
    for step in steps.steps() {
        if let Step::Point { point, part, .. } = *step {
            ring.push(point);
            dots.push((point, part));
        }
    }
    ring.extend(ring.first().copied());
    panel.chain(&points, "thin");
    panel.chain(&ring, "a");
    for (point, part) in dots {
        let color = match part {
            Part::Side => "#1f6fb4",
            Part::Pivot => "#d1495b",
            Part::Join => "#2b7a48",
            Part::Cap => "#888",
        };
        panel.dot(point, color);
    }
    Ok(panel.caption(caption))
}
