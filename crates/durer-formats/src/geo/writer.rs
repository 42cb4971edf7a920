//! Features to bytes in any format.

use super::{Feature, GeoFormat, Member, geojson, svg, wkb, wkt};
use crate::Result;
use std::io::Write;

/// Writes features one after the other.
///
/// All formats but SVG are written as features come. WKT and WKB keep geometry and SRID only; SVG
/// keeps ids too.
pub struct Writer<W> {
    format: GeoFormat,
    out: W,
    members: Vec<Member>,
    count: u64,
    /// What has to wait for the end.
    held: Vec<Feature>,
    line: Vec<u8>,
}

impl<W: Write> Writer<W> {
    /// A writer of a format. Nothing is written yet.
    pub fn new(format: GeoFormat, out: W) -> Self {
        Self { format, out, members: Vec::new(), count: 0, held: Vec::new(), line: Vec::new() }
    }

    /// Members for the head of a GeoJSON collection; taken until the first feature is written.
    pub fn head(&mut self, members: &[Member]) {
        if self.count == 0 {
            self.members = members.to_vec();
        }
    }

    /// Writes a feature. WKT and WKB leave out those without geometry.
    ///
    /// # Errors
    /// [`crate::Error::Io`].
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
            GeoFormat::Svg => self.held.push(feature.clone()),
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

    /// Ends the document, with all members of the collection: those that were not in the head come
    /// after the features. Gives the target back.
    ///
    /// # Errors
    /// [`crate::Error::Io`].
    pub fn finish(mut self, members: &[Member]) -> Result<W> {
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
            _ => {}
        }
        self.out.flush()?;
        Ok(self.out)
    }
}
