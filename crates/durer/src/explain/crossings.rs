//! The lesson of Bentley and Ottmann's sweep.

use super::frame::{Frames, record};
use super::grid::letter;
use super::input::{Figure, Input};
use super::lesson::{Example, Lesson};
use super::picture::{Look, Picture};
use super::table::Table;
use super::words::{Caption, Template, Value, Word};
use crate::clip::crossings::bentley_ottmann::{INFO, Neighbours, Step, crossings};
use crate::clip::crossings::{Crossing, Options};
use crate::clip::line::Segment;
use crate::math::DVec2;
use crate::trace::PseudocodeLine;
use crate::{Error, Result};

pub(super) const LESSON: Lesson = Lesson {
    name: INFO.name,
    info: &INFO,
    takes: TAKES,
    examples: &[
        Example {
            name: "four",
            title: Word::new("four segments, four crossings", "vier Strecken, vier Schnittpunkte"),
            input: || {
                segments(&[
                    [0.0, 1.0, 10.0, 6.0],
                    [0.0, 5.0, 10.0, 2.0],
                    [1.0, 7.0, 9.0, 0.0],
                    [3.0, 0.0, 8.0, 7.0],
                ])
            },
        },
        Example {
            name: "one-point",
            title: Word::new(
                "three in one point, one of them vertical",
                "drei in einem Punkt, eine davon senkrecht",
            ),
            input: || segments(&[[0.0, 0.0, 8.0, 8.0], [0.0, 8.0, 8.0, 0.0], [4.0, 1.0, 4.0, 9.0]]),
        },
        Example {
            name: "overlap",
            title: Word::new(
                "two on one line, and a third that ends on them",
                "zwei auf einer Geraden, und eine dritte, die auf ihnen endet",
            ),
            input: || {
                segments(&[[0.0, 1.0, 6.0, 4.0], [2.0, 2.0, 10.0, 6.0], [3.0, 6.0, 4.0, 3.0]])
            },
        },
        Example {
            name: "apart",
            title: Word::new(
                "neighbours that never meet are tested once",
                "Nachbarn, die sich nie treffen, werden einmal geprüft",
            ),
            input: || segments(&[[0.0, 0.0, 9.0, 1.0], [1.0, 2.0, 8.0, 3.0], [2.0, 5.0, 7.0, 4.0]]),
        },
        Example::new(
            "grid",
            "three across three: nine crossings",
            "drei über drei: neun Schnittpunkte",
            || {
                segments(&[
                    [0.0, 1.0, 9.0, 2.0],
                    [0.0, 3.0, 9.0, 4.0],
                    [0.0, 5.0, 9.0, 6.0],
                    [1.0, 0.0, 2.0, 8.0],
                    [4.0, 0.0, 5.0, 8.0],
                    [7.0, 0.0, 8.0, 8.0],
                ])
            },
        ),
        Example::new(
            "fan",
            "four that begin at one point",
            "vier, die an einem Punkt beginnen",
            || {
                segments(&[
                    [0.0, 4.0, 9.0, 0.0],
                    [0.0, 4.0, 9.0, 3.0],
                    [0.0, 4.0, 9.0, 5.0],
                    [0.0, 4.0, 9.0, 8.0],
                ])
            },
        ),
    ],
    templates: &[&ENDS, &EVENT, &REPORT, &STATUS, &FOUND, &KNOWN, &APART],
    unreached: &[],
    make: |_, input, _, cap| make(input, cap),
};

const TAKES: Word = Word::new(
    "segments: lines of two or more points",
    "Strecken: Linien aus zwei oder mehr Punkten",
);

/// The most segments that get letters of their own.
const MOST: usize = 200;

static ENDS: Template = Template::new(
    "ends",
    "The ends of {segment} go into the queue: {from} and {to}.",
    "Die Enden von {segment} kommen in die Warteschlange: {from} und {to}.",
);
static EVENT: Template = Template::new(
    "event",
    "The sweep comes to {at}. Beginning: {begin}; ending: {end}; going through: {through}.",
    "Die Sweepline erreicht {at}. Es beginnen: {begin}; es enden: {end}; es gehen hindurch: {through}.",
);
static REPORT: Template = Template::new(
    "report",
    "{segments} meet at {at}: a crossing.",
    "{segments} treffen sich in {at}: ein Schnittpunkt.",
);
static STATUS: Template = Template::new(
    "status",
    "Just right of the point the status is, from below to above: {order}.",
    "Rechts neben dem Punkt lautet der Status von unten nach oben: {order}.",
);
static FOUND: Template = Template::new(
    "test",
    "{place} {a} and {b} are tested: they meet at {meet}, which goes into the queue.",
    "{place} werden {a} und {b} geprüft: Sie treffen sich in {meet}, das kommt in die Warteschlange.",
);
static KNOWN: Template = Template::new(
    "test",
    "{place} {a} and {b} are tested: they meet at {meet}, which is in the queue.",
    "{place} werden {a} und {b} geprüft: Sie treffen sich in {meet}, das schon in der Warteschlange steht.",
);
static APART: Template = Template::new(
    "test",
    "{place} {a} and {b} are tested: they meet at no later point.",
    "{place} werden {a} und {b} geprüft: Sie treffen sich in keinem späteren Punkt.",
);

/// Returns an input of segments, each x and y of its two ends.
fn segments(ends: &[[f64; 4]]) -> Input {
    let line = |&[a, b, c, d]: &[f64; 4]| vec![DVec2::new(a, b), DVec2::new(c, d)];
    Input::Figure(Figure { lines: ends.iter().map(line).collect(), ..Figure::default() })
}

/// State of the sweep.
#[derive(Clone)]
struct State {
    segments: Vec<Segment<DVec2>>,
    /// Points to come, in their order.
    queue: Vec<DVec2>,
    status: Vec<u32>,
    at: Option<DVec2>,
    found: Vec<Crossing>,
    tested: Option<[u32; 2]>,
}

fn make(input: &Input, cap: usize) -> Result<Frames> {
    let lines = &input.figure(TAKES)?.lines;
    let pairs = lines.iter().flat_map(|line| line.windows(2));
    let segments: Vec<_> = pairs.map(|pair| Segment::new(pair[0], pair[1])).collect();
    if segments.is_empty() {
        return Err(Error::parameter("input", "without a segment", TAKES.en));
    }
    if segments.len() > MOST {
        let (value, limit) = (segments.len() as u64, MOST as u64);
        return Err(Error::Limit { what: "number of segments to be explained", value, limit });
    }
    let steps = record(cap, |t| crossings(&segments, &Options::default(), t))?;
    let (queue, status, found) = (Vec::new(), Vec::new(), Vec::new());
    let mut state = State { segments, queue, status, at: None, found, tested: None };
    Ok(Frames::new(steps, move |step, want| {
        let caption = state.take(step);
        want.shown(step.line(), caption, || state.table(), || state.picture(step))
    }))
}

impl State {
    fn take(&mut self, step: &Step) -> Caption {
        self.tested = None;
        match step {
            Step::Ends { segment, ends } => {
                ends.iter().for_each(|end| self.enqueue(*end));
                let [from, to] = ends.map(Value::from);
                ENDS.with([("segment", name(*segment)), ("from", from), ("to", to)])
            }
            Step::Event { at, begin, end, through } => {
                self.at = Some(*at);
                self.queue.retain(|point| point != at);
                let [begin, end, through] = [begin, end, through].map(|all| names(all));
                let values = [("begin", begin), ("end", end), ("through", through)];
                let [begin, end, through] = values;
                EVENT.with([("at", (*at).into()), begin, end, through])
            }
            Step::Report(crossing) => {
                self.found.push(crossing.clone());
                let at = ("at", crossing.at.into());
                REPORT.with([("segments", names(&crossing.segments)), at])
            }
            Step::Status { order } => {
                self.status.clone_from(order);
                STATUS.with([("order", names(order))])
            }
            Step::Test { place, pair, meet, is_new } => {
                self.tested = Some(*pair);
                let [a, b] = pair.map(name);
                let place = match place {
                    Neighbours::Around => Word::new("Now neighbours,", "Als neue Nachbarn"),
                    Neighbours::Below => Word::new("Below the point,", "Unterhalb des Punkts"),
                    Neighbours::Above => Word::new("Above the point,", "Oberhalb des Punkts"),
                };
                let [place, a, b] = [("place", place.into()), ("a", a), ("b", b)];
                let Some(meet) = *meet else { return APART.with([place, a, b]) };
                if *is_new {
                    self.enqueue(meet);
                }
                let template = if *is_new { &FOUND } else { &KNOWN };
                template.with([place, a, b, ("meet", meet.into())])
            }
        }
    }

    fn enqueue(&mut self, point: DVec2) {
        let key = |p: &DVec2| (p.x, p.y);
        let place = self.queue.partition_point(|other| key(other) < key(&point));
        if self.queue.get(place) != Some(&point) {
            self.queue.insert(place, point);
        }
    }

    /// Returns queue, status and crossings.
    fn table(&self) -> Table {
        let mut table = Table::new([Word::new("list", "Liste"), Word::new("content", "Inhalt")]);
        let few = |points: &[DVec2]| {
            let mut list: Vec<Value> = points.iter().take(6).map(|p| (*p).into()).collect();
            if points.len() > 6 {
                list.push("…".into());
            }
            Value::List(list)
        };
        table.row(Word::new("queue", "Warteschlange"), [few(&self.queue)]);
        table.row(Word::new("status", "Status"), [names(&self.status)]);
        let first = self.found.len().saturating_sub(8);
        for (number, crossing) in self.found.iter().enumerate().skip(first) {
            let value = Value::List(vec![crossing.at.into(), names(&crossing.segments)]);
            table.row(number + 1, [value]);
        }
        table
    }

    fn picture(&self, step: &Step) -> Picture {
        let ends = self.segments.iter().flat_map(|segment| [segment.start, segment.end]);
        let mut picture = Picture::around(ends, 0.1);
        for (number, segment) in self.segments.iter().enumerate() {
            let number = number as u32;
            let look = if self.tested.is_some_and(|pair| pair.contains(&number)) {
                Look::Now
            } else if self.status.contains(&number) {
                Look::First
            } else {
                Look::Pale
            };
            picture.chain([segment.start, segment.end], look);
            let along = (segment.end - segment.start).normalize_or(DVec2::X) * 10.0;
            picture.label(segment.start, (-along.x, along.y), name(number));
        }
        let [low, high] = picture.extent;
        if let Some(at) = self.at {
            picture.chain([DVec2::new(at.x, low.y), DVec2::new(at.x, high.y)], Look::Dashed);
        }
        self.queue.iter().for_each(|point| picture.dot(*point, Look::Pale));
        self.found.iter().for_each(|crossing| picture.dot(crossing.at, Look::Result));
        match step {
            Step::Event { at, .. } => picture.dot(*at, Look::Now),
            Step::Test { meet: Some(meet), .. } => picture.dot(*meet, Look::Second),
            _ => {}
        }
        picture
    }
}

fn name(segment: u32) -> Value {
    letter(segment as usize).into()
}

fn names(segments: &[u32]) -> Value {
    Value::List(segments.iter().map(|segment| name(*segment)).collect())
}
