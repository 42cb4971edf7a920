//! The lesson of ray tracing: the rays of one row of pixels, in a view from above.

use super::row::row_camera;
use super::triangles::Triangles;
use super::{EXAMPLES, Scene, TAKES, slab};
use crate::Result;
use crate::explain::frame::{Frames, Shown, Want, record};
use crate::explain::input::Input;
use crate::explain::lesson::{Example, Lesson};
use crate::explain::picture::{Look, Picture};
use crate::explain::table::Table;
use crate::explain::words::{Caption, Template, Value, Word};
use crate::math::{DVec2, DVec3, Vec3};
use crate::scene::{Camera, Light, LightKind, Material, Part, ShadingModel};
use crate::shade::PreparedLights;
use crate::target::Framebuffer;
use crate::trace::PseudocodeLine;
use crate::view::View;
use crate::visibility::surface::Cull;
use crate::visibility::surface::input::SurfaceInput;
use crate::visibility::surface::ray::{INFO, Options, RayKind, Step, render};
use crate::visibility::surface::setup::TriangleFilter;

pub(super) const LESSON: Lesson = Lesson {
    name: INFO.name,
    info: &INFO,
    takes: TAKES,
    examples: &[SHADOW, MIRRORS, EXAMPLES[0], EXAMPLES[1], EXAMPLES[2], EXAMPLES[5]],
    templates: &[&BEGIN, &HIT, &MISSED, &DARK, &LIT, &MIRRORED, &AWAY],
    unreached: &[],
    make: |_, input, _, cap| make(input, cap),
};

const SHADOW: Example = Example {
    name: "shadow",
    title: Word::new(
        "a plate between the light and a wall",
        "eine Platte zwischen dem Licht und einer Wand",
    ),
    input: || {
        let wall = slab((0.0, 0.0), (12.0, 4.0), (6.0, 6.0));
        let plate = slab((6.0, 1.0), (9.0, 3.0), (3.0, 3.0));
        Input::Faces(vec![wall, plate])
    },
};

const MIRRORS: Example = Example {
    name: "mirrors",
    title: Word::new(
        "two walls at an angle see each other",
        "zwei Wände im Winkel spiegeln sich ineinander",
    ),
    input: || {
        let left = slab((0.0, 0.0), (5.0, 4.0), (1.0, 6.0));
        let right = slab((5.0, 0.0), (10.0, 4.0), (6.0, 1.0));
        Input::Faces(vec![left, right])
    },
};

static BEGIN: Template = Template::new(
    "begin",
    "One row of {count} pixels, seen from above: the eye is at {eye}, the light at {light}.",
    "Eine Zeile aus {count} Pixeln, von oben gesehen: Das Auge ist bei {eye}, das Licht bei {light}.",
);
static HIT: Template = Template::new(
    "ray",
    "Pixel {x}: D = {d}. The nearest face along O + t · D is {face}, t = {t}, at {point}.",
    "Pixel {x}: D = {d}. Die nächste Fläche längs O + t · D ist {face}, t = {t}, bei {point}.",
);
static MISSED: Template = Template::new(
    "ray",
    "Pixel {x}: D = {d}. The ray meets nothing: the pixel shows the background.",
    "Pixel {x}: D = {d}. Der Strahl trifft nichts: Das Pixel zeigt den Hintergrund.",
);
static DARK: Template = Template::new(
    "ray",
    "Shadow ray from {o}, D = {d}: {face} is in the way at t = {t}, so the point gets no light.",
    "Schattenstrahl von {o}, D = {d}: {face} ist bei t = {t} im Weg, der Punkt bekommt kein Licht.",
);
static LIT: Template = Template::new(
    "ray",
    "Shadow ray from {o}, D = {d}: nothing is in the way, so the point is lit.",
    "Schattenstrahl von {o}, D = {d}: Nichts ist im Weg, der Punkt wird beleuchtet.",
);
static MIRRORED: Template = Template::new(
    "ray",
    "Mirrored ray {generation} from {o}, D = {d}: it meets {face} at t = {t}, {point}.",
    "Gespiegelter Strahl {generation} von {o}, D = {d}: Er trifft {face} bei t = {t}, {point}.",
);
static AWAY: Template = Template::new(
    "ray",
    "Mirrored ray {generation} from {o}, D = {d}: it meets nothing and brings the background.",
    "Gespiegelter Strahl {generation} von {o}, D = {d}: Er trifft nichts und bringt den Hintergrund.",
);

/// Pixels of the row; the middle one looks straight ahead.
const PIXELS: u32 = 7;

/// The rays of the row so far.
#[derive(Clone)]
struct State {
    triangles: Triangles,
    /// Faces cut by the plane of the rays: their ends in it, and their items.
    cuts: Vec<([DVec2; 2], u32)>,
    eye: DVec3,
    light: DVec3,
    rays: Vec<Ray>,
}

/// A ray in the plane of the row.
#[derive(Clone, Copy)]
struct Ray {
    ends: [DVec2; 2],
    kind: RayKind,
    x: i32,
    item: Option<u32>,
    t: f64,
}

fn make(input: &Input, cap: usize) -> Result<Frames> {
    let scene = Scene::new(input)?;
    let triangles = Triangles::new(&scene)?;
    let (mut model, _) = triangles.prepared(&scene)?;
    let camera = row_camera(&scene, &triangles, PIXELS);
    let Camera { eye, .. } = camera;
    let aside = f64::from(scene.raster.columns) * 0.45;
    let light = DVec3::new(eye.x + aside, eye.y, eye.z * 0.6);
    let kind = LightKind::Point { position: light, range: None };
    model.lights = vec![Light { kind, color: Vec3::splat(50.0) }];
    mirrors(&mut model);
    let view = View::new(camera, PIXELS, 1)?;
    let surfaces = SurfaceInput::new(&model, &view, TriangleFilter::new(Cull::None, 0))?;
    let lights = PreparedLights::of(&model, view.camera());
    let options = Options { shadows: true, reflections: true, depth: 1, ..Options::default() };
    let mut target = Framebuffer::new(PIXELS, 1);
    let steps = record(cap, |t| {
        render(&surfaces, &lights, &options, &mut target, t);
        Ok(())
    })?;
    let cuts = cuts(&triangles, eye.y);
    let mut state = State { triangles, cuts, eye, light, rays: Vec::new() };
    Ok(Frames::new(steps, move |step, want| state.show(step, want)))
}

/// Assigns a material that mirrors to all faces.
fn mirrors(model: &mut crate::scene::Scene) {
    model.materials = vec![Material {
        model: ShadingModel::Phong,
        specular: Vec3::splat(0.4),
        shininess: 5000.0,
        ..Material::default()
    }];
    for mesh in &mut model.meshes {
        let range = 0..mesh.primitive_count() as u32;
        mesh.parts = vec![Part { range, material: Some(0), name: String::new() }];
    }
}

/// Returns the place of a point in the view from above: x to the right, away from the eye upwards.
fn above(p: DVec3) -> DVec2 {
    DVec2::new(p.x, -p.z)
}

/// Returns where the triangles meet the plane of the rays.
fn cuts(triangles: &Triangles, y: f64) -> Vec<([DVec2; 2], u32)> {
    let cut = |(corners, item): (&[DVec3; 3], u32)| {
        let sides = [(0, 1), (1, 2), (2, 0)].map(|(i, k)| (corners[i], corners[k]));
        let meets = sides.iter().filter(|(a, b)| (a.y < y) != (b.y < y));
        let at = meets.map(|(a, b)| *a + (*b - *a) * ((y - a.y) / (b.y - a.y)));
        let ends: Vec<DVec2> = at.map(|p| DVec2::new(p.x, p.z)).collect();
        Some(([*ends.first()?, *ends.get(1)?], item))
    };
    triangles.corners.iter().zip(0..).filter_map(cut).collect()
}

impl State {
    fn show(&mut self, step: &Step, want: Want) -> Shown {
        let caption = self.take(step);
        want.shown(step.line(), caption, || self.table(), || self.picture())
    }

    fn take(&mut self, step: &Step) -> Caption {
        let Step::Ray { x, kind, generation, origin, direction, hit, t, .. } = *step else {
            let [eye, light] = [self.eye, self.light].map(Value::from);
            return BEGIN.with([("count", PIXELS.into()), ("eye", eye), ("light", light)]);
        };
        let reach = match kind {
            RayKind::Shadow if hit.is_none() => (self.light - origin).length(),
            _ if hit.is_none() => self.extent()[1].distance(self.extent()[0]) * 0.3,
            _ => t,
        };
        // Noise of the last digits is not shown.
        let rounded = |v: DVec3| (v * 1e6).round() / 1e6;
        let (origin, direction) = (rounded(origin), rounded(direction));
        let ends = [origin, origin + direction * reach];
        self.rays.push(Ray { ends: ends.map(above), kind, x, item: hit, t });
        let values = [("o", origin.into()), ("d", direction.into()), ("t", t.into())];
        let [o, d, t] = values;
        let face = ("face", hit.map(|item| self.triangles.name(item)).unwrap_or_default().into());
        let point = ("point", rounded(ends[1]).into());
        let generation = ("generation", generation.into());
        match (kind, hit) {
            (RayKind::Primary | RayKind::Sample, Some(_)) => {
                HIT.with([("x", x.into()), d, face, t, point])
            }
            (RayKind::Primary | RayKind::Sample, None) => MISSED.with([("x", x.into()), d]),
            (RayKind::Shadow, Some(_)) => DARK.with([o, d, face, t]),
            (RayKind::Shadow, None) => LIT.with([o, d]),
            (RayKind::Mirror | RayKind::Refraction, Some(_)) => {
                MIRRORED.with([generation, o, d, face, t, point])
            }
            (RayKind::Mirror | RayKind::Refraction, None) => AWAY.with([generation, o, d]),
        }
    }

    /// Returns the rays of the pixel: the tree of which the first is the root.
    fn table(&self) -> Table {
        let heads = [Word::new("ray", "Strahl"), Word::new("meets", "trifft"), Word::new("t", "t")];
        let mut table = Table::new(heads);
        let now = self.rays.last().map(|ray| ray.x);
        let of_pixel = self.rays.iter().filter(|ray| Some(ray.x) == now);
        for (number, ray) in of_pixel.enumerate() {
            let kind = match ray.kind {
                RayKind::Primary | RayKind::Sample => Word::new("from the eye", "vom Auge"),
                RayKind::Shadow => Word::new("to the light", "zum Licht"),
                RayKind::Mirror => Word::new("mirrored", "gespiegelt"),
                RayKind::Refraction => Word::new("refracted", "gebrochen"),
            };
            let name = Value::List(vec![(number + 1).into(), kind.into()]);
            let meets = ray.item.map_or("–".to_owned(), |item| self.triangles.name(item));
            table.row(name, [meets.into(), ray.t.into()]);
        }
        table
    }

    /// Returns the corners of what is drawn.
    fn extent(&self) -> [DVec2; 2] {
        let ends = self.cuts.iter().flat_map(|(ends, _)| *ends);
        let all = ends.chain([above(self.eye), above(self.light)]);
        Picture::around(all, 0.08).extent
    }

    fn picture(&self) -> Picture {
        let mut picture = Picture::new(self.extent());
        picture.picture_from_input = None;
        for (number, (ends, item)) in self.cuts.iter().enumerate() {
            picture.chain(*ends, Look::Window);
            let face = self.triangles.face(*item);
            let is_first = self.cuts.iter().position(|(_, k)| self.triangles.face(*k) == face);
            if is_first == Some(number) {
                picture.label((ends[0] + ends[1]) / 2.0, (-7.0, -9.0), super::name(face as u32));
            }
        }
        let now = self.rays.last().map(|ray| ray.x);
        for ray in &self.rays {
            let look = match ray.kind {
                _ if Some(ray.x) != now => Look::Grid,
                RayKind::Shadow if ray.item.is_some() => Look::Second,
                RayKind::Shadow => Look::Result,
                RayKind::Primary | RayKind::Sample => Look::First,
                RayKind::Mirror | RayKind::Refraction => Look::Dashed,
            };
            picture.chain(ray.ends, look);
        }
        if let Some(ray) = self.rays.last() {
            picture.arrow(ray.ends[0], ray.ends[1], Look::Now);
        }
        picture.named(above(self.eye), Word::new("eye", "Auge"), Look::First);
        picture.named(above(self.light), Word::new("light", "Licht"), Look::Result);
        picture
    }
}
