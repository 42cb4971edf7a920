//! The lesson of Warnock's subdivision, on the triangles of faces.

use super::triangles::Triangles;
use super::{EXAMPLES, Scene, TAKES};
use crate::Result;
use crate::explain::frame::{Frames, Shown, frames, record};
use crate::explain::grid::color;
use crate::explain::input::Input;
use crate::explain::lesson::Lesson;
use crate::explain::picture::{Look, Picture};
use crate::explain::table::Table;
use crate::explain::words::{Caption, Template, Value, Word};
use crate::math::DVec2;
use crate::shade::PreparedLights;
use crate::target::Framebuffer;
use crate::visibility::surface::Cull;
use crate::visibility::surface::cover::Window;
use crate::visibility::surface::input::SurfaceInput;
use crate::visibility::surface::setup::Filter;
use crate::visibility::surface::warnock::{INFO, Options, Step, render};

pub(super) const LESSON: Lesson = Lesson {
    name: INFO.name,
    info: &INFO,
    takes: TAKES,
    examples: EXAMPLES,
    templates: &[&BEGIN, &LOOK_AT, &EMPTY, &SINGLE, &SURROUNDED, &SAMPLE, &NO_SAMPLE, &DIVIDE],
    unreached: &[(
        "sample",
        "a triangle over the only centre of a window surrounds it: rule 4 is left where rounding cannot tell depths apart",
    )],
    make: |_, input, _, cap| make(input, cap),
};

static BEGIN: Template = Template::new(
    "begin",
    "The whole picture is the first window.",
    "Das ganze Bild ist das erste Fenster.",
);
static LOOK_AT: Template = Template::new(
    "look",
    "A window of {width} × {height} pixels at {at}: {count} triangles concern it.",
    "Ein Fenster von {width} × {height} Pixeln bei {at}: {count} Dreiecke betreffen es.",
);
static EMPTY: Template = Template::new(
    "empty",
    "Rule 1: all triangles are outside, so the window shows the background.",
    "Regel 1: Alle Dreiecke liegen außerhalb, das Fenster zeigt den Hintergrund.",
);
static SINGLE: Template = Template::new(
    "single",
    "Rule 2: only {triangle} concerns the window, so its part is drawn.",
    "Regel 2: Nur {triangle} betrifft das Fenster, sein Teil wird gezeichnet.",
);
static SURROUNDED: Template = Template::new(
    "surrounded",
    "Rule 3: {triangle} surrounds the window and hides all others, so the window is filled.",
    "Regel 3: {triangle} umgibt das Fenster und verdeckt alle anderen, das Fenster wird gefüllt.",
);
static SAMPLE: Template = Template::new(
    "sample",
    "Rule 4: the window is one pixel, {at}: {triangle} is nearest there.",
    "Regel 4: Das Fenster ist ein Pixel, {at}: Dort liegt {triangle} vorn.",
);
static NO_SAMPLE: Template = Template::new(
    "sample",
    "Rule 4: the window is one pixel, {at}: no triangle covers its centre.",
    "Regel 4: Das Fenster ist ein Pixel, {at}: Kein Dreieck bedeckt die Mitte.",
);
static DIVIDE: Template = Template::new(
    "divide",
    "No rule holds: the window is divided in four at {at}.",
    "Keine Regel gilt: Das Fenster wird bei {at} in vier geteilt.",
);
/// Windows that wait, and the decisions so far.
struct Windows {
    scene: Scene,
    triangles: Triangles,
    /// Items of the input's triangles, which a fan's parts have in the order of the scene.
    items: Vec<u32>,
    stack: Vec<Window>,
    now: Option<Window>,
    decided: Vec<(Window, Option<u32>)>,
}

fn make(input: &Input, cap: usize) -> Result<Frames> {
    let scene = Scene::new(input)?;
    let triangles = Triangles::new(&scene)?;
    let (model, view) = triangles.prepared(&scene)?;
    let surfaces = SurfaceInput::new(&model, &view, Filter::new(Cull::None, 0))?;
    let lights = PreparedLights::of(&model, view.camera());
    let mut target = Framebuffer::new(view.width(), view.height());
    let options = Options::default();
    let steps = record(cap, |t| {
        render(&surfaces, &lights, &options, &mut target, t);
        Ok(())
    })?;
    let items = surfaces.triangles.iter().map(|triangle| triangle.item).collect();
    let (stack, decided) = (Vec::new(), Vec::new());
    let mut windows = Windows { scene, triangles, items, stack, now: None, decided };
    Ok(frames(&steps, |step| windows.show(step)))
}

impl Windows {
    fn show(&mut self, step: &Step) -> Shown {
        let caption = self.take(step);
        Shown { line: step.line(), caption, table: self.table(), picture: self.picture() }
    }

    fn name(&self, triangle: u32) -> Value {
        let item = self.items.get(triangle as usize).copied().unwrap_or_default();
        self.triangles.name(item).into()
    }

    /// Returns a place with rows upwards.
    fn at(&self, x: i32, y: i32) -> DVec2 {
        DVec2::new(x.into(), f64::from(self.scene.raster.rows) - f64::from(y))
    }

    fn decide(&mut self, window: Window, triangle: Option<u32>) {
        self.decided.push((window, triangle));
        self.now = Some(window);
    }

    fn take(&mut self, step: &Step) -> Caption {
        match *step {
            Step::Begin { window, .. } => {
                self.stack = vec![window];
                self.now = Some(window);
                BEGIN.with([])
            }
            Step::Look { window, triangles } => {
                self.stack.retain(|other| *other != window);
                self.now = Some(window);
                let size = [window.x1 - window.x0, window.y1 - window.y0].map(Value::from);
                let [width, height] = size;
                let at = ("at", self.at(window.x0, window.y1).into());
                let count = ("count", triangles.into());
                LOOK_AT.with([("width", width), ("height", height), at, count])
            }
            Step::Empty { window } => {
                self.decide(window, None);
                EMPTY.with([])
            }
            Step::Single { window, triangle } => {
                self.decide(window, Some(triangle));
                SINGLE.with([("triangle", self.name(triangle))])
            }
            Step::Surrounded { window, triangle } => {
                self.decide(window, Some(triangle));
                SURROUNDED.with([("triangle", self.name(triangle))])
            }
            Step::Sample { x, y, triangle } => {
                let window = Window { x0: x, y0: y, x1: x + 1, y1: y + 1 };
                self.stack.retain(|other| *other != window);
                self.decide(window, triangle);
                let at = ("at", self.at(x, y + 1).into());
                match triangle {
                    Some(triangle) => SAMPLE.with([at, ("triangle", self.name(triangle))]),
                    None => NO_SAMPLE.with([at]),
                }
            }
            Step::Divide { window, x, y } => {
                let Window { x0, y0, x1, y1 } = window;
                let parts = [(x0, y0, x, y), (x, y0, x1, y), (x0, y, x, y1), (x, y, x1, y1)];
                let parts = parts.map(|(x0, y0, x1, y1)| Window { x0, y0, x1, y1 });
                self.stack.extend(parts.iter().rev().filter(|part| !part.is_empty()));
                DIVIDE.with([("at", self.at(x, y).into())])
            }
        }
    }

    /// Returns the windows that wait, the next one above.
    fn table(&self) -> Table {
        let heads =
            [Word::new("waits", "wartet"), Word::new("from", "von"), Word::new("to", "bis")];
        let mut table = Table::new(heads);
        for (place, window) in self.stack.iter().enumerate().rev() {
            let corners = [self.at(window.x0, window.y1), self.at(window.x1, window.y0)];
            table.row(place + 1, corners.map(Value::from));
        }
        table
    }

    fn frame(&self, window: &Window) -> Vec<DVec2> {
        let Window { x0, y0, x1, y1 } = *window;
        [(x0, y0), (x1, y0), (x1, y1), (x0, y1), (x0, y0)].map(|(x, y)| self.at(x, y)).to_vec()
    }

    fn picture(&self) -> Picture {
        let mut picture = self.scene.raster.picture();
        let rows = self.scene.raster.rows as i32;
        for (window, triangle) in &self.decided {
            let item = triangle.and_then(|triangle| self.items.get(triangle as usize));
            let Some(&item) = item else { continue };
            let color = color(self.triangles.face(item));
            for y in window.y0..window.y1 {
                for x in (window.x0..window.x1).filter(|&x| self.covers(item, x, y)) {
                    picture.colored([x, rows - 1 - y], color, "");
                }
            }
        }
        self.decided.iter().for_each(|(window, _)| picture.chain(self.frame(window), Look::Thin));
        for item in 0..self.triangles.corners.len() as u32 {
            picture.chain(self.triangles.outline(item), Look::Window);
        }
        self.now.iter().for_each(|window| picture.chain(self.frame(window), Look::Now));
        picture
    }

    /// Returns whether a triangle covers the centre of a pixel.
    fn covers(&self, item: u32, x: i32, y: i32) -> bool {
        let center = self.at(x, y + 1) + 0.5;
        let Some(corners) = self.triangles.corners.get(item as usize) else { return false };
        let flat = corners.map(|corner| corner.truncate());
        let weights = crate::raster::interpolate::barycentric_2d(flat, center);
        weights.is_some_and(|weights| weights.iter().all(|weight| *weight >= 0.0))
    }
}
