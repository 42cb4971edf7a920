//! STL, the stereolithography format: binary and ascii.
//!
//! Source: 3D Systems, *StereoLithography Interface Specification*, 1988; colors after VisCAM and
//! Materialise Magics. Which of the two a file is, is told by its content: many binary files begin
//! with `solid`, and counts in headers are often wrong.
//!
//! Vertices are not joined and the stored facet normals, which are often wrong, are left out: the
//! mesh has three vertices per triangle, in the file's order. z is up.
//!
//! Cost: one pass, after one that asks for colors. Memory: 0.72 of a binary file, 1.7 with colors;
//! under 4 times an ascii file.

use crate::model::count_infinite;
use crate::text::{Cursor, Tally, utf8};
use crate::{
    Error, Limits, Model, ModelFormat, Place, ReadOptions, Resources, Result, color, place,
};
use durer::math::{DVec3, Vec3, Vec4};
use durer::scene::{Instance, Material, Mesh, Part, UpAxis};

/// Bytes of a binary file before its first triangle: 80 of text, and the count.
pub const HEADER: usize = 84;
/// Bytes of a triangle in a binary file: normal, three vertices, two bytes of attributes.
const RECORD: usize = 50;
/// What the format is called in a model.
const BINARY: &str = "STL, binary";
/// How far into a file that begins with `solid` a keyword of ascii STL is looked for.
const PROBE: usize = 4096;

/// Whether the content looks like STL.
pub(crate) fn sniff(bytes: &[u8]) -> bool {
    has_exact_length(bytes) || is_ascii(bytes)
}

/// Bytes of a binary file that [`read_binary_stream`] works on at a time: few enough for the cache.
const AT_ONCE: usize = 1024;

/// Whether a file of `length` bytes that begins with `head`, [`HEADER`] bytes or more, is binary STL
/// as long as its header says; [`read_binary_stream`] reads such a file.
pub fn is_whole_binary(head: &[u8], length: u64) -> bool {
    is_length_in_header(head, length) && ModelFormat::may_be_stl(head)
}

fn count_in_header(bytes: &[u8]) -> Option<u32> {
    let count = bytes.get(80..HEADER)?;
    Some(u32::from_le_bytes(count.try_into().ok()?))
}

/// Whether the file is as long as a binary header says; such a file is binary whatever it begins with.
fn has_exact_length(bytes: &[u8]) -> bool {
    is_length_in_header(bytes, bytes.len() as u64)
}

fn is_length_in_header(head: &[u8], length: u64) -> bool {
    let expected = |count: u32| HEADER as u64 + RECORD as u64 * u64::from(count);
    count_in_header(head).is_some_and(|count| expected(count) == length)
}

/// Whether the file begins as ascii STL does, and goes on as text.
fn is_ascii(bytes: &[u8]) -> bool {
    let text = utf8(bytes.get(..PROBE).unwrap_or(bytes));
    let text = text.trim_ascii_start();
    let solid = text.get(..5).is_some_and(|w| w.eq_ignore_ascii_case(b"solid"));
    // Control characters below tab do not occur in text and do in coordinates.
    let texty = !text.iter().any(|&b| b < b'\t');
    solid && texty
}

/// Reads an STL file.
///
/// A count that does not fit the file's length, or a file that ends inside a triangle, is a warning:
/// all whole triangles are taken.
///
/// # Errors
/// [`Error::Decode`] for a file too short to be binary STL, cut off before its first triangle, or
/// for a vertex without three numbers (ascii); [`Error::Limit`] for too many triangles.
pub fn read(bytes: &[u8], _resources: &dyn Resources, options: &ReadOptions) -> Result<Model> {
    if !has_exact_length(bytes) && is_ascii(bytes) {
        read_ascii(&utf8(bytes), &options.limits)
    } else {
        read_binary(bytes, &options.limits)
    }
}

/// Reads a binary STL file as it comes: the bytes after `head`, for which [`is_whole_binary`] holds.
/// The same model as [`read`] gives, without holding the file's bytes.
///
/// # Errors
/// [`Error::Limit`] for too many triangles, [`Error::Io`] where reading fails or ends too early.
pub fn read_binary_stream(
    head: &[u8; HEADER],
    mut source: impl std::io::Read,
    options: &ReadOptions,
) -> Result<Model> {
    let mut left = count_in_header(head).unwrap_or(0) as usize;
    check_limit(left as u64, &options.limits)?;
    let mut facets = Facets::new(head, left);
    let mut buffer = vec![0; left.min(AT_ONCE) * RECORD];
    while left > 0 {
        let count = left.min(AT_ONCE);
        let bytes = &mut buffer[..count * RECORD];
        source.read_exact(bytes).map_err(Error::Io)?;
        facets.add(bytes.as_chunks().0);
        left -= count;
    }
    facets.into_model(Model { format: BINARY.to_owned(), ..Model::default() })
}

/// What files of both kinds have in common; told how many vertices are not finite.
fn finished(mut model: Model, infinite: usize) -> Result<Model> {
    model.scene.up_axis = UpAxis::Z;
    if model.scene.meshes.iter().all(|m| m.positions.is_empty()) {
        model.warn(Place::Whole, "holds no triangles");
    }
    if infinite > 0 {
        let message = format!("{infinite} vertices have a coordinate that is NaN or infinite");
        model.warn(Place::Whole, message);
    }
    model.scene.check()?;
    Ok(model)
}

fn check_limit(triangles: u64, limits: &Limits) -> Result<()> {
    // Three vertices per triangle must be numbered in 32 bits.
    let limit = limits.primitives.min(u64::from(u32::MAX / 3));
    let what = "number of triangles";
    if triangles <= limit {
        return Ok(());
    }
    Err(Error::Limit { place: Place::Whole, what, value: triangles, limit })
}

fn add(model: &mut Model, mesh: Mesh, origin: DVec3) {
    let name = mesh.name.clone();
    let world_from_mesh = place::matrix(origin);
    model.scene.meshes.push(mesh);
    model.scene.instances.push(Instance { mesh: 0, world_from_mesh, name });
}

fn read_binary(bytes: &[u8], limits: &Limits) -> Result<Model> {
    let mut model = Model { format: BINARY.to_owned(), ..Model::default() };
    let (Some(count), Some(data)) = (count_in_header(bytes), bytes.get(HEADER..)) else {
        let message = format!(
            "the file has {} bytes; a binary STL has at least {HEADER}, an ascii one begins with `solid`",
            bytes.len()
        );
        return Err(Error::byte(bytes.len() as u64, message));
    };
    let records = records(&mut model, data, count)?;
    check_limit(records.len() as u64, limits)?;
    let mut facets = Facets::new(bytes, records.len());
    records.chunks(AT_ONCE).for_each(|some| facets.add(some));
    facets.into_model(model)
}

/// The triangles that are really there.
fn records<'a>(model: &mut Model, data: &'a [u8], count: u32) -> Result<&'a [[u8; RECORD]]> {
    let (whole, rest) = data.as_chunks::<RECORD>();
    let (said, there) = (count as usize, whole.len());
    if said > there {
        let message = format!("the header counts {said} triangles, the file has room for {there}");
        if there == 0 {
            return Err(Error::byte(80, message));
        }
        model.warn(Place::Byte(80), message + "; those were read");
    } else if said < there && (said == 0 || rest.is_empty()) {
        let message =
            format!("the header counts {said} triangles, the file holds {there}; all were read");
        model.warn(Place::Byte(80), message);
    } else if data.len() > said * RECORD {
        let end = HEADER + said * RECORD;
        let message =
            format!("{} bytes after the last triangle were ignored", data.len() - said * RECORD);
        model.warn(Place::Byte(end as u64), message);
        return Ok(whole.get(..said).unwrap_or(whole));
    }
    Ok(whole)
}

fn vertices(record: &[u8; RECORD]) -> [Vec3; 3] {
    let mut numbers = [0.0; 9];
    for (to, bytes) in numbers.iter_mut().zip(record[12..48].as_chunks().0) {
        *to = f32::from_le_bytes(*bytes);
    }
    let [ax, ay, az, bx, by, bz, cx, cy, cz] = numbers;
    [Vec3::new(ax, ay, az), Vec3::new(bx, by, bz), Vec3::new(cx, cy, cz)]
}

/// The facets of a binary file so far.
struct Facets {
    mesh: Mesh,
    /// How many there will be.
    count: usize,
    palette: Palette,
    /// Vertices that are not finite, counted while they are in the cache.
    infinite: usize,
}

impl Facets {
    /// For a file that begins so and has so many facets.
    fn new(head: &[u8], count: usize) -> Self {
        let mesh = Mesh { positions: Vec::with_capacity(3 * count), ..Mesh::default() };
        Self { mesh, count, palette: Palette::new(head), infinite: 0 }
    }

    fn add(&mut self, records: &[[u8; RECORD]]) {
        let Mesh { positions, colors, .. } = &mut self.mesh;
        let before = positions.len();
        positions.resize(before + 3 * records.len(), Vec3::ZERO);
        for (to, record) in positions[before..].as_chunks_mut().0.iter_mut().zip(records) {
            *to = vertices(record);
        }
        self.infinite += count_infinite(&positions[before..]);
        let attribute = |r: &[u8; RECORD]| u16::from_le_bytes([r[48], r[49]]);
        let marked = |r: &[u8; RECORD]| attribute(r) & PAINTED;
        let colored = !colors.is_empty() || self.palette.body.is_some();
        if !colored && records.iter().fold(0, |any, r| any | marked(r)) == 0 {
            return;
        }
        colors.reserve_exact(3 * self.count - colors.len());
        // The first facet with a color: those before have none.
        colors.resize(before, Material::default().base_color);
        colors.extend(records.iter().flat_map(|r| [self.palette.color(attribute(r)); 3]));
    }

    fn into_model(mut self, mut model: Model) -> Result<Model> {
        if !self.mesh.colors.is_empty() {
            let range = 0..self.count as u32;
            self.mesh.parts.push(Part { range, material: Some(0), name: String::new() });
            model.scene.materials.push(color::vertex_color_material());
        }
        add(&mut model, self.mesh, DVec3::ZERO);
        finished(model, self.infinite)
    }
}

/// The bit of a facet's attributes that says which color it has.
const PAINTED: u16 = 1 << 15;

/// Colors of facets.
///
/// Magics writes `COLOR=` and the body's RGBA into the header, and per facet 5 bits of red, green
/// and blue from the lowest bit on, with bit 15 set where the facet has the body's color. VisCAM
/// has no mark in the header, blue lowest, and bit 15 set where the facet has a color of its own.
struct Palette {
    /// Linear values of sRGB bytes.
    table: [f32; 256],
    /// The body's color, where the file is Magics'.
    body: Option<Vec4>,
}

impl Palette {
    fn new(head: &[u8]) -> Self {
        let mut palette = Self { table: color::linear_bytes(), body: None };
        let text = head.get(..80).unwrap_or_default();
        let mark = text.windows(10).find(|w| w.starts_with(b"COLOR="));
        let bytes = mark.and_then(|w| w.get(6..)?.try_into().ok());
        palette.body = bytes.map(|bytes| palette.of_bytes(bytes));
        palette
    }

    fn of_bytes(&self, [r, g, b, a]: [u8; 4]) -> Vec4 {
        let linear = |v: u8| self.table[usize::from(v)];
        Vec4::new(linear(r), linear(g), linear(b), f32::from(a) / 255.0)
    }

    fn color(&self, attribute: u16) -> Vec4 {
        let five = |bits: u16| ((bits & 31) * 255 / 31) as u8;
        let [low, middle, high] = [attribute, attribute >> 5, attribute >> 10].map(five);
        match (self.body, attribute & PAINTED != 0) {
            (Some(body), true) => body,
            (Some(_), false) => self.of_bytes([low, middle, high, 255]),
            (None, true) => self.of_bytes([high, middle, low, 255]),
            (None, false) => Material::default().base_color,
        }
    }
}

/// State of the ascii reader.
struct Ascii {
    points: Vec<DVec3>,
    /// Vertices of the facet that is open.
    open: usize,
    inside_facet: bool,
    inside_solid: bool,
    solids: Vec<(usize, String)>,
    unknown: Tally,
    limit: Limits,
}

fn read_ascii(text: &[u8], limits: &Limits) -> Result<Model> {
    let mut model = Model { format: "STL, ascii".to_owned(), ..Model::default() };
    let mut cursor = Cursor::new(text);
    let mut ascii = Ascii {
        points: Vec::new(),
        open: 0,
        inside_facet: false,
        inside_solid: false,
        solids: Vec::new(),
        unknown: Tally::default(),
        limit: *limits,
    };
    while !cursor.at_end() {
        ascii.line(&mut cursor)?;
        cursor.next_line();
    }
    ascii.end(&mut model, &cursor)?;
    let origin = place::origin(&ascii.points);
    let parts = ascii.parts();
    let mesh = Mesh { positions: place::narrow(&ascii.points, origin), parts, ..Mesh::default() };
    let infinite = count_infinite(&mesh.positions);
    add(&mut model, mesh, origin);
    finished(model, infinite)
}

impl Ascii {
    fn line(&mut self, cursor: &mut Cursor<'_>) -> Result<()> {
        // A file may hold all of it in one line.
        while let Some(word) = cursor.word() {
            let is = |keyword: &[u8]| word.eq_ignore_ascii_case(keyword);
            if is(b"vertex") {
                self.vertex(cursor)?;
            } else if is(b"facet") {
                self.inside_facet = true;
            } else if is(b"endfacet") {
                self.close_facet(cursor)?;
            } else if is(b"solid") {
                self.inside_solid = true;
                let name = String::from_utf8_lossy(cursor.rest()).into_owned();
                self.solids.push((self.points.len() / 3, name));
            } else if is(b"endsolid") {
                self.inside_solid = false;
                cursor.rest();
            } else if is(b"normal") {
                // Not used, and not worth an error where it is wrong.
                for _ in 0..3 {
                    cursor.word();
                }
            } else if !(is(b"outer") || is(b"loop") || is(b"endloop")) {
                let place = cursor.place();
                self.unknown.add(|| place);
            }
        }
        Ok(())
    }

    fn vertex(&mut self, cursor: &mut Cursor<'_>) -> Result<()> {
        let mut values = [0.0; 3];
        let count = cursor.floats(&mut values)?;
        if count < 3 {
            let message = format!("`vertex` has {count} numbers; it needs 3");
            return Err(Error::line(cursor.line(), 0, message));
        }
        self.open += 1;
        if self.open > 3 {
            let message = "a fourth vertex in a facet; a facet has 3";
            return Err(Error::line(cursor.line(), 0, message));
        }
        self.reserve(cursor.offset());
        self.points.push(DVec3::from_array(values));
        Ok(())
    }

    /// Grows by halves, not by doubling, so that memory stays near what is needed.
    fn reserve(&mut self, read: usize) {
        if self.points.len() == self.points.capacity() {
            // What was read so far has a vertex per so many bytes; the first guess is a page's worth.
            let more = (self.points.len() / 2).max(read.min(256)).max(16);
            self.points.reserve_exact(more);
        }
    }

    fn close_facet(&mut self, cursor: &Cursor<'_>) -> Result<()> {
        if self.open != 3 {
            let message =
                format!("the facet that ends here has {} vertices; it needs 3", self.open);
            return Err(Error::Decode { place: cursor.place(), message });
        }
        (self.open, self.inside_facet) = (0, false);
        check_limit(self.points.len() as u64 / 3, &self.limit)
    }

    /// Drops what a cut-off file leaves open.
    fn end(&mut self, model: &mut Model, cursor: &Cursor<'_>) -> Result<()> {
        let cut = self.inside_facet || self.open > 0;
        // All three vertices are there: only the closing words are missing.
        let whole = self.points.len() - if self.open == 3 { 0 } else { self.open };
        self.points.truncate(whole);
        let place = Place::Line(cursor.line(), 0);
        if cut && whole == 0 {
            let message = "the file ends inside its first facet; `endloop`, `endfacet`, `endsolid` are missing";
            return Err(Error::Decode { place, message: message.to_owned() });
        }
        if self.unknown.count > 0 {
            if whole == 0 && !cut {
                let message = "neither `facet` nor `endsolid` follows `solid`: this is not STL";
                return Err(Error::Decode {
                    place: self.unknown.first.clone(),
                    message: message.to_owned(),
                });
            }
            let message = format!("{} words are not STL and were skipped", self.unknown.count);
            model.warn(self.unknown.first.clone(), message);
        }
        if cut || self.inside_solid {
            let message = format!(
                "the file ends without `endsolid`; {} whole triangles were read",
                whole / 3
            );
            model.warn(place, message);
        }
        Ok(())
    }

    /// Each solid is a part, where there are several or the one has a name.
    fn parts(&self) -> Vec<Part> {
        let count = self.points.len() / 3;
        if self.solids.iter().all(|(_, name)| name.is_empty()) && self.solids.len() < 2 {
            return Vec::new();
        }
        let starts = [0].into_iter().chain(self.solids.iter().skip(1).map(|s| s.0));
        let ends = self.solids.iter().skip(1).map(|s| s.0).chain([count]);
        starts
            .zip(ends)
            .zip(&self.solids)
            .map(|((start, end), (_, name))| Part {
                range: start as u32..end as u32,
                material: None,
                name: name.clone(),
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::NoResources;

    fn read_ok(bytes: &[u8]) -> Model {
        read(bytes, &NoResources, &ReadOptions::default()).expect("readable")
    }

    fn message(bytes: &[u8]) -> String {
        read(bytes, &NoResources, &ReadOptions::default()).expect_err("broken").to_string()
    }

    /// A binary file: header text, count field, and per triangle nine numbers and the attributes.
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
    fn ascii_with_solids_and_odd_layout() {
        let text = "\u{feff}  SOLID a b\r\nfacet normal 0 0 1 outer loop vertex 0 0 0 vertex 1 0 0 \
                    vertex 0 1 0 endloop endfacet\nendsolid\nsolid c\n facet\nouter loop\nvertex 0 0 5e-1\n\
                    vertex 1 0 .5\nvertex 0 1 +.5\nendloop\nendfacet\nendsolid c\n";
        let model = read_ok(text.as_bytes());
        let mesh = &model.scene.meshes[0];
        assert_eq!(mesh.positions[3], Vec3::new(0.0, 0.0, 0.5));
        let parts: Vec<_> = mesh.parts.iter().map(|p| (p.range.clone(), p.name.as_str())).collect();
        assert_eq!(parts, [(0..1, "a b"), (1..2, "c")]);
        assert!(model.warnings.is_empty(), "{:?}", model.warnings);
        assert_eq!(model.scene.up_axis, UpAxis::Z);
    }

    #[test]
    fn broken_ascii_says_where() {
        let start = "solid\nfacet normal 0 0 1\nouter loop\n";
        assert!(
            message(format!("{start}vertex 1 2").as_bytes()).starts_with("line 4: `vertex` has 2")
        );
        assert!(
            message(format!("{start}vertex 1 b 2").as_bytes())
                .starts_with("line 4, column 10: `b`")
        );
        assert!(message(format!("{start}vertex 1 2 3").as_bytes()).contains("first facet"));
        assert!(message(format!("{start}endloop endfacet").as_bytes()).contains("0 vertices"));
        assert!(message(b"solid nonsense\nall along\n").contains("not STL"));
        let cut =
            format!("{start}vertex 1 2 3\nvertex 2 3 4\nvertex 1 5 6\nendloop\nendfacet\nfacet");
        let model = read_ok(cut.as_bytes());
        assert_eq!((model.scene.triangle_count(), model.warnings.len()), (1, 1));
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
