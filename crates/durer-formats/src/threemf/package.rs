//! The archive: parts by name, and the relationship that names the model.

use crate::budget::MODEL;
use crate::foreign;
use crate::{Error, Limits, Place, Result, xml};
use durer::work::Work;
use quick_xml::Reader;
use quick_xml::events::Event;
use std::borrow::Cow;
use std::io::{Cursor, Read};
use zip::ZipArchive;

/// Path of the package's relationships.
const RELATIONSHIPS: &str = "_rels/.rels";
/// Path at which nearly all writers put the model.
const USUAL: &str = "3D/3dmodel.model";

/// An open archive.
pub(super) struct Package<'a> {
    archive: ZipArchive<Cursor<&'a [u8]>>,
    /// Bytes that may still be inflated.
    left: u64,
    limit: u64,
    work: Work,
}

/// Memory of a part and of the data read from it, relative to its size: numbers take less than their text.
const PER_BYTE: u64 = 2;

impl<'a> Package<'a> {
    pub fn open(bytes: &'a [u8], limits: Limits) -> Result<Self> {
        let archive = ZipArchive::new(Cursor::new(bytes)).map_err(|e| {
            Error::whole(format!("the ZIP archive is broken: {}", foreign::zip(&e)))
        })?;
        let (left, limit) = (limits.decoded_bytes, limits.decoded_bytes);
        Ok(Self { archive, left, limit, work: limits.work })
    }

    /// Returns whether there is a part of this name.
    pub fn has(&self, name: &str) -> bool {
        self.number(name).is_some()
    }

    /// Returns the number of bytes that may still be inflated or decoded.
    pub fn left(&self) -> u64 {
        self.left
    }

    /// Charges this many of the bytes that may still be decoded.
    pub fn charge(&mut self, bytes: u64) {
        self.left = self.left.saturating_sub(bytes);
    }

    /// Returns the archive's number of a part; case does not count, as the Open Packaging
    /// Conventions say.
    fn number(&self, name: &str) -> Option<usize> {
        let name = name.trim_start_matches('/');
        let same = |n: &str| n.eq_ignore_ascii_case(name);
        let alike = || self.archive.file_names().position(|n| n.is_ok_and(|n| same(&n)));
        self.archive.index_for_name(name).or_else(alike)
    }

    /// Returns the inflated text of a part, as UTF-8.
    pub fn read_text(&mut self, name: &str) -> Result<Vec<u8>> {
        let bytes = self.read(name)?;
        let recoded = match xml::utf8(&bytes) {
            Cow::Borrowed(text) if text.len() == bytes.len() => None,
            text => Some(text.into_owned()),
        };
        Ok(recoded.unwrap_or(bytes))
    }

    /// Returns the inflated bytes of a part.
    pub fn read(&mut self, name: &str) -> Result<Vec<u8>> {
        let at = |message: String| Error::path(name, message);
        let number = self.number(name).ok_or_else(|| at("is not in the archive".to_owned()))?;
        let file = self.archive.by_index(number);
        let file = file.map_err(|e| at(format!("cannot be read: {}", foreign::zip(&e))))?;
        let (what, limit) = ("size of the inflated parts", self.limit);
        let too_large = |size: u64| {
            let value = (limit - self.left).saturating_add(size);
            Error::Limit { place: Place::Path(name.to_owned()), what, value, limit }
        };
        if file.size() > self.left {
            return Err(too_large(file.size()));
        }
        // The size in the archive is not trusted: no memory is allocated in advance, and reading one byte beyond the
        // limit reveals a wrong size.
        let mut bytes = Vec::new();
        let mut file = file.take(self.left.saturating_add(1));
        file.read_to_end(&mut bytes)
            .map_err(|e| at(format!("cannot be inflated: {}", foreign::inflating(&e))))?;
        if bytes.len() as u64 > self.left {
            return Err(too_large(bytes.len() as u64));
        }
        self.left -= bytes.len() as u64;
        self.work.keep(MODEL, PER_BYTE.saturating_mul(bytes.len() as u64))?;
        Ok(bytes)
    }

    /// Returns the name of the part that the package's relationships call the 3D model.
    pub fn root(&mut self) -> Result<String> {
        let Ok(xml) = self.read_text(RELATIONSHIPS) else { return Ok(USUAL.to_owned()) };
        let mut reader = Reader::from_reader(xml.as_slice());
        loop {
            let at = reader.buffer_position();
            match reader.read_event() {
                Ok(Event::Start(e) | Event::Empty(e)) => {
                    let value = |key: &str| {
                        let found = e.attributes().flatten().find(|a| a.key.as_ref() == key);
                        found.map(|a| a.value.into_owned())
                    };
                    let model = value("Type").is_some_and(|t| t.ends_with("/3dmodel"));
                    if let Some(target) = value("Target").filter(|_| model) {
                        return Ok(target.trim_start_matches('/').to_owned());
                    }
                }
                Ok(Event::Eof) => break,
                Ok(_) => {}
                Err(e) => {
                    let place = format!("{RELATIONSHIPS}, byte {at}");
                    return Err(Error::path(place, foreign::xml(&e)));
                }
            }
        }
        Err(Error::path(
            RELATIONSHIPS,
            "names no 3D model (a relationship whose type ends in /3dmodel)",
        ))
    }
}
