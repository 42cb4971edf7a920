//! Placemarks of KML (OGC 12-007r2) as features: name, description, data and geometry.
//!
//! Styles and views are ignored; overlays and links to other files give a warning.

use super::geojson::{finish_line, finish_ring};
use super::markup::{MIXED, push};
use super::members::{object, quoted};
use super::numbered::Label;
use super::{Feature, Geometry, MAX_DEPTH, Member, Points, Warnings};
use crate::collada::document::Document;
use crate::text::Tally;
use crate::{Error, Place, Result};
use durer::math::DVec2;
use std::collections::BTreeMap;

/// Memory that the tree of elements may take, in bytes.
const MAX_MEMORY: u64 = 8 << 30;

/// Elements of a placemark that become fields, in the order of the fields.
const FIELDS: [&str; 5] = ["name", "description", "address", "phoneNumber", "visibility"];

/// Elements shown beside placemarks that are left out.
const LEFT_OUT: [&str; 4] = ["GroundOverlay", "ScreenOverlay", "PhotoOverlay", "NetworkLink"];

/// Reads all placemarks of a document.
pub fn read(text: &str, warnings: &mut Warnings) -> Result<Vec<Feature>> {
    let document = Document::parse(text, MAX_MEMORY)?;
    let root = document.root().filter(|&root| document.name(root) == "kml");
    let root = root.ok_or_else(|| Error::line(1, 0, "there is no kml element"))?;
    let types = types(&document, root);
    let mut reader = Reader { document, types, faults: Faults::default() };
    let mut features = Vec::new();
    for element in reader.document.inside(root).collect::<Vec<_>>() {
        let name = reader.document.name(element).to_owned();
        if name == "Placemark" {
            let (number, from) = (features.len() as u64 + 1, warnings.kept.len());
            features.push(reader.placemark(element, number, warnings)?);
            if let Some(feature) = features.last() {
                let label = || Label::of(number, feature);
                warnings.label(from, label);
                reader.faults.label(label);
            }
        } else if LEFT_OUT.contains(&&name[..]) {
            let place = reader.document.place(element);
            reader.faults.others.add(|| place);
        }
    }
    reader.faults.warn(warnings);
    Ok(features)
}

/// Faults that are reported once, with a count.
#[derive(Debug, Default)]
struct Faults {
    others: Tally,
    models: Tally,
    coordinates: Tally,
    mixed: Tally,
    times: Tally,
}

impl Faults {
    /// Adds the feature that has just been read to the places of its faults.
    fn label(&mut self, label: impl Fn() -> Label) {
        let Self { models, coordinates, mixed, times, .. } = self;
        [models, coordinates, mixed, times].into_iter().for_each(|tally| tally.label(&label));
    }

    fn warn(self, warnings: &mut Warnings) {
        for (tally, [one, several]) in [
            (
                self.others,
                [
                    "overlay or link to another file is left out",
                    "overlays and links to other files are left out",
                ],
            ),
            (self.models, ["model is left out", "models are left out"]),
            (
                self.coordinates,
                ["coordinate is not a number; left out", "coordinates are not numbers; left out"],
            ),
            (self.mixed, MIXED),
            (
                self.times,
                [
                    "moment of a track is left out; the place is kept",
                    "moments of tracks are left out; the places are kept",
                ],
            ),
        ] {
            warnings.add_counted(tally, one, several);
        }
    }
}

/// Returns the types of fields that schemas declare, by the fields' names; none for names with several types.
fn types(document: &Document<'_>, root: usize) -> BTreeMap<String, Option<Type>> {
    let mut types = BTreeMap::new();
    for schema in document.inside(root).filter(|&e| document.name(e) == "Schema") {
        for field in document.named(schema, "SimpleField") {
            let [name, declared] = ["name", "type"].map(|key| document.attribute(field, key));
            let declared = match declared.unwrap_or_default() {
                "int" | "uint" | "short" | "ushort" | "float" | "double" => Some(Type::Number),
                "bool" => Some(Type::Truth),
                _ => None,
            };
            let known = types.entry(name.unwrap_or_default().to_owned()).or_insert(declared);
            *known = known.filter(|known| Some(*known) == declared);
        }
    }
    types
}

/// Type of a field other than text.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Type {
    Number,
    Truth,
}

impl Type {
    /// Returns a text of this type in JSON; `None` if it is not of the type.
    fn json(self, text: &str) -> Option<String> {
        let text = text.trim();
        match (self, text) {
            (Self::Number, _) => {
                serde_json::from_str::<serde_json::Number>(text).ok().map(|_| text.to_owned())
            }
            (Self::Truth, "true" | "1") => Some("true".to_owned()),
            (Self::Truth, "false" | "0") => Some("false".to_owned()),
            (Self::Truth, _) => None,
        }
    }
}

struct Reader<'a> {
    document: Document<'a>,
    /// Types of fields that are not texts.
    types: BTreeMap<String, Option<Type>>,
    faults: Faults,
}

impl Reader<'_> {
    fn placemark(
        &mut self,
        element: usize,
        number: u64,
        warnings: &mut Warnings,
    ) -> Result<Feature> {
        let document = &self.document;
        let id = document.attribute(element, "id").map(quoted);
        let properties = Some(object(&self.fields(element)));
        let mut feature = Feature { id, properties, srid: Some(4326), ..Feature::default() };
        for child in document.children(element).collect::<Vec<_>>() {
            let found = self.geometry(child, 0, warnings);
            let found = found.map_err(|error| error.in_feature(&Label::of(number, &feature)))?;
            feature.geometry = feature.geometry.or(found);
        }
        Ok(feature)
    }

    fn fields(&self, element: usize) -> Vec<Member> {
        let document = &self.document;
        let mut fields = Vec::new();
        let mut add = |key: &str, element: usize| {
            let text = document.text(element);
            let is_typed = document.name(element) == "SimpleData";
            let declared = self.types.get(key).copied().flatten().filter(|_| is_typed);
            let text = declared.and_then(|t| t.json(&text)).unwrap_or_else(|| quoted(&text));
            if !fields.iter().any(|m: &Member| m.name == quoted(key)) {
                fields.push(Member::new(key, text));
            }
        };
        for key in FIELDS {
            document.named(element, key).take(1).for_each(|child| add(key, child));
        }
        for (time, parts) in [("TimeStamp", &["when"][..]), ("TimeSpan", &["begin", "end"])] {
            for part in parts {
                document
                    .find(element, &[time, part])
                    .into_iter()
                    .for_each(|child| add(part, child));
            }
        }
        for data in document.named(element, "ExtendedData") {
            for item in document.inside(data) {
                let Some(key) = document.attribute(item, "name") else { continue };
                match document.name(item) {
                    "Data" => {
                        document.named(item, "value").take(1).for_each(|value| add(key, value))
                    }
                    "SimpleData" => add(key, item),
                    _ => {}
                }
            }
        }
        fields
    }

    /// Returns the geometry of an element, if it is one.
    fn geometry(
        &mut self,
        element: usize,
        depth: usize,
        warnings: &mut Warnings,
    ) -> Result<Option<Geometry>> {
        let document = &self.document;
        let place = || document.place(element);
        if depth > MAX_DEPTH {
            return Err(Error::Decode {
                place: place(),
                message: "geometries are nested too deep".to_owned(),
            });
        }
        Ok(Some(match document.name(element) {
            "Point" => {
                let mut points = self.coordinates(element);
                (1..points.len()).for_each(|_| points.pop());
                Geometry::Point(points)
            }
            "LineString" => Geometry::LineString(self.line(element, warnings)),
            "LinearRing" => {
                let mut line = self.coordinates(element);
                if line.len() > 2 && line.xy.first() != line.xy.last() {
                    line.push(line.xy[0], line.zm(0));
                }
                Geometry::LineString(line)
            }
            "Polygon" => Geometry::Polygon(self.polygon(element, warnings)),
            "Track" => Geometry::LineString(self.track(element, warnings)),
            "MultiTrack" => {
                let tracks: Vec<usize> = document.named(element, "Track").collect();
                let lines = tracks.into_iter().map(|track| self.track(track, warnings));
                Geometry::MultiLineString(lines.filter(|line| !line.is_empty()).collect())
            }
            "MultiGeometry" => {
                let mut parts = Vec::new();
                for child in document.children(element).collect::<Vec<_>>() {
                    parts.extend(self.geometry(child, depth + 1, warnings)?);
                }
                alike(parts)
            }
            "Model" => {
                let place = place();
                self.faults.models.add(|| place);
                return Ok(None);
            }
            _ => return Ok(None),
        }))
    }

    /// Returns the positions of an element's `coordinates`: numbers joined by commas, parted by
    /// blanks.
    fn coordinates(&mut self, element: usize) -> Points {
        let Some(list) = self.document.find(element, &["coordinates"]) else {
            return Points::default();
        };
        // Some writers put blanks after commas.
        let text = self.document.text(list);
        let text = text.split(',').map(str::trim).collect::<Vec<_>>().join(",");
        let parts = text.split_ascii_whitespace().map(|tuple| tuple.split(',').collect::<Vec<_>>());
        let place = self.document.place(list);
        points(parts, &mut self.faults, &place)
    }

    fn line(&mut self, element: usize, warnings: &mut Warnings) -> Points {
        let mut line = self.coordinates(element);
        finish_line(&mut line, || self.document.place(element), warnings);
        line
    }

    fn polygon(&mut self, element: usize, warnings: &mut Warnings) -> Vec<Points> {
        let mut rings = Vec::new();
        for (side, is_outer) in [("outerBoundaryIs", true), ("innerBoundaryIs", false)] {
            let sides: Vec<usize> = self.document.named(element, side).collect();
            for side in sides {
                // Some writers put several rings into one border.
                for ring in self.document.named(side, "LinearRing").collect::<Vec<_>>() {
                    let mut points = self.coordinates(ring);
                    finish_ring(&mut points, || self.document.place(ring), warnings);
                    if !points.is_empty() && (is_outer || !rings.is_empty()) {
                        rings.push(points);
                    }
                }
            }
        }
        rings
    }

    /// Returns the positions of a track: `coord` elements of numbers parted by blanks.
    fn track(&mut self, element: usize, warnings: &mut Warnings) -> Points {
        let document = &self.document;
        let texts: Vec<String> =
            document.named(element, "coord").map(|c| document.text(c)).collect();
        let parts = texts.iter().map(|text| text.split_ascii_whitespace().collect::<Vec<_>>());
        let place = document.place(element);
        for _ in document.named(element, "when") {
            self.faults.times.add(|| place.clone());
        }
        let mut line = points(parts, &mut self.faults, &place);
        finish_line(&mut line, || place.clone(), warnings);
        line
    }
}

/// Returns positions from the texts of their numbers.
fn points<'a>(
    parts: impl Iterator<Item = Vec<&'a str>>,
    faults: &mut Faults,
    place: &Place,
) -> Points {
    let mut points = Points::default();
    for part in parts {
        let number = |i: usize| part.get(i).map(|text| number(text));
        let (Some(Some(x)), Some(Some(y)), z) = (number(0), number(1), number(2).flatten()) else {
            faults.coordinates.add(|| place.clone());
            continue;
        };
        push(&mut points, DVec2::new(x, y), z, (&mut faults.mixed, || place.clone()));
    }
    points
}

fn number(text: &str) -> Option<f64> {
    let (value, length) = crate::number::float(text.as_bytes())?;
    (length == text.len() && value.is_finite()).then_some(value)
}

/// Returns parts of one kind as one geometry of several, others as a collection.
fn alike(parts: Vec<Geometry>) -> Geometry {
    let all = |name: &str| !parts.is_empty() && parts.iter().all(|part| part.name() == name);
    if all("Polygon") {
        let rings = parts.into_iter().filter_map(|part| match part {
            Geometry::Polygon(rings) if !rings.is_empty() => Some(rings),
            _ => None,
        });
        return Geometry::MultiPolygon(rings.collect());
    }
    if all("LineString") {
        let lines = parts.into_iter().filter_map(|part| match part {
            Geometry::LineString(line) if !line.is_empty() => Some(line),
            _ => None,
        });
        return Geometry::MultiLineString(lines.collect());
    }
    Geometry::Collection(parts)
}
