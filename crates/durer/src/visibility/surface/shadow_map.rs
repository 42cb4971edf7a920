//! Makes shadow maps: the scene as each light sees it. The method is in [`crate::shade::shadow`].
//!
//! A directional light sees the scene by a parallel view around its bounding sphere. A spot light up to
//! 60 degrees wide to each side looks along its axis; wider ones, and point lights, look along the six
//! axes of the world. Cost: for each map O(triangles + covered texels).

use crate::math::{DMat4, DVec3};
use crate::scene::{BoundingSphere, Camera, Projection, Scene};
use crate::shade::PreparedLights;
use crate::shade::light::PointLight;
use crate::shade::shadow::ShadowMap;
use crate::target::Pixels;
use crate::view::View;
use crate::visibility::surface::Cull;
use crate::visibility::surface::input::SurfaceInput;
use crate::visibility::surface::lit::Lit;
use crate::visibility::surface::picture;
use crate::visibility::surface::rows::active::ActiveList;
use crate::visibility::surface::rows::nearest::{DepthRow, Masked};
use crate::visibility::surface::setup::{Coverage, TriangleFilter};
use crate::visibility::surface::visible::with_lighting;
use crate::work::Work;
use crate::{Error, Result};

/// Options for making maps.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Options {
    /// Texels along the side of a map, 1 … 16,384; half as many where a light looks to six sides. Time
    /// and memory (4 bytes per texel) grow with its square, the steps along shadows' edges shrink with it.
    pub side: u32,
}

impl Default for Options {
    /// Returns the default: 2048.
    fn default() -> Self {
        Self { side: 2048 }
    }
}

/// The largest side: 1 GB a map.
pub const MAX_SIDE: u32 = 16_384;

/// Cosine of the widest half angle that one map can cover without wasting most of its texels.
const WIDEST: f32 = 0.5;

/// Width of a spot's map relative to the cone, so that points that are moved off their surface stay
/// in it.
const MARGIN: f64 = 1.05;

/// The near plane as a part of the far plane's distance: depth keeps enough digits, and little that
/// is this near to a light is left out.
const NEAR: f64 = 1e-3;

/// Makes the maps of all directional, spot and point lights into [`PreparedLights`].
///
/// # Errors
/// [`Error::Parameter`] for a side of 0, [`Error::TooLarge`] above [`MAX_SIDE`], and the errors of [`SurfaceInput::new`].
pub fn cast(scene: &Scene, lights: &mut PreparedLights, options: &Options) -> Result<()> {
    cast_within(&Work::default(), scene, lights, options)
}

/// Makes maps like [`cast`], within a budget.
///
/// # Errors
/// As [`cast`], and [`Error::Memory`] if the budget has no room for the maps.
pub(crate) fn cast_within(
    work: &Work,
    scene: &Scene,
    lights: &mut PreparedLights,
    options: &Options,
) -> Result<()> {
    if options.side == 0 {
        return Err(Error::parameter("side of a shadow map", 0, "at least 1 texel"));
    }
    if options.side > MAX_SIDE {
        let (value, limit) = (u64::from(options.side), u64::from(MAX_SIDE));
        return Err(Error::TooLarge { what: "side of a shadow map", value, limit });
    }
    let Some(sphere) = scene.bounding_sphere() else { return Ok(()) };
    let directions: Vec<DVec3> = lights.directional.iter().map(|l| l.to_light.as_dvec3()).collect();
    let points = lights.points.clone();
    for to_light in directions {
        let cameras = parallel_camera(&sphere, to_light).into_iter();
        let maps = maps((work, scene), lights, cameras, options.side)?;
        lights.shadows.directional.push(maps);
    }
    for light in &points {
        let place = lights.origin + light.position.as_dvec3();
        let cameras = cameras_of_point(light, place, &sphere);
        let side = if cameras.len() > 1 { options.side.div_ceil(2) } else { options.side };
        let maps = maps((work, scene), lights, cameras.into_iter(), side)?;
        lights.shadows.points.push(maps);
    }
    Ok(())
}

/// Creates a camera that sees all of a sphere along a direction.
fn parallel_camera(sphere: &BoundingSphere, to_light: DVec3) -> Option<Camera> {
    let r = sphere.radius;
    let projection = Projection::Orthographic { height: 2.0 * r * MARGIN };
    let eye = sphere.center + to_light * (2.0 * r);
    let camera = Camera {
        eye,
        target: sphere.center,
        up: across(to_light),
        projection,
        near: r * (2.0 - MARGIN),
        far: r * (2.0 + MARGIN),
    };
    camera.check().is_ok().then_some(camera)
}

/// Returns cameras that together cover all directions of a point or spot light.
fn cameras_of_point(light: &PointLight, eye: DVec3, sphere: &BoundingSphere) -> Vec<Camera> {
    let far = ((sphere.center - eye).length() + sphere.radius) * MARGIN;
    let camera = |axis: DVec3, fov_y: f64| Camera {
        eye,
        target: eye + axis * far,
        up: across(axis),
        projection: Projection::Perspective { fov_y },
        near: far * NEAR,
        far,
    };
    let cameras = match light.cone() {
        Some((axis, cosine)) if cosine >= WIDEST => {
            let fov_y = 2.0 * libm::acos(f64::from(cosine.min(1.0))) * MARGIN + 1e-3;
            vec![camera(axis.as_dvec3(), fov_y)]
        }
        _ => {
            let right_angle = std::f64::consts::FRAC_PI_2 * 1.01;
            let axes = DVec3::AXES.into_iter().flat_map(|axis| [axis, -axis]);
            axes.map(|axis| camera(axis, right_angle)).collect()
        }
    };
    cameras.into_iter().filter(|c| c.check().is_ok()).collect()
}

/// Returns a direction across another, always the same one.
fn across(axis: DVec3) -> DVec3 {
    let a = axis.abs();
    let least = if a.x <= a.y && a.x <= a.z {
        DVec3::X
    } else if a.y <= a.z {
        DVec3::Y
    } else {
        DVec3::Z
    };
    axis.cross(least).normalize_or(DVec3::Y)
}

fn maps(
    of: (&Work, &Scene),
    lights: &PreparedLights,
    cameras: impl Iterator<Item = Camera>,
    side: u32,
) -> Result<Vec<ShadowMap>> {
    let mut maps = Vec::new();
    for camera in cameras {
        let view = View::new(camera, side, side)?;
        let depths = depths(of, &view, lights)?;
        let world_from_position = DMat4::from_translation(lights.origin);
        let map_from_position = view.screen_from_world() * world_from_position;
        let (perspective, height) = match camera.projection {
            Projection::Perspective { fov_y } => (true, 2.0 * libm::tan(fov_y * 0.5)),
            Projection::Orthographic { height } => (false, height),
        };
        let texel = height / f64::from(side);
        maps.push(ShadowMap::new(&map_from_position, texel, perspective, depths)?);
    }
    Ok(maps)
}

/// Returns the depths of the triangles that cast shadows: opaque ones, and masked ones where they pass the alpha test.
fn depths(
    (work, scene): (&Work, &Scene),
    view: &View,
    lights: &PreparedLights,
) -> Result<Pixels<f32>> {
    let filter = TriangleFilter::new(Cull::None, 0);
    let mut input = SurfaceInput::within(work, scene, view, filter)?;
    let count = scene.triangle_count() as u32;
    let throws = |item: u32| item < count && input.run_of(item).coverage != Coverage::Blended;
    let kept: Vec<_> = input.triangles.iter().copied().filter(|t| throws(t.item)).collect();
    input.triangles = kept;
    let stage = (work, "shadow maps");
    let mut depths = Pixels::within(stage, view.width(), view.height(), 1.0)?;
    with_lighting(&input, lights, &picture::Options::default(), |lighting| {
        let (masked, mut lit) = (Masked::new(&input), Lit::new(lighting));
        let mut list = ActiveList::new(&input.triangles, view);
        let mut row = DepthRow::new(view.width());
        work.begin("rows of shadow maps", view.height().into());
        for y in (0..view.height()).take_while(|_| !work.is_stopped()) {
            work.advance(1);
            row.clear();
            for a in list.advance(y as i32, |_| ()) {
                masked.enter(&mut row, a.triangle, [a.x0, a.x1], y as i32, &mut lit, |_, _| ());
            }
            depths.row_mut(y).copy_from_slice(&row.depth);
        }
    });
    work.check()?;
    Ok(depths)
}
