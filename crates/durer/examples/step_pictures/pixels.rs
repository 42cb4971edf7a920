//! Lines, polygons and seed fills in pixels.

use durer::curve::Contours;
use durer::math::{DVec2, IVec2, Rect};
use durer::raster::coverage::{self, FillRule};
use durer::raster::line::anti_aliased::{self, SmoothLine};
use durer::raster::line::{self, LineRasterizer};
use durer::raster::polygon::{self, edge_table};
use durer::raster::seed_fill::{self, SeedFill, flood_fill};
use durer::target::Pixels;
use durer::trace::{NoTrace, Recorder};

use crate::Picture;
use crate::sketch::{Panel, shade, svg};

pub const ALL: &[fn() -> Picture] = &[
    || ("lines", lines()),
    || ("edge-table", rows()),
    || ("coverage", areas()),
    || ("seed-fill", seeds()),
];

const BLUE: [u8; 3] = [0x1f, 0x6f, 0xb4];
const PALE: [u8; 3] = [0xd6, 0xe6, 0xf4];
const WHITE: [u8; 3] = [255; 3];

fn lines() -> durer::Result<String> {
    let (from, to) = (IVec2::new(1, 1), IVec2::new(14, 6));
    let center = |p: IVec2| p.as_dvec2() + 0.5;
    let mut panels = Vec::new();
    let window = (IVec2::new(4, 0), IVec2::new(9, 7));
    for (window, caption) in [
        (None, "Bresenham: the pixels in their order"),
        (Some(window), "clipped: the same pixels, those in\nthe window only"),
    ] {
        let mut panel = Panel::pixels(16, 8)?;
        let mut steps = Recorder::default();
        let options = line::Options { window };
        LineRasterizer::Bresenham.draw(from, to, &options, |_| {}, &mut steps);
        for (i, step) in steps.steps().iter().enumerate() {
            let at = step.pixel.as_dvec2();
            panel.cell(at.x, at.y, "#8fbbe0");
            panel.mark(at.x, at.y, &format!("{}", i + 1));
        }
        if let Some((low, high)) = window {
            panel.rect(&Rect::new(low.as_dvec2(), high.as_dvec2() + 1.0)?, "win");
        }
        panel.line([from, to].map(center), "b");
        panels.push(panel.caption(caption));
    }
    for (method, caption) in [
        (SmoothLine::Wu, "Wu: two pixels per column share\nthe intensity"),
        (SmoothLine::GuptaSproull, "Gupta–Sproull: by the distance\nof the pixel from the line"),
    ] {
        let mut panel = Panel::pixels(16, 8)?;
        let mut steps = Recorder::default();
        anti_aliased::draw(method, from, to, &Default::default(), |_, _| {}, &mut steps);
        for step in steps.steps() {
            let color = shade(WHITE, BLUE, f64::from(step.intensity) / 255.0);
            panel.cell(f64::from(step.pixel.x), f64::from(step.pixel.y), &color);
        }
        panel.line([from, to].map(center), "b");
        panels.push(panel.caption(caption));
    }
    Ok(svg(&panels, 4))
}

/// Returns a polygon with a notch, in pixels.
fn notched() -> Vec<DVec2> {
    let points =
        [(1.2, 1.4), (6.1, 4.3), (11.3, 0.6), (14.6, 7.2), (9.0, 9.5), (6.4, 7.1), (3.1, 9.2)];
    points.map(DVec2::from).to_vec()
}

fn rows() -> durer::Result<String> {
    let (contours, size) = (Contours::polygon(notched()), (16, 10));
    let options = polygon::Options { rule: FillRule::EvenOdd };
    let mut steps = Recorder::default();
    edge_table::fill(&contours, size.0, size.1, &options, |_| {}, &mut steps);
    let mut panels = Vec::new();
    for last in [2, 4, 7, 9] {
        let mut panel = Panel::pixels(size.0, size.1)?;
        let (mut entered, mut active) = (0, 0);
        for step in steps.steps() {
            match *step {
                edge_table::Step::Span(span) if span.y <= last => {
                    let color = if span.y == last { "#1f6fb4" } else { "#a9cbe8" };
                    (span.x0..span.x1)
                        .for_each(|x| panel.cell(f64::from(x), f64::from(span.y), color));
                }
                edge_table::Step::Enter { y, .. } if y <= last => {
                    (entered, active) = (entered + 1, active + 1);
                }
                edge_table::Step::Leave { y, active: left } if y <= last => active = left,
                _ => {}
            }
        }
        panel.rings([&notched()[..]], "b");
        panels.push(
            panel.caption(format!("row {last}: {entered} edges entered so far,\n{active} active")),
        );
    }
    Ok(svg(&panels, 4))
}

fn areas() -> durer::Result<String> {
    let triangle = [(1.3, 0.7), (8.6, 2.9), (2.4, 5.6)].map(DVec2::from);
    let contours = Contours::polygon(triangle);
    let mut aliased = Panel::pixels(10, 6)?;
    let options = polygon::Options { rule: FillRule::NonZero };
    let emit = |span: durer::raster::span::Span| {
        (span.x0..span.x1).for_each(|x| aliased.cell(f64::from(x), f64::from(span.y), "#8fbbe0"));
    };
    edge_table::fill(&contours, 10, 6, &options, emit, &mut NoTrace);
    for (x, y) in (0..10).flat_map(|x| (0..6).map(move |y| (x, y))) {
        let center = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
        aliased.line([center - DVec2::X * 0.06, center + DVec2::X * 0.06], "win");
    }
    aliased.rings([&triangle[..]], "b");
    let mut smooth = Panel::pixels(10, 6)?;
    let mut steps = Recorder::default();
    coverage::fill(&contours, 10, 6, &Default::default(), &mut steps)?;
    for step in steps.steps() {
        let color = shade(WHITE, [0x8f, 0xbb, 0xe0], f64::from(step.coverage) / 255.0);
        for x in step.x0..step.x1 {
            smooth.cell(f64::from(x), f64::from(step.y), &color);
            smooth.mark(f64::from(x), f64::from(step.y), &format!("{}", step.coverage));
        }
    }
    smooth.rings([&triangle[..]], "b");
    let panels = [
        aliased.caption("aliased: pixels whose centres are inside"),
        smooth.caption("area coverage: 255 times the part\nof the pixel that is inside"),
    ];
    Ok(svg(&panels, 2))
}

fn seeds() -> durer::Result<String> {
    let walls = [
        "................",
        ".##########.....",
        ".#........#.....",
        ".#..####..#.....",
        ".#..#..#..####..",
        ".#.....#.....#..",
        ".#######..#..#..",
        "......#......#..",
        "......########..",
        "................",
    ];
    let image = || {
        let data: Vec<u8> = walls.concat().bytes().map(|b| u8::from(b == b'#')).collect();
        Pixels::from_data(16, 10, data)
    };
    let mut panels = Vec::new();
    for method in [SeedFill::Naive, SeedFill::Spans] {
        let mut pixels = image()?;
        let mut steps = Recorder::default();
        let options = seed_fill::Options::default();
        let filled = flood_fill(&mut pixels, (4, 2), 2, 0, method, &options, &mut steps);
        for part in [3, 1] {
            let mut panel = Panel::pixels(16, 10)?;
            for (i, _) in walls.concat().bytes().enumerate().filter(|(_, b)| *b == b'#') {
                panel.cell((i % 16) as f64, (i / 16) as f64, "#444");
            }
            let runs: Vec<_> = steps.steps().iter().filter_map(seed_fill::Step::filled).collect();
            let steps = &runs[..runs.len() / part];
            for (i, step) in steps.iter().enumerate() {
                let color = shade(PALE, BLUE, i as f64 / steps.len() as f64);
                for x in step.x0..step.x1 {
                    panel.cell(x as f64, step.y as f64, &color);
                }
                if method == SeedFill::Spans {
                    panel.mark(step.x0 as f64, step.y as f64, &format!("{}", i + 1));
                }
            }
            panel.dot(DVec2::new(4.5, 2.5), "#d1495b");
            let what = if method == SeedFill::Naive { "pixels from a stack" } else { "spans" };
            panels.push(panel.caption(format!(
                "{} {what}\n({filled} pixels in all, darker is later)",
                steps.len()
            )));
        }
    }
    Ok(svg(&panels, 4))
}
