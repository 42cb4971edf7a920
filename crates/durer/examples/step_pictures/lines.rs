//! Line clipping.

use durer::clip::line::{
    ConvexPolygon, End, Relation, Segment, cohen_sutherland, cyrus_beck, midpoint,
    nicholl_lee_nicholl,
};
use durer::clip::outcode::Outcode;
use durer::math::{DVec2, IVec2, Rect};
use durer::trace::Recorder;

use crate::Picture;
use crate::sketch::{Panel, svg};

pub const ALL: &[fn() -> Picture] = &[
    || ("cohen-sutherland", outcodes()),
    || ("midpoint", halving()),
    || ("cyrus-beck", parameters()),
    || ("nicholl-lee-nicholl", corners()),
];

fn p(x: f64, y: f64) -> DVec2 {
    DVec2::new(x, y)
}

fn bits(code: Outcode) -> String {
    format!("{:04b}", code.0)
}

fn border(code: Outcode) -> &'static str {
    let names = ["left", "right", "bottom", "top"];
    let all = Outcode::BORDERS.into_iter().zip(names);
    all.into_iter().find(|(b, _)| *b == code).map_or("?", |(_, name)| name)
}

/// The window's four lines, drawn through.
fn nine_regions(panel: &mut Panel, window: &Rect, around: &Rect) {
    let (a, b, low, high) = (window.min(), window.max(), around.min(), around.max());
    for x in [a.x, b.x] {
        panel.line([p(x, low.y), p(x, high.y)], "thin");
    }
    for y in [a.y, b.y] {
        panel.line([p(low.x, y), p(high.x, y)], "thin");
    }
    panel.rect(window, "win");
}

fn outcodes() -> durer::Result<String> {
    let window = Rect::new(p(0.0, 0.0), p(10.0, 6.0))?;
    let around = Rect::new(p(-6.0, -4.0), p(16.0, 10.0))?;
    let segment = Segment::new(p(-4.0, -2.5), p(12.5, 8.5));
    let mut steps = Recorder::default();
    cohen_sutherland::clip(&window, segment, &mut steps)?;
    let mut panels = Vec::new();
    let mut left = segment;
    for step in steps.steps() {
        let mut panel = Panel::new(around.min().into(), around.max().into())?;
        nine_regions(&mut panel, &window, &around);
        panel.line([segment.start, segment.end], "pale");
        let caption = match *step {
            cohen_sutherland::Step::Codes { start, end } => {
                for (x, y) in
                    [-3.0, 5.0, 13.0].into_iter().flat_map(|x| [-3.0, 3.0, 9.0].map(|y| (x, y)))
                {
                    panel.text(p(x, y), (0.0, 0.0), &bits(Outcode::of_point_2d(&window, p(x, y))));
                }
                format!(
                    "codes {} and {}: AND is 0,\nOR is not: neither refused nor accepted",
                    bits(start),
                    bits(end)
                )
            }
            cohen_sutherland::Step::Cut { end, border: at, point, code } => {
                left = match end {
                    End::Start => Segment { start: point, ..left },
                    End::End => Segment { end: point, ..left },
                };
                panel.dot(point, "#d1495b");
                let which = if end == End::Start { "first" } else { "second" };
                format!("the {which} end moves to\nthe {} border: code {}", border(at), bits(code))
            }
            cohen_sutherland::Step::Accepted => "OR is 0: accepted".into(),
            cohen_sutherland::Step::Rejected => "AND is not 0: rejected".into(),
        };
        panel.line([left.start, left.end], "a");
        panels.push(panel.caption(caption));
    }
    Ok(svg(&panels, 3))
}

fn halving() -> durer::Result<String> {
    let window = midpoint::PixelWindow::new(IVec2::new(4, 3), IVec2::new(19, 11))?;
    let segment = Segment::new(IVec2::new(0, 0), IVec2::new(31, 14));
    let mut steps = Recorder::default();
    midpoint::clip(&window, segment, &mut steps);
    let center = |at: IVec2| at.as_dvec2() + 0.5;
    let mut panels = Vec::new();
    let mut looked: Vec<IVec2> = Vec::new();
    for step in steps.steps() {
        let (end, point) = match *step {
            midpoint::Step::Halved { middle, .. } => {
                looked.push(middle);
                continue;
            }
            midpoint::Step::Cut { end, point } => (end, point),
            midpoint::Step::Accepted | midpoint::Step::Rejected => continue,
        };
        let mut panel = Panel::pixels(32, 15)?;
        let frame = Rect::new(window.min().as_dvec2(), window.max().as_dvec2() + 1.0)?;
        panel.rect(&frame, "win");
        panel.line([segment.start, segment.end].map(center), "pale");
        for (i, &at) in looked.iter().enumerate() {
            panel.dot(center(at), "#1f6fb4");
            panel.text(
                center(at),
                (0.0, if i % 2 == 0 { -8.0 } else { 9.0 }),
                &format!("{}", i + 1),
            );
        }
        panel.dot(center(point), "#d1495b");
        let which = if end == End::Start { "first" } else { "second" };
        let count = looked.len();
        panels.push(panel.caption(format!(
            "{count} middles (blue, numbered), then\nthe {which} end is found (red)"
        )));
        looked.clear();
    }
    Ok(svg(&panels, 2))
}

/// Returns the intersection of the lines through two pairs of points.
fn meet([a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> DVec2 {
    let (u, v) = (b - a, d - c);
    a + u * ((c - a).perp_dot(v) / u.perp_dot(v))
}

fn parameters() -> durer::Result<String> {
    let corners = [p(1.0, 0.5), p(6.5, 0.0), p(9.0, 3.5), p(5.5, 6.5), p(0.5, 5.0)];
    let window = ConvexPolygon::new(&corners)?;
    let segment = Segment::new(p(-3.0, 0.2), p(12.5, 5.6));
    let mut steps = Recorder::default();
    cyrus_beck::clip_polygon(&window, segment, &mut steps)?;
    let mut all = Panel::new((-4.0, -2.5), (13.5, 9.0))?;
    let mut result = Panel::new((-4.0, -2.5), (13.5, 9.0))?;
    let ends = [segment.start, segment.end];
    let mut left = segment;
    for panel in [&mut all, &mut result] {
        panel.rings([window.vertices()], "win");
        panel.line(ends, "pale");
    }
    for step in steps.steps() {
        match *step {
            cyrus_beck::Step::Border { border, relation, .. } => {
                let edge = [border, (border + 1) % 5].map(|i| window.vertices()[i]);
                let along = (edge[1] - edge[0]).normalize() * 20.0;
                all.line([edge[0] - along, edge[1] + along], "dash");
                let at = meet(ends, edge);
                match relation {
                    Relation::Entering => all.dot(at, "#2b7a48"),
                    Relation::Leaving => all.dot(at, "#d1495b"),
                    Relation::Inside | Relation::Outside => {}
                }
            }
            cyrus_beck::Step::Cut { end: End::Start, point, .. } => {
                left.start = point;
                result.dot(point, "#2b7a48");
            }
            cyrus_beck::Step::Cut { end: End::End, point, .. } => {
                left.end = point;
                result.dot(point, "#d1495b");
            }
            cyrus_beck::Step::Accepted | cyrus_beck::Step::Rejected => {}
        }
    }
    result.line([left.start, left.end], "a");
    let panels = [
        all.caption("each border's line: entered (green)\nor left (red)"),
        result.caption("the last entry and the first exit\nbound the visible part"),
    ];
    Ok(svg(&panels, 2))
}

fn corners() -> durer::Result<String> {
    let window = Rect::new(p(0.0, 0.0), p(10.0, 6.0))?;
    let around = Rect::new(p(-6.0, -4.0), p(16.0, 10.0))?;
    let cases = [
        (Segment::new(p(3.0, 2.0), p(14.0, 7.0)), "from inside"),
        (Segment::new(p(-4.0, 2.0), p(12.0, 8.5)), "from beside a border"),
        (Segment::new(p(-4.0, -2.5), p(13.0, 4.5)), "from a corner"),
    ];
    let mut panels = Vec::new();
    for (segment, name) in cases {
        let mut steps = Recorder::default();
        let clipped = nicholl_lee_nicholl::clip(&window, segment, &mut steps)?;
        let mut panel = Panel::new(around.min().into(), around.max().into())?;
        panel.rect(&window, "win");
        let (mut asked, mut cuts) = (0, 0);
        for step in steps.steps() {
            match *step {
                nicholl_lee_nicholl::Step::Corner { corner, .. } => {
                    let right = corner.0 & Outcode::RIGHT.0 != 0;
                    let top = corner.0 & Outcode::TOP.0 != 0;
                    let at = p(if right { 10.0 } else { 0.0 }, if top { 6.0 } else { 0.0 });
                    panel
                        .line([segment.start, segment.start + (at - segment.start) * 1.35], "dash");
                    asked += 1;
                }
                nicholl_lee_nicholl::Step::Cut { point, .. } => {
                    panel.dot(point, "#d1495b");
                    cuts += 1;
                }
                _ => {}
            }
        }
        panel.line([segment.start, segment.end], "pale");
        if let Some(seen) = clipped {
            panel.line([seen.start, seen.end], "a");
        }
        let plural = |n: usize| if n == 1 { "" } else { "s" };
        panels.push(panel.caption(format!(
            "{name}: {asked} corner{} asked for,\n{cuts} cut{} computed",
            plural(asked),
            plural(cuts)
        )));
    }
    Ok(svg(&panels, 3))
}
