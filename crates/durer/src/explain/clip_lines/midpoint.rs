//! The lesson of midpoint subdivision.

use super::{CODE, Cutting, END, NO_HEAD, START, end_name, figure};
use crate::clip::line::Segment;
use crate::clip::line::midpoint::{INFO, PixelWindow, Step, clip};
use crate::clip::outcode::Outcode;
use crate::explain::frame::{Frames, Shown, Want, record};
use crate::explain::input::{Input, Options};
use crate::explain::lesson::{Example, Lesson};
use crate::explain::picture::{Look, Picture};
use crate::explain::table::Table;
use crate::explain::words::{Caption, Template, Value, Word};
use crate::math::{DAffine2, DVec2, IVec2, Rect};
use crate::trace::PseudocodeLine;
use crate::{Error, Result};

const TAKES: Word = Word::new(
    "a window and a line of two points, in whole numbers from 0 to 200",
    "ein Fenster und eine Strecke in ganzen Zahlen von 0 bis 200",
);

pub(super) const LESSON: Lesson = Lesson {
    name: INFO.name,
    info: &INFO,
    takes: TAKES,
    examples: &[
        Example {
            name: "both-ends",
            title: Word::new("both ends outside", "beide Enden außen"),
            input: || window((0.0, 0.0), (31.0, 14.0)),
        },
        Example {
            name: "one-end",
            title: Word::new("one end inside", "ein Ende innen"),
            input: || window((8.0, 5.0), (30.0, 9.0)),
        },
        Example {
            name: "missed",
            title: Word::new(
                "past a corner: nothing is visible",
                "an einer Ecke vorbei: nichts sichtbar",
            ),
            input: || window((0.0, 10.0), (8.0, 14.0)),
        },
        Example::new("inside", "both ends inside", "beide Enden innen", || {
            window((6.0, 5.0), (17.0, 9.0))
        }),
        Example::new(
            "beyond",
            "both ends beyond one border",
            "beide Enden jenseits eines Rands",
            || window((0.0, 2.0), (2.0, 13.0)),
        ),
        Example::new(
            "corner",
            "through a corner: one pixel remains",
            "durch eine Ecke: ein Pixel bleibt",
            || window((2.0, 5.0), (6.0, 1.0)),
        ),
    ],
    templates: &[&HALVED_IN, &HALVED_OUT, &CUT, &ACCEPTED, &REJECTED],
    unreached: &[],
    make,
};

/// Returns the window of the examples with a segment.
fn window(start: (f64, f64), end: (f64, f64)) -> Input {
    let Input::Figure(mut figure) = figure((1.0, 1.0), start, end) else {
        return Input::Example(String::new());
    };
    figure.window = Rect::new(DVec2::new(4.0, 3.0), DVec2::new(19.0, 11.0)).ok();
    Input::Figure(figure)
}

static HALVED_IN: Template = Template::new(
    "halved",
    "Middle {count}: the pixel {middle} with code {code} is inside; the search goes on between it and the end.",
    "Mitte {count}: Das Pixel {middle} mit Code {code} liegt innen; weiter zwischen ihm und dem Ende.",
);
static HALVED_OUT: Template = Template::new(
    "halved",
    "Middle {count}: the pixel {middle} with code {code} is outside; the half beyond it is dropped.",
    "Mitte {count}: Das Pixel {middle} mit Code {code} liegt außen; die Hälfte jenseits fällt weg.",
);
static CUT: Template = Template::new(
    "cut",
    "After {count} {count|middle|middles} {end} is found: the last visible pixel is {point}.",
    "Nach {count} {count|Mitte|Mitten} ist {end} gefunden: Das letzte sichtbare Pixel ist {point}.",
);
static ACCEPTED: Template = Template::new(
    "accepted",
    "Both ends are visible: the pixels between are, too.",
    "Beide Enden sind sichtbar, also auch alle Pixel dazwischen.",
);
static REJECTED: Template = Template::new(
    "rejected",
    "The rest is beyond one border or between two pixels: rejected.",
    "Was übrig ist, liegt jenseits eines Rands oder zwischen zwei Pixeln: abgelehnt.",
);

#[derive(Clone)]
struct State {
    cutting: Cutting,
    size: [u32; 2],
    /// Middles since the last end was found.
    looked: Vec<DVec2>,
    code_of_middle: Value,
}

fn make(_: &Lesson, input: &Input, _: &Options, cap: usize) -> Result<Frames> {
    let cutting = Cutting::new(input)?;
    let (min, max) = (cutting.window.min(), cutting.window.max());
    let ends = [cutting.whole.start, cutting.whole.end];
    let all = [min, max, ends[0], ends[1]];
    if let Some(p) = all
        .iter()
        .find(|p| p.fract() != DVec2::ZERO || p.cmplt(DVec2::ZERO).any() || p.max_element() > 200.0)
    {
        return Err(Error::parameter("input", format!("one with the point {p}"), TAKES.en));
    }
    let window = PixelWindow::new(min.as_ivec2(), max.as_ivec2())?;
    let segment = Segment::new(ends[0].as_ivec2(), ends[1].as_ivec2());
    let steps = record(cap, |t| Ok(clip(&window, segment, t)))?;
    let size = all.iter().fold(DVec2::ZERO, |a, &b| a.max(b)) + 1.0;
    let size = [size.x as u32, size.y as u32];
    let mut state = State { cutting, size, looked: Vec::new(), code_of_middle: "–".into() };
    Ok(Frames::new(steps, move |step, want| state.show(step, want)))
}

/// Returns the middle of a pixel.
fn center(p: IVec2) -> DVec2 {
    p.as_dvec2() + 0.5
}

impl State {
    fn show(&mut self, step: &Step, want: Want) -> Shown {
        let (count, clear) = (self.looked.len(), matches!(step, Step::Cut { .. }));
        let caption = self.take(step, count);
        let picture = || {
            let mut picture = self.picture();
            match *step {
                Step::Halved { middle, .. } => picture.dot(center(middle), Look::Now),
                Step::Cut { point, .. } => picture.dot(center(point), Look::Result),
                Step::Accepted => {
                    let left = self.cutting.left;
                    picture.chain([left.start + 0.5, left.end + 0.5], Look::Result);
                }
                Step::Rejected => {}
            }
            picture
        };
        let shown = want.shown(step.line(), caption, || self.table(), picture);
        if clear {
            self.looked.clear();
        }
        shown
    }

    fn take(&mut self, step: &Step, count: usize) -> Caption {
        match *step {
            Step::Halved { middle, code } => {
                self.looked.push(center(middle));
                self.code_of_middle = code.into();
                let template = if code.is_inside() { &HALVED_IN } else { &HALVED_OUT };
                let middle = middle.as_dvec2().into();
                template.with([
                    ("count", (count + 1).into()),
                    ("middle", middle),
                    ("code", code.into()),
                ])
            }
            Step::Cut { end, point } => {
                let point = point.as_dvec2();
                self.cutting.cut(end, point);
                CUT.with([("count", count.into()), ("end", end_name(end)), ("point", point.into())])
            }
            Step::Accepted => ACCEPTED.with([]),
            Step::Rejected => {
                self.cutting.gone = true;
                REJECTED.with([])
            }
        }
    }

    fn table(&self) -> Table {
        let mut table = Table::new([NO_HEAD, Word::new("pixel", "Pixel"), CODE]);
        let left = self.cutting.left;
        let code = |p| Value::from(Outcode::of_point_2d(&self.cutting.window, p));
        table.row(START, [left.start.into(), code(left.start)]);
        table.row(END, [left.end.into(), code(left.end)]);
        let middle = self.looked.last().map_or(Value::from("–"), |p| (*p - 0.5).into());
        let known = if self.looked.is_empty() { "–".into() } else { self.code_of_middle.clone() };
        table.row(Word::new("the middle", "die Mitte"), [middle, known]);
        table
    }

    fn picture(&self) -> Picture {
        let [columns, rows] = self.size;
        let mut picture = Picture::pixels(columns, rows);
        picture.down = false;
        let shift = DVec2::splat(0.5);
        picture.picture_from_input = Some(DAffine2::from_translation(shift));
        let window = &self.cutting.window;
        if let Ok(frame) = Rect::new(window.min(), window.max() + 1.0) {
            picture.frame(&frame, Look::Window);
        }
        let (whole, left) = (self.cutting.whole, self.cutting.left);
        picture.chain([whole.start + 0.5, whole.end + 0.5], Look::Pale);
        if !self.cutting.gone {
            picture.chain([left.start + 0.5, left.end + 0.5], Look::Thin);
        }
        for (i, &at) in self.looked.iter().enumerate() {
            picture.dot(at, Look::First);
            let aside = if i % 2 == 0 { -9.0 } else { 9.0 };
            picture.label(at, (0.0, aside), i + 1);
        }
        picture.label(whole.start + 0.5, (0.0, -9.0), "A");
        picture.label(whole.end + 0.5, (0.0, -9.0), "B");
        picture
    }
}
