//! The lesson of picking: what is behind the middle of the picture.

use super::faces::{Scene, TAKES, Triangles, slab};
use super::frame::{Frames, Shown, Want, record};
use super::grid::letter;
use super::input::Input;
use super::lesson::{Example, Lesson};
use super::picture::{Look, Picture};
use super::table::Table;
use super::words::{Caption, Template, Value, Word};
use crate::Result;
use crate::math::DVec2;
use crate::scene::{Instance, Mesh};
use crate::sorting::CompactSort;
use crate::trace::PseudocodeLine;
use crate::view::pick::{Hit, INFO, PickArea, Step, pick_traced};

pub(super) const LESSON: Lesson = Lesson {
    name: INFO.name,
    info: &INFO,
    takes: TAKES,
    examples: EXAMPLES,
    templates: &[&MET, &MISSED, &COVERS, &BESIDE, &SORTED, &NOTHING],
    unreached: &[],
    make: |_, input, _, cap| make(input, cap),
};

const EXAMPLES: &[Example] = &[
    Example {
        name: "stack",
        title: Word::new(
            "three faces on each other, and one aside",
            "drei Flächen übereinander und eine daneben",
        ),
        input: || {
            let far = slab((0.0, 0.0), (16.0, 8.0), (5.0, 5.0));
            let near = slab((6.0, 2.0), (12.0, 6.0), (1.0, 1.0));
            let middle = slab((5.0, 3.0), (11.0, 8.0), (3.0, 3.0));
            let aside = slab((0.0, 6.0), (3.0, 9.0), (2.0, 2.0));
            Input::Faces(vec![far, near, middle, aside])
        },
    },
    Example {
        name: "gap",
        title: Word::new("the point is in a gap", "der Punkt liegt in einer Lücke"),
        input: || {
            let left = slab((0.0, 0.0), (3.0, 5.0), (1.0, 1.0));
            let right = slab((6.0, 0.0), (9.0, 5.0), (2.0, 2.0));
            Input::Faces(vec![left, right])
        },
    },
    Example::new(
        "common-edge",
        "on the common edge of two faces: only one is hit",
        "auf der gemeinsamen Kante zweier Flächen: Nur eine wird getroffen",
        || {
            let left = slab((0.0, 0.0), (5.5, 7.0), (2.0, 2.0));
            Input::Faces(vec![left, slab((5.5, 0.0), (10.0, 7.0), (2.0, 2.0))])
        },
    ),
    Example::new(
        "same-depth",
        "two faces in one plane: the first one counts as nearer",
        "zwei Flächen in einer Ebene: Die erste gilt als näher",
        || {
            let first = slab((0.0, 0.0), (8.0, 7.0), (3.0, 3.0));
            Input::Faces(vec![first, slab((3.0, 1.0), (10.0, 6.0), (3.0, 3.0))])
        },
    ),
    Example::new(
        "beside",
        "in the box, but beside the triangle",
        "im Kasten, aber neben dem Dreieck",
        || {
            let corner = [(0.0, 0.0), (10.0, 0.0), (0.0, 7.0)];
            let corner = corner.map(|(x, y)| crate::math::DVec3::new(x, y, -2.0)).to_vec();
            Input::Faces(vec![corner, slab((0.0, 0.0), (10.0, 8.0), (4.0, 4.0))])
        },
    ),
    Example::new(
        "slanted",
        "slanted faces: the depth at the point decides",
        "schräge Flächen: Die Tiefe am Punkt entscheidet",
        || {
            let falling = slab((0.0, 0.0), (10.0, 6.0), (1.0, 8.0));
            Input::Faces(vec![falling, slab((0.0, 0.0), (10.0, 6.0), (7.0, 2.0))])
        },
    ),
];

static MET: Template = Template::new(
    "object",
    "The box of {face} meets the pick volume: its triangles are tested.",
    "Der Kasten von {face} trifft das Auswahlvolumen: Seine Dreiecke werden geprüft.",
);
static MISSED: Template = Template::new(
    "object",
    "The box of {face} is outside of the pick volume: none of its triangles is tested.",
    "Der Kasten von {face} liegt außerhalb des Auswahlvolumens: Keines seiner Dreiecke wird geprüft.",
);
static COVERS: Template = Template::new(
    "tested",
    "{triangle} covers the point, its window depth there is {z}: a hit.",
    "{triangle} überdeckt den Punkt, seine Fenstertiefe dort ist {z}: ein Treffer.",
);
static BESIDE: Template = Template::new(
    "tested",
    "{triangle} does not cover the point: an edge function has the wrong sign.",
    "{triangle} überdeckt den Punkt nicht: Eine Kantenfunktion hat das falsche Vorzeichen.",
);
static SORTED: Template = Template::new(
    "sorted",
    "{count} {count|hit|hits}, sorted by depth: {names}. {first} is the visible one.",
    "{count} Treffer, nach Tiefe sortiert: {names}. Zu sehen ist {first}.",
);
static NOTHING: Template = Template::new(
    "sorted",
    "No hits: the background is picked.",
    "Keine Treffer: Gewählt ist der Hintergrund.",
);

/// The faces, the point, and the hits so far.
#[derive(Clone)]
struct State {
    scene: Scene,
    triangles: Triangles,
    point: DVec2,
    hits: Vec<Hit>,
}

fn make(input: &Input, cap: usize) -> Result<Frames> {
    let scene = Scene::new(input)?;
    let triangles = Triangles::new(&scene)?;
    let (mut model, view) = triangles.prepared(&scene)?;
    // Each face is an object of its own; items are in the same order.
    let whole = model.meshes.first().map(|mesh| mesh.positions.clone()).unwrap_or_default();
    let corners = whole.as_chunks::<3>().0;
    let of = |face: usize| {
        let own = (0..).zip(corners).filter(|(item, _)| triangles.face(*item) == face);
        Mesh::from_triangles(own.map(|(_, corners)| *corners))
    };
    model.meshes = (0..scene.faces.len()).map(of).collect();
    model.instances = (0..model.meshes.len()).map(Instance::of).collect();
    let size = DVec2::new(scene.raster.columns.into(), scene.raster.rows.into());
    let point = (size / 2.0).floor() + 0.5;
    let on_screen = DVec2::new(point.x, size.y - point.y);
    let steps = record(cap, |t| {
        pick_traced(&model, &view, PickArea::Point(on_screen), t);
        Ok(())
    })?;
    let mut state = State { scene, triangles, point, hits: Vec::new() };
    Ok(Frames::new(steps, move |step, want| state.show(step, want)))
}

impl State {
    fn show(&mut self, step: &Step, want: Want) -> Shown {
        let caption = self.take(step);
        want.shown(step.line(), caption, || self.table(), || self.picture(step))
    }

    fn take(&mut self, step: &Step) -> Caption {
        match *step {
            Step::Object { instance, inside } => {
                let template = if inside { &MET } else { &MISSED };
                template.with([("face", letter(instance).into())])
            }
            Step::Tested { item, hit } => {
                self.hits.extend(hit);
                let triangle = ("triangle", self.triangles.name(item).into());
                match hit {
                    Some(hit) => COVERS.with([triangle, ("z", hit.depth.into())]),
                    None => BESIDE.with([triangle]),
                }
            }
            Step::Sorted { hits } => {
                self.hits
                    .compact_sort_by(|a, b| a.depth.total_cmp(&b.depth).then(a.item.cmp(&b.item)));
                let names: Vec<String> =
                    self.hits.iter().map(|hit| self.triangles.name(hit.item)).collect();
                match names.first().cloned() {
                    Some(first) => SORTED.with([
                        ("count", hits.into()),
                        ("names", names.into()),
                        ("first", first.into()),
                    ]),
                    None => NOTHING.with([]),
                }
            }
        }
    }

    fn table(&self) -> Table {
        let mut table = Table::new([
            Word::new("hit", "Treffer"),
            Word::new("triangle", "Dreieck"),
            Word::new("depth", "Tiefe"),
        ]);
        for (number, hit) in self.hits.iter().enumerate() {
            let name: Value = self.triangles.name(hit.item).into();
            table.row(number + 1, [name, hit.depth.into()]);
        }
        table
    }

    fn picture(&self, step: &Step) -> Picture {
        let mut picture = self.scene.raster.picture();
        for face in 0..self.scene.faces.len() {
            self.scene.outline(&mut picture, face, Look::Window);
        }
        for hit in &self.hits {
            picture.chain(self.triangles.outline(hit.item), Look::Result);
        }
        match *step {
            Step::Object { instance, .. } => {
                self.scene.outline(&mut picture, instance, Look::Now);
            }
            Step::Tested { item, .. } => {
                picture.chain(self.triangles.outline(item), Look::Now);
            }
            Step::Sorted { .. } => {
                if let Some(first) = self.hits.first() {
                    picture.chain(self.triangles.outline(first.item), Look::Now);
                }
            }
        }
        picture.dot(self.point, Look::Second);
        picture
    }
}
