//! The filters applied to attributes before packing, reversed in place.

use super::Refusal;
use std::f32::consts::FRAC_1_SQRT_2;

/// The largest normalized 16-bit value.
const MAX_16: f32 = 32767.0;

/// Reverses a filter by name, element by element.
pub fn apply(bytes: &mut [u8], stride: usize, filter: &str) -> Result<(), Refusal> {
    let each_16 = |bytes: &mut [u8], undo: fn([i16; 4]) -> [i16; 4]| {
        for element in bytes.as_chunks_mut::<8>().0 {
            let word = |j: usize| i16::from_le_bytes([element[2 * j], element[2 * j + 1]]);
            let out = undo(std::array::from_fn(word)).map(i16::to_le_bytes);
            element.copy_from_slice(out.as_flattened());
        }
    };
    let each_8 = |bytes: &mut [u8], undo: fn([i8; 4]) -> [i8; 4]| {
        for element in bytes.as_chunks_mut::<4>().0 {
            *element = undo(element.map(|b| b as i8)).map(|b| b as u8);
        }
    };
    match (filter, stride) {
        ("NONE", _) => {}
        ("OCTAHEDRAL", 4) => {
            each_8(bytes, |v| octahedral(v.map(f32::from), 127.0, v[3], |x| x as i8))
        }
        ("OCTAHEDRAL", 8) => {
            each_16(bytes, |v| octahedral(v.map(f32::from), MAX_16, v[3], |x| x as i16));
        }
        ("QUATERNION", 8) => each_16(bytes, quaternion),
        ("EXPONENTIAL", _) => {
            for word in bytes.as_chunks_mut::<4>().0 {
                *word = exponential(i32::from_le_bytes(*word)).to_le_bytes();
            }
        }
        ("COLOR", 4) => each_8(bytes, |v| {
            color(v.map(|c| c.into()), v[3] as u8 as u32, 255.0).map(|c| c as u8 as i8)
        }),
        ("COLOR", 8) => {
            each_16(bytes, |v| {
                color(v.map(|c| c.into()), v[3] as u16 as u32, 65535.0).map(|c| c as u16 as i16)
            });
        }
        ("OCTAHEDRAL" | "QUATERNION" | "COLOR", _) => {
            return Err("a stride that its filter does not take");
        }
        _ => return Err("an unknown filter"),
    }
    Ok(())
}

/// Returns a unit vector from the octahedron: x, y, and the value of 1.0; the fourth passes
/// through.
fn octahedral<T: Copy>([x, y, one, _]: [f32; 4], max: f32, fourth: T, to: fn(f32) -> T) -> [T; 4] {
    let (mut x, mut y) = (x / one, y / one);
    let z = 1.0 - x.abs() - y.abs();
    // The lower half is folded over the edges.
    let t = z.min(0.0);
    x += if x >= 0.0 { t } else { -t };
    y += if y >= 0.0 { t } else { -t };
    let scale = max / (x * x + y * y + z * z).sqrt();
    [to((x * scale).round()), to((y * scale).round()), to((z * scale).round()), fourth]
}

/// Returns a unit quaternion from its three smaller components and the place of the largest.
fn quaternion(v: [i16; 4]) -> [i16; 4] {
    let scale = FRAC_1_SQRT_2 / f32::from(v[3] | 3);
    let [x, y, z] = [v[0], v[1], v[2]].map(|c| f32::from(c) * scale);
    let w = (1.0 - x * x - y * y - z * z).max(0.0).sqrt();
    let largest = (v[3] & 3) as usize;
    let mut out = [0; 4];
    for (i, c) in [w, x, y, z].into_iter().enumerate() {
        out[(largest + i) % 4] = (c * MAX_16).round() as i16;
    }
    out
}

/// Returns 2^e · m with the exponent in the upper 8 bits and the mantissa in the lower 24, both signed.
fn exponential(v: i32) -> f32 {
    let (exponent, mantissa) = (v >> 24, v << 8 >> 8);
    let power = f64::from_bits(((1023 + i64::from(exponent)) as u64) << 52);
    (power * f64::from(mantissa)) as f32
}

/// Converts luma, two chroma and alpha to RGBA; the highest set bit of the alpha determines the scale.
fn color([y, co, cg, _]: [i32; 4], alpha: u32, max: f32) -> [f32; 4] {
    // The luma is unsigned, whatever the lanes are.
    let y = y & max as i32;
    let scale_bits = (u32::MAX >> alpha.leading_zeros().min(31)) as i32;
    let a = alpha as i32 & (scale_bits >> 1);
    let scale = max / scale_bits as f32;
    let parts = [y + co - cg, y + cg, y - co - cg, a << 1 | a & 1];
    parts.map(|c| (c as f32 * scale).round())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn octahedral_covers_both_halves() {
        let undo = |v: [i8; 4]| octahedral(v.map(f32::from), 127.0, v[3], |x| x as i8);
        assert_eq!(undo([0, 0, 127, 9]), [0, 0, 127, 9]);
        assert_eq!(undo([127, 127, 127, 0]), [0, 0, -127, 0]);
        assert_eq!(undo([0, -7, 7, 1]), [0, -127, 0, 1]);
        // (64, 32) of 127: z = 31/127.
        assert_eq!(undo([64, 32, 127, 0]), [104, 52, 50, 0]);
    }

    #[test]
    fn quaternions_are_turned_by_the_largest() {
        assert_eq!(quaternion([0, 0, 0, 32764 | 3]), [0, 0, 0, 32767]);
        assert_eq!(quaternion([0, 0, 0, 32764]), [32767, 0, 0, 0]);
        // Two equal components: each 1/√2 = 23170.
        assert_eq!(quaternion([32767, 0, 0, 32764 | 1]), [0, 23170, 23170, 0]);
    }

    #[test]
    fn exponentials_and_colours() {
        assert_eq!(exponential(0x0100_0003), 6.0);
        assert_eq!(exponential((-2i32 << 24) | 0x00ff_fffd), -0.75);
        // Eight bits: luma 100, co 20, cg −30, alpha 127 of 127 with the mark at bit 7.
        let out = color([100, 20, -30, 0], 0xff, 255.0);
        assert_eq!(out, [150.0, 70.0, 110.0, 255.0]);
    }
}
