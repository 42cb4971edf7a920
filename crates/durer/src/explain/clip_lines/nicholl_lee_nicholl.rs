//! The lesson of Nicholl, Lee and Nicholl's rays.

use super::{Cutting, NO_HEAD, TAKES, border_name, end_name, figure, p};
use crate::Result;
use crate::clip::line::nicholl_lee_nicholl::{INFO, Step, clip};
use crate::clip::outcode::Outcode;
use crate::explain::frame::{Frames, Shown, Want, record};
use crate::explain::input::{Input, Options};
use crate::explain::lesson::{Example, Lesson};
use crate::explain::picture::{Look, Picture};
use crate::explain::table::Table;
use crate::explain::words::{Caption, Template, Value, Word};
use crate::math::DVec2;
use crate::trace::PseudocodeLine;
use std::cmp::Ordering;

pub(super) const LESSON: Lesson = Lesson {
    name: INFO.name,
    info: &INFO,
    takes: TAKES,
    examples: &[
        Example {
            name: "from-corner",
            title: Word::new("from the region of a corner", "aus dem Gebiet einer Ecke"),
            input: || figure((10.0, 6.0), (-4.0, -2.5), (13.0, 4.5)),
        },
        Example {
            name: "from-border",
            title: Word::new("from beside a border", "von neben einem Rand"),
            input: || figure((10.0, 6.0), (-4.0, 2.0), (12.0, 8.5)),
        },
        Example {
            name: "from-inside",
            title: Word::new("from inside", "von innen"),
            input: || figure((10.0, 6.0), (3.0, 2.0), (14.0, 7.0)),
        },
        Example {
            name: "missed",
            title: Word::new("past a corner", "an einer Ecke vorbei"),
            input: || figure((10.0, 6.0), (-4.0, 3.0), (3.0, 9.5)),
        },
        Example::new(
            "through-corners",
            "exactly through two corners",
            "genau durch zwei Ecken",
            || figure((10.0, 6.0), (-5.0, -3.0), (15.0, 9.0)),
        ),
        Example::new(
            "beyond",
            "both ends beyond one border",
            "beide Enden jenseits eines Rands",
            || figure((10.0, 6.0), (-4.0, 1.0), (-1.0, 5.0)),
        ),
    ],
    templates: &[&REGION, &CORNER, &CUT, &ACCEPTED, &REJECTED],
    unreached: &[],
    make,
};

static REGION: Template = Template::new(
    "region",
    "{name} is where the search begins: {region}, code {code}.",
    "{name} ist der Ausgangspunkt: {region}, Code {code}.",
);
static CORNER: Template = Template::new(
    "corner",
    "The line passes {side} the corner {corner}.",
    "Die Gerade geht {side} der Ecke {corner} vorbei.",
);
static CUT: Template = Template::new(
    "cut",
    "So the {border} border is crossed: {end} moves to {point}. It is an end of the result.",
    "Also wird der Rand gekreuzt, und zwar am {border}: {end} wandert nach {point}, ein Ende des Ergebnisses.",
);
static ACCEPTED: Template = Template::new(
    "accepted",
    "Accepted: {corners} {corners|ray was|rays were} tested, {cuts} {cuts|cut was|cuts were} computed, none of them in vain.",
    "Angenommen: {corners} {corners|Strahl wurde|Strahlen wurden} befragt, {cuts} {cuts|Schnitt|Schnitte} berechnet, keiner umsonst.",
);
static REJECTED: Template = Template::new(
    "rejected",
    "Rejected: the line misses the window; no cut was computed.",
    "Abgelehnt: Die Gerade geht am Fenster vorbei; kein Schnitt wurde berechnet.",
);

#[derive(Clone)]
struct State {
    cutting: Cutting,
    /// Start of the rays.
    from: DVec2,
    rays: Vec<(Outcode, Ordering)>,
    cuts: usize,
}

fn make(_: &Lesson, input: &Input, _: &Options, cap: usize) -> Result<Frames> {
    let cutting = Cutting::new(input)?;
    let steps = record(cap, |t| clip(&cutting.window, cutting.whole, t))?;
    // It begins at the end with the smaller x, or with the smaller y above one another.
    let [a, b] = [cutting.whole.start, cutting.whole.end];
    let from = if (a.x, a.y) <= (b.x, b.y) { a } else { b };
    let mut state = State { cutting, from, rays: Vec::new(), cuts: 0 };
    Ok(Frames::new(steps, move |step, want| state.show(step, want)))
}

impl State {
    /// Returns the corner that two bits name.
    fn corner(&self, code: Outcode) -> DVec2 {
        let (min, max) = (self.cutting.window.min(), self.cutting.window.max());
        let pick = |bit, low, high| if code.contains(bit) { high } else { low };
        p(pick(Outcode::RIGHT, min.x, max.x), pick(Outcode::TOP, min.y, max.y))
    }

    fn show(&mut self, step: &Step, want: Want) -> Shown {
        let caption = self.take(step);
        want.shown(
            step.line(),
            caption,
            || self.table(),
            || {
                let mut picture = self.picture();
                match *step {
                    Step::Region { .. } => picture.dot(self.from, Look::Now),
                    Step::Corner { corner, .. } => picture.dot(self.corner(corner), Look::Now),
                    Step::Cut { point, .. } => picture.dot(point, Look::Now),
                    Step::Accepted => {
                        picture
                            .chain([self.cutting.left.start, self.cutting.left.end], Look::Result);
                    }
                    Step::Rejected => {}
                }
                picture
            },
        )
    }

    fn take(&mut self, step: &Step) -> Caption {
        match *step {
            Step::Region { code } => {
                let name = if self.from == self.cutting.whole.start { "A" } else { "B" };
                REGION.with([
                    ("name", name.into()),
                    ("region", region(code)),
                    ("code", code.into()),
                ])
            }
            Step::Corner { corner, passes } => {
                self.rays.push((corner, passes));
                CORNER.with([("side", side(passes)), ("corner", self.corner(corner).into())])
            }
            Step::Cut { end, border, point } => {
                self.cutting.cut(end, point);
                self.cuts += 1;
                CUT.with([
                    ("border", border_name(border)),
                    ("end", end_name(end)),
                    ("point", point.into()),
                ])
            }
            Step::Accepted => {
                ACCEPTED.with([("corners", self.rays.len().into()), ("cuts", self.cuts.into())])
            }
            Step::Rejected => {
                self.cutting.gone = true;
                REJECTED.with([])
            }
        }
    }

    fn table(&self) -> Table {
        let head = Word::new("the line passes", "die Gerade geht vorbei");
        let mut table = Table::new([Word::new("corner", "Ecke"), head]);
        for &(corner, passes) in &self.rays {
            table.row(self.corner(corner), [side(passes)]);
        }
        let left = self.cutting.left;
        table.row(NO_HEAD, [Value::List(vec![left.start.into(), "–".into(), left.end.into()])]);
        table
    }

    fn picture(&self) -> Picture {
        let mut picture = Picture::new(self.cutting.extent());
        picture.frame(&self.cutting.window, Look::Window);
        for &(corner, _) in &self.rays {
            let to = self.from + (self.corner(corner) - self.from) * 1.6;
            picture.chain([self.from, to], Look::Dashed);
        }
        self.cutting.add_segment(&mut picture);
        picture
    }
}

fn region(code: Outcode) -> Value {
    match code.0.count_ones() {
        0 => Word::new("inside", "innen"),
        1 => Word::new("beside a border", "neben einem Rand"),
        _ => Word::new("at a corner", "an einer Ecke"),
    }
    .into()
}

fn side(passes: Ordering) -> Value {
    match passes {
        Ordering::Less => Word::new("below, or left of,", "unterhalb oder links"),
        Ordering::Equal => Word::new("exactly through", "genau an"),
        Ordering::Greater => Word::new("above, or right of,", "oberhalb oder rechts"),
    }
    .into()
}
