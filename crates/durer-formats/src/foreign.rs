//! Errors of other crates in durer's words: their own mention Rust types and may quote a file's text at any length.

use crate::wording::shown;
use quick_xml::Error as Xml;
use quick_xml::errors::{IllFormedError, SyntaxError};
use std::io::ErrorKind;
use usvg::roxmltree::Error as Markup;
use zip::result::ZipError;

/// Describes a fault of XML.
pub(crate) fn xml(error: &Xml) -> String {
    match error {
        Xml::Syntax(error) => not_closed(error).to_owned(),
        Xml::IllFormed(error) => ill_formed(error),
        Xml::InvalidAttr(_) => {
            "an attribute is not written as `name=\"value\"`, or appears twice".to_owned()
        }
        Xml::Escape(_) => entity(),
        Xml::Encoding(_) => "the text is not in the encoding that it names".to_owned(),
        Xml::Namespace(_) => "a prefix of a namespace is not declared".to_owned(),
        Xml::Io(_) => "the text ends early".to_owned(),
    }
}

/// Describes a fault of an entity of XML.
pub(crate) fn entity() -> String {
    "after `&` no known entity follows; `&` itself is written `&amp;`".to_owned()
}

fn not_closed(error: &SyntaxError) -> &'static str {
    match error {
        SyntaxError::UnclosedComment => "a comment does not end with `-->`",
        SyntaxError::UnclosedCData => "a CDATA section does not end with `]]>`",
        SyntaxError::UnclosedDoctype => "the DOCTYPE does not end with `>`",
        SyntaxError::UnclosedPI | SyntaxError::UnclosedXmlDecl => {
            "a processing instruction does not end with `?>`"
        }
        SyntaxError::UnclosedTag => "a tag does not end with `>`",
        SyntaxError::InvalidBangMarkup => "`<!` is not followed by a comment, CDATA or a DOCTYPE",
        _ => "the value of an attribute does not end with a quote",
    }
}

fn mismatched(expected: &str, found: &str) -> String {
    format!("`</{}>` is found where `</{}>` is expected", shown(found), shown(expected))
}

fn ill_formed(error: &IllFormedError) -> String {
    match error {
        IllFormedError::MismatchedEndTag { expected, found } => mismatched(expected, found),
        IllFormedError::UnmatchedEndTag(name) => {
            format!("`</{}>` closes an element that was not opened", shown(name))
        }
        IllFormedError::MissingEndTag(name) => format!("`</{}>` is missing", shown(name)),
        IllFormedError::MissingDoctypeName => "the DOCTYPE has no name".to_owned(),
        _ => "it is not well-formed".to_owned(),
    }
}

/// Describes a fault of the XML of a drawing, without its place.
pub(crate) fn markup(error: &Markup) -> String {
    match error {
        Markup::UnexpectedCloseTag(expected, found, _) => mismatched(expected, found),
        Markup::UnknownNamespace(prefix, _) => {
            let prefix = shown(prefix);
            format!("the prefix of `{prefix}:` is not declared; `svg` needs `xmlns:{prefix}=\"…\"`")
        }
        Markup::UnknownEntityReference(name, _) => {
            format!("`&{};` is not a known entity; `&` itself is written `&amp;`", shown(name))
        }
        Markup::MalformedEntityReference(_) | Markup::EntityResolver(..) => entity(),
        Markup::DuplicatedAttribute(name, _) => {
            format!("an element has the attribute `{}` twice", shown(name))
        }
        Markup::DuplicatedNamespace(prefix, _) => {
            let colon = if prefix.is_empty() { "" } else { ":" };
            format!("an element has `xmlns{colon}{}` twice", shown(prefix))
        }
        Markup::NonXmlChar(c, _) => {
            format!("the character U+{:04X} is not allowed in XML", u32::from(*c))
        }
        // In an attribute's value whose end is missing.
        Markup::InvalidChar(b'"' | b'\'', b'<', _) => LESS_IN_VALUE.to_owned(),
        Markup::InvalidChar(expected, found, _) => {
            format!("`{}` is found where `{}` is expected", byte(*found), byte(*expected))
        }
        Markup::InvalidChar2(expected, found, _) => {
            let needed = expected.replace('\'', "`");
            format!("`{}` is found where {needed} is expected", byte(*found))
        }
        Markup::InvalidString(expected, _) => format!("`{expected}` is needed"),
        other => structure(other).to_owned(),
    }
}

const LESS_IN_VALUE: &str = "an attribute's value holds `<`, which is written `&lt;`";

/// Returns a byte as a message shows it.
fn byte(byte: u8) -> String {
    if byte.is_ascii_graphic() { char::from(byte).to_string() } else { format!("\\x{byte:02x}") }
}

/// Describes a fault of the XML of a drawing without quoting the text.
fn structure(error: &Markup) -> &'static str {
    match error {
        Markup::InvalidXmlPrefixUri(_)
        | Markup::UnexpectedXmlUri(_)
        | Markup::UnexpectedXmlnsUri(_)
        | Markup::InvalidElementNamePrefix(_) => {
            "the prefixes `xml` and `xmlns` are XML's own and cannot be declared"
        }
        Markup::UnexpectedEntityCloseTag(_) => "an entity ends an element that it does not begin",
        Markup::EntityReferenceLoop(_) => {
            "entities refer to each other in a circle, or too often; ten levels are allowed"
        }
        Markup::InvalidAttributeValue(_) => LESS_IN_VALUE,
        Markup::NoRootNode => "it has no element",
        Markup::UnclosedRootNode | Markup::UnexpectedEndOfStream => {
            "the text ends before all elements do"
        }
        Markup::UnexpectedDeclaration(_) => {
            "`<?xml … ?>` stands elsewhere than at the very beginning"
        }
        Markup::NodesLimitReached => TOO_MANY_ELEMENTS,
        Markup::AttributesLimitReached => "it has more attributes than are read",
        Markup::NamespacesLimitReached => "it declares more than 65,535 namespaces",
        Markup::InvalidName(_) => "a name is needed, which begins with a letter, `_` or `:`",
        Markup::InvalidExternalID(_) => {
            "after SYSTEM or PUBLIC, the DOCTYPE needs a name in quotes"
        }
        Markup::InvalidComment(_) => "a comment holds `--`, or ends with `-`",
        Markup::InvalidCharacterData(_) => "a text holds `]]>`, which is written `]]&gt;`",
        _ => "an element, a comment or text is expected here; `<` itself is written `&lt;`",
    }
}

/// The message for drawings of more elements than the library that resolves them takes.
pub(crate) const TOO_MANY_ELEMENTS: &str = "the drawing has more than 1,000,000 elements, each as often as `use` repeats it, \
    or more than 1,024 levels of them; that many are not read";

/// Describes a fault of JSON, without its place.
pub(crate) fn json(error: &serde_json::Error) -> String {
    if error.is_eof() {
        return "the text ends early".to_owned();
    }
    let text = error.to_string();
    let text = text.rsplit_once(" at line ").map_or(text.as_str(), |(text, _)| text);
    if error.is_syntax() { syntax(text).to_owned() } else { types(text) }
}

/// Describes a fault of the syntax of JSON; faults that are not in the list get a general answer.
fn syntax(text: &str) -> &'static str {
    match text {
        "expected `:`" => "`:` is needed after a name",
        "expected `,` or `]`" => "`,` or `]` is needed in a list",
        "expected `,` or `}`" => "`,` or `}` is needed in an object",
        "trailing comma" => "a comma has nothing after it",
        "trailing characters" => "something follows after the end",
        "key must be a string" => "a name in an object is not in double quotes",
        "invalid escape"
        | "lone leading surrogate in hex escape"
        | "unexpected end of hex escape" => {
            "a `\\` in a string is not followed by what JSON allows"
        }
        "invalid number" | "number out of range" => "this is not a number of JSON",
        "recursion limit exceeded" => {
            "lists and objects are nested too deep; 128 levels are allowed"
        }
        "control character (\\u0000-\\u001F) found while parsing a string" => {
            "a string holds a control character; a line break is written `\\n`"
        }
        _ => "a value is expected",
    }
}

/// Describes a value of JSON that has the wrong type.
fn types(text: &str) -> String {
    if let Some(name) = text.strip_prefix("missing field `").and_then(|t| t.strip_suffix('`')) {
        return format!("`{}` is missing", shown(name));
    }
    if let Some(name) = text.strip_prefix("duplicate field `").and_then(|t| t.strip_suffix('`')) {
        return format!("`{}` appears twice", shown(name));
    }
    let said = ["invalid type: ", "invalid value: ", "invalid length "];
    let found = said.iter().find_map(|start| text.strip_prefix(start));
    match found.and_then(|rest| rest.rsplit_once(", expected ")) {
        Some((found, needed)) => {
            format!("{} is found where {} is expected", shown(&value(found)), kind(needed))
        }
        None => shown(text).into_owned(),
    }
}

/// Returns a value that serde calls `string "x"`, ``integer `5` `` or the like.
fn value(found: &str) -> String {
    for (theirs, ours) in
        [("string ", "the text "), ("integer ", "the number "), ("floating point ", "the number ")]
    {
        if let Some(rest) = found.strip_prefix(theirs) {
            return format!("{ours}{rest}");
        }
    }
    kind(found).to_owned()
}

/// Returns the name in JSON of a type of Rust or serde.
fn kind(name: &str) -> &str {
    match name {
        "u8" | "u16" | "u32" | "u64" | "usize" => "a whole number from 0 on",
        "i8" | "i16" | "i32" | "i64" | "isize" => "a whole number",
        "f32" | "f64" => "a number",
        "a boolean" | "boolean `true`" | "boolean `false`" => "true or false",
        "a string" | "str" => "a text",
        "sequence" | "a sequence" => "a list",
        "map" | "a map" => "an object",
        "null" | "unit" | "unit value" => "null",
        _ if name.starts_with("struct ") => "an object",
        _ => name,
    }
}

/// Describes a fault of a ZIP archive, or of a part of one.
pub(crate) fn zip(error: &ZipError) -> &'static str {
    match error {
        ZipError::Io(error) => inflating(error),
        ZipError::UnsupportedArchive(why) if *why == ZipError::PASSWORD_REQUIRED => {
            "it is encrypted; save it without a password"
        }
        ZipError::InvalidPassword => "it is encrypted; save it without a password",
        ZipError::UnsupportedArchive(_) | ZipError::CompressionMethodNotSupported(_) => {
            "it is packed in a way that is not read; pack it with deflate"
        }
        ZipError::FileNotFound => "it is not in the archive",
        _ => "its directory, at the end of the file, is missing or damaged",
    }
}

/// Describes a fault of deflated data.
pub(crate) fn inflating(error: &std::io::Error) -> &'static str {
    match error.kind() {
        ErrorKind::UnexpectedEof => "the data are cut off",
        _ => "the data are damaged",
    }
}

/// The message for a picture that an encoder refuses, except for failed writes.
pub(crate) const REFUSED: &str = "this picture cannot be put into its format; write a PNG";

/// Describes a fault of a PNG, as a predicate of its name.
pub(crate) fn png(error: &png::DecodingError) -> &'static str {
    use png::DecodingError::{IoError, LimitsExceeded};
    match error {
        IoError(error) if error.kind() == ErrorKind::UnexpectedEof => "is cut off",
        LimitsExceeded => "is too large",
        _ => "holds broken PNG data",
    }
}

/// Describes a fault of a JPEG, as a predicate of its name.
pub(crate) fn jpeg(error: &zune_jpeg::errors::DecodeErrors) -> &'static str {
    use zune_jpeg::errors::DecodeErrors::{ExhaustedData, IoErrors, LargeDimensions, Unsupported};
    match error {
        ExhaustedData | IoErrors(_) => "is cut off",
        LargeDimensions(_) => "is too large",
        Unsupported(_) => "is a kind of JPEG that is not read; save it as baseline or progressive",
        _ => "holds broken JPEG data",
    }
}

/// Describes a fault of a GIF, as a predicate of its name.
pub(crate) fn gif(error: &gif::DecodingError) -> &'static str {
    use gif::DecodingError::{EndCodeNotFound, MemoryLimit, OutOfMemory, UnexpectedEof};
    match error {
        UnexpectedEof | EndCodeNotFound => "is cut off",
        MemoryLimit | OutOfMemory => "is too large",
        _ => "holds broken GIF data",
    }
}

/// Describes a fault of a WebP, as a predicate of its name.
pub(crate) fn webp(error: &image_webp::DecodingError) -> &'static str {
    use image_webp::DecodingError::{ImageTooLarge, IoError, MemoryLimitExceeded};
    match error {
        IoError(_) => "is cut off",
        ImageTooLarge | MemoryLimitExceeded => "is too large",
        _ => "holds broken WebP data",
    }
}

/// Describes a fault of an E57 file.
#[cfg(feature = "e57")]
pub(crate) fn e57(error: &e57::Error) -> &'static str {
    match error {
        e57::Error::Read { .. } => "it is cut off, or a checksum is wrong",
        e57::Error::NotImplemented { .. } => "it holds what is not read; save it with plain points",
        _ => "its header or its XML is damaged",
    }
}

/// Describes a fault of LAZ data.
#[cfg(feature = "laz")]
pub(crate) fn laz(error: &laz::LasZipError) -> &'static str {
    use laz::LasZipError as E;
    match error {
        E::IoError(_) => "they are cut off",
        E::MissingChunkTable => "their table of chunks is missing",
        _ => "they are packed in a way that is not known",
    }
}
