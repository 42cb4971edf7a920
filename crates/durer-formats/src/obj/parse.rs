//! The statements of an OBJ file.

mod element;
mod finish;

use super::corners::{Corner, Corners, NONE};
use super::count::{Counts, is_off};
use super::repairs::{Repairs, note};
use crate::text::{self, Cursor, quote};
use crate::wording::{counted, there_are};
use crate::{Error, Limits, Place, Result};
use durer::math::{DVec3, Vec2, Vec3};
use element::Part;
use std::collections::HashMap;

/// Statements of free-form curves and surfaces.
const FREE_FORM: &[&[u8]] = &[
    b"vp", b"cstype", b"deg", b"bmat", b"step", b"curv", b"curv2", b"surf", b"parm", b"trim",
    b"hole", b"scrv", b"sp", b"end", b"con", b"mg",
];

/// Statements about how a renderer should show faces, which change no shape and no material.
const IDLE: &[&[u8]] =
    &[b"lod", b"bevel", b"c_interp", b"d_interp", b"shadow_obj", b"trace_obj", b"stech", b"ctech"];

/// Primitives from `start` on have this material and these names, until the next run.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Run {
    pub start: usize,
    pub material: Option<usize>,
    pub object: String,
    pub group: String,
}

impl Run {
    /// Returns the name of its primitives and of their part: the object's in files with several objects, else the
    /// group's; if one is missing, the other.
    pub fn name(&self, has_objects: bool) -> &str {
        let (first, second) = match has_objects {
            true => (&self.object, &self.group),
            false => (&self.group, &self.object),
        };
        if first.is_empty() { second } else { first }
    }
}

/// Contents of the statements.
#[derive(Debug, Default)]
pub(super) struct Parsed {
    pub positions: Vec<DVec3>,
    /// sRGB; empty or as long as `positions`.
    pub colors: Vec<Vec3>,
    pub tex_coords: Vec<Vec2>,
    pub normals: Vec<Vec3>,
    /// Their normals may be numbers of smoothing groups, see [`super::smooth`].
    pub triangles: Corners,
    pub triangle_runs: Vec<Run>,
    /// First triangle of each face; empty while all faces are triangles.
    pub faces: Vec<u32>,
    /// Positions, two per line.
    pub lines: Vec<u32>,
    pub line_runs: Vec<Run>,
    pub points: Vec<u32>,
    pub point_runs: Vec<Run>,
    /// Names in `usemtl`, by first use.
    pub materials: Vec<String>,
    /// Operands of `mtllib`, with their lines.
    pub libraries: Vec<(u64, String)>,
    pub repairs: Repairs,
}

impl Parsed {
    /// Returns whether the file has several objects; if it has one, its groups are the parts.
    pub fn has_objects(&self) -> bool {
        let runs = [&self.triangle_runs, &self.line_runs, &self.point_runs];
        let mut named = runs.into_iter().flatten().map(|r| &r.object).filter(|o| !o.is_empty());
        named.next().is_some_and(|first| named.any(|o| o != first))
    }
}

/// Reads all statements.
///
/// # Errors
/// See [`super::read`].
pub(super) fn parse(text: &[u8], counts: &Counts, limits: &Limits) -> Result<Parsed> {
    let mut parser = Parser::new(text, counts, limits);
    while !parser.cursor.at_end() {
        parser.statement()?;
        parser.cursor.next_line();
    }
    parser.finish()
}

struct Parser<'a> {
    cursor: Cursor<'a>,
    counts: &'a Counts,
    limit: u64,
    out: Parsed,
    material_numbers: HashMap<&'a [u8], usize>,
    material: Option<usize>,
    object: &'a [u8],
    group: &'a [u8],
    /// Parts and materials for which the last run of triangles, lines and points was begun.
    open: [Option<Part<'a>>; 3],
    /// The largest color value, to distinguish 0…1 from 0…255.
    brightest: f32,
    /// Faces with three or more corners so far.
    faces: usize,
    /// Placeholder for the normal of a corner that has none: [`NONE`], or in files with smoothing groups a number after
    /// the normals' numbers: the first for flat faces, then one for each group.
    smoothing: u32,
    groups: HashMap<&'a [u8], u32>,
}

/// The three kinds of values that corners refer to.
#[derive(Clone, Copy)]
enum Kind {
    Position,
    TexCoord,
    Normal,
}

impl<'a> Parser<'a> {
    fn new(text: &'a [u8], counts: &'a Counts, limits: &Limits) -> Self {
        let mut out = Parsed::default();
        out.positions.reserve_exact(counts.positions);
        out.tex_coords.reserve_exact(counts.tex_coords);
        out.normals.reserve_exact(counts.normals);
        out.triangles.indices.reserve_exact(3 * counts.triangles);
        out.lines.reserve_exact(2 * counts.lines);
        out.points.reserve_exact(counts.points);
        Self {
            cursor: Cursor::new(text),
            counts,
            limit: limits.primitives,
            out,
            material_numbers: HashMap::new(),
            material: None,
            object: b"",
            group: b"",
            open: [None; 3],
            brightest: 0.0,
            faces: 0,
            // The manual's default is off, where groups are used at all.
            smoothing: if counts.smoothing { counts.normals as u32 } else { NONE },
            groups: HashMap::new(),
        }
    }

    fn statement(&mut self) -> Result<()> {
        let Some(word) = self.cursor.word() else { return Ok(()) };
        match word {
            b"v" => self.position(),
            b"vt" => self.tex_coord(),
            b"vn" => self.normal(),
            b"f" | b"fo" => self.face(),
            b"l" => self.line(),
            b"p" => self.points(),
            _ => {
                self.naming(word);
                Ok(())
            }
        }
    }

    /// Parses statements with names, and unknown statements.
    fn naming(&mut self, word: &[u8]) {
        match word {
            b"usemtl" => {
                let name = self.cursor.rest();
                let next = self.material_numbers.len();
                let number = *self.material_numbers.entry(name).or_insert(next);
                if number == next {
                    self.out.materials.push(text::name(name).into_owned());
                }
                self.material = Some(number);
            }
            b"mtllib" => {
                let name = text::name(self.cursor.rest()).into_owned();
                self.out.libraries.push((self.cursor.line(), name));
            }
            b"o" => self.object = self.cursor.rest(),
            b"g" => self.group = self.cursor.rest(),
            b"s" => self.smoothing_group(),
            _ if IDLE.contains(&word) => {}
            _ if FREE_FORM.contains(&word) => {
                let place = self.cursor.place();
                self.out.repairs.free_form.add(|| place);
            }
            _ => {
                let place = self.cursor.place();
                if self.out.repairs.unknown.count == 0 {
                    self.out.repairs.unknown_word = quote(word);
                }
                self.out.repairs.unknown.add(|| place);
            }
        }
    }

    fn smoothing_group(&mut self) {
        let name = self.cursor.word().unwrap_or_default();
        let flat = self.counts.normals as u32;
        if self.counts.smoothing && is_off(Some(name)) {
            self.smoothing = flat;
        } else if self.counts.smoothing {
            let next = self.groups.len() as u32;
            let group = *self.groups.entry(name).or_insert(next);
            self.smoothing = flat.saturating_add(1).saturating_add(group).min(NONE - 1);
        }
    }

    /// Reads the numbers of a statement that needs `least` of them; NaN where they cannot be read.
    fn numbers<const N: usize>(&mut self, what: &str, least: usize) -> Result<([f64; N], usize)> {
        self.numbers_or_error(what, least).or_else(|error| {
            let repairs = &mut self.out.repairs;
            note(&mut repairs.bad_numbers, &mut repairs.bad_number, error)?;
            Ok(([f64::NAN; N], least))
        })
    }

    fn numbers_or_error<const N: usize>(
        &mut self,
        what: &str,
        least: usize,
    ) -> Result<([f64; N], usize)> {
        let line = self.cursor.line();
        let mut values = [0.0; N];
        let count = self.cursor.floats(&mut values)?;
        if count < least {
            let numbers = counted(count as u64, "number", "numbers");
            let message = format!("`{what}` has {numbers}; it needs {least}");
            return Err(Error::line(line, 0, message));
        }
        Ok((values, count))
    }

    fn position(&mut self) -> Result<()> {
        let ([x, y, z, a, b, c, ..], count) = self.numbers::<7>("v", 3)?;
        let p = DVec3::new(x, y, z);
        if !p.is_finite() {
            let line = self.cursor.line();
            self.out.repairs.non_finite.add(|| Place::Line(line, 0));
        }
        self.out.positions.push(p);
        if count >= 6 || !self.out.colors.is_empty() {
            self.color((count >= 6).then(|| Vec3::new(a as f32, b as f32, c as f32)));
        }
        Ok(())
    }

    /// Adds the color of the last position; white before the first color and if there is none.
    fn color(&mut self, color: Option<Vec3>) {
        let colors = &mut self.out.colors;
        if colors.is_empty() {
            colors.reserve_exact(self.counts.positions);
        }
        colors.resize(self.out.positions.len() - 1, Vec3::ONE);
        let color = color.filter(|c| c.is_finite());
        if color.is_none() {
            self.out.repairs.no_color.add(|| Place::Line(self.cursor.line(), 0));
        }
        colors.push(color.unwrap_or(Vec3::ONE));
        self.brightest = self.brightest.max(color.map_or(0.0, Vec3::max_element));
    }

    fn tex_coord(&mut self) -> Result<()> {
        let ([u, v, _], _) = self.numbers::<3>("vt", 1)?;
        let [u, v] = if u.is_nan() || v.is_nan() { [0.0; 2] } else { [u, v] };
        self.out.tex_coords.push(Vec2::new(u as f32, (1.0 - v) as f32));
        Ok(())
    }

    fn normal(&mut self) -> Result<()> {
        let ([x, y, z], _) = self.numbers::<3>("vn", 3)?;
        let n = DVec3::new(x, y, z);
        let n = if n.is_finite() { n.normalize_or_zero() } else { DVec3::ZERO };
        self.out.normals.push(n.as_vec3());
        Ok(())
    }

    /// Reads `v`, `v/vt`, `v//vn` or `v/vt/vn`; `None` if the line is over.
    fn corner(&mut self) -> Result<Option<Corner>> {
        if self.cursor.line_is_over() {
            return Ok(None);
        }
        let Some(position) = self.cursor.integer_here() else { return Err(self.not_a_corner()) };
        let (mut tex_coord, mut normal) = (None, None);
        if self.cursor.take(b'/') {
            tex_coord = self.cursor.integer_here();
            if self.cursor.take(b'/') {
                normal = self.cursor.integer_here();
            }
        }
        if !self.cursor.word_is_over() {
            return Err(self.not_a_corner());
        }
        let position = self.resolve(position, Kind::Position)?;
        let (tex_coord, normal) = self.only_existing(tex_coord, normal);
        let tex_coord = tex_coord.map(|i| self.resolve(i, Kind::TexCoord)).transpose()?;
        let normal = normal.map(|i| self.resolve(i, Kind::Normal)).transpose()?;
        Ok(Some(Corner {
            position,
            tex_coord: tex_coord.unwrap_or(NONE),
            normal: normal.unwrap_or(self.smoothing),
        }))
    }

    /// Drops references to texture coordinates or normals if the file has none at all: some writers number them
    /// nevertheless.
    fn only_existing(&mut self, t: Option<i64>, n: Option<i64>) -> (Option<i64>, Option<i64>) {
        let kept =
            (t.filter(|_| self.counts.tex_coords > 0), n.filter(|_| self.counts.normals > 0));
        if kept != (t, n) {
            let place = self.cursor.place();
            self.out.repairs.no_attributes.add(|| place);
        }
        kept
    }

    fn not_a_corner(&mut self) -> Error {
        let word = self.cursor.current_word();
        let message = format!("`{word}` is not a corner; it should be v, v/vt, v//vn or v/vt/vn");
        self.cursor.error(message)
    }

    /// Resolves an index of the file, from 1 on or back from −1.
    fn resolve(&self, index: i64, kind: Kind) -> Result<u32> {
        let (total, so_far) = match kind {
            Kind::Position => (self.counts.positions, self.out.positions.len()),
            Kind::TexCoord => (self.counts.tex_coords, self.out.tex_coords.len()),
            Kind::Normal => (self.counts.normals, self.out.normals.len()),
        };
        let from_zero = if index < 0 { so_far as i64 + index } else { index - 1 };
        if from_zero >= 0 && (from_zero as u64) < total as u64 {
            return Ok(from_zero as u32);
        }
        let what = match kind {
            Kind::Position => "vertex",
            Kind::TexCoord => "texture coordinate",
            Kind::Normal => "normal",
        };
        let there = match index {
            0.. => there_are(total as u64),
            _ => there_are(so_far as u64) + " so far",
        };
        Err(self.cursor.error(format!(
            "{what} {index} does not exist: {there}, counted from 1, or back from -1"
        )))
    }
}
