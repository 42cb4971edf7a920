//! Mode 0: elements of any size, stored as differences, byte position by byte position.

use super::{Bytes, Refusal, TOO_LONG, TOO_SHORT};

/// Elements of a group, which share the width of their differences.
const GROUP: usize = 16;
/// A block is at most this many bytes, and at most this many elements.
const BLOCK_BYTES: usize = 8192;
const BLOCK_ELEMENTS: usize = 256;

/// Coding of a channel's four bytes relative to those of the element before.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Channel {
    /// Four single bytes, each by its zigzag difference.
    Bytes,
    /// Two 16-bit numbers, each by its zigzag difference.
    Words,
    /// One 32-bit number by exclusive or, rotated left by this many bits.
    Xor(u32),
}

/// Widths in bits of a group's differences, by control mode and header bits.
const WIDTHS_0: [u32; 4] = [0, 2, 4, 8];
const WIDTHS_1: [[u32; 4]; 2] = [[0, 1, 2, 4], [1, 2, 4, 8]];

pub fn decode(data: &[u8], count: usize, stride: usize) -> Result<Vec<u8>, Refusal> {
    if !stride.is_multiple_of(4) || !(4..=256).contains(&stride) {
        return Err("the stride of attributes must be a multiple of 4 from 4 to 256");
    }
    let mut input = Bytes(data);
    let version = match input.byte()? {
        0xa0 => 0,
        0xa1 => 1,
        _ => return Err("the data do not begin with the mark of attributes"),
    };
    let modes = if version == 0 { 0 } else { stride / 4 };
    let tail = (stride + modes).max(if version == 0 { 32 } else { 24 });
    let body = input.0.len().checked_sub(tail).ok_or(TOO_SHORT)?;
    let (body, tail) = input.0.split_at(body);
    let (first, modes) = tail[tail.len() - stride - modes..].split_at(stride);
    let channels = channels(modes, stride)?;
    let mut body = Bytes(body);
    let mut last = first.to_vec();
    let block = ((BLOCK_BYTES / stride) & !(GROUP - 1)).min(BLOCK_ELEMENTS);
    // A quarter of a byte per byte position is the least that a block can take.
    if count.div_ceil(block) > body.0.len() / (stride / 4) {
        return Err(TOO_SHORT);
    }
    let mut out = vec![0; count.checked_mul(stride).ok_or("the size overflows")?];
    for elements in out.chunks_mut(block * stride) {
        decode_block(&mut body, elements, &mut last, &channels, version)?;
    }
    if body.0.is_empty() { Ok(out) } else { Err(TOO_LONG) }
}

fn channels(modes: &[u8], stride: usize) -> Result<Vec<Channel>, Refusal> {
    if modes.is_empty() {
        return Ok(vec![Channel::Bytes; stride / 4]);
    }
    let channel = |mode: &u8| match (mode & 15, mode >> 4) {
        (0, 0) => Ok(Channel::Bytes),
        (1, 0) => Ok(Channel::Words),
        (2, turn) => Ok(Channel::Xor(u32::from(turn))),
        _ => Err("an unknown channel mode"),
    };
    modes.iter().map(channel).collect()
}

fn decode_block(
    body: &mut Bytes<'_>,
    out: &mut [u8],
    last: &mut [u8],
    channels: &[Channel],
    version: u32,
) -> Result<(), Refusal> {
    let stride = last.len();
    let count = out.len() / stride;
    let controls = body.take(if version == 0 { 0 } else { stride / 4 })?;
    let mut deltas = [const { [0u8; BLOCK_ELEMENTS] }; 4];
    for (k, &channel) in channels.iter().enumerate() {
        for (j, lane) in deltas.iter_mut().enumerate() {
            let control = controls.get(k).map(|c| c >> (2 * j) & 3);
            decode_lane(body, &mut lane[..count.next_multiple_of(GROUP)], count, control)?;
        }
        let mut value = [0; 4];
        value.copy_from_slice(&last[4 * k..4 * k + 4]);
        for (i, element) in out.chunks_exact_mut(stride).enumerate() {
            value = step(channel, value, deltas.each_ref().map(|lane| lane[i]));
            element[4 * k..4 * k + 4].copy_from_slice(&value);
        }
        last[4 * k..4 * k + 4].copy_from_slice(&value);
    }
    Ok(())
}

/// Decodes the differences at one byte position of a block's elements; `lane` is rounded up to groups.
fn decode_lane(
    body: &mut Bytes<'_>,
    lane: &mut [u8],
    count: usize,
    control: Option<u8>,
) -> Result<(), Refusal> {
    let widths = match control {
        None => &WIDTHS_0,
        Some(2) => {
            lane.fill(0);
            return Ok(());
        }
        Some(3) => {
            lane[..count].copy_from_slice(body.take(count)?);
            return Ok(());
        }
        Some(mode) => &WIDTHS_1[usize::from(mode & 1)],
    };
    let headers = body.take((lane.len() / GROUP).div_ceil(4))?;
    for (g, group) in lane.as_chunks_mut::<GROUP>().0.iter_mut().enumerate() {
        let bits = headers[g / 4] >> (2 * (g % 4)) & 3;
        decode_group(body, group, widths[usize::from(bits)])?;
    }
    Ok(())
}

/// Decodes sixteen differences of `width` bits; a difference with all bits set is replaced by a following byte.
fn decode_group(body: &mut Bytes<'_>, group: &mut [u8; GROUP], width: u32) -> Result<(), Refusal> {
    if width == 0 {
        group.fill(0);
        return Ok(());
    }
    let packed = body.take(width as usize * 2)?;
    let per_byte = 8 / width as usize;
    let sentinel = (0xff >> (8 - width)) as u8;
    for (i, value) in group.iter_mut().enumerate() {
        // Single bits are stored lowest first, wider groups highest first.
        let place = i % per_byte;
        let shift = if width == 1 { place } else { (per_byte - 1 - place) * width as usize };
        *value = packed[i / per_byte] >> shift & sentinel;
    }
    if width < 8 {
        for value in group.iter_mut().filter(|v| **v == sentinel) {
            *value = body.byte()?;
        }
    }
    Ok(())
}

/// Returns the channel's next four bytes.
fn step(channel: Channel, last: [u8; 4], delta: [u8; 4]) -> [u8; 4] {
    match channel {
        Channel::Bytes => {
            std::array::from_fn(|j| last[j].wrapping_add(super::unzigzag(delta[j].into()) as u8))
        }
        Channel::Words => {
            let word = |v: [u8; 4], j: usize| u16::from_le_bytes([v[2 * j], v[2 * j + 1]]);
            let next =
                |j| word(last, j).wrapping_add(super::unzigzag(word(delta, j).into()) as u16);
            let [[a, b], [c, d]] = [next(0).to_le_bytes(), next(1).to_le_bytes()];
            [a, b, c, d]
        }
        Channel::Xor(turn) => {
            let difference = u32::from_le_bytes(delta).rotate_left(turn);
            (u32::from_le_bytes(last) ^ difference).to_le_bytes()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_specifications_example_group() {
        let data = [0x17, 0x5f, 0xf0, 0xbc, 0x77, 0xa9, 0x21, 0x00, 0x34, 0xb5];
        let mut group = [0; GROUP];
        decode_group(&mut Bytes(&data), &mut group, 4).unwrap();
        let deltas = group.map(|v| crate::gltf::meshopt::unzigzag(v.into()) as u8 as i8);
        assert_eq!(deltas, [-1, -4, -3, 26, -91, 0, -6, 6, -4, -4, 5, -5, 1, -1, 0, 0]);
    }

    #[test]
    fn version_1_channels_and_controls() {
        // Two elements of 4 bytes. Control bytes: lane 0 literal, lanes 1…3 all zero.
        let stream = |mode: u8, literal: [u8; 2]| {
            let mut data = vec![0xa1, 0b10_10_10_11];
            data.extend(literal);
            data.extend([0; 24 - 5]);
            data.extend([10, 0, 0, 0x80, mode]);
            decode(&data, 2, 4).unwrap()
        };
        assert_eq!(stream(0, [2, 1]), [11, 0, 0, 0x80, 10, 0, 0, 0x80]);
        // −11 borrows from the high byte of the word.
        assert_eq!(stream(1, [21, 0]), [0xff, 0xff, 0, 0x80, 0xff, 0xff, 0, 0x80]);
        assert_eq!(stream(0x82, [1, 3]), [10, 1, 0, 0x80, 10, 2, 0, 0x80]);
        let mut one_bit = vec![0xa1, 0b10_10_10_00, 0b01, 0b10, 0, 7];
        one_bit.extend([0; 24 - 5 + 5]);
        let out = decode(&one_bit, 2, 4).unwrap();
        assert_eq!(out, [0, 0, 0, 0, 0xfc, 0, 0, 0]);
    }

    #[test]
    fn every_cut_is_noticed() {
        let mut data = vec![0xa0];
        for _ in 0..4 {
            data.extend([0b10, 0x12, 0x34, 0x56, 0x78, 0x9a, 0xbc, 0xde, 0x01]);
        }
        data.extend([0; 32]);
        assert!(decode(&data, 16, 4).is_ok());
        for cut in 0..data.len() {
            assert!(decode(&data[..cut], 16, 4).is_err(), "{cut}");
        }
        assert_eq!(decode(&data, 1_000_000_000, 4), Err(TOO_SHORT));
        data.push(0);
        assert_eq!(decode(&data, 16, 4), Err(TOO_LONG));
    }
}
