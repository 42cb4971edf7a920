//! Hidden lines and the floating horizon.

use durer::math::{DVec2, DVec3, Rect};
use durer::scene::{Camera, HeightField, Projection};
use durer::target::drawing::{Drawing, LineClass};
use durer::trace::{NoTrace, Recorder};
use durer::view::View;
use durer::view::picture_plane::PicturePlane;
use durer::visibility::line::floating_horizon::{self, Family, Piece};
use durer::visibility::line::{Intersections, edge_lines::ClassSet, hidden_line};

use crate::Picture;
use crate::scene;
use crate::sketch::{Panel, svg};

pub const ALL: &[fn() -> Picture] =
    &[|| ("hidden-line", invisibility()), || ("floating-horizon", horizon())];

fn panel(window: Rect) -> durer::Result<Panel> {
    let margin = window.size() * 0.03;
    Panel::new((window.min() - margin).into(), (window.max() + margin).into())
}

fn invisibility() -> durer::Result<String> {
    let (scene, mut camera) = (scene::scene(), scene::camera());
    camera.projection = Projection::Perspective { fov_y: 0.9 };
    let view = View::new(camera, 288, 216)?;
    let options = hidden_line::Options {
        hidden: true,
        intersections: Intersections::All,
        classes: ClassSet::default().with(LineClass::Intersection),
        ..Default::default()
    };
    let drawing: Drawing = hidden_line::draw(&scene, &view, &options, &mut NoTrace)?;
    let Some(window) = drawing.bounds() else { return Ok(String::new()) };
    let mut panels = Vec::new();
    let classes = ["a", "b", "c"];
    for (k, caption) in [
        "all lines: edges, and where faces\ngo through each other",
        "how many faces are before each piece:\nblue none, red one",
        "hidden pieces dashed",
        "hidden pieces dropped",
    ]
    .into_iter()
    .enumerate()
    {
        let mut panel = panel(window)?;
        for line in &drawing.lines {
            let level = (line.invisibility as usize).min(2);
            let class = match (k, line.is_visible()) {
                (0, _) | (2.., true) => "win",
                (1, _) => classes[level],
                (2, false) => "dash",
                (_, false) => continue,
            };
            let mut points = line.points.clone();
            points.extend(line.points.first().filter(|_| line.closed));
            panel.chain(&points, class);
        }
        panels.push(panel.caption(caption));
    }
    Ok(svg(&panels, 4))
}

/// Returns a piece of a grid line, as seen.
fn seen(piece: &Piece, field: &HeightField, plane: &PicturePlane) -> Option<[DVec2; 2]> {
    let at = |i: usize| match piece.family {
        Family::AlongX => field.point(i, piece.line),
        Family::AlongZ => field.point(piece.line, i),
    };
    let (a, b) = (at(piece.segment)?, at(piece.segment + 1)?);
    let [p, q] = piece.range.map(|t| plane.project(a + (b - a) * t));
    Some([p?, q?])
}

fn horizon() -> durer::Result<String> {
    let field = HeightField::from_fn([25, 21], [-6.0, 6.0], [-6.0, 6.0], |x, z| {
        let r = libm::sqrt(x * x + z * z).max(1e-9);
        4.0 * libm::sin(1.6 * r) / (1.0 + r)
    })?;
    let camera = Camera {
        eye: DVec3::new(7.0, 10.0, 16.0),
        target: DVec3::ZERO,
        up: DVec3::Y,
        projection: Projection::Orthographic { height: 14.0 },
        near: 1.0,
        far: 60.0,
    };
    let plane = PicturePlane::of_camera(&camera, 1.0)?;
    let options = floating_horizon::Options { hidden: true, ..Default::default() };
    let mut steps = Recorder::with_cap(1 << 20);
    floating_horizon::curves(&field, &camera, &options, &mut steps)?;
    let pieces: Vec<Piece> = (steps.steps().iter())
        .filter_map(|step| match step {
            floating_horizon::Step::Piece(piece) => Some(*piece),
            floating_horizon::Step::Cover(_) => None,
        })
        .collect();
    let lines = pieces.iter().filter_map(|piece| seen(piece, &field, &plane));
    let Some(window) = Rect::around(lines.flatten()) else { return Ok(String::new()) };
    let mut panels = Vec::new();
    for (part, hidden, caption) in [
        (0.3, true, "the nearest pieces first: what they\ncover moves the horizons"),
        (
            0.65,
            true,
            "only what is above the upper or below the\nlower horizon is seen (hidden: grey)",
        ),
        (1.0, true, "all pieces"),
        (1.0, false, "the visible ones"),
    ] {
        let mut panel = panel(window)?;
        let count = (pieces.len() as f64 * part) as usize;
        for class in ["thin", "under", "seen"] {
            let look = |piece: &Piece| match (piece.visible, piece.underside) {
                (false, _) => "thin",
                (true, true) => "under",
                (true, false) => "seen",
            };
            let ends = pieces[..count].iter().filter(|p| look(p) == class);
            let ends: Vec<_> = ends.filter_map(|p| seen(p, &field, &plane)).collect();
            if class != "thin" || hidden {
                panel.chains(ends.iter().map(|e| &e[..]), class);
            }
        }
        panels.push(panel.caption(caption));
    }
    Ok(svg(&panels, 4))
}
