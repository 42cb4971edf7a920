//! The lesson of shadow maps: points of one row, and the depths that a light above them has stored.

use super::faces::{Scene, TAKES, Triangles, slab};
use super::frame::{Frames, Numbered, Shown, Want, record};
use super::grid::letter;
use super::input::Input;
use super::lesson::{Example, Lesson};
use super::picture::{Look, Picture};
use super::table::Table;
use super::words::{Caption, Template, Value, Word};
use crate::math::{DVec2, DVec3};
use crate::raster::interpolate::{barycentric_2d, blend};
use crate::scene::Camera;
use crate::shade::PreparedLights;
use crate::shade::shadow::{INFO, ShadowMap, Step};
use crate::sorting::CompactSort;
use crate::target::{Framebuffer, Pixels};
use crate::trace::{NoTrace, PseudocodeLine};
use crate::view::View;
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
    templates: &[&MOVED, &OUTSIDE, &NEAR, &FREE, &BEHIND, &ALL, &NONE, &PART],
    unreached: &[],
    make: |_, input, _, cap| make(input, cap),
};

const EXAMPLES: &[Example] = &[
    Example {
        name: "plate",
        title: Word::new(
            "a plate over a floor; the light comes from above",
            "eine Platte über einem Boden; das Licht kommt von oben",
        ),
        input: || {
            let floor = slab((0.0, 0.0), (9.0, 3.0), (5.0, 5.0));
            let plate = slab((3.0, 0.0), (6.0, 3.0), (2.0, 2.0));
            Input::Faces(vec![floor, plate])
        },
    },
    Example {
        name: "slope",
        title: Word::new(
            "a slope: without the bias it would shadow itself",
            "eine Schräge: Ohne den Versatz würde sie sich selbst beschatten",
        ),
        input: || {
            let floor = slab((4.0, 0.0), (8.0, 3.0), (7.0, 7.0));
            Input::Faces(vec![slab((0.0, 0.0), (6.0, 3.0), (6.0, 1.0)), floor])
        },
    },
    Example::new(
        "slit",
        "two plates with a slit: a strip of light",
        "zwei Platten mit einem Schlitz: ein Streifen Licht",
        || {
            let floor = slab((0.0, 0.0), (10.0, 3.0), (5.0, 5.0));
            let left = slab((1.0, 0.0), (4.0, 3.0), (2.0, 2.0));
            Input::Faces(vec![floor, left, slab((6.0, 0.0), (9.0, 3.0), (3.0, 3.0))])
        },
    ),
    Example::new(
        "near-floor",
        "a plate just above the floor: the bias must be smaller than the gap",
        "eine Platte dicht über dem Boden: Der Versatz muss kleiner sein als der Spalt",
        || {
            let floor = slab((0.0, 0.0), (9.0, 3.0), (4.0, 4.0));
            Input::Faces(vec![floor, slab((3.0, 0.0), (6.0, 3.0), (3.5, 3.5))])
        },
    ),
    Example::new(
        "roof",
        "a slanted plate: its shadow ends where it ends",
        "eine schräge Platte: Ihr Schatten endet, wo sie endet",
        || {
            let floor = slab((0.0, 0.0), (9.0, 3.0), (6.0, 6.0));
            Input::Faces(vec![floor, slab((2.0, 0.0), (7.0, 3.0), (4.5, 1.0))])
        },
    ),
    Example::new(
        "three",
        "three plates in a stack: only the depth of the uppermost is stored",
        "drei Platten übereinander: Gespeichert ist nur die Tiefe der obersten",
        || {
            let floor = slab((0.0, 0.0), (8.0, 3.0), (7.0, 7.0));
            let low = slab((2.0, 0.0), (5.0, 3.0), (5.0, 5.0));
            let middle = slab((3.0, 0.0), (6.0, 3.0), (3.0, 3.0));
            Input::Faces(vec![floor, low, middle, slab((4.0, 0.0), (7.0, 3.0), (1.0, 1.0))])
        },
    ),
];

static MOVED: Template = Template::new(
    "moved",
    "A point of {face}, {point}, moves {bias} along its normal. In the map it is at x = {x}, d = {depth}.",
    "Ein Punkt von {face}, {point}, rückt um {bias} längs der Normalen. In der Karte liegt er bei x = {x}, d = {depth}.",
);
static OUTSIDE: Template = Template::new(
    "moved",
    "A point of {face}, {point}, moves {bias} along its normal and is outside of the map: lit.",
    "Ein Punkt von {face}, {point}, rückt um {bias} längs der Normalen und liegt außerhalb der Karte: beleuchtet.",
);
static NEAR: Template = Template::new(
    "texel",
    "Texel {texel}, weight {weight}: d = {depth} ≤ {stored}, so it is lit.",
    "Texel {texel}, Gewicht {weight}: d = {depth} ≤ {stored}, also beleuchtet.",
);
static FREE: Template = Template::new(
    "texel",
    "Texel {texel}, weight {weight}: the light met nothing there, so it is lit.",
    "Texel {texel}, Gewicht {weight}: Dort hat das Licht nichts getroffen, also beleuchtet.",
);
static BEHIND: Template = Template::new(
    "texel",
    "Texel {texel}, weight {weight}: d = {depth} > {stored}, the light met something before: dark.",
    "Texel {texel}, Gewicht {weight}: d = {depth} > {stored}, das Licht traf vorher etwas: dunkel.",
);
static ALL: Template =
    Template::new("share", "All the light reaches the point.", "Alles Licht erreicht den Punkt.");
static NONE: Template = Template::new(
    "share",
    "No light reaches the point: it is in shadow.",
    "Kein Licht erreicht den Punkt: Er liegt im Schatten.",
);
static PART: Template = Template::new(
    "share",
    "At the edge of a shadow: {share} of the light reaches the point.",
    "Am Rand eines Schattens: {share} des Lichts erreicht den Punkt.",
);

/// Distance of the points, in texels, and the first one.
const APART: f64 = 1.25;
const FIRST: f64 = 0.3;

/// A point of a face, as the input has it: x, y, depth.
#[derive(Clone)]
struct Point {
    face: usize,
    at: DVec3,
    normal: DVec3,
}

/// The map and the points so far.
#[derive(Clone)]
struct State {
    triangles: Triangles,
    /// Depths in the middle row of the map; none where nothing is.
    stored: Vec<Option<f64>>,
    camera: Camera,
    points: Vec<Point>,
    /// The share of each point.
    shares: Vec<f32>,
    texels: Vec<([u32; 2], f32, f32, bool)>,
    now: usize,
    place: Option<DVec2>,
}

fn make(input: &Input, cap: usize) -> Result<Frames> {
    let scene = Scene::new(input)?;
    let triangles = Triangles::new(&scene)?;
    let (model, view) = triangles.prepared(&scene)?;
    let y = f64::from(scene.raster.rows / 2) + 0.5;
    let points = points(&triangles, y, scene.raster.columns);
    let depths = depths(&model, &view)?;
    let camera = *view.camera();
    let row = view.height() - 1 - scene.raster.rows / 2;
    let place = |x: u32| depths.get(x, row).filter(|depth| *depth < 1.0);
    let stored = (0..view.width()).map(|x| place(x).map(|depth| below(&camera, depth))).collect();
    let map = ShadowMap::new(&view.screen_from_world(), 1.0, false, depths)?;
    let steps = record(cap, |t| {
        for (number, Point { at, normal, .. }) in points.iter().enumerate() {
            let position = DVec3::new(at.x, at.y, -at.z).as_vec3();
            map.reach_traced(position, normal.as_vec3(), &mut Numbered { number, t: &mut *t });
        }
        Ok(())
    })?;
    let (shares, texels) = (Vec::new(), Vec::new());
    let mut state =
        State { triangles, stored, camera, points, shares, texels, now: 0, place: None };
    Ok(Frames::new(steps, move |(number, step), want| state.show(*number, step, want)))
}

/// Returns the depths that the light sees: it looks along −z, in parallel rays.
fn depths(model: &crate::scene::Scene, view: &View) -> Result<Pixels<f32>> {
    let surfaces = SurfaceInput::new(model, view, TriangleFilter::new(Cull::None, 0))?;
    let lights = PreparedLights::of(model, view.camera());
    let mut target = Framebuffer::new(view.width(), view.height()).with_depth();
    let options = scan_line_z::Options::default();
    scan_line_z::render(&surfaces, &lights, &options, &mut target, &mut NoTrace);
    target.depth.ok_or_else(|| Error::parameter("map", "without depths", "with depths"))
}

/// Returns the depth below the light's plane of a stored one.
fn below(camera: &Camera, depth: f32) -> f64 {
    let z = camera.near + f64::from(depth) * (camera.far - camera.near) - camera.eye.z;
    (z * 1e4).round() / 1e4
}

/// Returns points of all faces in a row.
fn points(triangles: &Triangles, y: f64, columns: u32) -> Vec<Point> {
    let mut found: Vec<Point> = Vec::new();
    for (item, corners) in (0..).zip(&triangles.corners) {
        let face = triangles.face(item);
        let flat = corners.map(|corner| corner.truncate());
        let [a, b, c] = corners.map(|corner| DVec3::new(corner.x, corner.y, -corner.z));
        let normal = (b - a).cross(c - a).normalize_or(DVec3::Z);
        let normal = if normal.z < 0.0 { -normal } else { normal };
        for k in 0..=(f64::from(columns) / APART) as u32 {
            let at = DVec2::new(FIRST + f64::from(k) * APART, y);
            let is_new = !found.iter().any(|p| p.face == face && p.at.x == at.x);
            let weights = barycentric_2d(flat, at).filter(|all| all.iter().all(|w| *w >= 0.0));
            if let Some(weights) = weights.filter(|_| is_new) {
                let z = blend(weights, corners.map(|corner| corner.z));
                found.push(Point { face, at: at.extend(z), normal });
            }
        }
    }
    found.compact_sort_by(|p, q| {
        (p.face, p.at.x).partial_cmp(&(q.face, q.at.x)).unwrap_or(p.face.cmp(&q.face))
    });
    found
}

/// Returns a number with the digits that are shown.
fn short(x: f32) -> Value {
    ((f64::from(x) * 1000.0).round() / 1000.0).into()
}

impl State {
    fn show(&mut self, number: usize, step: &Step, want: Want) -> Shown {
        let caption = self.take(number, step);
        want.shown(step.line(), caption, || self.table(), || self.picture())
    }

    fn take(&mut self, number: usize, step: &Step) -> Caption {
        self.now = number;
        match *step {
            Step::Moved { bias, place, inside, .. } => {
                self.texels.clear();
                let depth = below(&self.camera, place.z);
                self.place = inside.then(|| DVec2::new(place.x.into(), depth));
                let point = self.points.get(number);
                let face = point.map(|point| letter(point.face)).unwrap_or_default();
                let at = point.map(|p| DVec3::new(p.at.x, p.at.y, -p.at.z)).unwrap_or_default();
                let values = [("face", face.into()), ("point", at.into()), ("bias", short(bias))];
                let [face, point, bias] = values;
                if inside {
                    MOVED.with([face, point, bias, ("x", short(place.x)), ("depth", depth.into())])
                } else {
                    self.shares.push(1.0);
                    OUTSIDE.with([face, point, bias])
                }
            }
            Step::Texel { texel, stored, depth, weight, lit } => {
                self.texels.push((texel, stored, weight, lit));
                let at = DVec2::new(texel[0].into(), texel[1].into());
                let values = [("texel", at.into()), ("weight", short(weight))];
                let [texel, weight] = values;
                let depth = ("depth", below(&self.camera, depth).into());
                let far = ("stored", below(&self.camera, stored).into());
                match (lit, stored < 1.0) {
                    (true, true) => NEAR.with([texel, weight, depth, far]),
                    (true, false) => FREE.with([texel, weight]),
                    (false, _) => BEHIND.with([texel, weight, depth, far]),
                }
            }
            Step::Share { share } => {
                self.shares.push(share);
                match share {
                    1.0 => ALL.with([]),
                    0.0 => NONE.with([]),
                    _ => PART.with([("share", short(share))]),
                }
            }
        }
    }

    /// Returns the texels of the point.
    fn table(&self) -> Table {
        let mut table = Table::new([
            Word::new("texel", "Texel"),
            Word::new("stored", "gespeichert"),
            Word::new("weight", "Gewicht"),
            Word::new("lit", "beleuchtet"),
        ]);
        for &([x, y], stored, weight, lit) in &self.texels {
            let far: Value =
                if stored < 1.0 { below(&self.camera, stored).into() } else { "∞".into() };
            let lit = if lit { Word::new("yes", "ja") } else { Word::new("no", "nein") };
            table.row(DVec2::new(x.into(), y.into()), [far, short(weight), lit.into()]);
        }
        table
    }

    /// Draws the row from the side, the light above: the faces, the depths of the map, and the points.
    fn picture(&self) -> Picture {
        let columns = self.stored.len() as f64;
        let deepest = self.triangles.corners.iter().flatten().map(|c| c.z).fold(1.0, f64::max);
        let scale = (columns * 0.7 / deepest).min(1.0);
        let at = |x: f64, z: f64| DVec2::new(x, -z * scale);
        let mut picture =
            Picture::new([at(-0.7, deepest + 0.7 / scale), at(columns + 0.7, -0.9 / scale)]);
        picture.picture_from_input = None;
        let sun = Word::new("light", "Licht");
        picture.arrow(at(columns / 2.0, -0.8 / scale), at(columns / 2.0, 0.0), Look::Thin);
        picture.label(at(columns / 2.0, -0.5 / scale), (24.0, 0.0), sun);
        for (x, stored) in self.stored.iter().enumerate() {
            let x = x as f64;
            picture.chain([at(x, 0.0), at(x, -0.25 / scale)], Look::Thin);
            if let Some(z) = stored {
                picture.chain([at(x, *z), at(x + 1.0, *z)], Look::Window);
            }
        }
        picture.chain([at(0.0, 0.0), at(columns, 0.0)], Look::Thin);
        for &([x, _], stored, _, lit) in &self.texels {
            let z = if stored < 1.0 { below(&self.camera, stored) } else { deepest };
            let look = if lit { Look::Result } else { Look::Second };
            picture.chain([at(x.into(), z), at(f64::from(x) + 1.0, z)], look);
        }
        for (point, share) in self.points.iter().zip(&self.shares) {
            let look = if *share < 0.5 { Look::Second } else { Look::Result };
            picture.dot(at(point.at.x, point.at.z), look);
        }
        if let Some(point) = self.points.get(self.now) {
            picture.dot(at(point.at.x, point.at.z), Look::Now);
            picture.label(at(point.at.x, point.at.z), (0.0, 12.0), letter(point.face));
        }
        if let Some(place) = self.place {
            picture.chain([at(place.x, 0.0), at(place.x, place.y)], Look::Dashed);
        }
        picture
    }
}
