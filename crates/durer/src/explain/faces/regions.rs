//! The lesson of Weiler and Atherton's visible regions.

use super::{EXAMPLES, Scene, TAKES, name};
use crate::Result;
use crate::clip::polygon::Shapes;
use crate::explain::frame::{Frames, Shown, Want, record};
use crate::explain::input::Input;
use crate::explain::lesson::Lesson;
use crate::explain::picture::{Look, Picture};
use crate::explain::table::Table;
use crate::explain::words::{Caption, Template, Value, Word};
use crate::math::DVec2;
use crate::trace::PseudocodeLine;
use crate::visibility::polygons::regions::{FaceRegion, INFO, Step, regions};

pub(super) const LESSON: Lesson = Lesson {
    name: INFO.name,
    info: &INFO,
    takes: TAKES,
    examples: EXAMPLES,
    templates: &[&NEAREST, &CUT, &HIDDEN, &IN_FRONT, &SEEN],
    unreached: &[],
    make: |_, input, _, cap| make(input, cap),
};

static NEAREST: Template = Template::new(
    "nearest",
    "{face} has the nearest corner of its list: the {count} {count|other is|others are} cut along it.",
    "{face} hat die nächste Ecke der Liste: Die {count} {count|andere wird|anderen werden} an ihr zerschnitten.",
);
static CUT: Template = Template::new(
    "cut",
    "{face} is cut: area {inside} inside, {outside} outside.",
    "{face} wird zerschnitten: Fläche {inside} innen, {outside} außen.",
);
static HIDDEN: Template = Template::new(
    "hidden",
    "The part of {face} inside is behind {by}: it is hidden.",
    "Was von {face} innen ist, liegt hinter {by}: Es ist verdeckt.",
);
static IN_FRONT: Template = Template::new(
    "in-front",
    "{face}, or a part of it, lies in front of {by}: it goes into the inside list.",
    "{face} oder ein Teil davon liegt vor {by} und kommt in die innere Liste.",
);
static SEEN: Template = Template::new(
    "seen",
    "Nothing is left in front: {face} is seen in an area of {area}.",
    "Nichts liegt mehr davor: {face} ist auf einer Fläche von {area} zu sehen.",
);

/// Regions found so far, and the latest cut.
#[derive(Clone)]
struct State {
    scene: Scene,
    seen: Vec<FaceRegion>,
    by: u32,
    cut: Option<[Shapes; 2]>,
}

fn make(input: &Input, cap: usize) -> Result<Frames> {
    let scene = Scene::new(input)?;
    let steps =
        record(cap, |t| regions(&scene.faces, &Default::default(), &scene.screen().work, t))?;
    let mut state = State { scene, seen: Vec::new(), by: 0, cut: None };
    Ok(Frames::new(steps, move |step, want| state.show(step, want)))
}

impl State {
    fn show(&mut self, step: &Step, want: Want) -> Shown {
        let caption = self.take(step);
        want.shown(step.line(), caption, || self.table(), || self.picture(step))
    }

    fn take(&mut self, step: &Step) -> Caption {
        let named = |number: u32| Value::from(name(number));
        match step {
            Step::Nearest { face, others } => {
                (self.by, self.cut) = (*face, None);
                NEAREST.with([("face", named(*face)), ("count", (*others).into())])
            }
            Step::Cut { face, inside, outside } => {
                self.cut = Some([inside.clone(), outside.clone()]);
                let [inside, outside] = [inside.area(), outside.area()].map(Value::from);
                CUT.with([("face", named(*face)), ("inside", inside), ("outside", outside)])
            }
            Step::Hidden { face } => HIDDEN.with([("face", named(*face)), ("by", named(self.by))]),
            Step::InFront { face } => {
                IN_FRONT.with([("face", named(*face)), ("by", named(self.by))])
            }
            Step::Seen(region) => {
                self.cut = None;
                self.seen.push(region.clone());
                SEEN.with([("face", named(region.face)), ("area", region.shapes.area().into())])
            }
        }
    }

    fn table(&self) -> Table {
        let mut table = Table::new([Word::new("seen", "gesehen"), Word::new("area", "Fläche")]);
        for (place, region) in self.seen.iter().enumerate() {
            table
                .row(format!("{} {}", place + 1, name(region.face)), [region.shapes.area().into()]);
        }
        table
    }

    fn picture(&self, step: &Step) -> Picture {
        let mut picture = self.scene.raster.picture();
        picture.grid = None;
        for region in &self.seen {
            picture.rings(&rings(&region.shapes), Look::Result);
        }
        if let Some([inside, outside]) = &self.cut {
            picture.rings(&rings(outside), Look::First);
            picture.rings(&rings(inside), Look::Second);
        }
        let faces = 0..self.scene.faces.len();
        faces.for_each(|face| self.scene.outline(&mut picture, face, Look::Window));
        if !matches!(step, Step::Seen(_)) {
            self.scene.outline(&mut picture, self.by as usize, Look::Now);
        }
        picture
    }
}

fn rings(shapes: &Shapes) -> Vec<Vec<DVec2>> {
    shapes.rings().map(<[DVec2]>::to_vec).collect()
}
