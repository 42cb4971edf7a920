//! Protocol buffers, as far as vector tiles need them: <https://protobuf.dev/programming-guides/encoding/>.

/// A message that is being written.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Message(pub Vec<u8>);

const VARINT: u64 = 0;
const FIXED_64: u64 = 1;
const BYTES: u64 = 2;

impl Message {
    /// Adds a whole number.
    pub fn unsigned(&mut self, field: u64, value: u64) {
        varint(&mut self.0, field << 3 | VARINT);
        varint(&mut self.0, value);
    }

    /// Adds a whole number of either sign, small where its size is.
    pub fn signed(&mut self, field: u64, value: i64) {
        self.unsigned(field, zigzag(value));
    }

    /// Adds a number.
    pub fn double(&mut self, field: u64, value: f64) {
        varint(&mut self.0, field << 3 | FIXED_64);
        self.0.extend(value.to_le_bytes());
    }

    /// Adds bytes: text, or another message.
    pub fn bytes(&mut self, field: u64, bytes: &[u8]) {
        varint(&mut self.0, field << 3 | BYTES);
        varint(&mut self.0, bytes.len() as u64);
        self.0.extend_from_slice(bytes);
    }

    /// Adds whole numbers, one after the other.
    pub fn packed(&mut self, field: u64, values: &[u32]) {
        let mut bytes = Vec::with_capacity(values.len());
        values.iter().for_each(|&value| varint(&mut bytes, value.into()));
        self.bytes(field, &bytes);
    }
}

/// Writes seven bits at a time, the lowest first.
pub fn varint(out: &mut Vec<u8>, mut value: u64) {
    while value > 0x7f {
        out.push(value as u8 | 0x80);
        value >>= 7;
    }
    out.push(value as u8);
}

/// Encodes 0, −1, 1, −2, … as 0, 1, 2, 3, …
pub fn zigzag(value: i64) -> u64 {
    (value << 1 ^ value >> 63) as u64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_those_of_the_documentation() {
        let mut message = Message::default();
        message.unsigned(1, 150);
        message.signed(2, -2);
        message.packed(6, &[3, 270, 86942]);
        assert_eq!(message.0, b"\x08\x96\x01\x10\x03\x32\x06\x03\x8e\x02\x9e\xa7\x05");
        assert_eq!([0, -1, 1, i64::MAX, i64::MIN].map(zigzag), [0, 1, 2, u64::MAX - 1, u64::MAX]);
    }
}
