//! The contents of the files, placed on the map and with numbered properties.

use super::args::TilesArgs;
use crate::failure::Failure;
use crate::input::display_name;
use crate::layer::{Fields, Shift, SystemArgs, keep, late, none_meets, open, packed_names, words};
use crate::messages::Messages;
use crate::names;
use crate::options::TileCoordinates;
use crate::places::is_stream;
use durer::clip::tiles::{self, PlacedGeometry};
use durer::parallel;
use durer_formats::geo::crs::Crs;
use durer_formats::geo::{Feature, GeoFormat, System};
use durer_formats::tiles::{Dictionary, Field, LayerInfo, Value};
use durer_formats::wording::counted;
use durer_formats::{Place, Warning};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

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
    pub features: Vec<tiles::TileFeature>,
    /// The row of each of them.
    pub row_of: Vec<usize>,
    /// Features read.
    pub read: u64,
    /// Repairs and omissions.
    pub warnings: Vec<String>,
    /// Features that cannot be read and are left out.
    pub skipped: u64,
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

    fn warning(&self, one: &str, several: &str) -> Option<String> {
        let Self { count, first } = self;
        match count {
            0 => None,
            1 => Some(format!("feature {first} {one}")),
            _ => Some(format!("{count} features (the first is feature {first}) {several}")),
        }
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

/// Features that are placed at a time.
const BATCH: usize = 4096;

/// Reads all files.
pub fn read(args: &TilesArgs, messages: &Messages) -> Result<Layers, Failure> {
    let mut all = Layers::default();
    let names = layer_names(args)?;
    let mut fields = Fields::new(&args.fields);
    for (path, name) in args.inputs.iter().zip(names) {
        let files = packed_names(path);
        if files.len() < 2 {
            let whole = Part { name, ..Part::default() };
            read_file(&mut all, path, &whole, &mut fields, (args, messages))?;
            continue;
        }
        for file in &files {
            let name = part_name(args, &name, names::stem(Path::new(file)));
            let part = Part { name, file: Some(file), layer: None };
            read_file(&mut all, path, &part, &mut fields, (args, messages))?;
        }
    }
    if let Some(message) = fields.warning() {
        let names: Vec<String> = args.inputs.iter().map(|path| display_name(path)).collect();
        warn(message, &names.join(", "), messages, &mut all.warnings);
    }
    Ok(all)
}

/// Part of a file that becomes a layer.
#[derive(Debug, Default)]
struct Part<'a> {
    /// The name of the layer of the tiles.
    name: String,
    /// The file, of an archive with several.
    file: Option<&'a str>,
    /// The layer, of a file with several.
    layer: Option<&'a str>,
}

impl Part<'_> {
    /// Returns the part as `--layer` of other commands names it.
    fn choice(&self) -> Option<String> {
        match (self.file, self.layer) {
            (Some(file), Some(layer)) => Some(format!("{file}/{layer}")),
            (one, other) => one.or(other).map(str::to_owned),
        }
    }
}

/// Returns the name of the layer of a part of a file: the name given for the file, or that of the part.
fn part_name(args: &TilesArgs, of_file: &str, of_part: String) -> String {
    if args.layer.is_empty() { of_part } else { of_file.to_owned() }
}

/// Reads a file, or a part of one, into a layer; each layer of the file into its own.
fn read_file(
    all: &mut Layers,
    path: &Path,
    part: &Part<'_>,
    fields: &mut Fields,
    (args, messages): (&TilesArgs, &Messages),
) -> Result<(), Failure> {
    let shown = display_name(path);
    let fail = |e| Failure::Data(format!("{shown}: {}", words(&e)));
    let (from, mut reader) = open(path, args.from, part.choice().as_deref(), &args.running.work)?;
    if args.fields.skip_failures {
        reader.skip_failures();
    }
    let layers = reader.layers();
    if layers.len() > 1 && !is_stream(path) {
        drop(reader);
        return layers.iter().try_for_each(|layer| {
            let name = part_name(args, &part.name, layer.clone());
            let part = Part { name, layer: Some(layer), ..*part };
            read_file(all, path, &part, fields, (args, messages))
        });
    }
    let layer = all.layers.iter().position(|layer| layer.name == part.name).unwrap_or_else(|| {
        all.layers.push(Layer { name: part.name.clone(), ..Layer::default() });
        all.layers.len() - 1
    });
    if from == GeoFormat::Svg {
        return Err(Failure::Data(format!("{shown}: an SVG has no places on the earth")));
    }
    let (mut doubts, before, mut kept) = (Doubts::default(), all.read, 0);
    let mut placing = Placing::new(args);
    loop {
        let mut features = Vec::new();
        while features.len() < BATCH {
            let Some(mut feature) = reader.next_feature().map_err(fail)? else { break };
            all.read += 1;
            if fields.apply(&mut feature) {
                placing.convert(&mut feature, || reader.system()).map_err(|why| {
                    Failure::Data(format!(
                        "{shown}: {why}; --from-crs says what its coordinates are"
                    ))
                })?;
                keep(&feature, &args.running.work).map_err(|e| fail(e.into()))?;
                features.push((all.read - before, feature));
            }
        }
        if features.is_empty() {
            break;
        }
        kept += features.len();
        let coordinates = placing.coordinates;
        let place = |(_, f): &(u64, Feature)| match &f.geometry {
            Some(geometry) => tiles::place(geometry, coordinates, args.short_way),
            None => PlacedGeometry::default(),
        };
        let placed = parallel::of_each(&features, place);
        for ((number, feature), placed) in features.iter().zip(placed) {
            all.add(args, layer, feature, placed, *number, &mut doubts);
        }
        messages.progress.stage(|| format!("{} features", all.read));
    }
    let stated = placing.stated.as_ref().filter(|_| placing.shift.is_some() && !placing.is_given);
    if let Some((why, option)) = late(stated, &reader) {
        return Err(Failure::Data(format!("{shown}: {why}; {option} sets their system")));
    }
    let mut warnings = reader.warnings().to_vec();
    if layers.len() > 1 {
        // The hint at --layer is for other commands.
        let note = format!(
            "its {} layers become one; read from a file, each becomes a layer",
            layers.len()
        );
        warnings
            .iter_mut()
            .filter(|warning| reader.is_note(warning))
            .for_each(|w| w.message.clone_from(&note));
    }
    let lost = placing.shift.as_ref().and_then(Shift::warning);
    warnings.extend(lost.map(|message| Warning { place: Place::Whole, message }));
    messages.warnings(&shown, &warnings);
    all.skipped += reader.skipped();
    all.warnings.extend(warnings.iter().map(|warning| format!("{shown}: {warning}")));
    let none = match (all.read == before, kept) {
        (true, _) => Some("there is no feature in it".to_owned()),
        (false, 0) => Some(none_meets(all.read - before)),
        _ => None,
    };
    for message in none.into_iter().chain(doubts.messages()) {
        warn(message, &shown, messages, &mut all.warnings);
    }
    Ok(())
}

/// Way of a file's coordinates to those of tiles.
struct Placing {
    coordinates: tiles::Coordinates,
    /// The conversion to longitudes and latitudes, unless an option says what the coordinates are.
    shift: Option<Shift>,
    /// The system that the file states, from the first feature on.
    stated: Option<System>,
    /// True if --from-crs gives the system of all features.
    is_given: bool,
}

impl Placing {
    fn new(args: &TilesArgs) -> Self {
        let lonlat = Crs::of_system(&System::LONLAT).ok();
        let from_crs = args.from_crs.clone();
        let direct = match from_crs.as_ref().and_then(Crs::code) {
            Some(MERCATOR) => Some(TileCoordinates::Mercator),
            Some(4326) => Some(TileCoordinates::Lonlat),
            _ => args.coordinates,
        };
        let is_given = from_crs.is_some();
        let systems = SystemArgs { from_crs, to_crs: lonlat };
        let shift = Shift::new(&systems).filter(|_| direct.is_none());
        let coordinates = direct.unwrap_or(TileCoordinates::Lonlat).into();
        Self { coordinates, shift, stated: None, is_given }
    }

    /// Converts a feature to longitudes and latitudes if its file or itself states another system.
    ///
    /// # Errors
    /// The reason why the system is not known.
    fn convert(
        &mut self,
        feature: &mut Feature,
        system: impl Fn() -> System,
    ) -> Result<(), String> {
        let Some(shift) = &mut self.shift else { return Ok(()) };
        if self.is_given {
            if !shift.apply(feature).map_err(|failure| failure.to_string())? {
                feature.geometry = None;
            }
            return Ok(());
        }
        let stated = self.stated.get_or_insert_with(|| {
            let stated = system();
            shift.begin(stated.clone());
            if stated.code == Some(MERCATOR) {
                self.coordinates = tiles::Coordinates::Mercator;
            }
            stated
        });
        let is_other = feature.srid.is_some() && feature.srid != stated.code;
        let is_direct =
            *stated == System::LONLAT || stated.code == Some(MERCATOR) || stated.is_unknown();
        if is_direct && !is_other {
            return Ok(());
        }
        let own = if is_other { feature.srid.map(System::of_code) } else { None };
        Crs::of_system(own.as_ref().unwrap_or(stated))?;
        if is_other && self.coordinates == tiles::Coordinates::Mercator {
            return Err("its features are in several coordinate systems".to_owned());
        }
        if !shift.apply(feature).map_err(|failure| failure.to_string())? {
            feature.geometry = None;
        }
        Ok(())
    }
}

/// Number of Web Mercator.
const MERCATOR: i32 = 3857;

/// Prints a warning now and adds it to the report.
fn warn(message: String, name: &str, messages: &Messages, warnings: &mut Vec<String>) {
    messages.warning(name, &message);
    warnings.push(format!("{name}: {message}"));
}

/// Returns the layer of each file.
fn layer_names(args: &TilesArgs) -> Result<Vec<String>, Failure> {
    match (args.layer.len(), args.inputs.len()) {
        (0, _) => Ok(stems(&args.inputs)),
        (1, count) => Ok(vec![args.layer[0].clone(); count]),
        (names, count) if names == count => Ok(args.layer.clone()),
        (names, count) => {
            let (names, files) =
                (counted(names as u64, "name", "names"), counted(count as u64, "file", "files"));
            let message = format!("--layer: {names} for {files}; give one for each, or one");
            Err(Failure::Usage(message))
        }
    }
}

/// Returns the names of the files without folder and suffix; where several are the same, with the suffix, then with a
/// number.
fn stems(inputs: &[PathBuf]) -> Vec<String> {
    let stems: Vec<String> = inputs.iter().map(|input| names::stem(input)).collect();
    let mut counts = BTreeMap::new();
    stems.iter().for_each(|stem| *counts.entry(stem).or_insert(0) += 1);
    let mut taken = BTreeSet::new();
    // By the name, the number to try next: many may share one.
    let mut numbers = BTreeMap::new();
    let mut result = Vec::new();
    for (input, stem) in inputs.iter().zip(&stems) {
        let base = if counts[stem] > 1 { names::expand("{name}", input) } else { stem.clone() };
        let number = numbers.entry(base.clone()).or_insert(2);
        let mut name = base.clone();
        while !taken.insert(name.clone()) {
            name = format!("{base}-{number}");
            *number += 1;
        }
        result.push(name);
    }
    result
}

impl Doubts {
    fn messages(&self) -> Vec<String> {
        let found = [
            self.far.warning(
                "lies more than four worlds beyond 180 degrees; left out",
                "lie more than four worlds beyond 180 degrees; left out",
            ),
            self.latitudes.warning(
                "has latitudes beyond 90 degrees; are longitude and latitude in the wrong order, or --coordinates?",
                "have latitudes beyond 90 degrees; are longitude and latitude in the wrong order, or --coordinates?",
            ),
            self.poles.warning(
                "goes around a pole; it is closed along it",
                "go around a pole; they are closed along it",
            ),
            self.long.warning(
                "has an edge of more than 180 degrees, which goes around the world; --short-way lets it cross the date line",
                "have edges of more than 180 degrees, which go around the world; --short-way lets them cross the date line",
            ),
            self.ids.warning(
                "has an id that is not a whole number; vector tiles know no others, left out",
                "have ids that are not whole numbers; vector tiles know no others, left out",
            ),
            self.no_geometry.warning("has no geometry; left out", "have no geometry; left out"),
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
        placed: PlacedGeometry,
        number: u64,
        doubts: &mut Doubts,
    ) {
        let id = feature.id.as_deref().and_then(whole_number);
        doubts.ids.add(feature.id.is_some() && id.is_none(), number);
        doubts.far.add(placed.far, number);
        doubts.latitudes.add(placed.latitude, number);
        doubts.poles.add(placed.pole, number);
        doubts.long.add(placed.long, number);
        doubts.no_geometry.add(placed.bodies.is_empty() && !placed.far, number);
        if placed.bodies.is_empty() {
            return;
        }
        let properties = self.layers[layer].properties(args, feature.properties.as_deref());
        self.rows.push(Row { layer, id, properties });
        for body in placed.bodies {
            self.features.push(tiles::TileFeature { layer, body, fill: feature.fill_rule });
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
    /// Returns the properties by their numbers; properties without a value are left out, and structured values become
    /// JSON.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn layers_differ_where_names_of_files_do_not() {
        let of = |paths: &[&str]| stems(&paths.iter().map(PathBuf::from).collect::<Vec<_>>());
        assert_eq!(of(&["x/a.geojson", "b.wkt"]), ["a", "b"]);
        assert_eq!(of(&["a.wkt", "a.wkb", "-"]), ["a.wkt", "a.wkb", "stdin"]);
        assert_eq!(of(&["x/a.wkt", "y/a.wkt"]), ["a.wkt", "a.wkt-2"]);
    }
}
