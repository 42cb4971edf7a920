//! `durer info`.

use crate::failure::Failure;
use crate::input::{self, InPieces};
use crate::layer::{self, LayerInfo};
use crate::messages::Messages;
use crate::options::{ReadingArgs, RunningArgs};
use crate::places::is_stream;
use crate::report;
use clap::{Args, ValueHint};
use durer::scene::{Aabb, Instance, LightKind, Material, Mesh, Scene, ShadingModel};
use durer::view::cull::triangle_area;
use durer::view::topology::written_topology;
use durer::visibility::object::{Edges, Faces, SceneOrientation};
use durer::work::Work;
use durer_formats::wording::{counted, cut, escaped};
use durer_formats::{Facts, Model, ModelFormat, Place, archive, is_name_of_model, xyz};
use serde::Serialize;
use std::fmt::Write;
use std::fs::File;
use std::io::BufRead;
use std::path::{Path, PathBuf};

/// The options of `durer info`.
#[derive(Debug, Args)]
pub struct InfoArgs {
    /// Models, or map data: GeoJSON, TopoJSON, FlatGeobuf, GeoPackage, Shapefile, CSV, KML, GPX, WKT, WKB; `-` reads a
    /// model from standard input
    #[arg(required = true, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub models: Vec<PathBuf>,
    /// Describe only this layer of a TopoJSON or GeoPackage file; of an archive, this file or FILE/LAYER [default: all
    /// layers]
    #[arg(long, value_name = "NAME")]
    pub layer: Option<String>,
    /// Write JSON: one object, or an array of them for several files
    #[arg(long)]
    pub json: bool,
    /// Reading and its limits.
    #[command(flatten)]
    pub reading: ReadingArgs,
    /// Threads and messages.
    #[command(flatten)]
    pub running: RunningArgs,
}

/// Report on a file's contents.
#[derive(Debug, Serialize)]
#[serde(untagged)]
enum Contents {
    Model(Box<Info>),
    Layer(Box<LayerInfo>),
}

impl Contents {
    fn text(&self) -> String {
        match self {
            Self::Model(info) => info.text(),
            Self::Layer(info) => info.text(),
        }
    }
}

/// Report on a model's contents.
#[derive(Debug, Serialize)]
struct Info {
    model: String,
    format: String,
    triangles: u64,
    /// Number of vertices of all meshes, before instancing.
    vertices: u64,
    lines: u64,
    points: u64,
    meshes: usize,
    instances: usize,
    bounds: Option<Bounds>,
    /// Area of all triangles together, in the model's own units; `null` if there are none.
    area: Option<f64>,
    /// True if the triangles bound a body; `null` if there are none.
    closed: Option<bool>,
    /// Number of closed bodies whose faces are turned inwards; `null` if that was not examined.
    inside_out: Option<u64>,
    /// Number of faces that are turned against most of their neighbours; `null` if that was not examined.
    flipped: Option<u64>,
    #[serde(skip)]
    all_inside_out: bool,
    up_axis: &'static str,
    materials: Vec<MaterialInfo>,
    textures: Vec<TextureInfo>,
    cameras: Vec<String>,
    lights: Vec<&'static str>,
    animations: Vec<String>,
    /// Names of its material variants.
    variants: Vec<String>,
    /// Names of its scenes, if it may have several.
    scenes: Vec<String>,
    plates: Vec<String>,
    extensions: Vec<String>,
    warnings: Vec<String>,
}

/// The box around the model, in its own units.
#[derive(Debug, Serialize)]
struct Bounds {
    min: [f64; 3],
    max: [f64; 3],
    size: [f64; 3],
}

#[derive(Debug, Serialize)]
struct MaterialInfo {
    name: String,
    model: &'static str,
    textures: usize,
}

#[derive(Debug, Serialize)]
struct TextureInfo {
    name: String,
    width: u32,
    height: u32,
}

/// Prints information on all models.
pub fn run(args: &InfoArgs) -> Result<(), Failure> {
    input::check_streams(&args.models)?;
    let messages = Messages::new(&args.running, args.models.len() as u64);
    let mut infos = Vec::new();
    let ended = describe_all(args, &messages, &mut infos);
    drop(messages);
    if ended.is_err() && infos.is_empty() {
        return ended;
    }
    let printed = match &infos[..] {
        _ if !args.json => {
            let texts: Vec<String> = infos.iter().map(Contents::text).collect();
            report::print_text(&texts.join("\n"))
        }
        [one] if ended.is_ok() => report::print(one),
        several => report::print(&several),
    };
    ended.and(printed)
}

/// Reads the files one after the other, up to the first that cannot be read.
fn describe_all(
    args: &InfoArgs,
    messages: &Messages,
    infos: &mut Vec<Contents>,
) -> Result<(), Failure> {
    for path in &args.models {
        let name = input::display_name(path);
        messages.progress.stage(|| format!("reading {name}"));
        if let Some(files) = maps(path) {
            let names = files.iter().map(|file| Some(file.as_str()));
            let chosen = args.layer.as_deref();
            let each =
                if chosen.is_some() || files.len() < 2 { vec![chosen] } else { names.collect() };
            for chosen in each {
                let layers = layer::of_layers(path, chosen, &args.running.work)?;
                infos.extend(layers.into_iter().map(|layer| Contents::Layer(Box::new(layer))));
            }
        } else if args.layer.is_some() {
            let message = format!("--layer: {name} holds a model, which has no layers");
            return Err(Failure::Usage(message));
        } else {
            // The model's part of the budget is released with it.
            let options = input::read_options(&args.reading, &args.running.work.part());
            let name = input::given_name(path);
            let info = match input::in_pieces(path, &options) {
                Some(pieces) => of_pieces(name, &mut pieces?)?,
                None => of_model(name, &input::read(path, &options)?, &args.running.work)?,
            };
            infos.push(Contents::Model(Box::new(info)));
        }
        messages.progress.advance();
    }
    Ok(())
}

/// Returns the files of map data in an archive, or nothing for a file of map data; `None` for a model. A file is known by
/// its first bytes, or else by its name; an archive by the names in it, and on standard input as a model.
fn maps(path: &Path) -> Option<Vec<String>> {
    let head = head(path)?;
    let head = &head[..];
    if head.starts_with(archive::MAGIC) {
        if is_stream(path) {
            return None;
        }
        let names = File::open(path).ok().and_then(|file| archive::names(file).ok())?;
        let has_model = names.iter().any(|name| is_name_of_model(name));
        let maps = layer::packed_names(path);
        return (!maps.is_empty() && !has_model).then_some(maps);
    }
    let lower = head.get(..2).unwrap_or_default().to_ascii_lowercase();
    // Rows that begin with x are points of a model, as other columns beside them say, and so are rows of numbers.
    let is_cloud = ModelFormat::of_name(&path.to_string_lossy()) == Some(ModelFormat::Xyz)
        && (lower.starts_with(b"x") || xyz::sniff(head));
    // Broken glTF is JSON like map data; the name tells.
    let named = ModelFormat::of_name(&path.to_string_lossy()).filter(|f| *f != ModelFormat::Xyz);
    let is_model = ModelFormat::of_content(head).or(named).is_some() || is_cloud;
    (!is_model && layer::format_of(path, head).is_some()).then(Vec::new)
}

/// Returns the first bytes of a file, decompressed if they are gzip; those of standard input stay to be read.
fn head(path: &Path) -> Option<Vec<u8>> {
    if is_stream(path) {
        return std::io::stdin().lock().fill_buf().ok().map(<[u8]>::to_vec);
    }
    layer::bytes(path).ok()?.fill_buf().ok().map(<[u8]>::to_vec)
}

fn of_model(name: String, model: &Model, work: &Work) -> Result<Info, Failure> {
    let scene = &model.scene;
    let count = |wanted| {
        let of = |i: &Instance| scene.meshes.get(i.mesh).filter(|m| m.topology == wanted);
        scene.instances.iter().filter_map(of).map(|m| m.primitive_count() as u64).sum()
    };
    let mut warnings: Vec<String> = model.warnings.iter().map(ToString::to_string).collect();
    let closed = closed(scene, work).unwrap_or_else(|e| {
        warnings.push(format!("whether it is closed is not checked: {e}"));
        None
    });
    let orientation = orientation(scene, work).unwrap_or_else(|e| {
        warnings.push(format!("whether faces are turned inwards is not checked: {e}"));
        None
    });
    work.check().map_err(|e| Failure::Data(format!("{name}: {e}")))?;
    Ok(Info {
        model: name,
        format: model.format.clone(),
        triangles: scene.triangle_count(),
        vertices: scene.meshes.iter().map(|m| m.positions.len() as u64).sum(),
        lines: count(durer::scene::Topology::Lines),
        points: count(durer::scene::Topology::Points),
        meshes: scene.meshes.len(),
        instances: scene.instances.len(),
        bounds: scene.bounds().map(reported_bounds),
        area: area(scene),
        closed,
        inside_out: orientation.as_ref().map(|o| o.inside_out),
        flipped: orientation.as_ref().map(|o| o.flipped),
        all_inside_out: orientation.is_some_and(|o| o.inside_out == o.closed),
        up_axis: scene.up_axis.name(),
        materials: scene.materials.iter().map(material).collect(),
        textures: textures(scene),
        cameras: scene.cameras.iter().map(|c| short(&c.name)).collect(),
        lights: scene.lights.iter().map(|l| light(&l.kind)).collect(),
        animations: model.animations.iter().map(short).collect(),
        variants: model.variants.iter().map(short).collect(),
        scenes: model.scenes.iter().map(short).collect(),
        plates: model.plates.iter().map(short).collect(),
        extensions: model.extensions.iter().map(short).collect(),
        warnings,
    })
}

/// Returns the report on a model that is larger than its budget.
fn of_pieces(name: String, read: &mut InPieces) -> Result<Info, Failure> {
    let bounds = read.pieces.bounds().map_err(|e| read.failure(&e))?;
    let (mut area, facts) = (0.0, read.facts()?);
    if facts.triangles > 0 {
        let passed = read.pieces.primitives(&mut |piece| {
            add_areas(piece, &mut area);
            Ok(())
        });
        passed.map_err(|e| read.failure(&e))?;
    }
    let Facts { mut model, triangles, points, vertices } = facts;
    let why = "whether it is closed is not checked: it is larger than the memory budget and read in pieces";
    if triangles > 0 {
        model.warn(Place::Whole, why);
    }
    Ok(Info {
        model: name,
        format: model.format.clone(),
        triangles,
        vertices,
        lines: 0,
        points,
        meshes: 1,
        instances: 1,
        bounds: bounds.map(reported_bounds),
        area: (triangles > 0).then_some(area),
        closed: None,
        inside_out: None,
        flipped: None,
        all_inside_out: false,
        up_axis: model.scene.up_axis.name(),
        materials: model.scene.materials.iter().map(material).collect(),
        textures: Vec::new(),
        cameras: Vec::new(),
        lights: Vec::new(),
        animations: Vec::new(),
        variants: Vec::new(),
        scenes: Vec::new(),
        plates: Vec::new(),
        extensions: Vec::new(),
        warnings: model.warnings.iter().map(ToString::to_string).collect(),
    })
}

/// Adds the areas of a scene's triangles, one by one.
fn add_areas(scene: &Scene, sum: &mut f64) {
    for instance in &scene.instances {
        let Some(mesh) = scene.meshes.get(instance.mesh) else { continue };
        let areas = areas(mesh, instance);
        areas.for_each(|area| *sum += area);
    }
}

/// Returns a name of the file, not too long.
fn short(name: impl AsRef<str>) -> String {
    cut(name.as_ref()).into_owned()
}

fn reported_bounds(b: Aabb) -> Bounds {
    Bounds { min: b.min.to_array(), max: b.max.to_array(), size: b.size().to_array() }
}

/// Returns the sum of the triangles' areas, instance by instance.
fn area(scene: &Scene) -> Option<f64> {
    let of_instance = |instance: &Instance| {
        let mesh = scene.meshes.get(instance.mesh)?;
        Some(areas(mesh, instance).sum::<f64>())
    };
    // An empty sum is -0.
    let sum = scene.instances.iter().filter_map(of_instance).sum::<f64>() + 0.0;
    (scene.triangle_count() > 0).then_some(sum)
}

/// Returns the finite areas of an instance's triangles.
fn areas(mesh: &Mesh, instance: &Instance) -> impl Iterator<Item = f64> {
    let corner = |v: u32| {
        let p = mesh.positions.get(v as usize).copied().unwrap_or_default();
        instance.world_from_mesh.transform_point3(p.as_dvec3())
    };
    let area = move |i| triangle_area(mesh.triangle(i).map(corner)).length();
    (0..mesh.triangle_count()).map(area).filter(|area| area.is_finite())
}

/// Returns whether all visible meshes of triangles are closed, each or together; `None` if it was
/// not examined.
fn closed(scene: &Scene, work: &Work) -> durer::Result<Option<bool>> {
    let mut shown = vec![false; scene.meshes.len()];
    for instance in &scene.instances {
        if let Some(shown) = shown.get_mut(instance.mesh) {
            *shown = true;
        }
    }
    let meshes = scene.meshes.iter().zip(shown);
    let solid = meshes.filter(|(mesh, shown)| mesh.triangle_count() > 0 && *shown);
    let (mut each, mut count, mut area) = (true, 0_usize, 0.0);
    for (mesh, _) in solid {
        let (triangles, vertices) = (mesh.triangle_count() as u64, mesh.positions.len() as u64);
        let _edges = work.charge("edges of the model", 36 * triangles + 16 * vertices)?;
        let found = written_topology(mesh, scene.last_digit);
        each &= found.closed;
        area += found.area;
        count += 1;
    }
    if count == 0 || each || area == 0.0 {
        // Without an area, they bound nothing.
        return Ok((count > 0).then_some(area > 0.0));
    }
    closed_together(scene, work).map(Some)
}

/// Largest number of triangles of meshes that are examined together: more would take more memory than a picture of
/// them.
const MOST_TOGETHER: u64 = 1 << 20;

/// Returns the orientation of all faces; `None` if there are none, or more than are examined together.
fn orientation(scene: &Scene, work: &Work) -> durer::Result<Option<SceneOrientation>> {
    let triangles = scene.triangle_count();
    if triangles == 0 || triangles > MOST_TOGETHER {
        return Ok(None);
    }
    let _faces = work.charge("edges of the model", 160 * triangles)?;
    SceneOrientation::of(scene).map(Some)
}

/// Returns whether the meshes together bound bodies, as in files with a mesh for each face; borders that run along each
/// other are joined.
fn closed_together(scene: &Scene, work: &Work) -> durer::Result<bool> {
    let value = scene.triangle_count();
    if value > MOST_TOGETHER {
        let what = "number of triangles whose borders are compared";
        return Err(durer::Error::Limit { what, value, limit: MOST_TOGETHER });
    }
    let _faces = work.charge("edges of the model", 150 * value)?;
    let faces = Faces::new(scene)?;
    let edges = Edges::new(&faces, |_| true);
    Ok(edges.iter().all(|(_, sides)| sides.len() == 2))
}

fn material(material: &Material) -> MaterialInfo {
    let model = match material.model {
        ShadingModel::MetallicRoughness => "metallic-roughness",
        ShadingModel::Phong => "phong",
        ShadingModel::Unlit => "unlit",
    };
    MaterialInfo { name: short(&material.name), model, textures: material.textures().count() }
}

fn textures(scene: &Scene) -> Vec<TextureInfo> {
    let images = scene.textures.iter().filter_map(|t| scene.images.get(t.image));
    // Those that nothing shows, or that could not be read, are empty.
    let read = images.filter(|i| !i.data.is_empty());
    read.map(|i| TextureInfo { name: short(&i.name), width: i.width, height: i.height }).collect()
}

fn light(kind: &LightKind) -> &'static str {
    match kind {
        LightKind::Ambient => "ambient",
        LightKind::Directional { .. } => "directional",
        LightKind::Point { .. } => "point",
        LightKind::Spot { .. } => "spot",
    }
}

impl Info {
    /// Returns a line for each fact; facts that are nothing are left out.
    fn text(&self) -> String {
        let mut lines = vec![
            ("format", self.format.clone()),
            ("triangles", self.triangles.to_string()),
            ("vertices", self.vertices.to_string()),
        ];
        let mut some = |name, count: u64| {
            if count > 0 {
                lines.push((name, count.to_string()));
            }
        };
        some("lines", self.lines);
        some("points", self.points);
        some("meshes", self.meshes as u64);
        some("instances", self.instances as u64);
        if let Some(Bounds { min, max, size }) = &self.bounds {
            lines.push(("bounds", format!("{} … {}", triple(min), triple(max))));
            lines.push(("size", triple(size)));
        }
        if let Some(area) = self.area {
            lines.push(("area", (area as f32).to_string()));
        }
        if let Some(closed) = self.closed {
            lines.push(("closed", if closed { "yes" } else { "no" }.to_owned()));
        }
        let counted = |count: Option<u64>, one: &str, several: &str| {
            count.filter(|&count| count > 0).map(|count| counted(count, one, several))
        };
        let inside_out = counted(self.inside_out, "body inside out", "bodies inside out");
        let inside_out =
            inside_out.map(|some| if self.all_inside_out { "inside out".to_owned() } else { some });
        let flipped = counted(self.flipped, "face flipped", "faces flipped");
        let wrong: Vec<String> = inside_out.into_iter().chain(flipped).collect();
        if !wrong.is_empty() {
            lines.push(("faces", wrong.join(", ")));
        }
        lines.push(("up axis", self.up_axis.to_owned()));
        let mut list = |name, items: Vec<String>| {
            if !items.is_empty() {
                lines.push((name, items.join(", ")));
            }
        };
        let unnamed =
            |name: &String| if name.is_empty() { "(no name)".to_owned() } else { name.clone() };
        list(
            "materials",
            self.materials.iter().map(|m| format!("{} [{}]", unnamed(&m.name), m.model)).collect(),
        );
        list(
            "textures",
            self.textures
                .iter()
                .map(|t| format!("{} {}x{}", unnamed(&t.name), t.width, t.height))
                .collect(),
        );
        list("cameras", self.cameras.clone());
        list("lights", self.lights.iter().map(ToString::to_string).collect());
        list("animations", self.animations.iter().map(unnamed).collect());
        list("variants", self.variants.iter().map(unnamed).collect());
        if self.scenes.len() > 1 {
            list("scenes", self.scenes.iter().map(unnamed).collect());
        }
        let numbered =
            |(i, name): (usize, &String)| format!("{} {name}", i + 1).trim_end().to_owned();
        list("plates", self.plates.iter().enumerate().map(numbered).collect());
        list("extensions", self.extensions.clone());
        lines.extend(self.warnings.iter().map(|w| ("warning", w.clone())));
        let mut text = format!("{}\n", escaped(&self.model));
        for (name, value) in lines {
            // Writing to a string cannot fail.
            let _ = writeln!(text, "  {name:<11} {}", escaped(&value));
        }
        text
    }
}

/// Formats with as many digits as coordinates of single precision have.
fn triple(v: &[f64; 3]) -> String {
    let [x, y, z] = v.map(|c| c as f32);
    format!("({x}, {y}, {z})")
}
