//! Bytes of a file: in memory, or still in the file, to be read when needed.
//!
//! From an open file, the data of vertices and indices are read in pieces that stay in the cache, so that memory is
//! needed only for the decoded values.

use crate::{Error, Result};
use std::borrow::Cow;
use std::cell::RefCell;
use std::io::{self, Read, Seek, SeekFrom};
use std::ops::Range;

/// Bytes of a file that are read at a time: few enough for the cache.
const AT_ONCE: usize = 64 << 10;

/// File that is read from any position.
pub trait ReadAt {
    /// Fills `to` from a place on.
    fn read_at(&self, place: u64, to: &mut [u8]) -> io::Result<()>;
}

impl<R: Read + Seek> ReadAt for RefCell<R> {
    fn read_at(&self, place: u64, to: &mut [u8]) -> io::Result<()> {
        let mut file = self.borrow_mut();
        file.seek(SeekFrom::Start(place))?;
        file.read_exact(to)
    }
}

/// Bytes one after another.
#[derive(Clone)]
pub enum Bytes<'a> {
    /// Bytes in memory.
    Held(&'a [u8]),
    /// Bytes in a range of an open file, within its length.
    InFile(&'a dyn ReadAt, Range<u64>),
}

impl std::fmt::Debug for Bytes<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} bytes", self.len())
    }
}

impl<'a> Bytes<'a> {
    /// Returns the number of bytes.
    pub fn len(&self) -> u64 {
        match self {
            Self::Held(bytes) => bytes.len() as u64,
            Self::InFile(_, range) => range.end - range.start,
        }
    }

    /// Returns the bytes of a range; `None` if it leads out of them.
    pub fn part(&self, range: Range<u64>) -> Option<Self> {
        match self {
            Self::Held(bytes) => {
                let [start, end] = [range.start, range.end].map(|i| usize::try_from(i).ok());
                bytes.get(start?..end?).map(Self::Held)
            }
            Self::InFile(file, whole) => {
                let inside = range.start <= range.end && range.end <= self.len();
                let part = whole.start + range.start..whole.start.saturating_add(range.end);
                inside.then_some(Self::InFile(*file, part))
            }
        }
    }

    /// Returns all bytes; at most the file's size, which is within the limits.
    ///
    /// # Errors
    /// [`Error::Io`] if the file cannot be read, or has become shorter.
    pub fn whole(&self) -> Result<Cow<'a, [u8]>> {
        match self {
            Self::Held(bytes) => Ok(Cow::Borrowed(bytes)),
            Self::InFile(file, range) => {
                let length = usize::try_from(range.end - range.start).unwrap_or(usize::MAX);
                let mut bytes = vec![0; length];
                file.read_at(range.start, &mut bytes).map_err(Error::Io)?;
                Ok(Cow::Owned(bytes))
            }
        }
    }

    /// Passes the bytes on in order, in pieces of a multiple of `unit` bytes, except for the last; `unit` is at least
    /// 1.
    ///
    /// # Errors
    /// As [`Self::whole`].
    pub fn pieces(&self, unit: usize, mut take: impl FnMut(&[u8])) -> Result<()> {
        let (file, range) = match self {
            Self::Held(bytes) => {
                take(bytes);
                return Ok(());
            }
            Self::InFile(file, range) => (file, range),
        };
        let most = unit * (AT_ONCE / unit).max(1);
        let first = usize::try_from(self.len()).map_or(most, |length| length.min(most));
        let mut buffer = vec![0; first];
        let mut place = range.start;
        while place < range.end {
            let left = usize::try_from(range.end - place).unwrap_or(usize::MAX);
            let piece = &mut buffer[..left.min(most)];
            file.read_at(place, piece).map_err(Error::Io)?;
            take(piece);
            place += piece.len() as u64;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns a file whose byte i is i modulo 251.
    fn file(length: usize) -> Vec<u8> {
        (0..length).map(|i| (i % 251) as u8).collect()
    }

    #[test]
    fn what_is_in_a_file_is_what_is_at_hand() {
        let all = file(3 * AT_ONCE + 17);
        let opened = RefCell::new(io::Cursor::new(&all));
        let length = all.len() as u64;
        let in_file = Bytes::InFile(&opened, 0..length);
        let held = Bytes::Held(&all);
        for range in [0..length, 5..9, 7..7, 3..length - 2, length - 1..length] {
            let expected = &all[range.start as usize..range.end as usize];
            for bytes in [&in_file, &held] {
                let part = bytes.part(range.clone()).unwrap();
                assert_eq!(part.len(), expected.len() as u64);
                let inner = part.part(0..part.len()).unwrap();
                assert_eq!(&*inner.whole().unwrap(), expected);
                for unit in [1, 12, 100, AT_ONCE + 1] {
                    let mut joined = Vec::new();
                    let mut sizes = Vec::new();
                    let take = |piece: &[u8]| {
                        joined.extend_from_slice(piece);
                        sizes.push(piece.len());
                    };
                    part.pieces(unit, take).unwrap();
                    assert_eq!(joined, expected);
                    let before = sizes.len().saturating_sub(1);
                    assert!(sizes[..before].iter().all(|size| size.is_multiple_of(unit)));
                }
            }
        }
        for range in [0..length + 1, length + 1..length + 1, 0..u64::MAX, u64::MAX..u64::MAX] {
            assert!(in_file.part(range.clone()).is_none() && held.part(range).is_none());
        }
    }

    #[test]
    fn a_file_that_becomes_shorter_is_an_error() {
        let all = file(10);
        let opened = RefCell::new(io::Cursor::new(&all));
        let bytes = Bytes::InFile(&opened, 0..11);
        assert!(matches!(bytes.pieces(1, |_| {}), Err(Error::Io(_))));
        assert!(matches!(bytes.whole(), Err(Error::Io(_))));
    }
}
