//! The completeness of drawings for plotters: over scenes at which solvers fail, each class of lines is complete and
//! has nothing extra; no specks, nothing twice; counts of polylines. Independently of the solver: every feature edge is
//! sampled, and rays decide whether it is hidden.

use crate::line_oracle::{Edge, Oracle, Score, distance, drawn_twice, segments};
use crate::line_scenes::{
    Random, Triangle, city, cuboid, cylinder, placed, quad, random_boxes, soup, torus, view,
};
use durer::math::{DMat3, DMat4, DVec2, DVec3};
use durer::scene::Scene;
use durer::target::drawing::{Drawing, LineClass};
use durer::trace::NoTrace;
use durer::view::View;
use durer::visibility::line::hidden_line::{Options, draw};
use std::collections::BTreeMap;

/// Width of the picture in pixels.
const PIXELS: f64 = 1000.0;

/// A feature of the scene.
struct Feature {
    class: LineClass,
    edge: Edge,
}

/// Returns the features, found from the triangles alone, except those whose class depends on rounding.
fn features(oracle: &Oracle, triangles: &[Triangle]) -> Vec<Feature> {
    let normal = |i: u32| {
        let [a, b, c] = oracle.triangles()[i as usize];
        (b - a).cross(c - a).normalize_or_zero()
    };
    let class = |edge: &Edge| match edge.triangles[..] {
        [_] => Some(LineClass::Border),
        [a, b] => {
            let (_, sight) = oracle.sight(oracle.project(edge.ends[0]).0);
            // A face seen edge-on shows no front.
            let front = |i: u32| normal(i).dot(sight.normalize()) < -1e-9;
            let sharp = normal(a).dot(normal(b)) < 40.0_f64.to_radians().cos();
            if front(a) != front(b) {
                Some(LineClass::Silhouette)
            } else {
                sharp.then_some(LineClass::Crease)
            }
        }
        _ => Some(LineClass::NonManifold),
    };
    let of_mesh = oracle.edges().into_iter();
    let mut found: Vec<Feature> =
        of_mesh.filter_map(|edge| class(&edge).map(|class| Feature { class, edge })).collect();
    for (i, a) in triangles.iter().enumerate() {
        for b in &triangles[i + 1..] {
            if let Some(ends) = meeting(a, b, 1e-7 * oracle.extent()) {
                let edge = Edge { ends, triangles: Vec::new() };
                found.push(Feature { class: LineClass::Intersection, edge });
            }
        }
    }
    found
}

/// Returns the intersection of two triangles.
fn meeting(a: &Triangle, b: &Triangle, least: f64) -> Option<[DVec3; 2]> {
    let plane = |t: &Triangle| {
        let n = (t[1] - t[0]).cross(t[2] - t[0]).normalize_or_zero();
        (n, n.dot(t[0]))
    };
    let ((na, da), (nb, db)) = (plane(a), plane(b));
    let along = na.cross(nb).normalize_or_zero();
    let cut = |t: &Triangle, (n, d): (DVec3, f64)| {
        let s = t.map(|p| n.dot(p) - d);
        let crossing = |i: usize| {
            let k = (i + 1) % 3;
            (s[i] * s[k] < 0.0 && s[i].abs().min(s[k].abs()) > least)
                .then(|| t[i].lerp(t[k], s[i] / (s[i] - s[k])))
        };
        let ends: Vec<DVec3> = (0..3).filter_map(crossing).collect();
        <[DVec3; 2]>::try_from(ends).ok()
    };
    let (p, q) = (cut(a, (nb, db))?, cut(b, (na, da))?);
    let order = |[x, y]: [DVec3; 2]| if x.dot(along) < y.dot(along) { [x, y] } else { [y, x] };
    let (p, q) = (order(p), order(q));
    let from = if p[0].dot(along) > q[0].dot(along) { p[0] } else { q[0] };
    let to = if p[1].dot(along) < q[1].dot(along) { p[1] } else { q[1] };
    ((to - from).dot(along) > 10.0 * least).then_some([from, to])
}

/// Results of checking a drawing.
#[derive(Debug, Default)]
struct Marks {
    precision: BTreeMap<LineClass, Score>,
    recall: BTreeMap<LineClass, Score>,
}

/// Samples in both directions, with a tolerance of a tenth of a pixel.
fn marks(oracle: &Oracle, features: &[Feature], drawing: &Drawing) -> Marks {
    let pixel = oracle.extent() / PIXELS;
    let (slack, mut marks) = (0.1 * pixel, Marks::default());
    let plane = |e: &Edge| e.ends.map(|p| oracle.project(p).0);
    for line in drawing.lines.iter().filter(|l| l.is_visible()) {
        for [a, b] in segments(line) {
            let count = (a.distance(b) / pixel).ceil().clamp(1.0, 60.0) as usize;
            // Features that run along this piece somewhere.
            let near: Vec<&Feature> = features
                .iter()
                .filter(|f| f.class <= line.class || line.class <= f.class)
                .filter(|f| overlaps([a, b], plane(&f.edge), slack))
                .collect();
            for k in 0..count {
                let p = a.lerp(b, (k as f64 + 0.43) / count as f64);
                let fits = near.iter().any(|f| {
                    let (t, d) = oracle.nearest(&f.edge, p);
                    d <= slack && f.class == line.class && !surely_hidden(oracle, &f.edge, t, slack)
                });
                marks.precision.entry(line.class).or_default().add(fits);
            }
        }
    }
    let visible: Vec<(LineClass, [DVec2; 2])> = drawing
        .lines
        .iter()
        .filter(|l| l.is_visible())
        .flat_map(|l| segments(l).into_iter().map(|s| (l.class, s)))
        .collect();
    for feature in features {
        let ends = plane(&feature.edge);
        let length = ends[0].distance(ends[1]);
        if length < pixel {
            continue;
        }
        let near: Vec<_> = visible.iter().filter(|(_, s)| overlaps(*s, ends, slack)).collect();
        let count = (length / pixel * 4.0).ceil().min(120.0) as usize;
        for k in 0..count {
            let t = (k as f64 + 0.37) / count as f64;
            if surely_visible(oracle, &feature.edge, t, slack / length) {
                let p = oracle.project(feature.edge.ends[0].lerp(feature.edge.ends[1], t)).0;
                // Where lines coincide, the class listed first is drawn.
                let drawn =
                    near.iter().any(|(c, s)| *c <= feature.class && distance(p, *s) <= slack);
                marks.recall.entry(feature.class).or_default().add(drawn);
            }
        }
    }
    marks
}

fn overlaps(s: [DVec2; 2], e: [DVec2; 2], slack: f64) -> bool {
    let (lo, hi) = (s[0].min(s[1]) - slack, s[0].max(s[1]) + slack);
    lo.cmple(e[0].max(e[1])).all() && hi.cmpge(e[0].min(e[1])).all()
}

fn surely_visible(oracle: &Oracle, edge: &Edge, t: f64, step: f64) -> bool {
    [-step, 0.0, step].iter().all(|d| !oracle.hidden(edge, (t + d).clamp(0.0, 1.0)))
}

fn surely_hidden(oracle: &Oracle, edge: &Edge, t: f64, slack: f64) -> bool {
    let [a, b] = edge.ends.map(|p| oracle.project(p).0);
    let step = slack / a.distance(b);
    [-step, 0.0, step].iter().all(|d| oracle.hidden(edge, (t + d).clamp(0.0, 1.0)))
}

fn prism(turn: DMat3, radius: f64, half: f64) -> Vec<Triangle> {
    let upright = cylinder([0.0; 2], radius, [-half, half], 3);
    upright.into_iter().map(|t| t.map(|p| turn * p)).collect()
}

fn crossing_prisms() -> Vec<Triangle> {
    let mut prisms = prism(DMat3::IDENTITY, 1.0, 3.0);
    prisms.extend(prism(DMat3::from_rotation_x(1.5) * DMat3::from_rotation_z(0.3), 1.1, 3.0));
    prisms
}

fn scenes() -> Vec<(&'static str, Vec<Triangle>, DVec3)> {
    let iso = DVec3::new(1.0, -1.7, 0.9);
    let mut touching = cuboid([0.0; 3], [2.0; 3]);
    touching.extend(cuboid([2.0, 0.5, 0.25], [3.0, 1.5, 1.0]));
    touching.extend(cuboid([0.5, 0.5, 2.0], [1.5, 1.5, 3.0]));
    let mut plate = cuboid([-4.0, -4.0, -1.0], [4.0, 4.0, 0.0]);
    plate.extend(cylinder([-1.5, 0.0], 1.2, [0.0, 3.0], 24));
    plate.extend(cylinder([2.0, 1.0], 0.8, [0.0, 1.5], 17));
    let mut random = Random(11);
    let open: Vec<Triangle> = (0..40)
        .map(|_| {
            let at = DVec3::from(std::array::from_fn(|_| random.next() * 6.0));
            std::array::from_fn(|_| at + DVec3::from(std::array::from_fn(|_| random.next() * 2.0)))
        })
        .collect();
    let mut fins = cuboid([0.0; 3], [3.0, 0.5, 1.0]);
    fins.extend(quad([[0.0, 0.0, 1.0], [3.0, 0.0, 1.0], [3.0, -1.0, 2.0], [0.0, -1.0, 2.0]]));
    let bar = |k: usize| {
        let turn = DMat3::from_rotation_z(k as f64 * std::f64::consts::TAU / 3.0);
        let corners = [[-2.5, -1.2, 0.4], [2.5, -1.2, -0.4], [2.5, -0.8, -0.4], [-2.5, -0.8, 0.4]];
        quad(corners.map(|c| (turn * DVec3::from(c)).to_array()))
    };
    vec![
        ("cube", cuboid([-1.0; 3], [1.0; 3]), iso),
        ("bars in a cycle", (0..3).flat_map(bar).collect(), DVec3::Z),
        ("crossing prisms", crossing_prisms(), iso),
        ("touching boxes", touching, iso),
        ("cylinders on a plate", plate, DVec3::new(0.6, -1.0, 0.7)),
        ("city", city(4), DVec3::ONE),
        ("boxes", random_boxes(12, 1), iso),
        ("open", open, iso),
        ("fins", fins, iso),
        ("edge-on", cuboid([-1.0; 3], [1.0; 3]), DVec3::NEG_Y),
        ("cusps", torus(32, 16), DVec3::new(0.0, -1.0, 0.45)),
    ]
}

fn drawn(scene: &Scene, view: &View) -> Drawing {
    draw(scene, view, &Options { hidden: false, ..Options::default() }, &mut NoTrace)
        .expect("drawing")
}

/// Returns the scene moved and scaled: 32-bit numbers keep exact coordinates exact.
fn placings() -> [(f64, DVec3); 5] {
    [
        (1.0, DVec3::ZERO),
        (1e-6, DVec3::ZERO),
        (1e6, DVec3::ZERO),
        (1e-3, DVec3::ONE),
        (1.0, DVec3::new(512.0, -2048.0, 64.0)),
    ]
}

#[test]
fn line_classes_are_complete_and_nothing_else_is_drawn() {
    let mut wrong = Vec::new();
    for (name, triangles, to_eye) in scenes() {
        for (k, (scale, by)) in placings().into_iter().enumerate() {
            let matrix = DMat4::from_scale(DVec3::splat(scale)) * DMat4::from_translation(by);
            // As the library gets them: 32-bit coordinates, placed by the matrix.
            let place = |p: DVec3| matrix.transform_point3(p.as_vec3().as_dvec3());
            let mut there: Vec<Triangle> = triangles.iter().map(|t| t.map(place)).collect();
            let middle = there.iter().flatten().sum::<DVec3>() / (3.0 * there.len() as f64);
            let v = view(middle, to_eye, 14.0 * scale, k == 0);
            let mut mixed = triangles.clone();
            if k == 4 {
                mixed.reverse();
                mixed.iter_mut().for_each(|t| t.rotate_left(1));
            }
            let found = drawn(&placed(&mixed, matrix), &v);
            there.dedup();
            let oracle = Oracle::new(&there, &v);
            let marks = marks(&oracle, &features(&oracle, &there), &found);
            for (what, scores) in [("precision", &marks.precision), ("recall", &marks.recall)] {
                for (class, score) in scores {
                    if score.share() < 0.9999 {
                        wrong.push(format!("{name} {k}: {what} of {class}: {score:?}"));
                    }
                }
            }
            let pixel = oracle.extent() / PIXELS;
            let specks = found.lines.iter().filter(|l| l.length() < 0.05 * pixel).count();
            let twice = drawn_twice(&found, 0.02 * pixel);
            let length = found.length(|_| true);
            if specks > 0 || twice > 1e-3 * length || marks.precision.is_empty() {
                wrong.push(format!("{name} {k}: {specks} specks, {twice} of {length} twice"));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn crossing_prisms_meet_along_their_whole_intersection() {
    let v = view(DVec3::ZERO, DVec3::new(1.0, -1.7, 0.9), 8.0, false);
    let prisms = crossing_prisms();
    let found = draw(&soup(&prisms), &v, &Options::default(), &mut NoTrace).expect("drawing");
    let oracle = Oracle::new(&prisms, &v);
    let features = features(&oracle, &prisms);
    let meets = features.iter().filter(|f| f.class == LineClass::Intersection);
    let plane = |f: &Feature| f.edge.ends.map(|p| oracle.project(p).0);
    let expected: f64 = meets.map(plane).map(|[a, b]| a.distance(b)).sum();
    let length = found.length(|l| l.class == LineClass::Intersection);
    assert!(expected > 1.0 && (length - expected).abs() < 1e-4 * expected, "{length} {expected}");
}
