//! OFF, Geomview's object file format, as text.
//!
//! Source: The Geometry Center, *Geomview Manual*, 1996, section *OFF Files*; with the practice of later writers: no
//! line end after `OFF`, colours of vertices even if the first word does not announce them, three components of colour
//! instead of four. Faces of two vertices are lines. Colours are sRGB, of vertices or of faces; indices of colour maps
//! are ignored. y is up.
//!
//! Cost: one pass. Memory: 24 bytes per vertex while reading, and the mesh.

use crate::facets::{self, Attributes, Facets};
use crate::last_digit::last_digit;
use crate::model::count_infinite;
use crate::obj::corners::NONE;
use crate::text::{Cursor, Tally, quote, utf8};
use crate::wording::there_are;
use crate::{Error, Limits, Model, Place, ReadOptions, Resources, Result, place};
use durer::math::{DVec3, Vec2, Vec4};
use durer::scene::{Instance, Mesh, Topology};

/// Numbers that a vertex may have.
const NUMBERS: usize = 12;
/// Number of bytes at the start of a file in which its first word is searched.
const PROBE: usize = 4096;

/// Attributes of vertices according to the first word of a file.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
struct Kind {
    tex_coords: bool,
    normals: bool,
    /// A fourth coordinate, or any number of them.
    dimensions: bool,
    /// Length of the word; a count may follow at once.
    length: usize,
}

impl Kind {
    /// Parses a word, if it is one of the format's.
    fn of(word: &[u8]) -> Option<Self> {
        let mut kind = Self::default();
        let mut rest = word;
        let mut take = |prefix: &[u8]| match rest.strip_prefix(prefix) {
            Some(after) => {
                rest = after;
                true
            }
            None => false,
        };
        kind.tex_coords = take(b"ST");
        take(b"C");
        kind.normals = take(b"N");
        kind.dimensions = take(b"4") | take(b"n");
        let plain = take(b"OFF") || take(b"off");
        kind.length = word.len() - rest.len();
        (plain && rest.iter().all(u8::is_ascii_digit)).then_some(kind)
    }
}

/// Returns whether the content begins as OFF does.
pub(crate) fn sniff(bytes: &[u8]) -> bool {
    let text = utf8(bytes.get(..PROBE).unwrap_or(bytes));
    let mut cursor = Cursor::new(&text);
    let Some(word) = next_word(&mut cursor) else { return false };
    if Kind::of(word).is_none() {
        return false;
    }
    // A count or the end, but not a word of prose.
    let next = next_word(&mut cursor).unwrap_or(b"0");
    next == b"BINARY" || next.iter().all(u8::is_ascii_digit)
}

fn next_word<'a>(cursor: &mut Cursor<'a>) -> Option<&'a [u8]> {
    while !cursor.at_end() {
        if let Some(word) = cursor.word() {
            return Some(word);
        }
        cursor.next_line();
    }
    None
}

/// Reads an OFF file.
///
/// A truncated file is read up to its end, and faces with missing vertices are left out, with a warning.
///
/// # Errors
/// [`Error::Decode`] with the line for a file that does not begin as OFF, a word that is not a number, or
/// where no vertex, or no vertex of a face, is there; [`Error::Unsupported`] for binary files and those
/// of four dimensions; [`Error::Limit`] for more primitives than allowed.
pub fn read(bytes: &[u8], _resources: &dyn Resources, options: &ReadOptions) -> Result<Model> {
    let text = utf8(bytes);
    let mut cursor = Cursor::new(&text);
    let mut model = Model { format: "OFF".to_owned(), ..Model::default() };
    let (kind, counts) = header(&mut cursor, &text)?;
    let mut reader = Reader { kind, counts, limits: options.limits.clone(), ..Reader::default() };
    match reader.body(&mut cursor) {
        Err(why) if reader.has_something() => reader.warn_of_end(&mut model, why)?,
        other => other?,
    }
    model.warn_of(&cursor.commas, crate::text::COMMAS);
    model.scene.last_digit = last_digit(&text, b"");
    reader.into_model(model)
}

/// Returns the first word, and the numbers of vertices and faces.
fn header<'a>(cursor: &mut Cursor<'a>, text: &'a [u8]) -> Result<(Kind, [u64; 2])> {
    let word = next_word(cursor).unwrap_or_default();
    // Some files lack the word and begin with the counts.
    let kind = Kind::of(word).or(word.iter().all(u8::is_ascii_digit).then(Kind::default));
    let Some(kind) = kind.filter(|_| !word.is_empty()) else {
        let message = format!("an OFF file begins with `OFF`, not with `{}`", quote(word));
        return Err(cursor.error(message));
    };
    if kind.dimensions {
        let (what, hint) = ("OFF of four or more dimensions", "project it to three");
        return Err(unsupported(cursor, what, hint));
    }
    let mut after = cursor.clone();
    if after.word() == Some(b"BINARY") {
        return Err(unsupported(cursor, "binary OFF", "Geomview and MeshLab write it as text"));
    }
    let start = cursor.offset() - word.len() + kind.length;
    let mut counts = Cursor::at_line(text.get(start..).unwrap_or_default(), cursor.line());
    let all = [count(&mut counts, "vertices")?, count(&mut counts, "faces")?];
    // That of edges follows, or not.
    let line = counts.line();
    counts.next_line();
    *cursor = Cursor::at_line(text.get(start + counts.offset()..).unwrap_or_default(), line + 1);
    Ok((kind, all))
}

fn unsupported(cursor: &Cursor<'_>, what: &str, hint: &str) -> Error {
    Error::Unsupported { place: cursor.place(), what: what.to_owned(), hint: hint.to_owned() }
}

fn count(cursor: &mut Cursor<'_>, of: &str) -> Result<u64> {
    let word = next_word(cursor).unwrap_or_default();
    let count = std::str::from_utf8(word).ok().and_then(|w| w.parse().ok());
    count.ok_or_else(|| cursor.error(format!("`{}` is not a number of {of}", quote(word))))
}

/// State of the reader.
#[derive(Default)]
struct Reader {
    kind: Kind,
    /// Numbers of vertices and faces according to the file.
    counts: [u64; 2],
    limits: Limits,
    /// True if the file ended too early.
    ended: bool,
    points: Vec<DVec3>,
    vertices: Attributes,
    facets: Facets,
    lines: Vec<u32>,
    corners: Vec<u32>,
    faces: u64,
    dangling: Tally,
    small: Tally,
    odd: Tally,
    mapped: Tally,
}

impl Reader {
    fn body(&mut self, cursor: &mut Cursor<'_>) -> Result<()> {
        let [vertices, faces] = self.counts;
        let room = cursor.bytes_left() as u64 / 2 + 1;
        self.check(vertices.min(room), "number of vertices", cursor)?;
        self.points.reserve_exact(vertices.min(room / 3) as usize);
        for _ in 0..vertices {
            self.vertex(cursor)?;
        }
        for _ in 0..faces {
            self.face(cursor)?;
            self.check(
                self.facets.triangles.indices.len() as u64 / 3,
                "number of triangles",
                cursor,
            )?;
        }
        Ok(())
    }

    fn check(&self, value: u64, what: &'static str, cursor: &Cursor<'_>) -> Result<()> {
        let limit = self.limits.primitives.min(u64::from(u32::MAX / 3));
        if value <= limit {
            Ok(())
        } else {
            Err(Error::Limit { place: cursor.place(), what, value, limit })
        }
    }

    /// Returns the next number, on this line or a later one.
    fn number(&mut self, cursor: &mut Cursor<'_>) -> Result<f64> {
        loop {
            if let Some(value) = cursor.float()? {
                return Ok(value);
            }
            if cursor.at_end() {
                self.ended = true;
                return Err(Error::line(cursor.line(), 0, "the file ends too early"));
            }
            cursor.next_line();
        }
    }

    fn vertex(&mut self, cursor: &mut Cursor<'_>) -> Result<()> {
        let Kind { tex_coords, normals, .. } = self.kind;
        let fixed = 3 + 3 * usize::from(normals);
        let mut values = [0.0; NUMBERS];
        for value in values.iter_mut().take(fixed) {
            *value = self.number(cursor)?;
        }
        let [x, y, z, nx, ny, nz, ..] = values;
        let mut rest = [0.0; NUMBERS];
        let mut count = cursor.floats(&mut rest)?;
        if tex_coords && count >= 2 {
            count -= 2;
            let [u, v] = [rest[count], rest[count + 1]].map(|v| v as f32);
            self.vertices.tex_coords.resize(self.points.len(), Vec2::ZERO);
            self.vertices.tex_coords.push(Vec2::new(u, 1.0 - v));
        }
        match rest {
            [r, g, b, a, ..] if matches!(count, 3 | 4) => {
                let alpha = if count == 4 { a } else { f64::INFINITY };
                let color = [r, g, b, alpha].map(|c| c as f32);
                self.vertices.colors.resize(self.points.len(), Vec4::INFINITY);
                self.vertices.colors.push(Vec4::from_array(color));
            }
            _ if count > 0 => self.odd.add(|| cursor.place()),
            _ => {}
        }
        if normals {
            let n = DVec3::new(nx, ny, nz);
            let n = if n.is_finite() { n.normalize_or_zero() } else { DVec3::ZERO };
            self.vertices.normals.push(n.as_vec3());
        }
        self.points.push(DVec3::new(x, y, z));
        Ok(())
    }

    fn face(&mut self, cursor: &mut Cursor<'_>) -> Result<()> {
        let length = self.number(cursor)?;
        if !(0.0..=f64::from(u32::MAX)).contains(&length) || length.fract() != 0.0 {
            return Err(cursor.error(format!("`{length}` is not a number of vertices of a face")));
        }
        self.corners.clear();
        let mut whole = true;
        for _ in 0..length as u64 {
            let value = self.number(cursor)?;
            let there = value >= 0.0 && value < self.points.len() as f64 && value.fract() == 0.0;
            if whole && !there {
                self.dangling.add(|| cursor.place());
            }
            whole &= there;
            self.corners.push(value as u32);
        }
        let color = self.face_color(cursor)?;
        self.faces += 1;
        match &self.corners[..] {
            _ if !whole => {}
            [] | [_] => self.small.add(|| cursor.place()),
            ends @ [_, _] => self.lines.extend(ends),
            corners => {
                let color = color.map_or(NONE, |c| self.facets.palette.number(c));
                self.facets.add(corners, &[], color);
            }
        }
        Ok(())
    }

    /// Reads the colour after the vertices of a face.
    fn face_color(&mut self, cursor: &mut Cursor<'_>) -> Result<Option<[f32; 4]>> {
        let mut rest = [0.0; 5];
        let count = cursor.floats(&mut rest)?;
        let [r, g, b, a] = [rest[0], rest[1], rest[2], rest[3]].map(|c| c as f32);
        match count {
            0 => return Ok(None),
            1 => self.mapped.add(|| cursor.place()),
            3 => return Ok(Some([r, g, b, f32::INFINITY])),
            4 => return Ok(Some([r, g, b, a])),
            _ => self.odd.add(|| cursor.place()),
        }
        Ok(None)
    }

    /// Returns whether there is something to show if the file ends here.
    fn has_something(&self) -> bool {
        !self.facets.triangles.indices.is_empty() || (self.ended && !self.points.is_empty())
    }

    /// Warns of where the file breaks off.
    ///
    /// # Errors
    /// `why`, if it is a limit.
    fn warn_of_end(&self, model: &mut Model, why: Error) -> Result<()> {
        let Error::Decode { place, message } = why else { return Err(why) };
        let ([vertices, faces], points, read) = (self.counts, self.points.len(), self.faces);
        let message = format!(
            "{message}: {points} of {vertices} vertices and {read} of {faces} faces are read"
        );
        model.warn(place, message);
        Ok(())
    }

    fn into_model(mut self, mut model: Model) -> Result<Model> {
        let nothing = self.facets.triangles.indices.is_empty() && self.lines.is_empty();
        if nothing && self.dangling.count > 0 {
            let (place, count) = (self.dangling.first, self.points.len());
            let there = there_are(count as u64);
            let message = format!("this vertex does not exist: {there}, counted from 0");
            return Err(Error::Decode { place, message });
        }
        self.warn(&mut model);
        let origin = place::origin(&self.points);
        self.vertices.positions = place::narrow(&self.points, origin);
        let count = self.points.len();
        self.points = Vec::new();
        let Attributes { colors, tex_coords, positions, .. } = &mut self.vertices;
        model.warn_infinite(count_infinite(positions));
        tex_coords.resize(if tex_coords.is_empty() { 0 } else { count }, Vec2::ZERO);
        colors.resize(if colors.is_empty() { 0 } else { count }, Vec4::INFINITY);
        to_unit(colors);
        facets::make_linear(&mut model, colors);
        to_unit(&mut self.facets.palette.colors);
        facets::make_linear(&mut model, &mut self.facets.palette.colors);
        let mut meshes = self.meshes(&mut model)?;
        facets::show_colors(&mut model, &mut meshes);
        for (mesh, number) in meshes.into_iter().zip(0..) {
            model.scene.meshes.push(mesh);
            let (world_from_mesh, name) = (place::matrix(origin), String::new());
            model.scene.instances.push(Instance { mesh: number, world_from_mesh, name });
        }
        model.scene.check()?;
        Ok(model)
    }

    fn warn(&self, model: &mut Model) {
        for (tally, message) in [
            (
                &self.dangling,
                "{face has a vertex that does not exist and was|faces have a vertex that does not exist and were} left out",
            ),
            (
                &self.small,
                "{face has fewer than two vertices and was|faces have fewer than two vertices and were} left out",
            ),
            (&self.odd, "{line has|lines have} further numbers, which were ignored"),
            (&self.mapped, "{face has|faces have} a color by number, which is not shown"),
        ] {
            model.warn_of(tally, message);
        }
        if self.points.is_empty() {
            model.warn(Place::Whole, "holds no vertices");
        }
    }

    /// Returns triangles and lines; else points.
    fn meshes(self, model: &mut Model) -> Result<Vec<Mesh>> {
        let Self { vertices, facets, lines, limits, .. } = self;
        let mut meshes = Vec::new();
        if !lines.is_empty() {
            let (positions, colors) = (vertices.positions.clone(), vertices.colors.clone());
            let (topology, indices) = (Topology::Lines, Some(lines));
            meshes.push(Mesh { topology, positions, colors, indices, ..Mesh::default() });
        }
        if !facets.triangles.indices.is_empty() {
            let mesh = facets::mesh(model, vertices, facets, &[], &limits, |_, _| {})?;
            meshes.insert(0, mesh);
        } else if meshes.is_empty() {
            meshes.push(Mesh { topology: Topology::Points, ..vertices.into_mesh() });
        }
        Ok(meshes)
    }
}

/// Scales colours of bytes to 0 … 1, by the largest of all; components that are not there become 1.
fn to_unit(colors: &mut [Vec4]) {
    let finite = |c: f32| if c.is_finite() { c } else { 0.0 };
    let most = colors.iter().flat_map(|c| c.to_array()).map(finite).fold(0.0, f32::max);
    let scale = if most > 1.0 { 1.0 / 255.0 } else { 1.0 };
    for color in colors {
        let unit = color.to_array().map(|c| if c.is_finite() { c * scale } else { 1.0 });
        *color = Vec4::from_array(unit);
    }
}

#[cfg(test)]
mod tests;
