//! The lessons of the z-buffer as a plain loop, and of the painter's method.

use super::{DEPTH, EXAMPLES, FACE, Scene, TAKES, middle, name};
use crate::Result;
use crate::explain::frame::{Frames, Shown, Want, record};
use crate::explain::grid::color;
use crate::explain::input::Input;
use crate::explain::lesson::Lesson;
use crate::explain::picture::{Look, Picture};
use crate::explain::table::Table;
use crate::explain::words::{Caption, Template, Value, Word};
use crate::math::DVec2;
use crate::trace::PseudocodeLine;
use crate::visibility::polygons::{painter, z_buffer};

pub(super) const Z_BUFFER: Lesson = Lesson {
    name: z_buffer::INFO.name,
    info: &z_buffer::INFO,
    takes: TAKES,
    examples: EXAMPLES,
    templates: &[&CLEAR, &TURN, &NEARER, &FARTHER, &STORE],
    unreached: &[],
    make: |_, input, _, cap| by_pixels(input, cap),
};

pub(super) const PAINTER: Lesson = Lesson {
    name: painter::INFO.name,
    info: &painter::INFO,
    templates: &[&SORTED, &PAINT],
    make: |_, input, _, cap| by_order(input, cap),
    ..Z_BUFFER
};

static CLEAR: Template = Template::new(
    "clear",
    "All pixels are cleared: depth ∞, no face.",
    "Alle Pixel werden gelöscht: Tiefe ∞, keine Fläche.",
);
static TURN: Template = Template::new(
    "face",
    "Face {face} comes next, in the order given: the z-buffer needs no other.",
    "Fläche {face} ist an der Reihe, wie gegeben: Der z-Buffer braucht keine andere Reihenfolge.",
);
static NEARER: Template = Template::new(
    "compare",
    "Pixel {pixel}: {face} has depth {depth}, {stored} is stored. It is nearer.",
    "Pixel {pixel}: {face} hat die Tiefe {depth}, gespeichert ist {stored}. Sie liegt näher.",
);
static FARTHER: Template = Template::new(
    "compare",
    "Pixel {pixel}: {face} has depth {depth}, {stored} is stored. It is not nearer: nothing changes.",
    "Pixel {pixel}: {face} hat die Tiefe {depth}, gespeichert ist {stored}. Nicht näher: Nichts ändert sich.",
);
static STORE: Template = Template::new(
    "store",
    "Pixel {pixel}: depth {depth} and face {face} are stored.",
    "Pixel {pixel}: Tiefe {depth} und Fläche {face} werden gespeichert.",
);
static SORTED: Template = Template::new(
    "sorted",
    "Number {place} from the back is {face}: its farthest corner lies at {depth}.",
    "Nummer {place} von hinten ist {face}: Ihre fernste Ecke hat die Tiefe {depth}.",
);
static PAINT: Template = Template::new(
    "paint",
    "{face} is painted over pixels {first} to {last} of row {row}, whatever was there.",
    "{face} wird über die Pixel {first} bis {last} der Zeile {row} gemalt, was immer dort war.",
);

/// Contents of the z-buffer.
#[derive(Clone)]
struct Buffer {
    scene: Scene,
    depths: Vec<Option<f64>>,
    face: u32,
}

fn by_pixels(input: &Input, cap: usize) -> Result<Frames> {
    let scene = Scene::new(input)?;
    let steps = record(cap, |t| z_buffer::items(&scene.faces, &scene.screen(), t))?;
    let depths = vec![None; scene.items.len()];
    let mut buffer = Buffer { scene, depths, face: 0 };
    Ok(Frames::new(steps, move |step, want| buffer.show(step, want)))
}

impl Buffer {
    fn show(&mut self, step: &z_buffer::Step, want: Want) -> Shown {
        use z_buffer::Step;
        let mut row = None;
        let (caption, pixel) = match *step {
            Step::Clear => (CLEAR.with([]), None),
            Step::Face { face } => {
                self.face = face;
                (TURN.with([("face", name(face).into())]), None)
            }
            Step::Compare { pixel, depth, stored } => {
                let at = Value::from(DVec2::new(pixel[0].into(), pixel[1].into()));
                row = Some((name(self.face), [at.clone(), depth.into(), stored.into()]));
                let template = if depth < stored { &NEARER } else { &FARTHER };
                let values = [("depth", depth.into()), ("stored", stored.into())];
                let [depth, stored] = values;
                let face = ("face", name(self.face).into());
                (template.with([("pixel", at), face, depth, stored]), Some(pixel))
            }
            Step::Store { pixel, face, depth } => {
                let at = Value::from(DVec2::new(pixel[0].into(), pixel[1].into()));
                self.store(pixel, face, depth);
                row = Some((name(face), [at.clone(), depth.into(), depth.into()]));
                let face = ("face", name(face).into());
                (STORE.with([("pixel", at), ("depth", depth.into()), face]), Some(pixel))
            }
        };
        let heads = [FACE, Word::new("pixel", "Pixel"), DEPTH, Word::new("stored", "gespeichert")];
        let table = || {
            let mut table = Table::new(heads);
            row.into_iter().for_each(|(name, cells)| table.row(name, cells));
            table
        };
        want.shown(step.line(), caption, table, || self.picture(pixel))
    }

    fn store(&mut self, pixel @ [x, y]: [u32; 2], face: u32, depth: f64) {
        self.scene.set(pixel, face);
        let place = y as usize * self.scene.raster.columns as usize + x as usize;
        if let Some(stored) = self.depths.get_mut(place) {
            *stored = Some(depth);
        }
    }

    /// Draws the buffer: colours of faces, depths as numbers.
    fn picture(&self, pixel: Option<[u32; 2]>) -> Picture {
        let mut picture = self.scene.picture();
        let columns = self.scene.raster.columns as usize;
        // Wider grids leave no room for numbers.
        let is_small = columns <= 12;
        for (place, depth) in self.depths.iter().enumerate().filter(|_| is_small) {
            let at = [(place % columns) as i32, (place / columns) as i32];
            let item = self.scene.items.get(place).filter(|_| depth.is_some());
            let color = item.map_or([255; 3], |item| color(*item as usize));
            let tenths = depth.map_or(f64::INFINITY, |depth| (depth * 10.0).round() / 10.0);
            picture.colored(at, color, tenths);
        }
        if let Some([x, y]) = pixel {
            let side = [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5), (-0.5, -0.5)];
            picture.chain(side.map(|d| middle([x, y]) + DVec2::from(d)), Look::Now);
            self.scene.outline(&mut picture, self.face as usize, Look::First);
        }
        picture
    }
}

fn by_order(input: &Input, cap: usize) -> Result<Frames> {
    let mut scene = Scene::new(input)?;
    let options = painter::Options::default();
    let steps = record(cap, |t| painter::items(&scene.faces, &scene.screen(), &options, t))?;
    let mut order: Vec<(u32, f64)> = Vec::new();
    let mut painted: Option<u32> = None;
    Ok(Frames::new(steps, move |step, want| {
        let caption = match *step {
            painter::Step::Sorted { face, z } => {
                order.push((face, z));
                sorted(face, z, order.len())
            }
            painter::Step::Paint { face, y, x0, x1 } => {
                painted = Some(face);
                let rows = u32::try_from(y).into_iter();
                let pixels = rows.flat_map(|y| (x0.max(0)..x1).map(move |x| [x as u32, y]));
                pixels.for_each(|pixel| scene.set(pixel, face));
                let [first, last, row] = [x0, x1 - 1, y].map(Value::from);
                let face = ("face", name(face).into());
                PAINT.with([face, ("first", first), ("last", last), ("row", row)])
            }
        };
        let (painter::Step::Sorted { face, .. } | painter::Step::Paint { face, .. }) = *step;
        let picture = || {
            let mut picture = scene.picture();
            scene.outline(&mut picture, face as usize, Look::Now);
            picture
        };
        want.shown(step.line(), caption, || list(&order, painted), picture)
    }))
}

fn sorted(face: u32, z: f64, place: usize) -> Caption {
    SORTED.with([("place", place.into()), ("face", name(face).into()), ("depth", z.into())])
}

/// Returns the list from far to near, and where the painting is.
fn list(order: &[(u32, f64)], painted: Option<u32>) -> Table {
    let mut table = Table::new([FACE, DEPTH, Word::new("painted", "gemalt")]);
    let now = order.iter().position(|(face, _)| Some(*face) == painted);
    for (place, &(face, z)) in order.iter().enumerate() {
        let done = if now.is_some_and(|now| place <= now) { "✓" } else { "" };
        table.row(name(face), [z.into(), done.into()]);
    }
    table
}
