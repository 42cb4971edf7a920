//! Unit tests: every SIMD level gives the same bytes.

use super::*;
use crate::math::DVec2;

#[test]
fn every_simd_level_paints_the_same_bytes() {
    for blending in [Blending::Srgb, Blending::Linear] {
        let options = Options { blending, ..Options::default() };
        let mut canvas = Canvas::new(133, 70, options).unwrap();
        for i in 0..20_u8 {
            let center = DVec2::new(f64::from(i) * 7.3, f64::from(i) * 3.1);
            let paint = Paint::Color([i * 12, 255 - i * 3, 80, 255 - i * 9]);
            canvas.fill(&Path::circle(center, 20.0), FillRule::NonZero, &paint, 0.9);
            let mut line = Path::new();
            line.move_to(center.x, 3.0).line_to(130.0 - 2.0 * center.x, 60.0 - center.y);
            canvas.stroke(&line, &Stroke::default(), &paint, 1.0).unwrap();
        }
        let at = |level| {
            let mut target = Pixels::new(133, 70, [250, 240, 10, 200]);
            canvas.render_at(level, &mut target).unwrap();
            target
        };
        assert_eq!(at(Level::new()), at(Level::baseline()));
    }
}
