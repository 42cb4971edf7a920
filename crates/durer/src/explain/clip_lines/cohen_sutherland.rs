//! The lesson of Cohen and Sutherland's outcodes.

use super::{
    CODE, Cutting, END, NO_HEAD, POINT, START, TAKES, border_name, end_name, figure, side,
};
use crate::Result;
use crate::clip::line::cohen_sutherland::{INFO, Step, clip};
use crate::clip::line::{End, Segment};
use crate::clip::outcode::Outcode;
use crate::explain::frame::{Frames, Shown, Want, record};
use crate::explain::input::{Input, Options};
use crate::explain::lesson::{Example, Lesson};
use crate::explain::picture::{Look, Picture};
use crate::explain::table::Table;
use crate::explain::words::{Caption, Template, Value, Word};
use crate::math::{DVec2, Rect};
use crate::trace::{PseudocodeLine, Recorder};

pub(super) const LESSON: Lesson = Lesson {
    name: INFO.name,
    info: &INFO,
    takes: TAKES,
    examples: EXAMPLES,
    templates: &[&CODES, &CUT, &ACCEPTED, &REJECTED],
    unreached: &[],
    make,
};

const EXAMPLES: &[Example] = &[
    Example {
        name: "all-borders",
        title: Word::new("four cuts, two of them useless", "Vier Schnitte, zwei davon nutzlos"),
        input: || figure((10.0, 6.0), (-4.0, -2.5), (12.5, 8.5)),
    },
    Example {
        name: "line-ad",
        title: Word::new(
            "AD of the lecture: one cut, then rejected",
            "AD der Vorlesung: ein Schnitt, dann abgelehnt",
        ),
        input: || figure((10.0, 6.0), (-5.0, 3.5), (3.0, 9.5)),
    },
    Example {
        name: "line-eh",
        title: Word::new(
            "EH of the lecture: cut left and right",
            "EH der Vorlesung: links und rechts geschnitten",
        ),
        input: || figure((10.0, 6.0), (-3.0, 1.5), (13.0, 4.0)),
    },
    Example {
        name: "corner",
        title: Word::new("through a corner: a point remains", "durch eine Ecke: ein Punkt bleibt"),
        input: || figure((10.0, 6.0), (8.0, 8.0), (12.0, 4.0)),
    },
    Example {
        name: "inside",
        title: Word::new("inside: accepted at once", "innen: sofort angenommen"),
        input: || figure((10.0, 6.0), (1.0, 1.0), (8.0, 5.0)),
    },
    Example::new(
        "vertical",
        "vertical: it meets two borders only",
        "senkrecht: trifft nur zwei Ränder",
        || figure((10.0, 6.0), (4.0, -3.0), (4.0, 9.0)),
    ),
];

static CODES: Template = Template::new(
    "codes",
    "Codes {start} of A ({place_a}) and {end} of B ({place_b}): OR is {or}, AND is {and}.",
    "Codes {start} von A ({place_a}) und {end} von B ({place_b}): ODER gibt {or}, UND gibt {and}.",
);
static CUT: Template = Template::new(
    "cut",
    "The code has the bit of the {border} border: {end} moves to {point}, code {code}.",
    "Im Code steht das Bit des {border} Rands: {end} wandert nach {point}, Code {code}.",
);
static ACCEPTED: Template = Template::new(
    "accepted",
    "OR of the codes is 0000: the rest is inside, accepted.",
    "ODER der Codes gibt 0000: Was übrig ist, liegt innen und wird angenommen.",
);
static REJECTED: Template = Template::new(
    "rejected",
    "AND of the codes is {and}, not 0000: everything is beyond one border, rejected.",
    "UND der Codes gibt {and}, nicht 0000: Alles liegt jenseits eines Rands und wird abgelehnt.",
);

/// The segment with the codes of its ends.
#[derive(Clone)]
struct State {
    cutting: Cutting,
    codes: [Outcode; 2],
}

fn make(_: &Lesson, input: &Input, _: &Options, cap: usize) -> Result<Frames> {
    by_codes(input, cap, |window, segment, t| clip(window, segment, t).map(drop))
}

/// Makes the frames of a program that reports steps of outcodes.
pub(in crate::explain) fn by_codes(
    input: &Input,
    cap: usize,
    program: impl FnOnce(&Rect, Segment<DVec2>, &mut Recorder<Step<DVec2>>) -> Result<()>,
) -> Result<Frames> {
    let cutting = Cutting::new(input)?;
    let steps = record(cap, |t| program(&cutting.window, cutting.whole, t))?;
    let mut state = State { cutting, codes: [Outcode::INSIDE; 2] };
    Ok(Frames::new(steps, move |step, want| state.show(step, want)))
}

/// Returns the region of an outcode in words.
fn place(code: Outcode) -> Value {
    let words = [
        (Outcode::TOP, Word::new("above", "oben")),
        (Outcode::BOTTOM, Word::new("below", "unten")),
        (Outcode::LEFT, Word::new("left", "links")),
        (Outcode::RIGHT, Word::new("right", "rechts")),
    ];
    if code.is_inside() {
        return Word::new("inside", "innen").into();
    }
    let set = words.into_iter().filter(|(bit, _)| code.contains(*bit));
    Value::List(set.map(|(_, word)| word.into()).collect())
}

impl State {
    fn show(&mut self, step: &Step<DVec2>, want: Want) -> Shown {
        let caption = self.take(step);
        want.shown(
            step.line(),
            caption,
            || self.table(),
            || {
                let mut picture = self.picture();
                if let Step::Cut { border, point, .. } = *step {
                    picture.chain(side(&self.cutting.window, border), Look::Now);
                    picture.dot(point, Look::Now);
                }
                if *step == Step::Accepted {
                    picture.chain([self.cutting.left.start, self.cutting.left.end], Look::Result);
                }
                picture
            },
        )
    }

    fn take(&mut self, step: &Step<DVec2>) -> Caption {
        match *step {
            Step::Codes { start, end } => {
                self.codes = [start, end];
                let values = [start, end, start | end, start & end].map(Into::into);
                let places = [("place_a", place(self.codes[0])), ("place_b", place(self.codes[1]))];
                let ([start, end, or, and], [a, b]) = (values, places);
                CODES.with([("start", start), ("end", end), ("or", or), ("and", and), a, b])
            }
            Step::Cut { end, border, point, code } => {
                self.cutting.cut(end, point);
                self.codes[usize::from(end == End::End)] = code;
                CUT.with([
                    ("border", border_name(border)),
                    ("end", end_name(end)),
                    ("point", point.into()),
                    ("code", code.into()),
                ])
            }
            Step::Accepted => ACCEPTED.with([]),
            Step::Rejected => {
                self.cutting.gone = true;
                REJECTED.with([("and", (self.codes[0] & self.codes[1]).into())])
            }
        }
    }

    fn table(&self) -> Table {
        let mut table = Table::new([NO_HEAD, POINT, CODE]);
        let left = self.cutting.left;
        let [start, end] = self.codes;
        table.row(START, [left.start.into(), start.into()]);
        table.row(END, [left.end.into(), end.into()]);
        table.row(Word::new("OR", "ODER"), ["".into(), (start | end).into()]);
        table.row(Word::new("AND", "UND"), ["".into(), (start & end).into()]);
        table
    }

    /// Draws the regions, the window and the segment.
    fn picture(&self) -> Picture {
        let mut picture = self.cutting.regions();
        self.cutting.add_segment(&mut picture);
        picture
    }
}
