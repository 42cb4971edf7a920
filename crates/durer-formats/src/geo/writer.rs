//! Features to bytes in any format.

use super::members::with_id;
use super::{
    Feature, GeoFormat, Member, System, csv, flatgeobuf, geojson, geopackage, geoparquet,
    shapefile, svg, topojson, wkb, wkt,
};
use crate::{Error, Place, Result, Warning};
use std::io::{self, Seek, SeekFrom, Write};

/// Writer of features, one after the other.
///
/// GeoJSON, WKT and WKB are written as features come, and GeoPackages by [`Writer::seekable`]; the others at the end.
/// WKT and WKB keep geometry and SRID only; SVG keeps ids too. CSV, FlatGeobuf and Shapefile keep an id as the field
/// `id`, if there is no other of that name; so do GeoPackages ids that are not whole numbers which grow.
pub struct Writer<W> {
    format: GeoFormat,
    out: W,
    members: Vec<Member>,
    count: u64,
    /// Features that have to wait for the end.
    held: Vec<Feature>,
    line: Vec<u8>,
    system: System,
    layer: String,
    package: Option<Box<geopackage::Writer>>,
    /// Function that writes over the first bytes, where the target can.
    rewrite: Option<Rewrite<W>>,
}

/// Function that overwrites the first bytes of a target and moves to its end.
type Rewrite<W> = fn(&mut W, &[u8]) -> io::Result<()>;

/// Result of a writer at its end.
#[derive(Debug)]
pub struct Finished<W> {
    /// Target that the file was written to.
    pub out: W,
    /// Further files that belong beside it: the endings of their names, and their bytes.
    pub beside: Vec<(&'static str, Vec<u8>)>,
    /// Warnings about data that the format cannot represent.
    pub warnings: Vec<Warning>,
}

impl<W: Write + Seek> Writer<W> {
    /// Creates a writer of a format to an empty, seekable target, so that a GeoPackage is written as its features are
    /// added. Nothing is written yet.
    pub fn seekable(format: GeoFormat, out: W) -> Self {
        let rewrite: Rewrite<W> = |out, bytes| {
            out.seek(SeekFrom::Start(0))?;
            out.write_all(bytes)?;
            out.seek(SeekFrom::End(0)).map(drop)
        };
        Self { rewrite: Some(rewrite), ..Self::new(format, out) }
    }
}

impl<W: Write> Writer<W> {
    /// Creates a writer of a format. Nothing is written yet.
    pub fn new(format: GeoFormat, out: W) -> Self {
        let (members, held, line, system, package) = Default::default();
        let (layer, rewrite) = ("layer".to_owned(), None);
        Self { format, out, members, count: 0, held, line, system, layer, package, rewrite }
    }

    /// Sets the name of the layer, for GeoPackages; before the end.
    pub fn set_layer(&mut self, name: &str) {
        name.clone_into(&mut self.layer);
    }

    fn package(&mut self) -> &mut geopackage::Writer {
        self.package.get_or_insert_with(|| {
            let mut package = geopackage::Writer::new();
            package.set_system(self.system.clone());
            Box::new(package)
        })
    }

    /// Ends a GeoPackage.
    fn finish_package(&mut self) -> Result<Vec<Warning>> {
        self.package();
        let Some(package) = self.package.take() else { return Ok(Vec::new()) };
        let (first, mut rest, warnings) = package.finish(&self.layer)?;
        match self.rewrite {
            Some(rewrite) => {
                self.out.write_all(&rest)?;
                rewrite(&mut self.out, &first)?;
            }
            None => {
                rest.iter_mut().zip(&first).for_each(|(to, from)| *to = *from);
                self.out.write_all(&rest)?;
            }
        }
        Ok(warnings)
    }

    /// Sets the coordinate system of all coordinates, for formats that state it; before the first feature.
    pub fn set_system(&mut self, system: System) {
        self.system = system;
    }

    /// Sets the members for the head of a GeoJSON collection; taken until the first feature is written.
    pub fn head(&mut self, members: &[Member]) {
        if self.count == 0 {
            self.members = members.to_vec();
        }
    }

    /// Writes a feature. WKT and WKB leave out those without geometry.
    ///
    /// # Errors
    /// [`crate::Error::Io`]; [`crate::Error::Unsupported`] if a GeoPackage would have more than 1998 fields.
    pub fn write(&mut self, feature: &Feature) -> Result<()> {
        self.line.clear();
        match self.format {
            GeoFormat::GeoJson => {
                self.begin_collection()?;
                self.line.extend_from_slice(if self.count == 0 { b"\n" } else { b",\n" });
                geojson::write_feature(&mut self.line, feature)?;
            }
            GeoFormat::GeoJsonSeq => {
                geojson::write_feature(&mut self.line, feature)?;
                self.line.push(b'\n');
            }
            GeoFormat::GeoJsonRs => {
                self.line.push(0x1e);
                geojson::write_feature(&mut self.line, feature)?;
                self.line.push(b'\n');
            }
            GeoFormat::Wkt => wkt::write_feature(&mut self.line, feature)?,
            GeoFormat::Wkb => wkb::write_feature(&mut self.line, feature)?,
            GeoFormat::WkbHex => {
                let mut bytes = Vec::new();
                wkb::write_feature(&mut bytes, feature)?;
                bytes.iter().try_for_each(|b| write!(self.line, "{b:02X}"))?;
                self.line.extend((!bytes.is_empty()).then_some(b'\n'));
            }
            GeoFormat::Svg | GeoFormat::TopoJson | GeoFormat::GeoParquet => {
                self.held.push(feature.clone())
            }
            GeoFormat::Shapefile | GeoFormat::FlatGeobuf | GeoFormat::Csv => {
                self.held.push(with_id(feature));
            }
            GeoFormat::GeoPackage => {
                self.package().add(feature)?;
                if self.rewrite.is_some() {
                    self.line = self.package().take();
                }
            }
            GeoFormat::Kml | GeoFormat::Gpx => return Err(unwritten(self.format)),
        }
        self.count += 1;
        Ok(self.out.write_all(&self.line)?)
    }

    fn begin_collection(&mut self) -> Result<()> {
        if self.count == 0 {
            self.out.write_all(br#"{"type":"FeatureCollection""#)?;
            geojson::write_members(&mut self.out, &self.members)?;
            self.out.write_all(br#","features":["#)?;
        }
        Ok(())
    }

    /// Ends the document with all members of the collection: members that were not in the head come after the features.
    /// Returns the target.
    ///
    /// # Errors
    /// [`crate::Error::Io`].
    pub fn finish(self, members: &[Member]) -> Result<W> {
        self.finish_all(members).map(|finished| finished.out)
    }

    /// Ends the document as [`Self::finish`] does; returns further files and warnings too.
    ///
    /// # Errors
    /// [`crate::Error::Io`]; [`crate::Error::Unsupported`] if the format cannot hold the features.
    pub fn finish_all(mut self, members: &[Member]) -> Result<Finished<W>> {
        let (mut beside, mut warnings) = Default::default();
        match self.format {
            GeoFormat::GeoJson => {
                self.head(members);
                self.begin_collection()?;
                self.out.write_all(b"\n]")?;
                for member in members.iter().filter(|m| !self.members.contains(m)) {
                    geojson::write_member(&mut self.out, member)?;
                }
                self.out.write_all(b"}\n")?;
            }
            GeoFormat::Svg => svg::write(&mut self.out, &self.held)?,
            GeoFormat::TopoJson => topojson::write(&mut self.out, &self.held, members)?,
            GeoFormat::Csv => csv::write(&mut self.out, &self.held)?,
            GeoFormat::FlatGeobuf => flatgeobuf::write(&mut self.out, &self.held, &self.system)?,
            GeoFormat::GeoParquet => geoparquet::write(&mut self.out, &self.held, &self.system)?,
            GeoFormat::GeoPackage => warnings = self.finish_package()?,
            GeoFormat::Shapefile => {
                let whole = shapefile::write(&self.held, &self.system)?;
                self.out.write_all(&whole.0)?;
                (_, beside, warnings) = whole;
            }
            GeoFormat::Kml | GeoFormat::Gpx => return Err(unwritten(self.format)),
            _ => {}
        }
        self.out.flush()?;
        Ok(Finished { out: self.out, beside, warnings })
    }
}

fn unwritten(format: GeoFormat) -> Error {
    let (what, hint) = (format!("writing {format}"), "it is only read".to_owned());
    Error::Unsupported { place: Place::Whole, what, hint }
}
