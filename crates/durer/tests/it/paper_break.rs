//! Broken views: parts left out, parts moved, and dimensions that still state the true length.

use durer::math::{DVec2, DVec3};
use durer::paper::{Break, Breaks, ViewBreaks};
use durer::scene::{Aabb, Camera, Projection};
use durer::target::drawing::{Drawing, Line, LineClass, Region, RegionKind, TextLabel};

fn camera(to_eye: DVec3, up: DVec3) -> Camera {
    let projection = Projection::Orthographic { height: 100.0 };
    Camera { eye: to_eye * 500.0, target: DVec3::ZERO, up, projection, near: 1.0, far: 1000.0 }
}

fn front() -> Camera {
    camera(-DVec3::Y, DVec3::Z)
}

/// From 0 to 300 along x, 20 thick.
const BOUNDS: Aabb =
    Aabb { min: DVec3::new(0.0, -10.0, -10.0), max: DVec3::new(300.0, 10.0, 10.0) };

fn breaks(texts: &[&str], camera: &Camera) -> durer::Result<ViewBreaks> {
    let all: Vec<Break> = texts.iter().map(|t| t.parse()).collect::<Result<_, _>>()?;
    Ok(Breaks::new(&all, BOUNDS, &[*camera])?.seen_by(camera))
}

/// Returns the closed outline, a line along the axis and a region, with a label at each end and in the middle.
fn bar() -> Drawing {
    let p = DVec2::new;
    let ring = vec![p(0.0, -10.0), p(300.0, -10.0), p(300.0, 10.0), p(0.0, 10.0)];
    let line = |points, closed| Line { class: LineClass::Crease, invisibility: 0, points, closed };
    let label = |x: f64| TextLabel {
        at: p(x, 0.0),
        text: format!("{x}"),
        height: 3.0,
        anchor: Default::default(),
    };
    let region = Region {
        kind: RegionKind::Surface,
        rings: vec![ring.clone()],
        color: [9; 4],
        item: None,
        part: None,
    };
    Drawing {
        regions: vec![region],
        lines: vec![line(ring, true), line(vec![p(10.0, 5.0), p(290.0, 5.0)], false)],
        labels: [5.0, 150.0, 295.0].map(label).to_vec(),
        nearness: vec![Some(1), None],
        ..Drawing::default()
    }
}

#[test]
fn what_lies_between_is_left_out_and_the_rest_moved() {
    let cut = breaks(&["x:50,250"], &front()).unwrap().cut(bar()).unwrap();
    let bounds = cut.bounds().unwrap();
    assert!(bounds.min().x == 0.0 && (bounds.max().x - 102.5).abs() < 1e-12, "{bounds:?}");
    // 50 at each end, as the zigzags swing equally to both sides: the line at 5, beside them, keeps its length.
    let area: f64 = cut.regions.iter().map(Region::area).sum();
    assert!((area - 2000.0).abs() < 1e-9, "{area}");
    assert_eq!(cut.regions.len(), 2);
    let of = |class| cut.lines.iter().filter(move |l| l.class == class);
    assert_eq!((of(LineClass::Crease).count(), of(LineClass::Break).count()), (4, 2));
    let straight: Vec<_> = of(LineClass::Crease).filter(|l| l.points.len() == 2).collect();
    for (line, ends) in straight.iter().zip([[10.0, 50.0], [52.5, 92.5]]) {
        let ends = ends.map(|x| DVec2::new(x, 5.0));
        assert!(line.points.iter().zip(ends).all(|(p, q)| p.distance(q) < 1e-12), "{line:?}");
    }
    // The outline is open at the break, and begins and ends there.
    let outline: Vec<_> = of(LineClass::Crease).filter(|l| l.points.len() == 4).collect();
    assert_eq!(outline.len(), 2);
    assert!(outline.iter().all(|l| !l.closed));
    let begins = outline[0].points[0];
    assert!(begins.distance(DVec2::new(50.0, 10.0)) < 1e-12, "{begins}");
    assert_eq!(cut.nearness, [Some(1), None, None, Some(1), None, None]);
    let labels: Vec<&str> = cut.labels.iter().map(|l| &l.text[..]).collect();
    assert_eq!(labels, ["5", "295"]);
    assert!((cut.labels[1].at.x - 97.5).abs() < 1e-12);
    // Break lines extend beyond the lines that they cut.
    let reach = of(LineClass::Break).map(|l| l.points.iter().map(|p| p.y).fold(0.0, f64::max));
    let reach: Vec<f64> = reach.collect();
    assert!(reach.iter().all(|y| (y - 11.5).abs() < 1e-12), "{reach:?}");
}

#[test]
fn lines_and_areas_end_on_the_zigzag() {
    let mut drawing = bar();
    drawing.lines[1].points = vec![DVec2::new(10.0, 0.5), DVec2::new(290.0, 0.5)];
    let cut = breaks(&["x:50,250"], &front()).unwrap().cut(drawing).unwrap();
    let zigzag = cut.lines.iter().find(|l| l.class == LineClass::Break).unwrap();
    // The line between the two bends.
    let (a, b) = (zigzag.points[2], zigzag.points[3]);
    let on_it = a.lerp(b, (0.5 - a.y) / (b.y - a.y));
    let end = cut.lines.iter().find(|l| l.points.len() == 2).unwrap().points[1];
    assert!(end.distance(on_it) < 1e-9 && (end.x - 50.0).abs() > 0.1, "{end} {on_it}");
    let corners = cut.regions[0].rings.iter().flatten();
    assert!(corners.clone().any(|p| p.distance(a) < 1e-9), "{:?}", cut.regions[0]);
}

#[test]
fn several_breaks_and_both_axes_of_a_view() {
    let all = breaks(&["x:200,260", "x:40,100", "z:-5,5"], &front()).unwrap();
    let gap = 180.0 * 0.025;
    let p = DVec2::new;
    for (seen, drawn) in [
        (p(20.0, -8.0), p(20.0, -8.0)),
        (p(150.0, 8.0), p(150.0 - 60.0 + gap, 8.0 - 10.0 + gap)),
        (p(300.0, -8.0), p(300.0 - 120.0 + 2.0 * gap, -8.0)),
        (p(70.0, 0.0), p(40.0 + gap / 2.0, -5.0 + gap / 2.0)),
    ] {
        assert!(all.drawn_at(seen).distance(drawn) < 1e-9, "{seen}: {}", all.drawn_at(seen));
        assert!(all.seen_at(drawn).distance(seen) < 1e-9, "{drawn}: {}", all.seen_at(drawn));
    }
    let cut = all.cut(bar()).unwrap();
    let edges = cut.lines.iter().filter(|l| l.class == LineClass::Crease);
    let right = edges.flat_map(|l| &l.points).map(|p| p.x).fold(0.0, f64::max);
    assert!((right - (180.0 + 2.0 * gap)).abs() < 1e-9, "{right}");
    let area: f64 = cut.regions.iter().map(Region::area).sum();
    assert!((area - 1800.0).abs() < 1e-9, "{area}");
}

#[test]
fn views_from_elsewhere_show_all() {
    let along = camera(DVec3::X, DVec3::Z);
    let oblique = camera(DVec3::new(0.6, -0.8, 0.0), DVec3::Z);
    let lens = Projection::Perspective { fov_y: 0.5 };
    let perspective = Camera { projection: lens, ..front() };
    for view in [along, oblique, perspective] {
        assert!(breaks(&["x:50,250"], &view).unwrap().is_empty());
    }
    // Seen from behind, the axis has the opposite direction.
    let back = camera(DVec3::Y, DVec3::Z);
    let breaks = breaks(&["x:50,250"], &back).unwrap();
    assert_eq!(breaks.drawn_at(DVec2::new(-20.0, 1.0)), DVec2::new(-20.0, 1.0));
    assert_eq!(breaks.drawn_at(DVec2::new(-300.0, 1.0)), DVec2::new(-102.5, 1.0));
}

#[test]
fn breaks_that_make_no_sense_are_refused() {
    for text in ["x", "w:1,2", "x:1", "x:2,1", "x:1,1", "x:1,nan", "x:1,2,3"] {
        assert!(text.parse::<Break>().is_err(), "{text}");
    }
    for (all, part) in [
        (&["x:-5,100"][..], "between 0 and 300"),
        (&["x:50,300"], "inside the model"),
        (&["x:50,51"], "takes"),
        (&["x:50,150", "x:140,200"], "apart"),
        (&["x:50,150", "x:152,200"], "apart"),
    ] {
        let error = breaks(all, &front()).unwrap_err().to_string();
        assert!(error.contains(part), "{error}");
    }
}
