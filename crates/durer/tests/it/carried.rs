//! Hidden lines whose visibility is carried along edges, by Appel and by Galimberti and Montanari: hand-computed
//! numbers, comparison with rays, and the same drawing as by the production's hidden lines.

use crate::line_scenes::{
    Random, Triangle, city, cuboid, cylinder, soup, torus, turned_boxes, view,
};
use durer::Error;
use durer::math::DVec3;
use durer::target::drawing::LineClass;
use durer::trace::{NoTrace, Recorder};
use durer::visibility::back_face::Eye;
use durer::visibility::line::face_net::FaceNet;
use durer::visibility::line::{ClassSet, appel, galimberti_montanari as natures, hidden_line};
use durer::work::Work;

const ISO: DVec3 = DVec3::new(1.0, -1.7, 0.9);

fn net(triangles: &[Triangle], eye: Eye) -> FaceNet {
    let faces: Vec<Vec<DVec3>> = triangles.iter().map(|t| t.to_vec()).collect();
    FaceNet::new(&faces, eye).unwrap()
}

fn by_numbers(net: &FaceNet) -> Vec<appel::AppelEdge> {
    let mut steps = Recorder::default();
    let lines = appel::draw(net, &appel::Options::default(), &Work::default(), &mut steps).unwrap();
    assert_eq!(
        appel::draw(net, &appel::Options::default(), &Work::default(), &mut NoTrace).unwrap(),
        lines
    );
    assert_eq!(appel::replay(net, steps.steps()), lines);
    lines
}

fn by_sets(net: &FaceNet) -> Vec<natures::GalimbertiEdge> {
    let mut steps = Recorder::default();
    let lines =
        natures::draw(net, &natures::Options::default(), &Work::default(), &mut steps).unwrap();
    assert_eq!(
        natures::draw(net, &natures::Options::default(), &Work::default(), &mut NoTrace).unwrap(),
        lines
    );
    assert_eq!(natures::replay(net, steps.steps()), lines);
    lines
}

/// Returns an L-shaped prism, which hides parts of itself.
fn step() -> Vec<Triangle> {
    let profile = [(0.0, 0.0), (4.0, 0.0), (4.0, 1.0), (2.0, 1.0), (2.0, 3.0), (0.0, 3.0)];
    let at = |i: usize, y: f64| {
        let (x, z): (f64, f64) = profile[i % 6];
        DVec3::new(x, y, z)
    };
    let mut all = Vec::new();
    for i in 0..6 {
        let [a, b, c, d] = [at(i, 0.0), at(i + 1, 0.0), at(i + 1, 5.0), at(i, 5.0)];
        all.extend([[a, b, c], [a, c, d]]);
    }
    for y in [0.0, 5.0] {
        for [a, b, c] in [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5]] {
            all.push([at(a, y), at(b, y), at(c, y)]);
        }
    }
    all
}

/// Bodies that hide parts of themselves and of each other.
fn solids() -> Vec<(&'static str, Vec<Triangle>)> {
    let mut random = Random(11);
    let mut pillars = step();
    pillars.extend(cuboid([2.5, 1.0, 1.5], [3.5, 2.0, 4.0]));
    pillars.extend(cylinder([6.0, 2.0], 0.9, [-1.0, 3.0], 7));
    vec![
        ("step", step()),
        ("pillars", pillars),
        ("ring", torus(9, 6)),
        ("city", city(3)),
        ("few boxes", turned_boxes(3, &mut random)),
        ("many boxes", turned_boxes(6, &mut random)),
    ]
}

/// Returns the faces, except those at the edge, that hide a point of an edge, found by a ray to the eye; `None` if the
/// ray passes too close to a border or a face is too close to the point.
fn hiding(net: &FaceNet, edge: usize, point: DVec3, eye: Eye) -> Option<Vec<usize>> {
    let to_eye = match eye {
        Eye::At(at) => (at - point).normalize(),
        Eye::Along(direction) => -direction.normalize(),
    };
    let mut found = Vec::new();
    for (number, face) in net.faces().iter().enumerate() {
        if net.edges()[edge].faces.contains(&number) || !net.is_hider(number) {
            continue;
        }
        let [a, b, c] = [0, 1, 2].map(|k| net.corners()[face.ring[k]]);
        // Möller and Trumbore's solution for the triangle.
        let (e1, e2) = (b - a, c - a);
        let p = to_eye.cross(e2);
        let det = e1.dot(p);
        if det.abs() < 1e-4 {
            return None;
        }
        let s = point - a;
        let q = s.cross(e1);
        let (u, v, t) = (s.dot(p) / det, to_eye.dot(q) / det, e2.dot(q) / det);
        let inner = u.min(v).min(1.0 - u - v);
        if inner.abs() < 1e-3 || (inner > 0.0 && t.abs() < 1e-3) {
            return None;
        }
        if inner > 0.0 && t > 0.0 {
            found.push(number);
        }
    }
    Some(found)
}

#[test]
fn numbers_and_natures_are_those_of_rays() {
    let mut checked = 0;
    for (name, triangles) in solids() {
        for eye in [Eye::Along(-ISO), Eye::At(DVec3::new(9.0, -14.0, 8.0))] {
            let net = net(&triangles, eye);
            let (numbers, sets) = (by_numbers(&net), by_sets(&net));
            assert_eq!(numbers.len(), sets.len());
            for (line, other) in numbers.iter().zip(&sets) {
                assert_eq!((line.edge, line.ends), (other.edge, other.ends));
                for k in 0..11 {
                    let t = (f64::from(k) + 0.37) / 11.0;
                    let point = line.ends[0].lerp(line.ends[1], t);
                    let Some(faces) = hiding(&net, line.edge, point, eye) else { continue };
                    let span = line.spans.iter().rev().find(|span| span.from <= t).unwrap();
                    let part = other.parts.iter().rev().find(|part| part.from <= t).unwrap();
                    assert_eq!(part.nature, faces, "{name} {eye:?} {t} {line:?}");
                    assert_eq!(span.invisibility as usize, faces.len(), "{name} {eye:?} {line:?}");
                    checked += 1;
                }
            }
        }
    }
    assert!(checked > 5_000, "{checked}");
}

/// Returns surfaces with holes, whose backs hide as their fronts do.
#[test]
fn natures_of_open_surfaces_are_those_of_rays() {
    let mut checked = 0;
    for (name, triangles) in solids() {
        let open: Vec<Triangle> =
            triangles.chunks(7).flat_map(|some| &some[1..]).copied().collect();
        let eye = Eye::Along(-ISO);
        let net = net(&open, eye);
        assert!(!net.is_closed());
        for line in by_sets(&net) {
            for k in 0..7 {
                let t = (f64::from(k) + 0.37) / 7.0;
                let point = line.ends[0].lerp(line.ends[1], t);
                let Some(faces) = hiding(&net, line.edge, point, eye) else { continue };
                let part = line.parts.iter().rev().find(|part| part.from <= t).unwrap();
                assert_eq!(part.nature, faces, "{name} {t} {line:?}");
                checked += 1;
            }
        }
    }
    assert!(checked > 2_000, "{checked}");
}

#[test]
fn drawings_are_those_of_production() {
    for (name, triangles) in solids() {
        let view = view(DVec3::splat(2.5), ISO, 30.0, false);
        let eye = Eye::of(view.camera());
        let net = net(&triangles, eye);
        let n = ISO.normalize();
        let flat = |p: DVec3| p - n * p.dot(n);
        let length = |[p, q]: [DVec3; 2]| flat(p).distance(flat(q));
        let numbers: f64 = by_numbers(&net).iter().flat_map(|l| l.parts()).map(length).sum();
        let sets: f64 = by_sets(&net).iter().flat_map(|l| l.visible()).map(length).sum();
        // All edges, however short and obtuse, and no others.
        let options = hidden_line::Options {
            classes: ClassSet::default().without(LineClass::Intersection),
            crease: 1e-3,
            tolerance: 0.0,
            ..Default::default()
        };
        let drawing = hidden_line::draw(&soup(&triangles), &view, &options, &mut NoTrace).unwrap();
        let expected = drawing.length(|line| line.is_visible());
        let off = (numbers - expected).abs().max((sets - expected).abs()) / expected;
        assert!(off < 1e-5, "{name}: {numbers} {sets} {expected}");
    }
}

/// Checks a plate in front of the middle of a bar: the bar's edges are hidden once between the plate's borders, by its
/// front.
#[test]
fn a_plate_hides_the_middle_of_a_bar() {
    let mut triangles = cuboid([0.0, 1.0, 0.0], [10.0, 2.0, 1.0]);
    triangles.extend(cuboid([2.0, 0.0, 5.0], [4.0, 3.0, 6.0]));
    let net = net(&triangles, Eye::Along(DVec3::NEG_Z));
    let mut steps = Recorder::default();
    let lines =
        appel::draw(&net, &appel::Options::default(), &Work::default(), &mut steps).unwrap();
    // One ray for each body; everything else is carried along edges.
    let rays = steps.steps().iter().filter(|step| matches!(step, appel::Step::Ray { .. }));
    assert_eq!(rays.count(), 2);
    let front = |line: &&appel::AppelEdge| {
        line.ends.iter().all(|p| p.z == 1.0) && line.ends[0].distance(line.ends[1]) == 10.0
    };
    let long: Vec<_> = lines.iter().filter(front).collect();
    assert_eq!(long.len(), 2);
    for line in long {
        let numbers: Vec<u32> = line.spans.iter().map(|span| span.invisibility).collect();
        assert_eq!(numbers, [0, 1, 0]);
        let mut cuts: Vec<f64> =
            line.spans[1..].iter().map(|s| line.ends[0].lerp(line.ends[1], s.from).x).collect();
        cuts.sort_by(f64::total_cmp);
        assert!((cuts[0] - 2.0).abs().max((cuts[1] - 4.0).abs()) < 1e-4, "{cuts:?}");
    }
    // Twice behind the plate: by the plate and by their own front.
    assert!(lines.iter().flat_map(|line| &line.spans).any(|span| span.invisibility == 2));
}

#[test]
fn open_surfaces_have_natures_but_no_numbers() {
    let square = |x: f64, z: f64| {
        [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)].map(|(u, v)| DVec3::new(x + u, v + x, z))
    };
    // The middle one has the opposite winding.
    let mut faces = [square(0.0, 0.0), square(1.0, 1.0), square(2.0, 2.0)].map(Vec::from);
    faces[1].reverse();
    let net = FaceNet::new(&faces, Eye::Along(DVec3::NEG_Z)).unwrap();
    let refused =
        appel::draw(&net, &appel::Options::default(), &Work::default(), &mut NoTrace).unwrap_err();
    assert!(refused.to_string().contains("closed"), "{refused}");
    let lines = by_sets(&net);
    let seen: f64 = lines.iter().flat_map(|line| line.visible()).map(|[p, q]| p.distance(q)).sum();
    // The lower of the two is covered by the next one in a square of three by three.
    assert!((seen - (16.0 + 10.0 + 10.0)).abs() < 1e-4, "{seen}");
    let both =
        |line: &&natures::GalimbertiEdge| line.parts.iter().any(|part| part.nature == [1, 2]);
    assert_eq!(lines.iter().filter(both).count(), 2);
}

#[test]
fn what_pierces_enters_at_the_face() {
    // A needle through a square plate, seen from above at a slant.
    let mut triangles = cuboid([-3.0, -3.0, -0.1], [3.0, 3.0, 0.1]);
    triangles.extend(cuboid([-0.2, -0.2, -4.0], [0.2, 0.2, 4.0]));
    let net = net(&triangles, Eye::Along(-ISO));
    let mut steps = Recorder::default();
    appel::draw(&net, &appel::Options::default(), &Work::default(), &mut steps).unwrap();
    let pierced = |step: &&appel::Step| {
        matches!(step, appel::Step::Change { cause: appel::Cause::Face(_), .. })
    };
    // Each of the four long edges, at the plate's top; its bottom is a back.
    assert_eq!(steps.steps().iter().filter(pierced).count(), 4);
    // Without the test for piercing, paths around the plate and through it contradict each other, or agree by chance.
    let options = appel::Options { piercing: false };
    let other = appel::draw(&net, &options, &Work::default(), &mut NoTrace);
    assert!(other.is_err() || other.unwrap() != by_numbers(&net));
}

#[test]
fn nets_refuse_what_is_not_before_the_eye() {
    let square = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
    let square = square.map(|(x, y)| DVec3::new(x, y, 0.0)).to_vec();
    let reported = |faces: &[Vec<DVec3>], eye| FaceNet::new(faces, eye).unwrap_err().to_string();
    let eye = Eye::At(DVec3::new(0.5, -0.5, 0.0));
    assert!(
        FaceNet::new(std::slice::from_ref(&square), Eye::At(DVec3::new(0.5, 0.5, 1.0))).is_ok()
    );
    let behind: Vec<DVec3> = square.iter().map(|p| *p - DVec3::Y * 3.0).collect();
    assert!(reported(&[square.clone(), square.clone(), behind], eye).contains("before the eye"));
    let mut bent = square.clone();
    bent[0].z = 0.5;
    assert!(reported(&[bent], Eye::Along(DVec3::NEG_Z)).contains("plane"));
    let line = vec![square[0], square[1], square[0]];
    assert!(reported(&[line], Eye::Along(DVec3::NEG_Z)).contains("area"));
    let mut wrong = square;
    wrong[1].y = f64::INFINITY;
    assert!(FaceNet::new(&[wrong], Eye::Along(DVec3::NEG_Z)).is_err());
    assert_eq!(by_numbers(&FaceNet::new(&[], Eye::Along(DVec3::Z)).unwrap()), []);
}

/// Checks that memory which is charged is given back, that too little of it is an error, and that a stop ends the work.
#[test]
fn lines_are_charged_to_the_work_that_can_be_stopped() {
    let net = net(&step(), Eye::Along(-ISO));
    type Draw = fn(&FaceNet, &Work) -> Result<usize, Error>;
    let draws: [Draw; 2] = [
        |net, work| Ok(appel::draw(net, &Default::default(), work, &mut NoTrace)?.len()),
        |net, work| Ok(natures::draw(net, &Default::default(), work, &mut NoTrace)?.len()),
    ];
    for draw in draws {
        let work = Work::with_budget(1 << 20, "the budget");
        assert_eq!(draw(&net, &work), draw(&net, &Work::default()));
        assert_eq!(work.used(), 0);
        let stage = |bytes: u64| match draw(&net, &Work::with_budget(bytes, "the budget")) {
            Err(Error::Memory { stage, .. }) => stage,
            _ => "none",
        };
        assert_eq!(stage(300), "corners of faces");
        let of_lines = stage(1000);
        assert!(["invisibility of edges", "natures of edges"].contains(&of_lines), "{of_lines}");
        let stopped = Work::stoppable();
        stopped.stop(Error::Cancelled);
        assert_eq!(draw(&net, &stopped), Err(Error::Cancelled));
    }
}
