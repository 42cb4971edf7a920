//! Features from a stream; only the current feature is held in memory.

use super::coordinates::{Geometries, further_members};
use super::esri;
use super::object::{RawMember, Text, kind};
use super::stream::{Piece, Stream};
use crate::geo::numbered::{Label, name};
use crate::geo::system::{self, System};
use crate::geo::{Feature, Member, Warnings};
use crate::{Error, Place, Result};
use std::io::Read;

/// State of the reader.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum State {
    Between,
    /// Within the array `features` of a collection; true if features came before.
    Features(bool),
}

/// Reader of features from any sequence of GeoJSON documents.
pub struct Reader<R> {
    stream: Stream<R>,
    state: State,
    geometries: Geometries,
    /// Members of the collection or document being read.
    open: Vec<(Piece, Piece)>,
    collection: (u64, u64),
    members: Vec<Member>,
    documents: u64,
    /// Features on lines of their own, since another document came.
    in_lines: u64,
    systems: Systems,
    /// Statements of an Esri feature set about all its geometries; `None` for other documents.
    esri: Option<esri::Given>,
    /// True if the text of the feature read last has been cut out of the stream.
    is_cut: bool,
    /// Number of features that have begun.
    count: u64,
    /// The feature that has begun, and the number of warnings before it; `None` between features.
    within: Option<(Label, usize)>,
}

/// Coordinate systems of the features, which members `crs` state.
#[derive(Debug, Default)]
struct Systems {
    /// The system of the collection, if it is stated before the features.
    collection: Option<System>,
    /// The common one of the features that have been read; unknown if they have several.
    common: Option<System>,
    /// True once a warning about an unknown one has been given.
    is_reported: bool,
}

impl Systems {
    /// Reads a member `crs`; warns of the first one that cannot be read.
    fn of_member(&mut self, value: &str, place: Place, warnings: &mut Warnings) -> System {
        let found = system::of_value(value);
        if found.is_unknown()
            && value.trim() != "null"
            && !std::mem::replace(&mut self.is_reported, true)
        {
            let shown = crate::text::quote(value.as_bytes());
            let message = format!("the member crs, {shown}, names no known coordinate system");
            warnings.push(place, message);
        }
        found
    }

    /// Gives a feature the number of its system, its own or that of the collection, unless it is the one that GeoJSON
    /// assumes.
    fn stamp(&mut self, feature: &mut Feature, own: Option<System>) {
        let system = own.or_else(|| self.collection.clone()).unwrap_or(System::LONLAT);
        let is_first = self.common.is_none();
        let is_other = *self.common.get_or_insert_with(|| system.clone()) != system;
        if is_other {
            self.common = Some(System::default());
        }
        let is_plain = system == System::LONLAT && (is_first || !is_other);
        feature.srid = system.code.filter(|_| !is_plain);
    }
}

/// Name of the member for the coordinate system.
const CRS: &[u8] = system::CRS.as_bytes();

/// Number of features, one per line each, after which all others must be on single lines, too, so that a truncated line
/// is not read on to the end of the file.
const LINES: u64 = 2;

impl<R: Read> Reader<R> {
    pub fn new(source: R) -> Self {
        Self {
            stream: Stream::new(source),
            state: State::Between,
            geometries: Geometries::default(),
            open: Vec::new(),
            collection: (1, 1),
            members: Vec::new(),
            documents: 0,
            in_lines: 0,
            systems: Systems::default(),
            esri: None,
            is_cut: false,
            count: 0,
            within: None,
        }
    }

    /// Returns the common coordinate system of the features, as far as they have been read.
    pub fn system(&self) -> System {
        let stated = system::of_members(&self.members);
        stated.or_else(|| self.systems.common.clone()).unwrap_or(System::LONLAT)
    }

    /// Returns whether the text is JSON of ArcGIS, before the first feature has been read.
    pub fn is_arcgis(&mut self) -> bool {
        esri::begins(self.stream.ahead())
    }

    pub fn warnings(&mut self) -> &mut Warnings {
        &mut self.geometries.warnings
    }

    /// Returns foreign members of the collections, as far as they have been read.
    pub fn members(&self) -> &[Member] {
        &self.members
    }

    /// Returns whether the next feature can be read after an error.
    pub fn goes_on(&self) -> bool {
        self.is_cut
    }

    /// Returns the next feature, and tells in which one faults are.
    pub fn next_feature(&mut self) -> Result<Option<Feature>> {
        self.is_cut = false;
        let next = self.next_unlabelled();
        let Some((label, from)) = self.within.take() else { return next };
        self.geometries.warnings.labelled(next, label, from)
    }

    /// Notes that a feature begins.
    fn begin_feature(&mut self) {
        self.count += 1;
        self.within = Some((Label::bare(self.count), self.geometries.warnings.kept.len()));
    }

    fn next_unlabelled(&mut self) -> Result<Option<Feature>> {
        loop {
            match self.state {
                State::Between => {
                    if !self.begin()? {
                        return Ok(None);
                    }
                    if self.state == State::Between {
                        let one_line = self.stream.here.0 == self.collection.0;
                        self.in_lines = if one_line { self.in_lines + 1 } else { 0 };
                        self.stream.by_lines = self.in_lines >= LINES;
                        self.is_cut = true;
                        self.begin_feature();
                        return self.document().map(Some);
                    }
                    (self.in_lines, self.stream.by_lines) = (0, false);
                }
                State::Features(_) if self.stream.take(b']')? => {
                    if self.stream.take(b'}')? {
                        self.state = State::Between;
                    } else {
                        self.stream.expect(b',', "`,` or `}` after the features")?;
                        self.object_members()?;
                    }
                    if self.state == State::Between {
                        self.end_collection()?;
                    }
                }
                State::Features(began) => {
                    if began {
                        self.stream.expect(b',', "`,` or `]` after a feature")?;
                    }
                    self.state = State::Features(true);
                    self.begin_feature();
                    let piece = self.stream.value("a feature")?;
                    self.is_cut = true;
                    return self.feature(piece.text()).map(Some);
                }
            }
        }
    }

    /// Enters the next document, up to its end or its array of features; returns false if there is none.
    fn begin(&mut self) -> Result<bool> {
        // Byte-order mark, and the separators of RFC 8142.
        if self.documents == 0 && self.stream.peek()? == Some(0xef) {
            for byte in [0xef, 0xbb, 0xbf] {
                self.stream.expect(byte, "a document")?;
            }
            self.stream.here = (1, 1);
        }
        while self.stream.take(0x1e)? {}
        if self.stream.next()?.is_none() {
            return Ok(false);
        }
        self.documents += 1;
        (self.systems.collection, self.esri) = (None, None);
        self.collection = self.stream.here;
        self.open.clear();
        self.stream.expect(b'{', "a GeoJSON object")?;
        if !self.stream.take(b'}')? {
            self.object_members()?;
        }
        Ok(true)
    }

    /// Reads members of the document, to its end or its array of features.
    fn object_members(&mut self) -> Result<()> {
        self.state = State::Between;
        loop {
            let name = self.stream.value("a member's name")?;
            if name.bytes.first() != Some(&b'"') {
                return Err(name.text().error("the name of a member must be a string"));
            }
            self.stream.expect(b':', "`:` after a member's name")?;
            if name.bytes == b"\"features\"" && self.may_be_collection() {
                self.stream.expect(b'[', "the array of features")?;
                self.open.push((name, Piece { bytes: b"[]".to_vec(), start: self.stream.here }));
                self.state = State::Features(false);
                return self.collection_system();
            }
            let value = self.stream.value("a value")?;
            self.open.push((name, value));
            if self.stream.take(b'}')? {
                return Ok(());
            }
            self.stream.expect(b',', "`,` or `}` after a member")?;
        }
    }

    /// Notes the system of a collection that states it before its features.
    fn collection_system(&mut self) -> Result<()> {
        self.systems.collection = match self.open.iter().find(|(name, _)| name.bytes == CRS) {
            Some((_, value)) => {
                let (text, warnings) = (value.text(), &mut self.geometries.warnings);
                Some(self.systems.of_member(&text.checked()?, text.place(), warnings))
            }
            None => {
                let stated = self.open.iter().find(|(name, _)| name.bytes == esri::SYSTEM);
                stated.map(|(_, value)| esri::system(&value.bytes))
            }
        };
        if self.open.iter().any(|(name, _)| esri::is_of_set(&name.bytes)) {
            let members: Vec<RawMember<'_>> =
                self.open.iter().map(|(n, v)| (n.text(), v.text())).collect();
            self.esri = Some(esri::Given::default().of(&members));
        }
        Ok(())
    }

    /// Returns whether the object may still be a collection by the members read so far.
    fn may_be_collection(&self) -> bool {
        let kind = self.open.iter().find(|(name, _)| name.bytes == b"\"type\"");
        kind.is_none_or(|(_, value)| value.bytes == b"\"FeatureCollection\"")
    }

    fn end_collection(&mut self) -> Result<()> {
        let open = std::mem::take(&mut self.open);
        let kind = open.iter().find(|(name, _)| name.bytes == b"\"type\"");
        if kind.is_none() && self.end_of_set(&open) {
            return Ok(());
        }
        if kind.is_none_or(|(_, value)| value.bytes != b"\"FeatureCollection\"") {
            let (line, column) = self.collection;
            return Err(Error::line(
                line,
                column,
                "an object with features needs \"type\": \"FeatureCollection\"",
            ));
        }
        for (name, value) in &open {
            if !matches!(&name.bytes[..], b"\"type\"" | b"\"features\"" | b"\"bbox\"") {
                let (name, text) = (name.text().checked()?, value.text());
                let value = text.checked()?;
                if name.as_bytes() == CRS {
                    self.systems.of_member(&value, text.place(), &mut self.geometries.warnings);
                }
                self.members.push(Member { name, value });
            }
        }
        Ok(())
    }

    /// Ends the feature set of Esri; returns whether it is one.
    fn end_of_set(&mut self, open: &[(Piece, Piece)]) -> bool {
        let is_set = open.iter().any(|(name, _)| esri::is_of_set(&name.bytes));
        for (name, value) in open.iter().filter(|_| is_set || self.esri.is_some()) {
            if name.bytes == b"\"exceededTransferLimit\"" {
                let place = value.text().place();
                esri::warn_of_limit(&value.bytes, place, &mut self.geometries.warnings);
            }
            // A system that is stated behind the features.
            let late = name.bytes == esri::SYSTEM && self.systems.collection.is_none();
            self.members.extend(late.then(|| esri::system(&value.bytes).member()).flatten());
        }
        is_set || self.esri.is_some()
    }

    /// Returns the document whose members have been read.
    fn document(&mut self) -> Result<Feature> {
        let open = std::mem::take(&mut self.open);
        let members: Vec<RawMember<'_>> = open.iter().map(|(n, v)| (n.text(), v.text())).collect();
        let whole = Text::new(b"", self.collection);
        self.interpret(whole, &members)
    }

    fn feature(&mut self, text: Text<'_>) -> Result<Feature> {
        self.interpret(text, &text.members()?)
    }

    /// Returns a feature with the number of its system.
    fn interpret(&mut self, whole: Text<'_>, members: &[RawMember<'_>]) -> Result<Feature> {
        let mut feature = match self.bare(whole, members) {
            Ok(feature) => feature,
            Err(error) => {
                self.name_broken(members);
                return Err(error);
            }
        };
        let further = feature.members.iter().chain(&feature.geometry_members);
        let own = further.into_iter().find(|member| member.name.as_bytes() == CRS);
        let warnings = &mut self.geometries.warnings;
        let own = own.map(|own| self.systems.of_member(&own.value, whole.place(), warnings));
        let own = if kind(members).is_some() {
            own
        } else {
            // Without a statement it is not longitude and latitude, as in GeoJSON.
            let common = || self.systems.collection.is_none().then(System::default);
            own.or_else(|| esri::own_system(members)).or_else(common)
        };
        self.systems.stamp(&mut feature, own);
        Ok(feature)
    }

    /// Notes the name of a feature that cannot be read. A document of no type that is known is no feature.
    fn name_broken(&mut self, members: &[RawMember<'_>]) {
        let value = |name: &[u8]| {
            let found = members.iter().rfind(|(known, _)| known.as_bytes() == name);
            found.map(|(_, value)| *value)
        };
        if self.count == 1 && self.state == State::Between && value(b"\"geometry\"").is_none() {
            self.within = None;
        } else if let Some((label, _)) = &mut self.within {
            let properties = value(b"\"properties\"").or_else(|| value(b"\"attributes\""));
            let id = value(b"\"id\"").and_then(|id| std::str::from_utf8(id.as_bytes()).ok());
            label.name = name(id, || properties.map(fields).unwrap_or_default());
        }
    }

    fn bare(&mut self, whole: Text<'_>, members: &[RawMember<'_>]) -> Result<Feature> {
        let Some(kind) = kind(members) else {
            if self.esri.is_some() || esri::is_one(members) {
                let given = *self.esri.get_or_insert_default();
                return esri::feature(&mut self.geometries, members, given);
            }
            let message = foreign(members).or_else(|| esri::error_of_server(members));
            let needed = "a GeoJSON object needs the member \"type\", a string";
            return Err(whole.error(message.unwrap_or_else(|| needed.to_owned())));
        };
        match &kind[..] {
            "Feature" => self.members_of_feature(whole, members),
            "Topology" => {
                let hint = "a file of it is read as such; --from topojson says so";
                Err(unsupported(whole.place(), "TopoJSON within GeoJSON", hint))
            }
            "FeatureCollection" => {
                Err(whole.error("a FeatureCollection needs features, and cannot be a feature"))
            }
            _ => {
                let geometry = self.geometries.geometry(&kind, whole, members)?;
                let geometry = geometry.ok_or_else(|| {
                    let kind = crate::text::quote(kind.as_bytes());
                    whole.error(format!("`{kind}` is not a type of GeoJSON"))
                })?;
                let geometry_members = further_members(members)?;
                Ok(Feature { geometry_members, ..Feature::of_geometry(geometry) })
            }
        }
    }

    fn members_of_feature(
        &mut self,
        whole: Text<'_>,
        members: &[RawMember<'_>],
    ) -> Result<Feature> {
        let mut feature = Feature::default();
        let mut has_geometry = false;
        for (name, value) in members {
            match name.as_bytes() {
                b"\"type\"" | b"\"bbox\"" => {}
                b"\"geometry\"" => {
                    has_geometry = true;
                    if !value.is_null() {
                        feature.geometry = Some(self.geometries.object(*value, 0)?);
                        feature.geometry_members = std::mem::take(&mut self.geometries.further);
                    }
                }
                b"\"properties\"" if value.is_null() => feature.properties = None,
                b"\"properties\"" if value.as_bytes().first() == Some(&b'{') => {
                    let (properties, lost) = value.checked_without_nan()?;
                    (0..lost).for_each(|_| self.geometries.warnings.nan.add(|| value.place()));
                    feature.properties = Some(properties);
                }
                b"\"properties\"" => {
                    return Err(value.error("properties must be an object or null"));
                }
                b"\"id\"" if value.is_null() => {}
                b"\"id\"" => feature.id = Some(value.checked()?),
                _ => {
                    let name = name.checked()?;
                    feature.members.push(Member { name, value: value.checked()? });
                }
            }
        }
        if has_geometry {
            Ok(feature)
        } else {
            Err(whole.error("a Feature needs the member \"geometry\""))
        }
    }
}

/// Returns the members of an object; none of a broken one.
fn fields(object: Text<'_>) -> Vec<Member> {
    let text = |text: Text<'_>| String::from_utf8_lossy(text.as_bytes()).into_owned();
    let members = object.members().unwrap_or_default().into_iter();
    members.map(|(name, value)| Member { name: text(name), value: text(value) }).collect()
}

/// Returns a message about OpenStreetMap's JSON.
fn foreign(members: &[RawMember<'_>]) -> Option<String> {
    let has = |name: &str| members.iter().any(|(known, _)| known.as_bytes() == name.as_bytes());
    let is_osm = has("\"elements\"") && (has("\"osm3s\"") || has("\"generator\""));
    let message = "this is OpenStreetMap's JSON; convert it to GeoJSON (osmtogeojson does)";
    is_osm.then(|| message.to_owned())
}

fn unsupported(place: Place, what: &str, hint: &str) -> Error {
    Error::Unsupported { place, what: what.to_owned(), hint: hint.to_owned() }
}
