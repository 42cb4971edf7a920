//! The contents of the files, projected and with numbered properties.

use super::args::TilesArgs;
use crate::clip::TileCoordinates;
use crate::failure::Failure;
use crate::input::display_name;
use crate::layer::{Fields, keep, open, words};
use crate::messages::Messages;
use crate::output;
use durer::clip::polygon::Shapes;
use durer::clip::tiles::{self, Body, mercator};
use durer::math::DVec2;
use durer_formats::geo::{Feature, GeoFormat, Geometry, Points};
use durer_formats::tiles::{Dictionary, Field, LayerInfo, Value};
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::path::Path;

/// A layer.
#[derive(Debug, Default)]
pub struct Layer {
    pub name: String,
    pub dictionary: Dictionary,
    fields: BTreeMap<String, Field>,
}

/// Properties of a feature beside its geometry.
#[derive(Debug, Default)]
pub struct Row {
    pub layer: usize,
    pub id: Option<u64>,
    /// Names and values by their numbers in the layer's dictionary.
    pub properties: Vec<(u32, u32)>,
}

/// All layers.
#[derive(Debug, Default)]
pub struct Layers {
    pub layers: Vec<Layer>,
    pub rows: Vec<Row>,
    /// Geometries of one kind, in the order of the rows.
    pub features: Vec<tiles::Feature>,
    /// The row of each of them.
    pub row_of: Vec<usize>,
    /// Features read.
    pub read: u64,
    /// Repairs and omissions.
    pub warnings: Vec<String>,
}

/// Number of occurrences, and the first of them.
#[derive(Debug, Default)]
struct Found {
    count: u64,
    first: u64,
}

impl Found {
    fn add(&mut self, found: bool, feature: u64) {
        if found && self.count == 0 {
            self.first = feature;
        }
        self.count += u64::from(found);
    }

    fn told(&self, what: &str) -> Option<String> {
        let Self { count, first } = self;
        (*count > 0).then(|| format!("{count} features (the first is feature {first}) {what}"))
    }
}

/// Warnings about a file.
#[derive(Debug, Default)]
struct Doubts {
    far: Found,
    latitudes: Found,
    poles: Found,
    long: Found,
    ids: Found,
    no_geometry: Found,
}

/// A feature's geometry by kinds, and what is odd about it.
#[derive(Debug, Default)]
struct Projected {
    bodies: Vec<Body>,
    /// Beyond all worlds.
    far: bool,
    /// A latitude beyond ±90°.
    latitude: bool,
    /// Goes around a pole.
    pole: bool,
    /// Has an edge around more than half of the world.
    long: bool,
}

/// Features that are projected at a time.
const BATCH: usize = 4096;

/// Reads all files.
pub fn read(args: &TilesArgs, messages: &Messages) -> Result<Layers, Failure> {
    let mut all = Layers::default();
    let names = names(args)?;
    let mut fields = Fields::new(&args.fields);
    for (path, name) in args.inputs.iter().zip(names) {
        let layer = all.layers.iter().position(|layer| layer.name == name).unwrap_or_else(|| {
            all.layers.push(Layer { name, ..Layer::default() });
            all.layers.len() - 1
        });
        read_file(&mut all, path, layer, &mut fields, (args, messages))?;
    }
    if let Some(message) = fields.told() {
        let names: Vec<String> = args.inputs.iter().map(|path| display_name(path)).collect();
        tell(message, &names.join(", "), messages, &mut all.warnings);
    }
    Ok(all)
}

/// Reads a file into a layer.
fn read_file(
    all: &mut Layers,
    path: &Path,
    layer: usize,
    fields: &mut Fields,
    (args, messages): (&TilesArgs, &Messages),
) -> Result<(), Failure> {
    let shown = display_name(path);
    let fail = |e| Failure::Data(format!("{shown}: {}", words(&e)));
    let (from, mut reader) = open(path, args.from, None, &args.running.work)?;
    if from == GeoFormat::Svg {
        return Err(Failure::Data(format!("{shown}: an SVG has no places on the earth")));
    }
    let (mut doubts, before, mut kept) = (Doubts::default(), all.read, 0);
    loop {
        let mut features = Vec::new();
        while features.len() < BATCH {
            let Some(mut feature) = reader.next_feature().map_err(fail)? else { break };
            all.read += 1;
            if fields.apply(&mut feature) {
                keep(&feature, &args.running.work).map_err(|e| fail(e.into()))?;
                features.push((all.read - before, feature));
            }
        }
        if features.is_empty() {
            break;
        }
        kept += features.len();
        let project = |(_, f): &(u64, Feature)| project(f.geometry.as_ref(), args);
        let projected: Vec<_> = features.par_iter().map(project).collect();
        for ((number, feature), projected) in features.iter().zip(projected) {
            all.add(args, layer, feature, projected, *number, &mut doubts);
        }
        messages.progress.stage(|| format!("{} features", all.read));
    }
    messages.warnings(&shown, reader.warnings());
    all.warnings.extend(reader.warnings().iter().map(|warning| format!("{shown}: {warning}")));
    let none = match (all.read == before, kept) {
        (true, _) => Some("there is no feature in it".to_owned()),
        (false, 0) => {
            Some(format!("none of its {} features is as --where asks", all.read - before))
        }
        _ => None,
    };
    for message in none.into_iter().chain(doubts.messages()) {
        tell(message, &shown, messages, &mut all.warnings);
    }
    Ok(())
}

/// Tells a warning now and in the report.
fn tell(message: String, name: &str, messages: &Messages, warnings: &mut Vec<String>) {
    messages.warning(name, &message);
    warnings.push(format!("{name}: {message}"));
}

/// Returns the layer of each file.
fn names(args: &TilesArgs) -> Result<Vec<String>, Failure> {
    match (args.layer.len(), args.inputs.len()) {
        (0, _) => Ok(output::stems(&args.inputs)),
        (1, count) => Ok(vec![args.layer[0].clone(); count]),
        (names, count) if names == count => Ok(args.layer.clone()),
        (names, count) => {
            let message =
                format!("--layer: {names} names for {count} files; give one for each, or one");
            Err(Failure::Usage(message))
        }
    }
}

impl Doubts {
    fn messages(&self) -> Vec<String> {
        let found = [
            self.far.told("lie more than four worlds beyond 180 degrees; left out"),
            self.latitudes.told(
                "have latitudes beyond 90 degrees; are longitude and latitude in the wrong order, or --coordinates?",
            ),
            self.poles.told("go around a pole; they are closed along it"),
            self.long.told(
                "have edges of more than 180 degrees, which go around the world; --short-way lets them cross the date line",
            ),
            self.ids.told("have ids that are no whole numbers; vector tiles know no others, left out"),
            self.no_geometry.told("have no geometry; left out"),
        ];
        found.into_iter().flatten().collect()
    }
}

impl Layers {
    fn add(
        &mut self,
        args: &TilesArgs,
        layer: usize,
        feature: &Feature,
        projected: Projected,
        number: u64,
        doubts: &mut Doubts,
    ) {
        let id = feature.id.as_deref().and_then(whole_number);
        doubts.ids.add(feature.id.is_some() && id.is_none(), number);
        doubts.far.add(projected.far, number);
        doubts.latitudes.add(projected.latitude, number);
        doubts.poles.add(projected.pole, number);
        doubts.long.add(projected.long, number);
        doubts.no_geometry.add(projected.bodies.is_empty() && !projected.far, number);
        if projected.bodies.is_empty() {
            return;
        }
        let properties = self.layers[layer].properties(args, feature.properties.as_deref());
        self.rows.push(Row { layer, id, properties });
        for body in projected.bodies {
            self.features.push(tiles::Feature { layer, body, fill: feature.fill_rule });
            self.row_of.push(self.rows.len() - 1);
        }
    }

    /// Returns the descriptions of layers in the map's metadata.
    pub fn infos(&self) -> Vec<LayerInfo> {
        let fields = |layer: &Layer| layer.fields.iter().map(|(n, f)| (n.clone(), *f)).collect();
        let info = |layer: &Layer| LayerInfo { name: layer.name.clone(), fields: fields(layer) };
        self.layers.iter().map(info).collect()
    }
}

impl Layer {
    /// Returns the properties by their numbers; those without a value are left out, and what has parts
    /// becomes JSON.
    fn properties(&mut self, args: &TilesArgs, json: Option<&str>) -> Vec<(u32, u32)> {
        let object = json.and_then(|json| serde_json::from_str(json).ok());
        let Some(serde_json::Value::Object(object)) = object else { return Vec::new() };
        let mut properties = Vec::new();
        for (name, value) in object {
            if args.exclude.contains(&name) {
                continue;
            }
            let Some((value, field)) = typed(value) else { continue };
            let kept = self.fields.entry(name.clone()).or_insert(field);
            if *kept != field {
                *kept = Field::Text;
            }
            properties.push((self.dictionary.name(&name), self.dictionary.value(value)));
        }
        properties
    }
}

fn typed(value: serde_json::Value) -> Option<(Value, Field)> {
    use serde_json::Value as Json;
    Some(match value {
        Json::Null => return None,
        Json::Bool(value) => (Value::Bool(value), Field::Bool),
        Json::Number(number) => {
            let value = match (number.as_u64(), number.as_i64()) {
                (Some(value), _) => Value::Unsigned(value),
                (_, Some(value)) => Value::Signed(value),
                _ => Value::Number(number.as_f64()?),
            };
            (value, Field::Number)
        }
        Json::String(text) => (Value::Text(text), Field::Text),
        other => (Value::Text(other.to_string()), Field::Text),
    })
}

/// Returns an id that vector tiles can have: a whole number, or text that is one.
fn whole_number(json: &str) -> Option<u64> {
    let text = json.strip_prefix('"').and_then(|text| text.strip_suffix('"')).unwrap_or(json);
    text.parse().ok().filter(|number: &u64| number.to_string() == text)
}

/// The parts of a geometry by kinds.
#[derive(Default)]
struct Parts {
    points: Vec<DVec2>,
    lines: Vec<DVec2>,
    ends: Vec<usize>,
    areas: Shapes,
}

fn project(geometry: Option<&Geometry>, args: &TilesArgs) -> Projected {
    let (mut parts, mut projected) = (Parts::default(), Projected::default());
    if let Some(geometry) = geometry {
        parts.add(geometry, args, &mut projected);
    }
    let Parts { points, lines, ends, areas } = parts;
    let bodies = [Body::Areas(areas), Body::Lines { points: lines, ends }, Body::Points(points)];
    for body in bodies {
        let near = |p: &DVec2| p.x.abs().max(p.y.abs()) < tiles::WORLDS;
        projected.far |= !body.points().iter().all(near);
        if !body.points().is_empty() {
            projected.bodies.push(body);
        }
    }
    if projected.far {
        projected.bodies.clear();
    }
    projected
}

impl Parts {
    fn add(&mut self, geometry: &Geometry, args: &TilesArgs, doubts: &mut Projected) {
        match geometry {
            Geometry::Point(points) | Geometry::MultiPoint(points) => {
                self.points.extend(run(points, false, args, doubts));
            }
            Geometry::LineString(line) => self.add_line(line, args, doubts),
            Geometry::MultiLineString(lines) => {
                lines.iter().for_each(|line| self.add_line(line, args, doubts));
            }
            Geometry::Polygon(rings) => self.add_polygon(rings, args, doubts),
            Geometry::MultiPolygon(polygons) => {
                polygons.iter().for_each(|rings| self.add_polygon(rings, args, doubts));
            }
            Geometry::Collection(parts) => {
                parts.iter().for_each(|part| self.add(part, args, doubts));
            }
        }
    }

    fn add_line(&mut self, line: &Points, args: &TilesArgs, doubts: &mut Projected) {
        self.lines.extend(run(line, args.short_way, args, doubts));
        self.ends.push(self.lines.len());
    }

    fn add_polygon(&mut self, rings: &[Points], args: &TilesArgs, doubts: &mut Projected) {
        let mut first: Option<f64> = None;
        for ring in rings {
            let mut places = run(ring, args.short_way, args, doubts);
            if let ([first, .., last], false) = (&places[..], args.short_way) {
                doubts.long |= is_long(*last, *first);
            }
            if args.short_way {
                if goes_around(&places) {
                    doubts.pole = true;
                    close_along_pole(&mut places);
                }
                // Holes are where their polygon is.
                let start = places.first().map_or(0.0, |p| p.x);
                let shift = (first.unwrap_or(start) - start).round();
                places.iter_mut().for_each(|p| p.x += shift);
                first = first.or(Some(start));
            }
            self.areas.push_ring(places);
        }
        self.areas.end_polygon();
    }
}

/// Returns whether a ring ends in another world than it begins.
fn goes_around(ring: &[DVec2]) -> bool {
    matches!((ring.first(), ring.last()), (Some(a), Some(b)) if (a.x - b.x).abs() > 0.5)
}

/// Leads a ring that goes around a pole back along it, far beyond the last latitude of the map.
fn close_along_pole(ring: &mut Vec<DVec2>) {
    /// Beyond 0 … 1.
    const POLES: [f64; 2] = [-0.5, 1.5];
    let (Some(&first), Some(&last)) = (ring.first(), ring.last()) else { return };
    let middle = ring.iter().map(|p| p.y).sum::<f64>() / ring.len() as f64;
    let pole = POLES[usize::from(middle > 0.5)];
    let end = first.x + (last.x - first.x).round();
    ring.extend([(end, first.y), (end, pole), (first.x, pole)].map(DVec2::from));
}

/// Returns whether an edge goes around more than half of the world, and not along a pole, where no map shows which way
/// it goes.
fn is_long(from: DVec2, to: DVec2) -> bool {
    let is_on_map = |p: DVec2| (0.0..=1.0).contains(&p.y);
    (to.x - from.x).abs() > 0.5 && (is_on_map(from) || is_on_map(to))
}

/// Returns the places of positions; where it matters, each in the world nearest to the one before.
fn run(points: &Points, short_way: bool, args: &TilesArgs, doubts: &mut Projected) -> Vec<DVec2> {
    let degrees = args.coordinates == TileCoordinates::Lonlat;
    let mut before: Option<DVec2> = None;
    let place = |&p: &DVec2| {
        doubts.latitude |= degrees && p.y.abs() > 90.0;
        let mut place = if degrees { mercator::project(p) } else { mercator::of_metres(p) };
        if let Some(before) = before {
            let across = place.x - before.x;
            if short_way {
                place.x -= across.round();
            } else {
                doubts.long |= is_long(before, place);
            }
        }
        before = Some(place);
        place
    };
    points.xy.iter().map(place).collect()
}
