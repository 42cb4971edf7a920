//! The output of pictures: one file, many files, or standard output; never half a file.

use crate::beside::Beside;
use crate::failure::{Failure, in_words};
use crate::kind::{Kind, Wanted};
use crate::names;
use crate::places::{Place, is_stream};
use durer::work::{Charge, Work};
use durer_formats::wording::shown_path;
use std::collections::BTreeMap;
use std::fs::{self, OpenOptions};
use std::io::{self, BufWriter, IsTerminal, Write};
use std::path::{Path, PathBuf};

/// A place for one picture.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Target {
    /// Standard output.
    Stdout,
    /// A file that is replaced as a whole.
    File(PathBuf),
}

impl Target {
    /// Returns its name in messages.
    fn name(&self) -> String {
        match self {
            Self::Stdout => "standard output".to_owned(),
            Self::File(path) => shown_path(path),
        }
    }
}

impl std::fmt::Display for Target {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Stdout => f.write_str("-"),
            Self::File(path) => path.display().fmt(f),
        }
    }
}

/// Source of a picture's name if there are several.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Name {
    /// The model.
    pub input: PathBuf,
    /// Its number among the frames of a turntable.
    pub frame: Option<u32>,
}

/// Returns one target for each name; creates missing folders for outputs of several files.
pub fn plan(
    option: &str,
    path: &Path,
    names: &[Name],
    wanted: &Wanted,
) -> Result<Vec<Target>, Failure> {
    let many = names.len() != 1;
    if is_stream(path) {
        return if many {
            Err(usage(option, path, "standard output takes one picture; name a folder"))
        } else {
            stdout_target(option).map(|t| vec![t])
        };
    }
    if names::is_pattern(path) {
        return expanded(option, path, names, wanted);
    }
    if let Some(pattern) = Pattern::of(path).filter(|_| names.iter().any(|n| n.frame.is_some())) {
        if names.iter().any(|n| n.input != names[0].input) {
            let what = "frames of several models need a folder, or {stem} in the name";
            return Err(usage(option, path, what));
        }
        wanted.check_name(option, path)?;
        make_folder(path.parent().unwrap_or(Path::new("")))?;
        return Ok(names
            .iter()
            .map(|n| Target::File(pattern.path(n.frame.unwrap_or(0))))
            .collect());
    }
    if path.is_dir() || ends_in_separator(path) || (many && path.extension().is_none()) {
        make_folder(path)?;
        return Ok(names
            .iter()
            .map(|n| Target::File(path.join(n.file_name(wanted.kind))))
            .collect());
    }
    if many {
        let frames = names.iter().any(|n| n.frame.is_some());
        let hint = if frames { " or a name such as frame_%04d.png" } else { "" };
        return Err(usage(option, path, &format!("several pictures need a folder{hint}")));
    }
    single(option, path, wanted).map(|t| vec![t])
}

/// Returns the targets of a name with placeholders; creates their folders.
fn expanded(
    option: &str,
    path: &Path,
    names: &[Name],
    wanted: &Wanted,
) -> Result<Vec<Target>, Failure> {
    let pattern = path.to_string_lossy();
    let target = |name: &Name| {
        let path = PathBuf::from(names::expand(&pattern, &name.input));
        let path = match (name.frame, Pattern::of(&path)) {
            (None, _) => path,
            (Some(frame), Some(pattern)) => pattern.path(frame),
            (Some(_), None) => {
                let what = "frames need a place for their number, such as {stem}_%04d.png";
                return Err(usage(option, &path, what));
            }
        };
        wanted.check_name(option, &path)?;
        make_folder(path.parent().unwrap_or(Path::new("")))?;
        Ok(Target::File(path))
    };
    names.iter().map(target).collect()
}

/// Refuses two pictures in one place, however it is spelled.
pub fn check_distinct<'a>(targets: impl Iterator<Item = &'a Target>) -> Result<(), Failure> {
    let mut seen = BTreeMap::new();
    for target in targets {
        let place = match target {
            Target::Stdout => Place::of_stdout(),
            Target::File(path) => Place::of(path),
        };
        let shown = target.name();
        if let Some(first) = seen.insert(place, target) {
            let also = if first == target {
                String::new()
            } else {
                format!(" (it is {} too)", first.name())
            };
            return Err(Failure::Usage(format!("{shown}: two pictures would go there{also}")));
        }
    }
    Ok(())
}

fn usage(option: &str, path: &Path, what: &str) -> Failure {
    Failure::Usage(format!("{option} {}: {what}", path.display()))
}

fn stdout_target(option: &str) -> Result<Target, Failure> {
    if io::stdout().is_terminal() {
        let message =
            format!("{option} -: a picture is not text for a terminal; use a pipe or a file");
        return Err(Failure::Usage(message));
    }
    Ok(Target::Stdout)
}

/// Returns one file, named as its kind, in an existing folder; or a special file such as a device.
fn single(option: &str, path: &Path, wanted: &Wanted) -> Result<Target, Failure> {
    if is_special(path) {
        return Ok(Target::File(path.to_owned()));
    }
    wanted.check_name(option, path)?;
    in_its_folder(path)
}

/// Returns whether a name means one file: not a folder, not a stream, and not one file per frame.
pub fn is_one_file(path: &Path) -> bool {
    let folder = path.is_dir() || ends_in_separator(path) || path.extension().is_none();
    !is_stream(path) && !folder && Pattern::of(path).is_none()
}

/// Returns one file of any format, or `-` for standard output; nothing is read or written yet.
pub fn file_or_stream(option: &str, path: &Path) -> Result<Target, Failure> {
    if is_stream(path) {
        return stdout_target(option);
    }
    if is_special(path) {
        return Ok(Target::File(path.to_owned()));
    }
    if path.is_dir() || ends_in_separator(path) {
        return Err(usage(option, path, "it is a folder; name a file in it"));
    }
    in_its_folder(path)
}

/// Returns a file in a folder that is there.
fn in_its_folder(path: &Path) -> Result<Target, Failure> {
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    match fs::metadata(folder) {
        Ok(m) if m.is_dir() => Ok(Target::File(path.to_owned())),
        Ok(_) => Err(Failure::of_file(path, format!("{} is not a folder", folder.display()))),
        Err(e) if e.kind() == io::ErrorKind::NotFound => {
            Err(Failure::of_file(path, format!("there is no folder {}", folder.display())))
        }
        Err(e) => {
            Err(Failure::of_file(path, format!("folder {}: {}", folder.display(), in_words(&e))))
        }
    }
}

/// Returns whether the path exists and is neither a file nor a folder.
pub fn is_special(path: &Path) -> bool {
    fs::metadata(path).is_ok_and(|m| !m.is_file() && !m.is_dir())
}

pub fn ends_in_separator(path: &Path) -> bool {
    path.to_string_lossy().ends_with(std::path::is_separator)
}

pub fn make_folder(folder: &Path) -> Result<(), Failure> {
    if folder.as_os_str().is_empty() || folder.is_dir() {
        return Ok(());
    }
    if folder.exists() {
        return Err(Failure::of_file(folder, "it is a file, where a folder is needed"));
    }
    fs::create_dir_all(folder).map_err(|e| Failure::of_file(folder, in_words(&e)))
}

impl Name {
    /// Returns the file's name: `NAME.png`, or `NAME_0001.png` for a frame.
    fn file_name(&self, kind: Kind) -> String {
        let (stem, suffix) = (names::stem(&self.input), kind.suffix());
        match self.frame {
            Some(frame) => format!("{stem}_{frame:04}.{suffix}"),
            None => format!("{stem}.{suffix}"),
        }
    }
}

/// A file name with one place for a number, such as `frame_%04d.png`.
#[derive(Debug, PartialEq, Eq)]
struct Pattern {
    before: String,
    digits: usize,
    after: String,
    folder: PathBuf,
}

impl Pattern {
    fn of(path: &Path) -> Option<Self> {
        let name = path.file_name()?.to_str()?;
        let (before, rest) = name.split_once('%')?;
        let (digits, after) = rest.split_once('d')?;
        let digits =
            if digits.is_empty() { 0 } else { digits.parse().ok().filter(|&d| d <= 20)? };
        let folder = path.parent().unwrap_or(Path::new("")).to_owned();
        Some(Self { before: before.to_owned(), digits, after: after.to_owned(), folder })
    }

    fn path(&self, frame: u32) -> PathBuf {
        let Self { before, digits, after, folder } = self;
        folder.join(format!("{before}{frame:0digits$}{after}"))
    }
}

/// Destination of encoders: memory, or a new file beside the old one.
pub struct Out {
    sink: Sink,
    written: u64,
    /// Charge of the memory to the budget.
    charge: Charge,
}

enum Sink {
    Memory(Vec<u8>),
    File(BufWriter<Beside>),
}

impl Write for Out {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let count = match &mut self.sink {
            Sink::Memory(memory) => {
                let count = memory.write(bytes)?;
                self.charge.grow_to(memory.capacity() as u64).map_err(io::Error::other)?;
                count
            }
            Sink::File(file) => file.write(bytes)?,
        };
        self.written += count as u64;
        Ok(count)
    }

    fn flush(&mut self) -> io::Result<()> {
        match &mut self.sink {
            Sink::Memory(_) => Ok(()),
            Sink::File(file) => file.flush(),
        }
    }
}

/// Writes a file beside its place and renames it when it is complete; output to a stream is collected in memory first.
/// Returns the number of bytes.
pub fn deliver(
    target: &Target,
    work: &Work,
    encode: impl FnOnce(&mut Out) -> durer_formats::Result<()>,
) -> Result<u64, Failure> {
    let (name, replaced) = match target {
        Target::Stdout => (Path::new("standard output"), None),
        Target::File(path) => (path.as_path(), (!is_special(path)).then_some(path)),
    };
    let fail = |e: &io::Error| Failure::of_file(name, in_words(e));
    let sink = match replaced {
        Some(path) => Sink::File(BufWriter::new(Beside::create(path).map_err(|e| fail(&e))?)),
        None => Sink::Memory(Vec::new()),
    };
    let charge = work.charge("output to a stream", 0).map_err(|e| Failure::of_file(name, e))?;
    let mut out = Out { sink, written: 0, charge };
    encode(&mut out).map_err(|e| match &e {
        durer_formats::Error::Io(e) => fail(e),
        _ => Failure::of_file(name, e),
    })?;
    match (out.sink, target) {
        (Sink::File(file), _) => {
            let file = file.into_inner().map_err(|e| fail(e.error()))?;
            file.commit().map_err(|e| fail(&e))?;
        }
        (Sink::Memory(bytes), Target::File(path)) => write_special(path, &bytes)?,
        (Sink::Memory(bytes), Target::Stdout) => {
            let mut out = io::stdout().lock();
            out.write_all(&bytes).and_then(|()| out.flush()).map_err(|e| Failure::of_stdout(&e))?;
        }
    }
    Ok(out.written)
}

/// Writes a file of bytes as [`deliver`] does.
pub fn deliver_bytes(target: &Target, bytes: &[u8]) -> Result<u64, Failure> {
    deliver(target, &Work::default(), |out| Ok(out.write_all(bytes)?))
}

/// Writes to a pipe or device, which cannot be replaced.
fn write_special(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    let fail = |e: &io::Error| Failure::of_file(path, in_words(e));
    let mut file = OpenOptions::new().write(true).open(path).map_err(|e| fail(&e))?;
    if file.is_terminal() {
        return Err(Failure::of_file(path, "a picture is not text for a terminal"));
    }
    match file.write_all(bytes).and_then(|()| file.flush()) {
        Err(e) if e.kind() == io::ErrorKind::BrokenPipe => Err(Failure::ClosedPipe),
        other => other.map_err(|e| fail(&e)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patterns_have_one_number() {
        let pattern = Pattern::of(Path::new("out/frame_%04d.png")).unwrap();
        assert_eq!(pattern.path(7), Path::new("out/frame_0007.png"));
        assert_eq!(Pattern::of(Path::new("%d.png")).unwrap().path(12), Path::new("12.png"));
        for none in ["frame.png", "%.png", "%xd.png", "100%.png", "%99d.png", "%d/a.png"] {
            assert_eq!(Pattern::of(Path::new(none)), None, "{none}");
        }
    }

    #[test]
    fn two_pictures_cannot_share_a_place() {
        let a = Target::File("a.png".into());
        assert!(check_distinct([&a, &Target::Stdout].into_iter()).is_ok());
        assert!(check_distinct([&a, &a].into_iter()).is_err());
        assert!(check_distinct([&Target::Stdout, &Target::Stdout].into_iter()).is_err());
    }
}
