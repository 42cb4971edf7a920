//! Simulated machines: G-code read back as a machine would, and the pens of HPGL.

use durer::curve::pieces;
use durer::math::DVec2;
use durer::target::drawing::TextAnchor;
use durer::target::sheet::{PaperMark, Pen, Sheet, SheetLayer};
use durer::target::{Curve, CurvePiece, EllipticArc};
use durer_formats::drawing::{MachineOptions, write_gcode, write_hpgl};

fn points(list: &[(f64, f64)]) -> Vec<DVec2> {
    list.iter().map(|&(x, y)| DVec2::new(x, y)).collect()
}

fn stroke(list: &[(f64, f64)], closed: bool, pen: usize) -> PaperMark {
    PaperMark::Stroke { points: points(list), closed, pen }
}

/// Returns a sheet of 100 × 80 with three pens; the dashed one is as wide and dark as the first.
fn sheet() -> Sheet {
    let pen = |width, color, dashes| Pen { width, color, dashes };
    let layer = |name: &str, marks| SheetLayer { name: name.to_owned(), marks };
    let square = [(10.0, 10.0), (30.0, 10.0), (30.0, 30.0), (10.0, 30.0)];
    let text = PaperMark::Text {
        at: DVec2::new(50.0, 40.0),
        text: "A".to_owned(),
        height: 5.0,
        anchor: TextAnchor::Start,
        pen: 1,
    };
    Sheet {
        title: "Näher! ~1; ?".to_owned(),
        size: DVec2::new(100.0, 80.0),
        background: None,
        pens: vec![
            pen(0.5, [0, 0, 0, 255], Vec::new()),
            pen(0.25, [255, 0, 0, 255], Vec::new()),
            pen(0.5, [0, 0, 0, 255], vec![3.0, 1.0]),
        ],
        layers: vec![
            layer("dashed", vec![stroke(&[(0.0, 70.0), (11.0, 70.0)], false, 2)]),
            layer("thin", vec![stroke(&[(40.0, 5.0), (50.0, 5.0), (50.0, 9.0)], false, 1)]),
            layer("thick", vec![stroke(&square, true, 0), stroke(&[(90.0, 70.0); 2], false, 0)]),
            layer("text", vec![text]),
        ],
    }
}

fn gcode(sheet: &Sheet, machine: &MachineOptions) -> String {
    let mut bytes = Vec::new();
    write_gcode(&mut bytes, sheet, machine).expect("written");
    String::from_utf8(bytes).expect("text")
}

/// Returns the drawing of a machine with a servo on its spindle: chains by pen, split by `M0`. Panics at unknown words.
fn replay(text: &str) -> Vec<Vec<Vec<DVec2>>> {
    let (mut at, mut down, mut ended) = (DVec2::ZERO, false, false);
    let mut pens: Vec<Vec<Vec<DVec2>>> = vec![Vec::new()];
    let mut modes = Vec::new();
    for line in text.lines() {
        let code = line.split(';').next().unwrap_or_default().trim();
        let words: Vec<(char, f64)> = code
            .split_whitespace()
            .map(|w| (w.chars().next().expect("a letter"), w[1..].parse().expect("a number")))
            .collect();
        let Some(&(letter, number)) = words.first() else { continue };
        assert!(!ended, "{line}");
        match (letter, number as u32) {
            ('G', 0 | 1) => {
                assert_eq!(modes, [21, 90], "the units are messages first");
                for &(letter, value) in &words[1..] {
                    match letter {
                        'X' => at.x = value,
                        'Y' => at.y = value,
                        'F' => assert!(value > 0.0),
                        other => panic!("{other} in {line}"),
                    }
                }
                match pens.last_mut().and_then(|p| p.last_mut()) {
                    Some(chain) if down => chain.push(at),
                    _ => assert!(!down, "{line}"),
                }
                assert!(!down || number == 1.0, "{line} with the pen down");
            }
            ('G', 2 | 3) => {
                assert!(down, "{line} in the air");
                let word = |name| words.iter().find(|w| w.0 == name).map(|w| w.1);
                let [to, off] = [['X', 'Y'], ['I', 'J']].map(|names| {
                    DVec2::from_array(
                        names.map(|n| word(n).unwrap_or_else(|| panic!("{n} in {line}"))),
                    )
                });
                let chain = pens.last_mut().and_then(|p| p.last_mut()).expect("a chain");
                chain.extend(arc(at, to, at + off, number == 3.0));
                at = to;
            }
            ('G', 21 | 90) => modes.push(number as u32),
            ('G', 4) => {}
            ('M', 3) => {
                down = true;
                pens.last_mut().expect("a pen").push(vec![at]);
            }
            ('M', 5) => down = false,
            ('M', 0) => {
                assert!(!down && at == DVec2::ZERO, "pens are changed at home");
                pens.push(Vec::new());
            }
            ('M', 2) => ended = true,
            _ => panic!("{line}"),
        }
    }
    assert!(ended && !down && at == DVec2::ZERO);
    pens
}

/// Returns points on an arc, at most a degree apart, its end last. Machines refuse arcs whose ends differ in distance
/// from the centre.
fn arc(from: DVec2, to: DVec2, middle: DVec2, is_left: bool) -> Vec<DVec2> {
    let (a, b) = (from - middle, to - middle);
    assert!((a.length() - b.length()).abs() < 0.002, "{from} {to} around {middle}");
    let turn =
        if is_left { a.angle_to(b) } else { b.angle_to(a) }.rem_euclid(std::f64::consts::TAU);
    let count = turn.to_degrees().ceil().max(1.0);
    let sign = if is_left { 1.0 } else { -1.0 };
    let at = |i: u32| middle + DVec2::from_angle(sign * turn * f64::from(i) / count).rotate(a);
    (1..count as u32).map(at).chain([to]).collect()
}

/// Returns straight segments regardless of direction, in micrometres, sorted.
fn pieces(chains: &[Vec<DVec2>]) -> Vec<[[i64; 2]; 2]> {
    let place = |p: DVec2| [p.x, p.y].map(|v| (v * 1000.0).round() as i64);
    let piece = |w: &[DVec2]| {
        let mut ends = [place(w[0]), place(w[1])];
        ends.sort_unstable();
        ends
    };
    let mut all: Vec<_> = chains.iter().flat_map(|c| c.windows(2).map(piece)).collect();
    all.sort_unstable();
    all
}

#[test]
fn gcode_read_back_is_the_sheet_pen_by_pen() {
    let pens = replay(&gcode(&sheet(), &MachineOptions::default()));
    let [black, red] = &pens[..] else { panic!("{} pens", pens.len()) };
    // Three dashes, the square and the dot; y is up.
    assert_eq!(black.len(), 5);
    let square = points(&[(10.0, 70.0), (30.0, 70.0), (30.0, 50.0), (10.0, 50.0), (10.0, 70.0)]);
    let dashes = [(0.0, 3.0), (4.0, 7.0), (8.0, 11.0)];
    let dashes = dashes.map(|(from, to)| points(&[(from, 10.0), (to, 10.0)]));
    let expected = [&dashes[..], &[square]].concat();
    assert_eq!(pieces(black), pieces(&expected));
    assert!(black.contains(&points(&[(90.0, 10.0)])), "a dot is put down: {black:?}");
    let thin = points(&[(40.0, 75.0), (50.0, 75.0), (50.0, 71.0)]);
    let letter = durer::paper::text_strokes(DVec2::new(50.0, 40.0), "A", 5.0, TextAnchor::Start);
    let up = |chain: Vec<DVec2>| chain.into_iter().map(|p| DVec2::new(p.x, 80.0 - p.y)).collect();
    let expected: Vec<Vec<DVec2>> = letter.into_iter().map(up).chain([thin]).collect();
    assert_eq!(pieces(red), pieces(&expected));
}

#[test]
fn gcode_says_what_it_draws_in_words_that_no_machine_obeys() {
    let text = gcode(&sheet(), &MachineOptions::default());
    let comments: Vec<&str> = text.lines().filter(|l| l.starts_with(';')).collect();
    let expected = [
        "; N_her_ _1; _",
        "; sheet 100 x 80 mm, pens: 2",
        "; pen 1: .5 mm, #000000",
        "; layer dashed",
        "; layer thick",
        "; pen 2: .25 mm, #ff0000",
        "; layer thin",
        "; layer text",
    ];
    assert_eq!(comments, expected);
    assert!(text.chars().all(|c| c == '\n' || matches!(c, ' '..='}') && c != '!' && c != '?'));
    assert!(
        text.contains("G0 X40 Y75\nM3 S1000\nG4 P0.2\nG1 X50 Y75 F1500\nG1 X50 Y71\nM5\n"),
        "{text}"
    );
}

#[test]
fn gcode_takes_the_machines_own_commands_and_speeds() {
    let machine = MachineOptions {
        arcs: true,
        pens: Some(1),
        feed: 900.0,
        travel: Some(4000.0),
        pen_down: "G1 Z0 F300".to_owned(),
        pen_up: "G0 Z5".to_owned(),
    };
    let text = gcode(&sheet(), &machine);
    let part = "G1 X50 Y71 F4000\nG1 Z0 F300\nG1 X50 Y75 F900\nG1 X40 Y75\nG0 Z5\n";
    assert!(text.contains(part), "{text}");
    assert!(!text.contains("M0\n") && !text.contains("G0 X"), "one pen is never changed: {text}");
    for wrong in [
        MachineOptions { feed: 0.0, ..machine.clone() },
        MachineOptions { travel: Some(f64::NAN), ..machine.clone() },
        MachineOptions { pens: Some(0), ..machine.clone() },
        MachineOptions { pen_up: "M5 ; ok?".to_owned(), ..machine.clone() },
    ] {
        assert!(write_gcode(&mut Vec::new(), &sheet(), &wrong).is_err(), "{wrong:?}");
    }
}

#[test]
fn hpgl_has_a_pen_for_each_width_and_colour_and_takes_it_once() {
    let mut bytes = Vec::new();
    write_hpgl(&mut bytes, &sheet()).expect("written");
    let text = String::from_utf8(bytes).expect("text");
    let pens: Vec<&str> = text.lines().filter(|l| l.starts_with("SP")).collect();
    assert_eq!(pens, ["SP1;PW.5,1;", "SP2;PW.25,2;", "SP0;"]);
}

/// Returns a circle, an arc of nearly a full turn, an ellipse, and a line that continues in a cubic curve; y down.
fn curves() -> Vec<Curve> {
    let p = DVec2::new;
    let arc = |center, axis, ratio, start, turn| EllipticArc { center, axis, ratio, start, turn };
    let alone = |arc: EllipticArc, closed| {
        let (start, end) = (arc.at(arc.start), arc.at(arc.start + arc.turn));
        let end = if closed { start } else { end };
        Curve { start, pieces: vec![CurvePiece::Arc(arc, end)], closed }
    };
    let whole = std::f64::consts::TAU;
    let cubic = CurvePiece::Cubic(p(70.0, 60.0), p(90.0, 30.0), p(95.0, 75.0));
    vec![
        alone(arc(p(20.0, 20.0), p(12.345_67, 0.0), 1.0, 0.3, whole), true),
        alone(arc(p(50.0, 20.0), p(0.0, 8.1), 1.0, 1.0, -6.2), false),
        alone(arc(p(30.0, 55.0), p(20.0, 7.0), 0.4, 0.0, whole), true),
        Curve {
            start: p(60.0, 70.0),
            pieces: vec![CurvePiece::Line(p(65.0, 66.0)), cubic],
            closed: false,
        },
    ]
}

#[test]
fn gcode_draws_curves_with_arcs() {
    let mut sheet = sheet();
    sheet.layers.truncate(1);
    sheet.layers[0].marks =
        curves().into_iter().map(|curve| PaperMark::Curve { curve, pen: 0 }).collect();
    let distance = |p: DVec2, chain: &[DVec2]| {
        let off = |w: &[DVec2]| {
            let t = ((p - w[0]).dot(w[1] - w[0]) / (w[1] - w[0]).length_squared()).clamp(0.0, 1.0);
            p.distance(w[0].lerp(w[1], t))
        };
        chain.windows(2).map(off).fold(f64::INFINITY, f64::min)
    };
    let up = |p: DVec2| DVec2::new(p.x, 80.0 - p.y);
    for arcs in [true, false] {
        let machine = MachineOptions { arcs, ..MachineOptions::default() };
        let text = gcode(&sheet, &machine);
        assert_eq!(text.contains("G3 ") && text.contains("G2 "), arcs);
        let lines = text.lines().filter(|l| l.starts_with('G')).count();
        assert!(if arcs { lines < 100 } else { lines > 150 }, "{lines}");
        let drawn = &replay(&text)[0];
        assert_eq!(drawn.len(), 4);
        let all: Vec<Vec<DVec2>> = curves()
            .iter()
            .map(|c| {
                let again = c.closed.then_some(c.start);
                pieces::points(c, 1e-4).into_iter().chain(again).map(up).collect()
            })
            .collect();
        for chain in drawn {
            // Each chain is one of the curves, from end to end.
            let far = |exact: &Vec<DVec2>| {
                let there = chain.iter().map(|p| distance(*p, exact)).fold(0.0, f64::max);
                let back = exact.iter().map(|p| distance(*p, chain)).fold(0.0, f64::max);
                there.max(back)
            };
            let nearest = all.iter().map(far).fold(f64::INFINITY, f64::min);
            assert!(nearest < 0.012, "{nearest} with arcs: {arcs}");
        }
    }
}
