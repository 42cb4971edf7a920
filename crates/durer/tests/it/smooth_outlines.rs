//! Outlines of the smooth surfaces that meshes stand for: round, and met by all that ends on them.

use crate::line_oracle::{distance, segments};
use crate::line_scenes::{Triangle, quad, soup, torus, view};
use durer::math::{DVec2, DVec3};
use durer::target::drawing::{Drawing, LineClass};
use durer::trace::NoTrace;
use durer::view::View;
use durer::visibility::line::hidden_line::{Options, draw};

fn smooth(triangles: &[Triangle], view: &View) -> Drawing {
    let options = Options { smooth: true, hidden: false, tolerance: 1e-6, ..Options::default() };
    draw(&soup(triangles), view, &options, &mut NoTrace).expect("drawing")
}

/// A ball of radius 1 of `n` by 2 `n` quadrilaterals.
fn ball(n: usize) -> Vec<Triangle> {
    let at = |i: usize, k: usize| {
        let angle = |j: usize, of: usize| (j % of) as f64 / of as f64 * std::f64::consts::TAU;
        let ((s, c), (t, d)) = (angle(i, 2 * n).sin_cos(), angle(k, 2 * n).sin_cos());
        DVec3::new(c * t, s * t, d)
    };
    let cells = (0..2 * n).flat_map(|i| (0..n).map(move |k| (i, k)));
    let quads = cells.map(|(i, k)| [at(i, k), at(i, k + 1), at(i + 1, k + 1), at(i + 1, k)]);
    quads.flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).collect()
}

#[test]
fn outline_of_a_coarse_ball_is_round() {
    for perspective in [false, true] {
        let v = view(DVec3::ZERO, DVec3::new(1.0, -1.7, 0.9), 4.0, perspective);
        let drawing = smooth(&ball(12), &v);
        // From 12 away a ball looks a little larger than it is.
        let radius = if perspective { 12.0 / 143.0_f64.sqrt() } else { 1.0 };
        let outline = drawing.lines.iter().filter(|l| l.class == LineClass::Silhouette);
        let radii: Vec<f64> =
            outline.flat_map(|l| &l.points).map(|p| p.length() / radius).collect();
        // Half of what the mesh's own outline has is further in, up to 0.86 %.
        let round = radii.iter().filter(|r| (**r - 1.0).abs() < 2e-3).count();
        assert!(4 * round > 3 * radii.len(), "{perspective}: {round} of {radii:?}");
        assert!(radii.iter().all(|r| (0.99..1.002).contains(r)), "{perspective}: {radii:?}");
        let closed = drawing.lines.iter().filter(|l| l.closed).count();
        let in_the_open = drawing.length(|l| !l.closed);
        assert_eq!(closed, 1, "{perspective}");
        // Near a pole one edge of a facet sticks out.
        assert!(in_the_open < 0.05 * drawing.length(|_| true), "{perspective}: {in_the_open}");
    }
}

#[test]
fn lines_that_pass_behind_a_smooth_outline_end_on_it() {
    let mut scene = torus(24, 12);
    for i in 0..9 {
        let at = |x: f64, y: f64| [x, y, -1.2];
        let y = -2.1 + 0.5 * f64::from(i);
        scene.extend(quad([at(-4.0, y), at(4.0, y), at(4.0, y + 0.21), at(-4.0, y + 0.21)]));
    }
    for to_eye in [DVec3::new(0.1, -0.7, 1.0), DVec3::new(1.0, 0.4, 0.9), DVec3::new(0.3, 0.2, 1.0)]
    {
        let v = view(DVec3::ZERO, to_eye, 12.0, false);
        let drawing = smooth(&scene, &v);
        let of = |class| drawing.lines.iter().filter(move |l| l.class == class);
        let outline: Vec<[DVec2; 2]> = of(LineClass::Silhouette).flat_map(segments).collect();
        let (mut on_outline, mut in_the_open) = (0, Vec::new());
        for line in of(LineClass::Border).filter(|l| !l.closed) {
            for end in [line.points[0], line.points[line.points.len() - 1]] {
                let gap = outline.iter().map(|s| distance(end, *s)).fold(f64::INFINITY, f64::min);
                if gap < 1e-5 {
                    on_outline += 1;
                } else {
                    in_the_open.push((end, gap));
                }
            }
        }
        assert!(
            on_outline > 30 && in_the_open.is_empty(),
            "{to_eye}: {on_outline}, {in_the_open:?}"
        );
    }
}

#[test]
fn outlines_of_balls_are_one_line_whatever_the_mesh() {
    let (mut drawings, mut pieces) = (0, 0);
    for n in [7, 10, 13, 18, 25] {
        for (x, y, z) in [(1.0, -1.7, 0.9), (0.3, -2.0, 0.2), (0.05, -0.1, 1.0), (-2.0, 0.7, -1.1)]
        {
            let drawing = smooth(&ball(n), &view(DVec3::ZERO, DVec3::new(x, y, z), 4.0, false));
            drawings += 1;
            pieces += drawing.lines.len();
        }
    }
    // Near a pole one edge of a facet may stick out.
    assert!(pieces < drawings + 3, "{pieces} in {drawings} drawings");
}
