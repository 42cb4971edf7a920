//! Features from a file.

use super::table::{Table, Vector};
use super::{HEAD, column, index, sniff};
use crate::geo::geojson::{finish_line, finish_ring};
use crate::geo::members::{object, quoted};
use crate::geo::{
    Dimensions, Feature, Geometry, MAX_DEPTH, Member, Points, System, Warnings, crs, number,
};
use crate::text::Tally;
use crate::{Error, Place, Result};
use durer::math::{DVec2, Rect};

/// A field of all features.
#[derive(Debug, Clone)]
struct Column {
    key: String,
    kind: u8,
}

/// Reader of the features of a file.
pub struct Reader {
    bytes: Vec<u8>,
    at: usize,
    /// The index: its bytes, how many features it is of, and how many children nodes have.
    index: (std::ops::Range<usize>, u64, u16),
    /// The places that are read, the last one first, where not all are.
    chosen: Option<Vec<usize>>,
    columns: Vec<Column>,
    /// The kind of all geometries; 0 where each says its own.
    kind: u8,
    has_z: bool,
    has_m: bool,
    /// System that the header states.
    pub system: System,
    binary: Tally,
    infinite: Tally,
}

impl Reader {
    /// Reads the header.
    ///
    /// # Errors
    /// If there is none.
    pub fn new(bytes: Vec<u8>) -> Result<Self> {
        if !sniff(&bytes) {
            return Err(Error::byte(0, "a FlatGeobuf of version 3 is expected"));
        }
        let wrong = |message: &str| Error::byte(HEAD as u64, message);
        let (start, end) =
            piece(&bytes, HEAD).ok_or_else(|| wrong("the file ends within its header"))?;
        let header = bytes.get(start..end).and_then(Table::root);
        let header = header.ok_or_else(|| wrong("the header cannot be read"))?;
        let columns = columns(&header, 7);
        let (count, width) = (header.u64(8).unwrap_or(0), header.u16(9).unwrap_or(16));
        let after =
            usize::try_from(index::size(count, width)).ok().and_then(|size| end.checked_add(size));
        let at = after.filter(|&at| at <= bytes.len());
        let at = at.ok_or_else(|| Error::byte(end as u64, "the file ends within its index"))?;
        let (kind, system) = (header.u8(2).unwrap_or(0), system(&header));
        let (has_z, has_m) = (header.u8(3) == Some(1), header.u8(4) == Some(1));
        let (binary, infinite) = Default::default();
        let (index, chosen) = ((end..at, count, width), None);
        Ok(Self { index, chosen, columns, kind, has_z, has_m, system, at, bytes, binary, infinite })
    }

    /// Restricts reading to features whose boxes meet a window, before the first one; nothing happens if there is no
    /// index.
    pub fn choose(&mut self, window: &Rect) {
        let (place, count, width) = &self.index;
        let bytes = self.bytes.get(place.clone()).unwrap_or_default();
        let Some(found) = index::search(bytes, *count, *width, window) else { return };
        let at = |offset: u64| usize::try_from(offset).ok()?.checked_add(self.at);
        self.chosen = found.into_iter().rev().map(at).collect();
    }

    /// Returns whether only some features are read, so that their numbers are unknown.
    pub fn is_chosen(&self) -> bool {
        self.chosen.is_some()
    }

    /// Returns the next feature; `None` at the end.
    pub fn next_feature(&mut self, warnings: &mut Warnings) -> Result<Option<Feature>> {
        if let Some(chosen) = &mut self.chosen {
            self.at = chosen.pop().unwrap_or(self.bytes.len());
        }
        let Some((start, end)) = piece(&self.bytes, self.at) else {
            if self.at < self.bytes.len() {
                let message = "the file ends within a feature, which is left out";
                warnings.push(Place::Byte(self.at as u64), message);
                self.at = self.bytes.len();
            }
            self.warn(warnings);
            return Ok(None);
        };
        let place = Place::Byte(self.at as u64);
        self.at = end;
        let bytes = self.bytes.get(start..end).unwrap_or_default();
        let table = Table::root(bytes)
            .ok_or_else(|| Error::byte(start as u64, "the feature cannot be read"))?;
        let own = columns(&table, 2);
        let columns = if own.is_empty() { &self.columns } else { &own };
        let fields = fields(table.bytes(1).unwrap_or_default(), columns, &mut self.binary, &place)?;
        let mut shapes = Shapes {
            left: bytes.len() / 16,
            place: &place,
            warnings,
            header: (self.has_z, self.has_m),
        };
        let geometry =
            table.table(0).map(|table| shapes.geometry(&table, self.kind, 0)).transpose()?;
        let geometry = geometry.filter(|geometry| {
            let finite = is_finite(geometry);
            if !finite {
                self.infinite.add(|| place.clone());
            }
            finite
        });
        let properties = (!columns.is_empty()).then(|| object(&fields));
        Ok(Some(Feature { geometry, properties, srid: self.system.code, ..Feature::default() }))
    }

    fn warn(&mut self, warnings: &mut Warnings) {
        let [binary, infinite] = [&mut self.binary, &mut self.infinite].map(std::mem::take);
        warnings.add_counted(binary, "binary value is left out", "binary values are left out");
        warnings.add_counted(
            infinite,
            "geometry has coordinates that are not finite; left out",
            "geometries have coordinates that are not finite; left out",
        );
    }
}

fn is_finite(geometry: &Geometry) -> bool {
    let mut finite = true;
    geometry.for_each(&mut |points| {
        finite &= points.xy.iter().all(|p| p.is_finite());
        finite &= points.zm.iter().all(|zm| zm.iter().all(|n| n.is_finite()));
    });
    finite
}

/// Returns the bytes of a piece after its length, which is at `at`.
fn piece(bytes: &[u8], at: usize) -> Option<(usize, usize)> {
    let length = u32::from_le_bytes(*bytes.get(at..)?.first_chunk()?) as usize;
    let start = at + 4;
    let end = start.checked_add(length)?;
    (end <= bytes.len()).then_some((start, end))
}

fn columns(table: &Table<'_>, slot: usize) -> Vec<Column> {
    let column = |table: Table<'_>| Column {
        key: table.text(0).unwrap_or_default(),
        kind: table.u8(1).unwrap_or(column::BYTE),
    };
    table.tables(slot).flatten().map(column).collect()
}

fn system(header: &Table<'_>) -> System {
    let Some(table) = header.table(10) else { return System::default() };
    let code = table.i32(1).filter(|code| *code > 0);
    let wkt = table.text(4).filter(|text| !text.is_empty());
    System { code: code.or_else(|| crs::code_of_wkt(wkt.as_deref()?)), wkt }
}

/// Returns the values of a feature: numbers of columns, each followed by a value. Columns without one
/// are null.
fn fields(
    bytes: &[u8],
    columns: &[Column],
    binary: &mut Tally,
    place: &Place,
) -> Result<Vec<Member>> {
    let wrong = |what: &str| Error::Decode { place: place.clone(), message: what.to_owned() };
    let mut values = vec![None; columns.len()];
    let mut rest = bytes;
    while let Some((number, after)) = rest.split_first_chunk() {
        let number = usize::from(u16::from_le_bytes(*number));
        let (column, own) = columns
            .get(number)
            .zip(values.get_mut(number))
            .ok_or_else(|| wrong("a value belongs to a column that does not exist"))?;
        let (value, after) = value(column.kind, after)
            .ok_or_else(|| wrong("the values of a feature end within one"))?;
        if value.is_none() {
            binary.add(|| place.clone());
        }
        *own = value;
        rest = after;
    }
    let readable = columns.iter().zip(values).filter(|(column, _)| column.kind != column::BINARY);
    Ok(readable
        .map(|(column, value)| Member::new(&column.key, value.unwrap_or_else(|| "null".to_owned())))
        .collect())
}

/// Returns a value as JSON, `None` if it is binary, and the bytes after it.
fn value(kind: u8, bytes: &[u8]) -> Option<(Option<String>, &[u8])> {
    macro_rules! number {
        ($type:ty) => {{
            let (own, rest) = bytes.split_first_chunk()?;
            Some((Some(<$type>::from_le_bytes(*own).to_string()), rest))
        }};
    }
    match kind {
        column::BYTE => number!(i8),
        column::UBYTE => number!(u8),
        column::BOOL => {
            bytes.split_first().map(|(own, rest)| (Some((*own != 0).to_string()), rest))
        }
        column::SHORT => number!(i16),
        column::USHORT => number!(u16),
        column::INT => number!(i32),
        column::UINT => number!(u32),
        column::LONG => number!(i64),
        column::ULONG => number!(u64),
        column::FLOAT => {
            let (own, rest) = bytes.split_first_chunk()?;
            // The shortest decimal that identifies it.
            let short = f32::from_le_bytes(*own).to_string().parse().unwrap_or(f64::NAN);
            Some((Some(number::json(short)), rest))
        }
        column::DOUBLE => {
            let (own, rest) = bytes.split_first_chunk()?;
            Some((Some(number::json(f64::from_le_bytes(*own))), rest))
        }
        column::STRING | column::JSON | column::DATE_TIME | column::BINARY => {
            let (length, rest) = bytes.split_first_chunk()?;
            let (own, rest) = rest.split_at_checked(u32::from_le_bytes(*length) as usize)?;
            let text = String::from_utf8_lossy(own);
            let json = match kind {
                column::BINARY => None,
                column::JSON if serde_json::from_str::<serde::de::IgnoredAny>(&text).is_ok() => {
                    Some(text.trim().to_owned())
                }
                _ => Some(quoted(&text)),
            };
            Some((json, rest))
        }
        _ => None,
    }
}

/// Maker of geometries from a feature's tables.
struct Shapes<'a> {
    /// Positions and parts that the feature's bytes have room for.
    left: usize,
    place: &'a Place,
    warnings: &'a mut Warnings,
    /// True if the header says that there are heights and measures.
    header: (bool, bool),
}

impl Shapes<'_> {
    fn wrong(&self, message: &str) -> Error {
        Error::Decode { place: self.place.clone(), message: message.to_owned() }
    }

    /// Counts warnings, so that one that is printed once is not built many times.
    fn charge(&mut self, count: usize) -> Result<()> {
        let left = self.left.checked_sub(count);
        self.left =
            left.ok_or_else(|| self.wrong("parts of the geometry are given more than once"))?;
        Ok(())
    }

    fn geometry(&mut self, table: &Table<'_>, kind: u8, depth: usize) -> Result<Geometry> {
        if depth > MAX_DEPTH {
            return Err(self.wrong("geometries are nested too deep"));
        }
        self.charge(usize::from(depth > 0))?;
        let kind = if kind == 0 { table.u8(6).unwrap_or(0) } else { kind };
        Ok(match kind {
            1 => Geometry::Point(self.all(table)?),
            2 => {
                let mut line = self.all(table)?;
                finish_line(&mut line, || self.place.clone(), self.warnings);
                Geometry::LineString(line)
            }
            3 | 17 => Geometry::Polygon(self.rings(table)?),
            4 => Geometry::MultiPoint(self.all(table)?),
            5 => {
                let mut lines = self.runs(table)?;
                lines
                    .iter_mut()
                    .for_each(|line| finish_line(line, || self.place.clone(), self.warnings));
                lines.retain(|line| !line.is_empty());
                Geometry::MultiLineString(lines)
            }
            6 | 16 => {
                let mut polygons = Vec::new();
                for part in table.tables(7) {
                    self.charge(1)?;
                    polygons.push(
                        self.rings(&part.ok_or_else(|| self.wrong("a part cannot be read"))?)?,
                    );
                }
                polygons.retain(|rings| !rings.is_empty());
                Geometry::MultiPolygon(polygons)
            }
            7 => {
                let mut parts = Vec::new();
                for part in table.tables(7) {
                    let part = part.ok_or_else(|| self.wrong("a part cannot be read"))?;
                    parts.push(self.geometry(&part, 0, depth + 1)?);
                }
                Geometry::Collection(parts)
            }
            _ => {
                let what = format!("geometry of kind {kind}");
                let hint = "points, lines, polygons and their collections are read".to_owned();
                return Err(Error::Unsupported { place: self.place.clone(), what, hint });
            }
        })
    }

    fn all(&mut self, table: &Table<'_>) -> Result<Points> {
        let Some(xy) = table.vector(1, 8) else { return Ok(Points::default()) };
        self.run(table, &xy, 0, xy.len / 2)
    }

    /// Returns the positions from one to another.
    fn run(
        &mut self,
        table: &Table<'_>,
        xy: &Vector<'_>,
        from: usize,
        to: usize,
    ) -> Result<Points> {
        self.charge(to.saturating_sub(from))?;
        let [z, m] = [(self.header.0, 2), (self.header.1, 3)]
            .map(|(there, slot)| table.vector(slot, 8).filter(|v| there && v.len > 0));
        let mut points = Points::new(Dimensions::new(z.is_some(), m.is_some()));
        let further = |vector: &Option<Vector<'_>>, i| vector.and_then(|v| v.f64(i)).unwrap_or(0.0);
        for i in from..to {
            let (Some(x), Some(y)) = (xy.f64(2 * i), xy.f64(2 * i + 1)) else {
                return Err(self.wrong("a part ends beyond the positions"));
            };
            points.push(DVec2::new(x, y), [further(&z, i), further(&m, i)]);
        }
        Ok(points)
    }

    /// Returns the positions of all parts, which a list of ends parts.
    fn runs(&mut self, table: &Table<'_>) -> Result<Vec<Points>> {
        let Some(xy) = table.vector(1, 8) else { return Ok(Vec::new()) };
        let Some(ends) = table.vector(0, 4).filter(|ends| ends.len > 1) else {
            return Ok(vec![self.run(table, &xy, 0, xy.len / 2)?]);
        };
        let (mut runs, mut start) = (Vec::new(), 0);
        for i in 0..ends.len {
            let end = ends.u32(i).unwrap_or(0) as usize;
            self.charge(usize::from(end <= start))?;
            runs.push(self.run(table, &xy, start, end)?);
            start = end;
        }
        Ok(runs)
    }

    fn rings(&mut self, table: &Table<'_>) -> Result<Vec<Points>> {
        let (mut rings, mut lost) = (Vec::new(), false);
        for (i, mut ring) in self.runs(table)?.into_iter().enumerate() {
            finish_ring(&mut ring, || self.place.clone(), self.warnings);
            lost |= i == 0 && ring.is_empty();
            if !lost && !ring.is_empty() {
                rings.push(ring);
            }
        }
        Ok(rings)
    }
}
