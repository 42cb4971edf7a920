//! Visible regions: the visible parts of a scene's faces, as exact polygons.
//!
//! [`draw`] gives a finished [`Drawing`]: filled regions, flat-shaded, disjoint or trapped, with exact
//! shadows if requested. [`planar_map::solve`] gives the planar map behind it, whose faces know the
//! triangle that they show; [`hatch`] replaces tones by lines.

mod caps;
pub mod hatch;
mod paint;
pub mod planar_map;
mod shadow;
mod trap;

pub use caps::draw_caps;
pub use shadow::INFO as SHADOWS;

use crate::Result;
use crate::math::Rect;
use crate::scene::Scene;
use crate::shade::{PreparedLights, PreparedMaterials};
use crate::target::drawing::Drawing;
use crate::trace::NoTrace;
use crate::view::View;
use crate::visibility::surface::Cull;
use crate::work::Work;
use paint::Paint;
use planar_map::faces::{Face, Frame};
use planar_map::merge;
use shadow::{Lamps, World};

/// Rule that joins neighbours to one region.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Merge {
    /// No neighbours: each region shows one triangle, given by [`crate::target::drawing::Region::item`].
    Face,
    /// Neighbours that show one material in one colour (8-bit sRGB).
    #[default]
    Shade,
    /// Neighbours that show one material in like shades, of 16 between black and white, in the colour of most of the
    /// area that the material has in that shade: round faces become bands.
    Band,
    /// Areas with the same material, in the colour of most of their area.
    Material,
    /// Neighbours of one instance of a mesh, likewise.
    Part,
}

/// Extent of a filled shape beyond its border.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Fill {
    /// Shapes share their borders and do not overlap: for cutters, plotters and hatching.
    #[default]
    Disjoint,
    /// Shapes reach under the neighbours that are painted after them, so that viewers, which blend each
    /// shape's border by itself, show no hairline cracks.
    Trapped {
        /// Distance that it extends, plane units; half a pixel or dot of the finest output is
        /// enough. Silhouettes against the background do not grow.
        reach: f64,
    },
}

/// Options for drawing regions.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Options {
    /// Faces to leave out.
    pub cull: Cull,
    /// Budget of memory, and whether to go on.
    pub work: Work,
    /// Rule that joins neighbours to one region.
    pub merge: Merge,
    /// Extent of shapes beyond their borders.
    pub fill: Fill,
    /// True if faces cast shadows: light that another face keeps off is left out, and
    /// [`crate::target::drawing::LineClass::Shadow`] lines are given.
    pub shadows: bool,
    /// The material of the caps of a section ([`crate::view::section::Section::cap_material`]).
    pub cap_material: Option<usize>,
}

/// Draws the visible parts of a scene as filled regions.
///
/// Every face has one colour, by [`crate::shade::flat`] at its centroid. The drawing has regions, and
/// with [`Options::shadows`] the borders of shadows as lines. For hatching see [`hatch::hatch`].
///
/// # Errors
/// The errors of [`Scene::check`], and [`crate::Error::Limit`] for too many triangles.
pub fn draw(
    scene: &Scene,
    view: &View,
    lights: &PreparedLights,
    options: &Options,
) -> Result<Drawing> {
    scene.check()?;
    let world = World::new(scene)?;
    let lamps = Lamps::new(&world, view, lights, options.shadows)?;
    let how = planar_map::Options { cull: options.cull, work: options.work.clone() };
    let more = |frame: &Frame, faces: &[Face]| lamps.edges(frame, faces);
    let map = planar_map::divide(scene, view, &how, more, &mut NoTrace)?;
    let bytes = PreparedMaterials::bytes(scene);
    let _materials = options.work.charge(PreparedMaterials::STAGE, bytes)?;
    let paint = Paint::new(scene, view, lights, options, &world, &lamps, &map);
    let patches = merge::patches(&map.map, &paint.labels);
    let half = map.frame.half() * map.frame.unit;
    Ok(Drawing {
        window: Rect::new(-half, half).ok(),
        regions: paint.regions(&map, &patches, options),
        lines: paint.shadow_lines(&map),
        ..Drawing::default()
    })
}
