//! The archive: parts by name, and the relationship that names the model.

use crate::archive::Archive;
use crate::{Error, Limits, Result, foreign, xml};
use quick_xml::Reader;
use quick_xml::events::Event;
use std::borrow::Cow;

/// Path of the package's relationships.
const RELATIONSHIPS: &str = "_rels/.rels";
/// Path at which nearly all writers put the model.
const USUAL: &str = "3D/3dmodel.model";

/// An open archive.
pub(super) struct Package<'a>(Archive<&'a [u8]>);

impl<'a> Package<'a> {
    pub fn open(bytes: &'a [u8], limits: &Limits) -> Result<Self> {
        Archive::open(bytes, limits).map(Self)
    }

    /// Returns whether there is a part of this name.
    pub fn has(&self, name: &str) -> bool {
        self.0.has(name)
    }

    /// Returns the number of bytes that may still be inflated or decoded.
    pub fn left(&self) -> u64 {
        self.0.left()
    }

    /// Charges this many of the bytes that may still be decoded.
    pub fn charge(&mut self, bytes: u64) {
        self.0.charge(bytes);
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
        self.0.read(name)
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
