//! Pictures of scenes that are larger than memory and are read in pieces, several times.
//!
//! A [`Survey`] of all pieces finds the visible items; a scene of these alone, in the same order, gives the picture of
//! the whole, bit for bit. Blended surfaces, shadows and metered exposure need the whole scene at once.

use super::{
    Cull, Exposure, Lighting, Places, RenderOptions, Report, Shading, Shadows, Status,
    SurfaceMethod, Surroundings, Survey, SurveyResult, TriangleFilter, Unseen, render,
};
use crate::scene::Scene;
use crate::target::{Framebuffer, NO_ITEM};
use crate::view::View;
use crate::visibility::surface::z_buffer::survey;
use crate::{Error, Result};

/// Alternative to a picture in pieces.
const INSTEAD: &str = "the whole scene must be in memory";

/// Checks that a picture can be made of pieces without lights; `have_normals` tells whether their vertices have
/// normals.
///
/// # Errors
/// The errors of [`RenderOptions::check`], and [`Error::Unsupported`] for options that need the whole scene at once.
pub fn check_pieces(options: &RenderOptions, have_normals: bool) -> Result<()> {
    options.check()?;
    let smooth = matches!(options.shading, Some(Shading::Gouraud | Shading::Phong));
    let panorama = matches!(options.surroundings, Surroundings::Panorama(_));
    // The brightness of lights that go with the camera is known.
    let metered = match (options.exposure, &options.lighting) {
        (Some(Exposure::Ev(_)), _) => false,
        (Some(Exposure::Auto), Lighting::Given(_)) => true,
        (_, Lighting::Auto) => panorama,
        (None, Lighting::Given(_)) => false,
    };
    let what = if options.algorithm != SurfaceMethod::ZBuffer {
        "a picture in pieces by another algorithm than the z-buffer"
    } else if options.shadows != Shadows::None {
        "a picture in pieces with shadows"
    } else if options.ambient_occlusion.is_some() {
        "a picture in pieces with ambient occlusion"
    } else if smooth && !have_normals {
        "a picture in pieces with normals from faces that meet"
    } else if metered {
        "a picture in pieces with an exposure that is found"
    } else {
        return Ok(());
    };
    Err(Error::Unsupported { what, instead: INSTEAD })
}

/// Begins to search for the triangles that are visible in a picture.
///
/// # Errors
/// The errors of [`RenderOptions::check`]; [`Error::Memory`] if the budget has no room for the samples.
pub fn survey(options: &RenderOptions) -> Result<Survey> {
    options.check()?;
    let view = options.view()?;
    let sample_reach = options.samples.reach();
    let filter = TriangleFilter { cull: options.cull, sample_reach, marks: options.marks };
    let centers = options.depth || options.item || options.normal;
    let RenderOptions { samples, level, .. } = *options;
    let work = options.work.clone();
    Survey::new(&view, survey::Options { samples, centers, filter, level, work })
}

/// Renders a scene of those items alone that are seen, in their order: the picture, and the report, of the whole.
///
/// # Errors
/// As [`render`].
pub fn render_seen(
    scene: &Scene,
    triangles: u64,
    seen: &SurveyResult,
    options: &RenderOptions,
) -> Result<(Framebuffer, Report)> {
    let (mut picture, report) = render(scene, options)?;
    if let Some(items) = &mut picture.item {
        for item in items.data_mut() {
            *item = seen.items.get(*item as usize).copied().unwrap_or(NO_ITEM);
        }
    }
    let survey_counts = seen.counts;
    let report = Report {
        triangles_in: triangles,
        non_finite: survey_counts.non_finite,
        clipped: survey_counts.clipped,
        culled: survey_counts.culled,
        drawn: survey_counts.drawn,
        ..report
    };
    Ok((picture, report))
}

/// Returns why nothing of a scene in pieces is visible: [`super::status`] of the whole. `again` passes all pieces to
/// its argument.
///
/// # Errors
/// Those of `again`, and as [`survey()`].
pub fn status_of_pieces<E: From<Error>>(
    options: &RenderOptions,
    mut again: impl FnMut(&mut dyn FnMut(&Scene) -> Result<()>) -> Result<(), E>,
) -> Result<Status, E> {
    let view = View::new(options.camera, options.width, options.height)?;
    let mut places = Places::new(&view);
    again(&mut |piece| {
        places.add(piece);
        Ok(())
    })?;
    if let Some(status) = places.status() {
        return Ok(status);
    }
    if options.window.is_some() {
        return Ok(Status::Ok);
    }
    if options.cull != Cull::None {
        let mut all = survey(&RenderOptions { cull: Cull::None, ..options.clone() })?;
        again(&mut |piece| all.add(piece))?;
        if !all.finish()?.items.is_empty() {
            return Ok(Status::Invisible(Unseen::Culled));
        }
    }
    Ok(Status::Invisible(Unseen::Missed))
}
