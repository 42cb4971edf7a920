//! Lessons of the walks along linked lists: Weiler–Atherton, and Greiner–Hormann.

use super::{
    CLIP, Operands, SUBJECT, TAKES, apart, bars, lecture, letter_and_blade, nested, pentagram,
    squares,
};
use crate::clip::polygon::Operand;
use crate::clip::polygon::weiler_atherton::{CrossingMark, Step};
use crate::clip::polygon::{greiner_hormann, weiler_atherton};
use crate::explain::frame::{Frames, Shown, Want, record};
use crate::explain::lesson::{Example, Lesson};
use crate::explain::picture::{Look, Picture};
use crate::explain::table::Table;
use crate::explain::words::{Caption, Template, Value, Word};
use crate::math::DVec2;
use crate::trace::PseudocodeLine;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

pub(super) const WEILER_ATHERTON: Lesson = Lesson {
    name: weiler_atherton::INFO.name,
    info: &weiler_atherton::INFO,
    takes: TAKES,
    examples: EXAMPLES,
    templates: &[&LISTED, &LISTED_CROSSING, &START, &ONTO_SUBJECT, &ONTO_CLIP, &PASSED, &RING],
    unreached: &[],
    make: |_, input, options, cap| {
        let operands = Operands::new(input)?;
        let [subject, clip] = operands.shapes();
        let steps = record(cap, |t| {
            weiler_atherton::weiler_atherton(
                &subject,
                &clip,
                options.operation,
                &Default::default(),
                t,
            )
        })?;
        Ok(show_all(operands, steps))
    },
};

pub(super) const GREINER_HORMANN: Lesson = Lesson {
    name: greiner_hormann::INFO.name,
    info: &greiner_hormann::INFO,
    takes: TAKES,
    examples: CROSSING_EXAMPLES,
    templates: &[&CROSSING_RINGS, &LISTED, &LISTED_CROSSING, &ENTRY, &EXIT, &START, &PASSED, &RING],
    unreached: &[],
    make: |_, input, options, cap| {
        let operands = Operands::new(input)?;
        let [subject, clip] = operands.shapes();
        let steps = record(cap, |t| {
            greiner_hormann::greiner_hormann(
                &subject,
                &clip,
                options.operation,
                &Default::default(),
                t,
            )
        })?;
        Ok(show_all(operands, steps))
    },
};

const EXAMPLES: &[Example] = &[
    Example {
        name: "lecture",
        title: Word::new(
            "subject 0 … 9, window a … d: two rings",
            "Subjekt 0 … 9, Fenster a … d: zwei Ringe",
        ),
        input: lecture,
    },
    Example {
        name: "letter",
        title: Word::new(
            "a letter cut by a concave polygon",
            "ein Buchstabe, zerschnitten von einem konkaven Polygon",
        ),
        input: letter_and_blade,
    },
    Example { name: "squares", title: Word::new("two squares", "zwei Quadrate"), input: squares },
    Example::new(
        "bars",
        "two bars across: four crossings",
        "zwei gekreuzte Balken: vier Schnittpunkte",
        bars,
    ),
    Example::new(
        "nested",
        "one within the other: no edges cross",
        "eines im anderen: keine Kanten schneiden sich",
        nested,
    ),
    Example::new("apart", "nothing in common", "nichts gemeinsam", apart),
];

const CROSSING_EXAMPLES: &[Example] = &[
    EXAMPLES[0],
    EXAMPLES[1],
    EXAMPLES[2],
    Example {
        name: "pentagram",
        title: Word::new(
            "a star that crosses itself and a square: points with an odd winding number are inside",
            "ein Stern, der sich selbst kreuzt, und ein Quadrat: Innen ist, was ungerade oft umlaufen wird",
        ),
        input: pentagram,
    },
    EXAMPLES[3],
    EXAMPLES[4],
];

static CROSSING_RINGS: Template = Template::new(
    "crossing-rings",
    "A ring crosses itself: entries and exits alternate along it, and the result follows the even-odd rule.",
    "Ein Ring kreuzt sich selbst: Eintritte und Austritte wechseln sich auf ihm ab, und das Ergebnis gilt nach der \
     Gerade-Ungerade-Regel.",
);
static LISTED: Template = Template::new(
    "listed",
    "The list of the {list}: vertex {name} at {at}.",
    "Die Liste von {list}: Ecke {name} bei {at}.",
);
static LISTED_CROSSING: Template = Template::new(
    "listed",
    "The list of the {list}: crossing {name} at {at}; here it is {mark} the other polygon.",
    "Die Liste von {list}: Kreuzung {name} bei {at}; hier {mark} das andere Polygon.",
);
static ENTRY: Template = Template::new(
    "crossing",
    "Crossing {name}: the subject enters the clip, an entry.",
    "Kreuzung {name}: Das Subjekt betritt den Clip, ein Eintritt.",
);
static EXIT: Template = Template::new(
    "crossing",
    "Crossing {name}: the subject leaves the clip, an exit.",
    "Kreuzung {name}: Das Subjekt verlässt den Clip, ein Austritt.",
);
static START: Template = Template::new(
    "start",
    "A ring begins at {name}, a crossing that no ring has passed yet.",
    "Bei {name} beginnt ein Ring: Diese Kreuzung hat noch keiner durchlaufen.",
);
static ONTO_SUBJECT: Template = Template::new(
    "turn",
    "At {name} the walk continues along the subject.",
    "Bei {name} geht der Gang auf dem Subjekt weiter.",
);
static ONTO_CLIP: Template = Template::new(
    "turn",
    "At {name} the walk turns onto the clip.",
    "Bei {name} wechselt der Gang auf den Clip.",
);
static PASSED: Template = Template::new(
    "passed",
    "{name} on the {list} belongs to the ring: {ring}.",
    "{name} auf {list} gehört zum Ring: {ring}.",
);
static RING: Template = Template::new(
    "ring",
    "Back at the start: ring number {number} is complete, {ring}.",
    "Zurück am Anfang: Ring Nummer {number} ist fertig, {ring}.",
);

/// The two lists, and the ring that is being made.
#[derive(Clone)]
struct State {
    operands: Operands,
    names: Arc<Names>,
    lists: [Vec<(DVec2, Option<CrossingMark>)>; 2],
    ring: Vec<DVec2>,
    rings: Vec<Vec<DVec2>>,
}

fn show_all(operands: Operands, steps: crate::trace::Recorder<Step>) -> Frames {
    let names = Arc::new(Names::new(&operands, steps.steps()));
    let lists = [Vec::new(), Vec::new()];
    let mut state = State { operands, names, lists, ring: Vec::new(), rings: Vec::new() };
    Frames::new(steps, move |step, want| state.show(step, want))
}

/// Names of vertices and crossings: numbers for the subject, letters for the clip and for crossings.
struct Names {
    /// Names by the bits of the coordinates.
    of: BTreeMap<[u64; 2], String>,
    /// Name of a point that is none of them.
    other: String,
}

impl Names {
    fn new(operands: &Operands, steps: &[Step]) -> Self {
        let letter = |first: u8, k: usize, most: usize, long: char| {
            let letter = u8::try_from(k).ok().filter(|_| k < most).map(|k| char::from(first + k));
            letter.map_or_else(|| format!("{long}{}", k + 1), String::from)
        };
        let crossing = |k: usize| letter(b'i', k, 12, 'x');
        let mut of = BTreeMap::new();
        // Where two are at one place, the first one names it.
        let mut add = |at: DVec2, name: String| _ = of.entry(bits(at)).or_insert(name);
        let [subject, clip] = &operands.rings;
        subject.iter().flatten().enumerate().for_each(|(k, &at)| add(at, k.to_string()));
        clip.iter().flatten().enumerate().for_each(|(k, &at)| add(at, letter(b'a', k, 8, 'c')));
        // Crossings are named as they are met round the clip; the subject's list has all others.
        let met = |wanted: Operand| {
            steps.iter().filter_map(move |step| match *step {
                Step::Listed { list, at, mark: Some(_) } if list == wanted => Some(at),
                _ => None,
            })
        };
        let mut all: Vec<DVec2> = met(Operand::Clip).collect();
        let mut known: BTreeSet<_> = all.iter().copied().map(bits).collect();
        all.extend(met(Operand::Subject).filter(|&at| known.insert(bits(at))));
        all.iter().enumerate().for_each(|(k, &at)| add(at, crossing(k)));
        Self { of, other: crossing(all.len()) }
    }

    fn of(&self, at: DVec2) -> &str {
        self.of.get(&bits(at)).unwrap_or(&self.other)
    }
}

/// Returns the bits of coordinates, the same for both zeros.
fn bits(at: DVec2) -> [u64; 2] {
    (at + 0.0).to_array().map(f64::to_bits)
}

/// The most points of a ring that a sentence names.
const MOST_NAMED: usize = 40;

impl State {
    fn name(&self, at: DVec2) -> String {
        self.names.of(at).to_owned()
    }

    fn names(&self, points: &[DVec2]) -> Value {
        Value::List(points.iter().map(|&p| self.name(p).into()).collect())
    }

    /// Returns the names of points for a sentence, which has only the ends of a long ring.
    fn ends(&self, points: &[DVec2]) -> Value {
        if points.len() <= MOST_NAMED {
            return self.names(points);
        }
        let first = self.names(&points[..MOST_NAMED / 2]);
        let last = self.names(&points[points.len() - MOST_NAMED / 2..]);
        Value::List(vec![first, "…".into(), last])
    }

    fn show(&mut self, step: &Step, want: Want) -> Shown {
        let caption = self.take(step);
        want.shown(
            step.line(),
            caption,
            || self.table(),
            || {
                let mut picture = self.picture();
                match step {
                    Step::Listed { at, .. }
                    | Step::Start { at }
                    | Step::Passed { at, .. }
                    | Step::Crossing { at, .. }
                    | Step::Turn { at, .. } => {
                        picture.dot(*at, Look::Now);
                    }
                    Step::Ring { .. } | Step::CrossingRings => {}
                }
                picture
            },
        )
    }

    fn take(&mut self, step: &Step) -> Caption {
        match step {
            Step::CrossingRings => CROSSING_RINGS.with([]),
            Step::Listed { list, at, mark } => self.listed(*list, *at, *mark),
            Step::Crossing { at, entry } => {
                let template = if *entry { &ENTRY } else { &EXIT };
                template.with([("name", self.name(*at).into())])
            }
            Step::Start { at } => {
                self.ring.clear();
                START.with([("name", self.name(*at).into())])
            }
            Step::Turn { at, to_subject } => {
                let template = if *to_subject { &ONTO_SUBJECT } else { &ONTO_CLIP };
                template.with([("name", self.name(*at).into())])
            }
            Step::Passed { list, at } => {
                self.ring.push(*at);
                let values = [
                    ("name", self.name(*at).into()),
                    ("list", operand(*list)),
                    ("ring", self.ends(&self.ring)),
                ];
                PASSED.with(values)
            }
            Step::Ring { points } => {
                self.rings.push(points.clone());
                self.ring.clear();
                RING.with([("number", self.rings.len().into()), ("ring", self.ends(points))])
            }
        }
    }

    fn listed(&mut self, list: Operand, at: DVec2, mark: Option<CrossingMark>) -> Caption {
        self.lists[usize::from(list == Operand::Clip)].push((at, mark));
        let values = [("list", operand(list)), ("name", self.name(at).into()), ("at", at.into())];
        let Some(mark) = mark else { return LISTED.with(values) };
        let word = match mark {
            CrossingMark::Entering => Word::new("entering", "betritt sie"),
            CrossingMark::Leaving => Word::new("leaving", "verlässt sie"),
        };
        let mut caption = LISTED_CROSSING.with(values);
        caption.values.push(("mark", word.into()));
        caption
    }

    fn table(&self) -> Table {
        let order =
            Word::new("in order; ↓ enters, ↑ leaves", "der Reihe nach; ↓ tritt ein, ↑ tritt aus");
        let mut table = Table::new([Word::new("list", "Liste"), order]);
        for (list, name) in self.lists.iter().zip([SUBJECT, CLIP]) {
            let marked = |&(at, mark): &(DVec2, Option<CrossingMark>)| {
                let arrow = match mark {
                    None => "",
                    Some(CrossingMark::Entering) => "↓",
                    Some(CrossingMark::Leaving) => "↑",
                };
                Value::from(self.name(at) + arrow)
            };
            table.row(name, [Value::List(list.iter().map(marked).collect())]);
        }
        table.row(Word::new("ring", "Ring"), [self.names(&self.ring)]);
        let rings = self
            .rings
            .iter()
            .map(|ring| Value::List(vec!["{".into(), self.names(ring), "}".into()]));
        table.row(Word::new("done", "fertig"), [Value::List(rings.collect())]);
        table
    }

    /// Adds a dot with its name to the upper right, where edges of rectangles do not run.
    fn add_named(&self, picture: &mut Picture, at: DVec2, look: Look) {
        picture.dot(at, look);
        picture.label(at, (9.0, -10.0), self.name(at));
    }

    fn picture(&self) -> Picture {
        let mut picture = self.operands.picture();
        picture.rings(&self.rings, Look::Result);
        picture.chain(self.ring.clone(), Look::Result);
        for (list, look) in self.lists.iter().zip([Look::First, Look::Second]) {
            let plain = list.iter().filter(|(_, mark)| mark.is_none());
            plain.for_each(|&(at, _)| self.add_named(&mut picture, at, look));
        }
        let listed = self.lists.iter().flatten().filter(|(_, mark)| mark.is_some());
        let mut shown = BTreeSet::new();
        for &(at, _) in listed.filter(|&&(at, _)| shown.insert(bits(at))) {
            self.add_named(&mut picture, at, Look::Result);
        }
        picture
    }
}

fn operand(list: Operand) -> Value {
    match list {
        Operand::Subject => SUBJECT,
        Operand::Clip => CLIP,
    }
    .into()
}
