//! `durer pick`.

use crate::camera::{self, Shot};
use crate::failure::Failure;
use crate::input;
use crate::messages::Messages;
use crate::options::{ReadingArgs, RunningArgs, ViewArgs};
use crate::report;
use crate::shape;
use crate::sides::{Sides, sides};
use crate::values;
use clap::{Args, ValueHint};
use durer::math::{DVec2, Rect};
use durer::scene::{Scene, Topology};
use durer::view::View;
use durer::view::pick::{Hit, PickArea, objects, pick};
use durer_formats::wording::counted;
use serde::Serialize;
use std::fmt::Write;
use std::path::PathBuf;

/// The options of `durer pick`.
#[derive(Debug, Args)]
pub struct PickArgs {
    /// The model; `-` reads it from standard input
    #[arg(value_name = "MODEL", value_hint = ValueHint::FilePath)]
    pub model: PathBuf,
    /// A point of the picture, in pixels from its upper left corner
    ///
    /// x to the right, y downwards; the middle of the first pixel is 0.5,0.5.
    #[arg(long, value_name = "X,Y", allow_hyphen_values = true, value_parser = values::point, required_unless_present = "rect", conflicts_with = "rect")]
    pub at: Option<DVec2>,
    /// A rectangle of the picture, in pixels: two opposite corners
    #[arg(long, value_name = "X0,Y0,X1,Y1", allow_hyphen_values = true, value_parser = values::rect)]
    pub rect: Option<Rect>,
    /// Width and height of the picture in pixels, as for `render`
    #[arg(long, value_name = "WxH", allow_hyphen_values = true, default_value = "1024x1024", value_parser = sides)]
    pub size: Sides,
    /// Write JSON
    #[arg(long)]
    pub json: bool,
    /// Options for the camera.
    #[command(flatten)]
    pub view: ViewArgs,
    /// Reading and its limits.
    #[command(flatten)]
    pub reading: ReadingArgs,
    /// Threads and messages.
    #[command(flatten)]
    pub running: RunningArgs,
}

/// Contents behind a part of the picture.
#[derive(Debug, Serialize)]
struct Picked {
    model: String,
    /// Objects, nearest first.
    objects: Vec<Object>,
    /// Triangles, nearest first.
    triangles: Vec<Triangle>,
    /// Lines, nearest first.
    lines: Vec<Mark>,
    /// Points, nearest first.
    points: Vec<Mark>,
}

#[derive(Debug, Serialize)]
struct Object {
    instance: usize,
    name: String,
    /// Window depth of the nearest point: 0 at the near plane, 1 at the far.
    depth: f64,
    /// Number of its triangles that were hit.
    triangles: usize,
    /// Number of its lines or points that were hit.
    marks: usize,
}

#[derive(Debug, Serialize)]
struct Triangle {
    /// Number in the pictures that `render --item` writes.
    item: u32,
    instance: usize,
    /// Index in the mesh.
    triangle: usize,
    depth: f64,
    /// Position in the world.
    position: [f64; 3],
}

/// A line or a point of the model.
#[derive(Debug, Serialize)]
struct Mark {
    /// Counted on from the triangles.
    item: u32,
    instance: usize,
    /// Index in the mesh.
    index: usize,
    depth: f64,
    /// Position in the world.
    position: [f64; 3],
}

/// Reads a model and reports the items behind a part of the picture.
pub fn run(args: &PickArgs) -> Result<(), Failure> {
    camera::check(&args.view)?;
    let name = input::display_name(&args.model);
    let messages = Messages::new(&args.running, 1);
    let mut model =
        input::read(&args.model, &input::read_options(&args.reading, &args.running.work))?;
    if let Some(axis) = args.view.up_axis {
        model.scene.up_axis = axis.into();
    }
    messages.warnings(&name, &model.warnings);
    drop(messages);
    let usage = |e: durer::Error| Failure::of_library(&e);
    let natural = match args.size.is_open() {
        true => shape::of_view(&args.view, &model.scene, None)
            .map_err(|failure| input::blamed(&name, &model.scene, failure))?,
        false => DVec2::ONE,
    };
    let size = args.size.of_shape(natural);
    let shot = Shot { view: None, size, turn: None };
    let camera = camera::camera(&args.view, &model.scene, &shot)
        .map_err(|failure| input::blamed(&name, &model.scene, failure))?;
    let view = View::new(camera, size.width, size.height).map_err(usage)?;
    let area = match (args.at, args.rect) {
        (_, Some(rect)) => PickArea::Rect(rect),
        (Some(point), None) => PickArea::Point(point),
        (None, None) => return Err(Failure::Usage("--at or --rect is needed".to_owned())),
    };
    let hits = pick(&model.scene, &view, area);
    let picked = describe(name, &model.scene, &hits);
    if args.json { report::print(&picked) } else { report::print_text(&text(&picked)) }
}

fn describe(model: String, scene: &Scene, hits: &[Hit]) -> Picked {
    let objects = objects(hits).into_iter().map(|o| Object {
        instance: o.instance,
        name: scene.instances[o.instance].name.clone(),
        depth: o.nearest.depth,
        triangles: if o.nearest.topology == Topology::Triangles { o.primitives } else { 0 },
        marks: if o.nearest.topology == Topology::Triangles { 0 } else { o.primitives },
    });
    let triangles = of(hits, Topology::Triangles).map(|h| Triangle {
        item: h.item,
        instance: h.instance,
        triangle: h.primitive,
        depth: h.depth,
        position: h.position.to_array(),
    });
    Picked {
        model,
        objects: objects.collect(),
        triangles: triangles.collect(),
        lines: of(hits, Topology::Lines).map(Mark::from).collect(),
        points: of(hits, Topology::Points).map(Mark::from).collect(),
    }
}

/// Returns the hits of one kind.
fn of(hits: &[Hit], topology: Topology) -> impl Iterator<Item = &Hit> {
    hits.iter().filter(move |h| h.topology == topology)
}

impl From<&Hit> for Mark {
    fn from(h: &Hit) -> Self {
        let Hit { item, instance, primitive: index, depth, .. } = *h;
        Self { item, instance, index, depth, position: h.position.to_array() }
    }
}

/// Returns one line per object.
fn text(picked: &Picked) -> String {
    let mut text = String::new();
    for o in &picked.objects {
        let name = if o.name.is_empty() { "unnamed" } else { &o.name };
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "object {} ({name}): {}, nearest at depth {:.6}",
            o.instance,
            if o.marks > 0 {
                counted(o.marks as u64, "line or point", "lines or points")
            } else {
                counted(o.triangles as u64, "triangle", "triangles")
            },
            o.depth
        );
    }
    if picked.objects.is_empty() {
        text.push_str("nothing\n");
    }
    text
}
