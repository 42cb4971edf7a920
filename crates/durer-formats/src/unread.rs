//! Formats of models that are recognized but not read, with a way to convert them.

use crate::{Error, Place, gzip};

/// Number of bytes of a file that are examined.
const PROBE: usize = 4096;

/// A format that is not read.
struct Format {
    /// Its name, and what it is for, for a message.
    what: &'static str,
    suffixes: &'static [&'static str],
    /// Beginnings of its files; of XML, an element near the beginning.
    magics: &'static [&'static [u8]],
    hint: &'static str,
}

/// Advice for formats of CAD programs, which describe surfaces exactly.
const CAD: &str =
    "export the model as STL or 3MF from the CAD program, or convert it, for example by FreeCAD";

/// Advice for formats that Blender opens.
const BLENDER: &str = "convert the model to glTF, for example by Blender";

/// Advice for the native formats of programs.
const EXPORT: &str = "export the model as glTF, OBJ or STL from the program that wrote it";

const IFC: Format = format("IFC, a format of buildings,", &["ifc"], &[], IFC_HINT);
const IFC_HINT: &str = "convert the model to glTF, for example by IfcConvert";
const STEP: Format = format("STEP, a format of CAD programs,", &["step", "stp", "p21"], &[], CAD);

/// All others.
const FORMATS: &[Format] = &[
    format("IGES, a format of CAD programs,", &["igs", "iges"], &[], CAD),
    format("BREP, a format of CAD programs,", &["brep", "brp"], &[b"DBRep_DrawableShape"], CAD),
    format("Parasolid, a format of CAD programs,", &["x_t", "x_b"], &[b"**ABCDEF"], CAD),
    format(
        "a document of FreeCAD",
        &["fcstd"],
        &[],
        "export the model as STL, 3MF or glTF from FreeCAD",
    ),
    format("a document of SolidWorks", &["sldprt", "sldasm"], &[], EXPORT),
    format("a program of OpenSCAD", &["scad"], &[], "let OpenSCAD export it as STL or 3MF"),
    format("a document of Rhino", &["3dm"], &[b"3D Geometry File Format"], EXPORT),
    format(
        "a document of SketchUp",
        &["skp"],
        &[b"\xff\xfe\xff\x0eS\0k\0e\0t\0c\0h\0U\0p\0"],
        EXPORT,
    ),
    format("a document of AutoCAD", &["dwg"], &[b"AC10"], EXPORT),
    format("DXF, a format of drawings,", &["dxf"], &[b"0\nSECTION", b"0\r\nSECTION"], EXPORT),
    format(
        "a document of Blender",
        &["blend"],
        &[b"BLENDER"],
        "export the model as glTF from Blender",
    ),
    format("a document of Maya", &["ma", "mb"], &[b"//Maya ASCII"], EXPORT),
    format("a document of 3ds Max", &["max"], &[], EXPORT),
    format("a document of Cinema 4D", &["c4d"], &[], EXPORT),
    format("3DS, an old format of 3D Studio,", &["3ds"], &[], BLENDER),
    format("LWO, the format of LightWave,", &["lwo", "lws"], &[], EXPORT),
    format("X, an old format of DirectX,", &["x"], &[b"xof 0"], "convert the model to glTF or OBJ"),
    format("USD", &["usd", "usda", "usdc", "usdz"], &[b"#usda", b"PXR-USDC"], BLENDER),
    format("Alembic", &["abc"], &[b"Ogawa"], BLENDER),
    format("VRML", &["wrl", "vrml"], &[b"#VRML"], BLENDER),
    format("X3D", &["x3d", "x3dv"], &[b"<X3D", b"#X3D"], BLENDER),
    format(
        "AMF",
        &["amf"],
        &[b"<amf"],
        "convert the model to 3MF or STL, for example by PrusaSlicer",
    ),
    format(
        "VTK",
        &["vtk", "vtp", "vtu"],
        &[b"# vtk", b"<VTKFile"],
        "export the surface as PLY or glTF, for example by ParaView",
    ),
    format(
        "PCD, a format of point clouds,",
        &["pcd"],
        &[b"# .PCD"],
        "convert it to PLY, for example by CloudCompare",
    ),
    format(
        "a mesh of Gmsh",
        &["msh"],
        &[b"$MeshFormat"],
        "let Gmsh export the surface as STL or PLY",
    ),
    format(
        "G-code, the paths of a machine,",
        &["gcode", "nc", "ngc"],
        &[],
        "render the model that it was made from",
    ),
    format(
        "an ESRI grid, a height map,",
        &[],
        &[b"ncols", b"NCOLS"],
        "`durer plot` draws it as a surface",
    ),
];

const fn format(
    what: &'static str,
    suffixes: &'static [&'static str],
    magics: &'static [&'static [u8]],
    hint: &'static str,
) -> Format {
    Format { what, suffixes, magics, hint }
}

impl Format {
    fn begins(&self, head: &[u8]) -> bool {
        self.magics.iter().any(|magic| match magic {
            [b'<', ..] => head.starts_with(b"<") && contains(head, magic),
            _ => head.starts_with(magic),
        })
    }

    fn error(&self) -> Error {
        let (what, hint) = (self.what.to_owned(), self.hint.to_owned());
        Error::Unsupported { place: Place::Whole, what, hint }
    }
}

/// Returns the error for a file whose content is in a format that is not read, whatever its name.
pub(crate) fn of_content(bytes: &[u8]) -> Option<Error> {
    let head = bytes.get(..PROBE).unwrap_or(bytes);
    let head = head.strip_prefix(b"\xef\xbb\xbf").unwrap_or(head).trim_ascii_start();
    if head.starts_with(b"ISO-10303-21") {
        return Some(if contains(head, b"'IFC") { IFC } else { STEP }.error());
    }
    FORMATS.iter().find(|format| format.begins(head)).map(Format::error)
}

/// Returns the error for a file with a name of a format that is not read.
pub(crate) fn of_name(name: &str) -> Option<Error> {
    let (_, suffix) = gzip::stem(name).rsplit_once('.')?;
    let suffix = suffix.to_ascii_lowercase();
    let mut all = [IFC, STEP].into_iter().chain(FORMATS.iter().map(|f| Format { ..*f }));
    all.find(|format| format.suffixes.contains(&&*suffix)).map(|format| format.error())
}

fn contains(head: &[u8], part: &[u8]) -> bool {
    head.windows(part.len()).any(|window| window == part)
}

#[cfg(test)]
mod tests {
    use crate::{NoResources, ReadOptions, read_model};

    #[test]
    fn formats_that_are_not_read_are_named() {
        let xml = br#"<?xml version="1.0"?><X3D profile="Interchange"/>"#;
        for (bytes, name, expected) in [
            (&b"ISO-10303-21;\nHEADER;"[..], "a.stp", "STEP, a format of CAD programs, is not"),
            (b"ISO-10303-21;\nFILE_SCHEMA(('IFC4'));", "a", "IFC, a format of buildings, is not"),
            (b"ISO-10303-21;", "a.stl", "STEP"),
            (b"#VRML V2.0 utf8\n", "-", "VRML is not supported; convert the model to glTF"),
            (xml, "a.xml", "X3D"),
            (b"  0\r\nSECTION\r\n  2\r\n", "a", "DXF"),
            (b"MM\0\0", "A.3DS", "3DS"),
            (b"PK\x03\x04", "a.usdz", "USD"),
            (
                b"ncols 2\nnrows 2\n",
                "a.asc",
                "an ESRI grid, a height map, is not supported; `durer plot`",
            ),
            (b"cube(2);", "a.scad.gz", "a program of OpenSCAD"),
        ] {
            let error = read_model(bytes, name, &NoResources, &ReadOptions::default());
            let message = error.expect_err(name).to_string();
            assert!(message.starts_with(expected), "{name}: {message}");
        }
    }
}
