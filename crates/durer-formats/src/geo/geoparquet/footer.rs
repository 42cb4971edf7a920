//! A check of a file's end before the crate reads it, because the crate recurses into nested groups without a limit.

use crate::{Error, Result};

/// Groups may be nested so deep.
const MAX_DEPTH: usize = 64;

/// Largest footer in bytes: its decoded form is about ten times as large.
const MAX_FOOTER: usize = 256 << 20;

/// Refuses files whose columns are nested too deeply, or that do not end like a Parquet file.
///
/// # Errors
/// [`Error::Decode`] with the fault.
pub fn check(bytes: &[u8]) -> Result<()> {
    let wrong = |message: &str| Error::byte(bytes.len() as u64, message);
    let (rest, _) =
        bytes.split_last_chunk::<4>().filter(|(_, end)| *end == b"PAR1").ok_or_else(|| {
            wrong("the file does not end as Parquet does, with PAR1; it is cut short")
        })?;
    let (rest, length) = rest.split_last_chunk::<4>().ok_or_else(|| wrong("it has no footer"))?;
    let length = u32::from_le_bytes(*length) as usize;
    let start = rest.len().checked_sub(length).filter(|_| length <= MAX_FOOTER);
    let start = start.ok_or_else(|| wrong("its footer is longer than it can be"))?;
    let mut walk = Walk { bytes: rest.get(start..).unwrap_or_default() };
    walk.file().ok_or_else(|| {
        Error::byte(start as u64, "the footer of Parquet cannot be read, or nests columns too deep")
    })
}

/// Walk through structures of Thrift's compact protocol.
struct Walk<'a> {
    bytes: &'a [u8],
}

impl Walk<'_> {
    fn byte(&mut self) -> Option<u8> {
        let (first, rest) = self.bytes.split_first()?;
        self.bytes = rest;
        Some(*first)
    }

    fn skip(&mut self, count: u64) -> Option<()> {
        self.bytes = self.bytes.get(usize::try_from(count).ok()?..)?;
        Some(())
    }

    fn number(&mut self) -> Option<u64> {
        let mut value = 0;
        for shift in (0..64).step_by(7) {
            let byte = self.byte()?;
            value |= u64::from(byte & 0x7f) << shift;
            if byte < 0x80 {
                return Some(value);
            }
        }
        None
    }

    /// Returns the next field of a structure: its number and type; type 0 at the end.
    fn field(&mut self, number: &mut i64) -> Option<u8> {
        let head = self.byte()?;
        let (step, kind) = (head >> 4, head & 15);
        if kind == 0 {
            return Some(0);
        }
        *number = if step > 0 {
            number.checked_add(step.into())?
        } else {
            let value = self.number()?;
            (value >> 1) as i64 ^ -((value & 1) as i64)
        };
        Some(kind)
    }

    fn value(&mut self, kind: u8, depth: usize) -> Option<()> {
        if depth > MAX_DEPTH {
            return None;
        }
        match kind {
            1 | 2 => Some(()),
            3 => self.skip(1),
            4..=6 => self.number().map(drop),
            7 => self.skip(8),
            8 => {
                let length = self.number()?;
                self.skip(length)
            }
            9 | 10 => {
                let (count, kind) = self.list()?;
                (0..count).try_for_each(|_| self.item(kind, depth + 1))
            }
            12 => {
                let mut number = 0;
                loop {
                    match self.field(&mut number)? {
                        0 => return Some(()),
                        kind => self.value(kind, depth + 1)?,
                    }
                }
            }
            _ => None,
        }
    }

    /// Returns the length of a list and the type of its items, each of at least a byte.
    fn list(&mut self) -> Option<(u64, u8)> {
        let head = self.byte()?;
        let count = if head >> 4 == 15 { self.number()? } else { u64::from(head >> 4) };
        (count <= self.bytes.len() as u64).then_some((count, head & 15))
    }

    fn item(&mut self, kind: u8, depth: usize) -> Option<()> {
        if matches!(kind, 1 | 2) { self.skip(1) } else { self.value(kind, depth) }
    }

    /// Walks through the description of the file, with its columns as field 2.
    fn file(&mut self) -> Option<()> {
        let mut number = 0;
        loop {
            match self.field(&mut number)? {
                0 => return Some(()),
                9 if number == 2 => self.columns()?,
                kind => self.value(kind, 0)?,
            }
        }
    }

    /// Walks through the columns; groups state how many of the next are in them.
    fn columns(&mut self) -> Option<()> {
        let (count, kind) = self.list()?;
        let mut open: Vec<u64> = Vec::new();
        for _ in 0..count {
            let children = if kind == 12 { self.column()? } else { return None };
            while open.last() == Some(&0) {
                open.pop();
            }
            if let Some(left) = open.last_mut() {
                *left -= 1;
            }
            if children > 0 {
                open.push(children);
            }
            if open.len() > MAX_DEPTH {
                return None;
            }
        }
        Some(())
    }

    /// Walks through a column; returns the number of its children.
    fn column(&mut self) -> Option<u64> {
        let (mut number, mut children) = (0, 0);
        loop {
            match self.field(&mut number)? {
                0 => return Some(children),
                4..=6 if number == 5 => children = self.number()? >> 1,
                kind => self.value(kind, 0)?,
            }
        }
    }
}
