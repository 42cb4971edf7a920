//! The checks of options before anything is read, and the choices that follow from options alone.

use super::RenderArgs;
use super::cells::shots;
use crate::failure::Failure;
use crate::kind::{Kind, Wanted};
use crate::options::{Samples, Shadows};
use crate::values::{Algorithm, Size};
use crate::{camera, drawing, environment, input, section};
use durer::pipeline::SurfaceMethod;
use durer::raster::coverage::MAX_SIDE;

/// Checks options that the parser cannot check, before anything is read.
pub fn check(args: &RenderArgs) -> Result<(), Failure> {
    input::check_streams(&args.models)?;
    camera::check(&args.view)?;
    section::check(&args.section, args.drawing.sheet.is_some())?;
    let kind = wanted(args).kind;
    drawing::check(args, kind)?;
    let beside = if has_planes(args) { Kind::PNG } else { kind };
    args.picture.encoding.check(&[kind, beside])?;
    if !args.picture.sides.is_open() {
        check_tile(args)?;
    }
    check_size(args)?;
    environment::read(&args.look, &args.running.work)?;
    check_algorithm(args)?;
    shots(args, None).map(|_| ())
}

/// Checks that the picture is not too large.
pub fn check_size(args: &RenderArgs) -> Result<(), Failure> {
    let Size { width, height } = args.picture.rendered_size();
    let (kind, side) = (wanted(args).kind, width.max(height));
    if side > kind.max_side() {
        let (most, suffix) = (kind.max_side(), kind.suffix());
        let message =
            format!("--size {width}x{height}: a .{suffix} has room for {most} pixels along a side");
        return Err(Failure::Usage(message));
    }
    if args.stage.has_edges() && side > MAX_SIDE {
        let message = format!(
            "--size {width}x{height}: --edges are drawn on at most {MAX_SIDE} pixels a side"
        );
        return Err(Failure::Usage(message));
    }
    let (pixels, limit) = (u64::from(width) * u64::from(height), args.picture.max_pixels);
    if pixels > limit {
        let message = format!(
            "--size {width}x{height}: {pixels} pixels are above the limit of {limit}; \
             --max-pixels raises it"
        );
        return Err(Failure::Usage(message));
    }
    Ok(())
}

/// Checks that the chosen algorithm supports the other options.
fn check_algorithm(args: &RenderArgs) -> Result<(), Failure> {
    let usage = |text: String| Err(Failure::Usage(text));
    let rays = asks_for_rays(args);
    match args.picture.algorithm {
        Some(Algorithm::Surfaces(SurfaceMethod::Ray)) | None => {}
        Some(_) if rays == Some("--bounces") => {
            return usage("--bounces: only the algorithm ray follows reflected rays".to_owned());
        }
        Some(_) if rays.is_some() => {
            let message = "--shadows rays: only the algorithm ray casts them; --shadows map goes \
                           with all";
            return usage(message.to_owned());
        }
        Some(_) => {}
    }
    check_whole(args)?;
    match args.picture.algorithm {
        None if args.picture.aa == Samples::SixtyFour && rays.is_some() => {
            usage("--aa 64: rays take up to 16 samples".to_owned())
        }
        Some(Algorithm::Surfaces(method))
            if args.picture.aa == Samples::SixtyFour && method != SurfaceMethod::ABuffer =>
        {
            usage(format!("--aa 64: the A-buffer does that, {method} takes up to 16 samples"))
        }
        Some(Algorithm::All) if args.picture.viewports.is_some() => {
            usage("--algorithm all: one sheet at a time, so not with --viewports".to_owned())
        }
        Some(Algorithm::All) if args.stage.has_edges() => {
            usage("--edges: they go with one algorithm, not with --algorithm all".to_owned())
        }
        Some(Algorithm::Wireframe) if args.stage.has_occlusion() => usage(
            "--ambient-occlusion: a wireframe shows no surfaces that could be darkened".to_owned(),
        ),
        Some(Algorithm::All | Algorithm::Wireframe) if has_planes(args) => usage(
            "--item, --depth, --normal: they go with one algorithm that finds surfaces".to_owned(),
        ),
        _ => Ok(()),
    }
}

/// Checks that the tile is in the picture, both of whose sides are known.
pub fn check_tile(args: &RenderArgs) -> Result<(), Failure> {
    let Size { width, height } = args.picture.size;
    let Some(tile) = args.picture.tile else { return Ok(()) };
    let ends = [tile.x1(), tile.y1()].map(i32::unsigned_abs);
    if ends[0] <= width && ends[1] <= height {
        return Ok(());
    }
    Err(Failure::Usage(format!(
        "--tile {},{},{},{}: it ends at {},{}, beyond the picture of {width}x{height} pixels",
        tile.x0(),
        tile.y0(),
        tile.width(),
        tile.height(),
        ends[0],
        ends[1]
    )))
}

/// Refuses tiles together with options that need the whole picture.
fn check_whole(args: &RenderArgs) -> Result<(), Failure> {
    if args.picture.tile.is_none() {
        return Ok(());
    }
    let what = match args.picture.algorithm {
        Some(Algorithm::All) => "--algorithm all compares whole pictures",
        Some(Algorithm::Wireframe) => "the algorithm wireframe draws whole lines",
        Some(Algorithm::Surfaces(SurfaceMethod::DepthSort)) => {
            "the algorithm depth-sort puts all of a picture in order"
        }
        _ if args.stage.has_edges() => "--edges and --look technical draw whole lines",
        _ if args.stage.has_occlusion() => {
            "--ambient-occlusion and the looks studio and clay compare pixels with others far away"
        }
        _ => return Ok(()),
    };
    Err(Failure::Usage(format!("--tile: {what}; render without --tile, or without that option")))
}

fn has_planes(args: &RenderArgs) -> bool {
    let planes = &args.planes;
    planes.item.is_some() || planes.depth.is_some() || planes.normal.is_some()
}

/// Returns the option that only rays can fulfil.
pub fn asks_for_rays(args: &RenderArgs) -> Option<&'static str> {
    if args.look.bounces > 0 {
        Some("--bounces")
    } else {
        matches!(args.look.shadows, Shadows::Rays).then_some("--shadows")
    }
}

/// Returns how surfaces are found: as requested, or as fits the other options.
pub fn algorithm(args: &RenderArgs) -> Algorithm {
    args.picture.algorithm.unwrap_or_else(|| {
        Algorithm::Surfaces(match args.picture.aa {
            _ if asks_for_rays(args).is_some() => SurfaceMethod::Ray,
            Samples::SixtyFour => SurfaceMethod::ABuffer,
            _ => SurfaceMethod::ZBuffer,
        })
    })
}

/// Returns the output format: from --format, or from the output's name.
pub fn wanted(args: &RenderArgs) -> Wanted {
    Wanted::any(&args.output, args.format)
}
