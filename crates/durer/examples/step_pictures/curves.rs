//! Curves and their flattening.

use durer::curve::b_spline::BSpline;
use durer::curve::bezier::de_casteljau;
use durer::curve::{Path, flatten};
use durer::math::DVec2;
use durer::trace::{NoTrace, Recorder};

use crate::Picture;
use crate::sketch::{Panel, svg};

pub const ALL: &[fn() -> Picture] = &[|| ("de-casteljau", mixes()), || ("flatten", chords())];

fn control() -> [DVec2; 4] {
    [(1.0, 1.0), (2.5, 8.0), (10.0, 9.0), (12.0, 2.0)].map(DVec2::from)
}

fn panel() -> durer::Result<Panel> {
    Panel::new((0.0, 0.0), (13.0, 9.5))
}

fn mixes() -> durer::Result<String> {
    let t = 0.35;
    let mut steps = Recorder::default();
    de_casteljau(&control(), t, &mut steps);
    let curve: Vec<DVec2> = (0..=60)
        .filter_map(|i| de_casteljau(&control(), f64::from(i) / 60.0, &mut NoTrace))
        .collect();
    let mut panels = Vec::new();
    let names =
        ["the control points", "mixed by t = 0.35", "mixed again", "the point of the curve"];
    for (level, name) in names.into_iter().enumerate() {
        let mut panel = panel()?;
        panel.chain(&curve, "pale");
        panel.chain(&control(), "thin");
        for at in 0..=level {
            let of_level = steps.steps().iter().filter(|s| s.level == at).map(|s| s.point);
            let points: Vec<DVec2> = if at == 0 { control().to_vec() } else { of_level.collect() };
            panel.chain(&points, ["thin", "a", "c", "b"][at]);
            let color = ["#888", "#1f6fb4", "#2b7a48", "#d1495b"][at];
            points.iter().for_each(|&p| panel.dot(p, color));
        }
        panels.push(panel.caption(name));
    }
    Ok(svg(&panels, 4))
}

fn chords() -> durer::Result<String> {
    let mut path = Path::new();
    let [a, b, c, d] = control();
    path.move_to(a.x, a.y).cubic_to(b, c, d);
    let mut panels = Vec::new();
    for tolerance in [1.0, 0.25, 0.02] {
        let mut panel = panel()?;
        let chain = flatten(&path, tolerance);
        panel.chain(flatten(&path, 0.001).points(), "pale");
        panel.chain(chain.points(), "a");
        chain.points().iter().for_each(|&p| panel.dot(p, "#1f6fb4"));
        let count = chain.points().len() - 1;
        panels.push(panel.caption(format!("tolerance {tolerance}: {count} chords")));
    }
    let points =
        [(0.7, 1.0), (1.5, 8.0), (5.0, 1.0), (7.5, 9.0), (10.0, 1.5), (12.5, 7.0)].map(DVec2::from);
    let spline = BSpline::clamped(3, points.to_vec())?;
    let (start, end) = spline.domain();
    let at = |i: i32| spline.point(start + (end - start) * f64::from(i) / 90.0);
    let mut last = panel()?;
    last.chain(&points, "thin");
    points.iter().for_each(|&p| last.dot(p, "#888"));
    last.chain(&(0..=90).map(at).collect::<Vec<_>>(), "b");
    (0..=3).for_each(|k| last.dot(at(30 * k), "#d1495b"));
    panels.push(last.caption("a cubic B-spline by de Boor:\nthree pieces, joined at the knots"));
    Ok(svg(&panels, 4))
}
