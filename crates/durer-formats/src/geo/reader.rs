//! Features from bytes in any format.

use super::beside::{Beside, MAX_BYTES};
use super::numbered::Label;
use super::{
    Feature, GeoFormat, Member, System, Warnings, csv, flatgeobuf, geojson, geopackage, geoparquet,
    gpx, kml, shapefile, svg_shapes, topojson, wkb, wkt,
};
use crate::{Error, Place, Result, Warning};
use durer::math::Rect;
use std::io::Read;

/// Reader of the features of a file, one after the other.
///
/// GeoJSON holds one feature at a time in memory; the other formats hold the file.
pub struct Reader<R> {
    source: Source<R>,
    warnings: Warnings,
    /// System that a file states for all its coordinates.
    system: System,
    /// Members of the file that are known at once.
    members: Vec<Member>,
    /// Names of the layers of a topology that are read.
    layers: Vec<String>,
    /// True once a feature has been read.
    begun: bool,
    /// Number of features that have been read or left out, of formats that do not count them themselves.
    count: u64,
    /// True if features that cannot be read are left out.
    skips: bool,
    /// Features that have been left out for it, with the reason for the first.
    skipped: Skipped,
}

/// Features that cannot be read.
#[derive(Debug, Default)]
struct Skipped {
    count: u64,
    first: Place,
    /// The reason, until it has been reported.
    why: Option<String>,
}

enum Source<R> {
    GeoJson(geojson::Reader<R>),
    Wkt(Vec<u8>, wkt::Mark),
    /// Bytes, and how many have been read.
    Wkb(Vec<u8>, usize),
    /// Text, bytes read, lines read.
    WkbHex(Vec<u8>, usize, u64),
    Svg(svg_shapes::Reader),
    Shapefile(shapefile::Reader),
    FlatGeobuf(flatgeobuf::Reader),
    GeoPackage(geopackage::Reader),
    GeoParquet(Box<geoparquet::Reader>),
    Csv(csv::Reader),
    /// Features that have been read.
    Held(std::vec::IntoIter<Feature>),
}

impl<R: Read> Source<R> {
    /// Returns whether the next feature can be found after an error.
    fn goes_on(&self) -> bool {
        match self {
            Self::GeoJson(reader) => reader.goes_on(),
            Self::Wkt(..) | Self::WkbHex(..) | Self::Csv(_) | Self::Shapefile(_) => true,
            _ => false,
        }
    }

    /// Returns whether places already name features, rows, or layers and rows, or are not those of features.
    fn tells_features(&self) -> bool {
        match self {
            Self::GeoJson(_) | Self::Shapefile(_) | Self::Held(_) => true,
            Self::GeoPackage(_) | Self::GeoParquet(_) | Self::Svg(_) => true,
            Self::FlatGeobuf(reader) => reader.is_chosen(),
            _ => false,
        }
    }
}

impl<R: Read> Reader<R> {
    /// Creates a reader of a format.
    ///
    /// # Errors
    /// [`Error::Io`] if the source cannot be read, [`Error::Limit`] if a format that is held
    /// whole is longer than 4 GiB.
    pub fn new(format: GeoFormat, source: R) -> Result<Self> {
        Self::with(format, source, &Beside::NOTHING)
    }

    /// Creates a reader of a format that may have further files beside it, or layers.
    ///
    /// # Errors
    /// As [`Self::new`]; also those of [`Self::next_feature`] for formats that are read as a whole before the first
    /// feature.
    pub fn with(format: GeoFormat, source: R, beside: &Beside<'_>) -> Result<Self> {
        let mut warnings = Warnings::default();
        let (mut members, mut layers) = (Vec::new(), Vec::new());
        let mut system = if format.is_lonlat() { System::LONLAT } else { System::default() };
        let source = match format {
            GeoFormat::GeoJson | GeoFormat::GeoJsonSeq | GeoFormat::GeoJsonRs => {
                Source::GeoJson(geojson::Reader::new(source))
            }
            GeoFormat::Wkt => Source::Wkt(text(source)?, wkt::Mark::default()),
            GeoFormat::Wkb => Source::Wkb(whole(source)?, 0),
            GeoFormat::WkbHex => Source::WkbHex(text(source)?, 0, 0),
            GeoFormat::Svg => Source::Svg(svg_shapes::Reader::new(text(source)?)),
            GeoFormat::Shapefile => {
                let reader = shapefile::Reader::new(whole(source)?, beside, &mut warnings)?;
                system = reader.system.clone();
                Source::Shapefile(reader)
            }
            GeoFormat::FlatGeobuf => {
                let reader = flatgeobuf::Reader::new(whole(source)?)?;
                system = reader.system.clone();
                Source::FlatGeobuf(reader)
            }
            GeoFormat::GeoPackage => {
                let reader = geopackage::Reader::new(whole(source)?, beside, &mut warnings)?;
                system = reader.system();
                Source::GeoPackage(reader)
            }
            GeoFormat::GeoParquet => {
                let reader = geoparquet::Reader::new(whole(source)?, beside, &mut warnings)?;
                system = reader.system.clone();
                Source::GeoParquet(Box::new(reader))
            }
            GeoFormat::Csv => Source::Csv(csv::Reader::new(text(source)?)?),
            GeoFormat::TopoJson => {
                let read = topojson::read(&text(source)?, beside.layer, &mut warnings)?;
                (members, layers) = (read.members, read.layers);
                Source::Held(read.features.into_iter())
            }
            GeoFormat::Kml => Source::Held(kml::read(&markup(source)?, &mut warnings)?.into_iter()),
            GeoFormat::Gpx => Source::Held(gpx::read(&markup(source)?, &mut warnings)?.into_iter()),
        };
        if beside.layer.is_some() && !format.has_layers() {
            warnings.note(format!("{format} has one layer; --layer does nothing"));
        }
        Ok(Self {
            source,
            warnings,
            system,
            members,
            layers,
            begun: false,
            count: 0,
            skips: false,
            skipped: Skipped::default(),
        })
    }

    /// Returns the coordinate system given by the file for all its coordinates, as far as it has been read: a member of
    /// GeoJSON after the features is known only at the end.
    pub fn system(&self) -> System {
        if let Source::GeoJson(reader) = &self.source {
            return reader.system();
        }
        let stated = super::system::of_members(self.members());
        stated.unwrap_or_else(|| self.system.clone())
    }

    /// Skips features whose boxes do not meet a window, in the coordinates of the file, if the file has a spatial
    /// index; to be called before the first feature. Without an index, features outside the window are returned as
    /// well.
    pub fn choose(&mut self, window: &Rect) {
        if let Source::FlatGeobuf(reader) = &mut self.source {
            reader.choose(window);
        }
    }

    /// Returns the next feature; `None` at the end, and after an error.
    ///
    /// # Errors
    /// [`Error::Decode`] with line and column, or the byte; [`Error::Unsupported`] for geometries
    /// that durer does not know; [`Error::Io`].
    pub fn next_feature(&mut self) -> Result<Option<Feature>> {
        let layers = &self.layers;
        if !std::mem::replace(&mut self.begun, true) && layers.len() > 1 {
            let (count, names) = (layers.len(), crate::text::quote(layers.join(", ").as_bytes()));
            self.warnings
                .note(format!("its {count} layers, {names}, become one; --layer names one"));
        }
        let feature = loop {
            match self.next_of_source() {
                Err(error) if self.skips && self.source.goes_on() && is_of_data(&error) => {
                    self.skip(error);
                }
                next => break next?,
            }
        };
        if feature.is_none() {
            self.warnings.take_over();
            let Skipped { count, first, why } = &mut self.skipped;
            if let Some(why) = why.take() {
                let message = super::unread(*count, super::FEATURES, &why);
                self.warnings.push(std::mem::take(first), message);
            }
        }
        Ok(feature)
    }

    /// Returns whether the file is JSON of ArcGIS, which is read as if it were GeoJSON; to be called before the first
    /// feature.
    pub fn is_arcgis(&mut self) -> bool {
        match &mut self.source {
            Source::GeoJson(reader) => reader.is_arcgis(),
            _ => false,
        }
    }

    /// Leaves out features that cannot be read, from now on, where a format shows the end of such a feature: GeoJSON
    /// (whose text is JSON), CSV, WKT (with a geometry per line), hexadecimal WKB and Shapefile. A warning at the end
    /// counts them.
    pub fn skip_failures(&mut self) {
        self.skips = true;
    }

    /// Returns the number of features that have been left out because they cannot be read.
    pub fn skipped(&self) -> u64 {
        self.skipped.count
    }

    /// Counts a feature that cannot be read, and steps over the rest of it.
    fn skip(&mut self, error: Error) {
        let (place, why) = match error {
            Error::Decode { place, message } => (place, message),
            other => (Place::Whole, other.to_string()),
        };
        if self.skipped.count == 0 {
            (self.skipped.first, self.skipped.why) = (place, Some(why));
        }
        self.skipped.count += 1;
        if let Source::Wkt(text, mark) = &mut self.source {
            *mark = wkt::Reader::new(text, *mark).next_line();
        }
    }

    /// Returns the next feature, and tells in which one faults are.
    fn next_of_source(&mut self) -> Result<Option<Feature>> {
        if self.source.tells_features() {
            return self.next_unlabelled();
        }
        let from = self.warnings.kept.len();
        self.count += 1;
        let next = self.next_unlabelled();
        self.warnings.labelled(next, Label::bare(self.count), from)
    }

    fn next_unlabelled(&mut self) -> Result<Option<Feature>> {
        match &mut self.source {
            Source::GeoJson(reader) => {
                let feature = reader.next_feature();
                self.warnings.append(reader.warnings());
                feature
            }
            Source::Wkt(text, mark) => {
                let mut reader = wkt::Reader::new(text, *mark);
                let feature = reader.next_feature();
                if feature.is_ok() {
                    *mark = reader.mark();
                }
                self.warnings.append(&mut reader.warnings);
                feature
            }
            Source::Wkb(bytes, at) => {
                let mut reader = wkb::Reader::new(bytes);
                reader.resume(*at);
                let feature = reader.next_feature();
                *at = reader.offset();
                self.warnings.append(&mut reader.warnings);
                feature
            }
            Source::WkbHex(text, at, line) => next_hex(text, at, line, &mut self.warnings),
            Source::Svg(reader) => reader.next_feature(&mut self.warnings),
            Source::Shapefile(reader) => reader.next_feature(&mut self.warnings),
            Source::FlatGeobuf(reader) => reader.next_feature(&mut self.warnings),
            Source::GeoPackage(reader) => reader.next_feature(&mut self.warnings),
            Source::GeoParquet(reader) => reader.next_feature(&mut self.warnings),
            Source::Csv(reader) => reader.next_feature(&mut self.warnings),
            Source::Held(features) => Ok(features.next()),
        }
    }

    /// Returns the names of the layers that are read from a GeoPackage or a TopoJSON; empty for other formats.
    pub fn layers(&self) -> Vec<String> {
        match &self.source {
            Source::GeoPackage(reader) => reader.layers(),
            _ => self.layers.clone(),
        }
    }

    /// Returns the members of collections that GeoJSON does not define, as far as they have been read: those before the
    /// features are known with the first feature.
    pub fn members(&self) -> &[Member] {
        match &self.source {
            Source::GeoJson(reader) => reader.members(),
            _ => &self.members,
        }
    }

    /// Returns the repairs and omissions so far; at most a thousand warnings are kept.
    pub fn warnings(&self) -> &[Warning] {
        &self.warnings.kept
    }

    /// Returns whether a warning tells only how the file is read, and of nothing that was repaired or left out.
    pub fn is_note(&self, warning: &Warning) -> bool {
        self.warnings.notes.contains(&warning.message)
    }

    /// Returns the number of warnings beyond those kept.
    pub fn further_warnings(&self) -> u64 {
        self.warnings.more
    }
}

/// Returns whether an error is about one feature's data.
fn is_of_data(error: &Error) -> bool {
    matches!(error, Error::Decode { .. } | Error::Unsupported { .. })
}

/// Returns the geometry of the next line that is not empty.
fn next_hex(
    text: &[u8],
    at: &mut usize,
    line: &mut u64,
    warnings: &mut Warnings,
) -> Result<Option<Feature>> {
    loop {
        let rest = text.get(*at..).unwrap_or_default();
        if rest.is_empty() {
            return Ok(None);
        }
        let length = rest.iter().position(|&b| b == b'\n').map_or(rest.len(), |i| i + 1);
        let digits = rest.get(..length).unwrap_or_default().trim_ascii();
        *at += length;
        *line += 1;
        if digits.is_empty() {
            continue;
        }
        let bytes = wkb::decode_hex(digits, *line)?;
        let in_line = |place: Place| match place {
            Place::Byte(offset) => Place::Line(*line, 2 * offset + 1),
            other => other,
        };
        let mut reader = wkb::Reader::new(&bytes);
        let feature = reader.next_feature().and_then(|feature| {
            let rest = bytes.len() - reader.offset();
            let end = reader.offset() as u64;
            if rest == 0 {
                Ok(feature)
            } else {
                Err(Error::byte(end, format!("{rest} bytes after the geometry")))
            }
        });
        reader.warnings.relocate(in_line);
        warnings.append(&mut reader.warnings);
        return feature.map_err(|e| e.at(in_line));
    }
}

fn whole(source: impl Read) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    source.take(MAX_BYTES + 1).read_to_end(&mut bytes)?;
    let value = bytes.len() as u64;
    if value > MAX_BYTES {
        return Err(Error::Limit { place: Place::Whole, what: "size", value, limit: MAX_BYTES });
    }
    Ok(bytes)
}

fn text(source: impl Read) -> Result<Vec<u8>> {
    Ok(crate::text::utf8(&whole(source)?).into_owned())
}

/// Returns a document of XML as text.
fn markup(source: impl Read) -> Result<String> {
    let text = crate::xml::utf8(&whole(source)?).into_owned();
    Ok(String::from_utf8(text)
        .unwrap_or_else(|e| String::from_utf8_lossy(e.as_bytes()).into_owned()))
}

/// Returns all features of a file in the format of its content, or else of its name.
///
/// # Errors
/// [`Error::Unknown`] if neither does; else as [`Reader::next_feature`].
pub fn read_all(bytes: &[u8], name: &str) -> Result<(Vec<Feature>, Vec<Warning>)> {
    let format = GeoFormat::of_content(bytes).or_else(|| GeoFormat::of_name(name));
    let unknown =
        format!("{}; map data are read from {}", GeoFormat::foreign(bytes), GeoFormat::READ);
    let mut reader = Reader::new(format.ok_or(Error::Unknown(unknown))?, bytes)?;
    let mut features = Vec::new();
    while let Some(feature) = reader.next_feature()? {
        features.push(feature);
    }
    Ok((features, reader.warnings.kept))
}
