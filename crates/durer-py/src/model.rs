//! Models: read from bytes, written for pickling, described.

use crate::error;
use crate::threads::on_threads;
use durer::scene::{Camera, Projection, Scene};
use durer_cli::embedded::{Folder, InMemory};
use durer_formats::{Limits, NoResources, Pose, ReadOptions, Resources, read_model};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::pybacked::PyBackedBytes;
use pyo3::types::{PyBytes, PyDict};
use std::path::PathBuf;

/// A scene with the name and format of its file.
#[pyclass(frozen, module = "durer._durer")]
pub struct Model {
    /// Meshes, materials, lights and cameras; passes [`Scene::check`].
    pub scene: Scene,
    name: String,
    format: String,
    warnings: Vec<String>,
    animations: Vec<String>,
}

impl Model {
    /// Creates a model without a file.
    pub fn of_scene(scene: Scene, name: String) -> Self {
        Self { scene, name, format: String::new(), warnings: Vec::new(), animations: Vec::new() }
    }

    /// Returns the model in the form of the command's functions.
    pub fn subject(&self) -> InMemory<'_> {
        InMemory { scene: &self.scene, name: &self.name, format: &self.format }
    }
}

/// A camera in numbers: eye, target, up, angle of view in radians or else height of the view, near, far.
pub type CameraNumbers = ([f64; 3], [f64; 3], [f64; 3], Option<f64>, Option<f64>, f64, f64);

/// Returns a camera in numbers.
pub fn numbers(camera: &Camera) -> CameraNumbers {
    let (fov, height) = match camera.projection {
        Projection::Perspective { fov_y } => (Some(fov_y), None),
        Projection::Orthographic { height } => (None, Some(height)),
    };
    let [eye, target, up] = [camera.eye, camera.target, camera.up].map(|v| v.to_array());
    (eye, target, up, fov, height, camera.near, camera.far)
}

/// Returns a camera from its numbers.
pub fn camera((eye, target, up, fov, height, near, far): CameraNumbers) -> Camera {
    let projection = match (fov, height) {
        (_, Some(height)) => Projection::Orthographic { height },
        (fov, None) => Projection::Perspective { fov_y: fov.unwrap_or(0.0) },
    };
    Camera { eye: eye.into(), target: target.into(), up: up.into(), projection, near, far }
}

#[pymethods]
impl Model {
    #[getter]
    fn name(&self) -> &str {
        &self.name
    }

    #[getter]
    fn format(&self) -> &str {
        &self.format
    }

    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.warnings.clone()
    }

    #[getter]
    fn triangle_count(&self) -> u64 {
        self.scene.triangle_count()
    }

    /// Returns the lower and the upper corner of the box around the model; `None` if it is empty.
    fn bounds(&self, py: Python<'_>) -> Option<[[f64; 3]; 2]> {
        py.detach(|| self.scene.bounds().map(|b| [b.min.to_array(), b.max.to_array()]))
    }

    /// Returns counts and names.
    fn info<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let info = PyDict::new(py);
        let vertices: usize = self.scene.meshes.iter().map(|m| m.positions.len()).sum();
        info.set_item("name", &self.name)?;
        info.set_item("format", &self.format)?;
        info.set_item("up_axis", self.scene.up_axis.name())?;
        info.set_item("triangles", self.scene.triangle_count())?;
        info.set_item("vertices", vertices)?;
        info.set_item("meshes", self.scene.meshes.len())?;
        info.set_item("instances", self.scene.instances.len())?;
        let materials: Vec<&str> = self.scene.materials.iter().map(|m| m.name.as_str()).collect();
        info.set_item("materials", materials)?;
        info.set_item("textures", self.scene.textures.len())?;
        info.set_item("lights", self.scene.lights.len())?;
        let cameras: Vec<&str> = self.scene.cameras.iter().map(|c| c.name.as_str()).collect();
        info.set_item("cameras", cameras)?;
        info.set_item("animations", &self.animations)?;
        Ok(info)
    }

    /// Returns the model as bytes, for pickling.
    fn to_bytes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let all = (&self.scene, &self.name, &self.format, &self.warnings, &self.animations);
        let bytes = py.detach(|| postcard::to_stdvec(&all));
        let bytes = bytes
            .map_err(|e| PyValueError::new_err(format!("the scene cannot be pickled: {e}")))?;
        Ok(PyBytes::new(py, &bytes))
    }

    /// Returns the model from bytes returned by `to_bytes`.
    #[staticmethod]
    fn from_bytes(py: Python<'_>, bytes: PyBackedBytes) -> PyResult<Self> {
        type All = (Scene, String, String, Vec<String>, Vec<String>);
        let wrong = |e: String| PyValueError::new_err(format!("these bytes are not a scene: {e}"));
        let all: Result<All, _> = py.detach(|| postcard::from_bytes(&bytes));
        let (scene, name, format, warnings, animations) = all.map_err(|e| wrong(e.to_string()))?;
        scene.check().map_err(|e| wrong(e.to_string()))?;
        Ok(Self { scene, name, format, warnings, animations })
    }
}

/// Reads a model from bytes; files that it refers to are searched for beside `path`.
#[pyfunction]
#[pyo3(signature = (data, name, path, threads, limits, pose))]
fn read(
    py: Python<'_>,
    data: PyBackedBytes,
    name: String,
    path: Option<PathBuf>,
    threads: usize,
    limits: (Option<u64>, Option<u64>),
    pose: (Option<String>, Option<f64>),
) -> PyResult<Model> {
    let default = Limits::default();
    let posed = pose.0.is_some() || pose.1.is_some();
    let options = ReadOptions {
        limits: Limits {
            primitives: limits.0.unwrap_or(default.primitives),
            decoded_bytes: limits.1.unwrap_or(default.decoded_bytes),
            ..default
        },
        pose: posed.then(|| Pose { animation: pose.0, time: pose.1.unwrap_or(0.0) }),
        ..ReadOptions::default()
    };
    let folder = path.map(|path| Folder::of(&path)).transpose()?;
    let resources = folder.as_ref().map_or(&NoResources as &(dyn Resources + Sync), |f| f);
    let read = on_threads(py, threads, || read_model(&data, &name, resources, &options))?;
    let model = read.map_err(|e| error::of_reader(py, e, &name))?;
    let stem = std::path::Path::new(&name).file_stem().unwrap_or_default();
    Ok(Model {
        name: stem.to_string_lossy().into_owned(),
        format: model.format,
        warnings: model.warnings.iter().map(ToString::to_string).collect(),
        animations: model.animations,
        scene: model.scene,
    })
}

/// Adds the names of this file to the module.
pub fn add(m: &Bound<'_, PyModule>) -> PyResult<()> {
    m.add_class::<Model>()?;
    m.add_function(wrap_pyfunction!(read, m)?)
}
