//! Waypoints, routes and tracks of GPX 1.0 and 1.1 as points, lines and groups of lines.

use super::geojson::finish_line;
use super::markup::{MIXED, push};
use super::members::{object, quoted};
use super::numbered::Label;
use super::{Feature, Geometry, Member, Points, Warnings};
use crate::collada::document::Document;
use crate::text::Tally;
use crate::{Error, Result};
use durer::math::DVec2;

/// Memory that the tree of elements may take, in bytes.
const MAX_MEMORY: u64 = 8 << 30;

/// The field with the kind of a feature in the file.
const KIND: &str = "gpx";

/// Elements with texts that are numbers.
const NUMBERS: [&str; 9] =
    ["ele", "magvar", "geoidheight", "sat", "hdop", "vdop", "pdop", "number", "ageofdgpsdata"];

/// Elements that are not fields of their own.
const NO_FIELDS: [&str; 5] = ["extensions", "rtept", "trkseg", "trkpt", "ele"];

/// Reads all waypoints, routes and tracks of a document, in its order.
pub fn read(text: &str, warnings: &mut Warnings) -> Result<Vec<Feature>> {
    let document = Document::parse(text, MAX_MEMORY)?;
    let root = document.root().filter(|&root| document.name(root) == "gpx");
    let root = root.ok_or_else(|| Error::line(1, 0, "there is no gpx element"))?;
    let mut reader = Reader {
        document,
        places: Tally::default(),
        times: Tally::default(),
        mixed: Tally::default(),
    };
    let mut features = Vec::new();
    for element in reader.document.children(root).collect::<Vec<_>>() {
        let from = warnings.kept.len();
        let (kind, geometry) = match reader.document.name(element) {
            "wpt" => ("waypoint", Geometry::Point(reader.points([element].into_iter()))),
            "rte" => ("route", Geometry::LineString(reader.line(element, "rtept", warnings))),
            "trk" => {
                let segments: Vec<usize> = reader.document.named(element, "trkseg").collect();
                let lines = segments.into_iter().map(|s| reader.line(s, "trkpt", warnings));
                let lines: Vec<Points> = lines.filter(|line| !line.is_empty()).collect();
                ("track", Geometry::MultiLineString(lines))
            }
            _ => continue,
        };
        let properties = Some(object(&reader.fields(element, kind)));
        let (geometry, srid) = (Some(geometry), Some(4326));
        let feature = Feature { geometry, properties, srid, ..Feature::default() };
        let label = || Label::of(features.len() as u64 + 1, &feature);
        warnings.label(from, label);
        let Reader { places, times, mixed, .. } = &mut reader;
        [places, times, mixed].into_iter().for_each(|tally| tally.label(label));
        features.push(feature);
    }
    warnings.add_counted(reader.mixed, MIXED[0], MIXED[1]);
    warnings.add_counted(
        reader.places,
        "point has no latitude and longitude; left out",
        "points have no latitude and longitude; left out",
    );
    warnings.add_counted(
        reader.times,
        "point of a route or track has a time or other values; its place is kept",
        "points of routes and tracks have times or other values; their places are kept",
    );
    Ok(features)
}

struct Reader<'a> {
    document: Document<'a>,
    /// Points without a place.
    places: Tally,
    /// Points with more than a place.
    times: Tally,
    /// Points with a height beside others without.
    mixed: Tally,
}

impl Reader<'_> {
    fn fields(&self, element: usize, kind: &str) -> Vec<Member> {
        let document = &self.document;
        let mut fields = vec![Member::new(KIND, quoted(kind))];
        for child in document.children(element).filter(|&c| !NO_FIELDS.contains(&document.name(c)))
        {
            let key = document.name(child);
            let text = match document.attribute(child, "href") {
                Some(link) => link.to_owned(),
                None => document.text(child),
            };
            let is_number =
                NUMBERS.contains(&key) && serde_json::from_str::<serde_json::Number>(&text).is_ok();
            let value = if is_number { text } else { quoted(&text) };
            if !fields.iter().any(|m| m.name == quoted(key)) {
                fields.push(Member::new(key, value));
            }
        }
        fields
    }

    fn line(&mut self, element: usize, name: &str, warnings: &mut Warnings) -> Points {
        let points: Vec<usize> = self.document.named(element, name).collect();
        for &point in &points {
            let further = |c: usize| !matches!(self.document.name(c), "ele" | "extensions");
            if self.document.children(point).any(further) {
                self.times.add(|| self.document.place(point));
            }
        }
        let mut line = self.points(points.into_iter());
        finish_line(&mut line, || self.document.place(element), warnings);
        line
    }

    fn points(&mut self, elements: impl Iterator<Item = usize>) -> Points {
        let document = &self.document;
        let mut points = Points::default();
        for element in elements {
            let number = |text: &str| text.trim().parse().ok().filter(|n: &f64| n.is_finite());
            let at = |key| document.attribute(element, key).and_then(number);
            let (Some(lon), Some(lat)) = (at("lon"), at("lat")) else {
                self.places.add(|| document.place(element));
                continue;
            };
            let height =
                document.find(element, &["ele"]).and_then(|ele| number(&document.text(ele)));
            let mixed = (&mut self.mixed, || document.place(element));
            push(&mut points, DVec2::new(lon, lat), height, mixed);
        }
        points
    }
}
