//! The lessons of clipping text.

use crate::Result;
use crate::clip::text::{self, BoxPlace, Character, Step, TextClipper, clip, of_strokes};
use crate::curve::Contours;
use crate::explain::frame::{Frames, Shown, Want, record};
use crate::explain::input::{Figure, Input};
use crate::explain::lesson::{Example, Lesson};
use crate::explain::picture::{Look, Picture, corners};
use crate::explain::table::Table;
use crate::explain::words::{Caption, Template, Value, Word};
use crate::math::{DVec2, Rect};

pub(super) const STRING: Lesson = Lesson {
    name: text::STRING.name,
    info: &text::STRING,
    templates: &[&STRING_WITHIN, &STRING_OUTSIDE, &KEEP, &DROP],
    make: |_, input, _, cap| make(TextClipper::String, input, cap),
    ..OUTLINE
};

pub(super) const CHARACTER: Lesson = Lesson {
    name: text::CHARACTER.name,
    info: &text::CHARACTER,
    templates: &[&WITHIN, &BEYOND, &CROSSING, &KEEP, &DROP],
    make: |_, input, _, cap| make(TextClipper::Character, input, cap),
    ..OUTLINE
};

pub(super) const OUTLINE: Lesson = Lesson {
    name: text::OUTLINE.name,
    info: &text::OUTLINE,
    takes: TAKES,
    examples: &[
        Example {
            name: "word",
            title: Word::new(
                "a word that is wider than the window",
                "ein Wort, breiter als das Fenster",
            ),
            input: || of_text((5.0, -5.0), (38.0, 13.0), "WAVES"),
        },
        Example {
            name: "height",
            title: Word::new(
                "the upper border cuts every character",
                "der obere Rand schneidet jedes Zeichen",
            ),
            input: || of_text((-2.0, -6.0), (60.0, 8.0), "TEXT"),
        },
        Example {
            name: "rings",
            title: Word::new("letters as rings", "Buchstaben als Ringe"),
            input: letters,
        },
        Example {
            name: "inside",
            title: Word::new("in the window", "im Fenster"),
            input: || of_text((-3.0, -6.0), (24.0, 15.0), "IN"),
        },
        Example::new(
            "between",
            "the border is in the gap between two characters",
            "der Rand liegt in der Lücke zwischen zwei Zeichen",
            || of_text((-2.0, -5.0), (11.0, 15.0), "HI"),
        ),
        Example::new("outside", "beside the window", "neben dem Fenster", || {
            of_text((40.0, -5.0), (60.0, 15.0), "OUT")
        }),
    ],
    templates: &[&WITHIN, &BEYOND, &CROSSING, &KEEP, &DROP, &STROKE, &RING, &GONE],
    unreached: &[],
    make: |_, input, _, cap| make(TextClipper::Outline, input, cap),
};

const TAKES: Word = Word::new(
    "a window, strokes or rings, and the boxes of the characters as clip rings",
    "ein Fenster, Striche oder Ringe und die Kästen der Zeichen als Clip-Ringe",
);

static STRING_WITHIN: Template = Template::new(
    "box",
    "The box around the whole string is within the window.",
    "Der Kasten um die ganze Zeichenkette liegt im Fenster.",
);
static STRING_OUTSIDE: Template = Template::new(
    "box",
    "The box around the whole string is not within the window: no character is kept.",
    "Der Kasten um die ganze Zeichenkette liegt nicht im Fenster: Kein Zeichen bleibt.",
);
static WITHIN: Template = Template::new(
    "box",
    "The box of character {number} is within the window.",
    "Der Kasten von Zeichen {number} liegt im Fenster.",
);
static BEYOND: Template = Template::new(
    "box",
    "The box of character {number} is beyond a border.",
    "Der Kasten von Zeichen {number} liegt jenseits eines Rands.",
);
static CROSSING: Template = Template::new(
    "box",
    "The box of character {number} crosses a border.",
    "Der Kasten von Zeichen {number} kreuzt einen Rand.",
);
static KEEP: Template = Template::new(
    "keep",
    "Character {number} is kept as it is.",
    "Zeichen {number} bleibt, wie es ist.",
);
static DROP: Template =
    Template::new("drop", "Character {number} is left out.", "Zeichen {number} entfällt.");
static STROKE: Template = Template::new(
    "cut",
    "A stroke of character {number} is clipped as line segments; parts in the window: {parts}.",
    "Ein Strich von Zeichen {number} wird als Strecken geclippt; Teile im Fenster: {parts}.",
);
static RING: Template = Template::new(
    "cut",
    "A ring of character {number} is clipped as a polygon; parts in the window: {parts}.",
    "Ein Ring von Zeichen {number} wird als Polygon geclippt; Teile im Fenster: {parts}.",
);
static GONE: Template = Template::new(
    "cut",
    "Nothing of this stroke or ring of character {number} is in the window.",
    "Nichts von diesem Strich oder Ring von Zeichen {number} liegt im Fenster.",
);

/// Returns an input of a window and a text in strokes, with capitals 12 high on the base line y = 0.
fn of_text(low: (f64, f64), high: (f64, f64), text: &str) -> Input {
    let characters = of_strokes(text, 12.0, DVec2::ZERO).unwrap_or_default();
    let mut figure =
        Figure { window: Rect::new(low.into(), high.into()).ok(), ..Figure::default() };
    for own in &characters {
        figure.clip.push(corners(&own.bounds).to_vec());
        figure.lines.extend(own.outline.iter().map(|(stroke, _)| stroke.to_vec()));
    }
    Input::Figure(figure)
}

/// Returns an L, an A with its hole, and a T as rings.
fn letters() -> Input {
    let ring = |x: f64, points: &[(f64, f64)]| -> Vec<DVec2> {
        points.iter().map(|p| DVec2::new(x + p.0, p.1)).collect()
    };
    let l = [(0.0, 0.0), (8.0, 0.0), (8.0, 3.0), (3.0, 3.0), (3.0, 12.0), (0.0, 12.0)];
    let a = [
        (0.0, 0.0),
        (3.0, 0.0),
        (4.0, 3.0),
        (7.0, 3.0),
        (8.0, 0.0),
        (11.0, 0.0),
        (7.0, 12.0),
        (4.0, 12.0),
    ];
    let hole = [(4.8, 5.5), (6.2, 5.5), (5.5, 8.5)];
    let t = [
        (3.5, 0.0),
        (6.5, 0.0),
        (6.5, 9.0),
        (10.0, 9.0),
        (10.0, 12.0),
        (0.0, 12.0),
        (0.0, 9.0),
        (3.5, 9.0),
    ];
    let cell = |x: f64, width: f64| {
        ring(x - 1.0, &[(0.0, -1.0), (width, -1.0), (width, 13.0), (0.0, 13.0)])
    };
    Input::Figure(Figure {
        window: Rect::new(DVec2::new(-4.0, -2.0), DVec2::new(29.0, 7.0)).ok(),
        rings: vec![ring(0.0, &l), ring(10.0, &a), ring(10.0, &hole), ring(23.0, &t)],
        clip: vec![cell(0.0, 10.0), cell(10.0, 13.0), cell(23.0, 12.0)],
        ..Figure::default()
    })
}

/// Returns the characters of a figure: each of the clip's rings is around one; strokes and rings that are in none of them are
/// characters of their own.
fn characters(figure: &Figure) -> Vec<Character> {
    let boxes = figure.clip.iter().filter_map(|ring| Rect::around(ring.iter().copied()));
    let mut all: Vec<Character> =
        boxes.map(|bounds| Character { bounds, outline: Contours::new() }).collect();
    let strokes = figure.lines.iter().map(|line| (line, false));
    for (points, closed) in strokes.chain(figure.rings.iter().map(|ring| (ring, true))) {
        let Some(bounds) = Rect::around(points.iter().copied()) else { continue };
        let holds = |own: &&mut Character| {
            own.bounds.contains(bounds.min()) && own.bounds.contains(bounds.max())
        };
        match all.iter_mut().find(holds) {
            Some(own) => own.outline.push(points.iter().copied(), closed),
            None => {
                let mut outline = Contours::new();
                outline.push(points.iter().copied(), closed);
                all.push(Character { bounds, outline });
            }
        }
    }
    all
}

#[derive(Clone)]
struct State {
    clipper: TextClipper,
    window: Rect,
    text: Vec<Character>,
    /// Place of each character, and whether it is kept, once that is known.
    found: Vec<Option<(BoxPlace, bool)>>,
    left: Vec<(Vec<DVec2>, bool)>,
}

fn make(clipper: TextClipper, input: &Input, cap: usize) -> Result<Frames> {
    let figure = input.figure(TAKES)?;
    let (window, text) = (figure.window(TAKES)?, characters(figure));
    let options = text::Options { clipper };
    let steps = record(cap, |t| clip(&window, &text, &options, t))?;
    let found = vec![None; text.len()];
    let mut state = State { clipper, window, text, found, left: Vec::new() };
    Ok(Frames::new(steps, move |step, want| state.show(step, want)))
}

impl State {
    fn show(&mut self, step: &Step, want: Want) -> Shown {
        let caption = self.take(step);
        want.shown(step.line(self.clipper), caption, || self.table(), || self.picture(step))
    }

    fn take(&mut self, step: &Step) -> Caption {
        let number = |character: usize| ("number", Value::from(character + 1));
        match step {
            Step::Box { character: None, place, .. } => {
                self.found.fill(Some((*place, false)));
                let template =
                    if *place == BoxPlace::Within { &STRING_WITHIN } else { &STRING_OUTSIDE };
                template.with([])
            }
            Step::Box { character: Some(own), place, .. } => {
                self.found[*own] = Some((*place, false));
                let template = match place {
                    BoxPlace::Within => &WITHIN,
                    BoxPlace::Beyond => &BEYOND,
                    BoxPlace::Crossing => &CROSSING,
                };
                template.with([number(*own)])
            }
            Step::Keep { character, outline } => {
                self.keep(*character);
                self.left.extend(outline.iter().map(|(points, closed)| (points.to_vec(), closed)));
                KEEP.with([number(*character)])
            }
            Step::Drop { character } => DROP.with([number(*character)]),
            Step::Cut { character, closed, parts, .. } => {
                if parts.is_empty() {
                    return GONE.with([number(*character)]);
                }
                self.keep(*character);
                self.left.extend(parts.iter().map(|part| (part.clone(), *closed)));
                let template = if *closed { &RING } else { &STROKE };
                template.with([number(*character), ("parts", parts.len().into())])
            }
        }
    }

    fn keep(&mut self, character: usize) {
        if let Some((_, kept)) = &mut self.found[character] {
            *kept = true;
        }
    }

    fn table(&self) -> Table {
        let heads = [
            Word::new("character", "Zeichen"),
            Word::new("box", "Kasten"),
            Word::new("result", "Ergebnis"),
        ];
        let mut table = Table::new(heads);
        for (number, found) in self.found.iter().enumerate() {
            let Some((place, kept)) = found else { continue };
            let name = match place {
                BoxPlace::Within => Word::new("within", "innen"),
                BoxPlace::Beyond => Word::new("beyond a border", "jenseits"),
                BoxPlace::Crossing => Word::new("crossing", "kreuzt"),
            };
            let result = if *kept { Word::new("kept", "bleibt") } else { Word::new("–", "–") };
            table.row(number + 1, [name.into(), result.into()]);
        }
        table
    }

    fn picture(&self, step: &Step) -> Picture {
        let boxes = self.text.iter().flat_map(|own| [own.bounds.min(), own.bounds.max()]);
        let around = boxes.chain([self.window.min(), self.window.max()]);
        let mut picture = Picture::around(around, 0.06);
        for own in &self.text {
            picture.frame(&own.bounds, Look::Thin);
            add(&mut picture, own.outline.iter(), Look::Pale);
        }
        picture.frame(&self.window, Look::Window);
        add(
            &mut picture,
            self.left.iter().map(|(points, closed)| (&points[..], *closed)),
            Look::Result,
        );
        match step {
            Step::Box { bounds, .. } => picture.frame(bounds, Look::Now),
            Step::Cut { contour, closed, .. } => {
                add(&mut picture, [(&contour[..], *closed)], Look::Now)
            }
            Step::Keep { .. } | Step::Drop { .. } => {}
        }
        picture
    }
}

/// Adds strokes and rings to a picture.
fn add<'a>(
    picture: &mut Picture,
    contours: impl IntoIterator<Item = (&'a [DVec2], bool)>,
    look: Look,
) {
    for (points, closed) in contours {
        let mut points = points.to_vec();
        if closed {
            points.extend(points.first().copied());
        }
        picture.chain(points, look);
    }
}
