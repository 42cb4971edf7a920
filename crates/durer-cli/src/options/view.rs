//! The options of the camera.

use super::UpAxis;
use crate::values::{self, positive};
use clap::Args;
use durer::math::DVec3;
use durer::view::projection::NamedView;

/// `--ortho`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Ortho {
    /// Height of the view in world units.
    Height(f64),
    /// Extent of the model in the view.
    Fit,
}

/// Parses `fit`, or a height above 0.
pub fn ortho(text: &str) -> Result<Ortho, String> {
    match text {
        "fit" => Ok(Ortho::Fit),
        _ => positive(text).map(Ortho::Height).map_err(|e| format!("{e}; or `fit`")),
    }
}

/// The camera: a named view, angles, a place, or one of the file's.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "View")]
pub struct ViewArgs {
    /// iso, front, back, left, right, top or bottom; fits the model into the picture
    #[arg(long, value_name = "VIEW", default_value = "iso",  conflicts_with_all = ["azimuth", "elevation", "eye", "camera"])]
    pub view: NamedView,
    /// Degrees around the up axis from the front, to the right; fits the model
    #[arg(long, value_name = "DEG", allow_hyphen_values = true, value_parser = values::number, conflicts_with_all = ["eye", "camera"])]
    pub azimuth: Option<f64>,
    /// Degrees above the horizon, -90 to 90; fits the model
    #[arg(long, value_name = "DEG", allow_hyphen_values = true, value_parser = values::elevation, conflicts_with_all = ["eye", "camera"])]
    pub elevation: Option<f64>,
    /// Position of the eye, in the coordinates of the file
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = values::vector, conflicts_with = "camera")]
    pub eye: Option<DVec3>,
    /// Point that the eye looks at [default: the middle of the model]
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = values::vector, requires = "eye")]
    pub target: Option<DVec3>,
    /// Direction that points up in the picture [default: the up axis]
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = values::direction, requires = "eye")]
    pub up: Option<DVec3>,
    /// Vertical angle of view in degrees
    #[arg(long, value_name = "DEG", allow_hyphen_values = true, value_parser = values::angle_of_view, conflicts_with_all = ["ortho", "camera"])]
    pub fov: Option<f64>,
    /// Parallel projection; the height of the view in world units, or `fit`
    #[arg(long, value_name = "HEIGHT", allow_hyphen_values = true, value_parser = ortho, conflicts_with = "camera")]
    pub ortho: Option<Ortho>,
    /// Distance of the near plane [default: by the model]
    #[arg(long, value_name = "DISTANCE", allow_hyphen_values = true, value_parser = values::number)]
    pub near: Option<f64>,
    /// Distance of the far plane [default: by the model]
    #[arg(long, value_name = "DISTANCE", allow_hyphen_values = true, value_parser = values::number)]
    pub far: Option<f64>,
    /// A camera of the file, by its name; `durer info` lists them
    #[arg(long, value_name = "NAME")]
    pub camera: Option<String>,
    /// Axis that points up: x, y, z, -x, -y or -z [default: by the format]
    #[arg(long, value_name = "AXIS", ignore_case = true, allow_hyphen_values = true)]
    pub up_axis: Option<UpAxis>,
}
