//! Creases recognized by their neighbouring faces.

use crate::data;
use crate::line_scenes::{Triangle, cylinder, quad, soup, view};
use durer::math::{DVec2, DVec3};
use durer::target::drawing::LineClass;
use durer::trace::NoTrace;
use durer::visibility::line::Smooth;
use durer::visibility::line::hidden_line::{Options, draw};

/// Returns the length of all creases that are not outlines, seen from above.
fn creases(triangles: &[Triangle], crease: f64, neighbours: bool) -> f64 {
    let view = view(DVec3::ZERO, DVec3::new(0.0, -0.3, 1.0), 12.0, false);
    let options = Options { crease: crease.to_radians(), neighbours, ..Options::default() };
    let drawing = draw(&soup(triangles), &view, &options, &mut NoTrace).expect("drawing");
    drawing.length(|line| line.class == LineClass::Crease)
}

/// Returns a body along x whose cross-section at each position is a polygon; fans close its ends.
fn along(rings: &[Vec<DVec3>]) -> Vec<Triangle> {
    let count = rings[0].len();
    let mut triangles = Vec::new();
    for pair in rings.windows(2) {
        for i in 0..count {
            let k = (i + 1) % count;
            let ([a, b], [c, d]) = ([pair[0][i], pair[0][k]], [pair[1][k], pair[1][i]]);
            triangles.extend(quad([a, b, c, d].map(|p| p.to_array())));
        }
    }
    for i in 1..count - 1 {
        let (first, last) = (&rings[0], &rings[rings.len() - 1]);
        triangles.push([first[0], first[i + 1], first[i]]);
        triangles.push([last[0], last[i], last[i + 1]]);
    }
    triangles
}

/// Returns a bar from x = −3 to 3 with a roof that rises by `rise` to its ridge at y = 0.
fn roof(rise: f64) -> Vec<Triangle> {
    let section = [[-2.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0 + rise], [-2.0, 1.0]];
    let ring = |x: f64| section.iter().map(|[y, z]| DVec3::new(x, *y, *z)).collect::<Vec<_>>();
    along(&[ring(-3.0), ring(3.0)])
}

#[test]
fn a_blunt_edge_between_flat_faces_is_a_crease() {
    // The angle is 11.4°, the length 6; outlines and sharp edges are the same with it.
    let by_angle = creases(&roof(0.2), 40.0, false);
    let by_neighbours = creases(&roof(0.2), 40.0, true);
    assert!((by_neighbours - by_angle - 6.0).abs() < 0.05, "{by_angle} {by_neighbours}");
    // Flat within the bound on rounding.
    let flat = [false, true].map(|neighbours| creases(&roof(0.04), 40.0, neighbours));
    assert_eq!(flat[0], flat[1]);
}

#[test]
fn facets_of_round_parts_are_no_creases() {
    for sides in [12, 24, 60] {
        let body = cylinder([0.0; 2], 2.0, [0.0, 3.0], sides);
        let [by_angle, by_neighbours] = [false, true].map(|n| creases(&body, 40.0, n));
        assert_eq!(by_angle, by_neighbours, "{sides}");
    }
}

/// Returns a barrel of nine sides: in the middle they turn by 40°, nearer to the ends by 37°.
fn barrel(sides: usize) -> Vec<Triangle> {
    let ring = |(x, radius): (f64, f64)| {
        let angle = |i: usize| i as f64 / sides as f64 * std::f64::consts::TAU;
        let at = |i: usize| DVec3::new(x, radius * angle(i).cos(), radius * angle(i).sin());
        (0..sides).map(at).collect::<Vec<_>>()
    };
    along(&[(-3.0, 1.2), (-1.0, 2.0), (1.0, 2.0), (3.0, 1.2)].map(ring))
}

#[test]
fn ticks_within_a_round_part_are_no_creases() {
    let [by_angle, by_neighbours] = [false, true].map(|n| creases(&barrel(9), 38.0, n));
    // Nine edges of 2, some of them outlines.
    assert!(by_angle - by_neighbours > 8.0, "{by_angle} {by_neighbours}");
    // Those of a bar of six sides extend from end to end.
    let [by_angle, by_neighbours] = [false, true].map(|n| creases(&barrel(6), 38.0, n));
    assert_eq!(by_angle, by_neighbours);
}

/// Returns a bar from x = −4 to 4 with a vaulted roof; a valley in it at y = 0 has sides with the given slope at each
/// of 16 steps.
fn valley(slope: impl Fn(usize) -> f64) -> Vec<Triangle> {
    let ring = |i: usize| {
        let x = i as f64 / 2.0 - 4.0;
        let height = |y: f64| 1.0 - y * y / 16.0 + y.abs() * slope(i);
        let roof = (0..9).map(|k| 2.0 - f64::from(k) / 2.0);
        let roof = roof.map(|y| DVec3::new(x, y, height(y)));
        let floor = [-2.0, 2.0].map(|y| DVec3::new(x, y, -1.0));
        floor.into_iter().chain(roof).collect::<Vec<_>>()
    };
    along(&(0..17).map(ring).collect::<Vec<_>>())
}

#[test]
fn creases_between_round_parts_go_on_where_they_fade() {
    let fading = |i: usize| 0.33 * ((16 - i) as f64 / 16.0).powi(2);
    let mut faded = valley(fading);
    for _ in 0..2 {
        let [by_angle, by_neighbours] = [false, true].map(|n| creases(&faded, 40.0, n));
        // From 36° down to less than the facets' own 3.6°.
        assert!((by_neighbours - by_angle - 8.0).abs() < 0.01, "{by_angle} {by_neighbours}");
        faded.reverse();
    }
    // A vault alone, and one whose valley ends less than a third of the way across.
    let ends_early = |i: usize| 0.33 * (1.0 - i as f64 / 5.0).max(0.0);
    for body in [valley(|_| 0.0), valley(ends_early)] {
        let [by_angle, by_neighbours] = [false, true].map(|n| creases(&body, 40.0, n));
        assert_eq!(by_angle, by_neighbours);
    }
}

#[test]
fn slivers_of_fillets_leave_no_ticks() {
    let Some(folder) = data::folder() else { return };
    let scene = data::read_model(&folder.join("cases/drawing/flange_tol0.2.stl")).scene;
    let view = view(DVec3::new(0.0, 0.0, 14.0), DVec3::new(1.0, -1.0, 1.0), 90.0, false);
    let options = Options {
        smooth: Smooth::Auto,
        neighbours: true,
        hidden: false,
        stubs: 0.01,
        ..Options::default()
    };
    let drawing = draw(&scene, &view, &options, &mut NoTrace).expect("drawing");
    let length = |points: &[DVec2]| points.windows(2).map(|w| w[0].distance(w[1])).sum::<f64>();
    let outlines = drawing.lines.iter().filter(|l| l.class == LineClass::Silhouette && !l.closed);
    // Out of 80; the edges of its slivers are 1.3 long.
    let short: Vec<_> = outlines.filter(|l| length(&l.points) < 4.0).collect();
    assert!(short.is_empty(), "{short:?}");
}
