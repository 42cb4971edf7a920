//! The header of a PLY file.

use crate::text::{Cursor, Tally, quote};
use crate::{Error, Place, Result};

/// Encoding of values.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Encoding {
    Ascii,
    LittleEndian,
    BigEndian,
}

/// Type of a value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Type {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    I64,
    U64,
    F32,
    F64,
}

/// A property: one value, or a list of them.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Property {
    pub name: String,
    /// Type of the length, where this is a list.
    pub list: Option<Type>,
    pub kind: Type,
}

/// An element: `count` rows of its properties.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Element {
    pub name: String,
    pub count: u64,
    pub properties: Vec<Property>,
}

/// Declarations of a file's header.
#[derive(Debug)]
pub(super) struct Header {
    pub encoding: Encoding,
    pub elements: Vec<Element>,
    /// Pictures that `comment TextureFile` names.
    pub textures: Vec<String>,
    /// Bytes up to the data.
    pub length: usize,
    /// Lines up to the data.
    pub lines: u64,
    /// Lines that do not begin with a keyword of PLY: some writers forget `comment`.
    pub unknown: Tally,
}

impl Type {
    /// Returns the size of a binary value in bytes.
    pub fn size(self) -> u64 {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::I64 | Self::U64 | Self::F64 => 8,
        }
    }

    /// Returns the largest value of an integer type, by which colors are divided; 1 for others.
    pub fn full_scale(self) -> f64 {
        match self {
            Self::I8 => 127.0,
            Self::U8 => 255.0,
            Self::I16 => 32_767.0,
            Self::U16 => 65_535.0,
            Self::I32 => f64::from(i32::MAX),
            Self::U32 => f64::from(u32::MAX),
            Self::I64 => i64::MAX as f64,
            Self::U64 => u64::MAX as f64,
            Self::F32 | Self::F64 => 1.0,
        }
    }

    fn from_name(name: &[u8]) -> Option<Self> {
        Some(match name {
            b"char" | b"int8" => Self::I8,
            b"uchar" | b"uint8" => Self::U8,
            b"short" | b"int16" => Self::I16,
            b"ushort" | b"uint16" => Self::U16,
            b"int" | b"int32" => Self::I32,
            b"uint" | b"uint32" => Self::U32,
            b"int64" | b"longlong" => Self::I64,
            b"uint64" | b"ulonglong" => Self::U64,
            b"float" | b"float32" => Self::F32,
            b"double" | b"float64" => Self::F64,
            _ => return None,
        })
    }
}

impl Header {
    /// Returns the element of a name, in any case.
    pub fn element(&self, name: &str) -> Option<&Element> {
        self.elements.iter().find(|e| e.name.eq_ignore_ascii_case(name))
    }
}

/// Reads up to `end_header` and its line end.
pub(super) fn parse(bytes: &[u8]) -> Result<Header> {
    let mut cursor = Cursor::new(bytes);
    if cursor.word() != Some(b"ply") {
        return Err(Error::line(1, 0, "a PLY file begins with `ply`"));
    }
    let (mut encoding, mut elements) = (None, Vec::<Element>::new());
    let (mut textures, mut unknown) = (Vec::new(), Tally::default());
    loop {
        cursor.next_line();
        if cursor.at_end() {
            return Err(Error::line(cursor.line(), 0, "`end_header` is missing"));
        }
        match cursor.word() {
            Some(b"format") => encoding = Some(format(&mut cursor)?),
            Some(b"element") => elements.push(element(&mut cursor)?),
            Some(b"property") => {
                let property = property(&mut cursor)?;
                let Some(element) = elements.last_mut() else {
                    return Err(wrong(&cursor, "`property` is before any `element`".to_owned()));
                };
                element.properties.push(property);
            }
            Some(b"comment") => textures.extend(texture(&mut cursor)),
            Some(b"obj_info") | None => {}
            Some(b"end_header") => break,
            Some(_) => unknown.add(|| Place::Line(cursor.line(), 0)),
        }
    }
    cursor.rest();
    let end = cursor.offset();
    // Binary data begin right behind: `\r` belongs to the header only where `\n` follows, or where
    // the header's lines all end so.
    let length = end
        + match (bytes.get(end), bytes.get(end + 1)) {
            (Some(b'\r'), Some(b'\n')) => 2,
            (Some(b'\r' | b'\n'), _) => 1,
            _ => 0,
        };
    let Some(encoding) = encoding else {
        return Err(Error::line(
            2,
            0,
            "`format ascii|binary_little_endian|binary_big_endian 1.0` is missing",
        ));
    };
    Ok(Header { encoding, elements, textures, length, lines: cursor.line() + 1, unknown })
}

/// Returns the picture named by a comment, as VCG's library and others write it.
fn texture(cursor: &mut Cursor<'_>) -> Option<String> {
    let names = cursor.word()?.eq_ignore_ascii_case(b"TextureFile");
    let name = names.then(|| String::from_utf8_lossy(cursor.rest()).into_owned());
    name.filter(|name| !name.is_empty())
}

fn wrong(cursor: &Cursor<'_>, message: String) -> Error {
    Error::line(cursor.line(), 0, message)
}

fn format(cursor: &mut Cursor<'_>) -> Result<Encoding> {
    Ok(match cursor.word().unwrap_or_default() {
        b"ascii" => Encoding::Ascii,
        b"binary_little_endian" => Encoding::LittleEndian,
        b"binary_big_endian" => Encoding::BigEndian,
        other => {
            let message = format!(
                "`{}` is not a format; ascii, binary_little_endian and binary_big_endian are",
                quote(other)
            );
            return Err(wrong(cursor, message));
        }
    })
}

fn element(cursor: &mut Cursor<'_>) -> Result<Element> {
    let name = String::from_utf8_lossy(cursor.word().unwrap_or_default()).into_owned();
    let word = cursor.word().unwrap_or_default();
    let count = std::str::from_utf8(word).ok().and_then(|w| w.parse().ok());
    let Some(count) = count else {
        return Err(wrong(cursor, format!("`{}` is not a count of element `{name}`", quote(word))));
    };
    Ok(Element { name, count, properties: Vec::new() })
}

fn property(cursor: &mut Cursor<'_>) -> Result<Property> {
    let first = cursor.word().unwrap_or_default();
    let list = if first == b"list" { Some(kind(cursor, None)?) } else { None };
    let kind = kind(cursor, list.is_none().then_some(first))?;
    let name = String::from_utf8_lossy(cursor.word().unwrap_or_default()).into_owned();
    Ok(Property { name, list, kind })
}

fn kind(cursor: &mut Cursor<'_>, word: Option<&[u8]>) -> Result<Type> {
    let word = word.or_else(|| cursor.word()).unwrap_or_default();
    Type::from_name(word).ok_or_else(|| {
        let message = format!(
            "`{}` is not a type; char, uchar, short, ushort, int, uint, int64, uint64, float and double are",
            quote(word)
        );
        wrong(cursor, message)
    })
}
