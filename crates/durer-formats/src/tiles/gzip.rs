//! Bytes compressed as gzip (RFC 1952). Not by flate2, whose bytes depend on the instructions of the machine.

/// Effort of compression, of 10: beyond, sizes hardly fall.
const LEVEL: u8 = 6;

/// Compresses bytes; the same bytes on every machine.
///
/// ```
/// let packed = durer_formats::tiles::gzip(&[7; 1000]);
/// assert_eq!((&packed[..3], packed.len() < 40), (&[0x1f, 0x8b, 8][..], true));
/// ```
pub fn gzip(bytes: &[u8]) -> Vec<u8> {
    // Deflate, no flags, no time, no hint, no system.
    let mut packed = vec![0x1f, 0x8b, 8, 0, 0, 0, 0, 0, 0, 255];
    packed.extend(miniz_oxide::deflate::compress_to_vec(bytes, LEVEL));
    packed.extend(crc32(bytes).to_le_bytes());
    packed.extend((bytes.len() as u32).to_le_bytes());
    packed
}

/// Returns the checksum of RFC 1952, 8.
fn crc32(bytes: &[u8]) -> u32 {
    let step = |crc: u32, &byte: &u8| TABLE[((crc ^ u32::from(byte)) & 255) as usize] ^ (crc >> 8);
    !bytes.iter().fold(u32::MAX, step)
}

const TABLE: [u32; 256] = {
    let mut table = [0; 256];
    let mut i = 0;
    while i < 256 {
        let (mut crc, mut bit) = (i as u32, 0);
        while bit < 8 {
            crc = if crc & 1 == 1 { 0xedb8_8320 ^ (crc >> 1) } else { crc >> 1 };
            bit += 1;
        }
        table[i] = crc;
        i += 1;
    }
    table
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn checksums_are_right() {
        assert_eq!(crc32(b"123456789"), 0xcbf4_3926);
    }
}
