//! The lesson of the scan-line z-buffer, on the triangles of faces.

use super::triangles::Triangles;
use super::{EXAMPLES, Scene, TAKES};
use crate::Result;
use crate::explain::frame::{Frames, Shown, Want, record};
use crate::explain::input::Input;
use crate::explain::lesson::Lesson;
use crate::explain::picture::{Look, Picture};
use crate::explain::table::Table;
use crate::explain::words::{Caption, Template, Value, Word};
use crate::math::DVec2;
use crate::scene::Camera;
use crate::shade::PreparedLights;
use crate::target::Framebuffer;
use crate::trace::PseudocodeLine;
use crate::visibility::surface::Cull;
use crate::visibility::surface::input::SurfaceInput;
use crate::visibility::surface::scan_line_z::{INFO, Options, Step, render};
use crate::visibility::surface::setup::TriangleFilter;

pub(super) const LESSON: Lesson = Lesson {
    name: INFO.name,
    info: &INFO,
    takes: TAKES,
    examples: EXAMPLES,
    templates: &[&ROW, &ENTER, &SPAN, &FIRST, &NEARER],
    unreached: &[],
    make: |_, input, _, cap| make(input, cap),
};

static ROW: Template = Template::new(
    "row",
    "Row {row} begins: all its depths are ∞.",
    "Zeile {row} beginnt: Alle ihre Tiefen sind ∞.",
);
static ENTER: Template = Template::new(
    "enter",
    "{triangle} begins in this row and joins the active triangles.",
    "{triangle} beginnt in dieser Zeile und wird aktiv.",
);
static SPAN: Template = Template::new(
    "span",
    "The edges of {triangle} bound pixels {first} to {last} of row {row}: their depths are compared.",
    "Die Kanten von {triangle} begrenzen die Pixel {first} bis {last} der Zeile {row}: Tiefen werden verglichen.",
);
static FIRST: Template = Template::new(
    "write",
    "Pixel {x}: z = {z} < ∞, so {triangle} is entered.",
    "Pixel {x}: z = {z} < ∞, {triangle} wird eingetragen.",
);
static NEARER: Template = Template::new(
    "write",
    "Pixel {x}: z = {z} < {before} of {other}, so {triangle} takes the pixel.",
    "Pixel {x}: z = {z} < {before} von {other}, {triangle} übernimmt das Pixel.",
);

/// The row of depths and the picture so far.
#[derive(Clone)]
struct State {
    scene: Scene,
    triangles: Triangles,
    camera: Camera,
    active: Vec<(u32, Option<[i32; 2]>)>,
    /// Depth and item of each pixel of the row.
    row: Vec<Option<(f64, u32)>>,
    /// The row, from the top.
    y: i32,
}

fn make(input: &Input, cap: usize) -> Result<Frames> {
    let scene = Scene::new(input)?;
    let triangles = Triangles::new(&scene)?;
    let (model, view) = triangles.prepared(&scene)?;
    let surfaces = SurfaceInput::new(&model, &view, TriangleFilter::new(Cull::None, 0))?;
    let lights = PreparedLights::of(&model, view.camera());
    let mut target = Framebuffer::new(view.width(), view.height());
    let steps = record(cap, |t| {
        render(&surfaces, &lights, &Options::default(), &mut target, t);
        Ok(())
    })?;
    let row = vec![None; scene.raster.columns as usize];
    let camera = *view.camera();
    let mut state = State { scene, triangles, camera, active: Vec::new(), row, y: 0 };
    Ok(Frames::new(steps, move |step, want| state.show(step, want)))
}

impl State {
    fn show(&mut self, step: &Step, want: Want) -> Shown {
        let caption = self.take(step);
        want.shown(step.line(), caption, || self.table(), || self.picture(step))
    }

    /// Returns the number of the row with rows upwards.
    fn upright(&self) -> i32 {
        self.scene.raster.rows as i32 - 1 - self.y
    }

    fn named(&self, item: u32) -> (&'static str, Value) {
        ("triangle", self.triangles.name(item).into())
    }

    fn take(&mut self, step: &Step) -> Caption {
        match *step {
            Step::Row { y } => {
                self.y = y;
                self.row.fill(None);
                // Those that end above the row leave.
                let bottom = f64::from(self.upright()) + 0.5;
                let below = |item: u32| {
                    let corners = self.triangles.corners.get(item as usize);
                    corners.is_some_and(|own| own.iter().any(|corner| corner.y < bottom))
                };
                let stays: Vec<_> =
                    self.active.iter().filter(|(item, _)| below(*item)).copied().collect();
                self.active = stays.into_iter().map(|(item, _)| (item, None)).collect();
                ROW.with([("row", self.upright().into())])
            }
            Step::Enter { item } => {
                self.active.push((item, None));
                ENTER.with([self.named(item)])
            }
            Step::Span { item, x0, x1 } => {
                for (_, span) in self.active.iter_mut().filter(|(other, _)| *other == item) {
                    *span = Some([x0, x1 - 1]);
                }
                let [first, last, row] = [x0, x1 - 1, self.upright()].map(Value::from);
                SPAN.with([self.named(item), ("first", first), ("last", last), ("row", row)])
            }
            Step::Write { item, x, depth } => {
                let Camera { near, far, eye, .. } = self.camera;
                // Depths of the input are measured from z = 0.
                let z = near + f64::from(depth) * (far - near) - eye.z;
                let z = (z * 1e4).round() / 1e4;
                let pixel = usize::try_from(x).ok().and_then(|x| self.row.get_mut(x));
                let before = pixel.and_then(|own| own.replace((z, item)));
                let row = self.upright();
                if let (Ok(x), Ok(y)) = (u32::try_from(x), u32::try_from(row)) {
                    self.scene.set([x, y], self.triangles.face(item) as u32);
                }
                let values = [("x", x.into()), ("z", z.into())];
                let [x, z] = values;
                match before {
                    None => FIRST.with([x, z, self.named(item)]),
                    Some((depth, other)) => {
                        let other = ("other", self.triangles.name(other).into());
                        NEARER.with([x, z, ("before", depth.into()), other, self.named(item)])
                    }
                }
            }
        }
    }

    /// Returns the active triangles, and the row of depths.
    fn table(&self) -> Table {
        let heads =
            [Word::new("active", "aktiv"), Word::new("pixels", "Pixel"), Word::new("z", "z")];
        let mut table = Table::new(heads);
        for &(item, span) in &self.active {
            let pixels = span
                .map_or("".into(), |[first, last]| Value::List(vec![first.into(), last.into()]));
            table.row(self.triangles.name(item), [pixels, "".into()]);
        }
        for (x, pixel) in self.row.iter().enumerate() {
            if let Some((z, item)) = pixel {
                table.row(format!("x = {x}"), [self.triangles.name(*item).into(), (*z).into()]);
            }
        }
        table
    }

    /// Draws the pixels, and under them the row from the side: x to the right, far up.
    fn picture(&self, step: &Step) -> Picture {
        let mut picture = self.scene.picture();
        let y = f64::from(self.upright()) + 0.5;
        let [low, high] = picture.extent;
        picture.chain([DVec2::new(low.x, y), DVec2::new(high.x, y)], Look::Dashed);
        let depths = || self.triangles.corners.iter().flatten().map(|corner| corner.z);
        let deepest = depths().fold(1.0, f64::max);
        let tall = (f64::from(self.scene.raster.rows) * 0.5).max(2.0);
        let base = -0.6 - tall;
        picture.extent[0].y = base - 0.4;
        let at = |x: f64, z: f64| DVec2::new(x, base + z / deepest * tall);
        let columns = f64::from(self.scene.raster.columns);
        picture.chain([at(0.0, 0.0), at(columns, 0.0)], Look::Thin);
        picture.arrow(at(0.0, 0.0), at(0.0, deepest * 1.05), Look::Thin);
        picture.label(at(0.0, deepest), (9.0, 0.0), "z");
        for (x, pixel) in self.row.iter().enumerate() {
            let Some((z, item)) = pixel else { continue };
            let (left, right) = (x as f64, x as f64 + 1.0);
            picture.chain([at(left, 0.0), at(left, *z), at(right, *z), at(right, 0.0)], Look::Thin);
            picture.label(at(left + 0.5, *z), (0.0, 8.0), self.triangles.name(*item));
        }
        match *step {
            Step::Write { x, item, .. } => {
                let z = usize::try_from(x).ok().and_then(|x| *self.row.get(x)?);
                let z = z.map_or(0.0, |(z, _)| z);
                let x = f64::from(x);
                picture.chain([at(x, z), at(x + 1.0, z)], Look::Now);
                picture.dot(DVec2::new(x + 0.5, y), Look::Now);
                picture.chain(self.triangles.outline(item), Look::First);
            }
            Step::Span { item, x0, x1 } => {
                picture.chain([x0, x1].map(|x| DVec2::new(x.into(), y)), Look::Now);
                picture.chain(self.triangles.outline(item), Look::First);
            }
            Step::Enter { item } => picture.chain(self.triangles.outline(item), Look::Now),
            Step::Row { .. } => {}
        }
        picture
    }
}
