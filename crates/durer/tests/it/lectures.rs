//! The worked examples of the classical lectures: not only the results but also the intermediate numbers, as the steps
//! record them.

mod bodies;
mod formulas;
mod hidden;
mod lines;
mod pixels;
mod polygons;
mod surfaces;
mod views;

use durer::math::DVec2;

fn p(x: f64, y: f64) -> DVec2 {
    DVec2::new(x, y)
}

/// Returns whether two numbers are equal up to rounding.
fn near(a: f64, b: f64) -> bool {
    (a - b).abs() < 1e-12
}

#[test]
fn a_window_maps_to_a_viewport_by_two_products_and_two_sums() {
    use durer::view::window::{Aspect, PixelRect, Viewport, Window, WindowToViewport, YAxis};
    let window = Window::new(0.0, 4.0, 0.0, 2.0).unwrap();
    let viewport = Viewport::new(PixelRect::new(100, 50, 300, 250).unwrap()).unwrap();
    let map = WindowToViewport::new(&window, &viewport, Aspect::Stretch, YAxis::Up);
    assert_eq!(map.coefficients(), [50.0, 100.0, 100.0, 50.0]);
    assert_eq!(map.to_screen(p(1.0, 1.0)), p(150.0, 150.0));
    // From the top of the screen, the same point has its row counted down from the viewport's last.
    let map = WindowToViewport::new(&window, &viewport, Aspect::Stretch, YAxis::Down);
    assert_eq!(map.to_screen(p(1.0, 1.0)), p(150.0, 150.0));
    assert_eq!(map.to_screen(p(1.0, 0.0)), p(150.0, 250.0));
}
