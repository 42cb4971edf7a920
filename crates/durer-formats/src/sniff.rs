//! The detection of a model's format: by its content first, then by its name.

use crate::archive::{self, Member};
use crate::geo::GeoFormat;
use crate::text::{Cursor, utf8};
use crate::{
    Error, Model, Place, ReadOptions, Resources, Result, collada, e57, fbx, gltf, gzip, image, las,
    obj, off, ply, stl, threemf, unread, xyz,
};

/// Number of bytes of a file that are examined.
const PROBE: usize = 64 << 10;

/// A format of models.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum ModelFormat {
    /// glTF 2.0, text or binary.
    Gltf,
    /// Wavefront OBJ.
    Obj,
    /// STL, ascii or binary.
    Stl,
    /// PLY, ascii or binary.
    Ply,
    /// 3D Manufacturing Format.
    ThreeMf,
    /// COLLADA 1.4 and 1.5.
    Collada,
    /// FBX; read with the feature `fbx`.
    Fbx,
    /// Geomview's OFF, as text.
    Off,
    /// LAS and LAZ.
    Las,
    /// E57.
    E57,
    /// Points as text; detected by the name, or by lines of numbers if neither name nor content determine another.
    Xyz,
}

impl ModelFormat {
    /// All formats that are read, in the order in which messages list them.
    pub const ALL: [Self; if cfg!(feature = "fbx") { 11 } else { 10 }] = [
        Self::Gltf,
        Self::Obj,
        Self::Stl,
        Self::Ply,
        Self::ThreeMf,
        Self::Collada,
        #[cfg(feature = "fbx")]
        Self::Fbx,
        Self::Off,
        Self::Las,
        Self::E57,
        Self::Xyz,
    ];

    /// Returns its usual name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Gltf => "glTF",
            Self::Obj => "OBJ",
            Self::Stl => "STL",
            Self::Ply => "PLY",
            Self::ThreeMf => "3MF",
            Self::Collada => "COLLADA",
            Self::Fbx => "FBX",
            Self::Off => "OFF",
            Self::Las => "LAS",
            Self::E57 => "E57",
            Self::Xyz => "points as text",
        }
    }

    /// Returns the endings of its files' names, lower case, without a dot.
    pub fn suffixes(self) -> &'static [&'static str] {
        match self {
            Self::Gltf => &["gltf", "glb"],
            Self::Obj => &["obj"],
            Self::Stl => &["stl"],
            Self::Ply => &["ply"],
            Self::ThreeMf => &["3mf"],
            Self::Collada => &["dae"],
            Self::Fbx => &["fbx"],
            Self::Off => &["off"],
            Self::Las => &["las", "laz"],
            Self::E57 => &["e57"],
            Self::Xyz => &["xyz", "xyzrgb", "pts", "asc", "txt", "csv"],
        }
    }

    /// Returns the format that the content speaks for, if any does.
    pub fn of_content(bytes: &[u8]) -> Option<Self> {
        if is_gltf(bytes) {
            Some(Self::Gltf)
        } else if ply::sniff(bytes) {
            Some(Self::Ply)
        } else if bytes.starts_with(archive::MAGIC) {
            Some(Self::ThreeMf)
        } else if collada::sniff(bytes.get(..PROBE).unwrap_or(bytes)) {
            Some(Self::Collada)
        } else if fbx::sniff(bytes) {
            Some(Self::Fbx)
        } else if las::sniff(bytes) {
            Some(Self::Las)
        } else if e57::sniff(bytes) {
            Some(Self::E57)
        } else if stl::sniff(bytes) {
            Some(Self::Stl)
        } else if off::sniff(bytes) {
            Some(Self::Off)
        } else {
            is_obj(bytes).then_some(Self::Obj)
        }
    }

    /// Returns whether a file with this beginning has none of the formats that are tested before STL.
    pub(crate) fn may_be_stl(head: &[u8]) -> bool {
        let other: [&[u8]; 5] =
            [b"glTF", b"PK\x03\x04", b"LASF", e57::MAGIC, b"Kaydara FBX Binary"];
        !other.iter().any(|magic| head.starts_with(magic))
            && !starts_as_json(head)
            && !ply::sniff(head)
    }

    /// Returns the format that a file's name speaks for, if any does; `.gz` at its end does not count.
    pub fn of_name(name: &str) -> Option<Self> {
        let (_, suffix) = gzip::stem(name).rsplit_once('.')?;
        let suffix = suffix.to_ascii_lowercase();
        Self::ALL.into_iter().find(|f| f.suffixes().contains(&suffix.as_str()))
    }
}

/// Returns whether the bytes are glTF: binary by its magic, text by an object with the key that it must have.
fn is_gltf(bytes: &[u8]) -> bool {
    bytes.starts_with(b"glTF") || (starts_as_json(bytes) && has_member(bytes, b"asset"))
}

/// Returns whether the outermost object of a JSON text has a member of this name.
fn has_member(text: &[u8], name: &[u8]) -> bool {
    let (mut depth, mut string, mut escaped) = (0_u64, None, false);
    for (i, byte) in text.iter().enumerate() {
        match (string, byte) {
            _ if std::mem::take(&mut escaped) => {}
            (Some(_), b'\\') => escaped = true,
            (Some(start), b'"') => {
                string = None;
                let follows = || text.get(i + 1..).unwrap_or_default().trim_ascii_start();
                if depth == 1 && text.get(start..i) == Some(name) && follows().starts_with(b":") {
                    return true;
                }
            }
            (Some(_), _) => {}
            (None, b'"') => string = Some(i + 1),
            (None, b'{' | b'[') => depth += 1,
            (None, b'}' | b']') => depth = depth.saturating_sub(1),
            _ => {}
        }
    }
    false
}

fn starts_as_json(bytes: &[u8]) -> bool {
    let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    text.trim_ascii_start().starts_with(b"{")
}

/// Returns whether the first statement that is neither a comment nor empty is one of OBJ's.
fn is_obj(bytes: &[u8]) -> bool {
    let text = utf8(bytes.get(..PROBE).unwrap_or(bytes));
    let mut cursor = Cursor::new(&text);
    while !cursor.at_end() {
        match cursor.word() {
            None => cursor.next_line(),
            Some(b"v" | b"vt" | b"vn" | b"f" | b"l" | b"p") => {
                return cursor.float().is_ok_and(|n| n.is_some());
            }
            Some(word) => {
                return matches!(word, b"mtllib" | b"usemtl" | b"o" | b"g" | b"s");
            }
        }
    }
    false
}

/// Reads a model of any known format: by its content, or where that says nothing, by the suffix of
/// `name`. The file may be compressed by gzip, or be the only model of a ZIP archive, whose other files it may use.
///
/// # Errors
/// [`Error::Unknown`] if neither content nor name determines the format; [`Error::Decode`] for broken gzip,
/// [`Error::Limit`] if it unpacks to more than `options.limits.decoded_bytes`; else those of the reader: [`obj::read`],
/// [`stl::read`], [`ply::read`], [`threemf::read`], [`collada::read`], [`fbx::read`], [`off::read`], [`las::read`],
/// [`e57::read`], [`xyz::read`].
pub fn read_model(
    bytes: &[u8],
    name: &str,
    resources: &dyn Resources,
    options: &ReadOptions,
) -> Result<Model> {
    let bytes = &*gzip::unpacked(bytes, &options.limits)?;
    let packed = bytes.starts_with(archive::MAGIC);
    if let (true, Some(unread)) = (packed, unread::of_name(name)) {
        return Err(unread);
    }
    if !packed || is_3mf(bytes) {
        return read_unpacked(bytes, name, resources, options);
    }
    let Member { name, bytes, beside, .. } = archive::only(
        bytes,
        &options.limits,
        is_name_of_model,
        ("models", None, "unpack it, or pack one alone"),
    )?;
    read_unpacked(&bytes, &name, &beside, options).map_err(|error| {
        error.at(|place| match place {
            Place::Whole => Place::Path(name),
            inner => Place::Path(format!("{name}, {}", inner.to_string().trim_end_matches(": "))),
        })
    })
}

/// Returns whether an archive is 3MF, or broken.
fn is_3mf(bytes: &[u8]) -> bool {
    let of_3mf = |name: &String| name == "[Content_Types].xml" || name.starts_with("3D/");
    archive::names(std::io::Cursor::new(bytes)).map_or(true, |names| names.iter().any(of_3mf))
}

/// Returns whether a file in an archive is a model by its name; texts and tables are more likely something else.
pub fn is_name_of_model(name: &str) -> bool {
    let lower = name.to_ascii_lowercase();
    let is_text = || [".txt", ".csv", ".asc"].iter().any(|suffix| lower.ends_with(suffix));
    ModelFormat::of_name(name).is_some_and(|format| format != ModelFormat::Xyz || !is_text())
}

/// Reads a model whose file is not compressed.
fn read_unpacked(
    bytes: &[u8],
    name: &str,
    resources: &dyn Resources,
    options: &ReadOptions,
) -> Result<Model> {
    let content = ModelFormat::of_content(bytes);
    if let (None, Some(unread)) = (content, unread::of_content(bytes)) {
        return Err(unread);
    }
    let points = || xyz::sniff(bytes).then_some(ModelFormat::Xyz);
    match content.or_else(|| ModelFormat::of_name(name)).or_else(points) {
        Some(ModelFormat::Gltf) => gltf::read(bytes, resources, options),
        Some(ModelFormat::Obj) => obj::read(bytes, resources, options),
        Some(ModelFormat::Stl) => stl::read(bytes, resources, options),
        Some(ModelFormat::Ply) => ply::read(bytes, resources, options),
        Some(ModelFormat::ThreeMf) => threemf::read(bytes, resources, options),
        Some(ModelFormat::Collada) => collada::read(bytes, resources, options),
        Some(ModelFormat::Fbx) => fbx::read(bytes, resources, options),
        Some(ModelFormat::Off) => off::read(bytes, resources, options),
        Some(ModelFormat::Las) => las::read(bytes, resources, options),
        Some(ModelFormat::E57) => e57::read(bytes, resources, options),
        Some(ModelFormat::Xyz) => xyz::read(bytes, resources, options),
        None if bytes.is_empty() => Err(Error::Unknown(unknown(bytes))),
        None => Err(unread::of_name(name).unwrap_or_else(|| Error::Unknown(unknown(bytes)))),
    }
}

fn unknown(bytes: &[u8]) -> String {
    let formats = ModelFormat::ALL.map(|f| format!("{} (.{})", f.name(), f.suffixes().join(" .")));
    let what = if bytes.is_empty() {
        "the file is empty".to_owned()
    } else if Cursor::new(bytes).word() == Some(b"newmtl") {
        "this is a material library; open the OBJ file that uses it".to_owned()
    } else if let Some(flat) = flat(bytes) {
        format!("this is {}, which has no surfaces; `draw` draws it", flat.name())
    } else if image::is_picture(bytes) {
        "this is a picture".to_owned()
    } else {
        "neither content nor name tell".to_owned()
    };
    format!("{what}; models are read from {}", formats.join(", "))
}

/// Returns the format of drawings or map data that the bytes are in without doubt.
fn flat(bytes: &[u8]) -> Option<GeoFormat> {
    use GeoFormat::{Csv, GeoJson, Svg, Wkb, WkbHex};
    let head = bytes.get(..PROBE).unwrap_or(bytes);
    let has = |part: &[u8]| head.windows(part.len()).any(|window| window == part);
    GeoFormat::of_content(bytes).filter(|format| match format {
        Csv | Wkb | WkbHex => false,
        // Any XML is taken for SVG, and any JSON for GeoJSON.
        Svg => has(b"<svg") || has(b":svg"),
        GeoJson => has(b"\"Feature") || has(b"\"coordinates\"") || has(b"\"geometries\""),
        _ => true,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::NoResources;

    #[test]
    fn content_goes_before_name() {
        let binary_stl = [&b"solid"[..], &[0; 79]].concat();
        for (content, expected) in [
            (&b"glTF\x02"[..], Some(ModelFormat::Gltf)),
            (b"\n{ \"asset\": {} }", Some(ModelFormat::Gltf)),
            (b"{}", None),
            (b"{\"a\\\"\": [{\"b\": 1}], \"asset\" : {}}", Some(ModelFormat::Gltf)),
            // Map data whose features have a property of that name.
            (b"{\"type\": \"Feature\", \"properties\": {\"asset\": 1}}", None),
            (b"{\"type\": \"asset\"}", None),
            (b"ply\r\n", Some(ModelFormat::Ply)),
            (b"PK\x03\x04", Some(ModelFormat::ThreeMf)),
            (
                b"\xef\xbb\xbf<?xml version=\"1.0\"?>\n<!-- x -->\n<COLLADA",
                Some(ModelFormat::Collada),
            ),
            (b"<\0C\0O\0L\0L\0A\0D\0A\0", Some(ModelFormat::Collada)),
            (b"<svg/>", None),
            (b" solid x\nfacet", Some(ModelFormat::Stl)),
            (&binary_stl, Some(ModelFormat::Stl)),
            (b"# text\r\n\r\n  v 1 2 3\n", Some(ModelFormat::Obj)),
            (b"\xff\xfev\0 \0\x31\0", Some(ModelFormat::Obj)),
            (b"mtllib a.mtl\n", Some(ModelFormat::Obj)),
            (b"v for vendetta", None),
            (b"OFF\n1 2 3", Some(ModelFormat::Off)),
            (b"LASF", Some(ModelFormat::Las)),
            (b"ASTM-E57", Some(ModelFormat::E57)),
            (b"1 2 3\n", None),
            (b"", None),
        ] {
            assert_eq!(ModelFormat::of_content(content), expected, "{content:?}");
        }
        assert_eq!(ModelFormat::of_name("a.b/X.STL"), Some(ModelFormat::Stl));
        assert_eq!(ModelFormat::of_name("stl"), None);
        assert_eq!(ModelFormat::of_name("a.PTS"), Some(ModelFormat::Xyz));
    }

    #[test]
    fn compressed_models_are_read_by_content_and_by_name() {
        use std::io::Write;
        let packed = |bytes: &[u8]| {
            let fast = flate2::Compression::fast();
            let mut encoder = flate2::write::GzEncoder::new(Vec::new(), fast);
            encoder.write_all(bytes).expect("memory");
            encoder.finish().expect("memory")
        };
        let read = |bytes: &[u8], name: &str| {
            read_model(bytes, name, &NoResources, &ReadOptions::default())
        };
        let obj = packed(b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
        for name in ["a.obj.gz", "a.stl", ""] {
            let model = read(&obj, name).expect("model");
            assert_eq!((&model.format[..], model.scene.triangle_count()), ("OBJ", 1), "{name}");
        }
        let points = read(&packed(b"1 2 3\n4 5 6\n"), "a.XYZ.gz").expect("points");
        assert_eq!(points.scene.meshes[0].positions.len(), 2);
        let cut = read(&obj[..obj.len() - 9], "a.obj.gz").expect_err("cut off").to_string();
        assert!(cut.contains("broken gzip: the data are cut off"), "{cut}");
        assert_eq!(ModelFormat::of_name("a.OBJ.GZ"), Some(ModelFormat::Obj));
    }

    #[test]
    fn the_unknown_is_reported_what_is_known() {
        let message = |bytes: &[u8], name: &str| {
            let e = read_model(bytes, name, &NoResources, &ReadOptions::default());
            e.expect_err("unknown").to_string()
        };
        let text = message(b"GOFF\n", "x.geom");
        assert!(text.contains("neither content") && text.contains("STL (.stl)"), "{text}");
        assert!(message(b"newmtl a\n", "x.mtl").contains("material library"));
        let map = message(b"{\"type\": \"Point\", \"coordinates\": [1, 2]}", "x.geojson");
        assert!(map.contains("this is geojson, which has no surfaces; `draw` draws it"), "{map}");
        assert!(message(b"\x89PNG\r\n\x1a\n", "x.png").contains("this is a picture"));
        assert!(message(b"", "x").contains("empty"));
    }
}
