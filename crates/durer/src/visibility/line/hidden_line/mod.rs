//! Hidden lines: the visible parts of the edges of a scene, exactly, and the number of surfaces that hide the rest.
//!
//! Arthur Appel, *The notion of quantitative invisibility and the machine rendering of solids*,
//! Proceedings of the ACM National Conference, 1967: a line changes its visibility only where it passes
//! behind an edge or through a face; the number of surfaces in front of it is its quantitative
//! invisibility. Object space; O(n) for the set-up and about O(k) for k pairs of a line and a face
//! that overlap in the picture.
//!
//! Deviations: the number is not carried from vertex to vertex along the edges, where one wrong
//! crossing would spoil all that follow, but counted for each line from the faces that overlap it, as
//! Lawrence Roberts did (*Machine perception of three-dimensional solids*, 1963); these come from a
//! grid over the picture. Each face cuts a line at its projected borders and at its plane (Cyrus–Beck).
//!
//! Rules instead of chance: vertices are snapped to a grid of about 2⁻²⁷ of the picture's extent, on which all
//! decisions in the plane are exact integers; a line along the border of a face is hidden on that side only, and counts
//! as hidden if both sides are; touching lines are visible; coincident lines are drawn once, the visible one first.

mod absorb;
mod cells;
mod cover;
mod lines;
mod met;
mod occluders;
mod span;
mod step;

pub use cover::Cover;
pub use span::HiddenSpan;
pub use step::{Step, replay};

use self::lines::{FeatureLine, Known, Lines, joined};
use self::met::Met;
use self::occluders::Occluders;
use super::arrange::{How, Pieces, SLIVER, arranged, corners, on_page};
use super::edge_lines::{ClassSet, Intersections, NO_ITEM};
use super::facing::Facing;
use super::page::{GridPoint, Projected};
use super::piece::Piece;
use super::planes::Planes;
use super::roundness::Smooth;
use super::smooth_silhouette::{Whole, divided};
use super::steps::Steps;
use super::tangent::Tangents;
use crate::info::{Class, Coherence, Info, Occluder};
use crate::scene::Scene;
use crate::target::drawing::{Drawing, LineClass};
use crate::trace::Tracer;
use crate::view::View;
use crate::view::picture_plane::PicturePlane;
use crate::visibility::object::{Bodies, Edges, Faces, Weld};
use crate::work::Work;
use crate::{Error, Result, parallel};
use std::ops::Range;

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "hidden-line",
    title: "Hidden lines by quantitative invisibility",
    authors: "Arthur Appel",
    year: 1967,
    source: "The notion of quantitative invisibility and the machine rendering of solids, ACM National \
             Conference",
    class: Class::ObjectSpace,
    occluder: Occluder::Area,
    coherence: &[Coherence::Edge],
    cost: "O(n + k) for n faces and k pairs of a line and a face that overlap in the picture",
    limits: "all faces are opaque; a point nearer to a face than 2^-23 of the model's extent touches it",
    pseudocode: &[
        "project all vertices to a grid of the page",
        "find the lines: edges by their class, and where faces pierce each other",
        "for each line from P to Q:",
        "    Q(0) ← 0, cuts ← ∅",
        "    for each face whose cells of the grid the line crosses:",
        "        [t0, t1] ← part of the line within the face's outline, by Cyrus and Beck",
        "        [t0, t1] ← part of that where the face is nearer",
        "        if t0 < t1: add +1 at t0 and −1 at t1 to the cuts",
        "    sort the cuts by t",
        "    for each cut: output the part before it with its invisibility Q",
        "        Q ← Q + 1, or Q − 1",
        "    output the last part",
    ],
};

/// Options for the lines of a drawing.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// Classes of lines to draw.
    pub classes: ClassSet,
    /// Edges whose faces are turned against each other by more than this are creases; radians, 0 … π.
    pub crease: f64,
    /// A crease goes on, though its edges get blunter, as long as they turn by more than this and it goes
    /// straight on; radians. `crease` or more, as by default, ends it if it is not a crease any more. Lower
    /// angles suit sculpted surfaces; on coarse meshes of round ones they show facets.
    pub crease_end: f64,
    /// True if the surroundings of an edge may decide against `crease`: edges from 3° on between
    /// flat faces that bend no further are creases, too, and a few edges of up to 60° that begin
    /// and end within round faces are none. A crease between round faces goes on where it fades, if it leads
    /// from one sharp corner to another.
    pub neighbours: bool,
    /// Penetrating faces to look for, if [`LineClass::Intersection`] is among the classes.
    pub intersections: Intersections,
    /// The material of a section's caps ([`crate::view::section::Section::cap_material`]): where they
    /// end is [`LineClass::Section`].
    pub cap_material: Option<usize>,
    /// Objects whose silhouettes are those of the smooth surfaces that meshes approximate, where
    /// normals are at a right angle to the sight, and not the edges between faces. The mesh is divided
    /// along them, with its new vertices on the smooth surface, and all lines are those of the divided
    /// mesh.
    pub smooth: Smooth,
    /// True if hidden lines are given too. Without them the work ends where a line is known to be
    /// hidden, and the drawing has visible lines only.
    pub hidden: bool,
    /// Largest distance that a line may be moved, as a part of the drawing's larger side: polylines are simplified
    /// within it, those shorter are left out, and lines much closer than it to another along their whole length are
    /// drawn once. A triangle lower than that, as a part of the model's extent, between two that continue each other
    /// makes no line, however rounding has turned it. 0 keeps everything that the grid resolves.
    pub tolerance: f64,
    /// Silhouettes of round parts and creases that end in the open are cut back to the next junction,
    /// or left out, where that takes at most this part of the drawing's larger side, or four times as
    /// much but three edges of the mesh; gaps between their tips are closed up to 0.3 times as wide.
    /// 0 leaves all as it is on the mesh, and so does a choice of classes that lacks some of
    /// [`ClassSet::default`]. 0.01 suits drawings that are examined.
    pub stubs: f64,
    /// Hidden lines, and parts of them, that lie within this part of the drawing's larger side of a visible one all
    /// along are left out: their strokes would run into each other, as where a view is nearly along an axis. 0
    /// keeps all but those that lie on visible ones.
    pub beneath: f64,
    /// Rule that joins vertices, so that faces find their neighbours.
    pub weld: Weld,
    /// Budget of the work, and its cancellation.
    pub work: Work,
}

/// Bytes that faces, edges and cells take for each triangle, about.
const PER_TRIANGLE: u64 = 96;

impl Default for Options {
    /// Creates a technical drawing: creases from 40°, visible and hidden lines, 0.05 pixels in a
    /// picture of 1000.
    fn default() -> Self {
        Self {
            classes: ClassSet::default(),
            crease: 40.0_f64.to_radians(),
            crease_end: std::f64::consts::PI,
            neighbours: false,
            intersections: Intersections::default(),
            cap_material: None,
            smooth: Smooth::Off,
            hidden: true,
            tolerance: 5e-5,
            stubs: 0.0,
            beneath: 0.0,
            weld: Weld::Auto,
            work: Work::default(),
        }
    }
}

impl Options {
    pub(super) fn check(&self) -> Result<()> {
        if !(0.0..=std::f64::consts::PI).contains(&self.crease) {
            return Err(Error::parameter("crease", self.crease.to_degrees(), "0 to 180 degrees"));
        }
        if !(0.0..=std::f64::consts::PI).contains(&self.crease_end) {
            let value = self.crease_end.to_degrees();
            return Err(Error::parameter("crease_end", value, "0 to 180 degrees"));
        }
        self.how().check()
    }

    /// Returns how lines are drawn; stubs are known by what they do not touch, so only where everything is drawn.
    fn how(&self) -> How {
        let edges = |set: ClassSet| {
            let loose = set.with(LineClass::Wire).with(LineClass::Section).with(LineClass::Mark);
            loose.with(LineClass::Tangent)
        };
        let all = edges(self.classes) == edges(ClassSet::default());
        let stubs = if all { self.stubs } else { 0.0 };
        let Self { tolerance, beneath, smooth, .. } = *self;
        How { tolerance, stubs, beneath, smooth: smooth != Smooth::Off }
    }
}

/// Draws the lines of a scene.
///
/// ```
/// use durer::math::{DMat4, DVec3, Vec3};
/// use durer::scene::{Camera, Instance, Mesh, Projection, Scene};
/// use durer::trace::NoTrace;
/// use durer::view::View;
/// use durer::visibility::line::hidden_line::{Options, draw};
///
/// // Two triangles, one behind the other and to the right.
/// let corner = |x: f32, z: f32| [[0.0, 0.0], [2.0, 0.0], [0.0, 2.0]].map(|[u, v]| Vec3::new(x + u, v, z));
/// let positions = [corner(0.0, 0.0), corner(0.5, -1.0)].concat();
/// let instance = Instance { mesh: 0, world_from_mesh: DMat4::IDENTITY, name: String::new() };
/// let mesh = Mesh { positions, ..Mesh::default() };
/// let scene = Scene { meshes: vec![mesh], instances: vec![instance], ..Scene::default() };
/// let camera = Camera {
///     eye: DVec3::new(1.0, 1.0, 5.0),
///     target: DVec3::new(1.0, 1.0, 0.0),
///     up: DVec3::Y,
///     projection: Projection::Orthographic { height: 4.0 },
///     near: 1.0,
///     far: 10.0,
/// };
/// let drawing = draw(&scene, &View::new(camera, 400, 400)?, &Options::default(), &mut NoTrace)?;
/// let hidden = drawing.length(|line| !line.is_visible());
/// assert!((hidden - 1.5).abs() < 1e-6); // on the left; below, the nearer one's side covers the other's
/// # Ok::<(), durer::Error>(())
/// ```
///
/// # Errors
/// [`Error::Parameter`] for an option out of its range, and what [`Faces::welded`] finds.
pub fn draw(
    scene: &Scene,
    view: &View,
    options: &Options,
    t: &mut impl Tracer<Step>,
) -> Result<Drawing> {
    options.check()?;
    let work = options.work.part();
    let stage = "faces for hidden lines";
    work.keep(stage, scene.triangle_count().saturating_mul(PER_TRIANGLE))?;
    let (mut faces, plane) = (Faces::welded(scene, options.weld)?, PicturePlane::new(view));
    let window = plane.window();
    let mut edges = faces.take_edges();
    let count = edges.count();
    let wanted = options.classes.contains(LineClass::Tangent);
    let requested = wanted || options.neighbours || options.smooth != Smooth::Off;
    let planes = requested.then(|| Planes::new(&faces));
    let mesh = (&faces, &edges);
    let known = |wanted: bool| planes.as_ref().filter(|_| wanted);
    let tangents = known(wanted).map(|p| Tangents::new(mesh, p, options.crease));
    let steps = known(options.neighbours).map(|p| Steps::new(mesh, p, options.crease));
    let known = Known {
        whole: Whole(None),
        tangents: tangents.as_ref(),
        steps: steps.as_ref().filter(|s| !s.is_empty()),
    };
    let round = options.smooth.round(mesh, planes.as_ref(), options.crease);
    let found = if let Some((round, planes)) = round.zip(planes) {
        let mut divided = divided(scene, (faces, &edges, planes), &plane, &round);
        edges = divided.faces.take_edges();
        let known = Known { whole: Whole(Some(&divided)), ..known };
        on_page(&divided.faces, plane, |p| pieces(&divided.faces, edges, known, p, options, t))
    } else {
        on_page(&faces, plane, |p| pieces(&faces, edges, known, p, options, t))
    };
    options.work.check()?;
    let lines = arranged(found, options.how());
    Ok(Drawing { window, lines, edges: count, ..Drawing::default() })
}

/// Finds the visible and the hidden pieces of all lines.
fn pieces(
    faces: &Faces,
    edges: Edges,
    known: Known<'_>,
    projected: &Projected,
    options: &Options,
    t: &mut impl Tracer<Step>,
) -> Pieces {
    t.step(|| Step::Page(projected.page));
    let (bodies, edges) = Bodies::of_edges(faces, edges);
    let whole = known.whole;
    let facing = Facing::new(faces, &bodies, &edges, projected, whole, options.tolerance);
    let lines = Lines::new(faces, &bodies, edges, &facing, options, (projected, known));
    let all = lines.some(0..lines.len()).map(|l| l.ends);
    let occluders = Occluders::new(faces, &bodies, &facing, projected, all);
    drop((bodies, facing));
    let ends = |l: FeatureLine| (l.class, l.smooth, l.ends.map(|v| v.at));
    let corners = corners(lines.some(0..lines.len()).map(ends));
    Pieces { all: hide(&lines, &occluders, whole, options, t), corners }
}

/// Returns the pieces of all lines.
fn hide(
    lines: &Lines<'_>,
    occluders: &Occluders<'_>,
    whole: Whole<'_>,
    options: &Options,
    t: &mut impl Tracer<Step>,
) -> Vec<Piece> {
    let count = lines.len();
    let jobs: Vec<_> = (0..count).step_by(JOB).map(|i| i..(i + JOB).min(count)).collect();
    let page = occluders.page();
    let new_met = || Met::new(occluders.count());
    let how = (page.touching, !options.hidden);
    let work = options.work.part();
    work.begin("lines", jobs.len() as u64);
    let hide = |range: Range<usize>| {
        let (mut pieces, mut spans, mut covers) = (Vec::new(), Vec::new(), Vec::new());
        let mut met = new_met();
        for line in lines.some(range) {
            if work.is_stopped() {
                break;
            }
            covers_of(&line, lines, occluders, how, (&mut met, &mut covers), |_| {});
            cut(line.piece(), &covers, line.fold, options.hidden, &mut spans, &mut pieces);
        }
        work.advance(1);
        // There for a while in parts and as a whole.
        work.keep_or_stop("hidden lines", 2 * (pieces.len() * size_of::<Piece>()) as u64);
        pieces
    };
    let pieces = joined(parallel::map(jobs, hide));
    let mut met = None;
    for line in lines.some(0..count) {
        t.step(|| {
            let (mut covers, mut tried) = (Vec::new(), Vec::new());
            let into = (met.get_or_insert_with(new_met), &mut covers);
            covers_of(&line, lines, occluders, how, into, |item| tried.push(whole.item(item)));
            covers.iter_mut().for_each(|c| c.item = whole.item(c.item));
            tried.sort_unstable();
            tried.dedup();
            let ends = line.ends.map(|v| page.plane_from_grid(v.at));
            let FeatureLine { class, smooth, fold, .. } = line;
            Step::Line { class, smooth, ends, tried, covers, fold }
        });
    }
    pieces
}

/// Lines per job.
const JOB: usize = 2048;

/// Finds the parts of a line that faces hide, by face. `enough` ends the search in places where the line is known to be
/// hidden. Calls `tried` with the item of each face that is compared, perhaps several times.
fn covers_of(
    line: &FeatureLine,
    lines: &Lines<'_>,
    occluders: &Occluders<'_>,
    (touching, enough): (f64, bool),
    (met, covers): (&mut Met, &mut Vec<Cover>),
    mut tried: impl FnMut(u32),
) {
    let mut found: Vec<(u32, Cover)> = Vec::new();
    occluders.along(&line.ends, met, |id, face, met| {
        if line.items.contains(&id) && id != NO_ITEM {
            return;
        }
        let Some(face) = face() else { return };
        if lines.is_at(line, face.item) {
            return;
        }
        tried(face.item);
        let own = line.reach > touching && occluders.same_body(line.items[0], face.item);
        let touching = if own { line.reach } else { touching };
        let Some(cover) = cover::cover(&line.ends, &face, touching) else { return };
        if does_not_hide(&face, line, occluders, lines.whole) {
            return;
        }
        found.push((id, cover));
        if enough && cover.left && cover.right && cover.weight > 0 {
            met.hide(cover.from, cover.to);
        }
    });
    // A face may have been met several times.
    found.sort_unstable_by_key(|(id, _)| *id);
    found.dedup_by_key(|(id, _)| *id);
    covers.clear();
    covers.extend(found.into_iter().map(|(_, cover)| cover));
}

/// Returns whether a face is beside a line where smooth surfaces are folded, so that it does not hide it.
fn does_not_hide(
    face: &occluders::Occluder,
    line: &FeatureLine,
    occluders: &Occluders<'_>,
    whole: Whole<'_>,
) -> bool {
    let outline = || line.class == LineClass::Silhouette || whole.at_outline(face.item);
    if line.vertices[0] != NO_ITEM && occluders.is_beside(face.item, line.vertices) && outline() {
        return true;
    }
    line.smooth && line.fold == [0.0; 2] && whole.is_beside(face.item, line.items)
}

/// Cuts one line into pieces.
fn cut(
    line: Piece,
    covers: &[Cover],
    fold: [f64; 2],
    hidden: bool,
    spans: &mut Vec<span::HiddenSpan>,
    pieces: &mut Vec<Piece>,
) {
    let [p, q] = line.ends;
    cover::spans(covers, fold, SLIVER / p.distance(q), hidden, spans);
    let [dx, dy] = q.minus(p).map(|d| d as f64);
    let at = |t: f64| match t {
        0.0 => p,
        1.0 => q,
        _ => GridPoint { x: p.x + (t * dx).round() as i32, y: p.y + (t * dy).round() as i32 },
    };
    for s in spans.iter().filter(|s| hidden || s.invisibility == 0) {
        pieces.push(Piece { ends: [at(s.from), at(s.to)], invisibility: s.invisibility, ..line });
    }
}
