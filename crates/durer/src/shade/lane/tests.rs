//! Scalar lanes and vector lanes give the same.

use super::*;
use crate::simd::dispatch;

#[test]
fn powers_are_close_to_the_platforms() {
    for i in 1..=1000 {
        let x = i as f32 / 1000.0;
        for e in [0.0_f32, 0.5, 1.0, 2.2, 17.3, 96.078, 900.5] {
            let exact = f64::from(x).powf(f64::from(e));
            let log = f64::from(e) * f64::from(x).log2();
            if log > -120.0 {
                let error = (f64::from(x.power_real(e)) - exact).abs();
                assert!(error <= exact * 1e-6 * (1.0 + log.abs()), "{x}^{e}");
            }
        }
        let exact = f64::from(x).powi(37);
        assert!((f64::from(x.power(37)) - exact).abs() <= exact * 1e-5 + 1e-37);
    }
    assert!(0.0_f32.power_real(2.0) < 1e-37);
    assert_eq!(1.0_f32.power_real(55.5), 1.0);
    assert!(f32::NAN.power_real(2.0) < 1e-37);
}

#[inline(always)]
fn functions<L: Lane>(x: L) -> [L; 6] {
    let v = Vec3Lane::new(x, x * 0.5, x - 1.0);
    let unit = v.unit_or(Vec3Lane::splat(x, Vec3::X));
    [x.power_real(3.7), x.log2(), (x * 0.3).exp2(), x.at_most(2.0).power(11), unit.x, unit.z]
}

#[test]
fn eight_lanes_are_eight_numbers_bit_for_bit() {
    let inputs: [f32; 8] = [1e-30, 1e-3, 0.7, 1.0, 1.5, 3.25, 1e9, 1e30];
    for level in crate::simd::levels() {
        let lanes = dispatch!(level, simd => {
            functions(f32x8::simd_from(simd, inputs)).map(<[f32; 8]>::from)
        });
        for (i, &x) in inputs.iter().enumerate() {
            let scalar = functions(x);
            for (a, b) in scalar.iter().zip(&lanes) {
                assert_eq!(a.to_bits(), b[i].to_bits(), "{x} at {level:?}");
            }
        }
    }
}

#[test]
fn vectors_without_direction_are_replaced() {
    for v in [Vec3::ZERO, Vec3::NAN, Vec3::splat(f32::INFINITY), Vec3::splat(1e30)] {
        assert_eq!(Vec3::from(Vec3Lane::from(v).unit_or(Vec3::Y.into())), Vec3::Y);
    }
}
