//! STL as bytes.

use super::palette::Palette;
use super::{HEADER, RECORD, add, check_limit, count_in_header, finished};
use crate::budget::MODEL;
use crate::model::count_infinite;
use crate::wording::counted;
use crate::{Error, Limits, Model, Place, ReadOptions, Result};
use durer::math::{DVec3, Vec3};
use durer::scene::{Mesh, Part};

/// Name of the format in a model.
pub(super) const BINARY: &str = "STL, binary";

/// Bytes of a binary file that [`read_binary_stream`] works on at a time: few enough for the cache.
const AT_ONCE: usize = 1024;

/// Reads a binary STL file as it comes: the bytes after `head`, for which [`super::is_whole_binary`]
/// holds. The same model as [`super::read`] gives, without holding the file's bytes.
///
/// # Errors
/// [`Error::Limit`] for too many triangles, [`Error::Io`] if reading fails or ends too early.
pub fn read_binary_stream(
    head: &[u8; HEADER],
    mut source: impl std::io::Read,
    options: &ReadOptions,
) -> Result<Model> {
    let mut left = count_in_header(head).unwrap_or(0) as usize;
    check_limit(left as u64, &options.limits)?;
    keep(left, &options.limits)?;
    let mut facets = Facets::new(head, left);
    let mut buffer = vec![0; left.min(AT_ONCE) * RECORD];
    while left > 0 {
        let count = left.min(AT_ONCE);
        let bytes = &mut buffer[..count * RECORD];
        source.read_exact(bytes).map_err(Error::Io)?;
        facets.add(bytes.as_chunks().0);
        left -= count;
    }
    facets.into_model(Model { format: BINARY.to_owned(), ..Model::default() }, false)
}

/// Bytes for a triangle: its corners, some shared, and their numbers.
pub(super) const BYTES: u64 = 48;

/// Charges the memory for this many triangles to the budget.
fn keep(triangles: usize, limits: &Limits) -> Result<()> {
    Ok(limits.work.keep(MODEL, triangles as u64 * BYTES)?)
}

/// Reads all bytes of a file.
///
/// # Errors
/// As [`super::read`].
pub(super) fn read(bytes: &[u8], limits: &Limits) -> Result<Model> {
    let mut model = Model { format: BINARY.to_owned(), ..Model::default() };
    let (Some(count), Some(data)) = (count_in_header(bytes), bytes.get(HEADER..)) else {
        let message = format!(
            "the file has {}; a binary STL has at least {HEADER}, an ascii one begins with `solid`",
            counted(bytes.len() as u64, "byte", "bytes")
        );
        return Err(Error::byte(bytes.len() as u64, message));
    };
    let records = records(&mut model, data, count)?;
    check_limit(records.len() as u64, limits)?;
    keep(records.len(), limits)?;
    let mut facets = Facets::new(bytes, records.len());
    records.chunks(AT_ONCE).for_each(|some| facets.add(some));
    facets.into_model(model, false)
}

/// Returns the triangles that are really there.
fn records<'a>(model: &mut Model, data: &'a [u8], count: u32) -> Result<&'a [[u8; RECORD]]> {
    let (whole, rest) = data.as_chunks::<RECORD>();
    let (stated, there) = (count as usize, whole.len());
    let triangles = counted(u64::from(count), "triangle", "triangles");
    if stated > there {
        let message = format!("the header counts {triangles}, the file has room for {there}");
        if there == 0 {
            return Err(Error::byte(80, message));
        }
        model.warn(Place::Byte(80), message + "; those were read");
    } else if stated < there && (stated == 0 || rest.is_empty()) {
        let message =
            format!("the header counts {triangles}, the file holds {there}; all were read");
        model.warn(Place::Byte(80), message);
    } else if data.len() > stated * RECORD {
        let end = HEADER + stated * RECORD;
        let words = "{byte after the last triangle was|bytes after the last triangle were} ignored";
        model.warn_counted(Place::Byte(end as u64), (data.len() - stated * RECORD) as u64, words);
        return Ok(whole.get(..stated).unwrap_or(whole));
    }
    Ok(whole)
}

pub(super) fn vertices(record: &[u8; RECORD]) -> [Vec3; 3] {
    let mut numbers = [0.0; 9];
    for (to, bytes) in numbers.iter_mut().zip(record[12..48].as_chunks().0) {
        *to = f32::from_le_bytes(*bytes);
    }
    let [ax, ay, az, bx, by, bz, cx, cy, cz] = numbers;
    [Vec3::new(ax, ay, az), Vec3::new(bx, by, bz), Vec3::new(cx, cy, cz)]
}

/// The facets of a binary file so far.
pub(super) struct Facets {
    mesh: Mesh,
    /// Expected number of facets.
    count: usize,
    palette: Palette,
    /// Vertices that are not finite, counted while they are in the cache.
    infinite: usize,
}

impl Facets {
    /// Creates the facets of a file that begins with `head` and has `count` of them.
    pub fn new(head: &[u8], count: usize) -> Self {
        let mesh = Mesh { positions: Vec::with_capacity(3 * count), ..Mesh::default() };
        Self { mesh, count, palette: Palette::new(head), infinite: 0 }
    }

    pub fn add(&mut self, records: &[[u8; RECORD]]) {
        let Mesh { positions, colors, .. } = &mut self.mesh;
        let before = positions.len();
        positions.resize(before + 3 * records.len(), Vec3::ZERO);
        for (to, record) in positions[before..].as_chunks_mut().0.iter_mut().zip(records) {
            *to = vertices(record);
        }
        self.infinite += count_infinite(&positions[before..]);
        let attribute = |r: &[u8; RECORD]| u16::from_le_bytes([r[48], r[49]]);
        let marking = self.palette.marking_bits();
        let marked = |r: &[u8; RECORD]| attribute(r) & marking;
        if colors.is_empty() && records.iter().fold(0, |any, r| any | marked(r)) == 0 {
            return;
        }
        colors.reserve_exact(3 * self.count - colors.len());
        // The first facet with a color; earlier ones have none.
        colors.resize(before, self.palette.color(0));
        colors.extend(records.iter().flat_map(|r| [self.palette.color(attribute(r)); 3]));
    }

    /// Adds the facets to a model, with colours where some have one, or if it is known that others of the file have.
    pub fn into_model(mut self, mut model: Model, colored: bool) -> Result<Model> {
        if colored && self.mesh.colors.is_empty() {
            self.mesh.colors.resize(self.mesh.positions.len(), self.palette.color(0));
        }
        if let Some(material) = self.palette.material(!self.mesh.colors.is_empty()) {
            let range = 0..self.count as u32;
            self.mesh.parts.push(Part { range, material: Some(0), name: String::new() });
            model.scene.materials.push(material);
        }
        add(&mut model, self.mesh, DVec3::ZERO);
        finished(model, self.infinite)
    }
}

#[cfg(test)]
mod tests {
    use super::super::palette::PAINTED;
    use super::*;
    use crate::NoResources;
    use crate::stl::{is_whole_binary, read};
    use durer::math::Vec4;

    fn read_ok(bytes: &[u8]) -> Model {
        read(bytes, &NoResources, &ReadOptions::default()).expect("readable")
    }

    fn message(bytes: &[u8]) -> String {
        read(bytes, &NoResources, &ReadOptions::default()).expect_err("broken").to_string()
    }

    /// Returns a binary file: header text, count field, and per triangle nine numbers and the
    /// attributes.
    fn binary(header: &[u8], count: u32, triangles: &[([f32; 9], u16)]) -> Vec<u8> {
        let mut bytes = header.to_vec();
        bytes.resize(80, b' ');
        bytes.extend(count.to_le_bytes());
        for (numbers, attribute) in triangles {
            bytes.extend([0; 12]);
            bytes.extend(numbers.iter().flat_map(|n| n.to_le_bytes()));
            bytes.extend(attribute.to_le_bytes());
        }
        bytes
    }

    const ONE: [f32; 9] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.5];

    #[test]
    fn lying_headers_are_seen_through() {
        for header in ["solid x", "x"] {
            for (count, warnings) in [(2, 0), (0, 1), (1, 1), (u32::MAX, 1)] {
                let model = read_ok(&binary(header.as_bytes(), count, &[(ONE, 0), (ONE, 0)]));
                assert_eq!(model.scene.triangle_count(), 2, "{header} {count}");
                assert_eq!(model.warnings.len(), warnings, "{header} {count}");
                assert_eq!(model.format, "STL, binary");
            }
        }
        let mut cut = binary(b"x", 2, &[(ONE, 0), (ONE, 0)]);
        cut.truncate(cut.len() - 1);
        assert_eq!(read_ok(&cut).scene.triangle_count(), 1);
        cut.truncate(HEADER + 10);
        assert!(message(&cut).contains("room for 0"), "{}", message(&cut));
    }

    #[test]
    fn facet_colors_of_both_makers() {
        let red = |bytes: &[u8]| read_ok(bytes).scene.meshes[0].colors.clone();
        assert!(red(&binary(b"x", 1, &[(ONE, 31)])).is_empty());
        let viscam = binary(b"x", 1, &[(ONE, 0x8000 | 31 << 10)]);
        assert_eq!(red(&viscam), [Vec4::new(1.0, 0.0, 0.0, 1.0); 3]);
        let magics = binary(b"COLOR=\x00\xff\x00\xff", 2, &[(ONE, 31), (ONE, 0x8000)]);
        let (first, second) = (red(&magics)[0], red(&magics)[3]);
        assert_eq!(first, Vec4::new(1.0, 0.0, 0.0, 1.0));
        assert_eq!(second, Vec4::new(0.0, 1.0, 0.0, 1.0));
    }

    #[test]
    fn a_header_color_is_everywhere_where_no_facet_has_one() {
        let header =
            b"COLOR=\xff\x00\x00\x20,MATERIAL=\x00\x00\x00\xff\x00\xff\x00\xff\x00\x00\x00\xff";
        let model = read_ok(&binary(header, 2, &[(ONE, 0), (ONE, 0)]));
        let material = &model.scene.materials[0];
        assert_eq!(material.base_color, Vec4::new(1.0, 0.0, 0.0, 1.0));
        assert_eq!(material.specular, Vec3::Y);
        let mesh = &model.scene.meshes[0];
        assert!(mesh.colors.is_empty() && mesh.parts[0].material == Some(0));
        // One facet has its own colour: facets with 0 are black.
        let model = read_ok(&binary(header, 2, &[(ONE, 0), (ONE, 31 << 10)]));
        let colors = &model.scene.meshes[0].colors;
        assert_eq!((colors[0], colors[3]), (Vec4::W, Vec4::new(0.0, 0.0, 1.0, 1.0)));
        let model = read_ok(&binary(&header[11..], 1, &[(ONE, 0)]));
        assert_eq!(model.scene.materials[0].base_color, Vec4::W);
    }

    #[test]
    fn a_stream_gives_the_same_model() {
        let many = |attribute: &dyn Fn(usize) -> u16| -> Vec<([f32; 9], u16)> {
            let place = |i: usize| ONE.map(|n| n + i as f32);
            (0..2 * AT_ONCE + 7).map(|i| (place(i), attribute(i))).collect()
        };
        let late = |i: usize| if i == AT_ONCE + 3 { PAINTED | 31 } else { 0 };
        for (header, triangles) in [
            (&b"x"[..], many(&|_| 0)),
            (b"solid", many(&late)),
            (b"COLOR=\x00\xff\x00\xff", many(&|i| i as u16)),
            (b"x", vec![]),
            (b"x", vec![([f32::NAN; 9], 0)]),
        ] {
            let bytes = binary(header, triangles.len() as u32, &triangles);
            assert!(is_whole_binary(&bytes[..HEADER], bytes.len() as u64));
            assert!(!is_whole_binary(&bytes[..HEADER], bytes.len() as u64 + 1));
            let (head, rest) = bytes.split_first_chunk().unwrap();
            let options = ReadOptions::default();
            let streamed = read_binary_stream(head, rest, &options).unwrap();
            assert_eq!(format!("{streamed:?}"), format!("{:?}", read_ok(&bytes)));
            let cut = rest.get(1..).unwrap_or_default();
            assert_eq!(read_binary_stream(head, cut, &options).is_ok(), rest.is_empty());
        }
        for other in [&b"glTF"[..], b"ply\n", b"PK\x03\x04", b" {"] {
            let bytes = binary(other, 1, &[(ONE, 0)]);
            assert!(!is_whole_binary(&bytes, bytes.len() as u64));
        }
    }

    #[test]
    fn a_limit_is_kept() {
        let options = ReadOptions {
            limits: Limits { primitives: 1, ..Limits::default() },
            ..ReadOptions::default()
        };
        let two = binary(b"x", 2, &[(ONE, 0), (ONE, 0)]);
        assert!(matches!(read(&two, &NoResources, &options), Err(Error::Limit { value: 2, .. })));
    }
}
