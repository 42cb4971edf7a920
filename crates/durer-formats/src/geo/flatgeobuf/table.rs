//! Tables of FlatBuffers in untrusted bytes.
//!
//! <https://flatbuffers.dev/internals>: an offset leads from its own place to its target; a table begins with the
//! offset back to the list of its fields' positions.

/// A table in a buffer.
#[derive(Debug, Clone, Copy)]
pub struct Table<'a> {
    bytes: &'a [u8],
    at: usize,
    /// Position of the list of its fields.
    list: usize,
}

/// Elements of one size, side by side.
#[derive(Debug, Clone, Copy)]
pub struct Vector<'a> {
    bytes: &'a [u8],
    at: usize,
    pub len: usize,
}

fn take<const N: usize>(bytes: &[u8], at: usize) -> Option<[u8; N]> {
    bytes.get(at..)?.first_chunk().copied()
}

/// Returns the position that the offset at a place points to.
fn follow(bytes: &[u8], at: usize) -> Option<usize> {
    at.checked_add(u32::from_le_bytes(take(bytes, at)?) as usize)
}

impl<'a> Table<'a> {
    /// Returns the table that a buffer begins with.
    pub fn root(bytes: &'a [u8]) -> Option<Self> {
        Self::at(bytes, follow(bytes, 0)?)
    }

    fn at(bytes: &'a [u8], at: usize) -> Option<Self> {
        let back = i64::from(i32::from_le_bytes(take(bytes, at)?));
        let list = usize::try_from(i64::try_from(at).ok()?.checked_sub(back)?).ok()?;
        take::<4>(bytes, list)?;
        Some(Self { bytes, at, list })
    }

    /// Returns the position of a field; `None` if the field is missing.
    fn field(&self, slot: usize) -> Option<usize> {
        let length = usize::from(u16::from_le_bytes(take(self.bytes, self.list)?));
        let entry = 4 + 2 * slot;
        if entry + 2 > length {
            return None;
        }
        let offset = u16::from_le_bytes(take(self.bytes, self.list.checked_add(entry)?)?);
        (offset != 0).then(|| self.at + usize::from(offset))
    }

    pub fn u8(&self, slot: usize) -> Option<u8> {
        self.bytes.get(self.field(slot)?).copied()
    }

    pub fn u16(&self, slot: usize) -> Option<u16> {
        take(self.bytes, self.field(slot)?).map(u16::from_le_bytes)
    }

    pub fn i32(&self, slot: usize) -> Option<i32> {
        take(self.bytes, self.field(slot)?).map(i32::from_le_bytes)
    }

    pub fn u64(&self, slot: usize) -> Option<u64> {
        take(self.bytes, self.field(slot)?).map(u64::from_le_bytes)
    }

    pub fn table(&self, slot: usize) -> Option<Self> {
        Self::at(self.bytes, follow(self.bytes, self.field(slot)?)?)
    }

    /// Returns a vector of elements of this many bytes; `None` also if there is no room for them.
    pub fn vector(&self, slot: usize, size: usize) -> Option<Vector<'a>> {
        let start = follow(self.bytes, self.field(slot)?)?;
        let len = u32::from_le_bytes(take(self.bytes, start)?) as usize;
        let at = start + 4;
        (len <= self.bytes.len().checked_sub(at)? / size).then_some(Vector {
            bytes: self.bytes,
            at,
            len,
        })
    }

    pub fn bytes(&self, slot: usize) -> Option<&'a [u8]> {
        let vector = self.vector(slot, 1)?;
        self.bytes.get(vector.at..vector.at + vector.len)
    }

    pub fn text(&self, slot: usize) -> Option<String> {
        self.bytes(slot).map(|bytes| String::from_utf8_lossy(bytes).into_owned())
    }

    pub fn tables(&self, slot: usize) -> impl Iterator<Item = Option<Table<'a>>> + use<'a> {
        let vector = self.vector(slot, 4);
        vector.into_iter().flat_map(|v| {
            (0..v.len).map(move |i| Self::at(v.bytes, follow(v.bytes, v.at + 4 * i)?))
        })
    }
}

impl Vector<'_> {
    pub fn u32(&self, index: usize) -> Option<u32> {
        take(self.bytes, self.at + 4 * index).filter(|_| index < self.len).map(u32::from_le_bytes)
    }

    pub fn f64(&self, index: usize) -> Option<f64> {
        take(self.bytes, self.at + 8 * index).filter(|_| index < self.len).map(f64::from_le_bytes)
    }
}
