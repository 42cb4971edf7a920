//! The visibility of a scene in its picture or drawing, with the reason if nothing is visible.
//!
//! An empty picture may be right or the result of one wrong number in a file. For most pictures the check reads only
//! the first rows; only if nothing is visible, the reason is searched: by outcodes of all vertices, then by rendering
//! again without options that may have hidden the model.

use super::{RenderOptions, render};
use crate::Result;
use crate::clip::outcode::{ClipDepths, Outcode};
use crate::math::{DVec3, Vec4};
use crate::scene::{AlphaMode, Camera, Projection, Scene, Topology};
use crate::target::Framebuffer;
use crate::target::drawing::Drawing;
use crate::view::View;
use crate::visibility::surface::{Background, Cull};

/// Visibility of a scene in its picture or drawing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Status {
    /// Something of it.
    Ok,
    /// The scene has no triangles, lines or points.
    Empty,
    /// Nothing of the scene is visible.
    Invisible(Unseen),
}

/// Reason why nothing of a scene is visible, as far as it is known.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Unseen {
    /// No vertex is finite.
    NotFinite,
    /// All of it is behind the eye.
    BehindEye,
    /// All of it is nearer than the near plane.
    BeforeNear,
    /// All of it is beyond the far plane.
    BeyondFar,
    /// All of it is to one side of the picture.
    Beside,
    /// All faces in view are seen from behind and left out.
    Culled,
    /// All materials in view are wholly transparent.
    Transparent,
    /// It is in the picture, in the colour of the background.
    LikeBackground,
    /// No sample of a pixel is on it, or no line of a drawing is requested.
    Missed,
}

impl Status {
    /// Returns the name used in reports.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Ok => "ok",
            Self::Empty => "empty",
            Self::Invisible(_) => "invisible",
        }
    }
}

/// Returns the status of a picture that [`render`] made with these options: whether anything of its scene is visible. A
/// window that shows only the background is [`Status::Ok`] if the whole picture may show something.
///
/// Cost: the first rows of most pictures; where a picture is empty, a pass over all vertices and up to
/// four more renderings.
///
/// # Errors
/// As [`render`].
pub fn status(scene: &Scene, options: &RenderOptions, picture: &Framebuffer) -> Result<Status> {
    if varies_in_rows(picture) {
        return Ok(Status::Ok);
    }
    let view = View::new(options.camera, options.width, options.height)?;
    if let Some(status) = status_of_vertices(scene, &view) {
        return Ok(status);
    }
    if options.window.is_some() {
        return Ok(Status::Ok);
    }
    let other = RenderOptions {
        background: Background::Color(other_color(options.background)),
        depth: false,
        item: false,
        normal: false,
        ..options.clone()
    };
    let (nothing, _) = render(&Scene::default(), &other)?;
    let (before_other, _) = render(scene, &other)?;
    if varies_in_rows(&before_other) {
        return Ok(Status::Invisible(Unseen::LikeBackground));
    }
    if before_other.color != nothing.color {
        return Ok(Status::Ok); // It fills the whole picture.
    }
    let shows = |scene: &Scene, options: &RenderOptions| -> Result<bool> {
        Ok(render(scene, options)?.0.color != nothing.color)
    };
    let whole = RenderOptions { cull: Cull::None, ..other.clone() };
    if options.cull != Cull::None && shows(scene, &whole)? {
        return Ok(Status::Invisible(Unseen::Culled));
    }
    let _copy = options.work.charge("copy of the model", scene.bytes())?;
    let missed = !shows(&made_opaque(scene), &whole)?;
    Ok(Status::Invisible(if missed { Unseen::Missed } else { Unseen::Transparent }))
}

/// Returns the status of a drawing that [`super::draw()`] made through this camera: whether anything of its scene is
/// visible; `aspect` is width over height of the camera's field of view.
///
/// Cost: O(1), or a pass over all vertices for an empty drawing.
///
/// # Errors
/// The errors of [`Camera::check`].
pub fn drawing_status(
    scene: &Scene,
    camera: &Camera,
    aspect: f64,
    drawing: &Drawing,
) -> Result<Status> {
    if !(drawing.lines.is_empty() && drawing.regions.is_empty()) {
        return Ok(Status::Ok);
    }
    let rows = 1000.0;
    let view = View::new(*camera, (rows * aspect).round().max(1.0) as u32, rows as u32)?;
    Ok(status_of_vertices(scene, &view).unwrap_or(Status::Invisible(Unseen::Missed)))
}

/// Returns whether a row has pixels of different colours; a background has not.
fn varies_in_rows(picture: &Framebuffer) -> bool {
    let width = picture.width().max(1) as usize;
    picture.color.data().chunks(width).any(|row| row.iter().any(|pixel| *pixel != row[0]))
}

/// Returns a colour that is well apart from the background's.
fn other_color(background: Background) -> Vec4 {
    let ink = background.ink();
    Vec4::new(ink.x, 0.5, 1.0 - ink.z, 1.0)
}

/// Returns the findings from the vertices' positions; `None` if some may be seen.
fn status_of_vertices(scene: &Scene, view: &View) -> Option<Status> {
    let mut places = Places::new(view);
    places.add(scene);
    places.status()
}

/// Positions of all vertices used by primitives, of a scene that may come in pieces.
pub(crate) struct Places<'a> {
    view: &'a View,
    any: bool,
    beyond_all: Option<Outcode>,
    behind_all: bool,
}

impl<'a> Places<'a> {
    /// Creates the positions of no vertices.
    pub(crate) fn new(view: &'a View) -> Self {
        Self { view, any: false, beyond_all: None, behind_all: true }
    }

    /// Adds the vertices of a scene, or of the next piece of one.
    pub(crate) fn add(&mut self, scene: &Scene) {
        for p in drawn_vertices(scene) {
            self.any = true;
            if !p.is_finite() {
                continue;
            }
            let clip = self.view.clip_from_world() * p.extend(1.0);
            let code = Outcode::of_homogeneous(clip, ClipDepths::NegativeOneToOne);
            self.behind_all &= clip.w <= 0.0;
            self.beyond_all = Some(self.beyond_all.map_or(code, |all| all & code));
        }
    }

    /// Returns the status that follows from them; `None` if some may be visible.
    pub(crate) fn status(&self) -> Option<Status> {
        if !self.any {
            return Some(Status::Empty);
        }
        let Some(beyond) = self.beyond_all else {
            return Some(Status::Invisible(Unseen::NotFinite));
        };
        let perspective = matches!(self.view.camera().projection, Projection::Perspective { .. });
        let why = if self.behind_all && perspective {
            Unseen::BehindEye
        } else if beyond.contains(Outcode::NEAR) {
            Unseen::BeforeNear
        } else if beyond.contains(Outcode::FAR) {
            Unseen::BeyondFar
        } else if beyond.is_inside() {
            return None;
        } else {
            Unseen::Beside
        };
        Some(Status::Invisible(why))
    }
}

/// Returns all vertices that a triangle, a line or a point uses, in world space.
fn drawn_vertices(scene: &Scene) -> impl Iterator<Item = DVec3> + '_ {
    scene.instances.iter().flat_map(|instance| {
        let mesh = &scene.meshes[instance.mesh];
        let count = mesh.primitive_count()
            * match mesh.topology {
                Topology::Points => 1,
                Topology::Lines => 2,
                Topology::Triangles => 3,
            };
        let vertex = |i: usize| mesh.indices.as_ref().map_or(i, |indices| indices[i] as usize);
        (0..count).map(move |i| {
            instance.world_from_mesh.transform_point3(mesh.positions[vertex(i)].as_dvec3())
        })
    })
}

/// Returns the scene with all materials opaque.
fn made_opaque(scene: &Scene) -> Scene {
    let mut scene = scene.clone();
    for material in &mut scene.materials {
        material.alpha_mode = AlphaMode::Opaque;
    }
    scene
}

impl std::fmt::Display for Unseen {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::NotFinite => "no vertex has finite coordinates",
            Self::BehindEye => "all of it is behind the eye",
            Self::BeforeNear => "all of it is nearer than the near plane",
            Self::BeyondFar => "all of it is beyond the far plane",
            Self::Beside => "all of it is outside the picture",
            Self::Culled => "all faces in view are seen from behind and left out",
            Self::Transparent => "all materials in view are wholly transparent",
            Self::LikeBackground => "it has the colour of the background",
            Self::Missed => "no pixel or line falls on it",
        })
    }
}
