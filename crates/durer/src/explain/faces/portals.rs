//! The lesson of cells and portals: a plan of rooms from above, and the rooms visible through doors.

use crate::clip::polygon::WindingRule;
use crate::clip::polygon::point::winding_number;
use crate::explain::frame::{Frames, Shown, Want, record};
use crate::explain::grid::letter;
use crate::explain::input::{Figure, Input};
use crate::explain::lesson::{Example, Lesson};
use crate::explain::picture::{Look, Picture};
use crate::explain::table::Table;
use crate::explain::words::{Caption, Template, Value, Word};
use crate::math::{DVec2, DVec3};
use crate::trace::{NoTrace, PseudocodeLine};
use crate::visibility::polygons::Screen;
use crate::visibility::polygons::portals::{
    INFO, Options, Plan, PlanEye, PortalWindow, Step, Visit, visits,
};
use crate::{Error, Result};

pub(super) const LESSON: Lesson = Lesson {
    name: INFO.name,
    info: &INFO,
    takes: TAKES,
    examples: &[
        Example {
            name: "rooms",
            title: Word::new(
                "six rooms, five of them visible",
                "sechs Räume, von denen man fünf sieht",
            ),
            input: || {
                let rooms = [
                    [0.0, 0.0, 6.0, 4.0],
                    [6.0, 0.0, 10.0, 4.0],
                    [0.0, 4.0, 4.0, 8.0],
                    [4.0, 4.0, 10.0, 8.0],
                    [0.0, 8.0, 5.0, 12.0],
                    [5.0, 8.0, 10.0, 12.0],
                ];
                let doors = [
                    [1.0, 4.0, 2.0, 4.0],
                    [4.5, 4.0, 5.5, 4.0],
                    [6.0, 2.5, 6.0, 3.5],
                    [4.0, 6.0, 4.0, 7.0],
                    [5.5, 8.0, 7.0, 8.0],
                    [0.5, 8.0, 1.5, 8.0],
                    [5.0, 10.0, 5.0, 11.0],
                ];
                plan(&rooms, &doors, (4.0, 1.0))
            },
        },
        Example {
            name: "row",
            title: Word::new(
                "doors in a row: smaller windows, the last one empty",
                "Türen hintereinander: immer kleinere Fenster, das letzte leer",
            ),
            input: || {
                let room = |k: f64| [0.0, 4.0 * k, 8.0, 4.0 * k + 4.0];
                let rooms = [0.0, 1.0, 2.0, 3.0].map(room);
                let doors = [[2.0, 4.0, 5.0, 4.0], [4.0, 8.0, 6.0, 8.0], [1.0, 12.0, 3.0, 12.0]];
                plan(&rooms, &doors, (3.0, 1.0))
            },
        },
        Example::new("alone", "one room without a door", "ein Raum ohne Tür", || {
            plan(&[[0.0, 0.0, 8.0, 6.0]], &[], (4.0, 1.0))
        }),
        Example::new(
            "behind",
            "a door behind the eye, and one before it",
            "eine Tür hinter dem Auge, und eine davor",
            || {
                let rooms = [[0.0, 4.0, 8.0, 8.0], [0.0, 0.0, 8.0, 4.0], [0.0, 8.0, 8.0, 12.0]];
                plan(&rooms, &[[3.0, 4.0, 5.0, 4.0], [3.0, 8.0, 5.0, 8.0]], (4.0, 5.0))
            },
        ),
        Example::new(
            "two-doors",
            "two doors to one room: it is drawn in both windows",
            "zwei Türen in einen Raum: Er wird in beiden Fenstern gezeichnet",
            || {
                let rooms = [[0.0, 0.0, 10.0, 4.0], [0.0, 4.0, 10.0, 9.0]];
                plan(&rooms, &[[2.0, 4.0, 4.0, 4.0], [6.0, 4.0, 8.0, 4.0]], (5.0, 1.0))
            },
        ),
        Example::new(
            "corner",
            "round a corner: the third room is not seen",
            "um die Ecke: Der dritte Raum ist nicht zu sehen",
            || {
                let rooms = [[0.0, 0.0, 4.0, 4.0], [0.0, 4.0, 4.0, 8.0], [4.0, 4.0, 9.0, 8.0]];
                plan(&rooms, &[[0.5, 4.0, 1.5, 4.0], [4.0, 7.2, 4.0, 7.8]], (3.0, 1.0))
            },
        ),
    ],
    templates: &[&FIRST, &ENTER, &BACK, &BEHIND, &EDGE_ON, &EMPTY, &SEEN],
    unreached: &[],
    make: |_, input, _, cap| make(input, cap),
};

const TAKES: Word = Word::new(
    "convex rooms as rings, doors as lines of two points, and the eye as a point, which looks up",
    "konvexe Räume als Ringe, Türen als Strecken und das Auge als Punkt, das nach oben blickt",
);

/// Returns rectangular rooms with their corners, doors with their ends, and an eye.
fn plan(rooms: &[[f64; 4]], doors: &[[f64; 4]], eye: (f64, f64)) -> Input {
    let p = DVec2::new;
    let room = |&[x0, y0, x1, y1]: &[f64; 4]| vec![p(x0, y0), p(x1, y0), p(x1, y1), p(x0, y1)];
    let door = |&[x0, y0, x1, y1]: &[f64; 4]| vec![p(x0, y0), p(x1, y1)];
    Input::Figure(Figure {
        rings: rooms.iter().map(room).collect(),
        lines: doors.iter().map(door).collect(),
        points: vec![eye.into()],
        ..Figure::default()
    })
}

static FIRST: Template = Template::new(
    "enter",
    "The eye is in {cell}: its walls are drawn in the whole picture, columns {from} to {to}.",
    "Das Auge ist in {cell}: Seine Wände werden im ganzen Bild gezeichnet, Spalten {from} bis {to}.",
);
static ENTER: Template = Template::new(
    "enter",
    "Enter {cell}, portals on the way: {portals}. Its walls are drawn in columns {from} to {to} alone.",
    "Weiter in {cell}, Portale auf dem Weg: {portals}. Seine Wände werden nur in den Spalten {from} bis {to} gezeichnet.",
);
static BACK: Template = Template::new(
    "back",
    "A portal of {cell} leads back to {to}, which is on the way: next portal.",
    "Ein Portal von {cell} führt zurück nach {to}, das auf dem Weg liegt: nächstes Portal.",
);
static BEHIND: Template = Template::new(
    "portal",
    "The portal from {cell} to {to} is behind the eye: not seen.",
    "Das Portal von {cell} nach {to} liegt hinter dem Auge: nicht zu sehen.",
);
static EDGE_ON: Template = Template::new(
    "portal",
    "The portal from {cell} to {to} covers no pixel: {to} is not entered.",
    "Das Portal von {cell} nach {to} bedeckt kein Pixel: {to} wird nicht betreten.",
);
static EMPTY: Template = Template::new(
    "portal",
    "The portal from {cell} to {to} is at columns {from} to {until}, outside the window: {to} is not entered.",
    "Das Portal von {cell} nach {to} liegt in den Spalten {from} bis {until}, außerhalb des Fensters: {to} wird nicht betreten.",
);
static SEEN: Template = Template::new(
    "portal",
    "The portal from {cell} to {to} is at columns {from} to {until}; with the window {low} to {high} are left.",
    "Das Portal von {cell} nach {to} liegt in den Spalten {from} bis {until}; mit dem Fenster bleiben {low} bis {high}.",
);

/// Size of the picture, pixels; the view is 90 degrees wide.
const SIZE: [u32; 2] = [40, 20];
const FOCAL: f64 = 20.0;

/// More visits than anyone follows.
const OPTIONS: Options = Options { max_visits: 1 << 14 };

/// The plan with the visits so far.
#[derive(Clone)]
struct State {
    rooms: Vec<Vec<DVec2>>,
    doors: Vec<[DVec2; 2]>,
    plan: Plan,
    eye: DVec2,
    seen: Vec<Visit>,
    window: Option<PortalWindow>,
}

fn make(input: &Input, cap: usize) -> Result<Frames> {
    let figure = input.figure(TAKES)?;
    figure.ring(TAKES)?;
    let missing = |what: &str| Error::parameter("input", format!("without {what}"), TAKES.en);
    let rooms = figure.rings.clone();
    let ends = |line: &Vec<DVec2>| Some([*line.first()?, *line.last()?]);
    let doors: Vec<[DVec2; 2]> = figure.lines.iter().filter_map(ends).collect();
    let eye = *figure.points.first().ok_or_else(|| missing("an eye"))?;
    let inside = |room: &Vec<DVec2>| {
        let turns = winding_number([room.as_slice()], eye, &mut NoTrace);
        turns.is_none_or(|turns| WindingRule::NonZero.fills(turns))
    };
    let cell = rooms.iter().position(inside).ok_or_else(|| missing("a room around the eye"))?;
    let plan = Plan::of_rooms(&rooms, &doors, 2.0)?;
    let from = PlanEye { at: DVec3::new(eye.x, 0.0, eye.y), cell, focal: FOCAL };
    let screen = Screen { width: SIZE[0], height: SIZE[1], ..Screen::default() };
    let steps = record(cap, |t| visits(&plan, &from, &screen, &OPTIONS, t))?;
    let mut state = State { rooms, doors, plan, eye, seen: Vec::new(), window: None };
    Ok(Frames::new(steps, move |step, want| state.show(step, want)))
}

impl State {
    fn show(&mut self, step: &Step, want: Want) -> Shown {
        let caption = self.take(step);
        want.shown(step.line(), caption, || self.table(), || self.picture(step))
    }

    /// Returns the cell that a portal leads to.
    fn behind(&self, cell: usize, portal: usize) -> Option<usize> {
        Some(self.plan.cells().get(cell)?.portals.get(portal)?.to)
    }

    fn take(&mut self, step: &Step) -> Caption {
        match *step {
            Step::Enter(visit) => {
                self.seen.push(visit);
                self.window = Some(visit.window);
                let [from, to] = columns(visit.window);
                let template = if visit.portals == 0 { &FIRST } else { &ENTER };
                template.with([
                    ("cell", letter(visit.cell).into()),
                    ("portals", visit.portals.into()),
                    ("from", from),
                    ("to", to),
                ])
            }
            Step::Back { cell, portal } => {
                let to = self.behind(cell, portal).map_or_else(String::new, letter);
                BACK.with([("cell", letter(cell).into()), ("to", to.into())])
            }
            Step::Portal { cell, portal, bounds, window } => {
                let to = self.behind(cell, portal).map_or_else(String::new, letter);
                let (cell, to) = (("cell", letter(cell).into()), ("to", to.into()));
                let Some(around) = bounds else {
                    return BEHIND.with([cell, to]);
                };
                if (0..2).any(|k| around.low[k] >= around.high[k]) {
                    return EDGE_ON.with([cell, to]);
                }
                let [from, until] = columns(around);
                let (from, until) = (("from", from), ("until", until));
                match window.map(columns) {
                    None => EMPTY.with([cell, to, from, until]),
                    Some([low, high]) => {
                        SEEN.with([cell, to, from, until, ("low", low), ("high", high)])
                    }
                }
            }
        }
    }

    fn table(&self) -> Table {
        let mut table = Table::new([
            Word::new("visit", "Besuch"),
            Word::new("room", "Raum"),
            Word::new("portals", "Portale"),
            Word::new("columns", "Spalten"),
        ]);
        for (number, visit) in self.seen.iter().enumerate() {
            let columns = Value::List(columns(visit.window).into());
            table.row(number + 1, [letter(visit.cell).into(), visit.portals.into(), columns]);
        }
        table
    }

    fn picture(&self, step: &Step) -> Picture {
        let mut picture = Picture::around(self.rooms.iter().flatten().copied(), 0.06);
        let now = match *step {
            Step::Enter(Visit { cell, .. }) => cell,
            Step::Back { cell, .. } | Step::Portal { cell, .. } => cell,
        };
        for (room, ring) in self.rooms.iter().enumerate() {
            let seen = self.seen.iter().any(|visit| visit.cell == room);
            if room == now {
                picture.ring(ring.clone(), Look::First);
            } else if seen {
                picture.ring(ring.clone(), Look::Result);
            }
            let closed: Vec<DVec2> = ring.iter().chain(ring.first()).copied().collect();
            picture.chain(closed, Look::Window);
            let middle = ring.iter().sum::<DVec2>() / ring.len().max(1) as f64;
            picture.label(middle, (0.0, 0.0), letter(room));
        }
        for door in &self.doors {
            picture.chain(*door, Look::Second);
        }
        if let Step::Back { cell, portal } | Step::Portal { cell, portal, .. } = *step {
            let own = self.plan.cells().get(cell).and_then(|cell| cell.portals.get(portal));
            if let Some([a, b, ..]) = own.map(|portal| portal.corners.as_slice()) {
                picture.chain([a, b].map(|p| DVec2::new(p.x, p.z)), Look::Now);
            }
        }
        if let Some(window) = self.shown(step) {
            let far = (picture.extent[1] - picture.extent[0]).length();
            for column in [window.low[0], window.high[0]] {
                let aside = (f64::from(column) - f64::from(SIZE[0]) / 2.0) / FOCAL;
                let way = DVec2::new(aside, 1.0).normalize() * far;
                picture.chain([self.eye, self.eye + way], Look::Dashed);
            }
        }
        picture.dot(self.eye, Look::Now);
        picture
    }

    /// Returns the window whose borders are drawn: that of a portal, or of the last cell entered.
    fn shown(&self, step: &Step) -> Option<PortalWindow> {
        match *step {
            Step::Portal { bounds, window, .. } => window.or(bounds),
            Step::Enter(_) | Step::Back { .. } => self.window,
        }
    }
}

/// Returns the first and the last column of a window.
fn columns(window: PortalWindow) -> [Value; 2] {
    [window.low[0].into(), window.high[0].saturating_sub(1).into()]
}
