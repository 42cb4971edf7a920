//! The laws that hold for any bytes, read as a picture with a wide range of brightness: the body of the
//! fuzz target `hdr`, which the tests call as well.

use durer_formats::Limits;
use durer_formats::hdr::read;

/// Whatever is read has as many colours as its size says, none of them below 0.
pub fn hdr(bytes: &[u8]) {
    let limits = Limits { decoded_bytes: 1 << 20, ..Limits::default() };
    let Ok(picture) = read(bytes, &limits) else { return };
    let pixels = u64::from(picture.width) * u64::from(picture.height);
    assert!(pixels > 0 && pixels == picture.pixels.len() as u64);
    assert!(picture.pixels.as_flattened().iter().all(|channel| *channel >= 0.0));
}
