use super::*;
use crate::math::DVec2;

#[test]
fn the_finest_grid_is_a_power_of_two() {
    let bounds = Rect::new(DVec2::splat(-180.0), DVec2::splat(180.0)).ok();
    let cell = finest_grid([bounds, None]).expect("a grid");
    assert!(cell >= 360.0 / 2f64.powi(40) && cell <= 360.0 / 2f64.powi(39));
    assert_eq!(cell.to_bits() << 12, 0);
}
