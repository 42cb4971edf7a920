//! Any bytes become a scene, whose hidden lines and visible regions must be sound: the bodies of the fuzz
//! targets `lines` and `regions`, which the tests call as well.

use super::surfaces::{Bytes, camera, scene};
use durer::math::DVec2;
use durer::scene::{Projection, Scene};
use durer::trace::NoTrace;
use durer::view::View;
use durer::visibility::line::hidden_line;
use durer::visibility::region::planar_map::{Options, VisibleRegion, solve};

/// Columns and rows of pixels of the pictures.
const WIDTH: u32 = 80;
const HEIGHT: u32 = 60;

fn seen(data: &[u8]) -> Option<(Scene, View)> {
    let mut bytes = Bytes(data);
    let view = View::new(camera(&mut bytes), WIDTH, HEIGHT).ok()?;
    Some((scene(&mut bytes), view))
}

/// Returns the same triangles, the last first.
fn reversed(scene: &Scene) -> Scene {
    let mut scene = scene.clone();
    for mesh in &mut scene.meshes {
        mesh.parts.clear();
        let mut triangles = mesh.positions.as_chunks::<3>().0.to_vec();
        triangles.reverse();
        mesh.positions = triangles.into_flattened();
    }
    scene
}

/// Returns the height of the picture where the target is, in units of the scene.
fn height(view: &View) -> f64 {
    let camera = view.camera();
    match camera.projection {
        Projection::Orthographic { height } => height,
        Projection::Perspective { fov_y } => {
            2.0 * libm::tan(fov_y / 2.0) * camera.eye.distance(camera.target)
        }
    }
}

/// Lines are finite, and the order of the triangles is of no matter, to the bit.
///
/// # Panics
/// Where that is not so.
pub fn lines(data: &[u8]) {
    let Some((mut scene, view)) = seen(data) else { return };
    scene.meshes.iter_mut().for_each(|mesh| mesh.parts.clear());
    let options = hidden_line::Options::default();
    let draw = |scene: &Scene| hidden_line::draw(scene, &view, &options, &mut NoTrace);
    let Ok(drawing) = draw(&scene) else { return };
    for line in &drawing.lines {
        assert!(line.points.len() >= 2 && line.points.iter().all(|p| p.is_finite()), "{line:?}");
    }
    let again = draw(&reversed(&scene)).expect("the same triangles");
    assert!(again.lines == drawing.lines, "{:?}\n{:?}", again.lines, drawing.lines);
}

/// Regions are a planar map, and neither overlap nor leave gaps.
///
/// # Panics
/// Where that is not so.
pub fn regions(data: &[u8]) {
    let Some((scene, view)) = seen(data) else { return };
    let Ok(map) = solve(&scene, &view, &Options::default(), &mut NoTrace) else { return };
    let [vertices, edges, faces, parts] = map.counts();
    assert_eq!(vertices + faces, edges + 1 + parts, "Euler");
    let (items, whole) = (map.regions(u64::from), map.regions(|_| 0));
    let area = |regions: &[VisibleRegion]| regions.iter().map(VisibleRegion::area).sum::<f64>();
    // Vertices within a step of the grid are left out of straight lines.
    let step = height(&view) * f64::from(WIDTH) / f64::from(HEIGHT) / f64::from(1u32 << 30);
    let within = step * (length(&items) + length(&whole));
    let (sum, whole) = (area(&items), area(&whole));
    assert!((sum - whole).abs() <= within, "{sum} {whole}: {within}");
    let count = scene.triangle_count() as u32;
    assert!(items.iter().all(|r| r.item < count && r.area() >= 0.0));
}

/// Returns the length of all borders.
fn length(regions: &[VisibleRegion]) -> f64 {
    let around = |ring: &Vec<DVec2>| {
        let next = ring.iter().cycle().skip(1);
        ring.iter().zip(next).map(|(a, b)| a.distance(*b)).sum::<f64>()
    };
    regions.iter().flat_map(|region| &region.rings).map(around).sum()
}
