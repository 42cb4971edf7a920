//! ZIP archives: files in them are found by name and inflated within limits.

use crate::{Error, Limits, Place, Resources, Result, foreign};
use durer::work::Work;
use std::cell::RefCell;
use std::io::{Cursor, Read, Seek};
use zip::ZipArchive;

/// First bytes of an archive with files in it.
pub const MAGIC: &[u8] = b"PK\x03\x04";

/// Memory of a file and of the data read from it, relative to its size: numbers take less than their text.
const PER_BYTE: u64 = 2;

/// Stage of inflating in errors about memory.
const STAGE: &str = "files of the archive";

/// Names in messages are at most this many.
const MOST_NAMES: usize = 4;

/// An open archive.
pub struct Archive<B> {
    archive: ZipArchive<Cursor<B>>,
    /// Bytes that may still be inflated.
    left: u64,
    limit: u64,
    work: Work,
}

impl<B: AsRef<[u8]>> Archive<B> {
    /// Opens the archive that these bytes are.
    ///
    /// # Errors
    /// [`Error::Decode`] for a broken directory.
    pub fn open(bytes: B, limits: &Limits) -> Result<Self> {
        let archive = ZipArchive::new(Cursor::new(bytes)).map_err(|e| broken(&e))?;
        let (left, limit) = (limits.decoded_bytes, limits.decoded_bytes);
        Ok(Self { archive, left, limit, work: limits.work.clone() })
    }

    /// Returns the number of bytes that may still be inflated or decoded.
    pub fn left(&self) -> u64 {
        self.left
    }

    /// Charges this many of the bytes that may still be decoded.
    pub fn charge(&mut self, bytes: u64) {
        self.left = self.left.saturating_sub(bytes);
    }

    /// Returns whether there is a file of this name.
    pub fn has(&self, name: &str) -> bool {
        self.number(name).is_some()
    }

    /// Returns the archive's number of a file; case does not count, as the Open Packaging
    /// Conventions say.
    fn number(&self, name: &str) -> Option<usize> {
        let name = name.trim_start_matches('/');
        let same = |n: &str| n.eq_ignore_ascii_case(name);
        let alike = || self.archive.file_names().position(|n| n.is_ok_and(|n| same(&n)));
        self.archive.index_for_name(name).or_else(alike)
    }

    /// Returns the inflated bytes of a file.
    ///
    /// # Errors
    /// [`Error::Decode`] if it is missing or broken; [`Error::Limit`]; the error of the budget.
    pub fn read(&mut self, name: &str) -> Result<Vec<u8>> {
        let at = |message: String| Error::path(name, message);
        let number = self.number(name).ok_or_else(|| at("is not in the archive".to_owned()))?;
        let file = self.archive.by_index(number);
        let file = file.map_err(|e| at(format!("cannot be read: {}", foreign::zip(&e))))?;
        let (what, limit) = ("size of the inflated parts", self.limit);
        let too_large = |size: u64| {
            let value = (limit - self.left).saturating_add(size);
            Error::Limit { place: Place::Path(name.to_owned()), what, value, limit }
        };
        if file.size() > self.left {
            return Err(too_large(file.size()));
        }
        // The size in the archive is not trusted: no memory is allocated in advance, and reading one byte beyond the
        // limit reveals a wrong size.
        let mut bytes = Vec::new();
        let in_budget = self.work.budget().saturating_sub(self.work.used());
        let mut file = file.take(self.left.min(in_budget).saturating_add(1));
        file.read_to_end(&mut bytes)
            .map_err(|e| at(format!("cannot be inflated: {}", foreign::inflating(&e))))?;
        if bytes.len() as u64 > self.left {
            return Err(too_large(bytes.len() as u64));
        }
        self.left -= bytes.len() as u64;
        self.work.keep(STAGE, PER_BYTE.saturating_mul(bytes.len() as u64))?;
        Ok(bytes)
    }
}

fn broken(error: &zip::result::ZipError) -> Error {
    Error::whole(format!("the ZIP archive is broken: {}", foreign::zip(error)))
}

/// Returns the names of the files in an archive, without those that systems add for themselves.
///
/// # Errors
/// [`Error::Decode`] for a broken directory.
pub fn names(source: impl Read + Seek) -> Result<Vec<String>> {
    let archive = ZipArchive::new(source).map_err(|e| broken(&e))?;
    Ok(files(&archive))
}

fn files<R: Read + Seek>(archive: &ZipArchive<R>) -> Vec<String> {
    let of_system = |name: &str| {
        name.starts_with("__MACOSX/") || name.split('/').any(|part| part.starts_with('.'))
    };
    let names = archive.file_names().filter_map(|name| name.ok().map(|name| name.into_owned()));
    names.filter(|name| !name.ends_with('/') && !of_system(name)).collect()
}

/// The files of an archive as one of them refers to them.
pub struct Inside<B> {
    archive: RefCell<Archive<B>>,
    /// The folder of that file, with a slash at its end if it is not the outermost one.
    folder: String,
}

impl<B: AsRef<[u8]>> Resources for Inside<B> {
    fn read(&self, path: &str, limit: u64) -> std::result::Result<Vec<u8>, String> {
        let name = format!("{}{}", self.folder, path.trim_start_matches("./"));
        let mut archive = self.archive.borrow_mut();
        let bytes = archive.read(&name).map_err(|e| e.to_string())?;
        let fits = bytes.len() as u64 <= limit;
        fits.then_some(bytes).ok_or_else(|| format!("it has more than {limit} bytes"))
    }
}

/// A file of an archive.
pub struct Member<B> {
    /// Its path in the archive.
    pub name: String,
    /// Its bytes.
    pub bytes: Vec<u8>,
    /// The files beside it.
    pub beside: Inside<B>,
    /// The part of the choice that names something within the file.
    pub within: Option<String>,
}

/// Returns the only file of an archive whose name is wanted, or of several the one that is called `choice`, with its
/// folder or without, with its suffix or without. After a slash, a choice among several files can name something within
/// the file, such as a layer; beside a single file, all of the choice does. In messages, `kind` names what is wanted, and
/// `hint` tells what to do about several.
///
/// # Errors
/// [`Error::Unknown`] if no file is wanted; [`Error::Unsupported`] if there are several and the choice is none of them;
/// those of [`Archive::open`] and [`Archive::read`].
pub fn only<B: AsRef<[u8]>>(
    bytes: B,
    limits: &Limits,
    wanted: impl Fn(&str) -> bool,
    (kind, choice, hint): (&'static str, Option<&str>, &'static str),
) -> Result<Member<B>> {
    let mut archive = Archive::open(bytes, limits)?;
    let mut found: Vec<String> =
        files(&archive.archive).into_iter().filter(|name| wanted(name)).collect();
    let mut within = choice;
    if let Some(choice) = choice.filter(|_| found.len() > 1) {
        let (called, rest) = called(&found, choice);
        within = rest;
        if !called.is_empty() {
            found = called;
        }
    }
    match &found[..] {
        [] => Err(Error::Unknown(format!("the ZIP archive holds no {kind}"))),
        [name] => {
            let bytes = archive.read(name)?;
            let folder = name.rfind('/').map_or("", |end| &name[..=end]).to_owned();
            let beside = Inside { archive: RefCell::new(archive), folder };
            let (name, within) = (name.clone(), within.map(str::to_owned));
            Ok(Member { name, bytes, beside, within })
        }
        several => {
            let shown: Vec<&str> = several.iter().map(String::as_str).take(MOST_NAMES).collect();
            let more = if several.len() > MOST_NAMES { ", …" } else { "" };
            let names = shown.join(", ");
            Err(Error::Unsupported {
                place: Place::Whole,
                what: format!("a ZIP archive with {} {kind} ({names}{more})", several.len()),
                hint: hint.to_owned(),
            })
        }
    }
}

/// Returns the files that a choice names, and the rest of the choice after their name and a slash.
fn called<'a>(files: &[String], choice: &'a str) -> (Vec<String>, Option<&'a str>) {
    let ends = choice.rmatch_indices('/').map(|(slash, _)| (slash, Some(&choice[slash + 1..])));
    let mut ways = std::iter::once((choice.len(), None)).chain(ends);
    let found = ways.find_map(|(end, rest)| {
        let files = files.iter().filter(|file| is_called(file, &choice[..end]));
        let files: Vec<String> = files.cloned().collect();
        (!files.is_empty()).then_some((files, rest))
    });
    found.unwrap_or_default()
}

/// Returns whether a path is called so, with its folder or without, with its suffix or without.
fn is_called(path: &str, name: &str) -> bool {
    let file = path.rsplit('/').next().unwrap_or(path);
    let stem = |path: &str| path.rsplit_once('.').map_or(path, |(stem, _)| stem).len();
    [path, file].iter().any(|whole| *whole == name || &whole[..stem(whole)] == name)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write;
    use zip::write::{SimpleFileOptions, ZipWriter};

    fn packed(files: &[(&str, &[u8])]) -> Vec<u8> {
        let mut writer = ZipWriter::new(Cursor::new(Vec::new()));
        for (name, bytes) in files {
            writer.start_file(*name, SimpleFileOptions::default()).expect("memory");
            writer.write_all(bytes).expect("memory");
        }
        writer.finish().expect("memory").into_inner()
    }

    fn message(result: Result<Member<Vec<u8>>>) -> String {
        result.err().expect("refused").to_string()
    }

    #[test]
    fn the_wanted_file_is_found_with_those_beside_it() {
        let archive = packed(&[
            ("__MACOSX/data/a.shp", b"0"),
            ("data/.b.shp", b"0"),
            ("data/a.shp", b"1"),
            ("data/A.DBF", b"2"),
        ]);
        let shp = |name: &str| name.ends_with(".shp");
        let limits = Limits::default();
        let member = only(archive, &limits, shp, ("map data", None, "")).expect("one");
        assert_eq!((&member.name[..], &member.bytes[..]), ("data/a.shp", &b"1"[..]));
        assert_eq!(member.within, None);
        assert_eq!(member.beside.read("a.dbf", 9).expect("case does not count"), b"2");
        assert!(member.beside.read("a.prj", 9).expect_err("none").contains("not in the archive"));
        assert!(member.beside.read("a.dbf", 0).expect_err("large").contains("more than 0 bytes"));
    }

    #[test]
    fn of_several_files_one_is_chosen_by_name() {
        let archive = packed(&[("x/a.stl", b"1"), ("x/b.stl", b"2"), ("y/b.stl", b"3")]);
        let limits = Limits::default();
        let find = |choice| {
            only(
                archive.clone(),
                &limits,
                |_| true,
                ("models", choice, "unpack it, or pack one alone"),
            )
        };
        for (choice, bytes, within) in [
            ("a", b"1", None),
            ("a.stl", b"1", None),
            ("x/b.stl", b"2", None),
            ("y/b", b"3", None),
            ("a/roof", b"1", Some("roof")),
            ("x/b.stl/roof/tiles", b"2", Some("roof/tiles")),
        ] {
            let member = find(Some(choice)).expect(choice);
            let found = (&member.bytes[..], member.within.as_deref());
            assert_eq!(found, (&bytes[..], within), "{choice}");
        }
        let alone = packed(&[("x/a.stl", b"1")]);
        let member = only(alone, &limits, |_| true, ("models", Some("a/roof"), "")).expect("one");
        assert_eq!(member.within.as_deref(), Some("a/roof"), "there is no file to choose");
        for choice in [None, Some("c")] {
            assert_eq!(
                message(find(choice)),
                "a ZIP archive with 3 models (x/a.stl, x/b.stl, y/b.stl) is not \
                 supported; unpack it, or pack one alone"
            );
        }
        assert!(message(find(Some("b"))).contains("2 models (x/b.stl, y/b.stl)"));
        let none = only(archive.clone(), &limits, |_| false, ("models", None, ""));
        assert!(message(none).contains("the ZIP archive holds no models"));
    }

    #[test]
    fn broken_archives_and_large_files_are_refused() {
        let archive = packed(&[("a", &[0; 1000])]);
        let small = Limits { decoded_bytes: 999, ..Limits::default() };
        let refused = message(only(archive.clone(), &small, |_| true, ("models", None, "")));
        assert!(
            refused.contains("the size of the inflated parts is 1000, above the limit of 999"),
            "{refused}"
        );
        let work = Work::with_budget(500, "max_memory");
        let poor = Limits { work, ..Limits::default() };
        let refused = message(only(archive.clone(), &poor, |_| true, ("models", None, "")));
        assert!(refused.contains("files of the archive: 1 kB of memory"), "{refused}");
        let cut = archive[..archive.len() - 9].to_vec();
        let refused = message(only(cut, &Limits::default(), |_| true, ("models", None, "")));
        assert!(refused.contains("the ZIP archive is broken"), "{refused}");
    }
}
