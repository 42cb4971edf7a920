//! The camera for the options.

use crate::failure::Failure;
use crate::options::{Ortho, PictureArgs, ViewArgs};
use crate::values::Size;
use durer::math::{DQuat, DVec3};
use durer::scene::{Camera, NamedCamera, Projection, Scene, UpAxis};
use durer::view::fit::{self, fit_turning};
use durer::view::projection::{FitOptions, Lens, NamedView, ViewDirection, fit_scene};

/// Angle of view of a fitted camera, degrees: like a lens of 70 mm on a full frame.
pub const FOV: f64 = 30.0;

/// The part of the picture that a fitted model leaves free at each border.
const MARGIN: f64 = 0.03;

/// Selection of one of the pictures that the options request.
#[derive(Debug, Clone, Copy)]
pub struct Shot {
    /// The view of a viewport; `None` = the one of the view options.
    pub view: Option<NamedView>,
    /// Its size.
    pub size: Size,
    /// Its place in a turntable, and the number of frames.
    pub turn: Option<(u32, u32)>,
}

impl Shot {
    /// Returns the only picture, or one frame of a turntable.
    pub fn of(picture: &PictureArgs, frame: Option<u32>) -> Self {
        Self { view: None, size: picture.size, turn: frame.zip(picture.turntable) }
    }

    fn aspect(&self) -> f64 {
        f64::from(self.size.width) / f64::from(self.size.height)
    }

    /// Returns the angle by which the turntable has turned, in degrees.
    fn turned(&self) -> f64 {
        self.turn.map_or(0.0, |(frame, count)| 360.0 * f64::from(frame) / f64::from(count))
    }
}

/// Checks option combinations that the parser does not know to be wrong.
pub fn check(args: &ViewArgs) -> Result<(), Failure> {
    let usage = |text: &str| Err(Failure::Usage(text.to_owned()));
    match (args.eye, args.target) {
        (Some(eye), Some(target)) if eye == target => {
            return usage("--target: it must be a point other than --eye");
        }
        (Some(_), _) if args.ortho == Some(Ortho::Fit) => {
            return usage("--ortho fit: with --eye the height must be given as a number");
        }
        _ => {}
    }
    let parallel = args.ortho.is_some() || args.camera.is_some();
    match (args.near, args.far) {
        (Some(near), Some(far)) if near >= far => usage("--near: it must be less than --far"),
        (Some(near), _) if near <= 0.0 && !parallel => {
            usage("--near: it must be above 0 for a perspective view")
        }
        (_, Some(far)) if far <= 0.0 && !parallel => {
            usage("--far: it must be above 0 for a perspective view")
        }
        _ => Ok(()),
    }
}

/// Model that cameras are fitted to: a scene in memory, or one that is read in pieces.
pub trait Sights {
    /// Returns the axis that points up.
    fn up_axis(&self) -> UpAxis;

    /// Returns the cameras of the file.
    fn cameras(&self) -> &[NamedCamera];

    /// Returns the middle of the box around everything drawn; the origin if there is nothing.
    fn center(&mut self) -> Result<DVec3, Failure>;

    /// Returns the distances of near and far planes around the part that a camera can see.
    fn depth_range(&mut self, camera: &Camera) -> Result<(f64, f64), Failure>;

    /// Returns the camera that sees all of it; with `turning`, also while it turns.
    fn fitted(
        &mut self,
        direction: &ViewDirection,
        options: &FitOptions,
        turning: bool,
    ) -> Result<Camera, Failure>;
}

impl Sights for &Scene {
    fn up_axis(&self) -> UpAxis {
        self.up_axis
    }

    fn cameras(&self) -> &[NamedCamera] {
        &self.cameras
    }

    fn center(&mut self) -> Result<DVec3, Failure> {
        Ok(fit::center(self).unwrap_or(DVec3::ZERO))
    }

    fn depth_range(&mut self, camera: &Camera) -> Result<(f64, f64), Failure> {
        Ok(fit::depth_range(camera, self))
    }

    fn fitted(
        &mut self,
        direction: &ViewDirection,
        options: &FitOptions,
        turning: bool,
    ) -> Result<Camera, Failure> {
        let fit = if turning { fit_turning } else { fit_scene };
        fit(self, direction, options).map_err(|e| Failure::Data(e.to_string()))
    }
}

/// Returns the camera of one picture of a scene.
pub fn camera(args: &ViewArgs, mut scene: &Scene, shot: &Shot) -> Result<Camera, Failure> {
    camera_by(args, &mut scene, shot)
}

/// Returns the camera of one picture.
pub fn camera_by(args: &ViewArgs, scene: &mut impl Sights, shot: &Shot) -> Result<Camera, Failure> {
    let mut camera = if let Some(name) = &args.camera {
        of_file(name, scene, shot)?
    } else if let Some(eye) = args.eye {
        at(eye, args, scene, shot)?
    } else {
        fitted(args, scene, shot)?
    };
    camera.near = args.near.unwrap_or(camera.near);
    camera.far = args.far.unwrap_or(camera.far);
    keep_order(args, &mut camera);
    camera.check().map_err(|e| Failure::Usage(format!("--{e}")))?;
    Ok(camera)
}

/// Moves the clipping distance fitted to the model if the other one, given by the user, is beyond it.
fn keep_order(args: &ViewArgs, camera: &mut Camera) {
    if camera.near < camera.far {
        return;
    }
    match (args.near, args.far) {
        (Some(near), None) => camera.far = near + near.abs().max(1.0),
        (None, Some(far)) if far > 0.0 => camera.near = far * 1e-3,
        (None, Some(far)) => camera.near = far - far.abs().max(1.0),
        _ => {}
    }
}

/// Returns a camera of the file, turned around the middle of the model.
fn of_file(name: &str, scene: &mut impl Sights, shot: &Shot) -> Result<Camera, Failure> {
    let found = scene.cameras().iter().find(|c| c.name == name).ok_or_else(|| {
        let names: Vec<&str> = scene.cameras().iter().map(|c| c.name.as_str()).collect();
        let there = match names[..] {
            [] => "the file has no cameras".to_owned(),
            _ => format!("there are {}", names.join(", ")),
        };
        Failure::Data(format!("--camera: no camera `{name}`; {there}"))
    })?;
    let camera = found.camera;
    if shot.turned() == 0.0 {
        return Ok(camera);
    }
    let pivot = scene.center()?;
    Ok(turned(camera, pivot, scene.up_axis(), shot))
}

/// Returns a camera in a given place, turned around its target.
fn at(
    eye: DVec3,
    args: &ViewArgs,
    scene: &mut impl Sights,
    shot: &Shot,
) -> Result<Camera, Failure> {
    let front = NamedView::Front.direction(scene.up_axis());
    let target = match args.target {
        Some(target) => target,
        None => {
            let center = scene.center()?;
            if center == eye { eye - front.to_eye() } else { center }
        }
    };
    let up = args.up.unwrap_or_else(|| fit::up_for(target - eye, scene.up_axis()));
    let camera = Camera { eye, target, up, projection: projection(args), near: 1.0, far: 2.0 };
    let camera = turned(camera, target, scene.up_axis(), shot);
    let (near, far) = scene.depth_range(&camera)?;
    Ok(Camera { near, far, ..camera })
}

fn projection(args: &ViewArgs) -> Projection {
    match args.ortho {
        Some(Ortho::Height(height)) => Projection::Orthographic { height },
        _ => Projection::Perspective { fov_y: args.fov.unwrap_or(FOV).to_radians() },
    }
}

/// Returns the camera after the share of a full turn around the up axis through the pivot.
fn turned(camera: Camera, pivot: DVec3, up_axis: UpAxis, shot: &Shot) -> Camera {
    let half = shot.turned().to_radians() * 0.5;
    if half == 0.0 {
        return camera;
    }
    let (sin, cos) = libm::sincos(half);
    let axis = NamedView::Front.direction(up_axis).up() * sin;
    let turn = DQuat::from_xyzw(axis.x, axis.y, axis.z, cos);
    let around = |p: DVec3| pivot + turn * (p - pivot);
    let (eye, target) = (around(camera.eye), around(camera.target));
    Camera { eye, target, up: turn * camera.up, ..camera }
}

/// Returns a camera that sees the whole model; the same distance for all frames of a turntable.
fn fitted(args: &ViewArgs, scene: &mut impl Sights, shot: &Shot) -> Result<Camera, Failure> {
    let (azimuth, elevation) = match (shot.view, args.azimuth, args.elevation) {
        (Some(view), ..) => view.angles(),
        (None, None, None) => args.view.angles(),
        (None, azimuth, elevation) => (azimuth.unwrap_or(0.0), elevation.unwrap_or(0.0)),
    };
    let azimuth = azimuth + shot.turned();
    let direction = ViewDirection::from_angles(azimuth, elevation, scene.up_axis())
        .map_err(|e| Failure::Usage(format!("--{e}")))?;
    let lens = match args.ortho {
        Some(_) => Lens::Orthographic,
        None => Lens::Perspective { fov_y: args.fov.unwrap_or(FOV).to_radians() },
    };
    let options = FitOptions { lens, aspect: shot.aspect(), margin: MARGIN };
    let mut camera = scene.fitted(&direction, &options, shot.turn.is_some())?;
    if let Some(Ortho::Height(height)) = args.ortho {
        camera.projection = Projection::Orthographic { height };
    }
    Ok(camera)
}
