//! From a scene to a drawing: the order of the stages.

use super::{Exposure, Lighting, Surroundings};
use crate::math::DVec3;
use crate::scene::{Camera, Projection, Scene};
use crate::shade::PreparedLights;
use crate::target::drawing::{Drawing, Line, LineClass};
use crate::trace::NoTrace;
use crate::view::View;
use crate::visibility::line::{ClassSet, hidden_line, wireframe};
use crate::visibility::region::{self, Fill, Merge, hatch};
use crate::visibility::surface::Cull;
use crate::work::{Charge, Work};
use crate::{Error, Result};

/// Content of a drawing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum DrawStyle {
    /// Visible edges, and hidden ones in a style of their own.
    #[default]
    HiddenLine,
    /// All edges, hidden or not.
    Wireframe,
    /// The visible parts of surfaces in flat colours.
    Regions,
    /// Regions with lines on top.
    RegionsAndLines,
    /// Regions with exact shadows.
    Shadows,
}

impl DrawStyle {
    /// All styles.
    pub const ALL: &'static [Self] =
        &[Self::HiddenLine, Self::Wireframe, Self::Regions, Self::RegionsAndLines, Self::Shadows];

    /// Returns the name used on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::HiddenLine => "hidden-line",
            Self::Wireframe => "wireframe",
            Self::Regions => "regions",
            Self::RegionsAndLines => "regions+lines",
            Self::Shadows => "shadows",
        }
    }

    /// Returns whether it has filled parts.
    pub const fn has_regions(self) -> bool {
        matches!(self, Self::Regions | Self::RegionsAndLines | Self::Shadows)
    }
}

impl std::fmt::Display for DrawStyle {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}

impl std::str::FromStr for DrawStyle {
    type Err = Error;

    fn from_str(s: &str) -> Result<Self> {
        let expected = "hidden-line, wireframe, regions, regions+lines or shadows";
        let found = Self::ALL.iter().copied().find(|style| style.name() == s);
        found.ok_or_else(|| Error::parameter("style", s, expected))
    }
}

/// Everything about a drawing but the scene and the paper.
#[derive(Debug, Clone)]
pub struct DrawOptions {
    /// Style of the drawing.
    pub style: DrawStyle,
    /// Camera that sees the drawing.
    pub camera: Camera,
    /// Width over height of the camera's field of view; 1/1000 … 1000.
    pub aspect: f64,
    /// Classes of lines, and options for finding them; also for [`DrawStyle::RegionsAndLines`] and
    /// [`DrawStyle::Shadows`].
    pub lines: hidden_line::Options,
    /// Lights that shine on filled parts.
    pub lighting: Lighting,
    /// Exposure, as in [`super::RenderOptions::exposure`].
    pub exposure: Option<Exposure>,
    /// Faces to leave out of filled parts.
    pub cull: Cull,
    /// Rule that joins neighbours to one region.
    pub merge: Merge,
    /// True if regions reach under their neighbours, so that viewers show no hairline cracks;
    /// otherwise they share their borders.
    pub trapped: bool,
    /// The material of a section's caps ([`crate::view::section::Section::cap_material`]): their
    /// regions are distinguished and get the hatching of sections.
    pub cap_material: Option<usize>,
    /// Budget and cancellation of the work; also used for the lines, instead of the one in [`Self::lines`].
    pub work: Work,
}

impl DrawOptions {
    /// Creates the options of a square view with visible and hidden lines; regions are disjoint, and those of one
    /// shade are merged.
    pub fn new(camera: Camera) -> Self {
        Self {
            style: DrawStyle::HiddenLine,
            camera,
            aspect: 1.0,
            lines: hidden_line::Options::default(),
            lighting: Lighting::Auto,
            exposure: None,
            cull: Cull::None,
            merge: Merge::Shade,
            trapped: false,
            cap_material: None,
            work: Work::default(),
        }
    }
}

/// Rows of the screen that a drawing's view has; solvers work in the plane and do not depend on it.
const ROWS: f64 = 1000.0;

/// Trapped regions reach this part of the picture's height under their neighbours: half a dot of a
/// picture 1000 dots high.
const REACH: f64 = 5e-4;

/// Draws a scene: lines and regions in the plane of the picture.
///
/// The same input produces the same bytes on every CPU and number of threads.
///
/// # Errors
/// The errors of [`Camera::check`], [`Scene::check`] and the solvers' options.
pub fn draw(scene: &Scene, options: &DrawOptions) -> Result<Drawing> {
    if !(1e-3..=1e3).contains(&options.aspect) {
        return Err(Error::parameter("aspect", options.aspect, "between 1/1000 and 1000"));
    }
    scene.check()?;
    options.work.check()?;
    let columns = (ROWS * options.aspect).round().max(1.0) as u32;
    let view = View::new(options.camera, columns, ROWS as u32)?;
    let mut drawing = match options.style {
        DrawStyle::HiddenLine if options.cap_material.is_some() => caps(scene, &view, options)?,
        DrawStyle::HiddenLine => Drawing::default(),
        DrawStyle::Wireframe => return all_edges(scene, &view, options),
        _ => regions(scene, &view, options)?,
    };
    if options.style != DrawStyle::Regions {
        let cap_material = options.lines.cap_material.or(options.cap_material);
        let work = options.work.clone();
        let how = hidden_line::Options { cap_material, work, ..options.lines.clone() };
        let lines = hidden_line::draw(scene, &view, &how, &mut NoTrace)?;
        drawing.window = lines.window;
        drawing.lines.extend(lines.lines);
        drawing.edges = lines.edges;
    }
    Ok(drawing)
}

fn all_edges(scene: &Scene, view: &View, options: &DrawOptions) -> Result<Drawing> {
    let _faces = faces(scene, options)?;
    let hidden_line::Options { tolerance, weld, .. } = options.lines;
    let how = wireframe::Options { tolerance, weld };
    let drawing = wireframe::draw(scene, view, &how, &mut NoTrace)?;
    options.work.check().map(|()| drawing)
}

/// Bytes that faces and their edges take for each triangle, about.
const PER_TRIANGLE: u64 = 128;

/// Charges the memory for the faces of a scene to the budget.
fn faces(scene: &Scene, options: &DrawOptions) -> Result<Charge> {
    let bytes = scene.triangle_count().saturating_mul(PER_TRIANGLE);
    options.work.charge("faces of the drawing", bytes)
}

/// Returns the visible parts of a section's caps, to be filled or hatched among lines.
fn caps(scene: &Scene, view: &View, options: &DrawOptions) -> Result<Drawing> {
    let options = DrawOptions { trapped: false, merge: Merge::Material, ..options.clone() };
    region::draw_caps(scene, view, &lights(scene, &options), &region_options(&options))
}

fn regions(scene: &Scene, view: &View, options: &DrawOptions) -> Result<Drawing> {
    let _faces = faces(scene, options)?;
    let lights = lights(scene, options);
    let mut drawing = region::draw(scene, view, &lights, &region_options(options))?;
    // Fills show where shadows end; their outlines are drawn if requested.
    drawing.lines.retain(|l| options.lines.classes.contains(l.class));
    options.work.check().map(|()| drawing)
}

fn lights(scene: &Scene, options: &DrawOptions) -> PreparedLights {
    // One colour for each face: a mirror would show only one point of its surroundings.
    let light = (&options.lighting, &Surroundings::None);
    super::lights(scene, &options.camera, light, options.exposure)
}

fn region_options(options: &DrawOptions) -> region::Options {
    let reach = REACH * seen_height(&options.camera);
    region::Options {
        work: options.work.clone(),
        cull: options.cull,
        merge: options.merge,
        fill: if options.trapped { Fill::Trapped { reach } } else { Fill::Disjoint },
        shadows: options.style == DrawStyle::Shadows,
        cap_material: options.cap_material,
    }
}

/// Returns the height of the picture in the plane through the target, model units.
pub(super) fn seen_height(camera: &Camera) -> f64 {
    match camera.projection {
        Projection::Orthographic { height } => height,
        Projection::Perspective { fov_y } => {
            let distance: DVec3 = camera.target - camera.eye;
            2.0 * distance.length() * libm::tan(fov_y * 0.5)
        }
    }
}

/// Replaces the filled parts of a drawing by hatching: `spacing` is the distance of lines in the
/// darkest tone, plane units. For pens, which know no grey; regions have to be disjoint.
pub fn hatched(drawing: Drawing, spacing: f64) -> Drawing {
    let options = hatch::Options { spacing, ..hatch::Options::default() };
    let lines = hatch::hatch(&drawing.regions, &options);
    with_marks(Drawing { regions: Vec::new(), ..drawing }, lines)
}

/// Adds the marks that show tones, of [`super::tone_marks`] or [`hatch`], beneath the lines of a drawing.
pub fn with_marks(drawing: Drawing, marks: Vec<Line>) -> Drawing {
    let (mut lines, mut nearness) = (marks, drawing.nearness);
    if !nearness.is_empty() {
        nearness.splice(..0, lines.iter().map(|_| None));
    }
    lines.extend(drawing.lines);
    Drawing { lines, nearness, ..drawing }
}

/// Returns the classes named in `names`, separated by commas; `all` means all classes of edges except
/// [`LineClass::Wire`].
///
/// # Errors
/// [`Error::Parameter`] for a name that is none.
pub fn line_classes(names: &str) -> Result<ClassSet> {
    let one = |set: ClassSet, name: &str| {
        if name.trim() == "all" {
            let all = LineClass::ALL.iter().filter(|c| ClassSet::default().contains(**c));
            return Ok(all.fold(set, |set, class| set.with(*class)));
        }
        let class: LineClass = name.trim().parse().map_err(|_| {
            let expected = "classes joined by commas: silhouette, crease, border, non-manifold, \
                            material, intersection, section, tangent, shadow, wire; or all";
            Error::parameter("lines", name, expected)
        })?;
        Ok(set.with(class))
    };
    names.split(',').try_fold(ClassSet::NONE, one)
}
