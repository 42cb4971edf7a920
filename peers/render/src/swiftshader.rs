//! SwiftShader, the software Vulkan of Chromium, from its shared library.

use crate::clock::{Cost, measure, median_cost};
use crate::mesh::Mesh;
use crate::picture::Picture;
use crate::scene::{self, Place};
use crate::vulkan::Gpu;
use crate::{Result, shaders};
use ash::vk;
use std::path::{Path, PathBuf};
use vek::Mat4;

/// Path of the library in Debian's `chromium-common`.
const DEBIAN: &str = "/usr/lib/chromium/libvk_swiftshader.so";

/// Returns the library, if there is one: the one named by `SWIFTSHADER`, else Debian's.
pub fn library() -> Option<PathBuf> {
    let named = std::env::var_os("SWIFTSHADER").map(PathBuf::from);
    named.or_else(|| Some(PathBuf::from(DEBIAN)).filter(|path| path.exists()))
}

/// Returns the name of the library's device, which has to be SwiftShader: other libraries draw too.
pub fn name(library: &Path) -> Result<String> {
    let path = library.display();
    let gpu = Gpu::new(library).map_err(|e| format!("{path}: {e}"))?;
    if gpu.name.contains("SwiftShader") {
        return Ok(gpu.name.clone());
    }
    Err(format!("{path}: the device is {}, not SwiftShader", gpu.name).into())
}

/// The scene for a number of samples and threads.
pub struct SwiftShader {
    library: PathBuf,
    /// Position and normal of each vertex, bits of `f32`.
    vertices: Vec<u32>,
    indices: Vec<u32>,
    place: Place,
    samples: u32,
    /// Folder of `SwiftShader.ini`, which says how many threads.
    folder: PathBuf,
    last: Picture,
}

impl SwiftShader {
    /// Creates the scene ready to be drawn, with 1 or 4 samples per pixel and a number of threads, in a new folder
    /// inside the given one.
    pub fn new(
        library: PathBuf,
        mesh: &Mesh,
        samples: u32,
        threads: usize,
        folder: &Path,
    ) -> Result<Self> {
        let folder = folder.join(format!("swiftshader-{threads}"));
        std::fs::create_dir_all(&folder)?;
        let settings = format!("[Processor]\nThreadCount={threads}\n");
        std::fs::write(folder.join("SwiftShader.ini"), settings)?;
        let vertices = mesh.positions.iter().zip(&mesh.normals);
        Ok(Self {
            library,
            vertices: vertices.flat_map(|(p, n)| [*p, *n]).flatten().map(f32::to_bits).collect(),
            indices: mesh.triangles.as_flattened().to_vec(),
            place: Place::of(mesh),
            samples,
            folder,
            last: Picture { width: scene::WIDTH, pixels: Vec::new(), background: [0; 3] },
        })
    }

    /// Returns a device with its threads: SwiftShader reads its settings in the current folder.
    fn open(&self) -> Result<Gpu> {
        let before = std::env::current_dir()?;
        let library = self.library.canonicalize()?;
        std::env::set_current_dir(&self.folder)?;
        let gpu = Gpu::new(&library);
        std::env::set_current_dir(before)?;
        gpu
    }

    /// Draws one turn of frames on a new device; returns the medians of the timed ones.
    pub fn turn(&mut self) -> Result<Cost> {
        let mut gpu = self.open()?;
        let targets = gpu.targets(self.samples)?;
        gpu.pipeline(&shaders::phong()?, self.samples)?;
        let buffers = [
            gpu.buffer(&self.vertices, vk::BufferUsageFlags::VERTEX_BUFFER)?,
            gpu.buffer(&self.indices, vk::BufferUsageFlags::INDEX_BUFFER)?,
        ];
        let mut costs = Vec::new();
        for frame in 0..=scene::LAST {
            let count = self.indices.len() as u32;
            let draw = || gpu.draw(&targets, buffers, count, &self.matrices(frame));
            let (result, cost) = measure(draw);
            result?;
            if frame >= scene::WARM {
                costs.push(cost);
            }
        }
        self.last.pixels = gpu.read(&targets)?.iter().map(|&[r, g, b, _]| [r, g, b]).collect();
        // The corner is never covered.
        self.last.background = self.last.pixels[0];
        Ok(median_cost(&costs))
    }

    /// Clip space from the world, then view space from the world, column by column.
    fn matrices(&self, frame: usize) -> [u8; 128] {
        let (width, height) = (scene::WIDTH as f32, scene::HEIGHT as f32);
        let (near, far) = (self.place.near() as f32, self.place.far() as f32);
        let fov = scene::FOV_Y as f32;
        let clip_from_view = Mat4::perspective_fov_rh_zo(fov, width, height, near, far);
        let view_from_world = self.place.view_from_world(frame);
        let both = [clip_from_view * view_from_world, view_from_world];
        let mut bytes = [0; 128];
        for (to, from) in
            bytes.chunks_exact_mut(4).zip(both.map(Mat4::into_col_array).as_flattened())
        {
            to.copy_from_slice(&from.to_le_bytes());
        }
        bytes
    }

    /// Returns the last frame.
    pub fn picture(&self) -> Picture {
        self.last.clone()
    }
}
