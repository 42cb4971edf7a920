//! PLY, the polygon file format: ascii, binary little endian, binary big endian.
//!
//! Source: G. Turk, *The PLY Polygon File Format*, 1994 (file `PLY_FILES.txt` of Stanford's distribution); names of
//! properties as its many writers use them, in any case. Elements and properties may come in any order; unknown ones
//! are skipped, with a warning for elements that might have something to show. Faces are polygons, triangle strips are
//! divided into triangles; a file without faces is a point cloud (or lines, if it has edges), or Gaussian splats.
//! Colors are sRGB, of vertices, faces or edges. Pictures named by `comment TextureFile` are mapped by texture
//! coordinates of vertices or of corners (lists `texcoord`). y is up.
//!
//! Positions declared `double` keep their detail far from the origin (see [`durer::scene::Mesh`]);
//! `float` ones are taken as they are.
//!
//! Cost: one pass. Memory: at most 8 times the file (ascii `0 0 0` lines), about 1 in binary; with
//! texture coordinates or colors of faces at most 10 times a binary file.

mod body;
mod bounds;
mod build;
mod faces;
mod finish;
mod header;
mod names;
mod pieces;
mod row_color;
mod splat;
mod stream;
mod texture;
mod vertices;

use crate::last_digit::last_digit;
use crate::{Error, Model, Place, ReadOptions, Resources, Result, text};
use body::{Ascii, Binary};
use build::Builder;
use header::{Element, Encoding, Header};
pub use pieces::Pieces;

/// Returns whether the content begins as PLY does.
pub(crate) fn sniff(bytes: &[u8]) -> bool {
    matches!(bytes, [b'p', b'l', b'y', b'\r' | b'\n' | b' ', ..]) || bytes == b"ply"
}

/// Reads a PLY file.
///
/// A truncated file is read up to its end, and faces with missing vertices are left out, with a warning.
///
/// # Errors
/// [`Error::Decode`] with the line (header, ascii) or byte offset (binary) for a header that is not
/// PLY's, data that end before the first vertex, a word that is not a number, or vertex indices that are
/// all out of range; [`Error::Limit`] for more primitives than allowed.
pub fn read(bytes: &[u8], resources: &dyn Resources, options: &ReadOptions) -> Result<Model> {
    let stripped = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let header = header::parse(stripped)?;
    refuse_packed(&header)?;
    let body = stripped.get(header.length..).unwrap_or_default();
    let offset = (bytes.len() - stripped.len() + header.length) as u64;
    let mut builder = Builder::new(&header, options.limits.clone());
    let mut commas = text::Tally::default();
    let warning = match header.encoding {
        Encoding::Ascii => {
            let cursor = text::Cursor::at_line(body, header.lines);
            let mut values = Ascii::new(cursor);
            let warning = read_body(&header, &mut builder, &mut values)?;
            commas = values.commas();
            warning
        }
        Encoding::LittleEndian => {
            read_body(&header, &mut builder, &mut Binary::<true>::new(body, offset))?
        }
        Encoding::BigEndian => {
            read_body(&header, &mut builder, &mut Binary::<false>::new(body, offset))?
        }
    };
    let mut model = finish::finish(builder, &header, resources, options)?;
    if matches!(header.encoding, Encoding::Ascii) {
        model.scene.last_digit = last_digit(body, b"");
    }
    model.warn_of(&commas, text::COMMAS);
    warn_of_end(&mut model, &header, warning);
    model.scene.check()?;
    Ok(model)
}

/// Warns of skipped lines, and of missing or surplus data at the end of the file.
fn warn_of_end(model: &mut Model, header: &Header, end: Option<(Place, String)>) {
    let words = "{line is|lines are} not of a PLY header and {was|were} skipped";
    model.warn_of(&header.unknown, words);
    if let Some((place, message)) = end {
        model.warn(place, message);
    }
}

/// Refuses compressed splats, whose vertices are only four words of bits.
///
/// # Errors
/// [`Error::Unsupported`].
fn refuse_packed(header: &Header) -> Result<()> {
    let vertex = header.element("vertex");
    if vertex.is_some_and(|v| v.properties.iter().any(|p| p.name == "packed_position")) {
        let what = "PLY with packed splats (`packed_position`)".to_owned();
        let hint = "programs that write it export plain splats too".to_owned();
        return Err(Error::Unsupported { place: Place::Whole, what, hint });
    }
    Ok(())
}

/// Reads all elements; surplus or missing data give a warning.
fn read_body(
    header: &Header,
    builder: &mut Builder,
    values: &mut impl body::Values,
) -> Result<Option<(Place, String)>> {
    for element in &header.elements {
        // Rows without properties take no bytes: any count of them could be claimed.
        let rows = if element.properties.is_empty() { 0 } else { element.count };
        let plan = builder.begin(element, rows.min(room(element, values)))?;
        for row in 0..rows {
            match builder.row(&plan, row, values) {
                Err(why) if values.ended() || builder.has_faces() => {
                    return missing(element, row, builder, why).map(Some);
                }
                other => other?,
            }
        }
    }
    Ok(values.left_over())
}

/// Returns the number of an element's rows that fit into the rest of the file.
fn room(element: &Element, values: &impl body::Values) -> u64 {
    // The last value of an ascii file needs no blank behind it.
    (values.bytes_left() + 1) / values.least_size(element).max(1)
}

/// Returns the place and message for a file that ends, or becomes invalid, at a row.
///
/// # Errors
/// `why`, if there is nothing to show yet.
fn missing(element: &Element, row: u64, builder: &Builder, why: Error) -> Result<(Place, String)> {
    if builder.vertices.len() == 0 {
        return Err(why);
    }
    missing_rows(element, row, why)
}

/// Returns the place and message for rows of an element that are missing.
///
/// # Errors
/// `why`, if it is not about the contents of the file.
fn missing_rows(element: &Element, row: u64, why: Error) -> Result<(Place, String)> {
    let Error::Decode { place, message } = why else { return Err(why) };
    let Element { name, count, .. } = element;
    let are = if row == 1 { "is" } else { "are" };
    let message = format!(
        "{message}: {row} of {count} rows of element `{name}` {are} read, and nothing after them"
    );
    Ok((place, message))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::NoResources;
    use durer::math::{Vec2, Vec3, Vec4};
    use durer::scene::Topology;

    fn read_ok(text: &str) -> Model {
        read(text.as_bytes(), &NoResources, &ReadOptions::default()).expect("readable")
    }

    fn message(text: &str) -> String {
        read(text.as_bytes(), &NoResources, &ReadOptions::default())
            .expect_err("broken")
            .to_string()
    }

    const XYZ: &str = "property float x\nproperty float y\nproperty float z\n";

    #[test]
    fn every_property_finds_its_place() {
        let model = read_ok(
            "ply\r\nformat ascii 1.0\r\ncomment c\r\nobj_info o\r\nelement face 2\r\n\
             property uchar flags\r\nproperty list uchar int vertex_index\r\n\
             property list uchar float other\r\nelement vertex 5\r\nproperty uchar blue\r\n\
             property double z\r\nproperty list int int junk\r\nproperty float x\r\nproperty float y\r\n\
             property uchar green\r\nproperty uchar red\r\nproperty float s\r\nproperty float t\r\n\
             property float ny\r\nproperty float nx\r\nproperty float nz\r\nend_header\r\n\
             7 4 0 1 2 3 0\r\n7 3 0 3 4 2 1 2\r\n\
             0 3 0 1 2 0 255 .25 .25 0 2 0\r\n0 3 2 9 9 1 2 0 255 0 0 0 1 0\r\n\
             0 3 0 1 2 0 255 0 0 0 1 0\r\n0 3 0 1 2 0 255 0 0 0 1 0\r\n0 3 0 1 2 0 255 0 0 0 1 0\r\n",
        );
        assert!(model.warnings.is_empty(), "{:?}", model.warnings);
        let mesh = &model.scene.meshes[0];
        assert_eq!(mesh.positions[1], Vec3::new(1.0, 2.0, 3.0));
        assert_eq!(mesh.normals[0], Vec3::X);
        assert_eq!(mesh.tex_coords[0][0], Vec2::new(0.25, 0.75));
        assert_eq!(mesh.colors[4], Vec4::new(1.0, 0.0, 0.0, 1.0));
        assert_eq!(mesh.indices.as_deref(), Some(&[0, 1, 2, 0, 2, 3, 0, 3, 4][..]));
        assert_eq!(mesh.faces, [0, 2]);
    }

    #[test]
    fn strips_points_and_edges() {
        let strip = format!(
            "ply\nformat ascii 1.0\nelement vertex 4\n{XYZ}element tristrips 1\n\
             property list int int vertex_indices\nend_header\n\
             0 0 0\n1 0 0\n0 1 0\n1 1 0\n8 0 1 2 3 -1 3 2 1\n"
        );
        let model = read_ok(&strip);
        let expected = [0, 1, 2, 2, 1, 3, 3, 2, 1];
        assert_eq!(model.scene.meshes[0].indices.as_deref(), Some(&expected[..]));

        let points =
            format!("ply\nformat ascii 1.0\nelement vertex 2\n{XYZ}end_header\n1 2 3\n4 5 6");
        let model = read_ok(&points);
        assert_eq!(model.scene.meshes[0].topology, Topology::Points);
        assert_eq!(model.scene.meshes[0].primitive_count(), 2);

        let edges = format!(
            "ply\nformat ascii 1.0\nelement vertex 2\n{XYZ}element edge 1\nproperty int vertex1\n\
             property int vertex2\nend_header\n1 2 3\n4 5 6\n1 0\n"
        );
        let model = read_ok(&edges);
        assert_eq!(model.scene.meshes[0].topology, Topology::Lines);
        assert_eq!(model.scene.meshes[0].indices.as_deref(), Some(&[1, 0][..]));
    }

    #[test]
    fn doubles_keep_their_detail() {
        let model = read_ok(
            "ply\nformat ascii 1.0\nelement vertex 2\nproperty double x\nproperty double y\n\
             property double z\nend_header\n5000000.001 1 1\n5000000.002 1 1\n",
        );
        let scene = &model.scene;
        let at = |i: usize| {
            let p = scene.meshes[0].positions[i].as_dvec3();
            scene.instances[0].world_from_mesh.transform_point3(p).x
        };
        assert!((at(1) - at(0) - 0.001).abs() < 1e-8);
    }

    #[test]
    fn errors_say_where_and_what() {
        let file =
            |head: &str, body: &str| format!("ply\nformat ascii 1.0\n{head}end_header\n{body}");
        let vertices = |n: &str| format!("element vertex {n}\n{XYZ}");
        let faces =
            format!("{}element face 1\nproperty list uchar int vertex_indices\n", vertices("1"));
        for (text, expected) in [
            (file(&vertices("-5"), ""), "line 3: `-5` is not a count"),
            (file(&vertices("1"), "0 x 000000"), "line 8, column 3: `x` is not a number"),
            (file(&vertices("1"), "0      0\n"), "the file ends"),
            (file(&faces, "0 0 0\n3 0 0 1"), "vertex 1 does not exist"),
            (file(&faces, "0 0 0\n3 0 0 -1"), "vertex -1 does not exist"),
            (file(&faces, "0 0 0\n-3 0 0"), "`-3` is not a length"),
            (file("element vertex 1\nproperty quaternion x\n", "0"), "`quaternion` is not a type"),
            (file("element vertex 1\nproperty float x\n", "0"), "no property `y`"),
            (file("", ""), "no element `vertex`"),
            ("ply\nformat ascii 1.0\nelement vertex 1\n".to_owned(), "`end_header` is missing"),
            ("ply\nformat utf 1.0\nend_header\n".to_owned(), "line 2: `utf` is not a format"),
            ("plyx".to_owned(), "line 1: a PLY file begins with `ply`"),
        ] {
            let found = message(&text);
            assert!(found.contains(expected), "{found}\n{text}");
        }
    }

    #[test]
    fn a_header_with_the_wrong_byte_order_is_suspected() {
        let faces = "element face 1\nproperty list uchar int vertex_indices\n";
        let head = format!(
            "ply\nformat binary_big_endian 1.0\nelement vertex 3\n{XYZ}{faces}end_header\n"
        );
        let mut bytes = [head.as_bytes(), &[0; 36], &[3]].concat();
        bytes.extend([0_i32, 1, 2].map(i32::to_le_bytes).as_flattened());
        let error =
            super::read(&bytes, &NoResources, &ReadOptions::default()).unwrap_err().to_string();
        assert!(error.contains("vertex 16777216 does not exist: there are 3"), "{error}");
        assert!(error.contains("other byte order"), "{error}");
    }

    #[test]
    fn huge_counts_take_no_memory() {
        let file = |encoding: &str| {
            format!(
                "ply\nformat {encoding} 1.0\nelement vertex 4000000000\n{XYZ}end_header\n0 0 0\n"
            )
        };
        let model = read_ok(&file("ascii"));
        assert_eq!(model.scene.meshes[0].positions, [Vec3::ZERO]);
        let warning = model.warnings[0].to_string();
        assert!(warning.contains("1 of 4000000000 rows of element `vertex`"), "{warning}");
        assert!(message(&file("binary_little_endian")).contains("the file ends"));
        let empty = "ply\nformat ascii 1.0\nelement nothing 4000000000000\nelement vertex 0\n\
                     property int x\nproperty int y\nproperty int z\nend_header\n";
        assert!(read_ok(empty).scene.meshes.iter().all(|m| m.positions.is_empty()));
    }
}
