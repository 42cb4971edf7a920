//! The lesson of hidden lines by quantitative invisibility, on the triangles of faces.

use super::triangles::Triangles;
use super::{EXAMPLES, Scene, TAKES, slab};
use crate::Result;
use crate::explain::frame::{Frames, Shown, Want, record};
use crate::explain::input::Input;
use crate::explain::lesson::{Example, Lesson};
use crate::explain::picture::{Look, Picture};
use crate::explain::table::Table;
use crate::explain::words::{Caption, Template, Value, Word};
use crate::math::DVec2;
use crate::target::drawing::LineClass;
use crate::trace::PseudocodeLine;
use crate::visibility::line::Intersections;
use crate::visibility::line::edge_lines::ClassSet;
use crate::visibility::line::hidden_line::{HiddenSpan, INFO, Options, Step, draw};

pub(super) const LESSON: Lesson = Lesson {
    name: INFO.name,
    info: &INFO,
    takes: TAKES,
    examples: &[STRIP, EXAMPLES[0], EXAMPLES[2], EXAMPLES[1], EXAMPLES[3], EXAMPLES[5]],
    templates: &[&PAGE, &SEEN, &PARTLY, &HIDDEN],
    unreached: &[],
    make: |_, input, _, cap| make(input, cap),
};

pub(super) const STRIP: Example = Example {
    name: "strip",
    title: Word::new(
        "a strip behind two squares: Q = 0, 1, 2, 1, 0; D is hidden",
        "ein Streifen hinter zwei Quadraten: Q = 0, 1, 2, 1, 0; D ist verdeckt",
    ),
    input: || {
        let strip = slab((0.0, 2.0), (10.0, 3.0), (5.0, 5.0));
        let near = slab((2.0, 0.0), (6.0, 4.0), (3.0, 3.0));
        let middle = slab((4.0, 1.0), (8.0, 5.0), (4.0, 4.0));
        let behind = slab((2.5, 1.0), (3.5, 1.8), (6.0, 6.0));
        Input::Faces(vec![strip, near, middle, behind])
    },
};

static PAGE: Template = Template::new(
    "page",
    "The corners are projected to a fine grid of the page; from here on signs are exact.",
    "Die Ecken werden auf ein feines Gitter der Seite projiziert; von hier an sind Vorzeichen exakt.",
);
static SEEN: Template = Template::new(
    "line",
    "{class} from {p} to {q}; triangles compared: {tried}. None is in front: Q = 0, all of it is seen.",
    "{class} von {p} nach {q}; verglichene Dreiecke: {tried}. Keines liegt davor: Q = 0, alles ist zu sehen.",
);
static PARTLY: Template = Template::new(
    "line",
    "{class} from {p} to {q}; triangles compared: {tried}. Q changes at t = {cuts} and is {levels}.",
    "{class} von {p} nach {q}; verglichene Dreiecke: {tried}. Q ändert sich bei t = {cuts} und ist {levels}.",
);
static HIDDEN: Template = Template::new(
    "line",
    "{class} from {p} to {q}; triangles compared: {tried}. Q = {levels} from end to end: nothing of it is seen.",
    "{class} von {p} nach {q}; verglichene Dreiecke: {tried}. Q = {levels} von Ende zu Ende: Nichts davon ist zu sehen.",
);

/// A line whose parts are known.
#[derive(Clone)]
struct Known {
    ends: [DVec2; 2],
    spans: Vec<HiddenSpan>,
}

/// The faces and the lines so far.
#[derive(Clone)]
struct State {
    scene: Scene,
    triangles: Triangles,
    lines: Vec<Known>,
}

fn make(input: &Input, cap: usize) -> Result<Frames> {
    let scene = Scene::new(input)?;
    let triangles = Triangles::new(&scene)?;
    let (model, view) = triangles.prepared(&scene)?;
    let options = Options {
        intersections: Intersections::All,
        classes: ClassSet::default().with(LineClass::Intersection),
        ..Options::default()
    };
    let steps = record(cap, |t| draw(&model, &view, &options, t))?;
    let mut state = State { scene, triangles, lines: Vec::new() };
    Ok(Frames::new(steps, move |step, want| state.show(step, want)))
}

impl State {
    fn show(&mut self, step: &Step, want: Want) -> Shown {
        let caption = self.take(step);
        want.shown(step.line(), caption, || self.table(step), || self.picture(step))
    }

    /// Returns a place on the grid of a point of the picture's plane, whose origin is in the middle.
    fn at(&self, p: DVec2) -> DVec2 {
        p + DVec2::new(self.scene.raster.columns.into(), self.scene.raster.rows.into()) / 2.0
    }

    fn take(&mut self, step: &Step) -> Caption {
        let Step::Line { class, ends, tried, .. } = step else { return PAGE.with([]) };
        let ends = ends.map(|end| self.at(end));
        let [p, q] = ends.map(Value::from);
        let names: Vec<String> = tried.iter().map(|&item| self.triangles.name(item)).collect();
        let tried = if names.is_empty() { Word::new("none", "keine").into() } else { names.into() };
        let spans = step.spans();
        let cuts: Vec<f64> = spans.iter().skip(1).map(|span| span.from).collect();
        let levels: Vec<u32> = spans.iter().map(|span| span.invisibility).collect();
        self.lines.push(Known { ends, spans });
        let values = [("class", style(*class)), ("p", p), ("q", q), ("tried", tried)];
        let [class, p, q, tried] = values;
        match levels[..] {
            [] | [0] => SEEN.with([class, p, q, tried]),
            [_] => HIDDEN.with([class, p, q, tried, ("levels", levels.into())]),
            _ => {
                PARTLY.with([class, p, q, tried, ("cuts", cuts.into()), ("levels", levels.into())])
            }
        }
    }

    /// Returns what hides the line, face by face, and its parts.
    fn table(&self, step: &Step) -> Table {
        let heads = [
            Word::new("triangle or part", "Dreieck, Teil"),
            Word::new("from t", "von t"),
            Word::new("to t", "bis t"),
            Word::new("Q", "Q"),
        ];
        let mut table = Table::new(heads);
        if let Step::Line { covers, .. } = step {
            for cover in covers {
                let weight = if cover.weight < 0 { "−1" } else { "+1" };
                let cells = [cover.from.into(), cover.to.into(), weight.into()];
                table.row(self.triangles.name(cover.item), cells);
            }
        }
        let spans = self.lines.last().map(|line| &line.spans[..]).unwrap_or_default();
        for (number, span) in spans.iter().enumerate() {
            let cells = [span.from.into(), span.to.into(), span.invisibility.into()];
            table.row(number + 1, cells);
        }
        table
    }

    fn picture(&self, step: &Step) -> Picture {
        let corners = self.triangles.corners.iter().flatten().map(|corner| corner.truncate());
        let mut picture = Picture::around(corners, 0.1);
        for face in 0..self.scene.faces.len() {
            self.scene.outline(&mut picture, face, Look::Pale);
            let own = self.scene.faces.get(face).map(|face| face.outline()).unwrap_or_default();
            let inner = own.iter().sum::<DVec2>() / own.len().max(1) as f64;
            let first = own.first().copied().unwrap_or_default();
            // Beside both edges of the corner, however thin the face is.
            let way = (inner - first).signum();
            picture.label(first, (way.x * 11.0, -way.y * 10.0), super::name(face as u32));
        }
        let now = matches!(step, Step::Line { .. });
        let done = self.lines.len().saturating_sub(usize::from(now));
        for line in self.lines.iter().take(done) {
            for span in &line.spans {
                let look = if span.invisibility == 0 { Look::Window } else { Look::Dashed };
                picture.chain(part(line, span), look);
            }
        }
        if let Some(line) = self.lines.get(done) {
            picture.chain(line.ends, Look::Now);
            for span in &line.spans {
                let look = match span.invisibility {
                    0 => Look::Result,
                    1 => Look::First,
                    _ => Look::Second,
                };
                let ends = part(line, span);
                picture.chain(ends, look);
                picture.dot(ends[1], Look::Pale);
                picture.label((ends[0] + ends[1]) / 2.0, (0.0, -9.0), span.invisibility);
            }
            let [p, q] = line.ends;
            let along = (q - p).normalize_or(DVec2::X) * DVec2::new(22.0, 11.0);
            // Not by letters: Q is the invisibility.
            for (end, name, way) in [(p, "t = 0", -along), (q, "t = 1", along)] {
                picture.dot(end, Look::First);
                picture.label(end, (way.x, -way.y), name);
            }
        }
        picture
    }
}

/// Returns the ends of a part of a line.
fn part(line: &Known, span: &HiddenSpan) -> [DVec2; 2] {
    let [p, q] = line.ends;
    [span.from, span.to].map(|t| p + (q - p) * t)
}

/// Returns the name of a line's kind.
fn style(class: LineClass) -> Value {
    match class {
        LineClass::Border => Word::new("Border", "Rand").into(),
        LineClass::Contour | LineClass::Silhouette => Word::new("Silhouette", "Umriss").into(),
        LineClass::Crease => Word::new("Crease", "Knick").into(),
        LineClass::Intersection => Word::new("Intersection", "Durchdringung").into(),
        other => other.name().into(),
    }
}
