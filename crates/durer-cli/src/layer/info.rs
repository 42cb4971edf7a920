//! The report of `durer info` on map data.

use super::{Source, open, words};
use crate::failure::Failure;
use crate::input::display_name;
use crate::places::is_stream;
use durer::clip::mask::is_valid;
use durer::math::Rect;
use durer::work::Work;
use durer_formats::geo::crs::Crs;
use durer_formats::geo::{Dimensions, Feature, FieldKind, GeoFormat, Schema, System};
use durer_formats::wording::counted;
use durer_formats::wording::escaped;
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::Path;

/// Report on a layer's contents.
#[derive(Debug, Serialize)]
pub struct LayerInfo {
    layer: String,
    /// Its name, of a file with several.
    #[serde(skip_serializing_if = "Option::is_none")]
    name: Option<String>,
    format: &'static str,
    features: u64,
    /// Number of features by the name of their geometry; `none` counts features without one.
    geometries: BTreeMap<&'static str, u64>,
    /// `xy`, `xyz`, `xym` or `xyzm`, of all features together.
    dimensions: &'static str,
    /// The smallest and largest x and y: left, lower, right, upper.
    extent: Option<[f64; 4]>,
    crs: Option<CrsInfo>,
    fields: Vec<FieldInfo>,
    /// Features whose polygons cross, pinch or overlap themselves.
    invalid: u64,
    /// The first of them, counted from 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    first_invalid: Option<u64>,
    pub warnings: Vec<String>,
}

#[derive(Debug, Serialize)]
struct CrsInfo {
    code: Option<String>,
    wkt: Option<String>,
    /// True if `--to-crs` knows it.
    known: bool,
}

#[derive(Debug, Serialize)]
struct FieldInfo {
    name: String,
    kind: &'static str,
    /// Features with a value that is not null.
    filled: u64,
    examples: Vec<serde_json::Value>,
}

/// Counts over features.
#[derive(Default)]
struct Counts {
    features: u64,
    geometries: BTreeMap<&'static str, u64>,
    has_z: bool,
    has_m: bool,
    extent: Option<Rect>,
    schema: Schema,
    invalid: u64,
    first_invalid: Option<u64>,
    srids: Vec<i32>,
}

impl Counts {
    fn add(&mut self, feature: &Feature) {
        self.features += 1;
        self.schema.add(feature);
        if let Some(srid) =
            feature.srid.filter(|srid| !self.srids.contains(srid) && self.srids.len() < 2)
        {
            self.srids.push(srid);
        }
        let Some(geometry) = &feature.geometry else {
            *self.geometries.entry("none").or_default() += 1;
            return;
        };
        *self.geometries.entry(geometry.name()).or_default() += 1;
        geometry.for_each(&mut |points| {
            self.has_z |= points.dimensions.has_z();
            self.has_m |= points.dimensions.has_m();
        });
        let boxes = [self.extent, geometry.bounds()];
        self.extent = Rect::around(boxes.iter().flatten().flat_map(|b| [b.min(), b.max()]));
        if !is_valid(geometry) {
            self.invalid += 1;
            self.first_invalid = self.first_invalid.or(Some(self.features));
        }
    }
}

/// Reads a file and describes each of its layers, or the one that is chosen.
pub fn of_layers(
    path: &Path,
    chosen: Option<&str>,
    work: &Work,
) -> Result<Vec<LayerInfo>, Failure> {
    let (format, reader) = open(path, None, chosen, work)?;
    let name = chosen.map(str::to_owned);
    // Standard input is read once, with all layers as one.
    let is_whole = chosen.is_some() || is_stream(path);
    let names = if is_whole { Vec::new() } else { reader.layers() };
    if names.len() < 2 {
        return Ok(vec![of_layer(path, format, reader, name)?]);
    }
    let mut infos = Vec::new();
    for name in names {
        let (format, one) = open(path, Some(format), Some(&name), work)?;
        infos.push(of_layer(path, format, one, Some(name))?);
    }
    // Warnings about the file as a whole go to the first layer.
    if let Some(first) = infos.first_mut() {
        first.warnings.splice(0..0, reader.warnings().iter().map(ToString::to_string));
    }
    Ok(infos)
}

fn of_layer(
    path: &Path,
    format: GeoFormat,
    mut reader: Source,
    name: Option<String>,
) -> Result<LayerInfo, Failure> {
    let mut counts = Counts::default();
    let fail =
        |e: durer_formats::Error| Failure::Data(format!("{}: {}", display_name(path), words(&e)));
    while let Some(feature) = reader.next_feature().map_err(fail)? {
        counts.add(&feature);
    }
    let mut system = reader.system();
    if let ([srid], true) = (&counts.srids[..], system.is_unknown()) {
        system = System::of_code(*srid);
    }
    let mut warnings: Vec<String> = reader.warnings().iter().map(ToString::to_string).collect();
    if reader.further_warnings() > 0 {
        warnings.push(format!("and {} more", reader.further_warnings()));
    }
    Ok(LayerInfo {
        layer: display_name(path),
        name,
        format: format.name(),
        features: counts.features,
        geometries: counts.geometries,
        dimensions: match Dimensions::new(counts.has_z, counts.has_m) {
            Dimensions::Xy => "xy",
            Dimensions::Xyz => "xyz",
            Dimensions::Xym => "xym",
            Dimensions::Xyzm => "xyzm",
        },
        extent: counts.extent.map(|b| [b.min().x, b.min().y, b.max().x, b.max().y]),
        crs: crs(&system),
        fields: fields(&counts.schema),
        invalid: counts.invalid,
        first_invalid: counts.first_invalid,
        warnings,
    })
}

fn crs(system: &System) -> Option<CrsInfo> {
    let code = system.code.map(|code| format!("EPSG:{code}"));
    let known = Crs::of_system(system).is_ok();
    (!system.is_unknown()).then(|| CrsInfo { code, wkt: system.wkt.clone(), known })
}

fn fields(schema: &Schema) -> Vec<FieldInfo> {
    let value = |text: &String| serde_json::from_str(text).unwrap_or_default();
    let field = |field: &durer_formats::geo::Field| FieldInfo {
        name: field.key.clone(),
        kind: FieldKind::name(field.kind),
        filled: field.filled,
        examples: field.examples.iter().map(value).collect(),
    };
    schema.columns().iter().map(field).collect()
}

/// Texts of examples are cut to this many letters.
const LONG: usize = 40;

impl LayerInfo {
    /// Returns a line for each fact; facts that are nothing are left out.
    pub fn text(&self) -> String {
        let title = match &self.name {
            Some(name) => format!("{}, layer {name}", self.layer),
            None => self.layer.clone(),
        };
        let mut lines =
            vec![("format", self.format.to_owned()), ("features", self.features.to_string())];
        let kinds = self.geometries.iter().map(|(kind, count)| format!("{count} {kind}"));
        let kinds = kinds.collect::<Vec<_>>().join(", ");
        let geometry = match self.features {
            0 => "none".to_owned(),
            _ => format!("{kinds} [{}]", self.dimensions),
        };
        lines.push(("geometry", geometry));
        if let Some([left, lower, right, upper]) = self.extent {
            lines.push(("extent", format!("{left}, {lower} … {right}, {upper}")));
        }
        if let Some(crs) = &self.crs {
            let own = crs.code.as_ref().or(crs.wkt.as_ref()).cloned().unwrap_or_default();
            let hint = if crs.known { "" } else { " (not known to --to-crs)" };
            lines.push(("crs", format!("{own}{hint}")));
        }
        let invalid = match self.first_invalid {
            Some(first) if self.invalid == 1 => format!("1 feature, number {first}"),
            Some(first) => {
                let features = counted(self.invalid, "feature", "features");
                format!("{features}, the first is number {first}")
            }
            None => "none".to_owned(),
        };
        lines.push(("invalid", invalid));
        for (i, field) in self.fields.iter().enumerate() {
            let examples: Vec<String> = field.examples.iter().map(short).collect();
            let filled = if field.filled < self.features {
                format!(", {} filled", field.filled)
            } else {
                String::new()
            };
            let text = format!("{} [{}{filled}] {}", field.name, field.kind, examples.join(", "));
            lines.push((if i == 0 { "fields" } else { "" }, text.trim_end().to_owned()));
        }
        lines.extend(self.warnings.iter().map(|w| ("warning", w.clone())));
        let lines: Vec<String> = lines
            .iter()
            .map(|(name, value)| format!("  {name:<11} {}\n", escaped(value)))
            .collect();
        format!("{}\n{}", escaped(&title), lines.concat())
    }
}

/// Returns a value as one short line.
fn short(value: &serde_json::Value) -> String {
    let text = value.to_string();
    let plain: String = text.chars().filter(|c| !c.is_control()).collect();
    if plain.chars().count() <= LONG {
        plain
    } else {
        plain.chars().take(LONG).chain(['…']).collect()
    }
}
