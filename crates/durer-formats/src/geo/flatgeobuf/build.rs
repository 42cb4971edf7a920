//! Buffers of FlatBuffers, from front to back: a table comes before the targets of its offsets, and its list of fields
//! before it. Alignment is counted from the length in front of each buffer.

/// A field of a table.
#[derive(Debug, Clone, Copy)]
pub enum Value {
    U8(u8),
    U16(u16),
    I32(i32),
    U64(u64),
    /// An offset to data written later.
    Later,
}

impl Value {
    fn size(self) -> usize {
        match self {
            Self::U8(_) => 1,
            Self::U16(_) => 2,
            Self::I32(_) | Self::Later => 4,
            Self::U64(_) => 8,
        }
    }
}

/// A buffer with its length before it.
#[derive(Debug)]
pub struct Builder {
    out: Vec<u8>,
}

/// Position of an offset that has yet to be set.
#[derive(Debug, Clone, Copy)]
pub struct Later(usize);

impl Builder {
    /// Returns a buffer, and the offset to its root.
    pub fn new() -> (Self, Later) {
        (Self { out: vec![0; 8] }, Later(4))
    }

    /// Returns the whole buffer.
    pub fn finish(mut self) -> Vec<u8> {
        let length = u32::try_from(self.out.len() - 4).unwrap_or(u32::MAX);
        self.set(0, &length.to_le_bytes());
        self.out
    }

    fn set(&mut self, at: usize, bytes: &[u8]) {
        let place = self.out.get_mut(at..at + bytes.len());
        place.into_iter().for_each(|place| place.copy_from_slice(bytes));
    }

    /// Adds zeros until the position `before` bytes further is aligned.
    fn align(&mut self, size: usize, before: usize) {
        while !(self.out.len() + before).is_multiple_of(size) {
            self.out.push(0);
        }
    }

    /// Sets an offset to the next value written.
    fn here(&mut self, later: Later) {
        let offset = u32::try_from(self.out.len() - later.0).unwrap_or(u32::MAX);
        self.set(later.0, &offset.to_le_bytes());
    }

    /// Writes a table of fields, by their slots; returns the positions of the offsets among them, in order.
    pub fn table(&mut self, later: Later, fields: &[(usize, Value)]) -> Vec<Later> {
        let slots = fields.iter().map(|(slot, _)| slot + 1).max().unwrap_or(0);
        let mut sorted: Vec<(usize, Value)> = fields.to_vec();
        sorted.sort_by_key(|(_, value)| std::cmp::Reverse(value.size()));
        // Eight-byte fields come first, after the offset back to the list.
        let mut at = if sorted.first().is_some_and(|(_, value)| value.size() == 8) { 8 } else { 4 };
        let mut places = vec![0_u16; slots];
        for (slot, value) in &sorted {
            places[*slot] = at;
            at += value.size() as u16;
        }
        let list_size = 4 + 2 * slots;
        self.align(8, list_size);
        let list = self.out.len();
        self.out.extend((list_size as u16).to_le_bytes().iter().chain(&at.to_le_bytes()));
        places.iter().for_each(|place| self.out.extend(place.to_le_bytes()));
        self.here(later);
        let table = self.out.len();
        self.out.extend(u32::try_from(table - list).unwrap_or(0).to_le_bytes());
        self.out.resize(table + usize::from(at), 0);
        let mut open = Vec::new();
        for (slot, value) in fields {
            let place = table + usize::from(places[*slot]);
            match value {
                Value::U8(n) => self.set(place, &[*n]),
                Value::U16(n) => self.set(place, &n.to_le_bytes()),
                Value::I32(n) => self.set(place, &n.to_le_bytes()),
                Value::U64(n) => self.set(place, &n.to_le_bytes()),
                Value::Later => open.push(Later(place)),
            }
        }
        open
    }

    fn count(&mut self, later: Later, count: usize, size: usize) {
        self.align(size.max(4), 4);
        self.here(later);
        self.out.extend(u32::try_from(count).unwrap_or(u32::MAX).to_le_bytes());
    }

    pub fn bytes(&mut self, later: Later, bytes: &[u8]) {
        self.count(later, bytes.len(), 1);
        self.out.extend(bytes);
    }

    pub fn text(&mut self, later: Later, text: &str) {
        self.bytes(later, text.as_bytes());
        self.out.push(0);
    }

    pub fn words(&mut self, later: Later, words: &[u32]) {
        self.count(later, words.len(), 4);
        words.iter().for_each(|word| self.out.extend(word.to_le_bytes()));
    }

    pub fn doubles(&mut self, later: Later, numbers: impl ExactSizeIterator<Item = f64>) {
        self.count(later, numbers.len(), 8);
        numbers.for_each(|n| self.out.extend(n.to_le_bytes()));
    }

    /// Writes a vector of offsets to tables that are written next, and returns those offsets.
    pub fn tables(&mut self, later: Later, count: usize) -> Vec<Later> {
        self.count(later, count, 4);
        let start = self.out.len();
        self.out.resize(start + 4 * count, 0);
        (0..count).map(|i| Later(start + 4 * i)).collect()
    }
}
