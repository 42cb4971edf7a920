//! Features from bytes in any format.

use super::{Feature, GeoFormat, Member, Warnings, geojson, svg_shapes, wkb, wkt};
use crate::{Error, Place, Result, Warning};
use std::io::Read;

/// Files that are held whole may have so many bytes.
const MAX_BYTES: u64 = 4 << 30;

/// Gives the features of a file, one after the other.
///
/// GeoJSON holds one feature at a time in memory; the other formats hold the file.
pub struct Reader<R> {
    source: Source<R>,
    warnings: Warnings,
}

enum Source<R> {
    GeoJson(geojson::Reader<R>),
    Wkt(Vec<u8>, wkt::Mark),
    /// Bytes, and how many have been read.
    Wkb(Vec<u8>, usize),
    /// Text, bytes read, lines read.
    WkbHex(Vec<u8>, usize, u64),
    Svg(svg_shapes::Reader),
}

impl<R: Read> Reader<R> {
    /// A reader of a format.
    ///
    /// # Errors
    /// [`Error::Io`] where the source cannot be read, [`Error::Limit`] where a format that is held
    /// whole is longer than 4 GiB.
    pub fn new(format: GeoFormat, source: R) -> Result<Self> {
        let source = match format {
            GeoFormat::GeoJson | GeoFormat::GeoJsonSeq | GeoFormat::GeoJsonRs => {
                Source::GeoJson(geojson::Reader::new(source))
            }
            GeoFormat::Wkt => Source::Wkt(text(source)?, wkt::Mark::default()),
            GeoFormat::Wkb => Source::Wkb(whole(source)?, 0),
            GeoFormat::WkbHex => Source::WkbHex(text(source)?, 0, 0),
            GeoFormat::Svg => Source::Svg(svg_shapes::Reader::new(text(source)?)),
        };
        Ok(Self { source, warnings: Warnings::default() })
    }

    /// The next feature; `None` at the end. After an error there is nothing more to be had.
    ///
    /// # Errors
    /// [`Error::Decode`] with line and column, or the byte; [`Error::Unsupported`] for geometries
    /// that durer does not know; [`Error::Io`].
    pub fn next_feature(&mut self) -> Result<Option<Feature>> {
        match &mut self.source {
            Source::GeoJson(reader) => {
                let feature = reader.next_feature();
                move_warnings(reader.warnings(), &mut self.warnings);
                feature
            }
            Source::Wkt(text, mark) => {
                let mut reader = wkt::Reader::new(text, *mark);
                let feature = reader.next_feature();
                *mark = reader.mark();
                move_warnings(&mut reader.warnings, &mut self.warnings);
                feature
            }
            Source::Wkb(bytes, at) => {
                let mut reader = wkb::Reader::new(bytes);
                reader.resume(*at);
                let feature = reader.next_feature();
                *at = reader.offset();
                move_warnings(&mut reader.warnings, &mut self.warnings);
                feature
            }
            Source::WkbHex(text, at, line) => next_hex(text, at, line, &mut self.warnings),
            Source::Svg(reader) => reader.next_feature(&mut self.warnings),
        }
    }

    /// Members of collections that GeoJSON does not define, as far as they have been read: those
    /// that stand before the features are known with the first feature.
    pub fn members(&self) -> &[Member] {
        match &self.source {
            Source::GeoJson(reader) => reader.members(),
            _ => &[],
        }
    }

    /// What was repaired or left out so far; at most a thousand warnings are kept.
    pub fn warnings(&self) -> &[Warning] {
        &self.warnings.kept
    }

    /// How many warnings there were beyond those kept.
    pub fn further_warnings(&self) -> u64 {
        self.warnings.more
    }
}

fn move_warnings(from: &mut Warnings, to: &mut Warnings) {
    for warning in from.kept.drain(..) {
        to.push(warning.place, warning.message);
    }
    to.more += std::mem::take(&mut from.more);
}

/// The geometry of the next line that is not empty.
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
        for warning in reader.warnings.kept {
            warnings.push(in_line(warning.place), warning.message);
        }
        return feature.map_err(|e| match e {
            Error::Decode { place, message } => Error::Decode { place: in_line(place), message },
            Error::Unsupported { place, what, hint } => {
                Error::Unsupported { place: in_line(place), what, hint }
            }
            other => other,
        });
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

/// All features of a file in the format that its content, or else its name, speaks for.
///
/// # Errors
/// [`Error::Unknown`] where neither does; else as [`Reader::next_feature`].
pub fn read_all(bytes: &[u8], name: &str) -> Result<(Vec<Feature>, Vec<Warning>)> {
    let format = GeoFormat::of_content(bytes).or_else(|| GeoFormat::of_name(name));
    let unknown = "geodata are read from GeoJSON, WKT, WKB and SVG".to_owned();
    let mut reader = Reader::new(format.ok_or(Error::Unknown(unknown))?, bytes)?;
    let mut features = Vec::new();
    while let Some(feature) = reader.next_feature()? {
        features.push(feature);
    }
    Ok((features, reader.warnings.kept))
}
