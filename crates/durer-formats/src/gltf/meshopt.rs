//! Decompression of buffer views: `EXT_meshopt_compression` and `KHR_meshopt_compression`.
//!
//! Source: the bitstream and filters as the two extensions' specifications publish them (Arseny
//! Kapoulkine and others, 2020 and 2025): attributes of version 0 and 1, triangles, indices. Linear
//! in the output, which the caller bounds: `count · stride` bytes.

mod attributes;
mod filter;
mod indices;

/// Packing of one view.
#[derive(Debug, Clone, Copy)]
pub struct Packing<'a> {
    /// The number of elements.
    pub count: usize,
    /// Bytes per element.
    pub stride: usize,
    /// `ATTRIBUTES`, `TRIANGLES` or `INDICES`.
    pub mode: &'a str,
    /// `NONE`, `OCTAHEDRAL`, `QUATERNION`, `EXPONENTIAL` or `COLOR`.
    pub filter: &'a str,
}

/// Reason why a view cannot be unpacked.
pub type Refusal = &'static str;

/// Said wherever the packed bytes end too early.
const TOO_SHORT: Refusal = "the compressed data end too early";
/// Said where bytes are left over.
const TOO_LONG: Refusal = "there are compressed data left over";

/// Unpacks bytes to `count · stride` plain ones.
pub fn decode(data: &[u8], packing: Packing<'_>) -> Result<Vec<u8>, Refusal> {
    let Packing { count, stride, mode, filter } = packing;
    if mode != "ATTRIBUTES" && filter != "NONE" {
        return Err("only attributes may have a filter");
    }
    match mode {
        "ATTRIBUTES" => {
            let mut bytes = attributes::decode(data, count, stride)?;
            filter::apply(&mut bytes, stride, filter)?;
            Ok(bytes)
        }
        "TRIANGLES" if count % 3 != 0 => {
            Err("the count of triangles' indices is not a multiple of 3")
        }
        "TRIANGLES" => narrow(indices::decode_triangles(data, count)?, stride),
        "INDICES" => narrow(indices::decode_sequence(data, count)?, stride),
        _ => Err("the mode is not one of ATTRIBUTES, TRIANGLES, INDICES"),
    }
}

/// Returns indices as little-endian bytes of 2 or 4 each; 16 bits wrap, as the specification says.
fn narrow(indices: Vec<u32>, stride: usize) -> Result<Vec<u8>, Refusal> {
    match stride {
        2 => Ok(indices.iter().flat_map(|&i| (i as u16).to_le_bytes()).collect()),
        4 => Ok(indices.iter().flat_map(|&i| i.to_le_bytes()).collect()),
        _ => Err("indices must have a stride of 2 or 4"),
    }
}

/// A place in packed bytes.
struct Bytes<'a>(&'a [u8]);

impl<'a> Bytes<'a> {
    fn take(&mut self, count: usize) -> Result<&'a [u8], Refusal> {
        let (head, rest) = self.0.split_at_checked(count).ok_or(TOO_SHORT)?;
        self.0 = rest;
        Ok(head)
    }

    fn byte(&mut self) -> Result<u8, Refusal> {
        let (&byte, rest) = self.0.split_first().ok_or(TOO_SHORT)?;
        self.0 = rest;
        Ok(byte)
    }

    /// Returns an unsigned number of 7 bits a byte, low ones first, in at most five bytes.
    fn varint(&mut self) -> Result<u32, Refusal> {
        let mut value = 0u32;
        for shift in (0..35).step_by(7) {
            let byte = self.byte()?;
            value |= u32::from(byte & 0x7f) << shift;
            if byte < 0x80 {
                return Ok(value);
            }
        }
        Err("a number of more than five bytes")
    }
}

/// Reverses the zigzag code that puts the sign of a difference into its lowest bit.
fn unzigzag(v: u32) -> u32 {
    (v >> 1) ^ (v & 1).wrapping_neg()
}
