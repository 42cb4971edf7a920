//! The orientation of pictures that cameras write into their files (CIPA DC-008, *Exif*, tag 0x0112), in an APP1
//! segment of a JPEG or an eXIf chunk of a PNG.

use super::{jpeg, png};
use durer::target::Pixels;

/// The tag of the orientation in the first directory, and the type of its value: 16 bits.
const TAG: u16 = 0x0112;
const SHORT: u16 = 3;

/// Turn of the stored pixels that makes the picture upright.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Orientation {
    /// No turn.
    #[default]
    Upright = 1,
    /// Left and right are exchanged.
    Mirrored = 2,
    /// Turned by half a circle.
    UpsideDown = 3,
    /// Top and bottom are exchanged.
    Flipped = 4,
    /// Rows are to be columns.
    Transposed = 5,
    /// To be turned by a quarter to the right.
    Right = 6,
    /// Rows are to be columns, each from its end.
    Transversed = 7,
    /// To be turned by a quarter to the left.
    Left = 8,
}

impl Orientation {
    const ALL: [Self; 8] = [
        Self::Upright,
        Self::Mirrored,
        Self::UpsideDown,
        Self::Flipped,
        Self::Transposed,
        Self::Right,
        Self::Transversed,
        Self::Left,
    ];

    /// Returns the orientation that a picture's file states; upright if it states none, or an
    /// invalid one.
    pub fn of(bytes: &[u8]) -> Self {
        let exif = if bytes.starts_with(png::MAGIC) { of_png(bytes) } else { of_jpeg(bytes) };
        let number = exif.and_then(value).unwrap_or(1);
        Self::ALL.get(usize::from(number).wrapping_sub(1)).copied().unwrap_or_default()
    }

    /// Returns the pixels in the orientation of display.
    pub fn turned<P: Copy>(self, pixels: Pixels<P>) -> Pixels<P> {
        let (w, h) = (pixels.width(), pixels.height());
        let (width, height) = if self as u8 >= Self::Transposed as u8 { (h, w) } else { (w, h) };
        if self == Self::Upright || w == 0 || h == 0 {
            return pixels;
        }
        let source = |x: u32, y: u32| match self {
            Self::Upright => (x, y),
            Self::Mirrored => (w - 1 - x, y),
            Self::UpsideDown => (w - 1 - x, h - 1 - y),
            Self::Flipped => (x, h - 1 - y),
            Self::Transposed => (y, x),
            Self::Right => (y, h - 1 - x),
            Self::Transversed => (w - 1 - y, h - 1 - x),
            Self::Left => (w - 1 - y, x),
        };
        let mut turned = Pixels::new(width, height, pixels.row(0)[0]);
        for y in 0..height {
            for (x, pixel) in (0..width).zip(turned.row_mut(y)) {
                let (x, y) = source(x, y);
                *pixel = pixels.row(y)[x as usize];
            }
        }
        turned
    }
}

/// Returns the Exif data of a JPEG: its segments are walked through to the first scan.
fn of_jpeg(bytes: &[u8]) -> Option<&[u8]> {
    const APP1: u8 = 0xe1;
    const START_OF_SCAN: u8 = 0xda;
    bytes.starts_with(jpeg::MAGIC).then_some(())?;
    let mut rest = bytes.get(2..)?;
    loop {
        let &[0xff, marker, high, low, ..] = rest else { return None };
        if marker == 0xff {
            rest = &rest[1..];
            continue;
        }
        let length = usize::from(u16::from_be_bytes([high, low]));
        let segment = rest.get(4..2 + length)?;
        match (marker, segment.strip_prefix(b"Exif\0\0")) {
            (APP1, Some(exif)) => return Some(exif),
            (START_OF_SCAN, _) => return None,
            _ => rest = rest.get(2 + length..)?,
        }
    }
}

/// Returns the metadata of a PNG.
fn of_png(bytes: &[u8]) -> Option<&[u8]> {
    let mut rest = bytes.get(png::MAGIC.len()..)?;
    loop {
        let (length, after) = rest.split_first_chunk()?;
        let length = u32::from_be_bytes(*length) as usize;
        let (kind, after) = after.split_first_chunk::<4>()?;
        if kind == b"eXIf" {
            return after.get(..length);
        }
        // The chunk's bytes and its checksum.
        rest = after.get(length.checked_add(4)?..)?;
    }
}

/// Returns the orientation in Exif data, which are laid out as in a TIFF file.
fn value(exif: &[u8]) -> Option<u16> {
    let big = match exif.get(..4)? {
        b"MM\0*" => true,
        b"II*\0" => false,
        _ => return None,
    };
    let short = |at: usize| {
        let two = exif.get(at..)?.first_chunk::<2>()?;
        Some(if big { u16::from_be_bytes(*two) } else { u16::from_le_bytes(*two) })
    };
    let four = exif.get(4..)?.first_chunk::<4>()?;
    let start = if big { u32::from_be_bytes(*four) } else { u32::from_le_bytes(*four) } as usize;
    let count = usize::from(short(start)?);
    let entries = (0..count).map(|i| start.saturating_add(2 + 12 * i));
    let mut found = entries.filter(|at| short(*at) == Some(TAG));
    let at = found.next()?;
    (short(at + 2)? == SHORT).then(|| short(at + 8)).flatten()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Creates Exif data with a tag before the orientation.
    fn exif(big: bool, orientation: u16) -> Vec<u8> {
        let short = |v: u16| if big { v.to_be_bytes() } else { v.to_le_bytes() };
        let long = |v: u32| if big { v.to_be_bytes() } else { v.to_le_bytes() };
        let mut bytes = if big { b"MM\0*".to_vec() } else { b"II*\0".to_vec() };
        bytes.extend(long(8));
        bytes.extend(short(2));
        for (tag, value) in [(0x0100, 640), (TAG, orientation)] {
            bytes.extend(short(tag));
            bytes.extend(short(SHORT));
            bytes.extend(long(1));
            bytes.extend(short(value));
            bytes.extend([0; 2]);
        }
        bytes.extend(long(0));
        bytes
    }

    fn jpeg(exif: &[u8]) -> Vec<u8> {
        let segment = |marker: u8, data: &[u8]| {
            let length = (data.len() as u16 + 2).to_be_bytes();
            [&[0xff, marker], &length[..], data].concat()
        };
        let app0 = segment(0xe0, b"JFIF\0");
        let app1 = segment(0xe1, &[b"Exif\0\0", exif].concat());
        [&[0xff, 0xd8][..], &app0, &app1, &[0xff, 0xda, 0, 2]].concat()
    }

    fn png(exif: &[u8]) -> Vec<u8> {
        let chunk = |kind: &[u8; 4], data: &[u8]| {
            [&(data.len() as u32).to_be_bytes()[..], kind, data, &[0; 4]].concat()
        };
        [png::MAGIC, &chunk(b"IHDR", &[0; 13]), &chunk(b"eXIf", exif)].concat()
    }

    #[test]
    fn the_orientation_is_found_in_both_formats_and_both_orders_of_bytes() {
        for orientation in Orientation::ALL {
            for big in [false, true] {
                let exif = exif(big, orientation as u16);
                assert_eq!(Orientation::of(&jpeg(&exif)), orientation);
                assert_eq!(Orientation::of(&png(&exif)), orientation);
            }
        }
        for wrong in [0, 9, u16::MAX] {
            assert_eq!(Orientation::of(&jpeg(&exif(true, wrong))), Orientation::Upright);
        }
    }

    #[test]
    fn what_is_cut_off_or_broken_is_upright() {
        for whole in [jpeg(&exif(true, 6)), png(&exif(false, 6))] {
            for end in 0..whole.len() - 12 {
                let _ = Orientation::of(&whole[..end]);
            }
        }
        let mut far = exif(true, 6);
        far[4..8].copy_from_slice(&[0xff; 4]);
        assert_eq!(Orientation::of(&jpeg(&far)), Orientation::Upright);
        assert_eq!(Orientation::of(b""), Orientation::Upright);
    }

    #[test]
    fn pixels_go_where_viewers_show_them() {
        // a b c
        // d e f
        let image = |rows: &[&str]| {
            let data = rows.concat().into_bytes();
            Pixels::from_data(rows[0].len() as u32, rows.len() as u32, data).unwrap()
        };
        let cases: [(Orientation, &[&str]); 8] = [
            (Orientation::Upright, &["abc", "def"]),
            (Orientation::Mirrored, &["cba", "fed"]),
            (Orientation::UpsideDown, &["fed", "cba"]),
            (Orientation::Flipped, &["def", "abc"]),
            (Orientation::Transposed, &["ad", "be", "cf"]),
            (Orientation::Right, &["da", "eb", "fc"]),
            (Orientation::Transversed, &["fc", "eb", "da"]),
            (Orientation::Left, &["cf", "be", "ad"]),
        ];
        for (orientation, rows) in cases {
            assert_eq!(orientation.turned(image(&["abc", "def"])), image(rows), "{orientation:?}");
        }
    }
}
