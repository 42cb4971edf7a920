//! The lesson of forward warping: one row of pixels, moved to where a camera beside the first sees them.

use super::faces::{Scene, TAKES, Triangles, row_camera, slab};
use super::frame::{Frames, Shown, Want, record};
use super::grid::{color, letter};
use super::input::Input;
use super::lesson::{Example, Lesson};
use super::picture::{Look, Picture};
use super::table::Table;
use super::words::{Caption, Template, Value, Word};
use crate::math::{DVec2, DVec3};
use crate::scene::Camera;
use crate::shade::PreparedLights;
use crate::target::{Framebuffer, Pixels};
use crate::trace::{NoTrace, PseudocodeLine};
use crate::view::View;
use crate::view::warp::{DepthPicture, INFO, Options, Step, warp};
use crate::visibility::surface::Cull;
use crate::visibility::surface::input::SurfaceInput;
use crate::visibility::surface::scan_line_z;
use crate::visibility::surface::setup::TriangleFilter;
use crate::{Error, Result};

pub(super) const LESSON: Lesson = Lesson {
    name: INFO.name,
    info: &INFO,
    takes: TAKES,
    examples: EXAMPLES,
    templates: &[&MOVED, &ENDLESS, &FIRST, &NEARER],
    unreached: &[],
    make: |_, input, _, cap| make(input, cap),
};

const EXAMPLES: &[Example] = &[
    Example {
        name: "hole",
        title: Word::new(
            "a near plate moves further than the wall: a hole opens",
            "eine nahe Platte wandert weiter als die Wand: Ein Loch öffnet sich",
        ),
        input: || {
            let wall = slab((0.0, 0.0), (12.0, 4.0), (8.0, 8.0));
            Input::Faces(vec![wall, slab((4.0, 1.0), (8.0, 3.0), (1.0, 1.0))])
        },
    },
    Example {
        name: "slope",
        title: Word::new("a slope is stretched", "eine Schräge wird gedehnt"),
        input: || Input::Faces(vec![slab((1.0, 0.0), (11.0, 4.0), (1.0, 9.0))]),
    },
    Example::new(
        "wall",
        "a wall straight ahead: all pixels move equally far",
        "eine Wand geradeaus: Alle Pixel wandern gleich weit",
        || Input::Faces(vec![slab((0.0, 0.0), (12.0, 4.0), (4.0, 4.0))]),
    ),
    Example::new(
        "two-plates",
        "two plates before a wall: the nearer one covers the other",
        "zwei Platten vor einer Wand: Die nähere verdeckt die andere",
        || {
            let wall = slab((0.0, 0.0), (12.0, 4.0), (9.0, 9.0));
            let near = slab((6.0, 1.0), (9.0, 3.0), (1.0, 1.0));
            Input::Faces(vec![wall, slab((3.0, 1.0), (5.5, 3.0), (4.0, 4.0)), near])
        },
    ),
    Example::new(
        "away",
        "a slope the other way: pixels are pressed together",
        "eine Schräge in der anderen Richtung: Pixel werden gedrängt",
        || Input::Faces(vec![slab((1.0, 0.0), (11.0, 4.0), (9.0, 1.0))]),
    ),
    Example::new(
        "gap",
        "nothing behind a gap: the background stays where it is",
        "nichts hinter einer Lücke: Der Hintergrund bleibt, wo er ist",
        || {
            let left = slab((0.0, 0.0), (4.0, 4.0), (3.0, 3.0));
            Input::Faces(vec![left, slab((8.0, 0.0), (12.0, 4.0), (3.0, 3.0))])
        },
    ),
];

static MOVED: Template = Template::new(
    "move",
    "Pixel {x}, {face}, distance {distance}: the new camera sees its middle at x = {to}.",
    "Pixel {x}, {face}, Abstand {distance}: Die neue Kamera sieht seine Mitte bei x = {to}.",
);
static ENDLESS: Template = Template::new(
    "move",
    "Pixel {x} shows no surface: it is behind everything and stays at x = {to}.",
    "Pixel {x} zeigt keine Fläche: Es liegt hinter allem und bleibt bei x = {to}.",
);
static FIRST: Template = Template::new(
    "write",
    "Its square covers the centre of pixel {at} of the new picture, where nothing was: it is written.",
    "Sein Quadrat überdeckt die Mitte von Pixel {at} des neuen Bildes, wo noch nichts war: Es wird geschrieben.",
);
static NEARER: Template = Template::new(
    "write",
    "Its square covers the centre of pixel {at} of the new picture and is nearer than what was there.",
    "Sein Quadrat überdeckt die Mitte von Pixel {at} des neuen Bildes und ist näher als das, was dort war.",
);

/// Pixels of the row.
const PIXELS: u32 = 11;
/// Distance of the cameras, in widths of the scene.
const BESIDE: f64 = 0.14;

/// A pixel of the new row: the old one, its distance, and its colour.
type Written = Option<(u32, f64, [u8; 3])>;

/// Both rows.
#[derive(Clone)]
struct State {
    old: Pixels<[u8; 4]>,
    faces: Vec<Option<usize>>,
    camera: Camera,
    new: Vec<Written>,
    now: Option<(u32, DVec2, f64, [u8; 3])>,
    written: Option<usize>,
}

fn make(input: &Input, cap: usize) -> Result<Frames> {
    let scene = Scene::new(input)?;
    let triangles = Triangles::new(&scene)?;
    let (model, _) = triangles.prepared(&scene)?;
    let camera = row_camera(&scene, &triangles, PIXELS);
    let view = View::new(camera, PIXELS, 1)?;
    let surfaces = SurfaceInput::new(&model, &view, TriangleFilter::new(Cull::None, 0))?;
    let lights = PreparedLights::of(&model, view.camera());
    let mut target = Framebuffer::new(PIXELS, 1).with_depth().with_items();
    let look = scan_line_z::Options::default();
    scan_line_z::render(&surfaces, &lights, &look, &mut target, &mut NoTrace);
    let (Some(depth), Some(items)) = (target.depth, target.item) else {
        return Err(Error::parameter("picture", "without depths", "with depths"));
    };
    let count = triangles.corners.len();
    let face = |item: &u32| Some(triangles.face(*item)).filter(|_| (*item as usize) < count);
    let faces: Vec<Option<usize>> = items.data().iter().map(face).collect();
    let code = |face: &Option<usize>| {
        let [r, g, b] = face.map_or([255; 3], color);
        [r, g, b, 255]
    };
    let old = Pixels::from_data(PIXELS, 1, faces.iter().map(code).collect())?;
    let aside = DVec3::X * f64::from(scene.raster.columns) * BESIDE;
    let new = Camera { eye: camera.eye + aside, target: camera.target + aside, ..camera };
    let sources = [DepthPicture { color: &old, depth: &depth, camera }];
    let steps = record(cap, |t| warp(&sources, &new, [PIXELS, 1], &Options::default(), t))?;
    let new = vec![None; PIXELS as usize];
    let mut state = State { old, faces, camera, new, now: None, written: None };
    Ok(Frames::new(steps, move |step, want| state.show(step, want)))
}

impl State {
    fn show(&mut self, step: &Step, want: Want) -> Shown {
        let caption = self.take(step);
        want.shown(step.line(), caption, || self.table(), || self.picture())
    }

    /// Returns the distance from the plane of the eye at a window depth.
    fn distance(&self, depth: f64) -> f64 {
        let Camera { near, far, .. } = self.camera;
        let distance = near * far / (far - depth * (far - near));
        (distance * 1e3).round() / 1e3
    }

    fn take(&mut self, step: &Step) -> Caption {
        match *step {
            Step::Move { from: [x, _], to, depth, color: [r, g, b, _], .. } => {
                self.now = Some((x, to, depth, [r, g, b]));
                self.written = None;
                let to = ("to", ((to.x * 1e3).round() / 1e3).into());
                let x_of = ("x", x.into());
                match self.faces.get(x as usize).copied().flatten() {
                    Some(face) => {
                        let distance = ("distance", self.distance(depth).into());
                        MOVED.with([x_of, ("face", letter(face).into()), distance, to])
                    }
                    None => ENDLESS.with([x_of, to]),
                }
            }
            Step::Write { at: [x, _] } => {
                self.written = Some(x as usize);
                let now = self.now.map(|(from, _, depth, rgb)| (from, self.distance(depth), rgb));
                let place = self.new.get_mut(x as usize);
                let before = place.and_then(|place| std::mem::replace(place, now));
                let template = if before.is_some() { &NEARER } else { &FIRST };
                template.with([("at", x.into())])
            }
        }
    }

    /// Returns the new pixels.
    fn table(&self) -> Table {
        let mut table = Table::new([
            Word::new("new pixel", "neues Pixel"),
            Word::new("from", "von"),
            Word::new("distance", "Abstand"),
        ]);
        for (x, written) in self.new.iter().enumerate() {
            let cells: [Value; 2] = match written {
                Some((from, distance, _)) => [(*from).into(), (*distance).into()],
                None => ["–".into(), "".into()],
            };
            table.row(x, cells);
        }
        table
    }

    /// Draws the old row, the new one above it, and the way between them.
    fn picture(&self) -> Picture {
        let width = f64::from(PIXELS);
        let mut picture = Picture::new([DVec2::new(-0.6, -0.9), DVec2::new(width + 0.6, 5.4)]);
        picture.picture_from_input = None;
        for x in 0..PIXELS {
            let [r, g, b, _] = self.old.get(x, 0).unwrap_or([255; 4]);
            picture.colored([x as i32, 0], [r, g, b], "");
            picture.label(DVec2::new(f64::from(x) + 0.5, 0.0), (0.0, 8.0), x);
            let new = self.new.get(x as usize).copied().flatten();
            picture.colored([x as i32, 3], new.map_or([255; 3], |(_, _, rgb)| rgb), "");
        }
        for y in [0.0, 3.0] {
            for x in 0..=PIXELS {
                let x = f64::from(x);
                picture.chain([DVec2::new(x, y), DVec2::new(x, y + 1.0)], Look::Thin);
            }
            for side in [y, y + 1.0] {
                picture.chain([DVec2::new(0.0, side), DVec2::new(width, side)], Look::Thin);
            }
        }
        picture.label(DVec2::new(width / 2.0, 4.7), (0.0, 0.0), Word::new("new", "neu"));
        if let Some((x, to, ..)) = self.now {
            let from = DVec2::new(f64::from(x) + 0.5, 1.0);
            picture.arrow(from, DVec2::new(to.x.clamp(-0.5, width + 0.5), 3.0), Look::Now);
        }
        if let Some(x) = self.written {
            let x = x as f64;
            let border = [(x, 3.0), (x + 1.0, 3.0), (x + 1.0, 4.0), (x, 4.0), (x, 3.0)];
            picture.chain(border.map(DVec2::from), Look::Now);
        }
        picture
    }
}
