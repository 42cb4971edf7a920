//! The lesson of Sobkow, Pospisil and Yang's line codes.

use super::parametric::SIDES;
use super::{
    CODE, Cutting, END, NO_HEAD, POINT, START, TAKES, border_name, end_name, figure, side,
};
use crate::Result;
use crate::clip::line::sobkow_pospisil_yang::{CASES, Case, EndWay, INFO, Step, clip};
use crate::clip::outcode::Outcode;
use crate::explain::frame::{Frames, Shown, Want, record};
use crate::explain::input::{Input, Options};
use crate::explain::lesson::{Example, Lesson};
use crate::explain::picture::{Look, Picture};
use crate::explain::table::Table;
use crate::explain::words::{Caption, Template, Value, Word};
use crate::trace::PseudocodeLine;

pub(super) const LESSON: Lesson = Lesson {
    name: INFO.name,
    info: &INFO,
    takes: TAKES,
    examples: &[
        Example {
            name: "corners",
            title: Word::new("from corner to corner", "von Ecke zu Ecke"),
            input: || figure((10.0, 6.0), (-4.0, -2.5), (12.5, 8.5)),
        },
        Example {
            name: "missed",
            title: Word::new("one cut shows the miss", "ein Schnitt zeigt den Fehlschlag"),
            input: || figure((10.0, 6.0), (-4.0, 3.0), (3.0, 9.5)),
        },
        Example {
            name: "two-sides",
            title: Word::new("from left to right: no test", "von links nach rechts: keine Prüfung"),
            input: || figure((10.0, 6.0), (-3.0, 1.5), (13.0, 4.0)),
        },
        Example {
            name: "from-inside",
            title: Word::new("from inside to a corner", "von innen zu einer Ecke"),
            input: || figure((10.0, 6.0), (3.0, 2.0), (14.0, 9.0)),
        },
        Example {
            name: "beyond",
            title: Word::new("both ends beyond one border", "beide Enden jenseits eines Rands"),
            input: || figure((10.0, 6.0), (-4.0, 1.0), (-1.0, 8.0)),
        },
        Example {
            name: "inside",
            title: Word::new("inside: accepted at once", "innen: sofort angenommen"),
            input: || figure((10.0, 6.0), (1.0, 1.0), (8.0, 5.0)),
        },
    ],
    templates: &[&CODE_OF_LINE, &CUT, &CUT_BEYOND, &AT_ONCE, &ACCEPTED, &SHARED, &MISSED],
    unreached: &[],
    make,
};

static CODE_OF_LINE: Template = Template::new(
    "code",
    "A has {start}, B has {end}: the line code {code} chooses the case, one of 81.",
    "A hat {start}, B hat {end}: Der Streckencode {code} wählt den Fall, einen von 81.",
);
static CUT: Template = Template::new(
    "cut",
    "The case names the {border} border: {end} moves to {point}. It is inside.",
    "Der Fall nennt den {border} Rand: {end} wandert nach {point}. Das liegt innen.",
);
static CUT_BEYOND: Template = Template::new(
    "cut",
    "The case names the {border} border: {end} moves to {point}, still outside with {code}.",
    "Der Fall nennt den {border} Rand: {end} wandert nach {point}, noch außen mit {code}.",
);
static AT_ONCE: Template = Template::new(
    "accepted",
    "Case 0000 0000: both ends are inside, accepted.",
    "Fall 0000 0000: Beide Enden liegen innen, angenommen.",
);
static ACCEPTED: Template = Template::new(
    "accepted",
    "Accepted: the case has no more to do. Cuts: {cuts}.",
    "Angenommen: Im Fall ist nichts mehr zu tun. Schnitte: {cuts}.",
);
static SHARED: Template = Template::new(
    "rejected",
    "Case {code}: the bit {bit} is in both halves, so both ends are beyond one border. Rejected.",
    "Fall {code}: Das Bit {bit} steht in beiden Hälften, also liegen beide Enden jenseits eines Rands. Abgelehnt.",
);
static MISSED: Template = Template::new(
    "rejected",
    "The crossing is beyond a border of the other end, too: the segment passes the corner. Rejected.",
    "Der Schnittpunkt liegt auch jenseits eines Rands des anderen Endes: Die Strecke geht an der Ecke vorbei. Abgelehnt.",
);

/// The segment with the codes of its ends.
#[derive(Clone)]
struct State {
    cutting: Cutting,
    codes: [Outcode; 2],
    cuts: usize,
}

fn make(_: &Lesson, input: &Input, _: &Options, cap: usize) -> Result<Frames> {
    let cutting = Cutting::new(input)?;
    let steps = record(cap, |t| clip(&cutting.window, cutting.whole, t))?;
    let mut state = State { cutting, codes: [Outcode::INSIDE; 2], cuts: 0 };
    Ok(Frames::new(steps, move |step, want| state.show(step, want)))
}

impl State {
    fn show(&mut self, step: &Step, want: Want) -> Shown {
        let caption = self.take(step);
        let picture = || {
            let mut picture = self.picture();
            match *step {
                Step::Cut { border, point, .. } => {
                    picture.chain(side(&self.cutting.window, border), Look::Now);
                    picture.dot(point, Look::Now);
                }
                Step::Accepted { .. } => {
                    picture.chain([self.cutting.left.start, self.cutting.left.end], Look::Result);
                }
                Step::Code { .. } | Step::Rejected { .. } => {}
            }
            picture
        };
        want.shown(step.line(), caption, || self.table(), picture)
    }

    fn take(&mut self, step: &Step) -> Caption {
        match *step {
            Step::Code { start, end } => {
                self.codes = [start, end];
                let code = ("code", self.code());
                CODE_OF_LINE.with([("start", start.into()), ("end", end.into()), code])
            }
            Step::Cut { end, border, point, code } => {
                self.cutting.cut(end, point);
                self.cuts += 1;
                let template = if code.is_inside() { &CUT } else { &CUT_BEYOND };
                template.with([
                    ("border", border_name(border)),
                    ("end", end_name(end)),
                    ("point", point.into()),
                    ("code", code.into()),
                ])
            }
            Step::Accepted { at_once: true } => AT_ONCE.with([]),
            Step::Accepted { at_once: false } => ACCEPTED.with([("cuts", self.cuts.into())]),
            Step::Rejected { at_once } => {
                self.cutting.gone = true;
                if at_once {
                    let bit = (self.codes[0] & self.codes[1]).into();
                    SHARED.with([("code", self.code()), ("bit", bit)])
                } else {
                    MISSED.with([])
                }
            }
        }
    }

    /// Returns the line code as two halves.
    fn code(&self) -> Value {
        let [start, end] = self.codes;
        format!("{start} {end}").into()
    }

    fn table(&self) -> Table {
        let cuts = Word::new("may be cut at", "Schnitt mit");
        let misses = Word::new("missed beyond", "verfehlt jenseits");
        let mut table = Table::new([NO_HEAD, POINT, CODE, cuts, misses]);
        let [start, end] = self.codes;
        let none = EndWay { borders: Outcode::INSIDE, misses: Outcode::INSIDE };
        let ways = match CASES[usize::from(start.0 << 4 | end.0)] {
            Case::Cut { start, end } => [start, end],
            Case::Accept | Case::Reject => [none; 2],
        };
        let left = self.cutting.left;
        let rows = [(START, left.start, start), (END, left.end, end)];
        for ((name, point, code), way) in rows.into_iter().zip(ways) {
            table.row(name, [point.into(), code.into(), borders(way.borders), borders(way.misses)]);
        }
        table
    }

    fn picture(&self) -> Picture {
        let mut picture = self.cutting.regions();
        self.cutting.add_segment(&mut picture);
        picture
    }
}

/// Returns the names of borders, in the order of their cuts.
fn borders(code: Outcode) -> Value {
    let set = |(border, _): &(Outcode, Word)| code.contains(*border);
    let names = Outcode::BORDERS.into_iter().zip(SIDES).filter(set);
    names.map(|(_, name)| name).collect::<Vec<Word>>().into()
}
