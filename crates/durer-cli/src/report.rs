//! The report of `durer render --json`.

pub mod drawing;
mod growing;
pub mod noticed;

pub use growing::Growing;

use durer::pipeline::{self, Status, Unseen};
use durer::scene::{Camera, Projection};
use durer_formats::wording;
use serde::Serialize;
use std::sync::{Mutex, PoisonError};

/// A model that could be read.
#[derive(Debug, Serialize)]
pub struct ModelReport {
    /// Path of the model, as given on the command line.
    pub model: String,
    /// The format found.
    pub format: String,
    /// Seconds for reading and decoding.
    pub read_seconds: f64,
    /// Repairs and omissions.
    pub warnings: Vec<String>,
}

/// One picture, with its further planes.
#[derive(Debug, Default, Serialize)]
pub struct PictureReport {
    /// Files that were written; `-` is standard output.
    pub files: Vec<String>,
    /// `ok`, `empty` or `invisible`: whether anything of the model is visible.
    pub status: &'static str,
    /// In pixels; 0 for vectors.
    pub width: u32,
    /// In pixels; 0 for vectors.
    pub height: u32,
    /// Over all viewports.
    pub triangles: Triangles,
    /// Report on the drawing, if it is one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub drawing: Option<drawing::DrawingReport>,
    /// Seconds for vertices, clipping and set-up.
    pub geometry_seconds: f64,
    /// Seconds for rasterization, shading and resolve.
    pub raster_seconds: f64,
    /// Seconds for encoding and writing.
    pub encode_seconds: f64,
    /// Method that found the surfaces: an algorithm's name, `wireframe`, or `all`.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub algorithm: String,
    /// The eye of each viewport.
    pub cameras: Vec<CameraReport>,
    /// True if it was not opaque, and had to become so.
    #[serde(skip)]
    pub flattened: bool,
    /// Messages about features of the model that the picture does not show.
    #[serde(skip)]
    pub notes: Vec<String>,
    /// For `all`: each algorithm beside the z-buffer.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub compared: Vec<ComparedReport>,
}

/// An eye, as the options of `render` and `warp` take it.
#[derive(Debug, Serialize)]
pub struct CameraReport {
    /// Position of the eye in the world.
    pub eye: [f64; 3],
    /// Point that it looks at.
    pub target: [f64; 3],
    /// Direction that points up in the picture.
    pub up: [f64; 3],
    /// Vertical angle of view in degrees, in perspective.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fov: Option<f64>,
    /// Height of the view in world units, in parallel projection.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ortho: Option<f64>,
    /// Distance of the near plane.
    pub near: f64,
    /// Distance of the far plane.
    pub far: f64,
}

impl From<&Camera> for CameraReport {
    fn from(camera: &Camera) -> Self {
        let (fov, ortho) = match camera.projection {
            Projection::Perspective { fov_y } => (Some(fov_y.to_degrees()), None),
            Projection::Orthographic { height } => (None, Some(height)),
        };
        let Camera { eye, target, up, near, far, .. } = *camera;
        let [eye, target, up] = [eye, target, up].map(|v| v.to_array());
        Self { eye, target, up, fov, ortho, near, far }
    }
}

/// One algorithm of a contact sheet.
#[derive(Debug, Serialize)]
pub struct ComparedReport {
    /// Its name.
    pub algorithm: &'static str,
    /// Number of pixels whose item differs from the z-buffer's.
    pub differing_pixels: u64,
    /// Seconds for all of its picture.
    pub seconds: f64,
}

/// Counts of triangles.
#[derive(Debug, Default, Serialize)]
pub struct Triangles {
    /// Handed to the renderer.
    #[serde(rename = "in")]
    pub given: u64,
    /// Left out because a vertex is not finite.
    pub non_finite: u64,
    /// Cut by a plane of the view volume.
    pub clipped: u64,
    /// Left out: outside the view, turned away, or without area.
    pub culled: u64,
    /// Handed to the rasterizer.
    pub drawn: u64,
}

/// A model that could not be rendered.
#[derive(Debug, Serialize)]
pub struct Failed {
    /// Path of the model, as given on the command line.
    pub model: String,
    /// Reason of the failure.
    pub error: String,
}

impl PictureReport {
    /// Sets the status from the viewports': the model is visible if one shows it. If nothing is visible, returns a
    /// message with the reason.
    pub fn set_status(&mut self, of_cells: &[Status]) -> Option<String> {
        let shown = of_cells.iter().find(|s| **s == Status::Ok);
        let status = shown.or(of_cells.first()).copied().unwrap_or(Status::Ok);
        self.status = status.name();
        match status {
            Status::Ok => None,
            Status::Empty => Some("there is nothing to draw in it".to_owned()),
            Status::Invisible(why) => Some(format!("nothing of it is seen: {why}{}", hint(why))),
        }
    }

    /// Adds the renderer's report on one viewport.
    pub fn add(&mut self, report: &pipeline::Report) {
        self.triangles.given += report.triangles_in;
        self.triangles.non_finite += report.non_finite;
        self.triangles.clipped += report.clipped;
        self.triangles.culled += report.culled;
        self.triangles.drawn += report.drawn;
        self.geometry_seconds += report.geometry_seconds;
        self.raster_seconds += report.raster_seconds;
    }
}

/// Returns advice for a model of which nothing is visible.
fn hint(why: Unseen) -> &'static str {
    match why {
        Unseen::Culled => "; --cull none shows them",
        Unseen::LikeBackground => "; --background or --color makes it seen",
        Unseen::BeforeNear => "; --near is the distance of that plane",
        Unseen::BeyondFar => "; --far is the distance of that plane",
        Unseen::BehindEye | Unseen::Beside => "; without a camera the view is fitted to the model",
        _ => "",
    }
}

/// Returns the peak of the resident memory, as Linux reports it.
pub fn peak_memory() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()?.checked_mul(1024)
}

/// Writes a value as indented JSON, with a newline, to standard output.
pub fn print(value: &impl Serialize) -> Result<(), crate::failure::Failure> {
    let mut text = serde_json::to_string_pretty(value)
        .map_err(|e| crate::failure::Failure::Data(format!("the report: {e}")))?;
    text.push('\n');
    print_text(&wording::json(&text))
}

/// Text that is kept instead of going to standard output, if requested.
static KEPT: Mutex<Option<String>> = Mutex::new(None);

/// Collects text from now on, and returns the text collected so far.
pub fn keep() -> String {
    KEPT.lock().unwrap_or_else(PoisonError::into_inner).replace(String::new()).unwrap_or_default()
}

/// Writes text to standard output, or keeps it.
pub fn print_text(text: &str) -> Result<(), crate::failure::Failure> {
    use std::io::Write;
    if let Some(kept) = &mut *KEPT.lock().unwrap_or_else(PoisonError::into_inner) {
        kept.push_str(text);
        return Ok(());
    }
    let mut out = std::io::stdout().lock();
    out.write_all(text.as_bytes())
        .and_then(|()| out.flush())
        .map_err(|e| crate::failure::Failure::of_stdout(&e))
}
