//! Polygon clipping.

use durer::clip::polygon::overlay::{self, overlay};
use durer::clip::polygon::{BooleanOp, Shapes, greiner_hormann, vatti};
use durer::math::{DVec2, Rect};
use durer::trace::Recorder;

use crate::Picture;
use crate::sketch::{Panel, svg};

pub const ALL: &[fn() -> Picture] =
    &[|| ("greiner-hormann", entries()), || ("vatti", sweep()), || ("overlay", snapping())];

fn ring(points: &[(f64, f64)]) -> Vec<DVec2> {
    points.iter().map(|&p| p.into()).collect()
}

/// Returns a letter C that a window cuts in two.
fn letter() -> Vec<DVec2> {
    ring(&[
        (1.0, 0.0),
        (12.0, 0.0),
        (12.0, 3.0),
        (4.0, 3.0),
        (4.0, 6.0),
        (12.0, 6.0),
        (12.0, 9.0),
        (1.0, 9.0),
    ])
}

fn pair() -> [Vec<DVec2>; 2] {
    let clip = ring(&[(3.0, -1.0), (9.0, 1.5), (10.0, 7.0), (6.0, 10.5), (2.5, 8.5), (6.5, 4.5)]);
    [letter(), clip]
}

fn both(panel: &mut Panel, [subject, clip]: &[Vec<DVec2>; 2]) {
    panel.rings([&subject[..]], "fa");
    panel.rings([&clip[..]], "fb");
}

fn result(rings: &[Vec<DVec2>]) -> durer::Result<Panel> {
    let mut panel = Panel::new((0.0, -2.0), (13.0, 11.0))?;
    both(&mut panel, &pair());
    panel.rings(rings.iter().map(|r| &r[..]), "fc");
    Ok(panel)
}

fn entries() -> durer::Result<String> {
    let [subject, clip] = pair().map(|ring| Shapes::from_rings([ring]));
    let mut steps = Recorder::default();
    let op = BooleanOp::Difference;
    greiner_hormann::greiner_hormann(&subject, &clip, op, &Default::default(), &mut steps)?;
    let mut crossings = Panel::new((0.0, -2.0), (13.0, 11.0))?;
    both(&mut crossings, &pair());
    let mut rings = Vec::new();
    for step in steps.steps() {
        match step {
            greiner_hormann::Step::Crossing { at, entry } => {
                crossings.dot(*at, if *entry { "#2b7a48" } else { "#d1495b" });
            }
            greiner_hormann::Step::Ring { points } => rings.push(points.clone()),
            _ => {}
        }
    }
    let panels = [
        crossings.caption("the subject enters the clip (green)\nor leaves it (red)"),
        result(&rings)?.caption(format!("difference: {} rings", rings.len())),
    ];
    Ok(svg(&panels, 2))
}

fn sweep() -> durer::Result<String> {
    let [subject, clip] = pair().map(|ring| Shapes::from_rings([ring]));
    let mut steps = Recorder::default();
    let out = vatti::vatti(&subject, &clip, BooleanOp::Xor, &Default::default(), &mut steps)?;
    let stops: Vec<(DVec2, usize)> = (steps.steps().iter())
        .filter_map(|step| match *step {
            overlay::Step::Sweep { at, active } => Some((at, active)),
            _ => None,
        })
        .collect();
    let mut panels = Vec::new();
    for k in [stops.len() / 4, stops.len() / 2, stops.len() * 3 / 4] {
        let (at, active) = stops[k];
        let mut panel = Panel::new((0.0, -2.0), (13.0, 11.0))?;
        both(&mut panel, &pair());
        panel.line([DVec2::new(at.x, -2.0), DVec2::new(at.x, 11.0)], "win");
        stops[..=k].iter().for_each(|stop| panel.dot(stop.0, "#222"));
        panels.push(
            panel.caption(format!("{} nodes passed,\n{active} edges active after the last", k + 1)),
        );
    }
    let rings: Vec<Vec<DVec2>> = out.shapes.rings().map(<[DVec2]>::to_vec).collect();
    let count = (out.shapes.polygon_count(), rings.len());
    panels.push(result(&rings)?.caption(format!("xor: {} polygons, {} rings", count.0, count.1)));
    Ok(svg(&panels, 4))
}

fn snapping() -> durer::Result<String> {
    let a = ring(&[(0.6, 0.8), (9.2, 2.4), (8.6, 6.2), (1.4, 5.7)]);
    let b = ring(&[(4.3, 0.1), (6.1, 0.4), (7.4, 7.6), (3.2, 7.2)]);
    let (subject, clip) = (Shapes::from_rings([&a]), Shapes::from_rings([&b]));
    let options = overlay::Options { grid: Some(1.0), ..Default::default() };
    let mut steps = Recorder::default();
    let out = overlay(&subject, &clip, BooleanOp::Union, &options, &mut steps)?;
    let mut panels = Vec::new();
    for done in [false, true] {
        let mut panel = Panel::new((-0.5, -0.5), (10.5, 8.5))?;
        for k in 0..10 {
            let at = f64::from(k) + 0.5;
            panel.line([DVec2::new(at, -0.5), DVec2::new(at, 8.5)], "grid");
            if k < 8 {
                panel.line([DVec2::new(-0.5, at), DVec2::new(10.5, at)], "grid");
            }
        }
        for p in a.iter().chain(&b) {
            let cell = Rect::new((*p + 0.5).floor() - 0.5, (*p + 0.5).floor() + 0.5)?;
            panel.rect(&cell, "fb");
        }
        for step in steps.steps() {
            if let overlay::Step::Crossing { at } = *step {
                panel.rect(&Rect::new(at - 0.5, at + 0.5)?, "fb");
            }
        }
        panel.rings([&a[..], &b[..]], "a");
        let caption = if done {
            panel.rings(out.shapes.rings(), "fc");
            "edges bent to the centres of the hot cells\nthey pass: the union"
        } else {
            "hot cells (red): those of the corners\nand of the crossings"
        };
        panels.push(panel.caption(caption));
    }
    Ok(svg(&panels, 2))
}
