//! The lesson of the floating horizon, curve by curve.

use crate::Result;
use crate::explain::frame::{Frames, Shown, Want, record};
use crate::explain::grid::letter;
use crate::explain::input::{Figure, Input};
use crate::explain::lesson::{Example, Lesson};
use crate::explain::picture::{Look, Picture};
use crate::explain::table::Table;
use crate::explain::words::{Caption, Template, Value, Word};
use crate::math::DVec2;
use crate::trace::PseudocodeLine;
use crate::visibility::line::horizon_curves::{
    ColumnCurve, HorizonSide, INFO, Options, Step, VisiblePiece, draw,
};

pub(super) const LESSON: Lesson = Lesson {
    name: INFO.name,
    info: &INFO,
    takes: TAKES,
    examples: EXAMPLES,
    templates: &[&ABOVE, &BELOW, &BETWEEN, &CROSSING, &DRAW, &HORIZON],
    unreached: &[],
    make: |_, input, _, cap| make(input, cap),
};

const TAKES: Word = Word::new(
    "lines with a point in each column, the nearest line first",
    "Linien mit einem Punkt je Spalte, die nächste zuerst",
);

/// Largest number of columns that can be distinguished.
const MOST: usize = 200;

const EXAMPLES: &[Example] = &[
    Example {
        name: "lecture",
        title: Word::new(
            "0, 2, 0 before 1, 1, 1: crossings at ½ and 1½",
            "0, 2, 0 vor 1, 1, 1: Schnitte bei ½ und 1½",
        ),
        input: || curves(&[&[0.0, 2.0, 0.0], &[1.0, 1.0, 1.0]]),
    },
    Example {
        name: "hill",
        title: Word::new(
            "a hill, and curves seen below it",
            "ein Hügel, und was unter ihm zu sehen ist",
        ),
        input: || {
            curves(&[
                &[1.0, 1.5, 1.0, 0.5, 1.0],
                &[1.5, 3.0, 4.0, 2.0, 1.5],
                &[2.0, 2.0, 2.0, 2.0, 2.0],
                &[0.0, 2.5, 3.0, 3.0, 0.5],
            ])
        },
    },
    Example::new(
        "flat",
        "all curves at one height: nothing is added",
        "alle Kurven auf einer Höhe: nichts kommt hinzu",
        || curves(&[&[1.0, 1.0, 1.0], &[1.0, 1.0, 1.0], &[1.0, 1.0, 1.0]]),
    ),
    Example::new(
        "rising",
        "each curve above the one before it: all is seen",
        "jede Kurve über der vorigen: alles ist zu sehen",
        || curves(&[&[0.0, 0.5, 0.0, 0.5], &[1.0, 1.5, 1.0, 1.5], &[2.0, 2.5, 2.0, 2.5]]),
    ),
    Example::new(
        "valley",
        "a valley, whose bottom the front hides",
        "ein Tal, dessen Grund der Vordergrund verdeckt",
        || {
            curves(&[
                &[1.0, 2.0, 2.0, 2.0, 1.0],
                &[2.0, 1.0, 0.5, 1.0, 2.0],
                &[3.0, 2.0, 1.5, 2.0, 3.0],
            ])
        },
    ),
    Example::new(
        "waves",
        "waves: a crossing in every column",
        "Wellen: in jeder Spalte ein Schnitt",
        || {
            curves(&[
                &[0.0, 2.0, 0.0, 2.0, 0.0],
                &[2.0, 0.0, 2.0, 0.0, 2.0],
                &[1.0, 1.0, 1.0, 1.0, 1.0],
            ])
        },
    ),
];

fn curves(all: &[&[f64]]) -> Input {
    let line = |heights: &&[f64]| {
        heights.iter().enumerate().map(|(x, &y)| DVec2::new(x as f64, y)).collect()
    };
    Input::Figure(Figure { lines: all.iter().map(line).collect(), ..Figure::default() })
}

static ABOVE: Template = Template::new(
    "point",
    "Curve {curve}, column {column}: y = {y} is not below the upper horizon {upper}: seen.",
    "Kurve {curve}, Spalte {column}: y = {y} liegt nicht unter dem oberen Horizont {upper}: sichtbar.",
);
static BELOW: Template = Template::new(
    "point",
    "Curve {curve}, column {column}: y = {y} is not above the lower horizon {lower}: seen.",
    "Kurve {curve}, Spalte {column}: y = {y} liegt nicht über dem unteren Horizont {lower}: sichtbar.",
);
static BETWEEN: Template = Template::new(
    "point",
    "Curve {curve}, column {column}: y = {y} lies between the horizons {lower} and {upper}: hidden.",
    "Kurve {curve}, Spalte {column}: y = {y} liegt zwischen den Horizonten {lower} und {upper}: verdeckt.",
);
static CROSSING: Template = Template::new(
    "crossing",
    "Curve {curve} passes a horizon between two columns, at {at} by interpolation.",
    "Kurve {curve} kreuzt zwischen zwei Spalten einen Horizont, interpoliert bei {at}.",
);
static DRAW: Template = Template::new(
    "draw",
    "The piece of curve {curve} from {from} to {to} is drawn.",
    "Das Stück der Kurve {curve} von {from} bis {to} wird gezeichnet.",
);
static HORIZON: Template = Template::new(
    "horizon",
    "In column {column} the horizons are now {lower} and {upper}.",
    "In Spalte {column} liegen die Horizonte jetzt bei {lower} und {upper}.",
);

/// The curves, the two arrays, and the drawn pieces.
#[derive(Clone)]
struct State {
    curves: Vec<ColumnCurve>,
    horizons: Vec<[f64; 2]>,
    drawn: Vec<VisiblePiece>,
}

fn make(input: &Input, cap: usize) -> Result<Frames> {
    let curves = laid(input.figure(TAKES)?)?;
    let last = |curve: &ColumnCurve| curve.first + curve.heights.len();
    let columns = curves.iter().map(last).max().unwrap_or_default();
    let steps = record(cap, |t| draw(&curves, &Options::columns(columns), t))?;
    let horizons = vec![[f64::INFINITY, f64::NEG_INFINITY]; columns];
    let mut state = State { curves, horizons, drawn: Vec::new() };
    Ok(Frames::new(steps, move |step, want| state.show(step, want)))
}

/// Returns the lines as curves: a point in each column, in order.
fn laid(figure: &Figure) -> Result<Vec<ColumnCurve>> {
    let wrong = || crate::Error::parameter("line", "given", TAKES.en);
    let curve = |line: &Vec<DVec2>| {
        let first = line.first().map_or(0.0, |p| p.x);
        let steps = line.iter().enumerate().all(|(k, p)| p.x == first + k as f64);
        let fits = steps
            && first >= 0.0
            && first.fract() == 0.0
            && first + line.len() as f64 <= MOST as f64;
        let heights = line.iter().map(|p| p.y).collect();
        fits.then_some(ColumnCurve { first: first as usize, heights }).ok_or_else(wrong)
    };
    figure.lines.iter().map(curve).collect()
}

impl State {
    fn show(&mut self, step: &Step, want: Want) -> Shown {
        let caption = self.take(step);
        want.shown(step.line(), caption, || self.table(), || self.picture(step))
    }

    fn take(&mut self, step: &Step) -> Caption {
        match *step {
            Step::Point { curve, column, y, horizons: [lower, upper], seen } => {
                let values =
                    [("curve", letter(curve).into()), ("column", column.into()), ("y", y.into())];
                let [curve, column, y] = values;
                let (lower, upper) = (("lower", lower.into()), ("upper", upper.into()));
                match seen {
                    HorizonSide::Above => ABOVE.with([curve, column, y, upper]),
                    HorizonSide::Below => BELOW.with([curve, column, y, lower]),
                    HorizonSide::Hidden => BETWEEN.with([curve, column, y, lower, upper]),
                }
            }
            Step::Crossing { curve, at } => {
                CROSSING.with([("curve", letter(curve).into()), ("at", at.into())])
            }
            Step::Draw(piece) => {
                self.drawn.push(piece);
                let [from, to] = piece.ends.map(Value::from);
                DRAW.with([("curve", letter(piece.curve).into()), ("from", from), ("to", to)])
            }
            Step::Horizon { column, horizons: horizons @ [lower, upper] } => {
                if let Some(own) = self.horizons.get_mut(column) {
                    *own = horizons;
                }
                let column = ("column", column.into());
                HORIZON.with([column, ("lower", lower.into()), ("upper", upper.into())])
            }
        }
    }

    fn table(&self) -> Table {
        let heads = [
            Word::new("column", "Spalte"),
            Word::new("lower", "unten"),
            Word::new("upper", "oben"),
        ];
        let mut table = Table::new(heads);
        for (column, horizons) in self.horizons.iter().enumerate() {
            table.row(column, horizons.map(Value::from));
        }
        table
    }

    fn picture(&self, step: &Step) -> Picture {
        let points = |curve: &ColumnCurve| -> Vec<DVec2> {
            (curve.first..).zip(&curve.heights).map(|(x, &y)| DVec2::new(x as f64, y)).collect()
        };
        let mut picture = Picture::around(self.curves.iter().flat_map(points), 0.12);
        for (number, curve) in self.curves.iter().enumerate() {
            let points = points(curve);
            points
                .last()
                .into_iter()
                .for_each(|&end| picture.label(end, (9.0, 0.0), letter(number)));
            picture.chain(points, Look::Pale);
        }
        for which in [0, 1] {
            let known = self.horizons.iter().enumerate().filter(|(_, h)| h[which].is_finite());
            let chain: Vec<DVec2> = known.map(|(x, h)| DVec2::new(x as f64, h[which])).collect();
            picture.chain(chain, if which == 0 { Look::Second } else { Look::First });
        }
        self.drawn.iter().for_each(|piece| picture.chain(piece.ends, Look::Result));
        match *step {
            Step::Point { column, y, .. } => picture.dot(DVec2::new(column as f64, y), Look::Now),
            Step::Crossing { at, .. } => picture.dot(at, Look::Now),
            Step::Draw(piece) => picture.chain(piece.ends, Look::Now),
            Step::Horizon { column, horizons } => {
                for y in horizons {
                    picture.dot(DVec2::new(column as f64, y), Look::Now);
                }
            }
        }
        picture
    }
}
