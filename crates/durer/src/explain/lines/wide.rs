//! The lesson of outlines of strokes.

use crate::curve::Path;
use crate::explain::frame::{Frames, Numbered, Shown, Want, record};
use crate::explain::grid::log;
use crate::explain::input::{Figure, Input};
use crate::explain::lesson::{Example, Lesson};
use crate::explain::picture::{Look, Picture};
use crate::explain::words::{Caption, Template, Value, Word};
use crate::math::DVec2;
use crate::raster::line::wide::{Cap, INFO, Join, Step, Stroke, StrokePart, outline};
use crate::trace::PseudocodeLine;
use crate::{Error, Result};

pub(super) const LESSON: Lesson = Lesson {
    name: INFO.name,
    info: &INFO,
    takes: TAKES,
    examples: EXAMPLES,
    templates: &[&RING, &SIDE, &PIVOT, &JOIN, &CAP],
    unreached: &[],
    make: |_, input, _, cap| make(input, cap),
};

const TAKES: Word = Word::new(
    "lines: the first has miter joins and butt ends, the second round ones, the third bevels and square ends",
    "Linien: die erste mit spitzen Ecken und stumpfen Enden, die zweite rund, die dritte abgekantet mit eckigen Enden",
);

const EXAMPLES: &[Example] = &[
    Example {
        name: "joins",
        title: Word::new(
            "miter, round and bevel at one corner",
            "spitz, rund und abgekantet an einer Ecke",
        ),
        input: || {
            let peak = |x: f64| vec![(x, 0.0), (x + 2.0, 4.0), (x + 4.0, 0.0)];
            lines(&[peak(0.0), peak(6.5), peak(13.0)])
        },
    },
    Example {
        name: "short-pieces",
        title: Word::new(
            "pieces shorter than the width: through the corner",
            "Stücke kürzer als die Breite: durch die Ecke",
        ),
        input: || lines(&[vec![(0.0, 0.0), (8.0, 0.0), (8.8, 1.0), (8.2, 2.0), (0.0, 2.4)]]),
    },
    Example {
        name: "sharp",
        title: Word::new(
            "beyond the miter limit a corner is cut off",
            "jenseits der Gehrungsgrenze wird eine Ecke gekappt",
        ),
        input: || lines(&[vec![(0.0, 0.0), (9.0, 1.0), (0.0, 2.0)]]),
    },
    Example::new(
        "straight",
        "the three ends: butt, round, square",
        "die drei Enden: stumpf, rund, eckig",
        || {
            lines(&[
                vec![(0.0, 0.0), (6.0, 0.0)],
                vec![(0.0, 3.0), (6.0, 3.0)],
                vec![(0.0, 6.0), (6.0, 6.0)],
            ])
        },
    ),
    Example::new(
        "right-angles",
        "right angles to both sides",
        "rechte Winkel nach beiden Seiten",
        || lines(&[vec![(0.0, 0.0), (5.0, 0.0), (5.0, 4.0), (10.0, 4.0)]]),
    ),
    Example::new(
        "nearly-straight",
        "a corner that is hardly one",
        "eine Ecke, die kaum eine ist",
        || lines(&[vec![(0.0, 0.0), (6.0, 0.2), (12.0, 0.0)]]),
    ),
];

fn lines(all: &[Vec<(f64, f64)>]) -> Input {
    let line = |line: &Vec<(f64, f64)>| line.iter().copied().map(DVec2::from).collect();
    Input::Figure(Figure { lines: all.iter().map(line).collect(), ..Figure::default() })
}

static RING: Template = Template::new(
    "ring",
    "A ring of the outline begins: {join}, {cap}, width {width}.",
    "Ein Ring des Umrisses beginnt: {join}, {cap}, Breite {width}.",
);
static SIDE: Template = Template::new(
    "point",
    "Side at {vertex}: the offset lines lead to {point}.",
    "Seite bei {vertex}: Die versetzten Geraden führen nach {point}.",
);
static PIVOT: Template = Template::new(
    "point",
    "Inner side: a piece is too short for its offset lines to meet, so the outline goes through {vertex} itself.",
    "Innenseite: Ein Stück ist zu kurz, als dass die versetzten Geraden sich träfen; der Umriss geht durch {vertex} selbst.",
);
static JOIN: Template = Template::new(
    "point",
    "Outer side of the corner {vertex}, {join}: {point}, {distance} from it.",
    "Außenseite der Ecke {vertex}, {join}: {point}, {distance} davon entfernt.",
);
static CAP: Template =
    Template::new("point", "End {vertex}, {cap}: {point}.", "Ende {vertex}, {cap}: {point}.");

/// Part of the picture's longer side that strokes of one line are wide.
const WIDTH: f64 = 0.25;

/// Line by line: what is at corners and at ends.
const LOOKS: [(Join, Cap); 3] =
    [(Join::Miter, Cap::Butt), (Join::Round, Cap::Round), (Join::Bevel, Cap::Square)];

fn join_name(join: Join) -> Word {
    match join {
        Join::Miter => Word::new("miter joins", "spitze Ecken"),
        Join::Round => Word::new("round joins", "runde Ecken"),
        Join::Bevel => Word::new("bevel joins", "abgekantete Ecken"),
    }
}

fn cap_name(cap: Cap) -> Word {
    match cap {
        Cap::Butt => Word::new("butt caps", "stumpfe Enden"),
        Cap::Round => Word::new("round caps", "runde Enden"),
        Cap::Square => Word::new("square caps", "eckige Enden"),
    }
}

/// The lines, and their outlines so far.
#[derive(Clone)]
struct State {
    lines: Vec<Vec<DVec2>>,
    width: f64,
    rings: Vec<Vec<(DVec2, StrokePart)>>,
    rows: Vec<[Value; 3]>,
}

fn make(input: &Input, cap: usize) -> Result<Frames> {
    let given = &input.figure(TAKES)?.lines;
    let lines: Vec<Vec<DVec2>> = given.iter().filter(|line| line.len() > 1).cloned().collect();
    if lines.is_empty() {
        return Err(Error::parameter("input", "without a line", TAKES.en));
    }
    // As wide as suits the longest of them.
    let longest = |line: &Vec<DVec2>| {
        let [low, high] = Picture::around(line.iter().copied(), 0.0).extent;
        (high - low).max_element()
    };
    let width = lines.iter().map(longest).fold(0.0, f64::max) * WIDTH;
    let steps = record(cap, |t| {
        for (number, line) in lines.iter().enumerate() {
            let (join, cap) = LOOKS[number % LOOKS.len()];
            let stroke = Stroke { width, join, cap, ..Stroke::default() };
            let mut numbered = Numbered { number, t: &mut *t };
            outline(&Path::polyline(line.iter().copied()), &stroke, width / 40.0, &mut numbered)?;
        }
        Ok(())
    })?;
    let mut state = State { lines, width, rings: Vec::new(), rows: Vec::new() };
    Ok(Frames::new(steps, move |(number, step), want| state.show(*number, step, want)))
}

impl State {
    fn show(&mut self, number: usize, step: &Step, want: Want) -> Shown {
        let caption = self.take(number, step);
        let heads = [
            Word::new("point", "Punkt"),
            Word::new("vertex", "Ecke"),
            Word::new("part", "Teil"),
            Word::new("at", "bei"),
        ];
        want.shown(step.line(), caption, || log(heads, &self.rows), || self.picture())
    }

    fn take(&mut self, number: usize, step: &Step) -> Caption {
        let (join, cap) = LOOKS[number % LOOKS.len()];
        let (join, cap) = (("join", join_name(join).into()), ("cap", cap_name(cap).into()));
        match *step {
            Step::Ring => {
                self.rings.push(Vec::new());
                self.rows.clear();
                RING.with([join, cap, ("width", self.width.into())])
            }
            Step::Point { vertex, point, part } => {
                self.rings.last_mut().into_iter().for_each(|ring| ring.push((point, part)));
                self.rows.push([vertex.into(), part_name(part).into(), point.into()]);
                let distance = ("distance", vertex.distance(point).into());
                let (vertex, point) = (("vertex", vertex.into()), ("point", point.into()));
                match part {
                    StrokePart::Side => SIDE.with([vertex, point]),
                    StrokePart::Pivot => PIVOT.with([vertex]),
                    StrokePart::Join => JOIN.with([vertex, join, point, distance]),
                    StrokePart::Cap => CAP.with([vertex, cap, point]),
                }
            }
        }
    }

    fn picture(&self) -> Picture {
        let points = self.lines.iter().flatten().copied();
        let mut picture = Picture::around(points, 0.0);
        let reach = DVec2::splat(self.width * 1.6);
        picture.extent = [picture.extent[0] - reach, picture.extent[1] + reach];
        self.lines.iter().for_each(|line| picture.chain(line.clone(), Look::Thin));
        for (number, ring) in self.rings.iter().enumerate() {
            let mut points: Vec<DVec2> = ring.iter().map(|(point, _)| *point).collect();
            let is_last = number + 1 == self.rings.len();
            if !is_last {
                points.extend(points.first().copied());
            }
            picture.chain(points, Look::First);
            for (point, part) in ring {
                let look = match part {
                    StrokePart::Side => Look::First,
                    StrokePart::Pivot => Look::Second,
                    StrokePart::Join => Look::Result,
                    StrokePart::Cap => Look::Pale,
                };
                picture.dot(*point, look);
            }
            if let Some((point, _)) = ring.last().filter(|_| is_last) {
                picture.dot(*point, Look::Now);
            }
        }
        picture
    }
}

fn part_name(part: StrokePart) -> Word {
    match part {
        StrokePart::Side => Word::new("side", "Seite"),
        StrokePart::Pivot => Word::new("corner itself", "Ecke selbst"),
        StrokePart::Join => Word::new("join", "Verbindung"),
        StrokePart::Cap => Word::new("cap", "Ende"),
    }
}
