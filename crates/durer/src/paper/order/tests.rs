use super::*;
use crate::target::drawing::TextAnchor;
use crate::target::sheet::{Pen, SheetLayer};

fn points(list: &[(f64, f64)]) -> Vec<DVec2> {
    list.iter().map(|&(x, y)| DVec2::new(x, y)).collect()
}

fn open(list: &[(f64, f64)]) -> PenStroke {
    PenStroke { points: points(list), closed: false }
}

fn ring(list: &[(f64, f64)]) -> PenStroke {
    PenStroke { points: points(list), closed: true }
}

/// Returns random numbers from 0 to 1 (Knuth's linear congruences).
fn random() -> impl FnMut() -> f64 {
    let mut state = 1_u64;
    move || {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f64 / (1_u64 << 24) as f64
    }
}

/// Creates short strokes, every fifth of them a square, all over a sheet of 100 × 100.
pub fn scattered(count: usize) -> Vec<PenStroke> {
    let mut random = random();
    let mut stroke = |i: usize| {
        let at = DVec2::new(random(), random()) * 100.0;
        let side = DVec2::new(random() - 0.5, random() - 0.5);
        if i.is_multiple_of(5) {
            let corners = [at, at + side, at + side + side.perp(), at + side.perp()];
            return PenStroke { points: corners.to_vec(), closed: true };
        }
        PenStroke { points: vec![at, at + side], closed: false }
    };
    (0..count).map(&mut stroke).collect()
}

/// Orders strokes and joins them, all of straight lines.
fn ordered(strokes: Vec<PenStroke>, start: DVec2) -> Vec<PenStroke> {
    let chains = strokes.into_iter().map(Chain::Straight).collect();
    let stroke = |chain| match chain {
        Chain::Straight(stroke) => stroke,
        Chain::Curved(curve) => {
            let ends = curve.pieces.iter().map(|piece| piece.end());
            let points = std::iter::once(curve.start).chain(ends).collect();
            PenStroke { points, closed: curve.closed }
        }
    };
    ordered_chains(chains, start).into_iter().map(stroke).collect()
}

/// Returns the length of pen-up moves between strokes in drawing order.
fn way(strokes: &[PenStroke], turns: &[OrderedStroke], start: DVec2) -> f64 {
    let mut at = start;
    let mut step = |turn: &OrderedStroke| {
        let stroke = strokes[turn.index].clone().begun_at(turn.first);
        let length = at.distance(stroke.points[0]);
        at = stroke.end().expect("points");
        length
    };
    turns.iter().map(&mut step).sum()
}

#[test]
fn every_stroke_is_drawn_once_and_the_way_is_much_shorter_than_the_greedy_one() {
    let strokes = scattered(2000);
    let start = DVec2::ZERO;
    let found = turns(&strokes, start);
    let mut drawn: Vec<usize> = found.iter().map(|t| t.index).collect();
    drawn.sort_unstable();
    assert!(drawn.into_iter().eq(0..2000));
    for turn in &found {
        let PenStroke { points, closed } = &strokes[turn.index];
        assert!(*closed || [0, points.len() - 1].contains(&turn.first), "{turn:?}");
    }
    let greedy = way(&strokes, &greedy::turns(&strokes, start), start);
    let short = way(&strokes, &found, start);
    assert!(short < 0.82 * greedy, "{short} {greedy}");
    assert_eq!(turns(&strokes, start), found);
}

#[test]
fn strokes_in_a_row_are_drawn_in_a_row_whichever_way_they_run() {
    let count = 200;
    let at = |i: usize| (i as f64, 0.0);
    // 0, 99, 198, 97, …: shuffled, and every other one reversed.
    let shuffled = (0..count).map(|i| (i * 99) % count);
    let ends = shuffled.map(|i| if i % 2 == 0 { [at(i), at(i + 1)] } else { [at(i + 1), at(i)] });
    let strokes: Vec<PenStroke> = ends.map(|e| open(&e)).collect();
    let one = ordered(strokes, DVec2::new(-3.0, 0.0));
    let all: Vec<(f64, f64)> = (0..=count).map(at).collect();
    assert_eq!(one, [open(&all)]);
}

#[test]
fn closed_strokes_are_begun_where_they_are_passed() {
    let square = [(10.0, 10.0), (10.0, -10.0), (30.0, -10.0), (30.0, 10.0), (20.0, 0.5)];
    let strokes =
        [open(&[(40.0, 0.0), (21.0, 0.0)]), ring(&square), open(&[(0.0, 0.0), (19.0, 0.0)])];
    let found = ordered(strokes.to_vec(), DVec2::ZERO);
    assert_eq!(found[0], strokes[2]);
    assert_eq!(found[1].points[0], DVec2::new(20.0, 0.5));
    assert_eq!((found[1].points.len(), found[1].closed), (5, true));
    assert_eq!(found[2], open(&[(21.0, 0.0), (40.0, 0.0)]));
}

#[test]
fn what_has_no_sense_is_no_trouble() {
    let start = DVec2::ZERO;
    assert_eq!(turns(&[], start), []);
    assert_eq!(
        turns(&[PenStroke::default(), open(&[(1.0, 1.0)])], start),
        [OrderedStroke { index: 1, first: 0 }]
    );
    let far = f64::MAX;
    let strokes = [
        open(&[(f64::NAN, 1.0), (2.0, f64::INFINITY)]),
        open(&[(far, -far), (-far, far)]),
        ring(&[(f64::NAN, 0.0), (5.0, 5.0), (f64::NEG_INFINITY, 1.0)]),
        open(&[(3.0, 3.0), (3.0, 3.0)]),
    ];
    for start in [start, DVec2::NAN] {
        assert_eq!(turns(&strokes, start).len(), 4);
    }
    // All in one place.
    let same: Vec<PenStroke> = (0..5000).map(|_| open(&[(1.0, 1.0), (1.0, 1.0)])).collect();
    assert_eq!(ordered(same, start).len(), 1);
}

#[test]
fn sheets_keep_layers_texts_dashes_and_what_covers_what() {
    let pen = |dashes| Pen { width: 0.5, color: [0, 0, 0, 255], dashes };
    let stroke =
        |list: &[(f64, f64)], pen| PaperMark::Stroke { points: points(list), closed: false, pen };
    let text = |x: f64| {
        let (at, text, anchor) = (DVec2::new(x, 5.0), x.to_string(), TextAnchor::Start);
        PaperMark::Text { at, text, height: 2.0, anchor, pen: 0 }
    };
    let fill = PaperMark::Fill {
        rings: vec![points(&[(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)])],
        color: [9; 4],
        even_odd: false,
    };
    let lines = [[(30.0, 0.0), (20.0, 0.0)], [(0.0, 0.0), (10.0, 0.0)], [(20.0, 0.0), (10.0, 0.0)]];
    let of = |pen: usize| lines.iter().map(move |l| stroke(l, pen));
    let mixed = of(0).zip(of(1)).flat_map(|(a, b)| [a, b]).chain([text(9.0), text(28.0)]).collect();
    let covered: Vec<PaperMark> = of(0).chain([fill]).chain(of(1)).collect();
    let layer = |marks: Vec<PaperMark>| SheetLayer { name: "layer".to_owned(), marks };
    let mut found = Sheet {
        pens: vec![pen(Vec::new()), pen(vec![3.0, 1.0])],
        layers: vec![layer(covered.clone()), layer(mixed)],
        ..Sheet::default()
    };
    sheet(&mut found);
    assert_eq!(found.layers[0].marks, covered);
    let expected = [
        stroke(&[(0.0, 0.0), (10.0, 0.0), (20.0, 0.0), (30.0, 0.0)], 0),
        text(28.0),
        text(9.0),
        stroke(&[(0.0, 0.0), (10.0, 0.0)], 1),
        stroke(&[(10.0, 0.0), (20.0, 0.0)], 1),
        stroke(&[(20.0, 0.0), (30.0, 0.0)], 1),
    ];
    assert_eq!(found.layers[1].marks, expected);
}
