//! The inside view: every SIMD level gives the same bytes.

use super::*;
use crate::math::DVec2;
use crate::trace::NoTrace;

#[test]
fn every_simd_level_gives_the_same_bytes() {
    let mut seed = 3_u64;
    let mut random = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 33) as f64 / f64::from(1_u32 << 31) * 300.0 - 20.0
    };
    let contours = Contours::polygon((0..60).map(|_| DVec2::new(random(), random())));
    for rule in [FillRule::NonZero, FillRule::EvenOdd] {
        let options = Options { rule, ..Options::default() };
        let at = |level| fill_at(level, &contours, 257, 261, &options, &mut NoTrace).unwrap();
        let reference = at(Level::baseline());
        assert_eq!(at(Level::new()), reference);
        assert!(reference.data().iter().any(|c| *c > 0 && *c < 255));
    }
}
