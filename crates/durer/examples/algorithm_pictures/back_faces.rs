//! Faces of a torus of quadrangles: those that back-face removal keeps, and those that it removes.

use crate::overlay;
use durer::math::{DVec2, DVec3};
use durer::scene::Camera;
use durer::target::Framebuffer;
use durer::trace::NoTrace;
use durer::view::View;
use durer::visibility::back_face::{Eye, Options, remove};

const AROUND: u32 = 28;

const ACROSS: u32 = 12;

/// Returns a torus, its faces counter-clockwise seen from outside.
fn faces() -> Vec<Vec<DVec3>> {
    let turn = |i: u32, n: u32| f64::from(i % n) / f64::from(n) * std::f64::consts::TAU;
    let point = |i: u32, j: u32| {
        let (u, v) = (turn(i, AROUND), turn(j, ACROSS));
        let radius = 1.0 + 0.45 * libm::cos(v);
        DVec3::new(radius * libm::cos(u), 0.45 * libm::sin(v), -radius * libm::sin(u))
    };
    let faces = (0..AROUND).flat_map(|i| (0..ACROSS).map(move |j| (i, j)));
    let face = |(i, j)| vec![point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)];
    faces.map(face).collect()
}

/// Returns all edges on the left, and the edges of the kept faces on the right.
pub fn picture(camera: &Camera, [width, height]: [u32; 2]) -> durer::Result<Framebuffer> {
    let camera = Camera { eye: DVec3::new(0.0, 3.9, 5.4), ..*camera };
    let view = View::new(camera, width / 2, height)?;
    let faces = faces();
    let given = faces.iter().map(Vec::as_slice);
    let kept = remove(given, Eye::of(&camera), &Options::default(), &mut NoTrace);
    let mut picture = Framebuffer::new(width, height);
    picture.color.data_mut().fill([255; 4]);
    let mut draw = |face: usize, column: u32| {
        let on_screen = faces[face].iter().map(|p| {
            let at = view.screen_from_world() * p.extend(1.0);
            DVec2::new(at.x / at.w + f64::from(column), at.y / at.w)
        });
        overlay::outline(&on_screen.collect::<Vec<_>>(), &mut picture.color);
    };
    (0..faces.len()).for_each(|face| draw(face, 0));
    kept.into_iter().for_each(|face| draw(face, width / 2));
    Ok(picture)
}
