//! STL as text.

use super::{add, check_limit, finished};
use crate::last_digit::last_digit;
use crate::model::count_infinite;
use crate::text::{Cursor, Tally, quote};
use crate::wording::counted;
use crate::{Error, Limits, Model, Place, Result, number, place, polygon};
use durer::math::DVec3;
use durer::scene::{Mesh, Part};
use std::collections::BTreeMap;

/// Reads the text.
///
/// # Errors
/// As [`super::read`].
pub(super) fn read(text: &[u8], limits: &Limits) -> Result<Model> {
    let mut model = Model { format: "STL, ascii".to_owned(), ..Model::default() };
    let mut cursor = Cursor::new(text);
    let mut ascii = Ascii { text, limits: limits.clone(), ..Ascii::default() };
    while !cursor.at_end() {
        ascii.line(&mut cursor)?;
        cursor.next_line();
    }
    ascii.decimal_commas.append(std::mem::take(&mut cursor.commas));
    ascii.end(&mut model, &cursor)?;
    let origin = place::origin(&ascii.points);
    let parts = ascii.parts();
    let mut mesh =
        Mesh { positions: place::narrow(&ascii.points, origin), parts, ..Mesh::default() };
    if !ascii.faces.is_empty() {
        mesh.faces = ascii.faces;
        mesh.indices = Some((0..mesh.positions.len() as u32).collect());
        polygon::recut(&mut model, &mut mesh, limits)?;
    }
    model.scene.last_digit = last_digit(text, b"vertex");
    let infinite = count_infinite(&mesh.positions);
    add(&mut model, mesh, origin);
    finished(model, infinite)
}

/// State of the reader.
#[derive(Default)]
struct Ascii<'a> {
    text: &'a [u8],
    points: Vec<DVec3>,
    /// First triangle of each facet, once one has several.
    faces: Vec<u32>,
    /// Facets so far.
    count: u32,
    /// Vertices of the facet that is open.
    open: usize,
    inside_facet: bool,
    inside_solid: bool,
    solids: Vec<(usize, String)>,
    unknown: Tally,
    /// Facets of fewer than three vertices.
    small: Tally,
    decimal_commas: Tally,
    /// Vertices that are not three numbers, and the fault of the first.
    bad_vertices: Tally,
    bad_vertex: Option<Error>,
    /// True if the current facet has such a vertex.
    spoiled: bool,
    limits: Limits,
}

/// Returns whether the first facet of a solid begins here: its name may be on the same line.
fn begins_facet(rest: &[u8]) -> bool {
    let mut words = Cursor::new(rest.get(..64).unwrap_or(rest));
    let mut is = |word: &[u8]| words.word().is_some_and(|w| w.eq_ignore_ascii_case(word));
    is(b"facet") && is(b"normal")
}

/// Returns whether the next solid begins here, of a file that is one line.
fn begins_solid(rest: &[u8]) -> bool {
    let mut words = Cursor::new(rest.get(..256).unwrap_or(rest));
    words.word().is_some_and(|w| w.eq_ignore_ascii_case(b"solid"))
        && std::iter::from_fn(|| words.word()).any(|w| w.eq_ignore_ascii_case(b"facet"))
}

impl<'a> Ascii<'a> {
    fn line(&mut self, cursor: &mut Cursor<'a>) -> Result<()> {
        // A file may hold all of it in one line.
        while let Some(word) = cursor.word() {
            let is = |keyword: &[u8]| word.eq_ignore_ascii_case(keyword);
            if is(b"vertex") {
                let place = cursor.place();
                if let Err(why) = self.vertex(cursor) {
                    self.spoiled = true;
                    self.bad_vertices.add(|| place);
                    self.bad_vertex.get_or_insert(why);
                }
            } else if is(b"facet") {
                self.begin_facet(cursor)?;
            } else if is(b"endfacet") {
                self.close_facet(cursor)?;
            } else if is(b"solid") {
                self.begin_solid(cursor);
            } else if is(b"endsolid") {
                self.end_solid(cursor);
            } else if is(b"end") {
                self.end_of(cursor)?;
            } else if is(b"normal") {
                // Not used, so errors in it are ignored.
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

    /// Reads `end loop`, `end facet` or `end solid`, written as two words.
    fn end_of(&mut self, cursor: &mut Cursor<'a>) -> Result<()> {
        let what = cursor.word().unwrap_or_default().to_ascii_lowercase();
        match &what[..] {
            b"facet" => return self.close_facet(cursor),
            b"solid" => self.end_solid(cursor),
            b"loop" => {}
            _ => self.unknown.add(|| cursor.place()),
        }
        Ok(())
    }

    fn begin_solid(&mut self, cursor: &mut Cursor<'a>) {
        self.inside_solid = true;
        let name = String::from_utf8_lossy(cursor.rest_before(begins_facet)).into_owned();
        self.solids.push((self.points.len() / 3, name));
    }

    fn end_solid(&mut self, cursor: &mut Cursor<'a>) {
        self.inside_solid = false;
        cursor.rest_before(begins_solid);
    }

    fn begin_facet(&mut self, cursor: &Cursor<'a>) -> Result<()> {
        if self.open > 0 || self.spoiled {
            // The last one's end is missing.
            self.close_facet(cursor)?;
        }
        self.inside_facet = true;
        Ok(())
    }

    fn vertex(&mut self, cursor: &mut Cursor<'a>) -> Result<()> {
        let (start, sloppy) = (cursor.offset(), cursor.sloppy.count);
        let mut values = [0.0; 3];
        let mut count = cursor.floats(&mut values)?;
        if cursor.sloppy.count > sloppy {
            let text = self.text.get(start..cursor.offset()).unwrap_or_default();
            count = self.with_commas(text, cursor, &mut values)?;
        }
        if count < 3 {
            let numbers = counted(count as u64, "number", "numbers");
            let message = format!("`vertex` has {numbers}; it needs 3");
            return Err(Error::line(cursor.line(), 0, message));
        }
        self.open += 1;
        self.reserve(cursor.offset());
        self.points.push(DVec3::from_array(values));
        Ok(())
    }

    /// Reads numbers with commas between them, or with commas for decimal points.
    fn with_commas(
        &mut self,
        text: &[u8],
        cursor: &Cursor<'_>,
        values: &mut [f64; 3],
    ) -> Result<usize> {
        let words = text.split(u8::is_ascii_whitespace).filter(|w| !w.is_empty());
        for (value, word) in values.iter_mut().zip(words) {
            let word = word.strip_suffix(b",").unwrap_or(word);
            let point: Vec<u8> = word.iter().map(|&b| if b == b',' { b'.' } else { b }).collect();
            match number::float(&point) {
                Some((number, length)) if length == point.len() => *value = number,
                _ => {
                    let message = format!("`{}` is not a number", quote(word));
                    return Err(Error::line(cursor.line(), 0, message));
                }
            }
            if point != word {
                self.decimal_commas.add(|| cursor.place());
            }
        }
        Ok(3)
    }

    /// Grows by halves, not by doubling, so that memory stays near what is needed.
    fn reserve(&mut self, read: usize) {
        if self.points.len() == self.points.capacity() {
            // Estimated from the bytes per vertex read so far; the first guess is one page.
            let more = (self.points.len() / 2).max(read.min(256)).max(16);
            self.points.reserve_exact(more);
        }
    }

    fn close_facet(&mut self, cursor: &Cursor<'_>) -> Result<()> {
        let open = std::mem::take(&mut self.open);
        self.inside_facet = false;
        let spoiled = std::mem::take(&mut self.spoiled);
        if spoiled || open < 3 {
            self.points.truncate(self.points.len() - open);
            if !spoiled {
                self.small.add(|| cursor.place());
            }
            return Ok(());
        }
        let first = (self.points.len() - open) / 3;
        if open > 3 {
            self.fan(open);
        }
        if open > 3 && self.faces.is_empty() {
            self.faces.extend(0..self.count);
        }
        if open > 3 || !self.faces.is_empty() {
            self.faces.push(first as u32);
        }
        self.count += 1;
        check_limit(self.points.len() as u64 / 3, &self.limits)
    }

    /// Makes the last this many points triangles that all have the first of them.
    fn fan(&mut self, count: usize) {
        let corners = self.points.split_off(self.points.len() - count);
        let Some((&first, rest)) = corners.split_first() else { return };
        self.points.extend(rest.windows(2).flat_map(|pair| [first, pair[0], pair[1]]));
    }

    /// Drops the incomplete rest of a truncated file.
    fn end(&mut self, model: &mut Model, cursor: &Cursor<'_>) -> Result<()> {
        let cut = self.inside_facet || self.open > 0;
        if self.open >= 3 && !self.spoiled {
            // All vertices are present; only the closing words are missing.
            self.close_facet(cursor)?;
        }
        let whole = self.points.len() - self.open;
        self.points.truncate(whole);
        let place = Place::Line(cursor.line(), 0);
        if whole == 0
            && let Some(why) = self.bad_vertex.take()
        {
            return Err(why);
        }
        if cut && whole == 0 {
            let message = "the file ends inside its first facet; `endloop`, `endfacet`, `endsolid` are missing";
            return Err(Error::Decode { place, message: message.to_owned() });
        }
        self.check_words(cut)?;
        self.warn(model);
        if cut || self.inside_solid {
            let message = format!(
                "the file ends without `endsolid`; {} read",
                counted(whole as u64 / 3, "whole triangle was", "whole triangles were")
            );
            model.warn(place, message);
        }
        Ok(())
    }

    /// Refuses files without a facet that have other words or invalid facets.
    fn check_words(&self, cut: bool) -> Result<()> {
        if !self.points.is_empty() || cut {
            return Ok(());
        }
        let (tally, message) = if self.small.count > 0 {
            (&self.small, "no facet has three vertices: there is nothing to show")
        } else if self.unknown.count > 0 {
            (&self.unknown, "neither `facet` nor `endsolid` follows `solid`: this is not STL")
        } else {
            return Ok(());
        };
        Err(Error::Decode { place: tally.first.clone(), message: message.to_owned() })
    }

    fn warn(&self, model: &mut Model) {
        for (tally, message) in [
            (&self.unknown, "{word is|words are} not STL and {was|were} skipped"),
            (
                &self.small,
                "{facet has|facets have} fewer than three vertices and {was|were} left out",
            ),
            (
                &self.bad_vertices,
                "{vertex is not three numbers; its facet was|vertices are not three numbers; their facets were} left out",
            ),
            (&self.decimal_commas, crate::text::COMMAS),
        ] {
            model.warn_of(tally, message);
        }
    }

    /// Returns the names of the solids; solids without a name, or with the name of an earlier one, get a number.
    fn names<'b>(&'b self) -> Vec<String> {
        let mut seen: BTreeMap<&str, usize> = BTreeMap::new();
        let several = self.solids.len() > 1;
        let mut name = |name: &'b str| {
            let is_made = name.is_empty() && several;
            let stem = if is_made { "solid" } else { name };
            let count = seen.entry(stem).and_modify(|n| *n += 1).or_insert(1);
            if *count > 1 || is_made { format!("{stem} {count}") } else { stem.to_owned() }
        };
        self.solids.iter().map(|s| name(&s.1)).collect()
    }

    /// Returns the parts: each solid is one, if there are several or the only one has a name. If there are several,
    /// each has its own name.
    fn parts(&self) -> Vec<Part> {
        let count = self.points.len() / 3;
        if self.solids.iter().all(|(_, name)| name.is_empty()) && self.solids.len() < 2 {
            return Vec::new();
        }
        let starts = [0].into_iter().chain(self.solids.iter().skip(1).map(|s| s.0));
        let ends = self.solids.iter().skip(1).map(|s| s.0).chain([count]);
        starts
            .zip(ends)
            .zip(self.names())
            .map(|((start, end), name)| Part {
                range: start as u32..end as u32,
                material: None,
                name,
            })
            .collect()
    }
}

#[cfg(test)]
mod tests;
